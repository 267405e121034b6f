//! Viewsheds against closed forms, against answers one by one, and against the exact mesh of a town.

use belvedere::apps::viewshed::{
    GROUND_TOLERANCE, Masks, Observer, SightLimits, ViewshedParams, cell_targets, min_visible_heights, viewshed,
};
use belvedere::control::Control;
use belvedere::ground::{Ground, MapGrid};
use belvedere::medial::MedialBalls;
use belvedere::query::{Answer, BlockRule, Curvature, EarthParams, MedialScene};
use belvedere::random::uniform;

fn scene(list: &[([f32; 3], f32)], params: &BlockRule) -> MedialScene {
    let balls = MedialBalls {
        centers: list.iter().map(|b| b.0).collect(),
        radii: list.iter().map(|b| b.1).collect(),
        source: (0..list.len() as u32).collect(),
        touch: (0..list.len() as u32).collect(),
        separation_angles: vec![1.0; list.len()],
    };
    MedialScene::new(&balls, params).unwrap()
}

/// Level ground at height 0 over a square.
fn plain(size: f64, cell: f64) -> Ground {
    let grid = MapGrid::covering([0.0; 2], [size - cell / 2.0; 2], cell, [0.0; 2]).unwrap();
    let far = size as f32 + 10.0;
    let corners = [[-10.0, -10.0, 0.0], [far, -10.0, 0.0], [-10.0, far, 0.0], [far, far, 0.0]];
    Ground::of_points(&corners, grid, 1e6, &Control::none()).unwrap()
}

fn random_balls(count: u64, size: f64) -> Vec<([f32; 3], f32)> {
    let at = |i: u64| (size * uniform(3, i)) as f32;
    (0..count).map(|i| ([at(3 * i), at(3 * i + 1), 0.2 * at(3 * i + 2)], 0.3 + 2.0 * uniform(4, i) as f32)).collect()
}

fn looking(eye: [f64; 3]) -> Observer {
    Observer { eye, ..Observer::default() }
}

#[test]
fn the_shadow_of_a_ball_on_a_plain_is_its_conic() {
    // a ball of 2 m at 5 m height, 10 m before an eye at 8 m: a cell is hidden where its line of sight comes within 2 m
    // of the middle
    let (eye, center, radius) = ([5.0, 20.0, 8.0], [15.0, 20.0, 5.0], 2.0);
    let scene = scene(&[(center.map(|v: f64| v as f32), radius as f32)], &BlockRule::default());
    let ground = plain(40.0, 0.25);
    let targets = cell_targets(&ground, 0.0);
    let result = viewshed(&scene, &[looking(eye)], &targets, &ViewshedParams::default(), &Control::none()).unwrap();
    let mut hidden = 0;
    for (target, answer) in targets.iter().zip(&result.answers) {
        let t = target.map(f64::from);
        let d: [f64; 3] = std::array::from_fn(|i| t[i] - eye[i]);
        let c: [f64; 3] = std::array::from_fn(|i| center[i] - eye[i]);
        let along: f64 = (0..3).map(|i| d[i] * c[i]).sum::<f64>() / d.iter().map(|v| v * v).sum::<f64>();
        let miss = (0..3).map(|i| (c[i] - along * d[i]).powi(2)).sum::<f64>().sqrt();
        let expected = if miss < radius && along > 0.0 { Answer::Blocked } else { Answer::Visible };
        hidden += usize::from(expected == Answer::Blocked);
        // 1e-5 m: positions are f32
        assert!(*answer == expected || (miss - radius).abs() < 1e-5, "{t:?}");
    }
    assert!(hidden > 500, "{hidden}");
    assert_eq!(result.seen_counts, [targets.len() - hidden]);
}

#[test]
fn least_heights_are_where_answers_change() {
    let list = random_balls(120, 60.0);
    let ground = plain(60.0, 2.0);
    let (ceiling, flat) = (80.0, EarthParams::flat());
    for params in [BlockRule::default(), BlockRule::carved(), BlockRule::uncarved()] {
        let scene = scene(&list, &params);
        let observer = looking([31.0, 29.0, 1.7]);
        let heights = min_visible_heights(&scene, &[observer], &ground, ceiling, &flat, &Control::none()).unwrap();
        let mut raised = 0;
        for (foot, &height) in cell_targets(&ground, 0.0).iter().zip(heights.values()) {
            let seen = |h: f64| {
                let target = [f64::from(foot[0]), f64::from(foot[1]), f64::from(foot[2]) + h];
                scene.sight_answer(observer.eye, target, &flat) == Answer::Visible
            };
            let found = f64::from(height);
            // every height tried in turn, 5 cm apart, from that at which the ground is tested
            let tried = (1..1600).map(|i| 0.05 * f64::from(i)).find(|&h| seen(h));
            match tried {
                None => assert!(found.is_infinite() || found > ceiling - 0.1, "{foot:?} {found}"),
                Some(tried) if tried == GROUND_TOLERANCE => assert_eq!(found, 0.0),
                Some(tried) => {
                    raised += 1;
                    assert!(found > GROUND_TOLERANCE, "{foot:?}: {found}");
                    // f32 heights of 80 m carry 4e-6 m
                    assert!(found <= tried + 2e-3 + 1e-5, "{foot:?}: {found} but seen at {tried}");
                    assert!(seen(found + 1e-5) || seen(found + 1e-3), "{foot:?}: not seen at {found}");
                    assert!(!seen(found - 2.2e-3), "{foot:?}: seen below {found}");
                }
            }
        }
        assert!(raised > 100, "{raised}");
    }
}

#[test]
fn beyond_the_horizon_a_thing_must_reach_the_closed_form() {
    // water as a row of large balls whose crests lie at height 0, an eye 10 m above it: a mast at S metres is seen from
    // (S − d)²·q on, where d = √(10/q) is the way to the horizon and q = (1 − k)/2R
    let list: Vec<([f32; 3], f32)> = (0..1500).map(|i| ([20.0 * i as f32, 0.0, -5000.0], 5000.0)).collect();
    let scene = scene(&list, &BlockRule::default());
    let earth = EarthParams { curvature: Curvature::On, ..EarthParams::default() };
    let q = (1.0 - 1.0 / 7.0) / (2.0 * 6_371_008.8);
    for span in [20_000.0, 25_000.0] {
        let expected = q * (span - (10.0_f64 / q).sqrt()).powi(2);
        let found = scene.min_visible_height([0.0, 0.0, 10.0], [span, 0.0, 0.0], 500.0, &earth).unwrap();
        // crests 20 m apart sag by 1 cm between them, chords by 4 mm, and both are magnified by the ratio of the ways,
        // below 2
        assert!((found - expected).abs() < 0.05, "{found} {expected}");
        assert!(expected > 3.0);
    }
}

#[test]
fn counts_and_masks_are_those_of_each_observer_alone() {
    let scene = scene(&random_balls(150, 40.0), &BlockRule::carved());
    let ground = plain(40.0, 1.0);
    let targets = cell_targets(&ground, 0.0);
    let observers: Vec<Observer> =
        (0..35).map(|i| looking([40.0 * uniform(1, i), 40.0 * uniform(2, i), 1.7])).collect();
    let params = ViewshedParams::default().with_masks(Masks::Kept);
    let all = viewshed(&scene, &observers, &targets, &params, &Control::none()).unwrap();
    assert_eq!(all.masks.len(), 2);
    for (number, observer) in observers.iter().enumerate() {
        let one = viewshed(&scene, &[*observer], &targets, &params, &Control::none()).unwrap();
        for (cell, answer) in one.answers.iter().enumerate() {
            let bit = all.masks[number / 32][cell] >> (number % 32) & 1 == 1;
            assert_eq!(bit, *answer == Answer::Visible);
        }
        assert_eq!(one.seen_counts[0], all.seen_counts[number]);
    }
    for (cell, &count) in all.counts.iter().enumerate() {
        assert_eq!(count, all.masks.iter().map(|band| band[cell].count_ones()).sum::<u32>());
        assert_eq!(all.answers[cell] == Answer::Visible, count > 0);
    }
    assert!(all.counts.iter().any(|&c| c > 5) && all.counts.contains(&0));
}

#[test]
fn cells_outside_the_limits_are_not_queried() {
    let scene = scene(&random_balls(50, 40.0), &BlockRule::carved());
    let targets = cell_targets(&plain(40.0, 1.0), 0.0);
    let all = looking([20.0, 20.0, 1.7]);
    let limits = SightLimits { azimuth: Some([0.0, 1.0]), distance: [5.0, 15.0], ..SightLimits::default() };
    let some = Observer { limits, ..all };
    let params = ViewshedParams::default();
    let [all, some] = [all, some].map(|o| viewshed(&scene, &[o], &targets, &params, &Control::none()).unwrap().answers);
    let inside = targets.iter().filter(|t| limits.allow([20.0, 20.0, 1.7], t.map(f64::from))).count();
    assert_eq!(some.iter().filter(|a| **a != Answer::OutsideView).count(), inside);
    assert!(inside > 20 && some.iter().zip(&all).all(|(s, a)| *s == Answer::OutsideView || s == a));
}

#[test]
fn parameters_out_of_range_are_refused_and_eyes_that_are_no_numbers_see_nothing() {
    let scene = scene(&random_balls(5, 10.0), &BlockRule::default());
    let run = |observer, params| viewshed(&scene, &[observer], &[[1.0; 3]], &params, &Control::none());
    // an observer that was skipped sees nothing
    assert_eq!(run(looking([f64::NAN; 3]), ViewshedParams::default()).unwrap().seen_counts, [0]);
    let earth = EarthParams { refraction: 2.0, ..EarthParams::default() };
    assert!(run(looking([0.0; 3]), ViewshedParams::default().with_earth(earth)).is_err());
    // a target without a height is no error, and nothing is said of it
    let targets = [[1.0, 1.0, f32::NAN]];
    let none = viewshed(&scene, &[looking([0.0; 3])], &targets, &ViewshedParams::default(), &Control::none());
    assert_eq!(none.unwrap().answers, [Answer::OutsideView]);
}
