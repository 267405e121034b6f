//! Counts against clouds made by hand and against brute force.

use super::*;
use belvedere_data::Attributes;
use belvedere_data::control::Control;

/// A flat grid of points a metre apart.
fn meadow(side: u16) -> Vec<[f32; 3]> {
    (0..side).flat_map(|x| (0..side).map(move |y| [f32::from(x), f32::from(y), 0.0])).collect()
}

fn cloud(positions: Vec<[f32; 3]>) -> PointCloud {
    PointCloud { positions, ..PointCloud::default() }
}

fn cleaned(cloud: &PointCloud, params: &CleanParams) -> (Vec<u32>, CleanReport) {
    let (kept, report) = clean(cloud, params, &Control::none()).unwrap();
    assert!(kept.windows(2).all(|pair| pair[0] < pair[1]));
    assert_eq!(kept.len(), report.kept_count);
    let removed = report.not_finite_count
        + report.withheld_count
        + report.class_count
        + report.exact_duplicate_count
        + report.near_duplicate_count
        + report.isolated_count;
    assert_eq!(report.kept_count + removed, report.point_count);
    assert_eq!(report.point_count, cloud.len());
    (kept, report)
}

#[test]
fn every_step_counts_its_own() {
    let mut positions = meadow(20);
    let meadow_count = positions.len();
    positions.extend([[5.0, 5.0, 0.0], [-0.0, 3.0, 0.0], [7.0, 7.0, 0.0005], [9.0, 9.0, 300.0], [f32::NAN, 0.0, 0.0]]);
    positions.extend([[3.5, 3.5, 0.0], [4.5, 4.5, 0.0], [4.5, 3.5, 0.0]]);
    let count = positions.len();
    let mut flags = vec![0; count];
    flags[count - 3] = 4 | 8;
    flags[count - 2] = 8;
    let mut classes = vec![2; count];
    classes[count - 3] = 7;
    classes[count - 1] = 18;
    let cloud = PointCloud {
        positions,
        attributes: Attributes { flags: Some(flags), classification: Some(classes), ..Attributes::default() },
        ..PointCloud::default()
    };
    let (kept, report) = cleaned(&cloud, &CleanParams::default());
    let expected: Vec<u32> =
        (0..u32::try_from(meadow_count).unwrap()).chain([u32::try_from(count - 2).unwrap()]).collect();
    assert_eq!(kept, expected);
    assert_eq!((report.not_finite_count, report.withheld_count, report.class_count), (1, 1, 1));
    assert_eq!((report.exact_duplicate_count, report.near_duplicate_count, report.isolated_count), (2, 1, 1));
    assert!((report.isolation_radius.unwrap() - 10.0).abs() < 1e-6);
    let off = CleanParams {
        withheld: Treatment::Keep,
        dropped_classes: Vec::new(),
        exact_duplicates: Treatment::Keep,
        near_duplicate_distance: None,
        isolated: None,
    };
    assert_eq!(cleaned(&cloud, &off).1.kept_count, count - 1);
}

#[test]
fn near_duplicates_are_those_of_brute_force() {
    // a heap: many chains of points within a millimetre of each other
    let mut state = 1_u32;
    let mut random = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / (1 << 24) as f32
    };
    let positions: Vec<[f32; 3]> =
        (0..3000).map(|_| [random() * 0.02 - 0.01, random() * 0.02 - 0.01, random() * 0.004 - 0.002]).collect();
    let mut expected: Vec<u32> = Vec::new();
    for (index, p) in (0_u32..).zip(&positions) {
        if expected.iter().all(|&k| grid::squared_distance(*p, positions[k as usize]) > 1e-6) {
            expected.push(index);
        }
    }
    let params = CleanParams { isolated: None, ..CleanParams::default() };
    assert!(expected.len() < 2900);
    assert_eq!(cleaned(&cloud(positions), &params).0, expected);
}

#[test]
fn isolated_points_are_those_of_brute_force() {
    let mut positions = meadow(12);
    // a sparse wire stays, a pair of echoes goes
    positions.extend((0..8_u8).map(|i| [4.0 * f32::from(i), 40.0, 12.0]));
    positions.extend([[-60.0, -60.0, 3.0], [-60.5, -60.0, 3.0], [1e30, 0.0, 0.0], [-1e30, 5.0, 0.0]]);
    for (radius, min_neighbors) in [(5.0, 1), (5.0, 2), (9.0, 3), (1.2, 3)] {
        let params = CleanParams {
            isolated: Some(IsolatedPoints { radius: IsolationRadius::Metres(radius), min_neighbors }),
            ..CleanParams::default()
        };
        let expected: Vec<u32> = (0_u32..)
            .zip(&positions)
            .filter(|(_, p)| {
                let near = |q: &&[f32; 3]| grid::squared_distance(**p, **q) <= radius * radius;
                positions.iter().filter(near).count() > min_neighbors
            })
            .map(|(index, _)| index)
            .collect();
        assert_eq!(cleaned(&cloud(positions.clone()), &params).0, expected, "{radius} {min_neighbors}");
    }
    let (kept, report) = cleaned(&cloud(positions), &CleanParams::default());
    assert_eq!((kept.len(), report.isolated_count), (12 * 12 + 8, 4));
}

#[test]
fn a_point_of_a_wall_stays_and_one_in_the_air_goes() {
    // a roof of 20 m by 10 m, 12 m high, over a meadow of a metre
    let mut positions = meadow(20);
    let roof = (0..20_u8).flat_map(|x| (0..10_u8).map(move |y| [f32::from(x), f32::from(y), 12.0]));
    positions.extend(roof);
    let surfaces = positions.len();
    let wall = [7.2, 9.3, 6.0];
    // a bird, an echo from below the ground, one over the roof, two birds above each other
    let stray = [[7.0, 15.0, 6.0], [7.0, 15.0, -6.0], [7.0, 5.0, 20.0], [14.0, 15.0, 5.0], [14.0, 15.0, 9.0]];
    positions.push(wall);
    positions.extend(stray);
    let params = CleanParams {
        isolated: Some(IsolatedPoints { radius: IsolationRadius::Metres(2.0), min_neighbors: 2 }),
        ..CleanParams::default()
    };
    let (kept, report) = cleaned(&cloud(positions), &params);
    assert_eq!((kept.len(), report.isolated_count), (surfaces + 1, stray.len()));
    assert_eq!(kept.last().copied(), u32::try_from(surfaces).ok());
}

#[test]
fn strange_clouds_are_no_trouble() {
    assert!(cleaned(&PointCloud::default(), &CleanParams::default()).0.is_empty());
    assert_eq!(cleaned(&cloud(vec![[1.0; 3]]), &CleanParams::default()).0, [0]);
    assert_eq!(cleaned(&cloud(vec![[1.0; 3]; 5000]), &CleanParams::default()).0, [0]);
    assert!(cleaned(&cloud(vec![[f32::INFINITY; 3]; 50]), &CleanParams::default()).0.is_empty());
    let spread: Vec<[f32; 3]> = (0..40_u8).map(|i| [10.0_f32.powi(i32::from(i) - 5), 0.0, 0.0]).collect();
    let _ = cleaned(&cloud(spread), &CleanParams::default());
}

#[test]
fn cells_that_wrap_lose_no_neighbour() {
    // cell numbers run through a multiple of two million between these points
    let params = CleanParams {
        isolated: Some(IsolatedPoints { radius: IsolationRadius::Metres(0.001), min_neighbors: 1 }),
        near_duplicate_distance: None,
        ..CleanParams::default()
    };
    let height = 2_097_152.0 * 0.001;
    let pair =
        cloud(vec![[0.0, 0.0, height - 0.0004], [0.0, 0.0, height + 0.0004], [0.0, 0.0, -0.0004], [0.0, 0.0, 0.0004]]);
    assert_eq!(cleaned(&pair, &params).0.len(), 4);
}

#[test]
fn parameters_out_of_range_are_errors() {
    let field = cloud(meadow(3));
    for distance in [0.0, -1.0, f64::NAN, f64::INFINITY, 1001.0] {
        let near = CleanParams { near_duplicate_distance: Some(distance), ..CleanParams::default() };
        assert!(clean(&field, &near, &Control::none()).is_err());
        let radius = IsolationRadius::Metres(distance);
        let alone =
            CleanParams { isolated: Some(IsolatedPoints { radius, min_neighbors: 2 }), ..CleanParams::default() };
        assert!(clean(&field, &alone, &Control::none()).is_err());
    }
    let mut broken = field.clone();
    broken.attributes.flags = Some(vec![0]);
    assert!(clean(&broken, &CleanParams::default(), &Control::none()).is_err());
}

#[test]
fn any_number_of_threads_keeps_the_same_points() {
    let mut positions = meadow(100);
    positions.extend(positions.clone().iter().step_by(3).map(|p| [p[0] + 0.0006, p[1], p[2] + 0.0002]));
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| cleaned(&cloud(positions.clone()), &CleanParams::default()))
    };
    assert_eq!(run(1), run(3));
}
