//! The energy that planes get over a period.

use super::period::{PeriodRadiation, Surroundings};
use crate::rows::{check_normals, fold_rows, normals_of};
use belvedere_core::query::{MedialScene, VisibilityMatrix};
use belvedere_data::control::Control;
use belvedere_data::vector::dot;
use belvedere_data::{Error, Result};
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
    /// From the sky, the part from around the sun among it.
    pub diffuse: f64,
    /// From the ground, and from what hides the sky where that is taken to reflect.
    pub reflected: f64,
    /// What it would get if nothing stood before it.
    pub unshaded: f64,
}

impl Irradiation {
    /// All that arrives, kWh/m².
    #[must_use]
    pub fn total(&self) -> f64 {
        self.beam + self.diffuse + self.reflected
    }

    /// Share of what would arrive without obstacles that is lost, 0 to 1; 0 where nothing would arrive.
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

    /// What arrives where crowns of trees let `transmissivity`, 0 to 1, of the light through: `self` is what does where
    /// they let nothing through, `opaque` what does without them. Both are sums over directions, and so is all between.
    /// Strings limited by their worst cell are as well: what gets to all cells of one is the same share, or nothing, or
    /// all.
    #[must_use]
    pub fn through_crowns(&self, opaque: &Self, transmissivity: f64) -> Self {
        let between = |all: f64, opaque: f64| all + transmissivity * (opaque - all);
        Self {
            beam: between(self.beam, opaque.beam),
            diffuse: between(self.diffuse, opaque.diffuse),
            reflected: between(self.reflected, opaque.reflected),
            unshaded: self.unshaded,
        }
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
/// [`Error::LengthMismatch`] where matrix, directions and normals differ.
pub fn irradiation(
    matrix: &VisibilityMatrix,
    normals: Option<&[[f32; 3]]>,
    radiation: &PeriodRadiation,
) -> Result<Vec<Irradiation>> {
    let expected = radiation.sun_directions.len() + radiation.sky.directions.len();
    if matrix.direction_count() != expected {
        let found = matrix.direction_count();
        return Err(Error::LengthMismatch { what: "directions of sun and sky", expected, found });
    }
    let expected = matrix.target_count();
    if let Some(found) = normals.map(<[_]>::len).filter(|&found| found != expected) {
        return Err(Error::LengthMismatch { what: "normals of targets", expected, found });
    }
    let mut sums = vec![Irradiation::default(); expected * radiation.group_count()];
    sums.par_chunks_mut(radiation.group_count()).enumerate().with_min_len(CHUNK).for_each(|(target, groups)| {
        let normal = normals.map_or([0.0, 0.0, 1.0], |normals| normals[target].map(f64::from));
        on_plane(radiation, normal, |direction| matrix.is_free(target, direction), groups);
    });
    Ok(sums)
}

/// The energy of a plane with a unit `normal`, before which the directions that `is_free` tells, by their row in
/// [`PeriodRadiation::directions`], are free, for each group into `groups`.
pub(super) fn on_plane(
    radiation: &PeriodRadiation,
    normal: [f64; 3],
    is_free: impl Fn(usize) -> bool,
    groups: &mut [Irradiation],
) {
    if !(dot(normal, normal) > 0.5) {
        groups.fill(Irradiation::unknown());
        return;
    }
    groups.fill(Irradiation::default());
    add_sun(radiation, normal, &is_free, groups);
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
        let is_free = is_free(first + patch);
        sky.add(cosine.max(0.0) * solid_angle, is_free);
        if in_band {
            horizon.add(ahead * solid_angle, is_free);
        }
        let of_patch = radiation.patches.get(patch * group_count..(patch + 1) * group_count).unwrap_or_default();
        for (sum, radiation) in groups.iter_mut().zip(of_patch) {
            let energy = radiation * cosine.max(0.0);
            sum.unshaded += energy;
            if is_free {
                sum.diffuse += energy;
            }
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

/// Adds what comes from the sun and from the sky around it.
fn add_sun(radiation: &PeriodRadiation, normal: [f64; 3], is_free: impl Fn(usize) -> bool, groups: &mut [Irradiation]) {
    for share in &radiation.sun {
        let Some(sum) = groups.get_mut(share.group) else { continue };
        let (beam, around) = (dot(share.beam, normal).max(0.0), dot(share.around, normal).max(0.0));
        sum.unshaded += beam + around;
        if beam + around > 0.0 && is_free(share.direction) {
            sum.beam += beam;
            sum.diffuse += around;
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
    fn add(&mut self, weight: f64, is_free: bool) {
        self.all += weight;
        if is_free {
            self.seen += weight;
        }
    }

    fn share(self) -> f64 {
        if self.all > 0.0 { self.seen / self.all } else { 0.0 }
    }
}
