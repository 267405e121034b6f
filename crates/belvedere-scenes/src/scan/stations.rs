//! Free places for tripods: on open ground, away from walls, spread over the scene.

use std::f64::consts::TAU;

use rayon::prelude::*;

use crate::scene::{Material, TriangleScene};
use crate::truth::Truth;

/// Minimum distances of obstacles from a tripod, metres, tried in turn. A tripod does not stand against a wall while
/// the middle of a street is free.
const CLEARANCES: [f64; 3] = [2.5, 1.2, 0.5];
/// Number of directions in which that space must be free.
const DIRECTIONS: u32 = 16;
/// Distance between tried places, metres, in scenes of up to [`PLACES_ACROSS`] places along a side.
const STEP: f64 = 2.0;
/// Maximum number of places along each side.
const PLACES_ACROSS: f64 = 150.0;
/// Height above the foot at which space must be free, metres, besides the height of the instrument. It is above kerbs
/// and cars' wheels, and below hedges.
const KNEE: f64 = 0.6;

/// Returns up to `count` positions of an instrument `height` metres above open ground, (S, 3), metres, absolute.
///
/// Open ground has nothing above it and nothing beside it for a few metres. Each open place is as near as possible to
/// one of the positions. The positions start far from each other and then move to the middle of their nearest places.
/// There are fewer positions if there is less room, and none in a scene without ground.
///
/// # Source
/// Start: farthest-point sampling, Gonzalez 1985. Moves: Lloyd 1982.
pub(crate) fn free_stations(scene: &TriangleScene, truth: &Truth, count: u16, height: f64) -> Vec<[f64; 3]> {
    let Some((low, high)) = scene.bounds() else { return Vec::new() };
    let places = open_ground(scene, truth, (low, high));
    for clearance in CLEARANCES {
        let free: Vec<[f64; 3]> =
            places.par_iter().copied().filter(|&foot| has_room(truth, foot, height, clearance)).collect();
        if !free.is_empty() {
            let chosen = spread(&free, count);
            return chosen.into_iter().map(|[x, y, z]| [x, y, z + height]).collect();
        }
    }
    Vec::new()
}

/// Returns the places on a grid with ground directly below the sky.
fn open_ground(scene: &TriangleScene, truth: &Truth, (low, high): ([f64; 3], [f64; 3])) -> Vec<[f64; 3]> {
    let sides = [0, 1].map(|axis| high[axis] - low[axis]);
    let step = STEP.max(sides[0].max(sides[1]) / PLACES_ACROSS);
    let coordinates = |axis: usize| {
        let start = low[axis] + step / 2.0;
        std::iter::successors(Some(start), move |v| Some(v + step)).take_while(move |v| *v < high[axis])
    };
    let grid: Vec<[f64; 2]> = coordinates(1).flat_map(|y| coordinates(0).map(move |x| [x, y])).collect();
    let sky = high[2] + 1.0;
    grid.par_iter()
        .filter_map(|&[x, y]| {
            let hit = truth.first_hit([x, y, sky], [0.0, 0.0, -1.0], f64::INFINITY)?;
            let is_ground = scene.materials.get(hit.triangle as usize) == Some(&Material::Terrain);
            is_ground.then_some([x, y, sky - hit.range])
        })
        .collect()
}

fn has_room(truth: &Truth, [x, y, z]: [f64; 3], height: f64, clearance: f64) -> bool {
    [KNEE, height].iter().all(|above| {
        (0..DIRECTIONS).all(|i| {
            let (sin, cos) = (f64::from(i) * TAU / f64::from(DIRECTIONS)).sin_cos();
            truth.first_hit([x, y, z + above], [cos, sin, 0.0], clearance).is_none()
        })
    })
}

/// Number of rounds in which stations move to the middle of their surroundings; after ten hardly any moves.
const ROUNDS: u32 = 10;

/// Returns up to `count` of `places`, spread evenly over them.
fn spread(places: &[[f64; 3]], count: u16) -> Vec<[f64; 3]> {
    let mut chosen = far_apart(places, count);
    for _ in 0..ROUNDS {
        let owners: Vec<usize> = places.par_iter().filter_map(|&place| nearest(&chosen, place)).collect();
        let mut sums = vec![([0.0; 2], 0.0); chosen.len()];
        for (place, &owner) in places.iter().zip(&owners) {
            if let Some((sum, members)) = sums.get_mut(owner) {
                *sum = [sum[0] + place[0], sum[1] + place[1]];
                *members += 1.0;
            }
        }
        let owning = sums.iter().filter(|(_, members)| *members > 0.0);
        let middles = owning.map(|(sum, members)| [sum[0] / members, sum[1] / members, 0.0]);
        chosen = middles.filter_map(|middle| places.get(nearest(places, middle)?).copied()).collect();
    }
    chosen
}

/// Returns up to `count` of `places`, each the farthest from the earlier ones. The first is the first of all.
fn far_apart(places: &[[f64; 3]], count: u16) -> Vec<[f64; 3]> {
    let mut gaps = vec![f64::INFINITY; places.len()];
    let mut chosen = Vec::new();
    for _ in 0..count {
        // The first of equals, so that the choice does not depend on the order of the search.
        let best = gaps.iter().enumerate().reduce(|a, b| if b.1 > a.1 { b } else { a });
        let Some((index, _)) = best.filter(|(_, gap)| **gap > 0.0) else { break };
        let Some(&place) = places.get(index) else { break };
        for (gap, p) in gaps.iter_mut().zip(places) {
            *gap = gap.min(level_distance(*p, place));
        }
        chosen.push(place);
    }
    chosen
}

/// Returns the index of the first of `places` nearest to `place` on the map.
fn nearest(places: &[[f64; 3]], place: [f64; 3]) -> Option<usize> {
    let gaps = places.iter().map(|&p| level_distance(p, place)).enumerate();
    gaps.reduce(|a, b| if b.1 < a.1 { b } else { a }).map(|(index, _)| index)
}

fn level_distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}
