//! Accuracy of the default model on scans from tripods and from a car, in streets of simulated towns.
//!
//! ```sh
//! cargo research ground_scanners -- tripods,car town 110 77
//! ```
//!
//! prints the table of docs/methods/scanners.md: scanners, kinds of towns, their extent in metres, seeds. A last number
//! makes the angles between pulses so many times as large, for a quick look.
#![allow(clippy::print_stdout, reason = "an example talks")]

mod judge;

use belvedere::PointCloud;
use belvedere::cast::{to_index, to_row};
use belvedere_baselines::simulated::{SurveyedScene, flown, preset, surveyed};
use belvedere_scenes::{
    AirborneParams, MobileParams, Stations, TerrestrialParams, TownParams, TriangleScene, scan_mobile,
    scan_terrestrial, town,
};

/// Places of a tripod in a town.
const STATIONS: u16 = 12;

type AnyResult<T> = Result<T, Box<dyn std::error::Error>>;

fn main() -> AnyResult<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let word = |i: usize, usual: &'static str| arguments.get(i).map_or(usual, String::as_str);
    let extent: f64 = word(2, "110").parse()?;
    for name in word(1, "town").split(',') {
        let preset = preset(name)?;
        for seed in word(3, "77").split(',') {
            let params = preset.params(extent, seed.parse()?);
            for scanner in word(0, "tripods,car").split(',') {
                let scene = town(&params);
                let survey = scanned(scanner, &scene, &params, word(4, "1").parse()?)?;
                let town = SurveyedScene::new(scene, survey);
                let found = judge::judge(&town, params.seed)?;
                println!("{name} {extent} m, seed {seed}, {scanner}: {} points\n{found}", town.cloud.len());
            }
        }
    }
    Ok(())
}

/// The cloud that a scanner makes of a town, and where it was at each point.
fn scanned(
    scanner: &str,
    scene: &TriangleScene,
    params: &TownParams,
    coarser: f64,
) -> AnyResult<(PointCloud, Vec<[f32; 3]>)> {
    let seed = params.seed;
    Ok(match scanner {
        "air" => flown(scene, &AirborneParams { seed, ..AirborneParams::covering(scene, 10.0) })?,
        "tripods" => {
            let stations = Stations::Chosen(STATIONS);
            let usual = TerrestrialParams::default();
            let angular_step = coarser * usual.angular_step;
            surveyed(&scan_terrestrial(scene, &TerrestrialParams { seed, stations, angular_step, ..usual }))?
        }
        "car" => {
            let runs = params.lanes();
            let usual = MobileParams::default();
            let pulses_per_line = to_row(to_index(f64::from(usual.pulses_per_line) / coarser));
            let line_rate = usual.line_rate / coarser;
            surveyed(&scan_mobile(scene, &MobileParams { seed, runs, pulses_per_line, line_rate, ..usual }))?
        }
        other => return Err(format!("no scanner {other:?}; there are air, tripods and car").into()),
    })
}
