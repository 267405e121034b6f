//! Elevation rasters in degrees, brought into the plane of a scene.

use crate::geotiff::Georeference;
use belvedere_data::cast::to_index;
use belvedere_data::raster::Raster;
use belvedere_data::vector::to_f32;
use belvedere_data::{ElevationGrid, Error, Frame, Result};
use std::path::Path;

/// Systems of longitude and latitude that differ from WGS 84 by a metre or two at most: WGS 84, ETRS89, NAD83.
const LIKE_WGS_84: [u32; 4] = [4326, 4979, 4258, 4269];
/// Cells between places whose longitude and latitude are computed: between them both are linear to a centimetre.
const STEP: usize = 16;
/// Places on each side of the raster whose projections give its extent.
const PLACES: usize = 32;
/// Maximum extent of a raster, degrees: a zone of UTM, some 400 km. Formulas of projections err far from their area,
/// without a word.
const MAX_DEGREES: f64 = 6.0;
/// Maximum number of cells of the result, as for rasters that need no projection.
const MAX_CELLS: f64 = 67e6;

/// Returns true if a raster in this system can be projected.
pub(crate) fn is_like_wgs_84(code: Option<u32>) -> bool {
    code.is_some_and(|code| LIKE_WGS_84.contains(&code))
}

/// Projects the terrain of `raster`, heights in metres at longitudes and latitudes in degrees, into the plane of
/// `frame`. Cells are as large as those of the raster in its middle, with bilinear heights.
///
/// # Errors
/// [`Error::Malformed`] for a raster that does not fit into the plane, or needs too many cells; those of
/// [`Crs::geographic_projection`](belvedere_data::crs::Crs::geographic_projection).
pub(crate) fn projected(
    raster: &Raster<f32>,
    place: &Georeference,
    frame: &Frame,
    name: &Path,
) -> Result<ElevationGrid> {
    let projection = frame.crs.geographic_projection()?;
    let [east, south] = [place.column_step[0], -place.row_step[1]];
    // longitude and latitude, degrees, of columns and rows of the middles of cells
    let degrees = |[u, v]: [f64; 2]| [place.upper_left[0] + (u + 0.5) * east, place.upper_left[1] - (v + 0.5) * south];
    let last = [raster.width() as f64 - 1.0, raster.height() as f64 - 1.0];
    if last[0] * east > MAX_DEGREES || last[1] * south > MAX_DEGREES {
        return Err(too_large(name));
    }
    let on_plane = |node: [f64; 2]| {
        let [longitude, latitude] = degrees(node).map(f64::to_radians);
        let [x, y] = projection.project(latitude, longitude).map_err(|_| too_large(name))?;
        Ok([x - frame.origin[0], y - frame.origin[1]])
    };
    let [low, high] = corners_on_plane(last, on_plane)?;
    let middle = last.map(|last| last / 2.0);
    let [at, beside, below] = [middle, [middle[0] + 1.0, middle[1]], [middle[0], middle[1] + 1.0]].map(on_plane);
    let (at, beside, below) = (at?, beside?, below?);
    let cell = [beside, below].map(|other| (other[0] - at[0]).hypot(other[1] - at[1]));
    let counts = [0, 1].map(|i| ((high[i] - low[i]) / cell[i]).floor() + 1.0);
    if !(counts[0] * counts[1] <= MAX_CELLS) {
        return Err(too_large(name));
    }
    let [width, height] = counts.map(to_index);
    // columns and rows of the raster at every few nodes of the result, and one beyond the last
    let coarse = [width, height].map(|count| count.div_ceil(STEP) + 1);
    let mut known = Vec::with_capacity(coarse[0] * coarse[1]);
    for i in 0..coarse[0] * coarse[1] {
        let node = [i % coarse[0] * STEP, i / coarse[0] * STEP];
        let x = low[0] + node[0] as f64 * cell[0] + frame.origin[0];
        let y = high[1] - node[1] as f64 * cell[1] + frame.origin[1];
        let [latitude, longitude] = projection.unproject([x, y]).map_err(|_| too_large(name))?;
        let [longitude, latitude] = [longitude, latitude].map(f64::to_degrees);
        known.push([(longitude - place.upper_left[0]) / east - 0.5, (place.upper_left[1] - latitude) / south - 0.5]);
    }
    let value = |i: usize| {
        let (column, row) = (i % width, i / width);
        let first = row / STEP * coarse[0] + column / STEP;
        let (s, t) = ((column % STEP) as f64 / STEP as f64, (row % STEP) as f64 / STEP as f64);
        let corners = [first, first + 1, first + coarse[0], first + coarse[0] + 1].map(|at| known[at]);
        let at = [0, 1].map(|axis| {
            let [a, b, c, d] = corners.map(|corner| corner[axis]);
            (1.0 - t) * ((1.0 - s) * a + s * b) + t * ((1.0 - s) * c + s * d)
        });
        to_f32(bilinear(raster, at) - frame.origin[2])
    };
    let heights = Raster::from_values(width, height, (0..width * height).map(value).collect())?;
    ElevationGrid::new(heights, [low[0], high[1]], cell).map_err(|error| Error::malformed(name, error.to_string()))
}

/// The lowest and highest coordinates on the plane that the border of a raster reaches, whose `last` column and row
/// these are.
fn corners_on_plane(last: [f64; 2], on_plane: impl Fn([f64; 2]) -> Result<[f64; 2]>) -> Result<[[f64; 2]; 2]> {
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for i in 0..=PLACES {
        let share = i as f64 / PLACES as f64;
        let [u, v] = last.map(|last| last * share);
        for node in [[u, 0.0], [u, last[1]], [0.0, v], [last[0], v]] {
            let at = on_plane(node)?;
            low = [low[0].min(at[0]), low[1].min(at[1])];
            high = [high[0].max(at[0]), high[1].max(at[1])];
        }
    }
    Ok([low, high])
}

fn too_large(name: &Path) -> Error {
    let what = "spans more than 6 degrees, or reaches beyond the coordinate system of the scene; cut out the surroundings of the scene, for example: \
                gdalwarp -te WEST SOUTH EAST NORTH IN.tif OUT.tif";
    Error::malformed(name, what)
}

/// The height between four middles of cells; NaN outside, and beside a cell without one.
fn bilinear(raster: &Raster<f32>, [u, v]: [f64; 2]) -> f64 {
    // the outermost middles belong to the raster even after rounding
    const ROUNDING: f64 = 1e-6;
    let last = [raster.width() as f64 - 1.0, raster.height() as f64 - 1.0];
    if !([u, v].iter().zip(last).all(|(at, last)| (-ROUNDING..=last + ROUNDING).contains(at))) {
        return f64::NAN;
    }
    let [s, t] = [u.clamp(0.0, last[0]), v.clamp(0.0, last[1])];
    let [column, row] = [s.min(last[0] - 1.0), t.min(last[1] - 1.0)].map(to_index);
    let (s, t) = (s - column as f64, t - row as f64);
    let at = |c: usize, r: usize| raster.get(column + c, row + r).map_or(f64::NAN, f64::from);
    (1.0 - t) * ((1.0 - s) * at(0, 0) + s * at(1, 0)) + t * ((1.0 - s) * at(0, 1) + s * at(1, 1))
}

#[cfg(all(test, feature = "crs"))]
#[allow(clippy::cast_possible_truncation, reason = "heights are f32")]
mod tests {
    use super::*;
    use belvedere_data::crs::Crs;

    #[test]
    fn heights_stay_at_their_longitude_and_latitude() {
        // some 60 km of the Alps at 3 arc seconds, a plane in degrees, with a hole
        let place = Georeference {
            upper_left: [8.0, 47.0],
            column_step: [1.0 / 1200.0, 0.0],
            row_step: [0.0, -1.0 / 1200.0],
            crs: Crs::from_epsg(4326).unwrap(),
        };
        let height = |longitude: f64, latitude: f64| 900.0 * (longitude - 8.0) + 2000.0 * (47.0 - latitude);
        let node = |i: usize| {
            let (column, row) = ((i % 900) as f64 + 0.5, (i / 900) as f64 + 0.5);
            height(8.0 + column / 1200.0, 47.0 - row / 1200.0) as f32
        };
        let mut values: Vec<f32> = (0..900 * 700).map(node).collect();
        values[350 * 900 + 450] = f32::NAN;
        let raster = Raster::from_values(900, 700, values).unwrap();
        let frame = Frame { origin: [430_000.0, 5_160_000.0, 500.0], crs: Crs::from_epsg(25_832).unwrap() };
        let grid = projected(&raster, &place, &frame, Path::new("dtm.tif")).unwrap();
        // 3 arc seconds are 92.6 m to the south and 63.6 m to the east
        assert!((grid.cell()[1] - 92.6).abs() < 0.2 && (grid.cell()[0] - 63.6).abs() < 0.3, "{:?}", grid.cell());
        let projection = frame.crs.geographic_projection().unwrap();
        let (mut known, mut unknown) = (0, 0);
        for row in (0..grid.heights().height()).step_by(7) {
            for column in (0..grid.heights().width()).step_by(7) {
                let x = grid.north_west()[0] + column as f64 * grid.cell()[0] + frame.origin[0];
                let y = grid.north_west()[1] - row as f64 * grid.cell()[1] + frame.origin[1];
                let [latitude, longitude] = projection.unproject([x, y]).unwrap().map(f64::to_degrees);
                let found = f64::from(grid.heights().get(column, row).unwrap()) + 500.0;
                if found.is_nan() {
                    unknown += 1;
                } else {
                    known += 1;
                    // f32 heights, and longitude and latitude linear over 16 cells
                    assert!((found - height(longitude, latitude)).abs() < 2e-3, "{column} {row} {found}");
                }
            }
        }
        assert!(known > 10_000 && unknown < known / 10, "{known} {unknown}");
        assert!(grid.unknown_count() >= 4);
        let world =
            Georeference { upper_left: [-180.0, 90.0], column_step: [0.4, 0.0], row_step: [0.0, -0.25], ..place };
        let error = projected(&raster, &world, &frame, Path::new("world.tif")).unwrap_err().to_string();
        assert!(error.contains("world.tif") && error.contains("gdalwarp"), "{error}");
    }
}
