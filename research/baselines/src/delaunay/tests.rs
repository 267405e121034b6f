use super::{Delaunay, NONE, in_sphere, orient};
use std::collections::BTreeSet;

/// Positions without pattern in the box from -1 to 1, times `size`, of f32 precision.
fn scattered(count: u64, size: [f64; 3]) -> Vec<[f64; 3]> {
    let number = |counter| 2.0 * belvedere::random::uniform(11, counter) - 1.0;
    #[expect(clippy::cast_possible_truncation, reason = "made to be f32")]
    let position = |i| std::array::from_fn(|axis| f64::from((size[axis] * number(3 * i + axis as u64)) as f32));
    (0..count).map(position).collect()
}

fn lattice(side: i32) -> Vec<[f64; 3]> {
    let range = || 0..=side;
    range().flat_map(|x| range().flat_map(move |y| range().map(move |z| [x, y, z].map(f64::from)))).collect()
}

/// Checks what a Delaunay tetrahedralisation is by definition, over all pairs of a tetrahedron and a point, and returns
/// its volume.
fn checked_volume(points: &[[f64; 3]]) -> f64 {
    let delaunay = Delaunay::new(points.to_vec());
    let (mut edges, mut faces, mut hull_faces, mut used) = (BTreeSet::new(), 0, 0, BTreeSet::new());
    let mut volume = 0.0;
    for (index, tetrahedron) in (0..).zip(&delaunay.tetrahedra) {
        let corners = delaunay.corners(index);
        let six_volumes = orient(corners);
        assert!(six_volumes > 0.0);
        volume += six_volumes / 6.0;
        assert!(points.iter().all(|&p| in_sphere(corners, p) <= 0.0), "a circumsphere holds a point");
        for (i, &neighbor) in tetrahedron.neighbors.iter().enumerate() {
            used.insert(tetrahedron.corners[i]);
            for k in 0..i {
                let ends = [tetrahedron.corners[i], tetrahedron.corners[k]];
                edges.insert([ends[0].min(ends[1]), ends[0].max(ends[1])]);
            }
            if neighbor == NONE {
                hull_faces += 1;
                continue;
            }
            faces += 1;
            let other = &delaunay.tetrahedra[neighbor as usize];
            let back = other.neighbors.iter().position(|&back| back == index).unwrap();
            let shared = |corners: [u32; 4], opposite: usize| {
                let mut shared = corners.to_vec();
                shared.remove(opposite);
                shared.sort_unstable();
                shared
            };
            assert_eq!(shared(tetrahedron.corners, i), shared(other.corners, back));
        }
    }
    let places: BTreeSet<[u64; 3]> = points.iter().map(|p| p.map(|v| (v + 0.0).to_bits())).collect();
    assert_eq!(used.len(), places.len(), "each place is a corner");
    // Euler: vertices − edges + faces − cells of a ball are 1
    let count = |n: usize| i64::try_from(n).unwrap();
    let faces = faces / 2 + hull_faces;
    assert_eq!(count(used.len()) - count(edges.len()) + faces - count(delaunay.tetrahedra.len()), 1);
    for (point, &at) in (0..).zip(&delaunay.at_point) {
        assert!(at == NONE || delaunay.tetrahedra[at as usize].corners.contains(&point));
    }
    volume
}

#[test]
fn circumspheres_of_scattered_points_are_empty() {
    for size in [[1.0; 3], [1.0, 1.0, 1e-4], [1e-4, 1.0, 1e4]] {
        checked_volume(&scattered(250, size));
    }
}

#[test]
fn a_lattice_is_filled_although_all_its_cubes_are_on_spheres() {
    let points = lattice(4);
    // sixths of cubes: sums of small integers are exact up to the division by six
    assert!((checked_volume(&points) - 64.0).abs() < 1e-9);
    let mut doubled = points.clone();
    doubled.extend_from_within(..);
    assert!((checked_volume(&doubled) - 64.0).abs() < 1e-9);
}

#[test]
fn walls_and_floors_with_points_in_their_planes_are_filled() {
    // a floor of 8 × 8 and two walls 4 high on it, all in planes of the lattice
    let mut points: Vec<[f64; 3]> = lattice(8).into_iter().filter(|p| p[2] == 0.0).collect();
    points.extend(lattice(8).into_iter().filter(|p| (p[0] == 2.0 || p[0] == 5.0) && (1.0..=4.0).contains(&p[2])));
    // walls of 8 × 4 three apart hold 96; each slope from a wall to the edge of the floor is a wedge, at 2 and at 3
    // metres
    assert!((checked_volume(&points) - (96.0 + 32.0 + 48.0)).abs() < 1e-9);
}

#[test]
fn points_in_one_plane_have_no_tetrahedra() {
    let flat: Vec<[f64; 3]> = lattice(5).into_iter().filter(|p| p[1] == 3.0).collect();
    let line: Vec<[f64; 3]> = (0..9).map(|i| [f64::from(i), 2.0 * f64::from(i), 1.0]).collect();
    for points in [Vec::new(), vec![[1.0; 3]], vec![[1.0; 3]; 7], line, flat] {
        let delaunay = Delaunay::new(points.clone());
        assert!(delaunay.tetrahedra.is_empty());
        assert_eq!(delaunay.at_point, vec![NONE; points.len()]);
    }
}

#[test]
fn the_least_and_greatest_numbers_of_f32_are_no_trouble() {
    let (max, min) = (f64::from(f32::MAX), f64::from(f32::MIN_POSITIVE));
    let mut points = scattered(40, [1.0; 3]);
    points.extend([[max, 0.0, 0.0], [0.0, max, -max], [min, min, 0.0], [-max; 3], [0.0, 0.0, -min], [0.0; 3]]);
    let delaunay = Delaunay::new(points.clone());
    assert!(delaunay.at_point.iter().all(|&at| at != NONE));
}
