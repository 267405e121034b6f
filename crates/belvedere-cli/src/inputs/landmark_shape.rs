//! The landmark: a mesh, or points of the cloud.

use crate::arguments::{LandmarkShapeArguments, refuse};
use crate::outputs::formats::extension;
use crate::pipeline::{LoadedScene, mesh_in};
use crate::run::CommandContext;
use crate::summary::Summary;
use anyhow::{Result, bail};
use belvedere::apps::ask;
use belvedere::io::{FEATURE_EXTENSIONS, FeatureShape, read_features, read_table};
use belvedere::query::SurfacePieces;
use belvedere::{Frame, Mesh};
use std::path::Path;
use std::sync::Arc;

/// The landmark of the flags, in the frame of a scene.
pub(crate) fn shape(
    arguments: &LandmarkShapeArguments,
    frame: &Frame,
    run: &mut CommandContext,
) -> Result<ask::LandmarkShape> {
    let what = &arguments.what;
    match (&what.target, what.target_class, &what.target_polygon) {
        (Some(path), ..) => {
            let mesh = objects_of(mesh_in(path, &frame.crs, run)?, &arguments.object, path)?;
            let (mesh, spacing, seed) = (Some(Arc::new(mesh)), arguments.spacing, run.seed);
            Ok(ask::LandmarkShape::Mesh { mesh, spacing, seed })
        }
        (None, Some(class), _) => Ok(ask::LandmarkShape::Class(class)),
        (None, None, Some(path)) => Ok(ask::LandmarkShape::Inside { polygons: polygons_of(path, frame)? }),
        (None, None, None) => refuse("the landmark is missing: give --targets, --target-class or --target-polygon"),
    }
}

/// The surface of the landmark, and its middle on the map, local metres.
pub(crate) fn surface(
    arguments: &LandmarkShapeArguments,
    scene: &LoadedScene,
    run: &mut CommandContext,
) -> Result<(SurfacePieces, [f64; 2])> {
    let frame = &scene.cloud.frame;
    let shape = shape(arguments, frame, run)?;
    let (surface, section) = shape.surface(&scene.cloud, frame.origin, &run.control())?;
    run.summary.add("landmark", Summary::of(&section));
    let middle = surface.middle_on_map();
    Ok((surface, middle))
}

/// The triangles of the objects named, all where none is.
pub(crate) fn objects_of(mesh: Mesh, names: &[String], path: &Path) -> Result<Mesh> {
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

/// Polygons of a file, each an outer ring and holes, local metres.
fn polygons_of(path: &Path, frame: &Frame) -> Result<Vec<Vec<Vec<[f64; 2]>>>> {
    let polygons: Vec<Vec<Vec<[f64; 2]>>> = match extension(path).as_str() {
        extension if FEATURE_EXTENSIONS.contains(&extension) => {
            let place = |corner: &[f64; 3]| [corner[0] - frame.origin[0], corner[1] - frame.origin[1]];
            read_features(path, &frame.crs)?
                .into_iter()
                .filter_map(|feature| match feature.shape {
                    FeatureShape::Polygon(rings) => {
                        Some(rings.iter().map(|ring| ring.iter().map(place).collect()).collect())
                    }
                    _ => None,
                })
                .collect()
        }
        "csv" | "txt" => {
            let table = read_table(path)?;
            let (x, y) = (table.full_column(path, "x")?, table.full_column(path, "y")?);
            let on_map = |x: f64, y: f64| {
                let [x, y, _] = frame.local_from_file([x, y, 0.0]);
                [x, y]
            };
            let ring: Vec<[f64; 2]> = x.iter().zip(y).map(|(&x, &y)| on_map(x, y)).collect();
            if ring.len() < 3 {
                bail!("{}: a polygon needs at least three corners, but this one has {}", path.display(), ring.len());
            }
            vec![vec![ring]]
        }
        _ => {
            return refuse(format!("--target-polygon {}: use .geojson .json .gpkg .shp .csv or .txt", path.display()));
        }
    };
    if polygons.is_empty() {
        bail!("{}: the file has no polygon", path.display());
    }
    Ok(polygons)
}
