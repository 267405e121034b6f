//! `belvedere sun-calendar`.

use crate::arguments::{Global, MapPosition, SunCalendarArguments, refuse};
use crate::inputs::typed_places::on_map;
use crate::inputs::windows::{FaceChoice, WindowFile, refuse_mesh};
use crate::outputs::formats::check_outputs;
use crate::pipeline::{self, KeepPoints};
use crate::run::CommandContext;
use crate::summary::Summary;
use anyhow::Result;
use belvedere::apps::ask::{self, Ask, Places, Reach, position_on_map, standing_on_map};
use belvedere::results::write_calendar;

pub(crate) fn run(arguments: &SunCalendarArguments, global: &Global) -> Result<Summary> {
    check_outputs("-o", &arguments.output, &["csv", "ics"])?;
    let typed = &arguments.places.at;
    MapPosition::refuse_twice("--at", typed)?;
    if arguments.rule.is_none() && !arguments.when.is_given() {
        return refuse("days are missing: give --date DAY, --from and --to, or --rule RULE");
    }
    let mut question = ask::SunCalendarQuestion {
        days: arguments.when.days(),
        rule: arguments.rule.clone(),
        place: arguments.sun.place(&arguments.north)?,
        ..ask::SunCalendarQuestion::default()
    };
    question.check()?;
    arguments.places.windows.as_deref().map_or(Ok(()), refuse_mesh)?;
    if let (false, Some((crs, bounds))) = (typed.is_empty(), on_map(&arguments.scene.input)?) {
        typed.iter().try_for_each(|place| position_on_map(place.0, &crs, bounds).map(|_| ()))?;
    }
    let mut run = CommandContext::new(global);
    let mut scene = pipeline::scene(&arguments.scene, KeepPoints::Keep, &mut run)?;
    arguments.far.set(&mut scene, &mut run)?;
    let scene = scene.into_question_scene(Some(&arguments.ground), arguments.shell.shell, &run)?;
    let mut names = Vec::new();
    let places = match &arguments.places.windows {
        Some(path) => {
            let file = WindowFile::read(path, &FaceChoice::default(), scene.frame(), &mut run)?;
            names = file.buildings(&[]);
            question.windows = file.given;
            Places::Scene
        }
        None => {
            let typed = typed.iter().map(|place| (place.0, place.1));
            let height = arguments.height.map(f64::from);
            Places::At(standing_on_map(typed, height, Reach::Cloud, &scene)?, arguments.ground.points())
        }
    };
    let answers = run.ask(&scene, &question, &places)?;
    for output in &arguments.output {
        run.stage("writing", 0, |_| write_calendar(output, &answers.found, &names))?;
    }
    run.summary.add_paths("written", &arguments.output);
    Ok(run.finish())
}
