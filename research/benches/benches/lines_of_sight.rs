//! How long do a million lines of sight between pairs, what an observer in a street sees of 360 000 cells, and what
//! these see of the sky, take in a town of a million points?
#![allow(clippy::unwrap_used, reason = "a bench that cannot go on fails")]

mod common;

use belvedere::apps::sky_view::SkyDirections;
use belvedere::control::Control;
use belvedere::medial::{ShrinkParams, Side, shrink};
use belvedere::query::target_tree::TargetTree;
use belvedere::query::{BlockRule, EarthParams, MedialScene, Viewer, Visibility, random_pairs};
use belvedere_benches::Group;

const CELLS: usize = 600;

fn sights() {
    let (cloud, index) = common::indexed(common::aerial_city(1_000_000));
    let (low, high) = cloud.positions().iter().fold(([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]), |(low, high), p| {
        (std::array::from_fn(|i| f32::min(low[i], p[i])), std::array::from_fn(|i| f32::max(high[i], p[i])))
    });
    let (balls, _) = shrink(&cloud, &index, Side::Interior, &ShrinkParams::tau(), &Control::none()).unwrap();
    let scene = MedialScene::new(&balls, &BlockRule::carved()).unwrap();
    // the ground of the city of these benches
    let ground = |x: f32, y: f32| 2.0 * (x / 90.0).sin() + 2.0 * (y / 70.0).cos();
    let side = high[0] / CELLS as f32;
    let cells: Vec<[f32; 3]> = (0..CELLS * CELLS)
        .map(|i| {
            let (x, y) = (((i % CELLS) as f32 + 0.5) * side, ((i / CELLS) as f32 + 0.5) * side);
            [x, y, ground(x, y)]
        })
        .collect();
    // where streets cross, a block of 30 m by 40 m each
    let eyes: Vec<[f64; 3]> = (0..20)
        .map(|i| {
            let (x, y) = (30.0 * (1 + i % 5 * 2) as f32, 40.0 * (1 + i / 5 * 2) as f32);
            [x, y, ground(x, y) + 1.7].map(f64::from)
        })
        .collect();
    let mut group = Group::new("a town of a million points");
    group.sample_size(10);
    let pairs = random_pairs(low, high, 1_000_000, 1);
    group.throughput(pairs.len());
    group.bench_function("a million pairs", |b| {
        b.iter(|| scene.lines_of_sight(&pairs, &EarthParams::default(), &Control::none()).unwrap().len());
    });
    group.throughput(eyes.len() * cells.len());
    group.bench_function("20 observers, cell by cell", |b| {
        b.iter(|| eyes.iter().map(|&eye| scene.visible(Viewer::Eye(eye), &cells).unwrap().len()).sum::<usize>());
    });
    group.bench_function("20 observers, all cells at once", |b| {
        b.iter(|| {
            let tree = TargetTree::new(&cells);
            eyes.iter()
                .map(|&eye| scene.answer_among(Viewer::Eye(eye), &tree, &Control::none()).unwrap().len())
                .sum::<usize>()
        });
    });
    let sky = SkyDirections::patches(1).unwrap();
    let lifted: Vec<[f32; 3]> = cells.iter().map(|&[x, y, z]| [x, y, z + 0.1]).collect();
    group.throughput(sky.directions.len() * lifted.len());
    group.bench_function("145 directions of the sky, all cells", |b| {
        b.iter(|| scene.visibility_matrix(&lifted, &sky.directions, &Control::none()).unwrap().row(0).len());
    });
}

fn main() {
    sights();
}
