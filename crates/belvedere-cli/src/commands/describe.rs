//! `belvedere describe`: the command line as data, from the same model that parses it.

use crate::arguments::Numbers;
use crate::help::{self, BALL_FLAGS};
use crate::summary::Summary;
use crate::written_files;
use clap::builder::StyledStr;
use clap::{Arg, ArgAction, Command};
use serde_json::{Value, json};
use std::any::TypeId;
use std::path::PathBuf;

pub(crate) fn run() -> Summary {
    let program = help::command();
    let mut summary = Summary::default();
    summary
        .is_report()
        .add("name", program.get_name())
        .add("version", env!("CARGO_PKG_VERSION"))
        .add("summary", text(program.get_about()))
        .add("global_parameters", program.get_arguments().map(parameter).collect::<Vec<_>>())
        .add("commands", program.get_subcommands().flat_map(steps).collect::<Vec<_>>());
    summary
}

/// A command, or the steps of one that has steps, under their names of two words.
fn steps(of: &Command) -> Vec<Value> {
    let name = |step: &Command| format!("{} {}", of.get_name(), step.get_name());
    let steps: Vec<Value> = of.get_subcommands().map(|step| command(&name(step), step)).collect();
    if steps.is_empty() { vec![command(of.get_name(), of)] } else { steps }
}

fn command(name_of: &str, command: &Command) -> Value {
    let examples = help::examples(&text(command.get_after_long_help()));
    let one_of: Vec<Value> = command
        .get_groups()
        .filter(|group| (*group).clone().is_required_set())
        .map(|group| {
            let of_group = |argument: &&Arg| group.get_args().any(|id| id == argument.get_id());
            command.get_arguments().filter(of_group).map(name).collect::<Vec<_>>().into()
        })
        .collect();
    json!({
        "name": name_of,
        "group": name_of.split(' ').next().and_then(help::group),
        "summary": text(command.get_about()),
        "description": text(command.get_long_about()),
        "examples": examples,
        "required_one_of": one_of,
        "parameters": command.get_arguments().map(parameter).collect::<Vec<_>>(),
    })
}

fn parameter(argument: &Arg) -> Value {
    let short_text = text(argument.get_help());
    let (short_text, default_text) = match short_text.split_once(" [default") {
        Some((before, after)) => {
            (before.to_owned(), after.trim_end_matches(']').split_once(": ").map(|(_, v)| v.to_owned()))
        }
        None => (short_text, None),
    };
    let defaults: Vec<String> =
        argument.get_default_values().iter().map(|value| value.to_string_lossy().into_owned()).collect();
    let takes_value = argument.get_action().takes_values();
    let default = (takes_value && !defaults.is_empty()).then(|| defaults.join(","));
    let choices: Vec<Value> = argument
        .get_possible_values()
        .iter()
        .filter(|_| takes_value)
        .map(|value| json!({ "name": value.get_name(), "text": text(value.get_help()) }))
        .collect();
    json!({
        "name": name(argument),
        "short": argument.get_short().map(|short| format!("-{short}")),
        "type": kind(argument),
        "value_name": argument.get_value_names().filter(|_| takes_value).and_then(<[_]>::first).map(|name| name.as_str()),
        "unit": unit(argument),
        "written": takes_value && written_files::is_written(argument),
        "formats": if matches!(kind(argument), "path" | "text") { formats(&short_text) } else { Vec::new() },
        "choices": choices,
        "required": argument.is_required_set(),
        "repeatable": matches!(argument.get_action(), ArgAction::Append),
        "default": default.or(default_text),
        "heading": argument.get_help_heading(),
        "builds_balls": BALL_FLAGS.contains(&argument.get_id().as_str()),
        "text": short_text,
        "details": text(argument.get_long_help()),
    })
}

fn name(argument: &Arg) -> String {
    argument.get_long().map_or_else(|| argument.get_id().to_string(), |long| format!("--{long}"))
}

fn text(text: Option<&StyledStr>) -> String {
    text.map(ToString::to_string).unwrap_or_default()
}

fn kind(argument: &Arg) -> &'static str {
    if !argument.get_action().takes_values() {
        return "flag";
    }
    if !argument.get_possible_values().is_empty() {
        return "choice";
    }
    let parsed = argument.get_value_parser().type_id();
    let is = |types: &[TypeId]| types.iter().any(|one| parsed == *one);
    if is(&[TypeId::of::<f32>(), TypeId::of::<f64>()]) {
        "number"
    } else if is(&[
        TypeId::of::<usize>(),
        TypeId::of::<u64>(),
        TypeId::of::<u16>(),
        TypeId::of::<u8>(),
        TypeId::of::<i16>(),
    ]) {
        "integer"
    } else if is(&[TypeId::of::<Numbers<2>>(), TypeId::of::<Numbers<3>>()]) {
        "numbers"
    } else if is(&[TypeId::of::<PathBuf>()]) {
        if written_files::is_folder(argument) { "folder" } else { "path" }
    } else {
        "text"
    }
}

/// The extensions of the files that a parameter names, by its text.
fn formats(text: &str) -> Vec<String> {
    let word = |c: char| c.is_whitespace() || "(),;:".contains(c);
    let format = |word: &str| match word {
        "GeoJSON" => Some(".geojson".to_owned()),
        _ => {
            word.strip_prefix('.').is_some_and(|rest| rest.starts_with(char::is_alphanumeric)).then(|| word.to_owned())
        }
    };
    text.split(word).filter_map(format).collect()
}

/// The unit of a number, by the name of its value in the help.
fn unit(argument: &Arg) -> Option<&'static str> {
    let name = argument.get_value_names().and_then(<[_]>::first)?;
    match name.as_str() {
        "M" => Some("m"),
        "M2" => Some("m2"),
        "DEG" => Some("degree"),
        "MIN" => Some("minute"),
        "S" => Some("s"),
        "M_PER_S" => Some("m/s"),
        "MRAD" => Some("mrad"),
        "PULSES_PER_M2" => Some("1/m2"),
        "HPA,C" => Some("hPa, degree Celsius"),
        "AZ,EL" | "LAT,LON" => Some("degree"),
        _ => None,
    }
}
