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

#[cfg(feature = "npy")]
mod arrays;
mod balls;
mod cloud_batches;
pub mod colors;
#[cfg(feature = "e57")]
mod e57;
mod files;
#[cfg(feature = "tiff")]
mod geotiff;
#[cfg(feature = "las")]
mod las;
mod map_features;
mod mesh;
#[cfg(all(feature = "http", feature = "las"))]
pub mod open_surveys;
mod ply;
mod points;
mod read_cloud;
mod reference_beside;
mod text;
mod vpc;
mod weather;
mod write_cloud;

#[cfg(feature = "npy")]
pub use arrays::masbcpp::{MasbcppFolder, write_masbcpp};
#[cfg(feature = "npy")]
pub use arrays::write_npy::{write_npy_f32, write_npy_f32_2d, write_npy_u8, write_npy_u32_2d, write_npy_u32_bands};
pub use balls::files::{is_ball_file, read_balls, write_balls};
#[cfg(feature = "npy")]
pub use balls::{
    read_kept_cloud, read_kept_ground, read_kept_model, read_kept_notes, read_kept_rasters, write_kept_cloud,
    write_kept_ground, write_kept_model, write_kept_rasters,
};
pub use cloud_batches::{CloudBatch, CloudBatches, read_batches};
pub use colors::{class_color, in_shadow, ramp, ramp_colors};
pub use files::atomic;
pub use files::output::{Output, WriteSeek};
pub use files::secrets::{hidden, hidden_text};
pub use files::source::{OpenSource, ReadSeek, Source, SystemBeside, web_address};
#[cfg(feature = "tiff")]
pub use geotiff::read::{
    NamedBand, PlacedRaster, ReadBands, read_bands as read_tif_bands, read_f32 as read_tif_f32,
    read_placed as read_tif, read_tags as read_tif_tags, read_u8 as read_tif_u8, read_u16 as read_tif_u16,
};
#[cfg(feature = "tiff")]
pub use geotiff::terrain::read_terrain;
#[cfg(feature = "tiff")]
pub use geotiff::write_cog::write_cog;
#[cfg(feature = "tiff")]
pub use geotiff::{
    BandLabel, BandValues, Bands, Georeference, MetadataTag, write_bands as write_tif_bands,
    write_f32 as write_tif_f32, write_u8 as write_tif_u8, write_u16 as write_tif_u16, write_u32 as write_tif_u32,
};
#[cfg(feature = "las")]
pub use las::results::{PointResults, has_point_results, read_point_results};
#[cfg(feature = "las")]
pub use las::{LasHead, read_las_head};
pub use map_features::outline::{GridPolygon, outlines};
pub use map_features::{
    FEATURE_EXTENSIONS, FeatureCoordinates, FeatureShape, MapFeature, PathLine, PolygonArea, Spot, holds_polygons,
    read_features, write_areas, write_places,
};
pub use mesh::cityjson::{LevelOfDetail, read_cityjson};
pub use mesh::footprints::read_footprints;
pub use mesh::polygons::MeshReport;
pub use mesh::write::{write_mesh, write_mesh_values};
pub use mesh::{is_mesh, read_mesh, read_mesh_in};
pub use points::columns::{ExtraColumn, ExtraValues, WriteReport};
pub use points::read_options::{DistantFiles, Insistence, ReadOptions, RowNumbers, UpAxis, Within};
pub use points::read_report::{FileReport, LeftOut, ReadReport};
pub use read_cloud::{CLOUD_EXTENSIONS, cloud_files, cloud_sources, read_cloud};
pub use text::graphml::write_graphml;
pub use text::horizon_profile::read_horizon;
pub use text::observers::{ObserverRow, ObserverRows, RowsAre, property, read_observers};
pub use text::stations::read_stations;
pub use text::table::{Table, read_table, row_properties, with_columns_read, write_table, write_text_rows};
pub use text::text_rows::TextRows;
pub use text::towers::{TowerRow, read_towers};
pub use text::trajectory::{TrajectoryReport, read_trajectory};
pub use text::write_trajectory::{VehicleHeading, write_found_trajectory, write_trajectory};
pub use text::xyz::read_text_rows;
pub use vpc::{CatalogueTile, read_catalogue};
pub use weather::read_weather;
pub use write_cloud::write_cloud;
