//! The ground below a cloud: heights on a grid, from points classed as ground or from points found to be.

mod believed;
mod by_squares;
pub mod find;
mod in_blocks;
pub mod map_grid;
mod morphology;
mod relief;
mod returns;
mod shifted;
mod surface;
mod triangulate;

pub(crate) use triangulate::sides;

use belvedere_data::cast::{to_f32, to_index};
use belvedere_data::cloud::GROUND;
pub use by_squares::GroundBySquares;
pub use find::{FinderParams, find_ground};
pub(crate) use in_blocks::{GROUND_REACH, ground_in_blocks};
pub use map_grid::MapGrid;
pub use relief::{HighestPoints, hidden_ground, highest_points};
pub use returns::{MAX_GAP_FROM_RETURNS, cells_near_returns};
pub use shifted::{GroundShift, ShiftEvidence};
pub use surface::{SurfaceParams, top_surface};

use crate::neighbors::NeighborIndex;
use belvedere_data::control::Control;
use belvedere_data::raster::Raster;
use belvedere_data::vector::compare_places;
use belvedere_data::{Error, Parameter, PointCloud, Result};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// ASPRS classes of the surface of water, which is the ground there: without it heights would be interpolated from bank
/// to bank, and boats float as high as the quays.
const WATER: [u8; 2] = [9, 41];
/// LAS flag of points that the supplier withdrew.
const WITHHELD: u8 = 4;
/// Ground points beyond the outermost of which the nearest one's height is still taken, metres: a few spacings of
/// sparse surveys.
const MAX_EXTRAPOLATION: f32 = 5.0;

/// Parameters of the ground of a cloud.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroundParams {
    /// Source of ground points. Default: class 2 if there are any, else detection.
    pub points: GroundPoints,
    /// Parameters of ground detection.
    pub finder: FinderParams,
    /// Maximum distance from the next ground point for which a height is given, metres, above 0. Default 60: the middle
    /// of large halls has a ground below it.
    pub reach: f64,
    /// Maximum horizontal distance of the middle of a cell from the nearest return, a point of the cloud of any class,
    /// for which it has a height, metres, above 0. Default 5: a hole in the survey, such as a missing tile or wide
    /// water, has no ground. Ground beside and below buildings keeps its height, because walls and roofs are returns.
    pub max_gap_from_returns: f64,
}

/// Source of ground points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum GroundPoints {
    /// Class 2 and water where at least one point in a thousand has class 2, else [`GroundPoints::Found`].
    #[default]
    Auto,
    /// Points of class 2, except small groups metres below or above the rest, and the surface of water (9, 41).
    Classed,
    /// Points that [`find_ground`] finds, of any class.
    Found,
}

impl GroundParams {
    fn check(&self) -> Result<()> {
        match [self.reach, self.max_gap_from_returns].into_iter().find(|reach| !(*reach > 0.0)) {
            None => Ok(()),
            Some(value) => Err(Error::invalid(Parameter::GroundReach, value, "above zero metres")),
        }
    }
}

impl Default for GroundParams {
    fn default() -> Self {
        Self {
            points: GroundPoints::Auto,
            finder: FinderParams::default(),
            reach: 60.0,
            max_gap_from_returns: MAX_GAP_FROM_RETURNS,
        }
    }
}

/// Source of the ground of a [`Ground`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct GroundReport {
    /// [`GroundPoints::Classed`] or [`GroundPoints::Found`].
    pub from: GroundPoints,
    /// Number of ground points.
    pub point_count: usize,
    /// Number of points of class 2 that are not believed: they lie metres below or above the ground around, alone or in
    /// small groups.
    pub doubted_count: usize,
    /// The points of class 2 that lie off by a metre or more over an area, as other points show. They count as ground
    /// all the same: nobody can say which of the two is right.
    pub shift: Option<GroundShift>,
    /// Cells of the grid that have a height.
    pub cell_count: usize,
}

/// Heights of the ground on a grid.
#[derive(Clone, Debug)]
pub struct Ground {
    /// Position of the cells.
    pub grid: MapGrid,
    /// Height of the ground at the middle of each cell, local metres; NaN where nothing is known.
    pub heights: Raster<f32>,
    /// Horizontal distance of the middle of each cell to the next ground point, metres: how far the height is
    /// interpolated.
    pub gaps: Raster<f32>,
}

/// Rows of the points of `cloud` that are ground, in rising order, and the method that classified them. Of class 2,
/// withheld points are none, nor are small groups that lie metres below or above the ground around
/// ([`GroundReport::doubted_count`]).
///
/// # Errors
/// [`Error::NoPoints`] for an empty cloud, and for [`GroundPoints::Classed`] without class 2; otherwise those of
/// [`find_ground`].
pub fn ground_points(
    cloud: &PointCloud,
    params: &GroundParams,
    control: &Control<'_>,
) -> Result<(Vec<u32>, GroundPoints)> {
    tested_points(cloud, params, control).map(|GroundRows { rows, from, .. }| (rows, from))
}

/// The points that are ground.
struct GroundRows {
    rows: Vec<u32>,
    from: GroundPoints,
    doubted_count: usize,
    /// True if some of the rows are water.
    has_water: bool,
}

impl GroundRows {
    /// The same in an order that does not depend on that of the cloud.
    fn in_order(mut self, cloud: &PointCloud) -> Self {
        let strips = cloud.attributes.point_source_id.as_deref();
        let strip = |row: u32| strips.and_then(|strips| strips.get(row as usize));
        let place = |row: u32| &cloud.positions[row as usize];
        self.rows.par_sort_unstable_by(|&a, &b| {
            compare_places(place(a), place(b)).then_with(|| strip(a).cmp(&strip(b))).then(a.cmp(&b))
        });
        self
    }

    fn positions(&self, cloud: &PointCloud) -> Vec<[f32; 3]> {
        self.rows.iter().filter_map(|&row| cloud.positions.get(row as usize).copied()).collect()
    }

    /// The points of class 2 that lie off, as those that are not show; `points` are the ground.
    fn shift(&self, cloud: &PointCloud, points: &[[f32; 3]], control: &Control<'_>) -> Result<Option<GroundShift>> {
        match self.from {
            GroundPoints::Found => Ok(None),
            // what lies lower than ground around it is no error there
            _ if self.has_water => {
                let is_ground = |row: &&u32| cloud.attributes.class_of(**row as usize) == Some(GROUND);
                let rows: Vec<u32> = self.rows.iter().filter(is_ground).copied().collect();
                let points: Vec<[f32; 3]> =
                    rows.iter().filter_map(|&row| cloud.positions.get(row as usize).copied()).collect();
                shifted::shift_of(cloud, &rows, &points, control)
            }
            _ => shifted::shift_of(cloud, &self.rows, points, control),
        }
    }

    /// Returns the report without cells.
    fn report(&self, point_count: usize, shift: Option<GroundShift>) -> GroundReport {
        let Self { from, doubted_count, .. } = *self;
        GroundReport { from, point_count, doubted_count, shift, cell_count: 0 }
    }
}

fn tested_points(cloud: &PointCloud, params: &GroundParams, control: &Control<'_>) -> Result<GroundRows> {
    if cloud.is_empty() {
        return Err(Error::NoPoints { what: "the ground needs a cloud".to_owned() });
    }
    let found = || {
        let rows = find_ground(cloud, &params.finder, control)?;
        Ok(GroundRows { rows, from: GroundPoints::Found, doubted_count: 0, has_water: false })
    };
    if params.points == GroundPoints::Found {
        return found();
    }
    let classes = cloud.attributes.classification.as_deref().unwrap_or_default();
    let flags = cloud.attributes.flags.as_deref().unwrap_or_default();
    let rows_of = |of_classes: &[u8]| -> Vec<u32> {
        let is_wanted = |(row, class): &(u32, &u8)| {
            of_classes.contains(class) && flags.get(*row as usize).is_none_or(|flags| flags & WITHHELD == 0)
        };
        (0_u32..).zip(classes).filter(is_wanted).map(|(row, _)| row).collect()
    };
    let classed = rows_of(&[GROUND]);
    match params.points {
        GroundPoints::Classed if classed.is_empty() => {
            let what = "no point has class 2 (ground); detect the ground from all points".to_owned();
            return Err(Error::NoPoints { what });
        }
        GroundPoints::Auto if classed.len() < cloud.len().div_ceil(1000) => return found(),
        _ => {}
    }
    let points: Vec<[f32; 3]> = classed.iter().filter_map(|&row| cloud.positions.get(row as usize).copied()).collect();
    let believed = believed::believed(&points, control)?;
    let count = classed.len();
    let rows: Vec<u32> =
        classed.into_iter().zip(believed).filter(|(_, believed)| *believed).map(|(row, _)| row).collect();
    let doubted_count = count - rows.len();
    let water = rows_of(&WATER);
    let has_water = !water.is_empty();
    let mut rows = rows;
    if has_water {
        rows.extend(water);
        rows.sort_unstable();
    }
    Ok(GroundRows { rows, from: GroundPoints::Classed, doubted_count, has_water })
}

/// Points sorted by their coordinates: triangulations and the nearest of several points depend on the order.
fn in_order(mut points: Vec<[f32; 3]>) -> Vec<[f32; 3]> {
    points.par_sort_unstable_by(compare_places);
    points
}

/// Points in the plane, for distances and neighbours on the map.
fn on_map(points: &[[f32; 3]]) -> Vec<[f32; 3]> {
    points.iter().map(|p| [p[0], p[1], 0.0]).collect()
}

impl Ground {
    /// The ground of `cloud` on `grid`: heights of the triangulated ground points at the middles of the cells, and the
    /// nearest ground point's within 5 m beyond the outermost. A hole of the survey has none
    /// ([`GroundParams::max_gap_from_returns`]); where points were cleared ([`PointCloud::cleared_places`]) there is no
    /// hole.
    ///
    /// # Errors
    /// Those of [`ground_points`], and [`Error::InvalidParameter`] for a parameter outside its range.
    pub fn of_cloud(
        cloud: &PointCloud,
        grid: MapGrid,
        params: &GroundParams,
        control: &Control<'_>,
    ) -> Result<(Self, GroundReport)> {
        params.check()?;
        let found = tested_points(cloud, params, control)?.in_order(cloud);
        let points = found.positions(cloud);
        let left = cloud.positions.iter().map(|p| [f64::from(p[0]), f64::from(p[1])]);
        let returns = left.chain(cloud.cleared_places.iter().map(|place| place.map(f64::from)));
        // most of each is one thread's work
        let (ground, (near, shift)) = rayon::join(
            || Self::of_points(&points, grid, params.reach, control),
            || {
                rayon::join(
                    || cells_near_returns(returns, &grid, params.max_gap_from_returns),
                    || found.shift(cloud, &points, control),
                )
            },
        );
        let ground = ground?;
        Ok(ground.known_near_returns(&near, found.report(points.len(), shift?)))
    }

    /// This, without the heights of cells that lie near no return.
    fn known_near_returns(mut self, near: &[bool], report: GroundReport) -> (Self, GroundReport) {
        for (height, _) in self.heights.values_mut().iter_mut().zip(near).filter(|(_, is_near)| !**is_near) {
            *height = f32::NAN;
        }
        let cell_count = self.heights.values().iter().filter(|h| h.is_finite()).count();
        (self, GroundReport { cell_count, ..report })
    }

    /// The ground through `points`, (N, 3) local metres, on `grid`. Cells farther than `reach` metres from the nearest
    /// point have no height.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a point that is not finite, [`Error::Cancelled`].
    pub fn of_points(points: &[[f32; 3]], grid: MapGrid, reach: f64, control: &Control<'_>) -> Result<Self> {
        let points = &in_order(points.to_vec())[..];
        let flat = on_map(points);
        let (heights, nearest) =
            rayon::join(|| triangulate::heights(points, &grid), || NeighborIndex::new(&flat, control));
        let (heights, nearest) = (heights?, nearest?);
        control.check()?;
        Self::near_points(points, &nearest, (grid, heights), reach, control)
    }

    /// The ground with these heights of the triangulated `points`, as far as `reach` metres from the next of them;
    /// `nearest` finds those on the map.
    fn near_points(
        points: &[[f32; 3]],
        nearest: &NeighborIndex,
        (grid, mut heights): (MapGrid, Raster<f32>),
        reach: f64,
        control: &Control<'_>,
    ) -> Result<Self> {
        let mut gaps = Raster::filled(grid.width, grid.height, f32::INFINITY);
        let reach = to_f32(reach.min(1e6));
        let width = grid.width.max(1);
        heights
            .values_mut()
            .par_chunks_mut(width)
            .zip(gaps.values_mut().par_chunks_mut(width))
            .enumerate()
            .try_for_each(|(row, (heights, gaps))| {
                control.check()?;
                for (column, (height, gap)) in heights.iter_mut().zip(gaps).enumerate() {
                    let [x, y] = grid.center(column, row);
                    let near = nearest.nearest_within([to_f32(x), to_f32(y), 0.0], f32::INFINITY);
                    let Some(near) = near else { continue };
                    *gap = near.distance_squared.sqrt();
                    if *gap > reach {
                        *height = f32::NAN;
                    } else if height.is_nan() && *gap <= MAX_EXTRAPOLATION {
                        *height = points.get(near.index as usize).map_or(f32::NAN, |p| p[2]);
                    }
                }
                Ok(())
            })?;
        Ok(Self { grid, heights, gaps })
    }

    /// Returns the range of heights of most of the ground within `radius` metres of a place in plan, local metres. The
    /// 5 % lowest and the 5 % highest cells are left out, and those within a quarter of the radius. `None` if the
    /// ground is not known.
    #[must_use]
    pub fn heights_around(&self, [x, y]: [f64; 2], radius: f64) -> Option<[f64; 2]> {
        let middle = self.grid.cell_position([x, y])?;
        let reach = radius / self.grid.cell;
        let span = |at: f64, count: usize| to_index(at - reach)..to_index((at + reach).ceil()).min(count);
        let mut heights: Vec<f32> = Vec::new();
        for row in span(middle[1], self.grid.height) {
            for column in span(middle[0], self.grid.width) {
                let [east, north] = self.grid.center(column, row);
                let height = self.heights.get(column, row).filter(|height| height.is_finite());
                let is_around = (0.25 * radius..=radius).contains(&(east - x).hypot(north - y));
                heights.extend(height.filter(|_| is_around));
            }
        }
        heights.sort_unstable_by(f32::total_cmp);
        let last = heights.len().checked_sub(1)?;
        Some([last / 20, last - last / 20].map(|at| f64::from(heights[at])))
    }

    /// Height of the ground at a local position on the map, between the middles of cells linearly, local metres; `None`
    /// outside and where nothing is known.
    #[must_use]
    pub fn height_at(&self, [x, y]: [f64; 2]) -> Option<f64> {
        let [column, row] = self.grid.cell_position([x, y])?;
        let (u, v) = (column - 0.5, row - 0.5);
        let floor = |value: f64, count: usize| to_index(value).min(count.saturating_sub(2));
        let (c, r) = (floor(u, self.grid.width), floor(v, self.grid.height));
        let (s, t) = ((u - c as f64).clamp(0.0, 1.0), (v - r as f64).clamp(0.0, 1.0));
        let (mut sum, mut weights) = (0.0, 0.0);
        for (dc, dr, weight) in
            [(0, 0, (1.0 - s) * (1.0 - t)), (1, 0, s * (1.0 - t)), (0, 1, (1.0 - s) * t), (1, 1, s * t)]
        {
            let height = self.heights.get(c + dc, r + dr).map_or(f64::NAN, f64::from);
            if height.is_finite() && weight > 0.0 {
                sum += weight * height;
                weights += weight;
            }
        }
        (weights > 0.0).then(|| sum / weights)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use belvedere_data::Attributes;

    #[test]
    fn water_is_its_own_level_and_not_a_bridge_between_its_banks() {
        // a canal of 20 m, 3 m below its quays, a point each half metre
        for water in [9, 41] {
            let (mut positions, mut classes) = (Vec::new(), Vec::new());
            for i in 0..120_u8 {
                for k in 0..60_u8 {
                    let (x, y) = (0.5 * f32::from(i), 0.5 * f32::from(k));
                    let is_water = (20.0..40.0).contains(&x);
                    positions.push([x, y, if is_water { 0.0 } else { 3.0 }]);
                    classes.push(if is_water { water } else { 2 });
                }
            }
            let attributes = Attributes { classification: Some(classes), ..Attributes::default() };
            let cloud = PointCloud { positions, attributes, ..PointCloud::default() };
            let grid = MapGrid::covering([0.0, 0.0], [59.0, 29.0], 1.0, [0.0; 2]).unwrap();
            let (ground, report) = Ground::of_cloud(&cloud, grid, &GroundParams::default(), &Control::none()).unwrap();
            for (x, height) in [(10.5, 3.0), (22.5, 0.0), (30.5, 0.0), (37.5, 0.0), (50.5, 3.0)] {
                assert_eq!(ground.height_at([x, 15.5]), Some(height), "{x}");
            }
            assert_eq!((report.from, report.shift), (GroundPoints::Classed, None));
        }
    }
}
