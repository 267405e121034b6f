//! Several pictures after each other as one animated PNG, which browsers and viewers play like a GIF but in full
//! colour.

use std::path::Path;

use crate::picture::Picture;
use crate::png::write_frames;
use belvedere_data::{Error, Parameter, Result};

/// Maximum time of a frame, seconds: the file format counts milliseconds in 16 bits.
const LONGEST: f64 = 65.535;

/// Writes `frames`, all of one size, as an animated PNG that shows each for `seconds_per_frame` (to a millisecond) and
/// starts over without end. Programs that know no animated PNG show the first frame.
///
/// Of each frame only the rectangle that differs from the frame before is stored.
///
/// # Errors
/// [`Error::InvalidParameter`] for no frame, frames of different sizes or without pixels, and a time that is not 0.001
/// to 65.535 seconds; [`Error::Io`].
///
/// # Source
/// W3C, Portable Network Graphics (PNG) Specification, third edition, 2025, sections 4.9 and 11.3.6.
pub fn write_apng(path: &Path, frames: &[Picture], seconds_per_frame: f64) -> Result<()> {
    let Some(first) = frames.first() else {
        return Err(Error::invalid(Parameter::Frames, "none", "at least one"));
    };
    if let Some(other) = frames.iter().find(|frame| (frame.width, frame.height) != (first.width, first.height)) {
        let value = format!("{} x {} pixels after {} x {}", other.width, other.height, first.width, first.height);
        return Err(Error::invalid(Parameter::Frames, value, "of the size of the first frame"));
    }
    if !(0.001..=LONGEST).contains(&seconds_per_frame) {
        return Err(Error::invalid(Parameter::FrameTime, format!("{seconds_per_frame} s"), "0.001 to 65.535 seconds"));
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked to be 1 to 65535 ms")]
    let milliseconds = (seconds_per_frame * 1000.0).round() as u16;
    write_frames(path, frames, milliseconds)
}
