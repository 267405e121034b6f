//! A raster of the highest points (DSM): what viewshed and shadow tools of GIS packages work on.

mod fill;
mod grid;

use crate::lines_of_sight::{check_clearance, check_positive, sight};
use crate::mesh_rays::{MeshRays, MeshRaysParams};
use belvedere::cast::{to_f32, to_index};
use belvedere::query::{Sight, Viewer, Visibility};
use belvedere::raster::Raster;
use belvedere::ray_index::Ray;
use belvedere::view::MAX_PIXEL_COUNT;
use belvedere::{Error, Mesh, Parameter, Result};
use grid::HeightGrid;
use rayon::prelude::*;

pub use fill::GapFill;

/// How the surface runs between the middles of the cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DsmSurface {
    /// Each cell is a column with a flat top.
    Columns,
    /// The height is interpolated bilinearly between the middles of four cells, as GDAL, GRASS and WhiteboxTools do
    /// along lines of sight.
    Bilinear,
}

/// How a [`Dsm`] is made and traced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DsmParams {
    /// Side of a cell, metres, above 0. Default 0.25: half of what GIS users take, but on a simulated town of 11
    /// points/m² (seed 7, not one that is reported) it is right for 94.5 % of sunlit and shaded pedestrian points where
    /// 0.5 m is for 92.9 %, and for 94.6 instead of 91.1 % on facades (balanced). Gaps, filled from below, keep streets
    /// open.
    pub cell: f64,
    /// How cells without points get a height. Default from below, which the same town found as good as the mean, and
    /// better on facades by half a percent.
    pub gap_fill: GapFill,
    /// How the surface runs between the cells. Default columns: in the same town 0.6 % better for pedestrians and 4 %
    /// on roofs, and an eye in a street sees out of its column, whereas bilinear slopes bury it.
    pub relief: DsmSurface,
    /// The surface blocks only farther than this from the target, metres, 0 or more. Columns that hold the target or
    /// the eye never block whatever the clearance, since the tools take the heights of both as given. Default 1: of
    /// 0.25 to 2 in the same town, where roofs and facades (0.1 m off the surface) are wrong least often together.
    pub clearance: f64,
}

impl Default for DsmParams {
    fn default() -> Self {
        Self { cell: 0.25, gap_fill: GapFill::Lowest, relief: DsmSurface::Columns, clearance: 1.0 }
    }
}

/// A height field that blocks all below it.
///
/// A target under the surface (below a crown, a deck or an eave) is in the solid, hence blocked unless it leaves it
/// within the clearance, or among columns the one it is in. An eye under the surface sees nothing, but for what is as
/// near.
pub struct Dsm {
    grid: HeightGrid,
    params: DsmParams,
}

impl Dsm {
    /// The highest of `positions`, (N, 3) local metres, in each cell. Positions that are not finite are left out.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a parameter out of its range or a raster of more than 2³⁰ cells.
    pub fn from_points(positions: &[[f32; 3]], params: &DsmParams) -> Result<Self> {
        let (low, high) = positions.iter().filter(|p| p.iter().all(|v| v.is_finite())).fold(
            ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]),
            |(low, high), p| {
                let at = [f64::from(p[0]), f64::from(p[1])];
                ([low[0].min(at[0]), low[1].min(at[1])], [high[0].max(at[0]), high[1].max(at[1])])
            },
        );
        let (corner, [width, height]) = layout(low, high, params)?;
        let mut heights = vec![f32::NAN; width * height];
        for position in positions.iter().filter(|p| p.iter().all(|v| v.is_finite())) {
            let [column, row] = [0, 1].map(|axis| to_index((f64::from(position[axis]) - corner[axis]) / params.cell));
            if let Some(cell) = heights.get_mut(row.min(height - 1) * width + column.min(width - 1)) {
                *cell = cell.max(position[2]);
            }
        }
        Self::from_heights(corner, width, heights, params)
    }

    /// The highest surface of `mesh`, metres of its reference system, at the middle of each cell, for local positions
    /// relative to `origin`: what a perfect survey could give a raster, and so an upper bound.
    ///
    /// # Errors
    /// As [`Dsm::from_points`].
    pub fn from_mesh(mesh: &Mesh, origin: [f64; 3], params: &DsmParams) -> Result<Self> {
        let rays = MeshRays::new(mesh, origin, &MeshRaysParams::default())?;
        let [low, high] = rays.bounds().unwrap_or([[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]]);
        let (corner, [width, height]) = layout([low[0], low[1]], [high[0], high[1]], params)?;
        let mut heights = vec![f32::NAN; width * height];
        heights.par_chunks_mut(width).enumerate().for_each(|(row, heights)| {
            for (column, height) in heights.iter_mut().enumerate() {
                let [x, y] = [(0, column), (1, row)].map(|(axis, i)| corner[axis] + (i as f64 + 0.5) * params.cell);
                // from a metre above the highest vertex
                let top = high[2] + 1.0;
                let hit =
                    Ray::new([x, y, top], [0.0, 0.0, -1.0], [0.0, f64::INFINITY]).and_then(|ray| rays.first(&ray));
                if let Some((range, _)) = hit {
                    *height = to_f32(top - range);
                }
            }
        });
        Self::from_heights(corner, width, heights, params)
    }

    fn from_heights(corner: [f64; 2], width: usize, mut heights: Vec<f32>, params: &DsmParams) -> Result<Self> {
        fill::fill(&mut heights, width, params.gap_fill);
        let raster = Raster::from_values(width, heights.len() / width, heights)?;
        Ok(Self { grid: HeightGrid::new(raster, corner, params.cell, params.relief), params: *params })
    }

    /// Heights, local metres, gaps filled; row 0 is the southernmost, NaN where no height could be found. The lower
    /// left corner of the first cell is at [`Dsm::corner`].
    #[must_use]
    pub fn heights(&self) -> &Raster<f32> {
        self.grid.heights()
    }

    /// Local east and north of the south-western corner of the raster, metres.
    #[must_use]
    pub fn corner(&self) -> [f64; 2] {
        self.grid.corner()
    }

    /// Whether the surface lies above some part of `ray` within its ranges, which count from the target.
    #[must_use]
    pub fn blocks(&self, ray: &Ray) -> bool {
        self.grid.blocks(ray)
    }
}

impl Visibility for Dsm {
    fn seen_from<'a>(&'a self, viewer: Viewer<'a>) -> Result<Sight<'a>> {
        sight(viewer, self.params.clearance, |ray| self.blocks(ray))
    }
}

/// South-western corner, a multiple of the cell, and columns and rows of the raster that holds a rectangle.
fn layout(low: [f64; 2], high: [f64; 2], params: &DsmParams) -> Result<([f64; 2], [usize; 2])> {
    check_positive("cell of the raster", params.cell)?;
    check_clearance(params.clearance)?;
    if !(low[0] <= high[0] && low[1] <= high[1]) {
        // nothing to hold: one cell without a height
        return Ok(([0.0; 2], [1; 2]));
    }
    let corner = low.map(|v| (v / params.cell).floor() * params.cell);
    let size = [0, 1].map(|axis| ((high[axis] - corner[axis]) / params.cell).floor() + 1.0);
    if !(size[0] * size[1] <= MAX_PIXEL_COUNT as f64) {
        return Err(Error::InvalidParameter {
            parameter: Parameter::Raster,
            value: format!("{} x {} cells", size[0], size[1]),
            expected: "at most 268435456 cells; take larger cells",
        });
    }
    Ok((corner, size.map(to_index)))
}
