//! Files in and out.

pub mod cityjson;
pub mod mesh;
pub mod mesh_ply;
pub mod obj;
pub mod polygons;
pub mod trajectory;

pub use mesh::read_mesh;
pub use polygons::MeshReport;
pub use trajectory::{TrajectoryReport, read_trajectory};
