//! Files in and out; the extension tells the format. Every output appears only when it is complete.

mod assemble;
pub mod atomic;
mod ball_formats;
mod balls;
mod cityjson;
pub mod colors;
mod columns;
mod e57;
mod geojson;
mod geojson_read;
mod geotiff;
mod las;
mod las_columns;
mod las_extra;
mod las_header;
mod laz;
mod masbcpp;
mod mesh;
mod mesh_ply;
mod npy;
mod npz_arrays;
mod obj;
mod observers;
mod outline;
mod part;
mod pcd;
mod ply;
mod polygons;
mod ptx;
mod read_cloud;
mod read_report;
mod rows;
mod saved_matrix;
mod table;
mod trajectory;
mod weather;
mod write_cloud;
mod write_faces;
mod write_las;
mod write_masbcpp;
mod write_mesh;
mod write_npy;
mod write_ply;
mod write_table;
mod write_trajectory;
mod xyz;

pub use balls::{is_ball_file, read_balls, write_balls};
pub use cityjson::{LevelOfDetail, read_cityjson};
pub use colors::{class_color, in_shadow, ramp_colors};
pub use geojson::{Area, GeojsonCoordinates, write_geojson_areas};
pub use geojson_read::{GeojsonFeature, Shape, read_geojson};
pub use geotiff::{
    Georeference, write_f32 as write_tif_f32, write_u8 as write_tif_u8, write_u16 as write_tif_u16,
    write_u32 as write_tif_u32,
};
pub use mesh::read_mesh;
pub use observers::{ObserverRow, RowsAre, read_observers};
pub use outline::{GridPolygon, outlines};
pub use polygons::MeshReport;
pub use read_cloud::{CLOUD_EXTENSIONS, FileReport, LeftOut, ReadOptions, ReadReport, read_cloud};
pub use saved_matrix::{
    MatrixHead, RowSink, SavedMatrix, read_matrix, read_matrix_head, read_matrix_rows, write_matrix, write_matrix_rows,
};
pub use table::{Cells, Table, read_table, write_table};
pub use trajectory::{TrajectoryReport, read_trajectory};
pub use weather::read_weather;
pub use write_cloud::{ExtraColumn, ExtraValues, WriteReport, write_cloud};
pub use write_faces::write_mesh;
pub use write_masbcpp::{MasbcppFolder, write_masbcpp};
pub use write_mesh::write_mesh_values;
pub use write_npy::{write_npy_f32, write_npy_f32_2d, write_npy_u8, write_npy_u32_2d, write_npy_u32_bands};
pub use write_trajectory::{Heading, write_found_trajectory, write_trajectory};
