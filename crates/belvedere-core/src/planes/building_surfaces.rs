//! Surfaces of the buildings of a survey, block by block.

use super::block::{Block, SurveyPoints, blocks};
use super::building_outlines::{self, PointOnSurface, Surface};
use super::edges::{self, EdgeParams, Outline};
use super::leaves::{self, LeafParams};
use super::likelihood::LikelihoodTable;
use super::patches::Patch;
use super::regions::{self, RegionParams, SurfaceRegions};
use super::ridges::{self, RidgeLine, RidgeParams};
use super::roof_planes::{self, Candidates, RoofParams, Roofs};
use super::sheets::{self, SheetParams};
use super::slabs::{self, Sheets, SlabParams, Slabs};
use super::walls::{self, WallLine, WallParams};
use belvedere_data::Result;
use belvedere_data::building_outlines::{BuildingOutlines, Edge, Ridge, Wall};
use belvedere_data::control::Control;
use belvedere_data::patches::SurfacePatches;
use belvedere_data::vector::{dot, sub};
use rayon::prelude::*;

/// Parameters of the surfaces of buildings. Measurements of neighbouring values: `docs/methods/planes.md`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneParams {
    /// Margin around a block within which points are used, metres. Default 8: 16 improves nothing.
    pub margin: f64,
    /// Minimum number of points on a plane of a roof. Default 12.
    pub min_points: usize,
    /// Parameters of edges.
    pub edges: EdgeParams,
    /// Parameters of walls.
    pub walls: WallParams,
    /// Parameters of slabs.
    pub slabs: SlabParams,
    /// Parameters of the planes of roofs.
    pub(super) roofs: RoofParams,
    /// Parameters of ridges.
    pub(super) ridges: RidgeParams,
    /// Parameters of the pieces of roofs.
    pub(super) leaves: LeafParams,
    /// Parameters of upright sheets.
    pub(super) sheets: SheetParams,
    /// Parameters of the space before surfaces.
    pub(super) regions: RegionParams,
}

impl PlaneParams {
    /// These for pulses of which only the returns are known: edges find walls, and cut nothing.
    #[must_use]
    pub(crate) fn for_assumed_pulses(self) -> Self {
        let edges = EdgeParams { max_sd: 0.0, max_scatter: 0.0, ..self.edges };
        Self { edges, ..self }
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
            roofs: RoofParams::default(),
            ridges: RidgeParams::default(),
            leaves: LeafParams::default(),
            sheets: SheetParams::default(),
            regions: RegionParams::default(),
        }
    }
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

    /// Adds triangles.
    fn add_patches(&mut self, patches: impl IntoIterator<Item = Patch>) {
        patches.into_iter().for_each(|(corners, kind)| self.patches.push(corners, kind));
    }

    /// Adds slabs of the block.
    fn add_slabs(&mut self, slabs: Slabs) {
        self.add_patches(slabs.patches);
        self.slabs += slabs.count;
        self.slab_rows.extend(slabs.rows);
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
        self.add_patches(other.patches.iter().map(|(corners, kind)| (*corners, kind)));
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
    let blocks = blocks(survey, params.margin, control)?;
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
    let roofs = roof_planes::find(block, Candidates::Buildings, params.min_points, &params.roofs, control)?;
    let ridges = ridges::find(&roofs, &params.ridges);
    let table = LikelihoodTable::new(&params.edges.likelihood);
    let outline_of = |roofs: &Roofs, ridges: &[RidgeLine], plane: usize| {
        edges::find(block, roofs, ridges, plane, &params.edges, &table)
    };
    let outlines: Vec<Outline> = (0..roofs.planes.len()).map(|plane| outline_of(&roofs, &ridges, plane)).collect();
    let walls = walls::find(block, &roofs, &outlines, &params.walls);
    let leaves = leaves::find(&roofs, &ridges, &outlines, &params.leaves);
    let mut found = BuildingSurfaces::default();
    (found.outlines, found.points) = building_outlines::of_block(block, &roofs, &ridges, &outlines, &walls);
    found.regions = regions::of_block(block, &roofs, &outlines, &walls, &leaves, &params.regions);
    found.add_patches(leaves::patches(block, &roofs, &leaves));
    found.add_patches(walls::patches(block, &roofs, &walls, &params.walls));
    let parapets = &params.edges.parapets;
    found.add_patches(sheets::patches(block, &roofs, &outlines, &walls, &params.sheets, parapets));
    // canopies and decks that have the class of buildings, or none, are closed as roofs already
    let mut are_slabs = slabs::find(block, &roofs, &params.slabs);
    for (plane, is_slab) in are_slabs.iter_mut().enumerate().filter(|(_, is_slab)| **is_slab) {
        let own: Vec<&WallLine> = walls.iter().filter(|wall| wall.plane == plane).collect();
        *is_slab = own.is_empty() || !sheets::is_walled(&outlines[plane], &own, &params.sheets.inside);
    }
    found.add_slabs(slabs::close(block, &roofs, &are_slabs, &leaves, Sheets::Underside, &params.slabs));
    let candidates = Candidates::Slabs { max_noise: params.slabs.max_noise };
    let others = roof_planes::find(block, candidates, params.min_points, &params.roofs, control)?;
    let are_slabs = slabs::find(block, &others, &params.slabs);
    let outlines: Vec<Outline> = are_slabs
        .iter()
        .enumerate()
        .map(|(plane, is_slab)| if *is_slab { outline_of(&others, &[], plane) } else { Outline::default() })
        .collect();
    let leaves = leaves::find(&others, &[], &outlines, &params.leaves);
    found.add_slabs(slabs::close(block, &others, &are_slabs, &leaves, Sheets::Both, &params.slabs));
    Ok(found)
}
