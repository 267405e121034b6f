//! Free segments of pulses and balls cut by them, compared with every pulse tried in turn at dense samples, and with
//! closed forms.

use belvedere::control::Control;
use belvedere::medial::{KindCaps, LIMIT_TOUCH, MedialBalls, NO_TOUCH, PULSE_TOUCH, RadiusCaps, carve, kinds};
use belvedere::neighbors::Tangent;
use belvedere::normals::{Normals, Orientation, orient};
use belvedere::pulses::{FreeSegmentParams, FreeSegments};
use belvedere::random::uniform;
use belvedere::{Attributes, PointCloud};

fn at(seed: u64, index: u64) -> f64 {
    uniform(seed, index)
}

/// First returns on a bumpy surface, seen from two strips 400 m up, 250 m to either side.
fn survey(count: u64) -> (Vec<[f32; 3]>, Vec<[f32; 3]>) {
    let mut returns = Vec::new();
    let mut scanner = Vec::new();
    for i in 0..count {
        let (x, y) = (100.0 * at(1, 2 * i), 100.0 * at(1, 2 * i + 1));
        let z = 4.0 * (x / 9.0).sin() + 6.0 * (y / 13.0).cos() + if (x / 20.0) as i64 % 2 == 0 { 8.0 } else { 0.0 };
        returns.push([x as f32, y as f32, z as f32]);
        let side = if i % 2 == 0 { -250.0 } else { 350.0 };
        scanner.push([side, (y + 10.0 * at(2, i)) as f32, 400.0]);
    }
    (returns, scanner)
}

/// First returns anywhere about three scanners in their midst and one that drives through: pulses in all directions,
/// some of them short.
fn survey_from_the_ground(count: u64) -> (Vec<[f32; 3]>, Vec<[f32; 3]>) {
    let stations = [[20.0, 30.0, 1.5], [70.0, 40.0, 6.0], [55.0, 90.0, -2.0]];
    let of = |i: u64| {
        let place = [100.0 * at(31, i), 100.0 * at(32, i), 30.0 * at(33, i) - 8.0].map(|v| v as f32);
        let scanner = match i % 5 {
            4 => [90.0 * at(34, i) as f32, 50.0, 2.0],
            3 => std::array::from_fn(|axis| place[axis] + 1.2 - at(35, 3 * i + axis as u64) as f32),
            station => stations[station as usize],
        };
        (place, scanner)
    };
    (0..count).map(of).unzip()
}

/// Distance between pulses, metres: ten a square metre.
const SPACING: f32 = 0.316;

/// Caps by kind of point.
fn caps(attributes: &Attributes, count: usize) -> RadiusCaps {
    RadiusCaps::by_kind(&kinds(attributes, count), attributes, &vec![SPACING; count], &KindCaps::default())
}

/// A pencil of balls at a random place, pointing anywhere.
fn pencil(i: u64) -> Tangent {
    let direction: [f64; 3] = std::array::from_fn(|k| at(5, 3 * i + k as u64) - 0.5);
    let length = direction.iter().map(|v| v * v).sum::<f64>().sqrt();
    let point = [100.0 * at(6, 3 * i), 100.0 * at(6, 3 * i + 1), 30.0 * at(6, 3 * i + 2) - 8.0];
    Tangent { point: point.map(|v| v as f32), inward: direction.map(|v| (v / length) as f32), margin: 0.02 }
}

/// Radius of the largest ball of a pencil, metres.
const LARGEST: f32 = 12.0;

/// Least radius of the balls of a pencil that touch one of many places along the free segments, in f64. Free segments
/// that no ball up to [`LARGEST`] reaches are left out.
fn brute_force(tangent: &Tangent, returns: &[[f32; 3]], scanner: &[[f32; 3]], params: &FreeSegmentParams) -> f64 {
    let top = returns.iter().map(|p| p[2]).fold(f32::NEG_INFINITY, f32::max) + params.headroom;
    let inward = tangent.inward.map(f64::from);
    let touching: [f64; 3] =
        std::array::from_fn(|i| f64::from(tangent.point[i]) + inward[i] * f64::from(tangent.margin));
    let mut min = f64::INFINITY;
    for (p, s) in returns.iter().zip(scanner) {
        let sight: [f64; 3] = std::array::from_fn(|i| f64::from(s[i]) - f64::from(p[i]));
        let range = sight.iter().map(|v| v * v).sum::<f64>().sqrt();
        let up = sight.map(|v| v / range);
        let to_top = if up[2] > 0.0 { (f64::from(top) - f64::from(p[2])) / up[2] } else { f64::INFINITY };
        let (from, to) = (f64::from(params.end_margin), to_top.min(range));
        let offset = |t: f64| -> [f64; 3] { std::array::from_fn(|i| f64::from(p[i]) + t * up[i] - touching[i]) };
        let from_start = offset(0.0);
        let nearest = offset((0..3).map(|i| -from_start[i] * up[i]).sum::<f64>().max(from).min(to));
        // all of a ball lies within its diameter of any place on it
        if nearest.iter().map(|v| v * v).sum::<f64>().sqrt() > 2.0 * f64::from(LARGEST) {
            continue;
        }
        let radius = |t: f64| {
            let q = offset(t);
            let height: f64 = (0..3).map(|i| inward[i] * q[i]).sum();
            let square: f64 = q.iter().map(|v| v * v).sum();
            if height > 0.0 { square / (2.0 * height) } else { f64::INFINITY }
        };
        // 5 cm apart, then closing in about the best: the function has one valley
        let steps = ((to - from) / 0.05).ceil().max(1.0) as u32;
        let place = |k: u32| from + (to - from) * f64::from(k) / f64::from(steps);
        let (_, best) = (0..=steps).map(|k| (radius(place(k)), k)).min_by(|a, b| a.0.total_cmp(&b.0)).unwrap();
        let (mut low, mut high) = (place(best.saturating_sub(1)), place((best + 1).min(steps)));
        for _ in 0..80 {
            let third = (high - low) / 3.0;
            if radius(low + third) < radius(high - third) {
                high -= third;
            } else {
                low += third;
            }
        }
        min = min.min(radius(place(best))).min(radius((low + high) / 2.0));
    }
    min
}

#[test]
fn the_ball_that_no_pulse_enters_is_that_of_all_pulses_tried_in_turn() {
    let params = FreeSegmentParams::default();
    for (returns, scanner) in [survey(3000), survey_from_the_ground(3000)] {
        let (free_segments, report) = FreeSegments::new(&returns, &scanner, &params, &Control::none()).unwrap();
        assert_eq!((report.used, report.without_scanner), (3000, 0));
        let mut cut_count = 0;
        for i in 0..120 {
            let tangent = pencil(i);
            let expected = brute_force(&tangent, &returns, &scanner, &params);
            let found = free_segments.smallest_tangent_ball(&tangent, LARGEST);
            if let Some(radius) = found {
                cut_count += 1;
                // ends of free segments are f32, off by 1e-5 m, which a ball of the pencil magnifies where the segment
                // grazes its plane
                let off = (f64::from(radius) - expected).abs();
                assert!(off < 1e-3 + 1e-3 * expected, "pencil {i}: {radius} instead of {expected}");
            } else {
                assert!(expected > 11.98, "pencil {i}: a pulse enters down to {expected}");
            }
        }
        assert!((40..=120).contains(&cut_count), "{cut_count}");
    }
}

#[test]
fn a_ball_beside_a_curtain_of_pulses_shrinks_to_the_closed_form() {
    // vertical pulses along the plane x = 3 cut balls at the origin that grow towards +x: the largest has its far side
    // there
    let returns: Vec<[f32; 3]> = (-200..=200).map(|i| [3.0, 0.05 * i as f32, -20.0]).collect();
    let scanner: Vec<[f32; 3]> = returns.iter().map(|p| [p[0], p[1], 500.0]).collect();
    // one return high up, so that free segments reach past the balls
    let (returns, scanner) =
        ([returns, vec![[50.0, 50.0, 30.0]]].concat(), [scanner, vec![[50.0, 50.0, 500.0]]].concat());
    let (free_segments, _) =
        FreeSegments::new(&returns, &scanner, &FreeSegmentParams::default(), &Control::none()).unwrap();
    let tangent = Tangent { point: [0.0; 3], inward: [1.0, 0.0, 0.0], margin: 0.0 };
    let radius = free_segments.smallest_tangent_ball(&tangent, 10.0).unwrap();
    assert!((radius - 1.5).abs() < 1e-5, "{radius}");
    // growing away from them none is met
    assert_eq!(free_segments.smallest_tangent_ball(&Tangent { inward: [-1.0, 0.0, 0.0], ..tangent }, 10.0), None);
    // a radius below that of the cut is left alone
    assert_eq!(free_segments.smallest_tangent_ball(&tangent, 1.4), None);
}

#[test]
fn pulses_without_scanner_are_counted_and_cut_nothing() {
    let returns = [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]];
    // a pulse without length proves nothing either
    let scanner = [[f32::NAN; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 300.0]];
    let (_, report) = FreeSegments::new(&returns, &scanner, &FreeSegmentParams::default(), &Control::none()).unwrap();
    assert_eq!((report.used, report.without_scanner), (1, 1));
    assert!(FreeSegments::new(&returns, &scanner[..2], &FreeSegmentParams::default(), &Control::none()).is_err());
    let (none, _) = FreeSegments::new(&[], &[], &FreeSegmentParams::default(), &Control::none()).unwrap();
    let tangent = Tangent { point: [0.0; 3], inward: [0.0, 0.0, 1.0], margin: 0.0 };
    assert_eq!(none.smallest_tangent_ball(&tangent, 5.0), None);
}

/// A scene of points with upward normals, each with an interior ball of 5 m that met nothing.
fn balls_below(positions: Vec<[f32; 3]>) -> (PointCloud, belvedere::normals::OrientedCloud, MedialBalls) {
    let count = positions.len();
    let cloud = PointCloud { positions, ..PointCloud::default() };
    let normals = Normals { vectors: vec![[0.0, 0.0, 1.0]; count], quality: vec![1.0; count] };
    let (oriented, _) = orient(&cloud, normals, &Orientation::Up, &Control::none()).unwrap();
    let balls = MedialBalls {
        centers: cloud.positions.iter().map(|p| [p[0], p[1], p[2] - 5.0]).collect(),
        radii: vec![5.0; count],
        source: (0..).take(count).collect(),
        touch: vec![NO_TOUCH; count],
        separation_angles: vec![f32::NAN; count],
    };
    (cloud, oriented, balls)
}

#[test]
fn a_deck_is_cut_to_what_slanted_pulses_leave_below_it() {
    // a deck at z = 6 whose underside slanted pulses pass: they hit the ground below it, coming in at 45 degrees
    let (cloud, oriented, mut balls) = balls_below(vec![[0.0, 0.0, 6.0]]);
    let returns: Vec<[f32; 3]> = (-40..=40).map(|i| [-6.0 + 4.0, 0.1 * i as f32, 0.0]).collect();
    let scanner: Vec<[f32; 3]> = returns.iter().map(|p| [p[0] + 400.0, p[1], 400.0]).collect();
    let returns = [returns, vec![[60.0, 0.0, 20.0]]].concat();
    let scanner = [scanner, vec![[60.0, 0.0, 400.0]]].concat();
    let (free_segments, _) =
        FreeSegments::new(&returns, &scanner, &FreeSegmentParams::default(), &Control::none()).unwrap();
    let report =
        carve(&mut balls, &oriented, &free_segments, &caps(&cloud.attributes, cloud.len()), &Control::none()).unwrap();
    // the line x − z = −2 passes the axis of the balls at z = 2: the ball below (0, 0, 6) of radius r has its
    // centre 6 − r high, (4 − r)/√2 from the line; that equals r for r = 4/(1 + √2)
    let expected = 4.0 / (1.0 + 2f32.sqrt());
    assert!((balls.radii[0] - expected).abs() < 0.01, "{} instead of {expected}", balls.radii[0]);
    assert_eq!((report.carved, balls.touch[0]), (1, PULSE_TOUCH));
    assert!((balls.centers[0][2] - (6.0 - balls.radii[0])).abs() < 2e-3);
}

#[test]
fn kinds_of_points_bound_their_balls_and_carving_twice_changes_nothing() {
    let (mut cloud, oriented, mut balls) = balls_below((0..5).map(|i| [10.0 * i as f32, 0.0, 0.0]).collect());
    cloud.attributes.classification = Some(vec![6, 5, 2, 6, 6]);
    cloud.attributes.return_number = Some(vec![1, 1, 1, 2, 1]);
    let (free_segments, _) = FreeSegments::new(&[], &[], &FreeSegmentParams::default(), &Control::none()).unwrap();
    let report =
        carve(&mut balls, &oriented, &free_segments, &caps(&cloud.attributes, cloud.len()), &Control::none()).unwrap();
    // what nothing bounds is cut to half a metre
    assert_eq!(balls.radii, [0.5, 1.0, 2.0, 0.95 * SPACING, 0.5]);
    assert_eq!((report.carved, report.limited), (0, 5));
    assert_eq!(balls.touch, [LIMIT_TOUCH; 5]);
    let once = balls.clone();
    carve(&mut balls, &oriented, &free_segments, &caps(&cloud.attributes, cloud.len()), &Control::none()).unwrap();
    assert_eq!(balls.radii, once.radii);
    assert!(carve(&mut balls, &oriented, &free_segments, &caps(&cloud.attributes, 1), &Control::none()).is_err());
}

#[test]
fn carving_gives_the_same_bits_for_any_number_of_threads_and_order_of_pulses() {
    let (returns, scanner) = survey(20_000);
    let run = |threads: usize, backwards: bool| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let (mut returns, mut scanner) = (returns.clone(), scanner.clone());
            if backwards {
                returns.reverse();
                scanner.reverse();
            }
            let (free_segments, _) =
                FreeSegments::new(&returns, &scanner, &FreeSegmentParams::default(), &Control::none()).unwrap();
            let points: Vec<[f32; 3]> = (0..3000).map(|i| pencil(i).point).collect();
            let (cloud, oriented, mut balls) = balls_below(points);
            let report =
                carve(&mut balls, &oriented, &free_segments, &caps(&cloud.attributes, cloud.len()), &Control::none())
                    .unwrap();
            (balls.radii, balls.centers, report)
        })
    };
    let one = run(1, false);
    assert!(one.2.carved > 500, "{:?}", one.2);
    assert!(one == run(2, false) && one == run(7, true));
}
