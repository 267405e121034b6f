//! Views of a scene of balls and targets at their surfaces, and requirements on bounds of depth and answers by them,
//! for the CPU and a device.

use belvedere::blocking::Ball;
use belvedere::control::Control;
use belvedere::depth::DepthBounds;
use belvedere::medial::MedialBalls;
use belvedere::query::certified::CertifiedMap;
use belvedere::query::{Answer, MedialScene, Scope, Viewer, Visibility, random_targets};
use belvedere::random::uniform;
use belvedere::view::View;

/// Balls of all sizes below 3 m in a box of 60 m, some of them alike.
pub(crate) fn balls(count: u64, seed: u64) -> MedialBalls {
    let u = |i: u64| uniform(seed, i) as f32;
    let centers = (0..count).map(|i| [60.0 * u(4 * i), 60.0 * u(4 * i + 1), 30.0 * u(4 * i + 2)]).collect();
    let radii = (0..count).map(|i| 0.02 * 150f32.powf(u(4 * i + 3))).collect::<Vec<f32>>();
    let n = radii.len();
    MedialBalls { centers, radii, source: vec![0; n], touch: vec![0; n], separation_angles: vec![1.0; n] }
}

/// The same with some around the eye, one of which has it on its surface as nearly as f32 can tell. Two hold it 0.1 m
/// deep: without a shell it is inside an obstacle, with one of [`RULES`] they give way to it.
pub(crate) fn balls_at_eye() -> MedialBalls {
    let mut balls = balls(3000, 1);
    balls.centers[..3].copy_from_slice(&[[31.0, 28.0, 12.2], [30.0, 27.5, 11.0], [31.0, 28.0, 11.5]]);
    balls.radii[..3].copy_from_slice(&[0.3, 1.6, 0.5]);
    balls
}

/// Biases and shells, metres.
pub(crate) const RULES: [(f64, f64); 4] = [(0.0, 0.0), (0.0, 0.2), (0.1, 0.25), (-0.1, 0.3)];

pub(crate) const EYE: [f64; 3] = [31.0, 28.0, 12.0];

/// One view of each projection, and a whole sphere.
pub(crate) fn views() -> Vec<(&'static str, Vec<View>)> {
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
pub(crate) fn targets(balls: &MedialBalls, count: usize) -> Vec<[f32; 3]> {
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

pub(crate) fn as_list(balls: &MedialBalls) -> Vec<Ball> {
    balls.centers.iter().zip(&balls.radii).map(|(&center, &radius)| Ball { center, radius }).collect()
}

/// Returns the end of lines of sight in a view of [`views`], metres.
pub(crate) fn start_of(name: &str) -> f64 {
    if name == "camera with a near limit" { 3.0 } else { 0.0 }
}

/// Checks bounds at 1500 places, corners of pixels among them. Says at how many of them there is an upper bound.
pub(crate) fn assert_bounds_hold(balls: &[Ball], bounds: &DepthBounds, start: f64, what: &str) -> usize {
    let mut within_upper = 0;
    let view = &bounds.view;
    for i in 0..1500u64 {
        let [width, height] = view.size_px.map(|v| v as f64);
        let (x, y) = (uniform(9, 2 * i) * width, uniform(9, 2 * i + 1) * height);
        let place = if i % 3 == 0 { [x.floor() + 1e-9, y.floor() + 1.0 - 1e-9] } else { [x, y] };
        let [column, row] = place.map(|v| v as usize);
        let [mut min, max] = bounds.bounds.get(column, row).unwrap().map(f64::from);
        if start == 0.0 {
            min = min.max(0.0);
        }
        let front = first_front(balls, view, place, start);
        assert!(min <= front && front <= max, "{what}: {front} not in {min}..{max}");
        within_upper += usize::from(max.is_finite());
    }
    within_upper
}

/// Checks that answers by bounds are those of exact lines of sight, all that the viewer may ask and those within a
/// picture. Says which share of the former the bounds settle.
pub(crate) fn assert_answers_are_exact(scene: &MedialScene, views: &[View], targets: &[[f32; 3]], what: &str) -> f64 {
    let viewer = match views[0].is_central() {
        true => Viewer::Eye(views[0].frame.eye),
        false => Viewer::Direction(views[0].frame.forward.map(|v| -v)),
    };
    let certified = |scope| {
        let map = CertifiedMap::new(scene, views, scope, &Control::none()).unwrap();
        map.answers(targets, &Control::none()).unwrap()
    };
    let (answers, report) = certified(Scope::Viewer);
    let exact = scene.visible(viewer, targets).unwrap();
    let differ = answers.iter().zip(&exact).filter(|(answer, exact)| answer != exact).count();
    assert_eq!(differ, 0, "{what}");
    assert_eq!(report.target_count, targets.len());
    // from inside an obstacle nothing is seen
    let is_inside = matches!(viewer, Viewer::Eye(eye) if scene.is_inside_obstacle(eye));
    assert!(exact.contains(&Answer::Blocked) && exact.contains(&Answer::Visible) != is_inside, "{what}");
    if let [view] = views {
        let (answers, _) = certified(Scope::View);
        assert!(answers == scene.query_view(view, targets, &Control::none()).unwrap(), "{what} within the view");
        assert!(answers.contains(&Answer::OutsideView), "{what}");
    }
    report.settled_count as f64 / targets.len() as f64
}
