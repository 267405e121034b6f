//! Lines of sight with ends on the terrain beyond a cloud, against closed forms and lines followed step by step.

use crate::far_viewsheds::{MapBox, around, heights_above, open_scene, sag, scene};
use crate::mountains::{grid, mountains};
use belvedere::apps::profile::sight_profile;
use belvedere::control::Control;
use belvedere::query::{Answer, Blocker, EarthParams, LineOfSight, MedialScene, RadioWave};
use belvedere::random::uniform;

fn line(scene: &MedialScene, from: [f64; 3], to: [f64; 3], earth: &EarthParams) -> LineOfSight {
    let found = scene.line_of_sight(from, to, earth).unwrap();
    assert_eq!(found.answer, scene.sight_answer(from, to, earth), "{from:?} {to:?}");
    found
}

#[test]
fn two_masts_by_the_sea_see_each_other_up_to_the_sum_of_their_horizons() {
    let scene = open_scene(grid(101, 1000.0, |_, _| 0.0), ([50_000.0, -50_400.0], [50_400.0, -50_000.0]));
    for refraction in [1.0 / 7.0, 0.0] {
        let earth = EarthParams { refraction, ..EarthParams::default() };
        let radius = earth.radius / (1.0 - refraction);
        let [low, high] = [30.0_f64, 55.0];
        let reach = (2.0 * radius * low).sqrt() + (2.0 * radius * high).sqrt();
        for (span, is_seen) in [(reach - 1.0, true), (reach + 1.0, false), (reach + 9000.0, false)] {
            // far to the side of the cloud, and across it
            for y in [-20_123.0, -50_100.0] {
                let ends = [[11_050.0, y, low], [11_050.0 + span, y, high]];
                let found = line(&scene, ends[0], ends[1], &earth);
                assert_eq!(found.answer == Answer::Visible, is_seen, "{span}");
                if is_seen {
                    assert_eq!((found.first_block, found.unproven_length), (None, 0.0));
                    continue;
                }
                // where the line meets the sea first: low + (high - low) s / S - s (S - s) / 2R' = 0
                let (a, b) = (1.0 / (2.0 * radius), (high - low) / span - span / (2.0 * radius));
                let at = (-b - (b * b - 4.0 * a * low).sqrt()) / (2.0 * a);
                let block = found.first_block.unwrap();
                assert_eq!(block.blocker, Blocker::Terrain);
                // rounding is allowed a billionth of the distance in height; that is metres along a line that grazes the sea
                let room = if span < reach + 2.0 { 30.0 } else { 0.1 };
                assert!((block.place[0] - ends[0][0] - at).abs() < room, "{block:?} {at}");
                assert!(block.place[2].abs() < 1e-4 && (block.range - at.hypot(low)).abs() < room, "{block:?}");
            }
        }
    }
}

#[test]
fn lines_over_mountains_are_blocked_where_lines_followed_step_by_step_come_below_the_surface() {
    let terrain = mountains(301, 60.0, 1500.0);
    let cloud: MapBox = ([8000.0, -9000.0], [8600.0, -8400.0]);
    let scene = open_scene(terrain.clone(), cloud);
    let earth = EarthParams::default();
    let top = f64::from(terrain.height_range(cloud).unwrap()[1]);
    let on_terrain = |i: u64| {
        let [x, y] = [300.0 + 17_400.0 * uniform(7, 3 * i), -300.0 - 17_400.0 * uniform(7, 3 * i + 1)];
        [x, y, terrain.height_at([x, y]).unwrap() + 2.0 + 300.0 * uniform(7, 3 * i + 2)]
    };
    let in_cloud = |i: u64| [0, 1, 2].map(|k| uniform(9, 3 * i + k)).map(|v| 600.0 * v);
    let in_cloud = |i: u64| {
        let [x, y, z] = in_cloud(i);
        [8000.0 + x, -9000.0 + y, top + 1.0 + z / 6.0]
    };
    let mut counts = [0; 2];
    let mut grazing = 0;
    for i in 0..2000 {
        let (from, other) = (on_terrain(i), if i % 3 == 0 { in_cloud(i) } else { on_terrain(i + 5000) });
        let [from, to] = if i % 2 == 0 { [from, other] } else { [other, from] };
        let found = line(&scene, from, to, &earth);
        let steps = heights_above(&terrain, cloud, from, to, &earth);
        let first_below = steps.iter().find(|[_, above]| *above < -1e-4).map(|[at, _]| *at);
        counts[usize::from(found.answer == Answer::Visible)] += 1;
        match (found.first_block, first_below) {
            (None, below) => assert_eq!(below, None, "{from:?} {to:?}"),
            (Some(block), below) => {
                assert_eq!(block.blocker, Blocker::Terrain);
                let at = (block.place[0] - from[0]).hypot(block.place[1] - from[1]);
                let straight = (0..3).map(|k| (block.place[k] - from[k]).powi(2)).sum::<f64>().sqrt();
                assert!((block.range - straight).abs() < 1e-9);
                // there the line lies on the surface, or leaves the box within which the raster does not count
                let ground = terrain.height_at([block.place[0], block.place[1]]).unwrap();
                let is_at_box = (0..2).any(|k| {
                    [cloud.0[k] - 60.0, cloud.1[k] + 60.0].iter().any(|side| (block.place[k] - side).abs() < 1e-6)
                });
                let above = block.place[2] - ground;
                assert!(above.abs() < 1e-3 || is_at_box && above < 0.0, "{} {ground}", block.place[2]);
                match below {
                    // steps are at most 60 m / 32 times the root of 2 apart; terrain may also rise above the line between two steps only
                    Some(below) if at <= below + 1e-6 => grazing += usize::from(below - at > 2.7),
                    Some(below) => panic!("{from:?} {to:?}: {at} after {below}"),
                    None => grazing += 1,
                }
            }
        }
    }
    assert!(counts.iter().all(|&count| count > 300) && grazing < 20, "{counts:?} {grazing}");
}

#[test]
fn what_stands_nearer_to_the_observer_blocks_first() {
    // a ridge 200 m high at x = 5000, and a ball in the cloud 3 km behind it
    let ridge = |x: f64, _: f64| if x == 5000.0 { 200.0 } else { 0.0 };
    let (center, radius) = ([8000.0, -4000.0, 100.0], 20.0);
    let scene = scene(grid(501, 20.0, ridge), around(center, 300.0), center, radius);
    let flat = EarthParams::flat();
    let (west, east) = ([3000.0, -4000.0, 100.0], [9500.0, -4000.0, 100.0]);
    let [there, back] = [line(&scene, west, east, &flat), line(&scene, east, west, &flat)];
    let first = there.first_block.unwrap();
    // up the west side of the ridge from 0 m at x = 4980: 100 m high in its middle
    assert_eq!(first.blocker, Blocker::Terrain);
    assert!((first.range - 1990.0).abs() < 1e-6 && (first.place[2] - 100.0).abs() < 1e-9, "{first:?}");
    let first = back.first_block.unwrap();
    assert_eq!((first.blocker, (first.range - 1480.0).abs() < 1e-6), (Blocker::Ball(0), true), "{first:?}");
    // above the ridge only the ball is in the way, and beside the ball only the ridge
    let raised = |[x, y, z]: [f64; 3], dy: f64, dz: f64| [x, y + dy, z + dz];
    let over = line(&scene, raised(west, 0.0, 400.0), raised(center, 0.0, -15.0), &flat);
    assert_eq!(over.first_block.map(|block| block.blocker), Some(Blocker::Ball(0)));
    let beside = line(&scene, raised(west, 50.0, 0.0), raised(east, 50.0, 0.0), &flat);
    assert_eq!(beside.first_block.map(|block| block.blocker), Some(Blocker::Terrain));
    let free = line(&scene, raised(west, 50.0, 110.0), raised(east, 50.0, 110.0), &flat);
    assert_eq!((free.answer, free.first_block), (Answer::Visible, None));
}

#[test]
fn places_without_terrain_below_the_cloud_or_above_each_other_have_no_line() {
    let cloud: MapBox = ([4000.0, -4600.0], [4600.0, -4000.0]);
    let scene = open_scene(grid(401, 20.0, |_, _| 0.0), cloud);
    let earth = EarthParams::default();
    let (inside, far) = ([4300.0, -4300.0, 20.0], [1000.0, -1000.0, 20.0]);
    let answer = |a, b| {
        let [there, back] = [scene.sight_answer(a, b, &earth), scene.sight_answer(b, a, &earth)];
        assert_eq!(there, back);
        assert_eq!(scene.line_of_sight(a, b, &earth).map_or(Answer::OutsideView, |sight| sight.answer), there);
        there
    };
    assert_eq!(answer(inside, far), Answer::Visible);
    assert_eq!(answer(far, [7000.0, -1500.0, 20.0]), Answer::Visible);
    for outside in [[-1.0, -1000.0, 20.0], [1000.0, -8001.0, 20.0], [1000.0, -1000.0, 1e6], [4300.0, -4300.0, -5002.0]]
    {
        assert_eq!((answer(inside, outside), answer(far, outside)), (Answer::OutsideCloud, Answer::OutsideCloud));
        assert!(scene.is_outside(outside));
    }
    assert_eq!(answer(far, [1000.0, -1000.0, 50.0]), Answer::OutsideView);
    assert_eq!(answer(far, [1000.0, f64::NAN, 50.0]), Answer::OutsideView);
    // ends below the surface are behind it
    assert_eq!(answer(inside, [1000.0, -1000.0, -3.0]), Answer::Blocked);
    // a scene of which nobody knows where its cloud lies has no terrain beyond it
    let unknown = MedialScene::new(&Default::default(), &Default::default()).unwrap();
    assert!(!unknown.is_on_far_terrain(far) && !unknown.is_outside(far));
    // zones of radio links are not tested over terrain
    let wave = RadioWave::of_frequency(5.8).unwrap();
    let zones = |pairs: &[[[f64; 3]; 2]]| {
        let sights = scene.lines_of_sight(pairs, &earth, &Control::none())?;
        scene.fresnel_clearances(pairs, &sights, wave, &earth, &Control::none())
    };
    assert_eq!(zones(&[[inside, [4400.0, -4400.0, 20.0]]]).unwrap(), [1.0]);
    let error = zones(&[[inside, [4400.0, -4400.0, 20.0]], [inside, far]]).unwrap_err().to_string();
    assert!(error.contains("number 2") && error.contains("within the cloud"), "{error}");
}

#[test]
fn a_profile_has_the_ground_of_the_terrain_beyond_the_cloud() {
    let ridge = |x: f64, _: f64| if x == 5000.0 { 90.0 } else { 0.0 };
    let (center, radius) = ([6250.0, -4000.0, 20.0], 30.0);
    let scene = scene(grid(501, 20.0, ridge), around(center, 300.0), center, radius);
    let earth = EarthParams::default();
    let ends = [[4600.0, -4000.0, 30.0], [6250.0, -4000.0, 70.0]];
    let profile = sight_profile(&scene, None, ends, &earth, Some(5.0), &Control::none()).unwrap();
    assert_eq!(profile.distances.len(), 331);
    for (i, &at) in profile.distances.iter().enumerate() {
        let x = 4600.0 + at;
        let line = 30.0 + 40.0 * at / 1650.0 - sag(&earth, at, 1650.0);
        assert!((profile.line[i] - line).abs() < 1e-9);
        if x < 5949.0 {
            let ground = (90.0 - 4.5 * (x - 5000.0).abs()).max(0.0);
            assert!((profile.ground[i] - ground).abs() < 1e-6 && profile.solid[i].is_empty());
            assert_eq!(profile.blocked[i], ground > line, "{x}");
        } else {
            assert!(profile.ground[i].is_nan() && !profile.blocked[i]);
            let half = (radius * radius - (x - center[0]).powi(2)).max(0.0).sqrt();
            assert_eq!(profile.solid[i].len(), usize::from(half > 0.0), "{x}");
        }
    }
    // up the west side of the ridge to the line, about 39 m high there: x = 4988.6
    let at = profile.blocked_at.unwrap();
    let line = 30.0 + 40.0 * at / 1650.0 - sag(&earth, at, 1650.0);
    assert!((90.0 - 4.5 * (400.0 - at) - line).abs() < 1e-6, "{at}");
}
