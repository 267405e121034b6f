//! Bounds of depth from a device are valid, and answers by them equal those of exact lines of sight. Cases: all
//! projections, random and hostile balls, parts, and a device lost during the work.

use belvedere::control::Control;
use belvedere::depth::{BoundsParams, DepthBounds, Profile, depth_bounds};
use belvedere::medial::MedialBalls;
use belvedere::query::certified::CertifiedMap;
use belvedere::query::{Backend, BallTree, BlockRule, MedialScene, Scope, random_targets};
use belvedere::view::View;
use belvedere_gpu::Gpu;
use std::sync::Arc;

use crate::bounded_views::{
    RULES, as_list, assert_answers_are_exact, assert_bounds_hold, balls, balls_at_eye, start_of, targets, views,
};
use crate::depth_maps::{hostile, on, views as depth_map_views};
use crate::devices_or_skip;

/// Bounds of a device.
fn drawn(gpu: &Gpu, balls: &MedialBalls, rule: &BlockRule, view: &View, start: f64) -> DepthBounds {
    let tree = Arc::new(BallTree::new(balls, rule).unwrap());
    gpu.prepare(&tree).unwrap().depth(view, start, &Control::none()).unwrap()
}

/// The share of pixels whose bounds of a device are more than a millimetre wider than those of the CPU.
fn share_wider(drawn: &DepthBounds, expected: &DepthBounds) -> f64 {
    let is_wider = |(drawn, expected): (&[f32; 2], &[f32; 2])| {
        let below = |lower: f32, upper: f32| lower < upper && !(upper - lower < 0.001);
        below(drawn[0], expected[0]) || below(expected[1], drawn[1])
    };
    let pixels = drawn.bounds.values().iter().zip(expected.bounds.values());
    pixels.filter(|&pair| is_wider(pair)).count() as f64 / drawn.bounds.values().len() as f64
}

#[test]
fn bounds_hold_for_every_place_of_a_pixel() {
    let balls = balls(5000, 3);
    let list = as_list(&balls);
    for device in devices_or_skip("bounds_hold_for_every_place_of_a_pixel") {
        let gpu = on(&device);
        let mut within_upper = 0;
        for (name, views) in views() {
            for view in views {
                let (start, what) = (start_of(name), format!("{name} on {}", device.name));
                let rule = BlockRule { profile: Profile::Sphere, bias: 0.0, shell: 0.0 };
                let bounds = drawn(&gpu, &balls, &rule, &view, start);
                within_upper += assert_bounds_hold(&list, &bounds, start, &what);
                let of_cpu = depth_bounds(&list, &view, &BoundsParams { shell: 0.0, start }, &Control::none()).unwrap();
                let wider = share_wider(&bounds, &of_cpu);
                // 2 × 10⁻⁴ measured; where a pixel sees 40 degrees the device's cones are wider
                assert!(wider < 0.001 || name == "coarse camera", "{what}: {wider} of pixels have wider bounds");
            }
        }
        assert!(within_upper > 3000, "upper bounds must mean something: {within_upper}");
        assert!(gpu.notes().is_empty() && gpu.used().is_some(), "{:?}", gpu.notes());
    }
}

#[test]
fn answers_by_bounds_of_a_device_are_those_of_exact_lines_of_sight() {
    let balls = balls_at_eye();
    let targets = targets(&balls, 4_000);
    for device in devices_or_skip("answers_by_bounds_of_a_device_are_those_of_exact_lines_of_sight") {
        for (bias, shell) in RULES {
            let gpu = Arc::new(on(&device));
            let scene = || MedialScene::new(&balls, &BlockRule { profile: Profile::Sphere, bias, shell }).unwrap();
            let (scene, on_device) = (scene(), scene().with_backend(gpu.clone()));
            for (name, views) in views() {
                let what = format!("{name}, bias {bias}, shell {shell} on {}", device.name);
                let settled = assert_answers_are_exact(&on_device, &views, &targets, &what);
                let by_cpu = assert_answers_are_exact(&scene, &views, &targets, &what);
                // mostly more: the device has a cone for each pixel, the CPU one for each tile
                assert!(settled > by_cpu - 0.001, "{what}: {settled} settled, {by_cpu} by the CPU");
            }
            assert!(gpu.notes().is_empty() && gpu.used().is_some(), "{:?}", gpu.notes());
        }
    }
}

/// As many targets as there are, seen through all views, have the answers that the CPU gives.
fn assert_same_answers(gpu: &Arc<Gpu>, balls: &MedialBalls, views: &[(&str, View)], what: &str) {
    let targets = random_targets([-35.0; 3], [35.0; 3], 1500, 3);
    let scene = || MedialScene::new(balls, &BlockRule::carved()).unwrap();
    let (scene, on_device) = (scene(), scene().with_backend(gpu.clone()));
    for (name, view) in views {
        for scope in [Scope::View, Scope::Viewer] {
            let answers = |scene: &MedialScene| {
                let map = CertifiedMap::new(scene, std::slice::from_ref(view), scope, &Control::none()).unwrap();
                map.answers(&targets, &Control::none()).unwrap().0
            };
            assert!(answers(&on_device) == answers(&scene), "{what}: {name}, {scope:?}");
        }
    }
}

#[test]
fn answers_past_hostile_balls_are_those_of_the_cpu() {
    for device in devices_or_skip("answers_past_hostile_balls_are_those_of_the_cpu") {
        let gpu = Arc::new(on(&device));
        for (of, balls) in hostile() {
            assert_same_answers(&gpu, &balls, &depth_map_views(), &format!("{of} on {}", device.name));
        }
        assert!(gpu.notes().is_empty() && gpu.used().is_some(), "{:?}", gpu.notes());
    }
}

#[test]
fn bounds_are_drawn_in_parts_and_a_lost_device_loses_nothing() {
    let balls = balls(8000, 6);
    let views: Vec<_> = depth_map_views().into_iter().step_by(3).collect();
    for device in devices_or_skip("bounds_are_drawn_in_parts_and_a_lost_device_loses_nothing") {
        let in_parts = Arc::new(Gpu::limited(device.number, 150_000, None).unwrap());
        assert_same_answers(&in_parts, &balls, &views, &format!("in parts on {}", device.name));
        assert!(in_parts.notes().is_empty() && in_parts.used().is_some(), "{:?}", in_parts.notes());
        let lost = Arc::new(Gpu::limited(device.number, 150_000, Some(1)).unwrap());
        assert_same_answers(&lost, &balls, &views, &format!("lost on {}", device.name));
        assert!(lost.notes().len() == 1 && lost.used().is_none(), "{:?}", lost.notes());
    }
}
