//! Results that several commands write.

pub(crate) mod balls;
pub(crate) mod fading;
pub(crate) mod formats;
pub(crate) mod heights;
pub(crate) mod sheet;
pub(crate) mod targets;
pub(crate) mod text;
