//! The bundle that is committed is what its sources give.

use std::io::Write;
use std::path::Path;
use std::process::Command;

#[test]
fn the_committed_bundle_is_made_of_its_sources() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("page");
    let skip = |why: &str| {
        // not `eprintln!`, which the test runner captures and shows for failed tests only
        let _ = writeln!(std::io::stderr().lock(), "SKIPPED a comparison of the bundle of the page: {why}");
    };
    if !folder.join("node_modules/esbuild").is_dir() {
        return skip("its packages are not installed; run `npm ci` in crates/belvedere-viewer/page");
    }
    let made = tempfile::tempdir().unwrap();
    let output = made.path().join("page.js");
    match Command::new(folder.join("build")).arg(&output).status() {
        Ok(status) if status.success() => {}
        _ => return skip("page/build does not run here"),
    }
    let [made, committed] = [output, folder.join("page.js")].map(|path| std::fs::read(path).unwrap());
    assert!(made == committed, "page/page.js is older than its sources: run crates/belvedere-viewer/page/build");
}
