//! The surface at the middle of cells, on roofs whose heights are formulas.

use belvedere::control::Control;
use belvedere::ground::{Ground, MapGrid, SurfaceParams, highest_points, top_surface};
use belvedere::random::uniform;
use belvedere::raster::Raster;

/// Half the width of the building, metres.
const HALF: f64 = 6.0;
/// Height of its eaves, metres.
const EAVES: f64 = 5.0;

fn ground(cell: f64) -> Ground {
    let grid = MapGrid::covering([-20.0; 2], [19.9; 2], cell, [0.0; 2]).unwrap();
    let level = || Raster::filled(grid.width, grid.height, 0.0);
    Ground { grid, heights: level(), gaps: level() }
}

/// Eleven returns a square metre over 40 by 40 m from a surface above the map, with 2 cm of noise.
fn returns(surface: impl Fn([f64; 2]) -> f64) -> Vec<[f32; 3]> {
    let noise = |i| 0.02 * 3f64.sqrt() * (2.0 * uniform(3, i) - 1.0);
    (0..11 * 1600)
        .map(|i| {
            let at = [40.0 * uniform(1, i) - 20.0, 40.0 * uniform(2, i) - 20.0];
            [at[0], at[1], surface(at) + noise(i)].map(|v| v as f32)
        })
        .collect()
}

/// A gabled roof of 45 degrees over level ground, its ridge running north.
fn gable([x, y]: [f64; 2]) -> f64 {
    if x.abs() < HALF && y.abs() < HALF { EAVES + HALF - x.abs() } else { 0.0 }
}

/// Errors at the middles of cells whose distance to eaves and borders is at least `away` metres.
fn errors(found: &Raster<f32>, ground: &Ground, away: f64) -> Vec<f64> {
    let grid = ground.grid;
    let mut errors = Vec::new();
    for row in 0..grid.height {
        for column in 0..grid.width {
            let at = grid.center(column, row);
            let is_far = |v: f64| (v.abs() - HALF).abs() >= away && v.abs() < 19.0;
            if at.iter().all(|&v| is_far(v)) {
                errors.push(f64::from(found.get(column, row).unwrap()) - gable(at));
            }
        }
    }
    errors
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

#[test]
fn on_roofs_and_streets_the_surface_is_that_at_the_middle() {
    let points = returns(gable);
    for cell in [0.25, 0.5, 1.0, 3.0] {
        let ground = ground(cell);
        let found = top_surface(&points, &ground, &SurfaceParams::default(), &Control::none()).unwrap();
        let errors = errors(&found, &ground, 0.75);
        let absolute: Vec<f64> = errors.iter().map(|v| v.abs()).collect();
        // twelve points with noise of 2 cm; at the ridge their plane cuts the corner by a few cm
        assert!(mean(&absolute) < 0.02 && mean(&errors).abs() < 0.01, "{cell}: {} {}", mean(&absolute), mean(&errors));
        assert!(absolute.iter().all(|&error| error < 0.35), "{cell}");
        let highest = highest_points(&points, &ground);
        let highest: Vec<f64> = self::errors(&highest, &ground, 0.75).iter().map(|v| v.abs()).collect();
        assert!(mean(&highest) > 2.0 * mean(&absolute), "{cell}: highest points are {} m off", mean(&highest));
    }
}

#[test]
fn at_eaves_cells_are_of_the_roof_or_of_the_ground_never_between() {
    let points = returns(|[x, _]| if x < 0.0 { 6.0 } else { 0.0 });
    let ground = ground(0.5);
    let found = top_surface(&points, &ground, &SurfaceParams::default(), &Control::none()).unwrap();
    for (cell, &height) in found.values().iter().enumerate() {
        let [x, _] = ground.grid.center(cell % ground.grid.width, cell / ground.grid.width);
        assert!(height.abs() < 0.1 || (height - 6.0).abs() < 0.1, "{height} at {x}");
        // half a cell is looked at, and where that is empty the nearest point
        assert!(x.abs() < 0.8 || (height > 3.0) == (x < 0.0), "{height} at {x}");
    }
}

#[test]
fn a_crown_keeps_its_highest_points() {
    let points = returns(|[x, y]| 8.0 + 3.0 * uniform(9, (1e6 * (x + 20.0) + y) as u64));
    let ground = ground(1.0);
    let found = top_surface(&points, &ground, &SurfaceParams::default(), &Control::none()).unwrap();
    let highest = highest_points(&points, &ground);
    let same = found.values().iter().zip(highest.values()).filter(|(a, b)| a == b).count();
    // points of a few cells lie on a plane by chance
    assert!(same as f64 > 0.95 * found.values().len() as f64, "{same}");
    // and never higher than a point
    let top = highest.values().iter().copied().fold(f32::NEG_INFINITY, f32::max);
    assert!(found.values().iter().all(|&height| height <= top));
}

#[test]
fn far_from_points_and_without_them_the_ground_is_kept_and_nonsense_refused() {
    let ground = ground(0.5);
    let lone = top_surface(&[[0.0, 0.0, 7.0]], &ground, &SurfaceParams::default(), &Control::none()).unwrap();
    let at = |[x, y]: [f64; 2]| {
        let [column, row] = ground.grid.cell_of([x, y]).unwrap();
        lone.get(column, row).unwrap()
    };
    assert_eq!((at([0.1, 0.1]), at([10.0, 10.0])), (7.0, 0.0));
    assert_eq!(
        top_surface(&[], &ground, &SurfaceParams::default(), &Control::none()).unwrap().values(),
        ground.heights.values()
    );
    assert!(top_surface(&[[0.0, f32::NAN, 1.0]], &ground, &SurfaceParams::default(), &Control::none()).is_err());
    let usual = SurfaceParams::default();
    for params in [
        SurfaceParams { neighbors: 2, ..usual },
        SurfaceParams { neighbors: 257, ..usual },
        SurfaceParams { step: 0.0, ..usual },
        SurfaceParams { step: f64::NAN, ..usual },
        SurfaceParams { roughness: -0.1, ..usual },
        SurfaceParams { roughness: f64::INFINITY, ..usual },
    ] {
        assert!(top_surface(&[[0.0; 3]], &ground, &params, &Control::none()).is_err(), "{params:?}");
    }
}

#[test]
fn the_number_of_threads_does_not_matter() {
    let points = returns(gable);
    let ground = ground(0.5);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let found =
            pool.install(|| top_surface(&points, &ground, &SurfaceParams::default(), &Control::none()).unwrap());
        found.values().iter().map(|v| v.to_bits()).collect::<Vec<u32>>()
    };
    assert!(on(1) == on(4));
}
