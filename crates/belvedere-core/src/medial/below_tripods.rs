//! Floors below tripods: a scanner does not measure the place that it stands on, and the floor goes on there.

use crate::neighbors::NeighborIndex;
use crate::pulses::FreeSegments;
use belvedere_data::cast::{to_i64, to_index};
use belvedere_data::vector::sub;
use std::collections::BTreeMap;
use std::f32::consts::TAU;

/// Number of free segments of which one is used to find the position of the scanner.
const SAMPLE: usize = 64;
/// Sampled free segments that a tripod has at least.
const MIN_SAMPLED: usize = 32;
/// Steps of scanner positions, metres: a car leaves each before it has sent 2000 pulses, and f32 rounds to less.
const STEP_M: f32 = 0.002;
/// Minimum distance between tripods, metres; nearer ones are one tripod on both sides of a step.
const MIN_APART: f32 = 0.1;
/// Sectors about a tripod that the nearest points on the floor are looked for in, and how many must have one: its legs
/// may hide the others.
const SECTORS: usize = 36;
const MIN_SECTORS: usize = 24;
/// Maximum distance of the floor's nearest points from the foot of a tripod, in heights of the scanner above them:
/// scanners look down to 30° from straight down or more.
const MAX_HEIGHTS: f32 = 1.2;
/// Minimum height of a scanner above the floor, metres; points nearer to it are the tripod itself.
const MIN_HEIGHT: f32 = 0.5;
/// Maximum slope of a floor; points farther above or below the others are no part of it.
const MAX_SLOPE: f32 = 0.5;

/// A place on the floor below a tripod.
#[derive(Clone, Copy)]
pub(super) struct FloorPlace {
    pub(super) position: [f32; 3],
    /// Row of the nearest point where the measured floor begins.
    pub(super) row: usize,
}

/// Places on the floor, at most `spacing` metres apart, that tripods among the scanners of `free_segments` stand on.
/// They go from the foot of each to where its own pulses reached the floor. `index` must have been built from the
/// `positions`. The result does not depend on the number of threads.
pub(super) fn floors_below(
    positions: &[[f32; 3]],
    index: &NeighborIndex,
    free_segments: &FreeSegments,
    spacing: f32,
) -> Vec<FloorPlace> {
    let floor_below =
        |tripod| floor_below(positions, &nearest_around(index, positions, free_segments, tripod), tripod, spacing);
    tripods(free_segments).into_iter().flat_map(floor_below).collect()
}

/// Returns the places where many free segments end.
fn tripods(free_segments: &FreeSegments) -> Vec<[f32; 3]> {
    let mut found: BTreeMap<[i64; 3], (usize, [f32; 3])> = BTreeMap::new();
    for (start, direction, length) in
        (0..free_segments.len()).step_by(SAMPLE).filter_map(|number| free_segments.segment(number))
    {
        let end: [f32; 3] = std::array::from_fn(|axis| start[axis] + direction[axis] * length);
        let step = end.map(|v| to_i64(f64::from((v / STEP_M).round())));
        let (count, least) = found.entry(step).or_insert((0, end));
        *count += 1;
        *least = if end < *least { end } else { *least };
    }
    let mut tripods: Vec<[f32; 3]> = Vec::new();
    for (_, end) in found.into_values().filter(|(count, _)| *count >= MIN_SAMPLED) {
        let is_known = |other: &[f32; 3]| sub(end, *other).iter().all(|off| off.abs() < MIN_APART);
        if !tripods.iter().any(is_known) {
            tripods.push(end);
        }
    }
    tripods
}

fn floor_below(positions: &[[f32; 3]], around: &[Edge], tripod: [f32; 3], spacing: f32) -> Vec<FloorPlace> {
    let widest = around.iter().map(|point| point.range).fold(0.0, f32::max);
    #[expect(clippy::cast_possible_truncation, reason = "some hundred steps")]
    let steps = (widest / spacing).ceil() as i16;
    let offsets = || (-steps..=steps).map(|number| f32::from(number) * spacing);
    let mut places = Vec::new();
    for [x, y] in offsets().flat_map(|x| offsets().map(move |y| [x, y])) {
        let off = |point: &&Edge| (point.offset[0] - x).hypot(point.offset[1] - y);
        let Some(nearest) = around.iter().min_by(|a, b| off(a).total_cmp(&off(b))) else { continue };
        // one step over what was measured, so that no gap is left
        if x.hypot(y) >= nearest.range + spacing {
            continue;
        }
        // heights weighted by the inverse square of the distance
        let weight = |point: &Edge| 1.0 / off(&point).max(spacing).powi(2);
        let weights: f32 = around.iter().map(weight).sum();
        let z = around.iter().map(|point| weight(point) * positions[point.row][2]).sum::<f32>() / weights;
        places.push(FloorPlace { position: [tripod[0] + x, tripod[1] + y, z], row: nearest.row });
    }
    places
}

/// A point where the floor around a tripod begins.
#[derive(Clone, Copy)]
struct Edge {
    /// Horizontal distance from the foot of the tripod, metres; and where it lies from there, east and north.
    range: f32,
    offset: [f32; 2],
    height: f32,
    row: usize,
}

/// Returns the nearest floor point in each sector around the foot of the tripod, seen by its own pulses. Empty if too
/// few sectors have one.
fn nearest_around(
    index: &NeighborIndex,
    positions: &[[f32; 3]],
    free_segments: &FreeSegments,
    tripod: [f32; 3],
) -> Vec<Edge> {
    let mut lowest = [None::<(f32, [f32; 3])>; SECTORS];
    for (start, direction, length) in (0..free_segments.len()).filter_map(|number| free_segments.segment(number)) {
        let [x, y, height] = sub(start, tripod);
        let range = x.hypot(y);
        let is_below = height < -MIN_HEIGHT && range < -height * MAX_HEIGHTS;
        let is_own = || (0..3).all(|axis| (start[axis] + direction[axis] * length - tripod[axis]).abs() < MIN_APART);
        if is_below && is_own() {
            let sector = to_index(f64::from(y.atan2(x).rem_euclid(TAU) / TAU * SECTORS as f32));
            let own = &mut lowest[sector.min(SECTORS - 1)];
            if own.is_none_or(|known| (range, start) < known) {
                *own = Some((range, start));
            }
        }
    }
    let mut near = Vec::new();
    let mut found = Vec::new();
    for (_, start) in lowest.into_iter().flatten() {
        // the pulse begins just before its return
        index.k_nearest(start, 1, &mut near);
        if let Some(row) = near.first().map(|found| found.index as usize) {
            let [x, y, height] = sub(positions[row], tripod);
            found.push(Edge { range: x.hypot(y), offset: [x, y], height, row });
        }
    }
    let mut heights: Vec<f32> = found.iter().map(|point| point.height).collect();
    heights.sort_unstable_by(f32::total_cmp);
    let middle = heights.get(heights.len() / 2).copied().unwrap_or_default();
    let widest = found.iter().map(|point| point.range).fold(0.0, f32::max);
    found.retain(|point| (point.height - middle).abs() <= MAX_SLOPE * widest);
    if found.len() < MIN_SECTORS {
        found.clear();
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pulses::FreeSegmentParams;
    use belvedere_data::control::Control;

    const TRIPOD: [f32; 3] = [3.0, -2.0, 1.6];
    /// Radius of the place that the scanner does not look at, metres.
    const BLIND: f32 = 0.8;

    /// A floor that rises by a tenth to the east, measured except below the tripod, in sectors for which `is_open`.
    fn floor(is_open: impl Fn(f32) -> bool) -> (Vec<[f32; 3]>, NeighborIndex, FreeSegments) {
        let mut positions = Vec::new();
        for ring in 0_u8..20 {
            for step in 0_u8..200 {
                let angle = f32::from(step) / 200.0 * TAU;
                let range = BLIND + f32::from(ring) * 0.05;
                if is_open(angle) {
                    let [x, y] = [range * angle.cos(), range * angle.sin()];
                    positions.push([TRIPOD[0] + x, TRIPOD[1] + y, 0.1 * x]);
                }
            }
        }
        let scanner = vec![TRIPOD; positions.len()];
        let params = FreeSegmentParams::default();
        let (free_segments, _) = FreeSegments::new(&positions, &scanner, &params, &Control::none()).unwrap();
        let index = NeighborIndex::new(&positions, &Control::none()).unwrap();
        (positions, index, free_segments)
    }

    #[test]
    fn the_floor_below_a_tripod_goes_on_as_it_is_around() {
        let (positions, index, free_segments) = floor(|_| true);
        let places = floors_below(&positions, &index, &free_segments, 0.05);
        let area = places.len() as f32 * 0.05 * 0.05;
        let whole = std::f32::consts::PI * (BLIND + 0.05) * (BLIND + 0.05);
        // the edge of the places is ragged by half a step
        assert!((area / whole - 1.0).abs() < 0.05, "{area} of {whole} m²");
        for place in places {
            let [x, y, z] = sub(place.position, [TRIPOD[0], TRIPOD[1], 0.0]);
            assert!(x.hypot(y) < BLIND + 0.06);
            // interpolation flattens a slope of 0.08 m from the middle to the edge
            assert!((z - 0.1 * x).abs() < 0.05, "{z} at {x}");
            assert!(sub(positions[place.row], place.position)[0].abs() < 2.0 * BLIND);
        }
    }

    #[test]
    fn legs_of_the_tripod_do_not_matter_but_half_a_floor_is_none() {
        let is_leg = |angle: f32| (angle % (TAU / 3.0)) < 0.2;
        let (positions, index, free_segments) = floor(|angle| !is_leg(angle));
        assert!(floors_below(&positions, &index, &free_segments, 0.05).len() > 600);
        let (positions, index, free_segments) = floor(|angle| angle < 3.5);
        assert!(floors_below(&positions, &index, &free_segments, 0.05).is_empty());
    }

    #[test]
    fn a_scanner_that_moves_stands_nowhere() {
        let (positions, index, _) = floor(|_| true);
        let scanner: Vec<[f32; 3]> =
            (0..positions.len()).map(|i| [TRIPOD[0] + 0.001 * i as f32, TRIPOD[1], TRIPOD[2]]).collect();
        let params = FreeSegmentParams::default();
        let (free_segments, _) = FreeSegments::new(&positions, &scanner, &params, &Control::none()).unwrap();
        assert!(floors_below(&positions, &index, &free_segments, 0.05).is_empty());
    }
}
