//! Runs of a simulated town in tiles.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod any_size;
mod cells;
mod cleared;
mod common;
mod hostile;
mod planned;
mod robust;
mod seams;
