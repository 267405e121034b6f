//! Checks whether an elevation raster can be the terrain around a cloud.

use belvedere_data::report::{percent, rounded};
use belvedere_data::{Bounds, ElevationGrid, Error, Frame, Parameter, Result};
use serde::Serialize;

/// Maximum height of terrain above or below all points of a cloud, metres. It is more than any error of a raster of 90
/// m cells, and less than 30 m, by which heights above an ellipsoid and above the sea differ in most countries. It is
/// also less than the error of heights in feet taken for metres in all but the lowest terrain.
const MAX_OFFSET: f32 = 25.0;

/// Maximum distance between the sea and the ellipsoid, metres.
const MAX_GEOID: f64 = 107.0;
const METRES_PER_FOOT: f64 = 0.3048;

/// Contents of an elevation raster.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct TerrainReport {
    /// Number of cells.
    pub cells: usize,
    /// Cells without a height, which block nothing.
    pub without_height_percent: f64,
    /// The longer side of a cell.
    pub cell_m: f64,
    /// Lowest and highest height, metres.
    pub lowest_m: f64,
    /// See [`TerrainReport::lowest_m`].
    pub highest_m: f64,
    /// The least distance that the raster reaches beyond the cloud: mountains farther away are not known.
    pub reach_m: f64,
}

impl TerrainReport {
    /// Summarises `terrain` around a cloud with the bounds `cloud`, both local metres of `frame`.
    #[must_use]
    pub fn of(terrain: &ElevationGrid, cloud: Bounds, frame: &Frame) -> Self {
        let ([west, south], [east, north]) = terrain.on_map();
        let (low, high) = cloud.on_map();
        let reach = [low[0] - west, low[1] - south, east - high[0], north - high[1]];
        let [lowest, highest] = terrain.height_range(terrain.on_map()).unwrap_or_default();
        let height = |local: f32| rounded(frame.origin[2] + f64::from(local), 1);
        let cells = terrain.heights().values().len();
        Self {
            cells,
            without_height_percent: percent(terrain.unknown_count(), cells),
            cell_m: rounded(terrain.cell()[0].max(terrain.cell()[1]), 3),
            lowest_m: height(lowest),
            highest_m: height(highest),
            reach_m: rounded(reach.into_iter().fold(f64::INFINITY, f64::min), 0),
        }
    }
}

/// Refuses terrain, which `name` names, that does not reach the cloud between `cloud`, local metres, or whose heights
/// are not those of the cloud.
///
/// # Errors
/// [`Error::InvalidParameter`] with advice.
pub fn check_terrain(terrain: &ElevationGrid, name: &str, cloud: Bounds, frame: &Frame) -> Result<()> {
    let ([west, south], [east, north]) = terrain.on_map();
    let (low, high) = cloud.on_map();
    let invalid = |value: String, expected| Err(Error::invalid(Parameter::Terrain, value, expected));
    if west > low[0] || south > low[1] || east < high[0] || north < high[1] {
        let file = |[x, y]: [f64; 2]| {
            let [x, y, _] = frame.file_from_local([x, y, 0.0]);
            format!("{x:.1}, {y:.1}")
        };
        let value = format!(
            "{name}, which lies between {} and {} while the cloud lies between {} and {}",
            file([west, south]),
            file([east, north]),
            file(low),
            file(high)
        );
        return invalid(value, "in the coordinates of the cloud, with all of the cloud in it");
    }
    let Some([lowest, highest]) = terrain.height_range((low, high)) else { return Ok(()) };
    if lowest > cloud.high[2] + MAX_OFFSET || highest < cloud.low[2] - MAX_OFFSET {
        let z = |local: f32| frame.origin[2] + f64::from(local);
        let [terrain, cloud] = [[lowest, highest], [cloud.low[2], cloud.high[2]]].map(|heights| heights.map(z));
        let text = |[low, high]: [f64; 2]| format!("{low:.1} to {high:.1} m");
        let value = format!("{name}, with heights of {} where the cloud has {}", text(terrain), text(cloud));
        return invalid(value, expected_heights(terrain, cloud));
    }
    Ok(())
}

/// Describes the heights of `terrain` that would fit those of a `cloud`, metres; the numbers show the cause of the
/// difference.
fn expected_heights(terrain: [f64; 2], cloud: [f64; 2]) -> &'static str {
    let room = f64::from(MAX_OFFSET);
    let [low, high] = terrain.map(|height| height * METRES_PER_FOOT);
    // heights in feet are larger numbers
    let are_like_feet = terrain[0] > cloud[1] && low <= cloud[1] + room && high >= cloud[0] - room;
    let gap = (terrain[0] - cloud[1]).max(cloud[0] - terrain[1]);
    match (are_like_feet, gap <= MAX_GEOID) {
        (true, true) => {
            "in metres above the same zero as those of the cloud; they look like feet (gdal_calc.py -A IN.tif --calc=A*0.3048 --outfile=OUT.tif) \
             or like heights above the ellipsoid (gdalwarp -s_srs and -t_srs)"
        }
        (true, false) => "in metres; they look like feet: gdal_calc.py -A IN.tif --calc=A*0.3048 --outfile=OUT.tif",
        (false, true) => {
            "above the same zero as those of the cloud; heights above the ellipsoid and above the sea differ that much: convert one of \
             them with gdalwarp -s_srs and -t_srs"
        }
        (false, false) => "above the same zero as those of the cloud, and in metres",
    }
}
