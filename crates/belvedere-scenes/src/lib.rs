//! Simulated towns with exact meshes, and simulated laser scans of them.
//!
//! Tests and demonstrations need scenes whose answers are known. This crate makes a town out of triangles ([`town`], from a
//! description or a [`Preset`]) or a scene with a formula ([`closed_forms`]), generalises it to the blocks of a city model
//! ([`blocks`]), answers exactly what blocks what in it ([`Truth`]), and flies a laser scanner over it
//! ([`scan_airborne`]). It knows no other crate of the project: what comes out are plain columns and meshes.
//!
//! ```
//! use belvedere_scenes::{AirborneParams, TownParams, Truth, scan_airborne, town};
//!
//! let scene = town(&TownParams::default());
//! let scan = scan_airborne(&scene, &AirborneParams { pulses_per_m2: 0.5, ..AirborneParams::default() });
//! let truth = Truth::new(&scene);
//! let to_sun = [0.5, -0.5, 0.4];
//! let shaded = truth.occluded_towards_each(&scan.exact_positions, to_sun);
//! assert_eq!(shaded.len(), scan.len());
//! ```
//!
//! Coordinates are absolute everywhere: metres, f64, x east, y north, z up, in a projected frame such as the Dutch
//! national grid. Everything follows from the parameters alone, seeds included, with the same bits for any number of
//! threads; between platforms the last bits may differ where the mathematical library does.

mod airborne;
mod beam;
mod buildings;
mod cityjson;
pub mod closed_forms;
mod flight;
mod given_model;
mod lod1;
mod obj;
mod open_blocks;
mod plain_blocks;
mod plan;
mod preset;
mod queries;
mod random;
mod recording;
mod row_blocks;
mod scan;
mod scan_pattern;
mod scene;
mod site;
mod solids;
mod stations;
mod street_furniture;
mod streets;
mod terrain;
mod terrestrial;
mod town;
mod trees;
mod truth;
mod vector;

pub use airborne::{AirborneParams, scan_airborne};
pub use beam::BeamParams;
pub use lod1::blocks;
pub use preset::Preset;
pub use queries::{QuerySet, QuerySite, Targets};
pub use scan::{Scan, ScanReport, SensorPath};
pub use scan_pattern::{MirrorMotion, ScanPattern};
pub use scene::{Material, Part, Scene};
pub use solids::{Placement, extruded, l_shaped_ridged, ridged};
pub use terrain::Terrain;
pub use terrestrial::{Stations, TerrestrialParams, scan_terrestrial};
pub use town::{BlockPlan, StreetTrees, TownParams, town};
pub use trees::Crowns;
pub use truth::{CONTACT, Hit, Truth};
