//! The answer first: a summary of few lines.

use serde_json::{Map, Number, Value};

/// Key of the remarks.
pub(super) const REMARKS: &str = "remarks";
/// Lines of a summary.
const MAX_LINES: usize = 12;
/// Files that are listed one by one.
const MAX_FILES: usize = 4;
/// Lines for remarks.
const MAX_REMARKS: usize = 3;
/// Figures of a command that marks none.
const MAX_FIGURES: usize = 6;
/// Digits of a measured figure.
const DIGITS: usize = 4;
/// Sections about the input and the work, which are no answer.
const BESIDE: [&str; 3] = ["reading", "seconds", REMARKS];

/// A line with its figures, each `<section.name>`, and parts in brackets; `None` if a figure outside brackets is not
/// there.
pub(super) fn filled(text: &str, entries: &Map<String, Value>) -> Option<String> {
    let mut line = String::new();
    let mut rest = text;
    while let Some((before, behind)) = rest.split_once('[') {
        let (optional, after) = behind.split_once(']')?;
        line.push_str(&with_figures(before, entries)?);
        line.push_str(&with_figures(optional, entries).unwrap_or_default());
        rest = after;
    }
    Some(line + &with_figures(rest, entries)?)
}

fn with_figures(text: &str, entries: &Map<String, Value>) -> Option<String> {
    let mut line = String::new();
    let mut rest = text;
    while let Some((before, behind)) = rest.split_once('<') {
        let (path, after) = behind.split_once('>')?;
        line.push_str(before);
        line.push_str(&figure(value_at(entries, path)?)?);
        rest = after;
    }
    Some(line + rest)
}

/// The answer, remarks and files.
pub(super) fn text(headlines: &[String], entries: &Map<String, Value>) -> String {
    let files = limit_lines(files(entries), MAX_FILES + 1, "files");
    let mut remarks = Vec::new();
    add_remarks(entries, &mut remarks);
    let remarks = limit_lines(remarks, MAX_REMARKS, "remarks, with -v");
    let room = MAX_LINES - files.len() - remarks.len();
    let answer = if headlines.is_empty() { last_figures(entries) } else { headlines.to_vec() };
    let lines = [limit_lines(answer, room, "lines, with -v"), remarks, files].concat();
    lines.into_iter().map(|line| line + "\n").collect()
}

/// Shortens the lines to at most `max`; the last one counts those left out.
fn limit_lines(mut lines: Vec<String>, max: usize, what: &str) -> Vec<String> {
    if lines.len() > max {
        let more = lines.len() + 1 - max;
        lines.truncate(max - 1);
        lines.push(format!("and {more} more {what}"));
    }
    lines
}

fn value_at<'a>(entries: &'a Map<String, Value>, path: &str) -> Option<&'a Value> {
    match path.split_once('.') {
        None => entries.get(path),
        Some((section, inner)) => value_at(entries.get(section)?.as_object()?, inner),
    }
}

/// A figure as people write it, or a list of them.
fn figure(value: &Value) -> Option<String> {
    match value {
        Value::Number(number) => Some(grouped(number)),
        Value::String(text) => Some(text.clone()),
        Value::Array(items) => Some(items.iter().map(plain).collect::<Vec<_>>().join(", ")),
        _ => None,
    }
}

/// A number with commas between thousands, and of a measured one the first digits.
fn grouped(number: &Number) -> String {
    let text = match number.as_f64().filter(|_| number.is_f64()) {
        Some(value) => {
            let digits = if value.abs() < 1.0 { 0 } else { format!("{:.0}", value.abs().trunc()).len() };
            format!("{value:.*}", DIGITS.saturating_sub(digits))
        }
        None => number.to_string(),
    };
    let (whole, decimals) = text.split_once('.').unwrap_or((&text, ""));
    let (sign, digits) = whole.strip_prefix('-').map_or(("", whole), |digits| ("-", digits));
    let mut text = sign.to_owned();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i) % 3 == 0 {
            text.push(',');
        }
        text.push(digit);
    }
    let decimals = decimals.trim_end_matches('0');
    if decimals.is_empty() { text } else { format!("{text}.{decimals}") }
}

/// Files and folders that were written, a line each.
fn files(entries: &Map<String, Value>) -> Vec<String> {
    let is_of_files = |name: &str| {
        ["written", "open", "files"].contains(&name) || name.ends_with("_written") && !name.ends_with("not_written")
    };
    let mut lines = Vec::new();
    for (name, value) in entries.iter().filter(|(name, _)| is_of_files(name)) {
        let name = name.replace("files", "written").replace('_', " ");
        match value {
            Value::String(path) => lines.push(format!("{name}: {path}")),
            Value::Array(paths) => lines.extend(paths.iter().map(|path| format!("{name}: {}", plain(path)))),
            _ => {}
        }
    }
    lines
}

/// Notes of all sections, and what a format had no room for.
fn add_remarks(entries: &Map<String, Value>, remarks: &mut Vec<String>) {
    for (name, value) in entries.iter().filter(|(name, _)| !BESIDE.contains(&name.as_str())) {
        let is_note = ["note", "notes"].contains(&name.as_str());
        match value {
            Value::Object(section) => add_remarks(section, remarks),
            Value::Array(notes) if is_note => remarks.extend(notes.iter().map(|note| format!("note: {}", plain(note)))),
            Value::String(note) if is_note => remarks.push(format!("note: {note}")),
            value if name.ends_with("not_written") => {
                remarks.extend(figure(value).map(|what| format!("{}: {what}", name.replace('_', " "))));
            }
            _ => {}
        }
    }
}

/// The last figures, in their order: the first are about the input.
fn last_figures(entries: &Map<String, Value>) -> Vec<String> {
    let mut lines = Vec::new();
    for (name, value) in entries.iter().filter(|(name, _)| !BESIDE.contains(&name.as_str())) {
        let words = name.replace('_', " ");
        match value {
            Value::Object(section) => {
                lines.extend(last_figures(section).into_iter().map(|line| format!("{words}, {line}")));
            }
            Value::Number(number) => lines.push(format!("{words}: {}", grouped(number))),
            _ => {}
        }
    }
    let from = lines.len().saturating_sub(MAX_FIGURES);
    lines.split_off(from)
}

pub(super) fn plain(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn entries(value: Value) -> Map<String, Value> {
        value.as_object().cloned().unwrap_or_default()
    }

    #[test]
    fn a_line_has_its_figures_with_thousands_and_is_left_out_without_them() {
        let entries = entries(
            json!({"cells": {"targets": 14400, "visible_m2": 1771.0, "share": 12.3416, "low": -1234.5, "few": 0.01596}}),
        );
        let line = |text: &str| filled(text, &entries);
        assert_eq!(line("<cells.targets> cells, <cells.visible_m2> m2").as_deref(), Some("14,400 cells, 1,771 m2"));
        assert_eq!(line("<cells.share> %, <cells.low>").as_deref(), Some("12.34 %, -1,234"));
        assert_eq!(line("<cells.few> m").as_deref(), Some("0.016 m"));
        assert_eq!(line("<cells.unproven> unproven"), None);
        assert_eq!(line("<cells>"), None);
        assert_eq!(line("<cells.share> %[, <cells.unproven> % unproven], low").as_deref(), Some("12.34 %, low"));
        assert_eq!(line("<cells.share> %[, low <cells.low>]").as_deref(), Some("12.34 %, low -1,234"));
    }

    #[test]
    fn files_are_counted_from_the_fifth_and_a_summary_has_twelve_lines() {
        let many: Vec<String> = (0..9).map(|i| format!("{i}.tif")).collect();
        let notes: Vec<String> = (0..9).map(|i| format!("eye {i}")).collect();
        let entries = entries(json!({"a": {"notes": notes}, "written": many}));
        let headlines: Vec<String> = (0..9).map(|i| format!("line {i}")).collect();
        let text = text(&headlines, &entries);
        assert_eq!(text.lines().count(), MAX_LINES);
        for line in ["line 2", "and 6 more lines, with -v", "note: eye 1", "and 7 more remarks, with -v"] {
            assert!(text.lines().any(|own| own == line), "{line}: {text}");
        }
        assert!(text.ends_with("written: 3.tif\nand 5 more files\n"), "{text}");
    }

    #[test]
    fn without_headlines_the_last_figures_are_printed() {
        let entries = entries(json!({"points": 7, "reading": {"x": 1}, "lit": {"mean": 0.5}, "seconds": {"total": 3}}));
        assert_eq!(text(&[], &entries), "points: 7\nlit, mean: 0.5\n");
    }
}
