//! Accuracy of sun hours and sky views of carved balls on simulated towns.
//!
//! ```sh
//! cargo research sun_and_sky -- village,town,old-town 150 0.5 4000 11
//! ```
//!
//! prints the table of docs/methods/sun-and-sky-accuracy.md: kinds of towns, their extent and the side of a cell in
//! metres, targets of each kind, and the seed. Sun hours are those of 21 June at 52° N in steps of ten minutes, sky
//! views those of 577 directions.
#![allow(clippy::print_stdout, reason = "an example talks")]

mod judge;

use belvedere::query::BlockRule;
use belvedere_baselines::dsm::{Dsm, DsmParams};
use belvedere_baselines::simulated::preset;
use judge::score::{ELEVATIONS_DEG, LightDirections, LightScore, Setting};
use judge::{CellTops, JudgedTargets, LightTown};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let word = |i: usize, usual: &'static str| arguments.get(i).map_or(usual, String::as_str);
    let (extent, cell): (f64, f64) = (word(1, "150").parse()?, word(2, "0.5").parse()?);
    let (count, seed): (usize, u64) = (word(3, "4000").parse()?, word(4, "11").parse()?);
    let light = LightDirections::of_day(52f64.to_radians(), 23.44f64.to_radians(), 10.0, 577)?;
    for name in word(0, "village,town,old-town").split(',') {
        let preset = preset(name)?;
        let town = LightTown::new(preset, extent, cell, seed)?;
        println!("{name}: {} points, {} balls", town.town.cloud.len(), town.balls.len());
        let carved = BlockRule::carved();
        let raster = Dsm::from_points(&town.town.cloud.positions, &DsmParams { cell: 0.5, ..DsmParams::default() })?;
        let ground = town.ground_cells(0.0, count, &light);
        let roofs = town.roofs(count, &light);
        let returns = town.roof_returns(count, &light);
        for (what, places) in [
            ("ground, queried 0.1 m higher", &ground),
            ("0.1 m above ground", &town.ground_cells(0.1, count, &light)),
            ("1.5 m above ground", &town.ground_cells(1.5, count, &light)),
            ("0.1 m off roofs", &roofs),
            (
                "0.1 m above the highest points of cells of roofs",
                &town.roof_cells(CellTops::Highest, 0.1, count, &light)?,
            ),
            ("0.1 m above the surface at cells of roofs", &town.roof_cells(CellTops::Surface, 0.1, count, &light)?),
            ("returns of roofs, queried 0.1 m higher", &returns),
        ] {
            let lift = if what.ends_with("higher") { 0.1 } else { 0.0 };
            let score = town.judge(places, &light, lift, &carved)?;
            println!("  {what} ({})", places.len());
            let [mean, absolute] = LightTown::heights_off(places, town.town.cloud.frame.origin[2]);
            println!("    queried {mean:+.3} m too high, {absolute:.3} m off");
            print_score(&score);
            let raster = town.judge_other(&raster, places, &light)?;
            println!(
                "    the highest points of cells of 0.5 m instead: sun MAE {:.3} h, sky view factor {:.4}, openness {:.4}",
                raster.sun[1], raster.factor[1], raster.openness[1]
            );
            for (what, hours) in town.blame(places, &light, lift, &carved)?.iter().take(8) {
                println!("        {hours:.3} h {what}");
            }
        }
        for (what, places) in [("ground", &ground), ("returns of roofs", &returns), ("0.1 m off roofs", &roofs)] {
            print_lifts(&town, what, places, &light)?;
        }
    }
    Ok(())
}

fn print_score(score: &LightScore) {
    for (what, [lit, error, false_lit, false_shaded]) in [("", score.sun), (" above 5 deg", score.sun_above_5)] {
        println!(
            "    sun{what}: {lit:.2} h, MAE {error:.3} h, bias {:+.3}, wrongly lit {false_lit:.3}, wrongly shaded {false_shaded:.3}",
            false_lit - false_shaded
        );
    }
    for (what, [mean, error, bias]) in [("sky view factor", score.factor), ("openness", score.openness)] {
        println!("    {what}: {mean:.3}, MAE {error:.4}, bias {bias:+.4}");
    }
    let mut low = 0.0;
    for (high, [false_lit, false_shaded]) in ELEVATIONS_DEG.iter().zip(score.by_elevation) {
        println!("      sun {low} to {high} deg: wrongly lit {false_lit:.3} h, wrongly shaded {false_shaded:.3} h");
        low = *high;
    }
    for (setting, [share, error, false_lit, false_shaded, factor]) in Setting::ALL.iter().zip(score.by_setting) {
        println!(
            "      {setting:?}: {:.1} % of targets; of the sums above: MAE {error:.3} h, wrongly lit {false_lit:.3}, wrongly shaded {false_shaded:.3}, sky view {factor:.4}",
            100.0 * share
        );
    }
}

fn print_lifts(town: &LightTown, what: &str, places: &JudgedTargets, light: &LightDirections) -> belvedere::Result<()> {
    for shell in [0.1, 0.2, 0.3] {
        for lift in [0.0, 0.05, 0.1, 0.2] {
            let score = town.judge(places, light, lift, &BlockRule { shell, ..BlockRule::carved() })?;
            let [_, error, false_lit, false_shaded] = score.sun;
            println!(
                "  {what}, shell {shell} m, lift {lift} m: MAE {error:.3} h (lit {false_lit:.3}, shaded {false_shaded:.3}), above 5 deg {:.3}, sky view {:.4}, openness {:.4}",
                score.sun_above_5[1], score.factor[1], score.openness[1]
            );
        }
    }
    Ok(())
}
