//! Sources and outputs: files, bytes, readers, and files on web servers.

pub(crate) mod announced;
pub mod atomic;
pub(crate) mod output;
#[cfg(feature = "http")]
pub(crate) mod remote;
pub(crate) mod secrets;
pub(crate) mod source;
