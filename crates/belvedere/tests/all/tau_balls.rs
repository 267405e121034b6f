//! Balls of bounded penetration: their guarantee, and that nothing but the points decides them.

use belvedere::control::Control;
use belvedere::medial::feature_size::{Cells, SimplifyParams, simplify};
use belvedere::medial::{LIMIT_TOUCH, MedialBalls, NO_TOUCH, ShrinkMethod, ShrinkParams, ShrinkReport, Side, shrink};
use belvedere::neighbors::NeighborIndex;
use belvedere::normals::OrientedCloud;
use proptest::prelude::*;

const PENETRATION: f32 = 0.05;

fn tau(initial_radius: f32) -> ShrinkParams {
    ShrinkParams {
        method: ShrinkMethod::Tau { penetration: PENETRATION },
        initial_radius,
        max_radius: f32::INFINITY,
        max_spacings: f32::INFINITY,
    }
}

fn balls_of(
    points: &[[f32; 3]],
    normals: &[[f32; 3]],
    side: Side,
    params: &ShrinkParams,
) -> (MedialBalls, ShrinkReport) {
    let index = NeighborIndex::new(points, &Control::none()).unwrap();
    shrink(
        &OrientedCloud::with_known_normals(points.to_vec(), normals.to_vec()).unwrap(),
        &index,
        side,
        params,
        &Control::none(),
    )
    .unwrap()
}

/// A noisy gabled house on noisy ground, with normals that are off by some degrees.
fn house(seed: u64) -> (Vec<[f32; 3]>, Vec<[f32; 3]>) {
    let mut state = seed;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f32 / (1u64 << 24) as f32 - 0.5
    };
    let mut points = Vec::new();
    let mut normals = Vec::new();
    for i in 0..3000 {
        let (u, v) = (40.0 * random(), 40.0 * random());
        let (p, n) = if u.abs() < 5.0 && v.abs() < 8.0 {
            ([u, v, 9.0 - u.abs()], [u.signum() * 0.707, 0.0, 0.707])
        } else if i % 5 == 0 {
            ([5.0 * u.signum(), v * 0.4, 2.0 + 4.0 * random()], [u.signum(), 0.0, 0.0])
        } else {
            ([u, v, 0.0], [0.0, 0.0, 1.0])
        };
        points.push(std::array::from_fn(|k| p[k] + 0.06 * random()));
        let tilted: [f32; 3] = std::array::from_fn(|k| n[k] + 0.2 * random());
        let length = tilted.iter().map(|v| v * v).sum::<f32>().sqrt();
        normals.push(tilted.map(|v| v / length));
    }
    (points, normals)
}

/// Returns the depth of the deepest point inside a ball, metres, in f64.
fn deepest_penetration(points: &[[f32; 3]], center: [f32; 3], radius: f32) -> f64 {
    points
        .iter()
        .map(|p| {
            let square: f64 = (0..3).map(|i| (f64::from(p[i]) - f64::from(center[i])).powi(2)).sum();
            f64::from(radius) - square.sqrt()
        })
        .fold(f64::NEG_INFINITY, f64::max)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]
    #[test]
    fn no_point_lies_deeper_in_a_ball_than_the_penetration(seed in any::<u64>()) {
        let (points, normals) = house(seed);
        for side in [Side::Interior, Side::Exterior] {
            let (balls, _) = balls_of(&points, &normals, side, &tau(30.0));
            for i in (0..balls.len()).step_by(7) {
                let depth = deepest_penetration(&points, balls.centers[i], balls.radii[i]);
                // centres are f32 at coordinates up to 50 m: 4 µm; radii up to 30 m: 2 µm
                prop_assert!(depth <= f64::from(PENETRATION) + 1e-5, "{depth} in a ball of {}", balls.radii[i]);
                if balls.touch[i] != NO_TOUCH {
                    // and it is the largest such ball: the touched point is exactly that deep
                    prop_assert!((depth - f64::from(PENETRATION)).abs() < 1e-4, "{depth} {}", balls.radii[i]);
                }
            }
        }
    }
}

#[test]
fn adding_points_never_enlarges_a_ball() {
    let (points, normals) = house(5);
    let (few, _) = balls_of(&points[..1500], &normals[..1500], Side::Interior, &tau(30.0));
    let (many, _) = balls_of(&points, &normals, Side::Interior, &tau(30.0));
    for i in 0..1500 {
        assert!(many.radii[i] <= few.radii[i], "{i}: {} > {}", many.radii[i], few.radii[i]);
    }
}

#[test]
fn balls_are_bit_identical_for_any_number_of_threads_and_any_order_of_points() {
    let (points, normals) = house(9);
    for params in [tau(30.0), ShrinkParams::angles()] {
        let in_pool = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| balls_of(&points, &normals, Side::Interior, &params).0)
        };
        let one = in_pool(1);
        let bits = |b: &MedialBalls| -> Vec<[u32; 5]> {
            (0..b.len())
                .map(|i| {
                    let [x, y, z] = b.centers[i].map(f32::to_bits);
                    [x, y, z, b.radii[i].to_bits(), b.touch[i]]
                })
                .collect()
        };
        for threads in [2, 7] {
            assert_eq!(bits(&one), bits(&in_pool(threads)));
        }
        let reversed = |v: &[[f32; 3]]| v.iter().rev().copied().collect::<Vec<_>>();
        let (backwards, _) = balls_of(&reversed(&points), &reversed(&normals), Side::Interior, &params);
        let mirrored: Vec<u32> = backwards.radii.iter().rev().map(|r| r.to_bits()).collect();
        assert_eq!(one.radii.iter().map(|r| r.to_bits()).collect::<Vec<_>>(), mirrored);
    }
}

#[test]
fn a_limited_ball_lies_within_the_unlimited_one_and_is_tangent_at_the_same_point() {
    let (points, normals) = house(7);
    let limit = 0.8;
    for params in [tau(30.0), ShrinkParams::angles()] {
        let (full, report) = balls_of(&points, &normals, Side::Interior, &params);
        let (limited, same) =
            balls_of(&points, &normals, Side::Interior, &ShrinkParams { max_radius: limit, ..params });
        assert_eq!((report.shrunk, report.never_shrunk), (same.shrunk, same.never_shrunk + same.limited));
        let mut cut = 0;
        for (i, p) in points.iter().enumerate() {
            if full.touch[i] == NO_TOUCH && limited.touch[i] == LIMIT_TOUCH {
                // nothing bounds it, but the limit does
                assert_eq!(limited.radii[i], limit);
                continue;
            }
            assert_eq!(full.touch[i], limited.touch[i]);
            if full.touch[i] == NO_TOUCH || full.radii[i] <= limit {
                assert_eq!(full.radii[i], limited.radii[i]);
                continue;
            }
            cut += 1;
            let apart = (0..3).map(|k| (full.centers[i][k] - limited.centers[i][k]).powi(2)).sum::<f32>().sqrt();
            let from_p = (0..3).map(|k| (limited.centers[i][k] - p[k]).powi(2)).sum::<f32>().sqrt();
            // f32 at coordinates up to 30 m, radii up to 200 m
            assert!((apart + limit - full.radii[i]).abs() < 1e-4, "{apart} {}", full.radii[i]);
            assert!((from_p - limit).abs() < 1e-4 && limited.radii[i] == limit);
        }
        assert!(cut > 100, "{cut} balls were cut");
    }
}

#[test]
fn points_without_a_normal_get_no_ball_but_still_shrink_others() {
    let points = vec![[0.0, 0.0, 0.0], [0.0, 0.0, -2.0], [1.0, 0.0, 50.0]];
    let normals = vec![[0.0, 0.0, 1.0], [0.0; 3], [0.0, 0.0, 1.0]];
    let (balls, report) = balls_of(&points, &normals, Side::Interior, &tau(10.0));
    assert_eq!(report, ShrinkReport { shrunk: 1, never_shrunk: 1, without_normal: 1, ..ShrinkReport::default() });
    // from the penetration below p down to the second point: a ball of that diameter, plus the penetration
    let expected = (2.0 - PENETRATION) / 2.0 + PENETRATION;
    assert!((balls.radii[0] - expected).abs() < 1e-6 && balls.touch[0] == 1, "{} {}", balls.radii[0], balls.touch[0]);
    assert!((balls.separation_angles[0] - std::f32::consts::PI).abs() < 1e-3);
    assert_eq!((balls.radii[1], balls.touch[1]), (0.0, NO_TOUCH));
    assert_eq!((balls.radii[2], balls.touch[2]), (10.0, NO_TOUCH));
}

#[test]
fn duplicates_neither_stop_nor_enlarge_balls() {
    let (points, normals) = house(3);
    let (plain, _) = balls_of(&points, &normals, Side::Interior, &tau(30.0));
    let twice = |v: &[[f32; 3]]| [v, v].concat();
    let (doubled, _) = balls_of(&twice(&points), &twice(&normals), Side::Interior, &tau(30.0));
    assert_eq!(plain.radii[..], doubled.radii[..points.len()]);
    assert_eq!(plain.radii[..], doubled.radii[points.len()..]);
}

#[test]
fn parameters_out_of_range_are_refused() {
    let (points, normals) = house(1);
    let index = NeighborIndex::new(&points, &Control::none()).unwrap();
    let cloud = OrientedCloud::with_known_normals(points, normals).unwrap();
    let angles = |first: f64| ShrinkParams {
        method: ShrinkMethod::Angles { first_separation_angle: first, next_separation_angle: 0.3 },
        initial_radius: 200.0,
        max_radius: f32::INFINITY,
        max_spacings: f32::INFINITY,
    };
    for bad in [tau(0.0), tau(f32::NAN), tau(f32::INFINITY), tau(0.01), angles(-0.1), angles(f64::NAN)] {
        assert!(shrink(&cloud, &index, Side::Interior, &bad, &Control::none()).is_err(), "{bad:?}");
    }
}

#[test]
fn simplify_leaves_the_density_of_the_feature_size_and_repeats_itself() {
    // 100 x 100 points, 1 m apart in cells of 10 m: 100 a cell; A / (ε·m)² = 100 / (0.4 · 5)² = 25 are to stay
    let points: Vec<[f32; 3]> = (0..10_000).map(|i| [(i % 100) as f32, (i / 100) as f32, 0.0]).collect();
    let sizes = vec![5.0; points.len()];
    let params = SimplifyParams { cell_size: 10.0, ..SimplifyParams::default() };
    let kept = simplify(&points, &sizes, &params).unwrap();
    let share = kept.iter().filter(|&&k| k).count() as f64 / kept.len() as f64;
    // binomial: sigma of the share is sqrt(.25 · .75 / 10000) = 0.0043
    assert!((share - 0.25).abs() < 4.0 * 0.0044, "{share}");
    assert_eq!(kept, simplify(&points, &sizes, &params).unwrap());
    assert_ne!(kept, simplify(&points, &sizes, &SimplifyParams { seed: 2, ..params }).unwrap());
    let all = SimplifyParams { density_limits: [1.0, f32::INFINITY], ..params };
    assert!(simplify(&points, &sizes, &all).unwrap().iter().all(|&k| k));
    assert!(simplify(&points, &sizes[1..], &params).is_err());
    // a step of 13 m in a column makes an edge, which keeps a hundred times as many; in cubes each level is flat
    let stepped: Vec<[f32; 3]> =
        points.iter().map(|p| [p[0], p[1], if p[0] as i32 % 2 == 0 { 0.0 } else { 13.0 }]).collect();
    let columns = SimplifyParams { cells: Cells::Columns, ..params };
    assert!(simplify(&stepped, &sizes, &columns).unwrap().iter().all(|&k| k));
    let no_edges = SimplifyParams { edge_height: None, ..columns };
    let share = simplify(&stepped, &sizes, &no_edges).unwrap().iter().filter(|&&k| k).count() as f64 / 1e4;
    assert!((share - 0.25).abs() < 4.0 * 0.0044, "{share}");
    // where no medial point is reliable the feature size is infinite and one keeps nothing but the lower limit
    assert!(!simplify(&points, &vec![f32::INFINITY; points.len()], &params).unwrap().contains(&true));
}
