//! Whether the share of a beam that gets through plants is what a model says: pulses that the model never saw.
//!
//! ```sh
//! cargo research through_plants -- pulse tile.laz other.laz
//! cargo research through_plants -- line tile.laz
//! ```
//!
//! prints a table of docs/methods/tree-light.md. `pulse` keeps out a tenth of the pulses, `line` whole flight lines,
//! one after the other. A pulse that was kept out and runs through crowns of the model has a truth: the share of its
//! returns that lie behind all plants, on the ground, within half a metre above it, or on roofs. Predicted are 0 or 1
//! by balls, which are opaque; 0.03 where balls of plants stand in the way (`seasons` without a medium); and exp(−τ) of
//! the medium. A pulse that ends in a plant is followed to the ground.
#![allow(clippy::print_stdout, reason = "an example talks")]

use belvedere::control::Control;
use belvedere::io::{ReadOptions, read_cloud};
use belvedere::medium::Medium;
use belvedere::model::{ModelParams, OrientBy, SceneModel};
use belvedere::pulses::{LocateParams, Means, Pulses, SensorPositions, group, locate};
use belvedere::query::{Answer, MedialScene, UnprovenAs};
use belvedere::random::uniform;
use belvedere::vector::{length, sub, unit};
use belvedere::{PointCloud, Result};
use std::collections::{BTreeSet, HashMap};
use std::path::Path;

type AnyResult<T> = std::result::Result<T, Box<dyn std::error::Error>>;

/// Share of the pulses that is kept out.
const SHARE: f64 = 0.1;
/// Side of the cells that the ground below a pulse is taken from, metres.
const CELL: f64 = 2.0;
/// How far before the end of a pulse its line begins, metres: clear of the balls of what it met.
const CLEARANCE: f64 = 0.3;
/// Least share of a cloud that is left to build from where a line is kept out.
const MIN_LEFT: f64 = 0.25;
/// Height above the ground up to which returns count as ground, metres: grass, which is no part of a medium.
const GRASS: f64 = 0.5;
/// Optical depth from which on a line runs through plants.
const MIN_DEPTH: f64 = 1e-6;
const NAMES: [&str; 3] = ["opaque balls", "0.03 through balls", "medium"];

fn main() -> AnyResult<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [by, files @ ..] = &arguments[..] else { return Err("give pulse or line, and clouds".into()) };
    println!("cloud | crossing | method | MSE | ECE, % | predicted → found");
    for file in files {
        let (cloud, _) = read_cloud([Path::new(file)], &ReadOptions::default(), &Control::none())?;
        let survey = Survey::new(&cloud)?;
        let mut found = Found::default();
        if by == "line" {
            for line in survey.lines() {
                survey.judge(|pulse| survey.line_of(pulse) == Some(line), &mut found)?;
            }
        } else {
            survey.judge(|pulse| uniform(1, pulse as u64) < SHARE, &mut found)?;
        }
        let name = Path::new(file).file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        found.report(&name);
    }
    Ok(())
}

/// A cloud, its pulses and where they came from.
struct Survey<'a> {
    cloud: &'a PointCloud,
    pulses: Pulses,
    scanner: Vec<[f32; 3]>,
    /// Mean height of the ground by cell.
    ground: HashMap<[i64; 2], [f64; 2]>,
}

/// Predictions of each method, and truths.
#[derive(Default)]
struct Found {
    predicted: [Vec<f64>; NAMES.len()],
    truth: Vec<f64>,
}

fn cell(place: [f64; 3]) -> [i64; 2] {
    #[expect(clippy::cast_possible_truncation, reason = "local positions")]
    let number = |v: f64| (v / CELL).floor() as i64;
    [number(place[0]), number(place[1])]
}

impl<'a> Survey<'a> {
    fn new(cloud: &'a PointCloud) -> AnyResult<Self> {
        let none = Control::none();
        let (pulses, _) = group(cloud, &none)?;
        let (scanner, _) = locate(cloud, &Means::Automatic, &LocateParams::default(), &none)?;
        let mut ground: HashMap<[i64; 2], [f64; 2]> = HashMap::new();
        for row in (0..cloud.len()).filter(|&row| class(cloud, row) == 2) {
            let place = cloud.positions[row].map(f64::from);
            let sum = ground.entry(cell(place)).or_default();
            *sum = [sum[0] + place[2], sum[1] + 1.0];
        }
        Ok(Self { cloud, pulses, scanner, ground })
    }

    fn line_of(&self, pulse: usize) -> Option<u16> {
        let row = *self.pulses.returns_of(pulse).first()? as usize;
        self.cloud.attributes.point_source_id.as_ref()?.get(row).copied()
    }

    /// The flight lines without which enough is left.
    fn lines(&self) -> BTreeSet<u16> {
        let Some(ids) = &self.cloud.attributes.point_source_id else { return BTreeSet::new() };
        let mut lines: BTreeSet<u16> = ids.iter().copied().collect();
        let is_left = |line: &u16| ids.iter().filter(|id| *id != line).count() as f64 >= MIN_LEFT * ids.len() as f64;
        lines.retain(is_left);
        lines
    }

    /// Height of the ground at a place, from the cell and those around it.
    fn ground_at(&self, place: [f64; 3]) -> Option<f64> {
        let [east, north] = cell(place);
        let cells = (-1..=1).flat_map(|x| (-1..=1).map(move |y| [east + x, north + y]));
        let sums = cells.filter_map(|at| self.ground.get(&at));
        let [sum, count] = sums.fold([0.0; 2], |all, one| [all[0] + one[0], all[1] + one[1]]);
        (count > 0.0).then(|| sum / count)
    }

    fn judge(&self, is_out: impl Fn(usize) -> bool, found: &mut Found) -> Result<()> {
        let none = Control::none();
        let mut is_kept = vec![true; self.cloud.len()];
        let out: Vec<usize> = (0..self.pulses.len()).filter(|&pulse| is_out(pulse)).collect();
        for &row in out.iter().flat_map(|&pulse| self.pulses.returns_of(pulse)) {
            is_kept[row as usize] = false;
        }
        let kept: Vec<u32> = (0..).zip(&is_kept).filter(|(_, kept)| **kept).map(|(row, _)| row).collect();
        let scanner = kept.iter().map(|&row| self.scanner[row as usize]).collect();
        let params = ModelParams::default().with_orient(OrientBy::ScannerOfEachPoint(scanner));
        let (model, _) = SceneModel::build(&self.cloud.select(&kept), &params, &none)?;
        let Some(medium) = model.medium() else { return Ok(()) };
        let balls = model.scene(&model.rule(), UnprovenAs::Visible, &none)?;
        let solid = model.scene_without_vegetation(&model.rule(), &none)?;
        let positions = SensorPositions::of_points(&self.pulses, &self.scanner);
        for &pulse in &out {
            if let Some(Line { start, towards, range, truth }) = self.line(pulse, positions.per_pulse[pulse]) {
                self.predict(&medium, [&balls, &solid], (start, towards, range), truth, found);
            }
        }
        Ok(())
    }

    fn predict(
        &self,
        medium: &Medium,
        [balls, solid]: [&MedialScene; 2],
        (start, towards, range): ([f64; 3], [f64; 3], f64),
        truth: f64,
        found: &mut Found,
    ) {
        let depth = medium.optical_depth(start, towards, range);
        if depth < MIN_DEPTH {
            return;
        }
        let is_free = |scene: &MedialScene| scene.answer(start, towards, range) != Answer::Blocked;
        let by_balls = f64::from(u8::from(is_free(balls)));
        let of_seasons = if by_balls == 0.0 && is_free(solid) { 0.03 } else { by_balls };
        for (column, value) in found.predicted.iter_mut().zip([by_balls, of_seasons, (-depth).exp()]) {
            column.push(value);
        }
        found.truth.push(truth);
    }

    /// The line of a pulse from the ground or a roof up, and the share of its returns that got there.
    fn line(&self, pulse: usize, scanner: [f32; 3]) -> Option<Line> {
        let returns = self.pulses.returns_of(pulse);
        let place = |row: u32| self.cloud.positions[row as usize].map(f64::from);
        let is_low = |row: u32| self.ground_at(place(row)).is_some_and(|ground| place(row)[2] < ground + GRASS);
        let is_end = |row: u32| matches!(class(self.cloud, row as usize), 2 | 6 | 9) || is_low(row);
        let lowest = returns.iter().copied().min_by(|&a, &b| place(a)[2].total_cmp(&place(b)[2]))?;
        let scanner = scanner.map(f64::from);
        let end = place(lowest);
        let towards = unit(sub(scanner, end)).filter(|towards| towards[2] > 0.2)?;
        let last_plant = returns.iter().filter(|&&row| !is_end(row)).map(|&row| place(row)[2]).reduce(f64::min);
        let behind = |row: &&u32| is_end(**row) && last_plant.is_none_or(|height| place(**row)[2] < height);
        let truth = returns.iter().filter(behind).count() as f64 / returns.len() as f64;
        let down = if is_end(lowest) { 0.0 } else { ((end[2] - self.ground_at(end)?) / towards[2]).max(0.0) };
        let start = std::array::from_fn(|axis| end[axis] + (CLEARANCE - down) * towards[axis]);
        Some(Line { start, towards, range: length(sub(scanner, start)), truth })
    }
}

/// A line of sight to the scanner, and the share of the beam that got along it.
struct Line {
    start: [f64; 3],
    towards: [f64; 3],
    range: f64,
    truth: f64,
}

fn class(cloud: &PointCloud, row: usize) -> u8 {
    cloud.attributes.classification.as_ref().and_then(|classes| classes.get(row)).copied().unwrap_or(0)
}

impl Found {
    fn report(&self, name: &str) {
        let count = self.truth.len();
        for (method, predicted) in NAMES.iter().zip(&self.predicted) {
            let squares: f64 = predicted.iter().zip(&self.truth).map(|(p, t)| (p - t) * (p - t)).sum();
            let (mut error, mut classes) = (0.0, Vec::new());
            for tenth in 0..10 {
                let range = [f64::from(tenth) / 10.0, f64::from(tenth + 1) / 10.0];
                let is_in = |p: &f64| *p >= range[0] && (*p < range[1] || tenth == 9);
                let own: Vec<(f64, f64)> =
                    predicted.iter().zip(&self.truth).filter(|(p, _)| is_in(p)).map(|(p, t)| (*p, *t)).collect();
                let mean = |of: fn(&(f64, f64)) -> f64| own.iter().map(of).sum::<f64>() / own.len().max(1) as f64;
                let (expected, found) = (mean(|pair| pair.0), mean(|pair| pair.1));
                error += own.len() as f64 / count.max(1) as f64 * (expected - found).abs();
                if !own.is_empty() {
                    classes.push(format!("{expected:.2} → {found:.2} ({})", own.len()));
                }
            }
            let mse = squares / count.max(1) as f64;
            println!("{name} | {count} | {method} | {mse:.3} | {:.1} | {}", 100.0 * error, classes.join(", "));
        }
    }
}
