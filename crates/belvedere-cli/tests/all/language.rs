//! Plain words in help, messages and pages; and pages that name only what exists.

use crate::common::Workplace;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Words that readers with another first language stumble over, or that have had two meanings here, and what to write instead.
const REFUSED: [(&str, &str); 15] = [
    ("told", "say `given`, `classified`, `separated`"),
    ("tells apart", "say `separates`"),
    ("asked", "say `queried`, `tested`, `required`"),
    ("asks for", "say `requires`"),
    ("stands for", "say `represents`"),
    ("stand for", "say `represent`"),
    ("rim", "say `edge`, `boundary`, `outline`"),
    ("rims", "say `edges`, `boundaries`, `outlines`"),
    ("how right", "say `accuracy`"),
    ("served", "say `known`, `used`"),
    ("serves", "say `is used for`"),
    ("of the blocked", "say `of blocked targets`"),
    ("save for", "say `except`"),
    ("reckoned", "say `computed`"),
    ("held against", "say `compared with`"),
];
/// Identifiers of the code that a page may name although they contain such a word.
const NAMES: [&str; 1] = ["`rim`"];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Files below a folder with an extension, in order.
fn files(folder: &Path, extension: &str, found: &mut Vec<PathBuf>) {
    let mut entries: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    entries.sort();
    for path in entries {
        if path.is_dir() {
            files(&path, extension, found);
        } else if path.extension().is_some_and(|own| own == extension) {
            found.push(path);
        }
    }
}

fn pages() -> Vec<PathBuf> {
    let mut pages = vec![root().join("README.md"), root().join("CONTRIBUTING.md")];
    files(&root().join("docs"), "md", &mut pages);
    files(&root().join("crates/belvedere-python/python"), "py", &mut pages);
    pages
}

/// Refused words in a text, each with its line and the advice.
fn refused(name: &str, text: &str) -> Vec<String> {
    let mut found = Vec::new();
    for (number, line) in (1..).zip(text.lines()) {
        let mut line = line.to_lowercase();
        NAMES.iter().for_each(|own| line = line.replace(own, ""));
        for (word, advice) in REFUSED {
            let is_word = |at: usize| {
                let before = line[..at].chars().next_back().is_none_or(|c| !c.is_alphanumeric() && c != '_');
                let after = line[at + word.len()..].chars().next().is_none_or(|c| !c.is_alphanumeric() && c != '_');
                before && after
            };
            if line.match_indices(word).any(|(at, _)| is_word(at)) {
                found.push(format!("{name}:{number}: `{word}`: {advice}: {}", line.trim()));
            }
        }
    }
    found
}

/// The string literals of a source file, without comments, attributes and tests.
fn messages(source: &str) -> String {
    let source = source.split("#[cfg(test)]\nmod tests").next().unwrap_or(source);
    let code = source.lines().filter(|line| {
        let line = line.trim_start();
        !line.starts_with("//") && !line.starts_with("#[expect") && !line.starts_with("#[allow")
    });
    let code = code.collect::<Vec<_>>().join("\n").replace("\\\"", "'").replace("'\"'", "");
    code.split('"').skip(1).step_by(2).collect::<Vec<_>>().join("\n")
}

#[test]
fn help_pages_and_messages_use_plain_words() {
    let place = Workplace::new();
    let mut found = refused("belvedere describe", &place.run("describe --json").stdout);
    for page in pages() {
        found.extend(refused(&page.display().to_string(), &fs::read_to_string(&page).unwrap()));
    }
    let mut sources = Vec::new();
    for folder in ["crates", "research"].map(|folder| fs::read_dir(root().join(folder)).unwrap()).into_iter().flatten()
    {
        let sources_of = folder.unwrap().path().join("src");
        if sources_of.exists() {
            files(&sources_of, "rs", &mut sources);
        }
    }
    assert!(sources.len() > 100, "{}", sources.len());
    for source in sources {
        found.extend(refused(&source.display().to_string(), &messages(&fs::read_to_string(&source).unwrap())));
    }
    assert!(found.is_empty(), "{} places:\n{}", found.len(), found.join("\n"));
}

#[test]
fn refused_words_are_found_in_messages_and_not_in_comments() {
    let source = "// told\nlet a = \"the rim\"; let b = \"trimmed\";\n#[cfg(test)]\nmod tests { \"asked\" }";
    assert_eq!(refused("x", &messages(source)).len(), 1);
    assert!(refused("x", "the told story")[0].contains("given"));
}

#[test]
fn every_flag_and_file_that_a_page_names_exists() {
    let place = Workplace::new();
    let program = place.summary("describe");
    let mut flags: BTreeSet<String> =
        ["--help", "--version"].into_iter().chain(FLAGS_OF_OTHERS).map(str::to_owned).collect();
    let all =
        program["commands"].as_array().unwrap().iter().flat_map(|command| command["parameters"].as_array().unwrap());
    for parameter in all.chain(program["global_parameters"].as_array().unwrap()) {
        flags.insert(parameter["name"].as_str().unwrap().to_owned());
    }
    flags.extend(flags_of_compare());
    let mut missing = Vec::new();
    for page in pages() {
        let text = fs::read_to_string(&page).unwrap();
        for word in text.split(|c: char| !(c.is_ascii_alphanumeric() || c == '-')) {
            if word.len() > 2 && word.starts_with("--") && !word[2..].starts_with('-') && !flags.contains(word) {
                missing.push(format!("{}: {word}", page.display()));
            }
        }
        for link in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            let file = link.split('#').next().unwrap_or_default();
            if !link.contains("://") && !file.is_empty() && !page.parent().unwrap().join(file).exists() {
                missing.push(format!("{}: {link}", page.display()));
            }
        }
    }
    assert!(missing.is_empty(), "{missing:#?}");
}

/// Flags of the program `compare` in `research`, from its source.
fn flags_of_compare() -> Vec<String> {
    let source = fs::read_to_string(root().join("research/compare/src/arguments.rs")).unwrap();
    let fields = source.split("pub(crate) struct Compare {").nth(1).unwrap().split("\n}").next().unwrap();
    let names = fields.lines().filter_map(|line| line.trim().strip_prefix("pub(crate) ")?.split(':').next());
    let mut flags: Vec<String> = names.map(|name| format!("--{}", name.replace('_', "-"))).collect();
    let given = fields.split("long = \"").skip(1).filter_map(|rest| rest.split('"').next());
    flags.extend(given.map(|name| format!("--{name}")));
    assert!(flags.contains(&"--target-count".to_owned()) && flags.contains(&"--held-out".to_owned()), "{flags:?}");
    flags
}

/// Flags of cargo and of this project's examples that pages name.
const FLAGS_OF_OTHERS: [&str; 13] = [
    "--release",
    "--manifest-path",
    "--path",
    "--example",
    "--bench",
    "--package",
    "--baseline-rev",
    "--workspace",
    "--dry-run",
    "--no-default-features",
    "--features",
    "--all-targets",
    "--locked",
];
