//! Input of the rules: the points of a survey, the kind of each, and statistics of the whole.

use super::cells::{Cells, cell, highest, lowest_near};
use super::kinds::{Kind, kinds};
use super::spacing::{median_spacing, pulse_counts, pulse_spacing};
use crate::medium::PlantReturn;
use crate::neighbors::NeighborIndex;
use crate::normals::OrientedCloud;
use crate::pulses::{FreeSegments, Pulses};
use belvedere_data::Attributes;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Side of the blocks in which balls are pruned and thin surfaces end, metres: many times the largest ball, so that
/// little is kept twice.
pub(crate) const BLOCK: f32 = 64.0;
/// Height above the lowest return near by from which on plants take light, metres: below lie grass and the noise of the
/// ground.
const PLANTS_ABOVE: f32 = 0.5;

/// Statistics of a whole survey that rules need, so that a part of it has the balls of the whole.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RuleStatistics {
    /// True if any point has class 2, ground.
    pub has_ground: bool,
    /// True if any point has a class of vegetation, 3 to 5.
    pub has_vegetation: bool,
    /// Share of all pulses that met a crown which got through it, 0 to 1.
    pub transmission: f64,
    /// Median spacing of later returns within crowns, metres; `None` where there are none.
    pub crown_spacing: Option<f32>,
    /// Median of the mean distance between pulses over the cells of a square metre that they reach, metres; 0 where it
    /// is unknown.
    #[serde(default)]
    pub spacing: f32,
}

/// Input of carved balls. All columns have a row for each point.
#[derive(Clone, Copy)]
pub struct CarvedInput<'a> {
    /// Points and outward normals.
    pub oriented: &'a OrientedCloud,
    /// The points before they were moved onto their surface, (N, 3) local metres: they decide which block of 64 m a
    /// point belongs to.
    pub measured: &'a [[f32; 3]],
    /// Index of the same points.
    pub index: &'a NeighborIndex,
    /// Class, return number and return count are used where present.
    pub attributes: &'a Attributes,
    /// Space that the pulses prove empty.
    pub free_segments: &'a FreeSegments,
    /// Groups of returns that share a pulse, rows as in the cloud; without it no crown is measured.
    pub pulses: Option<&'a Pulses>,
    /// Statistics of the survey that the points are a part of; `None` where they are the whole.
    pub statistics: Option<&'a RuleStatistics>,
}

/// The points of a survey, or of a part of one, as rules read them. Columns have a row for each point.
pub(super) struct Survey<'a> {
    /// Points and outward normals.
    pub(super) oriented: &'a OrientedCloud,
    /// The points before they were moved onto their surface: they decide which block a point belongs to.
    pub(super) measured: &'a [[f32; 3]],
    /// Index of the points.
    pub(super) index: &'a NeighborIndex,
    /// Class, return number and return count, where present.
    pub(super) attributes: &'a Attributes,
    /// Space that the pulses prove empty.
    pub(super) free_segments: &'a FreeSegments,
    /// Kind of each point.
    pub(super) kinds: Vec<Kind>,
    /// Number of points whose kind was found by shape and not given by a class.
    pub(super) found_vegetation: usize,
    /// Number of pulses that end in each cell and its neighbours.
    pub(super) counts: Cells<u32>,
    /// Mean distance of the pulses about each point, metres.
    pub(super) spacing: Vec<f32>,
    /// Height of the lowest point in each cell and those about it.
    pub(super) lowest: Cells<f32>,
    /// Height of the highest point in each cell.
    pub(super) highest: Cells<f32>,
    /// Share of the pulses that got through the crown about each point; NaN where there is none, empty where it was not
    /// measured.
    pub(super) transmission: Vec<f32>,
    /// Rows of later returns within crowns, and their spacing, metres.
    pub(super) later_in_crowns: Vec<(usize, f32)>,
    /// Statistics of the whole survey.
    pub(super) statistics: RuleStatistics,
    /// Points that a rule represents by fills of its own: rules after it leave them alone.
    claimed: Vec<bool>,
}

impl<'a> Survey<'a> {
    /// The survey of `input`, before vegetation is found and crowns are measured. Without statistics of a whole it is
    /// the whole.
    pub(super) fn of(input: &CarvedInput<'a>) -> Self {
        let CarvedInput { oriented, measured, index, attributes, free_segments, statistics, .. } = *input;
        let positions = oriented.positions();
        let kinds = kinds(attributes, oriented.len());
        let counts = pulse_counts(positions, attributes);
        let own = || RuleStatistics {
            has_ground: kinds.contains(&Kind::Ground),
            has_vegetation: kinds.contains(&Kind::Vegetation),
            spacing: median_spacing(&counts),
            ..RuleStatistics::default()
        };
        Self {
            statistics: statistics.copied().unwrap_or_else(own),
            oriented,
            measured,
            index,
            attributes,
            free_segments,
            found_vegetation: 0,
            spacing: pulse_spacing(positions, &counts),
            counts,
            lowest: lowest_near(positions),
            highest: highest(positions),
            transmission: Vec::new(),
            later_in_crowns: Vec::new(),
            claimed: vec![false; oriented.len()],
            kinds,
        }
    }

    /// The points, (N, 3) local metres.
    pub(super) fn positions(&self) -> &'a [[f32; 3]] {
        self.oriented.positions()
    }

    /// Class of a point.
    pub(super) fn class(&self, row: usize) -> Option<u8> {
        self.attributes.classification.as_ref().and_then(|classes| classes.get(row)).copied()
    }

    /// Returns true if a point is a return after the first of its pulse.
    pub(super) fn is_later(&self, row: usize) -> bool {
        self.attributes.return_number.as_ref().and_then(|numbers| numbers.get(row)).is_some_and(|&number| number > 1)
    }

    /// Returns true if a point is neither ground nor vegetation.
    pub(super) fn is_solid(&self, row: usize) -> bool {
        matches!(self.kinds.get(row), Some(Kind::Other | Kind::Later))
    }

    /// Takes note of the points that a rule claims.
    pub(super) fn claim(&mut self, rows: impl Iterator<Item = usize>) {
        for row in rows {
            if let Some(claimed) = self.claimed.get_mut(row) {
                *claimed = true;
            }
        }
    }

    /// Returns the evidence of each return about plants. Vegetation is a plant; points of no particular class (0 and 1)
    /// may be. Points on the ground are neither.
    pub(super) fn plant_returns(&self) -> Vec<PlantReturn> {
        let of_row = |(row, (p, kind)): (usize, (&[f32; 3], &Kind))| {
            let is_low = self.lowest.get(cell(*p)).is_none_or(|lowest| p[2] < lowest + PLANTS_ABOVE);
            match (kind, self.class(row)) {
                _ if is_low => PlantReturn::Elsewhere,
                (Kind::Vegetation, _) => PlantReturn::Plant,
                (Kind::Other | Kind::Later, None | Some(0 | 1)) => PlantReturn::Perhaps,
                _ => PlantReturn::Elsewhere,
            }
        };
        self.measured.par_iter().zip(&self.kinds).enumerate().map(of_row).collect()
    }

    /// Returns true if a rule represents a point by fills of its own.
    pub(super) fn is_claimed(&self, row: usize) -> bool {
        self.claimed.get(row).copied().unwrap_or(false)
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::pulses::FreeSegmentParams;
    use belvedere_data::control::Control;

    /// A survey made of its own points and classes, whose pulses came from `scanner`, (N, 3) or empty for none.
    pub(in super::super) fn with_survey<T>(
        oriented: &OrientedCloud,
        classes: Option<Vec<u8>>,
        scanner: &[[f32; 3]],
        read: impl FnOnce(Survey<'_>) -> T,
    ) -> T {
        let none = Control::none();
        let attributes = &Attributes { classification: classes, ..Attributes::default() };
        let index = NeighborIndex::new(oriented.positions(), &none).unwrap();
        let returns = if scanner.is_empty() { &[] } else { oriented.positions() };
        let (free_segments, _) = FreeSegments::new(returns, scanner, &FreeSegmentParams::default(), &none).unwrap();
        let measured = oriented.positions();
        let input = CarvedInput {
            oriented,
            measured,
            index: &index,
            attributes,
            free_segments: &free_segments,
            pulses: None,
            statistics: None,
        };
        read(Survey::of(&input))
    }
}
