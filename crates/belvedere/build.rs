//! Names the sources that a kept scene depends on (`cache/key.rs`): between two versions only they tell programs apart.

use std::collections::hash_map::DefaultHasher;
use std::hash::{Hash, Hasher};
use std::path::Path;

fn main() {
    let mut hasher = DefaultHasher::new();
    for name in ["data", "io", "core"] {
        let folder = Path::new("..").join(format!("belvedere-{name}")).join("src");
        println!("cargo::rerun-if-changed={}", folder.display());
        // a published crate has no neighbours, and its version is enough
        add(&folder, &mut hasher);
    }
    println!("cargo::rustc-env=BELVEDERE_SOURCES={:016x}", hasher.finish());
}

fn add(path: &Path, hasher: &mut DefaultHasher) {
    if let Ok(rows) = path.read_dir() {
        let mut paths: Vec<_> = rows.filter_map(|row| Some(row.ok()?.path())).collect();
        paths.sort();
        paths.iter().for_each(|path| add(path, hasher));
    } else if let Ok(source) = std::fs::read(path) {
        (path, source).hash(hasher);
    }
}
