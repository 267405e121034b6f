//! Survey plan: places to scan again, so that unproven lines of sight of a question become proven.
//!
//! A line is unproven because no pulse came near to pieces of it. These pieces are cut into *places*. A scan from a
//! candidate is simulated in the model: along each of its ways runs a pulse up to the first surface. A place is proven
//! if a pulse passes near to it and returns. A line is *settled* when no more of it is unproven than
//! [`Proof::tolerance`](belvedere_core::query::Proof::tolerance).
//!
//! Stations are chosen by [`place_cameras`]: places and lines are its targets.

mod scanner;
mod virtual_scan;

pub use scanner::{STATION_HEIGHT, ScannerParams};

use crate::cameras::{CoverageTable, Goal, Placement, PlacementParams, place_cameras};
use belvedere_core::ground::Ground;
use belvedere_core::query::{MedialScene, Proof};
use belvedere_data::cast::to_i64;
use belvedere_data::control::Control;
use belvedere_data::vector::{length, sub};
use belvedere_data::{Error, Result};
use rayon::prelude::*;
use std::collections::HashMap;
use virtual_scan::{LEVELS, ScannedSpace, SeenCells, VirtualScan, ways_around};

/// Side of the cells in which unproven pieces of lines are one place, as a share of how near a pulse must pass.
const CELL_PER_NEARNESS: f64 = 0.5;
/// Share of the worth of a line that its proven share counts for. The rest counts for a station that settles the line
/// alone.
const WORTH_OF_SHARE: f64 = 0.25;
/// Probability that nothing stands in the unseen space that pulses must pass, for each level of it ([`LEVELS`]).
const CHANCES: [f64; LEVELS.len()] = [0.75, 0.5, 0.2];

/// Proof of unproven lines by stations.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SurveyGain {
    /// Lines that become proven, if nothing stands in the space that no pulse saw.
    pub settled: usize,
    /// Expected number of lines that become proven. Objects may stand in the space that no pulse saw.
    pub expected: f64,
    /// Length of unproven pieces that is proven, over all lines, metres.
    pub proven: f64,
}

/// Chosen stations with their expected gains.
#[derive(Clone, Debug, PartialEq)]
pub struct SurveyPlan {
    /// Candidates that were chosen, those that add most first.
    pub chosen: Vec<usize>,
    /// Gain of the first stations together, (chosen + 1), beginning with that of no station.
    pub curve: Vec<SurveyGain>,
    /// Gain of each candidate alone.
    pub alone: Vec<SurveyGain>,
    /// Gain of all candidates together.
    pub reachable: SurveyGain,
    /// Unproven length of all lines, metres.
    pub unproven: f64,
    /// Maximum gap between the worth of the choice and the best possible, as a share of the latter.
    pub gap: f64,
}

/// Unproven pieces of lines, cut into places.
struct OpenSpace {
    /// Local metres.
    places: Vec<[f64; 3]>,
    lines: Vec<OpenLine>,
    /// Unproven length of a line that is settled even so, metres.
    tolerance: f64,
}

/// Unproven part of a line.
struct OpenLine {
    /// Places on it, and the length of the line that each represents, metres.
    parts: Vec<(usize, f64)>,
    length: f64,
    /// Through how much unseen space it runs itself.
    level: usize,
}

/// Places that a station proves, each with the level of unseen space before it.
type ProvenPlaces = Vec<(u32, u8)>;

/// The level of a place that is not proven.
const NOT_PROVEN: u8 = u8::MAX;

impl OpenLine {
    fn new(parts: Vec<(usize, f64)>) -> Self {
        let length = parts.iter().map(|(_, length)| length).sum();
        let level = LEVELS.iter().position(|most| length <= *most).unwrap_or(LEVELS.len() - 1);
        Self { parts, length, level }
    }

    /// Returns the length of it that is proven through at most `most` levels of unseen space.
    fn proven_length(&self, levels: &[u8], most: usize) -> f64 {
        let is_proven = |place: usize| usize::from(levels[place]) <= most;
        self.parts.iter().filter(|(place, _)| is_proven(*place)).map(|(_, length)| length).sum()
    }
}

impl OpenSpace {
    fn of(lines: &[Vec<[[f64; 3]; 2]>], proof: &Proof) -> Self {
        let side = CELL_PER_NEARNESS * proof.nearness();
        let (mut places, mut by_cell) = (Vec::new(), HashMap::new());
        let mut open_line = |pieces: &Vec<[[f64; 3]; 2]>| {
            let mut parts = Vec::new();
            for &[from, to] in pieces {
                let along = sub(to, from);
                let size = length(along);
                let count = (size / side).ceil().max(1.0);
                let middles = (0..).map(f64::from).take_while(|number| *number < count);
                for at in middles.map(|number| (number + 0.5) / count) {
                    let place: [f64; 3] = std::array::from_fn(|i| from[i] + at * along[i]);
                    let cell = place.map(|v| to_i64((v / side).floor()));
                    let number = *by_cell.entry(cell).or_insert_with(|| {
                        places.push(place);
                        places.len() - 1
                    });
                    parts.push((number, size / count));
                }
            }
            OpenLine::new(parts)
        };
        let lines = lines.iter().map(&mut open_line).collect();
        Self { places, lines, tolerance: proof.tolerance() }
    }

    /// The lowest level at which a line is settled where places are proven at these levels.
    fn settled_level(&self, line: &OpenLine, levels: &[u8]) -> Option<usize> {
        (line.level..LEVELS.len()).find(|&most| line.length - line.proven_length(levels, most) <= self.tolerance)
    }

    /// The best level of each place for several stations together.
    fn levels<'a>(&self, stations: impl Iterator<Item = &'a ProvenPlaces>) -> Vec<u8> {
        let mut levels = vec![NOT_PROVEN; self.places.len()];
        for &(place, level) in stations.flatten() {
            let best = &mut levels[place as usize];
            *best = level.min(*best);
        }
        levels
    }

    fn gain(&self, levels: &[u8]) -> SurveyGain {
        let mut gain = SurveyGain::default();
        for line in &self.lines {
            if let Some(level) = self.settled_level(line, levels) {
                gain.settled += 1;
                gain.expected += CHANCES[level];
            }
            gain.proven += line.proven_length(levels, LEVELS.len() - 1);
        }
        gain
    }

    /// Returns the targets that a station covers: a target for each place and level, then one for each line and level.
    /// A target proven through little unseen space is proven at higher levels as well.
    fn covered_targets(&self, proven: &ProvenPlaces) -> Vec<usize> {
        let from = |number: usize, level: usize| (level..LEVELS.len()).map(move |level| number * LEVELS.len() + level);
        let levels = self.levels(std::iter::once(proven));
        let settled = |(row, line): (usize, &OpenLine)| {
            let level = self.settled_level(line, &levels)?;
            Some(from(self.places.len() + row, level))
        };
        let places = proven.iter().flat_map(|&(place, level)| from(place as usize, usize::from(level)));
        places.chain(self.lines.iter().enumerate().filter_map(settled).flatten()).collect()
    }

    /// Returns the weight of each of these targets: for a line that is proven at a level, the sum from there on is its
    /// probability.
    fn weights(&self) -> Vec<f64> {
        let next = |level: usize| CHANCES.get(level + 1).copied().unwrap_or(0.0);
        let mut weights = vec![0.0; (self.places.len() + self.lines.len()) * LEVELS.len()];
        for (row, line) in self.lines.iter().enumerate() {
            for level in line.level..LEVELS.len() {
                let worth = CHANCES[level] - next(level);
                for &(place, length) in &line.parts {
                    weights[place * LEVELS.len() + level] += WORTH_OF_SHARE * worth * length / line.length;
                }
                weights[(self.places.len() + row) * LEVELS.len() + level] = (1.0 - WORTH_OF_SHARE) * worth;
            }
        }
        weights
    }
}

/// Chooses `count` of `candidates`. Each candidate has the places that it is scanned from, local metres: one of a
/// tripod, several of a flight line; a place that is not finite is not used. `lines` are the unproven lines of sight of
/// a question, each with the pieces that no pulse came near to ([`MedialScene::unproven_pieces`]). They must be longer
/// than the tolerance of the proof of `scene`. Beyond the model, pulses return from the level of `ground` below the
/// station. Control counts candidates. The result is the same for any number of threads.
///
/// # Errors
/// [`Error::MissingAttribute`] for a scene without pulses, those of [`ScannerParams::validate`] and of
/// [`place_cameras`], and [`Error::Cancelled`].
pub fn plan_survey(
    (scene, ground): (&MedialScene, Option<&Ground>),
    candidates: &[Vec<[f64; 3]>],
    lines: &[Vec<[[f64; 3]; 2]>],
    count: usize,
    params: &ScannerParams,
    control: &Control<'_>,
) -> Result<SurveyPlan> {
    params.validate()?;
    let proof = scene.proof().ok_or_else(missing_pulses)?;
    let open = OpenSpace::of(lines, proof);
    let seen = SeenCells::around(proof, candidates.iter().flatten().chain(&open.places));
    let (nearness, around) = (proof.nearness(), ways_around());
    let space = ScannedSpace { scene, ground, seen, params, nearness, around };
    let proven_from = |&eye: &[f64; 3]| {
        control.check()?;
        let Some(mut scan) = VirtualScan::new(&space, eye) else { return Ok(Vec::new()) };
        let mut level = |place: &[f64; 3]| u8::try_from(scan.level(*place)?).ok();
        Ok((0..).zip(&open.places).filter_map(|(row, place)| Some((row, level(place)?))).collect())
    };
    let proven_by = |places: &Vec<[f64; 3]>| {
        let of_places: Vec<ProvenPlaces> = places.par_iter().map(proven_from).collect::<Result<_>>()?;
        control.advance(1);
        let levels = open.levels(of_places.iter());
        Ok((0..).zip(levels).filter(|(_, level)| *level != NOT_PROVEN).collect())
    };
    let proven: Vec<ProvenPlaces> = candidates.par_iter().map(proven_by).collect::<Result<_>>()?;
    let covered: Vec<Vec<usize>> = proven.par_iter().map(|proven| open.covered_targets(proven)).collect();
    let weights = open.weights();
    let table = CoverageTable::of_lists(weights.len(), &covered)?;
    // exchanges find what a search would, and the bound says how much could be missing
    let params = PlacementParams::new(Goal::Count(count)).with_search_limit(Some(0));
    let placed: Option<Placement> =
        (!lines.is_empty()).then(|| place_cameras(&table, &weights, &params, control)).transpose()?;
    let chosen = placed.as_ref().map_or_else(Vec::new, |placed| placed.chosen.clone());
    let together = |first: usize| open.gain(&open.levels(chosen[..first].iter().map(|&row| &proven[row])));
    Ok(SurveyPlan {
        curve: (0..=chosen.len()).map(together).collect(),
        alone: proven.par_iter().map(|proven| open.gain(&open.levels(std::iter::once(proven)))).collect(),
        reachable: open.gain(&open.levels(proven.iter())),
        unproven: open.lines.iter().map(|line| line.length).sum(),
        gap: placed.map_or(0.0, |placed| placed.gap()),
        chosen,
    })
}

/// A scene that does not know its pulses, as an error.
pub(crate) fn missing_pulses() -> Error {
    Error::MissingAttribute {
        attribute: "pulses with known scanner positions",
        needed_for: "a plan of what to scan again",
        advice: "without them no line of sight is unproven: give scanner positions with --orient (trajectory=FILE, stations=FILE or scanner=X,Y,Z), \
                 or an .npz ball file of a cloud that had them",
    }
}
