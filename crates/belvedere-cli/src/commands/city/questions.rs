//! Converts flags to the questions of a plan.

use crate::arguments::{AreaChoice, CellFor, CityPlan, MapPosition, refuse};
use crate::inputs::radiation;
use crate::run::CommandContext;
use anyhow::Result;
use belvedere::Error;
use belvedere::apps::ask::{self, SkyParts, SunPlace, Suns};
use belvedere::apps::shadow::Edges;
use belvedere::apps::sun::zone_of_instant;
use belvedere::crs::Crs;
use belvedere::io::{read_features, read_horizon, read_mesh, read_tif, read_weather};
use belvedere_tiles::{CellSizes, Plan, TileQuestion, Topic};

/// Refuses questions that cannot be answered, before the survey is read.
pub(super) fn check(arguments: &CityPlan) -> Result<()> {
    let usage = |text: &str| refuse(text);
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
    if arguments.probability && !has_suns && arguments.observers.is_empty() {
        return usage("--probability needs --sun, --time or --observer");
    }
    if arguments.interval && !(arguments.sun_hours || arguments.sky_view || arguments.irradiance) {
        return usage("--interval needs --sun-hours, --sky-view or --irradiance");
    }
    let has_radiation = arguments.weather.is_some() || arguments.clear_sky.is_some();
    if arguments.irradiance && !has_radiation {
        return usage("--irradiance needs --weather FILE or --clear-sky MODEL");
    }
    of_sun_and_sky(arguments)?.iter().try_for_each(ask::Question::check)?;
    ask::check_interval(arguments.interval, &arguments.trees.choice()?)?;
    MapPosition::refuse_twice("--observer", &arguments.observers)?;
    for mesh in &arguments.add {
        read_mesh(mesh)?;
    }
    for choice in &arguments.clear {
        if let AreaChoice::File(path) = choice {
            match read_features(path, &Crs::default()) {
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
    radiation::params(&arguments.model).validate()?;
    radiation::check_linke(arguments.clear_sky, &arguments.model)
}

/// Sides of cells, for the requested kinds of results.
pub(super) fn cells(arguments: &CityPlan) -> Result<CellSizes> {
    let mut cells = CellSizes::all(arguments.cell);
    let mut given = Vec::new();
    for &CellFor(topic, side) in &arguments.cell_for {
        let name = topic.name();
        if given.contains(&topic) {
            return refuse(format!("--cell-for: {name} is given twice"));
        }
        let (is_requested, flag) = match topic {
            Topic::Shadow => (!arguments.suns.is_empty() || !arguments.times.is_empty(), "--sun or --time"),
            Topic::SunHours => (arguments.sun_hours, "--sun-hours"),
            Topic::Rule => (!arguments.rule.is_empty(), "--rule"),
            Topic::Irradiance => (arguments.irradiance, "--irradiance"),
            Topic::SkyView => (arguments.sky_view, "--sky-view"),
            Topic::Viewshed => (!arguments.observers.is_empty(), "--observer"),
        };
        if !is_requested {
            return refuse(format!("--cell-for {name} needs {flag}"));
        }
        given.push(topic);
        cells = cells.with(topic, side);
    }
    Ok(cells)
}

/// Returns the location of the survey for suns. Without a typed zone the clock is that of one of the times.
fn sun_place(arguments: &CityPlan) -> Result<SunPlace> {
    let place = arguments.sun.place(&arguments.north)?;
    let of_times = || arguments.times.iter().find_map(|time| zone_of_instant(time));
    let zone = place.zone.clone().or_else(|| of_times().map(|zone| zone.name().to_owned()));
    Ok(SunPlace { zone, ..place })
}

fn how_sure(arguments: &CityPlan) -> ask::HowSure {
    ask::HowSure { probability: arguments.probability, certain: None }
}

/// The questions that were typed about sun and sky, as one would put them to a scene.
fn of_sun_and_sky(arguments: &CityPlan) -> Result<Vec<ask::Question>> {
    let (place, trees) = (sun_place(arguments)?, arguments.trees.choice()?);
    let shadow = |suns| {
        let (place, edges) = (place.clone(), Edges::Hard);
        ask::Question::Shadow(ask::ShadowQuestion {
            suns,
            place,
            edges,
            trees,
            unproven: None,
            how_sure: how_sure(arguments),
            casters: false,
        })
    };
    let mut questions = Vec::new();
    if !arguments.suns.is_empty() {
        questions.push(shadow(Suns::Directions(arguments.suns.iter().map(|sun| sun.0).collect())));
    }
    if !arguments.times.is_empty() {
        questions.push(shadow(Suns::Times(arguments.times.clone())));
    }
    if arguments.sun_hours || !arguments.rule.is_empty() {
        let (days, rules) = (arguments.when.days(), arguments.rule.clone());
        questions.push(ask::Question::SunHours(ask::SunHoursQuestion {
            days,
            rules,
            place,
            trees,
            interval: arguments.interval,
            ..ask::SunHoursQuestion::default()
        }));
    }
    Ok(questions)
}

/// Converts the typed questions. Azimuths count from the north, and the sun stands, at the middle of the survey.
pub(super) fn questions(arguments: &CityPlan, plan: &Plan, run: &mut CommandContext) -> Result<Vec<TileQuestion>> {
    let frame = plan.frame()?;
    let whereabouts = plan.whereabouts(&frame);
    let mut questions = Vec::new();
    for question in of_sun_and_sky(arguments)? {
        questions.extend(TileQuestion::one_by_one(&question, (plan, &whereabouts), &run.control())?);
    }
    if arguments.irradiance {
        let from = (arguments.weather.as_deref(), arguments.clear_sky);
        let question = ask::Question::Irradiance(ask::IrradianceQuestion {
            radiation: radiation::of(from, &arguments.model, arguments.when.year, run)?,
            params: radiation::params(&arguments.model),
            place: sun_place(arguments)?,
            trees: arguments.trees.choice()?,
            roofs: None,
            interval: arguments.interval,
        });
        questions.extend(TileQuestion::one_by_one(&question, (plan, &whereabouts), &run.control())?);
    }
    if arguments.sky_view {
        let sky = SkyParts::Even(arguments.direction_count);
        let question = ask::Question::SkyView(ask::SkyViewQuestion {
            sky,
            trees: arguments.trees.choice()?,
            interval: arguments.interval,
        });
        questions.extend(TileQuestion::one_by_one(&question, (plan, &whereabouts), &run.control())?);
    }
    if !arguments.observers.is_empty() {
        let bounds = plan.bounds();
        let observer = |&MapPosition(place, z): &MapPosition| -> belvedere::Result<ask::StandingObserver> {
            let standing = ask::Standing::on_map(place, z, &frame, &bounds)?;
            let standing = ask::Standing { height: arguments.observer_height, ..standing };
            Ok(ask::StandingObserver { standing, limits: ask::ViewLimits::default() })
        };
        let question = ask::Question::Viewshed(ask::ViewshedQuestion {
            observers: arguments.observers.iter().map(observer).collect::<belvedere::Result<_>>()?,
            limits: ask::ViewLimits { max_distance: arguments.max_distance, ..ask::ViewLimits::default() },
            how_sure: how_sure(arguments),
            ..ask::ViewshedQuestion::default()
        });
        questions.extend(TileQuestion::one_by_one(&question, (plan, &whereabouts), &run.control())?);
    }
    Ok(questions)
}
