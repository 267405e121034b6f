//! Crowns of trees: what pulses get through them, what limits and what fills their balls.

use belvedere::control::Control;
use belvedere::medial::{CarvedBalls, CarvedInput, CarvedParams, CrownParams, Trees, carved_balls};
use belvedere::neighbors::NeighborIndex;
use belvedere::normals::estimate::{Neighborhood, estimate};
use belvedere::normals::{Orientation, orient};
use belvedere::pulses::{FreeSegmentParams, FreeSegments, group};
use belvedere::random::uniform;
use belvedere::{Attributes, PointCloud};

/// Creates returns of vertical pulses 0.25 m apart over 12 m × 12 m of ground, with a crown from 3 m up to 8 m on 8 m ×
/// 8 m of it. The first return is at 8 m. Every `nth` pulse continues to the ground; the others have their last return
/// at `base`.
fn tree(nth: usize, base: f32) -> PointCloud {
    let mut cloud = PointCloud::default();
    let (mut classes, mut numbers, mut counts, mut times) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let mut met = 0;
    for i in 0..48_u32 {
        for j in 0..48_u32 {
            let (x, y) = (i as f32 * 0.25, j as f32 * 0.25);
            let is_crown = (2.0..10.0).contains(&x) && (2.0..10.0).contains(&y);
            let returns = if is_crown {
                met += 1;
                vec![(8.0, 5), if met % nth == 0 { (0.0, 2) } else { (base, 5) }]
            } else {
                vec![(0.0, 2)]
            };
            for (number, &(z, class)) in returns.iter().enumerate() {
                cloud.positions.push([x, y, z]);
                classes.push(class);
                numbers.push(number as u8 + 1);
                counts.push(returns.len() as u8);
                times.push(1.0 + f64::from(i * 48 + j) * 1e-5);
            }
        }
    }
    cloud.attributes = Attributes {
        classification: Some(classes),
        return_number: Some(numbers),
        return_count: Some(counts),
        gps_time: Some(times),
        ..Attributes::default()
    };
    cloud
}

fn carved(cloud: &PointCloud, params: &CarvedParams) -> CarvedBalls {
    let scanner: Vec<[f32; 3]> = cloud.positions.iter().map(|p| [p[0], p[1], 400.0]).collect();
    let index = NeighborIndex::new(&cloud.positions, &Control::none()).unwrap();
    let normals = estimate(&cloud.positions, &index, Neighborhood::default(), &Control::none()).unwrap();
    let (oriented, _) = orient(cloud, normals, &Orientation::Pulses(&scanner), &Control::none()).unwrap();
    let (free_segments, _) =
        FreeSegments::of_cloud(cloud, &scanner, &FreeSegmentParams::default(), &Control::none()).unwrap();
    let (pulses, _) = group(cloud, &Control::none()).unwrap();
    let input = CarvedInput {
        oriented: &oriented,
        measured: oriented.positions(),
        index: &index,
        attributes: &cloud.attributes,
        free_segments: &free_segments,
        pulses: Some(&pulses),
        statistics: None,
    };
    carved_balls(&input, params, &Control::none()).unwrap()
}

fn trees(trees: Trees) -> CarvedParams {
    CarvedParams { crowns: Some(CrownParams { trees, ..CrownParams::default() }), ..CarvedParams::default() }
}

fn class_of(cloud: &PointCloud, row: u32) -> u8 {
    cloud.attributes.classification.as_ref().unwrap()[row as usize]
}

#[test]
fn the_share_of_pulses_that_reach_the_ground_is_the_transmission_of_a_crown() {
    // every fourth pulse in turn, so that each piece has about the same share
    let cloud = tree(4, 3.0);
    let found = carved(&cloud, &CarvedParams::default());
    assert_eq!(found.transmission.len(), found.balls.len());
    let mut crown_count = 0;
    for (&source, &share) in found.balls.source.iter().zip(&found.transmission) {
        if class_of(&cloud, source) == 5 {
            crown_count += 1;
            // columns of the crown are 32 pulses, whole fours, so that a piece is off by a column of four at most
            assert!((share - 0.25).abs() < 0.01, "{share}");
        } else {
            assert!(share.is_nan(), "{share} at the ground");
        }
    }
    assert!(crown_count > 500, "{crown_count}");
    // a return inside the crown, however much deeper than the first, is no way through
    let stopped = carved(&tree(100_000, 3.0), &CarvedParams::default());
    assert!(stopped.transmission.iter().all(|share| share.is_nan() || *share == 0.0));
}

#[test]
fn a_piece_with_few_pulses_keeps_near_the_share_of_the_whole() {
    // the tree, and a single pulse 100 m away that went through a leaf to the ground
    let mut cloud = tree(4, 3.0);
    let alone = cloud.positions.len() as u32;
    cloud.positions.extend([[100.5, 100.5, 6.0], [100.5, 100.5, 0.0]]);
    let attributes = &mut cloud.attributes;
    attributes.classification.as_mut().unwrap().extend([5, 2]);
    attributes.return_number.as_mut().unwrap().extend([1, 2]);
    attributes.return_count.as_mut().unwrap().extend([2, 2]);
    attributes.gps_time.as_mut().unwrap().extend([2.0, 2.0]);
    let found = carved(&cloud, &CarvedParams::default());
    let ball = found.balls.source.iter().position(|&source| source == alone);
    // the 1024 pulses of the tree and this one: 257 of 1025, which counts as four pulses beside it
    let expected = (1.0 + 4.0 * 257.0 / 1025.0) / 5.0;
    let share = found.transmission[ball.unwrap()];
    assert!((f64::from(share) - expected).abs() < 1e-6, "{share} instead of {expected}");
}

#[test]
fn a_solid_crown_is_filled_down_to_its_lowest_returns_and_no_farther() {
    let cloud = tree(100_000, 3.0);
    let without = carved(&cloud, &CarvedParams { crowns: None, ..CarvedParams::default() });
    let filled = carved(&cloud, &trees(Trees::Measured));
    assert!(filled.report.count("balls_in_crowns") > 100, "{:?}", filled.report);
    assert_eq!(filled.balls.len() - without.balls.len(), filled.report.count("balls_in_crowns"));
    let inside = |found: &CarvedBalls, p: [f32; 3]| {
        found.balls.centers.iter().zip(&found.balls.radii).any(|(c, r)| {
            let square: f32 = (0..3).map(|i| (c[i] - p[i]) * (c[i] - p[i])).sum();
            square < r * r
        })
    };
    // hollow between the top at 8 m, whose balls are at most 1 m large, and the base at 3 m
    let middle = [6.1, 6.1, 5.0];
    assert!(!inside(&without, middle));
    assert!(inside(&filled, middle));
    for (center, radius) in filled.balls.centers.iter().zip(&filled.balls.radii).skip(without.balls.len()) {
        // from 8 m with a radius of at most 2 m and a millimetre: not below 4 m, nor beside the crown
        assert!(center[2] - radius > 4.0 - 2e-3 && *radius <= 2.0, "{center:?} {radius}");
        assert!(center[0] - radius > 1.75 - 1e-3 && center[0] + radius < 10.0 + 1e-3, "{center:?} {radius}");
    }
    // with returns at 6 m as the lowest there is room for a metre
    let shallow = carved(&tree(100_000, 6.0), &trees(Trees::Opaque));
    let fills = shallow.balls.len() - shallow.report.count("balls_in_crowns");
    let lowest = (fills..shallow.balls.len()).map(|i| shallow.balls.centers[i][2] - shallow.balls.radii[i]);
    assert!(lowest.fold(f32::INFINITY, f32::min) > 6.0 - 2e-3);
}

#[test]
fn crowns_that_pulses_get_through_are_not_filled_and_keep_small_balls() {
    let cloud = tree(1, 3.0);
    let found = carved(&cloud, &trees(Trees::Measured));
    assert_eq!(found.report.count("balls_in_crowns"), 0);
    assert_eq!(found.report.count("points_in_crowns_with_gaps"), 1024);
    let params = CrownParams::default();
    let largest = |found: &CarvedBalls| {
        let radii = found.balls.source.iter().zip(&found.balls.radii);
        radii.filter(|(source, _)| class_of(&cloud, **source) == 5).map(|(_, r)| *r).fold(0.0, f32::max)
    };
    assert_eq!(largest(&found), params.leaf_radius);
    assert_eq!(largest(&carved(&cloud, &trees(Trees::Porous))), params.porous_radius);
    assert!(largest(&carved(&cloud, &trees(Trees::Opaque))) > params.leaf_radius);
}

/// A flat roof, 10 m × 10 m, and a cloud of points in a ball beside it, without classes.
fn roof_and_bush() -> PointCloud {
    let roof = (0..1600).map(|i| [(i % 40) as f32 * 0.25, (i / 40) as f32 * 0.25, 6.0]);
    let bush = (0..600_u64).filter_map(|i| {
        let p: [f64; 3] = std::array::from_fn(|k| uniform(3, 3 * i + k as u64) * 4.0 - 2.0);
        let is_inside = p.iter().map(|v| v * v).sum::<f64>() < 4.0;
        is_inside.then(|| [p[0] as f32 + 20.0, p[1] as f32 + 5.0, p[2] as f32 + 3.0])
    });
    let positions: Vec<[f32; 3]> = roof.chain(bush).collect();
    let count = positions.len();
    let times = (0..count).map(|i| 1.0 + i as f64 * 1e-5).collect();
    let attributes = Attributes {
        return_number: Some(vec![1; count]),
        return_count: Some(vec![1; count]),
        gps_time: Some(times),
        ..Attributes::default()
    };
    PointCloud { positions, attributes, ..PointCloud::default() }
}

#[test]
fn without_classes_a_bush_is_separated_from_a_roof() {
    let mut cloud = roof_and_bush();
    let bush = cloud.len() - 1600;
    let found = carved(&cloud, &trees(Trees::Porous));
    // points of a ball have no plane about them: most of the bush is found, nothing of the roof
    assert!(
        found.report.count("points_found_to_be_vegetation") > bush * 6 / 10,
        "{} of {bush}",
        found.report.count("points_found_to_be_vegetation")
    );
    for (&source, &radius) in found.balls.source.iter().zip(&found.balls.radii) {
        assert!(source >= 1600 || radius > CrownParams::default().porous_radius, "row {source}: {radius}");
    }
    // one point of class 5 says that the cloud has its classes, and a class other than 1 is believed
    let mut classes = vec![1; cloud.len()];
    classes[1600] = 5;
    cloud.attributes.classification = Some(classes);
    assert_eq!(carved(&cloud, &CarvedParams::default()).report.count("points_found_to_be_vegetation"), 0);
    cloud.attributes.classification = Some(vec![6; cloud.len()]);
    assert_eq!(carved(&cloud, &CarvedParams::default()).report.count("points_found_to_be_vegetation"), 0);
}

#[test]
fn the_order_of_points_does_not_matter() {
    let cloud = tree(3, 3.0);
    let reversed: Vec<u32> = (0..cloud.len() as u32).rev().collect();
    let sorted = |cloud: &PointCloud| {
        let found = carved(cloud, &CarvedParams::default());
        let balls = found.balls.centers.iter().zip(&found.balls.radii).zip(&found.transmission);
        let mut balls: Vec<[u32; 5]> = balls
            .map(|((c, r), t)| [c[0].to_bits(), c[1].to_bits(), c[2].to_bits(), r.to_bits(), t.to_bits()])
            .collect();
        balls.sort_unstable();
        balls
    };
    assert!(sorted(&cloud) == sorted(&cloud.select(&reversed)));
}
