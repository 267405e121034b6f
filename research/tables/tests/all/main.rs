//! The tests of programs that make tables, in one program.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod sun_and_sky_truth;
mod viewshed_truth;
