//! Reading and writing files.

mod assemble;
mod e57;
mod las;
mod las_columns;
mod las_extra;
mod las_header;
mod laz;
mod masbcpp;
mod npy;
mod part;
mod pcd;
mod ply;
mod ptx;
mod read_cloud;
mod rows;
mod xyz;

pub use read_cloud::{CLOUD_EXTENSIONS, FileReport, LeftOut, ReadOptions, ReadReport, read_cloud};
