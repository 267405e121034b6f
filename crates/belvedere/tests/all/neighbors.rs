//! Every kind of search against brute force and against another kd-tree, query by query, on kind and unkind clouds,
//! with and without AVX2.

use belvedere::control::Control;
use belvedere::neighbors::{Instructions, Neighbor, NeighborIndex, Tangent};
use proptest::prelude::*;

/// A small generator with a fixed sequence, so that a failure can be repeated.
struct SequenceRandom(u64);

impl SequenceRandom {
    fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / (1u64 << 24) as f32
    }

    fn point(&mut self, scale: [f32; 3]) -> [f32; 3] {
        scale.map(|s| self.next() * s)
    }
}

fn clouds() -> Vec<(&'static str, Vec<[f32; 3]>)> {
    let mut s = SequenceRandom(7);
    let mut aerial: Vec<[f32; 3]> = (0..5000)
        .map(|_| {
            let [x, y, _] = s.point([100.0, 80.0, 0.0]);
            let roof = if (x as i32 / 15 + y as i32 / 15) % 2 == 0 { 9.0 } else { 0.0 };
            [x, y, roof + 0.02 * s.next()]
        })
        .collect();
    aerial.extend((0..300).map(|_| s.point([0.1, 80.0, 9.0])));
    let quantised = aerial.iter().map(|p| p.map(|v| (v / 0.5).round() * 0.5)).collect();
    let mut duplicates = aerial[..1500].to_vec();
    duplicates.extend_from_within(..700);
    duplicates.extend_from_within(..700);
    vec![
        ("aerial", aerial),
        ("quantised", quantised),
        ("duplicates", duplicates),
        ("vertical line", (0..1000).map(|i| [3.0, -4.0, i as f32 * 0.01]).collect()),
        ("all equal", vec![[1.5, 2.5, -3.5]; 500]),
        ("one", vec![[1.0, 2.0, 3.0]]),
        ("thirty-three", (0..33).map(|_| s.point([1.0; 3])).collect()),
        ("far from the origin", (0..800).map(|_| s.point([5.0; 3]).map(|v| v + 4000.0)).collect()),
    ]
}

fn queries(points: &[[f32; 3]]) -> Vec<[f32; 3]> {
    let mut s = SequenceRandom(11);
    let mut queries: Vec<[f32; 3]> = points.iter().step_by(points.len() / 60 + 1).copied().collect();
    for i in 0..120 {
        let p = points[i * 7919 % points.len()];
        // near the surface, and where ball centres lie: far below and above it
        let reach = [0.3, 5.0, 200.0][i % 3];
        queries
            .push(std::array::from_fn(|axis| p[axis] + reach * (s.next() - 0.5) * if axis == 2 { 2.0 } else { 0.4 }));
    }
    queries
}

fn distance_squared(a: [f32; 3], b: [f32; 3]) -> f32 {
    let d: [f32; 3] = std::array::from_fn(|i| a[i] - b[i]);
    d[0] * d[0] + d[1] * d[1] + d[2] * d[2]
}

fn all_by_distance(points: &[[f32; 3]], query: [f32; 3]) -> Vec<Neighbor> {
    let mut all: Vec<Neighbor> = points
        .iter()
        .zip(0..)
        .map(|(&p, index)| Neighbor { index, distance_squared: distance_squared(p, query) })
        .collect();
    all.sort_by(|a, b| a.distance_squared.total_cmp(&b.distance_squared).then(a.index.cmp(&b.index)));
    all
}

fn both(points: &[[f32; 3]]) -> Vec<NeighborIndex> {
    let mut kinds = vec![Instructions::Scalar];
    if Instructions::detect() != Instructions::Scalar {
        kinds.push(Instructions::detect());
    } else {
        crate::common::skipped("the AVX2 half of the neighbour tests: this machine has none");
    }
    kinds.into_iter().map(|kind| NeighborIndex::with_instructions(points, kind, &Control::none()).unwrap()).collect()
}

#[test]
fn every_search_equals_brute_force_on_every_cloud() {
    for (name, points) in clouds() {
        for index in both(&points) {
            let mut order = index.tree_order().to_vec();
            order.sort_unstable();
            assert!(order.iter().copied().eq(0..points.len() as u32), "{name}: the tree order is no permutation");
            let mut found = Vec::new();
            for query in queries(&points) {
                let truth = all_by_distance(&points, query);
                assert_eq!(index.nearest_within(query, f32::INFINITY), Some(truth[0]), "{name} {query:?}");
                let bound = truth[truth.len() / 2].distance_squared;
                let strictly = truth[0].distance_squared < bound;
                assert_eq!(index.nearest_within(query, bound), strictly.then_some(truth[0]), "{name} bound {bound}");
                for k in [1, 6, 17, points.len() + 3] {
                    index.k_nearest(query, k, &mut found);
                    assert_eq!(found, truth[..k.min(points.len())], "{name} k {k}");
                }
                let radius = truth[truth.len() / 3].distance_squared.sqrt();
                found.clear();
                index.within_radius(query, radius, |n| found.push(n));
                found.sort_by(|a, b| a.distance_squared.total_cmp(&b.distance_squared).then(a.index.cmp(&b.index)));
                let inside = truth.partition_point(|n| n.distance_squared <= radius * radius);
                assert_eq!(found, truth[..inside], "{name} radius {radius}");
            }
        }
    }
}

/// The same radius in f64 straight from the formula, over all points, and the squared chord to the point that decides
/// it.
fn tangent_ball_by_brute_force(points: &[[f32; 3]], t: &Tangent, max_radius: f32) -> (f64, f64) {
    points
        .iter()
        .filter_map(|p| {
            let a: [f64; 3] = std::array::from_fn(|i| {
                f64::from(p[i]) - f64::from(t.point[i]) - f64::from(t.margin) * f64::from(t.inward[i])
            });
            let depth: f64 = (0..3).map(|i| a[i] * f64::from(t.inward[i])).sum();
            let square: f64 = a.iter().map(|v| v * v).sum();
            (depth > 0.0).then_some((square / (2.0 * depth), square))
        })
        .fold((f64::from(max_radius), f64::INFINITY), |best, new| if new.0 < best.0 { new } else { best })
}

#[test]
fn tangent_balls_equal_brute_force_on_every_cloud() {
    let mut s = SequenceRandom(23);
    for (name, points) in clouds() {
        for index in both(&points) {
            for (i, &point) in points.iter().step_by(points.len() / 150 + 1).enumerate() {
                let tilt = s.point([0.4; 3]).map(|v| v - 0.2);
                let raw = if i % 3 == 0 {
                    [0.0, 1.0, tilt[2]]
                } else {
                    [tilt[0], tilt[1], if i % 2 == 0 { 1.0 } else { -1.0 }]
                };
                let length = distance_squared(raw, [0.0; 3]).sqrt();
                let tangent = Tangent { point, inward: raw.map(|v| v / length), margin: [0.0, 0.02, 0.1][i % 3] };
                for max_radius in [5.0, 30.0, 200.0] {
                    let (truth, chord_squared) = tangent_ball_by_brute_force(&points, &tangent, max_radius);
                    let mine = index.smallest_tangent_ball(&tangent, max_radius).map_or(max_radius, |(r, _)| r);
                    // f32 differences of neighbouring points are exact; the height h of the deciding point over the
                    // tangent plane then has an error of a few parts in 1e7 of the chord c, and the radius c² / 2h a
                    // relative error of that over h = c² / 2r
                    let allowed = 1e-6 + 5e-7 * 2.0 * truth / chord_squared.sqrt();
                    let relative = (f64::from(mine) - truth).abs() / truth;
                    assert!(
                        relative < allowed,
                        "{name} {tangent:?}: {mine} instead of {truth}, {relative} > {allowed}"
                    );
                }
            }
        }
    }
}

#[test]
fn both_kinds_of_instructions_give_the_same_bits() {
    for (name, points) in clouds() {
        let indices = both(&points);
        let [scalar, simd] = &indices[..] else { return };
        for query in queries(&points) {
            assert_eq!(scalar.nearest_within(query, 1e4), simd.nearest_within(query, 1e4), "{name}");
            let tangent = Tangent { point: query, inward: [0.6, 0.0, -0.8], margin: 0.05 };
            assert_eq!(
                scalar.smallest_tangent_ball(&tangent, 50.0),
                simd.smallest_tangent_ball(&tangent, 50.0),
                "{name}"
            );
        }
    }
}

#[test]
fn an_empty_index_finds_nothing() {
    let index = NeighborIndex::new(&[], &Control::none()).unwrap();
    let mut found = Vec::new();
    index.k_nearest([0.0; 3], 5, &mut found);
    assert!(found.is_empty());
    assert_eq!(index.nearest_within([0.0; 3], f32::INFINITY), None);
    let tangent = Tangent { point: [0.0; 3], inward: [0.0, 0.0, 1.0], margin: 0.0 };
    assert_eq!(index.smallest_tangent_ball(&tangent, 10.0), None);
}

#[test]
fn positions_that_are_not_finite_are_refused() {
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let error = NeighborIndex::new(&[[0.0; 3], [0.0, bad, 0.0]], &Control::none()).unwrap_err().to_string();
        assert!(error.contains("position"), "{error}");
    }
}

proptest! {
    #[test]
    fn nearest_of_random_clouds_equals_brute_force(
        points in prop::collection::vec(prop::array::uniform3(-100.0f32..100.0), 1..400),
        query in prop::array::uniform3(-300.0f32..300.0),
    ) {
        let truth = all_by_distance(&points, query)[0];
        for index in both(&points) {
            prop_assert_eq!(index.nearest_within(query, f32::INFINITY), Some(truth));
        }
    }
}
