//! Long work: without the interpreter, with progress, and stopped by Ctrl-C.

use crate::errors::exception;
use belvedere::control::{Control, OpenStages, StageEnd, Watcher};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Interval of checks for signals and of reports of progress.
const POLL: Duration = Duration::from_millis(50);
/// Time that cancelled work may take to notice. Decoders of other libraries cannot be interrupted: they are abandoned,
/// and their results are discarded.
const PATIENCE: Duration = Duration::from_millis(100);

#[derive(Default)]
struct Watch {
    stages: Mutex<OpenStages>,
    is_cancelled: AtomicBool,
}

impl Watcher for Watch {
    fn begin(&self, stage: &'static str, total: usize) {
        self.stages().begin(stage, total);
    }
    fn advance(&self, count: usize) {
        self.stages().advance(count);
    }
    fn end(&self, stage: &'static str, end: StageEnd) {
        self.stages().end(stage, end);
    }
    fn is_cancelled(&self) -> bool {
        self.is_cancelled.load(Ordering::Relaxed)
    }
}

impl Watch {
    fn stages(&self) -> MutexGuard<'_, OpenStages> {
        self.stages.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Hands stage, items done and items in all to `progress`, if there is one; an exception of it cancels the work.
    fn report(&self, py: Python<'_>, progress: Option<&Py<PyAny>>) -> PyResult<()> {
        let Some(progress) = progress else { return Ok(()) };
        let current = self.stages().current();
        if let Some(stage) = current {
            progress.call1(py, (stage.name, stage.done, stage.total))?;
        }
        Ok(())
    }
}

/// Maximum number of threads, as in the program.
const MAX_THREADS: u64 = 1024;

/// Refuses a number of threads in the environment that no computer needs.
fn check_threads() -> PyResult<()> {
    let threads = std::env::var("RAYON_NUM_THREADS").ok().and_then(|text| text.trim().parse::<u64>().ok());
    match threads.filter(|&threads| threads > MAX_THREADS) {
        Some(threads) => {
            let what = format!("the variable RAYON_NUM_THREADS is {threads}, but must be at most {MAX_THREADS}");
            Err(PyValueError::new_err(what))
        }
        None => Ok(()),
    }
}

/// Runs `work` on a thread of its own while other Python threads run.
///
/// # Errors
/// Those of the work as exceptions, exceptions of `progress`, and that of a signal: `KeyboardInterrupt`.
pub(crate) fn run<T: Send + 'static>(
    py: Python<'_>,
    progress: Option<Py<PyAny>>,
    work: impl FnOnce(&Control<'_>) -> belvedere::Result<T> + Send + 'static,
) -> PyResult<T> {
    check_threads()?;
    let watch = Arc::new(Watch::default());
    let (sender, receiver) = channel();
    let receiver = Mutex::new(receiver);
    let wait = |time: Duration| receiver.lock().unwrap_or_else(PoisonError::into_inner).recv_timeout(time);
    let of_worker = Arc::clone(&watch);
    let spawned = std::thread::Builder::new().name("belvedere".to_owned()).spawn(move || {
        let result = work(&Control::new(&*of_worker));
        // nobody listens any more where the caller was interrupted
        let _ = sender.send(result);
    });
    spawned.map_err(|error| PyRuntimeError::new_err(format!("a thread cannot be started: {error}")))?;
    loop {
        match py.detach(|| wait(POLL)) {
            Ok(result) => {
                let value = result.map_err(exception)?;
                watch.report(py, progress.as_ref())?;
                return Ok(value);
            }
            Err(RecvTimeoutError::Disconnected) => {
                return Err(PyRuntimeError::new_err(
                    "Belvedere failed in a way that it should not; please report this with the message above",
                ));
            }
            Err(RecvTimeoutError::Timeout) => {
                if let Err(raised) = py.check_signals().and_then(|()| watch.report(py, progress.as_ref())) {
                    watch.is_cancelled.store(true, Ordering::Relaxed);
                    let _ = py.detach(|| wait(PATIENCE));
                    return Err(raised);
                }
            }
        }
    }
}
