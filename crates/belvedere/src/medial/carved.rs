//! The model that Belvedere answers from: balls cut by pulses, and the rules for what balls alone represent badly.

use super::balls::{MedialBalls, Side};
use super::bounds::{KindBounds, RadiusBounds, kinds};
use super::carve::{CarveReport, carve};
use super::shrinking_ball::{ShrinkMethod, ShrinkParams, ShrinkReport, shrink};
use super::thin_surfaces::{ThinSurfaceParams, on_thin_surfaces};
use crate::neighbors::NeighborIndex;
use crate::normals::OrientedCloud;
use crate::progress::Progress;
use crate::pulses::Needles;
use crate::{Attributes, Result};

/// How carved balls are made. Every rule that is `Some` is applied; [`CarvedParams::default`] applies those that the comparison
/// of docs/methods/carving.md shows to earn their place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CarvedParams {
    /// Depth to which a point or a pulse may enter a ball, metres, above 0. Default 0.02: a penetration of 0.05 m costs 1.3
    /// points on facades.
    pub penetration: f32,
    /// Radius every ball starts with, metres. Default 5: 15 m answer the same, cost 40 % more a query and bulge farther where
    /// no pulse passes; 3 m let 1.2 points more of the shade of streets through.
    pub initial_radius: f32,
    /// Most radius of any ball, metres, above 0; +∞, the default, for no limit but those that pulses and rules set.
    pub max_radius: f32,
    /// Bounds by kind of point.
    pub kind_bounds: KindBounds,
    /// Small balls at surfaces that pulses run below.
    pub thin_surfaces: Option<ThinSurfaceParams>,
}

impl Default for CarvedParams {
    fn default() -> Self {
        Self {
            penetration: 0.02,
            initial_radius: 5.0,
            max_radius: f32::INFINITY,
            kind_bounds: KindBounds::default(),
            thin_surfaces: Some(ThinSurfaceParams::default()),
        }
    }
}

impl CarvedParams {
    /// How balls shrink before they are carved.
    #[must_use]
    pub fn shrinking(&self) -> ShrinkParams {
        ShrinkParams {
            method: ShrinkMethod::Tau { penetration: self.penetration },
            initial_radius: self.initial_radius,
            max_radius: self.max_radius,
        }
    }
}

/// What carved balls are made from. All columns have a row for each point.
#[derive(Clone, Copy)]
pub struct CarvedInput<'a> {
    /// Points and outward normals.
    pub oriented: &'a OrientedCloud,
    /// Index of the same points.
    pub index: &'a NeighborIndex,
    /// Class and return number are used where present.
    pub attributes: &'a Attributes,
    /// What the pulses prove empty.
    pub needles: &'a Needles,
}

/// What became of the balls in [`carved_balls`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CarvedReport {
    /// By the points.
    pub shrinking: ShrinkReport,
    /// By the pulses.
    pub carving: CarveReport,
    /// Points found on thin surfaces.
    pub thin: usize,
}

/// The interior balls of a survey as far as its pulses leave them, those alone that are of use. [`MedialBalls::source`] and
/// [`MedialBalls::touch`] are rows of the cloud.
///
/// # Errors
/// Those of [`shrink`] and [`carve`].
pub fn carved_balls(
    input: &CarvedInput<'_>,
    params: &CarvedParams,
    progress: Progress<'_>,
) -> Result<(MedialBalls, CarvedReport)> {
    let CarvedInput { oriented, index, attributes, needles } = *input;
    let kinds = kinds(attributes, oriented.len());
    let mut bounds = RadiusBounds::by_kind(&kinds, attributes, &params.kind_bounds);
    let mut report = CarvedReport::default();
    if let Some(params) = &params.thin_surfaces {
        let thin = on_thin_surfaces(oriented.positions(), &kinds, index, needles, params);
        for row in (0..thin.len()).filter(|&row| thin[row]) {
            bounds.limit(row, params.radius);
            report.thin += 1;
        }
    }
    let mut balls;
    (balls, report.shrinking) = shrink(oriented, index, Side::Interior, &params.shrinking(), progress)?;
    report.carving = carve(&mut balls, oriented, needles, params.penetration, &bounds)?;
    Ok((balls.shrunk(), report))
}
