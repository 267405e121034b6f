//! How well planes, ridges, edges and walls of buildings are found, against the exact meshes of simulated towns.
//!
//! ```sh
//! cargo research planes -- town,old-town,towers 5,10,40 [SEED]
//! ```
//!
//! prints the table of docs/methods/planes.md: the share of true edges and ridges that is found, the error across them,
//! that error over the standard deviation that is stated (0.67 in the median where it is honest), and the time.
#![allow(clippy::print_stdout, reason = "an example talks")]

mod truth;

use belvedere::PatchKind;
use belvedere::Result;
use belvedere::control::Control;
use belvedere::planes::{BuildingSurfaces, PlaneParams, SurveyPoints, find};
use belvedere_baselines::simulated::{SurveyedScene, preset};
use belvedere_scenes::Preset;
use std::time::Instant;
use truth::{FoundLine, Line, errors_of_walls, errors_on, lines_of};

const EXTENT: f64 = 150.0;

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let list = |index: usize, usual: &str| -> Vec<String> {
        let text = arguments.get(index).map_or(usual, String::as_str);
        text.split(',').map(str::to_owned).collect()
    };
    let seed = list(2, "5").first().and_then(|seed| seed.parse().ok()).unwrap_or(5);
    println!("| town | pulses/m² | what | true, m | found | median, cm | 95 %, cm | outward, cm | error / deviation |");
    println!("|---|---|---|---|---|---|---|---|---|");
    for name in list(0, "town,old-town,towers") {
        let preset = preset(&name)?;
        for density in list(1, "5,10,40").iter().filter_map(|density| density.parse::<f64>().ok()) {
            judge(preset, density, seed)?;
        }
    }
    Ok(())
}

/// Prints the rows of one town.
fn judge(preset: Preset, density: f64, seed: u64) -> Result<()> {
    let town = SurveyedScene::flown(preset, EXTENT, seed, density)?;
    let SurveyedScene { scene, truth: exact, cloud, scanner, .. } = &town;
    let survey = SurveyPoints {
        positions: &cloud.positions,
        scanner,
        attributes: &cloud.attributes,
        origin: cloud.frame.origin,
    };
    let params = PlaneParams::default();
    let start = Instant::now();
    let found = find(&survey, &params, &Control::none())?;
    let seconds = start.elapsed().as_secs_f64();
    let (edges, ridges) = lines_of(scene, exact);
    let absolute = |ends: [[f64; 3]; 2]| ends.map(|p| town.absolute_of(p));
    let sure = found.outlines.edges.iter().filter(|edge| edge.sd <= params.edges.max_sd);
    let found_edges: Vec<FoundLine> = sure.map(|edge| FoundLine { ends: absolute(edge.ends), sd: edge.sd }).collect();
    // a ridge is known as well as its planes
    let of_ridge =
        |planes: [usize; 2]| planes.iter().map(|&plane| found.outlines.planes[plane].sd.powi(2)).sum::<f64>().sqrt();
    let found_ridges: Vec<FoundLine> = found
        .outlines
        .ridges
        .iter()
        .map(|ridge| FoundLine { ends: absolute(ridge.ends), sd: of_ridge(ridge.planes).max(0.005) })
        .collect();
    let head = format!("| {} | {density} |", preset.name());
    let long = |from: f64, to: f64| move |line: &&Line| (from..to).contains(&line.length());
    let pick = |lines: &[Line], from: f64, to: f64| lines.iter().filter(long(from, to)).copied().collect::<Vec<_>>();
    println!("{head} edges of 5 m and more | {} |", errors_on(&pick(&edges, 5.0, f64::INFINITY), &found_edges));
    println!("{head} edges of 2 to 5 m | {} |", errors_on(&pick(&edges, 2.0, 5.0), &found_edges));
    println!("{head} ridges of 2 m and more | {} |", errors_on(&pick(&ridges, 2.0, f64::INFINITY), &found_ridges));
    println!("{head} walls | {} |", errors_of_walls(&found, cloud.frame.origin, exact));
    println!("{head} {} |", counts(&found, seconds, cloud.len()));
    Ok(())
}

/// What was found, and how fast.
fn counts(found: &BuildingSurfaces, seconds: f64, points: usize) -> String {
    let of = |kind: PatchKind| found.patches.kinds.iter().filter(|own| **own == kind).count();
    format!(
        "{} planes, {} edges, {} ridges, {} walls; triangles: {} of roofs, {} of walls, {} of parapets, {} of steps, {} of boxes, {} within; {:.2} s, {:.1} s for a million points",
        found.outlines.planes.len(),
        found.outlines.edges.len(),
        found.outlines.ridges.len(),
        found.outlines.walls.len(),
        of(PatchKind::Roof),
        of(PatchKind::Wall),
        of(PatchKind::Parapet),
        of(PatchKind::Step),
        of(PatchKind::Box),
        of(PatchKind::Inside),
        seconds,
        1e6 * seconds / points as f64,
    )
}
