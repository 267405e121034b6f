//! Cells of a grid over a scene.

use super::context::Context;
use super::scene::Scene;
use crate::targets::{CellLevel, CellParams, TargetLayout, Targets};
use crate::viewshed::cell_for;
use belvedere_core::ground::{Ground, GroundPoints, MapGrid};
use belvedere_data::Result;
use belvedere_data::control::Control;
use belvedere_data::polygon::is_inside;

/// Cells of a grid over the scene.
#[derive(Clone, Debug, Default)]
pub struct GridCells {
    /// Side, metres; `None` for 0.5 m, doubled until there are at most 4 million cells.
    pub cell: Option<f64>,
    /// Level of the cells.
    pub level: CellLevel,
    /// Height of the target above that, metres; `None` for the default of [`CellParams`].
    pub height: Option<f64>,
    /// Source of ground points.
    pub ground: GroundPoints,
    /// South-west and north-east corner of the grid on the map, local metres; `None` for those of the scene.
    pub bounds: Option<([f64; 2], [f64; 2])>,
    /// Rings of an area on the map, local metres. Cells whose centre lies outside it are no targets. Empty for all
    /// cells.
    pub within: Vec<Vec<[f64; 2]>>,
}

/// Cells without those under a cover or inside added meshes.
pub(super) fn cells_of(
    scene: &Scene,
    ground: Ground,
    params: &CellParams,
    context: &mut Context,
    control: &Control<'_>,
) -> Result<Targets> {
    let name = if params.level == CellLevel::Surface { "finding the surface" } else { "finding hidden ground" };
    let cloud = &*scene.points_over(&ground.grid, control)?;
    let (mut targets, report) = control.stage(name, 0, || Targets::of_cells(cloud, ground, params, control))?;
    let mut under_cover = report.cells_below_objects_excluded;
    if let Some(added) = scene.model().added() {
        under_cover += targets.set_on_added(added, params);
    }
    if params.level == CellLevel::Ground {
        context.report.places.cells_under_cover_left_out = Some(under_cover);
    }
    Ok(targets)
}

impl GridCells {
    /// The grid of these cells, over all of a scene unless they have bounds.
    ///
    /// # Errors
    /// Those of [`MapGrid::covering`].
    pub fn grid(&self, scene: &Scene) -> Result<MapGrid> {
        self.grid_over(scene, self.bounds.unwrap_or_else(|| scene.model().bounds().on_map()))
    }

    /// The grid of these cells over the box from `low` to `high`, local metres.
    ///
    /// # Errors
    /// Those of [`MapGrid::covering`].
    pub fn grid_over(&self, scene: &Scene, (low, high): ([f64; 2], [f64; 2])) -> Result<MapGrid> {
        let [x, y, _] = scene.frame().origin;
        MapGrid::covering(low, high, self.cell.unwrap_or_else(|| cell_for(low, high)), [x, y])
    }

    pub(super) fn targets(&self, scene: &Scene, context: &mut Context, control: &Control<'_>) -> Result<Targets> {
        let known = scene.ground(self.grid(scene)?, self.ground, control)?;
        context.ground(scene.frame(), &known);
        let mut params = CellParams::default().with_level(self.level);
        if let Some(height) = self.height {
            params = params.with_height(height);
        }
        let mut targets = cells_of(scene, known.ground.clone(), &params, context, control)?;
        self.keep_within(&mut targets);
        Ok(targets)
    }

    /// Leaves out cells beside the area.
    fn keep_within(&self, targets: &mut Targets) {
        let TargetLayout::Cells(ground) = &targets.layout else { return };
        if self.within.is_empty() {
            return;
        }
        let (grid, width) = (ground.grid, ground.grid.width.max(1));
        for (cell, position) in targets.positions.iter_mut().enumerate() {
            if !is_inside(&self.within, grid.center(cell % width, cell / width)) {
                *position = [f32::NAN; 3];
            }
        }
    }
}
