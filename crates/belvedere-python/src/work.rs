//! Long work: without the interpreter, with progress, and stopped by Ctrl-C.

use crate::errors::exception;
use belvedere::control::{Control, Watcher};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// How often signals are looked for and progress is reported.
const POLL: Duration = Duration::from_millis(50);
/// How long work that was cancelled may take to notice. Decoders of other libraries cannot be asked to stop: they are left behind, and
/// what they return is thrown away.
const PATIENCE: Duration = Duration::from_millis(100);

#[derive(Default)]
struct Watch {
    /// Name and number of items of the current stage.
    stage: Mutex<(&'static str, usize)>,
    done: AtomicUsize,
    is_cancelled: AtomicBool,
}

impl Watcher for Watch {
    fn begin(&self, stage: &'static str, total: usize) {
        *self.stage.lock().unwrap_or_else(PoisonError::into_inner) = (stage, total);
        self.done.store(0, Ordering::Relaxed);
    }
    fn advance(&self, count: usize) {
        self.done.fetch_add(count, Ordering::Relaxed);
    }
    fn is_cancelled(&self) -> bool {
        self.is_cancelled.load(Ordering::Relaxed)
    }
}

impl Watch {
    /// The work is over: items that had nothing to do are done too.
    fn finish(&self) {
        let (_, total) = *self.stage.lock().unwrap_or_else(PoisonError::into_inner);
        self.done.fetch_max(total, Ordering::Relaxed);
    }

    /// Hands stage, items done and items in all to `progress`, if there is one; what it raises cancels the work.
    fn report(&self, py: Python<'_>, progress: Option<&Py<PyAny>>) -> PyResult<()> {
        let Some(progress) = progress else { return Ok(()) };
        let (stage, total) = *self.stage.lock().unwrap_or_else(PoisonError::into_inner);
        if !stage.is_empty() {
            progress.call1(py, (stage, self.done.load(Ordering::Relaxed), total))?;
        }
        Ok(())
    }
}

/// Runs `work` on a thread of its own while other Python threads run.
///
/// # Errors
/// Those of the work as exceptions, what `progress` raises, and what a signal raises: `KeyboardInterrupt`.
pub(crate) fn run<T: Send + 'static>(
    py: Python<'_>,
    progress: Option<Py<PyAny>>,
    work: impl FnOnce(&Control<'_>) -> belvedere::Result<T> + Send + 'static,
) -> PyResult<T> {
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
                watch.finish();
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
