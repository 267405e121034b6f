//! Roofs as planes: the plane parts of objects above the ground, with tilt, azimuth, area and the cells that solar
//! panels would lie on.

mod buildings;
mod cells;
mod fit;
mod grow;
mod params;
mod points;
mod room;

pub use buildings::Buildings;
pub use cells::PlaneCells;
pub use params::RoofPlaneParams;
pub use points::{GROUND_CELL, RoofsFrom, roof_points};

use belvedere_core::neighbors::NeighborIndex;
use belvedere_core::normals::estimate::{Neighborhood, estimate};
use belvedere_data::Result;
use belvedere_data::control::Control;
use belvedere_data::vector::compare_places;
use rayon::prelude::*;
use room::Room;
use std::f64::consts::TAU;

/// ASPRS class of buildings.
pub const BUILDING: u8 = 6;

/// Maximum tilt of a level plane without an aspect, radians. Flat roofs have 2 to 3 % of slope for the rain, and a few
/// of these degrees are noise.
pub const MAX_LEVEL: f64 = 2.0 * std::f64::consts::PI / 180.0;

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
/// [`Error::InvalidParameter`](belvedere_data::Error::InvalidParameter) for parameters outside their range and points
/// that are not finite; [`Error::Cancelled`](belvedere_data::Error::Cancelled).
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
