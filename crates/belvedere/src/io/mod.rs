//! Files in and out.

mod assemble;
mod cityjson;
mod e57;
mod las;
mod las_columns;
mod las_extra;
mod las_header;
mod laz;
mod masbcpp;
mod mesh;
mod mesh_ply;
mod npy;
mod obj;
mod part;
mod pcd;
mod ply;
mod polygons;
mod read_cloud;
mod rows;
mod trajectory;
mod xyz;

pub use cityjson::{LevelOfDetail, read_cityjson};
pub use mesh::read_mesh;
pub use polygons::MeshReport;
pub use read_cloud::{CLOUD_EXTENSIONS, FileReport, LeftOut, ReadOptions, ReadReport, read_cloud};
pub use trajectory::{TrajectoryReport, read_trajectory};
