//! Runs of a simulated town in tiles.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]
#![allow(clippy::cast_possible_truncation, reason = "the numbers of tests are small, or made to be f32")]

mod any_size;
mod cells;
mod cleared;
mod common;
mod hostile;
mod joined;
mod planned;
mod robust;
mod seams;
