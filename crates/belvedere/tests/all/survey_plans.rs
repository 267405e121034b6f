//! Plans of where to scan again: against closed forms, and against scans of a simulated town from every candidate.

use crate::common::simulated::cloud_of;
use belvedere::apps::survey_plan::{ScannerParams, SurveyGain, SurveyPlan, plan_survey};
use belvedere::cloud::to_local;
use belvedere::control::Control;
use belvedere::medial::{CarvedParams, MedialBalls};
use belvedere::model::{BallParams, ModelParams, OrientBy, SceneModel};
use belvedere::pulses::{FreeSegmentParams, FreeSegments};
use belvedere::query::{Answer, Beside, BlockRule, EarthParams, MedialScene, Proof, ProofParams, UnprovenAs};
use belvedere::{Bounds, Error};
use belvedere_scenes::{
    Preset, QuerySet, QuerySite, Stations, TerrestrialParams, TriangleScene, Truth, scan_terrestrial, town,
};

/// Unproven pieces of a line, local metres.
type Pieces = Vec<[[f64; 3]; 2]>;

/// Creates balls that close the ground of 40 m by 30 m, a wall 10 m long and 6 m high along x = 0, and a lower wall
/// from its middle 4.5 m to the east.
fn walls() -> MedialBalls {
    let mut balls: Vec<([f32; 3], f32)> = Vec::new();
    let steps = |count: u16, size: f32, from: f32| (0..count).map(move |i| from + f32::from(i) * size);
    for x in steps(81, 0.5, -20.0) {
        balls.extend(steps(61, 0.5, -15.0).map(|y| ([x, y, -0.5], 0.5)));
    }
    for z in steps(21, 0.3, 0.0) {
        balls.extend(steps(35, 0.3, -5.0).map(|y| ([0.0, y, z], 0.3)));
        balls.extend(steps(15, 0.3, 0.3).map(|x| ([x, 0.0, z], 0.3)));
    }
    let count = u32::try_from(balls.len()).unwrap();
    MedialBalls {
        centers: balls.iter().map(|ball| ball.0).collect(),
        radii: balls.iter().map(|ball| ball.1).collect(),
        source: (0..count).collect(),
        touch: (0..count).collect(),
        separation_angles: vec![1.0; balls.len()],
    }
}

/// Creates the walls, seen by pulses that fall straight down on the west side only; single ones at the corners of the
/// ground, one of them on a mast of 40 m.
fn seen_from_the_west() -> MedialScene {
    let mut returns: Vec<[f32; 3]> = (0..38_u16)
        .flat_map(|i| (0..60_u16).map(move |k| [-20.0 + f32::from(i) * 0.5, -15.0 + f32::from(k) * 0.5, 0.0]))
        .collect();
    returns.extend([[20.0, -15.0, 0.0], [20.0, 15.0, 40.0]]);
    let scanner: Vec<[f32; 3]> = returns.iter().map(|p| [p[0], p[1], 500.0]).collect();
    let (pulses, _) = FreeSegments::new(&returns, &scanner, &FreeSegmentParams::default(), &Control::none()).unwrap();
    let scene = MedialScene::new(&walls(), &BlockRule::carved()).unwrap();
    scene.with_pulses(Proof::new(pulses, &ProofParams::default()).unwrap())
}

fn pieces(scene: &MedialScene, [observer, target]: [[f64; 3]; 2]) -> Pieces {
    let sight = scene.line_of_sight(observer, target, &EarthParams::default()).unwrap();
    assert_eq!(sight.answer, Answer::Unproven);
    let pieces = scene.unproven_pieces(observer, target, &EarthParams::default());
    let total: f64 = pieces.iter().map(|[from, to]| distance(*from, *to)).sum();
    assert!((total - sight.unproven_length).abs() < 1e-9, "{total} {sight:?}");
    pieces
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
}

/// Candidates of one place each.
fn tripods(eyes: &[[f64; 3]]) -> Vec<Vec<[f64; 3]>> {
    eyes.iter().map(|&eye| vec![eye]).collect()
}

fn plan(scene: &MedialScene, eyes: &[[f64; 3]], lines: &[Pieces], count: usize) -> SurveyPlan {
    let (tripods, params) = (tripods(eyes), ScannerParams::default());
    plan_survey((scene, None), &tripods, lines, count, &params, &Control::none()).unwrap()
}

#[test]
fn the_station_behind_the_wall_is_chosen_and_the_one_before_it_is_not() {
    let scene = seen_from_the_west();
    let lines = [pieces(&scene, [[4.0, 1.5, 1.5], [4.0, 9.0, 1.5]])];
    let (west, east) = ([-8.0, 3.0, 1.8], [10.0, 5.0, 1.8]);
    let found = plan(&scene, &[west, [f64::NAN; 3], east], &lines, 3);
    // the others add nothing, and are not chosen though there may be three
    assert_eq!((&found.chosen[..], found.curve[1].settled, found.reachable.settled), (&[2][..], 1, 1), "{found:?}");
    assert_eq!([found.alone[0].settled, found.alone[1].settled], [0, 0]);
    assert_eq!(found.alone[1], SurveyGain::default(), "a candidate that cannot be used proves nothing");
    assert!((found.curve[1].proven - found.unproven).abs() < 0.5 && found.gap < 1e-9, "{found:?}");
    // beyond its range a scanner proves nothing
    let short = ScannerParams::default().with_max_range(4.0);
    let found = plan_survey((&scene, None), &[vec![east]], &lines, 1, &short, &Control::none()).unwrap();
    assert_eq!((found.chosen.len(), found.reachable), (0, SurveyGain::default()));
    // nor does one whose pulses are farther apart than the proof needs: a pulse each 10 degrees is 1 m off
    let coarse = ScannerParams::default().with_angular_step(0.3);
    let found = plan_survey((&scene, None), &[vec![east]], &lines, 1, &coarse, &Control::none()).unwrap();
    assert_eq!(found.reachable.settled, 0);
}

#[test]
fn two_stations_settle_a_line_together_that_neither_settles_alone() {
    let scene = seen_from_the_west();
    // past the end of the wall that runs east
    let lines = [pieces(&scene, [[5.5, -10.0, 1.5], [5.5, 10.0, 1.5]])];
    let eyes = [[1.5, -4.0, 1.8], [-8.0, 3.0, 1.8], [1.5, 4.0, 1.8]];
    let found = plan(&scene, &eyes, &lines, 2);
    assert_eq!(found.alone.iter().map(|gain| gain.settled).collect::<Vec<_>>(), [0, 0, 0], "{found:?}");
    let mut chosen = found.chosen.clone();
    chosen.sort_unstable();
    assert_eq!(chosen, [0, 2]);
    assert_eq!(found.curve.iter().map(|gain| gain.settled).collect::<Vec<_>>(), [0, 0, 1]);
}

#[test]
fn places_before_the_sky_are_proven_by_no_station() {
    let scene = seen_from_the_west();
    let lines = [pieces(&scene, [[5.0, -8.0, 30.0], [5.0, 8.0, 30.0]])];
    let found = plan(&scene, &[[10.0, 5.0, 1.8], [10.0, -5.0, 1.8]], &lines, 2);
    assert!(found.chosen.is_empty() && found.reachable == SurveyGain::default(), "{found:?}");
    // from above, pulses pass the same places and return from the ground
    let found = plan(&scene, &[[5.0, -8.0, 60.0], [5.0, 8.0, 60.0]], &lines, 2);
    assert!(found.reachable.settled == 1, "{found:?}");
}

#[test]
fn a_plan_depends_neither_on_threads_nor_needs_lines_and_needs_pulses() {
    let scene = seen_from_the_west();
    let ends = |i: u32| [[2.0 + f64::from(i % 5), 1.0, 1.5], [8.0, 1.0 + f64::from(i), 1.5]];
    let lines: Vec<Pieces> = (0..12).map(|i| pieces(&scene, ends(i))).collect();
    let eyes: Vec<[f64; 3]> =
        (0..40).map(|i| [-16.0 + 4.0 * f64::from(i % 8), f64::from(i) / 2.0 - 9.8, 1.8]).collect();
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| plan(&scene, &eyes, &lines, 3))
    };
    let (one, many) = (with(1), with(5));
    assert!(one == many && !one.chosen.is_empty());
    let nothing = plan(&scene, &eyes, &[], 2);
    assert_eq!((nothing.chosen.len(), nothing.unproven), (0, 0.0));
    let blind = MedialScene::new(&walls(), &BlockRule::carved()).unwrap();
    let refused = plan_survey((&blind, None), &tripods(&eyes), &lines, 1, &ScannerParams::default(), &Control::none());
    assert!(matches!(refused, Err(Error::MissingAttribute { .. })));
}

/// A street of a town scanned from two tripods.
struct Streets {
    town: TriangleScene,
    origin: [f64; 3],
    scene: MedialScene,
    lines: Vec<Pieces>,
    candidates: Vec<[f64; 3]>,
}

const SEED: u64 = 5;
/// Angle between pulses: a quarter of the pulses of a coarse scan.
const STEP_DEG: f64 = 1.0;

fn scanner(stations: Stations) -> TerrestrialParams {
    let angular_step = STEP_DEG.to_radians();
    TerrestrialParams { seed: SEED, stations, angular_step, ..TerrestrialParams::default() }
}

fn streets() -> Streets {
    let town = town(&Preset::Town.params(100.0, SEED));
    let scan = scan_terrestrial(&town, &scanner(Stations::Chosen(2)));
    let cloud = cloud_of(&scan);
    let params = ModelParams::default()
        .with_orient(OrientBy::Stations((1..).zip(scan.stations.iter().copied()).collect()))
        .with_balls(BallParams::Carved(CarvedParams::default()));
    let (model, _) = SceneModel::build(&cloud, &params, &Control::none()).unwrap();
    let scene = model.scene(&model.rule(), UnprovenAs::Reported, &Control::none()).unwrap();
    let (truth, origin) = (Truth::new(&town), cloud.frame.origin);
    let Bounds { low, high } = cloud.bounds().unwrap();
    let absolute = |p: [f32; 3]| std::array::from_fn(|i| f64::from(p[i]) + origin[i]);
    // people in the middle: beyond the edge of the town is nothing that pulses could return from
    let (low, high): ([f64; 3], [f64; 3]) = (absolute(low), absolute(high));
    let [west, south] = [0, 1].map(|i| low[i] + 0.25 * (high[i] - low[i]));
    let [east, north] = [0, 1].map(|i| low[i] + 0.75 * (high[i] - low[i]));
    let bounds = [[west, south, low[2]], [east, north, high[2]]];
    let site = QuerySite { scene: &town, truth: &truth, bounds };
    let local = |p: [f64; 3]| std::array::from_fn(|i| p[i] - origin[i]);
    let targets = site.targets(QuerySet::Pedestrians, 40, SEED).positions;
    let mut lines = Vec::new();
    for eye in site.street_observers(20, SEED) {
        for ends in targets.iter().map(|&target| [local(eye), local(target)]) {
            if scene.sight_answer(ends[0], ends[1], &EarthParams::default()) == Answer::Unproven {
                lines.push(pieces(&scene, ends));
            }
        }
    }
    let candidates = site.street_observers(12, SEED + 1);
    Streets { origin, scene, lines, candidates, town }
}

/// Counts the lines that the pulses of one more scan of the exact town settle.
fn truly_settled(streets: &Streets, station: [f64; 3]) -> usize {
    let scan = scan_terrestrial(&streets.town, &scanner(Stations::At(vec![station])));
    let first = (0..scan.len()).filter(|&row| scan.return_number[row] == 1);
    let returns: Vec<[f32; 3]> =
        first.map(|row| to_local([scan.x[row], scan.y[row], scan.z[row]], streets.origin)).collect();
    let from = vec![to_local(station, streets.origin); returns.len()];
    let (pulses, _) = FreeSegments::new(&returns, &from, &FreeSegmentParams::default(), &Control::none()).unwrap();
    let known = streets.scene.proof().unwrap();
    let params = ProofParams { nearness: Some(known.nearness()), beside: Beside::Unseen, ..ProofParams::default() };
    let proof = Proof::new(pulses, &params).unwrap();
    let rest = |[from, to]: &[[f64; 3]; 2]| {
        let size = distance(*from, *to);
        proof.unproven_length(*from, std::array::from_fn(|i| (to[i] - from[i]) / size), size)
    };
    streets.lines.iter().filter(|pieces| pieces.iter().map(rest).sum::<f64>() <= known.tolerance()).count()
}

#[test]
fn in_streets_the_chosen_third_station_proves_nearly_what_the_best_one_proves() {
    let streets = streets();
    let eyes: Vec<[f64; 3]> =
        streets.candidates.iter().map(|place| std::array::from_fn(|i| place[i] - streets.origin[i])).collect();
    let params = ScannerParams::default().with_max_range(120.0).with_angular_step(STEP_DEG.to_radians());
    let plan =
        plan_survey((&streets.scene, None), &tripods(&eyes), &streets.lines, 1, &params, &Control::none()).unwrap();
    let settled: Vec<usize> = streets.candidates.iter().map(|&place| truly_settled(&streets, place)).collect();
    let (best, sum) = (settled.iter().copied().max().unwrap(), settled.iter().sum::<usize>());
    let chosen = settled[plan.chosen[0]];
    // the choice must matter: a station taken at random would not do
    let count = settled.len();
    assert!(streets.lines.len() > 100 && 10 * sum < 8 * best * count, "{} lines, {settled:?}", streets.lines.len());
    assert!(10 * chosen >= 9 * best, "{chosen} of {best}: {settled:?}, {:?}", plan.alone);
}
