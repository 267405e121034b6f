//! From flags and weather files to what a period sends.

use super::super::tree_light::{TreeLight, day_of_year};
use super::seasons::Season;
use crate::arguments::{ClearSkyChoice, Irradiance, Usage};
use crate::pipeline::{Scene, flagged};
use crate::progress::Stages;
use crate::summary::{Summary, rounded};
use anyhow::{Context, Result};
use belvedere::apps::irradiance::{
    BirdParams, ClearSky, Grouping, Instant, IrradianceParams, PARTS, PeriodRadiation, PeriodReport, Surroundings,
    clear_instants, weather_instants,
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
    flagged("--albedo, --sun-cell-deg", params.validate())?;
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
    let origin = scene.cloud.frame.origin;
    let middle: [f64; 3] = std::array::from_fn(|i| {
        origin[i] + f64::midpoint(f64::from(scene.model.bounds().low[i]), f64::from(scene.model.bounds().high[i]))
    });
    let height = middle[2].clamp(-500.0, 10_000.0);
    let of_crs = Site::of(&scene.cloud.frame.crs, [middle[0], middle[1]], height);
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

/// Where the sky stands, what it is known from, and the trees below it where these let light through.
pub(super) struct Sky<'a> {
    pub(super) site: &'a Site,
    pub(super) weather: Option<&'a Weather>,
    pub(super) trees: Option<&'a TreeLight>,
}

impl Sky<'_> {
    /// Share of the light that gets through crowns on a day.
    fn share(&self, date: Date) -> f64 {
        self.trees.map_or(0.0, |trees| trees.share(Some((day_of_year(date), self.site.latitude))))
    }

    /// The rows of the weather, those together whose days let the same share through crowns.
    fn parted(&self, weather: &Weather, zone: &Zone) -> Result<Vec<(f64, Weather)>> {
        let mut parts: Vec<(f64, Weather)> = Vec::new();
        for step in &weather.steps {
            let share = if self.trees.is_some() { self.share(zone.date_at(step.instant)?) } else { 0.0 };
            match parts.iter_mut().find(|(own, _)| *own == share) {
                Some((_, part)) => part.steps.push(*step),
                None => parts.push((share, Weather { steps: vec![*step], ..weather.clone() })),
            }
        }
        Ok(parts)
    }

    /// The days of a year from one change of what crowns let through to the next: share, begin and end.
    fn spans(&self, year: i16, zone: &Zone) -> belvedere::Result<Vec<(f64, [f64; 2])>> {
        let (first, last) = (Date::new(year, 1, 1)?, Date::new(year, 12, 31)?);
        let end = zone.instant_of(Date::new(year.saturating_add(1), 1, 1)?, 0.0)?;
        let mut spans: Vec<(f64, [f64; 2])> = Vec::new();
        for date in first.to(last) {
            let share = self.share(date);
            if spans.last().is_none_or(|(own, _)| *own != share) {
                let start = zone.instant_of(date, 0.0)?;
                if let Some((_, span)) = spans.last_mut() {
                    span[1] = start;
                }
                spans.push((share, [start, end]));
            }
        }
        Ok(spans)
    }
}

/// What a period sends, in parts by what crowns let through; one part where they let nothing.
pub(super) fn gather(
    arguments: &Irradiance,
    params: &IrradianceParams,
    sky: &Sky<'_>,
    stages: &mut Stages,
    summary: &mut Summary,
) -> Result<Vec<Season>> {
    let mut section = Summary::default();
    let (site, zone) = (sky.site, Zone::mean_solar(sky.site));
    let mut parts: Vec<(f64, Vec<Instant>)> = Vec::new();
    let mut put = |share: f64, instants: Vec<Instant>| match parts.iter_mut().find(|(own, _)| *own == share) {
        Some((_, part)) => part.extend(instants),
        None => parts.push((share, instants)),
    };
    match sky.weather {
        Some(weather) => {
            section.add("from", weather.format).add("rows", weather.steps.len());
            if weather.left_out_count > 0 {
                section.add("rows_without_radiation", weather.left_out_count);
            }
            section.add("hours", rounded(weather.hours(), 2)).add("notes", weather.notes.clone());
            let parts_of_row = arguments.parts.unwrap_or(PARTS);
            for (share, weather) in sky.parted(weather, &zone)? {
                let instants = stages.run("following the sun", 0, |_| weather_instants(&weather, site, parts_of_row));
                put(share, flagged("--parts-per-row", instants)?);
            }
        }
        None => {
            let year = arguments.year.unwrap_or(USUAL_YEAR);
            let spans = flagged("--year", sky.spans(year, &zone))?;
            let clear_sky = match arguments.radiation.clear_sky {
                Some(ClearSkyChoice::Haurwitz) => ClearSky::Haurwitz,
                Some(ClearSkyChoice::Bird) => {
                    ClearSky::Bird(BirdParams { albedo: params.albedo, ..BirdParams::default() })
                }
                _ => arguments.linke.map_or_else(ClearSky::default, |linke| ClearSky::Ineichen { linke }),
            };
            section.add("from", clear_sky.to_string()).add("year", year);
            for (share, span) in spans {
                let instants =
                    stages.run("following the sun", 0, |_| clear_instants(&clear_sky, site, span, CLEAR_STEP, &zone));
                put(share, flagged("--linke, --year", instants)?);
            }
        }
    }
    let mut seasons = Vec::new();
    let mut report = PeriodReport::default();
    for (share, instants) in &parts {
        let radiation = stages.run("gathering radiation", 0, |_| PeriodRadiation::gather(instants, params));
        let radiation = flagged("--patch-division", radiation)?;
        report.ghi += radiation.report.ghi;
        report.dni += radiation.report.dni;
        report.dhi += radiation.report.dhi;
        report.dni_without_sun += radiation.report.dni_without_sun;
        report.sun_direction_count += radiation.report.sun_direction_count;
        seasons.push(Season { radiation, share: *share });
    }
    section
        .add("global_kwh_m2", rounded(report.ghi, 1))
        .add("direct_normal_kwh_m2", rounded(report.dni, 1))
        .add("diffuse_kwh_m2", rounded(report.dhi, 1))
        .add("sun_directions", report.sun_direction_count)
        .add("diffuse_model", params.sky.to_string())
        .add(
            "obstacles_reflect",
            if params.surroundings == Surroundings::Dark { "nothing" } else { "like the ground" },
        );
    if report.dni_without_sun > DOUBTFUL * report.dni {
        let what = format!(
            "{:.0} kWh/m² of direct radiation come with the sun below the horizon and are not counted: do place and time zone of the \
             weather fit?",
            report.dni_without_sun
        );
        section.add("note", what);
    }
    summary.add("radiation", section);
    Ok(seasons)
}
