//! Observers, from flags and files to places.

use crate::arguments::{MapPosition, Usage, ViewshedArguments, refuse};
use crate::inputs::observers::{ObserverUse, min_count, observer_rows};
use crate::outputs::formats::extension;
use crate::run::CommandContext;
use anyhow::Result;
use belvedere::apps::ask::{Standing, StandingObserver, ViewLimits};
use belvedere::apps::viewshed::places_along;
use belvedere::io::{ObserverRow, RowsAre};
use belvedere::{Bounds, Frame};
use std::path::PathBuf;

/// Metres between the observers on a line of GeoJSON.
const STEP: f64 = 5.0;
/// Bits of a mask that a raster holds for each cell.
const MAX_IN_MASK: usize = 32;
/// Counts that a raster holds; the next number is nodata.
const MAX_COUNTED: usize = 65_534;

/// Refuses outputs that cannot hold the observers that are known of, before a scene is read.
pub(super) fn check(arguments: &ViewshedArguments) -> Result<()> {
    MapPosition::refuse_twice("--observer", &arguments.who.observer)?;
    let (who, looking) = (&arguments.who, &arguments.looking);
    if looking.step.is_some() && who.observers.is_none() {
        return refuse("--distance-step-m divides the paths of --observers, which is missing");
    }
    let typed = who.spread.unwrap_or(who.observer.len());
    let count = if looking.step.is_some() { 1 } else { min_count(typed, who.observers.as_deref())? };
    check_count(arguments, count)
}

/// Refuses outputs that cannot hold so many observers.
fn check_count(arguments: &ViewshedArguments, count: usize) -> Result<()> {
    let is_tif = |path: &PathBuf| matches!(extension(path).as_str(), "tif" | "tiff");
    if count > MAX_IN_MASK && arguments.masks.as_ref().is_some_and(is_tif) {
        return refuse(format!("--masks: a .tif holds {MAX_IN_MASK} observers, but there are {count}; use .npy"));
    }
    if count > MAX_COUNTED && arguments.output.iter().any(is_tif) {
        return refuse(format!(
            "-o: a .tif counts at most {MAX_COUNTED} observers, but there are {count}; give fewer, or use --masks with .npy"
        ));
    }
    Ok(())
}

/// The limits of the flags.
pub(super) fn limits(arguments: &ViewshedArguments) -> ViewLimits {
    let looking = &arguments.looking;
    ViewLimits {
        azimuth_range_deg: looking.azimuth.map(|range| range.0),
        elevation_range_deg: looking.elevation.map(|range| range.0),
        min_distance: looking.min_distance.map(f64::from),
        max_distance: looking.max_distance,
    }
}

/// The observers of the flags or of the file, or the target.
pub(super) fn observers(
    arguments: &ViewshedArguments,
    (frame, bounds): (&Frame, &Bounds),
    run: &mut CommandContext,
) -> Result<Vec<StandingObserver>> {
    let (who, looking) = (&arguments.who, &arguments.looking);
    let at = |place: [f64; 3], height: Option<f64>, limits: ViewLimits| StandingObserver {
        standing: Standing { place, height },
        limits,
    };
    let typed = |&MapPosition(place, z): &MapPosition| {
        Ok(at(Standing::on_map(place, z, frame, bounds)?.place, None, ViewLimits::default()))
    };
    if let Some(target) = &who.target {
        return Ok(vec![typed(target)?]);
    }
    let Some(path) = &who.observers else { return who.observer.iter().map(typed).collect() };
    let rows_are = if looking.step.is_some() { RowsAre::Corners } else { RowsAre::Places };
    let usual = limits(arguments);
    let mut observers = Vec::new();
    for row in observer_rows(path, frame, rows_are, ObserverUse::Limits, run)? {
        let limits = limits_of(&row);
        limits.or(&usual).check().map_err(|error| Usage(format!("{}: {error}", path.display())))?;
        let places = places_along(&row.corners, looking.step.unwrap_or(STEP))?;
        observers.extend(places.into_iter().map(|place| at(place, row.height, limits)));
    }
    check_count(arguments, observers.len())?;
    Ok(observers)
}

/// The limits of a row; ranges without both ends are none.
fn limits_of(row: &ObserverRow) -> ViewLimits {
    let range = |[from, to]: [Option<f64>; 2]| from.zip(to).map(|(from, to)| [from, to]);
    ViewLimits {
        azimuth_range_deg: range(row.azimuth_deg),
        elevation_range_deg: range(row.elevation_deg),
        min_distance: row.distance[0],
        max_distance: row.distance[1],
    }
}
