//! Values that are made when they are first needed, by all threads at once.

use belvedere_data::Result;
use belvedere_data::control::Control;
use std::sync::{Mutex, OnceLock, PoisonError};

/// A value that is made on first use.
///
/// The first caller makes the value, on threads of its own. A caller may be one of many threads at work. If it waited
/// for shared threads, it could be given work that needs this very value.
#[derive(Default)]
pub(super) struct Lazy<T> {
    value: OnceLock<T>,
    making: Mutex<()>,
}

impl<T: Send + Sync> Lazy<T> {
    pub(super) fn new() -> Self {
        Self { value: OnceLock::new(), making: Mutex::new(()) }
    }

    /// Returns true if the value exists.
    pub(super) fn is_made(&self) -> bool {
        self.value.get().is_some()
    }

    /// The value, made by `make` if it is not there yet. Nothing is kept of one that fails.
    ///
    /// # Errors
    /// Those of `make`.
    pub(super) fn get_or_make(&self, make: impl FnOnce() -> Result<T> + Send) -> Result<&T> {
        if let Some(value) = self.value.get() {
            return Ok(value);
        }
        let _making = self.making.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(value) = self.value.get() {
            return Ok(value);
        }
        let value = on_own_threads(make)?;
        Ok(self.value.get_or_init(|| value))
    }

    /// The value, made by `make` if it is not there yet; for a `make` that fails only if cancelled.
    pub(super) fn get(&self, make: impl Fn(&Control<'_>) -> Result<T> + Send + Sync) -> Option<&T> {
        self.get_or_make(|| make(&Control::none())).ok()
    }
}

/// Runs `work` where there are no threads to start: in a browser. Whoever asks there first must not be one of a pool.
#[cfg(target_family = "wasm")]
fn on_own_threads<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    work()
}

/// Runs `work` on as many new threads as the caller may use.
#[cfg(not(target_family = "wasm"))]
fn on_own_threads<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    /// Pause between attempts to start a thread that the system refuses, and number of attempts.
    const PAUSE: std::time::Duration = std::time::Duration::from_millis(50);
    const MAX_TRIES: usize = 100;
    let threads = rayon::current_num_threads();
    let work = Mutex::new(Some(work));
    let take = || work.lock().unwrap_or_else(PoisonError::into_inner).take();
    let run = || {
        let work = take()?;
        // without more threads the new one does all of it
        let alone = || rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread().build();
        match rayon::ThreadPoolBuilder::new().num_threads(threads).build().or_else(|_| alone()) {
            Ok(pool) => Some(pool.install(work)),
            Err(_) => Some(work()),
        }
    };
    for _ in 0..MAX_TRIES {
        let done = std::thread::scope(|scope| {
            let thread = std::thread::Builder::new().spawn_scoped(scope, run).ok()?;
            match thread.join() {
                Ok(value) => value,
                Err(panic) => std::panic::resume_unwind(panic),
            }
        });
        if let Some(value) = done {
            return value;
        }
        std::thread::sleep(PAUSE);
    }
    // the system gives no thread at all: this one must do
    match take() {
        Some(work) => work(),
        None => unreachable!("a thread that took the work has returned its value"),
    }
}
