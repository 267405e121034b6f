//! The energy of planes of roofs, cell by cell.

use super::intervals::EnergyOutlines;
use super::irradiation::Irradiation;
use super::seasons::{SeasonRadiation, add, group_count};
use super::strings::{PlaneIrradiation, PlaneLight, plane_irradiation};
use crate::roof_planes::RoofPlane;
use crate::rows::{BLOCK_BITS, Obstacles, RowBlock, fold_blocks};
use crate::sum_errors::{Intervals, SumError, SumKind, class_of};
use crate::targets::TARGET_LIFT;
use belvedere_core::query::MedialScene;
use belvedere_data::Result;
use belvedere_data::control::Control;
use belvedere_data::vector::{length, sub, to_f32};

/// Energy of a plane over a period.
#[derive(Clone, Debug, PartialEq)]
pub struct RoofIrradiation {
    /// Mean of its cells over the whole period, kWh/m²: panels that each work for themselves.
    pub mean: Irradiation,
    /// The same where a row of cells gets only the light that all of its cells get at once: strings without bypass
    /// diodes.
    pub string_limited: Irradiation,
    /// Energy in each group of the period, kWh/m²: 12 months, or the whole.
    pub groups: Vec<f64>,
    /// Light of each direction, for each season.
    pub light: Vec<PlaneLight>,
    /// Cells that count: those of the plane that see anything of the sky.
    pub cell_count: usize,
    /// Error class of the mean ([`SumKind::Plane`]); `None` if not requested.
    pub class: Option<u8>,
}

impl RoofIrradiation {
    /// The expected mean of the cells, and the ends of the interval that holds 90 %, kWh/m²; NaN where that was not
    /// wanted.
    #[must_use]
    pub fn expected(&self) -> [f64; 3] {
        let error = self.class.map(|class| SumError::of(SumKind::Plane, class));
        error.map_or([f64::NAN; 3], |error| error.interval(self.mean.total(), self.mean.unshaded))
    }

    /// Area of the cells of `plane` that count, m².
    #[must_use]
    pub fn panel_area(&self, plane: &RoofPlane) -> f64 {
        self.cell_count as f64 * plane.cells.cell.powi(2)
    }

    /// The greatest share lost by shading, that of strings, 0 to 1.
    #[must_use]
    pub fn greatest_loss(&self) -> f64 {
        (1.0 - self.string_limited.total() / self.mean.unshaded.max(f64::MIN_POSITIVE)).clamp(0.0, 1.0)
    }
}

/// A place above a roof at the height of its panels, local metres.
#[must_use]
pub fn above_roof(place: [f64; 3], normal: [f64; 3]) -> [f32; 3] {
    [0, 1, 2].map(|i| to_f32(place[i] + TARGET_LIFT * normal[i]))
}

/// Returns the place at which the horizon of each of `planes` is measured, and true if obstacles of `scene` are above
/// all of its cells. The place is above the middle of the open cell nearest to the middle of the plane; without an open
/// cell, above the nearest cell. Under a ball, however small, the horizon is 90° all around.
#[must_use]
pub fn horizon_places(planes: &[RoofPlane], scene: &MedialScene) -> Vec<([f32; 3], bool)> {
    let of_plane = |plane: &RoofPlane| {
        let distance = |place: &[f64; 3]| length(sub(*place, plane.middle));
        let mut places: Vec<[f64; 3]> = plane.cells.middles().into_iter().map(|(place, _)| place).collect();
        places.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
        let places: Vec<[f32; 3]> = places.into_iter().map(|place| above_roof(place, plane.normal)).collect();
        let is_open = |place: &&[f32; 3]| {
            let place = place.map(f64::from);
            scene.enclosure(place).ball_count == 0 && scene.seen_from_surface(place, [0.0, 0.0, 1.0]).is_none()
        };
        match (places.iter().find(is_open), places.first()) {
            (Some(open), _) => (*open, true),
            (None, Some(first)) => (*first, false),
            (None, None) => (above_roof(plane.middle, plane.normal), false),
        }
    };
    planes.iter().map(of_plane).collect()
}

/// The energy of each of `planes` over all of `seasons` among `obstacles`. Progress counts planes.
///
/// # Errors
/// Those of [`crate::rows::fold_rows`] and [`plane_irradiation`]; [`belvedere_data::Error::NoPoints`] without any
/// season.
pub fn roof_irradiation<'a>(
    obstacles: impl Into<Obstacles<'a>>,
    planes: &[RoofPlane],
    seasons: &[SeasonRadiation],
    intervals: Intervals,
    control: &Control<'_>,
) -> Result<Vec<RoofIrradiation>> {
    let obstacles = obstacles.into();
    group_count(seasons)?;
    let directions = seasons.iter().map(|season| season.radiation.directions().len()).max().unwrap_or(1).max(1);
    let max_cells = BLOCK_BITS / (directions * obstacles.matrix_count());
    let mut found = Vec::with_capacity(planes.len());
    let mut rest = planes;
    while !rest.is_empty() {
        let (some, others) = rest.split_at(planes_at_once(rest, max_cells));
        found.extend(of_planes(obstacles, some, seasons, intervals, control)?);
        control.advance(some.len());
        rest = others;
    }
    Ok(found)
}

/// Returns the number of planes, from the first, that have at most `max_cells` cells together, at least one.
fn planes_at_once(planes: &[RoofPlane], max_cells: usize) -> usize {
    let mut cells = 0;
    let fits = |plane: &&RoofPlane| {
        cells += plane.cells.filled.values().iter().filter(|&&filled| filled).count();
        cells <= max_cells
    };
    planes.iter().take_while(fits).count().max(1)
}

fn of_planes(
    obstacles: Obstacles<'_>,
    planes: &[RoofPlane],
    seasons: &[SeasonRadiation],
    intervals: Intervals,
    control: &Control<'_>,
) -> Result<Vec<RoofIrradiation>> {
    let mut moved = vec![0.0_f64; planes.len()];
    let mut places = Vec::new();
    let mut strings: Vec<Vec<usize>> = Vec::new();
    for plane in planes {
        let cells = plane.cells.middles();
        places.extend(cells.iter().map(|(place, _)| above_roof(*place, plane.normal)));
        strings.push(cells.iter().map(|(_, string)| *string).collect());
    }
    let mut sums: Vec<PlaneIrradiation> = Vec::new();
    let mut light: Vec<Vec<PlaneLight>> = vec![Vec::with_capacity(seasons.len()); planes.len()];
    // progress counts planes, so that the rows of their cells count nothing
    let quiet = Quiet(control);
    for season in seasons {
        let directions = season.radiation.directions();
        let outlines = (intervals == Intervals::With).then(|| EnergyOutlines::new(&season.radiation));
        fold_blocks(obstacles.into(), &places, &directions, places.len().max(1), &Control::new(&quiet), |block| {
            let mut own = of_season(&block, planes, &strings, season)?;
            light.iter_mut().zip(&mut own).for_each(|(light, own)| light.push(std::mem::take(&mut own.light)));
            if let Some(outlines) = &outlines {
                let (mut first, free) = (0, block.free_lines(season.factor)?);
                for ((plane, strings), moved) in planes.iter().zip(&strings).zip(&mut moved) {
                    let cells = first..first + strings.len();
                    first = cells.end;
                    *moved = moved.max(outlines.moved_share_of_plane(&free, cells, plane.normal));
                }
            }
            if sums.is_empty() {
                sums = own;
            } else {
                for (sum, own) in sums.iter_mut().zip(&own) {
                    add(&mut sum.mean, &own.mean);
                    add(&mut sum.string_limited, &own.string_limited);
                }
            }
            Ok(())
        })?;
    }
    Ok(sums
        .iter()
        .zip(moved)
        .zip(light)
        .map(|((sum, moved), light)| RoofIrradiation {
            light,
            class: (intervals == Intervals::With).then(|| class_of(false, moved)),
            mean: Irradiation::sum(&sum.mean),
            string_limited: Irradiation::sum(&sum.string_limited),
            groups: sum.mean.iter().map(Irradiation::total).collect(),
            cell_count: sum.cell_count,
        })
        .collect())
}

fn of_season(
    block: &RowBlock<'_>,
    planes: &[RoofPlane],
    strings: &[Vec<usize>],
    season: &SeasonRadiation,
) -> Result<Vec<PlaneIrradiation>> {
    let mut first = 0;
    let mut found = Vec::with_capacity(planes.len());
    for (plane, strings) in planes.iter().zip(strings) {
        found.push(plane_irradiation(block, (first, strings), plane.normal, &season.radiation, season.factor)?);
        first += strings.len();
    }
    Ok(found)
}

/// Passes cancellation on, but no progress.
struct Quiet<'a>(&'a Control<'a>);

impl belvedere_data::control::Watcher for Quiet<'_> {
    fn is_cancelled(&self) -> bool {
        self.0.is_cancelled()
    }
}
