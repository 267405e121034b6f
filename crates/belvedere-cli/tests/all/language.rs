//! Plain words in help, messages, pages and code; and pages that name only what exists.

use crate::common::Workplace;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Words that readers with another first language stumble over, or that have had two meanings here, and what to write
/// instead.
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
/// Words that code must not use beside those: comments, names and tests.
const REFUSED_IN_CODE: [(&str, &str); 7] = [
    ("halo", "say `buffer`"),
    ("halos", "say `buffers`"),
    ("needle", "say `pulse`, `free segment`"),
    ("needles", "say `pulses`, `free segments`"),
    ("facts", "say `statistics`"),
    ("tell apart", "say `separate`"),
    ("told apart", "say `separated`"),
];
/// Keys of files and of JSON that must stay although they contain such a word.
const KEYS: [&str; 14] = [
    "\"facts\"",
    "\"halo\"",
    "\"needle\"",
    "\"needles\"",
    "halo_m",
    "points_read_with_halo",
    "points_with_halo",
    "least_elevation",
    "least_green_and_blue",
    "least_possible_cameras",
    "most_balls",
    "most_green_and_blue",
    "most_lean",
    "most_points_of_a_tile",
];
/// Maximum length of a line of comment, characters.
const MAX_COMMENT: usize = 120;

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
    found_words(name, text, &REFUSED)
}

fn found_words(name: &str, text: &str, words: &[(&str, &str)]) -> Vec<String> {
    let mut found = Vec::new();
    for (number, line) in (1..).zip(text.lines()) {
        let line = line.to_lowercase();
        for (word, advice) in words {
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

/// Source files of programs, tests and the page, without what is generated.
fn sources() -> Vec<PathBuf> {
    let mut sources = Vec::new();
    for folder in ["crates", "fuzz", "integrations", "research"].map(|folder| root().join(folder)) {
        for extension in ["rs", "py", "wgsl", "js", "mjs"] {
            if folder.is_dir() {
                files(&folder, extension, &mut sources);
            }
        }
    }
    let is_own = |path: &PathBuf| {
        let text = path.display().to_string().replace('\\', "/");
        !["/target/", "/node_modules/", "page/page.js", "tests/all/language.rs"].iter().any(|part| text.contains(part))
    };
    sources.into_iter().filter(is_own).collect()
}

/// A source text with its names as words: `is_lit` and `IsLit` become "is lit".
fn words_of(source: &str) -> String {
    let mut words = String::with_capacity(source.len() + source.len() / 8);
    let mut was_lower = false;
    for letter in source.chars() {
        if letter.is_uppercase() && was_lower {
            words.push(' ');
        }
        was_lower = letter.is_lowercase();
        words.push(if letter == '_' { ' ' } else { letter });
    }
    words
}

/// Refused words in the comments, names and texts of a source file.
fn refused_in_code(name: &str, source: &str) -> Vec<String> {
    let mut source = source.to_owned();
    KEYS.iter().for_each(|key| source = source.replace(key, ""));
    let words = words_of(&source);
    let mut found = refused(name, &words);
    found.extend(found_words(name, &words, &REFUSED_IN_CODE));
    for (number, line) in (1..).zip(source.lines()) {
        if line.contains("The same.") {
            found.push(format!("{name}:{number}: `The same.`: say what it is: {}", line.trim()));
        }
        for own in line.split(|c: char| !c.is_alphanumeric() && c != '_') {
            let upper = own.to_uppercase();
            let is_limit = upper.starts_with("MOST_") || upper.starts_with("LEAST_");
            // longer names are sentences: names of tests
            if is_limit && own.split('_').count() < 5 {
                found.push(format!("{name}:{number}: `{own}`: say `max` or `min`"));
            }
        }
    }
    found
}

/// Lines of comments that are too long, except those with an address, which cannot be broken.
fn long_comments(name: &str, source: &str) -> Vec<String> {
    let mark = if name.ends_with(".py") { "#" } else { "//" };
    let is_long =
        |line: &str| line.trim_start().starts_with(mark) && line.chars().count() > MAX_COMMENT && !line.contains("://");
    let lines = (1..).zip(source.lines()).filter(|(_, line)| is_long(line));
    lines.map(|(number, line)| format!("{name}:{number}: {} characters", line.chars().count())).collect()
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
fn code_uses_plain_words() {
    let sources = sources();
    assert!(sources.len() > 500, "{}", sources.len());
    let found: Vec<String> = sources
        .iter()
        .flat_map(|path| refused_in_code(&path.display().to_string(), &fs::read_to_string(path).unwrap()))
        .collect();
    assert!(found.is_empty(), "{} places:\n{}", found.len(), found.join("\n"));
}

#[test]
fn comments_wrap_at_120() {
    let found: Vec<String> = sources()
        .iter()
        .flat_map(|path| long_comments(&path.display().to_string(), &fs::read_to_string(path).unwrap()))
        .collect();
    assert!(found.is_empty(), "{} lines:\n{}", found.len(), found.join("\n"));
}

#[test]
fn refused_words_are_found_in_comments_and_parts_of_names() {
    let source = "/// What is asked.\nfn is_told(IsToldElsewhere: u8) {}\nconst MOST_BALLS: u8 = 1;\n// The same.";
    assert_eq!(refused_in_code("x.rs", source).len(), 4);
    let fine = "// at most one, the same as before\nfn most_of_a_town_is_there() { trim(at_least_one, \"halo_m\") }";
    assert_eq!(refused_in_code("x.rs", fine), [""; 0]);
}

#[test]
fn long_lines_of_comments_are_found_and_long_addresses_are_not() {
    let long = "word ".repeat(25);
    let source = format!("// {long}\nlet a = 1; // {long}\n/// https://{long}\n//! short");
    assert_eq!(long_comments("x.rs", &source), ["x.rs:1: 128 characters"]);
    assert_eq!(long_comments("x.py", &format!("# {long}\n")).len(), 1);
}

/// Command lines of the program in a page: at the beginning of a line or of a piece of code, without `belvedere`.
fn command_lines(page: &str) -> Vec<String> {
    let lines = page.replace("\\\n", " ");
    let pieces = lines.split(['\n', '`', '|', ';']).filter_map(|piece| piece.trim().strip_prefix("belvedere "));
    let is_command = |piece: &&str| piece.starts_with(|c: char| c.is_ascii_lowercase());
    pieces.filter(is_command).map(|piece| piece.split(" # ").next().unwrap_or_default().to_owned()).collect()
}

/// Commands, and flags of other commands, that a page names; `flags` has the names of commands, each with its flags.
fn wrong_commands(page: &str, flags: &BTreeMap<String, BTreeSet<String>>) -> Vec<String> {
    let mut wrong = Vec::new();
    for line in command_lines(page) {
        let words: Vec<&str> = line.split_whitespace().collect();
        let names = [words.iter().take(2).copied().collect::<Vec<_>>().join(" "), words[0].to_owned()];
        let own = names.iter().find_map(|name| flags.get(name));
        let has_flag = |flag: &str| own.is_some_and(|own| own.contains(flag.split('=').next().unwrap_or_default()));
        let is_step = flags.keys().any(|name| name.starts_with(&format!("{} ", words[0])));
        match own {
            None if words[0] == "help"
                && words.get(1).is_none_or(|name| *name == "COMMAND" || flags.contains_key(*name)) => {}
            None if is_step && words.len() == 1 => {}
            None => wrong.push(format!("there is no command: belvedere {line}")),
            Some(_) => {
                let flags = words.iter().filter(|word| word.starts_with("--") && word.len() > 2);
                wrong.extend(
                    flags.filter(|flag| !has_flag(flag)).map(|flag| format!("{flag} is no flag: belvedere {line}")),
                );
            }
        }
    }
    wrong
}

#[test]
fn commands_and_flags_of_others_are_found_in_pages() {
    let own = |flags: &[&str]| flags.iter().map(|&flag| flag.to_owned()).collect::<BTreeSet<String>>();
    let flags =
        BTreeMap::from([("shadow".to_owned(), own(&["--time", "--json"])), ("city run".to_owned(), own(&["--json"]))]);
    let fine = "belvedere shadow a.laz --time=1 \\\n  --json # --any\n`belvedere city run x`, `belvedere help shadow`, belvedere does";
    assert_eq!(wrong_commands(fine, &flags), [""; 0]);
    let wrong = "see `belvedere compare`\nbelvedere city run a --time 1\n`belvedere help compare`";
    assert_eq!(wrong_commands(wrong, &flags).len(), 3);
}

#[test]
fn every_command_flag_and_file_that_a_page_names_exists() {
    let place = Workplace::new();
    let program = place.summary("describe");
    let names = |parameters: &serde_json::Value| -> BTreeSet<String> {
        let rows = parameters.as_array().unwrap().iter();
        rows.map(|parameter| parameter["name"].as_str().unwrap().to_owned()).collect()
    };
    let mut global = names(&program["global_parameters"]);
    global.extend(["--help", "--version"].map(str::to_owned));
    let of_command = |command: &serde_json::Value| {
        let own = names(&command["parameters"]).union(&global).cloned().collect();
        (command["name"].as_str().unwrap().to_owned(), own)
    };
    let by_command: BTreeMap<String, BTreeSet<String>> =
        program["commands"].as_array().unwrap().iter().map(of_command).collect();
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
        let wrong = wrong_commands(&text, &by_command);
        missing.extend(wrong.into_iter().map(|wrong| format!("{}: {wrong}", page.display())));
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
