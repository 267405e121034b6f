//! Text files.

use belvedere::Result;
use belvedere::io::atomic;
use std::io::Write;
use std::path::Path;

/// Writes a text file that appears only when it is complete.
pub(crate) fn write_text(path: &Path, text: &str) -> Result<()> {
    atomic::write(path, |file| file.write_all(text.as_bytes()).map_err(belvedere::Error::io(path)))
}

/// Writes lines of text.
pub(crate) fn write_lines(path: &Path, lines: impl Iterator<Item = String>) -> Result<()> {
    write_text(path, &lines.map(|line| line + "\n").collect::<String>())
}
