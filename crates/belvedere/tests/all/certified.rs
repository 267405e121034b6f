//! Certified answers against those of exact lines of sight, and bounds of depth against rays through the pixels.

use belvedere::control::Control;
use belvedere::depth::{BoundsParams, Profile, depth_bounds};
use belvedere::query::certified::CertifiedMap;
use belvedere::query::{Answer, BlockRule, MedialScene, Scope, random_targets};
use belvedere::view::View;

use crate::bounded_views::{
    EYE, RULES, as_list, assert_answers_are_exact, assert_bounds_hold, balls, balls_at_eye, start_of, targets, views,
};

#[test]
fn certified_answers_are_those_of_exact_lines_of_sight() {
    let around_eye = balls_at_eye();
    let targets = targets(&around_eye, 10_000);
    for (bias, shell) in RULES {
        let scene = MedialScene::new(&around_eye, &BlockRule { profile: Profile::Sphere, bias, shell }).unwrap();
        assert_eq!(scene.is_inside_obstacle(EYE), shell == 0.0);
        for (name, views) in views() {
            assert_answers_are_exact(&scene, &views, &targets, &format!("{name}, bias {bias}, shell {shell}"));
        }
    }
    // without a shell from an eye that is outside all balls
    let (free, rule) = (balls(3000, 1), BlockRule::default());
    let scene = MedialScene::new(&free, &rule).unwrap();
    assert!(!scene.is_inside_obstacle(EYE));
    for (name, views) in views() {
        assert_answers_are_exact(&scene, &views, &targets, &format!("{name}, an eye in the open"));
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

#[test]
fn the_first_surface_of_every_place_of_a_pixel_lies_within_its_bounds() {
    let list = as_list(&balls(2000, 3));
    let mut within_upper = 0;
    for (name, views) in views() {
        for view in views {
            let start = start_of(name);
            let bounds = depth_bounds(&list, &view, &BoundsParams { shell: 0.0, start }, &Control::none()).unwrap();
            within_upper += assert_bounds_hold(&list, &bounds, start, name);
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
