//! The import rules of ARCHITECTURE.md, checked on the sources.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use std::path::{Path, PathBuf};

/// Level of each module of the core; a module imports from lower levels, or from its own folder.
const LEVELS: [(&str, u8); 24] = [
    ("error", 0),
    ("crs", 0),
    ("cloud", 0),
    ("mesh", 0),
    ("raster", 0),
    ("view", 0),
    ("trajectory", 0),
    ("weather", 0),
    ("random", 0),
    ("progress", 0),
    ("vector", 0),
    ("neighbors", 1),
    ("io", 1),
    ("ray_index", 1),
    ("clean", 2),
    ("normals", 2),
    ("pulses", 2),
    ("ground", 2),
    ("summary", 3),
    ("medial", 3),
    ("depth", 4),
    ("query", 5),
    ("backend", 5),
    ("apps", 6),
];

/// Crates that only one file or folder may name, below `src`.
const ONE_HOME: [(&str, &str); 18] = [
    ("las::", "io/"),
    ("laz::", "io/laz.rs"),
    ("npyz::", "io/"),
    ("csv::", "io/table.rs"),
    ("delaunator::", "ground/triangulate.rs"),
    ("e57::", "io/e57.rs"),
    ("tiff::", "io/geotiff.rs"),
    ("png::", "io/png.rs"),
    ("tobj::", "io/obj.rs"),
    ("earcut::", "io/"),
    ("ply_rs_bw::", "io/"),
    ("proj_core::", "crs"),
    ("proj_wkt::", "crs"),
    ("rstar::", "normals/"),
    ("nalgebra::", "pulses/"),
    ("obvhs::", "ray_index.rs"),
    ("solar_positioning::", "apps/sun/position.rs"),
    ("jiff::", "apps/sun/time.rs"),
];

fn level(module: &str) -> Option<u8> {
    LEVELS.iter().find(|(name, _)| *name == module).map(|&(_, level)| level)
}

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
}

/// The code of a file before its unit tests, without comments.
fn code(path: &Path) -> String {
    let text = std::fs::read_to_string(path).unwrap();
    let code = text.split("#[cfg(test)]").next().unwrap_or_default();
    code.lines().map(|line| line.split("//").next().unwrap_or_default()).collect::<Vec<_>>().join("\n")
}

/// The first segment of everything that follows `crate::`, braces opened one level.
fn imported_modules(code: &str) -> Vec<String> {
    let word = |text: &str| text.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect::<String>();
    let mut modules = Vec::new();
    for after in code.split("crate::").skip(1) {
        if let Some(group) = after.strip_prefix('{') {
            let group = group.split("};").next().unwrap_or_default();
            modules.extend(group.split(',').map(|item| word(item.trim())));
        } else {
            modules.push(word(after));
        }
    }
    modules
}

/// Whether `code` names the crate whose paths begin with `prefix`, and not a module of ours that is called the same.
fn names_crate(code: &str, prefix: &str) -> bool {
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let bare = prefix.trim_end_matches(':');
    let imports = code.split("use super::").skip(1).filter_map(|rest| rest.split(';').next());
    let is_module = code.contains(&format!("mod {bare};"))
        || imports.flat_map(|import| import.split(|c| !is_word(c))).any(|word| word == bare);
    code.match_indices(prefix).any(|(at, _)| {
        let before = &code[..at];
        match before.strip_suffix("::") {
            Some(parent) => !parent.ends_with(is_word),
            None => !is_module && !before.ends_with(is_word),
        }
    })
}

#[test]
fn modules_import_downward_only_and_name_each_crate_in_one_place() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    sources(&root, &mut files);
    assert!(files.len() > 20, "only {} sources found", files.len());
    let mut wrong = Vec::new();
    let mut imports = 0;
    for file in files {
        let relative = file.strip_prefix(&root).unwrap().to_string_lossy().replace('\\', "/");
        let own = relative.split(['/', '.']).next().unwrap_or_default().to_owned();
        if own == "lib" {
            continue;
        }
        let Some(own_level) = level(&own) else {
            wrong.push(format!("{relative}: give module {own} a level in this test and in ARCHITECTURE.md"));
            continue;
        };
        let code = code(&file);
        for module in imported_modules(&code) {
            if let Some(other) = level(&module) {
                imports += 1;
                if module != own && (other > own_level || (other == own_level && own_level > 0)) {
                    wrong.push(format!("{relative} (level {own_level}) imports {module} (level {other})"));
                }
            }
        }
        for (name, home) in ONE_HOME {
            if names_crate(&code, name) && !relative.starts_with(home) {
                wrong.push(format!("{relative} names {name} whose place is {home}"));
            }
        }
        for forbidden in ["println!", "eprintln!", "std::env::", "SystemTime", "Instant::now"] {
            if code.contains(forbidden) {
                wrong.push(format!("{relative} uses {forbidden}, which the core must not"));
            }
        }
    }
    assert!(imports > 30, "the test sees only {imports} imports");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
