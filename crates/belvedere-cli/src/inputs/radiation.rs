//! Converts flags and weather files to the source of radiation.

use crate::arguments::{ClearSkyChoice, RadiationModel, refuse};
use crate::run::CommandContext;
use anyhow::Result;
use belvedere::apps::ask::Radiation;
use belvedere::apps::irradiance::{BirdParams, ClearSky, IrradianceParams, PARTS};
use belvedere::io::read_weather;
use std::path::Path;
use std::sync::Arc;

pub(crate) fn params(model: &RadiationModel) -> IrradianceParams {
    let usual = IrradianceParams::default();
    IrradianceParams::default()
        .with_sky(model.sky.map_or(usual.sky, Into::into))
        .with_patch_division(model.patch_division.unwrap_or(usual.patch_division))
        .with_sun_cell(model.sun_cell.map_or(usual.sun_cell, f64::to_radians))
        .with_albedo(model.albedo.unwrap_or(usual.albedo))
        .with_surroundings(model.surroundings.map_or(usual.surroundings, Into::into))
}

/// The model of a sky without clouds.
fn clear_sky(choice: Option<ClearSkyChoice>, model: &RadiationModel, params: &IrradianceParams) -> ClearSky {
    match choice {
        Some(ClearSkyChoice::Haurwitz) => ClearSky::Haurwitz,
        Some(ClearSkyChoice::Bird) => ClearSky::Bird(BirdParams { albedo: params.albedo, ..BirdParams::default() }),
        _ => model.linke.map_or_else(ClearSky::default, |linke| ClearSky::Ineichen { linke }),
    }
}

/// Refuses a turbidity for a sky that knows none.
pub(crate) fn check_linke(choice: Option<ClearSkyChoice>, model: &RadiationModel) -> Result<()> {
    if model.linke.is_some() && choice != Some(ClearSkyChoice::Ineichen) {
        return refuse("--linke needs --clear-sky ineichen");
    }
    Ok(())
}

/// Returns the source of radiation; reads weather.
pub(crate) fn of(
    (weather, choice): (Option<&Path>, Option<ClearSkyChoice>),
    model: &RadiationModel,
    year: i16,
    run: &CommandContext,
) -> Result<Radiation> {
    check_linke(choice, model)?;
    let Some(path) = weather else {
        return Ok(Radiation::ClearSky { clear_sky: clear_sky(choice, model, &params(model)), year });
    };
    let weather = run.stage("reading weather", 0, |_| read_weather(path))?;
    let parts = model.parts.unwrap_or(PARTS);
    Ok(Radiation::Weather { file: path.display().to_string(), weather: Some(Arc::new(weather)), parts })
}
