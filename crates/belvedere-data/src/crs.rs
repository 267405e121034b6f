//! Coordinate reference systems as far as visibility needs them: which unit, degrees or not, where on the globe.
//!
//! The cargo feature `crs` (on by default) brings the database of systems. Without it a [`Crs`] can be carried, written
//! and read from well-known text; codes alone are kept, but their names, units and projections are not known.

pub mod evidence;
#[cfg(not(feature = "crs"))]
#[path = "crs/no_registry.rs"]
mod registry;
#[cfg(feature = "crs")]
mod registry;
pub mod text;
mod wkt;

use crate::cast::to_u32;
use crate::{Error, Parameter, Result};
use std::path::Path;

/// Metres per US survey foot, 1200/3937 exactly.
pub const US_SURVEY_FOOT: f64 = 1200.0 / 3937.0;
/// Metres per international foot.
pub const INTERNATIONAL_FOOT: f64 = 0.3048;

/// Reference system and unit of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Crs {
    /// Well-known text as the file gave it.
    pub wkt: Option<String>,
    /// EPSG code of the horizontal (or compound) system.
    pub epsg: Option<u32>,
    /// EPSG code of the vertical system, where given apart.
    pub vertical_epsg: Option<u32>,
    /// Metres per horizontal unit of the file.
    pub metres_per_unit: f64,
    /// Metres per vertical unit of the file.
    pub vertical_metres_per_unit: f64,
    /// Kind of the coordinates.
    pub kind: CrsKind,
    /// Evidence in the files against this system, in words; `None` without any.
    pub doubt: Option<String>,
}

/// Kind of the coordinates of a reference system.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CrsKind {
    /// No system is known; taken as a plane in metres.
    #[default]
    Unknown,
    /// Easting and northing in a plane.
    Projected,
    /// Longitude and latitude in degrees.
    Geographic,
    /// Earth-centred X, Y, Z.
    Geocentric,
    /// A site's or machine's own axes.
    Local,
}

impl Default for Crs {
    fn default() -> Self {
        Self {
            wkt: None,
            epsg: None,
            vertical_epsg: None,
            metres_per_unit: 1.0,
            vertical_metres_per_unit: 1.0,
            kind: CrsKind::Unknown,
            doubt: None,
        }
    }
}

impl Crs {
    /// Metres per unit along x, y and z.
    #[must_use]
    pub fn metres_per_unit_xyz(&self) -> [f64; 3] {
        [self.metres_per_unit, self.metres_per_unit, self.vertical_metres_per_unit]
    }

    /// The system that `text` names: an EPSG code ("EPSG:28992", "28992", "EPSG:28992+5709"), well-known text (version
    /// 1 or 2, compound too) or a PROJ string.
    ///
    /// Heights without a unit of their own are taken in the horizontal unit. A unit whose name says foot is a foot even
    /// where the file gives it the factor 1.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] where the text names no system known here.
    pub fn parse(text: &str) -> Result<Self> {
        let text = text.trim_matches(|c: char| c.is_whitespace() || c == '\0');
        if text.contains(['[', '(']) && text.starts_with(|c: char| c.is_ascii_alphabetic()) {
            return wkt::read(text).ok_or_else(|| invalid(text));
        }
        registry::system(text).ok_or_else(|| invalid(text))
    }

    /// The system with an EPSG code, or `None` where the embedded registry lacks it.
    #[must_use]
    pub fn from_epsg(code: u32) -> Option<Self> {
        registry::system_of_code(code)
    }

    /// Longitude and latitude of WGS 84.
    #[must_use]
    pub fn wgs_84() -> Self {
        Self { epsg: Some(4326), kind: CrsKind::Geographic, ..Self::default() }
    }

    /// Returns true if this is longitude and latitude of WGS 84 itself.
    #[must_use]
    pub fn is_wgs_84(&self) -> bool {
        self.kind == CrsKind::Geographic && matches!(self.epsg, Some(4326 | 4979))
    }

    /// The system that a GeoTIFF key directory (the bytes of LAS record 34735, little-endian u16) names, or `None`
    /// where it names none. Keys that need the double or text records are not followed: only codes and units count.
    #[must_use]
    pub fn from_geotiff_keys(directory: &[u8]) -> Option<Self> {
        let words: Vec<u16> = directory.as_chunks::<2>().0.iter().map(|&pair| u16::from_le_bytes(pair)).collect();
        let (_, entries) = words.split_at_checked(4)?;
        let value = |key: u16| {
            entries
                .as_chunks::<4>()
                .0
                .iter()
                .find_map(|&[id, location, _, value]| (id == key && location == 0 && value != 0).then_some(value))
        };
        let code = |key: u16| value(key).filter(|&v| v < 32767).map(u32::from);
        let (projected, geodetic, vertical) = (code(3072), code(2048), code(4096));
        let kind = match value(1024) {
            Some(2) => CrsKind::Geographic,
            Some(3) => CrsKind::Geocentric,
            Some(1) => CrsKind::Projected,
            _ if value(3072).is_some() => CrsKind::Projected,
            _ if geodetic.is_some() => CrsKind::Geographic,
            _ => return None,
        };
        let epsg = if kind == CrsKind::Projected { projected } else { geodetic };
        let mut crs = epsg.and_then(Self::from_epsg).unwrap_or_default();
        (crs.epsg, crs.kind) = (epsg, kind);
        if let Some(unit) = value(3076).and_then(unit_of_code) {
            if epsg.is_some() {
                crs.doubt = units_apart("the unit", unit, crs.metres_per_unit);
            }
            crs.metres_per_unit = unit;
        }
        for (what, key) in [("the unit", 3076), ("the unit of heights", 4099)] {
            if let Some(unit) = value(key).filter(|&unit| unit_of_code(unit).is_none()) {
                let taken = unit_name(crs.metres_per_unit);
                crs = crs
                    .doubted(format!("{what} has the code {unit} in its keys, which is not known; {taken} were taken"));
            }
        }
        let (own, of_code) = (value(4099).and_then(unit_of_code), vertical.and_then(registry::vertical_metres_of_code));
        if let Some(what) = own.zip(of_code).and_then(|(own, of_code)| units_apart("the unit of heights", own, of_code))
        {
            crs = crs.doubted(what);
        }
        crs.vertical_metres_per_unit = own.or(of_code).unwrap_or(crs.metres_per_unit);
        crs.vertical_epsg = vertical;
        if let Some(name) = vertical.and_then(registry::depth_of_code) {
            crs = crs.doubted(counts_down(&name));
        }
        Some(crs)
    }

    /// Returns the name of the system for other programs: the well-known text of the file, else the code as
    /// `EPSG:28992`. `None` if no system is known.
    #[must_use]
    pub fn definition(&self) -> Option<String> {
        self.wkt.clone().or_else(|| self.epsg.map(|code| format!("EPSG:{code}")))
    }

    /// The system in a few words, such as "EPSG:28992 (Amersfoort / RD New), metres".
    #[must_use]
    pub fn describe(&self) -> String {
        let code = self.epsg.map(|code| format!("EPSG:{code}"));
        let name = self
            .wkt
            .as_deref()
            .and_then(wkt::name)
            .or_else(|| registry::name_of_code(self.epsg?))
            .filter(|name| !name.is_empty());
        let system = match (code, name) {
            (Some(code), Some(name)) => format!("{code} ({name})"),
            (Some(only), None) | (None, Some(only)) => only,
            (None, None) if self.kind == CrsKind::Unknown => "no reference system".to_owned(),
            (None, None) => "unnamed reference system".to_owned(),
        };
        let unit = match self.kind {
            CrsKind::Geographic => return format!("{system}, degrees"),
            CrsKind::Geocentric => return format!("{system}, earth-centred"),
            _ => unit_name(self.metres_per_unit),
        };
        let vertical_unit = unit_name(self.vertical_metres_per_unit);
        if unit == vertical_unit {
            format!("{system}, {unit}")
        } else {
            format!("{system}, {unit}, heights in {vertical_unit}")
        }
    }

    /// Returns true if both systems are known and differ, so that files in them cannot be combined.
    #[must_use]
    pub fn contradicts(&self, other: &Self) -> bool {
        let is_known = |crs: &Self| crs.kind != CrsKind::Unknown;
        is_known(self) && is_known(other) && !self.same_system(other)
    }

    /// Refuses a file in this system if it contradicts that of the scene it is for; `what` names the contents of the
    /// file at `path`, such as "mesh".
    ///
    /// # Errors
    /// [`Error::UnusableCrs`].
    pub fn check_for(&self, scene: &Self, what: &str, path: &Path) -> Result<()> {
        if !self.contradicts(scene) {
            return Ok(());
        }
        let (own, other) = (self.describe(), scene.describe());
        let what = format!("the {what} is in {own}, but the scene is in {other}; convert one of them");
        Err(Error::UnusableCrs { path: path.to_owned(), what })
    }

    /// Returns true if files in these systems can be combined: they have the same horizontal system in the same units.
    #[must_use]
    pub fn same_system(&self, other: &Self) -> bool {
        let close = |a: f64, b: f64| (a - b).abs() <= 1e-9 * b.abs();
        if self.kind != other.kind
            || !close(self.metres_per_unit, other.metres_per_unit)
            || !close(self.vertical_metres_per_unit, other.vertical_metres_per_unit)
        {
            return false;
        }
        match (self.horizontal_epsg(), other.horizontal_epsg()) {
            (Some(mine), Some(theirs)) => mine == theirs,
            _ => match (&self.wkt, &other.wkt) {
                (Some(mine), Some(theirs)) => {
                    mine == theirs || wkt::horizontal_name(mine) == wkt::horizontal_name(theirs)
                }
                (None, None) => true,
                // text without a code, and a code without text
                _ => match (self.horizontal_name(), other.horizontal_name()) {
                    (Some(mine), Some(theirs)) => plain(&mine) == plain(&theirs),
                    _ => false,
                },
            },
        }
    }

    /// Why coordinates in this system cannot be used, with a conversion to run first; `None` where they can.
    ///
    /// `somewhere` is any position of the file in its own unit, used to name a fitting UTM zone.
    #[must_use]
    pub fn refusal(&self, somewhere: [f64; 3]) -> Option<String> {
        let [x, y, z] = somewhere;
        let (longitude, latitude, what) = match self.kind {
            CrsKind::Geographic => (x, y, "in degrees"),
            CrsKind::Geocentric => {
                (y.atan2(x).to_degrees(), z.atan2(x.hypot(y)).to_degrees(), "earth-centred (geocentric)")
            }
            CrsKind::Projected if self.is_web_mercator() => {
                (web_mercator_degrees(x), (y / WEB_MERCATOR_RADIUS).sinh().atan().to_degrees(), WEB_MERCATOR)
            }
            CrsKind::Unknown | CrsKind::Projected | CrsKind::Local => return None,
        };
        let target = utm_zone(longitude, latitude);
        Some(format!(
            "coordinates are {what} ({}); a projected system in metres or feet is needed, so convert first, for \
             example: pdal translate IN.laz OUT.laz reprojection --filters.reprojection.out_srs=EPSG:{target}",
            self.describe()
        ))
    }

    /// Returns true if this is Web Mercator, whose metres are true at the equator only: twice too long at 60° of
    /// latitude.
    #[must_use]
    pub fn is_web_mercator(&self) -> bool {
        let codes = [3857, 3785, 900_913, 102_100, 102_113];
        let name = self.wkt.as_deref().and_then(wkt::name).unwrap_or_default().to_ascii_lowercase();
        self.horizontal_epsg().is_some_and(|code| codes.contains(&code))
            || ["pseudo-mercator", "web mercator", "web_mercator", "popular visualisation"]
                .iter()
                .any(|n| name.contains(n))
    }

    /// Name of the horizontal part, by its text or else its code.
    fn horizontal_name(&self) -> Option<String> {
        let by_code = || registry::name_of_code(self.horizontal_epsg()?);
        self.wkt.as_deref().and_then(wkt::horizontal_name).or_else(by_code)
    }

    fn horizontal_epsg(&self) -> Option<u32> {
        let code = self.epsg?;
        Some(registry::horizontal_code_of(code).unwrap_or(code))
    }
}

/// A name reduced to the characters that programs write alike.
fn plain(name: &str) -> String {
    name.chars().filter(char::is_ascii_alphanumeric).map(|c| c.to_ascii_lowercase()).collect()
}

fn invalid(text: &str) -> Error {
    let mut value: String = text.chars().take(80).collect();
    if value.len() < text.len() {
        value.push('…');
    }
    Error::invalid(
        Parameter::Crs,
        value,
        if cfg!(feature = "crs") {
            "a known EPSG code such as EPSG:28992, well-known text or a PROJ string"
        } else {
            "well-known text; this program was built without the cargo feature `crs`, which codes and PROJ strings need"
        },
    )
}

/// Radius of the sphere of Web Mercator, metres.
const WEB_MERCATOR_RADIUS: f64 = 6_378_137.0;
const WEB_MERCATOR: &str = "in Web Mercator, whose metres are not metres on the ground";

fn web_mercator_degrees(x: f64) -> f64 {
    (x / WEB_MERCATOR_RADIUS).to_degrees()
}

/// EPSG unit codes as GeoTIFF keys use them, with their metres.
const UNIT_CODES: [(u16, f64); 7] = [
    (9001, 1.0),
    (9002, INTERNATIONAL_FOOT),
    (9003, US_SURVEY_FOOT),
    (9005, 0.304_797_265_4),
    (9036, 1000.0),
    (1025, 0.001),
    (1033, 0.01),
];

fn unit_of_code(code: u16) -> Option<f64> {
    UNIT_CODES.iter().find(|&&(known, _)| known == code).map(|&(_, metres)| metres)
}

/// Describes the contradiction between a unit and that of the code beside it.
fn units_apart(what: &str, own: f64, of_code: f64) -> Option<String> {
    let [named, known] = [own, of_code].map(unit_name);
    ((own - of_code).abs() > 1e-7 * of_code)
        .then(|| format!("{what} is given as {named}, but that of its code is {known}"))
}

/// Describes the evidence against a vertical system that counts downwards.
fn counts_down(name: &str) -> String {
    format!("{name} counts downwards, and was read as if it counted upwards; turn the sign of z before")
}

fn unit_name(metres: f64) -> String {
    let is = |unit: f64| (metres - unit).abs() < 1e-9 * unit;
    if is(1.0) {
        "metres".to_owned()
    } else if is(INTERNATIONAL_FOOT) {
        "international feet".to_owned()
    } else if is(US_SURVEY_FOOT) {
        "US survey feet".to_owned()
    } else {
        format!("units of {metres} m")
    }
}

/// EPSG code of the UTM zone (WGS 84) around a position in degrees; zone 31 north where it is no position at all.
fn utm_zone(longitude: f64, latitude: f64) -> u32 {
    let zone =
        if longitude.is_finite() { to_u32(((longitude + 180.0) / 6.0).floor().clamp(0.0, 59.0)) + 1 } else { 31 };
    if latitude < 0.0 { 32700 + zone } else { 32600 + zone }
}

// ---- geographic coordinates into the plane of a reference system ----

/// Turns latitude and longitude (WGS 84) into the metres of one reference system, and back. The step between the datums
/// is the one that is best at the first place.
pub struct GeographicProjection {
    projection: registry::CrsProjection,
    metres_per_unit: f64,
}

impl Crs {
    /// The projection from latitude and longitude into this system, for many positions.
    ///
    /// # Errors
    /// [`Error::MissingAttribute`] where neither EPSG code nor well-known text is there,
    /// [`Error::InvalidParameter`] where it cannot be projected into.
    pub fn geographic_projection(&self) -> Result<GeographicProjection> {
        self.projection(registry::CrsProjection::new)
    }

    /// The projection alone, from latitude and longitude of a datum that nothing ties to WGS 84: directions are true,
    /// places may be hundreds of metres off. For systems that have no [`Crs::geographic_projection`].
    ///
    /// # Errors
    /// Those of [`Crs::geographic_projection`], where not even the projection is known.
    pub fn grid_projection(&self) -> Result<GeographicProjection> {
        self.projection(registry::CrsProjection::untied)
    }

    fn projection(
        &self,
        make: impl Fn(&str) -> std::result::Result<registry::CrsProjection, String>,
    ) -> Result<GeographicProjection> {
        let by_code = self.epsg.map(|code| format!("EPSG:{code}"));
        let mut is_named = false;
        // heights say nothing of a place, and may be written in ways that the database does not read
        let on_map = self.wkt.as_deref().and_then(wkt::horizontal_text);
        for definition in [by_code.as_deref(), self.wkt.as_deref(), on_map].into_iter().flatten() {
            is_named = true;
            if let Ok(projection) = make(definition) {
                return Ok(GeographicProjection { projection, metres_per_unit: self.metres_per_unit });
            }
        }
        Err(match is_named {
            true => Error::invalid(
                Parameter::ReferenceSystem,
                format!("{}, whose place on earth is not known here", self.describe()),
                "a projected system by EPSG code or well-known text",
            ),
            false => Error::MissingAttribute {
                attribute: "reference system",
                needed_for: "projecting latitude and longitude",
                advice: "name its EPSG code",
            },
        })
    }
}

impl GeographicProjection {
    /// Easting and northing in metres of a latitude and longitude in radians.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for values that are no latitude and longitude or cannot be projected.
    pub fn project(&self, latitude: f64, longitude: f64) -> Result<[f64; 2]> {
        use std::f64::consts::{FRAC_PI_2, PI};
        let invalid = |why: String| {
            Error::invalid(
                Parameter::LatitudeLongitude,
                format!("{latitude}, {longitude} rad{why}"),
                "radians within the area of the reference system",
            )
        };
        if !(latitude.abs() <= FRAC_PI_2 && longitude.abs() <= 2.0 * PI) {
            return Err(invalid(String::new()));
        }
        let (x, y) = self
            .projection
            .forward(longitude.to_degrees(), latitude.to_degrees())
            .map_err(|reason| invalid(format!(" ({reason})")))?;
        if !(x.is_finite() && y.is_finite()) {
            return Err(invalid(String::new()));
        }
        Ok([x * self.metres_per_unit, y * self.metres_per_unit])
    }

    /// Latitude and longitude in radians of an easting and northing in metres: the inverse of
    /// [`GeographicProjection::project`] within a micrometre.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for positions that the system cannot take back, and for systems without an inverse.
    pub fn unproject(&self, position: [f64; 2]) -> Result<[f64; 2]> {
        let invalid = |why: String| {
            Error::invalid(
                Parameter::Position,
                format!("{}, {} m{why}", position[0], position[1]),
                "within the area of the reference system",
            )
        };
        let back = |[x, y]: [f64; 2]| {
            let (longitude, latitude) = self
                .projection
                .back(x / self.metres_per_unit, y / self.metres_per_unit)
                .map_err(|reason| invalid(format!(" ({reason})")))?;
            Ok([latitude.to_radians(), longitude.to_radians()])
        };
        // Inverses of datum shifts are approximate; correcting by what projecting forward says removes the rest.
        let mut sought = position;
        for _ in 0..MAX_CORRECTIONS {
            let [latitude, longitude] = back(sought)?;
            let [x, y] = self.project(latitude, longitude)?;
            let error = [position[0] - x, position[1] - y];
            if error[0].hypot(error[1]) < UNPROJECT_TOLERANCE {
                return Ok([latitude, longitude]);
            }
            sought = [sought[0] + error[0], sought[1] + error[1]];
        }
        Err(invalid(String::new()))
    }
}

/// Maximum number of rounds of correcting an inverse: one or two are enough where it is approximate at all.
const MAX_CORRECTIONS: u32 = 8;
/// Distance that an inverse may miss, metres: far below a millimetre, above the rounding of degrees in f64 (2 nm).
const UNPROJECT_TOLERANCE: f64 = 1e-6;

#[cfg(all(test, feature = "crs"))]
mod geographic_projection_tests {
    use super::Crs;

    #[test]
    fn the_tower_of_amersfoort_is_where_it_should_be() {
        let rd = Crs { epsg: Some(28_992), ..Crs::default() };
        let [x, y] = rd
            .geographic_projection()
            .unwrap()
            .project(52.155_174_40_f64.to_radians(), 5.387_206_21_f64.to_radians())
            .unwrap();
        assert!((x - 155_000.0).abs() < 1.0 && (y - 463_000.0).abs() < 1.0, "{x} {y}");
    }

    #[test]
    fn unprojected_positions_project_back() {
        // The corners of the Dutch grid and its middle, Stuttgart in UTM 32, and New York in US survey feet.
        for (epsg, positions) in [
            (28_992, vec![[155_000.0, 463_000.0], [20_000.0, 370_000.0], [270_000.0, 600_000.0]]),
            (25_832, vec![[513_000.0, 5_402_000.0]]),
            (2263, vec![[300_000.0, 65_000.0]]),
        ] {
            let projection = Crs::from_epsg(epsg).unwrap().geographic_projection().unwrap();
            for position in positions {
                let [latitude, longitude] = projection.unproject(position).unwrap();
                let [x, y] = projection.project(latitude, longitude).unwrap();
                assert!((x - position[0]).hypot(y - position[1]) < 2e-6, "{epsg} {position:?}: {x} {y}");
            }
            assert!(projection.unproject([f64::NAN, 0.0]).is_err());
        }
    }

    #[test]
    fn without_a_system_the_error_advises() {
        let error = Crs::default().geographic_projection().err().unwrap().to_string();
        assert!(error.contains("EPSG"), "{error}");
        let rd = Crs { epsg: Some(28_992), ..Crs::default() };
        let projection = rd.geographic_projection().unwrap();
        assert!(projection.project(f64::NAN, 0.0).is_err());
        assert!(projection.project(52.0, 5.0).is_err());
    }
}
