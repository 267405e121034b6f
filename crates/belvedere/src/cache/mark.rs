//! Folders of the program's own, which a file with a mark tells from all others.
//!
//! # Source
//! Cache Directory Tagging Specification (Burnett 2004): programs that make copies of a disk pass over such folders.

use crate::io::atomic;
use crate::{Error, Result};
use std::fs::{self, DirBuilder};
use std::io::{ErrorKind, Write};
use std::path::Path;

/// The file that marks a folder. Its first line is that of all caches, and the second one that of this program.
pub(super) const TAG: &str = "CACHEDIR.TAG";
const MARK: &str =
    "Signature: 8a477f597d28d172789f06886806bc55\n# Kept by belvedere, which removes its own files here.\n";

/// A folder to which nothing is to be added, and the reason.
const FOREIGN: &str = "is a folder of files that this program did not make, or has no mark of its own; \
                       move it away, or give another one that is new or empty";

/// Returns true if a path is a folder with the mark; a link to one counts.
pub(super) fn is_marked(folder: &Path) -> bool {
    let tag = folder.join(TAG);
    is_plain_file(&tag) && fs::read(tag).is_ok_and(|bytes| bytes == MARK.as_bytes())
}

/// Returns true if a path is a folder with the mark, and no link.
pub(super) fn is_own_folder(folder: &Path) -> bool {
    is_plain_folder(folder) && is_marked(folder)
}

/// Returns true if a path is a file: neither a link nor a pipe, which could wait for ever.
pub(super) fn is_plain_file(path: &Path) -> bool {
    path.symlink_metadata().is_ok_and(|found| found.is_file())
}

/// Returns true if a path is a folder and no link.
pub(super) fn is_plain_folder(path: &Path) -> bool {
    path.symlink_metadata().is_ok_and(|found| found.is_dir())
}

/// Makes a folder that only its user can read, or marks one that is empty. One with the mark stays as it is.
///
/// # Errors
/// [`Error::Io`] for a folder of others, and for one that cannot be made.
pub(super) fn make_marked(folder: &Path) -> Result<()> {
    make_private(folder)?;
    // another program may mark it at the same time
    if is_marked(folder) || (!is_empty(folder)? && is_marked(folder)) {
        return Ok(());
    }
    if !is_empty(folder)? && !is_marked(folder) {
        return Err(foreign(folder));
    }
    close_to_others(folder);
    mark(folder)
}

/// Makes a folder that must not be there yet, or has the mark already.
///
/// # Errors
/// Those of [`make_marked`].
pub(super) fn make_new(folder: &Path) -> Result<()> {
    match private_folders().create(folder) {
        Ok(()) => mark(folder),
        Err(error) if error.kind() == ErrorKind::AlreadyExists && is_own_folder(folder) => Ok(()),
        Err(error) if error.kind() == ErrorKind::AlreadyExists => Err(foreign(folder)),
        Err(error) => Err(Error::io(folder)(error)),
    }
}

/// Makes a folder, and those above it, that only its user can read; one that is there stays as it is.
pub(super) fn make_private(folder: &Path) -> Result<()> {
    private_folders().recursive(true).create(folder).map_err(Error::io(folder))
}

fn foreign(folder: &Path) -> Error {
    Error::io(folder)(std::io::Error::new(ErrorKind::AlreadyExists, FOREIGN))
}

fn mark(folder: &Path) -> Result<()> {
    let tag = folder.join(TAG);
    atomic::write(&tag, |file| file.write_all(MARK.as_bytes()).map_err(Error::io(&tag)))
}

/// Returns true if a folder holds only the remains of an interrupted marking.
fn is_empty(folder: &Path) -> Result<bool> {
    let mut rows = folder.read_dir().map_err(Error::io(folder))?;
    let unfinished = format!(".{TAG}.");
    Ok(rows.all(|row| row.is_ok_and(|row| row.file_name().to_string_lossy().starts_with(&unfinished))))
}

fn private_folders() -> DirBuilder {
    #[cfg_attr(not(unix), expect(unused_mut, reason = "only Unix has modes"))]
    let mut builder = DirBuilder::new();
    #[cfg(unix)]
    std::os::unix::fs::DirBuilderExt::mode(&mut builder, 0o700);
    builder
}

/// Lets only the user of an empty folder look into it; one of another user stays as it is.
fn close_to_others(folder: &Path) {
    #[cfg(unix)]
    let _ = fs::set_permissions(folder, std::os::unix::fs::PermissionsExt::from_mode(0o700));
    #[cfg(not(unix))]
    let _ = folder;
}
