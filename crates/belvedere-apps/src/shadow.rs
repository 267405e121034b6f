//! Shadow: what of the sun reaches a place, its disc taken as a point or as it is.

use belvedere_core::query::VisibilityMatrix;
use belvedere_data::vector::{cross, dot, unit};
use belvedere_data::{Error, Result};
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Angular radius of the sun's disc at its mean distance, radians: 959.63 arc seconds.
///
/// # Source
/// Auwers 1891, as the almanacs have it.
pub const SUN_RADIUS: f64 = 959.63 / 3600.0 * std::f64::consts::PI / 180.0;
/// Points that stand for the disc: shares of light to 1/64.
const DISC_POINTS: usize = 64;
/// Targets handed to a thread at once.
const CHUNK: usize = 1024;

/// What edges of shadows are like.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Edges {
    /// The sun is a point: a place is lit or not.
    #[default]
    Hard,
    /// The sun is a disc of half a degree, of which a place sees a share: edges are as wide as 1/107 of the way to what casts them.
    Soft,
}

/// Directions that stand for a sun in the direction of the unit vector `to_sun`: itself, or 64 points of equal shares of its disc.
#[must_use]
pub fn sun_directions(to_sun: [f64; 3], edges: Edges) -> Vec<[f64; 3]> {
    if edges == Edges::Hard {
        return vec![to_sun];
    }
    let aside = if to_sun[2].abs() < 0.9 { [0.0, 0.0, 1.0] } else { [1.0, 0.0, 0.0] };
    let right = unit(cross(aside, to_sun)).unwrap_or([1.0, 0.0, 0.0]);
    let up = cross(to_sun, right);
    let golden_ratio = f64::midpoint(1.0, 5f64.sqrt());
    (0..DISC_POINTS)
        .filter_map(|i| {
            let off = SUN_RADIUS.tan() * ((i as f64 + 0.5) / DISC_POINTS as f64).sqrt();
            let (sin, cos) = (TAU * (i as f64 / golden_ratio).fract()).sin_cos();
            unit(std::array::from_fn(|axis| to_sun[axis] + off * (cos * right[axis] + sin * up[axis])))
        })
        .collect()
}

/// The share of a sun that each target of `matrix` sees, 0 to 1, (M), where `directions` stand for it, the first of them being column
/// `first` of the matrix. What is below the horizon is not seen, nor is what stands behind a target that is turned away by its
/// outward normal, (M, 3); `None` where targets have none.
///
/// # Errors
/// [`Error::LengthMismatch`] where the matrix has fewer columns, or normals are not as many as targets.
pub fn lit_shares(
    matrix: &VisibilityMatrix,
    first: usize,
    directions: &[[f64; 3]],
    normals: Option<&[[f32; 3]]>,
) -> Result<Vec<f32>> {
    let (expected, found) = (first + directions.len(), matrix.direction_count());
    if found < expected {
        return Err(Error::LengthMismatch { what: "directions of the sun", expected, found });
    }
    let expected = matrix.target_count();
    if let Some(found) = normals.map(<[_]>::len).filter(|&found| found != expected) {
        return Err(Error::LengthMismatch { what: "normals of targets", expected, found });
    }
    let share = |target: usize| {
        let is_lit = |(column, direction): &(usize, &[f64; 3])| {
            let is_before = normals.is_none_or(|normals| dot(normals[target].map(f64::from), **direction) > 0.0);
            direction[2] > 0.0 && is_before && matrix.is_free(target, first + column)
        };
        directions.iter().enumerate().filter(is_lit).count() as f32 / directions.len().max(1) as f32
    };
    Ok((0..matrix.target_count()).into_par_iter().with_min_len(CHUNK).map(share).collect())
}
