//! Pulses of tiles.

use crate::grid::MapArea;
use belvedere::pulses::FreeSegmentColumns;

/// Returns the pulses that end in a tile, in an order that does not depend on their index.
pub(crate) fn of_tile(pulses: &FreeSegmentColumns, core: &MapArea) -> FreeSegmentColumns {
    let is_own = |(_, start): &(u32, &[f32; 3])| core.holds([start[0].into(), start[1].into()]);
    let rows: Vec<u32> = (0..).zip(&pulses.starts).filter(is_own).map(|(row, _)| row).collect();
    pulses.select(&rows).in_order()
}
