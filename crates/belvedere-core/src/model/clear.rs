//! Clears an area of a model: removes its points, its balls, and patches that only they support, and closes the ground
//! below.

use super::SceneModel;
use super::clearing::{Clearing, class_of};
use crate::ground::MapGrid;
use crate::medial::MedialBalls;
use crate::neighbors::NeighborIndex;
use crate::planes::BuildingOutlines;
use crate::query::{BlockingTriangles, FreedSpace};
use belvedere_data::balls::LIMIT_TOUCH;
use belvedere_data::cast::to_i64;
use belvedere_data::control::Control;
use belvedere_data::polygon::{PolygonIndex, simple_rings};
use belvedere_data::{Bounds, Error, ExtinctionVoxels, Parameter, PointCloud, Result, SurfacePatches};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, HashSet};
use std::sync::OnceLock;

/// ASPRS class of ground.
const GROUND: u8 = 2;
/// Maximum number of columns in which space is freed: their side is doubled until they are no more.
const MAX_CELLS: f64 = 4e6;

/// Side of the squares whose polygons are cleared together, metres: columns of the usual width over one are fewer than
/// [`MAX_CELLS`].
const AREA_SIDE: f64 = 256.0;

/// Corners of an outline and of its holes.
type Rings = Vec<Vec<[f64; 2]>>;

/// Area or class to clear.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ClearedArea {
    /// Everything above the ground inside rings, local metres in plan: an outline and its holes.
    Polygon(Vec<Vec<[f64; 2]>>),
    /// The same inside several polygons, as [`ClearedArea::of_polygons`] joins them.
    Polygons(Vec<Vec<Vec<[f64; 2]>>>),
    /// The points of a class, and the balls at them.
    Class(u8),
}

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
            (0..cloud.len()).map(|row| clearing.clears(cloud.positions[row], class_of(cloud, row))).collect();
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

impl ClearedArea {
    /// Areas that clear the objects in `polygons`, local metres on the map, each an outline and its holes. Those near
    /// each other are one area, so that many take hardly longer than one, and the columns over each area stay narrow.
    #[must_use]
    pub fn of_polygons(polygons: Vec<Vec<Vec<[f64; 2]>>>) -> Vec<Self> {
        let mut squares: BTreeMap<[i64; 2], Vec<Rings>> = BTreeMap::new();
        for rings in polygons {
            let corner = rings.iter().flatten().next().copied().unwrap_or_default();
            let square = corner.map(|v| to_i64((v / AREA_SIDE).floor()));
            squares.entry(square).or_default().push(rings);
        }
        let area = |mut polygons: Vec<Rings>| match polygons.pop() {
            Some(only) if polygons.is_empty() => Self::Polygon(only),
            last => Self::Polygons(polygons.into_iter().chain(last).collect()),
        };
        squares.into_values().map(area).collect()
    }

    /// Its polygons; none for a class.
    fn polygons(&self) -> &[Vec<Vec<[f64; 2]>>] {
        match self {
            Self::Polygon(rings) => std::slice::from_ref(rings),
            Self::Polygons(polygons) => polygons,
            Self::Class(_) => &[],
        }
    }

    /// The index of its polygons; an empty one for a class.
    #[must_use]
    pub fn index(&self) -> PolygonIndex {
        PolygonIndex::of_polygons(self.polygons().iter().map(Vec::as_slice))
    }

    /// The rectangle around polygons on the map, from their lowest to their highest corner, as far as it lies on
    /// `bounds`, local metres from `origin`; `None` for a class.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a polygon beside `bounds`, for one that is none, and for the class of the
    /// ground.
    pub fn rectangle_on(&self, bounds: &Bounds, origin: [f64; 3]) -> Result<Option<([f64; 2], [f64; 2])>> {
        let invalid = |value: String, expected| {
            Err(Error::InvalidParameter { parameter: Parameter::ClearedArea, value, expected })
        };
        match self {
            Self::Class(GROUND) => return invalid("class 2".to_owned(), "a class that stands on the ground"),
            Self::Class(_) => return Ok(None),
            Self::Polygon(_) | Self::Polygons(_) => {}
        }
        let (first, last) = bounds.on_map();
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for rings in self.polygons() {
            if rings.is_empty() {
                return invalid("0 corners".to_owned(), "a polygon: three corners or more in each ring");
            }
            simple_rings(rings).map_err(|fault| fault.refusal(Parameter::ClearedArea))?;
            let bound = |pick: fn(f64, f64) -> f64, start: f64| {
                [0, 1].map(|axis| rings.iter().flatten().map(|corner| corner[axis]).fold(start, pick))
            };
            let (own_low, own_high) = (bound(f64::min, f64::INFINITY), bound(f64::max, f64::NEG_INFINITY));
            if (0..2).any(|axis| own_low[axis] > last[axis] || own_high[axis] < first[axis]) {
                let [[x, y], [west, south], [east, north]] =
                    [own_low, first, last].map(|corner| [0, 1].map(|axis| corner[axis] + origin[axis]));
                return invalid(
                    format!(
                        "from x {x:.1}, y {y:.1} m on (the points reach from {west:.0}, {south:.0} to {east:.0}, {north:.0})"
                    ),
                    "on the cloud, in its coordinates",
                );
            }
            low = [0, 1].map(|axis| low[axis].min(own_low[axis]));
            high = [0, 1].map(|axis| high[axis].max(own_high[axis]));
        }
        let within = |axis: usize| (low[axis].max(first[axis]), high[axis].min(last[axis]));
        let (x, y) = (within(0), within(1));
        Ok(Some(([x.0, y.0], [x.1, y.1])))
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
