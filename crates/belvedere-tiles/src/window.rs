//! Points of a rectangle of the survey, the same in every tile that reads them.

use crate::columns::append;
use crate::grid::{MapArea, block_area, block_of};
use crate::plan::Plan;
use crate::survey::is_counted;
use belvedere::control::Control;
use belvedere::io::{Insistence, ReadOptions, Within, read_batches};
use belvedere::weather::CalendarDay;
use belvedere::{Error, Frame, PointCloud, Result};
use std::collections::HashMap;
use std::path::PathBuf;

/// Reads the points of the plan's files within `area`, in the order of the files and of their points.
///
/// # Errors
/// Those of [`read_batches`], and [`Error::Malformed`] for a changed file.
pub(crate) fn read(plan: &Plan, area: &MapArea, control: &Control<'_>) -> Result<PointCloud> {
    let mut cloud = PointCloud::in_frame(plan.frame()?);
    each_batch(plan, area, control, |batch| append(&mut cloud, batch, plan.columns))?;
    Ok(cloud)
}

/// Passes the points of [`read`] to `take`, part by part.
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
    let flags = cloud.attributes.flags.as_deref().unwrap_or_default();
    let classes = cloud.attributes.classification.as_deref().unwrap_or_default();
    let mut found: HashMap<[i32; 2], u64> = HashMap::new();
    for (row, &p) in cloud.positions.iter().enumerate() {
        if is_counted(p, classes.get(row).copied().unwrap_or(0), flags.get(row).copied().unwrap_or(0)) {
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
