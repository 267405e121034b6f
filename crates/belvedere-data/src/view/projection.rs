//! Conversion between positions and places of the picture.

use super::{View, ViewFrame};
use crate::Parameter;
use crate::cast::to_index;
use crate::vector::dot;

/// Projection of space onto the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// Parallel rays along `forward`. Depth is metres along `forward` from the picture plane.
    Orthographic {
        /// The paper's s: pixels per metre, the same in both directions.
        pixels_per_metre: f64,
    },
    /// A pinhole camera: square pixels, straight lines stay straight, the axis meets the middle of the picture. Depth
    /// is metres along `forward` from the eye.
    Perspective {
        /// Pixels from the middle of the picture to a direction 45° off the axis.
        focal_px: f64,
        /// Minimum visible depth, metres, 0 or more.
        near: f64,
        /// Maximum visible depth, metres, above `near`; may be infinite.
        far: f64,
    },
    /// A stereographic map of the directions around `forward`: a ball's outline is a disc. A direction at the angle θ
    /// off the axis lies `radius_px` · tan(θ / 2) from the middle of the picture, so that a map may show more than a
    /// hemisphere. Depth is range: metres straight from the eye.
    Hemispherical {
        /// Pixels from the middle of the picture to directions at right angles to the axis.
        radius_px: f64,
        /// Minimum visible range, metres, 0 or more.
        near: f64,
        /// Maximum visible range, metres, above `near`; may be infinite.
        far: f64,
    },
}

impl View {
    /// Projects a local position into the picture: pixels from its upper left corner, and depth, metres, inside the
    /// picture and its limits or not. `None` for a position that a projection cannot show: at or behind the eye of a
    /// perspective view, at the eye or exactly opposite to the axis of a hemispherical one.
    #[must_use]
    #[inline]
    pub fn project(&self, local: [f32; 3]) -> Option<[f64; 3]> {
        self.place(self.frame.view_from_local(local))
    }

    /// Projects a direction from the eye (local, any length) into the picture of a view from an eye, pixels, inside or
    /// beside it. `None` where [`View::project`] returns none.
    #[must_use]
    pub fn place_of_direction(&self, direction: [f64; 3]) -> Option<[f64; 2]> {
        let ViewFrame { right, down, forward, .. } = self.frame;
        let [x, y, _] = self.place([right, down, forward].map(|axis| dot(axis, direction)))?;
        Some([x, y])
    }

    /// Place and depth of a position along right, down and forward.
    #[inline]
    fn place(&self, [x, y, z]: [f64; 3]) -> Option<[f64; 3]> {
        let middle = self.middle();
        match self.projection {
            Projection::Orthographic { pixels_per_metre } => Some([x * pixels_per_metre, y * pixels_per_metre, z]),
            Projection::Perspective { focal_px, .. } => {
                (z > 0.0).then(|| [middle[0] + focal_px * (x / z), middle[1] + focal_px * (y / z), z])
            }
            Projection::Hemispherical { radius_px, .. } => {
                let beside = x * x + y * y;
                let range = (beside + z * z).sqrt();
                // range + z, which cancels behind the eye
                let divisor = if z >= 0.0 { range + z } else { beside / (range - z) };
                let place = |middle: f64, v: f64| middle + radius_px * (v / divisor);
                (divisor > 0.0).then(|| [place(middle[0], x), place(middle[1], y), range])
            }
        }
    }

    /// The pixel that a place of [`View::project`] lies in, column and row, if its depth is within the limits too.
    #[must_use]
    #[inline]
    pub fn pixel(&self, [x, y, depth]: [f64; 3]) -> Option<[usize; 2]> {
        let [near, far] = self.limits();
        if !(x >= 0.0 && y >= 0.0 && depth >= near && depth <= far) {
            return None;
        }
        let pixel = [to_index(x), to_index(y)];
        (pixel[0] < self.size_px[0] && pixel[1] < self.size_px[1]).then_some(pixel)
    }

    /// Unit vector of sight through a place of the picture, in pixels from its upper left corner: along right, down and
    /// forward.
    #[must_use]
    pub fn direction(&self, [x, y]: [f64; 2]) -> [f64; 3] {
        let middle = self.middle();
        let offset = |scale: f64| [(x - middle[0]) / scale, (y - middle[1]) / scale];
        match self.projection {
            Projection::Orthographic { .. } => [0.0, 0.0, 1.0],
            Projection::Perspective { focal_px, .. } => {
                let [x, y] = offset(focal_px);
                let length = (x * x + y * y + 1.0).sqrt();
                [x / length, y / length, 1.0 / length]
            }
            Projection::Hemispherical { radius_px, .. } => {
                let [x, y] = offset(radius_px);
                let square = x * x + y * y;
                [2.0 * x, 2.0 * y, 1.0 - square].map(|v| v / (1.0 + square))
            }
        }
    }

    /// Returns the position at `depth` metres behind a place of the picture, in pixels from its upper left corner. It
    /// is in metres along right, down and forward of the frame. The inverse of [`View::project`].
    #[must_use]
    pub fn position(&self, place: [f64; 2], depth: f64) -> [f64; 3] {
        let direction = self.direction(place);
        match self.projection {
            Projection::Orthographic { pixels_per_metre } => {
                [place[0] / pixels_per_metre, place[1] / pixels_per_metre, depth]
            }
            Projection::Perspective { .. } => direction.map(|v| v * (depth / direction[2])),
            Projection::Hemispherical { .. } => direction.map(|v| v * depth),
        }
    }

    /// Returns the minimum and maximum visible depth, metres.
    #[must_use]
    pub fn limits(&self) -> [f64; 2] {
        match self.projection {
            Projection::Orthographic { .. } => [0.0, f64::INFINITY],
            Projection::Perspective { near, far, .. } | Projection::Hemispherical { near, far, .. } => [near, far],
        }
    }

    /// The same view with other limits of depth, metres. Parallel views have none and stay as they are.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`](crate::Error::InvalidParameter) unless `near` is finite, 0 or more, and `far` above
    /// it.
    pub fn with_limits(mut self, nearest: f64, farthest: f64) -> crate::Result<Self> {
        if !(nearest >= 0.0 && nearest.is_finite() && farthest > nearest) {
            return Err(crate::Error::invalid(
                Parameter::DepthLimits,
                format!("{nearest} and {farthest} m"),
                "near 0 or more, and far above near",
            ));
        }
        match &mut self.projection {
            Projection::Orthographic { .. } => {}
            Projection::Perspective { near, far, .. } | Projection::Hemispherical { near, far, .. } => {
                (*near, *far) = (nearest, farthest);
            }
        }
        Ok(self)
    }

    /// Returns true if lines of sight meet in an eye at [`ViewFrame::eye`](super::ViewFrame::eye), false if they are
    /// parallel.
    #[must_use]
    pub fn is_central(&self) -> bool {
        !matches!(self.projection, Projection::Orthographic { .. })
    }

    /// Pixels per metre of a parallel view; `None` where that depends on the depth.
    #[must_use]
    pub fn pixels_per_metre(&self) -> Option<f64> {
        match self.projection {
            Projection::Orthographic { pixels_per_metre } => Some(pixels_per_metre),
            _ => None,
        }
    }

    /// Width of a pixel at the middle of the picture, metres, at `range` metres from the eye (of no matter in a
    /// parallel view).
    #[must_use]
    pub fn pixel_width(&self, range: f64) -> f64 {
        match self.projection {
            Projection::Orthographic { pixels_per_metre } => 1.0 / pixels_per_metre,
            Projection::Perspective { focal_px, .. } => range / focal_px,
            Projection::Hemispherical { radius_px, .. } => range * 2.0 / radius_px,
        }
    }

    /// Returns the place at which the axis of a central view meets the picture, pixels.
    #[must_use]
    pub fn middle(&self) -> [f64; 2] {
        self.size_px.map(|size| size as f64 / 2.0)
    }
}
