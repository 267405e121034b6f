//! Elevation rasters of the terrain around a cloud.

use crate::files::source::Source;
use crate::geotiff::read::read_placed;
use crate::geotiff::terrain_in_degrees::{is_like_wgs_84, projected};
use belvedere_data::crs::{Crs, CrsKind};
use belvedere_data::raster::Raster;
use belvedere_data::vector::to_f32;
use belvedere_data::{ElevationGrid, Error, Frame, Result};
use std::ops::RangeInclusive;
use std::path::Path;

/// Heights of the ground, metres: the shore of the Dead Sea is at -430 m, Mount Everest at 8849 m.
const HEIGHTS: RangeInclusive<f64> = -500.0..=9000.0;

/// Reads the terrain from a GeoTIFF raster in the local coordinates of `frame`: heights of the ground (DTM) in the
/// middles of its cells. The raster must be in the reference system of the frame, or name none, which is then taken as
/// that of the frame. A raster in degrees (WGS 84, ETRS89, NAD83; heights in metres) is projected, with bilinear
/// heights. Its rows must run from north to south.
///
/// # Errors
/// - [`Error::Io`].
/// - [`Error::Malformed`] for a file that is no raster of one band, has no position, is turned, has no heights, or
///   heights that no ground has. Also for results of Belvedere that are no heights.
/// - [`Error::UnusableCrs`] for another system, with a conversion to run first.
pub fn read_terrain<'a>(source: impl Into<Source<'a>>, frame: &Frame) -> Result<ElevationGrid> {
    let source = source.into();
    let name = source.name().to_owned();
    let raster = read_placed(source)?;
    let Some(place) = raster.place else {
        return Err(Error::malformed(
            &name,
            "has no place on the map; give a GeoTIFF, for example of gdal_translate -a_ullr",
        ));
    };
    let ([east, turned], [also_turned, down]) = (place.column_step, place.row_step);
    if !(east > 0.0 && down < 0.0 && turned == 0.0 && also_turned == 0.0) {
        let what = "is turned or upside down; make its rows run from north to south first: gdalwarp IN.tif OUT.tif";
        return Err(Error::malformed(&name, what));
    }
    check_quantity(raster.description.as_deref(), &name)?;
    check_heights(&raster.values, &place.crs, &frame.crs, &name)?;
    let is_in_degrees = place.crs.kind == CrsKind::Geographic && is_like_wgs_84(place.crs.epsg);
    if is_in_degrees && frame.crs.kind == CrsKind::Projected {
        return projected(&raster.values, &place, frame, &name);
    }
    check_system(&place.crs, &frame.crs, &name)?;
    let system = if place.crs.kind == CrsKind::Unknown { &frame.crs } else { &place.crs };
    let [unit, _, height_unit] = system.metres_per_unit_xyz();
    let local = |height: &f32| f64::from(*height) * height_unit - frame.origin[2];
    let heights = raster.values.values().iter().map(|height| to_f32(local(height))).collect();
    let heights = Raster::from_values(raster.values.width(), raster.values.height(), heights)?;
    let cell = [east * unit, -down * unit];
    let [x, y] = place.upper_left;
    let north_west = [x * unit - frame.origin[0] + cell[0] / 2.0, y * unit - frame.origin[1] - cell[1] / 2.0];
    ElevationGrid::new(heights, north_west, cell).map_err(|error| Error::malformed(&name, error.to_string()))
}

/// Refuses a raster of which Belvedere, which wrote it, says that it holds something else than heights.
fn check_quantity(description: Option<&str>, name: &Path) -> Result<()> {
    let is_height = |what: &str| ["height", "elevation"].iter().any(|word| what.to_lowercase().starts_with(word));
    let Some(what) = description.filter(|what| !is_height(what)) else { return Ok(()) };
    let what = format!(
        "is no elevation raster: Belvedere wrote it, and its description says {what:?}; give heights of the ground (DTM). \
         If it holds heights, their description must begin with \"height\" or \"elevation\""
    );
    Err(Error::malformed(name, what))
}

/// Refuses heights that no ground has: mostly numbers of cells without a height that are not declared.
fn check_heights(values: &Raster<f32>, terrain: &Crs, scene: &Crs, name: &Path) -> Result<()> {
    let unit = match terrain.kind {
        CrsKind::Geographic => 1.0,
        CrsKind::Unknown => scene.metres_per_unit_xyz()[2],
        _ => terrain.metres_per_unit_xyz()[2],
    };
    let is_wrong = |height: &f32| !height.is_nan() && !HEIGHTS.contains(&(f64::from(*height) * unit));
    let Some(at) = values.values().iter().position(is_wrong) else { return Ok(()) };
    let (column, row) = (at % values.width() + 1, at / values.width() + 1);
    let height = values.values().get(at).copied().unwrap_or_default();
    let (low, high) = (HEIGHTS.start(), HEIGHTS.end());
    let what = format!(
        "has the height {height:?} in column {column}, row {row} (counted from 1 at the upper left); heights of the ground are {low} to {high} m. \
         If the number means that there is no height, declare it: gdal_translate -a_nodata {height:?} IN.tif OUT.tif"
    );
    Err(Error::malformed(name, what))
}

/// Refuses degrees, and a system that contradicts that of the scene.
fn check_system(terrain: &Crs, scene: &Crs, name: &Path) -> Result<()> {
    let is_plane = matches!(terrain.kind, CrsKind::Unknown | CrsKind::Projected | CrsKind::Local);
    if is_plane && !terrain.contradicts(scene) {
        return Ok(());
    }
    let target = match scene.epsg {
        Some(code) => format!("EPSG:{code}"),
        None => "SYSTEM_OF_THE_SCENE".to_owned(),
    };
    let what = format!(
        "the terrain is in {}, but the scene is in {}; convert it first, for example: gdalwarp -t_srs {target} -r bilinear IN.tif OUT.tif",
        terrain.describe(),
        scene.describe()
    );
    Err(Error::UnusableCrs { path: name.to_owned(), what })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geotiff::{Georeference, write_f32};

    fn terrain(crs: Crs, steps: [[f64; 2]; 2], values: Vec<f32>, frame: &Frame) -> Result<ElevationGrid> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("dtm.tif");
        let place = Georeference { upper_left: [1000.0, 2000.0], column_step: steps[0], row_step: steps[1], crs };
        let raster = Raster::from_values(3, values.len() / 3, values).unwrap();
        write_f32(path.as_path(), &raster, Some(&place), Some(-9999.0), None).unwrap();
        read_terrain(path.as_path(), frame)
    }

    const NORTH_UP: [[f64; 2]; 2] = [[10.0, 0.0], [0.0, -20.0]];

    #[test]
    #[cfg(feature = "crs")]
    fn terrain_in_feet_lies_where_it_should_and_nodata_is_unknown() {
        let feet = Crs::from_epsg(2992).unwrap();
        let frame = Frame { origin: [300.0, 600.0, 50.0], crs: feet.clone() };
        let found = terrain(feet, NORTH_UP, vec![100.0, 200.0, f32::NAN, 400.0, 500.0, 600.0], &frame).unwrap();
        let close = |a: [f64; 2], b: [f64; 2]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9);
        assert!(close(found.cell(), [3.048, 6.096]));
        assert!(close(found.north_west(), [1005.0 * 0.3048 - 300.0, 1990.0 * 0.3048 - 600.0]));
        let heights = found.heights().values();
        assert!((heights[1] - (200.0 * 0.3048 - 50.0)).abs() < 1e-4 && heights[2].is_nan());
    }

    #[test]
    #[cfg(feature = "crs")]
    fn another_system_degrees_and_turned_rasters_are_refused_with_what_to_do() {
        let values = || vec![1.0; 6];
        let rd = Frame { origin: [0.0; 3], crs: Crs::from_epsg(28_992).unwrap() };
        for (code, named) in [(25_832, "EPSG:25832"), (4289, "degrees")] {
            let error = terrain(Crs::from_epsg(code).unwrap(), NORTH_UP, values(), &rd).unwrap_err().to_string();
            for part in ["dtm.tif", named, "gdalwarp -t_srs EPSG:28992"] {
                assert!(error.contains(part), "{error}");
            }
        }
        let degrees = terrain(Crs::from_epsg(4326).unwrap(), NORTH_UP, values(), &Frame::default());
        assert!(degrees.unwrap_err().to_string().contains("degrees"));
        for steps in [[[10.0, 1.0], [1.0, -20.0]], [[10.0, 0.0], [0.0, 20.0]]] {
            let error = terrain(rd.crs.clone(), steps, values(), &rd).unwrap_err().to_string();
            assert!(error.contains("dtm.tif") && error.contains("gdalwarp"), "{error}");
        }
        let error = terrain(rd.crs.clone(), NORTH_UP, vec![f32::NAN; 6], &rd).unwrap_err().to_string();
        assert!(error.contains("dtm.tif") && error.contains("values"), "{error}");
        // a compound system of the scene is that of a raster without heights of its own
        let compound = Frame { origin: [0.0; 3], crs: Crs::from_epsg(7415).unwrap() };
        assert!(terrain(rd.crs.clone(), NORTH_UP, values(), &compound).is_ok());
        assert!(terrain(Crs::default(), NORTH_UP, values(), &rd).is_ok());
    }
}
