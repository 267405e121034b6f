//! The import rules of ARCHITECTURE.md, checked on the sources.

use std::path::{Path, PathBuf};

/// The crates of the library, and the crates of ours that each may import.
const CRATES: [(&str, &[&str]); 13] = [
    ("data", &[]),
    ("io", &["data"]),
    ("figures", &["data", "io"]),
    ("core", &["data"]),
    ("apps", &["data", "core"]),
    ("gpu", &["data", "core"]),
    ("", &["data", "io", "figures", "core", "apps", "gpu"]),
    ("tiles", &[""]),
    ("scenes", &[]),
    ("viewer", &[""]),
    ("web", &["", "viewer"]),
    ("cli", &["", "tiles", "scenes", "viewer"]),
    ("python", &["", "scenes"]),
];

/// The crates of the workspace `research`, and the crates of ours that each may import.
const RESEARCH: [(&str, &[&str]); 5] = [
    ("baselines", &["", "scenes"]),
    ("benches", &["", "scenes"]),
    ("compare", &["", "scenes", "baselines"]),
    ("device-rates", &["", "core", "data", "gpu"]),
    ("tables", &["", "scenes", "baselines"]),
];

/// Level of each module of `belvedere-core`: a module imports from lower levels, or from its own folder.
const LEVELS: [(&str, u8); 18] = [
    ("f32x8", 0),
    ("instructions", 0),
    ("neighbors", 1),
    ("ray_index", 1),
    ("blocking", 1),
    ("triangle_tree", 2),
    ("clean", 2),
    ("normals", 2),
    ("pulses", 2),
    ("medium", 2),
    ("strips", 2),
    ("ground", 2),
    ("planes", 3),
    ("summary", 3),
    ("medial", 4),
    ("depth", 5),
    ("query", 6),
    ("model", 7),
];

/// Crates of others that only one file or folder may name.
/// `schemars` is derived beside `serde` wherever a question has a type; schemas are made in one place.
const ONE_HOME: [(&str, &str); 40] = [
    ("ab_glyph_rasterizer::", "figures/src/font.rs"),
    ("schemars::generate::", "apps/src/ask/schema.rs"),
    ("sha2::", "/src/cache/key.rs"),
    ("skrifa::", "figures/src/font.rs"),
    ("colorous::", "io/src/colors.rs"),
    ("las::", "io/src/"),
    ("laz::", "io/src/las/"),
    ("npyz::", "io/src/"),
    ("zip::", "io/src/"),
    ("csv::", "io/src/text/table.rs"),
    ("e57::", "io/src/e57/"),
    ("tiff::", "io/src/geotiff/"),
    ("flate2::", "io/src/geotiff/write_cog.rs"),
    ("geojson::", "io/src/map_features"),
    ("rusqlite::", "io/src/map_features/geopackage"),
    ("shapefile::", "io/src/map_features/shapefile"),
    ("earcut::", "io/src/"),
    ("ply_rs_bw::", "io/src/"),
    ("pollster::", "gpu/src/device.rs"),
    ("wgpu::", "gpu/src/"),
    ("png::", "figures/src/png.rs"),
    ("delaunator::", "core/src/ground/triangulate.rs"),
    ("nalgebra::", "core/src/pulses/estimate/"),
    ("obvhs::", "core/src/ray_index"),
    ("smallvec::", "core/src/"),
    ("proj_core::", "data/src/crs"),
    ("proj_wkt::", "data/src/crs"),
    ("solar_positioning::", "apps/src/sun/position.rs"),
    ("jiff::", "apps/src/sun/time.rs"),
    ("pythonize::", "python/src/question.rs"),
    ("serde_path_to_error::", "python/src/question.rs"),
    ("axum::", "viewer/src/"),
    ("tokio::", "viewer/src/"),
    ("hyper::", "viewer/src/server.rs"),
    ("hyper_util::", "viewer/src/server.rs"),
    ("open::", "viewer/src/server.rs"),
    ("getrandom::", "viewer/src/guard.rs"),
    ("rustls::", "io/src/files/remote.rs"),
    ("rustls_native_certs::", "io/src/files/remote.rs"),
    ("ureq::", "io/src/files/remote.rs"),
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

/// Returns true if `code` names the crate whose paths begin with `prefix`, and not a module of ours with the same name.
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

/// The crates of ours that `code` names, without `belvedere` and the hyphen.
fn imported_crates(code: &str) -> Vec<String> {
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let names = code.match_indices("belvedere").filter(|&(at, _)| !code[..at].ends_with(is_word));
    names
        .filter_map(|(at, name)| {
            let word: String = code[at + name.len()..].chars().take_while(|&c| is_word(c)).collect();
            let after = &code[at + name.len() + word.len()..];
            after.starts_with("::").then(|| word.trim_start_matches('_').to_owned())
        })
        .collect()
}

#[test]
fn crates_and_modules_import_downward_only_and_name_each_crate_in_one_place() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut wrong = Vec::new();
    let mut imports = 0;
    for (name, allowed) in CRATES {
        let folder = if name.is_empty() { "belvedere".to_owned() } else { format!("belvedere-{name}") };
        let root = crates.join(folder).join("src");
        let mut files = Vec::new();
        sources(&root, &mut files);
        assert!(!files.is_empty(), "no sources of {name}");
        let is_library = !["scenes", "cli", "python"].contains(&name);
        for file in files {
            let within = file.strip_prefix(&root).unwrap().to_string_lossy().replace('\\', "/");
            let place = format!("{name}/src/{within}");
            let code = code(&file);
            for import in imported_crates(&code) {
                imports += 1;
                if import != name && !allowed.contains(&import.as_str()) {
                    wrong.push(format!("{place} imports the crate belvedere-{import}, which lies above it"));
                }
            }
            if !is_library {
                continue;
            }
            for (prefix, home) in ONE_HOME {
                if names_crate(&code, prefix) && !place.starts_with(home) {
                    wrong.push(format!("{place} names {prefix} whose place is {home}"));
                }
            }
            for forbidden in ["println!", "eprintln!", "std::env::", "SystemTime", "Instant::now"] {
                // no answer depends on the clock; which idle connection or kept scene makes room does, and when a
                // server is given up
                let by_time = [
                    ("Instant::now", "viewer/src/connections.rs"),
                    ("Instant::now", "io/src/files/remote.rs"),
                    ("SystemTime", "/src/cache/folder.rs"),
                ];
                if code.contains(forbidden) && !by_time.contains(&(forbidden, place.as_str())) {
                    wrong.push(format!("{place} uses {forbidden}, which the library must not"));
                }
            }
            let own = within.split(['/', '.']).next().unwrap_or_default().to_owned();
            if name != "core" || own == "lib" {
                continue;
            }
            let Some(own_level) = level(&own) else {
                wrong.push(format!("{place}: give module {own} a level in this test and in ARCHITECTURE.md"));
                continue;
            };
            for module in imported_modules(&code) {
                if let Some(other) = level(&module) {
                    imports += 1;
                    if module != own && other >= own_level {
                        wrong.push(format!("{place} (level {own_level}) imports {module} (level {other})"));
                    }
                }
            }
        }
    }
    assert!(imports > 100, "the test sees only {imports} imports");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

#[test]
fn research_imports_what_is_below_it() {
    let mut wrong = Vec::new();
    for (name, allowed) in RESEARCH {
        let mut files = Vec::new();
        sources(&repository().join("research").join(name), &mut files);
        assert!(!files.is_empty(), "no sources of {name}");
        for file in files {
            let code = code(&file);
            let is_wrong = |import: &String| *import != name && !allowed.contains(&import.as_str());
            wrong.extend(imported_crates(&code).into_iter().filter(is_wrong).map(|import| (file.clone(), import)));
        }
    }
    assert!(wrong.is_empty(), "{wrong:?}");
}

/// The lines of a manifest from `[start` to the next section that is not `[start`.
fn section(manifest: &str, start: &str) -> Vec<String> {
    let mut is_within = false;
    let mut lines = Vec::new();
    for line in manifest.lines().filter(|line| !line.is_empty() && !line.starts_with('#')) {
        if line.starts_with('[') {
            is_within = line.starts_with(start);
        }
        if is_within {
            lines.push(line.to_owned());
        }
    }
    lines
}

/// Names and versions of the crates in a `Cargo.lock`.
fn locked(lock: &str) -> Vec<(String, String)> {
    let value = |line: &str, key: &str| line.strip_prefix(key).map(|rest| rest.trim_matches('"').to_owned());
    let lines: Vec<&str> = lock.lines().collect();
    lines.windows(2).filter_map(|pair| Some((value(pair[0], "name = ")?, value(pair[1], "version = ")?))).collect()
}

#[test]
fn research_has_the_lints_profiles_and_versions_of_the_root() {
    let read = |name: &str| std::fs::read_to_string(repository().join(name)).unwrap();
    let manifests = ["Cargo.toml", "research/Cargo.toml"].map(read);
    for start in ["[workspace.lints", "[profile.release", "[profile.dev"] {
        let [of_root, of_research] = [0, 1].map(|i| section(&manifests[i], start));
        assert!(of_research.len() > 1 && of_research == of_root, "{start}: {of_research:?} and {of_root:?}");
    }
    let [versions, of_research] = [0, 1].map(|i| section(&manifests[i], "[workspace.dependencies]"));
    let name = |line: &str| line.split(" = ").next().unwrap_or_default().to_owned();
    for line in of_research.iter().filter(|line| line.contains(" = ") && !line.contains("path = ")) {
        let of_root = versions.iter().find(|other| name(other) == name(line));
        assert!(of_root.is_none_or(|other| other == line), "{line} and {of_root:?}");
    }
    let [of_root, of_research] = ["Cargo.lock", "research/Cargo.lock"].map(|name| locked(&read(name)));
    let is_known =
        |krate: &(String, String)| of_root.contains(krate) || of_root.iter().all(|(name, _)| *name != krate.0);
    let other: Vec<_> = of_research.iter().filter(|krate| !is_known(krate)).collect();
    assert!(of_research.len() > 100 && other.is_empty(), "in other versions than in Cargo.lock: {other:?}");
}
