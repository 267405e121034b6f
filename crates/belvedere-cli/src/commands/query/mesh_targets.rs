//! `belvedere query` for targets that are a mesh.

use crate::arguments::{GivingWay, Global, MeshTargets, Query, Usage};
use crate::inputs::view_obstacles;
use crate::outputs::formats::{check_output, extension};
use crate::pipeline::{self, KeepPoints, LoadedScene, mesh_in};
use crate::run::CommandContext;
use crate::summary::{Summary, rounded};
use anyhow::{Result, bail};
use belvedere::Mesh;
use belvedere::apps::ask;
use belvedere::io::write_mesh_values;
use belvedere::query::{BackFaces, MeshTargetParams, Scope, SeenArea, SurfacePieces, Viewer, seen_faces, seen_in_all};
use belvedere::results::FaceRows;
use belvedere::view::View;
use std::path::Path;

/// Longest side of a piece, metres: the resolution of usual airborne surveys on a wall.
pub(super) const SPACING: f64 = 0.5;

/// Refuses flags of meshes for targets that are points.
pub(super) fn refuse_flags(flags: &MeshTargets) -> Result<()> {
    let given = [("--spacing", flags.spacing.is_some()), ("--back-faces", flags.back_faces.is_some())];
    match given.into_iter().find(|(_, given)| *given) {
        Some((flag, _)) => Err(Usage(format!("{flag} applies only to mesh targets")).into()),
        None => Ok(()),
    }
}

/// Reads a mesh in the coordinates of a scene, as metres.
pub(super) fn mesh_of(path: &Path, scene: &LoadedScene, run: &mut CommandContext) -> Result<Mesh> {
    mesh_in(path, &scene.cloud.frame.crs, run)
}

pub(super) fn run(arguments: &Query, path: &Path, global: &Global) -> Result<Summary> {
    let output = &arguments.output;
    check_output("-o", output, &["csv", "ply"])?;
    if arguments.bias.is_some() {
        return Err(Usage("--bias applies only to point targets; for a mesh use --shell".to_owned()).into());
    }
    let profile = arguments.shape.of(&arguments.scene.balls)?;
    let mut run = CommandContext::new(global);
    let scene = pipeline::scene(&arguments.scene, KeepPoints::LetGo, &mut run)?;
    run.summary.remarks(ask::remarks_on_model(&scene.model));
    let mesh = mesh_of(path, &scene, &mut run)?;
    let views = arguments.view.views(&scene, &mut run.summary)?;
    let giving_way = GivingWay { shell: arguments.shell, unproven: arguments.unproven };
    let (blockers, unproven) = view_obstacles::proving_blockers(&scene, profile, &giving_way, &mut run)?;
    if let Some(view) = views.first().filter(|view| view.is_central()) {
        run.summary.remarks(ask::remark_on_inside(&blockers, view.frame.eye, "eye"));
    }
    let spacing = arguments.mesh.spacing.unwrap_or(SPACING);
    let surface = run
        .stage("sampling mesh", 0, |_| SurfacePieces::of_mesh(&mesh, scene.cloud.frame.origin, spacing, global.seed))?;
    let Some(view) = views.first() else { bail!("there is no view") };
    let viewer = match view.is_central() {
        true => Viewer::Eye(view.frame.eye),
        false => Viewer::Direction(view.frame.forward.map(|v| -v)),
    };
    let has_picture = arguments.view.kind.viewport.is_some() || arguments.view.kind.eye.is_some();
    let scope = if has_picture { Scope::View } else { Scope::Viewer };
    let usual = MeshTargetParams::default();
    let back_faces = arguments.mesh.back_faces.map_or(usual.back_faces, BackFaces::from);
    let params = MeshTargetParams { back_faces, ..usual };
    let faces = run.stage("querying", 0, |control| {
        seen_faces(&surface, viewer, &params, |places| {
            // as for points, a view that fits the scene has no plane that a target could lie before
            let moved = |view: &View| if has_picture { *view } else { view.moved_before(places) };
            let views: Vec<View> = views.iter().map(moved).collect();
            let (answers, _) = blockers.visible_in_views(&views, scope, places, control)?;
            Ok(answers.into_iter().map(|answer| unproven.settle(answer)).collect())
        })
    })?;
    run.summary.add("faces", face_summary(&faces, &surface, spacing));
    let places: Vec<[f32; 3]> = surface.pieces.iter().map(|piece| piece.place).collect();
    let outside = scene.model.coverage().map_or(0, |coverage| coverage.outside_count(&places));
    let things = "sample points of the mesh";
    run.summary.remarks(ask::remark_on_outside(outside, places.len(), things));
    run.summary.remarks(ask::remark_on_targets_beside(scene.model.coverage().as_ref(), &places, things));
    run.stage("writing", 0, |_| match extension(output).as_str() {
        "ply" => {
            let shares: Vec<f64> = faces.iter().map(SeenArea::visible_share).collect();
            let unit = scene.cloud.frame.crs.metres_per_unit_xyz();
            write_mesh_values(output, &mesh, unit, "visible_share", &shares, [0.0, 1.0])
        }
        _ => FaceRows::of_seen(&mesh, &faces).write(output),
    })?;
    run.summary
        .headline("visible <faces.visible_percent> % of <faces.area_m2> m2 on <faces.count> faces (<faces.visible_m2> m2, standard error <faces.standard_error_m2> m2)")
        .headline("unproven: <faces.unproven_m2> m2");
    run.summary.add("written", output.display().to_string());
    Ok(run.finish())
}

fn face_summary(faces: &[SeenArea], surface: &SurfacePieces, spacing: f64) -> Summary {
    let all = seen_in_all(faces);
    let mut section = Summary::default();
    section
        .add("count", faces.len())
        .add("spacing_m", rounded(spacing, 4))
        .add("sample_points", surface.pieces.len())
        .add("area_m2", rounded(all.area, 2))
        .add("visible_m2", rounded(all.visible, 2))
        .add("standard_error_m2", rounded(all.standard_error(), 2))
        .add("visible_percent", rounded(100.0 * all.visible_share(), 2))
        .add("unproven_m2", rounded(all.unproven, 2));
    section
}
