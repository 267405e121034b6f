//! Visibility analysis directly on point clouds.
//!
//! A scene is modelled as a union of medial balls (Peters, Ledoux & Biljecki 2015); the balls block lines of sight, a
//! depth map or exact rays answer what is visible.

pub mod clean;
pub mod cloud;
pub mod crs;
pub mod depth;
pub mod error;
pub mod io;
pub mod medial;
pub mod mesh;
pub mod neighbors;
pub mod normals;
pub mod progress;
pub mod query;
pub mod random;
pub mod raster;
pub mod summary;
pub mod trajectory;
mod vector;
pub mod view;

pub use cloud::{Attributes, GpsTimeKind, PointCloud};
pub use error::{Error, Result};
pub use mesh::Mesh;
