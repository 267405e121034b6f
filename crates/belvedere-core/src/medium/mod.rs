//! Crowns as a medium that takes a share of the light: extinction in voxels, measured by pulses, and what it takes of
//! lines.
//!
//! The transmission of a line is exp(−τ), its optical depth τ the integral of the extinction along it.

mod blocks;
mod estimate;
mod index;
mod walk;

pub use belvedere_data::medium::{ExtinctionVoxels, MAX_EXTINCTION, VOXEL_SIDE};
pub use estimate::{MediumParams, PlantReturn, PlantReturns, estimate};
pub use index::Medium;

/// Optical depth at which half of the light passes: deeper, a line counts as blocked where a yes or no is wanted.
pub const HALF_DEPTH: f64 = std::f64::consts::LN_2;
