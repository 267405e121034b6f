//! PNG files.

use std::path::Path;

use crate::io::atomic;
use crate::io::picture::Picture;
use crate::{Error, Result};

/// Writes `picture` with 8 bits per channel.
///
/// # Errors
/// [`Error::InvalidParameter`] for a picture without pixels, with a side of more than `u32` pixels or with the wrong number
/// of bytes, [`Error::Io`].
pub fn write_png(path: &Path, picture: &Picture) -> Result<()> {
    let size = (u32::try_from(picture.width), u32::try_from(picture.height));
    let (Ok(width @ 1..), Ok(height @ 1..)) = size else { return invalid(picture) };
    if picture.rgb.len() != picture.width * picture.height * 3 {
        return invalid(picture);
    }
    atomic::write(path, |output| {
        let failed = |e: png::EncodingError| match e {
            png::EncodingError::IoError(source) => Error::io(path)(source),
            other => Error::malformed(path, format!("cannot be written: {other}")),
        };
        let mut encoder = png::Encoder::new(output, width, height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        let mut writer = encoder.write_header().map_err(failed)?;
        writer.write_image_data(&picture.rgb).map_err(failed)?;
        writer.finish().map_err(failed)
    })
}

fn invalid(picture: &Picture) -> Result<()> {
    Err(Error::InvalidParameter {
        name: "picture size",
        value: format!("{} x {} pixels in {} bytes", picture.width, picture.height, picture.rgb.len()),
        expected: "at least one pixel and three bytes per pixel",
    })
}
