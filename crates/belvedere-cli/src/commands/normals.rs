//! `belvedere normals`.

use crate::arguments::{Global, NormalsArguments, OrientChoice};
use crate::outputs::formats::{NormalColumns, check_output, check_parent, is_folder, is_written_back};
use crate::pipeline::{self, params};
use crate::run::CommandContext;
use crate::summary::Summary;
use anyhow::Result;
use belvedere::PointCloud;
use belvedere::apps::ask::remark_on_axis;
use belvedere::io::{ExtraColumn, ExtraValues, MasbcppFolder, WriteReport, write_cloud, write_masbcpp};
use belvedere::medial::ShrinkParams;
use belvedere::model::{BallParams, OrientedSurvey};
use std::path::Path;

pub(crate) fn run(arguments: &NormalsArguments, global: &Global) -> Result<Summary> {
    let output = &arguments.output;
    let is_folder = is_folder(output);
    if is_folder {
        check_parent(output)?;
    } else {
        check_output("-o", output, &["laz", "las", "ply", "csv", "xyz", "txt"])?;
    }
    let mut parameters = arguments.points.parameters()?;
    let mut run = CommandContext::new(global);
    let mut cloud = if is_folder {
        pipeline::read_every_row(&arguments.points.input, &mut run)?
    } else {
        pipeline::read(&arguments.points.input, &mut run)?
    };
    if matches!(parameters.orienting.orient, None | Some(OrientChoice::Auto)) {
        // new normals are requested, so those of an earlier run are dropped
        cloud.attributes.normals = None;
    }
    if is_folder {
        // the rows of a folder belong to the rows of its coords.npy
        parameters = parameters.keeping_all();
    }
    let balls = BallParams::Shrunk(ShrinkParams::tau());
    let params = params::model(&parameters, balls, &cloud.frame.crs, &mut run)?;
    let prepared = OrientedSurvey::prepare(&cloud, &params, &run.control());
    let (survey, report) = prepared.map_err(|error| pipeline::advised(&arguments.points.input, error))?;
    run.summary.add_report(&report);
    run.summary.remarks(remark_on_axis(survey.looks_y_up(&cloud.frame)));
    let oriented = &survey.oriented;
    let report = run.stage("writing", 0, |_| -> Result<WriteReport> {
        if is_folder {
            let coords = (!is_written_back(&arguments.points.input.clouds, output))
                .then(|| pipeline::file_coordinates(&cloud, &cloud.positions));
            let folder = MasbcppFolder {
                coords: coords.as_deref(),
                normals: Some(oriented.normals()),
                ..MasbcppFolder::default()
            };
            write_masbcpp(output, &folder)?;
            return Ok(WriteReport::default());
        }
        write_points(output, &cloud, &survey)
    })?;
    run.summary.add_writing(output, &report);
    run.summary
        .headline("normals of <points> points, oriented by <normals.oriented_by>")
        .headline("uncertain sign: <normals.low_confidence_percent> % of the points");
    run.summary.add("written", output.display().to_string());
    Ok(run.finish())
}

/// The points that cleaning kept, with their normals and how well these are known.
fn write_points(output: &Path, cloud: &PointCloud, survey: &OrientedSurvey) -> Result<WriteReport> {
    let mut kept = if survey.kept.len() == cloud.len() { cloud.clone() } else { cloud.select(&survey.kept) };
    kept.attributes.normals = None;
    let oriented = &survey.oriented;
    let normals = NormalColumns::new(oriented.normals());
    let [x, y, z] = normals.columns(output);
    let column = |name, description, values| ExtraColumn { name, description, values: ExtraValues::F32(values) };
    let columns = [
        x,
        y,
        z,
        column("quality", "how well the line is known", oriented.quality()),
        column("confidence", "how sure the sign is", oriented.confidence()),
    ];
    Ok(write_cloud(output, &kept, &columns)?)
}
