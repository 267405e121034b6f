//! Files in and out of Belvedere.
//!
//! Readers take a [`Source`]: a path, an address of the web, bytes in memory, or any `Read + Seek` with a name. Writers
//! take an [`Output`]: a path or any `Write + Seek` with a name. The extension of the name selects the format. A file
//! appears under its name only when it is complete ([`atomic`]).
//!
//! # Features
//! Formats that need crates of their own are features, all on by default: `las` (LAS, LAZ, COPC), `e57`, `ply`
//! (reading), `npy` (NPY, NPZ ball files, masbcpp's folders), `tiff` (GeoTIFF), `gpkg` (GeoPackage), `shp` (reading
//! Shapefile). `http` reads files on web servers.
//! `crs` (from `belvedere-data`) is the database of reference systems. Text, PCD, PTX, OBJ, GeoJSON, CityJSON, tables,
//! weather files and trajectories are always there. A format that was not built in gives
//! [`belvedere_data::Error::MissingFeature`].

#[cfg(feature = "las")]
mod announced;
mod antimeridian;
mod assemble;
pub mod atomic;
mod ball_formats;
mod balls;
mod cityjson;
mod cloud_batches;
pub mod colors;
mod columns;
mod coordinates;
#[cfg(feature = "las")]
mod copc;
#[cfg(feature = "e57")]
mod e57;
#[cfg(feature = "e57")]
mod e57_counts;
#[cfg(feature = "las")]
mod ept;
mod file_part;
mod footprints;
#[cfg(feature = "tiff")]
mod geotiff;
#[cfg(feature = "tiff")]
mod geotiff_cog;
#[cfg(feature = "tiff")]
mod geotiff_read;
#[cfg(feature = "las")]
mod gps_epoch;
mod graphml;
mod horizon_profile;
#[cfg(feature = "las")]
mod las;
#[cfg(feature = "las")]
mod las_columns;
#[cfg(feature = "las")]
mod las_copy;
#[cfg(feature = "las")]
mod las_extra;
#[cfg(feature = "las")]
mod las_header;
#[cfg(feature = "las")]
mod las_records;
#[cfg(feature = "las")]
mod las_results;
#[cfg(feature = "las")]
mod las_system;
#[cfg(feature = "las")]
mod laz;
mod map_features;
#[cfg(feature = "npy")]
mod masbcpp;
mod mesh;
#[cfg(feature = "ply")]
mod mesh_ply;
#[cfg(feature = "npy")]
mod npy;
#[cfg(feature = "npy")]
mod npy_header;
#[cfg(feature = "npy")]
mod npz_arrays;
mod obj;
mod observers;
#[cfg(feature = "las")]
mod octree;
#[cfg(all(feature = "http", feature = "las"))]
pub mod open_surveys;
mod outline;
mod output;
mod pcd;
#[cfg(feature = "ply")]
mod ply;
mod polygons;
mod ptx;
mod read_cloud;
mod read_options;
mod read_report;
mod reference_beside;
#[cfg(feature = "http")]
mod remote;
mod rows;
mod scan_pose;
mod secrets;
mod simple_faces;
mod sky;
mod source;
mod stations;
mod table;
#[cfg(feature = "tiff")]
mod terrain;
#[cfg(feature = "tiff")]
mod terrain_in_degrees;
mod text_rows;
mod towers;
mod trajectory;
mod vpc;
mod weather;
mod write_cloud;
mod write_faces;
#[cfg(feature = "las")]
mod write_las;
#[cfg(feature = "npy")]
mod write_masbcpp;
mod write_mesh;
#[cfg(feature = "npy")]
mod write_npy;
mod write_ply;
mod write_table;
mod write_trajectory;
mod xyz;

#[cfg(feature = "npy")]
pub use ball_formats::{read_kept_model, read_kept_notes, read_kept_rasters, write_kept_model, write_kept_rasters};
pub use balls::{is_ball_file, read_balls, write_balls};
pub use cityjson::{LevelOfDetail, read_cityjson};
pub use cloud_batches::{CloudBatch, CloudBatches, read_batches};
pub use colors::{class_color, in_shadow, ramp, ramp_colors};
pub use columns::{ExtraColumn, ExtraValues, WriteReport};
pub use footprints::read_footprints;
#[cfg(feature = "tiff")]
pub use geotiff::{
    BandLabel, BandValues, Bands, Georeference, MetadataTag, write_bands as write_tif_bands,
    write_f32 as write_tif_f32, write_u8 as write_tif_u8, write_u16 as write_tif_u16, write_u32 as write_tif_u32,
};
#[cfg(feature = "tiff")]
pub use geotiff_cog::write_cog;
#[cfg(feature = "tiff")]
pub use geotiff_read::{
    NamedBand, PlacedRaster, ReadBands, read_bands as read_tif_bands, read_f32 as read_tif_f32,
    read_placed as read_tif, read_u8 as read_tif_u8, read_u16 as read_tif_u16,
};
pub use graphml::write_graphml;
pub use horizon_profile::read_horizon;
#[cfg(feature = "las")]
pub use las::{LasHead, read_las_head};
#[cfg(feature = "las")]
pub use las_results::{PointResults, has_point_results, read_point_results};
pub use map_features::{
    FEATURE_EXTENSIONS, FeatureCoordinates, FeatureShape, MapFeature, PathLine, PolygonArea, Spot, holds_polygons,
    read_features, write_areas, write_places,
};
pub use mesh::{is_mesh, read_mesh, read_mesh_in};
pub use observers::{ObserverRow, ObserverRows, RowsAre, property, read_observers};
pub use outline::{GridPolygon, outlines};
pub use output::{Output, WriteSeek};
pub use polygons::MeshReport;
pub use read_cloud::{CLOUD_EXTENSIONS, cloud_files, cloud_sources, read_cloud};
pub use read_options::{DistantFiles, Insistence, ReadOptions, RowNumbers, UpAxis, Within};
pub use read_report::{FileReport, LeftOut, ReadReport};
pub use secrets::{hidden, hidden_text};
pub use source::{OpenSource, ReadSeek, Source, SystemBeside, web_address};
pub use stations::read_stations;
pub use table::{Table, read_table, row_properties, with_columns_read, write_table, write_text_rows};
#[cfg(feature = "tiff")]
pub use terrain::read_terrain;
pub use text_rows::TextRows;
pub use towers::{TowerRow, read_towers};
pub use trajectory::{TrajectoryReport, read_trajectory};
pub use vpc::{CatalogueTile, read_catalogue};
pub use weather::read_weather;
pub use write_cloud::write_cloud;
pub use write_faces::write_mesh;
#[cfg(feature = "npy")]
pub use write_masbcpp::{MasbcppFolder, write_masbcpp};
pub use write_mesh::write_mesh_values;
#[cfg(feature = "npy")]
pub use write_npy::{write_npy_f32, write_npy_f32_2d, write_npy_u8, write_npy_u32_2d, write_npy_u32_bands};
pub use write_trajectory::{VehicleHeading, write_found_trajectory, write_trajectory};
pub use xyz::read_text_rows;
