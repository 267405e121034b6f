//! Observers and targets that were typed, from latitude and longitude to coordinates of the file.

use crate::arguments::{CloudInput, Command, MapPosition, Usage};
use anyhow::Result;
use belvedere::apps::ask::end_on_map;
use belvedere::crs::Crs;
use belvedere::io::{cloud_files, read_las_head};

/// Replaces the observers and targets of a command that are given in degrees, as far as headers tell. Parts of surveys
/// are then read around them; other files have their places converted once they are read.
///
/// # Errors
/// [`Usage`] for longitude before latitude.
pub(crate) fn in_file_coordinates(command: &mut Command) -> Result<()> {
    let (input, places): (&CloudInput, Vec<&mut MapPosition>) = match command {
        Command::LineOfSight(typed) => {
            (&typed.scene.input, typed.lines.from.iter_mut().chain(&mut typed.lines.to).collect())
        }
        Command::Viewshed(typed) => {
            (&typed.scene.input, typed.who.observer.iter_mut().chain(&mut typed.who.target).collect())
        }
        Command::ProtectedView(typed) => (&typed.scene.input, typed.eyes.eye.iter_mut().collect()),
        Command::Isovist(typed) => (&typed.scene.input, typed.eyes.eye.iter_mut().collect()),
        Command::Glare(typed) => (&typed.scene.input, typed.eyes.eye.iter_mut().collect()),
        Command::Horizon(typed) => (&typed.scene.input, typed.eyes.eye.iter_mut().collect()),
        #[cfg(feature = "view")]
        Command::View(typed) => (&typed.scene.input, typed.observer.iter_mut().collect()),
        _ => return Ok(()),
    };
    // other numbers are no degrees: nothing needs to be read
    if !places.iter().any(|place| place.0[0].abs() <= 90.0 && place.0[1].abs() <= 180.0) {
        return Ok(());
    }
    let Some((crs, bounds)) = on_map(input)? else { return Ok(()) };
    for place in places {
        place.0 = end_on_map(place.0, &crs, bounds).map_err(|error| Usage(error.to_string()))?;
    }
    Ok(())
}

/// Reference system and bounds of clouds, south-west and north-east corner, as far as their headers tell.
///
/// # Errors
/// An unknown reference system that was typed.
pub(crate) fn on_map(input: &CloudInput) -> Result<Option<(Crs, [[f64; 2]; 2])>> {
    let Ok(files) = cloud_files(&input.clouds) else { return Ok(None) };
    let heads: Option<Vec<_>> = files.iter().map(|file| read_las_head(file.as_path()).ok()).collect();
    let Some(heads) = heads.filter(|heads| !heads.is_empty()) else { return Ok(None) };
    let crs = match &input.crs {
        Some(crs) => Crs::parse(crs)?,
        None => heads[0].crs.clone(),
    };
    let end = |corner: usize, pick: fn(f64, f64) -> f64| {
        [0, 1].map(|axis| heads.iter().map(|head| head.bounds[corner][axis]).reduce(pick).unwrap_or(f64::NAN))
    };
    Ok(Some((crs, [end(0, f64::min), end(1, f64::max)])))
}
