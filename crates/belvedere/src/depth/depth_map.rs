//! The depth map and its one constructor.

use super::splat_balls::{Cone, Sphere};
use super::tiles;
use crate::medial::MedialBalls;
use crate::raster::Raster;
use crate::view::View;
use crate::{Error, Result};

/// Value of the item buffer where no ball is hit.
pub const NO_BALL: u32 = u32::MAX;

/// Which surface of a ball is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Profile {
    /// The sphere itself, sampled at pixel centres at its exact sub-pixel place. Balls behind the picture plane are not
    /// seen; one that the plane cuts blocks from depth 0 on.
    #[default]
    Sphere,
    /// Algorithm 1 of the paper to the letter: a cone with its tip at the nearest point of the ball, around the middle of
    /// the pixel that holds the centre, before and behind the picture plane alike.
    PaperCone,
}

/// Whether a depth map also says which ball each pixel shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ItemBuffer {
    /// Depths only.
    #[default]
    Without,
    /// The ball of each pixel beside its depth.
    With,
}

/// Depth along each pixel of a view.
#[derive(Clone, Debug, PartialEq)]
pub struct DepthMap {
    /// The view it was made for.
    pub view: View,
    /// The surface that was drawn.
    pub profile: Profile,
    /// Depth in metres along the view's forward vector, from its picture plane; +∞ where nothing is hit.
    pub depth: Raster<f32>,
    /// Row of the ball each pixel shows, [`NO_BALL`] where nothing is hit; of equally near balls the one with the lowest
    /// row. Only where asked for.
    pub balls: Option<Raster<u32>>,
}

/// The depth map of `balls` in `view`. Balls that never shrank, or whose centre or radius is not finite, are left out.
///
/// Cost: reading every ball once, then work in proportion to what is seen. Balls are drawn tile by tile from front to
/// back, and blocks of pixels that are already nearer than a ball can come are skipped. The result is the same for any
/// number of threads and any order of balls.
///
/// # Errors
/// [`Error::InvalidParameter`] for 2³² balls or more.
///
/// # Source
/// Peters, Ledoux & Biljecki 2015, section 3.2 and Algorithm 1 (`WRITEBALL`), of which [`Profile::PaperCone`] is the
/// printed form and [`Profile::Sphere`] the corrected one: the printed depth describes a cone inside the ball. Skipping
/// hidden blocks: Greene, Kass & Miller 1993.
pub fn depth_map(balls: &MedialBalls, view: &View, profile: Profile, items: ItemBuffer) -> Result<DepthMap> {
    if u32::try_from(balls.len()).is_err() {
        return Err(Error::InvalidParameter {
            name: "number of balls",
            value: balls.len().to_string(),
            expected: "below 2^32",
        });
    }
    let (depth, balls) = match profile {
        Profile::Sphere => tiles::draw::<Sphere>(balls, view, items),
        Profile::PaperCone => tiles::draw::<Cone>(balls, view, items),
    };
    Ok(DepthMap { view: *view, profile, depth, balls })
}

/// How far a point of an airborne scan may lie from the surface of the balls around it, metres: 0.05 of noise, and as much
/// by which the default balls stand out over points.
const SURFACE_DEVIATION: f64 = 0.1;
/// Slope of a surface against the picture plane up to which its own points shall be visible: 63°, level ground under a sun
/// 27° high.
const SLOPE: f64 = 2.0;

impl DepthMap {
    /// The bias, metres, by which a target may lie behind the depth of its pixel and still count as visible, unless the
    /// caller knows better.
    ///
    /// A target on a surface lies behind the depth at its pixel's centre by what noise and balls deviate along the normal
    /// (0.1 m, or a pixel where pixels are finer, as for small objects), seen at a slope of 2, and by that slope over half
    /// the diagonal of the pixel. On simulated towns this is close to the best for the cloud's own points under suns 15° to
    /// 60° high, with pixels of 0.05 and of 0.25 m; targets in free air hardly depend on it. The paper's algorithm has no
    /// bias, so [`Profile::PaperCone`] has 0.
    #[must_use]
    #[expect(clippy::cast_possible_truncation, reason = "a length in metres")]
    pub fn default_depth_bias(&self) -> f32 {
        let pixel = 1.0 / self.view.pixels_per_metre();
        let deviation = SURFACE_DEVIATION.min(pixel) * (1.0 + SLOPE * SLOPE).sqrt();
        match self.profile {
            Profile::Sphere => (deviation + SLOPE * pixel * std::f64::consts::FRAC_1_SQRT_2) as f32,
            Profile::PaperCone => 0.0,
        }
    }
}
