//! Depth maps from a device equal those of the CPU, within the tolerance of depths. Cases: all projections, random and
//! hostile balls, parts, and a device lost during the work.

use crate::{balls_of, devices_or_skip, random_balls};
use belvedere::control::Control;
use belvedere::depth::{DepthMap, ItemBuffer, Profile, depth_map};
use belvedere::medial::{MedialBalls, NO_TOUCH};
use belvedere::model::SceneModel;
use belvedere::query::{Backend, DEPTH_MAP_TOLERANCE};
use belvedere::view::View;
use belvedere_gpu::{Choice, DeviceInfo, Gpu};
use std::sync::Arc;

const SIZE: [f64; 3] = [60.0, 60.0, 15.0];

/// Views of every kind of a scene of [`SIZE`].
pub(crate) fn views() -> Vec<(&'static str, View)> {
    let box_of = |half: f64| [[-half, -half, -8.0], [half, half, 8.0]];
    let [low, high] = box_of(31.0);
    let parallel = |forward, pixel| View::parallel(forward, low, high, pixel).unwrap();
    let [inner_low, inner_high] = box_of(9.0);
    let inner = View::parallel([0.3, 0.5, -0.4], inner_low, inner_high, 0.07).unwrap();
    let camera =
        |eye, at, fov: f64, size, near, far| View::perspective(eye, at, fov.to_radians(), size, near, far).unwrap();
    let endless = f64::INFINITY;
    vec![
        ("from above", parallel([0.0, 0.0, -1.0], 0.23)),
        ("from the side, slanting", parallel([0.31, -0.72, -0.44], 0.3)),
        ("a picture plane amid the balls", inner),
        ("a single pixel", View::from_viewport([0.1, 0.2, 9.0], [0.5, 0.0, 0.0], [0.0, -0.5, 0.0], 2.0).unwrap()),
        ("a camera outside", camera([-50.0, -40.0, 20.0], [0.0, 0.0, 0.0], 60.0, [211, 150], 0.0, endless)),
        ("a camera within, wide", camera([1.3, -2.1, 0.7], [9.0, 8.0, 2.0], 150.0, [160, 133], 0.0, endless)),
        ("limits of depth", camera([-20.0, 5.0, 3.0], [0.0, 0.0, 0.0], 80.0, [150, 100], 6.0, 31.0)),
        ("a telescope", camera([-400.0, -300.0, 60.0], [0.0, 0.0, 0.0], 0.05, [90, 70], 0.0, endless)),
        ("a hemisphere", View::hemisphere([2.0, 3.0, -4.0], [0.0, 0.0, 1.0], 190).unwrap()),
        ("a hemisphere far below", View::hemisphere([0.0, 0.0, -300.0], [0.1, 0.2, 1.0], 300).unwrap()),
        ("more than a hemisphere", View::fisheye([-3.0, 1.0, 0.5], [1.0, 0.5, -0.2], 2.6, 170).unwrap()),
        (
            "a hemisphere with limits",
            View::hemisphere([0.0, 0.0, 2.0], [1.0, 0.0, 0.3], 120).unwrap().with_limits(4.0, 22.0).unwrap(),
        ),
    ]
}

/// Views of a hundred thousand balls, one of each kind: software takes seconds for each.
const WITH_MANY_BALLS: [&str; 3] = ["from the side, slanting", "limits of depth", "a hemisphere far below"];

/// Depths differ by the tolerance at most, empty pixels and the balls of pixels not at all.
fn assert_within(drawn: &DepthMap, expected: &DepthMap, what: &str) {
    let [width, _] = expected.view.size_px;
    for (at, (&drawn, &expected)) in drawn.depth.values().iter().zip(expected.depth.values()).enumerate() {
        let place = [at % width, at / width];
        assert!(is_within(drawn, expected), "{what}: {drawn} m for {expected} m at {place:?}");
    }
    assert!(drawn.balls == expected.balls, "{what}: other balls");
    assert_eq!(drawn.around_eye_count, expected.around_eye_count, "{what}: balls around the eye");
    assert!(drawn.view == expected.view && drawn.profile == expected.profile, "{what}");
}

fn is_within(drawn: f32, expected: f32) -> bool {
    let [drawn, expected] = [drawn, expected].map(f64::from);
    drawn == expected || (drawn - expected).abs() <= f64::from(DEPTH_MAP_TOLERANCE) * expected
}

/// Draws on a device and on the CPU. Says how many pixels show something.
fn assert_within_on(gpu: &Gpu, balls: &MedialBalls, view: &View, all_items: &[ItemBuffer], what: &str) -> usize {
    let pixels = view.size_px[0] * view.size_px[1];
    // the device draws a small picture too
    let drawable = gpu.drawable(balls, pixels.max(10_000), &Control::none()).unwrap();
    let drawable = drawable.unwrap_or_else(|| panic!("{what}: the device draws nothing"));
    let mut shown = 0;
    for &items in all_items {
        let expected = depth_map(balls, view, Profile::Sphere, items, &Control::none()).unwrap();
        let drawn = drawable.depth_map(view, items, &Control::none()).unwrap();
        assert_within(&drawn, &expected, what);
        shown = expected.depth.values().iter().filter(|depth| depth.is_finite()).count();
    }
    shown
}

pub(crate) fn on(device: &DeviceInfo) -> Gpu {
    Gpu::new(Choice::Number(device.number)).unwrap()
}

#[test]
fn depth_maps_of_random_balls_are_within_the_tolerance() {
    let few = balls_of(random_balls(2500, SIZE, 2.0));
    let many = balls_of(random_balls(100_000, SIZE, 0.4));
    for device in devices_or_skip("depth_maps_of_random_balls_are_within_the_tolerance") {
        let gpu = on(&device);
        for (name, view) in views() {
            let what = format!("{name} on {}", device.name);
            assert!(assert_within_on(&gpu, &few, &view, &[ItemBuffer::Without], &what) > 0, "{what}: nothing is seen");
            if WITH_MANY_BALLS.contains(&name) {
                assert_within_on(&gpu, &many, &view, &[ItemBuffer::With], &what);
            }
        }
        assert!(gpu.notes().is_empty() && gpu.used().is_some(), "{:?}", gpu.notes());
    }
}

/// Sets of balls at the edges of the range of numbers.
pub(crate) fn hostile() -> Vec<(&'static str, MedialBalls)> {
    let plain: Vec<_> = random_balls(800, SIZE, 2.0).collect();
    let with = |others: &[([f64; 3], f64)]| balls_of(plain.iter().chain(others).copied());
    let mut unlimited = with(&[([0.0; 3], 20.0)]);
    if let Some(touch) = unlimited.touch.last_mut() {
        *touch = NO_TOUCH;
    }
    // the eyes of some views lie in the first, at the surface of the second, and just outside and inside of the others
    let around_eyes = [
        ([2.0, 3.0, -4.0], 0.5),
        ([2.0, 3.0, -1.0], 3.0),
        ([1.3, -2.1, 3.7], 2.999_999),
        ([1.3, -2.1, 4.7], 4.000_001),
        ([2.0, 3.0, -4.0], 1e-6),
        ([-3.0, 1.0, 0.5], 1e-12),
    ];
    // their surface is where depth begins, or just before or behind
    let at_planes = [
        ([-14.0, 5.0, 3.0], 0.001),
        ([4.0, 0.0, 2.0], 1.0),
        ([0.5, 0.2, 9.0], 0.4),
        ([0.3, 0.1, 9.5], 0.5),
        ([0.3, 0.1, 9.5], 0.499_999_97),
    ];
    let twice: Vec<_> = plain.iter().rev().chain(&plain).chain(&plain).copied().collect();
    vec![
        ("balls of radius zero", balls_of(plain.iter().map(|(center, _)| (*center, 0.0)))),
        ("tiny balls", with(&[([0.0; 3], 1e-30), ([1.0; 3], 1e-42), ([2.0, 3.0, 1e-30], 1e-7)])),
        (
            "huge balls",
            with(&[([0.0, 0.0, -9e6], 9e6), ([3e5, 0.0, 0.0], 3e5 - 40.0), ([0.0, -1e12, 0.0], 1e12 - 60.0)]),
        ),
        ("the largest numbers", with(&[([3e38, 0.0, 0.0], 3e38), ([0.0, -3e38, 1.0], 1.0), ([1e20; 3], 1e19)])),
        (
            "balls far away",
            with(&[
                ([8e6, -8e6, 5e6], 1.0),
                ([0.0, 0.0, -4000.0], 900.0),
                ([1e5, 1e5, 0.0], 3e4),
                ([7e3, 7e3, 60.0], 40.0),
                ([9e3, -3e3, 300.0], 500.0),
                ([30.0, 20.0, -1e4], 200.0),
            ]),
        ),
        ("balls around eyes", with(&around_eyes)),
        ("balls at planes", with(&at_planes)),
        ("all balls thrice", balls_of(twice.into_iter())),
        ("a ball without limit", unlimited),
        ("negative radii", with(&[([0.0; 3], -4.0), ([0.0, 0.0, 1.0], f64::NEG_INFINITY)])),
        (
            "balls that are no numbers",
            with(&[
                ([f64::NAN, 0.0, 0.0], 1.0),
                ([0.0; 3], f64::NAN),
                ([0.0; 3], f64::INFINITY),
                ([f64::INFINITY, 0.0, 0.0], 2.0),
            ]),
        ),
        ("a single ball", balls_of([([0.0; 3], 7.0)].into_iter())),
    ]
}

#[test]
fn depth_maps_of_hostile_balls_are_within_the_tolerance() {
    for device in devices_or_skip("depth_maps_of_hostile_balls_are_within_the_tolerance") {
        let gpu = on(&device);
        for (of, balls) in hostile() {
            for (name, view) in views() {
                let what = format!("{of}, {name} on {}", device.name);
                assert_within_on(&gpu, &balls, &view, &[ItemBuffer::With], &what);
            }
        }
        assert!(gpu.notes().is_empty(), "{:?}", gpu.notes());
        // both ways were taken
        let share = gpu.redone_share();
        assert!(share > 0.001 && share < 0.5, "{share} of the pixels are drawn again");
    }
}

#[test]
fn balls_and_pictures_larger_than_the_buffers_are_drawn_in_parts() {
    let balls = balls_of(random_balls(8000, SIZE, 1.5));
    for device in devices_or_skip("balls_and_pictures_larger_than_the_buffers_are_drawn_in_parts") {
        // 8000 balls need lists of 288 kB, and pictures of 60 000 pixels 240 kB
        let gpu = Gpu::limited(device.number, 150_000, None).unwrap();
        for (name, view) in views().into_iter().step_by(2) {
            let what = format!("{name}, in parts on {}", device.name);
            assert_within_on(&gpu, &balls, &view, &[ItemBuffer::With], &what);
        }
        assert!(gpu.notes().is_empty() && gpu.used().is_some(), "{:?}", gpu.notes());
    }
}

#[test]
fn a_device_lost_in_the_middle_of_a_picture_loses_nothing() {
    let balls = balls_of(random_balls(5000, SIZE, 1.0));
    let view = views()[0].1;
    for device in devices_or_skip("a_device_lost_in_the_middle_of_a_picture_loses_nothing") {
        let gpu = Gpu::limited(device.number, 150_000, Some(1)).unwrap();
        assert_within_on(&gpu, &balls, &view, &[ItemBuffer::Without, ItemBuffer::With], "lost");
        assert!(gpu.notes().len() == 1 && gpu.notes()[0].contains("the CPU does the rest"), "{:?}", gpu.notes());
        assert!(gpu.device().is_none() && gpu.used().is_none());
        // and it is not used again
        assert!(gpu.drawable(&balls, 1 << 20, &Control::none()).unwrap().is_none());
        // a device whose buffers hold next to nothing
        let tiny = Gpu::limited(device.number, 64, None).unwrap();
        assert_within_on(&tiny, &balls, &view, &[ItemBuffer::Without], "tiny");
        assert_eq!(tiny.notes().len(), 1, "{:?}", tiny.notes());
    }
}

/// The pictures of a model are those of the CPU within the tolerance, panoramas too, and few pixels are drawn twice.
pub(crate) fn assert_pictures_are_within(name: &str, model: &SceneModel, gpu: &Arc<Gpu>) {
    let on_device = model.clone().with_backend(gpu.clone());
    let (low, high) = model.bounds().corners();
    let middle: [f64; 3] = std::array::from_fn(|axis| 0.5 * (low[axis] + high[axis]));
    let size = (high[0] - low[0]).max(high[1] - low[1]);
    let beside = [middle[0] - 0.3 * size, middle[1] + 0.1 * size, high[2] + 0.1 * size];
    let views = [
        View::parallel([0.0, 0.0, -1.0], low, high, size / 300.0).unwrap(),
        View::parallel([0.5, 0.6, -0.5], low, high, size / 300.0).unwrap(),
        View::perspective(beside, middle, 1.2, [320, 200], 0.0, f64::INFINITY).unwrap(),
    ];
    for view in &views {
        for items in [ItemBuffer::With, ItemBuffer::Without] {
            let draw = |model: &SceneModel| model.depth_map(view, Profile::Sphere, items, &Control::none()).unwrap();
            let expected = draw(model);
            assert!(expected.depth.values().iter().filter(|depth| depth.is_finite()).count() > 10_000, "{name}");
            assert_within(&draw(&on_device), &expected, name);
        }
    }
    let eye = [middle[0], middle[1], high[2]];
    let around = |model: &SceneModel| model.panorama(eye, 400, ItemBuffer::With, &Control::none()).unwrap();
    let (drawn, expected) = (around(&on_device), around(model));
    assert!(drawn.balls == expected.balls && drawn.around_eye_count == expected.around_eye_count, "{name}: panoramas");
    let mut ranges = drawn.range.values().iter().zip(expected.range.values());
    assert!(ranges.all(|(&drawn, &expected)| is_within(drawn, expected)), "{name}: panoramas");
    assert!(gpu.redone_share() < 0.02, "{name}: {} of the pixels are drawn again", gpu.redone_share());
}

#[test]
fn the_papers_cone_stays_on_the_cpu() {
    let balls = balls_of(random_balls(5000, SIZE, 1.0));
    let view = views()[0].1;
    for device in devices_or_skip("the_papers_cone_stays_on_the_cpu") {
        let parts = belvedere::model::ModelParts { balls: balls.clone(), ..Default::default() };
        let model = SceneModel::from_parts(parts).unwrap();
        let gpu = Arc::new(on(&device));
        let with_gpu = model.clone().with_backend(gpu.clone());
        let draw = |model: &SceneModel, profile| {
            model.depth_map(&view, profile, ItemBuffer::Without, &Control::none()).unwrap()
        };
        assert!(draw(&with_gpu, Profile::PaperCone) == draw(&model, Profile::PaperCone));
        assert!(gpu.used().is_none());
        assert_within(&draw(&with_gpu, Profile::Sphere), &draw(&model, Profile::Sphere), "spheres");
        assert!(gpu.used().is_some());
    }
}
