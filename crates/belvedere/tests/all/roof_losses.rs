//! Losses by shading on the planes of roofs, against rays in the exact mesh of simulated towns.

use crate::common::simulated::cloud_of;
use belvedere::apps::irradiance::{
    ClearSky, IrradianceParams, Irradiation, PeriodRadiation, SeasonRadiation, above_roof, clear_instants,
    plane_irradiation, roof_irradiation,
};
use belvedere::apps::roof_planes::{RoofPlane, RoofPlaneParams, roof_planes, roof_points};
use belvedere::apps::rows::RowBlock;
use belvedere::apps::sum_errors::Intervals;
use belvedere::apps::sun::{Site, Zone};
use belvedere::control::Control;
use belvedere::ground::{Ground, GroundParams, MapGrid};
use belvedere::model::{ModelParams, SceneModel};
use belvedere::query::{UnprovenAs, VisibilityMatrix};
use belvedere::weather::{CalendarDay, unix_day};
use belvedere_scenes::{AirborneParams, Preset, Truth, scan_airborne, town};

fn year() -> PeriodRadiation {
    let site = Site { latitude: 52f64.to_radians(), longitude: 5f64.to_radians(), height: 0.0, convergence: 0.0 };
    let sky = ClearSky::Ineichen { linke: 3.0 };
    let [start, end] = [2025, 2026].map(|year| unix_day(CalendarDay::new(year, 1, 1).unwrap()) as f64 * 86_400.0);
    let instants = clear_instants(&sky, &site, [start, end], 1800.0, &Zone::utc()).unwrap();
    let params = IrradianceParams::default().with_patch_division(1).with_sun_cell(4f64.to_radians());
    PeriodRadiation::gather(&instants, &params).unwrap()
}

/// The share that the exact town takes from what arrives on the cells of a plane.
fn true_loss(plane: &RoofPlane, truth: &Truth, origin: [f64; 3], radiation: &PeriodRadiation) -> f64 {
    let directions = radiation.directions();
    let cells = plane.cells.middles();
    let width = directions.len().div_ceil(64);
    let mut words = vec![0_u64; width * cells.len()];
    let places: Vec<[f64; 3]> = cells
        .iter()
        .map(|(middle, _)| {
            let place = above_roof(*middle, plane.normal);
            [0, 1, 2].map(|i| f64::from(place[i]) + origin[i])
        })
        .collect();
    for (number, direction) in directions.iter().enumerate() {
        for (row, occluded) in truth.occluded_towards_each(&places, *direction).into_iter().enumerate() {
            words[row * width + number / 64] |= u64::from(!occluded) << (number % 64);
        }
    }
    let matrix = VisibilityMatrix::from_words(cells.len(), directions.len(), words).unwrap();
    let strings: Vec<usize> = cells.iter().map(|(_, string)| *string).collect();
    let block = RowBlock::from(matrix);
    Irradiation::sum(&plane_irradiation(&block, (0, &strings), plane.normal, radiation, 0.0).unwrap().mean).loss()
}

#[test]
fn losses_of_the_planes_of_an_exact_town_are_within_a_point_on_the_mean() {
    let radiation = year();
    for (preset, seed) in [(Preset::Town, 3), (Preset::OldTown, 4)] {
        let scene = town(&preset.params(70.0, seed));
        let scan = scan_airborne(
            &scene,
            &AirborneParams { seed, pulses_per_m2: 10.0, ..AirborneParams::covering(&scene, 10.0) },
        );
        let cloud = cloud_of(&scan);
        let none = Control::none();
        let (model, _) = SceneModel::build(&cloud, &ModelParams::default(), &none).unwrap();
        let blockers = model.scene(&model.rule(), UnprovenAs::Visible, &none).unwrap();
        let (low, high) = model.bounds().on_map();
        let grid = MapGrid::covering(low, high, 1.0, [cloud.frame.origin[0], cloud.frame.origin[1]]).unwrap();
        let (ground, _) = Ground::of_cloud(&cloud, grid, &GroundParams::default(), &none).unwrap();
        let (rows, _) = roof_points(&cloud, &ground).unwrap();
        let points: Vec<[f32; 3]> = rows.iter().map(|&row| cloud.positions[row as usize]).collect();
        let planes = roof_planes(&points, &RoofPlaneParams::default(), &none).unwrap();
        let planes: Vec<RoofPlane> = planes.into_iter().take(20).collect();
        let seasons = [SeasonRadiation { radiation: radiation.clone(), factor: 0.0 }];
        let found = roof_irradiation(&blockers, &planes, &seasons, Intervals::Without, &none).unwrap();
        let truth = Truth::new(&scene);
        let (mut error, mut expected, mut mean) = (0.0, 0.0, 0.0);
        for (plane, found) in planes.iter().zip(&found) {
            let exact = true_loss(plane, &truth, cloud.frame.origin, &radiation);
            let share = 1.0 / planes.len() as f64;
            error += share * (found.mean.loss() - exact).abs();
            expected += share * exact;
            mean += share * found.mean.loss();
        }
        assert!(planes.len() >= 10 && expected > 0.02, "{} planes, {expected}", planes.len());
        assert!(error < 0.01, "seed {seed}: {error} on the mean, {mean} where {expected} is true");
    }
}
