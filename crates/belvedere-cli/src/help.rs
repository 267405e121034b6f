//! The command line with its long texts, one file for each command.

use crate::arguments::Cli;
use clap::{Command, CommandFactory};

/// Flags of how balls are built, by their names with underscores. They are also the keys of `--scene-config`.
pub(crate) const BALL_FLAGS: [&str; 14] = [
    "keep_noise",
    "keep_duplicates",
    "keep_isolated",
    "neighbors",
    "orient",
    "method",
    "trees",
    "without",
    "initial_radius",
    "max_radius",
    "penetration",
    "first_angle",
    "next_angle",
    "ball_profile",
];

/// What a command does, its input, output, units and limits, and examples that work as printed on the files of the demo.
const TEXTS: &[(&str, &str)] = &[
    ("demo", include_str!("help/demo.txt")),
    ("simulate", include_str!("help/simulate.txt")),
    ("info", include_str!("help/info.txt")),
    ("trajectory", include_str!("help/trajectory.txt")),
    ("normals", include_str!("help/normals.txt")),
    ("balls", include_str!("help/balls.txt")),
    ("depth-map", include_str!("help/depth-map.txt")),
    ("query", include_str!("help/query.txt")),
    ("line-of-sight", include_str!("help/line-of-sight.txt")),
    ("viewshed", include_str!("help/viewshed.txt")),
    ("landmark", include_str!("help/landmark.txt")),
    ("protected-view", include_str!("help/protected-view.txt")),
    ("cameras", include_str!("help/cameras.txt")),
    ("isovist", include_str!("help/isovist.txt")),
    ("horizon", include_str!("help/horizon.txt")),
    ("shadow", include_str!("help/shadow.txt")),
    ("sky-view", include_str!("help/sky-view.txt")),
    ("irradiance", include_str!("help/irradiance.txt")),
    ("sun-hours", include_str!("help/sun-hours.txt")),
    ("envelope", include_str!("help/envelope.txt")),
    ("comfort", include_str!("help/comfort.txt")),
    ("window-views", include_str!("help/window-views.txt")),
    #[cfg(feature = "view")]
    ("view", include_str!("help/view.txt")),
    ("city", include_str!("help/city.txt")),
    #[cfg(feature = "compare")]
    ("compare", include_str!("help/compare.txt")),
    ("difference", include_str!("help/difference.txt")),
    ("describe", include_str!("help/describe.txt")),
    ("completions", include_str!("help/completions.txt")),
    ("man", include_str!("help/man.txt")),
];

/// The same for the steps of `city`.
const STEPS_OF_CITY: &[(&str, &str)] = &[
    ("plan", include_str!("help/city-plan.txt")),
    ("run", include_str!("help/city-run.txt")),
    ("status", include_str!("help/city-status.txt")),
    ("merge", include_str!("help/city-merge.txt")),
];

/// The command line as users see it.
pub(crate) fn command() -> Command {
    let command = Cli::command().long_about(include_str!("help/belvedere.txt").trim_end());
    let command =
        TEXTS.iter().fold(command, |command, (name, text)| command.mut_subcommand(name, |sub| described(sub, text)));
    let with_step =
        |city: Command, (name, text): &(&str, &'static str)| city.mut_subcommand(name, |sub| described(sub, text));
    command.mut_subcommand("city", |city| STEPS_OF_CITY.iter().fold(city, with_step))
}

/// A text before and after its heading of examples.
fn parts(text: &str) -> (&str, &str) {
    let examples = text.find("\nExample").map_or(text.len(), |before| before + 1);
    let (description, examples) = text.split_at(examples);
    (description.trim_end(), examples.trim_end())
}

/// The command lines under a heading of examples, without the remarks behind them. A line that ends in a backslash goes on in the next.
pub(crate) fn examples(text: &str) -> Vec<String> {
    let joined = text.replace(" \\\n     ", "");
    let lines = joined.lines().filter_map(|line| line.strip_prefix("  "));
    lines.map(|line| line.split("  ").next().unwrap_or(line).trim().to_owned()).collect()
}

fn described(command: Command, text: &'static str) -> Command {
    let (description, examples) = parts(text);
    command.long_about(description).after_help(examples)
}
