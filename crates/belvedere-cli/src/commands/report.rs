//! `belvedere report`.

use crate::arguments::{AreaChoice, CornersArgument, Global, ReportArguments, refuse};
use crate::inputs::map_shapes::{TypedAre, shapes, wrong_shape};
use crate::inputs::windows::{FaceChoice, WindowFile, refuse_mesh};
use crate::outputs::formats::check_output;
use crate::pipeline;
use crate::run::CommandContext;
use crate::summary::Summary;
use anyhow::Result;
use belvedere::Frame;
use belvedere::apps::ask::{Days, GivenWindows};
use belvedere::io::FeatureShape;
use belvedere::sunlight_report::{ReportArea, ReportParams, ReportSource, sunlight_report};
use std::path::Path;

pub(crate) fn run(arguments: &ReportArguments, global: &Global) -> Result<Summary> {
    check_output("-o", &arguments.output, &["html"])?;
    if arguments.rule.is_some() && arguments.windows.is_none() {
        return refuse("--rule is for --windows; the rule of areas is --area-rule");
    }
    arguments.windows.as_deref().map_or(Ok(()), refuse_mesh)?;
    let plan = &arguments.scene.plan;
    if arguments.study.is_some() && plan.add.is_empty() && plan.clear.is_empty() {
        return refuse("--study counts the shade that a plan adds to areas: give the plan with --add or --clear");
    }
    let mut params = ReportParams {
        title: arguments.title.clone(),
        notes: arguments.note.clone(),
        language: arguments.language.into(),
        rule: arguments.rule.clone(),
        area_rule: arguments.area_rule.clone(),
        study: arguments.study.map(Into::into),
        days: Days {
            dates: arguments.date.clone(),
            year: arguments.year,
            time_step_min: arguments.step,
            ..Days::default()
        },
        place: arguments.sun.place(&arguments.north)?,
        command: global.command.clone(),
        date: belvedere::apps::sun::Zone::utc().date_at(now())?.to_string(),
        ..ReportParams::default()
    };
    params.check_rules()?;
    let mut run = CommandContext::new(global);
    let (present, planned) = pipeline::present_and_planned(&arguments.scene, &mut run)?;
    let mut scenes = Vec::new();
    for mut scene in [Some(present), planned].into_iter().flatten() {
        arguments.far.set(&mut scene, &mut run)?;
        scenes.push(scene.into_question_scene(None, arguments.shell.shell, &run)?);
    }
    let frame = scenes[0].frame();
    if let Some(path) = &arguments.windows {
        let file = WindowFile::read(path, &FaceChoice::default(), frame, &mut run)?;
        params.names = file.buildings(&[]);
        params.rooms = file.column_of_words("room").unwrap_or_default();
        if let GivenWindows::Each(windows) = file.given {
            params.windows = windows;
        }
    }
    for area in &arguments.area {
        params.areas.extend(areas(area, frame)?);
    }
    params.sources = run.stage("reading files again for their hashes", 0, |_| sources(arguments))?;
    let report = sunlight_report(&scenes[0], scenes.get(1), &params, &run.control())?;
    report.headlines().iter().for_each(|line| run.summary.answer(line));
    run.summary.remarks(report.remarks.iter().cloned());
    run.stage("writing", 0, |_| report.write(&arguments.output))?;
    run.summary.add("written", vec![arguments.output.display().to_string()]);
    Ok(run.finish())
}

/// Seconds of UTC since 1970.
fn now() -> f64 {
    std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).map_or(0.0, |since| since.as_secs_f64())
}

fn areas(given: &CornersArgument, frame: &Frame) -> Result<Vec<ReportArea>> {
    let mut areas = Vec::new();
    let file = match given {
        CornersArgument::File(path) => path.file_name().and_then(|name| name.to_str()),
        CornersArgument::Typed(_) => None,
    };
    for named in shapes("--area", given, TypedAre::Polygon, frame)? {
        let FeatureShape::Polygon(polygon) = named.shape else {
            return wrong_shape("--area", given, "an area is a polygon, but this file has a line or a point");
        };
        let rings = polygon.iter().map(|ring| ring.iter().map(|&[x, y, _]| [x, y]).collect()).collect();
        // what has no name of its own is called by its flag or its file
        let is_own = named.name != "--area" && !file.is_some_and(|file| named.name.starts_with(file));
        let name = if is_own { named.name } else { String::new() };
        areas.push(ReportArea { name, rings });
    }
    Ok(areas)
}

/// The files that the report rests on.
fn sources(arguments: &ReportArguments) -> belvedere::Result<Vec<ReportSource>> {
    let clouds = arguments.scene.input.clouds.iter().map(|path| ("cloud", path.as_path()));
    let plan = &arguments.scene.plan;
    let added = plan.add.iter().map(|path| ("plan", path.as_path()));
    let cleared = plan.clear.iter().filter_map(|area| match area {
        AreaChoice::File(path) => Some(("plan", path.as_path())),
        _ => None,
    });
    let windows = arguments.windows.iter().map(|path| ("windows", path.as_path()));
    let areas = arguments.area.iter().filter_map(|area| match area {
        CornersArgument::File(path) => Some(("areas", path.as_path())),
        CornersArgument::Typed(_) => None,
    });
    let far = arguments.far.terrain.iter().chain(&arguments.far.horizon).map(|path| ("terrain", path.as_path()));
    let all = clouds.chain(added).chain(cleared).chain(windows).chain(areas).chain(far);
    all.map(|(role, path): (&'static str, &Path)| ReportSource::of_path(role, path)).collect()
}
