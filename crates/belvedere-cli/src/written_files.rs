//! Inputs are there, no output replaces an input, and no file gets two results. Checked for all commands at once, on
//! what was typed, before anything is read.

use crate::arguments::{CornersArgument, refuse};
use anyhow::Result;
use belvedere::io::{Source, web_address};
use clap::parser::ValueSource;
use clap::{Arg, ArgMatches, Command};
use std::any::TypeId;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

/// A path that was typed, and the flag it belongs to.
struct Typed {
    flag: String,
    path: PathBuf,
}

/// Refuses inputs beside the scene that are not there, and outputs that are the same file as an input or as another
/// output of the command in `matches`.
pub(crate) fn check(program: &Command, matches: &ArgMatches) -> Result<()> {
    let Some((name, of_command)) = matches.subcommand() else { return Ok(()) };
    let Some(command) = program.find_subcommand(name) else { return Ok(()) };
    if command.has_subcommands() {
        return check(command, of_command);
    }
    let (mut inputs, mut outputs): (Vec<Typed>, Vec<Typed>) = (Vec::new(), Vec::new());
    for argument in command.get_arguments().filter(|argument| argument.get_action().takes_values()) {
        if of_command.value_source(argument.get_id().as_str()) != Some(ValueSource::CommandLine) {
            continue;
        }
        for value in of_command.get_raw(argument.get_id().as_str()).into_iter().flatten() {
            let typed = |path: PathBuf| Typed { flag: flag(argument), path };
            if is_output(argument) {
                outputs.push(typed(value.into()));
            } else {
                let paths = files_named(argument, value);
                if is_beside_the_scene(argument) {
                    paths.iter().try_for_each(|path| check_input(path))?;
                }
                inputs.extend(paths.into_iter().flat_map(files_of).map(typed));
            }
        }
    }
    for (i, output) in outputs.iter().enumerate() {
        let path = output.path.display();
        if let Some(input) = inputs.iter().find(|input| is_same(&input.path, &output.path)) {
            let (flag, input) = (&output.flag, input.path.display());
            return refuse(format!(
                "{flag} {path}: the same file as the input {input}, which it would replace; choose another name"
            ));
        }
        if let Some(earlier) = outputs[..i].iter().find(|other| is_same(&other.path, &output.path)) {
            let (flag, other) = (&output.flag, &earlier.flag);
            return refuse(format!("{flag} {path}: given for two results (also {other}); choose another name"));
        }
    }
    Ok(())
}

/// Refuses an input that is not there, on the disk or on a server.
pub(crate) fn check_input(path: &Path) -> belvedere::Result<()> {
    match web_address(path) {
        Some(_) => Source::path(path).into_reader().map(drop),
        None => path.metadata().map(drop).map_err(belvedere::Error::io(path)),
    }
}

/// Returns true if an argument names a file that is read after the scene is built, which may take hours. The files of
/// the scene are read at once.
fn is_beside_the_scene(argument: &Arg) -> bool {
    let is_of_scene = |name: &clap::builder::Str| ["CLOUD", "DIR"].contains(&name.as_str());
    // a page is written to
    argument.get_id() != "page" && argument.get_value_names().is_none_or(|names| !names.iter().any(is_of_scene))
}

/// The file that a value names, if it does. Some flags name it behind an equals sign.
pub(crate) fn files_named(argument: &Arg, value: &OsStr) -> Vec<PathBuf> {
    let text = value.to_string_lossy();
    let parsed = argument.get_value_parser().type_id();
    match text.split_once('=') {
        // standard input
        _ if text == "-" => Vec::new(),
        _ if parsed == TypeId::of::<PathBuf>() => vec![value.into()],
        Some(("trajectory" | "mesh" | "cloud", file)) => vec![file.into()],
        Some((_, file)) if argument.get_id() == "model" => vec![file.into()],
        // corners are typed, or in a file
        _ if parsed == TypeId::of::<CornersArgument>() && !text.contains(',') => vec![value.into()],
        _ => Vec::new(),
    }
}

/// Returns true if an argument names a file to write. Folders hold files of other names than their command reads.
fn is_output(argument: &Arg) -> bool {
    is_called(argument, "OUT")
}

/// Returns true if an argument names a folder to write into.
pub(crate) fn is_folder(argument: &Arg) -> bool {
    is_called(argument, "DIR")
}

/// Returns true if an argument names a file or a folder to write.
pub(crate) fn is_written(argument: &Arg) -> bool {
    is_output(argument) || is_folder(argument)
}

fn is_called(argument: &Arg, name: &str) -> bool {
    argument.get_value_names().is_some_and(|names| names.iter().any(|own| own == name))
}

fn flag(argument: &Arg) -> String {
    match (argument.get_short(), argument.get_long()) {
        (Some(short), _) => format!("-{short}"),
        (None, Some(long)) => format!("--{long}"),
        (None, None) => argument.get_id().to_string(),
    }
}

/// The file at a path, or the files of a folder.
fn files_of(path: PathBuf) -> Vec<PathBuf> {
    match path.read_dir() {
        Ok(entries) => entries.filter_map(|entry| Some(entry.ok()?.path())).filter(|path| path.is_file()).collect(),
        Err(_) => vec![path],
    }
}

/// Returns true if two paths lead to the same plain file, through links too, or would if it existed.
fn is_same(a: &Path, b: &Path) -> bool {
    match (a.metadata(), b.metadata()) {
        (Ok(of_a), Ok(of_b)) => of_a.is_file() && of_b.is_file() && is_identical((a, &of_a), (b, &of_b)),
        (Err(_), Err(_)) => absolute(a).is_some_and(|a| Some(a) == absolute(b)),
        _ => false,
    }
}

#[cfg(unix)]
fn is_identical((_, a): (&Path, &std::fs::Metadata), (_, b): (&Path, &std::fs::Metadata)) -> bool {
    use std::os::unix::fs::MetadataExt;
    (a.dev(), a.ino()) == (b.dev(), b.ino())
}

#[cfg(not(unix))]
fn is_identical((a, _): (&Path, &std::fs::Metadata), (b, _): (&Path, &std::fs::Metadata)) -> bool {
    matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b)
}

/// The path of a file that is not there yet.
fn absolute(path: &Path) -> Option<PathBuf> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    Some(folder.canonicalize().ok()?.join(path.file_name()?))
}
