//! Planes, ridges, edges and walls of buildings: surfaces that are known better than the spacing of points.
//!
//! A roof is a plane with many points, so that it is known to a few millimetres. Pulses define its end as well as
//! points. A return on the plane lies within its edge; a pulse that passed the plane and ended below it lies outside.
//! Walls are searched below edges, where ten points are enough.
//!
//! Everything is found in blocks of 64 m of the reference system with their surroundings, in an order that follows from
//! positions only. A part of a survey therefore finds the same as the whole. Scans from the ground have no planes yet.
//!
//! # Source
//! This project's. Edges as lines between returns and pulses that passed: `docs/methods/planes.md`.

mod block;
mod boxes;
mod building_outlines;
mod building_surfaces;
mod cell_runs;
mod edges;
mod fit;
mod leaves;
mod likelihood;
mod line;
mod parapets;
mod patches;
mod regions;
mod ridges;
mod roof_planes;
mod samples;
mod sheets;
mod slabs;
mod steps;
#[cfg(test)]
mod tests;
mod walls;

pub use belvedere_data::building_outlines::{BuildingOutlines, Edge, Ridge, RoofPlane, Wall, median_sd};
pub use block::SurveyPoints;
pub use building_outlines::{PointOnSurface, Surface};
pub use building_surfaces::{BuildingSurfaces, PlaneParams, find};
pub use edges::EdgeParams;
pub use regions::{SurfaceRegions, cap};
pub use slabs::SlabParams;
pub use walls::WallParams;
