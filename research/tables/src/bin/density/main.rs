//! Accuracy of the default model by the density of pulses, and by what a cloud lacks, on exact and simulated towns.
//!
//! ```sh
//! cargo research density -- shared/data/exact_town/a,town:21,old-town:22 whole,10,5,2 as-delivered,no-classes
//! ```
//!
//! prints false-blocked / false-visible in percent: means of three suns for pedestrians, roofs, facades, and people in
//! streets. Towns are folders with `cloud.laz` and `targets.npz`, or a kind and a seed of the simulator (150 m, 12
//! pulses/m²). Clouds are thinned by whole pulses, chosen by a hash of their times. Inside an obstacle is blocked,
//! unproven is visible.
#![allow(clippy::print_stdout, reason = "an example talks")]

mod towns;

use belvedere::control::Control;
use belvedere::medial::Trees;
use belvedere::model::{BallParams, ModelParams, SceneModel};
use belvedere::query::{Answer, MedialScene, UnprovenAs, Viewer, Visibility};
use belvedere::view::to_sun;
use belvedere::{Attributes, PointCloud};
use std::time::Instant;
use towns::{JudgedTown, SUNS_DEG};

type AnyResult<T> = Result<T, Box<dyn std::error::Error>>;

fn main() -> AnyResult<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let list = |i: usize, usual: &str| -> Vec<String> {
        arguments.get(i).map_or(usual, String::as_str).split(',').map(str::to_owned).collect()
    };
    println!(
        "| town | pulses/m² | given | pedestrians | roofs | facades | streets | unproven of free, pedestrians | s |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for name in list(0, "town:21,old-town:22,towers:23") {
        let town = JudgedTown::new(&name)?;
        for density in list(1, "whole,5,2") {
            let thinned = match density.as_str() {
                "whole" => town.cloud.clone(),
                density => thinned(&town.cloud, density.parse()?),
            };
            for given in list(2, "as-delivered") {
                let cloud = stripped(&thinned, &given)?;
                let start = Instant::now();
                let scene = built(&cloud)?;
                let seconds = start.elapsed().as_secs_f64();
                println!("| {name} | {density} | {given} | {} | {seconds:.1} |", judged(&town, &scene)?);
            }
        }
    }
    Ok(())
}

/// A cloud without what `given` names.
fn stripped(cloud: &PointCloud, given: &str) -> AnyResult<PointCloud> {
    let mut cloud = cloud.clone();
    match given {
        "as-delivered" => {}
        "no-classes" => cloud.attributes.classification = None,
        "no-times" => cloud.attributes.gps_time = None,
        "xyz" => cloud.attributes = Attributes::default(),
        other => return Err(format!("{other:?} is not as-delivered, no-classes, no-times or xyz").into()),
    }
    Ok(cloud)
}

fn built(cloud: &PointCloud) -> AnyResult<MedialScene> {
    let BallParams::CarvedIfPossible(carved, shrunk) = BallParams::default() else { return Err("no carving".into()) };
    let balls = BallParams::CarvedIfPossible(carved.with_trees(Trees::Opaque), shrunk);
    let params = ModelParams::default().with_balls(balls);
    let (model, _) = SceneModel::build(cloud, &params, &Control::none())?;
    Ok(model.scene(&model.rule(), UnprovenAs::Reported, &Control::none())?)
}

/// The pulses of a cloud, of which about `density` a square metre are left, all returns of each or none.
fn thinned(cloud: &PointCloud, density: f64) -> PointCloud {
    let (Some(times), Some(numbers), Some(bounds)) =
        (&cloud.attributes.gps_time, &cloud.attributes.return_number, cloud.bounds())
    else {
        return cloud.clone();
    };
    let (low, high) = bounds.on_map();
    let first = numbers.iter().filter(|&&number| number <= 1).count();
    let share = density * (high[0] - low[0]) * (high[1] - low[1]) / first.max(1) as f64;
    let rows: Vec<u32> = (0_u32..).zip(times).filter(|(_, time)| random(**time) < share).map(|(row, _)| row).collect();
    cloud.select(&rows)
}

/// A number from 0 to 1 that follows from a time alone.
///
/// # Source
/// The finaliser of SplitMix64: Steele, Lea & Flood 2014.
fn random(time: f64) -> f64 {
    let mut v = time.to_bits().wrapping_add(0x9E37_79B9_7F4A_7C15);
    v = (v ^ (v >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    v = (v ^ (v >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    (v ^ (v >> 31)) as f64 / 2f64.powi(64)
}

/// Free and blocked lines, and what was made of them.
#[derive(Default)]
struct Counts {
    free: usize,
    blocked: usize,
    false_blocked: usize,
    false_visible: usize,
    unproven_free: usize,
}

impl Counts {
    fn add(&mut self, answers: &[Answer], blocked: &[bool]) {
        for (answer, &is_blocked) in answers.iter().zip(blocked) {
            let said_blocked = match answer {
                Answer::Blocked | Answer::InsideObstacle => true,
                Answer::Visible | Answer::Unproven => false,
                // outside the view or the cloud
                _ => continue,
            };
            self.free += usize::from(!is_blocked);
            self.blocked += usize::from(is_blocked);
            self.false_blocked += usize::from(said_blocked && !is_blocked);
            self.false_visible += usize::from(!said_blocked && is_blocked);
            self.unproven_free += usize::from(*answer == Answer::Unproven && !is_blocked);
        }
    }

    fn rates(&self) -> [f64; 3] {
        let share = |part: usize, of: usize| 100.0 * part as f64 / of.max(1) as f64;
        [
            share(self.false_blocked, self.free),
            share(self.false_visible, self.blocked),
            share(self.unproven_free, self.free),
        ]
    }
}

/// The columns of a town.
fn judged(town: &JudgedTown, scene: &MedialScene) -> AnyResult<String> {
    let mut columns = Vec::new();
    let mut unproven = String::new();
    for set in &town.sets {
        let mut means = [0.0; 3];
        for ([azimuth, elevation], blocked) in SUNS_DEG.iter().zip(&set.blocked) {
            let towards = to_sun(azimuth.to_radians(), elevation.to_radians());
            let mut counts = Counts::default();
            counts.add(&scene.visible(Viewer::Direction(towards), &set.targets)?, blocked);
            let rates = counts.rates();
            means = [0, 1, 2].map(|i| means[i] + rates[i] / SUNS_DEG.len() as f64);
        }
        if set.name == "pedestrians" {
            unproven = format!("{:.1}", means[2]);
        }
        columns.push(format!("{:.2} / {:.2}", means[0], means[1]));
    }
    let mut counts = Counts::default();
    counts.add(&scene.visible(Viewer::Each(&town.street.0), &town.street.1)?, &town.street.2);
    let rates = counts.rates();
    columns.push(format!("{:.2} / {:.2}", rates[0], rates[1]));
    columns.push(unproven);
    Ok(columns.join(" | "))
}
