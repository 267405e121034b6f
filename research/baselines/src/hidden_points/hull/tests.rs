use super::{Hull, HullWalk};

/// Positions without pattern in the box from -1 to 1, times `size`.
fn scattered(count: u64, size: [f64; 3]) -> Vec<[f64; 3]> {
    let number = |counter| 2.0 * belvedere::random::uniform(7, counter) - 1.0;
    (0..count).map(|i| std::array::from_fn(|axis| size[axis] * number(3 * i + axis as u64))).collect()
}

/// Which of `points` are corners of their hull with the origin: those of a triangle that has all others on one side.
fn corners_by_force(points: &[[f64; 3]]) -> Vec<bool> {
    let all: Vec<[f64; 3]> = points.iter().copied().chain([[0.0; 3]]).collect();
    let mut corners = vec![false; all.len()];
    for i in 0..all.len() {
        for j in i + 1..all.len() {
            for k in j + 1..all.len() {
                let others = (0..all.len()).filter(|m| ![i, j, k].contains(m));
                let sides: Vec<f64> = others.map(|m| super::orient(all[i], all[j], all[k], all[m])).collect();
                if sides.iter().all(|&s| s > 0.0) || sides.iter().all(|&s| s < 0.0) {
                    for corner in [i, j, k] {
                        corners[corner] = true;
                    }
                }
            }
        }
    }
    corners.truncate(points.len());
    corners
}

fn extreme(points: &[[f64; 3]]) -> Vec<bool> {
    let hull = Hull::new(points.to_vec());
    (0..points.len()).map(|i| hull.is_extreme(i)).collect()
}

fn lattice(from: i32, to: i32) -> Vec<[f64; 3]> {
    let range = || from..=to;
    let points = range().flat_map(|x| range().flat_map(move |y| range().map(move |z| [x, y, z])));
    points.map(|p| p.map(f64::from)).collect()
}

#[test]
fn corners_are_those_found_by_force() {
    for size in [[1.0; 3], [1.0, 1.0, 1e-6], [1e9, 1.0, 1.0]] {
        for shift in [[0.0; 3], [3.0, 0.0, 0.0], [1.0, 1.0, 1.0]] {
            let points: Vec<[f64; 3]> =
                scattered(40, size).iter().map(|p| std::array::from_fn(|i| p[i] + shift[i] * size[i])).collect();
            assert_eq!(extreme(&points), corners_by_force(&points), "{size:?} {shift:?}");
        }
    }
}

#[test]
fn a_lattice_has_only_its_own_corners() {
    let around = lattice(-3, 3);
    let corner = |p: &[f64; 3]| p.iter().all(|v| v.abs() == 3.0);
    assert_eq!(extreme(&around), around.iter().map(corner).collect::<Vec<_>>());
    // seen from outside, the near corner lies between the eye and the far one
    let beside = lattice(1, 4);
    let corner = |p: &[f64; 3]| p.iter().all(|&v| v == 1.0 || v == 4.0) && *p != [1.0; 3];
    assert_eq!(extreme(&beside), beside.iter().map(corner).collect::<Vec<_>>());
}

#[test]
fn flat_sets_have_the_corners_of_their_plane_and_line() {
    let square: Vec<[f64; 3]> = lattice(-2, 2).into_iter().filter(|p| p[2] == 0.0).collect();
    let corner = |p: &[f64; 3]| p[0].abs() == 2.0 && p[1].abs() == 2.0;
    assert_eq!(extreme(&square), square.iter().map(corner).collect::<Vec<_>>());
    let line: Vec<[f64; 3]> = (1..=5).map(|i| [f64::from(i), f64::from(2 * i), 0.0]).collect();
    assert_eq!(extreme(&line), [false, false, false, false, true]);
    assert_eq!(extreme(&[[0.0, 0.0, 2.0]]), [true]);
    assert_eq!(extreme(&[[0.0; 3]; 2]).len(), 2);
    assert!(extreme(&[]).is_empty());
}

#[test]
fn copies_of_a_corner_are_corners() {
    let mut points = scattered(300, [1.0; 3]);
    let single = extreme(&points);
    points.extend_from_within(..);
    let doubled = extreme(&points);
    assert_eq!(doubled[..300], single);
    assert_eq!(doubled[300..], single);
}

#[test]
fn all_of_a_sphere_is_extreme_and_its_depths_are_those_of_the_closed_form() {
    let count = 20_000;
    let sphere: Vec<[f64; 3]> = (0..count)
        .map(|i| {
            let z = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(count);
            let turn = f64::from(i) * 2.399_963_229_728_653;
            let ring_radius = (1.0 - z * z).sqrt();
            [ring_radius * turn.cos(), ring_radius * turn.sin(), z].map(|v| 1e6 * v)
        })
        .collect();
    let hull = Hull::new(sphere.clone());
    // neighbours stand out by 1e-4 of the radius, rounding moves points by 1e-16
    assert!((0..sphere.len()).all(|i| hull.is_extreme(i)));
    let mut walk = HullWalk::default();
    for p in scattered(500, [1e6; 3]) {
        let range = belvedere::vector::length(p);
        match hull.depth_below(p, &mut walk) {
            None => assert!(range > 0.9998e6),
            // 40 000 facets with corners 0.016 rad from their middles lie 1.3e-4 below the sphere at most
            Some(depth) => assert!((depth - (1e6 - range)).abs() < 200.0, "{depth} {range}"),
        }
    }
}

#[test]
fn the_order_of_points_changes_nothing() {
    let points: Vec<[f64; 3]> = scattered(5000, [4.0; 3]).iter().map(|p| p.map(f64::round)).collect();
    let reversed: Vec<[f64; 3]> = points.iter().rev().copied().collect();
    let mut backwards = extreme(&reversed);
    backwards.reverse();
    assert_eq!(extreme(&points), backwards);
}
