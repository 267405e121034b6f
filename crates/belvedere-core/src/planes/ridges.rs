//! Ridges, hips and valleys: lines in which two planes of a roof meet.

use super::line::PlanLine;
use super::roof_planes::Roofs;
use belvedere_data::vector::{cross, dot};
use std::collections::BTreeMap;

/// Parameters of ridges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RidgeParams {
    /// Minimum number of pairs of neighbours on both planes. Default 4.
    pub(super) min_pairs: usize,
    /// Cosine of the angle below which two planes have a line of their own. Default 0.99, 8°.
    pub(super) max_cosine: f64,
    /// Maximum distance of neighbours from the line, on both sides of it, spacings. Default 1.2.
    pub(super) near_spacings: f64,
    /// Distance from the line within which points show whether it is convex, metres. Default 3.
    pub(super) side: f64,
}

impl Default for RidgeParams {
    fn default() -> Self {
        Self { min_pairs: 4, max_cosine: 0.990, near_spacings: 1.2, side: 3.0 }
    }
}

/// A line in which two planes meet, in plan.
#[derive(Clone, Debug)]
pub(super) struct RidgeLine {
    pub(super) line: PlanLine,
    pub(super) planes: [usize; 2],
    pub(super) is_convex: bool,
}

/// The lines in which planes that touch meet.
pub(super) fn find(roofs: &Roofs, params: &RidgeParams) -> Vec<RidgeLine> {
    let mut pairs: BTreeMap<[u32; 2], Vec<[f64; 2]>> = BTreeMap::new();
    for (row, near) in roofs.neighbors.iter().enumerate() {
        let Some(a) = roofs.plane_of[row] else { continue };
        for &near in near {
            if let Some(b) = roofs.plane_of[near as usize].filter(|&b| a < b) {
                let (p, q) = (roofs.points[row], roofs.points[near as usize]);
                pairs.entry([a, b]).or_default().push([0, 1].map(|i| f64::midpoint(p[i], q[i])));
            }
        }
    }
    let found =
        |(planes, middles): ([u32; 2], Vec<[f64; 2]>)| ridge(roofs, planes.map(|p| p as usize), &middles, params);
    pairs.into_iter().filter_map(found).collect()
}

/// The line in which two planes meet, if enough neighbours on both lie about it.
fn ridge(roofs: &Roofs, planes: [usize; 2], middles: &[[f64; 2]], params: &RidgeParams) -> Option<RidgeLine> {
    let [a, b] = planes.map(|plane| &roofs.planes[plane]);
    if middles.len() < params.min_pairs || a.plane.cosine(&b.plane) > params.max_cosine {
        return None;
    }
    let way = cross(a.plane.normal, b.plane.normal);
    let length = way[0].hypot(way[1]);
    if length < 1e-6 {
        return None;
    }
    let along = [way[0] / length, way[1] / length];
    // where both have the same height, across the line from the first middle
    let across = [along[1], -along[0]];
    let difference = |p: [f64; 2]| a.plane.height(p) - b.plane.height(p);
    let from = middles.first().copied()?;
    let slope = difference([from[0] + across[0], from[1] + across[1]]) - difference(from);
    if slope.abs() < 1e-9 {
        return None;
    }
    let step = -difference(from) / slope;
    let point = [from[0] + step * across[0], from[1] + step * across[1]];
    let mut line = PlanLine { point, along, ends: [f64::INFINITY, f64::NEG_INFINITY] };
    let reach = params.near_spacings * a.spacing.max(b.spacing);
    let mut count = 0;
    for &middle in middles {
        let [t, d] = line.of(middle);
        if d.abs() <= reach {
            line.ends = [line.ends[0].min(t), line.ends[1].max(t)];
            count += 1;
        }
    }
    if count < params.min_pairs || line.length() < a.spacing {
        return None;
    }
    let below = |own: usize, other: usize| {
        let (mut sum, mut count) = (0.0, 0.0);
        for &row in &roofs.planes[own].rows {
            let p = roofs.points[row];
            let [t, d] = line.of([p[0], p[1]]);
            if (line.ends[0]..=line.ends[1]).contains(&t) && d.abs() < params.side {
                sum += dot(roofs.planes[other].plane.normal, p) - roofs.planes[other].plane.offset;
                count += 1.0;
            }
        }
        count > 0.0 && sum < 0.0
    };
    let is_convex = below(planes[0], planes[1]) && below(planes[1], planes[0]);
    Some(RidgeLine { line, planes, is_convex })
}

/// The convex ridges of a plane, and the planes beyond.
pub(super) fn convex(ridges: &[RidgeLine], plane: usize) -> impl Iterator<Item = (&RidgeLine, usize)> {
    ridges
        .iter()
        .filter(move |ridge| ridge.is_convex && ridge.planes.contains(&plane))
        .map(move |ridge| (ridge, if ridge.planes[0] == plane { ridge.planes[1] } else { ridge.planes[0] }))
}
