//! Parallel views: the paper's viewport, and views that fit a scene.

use super::{MAX_PIXEL_COUNT, MAX_SIDE, Projection, View, ViewFrame};
use crate::cast::to_index;
use crate::vector::{box_around, cross, dot, unit};
use crate::{Error, Parameter, Result};

impl View {
    /// The paper's viewport: `p0` is the upper left corner, `vx` spans the rows and `vy` the columns (their lengths
    /// give the size of the picture), `pixels_per_metre` is s. The line of sight is `vx × vy`.
    ///
    /// `p0` is local; all lengths are metres.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] if a value is not finite, a vector has no length, or the two are not at right angles
    /// (to a thousandth). Also if the picture would be empty or have more than [`MAX_PIXEL_COUNT`] pixels.
    ///
    /// # Source
    /// Peters, Ledoux & Biljecki 2015, section 3.2 and Figure 3.
    pub fn from_viewport(p0: [f64; 3], vx: [f64; 3], vy: [f64; 3], pixels_per_metre: f64) -> Result<Self> {
        let invalid = |parameter, value: String, expected| Err(Error::invalid(parameter, value, expected));
        let (Some(right), Some(down)) = (unit(vx), unit(vy)) else {
            return invalid(Parameter::Viewport, format!("{vx:?}, {vy:?}"), "finite and longer than zero");
        };
        if !p0.iter().all(|v| v.is_finite()) {
            return invalid(Parameter::Viewport, format!("{p0:?}"), "finite");
        }
        if dot(right, down).abs() > 1e-3 {
            return invalid(Parameter::Viewport, format!("{vx:?}, {vy:?}"), "perpendicular to each other");
        }
        if !(pixels_per_metre.is_finite() && pixels_per_metre > 0.0) {
            return invalid(Parameter::PixelsPerMetre, pixels_per_metre.to_string(), "finite and above zero");
        }
        let Some(forward) = unit(cross(right, down)) else {
            return invalid(Parameter::Viewport, format!("{vx:?}, {vy:?}"), "perpendicular to each other");
        };
        let down = cross(forward, right);
        let size = |v: [f64; 3]| (dot(v, v).sqrt() * pixels_per_metre - 1e-6).ceil().max(1.0);
        let (width, height) = (size(vx), size(vy));
        if !(width * height <= MAX_PIXEL_COUNT as f64 && width.max(height) <= MAX_SIDE as f64) {
            return invalid(
                Parameter::PictureSize,
                format!("{width} x {height} pixels"),
                "at most 65536 on a side and 268435456 pixels in all",
            );
        }
        let size_px = [to_index(width), to_index(height)];
        Ok(Self {
            frame: ViewFrame { eye: p0, right, down, forward },
            projection: Projection::Orthographic { pixels_per_metre },
            size_px,
        })
    }

    /// A parallel view along `forward` (local, any length) that just holds the local box from `low` to `high`, with
    /// square pixels of `pixel_size` metres. The picture's up is the world's up, or north when looking straight down or
    /// up. The picture plane touches the box, so that every point of the box has a depth of zero or more.
    ///
    /// # Errors
    /// As [`View::from_viewport`].
    pub fn parallel(forward: [f64; 3], low: [f64; 3], high: [f64; 3], pixel_size: f64) -> Result<Self> {
        let Some(forward) = unit(forward) else {
            return Err(Error::invalid(
                Parameter::ViewDirection,
                format!("{forward:?}"),
                "finite and longer than zero",
            ));
        };
        if !(pixel_size.is_finite() && pixel_size > 0.0) {
            return Err(Error::invalid(Parameter::PixelSize, pixel_size, "above zero metres"));
        }
        let ViewFrame { right, down, .. } = ViewFrame::looking([0.0; 3], forward);
        let [min, max] = box_around((0..8).map(|corner| {
            let p: [f64; 3] = std::array::from_fn(|i| if corner >> i & 1 == 0 { low[i] } else { high[i] });
            [right, down, forward].map(|axis| dot(axis, p))
        }));
        let eye = std::array::from_fn(|i| min[0] * right[i] + min[1] * down[i] + min[2] * forward[i]);
        // half a pixel of room keeps points on the edge of the box inside the picture
        let span = |axis: usize| (max[axis] - min[axis]).max(0.0) + 0.5 * pixel_size;
        Self::from_viewport(eye, right.map(|v| v * span(0)), down.map(|v| v * span(1)), 1.0 / pixel_size)
    }

    /// The same view with the picture plane of a parallel view moved back as far as needed for none of `positions`,
    /// local metres, to lie before it. Pixels stay the same lines of sight. Views from an eye stay as they are.
    #[must_use]
    pub fn moved_before(mut self, positions: &[[f32; 3]]) -> Self {
        if self.is_central() {
            return self;
        }
        let depth = |&p: &[f32; 3]| self.frame.view_from_local(p)[2];
        let nearest = positions.iter().map(depth).fold(0.0, f64::min);
        if nearest < 0.0 {
            // a millimetre more, so that rounding leaves none before it
            let back = nearest - 1e-3;
            self.frame.eye = self.frame.local_from_view([0.0, 0.0, back]);
        }
        self
    }

    /// Returns the position in plan of the picture of a parallel view straight down or up: easting and northing of its
    /// upper left corner, of the step to the next column and of the step to the next row, local metres. `None` for any
    /// other view.
    #[must_use]
    pub fn ground_grid(&self) -> Option<[[f64; 2]; 3]> {
        let pixels_per_metre = self.pixels_per_metre()?;
        let plane = |v: [f64; 3]| [v[0], v[1]];
        let step = |v: [f64; 3]| plane(v).map(|v| v / pixels_per_metre);
        // a tilt that moves the far side of a kilometre by a millimetre is no tilt
        let upright = self.frame.forward[2].abs() > 1.0 - 0.5e-12;
        upright.then(|| [plane(self.frame.eye), step(self.frame.right), step(self.frame.down)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_view_moved_before_its_targets_has_none_behind_it_and_the_same_pixels() {
        let view = View::parallel([0.3, -0.5, -0.8], [0.0; 3], [10.0, 10.0, 5.0], 0.25).unwrap();
        let (target, lower) = ([4.0, 5.0, 40.0], [4.0, 5.0, 1.0]);
        assert_eq!(view.moved_before(&[lower]), view);
        let moved = view.moved_before(&[lower, target]);
        assert!(view.frame.view_from_local(target)[2] < 0.0 && moved.frame.view_from_local(target)[2] >= 0.0);
        let [before, after] = [view, moved].map(|v| v.frame.view_from_local(lower));
        // a nanometre: rounding of f64
        assert!((before[0] - after[0]).abs() < 1e-9 && (before[1] - after[1]).abs() < 1e-9);
    }

    #[test]
    fn only_a_view_straight_down_lies_on_the_map() {
        let low = [10.0, 20.0, 0.0];
        let high = [14.0, 22.0, 5.0];
        let down = View::parallel([0.0, 0.0, -2.0], low, high, 0.5).unwrap();
        assert_eq!(down.ground_grid(), Some([[10.0, 22.0], [0.5, 0.0], [0.0, -0.5]]));
        let oblique = View::parallel([0.0, 1e-5, -1.0], low, high, 0.5).unwrap();
        assert_eq!(oblique.ground_grid(), None);
    }
}
