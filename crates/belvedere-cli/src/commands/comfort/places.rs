//! Routes and windows: from flags and files to places that are asked.

use crate::arguments::{Comfort, Corners, Usage};
use crate::commands::mesh_targets::{is_mesh, mesh_of};
use crate::commands::shapes::{TypedAre, shapes, wrong_shape};
use crate::commands::sights::{ground, ground_cloud};
use crate::pipeline::{Scene, flagged};
use crate::progress::Stages;
use crate::summary::Summary;
use anyhow::{Result, bail};
use belvedere::Frame;
use belvedere::apps::exposure::{ROUTE_STEP, WALKER_HEIGHT};
use belvedere::apps::targets::{Route, Targets, Window, grid_around, set_on_ground};
use belvedere::apps::viewshed::{CELL, places_along};
use belvedere::io::{Shape, TextRows, read_table};
use std::path::Path;

/// Name, values and decimals.
pub(super) type Column = (&'static str, Vec<f64>, usize);

/// Targets on routes or windows, and what else is known of them.
pub(super) struct Places {
    pub(super) targets: Targets,
    /// Where each place lies.
    pub(super) place_columns: Vec<Column>,
    /// Where and what each route or window is.
    pub(super) group_columns: Vec<Column>,
    /// What each is called; empty where nothing is.
    pub(super) names: Vec<String>,
    /// The rows of a table of windows.
    pub(super) given: TextRows,
    /// What groups are.
    pub(super) kind: &'static str,
    /// Column of their numbers.
    pub(super) row_name: &'static str,
}

/// Places along routes.
pub(super) fn routes(
    arguments: &Comfort,
    route: &Corners,
    scene: &mut Scene,
    stages: &mut Stages,
    summary: &mut Summary,
) -> Result<Places> {
    let step = arguments.route_step.unwrap_or(ROUTE_STEP);
    let height = arguments.height.map_or(WALKER_HEIGHT, f64::from);
    let (mut routes, mut names) = (Vec::new(), Vec::new());
    for named in shapes("--route", route, TypedAre::Line, &scene.cloud)? {
        let Shape::Line(corners) = named.shape else {
            return wrong_shape("--route", route, "a route is a line, but this file has a point or a polygon");
        };
        if corners.len() < 2 {
            return wrong_shape("--route", route, "a route needs at least two corners");
        }
        routes.push(Route { places: flagged("--distance-step-m", places_along(&corners, step))? });
        names.push(named.name);
    }
    let places = || routes.iter().flat_map(|route| route.places.iter().copied());
    let count = places().count();
    if let Some(grid) = flagged("--route", grid_around(places(), scene.cloud.frame.origin))? {
        let (cloud, points) = ground_cloud(&arguments.ground, scene, stages)?;
        let ground = ground(&cloud, points, grid, stages, summary)?;
        let all = routes.iter_mut().flat_map(|route| &mut route.places).map(|place| (place, height));
        let unknown = set_on_ground(all, &ground).len();
        if unknown == count {
            bail!("--route: the ground below it is unknown; is the route in the coordinates of the cloud?");
        }
        if unknown > 0 {
            let note = format!("{unknown} targets on routes have no known ground below them, and no values");
            summary.add("notes", vec![note]);
        }
    }
    let places: Vec<[f64; 3]> = routes.iter().flat_map(|route| route.places.iter().copied()).collect();
    let frame = &scene.cloud.frame;
    let mut place_columns = vec![("distance_m", routes.iter().flat_map(Route::distances).collect(), 2)];
    place_columns.extend(coordinates(frame, &places));
    Ok(Places {
        targets: Targets::along_routes(&routes, frame.clone()),
        place_columns,
        group_columns: vec![("length_m", routes.iter().map(Route::length).collect(), 2)],
        names,
        given: TextRows::default(),
        kind: "routes",
        row_name: "route",
    })
}

/// Windows of a table, or the faces of a mesh. `grid_north` is the azimuth of grid north, radians.
pub(super) fn windows(
    arguments: &Comfort,
    path: &Path,
    (scene, grid_north): (&Scene, f64),
    seed: u64,
    stages: &mut Stages,
    summary: &mut Summary,
) -> Result<Places> {
    if is_mesh(path) {
        return faces(arguments, path, (scene, grid_north), seed, stages, summary);
    }
    if arguments.spacing.is_some() {
        return Err(Usage("--spacing applies only to windows from a mesh".to_owned()).into());
    }
    if !["csv", "txt"].contains(&crate::commands::extension(path).as_str()) {
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
    let group_columns = vec![
        ("x", x.to_vec(), 3),
        ("y", y.to_vec(), 3),
        ("z", z.to_vec(), 3),
        ("azimuth", azimuth.to_vec(), 2),
        ("tilt", tilts, 2),
    ];
    Ok(Places { given: table.into_text(), ..of_windows(targets, group_columns, Vec::new()) })
}

fn faces(
    arguments: &Comfort,
    path: &Path,
    (scene, grid_north): (&Scene, f64),
    seed: u64,
    stages: &mut Stages,
    summary: &mut Summary,
) -> Result<Places> {
    let mesh = mesh_of(path, scene, stages, summary)?;
    let spacing = arguments.spacing.unwrap_or(CELL);
    let (targets, windows) = flagged("--spacing", Targets::of_window_faces(&mesh, &scene.cloud.frame, spacing, seed))?;
    let centers: Vec<[f64; 3]> = windows.iter().map(|window| window.center).collect();
    let column = |of: &dyn Fn(&Window) -> f64| -> Vec<f64> { windows.iter().map(of).collect() };
    let mut group_columns = vec![("face", column(&|window| window.face.map_or(f64::NAN, f64::from)), 0)];
    group_columns.extend(coordinates(&scene.cloud.frame, &centers));
    group_columns.extend([
        ("azimuth", column(&|window| (window.azimuth + grid_north).to_degrees().rem_euclid(360.0)), 2),
        ("tilt", column(&|window| window.tilt.to_degrees()), 2),
        ("area_m2", column(&|window| window.area.unwrap_or(f64::NAN)), 4),
    ]);
    let name = |window: &Window| {
        let object = window.face.and_then(|face| mesh.objects.get(face as usize));
        object.and_then(|&object| mesh.object_names.get(object as usize)).cloned().unwrap_or_default()
    };
    let names = if mesh.object_names.is_empty() { Vec::new() } else { windows.iter().map(name).collect() };
    Ok(of_windows(targets, group_columns, names))
}

fn of_windows(targets: Targets, group_columns: Vec<Column>, names: Vec<String>) -> Places {
    let given = TextRows::default();
    Places { targets, place_columns: Vec::new(), group_columns, names, given, kind: "windows", row_name: "window" }
}

/// Coordinates of the file.
fn coordinates(frame: &Frame, places: &[[f64; 3]]) -> Vec<Column> {
    let of_file: Vec<[f64; 3]> = places.iter().map(|&place| frame.file_from_local(place)).collect();
    let axis = |i: usize| of_file.iter().map(|place| place[i]).collect();
    vec![("x", axis(0), 3), ("y", axis(1), 3), ("z", axis(2), 3)]
}
