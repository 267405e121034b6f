//! Queries: which targets can be seen.

mod beams;
pub mod certified;
mod clear_height;
pub mod earth;
mod fingerprint;
mod free_range;
pub mod medial_scene;
pub mod mesh;
pub mod points;
pub mod proof;
mod seen_space;
pub mod segments;
pub mod skyline;
pub mod surface;
pub mod target_tree;
pub mod visibility;
pub mod visibility_matrix;

pub use crate::blocking::{Ball, BlockRule, Profile};
pub use certified::{CertifiedMap, CertifiedReport, Scope, answer_views};
pub use earth::{Curvature, EarthParams};
pub use fingerprint::scene_fingerprint;
pub use medial_scene::MedialScene;
pub use mesh::{BackFaces, MeshTargetParams, SeenArea, facing, seen_faces, seen_in_all, seen_objects};
pub use points::{Answer, AnswerCounts, UnprovenAs, query_points, random_targets};
pub use proof::{Beside, Proof, ProofParams};
pub use segments::{Block, Crossing, Enclosure, LineOfSight, merged_crossings, random_pairs};
pub use skyline::SkylinePoint;
pub use surface::{Piece, Sides, SurfacePieces};
pub use target_tree::TargetTree;
pub use visibility::{Sight, Viewer, Visibility};
pub use visibility_matrix::{VisibilityMatrix, visibility_matrix};
