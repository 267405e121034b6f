//! Horizons of elevation rasters against closed forms and against casts that pass over every cell.

use crate::common::data;
use crate::mountains::{grid, mountains};
use belvedere::ElevationGrid;
use belvedere::control::Control;
use belvedere::ground::{Ground, GroundParams, MapGrid};
use belvedere::horizon::HorizonProfile;
use belvedere::io::{ReadOptions, read_cloud};
use belvedere::medial::MedialBalls;
use belvedere::query::{BlockRule, Curvature, EarthParams, FarTerrain, MedialScene};
use belvedere::random::uniform;
use belvedere::view::to_sun;
use std::f64::consts::{FRAC_PI_2, TAU};

fn far(grid: ElevationGrid) -> FarTerrain {
    FarTerrain::default().with_grid(grid, None)
}

fn horizon(far: &FarTerrain, place: [f64; 3], count: usize, earth: &EarthParams) -> Vec<f64> {
    far.elevations(place, [0.0, TAU / count as f64], count, earth)
}

/// The elevation of the horizon by a walk from patch to patch, with many heights in each. It knows nothing of maxima.
fn cast(grid: &ElevationGrid, place: [f64; 3], azimuth: f64, from: f64, earth: &EarthParams) -> f64 {
    let (heights, cell, [west, north]) = (grid.heights(), grid.cell(), grid.north_west());
    let (sin, cos) = azimuth.sin_cos();
    let rate = if earth.curvature == Curvature::Off { 0.0 } else { (1.0 - earth.refraction) / (2.0 * earth.radius) };
    let reach = cell[0] * heights.width() as f64 + cell[1] * heights.height() as f64;
    let mut spans = vec![from];
    for (slope, start, side, count) in
        [(sin, place[0] - west, cell[0], heights.width()), (-cos, north - place[1], cell[1], heights.height())]
    {
        let crossings = (0..count).map(|i| (i as f64 * side - start) / slope);
        spans.extend(crossings.filter(|span| *span > from && *span < reach));
    }
    spans.sort_by(f64::total_cmp);
    let mut highest = f64::NEG_INFINITY;
    for pair in spans.windows(2) {
        for part in 0..=32 {
            let span = pair[0] + (pair[1] - pair[0]) * (f64::from(part) / 32.0);
            let middle = f64::midpoint(pair[0], pair[1]);
            let patch = [(place[0] + sin * middle - west) / cell[0], (north - place[1] - cos * middle) / cell[1]];
            if patch[0] < 0.0 || patch[1] < 0.0 {
                continue;
            }
            let [column, row] = patch.map(|v| v as usize);
            let (u, v) = (
                (place[0] + sin * span - west) / cell[0] - column as f64,
                (north - place[1] - cos * span) / cell[1] - row as f64,
            );
            let at = |c: usize, r: usize| heights.get(column + c, row + r).map_or(f64::NAN, f64::from);
            let height = (1.0 - v) * ((1.0 - u) * at(0, 0) + u * at(1, 0)) + v * ((1.0 - u) * at(0, 1) + u * at(1, 1));
            // NaN is never the larger one
            highest = highest.max((height - place[2] - rate * span * span) / span);
        }
    }
    if highest == f64::NEG_INFINITY { -FRAC_PI_2 } else { highest.atan() }
}

/// The largest difference, degrees, between horizons and casts over every cell, for places at a height above the
/// terrain.
fn worst(far: &FarTerrain, places: &[[f64; 3]], azimuths: usize, from: f64) -> f64 {
    let (grid, earth) = (far.grid().unwrap(), EarthParams::default());
    let mut worst = 0.0_f64;
    for &place in places {
        for (i, found) in horizon(far, place, azimuths, &earth).into_iter().enumerate() {
            let cast = cast(grid, place, i as f64 * TAU / azimuths as f64, from, &earth);
            // the cast misses what lies between its samples, and can find nothing that is not there
            assert!(found >= cast - 1e-9, "{place:?} {i}: {} < {}", found.to_degrees(), cast.to_degrees());
            worst = worst.max(found - cast);
        }
    }
    worst.to_degrees()
}

/// Places at random on the middle half of a raster, 2 m above it.
fn places(grid: &ElevationGrid, count: u64) -> Vec<[f64; 3]> {
    let (low, high) = grid.on_map();
    let place = |i: u64| {
        let at: [f64; 2] =
            [0, 1].map(|axis| low[axis] + (high[axis] - low[axis]) * (0.25 + 0.5 * uniform(11, 2 * i + axis as u64)));
        let node = [(at[0] - low[0]) / grid.cell()[0], (high[1] - at[1]) / grid.cell()[1]].map(|v| v.round() as usize);
        [at[0], at[1], f64::from(grid.heights().get(node[0], node[1]).unwrap()) + 2.0]
    };
    (0..count).map(place).filter(|place| place[2].is_finite()).collect()
}

#[test]
fn a_cone_a_wall_and_the_sea_stand_as_high_as_geometry_says() {
    let flat = EarthParams::flat();
    // the top of a cone on a node 5 km to the north-east
    let cone = far(grid(401, 25.0, |x, y| (800.0 - 0.9 * (x - 7500.0).hypot(y + 2500.0)).max(0.0)));
    let place = [2500.0, -7500.0, 30.0];
    let found = cone.elevations(place, [TAU / 8.0, 1.0], 1, &flat)[0];
    assert!((found - (770.0 / 5000.0 / 2f64.sqrt()).atan()).abs() < 1e-9);
    // over the curved earth it sinks by 6/7 of s²/2R
    let span = 5000.0 * 2f64.sqrt();
    let fall = 6.0 / 7.0 * span * span / (2.0 * 6_371_008.8);
    let curved = cone.elevations(place, [TAU / 8.0, 1.0], 1, &EarthParams::default())[0];
    assert!((curved - ((770.0 - fall) / span).atan()).abs() < 1e-9 && curved < found - 3e-4);
    // a wall 1 km away all around: within a cell of where it begins
    let wall = far(grid(401, 10.0, |x, y| if (x - 2000.0).hypot(y + 2000.0) < 1000.0 { 0.0 } else { 120.0 }));
    for elevation in horizon(&wall, [2000.0, -2000.0, 1.7], 360, &flat) {
        assert!((118.3 / 1015.0..118.3 / 999.0).contains(&elevation.tan()), "{}", elevation.to_degrees());
    }
    // the dip of the sea from 50 m: tan = -2 √(h c)
    let sea = far(grid(101, 1000.0, |_, _| 0.0));
    let dip = -2.0 * (50.0f64 * 6.0 / 7.0 / (2.0 * 6_371_008.8)).sqrt();
    for elevation in horizon(&sea, [50_000.0, -50_000.0, 50.0], 90, &EarthParams::default()) {
        assert!((elevation.tan() - dip).abs() < 1e-12, "{}", elevation.to_degrees());
    }
}

#[test]
fn horizons_of_mountains_are_those_of_a_cast_over_every_cell() {
    // 24 km of ridges at 60 m, and at odd sizes
    for (count, cell) in [(401, 60.0), (130, 90.0), (3, 2000.0), (2, 500.0)] {
        let far = far(mountains(count, cell, 2000.0));
        let places = places(far.grid().unwrap(), 12);
        let worst = worst(&far, &places, 72, cell);
        assert!(worst < 0.01, "{count} x {cell} m: {worst} degrees");
    }
    // with holes, which block nothing
    let mut heights = mountains(200, 60.0, 2000.0).heights().clone();
    (0..4000).for_each(|i| heights.values_mut()[(uniform(3, i) * 40_000.0) as usize] = f32::NAN);
    let holes = far(ElevationGrid::new(heights, [0.0, 0.0], [60.0; 2]).unwrap());
    let worst = worst(&holes, &places(holes.grid().unwrap(), 12), 72, 60.0);
    assert!(worst < 0.01, "{worst} degrees");
}

#[test]
fn horizons_of_real_terrain_are_those_of_a_cast_over_every_cell() {
    let test = "horizons_of_real_terrain_are_those_of_a_cast_over_every_cell";
    let Some(path) = data(test, "data/terrain/Topography.laz") else { return };
    let (cloud, _) = read_cloud([&path], &ReadOptions::default(), &Control::none()).unwrap();
    let bounds = belvedere::Bounds::around(cloud.positions.iter().copied()).unwrap();
    let (low, high) = bounds.on_map();
    let cells = MapGrid::covering(low, high, 1.0, [0.0; 2]).unwrap();
    let (ground, _) = Ground::of_cloud(&cloud, cells, &GroundParams::default(), &Control::none()).unwrap();
    let far = far(ElevationGrid::new(ground.heights, cells.center(0, 0), [1.0; 2]).unwrap());
    let places = places(far.grid().unwrap(), 30);
    assert!(places.len() > 20);
    let worst = worst(&far, &places, 72, 1.0);
    assert!(worst < 0.05, "{worst} degrees");
}

#[test]
fn terrain_counts_from_a_cell_beyond_the_cloud_on() {
    // a tower on every node, as high as the node is far from the middle, over a cloud of 400 m
    let cell = 20.0;
    let tower = |at: f64| move |x: f64, y: f64| if x == at && y == -1000.0 { 100.0 } else { 0.0 };
    let cloud = ([800.0, -1200.0], [1200.0, -800.0]);
    let east = |at: f64, from: [f64; 3]| {
        let far = FarTerrain::default().with_grid(grid(101, cell, tower(at)), Some(cloud));
        far.elevations(from, [FRAC_PI_2, 1.0], 1, &EarthParams::flat())[0].tan()
    };
    // the slope of a tower begins a cell before it
    let place = [1000.0, -1000.0, 0.0];
    for (at, expected) in [(1100.0, 0.0), (1200.0, 0.0), (1240.0, 100.0 / 240.0), (1300.0, 100.0 / 300.0)] {
        assert!((east(at, place) - expected).abs() < 1e-9, "{at}: {}", east(at, place));
    }
    // on the flat outside of the tower nothing rises above a place of the cloud, how near to its edge it may be
    for x in [810.0, 1000.0, 1199.9, 1200.0] {
        assert!(east(400.0, [x, -1000.0, 0.0]).abs() < 1e-12);
        assert!(east(400.0, [x, -1000.0, 0.1]) < 0.0);
    }
    // and from outside of the cloud what is within it counts, but not the ground around the feet
    assert!((east(1000.0, [500.0, -1000.0, 0.0]) - 100.0 / 500.0).abs() < 1e-9);
    assert!(east(400.0, [400.0, -1000.0, 0.0]).abs() < 1e-12);
}

#[test]
fn every_bit_of_the_matrix_is_the_answer_of_a_line_of_sight_before_mountains() {
    let terrain = mountains(160, 60.0, 1500.0);
    let cloud = ([4000.0, -5200.0], [4400.0, -4800.0]);
    let middle = places(&terrain, 1)[0][2];
    // one ball far away, so that the usual way is taken
    let balls = MedialBalls {
        centers: vec![[4200.0, -5000.0, -900.0]],
        radii: vec![1.0],
        source: vec![0],
        touch: vec![0],
        separation_angles: vec![1.0],
    };
    let profile = HorizonProfile::new([[0.0, 0.02], [2.0, 0.3], [4.0, -0.1]]).unwrap();
    let alone = FarTerrain::default().with_grid(terrain, Some(cloud));
    let both = alone.clone().with_profile(profile.clone());
    let mut targets: Vec<[f32; 3]> = (0..3000)
        .map(|i| {
            let u = |k: u64| uniform(21, 8 * i + k);
            [4000.0 + 400.0 * u(0), -5200.0 + 400.0 * u(1), middle + 60.0 * u(2)].map(|v| v as f32)
        })
        .collect();
    targets.push([f32::NAN; 3]);
    let directions: Vec<[f64; 3]> = (0..300)
        .map(|i| to_sun(TAU * uniform(22, i), FRAC_PI_2 * uniform(23, i).powi(2) - 0.1))
        .chain([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]])
        .collect();
    for far in [alone, both] {
        let scene = MedialScene::new(&balls, &BlockRule::default()).unwrap().with_far_terrain(far.clone());
        let matrix = scene.visibility_matrix(&targets, &directions, &Control::none()).unwrap();
        let mut free = 0;
        for (row, target) in targets.iter().enumerate() {
            for (column, direction) in directions.iter().enumerate() {
                let is_free = target[0].is_finite() && !far.hides(target.map(f64::from), *direction);
                assert_eq!(matrix.is_free(row, column), is_free, "{target:?} {direction:?}");
                free += usize::from(is_free);
            }
        }
        let share = free as f64 / (targets.len() * directions.len()) as f64;
        assert!((0.3..0.97).contains(&share), "{share}");
        // horizon angles and lines of sight agree but for rounding
        let place = targets[0].map(f64::from);
        let skyline = scene.skyline(place, 90, &EarthParams::default(), &Control::none()).unwrap();
        for (i, point) in skyline.iter().enumerate() {
            let at = |elevation: f64| far.hides(place, to_sun(i as f64 * TAU / 90.0, elevation));
            assert!(at(point.elevation - 1e-9) && !at(point.elevation + 1e-9), "{i} {point:?}");
        }
        let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        let alone = one.install(|| scene.visibility_matrix(&targets, &directions, &Control::none()).unwrap());
        assert!(alone == matrix);
    }
}
