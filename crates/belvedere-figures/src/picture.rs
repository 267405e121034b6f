//! Pictures in memory: drawing and composing them.
//!
//! Depth maps become pictures by [`depth_picture`], points and balls by [`Canvas`], several pictures one by
//! [`side_by_side`](crate::side_by_side); [`crate::png::write_png`] saves them.

/// Colour of the paper around pictures.
pub(crate) const PAPER: [u8; 3] = [255, 255, 255];
/// Colour of text.
pub(crate) const INK: [u8; 3] = [25, 25, 30];

/// A picture with 8 bits per channel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Number of columns.
    pub width: usize,
    /// Number of rows.
    pub height: usize,
    /// Red, green and blue of each pixel, row by row from the top, `3 * width * height` bytes.
    pub rgb: Vec<u8>,
}

impl Picture {
    /// A picture in one colour.
    #[must_use]
    pub fn filled(width: usize, height: usize, color: [u8; 3]) -> Self {
        Self { width, height, rgb: color.repeat(width * height) }
    }

    /// Colour at a column and a row, or `None` outside.
    #[must_use]
    pub fn get(&self, column: usize, row: usize) -> Option<[u8; 3]> {
        if column >= self.width {
            return None;
        }
        self.rgb.get((row * self.width + column) * 3..)?.first_chunk().copied()
    }

    /// Fills the part of a rectangle of `size` at `corner` (column, row) that lies within the picture.
    pub fn fill_rectangle(&mut self, corner: [usize; 2], size: [usize; 2], color: [u8; 3]) {
        let right = (corner[0] + size[0]).min(self.width);
        if corner[0] >= right {
            return;
        }
        for row in corner[1]..(corner[1] + size[1]).min(self.height) {
            let pixels = row * self.width + corner[0]..row * self.width + right;
            for pixel in self.rgb[pixels.start * 3..pixels.end * 3].as_chunks_mut::<3>().0 {
                *pixel = color;
            }
        }
    }

    /// Copies `other` into this picture with its upper left corner at `corner` (column, row), cut at the border.
    pub fn paste(&mut self, other: &Self, corner: [usize; 2]) {
        let columns = other.width.min(self.width.saturating_sub(corner[0]));
        for row in 0..other.height.min(self.height.saturating_sub(corner[1])) {
            let from = row * other.width * 3;
            let to = ((row + corner[1]) * self.width + corner[0]) * 3;
            self.rgb[to..to + columns * 3].copy_from_slice(&other.rgb[from..from + columns * 3]);
        }
    }

    /// The picture with each pixel repeated `factor` times in both directions.
    #[must_use]
    pub fn enlarged(&self, factor: usize) -> Self {
        let mut rgb = Vec::with_capacity(self.rgb.len() * factor * factor);
        for row in self.rgb.chunks(self.width.max(1) * 3) {
            let wide: Vec<u8> = row.as_chunks::<3>().0.iter().flat_map(|p| p.repeat(factor)).collect();
            for _ in 0..factor {
                rgb.extend_from_slice(&wide);
            }
        }
        Self { width: self.width * factor, height: self.height * factor, rgb }
    }
}

/// Pixels per dot of the font for a picture of `side` pixels, so that text stays legible when it is shown whole.
pub(crate) fn text_scale(side: usize) -> usize {
    (side / 450).clamp(1, 8).max(if side >= 250 { 2 } else { 1 })
}
