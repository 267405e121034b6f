//! A model of a cloud, compared with the exact town.

use belvedere::Result;
use belvedere::control::Control;
use belvedere::medial::CarvedParams;
use belvedere::model::{BallParams, BallsReport, BuildReport, ModelParams, OrientBy, SceneModel};
use belvedere::query::{Answer, MedialScene, UnprovenAs, Viewer, Visibility};
use belvedere_baselines::simulated::SurveyedScene;
use belvedere_scenes::QuerySet;
use std::collections::BTreeMap;
use std::fmt;
use std::time::Instant;

/// People that look, and those that they look at; own points that they look at.
const EYES: usize = 40;
const TARGETS: usize = 2000;
const OWN: usize = 4000;

/// Answers to targets that are visible in truth, and to those that are blocked: blocked, visible, unproven.
#[derive(Default)]
struct AnswerTally([[usize; 3]; 2]);

/// What was found.
pub(crate) struct ScannerResults {
    build_seconds: f64,
    query_seconds: f64,
    balls: usize,
    report: BuildReport,
    streets: AnswerTally,
    own: AnswerTally,
    /// For lines in streets that are falsely blocked: what the point of the ball lies on, how many, and the mean
    /// radius.
    blockers: BTreeMap<&'static str, (usize, f64)>,
}

/// Builds the default model of a survey, and queries what people in streets see.
pub(crate) fn judge(town: &SurveyedScene, seed: u64) -> Result<ScannerResults> {
    let SurveyedScene { truth, cloud, scanner, .. } = town;
    let params = ModelParams::default()
        .with_orient(OrientBy::ScannerOfEachPoint(scanner.clone()))
        .with_balls(BallParams::Carved(CarvedParams::default()));
    let start = Instant::now();
    let (model, report) = SceneModel::build(cloud, &params, &Control::none())?;
    let build_seconds = start.elapsed().as_secs_f64();
    let medial = model.scene(&model.rule(), UnprovenAs::Reported, &Control::none())?;

    let site = town.site();
    let positions = site.targets(QuerySet::Pedestrians, TARGETS, seed).positions;
    let targets: Vec<[f32; 3]> = positions.iter().map(|&p| town.local(p)).collect();
    let step = (cloud.len() / OWN).max(1);
    let (own, outside): (Vec<[f32; 3]>, Vec<[f64; 3]>) = (0..cloud.len())
        .step_by(step)
        .filter_map(|row| {
            let p = cloud.positions[row];
            Some((p, site.surface_of_return(town.absolute(*scanner.get(row)?), town.absolute(p))?.1))
        })
        .unzip();
    let (mut streets, mut of_own, mut blockers) = (AnswerTally::default(), AnswerTally::default(), BTreeMap::new());
    let mut query_seconds = 0.0;
    for eye in site.street_observers(EYES, seed) {
        let local = town.eye(eye);
        let start = Instant::now();
        let answers = medial.visible(Viewer::Eye(local), &targets)?;
        query_seconds += start.elapsed().as_secs_f64();
        for (&target, answer) in targets.iter().zip(answers) {
            let is_blocked = truth.occluded(town.absolute(target), eye);
            streets.count(is_blocked, answer);
            if !is_blocked && answer == Answer::Blocked {
                blame(&medial, &model, town, (target, local), &mut blockers);
            }
        }
        let answers = medial.visible(Viewer::Eye(local), &own)?;
        for (&place, answer) in outside.iter().zip(answers) {
            of_own.count(truth.occluded(place, eye), answer);
        }
    }
    let balls = model.balls().len();
    Ok(ScannerResults { build_seconds, query_seconds, balls, report, streets, own: of_own, blockers })
}

/// Counts what lies at the point of the ball that blocks a line.
fn blame(
    medial: &MedialScene,
    model: &SceneModel,
    town: &SurveyedScene,
    (target, eye): ([f32; 3], [f64; 3]),
    blockers: &mut BTreeMap<&'static str, (usize, f64)>,
) {
    let Some((towards, range)) = Viewer::Eye(eye).line_of_sight(0, target) else { return };
    let block = medial.first_block(target.map(f64::from), towards, range);
    let Some(ball) = block.and_then(|(blocker, _)| blocker.ball()) else { return };
    let row = model.balls().source[ball] as usize;
    let [scanner, place] = [town.scanner[row], town.cloud.positions[row]].map(|p| town.absolute(p));
    let surface = town.site().surface_of_return(scanner, place);
    let material = surface.and_then(|(hit, _)| town.material(hit.triangle)).map(|material| material.name());
    let of = blockers.entry(material.unwrap_or("nothing")).or_default();
    of.0 += 1;
    of.1 += f64::from(model.balls().radii[ball]);
}

impl AnswerTally {
    fn count(&mut self, is_blocked: bool, answer: Answer) {
        let column = match answer {
            Answer::Blocked => 0,
            Answer::Visible => 1,
            Answer::Unproven => 2,
            _ => return,
        };
        self.0[usize::from(is_blocked)][column] += 1;
    }
}

impl fmt::Display for AnswerTally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [visible, blocked] = self.0;
        let share = |part: usize, of: [usize; 3]| 100.0 * part as f64 / of.iter().sum::<usize>().max(1) as f64;
        let false_visible = share(blocked[1] + blocked[2], blocked);
        let balanced = 100.0 - (share(visible[0], visible) + false_visible) / 2.0;
        write!(
            f,
            "false-blocked {:.2} %, false-visible {:.2} % (unproven besides {:.2} %), balanced {balanced:.2} %; of the visible {:.1} % unproven; {:.1} % visible",
            share(visible[0], visible),
            share(blocked[1], blocked),
            share(blocked[2], blocked),
            share(visible[2], visible),
            100.0 * visible.iter().sum::<usize>() as f64
                / (visible.iter().chain(&blocked).sum::<usize>().max(1)) as f64
        )
    }
}

impl fmt::Display for ScannerResults {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "  built in {:.1} s; {} balls; queried in {:.1} s",
            self.build_seconds, self.balls, self.query_seconds
        )?;
        if let Some(pulses) = &self.report.pulses {
            let blocked = pulses.blocked.map_or(f64::NAN, |blocked| blocked.percent);
            writeln!(f, "  pulses used {}, blocked {blocked:.3} %", pulses.free_segments.used)?;
        }
        if let Some(BallsReport::Carved(carved)) = &self.report.interior_balls {
            writeln!(f, "  {carved:?}")?;
        }
        writeln!(f, "  people in streets: {}", self.streets)?;
        writeln!(f, "  own points: {}", self.own)?;
        for (material, (count, radii)) in &self.blockers {
            writeln!(f, "    falsely blocked at {material}: {count}, mean radius {:.3} m", radii / *count as f64)?;
        }
        Ok(())
    }
}
