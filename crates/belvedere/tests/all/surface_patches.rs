//! Patches of surfaces of the survey: what they block by closed forms, and all ways of looking against single lines.

use belvedere::apps::radio_link::RadioWave;
use belvedere::blocking::{BlockRule, PATCH_DEPTH, Profile};
use belvedere::control::Control;
use belvedere::depth::{ItemBuffer, NO_BALL};
use belvedere::medial::MedialBalls;
use belvedere::model::{ModelParts, SceneModel};
use belvedere::query::target_tree::TargetTree;
use belvedere::query::{
    Answer, Blocker, BlockingTriangles, Curvature, EarthParams, MedialScene, Scope, Viewer, random_targets,
};
use belvedere::random::uniform;
use belvedere::vector::{length, sub, unit};
use belvedere::view::{View, to_sun};
use belvedere::{Bounds, PatchKind, SurfacePatches};
use belvedere_scenes::{PlanPlacement, TriangleScene, extruded};

fn balls(count: u64, size: f64) -> MedialBalls {
    let at = |i: u64| (size * uniform(3, i)) as f32;
    let mut balls = MedialBalls::default();
    for i in 0..count {
        balls.push(0, [at(4 * i), at(4 * i + 1), 0.2 * at(4 * i + 2)], 0.2 + 0.8 * uniform(4, i) as f32, 0);
    }
    balls
}

/// A wall of 20 by 10 m in the plane x = 0 that faces east.
fn wall() -> SurfacePatches {
    let mut patches = SurfacePatches::default();
    let [a, b, c, d] = [[0.0, -10.0, 0.0], [0.0, 10.0, 0.0], [0.0, 10.0, 10.0], [0.0, -10.0, 10.0]];
    patches.push([a, b, c], PatchKind::Wall);
    patches.push([a, c, d], PatchKind::Wall);
    patches
}

fn scene_of(balls: &MedialBalls, patches: &SurfacePatches) -> MedialScene {
    let triangles = BlockingTriangles::of_patches(patches, None).unwrap();
    MedialScene::new(balls, &BlockRule::carved()).unwrap().with_triangles(triangles)
}

/// The faces of some boxes as patches: roofs and walls that face outward, without a bottom.
fn houses() -> SurfacePatches {
    let mut scene = TriangleScene::default();
    for i in 0..14_u64 {
        let random = |k: u64| uniform(21, 16 * i + k);
        let place = PlanPlacement { origin: [60.0 * random(0), 60.0 * random(1)], angle: 3.0 * random(2) };
        let size = [4.0 + 8.0 * random(3), 3.0 + 5.0 * random(4)];
        scene.add_object("house", &[extruded(&place.rectangle(size[0], size[1]), 0.0, 4.0 + 8.0 * random(5))]);
    }
    let mut patches = SurfacePatches::default();
    for triangle in &scene.triangles {
        let corners = triangle.map(|row| scene.vertices[row as usize].map(|v| v as f32));
        let [a, b, c] = corners.map(|corner| corner.map(f64::from));
        let (u, v) = (sub(b, a), sub(c, a));
        let up = u[0] * v[1] - u[1] * v[0];
        let is_bottom = corners.iter().all(|corner| corner[2] == 0.0);
        let kind = if up.abs() > 1e-3 { PatchKind::Roof } else { PatchKind::Wall };
        if !is_bottom {
            patches.push(corners, kind);
        }
    }
    assert!(patches.kinds.contains(&PatchKind::Roof) && patches.kinds.contains(&PatchKind::Wall));
    patches
}

#[test]
fn a_patch_gives_way_to_ends_up_to_fifteen_centimetres_behind_it() {
    let scene = scene_of(&MedialBalls::default(), &wall());
    let flat = EarthParams::flat();
    let eye = [30.0, 1.0, 4.0];
    for (x, expected) in [
        // on the wall, a little behind and before it
        (0.0, Answer::Visible),
        (-0.1, Answer::Visible),
        (-0.149, Answer::Visible),
        (-0.151, Answer::Blocked),
        (-0.2, Answer::Blocked),
        (-20.0, Answer::Blocked),
        (0.0005, Answer::Visible),
        (0.1, Answer::Visible),
        (5.0, Answer::Visible),
    ] {
        for (y, z) in [(0.0, 3.0), (-9.0, 0.5), (7.0, 9.0)] {
            let target = [x, y, z];
            for [from, to] in [[eye, target], [target, eye]] {
                assert_eq!(scene.sight_answer(from, to, &flat), expected, "{from:?} {to:?}");
                let sight = scene.line_of_sight(from, to, &flat).unwrap();
                assert_eq!(sight.answer, expected);
                let block = sight.first_block.map(|block| block.blocker);
                assert_eq!(block, (expected == Answer::Blocked).then_some(Blocker::Patch(PatchKind::Wall)));
            }
        }
    }
    // an end in front of the wall is never behind it: lines that cross the wall from there are blocked
    for x in [0.002, 0.05, 0.1, 0.15, 3.0] {
        for far in [[-30.0, 0.0, 4.0], [-0.3, 2.0, 4.0]] {
            for [from, to] in [[[x, 0.0, 3.0], far], [far, [x, 0.0, 3.0]]] {
                assert_eq!(scene.sight_answer(from, to, &flat), Answer::Blocked, "{from:?} {to:?}");
            }
        }
    }
    // behind the wall on both ends, beside it, above it
    assert_eq!(scene.sight_answer([-1.0, 0.0, 3.0], [-20.0, 5.0, 3.0], &flat), Answer::Visible);
    assert_eq!(scene.sight_answer([5.0, 12.0, 3.0], [-5.0, 12.0, 3.0], &flat), Answer::Visible);
    assert_eq!(scene.sight_answer([5.0, 0.0, 12.0], [-5.0, 0.0, 9.0], &flat), Answer::Visible);
    // towards the sky and the sun
    let (east, west) = ([1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]);
    for (x, to_east, to_west) in [(-0.1, true, true), (-0.2, false, true), (0.1, true, false), (0.0, true, true)] {
        let lit = |direction| scene.answer([x, 0.5, 3.0], direction, f64::INFINITY) == Answer::Visible;
        assert_eq!((lit(east), lit(west)), (to_east, to_west), "{x}");
    }
}

#[test]
fn all_ways_of_looking_agree_about_patches() {
    let (balls, patches) = (balls(200, 60.0), houses());
    let (scene, bare) = (scene_of(&balls, &patches), MedialScene::new(&balls, &BlockRule::carved()).unwrap());
    let (control, flat) = (Control::none(), EarthParams::flat());
    // anywhere, and near patches: on both sides, where ends lie on the surface or just do not
    let mut targets = random_targets([-5.0, -5.0, 0.0], [65.0, 65.0, 14.0], 8000, 2);
    for (i, corners) in (0_u64..).zip(patches.triangles.iter().cycle().take(4000)) {
        let [u, v] = [uniform(31, 4 * i), uniform(31, 4 * i + 1)];
        let [u, v] = if u + v > 1.0 { [1.0 - u, 1.0 - v] } else { [u, v] };
        let [a, b, c] = corners.map(|corner| corner.map(f64::from));
        let by = 0.6 * (uniform(31, 4 * i + 2) - 0.5);
        let [p, q] = [sub(b, a), sub(c, a)];
        let normal = unit([p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]).unwrap();
        targets.push(std::array::from_fn(|k| (a[k] + u * p[k] + v * q[k] + by * normal[k]) as f32));
    }
    let near_patch = f64_of(targets[9000]).map(|v| v + 1e-3);
    for eye in [[4.0, 58.0, 15.0], [33.0, 28.0, 1.7], near_patch] {
        let viewer = Viewer::Eye(eye);
        let single = |scene: &MedialScene| -> Vec<Answer> {
            let line = |(row, &target)| {
                let (towards, range) = viewer.line_of_sight(row, target).unwrap();
                scene.answer(f64_of(target), towards, range)
            };
            targets.iter().enumerate().map(line).collect()
        };
        let expected = single(&scene);
        let hidden = single(&bare).iter().zip(&expected).filter(|(before, after)| before != after).count();
        assert!(hidden > 500, "{hidden}");
        assert_eq!(scene.visible_from(viewer, &targets, &control).unwrap(), expected);
        let tree = TargetTree::new(&targets);
        let mut seen = vec![false; targets.len()];
        scene.visible_among(viewer, &tree, &control, |place| seen[tree.rows()[place] as usize] = true).unwrap();
        assert!(seen.iter().zip(&expected).all(|(&seen, &answer)| seen == (answer == Answer::Visible)));
        let view = View::perspective(eye, [30.0, 30.0, 5.0], 1.2, [40, 30], 0.0, f64::INFINITY).unwrap();
        let (by_map, report) = scene.visible_in_views(&[view], Scope::Viewer, &targets, &control).unwrap();
        assert!(report.is_some_and(|report| report.settled_count > 500), "{report:?}");
        assert_eq!(by_map, expected);
        let curved = EarthParams { curvature: Curvature::On, refraction: 0.999, ..EarthParams::default() };
        let mut of_patch = 0;
        for &target in targets.iter().step_by(3) {
            let target = f64_of(target);
            let answer = scene.sight_answer(eye, target, &flat);
            assert_eq!(scene.sight_answer(target, eye, &flat), answer, "{target:?}");
            let sight = scene.line_of_sight(eye, target, &flat).unwrap();
            let back = scene.line_of_sight(target, eye, &flat).unwrap();
            assert_eq!((sight.answer, back.answer), (answer, answer), "{target:?}");
            assert_eq!(
                scene.sight_answer(eye, target, &curved),
                scene.line_of_sight(eye, target, &curved).unwrap().answer
            );
            let Some(block) = sight.first_block.filter(|block| block.blocker.patch().is_some()) else { continue };
            of_patch += 1;
            let towards = unit(sub(target, eye)).unwrap();
            let at: [f64; 3] = std::array::from_fn(|i| eye[i] + block.range * towards[i]);
            assert!(length(sub(at, block.place)) < 1e-9);
            let crossings = scene.crossings(eye, target, &flat);
            assert!(crossings.iter().any(|crossing| {
                crossing.blocker == block.blocker
                    && crossing.ranges.iter().all(|range| (range - block.range).abs() < 1e-3)
            }));
        }
        assert!(of_patch > 300, "{of_patch}");
    }
    // many directions, from few targets and many
    let directions: Vec<[f64; 3]> =
        (0..40).map(|i| to_sun(f64::from(i) * 0.7, f64::from(i % 13) * 0.11 - 0.02)).collect();
    for targets in [&targets[..], &targets[7990..8040]] {
        let matrix = scene.visibility_matrix(targets, &directions, &control).unwrap();
        let one_thread = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        assert!(matrix == one_thread.install(|| scene.visibility_matrix(targets, &directions, &control)).unwrap());
        for (column, direction) in directions.iter().enumerate() {
            for (row, &target) in targets.iter().enumerate() {
                let free = scene.answer(f64_of(target), *direction, f64::INFINITY) == Answer::Visible;
                assert_eq!(matrix.is_free(row, column), free, "{target:?} {direction:?}");
                let is_met = scene.seen_from_surface(f64_of(target), *direction).is_some();
                assert_eq!(is_met, !free, "{target:?} {direction:?}");
            }
        }
    }
}

fn f64_of(place: [f32; 3]) -> [f64; 3] {
    place.map(f64::from)
}

#[test]
fn skylines_and_lowest_visible_heights_are_those_of_single_lines() {
    let patches = houses();
    let (control, flat) = (Control::none(), EarthParams::flat());
    for scene in [scene_of(&MedialBalls::default(), &patches), scene_of(&balls(200, 60.0), &patches)] {
        let mut of_patch = 0;
        // also on a roof and on a wall, 10 cm behind them
        let [roof, wall] = [PatchKind::Roof, PatchKind::Wall].map(|kind| {
            let (corners, _) = patches.iter().find(|(_, own)| *own == kind).unwrap();
            let [a, b, c] = corners.map(f64_of);
            let [p, q] = [sub(b, a), sub(c, a)];
            let normal =
                unit([p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]).unwrap();
            std::array::from_fn(|k| (a[k] + b[k] + c[k]) / 3.0 - 0.1 * normal[k])
        });
        for eye in [[5.0, 8.0, 9.0], [44.0, 20.0, 1.7], [30.0, 45.0, 16.5], roof, wall] {
            for (number, point) in scene.skyline(eye, 72, &flat, &control).unwrap().into_iter().enumerate() {
                if !matches!(point.blocker, Some(Blocker::Patch(_))) || point.elevation > 1.57 {
                    continue;
                }
                of_patch += 1;
                let azimuth = (number as f64 * 5.0).to_radians();
                let free =
                    |elevation: f64| scene.answer(eye, to_sun(azimuth, elevation), f64::INFINITY) == Answer::Visible;
                assert!(!free(point.elevation - 1e-4), "{eye:?} {number}");
                assert!(free(point.elevation + 1e-4), "{eye:?} {number} {point:?}");
            }
        }
        assert!(of_patch > 100, "{of_patch}");
        let mut raised = 0;
        for i in 0..400_u64 {
            let place = |k: u64| 60.0 * uniform(8, 8 * i + k);
            let (observer, foot) = ([place(0), place(1), 2.0 + 0.3 * place(2)], [place(3), place(5), 0.0]);
            let Some(height) = scene.min_visible_height(observer, foot, 300.0, &flat) else { continue };
            let seen = |height: f64| scene.sight_answer(observer, [foot[0], foot[1], height], &flat) == Answer::Visible;
            assert!(seen(height) || seen(height + 1e-3), "{observer:?} {foot:?} {height}");
            let below = (0..400).map(|k| height * f64::from(k) / 400.0);
            assert!(
                height < 0.01 || !below.into_iter().any(|below| seen(below) && height - below > 0.005),
                "{observer:?} {foot:?} {height}"
            );
            let block = scene.line_of_sight(observer, foot, &flat).unwrap().first_block;
            raised += usize::from(block.is_some_and(|block| block.blocker.patch().is_some()));
        }
        assert!(raised > 50, "{raised}");
    }
    // below a roof the lowest place that is seen from above lies in its surface
    let mut roof = SurfacePatches::default();
    roof.push([[0.0, 0.0, 5.0], [40.0, 0.0, 5.0], [0.0, 40.0, 5.0]], PatchKind::Roof);
    let scene = scene_of(&MedialBalls::default(), &roof);
    let height = scene.min_visible_height([12.0, 10.0, 30.0], [10.0, 10.0, 1.0], 100.0, &flat).unwrap();
    assert!((height - (4.0 - PATCH_DEPTH)).abs() < 2e-3, "{height}");
}

#[test]
fn pictures_show_patches_where_they_are_nearer_than_balls() {
    let mut balls = MedialBalls::default();
    // before the wall, and behind it
    for x in [2.0, -6.0] {
        balls.push(0, [x, 0.0, 5.0], 1.0, 0);
    }
    let bounds = Bounds { low: [-10.0, -10.0, 0.0], high: [10.0; 3] };
    let parts = ModelParts { balls, bounds, ..ModelParts::default() };
    let model = SceneModel::from_parts(parts).unwrap().with_patches(wall()).unwrap();
    let (eye, none) = ([8.0, 0.0, 5.0], Control::none());
    let camera = View::perspective(eye, [0.0, 0.0, 5.0], 1.0, [81, 61], 0.0, f64::INFINITY).unwrap();
    let map = model.depth_map(&camera, Profile::Sphere, ItemBuffer::With, &none).unwrap();
    let items = map.balls.as_ref().unwrap();
    // the middle shows the ball before the wall, its side the wall, though a ball is behind
    assert!((map.depth.get(40, 30).unwrap() - 5.0).abs() < 0.01 && items.get(40, 30) == Some(0));
    assert!((map.depth.get(60, 30).unwrap() - 8.0).abs() < 1e-4 && items.get(60, 30) == Some(NO_BALL));
    let near = View::perspective(eye, [0.0, 0.0, 5.0], 1.0, [81, 61], 0.0, 7.5).unwrap();
    let cut = model.depth_map(&near, Profile::Sphere, ItemBuffer::Without, &none).unwrap();
    assert!(cut.depth.get(60, 30).unwrap().is_infinite(), "beyond the far limit nothing is seen");
    // from the east, level: depth counts from the picture plane
    let parallel = View::parallel([-1.0, 0.0, 0.0], [-10.0, -10.0, 0.0], [10.0; 3], 0.5).unwrap();
    let map = model.depth_map(&parallel, Profile::Sphere, ItemBuffer::Without, &none).unwrap();
    let [x, y, depth] = parallel.project([0.0, 6.0, 5.0]).unwrap();
    let seen = map.depth.get(x as usize, y as usize).unwrap();
    assert!((f64::from(seen) - depth).abs() < 1e-4, "{seen} {depth}");
    // all around: west, a quarter of the width from the left, is the ball; a little farther north is the wall
    let width = 720;
    let panorama = model.panorama(eye, width, ItemBuffer::With, &none).unwrap();
    assert!((panorama.range.get(width / 4, width / 4).unwrap() - 5.0).abs() < 0.01);
    let column = width / 4 + 40;
    let wall = 8.0 / ((40.5_f64) / width as f64 * std::f64::consts::TAU).cos();
    assert!((f64::from(panorama.range.get(column, width / 4).unwrap()) - wall).abs() < 0.01);
    assert_eq!(panorama.balls.unwrap().get(column, width / 4), Some(NO_BALL));
}

#[test]
fn ranges_and_radio_links_know_patches() {
    let scene = scene_of(&MedialBalls::default(), &wall());
    let eye = [-8.0, 1.0, 3.0];
    assert_eq!(scene.seen_along(eye, [1.0, 0.0, 0.0], 100.0), Some((Blocker::Patch(PatchKind::Wall), 8.0)));
    assert_eq!(scene.seen_along(eye, [1.0, 0.0, 0.0], 7.0), None);
    assert_eq!(scene.seen_along([-0.1, 1.0, 3.0], [1.0, 0.0, 0.0], 100.0), None);
    let block = scene.first_block(eye, [1.0, 0.0, 0.0], f64::INFINITY);
    assert_eq!(block, Some((Blocker::Patch(PatchKind::Wall), 8.0)));
    // two metres above the wall
    let wave = RadioWave::of_frequency(2.4).unwrap();
    let ends = [[-30.0, 0.0, 12.0], [70.0, 0.0, 12.0]];
    let found = wave.zone_clearance(&scene, ends, &EarthParams::flat(), 9.0);
    assert!((found - 2.0 / wave.zone_radius([30.0, 70.0])).abs() < 1e-6, "{found}");
}
