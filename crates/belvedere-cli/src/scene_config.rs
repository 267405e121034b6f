//! Parameters of balls from a file: `--scene-config`.

use crate::arguments::Usage;
use crate::help::BALL_FLAGS;
use anyhow::{Context, Result};
use clap::parser::ValueSource;
use clap::{ArgMatches, Command};
use serde_json::{Map, Value};
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// What was typed, completed by the file that `--scene-config` names. A flag that was typed overrides the file.
pub(crate) fn matches(command: &Command, typed: Vec<OsString>) -> Result<ArgMatches> {
    let matches = command.clone().get_matches_from(&typed);
    let Some((_, of_command)) = matches.subcommand() else { return Ok(matches) };
    let Ok(Some(path)) = of_command.try_get_one::<PathBuf>("scene_config") else { return Ok(matches) };
    let mut flags = Vec::new();
    for (key, value) in &read(path)? {
        if !BALL_FLAGS.contains(&key.as_str()) {
            let known = BALL_FLAGS.join(", ");
            return Err(Usage(format!("{}: unknown key {key:?}; the keys are {known}", path.display())).into());
        }
        let has_flag = of_command.try_contains_id(key).is_ok();
        if has_flag && of_command.value_source(key) != Some(ValueSource::CommandLine) {
            flags.extend(flag(key, value).map_err(|what| Usage(format!("{}: {what}", path.display())))?);
        }
    }
    let mut completed = typed;
    // behind `--` everything is a file
    let end = completed.iter().position(|word| word == "--").unwrap_or(completed.len());
    completed.splice(end..end, flags);
    command.clone().try_get_matches_from(completed).map_err(|error| {
        let message = error.to_string();
        let first = message.lines().next().unwrap_or_default().trim_start_matches("error: ");
        Usage(format!("{}: {first}", path.display())).into()
    })
}

fn read(path: &Path) -> Result<Map<String, Value>> {
    let text = std::fs::read_to_string(path).with_context(|| path.display().to_string())?;
    match serde_json::from_str(&text) {
        Ok(Value::Object(keys)) => Ok(keys),
        Ok(_) => Err(Usage(format!("{}: expected a JSON object", path.display())).into()),
        Err(error) => Err(Usage(format!("{}: {error}", path.display())).into()),
    }
}

/// A key and its value as they are typed; nothing for a switch that is off.
fn flag(key: &str, value: &Value) -> Result<Option<OsString>, String> {
    let name = key.replace('_', "-");
    let plain = |value: &Value| match value {
        Value::String(text) => Ok(text.clone()),
        Value::Number(number) => Ok(number.to_string()),
        _ => Err(format!("{key}: expected a text, a number, true, false, or a list of texts")),
    };
    match value {
        Value::Bool(true) => Ok(Some(format!("--{name}").into())),
        Value::Bool(false) | Value::Null => Ok(None),
        Value::Array(items) => {
            let items = items.iter().map(plain).collect::<Result<Vec<_>, _>>()?;
            Ok(Some(format!("--{name}={}", items.join(",")).into()))
        }
        other => plain(other).map(|text| Some(format!("--{name}={text}").into())),
    }
}
