//! Depths of single balls at single pixels.

use super::central::{self, Central};
use super::parallel::{self, Parallel};
use super::tiles::SplatSurface;
use crate::blocking::Ball;
use belvedere_data::view::{Projection, View};

/// The depth of one ball at the centre of one pixel, with the bits that [`depth_map`](super::depth_map()) has of
/// spheres. A device that draws with less precision leaves single pixels to this.
pub struct BallDepth {
    view_shape: ViewShape,
}

enum ViewShape {
    Parallel(Parallel<parallel::ParallelSphere>),
    Central(Box<Central<central::CentralSphere>>),
}

impl BallDepth {
    /// Depths in `view`.
    #[must_use]
    pub fn new(view: &View) -> Self {
        let view_shape = match view.projection {
            Projection::Orthographic { pixels_per_metre } => {
                ViewShape::Parallel(Parallel::new(view, pixels_per_metre, parallel::ParallelSphere))
            }
            _ => ViewShape::Central(Box::new(Central::new(view, central::CentralSphere))),
        };
        Self { view_shape }
    }

    /// Depth of `ball` (centre local, metres) at the centre of the pixel at a column and a row, metres; +∞ where it is
    /// not hit. A ball that holds the eye, or is not finite, is never hit.
    #[must_use]
    pub fn at(&self, ball: Ball, pixel: [usize; 2]) -> f32 {
        let Ball { center, radius } = ball;
        let depth = match &self.view_shape {
            ViewShape::Parallel(shape) => {
                shape.place(center, radius, 0).map(|splat| shape.depths(&pixel, &splat, [0, 0])[0])
            }
            ViewShape::Central(shape) => shape.place(center, radius, 0).map(|splat| shape.depth_at(&splat, pixel)),
        };
        depth.unwrap_or(f32::INFINITY)
    }
}
