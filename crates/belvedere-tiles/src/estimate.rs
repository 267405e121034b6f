//! What a run will take.

use crate::grid::{CELL, MapArea, block_area};
use crate::plan::Plan;
use crate::survey::SurveyBlock;
use serde::Serialize;

/// Memory for each point of a window while balls are made, and without any, bytes. As measured in docs/scale.md.
const BYTES_PER_POINT: f64 = 450.0;
const MIN_BYTES: f64 = 100e6;
/// Memory for each ball of those that are tested together, bytes: measured 290, and room for cells and their points.
const BYTES_PER_BALL: f64 = 450.0;
/// Balls that are always tested together: fewer would save no memory that counts.
const MIN_BALLS: usize = 100_000;
/// Bytes of a ball file for each point of a tile.
const DISK_PER_POINT: f64 = 30.0;

/// What a plan will take.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct RunEstimate {
    /// Points of all tiles.
    pub points: u64,
    /// Points that are read, those around tiles among them.
    #[serde(rename = "points_with_halo")]
    pub points_with_buffer: u64,
    /// Most points that one tile reads.
    #[serde(rename = "most_points_of_a_tile")]
    pub max_points_of_a_tile: u64,
    /// Memory that this tile takes, bytes.
    pub memory_bytes: u64,
    /// Disk that balls take, bytes.
    pub disk_bytes: u64,
}

impl Plan {
    /// Points that a tile reads, about.
    fn window_points(&self, area: &MapArea) -> f64 {
        let share = |block: &SurveyBlock| {
            let own = block_area(block.at);
            let side = |axis: usize| (area.high[axis].min(own.high[axis]) - area.low[axis].max(own.low[axis])).max(0.0);
            side(0) * side(1) / (CELL * CELL) * block.points as f64
        };
        self.blocks_in(area).map(share).sum()
    }

    /// What the run will take, about.
    #[must_use]
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "estimates; `as` saturates")]
    pub fn estimate(&self) -> RunEstimate {
        let windows: Vec<f64> = self.tiles.iter().map(|&tile| self.window_points(&self.window(tile))).collect();
        let max = windows.iter().copied().fold(0.0, f64::max);
        let points: u64 = self.blocks.iter().map(|block| block.points).sum();
        RunEstimate {
            points,
            points_with_buffer: windows.iter().sum::<f64>() as u64,
            max_points_of_a_tile: max as u64,
            memory_bytes: memory_of(max) as u64,
            disk_bytes: (points as f64 * DISK_PER_POINT) as u64,
        }
    }

    /// Most balls that are tested together: as many as take no more memory than making those of the largest tile.
    pub(crate) fn balls_at_a_time(&self) -> usize {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an estimate; `as` saturates")]
        let balls = ((self.estimate().memory_bytes as f64 - MIN_BYTES) / BYTES_PER_BALL) as usize;
        balls.max(MIN_BALLS)
    }
}

fn memory_of(points: f64) -> f64 {
    MIN_BYTES + points * BYTES_PER_POINT
}
