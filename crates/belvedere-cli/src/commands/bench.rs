//! `belvedere bench`: how long each stage takes on this machine, from a file of points to a map of shadows.

use crate::arguments::{BenchArguments, Cli, Global, Usage};
use crate::help;
use crate::memory;
use crate::run::CommandContext;
use crate::summary::{Summary, rounded, sections, whole};
use crate::written_files;
use anyhow::{Context, Result};
use belvedere::neighbors::Instructions;
use clap::FromArgMatches;
use serde::Serialize;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

/// Pulses per m² of the simulated town.
const DENSITY: &str = "10";
/// The question put to the scene: sun, and cells of a raster of its ground.
const SHADOW: [&str; 6] = ["--sun", "200,35", "--cell", "1", "--no-cache", "-o"];

/// Runs a command that was parsed.
type RunCommand = fn(&Cli) -> Result<Summary>;

pub(crate) fn run(arguments: &BenchArguments, global: &Global, run_command: RunCommand) -> Result<Summary> {
    let folder = WorkFolder::new()?;
    let cloud = match &arguments.cloud {
        Some(path) => path.clone(),
        None => {
            let mut words: Vec<OsString> = ["simulate", "town", "--density", DENSITY, "-o"].map(OsString::from).into();
            words.extend([folder.0.join("town").into(), "--extent".into(), arguments.extent.to_string().into()]);
            measured(&words, global, run_command)?;
            folder.0.join("town").join("cloud.laz")
        }
    };
    let mut words: Vec<OsString> = vec!["shadow".into(), cloud.into()];
    words.extend(SHADOW.map(OsString::from));
    words.push(folder.0.join("shadow.tif").into());
    words.extend(arguments.flags.iter().cloned());
    let before = memory::processor_seconds();
    let found = measured(&words, global, run_command)?.into_entries();
    let processor = memory::processor_seconds().zip(before).map(|(after, before)| after - before);

    let points = found.get("points").and_then(serde_json::Value::as_f64).unwrap_or(0.0);
    let seconds = found.get("seconds").and_then(serde_json::Value::as_object).context("no stage was measured")?;
    let mut stages: Vec<StageRow> =
        seconds.iter().filter_map(|(name, s)| StageRow::of(name, s.as_f64()?, points)).collect();
    let total: f64 = stages.iter().map(|stage| stage.seconds).sum();
    stages.sort_by(|a, b| b.seconds.total_cmp(&a.seconds));

    let mut run = CommandContext::new(global);
    run.summary.add("machine", Summary::of(&Machine::this()));
    run.summary.add("points", whole(points)).add("elapsed_seconds", rounded(total, 2));
    if let Some(processor) = processor {
        run.summary.add("processor_seconds", rounded(processor, 2));
        run.summary.add("processor_us_per_point", rounded(1e6 * processor / points, 2));
    }
    if let Some(bytes) = memory::peak_bytes() {
        run.summary.add("peak_megabytes", rounded(bytes as f64 / 1e6, 0));
    }
    run.summary.add("stage", sections(&stages));
    run.summary
        .headline("belvedere <machine.version>, <machine.system>, <machine.threads> threads[ of <machine.processor>]")
        .headline("<points> points: <elapsed_seconds> s[, <processor_seconds> s of processor time, <processor_us_per_point> µs a point][, <peak_megabytes> MB]");
    for StageRow { name, seconds, us_per_point } in &stages {
        run.summary.answer(&format!("{seconds:>9.3} s {us_per_point:>8.2} µs a point  {name}"));
    }
    Ok(run.finish())
}

/// Runs a command of this program as if it were typed.
fn measured(words: &[OsString], global: &Global, run_command: RunCommand) -> Result<Summary> {
    let typed = std::iter::once(OsString::from("belvedere")).chain(words.iter().cloned());
    let program = help::command();
    let matches = program.clone().try_get_matches_from(typed).map_err(|error| Usage(error.to_string()))?;
    let mut cli = Cli::from_arg_matches(&matches).map_err(|error| Usage(error.to_string()))?;
    written_files::check(&program, &matches)?;
    (cli.global.progress, cli.global.seed) = (global.progress, global.seed);
    run_command(&cli)
}

/// A stage of the command.
#[derive(Serialize)]
struct StageRow {
    name: String,
    seconds: f64,
    us_per_point: f64,
}

impl StageRow {
    /// `None` for the sum of all.
    fn of(name: &str, seconds: f64, points: f64) -> Option<Self> {
        let us_per_point = belvedere::report::rounded(1e6 * seconds / points, 3);
        (name != "total").then(|| Self { name: name.replace('_', " "), seconds, us_per_point })
    }
}

/// Machine of the measurements.
#[derive(Serialize)]
struct Machine {
    version: &'static str,
    system: String,
    threads: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    processor: Option<String>,
    instructions: String,
}

impl Machine {
    fn this() -> Self {
        Self {
            version: env!("CARGO_PKG_VERSION"),
            system: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
            threads: rayon::current_num_threads(),
            processor: memory::processor_name(),
            instructions: format!("{:?}", Instructions::detect()),
        }
    }
}

/// A folder for files that nobody wants to keep; it goes with the value.
struct WorkFolder(PathBuf);

impl WorkFolder {
    fn new() -> Result<Self> {
        let path = std::env::temp_dir().join(format!("belvedere-bench-{}", std::process::id()));
        let shown = path.display().to_string();
        fs::create_dir(&path).with_context(|| format!("{shown}: the folder for what is measured cannot be made"))?;
        Ok(Self(path))
    }
}

impl Drop for WorkFolder {
    fn drop(&mut self) {
        // what cannot be removed lies where systems remove it themselves
        let _ = fs::remove_dir_all::<&Path>(&self.0);
    }
}
