//! Points of an area, and whole tiles, from the servers of a survey.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use super::index::SurveyTile;
use super::table::SurveyArea;
use super::tiles::{FoundSurvey, best_covering, middle_in};
use crate::files::atomic;
use crate::files::secrets::hidden;
use crate::files::source::Source;
use crate::las::read_las_head;
use crate::points::read_options::{ReadOptions, Within};
use crate::points::read_report::ReadReport;
use crate::read_cloud::read_cloud;
use belvedere_data::control::Control;
use belvedere_data::crs::{Crs, CrsKind};
use belvedere_data::{Error, PointCloud, Result};

/// Bytes between two looks at whether to go on.
const BLOCK_BYTES: usize = 1 << 20;

/// Reads the points of `area`: of COPC tiles only the parts that meet it are transferred, of others all.
///
/// # Errors
/// [`Error::InvalidParameter`] for a radius above 1 km, [`Error::NoSurvey`] for surveys without tiles,
/// [`Error::Malformed`] for archives, and those of [`read_cloud`].
pub fn read_area(found: &FoundSurvey, area: &SurveyArea, control: &Control<'_>) -> Result<(PointCloud, ReadReport)> {
    area.check_cloud()?;
    let found = best_covering(std::slice::from_ref(found))?;
    if let Some(archive) = found.tiles.iter().find(|tile| tile.is_archive()) {
        let what = "is an archive: take whole tiles into a folder, and unpack them";
        return Err(Error::malformed(&hidden(Path::new(&archive.address)), what));
    }
    // the tiles of a survey of a country have systems of their own in each zone
    let of_file = found.tiles.first().map(|tile| read_las_head(Path::new(&tile.address))).transpose()?;
    let of_file = of_file.map(|head| head.crs).unwrap_or_default();
    let names_none = of_file.kind == CrsKind::Unknown;
    let given = if names_none { found.survey.crs.as_deref() } else { None };
    let crs = given.map_or(Ok(of_file), Crs::parse)?;
    let middle = middle_in(&crs.geographic_projection()?, area)?;
    let [per_x, per_y, _] = crs.metres_per_unit_xyz();
    let corner = |side: f64| [(middle[0] + side) / per_x, (middle[1] + side) / per_y];
    let [[west, south], [east, north]] = [corner(-area.radius_m()), corner(area.radius_m())];
    let within = Within::File { low: [west, south, f64::NEG_INFINITY], high: [east, north, f64::INFINITY] };
    let mut options = ReadOptions::new().with_points_within(within);
    options.crs = given.map(str::to_owned);
    let addresses = found.tiles.iter().map(|tile| Source::path(&tile.address));
    control.stage("reading tiles", 0, || read_cloud(addresses, &options, control))
}

/// Writes the whole tiles of a survey into `folder`, and returns their paths. A file of the name and size of a tile is
/// left as it is.
///
/// # Errors
/// [`Error::Io`], [`Error::Malformed`] for an address without a name, and [`Error::Cancelled`]; then the tiles before
/// are there.
pub fn download_tiles(found: &FoundSurvey, folder: &Path, control: &Control<'_>) -> Result<Vec<PathBuf>> {
    let mut paths: Vec<PathBuf> = Vec::new();
    for tile in &found.tiles {
        let name = tile.file_name();
        if name.is_empty() {
            return Err(Error::malformed(&hidden(Path::new(&tile.address)), "has no name of a file"));
        }
        // tiles of several folders may have the same name
        let mut path = folder.join(&name);
        for number in 2.. {
            if !paths.contains(&path) {
                break;
            }
            path = folder.join(format!("{number}_{name}"));
        }
        download(tile, &path, control)?;
        paths.push(path);
    }
    Ok(paths)
}

fn download(tile: &SurveyTile, path: &Path, control: &Control<'_>) -> Result<()> {
    let address = hidden(Path::new(&tile.address));
    let mut remote = Source::path(&tile.address).into_versioned_reader()?;
    if fs::metadata(path).is_ok_and(|file| file.is_file() && file.len() == remote.size) {
        return Ok(());
    }
    control.stage("downloading", usize::try_from(remote.size).unwrap_or_default(), || {
        atomic::write(path, |file| {
            let mut block = vec![0; BLOCK_BYTES];
            loop {
                control.check()?;
                let count = remote.reader.read(&mut block).map_err(Error::io(&address))?;
                if count == 0 {
                    return Ok(());
                }
                file.write_all(block.get(..count).unwrap_or_default()).map_err(Error::io(path))?;
                control.advance(count);
            }
        })
    })
}

/// Writes the origin of points or tiles: survey, licence, attribution, addresses and area, as JSON.
///
/// # Errors
/// [`Error::Io`].
pub fn write_origin(path: &Path, found: &FoundSurvey, area: &SurveyArea) -> Result<()> {
    let [latitude, longitude] = area.middle_deg();
    let FoundSurvey { survey, tiles, .. } = found;
    let addresses: Vec<_> = tiles.iter().map(|tile| hidden(Path::new(&tile.address))).collect();
    let origin = serde_json::json!({
        "survey": survey.title,
        "licence": survey.licence,
        "attribution": survey.attribution,
        "page": survey.page,
        "latitude_deg": latitude,
        "longitude_deg": longitude,
        "radius_m": area.radius_m(),
        "tiles": addresses,
    });
    atomic::write(path, |file| {
        serde_json::to_writer_pretty(&mut *file, &origin).map_err(|error| Error::io(path)(error.into()))?;
        writeln!(file).map_err(Error::io(path))
    })
}
