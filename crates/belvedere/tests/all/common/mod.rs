//! Common parts of several tests: the shared data, simulated scenes, light by hand.

pub(crate) mod simulated;

use belvedere::query::VisibilityMatrix;
use std::io::Write;
use std::path::PathBuf;

/// The file or folder at `relative` under `BELVEDERE_TEST_DATA` (default: `shared` beside the repository), or `None`
/// after saying that `test` is skipped.
pub(crate) fn data(test: &str, relative: &str) -> Option<PathBuf> {
    let root = std::env::var_os("BELVEDERE_TEST_DATA")
        .map_or_else(|| PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared")), PathBuf::from);
    let path = root.join(relative);
    if path.exists() {
        return Some(path);
    }
    skipped(&format!("{test} ({relative}): there is no reference data; name its folder in BELVEDERE_TEST_DATA"));
    None
}

/// Says that a test, or a part of one, did not run. The test runner captures what `eprintln!` prints and shows it for
/// failed tests only, so this writes to standard error itself.
pub(crate) fn skipped(what: &str) {
    let _ = writeln!(std::io::stderr().lock(), "SKIPPED {what}");
}

/// Share of the light that reaches a target from a direction: 1 where nothing blocks, 0 where anything but vegetation
/// does, and `share` where only vegetation does. `opaque` is the matrix of the balls that are not vegetation.
pub(crate) fn light_share(
    all: &VisibilityMatrix,
    opaque: &VisibilityMatrix,
    target: usize,
    direction: usize,
    share: f64,
) -> f64 {
    match (all.is_free(target, direction), opaque.is_free(target, direction)) {
        (true, _) => 1.0,
        (false, true) => share,
        (false, false) => 0.0,
    }
}
