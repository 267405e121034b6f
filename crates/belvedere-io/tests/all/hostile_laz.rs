//! Files that coverage-guided fuzzing made to crash LAS and LAZ readers, and the cost of refusing each.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use belvedere_data::control::Control;
use belvedere_io::{ReadOptions, Source, read_cloud};

/// Names the folder of files for the process that reads them.
const FOLDER: &str = "BELVEDERE_HOSTILE_FOLDER";
/// Duration that only work without end reaches, on any machine, in seconds: most files take milliseconds.
const SECONDS: f64 = 120.0;
/// Maximum memory of one file.
const MEBIBYTES: u64 = 200;

/// Largest resident memory of this process since the last call of [`forget_peak`], in MiB; `None` where the system does
/// not tell.
fn peak() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(line.split_whitespace().next()?.parse::<u64>().ok()? / 1024)
}

fn forget_peak() {
    // only Linux has this file; without it the peaks only grow
    let _ = std::fs::write("/proc/self/clear_refs", "5");
}

/// Reads each file of the folder that the environment names as LAS and as LAZ. A process of its own runs this, because
/// an abort would end the test program, and because other tests would be measured too.
#[test]
#[ignore = "run by fuzzed_files_are_refused_in_little_memory"]
fn read_the_folder_of_fuzzed_files() {
    let Some(folder) = std::env::var_os(FOLDER).map(PathBuf::from) else { return };
    let mut files: Vec<PathBuf> = folder.read_dir().unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    for file in &files {
        let bytes = std::fs::read(file).unwrap();
        for extension in ["las", "laz"] {
            let name = file.with_extension(extension);
            forget_peak();
            let start = Instant::now();
            let result = read_cloud([Source::bytes(&name, &bytes)], &ReadOptions::default(), &Control::none());
            let seconds = start.elapsed().as_secs_f64();
            let outcome = match result {
                Ok((cloud, _)) => format!("{} points", cloud.len()),
                Err(error) => error.to_string().replace('\n', " "),
            };
            println!("READ {seconds:.3} s {} MiB {}: {outcome}", peak().unwrap_or(0), file_name(file));
        }
    }
    println!("READ ALL");
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap().to_string_lossy().into_owned()
}

#[test]
fn fuzzed_files_are_refused_in_little_memory() {
    const TEST: &str = "fuzzed_files_are_refused_in_little_memory";
    let Some(folder) = crate::common::data(TEST, "data/hostile_laz") else { return };
    let output = Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "hostile_laz::read_the_folder_of_fuzzed_files", "--ignored", "--nocapture"])
        .env(FOLDER, folder)
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stdout);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && text.contains("READ ALL"), "{text}{errors}");
    assert!(!errors.contains("panicked"), "{errors}");
    let mut count = 0;
    for line in text.lines().filter_map(|line| line.split_once("READ ").map(|(_, rest)| rest)) {
        let words: Vec<&str> = line.split_whitespace().collect();
        let [seconds, "s", mebibytes, "MiB", ..] = words[..] else { continue };
        count += 1;
        assert!(seconds.parse::<f64>().unwrap() < SECONDS, "{line}");
        assert!(mebibytes.parse::<u64>().unwrap() < MEBIBYTES, "{line}");
    }
    assert_eq!(count, 2 * 63, "{text}");
}
