//! Estimates scanner positions from returns alone, by least squares over parts of flight lines.

mod from_angles;
mod from_returns;
mod height_offset;
mod sensor_fit;
mod smoother;
mod stations;

pub(super) use from_angles::paths_from_angles;
pub(super) use from_returns::paths_from_returns;
pub(super) use height_offset::height_offset;
pub(super) use stations::stations_of_tripods;

/// True: this build estimates scanner positions.
pub(super) const IS_BUILT: bool = true;
