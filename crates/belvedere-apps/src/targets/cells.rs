//! Cells of a grid on the ground, or on top of the objects on it.

use super::{TARGET_LIFT, TargetLayout, Targets};
use crate::viewshed::cell_targets;
use belvedere_core::ground::{Ground, GroundParams, MapGrid, SurfaceParams, hidden_ground, top_surface};
use belvedere_core::query::BlockingTriangles;
use belvedere_data::control::Control;
use belvedere_data::{Error, Parameter, PointCloud, Result};
use serde::{Deserialize, Serialize};

/// Level of cells: ground or surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum CellLevel {
    /// The ground. Default.
    #[default]
    Ground,
    /// The top surface: roofs, crowns, and the ground between.
    Surface,
}

/// Conversion of cells into targets.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct CellParams {
    /// Level of cells: ground or surface.
    pub level: CellLevel,
    /// Height of the target above that, metres. Default 0.1.
    pub height: f64,
}

belvedere_data::setters!(CellParams {
    with_level(level: CellLevel),
    with_height(height: f64),
});

impl Default for CellParams {
    fn default() -> Self {
        Self { level: CellLevel::Ground, height: TARGET_LIFT }
    }
}

/// Counts of cells that were left out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct CellReport {
    /// Cells on the ground under a roof or another cover, which are no targets.
    #[serde(rename = "cells_under_cover_left_out")]
    pub cells_below_objects_excluded: usize,
}

impl Targets {
    /// Cells of `cell` metres on the ground of `cloud`, over all of it, those under a cover left out.
    ///
    /// # Errors
    /// Those of [`MapGrid::covering`] and [`Ground::of_cloud`].
    pub fn ground_cells(cloud: &PointCloud, cell: f64) -> Result<Self> {
        let bounds =
            cloud.bounds().ok_or_else(|| Error::NoPoints { what: "cells need a cloud with points".to_owned() })?;
        let (low, high) = bounds.on_map();
        let [x, y, _] = cloud.frame.origin;
        let grid = MapGrid::covering(low, high, cell, [x, y])?;
        let (ground, _) = Ground::of_cloud(cloud, grid, &GroundParams::default(), &Control::none())?;
        Ok(Self::of_cells(cloud, ground, &CellParams::default(), &Control::none())?.0)
    }

    /// The cells of `ground`, whose heights come from `cloud`, in the frame of that cloud. Ground under a roof or
    /// another cover is left out.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a height that is negative or not finite, those of [`top_surface`], and
    /// [`Error::Cancelled`].
    pub fn of_cells(
        cloud: &PointCloud,
        mut ground: Ground,
        params: &CellParams,
        control: &Control<'_>,
    ) -> Result<(Self, CellReport)> {
        if !(params.height >= 0.0 && params.height.is_finite()) {
            return Err(Error::invalid(Parameter::HeightAboveGround, params.height, "0 metres or more"));
        }
        if params.level == CellLevel::Surface {
            ground.heights = control.stage("computing top surface", 0, || {
                top_surface(&cloud.positions, &ground, &SurfaceParams::default(), control)
            })?;
        }
        let mut positions = cell_targets(&ground, params.height);
        let mut report = CellReport::default();
        if params.level == CellLevel::Ground {
            let hidden = hidden_ground(&cloud.positions, &ground);
            for (position, _) in positions.iter_mut().zip(hidden).filter(|(_, is_hidden)| *is_hidden) {
                *position = [f32::NAN; 3];
                report.cells_below_objects_excluded += 1;
            }
        }
        Ok((Self::at(cloud.frame.clone(), positions, None, TargetLayout::Cells(Box::new(ground))), report))
    }

    /// Sets cells made with `params` on the meshes that were added: those on a surface on top of the higher of cloud
    /// and mesh. Cells on the ground inside a mesh are left out; returns how many.
    pub fn set_on_added(&mut self, added: &BlockingTriangles, params: &CellParams) -> usize {
        let TargetLayout::Cells(ground) = &mut self.layout else { return 0 };
        if params.level == CellLevel::Surface {
            let before = ground.heights.clone();
            added.raise(&mut ground.heights, &ground.grid);
            let heights = ground.heights.values().iter().zip(before.values());
            let on_added: Vec<bool> = heights.map(|(after, before)| after.to_bits() != before.to_bits()).collect();
            self.on_added = if on_added.contains(&true) { on_added } else { Vec::new() };
            self.positions = cell_targets(ground, params.height);
            return 0;
        }
        let mut left_out = 0;
        let is_inside =
            |position: &[f32; 3]| position.iter().all(|v| v.is_finite()) && added.encloses(position.map(f64::from));
        for position in self.positions.iter_mut().filter(|position| is_inside(position)) {
            *position = [f32::NAN; 3];
            left_out += 1;
        }
        left_out
    }
}
