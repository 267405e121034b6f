//! Pulses as columns of numbers: the pieces of lines that they prove empty.

use crate::cast::to_row;
use crate::frame::{FARTHEST, is_near};
use crate::{Error, Parameter, Result};
use rayon::prelude::*;

/// Ways that a pulse may go: along three axes, to both sides.
const WAYS: u8 = 6;

/// Empty piece of each pulse before its first return, and pieces between its returns, one per row. A row has 16 bytes
/// if all are upright and reach the same height, up to 21 otherwise.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FreeSegmentColumns {
    /// Ends at the first returns, (P, 3), local metres.
    pub starts: Vec<[f32; 3]>,
    /// The way that a pulse gets on most towards the scanner, (P): 0 up, 1 east, 2 north, 3 down, 4 west, 5 south;
    /// empty where all go up.
    pub ways: Vec<u8>,
    /// Shift to the east and to the north for each metre of height, in steps of 0.0001, (P, 2). Pulses that go east or
    /// west have the shift to the north and up, those that go north or south the shift up and to the east, for each
    /// metre of that direction.
    pub slopes: Vec<[i16; 2]>,
    /// Lengths, (P), metres, infinite for a pulse that reaches `top`; empty where all do.
    pub lengths: Vec<f32>,
    /// Height that no pulse rises above, local metres.
    pub top: f32,
}

impl FreeSegmentColumns {
    /// Adds the rows of `other`, which rises no higher.
    pub fn append(&mut self, mut other: Self) {
        let [own, added] = [self.starts.len(), other.starts.len()];
        let has_lengths = !self.lengths.is_empty() || !other.lengths.is_empty();
        let has_ways = !self.ways.is_empty() || !other.ways.is_empty();
        for (columns, count) in [(&mut *self, own), (&mut other, added)] {
            if has_lengths && columns.lengths.is_empty() {
                columns.lengths = vec![f32::INFINITY; count];
            }
            if has_ways && columns.ways.is_empty() {
                columns.ways = vec![0; count];
            }
        }
        self.starts.append(&mut other.starts);
        self.slopes.append(&mut other.slopes);
        self.lengths.append(&mut other.lengths);
        self.ways.append(&mut other.ways);
    }

    /// Sorts the rows by their numbers. Pulses that were joined from tiles then have one order.
    #[must_use]
    pub fn in_order(self) -> Self {
        let key = |row: u32| {
            let row = row as usize;
            let start = self.starts.get(row).map(|start| start.map(f32::to_bits));
            let length = self.lengths.get(row).map(|length| length.to_bits());
            (start, self.slopes.get(row), length, self.ways.get(row))
        };
        let mut rows: Vec<u32> = (0..to_row(self.starts.len())).collect();
        // those of one tile of a survey are sorted already
        if rows.is_sorted_by(|&a, &b| key(a) <= key(b)) {
            return self;
        }
        rows.par_sort_by(|&a, &b| key(a).cmp(&key(b)));
        self.select(&rows)
    }

    /// The rows of these numbers, in their order.
    #[must_use]
    pub fn select(&self, rows: &[u32]) -> Self {
        fn of<T: Copy>(column: &[T], rows: &[u32]) -> Vec<T> {
            if column.is_empty() {
                return Vec::new();
            }
            rows.iter().filter_map(|&row| column.get(row as usize).copied()).collect()
        }
        Self {
            starts: of(&self.starts, rows),
            ways: of(&self.ways, rows),
            slopes: of(&self.slopes, rows),
            lengths: of(&self.lengths, rows),
            top: self.top,
        }
    }

    /// Checks that columns are equally long and all positions within [`FARTHEST`], lengths (which may be infinite)
    /// above zero.
    ///
    /// # Errors
    /// [`Error::LengthMismatch`] or [`Error::InvalidParameter`] for the first fault.
    pub fn validate(&self) -> Result<()> {
        let expected = self.starts.len();
        let (slopes, lengths, ways) = (self.slopes.len(), self.lengths.len(), self.ways.len());
        for (what, found, may_be_empty) in
            [("slopes of pulses", slopes, false), ("lengths of pulses", lengths, true), ("ways of pulses", ways, true)]
        {
            if found != expected && !(found == 0 && may_be_empty) {
                return Err(Error::LengthMismatch { what, expected, found });
            }
        }
        let invalid = |parameter, value: String, expected| Err(Error::invalid(parameter, value, expected));
        if let Some(start) = self.starts.iter().find(|start| !is_near(**start)) {
            return invalid(Parameter::Pulse, format!("from {start:?} on"), "within 10000 km of the origin");
        }
        if let Some(way) = self.ways.iter().find(|way| **way >= WAYS) {
            return invalid(Parameter::Pulse, format!("of way {way}"), "of way 0 to 5");
        }
        if let Some(length) = self.lengths.iter().find(|length| !(**length > 0.0)) {
            return invalid(Parameter::Pulse, format!("of length {length}"), "of length above zero");
        }
        if !(self.top.abs() <= FARTHEST) {
            return invalid(Parameter::Pulse, format!("up to {}", self.top), "within 10000 km of the origin");
        }
        Ok(())
    }
}
