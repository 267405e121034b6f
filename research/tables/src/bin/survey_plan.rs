//! Whether `belvedere survey-plan` chooses the station that truly proves most: streets scanned from two tripods, lines
//! of sight between people in them, and a third station that is chosen out of many candidates.
//!
//! ```sh
//! cargo research survey_plan -- town 110 5,6 200
//! ```
//!
//! prints the table of docs/methods/survey-plan.md: kinds of towns, their extent in metres, seeds, candidates. Every
//! candidate is scanned in the exact town, and its pulses are put beside those of the two. The balls stay those of two
//! stations, but for the chosen station and the best one, for which the model is built again from three. People and
//! candidates are in the middle of the town: beyond its edge is nothing, and pulses do not return from there.
#![allow(clippy::print_stdout, reason = "an example talks")]

use belvedere::apps::eyes::fault_of;
use belvedere::apps::survey_plan::{ScannerParams, SurveyGain, plan_survey};
use belvedere::cloud::to_local;
use belvedere::control::Control;
use belvedere::ground::{Ground, GroundParams, MapGrid};
use belvedere::medial::CarvedParams;
use belvedere::model::{BallParams, ModelParams, OrientBy, SceneModel};
use belvedere::pulses::{FreeSegmentParams, FreeSegments};
use belvedere::query::{Answer, Beside, EarthParams, MedialScene, Proof, ProofParams, UnprovenAs};
use belvedere::{PointCloud, Result};
use belvedere_baselines::simulated::surveyed;
use belvedere_scenes::{
    Preset, QuerySet, QuerySite, Stations, TerrestrialParams, TriangleScene, Truth, scan_terrestrial, town,
};
use std::time::Instant;

type AnyResult<T> = std::result::Result<T, Box<dyn std::error::Error>>;
/// Observer and target, local metres.
type Line = [[f64; 3]; 2];
/// The ends of pieces of a line, local metres.
type Pieces = Vec<[[f64; 3]; 2]>;

/// Observers and targets of lines, and how long these may be, metres.
const PEOPLE: [usize; 2] = [60, 100];
const MAX_LENGTH: f64 = 60.0;
/// Between which shares of the sides of the town people and candidates are.
const INNER: [f64; 2] = [0.2, 0.8];
/// Angle between pulses, degrees.
const STEP_DEG: f64 = 0.5;

fn main() -> AnyResult<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let word = |i: usize, usual: &'static str| arguments.get(i).map_or(usual, String::as_str);
    let extent: f64 = word(1, "80").parse()?;
    println!(
        "town | seed | unproven | if nothing stands | expected | proven by the chosen | best | ratio | median | rebuilt | rank"
    );
    for name in word(0, "town").split(',') {
        let preset = Preset::ALL.into_iter().find(|preset| preset.name() == name).ok_or("no such town")?;
        for seed in word(2, "5").split(',') {
            let seed: u64 = seed.parse()?;
            let town = town(&preset.params(extent, seed));
            let streets = Streets::new(&town, seed)?;
            streets.report(name, word(3, "200").parse()?)?;
        }
    }
    Ok(())
}

/// A town scanned from two stations, with the lines of sight that remain unproven.
struct Streets<'a> {
    town: &'a TriangleScene,
    truth: Truth,
    seed: u64,
    stations: Vec<[f64; 3]>,
    cloud: PointCloud,
    medial: MedialScene,
    lines: Vec<Line>,
    open: Vec<Pieces>,
}

fn scanner(seed: u64, stations: Stations) -> TerrestrialParams {
    TerrestrialParams { seed, stations, angular_step: STEP_DEG.to_radians(), ..TerrestrialParams::default() }
}

/// The model of a town scanned from these stations.
fn built(town: &TriangleScene, stations: Stations, seed: u64) -> Result<(PointCloud, MedialScene, Vec<[f64; 3]>)> {
    let scan = scan_terrestrial(town, &scanner(seed, stations));
    let (cloud, positions) = surveyed(&scan)?;
    let params = ModelParams::default()
        .with_orient(OrientBy::ScannerOfEachPoint(positions))
        .with_balls(BallParams::Carved(CarvedParams::default()));
    let (model, _) = SceneModel::build(&cloud, &params, &Control::none())?;
    let medial = model.scene(&model.rule(), UnprovenAs::Reported, &Control::none())?;
    Ok((cloud, medial, scan.stations))
}

fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

fn length(a: [f64; 3]) -> f64 {
    a.iter().map(|v| v * v).sum::<f64>().sqrt()
}

impl<'a> Streets<'a> {
    fn new(town: &'a TriangleScene, seed: u64) -> AnyResult<Self> {
        let truth = Truth::new(town);
        let (cloud, medial, stations) = built(town, Stations::Chosen(2), seed)?;
        let mut streets = Self { town, truth, seed, stations, cloud, medial, lines: Vec::new(), open: Vec::new() };
        let site = streets.site();
        let targets = site.targets(QuerySet::Pedestrians, PEOPLE[1], seed).positions;
        let mut lines = Vec::new();
        for eye in site.street_observers(PEOPLE[0], seed) {
            let near = targets.iter().filter(|target| length(sub(**target, eye)) <= MAX_LENGTH);
            lines.extend(near.map(|&target| [eye, target].map(|end| sub(end, streets.cloud.frame.origin))));
        }
        let earth = EarthParams::default();
        lines.retain(|&[eye, target]| streets.medial.sight_answer(eye, target, &earth) == Answer::Unproven);
        let open = |&[eye, target]: &Line| streets.medial.unproven_pieces(eye, target, &earth);
        streets.open = lines.iter().map(open).collect();
        streets.lines = lines;
        Ok(streets)
    }

    /// Places of the exact town over the cloud.
    fn site(&self) -> QuerySite<'_> {
        let bounds = self.cloud.bounds().unwrap_or_default();
        let absolute = |p: [f32; 3]| std::array::from_fn(|i| f64::from(p[i]) + self.cloud.frame.origin[i]);
        let (low, high): ([f64; 3], [f64; 3]) = (absolute(bounds.low), absolute(bounds.high));
        let bounds = INNER.map(|share| [0, 1].map(|i| low[i] + share * (high[i] - low[i])));
        let [[west, south], [east, north]] = bounds;
        QuerySite { scene: self.town, truth: &self.truth, bounds: [[west, south, low[2]], [east, north, high[2]]] }
    }

    /// Places in streets, absolute.
    fn candidates(&self, count: usize) -> Vec<[f64; 3]> {
        let mut places = self.site().street_observers(2 * count, self.seed + 1000);
        let local = |place: &[f64; 3]| sub(*place, self.cloud.frame.origin);
        places.retain(|place| fault_of(&self.medial, None, local(place)).is_none());
        places.truncate(count);
        places
    }

    /// How many of the unproven lines the pulses of one more station prove, together with those of the others.
    fn settled_by(&self, station: [f64; 3]) -> Result<SurveyGain> {
        let scan = scan_terrestrial(self.town, &scanner(self.seed, Stations::At(vec![station])));
        let origin = self.cloud.frame.origin;
        let is_first = |row: &usize| scan.return_number[*row] == 1;
        let returns: Vec<[f32; 3]> = (0..scan.len())
            .filter(is_first)
            .map(|row| to_local([scan.x[row], scan.y[row], scan.z[row]], origin))
            .collect();
        let from = vec![to_local(station, origin); returns.len()];
        let (pulses, _) = FreeSegments::new(&returns, &from, &FreeSegmentParams::default(), &Control::none())?;
        let Some(known) = self.medial.proof() else { return Ok(SurveyGain::default()) };
        let params = ProofParams { nearness: Some(known.nearness()), beside: Beside::Unseen, ..ProofParams::default() };
        let proof = Proof::new(pulses, &params)?;
        let mut gain = SurveyGain::default();
        for pieces in &self.open {
            let (mut before, mut after) = (0.0, 0.0);
            for &[from, to] in pieces {
                let along = sub(to, from);
                let size = length(along);
                before += size;
                after += proof.unproven_length(from, along.map(|v| v / size), size);
            }
            gain.settled += usize::from(after <= known.tolerance());
            gain.proven += before - after;
        }
        Ok(gain)
    }

    /// How many of the unproven lines are no longer so where the model is built from one more station.
    fn settled_in_model_with(&self, station: [f64; 3]) -> Result<usize> {
        let stations = self.stations.iter().copied().chain([station]).collect();
        let (cloud, medial, _) = built(self.town, Stations::At(stations), self.seed)?;
        let moved = |end: [f64; 3]| {
            let absolute: [f64; 3] = std::array::from_fn(|i| end[i] + self.cloud.frame.origin[i]);
            sub(absolute, cloud.frame.origin)
        };
        let answer = |[eye, target]: Line| medial.sight_answer(moved(eye), moved(target), &EarthParams::default());
        Ok(self.lines.iter().filter(|&&line| answer(line) == Answer::Visible).count())
    }

    fn report(&self, name: &str, count: usize) -> AnyResult<()> {
        let candidates = self.candidates(count);
        let station = |&place: &[f64; 3]| vec![sub(place, self.cloud.frame.origin)];
        let stations: Vec<Vec<[f64; 3]>> = candidates.iter().map(station).collect();
        let params = ScannerParams::default().with_max_range(120.0).with_angular_step(STEP_DEG.to_radians());
        let start = Instant::now();
        let (low, high) = self.cloud.bounds().unwrap_or_default().on_map();
        let grid = MapGrid::covering(low, high, 1.0, [0.0; 2])?;
        let (ground, _) = Ground::of_cloud(&self.cloud, grid, &GroundParams::default(), &Control::none())?;
        let plan = plan_survey((&self.medial, Some(&ground)), &stations, &self.open, 1, &params, &Control::none())?;
        let seconds = start.elapsed().as_secs_f64();
        let found: Vec<SurveyGain> = candidates.iter().map(|&place| self.settled_by(place)).collect::<Result<_>>()?;
        let settled = |row: usize| found[row].settled;
        let best = (0..found.len()).max_by_key(|&row| settled(row)).ok_or("no candidate")?;
        let &chosen = plan.chosen.first().ok_or("no choice")?;
        let mut sorted: Vec<usize> = found.iter().map(|gain| gain.settled).collect();
        sorted.sort_unstable();
        let rank = sorted.iter().filter(|other| **other > settled(chosen)).count() + 1;
        let rebuilt = [chosen, best].map(|row| self.settled_in_model_with(candidates[row]));
        let [rebuilt_chosen, rebuilt_best] = rebuilt;
        println!(
            "{name} | {} | {} | {} | {:.0} | {} | {} | {:.3} | {} | {}, {} | {rank} of {} | {seconds:.1} s",
            self.seed,
            self.lines.len(),
            plan.alone[chosen].settled,
            plan.alone[chosen].expected,
            settled(chosen),
            settled(best),
            settled(chosen) as f64 / settled(best).max(1) as f64,
            sorted[sorted.len() / 2],
            rebuilt_chosen?,
            rebuilt_best?,
            sorted.len(),
        );
        Ok(())
    }
}
