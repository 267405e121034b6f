//! Visibility analysis directly on point clouds: no city model, no height raster in between.
//!
//! A scene is a union of medial balls (Peters, Ledoux & Biljecki 2015), cut with the space that laser pulses prove
//! empty. The balls block lines of sight. The answer for a place is visible, blocked, or unproven where no pulse saw
//! the space between.
//!
//! This program writes a raster of the shadow on a LAZ tile on a summer afternoon:
//!
//! ```no_run
//! use belvedere::prelude::*;
//! use std::sync::Arc;
//!
//! fn main() -> Result<()> {
//!     let control = Control::none();
//!     let options = ReadOptions::new().with_crs("EPSG:7415");
//!     let (cloud, _) = read_cloud(["tile.laz"], &options, &control)?;
//!     let (model, _) = SceneModel::build(&cloud, &ModelParams::default(), &control)?;
//!     let scene = Scene::new(model, Arc::new(cloud));
//!     let question = ShadowQuestion::of_times(vec!["2026-06-21T15:00".to_owned()]);
//!     let answers = ask(&scene, &question, &Places::Cells(GridCells::default()), &control)?;
//!     let bands: Vec<&Measure> = answers.measures.iter().collect();
//!     write_raster("shadow.tif".as_ref(), &answers.found.on.targets, &bands, &[])
//! }
//! ```
//!
//! All questions are structs of `apps::ask`, used in this way. Answers have values, warnings (`remarks`) and a few
//! sentences (`headline`).
//!
//! # Where to look
//!
//! | task | module |
//! |---|---|
//! | read and write clouds, meshes, rasters, tables, ball files | `io` |
//! | from a cloud to a scene; what Belvedere does by default | [`model`] |
//! | which lines of sight are free | [`query`] |
//! | questions: shadow, sun hours, sky view, viewsheds, cameras and all others | `apps::ask` |
//! | their computations one by one | `apps` |
//! | results of applications as files | `results` |
//! | sunlight of windows and gardens as a report | `sunlight_report` |
//! | scenes that were built before | `cache` |
//! | pictures and films | `figures` |
//! | progress and cancellation of long work | [`control`] |
//! | single stages, for research | [`clean`], [`normals`], [`pulses`], [`medial`], [`depth`] |
//!
//! # Features
//!
//! | feature | adds | default |
//! |---|---|---|
//! | `apps` | the applications | yes |
//! | `io` | file formats | yes |
//! | `figures` | pictures; needs `io` | yes |
//! | `cache` | scenes kept in a folder; needs `apps` and `npy` | yes |
//! | `gpu` | sky views, sun hours, irradiance and depth maps on a graphics processor, with the same answers | no |
//! | `las` `e57` `ply` `npy` `tiff` `gpkg` `shp` | single file formats; need `io` | yes |
//! | `scanner-estimate` | finding scanner positions; without it, clouds without count as scanned from above | yes |
//! | `crs` | the database of reference systems; without it, a system is carried, but not found by its code | yes |
//!
//! Without default features the crate builds balls and answers lines of sight for positions that the program has
//! itself.
//!
//! # Conventions
//!
//! Units are metres and radians. x is east, y north, z up. Positions are local f32 on an f64 origin ([`Frame`]). Every
//! result is the same, bit by bit, for any number of threads. The crate prints nothing and reads no environment; the
//! clock only for when a kept scene was used. Parameters are structs with defaults; those that may grow are
//! `#[non_exhaustive]` and have `with_…` methods.

#[cfg(feature = "apps")]
pub use belvedere_apps as apps;
pub use belvedere_core::{
    blocking, clean, depth, ground, medial, medium, model, neighbors, normals, planes, pulses, query, ray_index,
    strips, summary, triangle_tree,
};
pub use belvedere_data::{
    Attributes, Bounds, ElevationGrid, Error, ExtinctionVoxels, Frame, GpsTimeKind, Mesh, Parameter, PatchKind,
    PointCloud, Result, SurfacePatches, cloud,
};
pub use belvedere_data::{
    cast, contradiction, control, crs, elevation, error, frame, horizon, mesh, patches, polygon, random, raster,
    report, shown, sky_region, trajectory, vector, view, weather,
};
#[cfg(feature = "figures")]
pub use belvedere_figures as figures;
#[cfg(feature = "gpu")]
pub use belvedere_gpu as gpu;
#[cfg(feature = "io")]
pub use belvedere_io as io;
#[cfg(feature = "cache")]
pub mod cache;
#[cfg(all(feature = "apps", feature = "tiff"))]
pub mod results;
#[cfg(all(feature = "cache", feature = "figures"))]
pub mod sunlight_report;

/// Items that most programs need: `use belvedere::prelude::*`.
pub mod prelude {
    #[cfg(feature = "apps")]
    pub use crate::apps::ask::{GridCells, Places, Scene, ShadowQuestion, ask};
    #[cfg(feature = "apps")]
    pub use crate::apps::shadow::{ShadowSun, shadow};
    #[cfg(feature = "apps")]
    pub use crate::apps::sun::{Date, Site, Zone, parse_instant};
    #[cfg(feature = "apps")]
    pub use crate::apps::targets::{Measure, Targets};
    pub use crate::control::Control;
    pub use crate::crs::Crs;
    #[cfg(feature = "io")]
    pub use crate::io::{ReadOptions, read_balls, read_cloud, write_balls, write_cloud};
    pub use crate::model::{ModelParams, OrientBy, SceneModel};
    pub use crate::query::{Answer, UnprovenAs, Viewer, Visibility};
    #[cfg(all(feature = "apps", feature = "tiff"))]
    pub use crate::results::write_raster;
    pub use crate::{Attributes, Bounds, Error, Frame, Mesh, PointCloud, Result};
}
