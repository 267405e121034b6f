//! Reading and writing files. The extension decides the format.

pub mod atomic;
mod ball_formats;
pub mod balls;
mod canvas;
mod colors;
mod columns;
mod crs_text;
mod depth_picture;
mod font;
pub mod geotiff;
mod las_guard;
pub mod masbcpp;
pub mod picture;
pub mod png;
pub mod write_cloud;
mod write_las;
pub mod write_npy;
mod write_ply;
mod write_table;
