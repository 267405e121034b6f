//! Catalogues of tiles (`.vpc`, virtual point clouds): which files belong to a cloud, and where each of them lies.
//!
//! # Source
//! Virtual point cloud specification 1.0.0 (PDAL wrench, QGIS): a STAC collection of items with the asset `data` and
//! the property `proj:bbox`.

use std::path::{Path, PathBuf};

use serde::Deserialize;
use serde_json::Value;

use crate::files::announced::{Announced, BoundsAre};
use crate::files::source::{Source, folder_and_query, place_beside, web_address};
use crate::points::read_options::FileBox;
use belvedere_data::{Error, Result};

/// Largest catalogue that is read, bytes: a million tiles, and far below the memory of any machine.
const MAX_BYTES: u64 = 1 << 30;

/// Part of a catalogue that is read and held.
#[derive(Deserialize)]
struct Catalogue {
    features: Option<Vec<Item>>,
}

#[derive(Deserialize)]
struct Item {
    assets: Option<Assets>,
    properties: Option<Properties>,
}

#[derive(Deserialize)]
struct Assets {
    data: Option<Asset>,
}

#[derive(Deserialize)]
struct Asset {
    href: Option<Value>,
}

#[derive(Default, Deserialize)]
struct Properties {
    #[serde(rename = "pc:count")]
    count: Option<Value>,
    #[serde(rename = "proj:bbox")]
    bounds: Option<Value>,
}

/// A tile of a catalogue.
#[derive(Clone, Debug, PartialEq)]
pub struct CatalogueTile {
    /// Its file, from the folder that the catalogue lies in; addresses of the web stay unchanged.
    pub path: PathBuf,
    /// Lowest and highest corner in the coordinates of its file, unlimited in height where the catalogue gives none;
    /// `None` where it gives no bounds.
    pub bounds: Option<([f64; 3], [f64; 3])>,
    /// Number of its points, where the catalogue has it (`pc:count`).
    pub point_count: Option<u64>,
}

/// The files of the catalogue `source` that may have points in `wanted`, in its order; all of them without a box.
pub(crate) fn files_within(catalogue: Source<'_>, wanted: Option<&FileBox>) -> Result<Vec<Source<'static>>> {
    let name = catalogue.name().file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let meets = |tile: &CatalogueTile| match (wanted, tile.bounds) {
        (Some(wanted), Some((low, high))) => wanted.meets(low, high),
        _ => true,
    };
    let source = |tile: CatalogueTile| {
        let mut source = Source::path(tile.path);
        source.announced = Some(Announced {
            by: name.clone(),
            points: tile.point_count,
            bounds: tile.bounds,
            bounds_are: BoundsAre::OfPoints,
        });
        source
    };
    Ok(read_catalogue(catalogue)?.into_iter().filter(meets).map(source).collect())
}

/// The tiles of a catalogue, in its order.
///
/// # Errors
/// [`Error::Io`]; [`Error::Malformed`] for other files.
pub fn read_catalogue<'a>(source: impl Into<Source<'a>>) -> Result<Vec<CatalogueTile>> {
    let input = source.into().open()?;
    let (name, size) = (input.name, input.size);
    let damaged = |what: String| Error::malformed(&name, what);
    if size > MAX_BYTES {
        return Err(damaged(format!("has {size} bytes, more than a catalogue of tiles; give the folder of the tiles")));
    }
    let catalogue: Catalogue = serde_json::from_reader(input.reader)
        .map_err(|e| damaged(format!("is no catalogue of tiles (virtual point cloud): {e}")))?;
    let tiles =
        catalogue.features.ok_or_else(|| damaged("is no catalogue of tiles: it has no `features`".to_owned()))?;
    let folder = folder_and_query(&name);
    let mut found = Vec::with_capacity(tiles.len());
    for (number, Item { assets, properties }) in tiles.into_iter().enumerate() {
        let path = assets.and_then(|assets| assets.data?.href);
        let path = path.as_ref().and_then(Value::as_str);
        let path = path.ok_or_else(|| damaged(format!("has no file for tile {} (assets, data, href)", number + 1)))?;
        if path.contains("://") && web_address(Path::new(path)).is_none() {
            return Err(damaged(format!(
                "names {path}, which is neither a file nor an address of the web; download it first"
            )));
        }
        let Properties { count, bounds } = properties.unwrap_or_default();
        let point_count = count.as_ref().and_then(Value::as_u64);
        let bounds = bounds.as_ref().and_then(bounds_of);
        found.push(CatalogueTile { path: place_beside(&folder, path), bounds, point_count });
    }
    Ok(found)
}

fn bounds_of(numbers: &Value) -> Option<([f64; 3], [f64; 3])> {
    let numbers = numbers.as_array()?;
    let numbers: Vec<f64> = numbers.iter().map(Value::as_f64).collect::<Option<_>>()?;
    match numbers[..] {
        [a, b, c, d] => Some(([a, b, f64::NEG_INFINITY], [c, d, f64::INFINITY])),
        [a, b, c, d, e, f] => Some(([a, b, c], [d, e, f])),
        _ => None,
    }
}
