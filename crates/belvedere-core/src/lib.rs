//! The algorithms of Belvedere, from points to answers.
//!
//! Users add the crate `belvedere`, which holds everything here under the same names.

pub mod blocking;
pub mod clean;
pub mod depth;
#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
mod f32x8;
pub mod ground;
mod instructions;
pub mod medial;
pub mod medium;
pub mod model;
pub mod neighbors;
pub mod normals;
pub mod planes;
pub mod pulses;
pub mod query;
pub mod ray_index;
pub mod strips;
pub mod summary;
pub mod triangle_tree;
