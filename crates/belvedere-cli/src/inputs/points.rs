//! Points of files, beside those of the scene.

use crate::pipeline;
use crate::run::CommandContext;
use crate::summary::Summary;
use anyhow::Result;
use belvedere::io::{ReadOptions, read_cloud};
use belvedere::{Frame, PointCloud};
use std::path::Path;

/// The points of a file as a cloud in the frame of the scene, read with these options.
pub(crate) fn points_of_file(
    path: &Path,
    options: &ReadOptions,
    frame: &Frame,
    run: &mut CommandContext,
) -> Result<PointCloud> {
    let (cloud, report) =
        run.stage("reading targets", 0, |control| read_cloud(&[path.to_owned()], options, control))?;
    pipeline::check_every_row(&report)?;
    run.summary.add("reading_targets", Summary::of(&report));
    cloud.frame.crs.check_for(&frame.crs, "cloud of targets", path)?;
    Ok(cloud.moved_to(frame))
}
