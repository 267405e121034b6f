//! Summary of a command, for people and as JSON.

use crate::arguments::Global;
use belvedere::apps::ask::{Remark, remark_on_left_out};
use belvedere::cast::to_i64;
use belvedere::io::WriteReport;
use belvedere::report;
use belvedere::shown::{is_command, printable};
use serde::Serialize;
use serde_json::{Map, Value};
use short::{REMARKS, plain};
use std::io::Write;
use std::path::Path;
use std::process::ExitCode;

mod short;

/// Named figures and sections, in order, and those of them that are the answer.
#[derive(Clone, Default)]
pub(crate) struct Summary {
    entries: Map<String, Value>,
    headlines: Vec<String>,
    extent: SummaryDetail,
}

/// Extent of a summary printed as text.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
enum SummaryDetail {
    /// The headlines, remarks and files; all of it with `--verbose`.
    #[default]
    Short,
    /// All of it: a report is the answer.
    Whole,
}

impl Summary {
    /// Adds a line of the answer. `<section.name>` becomes that figure. A line, or a part in brackets, about a figure
    /// that is not there is left out.
    pub(crate) fn headline(&mut self, text: impl AsRef<str>) -> &mut Self {
        self.headlines.extend(short::filled(text.as_ref(), &self.entries));
        self
    }

    /// Adds a line of the answer as it is.
    pub(crate) fn answer(&mut self, line: &str) {
        self.headlines.push(line.to_owned());
    }

    /// Marks all figures as the answer.
    pub(crate) fn is_report(&mut self) -> &mut Self {
        self.extent = SummaryDetail::Whole;
        self
    }

    /// Adds a figure, a text, a list or a section.
    pub(crate) fn add(&mut self, name: &str, value: impl Into<Value>) -> &mut Self {
        self.entries.insert(name.to_owned(), value.into());
        self
    }

    /// Adds the names of files.
    pub(crate) fn add_paths(&mut self, name: &str, paths: impl IntoIterator<Item = impl AsRef<Path>>) -> &mut Self {
        let names = paths.into_iter().map(|path| path.as_ref().display().to_string());
        self.add(name, names.collect::<Vec<_>>())
    }

    /// The remarks alone.
    pub(crate) fn only_remarks(self) -> Self {
        let entries = self.entries.into_iter().filter(|(name, _)| name == REMARKS).collect();
        Self { entries, ..Self::default() }
    }

    /// The figures, sections and remarks.
    pub(crate) fn into_entries(self) -> Map<String, Value> {
        self.entries
    }

    /// Adds all figures of `other`.
    pub(crate) fn add_all(&mut self, other: Self) -> &mut Self {
        for (name, value) in other.entries {
            match (self.entries.get_mut(&name), value) {
                (Some(Value::Array(own)), Value::Array(more)) if name == REMARKS => own.extend(more),
                (_, value) => drop(self.entries.insert(name, value)),
            }
        }
        self.headlines.extend(other.headlines);
        self
    }

    /// Adds a report of the library under its own names.
    pub(crate) fn add_report(&mut self, report: &impl Serialize) -> &mut Self {
        self.add_all(Self::of(report))
    }

    /// The entries of a report of the library.
    pub(crate) fn of(report: &impl Serialize) -> Self {
        match serde_json::to_value(report) {
            Ok(Value::Object(entries)) => Self { entries, ..Self::default() },
            // reports are maps of numbers and texts, which JSON holds
            _ => Self::default(),
        }
    }

    /// Adds what the user must know to read the results rightly, and notes. They go to standard error unless the
    /// summary is JSON.
    pub(crate) fn remarks(&mut self, added: impl IntoIterator<Item = Remark>) {
        for remark in added {
            let remarks = self.entries.entry(REMARKS).or_insert_with(|| Value::Array(Vec::new()));
            // what reading and a question both say is said once
            let remark = Value::from(Self::of(&remark));
            if let Value::Array(remarks) = remarks
                && !remarks.contains(&remark)
            {
                remarks.push(remark);
            }
        }
    }

    /// Adds a warning of the program itself.
    pub(crate) fn warn(&mut self, key: &'static str, text: impl Into<String>) -> &mut Self {
        self.remarks([Remark::warning(key, text)]);
        self
    }

    /// Adds the seconds of each stage and their sum.
    pub(crate) fn add_seconds(&mut self, seconds: Vec<(&'static str, f64)>) -> &mut Self {
        let mut section = Self::default();
        let total: f64 = seconds.iter().map(|(_, s)| s).sum();
        for (name, s) in seconds {
            section.add(&name.replace(' ', "_"), rounded(s, 3));
        }
        section.add("total", rounded(total, 3));
        self.add("seconds", section)
    }

    /// Adds what an output has no room for.
    pub(crate) fn add_writing(&mut self, output: &Path, report: &WriteReport) -> &mut Self {
        if !report.left_out.is_empty() {
            self.add("attributes_not_written", report.left_out.clone());
            self.remarks(remark_on_left_out(output, &report.left_out));
        }
        if report.clamped_count > 0 {
            self.add("values_clamped", report.clamped_count);
        }
        self
    }

    /// The remarks so far.
    pub(crate) fn remarks_so_far(&self) -> &[Value] {
        self.entries.get(REMARKS).and_then(Value::as_array).map_or(&[], Vec::as_slice)
    }

    /// Prints the remarks on standard error.
    pub(crate) fn print_remarks(&self, global: &Global) {
        if global.quiet {
            return;
        }
        for remark in self.remarks_so_far() {
            note(&format!("{}: {}", plain(&remark["severity"]), plain(&remark["text"])));
        }
    }

    /// Prints the summary, as JSON where requested.
    pub(crate) fn print(&self, global: &Global) -> ExitCode {
        // a command without a summary, such as one that prints a script
        if self.entries.is_empty() {
            return ExitCode::SUCCESS;
        }
        if !global.json {
            self.print_remarks(global);
        }
        let text = match (global.json, global.quiet) {
            (true, _) => format!("{}\n", printable_json(&Value::Object(self.of_json()))),
            (false, true) => String::new(),
            (false, false) if global.verbose || self.extent == SummaryDetail::Whole => {
                printable(&self.whole()).into_owned()
            }
            (false, false) => printable(&short::text(&self.headlines, &self.entries)).into_owned(),
        };
        // a reader that stopped listening is not a failure
        match std::io::stdout().lock().write_all(text.as_bytes()) {
            Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
                note(&format!("error: standard output: {error}"));
                ExitCode::FAILURE
            }
            _ => ExitCode::SUCCESS,
        }
    }
}

impl Summary {
    fn of_json(&self) -> Map<String, Value> {
        let mut entries = self.entries.clone();
        if !self.headlines.is_empty() {
            entries.insert("headline".to_owned(), self.headlines.clone().into());
        }
        entries
    }

    /// All figures, after the answer.
    fn whole(&self) -> String {
        let mut entries = self.entries.clone();
        entries.remove(REMARKS);
        let mut text: String = self.headlines.iter().map(|line| format!("{line}\n")).collect();
        lines(&entries, 0, &mut text);
        text
    }
}

impl From<Summary> for Value {
    fn from(summary: Summary) -> Self {
        Self::Object(summary.entries)
    }
}

/// A section for each of several reports.
pub(crate) fn sections(reports: &[impl Serialize]) -> Vec<Value> {
    reports.iter().map(|report| Summary::of(report).into()).collect()
}

/// A number with `digits` decimals.
pub(crate) fn rounded(value: f64, digits: i32) -> Value {
    Value::from(report::rounded(value, digits))
}

/// A number without decimals.
pub(crate) fn whole(value: f64) -> Value {
    Value::from(to_i64(value.round()))
}

/// A share as a percentage with two decimals.
pub(crate) fn percent(part: usize, whole: usize) -> Value {
    Value::from(report::percent(part, whole))
}

fn lines(section: &Map<String, Value>, depth: usize, text: &mut String) {
    let indent = "  ".repeat(depth);
    for (name, value) in section {
        let name = name.replace('_', " ");
        match value {
            Value::Object(inner) if inner.is_empty() => {}
            Value::Object(inner) => {
                text.push_str(&format!("{indent}{name}\n"));
                lines(inner, depth + 1, text);
            }
            Value::Array(items) if items.is_empty() => {}
            Value::Array(items) if items.iter().any(Value::is_object) => {
                for item in items {
                    text.push_str(&format!("{indent}{name}\n"));
                    if let Value::Object(inner) = item {
                        lines(inner, depth + 1, text);
                    }
                }
            }
            Value::Array(items) if items.iter().all(Value::is_number) => {
                let items: Vec<String> = items.iter().map(plain).collect();
                text.push_str(&format!("{indent}{name}: {}\n", items.join(" ")));
            }
            Value::Array(items) => {
                text.push_str(&format!("{indent}{name}\n"));
                for item in items {
                    text.push_str(&format!("{indent}  - {}\n", plain(item)));
                }
            }
            other => text.push_str(&format!("{indent}{name}: {}\n", plain(other))),
        }
    }
}

/// JSON in which characters that command a terminal are escaped, as JSON has it: the values stay the same.
fn printable_json(value: &Value) -> String {
    let escaped = |text: String, c: char| {
        if is_command(c) { text + &format!("\\u{:04x}", c as u32) } else { text + c.encode_utf8(&mut [0; 4]) }
    };
    let text = format!("{value:#}");
    if text.contains(is_command) { text.chars().fold(String::with_capacity(text.len()), escaped) } else { text }
}

/// Says something beside the result.
pub(crate) fn note(text: &str) {
    // nobody is left to tell where standard error is closed
    let _ = writeln!(std::io::stderr().lock(), "{}", printable(text));
}

/// Says what went wrong, with its causes.
pub(crate) fn print_error(error: &anyhow::Error) {
    let mut text = error.to_string();
    for (cause, of) in error.chain().skip(1).zip(error.chain()) {
        let is_said = matches!(of.downcast_ref(), Some(belvedere::Error::Io { .. }));
        let cause = cause.to_string();
        // errors that already print their cause need not say it twice
        if !is_said && !text.contains(&cause) {
            text.push_str(": ");
            text.push_str(&cause);
        }
    }
    note(&format!("error: {text}"));
}
