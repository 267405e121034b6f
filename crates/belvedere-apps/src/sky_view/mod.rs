//! Visible part of the sky: the sky view factor and sky openness, two figures that are often confused.

mod directions;

pub use directions::SkyDirections;

use crate::rows::{RowBlock, SkyObstacles, check_normals, fold_rows, normals_of};
use crate::sum_errors::{Intervals, Outlines, SumKind, expected_measures};
use crate::targets::{Measure, Targets};
use belvedere_core::query::VisibilityMatrix;
use belvedere_data::Result;
use belvedere_data::control::Control;
use belvedere_data::error::check_length;
use belvedere_data::vector::{dot, to_f32};
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};

/// Number of directions of [`SkyDirections::even`] unless said otherwise: errors of half a percent at most streets.
pub const SKY_DIRECTIONS: usize = 577;

/// Description of a raster of sky view factors.
pub const SKY_VIEW_FACTOR: &str = "sky view factor, cosine";

/// Targets handed to a thread at once.
const CHUNK: usize = 256;

/// Visible part of the sky of many targets.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SkyView {
    /// Cosine-weighted share of the sky, 0 to 1, (M): (1/π) ∫ V cos θ dΩ, θ being the angle to the target's normal. The
    /// share of the radiation of an even sky that arrives, as energy models want it. A free plane has 1, a free wall ½.
    pub factors: Vec<f32>,
    /// Share of the hemisphere above the horizon that is seen, 0 to 1, (M): (1/2π) ∫ V dΩ, whatever the normal. A free
    /// plane has 1, and a free wall ½ too.
    pub openness: Vec<f32>,
    /// Error classes; empty if not requested.
    pub classes: Vec<u8>,
}

impl SkyView {
    /// Both figures as measures.
    #[must_use]
    pub fn into_measures(self) -> Vec<Measure> {
        let measure = |name: &str, description, values| {
            Measure::new(name, values).with_description(description).with_range(Some([0.0, 1.0]))
        };
        let factor = measure("sky_view_factor", SKY_VIEW_FACTOR, self.factors);
        let openness = measure("sky_openness", "sky openness, solid angle", self.openness);
        let expected = match self.classes.is_empty() {
            true => Vec::new(),
            false => {
                let of = |stem, sums| expected_measures(stem, sums, |_| 1.0, SumKind::Sky, &self.classes);
                [of("factor", &factor), of("open", &openness)].concat()
            }
        };
        [vec![factor, openness], expected].concat()
    }
}

/// Computes the visible part of `sky` for each of `targets` among `obstacles`; NaN for a target without a position.
/// Trees that let light through are as measured, or in leaf if they were not, unless leaves are given. Progress counts
/// targets, once or twice each.
///
/// # Errors
/// Those of [`fold_rows`] and [`sky_view`].
pub fn scene_sky_view<'a>(
    obstacles: impl Into<SkyObstacles<'a>>,
    targets: &Targets,
    sky: &SkyDirections,
    intervals: Intervals,
    control: &Control<'_>,
) -> Result<SkyView> {
    let obstacles = obstacles.into();
    let normals = targets.normals.as_deref();
    check_normals(normals, targets.len())?;
    let mut seen = SkyView::default();
    let are_inside = intervals.are_inside(obstacles, targets, control)?;
    let outlines = are_inside.map(|are_inside| (are_inside, Outlines::new(&sky.directions, &sky.solid_angles)));
    let factor = obstacles.crowns().map_or(0.0, |crowns| crowns.factor(None));
    fold_rows(obstacles, &targets.positions, &sky.directions, control, |block| {
        if let Some((are_inside, outlines)) = &outlines {
            seen.classes.extend(outlines.classes((&block, factor), are_inside, normals)?);
        }
        let normals = normals_of(normals, &block.rows);
        let own = match obstacles.crowns() {
            Some(_) => sky_through_crowns(&block, sky, normals, factor)?,
            None => sky_view(&block.matrix, sky, normals)?,
        };
        seen.factors.extend(own.factors);
        seen.openness.extend(own.openness);
        Ok(())
    })?;
    targets.clear_unasked(&mut seen.factors);
    targets.clear_unasked(&mut seen.openness);
    Ok(seen)
}

/// Sums up which of the directions of `sky` each target of `matrix` sees. `normals`, (M, 3) unit vectors, tilt the
/// target for the sky view factor; `None` for level ones. Directions behind a tilted target count as unseen.
///
/// # Errors
/// [`Error::LengthMismatch`](belvedere_data::Error::LengthMismatch) where matrix, sky and normals differ.
pub fn sky_view(matrix: &VisibilityMatrix, sky: &SkyDirections, normals: Option<&[[f32; 3]]>) -> Result<SkyView> {
    sky_shares(matrix, sky, normals, |target, column| f64::from(u8::from(matrix.is_free(target, column))))
}

/// Computes [`sky_view`] with directions behind crowns weighted by the share that these let through, with this
/// [`factor`](crate::tree_light::CrownLight::factor).
///
/// # Errors
/// Those of [`sky_view`].
pub fn sky_through_crowns(
    block: &RowBlock<'_>,
    sky: &SkyDirections,
    normals: Option<&[[f32; 3]]>,
    factor: f64,
) -> Result<SkyView> {
    sky_shares(&block.matrix, sky, normals, |target, column| block.line(target, column).share(factor))
}

fn sky_shares(
    matrix: &VisibilityMatrix,
    sky: &SkyDirections,
    normals: Option<&[[f32; 3]]>,
    light: impl Fn(usize, usize) -> f64 + Sync,
) -> Result<SkyView> {
    check_length("directions of the sky", matrix.direction_count(), sky.directions.len())?;
    check_normals(normals, matrix.target_count())?;
    let shares: Vec<[f64; 2]> = (0..matrix.target_count())
        .into_par_iter()
        .with_min_len(CHUNK)
        .map(|target| {
            let normal = normals.map_or([0.0, 0.0, 1.0], |normals| normals[target].map(f64::from));
            let mut seen = [0.0, 0.0];
            for (column, (&direction, &solid_angle)) in sky.directions.iter().zip(&sky.solid_angles).enumerate() {
                let cosine = dot(normal, direction);
                if cosine > 0.0 {
                    let light = light(target, column);
                    seen[0] += light * cosine * solid_angle;
                    seen[1] += light * solid_angle;
                }
            }
            [seen[0] / PI, seen[1] / TAU]
        })
        .collect();
    let column = |i: usize| shares.iter().map(|share| to_f32(share[i])).collect();
    Ok(SkyView { factors: column(0), openness: column(1), classes: Vec::new() })
}
