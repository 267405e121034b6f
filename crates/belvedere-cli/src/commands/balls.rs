//! `belvedere balls`.

use crate::arguments::{BallsArguments, CloudInput, Global, MethodChoice, SideChoice, refuse};
use crate::outputs::balls::with_program;
use crate::outputs::formats::{check_output, check_parent, extension, is_folder, is_written_back};
use crate::pipeline::{self, params};
use crate::run::CommandContext;
use crate::summary::{Summary, percent};
use anyhow::Result;
use belvedere::PointCloud;
use belvedere::apps::ask::{remark_on_axis, remarks_on_model};
use belvedere::io::{MasbcppFolder, write_balls, write_masbcpp};
use belvedere::medial::feature_size::{FeatureSizeParams, SimplifyParams, local_feature_size, simplify};
use belvedere::medial::{MedialBalls, NO_TOUCH, Side};
use belvedere::model::{BallParams, ModelParams, ModelParts, OrientedSurvey};
use std::borrow::Cow;

pub(crate) fn run(arguments: &BallsArguments, global: &Global) -> Result<Summary> {
    let is_folder = is_folder(&arguments.output);
    check(arguments, is_folder)?;
    let method = match (is_folder, arguments.side) {
        (true, _) => MethodChoice::Angles,
        (false, SideChoice::Interior) => MethodChoice::Carved,
        (false, SideChoice::Exterior) => MethodChoice::Tau,
    };
    let mut parameters = arguments.parameters()?;
    let balls = parameters.balls(method)?;
    let is_carved = matches!(balls, BallParams::Carved(_));
    if is_carved && (is_folder || arguments.side == SideChoice::Exterior) {
        return refuse(
            "--method carved builds interior balls in a ball file; a folder and --side exterior need tau or angles",
        );
    }
    let mut run = CommandContext::new(global);
    let cloud = if is_folder {
        pipeline::read_every_row(&arguments.input, &mut run)?
    } else {
        pipeline::read(&arguments.input, &mut run)?
    };
    if is_folder {
        parameters = parameters.keeping_all();
    }
    let params = params::model(&parameters, balls, &cloud.frame.crs, &mut run)?;
    match (is_folder, arguments.side) {
        (true, _) => write_folder(arguments, global, &cloud, &params, &mut run)?,
        (false, side) => {
            let model = match side {
                SideChoice::Interior => interior(&arguments.input, cloud, &params, &mut run)?,
                SideChoice::Exterior => exterior(&arguments.input, &cloud, &params, &mut run)?,
            };
            run.summary.add("balls", model.balls.len());
            let model = with_program(model, &arguments.input);
            if model.pulses.is_some() && extension(&arguments.output) != "npz" {
                run.summary.add("not_written", "pulses: only .npz keeps them, which unproven answers need");
            }
            run.stage("writing", 0, |_| write_balls(&arguments.output, &model))?;
        }
    }
    run.summary
        .headline("[<balls> ]balls from <points> points; normals oriented by <normals.oriented_by>")
        .headline("scanner found by <scanner.found_by>, known for <scanner.scanner_known_percent> % of the points")
        .headline("pulses: <pulses.pulses_used> cut <interior_balls.balls_cut_by_pulses> balls")
        .headline("noise of the surface: <smoothing.noise_m> m")
        .headline("thinning keeps <thinning_kept_percent> % of the points");
    run.summary.add("written", arguments.output.display().to_string());
    Ok(run.finish())
}

/// Refuses what cannot be written to the output, before any point is read.
fn check(arguments: &BallsArguments, is_folder: bool) -> Result<()> {
    if is_folder {
        check_parent(&arguments.output)?;
        return Ok(());
    }
    if arguments.nan || arguments.simplify.is_some() {
        return refuse("--nan and --simplify write into a folder: give -o a name without extension");
    }
    check_output("-o", &arguments.output, &["npz", "ply", "laz", "las"])?;
    Ok(())
}

/// The scene model, as it is saved.
fn interior(
    input: &CloudInput,
    cloud: PointCloud,
    params: &ModelParams,
    run: &mut CommandContext,
) -> Result<ModelParts> {
    let model = pipeline::model_of(Cow::Owned(cloud), params, input, run)?;
    run.summary.remarks(remarks_on_model(&model));
    Ok(model.into_parts())
}

/// Balls in free space, which are for looking at and for other programs: no scene is made of them.
fn exterior(
    input: &CloudInput,
    cloud: &PointCloud,
    params: &ModelParams,
    run: &mut CommandContext,
) -> Result<ModelParts> {
    let prepared = OrientedSurvey::prepare(cloud, params, &run.control());
    let (survey, report) = prepared.map_err(|error| pipeline::advised(input, error))?;
    run.summary.add_report(&report);
    run.summary.remarks(remark_on_axis(survey.looks_y_up(&cloud.frame)));
    let (parts, report) = survey.exterior_parts(cloud.frame.clone(), params, &run.control())?;
    run.summary.add("exterior_balls", Summary::of(&report));
    Ok(parts)
}

fn write_folder(
    arguments: &BallsArguments,
    global: &Global,
    cloud: &PointCloud,
    params: &ModelParams,
    run: &mut CommandContext,
) -> Result<()> {
    let prepared = OrientedSurvey::prepare(cloud, params, &run.control());
    let (survey, report) = prepared.map_err(|error| pipeline::advised(&arguments.input, error))?;
    run.summary.add_report(&report);
    run.summary.remarks(remark_on_axis(survey.looks_y_up(&cloud.frame)));
    let mut made = |name, side| -> Result<MedialBalls> {
        let (balls, report) = survey.shrink(side, params.balls.shrinking(), &run.control())?;
        run.summary.add(name, Summary::of(&report));
        Ok(balls)
    };
    let interior = made("interior_balls", Side::Interior)?;
    let exterior = made("exterior_balls", Side::Exterior)?;
    let mut folder = MasbcppFolder::default();
    let centers = |balls: &MedialBalls| {
        let mut centers = pipeline::file_coordinates(cloud, &balls.centers);
        if arguments.nan {
            centers.iter_mut().zip(&balls.touch).filter(|(_, t)| **t == NO_TOUCH).for_each(|(c, _)| *c = [f32::NAN; 3]);
        }
        centers
    };
    // NO_TOUCH has the bits of -1
    let touch = |balls: &MedialBalls| balls.touch.iter().map(|t| t.cast_signed()).collect::<Vec<i32>>();
    let (coords, inner, outer) =
        (pipeline::file_coordinates(cloud, &cloud.positions), centers(&interior), centers(&exterior));
    let (inner_touch, outer_touch) = (touch(&interior), touch(&exterior));
    let is_input = is_written_back(&arguments.input.clouds, &arguments.output);
    folder.coords = (!is_input).then_some(&coords);
    folder.normals = (!is_input || cloud.attributes.normals.is_none()).then_some(survey.oriented.normals());
    folder.ma_coords_in = Some(&inner);
    folder.ma_coords_out = Some(&outer);
    folder.ma_qidx_in = Some(&inner_touch);
    folder.ma_qidx_out = Some(&outer_touch);
    let (sizes, keep);
    if let Some(spacing) = arguments.simplify {
        sizes = run.stage("feature size", 0, |control| {
            local_feature_size(&cloud.positions, &[&interior, &exterior], &FeatureSizeParams::default(), control)
        })?;
        let params =
            SimplifyParams { spacing, cell_size: arguments.cell_size, seed: global.seed, ..SimplifyParams::default() };
        keep = simplify(&cloud.positions, &sizes, &params)?.into_iter().map(u8::from).collect::<Vec<u8>>();
        let kept = keep.iter().filter(|&&k| k == 1).count();
        run.summary.add("thinning_kept_percent", percent(kept, keep.len()));
        folder.lfs = Some(&sizes);
        folder.decimate_lfs = Some(&keep);
    }
    run.stage("writing", 0, |_| write_masbcpp(&arguments.output, &folder))?;
    Ok(())
}
