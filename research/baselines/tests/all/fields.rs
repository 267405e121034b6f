//! Height fields and voxels against brute force over all their cells and triangles.

use crate::common::{TestRandom, blocked, count_true};
use belvedere::Mesh;
use belvedere::query::Viewer;
use belvedere::ray_index::Ray;
use belvedere_baselines::dsm::{Dsm, DsmParams, DsmSurface, GapFill};
use belvedere_baselines::voxels::{VoxelParams, Voxels};

/// Ranges within which a line runs through a box, or `None`.
fn within_box(origin: [f64; 3], direction: [f64; 3], low: [f64; 3], high: [f64; 3]) -> Option<[f64; 2]> {
    let (mut from, mut to) = (f64::NEG_INFINITY, f64::INFINITY);
    for i in 0..3 {
        if direction[i] == 0.0 {
            if origin[i] < low[i] || origin[i] > high[i] {
                return None;
            }
        } else {
            let (a, b) = ((low[i] - origin[i]) / direction[i], (high[i] - origin[i]) / direction[i]);
            from = from.max(a.min(b));
            to = to.min(a.max(b));
        }
    }
    (from <= to).then_some([from, to])
}

/// Directions and eyes, straight up and along the axes among them.
fn lines(random: &mut TestRandom, count: usize, size: [f64; 3]) -> Vec<([f32; 3], Viewer<'static>)> {
    (0..count)
        .map(|i| {
            let target = random.point([-2.0, -2.0, 0.0], size);
            let axis = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]];
            let viewer = match i % 10 {
                0..4 => Viewer::Direction(axis[i % 10]),
                4..7 => Viewer::Direction(random.direction()),
                _ => Viewer::Eye(random.point([-2.0, -2.0, 0.0], size).map(f64::from)),
            };
            (target, viewer)
        })
        .collect()
}

/// Rough heights, (rows, columns), and one point in the middle of each cell.
fn heights(random: &mut TestRandom, columns: usize, rows: usize, cell: f64) -> (Vec<Vec<f64>>, Vec<[f32; 3]>) {
    let heights: Vec<Vec<f64>> =
        (0..rows).map(|_| (0..columns).map(|_| f64::from(random.between(0.0, 3.0).powi(2) as f32)).collect()).collect();
    let middle = |i: usize| ((i as f64 + 0.5) * cell) as f32;
    let points = (0..rows)
        .flat_map(|row| (0..columns).map(move |column| (row, column)))
        .map(|(row, column)| [middle(column), middle(row), heights[row][column] as f32])
        .collect();
    (heights, points)
}

#[test]
fn columns_of_a_dsm_block_as_brute_force_over_all_columns_says() {
    let mut random = TestRandom(1);
    let cell = 0.5;
    let (heights, points) = heights(&mut random, 37, 22, cell);
    let params = DsmParams { cell, relief: DsmSurface::Columns, clearance: 0.3, gap_fill: GapFill::Leave };
    let dsm = Dsm::from_points(&points, &params).unwrap();
    assert_eq!((dsm.heights().width(), dsm.heights().height(), dsm.corner()), (37, 22, [0.0; 2]));
    let mut seen = [0; 2];
    for (target, viewer) in lines(&mut random, 4000, [20.0, 13.0, 10.0]) {
        let (direction, range) = viewer.line_of_sight(0, target).unwrap();
        let origin = target.map(f64::from);
        let end: [f64; 2] = [0, 1].map(|i| origin[i] + range * direction[i]);
        let mut expected = false;
        for (row, heights) in heights.iter().enumerate() {
            for (column, &height) in heights.iter().enumerate() {
                let low = [column as f64 * cell, row as f64 * cell, -1e3];
                let high = [low[0] + cell, low[1] + cell, height];
                let holds = |x: f64, y: f64| x >= low[0] && x < high[0] && y >= low[1] && y < high[1];
                if holds(origin[0], origin[1]) || (range.is_finite() && holds(end[0], end[1])) {
                    continue;
                }
                expected |= within_box(origin, direction, low, high)
                    .is_some_and(|[from, to]| from.max(params.clearance) < to.min(range));
            }
        }
        assert_eq!(blocked(&dsm, viewer, &[target])[0], expected, "{target:?} {viewer:?}");
        seen[usize::from(expected)] += 1;
    }
    assert!(seen.iter().all(|&n| n > 500), "{seen:?}");
}

#[test]
fn a_bilinear_dsm_blocks_where_small_steps_along_the_line_dip_below_it() {
    let mut random = TestRandom(2);
    let cell = 0.5;
    let (heights, points) = heights(&mut random, 21, 17, cell);
    let params = DsmParams { cell, relief: DsmSurface::Bilinear, clearance: 0.3, gap_fill: GapFill::Leave };
    let dsm = Dsm::from_points(&points, &params).unwrap();
    let surface = |x: f64, y: f64| {
        let (u, v) = (x / cell - 0.5, y / cell - 0.5);
        if !(u >= 0.0 && v >= 0.0 && u <= 20.0 && v <= 16.0) {
            return f64::NEG_INFINITY;
        }
        let (column, row) = ((u as usize).min(19), (v as usize).min(15));
        let (u, v) = (u - column as f64, v - row as f64);
        let h = |dx: usize, dy: usize| heights[row + dy][column + dx];
        (h(0, 0) * (1.0 - u) + h(1, 0) * u) * (1.0 - v) + (h(0, 1) * (1.0 - u) + h(1, 1) * u) * v
    };
    let (mut seen, mut close) = ([0; 2], 0);
    for (target, viewer) in lines(&mut random, 3000, [11.0, 9.0, 10.0]) {
        let (direction, range) = viewer.line_of_sight(0, target).unwrap();
        let step = 0.002;
        let end = range.min(30.0);
        let min = (0..)
            .map(|i| params.clearance + f64::from(i) * step)
            .take_while(|&t| t < end)
            .map(|t| {
                let p: [f64; 3] = std::array::from_fn(|i| f64::from(target[i]) + t * direction[i]);
                p[2] - surface(p[0], p[1])
            })
            .fold(f64::INFINITY, f64::min);
        // slopes reach 9 m in 0.5 m: within a step of 2 mm the surface falls by 4 cm at most, but between two samples
        // only by half of it
        if min.abs() < 0.03 {
            close += 1;
            continue;
        }
        assert_eq!(blocked(&dsm, viewer, &[target])[0], min < 0.0, "{target:?} {viewer:?} {min}");
        seen[usize::from(min < 0.0)] += 1;
    }
    assert!(seen.iter().all(|&n| n > 500) && close < 100, "{seen:?}, {close} close");
}

#[test]
fn a_dsm_keeps_the_highest_point_and_fills_gaps_from_their_edge() {
    let mut points: Vec<[f32; 3]> = Vec::new();
    for row in 0..5 {
        for column in 0..5 {
            if (row, column) != (2, 2) {
                let height = if column > 2 { 6.0 } else { 1.0 };
                points.push([column as f32 + 0.5, row as f32 + 0.5, height]);
                points.push([column as f32 + 0.2, row as f32 + 0.7, height - 0.5]);
            }
        }
    }
    points.push([f32::NAN, 0.0, 99.0]);
    let middle = |gap_fill| {
        let params = DsmParams { cell: 1.0, gap_fill, ..DsmParams::default() };
        Dsm::from_points(&points, &params).unwrap().heights().get(2, 2).unwrap()
    };
    assert_eq!(middle(GapFill::Lowest), 1.0);
    // five neighbours of 1 m and three of 6 m
    assert_eq!(middle(GapFill::Mean), 2.875);
    assert!(middle(GapFill::Leave).is_nan());
    assert!(Dsm::from_points(&points, &DsmParams { cell: 1e-9, ..DsmParams::default() }).is_err());
    // nothing to see: nothing blocks
    let empty = Dsm::from_points(&[], &DsmParams::default()).unwrap();
    assert_eq!(blocked(&empty, Viewer::Direction([0.0, 0.0, 1.0]), &[[0.0; 3]]), [false]);
}

#[test]
fn a_dsm_of_a_mesh_has_the_heights_of_its_highest_surface() {
    // a slanted plane z = x / 2 under a smaller level one at 7 m, in a frame with a far origin
    let origin = [155_000.0, 463_000.0, 10.0];
    let square = |low: f64, high: f64, z: fn(f64) -> f64| {
        [[low, low], [high, low], [high, high], [low, high]]
            .map(|[x, y]| [x + origin[0], y + origin[1], z(x) + origin[2]])
    };
    let vertices = [square(0.0, 10.0, |x| x / 2.0), square(4.0, 6.0, |_| 7.0)].concat();
    let triangles = vec![[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]];
    let mesh = Mesh { vertices, triangles, ..Mesh::default() };
    let dsm = Dsm::from_mesh(&mesh, origin, &DsmParams { cell: 0.5, ..DsmParams::default() }).unwrap();
    for row in 0..20 {
        for column in 0..20 {
            let inside = |i: usize| (8..12).contains(&i);
            let expected = if inside(row) && inside(column) { 7.0 } else { (column as f64 + 0.5) / 4.0 };
            let height = f64::from(dsm.heights().get(column, row).unwrap());
            // a micrometre: f32
            assert!((height - expected).abs() < 1e-6, "{column} {row}: {height}");
        }
    }
}

#[test]
fn voxels_block_as_brute_force_over_all_boxes_says() {
    let mut random = TestRandom(6);
    for (size, min_points) in [(0.5, 1), (1.3, 2)] {
        let points: Vec<[f32; 3]> = (0..300).map(|_| random.point([-6.0, -5.0, -4.0], [7.0, 8.0, 9.0])).collect();
        let doubled: Vec<[f32; 3]> = points.iter().flat_map(|&p| vec![p; min_points as usize]).collect();
        let params = VoxelParams { size, min_points, clearance: 0.4 };
        let voxels = Voxels::new(&doubled, &params).unwrap();
        let cell = |p: [f64; 3]| p.map(|v| (v / size).floor());
        let mut solid: Vec<[f64; 3]> = points.iter().map(|p| cell(p.map(f64::from))).collect();
        solid.sort_by(|a, b| a.partial_cmp(b).unwrap());
        solid.dedup();
        assert_eq!(voxels.solid_count(), solid.len());
        assert_eq!(Voxels::new(&points[..10], &VoxelParams { min_points: 11, ..params }).unwrap().solid_count(), 0);
        let mut seen = [0; 2];
        for (target, viewer) in lines(&mut random, 3000, [8.0, 9.0, 10.0]) {
            let (direction, range) = viewer.line_of_sight(0, target).unwrap();
            let origin = target.map(f64::from);
            let eye: [f64; 3] = std::array::from_fn(|i| origin[i] + range * direction[i]);
            let expected = solid.iter().any(|&voxel| {
                let [low, high] = [voxel.map(|v| v * size), voxel.map(|v| (v + 1.0) * size)];
                // lines that graze a box by less than a µm do not occur among these
                voxel != cell(origin)
                    && (range.is_infinite() || voxel != cell(eye))
                    && within_box(origin, direction, low, high)
                        .is_some_and(|[from, to]| from.max(params.clearance) < to.min(range))
            });
            assert_eq!(blocked(&voxels, viewer, &[target])[0], expected, "{target:?} {viewer:?}");
            seen[usize::from(expected)] += 1;
        }
        assert!(seen.iter().all(|&n| n > 300), "{seen:?}");
    }
}

#[test]
fn a_long_ray_finds_the_one_voxel_at_its_far_end() {
    let voxels = Voxels::new(&[[20_000.2, 0.2, 3.3], [-20_000.0, 0.0, 0.0]], &VoxelParams::default()).unwrap();
    let ray = Ray::new([-19_000.3, 0.3, 0.2], [39_000.5, -0.1, 3.1], [0.5, f64::INFINITY]).unwrap();
    assert!(voxels.blocks(&ray));
    assert!(!voxels.blocks(&Ray { ranges: [0.5, 38_999.0], ..ray }));
    assert!(Voxels::new(&[[1e38, 0.0, 0.0]], &VoxelParams::default()).is_err());
    let none = Voxels::new(&[], &VoxelParams::default()).unwrap();
    assert_eq!(count_true(&blocked(&none, Viewer::Eye([1.0; 3]), &[[0.0; 3]])), 0);
}
