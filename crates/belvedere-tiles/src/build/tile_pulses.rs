//! Pulses of tiles, in an order that does not depend on their index.

use crate::grid::MapArea;
use belvedere::cast::to_row;
use belvedere::pulses::FreeSegmentColumns;
use rayon::prelude::*;

/// Returns the pulses that end in a tile, in an order that does not depend on their index.
pub(crate) fn of_tile(pulses: &FreeSegmentColumns, core: &MapArea) -> FreeSegmentColumns {
    let is_own = |(_, start): &(u32, &[f32; 3])| core.holds([start[0].into(), start[1].into()]);
    let rows: Vec<u32> = (0..).zip(&pulses.starts).filter(is_own).map(|(row, _)| row).collect();
    in_order(pulses.select(&rows))
}

/// Sorts pulses by their numbers.
pub(crate) fn in_order(pulses: FreeSegmentColumns) -> FreeSegmentColumns {
    let key = |row: u32| {
        let row = row as usize;
        let start = pulses.starts.get(row).map(|start| start.map(f32::to_bits));
        let length = pulses.lengths.get(row).map(|length| length.to_bits());
        (start, pulses.slopes.get(row), length, pulses.ways.get(row))
    };
    let mut rows: Vec<u32> = (0..to_row(pulses.starts.len())).collect();
    // The pulses of one tile are sorted already.
    if rows.is_sorted_by(|&a, &b| key(a) <= key(b)) {
        return pulses;
    }
    // Pulses of several tiles form as many sorted runs.
    rows.par_sort_by(|&a, &b| key(a).cmp(&key(b)));
    pulses.select(&rows)
}
