//! Fences, wires and what else pulses pass closely on both sides.

use belvedere::control::Control;
use belvedere::medial::{CarvedBalls, CarvedInput, CarvedParams, SlenderParams, carved_balls};
use belvedere::neighbors::NeighborIndex;
use belvedere::normals::estimate::{Neighborhood, estimate};
use belvedere::normals::{Orientation, orient};
use belvedere::pulses::{FreeSegmentParams, FreeSegments};
use belvedere::query::{BlockRule, MedialScene};
use belvedere::random::uniform;
use belvedere::{Attributes, PointCloud};

/// Simulates pulses 0.25 m apart over 20 m × 10 m of ground, tilted by 20° to either side in turn, and their first
/// returns. In the middle stands a box along x from `bottom` to `top`, `width` across; class 1, the ground class 2.
fn survey(bottom: f64, top: f64, width: f64) -> (PointCloud, Vec<[f32; 3]>) {
    let (mut cloud, mut scanner) = (PointCloud::default(), Vec::new());
    let mut classes = Vec::new();
    for i in 0..80_u64 {
        for j in 0..40_u64 {
            let (x, y) =
                (i as f64 * 0.25 + 0.1 * uniform(1, i * 40 + j), j as f64 * 0.25 - 5.0 + 0.1 * uniform(2, i * 40 + j));
            let slope = if (i + j) % 2 == 0 { 0.36 } else { -0.36 };
            // the pulse is at y + slope · z at height z
            let at = |z: f64| y + slope * z;
            let is_in = |z: f64| at(z).abs() <= width / 2.0;
            let side = (slope.signum() * width / 2.0 - y) / slope;
            let z = if is_in(top) {
                top
            } else if (bottom..top).contains(&side) {
                side
            } else {
                0.0
            };
            cloud.positions.push([x as f32, at(z) as f32, z as f32]);
            classes.push(if z > 0.0 { 1 } else { 2 });
            scanner.push([x as f32, at(400.0) as f32, 400.0]);
        }
    }
    cloud.attributes = Attributes { classification: Some(classes), ..Attributes::default() };
    (cloud, scanner)
}

fn carved(cloud: &PointCloud, scanner: &[[f32; 3]], slender: Option<SlenderParams>) -> (CarvedBalls, FreeSegments) {
    let index = NeighborIndex::new(&cloud.positions, &Control::none()).unwrap();
    let normals = estimate(&cloud.positions, &index, Neighborhood::default(), &Control::none()).unwrap();
    let (oriented, _) = orient(cloud, normals, &Orientation::Pulses(scanner), &Control::none()).unwrap();
    let (free_segments, _) =
        FreeSegments::of_cloud(cloud, scanner, &FreeSegmentParams::default(), &Control::none()).unwrap();
    let attributes = &cloud.attributes;
    let input = CarvedInput {
        oriented: &oriented,
        measured: oriented.positions(),
        index: &index,
        attributes,
        free_segments: &free_segments,
        pulses: None,
        statistics: None,
    };
    let params = CarvedParams { slender, ..CarvedParams::default() };
    (carved_balls(&input, &params, &Control::none()).unwrap(), free_segments)
}

/// Share of level lines of sight across the middle, at a height, that are blocked.
fn blocked(found: &CarvedBalls, height: f64) -> f64 {
    let scene = MedialScene::new(&found.balls, &BlockRule::default()).unwrap();
    let lines = 150;
    let blocked = (0..lines).filter(|i| {
        let x = 2.0 + f64::from(*i) * 0.1;
        scene.first_block([x, -3.0, height], [0.0, 1.0, 0.0], 6.0).is_some()
    });
    blocked.count() as f64 / f64::from(lines)
}

#[test]
fn a_fence_blocks_to_the_ground_and_stays_thin() {
    let (cloud, scanner) = survey(0.0, 1.5, 0.06);
    let (without, _) = carved(&cloud, &scanner, None);
    let (with, free_segments) = carved(&cloud, &scanner, Some(SlenderParams::default()));
    let hits = cloud.attributes.classification.as_ref().unwrap().iter().filter(|class| **class == 1).count();
    // the lowest 0.3 m of the fence, a fifth of its hits, are too low to tell; half of them at the least must be found
    assert!(
        with.report.count("points_on_thin_objects") * 2 > hits,
        "{} of {hits}",
        with.report.count("points_on_thin_objects")
    );
    assert!(blocked(&with, 0.7) > 0.9 && blocked(&with, 0.7) > blocked(&without, 0.7), "{}", blocked(&with, 0.7));
    assert_eq!(blocked(&with, 2.0), 0.0);
    // no ball of the fence reaches farther than its radius to either side and half the fence; beyond its ends no pulse
    // passes
    let away_from_ends = |c: &[f32; 3]| (1.0..19.0).contains(&c[0]);
    for (center, radius) in with.balls.centers.iter().zip(&with.balls.radii).filter(|(c, _)| away_from_ends(c)) {
        assert!(center[2] - radius < 0.35 || center[1].abs() + radius < 0.03 + 2.0 * 0.15, "{center:?} {radius}");
    }
    // what fills it is entered by no pulse
    let first = with.balls.len() - with.report.count("balls_in_thin_objects");
    for row in first..with.balls.len() {
        let (center, radius) = (with.balls.centers[row], with.balls.radii[row]);
        assert!(free_segments.clearance(center, 1.0) >= radius);
    }
}

#[test]
fn a_wire_gets_small_balls_and_nothing_below() {
    let (cloud, scanner) = survey(5.9, 6.0, 0.15);
    let (with, _) = carved(&cloud, &scanner, Some(SlenderParams::default()));
    assert!(with.report.count("points_on_thin_objects") > 10, "{:?}", with.report);
    assert_eq!(with.report.count("balls_in_thin_objects"), 0);
    assert_eq!(blocked(&with, 1.0), 0.0);
    let on_wire = |row: &usize| cloud.positions[with.balls.source[*row] as usize][2] > 5.0;
    let small = (0..with.balls.len()).filter(on_wire).filter(|&row| with.balls.radii[row] <= 0.1).count();
    let all = (0..with.balls.len()).filter(on_wire).count();
    // near the ends of the strip no pulse passes beyond; and pulses lie at random
    assert!(small * 10 >= all * 7, "{small} of {all}");
}

#[test]
fn a_block_two_metres_wide_is_not_slender() {
    let (cloud, scanner) = survey(0.0, 1.5, 2.0);
    let (with, _) = carved(&cloud, &scanner, Some(SlenderParams::default()));
    assert_eq!((with.report.count("points_on_thin_objects"), with.report.count("balls_in_thin_objects")), (0, 0));
}

#[test]
fn the_order_of_points_does_not_matter() {
    let (cloud, scanner) = survey(0.0, 1.5, 0.06);
    let reversed: Vec<u32> = (0..cloud.len() as u32).rev().collect();
    let sorted = |cloud: &PointCloud, scanner: &[[f32; 3]]| {
        let (found, _) = carved(cloud, scanner, Some(SlenderParams::default()));
        let balls = found.balls.centers.iter().zip(&found.balls.radii);
        let mut balls: Vec<[u32; 4]> =
            balls.map(|(c, r)| [c[0].to_bits(), c[1].to_bits(), c[2].to_bits(), r.to_bits()]).collect();
        balls.sort_unstable();
        balls
    };
    let backwards: Vec<[f32; 3]> = scanner.iter().rev().copied().collect();
    assert!(sorted(&cloud, &scanner) == sorted(&cloud.select(&reversed), &backwards));
}

#[test]
fn the_clearance_is_a_millimetre_less_than_the_distance_to_the_nearest_of_all_free_segments() {
    let (cloud, scanner) = survey(0.0, 1.5, 0.06);
    let params = FreeSegmentParams::default();
    let (free_segments, _) = FreeSegments::of_cloud(&cloud, &scanner, &params, &Control::none()).unwrap();
    let top = cloud.positions.iter().map(|p| p[2]).fold(f32::NEG_INFINITY, f32::max) + params.headroom;
    for i in 0..300 {
        let at = |k: u64, low: f64, high: f64| low + (high - low) * uniform(7, 3 * i + k);
        let center = [at(0, -1.0, 21.0), at(1, -6.0, 6.0), at(2, -0.5, 5.0)];
        // distance to each free segment in f64, its ends included
        let mut min = 0.501_f64;
        for (p, s) in cloud.positions.iter().zip(&scanner) {
            let (p, s) = (p.map(f64::from), s.map(f64::from));
            let sight: [f64; 3] = std::array::from_fn(|k| s[k] - p[k]);
            let range = sight.iter().map(|v| v * v).sum::<f64>().sqrt();
            let up = sight.map(|v| v / range);
            let from: [f64; 3] = std::array::from_fn(|k| center[k] - p[k]);
            let along: f64 = (0..3).map(|k| from[k] * up[k]).sum();
            let along = along.clamp(f64::from(params.end_margin), (f64::from(top) - p[2]) / up[2]);
            let square: f64 = (0..3).map(|k| (from[k] - along * up[k]).powi(2)).sum();
            min = min.min(square.sqrt());
        }
        // balls stay a millimetre clear of pulses
        let expected = min - 0.001;
        let found = free_segments.clearance(center.map(|v| v as f32), 0.5);
        // ends and directions of free segments are f32: a hundredth of a millimetre at these distances
        assert!((f64::from(found) - expected.max(0.0)).abs() < 1e-4, "{center:?}: {found} instead of {expected}");
    }
}
