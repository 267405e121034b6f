//! From flags and weather files to what a period sends.

use crate::arguments::{ClearSkyChoice, Irradiance, RadiationModel, Usage};
use crate::pipeline::Scene;
use crate::run::Run;
use crate::summary::{Summary, rounded};
use anyhow::{Context, Result};
use belvedere::apps::irradiance::{
    BirdParams, CLEAR_SKY_YEAR, ClearSky, IrradianceParams, PARTS, RadiationSource, SeasonRadiation, Surroundings,
    period_seasons,
};
use belvedere::apps::sun::{Site, SiteFrom};
use belvedere::apps::tree_light::Crowns;
use belvedere::io::read_weather;
use belvedere::weather::Weather;

/// Distance from which on a weather file is told to be that of another place, metres.
const FAR: f64 = 50_000.0;

pub(in crate::commands) fn params(model: &RadiationModel) -> Result<IrradianceParams> {
    let usual = IrradianceParams::default();
    let params = IrradianceParams::default()
        .with_sky(model.sky.map_or(usual.sky, Into::into))
        .with_patch_division(model.patch_division.unwrap_or(usual.patch_division))
        .with_sun_cell(model.sun_cell.map_or(usual.sun_cell, f64::to_radians))
        .with_albedo(model.albedo.unwrap_or(usual.albedo))
        .with_surroundings(model.surroundings.map_or(usual.surroundings, Into::into));
    params.validate()?;
    Ok(params)
}

/// The model of a sky without clouds.
pub(in crate::commands) fn clear_sky(
    choice: Option<ClearSkyChoice>,
    model: &RadiationModel,
    params: &IrradianceParams,
) -> ClearSky {
    match choice {
        Some(ClearSkyChoice::Haurwitz) => ClearSky::Haurwitz,
        Some(ClearSkyChoice::Bird) => ClearSky::Bird(BirdParams { albedo: params.albedo, ..BirdParams::default() }),
        _ => model.linke.map_or_else(ClearSky::default, |linke| ClearSky::Ineichen { linke }),
    }
}

/// Refuses a turbidity for a sky that knows none.
pub(in crate::commands) fn check_linke(choice: Option<ClearSkyChoice>, model: &RadiationModel) -> Result<()> {
    if model.linke.is_some() && choice != Some(ClearSkyChoice::Ineichen) {
        return Err(Usage("--linke needs --clear-sky ineichen".to_owned()).into());
    }
    Ok(())
}

pub(super) fn weather(arguments: &Irradiance, run: &mut Run) -> Result<Option<Weather>> {
    check_linke(arguments.radiation.clear_sky, &arguments.model)?;
    match &arguments.radiation.weather {
        Some(path) => Ok(Some(run.stage("reading weather", 0, |_| read_weather(path))?)),
        None => Ok(None),
    }
}

/// Where the scene lies on earth.
pub(super) fn site(
    arguments: &Irradiance,
    scene: &Scene,
    weather: Option<&Weather>,
    summary: &mut Summary,
) -> Result<Site> {
    let given = arguments.location.as_ref().map(|location| location.0.map(f64::to_radians));
    let station = weather.map(|weather| [weather.latitude, weather.longitude]);
    let found = Site::of_scene(&scene.cloud.frame, &scene.model.bounds(), given, station);
    let (site, from) = match given {
        Some(_) => found?,
        None => found.context("the location of the scene is unknown: give --crs EPSG:CODE or --location LAT,LON")?,
    };
    let from = match from {
        SiteFrom::Location => "--location",
        SiteFrom::ReferenceSystem => "reference system",
        SiteFrom::Elsewhere => "weather file",
    };
    let mut section = Summary::default();
    section
        .add("latitude_deg", rounded(site.latitude.to_degrees(), 5))
        .add("longitude_deg", rounded(site.longitude.to_degrees(), 5))
        .add("meridian_convergence_deg", rounded(site.convergence.to_degrees(), 4))
        .add("source", from);
    if let Some(distance) = station.map(|station| site.distance_to(station)).filter(|distance| *distance > FAR) {
        section.add("note", format!("the weather is for a location {:.0} km away", distance / 1000.0));
    }
    summary.add("location", section);
    Ok(site)
}

/// What a period sends, in parts by what crowns let through; one part where they let nothing.
pub(super) fn gather(
    arguments: &Irradiance,
    params: &IrradianceParams,
    site: &Site,
    weather: Option<&Weather>,
    crowns: Option<Crowns>,
    run: &mut Run,
) -> Result<Vec<SeasonRadiation>> {
    let mut section = Summary::default();
    let source = match weather {
        Some(weather) => {
            section.add("source", weather.format).add("weather_rows", weather.steps.len());
            if weather.left_out_count > 0 {
                section.add("weather_rows_without_radiation", weather.left_out_count);
            }
            if let Some(remark) = weather.period_remark() {
                run.summary.warn(remark);
            }
            section.add("weather_hours", rounded(weather.hours(), 2)).add("notes", weather.notes.clone());
            RadiationSource::Weather { weather, parts: arguments.model.parts.unwrap_or(PARTS) }
        }
        None => {
            let year = arguments.year.unwrap_or(CLEAR_SKY_YEAR);
            let clear_sky = clear_sky(arguments.radiation.clear_sky, &arguments.model, params);
            section.add("source", clear_sky.to_string()).add("year", year);
            RadiationSource::ClearSky { clear_sky, year }
        }
    };
    let (seasons, report) =
        run.stage("computing radiation", 0, |control| period_seasons(&source, site, crowns, params, control))?;
    section
        .add("global_kwh_m2", rounded(report.ghi, 1))
        .add("direct_normal_kwh_m2", rounded(report.dni, 1))
        .add("diffuse_kwh_m2", rounded(report.dhi, 1))
        .add("sun_directions", report.sun_direction_count)
        .add("diffuse_model", params.sky.to_string())
        .add(
            "obstacle_reflection",
            if params.surroundings == Surroundings::Dark { "nothing" } else { "like the ground" },
        );
    if report.night_hours > 0.0 {
        run.summary.warn(format!(
            "the weather has radiation in {:.1} hours of the night, with the sun more than 12 degrees below the horizon: are its location and time zone correct?",
            report.night_hours
        ));
    }
    if report.is_doubtful() {
        let what = format!(
            "{:.0} kWh/m² of direct radiation have the sun below the horizon and are ignored: are the location and the time zone of the weather correct?",
            report.dni_without_sun
        );
        run.summary.warn(what);
    }
    run.summary.add("radiation", section);
    Ok(seasons)
}
