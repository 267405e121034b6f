//! Pictures of results: maps, legends, charts, films.
//!
//! Users add the crate `belvedere`, which holds everything here as `belvedere::figures`.

mod animation;
mod canvas;
mod curves_picture;
mod day_chart;
mod depth_picture;
mod font;
mod horizon_picture;
mod map_picture;
mod picture;
mod picture_row;
mod png;
mod profile_picture;
mod round_step;
mod wireline_picture;

pub use animation::write_apng;
pub use belvedere_io::{class_color, in_shadow, ramp, ramp_colors};
pub use canvas::{Canvas, Colors};
pub use curves_picture::{Curves, curves_picture};
pub use day_chart::{DayPiece, day_chart};
pub use depth_picture::{camera_picture, depth_picture, panorama_picture};
pub use horizon_picture::horizon_picture;
pub use map_picture::{MapLegend, MapMark, MapPicture, map_image, map_picture};
pub use picture::Picture;
pub use picture_row::side_by_side;
pub use png::{png_bytes, write_png};
pub use profile_picture::{DistanceProfile, profile_picture};
pub use wireline_picture::{DrawnTower, WirelinePlane, wireline_picture};
