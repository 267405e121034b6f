//! Plain data that all of Belvedere shares: point clouds, reference systems, meshes, medial balls, rasters, views,
//! errors, progress.
//!
//! Users add the crate `belvedere`, which holds everything here under the same names.

pub mod balls;
pub mod building_outlines;
pub mod cast;
pub mod cloud;
pub mod contradiction;
pub mod control;
pub mod crs;
pub mod elevation;
pub mod error;
pub mod frame;
pub mod free_segments;
pub mod horizon;
pub mod medium;
pub mod mesh;
pub mod model;
pub mod parameter;
pub mod patches;
pub mod polygon;
pub mod random;
pub mod raster;
pub mod report;
pub mod result_columns;
mod setters;
pub mod shown;
pub mod sky_region;
pub mod trajectory;
pub mod vector;
pub mod view;
pub mod weather;

pub use cloud::{Attributes, CloudFile, CloudFiles, FileRows, GpsTimeKind, PointCloud};
pub use elevation::ElevationGrid;
pub use error::{Error, Result};
pub use frame::{Bounds, Frame};
pub use medium::ExtinctionVoxels;
pub use mesh::Mesh;
pub use parameter::Parameter;
pub use patches::{PatchKind, SurfacePatches};
