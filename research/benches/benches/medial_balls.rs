//! How many points a second become balls on both sides, and does the cost of a point stay the same as clouds grow?
//!
//! Set `BELVEDERE_BENCH_LARGE` to also measure 5 million points (a minute or two).
#![allow(clippy::unwrap_used, reason = "a bench that cannot go on fails")]

mod common;

use belvedere::control::Control;
use belvedere::medial::{ShrinkParams, Side, shrink};
use belvedere::neighbors::NeighborIndex;
use belvedere::normals::OrientedCloud;
use belvedere::normals::estimate::{Neighborhood, estimate};
use belvedere_benches::Group;

fn both_sides(cloud: &OrientedCloud, index: &NeighborIndex, params: &ShrinkParams) -> usize {
    [Side::Interior, Side::Exterior]
        .into_iter()
        .map(|side| shrink(cloud, index, side, params, &Control::none()).unwrap().1.shrunk)
        .sum()
}

fn growth() {
    let mut group = Group::new("both sides, simulated city");
    group.sample_size(10);
    let mut counts = vec![100_000, 1_000_000];
    if std::env::var_os("BELVEDERE_BENCH_LARGE").is_some() {
        counts.push(5_000_000);
    }
    for count in counts {
        let (cloud, index) = common::indexed(common::aerial_city(count));
        group.throughput(count);
        for (name, params) in [("angles", ShrinkParams::angles()), ("tau", ShrinkParams::tau())] {
            group.bench_function(format!("{name}, {count} points"), |b| b.iter(|| both_sides(&cloud, &index, &params)));
        }
    }
}

fn real_tile() {
    let Some(delft) = common::delft() else { return };
    let mut group = Group::new("Delft");
    group.sample_size(10).throughput(delft.0.len());
    group.bench_function("index", |b| b.iter(|| NeighborIndex::new(&delft.0, &Control::none()).unwrap().len()));
    let (cloud, index) = common::indexed(delft);
    group.bench_function("normals of 16 neighbours", |b| {
        b.iter(|| {
            estimate(cloud.positions(), &index, Neighborhood::default(), &Control::none()).unwrap().quality.len()
        });
    });
    group.bench_function("both sides, angles, initial radius 200 m", |b| {
        b.iter(|| both_sides(&cloud, &index, &ShrinkParams::angles()));
    });
    group.bench_function("both sides, tau", |b| b.iter(|| both_sides(&cloud, &index, &ShrinkParams::tau())));
}

fn main() {
    growth();
    real_tile();
}
