//! placeholder until orientation is merged
use crate::crs::Crs;
/// x
#[derive(Clone, Debug, Default)]
pub struct OrientedCloud {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    crs: Crs,
}
impl OrientedCloud {
    /// x
    pub fn positions(&self) -> &[[f32; 3]] {
        &self.positions
    }
    /// x
    pub fn normals(&self) -> &[[f32; 3]] {
        &self.normals
    }
    /// x
    pub fn new(positions: Vec<[f32; 3]>, normals: Vec<[f32; 3]>) -> Self {
        Self { positions, normals, crs: Crs::default() }
    }
}
