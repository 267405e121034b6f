//! Meshes added to a scene: against closed forms, against the exact rays of the simulated towns, and all ways of asking
//! against each other.

use belvedere::blocking::BlockRule;
use belvedere::control::Control;
use belvedere::medial::MedialBalls;
use belvedere::query::Coverage;
use belvedere::query::target_tree::TargetTree;
use belvedere::query::{
    Answer, Blocker, BlockingTriangles, Curvature, EarthParams, MedialScene, Scope, Viewer, random_targets,
};
use belvedere::random::uniform;
use belvedere::vector::{length, sub, unit};
use belvedere::view::{View, to_sun};
use belvedere::{Bounds, Mesh};
use belvedere_scenes::{PlanPlacement, TriangleScene, Truth, extruded};

fn balls(count: u64, size: f64) -> MedialBalls {
    let at = |i: u64| (size * uniform(3, i)) as f32;
    let rows = count as usize;
    MedialBalls {
        centers: (0..count).map(|i| [at(4 * i), at(4 * i + 1), 0.2 * at(4 * i + 2)]).collect(),
        radii: (0..count).map(|i| 0.2 + 1.5 * uniform(4, i) as f32).collect(),
        source: vec![0; rows],
        touch: vec![0; rows],
        separation_angles: vec![1.0; rows],
    }
}

fn mesh_of(scene: &TriangleScene) -> Mesh {
    Mesh { vertices: scene.vertices.clone(), triangles: scene.triangles.clone(), ..Mesh::default() }
}

/// An upright box: middle of its footprint, angle, length, width, bottom and top.
fn box_at([x, y]: [f64; 2], angle: f64, [along, across]: [f64; 2], [bottom, top]: [f64; 2]) -> TriangleScene {
    let mut scene = TriangleScene::default();
    let place = PlanPlacement { origin: [x, y], angle };
    scene.add_object("box", &[extruded(&place.rectangle(along, across), bottom, top)]);
    scene
}

fn added(scene: &TriangleScene) -> BlockingTriangles {
    BlockingTriangles::new(&mesh_of(scene), "box", [0.0; 3], None, None).unwrap()
}

/// Balls and two boxes.
fn town() -> MedialScene {
    let first = added(&box_at([30.0, 30.0], 0.4, [12.0, 7.0], [0.0, 15.0]));
    let second = mesh_of(&box_at([12.0, 20.0], 1.3, [5.0, 9.0], [2.0, 13.0]));
    let both = BlockingTriangles::new(&second, "second", [0.0; 3], None, Some(&first)).unwrap();
    MedialScene::new(&balls(300, 60.0), &BlockRule::carved()).unwrap().with_triangles(Some(both))
}

#[test]
fn the_shadow_of_an_added_box_is_its_closed_form() {
    let (low, high) = ([20.0, 30.0, 0.0], [32.0, 37.0, 9.0]);
    let mesh = box_at([26.0, 33.5], 0.0, [12.0, 7.0], [0.0, 9.0]);
    let scene =
        MedialScene::new(&MedialBalls::default(), &BlockRule::carved()).unwrap().with_triangles(Some(added(&mesh)));
    for (azimuth, elevation) in [(150.0_f64, 35.0_f64), (270.0, 10.0), (15.0, 60.0), (180.0, 89.0)] {
        let sun = to_sun(azimuth.to_radians(), elevation.to_radians());
        let targets = random_targets([-30.0, -20.0, 0.0], [90.0, 90.0, 0.0], 20_000, 5);
        let matrix = scene.visibility_matrix(&targets, &[sun], &Control::none()).unwrap();
        let mut counts = [0; 2];
        for (row, target) in targets.iter().enumerate() {
            // the line over the place passes the footprint while it is lower than the roof; a millimetre less and more
            let shaded = |room: f64| {
                let (mut from, mut to) = (0.0_f64, (high[2] + room - f64::from(target[2])) / sun[2]);
                for axis in 0..2 {
                    let sides = [low[axis] - room, high[axis] + room];
                    let [a, b] = sides.map(|side| (side - f64::from(target[axis])) / sun[axis]);
                    from = from.max(a.min(b));
                    to = to.min(a.max(b));
                }
                from < to
            };
            let free = matrix.is_free(row, 0);
            counts[usize::from(free)] += 1;
            assert!(if free { !shaded(-1e-3) } else { shaded(1e-3) }, "{target:?} {free}");
        }
        assert!(counts[0] > 50 && counts[1] > 50, "{counts:?}");
    }
}

#[test]
fn a_thousand_boxes_block_as_exact_rays_do() {
    let random = |row: u64, k: u64| uniform(11, 32 * row + k);
    let (mut blocked, mut differences) = (0, 0);
    for row in 0..1000 {
        let place = [200.0 * random(row, 0) + 85_000.0, 200.0 * random(row, 1) + 446_000.0];
        let size = [1.0 + 30.0 * random(row, 2), 1.0 + 30.0 * random(row, 3)];
        let bottom = 5.0 * random(row, 4);
        let scene = box_at(place, 7.0 * random(row, 5), size, [bottom, bottom + 0.5 + 30.0 * random(row, 6)]);
        let truth = Truth::new(&scene);
        let origin = [place[0] - 3.0, place[1] + 4.0, 1.0];
        let added = BlockingTriangles::new(&mesh_of(&scene), "box", origin, None, None).unwrap();
        for i in 0..40 {
            let end = |k: u64| -> [f64; 3] {
                let spread = |axis: u64| 60.0 * (uniform(12, row * 512 + 8 * i + k + axis) - 0.5);
                [spread(0), spread(1), 0.5 * spread(2) + 12.0]
            };
            let (target, eye) = (end(0), end(3));
            let in_map = |place: [f64; 3]| std::array::from_fn(|axis| place[axis] + origin[axis]);
            let towards = unit(sub(eye, target)).unwrap();
            // to an eye and to the sky
            let range = length(sub(eye, target));
            let of_rays =
                [truth.occluded(in_map(target), in_map(eye)), truth.occluded_towards(in_map(target), towards)];
            for (expected, range) in of_rays.into_iter().zip([range, f64::INFINITY]) {
                let found = added.blocks(target, towards, range);
                blocked += usize::from(found);
                if found != expected {
                    // within a millimetre of a face, which may be turned by 45 degrees to the axes, or of an edge
                    let moved = |axis: usize, by: f64| {
                        let mut moved = target;
                        moved[axis] += by;
                        added.blocks(moved, towards, range)
                    };
                    let is_near = (0..3).any(|axis| [-1.42e-3, 1.42e-3].iter().any(|&by| moved(axis, by) != found));
                    assert!(is_near, "box {row}, line {i}: {found}");
                    differences += 1;
                }
            }
        }
    }
    assert!(blocked > 10_000 && differences < 20, "{blocked} {differences}");
}

#[test]
fn all_ways_of_asking_agree_about_added_meshes() {
    let scene = town();
    let bare = MedialScene::new(&balls(300, 60.0), &BlockRule::carved()).unwrap();
    let control = Control::none();
    let targets = random_targets([-5.0, -5.0, 0.0], [65.0, 65.0, 16.0], 12_000, 2);
    let eye = [4.0, 58.0, 17.0];
    let viewer = Viewer::Eye(eye);
    let single = |viewer: Viewer<'_>, scene: &MedialScene| -> Vec<Answer> {
        let line = |(row, &target)| viewer.line_of_sight(row, target).map(|line| (target, line));
        let lines = targets.iter().enumerate().filter_map(line);
        lines.map(|(target, (towards, range))| scene.answer(target.map(f64::from), towards, range)).collect()
    };
    let expected = single(viewer, &scene);
    assert_eq!(scene.visible_from(viewer, &targets, &control).unwrap(), expected);
    let hidden = single(viewer, &bare).iter().zip(&expected).filter(|(before, after)| before != after).count();
    assert!(hidden > 300, "{hidden}");
    let tree = TargetTree::new(&targets);
    let mut seen = vec![false; targets.len()];
    scene.visible_among(viewer, &tree, &control, |place| seen[tree.rows()[place] as usize] = true).unwrap();
    assert!(seen.iter().zip(&expected).all(|(&seen, &answer)| seen == (answer == Answer::Visible)));
    let view = View::perspective(eye, [30.0, 30.0, 5.0], 1.2, [40, 30], 0.0, f64::INFINITY).unwrap();
    let (by_map, report) = scene.visible_in_views(&[view], Scope::Viewer, &targets, &control).unwrap();
    assert!(report.is_some_and(|report| report.settled_count > 1000));
    assert_eq!(by_map, expected);
    // pairs say which blocked lines have an end inside an obstacle, the others once they are marked; straight
    // and over a curved earth that is as good as flat
    let mut marked = expected.clone();
    scene.mark_inside_obstacles(viewer, &targets, &mut marked, &control).unwrap();
    assert!(!scene.is_inside_obstacle(eye));
    for ((target, expected), marked) in targets.iter().zip(&expected).zip(&marked) {
        let is_inside = *expected == Answer::Blocked && scene.is_inside_obstacle(target.map(f64::from));
        assert_eq!(*marked, if is_inside { Answer::InsideObstacle } else { *expected }, "{target:?}");
    }
    assert!(marked[..2000].contains(&Answer::InsideObstacle) && marked[..2000].contains(&Answer::Blocked));
    let curved = EarthParams { curvature: Curvature::On, refraction: 0.999, ..EarthParams::default() };
    for (target, &answer) in targets.iter().zip(&marked).take(2000) {
        let target = target.map(f64::from);
        let sight = scene.line_of_sight(eye, target, &EarthParams::flat()).unwrap();
        assert_eq!(sight.answer, answer);
        assert_eq!(scene.sight_answer(eye, target, &EarthParams::flat()), answer);
        assert_eq!(scene.sight_answer(eye, target, &curved), scene.line_of_sight(eye, target, &curved).unwrap().answer);
        // what blocks first stands where a line that ends a little before it does is free, and one a little after is
        // not
        if let Some(block) = sight.first_block.filter(|block| block.blocker.mesh().is_some()) {
            let towards = unit(sub(target, eye)).unwrap();
            let at = |range: f64| -> [f64; 3] { std::array::from_fn(|i| eye[i] + range * towards[i]) };
            let free = |range: f64| !scene.triangles().unwrap().blocks(at(range), towards.map(|v| -v), range);
            assert!(length(sub(at(block.range), block.place)) < 1e-9);
            assert!(free(block.range - 0.02) || free(block.range - 0.001), "{block:?}");
        }
    }
    let meshes: Vec<usize> = targets
        .iter()
        .filter_map(|target| {
            scene.line_of_sight(eye, target.map(f64::from), &EarthParams::flat())?.first_block?.blocker.mesh()
        })
        .collect();
    assert!(meshes.contains(&0) && meshes.contains(&1) && scene.triangles().unwrap().names() == ["box", "second"]);
    // many directions
    let directions: Vec<[f64; 3]> =
        (0..40).map(|i| to_sun(f64::from(i) * 0.7, 0.02 + f64::from(i % 13) * 0.11)).collect();
    let matrix = scene.visibility_matrix(&targets, &directions, &control).unwrap();
    let one_thread = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    assert!(matrix == one_thread.install(|| scene.visibility_matrix(&targets, &directions, &control)).unwrap());
    for (column, direction) in directions.iter().enumerate() {
        for (row, target) in targets.iter().enumerate().step_by(7) {
            let free = scene.answer(target.map(f64::from), *direction, f64::INFINITY) == Answer::Visible;
            assert_eq!(matrix.is_free(row, column), free, "{target:?} {direction:?}");
        }
    }
    // without any ball
    let alone = MedialScene::new(&MedialBalls::default(), &BlockRule::carved())
        .unwrap()
        .with_triangles(scene.triangles().cloned());
    let matrix = alone.visibility_matrix(&targets[..500], &directions, &control).unwrap();
    let is_same = |row: usize, column: usize| {
        let answer = alone.answer(targets[row].map(f64::from), directions[column], f64::INFINITY);
        matrix.is_free(row, column) == (answer == Answer::Visible)
    };
    assert!((0..500).all(|row| (0..40).all(|column| is_same(row, column))));
}

#[test]
fn skylines_heights_and_ranges_know_added_meshes() {
    let scene = town();
    let control = Control::none();
    let flat = EarthParams::flat();
    let mut of_mesh = 0;
    for eye in [[5.0, 8.0, 9.0], [44.0, 20.0, 8.0], [30.0, 45.0, 16.5]] {
        for (number, point) in scene.skyline(eye, 72, &flat, &control).unwrap().into_iter().enumerate() {
            let Some(Blocker::Mesh(_)) = point.blocker else { continue };
            of_mesh += 1;
            let azimuth = (number as f64 * 5.0).to_radians();
            let sees = |elevation: f64| scene.seen_along(eye, to_sun(azimuth, elevation), f64::INFINITY);
            let (blocker, range) = sees(point.elevation - 1e-4).unwrap();
            assert!(matches!(blocker, Blocker::Mesh(_)) || range < point.range, "{eye:?} {number}");
            assert!(sees(point.elevation + 1e-4).is_none(), "{eye:?} {number}");
        }
    }
    assert!(of_mesh > 30, "{of_mesh}");
    let mut raised = 0;
    for i in 0..300_u64 {
        let place = |k: u64| 60.0 * uniform(8, 4 * i + k);
        let (observer, foot) = ([place(0), place(1), 9.0 + 0.2 * place(2)], [place(3), place(5), 0.0]);
        let Some(height) = scene.min_visible_height(observer, foot, 300.0, &flat) else { continue };
        let seen = |height: f64| scene.sight_answer(observer, [foot[0], foot[1], height], &flat) == Answer::Visible;
        assert!(seen(height) || seen(height + 1e-3), "{observer:?} {foot:?} {height}");
        let below: Vec<f64> = (0..200).map(|k| height * f64::from(k) / 200.0).collect();
        assert!(
            height < 0.01 || !below.iter().any(|&below| seen(below) && height - below > 0.005),
            "{observer:?} {foot:?} {height}"
        );
        let block = scene.line_of_sight(observer, foot, &flat).unwrap().first_block;
        raised += usize::from(block.is_some_and(|block| block.blocker.mesh().is_some()));
    }
    assert!(raised > 15, "{raised}");
}

#[test]
fn a_target_on_a_face_is_not_hidden_by_it_and_inside_sees_nothing_outside() {
    let added = added(&box_at([400.3, 700.7], 0.3, [12.0, 7.0], [0.0, 9.0]));
    let scene =
        MedialScene::new(&MedialBalls::default(), &BlockRule::carved()).unwrap().with_triangles(Some(added.clone()));
    let place = PlanPlacement { origin: [400.3, 700.7], angle: 0.3 };
    for i in 0..500_u64 {
        let (u, v) = (11.9 * (uniform(1, 2 * i) - 0.5), 6.9 * (uniform(1, 2 * i + 1) - 0.5));
        let [x, y] = place.at(u, v);
        let up = to_sun(uniform(2, i) * 7.0, 0.001 + 1.5 * uniform(3, i));
        let answer = |place: [f64; 3]| scene.answer(place.map(|v| f64::from(v as f32)), up, f64::INFINITY);
        assert_eq!(answer([x, y, 9.0]), Answer::Visible);
        assert_eq!(answer([x, y, 8.99]), Answer::Blocked);
        // on a wall, looking out
        let [x, y] = place.at(6.0, v);
        let out = (0.3_f64.cos() * up[0] + 0.3_f64.sin() * up[1]) > 0.0;
        assert_eq!(answer([x, y, 4.0]) == Answer::Visible, out);
        assert!(added.encloses([400.3, 700.7, 4.0]) && !added.encloses([x, y, 9.5]));
    }
    assert_eq!(added.top_at([400.3, 700.7]), Some(9.0));
    assert_eq!(added.top_at([0.0, 0.0]), None);
}

#[test]
fn meshes_that_cannot_be_part_of_a_scene_are_refused_by_name() {
    let cloud = Coverage::of(Bounds { low: [0.0; 3], high: [100.0, 100.0, 30.0] });
    let origin = [85_000.0, 446_000.0, 0.0];
    let refused = |mesh: &Mesh, words: &[&str]| {
        let error = BlockingTriangles::new(mesh, "plan.obj", origin, cloud.as_ref(), None).unwrap_err().to_string();
        assert!(words.iter().chain(&["plan.obj"]).all(|word| error.contains(word)), "{error}");
    };
    let moved = |by: [f64; 3]| {
        let mut mesh = mesh_of(&box_at([0.0, 0.0], 0.0, [5.0, 5.0], [0.0, 5.0]));
        mesh.vertices.iter_mut().for_each(|vertex| *vertex = std::array::from_fn(|i| vertex[i] + by[i]));
        mesh
    };
    assert!(
        BlockingTriangles::new(&moved([85_050.0, 446_050.0, 3.0]), "plan.obj", origin, cloud.as_ref(), None).is_ok()
    );
    refused(&moved([85_500.0, 446_050.0, 3.0]), &["85502.5", "85100", "cloud"]);
    refused(&moved([85_050.0, 446_050.0, -80.0]), &["cloud"]);
    refused(&moved([4.3, 52.0, 0.0]), &["degrees"]);
    refused(&Mesh::default(), &["triangle"]);
    let mut broken = moved([85_050.0, 446_050.0, 3.0]);
    broken.vertices[2][1] = f64::NAN;
    refused(&broken, &["finite"]);
    broken.vertices.truncate(2);
    refused(&broken, &["vertex"]);
    let flat = Mesh { vertices: vec![[85_001.0, 446_001.0, 0.0]; 3], triangles: vec![[0, 1, 2]], ..Mesh::default() };
    refused(&flat, &["area"]);
}
