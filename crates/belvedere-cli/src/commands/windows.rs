//! Windows: from files to places that are asked.

use super::landmark::what::objects_of;
use super::mesh_targets::{is_mesh, mesh_of};
use crate::arguments::Usage;
use crate::pipeline::Scene;
use crate::run::Run;
use anyhow::{Result, bail};
use belvedere::Frame;
use belvedere::apps::targets::{Targets, Window, objects_of_windows};
use belvedere::apps::viewshed::CELL;
use belvedere::io::{TextRows, read_table};
use std::path::Path;

/// Name, values and decimals.
pub(crate) type Column = (&'static str, Vec<f64>, usize);

/// Windows, and what else is known of them.
pub(crate) struct Windows {
    /// A group for each window.
    pub(crate) targets: Targets,
    pub(crate) windows: Vec<Window>,
    /// Where and what each window is.
    pub(crate) columns: Vec<Column>,
    /// What the object of each is called; empty where nothing is.
    pub(crate) names: Vec<String>,
    /// The rows of a table of windows.
    pub(crate) given: TextRows,
}

/// Which faces of a mesh are windows, and how they are cut.
pub(crate) struct FaceChoice<'a> {
    /// Longest side of a piece, metres.
    pub(crate) spacing: Option<f64>,
    /// Names of objects; all where none is named.
    pub(crate) objects: &'a [String],
}

/// Windows of a table, or the faces of a mesh. `grid_north` is the azimuth of grid north, radians.
pub(crate) fn windows(
    path: &Path,
    choice: &FaceChoice<'_>,
    (scene, grid_north): (&Scene, f64),
    run: &mut Run,
) -> Result<Windows> {
    if is_mesh(path) {
        return faces(path, choice, (scene, grid_north), run);
    }
    for (flag, is_given) in [("--spacing", choice.spacing.is_some()), ("--object", !choice.objects.is_empty())] {
        if is_given {
            return Err(Usage(format!("{flag} applies only to windows from a mesh")).into());
        }
    }
    if !["csv", "txt"].contains(&super::extension(path).as_str()) {
        bail!("{}: windows are a table (.csv .txt) or a mesh (.obj .json .ply with faces)", path.display());
    }
    let table = read_table(path)?;
    let full = |name: &str| table.full_column(path, name);
    let (x, y, z, azimuth) = (full("x")?, full("y")?, full("z")?, full("azimuth")?);
    let optional = |name: &str| -> Result<Vec<f64>> {
        let column = table.column(path, name)?;
        Ok((0..table.row_count()).map(|row| column.and_then(|c| c.get(row)).copied().unwrap_or(f64::NAN)).collect())
    };
    let (tilt, width, height) = (optional("tilt")?, optional("width")?, optional("height")?);
    if table.row_count() == 0 {
        bail!("{}: the file has no window", path.display());
    }
    let mut windows = Vec::with_capacity(table.row_count());
    for row in 0..table.row_count() {
        let tilt = if tilt[row].is_nan() { 90.0 } else { tilt[row] };
        if !(0.0..=180.0).contains(&tilt) {
            bail!("{}: row {}: the tilt is {tilt}, but must be 0 (facing up) to 180 degrees", path.display(), row + 1);
        }
        let size = [width[row], height[row]];
        let size = size.iter().all(|v| v.is_finite()).then_some(size);
        let center = scene.cloud.frame.local_from_file([x[row], y[row], z[row]]);
        windows.push(Window::new(center, azimuth[row].to_radians() - grid_north, tilt.to_radians(), size));
    }
    let targets = Targets::of_windows(&windows, scene.cloud.frame.clone())
        .map_err(|(row, error)| anyhow::anyhow!("{}: row {}: {error}", path.display(), row + 1))?;
    let tilts = tilt.iter().map(|&tilt| if tilt.is_nan() { 90.0 } else { tilt }).collect();
    let columns = vec![
        ("x", x.to_vec(), 3),
        ("y", y.to_vec(), 3),
        ("z", z.to_vec(), 3),
        ("azimuth", azimuth.to_vec(), 2),
        ("tilt", tilts, 2),
    ];
    Ok(Windows { targets, windows, columns, names: Vec::new(), given: table.into_text() })
}

fn faces(path: &Path, choice: &FaceChoice<'_>, (scene, grid_north): (&Scene, f64), run: &mut Run) -> Result<Windows> {
    let mesh = objects_of(mesh_of(path, scene, run)?, choice.objects, path)?;
    let spacing = choice.spacing.unwrap_or(CELL);
    let (targets, windows) = Targets::of_window_faces(&mesh, &scene.cloud.frame, spacing, run.seed)?;
    let centers: Vec<[f64; 3]> = windows.iter().map(|window| window.center).collect();
    let column = |of: &dyn Fn(&Window) -> f64| -> Vec<f64> { windows.iter().map(of).collect() };
    let mut columns = vec![("face", column(&|window| window.face.map_or(f64::NAN, f64::from)), 0)];
    columns.extend(coordinates(&scene.cloud.frame, &centers));
    columns.extend([
        ("azimuth", column(&|window| (window.azimuth + grid_north).to_degrees().rem_euclid(360.0)), 2),
        ("tilt", column(&|window| window.tilt.to_degrees()), 2),
        ("area_m2", column(&|window| window.area.unwrap_or(f64::NAN)), 4),
    ]);
    let names = objects_of_windows(&windows, &mesh);
    Ok(Windows { targets, windows, columns, names, given: TextRows::default() })
}

/// Coordinates of the file.
pub(crate) fn coordinates(frame: &Frame, places: &[[f64; 3]]) -> Vec<Column> {
    let of_file: Vec<[f64; 3]> = places.iter().map(|&place| frame.file_from_local(place)).collect();
    let axis = |i: usize| of_file.iter().map(|place| place[i]).collect();
    vec![("x", axis(0), 3), ("y", axis(1), 3), ("z", axis(2), 3)]
}
