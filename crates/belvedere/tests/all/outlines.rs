//! Balls drawn in views from an eye against rays through the middle of every pixel, in f64.

use belvedere::control::Control;
use belvedere::depth::{ItemBuffer, NO_BALL, Profile, depth_map, panorama};
use belvedere::medial::MedialBalls;
use belvedere::random::uniform;
use belvedere::view::{Projection, View, panorama_direction};

const EYE: [f64; 3] = [3.0, -2.0, 1.5];

fn balls(list: &[([f32; 3], f32)]) -> MedialBalls {
    MedialBalls {
        centers: list.iter().map(|b| b.0).collect(),
        radii: list.iter().map(|b| b.1).collect(),
        source: vec![0; list.len()],
        touch: vec![0; list.len()],
        separation_angles: vec![1.0; list.len()],
    }
}

/// Balls of 2 mm to 10 m all around the eye, from within a metre to 60 m off; some cut near planes, none is left out.
fn around(count: u64, seed: u64) -> Vec<([f32; 3], f32)> {
    let u = |i: u64| uniform(seed, i);
    (0..count)
        .map(|i| {
            let at = 5 * i;
            let z = 2.0 * u(at) - 1.0;
            let (sin, cos) = (std::f64::consts::TAU * u(at + 1)).sin_cos();
            let beside = (1.0 - z * z).sqrt();
            let distance = 0.5 * 120f64.powf(u(at + 2));
            let radius = (0.002 * 5000f64.powf(u(at + 3))).min(0.98 * distance);
            let unit = [beside * cos, beside * sin, z];
            (std::array::from_fn(|k| (EYE[k] + distance * unit[k]) as f32), radius as f32)
        })
        .collect()
}

fn views() -> Vec<(&'static str, View)> {
    let camera = |look_at, fov, size, near, far| View::perspective(EYE, look_at, fov, size, near, far).unwrap();
    let all = f64::INFINITY;
    vec![
        ("camera", camera([20.0, 5.0, 0.0], 1.0, [90, 60], 0.0, all)),
        ("wide camera with limits", camera([3.0, 9.0, 5.0], 2.4, [110, 70], 1.5, 30.0)),
        ("camera straight down, near limit", camera([3.0, -2.0, -9.0], 1.5, [70, 70], 4.0, all)),
        ("hemisphere", View::hemisphere(EYE, [0.0, 0.0, 1.0], 90).unwrap()),
        ("fisheye", View::fisheye(EYE, [1.0, -2.0, -0.5], 2.3, 100).unwrap().with_limits(2.0, 40.0).unwrap()),
    ]
}

/// Depth of the nearest ball at a place of the picture by the definition, in f64, for radii larger by `grown` times the
/// distance.
fn exact_depth(list: &[([f32; 3], f32)], view: &View, place: [f64; 2], grown: f64) -> f64 {
    let direction = view.direction(place);
    let [near, far] = view.limits();
    let per_range = if matches!(view.projection, Projection::Perspective { .. }) { direction[2] } else { 1.0 };
    let mut nearest = f64::INFINITY;
    for &(center, radius) in list {
        let c = view.frame.view_from_local(center);
        let distance = c.map(|v| v * v).iter().sum::<f64>();
        let radius = f64::from(radius) + grown * distance.sqrt();
        let along: f64 = (0..3).map(|i| c[i] * direction[i]).sum();
        let square = radius * radius - (distance - along * along);
        let half = square.max(0.0).sqrt();
        let (front, back) = ((along - half) * per_range, (along + half) * per_range);
        if square > 0.0 && back > 0.0 && back >= near && front <= far {
            nearest = nearest.min(front.max(near));
        }
    }
    nearest
}

#[test]
fn outlines_hold_exactly_the_pixels_that_rays_hit() {
    // f32 takes directions and centres for right to a few units of 6e-8: a ball is as large as it is to a millionth of
    // its distance
    let room = 1e-6;
    for (name, view) in views() {
        let mut hits = 0;
        // ten balls a time, so that few hide others; 2 000 in each of five views
        for group in around(2000, 3).chunks(10) {
            let map = depth_map(&balls(group), &view, Profile::Sphere, ItemBuffer::With, &Control::none()).unwrap();
            assert_eq!(map.around_eye_count, 0);
            for row in 0..map.depth.height() {
                for column in 0..map.depth.width() {
                    let place = [column as f64 + 0.5, row as f64 + 0.5];
                    let mine = f64::from(map.depth.get(column, row).unwrap());
                    let min = exact_depth(group, &view, place, room);
                    let max = exact_depth(group, &view, place, -room);
                    let slack = room * 100.0;
                    assert!(
                        min - slack <= mine && mine <= max + slack,
                        "{name}, {column} {row}: {mine} not in {min}..{max}"
                    );
                    let item = map.balls.as_ref().unwrap().get(column, row).unwrap();
                    assert_eq!(item == NO_BALL, mine == f64::INFINITY);
                    hits += usize::from(item != NO_BALL);
                }
            }
        }
        assert!(hits > 10_000, "{name}: {hits}");
    }
}

#[test]
fn many_balls_at_once_show_the_nearest_at_every_pixel() {
    // hidden blocks are skipped by bounds: a thousand balls at once, pictures of several tiles
    let list = around(1500, 7);
    let drawn = balls(&list);
    let views = [
        View::perspective(EYE, [20.0, 5.0, 0.0], 1.6, [200, 150], 0.0, f64::INFINITY).unwrap(),
        View::hemisphere(EYE, [0.2, 0.1, -0.9], 170).unwrap(),
    ];
    for view in views {
        let map = depth_map(&drawn, &view, Profile::Sphere, ItemBuffer::Without, &Control::none()).unwrap();
        for row in (0..map.depth.height()).step_by(3) {
            for column in 0..map.depth.width() {
                let place = [column as f64 + 0.5, row as f64 + 0.5];
                let mine = f64::from(map.depth.get(column, row).unwrap());
                let bounds = [1e-6, -1e-6].map(|room| exact_depth(&list, &view, place, room));
                assert!(bounds[0] - 1e-4 <= mine && mine <= bounds[1] + 1e-4, "{column} {row}: {mine}, {bounds:?}");
            }
        }
    }
}

#[test]
fn balls_that_hold_the_eye_are_left_out_and_counted() {
    let list = [([3.0, -2.0, 1.0], 1.0), ([3.0, 5.0, 1.5], 2.0), ([3.5, -2.0, 1.5], 0.5)];
    for (name, view) in views() {
        let map = depth_map(&balls(&list), &view, Profile::Sphere, ItemBuffer::With, &Control::none()).unwrap();
        assert_eq!(map.around_eye_count, 2, "{name}");
        assert!(map.balls.unwrap().values().iter().all(|&ball| ball == 1 || ball == NO_BALL), "{name}");
    }
    assert!(
        depth_map(&balls(&list), &views()[0].1, Profile::PaperCone, ItemBuffer::Without, &Control::none()).is_err()
    );
}

#[test]
fn places_and_positions_are_inverse_and_every_direction_has_one_on_a_panorama() {
    for (name, view) in views() {
        for i in 0..500u64 {
            let place = [0, 1].map(|axis: usize| uniform(11, 3 * i + axis as u64) * view.size_px[axis] as f64);
            let depth = 0.1 + 50.0 * uniform(11, 3 * i + 2);
            let local = view.frame.local_from_view(view.position(place, depth)).map(|v| v as f32);
            let found = view.project(local).unwrap();
            // positions are f32 of some metres, 4e-6 m at a tenth of a metre's depth and 100 pixels a radian
            let off = [found[0] - place[0], found[1] - place[1], found[2] - depth];
            assert!(off.iter().all(|v| v.abs() < 0.02), "{name}: {place:?} {depth} became {found:?}");
        }
    }
    let halves = View::panorama(EYE, 50).unwrap();
    for i in 0..2000 {
        let direction = panorama_direction(100, [i % 100, i / 40]);
        let shown = halves.iter().filter(|half| {
            let place = half.place_of_direction(direction);
            place.is_some_and(|[x, y]| half.pixel([x, y, 1.0]).is_some())
        });
        assert!(shown.count() >= 1, "{direction:?}");
    }
}

#[test]
fn a_panorama_shows_balls_at_their_azimuth_and_elevation() {
    let at = |azimuth_deg: f64, elevation_deg: f64, range: f64| {
        let direction = belvedere::view::to_sun(azimuth_deg.to_radians(), elevation_deg.to_radians());
        std::array::from_fn(|i| (EYE[i] + range * direction[i]) as f32)
    };
    let list = [(at(0.0, 0.0, 10.0), 1.0), (at(90.0, 30.0, 20.0), 1.0), (at(-135.0, -60.0, 5.0), 0.5)];
    let map = panorama(&balls(&list), EYE, 720, ItemBuffer::With, &Control::none()).unwrap();
    let items = map.balls.unwrap();
    for (ball, [column, row], range) in [(0, [360, 180], 9.0), (1, [540, 120], 19.0), (2, [90, 300], 4.5)] {
        assert_eq!(items.get(column, row), Some(ball));
        // half a pixel, a quarter of a degree, off the middle of the ball
        assert!((f64::from(map.range.get(column, row).unwrap()) - range).abs() < 0.02);
    }
    assert_eq!(items.get(0, 180), Some(NO_BALL));
}

#[test]
fn views_from_an_eye_that_make_no_sense_are_refused() {
    let (nan, far) = (f64::NAN, f64::INFINITY);
    let camera = |eye, look_at, fov, size, near, far| View::perspective(eye, look_at, fov, size, near, far);
    assert!(camera([nan; 3], EYE, 1.0, [9, 9], 0.0, far).is_err());
    assert!(camera(EYE, EYE, 1.0, [9, 9], 0.0, far).is_err());
    assert!(camera(EYE, [nan; 3], 1.0, [9, 9], 0.0, far).is_err());
    for fov in [0.0, -1.0, 3.2, nan, far] {
        assert!(camera(EYE, [0.0; 3], fov, [9, 9], 0.0, far).is_err(), "{fov}");
    }
    for size in [[0, 9], [9, 0], [1 << 20, 1 << 20], [usize::MAX, 2]] {
        assert!(camera(EYE, [0.0; 3], 1.0, size, 0.0, far).is_err(), "{size:?}");
    }
    for (near, far) in [(-1.0, 5.0), (5.0, 5.0), (nan, 5.0), (0.0, nan), (far, far)] {
        assert!(camera(EYE, [0.0; 3], 1.0, [9, 9], near, far).is_err(), "{near} {far}");
    }
    assert!(View::hemisphere(EYE, [0.0; 3], 9).is_err());
    assert!(View::hemisphere(EYE, [0.0, 0.0, 1.0], 0).is_err());
    assert!(View::fisheye(EYE, [0.0, 0.0, 1.0], 3.1, 9).is_err());
}
