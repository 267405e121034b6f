//! The tests of reading and writing that need no other part of the library, in one program.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]
#![allow(clippy::cast_possible_truncation, reason = "the numbers of tests are small, or made to be f32")]

mod common;
mod contradictions;
mod hostile_archives;
mod hostile_input;
mod hostile_laz;
mod hostile_side_files;
mod map_files;
mod odd_clouds;
mod odd_meshes;
mod odd_tables;
mod open_surveys;
mod outputs;
mod remote;
mod skies;
mod sources;
mod web_server;
mod windows;
