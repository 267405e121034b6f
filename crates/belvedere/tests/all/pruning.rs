//! Result of pruning, against closed forms and every pair of balls tried in turn.

use belvedere::control::Control;
use belvedere::medial::{MedialBalls, NO_TOUCH, PruneParams, ShrinkMethod, ShrinkParams, Side, prune, shrink};
use belvedere::neighbors::NeighborIndex;
use belvedere::normals::OrientedCloud;
use belvedere::random::uniform;

fn at(seed: u64, index: u64) -> f32 {
    uniform(seed, index) as f32
}

/// A unit vector that belongs to `index`, spread evenly (Marsaglia's cylinder).
fn direction(index: u64) -> [f32; 3] {
    let z = 2.0 * at(1, index) - 1.0;
    let (sin, cos) = (std::f32::consts::TAU * at(2, index)).sin_cos();
    let across = (1.0 - z * z).max(0.0).sqrt();
    [across * cos, across * sin, z]
}

fn balls_of(cloud: &OrientedCloud, initial_radius: f32) -> (MedialBalls, NeighborIndex) {
    let index = NeighborIndex::new(cloud.positions(), &Control::none()).unwrap();
    let method = ShrinkMethod::Tau { penetration: 1e-3 };
    let params = ShrinkParams { method, initial_radius, max_radius: f32::INFINITY, max_spacings: f32::INFINITY };
    let (balls, _) = shrink(cloud, &index, Side::Interior, &params, &Control::none()).unwrap();
    (balls, index)
}

fn kept(balls: &MedialBalls) -> Vec<usize> {
    (0..balls.len()).filter(|&row| balls.touch[row] != NO_TOUCH).collect()
}

/// Both sides of a plate 1 m thick with a ridge, 100 m long so that it reaches over blocks.
fn plate(count: u64) -> OrientedCloud {
    let point = |i: u64| {
        let (x, y) = (100.0 * at(3, i), 6.0 * at(4, i));
        if i.is_multiple_of(2) {
            let slope = if y < 3.0 { 0.3 } else { -0.3 };
            let length = (1.0_f32 + slope * slope).sqrt();
            ([x, y, 1.0 + slope * (y - 3.0)], [0.0, -slope / length, 1.0 / length])
        } else {
            ([x, y, 0.0], [0.0, 0.0, -1.0])
        }
    };
    let (positions, normals) = (0..count).map(point).unzip();
    OrientedCloud::with_known_normals(positions, normals).unwrap()
}

#[test]
fn of_the_balls_of_a_sphere_one_is_left() {
    let middle = [32.0, 32.0, 5.0];
    let normals: Vec<[f32; 3]> = (0..3000).map(direction).collect();
    let positions = normals.iter().map(|n| std::array::from_fn(|i| middle[i] + 3.0 * n[i])).collect();
    let sphere = OrientedCloud::with_known_normals(positions, normals).unwrap();
    let (mut balls, index) = balls_of(&sphere, 10.0);
    let count = kept(&balls).len();
    let pruned = prune(&mut balls, &sphere, &index, &PruneParams::default(), &Control::none()).unwrap();
    assert_eq!((kept(&balls).len(), pruned), (1, count - 1));
    assert!(count > 2900, "{count}");
}

#[test]
fn every_ball_left_out_has_one_that_stands_in_for_it_and_no_ball_kept_has() {
    let cloud = plate(16_000);
    let (mut balls, index) = balls_of(&cloud, 5.0);
    let before = kept(&balls);
    let params = PruneParams::default();
    prune(&mut balls, &cloud, &index, &params, &Control::none()).unwrap();
    let after = kept(&balls);
    assert!(after.len() * 2 < before.len(), "{} of {}", after.len(), before.len());
    let in_block = |row: usize| cloud.positions()[row][0] < 64.0;
    let stands_in = |row: usize, other: usize| {
        let (p, n) = (cloud.positions()[row].map(f64::from), cloud.normals()[row].map(f64::from));
        let towards: [f64; 3] = std::array::from_fn(|i| f64::from(balls.centers[other][i]) - p[i]);
        let distance = towards.iter().map(|v| v * v).sum::<f64>().sqrt();
        let inward = -(0..3).map(|i| towards[i] * n[i]).sum::<f64>();
        // rounding of f32 at coordinates of a hundred metres
        let margin = |sign: f64| f64::from(params.deviation) + sign * 1e-4;
        let off = (distance - f64::from(balls.radii[other])).abs();
        let is = |sign: f64| off <= margin(sign) && inward >= (0.5 - sign * 1e-4) * distance;
        (is(1.0), is(-1.0))
    };
    for &row in before.iter().filter(|row| !after.contains(row)) {
        assert!(after.iter().any(|&other| stands_in(row, other).0), "ball {row} is missed");
    }
    for &row in &after {
        let larger = |other: &&usize| balls.radii[**other] > balls.radii[row] && in_block(**other) == in_block(row);
        assert!(!after.iter().filter(larger).any(|&other| stands_in(row, other).1), "ball {row} is superfluous");
    }
}

#[test]
fn order_of_points_and_number_of_threads_do_not_matter() {
    let cloud = plate(4000);
    let reversed = OrientedCloud::with_known_normals(
        cloud.positions().iter().rev().copied().collect(),
        cloud.normals().iter().rev().copied().collect(),
    )
    .unwrap();
    let pruned = |cloud: &OrientedCloud, threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let (mut balls, index) = balls_of(cloud, 5.0);
            prune(&mut balls, cloud, &index, &PruneParams::default(), &Control::none()).unwrap();
            let mut rows: Vec<[u32; 3]> =
                kept(&balls).into_iter().map(|row| cloud.positions()[row].map(f32::to_bits)).collect();
            rows.sort_unstable();
            rows
        })
    };
    let expected = pruned(&cloud, 1);
    assert_eq!(pruned(&cloud, 7), expected);
    assert_eq!(pruned(&reversed, 2), expected);
}

#[test]
fn columns_of_another_length_are_refused() {
    let cloud = plate(100);
    let (balls, index) = balls_of(&cloud, 5.0);
    assert!(prune(&mut balls.shrunk(), &plate(101), &index, &PruneParams::default(), &Control::none()).is_err());
}
