//! PLY.

#[cfg(feature = "ply")]
pub(crate) mod read;
pub(crate) mod write_ply;

#[cfg(feature = "ply")]
pub(crate) use read::read;
