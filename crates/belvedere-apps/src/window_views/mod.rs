//! The view from windows: how much of it is sky, vegetation, water, buildings and ground, and how far it reaches.

mod names;
mod seen;

pub use names::{NamedView, named_columns, views_by_name};
pub use seen::{ClassMeanings, SeenKind, are_made_from, balls_seen};

use crate::eyes::skip_unfit_eyes;
use crate::rows::check_normals;
use crate::sky_view::SkyDirections;
use crate::targets::{Measure, Targets};
use belvedere_core::query::{Blocker, MedialScene};
use belvedere_data::control::Control;
use belvedere_data::vector::{dot, to_f32};
use belvedere_data::{Error, Result};
use rayon::prelude::*;

/// Number of directions before a window unless said otherwise: shares err by less than half a percent.
pub const VIEW_DIRECTIONS: usize = 1000;
/// Longest side of a piece of a face that is a window unless said otherwise, metres: views change little over a window.
pub const VIEW_SPACING: f64 = 2.0;
/// A face whose normal rises or falls by more than this, as a sine, is a roof or a floor and no facade: 45°.
const STEEPEST_NORMAL: f32 = std::f32::consts::FRAC_1_SQRT_2;
/// Number of kinds of surfaces seen.
const KINDS: usize = SeenKind::ALL.len();

/// View from one window. All is NaN for a window without a position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindowView {
    /// Share of the half space before the window that is each of [`SeenKind::ALL`], by solid angle, 0 to 1; 1 together.
    pub shares: [f64; KINDS],
    /// The same, weighted by the cosine to the normal of the window, as light arrives through it; 1 together.
    pub cosine_shares: [f64; KINDS],
    /// Mean range of the surfaces seen, metres, by solid angle; sky, places beyond the cloud and far terrain do not
    /// count. NaN without a surface.
    pub mean_range: f64,
    /// Half of the solid angle of the things seen is nearer than this, metres; NaN where no thing is seen.
    pub median_range: f64,
    /// Share of the half space that is seen through space that no pulse came near to, 0 to 1, whatever is seen there; 0
    /// where pulses are not known.
    pub unproven: f64,
}

/// Kinds of balls and meshes.
#[derive(Clone, Copy, Debug)]
pub struct Kinds<'a> {
    /// Kind of each ball of the model, (B), as [`balls_seen`] has it.
    pub balls: &'a [SeenKind],
    /// Kind of each mesh that was added, by its number; a building where nothing is said.
    pub meshes: &'a [SeenKind],
}

/// `count` directions of the upper half of the sphere as [`SkyDirections::even`] has them, and their opposites: before
/// every window lie `count` of them, each with the same solid angle.
///
/// # Errors
/// Those of [`SkyDirections::even`].
pub fn view_directions(count: usize) -> Result<Vec<[f64; 3]>> {
    let mut directions = SkyDirections::even(count)?.directions;
    directions.extend_from_within(..);
    directions[count..].iter_mut().for_each(|direction| *direction = direction.map(|v| -v));
    Ok(directions)
}

/// Computes the view of each of the groups of `targets`, windows with normals, in `scene`. `directions` are unit
/// vectors of equal solid angle ([`view_directions`]); those behind the plane of a window do not count. Places of a
/// window count by their weight. Progress counts targets.
///
/// # Errors
/// [`Error::UnsupportedTargets`] for targets without normals, [`Error::LengthMismatch`] unless each target has one and
/// each ball has a kind, and [`Error::Cancelled`].
///
/// # Source
/// This project's own. Laser scans for the value of homes: Helbich, Jochem, Mücke & Höfle 2013, Computers, Environment
/// and Urban Systems 39.
pub fn window_views(
    scene: &MedialScene,
    targets: &Targets,
    kinds: Kinds<'_>,
    directions: &[[f64; 3]],
    control: &Control<'_>,
) -> Result<Vec<WindowView>> {
    let Some(normals) = &targets.normals else {
        let what = "the view from a window needs the direction that it looks to";
        return Err(Error::UnsupportedTargets { method: "window views", what });
    };
    check_normals(Some(normals), targets.len())?;
    check_kinds(scene, kinds.balls)?;
    let of_group = |group: &std::ops::Range<usize>| {
        let mut sums = Sums::default();
        for row in group.clone() {
            control.check()?;
            if let (true, Some(&place), Some(&normal)) =
                (targets.is_target(row), targets.positions.get(row), normals.get(row))
            {
                let window = (place.map(f64::from), normal.map(f64::from));
                sums.add(scene, window, targets.weight(row), kinds, directions);
            }
            control.advance(1);
        }
        Ok(sums.into_view())
    };
    targets.groups.par_iter().map(of_group).collect()
}

/// Leaves out the targets of a mesh that are no facade: roofs, floors, and all else nearer to level than to upright.
/// Returns how many.
pub fn leave_out_level(targets: &mut Targets) -> usize {
    let Targets { positions, normals, .. } = targets;
    let is_level = |normal: &[f32; 3]| !(normal[2].abs() <= STEEPEST_NORMAL);
    let level = positions.iter_mut().zip(normals.iter().flatten()).filter(|(_, normal)| is_level(normal));
    level.map(|(position, _)| *position = [f32::NAN; 3]).count()
}

/// Leaves out the targets that lie deep in an obstacle and have no view: a window lies on a wall, whose balls reach a
/// little beyond it. Returns how many.
///
/// # Errors
/// [`Error::Cancelled`].
pub fn leave_out_walled_up(targets: &mut Targets, scene: &MedialScene, control: &Control<'_>) -> Result<usize> {
    let mut places: Vec<[f64; 3]> = targets.positions.iter().map(|place| place.map(f64::from)).collect();
    let report = skip_unfit_eyes(scene, None, &mut places, control)?;
    for skipped in &report.faults {
        targets.positions[skipped.row] = [f32::NAN; 3];
    }
    Ok(report.skipped_inside_obstacle)
}

/// The figures of windows as measures: shares in percent, ranges in metres. Cosine-weighted shares have names that end
/// in `_cos`; unproven shares are left out where `proof` says that lines of sight were not tested with pulses.
#[must_use]
pub fn view_measures(views: &[WindowView], proof: Proving) -> Vec<Measure> {
    let percent = Some([0.0, 100.0]);
    let mut measures = Vec::new();
    let mut push = |name: String, description, decimals, range, value: &dyn Fn(&WindowView) -> f64| {
        let values = views.iter().map(|view| to_f32(value(view))).collect();
        let measure = Measure::new(&name, values).with_description(description).with_decimals(decimals);
        measures.push(measure.with_unit(if range == percent { "%" } else { "m" }).with_range(range));
    };
    for (i, seen) in SeenKind::ALL.into_iter().enumerate() {
        push(seen.name().to_owned(), "percent of the view", 3, percent, &|view| 100.0 * view.shares[i]);
    }
    for (i, seen) in SeenKind::ALL.into_iter().enumerate() {
        let name = format!("{}_cos", seen.name());
        push(name, "percent, cosine-weighted", 3, percent, &|view| 100.0 * view.cosine_shares[i]);
    }
    push("mean_range_m".to_owned(), "mean range of things seen", 2, None, &|view| view.mean_range);
    push("median_range_m".to_owned(), "median range of things seen", 2, None, &|view| view.median_range);
    if proof == Proving::Tested {
        push("unproven".to_owned(), "percent of the view not proven", 3, percent, &|view| 100.0 * view.unproven);
    }
    measures
}

/// Choice to test lines of sight with pulses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Proving {
    /// They were.
    Tested,
    /// They were not, or are not known.
    NotTested,
}

/// Sums over the places of a window.
#[derive(Default)]
struct Sums {
    weights: [f64; KINDS],
    cosines: [f64; KINDS],
    unproven: f64,
    /// Range and weight of each thing seen.
    ranges: Vec<(f64, f64)>,
}

impl Sums {
    /// Adds one place of a window with its normal.
    fn add(
        &mut self,
        scene: &MedialScene,
        (place, normal): ([f64; 3], [f64; 3]),
        weight: f64,
        kinds: Kinds<'_>,
        directions: &[[f64; 3]],
    ) {
        for &direction in directions {
            let cosine = dot(normal, direction);
            if !(cosine > 0.0) {
                continue;
            }
            let (seen, range, is_unproven) = match scene.seen_from_surface(place, direction) {
                Some((blocker, range)) => {
                    let kind = match blocker {
                        Blocker::Ball(row) => kinds.balls.get(row).copied().unwrap_or_default(),
                        Blocker::Mesh(number) => kinds.meshes.get(number).copied().unwrap_or(SeenKind::Building),
                        Blocker::Patch(_) => SeenKind::Building,
                        Blocker::Terrain => SeenKind::Ground,
                    };
                    (kind, range, scene.is_unproven(place, direction, range))
                }
                None => {
                    let seen = if scene.far_terrain().hides(place, direction) {
                        SeenKind::Ground
                    } else if direction[2] >= 0.0 {
                        SeenKind::Sky
                    } else {
                        SeenKind::Beyond
                    };
                    (seen, f64::INFINITY, scene.is_unproven(place, direction, f64::INFINITY))
                }
            };
            self.weights[seen as usize] += weight;
            self.cosines[seen as usize] += weight * cosine;
            if range < f64::INFINITY {
                self.ranges.push((range, weight));
            }
            if is_unproven {
                self.unproven += weight;
            }
        }
    }

    fn into_view(mut self) -> WindowView {
        let share_of = |parts: [f64; KINDS]| {
            let whole: f64 = parts.iter().sum();
            parts.map(|part| part / whole)
        };
        let whole: f64 = self.weights.iter().sum();
        let things: f64 = self.ranges.iter().map(|(_, weight)| weight).sum();
        let mean = self.ranges.iter().map(|(range, weight)| range * weight).sum::<f64>() / things;
        self.ranges.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut nearer = 0.0;
        let median = self.ranges.iter().find(|(_, weight)| {
            nearer += weight;
            2.0 * nearer >= things
        });
        WindowView {
            shares: share_of(self.weights),
            cosine_shares: share_of(self.cosines),
            mean_range: mean,
            median_range: median.map_or(f64::NAN, |(range, _)| *range),
            unproven: self.unproven / whole,
        }
    }
}

/// Checks that each ball of a scene has a kind.
pub(crate) fn check_kinds(scene: &MedialScene, kinds: &[SeenKind]) -> Result<()> {
    let (expected, found) = (scene.tree().rows().iter().map(|&row| row as usize + 1).max().unwrap_or(0), kinds.len());
    if found < expected { Err(Error::LengthMismatch { what: "kinds of balls", expected, found }) } else { Ok(()) }
}
