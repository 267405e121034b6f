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
mod edges;
mod fit;
mod likelihood;
mod line;
mod patches;
mod regions;
mod ridges;
mod roof_planes;
mod sheets;
mod slabs;
#[cfg(test)]
mod tests;
mod walls;

pub use belvedere_data::building_outlines::{BuildingOutlines, Edge, Ridge, RoofPlane, Wall, median_sd};
pub use regions::{SurfaceRegions, cap};
pub use slabs::SlabParams;

use belvedere_data::control::Control;
use belvedere_data::patches::{PatchKind, SurfacePatches};
use belvedere_data::vector::{dot, sub};
use belvedere_data::{Attributes, Result};
use block::{Block, blocks};
use likelihood::LikelihoodTable;
use rayon::prelude::*;
use roof_planes::Candidates;
use slabs::Sheets;

/// Side of the blocks in which surfaces are found, metres.
pub(crate) const BLOCK: f64 = 64.0;

/// Parameters of the surfaces of buildings. Measurements of neighbouring values: `docs/methods/planes.md`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneParams {
    /// Margin around a block within which points are used, metres. Default 8: 16 improves nothing.
    pub margin: f64,
    /// Minimum number of points on a plane of a roof. Default 12.
    pub min_points: usize,
    /// Required accuracy of edges.
    pub edges: EdgeParams,
    /// Parameters of walls.
    pub walls: WallParams,
    /// Parameters of slabs.
    pub slabs: SlabParams,
}

/// Required accuracy of edges of roofs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeParams {
    /// Maximum standard deviation of the position of a sure edge, one that cuts balls and ends patches, metres. Default
    /// 0.1: at five pulses per m² facades are falsely blocked a tenth more often with 0.08; at ten nothing changes.
    pub max_sd: f64,
    /// Maximum standard deviation of the mean of the middles along a sure edge, metres. Default 0.08.
    pub max_scatter: f64,
    /// Maximum standard deviation of the position of an edge below which walls are searched, in spacings of pulses,
    /// where that is more than `max_sd`. Default 0.35: at 2 pulses per m², 9 walls are found without it, and 199 at 10.
    pub max_sd_spacings: f64,
    /// The same of the mean of the middles. Default 0.28.
    pub max_scatter_spacings: f64,
}

/// Parameters of walls below edges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WallParams {
    /// Minimum number of points on a wall at `spacing` and closer. Default 8. Sparser pulses need fewer, in proportion
    /// to the number in a row along the wall.
    pub min_points: f64,
    /// The same for a wall that is closed between its points. Default 10.
    pub min_closed_points: f64,
    /// Spacing of pulses from which on fewer points are enough, metres. Default 0.32, of ten pulses per m².
    pub spacing: f64,
    /// Minimum number of points at any spacing. Default 4: at 2 pulses per m² facades are falsely visible in 5.4 %,
    /// instead of 7.3 with 8 and 10.
    pub fewest_points: f64,
    /// Minimum share of the points below an edge that lie on a wall, for it to be closed between its points. Default
    /// 0.5: fronts of stacked balconies have 0.3 to 0.4.
    pub min_share: f64,
    /// Maximum distance from its points at which a wall is closed, in spacings of pulses. Default 4.7, which is 1.5 m
    /// at ten pulses per m². With 1 m more is seen through walls, with 2 m arcades close.
    pub reach_spacings: f64,
}

impl PlaneParams {
    /// These for pulses of which only the returns are known: edges find walls, and cut nothing.
    #[must_use]
    pub(crate) fn for_assumed_pulses(self) -> Self {
        let edges = EdgeParams { max_sd: 0.0, max_scatter: 0.0, ..self.edges };
        Self { edges, ..self }
    }
}

impl Default for EdgeParams {
    fn default() -> Self {
        Self { max_sd: 0.1, max_scatter: 0.08, max_sd_spacings: 0.35, max_scatter_spacings: 0.28 }
    }
}

impl Default for WallParams {
    fn default() -> Self {
        Self {
            min_points: 8.0,
            min_closed_points: 10.0,
            spacing: 0.32,
            fewest_points: 4.0,
            min_share: 0.5,
            reach_spacings: 4.7,
        }
    }
}

impl WallParams {
    /// Number of points that a wall needs where pulses are `spacing` metres apart, of one that needs `full` at most.
    fn points_at(&self, full: f64, spacing: f64) -> usize {
        let wanted = (full * self.spacing / spacing).clamp(self.fewest_points.min(full), full).round();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to a small number")]
        let wanted = wanted as usize;
        wanted
    }
}

impl Default for PlaneParams {
    fn default() -> Self {
        Self {
            margin: 8.0,
            min_points: 12,
            edges: EdgeParams::default(),
            walls: WallParams::default(),
            slabs: SlabParams::default(),
        }
    }
}

/// The points that surfaces are found in. Columns have a row for each point.
#[derive(Clone, Copy)]
pub struct SurveyPoints<'a> {
    /// Measured positions, (N, 3) local metres.
    pub positions: &'a [[f32; 3]],
    /// The scanner at each point, (N, 3) local metres, NaN where unknown.
    pub scanner: &'a [[f32; 3]],
    /// Return numbers are used where present. Points of class 6 lie on buildings; where there are none, single returns
    /// of classes 0 and 1 may, if there are points of class 2 below them. Without classes nothing is found.
    pub attributes: &'a Attributes,
    /// Origin of the local positions in the reference system, metres.
    pub origin: [f64; 3],
}

/// A plane that points lie on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Surface {
    /// Row among [`BuildingOutlines::planes`].
    Roof(usize),
    /// Row among [`BuildingOutlines::walls`].
    Wall(usize),
}

/// A point that a plane of a roof or a wall was fitted to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PointOnSurface {
    /// Its row in the survey.
    pub row: u32,
    /// Surface of the point.
    pub surface: Surface,
}

/// Surfaces of buildings.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BuildingSurfaces {
    /// Planes, edges, ridges and walls.
    pub outlines: BuildingOutlines,
    /// Points on planes of roofs and on walls, each in the block that it lies in. Where two walls meet, a point may lie
    /// on both.
    pub points: Vec<PointOnSurface>,
    /// Triangles that close surfaces.
    pub patches: SurfacePatches,
    /// Slabs, in each block that they reach into.
    pub slabs: usize,
    /// Rows of the points on slabs, whose balls are not needed. A point may occur twice.
    pub slab_rows: Vec<u32>,
    /// Space before known surfaces.
    pub regions: SurfaceRegions,
}

impl BuildingSurfaces {
    /// Returns the distance of a place outside a surface, local metres; negative within the building, NaN for a surface
    /// that is not one of these.
    #[must_use]
    pub fn distance(&self, surface: Surface, place: [f64; 3]) -> f64 {
        match surface {
            Surface::Roof(row) => {
                self.outlines.planes.get(row).map_or(f64::NAN, |plane| dot(plane.normal, sub(place, plane.center)))
            }
            Surface::Wall(row) => self.outlines.walls.get(row).map_or(f64::NAN, |Wall { ends: [a, b], .. }| {
                let along = [b[0] - a[0], b[1] - a[1]];
                // the house lies to the left
                (along[1] * (place[0] - a[0]) - along[0] * (place[1] - a[1])) / along[0].hypot(along[1])
            }),
        }
    }

    /// Adds the surfaces of another block.
    fn append(&mut self, other: Self) {
        let outlines = &mut self.outlines;
        let (planes, edges, walls) = (outlines.planes.len(), outlines.edges.len(), outlines.walls.len());
        let moved = |surface| match surface {
            Surface::Roof(row) => Surface::Roof(row + planes),
            Surface::Wall(row) => Surface::Wall(row + walls),
        };
        let points = other.points.into_iter();
        self.points.extend(points.map(|point| PointOnSurface { surface: moved(point.surface), ..point }));
        let added = other.outlines;
        outlines.planes.extend(added.planes);
        outlines.edges.extend(added.edges.into_iter().map(|edge| Edge { plane: edge.plane + planes, ..edge }));
        let moved = |ridge: Ridge| Ridge { planes: ridge.planes.map(|plane| plane + planes), ..ridge };
        outlines.ridges.extend(added.ridges.into_iter().map(moved));
        outlines.walls.extend(added.walls.into_iter().map(|wall| Wall { edge: wall.edge + edges, ..wall }));
        self.patches.triangles.extend(other.patches.triangles);
        self.patches.kinds.extend(other.patches.kinds);
        self.regions.append(other.regions);
        self.slabs += other.slabs;
        self.slab_rows.extend(other.slab_rows);
    }
}

/// The surfaces of the buildings in a survey from the air.
///
/// # Errors
/// [`Error::LengthMismatch`](belvedere_data::Error::LengthMismatch) where columns differ in length;
/// [`Error::Cancelled`](belvedere_data::Error::Cancelled).
pub fn find(survey: &SurveyPoints<'_>, params: &PlaneParams, control: &Control<'_>) -> Result<BuildingSurfaces> {
    let blocks = blocks(survey, params, control)?;
    let found: Vec<Result<BuildingSurfaces>> = blocks
        .into_par_iter()
        .map(|block| of_block(&Block::new(survey, block, params.margin), params, control))
        .collect();
    let mut surfaces = BuildingSurfaces::default();
    for block in found {
        surfaces.append(block?);
    }
    Ok(surfaces)
}

/// Finds the surfaces of one block.
fn of_block(block: &Block, params: &PlaneParams, control: &Control<'_>) -> Result<BuildingSurfaces> {
    control.check()?;
    let roofs = roof_planes::find(block, Candidates::Buildings, params, control)?;
    let ridges = ridges::find(block, &roofs);
    let table = LikelihoodTable::new();
    let outlines: Vec<edges::Outline> =
        (0..roofs.planes.len()).map(|plane| edges::find(block, &roofs, &ridges, plane, params, &table)).collect();
    let walls = walls::find(block, &roofs, &outlines, &params.walls);
    let leaves = patches::roofs(block, &roofs, &ridges, &outlines);
    let mut found = BuildingSurfaces::default();
    patches::append_to(block, &roofs, &leaves, &walls, &params.walls, &mut found);
    sheets::append_to(block, &roofs, &outlines, &walls, &mut found);
    found.regions = regions::of_block(block, &roofs, &outlines, &walls, &leaves);
    block.append_to(&roofs, &ridges, &outlines, &walls, &mut found);
    // canopies and decks that have the class of buildings, or none, are closed as roofs already
    let mut are_slabs = slabs::find(block, &roofs, &params.slabs);
    for (plane, is_slab) in are_slabs.iter_mut().enumerate().filter(|(_, is_slab)| **is_slab) {
        let own: Vec<&walls::WallLine> = walls.iter().filter(|wall| wall.plane == plane).collect();
        *is_slab = own.is_empty() || !sheets::is_walled(&outlines[plane], &own);
    }
    slabs::append_to(block, (&roofs, &are_slabs), &leaves, Sheets::Underside, &params.slabs, &mut found);
    let others = roof_planes::find(block, Candidates::Slabs, params, control)?;
    let are_slabs = slabs::find(block, &others, &params.slabs);
    let outline_of = |plane: usize| match are_slabs[plane] {
        true => edges::find(block, &others, &[], plane, params, &table),
        false => edges::Outline::default(),
    };
    let outlines: Vec<edges::Outline> = (0..others.planes.len()).map(outline_of).collect();
    let leaves = patches::roofs(block, &others, &[], &outlines);
    slabs::append_to(block, (&others, &are_slabs), &leaves, Sheets::Both, &params.slabs, &mut found);
    Ok(found)
}
