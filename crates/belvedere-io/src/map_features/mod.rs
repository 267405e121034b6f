//! Points, lines and polygons on the map, with their properties: GeoJSON, GeoPackage and Shapefile.

mod antimeridian;
mod features;
#[cfg(feature = "gpkg")]
mod geopackage;
pub(crate) mod outline;
mod read;
#[cfg(feature = "shp")]
mod shapefile;
#[cfg(feature = "gpkg")]
mod wkb;
mod write;

pub use features::{FeatureShape, MapFeature};
pub use read::{FEATURE_EXTENSIONS, holds_polygons, read_features};
pub use write::{FeatureCoordinates, PathLine, PolygonArea, Spot, write_areas, write_places};
