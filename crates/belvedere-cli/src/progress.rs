//! A progress bar on a terminal, nothing in a pipe.

use crate::arguments::{Global, ProgressChoice};
use belvedere::control::{Control, Watcher};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde_json::json;
use std::time::{Duration, Instant};

/// The stages of a command, shown one after the other and timed.
pub(crate) struct Stages {
    shown: bool,
    json: bool,
    verbose: bool,
    seconds: Vec<(&'static str, f64)>,
}

/// A progress bar as the watcher of a stage.
struct Bar<'a>(&'a ProgressBar);

impl Watcher for Bar<'_> {
    fn advance(&self, count: usize) {
        self.0.inc(count as u64);
    }
}

impl Stages {
    pub(crate) fn new(global: &Global) -> Self {
        let json = global.progress == ProgressChoice::Json;
        let shown = global.progress == ProgressChoice::Bar && !global.quiet;
        Self { shown, json, verbose: global.verbose, seconds: Vec::new() }
    }

    /// Runs one stage over `count` items (0: unknown).
    pub(crate) fn run<T>(&mut self, name: &'static str, count: usize, work: impl FnOnce(&Control<'_>) -> T) -> T {
        // standard error: the bar hides itself where that is no terminal
        let target = if self.shown { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
        let bar = ProgressBar::with_draw_target(if count > 0 { Some(count as u64) } else { None }, target);
        let template =
            if count > 0 { "{msg:24} [{bar:30}] {human_pos}/{human_len} {eta}" } else { "{msg:24} {spinner}" };
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        bar.set_message(name);
        bar.enable_steady_tick(Duration::from_millis(200));
        let start = Instant::now();
        let result = work(&Control::new(&Bar(&bar)));
        bar.finish_and_clear();
        let seconds = start.elapsed().as_secs_f64();
        if self.json {
            let item_count = (count > 0).then_some(count);
            crate::summary::note(
                &json!({ "stage": name, "item_count": item_count, "seconds": (seconds * 1000.0).round() / 1000.0 })
                    .to_string(),
            );
        }
        if self.verbose {
            crate::summary::note(&format!("{name}: {seconds:.3} s"));
        }
        self.seconds.push((name, seconds));
        result
    }

    /// Seconds each stage took.
    pub(crate) fn into_seconds(self) -> Vec<(&'static str, f64)> {
        self.seconds
    }
}
