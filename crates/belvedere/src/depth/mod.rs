//! Depth maps: how far one can see along each pixel of a view before a medial ball blocks the line of sight.

pub mod depth_map;
mod splat_balls;
mod tiles;

pub use depth_map::{DepthMap, ItemBuffer, NO_BALL, Profile, depth_map};
