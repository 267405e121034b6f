//! The tetrahedron that a hull grows from.

use belvedere::cast::to_row;
use belvedere::vector::{cross, dot};

use super::{Facet, NONE, orient};

/// Four points that fill a volume, the eye first; adds pairs about the eye to `points` where they do not by themselves.
pub(super) fn first_tetrahedron(points: &mut Vec<[f64; 3]>, eye: u32) -> [u32; 4] {
    let origin = [0.0; 3];
    let size = points.iter().flatten().fold(0.0, |size: f64, v| size.max(v.abs()));
    let size = if size > 0.0 { size } else { 1.0 };
    let axes = [[size, 0.0, 0.0], [0.0, size, 0.0], [0.0, 0.0, size]];
    let complete = |points: &mut Vec<[f64; 3]>, volume: &dyn Fn([f64; 3]) -> f64| {
        let best = axes.into_iter().max_by(|a, b| volume(*a).total_cmp(&volume(*b))).unwrap_or(axes[0]);
        points.extend([best, best.map(|v| -v)]);
        to_row(points.len()) - 2
    };
    let given = eye as usize;
    let best_of = |points: &[[f64; 3]], size_of: &dyn Fn([f64; 3]) -> f64| {
        let sizes = points[..given].iter().enumerate().map(|(i, &p)| (to_row(i), size_of(p)));
        sizes.max_by(|a, b| a.1.total_cmp(&b.1)).filter(|best| best.1 > 0.0).map(|best| best.0)
    };
    let square = |v: [f64; 3]| dot(v, v);
    let first = best_of(points, &square).unwrap_or_else(|| complete(points, &|w| w[0]));
    let a = points[first as usize];
    let area = |p: [f64; 3]| square(cross(a, p));
    let off_line = |p: [f64; 3]| if axes.iter().any(|&w| orient(origin, a, p, w) != 0.0) { area(p) } else { 0.0 };
    let second = best_of(points, &off_line).unwrap_or_else(|| complete(points, &area));
    let b = points[second as usize];
    let volume = |p: [f64; 3]| orient(origin, a, b, p).abs();
    if let Some(third) = best_of(points, &volume) {
        let tetrahedron = [eye, first, second, third];
        if encloses(points, tetrahedron, middle(points, tetrahedron)) {
            return tetrahedron;
        }
    }
    let third = complete(points, &volume);
    [eye, first, second, third]
}

pub(super) fn middle(points: &[[f64; 3]], corners: [u32; 4]) -> [f64; 3] {
    std::array::from_fn(|i| corners.iter().map(|&c| points[c as usize][i]).sum::<f64>() / 4.0)
}

fn encloses(points: &[[f64; 3]], corners: [u32; 4], point: [f64; 3]) -> bool {
    tetrahedron(points, corners).iter().all(|facet| {
        let [a, b, c] = facet.corners.map(|corner| points[corner as usize]);
        orient(a, b, c, point) > 0.0
    })
}

/// The four facets of a tetrahedron.
pub(super) fn tetrahedron(points: &[[f64; 3]], [mut a, mut b, c, d]: [u32; 4]) -> Vec<Facet> {
    let [p, q, r, s] = [a, b, c, d].map(|corner| points[corner as usize]);
    if orient(p, q, r, s) < 0.0 {
        std::mem::swap(&mut a, &mut b);
    }
    let facets = [[a, b, c], [b, a, d], [c, b, d], [a, c, d]];
    let across = |from: u32, to: u32| {
        let has_edge = |f: &[u32; 3]| (0..3).any(|i| f[i] == to && f[(i + 1) % 3] == from);
        facets.iter().position(has_edge).map_or(NONE, to_row)
    };
    facets
        .iter()
        .map(|&corners| Facet { corners, neighbors: std::array::from_fn(|i| across(corners[i], corners[(i + 1) % 3])) })
        .collect()
}
