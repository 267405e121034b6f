//! Looks for files that make a reader panic, hang or take too much memory: the one that `BELVEDERE_READER` names.
#![no_main]

#[path = "../crates/belvedere-tiles/tests/hostile/readers.rs"]
mod readers;

use std::sync::LazyLock;

static READER: LazyLock<&readers::TriedReader> = LazyLock::new(|| {
    let name = std::env::var("BELVEDERE_READER").unwrap_or_default();
    let names: Vec<_> = readers::READERS.iter().map(|reader| reader.file).collect();
    let found = readers::READERS.iter().find(|reader| reader.file == name);
    found.unwrap_or_else(|| panic!("BELVEDERE_READER is {name:?}, none of {}", names.join(" ")))
});

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    readers::check(&READER, bytes);
});
