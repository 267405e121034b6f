//! How long does a whole country take on a cluster, how much disk do its balls need, and what is lost with computers?
//!
//!     cargo research country
//!
//! The table is that of docs/scale.md.

mod simulation;

use simulation::{Cluster, Country, simulate};
use std::io::Write;

/// Side of a tile, and of the squares that plans are made for, kilometres.
const TILE: f64 = 0.5;
const SQUARE: f64 = 30.0;
/// What a plan has around its square, kilometres.
const MARGIN: f64 = 1.0;
/// Seconds of a processor for the balls of a point, and for the sky view of a cell of 1 m in 577 directions:
/// docs/scale.md and docs/gpu.md.
const BALL_SECONDS: f64 = 22e-6;
const SKY_SECONDS: f64 = 170e-6;
/// Bytes of balls for each point.
const BALL_BYTES: f64 = 27.0;

fn main() -> std::io::Result<()> {
    let mut out = std::io::stdout().lock();
    writeln!(out, "| country | tiles | processor hours | processors | days | busy | computed again | balls on disk |")?;
    writeln!(out, "|---|---|---|---|---|---|---|---|")?;
    for (name, square_km, points_per_m2) in [("Netherlands", 41_500.0, 20.0), ("France", 550_000.0, 20.0)] {
        let tile_m2 = (TILE * 1000.0_f64).powi(2);
        let plan_side = (SQUARE + 2.0 * MARGIN) / TILE;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small counts")]
        let country = Country {
            plans: (square_km / (SQUARE * SQUARE)).ceil() as usize,
            tiles_per_plan: (plan_side * plan_side).round() as usize,
            seconds: [tile_m2 * points_per_m2 * BALL_SECONDS, tile_m2 * SKY_SECONDS],
            ball_bytes: tile_m2 * points_per_m2 * BALL_BYTES,
            bad_share: 1e-4,
        };
        for workers in [64, 1000] {
            // a processor is lost once a week
            // so that nobody waits for the last tiles of a stage
            let max_open = if workers < 500 { 2 } else { 4 };
            let cluster = Cluster { workers, hours_to_loss: 168.0, seconds_to_replace: 600.0, tries: 3, max_open };
            let outcome = simulate(&country, &cluster);
            let busy = (outcome.recorded + outcome.wasted) / (outcome.elapsed * workers as f64);
            writeln!(
                out,
                "| {name} | {:.2} million | {:.0} | {workers} | {:.1} | {:.1} % | {:.2} % | {:.2} TB |",
                (country.plans * country.tiles_per_plan) as f64 / 1e6,
                outcome.recorded / 3600.0,
                outcome.elapsed / 86_400.0,
                100.0 * busy,
                100.0 * outcome.wasted / outcome.recorded,
                outcome.max_ball_bytes / 1e12
            )?;
        }
    }
    Ok(())
}
