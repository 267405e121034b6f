//! Queries: which targets can be seen.

mod beams;
pub mod medial_scene;
pub mod points;
pub mod proof;
mod seen_space;
pub mod target_tree;
pub mod visibility;

pub use medial_scene::{MedialScene, SceneParams};
pub use points::{Answer, AnswerCounts, UnprovenAs, query_points, random_targets};
pub use proof::{Beside, Proof, ProofParams};
pub use target_tree::TargetTree;
pub use visibility::{Sight, Viewer, Visibility};
