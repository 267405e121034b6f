//! Estimate of the points, memory and disk of a run.

use crate::grid::{CELL, MapArea, block_area};
use crate::plan::Plan;
use belvedere::cast::to_index;
use belvedere::model::SurveyBlock;
use serde::Serialize;

/// Memory for each point of a window while balls are made, and without any point, bytes, as measured in docs/scale.md.
const BYTES_PER_POINT: f64 = 450.0;
const MIN_BYTES: f64 = 100e6;
/// Memory for each ball in a test, bytes: 290 measured, with a margin for cells and their points.
const BYTES_PER_BALL: f64 = 450.0;
/// Minimum number of balls that are tested together; fewer would save little memory.
const MIN_BALLS: usize = 100_000;
/// Bytes of a ball file for each point of a tile.
const DISK_PER_POINT: f64 = 30.0;

/// Estimate for a plan.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct RunEstimate {
    /// Number of points of all tiles.
    pub points: u64,
    /// Number of points read, including those around tiles.
    #[serde(rename = "points_with_halo")]
    pub points_with_buffer: u64,
    /// Maximum number of points that one tile reads.
    #[serde(rename = "most_points_of_a_tile")]
    pub max_points_of_a_tile: u64,
    /// Memory for this tile, bytes.
    pub memory_bytes: u64,
    /// Disk space for balls, bytes.
    pub disk_bytes: u64,
}

impl Plan {
    /// Returns the approximate number of points that a tile reads.
    fn window_points(&self, area: &MapArea) -> f64 {
        let share = |block: &SurveyBlock| {
            let own = block_area(block.at);
            let side = |axis: usize| (area.high[axis].min(own.high[axis]) - area.low[axis].max(own.low[axis])).max(0.0);
            side(0) * side(1) / (CELL * CELL) * block.points as f64
        };
        self.blocks_in(area).map(share).sum()
    }

    /// Returns an estimate for the run.
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

    /// Returns an estimate of the memory for the points of an area, bytes.
    pub(crate) fn memory_for(&self, area: &MapArea) -> u64 {
        self.memory_at(area, [MIN_BYTES, BYTES_PER_POINT])
    }

    /// Returns the memory for the points of an area, bytes, of work that takes `least` without any point, and
    /// `of_point` for each.
    pub(crate) fn memory_at(&self, area: &MapArea, [least, of_point]: [f64; 2]) -> u64 {
        to_index(least + of_point * self.window_points(area)) as u64
    }

    /// Returns the maximum number of balls that are tested together. They take no more memory than making the balls of
    /// the largest tile.
    pub(crate) fn balls_at_a_time(&self) -> usize {
        to_index((self.estimate().memory_bytes as f64 - MIN_BYTES) / BYTES_PER_BALL).max(MIN_BALLS)
    }
}

fn memory_of(points: f64) -> f64 {
    MIN_BYTES + points * BYTES_PER_POINT
}
