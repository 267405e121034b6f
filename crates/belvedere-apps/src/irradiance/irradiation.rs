//! The energy that planes get over a period.

use super::period::{PeriodRadiation, Surroundings};
use crate::rows::{RowBlock, check_normals, fold_rows, normals_of};
use belvedere_core::query::{MedialScene, VisibilityMatrix};
use belvedere_data::Result;
use belvedere_data::control::Control;
use belvedere_data::error::check_length;
use belvedere_data::vector::dot;
use rayon::prelude::*;

/// Targets handed to a thread at once.
const CHUNK: usize = 64;
/// Height, as a sine, below which patches of the sky represent its horizon: Perez et al. 1990 take a band of 6.5
/// degrees.
const HORIZON_BAND: f64 = 0.1132;

/// Energy that a plane gets over a period, kWh/m².
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Irradiation {
    /// Straight from the sun.
    pub beam: f64,
    /// Radiation of the sky, with the part around the sun.
    pub diffuse: f64,
    /// Radiation of the ground, and of the obstacles before the sky if these reflect.
    pub reflected: f64,
    /// Radiation without obstacles, kWh/m².
    pub unshaded: f64,
}

impl Irradiation {
    /// All that arrives, kWh/m².
    #[must_use]
    pub fn total(&self) -> f64 {
        self.beam + self.diffuse + self.reflected
    }

    /// Lost share of the energy that would arrive without obstacles, 0 to 1; 0 where none would arrive.
    #[must_use]
    pub fn loss(&self) -> f64 {
        if self.unshaded > 0.0 { (1.0 - self.total() / self.unshaded).clamp(0.0, 1.0) } else { 0.0 }
    }

    pub(super) fn unknown() -> Self {
        Self { beam: f64::NAN, diffuse: f64::NAN, reflected: f64::NAN, unshaded: f64::NAN }
    }

    fn add(&mut self, other: &Self) {
        self.beam += other.beam;
        self.diffuse += other.diffuse;
        self.reflected += other.reflected;
        self.unshaded += other.unshaded;
    }

    pub(super) fn scaled(mut self, factor: f64) -> Self {
        for value in [&mut self.beam, &mut self.diffuse, &mut self.reflected, &mut self.unshaded] {
            *value *= factor;
        }
        self
    }

    /// The sum over groups.
    #[must_use]
    pub fn sum(groups: &[Self]) -> Self {
        groups.iter().fold(Self::default(), |mut sum, group| {
            sum.add(group);
            sum
        })
    }
}

/// The energy of each of `targets`, (M, 3) local metres, among the balls of `scene`: rows as those of [`irradiation`],
/// NaN for a target that is not finite. Progress counts targets.
///
/// # Errors
/// Those of [`fold_rows`] and [`irradiation`].
pub fn scene_irradiation(
    scene: &MedialScene,
    targets: &[[f32; 3]],
    normals: Option<&[[f32; 3]]>,
    radiation: &PeriodRadiation,
    control: &Control<'_>,
) -> Result<Vec<Irradiation>> {
    check_normals(normals, targets.len())?;
    let mut sums = Vec::with_capacity(targets.len() * radiation.group_count());
    fold_rows(scene.into(), targets, &radiation.directions(), control, |block| {
        sums.extend(irradiation(&block.matrix, normals_of(normals, &block.rows), radiation)?);
        Ok(())
    })?;
    for (sums, target) in sums.chunks_mut(radiation.group_count()).zip(targets) {
        if !target.iter().all(|v| v.is_finite()) {
            sums.fill(Irradiation::unknown());
        }
    }
    Ok(sums)
}

/// The energy of each target of `matrix`, whose directions must be those of [`PeriodRadiation::directions`]: (M) rows
/// of [`PeriodRadiation::group_count`] sums each, row by row. `normals`, (M, 3) unit vectors, tilt the targets; `None`
/// for level ones. A target without a normal, (0, 0, 0), or whose normal is not finite gets NaN.
///
/// # Errors
/// [`Error::LengthMismatch`](belvedere_data::Error::LengthMismatch) where matrix, directions and normals differ.
pub fn irradiation(
    matrix: &VisibilityMatrix,
    normals: Option<&[[f32; 3]]>,
    radiation: &PeriodRadiation,
) -> Result<Vec<Irradiation>> {
    each_target(matrix, normals, radiation, |target, normal, groups| {
        let light = |direction: usize| f64::from(u8::from(matrix.is_free(target, direction)));
        on_plane(radiation, normal, light, groups);
    })
}

/// Computes [`irradiation`] with light behind crowns weighted by the share that these let through, with this
/// [`factor`](crate::tree_light::CrownLight::factor).
///
/// # Errors
/// Those of [`irradiation`].
pub fn irradiation_through_crowns(
    block: &RowBlock<'_>,
    normals: Option<&[[f32; 3]]>,
    radiation: &PeriodRadiation,
    factor: f64,
) -> Result<Vec<Irradiation>> {
    if block.crowns.is_none() {
        return irradiation(&block.matrix, normals, radiation);
    }
    each_target(&block.matrix, normals, radiation, |target, normal, groups| {
        let light = block.light(target, factor);
        on_plane(radiation, normal, |direction| light.get(direction).copied().unwrap_or(0.0), groups);
    })
}

/// Calls `sum` with each target of `matrix`, its normal and its sums.
fn each_target(
    matrix: &VisibilityMatrix,
    normals: Option<&[[f32; 3]]>,
    radiation: &PeriodRadiation,
    sum: impl Fn(usize, [f64; 3], &mut [Irradiation]) + Sync,
) -> Result<Vec<Irradiation>> {
    check_length(
        "directions of sun and sky",
        radiation.sun_directions.len() + radiation.sky.directions.len(),
        matrix.direction_count(),
    )?;
    check_normals(normals, matrix.target_count())?;
    let mut sums = vec![Irradiation::default(); matrix.target_count() * radiation.group_count()];
    sums.par_chunks_mut(radiation.group_count()).enumerate().with_min_len(CHUNK).for_each(|(target, groups)| {
        let normal = normals.map_or([0.0, 0.0, 1.0], |normals| normals[target].map(f64::from));
        sum(target, normal, groups);
    });
    Ok(sums)
}

/// The energy of a plane with a unit `normal`, at which a share of the `light` of each direction arrives, by its row in
/// [`PeriodRadiation::directions`], for each group into `groups`.
pub(super) fn on_plane(
    radiation: &PeriodRadiation,
    normal: [f64; 3],
    light: impl Fn(usize) -> f64,
    groups: &mut [Irradiation],
) {
    if !(dot(normal, normal) > 0.5) {
        groups.fill(Irradiation::unknown());
        return;
    }
    groups.fill(Irradiation::default());
    add_sun(radiation, normal, &light, groups);
    let first = radiation.sun_directions.len();
    let (mut sky, mut horizon) = (SeenWeights::default(), SeenWeights::default());
    let group_count = groups.len();
    for (patch, (&direction, &solid_angle)) in
        radiation.sky.directions.iter().zip(&radiation.sky.solid_angles).enumerate()
    {
        let cosine = dot(direction, normal);
        let ahead = direction[0] * normal[0] + direction[1] * normal[1];
        let in_band = direction[2] < HORIZON_BAND && ahead > 0.0;
        if cosine <= 0.0 && !in_band {
            continue;
        }
        let light = light(first + patch);
        sky.add(cosine.max(0.0) * solid_angle, light);
        if in_band {
            horizon.add(ahead * solid_angle, light);
        }
        let of_patch = radiation.patches.get(patch * group_count..(patch + 1) * group_count).unwrap_or_default();
        for (sum, radiation) in groups.iter_mut().zip(of_patch) {
            let energy = radiation * cosine.max(0.0);
            sum.unshaded += energy;
            sum.diffuse += light * energy;
        }
    }
    // patches represent the share that is seen; what a free plane sees is known exactly
    let whole = f64::midpoint(1.0, normal[2]);
    let seen = whole * sky.share();
    let tilt_sine = (1.0 - normal[2] * normal[2]).max(0.0).sqrt();
    for (sum, evenly) in groups.iter_mut().zip(&radiation.evenly) {
        let reflected = radiation.params.albedo * evenly.global;
        sum.unshaded += evenly.even * whole + evenly.horizon * tilt_sine + reflected * (1.0 - whole);
        sum.diffuse += evenly.even * seen + evenly.horizon * tilt_sine * horizon.share();
        sum.reflected = match radiation.params.surroundings {
            Surroundings::Dark => reflected * (1.0 - whole),
            Surroundings::LikeGround => reflected * (1.0 - seen),
        };
        *sum = sum.scaled(0.001);
    }
}

/// Adds the energy from the sun and from the sky around it.
fn add_sun(radiation: &PeriodRadiation, normal: [f64; 3], light: impl Fn(usize) -> f64, groups: &mut [Irradiation]) {
    for share in &radiation.sun {
        let Some(sum) = groups.get_mut(share.group) else { continue };
        let (beam, around) = (dot(share.beam, normal).max(0.0), dot(share.around, normal).max(0.0));
        sum.unshaded += beam + around;
        if beam + around > 0.0 {
            let light = light(share.direction);
            sum.beam += light * beam;
            sum.diffuse += light * around;
        }
    }
}

/// Weights of all directions and of those seen.
#[derive(Clone, Copy, Default)]
struct SeenWeights {
    all: f64,
    seen: f64,
}

impl SeenWeights {
    fn add(&mut self, weight: f64, light: f64) {
        self.all += weight;
        self.seen += light * weight;
    }

    fn share(self) -> f64 {
        if self.all > 0.0 { self.seen / self.all } else { 0.0 }
    }
}
