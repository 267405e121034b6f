//! Doc comments of all crates: shares of those that open with a clause, and of long sentences. Length of changes in the
//! changelog.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

/// First words of a clause. A noun phrase or a verb says the same, shorter.
const CLAUSES: [&str; 14] = [
    "What", "How", "Which", "Whether", "Where", "Who", "Whom", "Whose", "Whoever", "Of", "Those", "That", "If", "When",
];
/// Maximum share of doc comments that open with a clause. Six crates by others have 0.2 to 4.9 %.
const MAX_CLAUSES: f64 = 0.05;
/// Number of words from which a sentence is long.
const LONG: usize = 31;
/// Maximum share of long sentences: formulas and lists of keywords need some.
const MAX_LONG: f64 = 0.03;

/// Maximum number of words of a change in the changelog.
const MAX_CHANGE: usize = 15;

/// Counts of the doc comments of some files, with the places of the offenders.
#[derive(Default)]
struct Count {
    comments: usize,
    clauses: Vec<String>,
    sentences: usize,
    long: Vec<String>,
}

impl Count {
    /// Adds the doc comments of a source.
    fn add(&mut self, name: &str, source: &str) {
        for (line, comment) in doc_comments(source) {
            self.comments += 1;
            let first = comment.first().and_then(|paragraph| paragraph.split_whitespace().next()).unwrap_or_default();
            if CLAUSES.contains(&first.trim_end_matches(|c: char| !c.is_alphanumeric())) {
                self.clauses.push(format!("{name}:{line}: {}", comment[0]));
            }
            for sentence in comment.iter().flat_map(|paragraph| sentences(paragraph)) {
                self.sentences += 1;
                if words(&sentence) >= LONG {
                    self.long.push(format!("{name}:{line}: {sentence}"));
                }
            }
        }
    }
}

/// Returns the paragraphs of each doc comment, with the line of its beginning. Headings, tables and code are left out;
/// each item of a list is a paragraph.
fn doc_comments(source: &str) -> Vec<(usize, Vec<String>)> {
    let mut found: Vec<(usize, Vec<String>)> = Vec::new();
    let (mut before, mut is_code, mut is_open) = ("", false, false);
    for (number, line) in (1..).zip(source.lines()) {
        let line = line.trim_start();
        let mark = ["///", "//!"].into_iter().find(|mark| line.starts_with(mark)).unwrap_or_default();
        if mark.is_empty() {
            before = mark;
            continue;
        }
        if mark != before {
            found.push((number, Vec::new()));
            (is_code, is_open) = (false, false);
        }
        before = mark;
        let text = line[mark.len()..].trim();
        let is_fence = text.starts_with("```");
        is_code ^= is_fence;
        let is_item = text.starts_with("- ") || text.starts_with("* ");
        if is_code || is_fence || text.is_empty() || text.starts_with(['#', '|']) {
            is_open = false;
        } else if let Some((_, paragraphs)) = found.last_mut() {
            match paragraphs.last_mut().filter(|_| is_open && !is_item) {
                Some(paragraph) => write!(paragraph, " {text}").unwrap(),
                None => paragraphs.push(text.to_owned()),
            }
            is_open = true;
        }
    }
    found.retain(|(_, paragraphs)| !paragraphs.is_empty());
    found
}

/// Splits a paragraph after stops that a capital letter, a code or a link follows.
fn sentences(paragraph: &str) -> Vec<String> {
    let mut sentences = vec![String::new()];
    for word in paragraph.split_whitespace() {
        let begins = word.starts_with(|c: char| c.is_uppercase() || matches!(c, '`' | '[' | '*') || c.is_ascii_digit());
        let ended = |sentence: &String| sentence.trim_end_matches([')', '"']).ends_with(['.', '!', '?']);
        match sentences.last_mut() {
            Some(sentence) if !(begins && ended(sentence)) => write!(sentence, " {word}").unwrap(),
            _ => sentences.push(word.to_owned()),
        }
    }
    sentences.retain(|sentence| !sentence.is_empty());
    sentences
}

/// Counts the words of a sentence: pieces with a letter or a digit.
fn words(sentence: &str) -> usize {
    sentence.split_whitespace().filter(|word| word.contains(char::is_alphanumeric)).count()
}

/// Collects the Rust sources below a folder, without compiled files.
fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            if !["target", "node_modules"].iter().any(|name| path.ends_with(name)) {
                sources(&path, found);
            }
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
}

#[test]
fn doc_comments_are_noun_phrases_or_begin_with_a_verb() {
    let (mut files, mut count) = (Vec::new(), Count::default());
    sources(&Path::new(env!("CARGO_MANIFEST_DIR")).join(".."), &mut files);
    files.sort();
    for path in files {
        count.add(&path.display().to_string(), &fs::read_to_string(&path).unwrap());
    }
    assert!(count.comments > 10_000 && count.sentences > 10_000, "{} {}", count.comments, count.sentences);
    let clauses = count.clauses.len() as f64 / count.comments as f64;
    assert!(clauses < MAX_CLAUSES, "{clauses} open with a clause:\n{}", count.clauses.join("\n"));
    let long = count.long.len() as f64 / count.sentences as f64;
    assert!(long < MAX_LONG, "{long} of the sentences are long:\n{}", count.long.join("\n"));
}

#[test]
fn clauses_and_long_sentences_are_found_and_code_is_not() {
    let long = "word ".repeat(31);
    let source = format!(
        "//! Whether it is so.\n/// Returns one. It is (1.5).\n///\n/// ```\n/// What a code. {long}\n/// ```\nfn one() {{}}\n\
         // What is no doc.\n/// # Errors\n/// Those of two.\n\n/// Two {long} and\n/// more.\n/// - What an item."
    );
    let mut count = Count::default();
    count.add("x.rs", &source);
    assert_eq!((count.comments, count.sentences), (4, 6));
    assert_eq!(count.clauses, ["x.rs:1: Whether it is so.", "x.rs:9: Those of two."]);
    assert_eq!(count.long.len(), 1);
}

#[test]
fn changes_are_lines_of_few_words() {
    let changelog = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../CHANGELOG.md")).unwrap();
    let changes: Vec<&str> = changelog.lines().filter_map(|line| line.strip_prefix("- ")).collect();
    assert!(changes.len() > 100, "{}", changes.len());
    let long: Vec<&&str> = changes.iter().filter(|change| words(change) > MAX_CHANGE).collect();
    assert!(long.is_empty(), "{long:#?}");
    // a change goes on in no second line
    let others = changelog.lines().filter(|line| line.starts_with(' '));
    assert_eq!(others.collect::<Vec<_>>(), [""; 0]);
}
