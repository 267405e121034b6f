//! One run: its stages, its warnings, and what it prints.

use anyhow::{Context, Result};
use std::io::Write;
use std::time::Instant;

/// What every stage may add to.
pub(crate) struct Run {
    is_verbose: bool,
    pub(crate) warnings: Vec<String>,
}

impl Run {
    pub(crate) fn new(is_verbose: bool) -> Self {
        Self { is_verbose, warnings: Vec::new() }
    }

    /// Runs one stage, and prints its duration with `--verbose`.
    pub(crate) fn stage<T>(&self, name: &str, work: impl FnOnce() -> T) -> T {
        let start = Instant::now();
        let result = work();
        if self.is_verbose {
            note(&format!("{name}: {:.3} s", start.elapsed().as_secs_f64()));
        }
        result
    }
}

/// Prints a result on standard output. A reader that closes its pipe, such as `head`, is not an error.
pub(crate) fn print(text: &str) -> Result<()> {
    let mut output = std::io::stdout().lock();
    match output.write_all(text.as_bytes()).and_then(|()| output.flush()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => Err(error).context("standard output"),
        _ => Ok(()),
    }
}

/// Prints a remark on standard error.
pub(crate) fn note(text: &str) {
    // where standard error is closed nobody reads it
    let _ = writeln!(std::io::stderr().lock(), "{text}");
}

/// Prints an error with its causes.
pub(crate) fn print_error(error: &anyhow::Error) {
    let mut text = error.to_string();
    for (cause, of) in error.chain().skip(1).zip(error.chain()) {
        // some errors print their cause themselves, in their own words or in those of the cause
        let is_printed = matches!(of.downcast_ref(), Some(belvedere::Error::Io { .. }));
        let cause = cause.to_string();
        if !is_printed && !text.contains(&cause) {
            text.push_str(": ");
            text.push_str(&cause);
        }
    }
    note(&format!("error: {text}"));
}
