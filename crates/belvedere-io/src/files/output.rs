//! Targets of output: a file, which appears only when it is complete, or any writer.

use std::io::{BufWriter, Seek, Write};
use std::path::{Path, PathBuf};

use crate::files::atomic;
use belvedere_data::{Error, Result};

/// Writer that an [`Output`] can use.
pub trait WriteSeek: Write + Seek {}
impl<T: Write + Seek> WriteSeek for T {}

/// Bytes gathered before they are handed to the writer.
const BUFFER_BYTES: usize = 1 << 18;

/// One output with a name. The extension of the name selects the format; messages about the output begin with the name.
///
/// Paths become outputs by themselves: wherever an output is expected, a path will do. A file appears under its name
/// only when it is complete; a writer may have received a part when an error is returned.
pub struct Output<'a> {
    name: PathBuf,
    writer: Option<&'a mut dyn WriteSeek>,
}

impl<'a> Output<'a> {
    /// The file at `path`.
    #[must_use]
    pub fn path(path: impl Into<PathBuf>) -> Self {
        Self { name: path.into(), writer: None }
    }

    /// Anything that writes and seeks, from its present position on, such as a `Cursor<Vec<u8>>`. `name` needs an
    /// extension.
    #[must_use]
    pub fn writer(name: impl Into<PathBuf>, writer: &'a mut dyn WriteSeek) -> Self {
        Self { name: name.into(), writer: Some(writer) }
    }

    /// The path, or the name that was given.
    #[must_use]
    pub fn name(&self) -> &Path {
        &self.name
    }

    /// The extension of the name in lower case; empty where there is none.
    #[must_use]
    pub fn extension(&self) -> String {
        crate::files::source::extension(&self.name)
    }

    /// Returns true if the output is a file.
    #[cfg(feature = "las")]
    pub(crate) fn is_path(&self) -> bool {
        self.writer.is_none()
    }

    /// Returns the result of `body`, after everything that it wrote is in the output. The body gets the name for its
    /// errors.
    pub(crate) fn write<T>(self, body: impl FnOnce(&Path, &mut dyn WriteSeek) -> Result<T>) -> Result<T> {
        let Self { name, writer } = self;
        let Some(writer) = writer else { return atomic::write(&name, |file| body(&name, file)) };
        let mut buffered = BufWriter::with_capacity(BUFFER_BYTES, writer);
        let value = body(&name, &mut buffered)?;
        buffered.flush().map_err(Error::io(&name))?;
        Ok(value)
    }
}

impl From<PathBuf> for Output<'_> {
    fn from(path: PathBuf) -> Self {
        Self::path(path)
    }
}

impl From<&PathBuf> for Output<'_> {
    fn from(path: &PathBuf) -> Self {
        Self::path(path)
    }
}

impl From<&Path> for Output<'_> {
    fn from(path: &Path) -> Self {
        Self::path(path)
    }
}

impl From<&str> for Output<'_> {
    fn from(path: &str) -> Self {
        Self::path(path)
    }
}
