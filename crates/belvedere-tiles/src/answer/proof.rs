//! Proof by pulses of lines of sight that cross tiles. The proof runs block by block, so that memory does not grow with
//! the length of lines and tiles make no difference.
//!
//! The pulses that end in a tile are kept with its balls. A line of sight is cut at the sides of blocks of 64 m. The
//! length of each piece that no pulse over the block came near to is added in whole numbers. The order of the blocks
//! therefore does not change the sum.

use crate::answer::obstacles::ObstacleSearch;
use crate::grid::{CELL, MapArea, TileId, block_area, square_at};
use crate::plan::Plan;
use belvedere::Result;
use belvedere::cast::{to_f32s, to_row};
use belvedere::control::Control;
use belvedere::pulses::{FreeSegmentColumns, ends_of_pulse};
use belvedere::query::{Evidence, Proof, ProofParams};
use belvedere::vector::piece_in_box;
use rayon::prelude::*;
use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, HashMap};
use std::path::Path;

/// Additional distance beside a block within which a pulse counts as over it, metres, on top of the proof distance. It
/// is more than the rounding of positions.
const ROOM: f64 = 0.1;
/// Number of parts of a metre in which unseen lengths are counted.
const STEPS: f64 = 65_536.0;
/// Number of tiles above which pulses far from the block are dropped from memory.
const MAX_TILES: usize = 4;
/// Number of lines of sight and pulses that a thread takes at once: `CHUNK` for short work, `FEW` for long work.
const CHUNK: usize = 1024;
const FEW: usize = 64;

/// Line of sight from a target.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line {
    /// Target, local metres.
    pub(crate) target: [f64; 3],
    /// Unit vector from the target along the line.
    pub(crate) towards: [f64; 3],
    /// Length of the line, metres; infinite without an end.
    pub(crate) range: f64,
}

/// Returns the height up to which pulses can prove space empty, local metres.
pub(crate) fn top(plan: &Plan) -> f64 {
    f64::from(plan.statistics.top + plan.model().free_segments.headroom)
}

/// Returns the maximum horizontal distance from a place below `top` that a pulse passes near to its return, metres.
pub(crate) fn reach_of_pulses(plan: &Plan, top: f64) -> f64 {
    plan.statistics.max_lean * (top - f64::from(plan.low[2])).max(0.0) + plan.nearness + ROOM
}

/// True if a piece of a line passes over an area.
fn passes_over([start, end]: [[f64; 3]; 2], area: &MapArea) -> bool {
    let sides = [0, 1].map(|axis| [area.low[axis] - start[axis], area.high[axis] - start[axis]]);
    piece_in_box(sides, [end[0] - start[0], end[1] - start[1]], [0.0, 1.0]).is_some()
}

/// Flags those of `lines` that run through more unseen space than a proof tolerates.
///
/// # Errors
/// Those of reading pulses, and [`belvedere::Error::Cancelled`].
pub(crate) fn unproven(
    of_run: (&Plan, &Path),
    lines: &[Line],
    found: &mut ObstacleSearch,
    control: &Control<'_>,
) -> Result<Vec<bool>> {
    let ProofParams { tolerance, .. } = ProofParams::default();
    let measure = |proof: &Proof, line, piece| proof.unseen_length_between(line, piece, tolerance + 1.0);
    let unseen = unseen_steps(of_run, lines, (&measure, steps(tolerance)), found, control)?;
    Ok(unseen.into_iter().map(|unseen| unseen > steps(tolerance)).collect())
}

/// Returns the approximate unseen length of each of `lines`, metres, as evidence of a probability. Lengths above the
/// maximum of the evidence are not measured further.
///
/// # Errors
/// Those of [`unproven`].
pub(crate) fn sampled_lengths(
    of_run: (&Plan, &Path),
    lines: &[Line],
    found: &mut ObstacleSearch,
    control: &Control<'_>,
) -> Result<Vec<f64>> {
    let most = Evidence::MAX_UNPROVEN;
    let measure = |proof: &Proof, line, piece| proof.sampled_unseen_length_between(line, piece, most);
    let unseen = unseen_steps(of_run, lines, (&measure, steps(most)), found, control)?;
    Ok(unseen.into_iter().map(|unseen| f64::from(unseen) / STEPS).collect())
}

/// Measure of the unseen length of a piece of a line by a proof, metres.
type Measure<'a> = &'a (dyn Fn(&Proof, ([f64; 3], [f64; 3]), [f64; 2]) -> f64 + Sync);

/// Returns the unseen length of each of `lines` by `measure`, in steps, until it exceeds `enough`.
fn unseen_steps(
    (plan, run): (&Plan, &Path),
    lines: &[Line],
    (measure, enough): (Measure<'_>, u32),
    found: &mut ObstacleSearch,
    control: &Control<'_>,
) -> Result<Vec<u32>> {
    let params = ProofParams { nearness: Some(plan.nearness), ..ProofParams::default() };
    let survey = plan.area();
    let top = top(plan);
    // Only the part below the top and over the survey.
    let piece = |line: &Line| {
        let [east, north] = sides_of(&survey, line.target);
        let up = [f64::NEG_INFINITY, top - line.target[2]];
        piece_in_box([east, north, up], line.towards, [0.0, line.range]).filter(|[from, to]| to > from)
    };
    let pieces: Vec<Option<[f64; 2]>> = lines.par_iter().with_min_len(CHUNK).map(piece).collect();
    let mut unseen = vec![0_u32; lines.len()];
    let mut of_blocks: Vec<([i32; 2], Vec<u32>)> = lines_of_blocks(lines, &pieces).into_iter().collect();
    // Blocks of one tile follow each other.
    of_blocks.sort_by_cached_key(|(block, _)| (plan.grid().tile_of(block_area(*block).low), *block));
    let mut pulses = TilePulses { reach: reach_of_pulses(plan, top), tiles: BTreeMap::new() };
    for (block, rows) in of_blocks {
        control.check()?;
        let waiting: Vec<u32> = rows.into_iter().filter(|&row| unseen[row as usize] <= enough).collect();
        if waiting.is_empty() {
            continue;
        }
        let proof = Proof::from_columns(pulses.over((plan, run), block, found, control)?, &params)?;
        proof.prepare(control)?;
        let area = block_area(block);
        let length = |&row: &u32| {
            let line = lines.get(row as usize)?;
            let flat = [line.towards[0], line.towards[1]];
            let own = piece_in_box(sides_of(&area, line.target), flat, (*pieces.get(row as usize)?)?)?;
            Some((row, steps(measure(&proof, (line.target, line.towards), own))))
        };
        let lengths: Vec<(u32, u32)> = waiting.par_iter().with_min_len(FEW).filter_map(length).collect();
        for (row, length) in lengths {
            unseen[row as usize] = unseen[row as usize].saturating_add(length);
        }
    }
    Ok(unseen)
}

/// Rounds a length in metres to whole steps.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "`as` saturates")]
fn steps(metres: f64) -> u32 {
    (metres * STEPS).round() as u32
}

/// Returns the sides of an area relative to a place.
fn sides_of(area: &MapArea, place: [f64; 3]) -> [[f64; 2]; 2] {
    [0, 1].map(|axis| [area.low[axis] - place[axis], area.high[axis] - place[axis]])
}

/// Returns the blocks of 64 m that lines run through, with the indices of these lines.
fn lines_of_blocks(lines: &[Line], pieces: &[Option<[f64; 2]>]) -> BTreeMap<[i32; 2], Vec<u32>> {
    let mut blocks: BTreeMap<[i32; 2], Vec<u32>> = BTreeMap::new();
    for (row, (line, piece)) in (0_u32..).zip(lines.iter().zip(pieces)) {
        let Some([from, to]) = *piece else { continue };
        let at = |along: f64, axis: usize| line.target[axis] + along * line.towards[axis];
        let block = |along: f64| square_at(to_f32s([0, 1].map(|axis| at(along, axis))), CELL);
        let ends = [block(from), block(to)];
        let span = |axis: usize| {
            let [a, b] = ends.map(|block| block[axis]);
            a.min(b) - 1..=a.max(b) + 1
        };
        for north in span(1) {
            for east in span(0) {
                let sides = sides_of(&block_area([east, north]), line.target);
                let own = piece_in_box(sides, [line.towards[0], line.towards[1]], [from, to]);
                if own.is_some_and(|[from, to]| to > from) {
                    blocks.entry([east, north]).or_default().push(row);
                }
            }
        }
    }
    blocks
}

/// Pulses of the last tiles that were read.
struct TilePulses {
    /// Maximum distance from a block to the end of a pulse over it, metres.
    reach: f64,
    tiles: BTreeMap<TileId, PulsesOfBlocks>,
}

/// Pulses of a tile, and the rows of the pulses over each of its blocks.
struct PulsesOfBlocks {
    pulses: FreeSegmentColumns,
    rows: HashMap<[i32; 2], Vec<u32>>,
}

impl TilePulses {
    /// Returns the pulses over a block, in an order that does not depend on the tiles.
    fn over(
        &mut self,
        (plan, run): (&Plan, &Path),
        block: [i32; 2],
        found: &mut ObstacleSearch,
        control: &Control<'_>,
    ) -> Result<FreeSegmentColumns> {
        let around = block_area(block).widened(self.reach);
        let (first, last) = (plan.grid().tile_of(around.low), plan.grid().tile_of(around.high));
        let is_near = |tile: TileId| {
            (first.north..=last.north).contains(&tile.north) && (first.east..=last.east).contains(&tile.east)
        };
        if self.tiles.len() > MAX_TILES {
            self.tiles.retain(|&tile, _| is_near(tile));
        }
        let mut all = FreeSegmentColumns::default();
        for &tile in plan.tiles.iter().filter(|&&tile| is_near(tile)) {
            let PulsesOfBlocks { pulses, rows } = match self.tiles.entry(tile) {
                Entry::Occupied(kept) => kept.into_mut(),
                Entry::Vacant(place) => {
                    let read = control.stage("reading pulses", 0, || found.pulses(plan, run, tile, control))?;
                    place.insert(PulsesOfBlocks::new(read.unwrap_or_default(), plan.nearness))
                }
            };
            let Some(rows) = rows.get(&block) else { continue };
            let own = pulses.select(rows);
            all.top = own.top;
            all.append(own);
        }
        Ok(all.in_order())
    }
}

impl PulsesOfBlocks {
    fn new(pulses: FreeSegmentColumns, nearness: f64) -> Self {
        let blocks_of = |row: u32| {
            let ends = ends_of_pulse(&pulses, row as usize);
            let area = ends.map(|[start, end]| {
                let low = [0, 1].map(|axis| start[axis].min(end[axis]));
                let high = [0, 1].map(|axis| start[axis].max(end[axis]));
                MapArea { low, high }.widened(nearness + ROOM)
            });
            let blocks: Vec<[i32; 2]> = area.into_iter().flat_map(|area| area.blocks().collect::<Vec<_>>()).collect();
            let is_over = move |block: &[i32; 2]| {
                ends.is_some_and(|ends| passes_over(ends, &block_area(*block).widened(nearness + ROOM)))
            };
            blocks.into_iter().filter(is_over).map(move |block| (block, row))
        };
        let count = to_row(pulses.starts.len());
        let mut pairs: Vec<([i32; 2], u32)> =
            (0..count).into_par_iter().with_min_len(CHUNK).flat_map_iter(blocks_of).collect();
        pairs.par_sort_unstable();
        let of_block = |pairs: &[([i32; 2], u32)]| (pairs[0].0, pairs.iter().map(|pair| pair.1).collect());
        let rows = pairs.chunk_by(|a, b| a.0 == b.0).map(of_block).collect();
        Self { pulses, rows }
    }
}
