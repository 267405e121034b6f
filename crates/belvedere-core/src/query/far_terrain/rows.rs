//! Lines of sight of the matrix that far terrain blocks.

use super::{FarTerrain, LineStarts, on_map};
use crate::query::backend::{BLOCK, WORD};
use belvedere_data::Result;
use belvedere_data::cast::to_index;
use belvedere_data::control::Control;
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Sectors of azimuth for each of which the distance of the last horizon is kept.
const SECTORS: usize = 64;

/// Unsets the bits of lines of sight that far terrain blocks, in rows of `words` for `targets`, (M, 3), neighbours
/// together, and `directions`, (D, 3). For every pair the same as [`FarTerrain::hides`].
pub(in crate::query) fn hide_behind_terrain(
    far: &FarTerrain,
    targets: &[[f32; 3]],
    directions: &[[f64; 3]],
    words: &mut [u64],
    control: &Control<'_>,
) -> Result<()> {
    let width = directions.len().div_ceil(WORD).max(1);
    let mut above = vec![u64::MAX; width];
    let hides = |direction: &[f64; 3]| far.profile.as_ref().is_some_and(|profile| profile.hides(*direction));
    for (column, _) in directions.iter().enumerate().filter(|(_, direction)| hides(direction)) {
        above[column / WORD] &= !(1 << (column % WORD));
    }
    let blocks = words.par_chunks_mut(width * BLOCK).zip(targets.par_chunks(BLOCK));
    blocks.try_for_each(|(rows, targets)| {
        control.check()?;
        for row in rows.chunks_mut(width) {
            row.iter_mut().zip(&above).for_each(|(word, above)| *word &= above);
        }
        hide_block(far, targets, directions, rows, width);
        Ok(())
    })
}

/// Unsets the bits of lines of sight that the raster blocks, for targets close to each other. Answers that are certain
/// for their common box are not computed for each target.
fn hide_block(far: &FarTerrain, targets: &[[f32; 3]], directions: &[[f64; 3]], rows: &mut [u64], width: usize) {
    let Some(relief) = &far.relief else { return };
    let bound = |pick: fn(f64, f64) -> f64, start: f64| -> [f64; 3] {
        std::array::from_fn(|axis| targets.iter().map(|target| f64::from(target[axis])).fold(start, pick))
    };
    let places = LineStarts { low: bound(f64::min, f64::INFINITY), high: bound(f64::max, f64::NEG_INFINITY) };
    let middle = std::array::from_fn(|axis| f64::midpoint(places.low[axis], places.high[axis]));
    let mut guesses = [None; SECTORS];
    for (column, direction) in directions.iter().enumerate() {
        let (word, bit) = (column / WORD, 1 << (column % WORD));
        let (along, tangent) = on_map(*direction);
        if !rows.chunks(width).any(|row| row[word] & bit != 0) || !relief.may_hide(&places, along, tangent, &far.earth)
        {
            continue;
        }
        let sector = to_index(along[0].atan2(along[1]).rem_euclid(TAU) / TAU * SECTORS as f64) % SECTORS;
        let top = relief.top(middle, along, &far.earth, guesses[sector]);
        guesses[sector] = top.map(|top| top.span);
        let hides_all = top.is_some_and(|top| {
            top.tangent > tangent && relief.hides_all(&places, along, tangent, top.span, &far.earth)
        });
        for (row, target) in rows.chunks_mut(width).zip(targets) {
            if row[word] & bit != 0 && (hides_all || relief.hides(target.map(f64::from), along, tangent, &far.earth)) {
                row[word] &= !bit;
            }
        }
    }
}
