//! Exposure of routes and windows to sun and sky: the quantities of studies of thermal comfort, daylight and property
//! value.

use crate::rows::{check_normals, fold_rows, normals_of};
use crate::sky_view::{SkyDirections, SkyView, sky_view};
use crate::sun::SunSchedule;
use crate::sun_hours::{SunHours, SunHoursParams, sun_hours};
use crate::targets::{Measure, TARGET_LIFT, Targets, weighted_mean};
use belvedere_core::query::{MedialScene, VisibilityMatrix};
use belvedere_data::control::Control;
use belvedere_data::error::check_length;
use belvedere_data::vector::{cross, dot, to_f32, unit};
use belvedere_data::{Error, Parameter, Result};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Height above the ground of the targets of walkers, metres: the middle of a standing body, for which PET and UTCI
/// are defined (VDI 3787 part 2, 1.1 m).
pub const WALKER_HEIGHT: f64 = 1.1;
/// Metres between places along a route: a few steps.
pub const ROUTE_STEP: f64 = 2.0;
/// Number of targets along each side of a window that has a size.
const WINDOW_SIDE: u32 = 3;
/// Targets handed to a thread at once.
const CHUNK: usize = 256;

/// Returns the outward unit normal of a plane that faces `azimuth`, clockwise from grid north, tilted by `tilt` from
/// level, radians. A tilt of 0 faces up, π/2 is upright, more faces down.
#[must_use]
pub fn plane_normal(azimuth: f64, tilt: f64) -> [f64; 3] {
    [tilt.sin() * azimuth.sin(), tilt.sin() * azimuth.cos(), tilt.cos()]
}

/// Returns places that represent a window around `center`, local metres, a little in front of it along the unit normal
/// `normal`. They are nine, in the middles of equal parts of its width and height (`size`, metres), or its middle alone
/// if it has no size. The width is level.
///
/// # Errors
/// [`Error::InvalidParameter`] for a centre or normal that is not finite, or a size that is below zero or above 1000 m.
pub fn window_places(center: [f64; 3], normal: [f64; 3], size: Option<[f64; 2]>) -> Result<Vec<[f64; 3]>> {
    let Some(normal) = unit(normal).filter(|_| center.iter().all(|v| v.is_finite())) else {
        let expected = "finite, with a direction";
        return Err(Error::invalid(Parameter::Window, format!("at {center:?} looking to {normal:?}"), expected));
    };
    let Some(size) = size else {
        return Ok(vec![[0, 1, 2].map(|i| center[i] + TARGET_LIFT * normal[i])]);
    };
    if !size.iter().all(|v| (0.0..=1000.0).contains(v)) {
        return Err(Error::invalid(Parameter::Window, format!("of size {size:?} m"), "of size 0 to 1000 m"));
    }
    // a skylight that looks straight up has its width east
    let right = unit(cross([0.0, 0.0, 1.0], normal)).unwrap_or([1.0, 0.0, 0.0]);
    let up = cross(normal, right);
    let offset = |part: u32| (f64::from(part) + 0.5) / f64::from(WINDOW_SIDE) - 0.5;
    let mut places = Vec::new();
    for row in 0..WINDOW_SIDE {
        for column in 0..WINDOW_SIDE {
            let (across, above) = (offset(column) * size[0], offset(row) * size[1]);
            places.push([0, 1, 2].map(|i| center[i] + across * right[i] + above * up[i] + TARGET_LIFT * normal[i]));
        }
    }
    Ok(places)
}

/// Aggregate of a route or window over its places.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WholeIs {
    /// Their mean by weight.
    Mean,
    /// The least of them.
    Min,
    /// The greatest of them.
    Max,
}

/// Choice to keep the share of each group in shade for each sun.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum ShadeAtEachSun {
    /// No. Default.
    #[default]
    NotKept,
    /// Yes: one number for each group and direction.
    Kept,
}

/// Sun and sky at groups of targets.
#[derive(Clone, Debug, PartialEq)]
pub struct Exposure {
    /// `sky_view_factor`, `sky_openness`, for targets with normals `sky_component`, then `sun_hours`, `sun_share`,
    /// `first_light`, `last_light` and `longest`; each with its meaning for a group.
    pub measures: Vec<(Measure, WholeIs)>,
    /// For each group the share of its weight that each direction of the sun does not reach, (groups) rows of (D);
    /// empty unless kept.
    pub shaded_shares: Vec<Vec<f64>>,
}

impl Exposure {
    /// The values of a measure for each group of `targets`.
    #[must_use]
    pub fn of_groups(&self, number: usize, targets: &Targets) -> Vec<f64> {
        match self.measures.get(number) {
            Some((measure, WholeIs::Mean)) => targets.group_means(&measure.values),
            Some((measure, WholeIs::Min)) => targets.group_minima(&measure.values),
            Some((measure, WholeIs::Max)) => targets.group_maxima(&measure.values),
            None => Vec::new(),
        }
    }

    /// The mean over all groups, by their weight, of each measure that is a mean; without those that no group has.
    #[must_use]
    pub fn means(&self, targets: &Targets) -> Vec<(&Measure, f64)> {
        let weights = targets.group_weights();
        let means = self.measures.iter().enumerate().filter(|(_, (_, whole))| *whole == WholeIs::Mean);
        means
            .filter_map(|(number, (measure, _))| {
                Some((measure, weighted_mean(&self.of_groups(number, targets), &weights)?))
            })
            .collect()
    }
}

/// Computes the exposure of `targets`, routes or windows, to `sky` and to the suns of `schedule` in `scene`. Progress
/// counts targets, twice each.
///
/// # Errors
/// Those of [`fold_rows`], [`sky_view`], [`sky_component`] and [`sun_hours`].
pub fn scene_exposure(
    scene: &MedialScene,
    targets: &Targets,
    sky: &SkyDirections,
    schedule: &SunSchedule,
    shade: ShadeAtEachSun,
    control: &Control<'_>,
) -> Result<Exposure> {
    let normals = targets.normals.as_deref();
    check_normals(normals, targets.len())?;
    let mut seen = SkyView::default();
    let mut components = Vec::new();
    fold_rows(scene.into(), &targets.positions, &sky.directions, control, |block| {
        let normals = normals_of(normals, &block.rows);
        let own = sky_view(&block.matrix, sky, normals)?;
        seen.factors.extend(own.factors);
        seen.openness.extend(own.openness);
        if let Some(normals) = normals {
            components.extend(sky_component(&block.matrix, sky, normals)?);
        }
        Ok(())
    })?;
    let mut sun = SunHours::default();
    let mut shaded = match shade {
        ShadeAtEachSun::Kept => Some(Shaded::new(targets, schedule.directions.len())),
        ShadeAtEachSun::NotKept => None,
    };
    fold_rows(scene.into(), &targets.positions, &schedule.directions, control, |block| {
        let normals = normals_of(normals, &block.rows);
        sun.append(sun_hours(&block.matrix, schedule, normals, &SunHoursParams::default())?);
        if let Some(shaded) = &mut shaded {
            shaded.add(targets, block.rows.start, &block.matrix);
        }
        Ok(())
    })?;
    let mut measures = Vec::new();
    let mut push = |name: &str, description, (decimals, unit), mut values: Vec<f32>, whole| {
        targets.clear_unasked(&mut values);
        measures.push((
            Measure::new(name, values).with_description(description).with_unit(unit).with_decimals(decimals),
            whole,
        ));
    };
    push("sky_view_factor", "sky view factor, cosine", (4, "1"), seen.factors, WholeIs::Mean);
    push("sky_openness", "sky openness, solid angle", (4, "1"), seen.openness, WholeIs::Mean);
    if normals.is_some() {
        push("sky_component", "sky component, overcast sky", (4, "1"), components, WholeIs::Mean);
    }
    push("sun_hours", "hours of sun a day", (3, "h"), sun.hours, WholeIs::Mean);
    push("sun_share", "share of possible sun", (4, "1"), sun.share, WholeIs::Mean);
    push("first_light", "first sun, hour of the day", (3, "h"), sun.first, WholeIs::Min);
    push("last_light", "last sun, hour of the day", (3, "h"), sun.last, WholeIs::Max);
    push("longest", "longest uninterrupted sun, hours", (3, "h"), sun.longest, WholeIs::Mean);
    Ok(Exposure { measures, shaded_shares: shaded.map(|shaded| shaded.shares(targets)).unwrap_or_default() })
}

/// Weights of each group that each direction does not reach, added up target after target.
struct Shaded {
    /// (groups) rows of (D).
    sums: Vec<Vec<f64>>,
}

impl Shaded {
    fn new(targets: &Targets, direction_count: usize) -> Self {
        Self { sums: vec![vec![0.0; direction_count]; targets.groups.len()] }
    }

    /// Adds the rows of `matrix`, the first of which is that of target `first`.
    fn add(&mut self, targets: &Targets, first: usize, matrix: &VisibilityMatrix) {
        let end = first + matrix.target_count();
        self.sums.par_iter_mut().zip(&targets.groups).for_each(|(sums, group)| {
            for row in group.start.max(first)..group.end.min(end) {
                let weight = targets.weight(row);
                for (direction, sum) in sums.iter_mut().enumerate() {
                    if !matrix.is_free(row - first, direction) {
                        *sum += weight;
                    }
                }
            }
        });
    }

    fn shares(self, targets: &Targets) -> Vec<Vec<f64>> {
        let wholes = targets.group_weights();
        let of_group = |(sums, whole): (Vec<f64>, f64)| sums.into_iter().map(|sum| sum / whole).collect();
        self.sums.into_iter().zip(wholes).map(of_group).collect()
    }
}

/// Returns the sky component of each target of `matrix`, (M). This is the light that its plane (`normals`, (M, 3) unit
/// vectors) gets straight from an overcast sky, as a share of that on a free level plane. For upright planes it is the
/// vertical sky component; a free wall has 0.396, a free level plane 1. Light reflected by the ground and by facades is
/// not included.
///
/// # Errors
/// [`Error::LengthMismatch`] where matrix, sky and normals differ.
///
/// # Source
/// Moon & Spencer 1942, the overcast sky of CIE S 011: luminance 1 + 2 sin of the elevation, a third at the horizon.
/// Littlefair 2011, Site layout planning for daylight and sunlight, BRE 209, appendix C.
pub fn sky_component(matrix: &VisibilityMatrix, sky: &SkyDirections, normals: &[[f32; 3]]) -> Result<Vec<f32>> {
    check_length("directions of the sky", matrix.direction_count(), sky.directions.len())?;
    check_length("solid angles of the sky", matrix.direction_count(), sky.solid_angles.len())?;
    check_length("normals of targets", matrix.target_count(), normals.len())?;
    // of the zenith's luminance; a free level plane gets 7π/9 of it
    let luminances: Vec<f64> = sky.directions.iter().map(|direction| (1.0 + 2.0 * direction[2]) / 3.0).collect();
    let component = |(target, normal): (usize, &[f32; 3])| {
        let normal = normal.map(f64::from);
        let mut sum = 0.0;
        for (column, (&direction, &solid_angle)) in sky.directions.iter().zip(&sky.solid_angles).enumerate() {
            let cosine = dot(normal, direction);
            if cosine > 0.0 && matrix.is_free(target, column) {
                sum += cosine * solid_angle * luminances[column];
            }
        }
        to_f32(sum / (7.0 * PI / 9.0))
    };
    Ok(normals.par_iter().enumerate().with_min_len(CHUNK).map(component).collect())
}

/// The length of route that each of `places`, (N, 3) along it, represents, metres on the map: half the way to the place
/// before and half to the next, (N). A route of a single place has no length: its value is 1.
#[must_use]
pub fn route_lengths(places: &[[f64; 3]]) -> Vec<f64> {
    if places.len() == 1 {
        return vec![1.0];
    }
    let mut lengths = vec![0.0; places.len()];
    for (i, pair) in places.windows(2).enumerate() {
        let [a, b] = pair else { continue };
        let half = (b[0] - a[0]).hypot(b[1] - a[1]) / 2.0;
        lengths[i] += half;
        lengths[i + 1] += half;
    }
    lengths
}

/// Returns for each direction of `matrix` the share of `weights`, (M), whose targets do not see it free, (D). For suns
/// it is the share of a route in shade. NaN if the weights add up to nothing.
///
/// # Errors
/// [`Error::LengthMismatch`] unless there is a weight for each target.
pub fn shaded_shares(matrix: &VisibilityMatrix, weights: &[f64]) -> Result<Vec<f64>> {
    check_length("weights of targets", matrix.target_count(), weights.len())?;
    let whole: f64 = weights.iter().sum();
    let share = |direction: usize| {
        let shaded = weights.iter().enumerate().filter(|(target, _)| !matrix.is_free(*target, direction));
        shaded.map(|(_, weight)| weight).sum::<f64>() / whole
    };
    Ok((0..matrix.direction_count()).into_par_iter().map(share).collect())
}
