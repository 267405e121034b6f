//! What stands in an area now is gone: its points, its balls, and what only they supported; the ground below is closed.

use super::SceneModel;
use crate::ground::{Ground, GroundParams, GroundPoints, MapGrid, ground_points};
use crate::medial::MedialBalls;
use crate::neighbors::NeighborIndex;
use crate::query::FreedSpace;
use belvedere_data::balls::LIMIT_TOUCH;
use belvedere_data::control::Control;
use belvedere_data::polygon::is_inside;
use belvedere_data::raster::Raster;
use belvedere_data::vector::{sub, unit};
use belvedere_data::{Bounds, Error, PointCloud, Result};
use rayon::prelude::*;
use serde::Serialize;

/// ASPRS class of ground.
const GROUND: u8 = 2;
/// Height above the ground up to which a point or a ball belongs to it, metres: that up to which points are taken for ground where none are
/// classed.
const ABOVE_GROUND: f64 = 0.3;
/// Side of the columns in which space is freed, metres, doubled until they are no more than [`MOST_CELLS`].
const CELL: f64 = 0.25;
const MOST_CELLS: f64 = 4e6;
/// Distance on the map from a point that is cleared up to which its column is, metres: across gaps between points on roofs and in crowns.
const AROUND: f64 = 2.0;
/// The same where points of a class are cleared, which may stand close to others.
const AROUND_OF_CLASS: f64 = 1.0;
/// Distance to the next ground point from which the ground is closed with balls, metres: beyond what ground points hold themselves.
const GAP: f32 = 0.7;
/// Radius of balls that close the ground, metres, and how far they lie apart: their tops are up to 0.03 m below the ground between them.
const GROUND_RADIUS: f64 = 1.0;
const GROUND_STEP: f64 = 0.35;
/// Smallest radius to which a ball is cut that reaches into the area, metres; smaller ones are cleared.
const LEAST_RADIUS: f64 = 0.05;
/// Halvings that find the radius of such a ball: to a thousandth of its radius.
const HALVINGS: usize = 10;

/// What is cleared.
#[derive(Clone, Debug, PartialEq)]
pub enum ClearedArea {
    /// What stands above the ground inside rings, local metres on the map: an outline and its holes.
    Polygon(Vec<Vec<[f64; 2]>>),
    /// The points of a class, and the balls at them.
    Class(u8),
}

/// What was cleared.
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
}

impl SceneModel {
    /// The model and its cloud, in its frame, without what stands in `area` now: points above the ground, balls at them, and meshes that were added, of
    /// which triangles go with their middle. Balls beside a polygon that reach into it are cut to its edge, at the point that they are
    /// tangent at. The ground below is closed with balls at the height interpolated from the ground around. Lines of sight through the
    /// space that was freed are proven free.
    ///
    /// Where nothing stands, nothing changes, bit by bit.
    ///
    /// # Errors
    /// [`Error::NoPoints`] for a cloud without points, [`Error::LengthMismatch`] for one that the model was not made from,
    /// [`Error::InvalidParameter`] for an area beside the cloud and for the class of the ground, those of [`Ground::of_cloud`].
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
        if let (Some(added), ClearedArea::Polygon(rings)) = (&self.added, area) {
            self.added = added.without(|[x, y, _]| is_inside(rings, [x, y]))?;
        }
        let Some(grid) = grid_over(area, cloud)? else { return Ok((self, cloud.clone(), report)) };
        let params = GroundParams::default();
        let (ground_rows, from) = ground_points(cloud, &params, control)?;
        let points: Vec<[f32; 3]> = ground_rows.iter().map(|&row| cloud.positions[row as usize]).collect();
        let ground = Ground::of_points(&points, grid, params.reach, control)?;
        let mut is_cleared: Vec<bool> = (0..cloud.len()).map(|row| belongs(area, cloud, row, &ground)).collect();
        let tops = tops(area, cloud, &is_cleared, &ground.grid);
        if let (ClearedArea::Polygon(_), GroundPoints::Classed) = (area, from) {
            clear_low_points(cloud, &ground_rows, &ground.grid, &tops, &mut is_cleared);
        }
        report.points_cleared = is_cleared.iter().filter(|&&is_cleared| is_cleared).count();
        let columns = Columns { ground: &ground, tops: &tops };
        control.check()?;
        let rows: Vec<u32> =
            (0..).zip(&is_cleared).filter(|(_, is_cleared)| !**is_cleared).map(|(row, _)| row).collect();
        let kept = cloud.select(&rows);
        if report.points_cleared > 0 {
            self.clear_balls(area, cloud, &is_cleared, &columns, &mut report);
            self.renumber(&rows, cloud.len());
            self.close_ground(&kept, &columns, &mut report, control)?;
            self.tree = None;
            self.normals =
                self.normals.map(|normals| rows.iter().filter_map(|&row| normals.get(row as usize).copied()).collect());
        }
        self.freed.extend(FreedSpace::new(ground.grid, tops));
        Ok((self, kept, report))
    }

    /// Leaves out the balls at points that are cleared, and cuts those that reach into the area of a polygon.
    fn clear_balls(
        &mut self,
        area: &ClearedArea,
        cloud: &PointCloud,
        is_cleared: &[bool],
        columns: &Columns<'_>,
        report: &mut ClearReport,
    ) {
        let balls = &self.parts.balls;
        let cut = |row: usize| -> Option<([f32; 3], f32)> {
            let (center, radius, source) = (balls.centers[row], balls.radii[row], balls.source[row] as usize);
            if is_cleared.get(source).copied().unwrap_or(false) {
                return None;
            }
            match (area, cloud.positions.get(source)) {
                (ClearedArea::Polygon(_), Some(&point)) => columns.cut(center, radius, point),
                _ => Some((center, radius)),
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

    /// Puts balls below the ground where no ground point is near.
    fn close_ground(
        &mut self,
        cloud: &PointCloud,
        columns: &Columns<'_>,
        report: &mut ClearReport,
        control: &Control<'_>,
    ) -> Result<()> {
        let index = NeighborIndex::new(&cloud.positions, control)?;
        let grid = columns.ground.grid;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few cells")]
        let step = (GROUND_STEP / grid.cell).floor().max(1.0) as usize;
        for row in (0..grid.height).step_by(step) {
            for column in (0..grid.width).step_by(step) {
                let is_open = columns.ground.gaps.get(column, row).is_some_and(|gap| gap > GAP);
                let height = columns.ground.heights.get(column, row).map_or(f64::NAN, f64::from);
                if !is_open || columns.top(column, row).is_none() || !height.is_finite() {
                    continue;
                }
                let [x, y] = grid.center(column, row);
                #[expect(clippy::cast_possible_truncation, reason = "balls are f32")]
                let (center, radius) = ([x, y, height - GROUND_RADIUS].map(|v| v as f32), GROUND_RADIUS as f32);
                let Some(near) = index.nearest_within(center, f32::INFINITY) else { continue };
                self.parts.balls.push(near.index as usize, center, radius, LIMIT_TOUCH);
                report.ground_balls_added += 1;
            }
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

/// The columns that are cleared.
struct Columns<'a> {
    ground: &'a Ground,
    /// Height of what stood there, NaN where nothing did.
    tops: &'a Raster<f32>,
}

impl Columns<'_> {
    fn top(&self, column: usize, row: usize) -> Option<f64> {
        self.tops.get(column, row).map(f64::from).filter(|top| top.is_finite())
    }

    /// The ball, made smaller at the point of the surface that it is tangent at until it does not reach into a column; `None` where it vanishes.
    fn cut(&self, center: [f32; 3], radius: f32, point: [f32; 3]) -> Option<([f32; 3], f32)> {
        let (middle, whole) = (center.map(f64::from), f64::from(radius));
        if !self.reaches_in(middle, whole) {
            return Some((center, radius));
        }
        let inward = unit(sub(middle, point.map(f64::from)))?;
        let tangent: [f64; 3] = std::array::from_fn(|i| middle[i] - whole * inward[i]);
        let center_of = |radius: f64| -> [f64; 3] { std::array::from_fn(|i| tangent[i] + radius * inward[i]) };
        let (mut free, mut too_large) = (0.0, whole);
        for _ in 0..HALVINGS {
            let radius = f64::midpoint(free, too_large);
            if self.reaches_in(center_of(radius), radius) { too_large = radius } else { free = radius }
        }
        #[expect(clippy::cast_possible_truncation, reason = "balls are f32")]
        (free >= LEAST_RADIUS).then(|| (center_of(free).map(|v| v as f32), free as f32))
    }

    /// Whether a ball reaches into the space above the ground over the middle of a cleared column.
    fn reaches_in(&self, center: [f64; 3], radius: f64) -> bool {
        let grid = &self.ground.grid;
        let place = [(center[0] - grid.corner[0]) / grid.cell, (grid.corner[1] - center[1]) / grid.cell];
        let reach = radius / grid.cell;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the grid")]
        let range = |axis: usize, count: usize| {
            let end = |value: f64| value.clamp(0.0, count as f64) as usize;
            end(place[axis] - reach)..end((place[axis] + reach).ceil())
        };
        range(1, grid.height).any(|row| {
            range(0, grid.width).any(|column| {
                let [x, y] = grid.center(column, row);
                let half_square = radius * radius - (x - center[0]).powi(2) - (y - center[1]).powi(2);
                let Some(top) = self.top(column, row).filter(|_| half_square > 0.0) else { return false };
                let ground = self.ground.heights.get(column, row).map_or(f64::NAN, f64::from);
                let half = half_square.sqrt();
                !(center[2] + half <= ground + ABOVE_GROUND) && center[2] - half < top
            })
        })
    }
}

/// The grid of columns over an area; `None` where the cloud has no point of the class.
fn grid_over(area: &ClearedArea, cloud: &PointCloud) -> Result<Option<MapGrid>> {
    let bounds = cloud.bounds().ok_or_else(|| Error::NoPoints { what: "clearing needs the cloud".to_owned() })?;
    let invalid = |value: String, expected| Err(Error::InvalidParameter { name: "area to clear", value, expected });
    let (low, high) = match area {
        ClearedArea::Class(GROUND) => return invalid("class 2".to_owned(), "a class that stands on the ground"),
        ClearedArea::Class(class) => {
            let classes = cloud.attributes.classification.as_deref().unwrap_or_default();
            let of_class = cloud.positions.iter().zip(classes).filter(|(_, own)| *own == class).map(|(p, _)| *p);
            let Some(bounds) = Bounds::around(of_class) else { return Ok(None) };
            bounds.on_map()
        }
        ClearedArea::Polygon(rings) => {
            let corners = || rings.iter().flatten();
            let bound =
                |axis: usize, pick: fn(f64, f64) -> f64, start: f64| corners().map(|c| c[axis]).fold(start, pick);
            let low = [0, 1].map(|axis| bound(axis, f64::min, f64::INFINITY));
            let high = [0, 1].map(|axis| bound(axis, f64::max, f64::NEG_INFINITY));
            let (first, last) = bounds.on_map();
            if corners().flatten().any(|v| !v.is_finite()) || rings.first().is_none_or(|ring| ring.len() < 3) {
                let corners = rings.first().map_or(0, Vec::len);
                return invalid(format!("{corners} corners"), "a polygon of at least 3 finite corners");
            }
            if (0..2).any(|axis| low[axis] > last[axis] || high[axis] < first[axis]) {
                let [x, y] = [0, 1].map(|axis| low[axis] + cloud.frame.origin[axis]);
                return invalid(format!("from x {x:.1}, y {y:.1} m on"), "on the cloud, in its coordinates");
            }
            let within = |axis: usize| (low[axis].max(first[axis]), high[axis].min(last[axis]));
            let (x, y) = (within(0), within(1));
            ([x.0, y.0], [x.1, y.1])
        }
    };
    let (low, high) = (low.map(|v| v - AROUND), high.map(|v| v + AROUND));
    let mut cell = CELL;
    while (high[0] - low[0]) * (high[1] - low[1]) > MOST_CELLS * cell * cell {
        cell *= 2.0;
    }
    MapGrid::covering(low, high, cell, [cloud.frame.origin[0], cloud.frame.origin[1]]).map(Some)
}

/// Whether a point is one of those that are cleared.
fn belongs(area: &ClearedArea, cloud: &PointCloud, row: usize, ground: &Ground) -> bool {
    let [x, y, z] = cloud.positions[row].map(f64::from);
    match area {
        ClearedArea::Class(class) => {
            cloud.attributes.classification.as_deref().and_then(|classes| classes.get(row)) == Some(class)
        }
        ClearedArea::Polygon(rings) => {
            ground.grid.cell_of([x, y]).is_some()
                && is_inside(rings, [x, y])
                && !ground.height_at([x, y]).is_some_and(|height| z <= height + ABOVE_GROUND)
        }
    }
}

/// Clears what is no ground in columns where something higher is cleared: the foot of a wall, and what stood below a roof.
fn clear_low_points(
    cloud: &PointCloud,
    ground_rows: &[u32],
    grid: &MapGrid,
    tops: &Raster<f32>,
    is_cleared: &mut [bool],
) {
    let mut is_ground = vec![false; cloud.len()];
    ground_rows.iter().for_each(|&row| is_ground[row as usize] = true);
    for ((position, is_cleared), _) in
        cloud.positions.iter().zip(is_cleared).zip(is_ground).filter(|(_, is_ground)| !is_ground)
    {
        let cell = grid.cell_of([f64::from(position[0]), f64::from(position[1])]);
        *is_cleared |= cell.and_then(|[column, row]| tops.get(column, row)).is_some_and(f32::is_finite);
    }
}

/// Height of what is cleared around the middle of each cell; NaN where nothing is.
fn tops(area: &ClearedArea, cloud: &PointCloud, is_cleared: &[bool], grid: &MapGrid) -> Raster<f32> {
    let mut tops = Raster::filled(grid.width, grid.height, f32::NAN);
    let around = if matches!(area, ClearedArea::Class(_)) { AROUND_OF_CLASS } else { AROUND };
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few cells")]
    let reach = (around / grid.cell) as usize;
    let mut highest = Raster::filled(grid.width, grid.height, f32::NEG_INFINITY);
    for (position, _) in cloud.positions.iter().zip(is_cleared).filter(|(_, is_cleared)| **is_cleared) {
        let cell = grid.cell_of([f64::from(position[0]), f64::from(position[1])]);
        if let Some([column, row]) = cell
            && let Some(highest) = highest.values_mut().get_mut(row * grid.width + column)
        {
            *highest = highest.max(position[2]);
        }
    }
    for row in 0..grid.height {
        for column in 0..grid.width {
            let Some(top) = highest.get(column, row).filter(|top| top.is_finite()) else { continue };
            for near_row in row.saturating_sub(reach)..(row + reach + 1).min(grid.height) {
                for near in column.saturating_sub(reach)..(column + reach + 1).min(grid.width) {
                    let is_in = match area {
                        ClearedArea::Class(_) => true,
                        ClearedArea::Polygon(rings) => is_inside(rings, grid.center(near, near_row)),
                    };
                    let is_near = near.abs_diff(column).pow(2) + near_row.abs_diff(row).pow(2) <= reach * reach;
                    if let Some(own) =
                        tops.values_mut().get_mut(near_row * grid.width + near).filter(|_| is_in && is_near)
                    {
                        *own = own.max(top);
                    }
                }
            }
        }
    }
    tops
}

fn of_rows<T: Copy>(values: &[T], rows: &[usize]) -> Vec<T> {
    rows.iter().filter_map(|&row| values.get(row).copied()).collect()
}
