//! The database of coordinate reference systems, and projecting by it. Everything that names the crates for it is here.

use super::{Crs, CrsKind};

/// The system that a code such as `EPSG:28992` or a PROJ string names.
pub(super) fn system(text: &str) -> Option<Crs> {
    proj_wkt::parse_crs(text).ok().map(|definition| from_definition(&definition))
}

/// The system with an EPSG code.
pub(super) fn system_of_code(code: u32) -> Option<Crs> {
    proj_core::lookup_epsg(code).map(|definition| from_definition(&definition))
}

/// Name of the system with an EPSG code.
pub(super) fn name_of_code(code: u32) -> Option<String> {
    Some(proj_core::lookup_epsg(code)?.name().to_owned())
}

/// Code of the horizontal part of the system with an EPSG code.
pub(super) fn horizontal_code_of(code: u32) -> Option<u32> {
    proj_core::lookup_epsg(code).and_then(|definition| horizontal_code(&definition))
}

/// Metres per unit of the vertical system with an EPSG code.
pub(super) fn vertical_metres_of_code(code: u32) -> Option<f64> {
    Some(proj_core::lookup_vertical_epsg(code)?.linear_unit_to_meter())
}

/// Well-known text of the system that a code names.
pub(super) fn wkt(text: &str) -> Option<String> {
    proj_wkt::to_wkt(&proj_wkt::parse_crs(text).ok()?).ok()
}

/// From longitude and latitude of WGS 84 in degrees to the coordinates of a system, and back.
pub(super) struct CrsProjection {
    forward: proj_core::Transform,
    inverse: Option<proj_core::Transform>,
}

impl CrsProjection {
    /// The projection into the system that a code or well-known text names; on failure the reason.
    pub(super) fn new(definition: &str) -> Result<Self, String> {
        let forward =
            proj_wkt::transform_from_crs_strings_horizontal("EPSG:4326", definition).map_err(|e| e.to_string())?;
        let inverse = forward.inverse().ok();
        Ok(Self { forward, inverse })
    }

    /// Coordinates of a longitude and latitude in degrees; on failure the reason.
    pub(super) fn forward(&self, longitude: f64, latitude: f64) -> Result<(f64, f64), String> {
        self.forward.convert((longitude, latitude)).map_err(|e| e.to_string())
    }

    /// Longitude and latitude in degrees of coordinates; on failure the reason.
    pub(super) fn back(&self, x: f64, y: f64) -> Result<(f64, f64), String> {
        let inverse = self.inverse.as_ref().ok_or_else(|| "the system has no inverse".to_owned())?;
        inverse.convert((x, y)).map_err(|e| e.to_string())
    }
}

fn from_definition(definition: &proj_core::CrsDef) -> Crs {
    let horizontal = definition.as_projected().map_or(1.0, proj_core::ProjectedCrsDef::linear_unit_to_meter);
    let vertical = definition.vertical_crs();
    Crs {
        wkt: None,
        epsg: Some(definition.epsg()).filter(|&code| code != 0).or_else(|| horizontal_code(definition)),
        vertical_epsg: vertical.map(proj_core::VerticalCrsDef::epsg).filter(|&code| code != 0),
        metres_per_unit: horizontal,
        vertical_metres_per_unit: vertical.map_or(horizontal, proj_core::VerticalCrsDef::linear_unit_to_meter),
        kind: if definition.is_geocentric() {
            CrsKind::Geocentric
        } else if definition.is_geographic() {
            CrsKind::Geographic
        } else {
            CrsKind::Projected
        },
    }
}

fn horizontal_code(definition: &proj_core::CrsDef) -> Option<u32> {
    definition.horizontal_crs().map(|horizontal| horizontal.epsg()).filter(|&code| code != 0)
}
