//! Lines of sight between two ends, and what lies on them and beside them.

mod confidence;
mod far_sights;
mod free_range;
mod obstacles_near;
mod parallel_lines;
pub mod segments;

pub use confidence::{Certainty, Evidence, ScoreKey};
pub use free_range::SurfaceBefore;
pub use obstacles_near::Obstacle;
pub use parallel_lines::{BlockedLines, ParallelLines};
