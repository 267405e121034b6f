//! The visibility matrix is what lines of sight say, pair by pair.

use belvedere::apps::sky_view::SkyDirections;
use belvedere::control::Control;
use belvedere::medial::MedialBalls;
use belvedere::query::{Answer, BlockRule, FreeLines, MedialScene, VisibilityMatrix};
use belvedere::random::uniform;
use belvedere::view::to_sun;

/// Blocks of balls on a bumpy ground, crowns of small ones between.
fn place(count: u64, seed: u64) -> MedialBalls {
    let mut balls = MedialBalls::default();
    for i in 0..count {
        let u = |k: u64| uniform(seed, 8 * i + k);
        let (x, y) = (60.0 * u(0) - 30.0, 60.0 * u(1) - 30.0);
        let (z, radius) = match i % 3 {
            0 => (-2.0 + 0.2 * u(2), 2.0),
            1 if ((x / 12.0).floor() + (y / 12.0).floor()) % 2.0 == 0.0 => (9.0 * u(2), 0.3 + 2.0 * u(3)),
            _ => (4.0 + 5.0 * u(2), 0.1 + 0.3 * u(3)),
        };
        balls.centers.push([x, y, z].map(|v| v as f32));
        balls.radii.push(radius as f32);
        balls.source.push(0);
        balls.touch.push(0);
        balls.separation_angles.push(0.0);
    }
    balls
}

fn differing(matrix: &VisibilityMatrix, scene: &MedialScene, targets: &[[f32; 3]], directions: &[[f64; 3]]) -> usize {
    let pairs = targets.iter().enumerate().flat_map(|t| directions.iter().enumerate().map(move |d| (t, d)));
    pairs
        .filter(|((row, target), (column, direction))| {
            let is_finite = target.iter().all(|v| v.is_finite());
            let is_visible = || scene.answer(target.map(f64::from), **direction, f64::INFINITY) == Answer::Visible;
            matrix.is_free(*row, *column) != (is_finite && is_visible())
        })
        .count()
}

#[test]
fn every_bit_is_the_answer_of_a_line_of_sight() {
    let balls = place(1500, 3);
    let mut directions = SkyDirections::even(90).unwrap().directions;
    // along the axes, level, flat, and below the horizon
    directions.extend([[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [0.6, 0.0, 0.8]]);
    for flat in [0.02_f64, 0.05, -0.1] {
        directions.push([(1.0 - flat * flat).sqrt(), 0.0, flat]);
    }
    let target = |i: u64| -> [f32; 3] {
        let u = |k: u64| uniform(9, 8 * i + k);
        // on the ground, in the air and beside the place
        let height = if i.is_multiple_of(2) { 0.1 } else { 14.0 * u(2) - 1.0 };
        [80.0 * u(0) - 40.0, 80.0 * u(1) - 40.0, height].map(|v| v as f32)
    };
    let mut targets: Vec<[f32; 3]> = (0..1200).map(target).collect();
    targets.push([f32::NAN, 0.0, 0.0]);
    for params in [BlockRule::carved(), BlockRule::default(), BlockRule { bias: 0.7, ..BlockRule::default() }] {
        let scene = MedialScene::new(&balls, &params).unwrap();
        // many enough to be swept, and too few
        let swept = scene.visibility_matrix(&targets, &directions, &Control::none()).unwrap();
        assert_eq!(differing(&swept, &scene, &targets, &directions), 0, "{params:?}");
        let few = scene.visibility_matrix(&targets, &directions[..5], &Control::none()).unwrap();
        assert_eq!(differing(&few, &scene, &targets, &directions[..5]), 0, "{params:?}");
        assert_eq!((swept.target_count(), swept.direction_count()), (1201, 98));
        let free: usize =
            (0..1201).map(|row| swept.row(row).iter().map(|w| w.count_ones() as usize).sum::<usize>()).sum();
        assert!(free > 10_000 && free < 100_000, "a scene with light and shade: {free}");
        assert!(swept.row(1200) == [0, 0] && swept.row(5000).is_empty() && !swept.is_free(0, 98));
        let ones = vec![1.0; 98];
        assert!((0..1201).all(|row| {
            let expected = (0..98).filter(|&column| swept.is_free(row, column)).count();
            (swept.sum(row, &ones) - expected as f64).abs() < 1e-9
        }));
    }
}

#[test]
fn nothing_blocks_without_balls_and_bad_directions_are_refused() {
    let scene = MedialScene::new(&MedialBalls::default(), &BlockRule::carved()).unwrap();
    let sky = SkyDirections::even(20).unwrap();
    let matrix = scene.visibility_matrix(&[[0.0; 3]], &sky.directions, &Control::none()).unwrap();
    assert!((0..20).all(|column| matrix.is_free(0, column)));
    assert!(scene.visibility_matrix(&[[0.0; 3]], &[[0.0, 0.0, 2.0]], &Control::none()).is_err());
    assert!(scene.visibility_matrix(&[[0.0; 3]], &[[f64::NAN, 0.0, 1.0]], &Control::none()).is_err());
    let none = scene.visibility_matrix(&[], &sky.directions, &Control::none()).unwrap();
    assert_eq!(none.target_count(), 0);
}

#[test]
fn balls_queried_part_by_part_give_the_bits_of_all_at_once() {
    let balls = place(1500, 3);
    let directions = SkyDirections::even(150).unwrap().directions;
    let target = |i: u64| -> [f32; 3] {
        let u = |k: u64| uniform(9, 8 * i + k);
        [80.0 * u(0) - 40.0, 80.0 * u(1) - 40.0, 9.0 * u(2)].map(|v| v as f32)
    };
    let mut targets: Vec<[f32; 3]> = (0..1200).map(target).collect();
    targets.insert(600, [f32::NAN, 0.0, 0.0]);
    let none = Control::none();
    let scene = |balls: &MedialBalls| MedialScene::new(balls, &BlockRule::carved()).unwrap();
    let expected = scene(&balls).visibility_matrix(&targets, &directions, &none).unwrap();
    let all: Vec<usize> = (0..150).collect();
    // so few parts that each is swept, and so many that most are not
    for count in [2, 3, 40] {
        let mut free = FreeLines::new(&targets, &directions).unwrap();
        for part in 0..count {
            let rows: Vec<usize> = (0..balls.len()).filter(|row| row * 7919 % count == part).collect();
            let part = scene(&balls.select(&rows));
            // the order of columns, and asking some later, change nothing
            let (some, others): (Vec<usize>, Vec<usize>) = all.iter().rev().partition(|&column| column % 3 == 1);
            free.hide_behind_balls(&part, &some, &none).unwrap();
            free.hide_behind_balls(&part, &others, &none).unwrap();
        }
        assert!(free.into_matrix() == expected, "{count} parts");
    }
    // directions that are not tested stay free
    let mut free = FreeLines::new(&targets, &directions).unwrap();
    free.hide_behind_balls(&scene(&balls), &[70, 3], &none).unwrap();
    let matrix = free.clone().into_matrix();
    for (row, column) in (0..1201).flat_map(|row| (0..150).map(move |column| (row, column))) {
        let is_queried = [70, 3].contains(&column);
        let is_free = row != 600 && (!is_queried || expected.is_free(row, column));
        assert_eq!(matrix.is_free(row, column), is_free, "{row} {column}");
    }
    assert!(free.hide_behind_balls(&scene(&balls), &[150], &none).is_err());
    // what lies under a dome sees nothing
    let mut dome = MedialBalls::default();
    dome.push(0, [0.0, 0.0, 0.0], 400.0, 0);
    let mut above = FreeLines::new(&[[0.0, 0.0, 2.0]], &directions).unwrap();
    assert_eq!(above.free_columns(), all);
    above.hide_behind_balls(&scene(&dome), &all[20..], &none).unwrap();
    assert_eq!(above.free_columns(), all[..20]);
    // lines that another kept from the same obstacles
    let mut kept = FreeLines::new(&targets, &directions).unwrap();
    kept.hide_what_is_hidden_in(&free).unwrap();
    assert!(kept.into_matrix() == matrix);
    assert!(free.hide_what_is_hidden_in(&above).is_err());
}

#[test]
fn few_lines_near_distant_balls_have_the_bits_of_many() {
    // a wall of 9 m to the east, and balls 300 m behind it that only targets near its height see
    let mut wall = MedialBalls::default();
    for (y, z) in (-60..=60).flat_map(|y| [0, 2, 4, 6].map(|z| (y, z))) {
        wall.push(0, [60.0, y as f32, z as f32], 3.0, 0);
    }
    let mut far = MedialBalls::default();
    for i in 0..200 {
        let u = |k: u64| uniform(3, 8 * i + k);
        far.push(0, [360.0 + 20.0 * u(0), 200.0 * u(1) - 100.0, 14.0 * u(2)].map(|v| v as f32), 2.0, 0);
    }
    let directions: Vec<[f64; 3]> = (0..60)
        .map(|i| {
            let u = |k: u64| uniform(5, 8 * i + k);
            to_sun((80.0 + 20.0 * u(0)).to_radians(), (0.2 + 1.3 * u(1)).to_radians())
        })
        .collect();
    let targets: Vec<[f32; 3]> = (0..4000)
        .map(|i| {
            let u = |k: u64| uniform(9, 8 * i + k);
            [80.0 * u(0) - 40.0, 80.0 * u(1) - 40.0, 8.5 * u(2)].map(|v| v as f32)
        })
        .collect();
    let none = Control::none();
    let scene = |balls: &MedialBalls| MedialScene::new(balls, &BlockRule::carved()).unwrap();
    let columns: Vec<usize> = (0..60).collect();
    let mut free = FreeLines::new(&targets, &directions).unwrap();
    free.hide_behind_balls(&scene(&wall), &columns, &none).unwrap();
    let count = |matrix: &VisibilityMatrix| (0..4000).map(|row| matrix.sum(row, &[1.0; 60])).sum::<f64>() as usize;
    let past_wall = count(&free.clone().into_matrix());
    free.hide_behind_balls(&scene(&far), &columns, &none).unwrap();
    let found = free.into_matrix();
    for i in 0..far.len() {
        wall.push(0, far.centers[i], far.radii[i], 0);
    }
    assert!(found == scene(&wall).visibility_matrix(&targets, &directions, &none).unwrap());
    // a tenth of 240 000 lines, below which they are tested one by one
    assert!(past_wall < 24_000 && count(&found) < past_wall * 9 / 10, "{past_wall}, {}", count(&found));
}
