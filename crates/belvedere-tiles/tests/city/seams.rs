//! Tiles of any size give the balls and the answers of one tile over all.
#![expect(clippy::cast_possible_truncation, reason = "cells of a town are few")]

use crate::common::{plan, run_all, suns, write_town};
use belvedere::control::Control;
use belvedere::io::{read_balls, read_tif_f32, read_tif_u8};
use belvedere_tiles::{Plan, Question, merge, status};
use std::collections::BTreeMap;
use std::path::Path;

/// Values of all cells by their place in local cells, without those of no data.
fn cells<T: Copy + PartialEq>(plan: &Plan, values: &[T], width: usize, none: T) -> BTreeMap<[i64; 2], T> {
    let grid = plan.grid();
    let place = |number: i64| number as f64 * grid.size;
    let west = plan.tiles.iter().map(|tile| tile.east).min().unwrap();
    let north = plan.tiles.iter().map(|tile| tile.north).max().unwrap();
    let corner = [place(west), place(north + 1)].map(|v| (v / plan.cell).round() as i64);
    let cell = |(number, &value): (usize, &T)| {
        let [column, row] = [number % width, number / width].map(|v| v as i64);
        (value != none).then_some(([corner[0] + column, corner[1] - row], value))
    };
    values.iter().enumerate().filter_map(cell).collect()
}

fn shadow_cells(plan: &Plan, folder: &Path, question: &Question) -> BTreeMap<[i64; 2], u8> {
    let path = folder.join("merged.tif");
    merge(plan, folder, question, &path, &Control::none()).unwrap();
    let raster = read_tif_u8(&path).unwrap();
    cells(plan, raster.values(), raster.width(), 255)
}

/// Centres and radii of all balls of a run, as bits, sorted.
fn balls(plan: &Plan, folder: &Path) -> Vec<[u32; 4]> {
    let mut all = Vec::new();
    for tile in &plan.tiles {
        let path = folder.join("balls").join(format!("{}.npz", tile.name()));
        if !path.exists() {
            continue;
        }
        let parts = read_balls(&path).unwrap();
        assert_eq!(parts.frame.origin, plan.frame().unwrap().origin);
        let bits = |(c, r): (&[f32; 3], &f32)| [c[0], c[1], c[2], *r].map(f32::to_bits);
        all.extend(parts.balls.centers.iter().zip(&parts.balls.radii).map(bits));
    }
    all.sort_unstable();
    all
}

#[test]
fn tiles_of_any_size_give_the_balls_and_shadows_of_one_tile_over_all() {
    let place = tempfile::tempdir().unwrap();
    let clouds = write_town(place.path(), 220.0, 0.8);
    let whole_folder = place.path().join("whole");
    let whole = plan(&clouds, &whole_folder, 8192.0, suns());
    assert_eq!(whole.tiles.len(), 1);
    assert!(run_all(&whole, &whole_folder).failed.is_empty());
    let expected_balls = balls(&whole, &whole_folder);
    assert!(expected_balls.len() > 10_000, "{}", expected_balls.len());
    let expected: Vec<_> = suns().iter().map(|sun| shadow_cells(&whole, &whole_folder, sun)).collect();
    for (of_sun, lit_share) in expected.iter().zip([0.05..0.9, 0.2..0.95, 0.6..1.0]) {
        assert!(of_sun.len() > 40_000, "{}", of_sun.len());
        let lit = of_sun.values().filter(|&&value| value == 1).count() as f64 / of_sun.len() as f64;
        assert!(lit_share.contains(&lit), "{lit}");
        assert!(of_sun.values().all(|&value| value < 2), "nothing is missing");
    }
    for size in [75.0, 150.0] {
        let folder = place.path().join(format!("tiles_{size}"));
        let plan = plan(&clouds, &folder, size, suns());
        assert!(plan.tiles.len() >= 9);
        let report = run_all(&plan, &folder);
        assert!(report.failed.is_empty() && report.unproven_cells == 0, "{report:?}");
        assert!(status(&plan, &folder).is_complete());
        let found = balls(&plan, &folder);
        let different = expected_balls.iter().filter(|ball| found.binary_search(ball).is_err()).count();
        assert!(found == expected_balls, "tiles of {size} m: {different} of {} balls differ", expected_balls.len());
        for (sun, expected) in suns().iter().zip(&expected) {
            let found = shadow_cells(&plan, &folder, sun);
            let different = expected.iter().filter(|(place, value)| found.get(*place) != Some(value)).count();
            assert!(found == *expected, "tiles of {size} m, {}: {different} cells differ", sun.name());
        }
    }
}

#[test]
fn sky_view_is_that_of_one_tile_over_all() {
    let place = tempfile::tempdir().unwrap();
    let clouds = write_town(place.path(), 110.0, 1.0);
    let question = Question::SkyView { directions: 49 };
    let factors = |size: f64| {
        let folder = place.path().join(format!("tiles_{size}"));
        let plan = plan(&clouds, &folder, size, vec![question.clone()]);
        assert!(run_all(&plan, &folder).failed.is_empty());
        let path = folder.join("merged.tif");
        merge(&plan, &folder, &question, &path, &Control::none()).unwrap();
        let raster = read_tif_f32(&path).unwrap();
        let bits: Vec<u32> = raster.values().iter().map(|v| v.to_bits()).collect();
        cells(&plan, &bits, raster.width(), (-1.0_f32).to_bits())
    };
    let whole = factors(8192.0);
    // some tiles of 64 m have no point, but cells beside points
    assert!(whole.len() > 8_000);
    assert!(factors(64.0) == whole);
}
