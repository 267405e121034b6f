//! Where the shared test data lie.

pub(crate) mod simulated;

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
    eprintln!("SKIPPED {test}: {relative} is not under BELVEDERE_TEST_DATA");
    None
}
