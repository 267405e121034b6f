//! The tests of the server, without a browser.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]
#![allow(clippy::cast_possible_truncation, reason = "the numbers of tests are small, or made to be f32")]

mod bundle;
mod hostile;
