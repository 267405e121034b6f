//! `belvedere query`.

mod mesh_targets;

use crate::arguments::{Global, Query, Usage};
use crate::inputs::points::points_of_file;
use crate::inputs::view_obstacles;
use crate::outputs::formats::{check_output, extension, text_rows_for};
use crate::pipeline::{self, KeepPoints, LoadedScene};
use crate::run::CommandContext;
use crate::summary::{Summary, percent, rounded};
use anyhow::{Result, bail};
use belvedere::PointCloud;
use belvedere::apps::ask;
use belvedere::depth::{ItemBuffer, Profile, depth_map};
use belvedere::io::{
    ExtraColumn, ExtraValues, TextRows, UpAxis, WriteReport, is_mesh, write_cloud, write_npy_u8, write_text_rows,
};
use belvedere::model::SceneModel;
use belvedere::query::{
    Answer, AnswerCounts, BlockRule, CertifiedReport, Scope, UnprovenAs, Viewer, query_points, random_targets,
};
use belvedere::view::View;

pub(crate) fn run(arguments: &Query, global: &Global) -> Result<Summary> {
    arguments.view.check()?;
    if let Some(path) = arguments.targets.targets.as_deref().filter(|path| is_mesh(*path)) {
        return mesh_targets::run(arguments, path, global);
    }
    mesh_targets::refuse_flags(&arguments.mesh)?;
    let output = &arguments.output;
    check_output("-o", output, &["csv", "txt", "xyz", "laz", "las", "ply", "npy"])?;
    if arguments.probability && extension(output) == "npy" {
        let output = output.display();
        return Err(Usage(format!("{output}: .npy holds answers only; use another format with --probability")).into());
    }
    let is_central = arguments.view.is_central();
    let profile = arguments.shape.of(&arguments.scene.balls)?;
    if is_central && profile != Profile::Sphere {
        return Err(Usage("--ball-profile: the paper's cone is for parallel views only".to_owned()).into());
    }
    let mut run = CommandContext::new(global);
    let points = if arguments.targets.own { KeepPoints::Keep } else { KeepPoints::LetGo };
    let scene = pipeline::scene(&arguments.scene, points, &mut run)?;
    let wants_pulses = [("--unproven", arguments.unproven.is_some()), ("--probability", arguments.probability)];
    if let Some((flag, _)) = wants_pulses.iter().find(|(_, is_given)| *is_given && scene.model.pulses().is_none()) {
        let what = format!(
            "{flag} needs pulses: a cloud with known scanner positions (see `belvedere info`), or an .npz file from such a cloud"
        );
        return Err(Usage(what).into());
    }
    if arguments.shell.is_some() && !scene.model.is_carved() {
        return Err(Usage("--shell applies only to carved balls, and these are not carved".to_owned()).into());
    }
    run.summary.remarks(ask::remarks_on_model(&scene.model));
    let mut views = arguments.view.views(&scene, &mut run.summary)?;
    if arguments.targets.own && extension(output) == "npy" {
        pipeline::refuse_part(&arguments.scene.input)?;
        pipeline::check_every_row(&scene.left_out)?;
    }
    let rows = rows_as_given(arguments, &scene)?;
    let LoadedScene { model, cloud, .. } = scene;
    let targets = targets(arguments, cloud, model.bounds(), &mut run)?;
    if arguments.view.kind.viewport.is_none() {
        // a view that fits the scene has no plane of its own that a target could lie before
        views = views.iter().map(|view| view.moved_before(&targets.positions)).collect();
    }
    let mut section = Summary::default();
    let mut probabilities = None;
    let answers = if model.is_carved() || is_central {
        let (answers, found) =
            by_lines_of_sight(arguments, &model, &views, &targets.positions, &mut run, &mut section)?;
        probabilities = found;
        answers
    } else {
        let Some(view) = views.first() else { bail!("there is no view") };
        by_depth_map(arguments, &model, view, &targets.positions, &mut run, &mut section)?
    };
    let counts = AnswerCounts::of(&answers);
    run.summary.remarks(ask::remark_on_outside(counts.outside_cloud, answers.len(), "targets"));
    run.summary.remarks(ask::remark_on_targets_beside(model.coverage().as_ref(), &targets.positions, "targets"));
    run.summary.remarks(ask::remark_on_targets_inside(counts.inside_obstacle, answers.len()));
    let unproven_as = arguments.unproven.map_or(UnprovenAs::Reported, UnprovenAs::from);
    let codes: Vec<u8> = answers.iter().map(|&answer| unproven_as.settle(answer) as u8).collect();
    run.summary.add("answers", count_answers(&answers, unproven_as, section));
    let report = run.stage("writing", 0, |_| {
        if extension(output) == "npy" {
            return write_npy_u8(output, &codes).map(|()| WriteReport::default());
        }
        let column = ExtraColumn {
            name: "answer",
            description: "0 no 1 yes 2 ? 3 4 out 5 inside",
            values: ExtraValues::U8(&codes),
        };
        let likely = probabilities.as_deref().map(|values| ExtraColumn {
            name: "probability",
            description: "that it is visible, 0 to 1",
            values: ExtraValues::F32(values),
        });
        let columns: Vec<ExtraColumn<'_>> = [Some(column), likely].into_iter().flatten().collect();
        if let Some(rows) = &rows {
            return write_text_rows(output, rows, &columns).map(|()| WriteReport::default());
        }
        write_cloud(output, &targets, &columns)
    })?;
    run.summary.add_writing(output, &report);
    run.summary
        .headline("visible <answers.visible_percent> % of <answers.targets> targets")
        .headline("blocked: <answers.blocked> targets")
        .headline("unproven: <answers.unproven> targets")
        .headline("inside an obstacle: <answers.inside_obstacle> targets");
    run.summary.add("written", output.display().to_string());
    Ok(run.finish())
}

/// Answers from the depth map of a parallel view, as the paper has them.
fn by_depth_map(
    arguments: &Query,
    model: &SceneModel,
    view: &View,
    targets: &[[f32; 3]],
    run: &mut CommandContext,
    section: &mut Summary,
) -> Result<Vec<Answer>> {
    let profile = arguments.shape.of(&arguments.scene.balls)?;
    // by the CPU: pictures of other devices have a tolerance, answers have none
    let map = run.stage("drawing depth map", 0, |control| {
        depth_map(model.balls(), view, profile, ItemBuffer::Without, control)
    })?;
    let bias = arguments.bias.unwrap_or_else(|| map.default_depth_bias());
    section.add("method", "depth map").add("depth_bias_m", rounded(f64::from(bias), 4));
    let mut answers = run.compute("querying", || query_points(&map, targets, bias));
    if let Some(coverage) = model.coverage() {
        let viewer = Viewer::Direction(view.frame.forward.map(|v| -v));
        coverage.mark_outside(viewer, targets, &mut answers);
    }
    Ok(answers)
}

/// The rows of the targets as they were given, where they go from a table to a table.
fn rows_as_given(arguments: &Query, scene: &LoadedScene) -> Result<Option<TextRows>> {
    let clouds = &arguments.scene.input.clouds;
    match (&arguments.targets.targets, &clouds[..]) {
        (Some(path), _) => text_rows_for(path, &arguments.output),
        (None, [path]) if arguments.targets.own && scene.left_out.left_out_count() == 0 => {
            text_rows_for(path, &arguments.output)
        }
        _ => Ok(None),
    }
}

/// Answers by exact lines of sight, separated into proven and unproven by pulses where these are known; and how likely
/// targets are visible, where that is wanted.
fn by_lines_of_sight(
    arguments: &Query,
    model: &SceneModel,
    views: &[View],
    targets: &[[f32; 3]],
    run: &mut CommandContext,
    section: &mut Summary,
) -> Result<(Vec<Answer>, Option<Vec<f32>>)> {
    let usual = model.rule();
    let depth_bias = arguments.bias.map_or(usual.bias, f64::from);
    let shell = arguments.shell.map_or(usual.shell, f64::from);
    let profile = arguments.shape.of(&arguments.scene.balls)?;
    let rule = BlockRule { profile, bias: depth_bias, shell };
    let unproven_as = arguments.unproven.map_or(UnprovenAs::Reported, UnprovenAs::from);
    let scene = model.scene(&rule, unproven_as, &run.control())?;
    section.add("depth_bias_m", rounded(depth_bias, 4)).add("shell_m", rounded(shell, 4));
    let eye = views.iter().find(|view| view.is_central()).map(|view| view.frame.eye);
    if let Some(eye) = eye {
        section.add("balls_around_eye", scene.around_eye_count(eye));
        run.summary.remarks(ask::remark_on_inside(&scene, eye, "eye"));
    }
    view_obstacles::add_proof(&scene, section);
    // the sun, a direction and a panorama only say from where: without a picture there is nothing beside it
    let has_picture = arguments.view.kind.viewport.is_some() || arguments.view.kind.eye.is_some();
    let scope = if has_picture { Scope::View } else { Scope::Viewer };
    let viewer = eye.map_or(Viewer::Direction([0.0, 0.0, 1.0]), Viewer::Eye);
    let (answers, report) = run.stage("querying", 0, |control| {
        let (mut answers, report) = scene.visible_in_views(views, scope, targets, control)?;
        scene.mark_inside_obstacles(viewer, targets, &mut answers, control).map(|()| (answers, report))
    })?;
    match report {
        None => section.add("method", "lines of sight"),
        Some(CertifiedReport { target_count, settled_count }) => section
            .add("method", "certified depth map and lines of sight")
            .add("decided_by_map_percent", percent(settled_count, target_count)),
    };
    if !arguments.probability {
        return Ok((answers, None));
    }
    run.summary.remarks(ask::remark_from_ground(&scene));
    let forward = views.first().map_or([0.0, 0.0, -1.0], |view| view.frame.forward);
    let viewer = eye.map_or(Viewer::Direction(forward.map(|v| -v)), Viewer::Eye);
    let mut probabilities = run.stage("computing probabilities", targets.len(), |control| {
        scene.visible_probabilities(viewer, targets, control)
    })?;
    // a target beside the picture has no answer, and no probability
    for (probability, _) in probabilities.iter_mut().zip(&answers).filter(|(_, of)| **of == Answer::OutsideView) {
        *probability = f32::NAN;
    }
    Ok((answers, Some(probabilities)))
}

/// Counts the targets for each answer.
fn count_answers(answers: &[Answer], unproven_as: UnprovenAs, how: Summary) -> Summary {
    let settled: Vec<Answer> = answers.iter().map(|&answer| unproven_as.settle(answer)).collect();
    let [raw, counts] = [answers, &settled].map(AnswerCounts::of);
    let mut section = Summary::default();
    section.add("targets", answers.len()).add("visible", counts.visible);
    match unproven_as {
        UnprovenAs::Reported => section.add("unproven", raw.unproven),
        UnprovenAs::Visible | UnprovenAs::Blocked => &mut section,
    };
    section.add("blocked", counts.blocked);
    if unproven_as == UnprovenAs::Blocked {
        section.add("unproven_within", raw.unproven);
    }
    section
        .add("outside_view", counts.outside_view)
        .add("outside_cloud", counts.outside_cloud)
        .add("inside_obstacle", counts.inside_obstacle)
        .add("visible_percent", percent(counts.visible, answers.len()))
        .add_all(how);
    section
}

/// The targets as a cloud in the frame of the scene.
fn targets(
    arguments: &Query,
    scene: PointCloud,
    belvedere::Bounds { low, high }: belvedere::Bounds,
    run: &mut CommandContext,
) -> Result<PointCloud> {
    let frame = |positions| PointCloud { positions, ..PointCloud::in_frame(scene.frame.clone()) };
    if let Some(count) = arguments.targets.random {
        return Ok(frame(run.compute("choosing random targets", || random_targets(low, high, count, run.seed))));
    }
    if let Some(path) = &arguments.targets.targets {
        let whole = arguments.scene.input.clone().whole();
        return points_of_file(path, &whole.read_options().with_up(UpAxis::Z), &scene.frame, run);
    }
    if scene.is_empty() {
        return Err(Usage("--self needs a cloud; a ball file has no points".to_owned()).into());
    }
    Ok(scene)
}
