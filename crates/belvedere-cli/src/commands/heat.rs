//! `belvedere heat`.

use crate::arguments::{Global, HeatArguments};
use crate::outputs::targets::TargetOutput;
use crate::pipeline::KeepPoints;
use crate::run::CommandContext;
use crate::summary::Summary;
use anyhow::Result;
use belvedere::apps::ask::{self, Ask, Days, SunPlace};
use belvedere::apps::heat::SurfaceParams;
use belvedere::io::read_weather;
use std::sync::Arc;

pub(crate) fn run(arguments: &HeatArguments, global: &Global) -> Result<Summary> {
    arguments.places.check(&arguments.outputs)?;
    let mut run = CommandContext::new(global);
    // a mistyped weather file must not be found out after the balls were made
    let weather = run.stage("reading weather", 0, |_| read_weather(&arguments.weather))?;
    let question = question(arguments, weather)?;
    question.check()?;
    let scene = arguments.places.scene(&arguments.scene, arguments.shell.shell, KeepPoints::Keep, &mut run)?;
    let (places, source) = arguments.places.places(&scene, &mut run)?;
    let answers = run.ask(&scene, &question, &places)?;
    let shown = TargetOutput::new(&answers.found, source, &scene);
    shown.write(&arguments.outputs, &answers.measures, &mut run)?;
    shown.write_edge_mask(arguments.places.edge_mask.as_deref(), &mut run)?;
    Ok(run.finish())
}

fn question(arguments: &HeatArguments, weather: belvedere::weather::Weather) -> Result<ask::HeatQuestion> {
    let usual = ask::HeatQuestion::default();
    let surfaces =
        SurfaceParams { ground: arguments.cover.into(), warming: arguments.warming.unwrap_or(usual.surfaces.warming) };
    Ok(ask::HeatQuestion {
        file: arguments.weather.display().to_string(),
        weather: Some(Arc::new(weather)),
        days: Days {
            dates: arguments.date.clone(),
            between: arguments.from.clone().zip(arguments.to.clone()).map(|(from, to)| [from, to]),
            ..Days::default()
        },
        hours: arguments.between.map(|hours| hours.0),
        place: SunPlace {
            location: arguments.location.as_ref().map(|location| location.0),
            zone: arguments.zone.clone(),
            ..SunPlace::default()
        },
        body: arguments.body.into(),
        surfaces,
        trees: arguments.trees.choice()?,
        parts: arguments.parts.unwrap_or(usual.parts),
        wind_factor: arguments.wind_factor.unwrap_or(usual.wind_factor),
        by_hour: arguments.by_hour,
        pet: arguments.pet,
    })
}
