//! Queries: which targets can be seen.

pub mod certified;
pub mod medial_scene;
pub mod points;
pub mod proof;
mod seen_space;
pub mod visibility;

pub use certified::{CertifiedMap, CertifiedReport, Scope, answer_views};
pub use medial_scene::{MedialScene, SceneParams};
pub use points::{Answer, AnswerCounts, UnprovenAs, query_points, random_targets};
pub use proof::{Beside, Proof, ProofParams};
pub use visibility::{Sight, Viewer, Visibility};
