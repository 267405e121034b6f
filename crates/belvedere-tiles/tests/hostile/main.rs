//! Files that fuzzing made to break a reader, and valid files. Each is read or refused, in time and in little memory.
//! See `fuzz/`.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod readers;

use readers::{READERS, TriedReader, check};
use std::time::Instant;

/// Maximum time for a file, seconds. Only endless work reaches it on any machine; most files take milliseconds.
const SECONDS: f64 = 120.0;

/// Reader that takes 100 MB.
const GREEDY: TriedReader =
    TriedReader { file: "greedy", read: |_, bytes| std::hint::black_box(vec![1_u8; 100_000_000]).len() > bytes.len() };

// The only test of this program: memory is counted for all of its threads.
#[test]
fn every_input_is_read_or_refused_in_time_and_little_memory() {
    assert!(std::panic::catch_unwind(|| check(&GREEDY, &[])).is_err(), "memory is not counted");
    let large = vec![0; 3_000_000];
    assert!(check(&GREEDY, &large));
    let inputs = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/hostile/inputs");
    for reader in READERS {
        let folder = format!("{inputs}/{}", reader.file);
        let mut files: Vec<_> = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()).collect();
        files.sort();
        assert!(!files.is_empty(), "{folder}");
        for file in files {
            println!("{}", file.display());
            let (bytes, start) = (std::fs::read(&file).unwrap(), Instant::now());
            // Files that broke a reader are named after it; fuzzing starts from the others.
            let was_found = file.file_name().unwrap().to_string_lossy().starts_with("found_");
            assert!(check(reader, &bytes) || was_found, "{} is refused", file.display());
            assert!(start.elapsed().as_secs_f64() < SECONDS, "{}", file.display());
        }
    }
}
