//! Reliability of answers on a survey, measured with pulses that were kept out of the scene ([`crate::held_out`]).

use crate::calibration::Calibration;
use crate::held_out::{ErrorTally, HeldOut, HeldOutPairs, HeldOutParams, MetSurface, split};
use crate::resampling::{Interval, Tiles, resampled};
use belvedere_core::clean::clean;
use belvedere_core::model::{ModelParams, SceneModel};
use belvedere_core::pulses::{Pulses, SensorPositions, group, locate};
use belvedere_core::query::{Answer, AnswerCounts, Certainty, MedialScene, UnprovenAs, Viewer};
use belvedere_data::control::Control;
use belvedere_data::report::rounded;
use belvedere_data::{Error, PointCloud, Result};
use rayon::prelude::*;
use serde::Serialize;
use std::borrow::Cow;

/// Distance of places behind last returns, metres: several times the spacing of points of most surveys, and less than
/// the thickness of buildings.
const BEHIND_M: f64 = 1.0;
/// Side of the tiles that are resampled, metres: about a house with its surroundings.
const TILE_SIDE_M: f32 = 25.0;
/// Minimum probability of the more likely answer that counts as certain.
const CERTAIN_FROM: f64 = 0.9;
/// Minimum number of cases for which the share found in a tenth of probability is compared with the expected one.
const MIN_CASES: usize = 200;

/// Selection of the pulses that are kept out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReliabilityParams {
    /// Share of the pulses kept out, 0 to 1, both excluded. Default 0.1: with more of them the scene is made of a
    /// thinner survey, with fewer intervals are wider.
    pub share: f64,
    /// Any number; another one keeps out other pulses. Default 1.
    pub seed: u64,
}

impl Default for ReliabilityParams {
    fn default() -> Self {
        Self { share: 0.1, seed: 1 }
    }
}

/// Reliability of answers on a survey. Percentages have 95 % intervals.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SurveyReliability {
    /// Share of the pulses that were kept out.
    pub share: f64,
    /// Chose these pulses.
    pub seed: u64,
    /// Pulses kept out whose scanner position is known.
    pub pulses_kept_out: usize,
    /// Tiles of 25 m that intervals are made of.
    pub tiles: usize,
    /// Paths along pulses, which are free: wrong where blocked.
    pub free_paths: PlacesReliability,
    /// Places 1 m behind last returns, which the scanner does not see: wrong where visible or unproven.
    pub hidden_places: PlacesReliability,
    /// Probabilities of lines that end in the open; `None` where the scene has no pulses, which probabilities need.
    pub probabilities: Option<ProbabilityReliability>,
    /// The same of lines with an end inside an obstacle of the scene, where most hidden places are.
    pub probabilities_inside_obstacles: Option<ProbabilityReliability>,
}

/// Reliability of answers of one kind.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PlacesReliability {
    /// Wrong answers; `None` without any answer.
    pub wrong_percent: Option<Interval>,
    /// The answers.
    pub answers: FoundAnswers,
    /// Wrong answers by the surface that the pulse met; `None` for surfaces that no pulse met.
    pub wrong_percent_at: WrongBySurface,
}

/// Wrong answers by the surface that a pulse met.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct WrongBySurface {
    /// Ground or water.
    pub ground: Option<f64>,
    /// Buildings.
    pub building: Option<f64>,
    /// Anything else, mostly trees; everything where points have no classes.
    pub other: Option<f64>,
}

/// Numbers of answers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct FoundAnswers {
    /// Visible.
    pub visible: usize,
    /// Unproven: nothing blocks.
    pub unproven: usize,
    /// Blocked.
    pub blocked: usize,
    /// None, because an end lies beside or below the points that were left.
    pub none: usize,
}

/// Quality of probabilities on a survey.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ProbabilityReliability {
    /// Lines of sight.
    pub cases: usize,
    /// Minimum probability of the more likely answer that counts as certain.
    pub certain_from: f64,
    /// Answers that are certain.
    pub certain_percent: f64,
    /// Wrong ones of these; `None` where no answer is certain.
    pub certain_wrong_percent: Option<Interval>,
    /// Mean difference between the probability and the share found, in percent; `None` without a case.
    pub calibration_error_percent: Option<f64>,
    /// The greatest difference between the expected and the found percentage of a tenth with 200 cases or more; `None`
    /// without such a tenth.
    pub greatest_difference_percent: Option<f64>,
    /// Cases by tenths of the probability of being visible; tenths without a case are left out.
    pub tenths: Vec<TenthReliability>,
}

/// Cases of a tenth of probability: free paths and hidden places.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TenthReliability {
    /// Lowest probability of the tenth, percent.
    pub from_percent: f64,
    /// Number of cases.
    pub cases: usize,
    /// Mean probability of being visible.
    pub expected_percent: f64,
    /// Share that is free.
    pub found_percent: f64,
}

impl ReliabilityParams {
    /// Checks the parameters.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a share that is not between 0 and 1.
    pub fn check(&self) -> Result<()> {
        self.held_out().validate()
    }

    fn held_out(self) -> HeldOutParams {
        let Self { share, seed } = self;
        HeldOutParams { share, seed, depths: vec![BEHIND_M], ..HeldOutParams::default() }
    }
}

/// Keeps pulses of `cloud` out, makes the scene of the others with `model`, and compares its answers with the truth
/// known from the pulses kept out. The result is the same for any number of threads.
///
/// Hidden places are those behind ground, water and buildings where points have these classes, and behind all last
/// returns where not.
///
/// # Errors
/// - [`Error::MissingAttribute`] if the groups of returns of a pulse or the scanner position are not known.
/// - Errors of [`SceneModel::build`], among them [`Error::LengthMismatch`] if `model` gives the scanner of each point.
/// - [`Error::InvalidParameter`] for a share that is not between 0 and 1.
/// - [`Error::Cancelled`].
pub fn survey_reliability(
    cloud: &PointCloud,
    model: &ModelParams,
    params: &ReliabilityParams,
    control: &Control<'_>,
) -> Result<SurveyReliability> {
    params.check()?;
    let (kept, held_out) = control.stage("keeping pulses out", 0, || keep_out(cloud, model, params, control))?;
    let (built, _) = SceneModel::build_owned(kept, model, control)?;
    let scene = built.scene(&built.rule(), UnprovenAs::Reported, control)?;
    let has_classes = |pairs: &HeldOutPairs| pairs.surfaces.iter().any(|&surface| surface != MetSurface::Other);
    let behind = held_out.behind.into_iter().map(|(_, pairs)| pairs).next().unwrap_or_default();
    let behind = if has_classes(&behind) { behind.of_surfaces(|surface| surface != MetSurface::Other) } else { behind };
    let count = held_out.free.targets.len() + behind.targets.len();
    let has_pulses = built.pulses().is_some();
    let [free, hidden] = control.stage("testing pulses kept out", 2 * count, || {
        let known = |pairs, is_visible| KnownCases::of(&scene, pairs, is_visible, has_pulses, control);
        Ok([known(held_out.free, true)?, known(behind, false)?])
    })?;
    let of_free = free.reliability(params.seed);
    let of_hidden = hidden.reliability(params.seed);
    let tiles = Tiles::new(&free.pairs.targets, TILE_SIDE_M).count;
    let cases = [free, hidden];
    let reliability = |ends| has_pulses.then(|| probabilities(&cases, ends, params.seed)).transpose();
    Ok(SurveyReliability {
        share: params.share,
        seed: params.seed,
        pulses_kept_out: held_out.pulse_count,
        tiles,
        free_paths: of_free,
        hidden_places: of_hidden,
        probabilities: reliability(Ends::InTheOpen)?,
        probabilities_inside_obstacles: reliability(Ends::InsideObstacle)?,
    })
}

/// The cloud without the pulses kept out, and the truth known from these. Points that cleaning removes are no returns.
fn keep_out(
    cloud: &PointCloud,
    model: &ModelParams,
    params: &ReliabilityParams,
    control: &Control<'_>,
) -> Result<(PointCloud, HeldOut)> {
    let (rows, _) = clean(cloud, &model.clean, control)?;
    let cloud = if rows.len() == cloud.len() { Cow::Borrowed(cloud) } else { Cow::Owned(cloud.select(&rows)) };
    let (positions, report) = locate(&cloud, &model.orient.means(&cloud.frame), &model.locate, control)?;
    if report.is_assumed() {
        return Err(Error::MissingAttribute {
            attribute: "scanner positions, and they cannot be found in it",
            needed_for: "keeping pulses out",
            advice: "give a trajectory or the position of the scanner",
        });
    }
    let pulses = pulses_of(&cloud, control)?;
    let scanner = SensorPositions::of_points(&pulses, &positions);
    let held_out = split(&cloud, &pulses, &scanner, &params.held_out())?;
    Ok((cloud.select(&held_out.kept), held_out))
}

/// The pulses of a cloud. Where no point is said to be one of several returns and times are missing, each has its own.
fn pulses_of(cloud: &PointCloud, control: &Control<'_>) -> Result<Pulses> {
    let is_single = |numbers: &Option<Vec<u8>>| numbers.iter().flatten().all(|&number| number <= 1);
    let attributes = &cloud.attributes;
    match group(cloud, control) {
        Err(Error::MissingAttribute { .. })
            if is_single(&attributes.return_number) && is_single(&attributes.return_count) =>
        {
            // rows of a cloud are numbered with 32 bits everywhere
            Ok(Pulses::of_points(u32::try_from(cloud.len()).unwrap_or(u32::MAX)))
        }
        found => Ok(found?.0),
    }
}

/// Lines of sight of which the truth is known, with the answers of the scene.
struct KnownCases {
    pairs: HeldOutPairs,
    is_visible: bool,
    answers: Vec<Answer>,
    /// NaN where there is none.
    probabilities: Vec<f32>,
    ends: Vec<Ends>,
}

/// Position of the ends of a line of sight in a scene.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Ends {
    InTheOpen,
    /// One of them at least.
    InsideObstacle,
}

impl KnownCases {
    fn of(
        scene: &MedialScene,
        pairs: HeldOutPairs,
        is_visible: bool,
        has_pulses: bool,
        control: &Control<'_>,
    ) -> Result<Self> {
        let viewer = Viewer::Each(&pairs.eyes);
        let answers = scene.visible_from(viewer, &pairs.targets, control)?;
        let probabilities = match has_pulses {
            true => scene.visible_probabilities(viewer, &pairs.targets, control)?,
            false => vec![f32::NAN; answers.len()],
        };
        let is_inside = |place: &[f32; 3]| scene.is_inside_obstacle(place.map(f64::from));
        let of_line = |(target, eye)| match is_inside(target) || is_inside(eye) {
            true => Ends::InsideObstacle,
            false => Ends::InTheOpen,
        };
        let ends = pairs.targets.par_iter().zip(&pairs.eyes).map(of_line).collect();
        Ok(Self { pairs, is_visible, answers, probabilities, ends })
    }

    fn reliability(&self, seed: u64) -> PlacesReliability {
        let wrong = if self.is_visible { Answer::Blocked } else { Answer::Visible };
        let tiles = Tiles::new(&self.pairs.targets, TILE_SIDE_M);
        let mut by_tile = vec![ErrorTally::default(); tiles.count];
        let [mut ground, mut building, mut other] = [ErrorTally::default(); 3];
        let counts = AnswerCounts::of(&self.answers);
        let (visible, unproven, blocked) = (counts.visible, counts.unproven, counts.blocked);
        let none = self.answers.len() - visible - unproven - blocked;
        let answers = FoundAnswers { visible, unproven, blocked, none };
        let rows = self.answers.iter().zip(&self.pairs.surfaces).zip(&tiles.of_target);
        for ((&answer, surface), &tile) in rows {
            by_tile[tile as usize].count(answer, wrong);
            match surface {
                MetSurface::Ground => ground.count(answer, wrong),
                MetSurface::Building => building.count(answer, wrong),
                MetSurface::Other => other.count(answer, wrong),
            }
        }
        let of_surface = |tally: ErrorTally| (tally.answered_count > 0).then(|| percent(tally.share()));
        let wrong_percent_at =
            WrongBySurface { ground: of_surface(ground), building: of_surface(building), other: of_surface(other) };
        PlacesReliability { wrong_percent: wrong_percent(&by_tile, seed), answers, wrong_percent_at }
    }
}

/// A share as a percentage with two decimals.
fn percent(share: f64) -> f64 {
    rounded(100.0 * share, 2)
}

/// Wrong answers of all tiles, with the interval that tiles give.
fn wrong_percent(by_tile: &[ErrorTally], seed: u64) -> Option<Interval> {
    let share = |weights: Option<&[u32]>| {
        let mut sum = ErrorTally::default();
        for (number, tally) in by_tile.iter().enumerate() {
            let times = weights.map_or(1, |weights| weights[number] as usize);
            sum.wrong_count += times * tally.wrong_count;
            sum.answered_count += times * tally.answered_count;
        }
        (sum.answered_count > 0).then(|| sum.share())
    };
    let Interval { value, low, high } = resampled(by_tile.len(), seed, share)?;
    Some(Interval { value: percent(value), low: percent(low), high: percent(high) })
}

fn probabilities(cases: &[KnownCases; 2], ends: Ends, seed: u64) -> Result<ProbabilityReliability> {
    let certainty = Certainty::new(CERTAIN_FROM)?;
    let targets: Vec<[f32; 3]> = cases.iter().flat_map(|cases| &cases.pairs.targets).copied().collect();
    let tiles = Tiles::new(&targets, TILE_SIDE_M);
    let mut certain = vec![ErrorTally::default(); tiles.count];
    let mut all = Calibration::default();
    let of_kind = |cases: &KnownCases| {
        let rows = cases.probabilities.iter().zip(&cases.ends);
        rows.map(|(&probability, &of_line)| (probability, of_line, cases.is_visible)).collect::<Vec<_>>()
    };
    for ((probability, of_line, is_visible), &tile) in cases.iter().flat_map(of_kind).zip(&tiles.of_target) {
        if of_line != ends || probability.is_nan() {
            continue;
        }
        all.add(probability, is_visible);
        if !certainty.is_missed_by(probability) {
            certain[tile as usize].add((probability >= 0.5) != is_visible);
        }
    }
    let certain_count: usize = certain.iter().map(|tally| tally.answered_count).sum();
    let tenths = all.tenths().into_iter().enumerate().filter(|(_, tenth)| tenth.count > 0);
    let tenths = tenths.map(|(number, tenth)| TenthReliability {
        from_percent: 10.0 * number as f64,
        cases: tenth.count,
        expected_percent: percent(tenth.expected),
        found_percent: percent(tenth.found),
    });
    let tenths: Vec<TenthReliability> = tenths.collect();
    let large = tenths.iter().filter(|tenth| tenth.cases >= MIN_CASES);
    let differences = large.map(|tenth| rounded((tenth.expected_percent - tenth.found_percent).abs(), 2));
    Ok(ProbabilityReliability {
        cases: all.count(),
        certain_from: CERTAIN_FROM,
        certain_percent: percent(certain_count as f64 / all.count().max(1) as f64),
        certain_wrong_percent: wrong_percent(&certain, seed),
        calibration_error_percent: (all.count() > 0).then(|| percent(all.expected_error())),
        greatest_difference_percent: differences.max_by(f64::total_cmp),
        tenths,
    })
}
