//! Many targets at once give the answers of single lines of sight.

use belvedere::Error;
use belvedere::control::Control;
use belvedere::depth::Profile;
use belvedere::medial::MedialBalls;
use belvedere::query::target_tree::TargetTree;
use belvedere::query::{Answer, BlockRule, MedialScene, Viewer, Visibility};
use belvedere::random::uniform;

fn add(balls: &mut MedialBalls, center: [f32; 3], radius: f32) {
    balls.centers.push(center);
    balls.radii.push(radius);
    balls.source.push(0);
    balls.touch.push(0);
    balls.separation_angles.push(1.0);
}

/// Balls on rolling ground and in blocks above it, as crowded as in a town.
fn town(seed: u64, count: usize, shift: f32) -> MedialBalls {
    let mut balls = MedialBalls::default();
    for i in 0..count {
        let random = |k: u64| uniform(seed, 8 * i as u64 + k) as f32;
        let (x, y) = (100.0 * random(0), 100.0 * random(1));
        let ground = (0.1 * x).sin() + (0.07 * y).cos();
        let (center, radius) = match i % 4 {
            0 | 1 => ([x, y, ground - 2.0], 2.0),
            2 => ([(x / 25.0).floor() * 25.0 + 12.0 * random(2), y, ground + 8.0 * random(3)], 0.5 + 3.0 * random(4)),
            _ => ([x, y, ground + 10.0 * random(3)], 0.1 + 0.2 * random(4)),
        };
        add(&mut balls, center.map(|v| v + shift), radius);
    }
    balls
}

/// Targets on the ground, above it, and some twice.
fn targets(seed: u64, count: usize, shift: f32) -> Vec<[f32; 3]> {
    (0..count)
        .map(|i| {
            let i = if i % 50 == 0 { i / 2 } else { i };
            let random = |k: u64| uniform(seed + 1, 3 * i as u64 + k) as f32;
            let (x, y) = (110.0 * random(0) - 5.0, 110.0 * random(1) - 5.0);
            let height = if i % 3 == 0 { 0.0 } else { 12.0 * random(2) };
            [x, y, (0.1 * x).sin() + (0.07 * y).cos() + height].map(|v| v + shift)
        })
        .collect()
}

fn viewers(targets: &[[f32; 3]], shift: f64) -> Vec<Viewer<'static>> {
    let eye = |eye: [f64; 3]| Viewer::Eye(eye.map(|v| v + shift));
    vec![
        // between the blocks, over the ground
        eye([43.5, 50.0, 1.7]),
        eye([18.0, 70.0, 3.0]),
        // underground, in a ball: inside an obstacle
        eye([60.0, 30.0, -3.0]),
        // far off, and at a target
        eye([-4000.0, 900.0, 300.0]),
        Viewer::Eye(targets[123].map(f64::from)),
        Viewer::Direction([0.3, -0.5, 0.2]),
        Viewer::Direction([0.0, 0.0, 1.0]),
        Viewer::Direction([-1.0, 0.0, 0.0]),
        Viewer::Direction([0.0, 0.2, -1.0]),
    ]
}

#[test]
fn many_at_once_are_answered_as_one_by_one() {
    let kinds = [
        BlockRule::default(),
        BlockRule::carved(),
        BlockRule { bias: 0.4, ..BlockRule::carved() },
        BlockRule { bias: -0.6, ..BlockRule::carved() },
        BlockRule { profile: Profile::PaperCone, ..BlockRule::default() },
    ];
    // 20 km from the origin f32 steps by 2 mm, and beams must still not miss a ball
    for shift in [0.0, 20_000.0] {
        let targets = targets(5, 6000, shift);
        let tree = TargetTree::new(&targets);
        for params in kinds {
            let scene = MedialScene::new(&town(3, 8000, shift), &params).unwrap();
            for viewer in viewers(&targets, f64::from(shift)) {
                let single = scene.visible(viewer, &targets).unwrap();
                let among = scene.answer_among(viewer, &tree, &Control::none()).unwrap();
                let differing = single.iter().zip(&among).filter(|(a, b)| a != b).count();
                assert_eq!(differing, 0, "{params:?} {viewer:?}");
                let visible = single.iter().filter(|&&answer| answer == Answer::Visible).count();
                let mut visited = Vec::new();
                scene.visible_among(viewer, &tree, &Control::none(), |place| visited.push(tree.rows()[place])).unwrap();
                let at_viewer = single.iter().filter(|&&answer| answer == Answer::OutsideView).count();
                assert_eq!(visited.len(), visible + at_viewer);
                assert!(visited.iter().all(|&row| single[row as usize] != Answer::Blocked));
            }
        }
    }
}

#[test]
fn the_scene_of_these_tests_has_targets_of_either_kind() {
    let targets = targets(5, 6000, 0.0);
    let scene = MedialScene::new(&town(3, 8000, 0.0), &BlockRule::carved()).unwrap();
    let answers = scene.answer_among(viewers(&targets, 0.0)[0], &TargetTree::new(&targets), &Control::none()).unwrap();
    let visible = answers.iter().filter(|&&answer| answer == Answer::Visible).count();
    assert!((100..5900).contains(&visible), "{visible} of 6000 visible");
    let is_inside = |viewer: &Viewer<'_>| matches!(viewer, Viewer::Eye(eye) if scene.is_inside_obstacle(*eye));
    let inside: Vec<usize> = (0..9).filter(|&number| is_inside(&viewers(&targets, 0.0)[number])).collect();
    assert_eq!(inside, [2], "one eye is inside an obstacle, and the others are not");
}

#[test]
fn what_is_not_finite_is_outside_and_nothing_is_no_error() {
    let scene = MedialScene::new(&town(3, 500, 0.0), &BlockRule::carved()).unwrap();
    let eye = Viewer::Eye([50.0, 50.0, 20.0]);
    let odd = [[f32::NAN, 0.0, 0.0], [50.0, 50.0, 19.0], [0.0, f32::INFINITY, 0.0]];
    let answers = scene.answer_among(eye, &TargetTree::new(&odd), &Control::none()).unwrap();
    assert_eq!(answers, [Answer::OutsideView, Answer::Visible, Answer::OutsideView]);
    assert!(scene.answer_among(eye, &TargetTree::new(&[]), &Control::none()).unwrap().is_empty());
    let nothing = MedialScene::new(&MedialBalls::default(), &BlockRule::carved()).unwrap();
    assert_eq!(nothing.answer_among(eye, &TargetTree::new(&odd[1..2]), &Control::none()).unwrap(), [Answer::Visible]);
    let eyes = [[0.0_f32; 3]];
    let refused = scene.answer_among(Viewer::Each(&eyes), &TargetTree::new(&odd[1..2]), &Control::none());
    assert!(matches!(refused, Err(Error::UnsupportedViewer { .. })));
    let refused = scene.answer_among(Viewer::Eye([f64::NAN; 3]), &TargetTree::new(&odd), &Control::none());
    assert!(matches!(refused, Err(Error::InvalidParameter { .. })));
}

#[test]
fn a_wall_of_one_ball_hides_what_the_closed_form_says() {
    // from (0, 0, 0) a ball of radius 1 at 10 m east hides the cone within asin(1/10), from its tangent on
    let mut ball = MedialBalls::default();
    add(&mut ball, [10.0, 0.0, 0.0], 1.0);
    let scene = MedialScene::new(&ball, &BlockRule::default()).unwrap();
    let targets: Vec<[f32; 3]> =
        (0..4000).map(|i| [5.0 + (i % 80) as f32 * 0.5, (i / 80) as f32 * 0.125 - 3.0, 0.25]).collect();
    let answers = scene.answer_among(Viewer::Eye([0.0; 3]), &TargetTree::new(&targets), &Control::none()).unwrap();
    let mut hidden = 0;
    for (target, answer) in targets.iter().zip(answers) {
        let [x, y, z] = target.map(f64::from);
        let distance = (x * x + y * y + z * z).sqrt();
        let is_inside = (x - 10.0).powi(2) + y * y + z * z < 1.0;
        let in_cone = x / distance > (1.0_f64 - 0.01).sqrt();
        let is_hidden = is_inside || (in_cone && distance > 99.0_f64.sqrt());
        hidden += usize::from(is_hidden);
        assert_eq!(answer == Answer::Blocked, is_hidden, "{target:?}");
    }
    assert!(hidden > 500);
}
