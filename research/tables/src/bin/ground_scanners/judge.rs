//! A model of a cloud, compared with the exact town.

use belvedere::control::{Control, StageEnd, Watcher};
use belvedere::medial::CarvedParams;
use belvedere::model::{BallParams, BallsReport, BuildReport, ModelParams, OrientBy, SceneModel};
use belvedere::query::{Answer, MedialScene, UnprovenAs, Viewer, Visibility};
use belvedere::{Bounds, PointCloud, Result};
use belvedere_scenes::{QuerySet, QuerySite, TriangleScene, Truth};
use std::collections::BTreeMap;
use std::fmt;
use std::sync::{Mutex, PoisonError};
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
    peak_mib: Option<f64>,
    balls: usize,
    report: BuildReport,
    streets: AnswerTally,
    own: AnswerTally,
    /// For lines in streets that are falsely blocked: what the point of the ball lies on, how many, and the mean
    /// radius.
    blockers: BTreeMap<&'static str, (usize, f64)>,
}

/// Builds the default model of `cloud`, whose points were measured from `scanner`, and queries what people in streets
/// see.
pub(crate) fn judge(
    scene: &TriangleScene,
    cloud: &PointCloud,
    scanner: &[[f32; 3]],
    seed: u64,
) -> Result<ScannerResults> {
    let params = ModelParams::default()
        .with_orient(OrientBy::ScannerOfEachPoint(scanner.to_vec()))
        .with_balls(BallParams::Carved(CarvedParams::default()));
    let start = Instant::now();
    let (model, report) = SceneModel::build(cloud, &params, &Control::new(&Clock::default()))?;
    let build_seconds = start.elapsed().as_secs_f64();
    let peak_mib = peak_mib();
    let medial = model.scene(&model.rule(), UnprovenAs::Reported, &Control::none())?;

    let truth = Truth::new(scene);
    let origin = cloud.frame.origin;
    let absolute = |p: [f32; 3]| -> [f64; 3] { std::array::from_fn(|i| f64::from(p[i]) + origin[i]) };
    let Bounds { low, high } = cloud.bounds().unwrap_or_default();
    let site = QuerySite { scene, truth: &truth, bounds: [absolute(low), absolute(high)] };
    let targets: Vec<[f32; 3]> = site
        .targets(QuerySet::Pedestrians, TARGETS, seed)
        .positions
        .iter()
        .map(|&p| belvedere::cloud::to_local(p, origin))
        .collect();
    let step = (cloud.len() / OWN).max(1);
    let (own, outside): (Vec<[f32; 3]>, Vec<[f64; 3]>) = (0..cloud.len())
        .step_by(step)
        .filter_map(|row| {
            let p = cloud.positions[row];
            Some((p, site.surface_of_return(absolute(*scanner.get(row)?), absolute(p))?.1))
        })
        .unzip();
    let (mut streets, mut of_own, mut blockers) = (AnswerTally::default(), AnswerTally::default(), BTreeMap::new());
    let mut query_seconds = 0.0;
    for eye in site.street_observers(EYES, seed) {
        let local: [f64; 3] = std::array::from_fn(|i| eye[i] - origin[i]);
        let start = Instant::now();
        let answers = medial.visible(Viewer::Eye(local), &targets)?;
        query_seconds += start.elapsed().as_secs_f64();
        for (&target, answer) in targets.iter().zip(answers) {
            let is_blocked = truth.occluded(absolute(target), eye);
            streets.count(is_blocked, answer);
            if !is_blocked && answer == Answer::Blocked {
                blame(&medial, &model, &site, cloud, scanner, (target, local), &mut blockers);
            }
        }
        let answers = medial.visible(Viewer::Eye(local), &own)?;
        for (&place, answer) in outside.iter().zip(answers) {
            of_own.count(truth.occluded(place, eye), answer);
        }
    }
    let balls = model.balls().len();
    Ok(ScannerResults { build_seconds, query_seconds, peak_mib, balls, report, streets, own: of_own, blockers })
}

/// Counts what lies at the point of the ball that blocks a line.
fn blame(
    medial: &MedialScene,
    model: &SceneModel,
    site: &QuerySite<'_>,
    cloud: &PointCloud,
    scanner: &[[f32; 3]],
    (target, eye): ([f32; 3], [f64; 3]),
    blockers: &mut BTreeMap<&'static str, (usize, f64)>,
) {
    let Some((towards, range)) = Viewer::Eye(eye).line_of_sight(0, target) else { return };
    let block = medial.first_block(target.map(f64::from), towards, range);
    let Some(ball) = block.and_then(|(blocker, _)| blocker.ball()) else { return };
    let row = model.balls().source[ball] as usize;
    let absolute = |p: [f32; 3]| -> [f64; 3] { std::array::from_fn(|i| f64::from(p[i]) + cloud.frame.origin[i]) };
    let surface = site.surface_of_return(absolute(scanner[row]), absolute(cloud.positions[row]));
    let material =
        surface.and_then(|(hit, _)| site.scene.materials.get(hit.triangle as usize)).map(|material| material.name());
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
        let peak = self.peak_mib.map_or("unknown".to_owned(), |mib| format!("{mib:.0} MiB"));
        writeln!(
            f,
            "  built in {:.1} s, at most {peak}; {} balls; queried in {:.1} s",
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

/// Says on standard error how long each stage took.
#[derive(Default)]
struct Clock(Mutex<Option<Instant>>);

impl Watcher for Clock {
    fn begin(&self, _stage: &'static str, _total: usize) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = Some(Instant::now());
    }

    fn end(&self, stage: &'static str, _end: StageEnd) {
        if let Some(start) = *self.0.lock().unwrap_or_else(PoisonError::into_inner) {
            eprintln!("    {:6.2} s {stage}", start.elapsed().as_secs_f64());
        }
    }
}

/// Most memory that the process has held, MiB; `None` where the system does not say.
fn peak_mib() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    line.split_whitespace().nth(1)?.parse::<f64>().ok().map(|kib| kib / 1024.0)
}
