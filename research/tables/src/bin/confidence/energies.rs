//! Energies of places and of planes of roofs: how far they are from the truth.

use super::AnyResult;
use super::cases::{SurveyedTown, TownSurvey};
use super::sums::{SETS, SumCase, TARGETS};
use belvedere::apps::irradiance::{
    ClearSky, Instant, IrradianceParams, Irradiation, PeriodRadiation, SeasonRadiation, above_roof, clear_instants,
    irradiation, plane_irradiation, roof_irradiation, season_irradiation,
};
use belvedere::apps::roof_planes::{RoofPlane, RoofPlaneParams, roof_planes};
use belvedere::apps::rows::RowBlock;
use belvedere::apps::sum_errors::{Intervals, SumKind};
use belvedere::apps::sun::{Site, Zone};
use belvedere::apps::targets::Targets;
use belvedere::cast::to_f32s;
use belvedere::control::Control;
use belvedere::frame::Frame;
use belvedere::query::VisibilityMatrix;
use belvedere::weather::{CalendarDay, Irradiance, unix_day};
use belvedere_scenes::QuerySet;

/// Latitude of the towns, degrees.
const LATITUDE_DEG: f64 = 52.0;
/// Steps of the year, seconds.
const STEP: f64 = 1800.0;
/// Share of the direct radiation of a clear sky that gets through usual clouds; as much again comes from all of the
/// sky.
const THROUGH_CLOUDS: f64 = 0.4;
/// Side of the panels of planes, metres, and cells of planes that count.
const PANEL: f64 = 2.0;
const MIN_CELLS: usize = 3;

/// A year under a clear sky, and one with clouds.
fn years() -> AnyResult<[PeriodRadiation; 2]> {
    let site = Site { latitude: LATITUDE_DEG.to_radians(), longitude: 0.09, height: 0.0, convergence: 0.0 };
    let ends = [2025, 2026].map(|year| CalendarDay::new(year, 1, 1).map(unix_day));
    let [Some(start), Some(end)] = ends else { return Err("no such year".into()) };
    let span = [start, end].map(|day| day as f64 * 86_400.0);
    let clear = clear_instants(&ClearSky::Ineichen { linke: 3.0 }, &site, span, STEP, &Zone::utc())?;
    let cloudy: Vec<Instant> = clear.iter().map(clouded).collect();
    let params = IrradianceParams::default().with_patch_division(1).with_sun_cell(4f64.to_radians());
    Ok([PeriodRadiation::gather(&clear, &params)?, PeriodRadiation::gather(&cloudy, &params)?])
}

fn clouded(clear: &Instant) -> Instant {
    let Irradiance { dni, dhi, .. } = clear.irradiance;
    let level = dni * clear.sun[2].max(0.0);
    let diffuse = dhi + level * THROUGH_CLOUDS;
    let irradiance = Irradiance { ghi: diffuse + level * THROUGH_CLOUDS, dni: dni * THROUGH_CLOUDS, dhi: diffuse };
    Instant { irradiance, ..*clear }
}

/// Energies of level places, of walls and of planes of roofs in a surveyed town, and the truth.
pub(super) fn cases(survey: &TownSurvey, surveyed: &SurveyedTown) -> AnyResult<Vec<SumCase>> {
    let mut cases = Vec::new();
    let planes = planes(surveyed)?;
    for (radiation, name) in years()?.into_iter().zip(["energy of a year, clear sky", "energy of a year, clouds"]) {
        for set in SETS {
            let found = surveyed.town.site().targets(set, TARGETS, survey.seed).positions;
            cases.extend(of_places((set, name), &found, &radiation, surveyed)?);
        }
        cases.extend(of_planes(name, &planes, &radiation, surveyed)?);
    }
    Ok(cases)
}

/// What is free in the exact town.
fn exact(places: &[[f64; 3]], directions: &[[f64; 3]], surveyed: &SurveyedTown) -> AnyResult<VisibilityMatrix> {
    let width = directions.len().div_ceil(64);
    let mut words = vec![0_u64; width * places.len()];
    for (number, direction) in directions.iter().enumerate() {
        let occluded = surveyed.town.truth.occluded_towards_each(places, *direction);
        for (row, occluded) in occluded.into_iter().enumerate() {
            words[row * width + number / 64] |= u64::from(!occluded) << (number % 64);
        }
    }
    Ok(VisibilityMatrix::from_words(places.len(), directions.len(), words)?)
}

fn of_places(
    (set, name): (QuerySet, &'static str),
    found: &[[f64; 3]],
    radiation: &PeriodRadiation,
    surveyed: &SurveyedTown,
) -> AnyResult<Vec<SumCase>> {
    let none = Control::none();
    let positions: Vec<[f64; 3]> = found.iter().map(|p| surveyed.local(*p)).collect();
    let mut targets = Targets::of_places(&positions, Frame::default());
    let truth = exact(found, &radiation.directions(), surveyed)?;
    if set == QuerySet::Facades {
        targets.normals = Some(outward(&truth, &radiation.directions()));
    }
    let seasons = [SeasonRadiation { radiation: radiation.clone(), factor: 0.0 }];
    let energies = season_irradiation(&surveyed.scene, &targets, &seasons, Intervals::With, &none)?;
    let exact = irradiation(&truth, targets.normals.as_deref(), radiation)?;
    let rows = energies.sums.iter().zip(&exact).zip(&energies.classes).filter(|((found, _), _)| found.unshaded > 0.0);
    let case = |((found, truth), class): ((&Irradiation, &Irradiation), &u8)| SumCase {
        kind: SumKind::Energy,
        name,
        set: Some(set),
        class: *class,
        found: found.total() / found.unshaded,
        truth: truth.total() / found.unshaded,
    };
    Ok(rows.map(case).collect())
}

/// The level normals of walls: where most of the sky is seen.
fn outward(truth: &VisibilityMatrix, directions: &[[f64; 3]]) -> Vec<[f32; 3]> {
    let of_row = |row: usize| {
        let free = directions.iter().enumerate().filter(|(number, _)| truth.is_free(row, *number));
        let [x, y] = free.fold([0.0, 0.0], |[x, y], (_, d)| [x + d[0], y + d[1]]);
        let length = x.hypot(y).max(1e-9);
        to_f32s([x / length, y / length, 0.0])
    };
    (0..truth.target_count()).map(of_row).collect()
}

/// The planes of the roofs of a survey.
fn planes(surveyed: &SurveyedTown) -> AnyResult<Vec<RoofPlane>> {
    let params = RoofPlaneParams::default().with_cell(PANEL);
    let planes = roof_planes(&surveyed.roof_points, &params, &Control::none())?;
    Ok(planes.into_iter().filter(|plane| plane.cells.count() >= MIN_CELLS).collect())
}

fn of_planes(
    name: &'static str,
    planes: &[RoofPlane],
    radiation: &PeriodRadiation,
    surveyed: &SurveyedTown,
) -> AnyResult<Vec<SumCase>> {
    let seasons = [SeasonRadiation { radiation: radiation.clone(), factor: 0.0 }];
    let found = roof_irradiation(&surveyed.scene, planes, &seasons, Intervals::With, &Control::none())?;
    let mut cases = Vec::new();
    for (plane, found) in planes.iter().zip(found) {
        let cells = plane.cells.middles();
        let at = |(middle, _): &([f64; 3], usize)| surveyed.town.absolute(above_roof(*middle, plane.normal));
        let places: Vec<[f64; 3]> = cells.iter().map(at).collect();
        let truth = exact(&places, &radiation.directions(), surveyed)?;
        let strings: Vec<usize> = cells.iter().map(|(_, string)| *string).collect();
        let block = RowBlock::from(truth);
        let exact = Irradiation::sum(&plane_irradiation(&block, (0, &strings), plane.normal, radiation, 0.0)?.mean);
        if let (Some(class), true) = (found.class, found.cell_count > 0 && exact.unshaded > 0.0) {
            cases.push(SumCase {
                kind: SumKind::Plane,
                name,
                set: None,
                class,
                found: found.mean.total() / found.mean.unshaded,
                truth: exact.total() / exact.unshaded,
            });
        }
    }
    Ok(cases)
}
