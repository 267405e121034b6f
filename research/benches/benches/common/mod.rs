//! Clouds to measure on: a simulated aerial city of any size, and the Delft tile where the shared data are present.
#![allow(dead_code, reason = "each bench uses the part it needs")]
#![allow(clippy::cast_possible_truncation, reason = "local coordinates")]
#![allow(clippy::unwrap_used, reason = "a bench that cannot go on fails")]

use belvedere::control::Control;
use belvedere::neighbors::NeighborIndex;
use belvedere::normals::OrientedCloud;
use std::path::PathBuf;

/// Positions and outward normals.
pub(crate) type Oriented = (Vec<[f32; 3]>, Vec<[f32; 3]>);

/// About `count` points at 8 a square metre: gabled and flat blocks on gentle ground, with sparse walls and 2 cm noise,
/// and their outward normals.
pub(crate) fn aerial_city(count: usize) -> Oriented {
    let side = (count as f64 / 8.0).sqrt();
    let u = |i: usize, k: u64| belvedere::random::uniform(7, 8 * i as u64 + k);
    (0..count)
        .map(|i| {
            let (x, y) = (side * u(i, 0), side * u(i, 1));
            let noise = 0.04 * (u(i, 2) - 0.5);
            let (across, along) = (x % 30.0 - 15.0, y % 40.0 - 20.0);
            let block = (x / 30.0) as usize * 31 + (y / 40.0) as usize * 17;
            let eaves = 5.0 + (block % 7) as f64 * 1.5;
            let ground = 2.0 * (x / 90.0).sin() + 2.0 * (y / 70.0).cos();
            let inside = across.abs() < 8.0 && along.abs() < 14.0;
            let (p, n) = if inside && u(i, 3) < 0.06 {
                let s = across.signum();
                ([x - across + 8.0 * s + noise, y, ground + eaves * u(i, 4)], [s, 0.0, 0.0])
            } else if inside && block.is_multiple_of(2) {
                let s = across.signum() * std::f64::consts::FRAC_1_SQRT_2;
                ([x, y, ground + eaves + 8.0 - across.abs() + noise], [s, 0.0, s.abs()])
            } else if inside {
                ([x, y, ground + eaves + noise], [0.0, 0.0, 1.0])
            } else {
                ([x, y, ground + noise], [0.0, 0.0, 1.0])
            };
            (p.map(|v| v as f32), n.map(|v| v as f32))
        })
        .unzip()
}

/// Coordinates and normals of the Delft tile, 640 510 points, or `None` after saying so.
pub(crate) fn delft() -> Option<Oriented> {
    let root = std::env::var_os("BELVEDERE_TEST_DATA")
        .map_or_else(|| PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared")), PathBuf::from);
    let read = |name: &str| -> Option<Vec<[f32; 3]>> {
        let file = std::fs::File::open(root.join("reference/delft1").join(name)).ok()?;
        let values: Vec<f32> = npyz::NpyFile::new(file).ok()?.into_vec().ok()?;
        Some(values.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect())
    };
    let clouds = read("coords.npy").zip(read("normals.npy"));
    if clouds.is_none() {
        eprintln!("SKIPPED delft: reference/delft1 is not under BELVEDERE_TEST_DATA");
    }
    clouds
}

pub(crate) fn indexed((positions, normals): Oriented) -> (OrientedCloud, NeighborIndex) {
    let index = NeighborIndex::new(&positions, &Control::none()).unwrap();
    (OrientedCloud::with_known_normals(positions, normals).unwrap(), index)
}
