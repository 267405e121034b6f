//! Routes and windows against closed forms.

use belvedere::apps::exposure::{plane_normal, route_lengths, shaded_shares, sky_component, window_places};
use belvedere::apps::sky_view::SkyDirections;
use belvedere::control::Control;
use belvedere::medial::MedialBalls;
use belvedere::query::{BlockRule, MedialScene, VisibilityMatrix};
use std::f64::consts::{FRAC_PI_2, PI};

fn scene(center: [f32; 3], radius: f32) -> MedialScene {
    let balls = MedialBalls {
        centers: vec![center],
        radii: vec![radius],
        source: vec![0],
        touch: vec![0],
        separation_angles: vec![3.0],
    };
    MedialScene::new(&balls, &BlockRule::uncarved()).unwrap()
}

fn matrix(scene: &MedialScene, targets: &[[f32; 3]], directions: &[[f64; 3]]) -> VisibilityMatrix {
    scene.visibility_matrix(targets, directions, &Control::none()).unwrap()
}

/// A ball far below, which hides nothing.
fn nothing() -> MedialScene {
    scene([0.0, 0.0, -1e4], 1.0)
}

fn normal(azimuth_deg: f64, tilt_deg: f64) -> [f32; 3] {
    plane_normal(azimuth_deg.to_radians(), tilt_deg.to_radians()).map(|v| v as f32)
}

#[test]
fn free_planes_have_the_sky_components_of_the_overcast_sky() {
    let sky = SkyDirections::patches(4).unwrap();
    let normals = [normal(0.0, 0.0), normal(90.0, 90.0), normal(217.0, 90.0), normal(40.0, 180.0)];
    let seen = matrix(&nothing(), &[[0.0; 3]; 4], &sky.directions);
    let found = sky_component(&seen, &sky, &normals).unwrap();
    // a wall: (1/3)(π/2 + 4/3) of the zenith's luminance, a level plane 7π/9 (integrals in closed form): 39.6 %, as BRE
    // 209 has it
    let wall = (PI / 2.0 + 4.0 / 3.0) / 3.0 / (7.0 * PI / 9.0);
    assert!((wall - 0.396).abs() < 5e-4);
    // 2305 patches, each taken at its middle
    for (found, expected) in found.iter().zip([1.0, wall, wall, 0.0]) {
        assert!((f64::from(*found) - expected).abs() < 1e-3, "{found} {expected}");
    }
}

#[test]
fn a_wall_that_faces_a_long_obstruction_keeps_what_the_formula_leaves() {
    // an endless building parallel to the wall, 25° high straight ahead and lower to the sides: at the azimuth φ from
    // straight ahead the sky begins at θ = atan(tan 25° cos φ), and what is above gives (1/3)(½(π/2 − θ − sin θ cos
    // θ) + ⅔ cos³ θ) cos φ dφ
    let sky = SkyDirections::patches(6).unwrap();
    let slope = 25f64.to_radians().tan();
    let open: Vec<usize> =
        (0..sky.directions.len()).filter(|&i| sky.directions[i][2] > -slope * sky.directions[i][1]).collect();
    let part = SkyDirections {
        directions: open.iter().map(|&i| sky.directions[i]).collect(),
        solid_angles: open.iter().map(|&i| sky.solid_angles[i]).collect(),
    };
    let seen = matrix(&nothing(), &[[0.0; 3]], &part.directions);
    let found = f64::from(sky_component(&seen, &part, &[normal(180.0, 90.0)]).unwrap()[0]);
    let steps = 10_000;
    let at = |i: i32| {
        let azimuth = PI * (f64::from(i) + 0.5) / f64::from(steps) - FRAC_PI_2;
        let horizon = (slope * azimuth.cos()).atan();
        let level = 0.5 * (FRAC_PI_2 - horizon - horizon.sin() * horizon.cos());
        (level + 2.0 / 3.0 * horizon.cos().powi(3)) / 3.0 * azimuth.cos() * PI / f64::from(steps)
    };
    let expected = (0..steps).map(at).sum::<f64>() / (7.0 * PI / 9.0);
    // the figure that BRE 209 gives for 25°
    assert!((expected - 0.27).abs() < 0.005, "{expected}");
    // patches are 2° high and wide and counted by their middles
    assert!((found - expected).abs() < 0.004, "{found} {expected}");
}

#[test]
fn a_wall_before_a_ball_loses_the_component_behind_it() {
    let sky = SkyDirections::even(20_000).unwrap();
    // 10° wide at 30° up, straight ahead to the east
    let (distance, up) = (50.0, 30f64.to_radians());
    let radius = distance * 5f64.to_radians().sin();
    let ball = scene([(distance * up.cos()) as f32, 0.0, (distance * up.sin()) as f32], radius as f32);
    let free =
        sky_component(&matrix(&nothing(), &[[0.0; 3]], &sky.directions), &sky, &[normal(90.0, 90.0)]).unwrap()[0];
    let less = sky_component(&matrix(&ball, &[[0.0; 3]], &sky.directions), &sky, &[normal(90.0, 90.0)]).unwrap()[0];
    // the cosine over a disc averages to that of its middle times (1 + cos r)/2 per solid angle, the luminance likewise
    // to second order
    let solid_angle = 2.0 * PI * (1.0 - 5f64.to_radians().cos());
    let expected = solid_angle * up.cos() * (1.0 + 2.0 * up.sin()) / 3.0 / (7.0 * PI / 9.0);
    // some 76 of 20 000 directions: one more or less is 1.3 %, and the average is good to 1 %
    assert!((f64::from(free - less) / expected - 1.0).abs() < 0.04, "{} {expected}", free - less);
}

#[test]
fn targets_of_windows_lie_before_their_panes() {
    let [east] = &window_places([1.0, 2.0, 3.0], [1.0, 0.0, 0.0], None).unwrap()[..] else { panic!("one place") };
    assert_eq!(*east, [1.1, 2.0, 3.0]);
    let nine = window_places([0.0; 3], plane_normal(PI, FRAC_PI_2), Some([3.0, 1.5])).unwrap();
    let mean: [f64; 3] = std::array::from_fn(|i| nine.iter().map(|p| p[i]).sum::<f64>() / 9.0);
    assert!(mean[0].abs() < 1e-12 && (mean[1] + 0.1).abs() < 1e-12 && mean[2].abs() < 1e-12);
    let spread = |i: usize| nine.iter().map(|p| p[i]).fold(f64::NEG_INFINITY, f64::max);
    assert!((spread(0) - 1.0).abs() < 1e-12 && (spread(2) - 0.5).abs() < 1e-12, "{nine:?}");
    assert_eq!(window_places([0.0; 3], [0.0, 0.0, 1.0], Some([1.0, 1.0])).unwrap().len(), 9);
    assert!(window_places([f64::NAN; 3], [1.0, 0.0, 0.0], None).is_err());
    assert!(window_places([0.0; 3], [0.0; 3], None).is_err());
    assert!(window_places([0.0; 3], [1.0, 0.0, 0.0], Some([-1.0, 1.0])).is_err());
}

#[test]
fn routes_are_in_shade_by_length() {
    let places = [[0.0, 0.0, 1.0], [4.0, 0.0, 1.0], [4.0, 6.0, 9.0]];
    assert_eq!(route_lengths(&places), [2.0, 5.0, 3.0]);
    assert_eq!(route_lengths(&places[..1]), [1.0]);
    assert!(route_lengths(&[]).is_empty());
    // a ball over the middle place hides the zenith from it, and nothing from the others
    let ball = scene([4.0, 0.0, 20.0], 1.0);
    let targets = places.map(|p| [p[0] as f32, p[1] as f32, p[2] as f32]);
    let seen = matrix(&ball, &targets, &[[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]);
    assert_eq!(shaded_shares(&seen, &route_lengths(&places)).unwrap(), [0.5, 0.0]);
    assert!(shaded_shares(&seen, &[1.0]).is_err());
    assert!(shaded_shares(&seen, &[0.0; 3]).unwrap()[0].is_nan());
    let sky = SkyDirections::even(2).unwrap();
    assert!(sky_component(&seen, &sky, &[[0.0, 0.0, 1.0]; 2]).is_err());
}
