//! Targets of cameras and private places, from flags and files to a question.

use crate::arguments::{CameraTargetsArguments, refuse};
use crate::inputs::observers::{ObserverUse, observer_rows};
use crate::inputs::points::points_of_file;
use crate::outputs::formats::extension;
use crate::pipeline::mesh_in;
use crate::run::CommandContext;
use anyhow::{Result, bail};
use belvedere::Frame;
use belvedere::apps::ask::{self, GridCells, Places, PrivatePlaces, Standing};
use belvedere::apps::cameras::WeightedArea;
use belvedere::apps::targets::MeshParams;
use belvedere::io::{FeatureShape, ReadOptions, RowsAre, holds_polygons, is_mesh, property, read_features};
use std::path::Path;
use std::sync::Arc;

/// Content of a file of targets.
enum TargetFileKind {
    Areas,
    Places,
    Mesh,
    Cloud,
}

/// The type of a file. Features with polygons are areas.
fn kind(path: &Path) -> TargetFileKind {
    match extension(path).as_str() {
        // a file that cannot be read is refused where it is read
        "geojson" | "gpkg" | "shp" if holds_polygons(path).unwrap_or(false) => TargetFileKind::Areas,
        "geojson" | "gpkg" | "shp" => TargetFileKind::Places,
        "csv" | "txt" => TargetFileKind::Places,
        _ if is_mesh(path) => TargetFileKind::Mesh,
        _ => TargetFileKind::Cloud,
    }
}

/// Returns true if targets are cells.
pub(super) fn are_cells(flags: &CameraTargetsArguments) -> bool {
    flags.targets.as_deref().is_none_or(|path| matches!(kind(path), TargetFileKind::Areas))
}

/// Refuses flags of other targets.
pub(super) fn check(flags: &CameraTargetsArguments, are_cells: bool) -> Result<()> {
    if flags.cell.is_some() && !are_cells {
        return refuse("--cell applies only to targets that are cells: polygons, or no --targets");
    }
    if flags.spacing.is_some() && !flags.targets.as_deref().is_some_and(is_mesh) {
        return refuse("--spacing applies only to mesh targets");
    }
    Ok(())
}

/// Returns the targets: places, or additions to `targets`.
pub(super) fn places(
    flags: &CameraTargetsArguments,
    frame: &Frame,
    targets: &mut ask::CameraTargets,
    run: &mut CommandContext,
) -> Result<Places> {
    let cells = || Places::Cells(GridCells { cell: flags.cell, ..GridCells::default() });
    match flags.targets.as_deref().map(|path| (path, kind(path))) {
        None => Ok(cells()),
        Some((path, TargetFileKind::Areas)) => {
            targets.areas = areas(path, frame)?;
            Ok(cells())
        }
        Some((path, TargetFileKind::Places)) => {
            (targets.points, targets.weights) = points(path, frame, run)?;
            Ok(Places::Scene)
        }
        Some((path, TargetFileKind::Mesh)) => {
            let mesh = mesh_in(path, &frame.crs, run)?;
            let usual = MeshParams::default().with_seed(run.seed);
            let params = flags.spacing.map_or(usual, |spacing| usual.with_spacing(spacing));
            Ok(Places::Mesh(Arc::new(mesh), params))
        }
        Some((path, TargetFileKind::Cloud)) => {
            let cloud = points_of_file(path, &ReadOptions::new(), frame, run)?;
            let normals = cloud.attributes.normals.clone();
            Ok(Places::Cloud(Arc::new(cloud), normals))
        }
    }
}

/// The places that no camera may see.
pub(super) fn private(path: &Path, frame: &Frame, run: &mut CommandContext) -> Result<PrivatePlaces> {
    match kind(path) {
        TargetFileKind::Areas => Ok(PrivatePlaces::Areas(areas(path, frame)?)),
        TargetFileKind::Places => Ok(PrivatePlaces::Points(points(path, frame, run)?.0)),
        _ => {
            let path = path.display();
            refuse(format!("--private {path}: use points (.csv .geojson .gpkg .shp) or polygons (.geojson .gpkg .shp)"))
        }
    }
}

/// The polygons of a file with their weights.
fn areas(path: &Path, frame: &Frame) -> Result<Vec<WeightedArea>> {
    let on_map = |corner: &[f64; 3]| [corner[0] - frame.origin[0], corner[1] - frame.origin[1]];
    let mut found = Vec::new();
    for feature in read_features(path, &frame.crs)? {
        let FeatureShape::Polygon(rings) = feature.shape else {
            bail!("{}: use polygons, or points, but not both in one file", path.display());
        };
        let weight = match property(&feature.properties, "weight") {
            None => 1.0,
            Some(value) => match value.as_f64() {
                Some(weight) => weight,
                None => bail!("{}: the weight {value} must be a number, 0 or more", path.display()),
            },
        };
        let rings = rings.iter().map(|ring| ring.iter().map(on_map).collect()).collect();
        found.push(WeightedArea { rings, weight });
    }
    Ok(found)
}

/// The points of a file, and the weight of each.
fn points(path: &Path, frame: &Frame, run: &mut CommandContext) -> Result<(Vec<Standing>, Vec<f64>)> {
    let (mut points, mut weights) = (Vec::new(), Vec::new());
    for row in observer_rows(path, frame, RowsAre::Places, ObserverUse::Places, run)? {
        for &place in &row.corners {
            points.push(Standing { place, height: row.height });
            weights.push(row.weight.unwrap_or(1.0));
        }
    }
    Ok((points, weights))
}
