//! What cameras are to cover, and what they must not see: from flags and files to targets.

use crate::arguments::{CameraTargets, Usage};
use crate::commands::extension;
use crate::commands::mesh_targets::{is_mesh, mesh_of};
use crate::commands::query::points_of_file;
use crate::commands::sights::leave_out_outside;
use crate::pipeline::Scene;
use crate::run::Run;
use crate::summary::Summary;
use anyhow::{Result, bail};
use belvedere::PointCloud;
use belvedere::apps::cameras::{CAMERA_TARGET_HEIGHT, WeightedArea, keep_within};
use belvedere::apps::targets::{CellParams, MeshParams, Targets, set_on_ground};
use belvedere::ground::Ground;
use belvedere::io::{RowsAre, Shape, read_geojson, read_observers};
use std::path::Path;

/// The scene, with the cloud that its ground comes from.
pub(super) struct Site<'a> {
    pub(super) scene: &'a Scene,
    pub(super) cloud: &'a PointCloud,
    pub(super) ground: &'a Ground,
}

/// What a file of targets holds.
enum Kind {
    Areas,
    Places,
    Mesh,
    Cloud,
}

/// The type of a file. GeoJSON with polygons holds areas.
fn kind(path: &Path) -> Kind {
    match extension(path).as_str() {
        "geojson" => {
            let text = std::fs::read_to_string(path).unwrap_or_default();
            if text.contains("Polygon\"") { Kind::Areas } else { Kind::Places }
        }
        "csv" | "txt" => Kind::Places,
        _ if is_mesh(path) => Kind::Mesh,
        _ => Kind::Cloud,
    }
}

/// Whether targets are cells.
pub(super) fn are_cells(flags: &CameraTargets) -> bool {
    flags.targets.as_deref().is_none_or(|path| matches!(kind(path), Kind::Areas))
}

/// Refuses flags of other targets.
pub(super) fn check(flags: &CameraTargets, are_cells: bool) -> Result<()> {
    if flags.cell.is_some() && !are_cells {
        return Err(Usage("--cell applies only to targets that are cells: polygons, or no --targets".to_owned()).into());
    }
    if flags.spacing.is_some() && !flags.targets.as_deref().is_some_and(is_mesh) {
        return Err(Usage("--spacing applies only to mesh targets".to_owned()).into());
    }
    Ok(())
}

/// The targets of the flags.
pub(super) fn targets(flags: &CameraTargets, site: &Site<'_>, run: &mut Run) -> Result<Targets> {
    let frame = &site.scene.cloud.frame;
    let mut targets = match flags.targets.as_deref().map(|path| (path, kind(path))) {
        None => cells(flags, site)?,
        Some((path, Kind::Areas)) => {
            let mut targets = cells(flags, site)?;
            keep_within(&mut targets, &areas(path, site)?);
            targets
        }
        Some((path, Kind::Places)) => places(path, flags, site)?,
        Some((path, Kind::Mesh)) => {
            let mesh = mesh_of(path, site.scene, run)?;
            let usual = MeshParams::default().with_seed(run.seed);
            let params = flags.spacing.map_or(usual, |spacing| usual.with_spacing(spacing));
            Targets::of_mesh(&mesh, frame, &params)?
        }
        Some((path, Kind::Cloud)) => {
            let cloud = points_of_file(path, None, frame, run)?;
            Targets::of_points(&cloud, cloud.attributes.normals.clone())
        }
    };
    leave_out_outside(&mut targets, site.scene, &mut run.summary);
    if targets.asked_count() == 0 {
        bail!("no target is left: are --targets in the coordinates of the cloud, on known ground?");
    }
    run.summary.add("targets", targets.asked_count());
    Ok(targets)
}

/// The places that no camera may see.
pub(super) fn private(path: &Path, flags: &CameraTargets, site: &Site<'_>, summary: &mut Summary) -> Result<Targets> {
    let targets = match kind(path) {
        Kind::Areas => {
            let mut targets = cells(flags, site)?;
            keep_within(&mut targets, &areas(path, site)?);
            targets
        }
        Kind::Places => places(path, flags, site)?,
        _ => {
            let path = path.display();
            return Err(Usage(format!("--private {path}: use points (.csv .geojson) or polygons (.geojson)")).into());
        }
    };
    if targets.asked_count() == 0 {
        let path = path.display();
        bail!("{path}: no private place is left; is it in the coordinates of the cloud, and larger than a --cell?");
    }
    summary.add("private_places", targets.asked_count());
    Ok(targets)
}

fn height(flags: &CameraTargets) -> f64 {
    flags.target_height.unwrap_or(CAMERA_TARGET_HEIGHT)
}

/// The cells of the ground that are not under a roof.
fn cells(flags: &CameraTargets, site: &Site<'_>) -> Result<Targets> {
    let params = CellParams::default().with_height(height(flags));
    let control = belvedere::control::Control::none();
    let (mut targets, _) = Targets::of_cells(site.cloud, site.ground.clone(), &params, &control)?;
    if let Some(added) = site.scene.model.added() {
        targets.set_on_added(added, &params);
    }
    Ok(targets)
}

/// The polygons of a file with their weights.
fn areas(path: &Path, site: &Site<'_>) -> Result<Vec<WeightedArea>> {
    let frame = &site.scene.cloud.frame;
    let on_map = |corner: &[f64; 3]| [corner[0] - frame.origin[0], corner[1] - frame.origin[1]];
    let mut found = Vec::new();
    for feature in read_geojson(path, &frame.crs)? {
        let Shape::Polygon(rings) = feature.shape else {
            bail!("{}: use polygons, or points, but not both in one file", path.display());
        };
        let weight = match feature.properties.get("weight") {
            None => 1.0,
            Some(value) => match value.as_f64().filter(|weight| *weight >= 0.0) {
                Some(weight) => weight,
                None => bail!("{}: the weight {value} must be a number, 0 or more", path.display()),
            },
        };
        let rings = rings.iter().map(|ring| ring.iter().map(on_map).collect()).collect();
        found.push(WeightedArea { rings, weight });
    }
    Ok(found)
}

/// The points of a file with their weights.
fn places(path: &Path, flags: &CameraTargets, site: &Site<'_>) -> Result<Targets> {
    let frame = &site.scene.cloud.frame;
    let (mut positions, mut heights, mut weights): (Vec<[f64; 3]>, Vec<f64>, Vec<f64>) = Default::default();
    for row in read_observers(path, &frame.crs, RowsAre::Places)? {
        for corner in &row.corners {
            positions.push(std::array::from_fn(|i| corner[i] - frame.origin[i]));
            heights.push(row.height.unwrap_or(height(flags)));
            weights.push(row.weight.unwrap_or(1.0));
        }
    }
    if let Some(bad) = weights.iter().find(|weight| !(**weight >= 0.0 && weight.is_finite())) {
        bail!("{}: the weight {bad} must be a number, 0 or more", path.display());
    }
    set_on_ground(positions.iter_mut().zip(heights), site.ground);
    let targets = Targets::of_places(&positions, frame.clone());
    Ok(Targets { weights, ..targets })
}
