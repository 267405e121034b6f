//! Sums over directions: how far hours of sun and views of the sky are from the truth.

use super::cases::{SurveyedTown, TownSurvey};
use super::{AnyResult, energies};
use belvedere::apps::rows::RowBlock;
use belvedere::apps::sky_view::SkyDirections;
use belvedere::apps::sum_errors::{CLASSES, Outlines, SumKind, expected_measures};
use belvedere::apps::targets::{Measure, Targets};
use belvedere::cast::to_f32;
use belvedere::control::Control;
use belvedere::frame::Frame;
use belvedere_scenes::QuerySet;
use std::collections::BTreeSet;

/// Targets of each set.
pub(super) const TARGETS: usize = 400;
pub(super) const SETS: [QuerySet; 3] = [QuerySet::Pedestrians, QuerySet::Roofs, QuerySet::Facades];
/// Declination of the sun at the longest day; days between it and the shortest that represent a year; and the latitude,
/// degrees.
const MAX_DECLINATION_DEG: f64 = 23.4;
const DAYS_OF_YEAR: u16 = 13;
const LATITUDE_DEG: f64 = 52.0;
/// Suns of a whole day: one each ten minutes.
const STEPS: u16 = 144;
/// Fewer cases than this are no interval.
const MIN_CASES: usize = 50;

/// A sum of a target as a share of the greatest possible.
pub(super) struct SumCase {
    pub(super) kind: SumKind,
    /// What is summed up, for tables.
    pub(super) name: &'static str,
    /// `None` for planes of roofs.
    pub(super) set: Option<QuerySet>,
    pub(super) class: u8,
    pub(super) found: f64,
    pub(super) truth: f64,
}

/// Directions of one sum, and their weights.
struct Sum {
    kind: SumKind,
    name: &'static str,
    directions: Vec<[f64; 3]>,
    weights: Vec<f64>,
}

fn all_sums() -> AnyResult<Vec<Sum>> {
    let of_suns = |name, directions: Vec<[f64; 3]>| Sum {
        kind: SumKind::Sun,
        name,
        weights: vec![1.0; directions.len()],
        directions,
    };
    let day = |share: f64| suns(share * MAX_DECLINATION_DEG);
    // the shortest day, an equinox, the longest day, and a year
    let mut sums: Vec<Sum> = [-1.0, 0.0, 1.0].map(|share| of_suns("hours of sun of a day", day(share))).into();
    let days = (0..DAYS_OF_YEAR).map(|number| 2.0 * f64::from(number) / f64::from(DAYS_OF_YEAR - 1) - 1.0);
    sums.push(of_suns("hours of sun of a year", days.flat_map(day).collect()));
    let sky = SkyDirections::even(577)?;
    let cosines: Vec<f64> = sky.directions.iter().zip(&sky.solid_angles).map(|(d, angle)| d[2] * angle).collect();
    sums.push(Sum {
        kind: SumKind::Sky,
        name: "sky view factor",
        directions: sky.directions.clone(),
        weights: cosines,
    });
    sums.push(Sum { kind: SumKind::Sky, name: "sky openness", directions: sky.directions, weights: sky.solid_angles });
    Ok(sums)
}

/// The suns of a day above the horizon.
fn suns(declination_deg: f64) -> Vec<[f64; 3]> {
    let (latitude, declination) = (LATITUDE_DEG.to_radians(), declination_deg.to_radians());
    let sun = |step: u16| {
        let hour = ((f64::from(step) + 0.5) / f64::from(STEPS) - 0.5) * std::f64::consts::TAU;
        let east = -declination.cos() * hour.sin();
        let north = latitude.cos() * declination.sin() - latitude.sin() * declination.cos() * hour.cos();
        [east, north, latitude.sin() * declination.sin() + latitude.cos() * declination.cos() * hour.cos()]
    };
    (0..STEPS).map(sun).filter(|sun| sun[2] > 0.0).collect()
}

/// Sums over what targets of a surveyed town see, and the truth.
pub(super) fn cases(survey: &TownSurvey) -> AnyResult<Vec<SumCase>> {
    let surveyed = SurveyedTown::new(survey)?;
    let SurveyedTown { scene, town, .. } = &surveyed;
    let mut cases = energies::cases(survey, &surveyed)?;
    for set in SETS {
        let found = town.site().targets(set, TARGETS, survey.seed).positions;
        let positions: Vec<[f64; 3]> = found.iter().map(|p| surveyed.local(*p)).collect();
        let targets = Targets::of_places(&positions, Frame::default());
        let are_inside: Vec<bool> = positions.iter().map(|&place| scene.is_inside_obstacle(place)).collect();
        for Sum { kind, name, directions, weights } in all_sums()? {
            let outlines = Outlines::new(&directions, &weights);
            let matrix = scene.visibility_matrix(&targets.positions, &directions, &Control::none())?;
            let all: f64 = weights.iter().sum();
            let mut truths = vec![0.0; found.len()];
            for (direction, weight) in directions.iter().zip(&weights) {
                let blocked = town.truth.occluded_towards_each(&found, *direction);
                truths.iter_mut().zip(blocked).for_each(|(sum, blocked)| *sum += if blocked { 0.0 } else { *weight });
            }
            let block = RowBlock { rows: 0..found.len(), matrix, crowns: None };
            let classes = outlines.classes((&block, 1.0), &are_inside, None)?;
            cases.extend(truths.iter().zip(classes).enumerate().map(|(row, (truth, class))| SumCase {
                kind,
                name,
                set: Some(set),
                class,
                found: block.matrix.sum(row, &weights) / all,
                truth: truth / all,
            }));
        }
    }
    Ok(cases)
}

/// The errors as the program reads them.
pub(super) fn errors(cases: &[SumCase]) -> String {
    let mut text = "kind,class,mean,low,high,cases\n".to_owned();
    for (kind, name) in SumKind::ALL {
        for class in 0..CLASSES {
            let of_class = cases.iter().filter(|case| case.kind == kind && usize::from(case.class) == class);
            let mut errors: Vec<f64> = of_class.map(|case| case.truth - case.found).collect();
            if errors.len() < MIN_CASES {
                continue;
            }
            errors.sort_by(f64::total_cmp);
            let count = errors.len();
            let mean = errors.iter().sum::<f64>() / count as f64;
            let (low, high) = (errors[count / 20], errors[count - 1 - count / 20]);
            text += &format!("{name},{class},{mean:.4},{low:.4},{high:.4},{count}\n");
        }
    }
    text
}

/// Prints how often intervals hold the truth, and how wide they are.
pub(super) fn judge(cases: &[SumCase]) {
    println!(
        "\n| sum | targets | cases | held by the interval, % | mean width, % of the greatest sum |\n|---|---|---|---|---|"
    );
    let names: BTreeSet<&str> = cases.iter().map(|case| case.name).collect();
    for name in names {
        for set in SETS.map(|set| Some(Some(set))).into_iter().chain([Some(None), None]) {
            let of_set = cases.iter().filter(|case| case.name == name && set.is_none_or(|set| case.set == set));
            let (mut held, mut width, mut count) = (0.0, 0.0, 0.0);
            for case in of_set {
                let sums = Measure::new("sum", vec![to_f32(case.found)]);
                let measures = expected_measures("sum", &sums, |_| 1.0, case.kind, &[case.class]);
                let [low, high] = [1, 2].map(|number: usize| f64::from(measures[number].values[0]));
                // f32 rounds the ends
                held += f64::from(u8::from(low - 1e-6 <= case.truth && case.truth <= high + 1e-6));
                width += high - low;
                count += 1.0;
            }
            if count == 0.0 {
                continue;
            }
            let set = set.map_or("all", |set| set.map_or("planes of roofs", QuerySet::name));
            println!("| {name} | {set} | {count} | {:.1} | {:.1} |", 100.0 * held / count, 100.0 * width / count);
        }
    }
}
