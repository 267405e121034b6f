//! Tiles of any size have the balls and the answers of one tile over all.

use crate::common::{LARGE, cells, clear_year, plan, shadow, site, sky_view, sun_hours, suns};
use belvedere::apps::ask::{Days, Standing, StandingObserver, ViewLimits, ViewshedQuestion};
use belvedere::apps::irradiance::{ClearSky, IrradianceParams, clear_instants};
use belvedere::apps::sun::{Date, DayParams, Period, Site, SunStep, Zone, sun_days};
use belvedere::control::Control;
use belvedere::io::{read_balls, read_tif_f32, read_tif_u8, read_tif_u16};
use belvedere_tiles::{Plan, TileQuestion, Topic, UnfinishedRun, merge, status};
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::path::Path;

/// Maximum number of balls at a time for tiles of two sizes.
const MAX_BALLS: [usize; 2] = [900, 6000];

/// Returns centres and radii of all balls of a run, as bits, sorted.
fn balls(plan: &Plan, folder: &Path) -> Vec<[u32; 4]> {
    let mut all = Vec::new();
    for tile in &plan.tiles {
        let path = folder.join("balls").join(format!("{}.npz", tile.name()));
        if !path.exists() {
            continue;
        }
        let parts = read_balls(&path).unwrap();
        assert_eq!(parts.frame.origin, plan.frame().unwrap().origin);
        let bits = |(c, r): (&[f32; 3], &f32)| [c[0], c[1], c[2], *r].map(f32::to_bits);
        all.extend(parts.balls.centers.iter().zip(&parts.balls.radii).map(bits));
    }
    all.sort_unstable();
    all
}

/// Returns the parameters of hours of a day in spring with the sun above 8 degrees.
fn params() -> DayParams {
    DayParams::default().with_step(3600.0).with_min_elevation(8_f64.to_radians())
}

fn day() -> Period {
    Period::Days(vec![Date::new(2026, 4, 10).unwrap()])
}

/// Returns shadows, sky view, sun hours, energy, and the viewshed of two observers.
fn all_questions(eyes: [[f64; 3]; 2]) -> Vec<TileQuestion> {
    let days = Days {
        dates: vec!["2026-04-10".to_owned()],
        time_step_min: Some(60.0),
        min_sun_elevation_deg: Some(8.0),
        ..Days::default()
    };
    let coarse = IrradianceParams::default().with_patch_division(1).with_sun_cell(0.3);
    let observer = |eye: [f64; 3]| StandingObserver {
        standing: Standing { place: eye, height: None },
        limits: ViewLimits::default(),
    };
    let view = ViewshedQuestion {
        observers: eyes.map(observer).to_vec(),
        limits: ViewLimits { max_distance: Some(120.0), ..ViewLimits::default() },
        ..ViewshedQuestion::default()
    };
    let mut questions = suns();
    let view = TileQuestion::new("viewshed", view.into()).unwrap();
    questions.extend([sky_view(49), sun_hours(days), clear_year(coarse), view]);
    questions
}

/// Returns the shadow of each of the suns whose hours are summed.
fn suns_of_the_day(site: &Site) -> Vec<(TileQuestion, f64)> {
    let days = sun_days(site, &Zone::mean_solar(site), &day(), &params()).unwrap();
    let question = |(number, step): (usize, &SunStep)| {
        let [x, y, z] = step.direction;
        let question = shadow(&format!("step_{number}"), x.atan2(y).rem_euclid(TAU), z.asin());
        (question, (step.end - step.start) / 3600.0)
    };
    days[0].steps.iter().enumerate().map(question).collect()
}

fn values(plan: &Plan, folder: &Path, question: &TileQuestion) -> BTreeMap<[i64; 2], u32> {
    let path = folder.join("merged.tif");
    merge(plan, folder, question, &path, UnfinishedRun::Refused, &Control::none()).unwrap();
    match question.topic() {
        Topic::Shadow => {
            let raster = read_tif_u8(&path).unwrap();
            let wide: Vec<u32> = raster.values().iter().map(|&v| v.into()).collect();
            cells(&path, &wide, raster.width(), 255)
        }
        Topic::Viewshed => {
            let raster = read_tif_u16(&path).unwrap();
            let wide: Vec<u32> = raster.values().iter().map(|&v| v.into()).collect();
            cells(&path, &wide, raster.width(), 65_535)
        }
        _ => {
            let raster = read_tif_f32(&path).unwrap();
            let bits: Vec<u32> = raster.values().iter().map(|v| v.to_bits()).collect();
            cells(&path, &bits, raster.width(), (-9999.0_f32).to_bits())
        }
    }
}

#[test]
fn tiles_of_any_size_give_the_balls_and_answers_of_one_tile_over_all() {
    let place = tempfile::tempdir().unwrap();
    let clouds = &LARGE.clouds;
    let whole_folder = place.path().join("whole");
    let whole = plan(clouds, &whole_folder, 512.0, Vec::new());
    // One eye in a street in a corner and one above the roofs at the other end, in other tiles than most of their
    // views.
    let bounds = whole.bounds();
    let mut eyes = [
        [bounds.low[0] + 20.0, bounds.low[1] + 30.0, f32::NAN],
        [bounds.high[0] - 9.0, bounds.high[1] - 9.0, bounds.high[2] + 5.0],
    ]
    .map(|eye| eye.map(f64::from));
    whole.set_on_ground(&mut eyes, 1.7, &Control::none()).unwrap();
    let questions = all_questions(eyes);
    let steps = suns_of_the_day(&site(&whole));
    let of_whole = questions.iter().cloned().chain(steps.iter().map(|(question, _)| question.clone())).collect();
    let whole = plan(clouds, &whole_folder, 512.0, of_whole);
    assert_eq!(whole.tiles.len(), 1);
    let at_once = LARGE.run(&whole, &whole_folder, None);
    assert!(at_once.failed.is_empty() && at_once.max_balls > 3 * MAX_BALLS[1], "{at_once:?}");
    let expected_balls = balls(&whole, &whole_folder);
    assert!(expected_balls.len() > 10_000, "{}", expected_balls.len());
    let expected: Vec<_> = questions.iter().map(|question| values(&whole, &whole_folder, question)).collect();
    for (of_sun, lit_share) in expected.iter().zip([0.02..0.9, 0.2..0.95, 0.6..1.0]) {
        assert!(of_sun.len() > 15_000, "{}", of_sun.len());
        let lit = of_sun.values().filter(|&&value| value == 1).count() as f64 / of_sun.len() as f64;
        assert!(lit_share.contains(&lit), "{lit}");
        assert!(of_sun.values().all(|&value| value < 2), "nothing is missing");
    }
    sun_hours_are_the_sum_of_shadows(&expected[4], &whole, &whole_folder, &steps);
    energies_are_those_of_an_open_plane_less_what_obstacles_take(&expected[5], &site(&whole));
    each_observer_sees_its_share(&expected[6]);
    // With few balls at a time, a part of a tile is tested alone; with more, some tiles are tested together.
    for (size, max_balls) in [64.0, 100.0].into_iter().zip(MAX_BALLS) {
        let folder = place.path().join(format!("tiles_{size}"));
        let plan = plan(clouds, &folder, size, questions.clone());
        // Some tiles of 64 m have no point, but cells beside points.
        assert!(plan.tiles.len() >= 4);
        let report = LARGE.run(&plan, &folder, Some(max_balls));
        assert!(report.failed.is_empty() && report.unproven_cells == 0, "{report:?}");
        assert!((max_balls / 2..=max_balls).contains(&report.max_balls), "{report:?}");
        assert!(status(&plan, &folder).is_complete());
        let found = balls(&plan, &folder);
        let different = expected_balls.iter().filter(|ball| found.binary_search(ball).is_err()).count();
        assert!(found == expected_balls, "tiles of {size} m: {different} of {} balls differ", expected_balls.len());
        for (question, expected) in questions.iter().zip(&expected) {
            let found = values(&plan, &folder, question);
            let different = expected.iter().filter(|(place, value)| found.get(*place) != Some(value)).count();
            assert!(found == *expected, "tiles of {size} m, {}: {different} cells differ", question.name);
        }
    }
}

/// Compares the hours of a cell with the shadows of all suns.
fn sun_hours_are_the_sum_of_shadows(
    hours: &BTreeMap<[i64; 2], u32>,
    plan: &Plan,
    folder: &Path,
    steps: &[(TileQuestion, f64)],
) {
    assert!(steps.len() >= 8, "{}", steps.len());
    let mut sums: BTreeMap<[i64; 2], f64> = hours.keys().map(|&cell| (cell, 0.0)).collect();
    for (question, lasts) in steps {
        for (cell, lit) in values(plan, folder, question) {
            *sums.get_mut(&cell).unwrap() += f64::from(lit) * lasts;
        }
    }
    let mut kinds = [0; 3];
    let max: f64 = steps.iter().map(|(_, lasts)| lasts).sum();
    for (cell, sum) in sums {
        let found = f64::from(f32::from_bits(hours[&cell]));
        // Rounding of f32 in a sum of a dozen.
        assert!((found - sum).abs() < 1e-5, "{cell:?}: {found} {sum}");
        kinds[if sum == 0.0 {
            0
        } else if sum < max - 0.01 {
            1
        } else {
            2
        }] += 1;
    }
    assert!(kinds.iter().all(|&count| count > 200), "{kinds:?}");
}

/// Checks energies. A plane without obstacles gets the global radiation of the year, with any model of the sky; other
/// planes get less.
fn energies_are_those_of_an_open_plane_less_what_obstacles_take(energies: &BTreeMap<[i64; 2], u32>, site: &Site) {
    let instants = {
        let zone = Zone::mean_solar(site);
        let year = [2026, 2027].map(|year| zone.instant_of(Date::new(year, 1, 1).unwrap(), 0.0).unwrap());
        clear_instants(&ClearSky::Haurwitz, site, year, 600.0, &zone).unwrap()
    };
    let global: f64 = instants.iter().map(|instant| instant.irradiance.ghi * instant.hours / 1000.0).sum();
    let found: Vec<f64> = energies.values().map(|&bits| f64::from(f32::from_bits(bits))).collect();
    let [low, high] = [f64::min, f64::max].map(|pick| found.iter().copied().reduce(pick).unwrap());
    // Suns are gathered in cells of 17 degrees: each represents its cell.
    assert!(high <= global * 1.01 && high > global * 0.97, "{high} of {global}");
    assert!(low >= 0.0 && low < global * 0.4, "{low} of {global}");
}

/// Checks that the eye above all roofs sees most cells within its reach, and the eye in the street few.
fn each_observer_sees_its_share(counts: &BTreeMap<[i64; 2], u32>) {
    let of_number = |number: u32| counts.values().filter(|&&count| count == number).count();
    assert!(of_number(0) > 500 && of_number(1) > 2_000 && of_number(2) > 100, "{}", counts.len());
    assert_eq!(of_number(0) + of_number(1) + of_number(2), counts.len());
}
