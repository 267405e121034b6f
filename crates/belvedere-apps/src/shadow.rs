//! Shadow: light of the sun at a place, its disc taken as a point or as it is.

use crate::rows::{RowBlock, SkyObstacles, check_normals, fold_rows, normals_of};
use crate::targets::Targets;
use crate::tree_light::{Season, TreeLight};
use belvedere_core::query::{Answer, MedialScene, Viewer};
use belvedere_data::cast::to_f32;
use belvedere_data::control::Control;
use belvedere_data::error::check_length;
use belvedere_data::vector::{cross, dot, unit};
use belvedere_data::{Error, Result};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Angular radius of the sun's disc at its mean distance, radians: 959.63 arc seconds.
///
/// # Source
/// Auwers 1891, as the almanacs have it.
pub const SUN_RADIUS: f64 = 959.63 / 3600.0 * std::f64::consts::PI / 180.0;
/// Description of a raster of light.
pub const LIT: &str = "share of the sun, 0 in shadow";
/// Name of the measure that says which light is unproven.
pub const UNPROVEN: &str = "unproven";
/// Number of points that represent the disc of the sun: shares of light are multiples of 1/64.
const DISC_POINTS: usize = 64;
/// Targets handed to a thread at once.
const CHUNK: usize = 1024;
/// Targets whose lines of sight are proven by a thread at once: a few milliseconds.
const PROOF_CHUNK: usize = 512;

/// Hard or soft shadow edges.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Edges {
    /// The sun is a point: a place is lit or not.
    #[default]
    Hard,
    /// The sun is a disc of half a degree, of which a place sees a share. Edges are as wide as 1/107 of the distance to
    /// the object that casts them.
    Soft,
}

/// A sun whose light is computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadowSun {
    /// Unit vector from the scene to the sun: x east, y (grid) north, z up.
    pub to_sun: [f64; 3],
    /// The season, by which trees carry leaves; `None` where no date is known.
    pub season: Option<Season>,
}

impl ShadowSun {
    /// The sun at an azimuth clockwise from grid north and an elevation above the horizon, radians, on no date.
    #[must_use]
    pub fn at(azimuth: f64, elevation: f64) -> Self {
        Self { to_sun: belvedere_data::view::to_sun(azimuth, elevation), season: None }
    }
}

/// The share of each of `suns` that reaches each of `targets` among `obstacles`, 0 to 1, (suns) rows of (M); NaN for a
/// target without a position. Where crowns let light through, it is also less than 1 with hard edges. Progress counts
/// targets, once or twice each.
///
/// # Errors
/// Those of [`fold_rows`] and [`lit_shares`].
pub fn scene_shadow<'a>(
    obstacles: impl Into<SkyObstacles<'a>>,
    targets: &Targets,
    suns: &[ShadowSun],
    edges: Edges,
    control: &Control<'_>,
) -> Result<Vec<Vec<f32>>> {
    let obstacles = obstacles.into();
    let normals = targets.normals.as_deref();
    check_normals(normals, targets.len())?;
    let of_sun = |sun: &ShadowSun| {
        let mut points = sun_directions(sun.to_sun, edges);
        // nothing shines from below the horizon
        if points.iter().all(|point| point[2] <= 0.0) {
            points.clear();
        }
        points
    };
    let directions: Vec<Vec<[f64; 3]>> = suns.iter().map(of_sun).collect();
    let mut lit = vec![Vec::with_capacity(targets.len()); suns.len()];
    fold_rows(obstacles, &targets.positions, &directions.concat(), control, |block| {
        let normals = normals_of(normals, &block.rows);
        let mut first = 0;
        for ((lit, of_sun), sun) in lit.iter_mut().zip(&directions).zip(suns) {
            let factor = obstacles.crowns().map_or(0.0, |crowns| crowns.factor(sun.season));
            lit.extend(lit_shares(&block, (first, of_sun), normals, factor)?);
            first += of_sun.len();
        }
        Ok(())
    })?;
    lit.iter_mut().for_each(|shares| targets.clear_unasked(shares));
    Ok(lit)
}

/// Share of the light from which on a place counts as lit.
pub const HALF_LIGHT: f32 = 0.5;

/// 1 where half or more of the light arrives, else 0; NaN for NaN: a place behind crowns that were measured is lit or
/// not.
#[must_use]
pub fn half_or_more(share: f32) -> f32 {
    if share.is_nan() { share } else { f32::from(u8::from(share >= HALF_LIGHT)) }
}

/// The light of one sun with hard edges at each target: 1 for a target that is lit, 0 for one in shadow, NaN for one
/// without a position.
///
/// # Errors
/// Those of [`scene_shadow`].
pub fn shadow(scene: &MedialScene, targets: &Targets, sun: ShadowSun, control: &Control<'_>) -> Result<Vec<f32>> {
    Ok(scene_shadow(scene, targets, &[sun], Edges::Hard, control)?.pop().unwrap_or_default())
}

/// 1 for each of `targets` that `lit`, (M), says is lit, but whose line of sight to the sun the pulses of `scene` do
/// not prove; 0 for others. `None` for a scene that knows no pulses.
///
/// # Errors
/// [`Error::LengthMismatch`] unless there is a share for each target, and [`Error::Cancelled`].
pub fn unproven_light(
    scene: &MedialScene,
    targets: &Targets,
    sun: ShadowSun,
    lit: &[f32],
    control: &Control<'_>,
) -> Result<Option<Vec<f32>>> {
    if scene.proof().is_none() {
        return Ok(None);
    }
    check_length("shares of light", targets.len(), lit.len())?;
    let of_target = |(position, &lit): (&[f32; 3], &f32)| {
        let is_doubtful =
            lit > 0.0 && scene.answer_unblocked_towards(position.map(f64::from), sun.to_sun) == Answer::Unproven;
        f32::from(u8::from(is_doubtful))
    };
    let chunk = |(positions, lit): (&[[f32; 3]], &[f32])| {
        control.check()?;
        Ok(positions.iter().zip(lit).map(of_target).collect::<Vec<f32>>())
    };
    let chunks = targets.positions.par_chunks(PROOF_CHUNK).zip(lit.par_chunks(PROOF_CHUNK));
    Ok(Some(chunks.map(chunk).collect::<Result<Vec<_>>>()?.concat()))
}

/// Returns the probability that each target is lit by a sun with hard edges, 0 to 1, (M); NaN for one without a
/// position. A target that is turned away from the sun is certainly not lit.
///
/// # Errors
/// [`Error::LengthMismatch`] for normals that are not as many as targets, and those of
/// [`MedialScene::visible_probabilities`].
pub fn lit_probabilities(
    (scene, trees): (&MedialScene, Option<&TreeLight>),
    targets: &Targets,
    sun: ShadowSun,
    control: &Control<'_>,
) -> Result<Vec<f32>> {
    let viewer = Viewer::Direction(sun.to_sun);
    let found = match trees.and_then(|trees| Some((trees, trees.medium.as_deref()?))) {
        Some((trees, medium)) => {
            let crowns = (&*trees.opaque, medium, trees.crowns.factor(sun.season));
            scene.lit_probabilities(crowns, viewer, &targets.positions, control)?
        }
        None => scene.visible_probabilities(viewer, &targets.positions, control)?,
    };
    lit_before_sun(found, targets, sun)
}

/// Returns probabilities of a free line to the sun as those of being lit: 0 for targets that are turned away, and at
/// night.
///
/// # Errors
/// [`Error::LengthMismatch`] for normals that are not as many as targets.
pub(crate) fn lit_before_sun(mut found: Vec<f32>, targets: &Targets, sun: ShadowSun) -> Result<Vec<f32>> {
    let normals = targets.normals.as_deref();
    check_normals(normals, targets.len())?;
    for (row, probability) in found.iter_mut().enumerate().filter(|(_, probability)| !probability.is_nan()) {
        let is_before = normals.is_none_or(|normals| dot(normals[row].map(f64::from), sun.to_sun) > 0.0);
        if sun.to_sun[2] <= 0.0 || !is_before {
            *probability = 0.0;
        }
    }
    targets.clear_unasked(&mut found);
    Ok(found)
}

/// Directions that represent a sun in the direction of the unit vector `to_sun`: itself, or 64 points of equal shares
/// of its disc.
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

/// Returns the share of a sun that each target of `block` gets, 0 to 1, (M). `directions` represent the sun; the first
/// of them is column `first` of the block. Crowns have a [`factor`](crate::tree_light::CrownLight::factor). Directions
/// below the horizon give no light. Neither do those behind a target, by its outward normal, (M, 3); `None` if targets
/// have none.
///
/// # Errors
/// [`Error::LengthMismatch`] where the block has fewer columns, or normals are not as many as targets.
pub fn lit_shares(
    block: &RowBlock<'_>,
    (first, directions): (usize, &[[f64; 3]]),
    normals: Option<&[[f32; 3]]>,
    factor: f64,
) -> Result<Vec<f32>> {
    let matrix = &block.matrix;
    let (expected, found) = (first + directions.len(), matrix.direction_count());
    if found < expected {
        return Err(Error::LengthMismatch { what: "directions of the sun", expected, found });
    }
    check_normals(normals, matrix.target_count())?;
    let share = |target: usize| {
        let is_before = |(_, direction): &(usize, &[f64; 3])| {
            let is_before = normals.is_none_or(|normals| dot(normals[target].map(f64::from), **direction) > 0.0);
            direction[2] > 0.0 && is_before
        };
        let before = directions.iter().enumerate().filter(is_before);
        let light: f64 = before.map(|(column, _)| block.line(target, first + column).share(factor)).sum();
        to_f32(light / directions.len().max(1) as f64)
    };
    Ok((0..matrix.target_count()).into_par_iter().with_min_len(CHUNK).map(share).collect())
}
