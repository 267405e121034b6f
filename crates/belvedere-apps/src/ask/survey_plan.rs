//! Survey plan: the stations that would prove most of the unproven lines of sight of a question.

use super::answers::{Answered, Answers, Ask};
use super::cameras::CameraSite;
use super::cameras::Candidates;
use super::cells::GridCells;
use super::context::Context;
use super::line_of_sight::LinesOfSightQuestion;
use super::observers::{check_height, skip_unfit, stand};
use super::places::Places;
use super::remark::Remark;
use super::scene::Scene;
use super::sections::{LinesSection, PairsSection, StationSection, SurveyPlanSection};
use super::standing::{Reach, Standing};
use super::sun::Suns;
use super::sun_place::SunPlace;
use crate::eyes::EyesReport;
use crate::survey_plan::{STATION_HEIGHT, ScannerParams, SurveyGain, SurveyPlan, missing_pulses, plan_survey};
use crate::viewshed::OBSERVER_HEIGHT;
use belvedere_core::ground::GroundPoints;
use belvedere_core::query::{Answer, EarthParams, MedialScene, UnprovenAs};
use belvedere_data::control::Control;
use belvedere_data::report::{percent, rounded};
use belvedere_data::{Error, Parameter, Result};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Maximum number of lines of sight that are tested; of more, as many are taken at even steps.
const MAX_LINES: usize = 20_000;
/// Sine of the elevation of suns below which no line is followed: half a degree.
const LOWEST_SUN: f64 = 0.0087;
/// Height above all objects at which a line to a sun ends, metres.
const ABOVE_ALL: f64 = 1.0;
/// Side of the cells in which the ground below stations is known, metres.
const GROUND_CELL: f64 = 1.0;

/// Stations for another scan that make unproven lines of sight proven: lines between pairs, or from observers to cells
/// or points.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default)]
pub struct SurveyPlanQuestion {
    /// Stations to choose, 1 or more. Default 1.
    pub count: usize,
    /// Possible stations of the scanner.
    pub candidates: Candidates,
    /// Height of the scanner above the ground or the roof, metres, 0 or more; `None` for 1.8.
    pub station_height: Option<f64>,
    /// Maximum range at which surfaces return pulses, metres, above 0; `None` for 100.
    pub max_distance: Option<f64>,
    /// Angle between pulses, degrees, above 0 to 90; `None` for 0.1.
    pub angle_step_deg: Option<f64>,
    /// Observers of the places of the question; none for pairs, and for given suns.
    #[serde(skip)]
    pub observers: Vec<Standing>,
    /// Suns whose light is to be proven at the places of the question.
    pub suns: Option<Suns>,
    /// Location on earth, and clock.
    pub place: SunPlace,
    /// True if all places of a line of candidates are one candidate, such as a flight line. Default: each is one.
    pub whole_lines: bool,
    /// Height above the ground of observers without one, metres, 0 or more; `None` for 1.7.
    pub observer_height: Option<f64>,
    /// Height above the ground of targets of pairs without one, metres, 0 or more; `None` for 0.1.
    pub target_height: Option<f64>,
    /// Source of ground points.
    pub ground: GroundPoints,
}

impl Default for SurveyPlanQuestion {
    fn default() -> Self {
        Self {
            count: 1,
            candidates: Candidates::default(),
            station_height: None,
            max_distance: None,
            angle_step_deg: None,
            observers: Vec::new(),
            suns: None,
            place: SunPlace::default(),
            whole_lines: false,
            observer_height: None,
            target_height: None,
            ground: GroundPoints::default(),
        }
    }
}

/// Stations that were chosen, among those that could be.
#[derive(Clone, Debug)]
pub struct SurveyPlanResults {
    /// Eye of each candidate, local metres, of a line its first place; NaN for one that cannot be used.
    pub eyes: Vec<[f64; 3]>,
    /// Expected gain of the stations.
    pub plan: SurveyPlan,
    /// Number of unproven lines.
    pub unproven: usize,
}

/// A candidate with its expected gain: a row of a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlannedStation {
    /// Position of its eye, local metres.
    pub eye: [f64; 3],
    /// Its place in the order in which stations were chosen, from 1; `None` for one that was not.
    pub order: Option<usize>,
    /// Gain of the station alone.
    pub alone: SurveyGain,
    /// Gain together with those chosen before it, for one that was chosen.
    pub together: Option<SurveyGain>,
}

impl SurveyPlanResults {
    /// The candidates that can be used: those that were chosen first, in their order, then the others as they came.
    #[must_use]
    pub fn stations(&self) -> Vec<PlannedStation> {
        let SurveyPlan { chosen, curve, alone, .. } = &self.plan;
        let station = |row: usize, order: Option<usize>| {
            let (eye, alone) = (*self.eyes.get(row)?, *alone.get(row)?);
            let together = order.and_then(|order| curve.get(order).copied());
            eye[0].is_finite().then_some(PlannedStation { eye, order, alone, together })
        };
        let first = chosen.iter().zip(1..).filter_map(|(&row, order)| station(row, Some(order)));
        let others = (0..self.eyes.len()).filter(|row| !chosen.contains(row)).filter_map(|row| station(row, None));
        first.chain(others).collect()
    }

    /// Share of the unproven lines, percent.
    #[must_use]
    pub fn share(&self, gain: SurveyGain) -> f64 {
        percent(gain.settled, self.unproven)
    }
}

impl SurveyPlanQuestion {
    fn scanner(&self) -> ScannerParams {
        let usual = ScannerParams::default();
        usual
            .with_max_range(self.max_distance.unwrap_or(usual.max_range))
            .with_angular_step(self.angle_step_deg.map_or(usual.angular_step, f64::to_radians))
    }

    /// The lines of the question; of too many some.
    fn pairs(
        &self,
        (places, blockers): (&Places, &Arc<MedialScene>),
        scene: &Scene,
        context: &mut Context,
        control: &Control<'_>,
    ) -> Result<Vec<[[f64; 3]; 2]>> {
        if let Places::Pairs(_) = places {
            let lines = LinesOfSightQuestion {
                observer_height: self.observer_height,
                target_height: self.target_height,
                ground: self.ground,
                ..LinesOfSightQuestion::default()
            };
            let pairs = lines.ends(places, scene, context, control)?;
            return Ok(some_of(pairs.len(), |row| pairs[row], context));
        }
        if let Some(suns) = &self.suns {
            return self.lines_to_suns(suns, places, scene, context, control);
        }
        let usual = (self.observer_height.unwrap_or(OBSERVER_HEIGHT), self.ground);
        let eyes = stand(&self.observers, usual, scene, context, control)?;
        let eyes = skip_unfit(eyes, ("observer", Reach::Cloud), (blockers, None), (scene, context), control)?.eyes;
        let eyes: Vec<[f64; 3]> = eyes.into_iter().filter(|eye| eye[0].is_finite()).collect();
        let targets = places.targets(scene, context, control)?;
        let rows: Vec<usize> = (0..targets.len()).filter(|&row| targets.is_target(row)).collect();
        let line = |number: usize| {
            let target = targets.positions[rows[number / eyes.len()]];
            [eyes[number % eyes.len()], target.map(f64::from)]
        };
        Ok(some_of(rows.len() * eyes.len(), line, context))
    }

    /// Returns lines from above all objects of the scene towards each sun down to the places.
    fn lines_to_suns(
        &self,
        suns: &Suns,
        places: &Places,
        scene: &Scene,
        context: &mut Context,
        control: &Control<'_>,
    ) -> Result<Vec<[[f64; 3]; 2]>> {
        let suns = suns.resolve(&self.place, &scene.whereabouts(), context)?;
        let towards: Vec<[f64; 3]> =
            suns.iter().map(|sun| sun.sun.to_sun).filter(|to_sun| to_sun[2] > LOWEST_SUN).collect();
        let targets = places.targets(scene, context, control)?;
        let rows: Vec<usize> = (0..targets.len()).filter(|&row| targets.is_target(row)).collect();
        let top = f64::from(scene.model().bounds().high[2]) + ABOVE_ALL;
        let line = |number: usize| {
            let target = targets.positions[rows[number / towards.len()]].map(f64::from);
            let to_sun = towards[number % towards.len()];
            let range = (top - target[2]).max(ABOVE_ALL) / to_sun[2];
            [std::array::from_fn(|axis| target[axis] + range * to_sun[axis]), target]
        };
        Ok(some_of(rows.len() * towards.len(), line, context))
    }

    /// The places that each candidate is scanned from.
    fn stations(&self, eyes: &[[f64; 3]]) -> Vec<Vec<[f64; 3]>> {
        let lines: Vec<Option<usize>> = match &self.candidates {
            Candidates::Given(given) if self.whole_lines => given.iter().map(|one| one.line).collect(),
            _ => vec![None; eyes.len()],
        };
        let numbered: Vec<(Option<usize>, [f64; 3])> = lines.into_iter().zip(eyes.iter().copied()).collect();
        let is_one = |a: &(Option<usize>, [f64; 3]), b: &(Option<usize>, [f64; 3])| a.0.is_some() && a.0 == b.0;
        numbered.chunk_by(is_one).map(|places| places.iter().map(|(_, eye)| *eye).collect()).collect()
    }

    fn remark(found: &SurveyPlanResults, context: &mut Context) {
        if found.unproven == 0 {
            let text = "no line of sight of the question is unproven: there is nothing to scan again for it";
            context.add(Some(Remark::note("nothing-unproven", text)));
        } else if found.plan.reachable.settled == 0 {
            let text = "no candidate settles any unproven line, not even all of them together: give other candidates, or a \
                        longer range";
            context.add(Some(Remark::warning("no-station-settles", text)));
        } else if found.plan.chosen.is_empty() {
            context.add(Some(Remark::warning("no-station-chosen", "no candidate proves anything")));
        }
    }

    fn section(&self, found: &SurveyPlanResults, candidates: EyesReport, scene: &Scene) -> SurveyPlanSection {
        let station = |station: PlannedStation| {
            let together = station.together?;
            Some(StationSection {
                position: scene.frame().file_from_local(station.eye).map(|v| rounded(v, 2)),
                settled_alone: station.alone.settled,
                settled_lines: together.settled,
                expected_lines: rounded(together.expected, 1),
                settled_percent: found.share(together),
                proven_m: rounded(together.proven, 1),
            })
        };
        let plan = &found.plan;
        SurveyPlanSection {
            candidates,
            max_range_m: self.scanner().max_range,
            angle_step_deg: rounded(self.scanner().angular_step.to_degrees(), 4),
            unproven_lines: found.unproven,
            unproven_m: rounded(plan.unproven, 1),
            stations: found.stations().into_iter().filter_map(station).collect(),
            settled_percent: found.share(plan.curve.last().copied().unwrap_or_default()),
            all_candidates_settle_percent: found.share(plan.reachable),
            at_most_below_best_percent: rounded(100.0 * plan.gap, 2),
        }
    }
}

impl SurveyPlanSection {
    /// The answer in words.
    fn headlines(&self) -> Vec<String> {
        let total = self.unproven_lines;
        let station = |(station, number): (&StationSection, usize)| {
            let StationSection { position: [x, y, z], settled_lines, expected_lines, .. } = station;
            let who = if number == 1 { "it" } else { "it and those before" };
            format!(
                "station {number} at {x}, {y}, {z}: {who} should prove about {expected_lines:.0} of {total} unproven \
                 lines, and {settled_lines} at best (if nothing stands where no pulse was)"
            )
        };
        if self.stations.is_empty() {
            return vec![format!("no station is chosen, for {total} unproven lines of sight")];
        }
        let all = self.all_candidates_settle_percent;
        let all = format!("all {} candidates together would settle {all} %", self.candidates.count);
        self.stations.iter().zip(1..).map(station).chain([all]).collect()
    }
}

impl Ask for SurveyPlanQuestion {
    type Found = SurveyPlanResults;

    fn check(&self) -> Result<()> {
        check_height(self.station_height)?;
        check_height(self.observer_height)?;
        check_height(self.target_height)?;
        self.suns.as_ref().map_or(Ok(()), |suns| suns.check(&self.place))?;
        if self.count == 0 {
            return Err(Error::invalid(Parameter::StationCount, "0", "1 or more"));
        }
        self.scanner().validate()
    }

    fn answer(&self, scene: &Scene, places: &Places, context: &mut Context, control: &Control<'_>) -> Answered<Self> {
        if scene.model().pulses().is_none() {
            return Err(missing_pulses());
        }
        let blockers = scene.blockers(UnprovenAs::Reported, control)?;
        let pairs = self.pairs((places, &blockers), scene, context, control)?;
        let earth = EarthParams::default();
        let lines = control.stage("testing lines of sight", pairs.len(), || {
            let line = |&[observer, target]: &[[f64; 3]; 2]| {
                control.check()?;
                let answer = blockers.sight_answer(observer, target, &earth);
                let is_open = answer == Answer::Unproven;
                let pieces = is_open.then(|| blockers.unproven_pieces(observer, target, &earth));
                control.advance(1);
                Ok((answer, pieces))
            };
            pairs.par_iter().map(line).collect::<Result<Vec<_>>>()
        })?;
        let (answers, pieces): (Vec<Answer>, Vec<_>) = lines.into_iter().unzip();
        let unproven: Vec<_> = pieces.into_iter().flatten().collect();
        let section = PairsSection::of(&answers, UnprovenAs::Reported, [0; 2]);
        context.report.lines_of_sight = Some(LinesSection::of(&blockers, None).with_pairs(section));
        let cells = GridCells { cell: Some(GROUND_CELL), ..GridCells::default() };
        let known = scene.ground(cells.grid(scene)?, self.ground, control)?;
        context.ground(scene.frame(), &known);
        let site = CameraSite { scene, blockers: &blockers, ground: &known.ground, grid_north: 0.0 };
        let height = self.station_height.unwrap_or(STATION_HEIGHT);
        let (eyes, candidates) = self.candidates.eyes((height, self.ground), &site, context, control)?;
        if candidates.skipped == candidates.count {
            let what = "all lie inside obstacles, below the ground or outside the cloud".to_owned();
            return Err(Error::NoObserver { who: "candidate", what });
        }
        let stations = self.stations(&eyes);
        let plan = control.stage("testing candidates", stations.len(), || {
            plan_survey((&blockers, Some(&known.ground)), &stations, &unproven, self.count, &self.scanner(), control)
        })?;
        let is_usable = |eye: &&[f64; 3]| eye[0].is_finite();
        let eyes = stations.iter().map(|places| places.iter().find(is_usable).copied().unwrap_or([f64::NAN; 3]));
        let eyes: Vec<[f64; 3]> = eyes.collect();
        let found = SurveyPlanResults { eyes, plan, unproven: unproven.len() };
        Self::remark(&found, context);
        let section = self.section(&found, candidates, scene);
        section.headlines().into_iter().for_each(|line| context.headline(line));
        context.report.survey_plan = Some(section);
        Ok(Answers::new(found, Vec::new()))
    }
}

/// `count` lines, or at most [`MAX_LINES`] of them at even steps.
fn some_of(count: usize, line: impl Fn(usize) -> [[f64; 3]; 2], context: &mut Context) -> Vec<[[f64; 3]; 2]> {
    if count <= MAX_LINES {
        return (0..count).map(line).collect();
    }
    let text = format!("the plan is made for {MAX_LINES} of the {count} lines of sight, taken at even steps");
    let remark = Remark::note("lines-sampled", text).with("count", MAX_LINES as f64).with("of", count as f64);
    context.add(Some(remark));
    (0..MAX_LINES).map(|number| line(number * count / MAX_LINES)).collect()
}
