//! Laser pulses: which returns belong together, and where the scanner was.
//!
//! Groups returns into pulses and locates the scanner of each. The segment from the scanner to the first return of a
//! pulse is proven to be free; everything that uses this needs both steps. [`group`] puts the returns of each pulse
//! together. [`locate`] uses the best means that a cloud has:
//!
//! - poses or a trajectory ([`Means`]),
//! - pulses with several returns ([`SensorPositions`]),
//! - scan angles ([`ScanAngleParams`]),
//! - stations of tripods that the points show ([`FoundStation`]),
//! - the assumption that pulses fall straight down ([`vertical_pulses`]).

#[cfg(feature = "scanner-estimate")]
mod estimate;
#[cfg(not(feature = "scanner-estimate"))]
#[path = "not_estimated.rs"]
mod estimate;
mod flight_parts;
mod free_segments;
mod group;
mod line_path;
mod locate;
mod path_samples;
mod scanner_report;
mod sensor_positions;
mod time_offset;
mod vertical;

pub use flight_parts::{
    AngleVerdict, HeightOffset, PartVerdict, ScanAngleParams, ScanAnglePart, SensorEstimateParams, SensorPart,
};
pub use free_segments::{FreeSegmentColumns, FreeSegmentParams, FreeSegmentReport, FreeSegments, ends_of_pulse};
pub(crate) use free_segments::{GAP_M, come_from_the_ground, lower_ends};
pub use group::{PulseReport, Pulses, group};
pub(crate) use line_path::positions_on_paths;
pub use line_path::{FoundBy, LinePath, Stretch};
pub use locate::{LocateParams, Means, locate};
pub use path_samples::path_samples;
pub use scanner_report::{FlightLine, FoundStation, ScannerReport, TypicalFlight};
pub use sensor_positions::{SensorPositions, SensorReport};
pub use time_offset::TimeOffset;
pub(crate) use vertical::MIN_ASSUMED_SHARE;
pub use vertical::{VerticalParams, vertical_pulses};
