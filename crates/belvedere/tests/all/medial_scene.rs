//! Exact lines of sight through a union of balls, against every ball tried in turn and against closed forms.

use belvedere::control::Control;
use belvedere::depth::Profile;
use belvedere::medial::{MedialBalls, NO_TOUCH};
use belvedere::query::{Answer, BlockRule, MedialScene, Viewer, Visibility};
use belvedere::random::uniform;
use belvedere::ray_index::{Ray, RayIndex};

fn balls(centers: Vec<[f32; 3]>, radii: Vec<f32>) -> MedialBalls {
    let count = radii.len();
    MedialBalls { centers, radii, source: vec![0; count], touch: vec![0; count], separation_angles: vec![1.0; count] }
}

fn params(profile: Profile, depth_bias: f64) -> BlockRule {
    BlockRule { profile, bias: depth_bias, shell: 0.0 }
}

/// A number in 0 to 1 that belongs to `index`.
fn at(seed: u64, index: u64) -> f32 {
    uniform(seed, index) as f32
}

fn random_points(seed: u64, count: u64, size: f32) -> Vec<[f32; 3]> {
    (0..count).map(|i| std::array::from_fn(|axis| size * at(seed, 3 * i + axis as u64))).collect()
}

fn random_balls(count: u64) -> MedialBalls {
    let radii = (0..count).map(|i| 0.05 + 4.0 * at(7, i).powi(3)).collect();
    balls(random_points(3, count, 100.0), radii)
}

/// The rule of the documentation, ball after ball: a piece of the line more than `bias` from either end lies in the
/// ball.
fn brute_force(balls: &MedialBalls, target: [f32; 3], eye: [f64; 3], bias: f64) -> bool {
    let target = target.map(f64::from);
    let d: Vec<f64> = (0..3).map(|i| eye[i] - target[i]).collect();
    let range = d.iter().map(|v| v * v).sum::<f64>().sqrt();
    balls.centers.iter().zip(&balls.radii).any(|(center, radius)| {
        // roots of |target + t·d/|d| − c|² = r²
        let c: Vec<f64> = (0..3).map(|i| f64::from(center[i]) - target[i]).collect();
        let b: f64 = (0..3).map(|i| c[i] * d[i] / range).sum();
        let q: f64 = c.iter().map(|v| v * v).sum::<f64>() - f64::from(*radius).powi(2);
        let discriminant = b * b - q;
        discriminant > 0.0 && b + discriminant.sqrt() > bias && b - discriminant.sqrt() < range - bias
    })
}

#[test]
fn answers_equal_those_of_every_ball_tried_in_turn() {
    let balls = random_balls(3000);
    let targets = random_points(11, 4000, 100.0);
    let eyes = random_points(12, 4000, 100.0);
    for bias in [0.0, 0.25] {
        let scene = MedialScene::new(&balls, &params(Profile::Sphere, bias)).unwrap();
        let pairs = scene.visible(Viewer::Each(&eyes), &targets).unwrap();
        let eye = [50.3, 48.0, 130.0];
        let from_eye = scene.visible(Viewer::Eye(eye), &targets).unwrap();
        let mut blocked = 0;
        for (i, &target) in targets.iter().enumerate() {
            let expected = brute_force(&balls, target, eyes[i].map(f64::from), bias);
            blocked += usize::from(expected);
            assert_eq!(pairs[i] == Answer::Blocked, expected, "pair {i}");
            assert_eq!(from_eye[i] == Answer::Blocked, brute_force(&balls, target, eye, bias), "target {i}");
        }
        assert!((400..3600).contains(&blocked), "both answers must occur: {blocked}");
    }
}

/// Applies the documented rule of [`BlockRule::shell`], ball after ball. A ball has radius r − (shell − max(d − r, 0))
/// if an end at distance d from its centre lies less than the shell from its surface; the smaller radius of two ends
/// counts.
fn brute_force_with_shell(balls: &MedialBalls, target: [f32; 3], eye: [f64; 3], bias: f64, shell: f64) -> bool {
    (0..balls.len()).any(|i| {
        let one = |radius: f64| {
            let mut one = balls.clone();
            one.centers = vec![balls.centers[i]];
            (one.radii = vec![radius as f32]);
            one
        };
        let radius = f64::from(balls.radii[i]);
        let shell = shell.min(radius / 2.0);
        let counts = [target.map(f64::from), eye].map(|end| {
            let square = |(a, b): (&f32, f64)| (f64::from(*a) - b).powi(2);
            let d = balls.centers[i].iter().zip(end).map(square).sum::<f64>().sqrt();
            if (d - radius).abs() < shell { radius - (shell - (d - radius).max(0.0)) } else { radius }
        });
        let counts = counts[0].min(counts[1]);
        counts > 0.0 && brute_force(&one(counts), target, eye, bias)
    })
}

#[test]
fn balls_give_way_to_targets_near_their_surface_by_the_written_rule() {
    // half of the targets lie within a shell of the surface of some ball, where the rule does something
    let balls = random_balls(150);
    let mut targets = random_points(51, 1500, 100.0);
    for (i, target) in targets.iter_mut().enumerate().step_by(2) {
        let (center, radius) = (balls.centers[i % 150], balls.radii[i % 150]);
        let away = random_points(52, 1500, 1.0)[i].map(|v| v - 0.5);
        let length = away.iter().map(|v| v * v).sum::<f32>().sqrt();
        let off = radius + 0.5 * (at(53, i as u64) - 0.5);
        *target = std::array::from_fn(|k| center[k] + away[k] / length * off);
    }
    let eyes = random_points(54, 1500, 100.0);
    for (bias, shell) in [(0.0, 0.2), (0.1, 0.25)] {
        let scene = MedialScene::new(&balls, &BlockRule { profile: Profile::Sphere, bias, shell }).unwrap();
        let bare = MedialScene::new(&balls, &params(Profile::Sphere, bias)).unwrap();
        let found = scene.visible(Viewer::Each(&eyes), &targets).unwrap();
        let without = bare.visible(Viewer::Each(&eyes), &targets).unwrap();
        let mut wrong = 0;
        for (i, &target) in targets.iter().enumerate() {
            let expected = brute_force_with_shell(&balls, target, eyes[i].map(f64::from), bias, shell);
            wrong += usize::from((found[i] == Answer::Blocked) != expected);
            // to give way reveals and never hides
            assert!(found[i] == Answer::Visible || without[i] == Answer::Blocked, "target {i}");
        }
        // a radius rounded to f32 decides where a line grazes a ball
        assert!(wrong <= 1, "{wrong}");
        let revealed = found.iter().zip(&without).filter(|(a, b)| a != b).count();
        assert!(revealed > 100, "the rule must matter: {revealed}");
    }
}

#[test]
fn a_shell_in_numbers() {
    // a ball of radius 1 and a shell of 0.2; lines of sight run past it at a height, from 0.1 or 0.3 m off its surface
    let one = balls(vec![[0.0; 3]], vec![1.0]);
    let scene = MedialScene::new(&one, &BlockRule { shell: 0.2, ..params(Profile::Sphere, 0.0) }).unwrap();
    let towards = |target: [f64; 3], height: f64| {
        let d = [-target[0], 0.0, height];
        let length = (d[0] * d[0] + height * height).sqrt();
        scene.answer(target, d.map(|v| v / length), f64::INFINITY)
    };
    let (blocked, visible) = (Answer::Blocked, Answer::Visible);
    // 0.1 outside: radius 0.9, so that a line that passes the centre at 0.95 is free and one at 0.85 is not. A line
    // from (1.1, 0, 0) at angle a passes at 1.1 sin a
    let at_angle = |x: f64, passes: f64| towards([x, 0.0, 0.0], x * (passes / x).asin().tan());
    assert_eq!([at_angle(1.1, 0.95), at_angle(1.1, 0.85)], [visible, blocked]);
    // 0.3 outside: the whole ball
    assert_eq!([at_angle(1.3, 0.95), at_angle(1.3, 1.05)], [blocked, visible]);
    // 0.1 inside: radius 0.8, out of which the target lies: looking out it is free, looking through it is not
    assert_eq!(scene.answer([0.9, 0.0, 0.0], [1.0, 0.0, 0.0], f64::INFINITY), visible);
    assert_eq!(scene.answer([0.9, 0.0, 0.0], [-1.0, 0.0, 0.0], f64::INFINITY), blocked);
    // 0.3 inside: blocked whichever way
    assert_eq!(scene.answer([0.7, 0.0, 0.0], [1.0, 0.0, 0.0], f64::INFINITY), blocked);
}

#[test]
fn a_direction_is_an_eye_very_far_away() {
    let balls = random_balls(2000);
    let targets = random_points(21, 5000, 100.0);
    let scene = MedialScene::new(&balls, &params(Profile::Sphere, 0.1)).unwrap();
    for direction in [[0.3, -0.5, 0.4], [0.0, 0.0, 1.0], [-1.0, -0.0, 0.0]] {
        let far = scene.visible(Viewer::Eye(direction.map(|v: f64| 50.0 + 1e9 * v)), &targets).unwrap();
        let parallel = scene.visible(Viewer::Direction(direction), &targets).unwrap();
        // lines that differ by 1e-7 rad part at edges of balls only
        let differ = far.iter().zip(&parallel).filter(|(a, b)| a != b).count();
        assert!(differ <= 1, "{differ} of {} differ along {direction:?}", targets.len());
        assert!(parallel.contains(&Answer::Blocked) && parallel.contains(&Answer::Visible));
    }
}

#[test]
fn the_cone_hides_less_than_the_sphere_by_the_depth_between_them() {
    // ball of radius 2 at the origin, seen from above; at 1 m beside the axis the sphere's top is at √3, the cone's at
    // 1
    let one = balls(vec![[0.0; 3]], vec![2.0]);
    let sphere = MedialScene::new(&one, &params(Profile::Sphere, 0.0)).unwrap();
    let cone = MedialScene::new(&one, &params(Profile::PaperCone, 0.0)).unwrap();
    let up = Viewer::Direction([0.0, 0.0, 1.0]);
    let targets = [[1.0, 0.0, 0.99], [1.0, 0.0, 1.01], [1.0, 0.0, 1.73], [1.0, 0.0, 1.74], [2.01, 0.0, -5.0]];
    let (blocked, visible) = (Answer::Blocked, Answer::Visible);
    assert_eq!(sphere.visible(up, &targets).unwrap(), [blocked, blocked, blocked, visible, visible]);
    assert_eq!(cone.visible(up, &targets).unwrap(), [blocked, visible, visible, visible, visible]);
}

#[test]
fn balls_that_hold_the_viewer_hide_all_and_those_behind_it_or_that_never_shrank_nothing() {
    let mut three = balls(vec![[0.0; 3], [20.0, 0.0, 0.0], [10.0, 0.0, 0.0]], vec![2.0, 3.0, 1.0]);
    three.touch[2] = NO_TOUCH;
    let scene = MedialScene::new(&three, &params(Profile::Sphere, 0.0)).unwrap();
    let target = [[5.0, 0.0, 0.0]];
    for (eye, expected) in [
        ([1.0, 0.0, 0.0], Answer::Blocked), // within the first ball: from there nothing is seen
        ([3.0, 0.0, 0.0], Answer::Visible), // before the first ball, with its back to it
        ([15.0, 0.0, 0.0], Answer::Visible), // beyond the one that never shrank
        ([-3.0, 0.0, 0.0], Answer::Blocked), // beyond the first ball
        ([5.0, 0.0, 0.0], Answer::OutsideView),
    ] {
        let mut answers = scene.visible(Viewer::Eye(eye), &target).unwrap();
        assert_eq!(answers, [expected], "eye at {eye:?}");
        // those who want to know why have it marked
        scene.mark_inside_obstacles(Viewer::Eye(eye), &target, &mut answers, &Control::none()).unwrap();
        let is_inside = eye == [1.0, 0.0, 0.0];
        assert_eq!(answers, [if is_inside { Answer::InsideObstacle } else { expected }], "eye at {eye:?}");
    }
}

#[test]
fn answers_are_the_same_for_any_number_of_threads() {
    let (balls, targets) = (random_balls(2000), random_points(31, 20_000, 100.0));
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let scene = MedialScene::new(&balls, &params(Profile::Sphere, 0.1)).unwrap();
            scene.visible(Viewer::Direction([0.4, 0.3, 0.5]), &targets).unwrap()
        })
    };
    let one = run(1);
    assert!(one.contains(&Answer::Blocked) && one.contains(&Answer::Visible));
    assert!(one == run(2) && one == run(7));
}

#[test]
fn what_cannot_be_looked_at_is_said() {
    let scene = MedialScene::new(&random_balls(10), &params(Profile::Sphere, 0.0)).unwrap();
    let targets = [[f32::NAN, 0.0, 0.0], [1.0, 2.0, 3.0]];
    let answers = scene.visible(Viewer::Direction([0.0, 0.0, 1.0]), &targets).unwrap();
    assert_eq!(answers[0], Answer::OutsideView);
    assert!(scene.visible(Viewer::Direction([0.0; 3]), &targets).is_err());
    assert!(scene.visible(Viewer::Eye([f64::NAN, 0.0, 0.0]), &targets).is_err());
    assert!(scene.visible(Viewer::Each(&targets[..1]), &targets).is_err());
    let empty = MedialScene::new(&MedialBalls::default(), &params(Profile::Sphere, 0.0)).unwrap();
    assert_eq!(empty.visible(Viewer::Eye([0.0; 3]), &targets[1..]).unwrap(), [Answer::Visible]);
}

#[test]
fn the_index_proposes_every_box_that_a_ray_meets() {
    let low = random_points(41, 3000, 50.0);
    let boxes: Vec<[[f32; 3]; 2]> =
        low.iter().zip(random_points(42, 3000, 2.0)).map(|(&l, s)| [l, std::array::from_fn(|i| l[i] + s[i])]).collect();
    let index = RayIndex::new(&boxes).unwrap();
    let starts = random_points(43, 300, 60.0);
    let ends = random_points(44, 300, 60.0);
    for (i, (start, end)) in starts.iter().zip(&ends).enumerate() {
        let (start, end) = (start.map(f64::from), end.map(f64::from));
        let mut direction: [f64; 3] = std::array::from_fn(|i| end[i] - start[i]);
        if i % 3 == 0 {
            // along an axis, where slabs divide by zero
            direction = [-0.0, 0.0, if i % 2 == 0 { -1.0 } else { 1.0 }];
        }
        let ray = Ray::new(start, direction, [0.0, 30.0]).unwrap();
        let range = |corners: &[[f32; 3]; 2]| {
            let (mut from, mut to) = (0.0, 30.0);
            for ((corners, origin), direction) in
                (0..3).map(|i| [corners[0][i], corners[1][i]]).zip(ray.origin).zip(ray.direction)
            {
                let [low, high] = corners.map(|v| f64::from(v) - origin);
                if direction == 0.0 {
                    if low > 0.0 || high < 0.0 {
                        return None;
                    }
                } else {
                    let (a, b) = (low / direction, high / direction);
                    from = f64::max(from, a.min(b));
                    to = f64::min(to, a.max(b));
                }
            }
            (from <= to).then_some(from)
        };
        let expected: Vec<usize> = (0..boxes.len()).filter(|&b| range(&boxes[b]).is_some()).collect();
        let mut proposed = Vec::new();
        index.each(&ray, |row| proposed.push(index.order()[row] as usize));
        assert!(expected.iter().all(|b| proposed.contains(b)), "ray {i}");
        assert_eq!(index.any(&ray, |row| range(&boxes[index.order()[row] as usize]).is_some()), !expected.is_empty());
        let nearest = index.nearest(&ray, |row| range(&boxes[index.order()[row] as usize])).map(|(_, r)| r);
        let min = expected.iter().filter_map(|&b| range(&boxes[b])).reduce(f64::min);
        assert_eq!(nearest, min, "ray {i}");
    }
}
