//! Roofs as planes: the plane parts of objects above the ground, with tilt, azimuth, area and the cells that solar
//! panels would lie on.

mod buildings;
mod cells;
mod fit;
mod grow;
mod points;
mod room;

pub use buildings::Buildings;
pub use cells::PlaneCells;
pub use points::{GROUND_CELL, RoofsFrom, roof_points};

use belvedere_core::neighbors::NeighborIndex;
use belvedere_core::normals::estimate::{Neighborhood, estimate};
use belvedere_data::control::Control;
use belvedere_data::vector::compare_places;
use belvedere_data::{Error, Parameter, Result};
use rayon::prelude::*;
use room::Room;
use std::f64::consts::{FRAC_PI_2, TAU};

/// ASPRS class of buildings.
pub const BUILDING: u8 = 6;

/// Minimum side of a cell, metres: points resolve no more, and the cells of a whole town would fill the memory.
const MIN_CELL: f64 = 0.1;

/// Maximum tilt of a level plane without an aspect, radians. Flat roofs have 2 to 3 % of slope for the rain, and a few
/// of these degrees are noise.
pub const MAX_LEVEL: f64 = 2.0 * std::f64::consts::PI / 180.0;

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
    fn validate(&self) -> Result<()> {
        let lengths = [self.distance, self.reach, self.cell];
        let is_usable = |v: &f64| *v > 0.0 && *v < 1000.0;
        if let Some(bad) = lengths.iter().find(|v| !is_usable(v)) {
            let value = bad.to_string();
            return Err(Error::InvalidParameter {
                parameter: Parameter::RoofLength,
                value,
                expected: "above 0 to 1000 m",
            });
        }
        if self.cell < MIN_CELL {
            return Err(Error::InvalidParameter {
                parameter: Parameter::RoofLength,
                value: format!("cells of {} m", self.cell),
                expected: "cells of 0.1 m or more",
            });
        }
        let is_angle = |v: f64| v > 0.0 && v <= FRAC_PI_2;
        if !is_angle(self.angle) || !is_angle(self.max_tilt) || !(self.min_area >= 0.0) {
            return Err(Error::InvalidParameter {
                parameter: Parameter::RoofAngle,
                value: format!("{} and {} rad, {} m²", self.angle, self.max_tilt, self.min_area),
                expected: "angles above 0 to 90 degrees, an area of 0 or more",
            });
        }
        Ok(())
    }
}

/// A plane part of a roof.
#[derive(Clone, Debug, PartialEq)]
pub struct RoofPlane {
    /// Rows of its points among those given, rising.
    pub points: Vec<u32>,
    /// Mean of its points, local metres.
    pub middle: [f64; 3],
    /// Unit normal, upward.
    pub normal: [f64; 3],
    /// Root mean square distance of its points, metres.
    pub roughness: f64,
    /// Its cells.
    pub cells: PlaneCells,
    /// The plane itself, chimneys and the like on it included, in cells as small as its points allow.
    pub extent: PlaneCells,
    /// Area in the plane, m², chimneys and the like on it included.
    pub area: f64,
}

impl RoofPlane {
    /// Angle from level, radians.
    #[must_use]
    pub fn tilt(&self) -> f64 {
        self.normal[2].clamp(-1.0, 1.0).acos()
    }

    /// Area of its cells, m²: that of the panels that it has room for.
    #[must_use]
    pub fn panel_area(&self) -> f64 {
        self.cells.count() as f64 * self.cells.cell.powi(2)
    }

    /// Azimuth that it faces, clockwise from grid north, radians, 0 to 2π; `None` where it is level.
    #[must_use]
    pub fn azimuth(&self) -> Option<f64> {
        (self.tilt() > MAX_LEVEL).then(|| self.normal[0].atan2(self.normal[1]).rem_euclid(TAU))
    }
}

/// The plane parts of `points`, (N, 3) local metres, those of roofs being given; largest first. Points of no plane are
/// left out, and so are planes without room for a panel.
///
/// From points with the flattest surroundings on, a plane takes in neighbours that lie near it and have a similar
/// normal, and is fitted anew as it grows. Its area is that of the cells that hold points, less the parts of cells that
/// reach over its outline.
///
/// # Errors
/// [`Error::InvalidParameter`] for parameters outside their range and points that are not finite; [`Error::Cancelled`].
///
/// # Source
/// Region growing with a smoothness constraint: Rabbani, van den Heuvel & Vosselman 2006. The area of a set from the
/// number of squares it meets and the length of their outline is Steiner's formula.
pub fn roof_planes(points: &[[f32; 3]], params: &RoofPlaneParams, control: &Control<'_>) -> Result<Vec<RoofPlane>> {
    params.validate()?;
    // planes grow from the first of several points that are equally flat
    let mut rows: Vec<u32> = (0..).zip(points).map(|(row, _)| row).collect();
    rows.par_sort_unstable_by(|&a, &b| compare_places(&points[a as usize], &points[b as usize]).then(a.cmp(&b)));
    let points = &rows.iter().map(|&row| points[row as usize]).collect::<Vec<_>>()[..];
    let index = NeighborIndex::new(points, &Control::none())?;
    // near ridges and eaves few neighbours are on one plane
    let normals = estimate(points, &index, Neighborhood::adaptive(), &Control::none())?;
    let is_roof = |rows: &[u32], fit: &fit::PlaneFit| {
        let is_flat_enough = fit.normal[2].clamp(-1.0, 1.0).acos() <= params.max_tilt;
        is_flat_enough && cells::area(points, rows, fit, params.cell) >= params.min_area
    };
    let regions = grow::regions(points, &index, &normals, params, is_roof, control)?;
    let room = Room::new(points, &index, &regions, params);
    let mut planes: Vec<RoofPlane> = (0..)
        .zip(regions)
        .map(|(number, (rows, fit))| {
            let fits = |cells: &PlaneCells, middle| room.fits(number, cells, fit.normal, middle);
            let cells = PlaneCells::of(points, &rows, &fit, params.cell, fits);
            let area = cells::area(points, &rows, &fit, params.cell);
            let extent = PlaneCells::extent(points, &rows, &fit, area);
            let (middle, normal, roughness) = (fit.middle, fit.normal, fit.roughness);
            RoofPlane { points: rows, middle, normal, roughness, cells, extent, area }
        })
        .filter(|plane| plane.cells.count() > 0)
        .collect();
    // of equal areas the one with the lower first point, so that the order is settled
    planes.sort_by(|a, b| b.area.total_cmp(&a.area).then_with(|| a.points.first().cmp(&b.points.first())));
    planes.iter_mut().flat_map(|plane| &mut plane.points).for_each(|row| *row = rows[*row as usize]);
    Ok(planes)
}
