//! Isovists against closed forms, and of balls against what follows from their geometry.

use belvedere::apps::isovist::{Isovist, IsovistParams, isovist, isovist_of};
use belvedere::control::Control;
use belvedere::medial::MedialBalls;
use belvedere::query::{BlockRule, MedialScene};
use std::f64::consts::{PI, TAU};

/// Range along a unit vector to the walls of a box from `low` to `high` about the eye.
fn walls(low: [f64; 3], high: [f64; 3]) -> impl Fn([f64; 3]) -> Option<f64> + Sync {
    move |d: [f64; 3]| {
        let to = |i: usize| if d[i] > 0.0 { high[i] / d[i] } else { low[i] / d[i] };
        Some((0..3).filter(|&i| d[i] != 0.0).map(to).fold(f64::INFINITY, f64::min))
    }
}

fn seen(range: impl Fn([f64; 3]) -> Option<f64> + Sync, max_range: f64) -> Isovist {
    isovist_of(&range, &IsovistParams::default().with_max_range(max_range), &Control::none()).unwrap()
}

fn near(found: f64, expected: f64, share: f64) {
    assert!((found - expected).abs() <= share * expected.abs().max(1e-9), "{found}, expected {expected}");
}

fn scene(list: &[([f32; 3], f32)]) -> MedialScene {
    let balls = MedialBalls {
        centers: list.iter().map(|b| b.0).collect(),
        radii: list.iter().map(|b| b.1).collect(),
        source: vec![0; list.len()],
        touch: vec![0; list.len()],
        separation_angles: vec![1.0; list.len()],
    };
    MedialScene::new(&balls, &BlockRule::default()).unwrap()
}

#[test]
fn in_a_sphere_every_measure_is_that_of_the_sphere() {
    let found = seen(|_| Some(7.0), 100.0);
    // solid angles of cells are exact, so that only rounding is left
    near(found.volume, 4.0 / 3.0 * PI * 343.0, 1e-9);
    near(found.ranges.mean, 7.0, 1e-12);
    assert!(found.ranges.variance < 1e-12 && found.ranges.skewness == 0.0);
    assert_eq!((found.openness, found.sky_openness, found.plan.occlusivity), (0.0, 0.0, 0.0));
    // a polygon of 1440 corners in a circle lacks 3e-6 of its area and 1e-6 of its length
    near(found.plan.area, PI * 49.0, 1e-5);
    near(found.plan.perimeter, TAU * 7.0, 1e-5);
    near(found.plan.compactness(), 1.0, 1e-5);
    assert!(found.drift.iter().all(|v| v.abs() < 1e-9) && found.plan.drift_length() < 1e-9);
}

#[test]
fn in_a_box_room_volume_area_perimeter_and_drift_are_those_of_the_room() {
    // 8 x 6 x 3 m, the eye 1 m east of the middle, 0.5 m north, 0.1 m up
    let found = seen(walls([-5.0, -3.5, -1.6], [3.0, 2.5, 1.4]), 100.0);
    // rays a degree apart: corners of the room are cut by what 1° is at 6 m, 0.1 m
    near(found.volume, 144.0, 2e-3);
    assert_eq!(found.blocked_volume, found.volume);
    for (found, expected) in found.drift.into_iter().zip([-1.0, -0.5, -0.1]) {
        assert!((found - expected).abs() < 0.01, "{found} {expected}");
    }
    near(found.plan.area, 48.0, 1e-3);
    near(found.plan.perimeter, 28.0, 1e-3);
    // f64 of a room of metres
    assert!((found.plan.drift[0] + 1.0).abs() < 2e-3 && (found.plan.drift[1] + 0.5).abs() < 2e-3);
    assert_eq!((found.plan.occlusivity, found.openness), (0.0, 0.0));
    near(found.ranges.greatest, (25.0f64 + 12.25 + 2.56).sqrt(), 0.01);
    near(found.ranges.min, 1.4, 1e-3);
}

#[test]
fn a_gap_in_the_wall_of_a_room_is_unbounded_and_adds_nothing_to_its_volume() {
    let room = walls([-4.0, -3.0, -1.5], [4.0, 3.0, 1.5]);
    // a slit in the north wall, from floor to ceiling, through which the rays of two columns of the panorama pass
    let slit = 0.6f64.to_radians();
    let with_gap = |d: [f64; 3]| {
        let is_through = d[1] > 0.0 && (d[0] / d[1]).abs() < slit && (d[2] * 3.0 / d[1]).abs() < 1.5;
        if is_through { None } else { room(d) }
    };
    let found = seen(with_gap, 100.0);
    // 2° wide and 53° high: 0.03 sr, whose rays would end at 100 m instead of 3 m
    near(found.volume, 144.0, 7e-3);
    near(found.unbounded, 0.03 / (4.0 * PI), 0.2);
    // what is missing is the slit alone: 2 of 360 degrees, in which the room is 3 m deep
    near(found.blocked_volume, 144.0, 7e-3);
}

#[test]
fn a_corridor_ends_at_the_greatest_range_and_hides_nothing() {
    // 2 m wide, without end, under the open sky
    let wall = |d: [f64; 3]| (d[0] != 0.0).then(|| 1.0 / d[0].abs());
    let found = seen(wall, 50.0);
    // two halves of a disc of 50 m cut off at ±1 m
    let area = 2.0 * ((2500.0f64 - 1.0).sqrt() + 2500.0 * (0.02f64).asin());
    near(found.plan.area, area, 2e-3);
    // seen at a slant its walls jump by metres from ray to ray, but hide nothing
    assert_eq!(found.plan.occlusivity, 0.0);
    // azimuths open: those within asin(1 / 50) of the axis, both ways; rays a quarter of a degree apart
    near(found.plan.openness, 4.0 * (0.02f64).asin() / TAU, 0.1);
    // open directions: nearer than asin(1 / 50) to the plane along the corridor, a belt of the sphere 2.3° wide that
    // cells of a degree tell to a tenth
    near(found.openness, 0.02, 0.1);
    near(found.sky_openness, 0.02, 0.1);
    assert!(found.ranges.skewness > 1.0, "{:?}", found.ranges);
}

#[test]
fn a_screen_before_a_wall_makes_two_jumps_of_known_length() {
    // a round wall at 20 m, and north of the eye a screen at 5 m that is 2 m wide
    let half = 0.2f64.atan();
    let range = move |d: [f64; 3]| {
        let azimuth = d[0].atan2(d[1]);
        Some(if azimuth.abs() < half { 5.0 / (azimuth.cos() * d[0].hypot(d[1])) } else { 20.0 / d[0].hypot(d[1]) })
    };
    let found = seen(range, 1000.0);
    // each end of the screen lies at 5 / cos: the jump from there to 20 m, found to a thousandth of a quarter degree
    near(found.plan.occlusivity, 2.0 * (20.0 - 5.0 / half.cos()), 1e-4);
    near(found.plan.area, PI * 400.0 - half * 400.0 + 5.0, 1e-4);
}

#[test]
fn a_ball_takes_its_cap_from_the_openness_and_its_cone_from_the_volume() {
    let (distance, radius, reach): (f64, f64, f64) = (10.0, 4.0, 30.0);
    let scene = scene(&[([0.0, 10.0, 0.0], 4.0)]);
    let params = IsovistParams::default().with_step(0.25f64.to_radians()).with_max_range(reach);
    let found = isovist(&scene, [0.0; 3], &params, &Control::none()).unwrap();
    let half = (radius / distance).asin();
    let cap = (1.0 - half.cos()) / 2.0;
    // cells of a quarter degree along an outline of 24°: a few thousandths
    near(1.0 - found.openness, cap, 5e-3);
    near(1.0 - found.sky_openness, cap, 5e-3);
    // range to the ball at an angle a: d cos a − √(r² − d² sin² a); volume by the midpoint rule over 20 000 rings
    let ring = half / 20_000.0;
    let in_cone: f64 = (0..20_000)
        .map(|i| {
            let a = (f64::from(i) + 0.5) * ring;
            let range = distance * a.cos() - (radius.powi(2) - (distance * a.sin()).powi(2)).max(0.0).sqrt();
            TAU * a.sin() * ring * range.powi(3) / 3.0
        })
        .sum();
    near(found.volume, (1.0 - cap) * 4.0 * PI / 3.0 * reach.powi(3) + in_cone, 1e-3);
    // rings of a quarter degree over a cone of 24°
    near(found.blocked_volume, in_cone, 0.02);
    near(found.ranges.min, 6.0, 1e-4);
    // the tangent is 9.165 m long: two edges hide what lies behind, up to the greatest range
    near(found.plan.occlusivity, 2.0 * (reach - (distance * distance - radius * radius).sqrt()), 0.01);
    assert!(found.plan.drift[1] < -0.1 && found.plan.drift[0].abs() < 1e-6);
    // the middle column is north: that is where the ball is
    let (width, height) = (found.panorama.width(), found.panorama.height());
    assert!((f64::from(found.panorama.get(width / 2, height / 2).unwrap()) - 6.0).abs() < 1e-3);
    assert_eq!(found.panorama.get(0, height / 2), Some(f32::INFINITY));
}

#[test]
fn an_eye_inside_a_ball_looks_through_it_and_senseless_parameters_are_refused() {
    let scene = scene(&[([0.0, 0.0, 0.0], 2.0)]);
    let found = isovist(&scene, [0.5, 0.0, 0.0], &IsovistParams::default(), &Control::none()).unwrap();
    assert_eq!(found.openness, 1.0);
    let usual = IsovistParams::default();
    for params in [
        usual.with_step(0.0),
        usual.with_step(f64::NAN),
        usual.with_step(3.0),
        usual.with_max_range(f64::INFINITY),
        usual.with_jump(0.0),
    ] {
        assert!(isovist(&scene, [9.0; 3], &params, &Control::none()).is_err(), "{params:?}");
    }
    assert!(isovist(&scene, [f64::NAN, 0.0, 0.0], &usual, &Control::none()).is_err());
}
