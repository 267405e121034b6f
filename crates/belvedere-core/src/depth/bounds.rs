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

/// Parameters of bounds of depth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundsParams {
    /// Maximum reduction of balls near a target or an eye at their surface, metres, 0 or more, never more than half
    /// their radius: see [`BlockRule::shell`]. Default 0.
    pub shell: f64,
    /// End of lines of sight on the viewer's side, as a depth or, in a view from an eye, as a range in metres: balls
    /// that reach before it block nothing. −∞ for a viewer infinitely far away. Default 0, the picture plane or the
    /// eye. In a perspective view it is a plane of this depth. At an eye balls give way to it, and one that holds it
    /// even so blocks all.
    pub start: f64,
}

impl Default for BoundsParams {
    fn default() -> Self {
        Self { shell: 0.0, start: 0.0 }
    }
}

impl BoundsParams {
    /// Returns the nearest and the farthest end of the lines of sight of `view` on the viewer's side: depths in a
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
    /// Bounds for each pixel, metres (depth in parallel views, range from the eye in all others). The first is at most
    /// the depth of the first surface at any point of the pixel, +∞ if no ball touches it. The second is at least that
    /// depth at every point of it, even with balls reduced by the shell, +∞ if no single ball covers it.
    pub bounds: Raster<[f32; 2]>,
}

/// Returns bounds of depth in `view` over the balls, given as centre (local) and radius, metres; balls that are not
/// finite are left out. If lines of sight end at the eye of the view, balls near it have the radius reduced for it
/// ([`BlockRule::radius_for`]). The lower bound is 0 everywhere if a ball holds the eye even so.
///
/// Over the square of a pixel the front of a ball is nearest at the point nearest to the ball's middle, and farthest at
/// a corner. The lower bound is the minimum of the former over all balls that touch the square. The upper bound is the
/// minimum of the latter over all balls that cover it even when reduced by the shell. Balls that cover it only with
/// their whole radius count beyond the depth at which no target lies within their shell.
///
/// In views from an eye the circle of directions around the square takes its place. Balls are drawn a little too large
/// for the one and too small for the other, by more than the error of f32.
///
/// # Errors
/// [`Error::InvalidParameter`] for 2³² balls or more, and [`Error::Cancelled`].
pub fn depth_bounds(balls: &[Ball], view: &View, params: &BoundsParams, control: &Control<'_>) -> Result<DepthBounds> {
    if u32::try_from(balls.len()).is_err() {
        return Err(Error::invalid(Parameter::BallCount, balls.len(), "below 2^32"));
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
