//! Depth maps: how far one can see along each pixel of a view before a medial ball blocks the line of sight.

mod ball_bound;
pub mod ball_depth;
pub mod bounds;
mod central;
pub mod depth_map;
mod outline;
pub mod panorama;
mod parallel;
mod tiles;

pub use crate::blocking::{Profile, surface_bias};
pub use ball_depth::BallDepth;
pub use bounds::{BoundsParams, DepthBounds, depth_bounds};
pub use depth_map::{DepthMap, depth_map};
pub(crate) use panorama::panorama_of_maps;
pub use panorama::{Panorama, panorama};
pub use tiles::{ItemBuffer, NO_BALL};
