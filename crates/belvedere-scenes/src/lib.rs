//! Simulated towns with exact meshes, and simulated laser scans of them.
//!
//! Tests and demonstrations need scenes with known answers. This crate makes a town of triangles ([`town`], from a
//! description or a [`Preset`]) or a scene with a formula ([`closed_forms`]). It generalises the scene to the blocks of
//! a city model ([`blocks`]) and computes exact visibility in it ([`Truth`]). It draws targets and observers for tests
//! ([`QuerySite`]). It scans the scene from the air ([`scan_airborne`]), from tripods ([`scan_terrestrial`]) or from a
//! car ([`scan_mobile`]). The crate depends on no other crate of the project; its outputs are plain columns and meshes.
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
//! national grid. All results depend only on the parameters, including seeds, with the same bits for any number of
//! threads. Between platforms the last bits may differ, because mathematical libraries do.

pub mod closed_forms;
mod formats;
mod given_model;
mod lod1;
mod queries;
mod random;
mod room;
mod scan;
mod scene;
mod solids;
mod town;
mod truth;
mod vector;

pub use lod1::blocks;
pub use queries::{QuerySet, QuerySite, TargetsOfKind};
pub use scan::airborne::scan_airborne;
pub use scan::beam::BeamParams;
pub use scan::flight::{AirborneParams, DENSITY};
pub use scan::mobile::{MobileParams, scan_mobile};
pub use scan::order::PointOrder;
pub use scan::regimes::Regime;
pub use scan::scan_grid::ScanGrid;
pub use scan::scan_pattern::{MirrorMotion, ScanPattern};
pub use scan::terrestrial::{Stations, TerrestrialParams, scan_terrestrial};
pub use scan::{Scan, ScanReport, SensorPath};
pub use scene::{Material, ObjectPart, TriangleScene};
pub use solids::{PlanPlacement, extruded, l_shaped_ridged, ridged};
pub use town::preset::{EXTENT, Preset};
pub use town::site::RoofDetails;
pub use town::terrain::Terrain;
pub use town::trees::CrownMaterial;
pub use town::{BlockPlan, StreetTrees, TownParams, town};
pub use truth::{CONTACT, Hit, Truth};
