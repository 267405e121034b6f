//! Cells of a tile on the ground, or on top of present and planned objects.

use crate::answer::ground_cells::{EDGE_CELLS, GroundSquares, ground_cells};
use crate::build::cleared::{ClassedPoint, ClearedSurface, classed};
use crate::grid::{MapArea, TileId};
use crate::plan::Plan;
use crate::plan::side_files::Others;
use crate::plan::window;
use belvedere::apps::targets::{TargetLayout, Targets};
use belvedere::cast::{to_f32, to_f32s};
use belvedere::clean::clean;
use belvedere::control::Control;
use belvedere::ground::{Ground, MapGrid, SurfaceParams, top_surface};
use belvedere::query::BlockingTriangles;
use belvedere::raster::Raster;
use belvedere::{PointCloud, Result};
use std::sync::Arc;

/// Surfaces that answers share, for one tile and for neighbouring tiles.
#[derive(Default)]
pub(crate) struct SharedSurfaces {
    /// Surface of the last answer for the tile; the next answer may have the same cells.
    last: Option<TileSurface>,
    ground: GroundSquares,
}

impl SharedSurfaces {
    /// Removes the surface of the last tile.
    pub(crate) fn next_tile(&mut self) {
        self.last = None;
    }

    /// Returns the cells of a tile, with sides in metres.
    ///
    /// # Errors
    /// Those of reading the files.
    pub(crate) fn of_tile(
        &mut self,
        plan: &Plan,
        (tile, cell): (TileId, f64),
        others: &Others,
        control: &Control<'_>,
    ) -> Result<&TileSurface> {
        let surface = match self.last.take().filter(|last| last.cell == cell) {
            Some(surface) => surface,
            None => TileSurface::new(plan, (tile, cell), &mut self.ground, others, control)?,
        };
        Ok(self.last.insert(surface))
    }
}

/// Cells of a tile on the ground, or on top of present and planned objects.
pub(crate) struct TileSurface {
    /// Side of a cell, metres.
    cell: f64,
    /// Number of points read for the surface.
    pub(crate) points: usize,
    /// Number of cells on the ground under a cover, which are no targets.
    pub(crate) covered: usize,
    pub(crate) targets: Arc<Targets>,
}

/// Returns the area of the points that the cells of a tile need.
fn area_of_cells(plan: &Plan, tile: TileId, cell: f64) -> MapArea {
    let farthest = f64::from(plan.statistics.farthest()) + plan.statistics.isolation_radius.unwrap_or(0.0);
    plan.grid().core(tile).widened(farthest + (EDGE_CELLS + 1) as f64 * cell)
}

impl TileSurface {
    fn new(
        plan: &Plan,
        (tile, cell): (TileId, f64),
        ground: &mut GroundSquares,
        others: &Others,
        control: &Control<'_>,
    ) -> Result<Self> {
        if plan.is_on_ground() {
            let (targets, [covered, points]) =
                ground_cells(plan, (tile, cell), ground, others.added.as_ref(), control)?;
            return Ok(Self { cell, points, covered, targets: Arc::new(targets) });
        }
        let cloud = control.stage("reading", 0, || window::read(plan, &area_of_cells(plan, tile, cell), control))?;
        let added = others.added.as_ref();
        let targets =
            control.stage("computing top surface", 0, || cells(plan, (tile, cell), &cloud, added, control))?;
        Ok(Self { cell, points: cloud.len(), covered: 0, targets: Arc::new(targets) })
    }
}

/// Returns the cells of a tile, with sides in metres, as targets on top of present and planned objects.
fn cells(
    plan: &Plan,
    (tile, cell): (TileId, f64),
    cloud: &PointCloud,
    added: Option<&BlockingTriangles>,
    control: &Control<'_>,
) -> Result<Targets> {
    let (kept, _) = clean(cloud, &plan.statistics.cleaning(&plan.model().clean), control)?;
    let core = plan.grid().core(tile);
    let grid = plan.cells_of_tile(tile, cell);
    let count = grid.width;
    let places = (0..count).flat_map(|row| (0..count).map(move |column| (column, row)));
    let middles: Vec<[f64; 2]> = places.clone().map(|(column, row)| grid.center(column, row)).collect();
    let points = classed(cloud, kept.iter().map(|&row| row as usize));
    let areas = (&area_of_cells(plan, tile, cell), &core);
    let cleared = ClearedSurface::new(plan, areas, &points, &middles, control)?;
    let stays = |(point, is_cleared): (&ClassedPoint, &bool)| (!is_cleared).then_some(point.0);
    let positions: Vec<[f32; 3]> = points.iter().zip(&cleared.is_cleared).filter_map(stays).collect();
    let edge = EDGE_CELLS as f64 * cell;
    let wide = MapGrid {
        corner: [core.low[0] - edge, core.high[1] + edge],
        cell,
        width: count + 2 * EDGE_CELLS,
        height: count + 2 * EDGE_CELLS,
    };
    let unknown = Raster::filled(wide.width, wide.height, f32::NAN);
    let flat = Ground { grid: wide, heights: unknown.clone(), gaps: unknown };
    let params = SurfaceParams { farthest: plan.statistics.farthest(), ..SurfaceParams::default() };
    let heights = top_surface(&positions, &flat, &params, control)?;
    let of_cell =
        |(column, row): (usize, usize)| heights.get(column + EDGE_CELLS, row + EDGE_CELLS).unwrap_or(f32::NAN);
    let mut heights = Raster::from_values(count, count, places.clone().map(of_cell).collect())?;
    for (place, height) in cleared.ground {
        if let Some(value) = heights.values_mut().get_mut(place).filter(|value| value.is_nan()) {
            *value = to_f32(height);
        }
    }
    if let Some(added) = added {
        added.raise(&mut heights, &grid);
    }
    let survey = plan.area();
    let position = |(column, row): (usize, usize)| {
        let [x, y] = grid.center(column, row);
        // cells beside the survey have no value, as in one model
        if !MapArea::at([x, y, 0.0]).widened(cell / 2.0).meets(&survey) {
            return [f32::NAN; 3];
        }
        let z = f64::from(heights.get(column, row).unwrap_or(f32::NAN)) + plan.targets.height;
        if z.is_finite() { to_f32s([x, y, z]) } else { [f32::NAN; 3] }
    };
    let positions = places.map(position).collect();
    let gaps = Raster::filled(count, count, f32::NAN);
    let layout = TargetLayout::Cells(Box::new(Ground { grid, heights, gaps }));
    Ok(Targets::at(cloud.frame.clone(), positions, None, layout))
}
