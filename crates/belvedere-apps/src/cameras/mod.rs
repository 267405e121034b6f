//! Placement of cameras, watch posts and masts, so that few of them cover much.
//!
//! | step | function |
//! |---|---|
//! | cameras that could be put up | [`MountingParams::poses_at`], [`ground_places`], [`roof_places`] |
//! | what is to be covered | [`crate::targets`], [`keep_within`], [`counted_weights`] |
//! | which of them covers what | [`coverage`], and [`leave_out_private`] for those that must not be put up |
//! | which to choose | [`place_cameras`] |
//!
//! A target is covered by a camera if it is in its picture, near enough for the wanted pixels per metre, and nothing
//! hides it. Selections are made greedily and improved by exchanges; the linear relaxation bounds the coverage of any
//! selection, and a search closes the gap where the problem is small enough.

mod bound;
mod camera;
mod candidates;
mod coverage;
mod greedy;
mod placement;
mod problem;
mod search;
mod table;

pub use camera::{Camera, Lens, Level, PictureDirection};
pub use candidates::{
    CAMERA_HEIGHT, CAMERA_TARGET_HEIGHT, CameraPose, Motion, Mount, MountingParams, ROOF_CAMERA_HEIGHT, WeightedArea,
    counted_weights, ground_places, keep_within, roof_places,
};
pub use coverage::{
    CoverageParams, CoverageReport, FREE_FRESNEL_SHARE, FresnelZone, coverage, leave_out_private, sees_private,
};
pub use placement::{Goal, Placement, PlacementParams, place_cameras};
pub use table::CoverageTable;
