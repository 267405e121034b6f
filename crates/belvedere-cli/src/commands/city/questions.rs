//! From flags to the questions of a plan.

use crate::arguments::{AreaChoice, CellFor, CityPlan, Numbers, Place, Usage};
use crate::commands::irradiance::radiation;
use crate::commands::shadow::moment;
use crate::commands::sun_hours::rules;
use crate::run::Run;
use anyhow::Result;
use belvedere::Error;
use belvedere::apps::irradiance::PARTS;
use belvedere::apps::shadow::ShadowSun;
use belvedere::apps::sun::{Binning, Period, sun_position_with};
use belvedere::apps::tree_light::Season;
use belvedere::apps::viewshed::OBSERVER_HEIGHT;
use belvedere::crs::Crs;
use belvedere::io::{read_geojson, read_horizon, read_mesh, read_tif, read_weather};
use belvedere_tiles::{CellSizes, Plan, Question, Radiation, SideFile, SunQuestion, Topic};

/// Refuses what cannot be asked, before the survey is read.
pub(super) fn check(arguments: &CityPlan) -> Result<()> {
    let usage = |text: &str| Err(Usage(text.to_owned()).into());
    let has_suns = !arguments.suns.is_empty() || !arguments.times.is_empty();
    let has_maps = arguments.sky_view || arguments.sun_hours || arguments.irradiance || !arguments.rule.is_empty();
    if !has_suns && !has_maps && arguments.observers.is_empty() {
        return usage(
            "questions are missing: give --sun, --time, --sun-hours, --rule, --irradiance, --sky-view or --observer",
        );
    }
    match (arguments.sun_hours, arguments.when.is_given()) {
        (true, false) => return usage("--sun-hours needs --date DAY, or --from and --to"),
        (false, true) => return usage("--date, --from and --to need --sun-hours"),
        _ => {}
    }
    arguments.when.check(&arguments.sun)?;
    rules(&arguments.rule)?;
    for time in &arguments.times {
        arguments.sun.instant("--time", time)?;
    }
    let has_radiation = arguments.weather.is_some() || arguments.clear_sky.is_some();
    if arguments.irradiance && !has_radiation {
        return usage("--irradiance needs --weather FILE or --clear-sky MODEL");
    }
    Place::refuse_twice("--observer", &arguments.observers)?;
    for mesh in &arguments.add {
        read_mesh(mesh)?;
    }
    for choice in &arguments.clear {
        if let AreaChoice::File(path) = choice {
            match read_geojson(path, &Crs::default()) {
                // that of the survey is not known yet
                Ok(_) | Err(Error::UnusableCrs { .. }) => {}
                Err(error) => return Err(error.into()),
            }
        }
    }
    if let Some(weather) = &arguments.weather {
        read_weather(weather.as_path())?;
    }
    if let Some(terrain) = &arguments.far_terrain.terrain {
        read_tif(terrain.as_path())?;
    }
    if let Some(horizon) = &arguments.far_terrain.horizon {
        read_horizon(horizon)?;
    }
    radiation::params(&arguments.model)?;
    radiation::check_linke(arguments.clear_sky, &arguments.model)
}

/// Sides of cells, for kinds of results that are asked for.
pub(super) fn cells(arguments: &CityPlan) -> Result<CellSizes> {
    let mut cells = CellSizes::all(arguments.cell);
    let mut given = Vec::new();
    for &CellFor(topic, side) in &arguments.cell_for {
        let name = topic.name();
        if given.contains(&topic) {
            return Err(Usage(format!("--cell-for: {name} is given twice")).into());
        }
        let (is_asked, flag) = match topic {
            Topic::Shadow => (!arguments.suns.is_empty() || !arguments.times.is_empty(), "--sun or --time"),
            Topic::SunHours => (arguments.sun_hours, "--sun-hours"),
            Topic::Rule => (!arguments.rule.is_empty(), "--rule"),
            Topic::Irradiance => (arguments.irradiance, "--irradiance"),
            Topic::SkyView => (arguments.sky_view, "--sky-view"),
            Topic::Viewshed => (!arguments.observers.is_empty(), "--observer"),
        };
        if !is_asked {
            return Err(Usage(format!("--cell-for {name} needs {flag}")).into());
        }
        given.push(topic);
        cells = cells.with(topic, side);
    }
    Ok(cells)
}

/// What was typed as questions. Azimuths count from the north, and the sun is that, at the middle of the survey.
pub(super) fn questions(arguments: &CityPlan, plan: &Plan, run: &mut Run) -> Result<Vec<Question>> {
    let (frame, bounds) = (plan.frame()?, plan.bounds());
    let (low, high) = bounds.on_map();
    let north = arguments.north.of_frame(&frame, [0, 1].map(|axis| f64::midpoint(low[axis], high[axis])));
    let sun = |typed: &Numbers<2>| {
        let [azimuth, elevation] = typed.0;
        let to_sun = ShadowSun::at(azimuth.to_radians() - north.of_grid, elevation.to_radians()).to_sun;
        Question::Shadow { name: format!("shadow_{azimuth}_{elevation}"), to_sun, season: None }
    };
    let mut questions: Vec<Question> = arguments.suns.iter().map(sun).collect();
    if !arguments.times.is_empty() || arguments.sun_hours || !arguments.rule.is_empty() {
        let site = arguments.sun.site_of(&frame, &bounds, &mut run.summary)?;
        let mut times: Vec<&str> = arguments.times.iter().map(String::as_str).collect();
        times.extend(arguments.when.times());
        let zone = arguments.sun.zone(&site, &times)?;
        for time in &arguments.times {
            let instant = arguments.sun.instant("--time", time)?;
            let position = sun_position_with(&site, instant, arguments.sun.refraction()?)?;
            let name = format!("shadow_{}", moment(&zone, instant));
            let season = zone.date_at(instant).ok().map(|date| Season::on(date, &site));
            questions.push(Question::Shadow { name, to_sun: position.to_sun(&site), season });
        }
        if let Some(period) = arguments.when.period(&arguments.sun, &site, &zone)? {
            let params = arguments.when.params(&arguments.sun)?;
            let days = SunQuestion::new(site, &zone, &period, params, Binning::Auto)?;
            questions.push(Question::SunHours(days));
        }
        for (column, rule) in rules(&arguments.rule)? {
            let dates = rule.days.dates(arguments.when.year, &site, &zone)?;
            let least_elevation = arguments.when.least_elevation.map_or(rule.least_elevation, f64::to_radians);
            let params = arguments.when.params(&arguments.sun)?.with_least_elevation(least_elevation);
            let days = SunQuestion::new(site, &zone, &Period::Days(dates), params, Binning::Auto)?;
            questions.push(Question::SunRule { name: column.to_owned(), rule: rule.name, days });
        }
    }
    if arguments.irradiance {
        let site = arguments.sun.site_of(&frame, &bounds, &mut run.summary)?;
        let params = radiation::params(&arguments.model)?;
        let radiation = match &arguments.weather {
            Some(file) => {
                Radiation::Weather { file: SideFile::new(file)?, parts: arguments.model.parts.unwrap_or(PARTS) }
            }
            None => Radiation::ClearSky {
                clear_sky: radiation::clear_sky(arguments.clear_sky, &arguments.model, &params),
                year: arguments.when.year,
            },
        };
        questions.push(Question::Irradiance { site, radiation, params });
    }
    if arguments.sky_view {
        questions.push(Question::SkyView { directions: arguments.direction_count });
    }
    if !arguments.observers.is_empty() {
        let place = |&Place([x, y], z): &Place| frame.local_from_file([x, y, z.unwrap_or(f64::NAN)]);
        let mut eyes: Vec<[f64; 3]> = arguments.observers.iter().map(place).collect();
        let height = arguments.observer_height.unwrap_or(OBSERVER_HEIGHT);
        plan.set_on_ground(&mut eyes, height, &run.control())?;
        questions.push(Question::Viewshed { eyes, max_distance: arguments.max_distance });
    }
    Ok(questions)
}
