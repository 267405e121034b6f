//! Thin relief filled below its points, on a low wall along a flat roof.

use belvedere::Attributes;
use belvedere::control::Control;
use belvedere::medial::{CarvedBalls, CarvedInput, CarvedParams, ReliefParams, carved_balls};
use belvedere::neighbors::NeighborIndex;
use belvedere::normals::OrientedCloud;
use belvedere::pulses::{FreeSegmentParams, FreeSegments};
use belvedere::query::{Answer, BlockRule, MedialScene};
use belvedere::random::uniform;

/// Half the thickness and the height of the wall, metres; it runs north.
const HALF: f64 = 0.125;
const HEIGHT: f64 = 0.8;

struct ReliefSurvey {
    points: Vec<[f32; 3]>,
    scanner: Vec<[f32; 3]>,
}

/// 12 pulses per m² from two lines 60 m to either side, 450 m up. Exact first hits, by hand: the top of the wall, its
/// sides, the roof at height 0.
fn survey(wall_height: f64) -> ReliefSurvey {
    let mut survey = ReliefSurvey { points: Vec::new(), scanner: Vec::new() };
    for i in 0..12 * 8 * 24 {
        let side = if i % 2 == 0 { -1.0 } else { 1.0 };
        let scanner = [60.0 * side, 10.0 * (uniform(3, i) - 0.5), 450.0];
        let aim = [8.0 * (uniform(1, i) - 0.5), 24.0 * (uniform(2, i) - 0.5), 0.0];
        let at = |share: f64| -> [f64; 3] { std::array::from_fn(|k| aim[k] + share * (scanner[k] - aim[k])) };
        let top = at(wall_height / 450.0);
        // where the pulse crosses the plane of the side that faces the scanner
        let beside = at((HALF * side - aim[0]) / (scanner[0] - aim[0]));
        let p = if wall_height > 0.0 && top[0].abs() <= HALF {
            top
        } else if (0.0..wall_height).contains(&beside[2]) {
            beside
        } else {
            aim
        };
        survey.points.push(p.map(|v| v as f32));
        survey.scanner.push(scanner.map(|v| v as f32));
    }
    survey
}

fn free_segments(survey: &ReliefSurvey) -> FreeSegments {
    FreeSegments::new(&survey.points, &survey.scanner, &FreeSegmentParams::default(), &Control::none()).unwrap().0
}

fn balls(survey: &ReliefSurvey, relief: Option<ReliefParams>) -> CarvedBalls {
    // upward everywhere, as neighbours on the roof make them
    let normals = vec![[0.0, 0.0, 1.0]; survey.points.len()];
    let oriented = OrientedCloud::with_known_normals(survey.points.clone(), normals).unwrap();
    let index = NeighborIndex::new(&survey.points, &Control::none()).unwrap();
    let attributes = Attributes { classification: Some(vec![6; survey.points.len()]), ..Attributes::default() };
    let free_segments = free_segments(survey);
    let input = CarvedInput {
        oriented: &oriented,
        measured: oriented.positions(),
        index: &index,
        attributes: &attributes,
        free_segments: &free_segments,
        pulses: None,
        statistics: None,
    };
    carved_balls(&input, &CarvedParams { relief, ..CarvedParams::default() }, &Control::none()).unwrap()
}

/// Share of level lines of sight across the wall straight below points on its top, all of them blocked in truth, that
/// the balls block. They run between 0.2 m above the roof and 0.2 m below the top.
fn blocked_share(survey: &ReliefSurvey, balls: &CarvedBalls) -> f64 {
    let scene = MedialScene::new(&balls.balls, &BlockRule::default()).unwrap();
    let top: Vec<f64> = survey.points.iter().filter(|p| f64::from(p[2]) > HEIGHT - 0.01).map(|p| p[1].into()).collect();
    let is_blocked = |&(i, &north): &(u64, &f64)| {
        let from = [-2.0, north, 0.2 + (HEIGHT - 0.4) * uniform(5, i)];
        scene.answer(from, [1.0, 0.0, 0.0], 4.0) == Answer::Blocked
    };
    assert!(top.len() > 50, "{}", top.len());
    (0..).zip(&top).filter(is_blocked).count() as f64 / top.len() as f64
}

#[test]
fn a_low_wall_hides_what_is_behind_it_below_its_points() {
    let survey = survey(HEIGHT);
    let share = |relief| blocked_share(&survey, &balls(&survey, relief));
    let [without, with] = [share(None), share(Some(ReliefParams::default()))];
    // pulses pass some points at the edges so closely that nothing fits below them
    assert!(with > 0.95 && with > without + 0.1, "{without} {with}");
}

#[test]
fn what_fills_lies_in_the_wall_and_no_pulse_enters_it() {
    let survey = survey(HEIGHT);
    let found = balls(&survey, Some(ReliefParams::default()));
    let fills = found.balls.len() - found.report.count("balls_in_thin_relief")..found.balls.len();
    assert!(fills.len() > 300, "{}", fills.len());
    for ball in fills {
        let (center, radius) = (found.balls.centers[ball].map(f64::from), f64::from(found.balls.radii[ball]));
        assert!(center[0].abs() < HALF + 1e-6 && center[2] > 0.0 && center[2] < HEIGHT, "{center:?}");
        for (p, s) in survey.points.iter().zip(&survey.scanner) {
            let (p, s) = (p.map(f64::from), s.map(f64::from));
            let sight: [f64; 3] = std::array::from_fn(|k| s[k] - p[k]);
            let length = sight.iter().map(|v| v * v).sum::<f64>().sqrt();
            let up = sight.map(|v| v / length);
            let along: f64 = (0..3).map(|k| (center[k] - p[k]) * up[k]).sum();
            // free segments begin 0.05 m above their returns
            let nearest: [f64; 3] = std::array::from_fn(|k| p[k] + up[k] * along.max(0.05));
            let distance = (0..3).map(|k| (center[k] - nearest[k]).powi(2)).sum::<f64>().sqrt();
            // positions are rounded to micrometres, and directions turn by 1e-7 over metres
            assert!(distance > radius - 1e-5, "{center:?} {distance} {radius}");
        }
    }
}

#[test]
fn a_flat_roof_has_no_relief() {
    let found = balls(&survey(0.0), Some(ReliefParams::default()));
    assert_eq!((found.report.count("points_on_thin_relief"), found.report.count("balls_in_thin_relief")), (0, 0));
}

#[test]
fn neither_order_of_points_nor_number_of_threads_matters() {
    let forward = survey(HEIGHT);
    let mut backward = survey(HEIGHT);
    backward.points.reverse();
    backward.scanner.reverse();
    let on = |threads: usize, survey: &ReliefSurvey| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let found = pool.install(|| balls(survey, Some(ReliefParams::default())));
        let bits = |ball: usize| (found.balls.centers[ball].map(f32::to_bits), found.balls.radii[ball].to_bits());
        let fills = found.balls.len() - found.report.count("balls_in_thin_relief")..found.balls.len();
        let mut all: Vec<_> = fills.map(bits).collect();
        all.sort_unstable();
        all
    };
    let expected = on(1, &forward);
    assert!(expected == on(5, &backward) && !expected.is_empty());
}
