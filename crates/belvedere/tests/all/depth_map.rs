//! Depth maps against loops over all balls and pixels, against the printed algorithm, and against closed forms.

use belvedere::control::Control;
use belvedere::depth::{DepthMap, ItemBuffer, NO_BALL, Profile, depth_map};
use belvedere::medial::{MedialBalls, NO_TOUCH};
use belvedere::query::{Answer, query_points, random_targets};
use belvedere::view::{View, to_sun};
use proptest::prelude::*;

fn balls(list: &[([f32; 3], f32)]) -> MedialBalls {
    MedialBalls {
        centers: list.iter().map(|b| b.0).collect(),
        radii: list.iter().map(|b| b.1).collect(),
        source: (0..list.len() as u32).collect(),
        touch: vec![0; list.len()],
        separation_angles: vec![1.0; list.len()],
    }
}

/// Balls of all sizes, from a tenth of a pixel to several tiles, some beside and behind the picture.
fn mixed(count: u64, seed: u64) -> MedialBalls {
    let u = |i: u64| belvedere::random::uniform(seed, i) as f32;
    let list: Vec<_> = (0..count)
        .map(|i| {
            let at = 4 * i;
            let radius = 0.02 * 900f32.powf(u(at + 3));
            ([60.0 * u(at) - 5.0, 50.0 * u(at + 1) - 5.0, 40.0 * u(at + 2) - 10.0], radius)
        })
        .collect();
    balls(&list)
}

fn top_view(pixels_per_metre: f64) -> View {
    View::from_viewport([0.0, 40.0, 30.0], [50.0, 0.0, 0.0], [0.0, -40.0, 0.0], pixels_per_metre).unwrap()
}

fn views() -> Vec<View> {
    let sun = to_sun(200f64.to_radians(), 35f64.to_radians()).map(|v| -v);
    vec![
        top_view(4.0),
        top_view(0.7),
        View::parallel(sun, [0.0, 0.0, -5.0], [50.0, 40.0, 30.0], 0.31).unwrap(),
        // a plane that cuts the scene
        View::from_viewport([0.0, 20.0, 20.0], [50.0, 0.0, 0.0], [0.0, 0.0, -25.0], 3.0).unwrap(),
    ]
}

/// Depth by the definition: the front of the sphere at the pixel's centre, in f64, for radii larger by `grown`.
fn exact_depth(balls: &MedialBalls, view: &View, pixel: [usize; 2], grown: f64) -> f64 {
    let s = view.pixels_per_metre().unwrap();
    let at = pixel.map(|v| (v as f64 + 0.5) / s);
    let mut nearest = f64::INFINITY;
    for i in 0..balls.len() {
        let [x, y, z] = view.frame.view_from_local(balls.centers[i]);
        let square = (f64::from(balls.radii[i]) + grown).powi(2) - (x - at[0]).powi(2) - (y - at[1]).powi(2);
        let half = square.max(0.0).sqrt();
        if square > 0.0 && z + half >= 0.0 {
            nearest = nearest.min((z - half).max(0.0));
        }
    }
    nearest
}

#[test]
fn sphere_depths_equal_the_formula_at_every_pixel() {
    let balls = mixed(900, 3);
    // offsets and depths of up to 100 m are f32, good to 1e-5 m: at the edge of a ball this changes the depth by any
    // amount, but never into more than balls larger or smaller by that much would show
    let room = 2e-5;
    for view in views() {
        let map = depth_map(&balls, &view, Profile::Sphere, ItemBuffer::With, &Control::none()).unwrap();
        let items = map.balls.as_ref().unwrap();
        for row in 0..map.depth.height() {
            for column in 0..map.depth.width() {
                let mine = f64::from(map.depth.get(column, row).unwrap());
                let min = exact_depth(&balls, &view, [column, row], room) - room;
                let max = exact_depth(&balls, &view, [column, row], -room) + room;
                assert!((min..=max).contains(&mine), "pixel {column} {row}: {mine} not in {min}..{max}");
                let item = items.get(column, row).unwrap();
                assert_eq!(item == NO_BALL, mine == f64::INFINITY);
                if item != NO_BALL {
                    // the named ball alone shows the same depth
                    let i = item as usize;
                    let alone = self::balls(&[(balls.centers[i], balls.radii[i])]);
                    let near = exact_depth(&alone, &view, [column, row], room) - room;
                    let far = exact_depth(&alone, &view, [column, row], -room) + room;
                    assert!((near..=far).contains(&mine), "pixel {column} {row}: ball {i} is not at {mine}");
                }
            }
        }
    }
}

/// Algorithm 1 as printed: integer offsets around the pixel of the projected centre, depth in pixels.
fn write_ball(depths: &mut [f32], size: [usize; 2], c: [f32; 3], rs: f32) {
    let (cx, cy) = (c[0].floor() as i64, c[1].floor() as i64);
    let reach = rs.ceil() as i64;
    for x in -reach..=reach {
        for y in -reach..=reach {
            let h = ((x * x + y * y) as f32).sqrt();
            if h < rs {
                let d_new = c[2] - (rs - h);
                let (px, py) = (cx + x, cy + y);
                if px >= 0 && py >= 0 && (px as usize) < size[0] && (py as usize) < size[1] {
                    let d = &mut depths[py as usize * size[0] + px as usize];
                    if d_new < *d {
                        *d = d_new;
                    }
                }
            }
        }
    }
}

#[test]
fn the_paper_cone_equals_algorithm_1_as_printed_bit_by_bit() {
    let balls = mixed(900, 5);
    for view in views() {
        let s = view.pixels_per_metre().unwrap() as f32;
        let mut printed = vec![f32::INFINITY; view.size_px[0] * view.size_px[1]];
        for i in 0..balls.len() {
            let [x, y, z] = view.frame.view_from_local(balls.centers[i]);
            let in_pixels = [x * view.pixels_per_metre().unwrap(), y * view.pixels_per_metre().unwrap()];
            let c = [in_pixels[0] as f32, in_pixels[1] as f32, z as f32 * s];
            // the pixel of a centre is taken before rounding to f32
            let c = [in_pixels[0].floor() as f32, in_pixels[1].floor() as f32, c[2]];
            write_ball(&mut printed, view.size_px, c, balls.radii[i] * s);
        }
        let map = depth_map(&balls, &view, Profile::PaperCone, ItemBuffer::Without, &Control::none()).unwrap();
        for (i, (&mine, &pixels)) in map.depth.values().iter().zip(&printed).enumerate() {
            assert_eq!(mine.to_bits(), (pixels / s).to_bits(), "pixel {i}: {mine} instead of {}", pixels / s);
        }
    }
}

#[test]
fn one_sphere_seen_from_above_has_the_depth_of_a_sphere() {
    let view = top_view(10.0);
    let map =
        depth_map(&balls(&[([20.0, 15.0, 10.0], 4.0)]), &view, Profile::Sphere, ItemBuffer::Without, &Control::none())
            .unwrap();
    let mut area = 0.0;
    for row in 0..map.depth.height() {
        for column in 0..map.depth.width() {
            let depth = f64::from(map.depth.get(column, row).unwrap());
            let (x, y) = ((column as f64 + 0.5) / 10.0 - 20.0, 40.0 - (row as f64 + 0.5) / 10.0 - 15.0);
            let h = x * x + y * y;
            if h < 16.0 - 1e-3 {
                assert!((depth - (20.0 - (16.0 - h).sqrt())).abs() < 1e-4);
            }
            area += if depth.is_finite() { 0.01 } else { 0.0 };
        }
    }
    // pixel counting of a disc of 40 pixels radius is good to about its circumference times a tenth of a pixel
    assert!((area - std::f64::consts::PI * 16.0).abs() < 0.25, "{area}");
}

#[test]
fn the_cone_only_ever_reveals() {
    let balls = mixed(400, 9);
    let targets = random_targets([0.0, 0.0, 0.0], [50.0, 40.0, 30.0], 20_000, 1);
    let view = top_view(20.0);
    let answers = |profile| {
        let map = depth_map(&balls, &view, profile, ItemBuffer::Without, &Control::none()).unwrap();
        query_points(&map, &targets, 0.0)
    };
    let (sphere, cone) = (answers(Profile::Sphere), answers(Profile::PaperCone));
    let hidden_by_cone_only = cone.iter().zip(&sphere).filter(|&(c, s)| *c == Answer::Blocked && *s == Answer::Visible);
    let revealed = cone.iter().zip(&sphere).filter(|&(c, s)| *c == Answer::Visible && *s == Answer::Blocked).count();
    // the cone lies inside the ball; only its shift to the middle of a pixel can hide more
    let hidden = hidden_by_cone_only.count();
    assert!(revealed > 200 && hidden * 20 < revealed, "{hidden} hidden, {revealed} revealed");
}

fn bits(map: &DepthMap) -> (Vec<u32>, Option<Vec<u32>>) {
    (map.depth.values().iter().map(|d| d.to_bits()).collect(), map.balls.as_ref().map(|b| b.values().to_vec()))
}

#[test]
fn maps_and_answers_are_bit_identical_for_any_number_of_threads() {
    let balls = mixed(3000, 11);
    let view = &views()[2];
    for profile in [Profile::Sphere, Profile::PaperCone] {
        let in_pool = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let map = depth_map(&balls, view, profile, ItemBuffer::With, &Control::none()).unwrap();
                let targets = random_targets([0.0; 3], [50.0, 40.0, 30.0], 100_000, 2);
                (bits(&map), query_points(&map, &targets, 0.1))
            })
        };
        let one = in_pool(1);
        assert!(one == in_pool(2) && one == in_pool(7));
    }
}

#[test]
fn an_item_buffer_leaves_the_depths_as_they_are_and_breaks_ties_by_row() {
    let mut balls = mixed(500, 13);
    for i in 0..200 {
        balls.centers.push(balls.centers[i]);
        balls.radii.push(balls.radii[i]);
        balls.source.push(0);
        balls.touch.push(0);
        balls.separation_angles.push(1.0);
    }
    let view = top_view(3.0);
    let with = depth_map(&balls, &view, Profile::Sphere, ItemBuffer::With, &Control::none()).unwrap();
    let without = depth_map(&balls, &view, Profile::Sphere, ItemBuffer::Without, &Control::none()).unwrap();
    assert_eq!(bits(&with).0, bits(&without).0);
    let items = with.balls.unwrap();
    assert!(items.values().iter().all(|&i| i == NO_BALL || i < 500), "a copy was named instead of the original");
}

#[test]
fn balls_that_never_shrank_or_are_not_finite_block_nothing() {
    let mut some = mixed(50, 17);
    some.touch.fill(NO_TOUCH);
    some.centers.extend([[f32::NAN, 1.0, 1.0], [20.0, 20.0, f32::INFINITY], [20.0, 20.0, 5.0]]);
    some.radii.extend([3.0, 3.0, f32::NAN]);
    some.source.extend([0; 3]);
    some.touch.extend([0; 3]);
    some.separation_angles.extend([1.0; 3]);
    let map = depth_map(&some, &top_view(2.0), Profile::Sphere, ItemBuffer::Without, &Control::none()).unwrap();
    assert!(map.depth.values().iter().all(|d| *d == f32::INFINITY));
}

#[test]
fn targets_beside_the_picture_or_behind_its_plane_are_outside_the_view() {
    let map = depth_map(
        &balls(&[([20.0, 15.0, 10.0], 4.0)]),
        &top_view(2.0),
        Profile::Sphere,
        ItemBuffer::Without,
        &Control::none(),
    )
    .unwrap();
    let targets = [
        [20.0, 15.0, 20.0],
        [20.0, 15.0, 5.0],
        [-0.01, 15.0, 5.0],
        [50.01, 15.0, 5.0],
        [20.0, 40.01, 5.0],
        [20.0, 15.0, 31.0],
        [f32::NAN, 15.0, 5.0],
    ];
    let answers = query_points(&map, &targets, 0.0);
    use Answer::{Blocked, OutsideView, Visible};
    assert_eq!(answers, [Visible, Blocked, OutsideView, OutsideView, OutsideView, OutsideView, OutsideView]);
}

#[test]
fn random_targets_fill_the_box_evenly_and_repeat_by_seed() {
    let (low, high) = ([-3.0, 10.0, 0.0], [5.0, 20.0, 2.0]);
    let targets = random_targets(low, high, 100_000, 42);
    assert_eq!(targets, random_targets(low, high, 100_000, 42));
    assert_ne!(targets, random_targets(low, high, 100_000, 43));
    for axis in 0..3 {
        let mut tenths = [0usize; 10];
        for t in &targets {
            let share = (t[axis] - low[axis]) / (high[axis] - low[axis]);
            assert!((0.0..=1.0).contains(&share));
            tenths[((share * 10.0) as usize).min(9)] += 1;
        }
        // binomial with p = 0.1: sigma 95
        assert!(tenths.iter().all(|&n| n.abs_diff(10_000) < 5 * 95), "{tenths:?}");
    }
}

proptest! {
    #[test]
    fn adding_balls_never_reveals(seed in any::<u64>()) {
        let all = mixed(120, seed);
        let mut some = all.clone();
        some.touch[60..].fill(NO_TOUCH);
        let view = top_view(1.5);
        let map = |balls| depth_map(balls, &view, Profile::Sphere, ItemBuffer::Without, &Control::none()).unwrap();
        let (few, many) = (map(&some), map(&all));
        prop_assert!(few.depth.values().iter().zip(many.depth.values()).all(|(few, many)| many <= few));
    }
}

#[test]
fn views_that_make_no_sense_are_refused() {
    let (x, y) = ([50.0, 0.0, 0.0], [0.0, -40.0, 0.0]);
    assert!(View::from_viewport([f64::NAN; 3], x, y, 1.0).is_err());
    assert!(View::from_viewport([0.0; 3], [0.0; 3], y, 1.0).is_err());
    assert!(View::from_viewport([0.0; 3], x, [10.0, -40.0, 0.0], 1.0).is_err());
    assert!(View::from_viewport([0.0; 3], x, y, 0.0).is_err());
    assert!(View::from_viewport([0.0; 3], x, y, 1e9).unwrap_err().to_string().contains("pixels"));
    assert!(View::parallel([0.0; 3], [0.0; 3], [1.0; 3], 0.1).is_err());
    assert!(View::parallel([0.0, 0.0, -1.0], [0.0; 3], [1.0; 3], -0.1).is_err());
}

#[test]
fn a_fitted_view_holds_every_corner_of_the_box_from_any_direction() {
    let (low, high) = ([-10.0, 5.0, 0.0], [40.0, 30.0, 20.0]);
    for azimuth in 0..12 {
        for elevation in [-90.0f64, -30.0, 0.0, 15.0, 60.0, 89.9999, 90.0] {
            let sun = to_sun(f64::from(azimuth) * 0.5, elevation.to_radians());
            let view = View::parallel(sun.map(|v| -v), low, high, 0.5).unwrap();
            for corner in 0..8 {
                let p: [f32; 3] = std::array::from_fn(|i| if corner >> i & 1 == 0 { low[i] } else { high[i] } as f32);
                let [x, y, z] = view.frame.view_from_local(p);
                assert!(x >= -1e-4 && y >= -1e-4 && z >= -1e-4, "{azimuth} {elevation} {x} {y} {z}");
                assert!(x * 2.0 <= view.size_px[0] as f64 && y * 2.0 <= view.size_px[1] as f64);
            }
            let f = view.frame;
            let right_handed = f.right[0] * (f.down[1] * f.forward[2] - f.down[2] * f.forward[1])
                + f.right[1] * (f.down[2] * f.forward[0] - f.down[0] * f.forward[2])
                + f.right[2] * (f.down[0] * f.forward[1] - f.down[1] * f.forward[0]);
            assert!((right_handed - 1.0).abs() < 1e-9);
        }
    }
}
