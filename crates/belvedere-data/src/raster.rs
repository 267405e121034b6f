//! Grids of values, row 0 at the top.

use crate::{Error, Result};

/// A grid of `height` x `width` values, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Raster<T> {
    width: usize,
    values: Vec<T>,
}

impl<T: Copy> Raster<T> {
    /// A grid filled with `value`.
    #[must_use]
    pub fn filled(width: usize, height: usize, value: T) -> Self {
        Self { width, values: vec![value; width * height] }
    }

    /// A grid from its values, row by row from the top.
    ///
    /// # Errors
    /// [`Error::LengthMismatch`] unless there are `width * height` values.
    pub fn from_values(width: usize, height: usize, values: Vec<T>) -> Result<Self> {
        if values.len() != width * height {
            return Err(Error::LengthMismatch { what: "raster", expected: width * height, found: values.len() });
        }
        Ok(Self { width, values })
    }

    /// Number of columns.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Number of rows.
    #[must_use]
    pub fn height(&self) -> usize {
        self.values.len().checked_div(self.width).unwrap_or(0)
    }

    /// All values, row by row from the top.
    #[must_use]
    pub fn values(&self) -> &[T] {
        &self.values
    }

    /// All values, to be changed.
    pub fn values_mut(&mut self) -> &mut [T] {
        &mut self.values
    }

    /// Value at a column and a row, or `None` outside.
    #[must_use]
    pub fn get(&self, column: usize, row: usize) -> Option<T> {
        if column < self.width { self.values.get(row * self.width + column).copied() } else { None }
    }
}
