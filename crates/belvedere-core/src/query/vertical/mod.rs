//! Skylines, vertical lines and lowest visible heights: the half plane of an azimuth cuts a ball in a disc.

mod clear_height;
pub mod skyline;
mod vertical_line;
mod vertical_plane;

pub use vertical_line::{HeightSpans, VerticalLine, VerticalSight};
