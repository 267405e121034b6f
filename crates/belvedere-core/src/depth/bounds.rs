//! Bounds of depth that hold for every point of a pixel, not only for its centre.

use super::ball_bound::{BallBound, BoundSide};
use super::central::{self, Central};
use super::parallel::{self, Parallel};
use super::tiles::{self, ItemBuffer};
use crate::blocking::{Ball, BlockRule};
use belvedere_data::control::Control;
use belvedere_data::raster::Raster;
use belvedere_data::view::{Projection, View};
use belvedere_data::{Error, Parameter, Result};

/// What bounds of depth are to allow for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundsParams {
    /// How far balls may give way to a target, or an eye, near their surface, metres, 0 or more, never more than half
    /// their radius: see [`BlockRule::shell`]. Default 0.
    pub shell: f64,
    /// Where lines of sight end on the viewer's side, as a depth or, in a view from an eye, as a range in metres: balls
    /// that reach before it block nothing. −∞ for a viewer infinitely far away. Default 0, the picture plane or the
    /// eye. In a perspective view a plane of this depth. At an eye balls give way to it, and one that holds it even so
    /// blocks all.
    pub start: f64,
}

impl Default for BoundsParams {
    fn default() -> Self {
        Self { shell: 0.0, start: 0.0 }
    }
}

impl BoundsParams {
    /// Where lines of sight of `view` end on the viewer's side, the nearest and the farthest of them: depths in a
    /// parallel view, ranges in all others, metres.
    #[must_use]
    pub fn starts(&self, view: &View) -> [f64; 2] {
        let max_range_per_depth = match view.projection {
            Projection::Perspective { .. } => 1.0 / view.direction([0.0; 2])[2],
            _ => 1.0,
        };
        [self.start, if self.start > 0.0 { self.start * max_range_per_depth } else { self.start }]
    }
}

/// For each pixel of a view, between which depths the first surface lies that any line of sight through the pixel
/// meets.
#[derive(Clone, Debug, PartialEq)]
pub struct DepthBounds {
    /// The view they were made for.
    pub view: View,
    /// For each pixel, metres (depth in parallel views, range from the eye in all others): at most the depth of the
    /// first surface at any point of it, +∞ where no ball touches it; and at least that depth at every point of it,
    /// even where balls give way by the shell, +∞ where no single ball covers it.
    pub bounds: Raster<[f32; 2]>,
}

/// Bounds of depth in `view` over the balls given as centre (local) and radius, metres; those that are not finite are
/// left out. Where lines of sight end at the eye of the view, balls near it count with the radius that they give way to
/// ([`BlockRule::radius_for`]), and the lower bound is 0 everywhere where a ball holds the eye even so.
///
/// Over the square of a pixel the front of a ball is nearest at the point nearest to the ball's middle and farthest at
/// a corner. The lower bound is the least of the former over all balls that touch the square, the upper bound the least
/// of the latter over all balls that cover it even when they give way by the shell. Balls that cover it only with all
/// of their radius count too, but from the depth on from which no target lies within the shell of them. In views from
/// an eye the circle of directions around the square takes its place. Balls are drawn a little too large for the one
/// and too small for the other, by more than f32 can err.
///
/// # Errors
/// [`Error::InvalidParameter`] for 2³² balls or more, and [`Error::Cancelled`].
pub fn depth_bounds(balls: &[Ball], view: &View, params: &BoundsParams, control: &Control<'_>) -> Result<DepthBounds> {
    if u32::try_from(balls.len()).is_err() {
        return Err(Error::InvalidParameter {
            parameter: Parameter::BallCount,
            value: balls.len().to_string(),
            expected: "below 2^32",
        });
    }
    let ball = |i: usize| balls.get(i).copied().filter(|ball| ball.radius > 0.0 && ball.radius.is_finite());
    // what limits lines of sight is said by `start`
    let unlimited = view.with_limits(0.0, f64::INFINITY)?;
    let start = params.starts(view);
    let draw = |side: BoundSide| {
        let rule = BlockRule { shell: params.shell, ..BlockRule::default() };
        let bound = BallBound { side, rule, start, is_to_eye: view.is_central() && params.start == 0.0 };
        let drawn = match view.projection {
            Projection::Orthographic { pixels_per_metre } => {
                let surface = parallel::ParallelBound::new(bound, pixels_per_metre);
                let shape = Parallel::new(&unlimited, pixels_per_metre, surface);
                tiles::draw(&shape, view.size_px, balls.len(), ball, ItemBuffer::Without, control)
            }
            _ => {
                let shape = Central::new(&unlimited, central::CentralBound(bound));
                tiles::draw(&shape, view.size_px, balls.len(), ball, ItemBuffer::Without, control)
            }
        };
        drawn.map(|(depth, _)| depth)
    };
    let (lower, upper) = (draw(BoundSide::Lower)?, draw(BoundSide::Upper)?);
    let bounds = lower.values().iter().zip(upper.values()).map(|(&lower, &upper)| [lower, upper]).collect();
    let [width, height] = view.size_px;
    Ok(DepthBounds { view: *view, bounds: Raster::from_values(width, height, bounds)? })
}
