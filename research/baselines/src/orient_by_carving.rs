//! The sign of normals where no scanner gives it: inside is where carved balls stay large.

use belvedere::control::{Control, Stop};
use belvedere::neighbors::{NeighborIndex, Tangent};
use belvedere::normals::OrientedCloud;
use belvedere::pulses::FreeSegments;
use belvedere::{Error, Parameter, Result};
use rayon::prelude::*;

/// How [`orient_by_carving`] works.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrientByCarvingParams {
    /// Normals whose sign is less certain than this are tested, 0 to 1 (1 for all). Default 0.05: below that the way to
    /// the scanner runs within 3° of the surface.
    pub min_confidence: f32,
    /// Depth to which a point or a pulse may enter a ball, metres, above 0. Default 0.02, that of carved balls.
    pub penetration: f32,
    /// Radius every ball starts with, metres. Default 5, that of carved balls.
    pub initial_radius: f32,
    /// How many times larger the ball on the other side must be for the sign to change, at least 1. Default 1.
    pub min_ratio: f32,
}

impl Default for OrientByCarvingParams {
    fn default() -> Self {
        Self { min_confidence: 0.05, penetration: 0.02, initial_radius: 5.0, min_ratio: 1.0 }
    }
}

/// What became of the signs in [`orient_by_carving`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OrientByCarvingReport {
    /// Normals tested.
    pub tested: usize,
    /// Signs changed.
    pub flipped: usize,
}

/// The cloud with every normal whose sign is in doubt pointing away from the side on which points and pulses leave the
/// larger ball: pulses sweep the outside of a surface and never its inside. Normals keep their confidence.
///
/// For normals whose signs nothing tells, such as those of a file: on simulated towns with every normal turned inward
/// it brings back all but half a point of what right signs give. It needs pulses that were measured: assumed vertical
/// ones never see walls, and signs by up and by the vote of roof and ground ([`belvedere::normals::Orientation::Up`])
/// are better with them.
///
/// `index` must have been built from the positions of `oriented`.
///
/// # Errors
/// [`Error::InvalidParameter`] for parameters out of range, [`Error::LengthMismatch`] where the index holds another
/// number of points, what [`OrientedCloud::new`] refuses, and [`Error::Cancelled`].
///
/// # Source
/// This project's own.
pub fn orient_by_carving(
    oriented: &OrientedCloud,
    index: &NeighborIndex,
    free_segments: &FreeSegments,
    params: &OrientByCarvingParams,
    control: &Control<'_>,
) -> Result<(OrientedCloud, OrientByCarvingReport)> {
    if !(params.penetration > 0.0 && params.penetration < params.initial_radius && params.initial_radius <= 1e5) {
        let value = format!("{} of {}", params.penetration, params.initial_radius);
        return Err(Error::InvalidParameter {
            parameter: Parameter::Penetration,
            value,
            expected: "above 0 and below the initial radius",
        });
    }
    if !(params.min_ratio >= 1.0) {
        let value = params.min_ratio.to_string();
        return Err(Error::InvalidParameter { parameter: Parameter::RadiusRatio, value, expected: "at least 1" });
    }
    let (positions, count) = (oriented.positions(), oriented.len());
    if index.len() != count {
        return Err(Error::LengthMismatch { what: "neighbour index", expected: count, found: index.len() });
    }
    let needs_test = |row: usize| {
        let is_unsure = params.min_confidence >= 1.0 || oriented.confidence()[row] < params.min_confidence;
        is_unsure && oriented.normals()[row] != [0.0; 3]
    };
    // neighbours one after the other: their searches share the cache
    let tested: Vec<u32> = index.tree_order().iter().copied().filter(|&row| needs_test(row as usize)).collect();
    let radius = |point: [f32; 3], inward: [f32; 3]| {
        let tangent = Tangent { point, inward, margin: params.penetration };
        let most = params.initial_radius - params.penetration;
        let by_points = index.smallest_tangent_ball(&tangent, most).map_or(most, |(radius, _)| radius);
        free_segments.smallest_tangent_ball(&tangent, by_points).unwrap_or(by_points)
    };
    let stop = Stop::new(control);
    let flipped: Vec<u32> = tested
        .par_iter()
        .copied()
        .filter(|&row| {
            if stop.is_set() {
                return false;
            }
            let (point, normal) = (positions[row as usize], oriented.normals()[row as usize]);
            let [inside, outside] = [normal.map(|v| -v), normal].map(|inward| radius(point, inward));
            outside > inside * params.min_ratio
        })
        .collect();
    stop.check()?;
    let mut normals = oriented.normals().to_vec();
    for &row in &flipped {
        normals[row as usize] = normals[row as usize].map(|v| -v);
    }
    let report = OrientByCarvingReport { tested: tested.len(), flipped: flipped.len() };
    let turned =
        OrientedCloud::new(positions.to_vec(), normals, oriented.quality().to_vec(), oriented.confidence().to_vec())?;
    Ok((turned.with_place(oriented.origin(), oriented.crs().clone()), report))
}
