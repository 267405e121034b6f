//! Places where somebody stands, from coordinates or degrees.

use super::scene::Scene;
use belvedere_data::crs::Crs;
use belvedere_data::{Bounds, Error, Frame, Parameter, Result};

/// Maximum distance of a place from the box of the points, metres: that of targets of a scene.
const MARGIN: f64 = 1.0;

/// Maximum distance of an end of lines of sight from that box, metres: mountains on the horizon.
const END_MARGIN: f64 = 200e3;
/// Advice for degrees in the wrong order.
const SWAPPED: &str = "latitude before longitude: these are swapped";

/// A place where somebody stands, or that is looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Standing {
    /// Local metres; the height is NaN where it follows from the ground.
    pub place: [f64; 3],
    /// Height of the eye above the ground, metres; `None` for that of the question.
    pub height: Option<f64>,
}

/// Extent of lines of sight.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reach {
    /// Within the cloud.
    Cloud,
    /// The terrain beyond it, where there is any.
    FarTerrain,
}

/// Coordinates of the file of a place that is given in them, or as latitude and longitude in degrees. `bounds` are the
/// south-west and north-east corner of the points, in the coordinates of the file.
///
/// # Errors
/// [`Error::InvalidParameter`] for a place beside the points, and those of [`Crs::geographic_projection`] for degrees.
pub fn position_on_map(given: [f64; 2], crs: &Crs, bounds: [[f64; 2]; 2]) -> Result<[f64; 2]> {
    let is_inside = |place: &[f64; 2]| is_within(*place, bounds, MARGIN / crs.metres_per_unit);
    if is_inside(&given) {
        return Ok(given);
    }
    let [latitude, longitude] = given;
    let mut way_out = "on the points of the cloud";
    if are_degrees(given) {
        crs.geographic_projection()?;
        if let Some(place) = projected(given, crs).filter(is_inside) {
            return Ok(place);
        }
        way_out = match projected([longitude, latitude], crs).filter(is_inside) {
            Some(_) => SWAPPED,
            None => {
                "on the points of the cloud, as latitude and longitude in degrees, or in the coordinates of the file"
            }
        };
    }
    let [[west, south], [east, north]] = bounds;
    Err(Error::invalid(
        Parameter::Position,
        format!("{}, {} (the points reach from {west:.0}, {south:.0} to {east:.0}, {north:.0})", given[0], given[1]),
        way_out,
    ))
}

/// Coordinates of the file of an end of lines of sight that is given in them, or as latitude and longitude in degrees.
/// `bounds` as in [`position_on_map`]; ends may lie far beside the points.
///
/// # Errors
/// [`Error::InvalidParameter`] for longitude before latitude.
pub fn end_on_map(given: [f64; 2], crs: &Crs, bounds: [[f64; 2]; 2]) -> Result<[f64; 2]> {
    let is_near = |place: &[f64; 2]| is_within(*place, bounds, END_MARGIN / crs.metres_per_unit);
    if is_near(&given) || !are_degrees(given) {
        return Ok(given);
    }
    if let Some(place) = projected(given, crs).filter(is_near) {
        return Ok(place);
    }
    let [latitude, longitude] = given;
    if projected([longitude, latitude], crs).is_some_and(|place| is_within(place, bounds, MARGIN / crs.metres_per_unit))
    {
        return Err(Error::invalid(Parameter::Position, format!("{latitude}, {longitude}"), SWAPPED));
    }
    Ok(given)
}

/// Coordinates of the file of a latitude and longitude in degrees; `None` without a known projection.
fn projected([latitude, longitude]: [f64; 2], crs: &Crs) -> Option<[f64; 2]> {
    // a projection keeps the step between datums of its first place: each place has one of its own
    let projection = crs.geographic_projection().ok()?;
    let place = projection.project(latitude.to_radians(), longitude.to_radians()).ok()?;
    Some(place.map(|v| v / crs.metres_per_unit))
}

fn is_within(place: [f64; 2], [low, high]: [[f64; 2]; 2], margin: f64) -> bool {
    (0..2).all(|i| (low[i] - margin..=high[i] + margin).contains(&place[i]))
}

/// True for numbers that can be latitude and longitude in degrees.
fn are_degrees([latitude, longitude]: [f64; 2]) -> bool {
    latitude.abs() <= 90.0 && longitude.abs() <= 180.0
}

/// Returns places on the map, each with its height where that is known, as single places of a scene that stand `height`
/// metres above what is below. Lines of sight of this extent may begin beyond the cloud.
///
/// # Errors
/// Those of [`position_on_map`], and of places that lie beyond the terrain too.
pub fn standing_on_map(
    places: impl IntoIterator<Item = ([f64; 2], Option<f64>)>,
    height: Option<f64>,
    reach: Reach,
    scene: &Scene,
) -> Result<Vec<Standing>> {
    let frame = scene.frame();
    let bounds = bounds_in_file(frame, &scene.model().bounds());
    let one = |(place, given): ([f64; 2], Option<f64>)| {
        let on_cloud = position_on_map(place, &frame.crs, bounds);
        let [x, y] = if reach == Reach::Cloud { on_cloud? } else { on_cloud.or_else(|_| on_terrain(place, scene))? };
        Ok(Standing { place: frame.local_from_file([x, y, given.unwrap_or(f64::NAN)]), height })
    };
    places.into_iter().map(one).collect()
}

/// Coordinates of the file of a place on the terrain beyond the cloud, given as for [`position_on_map`].
fn on_terrain(given: [f64; 2], scene: &Scene) -> Result<[f64; 2]> {
    let frame = scene.frame();
    let terrain = scene.model().far_terrain().grid();
    let is_known = |[x, y]: &[f64; 2]| {
        let [x, y, _] = frame.local_from_file([*x, *y, 0.0]);
        terrain.is_some_and(|terrain| terrain.height_at([x, y]).is_some())
    };
    let [latitude, longitude] = given;
    let in_degrees = |degrees| if are_degrees(given) { projected(degrees, &frame.crs).filter(is_known) } else { None };
    if let Some(place) = Some(given).filter(is_known).or_else(|| in_degrees(given)) {
        return Ok(place);
    }
    let expected = match in_degrees([longitude, latitude]) {
        Some(_) => SWAPPED,
        None => "on the points of the cloud, or on the terrain beyond it",
    };
    Err(Error::invalid(Parameter::Position, format!("{latitude}, {longitude}"), expected))
}

impl Standing {
    /// Creates an end of lines of sight at a place on the map, of coordinates of the file or of degrees
    /// ([`end_on_map`]), with its height where that is known. `bounds` are those of the points, local metres.
    ///
    /// # Errors
    /// Those of [`end_on_map`].
    pub fn on_map(place: [f64; 2], height: Option<f64>, frame: &Frame, bounds: &Bounds) -> Result<Self> {
        let [x, y] = end_on_map(place, &frame.crs, bounds_in_file(frame, bounds))?;
        Ok(Self { place: frame.local_from_file([x, y, height.unwrap_or(f64::NAN)]), height: None })
    }
}

/// South-west and north-east corner of points, in the coordinates of the file.
fn bounds_in_file(frame: &Frame, bounds: &Bounds) -> [[f64; 2]; 2] {
    let (low, high) = bounds.on_map();
    [low, high].map(|[x, y]| {
        let [x, y, _] = frame.file_from_local([x, y, 0.0]);
        [x, y]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_of_lines_may_lie_beside_the_points_in_degrees_too() {
        let crs = Crs::parse("EPSG:28992").unwrap();
        let bounds = [[154_000.0, 462_000.0], [156_000.0, 464_000.0]];
        // the Dom tower of Utrecht, 20 km to the west
        let [x, y] = end_on_map([52.0907, 5.1214], &crs, bounds).unwrap();
        assert!((x - 136_800.0).abs() < 200.0 && (y - 455_900.0).abs() < 200.0, "{x} {y}");
        for given in [[136_800.0, 455_900.0], [-33.86, 151.2], [1.0, 2.0]] {
            assert_eq!(end_on_map(given, &crs, bounds).unwrap(), given);
        }
        assert!(end_on_map([5.387_2, 52.155_2], &crs, bounds).unwrap_err().to_string().contains("swapped"));
        // without a known system they are coordinates
        assert_eq!(end_on_map([52.0907, 5.1214], &Crs::default(), bounds).unwrap(), [52.0907, 5.1214]);
    }

    #[test]
    fn degrees_and_coordinates_name_the_same_place() {
        // the tower of Amersfoort, origin of the Dutch grid, in ETRS89 as its surveyors publish it; a Helmert
        // transformation is right to half a metre there
        let crs = Crs::parse("EPSG:28992").unwrap();
        let bounds = [[154_000.0, 462_000.0], [156_000.0, 464_000.0]];
        let by_degrees = position_on_map([52.155_174_40, 5.387_206_21], &crs, bounds).unwrap();
        assert!((by_degrees[0] - 155_000.0).abs() < 0.5 && (by_degrees[1] - 463_000.0).abs() < 0.5, "{by_degrees:?}");
        assert_eq!(position_on_map([155_100.0, 463_200.0], &crs, bounds).unwrap(), [155_100.0, 463_200.0]);
        for (wrong, is_swapped) in
            [([136_000.0, 455_000.0], false), ([5.387_2, 52.155_2], true), ([f64::NAN, 0.0], false)]
        {
            let error = position_on_map(wrong, &crs, bounds).unwrap_err().to_string();
            assert!(error.contains("154000, 462000"), "{error}");
            assert_eq!(error.contains("swapped"), is_swapped, "{error}");
        }
        // without a reference system, small coordinates are those of the file
        let unknown = Crs::default();
        assert_eq!(position_on_map([3.0, 4.0], &unknown, [[0.0; 2], [9.0; 2]]).unwrap(), [3.0, 4.0]);
        assert!(position_on_map([52.0, 4.0], &unknown, [[0.0; 2], [9.0; 2]]).is_err());
    }
}
