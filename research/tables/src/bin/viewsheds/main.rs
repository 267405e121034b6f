//! Accuracy and speed of viewsheds of carved balls on simulated towns.
//!
//! ```sh
//! cargo research viewsheds -- village,town,old-town 300 0.5 10
//! ```
//!
//! prints the table of docs/methods/viewshed.md: kinds of towns, their extent and the side of a cell in metres, people
//! in streets.
#![allow(clippy::print_stdout, reason = "an example talks")]

mod judge;

use belvedere::Bounds;
use belvedere::apps::viewshed::{Observer, ViewshedParams, cell_targets, viewshed};
use belvedere::control::Control;
use belvedere::query::{EarthParams, random_pairs};
use belvedere_baselines::simulated::preset;
use judge::ViewshedTown;
use std::time::Instant;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let word = |i: usize, usual: &'static str| arguments.get(i).map_or(usual, String::as_str);
    let (extent, cell): (f64, f64) = (word(1, "300").parse()?, word(2, "0.5").parse()?);
    let eyes: usize = word(3, "10").parse()?;
    for name in word(0, "village,town,old-town").split(',') {
        let preset = preset(name)?;
        let town = ViewshedTown::new(preset, extent, cell, eyes, 11)?;
        println!("{name}: {} points, {} balls, {} eyes", town.town.cloud.len(), town.balls.len(), town.eyes.len());
        for height in [0.0, 0.5, 1.7] {
            let score = town.judge(height)?;
            println!(
                "  targets {height} m above the ground: IoU {:.3}, without unproven {:.3} ({:.1} %), false-visible {:.2} %, false-blocked {:.2} %, visible {:.1} %",
                score.ious()[0],
                score.ious()[1],
                100.0 * score.unproven as f64 / (score.truly_visible + score.truly_blocked) as f64,
                100.0 * score.false_visible_share(),
                100.0 * score.false_blocked_share(),
                100.0 * score.truly_visible as f64 / (score.truly_visible + score.truly_blocked) as f64
            );
        }
        let scene = town.blockers()?;
        let targets = cell_targets(&town.ground, 0.0);
        let mut seconds = Vec::new();
        for &eye in &town.eyes {
            let start = Instant::now();
            let observer = Observer { eye, ..Observer::default() };
            viewshed(&scene, &[observer], &targets, &ViewshedParams::default(), &Control::none())?;
            seconds.push(start.elapsed().as_secs_f64());
        }
        seconds.sort_by(f64::total_cmp);
        let Bounds { low, high } = town.town.cloud.bounds().unwrap_or_default();
        let pairs = random_pairs(low, high, 1_000_000, 1);
        let start = Instant::now();
        let sights = scene.lines_of_sight(&pairs, &EarthParams::default(), &Control::none())?;
        let answering = start.elapsed().as_secs_f64();
        let median = seconds.get(seconds.len() / 2).copied().unwrap_or_default();
        println!("  {} cells: {median:.2} s an observer; {} pairs: {answering:.2} s", targets.len(), sights.len());
    }
    Ok(())
}
