//! Effect of clearing an area at a place: removes a point, cuts a ball, or closes the ground.

use super::cleared_area::ClearedArea;
use crate::ground::{Ground, GroundParams, GroundPoints, MapGrid, ground_points};
use belvedere_data::cast::to_index;
use belvedere_data::cloud::GROUND;
use belvedere_data::control::Control;
use belvedere_data::polygon::PolygonIndex;
use belvedere_data::raster::Raster;
use belvedere_data::vector::{sub, to_f32, unit};
use belvedere_data::{PointCloud, Result};

/// Height above the ground up to which a point or a ball belongs to it, metres: that up to which points are taken for
/// ground where none are classed.
const ABOVE_GROUND: f64 = 0.3;
/// Distance on the map from a point that is cleared up to which its column is, metres: across gaps between points on
/// roofs and in crowns.
const AROUND: f64 = 2.0;
/// The same distance for cleared points of a class, metres: these may stand close to other points.
const AROUND_OF_CLASS: f64 = 1.0;
/// Distance to the next ground point from which the ground is closed with balls, metres: beyond the radius that ground
/// points close themselves.
const GAP: f32 = 0.7;
/// Radius of balls that close the ground, metres, and how far they lie apart: their tops are up to 0.03 m below the
/// ground between them.
const GROUND_RADIUS: f64 = 1.0;
const GROUND_STEP: f64 = 0.35;
/// Smallest radius to which a ball is cut that reaches into the area, metres; smaller ones are cleared.
const MIN_RADIUS: f64 = 0.05;
/// Halvings that find the radius of such a ball: to a thousandth of its radius.
const HALVINGS: usize = 10;

/// An area that is cleared over the cells of a grid.
#[derive(Clone, Debug)]
pub struct Clearing {
    area: IndexedArea,
    ground: Ground,
    /// Rows of the cloud that are points of the ground.
    ground_rows: Vec<u32>,
    /// Height of the top of the removed objects, NaN in cells without one.
    tops: Raster<f32>,
    /// True if points below the cleared ones go too, unless their class is ground.
    clears_low: bool,
}

/// Area or class to clear, with an index of the sides of a polygon.
#[derive(Clone, Debug)]
enum IndexedArea {
    Polygon(PolygonIndex),
    Class(u8),
}

impl Clearing {
    /// Side of the columns in which space is freed, metres, where they are not made larger to have fewer.
    pub const CELL: f64 = 0.25;
    /// Maximum horizontal distance of the middle of a cleared column from a cleared point, metres.
    pub const REACH: f64 = AROUND;

    /// Prepares the clearing of `area` over `grid`. `cloud` holds all points around it, far enough for the ground to be
    /// known.
    ///
    /// # Errors
    /// Those of [`ground_points`], and of [`Ground::of_points`].
    pub fn new(area: &ClearedArea, cloud: &PointCloud, grid: MapGrid, control: &Control<'_>) -> Result<Self> {
        let params = GroundParams::default();
        let (rows, from) = ground_points(cloud, &params, control)?;
        let points: Vec<[f32; 3]> = rows.iter().filter_map(|&row| cloud.positions.get(row as usize).copied()).collect();
        let ground = Ground::of_points(&points, grid, params.reach, control)?;
        let clears_low = !matches!(area, ClearedArea::Class(_)) && from == GroundPoints::Classed;
        let nothing = Raster::filled(grid.width, grid.height, f32::NAN);
        let area = match area {
            ClearedArea::Polygon(_) | ClearedArea::Polygons(_) => IndexedArea::Polygon(area.index()),
            ClearedArea::Class(class) => IndexedArea::Class(*class),
        };
        let clearing = Self { area, ground, ground_rows: rows, tops: nothing, clears_low };
        let tops = clearing.tops_of(cloud);
        Ok(Self { tops, ..clearing })
    }

    /// Returns true if a point, local metres, is removed.
    #[must_use]
    pub fn clears(&self, position: [f32; 3], class: Option<u8>) -> bool {
        let [x, y, _] = position.map(f64::from);
        let is_below = || self.ground.grid.cell_of([x, y]).is_some_and(|[column, row]| self.top(column, row).is_some());
        self.stands_in(position, class) || (self.clears_low && class != Some(GROUND) && is_below())
    }

    /// Rows of the cloud that are points of the ground.
    pub(super) fn ground_rows(&self) -> &[u32] {
        &self.ground_rows
    }

    /// Height of the ground at a place of the map, local metres, where something is cleared there.
    #[must_use]
    pub fn ground_at(&self, place: [f64; 2]) -> Option<f64> {
        let [column, row] = self.ground.grid.cell_of(place)?;
        self.top(column, row)?;
        self.ground.height_at(place)
    }

    /// Returns a ball cut to the outside of a polygon: it shrinks, tangent to the surface at the same point, until it
    /// does not reach in. `None` where it vanishes. Beside points of a class balls stay.
    #[must_use]
    pub fn cut(&self, center: [f32; 3], radius: f32, point: [f32; 3]) -> Option<([f32; 3], f32)> {
        let (middle, whole) = (center.map(f64::from), f64::from(radius));
        if matches!(self.area, IndexedArea::Class(_)) || !self.reaches_in(middle, whole) {
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
        (free >= MIN_RADIUS).then(|| (center_of(free).map(to_f32), to_f32(free)))
    }

    /// Balls that close the ground where no ground point is near: centres and radii.
    pub fn closing_balls(&self) -> impl Iterator<Item = ([f32; 3], f32)> {
        let grid = self.ground.grid;
        let step = to_index((GROUND_STEP / grid.cell).floor().max(1.0));
        let places = (0..grid.height)
            .step_by(step)
            .flat_map(move |row| (0..grid.width).step_by(step).map(move |column| (column, row)));
        places.filter_map(move |(column, row)| {
            let is_open = self.ground.gaps.get(column, row).is_some_and(|gap| gap > GAP);
            let height = self.ground.heights.get(column, row).map_or(f64::NAN, f64::from);
            if !is_open || self.top(column, row).is_none() || !height.is_finite() {
                return None;
            }
            let [x, y] = grid.center(column, row);
            Some(([x, y, height - GROUND_RADIUS].map(to_f32), to_f32(GROUND_RADIUS)))
        })
    }

    /// The cells, and the height up to which each is cleared, NaN where it is not.
    #[must_use]
    pub fn into_columns(self) -> (MapGrid, Raster<f32>) {
        (self.ground.grid, self.tops)
    }

    fn top(&self, column: usize, row: usize) -> Option<f64> {
        self.tops.get(column, row).map(f64::from).filter(|top| top.is_finite())
    }

    /// Returns true if a point stands in the area.
    fn stands_in(&self, position: [f32; 3], class: Option<u8>) -> bool {
        let [x, y, z] = position.map(f64::from);
        match &self.area {
            IndexedArea::Class(own) => class == Some(*own),
            IndexedArea::Polygon(index) => {
                self.ground.grid.cell_of([x, y]).is_some()
                    && index.holds([x, y])
                    && !self.ground.height_at([x, y]).is_some_and(|height| z <= height + ABOVE_GROUND)
            }
        }
    }

    /// Returns true if a ball reaches into the space above the ground over the middle of a cleared column.
    fn reaches_in(&self, center: [f64; 3], radius: f64) -> bool {
        let grid = &self.ground.grid;
        let place = [(center[0] - grid.corner[0]) / grid.cell, (grid.corner[1] - center[1]) / grid.cell];
        let reach = radius / grid.cell;
        let range = |axis: usize, count: usize| {
            let end = |value: f64| to_index(value.clamp(0.0, count as f64));
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

    /// Height of the highest point of the area around the middle of each cell; NaN without one.
    fn tops_of(&self, cloud: &PointCloud) -> Raster<f32> {
        let grid = &self.ground.grid;
        let mut tops = Raster::filled(grid.width, grid.height, f32::NAN);
        let around = if matches!(self.area, IndexedArea::Class(_)) { AROUND_OF_CLASS } else { AROUND };
        let reach = to_index(around / grid.cell);
        let mut highest = Raster::filled(grid.width, grid.height, f32::NEG_INFINITY);
        let standing =
            (0..cloud.len()).filter(|&row| self.stands_in(cloud.positions[row], cloud.attributes.class_of(row)));
        for position in standing.map(|row| cloud.positions[row]) {
            let cell = grid.cell_of([f64::from(position[0]), f64::from(position[1])]);
            if let Some([column, row]) = cell
                && let Some(highest) = highest.values_mut().get_mut(row * grid.width + column)
            {
                *highest = highest.max(position[2]);
            }
        }
        let middles = (0..grid.height).flat_map(|row| (0..grid.width).map(move |column| grid.center(column, row)));
        let is_in: Vec<bool> = match &self.area {
            IndexedArea::Class(_) => vec![true; grid.width * grid.height],
            IndexedArea::Polygon(index) => middles.map(|middle| index.holds(middle)).collect(),
        };
        for row in 0..grid.height {
            for column in 0..grid.width {
                let Some(top) = highest.get(column, row).filter(|top| top.is_finite()) else { continue };
                for near_row in row.saturating_sub(reach)..(row + reach + 1).min(grid.height) {
                    for near in column.saturating_sub(reach)..(column + reach + 1).min(grid.width) {
                        let cell = near_row * grid.width + near;
                        let is_near = near.abs_diff(column).pow(2) + near_row.abs_diff(row).pow(2) <= reach * reach;
                        let is_in = is_in.get(cell).is_some_and(|&is_in| is_in);
                        if let Some(own) = tops.values_mut().get_mut(cell).filter(|_| is_in && is_near) {
                            *own = own.max(top);
                        }
                    }
                }
            }
        }
        tops
    }
}
