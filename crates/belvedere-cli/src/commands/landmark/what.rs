//! The landmark: a mesh, or points of the cloud.

use crate::arguments::{LandmarkShape, Usage};
use crate::commands::extension;
use crate::commands::mesh_targets::mesh_of;
use crate::pipeline::Scene;
use crate::run::Run;
use crate::summary::{Summary, rounded};
use anyhow::{Result, bail};
use belvedere::Mesh;
use belvedere::apps::landmark::{LandmarkPoints, landmark_points, spacing_for};
use belvedere::io::{Shape, read_geojson, read_table};
use belvedere::query::SurfacePieces;
use std::path::Path;

/// The surface of the landmark, and its middle on the map, local metres.
pub(in crate::commands) fn surface(
    arguments: &LandmarkShape,
    scene: &Scene,
    run: &mut Run,
) -> Result<(SurfacePieces, [f64; 2])> {
    let mut section = Summary::default();
    let surface = if let Some(path) = &arguments.what.target {
        let mesh = objects_of(mesh_of(path, scene, run)?, &arguments.object, path)?;
        let spacing = arguments.spacing.unwrap_or_else(|| spacing_for(mesh.area()));
        section.add("triangles", mesh.triangles.len()).add("spacing_m", rounded(spacing, 3));
        let surface = run
            .stage("sampling mesh", 0, |_| SurfacePieces::of_mesh(&mesh, scene.cloud.frame.origin, spacing, run.seed));
        surface?
    } else {
        if scene.cloud.is_empty() {
            let what = "a ball file has no points for a landmark: give the cloud, or a mesh with --targets";
            return Err(Usage(what.to_owned()).into());
        }
        let polygons;
        let which = match (arguments.what.target_class, &arguments.what.target_polygon) {
            (Some(class), _) => LandmarkPoints::Class(class),
            (None, Some(path)) => {
                polygons = polygons_of(path, scene)?;
                LandmarkPoints::Inside(&polygons)
            }
            (None, None) => {
                return Err(Usage(
                    "the landmark is missing: give --targets, --target-class or --target-polygon".to_owned(),
                )
                .into());
            }
        };
        let (rows, surface) = run.stage("selecting landmark", 0, |_| landmark_points(&scene.cloud, &which))?;
        section.add("points", rows.len());
        surface
    };
    section.add("sample_points", surface.pieces.len()).add("area_m2", rounded(surface.area(), 2));
    run.summary.add("landmark", section);
    let middle = surface.middle_on_map();
    Ok((surface, middle))
}

/// The triangles of the objects named, all where none is.
pub(in crate::commands) fn objects_of(mesh: Mesh, names: &[String], path: &Path) -> Result<Mesh> {
    if names.is_empty() {
        return Ok(mesh);
    }
    if let Some(name) = names.iter().find(|name| !mesh.object_names.contains(name)) {
        let some: Vec<&str> = mesh.object_names.iter().take(8).map(String::as_str).collect();
        bail!(
            "{}: there is no object {name}; it has {} objects, such as {}",
            path.display(),
            mesh.object_names.len(),
            some.join(", ")
        );
    }
    Ok(mesh.of_objects(names))
}

/// Polygons of a file, each a rim and holes, local metres.
fn polygons_of(path: &Path, scene: &Scene) -> Result<Vec<Vec<Vec<[f64; 2]>>>> {
    let cloud = &scene.cloud;
    let polygons: Vec<Vec<Vec<[f64; 2]>>> = match extension(path).as_str() {
        "geojson" | "json" | "gpkg" | "shp" => {
            let place = |corner: &[f64; 3]| [corner[0] - cloud.frame.origin[0], corner[1] - cloud.frame.origin[1]];
            read_geojson(path, &cloud.frame.crs)?
                .into_iter()
                .filter_map(|feature| match feature.shape {
                    Shape::Polygon(rings) => Some(rings.iter().map(|ring| ring.iter().map(place).collect()).collect()),
                    _ => None,
                })
                .collect()
        }
        "csv" | "txt" => {
            let table = read_table(path)?;
            let (x, y) = (table.full_column(path, "x")?, table.full_column(path, "y")?);
            let ring: Vec<[f64; 2]> = x.iter().zip(y).map(|(&x, &y)| super::on_map_of(cloud, [x, y])).collect();
            if ring.len() < 3 {
                bail!("{}: a polygon needs at least three corners, but this one has {}", path.display(), ring.len());
            }
            vec![vec![ring]]
        }
        _ => return Err(Usage(format!("--target-polygon {}: use .geojson .json .csv or .txt", path.display())).into()),
    };
    if polygons.is_empty() {
        bail!("{}: the file has no polygon", path.display());
    }
    Ok(polygons)
}
