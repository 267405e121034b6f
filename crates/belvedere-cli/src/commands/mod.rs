//! One file per command.

mod balls;
mod demo;
mod depth_map;
mod info;
mod normals;
mod query;

use crate::arguments::{Cli, Command, Usage};
use crate::summary::Summary;
use anyhow::{Context, Result};
use clap::CommandFactory;

/// Runs the command that was typed.
pub(crate) fn run(cli: &Cli) -> Result<Summary> {
    let global = &cli.global;
    if let Some(threads) = global.threads {
        if threads == 0 {
            return Err(Usage("--threads must be at least 1".to_owned()).into());
        }
        rayon::ThreadPoolBuilder::new().num_threads(threads).build_global().context("--threads")?;
    }
    match &cli.command {
        Command::Demo(arguments) => demo::run(arguments, global),
        Command::Info(arguments) => info::run(arguments, global),
        Command::Normals(arguments) => normals::run(arguments, global),
        Command::Balls(arguments) => balls::run(arguments, global),
        Command::DepthMap(arguments) => depth_map::run(arguments, global),
        Command::Query(arguments) => query::run(arguments, global),
        Command::Completions { shell } => {
            let mut script = Vec::new();
            clap_complete::generate(*shell, &mut Cli::command(), "belvedere", &mut script);
            print_raw(&script)
        }
        Command::Man => {
            let mut page = Vec::new();
            clap_mangen::Man::new(Cli::command()).render(&mut page)?;
            print_raw(&page)
        }
    }
}

fn print_raw(text: &[u8]) -> Result<Summary> {
    std::io::Write::write_all(&mut std::io::stdout().lock(), text)?;
    Ok(Summary::default())
}

/// The extension of a path in lower case, empty where it has none.
fn extension(path: &std::path::Path) -> String {
    path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default()
}
