//! The tests of the command line, in one program: linking many small ones took longer than running them.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]
#![allow(clippy::cast_possible_truncation, reason = "the numbers of tests are small, or made to be f32")]

mod answers;
mod any_size;
mod ask;
mod bench;
mod calibrate;
mod cameras;
mod carved;
mod city;
mod common;
mod contradictions;
mod conventions;
mod depth_maps;
mod determinism;
#[cfg(feature = "gpu")]
mod devices;
mod envelopes;
mod far_terrain;
mod fetch;
mod given_rows;
mod heat;
mod help_examples;
mod holes;
mod how_sure;
mod implausible;
mod info;
mod interrupts;
mod irradiance;
mod kept_scenes;
mod language;
mod limits;
mod lines_of_sight;
mod masbcpp_folder;
mod odd_clouds;
mod odd_places;
mod other_programs;
mod plain_english;
mod plans;
mod protected_views;
mod queries;
mod readme;
mod remote;
mod secrets;
mod shadow;
mod simulate;
mod sky_view;
mod sun_calendars;
mod sun_hours;
mod surface_patches;
mod surfaces;
mod surroundings;
mod survey_plan;
mod towers;
mod trajectory;
mod tree_light;
mod usage;
#[cfg(feature = "view")]
mod view;
#[path = "../../../belvedere-io/tests/all/web_server.rs"]
#[expect(dead_code, reason = "its bad manners are for the tests of reading")]
mod web_server;
mod window_views;
mod written_files;
