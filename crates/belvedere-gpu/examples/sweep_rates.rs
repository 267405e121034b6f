//! How fast is each stage of a question about many directions, on the CPU and on a device, and how far from the limit of memory traffic?
//!
//!     cargo run --release -p belvedere-gpu --example sweep_rates -- [DEVICE] [BALLS] [TARGETS]
//!
//! The scene is a simulated place of 400 m with ground, blocks and crowns. Without a device it lists what there is.

use belvedere_core::medial::MedialBalls;
use belvedere_core::query::cpu::{Heading, Place, SpaceLayers, sweep_all};
use belvedere_core::query::{Backend, BallTree, BlockRule, Cpu, MedialScene};
use belvedere_data::Result;
use belvedere_data::control::Control;
use belvedere_data::random::uniform;
use belvedere_gpu::{Choice, Gpu, devices};
use std::io::Write;
use std::sync::Arc;
use std::time::Instant;

/// Side of the scene, metres.
const SIDE: f64 = 400.0;
const DIRECTIONS: u32 = 577;
/// How far a line of sight is known, metres: about what a scene uses.
const NEAR: f64 = 2.0;
/// Places and headings between two that are counted step by step.
const SAMPLE: [usize; 2] = [97, 7];
/// Whole-number operations of a step in `sweep.wgsl`, counted by hand: 2 for the loop, 2 additions, 12 comparisons of borders, 6 for the word and the bit, 3 for
/// the test.
const OPERATIONS: f64 = 25.0;

fn place(count: u64) -> MedialBalls {
    let mut balls = MedialBalls::default();
    for i in 0..count {
        let u = |k: u64| uniform(31, 8 * i + k);
        let (x, y) = (SIDE * u(0), SIDE * u(1));
        let (z, radius) = match i % 3 {
            0 => (-2.0 + 0.2 * u(2), 2.0),
            1 => ((12.0 * u(2)), 0.3 + 1.5 * u(3) * f64::from(u8::from((x / 25.0).fract() < 0.5))),
            _ => (4.0 + 12.0 * u(2), 0.1 + 0.4 * u(3)),
        };
        #[expect(clippy::cast_possible_truncation, reason = "positions are f32")]
        balls.centers.push([x, y, z].map(|v| v as f32));
        #[expect(clippy::cast_possible_truncation, reason = "radii are f32")]
        balls.radii.push(radius as f32);
        balls.source.push(0);
        balls.touch.push(0);
        balls.separation_angles.push(0.0);
    }
    balls
}

fn directions() -> Vec<[f64; 3]> {
    let of = |i: u32| {
        let sine = (f64::from(i) + 0.5) / f64::from(DIRECTIONS);
        let (across, azimuth) = ((1.0 - sine * sine).sqrt(), 2.399_963 * f64::from(i));
        [across * azimuth.cos(), across * azimuth.sin(), sine]
    };
    (0..DIRECTIONS).map(of).collect()
}

/// Steps that the shader takes for a line of sight, and how many of them look at the second layer as well.
fn steps_of(space: &SpaceLayers, place: &Place, heading: &Heading) -> Option<[usize; 2]> {
    let cell = place.cell(heading)?;
    let [width, height, depth] = space.size;
    let own = place.layer(heading);
    let (mut steps, mut both, mut moves) = (0, 0, Vec::new());
    for layer in usize::try_from(own).unwrap_or(0).min(depth - 1)..depth {
        heading.moves_in(layer, &mut moves);
        for by in &moves {
            steps += 1;
            let [Ok(x), Ok(y)] = [0, 1].map(|i| usize::try_from(i64::from(cell[i]) + by[i])) else { continue };
            if x >= width || y >= height {
                continue;
            }
            let word = (layer * height + y) * space.width + x / 64;
            let is_set = |bits: &[u64]| bits[word] >> (x % 64) & 1 == 1;
            if is_set(&space.reached) {
                both += 1;
                if i64::from(own) < layer as i64 && is_set(&space.filled) {
                    return Some([steps, both]);
                }
            }
        }
    }
    Some([steps, both])
}

fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let start = Instant::now();
    let result = work();
    (result, start.elapsed().as_secs_f64())
}

fn main() -> Result<()> {
    let number = |at: usize, default: usize| std::env::args().nth(at).and_then(|n| n.parse().ok()).unwrap_or(default);
    let mut out = std::io::stdout().lock();
    let mut say = |line: String| drop(writeln!(out, "{line}"));
    let found = devices();
    for info in &found {
        say(format!(
            "device {}: {} ({:?}; {}; driver {})",
            info.number, info.name, info.kind, info.interface, info.driver
        ));
    }
    let control = Control::none();
    let (ball_count, target_count) = (number(2, 300_000), number(3, 200_000));
    let balls = place(ball_count as u64);
    let tree = Arc::new(BallTree::new(&balls, &BlockRule::carved())?);
    let directions = directions();
    #[expect(clippy::cast_possible_truncation, reason = "positions are f32")]
    let targets: Vec<[f32; 3]> = {
        let side = (target_count as f64).sqrt();
        let across = |i: usize| SIDE * (i as f64 + 0.5) / side;
        let of = |i: usize| [across(i % side as usize), across(i / side as usize), 0.3].map(|v| v as f32);
        (0..target_count).map(of).collect()
    };
    let lines = (targets.len() * directions.len()) as f64;
    say(format!(
        "{ball_count} balls, {target_count} targets, {} directions: {:.1} million lines of sight",
        directions.len(),
        lines / 1e6
    ));

    let (space, seconds) = timed(|| SpaceLayers::new(tree.balls(), tree.rule(), &control));
    let space = space?;
    let layer_bytes = 16.0 * space.reached.len() as f64;
    say(format!("layers, CPU: {seconds:.3} s, {:?} cells, {:.1} MB", space.size, layer_bytes / 1e6));
    let places: Vec<Option<Place>> = targets.iter().map(|target| Place::new(&space, *target)).collect();
    let headings: Vec<Heading> = directions
        .iter()
        .filter_map(|direction| Heading::new(&space, *direction, (0.6 / direction[2]).min(NEAR)))
        .collect();
    let mut sum = [0.0; 3];
    for (place, heading) in places
        .iter()
        .flatten()
        .step_by(SAMPLE[0])
        .flat_map(|place| headings.iter().step_by(SAMPLE[1]).map(move |heading| (place, heading)))
    {
        if let Some([steps, both]) = steps_of(&space, place, heading) {
            sum = [sum[0] + 1.0, sum[1] + steps as f64, sum[2] + both as f64];
        }
    }
    let swept_lines = (places.len() * headings.len()) as f64;
    let (per_line, both) = (sum[1] / sum[0], sum[2] / sum[0]);
    let (steps, loads) = (per_line * swept_lines, (per_line + both) * swept_lines);
    say(format!(
        "sweep, per line: {per_line:.1} steps, {:.1} words of 4 bytes from layers, {:.0} operations on whole numbers",
        per_line + both,
        OPERATIONS * per_line
    ));
    say(format!(
        "sweep, in all: {steps:.3e} steps, {:.3e} operations, {:.3e} bytes asked of caches, {:.3e} bytes of memory at least",
        OPERATIONS * steps,
        4.0 * loads,
        layer_bytes + 20.0 * places.len() as f64 + swept_lines / 4.0
    ));

    let (on_cpu, cpu_seconds) = timed(|| sweep_all(&space, &places, &headings, &control));
    let on_cpu = on_cpu?;
    say(format!("sweep, CPU: {cpu_seconds:.3} s, {:.1} million lines/s", swept_lines / cpu_seconds / 1e6));
    let prepared = Cpu.prepare(&tree)?;
    prepared.settle(&targets, &directions, &control)?;
    let (_, settle_seconds) = timed(|| prepared.settle(&targets, &directions, &control));
    say(format!("sweep and balls near targets, CPU: {settle_seconds:.3} s"));
    let scene = MedialScene::of_tree((*tree).clone());
    let (_, matrix_seconds) = timed(|| scene.visibility_matrix(&targets, &directions, &control));
    say(format!(
        "the whole matrix, CPU: {matrix_seconds:.3} s; the sweep is {:.0} % of it",
        100.0 * cpu_seconds / matrix_seconds
    ));

    let Some(info) = found.get(number(1, 0)) else {
        say("no device: nothing is measured on one".to_owned());
        return Ok(());
    };
    let gpu = Arc::new(Gpu::new(Choice::Number(info.number))?);
    let warmed: Vec<Heading> = headings.iter().take(1).cloned().collect();
    gpu.sweep(&space, &places, &warmed, &control)?;
    let (on_device, seconds) = timed(|| gpu.sweep(&space, &places, &headings, &control));
    let on_device = on_device?;
    let is_equal = if on_device == on_cpu { "equal" } else { "NOT EQUAL" };
    say(format!(
        "sweep, {} with transfers: {seconds:.3} s, {:.1} million lines/s, {:.2e} steps/s, {:.2} GB/s asked of caches; bits {is_equal}",
        info.name,
        swept_lines / seconds / 1e6,
        steps / seconds,
        4.0 * loads / seconds / 1e9
    ));
    let backed = scene.with_backend(gpu);
    backed.visibility_matrix(&targets[..1.min(targets.len())], &directions, &control)?;
    let (_, seconds) = timed(|| backed.visibility_matrix(&targets, &directions, &control));
    say(format!("the whole matrix, {}: {seconds:.3} s", info.name));
    Ok(())
}
