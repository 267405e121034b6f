//! Pulses as columns of numbers: the pieces of lines that they prove empty.

use crate::model::{FARTHEST, is_near};
use crate::{Error, Result};

/// The empty piece of each pulse above its first return, one per row: 16 bytes each where all reach the same height, 20 otherwise.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NeedleColumns {
    /// Lower ends, (P, 3), local metres.
    pub starts: Vec<[f32; 3]>,
    /// Shift to the east and to the north for each metre of height, in steps of 0.0001, (P, 2).
    pub slopes: Vec<[i16; 2]>,
    /// Lengths, (P), metres, infinite for a pulse that reaches `top`; empty where all do.
    pub lengths: Vec<f32>,
    /// Height that no pulse rises above, local metres.
    pub top: f32,
}

impl NeedleColumns {
    /// Checks that columns are equally long and all positions within [`FARTHEST`], lengths (which may be infinite) above zero.
    ///
    /// # Errors
    /// [`Error::LengthMismatch`] or [`Error::InvalidParameter`] for the first fault.
    pub fn validate(&self) -> Result<()> {
        let expected = self.starts.len();
        for (what, found) in [("slopes of pulses", self.slopes.len()), ("lengths of pulses", self.lengths.len())] {
            if found != expected && !(found == 0 && what.starts_with("lengths")) {
                return Err(Error::LengthMismatch { what, expected, found });
            }
        }
        let invalid = |name, value: String, expected| Err(Error::InvalidParameter { name, value, expected });
        if let Some(start) = self.starts.iter().find(|start| !is_near(**start)) {
            return invalid("lower end of a pulse", format!("{start:?}"), "within 10000 km of the origin");
        }
        if let Some(length) = self.lengths.iter().find(|length| !(**length > 0.0)) {
            return invalid("length of a pulse", length.to_string(), "above zero");
        }
        if !(self.top.abs() <= FARTHEST) {
            return invalid("top of all pulses", self.top.to_string(), "within 10000 km of the origin");
        }
        Ok(())
    }
}
