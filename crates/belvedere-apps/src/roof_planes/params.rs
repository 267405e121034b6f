//! Parameters of the detection of roof planes.

use belvedere_data::{Error, Parameter, Result};
use std::f64::consts::FRAC_PI_2;

/// Minimum side of a cell, metres: points resolve no more, and the cells of a whole town would fill the memory.
const MIN_CELL: f64 = 0.1;

/// Parameters of the detection of planes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct RoofPlaneParams {
    /// Maximum distance of a point of a plane from it, metres, above 0. Default 0.12: four times the noise of airborne
    /// scans.
    pub distance: f64,
    /// Maximum angle between the normals of a point and of its plane, radians, above 0 to π/2. Default 25 degrees:
    /// wide, since normals bend near ridges and eaves; distance decides.
    pub angle: f64,
    /// Maximum step from point to point of a plane, metres, above 0. Default 1: the gap of two points a square metre.
    pub reach: f64,
    /// Steepest plane that counts, radians from level, below π/2. Default 75 degrees: walls are no roofs.
    pub max_tilt: f64,
    /// Minimum area of a plane, m². Default 4: two panels.
    pub min_area: f64,
    /// Side of the cells that a plane is cut into, metres, 0.1 to 1000. Default 1: the width of a panel.
    pub cell: f64,
}

belvedere_data::setters!(RoofPlaneParams {
    with_distance(distance: f64),
    with_angle(angle: f64),
    with_reach(reach: f64),
    with_max_tilt(max_tilt: f64),
    with_min_area(min_area: f64),
    with_cell(cell: f64),
});

impl Default for RoofPlaneParams {
    fn default() -> Self {
        Self {
            distance: 0.12,
            angle: 25f64.to_radians(),
            reach: 1.0,
            max_tilt: 75f64.to_radians(),
            min_area: 4.0,
            cell: 1.0,
        }
    }
}

impl RoofPlaneParams {
    pub(super) fn validate(&self) -> Result<()> {
        let lengths = [self.distance, self.reach, self.cell];
        let is_usable = |v: &f64| *v > 0.0 && *v < 1000.0;
        if let Some(bad) = lengths.iter().find(|v| !is_usable(v)) {
            return Err(Error::invalid(Parameter::RoofLength, bad, "above 0 to 1000 m"));
        }
        if self.cell < MIN_CELL {
            let expected = "cells of 0.1 m or more";
            return Err(Error::invalid(Parameter::RoofLength, format!("cells of {} m", self.cell), expected));
        }
        let is_angle = |v: f64| v > 0.0 && v <= FRAC_PI_2;
        if !is_angle(self.angle) || !is_angle(self.max_tilt) || !(self.min_area >= 0.0) {
            return Err(Error::invalid(
                Parameter::RoofAngle,
                format!("{} and {} rad, {} m²", self.angle, self.max_tilt, self.min_area),
                "angles above 0 to 90 degrees, an area of 0 or more",
            ));
        }
        Ok(())
    }
}
