//! Help texts show examples, and the examples work as printed.

use crate::common::{Workplace, house};
use std::collections::BTreeSet;
use std::path::Path;

const COMMANDS: [&str; 39] = [
    "ask",
    "demo",
    "fetch",
    "simulate",
    "info",
    "trajectory",
    "normals",
    "balls",
    "calibrate",
    "cache",
    "bench",
    "depth-map",
    "query",
    "line-of-sight",
    "viewshed",
    "towers",
    "landmark",
    "protected-view",
    "cameras",
    "survey-plan",
    "isovist",
    "horizon",
    "envelope",
    "comfort",
    "report",
    "sun-calendar",
    "window-views",
    "irradiance",
    "glare",
    "shadow",
    "sky-view",
    "sun-hours",
    "sun-position",
    "city",
    "view",
    "difference",
    "describe",
    "completions",
    "man",
];

/// The command lines in a help text: what follows a heading "Example:" or "Examples:", without remarks behind it.
fn examples(help: &str) -> Vec<String> {
    // a line that ends in a backslash goes on in the next
    let joined = help.replace(" \\\n     ", "");
    let from = joined.lines().skip_while(|line| !line.starts_with("Example"));
    let lines = from.filter_map(|line| line.strip_prefix("  belvedere "));
    // remarks stand two blanks or more behind the command
    lines.map(|line| line.split("  ").next().unwrap_or(line).trim().to_owned()).collect()
}

/// The words of a command line as a shell would part them, where double quotes are all it has.
fn words(line: &str) -> Vec<String> {
    let mut words = vec![];
    for (i, part) in line.split('"').enumerate() {
        if i % 2 == 1 {
            words.push(part.to_owned());
        } else {
            words.extend(part.split_ascii_whitespace().map(str::to_owned));
        }
    }
    words
}

#[test]
fn every_command_shows_an_example_of_itself() {
    let place = Workplace::new();
    for command in COMMANDS {
        for arguments in [format!("help {command}"), format!("{command} --help"), format!("{command} -h")] {
            let run = place.run(&arguments);
            assert_eq!((run.status, run.stderr.as_str()), (0, ""), "{arguments}");
            let examples = examples(&run.stdout);
            assert!(examples.iter().any(|line| line.starts_with(command)), "{arguments}: {examples:?}");
        }
    }
    let overview = place.run("--help");
    assert_eq!(overview.status, 0);
    for command in COMMANDS {
        assert!(overview.stdout.lines().any(|line| line.trim_start().starts_with(command)), "{command}");
    }
    assert!(overview.stdout.contains("belvedere demo"));
    assert_eq!(place.run("--version").stdout.trim(), concat!("belvedere ", env!("CARGO_PKG_VERSION")));
    assert_eq!(place.run("").status, 2, "without a command the help is no result");
}

/// Lines of a screen, and characters of a line.
const SCREEN: [usize; 2] = [60, 100];

#[test]
fn the_overview_and_every_short_help_fit_a_screen() {
    let place = Workplace::new();
    let steps = ["city plan", "city run", "city tasks", "city status", "city merge"].map(|step| format!("{step} -h"));
    let of_commands = COMMANDS.iter().map(|command| format!("{command} -h"));
    let mut too_long = Vec::new();
    for arguments in ["--help", "-h", "help"].map(str::to_owned).into_iter().chain(of_commands).chain(steps) {
        let run = place.command(&arguments).env("COLUMNS", SCREEN[1].to_string()).output().unwrap();
        let text = String::from_utf8(run.stdout).unwrap();
        // a usage line is as long as its command has required flags
        let is_wide = |line: &&str| line.chars().count() > SCREEN[1] && !line.starts_with("Usage: ");
        let wide: Vec<&str> = text.lines().filter(is_wide).collect();
        if text.lines().count() > SCREEN[0] || !wide.is_empty() {
            too_long.push(format!("{arguments}: {} lines, {wide:?}", text.lines().count()));
        }
    }
    assert!(too_long.is_empty(), "{too_long:#?}");
}

#[test]
fn commands_are_listed_by_task() {
    let place = Workplace::new();
    let overview = place.run("--help").stdout;
    let groups = ["start", "sun", "sight", "scene", "maps", "other"];
    let headings: Vec<&str> = overview.lines().filter(|line| groups.contains(line)).collect();
    assert_eq!(headings, groups);
    for command in place.summary("describe")["commands"].as_array().unwrap() {
        assert!(groups.contains(&command["group"].as_str().unwrap()), "{command}");
    }
    // without --json the list is text
    assert!(place.run("describe").stdout.contains("group: sun"));
}

#[test]
fn completions_and_manual_name_every_command() {
    let place = Workplace::new();
    for arguments in ["completions bash", "completions zsh", "completions fish", "completions powershell", "man"] {
        let run = place.run(arguments);
        assert_eq!((run.status, run.stderr.as_str()), (0, ""), "{arguments}");
        for command in COMMANDS {
            let in_roff = command.replace('-', "\\-");
            assert!(run.stdout.contains(command) || run.stdout.contains(&in_roff), "{arguments}: {command}");
        }
        assert_eq!(place.run(&format!("{arguments} --json")).stdout, run.stdout, "a script is no summary");
    }
    place.refusal(2, "completions tcl", &["tcl", "bash"]);
}

#[test]
fn every_example_works_as_printed() {
    let place = Workplace::new();
    let demo = place.run("demo -o demo");
    assert_eq!(demo.status, 0, "{demo:?}");
    place.write_folder("FOLDER", &house());
    let mut done = BTreeSet::new();
    let steps = ["city plan", "city run", "city tasks", "city status", "city merge"];
    let of_help =
        COMMANDS.iter().chain(&steps).flat_map(|command| examples(&place.run(&format!("help {command}")).stdout));
    let of_help: Vec<String> = of_help.collect();
    for example in of_help.into_iter().chain(cookbook()) {
        // what follows > is for the shell
        let line = example.split(" > ").next().unwrap();
        let words = words(line);
        // the server of a page runs until Ctrl-C, and surveys are on the internet: see the tests of `view` and `fetch`
        let is_elsewhere = line.starts_with("fetch ") || line.starts_with("view ") && !line.contains("--export");
        if !done.insert(words.clone()) || is_elsewhere {
            continue;
        }
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        let run = place.run_with("", &words);
        // the town of the demo is small: much of it is near its edge
        let is_edge = |line: &str| line.starts_with("warning: ") && line.contains("near the edge of the cloud");
        // random lines, and the table of them that a later example reads, begin and end anywhere
        let is_of_lines = example.starts_with("line-of-sight ");
        let is_random = |text: &str| is_of_lines && text.contains("have an end inside an obstacle");
        let is_known = |line: &str| is_edge(line) || is_random(line) || line.starts_with("note: ");
        assert!(run.status == 0 && run.stderr.lines().all(is_known), "{example}: {run:?}");
    }
}

/// The commands of the cookbook.
fn cookbook() -> Vec<String> {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/cookbook.md");
    let page = std::fs::read_to_string(page).unwrap();
    let blocks = page.split("```sh\n").skip(1).filter_map(|rest| rest.split("```").next());
    let lines: Vec<String> =
        blocks.flat_map(|block| block.replace(" \\\n   ", "").lines().map(str::to_owned).collect::<Vec<_>>()).collect();
    let commands = lines.iter().filter_map(|line| line.strip_prefix("belvedere "));
    let commands: Vec<String> =
        commands.map(|line| line.split(" #").next().unwrap_or(line).trim().to_owned()).collect();
    assert!(commands.len() > 30, "{commands:?}");
    commands
}
