//! Queries: which targets can be seen.

pub mod points;
pub mod visibility;

pub use points::{Answer, AnswerCounts, query_points, random_targets};
pub use visibility::{Sight, Viewer, Visibility};
