//! The stages of a run: a progress bar on a terminal, lines of JSON where these are requested, and the duration of
//! each.

use crate::arguments::{Global, ProgressChoice};
use crate::interrupt;
use crate::summary::{note, rounded};
use belvedere::control::{Control, StageEnd, Watcher};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Minimum time between two lines of JSON about one stage.
const BETWEEN_LINES: Duration = Duration::from_millis(200);

/// The stages of a command, one after the other: what the library reports to, and where it learns of Ctrl-C.
pub(crate) struct CommandStages {
    progress: Progress,
}

/// The watcher of a whole run.
struct Progress {
    shown: bool,
    json: bool,
    verbose: bool,
    /// Another watcher of the same stages.
    also: Option<Box<dyn Watcher + Send>>,
    state: Mutex<ProgressState>,
}

#[derive(Default)]
struct ProgressState {
    /// Stages that have begun: the last one runs, the others wait for it.
    open: Vec<RunningStage>,
    /// Stages that are over, each name once, in the order of their first end.
    seconds: Vec<(&'static str, f64)>,
}

struct RunningStage {
    name: &'static str,
    start: Instant,
    /// Time that stages within this one took.
    within: Duration,
    total: usize,
    done: usize,
    bar: ProgressBar,
    /// Time of the last line of JSON.
    last_line: Instant,
}

impl RunningStage {
    /// A line of JSON: how far this stage is, and the stage that it is a part of.
    fn line(&mut self, within: Option<&'static str>, is_finished: bool) {
        self.last_line = Instant::now();
        let seconds = rounded(self.start.elapsed().saturating_sub(self.within).as_secs_f64(), 3);
        // a stage that does not count is done when it ends
        let total = if is_finished { self.total.max(self.done) } else { self.total };
        let done = if is_finished { total } else { self.done };
        let total = (total > 0).then_some(total);
        note(
            &serde_json::json!({
                "stage": self.name, "within": within, "done": done, "total": total, "seconds": seconds, "finished": is_finished
            })
            .to_string(),
        );
    }
}

impl Progress {
    fn state(&self) -> MutexGuard<'_, ProgressState> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn target(&self) -> ProgressDrawTarget {
        // standard error: the bar hides itself where that is no terminal
        if self.shown { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() }
    }
}

impl Watcher for Progress {
    fn begin(&self, stage: &'static str, total: usize) {
        if let Some(also) = &self.also {
            also.begin(stage, total);
        }
        let bar = ProgressBar::with_draw_target((total > 0).then_some(total as u64), self.target());
        let template =
            if total > 0 { "{msg:24} [{bar:30}] {human_pos}/{human_len} {eta}" } else { "{msg:24} {spinner}" };
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        bar.set_message(stage);
        bar.enable_steady_tick(Duration::from_millis(200));
        let mut state = self.state();
        if let Some(waiting) = state.open.last() {
            waiting.bar.set_draw_target(ProgressDrawTarget::hidden());
        }
        let start = Instant::now();
        let mut open =
            RunningStage { name: stage, start, within: Duration::ZERO, total, done: 0, bar, last_line: start };
        if self.json {
            open.line(state.open.last().map(|outer| outer.name), false);
        }
        state.open.push(open);
    }

    fn advance(&self, count: usize) {
        if let Some(also) = &self.also {
            also.advance(count);
        }
        let mut state = self.state();
        let Some((open, outer)) = state.open.split_last_mut() else { return };
        open.done += count;
        open.bar.inc(count as u64);
        if self.json && open.last_line.elapsed() >= BETWEEN_LINES {
            open.line(outer.last().map(|outer| outer.name), false);
        }
    }

    fn end(&self, stage: &'static str, end: StageEnd) {
        if let Some(also) = &self.also {
            also.end(stage, end);
        }
        let mut state = self.state();
        let Some(place) = state.open.iter().rposition(|open| open.name == stage) else { return };
        let mut open = state.open.remove(place);
        if self.json {
            open.line(state.open.last().map(|outer| outer.name), end == StageEnd::Finished);
        }
        open.bar.finish_and_clear();
        let whole = open.start.elapsed();
        if let Some(outer) = state.open.last_mut() {
            outer.within += whole;
            outer.bar.set_draw_target(self.target());
        }
        // what stages within took is theirs
        let seconds = whole.saturating_sub(open.within).as_secs_f64();
        match state.seconds.iter_mut().find(|(name, _)| *name == stage) {
            Some((_, sum)) => *sum += seconds,
            None => state.seconds.push((stage, seconds)),
        }
        drop(state);
        if self.verbose {
            note(&format!("{stage}: {seconds:.3} s"));
        }
    }

    fn is_cancelled(&self) -> bool {
        interrupt::is_requested()
    }
}

impl CommandStages {
    pub(crate) fn new(global: &Global) -> Self {
        let json = global.progress == ProgressChoice::Json;
        let shown = global.progress == ProgressChoice::Bar && !global.quiet;
        Self { progress: Progress { shown, verbose: global.verbose, json, also: None, state: Mutex::default() } }
    }

    /// The same, which `watcher` follows too.
    #[cfg(feature = "view")]
    pub(crate) fn watched(mut self, watcher: impl Watcher + Send + 'static) -> Self {
        self.progress.also = Some(Box::new(watcher));
        self
    }

    /// Returns the control to which functions of the library report their stages.
    pub(crate) fn control(&self) -> Control<'_> {
        Control::new(&self.progress)
    }

    /// Runs one stage over `count` items (0: unknown), which finished if `is_finished` says so of its result.
    pub(crate) fn run<T>(
        &self,
        name: &'static str,
        count: usize,
        work: impl FnOnce(&Control<'_>) -> T,
        is_finished: impl FnOnce(&T) -> bool,
    ) -> T {
        self.progress.begin(name, count);
        let result = work(&self.control());
        self.progress.end(name, if is_finished(&result) { StageEnd::Finished } else { StageEnd::Stopped });
        result
    }

    /// Seconds that each stage took, stages of one name together.
    pub(crate) fn into_seconds(self) -> Vec<(&'static str, f64)> {
        self.progress.state.into_inner().unwrap_or_else(PoisonError::into_inner).seconds
    }
}
