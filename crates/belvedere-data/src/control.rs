//! Control of long work: progress and cancellation.

use crate::{Error, Result};
use std::sync::atomic::{AtomicBool, Ordering};

/// End of a stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StageEnd {
    /// Its work is done.
    Finished,
    /// It was cancelled, or failed.
    Stopped,
}

/// Interface that the owner of long work provides: a progress bar, a notebook, a page, a signal handler. Every method
/// may be called from any thread and should return at once.
///
/// Stages nest: a stage that begins while another is open is a part of it, and the outer one goes on when it ends.
/// Finished items belong to the innermost open stage. [`OpenStages`] keeps account of this.
pub trait Watcher: Sync {
    /// A stage begins that has `total` items; 0 where the number is not known.
    fn begin(&self, _stage: &'static str, _total: usize) {}
    /// `count` more items of the innermost open stage are finished.
    fn advance(&self, _count: usize) {}
    /// The stage is over.
    fn end(&self, _stage: &'static str, _end: StageEnd) {}
    /// Returns true if the work should stop. It is called often, and should return at once.
    fn is_cancelled(&self) -> bool {
        false
    }
}

/// Progress and cancellation of one piece of work. Every function that can run longer than a second takes one.
#[derive(Clone, Copy, Default)]
pub struct Control<'a>(Option<&'a dyn Watcher>);

impl<'a> Control<'a> {
    /// Reports to `watcher` and stops when it says so.
    #[must_use]
    pub fn new(watcher: &'a dyn Watcher) -> Self {
        Self(Some(watcher))
    }

    /// Reports to nobody and is never cancelled.
    #[must_use]
    pub fn none() -> Self {
        Self(None)
    }

    /// Runs `work` as a stage of `total` items, 0 where their number is not known.
    ///
    /// # Errors
    /// Those of `work`, and [`Error::Cancelled`] where the work was cancelled before the stage began.
    pub fn stage<T>(&self, name: &'static str, total: usize, work: impl FnOnce() -> Result<T>) -> Result<T> {
        self.check()?;
        let Some(watcher) = self.0 else { return work() };
        watcher.begin(name, total);
        let result = work();
        watcher.end(name, if result.is_ok() { StageEnd::Finished } else { StageEnd::Stopped });
        result
    }

    /// Reports that `count` more items of the innermost open stage are finished.
    pub fn advance(&self, count: usize) {
        if let Some(watcher) = self.0 {
            watcher.advance(count);
        }
    }

    /// Returns true if the work should stop.
    #[must_use]
    pub fn is_cancelled(&self) -> bool {
        self.0.is_some_and(Watcher::is_cancelled)
    }

    /// Fails once the work is cancelled: called between pieces of work that take a tenth of a second at most.
    ///
    /// # Errors
    /// [`Error::Cancelled`].
    pub fn check(&self) -> Result<()> {
        if self.is_cancelled() { Err(Error::Cancelled) } else { Ok(()) }
    }
}

/// A stage that has begun.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OpenStage {
    /// Its name.
    pub name: &'static str,
    /// Number of its items; 0 where it is not known.
    pub total: usize,
    /// Items that are finished.
    pub done: usize,
}

/// The stages that are open, the innermost last: the state of a watcher that shows one stage at a time.
#[derive(Clone, Debug, Default)]
pub struct OpenStages {
    open: Vec<OpenStage>,
    /// The outermost stage that finished last.
    finished: Option<OpenStage>,
}

impl OpenStages {
    /// A stage begins.
    pub fn begin(&mut self, name: &'static str, total: usize) {
        self.open.push(OpenStage { name, total, done: 0 });
    }

    /// More items of the innermost open stage are finished.
    pub fn advance(&mut self, count: usize) {
        if let Some(stage) = self.open.last_mut() {
            stage.done += count;
        }
    }

    /// A stage ends, with the stages in it that are still open.
    pub fn end(&mut self, name: &'static str, end: StageEnd) {
        let Some(place) = self.open.iter().rposition(|stage| stage.name == name) else { return };
        let stage = self.open[place];
        self.open.truncate(place);
        if self.open.is_empty() && end == StageEnd::Finished {
            // items that had nothing to do are done too
            self.finished = Some(OpenStage { done: stage.done.max(stage.total), ..stage });
        }
    }

    /// The innermost open stage; the last that finished where none is open.
    #[must_use]
    pub fn current(&self) -> Option<OpenStage> {
        self.open.last().copied().or(self.finished)
    }
}

/// Flag to leave a parallel loop whose results are gathered as values. Once the work is cancelled its pieces are
/// skipped, and the gathered values must be discarded.
///
/// ```
/// use belvedere_data::control::{Control, Stop};
///
/// let control = Control::none();
/// let stop = Stop::new(&control);
/// let squares: Vec<u32> = (0..10).map(|i| if stop.is_set() { 0 } else { i * i }).collect();
/// stop.check()?;
/// # assert_eq!(squares[9], 81);
/// # Ok::<(), belvedere_data::Error>(())
/// ```
pub struct Stop<'a> {
    control: Control<'a>,
    is_set: AtomicBool,
}

impl<'a> Stop<'a> {
    /// One that is set when `control` is cancelled, and stays so.
    #[must_use]
    pub fn new(control: &Control<'a>) -> Self {
        Self { control: *control, is_set: AtomicBool::new(false) }
    }

    /// Returns true if the rest of the work is to be skipped.
    pub fn is_set(&self) -> bool {
        if self.is_set.load(Ordering::Relaxed) {
            return true;
        }
        let is_cancelled = self.control.is_cancelled();
        if is_cancelled {
            self.is_set.store(true, Ordering::Relaxed);
        }
        is_cancelled
    }

    /// Fails if any piece of the work was passed over.
    ///
    /// # Errors
    /// [`Error::Cancelled`].
    pub fn check(&self) -> Result<()> {
        if self.is_set.load(Ordering::Relaxed) { Err(Error::Cancelled) } else { self.control.check() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

    #[derive(Default)]
    struct Counting {
        begun: AtomicUsize,
        done: AtomicUsize,
        ended: AtomicUsize,
        finished: AtomicUsize,
        cancelled: AtomicBool,
    }

    impl Watcher for Counting {
        fn begin(&self, _stage: &'static str, total: usize) {
            self.begun.fetch_add(total, Ordering::Relaxed);
        }
        fn advance(&self, count: usize) {
            self.done.fetch_add(count, Ordering::Relaxed);
        }
        fn end(&self, _stage: &'static str, end: StageEnd) {
            self.ended.fetch_add(1, Ordering::Relaxed);
            self.finished.fetch_add(usize::from(end == StageEnd::Finished), Ordering::Relaxed);
        }
        fn is_cancelled(&self) -> bool {
            self.cancelled.load(Ordering::Relaxed)
        }
    }

    #[test]
    fn stages_report_items_and_stop_once_cancelled() {
        let watcher = Counting::default();
        let control = Control::new(&watcher);
        let work = || {
            control.advance(3);
            watcher.cancelled.store(true, Ordering::Relaxed);
            control.check()
        };
        assert!(matches!(control.stage("counting points", 5, work), Err(Error::Cancelled)));
        assert!(matches!(control.stage("never run", 7, || Ok(())), Err(Error::Cancelled)));
        let counts = [&watcher.begun, &watcher.done, &watcher.ended, &watcher.finished];
        assert_eq!(counts.map(|count| count.load(Ordering::Relaxed)), [5, 3, 1, 0]);
        assert!(Control::none().check().is_ok());
    }

    #[test]
    fn a_stage_goes_on_when_the_one_within_it_ends() {
        let mut stages = OpenStages::default();
        stages.begin("finding the surface", 0);
        stages.begin("computing top surface", 8);
        stages.advance(3);
        assert_eq!(stages.current(), Some(OpenStage { name: "computing top surface", total: 8, done: 3 }));
        stages.end("computing top surface", StageEnd::Finished);
        assert_eq!(stages.current().map(|stage| stage.name), Some("finding the surface"));
        stages.end("finding the surface", StageEnd::Stopped);
        assert_eq!(stages.current(), None);
        stages.begin("testing sun", 5);
        stages.end("testing sun", StageEnd::Finished);
        assert_eq!(stages.current(), Some(OpenStage { name: "testing sun", total: 5, done: 5 }));
    }
}
