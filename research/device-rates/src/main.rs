//! How fast does a device decide lines of sight in many directions and draw depth maps, and how far is that from the
//! limit of its memory?
//!
//!     cargo research device_rates -- [DEVICE] [CLOUD or BALLS] [TARGETS] [SHARE]
//!
//! With a cloud, the targets are its points; else the scene is a simulated place of 400 m with ground, blocks and
//! crowns, and a grid of targets. Of every SHAREth target bits are compared with those of the CPU. Without a device it
//! lists what there is. Depth maps of the simulated place:
//!
//!     cargo research device_rates -- DEVICE BALLS 0 [METRES] [PIXELS]

mod depth_maps;

use belvedere::control::Control;
use belvedere::io::{ReadOptions, read_cloud};
use belvedere::medial::MedialBalls;
use belvedere::model::{ModelParams, SceneModel};
use belvedere::query::{Backend, BallTree, BlockRule, Cpu, LineAnswer, MedialScene, Settled, UnprovenAs, Viewers};
use belvedere::random::uniform;
use belvedere_core::ray_index::{NODE_WORDS, NodePart, RayIndex};
use belvedere_data::Result;
use belvedere_data::cast::{to_f32, to_f32s, to_index};
use belvedere_gpu::{Choice, Gpu, devices};
use std::io::Write;
use std::sync::Arc;
use std::time::Instant;

/// Side of the simulated place, metres.
const SIDE: f64 = 400.0;
/// Side of pictures, pixels.
const PIXELS: usize = 4096;
const DIRECTIONS: u32 = 577;
/// Observers, at most.
const EYES: usize = 64;
/// Targets and directions between two of which steps are counted.
const SAMPLE: [usize; 2] = [997, 7];

fn place(count: u64, side: f64) -> MedialBalls {
    let mut balls = MedialBalls::default();
    for i in 0..count {
        let u = |k: u64| uniform(31, 8 * i + k);
        let (x, y) = (side * u(0), side * u(1));
        let (z, radius) = match i % 3 {
            0 => (-2.0 + 0.2 * u(2), 2.0),
            1 => ((12.0 * u(2)), 0.3 + 1.5 * u(3) * f64::from(u8::from((x / 25.0).fract() < 0.5))),
            _ => (4.0 + 12.0 * u(2), 0.1 + 0.4 * u(3)),
        };
        balls.centers.push(to_f32s([x, y, z]));
        balls.radii.push(to_f32(radius));
        balls.source.push(0);
        balls.touch.push(0);
        balls.separation_angles.push(0.0);
    }
    balls
}

fn grid(count: usize) -> Vec<[f32; 3]> {
    let side = (count as f64).sqrt();
    let across = |i: usize| SIDE * (i as f64 + 0.5) / side;
    let row = to_index(side);
    let of = |i: usize| to_f32s([across(i % row), across(i / row), 0.3]);
    (0..count).map(of).collect()
}

fn directions() -> Vec<[f64; 3]> {
    let of = |i: u32| {
        let sine = (f64::from(i) + 0.5) / f64::from(DIRECTIONS);
        let (across, azimuth) = ((1.0 - sine * sine).sqrt(), 2.399_963 * f64::from(i));
        [across * azimuth.cos(), across * azimuth.sin(), sine]
    };
    (0..DIRECTIONS).map(of).collect()
}

/// Nodes and balls that a line of sight looks at where it is not ended by the first ball that blocks it.
fn steps_of(index: &RayIndex, from: [f32; 3], towards: [f64; 3]) -> [usize; 2] {
    let (mut nodes, mut balls) = (0, 0);
    let mut waiting: Vec<u32> = index.root().into_iter().collect();
    while let Some(parts) = waiting.pop().and_then(|node| index.parts(node)) {
        nodes += 1;
        for (child, part) in parts.parts.into_iter().enumerate() {
            let (mut enter, mut leave) = (0.0_f64, f64::INFINITY);
            for axis in 0..3 {
                let middle = f64::from(parts.centers[axis][child]) - f64::from(from[axis]);
                let half = f64::from(parts.half_sizes[axis][child]);
                let (a, b) = ((middle - half) / towards[axis], (middle + half) / towards[axis]);
                (enter, leave) = (enter.max(a.min(b)), leave.min(a.max(b)));
            }
            match part {
                NodePart::Rows { count, .. } if enter <= leave => balls += count as usize,
                NodePart::Node(node) if enter <= leave => waiting.push(node),
                _ => {}
            }
        }
    }
    [nodes, balls]
}

fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let start = Instant::now();
    let result = work();
    (result, start.elapsed().as_secs_f64())
}

fn share_open(settled: &Settled, targets: usize, directions: usize) -> f64 {
    let is_open = |&(target, direction): &(usize, usize)| settled.line(target, direction) == LineAnswer::Open;
    let lines = (0..targets).flat_map(|target| (0..directions).map(move |direction| (target, direction)));
    lines.filter(is_open).count() as f64 / (targets * directions) as f64
}

fn main() -> Result<()> {
    let argument = |at: usize| std::env::args().nth(at);
    let number = |at: usize| argument(at).and_then(|n| n.parse::<usize>().ok());
    let mut out = std::io::stdout().lock();
    let mut say = |line: String| drop(writeln!(out, "{line}"));
    let found = devices();
    for info in &found {
        let (number, name, kind, interface, driver) =
            (info.number, &info.name, info.kind, &info.interface, &info.driver);
        say(format!("device {number}: {name} ({kind:?}; {interface}; driver {driver})"));
    }
    if number(3) == Some(0) {
        let side = number(4).map_or(SIDE, |metres| metres as f64);
        let balls = place(number(2).unwrap_or(300_000) as u64, side);
        return match found.get(number(1).unwrap_or(0)) {
            Some(info) => depth_maps::measure(info, &balls, side, number(5).unwrap_or(PIXELS), &mut say),
            None => Ok(()),
        };
    }
    let control = Control::none();
    let most = number(3).unwrap_or(1_000_000);
    let (scene, targets) = match (argument(2), number(2)) {
        (Some(path), None) => {
            let (cloud, _) = read_cloud([path.as_str()], &ReadOptions::new(), &control)?;
            let (model, _) = SceneModel::build(&cloud, &ModelParams::default(), &control)?;
            let targets = cloud.positions.iter().copied().cycle().take(most).collect();
            (model.scene(&model.rule(), UnprovenAs::Visible, &control)?, targets)
        }
        (_, balls) => {
            (MedialScene::new(&place(balls.unwrap_or(300_000) as u64, SIDE), &BlockRule::carved())?, grid(most))
        }
    };
    let tree = Arc::new(BallTree::clone(scene.tree()));
    let directions = directions();
    let lines = (targets.len() * directions.len()) as f64;
    let ball_count = tree.balls().len();
    say(format!(
        "{ball_count} balls, {} targets, {} directions: {:.1} million lines",
        targets.len(),
        directions.len(),
        lines / 1e6
    ));

    let sample = targets
        .iter()
        .step_by(SAMPLE[0])
        .flat_map(|from| directions.iter().step_by(SAMPLE[1]).map(move |towards| (from, towards)));
    let mut sum = [0.0; 3];
    for (from, towards) in sample {
        let [nodes, balls] = steps_of(tree.index(), *from, *towards);
        sum = [sum[0] + 1.0, sum[1] + nodes as f64, sum[2] + balls as f64];
    }
    let per_line = (4 * NODE_WORDS) as f64 * sum[1] / sum[0] + 16.0 * sum[2] / sum[0];
    say(format!(
        "a line that nothing ends looks at {:.1} nodes and {:.1} balls: {per_line:.0} bytes, which caches hold",
        sum[1] / sum[0],
        sum[2] / sum[0]
    ));
    let scene_bytes = (4 * NODE_WORDS * tree.index().node_words().len() + 16 * ball_count) as f64;
    let min_bytes = scene_bytes + 12.0 * targets.len() as f64 + lines / 4.0;
    say(format!(
        "the scene takes {:.1} MB of the device; memory moves {:.1} MB at least",
        scene_bytes / 1e6,
        min_bytes / 1e6
    ));

    if let Some(info) = found.get(number(1).unwrap_or(0)) {
        let gpu = Arc::new(Gpu::new(Choice::Number(info.number))?);
        let prepared = gpu.prepare(&tree)?;
        let (_, first) = timed(|| prepared.settle(&targets[..targets.len().min(1000)], &directions, &control));
        say(format!("{}, first question of 1000 targets, with all that is made once: {first:.3} s", info.name));
        let settle = || prepared.settle(&targets, &directions, &control);
        let mut best = f64::INFINITY;
        for _ in 0..3 {
            best = best.min(timed(settle).1);
        }
        say(format!(
            "{}: {best:.3} s with transfers, {:.1} million lines/s, {:.0} GB/s from caches at most, {:.1} GB/s of memory at least; {:.1e} of lines open",
            info.name,
            lines / best / 1e6,
            per_line * lines / best / 1e9,
            min_bytes / best / 1e9,
            share_open(&settle()?, targets.len(), directions.len()),
        ));
        let eyes: Vec<[f64; 3]> = (targets.iter().step_by(targets.len().div_ceil(EYES)))
            .map(|target| [target[0], target[1], target[2] + 1.6].map(f64::from))
            .collect();
        for eyes in [&eyes[..1], &eyes[..]] {
            let settle = || prepared.settle_few(&targets, Viewers::Eyes(eyes), &control);
            let mut best = f64::INFINITY;
            for _ in 0..5 {
                best = best.min(timed(settle).1);
            }
            let (count, lines) = (eyes.len(), (eyes.len() * targets.len()) as f64);
            say(format!(
                "{}, {count} observers at once: {:.2} ms each with transfers, {:.1} million lines/s",
                info.name,
                1e3 * best / count as f64,
                lines / best / 1e6
            ));
        }
        let backed = MedialScene::of_tree((*tree).clone()).with_backend(gpu);
        backed.visibility_matrix(&targets[..targets.len().min(1000)], &directions, &control)?;
        let (on_device, seconds) = timed(|| backed.visibility_matrix(&targets, &directions, &control));
        say(format!("the whole matrix, {}: {seconds:.3} s", info.name));
        if let Some(share) = number(4) {
            let some: Vec<[f32; 3]> = targets.iter().copied().step_by(share).collect();
            let on_cpu = MedialScene::of_tree((*tree).clone()).visibility_matrix(&some, &directions, &control)?;
            let on_device = on_device?;
            let equal = (0..some.len()).all(|at| on_device.row(at * share) == on_cpu.row(at));
            say(format!("of every {share}th target the bits are {}", if equal { "equal" } else { "NOT EQUAL" }));
        }
    } else {
        say("no device: nothing is measured on one".to_owned());
    }
    let prepared = Cpu.prepare(&tree)?;
    prepared.settle(&targets, &directions, &control)?;
    let (_, seconds) = timed(|| prepared.settle(&targets, &directions, &control));
    say(format!("CPU, before open lines: {seconds:.3} s"));
    let (_, seconds) =
        timed(|| MedialScene::of_tree((*tree).clone()).visibility_matrix(&targets, &directions, &control));
    say(format!("the whole matrix, CPU: {seconds:.3} s, {:.1} million lines/s", lines / seconds / 1e6));
    Ok(())
}
