//! Coordinate reference systems as far as visibility needs them: which unit, and degrees or not.

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
}

impl Default for Crs {
    fn default() -> Self {
        Self { wkt: None, epsg: None, vertical_epsg: None, metres_per_unit: 1.0, vertical_metres_per_unit: 1.0 }
    }
}

impl Crs {
    /// Metres per unit along x, y and z.
    #[must_use]
    pub fn metres_per_unit_xyz(&self) -> [f64; 3] {
        [self.metres_per_unit, self.metres_per_unit, self.vertical_metres_per_unit]
    }
}

// ---- geographic coordinates into the plane of a reference system ----

/// Turns latitude and longitude (WGS 84) into the metres of one reference system.
pub struct GeographicProjection {
    transform: proj_core::Transform,
    metres_per_unit: f64,
}

impl Crs {
    /// The projection from latitude and longitude into this system, for many positions.
    ///
    /// # Errors
    /// [`crate::Error::MissingAttribute`] where neither EPSG code nor well-known text is there,
    /// [`crate::Error::InvalidParameter`] where it cannot be projected into.
    pub fn geographic_projection(&self) -> crate::Result<GeographicProjection> {
        let by_code = self.epsg.map(|code| format!("EPSG:{code}"));
        let mut failure = None;
        for definition in [by_code.as_deref(), self.wkt.as_deref()].into_iter().flatten() {
            match proj_wkt::transform_from_crs_strings_horizontal("EPSG:4326", definition) {
                Ok(transform) => return Ok(GeographicProjection { transform, metres_per_unit: self.metres_per_unit }),
                Err(e) => failure = Some(e.to_string()),
            }
        }
        Err(match failure {
            Some(value) => crate::Error::InvalidParameter {
                name: "reference system",
                value,
                expected: "a projected system known by EPSG code or well-known text",
            },
            None => crate::Error::MissingAttribute {
                attribute: "reference system",
                needed_for: "projecting latitude and longitude",
                advice: "name its EPSG code",
            },
        })
    }

    /// Easting and northing in metres (units of this system times its metres per unit) of a latitude and longitude in
    /// radians (WGS 84). For many positions take [`Crs::geographic_projection`] once.
    ///
    /// # Errors
    /// As [`Crs::geographic_projection`] and [`GeographicProjection::project`].
    pub fn project_geographic(&self, latitude: f64, longitude: f64) -> crate::Result<[f64; 2]> {
        self.geographic_projection()?.project(latitude, longitude)
    }
}

impl GeographicProjection {
    /// Easting and northing in metres of a latitude and longitude in radians.
    ///
    /// # Errors
    /// [`crate::Error::InvalidParameter`] for values that are no latitude and longitude or cannot be projected.
    pub fn project(&self, latitude: f64, longitude: f64) -> crate::Result<[f64; 2]> {
        use std::f64::consts::{FRAC_PI_2, PI};
        let invalid = |why: String| crate::Error::InvalidParameter {
            name: "latitude and longitude",
            value: format!("{latitude}, {longitude} rad{why}"),
            expected: "radians within the area of the reference system",
        };
        if !(latitude.abs() <= FRAC_PI_2 && longitude.abs() <= 2.0 * PI) {
            return Err(invalid(String::new()));
        }
        let (x, y) = self
            .transform
            .convert((longitude.to_degrees(), latitude.to_degrees()))
            .map_err(|e| invalid(format!(" ({e})")))?;
        if !(x.is_finite() && y.is_finite()) {
            return Err(invalid(String::new()));
        }
        Ok([x * self.metres_per_unit, y * self.metres_per_unit])
    }
}

#[cfg(test)]
mod geographic_projection_tests {
    use super::Crs;

    #[test]
    fn the_tower_of_amersfoort_is_where_it_should_be() {
        let rd = Crs { epsg: Some(28_992), ..Crs::default() };
        let [x, y] = rd.project_geographic(52.155_174_40_f64.to_radians(), 5.387_206_21_f64.to_radians()).unwrap();
        assert!((x - 155_000.0).abs() < 1.0 && (y - 463_000.0).abs() < 1.0, "{x} {y}");
    }

    #[test]
    fn without_a_system_the_error_advises() {
        let error = Crs::default().project_geographic(0.9, 0.1).unwrap_err().to_string();
        assert!(error.contains("EPSG"), "{error}");
        let rd = Crs { epsg: Some(28_992), ..Crs::default() };
        assert!(rd.project_geographic(f64::NAN, 0.0).is_err());
        assert!(rd.project_geographic(52.0, 5.0).is_err());
    }
}
