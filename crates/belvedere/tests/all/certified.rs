//! Certified answers against those of exact lines of sight, and bounds of depth against rays through the pixels.

use belvedere::blocking::Ball;
use belvedere::control::Control;
use belvedere::depth::{BoundsParams, Profile, depth_bounds};
use belvedere::medial::MedialBalls;
use belvedere::query::certified::CertifiedMap;
use belvedere::query::{Answer, BlockRule, MedialScene, Scope, Viewer, Visibility, random_targets};
use belvedere::random::uniform;
use belvedere::view::View;

/// Balls of all sizes below 3 m in a box of 60 m, some of them alike.
fn balls(count: u64, seed: u64) -> MedialBalls {
    let u = |i: u64| uniform(seed, i) as f32;
    let centers = (0..count).map(|i| [60.0 * u(4 * i), 60.0 * u(4 * i + 1), 30.0 * u(4 * i + 2)]).collect();
    let radii = (0..count).map(|i| 0.02 * 150f32.powf(u(4 * i + 3))).collect::<Vec<f32>>();
    let n = radii.len();
    MedialBalls { centers, radii, source: vec![0; n], touch: vec![0; n], separation_angles: vec![1.0; n] }
}

const EYE: [f64; 3] = [31.0, 28.0, 12.0];

/// One view of each projection, and a whole sphere.
fn views() -> Vec<(&'static str, Vec<View>)> {
    let from_above = View::from_viewport([-1.0, 61.0, 28.0], [62.0, 0.0, 0.0], [0.0, -62.0, 0.0], 4.0).unwrap();
    let oblique = View::parallel([0.5, 0.3, -0.8], [0.0; 3], [60.0, 60.0, 30.0], 0.25).unwrap();
    let camera = |near| View::perspective(EYE, [50.0, 45.0, 9.0], 1.4, [420, 300], near, 60.0).unwrap();
    vec![
        ("straight down from a plane that cuts the scene", vec![from_above]),
        ("oblique", vec![oblique]),
        ("camera", vec![camera(0.0)]),
        ("camera with a near limit", vec![camera(3.0)]),
        ("hemisphere", vec![View::hemisphere(EYE, [0.3, 0.2, 0.9], 400).unwrap().with_limits(2.0, 50.0).unwrap()]),
        ("panorama", View::panorama(EYE, 400).unwrap().to_vec()),
        ("coarse camera", vec![View::perspective(EYE, [0.0, 0.0, 5.0], 2.6, [7, 5], 0.0, f64::INFINITY).unwrap()]),
    ]
}

/// Targets anywhere, and as many within a few centimetres of the surface of a ball, where answers turn.
fn targets(balls: &MedialBalls, count: usize) -> Vec<[f32; 3]> {
    let mut targets = random_targets([-5.0; 3], [65.0, 65.0, 35.0], count, 5);
    for i in 0..count {
        let ball = i % balls.len();
        let d: [f32; 3] = std::array::from_fn(|axis| uniform(6, (3 * i + axis) as u64) as f32 - 0.5);
        let off = balls.radii[ball] + 0.3 * (uniform(7, i as u64) as f32 - 0.5).powi(3);
        let length = d.iter().map(|v| v * v).sum::<f32>().sqrt();
        targets.push(std::array::from_fn(|axis| balls.centers[ball][axis] + d[axis] / length * off));
    }
    targets
}

#[test]
fn certified_answers_are_those_of_exact_lines_of_sight() {
    let mut balls = balls(3000, 1);
    // some hold the eye, one has it on its surface as nearly as f32 can tell
    balls.centers[..3].copy_from_slice(&[[31.0, 28.0, 12.2], [30.0, 27.5, 11.0], [31.0, 28.0, 11.5]]);
    balls.radii[..3].copy_from_slice(&[0.3, 2.0, 0.5]);
    let targets = targets(&balls, 10_000);
    for (depth_bias, shell) in [(0.0, 0.0), (0.0, 0.2), (0.1, 0.25), (-0.1, 0.3)] {
        let scene = MedialScene::new(&balls, &BlockRule { profile: Profile::Sphere, bias: depth_bias, shell }).unwrap();
        for (name, views) in views() {
            let viewer = match views[0].is_central() {
                true => Viewer::Eye(views[0].frame.eye),
                false => Viewer::Direction(views[0].frame.forward.map(|v| -v)),
            };
            let (certified, report) = CertifiedMap::new(&scene, &views, Scope::Viewer, &Control::none())
                .unwrap()
                .answers(&targets, &Control::none())
                .unwrap();
            let exact = scene.visible(viewer, &targets).unwrap();
            let differ = (0..targets.len()).filter(|&i| certified[i] != exact[i]).count();
            assert_eq!(differ, 0, "{name}, bias {depth_bias}, shell {shell}");
            assert_eq!(report.target_count, targets.len());
            assert!(exact.contains(&Answer::Blocked) && exact.contains(&Answer::Visible), "{name}");

            if let [view] = &views[..] {
                let (certified, _) = CertifiedMap::new(&scene, &views, Scope::View, &Control::none())
                    .unwrap()
                    .answers(&targets, &Control::none())
                    .unwrap();
                assert!(
                    certified == scene.query_view(view, &targets, &Control::none()).unwrap(),
                    "{name} within the view"
                );
                assert!(certified.contains(&Answer::OutsideView), "{name}");
            }
        }
    }
}

#[test]
fn bounds_settle_most_targets_and_more_with_finer_pixels() {
    let balls = balls(3000, 1);
    let scene = MedialScene::new(&balls, &BlockRule::carved()).unwrap();
    let targets = random_targets([0.0; 3], [60.0, 60.0, 30.0], 20_000, 8);
    let share = |pixel: f64| {
        let view = View::parallel([0.2, 0.1, -0.9], [0.0; 3], [60.0, 60.0, 30.0], pixel).unwrap();
        let (_, report) = CertifiedMap::new(&scene, &[view], Scope::Viewer, &Control::none())
            .unwrap()
            .answers(&targets, &Control::none())
            .unwrap();
        report.settled_count as f64 / report.target_count as f64
    };
    let shares = [1.0, 0.5, 0.25, 0.1].map(share);
    assert!(shares.is_sorted(), "{shares:?}");
    // most balls here are smaller than a pixel of a metre; 0.87 measured
    assert!(shares[3] > 0.8, "{shares:?}");
}

/// Least front of all balls along a line from the eye, or from the plane of a parallel view, in f64.
fn first_front(balls: &[Ball], view: &View, place: [f64; 2], start: f64) -> f64 {
    let direction = view.direction(place);
    let origin = if view.is_central() { [0.0; 3] } else { view.position(place, 0.0) };
    let range_per_depth = if view.limits()[1].is_finite() { 1.0 / direction[2] } else { 1.0 };
    let fronts = balls.iter().filter_map(|&Ball { center, radius }| {
        let c = view.frame.view_from_local(center);
        let c: [f64; 3] = std::array::from_fn(|i| c[i] - origin[i]);
        let along: f64 = (0..3).map(|i| c[i] * direction[i]).sum();
        let square = f64::from(radius).powi(2) - (c.iter().map(|v| v * v).sum::<f64>() - along * along);
        let front = along - square.max(0.0).sqrt();
        (square > 0.0 && front > start * range_per_depth).then_some(front)
    });
    fronts.fold(f64::INFINITY, f64::min)
}

#[test]
fn the_first_surface_of_every_place_of_a_pixel_lies_within_its_bounds() {
    let balls = balls(2000, 3);
    let list: Vec<_> =
        balls.centers.iter().zip(&balls.radii).map(|(&center, &radius)| Ball { center, radius }).collect();
    let mut within_upper = 0;
    for (name, views) in views() {
        for view in views {
            // limits of range of hemispheres and of depth of cameras differ: cameras are those with a far limit of 60 m
            let start = if name.contains("camera with") { 3.0 } else { 0.0 };
            let bounds = depth_bounds(&list, &view, &BoundsParams { shell: 0.0, start }, &Control::none()).unwrap();
            for i in 0..1500u64 {
                let [width, height] = view.size_px.map(|v| v as f64);
                let (x, y) = (uniform(9, 2 * i) * width, uniform(9, 2 * i + 1) * height);
                // corners of pixels too
                let place = if i % 3 == 0 { [x.floor() + 1e-9, y.floor() + 1.0 - 1e-9] } else { [x, y] };
                let [column, row] = place.map(|v| v as usize);
                let [mut least, most] = bounds.bounds.get(column, row).unwrap().map(f64::from);
                if start == 0.0 {
                    least = least.max(0.0);
                }
                let front = first_front(&list, &view, place, start);
                assert!(least <= front && front <= most, "{name}: {front} not in {least}..{most}");
                within_upper += usize::from(most.is_finite());
            }
        }
    }
    assert!(within_upper > 3000, "upper bounds must mean something: {within_upper}");
}

#[test]
fn answers_of_a_certified_map_are_the_same_for_any_number_of_threads() {
    let balls = balls(1500, 4);
    let targets = targets(&balls, 3000);
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let scene = MedialScene::new(&balls, &BlockRule::carved()).unwrap();
            let map =
                CertifiedMap::new(&scene, &View::panorama(EYE, 200).unwrap(), Scope::Viewer, &Control::none()).unwrap();
            let bits: Vec<u32> =
                map.bounds().iter().flat_map(|b| b.bounds.values().iter().flat_map(|v| v.map(f32::to_bits))).collect();
            (bits, map.answers(&targets, &Control::none()).unwrap())
        })
    };
    let one = run(1);
    assert!(one == run(2) && one == run(5));
}

#[test]
fn views_and_balls_that_cannot_be_certified_are_refused() {
    let balls = balls(10, 4);
    let scene = MedialScene::new(&balls, &BlockRule::carved()).unwrap();
    let eyes = [[0.0; 3], [1.0, 0.0, 0.0]].map(|eye| View::hemisphere(eye, [0.0, 0.0, 1.0], 10).unwrap());
    assert!(CertifiedMap::new(&scene, &[], Scope::Viewer, &Control::none()).is_err());
    assert!(CertifiedMap::new(&scene, &eyes, Scope::Viewer, &Control::none()).is_err());
    let cone = BlockRule { profile: Profile::PaperCone, ..BlockRule::default() };
    let cones = MedialScene::new(&balls, &cone).unwrap();
    assert!(CertifiedMap::new(&cones, &eyes[..1], Scope::Viewer, &Control::none()).is_err());
    let odd = [[f32::NAN, 1.0, 1.0], [f32::INFINITY, 0.0, 0.0], [f32::MAX, f32::MAX, 0.0], [0.0; 3]];
    for scope in [Scope::View, Scope::Viewer] {
        let (answers, _) = CertifiedMap::new(&scene, &eyes[..1], scope, &Control::none())
            .unwrap()
            .answers(&odd, &Control::none())
            .unwrap();
        assert_eq!(answers[0], Answer::OutsideView);
        assert_eq!(answers[3], Answer::OutsideView, "the eye itself");
    }
}
