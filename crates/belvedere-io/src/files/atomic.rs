//! Outputs that appear under their name only when they are complete.

use std::ffi::OsStr;
use std::fs::{self, File, OpenOptions};
use std::io::{BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::{LazyLock, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use belvedere_data::{Error, Result};

/// Maximum number of names to try for the temporary file; leftovers of killed runs may occupy some.
const MAX_NAME_ATTEMPTS: u32 = 1000;

/// Bytes gathered before they are handed to the operating system.
const BUFFER_BYTES: usize = 1 << 18;

/// Minimum age of an unfinished file that this computer cannot judge before it is removed, since the last write. Runs
/// write all the time, and none pauses for a day.
const OLD: Duration = Duration::from_secs(24 * 3600);

/// Identity of the host of this process: the start of this computer, and the space of process numbers, of which each
/// container has its own. It is part of the names of unfinished files. Computers and containers with a common folder
/// then do not take the files of each other for leftovers. Available on Linux only.
static HOST: LazyLock<String> = LazyLock::new(|| {
    let boot = fs::read_to_string("/proc/sys/kernel/random/boot_id").unwrap_or_default();
    let space = fs::read_link("/proc/self/ns/pid").unwrap_or_default();
    let digits = |text: &str| text.chars().filter(char::is_ascii_hexdigit).collect::<String>();
    let (boot, space) = (digits(&boot), digits(space.to_string_lossy().trim_start_matches("pid")));
    if boot.is_empty() || space.is_empty() { String::new() } else { format!("{boot:.12}{space}") }
});

/// A file that is removed again unless it was renamed to its final place.
struct Temporary {
    path: PathBuf,
    kept: bool,
}

/// Temporary files that are being written. A program that ends without unwinding, as on Ctrl-C, has no other way to
/// know of them.
static UNFINISHED: Mutex<Unfinished> = Mutex::new(Unfinished { paths: Vec::new(), is_abandoned: false });

struct Unfinished {
    paths: Vec<PathBuf>,
    is_abandoned: bool,
}

fn unfinished() -> MutexGuard<'static, Unfinished> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes every temporary file of this process, whose outputs then never appear, and refuses to begin others.
///
/// For a program that ends at once while other threads may still write. Nothing can be written afterwards.
pub fn abandon_unfinished() {
    let mut unfinished = unfinished();
    unfinished.is_abandoned = true;
    for path in unfinished.paths.drain(..) {
        // a failure leaves a file that says by its name that it is unfinished
        let _ = fs::remove_file(path);
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        unfinished().paths.retain(|path| *path != self.path);
        if !self.kept {
            // nothing can be done about a failure here, and the error that led here is the one to report
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// Writes a file and returns the result of `body`, after everything that it wrote is under `path`.
///
/// The body writes to a temporary file in the same folder, which replaces `path` when the body succeeded. When it
/// returns an error or panics, the temporary file is removed and the file at `path` stays unchanged. A link is
/// followed, so that its target is replaced; a pipe, a device or another special file is written directly.
///
/// # Errors
/// [`Error::Io`] when the folder does not exist or writing fails, and whatever `body` returns.
pub fn write<T>(path: &Path, body: impl FnOnce(&mut BufWriter<File>) -> Result<T>) -> Result<T> {
    let existing = fs::metadata(path).ok();
    if existing.as_ref().is_some_and(fs::Metadata::is_dir) {
        return Err(Error::io(path)(std::io::Error::new(ErrorKind::IsADirectory, "is a folder, not a file")));
    }
    if existing.as_ref().is_some_and(|m| !m.is_file()) {
        let file = OpenOptions::new().write(true).open(path).map_err(Error::io(path))?;
        let mut writer = BufWriter::new(file);
        let value = body(&mut writer)?;
        writer.flush().map_err(Error::io(path))?;
        return Ok(value);
    }
    let target = if existing.is_some() { fs::canonicalize(path).map_err(Error::io(path))? } else { path.to_owned() };
    let (file, mut temporary) = create_beside(&target)?;
    let mut writer = BufWriter::with_capacity(BUFFER_BYTES, file);
    let value = body(&mut writer)?;
    writer.flush().map_err(Error::io(path))?;
    let file = writer.into_inner().map_err(|e| Error::io(path)(e.into_error()))?;
    if let Some(metadata) = existing {
        // a refusal leaves the permissions of a new file, which is no reason to lose the result
        let _ = file.set_permissions(metadata.permissions());
    }
    file.sync_all().map_err(Error::io(path))?;
    drop(file);
    fs::rename(&temporary.path, &target).map_err(Error::io(path))?;
    temporary.kept = true;
    sync_folder(&target);
    Ok(value)
}

/// Brings the new name of a file to the disk.
#[cfg(unix)]
fn sync_folder(file: &Path) {
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    // the file is complete under its name; a file system that cannot synchronise folders is no reason to report a
    // failure
    let _ = File::open(folder).and_then(|folder| folder.sync_all());
}

/// Other systems cannot open folders as files; they record names by themselves.
#[cfg(not(unix))]
fn sync_folder(_file: &Path) {}

/// The folder at `path`, made if it is missing but its parent is there.
///
/// # Errors
/// [`Error::Io`] when the parent folder does not exist or a file is in the way.
pub fn make_folder(path: &Path) -> Result<()> {
    if path.is_dir() {
        return Ok(());
    }
    if path.exists() {
        let reason = "is a file, but a folder is needed; give another name";
        return Err(Error::io(path)(std::io::Error::new(ErrorKind::NotADirectory, reason)));
    }
    check_parent(path)?;
    fs::create_dir(path).map_err(Error::io(path))
}

fn check_parent(path: &Path) -> Result<()> {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() && !parent.is_dir() => {
            let reason = format!("the folder {} does not exist; create it first", parent.display());
            Err(Error::io(path)(std::io::Error::new(ErrorKind::NotFound, reason)))
        }
        _ => Ok(()),
    }
}

/// Removes the temporary files that runs left when they were killed while they wrote `target`: those of processes of
/// this computer that are no more, and old ones of others. `own` is the one that was just made.
fn remove_leftovers(target: &Path, name: &OsStr, own: &Path) {
    let Ok(now) = fs::metadata(own) else { return };
    let folder = target.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let start = format!(".{}.", name.to_string_lossy());
    for entry in folder.read_dir().into_iter().flatten().flatten() {
        let found = entry.file_name();
        let Some(maker) = found.to_str().and_then(|found| found.strip_prefix(&start)?.strip_suffix(".part")) else {
            continue;
        };
        let (true, Ok(metadata)) = (is_maker(maker), entry.metadata()) else { continue };
        // the same clock gave both times
        let age =
            now.modified().ok().zip(metadata.modified().ok()).and_then(|(now, then)| now.duration_since(then).ok());
        if is_abandoned(maker, &now, &metadata) || age.is_some_and(|age| age > OLD) {
            // one that cannot be removed is in nobody's way
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Returns true if the end of a name is that of an unfinished file: its host, the number of its process and its own.
fn is_maker(text: &str) -> bool {
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    let is_host = |text: &str| text == "0" || (text.len() > 12 && text.bytes().all(|byte| byte.is_ascii_hexdigit()));
    match text.split('-').collect::<Vec<_>>()[..] {
        [host, process, own] => is_host(host) && is_number(process) && is_number(own) && own.len() < 4,
        _ => false,
    }
}

/// Returns true if the process that made an unfinished file is known to have ended; `maker` is its host, its number and
/// that of the file.
fn is_abandoned(maker: &str, own: &fs::Metadata, other: &fs::Metadata) -> bool {
    let mut parts = maker.split('-');
    let (Some(host), Some(process), Some(_), None) = (parts.next(), parts.next(), parts.next(), parts.next()) else {
        return false;
    };
    // processes of other users may be hidden
    !HOST.is_empty() && host == *HOST && is_of_one_user(own, other) && !Path::new("/proc").join(process).exists()
}

#[cfg(unix)]
fn is_of_one_user(own: &fs::Metadata, other: &fs::Metadata) -> bool {
    use std::os::unix::fs::MetadataExt;
    own.uid() == other.uid()
}

#[cfg(not(unix))]
fn is_of_one_user(_own: &fs::Metadata, _other: &fs::Metadata) -> bool {
    true
}

fn create_beside(target: &Path) -> Result<(File, Temporary)> {
    check_parent(target)?;
    let Some(name) = target.file_name() else {
        return Err(Error::io(target)(std::io::Error::new(ErrorKind::InvalidInput, "names no file")));
    };
    for attempt in 0..MAX_NAME_ATTEMPTS {
        let mut hidden = std::ffi::OsString::from(".");
        hidden.push(name);
        // host and process are part of the name, so that two programs never write to one file
        let host = if HOST.is_empty() { "0" } else { HOST.as_str() };
        hidden.push(format!(".{host}-{}-{attempt}.part", std::process::id()));
        let path = target.with_file_name(hidden);
        let mut unfinished = unfinished();
        if unfinished.is_abandoned {
            return Err(Error::Cancelled);
        }
        match OpenOptions::new().read(true).write(true).create_new(true).open(&path) {
            Ok(file) => {
                unfinished.paths.push(path.clone());
                drop(unfinished);
                remove_leftovers(target, name, &path);
                return Ok((file, Temporary { path, kept: false }));
            }
            Err(e) if e.kind() == ErrorKind::AlreadyExists => {}
            Err(e) => return Err(Error::io(target)(e)),
        }
    }
    let reason = "too many unfinished outputs (.part files) in this folder; remove them";
    Err(Error::io(target)(std::io::Error::new(ErrorKind::AlreadyExists, reason)))
}
