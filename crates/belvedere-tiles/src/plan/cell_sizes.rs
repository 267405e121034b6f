//! Sides of the cells of results: one for all, with finer or coarser exceptions for single results.

use crate::plan::question::{TileQuestion, Topic};
use belvedere::{Error, Parameter, Result};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Step of the side of a cell, metres. With whole numbers of it, middles of cells are exact numbers.
const CELL_STEP: f64 = 1.0 / 64.0;
/// Maximum side of a cell, metres.
const LARGEST: f64 = 64.0;
/// Minimum and maximum side of a tile, metres.
pub(crate) const MIN_TILE: f64 = 16.0;
const LARGEST_TILE: f64 = 8192.0;

/// Sides of the cells of results, metres: whole numbers of sixty-fourths up to 64.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CellSizes {
    usual: f64,
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    others: BTreeMap<Topic, f64>,
}

impl Default for CellSizes {
    /// Returns sides of 1 m for all results.
    fn default() -> Self {
        Self::all(1.0)
    }
}

impl CellSizes {
    /// Returns one side for all results.
    #[must_use]
    pub fn all(side: f64) -> Self {
        Self { usual: side, others: BTreeMap::new() }
    }

    /// Returns these sides with another side for results on `topic`.
    #[must_use]
    pub fn with(mut self, topic: Topic, side: f64) -> Self {
        self.others.insert(topic, side);
        self
    }

    /// Returns the side for the result of a question.
    #[must_use]
    pub fn of(&self, question: &TileQuestion) -> f64 {
        self.others.get(&question.topic()).copied().unwrap_or(self.usual)
    }

    /// Returns all sides.
    pub(crate) fn sides(&self) -> impl Iterator<Item = f64> {
        std::iter::once(self.usual).chain(self.others.values().copied())
    }

    pub(crate) fn largest(&self) -> f64 {
        self.sides().fold(0.0, f64::max)
    }

    /// Returns true if a tile of this side is a whole number of cells, for all sides of cells.
    pub(crate) fn divide(&self, tile_size: f64) -> bool {
        self.sides().map(|side| tile_size / side).all(|cells| cells == cells.floor())
    }

    /// Checks the sides and the side of a tile that they divide.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a side out of range, and for a tile that is no whole number of cells.
    pub(crate) fn check_tile(&self, tile_size: f64) -> Result<()> {
        self.check()?;
        if (MIN_TILE..=LARGEST_TILE).contains(&tile_size) && self.divide(tile_size) {
            return Ok(());
        }
        let (value, expected) = (format!("{tile_size} m"), "16 to 8192 m, and a whole number of cells");
        Err(Error::invalid(Parameter::TileSize, value, expected))
    }

    /// Checks the range of the sides.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a side out of range.
    pub(crate) fn check(&self) -> Result<()> {
        let check = |parameter, side: f64| {
            let steps = side / CELL_STEP;
            if steps >= 1.0 && steps == steps.floor() && side <= LARGEST {
                return Ok(());
            }
            let expected = "a whole number of sixty-fourths of a metre up to 64, such as 0.25, 0.5, 1 or 2";
            Err(Error::invalid(parameter, format!("{side} m"), expected))
        };
        check(Parameter::Cell, self.usual)?;
        self.others.values().try_for_each(|&side| check(Parameter::CellOfResult, side))
    }
}
