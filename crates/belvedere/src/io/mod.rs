//! Reading and writing files. The extension decides the format.

pub mod atomic;
pub mod balls;
mod ball_formats;
mod canvas;
mod colors;
mod columns;
mod crs_text;
mod depth_picture;
mod font;
pub mod geotiff;
pub mod masbcpp;
pub mod picture;
pub mod png;
pub mod write_cloud;
mod write_las;
pub mod write_npy;
mod write_ply;
mod write_table;
