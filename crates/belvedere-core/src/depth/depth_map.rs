//! The depth map and its one constructor.

use super::central::{self, Central};
use super::parallel::{self, Parallel};
use super::tiles::{self, ItemBuffer};
use crate::blocking::{Ball, Profile, SLOPE, SURFACE_DEVIATION, holds_at};
use crate::medial::{MedialBalls, NO_TOUCH};
use belvedere_data::control::Control;
use belvedere_data::raster::Raster;
use belvedere_data::vector::to_f32;
use belvedere_data::view::{Projection, View};
use belvedere_data::{Error, Parameter, Result};
use rayon::prelude::*;

/// Depth along each pixel of a view.
#[derive(Clone, Debug, PartialEq)]
pub struct DepthMap {
    /// The view it was made for.
    pub view: View,
    /// The surface that was drawn.
    pub profile: Profile,
    /// Depth in metres: along the view's forward vector, from its picture plane or its eye, and straight from the eye
    /// for [`Projection::Hemispherical`]; +∞ where nothing is hit.
    pub depth: Raster<f32>,
    /// Row of the ball each pixel shows, [`NO_BALL`](super::NO_BALL) where nothing is hit; of equally near balls the
    /// one with the lowest row. Only where requested.
    pub balls: Option<Raster<u32>>,
    /// Balls that hold the eye of a view: left out, so that a wrong ball does not blind it.
    pub around_eye_count: usize,
}

/// Draws the depth map of `balls` in `view`. Balls that never shrank, or whose centre or radius is not finite, are left
/// out. Balls that hold the eye of the view (its distance to their centre is at most their radius) are left out and
/// counted.
///
/// Cost: reading every ball once, then work in proportion to the visible ones. Balls are drawn tile by tile from front
/// to back, and blocks of pixels that are already nearer than any depth of a ball are skipped. The result is the same
/// for any number of threads and any order of balls.
///
/// # Errors
/// [`Error::LengthMismatch`] for columns of unequal length, [`Error::InvalidParameter`] for 2³² balls or more, and for
/// [`Profile::PaperCone`] in a view that is not parallel, and [`Error::Cancelled`].
///
/// # Source
/// Peters, Ledoux & Biljecki 2015, section 3.2 and Algorithm 1 (`WRITEBALL`). [`Profile::PaperCone`] is the printed
/// form and [`Profile::Sphere`] the corrected one: the printed depth describes a cone inside the ball. Skipping hidden
/// blocks: Greene, Kass & Miller 1993.
pub fn depth_map(
    balls: &MedialBalls,
    view: &View,
    profile: Profile,
    items: ItemBuffer,
    control: &Control<'_>,
) -> Result<DepthMap> {
    balls.validate()?;
    if u32::try_from(balls.len()).is_err() {
        return Err(Error::invalid(Parameter::BallCount, balls.len(), "below 2^32"));
    }
    let usable = |i: usize| {
        let (center, radius) = (balls.centers[i], balls.radii[i]);
        (balls.touch[i] != NO_TOUCH && radius > 0.0 && radius.is_finite()).then_some(Ball { center, radius })
    };
    let (size, count) = (view.size_px, balls.len());
    let drawn = match (view.projection, profile) {
        (Projection::Orthographic { pixels_per_metre }, Profile::Sphere) => tiles::draw(
            &Parallel::new(view, pixels_per_metre, parallel::ParallelSphere),
            size,
            count,
            usable,
            items,
            control,
        ),
        (Projection::Orthographic { pixels_per_metre }, Profile::PaperCone) => {
            let cone = parallel::Cone { pixels_per_metre: to_f32(pixels_per_metre) };
            tiles::draw(&Parallel::new(view, pixels_per_metre, cone), size, count, usable, items, control)
        }
        (_, Profile::Sphere) => {
            tiles::draw(&Central::new(view, central::CentralSphere), size, count, usable, items, control)
        }
        (_, Profile::PaperCone) => {
            return Err(Error::invalid(
                Parameter::BallProfile,
                "the paper's cone in a view from an eye",
                "the sphere; the paper defines its cone for parallel views only",
            ));
        }
    }?;
    let around_eye_count = if view.is_central() {
        let holds_eye = |ball: &Ball| {
            let square: f64 = view.frame.view_from_local(ball.center).map(|v| v * v).iter().sum();
            holds_at(f64::from(ball.radius), square.sqrt())
        };
        (0..count).into_par_iter().with_min_len(1 << 13).filter_map(usable).filter(holds_eye).count()
    } else {
        0
    };
    Ok(DepthMap { view: *view, profile, depth: drawn.0, balls: drawn.1, around_eye_count })
}

impl DepthMap {
    /// The bias, metres, by which a target may lie behind the depth of its pixel and still count as visible, unless the
    /// caller knows better.
    ///
    /// A target on a surface lies behind the depth at its pixel's centre by the deviation of noise and balls along the
    /// normal, seen at a slope of 2. That is 0.1 m, or a pixel if pixels are finer, as for small objects. Half the
    /// diagonal of the pixel times that slope is added. On simulated towns this is close to the best for the cloud's
    /// own points, under suns 15° to 60° high, with pixels of 0.05 and of 0.25 m. Targets in free air hardly depend on
    /// it.
    ///
    /// The paper's algorithm has no bias, so [`Profile::PaperCone`] has 0. In views from an eye, where pixels widen
    /// with the range, it is that of a pixel at the mean visible range. Use exact lines of sight where that matters.
    #[must_use]
    pub fn default_depth_bias(&self) -> f32 {
        let range = if self.view.is_central() { self.mean_depth() } else { 0.0 };
        let pixel = self.view.pixel_width(range);
        let deviation = SURFACE_DEVIATION.min(pixel) * (1.0 + SLOPE * SLOPE).sqrt();
        match self.profile {
            Profile::Sphere => to_f32(deviation + SLOPE * pixel * std::f64::consts::FRAC_1_SQRT_2),
            Profile::PaperCone => 0.0,
        }
    }

    /// Mean depth of the pixels that show something, metres; 0 where none does.
    fn mean_depth(&self) -> f64 {
        let seen = self.depth.values().iter().filter(|depth| depth.is_finite());
        let (sum, count) = seen.fold((0.0, 0usize), |(sum, count), &depth| (sum + f64::from(depth), count + 1));
        sum / count.max(1) as f64
    }
}
