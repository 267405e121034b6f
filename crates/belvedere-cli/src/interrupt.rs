//! Ctrl-C: work stops at its next check, and the program ends soon even where there is none.

use crate::summary::note;
use belvedere::io::atomic;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// Exit status of a run that was interrupted, as shells have it for SIGINT.
const STATUS: u8 = 130;
/// Time that work may continue after the signal before the program ends without it.
const PATIENCE: Duration = Duration::from_millis(120);

static IS_REQUESTED: AtomicBool = AtomicBool::new(false);
static IS_REPORTED: AtomicBool = AtomicBool::new(false);

/// Returns true if the run should stop.
pub(crate) fn is_requested() -> bool {
    IS_REQUESTED.load(Ordering::Relaxed)
}

/// Begins to listen. Where that is refused the system's own way of ending a program remains.
pub(crate) fn listen() {
    let listening = ctrlc::set_handler(|| {
        IS_REQUESTED.store(true, Ordering::Relaxed);
        std::thread::sleep(PATIENCE);
        // decoders of other libraries and sorting cannot be cancelled
        atomic::abandon_unfinished();
        report();
        std::process::exit(i32::from(STATUS));
    });
    if let Err(error) = listening {
        note(&format!("Ctrl-C may leave unfinished files: {error}"));
    }
    catch_file_limit();
}

/// Lets a file that becomes too large be an error of writing, rather than the end of the program.
#[cfg(unix)]
fn catch_file_limit() {
    // nobody looks at the flag: what matters is that there is a handler
    let is_reached = std::sync::Arc::new(AtomicBool::new(false));
    let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, is_reached);
}

/// Other systems have no such signal.
#[cfg(not(unix))]
fn catch_file_limit() {}

/// Says once that the run was interrupted.
fn report() {
    if !IS_REPORTED.swap(true, Ordering::Relaxed) {
        note("interrupted; no unfinished file is left");
    }
}

/// The end of a run that was interrupted.
pub(crate) fn exit() -> ExitCode {
    report();
    ExitCode::from(STATUS)
}
