//! PNG files, still and animated.

use std::io::Write;
use std::path::Path;

use crate::picture::Picture;
use belvedere_data::cast::to_row;
use belvedere_data::{Error, Parameter, Result};
use belvedere_io::atomic;

/// The contents of the PNG file of `picture`, with 8 bits per channel.
///
/// # Errors
/// Those of [`write_png`], but [`Error::Io`].
pub fn png_bytes(picture: &Picture) -> Result<Vec<u8>> {
    let (width, height) = checked_size(picture)?;
    let mut bytes = Vec::new();
    let mut writer = encoder(&mut bytes, width, height).write_header().map_err(failed(Path::new("PNG")))?;
    writer.write_image_data(&picture.rgb).map_err(failed(Path::new("PNG")))?;
    writer.finish().map_err(failed(Path::new("PNG")))?;
    Ok(bytes)
}

/// Writes `picture` with 8 bits per channel.
///
/// # Errors
/// [`Error::InvalidParameter`] for a picture without pixels, with a side of more than `u32` pixels or with the wrong
/// number of bytes, [`Error::Io`].
pub fn write_png(path: &Path, picture: &Picture) -> Result<()> {
    let (width, height) = checked_size(picture)?;
    atomic::write(path, |output| {
        let mut writer = encoder(output, width, height).write_header().map_err(failed(path))?;
        writer.write_image_data(&picture.rgb).map_err(failed(path))?;
        writer.finish().map_err(failed(path))
    })
}

/// Writes pictures of one size as the frames of an animation that starts over without end, each shown for
/// `milliseconds`. A frame is stored as the rectangle that differs from the one before.
///
/// # Errors
/// Those of [`write_png`], and more than `u32` frames.
pub(super) fn write_frames(path: &Path, frames: &[Picture], milliseconds: u16) -> Result<()> {
    let (Some(first), Ok(count)) = (frames.first(), u32::try_from(frames.len())) else {
        let value = frames.len().to_string();
        return Err(Error::invalid(Parameter::Frames, value, "1 to 4294967295 in number"));
    };
    for frame in frames {
        checked_size(frame)?;
    }
    let (width, height) = checked_size(first)?;
    atomic::write(path, |output| {
        let mut encoder = encoder(output, width, height);
        encoder.set_animated(count, 0).map_err(failed(path))?;
        encoder.set_frame_delay(milliseconds, 1000).map_err(failed(path))?;
        let mut writer = encoder.write_header().map_err(failed(path))?;
        writer.write_image_data(&first.rgb).map_err(failed(path))?;
        for pair in frames.windows(2) {
            let [before, frame] = pair else { continue };
            let [left, top, width, height] = changed(before, frame);
            let mut part = Picture::filled(width, height, [0; 3]);
            for row in 0..height {
                let from = ((top + row) * frame.width + left) * 3;
                part.rgb[row * width * 3..][..width * 3].copy_from_slice(&frame.rgb[from..from + width * 3]);
            }
            let (x, y) = (to_row(left), to_row(top));
            // the position is set back first, since a size is checked against the current position
            writer.set_frame_position(0, 0).map_err(failed(path))?;
            writer.set_frame_dimension(to_row(width), to_row(height)).map_err(failed(path))?;
            writer.set_frame_position(x, y).map_err(failed(path))?;
            writer.write_image_data(&part.rgb).map_err(failed(path))?;
        }
        writer.finish().map_err(failed(path))
    })
}

/// Left, top, width and height of the smallest rectangle with all differences of two pictures of one size; one pixel
/// without any.
fn changed(before: &Picture, after: &Picture) -> [usize; 4] {
    let bytes = 3 * after.width;
    let rows = || before.rgb.chunks_exact(bytes).zip(after.rgb.chunks_exact(bytes));
    let differs = |(a, b): (&[u8], &[u8])| a != b;
    let Some(top) = rows().position(differs) else { return [0, 0, 1, 1] };
    let bottom = rows().rposition(differs).unwrap_or(top);
    let (mut left, mut right) = (bytes, 0);
    for (a, b) in rows().skip(top).take(bottom - top + 1) {
        let differing = || a.iter().zip(b);
        if let Some(first) = differing().position(|(a, b)| a != b) {
            left = left.min(first);
            right = right.max(differing().rposition(|(a, b)| a != b).unwrap_or(first));
        }
    }
    let (left, right) = (left / 3, right / 3);
    [left, top, right - left + 1, bottom - top + 1]
}

fn encoder<W: Write>(output: &mut W, width: u32, height: u32) -> png::Encoder<'static, &mut W> {
    let mut encoder = png::Encoder::new(output, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder
}

fn failed(path: &Path) -> impl Fn(png::EncodingError) -> Error + '_ {
    move |error| match error {
        png::EncodingError::IoError(source) => Error::io(path)(source),
        other => Error::malformed(path, format!("cannot be written: {other}")),
    }
}

/// Width and height of a picture that can be written.
fn checked_size(picture: &Picture) -> Result<(u32, u32)> {
    let size = (u32::try_from(picture.width), u32::try_from(picture.height));
    match size {
        (Ok(width @ 1..), Ok(height @ 1..)) if picture.rgb.len() == picture.width * picture.height * 3 => {
            Ok((width, height))
        }
        _ => Err(Error::invalid(
            Parameter::PictureSize,
            format!("{} x {} pixels in {} bytes", picture.width, picture.height, picture.rgb.len()),
            "at least one pixel and three bytes per pixel",
        )),
    }
}
