//! Flags of what is planned: a scene as it will be.

use crate::arguments::Plan;
use crate::progress::Stages;
use crate::summary::Summary;
use anyhow::{Result, bail};
use belvedere::Mesh;
use belvedere::crs::Crs;
use belvedere::io::read_mesh;
use belvedere::model::SceneModel;
use std::path::Path;

/// The model of a scene as it will be.
pub(crate) fn planned(
    mut model: SceneModel,
    plan: &Plan,
    stages: &mut Stages,
    summary: &mut Summary,
) -> Result<SceneModel> {
    if plan.add.is_empty() {
        return Ok(model);
    }
    let mut triangle_count = 0;
    for path in &plan.add {
        let mesh = mesh_in(path, &model.frame().crs, stages, &mut Summary::default())?;
        triangle_count += mesh.triangles.len();
        model = super::flagged("--add", model.with_added(&mesh, &path.display().to_string()))?;
    }
    let mut section = Summary::default();
    section.add("meshes_added", plan.add.len()).add("triangles", triangle_count);
    summary.add("plan", section);
    Ok(model)
}

/// Reads a mesh in the coordinates of a reference system, as metres.
pub(crate) fn mesh_in(path: &Path, crs: &Crs, stages: &mut Stages, summary: &mut Summary) -> Result<Mesh> {
    let (mesh, report) = stages.run("reading mesh", 0, |_| read_mesh(path))?;
    if mesh.crs.contradicts(crs) {
        bail!(
            "{}: the mesh is in {}, but the scene is in {}; convert one of them",
            path.display(),
            mesh.crs.describe(),
            crs.describe()
        );
    }
    let mut section = Summary::default();
    section
        .add("triangles", mesh.triangles.len())
        .add("objects", mesh.object_names.len())
        .add("triangles_without_area", report.degenerate_triangle_count);
    summary.add("mesh", section);
    Ok(mesh.scaled_to_metres(crs))
}
