//! Laser pulses: which returns belong together, and where the scanner was.
//!
//! The way from the scanner to the first return of a pulse is proven to be free. Everything that uses this needs the two
//! things found here: [`group`] puts the returns of each pulse together, [`SensorPositions`] says where it came from.

mod group;
mod needles;
mod sensor_estimate;
mod sensor_fit;

pub use group::{PulseReport, Pulses, group};
pub use needles::{NeedleColumns, NeedleParams, NeedleReport, Needles};
pub use sensor_estimate::{SensorEstimateParams, SensorPart, SensorPositions, SensorReport, Verdict};
