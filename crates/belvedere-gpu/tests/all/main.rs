//! Answers of a device equal those of the CPU.
//!
//! The tests run on every device of the computer, software ones among them (Debian: `mesa-vulkan-drivers`).
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]
#![allow(clippy::cast_possible_truncation, reason = "the numbers of tests are small, or made to be f32")]

#[path = "../../../belvedere/tests/all/bounded_views.rs"]
mod bounded_views;
mod depth_bounds;
mod depth_maps;
mod lines;

use belvedere::medial::MedialBalls;
use belvedere::random::uniform;
use belvedere_gpu::{DeviceInfo, devices};
use std::io::Write;
use std::path::PathBuf;

fn skipped(what: &str) {
    let _ = writeln!(std::io::stderr().lock(), "SKIPPED {what}");
}

fn devices_or_skip(test: &str) -> Vec<DeviceInfo> {
    let found = devices();
    if found.is_empty() {
        skipped(&format!("{test}: this computer has no device with a driver for Vulkan, Metal or DirectX 12"));
    }
    found
}

fn balls_of(balls: impl Iterator<Item = ([f64; 3], f64)>) -> MedialBalls {
    let mut all = MedialBalls::default();
    for (center, radius) in balls {
        all.centers.push(center.map(|v| v as f32));
        all.radii.push(radius as f32);
        all.source.push(0);
        all.touch.push(0);
        all.separation_angles.push(1.0);
    }
    all
}

/// Balls in a box of some size.
fn random_balls(count: u64, size: [f64; 3], largest: f64) -> impl Iterator<Item = ([f64; 3], f64)> {
    (0..count).map(move |i| {
        let random = |k: u64| uniform(21, 4 * i + k);
        let center = std::array::from_fn(|axis| (random(axis as u64) - 0.5) * size[axis]);
        (center, largest * random(3).powi(3))
    })
}

/// The file at `relative` under `BELVEDERE_TEST_DATA` (default: `shared` beside the repository), or `None` after saying
/// that the test is skipped.
fn data(test: &str, relative: &str) -> Option<PathBuf> {
    let root = std::env::var_os("BELVEDERE_TEST_DATA")
        .map_or_else(|| PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared")), PathBuf::from);
    let path = root.join(relative);
    if !path.exists() {
        skipped(&format!("{test} ({relative}): there is no reference data; name its folder in BELVEDERE_TEST_DATA"));
        return None;
    }
    Some(path)
}
