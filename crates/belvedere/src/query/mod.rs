//! Queries: which targets can be seen.

pub mod points;

pub use points::{Answer, AnswerCounts, query_points, random_targets};
