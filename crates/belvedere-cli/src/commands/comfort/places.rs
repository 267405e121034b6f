//! Routes and windows: from flags and files to places that are asked.

use crate::arguments::{Comfort, Corners, Usage};
use crate::commands::mesh_targets::{is_mesh, mesh_of, quoted};
use crate::commands::shapes::{TypedAre, shapes, wrong_shape};
use crate::commands::sights::{file, ground, ground_cloud, local};
use crate::pipeline::{Scene, flagged};
use crate::progress::Stages;
use crate::summary::Summary;
use anyhow::{Result, bail};
use belvedere::PointCloud;
use belvedere::apps::exposure::{ROUTE_STEP, WALKER_HEIGHT, WINDOW_LIFT, plane_normal, route_lengths, window_places};
use belvedere::apps::viewshed::{CELL, cell_for, places_along};
use belvedere::ground::MapGrid;
use belvedere::io::{Shape, read_table};
use belvedere::query::SurfacePieces;
use std::ops::Range;
use std::path::Path;

/// Ground made around routes, metres.
const MARGIN: f64 = 10.0;

/// Name, values and decimals.
pub(super) type Column = (&'static str, Vec<f64>, usize);

/// Places that are asked, those of a route or window after each other.
pub(super) struct Places {
    /// Local metres, (M, 3), NaN where no ground is known.
    pub(super) positions: Vec<[f32; 3]>,
    /// Outward unit normals, (M, 3); `None` where places are level.
    pub(super) normals: Option<Vec<[f32; 3]>>,
    /// What each stands for, (M).
    pub(super) weights: Vec<f64>,
    /// The places of each route or window.
    pub(super) groups: Vec<Range<usize>>,
    /// Where each place lies.
    pub(super) place_columns: Vec<Column>,
    /// Where and what each route or window is.
    pub(super) group_columns: Vec<Column>,
    /// What each is called; empty where nothing is.
    pub(super) names: Vec<String>,
    /// What groups are.
    pub(super) kind: &'static str,
    /// Column of their numbers.
    pub(super) row_name: &'static str,
}

impl Places {
    /// What each route or window stands for: length or area, or one each.
    pub(super) fn group_weights(&self) -> impl Iterator<Item = f64> + '_ {
        self.groups.iter().map(|group| self.weights[group.clone()].iter().sum())
    }
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
    let (mut places, mut groups, mut names) = (Vec::new(), Vec::new(), Vec::new());
    for named in shapes("--route", route, TypedAre::Line, &scene.cloud)? {
        let Shape::Line(corners) = named.shape else {
            return wrong_shape("--route", route, "a route is a line, this holds a point or a polygon");
        };
        if corners.len() < 2 {
            return wrong_shape("--route", route, "a route needs two corners or more");
        }
        let along = flagged("--distance-step-m", places_along(&corners, step))?;
        groups.push(places.len()..places.len() + along.len());
        names.push(quoted(&named.name));
        places.extend(along);
    }
    let unknown = set_on_ground(arguments, &mut places, height, scene, stages, summary)?;
    if unknown == places.len() {
        bail!("--route: there is no ground known below it; is it in the coordinates of the cloud?");
    }
    if unknown > 0 {
        summary
            .add("notes", vec![format!("{unknown} places of routes have no ground known below them, and no values")]);
    }
    let (mut weights, mut distances) = (Vec::new(), Vec::new());
    for group in &groups {
        let lengths = route_lengths(&places[group.clone()]);
        let mut along = 0.0;
        for (i, place) in group.clone().enumerate() {
            if i > 0 {
                let (a, b) = (places[place - 1], places[place]);
                along += (b[0] - a[0]).hypot(b[1] - a[1]);
            }
            distances.push(along);
        }
        weights.extend(lengths);
    }
    // what is not known weighs nothing
    for (weight, place) in weights.iter_mut().zip(&places) {
        if !place[2].is_finite() {
            *weight = 0.0;
        }
    }
    let lengths = groups.iter().map(|group| distances[group.clone()].last().copied().unwrap_or(0.0)).collect();
    let mut place_columns = vec![("distance_m", distances, 2)];
    place_columns.extend(coordinates(&scene.cloud, &places));
    Ok(Places {
        positions: places.iter().map(|&place| single(place)).collect(),
        normals: None,
        weights,
        groups,
        place_columns,
        group_columns: vec![("length_m", lengths, 2)],
        names,
        kind: "routes",
        row_name: "route",
    })
}

/// Gives places without a height that of the ground plus `height`; returns how many have no ground.
fn set_on_ground(
    arguments: &Comfort,
    places: &mut [[f64; 3]],
    height: f64,
    scene: &mut Scene,
    stages: &mut Stages,
    summary: &mut Summary,
) -> Result<usize> {
    let grounded: Vec<usize> = (0..places.len()).filter(|&i| places[i][2].is_nan()).collect();
    if grounded.is_empty() {
        return Ok(0);
    }
    let bound = |axis: usize, pick: fn(f64, f64) -> f64, start: f64| {
        grounded.iter().map(|&i| places[i][axis]).fold(start, pick)
    };
    let low = [0, 1].map(|axis| bound(axis, f64::min, f64::INFINITY) - MARGIN);
    let high = [0, 1].map(|axis| bound(axis, f64::max, f64::NEG_INFINITY) + MARGIN);
    let origin = [scene.cloud.frame.origin[0], scene.cloud.frame.origin[1]];
    let grid = flagged("--route", MapGrid::covering(low, high, cell_for(low, high), origin))?;
    let (cloud, points) = ground_cloud(&arguments.ground, scene, stages)?;
    let ground = ground(&cloud, points, grid, stages, summary)?;
    let mut unknown = 0;
    for i in grounded {
        match ground.height_at([places[i][0], places[i][1]]) {
            Some(level) => places[i][2] = level + height,
            None => unknown += 1,
        }
    }
    Ok(unknown)
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
        return Err(Usage("--spacing belongs to windows that are a mesh".to_owned()).into());
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
        bail!("{}: there is no window in it", path.display());
    }
    let (mut positions, mut normals, mut groups, mut tilts) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for row in 0..table.row_count() {
        let tilt = if tilt[row].is_nan() { 90.0 } else { tilt[row] };
        if !(0.0..=180.0).contains(&tilt) {
            bail!("{}: row {}: a tilt of {tilt} is not from 0 (up) to 180 degrees", path.display(), row + 1);
        }
        let normal = plane_normal(azimuth[row].to_radians() - grid_north, tilt.to_radians());
        let size = [width[row], height[row]];
        let size = size.iter().all(|v| v.is_finite()).then_some(size);
        let center = local(&scene.cloud, [x[row], y[row], z[row]]);
        let places = window_places(center, normal, size)
            .map_err(|error| anyhow::anyhow!("{}: row {}: {error}", path.display(), row + 1))?;
        groups.push(positions.len()..positions.len() + places.len());
        normals.extend(places.iter().map(|_| single(normal)));
        positions.extend(places.iter().map(|&place| single(place)));
        tilts.push(tilt);
    }
    let weights = groups.iter().flat_map(|group| group.clone().map(|_| 1.0 / group.len() as f64)).collect();
    let group_columns = vec![
        ("x", x.to_vec(), 3),
        ("y", y.to_vec(), 3),
        ("z", z.to_vec(), 3),
        ("azimuth", azimuth.to_vec(), 2),
        ("tilt", tilts, 2),
    ];
    Ok(of_windows(positions, normals, weights, groups, group_columns, Vec::new()))
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
    let surface = flagged("--spacing", SurfacePieces::of_mesh(&mesh, scene.cloud.frame.origin, spacing, seed))?;
    let pieces = &surface.pieces;
    // pieces of a face follow each other
    let mut groups: Vec<Range<usize>> = Vec::new();
    for run in pieces.chunk_by(|a, b| a.face == b.face) {
        let start = groups.last().map_or(0, |last| last.end);
        groups.push(start..start + run.len());
    }
    let mut centers = Vec::new();
    let (mut azimuths, mut tilts, mut areas, mut names) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for group in &groups {
        let run = &pieces[group.clone()];
        let area: f64 = run.iter().map(|piece| f64::from(piece.area)).sum();
        let middle = |axis: usize| {
            let of_piece = |piece: &belvedere::query::Piece| {
                f64::from(piece.area) * piece.corners.iter().map(|corner| f64::from(corner[axis])).sum::<f64>() / 3.0
            };
            run.iter().map(of_piece).sum::<f64>() / area
        };
        centers.push([middle(0), middle(1), middle(2)]);
        let [nx, ny, nz] = run[0].normal.map(f64::from);
        let upright = nx.hypot(ny);
        let azimuth = || (nx.atan2(ny) + grid_north).to_degrees().rem_euclid(360.0);
        azimuths.push(if upright > 1e-6 { azimuth() } else { f64::NAN });
        tilts.push(upright.atan2(nz).to_degrees());
        areas.push(area);
        let object = mesh.objects.get(run[0].face as usize).and_then(|&object| mesh.object_names.get(object as usize));
        names.push(object.map(|name| quoted(name)).unwrap_or_default());
    }
    let numbers = groups.iter().map(|group| f64::from(pieces[group.start].face)).collect();
    let mut group_columns = vec![("face", numbers, 0)];
    group_columns.extend(coordinates(&scene.cloud, &centers));
    group_columns.extend([("azimuth", azimuths, 2), ("tilt", tilts, 2), ("area_m2", areas, 4)]);
    if mesh.object_names.is_empty() {
        names.clear();
    }
    let positions = pieces.iter().map(|piece| piece.lifted_along_normal(WINDOW_LIFT)).collect();
    let normals = pieces.iter().map(|piece| piece.normal).collect();
    let weights = pieces.iter().map(|piece| f64::from(piece.area)).collect();
    Ok(of_windows(positions, normals, weights, groups, group_columns, names))
}

fn of_windows(
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    weights: Vec<f64>,
    groups: Vec<Range<usize>>,
    group_columns: Vec<Column>,
    names: Vec<String>,
) -> Places {
    Places {
        positions,
        normals: Some(normals),
        weights,
        groups,
        place_columns: Vec::new(),
        group_columns,
        names,
        kind: "windows",
        row_name: "window",
    }
}

/// Coordinates of the file.
fn coordinates(cloud: &PointCloud, places: &[[f64; 3]]) -> Vec<Column> {
    let of_file: Vec<[f64; 3]> = places.iter().map(|&place| file(cloud, place)).collect();
    let axis = |i: usize| of_file.iter().map(|place| place[i]).collect();
    vec![("x", axis(0), 3), ("y", axis(1), 3), ("z", axis(2), 3)]
}

#[expect(clippy::cast_possible_truncation, reason = "local positions are f32")]
fn single(place: [f64; 3]) -> [f32; 3] {
    place.map(|v| v as f32)
}
