//! Lines of sight and viewsheds with ends on the terrain beyond a cloud, against closed forms and lines followed step
//! by step.

use crate::far_viewsheds::{MapBox, around, heights_above, observer, open_scene, sag, scene};
use crate::mountains::{grid, mountains};
use belvedere::PointCloud;
use belvedere::apps::eyes::{EyeFault, fault_of_target, skip_unfit_eyes, skip_unfit_far_eyes};
use belvedere::apps::profile::sight_profile;
use belvedere::apps::radio_link::RadioWave;
use belvedere::apps::targets::{CellParams, Targets};
use belvedere::apps::viewshed::{Observer, ViewshedParams, far_viewshed, min_visible_heights, viewshed};
use belvedere::control::Control;
use belvedere::ground::{Ground, MapGrid};
use belvedere::query::{Answer, Blocker, EarthParams, LineOfSight, MedialScene};
use belvedere::random::uniform;
use belvedere::raster::Raster;

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
                // rounding is allowed a billionth of the distance in height; that is metres along a line that grazes
                // the sea
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
                    // steps are at most 60 m / 32 times the root of 2 apart; terrain may also rise above the line
                    // between two steps only
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
}

#[test]
fn zones_of_radio_links_clear_the_terrain() {
    let wave = RadioWave::of_frequency(5.8).unwrap();
    let earth = EarthParams::default();
    let cloud: MapBox = ([4000.0, -4600.0], [4600.0, -4000.0]);
    let plain = open_scene(grid(401, 20.0, |_, _| 0.0), cloud);
    let link = |height: f64| [[500.0, -1007.0, height], [7500.0, -1007.0, height]];
    // over a plain the middle is narrowest: there the earth bulges most and the zone is widest
    let middle = wave.zone_radius([3500.0, 3500.0]);
    let expected = |height: f64| (height - earth.sag(7000.0, 0.5)) / middle;
    for height in [3.0, 6.0, 40.0] {
        let found = wave.zone_clearance(&plain, link(height), &earth, 9.0);
        assert!((found - expected(height)).abs() < 1e-3, "{height}: {found} {}", expected(height));
    }
    // a ridge along x = 2000, 100 m high, steep enough that its crest is nearest
    let ridge = open_scene(grid(401, 20.0, |x, _| if x == 2000.0 { 100.0 } else { 0.0 }), cloud);
    let found = wave.zone_clearance(&ridge, link(104.0), &earth, 9.0);
    let gap = 104.0 - 100.0 - earth.sag(7000.0, 1500.0 / 7000.0);
    assert!((found - gap / wave.zone_radius([1500.0, 5500.0])).abs() < 2e-3, "{found}");
    // within the cloud terrain does not count, and a link that the ridge blocks has no zone
    let zones = |scene: &MedialScene, pairs: &[[[f64; 3]; 2]]| {
        let sights = scene.lines_of_sight(pairs, &earth, &Control::none()).unwrap();
        wave.zone_clearances(scene, pairs, &sights, &earth, &Control::none()).unwrap()
    };
    let inside = [[4300.0, -4300.0, 20.0], [4400.0, -4400.0, 20.0]];
    assert_eq!(zones(&ridge, &[inside, link(90.0)]), [1.0, 0.0]);
    let low = zones(&plain, &[link(6.0)])[0];
    assert!((low - expected(6.0)).abs() < 1e-3 && low < 0.6, "{low}");
}

#[test]
fn eyes_on_terrain_can_look_unless_they_are_below_it() {
    let scene = open_scene(grid(401, 20.0, |x, _| x / 100.0), ([4000.0, -4600.0], [4600.0, -4000.0]));
    let eyes = [
        [1000.0, -1000.0, 11.7],
        [1000.0, -1000.0, 9.9],
        [1000.0, -1000.0, 9.0],
        [1000.0, -1000.0, f64::NAN],
        [9000.0, -1000.0, 11.7],
        [4300.0, -4300.0, 50.0],
    ];
    let mut far = eyes;
    let report = skip_unfit_far_eyes(&scene, None, &mut far, &Control::none()).unwrap();
    let faults: Vec<_> = report.faults.iter().map(|skipped| (skipped.row, skipped.fault)).collect();
    assert_eq!(faults, [(2, EyeFault::BelowGround(1.0)), (3, EyeFault::NoGround), (4, EyeFault::OutsideCloud)]);
    assert_eq!(eyes.map(|eye| fault_of_target(&scene, eye).is_some()), [false, false, true, true, true, false]);
    // where lines of sight end in the cloud, all of these are outside it
    let mut near = eyes;
    assert_eq!(skip_unfit_eyes(&scene, None, &mut near, &Control::none()).unwrap().skipped_outside_cloud, 5);
}

#[test]
fn an_observer_behind_a_ridge_sees_of_the_cloud_what_lies_above_the_line_over_its_crest() {
    // the crest at x = 5000 is 90 m high; the cloud lies east of it with one ball
    let ridge = |x: f64, _: f64| if x == 5000.0 { 90.0 } else { 0.0 };
    let cloud: MapBox = ([6000.0, -4300.0], [6600.0, -3700.0]);
    let (center, radius) = ([6250.0, -4000.0, 70.0], 40.0);
    let scene = scene(grid(501, 20.0, ridge), cloud, center, radius);
    let eye = [2000.0, -4010.0, 140.0];
    let targets: Vec<[f32; 3]> = (0..4000)
        .map(|i| {
            let [x, y, z] = [0, 1, 2].map(|k| uniform(11, 3 * i + k));
            [6000.0 + 600.0 * x, -4300.0 + 600.0 * y, 120.0 * z].map(|v| v as f32)
        })
        .collect();
    for earth in [EarthParams::default(), EarthParams::flat()] {
        let params = ViewshedParams::default().with_earth(earth);
        let look = |observers: &[Observer]| viewshed(&scene, observers, &targets, &params, &Control::none()).unwrap();
        let found = look(&[observer(eye)]);
        let mut counts = [0; 3];
        for (target, &answer) in targets.iter().zip(&found.answers) {
            let target = target.map(f64::from);
            let span = (target[0] - eye[0]).hypot(target[1] - eye[1]);
            let share = 3000.0 / (target[0] - eye[0]);
            let over = eye[2] + (target[2] - eye[2]) * share - sag(&earth, share * span, span) - 90.0;
            let to: [f64; 3] = std::array::from_fn(|k| target[k] - eye[k]);
            let ball: [f64; 3] = std::array::from_fn(|k| center[k] - eye[k]);
            let dot = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            let beside = (dot(ball, ball) - dot(ball, to).powi(2) / dot(to, to)).max(0.0).sqrt();
            // the line sags by less than 0.4 m where the ball is, 350 m and more from the target
            if over.abs() < 1e-3 || (beside - radius).abs() < 0.5 || (target[0] - center[0]).abs() < 60.0 {
                continue;
            }
            let is_behind_ball = target[0] > center[0] && beside < radius;
            let expected = over > 0.0 && !is_behind_ball;
            assert_eq!(answer == Answer::Visible, expected, "{target:?} {over} {beside}");
            counts[if over < 0.0 { 0 } else { 1 + usize::from(is_behind_ball) }] += 1;
        }
        assert!(counts.iter().all(|&count| count > 50), "{counts:?}");
        // many observers, in the cloud and on the terrain, have the counts of each alone
        let mut observers: Vec<Observer> =
            (0..70).map(|i| observer([1000.0 + 50.0 * f64::from(i), -4000.0 - 10.0 * f64::from(i), 140.0])).collect();
        observers.extend((0..6).map(|i| observer([6050.0 + 90.0 * f64::from(i), -4200.0, 60.0])));
        observers.push(observer([f64::NAN; 3]));
        let all = look(&observers);
        let each: Vec<_> = observers.iter().map(|&one| look(&[one])).collect();
        assert_eq!(all.seen_counts, each.iter().flat_map(|one| one.seen_counts.clone()).collect::<Vec<_>>());
        for (i, &count) in all.counts.iter().enumerate() {
            assert_eq!(count, each.iter().map(|one| one.counts[i]).sum::<u32>());
        }
        let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        assert_eq!(one.install(|| look(&observers)), all);
        // nobody in the cloud sees otherwise than without terrain
        let near = &observers[70..76];
        let bare = MedialScene::of_tree(scene.tree().with_rule(scene.params()).unwrap())
            .with_coverage(scene.coverage().copied());
        assert_eq!(viewshed(&bare, near, &targets, &params, &Control::none()).unwrap(), look(near));
    }
    // targets beyond the cloud are those of another function, whoever looks
    for eye in [eye, [6100.0, -4200.0, 60.0], [3000.0, -4000.0, 90_000.0]] {
        let params = ViewshedParams::default();
        let beyond = [[5500.0, -4000.0, 120.0], [6300.0, -4100.0, 119.0]];
        let found = viewshed(&scene, &[observer(eye)], &beyond, &params, &Control::none()).unwrap();
        let outside = if eye[2] > 1e4 { Answer::OutsideView } else { Answer::OutsideCloud };
        assert_eq!(found.answers[0], outside, "{eye:?}");
    }
    // heights that a thing must have are not known there
    let cells = MapGrid { corner: [6000.0, -3700.0], cell: 100.0, width: 6, height: 6 };
    let heights = Raster::filled(6, 6, 0.0);
    let ground = Ground { grid: cells, gaps: heights.clone(), heights };
    let of = |eye| min_visible_heights(&scene, &[observer(eye)], &ground, 50.0, &EarthParams::flat(), &Control::none());
    assert!(of([6100.0, -4200.0, 60.0]).is_ok());
    assert!(of(eye).unwrap_err().to_string().contains("in the cloud"));
}

#[test]
fn targets_below_the_ground_are_refused() {
    let scene = open_scene(grid(101, 20.0, |_, _| 0.0), ([800.0, -1200.0], [1200.0, -800.0]));
    let eye = [observer([1000.0, -1000.0, 20.0])];
    let terrain = scene.far_terrain().grid().unwrap();
    let heights = Raster::filled(2, 2, 0.0);
    let grid = MapGrid { corner: [900.0, -900.0], cell: 50.0, width: 2, height: 2 };
    let ground = Ground { grid, gaps: heights.clone(), heights };
    let cloud = PointCloud { positions: vec![[950.0, -950.0, 0.0]], ..PointCloud::default() };
    let (params, control) = (ViewshedParams::default(), Control::none());
    for height in [-1.0, f64::NAN, f64::INFINITY] {
        let far = far_viewshed(&scene, &eye, terrain, height, &params, &control).map(drop);
        let near =
            Targets::of_cells(&cloud, ground.clone(), &CellParams::default().with_height(height), &control).map(drop);
        for result in [far, near] {
            let error = result.unwrap_err().to_string();
            assert!(error.contains("0 metres or more"), "{error}");
        }
    }
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
