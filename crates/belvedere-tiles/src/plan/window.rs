//! Points of a rectangle of the survey, the same in every tile that reads them.

use crate::columns::append;
use crate::grid::{MapArea, block_area, block_of};
use crate::plan::Plan;
use belvedere::apps::targets::{grid_around, set_on_ground};
use belvedere::control::Control;
use belvedere::ground::{Ground, GroundParams};
use belvedere::io::{Insistence, ReadOptions, Within, read_batches};
use belvedere::model::is_counted;
use belvedere::strips::move_strips;
use belvedere::weather::CalendarDay;
use belvedere::{Error, Frame, Parameter, PointCloud, Result};
use std::collections::HashMap;
use std::path::PathBuf;

/// Margin around the grid of a place within which points are read for its ground, metres.
pub(crate) const GROUND_AROUND: f64 = 32.0;

/// Reads the points of the plan's files within `area`, in the order of the files and of their points. Heights of flight
/// lines are fitted to each other.
///
/// # Errors
/// Those of [`read_as_stored`].
pub(crate) fn read(plan: &Plan, area: &MapArea, control: &Control<'_>) -> Result<PointCloud> {
    let mut cloud = read_as_stored(plan, area, control)?;
    move_strips(&mut cloud, plan.statistics.moved_strips());
    Ok(cloud)
}

/// Reads points as [`read`], with the heights of the files. Models fit these themselves.
///
/// # Errors
/// Those of [`read_batches`], and [`Error::Malformed`] for a changed file.
pub(crate) fn read_as_stored(plan: &Plan, area: &MapArea, control: &Control<'_>) -> Result<PointCloud> {
    let mut cloud = PointCloud::in_frame(plan.frame()?);
    each_batch(plan, area, control, |batch| append(&mut cloud, batch, plan.columns))?;
    Ok(cloud)
}

/// Passes the points of [`read_as_stored`] to `take`, part by part.
pub(crate) fn each_batch(
    plan: &Plan,
    area: &MapArea,
    control: &Control<'_>,
    mut take: impl FnMut(PointCloud),
) -> Result<()> {
    let column = area.column();
    let mut files = Vec::new();
    for file in plan.files_meeting(area) {
        file.check()?;
        files.push(file.source_within(&column));
    }
    if files.is_empty() {
        return Ok(());
    }
    let options = options(plan.crs.as_deref(), plan.insistence(), plan.flown(), plan.frame()?)
        .with_points_within(Within::Local(column));
    for batch in read_batches(files, &options, control)? {
        take(batch?.cloud);
    }
    Ok(())
}

/// Refuses points of a run whose counts differ from the plan. `cloud` has all points of the blocks of `area`.
///
/// # Errors
/// [`Error::Malformed`] for a file that hides points, or has more.
pub(crate) fn check_counts(plan: &Plan, cloud: &PointCloud, area: &MapArea) -> Result<()> {
    let mut found: HashMap<[i32; 2], u64> = HashMap::new();
    for (row, &p) in cloud.positions.iter().enumerate() {
        if is_counted(p, row, &cloud.attributes) {
            *found.entry(block_of([p[0], p[1]])).or_default() += 1;
        }
    }
    for block in plan.blocks_in(area) {
        let count = found.get(&block.at).copied().unwrap_or(0);
        if count != block.points {
            let of_block = block_area(block.at);
            let path = plan.files_meeting(&of_block).next().map_or_else(PathBuf::new, |file| file.path.clone());
            let origin = plan.frame()?.origin;
            let [x, y] = [0, 1].map(|axis| of_block.low[axis] + origin[axis]);
            let what = format!(
                "gives {count} points in the 64 m from {x} m east and {y} m north, where the plan counted {}: it changed, \
                 or its COPC hierarchy hides points; write it again (PDAL, las2las), and make the plan again",
                block.points
            );
            return Err(Error::malformed(&path, what));
        }
    }
    Ok(())
}

pub(crate) fn options(
    crs: Option<&str>,
    insistence: Insistence,
    flown: Option<CalendarDay>,
    frame: Frame,
) -> ReadOptions {
    let mut options = ReadOptions::new().with_frame(frame);
    options.flown = flown;
    match (crs, insistence) {
        (Some(crs), Insistence::Refuse) => options.with_crs(crs),
        (Some(crs), Insistence::Insist) => options.with_crs(crs).insisting_on_crs(),
        (None, _) => options,
    }
}

/// Returns true if the error only means an empty tile, which is no failure.
pub(crate) fn is_nothing(error: &Error) -> bool {
    matches!(error, Error::NoPoints { .. } | Error::NoSurface { .. })
}

impl Plan {
    /// Sets places on the map, local metres, on the ground. Each place without a height gets `height` metres above the
    /// ground.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a place without ground, those of reading the files and of [`Ground::of_cloud`].
    pub fn set_on_ground(&self, places: &mut [[f64; 3]], height: f64, control: &Control<'_>) -> Result<()> {
        let origin = self.frame.origin;
        for place in places {
            let Some(grid) = grid_around([*place], origin)? else { continue };
            let corner = [grid.corner[0], grid.corner[1] - grid.cell * grid.height as f64];
            let area = MapArea { low: corner, high: [corner[0] + grid.cell * grid.width as f64, grid.corner[1]] };
            let cloud = read(self, &area.widened(GROUND_AROUND), control)?;
            let ground = match Ground::of_cloud(&cloud, grid, &GroundParams::default(), control) {
                Err(error) if !is_nothing(&error) => return Err(error),
                ground => ground.ok(),
            };
            let unknown = ground.map(|(ground, _)| set_on_ground([(&mut *place, height)], &ground));
            if unknown.is_none_or(|unknown| !unknown.is_empty()) {
                return Err(without_ground(format!("{:.2}, {:.2}", place[0] + origin[0], place[1] + origin[1])));
            }
        }
        Ok(())
    }
}

pub(crate) fn without_ground(value: String) -> Error {
    let expected = "a place of the survey with ground, or with its height as a third coordinate";
    Error::invalid(Parameter::Observer, value, expected)
}
