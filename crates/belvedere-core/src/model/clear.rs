//! Clears an area of a model: removes its points, its balls, and patches that only they support, and closes the ground
//! below.

use super::SceneModel;
use super::cleared_area::ClearedArea;
use super::clearing::Clearing;
use crate::ground::MapGrid;
use crate::medial::MedialBalls;
use crate::neighbors::NeighborIndex;
use crate::planes::BuildingOutlines;
use crate::query::{BlockingTriangles, FreedSpace};
use belvedere_data::balls::LIMIT_TOUCH;
use belvedere_data::control::Control;
use belvedere_data::{Bounds, Error, ExtinctionVoxels, PointCloud, Result, SurfacePatches};
use rayon::prelude::*;
use serde::Serialize;
use std::collections::HashSet;
use std::sync::OnceLock;

/// Maximum number of columns in which space is freed: their side is doubled until they are no more.
const MAX_CELLS: f64 = 4e6;

/// Counts of points and balls that were cleared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct ClearReport {
    /// Points that are gone.
    pub points_cleared: usize,
    /// Balls that are gone.
    pub balls_cleared: usize,
    /// Balls beside the area that were cut to its edge.
    pub balls_cut: usize,
    /// Balls that close the ground.
    pub ground_balls_added: usize,
    /// Area of surface patches that is gone, m².
    pub patches_cleared_m2: f64,
}

impl SceneModel {
    /// Returns the model and its cloud, in its frame, without the objects in `area`: points above the ground, balls at
    /// them, and added meshes. Triangles of meshes go with their middle. Surface patches are cut at the edge of a
    /// polygon, and all go with the class of buildings. Balls beside a polygon that reach into it are cut to its edge,
    /// at the point that they touch. The ground below is closed with balls at the height interpolated from the ground
    /// around. Lines of sight through the freed space are proven free.
    ///
    /// Where nothing stands, nothing changes, bit by bit.
    ///
    /// # Errors
    /// - [`Error::NoPoints`] for a cloud without points.
    /// - [`Error::LengthMismatch`] for one that the model was not made from.
    /// - [`Error::InvalidParameter`] for an area beside the cloud and for the class of the ground.
    /// - Errors of [`Clearing::new`].
    pub fn without(
        mut self,
        area: &ClearedArea,
        cloud: &PointCloud,
        control: &Control<'_>,
    ) -> Result<(Self, PointCloud, ClearReport)> {
        let expected = self.balls().source.iter().max().map_or(0, |&row| row as usize + 1);
        if cloud.len() < expected {
            return Err(Error::LengthMismatch { what: "points of the model", expected, found: cloud.len() });
        }
        let mut report = ClearReport::default();
        self.clear_triangles(area, &mut report)?;
        let Some(grid) = grid_over(area, cloud)? else { return Ok((self, cloud.clone(), report)) };
        let clearing = Clearing::new(area, cloud, grid, control)?;
        let is_cleared: Vec<bool> =
            (0..cloud.len()).map(|row| clearing.clears(cloud.positions[row], cloud.attributes.class_of(row))).collect();
        report.points_cleared = is_cleared.iter().filter(|&&is_cleared| is_cleared).count();
        control.check()?;
        let rows: Vec<u32> =
            (0..).zip(&is_cleared).filter(|(_, is_cleared)| !**is_cleared).map(|(row, _)| row).collect();
        let mut kept = cloud.select(&rows);
        let cleared = cloud.positions.iter().zip(&is_cleared).filter(|(_, is_cleared)| **is_cleared);
        kept.cleared_places.extend(cleared.map(|(p, _)| [p[0], p[1]]));
        if report.points_cleared > 0 {
            self.clear_crowns(cloud, &is_cleared);
            self.clear_balls(cloud, &is_cleared, &clearing, &mut report);
            self.close_ground(cloud, &is_cleared, &clearing, &mut report, control)?;
            self.renumber(&rows, cloud.len());
            self.tree = None;
            self.normals =
                self.normals.map(|normals| rows.iter().filter_map(|&row| normals.get(row as usize).copied()).collect());
        }
        let (grid, tops) = clearing.into_columns();
        self.freed.extend(FreedSpace::new(grid, tops));
        Ok((self, kept, report))
    }

    /// Leaves out the triangles of meshes whose middles lie in a polygon, and cuts patches at its edge. Of classes,
    /// that of buildings takes all patches with it.
    fn clear_triangles(&mut self, area: &ClearedArea, report: &mut ClearReport) -> Result<()> {
        let left = match area {
            ClearedArea::Polygon(_) | ClearedArea::Polygons(_) => {
                let index = area.index();
                if let Some(triangles) = &self.triangles {
                    self.triangles = triangles.without(|[x, y, _]| index.holds([x, y]))?;
                }
                self.parts.outlines = std::mem::take(&mut self.parts.outlines).outside(&index);
                self.parts.patches.outside_polygons(&index)
            }
            ClearedArea::Class(SurfacePatches::CLASS) => {
                self.parts.outlines = BuildingOutlines::default();
                SurfacePatches::default()
            }
            ClearedArea::Class(_) => return Ok(()),
        };
        if left != self.parts.patches {
            report.patches_cleared_m2 = self.parts.patches.area_m2() - left.area_m2();
            self.triangles = BlockingTriangles::of_patches(&left, self.triangles.as_ref())?;
            self.parts.patches = left;
        }
        Ok(())
    }

    /// Leaves out the voxels of crowns at cleared points.
    fn clear_crowns(&mut self, cloud: &PointCloud, is_cleared: &[bool]) {
        let origin = self.frame().origin;
        let Some(voxels) = &mut self.parts.medium else { return };
        let voxels_of = |wanted: bool| -> HashSet<[i32; 3]> {
            let rows = cloud.positions.iter().zip(is_cleared).filter(|(_, cleared)| **cleared == wanted);
            rows.map(|(p, _)| ExtinctionVoxels::voxel_of(*p, origin)).collect()
        };
        let (cleared, kept) = (voxels_of(true), voxels_of(false));
        *voxels = voxels.without_cleared(&cleared, &kept);
        self.medium = OnceLock::new();
    }

    /// Leaves out the balls at points that are cleared, and cuts those that reach into the area of a polygon.
    fn clear_balls(&mut self, cloud: &PointCloud, is_cleared: &[bool], clearing: &Clearing, report: &mut ClearReport) {
        let balls = &self.parts.balls;
        let cut = |row: usize| -> Option<([f32; 3], f32)> {
            let (center, radius, source) = (balls.centers[row], balls.radii[row], balls.source[row] as usize);
            if is_cleared.get(source).copied().unwrap_or(false) {
                return None;
            }
            match cloud.positions.get(source) {
                Some(&point) => clearing.cut(center, radius, point),
                None => Some((center, radius)),
            }
        };
        let fates: Vec<Option<([f32; 3], f32)>> = (0..balls.len()).into_par_iter().map(cut).collect();
        let rows: Vec<usize> = (0..balls.len()).filter(|&row| fates[row].is_some()).collect();
        let mut left = balls.select(&rows);
        for (place, (center, radius)) in fates.into_iter().flatten().enumerate() {
            report.balls_cut += usize::from(radius < left.radii[place]);
            (left.centers[place], left.radii[place]) = (center, radius);
        }
        report.balls_cleared = balls.len() - rows.len();
        self.parts.balls = left;
        self.parts.transmission = of_rows(&self.parts.transmission, &rows);
        self.vegetation = of_rows(&self.vegetation, &rows);
    }

    /// Turns rows of the cloud before into those of the points that are left, `rows`.
    fn renumber(&mut self, rows: &[u32], count: usize) {
        let mut numbers = vec![LIMIT_TOUCH; count];
        for (number, &row) in (0_u32..).zip(rows) {
            numbers[row as usize] = number;
        }
        let MedialBalls { source, touch, .. } = &mut self.parts.balls;
        for row in source.iter_mut().chain(touch) {
            // neither a pulse nor nothing has a row
            *row = numbers.get(*row as usize).copied().unwrap_or(*row);
        }
    }

    /// Puts balls below the ground where no ground point is near. Their source is the nearest point of the ground,
    /// which stays when more is cleared.
    fn close_ground(
        &mut self,
        cloud: &PointCloud,
        is_cleared: &[bool],
        clearing: &Clearing,
        report: &mut ClearReport,
        control: &Control<'_>,
    ) -> Result<()> {
        let rows: Vec<usize> =
            clearing.ground_rows().iter().map(|&row| row as usize).filter(|&row| !is_cleared[row]).collect();
        let positions: Vec<[f32; 3]> = rows.iter().map(|&row| cloud.positions[row]).collect();
        let index = NeighborIndex::new(&positions, control)?;
        for (center, radius) in clearing.closing_balls() {
            let Some(near) = index.nearest_within(center, f32::INFINITY) else { continue };
            let Some(&source) = rows.get(near.index as usize) else { continue };
            self.parts.balls.push(source, center, radius, LIMIT_TOUCH);
            report.ground_balls_added += 1;
        }
        let count = self.parts.balls.len();
        if !self.parts.transmission.is_empty() {
            self.parts.transmission.resize(count, f32::NAN);
        }
        if !self.vegetation.is_empty() {
            self.vegetation.resize(count, false);
        }
        Ok(())
    }
}

/// The grid of columns over an area; `None` where the cloud has no point of the class.
fn grid_over(area: &ClearedArea, cloud: &PointCloud) -> Result<Option<MapGrid>> {
    let bounds = cloud.bounds().ok_or_else(|| Error::NoPoints { what: "clearing needs the cloud".to_owned() })?;
    let (low, high) = match (area.rectangle_on(&bounds, cloud.frame.origin)?, area) {
        (Some(rectangle), _) => rectangle,
        (None, ClearedArea::Polygon(_) | ClearedArea::Polygons(_)) => return Ok(None),
        (None, ClearedArea::Class(class)) => {
            let classes = cloud.attributes.classification.as_deref().unwrap_or_default();
            let of_class = cloud.positions.iter().zip(classes).filter(|(_, own)| *own == class).map(|(p, _)| *p);
            let Some(bounds) = Bounds::around(of_class) else { return Ok(None) };
            bounds.on_map()
        }
    };
    let (low, high) = (low.map(|v| v - Clearing::REACH), high.map(|v| v + Clearing::REACH));
    let mut cell = Clearing::CELL;
    while (high[0] - low[0]) * (high[1] - low[1]) > MAX_CELLS * cell * cell {
        cell *= 2.0;
    }
    MapGrid::covering(low, high, cell, [cloud.frame.origin[0], cloud.frame.origin[1]]).map(Some)
}

fn of_rows<T: Copy>(values: &[T], rows: &[usize]) -> Vec<T> {
    rows.iter().filter_map(|&row| values.get(row).copied()).collect()
}
