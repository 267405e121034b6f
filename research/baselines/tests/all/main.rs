//! The tests of the rivals and scores, in one program: linking many small ones took longer than running them.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]
#![allow(clippy::cast_possible_truncation, reason = "the numbers of tests are small, or made to be f32")]

mod all_methods;
mod common;
mod fields;
mod held_out;
mod hidden_points;
mod mesh_rays;
mod mesh_target_truth;
mod reconstructed;
mod surfaces;
mod water;
mod wrong_scanner;
