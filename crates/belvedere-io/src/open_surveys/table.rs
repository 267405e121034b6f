//! The table of open surveys, and the area that is wanted of them.

use serde::{Deserialize, Serialize, Serializer};
use std::path::Path;

use crate::files::secrets::hidden;
use crate::files::source::Source;
use belvedere_data::parameter::Parameter;
use belvedere_data::{Error, Result};

/// Surveys that this program knows, the newest of a country first.
const KNOWN: &str = include_str!("surveys.json");

/// Metres of a degree of latitude, of the sphere with the volume of the earth.
const METRES_PER_DEGREE: f64 = 111_195.0;
/// Maximum latitude at which degrees of longitude are still wide enough for windows of a few kilometres, degrees.
const MAX_LATITUDE: f64 = 85.0;
/// Radii of areas, metres: a courtyard, and what the index of a national survey answers at once.
const RADII: [f64; 2] = [1.0, 5000.0];
/// Maximum radius of an area that becomes one cloud, metres: 80 million points of a dense survey, 3 GB.
pub const MAX_CLOUD_RADIUS: f64 = 1000.0;

/// A survey whose points are published.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OpenSurvey {
    /// Name to choose it by, such as "ahn6".
    pub name: String,
    /// Name, country and years, for people.
    pub title: String,
    /// Usual density of points.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub points_per_m2: Option<f64>,
    /// Licence of its points.
    pub licence: String,
    /// Names that the licence wants to be mentioned.
    pub attribution: String,
    /// Page of the provider.
    pub page: String,
    /// Reference system of its files, where all have one: of those that name none, and of the grid of tiles.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub crs: Option<String>,
    /// Boxes around its area: west, south, east and north in degrees. Places in a box may lie outside the survey.
    pub areas_deg: Vec<[f64; 4]>,
    /// Way to find its tiles.
    pub index: TileIndex,
}

/// Way to find the tiles of a survey.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase", deny_unknown_fields)]
pub enum TileIndex {
    /// Squares of a grid in the system of the survey, each a file whose address has the south-west corner.
    Squares {
        /// Side of a square.
        side_m: f64,
        #[serde(serialize_with = "without_key")]
        /// Address with `{x_m}` and `{y_m}`, metres with six digits, or `{x_km}` and `{y_km}`.
        address: String,
    },
    /// A list of tiles as JSON, from a service: GeoJSON of WFS, items of STAC, products of The National Map.
    List {
        #[serde(serialize_with = "without_key")]
        /// Address with the corners of the area: `{west}`, `{south}`, `{east}`, `{north}` in degrees, or `{x_min}`,
        /// `{y_min}`, `{x_max}`, `{y_max}` in the system of the survey.
        address: String,
    },
    /// None: people choose tiles on the page of the provider.
    Page,
}

/// Writes an address without user, password and key.
pub(super) fn without_key<S: Serializer>(address: &str, serializer: S) -> std::result::Result<S::Ok, S::Error> {
    serializer.collect_str(&hidden(Path::new(address)).display())
}

/// A square area around a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurveyArea {
    latitude_deg: f64,
    longitude_deg: f64,
    radius_m: f64,
}

impl SurveyArea {
    /// The area from `radius_m` west to `radius_m` east, and likewise south and north, of a place in degrees.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for places that are none on earth or beyond 85 degrees, and for radii beyond the
    /// range of 1 m to 5 km.
    pub fn around([latitude_deg, longitude_deg]: [f64; 2], radius_m: f64) -> Result<Self> {
        if !(latitude_deg.abs() <= MAX_LATITUDE && longitude_deg.abs() <= 180.0) {
            return Err(Error::invalid(
                Parameter::SurveyPlace,
                format!("{latitude_deg}, {longitude_deg}"),
                "latitude (-85 to 85) and longitude (-180 to 180) in degrees, such as 52.01,4.36",
            ));
        }
        if !(RADII[0]..=RADII[1]).contains(&radius_m) {
            return Err(Error::invalid(Parameter::SurveyRadius, format!("{radius_m} m"), "1 to 5000 m"));
        }
        Ok(Self { latitude_deg, longitude_deg, radius_m })
    }

    /// Latitude and longitude of the middle, degrees.
    #[must_use]
    pub fn middle_deg(&self) -> [f64; 2] {
        [self.latitude_deg, self.longitude_deg]
    }

    /// Half of the side, metres.
    #[must_use]
    pub fn radius_m(&self) -> f64 {
        self.radius_m
    }

    /// Checks that the points of the area fit into one cloud.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a radius above 1 km.
    pub fn check_cloud(&self) -> Result<()> {
        if self.radius_m <= MAX_CLOUD_RADIUS {
            return Ok(());
        }
        let expected = "at most 1000 m for a single cloud; larger areas come as whole tiles";
        Err(Error::invalid(Parameter::SurveyRadius, format!("{} m", self.radius_m), expected))
    }

    /// West, south, east and north, degrees.
    pub(super) fn box_deg(&self) -> [f64; 4] {
        let high = self.radius_m / METRES_PER_DEGREE;
        let wide = high / self.latitude_deg.to_radians().cos();
        let [x, y] = [self.longitude_deg, self.latitude_deg];
        [x - wide, y - high, x + wide, y + high]
    }
}

impl OpenSurvey {
    /// Returns true if the middle of `area` may lie in the survey.
    #[must_use]
    pub fn may_cover(&self, area: &SurveyArea) -> bool {
        let [latitude, longitude] = area.middle_deg();
        self.areas_deg.iter().any(|&[west, south, east, north]| {
            (west..=east).contains(&longitude) && (south..=north).contains(&latitude)
        })
    }
}

/// The surveys that this program knows, the newest of a country first.
///
/// # Errors
/// [`Error::Malformed`] for a damaged program.
pub fn known_surveys() -> Result<Vec<OpenSurvey>> {
    read_surveys(Source::bytes("surveys.json", KNOWN.as_bytes()))
}

/// Reads a table of surveys: a list in JSON with the fields of [`OpenSurvey`].
///
/// # Errors
/// [`Error::Io`], and [`Error::Malformed`] for other content.
pub fn read_surveys<'a>(source: impl Into<Source<'a>>) -> Result<Vec<OpenSurvey>> {
    let (name, bytes) = source.into().read_text()?;
    let damaged = |what: String| Error::malformed(&name, what);
    let surveys: Vec<OpenSurvey> =
        serde_json::from_slice(&bytes).map_err(|e| damaged(format!("is no table of surveys: {e}")))?;
    for survey in &surveys {
        survey.check().map_err(|what| damaged(format!("survey {:?} {what}", survey.name)))?;
    }
    Ok(surveys)
}

impl OpenSurvey {
    fn check(&self) -> std::result::Result<(), String> {
        let has_all = |address: &str, names: [&str; 4]| names.iter().all(|name| address.contains(name));
        match &self.index {
            TileIndex::Squares { side_m, address } => {
                let has_corner = address.contains("{x_m}") && address.contains("{y_m}")
                    || address.contains("{x_km}") && address.contains("{y_km}");
                if !(has_corner && self.crs.is_some()) {
                    return Err("needs `crs`, and an address with {x_m} and {y_m} or {x_km} and {y_km}".to_owned());
                }
                if address.contains("{x_km}") && (side_m / 1000.0).fract() != 0.0 {
                    return Err("names squares by kilometres, but their side is not of whole kilometres".to_owned());
                }
                if !(10.0..=100_000.0).contains(side_m) {
                    return Err("has squares with a side beyond 10 m to 100 km".to_owned());
                }
            }
            TileIndex::List { address } => {
                let is_in_crs = has_all(address, ["{x_min}", "{y_min}", "{x_max}", "{y_max}"]) && self.crs.is_some();
                if !(is_in_crs || has_all(address, ["{west}", "{south}", "{east}", "{north}"])) {
                    return Err("needs an address with {west}, {south}, {east} and {north}, or `crs` and an address \
                                with {x_min}, {y_min}, {x_max} and {y_max}"
                        .to_owned());
                }
            }
            TileIndex::Page => {}
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_whole_and_places_lie_in_their_surveys() {
        let surveys = known_surveys().unwrap();
        let names = |place| {
            let area = SurveyArea::around(place, 100.0).unwrap();
            let names = surveys.iter().filter(|survey| survey.may_cover(&area)).map(|survey| &survey.name[..]);
            names.collect::<Vec<_>>()
        };
        assert_eq!(names([52.0116, 4.3571]), ["ahn6", "ahn5"]);
        assert_eq!(names([43.3, 0.37]), ["lidar-hd", "pnoa"]);
        assert_eq!(names([21.3, -157.86]), ["3dep"]);
        assert_eq!(names([-33.86, 151.2]), [""; 0]);
        let mut all: Vec<_> = surveys.iter().map(|survey| &survey.name).collect();
        all.sort();
        all.dedup();
        assert_eq!(all.len(), surveys.len());
        assert!(surveys.iter().all(|survey| survey.page.starts_with("https://")));
    }

    #[test]
    fn degrees_of_an_area_are_as_wide_as_its_metres() {
        let distance = |a: [f64; 2], b: [f64; 2]| {
            belvedere_data::crs::evidence::distance_on_earth(a.map(f64::to_radians), b.map(f64::to_radians))
        };
        let [west, south, east, north] = SurveyArea::around([60.0, 10.0], 1000.0).unwrap().box_deg();
        let side = distance([60.0, west], [60.0, east]);
        assert!((side - 2000.0).abs() < 5.0, "{side}");
        let side = distance([south, 10.0], [north, 10.0]);
        assert!((side - 2000.0).abs() < 5.0, "{side}");
    }

    #[test]
    fn tables_that_cannot_be_used_and_places_elsewhere_are_refused() {
        let row = |change: &str| {
            format!(
                r#"[{{"name": "a", "title": "A", "licence": "", "attribution": "", "page": "", "areas_deg": [], {change}}}]"#
            )
        };
        for (change, words) in [
            (r#""index": {"squares": {"side_m": 1000, "address": "https://a/{x_m}_{y_m}.laz"}}"#, "`crs`"),
            (
                r#""crs": "EPSG:2154", "index": {"squares": {"side_m": 1000, "address": "https://a/{x_m}.laz"}}"#,
                "{y_m}",
            ),
            (r#""crs": "EPSG:2154", "index": {"squares": {"side_m": 0, "address": "https://a/{x_m}_{y_m}"}}"#, "10 m"),
            (
                r#""crs": "EPSG:2154", "index": {"squares": {"side_m": 500, "address": "https://a/{x_km}_{y_km}"}}"#,
                "whole",
            ),
            (r#""index": {"list": {"address": "https://a/{west}"}}"#, "{south}"),
            (r#""index": "page", "color": 1"#, "color"),
        ] {
            let error = read_surveys(Source::bytes("own.json", &row(change))).unwrap_err().to_string();
            assert!(error.starts_with("own.json: ") && error.contains(words), "{error}");
        }
        for (place, radius, words) in [
            ([4.36, 452.0], 100.0, "longitude"),
            ([88.0, 4.0], 100.0, "-85"),
            ([f64::NAN, 4.0], 100.0, "latitude"),
            ([52.0, 4.0], 0.0, "5000"),
            ([52.0, 4.0], f64::NAN, "5000"),
        ] {
            let error = SurveyArea::around(place, radius).unwrap_err().to_string();
            assert!(error.contains(words), "{error}");
        }
    }
}
