//! Test data.

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

/// Reports that a test, or a part of one, did not run. The test runner captures the output of `eprintln!` and shows it
/// for failed tests only, so this writes to standard error itself.
pub(crate) fn skipped(what: &str) {
    let _ = writeln!(std::io::stderr().lock(), "SKIPPED {what}");
}
