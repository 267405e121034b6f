//! From flags and weather files to what a period sends.

use crate::arguments::{ClearSkyChoice, Irradiance, Usage};
use crate::pipeline::{Scene, flagged};
use crate::progress::Stages;
use crate::summary::{Summary, rounded};
use anyhow::{Context, Result};
use belvedere::apps::irradiance::{
    BirdParams, ClearSky, Grouping, IrradianceParams, PARTS, PeriodRadiation, clear_instants, weather_instants,
};
use belvedere::apps::sun::{Date, Site, Zone};
use belvedere::io::read_weather;
use belvedere::query::earth::EARTH_RADIUS;
use belvedere::weather::Weather;

/// Year of a clear sky that nobody chose; the sun's way differs by less than half a degree from year to year.
const USUAL_YEAR: i16 = 2026;
/// Steps of a clear sky, seconds.
const CLEAR_STEP: f64 = 600.0;
/// Distance from which on a weather file is told to be that of another place, metres.
const FAR: f64 = 50_000.0;
/// Share of direct radiation with the sun below the horizon from which on a file's times are doubtful.
const DOUBTFUL: f64 = 0.01;

pub(super) fn params(arguments: &Irradiance) -> Result<IrradianceParams> {
    let usual = IrradianceParams::default();
    let params = IrradianceParams {
        sky: arguments.sky.map_or(usual.sky, Into::into),
        patch_division: arguments.patch_division.unwrap_or(usual.patch_division),
        sun_cell: arguments.sun_cell.map_or(usual.sun_cell, f64::to_radians),
        albedo: arguments.albedo.unwrap_or(usual.albedo),
        surroundings: arguments.surroundings.map_or(usual.surroundings, Into::into),
        grouping: if arguments.months { Grouping::Months } else { Grouping::Whole },
    };
    flagged("--albedo, --sun-cell", params.validate())?;
    Ok(params)
}

pub(super) fn weather(arguments: &Irradiance, stages: &mut Stages) -> Result<Option<Weather>> {
    if arguments.linke.is_some() && arguments.radiation.clear_sky != Some(ClearSkyChoice::Ineichen) {
        return Err(Usage("--linke belongs to --clear-sky ineichen".to_owned()).into());
    }
    match &arguments.radiation.weather {
        Some(path) => Ok(Some(stages.run("reading weather", 0, |_| read_weather(path))?)),
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
    let origin = scene.cloud.origin;
    let middle: [f64; 3] =
        std::array::from_fn(|i| origin[i] + f64::midpoint(f64::from(scene.bounds.0[i]), f64::from(scene.bounds.1[i])));
    let height = middle[2].clamp(-500.0, 10_000.0);
    let of_crs = Site::of(&scene.cloud.crs, [middle[0], middle[1]], height);
    let (site, from) = match (&arguments.location, of_crs, weather) {
        (Some(location), of_crs, _) => {
            let [latitude, longitude] = location.0.map(f64::to_radians);
            // the axes of a grid do not turn because somebody names the place
            let convergence = of_crs.map_or(0.0, |site| site.convergence);
            let site = Site { latitude, longitude, height, convergence };
            (flagged("--location", site.validate())?, "--location")
        }
        (None, Ok(site), _) => (site, "reference system"),
        (None, Err(_), Some(weather)) => {
            let site = Site { latitude: weather.latitude, longitude: weather.longitude, height, convergence: 0.0 };
            (site.validate()?, "weather file")
        }
        (None, Err(error), None) => {
            return Err(anyhow::Error::from(error))
                .context("say where on earth the scene lies: --crs EPSG:CODE or --location LAT,LON");
        }
    };
    let mut section = Summary::default();
    section
        .add("latitude_deg", rounded(site.latitude.to_degrees(), 5))
        .add("longitude_deg", rounded(site.longitude.to_degrees(), 5))
        .add("grid_north_from_true_north_deg", rounded(site.convergence.to_degrees(), 4))
        .add("from", from);
    if let Some(distance) = weather.map(|weather| distance(&site, weather)).filter(|distance| *distance > FAR) {
        section.add("note", format!("the weather is that of a place {:.0} km off", distance / 1000.0));
    }
    summary.add("site", section);
    Ok(site)
}

fn distance(site: &Site, weather: &Weather) -> f64 {
    let north = weather.latitude - site.latitude;
    let east = (weather.longitude - site.longitude).sin().abs() * site.latitude.cos();
    EARTH_RADIUS * north.hypot(east)
}

pub(super) fn gather(
    arguments: &Irradiance,
    params: &IrradianceParams,
    site: &Site,
    weather: Option<&Weather>,
    stages: &mut Stages,
    summary: &mut Summary,
) -> Result<PeriodRadiation> {
    let mut section = Summary::default();
    let instants = match weather {
        Some(weather) => {
            section.add("from", weather.format).add("rows", weather.steps.len());
            if weather.left_out_count > 0 {
                section.add("rows_without_radiation", weather.left_out_count);
            }
            section.add("hours", rounded(weather.hours(), 2)).add("notes", weather.notes.clone());
            let parts = arguments.parts.unwrap_or(PARTS);
            let instants = stages.run("following the sun", 0, |_| weather_instants(weather, site, parts));
            flagged("--parts", instants)?
        }
        None => {
            let year = arguments.year.unwrap_or(USUAL_YEAR);
            let zone = Zone::mean_solar(site);
            let start = |year: i16| zone.instant_of(Date::new(year, 1, 1)?, 0.0);
            let period = [flagged("--year", start(year))?, flagged("--year", start(year.saturating_add(1)))?];
            let sky = match arguments.radiation.clear_sky {
                Some(ClearSkyChoice::Haurwitz) => ClearSky::Haurwitz,
                Some(ClearSkyChoice::Bird) => {
                    ClearSky::Bird(BirdParams { albedo: params.albedo, ..BirdParams::default() })
                }
                _ => arguments.linke.map_or_else(ClearSky::default, |linke| ClearSky::Ineichen { linke }),
            };
            section.add("from", format!("{sky:?}")).add("year", year);
            let instants =
                stages.run("following the sun", 0, |_| clear_instants(&sky, site, period, CLEAR_STEP, &zone));
            flagged("--linke, --year", instants)?
        }
    };
    let radiation = stages.run("gathering radiation", 0, |_| PeriodRadiation::gather(&instants, params));
    let radiation = flagged("--patch-division", radiation)?;
    let report = radiation.report;
    section
        .add("global_kwh_m2", rounded(report.ghi, 1))
        .add("direct_normal_kwh_m2", rounded(report.dni, 1))
        .add("diffuse_kwh_m2", rounded(report.dhi, 1))
        .add("sun_directions", report.sun_direction_count)
        .add("diffuse_model", format!("{:?}", params.sky))
        .add("obstacles_reflect", format!("{:?}", params.surroundings));
    if report.dni_without_sun > DOUBTFUL * report.dni {
        let what = format!(
            "{:.0} kWh/m² of direct radiation come with the sun below the horizon and are not counted: do place and time zone of the \
             weather fit?",
            report.dni_without_sun
        );
        section.add("note", what);
    }
    summary.add("radiation", section);
    Ok(radiation)
}
