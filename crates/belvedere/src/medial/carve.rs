//! Cutting balls down to what the pulses leave of them.

use super::balls::{MedialBalls, NO_TOUCH};
use crate::neighbors::Tangent;
use crate::normals::OrientedCloud;
use crate::pulses::Needles;
use crate::{Attributes, Error, Result};
use rayon::prelude::*;

/// Value of [`MedialBalls::touch`] for a ball whose second contact is a pulse instead of a point.
pub const PULSE_TOUCH: u32 = NO_TOUCH - 1;

/// Balls handed to a thread at once; their searches share the cache.
const CHUNK: usize = 512;

/// How balls are carved, and how large they may stay where nothing bounds them well. Radii are metres, above 0.
///
/// The defaults were chosen on simulated towns of another seed than those of `docs/accuracy.md`: a penetration of 0.05 m instead of
/// 0.02 costs 1.3 points on facades; between 0.3 and 1 m the radius at vegetation moves pedestrians by 0.2 points; later returns
/// cut to 0.15 m instead of 0.3 let three points more of the shade of crowns through. 0.08 instead
/// of 0.15 m as the least radius and 4 instead of 2 m at the ground change nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CarveParams {
    /// Depth to which a pulse may enter a ball, metres, 0 or more. Default 0.02.
    pub penetration: f32,
    /// Most radius at a point of vegetation (class 3 to 5). Default 1.
    pub vegetation_radius: f32,
    /// Most radius at a point that is not the first return of its pulse. Something before it let the pulse through, so that it
    /// mostly lies in or under a crown, where neither its normal nor the side it was seen from says much. Default 0.3.
    pub later_return_radius: f32,
    /// Most radius at a point of the ground (class 2). Default 2.
    pub ground_radius: f32,
    /// Least radius at any other point, to which carved balls are grown again: a wall is at least this thick. Default
    /// 0.15.
    pub least_radius: f32,
}

impl Default for CarveParams {
    fn default() -> Self {
        Self {
            penetration: 0.02,
            vegetation_radius: 1.0,
            later_return_radius: 0.3,
            ground_radius: 2.0,
            least_radius: 0.15,
        }
    }
}

/// What became of the balls in [`carve`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CarveReport {
    /// Balls that a pulse made smaller.
    pub carved: usize,
    /// Balls that were cut to the most radius for their kind of point.
    pub limited: usize,
    /// Balls grown again to the least radius.
    pub grown: usize,
}

/// Cuts each of `balls` until no needle enters it by more than [`CarveParams::penetration`], then limits its radius by the
/// kind of its point. Row i of `balls` must be the interior ball of point i of `oriented`, as [`super::shrink`] makes it, and
/// `attributes`, of which class and return number are used where present, must be those of the same points.
///
/// A ball that had met no point but meets a pulse counts as shrunk from here on, with [`PULSE_TOUCH`]; so does one that is
/// limited. The result depends on neither order nor number of threads.
///
/// # Errors
/// [`Error::LengthMismatch`] where they differ in length.
///
/// # Source
/// This project's own; cutting free space by lines of sight has relatives in space carving (Kutulakos & Seitz 2000) and
/// cone carving (Shalom et al. 2010).
pub fn carve(
    balls: &mut MedialBalls,
    attributes: &Attributes,
    oriented: &OrientedCloud,
    needles: &Needles,
    params: &CarveParams,
) -> Result<CarveReport> {
    let expected = oriented.positions().len();
    for (what, found) in [("balls", balls.len())].into_iter().chain(attributes.columns()) {
        if found != expected {
            return Err(Error::LengthMismatch { what, expected, found });
        }
    }
    let (positions, normals) = (oriented.positions(), oriented.normals());
    let ball = |row: usize, radius: f32| {
        let tangent = Tangent { point: positions[row], inward: normals[row].map(|v| -v), margin: params.penetration };
        let empty = needles.smallest_tangent_ball(&tangent, radius - params.penetration);
        empty.map(|empty| empty + params.penetration)
    };
    let carved: Vec<Option<f32>> =
        balls.radii.par_iter().enumerate().with_min_len(CHUNK).map(|(row, &r)| ball(row, r)).collect();
    let mut report = CarveReport::default();
    for (row, carved) in carved.into_iter().enumerate() {
        if !(balls.radii[row] > 0.0) {
            continue;
        }
        let mut radius = balls.radii[row];
        if let Some(carved) = carved {
            report.carved += 1;
            radius = carved;
        }
        let (least, most) = params.bounds(attributes, row);
        report.limited += usize::from(radius > most);
        report.grown += usize::from(radius < least);
        radius = radius.min(most).max(least);
        if radius < balls.radii[row] || carved.is_some() {
            balls.radii[row] = radius;
            balls.centers[row] = std::array::from_fn(|i| positions[row][i] - normals[row][i] * radius);
            if carved.is_some() || balls.touch[row] == NO_TOUCH {
                balls.touch[row] = PULSE_TOUCH;
                balls.separation_angles[row] = f32::NAN;
            }
        }
    }
    Ok(report)
}

impl CarveParams {
    /// Least and most radius of the ball of a point.
    fn bounds(&self, attributes: &Attributes, row: usize) -> (f32, f32) {
        let of = |column: &Option<Vec<u8>>| column.as_ref().and_then(|values| values.get(row)).copied();
        let most = match of(&attributes.classification) {
            Some(2) => return (0.0, self.ground_radius),
            Some(3..=5) => self.vegetation_radius,
            _ => f32::INFINITY,
        };
        let is_later = of(&attributes.return_number).is_some_and(|number| number > 1);
        let most = if is_later { most.min(self.later_return_radius) } else { most };
        (if most.is_finite() { 0.0 } else { self.least_radius }, most)
    }
}
