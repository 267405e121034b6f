//! The points of a rectangle of the survey, the same in every tile that reads them.

use crate::columns::append;
use crate::grid::MapArea;
use crate::plan::Plan;
use belvedere::control::Control;
use belvedere::io::{Insistence, ReadOptions, Within, read_batches};
use belvedere::{Error, Frame, PointCloud, Result};

/// The points of the plan's files within `area`, in the order of the files and of their points.
///
/// # Errors
/// Those of [`read_batches`], and [`Error::Malformed`] for a file that is no longer what it was.
pub(crate) fn read(plan: &Plan, area: &MapArea, control: &Control<'_>) -> Result<PointCloud> {
    let column = area.column();
    let mut files = Vec::new();
    for file in plan.files_meeting(area) {
        file.check()?;
        files.push(file.source_within(&column));
    }
    let mut cloud = PointCloud::in_frame(plan.frame()?);
    if files.is_empty() {
        return Ok(cloud);
    }
    let options =
        options(plan.crs.as_deref(), plan.insistence(), plan.frame()?).with_points_within(Within::Local(column));
    for batch in read_batches(files, &options, control)? {
        append(&mut cloud, batch?.cloud, plan.columns);
    }
    Ok(cloud)
}

pub(crate) fn options(crs: Option<&str>, insistence: Insistence, frame: Frame) -> ReadOptions {
    let options = ReadOptions::new().with_frame(frame);
    match (crs, insistence) {
        (Some(crs), Insistence::Refuse) => options.with_crs(crs),
        (Some(crs), Insistence::Insist) => options.with_crs(crs).insisting_on_crs(),
        (None, _) => options,
    }
}

/// Whether nothing is there, which is no failure for a tile.
pub(crate) fn is_nothing(error: &Error) -> bool {
    matches!(error, Error::NoPoints { .. } | Error::NoSurface { .. })
}
