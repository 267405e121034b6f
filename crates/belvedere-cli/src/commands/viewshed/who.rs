//! Who looks: from flags and files to eyes.

use crate::arguments::{Place, Usage, Viewshed};
use crate::commands::extension;
use crate::commands::surroundings::least_count;
use anyhow::Result;
use belvedere::PointCloud;
use belvedere::apps::targets::{set_on_ground, set_on_terrain};
use belvedere::apps::viewshed::{OBSERVER_HEIGHT, Observer, SightLimits, TARGET_HEIGHT, places_along};
use belvedere::ground::Ground;
use belvedere::io::{ObserverRow, RowsAre, read_observers};
use belvedere::model::SceneModel;
use std::path::PathBuf;

/// Metres between the observers on a line of GeoJSON.
const STEP: f64 = 5.0;

/// An observer before the ground below it is known.
pub(super) struct Row {
    /// Local metres; the height of the eye is NaN where it follows from the ground.
    pub(super) place: [f64; 3],
    pub(super) height: f64,
    pub(super) limits: SightLimits,
}

/// Bits of a mask that a raster holds for each cell.
const MOST_IN_MASK: usize = 32;
/// Counts that a raster holds; the next number is nodata.
const MOST_COUNTED: usize = 65_534;

/// Refuses limits that no observer can have, and outputs that cannot hold the observers that are known of, before a scene is read.
pub(super) fn check(arguments: &Viewshed) -> Result<()> {
    limits(arguments, 0.0)?;
    Place::refuse_twice("--observer", &arguments.who.observer)?;
    let (who, looking) = (&arguments.who, &arguments.looking);
    let count = if looking.step.is_some() { 1 } else { least_count(who.observer.len(), who.observers.as_deref())? };
    check_count(arguments, count)
}

/// Refuses outputs that cannot hold so many observers.
pub(super) fn check_count(arguments: &Viewshed, count: usize) -> Result<()> {
    let is_tif = |path: &PathBuf| matches!(extension(path).as_str(), "tif" | "tiff");
    if count > MOST_IN_MASK && arguments.masks.as_ref().is_some_and(is_tif) {
        return Err(
            Usage(format!("--masks: a .tif holds {MOST_IN_MASK} observers, but there are {count}; use .npy")).into()
        );
    }
    if count > MOST_COUNTED && arguments.output.iter().any(is_tif) {
        return Err(Usage(format!(
            "-o: a .tif counts at most {MOST_COUNTED} observers, but there are {count}; give fewer, or use --masks with .npy"
        ))
        .into());
    }
    Ok(())
}

fn limits(arguments: &Viewshed, grid_north: f64) -> Result<SightLimits> {
    let looking = &arguments.looking;
    let unlimited = SightLimits::default();
    let limits = SightLimits {
        azimuth: looking.azimuth.map(|v| v.0.map(|azimuth| azimuth.to_radians() - grid_north)),
        elevation: looking.elevation.map(|v| v.0.map(f64::to_radians)),
        distance: [
            looking.min_distance.map_or(unlimited.distance[0], f64::from),
            looking.max_distance.unwrap_or(unlimited.distance[1]),
        ],
    };
    limits.validate()?;
    if arguments.who.target.is_some() && (limits.azimuth.is_some() || limits.elevation.is_some()) {
        let what = "--azimuth-range and --elevation-range limit the view of one observer; with --target there are many";
        return Err(Usage(what.to_owned()).into());
    }
    Ok(limits)
}

/// The observers of the flags or of the file. `grid_north` is the azimuth of grid north, radians.
pub(super) fn rows(arguments: &Viewshed, cloud: &PointCloud, grid_north: f64) -> Result<Vec<Row>> {
    let (who, looking) = (&arguments.who, &arguments.looking);
    let limits = limits(arguments, grid_north)?;
    let height = looking.observer_height.unwrap_or(OBSERVER_HEIGHT);
    let typed = |place: &Place, height: f64| {
        let &Place([x, y], z) = place;
        Row { place: cloud.frame.local_from_file([x, y, z.unwrap_or(f64::NAN)]), height, limits }
    };
    if let Some(target) = &who.target {
        return Ok(vec![typed(target, looking.target_height.unwrap_or(TARGET_HEIGHT))]);
    }
    let Some(path) = &who.observers else {
        return Ok(who.observer.iter().map(|place| typed(place, height)).collect());
    };
    let rows_are = if looking.step.is_some() { RowsAre::Corners } else { RowsAre::Places };
    let mut rows = Vec::new();
    for row in read_observers(path, &cloud.frame.crs, rows_are)? {
        let limits = limits_of(&row, limits, grid_north);
        limits.validate().map_err(|error| Usage(format!("{}: {error}", path.display())))?;
        let corners: Vec<[f64; 3]> =
            row.corners.iter().map(|c| std::array::from_fn(|i| c[i] - cloud.frame.origin[i])).collect();
        let places = places_along(&corners, looking.step.unwrap_or(STEP))?;
        let height = row.height.unwrap_or(height);
        rows.extend(places.into_iter().map(|place| Row { place, height, limits }));
    }
    check_count(arguments, rows.len())?;
    Ok(rows)
}

/// The limits of a file override those of the flags.
fn limits_of(row: &ObserverRow, typed: SightLimits, grid_north: f64) -> SightLimits {
    let pair = |given: [Option<f64>; 2], typed: Option<[f64; 2]>| match given {
        [Some(from), Some(to)] => Some([from.to_radians(), to.to_radians()]),
        _ => typed,
    };
    SightLimits {
        azimuth: match row.azimuth_deg {
            [Some(from), Some(to)] => Some([from, to].map(|azimuth| azimuth.to_radians() - grid_north)),
            _ => typed.azimuth,
        },
        elevation: pair(row.elevation_deg, typed.elevation),
        distance: [row.distance[0].unwrap_or(typed.distance[0]), row.distance[1].unwrap_or(typed.distance[1])],
    }
}

/// The observers with their eyes above the ground, or above the far terrain of `model`; the height of an eye is NaN where no ground is known below it.
pub(super) fn observers(rows: &[Row], ground: &Ground, model: &SceneModel) -> Vec<Observer> {
    let mut eyes: Vec<[f64; 3]> = rows.iter().map(|row| row.place).collect();
    set_on_terrain(eyes.iter_mut().zip(rows).map(|(eye, row)| (eye, row.height)), model);
    set_on_ground(eyes.iter_mut().zip(rows).map(|(eye, row)| (eye, row.height)), ground);
    eyes.into_iter().zip(rows).map(|(eye, row)| Observer { eye, limits: row.limits }).collect()
}
