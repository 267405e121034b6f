//! Results that several commands write.

pub(crate) mod fading;
pub(crate) mod formats;
pub(crate) mod heights;
pub(crate) mod result_columns;
