//! `compare`: every method on the same places and questions, judged by exact answers.

mod arguments;
mod case;
mod held_out;
mod judge;
mod memory;
mod pictures;
mod place;
mod report;
mod results;
mod run;
mod scanners;
mod table;

use anyhow::{Context, Result};
use arguments::{Compare, Usage};
use belvedere::io::atomic;
use belvedere_baselines::methods::{Listing, method_keys, methods};
use case::{ComparisonCase, STREET_OBSERVERS, bounds_of};
use clap::Parser;
use place::ComparisonPlace;
use results::{MethodResult, PlaceResult, keep, kept};
use run::Run;
use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments = Compare::parse();
    match run(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            run::print_error(&error);
            if error.downcast_ref::<Usage>().is_some() { ExitCode::from(2) } else { ExitCode::FAILURE }
        }
    }
}

fn run(arguments: &Compare) -> Result<()> {
    if let Some(threads) = arguments.threads {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build_global().context("--threads")?;
    }
    if !arguments.scene.is_empty() && arguments.mesh.is_none() {
        return Err(Usage("--clouds needs --mesh, the exact surface for comparison".to_owned()).into());
    }
    if arguments.trajectory.is_some() && arguments.scene.is_empty() && arguments.held_out.is_empty() {
        return Err(Usage("--trajectory needs --clouds or --held-out".to_owned()).into());
    }
    let about_density = arguments.check_density()?;
    let models: Vec<&str> = arguments.model.iter().map(|model| model.name.as_str()).chain(place::MODELS).collect();
    arguments.check_methods(&method_keys(&models))?;
    let folder = &arguments.output;
    let folders = [folder.clone(), folder.join("results"), folder.join("pictures")];
    let missing: Vec<_> = folders.iter().filter(|folder| !folder.exists()).collect();
    folders.iter().try_for_each(|folder| atomic::make_folder(folder))?;
    let mut run = Run::new(arguments.verbose);
    run.warnings.extend(about_density);
    let compared = compare_all(arguments, &mut run);
    if compared.is_err() {
        // those that hold a result already stay
        missing.into_iter().rev().for_each(|folder| drop(std::fs::remove_dir(folder)));
    }
    compared
}

fn compare_all(arguments: &Compare, run: &mut Run) -> Result<()> {
    let folder = &arguments.output;
    let mut found = report::ComparisonResults::default();
    for place in ComparisonPlace::all(arguments) {
        compare_on(&place, arguments, run, &mut found)?;
    }
    for cloud in &arguments.held_out {
        found.held_out.extend(held_out::judge_all(cloud, arguments, run)?);
    }
    found.write(folder, arguments.page.as_deref())?;
    let page = folder.join("report.html").display().to_string();
    if arguments.json {
        let summary = serde_json::json!({ "results": found.to_json()?, "warnings": run.warnings, "open": page });
        return run::print(&format!("{summary:#}\n"));
    }
    for warning in run.warnings.iter().filter(|_| !arguments.quiet) {
        run::note(&format!("warning: {warning}"));
    }
    if arguments.quiet { Ok(()) } else { run::print(&format!("{}open: {page}\n", found.essence())) }
}

/// Judges every method on a place, taking over what an earlier run has found.
fn compare_on(
    place: &ComparisonPlace,
    arguments: &Compare,
    run: &mut Run,
    found: &mut report::ComparisonResults,
) -> Result<()> {
    let name = place.name();
    let results = arguments.output.join("results");
    let version = env!("CARGO_PKG_VERSION");
    let made_from = format!(
        "belvedere {version}; {}; {} targets; {STREET_OBSERVERS} in streets; seed {}",
        place.made_from(),
        arguments.targets,
        arguments.seed
    );
    let place_file = results.join(format!("{name}.json"));
    let listed: Option<PlaceResult> = kept(&place_file, &made_from);
    let method_file = |key: &str| results.join(format!("{name}--{key}.json"));
    if let Some(done) = &listed {
        arguments.check_methods(&done.methods)?;
        let all: Option<Vec<MethodResult>> = done
            .methods
            .iter()
            .filter(|key| arguments.wants(key, done.listing(key)))
            .map(|key| kept(&method_file(key), &made_from))
            .collect();
        if let Some(all) = all {
            found.places.push(done.clone());
            found.methods.extend(all);
            return Ok(());
        }
    }

    let (ingredients, warnings) = run.stage("building place", || place.make())?;
    run.warnings.extend(warnings);
    let case =
        run.stage("testing lines of sight", || ComparisonCase::new(ingredients, arguments.targets, arguments.seed))?;
    let survey = case.survey();
    let methods = methods(&survey);
    arguments.check_methods(&methods.iter().map(|method| method.key.clone()).collect::<Vec<_>>())?;
    let described = match listed {
        Some(listed) => listed,
        None => {
            let described =
                run.stage("auditing balls", || describe(&case, &name, &made_from, &methods, arguments.seed))?;
            keep(&place_file, &described)?;
            described
        }
    };
    found.places.push(described);
    for method in methods.iter().filter(|method| arguments.wants(&method.key, method.listing)) {
        let file = method_file(&method.key);
        if let Some(result) = kept(&file, &made_from) {
            found.methods.push(result);
            continue;
        }
        let (result, shown) = run.stage("comparing methods", || {
            judge::judge(&case, method, (&name, made_from.clone(), place.scanner()), arguments.seed)
        });
        if arguments.verbose {
            run::note(&format!("{name}: {}", method.title));
        }
        if let Some(shown) = shown {
            let picture = picture_file(&arguments.output, &name, &method.key);
            pictures::write_errors(&picture, &case, &method.title, &shown.answers)?;
        }
        keep(&file, &result)?;
        found.methods.push(result);
    }
    Ok(())
}

fn describe(
    case: &ComparisonCase,
    name: &str,
    made_from: &str,
    methods: &[belvedere_baselines::methods::Method<'_>],
    seed: u64,
) -> Result<PlaceResult> {
    let belvedere::Bounds { low, high } = bounds_of(&case.place.cloud)?;
    let (audit, ablation) = judge::audit_published(case, seed)?;
    Ok(PlaceResult {
        made_from: made_from.to_owned(),
        place: name.to_owned(),
        points: case.place.cloud.len(),
        area_m2: f64::from(high[0] - low[0]) * f64::from(high[1] - low[1]),
        triangles: case.place.scene.triangles.len(),
        methods: methods.iter().map(|method| method.key.clone()).collect(),
        when_named: methods.iter().filter(|m| m.listing != Listing::Always).map(|m| m.key.clone()).collect(),
        blocked_in_truth: judge::blocked_in_truth(case),
        audit,
        ablation,
        answers: judge::worth_of_answers(case)?,
    })
}

fn picture_file(folder: &Path, place: &str, method: &str) -> std::path::PathBuf {
    folder.join("pictures").join(format!("{place}--{method}.png"))
}
