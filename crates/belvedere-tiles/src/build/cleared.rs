//! Objects cleared from a survey, in blocks of 64 m that are the same for all tiles.
//!
//! The effect of clearing at a place depends on its surroundings: the interpolated ground below and the objects above
//! it. Each block is computed by itself, with all points of the eight blocks around it. A point or a ball therefore has
//! the same result in all tiles that meet it.

use crate::grid::{CELL, MapArea, block_area, block_of};
use crate::plan::Plan;
use crate::plan::window;
use belvedere::cast::to_f32;
use belvedere::control::Control;
use belvedere::ground::MapGrid;
use belvedere::medial::{LIMIT_TOUCH, MedialBalls};
use belvedere::medium::VOXEL_SIDE;
use belvedere::model::{ClearedArea, Clearing};
use belvedere::{ExtinctionVoxels, PointCloud, Result};
use std::collections::{HashMap, HashSet};

/// Width of the margin of columns around a block, metres. It covers a ball at one of the points, at most 10 m, and the
/// cleared space around a point.
const BESIDE: f64 = 12.0;

/// Point with the data that clearing needs: local metres, and its class.
pub(crate) type ClassedPoint = ([f32; 3], Option<u8>);

/// Returns the points of `rows`.
pub(crate) fn classed(cloud: &PointCloud, rows: impl Iterator<Item = usize>) -> Vec<ClassedPoint> {
    let classes = cloud.attributes.classification.as_deref().unwrap_or_default();
    rows.filter_map(|row| Some((*cloud.positions.get(row)?, classes.get(row).copied()))).collect()
}

impl Plan {
    /// Returns true if any object stands in the cleared areas. Tiles are tested one after the other until the first
    /// object.
    ///
    /// # Errors
    /// Those of reading the files, of [`Clearing::new`], and [`belvedere::Error::Cancelled`].
    pub fn clears_anything(&self, control: &Control<'_>) -> Result<bool> {
        let areas = self.cleared_areas()?;
        for &tile in &self.tiles {
            let core = self.grid().core(tile);
            for (_, polygon) in &areas {
                let Some(own) = polygon.map_or(Some(core), |polygon| polygon.common(&core)) else { continue };
                control.check()?;
                let cloud = control.stage("reading", 0, || window::read(self, &own, control))?;
                let points = classed(&cloud, 0..cloud.len());
                if ClearedSurface::new(self, (&own, &own), &points, &[], control)?.is_cleared.contains(&true) {
                    return Ok(true);
                }
            }
        }
        Ok(false)
    }
}

/// Clears the balls of a tile, which belong to `points`, and closes the ground in `core`. `transmission` has one value
/// for each ball, or none.
///
/// # Errors
/// Those of reading the files, and of [`Clearing::new`].
pub(crate) fn clear_balls(
    plan: &Plan,
    core: &MapArea,
    balls: &mut MedialBalls,
    transmission: &mut Vec<f32>,
    points: &[ClassedPoint],
    control: &Control<'_>,
) -> Result<()> {
    if plan.cleared.is_empty() {
        return Ok(());
    }
    let mut fates: Vec<Option<([f32; 3], f32)>> =
        balls.centers.iter().zip(&balls.radii).map(|(&center, &radius)| Some((center, radius))).collect();
    let of_blocks = by_block(points.iter().map(|point| point.0));
    let mut closing = Vec::new();
    each_block(plan, core, core, control, |block, clearings| {
        for &row in of_blocks.get(&block).into_iter().flatten() {
            let (position, class) = points[row as usize];
            let fate = &mut fates[row as usize];
            for clearing in clearings {
                let clears = clearing.clears(position, class);
                *fate = fate.filter(|_| !clears).and_then(|(center, radius)| clearing.cut(center, radius, position));
            }
        }
        let is_own = |ball: &([f32; 3], f32)| {
            let place = [ball.0[0], ball.0[1]];
            block_of(place) == block && core.holds(place.map(f64::from))
        };
        closing.extend(clearings.iter().flat_map(Clearing::closing_balls).filter(is_own));
    })?;
    let rows: Vec<usize> = (0..fates.len()).filter(|&row| fates[row].is_some()).collect();
    let mut left = balls.select(&rows);
    let cut = fates.into_iter().flatten();
    for ((own_center, own_radius), (center, radius)) in left.centers.iter_mut().zip(&mut left.radii).zip(cut) {
        (*own_center, *own_radius) = (center, radius);
    }
    closing.into_iter().for_each(|(center, radius)| left.push(0, center, radius, LIMIT_TOUCH));
    if !transmission.is_empty() {
        *transmission = rows.iter().filter_map(|&row| transmission.get(row).copied()).collect();
        transmission.resize(left.len(), f32::NAN);
    }
    *balls = left;
    Ok(())
}

/// Returns the voxels of the crowns of a tile without voxels at cleared points. `points` are those in the tile and
/// around it.
///
/// # Errors
/// Those of [`clear_balls`].
pub(crate) fn left_crowns(
    plan: &Plan,
    core: &MapArea,
    voxels: &ExtinctionVoxels,
    points: &[ClassedPoint],
    control: &Control<'_>,
) -> Result<ExtinctionVoxels> {
    let origin = plan.frame.origin;
    let is_own = |voxel: [i32; 3]| {
        let [low, high] = ExtinctionVoxels::square_of(voxel, origin);
        core.holds([0, 1].map(|axis| f64::midpoint(low[axis], high[axis])))
    };
    let own = voxels.filtered(is_own);
    if plan.cleared.is_empty() || own.is_empty() {
        return Ok(own);
    }
    let of_blocks = by_block(points.iter().map(|point| point.0));
    let [mut cleared, mut kept] = [HashSet::new(), HashSet::new()];
    let area = core.widened(VOXEL_SIDE);
    each_block(plan, &area, core, control, |block, clearings| {
        for &row in of_blocks.get(&block).into_iter().flatten() {
            let (position, class) = points[row as usize];
            let is_cleared = clearings.iter().any(|clearing| clearing.clears(position, class));
            let voxels = if is_cleared { &mut cleared } else { &mut kept };
            voxels.insert(ExtinctionVoxels::voxel_of(position, origin));
        }
    })?;
    Ok(own.without_cleared(&cleared, &kept))
}

/// Surface of a tile after clearing.
pub(crate) struct ClearedSurface {
    /// Flags the cleared points.
    pub(crate) is_cleared: Vec<bool>,
    /// Height of the ground, local metres, by the index of a place below which objects were cleared.
    pub(crate) ground: HashMap<usize, f64>,
}

impl ClearedSurface {
    /// Clears the `points` of `area`, and closes the ground at `places` on the map in the core of a tile.
    ///
    /// # Errors
    /// Those of reading the files, and of [`Clearing::new`].
    pub(crate) fn new(
        plan: &Plan,
        (area, core): (&MapArea, &MapArea),
        points: &[ClassedPoint],
        places: &[[f64; 2]],
        control: &Control<'_>,
    ) -> Result<Self> {
        let is_of =
            |class: Option<u8>| plan.cleared.iter().any(|area| class.map(ClearedArea::Class).as_ref() == Some(area));
        let mut is_cleared: Vec<bool> = points.iter().map(|point| is_of(point.1)).collect();
        let mut ground = HashMap::new();
        if plan.cleared.is_empty() {
            return Ok(Self { is_cleared, ground });
        }
        let of_blocks = by_block(points.iter().map(|point| point.0));
        let places_of_blocks = by_block(places.iter().map(|&[x, y]| [to_f32(x), to_f32(y), 0.0]));
        each_block(plan, area, core, control, |block, clearings| {
            for &row in of_blocks.get(&block).into_iter().flatten() {
                let (position, class) = points[row as usize];
                is_cleared[row as usize] |= clearings.iter().any(|clearing| clearing.clears(position, class));
            }
            for &place in places_of_blocks.get(&block).into_iter().flatten() {
                // In overlapping areas the last clearing has the points that all of them left.
                let found = clearings.iter().rev().find_map(|clearing| clearing.ground_at(places[place as usize]));
                ground.extend(found.map(|height| (place as usize, height)));
            }
        })?;
        Ok(Self { is_cleared, ground })
    }
}

/// Passes to `look` each block of `area` near polygons, with the clearings of the block. Blocks of `core` with points
/// of cleared classes are passed too.
fn each_block(
    plan: &Plan,
    area: &MapArea,
    core: &MapArea,
    control: &Control<'_>,
    mut look: impl FnMut([i32; 2], &[Clearing]),
) -> Result<()> {
    let (areas, frame) = (plan.cleared_areas()?, plan.frame()?);
    let reaches = |polygon: &MapArea, block: &MapArea| polygon.distance(block) <= BESIDE + Clearing::REACH;
    let is_near = |block: &MapArea| {
        areas.iter().any(|(_, polygon)| polygon.map_or_else(|| block.meets(core), |polygon| reaches(&polygon, block)))
    };
    let blocks: Vec<[i32; 2]> = area.blocks().filter(|&at| is_near(&block_area(at))).collect();
    let around = blocks.iter().map(|&at| block_area(at).widened(CELL)).reduce(|all, block| all.joined(&block));
    let Some(around) = around else { return Ok(()) };
    let cloud = control.stage("reading", 0, || window::read(plan, &around, control))?;
    let rows = by_block(cloud.positions.iter().copied());
    control.stage("clearing", blocks.len(), || {
        for at in blocks {
            control.check()?;
            let [east, north] = at;
            let beside = (north - 1..=north + 1).flat_map(|north| (east - 1..=east + 1).map(move |east| [east, north]));
            let mut own: Vec<u32> = beside.filter_map(|at| rows.get(&at)).flatten().copied().collect();
            own.sort_unstable();
            let mut left = cloud.select(&own);
            let columns = block_area(at).widened(BESIDE);
            let origin = [frame.origin[0], frame.origin[1]];
            let grid = MapGrid::covering(columns.low, columns.high, Clearing::CELL, origin)?;
            let mut clearings = Vec::new();
            for (cleared, polygon) in &areas {
                let has_class = |class: u8| {
                    left.attributes.classification.as_deref().is_some_and(|classes| classes.contains(&class))
                };
                let is_concerned = match (cleared, polygon) {
                    (ClearedArea::Class(class), _) => has_class(*class),
                    (ClearedArea::Polygon(_) | ClearedArea::Polygons(_), polygon) => {
                        polygon.is_some_and(|area| reaches(&area, &block_area(at)))
                    }
                };
                if left.is_empty() || !is_concerned {
                    continue;
                }
                let clearing = match Clearing::new(cleared, &left, grid, control) {
                    Ok(clearing) => clearing,
                    Err(error) if window::is_nothing(&error) => continue,
                    Err(error) => return Err(error),
                };
                let points = classed(&left, 0..left.len());
                let stays = |(_, point): &(u32, &ClassedPoint)| !clearing.clears(point.0, point.1);
                let kept: Vec<u32> = (0..).zip(&points).filter(stays).map(|(row, _)| row).collect();
                if kept.len() < left.len() {
                    left = left.select(&kept);
                }
                clearings.push(clearing);
            }
            look(at, &clearings);
            control.advance(1);
        }
        Ok(())
    })
}

/// Groups the indices of positions by block, in ascending order.
fn by_block(positions: impl Iterator<Item = [f32; 3]>) -> HashMap<[i32; 2], Vec<u32>> {
    let mut rows: HashMap<[i32; 2], Vec<u32>> = HashMap::new();
    for (row, [x, y, _]) in (0..).zip(positions) {
        rows.entry(block_of([x, y])).or_default().push(row);
    }
    rows
}
