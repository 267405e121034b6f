//! Queries: which targets can be seen.
//!
//! There are four kinds of queries of a [`MedialScene`]:
//!
//! - a pair of points: [`MedialScene::line_of_sight`] (its first obstacle, its unproven length), with
//!   [`MedialScene::crossings`], [`MedialScene::min_visible_height`], [`MedialScene::seen_along`],
//!   [`MedialScene::seen_from_surface`] and [`MedialScene::far_sight_answer`] (one that leaves the cloud) beside it;
//! - a vertical line: [`MedialScene::vertical_sight`], the visible part of a tower;
//! - many targets of one viewer: [`MedialScene::visible_from`], or [`MedialScene::visible_in_views`] for pictures;
//! - many directions at many targets: [`MedialScene::visibility_matrix`].
//!
//! Other models of a scene answer the last two by the trait [`Visibility`]. [`target_tree`] and
//! [`certified`] hold the parts of these, for repeated queries of the same targets or the same view. A [`Backend`]
//! settles lines of sight in bulk.

pub mod backend;
mod ball_tree;
mod beams;
mod blocker;
pub mod certified;
pub mod coverage;
pub mod cpu;
pub mod earth;
mod far_terrain;
mod lazy;
mod lines;
mod many_targets;
pub mod medial_scene;
pub mod points;
pub mod proof;
pub mod surface;
pub mod target_tree;
mod triangles;
mod vertical;
mod view_line;
pub mod visibility;
pub mod visibility_matrix;

pub use crate::blocking::{Ball, BlockRule, Profile};
pub use backend::{Backend, DEPTH_MAP_TOLERANCE, Drawable, LineAnswer, PreparedBackend, Settled, Viewers};
pub use ball_tree::BallTree;
pub use blocker::Blocker;
pub use certified::{CertifiedReport, Scope};
pub use coverage::Coverage;
pub use cpu::Cpu;
pub use earth::{Curvature, EarthParams};
pub use far_terrain::{FarTerrain, VisibleTerrain};
pub use lines::{BlockedLines, Certainty, Evidence, Obstacle, ParallelLines, ScoreKey, SurfaceBefore, segments};
pub use medial_scene::MedialScene;
pub use mesh::{BackFaces, MeshTargetParams, SeenArea, facing, seen_faces, seen_in_all, seen_objects};
pub use points::{
    Answer, AnswerCounts, MAX_RANDOM_PAIRS, MAX_RANDOM_TARGETS, UnprovenAs, query_points, random_targets,
};
pub use proof::{Beside, FreedSpace, Proof, ProofParams, nearness_of};
pub use segments::{Crossing, Enclosure, LineOfSight, Obstruction, merged_crossings, random_pairs};
pub use skyline::SkylinePoint;
pub use surface::{Sides, SurfacePiece, SurfacePieces, mesh};
pub use triangles::BlockingTriangles;
pub use vertical::{HeightSpans, VerticalLine, VerticalSight, skyline};
pub use visibility::{Sight, Viewer, Visibility};
pub use visibility_matrix::{FreeLines, VisibilityMatrix};
