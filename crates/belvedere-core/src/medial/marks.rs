//! Marks of the rules and their execution: a radius is capped, a ball is cut, a place is filled.

use super::kinds::{Kind, KindCaps};
use super::survey::Survey;
use crate::neighbors::Tangent;
use crate::normals::OrientedCloud;
use crate::pulses::{FreeSegments, GAP_M};
use belvedere_data::balls::{MedialBalls, NO_TOUCH, PULSE_TOUCH};
use belvedere_data::control::{Control, Stop};
use belvedere_data::{Attributes, Result};
use rayon::prelude::*;

/// Fills, or balls, handed to a thread at once.
const CHUNK: usize = 512;

/// Marks of one rule.
#[derive(Debug, Default)]
pub(super) struct Marks {
    /// Balls with a smaller radius because of the kind of their point.
    pub(super) caps: Vec<Cap>,
    /// Balls that reach into places known to be empty.
    pub(super) cuts: Vec<Cut>,
    /// Places that are known to be solid.
    pub(super) fills: Vec<Fill>,
    /// Names and numbers for the report.
    pub(super) counts: Vec<(&'static str, usize)>,
}

/// The largest radius of the ball at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cap {
    /// Row of the point.
    pub(super) row: usize,
    /// Metres, 0 or more.
    pub(super) radius: f32,
    /// True if the ball is centred at the point, as large as the pulses allow, instead of tangent there.
    pub(super) is_centred: bool,
    /// True if the rule fills here, so that later rules skip the point.
    pub(super) is_claimed: bool,
}

impl Cap {
    /// A tangent ball of at most this radius.
    pub(super) fn tangent(row: usize, radius: f32) -> Self {
        Self { row, radius, is_centred: false, is_claimed: false }
    }
}

/// New radius of the ball at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cut {
    /// Row of the point.
    pub(super) row: usize,
    /// Metres; `None` where nothing of it is needed.
    pub(super) radius: Option<f32>,
}

/// A ball at a place that is known to be solid, as large as the pulses leave it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fill {
    /// Row of the point that tells of the place.
    pub(super) row: usize,
    /// Position of the ball.
    pub(super) place: FillPlace,
    /// Largest radius, metres.
    pub(super) max_radius: f32,
    /// Radius below which the ball is left out, metres.
    pub(super) min_radius: f32,
}

/// Position of a fill, local metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum FillPlace {
    /// Around this centre.
    Center([f32; 3]),
    /// Hanging down from this place, and larger than the ball at its point.
    Below([f32; 3]),
}

/// Largest radius of each ball, metres. Rules only ever tighten it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RadiusCaps {
    /// To which a ball is cut, (N); +∞ for no limit.
    pub radii: Vec<f32>,
    /// To which a ball is cut that neither a point nor a pulse bounds, metres.
    pub unbounded: f32,
    /// True for balls that are centred at their point, (N); empty if there are none.
    pub(super) is_centred: Vec<bool>,
}

impl RadiusCaps {
    /// Caps by the kind of point, for points with these attributes about which pulses are `spacing` apart, (N), metres.
    #[must_use]
    pub fn by_kind(kinds: &[Kind], attributes: &Attributes, spacing: &[f32], params: &KindCaps) -> Self {
        let is_later = |row: usize| {
            attributes.return_number.as_ref().and_then(|numbers| numbers.get(row)).is_some_and(|&number| number > 1)
        };
        let radius = |(row, (kind, &spacing)): (usize, (&Kind, &f32))| match kind {
            Kind::Ground => params.ground_radius,
            Kind::Vegetation if is_later(row) => params.vegetation_radius.min(params.later_return_spacings * spacing),
            Kind::Vegetation => params.vegetation_radius,
            Kind::Later => params.later_return_spacings * spacing,
            Kind::Other => f32::INFINITY,
        };
        let radii = kinds.iter().zip(spacing).enumerate().map(radius).collect();
        Self { radii, unbounded: params.unbounded_radius, is_centred: Vec::new() }
    }

    /// Reduces the radii by the caps of a rule.
    pub(super) fn tighten(&mut self, caps: &[Cap]) {
        for cap in caps {
            let Some(radius) = self.radii.get_mut(cap.row) else { continue };
            if cap.is_centred {
                self.is_centred.resize(self.radii.len(), false);
                self.is_centred[cap.row] = true;
                self.radii[cap.row] = cap.radius;
            } else {
                *radius = radius.min(cap.radius);
            }
        }
    }
}

/// The cuts of all balls larger than `min_radius` that `left` leaves less of; it is given the row of a ball, which is
/// that of its point.
///
/// # Errors
/// [`Error::Cancelled`](belvedere_data::Error::Cancelled).
pub(super) fn cuts_of(
    balls: &MedialBalls,
    min_radius: f32,
    control: &Control<'_>,
    left: impl Fn(usize) -> f32 + Sync,
) -> Result<Vec<Cut>> {
    let stop = Stop::new(control);
    let is_usable = |row: usize| balls.touch[row] != NO_TOUCH && balls.radii[row] > min_radius && !stop.is_set();
    let rows = (0..balls.len()).into_par_iter().with_min_len(CHUNK).filter(|&row| is_usable(row));
    let cut = |row: usize| Some(left(row)).filter(|&r| r < balls.radii[row]).map(|r| Cut { row, radius: Some(r) });
    let cuts = rows.filter_map(cut).collect();
    stop.check()?;
    Ok(cuts)
}

/// Cuts `balls`, row i of which is the interior ball of point i of `oriented`.
pub(super) fn cut(balls: &mut MedialBalls, oriented: &OrientedCloud, cuts: &[Cut]) {
    for &Cut { row, radius } in cuts {
        let Some(radius) = radius else {
            balls.touch[row] = NO_TOUCH;
            continue;
        };
        let (p, n) = (oriented.positions()[row], oriented.normals()[row]);
        balls.radii[row] = radius;
        balls.centers[row] = std::array::from_fn(|i| p[i] - n[i] * radius);
        balls.touch[row] = PULSE_TOUCH;
        balls.separation_angles[row] = f32::NAN;
    }
}

/// Adds the balls of `fills` as far as the pulses leave them, and says how many. The first balls are those of the
/// points of `survey`.
///
/// # Errors
/// [`Error::Cancelled`](belvedere_data::Error::Cancelled).
pub(super) fn fill(
    balls: &mut MedialBalls,
    survey: &Survey<'_>,
    fills: &[Fill],
    control: &Control<'_>,
) -> Result<usize> {
    let stop = Stop::new(control);
    let ball = |fill: &Fill| {
        let own = balls.radii.get(fill.row).copied().unwrap_or_default();
        fill.ball(survey.free_segments, own).filter(|_| !stop.is_set())
    };
    let found: Vec<_> = fills.par_iter().with_min_len(CHUNK).map(ball).collect();
    stop.check()?;
    let before = balls.len();
    for (fill, ball) in fills.iter().zip(found) {
        if let Some((center, radius)) = ball {
            balls.push(fill.row, center, radius, PULSE_TOUCH);
        }
    }
    Ok(balls.len() - before)
}

impl Fill {
    /// Centre and radius of the ball after cutting by pulses, if large enough. The ball at its point has the radius
    /// `own`.
    fn ball(&self, free_segments: &FreeSegments, own: f32) -> Option<([f32; 3], f32)> {
        let most = self.max_radius;
        match self.place {
            FillPlace::Center(center) => {
                let radius = free_segments.clearance(center, most);
                (radius >= self.min_radius).then_some((center, radius))
            }
            FillPlace::Below(point) if most > own => {
                let hanging = Tangent { point, inward: [0.0, 0.0, -1.0], margin: 0.0 };
                let empty = free_segments.smallest_tangent_ball(&hanging, most);
                let radius = empty.map_or(most, |empty| empty - GAP_M);
                let [x, y, z] = point;
                (radius > own && radius >= self.min_radius).then_some(([x, y, z - radius - GAP_M], radius))
            }
            FillPlace::Below(_) => None,
        }
    }
}
