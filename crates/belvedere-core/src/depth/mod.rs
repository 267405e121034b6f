//! Depth maps: how far one can see along each pixel of a view before a medial ball blocks the line of sight.

pub mod bounds;
mod central;
pub mod depth_map;
mod outline;
pub mod panorama;
mod parallel;
mod tiles;

pub(crate) use bounds::SHELL_SHARE;
pub use bounds::{BoundsParams, DepthBounds, depth_bounds};
pub use depth_map::{DepthMap, ItemBuffer, NO_BALL, Profile, depth_map, surface_bias};
pub use panorama::{Panorama, panorama};
