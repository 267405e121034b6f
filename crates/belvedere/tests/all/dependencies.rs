//! The crates that the program needs have licences that it may have, and few are there twice: `deny.toml`, without the
//! program that it is written for.

use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The texts of a list of `deny.toml`.
fn list(name: &str) -> BTreeSet<String> {
    let text = std::fs::read_to_string(root().join("deny.toml")).unwrap();
    let (_, after) = text.split_once(&format!("\n{name} = [")).unwrap();
    let (items, _) = after.split_once(']').unwrap();
    items.split(',').map(|item| item.trim().trim_matches('"').to_owned()).filter(|item| !item.is_empty()).collect()
}

/// All crates of the workspace and those that they need.
fn packages() -> Vec<Value> {
    let arguments = ["metadata", "--format-version", "1", "--locked", "--quiet"];
    let metadata = Command::new(env!("CARGO")).args(arguments).current_dir(root()).output().unwrap();
    assert!(metadata.status.success(), "{}", String::from_utf8_lossy(&metadata.stderr));
    let metadata: Value = serde_json::from_slice(&metadata.stdout).unwrap();
    metadata["packages"].as_array().unwrap().clone()
}

/// Returns true if an expression of licences can be met with those that are allowed: words, `AND`, `OR` and brackets.
fn is_met(expression: &str, allowed: &BTreeSet<String>) -> bool {
    let spaced = expression.replace('/', " OR ").replace('(', " ( ").replace(')', " ) ").replace(" WITH ", "\u{1}");
    let words: Vec<String> = spaced.split_whitespace().map(|word| word.replace('\u{1}', " WITH ")).collect();
    let (is_met, rest) = any_of(&words, allowed);
    is_met && rest.is_empty()
}

fn any_of<'a>(words: &'a [String], allowed: &BTreeSet<String>) -> (bool, &'a [String]) {
    let (mut is_met, mut rest) = all_of(words, allowed);
    while let Some(("OR", after)) = rest.split_first().map(|(word, after)| (word.as_str(), after)) {
        let (other, after) = all_of(after, allowed);
        (is_met, rest) = (is_met || other, after);
    }
    (is_met, rest)
}

fn all_of<'a>(words: &'a [String], allowed: &BTreeSet<String>) -> (bool, &'a [String]) {
    let (mut is_met, mut rest) = one(words, allowed);
    while let Some(("AND", after)) = rest.split_first().map(|(word, after)| (word.as_str(), after)) {
        let (other, after) = one(after, allowed);
        (is_met, rest) = (is_met && other, after);
    }
    (is_met, rest)
}

fn one<'a>(words: &'a [String], allowed: &BTreeSet<String>) -> (bool, &'a [String]) {
    match words.split_first() {
        Some((word, after)) if word == "(" => {
            let (is_met, rest) = any_of(after, allowed);
            (is_met && rest.first().is_some_and(|word| word == ")"), rest.get(1..).unwrap_or_default())
        }
        Some((word, after)) => (allowed.contains(word), after),
        None => (false, words),
    }
}

#[test]
fn expressions_of_licences_are_understood() {
    let allowed = list("allow");
    for (expression, expected) in [
        ("MIT", true),
        ("GPL-3.0", false),
        ("MIT OR GPL-3.0", true),
        ("MIT AND GPL-3.0", false),
        ("MIT/Apache-2.0", true),
        ("(MIT OR GPL-3.0) AND Unicode-3.0", true),
        ("MIT OR (GPL-3.0 AND ISC)", true),
        ("GPL-3.0 OR (MPL-2.0 AND ISC)", false),
        ("Apache-2.0 WITH LLVM-exception", true),
        ("GPL-2.0 WITH Classpath-exception-2.0", false),
        ("(MIT", false),
        ("", false),
    ] {
        assert_eq!(is_met(expression, &allowed), expected, "{expression:?}");
    }
}

#[test]
fn crates_of_others_have_licences_that_are_allowed_and_few_are_there_twice() {
    let (allowed, twice) = (list("allow"), list("skip"));
    let mut versions: BTreeMap<String, usize> = BTreeMap::new();
    let packages = packages();
    assert!(packages.len() > 200, "{}", packages.len());
    for package in &packages {
        let name = package["name"].as_str().unwrap();
        let license = package["license"].as_str().unwrap_or_default();
        assert!(is_met(license, &allowed), "{name} has the licence {license:?}, which deny.toml does not allow");
        // from the registry, or of this workspace
        let is_own = package["source"].is_null() && name.starts_with("belvedere");
        assert!(is_own || package["source"].as_str().is_some_and(|source| source.starts_with("registry+")), "{name}");
        *versions.entry(name.to_owned()).or_default() += 1;
    }
    let found: BTreeSet<String> =
        versions.iter().filter(|(_, count)| **count > 1).map(|(name, _)| name.clone()).collect();
    assert_eq!(found, twice, "crates in more than one version, and those that deny.toml names");
    for name in ["ttf-parser", "owned_ttf_parser", "aes"] {
        assert!(!versions.contains_key(name), "{name}");
    }
}
