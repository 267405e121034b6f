//! Round holes in floors, as a tripod leaves them below itself.

use belvedere_data::cast::{to_cell, to_index, to_row, to_u32};
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Points that are looked at, at most, or a sixteenth of all where that is more: the floor about a tripod has thousands
/// in each square metre.
const SAMPLED: usize = 300_000;
const MIN_SHARE: f64 = 1.0 / 16.0;
/// Side of the cells that floors are looked at in, metres.
const CELL: f32 = 0.2;
/// Floor points in a cell from which on it is dense, and how many times as many it has as half of all cells. Measured:
/// seen from a tripod the edge of the hole has 6 times as many in a room, and hundreds of times in a street.
const MIN_COUNT: u32 = 8;
const MIN_CONTRAST: u32 = 5;
const OF_CONTRAST: u32 = 2;
/// Height of the slab that holds a floor, metres to each side of the tenth lowest of a hundred points.
const SLAB: f32 = 0.1;
/// Cells from the foot of a tripod to the edge of its hole, at most; 2 m.
const REACH: i32 = 10;
/// Directions that the edge is looked for in, and how many must have one: legs hide the others.
const SECTORS: usize = 12;
const MIN_SECTORS: usize = 9;
/// Share of the densest cell around that the edge of a hole has at least, and the hole at most.
const EDGE_SHARE: f64 = 0.2;
/// Maximum coefficient of variation of the distances to the edge (standard deviation over mean).
const MAX_UNEVEN: f64 = 0.4;
/// Maximum height difference between the floor around a tripod and its median height, metres: slopes and kerbs.
const MAX_STEP: f64 = 0.5;
/// Tripods on one floor stand farther apart than that, metres.
const MIN_APART: f64 = 0.8;
/// Maximum number of cells beside a hole, densest first, so that no cloud costs more than some tenths of a second.
const MAX_EDGES: usize = 20_000;

/// A cell of the map with its floor.
struct FloorCell {
    at: [i32; 2],
    /// Points of the floor.
    count: u32,
    height: f32,
}

/// Returns the centres of round holes in the floors of `points`, local metres, roundest first. In a cloud that is no
/// ground scan, one in a thousand of them looks like the foot of a tripod. The result does not depend on the order of
/// the points.
pub(super) fn floor_holes(points: &[[f32; 3]]) -> Vec<[f64; 3]> {
    let cells = cells(points);
    let mut counts: Vec<u32> = cells.iter().map(|cell| cell.count).collect();
    counts.sort_unstable();
    let middle = counts.get(counts.len() / 2).copied().unwrap_or_default();
    let dense = MIN_COUNT.max(middle.saturating_mul(MIN_CONTRAST) / OF_CONTRAST);
    let mut edges: Vec<&FloorCell> =
        cells.par_iter().filter(|cell| cell.count >= dense && is_edge(&cells, cell)).collect();
    edges.sort_by_key(|cell| (std::cmp::Reverse(cell.count), cell.at));
    edges.truncate(MAX_EDGES);
    let around =
        |at: [i32; 2]| (-REACH..=REACH).flat_map(move |x| (-REACH..=REACH).map(move |y| [at[0] + x, at[1] + y]));
    let mut feet: Vec<[i32; 2]> = edges.par_iter().flat_map_iter(|cell| around(cell.at)).collect();
    feet.par_sort_unstable();
    feet.dedup();
    let mut holes: Vec<(f64, [f64; 3])> = feet.par_iter().filter_map(|&foot| hole_about(&cells, foot, dense)).collect();
    holes.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.partial_cmp(&b.1).unwrap_or(std::cmp::Ordering::Equal)));
    let mut middles: Vec<[f64; 3]> = Vec::new();
    for (_, place) in holes {
        if middles.iter().all(|m| (m[0] - place[0]).hypot(m[1] - place[1]) >= MIN_APART) {
            middles.push(place);
        }
    }
    middles
}

/// The cells of a sample of the points, by place.
fn cells(points: &[[f32; 3]]) -> Vec<FloorCell> {
    let share = (SAMPLED as f64 / points.len().max(1) as f64).max(MIN_SHARE);
    let max = to_u32(share * f64::from(u32::MAX));
    let sampled = points.par_iter().filter(|p| scattered(p.map(f32::to_bits)) <= max);
    let mut sorted: Vec<([i32; 2], f32)> =
        sampled.map(|p| ([p[0], p[1]].map(|v| to_cell(f64::from(v / CELL))), p[2])).collect();
    sorted.par_sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let cell = |chunk: &[([i32; 2], f32)]| {
        let &(at, height) = chunk.get(chunk.len() / 10)?;
        let count = chunk.iter().filter(|(_, z)| (z - height).abs() <= SLAB).count();
        Some(FloorCell { at, count: to_row(count), height })
    };
    sorted.chunk_by(|a, b| a.0 == b.0).filter_map(cell).collect()
}

/// A number that depends on these alone, evenly spread over its range.
fn scattered(bits: [u32; 3]) -> u32 {
    // rounds of multiply and shift, after Steele, Lea & Flood 2014
    let mixed = bits.iter().fold(0x9E37_79B9_7F4A_7C15_u64, |state, &word| {
        let state = (state ^ u64::from(word)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        (state ^ (state >> 29)).wrapping_mul(0x94D0_49BB_1331_11EB)
    });
    (mixed >> 32) as u32
}

/// Floor points of the cell at a place, if its floor is at about this height: below a ceiling nothing else may have
/// been seen.
fn count_at(cells: &[FloorCell], at: [i32; 2], height: f64, max_offset: f64) -> f64 {
    let found = cells.binary_search_by(|cell| cell.at.cmp(&at)).ok().and_then(|i| cells.get(i));
    let on_floor = found.filter(|cell| (f64::from(cell.height) - height).abs() <= max_offset);
    on_floor.map_or(0.0, |cell| f64::from(cell.count))
}

/// Returns true if a neighbouring cell has far fewer points on the same floor.
fn is_edge(cells: &[FloorCell], cell: &FloorCell) -> bool {
    let [x, y] = cell.at;
    let beside = [[x - 1, y], [x + 1, y], [x, y - 1], [x, y + 1]];
    let is_low =
        |&at: &[i32; 2]| count_at(cells, at, cell.height.into(), MAX_STEP) < EDGE_SHARE * f64::from(cell.count);
    beside.iter().any(is_low)
}

/// Returns the unevenness of the edge of the hole around this cell, and the centre of the hole. `None` if the hole is
/// open or there is none.
fn hole_about(cells: &[FloorCell], foot: [i32; 2], dense: u32) -> Option<(f64, [f64; 3])> {
    let near = || {
        (-REACH..=REACH).flat_map(move |x| {
            let column = foot[0] + x;
            let from = cells.partition_point(|cell| cell.at < [column, foot[1] - REACH]);
            let is_within = move |cell: &&FloorCell| cell.at <= [column, foot[1] + REACH];
            cells.get(from..).unwrap_or_default().iter().take_while(is_within)
        })
    };
    let mut heights: Vec<f32> = near().filter(|cell| cell.count >= dense).map(|cell| cell.height).collect();
    heights.sort_unstable_by(f32::total_cmp);
    // ceilings and tables lie above floors
    let floor = f64::from(*heights.get(heights.len() / 4)?);
    let on_floor = || near().filter(|cell| (f64::from(cell.height) - floor).abs() <= MAX_STEP);
    let max = EDGE_SHARE * f64::from(on_floor().map(|cell| cell.count).max()?);
    if count_at(cells, foot, floor, MAX_STEP) >= max {
        return None;
    }
    let mut edge = [None::<f64>; SECTORS];
    for cell in on_floor().filter(|cell| f64::from(cell.count) >= max) {
        let [x, y] = [0, 1].map(|i| f64::from(cell.at[i] - foot[i]));
        let range = x.hypot(y) * f64::from(CELL);
        let sector = to_index(y.atan2(x).rem_euclid(TAU) / TAU * SECTORS as f64) % SECTORS;
        let own = &mut edge[sector];
        *own = Some(own.map_or(range, |known| known.min(range)));
    }
    let count = edge.iter().flatten().count();
    if count < MIN_SECTORS {
        return None;
    }
    let mean = edge.iter().flatten().sum::<f64>() / count as f64;
    let variance = edge.iter().flatten().map(|range| (range - mean).powi(2)).sum::<f64>() / count as f64;
    let uneven = variance.sqrt() / mean;
    if uneven > MAX_UNEVEN {
        return None;
    }
    // a foot that lies off the middle by s sees the edge in the direction u at s·u more than the mean
    let mut off = [0.0; 2];
    for (sector, range) in edge.iter().enumerate() {
        let angle = (sector as f64 + 0.5) / SECTORS as f64 * TAU;
        let more = 2.0 / SECTORS as f64 * (range.unwrap_or(mean) - mean);
        off = [off[0] + more * angle.cos(), off[1] + more * angle.sin()];
    }
    let [x, y] = [0, 1].map(|i| (f64::from(foot[i]) + 0.5) * f64::from(CELL) + off[i]);
    Some((uneven, [x, y, floor]))
}
