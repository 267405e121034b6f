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
