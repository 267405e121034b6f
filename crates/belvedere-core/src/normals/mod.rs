//! Surface normals: estimated from neighbourhoods, then oriented outward.

pub mod estimate;
pub(crate) mod moments;
pub mod orient;
pub mod oriented;
mod reference_mesh;
mod scatter;
mod surroundings;

pub use orient::{OrientReport, Orientation, orient};
pub use oriented::OrientedCloud;
pub use scatter::Scatter;

/// Unit normals of the points of a cloud, not yet oriented.
#[derive(Clone, Debug, Default)]
pub struct Normals {
    /// Unit vectors, (N, 3); (0, 0, 0) where the neighbourhood determines no plane.
    pub vectors: Vec<[f32; 3]>,
    /// Quality of each, (N), 0 to 1: one minus the ratio of the two smallest eigenvalues of the neighbourhood.
    pub quality: Vec<f32>,
}
