//! The command that was typed, as files name it: what decides the answer, without folders.

use crate::written_files::{files_named, is_written};
use belvedere::results::file_name;
use clap::parser::ValueSource;
use clap::{Arg, ArgMatches, Command};
use std::ffi::OsStr;

/// Describes the command in `matches`, such as `belvedere shadow town.laz --time 2026-06-21T15:00+02:00`. Outputs and
/// settings of the program, such as threads, are left out; files have no folders, which may be private.
pub(crate) fn described(program: &Command, matches: &ArgMatches) -> String {
    let mut words = vec![program.get_name().to_owned()];
    let (mut command, mut matches) = (program, matches);
    while let Some((name, of_command)) = matches.subcommand() {
        let Some(found) = command.find_subcommand(name) else { break };
        (command, matches) = (found, of_command);
        words.push(name.to_owned());
    }
    let is_typed = |argument: &&Arg| {
        matches.value_source(argument.get_id().as_str()) == Some(ValueSource::CommandLine)
            && !argument.is_global_set()
            && !is_written(argument)
    };
    let (positional, flags): (Vec<&Arg>, Vec<&Arg>) =
        command.get_arguments().partition(|argument| argument.is_positional());
    for argument in positional.into_iter().chain(flags).filter(is_typed) {
        let flag = argument.get_long().map(|long| format!("--{long}"));
        if !argument.get_action().takes_values() {
            words.extend(flag);
            continue;
        }
        for occurrence in matches.get_raw_occurrences(argument.get_id().as_str()).into_iter().flatten() {
            words.extend(flag.clone());
            words.extend(occurrence.map(|value| quoted(&without_folders(argument, value))));
        }
    }
    words.join(" ")
}

/// A typed value, of which files have no folders.
fn without_folders(argument: &Arg, value: &OsStr) -> String {
    let text = value.to_string_lossy();
    let Some(path) = files_named(argument, value).pop() else { return text.into_owned() };
    let path = path.to_string_lossy();
    format!("{}{}", text.strip_suffix(&*path).unwrap_or_default(), file_name(&path))
}

/// A word as shells take it.
fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "-_.,:=+/@%".contains(c);
    match !word.is_empty() && word.chars().all(is_plain) {
        true => word.to_owned(),
        false => format!("'{}'", word.replace('\'', r"'\''")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of_words(words: &[&str]) -> String {
        let program = crate::help::command();
        let matches = program.clone().try_get_matches_from(words).unwrap();
        described(&program, &matches)
    }

    #[test]
    fn outputs_settings_and_folders_are_left_out() {
        let words = ["belvedere", "shadow", "/home/ann/my town.laz", "--threads", "1", "--time", "2026-06-21T15:00Z"];
        let typed = [&words[..], &["-o", "a.tif", "--targets", "../b.csv", "--quiet", "--soft"]].concat();
        let found = of_words(&typed);
        for part in ["belvedere shadow 'my town.laz'", "--time 2026-06-21T15:00Z", "--targets b.csv", "--soft"] {
            assert!(found.contains(part), "{part}: {found}");
        }
        assert!(!found.contains("home") && !found.contains("a.tif") && !found.contains("threads"), "{found}");
        let far = of_words(&["belvedere", "info", "https://example.org/a/b.laz?key=1"]);
        assert_eq!(far, "belvedere info b.laz");
    }
}
