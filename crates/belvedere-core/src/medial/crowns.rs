//! Crowns of trees: the share of pulses that pass through them, and balls that fill dense ones.

use super::cells::{Cell, Cells, cell};
use super::kinds::Kind;
use super::marking_rule::{MarkingRule, Phase};
use super::marks::{Cap, Fill, FillPlace, Marks};
use super::survey::{RuleStatistics, Survey};
use crate::pulses::Pulses;
use belvedere_data::Result;
use belvedere_data::balls::MedialBalls;
use belvedere_data::control::{Control, Stop};
use belvedere_data::vector::to_f32;
use rayon::prelude::*;
use std::f32::consts::PI;

/// Points handed to a thread at once.
const CHUNK: usize = 512;
/// Maximum number of neighbours from which a spacing is taken.
const MAX_NEIGHBORS: usize = 64;

/// Representation of crowns.
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

/// Parameters of crowns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CrownParams {
    /// Representation of crowns. Default measured.
    pub trees: Trees,
    /// Minimum depth of a later return below the first of its pulse for the pulse to have passed the crown, metres,
    /// above 0. Default 2.
    pub through_depth: f32,
    /// Height above the lowest point near by below which a return lies under the crown, metres, above 0. Default 1.
    pub below_crown: f32,
    /// Pulses that the share of the whole cloud counts for in each piece of crown, above 0. Default 4: a piece has some
    /// seventy pulses at eight a square metre, and five at the edge of a sparse scan.
    pub prior_pulses: f32,
    /// Transmission from which a measured piece is one of leaves with gaps. Default 0.5: simulated crowns of single
    /// leaves measure 0.55 to 0.79 (middle 80 %), solid ones that pulses enter 0.11 to 0.41.
    pub porous_from: f32,
    /// Largest radius in measured pieces with gaps, metres. Default 0.4: as large as sprays of leaves. In towns of such
    /// trees 0.3 m lets more sun through to the streets than it should, 1 m hides more from an eye in the street.
    pub leaf_radius: f32,
    /// Largest radius where all trees are taken for porous, metres. Default 0.12: twigs. In AHN3, flown in winter, 6 %
    /// of held-out pulses are then blocked before they hit something, against 11 % with leaves.
    pub porous_radius: f32,
    /// Radius of the balls about returns within a crown that came after others, in spacings of these: the mean side of
    /// the cube that each has to itself. Default 0.7, at which balls of neighbours meet; 0.5 lets a fifth more through
    /// crowns, 0.9 blocks a fifth more beside them.
    pub later_spacings: f32,
    /// Neighbours that this spacing is taken from, 1 to 64. Default 8.
    pub later_neighbors: usize,
    /// Largest radius of balls that fill solid crowns, metres. Default 2; pulses mostly leave less than half a metre.
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

impl MarkingRule for CrownParams {
    fn stage(&self) -> Option<(Phase, &'static str)> {
        Some((Phase::Points, "marking crowns"))
    }

    /// Caps in crowns with gaps, balls centred about later returns, and fills of solid crowns.
    ///
    /// Within a crown neither the normal of a point nor the side it was seen from shows where the crown lies. A ball
    /// that is tangent there is outside the crown as often as not. Balls of later returns are therefore centred at
    /// their points. The ball of an isolated return, on a trunk, is at most as large as one of the typical spacing.
    fn marks(&self, survey: &Survey<'_>, _: &MedialBalls, _: &Control<'_>) -> Result<Marks> {
        let with_gaps = |row| self.max_radius(survey, row).map(|radius| Cap::tangent(row, radius));
        let mut caps: Vec<Cap> = (0..survey.positions().len()).filter_map(with_gaps).collect();
        let mut counts = vec![("points_in_crowns_with_gaps", caps.len())];
        let mut fills = Vec::new();
        // what is only found to be vegetation may be anything that is not flat: better neither centred nor filled
        if survey.found_vegetation == 0 {
            let centred = self.centred(survey);
            counts.push(("balls_centred_in_crowns", centred.len()));
            caps.extend(centred);
            fills = self.fills(survey);
        }
        Ok(Marks { caps, fills, counts, ..Marks::default() })
    }

    fn fills_name(&self) -> &'static str {
        "balls_in_crowns"
    }
}

impl CrownParams {
    /// Largest radius at a point of a crown with gaps, `None` at a point of a solid one or none. Crowns that were not
    /// measured are neither solid nor have gaps: nothing is known of them.
    fn max_radius(&self, survey: &Survey<'_>, row: usize) -> Option<f32> {
        if survey.kinds.get(row) != Some(&Kind::Vegetation) {
            return None;
        }
        match self.trees {
            Trees::Opaque => None,
            Trees::Porous => Some(self.porous_radius),
            Trees::Measured => {
                let has_gaps = survey.transmission.get(row).is_some_and(|&share| share >= self.porous_from);
                has_gaps.then_some(self.leaf_radius)
            }
        }
    }

    /// The balls of later returns within crowns, about their points.
    fn centred(&self, survey: &Survey<'_>) -> Vec<Cap> {
        let Some(typical) = survey.statistics.crown_spacing else { return Vec::new() };
        let cap = |&(row, spacing): &(usize, f32)| {
            let of_spacing = self.later_spacings * spacing.min(typical);
            let radius = self.max_radius(survey, row).unwrap_or(f32::INFINITY).min(of_spacing);
            Cap { is_centred: true, ..Cap::tangent(row, radius) }
        };
        survey.later_in_crowns.iter().map(cap).collect()
    }

    /// Fills of solid crowns.
    ///
    /// A crown returns pulses from its outer metre or two, so that the balls between these points are small and its
    /// inside is hollow. Here a ball hangs straight down from each first return. It is as large as the lowest
    /// vegetation within a metre or two and the pulses allow, if that exceeds the ball at that point.
    fn fills(&self, survey: &Survey<'_>) -> Vec<Fill> {
        if self.trees == Trees::Measured && survey.transmission.is_empty() {
            return Vec::new();
        }
        let positions = survey.positions();
        let is_solid = |&row: &usize| survey.kinds[row] == Kind::Vegetation && self.max_radius(survey, row).is_none();
        let solid: Vec<usize> = (0..positions.len()).filter(is_solid).collect();
        let base = solid.iter().map(|&row| (cell(positions[row]), positions[row][2])).collect();
        let base = Cells::new(base, f32::min).with_neighbors(f32::min);
        let fill = |&row: &usize| {
            let p = positions[row];
            let max_radius = ((p[2] - base.get(cell(p))?) / 2.0).min(self.fill_radius);
            Some(Fill { row, place: FillPlace::Below(p), max_radius, min_radius: 0.0 })
        };
        solid.par_iter().filter(|&&row| !survey.is_later(row)).filter_map(fill).collect()
    }
}

/// Measures which share of the pulses that met the crown about each point got through it, [`Survey::transmission`]: 0
/// to 1, NaN for points that are not vegetation.
///
/// A pulse counts where its first return is vegetation; it got through where another of its returns lies deeper by
/// [`CrownParams::through_depth`] and near the ground. Pulses are counted by cells of 1 m and their neighbours, and
/// [`CrownParams::prior_pulses`] pulses with the share of the whole survey are added.
///
/// A beam is as wide as a hand: many that got through in part would have been stopped were they thin. This is therefore
/// more than the share of straight lines that get through.
///
/// # Source
/// Counting returns under a crown against those that met it goes back to gap fractions from airborne scans (Solberg et
/// al. 2009, Remote Sensing of Environment 113); the prior is the mean of a Beta distribution.
pub(super) fn measure_transmission(
    survey: &mut Survey<'_>,
    pulses: &Pulses,
    params: &CrownParams,
    given: Option<&RuleStatistics>,
    control: &Control<'_>,
) -> Result<()> {
    let stop = Stop::new(control);
    let (positions, kinds, lowest) = (survey.positions(), &survey.kinds, &survey.lowest);
    let place = |row: u32| positions.get(row as usize).copied();
    // where the ground has its class, the lowest returns under a wide crown may still be its own
    let has_ground = given.map_or_else(|| kinds.contains(&Kind::Ground), |given| given.has_ground);
    let is_below = |top: [f32; 3], row: u32| {
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
    let whole = given.map_or(own, |given| given.transmission);
    let near = cells.with_neighbors(add);
    let prior = f64::from(params.prior_pulses);
    let of = |(&p, kind): (&[f32; 3], &Kind)| {
        if *kind != Kind::Vegetation || stop.is_set() {
            return f32::NAN;
        }
        let [met, through] = near.get(cell(p)).unwrap_or_default().map(f64::from);
        to_f32((through + prior * whole) / (met + prior))
    };
    let transmission = positions.par_iter().zip(kinds).map(of).collect();
    stop.check()?;
    survey.transmission = transmission;
    survey.statistics.transmission = whole;
    Ok(())
}

/// Measures the spacing of later returns within crowns: the mean side of the cube that each has to itself.
pub(super) fn measure_spacing(
    survey: &mut Survey<'_>,
    params: &CrownParams,
    given: Option<&RuleStatistics>,
    control: &Control<'_>,
) -> Result<()> {
    if survey.found_vegetation > 0 {
        return Ok(());
    }
    let stop = Stop::new(control);
    let is_wanted = |&row: &usize| survey.kinds[row] == Kind::Vegetation && survey.is_later(row);
    let rows: Vec<usize> = (0..survey.positions().len()).filter(is_wanted).collect();
    let count = params.later_neighbors.clamp(1, MAX_NEIGHBORS);
    let share = (4.0 / 3.0 * PI / count as f32).cbrt();
    let spacing = |&row: &usize| {
        let mut found = Vec::with_capacity(count + 2);
        if !stop.is_set() {
            survey.index.k_nearest(survey.positions()[row], count + 1, &mut found);
        }
        (row, found.last().map_or(0.0, |farthest| share * farthest.distance_squared.sqrt()))
    };
    let spacings: Vec<(usize, f32)> = rows.par_iter().with_min_len(CHUNK).map(spacing).collect();
    stop.check()?;
    let mut sorted: Vec<f32> = spacings.iter().map(|&(_, spacing)| spacing).collect();
    let middle = sorted.len() / 2;
    let own = (!sorted.is_empty()).then(|| *sorted.select_nth_unstable_by(middle, f32::total_cmp).1);
    survey.later_in_crowns = spacings;
    survey.statistics.crown_spacing = given.map_or(own, |given| given.crown_spacing);
    Ok(())
}
