//! `belvedere query`.

use crate::arguments::{Global, Query, refuse, refuse_given};
use crate::inputs::points::points_of_file;
use crate::outputs::formats::{check_output, extension, text_rows_for};
use crate::pipeline::{self, KeepPoints, mesh_in};
use crate::run::CommandContext;
use crate::summary::Summary;
use anyhow::Result;
use belvedere::PointCloud;
use belvedere::apps::ask::{Answers, HowSure, Places, Scene, ViewTargetsQuestion, ViewTargetsResults};
use belvedere::apps::targets::MeshParams;
use belvedere::depth::Profile;
use belvedere::io::{
    ExtraColumn, ExtraValues, ReadReport, TextRows, UpAxis, WriteReport, is_mesh, write_cloud, write_mesh_values,
    write_npy_u8, write_text_rows,
};
use belvedere::query::{BackFaces, SeenArea, UnprovenAs, random_targets};
use belvedere::results::FaceRows;
use std::path::Path;
use std::sync::Arc;

pub(crate) fn run(arguments: &Query, global: &Global) -> Result<Summary> {
    let mesh = arguments.targets.targets.as_deref().filter(|path| is_mesh(*path));
    let profile = check(arguments, mesh.is_some())?;
    let output = &arguments.output;
    let mut run = CommandContext::new(global);
    let points = if arguments.targets.own { KeepPoints::Keep } else { KeepPoints::LetGo };
    let mut scene = pipeline::scene(&arguments.scene, points, &mut run)?;
    scene.profile = profile;
    if arguments.targets.own && extension(output) == "npy" {
        pipeline::refuse_part(&arguments.scene.input)?;
        pipeline::check_every_row(&scene.left_out)?;
    }
    let rows = rows_as_given(arguments, &scene.left_out)?;
    let own = Arc::clone(&scene.cloud);
    let scene = scene.into_question_scene(None, arguments.shell, &run)?;
    let question = ViewTargetsQuestion {
        from: Some(arguments.view.view_from(&scene, &mut run.summary)?),
        within_picture: arguments.view.kind.viewport.is_some(),
        bias: arguments.bias,
        unproven: arguments.unproven.map(UnprovenAs::from),
        how_sure: HowSure { probability: arguments.probability, certain: None },
        back_faces: arguments.mesh.back_faces.map_or_else(BackFaces::default, BackFaces::from),
    };
    let report = match mesh {
        Some(path) => {
            let mesh = Arc::new(mesh_in(path, &scene.frame().crs, &mut run)?);
            let usual = MeshParams::default().with_seed(run.seed);
            let params = arguments.mesh.spacing.map_or(usual, |spacing| usual.with_spacing(spacing));
            let places = Places::Mesh(Arc::clone(&mesh), params);
            let faces = run.ask(&scene, &question, &places)?.found.faces;
            run.stage("writing", 0, |_| match extension(output).as_str() {
                "ply" => {
                    let shares: Vec<f64> = faces.iter().map(SeenArea::visible_share).collect();
                    let unit = scene.frame().crs.metres_per_unit_xyz();
                    write_mesh_values(output, &mesh, unit, "visible_share", &shares, [0.0, 1.0])
                }
                _ => FaceRows::of_seen(&mesh, &faces).write(output),
            })?;
            WriteReport::default()
        }
        None => {
            let targets = targets(arguments, own, &scene, &mut run)?;
            let answers = run.ask(&scene, &question, &Places::Cloud(Arc::clone(&targets), None))?;
            run.stage("writing", 0, |_| write(output, &answers, &targets, rows.as_ref()))?
        }
    };
    run.summary.add_writing(output, &report);
    run.summary.add("written", output.display().to_string());
    Ok(run.finish())
}

/// Refuses flags that do not belong together, before hours of work go into them; returns the shape of balls.
fn check(arguments: &Query, is_mesh: bool) -> Result<Profile> {
    arguments.view.check()?;
    let (output, mesh) = (&arguments.output, &arguments.mesh);
    let known: &[&str] = if is_mesh { &["csv", "ply"] } else { &["csv", "txt", "xyz", "laz", "las", "ply", "npy"] };
    check_output("-o", output, known)?;
    let profile = arguments.shape.of(&arguments.scene.balls)?;
    if is_mesh {
        refuse_given(&[("--bias", arguments.bias.is_some())], "applies only to point targets; for a mesh use --shell")?;
        return Ok(profile);
    }
    let of_meshes = [("--spacing", mesh.spacing.is_some()), ("--back-faces", mesh.back_faces.is_some())];
    refuse_given(&of_meshes, "applies only to mesh targets")?;
    if arguments.probability && extension(output) == "npy" {
        let output = output.display();
        return refuse(format!("{output}: .npy holds answers only; use another format with --probability"));
    }
    if arguments.view.is_central() && profile != Profile::Sphere {
        return refuse("--ball-profile: the paper's cone is for parallel views only");
    }
    Ok(profile)
}

/// Writes points with their answers, or the answers alone.
fn write(
    output: &Path,
    answers: &Answers<ViewTargetsResults>,
    targets: &PointCloud,
    rows: Option<&TextRows>,
) -> belvedere::Result<WriteReport> {
    let codes: Vec<u8> = answers.found.answers.iter().map(|&answer| answer as u8).collect();
    if extension(output) == "npy" {
        return write_npy_u8(output, &codes).map(|()| WriteReport::default());
    }
    let column =
        ExtraColumn { name: "answer", description: "0 no 1 yes 2 ? 3 4 out 5 inside", values: ExtraValues::U8(&codes) };
    let likely = answers.measures.iter().map(|measure| ExtraColumn {
        name: &measure.name,
        description: "that it is visible, 0 to 1",
        values: ExtraValues::F32(&measure.values),
    });
    let columns: Vec<ExtraColumn<'_>> = std::iter::once(column).chain(likely).collect();
    match rows {
        Some(rows) => write_text_rows(output, rows, &columns).map(|()| WriteReport::default()),
        None => write_cloud(output, targets, &columns),
    }
}

/// The rows of the targets as they were given, where they go from a table to a table.
fn rows_as_given(arguments: &Query, left_out: &ReadReport) -> Result<Option<TextRows>> {
    let clouds = &arguments.scene.input.clouds;
    match (&arguments.targets.targets, &clouds[..]) {
        (Some(path), _) => text_rows_for(path, &arguments.output),
        (None, [path]) if arguments.targets.own && left_out.left_out_count() == 0 => {
            text_rows_for(path, &arguments.output)
        }
        _ => Ok(None),
    }
}

/// The targets as a cloud in the frame of the scene; `own` are the points of the scene as they were read.
fn targets(
    arguments: &Query,
    own: Arc<PointCloud>,
    scene: &Scene,
    run: &mut CommandContext,
) -> Result<Arc<PointCloud>> {
    let frame = scene.frame();
    if let Some(count) = arguments.targets.random {
        let bounds = scene.model().bounds();
        let positions =
            run.compute("choosing random targets", || random_targets(bounds.low, bounds.high, count, run.seed));
        return Ok(Arc::new(PointCloud { positions, ..PointCloud::in_frame(frame.clone()) }));
    }
    if let Some(path) = &arguments.targets.targets {
        let whole = arguments.scene.input.clone().whole();
        return points_of_file(path, &whole.read_options().with_up(UpAxis::Z), frame, run).map(Arc::new);
    }
    if own.is_empty() {
        return refuse("--self needs a cloud; a ball file has no points");
    }
    Ok(own)
}
