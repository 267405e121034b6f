//! `belvedere city`.

mod questions;

use crate::arguments::{
    City, CityMerge, CityPlan, CityRun, CityStatus, CityStep, CityTaskStep, CityTasks, Global, PlanArguments, Usage,
    refuse,
};
use crate::in_tiles::{PROGRAM, planned, refuse_failed, report_plan};
use crate::outputs::formats::{check_folder, check_output};
use crate::run::CommandContext;
use crate::summary::{Summary, rounded};
use anyhow::Result;
use belvedere::apps::ask::remark_on_cleared;
use belvedere::io::Insistence;
use belvedere::{Error, Parameter};
use belvedere_tiles::{
    Plan, PlanParams, RunParams, Shard, Steps, UnfinishedRun, merge, run as run_tiles, status as status_of,
};
use std::time::Instant;

pub(crate) fn run(arguments: &City, global: &Global) -> Result<Summary> {
    match &arguments.step {
        CityStep::Plan(arguments) => plan(arguments, global),
        CityStep::Run(arguments) => run_plan(arguments, global),
        CityStep::Tasks(arguments) => tasks(arguments),
        CityStep::Status(arguments) => status(arguments),
        CityStep::Merge(arguments) => merge_tiles(arguments, global),
    }
}

fn plan(arguments: &CityPlan, global: &Global) -> Result<Summary> {
    questions::check(arguments)?;
    check_folder(&arguments.output)?;
    let mut run = CommandContext::new(global);
    let params = PlanParams {
        clouds: arguments.clouds.clone(),
        crs: arguments.crs.clone(),
        crs_against_files: if arguments.crs_override { Insistence::Insist } else { Insistence::Refuse },
        flown: arguments.flown,
        tile_size: arguments.tile_size,
        cells: questions::cells(arguments)?,
        places: arguments.observers.iter().filter(|place| place.1.is_none()).map(|place| place.0).collect(),
        memory: arguments.memory.map(|memory| memory.0),
        program: PROGRAM.to_owned(),
    };
    let plan = Plan::make(&params, &run.control())?;
    let changes = PlanArguments { add: arguments.add.clone(), clear: arguments.clear.clone() };
    let latitude = arguments.sun.latitude();
    let plan = planned(plan, &changes, Some(&arguments.far_terrain), Some((arguments.trees.choice()?, latitude)))?;
    let questions = questions::questions(arguments, &plan, &mut run)?;
    let plan = plan.with_questions(questions, &run.control()).map_err(|error| match error {
        Error::InvalidParameter { parameter: Parameter::Questions, .. } => Usage(error.to_string()).into(),
        other => anyhow::Error::from(other),
    })?;
    if !arguments.clear.is_empty() && !plan.clears_anything(&run.control())? {
        run.summary.remarks(remark_on_cleared(0));
    }
    plan.write(&arguments.output)?;
    report_plan(&plan, &arguments.output, &mut run);
    Ok(run.finish())
}

fn run_plan(arguments: &CityRun, global: &Global) -> Result<Summary> {
    let plan = Plan::read(&arguments.run)?;
    let mut run = CommandContext::new(global);
    let start = Instant::now();
    let shard = arguments.shard.map_or_else(Shard::default, |share| Shard { number: share.number, of: share.of });
    let steps = if arguments.balls_only { Steps::Balls } else { Steps::All };
    let params = RunParams { shard, steps, max_balls: None, seconds: &|| start.elapsed().as_secs_f64() };
    let report = run_tiles(&plan, &arguments.run, &params, &run.control())?;
    refuse_failed(&report, "the next run tries what failed again")?;
    run.summary.add_report(&report);
    run.summary.remarks(report.remarks());
    run.summary
        .add("written", arguments.run.display().to_string())
        .headline("balls of <balls_made> tiles made, and <answers_made> tiles of results")
        .headline("done before: <already_done>");
    Ok(run.finish())
}

/// Maximum number of jobs of a step by default.
const USUAL_TASKS: usize = 64;

fn tasks(arguments: &CityTasks) -> Result<Summary> {
    let plan = Plan::read(&arguments.run)?;
    let count = arguments.count.unwrap_or(plan.tiles.len().clamp(1, USUAL_TASKS));
    let folder = arguments.run.display().to_string();
    let is_plain = |c: char| c.is_alphanumeric() || "/._-+,:=@%".contains(c);
    let folder = match folder.chars().all(is_plain) {
        true => folder,
        false => format!("'{}'", folder.replace('\'', r"'\''")),
    };
    let steps = [(CityTaskStep::Balls, " --balls-only"), (CityTaskStep::Results, "")];
    let wanted = steps.into_iter().filter(|(step, _)| arguments.step.is_none_or(|only| only == *step));
    let command = |flag: &str, number: usize| format!("belvedere city run {folder} --shard {number}/{count}{flag}");
    let commands: Vec<String> = wanted
        .flat_map(|(_, flag)| (1..=count).map(move |number| (flag, number)))
        .map(|(f, n)| command(f, n))
        .collect();
    let mut summary = Summary::default();
    commands.iter().for_each(|line| {
        summary.headline(line.as_str());
    });
    summary.add("tasks", commands);
    Ok(summary)
}

fn status(arguments: &CityStatus) -> Result<Summary> {
    let plan = Plan::read(&arguments.run)?;
    let found = status_of(&plan, &arguments.run);
    let mut summary = Summary::default();
    summary.add("tiles", found.tiles).add("is_complete", found.is_complete());
    summary.headline(if found.is_complete() { "complete: <tiles> tiles" } else { "not complete: <tiles> tiles" });
    for stage in &found.stages {
        let mut section = Summary::of(stage);
        section.add("seconds", rounded(stage.seconds, 1));
        summary.add(&stage.name, section);
        summary.headline(format!("{0}: <{0}.done> done, <{0}.left> left", stage.name));
    }
    Ok(summary)
}

fn merge_tiles(arguments: &CityMerge, global: &Global) -> Result<Summary> {
    check_output("-o", &arguments.output, &["tif"])?;
    let plan = Plan::read(&arguments.run)?;
    let names = || plan.questions.iter().map(|one| one.name.as_str()).collect::<Vec<_>>().join(", ");
    let question = match (&arguments.result, &plan.questions[..]) {
        (None, [only]) => only,
        (None, _) => return refuse(format!("--result is missing: give one of {}", names())),
        (Some(name), questions) => questions
            .iter()
            .find(|question| &question.name == name)
            .ok_or_else(|| Usage(format!("--result {name}: the results are {}", names())))?,
    };
    let mut run = CommandContext::new(global);
    let unfinished = if arguments.unfinished { UnfinishedRun::Merged } else { UnfinishedRun::Refused };
    let merged = run.stage("merging", 0, |control| {
        merge(&plan, &arguments.run, question, &arguments.output, unfinished, control)
    })?;
    run.summary.add("tiles", merged.tiles).add("tiles_empty", merged.empty).add("tiles_missing", merged.missing);
    run.summary.headline("merged <tiles> tiles; on <tiles_empty> others nothing is");
    run.summary.remarks(merged.remarks());
    run.summary.add("written", arguments.output.display().to_string());
    Ok(run.finish())
}
