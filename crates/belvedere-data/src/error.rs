//! The one error type of the library.

use crate::parameter::Parameter;
use crate::shown::{ShownPath, printable};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// Result of every fallible function of this crate.
pub type Result<T> = std::result::Result<T, Error>;

/// Checks that there are as many values as things that have one.
///
/// # Errors
/// [`Error::LengthMismatch`].
pub fn check_length(what: &'static str, expected: usize, found: usize) -> Result<()> {
    if expected == found { Ok(()) } else { Err(Error::LengthMismatch { what, expected, found }) }
}

/// Error, with the offending value and advice.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The operating system refused to read or write a file.
    #[error("{}: {}", ShownPath(path), refusal(source))]
    Io {
        /// The file.
        path: PathBuf,
        /// The refusal.
        source: std::io::Error,
    },
    /// The content of a file cannot be understood.
    #[error("{}: {}", ShownPath(path), printable(what))]
    Malformed {
        /// The file.
        path: PathBuf,
        /// Damage and advice.
        what: String,
    },
    /// The extension of a file names no format that fits its use.
    #[error("{}: not a known {kind} format; use one of {supported}", ShownPath(path))]
    UnknownFormat {
        /// The file.
        path: PathBuf,
        /// Expected kind of content, such as "point cloud".
        kind: &'static str,
        /// The extensions that would do.
        supported: &'static str,
    },
    /// The format of a file, or a reference system, needs a part of the library that was not built in.
    #[error("{}: this program was built without the cargo feature `{feature}`, which this needs", ShownPath(path))]
    MissingFeature {
        /// The file.
        path: PathBuf,
        /// The feature of the crates `belvedere` and `belvedere-io`.
        feature: &'static str,
    },
    /// Coordinates in degrees, earth-centred coordinates, or two files whose reference systems differ.
    #[error("{}: {}", ShownPath(path), printable(what))]
    UnusableCrs {
        /// The file.
        path: PathBuf,
        /// System that was found, and the conversion to run first.
        what: String,
    },
    /// A file of several whose points all lie far away from those of the others.
    #[error(
        "{}: all of its points lie more than 1000 km from the middle of the other files; is it in another reference system? Convert it, leave it away, or skip such files (--skip-distant, in Python skip_distant=True)",
        ShownPath(path)
    )]
    DistantFile {
        /// The file.
        path: PathBuf,
    },
    /// The system has less memory than some work takes.
    #[error(
        "{work} takes about {} MB of memory, which the system does not give; use a smaller part, such as one tile, or raise the limit (ulimit -v)",
        bytes.div_ceil(1_000_000)
    )]
    TooLittleMemory {
        /// The work, such as "making balls of 30000 points".
        work: String,
        /// Memory needed, bytes.
        bytes: u64,
    },
    /// A graphics processor is missing, or fails.
    #[error("{what}")]
    Device {
        /// Fault and advice.
        what: String,
    },
    /// The caller stopped the work ([`crate::control::Control`]). Nothing was written.
    #[error("cancelled; nothing was written")]
    Cancelled,
    /// There is no point to work on.
    #[error("no points are left: {}", printable(what))]
    NoPoints {
        /// Stage at which they were lost.
        what: String,
    },
    /// No open survey gives points of a place.
    #[error("no survey gives points there: {}", printable(what))]
    NoSurvey {
        /// What each survey lacks, and advice.
        what: String,
    },
    /// There are points, but too few, or none beside one line, for a surface.
    #[error("{count} {} left, {what}: a surface cannot be made of {}; is this the right file?", if *count == 1 { "point is" } else { "points are" }, if *count == 1 { "it" } else { "them" })]
    NoSurface {
        /// Number of points.
        count: usize,
        /// Missing property.
        what: &'static str,
    },
    /// Nobody is left who can look.
    #[error("no {who} is left: {what}")]
    NoObserver {
        /// Missing viewer, such as "observer".
        who: &'static str,
        /// Why each cannot.
        what: String,
    },
    /// A parameter lies outside its range.
    #[error("{parameter} is {}, but must be {expected}", printable(value))]
    InvalidParameter {
        /// The parameter.
        parameter: Parameter,
        /// The value given.
        value: String,
        /// The range.
        expected: &'static str,
    },
    /// Two arrays that belong together differ in length.
    #[error("{what}: {found} values for {expected} points")]
    LengthMismatch {
        /// The array.
        what: &'static str,
        /// Length it should have.
        expected: usize,
        /// Length it has.
        found: usize,
    },
    /// The cloud lacks an attribute that the chosen way of working needs.
    #[error("the cloud has no {attribute}, which {needed_for} needs; {advice}")]
    MissingAttribute {
        /// The attribute.
        attribute: &'static str,
        /// Purpose that needs it.
        needed_for: &'static str,
        /// Alternative.
        advice: &'static str,
    },
    /// A method cannot answer for targets of this kind.
    #[error("{method} cannot answer for these targets: {what}")]
    UnsupportedTargets {
        /// The method.
        method: &'static str,
        /// Targets that it can answer for.
        what: &'static str,
    },
    /// A method knows no viewer of this kind.
    #[error("{method} does not support this viewer: {what}")]
    UnsupportedViewer {
        /// The method.
        method: &'static str,
        /// Supported position of the viewer.
        what: &'static str,
    },
}

/// Describes an error of the operating system, with advice if it is a known one.
fn refusal(source: &std::io::Error) -> String {
    match source.kind() {
        // readers and writers that know more have said it
        _ if source.get_ref().is_some() => printable(&source.to_string()).into_owned(),
        ErrorKind::NotFound => "there is no such file or folder; check the path".to_owned(),
        ErrorKind::PermissionDenied => "access is denied; check the permissions".to_owned(),
        ErrorKind::UnexpectedEof => "ends too early; is the file complete?".to_owned(),
        ErrorKind::StorageFull => "the disk is full; free some space".to_owned(),
        ErrorKind::QuotaExceeded => "your share of the disk is full (quota); free some space".to_owned(),
        ErrorKind::FileTooLarge => {
            "it would be larger than the system lets a file be; raise the limit (ulimit -f), or write to another disk"
                .to_owned()
        }
        ErrorKind::OutOfMemory => "the system gives no more memory; use a smaller part".to_owned(),
        _ => source.to_string(),
    }
}

impl Error {
    /// [`Error::InvalidParameter`]: a value of a parameter that cannot be used, and what would do.
    #[must_use]
    pub fn invalid(parameter: Parameter, value: impl ToString, expected: &'static str) -> Self {
        Self::InvalidParameter { parameter, value: value.to_string(), expected }
    }

    /// Turns an error of the operating system into an [`Error::Io`] about `path`, for use in `map_err`.
    pub fn io(path: &Path) -> impl FnOnce(std::io::Error) -> Self + '_ {
        move |source| Self::Io { path: path.to_owned(), source }
    }

    /// An [`Error::MissingFeature`] about `path`.
    #[must_use]
    pub fn missing_feature(path: &Path, feature: &'static str) -> Self {
        Self::MissingFeature { path: path.to_owned(), feature }
    }

    /// An [`Error::Malformed`] about `path`.
    pub fn malformed(path: &Path, what: impl Into<String>) -> Self {
        Self::Malformed { path: path.to_owned(), what: what.into() }
    }
}
