//! Ctrl-C: a run stops in the middle of its work and leaves no unfinished file.
#![cfg(unix)]
#![expect(clippy::unwrap_used, reason = "tests stop at the first surprise")]

use crate::common::Workplace;
use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};

/// Runs the program, sends SIGINT once it has finished its first stage, and gives the exit status and the lines that it
/// printed to standard error.
fn interrupted(place: &Workplace, arguments: &str) -> (Option<i32>, Vec<String>) {
    let mut run = place
        .command(&format!("--progress json {arguments}"))
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut lines = BufReader::new(run.stderr.take().unwrap()).lines().map(|line| line.unwrap());
    let first = lines.next().unwrap();
    assert!(first.contains("\"stage\""), "{first}");
    let sent = Command::new("kill").args(["-INT", &run.id().to_string()]).status().unwrap();
    assert!(sent.success());
    let rest: Vec<String> = lines.collect();
    (run.wait().unwrap().code(), rest)
}

#[test]
fn a_run_that_is_interrupted_while_it_builds_a_model_writes_nothing() {
    let place = Workplace::new();
    assert_eq!(place.run("simulate town -o town --extent 120").status, 0);
    std::fs::create_dir(place.path("out")).unwrap();
    let (status, lines) = interrupted(&place, "balls town/cloud.laz -o out/balls.npz");
    assert_eq!(status, Some(130), "{lines:?}");
    assert!(lines.iter().any(|line| line.contains("interrupted")), "{lines:?}");
    // the model was never finished: the stage after its last one did not begin
    assert!(!lines.iter().any(|line| line.contains("\"filling\"") || line.contains("\"writing\"")), "{lines:?}");
    assert_eq!(std::fs::read_dir(place.path("out")).unwrap().count(), 0);
}

#[test]
fn work_that_cannot_be_cancelled_ends_with_the_program() {
    let place = Workplace::new();
    // a town of 3 km: far longer than anybody waits for a test
    let (status, lines) = interrupted(&place, "simulate town -o town --extent 3000");
    assert_eq!(status, Some(130), "{lines:?}");
    assert!(lines.iter().any(|line| line.contains("interrupted")), "{lines:?}");
    let left: Vec<_> = walk(&place.path("town")).into_iter().filter(|name| name.ends_with(".part")).collect();
    assert!(left.is_empty(), "{left:?}");
}

/// Names of the files in a folder, empty where there is none.
fn walk(folder: &std::path::Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).into_iter().flatten();
    entries.map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned()).collect()
}
