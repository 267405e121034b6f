//! Files that a report rests on.

use crate::Result;
use crate::cache::file_hash;
use std::path::Path;

/// A file that a report rests on.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ReportSource {
    /// Key of what it is for: cloud, plan, windows, areas or terrain.
    pub role: &'static str,
    /// Its name, without folder.
    pub name: String,
    /// Its SHA-256 in hexadecimal digits; empty where it is not a file of this machine.
    pub sha256: String,
}

impl ReportSource {
    /// Reads the whole of a file for its hash. A folder or an address of the web has its name alone.
    ///
    /// # Errors
    /// [`crate::Error::Io`].
    pub fn of_path(role: &'static str, path: &Path) -> Result<Self> {
        let name = crate::results::file_name(&path.to_string_lossy());
        if !path.is_file() {
            return Ok(Self { role, name, ..Self::default() });
        }
        Ok(Self { role, name, sha256: file_hash(path)? })
    }
}
