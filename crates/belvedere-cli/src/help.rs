//! The command line with its long texts, one file for each command.

use crate::arguments::Cli;
use clap::{Arg, Command, CommandFactory};

/// Flags of how balls are built, by their names with underscores. They are also the keys of `--scene-config`.
pub(crate) const BALL_FLAGS: [&str; 15] = [
    "keep_noise",
    "keep_duplicates",
    "keep_isolated",
    "keep_strips",
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

/// Commands by task, in the order of the overview.
const GROUPS: [(&str, &[&str]); 6] = [
    ("start", &["demo", "fetch", "info", "view", "simulate"]),
    (
        "sun",
        &[
            "shadow",
            "sun-hours",
            "irradiance",
            "heat",
            "glare",
            "sky-view",
            "sun-calendar",
            "sun-position",
            "report",
            "envelope",
            "comfort",
        ],
    ),
    (
        "sight",
        &[
            "line-of-sight",
            "viewshed",
            "isovist",
            "horizon",
            "towers",
            "landmark",
            "protected-view",
            "window-views",
            "cameras",
            "survey-plan",
            "depth-map",
            "query",
        ],
    ),
    ("scene", &["balls", "calibrate", "normals", "surfaces", "trajectory", "cache"]),
    ("maps", &["difference", "city"]),
    ("other", &["ask", "bench", "describe", "completions", "man"]),
];

/// Flags that `-h` leaves out, so that it fits a screen; `--help` has all.
const RARE: &[&str] = &[
    "areas",
    "by-area",
    "air",
    "albedo",
    "back-faces",
    "ball-profile",
    "bias",
    "cell-for",
    "classes-of",
    "clear",
    "curvature",
    "curve",
    "edge-mask",
    "facing",
    "far",
    "far-output",
    "fence-height",
    "first-angle",
    "footprints",
    "frame-duration-s",
    "frames",
    "frequency-ghz",
    "fresnel-percent",
    "grid-north",
    "ground",
    "headings",
    "horizon",
    "horizons",
    "initial-radius",
    "keep-duplicates",
    "leaves",
    "linke",
    "masks",
    "max-height",
    "measures",
    "memory",
    "min-area",
    "min-distance",
    "min-sun-elevation",
    "near",
    "next-angle",
    "orient",
    "panel",
    "parts-per-row",
    "patch-division",
    "patches",
    "per-target",
    "refraction",
    "scene-config",
    "search-limit",
    "shell",
    "simplify",
    "sky-model",
    "spacing",
    "sun-cell-deg",
    "sun-elevation",
    "sun-tolerance-deg",
    "surroundings",
    "terrain",
    "tile-size",
    "tops",
    "trees",
    "unproven",
    "up",
    "vertical-fov",
    "wind-factor",
    "without",
    "year",
];
/// The same of commands with many flags.
const RARE_IN: &[(&str, &[&str])] = &[
    ("shadow", &["certain", "film", "location", "outlines", "self", "target-height"]),
    ("sun-hours", &["hourly-sun", "target-height"]),
    (
        "irradiance",
        &[
            "dc-ac-ratio",
            "footprints",
            "hourly",
            "inverter-efficiency",
            "min-cells",
            "module-efficiency",
            "system-losses",
            "target-height",
            "temperature-coefficient",
        ],
    ),
    ("cameras", &["existing", "pixels", "target-height", "tilt"]),
    ("comfort", &["directions"]),
    ("plan", &["clear-sky", "crs", "directions", "max-distance", "observer-height", "through-trees"]),
];
/// Options of all commands that `-h` shows.
const SHOWN_OF_ALL: [&str; 3] = ["json", "verbose", "help"];

/// Long help of each command: purpose, input, output, units and limits, and examples that work as printed on the files
/// of the demo.
const TEXTS: &[(&str, &str)] = &[
    ("ask", include_str!("help/ask.txt")),
    ("demo", include_str!("help/demo.txt")),
    ("simulate", include_str!("help/simulate.txt")),
    ("fetch", include_str!("help/fetch.txt")),
    ("info", include_str!("help/info.txt")),
    ("trajectory", include_str!("help/trajectory.txt")),
    ("normals", include_str!("help/normals.txt")),
    ("surfaces", include_str!("help/surfaces.txt")),
    ("balls", include_str!("help/balls.txt")),
    ("calibrate", include_str!("help/calibrate.txt")),
    ("cache", include_str!("help/cache.txt")),
    ("bench", include_str!("help/bench.txt")),
    ("depth-map", include_str!("help/depth-map.txt")),
    ("query", include_str!("help/query.txt")),
    ("line-of-sight", include_str!("help/line-of-sight.txt")),
    ("viewshed", include_str!("help/viewshed.txt")),
    ("towers", include_str!("help/towers.txt")),
    ("glare", include_str!("help/glare.txt")),
    ("landmark", include_str!("help/landmark.txt")),
    ("protected-view", include_str!("help/protected-view.txt")),
    ("cameras", include_str!("help/cameras.txt")),
    ("survey-plan", include_str!("help/survey-plan.txt")),
    ("isovist", include_str!("help/isovist.txt")),
    ("horizon", include_str!("help/horizon.txt")),
    ("shadow", include_str!("help/shadow.txt")),
    ("sky-view", include_str!("help/sky-view.txt")),
    ("irradiance", include_str!("help/irradiance.txt")),
    ("heat", include_str!("help/heat.txt")),
    ("sun-hours", include_str!("help/sun-hours.txt")),
    ("sun-position", include_str!("help/sun-position.txt")),
    ("envelope", include_str!("help/envelope.txt")),
    ("comfort", include_str!("help/comfort.txt")),
    ("report", include_str!("help/report.txt")),
    ("sun-calendar", include_str!("help/sun-calendar.txt")),
    ("window-views", include_str!("help/window-views.txt")),
    #[cfg(feature = "view")]
    ("view", include_str!("help/view.txt")),
    ("city", include_str!("help/city.txt")),
    ("difference", include_str!("help/difference.txt")),
    ("describe", include_str!("help/describe.txt")),
    ("completions", include_str!("help/completions.txt")),
    ("man", include_str!("help/man.txt")),
];

/// The same for the steps of `city`.
const STEPS_OF_CITY: &[(&str, &str)] = &[
    ("plan", include_str!("help/city-plan.txt")),
    ("run", include_str!("help/city-run.txt")),
    ("tasks", include_str!("help/city-tasks.txt")),
    ("status", include_str!("help/city-status.txt")),
    ("merge", include_str!("help/city-merge.txt")),
];

/// The command line as users see it.
pub(crate) fn command() -> Command {
    let command = Cli::command().mut_args(|argument| {
        let is_shown = SHOWN_OF_ALL.contains(&argument.get_id().as_str());
        argument.hide_short_help(!is_shown)
    });
    let command =
        TEXTS.iter().fold(command, |command, (name, text)| command.mut_subcommand(name, |sub| described(sub, text)));
    let with_step =
        |city: Command, (name, text): &(&str, &'static str)| city.mut_subcommand(name, |sub| described(sub, text));
    let command = command.mut_subcommand("city", |city| STEPS_OF_CITY.iter().fold(city, with_step));
    // a place is enough, where nothing but the sun counts
    let command = command.mut_subcommand("sun-position", |sub| {
        sub.mut_arg("clouds", |clouds| clouds.required(false).required_unless_present("location"))
    });
    let command = command.mut_subcommand("heat", |sub| {
        sub.mut_arg("height", |height| {
            with_help(height, "Height above the ground or above --surface, in metres [default: 1.1]")
        })
    });
    let command = command.mut_subcommand("sun-calendar", |sub| {
        sub.mut_arg("step", |step| with_help(step, "Time between two suns in minutes, 1/6 to 60 [default: 2]"))
    });
    let command = command.mut_subcommand("glare", |sub| {
        sub.mut_arg("step", |step| with_help(step, "Time between two suns in minutes, 1/6 to 60 [default: 1]"))
            .mut_arg("year", |year| {
                with_help(year, "Year of days that are given without a year; without days, all of it")
            })
            .mut_arg("min_elevation", |least| {
                with_help(least, "Minimum elevation of the sun in degrees; lower suns are ignored [default: 0]")
            })
    });
    // a plan writes no answer yet
    let command =
        ["shadow", "sun-hours", "sky-view", "irradiance", "viewshed"].iter().fold(command, |command, name| {
            command.mut_subcommand(name, |sub| sub.mut_arg("output", |output| output.required_unless_present("plan")))
        });
    let template = overview(&command);
    command.help_template(template)
}

/// The task that a command belongs to.
pub(crate) fn group(command: &str) -> Option<&'static str> {
    GROUPS.iter().find(|(_, commands)| commands.contains(&command)).map(|(name, _)| *name)
}

/// The help of the program, which fits a screen: its commands by task.
fn overview(program: &Command) -> String {
    let about = include_str!("help/belvedere.txt").trim_end();
    let mut text = format!("{about}\nUsage: belvedere COMMAND [OPTIONS]\n");
    for (name, commands) in GROUPS {
        text.push_str(&format!("\n{name}\n"));
        for command in commands.iter().filter_map(|command| program.find_subcommand(command)) {
            let about = command.get_about().map(ToString::to_string).unwrap_or_default();
            text.push_str(&format!("  {:<16}{about}\n", command.get_name()));
        }
    }
    let of_all: Vec<String> =
        program.get_arguments().filter_map(|argument| Some(format!("--{}", argument.get_long()?))).collect();
    text.push_str(&format!("\nOptions of all commands\n  {}\n", of_all.join(" ")));
    text
}

/// A text before and after its heading of examples.
fn parts(text: &str) -> (&str, &str) {
    let examples = text.find("\nExample").map_or(text.len(), |before| before + 1);
    let (description, examples) = text.split_at(examples);
    (description.trim_end(), examples.trim_end())
}

/// The command lines under a heading of examples, without the remarks behind them. A line that ends in a backslash goes
/// on in the next.
pub(crate) fn examples(text: &str) -> Vec<String> {
    let joined = text.replace(" \\\n     ", "");
    let lines = joined.lines().filter_map(|line| line.strip_prefix("  "));
    lines.map(|line| line.split("  ").next().unwrap_or(line).trim().to_owned()).collect()
}

/// Gives an argument that commands share a help of its own, also where the long help is shown.
fn with_help(argument: Arg, text: &'static str) -> Arg {
    argument.help(text).long_help(None)
}

fn described(command: Command, text: &'static str) -> Command {
    let (description, examples) = parts(text);
    let first = first_examples(command.get_name(), examples);
    let command = command.long_about(description).after_help(first).after_long_help(examples);
    let also = RARE_IN.iter().find(|(name, _)| *name == command.get_name()).map_or(&[][..], |(_, flags)| flags);
    command.mut_args(|argument| {
        let is_named = argument.get_long().is_some_and(|long| RARE.contains(&long) || also.contains(&long));
        let is_rare = is_named && !argument.is_required_set();
        if is_rare { argument.hide_short_help(true) } else { argument }
    })
}

/// The examples up to the first one of the command itself.
fn first_examples(command: &str, examples: &str) -> String {
    let is_own = |line: &str| line.split_whitespace().skip(1).take(2).any(|word| word == command);
    let mut has_own = false;
    let is_first = |line: &&str| {
        let begins = line.starts_with("  belvedere ");
        let is_next = begins && has_own;
        has_own |= begins && is_own(line);
        !is_next
    };
    examples.lines().take_while(is_first).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_command_stands_in_exactly_one_group() {
        for command in Cli::command().get_subcommands() {
            let count = GROUPS.iter().filter(|(_, commands)| commands.contains(&command.get_name())).count();
            assert_eq!(count, 1, "{}", command.get_name());
        }
    }

    #[test]
    fn each_rare_flag_exists() {
        let program = Cli::command();
        let steps = program.get_subcommands().flat_map(|command| command.get_subcommands().chain([command]));
        let flags: Vec<&str> = steps.flat_map(|step| step.get_arguments().filter_map(Arg::get_long)).collect();
        let rare = RARE_IN.iter().flat_map(|(_, flags)| flags.iter()).chain(RARE);
        rare.for_each(|rare| assert!(flags.contains(rare), "{rare}"));
    }
}
