//! Routes and windows: from flags and files to places that are asked.

use crate::arguments::{Comfort, Corners};
use crate::commands::shapes::{TypedAre, shapes, wrong_shape};
use crate::commands::sights::{ground, ground_cloud};
use crate::commands::windows::{Column, Windows, coordinates};
use crate::pipeline::Scene;
use crate::run::Run;
use anyhow::{Result, bail};
use belvedere::apps::exposure::{ROUTE_STEP, WALKER_HEIGHT};
use belvedere::apps::targets::{Route, Targets, grid_around, set_on_ground};
use belvedere::apps::viewshed::places_along;
use belvedere::io::{Shape, TextRows};

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
pub(super) fn routes(arguments: &Comfort, route: &Corners, scene: &mut Scene, run: &mut Run) -> Result<Places> {
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
        routes.push(Route { places: places_along(&corners, step)? });
        names.push(named.name);
    }
    let places = || routes.iter().flat_map(|route| route.places.iter().copied());
    let count = places().count();
    if let Some(grid) = grid_around(places(), scene.cloud.frame.origin)? {
        let (cloud, points) = ground_cloud(&arguments.ground, scene, run)?;
        let ground = ground(&cloud, points, grid, run)?;
        let all = routes.iter_mut().flat_map(|route| &mut route.places).map(|place| (place, height));
        let unknown = set_on_ground(all, &ground).len();
        if unknown == count {
            bail!("--route: the ground below it is unknown; is the route in the coordinates of the cloud?");
        }
        if unknown > 0 {
            let note = format!("{unknown} targets on routes have no known ground below them, and no values");
            run.summary.add("notes", vec![note]);
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

impl From<Windows> for Places {
    fn from(windows: Windows) -> Self {
        let Windows { targets, columns, names, given, .. } = windows;
        let kind = "windows";
        Self { targets, place_columns: Vec::new(), group_columns: columns, names, given, kind, row_name: "window" }
    }
}
