//! How long does a depth map of a million balls take from above and under a low sun, and how long a million queries on
//! it?
#![allow(clippy::unwrap_used, reason = "a bench that cannot go on fails")]

mod common;

use belvedere::control::Control;
use belvedere::depth::{ItemBuffer, Profile, depth_map};
use belvedere::medial::{MedialBalls, ShrinkParams, Side, shrink};
use belvedere::query::{query_points, random_targets};
use belvedere::view::{View, to_sun};
use belvedere_benches::Group;

fn scene() -> (&'static str, MedialBalls, [f32; 3], [f32; 3]) {
    let (name, cloud) = match common::delft() {
        Some(delft) => ("Delft", delft),
        None => ("simulated city", common::aerial_city(640_000)),
    };
    let (low, high) = cloud.0.iter().fold(([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]), |(low, high), p| {
        (std::array::from_fn(|i| low[i].min(p[i])), std::array::from_fn(|i| high[i].max(p[i])))
    });
    let (cloud, index) = common::indexed(cloud);
    let (balls, _) = shrink(&cloud, &index, Side::Interior, &ShrinkParams::angles(), &Control::none()).unwrap();
    (name, balls, low, high)
}

fn maps_and_queries() {
    let (name, balls, low, high) = scene();
    let mut group = Group::new(name);
    group.sample_size(20);
    for (azimuth, elevation) in [(0.0f64, 90.0f64), (180.0, 35.0), (240.0, 12.0)] {
        let forward = to_sun(azimuth.to_radians(), elevation.to_radians()).map(|v| -v);
        let view = View::parallel(forward, low.map(f64::from), high.map(f64::from), 0.25).unwrap();
        for items in [ItemBuffer::Without, ItemBuffer::With] {
            group.throughput(balls.len());
            group.bench_function(format!("depth map, sun {elevation} degrees high, items {items:?}"), |b| {
                b.iter(|| depth_map(&balls, &view, Profile::Sphere, items, &Control::none()).unwrap().depth.width());
            });
        }
        let map = depth_map(&balls, &view, Profile::Sphere, ItemBuffer::Without, &Control::none()).unwrap();
        let targets = random_targets(low, high, 1_000_000, 1);
        group.throughput(targets.len());
        group.bench_function(format!("a million queries, sun {elevation} degrees high"), |b| {
            b.iter(|| query_points(&map, &targets, 0.1).len());
        });
    }
}

fn main() {
    maps_and_queries();
}
