//! Lines of sight decided on a device equal those of the CPU: on random and hostile balls, on whole scenes, and with a
//! device lost during the work.

use belvedere::apps::sky_view::SkyDirections;
use belvedere::control::Control;
use belvedere::io::{ReadOptions, read_cloud};
use belvedere::medial::MedialBalls;
use belvedere::model::{ModelParams, SceneModel};
use belvedere::query::target_tree::TargetTree;
use belvedere::query::{
    Answer, Backend, Ball, BallTree, BlockRule, LineAnswer, MedialScene, UnprovenAs, Viewer, Viewers,
};
use belvedere::random::uniform;
use belvedere_gpu::{Choice, DeviceInfo, Gpu, devices};
use belvedere_scenes::{AirborneParams, TownParams, scan_airborne, town};
use std::sync::Arc;

use crate::depth_maps::assert_pictures_are_within;
use crate::{balls_of, data, devices_or_skip, random_balls};

/// The directions of a sky view, and some along axes, flat and downward.
fn directions() -> Vec<[f64; 3]> {
    let mut directions = SkyDirections::even(193).unwrap().directions;
    directions.extend([[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [0.6, 0.0, 0.8]]);
    for rise in [0.02_f64, 0.05, -0.1] {
        directions.push([(1.0 - rise * rise).sqrt(), 0.0, rise]);
    }
    directions
}

/// Targets in a box of some size and around it, and some very far away.
fn targets(count: u64, size: [f64; 3]) -> Vec<[f32; 3]> {
    let mut targets: Vec<[f32; 3]> = (0..count)
        .map(|i| {
            let random = |k: u64| uniform(22, 4 * i + k);
            std::array::from_fn(|axis| (1.2 * (random(axis as u64) - 0.5) * size[axis]) as f32)
        })
        .collect();
    for far in [3e3, 1e5, 9e6] {
        targets.extend([[far, 0.0, 0.0], [0.0, -far, 0.0], [0.0, 0.0, far], [0.0, 0.0, -far]]);
    }
    // on borders of cells, as far as there are any
    targets.extend((0..64_u8).map(|i| [0.5 * f32::from(i), -0.5 * f32::from(i), 0.0]));
    targets
}

/// Scenes of which a device decides nearly all lines.
const PLAIN: [&str; 3] = ["random balls", "a bias", "a single ball"];
/// Targets that are tested with every ball one by one.
const BRUTE: usize = 97;

/// Compares the decisions of a device with exact lines of sight, and the bits of the matrix with those of the CPU.
/// Returns the share of the lines that the device left open.
fn assert_equal_on(
    device: &DeviceInfo,
    balls: &MedialBalls,
    rule: &BlockRule,
    targets: &[[f32; 3]],
    what: &str,
) -> f64 {
    let tree = Arc::new(BallTree::new(balls, rule).unwrap());
    let directions = directions();
    let gpu = Arc::new(Gpu::new(Choice::Number(device.number)).unwrap());
    let settled = gpu.prepare(&tree).unwrap().settle(targets, &directions, &Control::none()).unwrap();
    assert!(gpu.notes().is_empty(), "{what} on {}: {:?}", device.name, gpu.notes());
    let scene = MedialScene::of_tree((*tree).clone());
    let mut open = 0_usize;
    for (number, target) in targets.iter().enumerate() {
        let from = target.map(f64::from);
        for (direction, towards) in directions.iter().enumerate() {
            let line = settled.line(number, direction);
            open += usize::from(line == LineAnswer::Open);
            if line == LineAnswer::Open || !(number % BRUTE == 0 || direction % BRUTE == 0) {
                continue;
            }
            let is_blocked = if number % BRUTE == 0 {
                let blocks = |ball: &Ball| rule.blocks_line(*ball, from, *towards, f64::INFINITY).is_some();
                tree.balls().iter().any(blocks)
            } else {
                scene.answer(from, *towards, f64::INFINITY) == Answer::Blocked
            };
            assert_eq!(
                line == LineAnswer::Blocked,
                is_blocked,
                "{what} on {}: {target:?} towards {towards:?}",
                device.name
            );
        }
    }
    assert_eyes_are_equal_on(device, &tree, targets, what);
    let on_cpu = scene.visibility_matrix(targets, &directions, &Control::none()).unwrap();
    let on_device = scene.with_backend(gpu).visibility_matrix(targets, &directions, &Control::none()).unwrap();
    assert!(on_device == on_cpu, "{what}: {} has other bits than the CPU", device.name);
    open as f64 / (targets.len() * directions.len()) as f64
}

/// Compares the lines of sight to eyes: at targets, beside them, in balls, far away, and no place at all.
fn assert_eyes_are_equal_on(device: &DeviceInfo, tree: &Arc<BallTree>, targets: &[[f32; 3]], what: &str) {
    let mut eyes: Vec<[f64; 3]> = targets.iter().step_by(targets.len() / 24).map(|eye| eye.map(f64::from)).collect();
    let beside = eyes.iter().map(|eye| [eye[0] + 0.123_456_789, eye[1] - 1e-7, eye[2] + 1.7]).collect::<Vec<_>>();
    eyes.extend(beside);
    eyes.extend(tree.balls().iter().step_by(tree.balls().len() / 4 + 1).map(|ball| ball.center.map(f64::from)));
    eyes.extend([[0.0, 0.0, 1e4], [4e6, -3e6, 200.0], [f64::NAN; 3], [1e30, 0.0, 0.0]]);
    let gpu = Arc::new(Gpu::new(Choice::Number(device.number)).unwrap());
    let prepared = gpu.prepare(tree).unwrap();
    let settled = prepared.settle_few(targets, Viewers::Eyes(&eyes), &Control::none()).unwrap().unwrap();
    let scene = MedialScene::of_tree((**tree).clone());
    let (mut decided, mut finite) = (0, 0);
    for (number, eye) in eyes.iter().enumerate() {
        for (place, target) in targets.iter().enumerate() {
            let line = settled.line(place, number);
            finite += usize::from(number + 4 < eyes.len());
            decided += usize::from(line != LineAnswer::Open);
            let sight = Viewer::Eye(*eye).line_of_sight(0, *target);
            let Some((towards, range)) = sight.filter(|_| line != LineAnswer::Open) else { continue };
            let is_blocked = scene.answer(target.map(f64::from), towards, range) == Answer::Blocked;
            assert_eq!(line == LineAnswer::Blocked, is_blocked, "{what} on {}: {target:?} to {eye:?}", device.name);
        }
    }
    // one target in 30 is very far away; eyes close to a target or to the surface of a ball leave a few more lines open
    assert!(!PLAIN.contains(&what) || decided > finite * 9 / 10, "{what}: {decided} of {finite} are decided");
    // and the questions that use them; thousands of kilometres away f64 itself errs by metres, so that these
    // differ among each other
    let near: Vec<[f32; 3]> = targets.iter().copied().filter(|target| target.iter().all(|v| v.abs() < 1e6)).collect();
    let targets = &near[..];
    let targets_in_tree = TargetTree::new(targets);
    let seen = |scene: &MedialScene| {
        let mut seen = Vec::new();
        let visit = |number: usize, place: usize| seen.push((number, place));
        scene.visible_among_each(&eyes, &targets_in_tree, &Control::none(), visit, |_| ()).unwrap();
        let viewers = [Viewer::Eye(eyes[1]), Viewer::Direction([0.6, 0.0, 0.8])];
        let answers = viewers.map(|viewer| scene.visible_from(viewer, targets, &Control::none()).unwrap());
        (seen, scene.answer_among(viewers[0], &targets_in_tree, &Control::none()).unwrap(), answers)
    };
    let (on_cpu, on_device) = (seen(&scene), seen(&scene.with_backend(gpu)));
    let by_eye =
        |seen: &[(usize, usize)], eye: usize| seen.iter().filter(|(of, _)| *of == eye).copied().collect::<Vec<_>>();
    for (number, eye) in eyes.iter().enumerate() {
        let [cpu, gpu] = [&on_cpu.0, &on_device.0].map(|seen| by_eye(seen, number));
        assert!(gpu == cpu, "{what} on {}: {eye:?} sees other targets", device.name);
    }
    assert!(on_device.1 == on_cpu.1, "{what} on {}: answers among a tree of targets", device.name);
    assert!(on_device.2 == on_cpu.2, "{what} on {}: answers of many targets", device.name);
}

#[test]
fn lines_past_random_and_hostile_balls_are_those_of_the_cpu() {
    let size = [60.0, 60.0, 15.0];
    let plain: Vec<_> = random_balls(2000, size, 2.0).collect();
    let with = |others: &[([f64; 3], f64)]| balls_of(plain.iter().chain(others).copied());
    let hostile = [
        ("random balls", with(&[]), BlockRule::carved()),
        ("a bias", with(&[]), BlockRule { bias: 0.7, ..BlockRule::default() }),
        ("balls of radius zero", balls_of(plain.iter().map(|(center, _)| (*center, 0.0))), BlockRule::carved()),
        ("a huge ball below", with(&[([0.0, 0.0, -9e6], 9e6)]), BlockRule::carved()),
        ("a ball far away", with(&[([8e6, -8e6, 5e6], 1.0)]), BlockRule::carved()),
        ("a tower of 1.5 km", with(&[([0.0, 0.0, 1500.0], 3.0)]), BlockRule::carved()),
        (
            "a scene higher than 4096 cells",
            balls_of([([0.0; 3], 1.0), ([5.0, 5.0, 4000.0], 2.0)].into_iter()),
            BlockRule::carved(),
        ),
        (
            "balls that are no numbers",
            with(&[([f64::NAN, 0.0, 0.0], 1.0), ([0.0; 3], f64::NAN), ([0.0; 3], f64::INFINITY)]),
            BlockRule::carved(),
        ),
        ("many balls", balls_of(random_balls(200_000, size, 0.4)), BlockRule::carved()),
        ("a single ball", balls_of([([0.0; 3], 20.0)].into_iter()), BlockRule::carved()),
        ("no balls", MedialBalls::default(), BlockRule::carved()),
    ];
    for device in devices_or_skip("lines_past_random_and_hostile_balls_are_those_of_the_cpu") {
        for (what, balls, rule) in &hostile {
            let open = assert_equal_on(&device, balls, rule, &targets(300, size), what);
            // the targets very far away are one in 30; their lines stay open
            assert!(!PLAIN.contains(what) || open < 0.05, "{what}: {open} of the lines stay open");
        }
    }
}

/// A scene is the same with each device, which decides nearly all lines.
fn assert_scene_is_equal(name: &str, model: &SceneModel) {
    let scene = |model: &SceneModel| model.scene(&model.rule(), UnprovenAs::Visible, &Control::none()).unwrap();
    let (low, high) = model.bounds().corners();
    // on the points' own box, with the ground at its lowest quarter
    let targets: Vec<[f32; 3]> = (0..500_u64)
        .map(|i| {
            let random = |k: u64| uniform(23, 4 * i + k);
            let up = if i % 4 == 0 { random(2) } else { 0.2 * random(2) };
            [0, 1, 2].map(|axis| {
                let share = if axis == 2 { up } else { random(axis as u64) };
                (low[axis] + share * (high[axis] - low[axis])) as f32
            })
        })
        .collect();
    let directions = SkyDirections::even(577).unwrap().directions;
    let on_cpu = scene(model).visibility_matrix(&targets, &directions, &Control::none()).unwrap();
    let free: u32 = (0..targets.len()).flat_map(|row| on_cpu.row(row)).map(|word| word.count_ones()).sum();
    assert!(free > 50_000, "{name}: {free} lines are free");
    for device in devices() {
        let gpu = Arc::new(Gpu::new(Choice::Number(device.number)).unwrap());
        let with_gpu = model.clone().with_backend(gpu.clone());
        let on_device = scene(&with_gpu).visibility_matrix(&targets, &directions, &Control::none()).unwrap();
        assert!(gpu.notes().is_empty(), "{name} on {}: {:?}", device.name, gpu.notes());
        assert!(on_device == on_cpu, "{name}: answers on {} are others than on the CPU", device.name);
        let tree = model.scene(&model.rule(), UnprovenAs::Visible, &Control::none()).unwrap();
        let open = assert_equal_on(&device, model.balls(), tree.params(), &targets, name);
        assert!(open < 0.001, "{name}: {open} of the lines stay open");
        assert_pictures_are_within(name, model, &gpu);
    }
}

#[test]
fn the_town_of_the_demo_has_the_same_answers() {
    if devices_or_skip("the_town_of_the_demo_has_the_same_answers").is_empty() {
        return;
    }
    let town = town(&TownParams { extent: 100.0, ..TownParams::default() });
    let scan = scan_airborne(&town, &AirborneParams::default());
    let mut cloud = belvedere::PointCloud::default();
    cloud.positions = (0..scan.len())
        .map(|i| [scan.x[i], scan.y[i], scan.z[i]])
        .map(|place| belvedere::cloud::to_local(place, [scan.x[0], scan.y[0], scan.z[0]]))
        .collect();
    let (model, _) = SceneModel::build(&cloud, &ModelParams::default(), &Control::none()).unwrap();
    assert_scene_is_equal("the town of the demo", &model);
}

#[test]
fn real_tiles_have_the_same_answers() {
    let test = "real_tiles_have_the_same_answers";
    if devices_or_skip(test).is_empty() {
        return;
    }
    for tile in ["delft_ahn3/ahn3_cropped_2.laz", "bresse_lidarhd/870000_6618000.subset.50mx100m.las"] {
        let Some(path) = data(test, &format!("data/{tile}")) else { continue };
        let (cloud, _) = read_cloud([&path], &ReadOptions::new(), &Control::none()).unwrap();
        let (model, _) = SceneModel::build(&cloud, &ModelParams::default(), &Control::none()).unwrap();
        assert_scene_is_equal(tile, &model);
    }
}

#[test]
fn a_device_lost_in_the_middle_loses_nothing() {
    let size = [60.0, 60.0, 15.0];
    let balls = balls_of(random_balls(2000, size, 2.0));
    let (targets, directions) = (targets(3000, size), directions());
    let scene = || MedialScene::new(&balls, &BlockRule::carved()).unwrap();
    let whole = scene().visibility_matrix(&targets, &directions, &Control::none()).unwrap();
    for device in devices_or_skip("a_device_lost_in_the_middle_loses_nothing") {
        for headings in [0, 1, 150] {
            let gpu = Arc::new(Gpu::limited(device.number, u64::MAX, Some(headings)).unwrap());
            let backed = scene().with_backend(gpu.clone());
            assert!(gpu.device().is_some());
            let matrix = backed.visibility_matrix(&targets, &directions, &Control::none()).unwrap();
            assert!(matrix == whole, "lost after {headings} directions");
            let notes = gpu.notes();
            assert!(notes.len() == 1 && notes[0].contains("the CPU does the rest"), "{notes:?}");
            assert!(gpu.device().is_none());
            // and a second question does not try again
            assert!(backed.visibility_matrix(&targets, &directions, &Control::none()).unwrap() == whole);
            assert_eq!(gpu.notes().len(), 1);
        }
    }
}

#[test]
fn a_scene_larger_than_the_buffers_of_a_device_is_tested_in_parts() {
    let size = [60.0, 60.0, 15.0];
    let balls = balls_of(random_balls(20_000, size, 1.0));
    // beside the scene, too: a part of it must not leave open what all of it would decide
    let (targets, directions) = (targets(1500, [150.0, 150.0, 15.0]), directions());
    let eyes = [[0.0, 0.0, 9.0], [-25.0, 31.0, 4.0], [90.0, 0.0, 30.0]];
    let scene = || MedialScene::new(&balls, &BlockRule::carved()).unwrap();
    let tree = Arc::new(BallTree::clone(scene().tree()));
    let share_open = |gpu: &Gpu| {
        let settled = gpu.prepare(&tree).unwrap().settle(&targets, &directions, &Control::none()).unwrap();
        let lines = (0..targets.len()).flat_map(|target| (0..directions.len()).map(move |number| (target, number)));
        lines.filter(|&(target, number)| settled.line(target, number) == LineAnswer::Open).count()
    };
    for device in devices_or_skip("a_scene_larger_than_the_buffers_of_a_device_is_tested_in_parts") {
        let whole = Arc::new(Gpu::new(Choice::Number(device.number)).unwrap());
        // 20 000 balls take 320 kB; 20 kB are enough for the targets
        let in_parts = Arc::new(Gpu::limited(device.number, 60_000, None).unwrap());
        let [open_whole, open_in_parts] = [&whole, &in_parts].map(|gpu| share_open(gpu));
        assert_eq!(open_in_parts, open_whole, "{}: a line that all balls decide is decided by parts", device.name);
        let answers = |scene: MedialScene| {
            let seen = eyes.map(|eye| scene.visible_from(Viewer::Eye(eye), &targets, &Control::none()).unwrap());
            // twice: the second question finds another part in the memory of the device
            let matrix = [(); 2].map(|()| scene.visibility_matrix(&targets, &directions, &Control::none()).unwrap());
            (seen, matrix)
        };
        let on_cpu = answers(scene());
        assert!(answers(scene().with_backend(in_parts.clone())) == on_cpu, "answers on {}", device.name);
        assert!(in_parts.notes().is_empty() && in_parts.used().is_some(), "{:?}", in_parts.notes());
        // what was finished past some parts only is not taken for finished
        let lost = Arc::new(Gpu::limited(device.number, 60_000, Some(20)).unwrap());
        assert!(answers(scene().with_backend(lost.clone())) == on_cpu, "lost on {}", device.name);
        assert_eq!(lost.notes().len(), 1, "{:?}", lost.notes());
        // buffers that not even the targets fit into
        let tiny = Arc::new(Gpu::limited(device.number, 4096, None).unwrap());
        assert!(answers(scene().with_backend(tiny.clone())) == on_cpu, "too large for {}", device.name);
        assert!(tiny.notes().iter().any(|note| note.contains("the CPU does the rest")), "{:?}", tiny.notes());
    }
}

#[test]
fn a_missing_device_is_named_and_a_missing_gpu_is_no_error() {
    let error = Gpu::new(Choice::Number(999)).unwrap_err().to_string();
    assert!(error.contains("there is no device 999"), "{error}");
    let gpu = Gpu::new(Choice::Gpu).unwrap();
    let has_gpu = devices().iter().any(|info| info.kind != belvedere_gpu::DeviceKind::Software);
    assert_eq!(gpu.device().is_some(), has_gpu);
    assert_eq!(gpu.notes().is_empty(), has_gpu, "{:?}", gpu.notes());
    // software is never taken by itself, and nothing is said about it
    let automatic = Gpu::new(Choice::Automatic).unwrap();
    assert!(automatic.device().is_none() && automatic.notes().is_empty());
}
