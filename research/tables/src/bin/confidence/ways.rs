//! Horizons and isovists: how often their intervals hold the truth.

use super::AnyResult;
use super::cases::{SurveyedTown, TownSurvey};
use belvedere::apps::horizon::{HorizonParams, horizon_intervals, horizons};
use belvedere::apps::isovist::{IsovistParams, isovist, isovist_intervals, isovist_of};
use belvedere::control::Control;
use belvedere::view::to_sun;
use belvedere_scenes::QuerySet;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Observers of each survey.
const OBSERVERS: usize = 30;
/// Azimuths of horizons.
const AZIMUTHS: usize = 72;
/// Elevations that are looked at for the true horizon, from the zenith to the nadir: a tenth of a degree apart.
const ELEVATIONS: usize = 1800;
/// Range at which isovists end, metres: the towns are 110 m wide.
const REACH: f64 = 40.0;

/// An interval, and the truth.
pub(super) struct WayCase {
    name: &'static str,
    interval: [f64; 2],
    truth: f64,
}

/// Horizons and isovists of people in a surveyed town, and the truth.
pub(super) fn cases(survey: &TownSurvey) -> AnyResult<Vec<WayCase>> {
    let surveyed = SurveyedTown::new(survey)?;
    let places = surveyed.town.site().targets(QuerySet::Pedestrians, OBSERVERS, survey.seed).positions;
    let local = |place: &[f64; 3]| surveyed.local(*place);
    let is_outside = |place: &&[f64; 3]| !surveyed.scene.is_inside_obstacle(local(place));
    let places: Vec<[f64; 3]> = places.iter().filter(is_outside).copied().collect();
    let eyes: Vec<[f64; 3]> = places.iter().map(local).collect();
    let mut cases = of_horizons(&surveyed, &places, &eyes)?;
    for (place, eye) in places.iter().zip(&eyes) {
        cases.extend(of_isovists(&surveyed, *place, *eye)?);
    }
    Ok(cases)
}

fn of_horizons(surveyed: &SurveyedTown, places: &[[f64; 3]], eyes: &[[f64; 3]]) -> AnyResult<Vec<WayCase>> {
    let none = Control::none();
    let params = HorizonParams::default().with_azimuth_count(AZIMUTHS);
    let skylines = horizons(&surveyed.scene, eyes, &params, &none)?;
    let intervals = horizon_intervals(&surveyed.scene, eyes, &skylines, &params, &none)?;
    let rows = places.par_iter().zip(intervals).flat_map_iter(|(place, of_eye)| {
        let case = |(azimuth, interval): (usize, [f64; 2])| {
            let elevation = |step: usize| FRAC_PI_2 * (1.0 - 2.0 * step as f64 / ELEVATIONS as f64);
            let azimuth = TAU * azimuth as f64 / AZIMUTHS as f64;
            let is_hidden =
                |step: &usize| surveyed.town.truth.occluded_towards(*place, to_sun(azimuth, elevation(*step)));
            let truth = (0..=ELEVATIONS).find(is_hidden).map_or(-FRAC_PI_2, elevation);
            // towns end in nothing, so that what is below the horizon is no horizon
            let [low, high] = interval.map(|end| end.to_degrees().max(0.0));
            // half a step of the truth
            let step = 0.5 * 180.0 / ELEVATIONS as f64;
            WayCase {
                name: "elevation of the horizon, degrees",
                interval: [low - step, high + step],
                truth: truth.to_degrees().max(0.0),
            }
        };
        of_eye.into_iter().enumerate().map(case).collect::<Vec<_>>()
    });
    Ok(rows.collect())
}

fn of_isovists(surveyed: &SurveyedTown, place: [f64; 3], eye: [f64; 3]) -> AnyResult<Vec<WayCase>> {
    let none = Control::none();
    let params = IsovistParams::default().with_max_range(REACH).with_step(2f64.to_radians());
    let seen = isovist(&surveyed.scene, eye, &params, &none)?;
    let Some(found) = isovist_intervals(&surveyed.scene, eye, &seen, &params, &none)? else { return Ok(Vec::new()) };
    let range = |direction: [f64; 3]| surveyed.town.truth.first_hit(place, direction, REACH).map(|hit| hit.range);
    let truth = isovist_of(&range, &params, &none)?;
    Ok(vec![
        WayCase { name: "area of the plan, m²", interval: found.plan_area, truth: truth.plan.area },
        WayCase { name: "volume seen, m³", interval: found.volume, truth: truth.volume },
    ])
}

/// Prints how often intervals hold the truth, and how wide they are.
pub(super) fn judge(cases: &[WayCase]) {
    println!(
        "\n| what | cases | held by the interval, % | truth below it, % | above it, % | mean width | mean truth |"
    );
    println!("|---|---|---|---|---|---|---|");
    let mut by_name: BTreeMap<&str, Vec<&WayCase>> = BTreeMap::new();
    cases.iter().for_each(|case| by_name.entry(case.name).or_default().push(case));
    for (name, cases) in by_name {
        let mean = |of: &dyn Fn(&WayCase) -> f64| cases.iter().map(|case| of(case)).sum::<f64>() / cases.len() as f64;
        let share = |is: &dyn Fn(&WayCase) -> bool| 100.0 * mean(&|case| f64::from(u8::from(is(case))));
        let below = share(&|case| case.truth < case.interval[0]);
        let above = share(&|case| case.truth > case.interval[1]);
        println!(
            "| {name} | {} | {:.1} | {below:.1} | {above:.1} | {:.2} | {:.2} |",
            cases.len(),
            100.0 - below - above,
            mean(&|case| case.interval[1] - case.interval[0]),
            mean(&|case| case.truth)
        );
    }
}
