//! Crowns of trees: what share of the pulses gets through them, and balls that fill those that let few through.

use super::bounds::{Kind, RadiusBounds};
use super::cells::{Cell, Cells, cell};
use super::whole_survey::WholeSurvey;
use crate::neighbors::{NeighborIndex, Tangent};
use crate::pulses::{FreeSegments, GAP_M, Pulses};
use belvedere_data::balls::{MedialBalls, NO_TOUCH, PULSE_TOUCH};
use belvedere_data::control::{Control, Stop};
use belvedere_data::{Attributes, Result};
use rayon::prelude::*;
use std::f32::consts::PI;

/// Points handed to a thread at once.
const CHUNK: usize = 512;
/// Most neighbours that a spacing is taken from.
const MOST_NEIGHBORS: usize = 64;

/// What crowns are taken for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Trees {
    /// Solid from the hull to the lowest return, as in full leaf.
    Opaque,
    /// Twigs with gaps between them, as in winter: balls of [`CrownParams::porous_radius`] at most.
    Porous,
    /// Each piece as the pulses found it: leaves with gaps where they get through, solid where they do not.
    #[default]
    Measured,
}

impl Trees {
    /// Every way.
    pub const ALL: [Self; 3] = [Self::Opaque, Self::Porous, Self::Measured];

    /// Name on the command line and in Python.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Opaque => "opaque",
            Self::Porous => "porous",
            Self::Measured => "measured",
        }
    }
}

/// How crowns are represented.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CrownParams {
    /// What they are taken for. Default measured.
    pub trees: Trees,
    /// How much deeper than the first return of a pulse a later one must lie for it to have got through, metres, above 0. Default
    /// 2.
    pub through_depth: f32,
    /// Height above the lowest point near by below which a return lies under the crown, metres, above 0. Default 1.
    pub below_crown: f32,
    /// Pulses that the share of the whole cloud counts for in each piece of crown, above 0. Default 4: a piece has some
    /// seventy pulses at eight a square metre, and five at the rim of a sparse scan.
    pub prior_pulses: f32,
    /// Transmission from which a measured piece is one of leaves with gaps. Default 0.5: simulated crowns of single leaves measure
    /// 0.55 to 0.79 (middle 80 %), solid ones that pulses enter 0.11 to 0.41.
    pub porous_from: f32,
    /// Most radius in measured pieces with gaps, metres. Default 0.4: as large as sprays of leaves. In towns of such trees
    /// 0.3 m lets more sun through to the streets than it should, 1 m hides more from an eye in the street.
    pub leaf_radius: f32,
    /// Most radius where all trees are taken for porous, metres. Default 0.12: twigs. In AHN3, flown in winter, 6 % of
    /// held-out pulses are then blocked before they hit something, against 11 % with leaves.
    pub porous_radius: f32,
    /// Radius of the balls about returns within a crown that came after others, in spacings of these: the mean side of the cube that each has
    /// to itself. Default 0.7, at which balls of neighbours meet; 0.5 lets a fifth more through crowns, 0.9 blocks a fifth more
    /// beside them.
    pub later_spacings: f32,
    /// Neighbours that this spacing is taken from, 1 to 64. Default 8.
    pub later_neighbors: usize,
    /// Most radius of balls that fill solid crowns, metres. Default 2; pulses mostly leave less than half a metre.
    pub fill_radius: f32,
}

impl Default for CrownParams {
    fn default() -> Self {
        Self {
            trees: Trees::Measured,
            through_depth: 2.0,
            below_crown: 1.0,
            prior_pulses: 4.0,
            porous_from: 0.5,
            leaf_radius: 0.4,
            porous_radius: 0.12,
            later_spacings: 0.7,
            later_neighbors: 8,
            fill_radius: 2.0,
        }
    }
}

/// Share of the pulses that met the crown about each point and got through it, (N), 0 to 1; NaN for points that are not
/// vegetation.
///
/// A pulse counts where its first return is vegetation; it got through where another of its returns lies deeper by
/// [`CrownParams::through_depth`] and near the ground. Pulses are counted by cells of 1 m and their neighbours, and
/// [`CrownParams::prior_pulses`] pulses with the share of the whole cloud are added, which is given where the cloud is a part of another, and
/// returned. `lowest` is [`super::cells::lowest_near`].
///
/// A beam is as wide as a hand: many that got through in part would have been stopped were they thin. This is therefore more
/// than the share of straight lines that get through.
///
/// # Source
/// Counting returns under a crown against those that met it goes back to gap fractions from airborne scans (Solberg et al. 2009,
/// Remote Sensing of Environment 113); the prior is the mean of a Beta distribution.
pub(super) fn transmission(
    positions: &[[f32; 3]],
    kinds: &[Kind],
    lowest: &Cells<f32>,
    pulses: &Pulses,
    params: &CrownParams,
    whole: Option<&WholeSurvey>,
    control: &Control<'_>,
) -> Result<(Vec<f32>, f64)> {
    let stop = Stop::new(control);
    let place = |row: u32| positions.get(row as usize).copied();
    let has_ground = whole.map_or_else(|| kinds.contains(&Kind::Ground), |whole| whole.has_ground);
    let is_below = |top: [f32; 3], row: u32| {
        // where the ground has its class, the lowest returns under a wide crown may still be its own
        let may_be_below = !has_ground || kinds.get(row as usize) != Some(&Kind::Vegetation);
        let is_low = |p: [f32; 3]| lowest.get(cell(p)).is_some_and(|lowest| p[2] < lowest + params.below_crown);
        may_be_below && place(row).is_some_and(|p| p[2] < top[2] - params.through_depth && is_low(p))
    };
    let met = |pulse: usize| -> Option<(Cell, [u32; 2])> {
        if stop.is_set() {
            return None;
        }
        let first = pulses.first_return(pulse)?;
        if kinds.get(first as usize) != Some(&Kind::Vegetation) {
            return None;
        }
        let top = place(first)?;
        let through = pulses.returns_of(pulse).iter().any(|&row| is_below(top, row));
        Some((cell(top), [1, u32::from(through)]))
    };
    let add = |a: [u32; 2], b: [u32; 2]| [a[0] + b[0], a[1] + b[1]];
    let cells = Cells::new((0..pulses.len()).into_par_iter().filter_map(met).collect(), add);
    stop.check()?;
    let [all, through] = cells.all(add).unwrap_or_default().map(f64::from);
    let own = if all > 0.0 { through / all } else { 0.0 };
    let whole = whole.map_or(own, |whole| whole.transmission);
    let near = cells.with_neighbors(add);
    let prior = f64::from(params.prior_pulses);
    let of = |(&p, kind): (&[f32; 3], &Kind)| {
        if *kind != Kind::Vegetation || stop.is_set() {
            return f32::NAN;
        }
        let [met, through] = near.get(cell(p)).unwrap_or_default().map(f64::from);
        #[expect(clippy::cast_possible_truncation, reason = "a share")]
        let share = ((through + prior * whole) / (met + prior)) as f32;
        share
    };
    let transmission = positions.par_iter().zip(kinds).map(of).collect();
    stop.check()?;
    Ok((transmission, whole))
}

/// What is known of the crowns of a cloud.
pub(super) struct Crowns<'a> {
    pub(super) positions: &'a [[f32; 3]],
    pub(super) kinds: &'a [Kind],
    pub(super) attributes: &'a Attributes,
    /// As [`transmission`] gives it, empty where it is not known.
    pub(super) transmission: &'a [f32],
    pub(super) params: &'a CrownParams,
}

impl Crowns<'_> {
    /// Most radius at a point of a crown with gaps, `None` at a point of a solid one or none. Crowns that were not measured are
    /// neither solid nor have gaps: nothing is known of them.
    fn most_radius(&self, row: usize) -> Option<f32> {
        if self.kinds.get(row) != Some(&Kind::Vegetation) {
            return None;
        }
        match self.params.trees {
            Trees::Opaque => None,
            Trees::Porous => Some(self.params.porous_radius),
            Trees::Measured => {
                let has_gaps = self.transmission.get(row).is_some_and(|&share| share >= self.params.porous_from);
                has_gaps.then_some(self.params.leaf_radius)
            }
        }
    }

    /// Cuts the radii in crowns with gaps, and says of how many balls.
    pub(super) fn limit(&self, bounds: &mut RadiusBounds) -> usize {
        let mut count = 0;
        for row in 0..self.positions.len() {
            if let Some(most) = self.most_radius(row) {
                bounds.limit(row, most);
                count += 1;
            }
        }
        count
    }

    /// Puts the balls of later returns within crowns about their points, as large as the pulses leave them, and says how many.
    ///
    /// Within a crown neither the normal of a point nor the side it was seen from says where the crown lies: a ball that is tangent there
    /// stands out of it as often as not. Row i of `balls` must be that of point i, which `index` holds. A return that
    /// lies alone, on a trunk, has no larger a ball than one of the typical spacing, which is given where the cloud is a part of another, and
    /// returned.
    ///
    /// # Errors
    /// [`Error::Cancelled`](belvedere_data::Error::Cancelled).
    pub(super) fn centre(
        &self,
        balls: &mut MedialBalls,
        index: &NeighborIndex,
        needles: &FreeSegments,
        whole: Option<&WholeSurvey>,
        control: &Control<'_>,
    ) -> Result<(usize, Option<f32>)> {
        let stop = Stop::new(control);
        let numbers = self.attributes.return_number.as_deref().unwrap_or_default();
        let is_later = |row: usize| numbers.get(row).is_some_and(|&number| number > 1);
        let rows: Vec<usize> =
            (0..self.positions.len()).filter(|&row| self.kinds[row] == Kind::Vegetation && is_later(row)).collect();
        let count = self.params.later_neighbors.clamp(1, MOST_NEIGHBORS);
        #[expect(clippy::cast_precision_loss, reason = "at most 64")]
        let share = (4.0 / 3.0 * PI / count as f32).cbrt();
        let spacing = |&row: &usize| {
            let mut found = Vec::with_capacity(count + 2);
            if !stop.is_set() {
                index.k_nearest(self.positions[row], count + 1, &mut found);
            }
            found.last().map_or(0.0, |farthest| share * farthest.distance_squared.sqrt())
        };
        let spacings: Vec<f32> = rows.par_iter().with_min_len(CHUNK).map(spacing).collect();
        let mut sorted = spacings.clone();
        let middle = sorted.len() / 2;
        let own = (!sorted.is_empty()).then(|| *sorted.select_nth_unstable_by(middle, f32::total_cmp).1);
        let typical = whole.map_or(own, |whole| whole.crown_spacing);
        let (Some(_), Some(typical)) = (own, typical) else { return Ok((0, typical)) };
        let radius = |(&row, &spacing): (&usize, &f32)| {
            let most =
                self.most_radius(row).unwrap_or(f32::INFINITY).min(self.params.later_spacings * spacing.min(typical));
            if stop.is_set() { 0.0 } else { needles.clearance(self.positions[row], most) }
        };
        let radii: Vec<f32> = rows.par_iter().zip(&spacings).with_min_len(CHUNK).map(radius).collect();
        stop.check()?;
        for (&row, radius) in rows.iter().zip(radii) {
            balls.centers[row] = self.positions[row];
            balls.radii[row] = radius;
            balls.separation_angles[row] = f32::NAN;
            // what the pulses leave nothing of blocks nothing
            balls.touch[row] = if radius > 0.0 { PULSE_TOUCH } else { NO_TOUCH };
        }
        Ok((rows.len(), Some(typical)))
    }

    /// Adds balls that fill solid crowns, and says how many.
    ///
    /// A crown returns pulses from all through its outer metre or two, which leaves the balls between these points small and its
    /// inside hollow. Here a ball hangs straight down from each first return, as large as the lowest vegetation within a metre
    /// or two and the pulses leave it, if that is more than the ball at that point.
    ///
    /// # Errors
    /// [`Error::Cancelled`](belvedere_data::Error::Cancelled).
    pub(super) fn fill(&self, balls: &mut MedialBalls, needles: &FreeSegments, control: &Control<'_>) -> Result<usize> {
        let stop = Stop::new(control);
        if self.params.trees == Trees::Measured && self.transmission.is_empty() {
            return Ok(0);
        }
        let solid: Vec<usize> = (0..self.positions.len())
            .filter(|&row| self.kinds[row] == Kind::Vegetation && self.most_radius(row).is_none())
            .collect();
        let base = solid.iter().map(|&row| (cell(self.positions[row]), self.positions[row][2])).collect();
        let base = Cells::new(base, f32::min).with_neighbors(f32::min);
        let numbers = self.attributes.return_number.as_deref();
        let is_first = |row: usize| numbers.and_then(|numbers| numbers.get(row)).is_none_or(|&number| number <= 1);
        let ball = |&row: &usize| {
            let p = self.positions[row];
            let most = ((p[2] - base.get(cell(p))?) / 2.0).min(self.params.fill_radius);
            if !is_first(row) || most <= balls.radii[row] || stop.is_set() {
                return None;
            }
            let hanging = Tangent { point: p, inward: [0.0, 0.0, -1.0], margin: 0.0 };
            let empty = needles.smallest_tangent_ball(&hanging, most);
            let radius = empty.map_or(most, |empty| empty - GAP_M);
            (radius > balls.radii[row]).then_some((row, [p[0], p[1], p[2] - radius - GAP_M], radius))
        };
        let found: Vec<_> = solid.par_iter().filter_map(ball).collect();
        stop.check()?;
        for &(row, center, radius) in &found {
            balls.push(row, center, radius, PULSE_TOUCH);
        }
        Ok(found.len())
    }
}
