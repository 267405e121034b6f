//! Probability that a target is visible, with every answer.
//!
//! An answer is wrong mostly where its line of sight passes close to an edge of an obstacle, or through space that no
//! pulse saw. So the probability follows from lines parallel to it ([`ParallelLines`]), from the length that no pulse
//! came near to, and from whether an end is inside an obstacle. Each of these has a score; the sum of scores is the
//! logarithm of the odds. The scores are fitted to simulated towns with exact answers (`research/`, program
//! `confidence`; docs/methods/confidence.md has the reliability curves).
//!
//! # Source
//! This project's own. Logistic regression on classes of evidence: a scorecard (Hosmer & Lemeshow 2000, chapter 3).

use crate::medium::Medium;
use crate::query::{Answer, BlockedLines, MedialScene, ParallelLines, Proof, Viewer};
use crate::ray_index::Ray;
use belvedere_data::control::Control;
use belvedere_data::vector::to_f32;
use belvedere_data::{Error, Parameter, Result};
use rayon::prelude::*;
use std::sync::LazyLock;

/// Targets handed to a thread at once.
const CHUNK: usize = 256;
/// The fitted scores.
const SCORES: &str = include_str!("confidence_scores.csv");
/// Upper ends of the classes of length that no pulse came near to, metres; the last class has none.
const UNPROVEN_CLASSES: [f64; 6] = [0.05, 0.5, 1.0, 2.0, 4.0, MAX_UNPROVEN];
/// Length from which on more makes no difference, metres.
const MAX_UNPROVEN: f64 = 8.0;
/// Logarithm of the odds of being dark behind crowns: constant, and weights of the same of the evidence past all balls
/// and of the optical depth. Fitted to photographs of shadows on eleven plots (docs/methods/tree-light.md), whose
/// weights are alike where one is left out.
const CROWNS_CONSTANT: f64 = -2.0;
/// See [`CROWNS_CONSTANT`].
const CROWNS_BALLS: f64 = 0.2;
/// See [`CROWNS_CONSTANT`].
const CROWNS_DEPTH: f64 = 2.4;
/// Distance of the nearest pulse beyond which a scanner on the ground did not see an end, metres.
const SCANNED_WITHIN: f64 = 1.0;
/// Unproven length from which on a line to such an end is unknown, metres: what `ProofParams` tolerates.
const UNKNOWN_FROM: f64 = 0.5;
/// Probabilities are no nearer to 0 and 1 before logarithms are taken.
const MIN_PROBABILITY: f64 = 1e-4;

/// Evidence for and against a target being visible.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Evidence {
    /// The line of sight and those beside it.
    pub lines: ParallelLines,
    /// True if an end lies inside an obstacle.
    pub is_inside_obstacle: bool,
    /// True if both ends lie below the highest return: a line to an aircraft is like one to the sky.
    pub is_between_places: bool,
    /// True if scanners stood on the ground.
    pub is_from_ground: bool,
    /// True if scanners stood on the ground, and no pulse came within 1 m of an end below the highest return.
    pub is_end_unscanned: bool,
    /// About how much of the line no pulse came near to, metres ([`Proof::sampled_unproven_length`]); 8 or more where
    /// it is 8 or more.
    pub unproven_length: f64,
}

/// Term of the score.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Term {
    /// The answer alone.
    Constant,
    /// Free lines of the inner ring, and of the outer.
    FreeNear,
    FreeFar,
    /// Lines of the inner ring that end inside an obstacle, and of the outer.
    HeldNear,
    HeldFar,
    /// End inside an obstacle.
    Inside,
    /// The class of the length that no pulse came near to, towards the sun or the sky, and between two places.
    UnprovenSky,
    UnprovenPair,
    /// The same for surveys from the ground.
    UnprovenSkyFromGround,
    UnprovenPairFromGround,
}

impl Term {
    const ALL: [(Self, &str); 10] = [
        (Self::Constant, "answer"),
        (Self::FreeNear, "free_near"),
        (Self::FreeFar, "free_far"),
        (Self::HeldNear, "held_near"),
        (Self::HeldFar, "held_far"),
        (Self::Inside, "inside_obstacle"),
        (Self::UnprovenSky, "unproven_sky"),
        (Self::UnprovenPair, "unproven_pair"),
        (Self::UnprovenSkyFromGround, "unproven_sky_from_ground"),
        (Self::UnprovenPairFromGround, "unproven_pair_from_ground"),
    ];
    /// Maximum number of classes of a term.
    const CLASSES: usize = 9;
}

/// A class of evidence, which has a score.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct ScoreKey {
    term: Term,
    is_free: bool,
    class: usize,
}

impl std::fmt::Display for ScoreKey {
    /// Writes the beginning of a line of the file of scores.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (_, name) = Term::ALL[self.term as usize];
        write!(f, "{name},{},{}", if self.is_free { "free" } else { "blocked" }, self.class)
    }
}

/// Scores by term, answer (blocked, free) and class.
type Scores = [[[f64; Term::CLASSES]; 2]; Term::ALL.len()];

static FITTED: LazyLock<Scores> = LazyLock::new(|| read_scores(SCORES));

/// Scores from lines of term, answer, class and score.
fn read_scores(text: &str) -> Scores {
    let mut scores = Scores::default();
    for line in text.lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        let [name, answer, class, score] = fields[..] else { continue };
        let term = Term::ALL.iter().position(|(_, of_term)| *of_term == name);
        if let (Some(term), Ok(class), Ok(score)) = (term, class.parse::<usize>(), score.parse()) {
            scores[term][usize::from(answer == "free")][class] = score;
        }
    }
    scores
}

impl Evidence {
    /// Length that no pulse came near to from which on more makes no difference, metres.
    pub const MAX_UNPROVEN: f64 = MAX_UNPROVEN;

    /// Creates the evidence for a line of sight from the lines blocked by all parts of a scene (airborne surveys).
    #[must_use]
    pub fn from_the_air(blocked: BlockedLines, is_between_places: bool, unproven_length: f64) -> Self {
        Self {
            lines: blocked.lines(),
            is_inside_obstacle: blocked.is_inside_obstacle(),
            is_between_places,
            is_from_ground: false,
            is_end_unscanned: false,
            unproven_length,
        }
    }

    /// Returns true if nothing tells whether the target is visible: no scanner on the ground saw an end of the line,
    /// nor 0.5 m or more of the free line.
    #[must_use]
    pub fn is_unknown(&self) -> bool {
        self.is_end_unscanned && self.lines.is_free && self.unproven_length >= UNKNOWN_FROM
    }

    /// The classes whose scores are added up.
    pub fn score_keys(&self) -> impl Iterator<Item = ScoreKey> {
        let ParallelLines { free, held, .. } = self.lines;
        let held = held.map(usize::from);
        let unproven = UNPROVEN_CLASSES.iter().take_while(|end| self.unproven_length >= **end).count();
        let of_proof = match (self.is_between_places, self.is_from_ground) {
            (false, false) => Term::UnprovenSky,
            (true, false) => Term::UnprovenPair,
            (false, true) => Term::UnprovenSkyFromGround,
            (true, true) => Term::UnprovenPairFromGround,
        };
        let terms = [
            (Term::Constant, usize::from(self.is_between_places)),
            (Term::FreeNear, usize::from(free[0])),
            (Term::FreeFar, usize::from(free[1])),
            (Term::HeldNear, held[0]),
            (Term::HeldFar, held[1]),
            (Term::Inside, usize::from(self.is_inside_obstacle)),
            (of_proof, unproven),
        ];
        let is_free = self.lines.is_free;
        terms.into_iter().map(move |(term, class)| ScoreKey { term, is_free, class })
    }

    /// Returns the probability that the target is lit, 0 to 1, behind crowns of the optical depth `depth`. `self` is
    /// the evidence past all balls; `solid` has the lines that balls without vegetation block.
    ///
    /// Without crowns it equals [`Evidence::probability`]. Otherwise light must pass both solids and crowns. The
    /// probability for solids follows from solid balls alone, that for crowns from the optical depth and from the
    /// evidence past all balls.
    #[must_use]
    pub fn probability_among_crowns(&self, solid: BlockedLines, depth: f64) -> f32 {
        let without_crowns = Self { lines: solid.lines(), is_inside_obstacle: solid.is_inside_obstacle(), ..*self };
        if depth == 0.0 && without_crowns.lines == self.lines {
            return self.probability();
        }
        let past_all = f64::from(self.probability()).clamp(MIN_PROBABILITY, 1.0 - MIN_PROBABILITY);
        let dark = CROWNS_CONSTANT + CROWNS_BALLS * ((1.0 - past_all) / past_all).ln() + CROWNS_DEPTH * depth;
        let through = 1.0 / (1.0 + dark.exp());
        to_f32(f64::from(without_crowns.probability()) * through)
    }

    /// Returns the probability that the target is visible, 0 to 1; NaN where it is [unknown](Evidence::is_unknown).
    #[must_use]
    pub fn probability(&self) -> f32 {
        if self.is_unknown() {
            return f32::NAN;
        }
        let scores = &FITTED;
        let of_key = |key: ScoreKey| scores[key.term as usize][usize::from(key.is_free)][key.class];
        let sum: f64 = self.score_keys().map(of_key).sum();
        to_f32(1.0 / (1.0 + (-sum).exp()))
    }
}

impl MedialScene {
    /// Returns the evidence for a line of sight from `target`, local metres, to `range` metres (infinite for a
    /// direction) along the unit vector `towards`. All numbers but the range must be finite. `None` if pulses are not
    /// known.
    #[must_use]
    pub fn evidence(&self, target: [f64; 3], towards: [f64; 3], range: f64) -> Option<Evidence> {
        Some(self.evidence_with(self.proof.as_ref()?, target, towards, range))
    }

    /// Returns true if nothing tells whether `eye`, local metres, sees `target` ([`Evidence::is_unknown`]). False where
    /// [`MedialScene::visible_from`] has no answer.
    #[must_use]
    pub fn is_unknown(&self, eye: [f64; 3], target: [f32; 3]) -> bool {
        let target = target.map(f64::from);
        let Some(Ray { origin, direction, ranges: [_, range] }) = Ray::between(target, eye) else { return false };
        let is_answer = ![eye, target].into_iter().any(|end| self.is_outside_cloud(end));
        is_answer && self.evidence(origin, direction, range).is_some_and(|evidence| evidence.is_unknown())
    }

    fn evidence_with(&self, proof: &Proof, target: [f64; 3], towards: [f64; 3], range: f64) -> Evidence {
        let end = std::array::from_fn(|i| target[i] + range * towards[i]);
        let is_between_places = range.is_finite() && ![target, end].into_iter().any(|end| proof.is_above_all(end));
        let blocked = self.blocked_lines(BlockedLines::NONE, target, towards, range);
        let unproven_length = self.sampled_unproven_length(proof, (target, towards, range), MAX_UNPROVEN);
        let is_from_ground = proof.is_from_ground();
        let is_end_unscanned = is_from_ground
            && [target, end]
                .into_iter()
                .any(|end| end.iter().all(|v| v.is_finite()) && !proof.is_seen_within(end, SCANNED_WITHIN));
        Evidence {
            is_from_ground,
            is_end_unscanned,
            ..Evidence::from_the_air(blocked, is_between_places, unproven_length)
        }
    }

    /// Returns the probability that each of `targets`, (M, 3) local metres, is visible for `viewer`, 0 to 1, (M). NaN
    /// where [`MedialScene::visible_from`] has no answer: a target that is not finite, is the viewer itself, or lies
    /// outside the cloud. NaN also where the answer is [unknown](Evidence::is_unknown). Progress counts targets.
    ///
    /// # Errors
    /// As [`MedialScene::visible_from`], and [`Error::InvalidParameter`] where pulses are not known.
    pub fn visible_probabilities(
        &self,
        viewer: Viewer<'_>,
        targets: &[[f32; 3]],
        control: &Control<'_>,
    ) -> Result<Vec<f32>> {
        viewer.validate()?;
        viewer.validate_count(targets)?;
        let mut outside = vec![Answer::Visible; targets.len()];
        if let Some(coverage) = self.coverage() {
            coverage.mark_outside(viewer, targets, &mut outside);
        }
        let sight = |number: usize| {
            let target = targets.get(number).filter(|_| outside.get(number) == Some(&Answer::Visible))?;
            viewer.sight(number, *target)
        };
        self.probabilities(targets.len(), sight, control)
    }

    /// Returns the probability that the two ends of each of `pairs`, local metres, see each other, 0 to 1. NaN if an
    /// end is not finite or lies outside the cloud, or both coincide. Progress counts pairs.
    ///
    /// # Errors
    /// As [`MedialScene::visible_probabilities`].
    pub fn pair_probabilities(&self, pairs: &[[[f64; 3]; 2]], control: &Control<'_>) -> Result<Vec<f32>> {
        let sight = |number: usize| {
            let [observer, target] = *pairs.get(number)?;
            let sight = Ray::between(observer, target)?;
            (![observer, target].into_iter().any(|end| self.is_outside_cloud(end))).then_some(sight)
        };
        self.probabilities(pairs.len(), sight, control)
    }

    /// Computes [`MedialScene::visible_probabilities`] for light through measured crowns: `solid` is this scene without
    /// its vegetation, `medium` its vegetation, of which optical depths are multiplied by `factor`.
    ///
    /// # Errors
    /// Those of [`MedialScene::visible_probabilities`].
    pub fn lit_probabilities(
        &self,
        (solid, medium, factor): (&Self, &Medium, f64),
        viewer: Viewer<'_>,
        targets: &[[f32; 3]],
        control: &Control<'_>,
    ) -> Result<Vec<f32>> {
        let mut found = self.visible_probabilities(viewer, targets, control)?;
        let chunks = found.par_chunks_mut(CHUNK).zip(targets.par_chunks(CHUNK)).enumerate();
        chunks.try_for_each(|(chunk, (found, targets))| {
            control.check()?;
            for (i, (found, target)) in found.iter_mut().zip(targets).enumerate() {
                let Some(sight) = viewer.sight(chunk * CHUNK + i, *target).filter(|_| !found.is_nan()) else {
                    continue;
                };
                let Ray { origin, direction, ranges: [_, range] } = sight;
                let depth = factor * medium.optical_depth(origin, direction, range);
                let Some(of_all) = self.evidence(origin, direction, range) else { continue };
                let blocked = solid.blocked_lines(BlockedLines::NONE, origin, direction, range);
                *found = of_all.probability_among_crowns(blocked, depth);
            }
            Ok(())
        })?;
        Ok(found)
    }

    fn probabilities(
        &self,
        count: usize,
        sight: impl Fn(usize) -> Option<Ray> + Sync,
        control: &Control<'_>,
    ) -> Result<Vec<f32>> {
        let Some(proof) = &self.proof else {
            return Err(Error::invalid(
                Parameter::Certainty,
                "given",
                "left out for scenes whose pulses are not known",
            ));
        };
        let mut found = vec![f32::NAN; count];
        found.par_chunks_mut(CHUNK).enumerate().try_for_each(|(chunk, found)| {
            control.check()?;
            for (i, found) in found.iter_mut().enumerate() {
                if let Some(Ray { origin, direction, ranges: [_, range] }) = sight(chunk * CHUNK + i) {
                    *found = self.evidence_with(proof, origin, direction, range).probability();
                }
            }
            control.advance(found.len());
            Ok(())
        })?;
        Ok(found)
    }
}

/// Minimum probability of the more likely answer, visible or not, for which it counts as certain: above 0.5 and at most
/// 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Certainty(f32);

impl Certainty {
    /// Creates the certainty of a minimum probability.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a number that is not above 0.5 and at most 1.
    pub fn new(least: f64) -> Result<Self> {
        if least > 0.5 && least <= 1.0 {
            return Ok(Self(to_f32(least)));
        }
        Err(Error::invalid(
            Parameter::Certainty,
            least,
            "above 0.5 and at most 1: the least probability of what is more likely",
        ))
    }

    /// Returns true if a target with this probability is certainly visible; false for NaN.
    #[must_use]
    pub fn is_visible(self, probability: f32) -> bool {
        probability >= self.0
    }

    /// Returns true if an answer with this probability of being visible is less certain; false for NaN.
    #[must_use]
    pub fn is_missed_by(self, probability: f32) -> bool {
        probability.max(1.0 - probability) < self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn evidence(is_free: bool, free: [u8; 2], unproven_length: f64, is_between_places: bool) -> Evidence {
        let lines = ParallelLines { is_free, free, held: [0; 2] };
        Evidence {
            lines,
            is_inside_obstacle: false,
            is_between_places,
            is_from_ground: false,
            is_end_unscanned: false,
            unproven_length,
        }
    }

    #[test]
    fn every_line_of_the_scores_is_read() {
        let scores = read_scores(SCORES);
        let known = scores.as_flattened().as_flattened().iter().filter(|score| **score != 0.0).count();
        let zeros = SCORES.lines().skip(1).filter(|line| line.ends_with(",0.0000")).count();
        assert_eq!(known + zeros, SCORES.lines().count() - 1);
        assert!(known > 60, "{known} scores");
    }

    #[test]
    fn what_all_lines_and_pulses_agree_on_is_nearly_certain() {
        for is_between_places in [false, true] {
            let visible = evidence(true, [8; 2], 0.0, is_between_places).probability();
            let blocked = evidence(false, [0; 2], 20.0, is_between_places).probability();
            assert!(visible > 0.97 && blocked < 0.03, "{visible} {blocked}");
            // half of the lines beside it say otherwise, and pulses prove nothing
            let doubtful = evidence(true, [4; 2], 3.0, is_between_places).probability();
            assert!((0.02..0.9).contains(&doubtful), "{doubtful}");
            assert!(evidence(true, [8; 2], 9.0, is_between_places).probability() < visible);
        }
    }

    #[test]
    fn a_free_line_to_an_end_that_nobody_scanned_is_unknown() {
        let unscanned = |is_free, unproven_length| Evidence {
            is_from_ground: true,
            is_end_unscanned: true,
            ..evidence(is_free, [8; 2], unproven_length, true)
        };
        assert!(unscanned(true, 0.5).is_unknown() && unscanned(true, 9.0).probability().is_nan());
        // what pulses prove is known, and so is what blocks
        assert!(!unscanned(true, 0.4).is_unknown() && unscanned(false, 9.0).probability() < 0.5);
    }

    #[test]
    fn certainty_is_above_one_half() {
        for wrong in [0.5, 0.0, -1.0, 1.01, f64::NAN] {
            assert!(Certainty::new(wrong).is_err(), "{wrong}");
        }
        let certainty = Certainty::new(0.9).unwrap();
        assert!(certainty.is_missed_by(0.89) && certainty.is_missed_by(0.11));
        assert!(!certainty.is_missed_by(0.9) && !certainty.is_missed_by(0.05) && !certainty.is_missed_by(f32::NAN));
    }
}
