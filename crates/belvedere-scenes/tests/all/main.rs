//! Tests of simulated towns and scans in one program, because linking many small programs took longer than running
//! them.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]
#![allow(clippy::cast_possible_truncation, reason = "the numbers of tests are small, or made to be f32")]

mod airborne;
mod closed_forms;
mod lod1;
mod presets;
mod queries;
mod surveys;
mod terrestrial;
mod town;
mod truth;
