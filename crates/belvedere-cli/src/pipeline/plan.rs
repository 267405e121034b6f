//! Flags of what is planned: a scene as it will be.

use super::loaded_scene::LoadedScene;
use crate::arguments::{AreaChoice, PlanArguments};
use crate::run::CommandContext;
use crate::summary::Summary;
use anyhow::{Result, bail};
use belvedere::apps::ask::{remark_on_cleared, remark_on_faces};
use belvedere::crs::Crs;
use belvedere::io::{FeatureShape, read_features, read_mesh_in};
use belvedere::model::{ClearReport, ClearedArea, SceneModel};
use belvedere::{Frame, Mesh};
use std::path::Path;
use std::sync::Arc;

/// Clears areas of a scene that has its points.
pub(super) fn clear(scene: &mut LoadedScene, plan: &PlanArguments, run: &mut CommandContext) -> Result<()> {
    if scene.cloud.is_empty() {
        bail!("--clear needs points, and a ball file has none: give the cloud that it was made from");
    }
    let mut sum = ClearReport::default();
    for area in plan.clear.iter().map(|choice| areas(choice, scene.model.frame())).collect::<Result<Vec<_>>>()?.concat()
    {
        let model = std::mem::take(&mut scene.model);
        let cleared = run.stage("clearing", 0, |control| model.without(&area, &scene.cloud, control));
        let (model, cloud, report) = cleared?;
        (scene.model, scene.cloud) = (model, Arc::new(cloud));
        scene.ground_store = None;
        sum.points_cleared += report.points_cleared;
        sum.balls_cleared += report.balls_cleared;
        sum.balls_cut += report.balls_cut;
        sum.ground_balls_added += report.ground_balls_added;
        sum.patches_cleared_m2 += report.patches_cleared_m2;
    }
    run.summary.remarks(remark_on_cleared(sum.points_cleared));
    run.summary.add("cleared", Summary::of(&sum));
    Ok(())
}

/// The areas that were typed, local metres.
pub(crate) fn areas(choice: &AreaChoice, frame: &Frame) -> Result<Vec<ClearedArea>> {
    let path = match choice {
        AreaChoice::Class(class) => return Ok(vec![ClearedArea::Class(*class)]),
        AreaChoice::Box([x0, y0, x1, y1]) => {
            let corners = [[x0, y0], [x1, y0], [x1, y1], [x0, y1]];
            let local = corners.map(|[x, y]| {
                let [x, y, _] = frame.local_from_file([*x, *y, 0.0]);
                [x, y]
            });
            return Ok(vec![ClearedArea::Polygon(vec![local.to_vec()])]);
        }
        AreaChoice::File(path) => path,
    };
    let local = |ring: &Vec<[f64; 3]>| ring.iter().map(|c| [c[0] - frame.origin[0], c[1] - frame.origin[1]]).collect();
    let polygons = read_features(path, &frame.crs)?.into_iter().filter_map(|feature| match feature.shape {
        FeatureShape::Polygon(rings) => Some(rings.iter().map(local).collect()),
        _ => None,
    });
    let areas = ClearedArea::of_polygons(polygons.collect());
    if areas.is_empty() {
        bail!("{}: no polygon to clear is in the file", path.display());
    }
    Ok(areas)
}

/// The model of a scene as it will be.
pub(crate) fn planned(mut model: SceneModel, plan: &PlanArguments, run: &mut CommandContext) -> Result<SceneModel> {
    if plan.add.is_empty() {
        return Ok(model);
    }
    let mut triangle_count = 0;
    for path in &plan.add {
        let (mesh, read) = run.aside(|run| mesh_in(path, &model.frame().crs, run));
        run.summary.add_all(read.only_remarks());
        let mesh = mesh?;
        triangle_count += mesh.triangles.len();
        model = model.with_added(&mesh, &path.display().to_string())?;
    }
    let mut section = Summary::default();
    section.add("meshes_added", plan.add.len()).add("triangles", triangle_count);
    run.summary.add("plan", section);
    Ok(model)
}

/// Reads a mesh in the coordinates of a reference system, as metres.
pub(crate) fn mesh_in(path: &Path, crs: &Crs, run: &mut CommandContext) -> Result<Mesh> {
    let (mesh, report) = run.stage("reading mesh", 0, |_| read_mesh_in(path, crs))?;
    let mut section = Summary::default();
    section
        .add("triangles", mesh.triangles.len())
        .add("objects", mesh.object_names.len())
        .add("triangles_without_area", report.degenerate_triangle_count);
    run.summary.add("mesh", section);
    run.summary.remarks(remark_on_faces(&path.display().to_string(), report.repeated_polygon_count));
    Ok(mesh)
}
