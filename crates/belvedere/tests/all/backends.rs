//! Backends: whatever one leaves open, the answers are the same bits.

use belvedere::Error;
use belvedere::blocking::BlockRule;
use belvedere::control::{Control, Watcher};
use belvedere::depth::{DepthBounds, ItemBuffer, Profile, depth_map};
use belvedere::medial::MedialBalls;
use belvedere::pulses::{FreeSegmentParams, FreeSegments};
use belvedere::query::certified::CertifiedMap;
use belvedere::query::target_tree::TargetTree;
use belvedere::query::{
    Answer, Backend, BallTree, Cpu, EarthParams, LineAnswer, MedialScene, PreparedBackend, Proof, ProofParams, Scope,
    Settled, Viewer, Visibility, VisibilityMatrix, random_pairs, random_targets,
};
use belvedere::random::uniform;
use belvedere::raster::Raster;
use belvedere::vector::unit;
use belvedere::view::View;
use std::sync::Arc;

/// A backend that knows less than the processor: of every so many lines and pixels it knows nothing.
#[derive(Debug)]
struct Forgetful {
    share_open: f64,
}

struct ForgetfulBalls {
    inner: Box<dyn PreparedBackend>,
    share_open: f64,
}

impl Backend for Forgetful {
    fn prepare(&self, balls: &Arc<BallTree>) -> belvedere::Result<Box<dyn PreparedBackend>> {
        Ok(Box::new(ForgetfulBalls { inner: Cpu.prepare(balls)?, share_open: self.share_open }))
    }
}

impl PreparedBackend for ForgetfulBalls {
    fn depth(&self, view: &View, start: f64, control: &Control<'_>) -> belvedere::Result<DepthBounds> {
        let sure = self.inner.depth(view, start, control)?;
        let [width, height] = view.size_px;
        let pixel = |(number, bounds): (usize, &[f32; 2])| match uniform(3, number as u64) {
            random if random < self.share_open => [f32::NEG_INFINITY, f32::INFINITY],
            _ => *bounds,
        };
        let bounds = sure.bounds.values().iter().enumerate().map(pixel).collect();
        Ok(DepthBounds { view: *view, bounds: Raster::from_values(width, height, bounds)? })
    }

    fn settle(
        &self,
        targets: &[[f32; 3]],
        directions: &[[f64; 3]],
        control: &Control<'_>,
    ) -> belvedere::Result<Settled> {
        let sure = self.inner.settle(targets, directions, control)?;
        let mut settled = Settled::new(targets.len(), directions.len());
        for target in 0..targets.len() {
            for direction in 0..directions.len() {
                let number = (target * directions.len() + direction) as u64;
                let line =
                    if uniform(8, number) < self.share_open { LineAnswer::Open } else { sure.line(target, direction) };
                settled.set(target, direction, line);
            }
        }
        Ok(settled)
    }
}

fn town(count: u64) -> MedialBalls {
    let random = |i: u64, k: u64| uniform(2, 8 * i + k) as f32;
    let ball = |i: u64| {
        let (x, y) = (60.0 * random(i, 0), 60.0 * random(i, 1));
        match i % 3 {
            0 => ([x, y, -2.0], 2.0),
            1 => ([(x / 20.0).floor() * 20.0 + 6.0 * random(i, 2), y, 8.0 * random(i, 3)], 0.4 + 2.5 * random(i, 4)),
            _ => ([x, y, 9.0 * random(i, 3)], 0.1 + 0.2 * random(i, 4)),
        }
    };
    let (centers, radii): (Vec<_>, Vec<_>) = (0..count).map(ball).unzip();
    let count = radii.len();
    MedialBalls { centers, radii, source: vec![0; count], touch: vec![0; count], separation_angles: vec![1.0; count] }
}

fn directions(count: u64) -> Vec<[f64; 3]> {
    let direction = |i: u64| {
        let random = |k: u64| uniform(7, 4 * i + k);
        unit([random(0) - 0.5, random(1) - 0.5, 0.7 * random(2) - 0.05])
    };
    (0..count).filter_map(direction).collect()
}

fn targets(count: usize) -> Vec<[f32; 3]> {
    let mut targets = random_targets([-2.0, -2.0, -0.2], [62.0, 62.0, 10.0], count, 5);
    targets[3] = [f32::INFINITY, 0.0, 0.0];
    targets
}

fn scene(rule: &BlockRule) -> MedialScene {
    MedialScene::new(&town(3000), rule).unwrap()
}

#[test]
fn whatever_a_backend_leaves_open_the_matrix_is_the_same() {
    let (targets, directions) = (targets(1500), directions(40));
    for rule in [BlockRule::carved(), BlockRule { bias: 0.3, ..BlockRule::default() }] {
        let exact = scene(&rule);
        let one_by_one: Vec<Vec<Answer>> = directions
            .iter()
            .map(|&direction| exact.visible(Viewer::Direction(direction), &targets).unwrap())
            .collect();
        for share_open in [0.0, 0.4, 1.0] {
            let backed = scene(&rule).with_backend(Arc::new(Forgetful { share_open }));
            let matrix = backed.visibility_matrix(&targets, &directions, &Control::none()).unwrap();
            for (direction, answers) in one_by_one.iter().enumerate() {
                for (target, answer) in answers.iter().enumerate() {
                    let is_free = *answer == Answer::Visible;
                    assert_eq!(matrix.is_free(target, direction), is_free, "{share_open} open, {rule:?}");
                }
            }
        }
    }
}

#[test]
fn whatever_a_backend_leaves_open_views_show_the_same() {
    let targets = targets(20_000);
    let view = View::parallel([-0.48, -0.6, -0.64], [0.0; 3], [60.0, 60.0, 10.0], 1.0).unwrap();
    let around = View::panorama([30.0, 31.0, 4.0], 64).unwrap();
    let exact = scene(&BlockRule::carved());
    for share_open in [0.3, 1.0] {
        let backed = scene(&BlockRule::carved()).with_backend(Arc::new(Forgetful { share_open }));
        for (views, viewer) in
            [(vec![view], Viewer::Direction([0.48, 0.6, 0.64])), (around.to_vec(), Viewer::Eye([30.0, 31.0, 4.0]))]
        {
            let map = CertifiedMap::new(&backed, &views, Scope::Viewer, &Control::none()).unwrap();
            let (answers, report) = map.answers(&targets, &Control::none()).unwrap();
            assert_eq!(answers, exact.visible(viewer, &targets).unwrap());
            // every other target lies in a pixel of which the backend knows
            assert!(share_open < 1.0 || report.settled_count < 10, "{report:?}");
        }
    }
}

#[test]
fn balls_made_ready_once_give_the_bits_of_balls_made_ready_anew() {
    let (targets, directions) = (targets(1500), directions(40));
    let rule = BlockRule::carved();
    let kept = scene(&rule);
    let whole = kept.visibility_matrix(&targets, &directions, &Control::none()).unwrap();
    let anew = |targets: &[[f32; 3]], directions: &[[f64; 3]]| -> VisibilityMatrix {
        scene(&rule).visibility_matrix(targets, directions, &Control::none()).unwrap()
    };
    assert!(whole == anew(&targets, &directions));
    // blocks of targets and fewer directions, tested with the prepared scene
    for (number, block) in targets.chunks(400).enumerate() {
        let rows = kept.visibility_matrix(block, &directions, &Control::none()).unwrap();
        assert!((0..block.len()).all(|row| rows.row(row) == whole.row(400 * number + row)), "block {number}");
    }
    let few = kept.visibility_matrix(&targets, &directions[..5], &Control::none()).unwrap();
    assert!(few == anew(&targets, &directions[..5]));
}

#[test]
fn many_targets_of_an_eye_are_answered_as_one_by_one() {
    let targets = targets(12_000);
    let scene = scene(&BlockRule::carved());
    for viewer in [Viewer::Eye([30.0, 31.0, 1.7]), Viewer::Direction([0.6, 0.0, 0.8])] {
        let one_by_one = scene.visible(viewer, &targets).unwrap();
        assert_eq!(scene.visible_from(viewer, &targets, &Control::none()).unwrap(), one_by_one);
        assert!(one_by_one.contains(&Answer::Blocked) && one_by_one.contains(&Answer::Visible));
    }
}

#[test]
fn pulses_that_are_indexed_when_needed_prove_the_same() {
    let count = 4000;
    let random = |i: u64, k: u64| uniform(12, 4 * i + k) as f32;
    // a field with a hole that no pulse reached
    let returns: Vec<[f32; 3]> = (0..count)
        .map(|i| [60.0 * random(i, 0), 60.0 * random(i, 1), 0.0])
        .filter(|p| (p[0] - 30.0).hypot(p[1] - 30.0) > 8.0)
        .collect();
    let scanner = vec![[30.0, 10.0, 500.0]; returns.len()];
    let (free_segments, _) =
        FreeSegments::new(&returns, &scanner, &FreeSegmentParams::default(), &Control::none()).unwrap();
    let columns = free_segments.to_columns();
    let params = ProofParams::default();
    let at_once = Proof::new(FreeSegments::from_columns(&columns, &Control::none()).unwrap(), &params).unwrap();
    let when_needed = Proof::from_columns(columns.clone(), &params).unwrap();
    assert_eq!(at_once.nearness().to_bits(), when_needed.nearness().to_bits());
    let targets = random_targets([0.0, 0.0, 0.1], [60.0, 60.0, 3.0], 3000, 4);
    let empty = |proof| MedialScene::new(&MedialBalls::default(), &BlockRule::default()).unwrap().with_pulses(proof);
    let viewer = Viewer::Eye([5.0, 30.0, 1.5]);
    // all threads at once are the first to need the index
    let found = empty(when_needed).visible(viewer, &targets).unwrap();
    assert_eq!(found, empty(at_once).visible(viewer, &targets).unwrap());
    assert!(found.contains(&Answer::Unproven) && found.contains(&Answer::Visible));
    let mut broken = columns;
    broken.slopes.pop();
    assert!(matches!(Proof::from_columns(broken, &params), Err(Error::LengthMismatch { .. })));
}

struct AlwaysCancelled;

impl Watcher for AlwaysCancelled {
    fn is_cancelled(&self) -> bool {
        true
    }
}

#[test]
fn what_is_cancelled_stops() {
    let control = Control::new(&AlwaysCancelled);
    let (targets, directions) = (targets(500), directions(20));
    let balls = town(3000);
    let scene = scene(&BlockRule::carved());
    let view = View::parallel([0.0, 0.0, -1.0], [0.0; 3], [60.0, 60.0, 10.0], 0.5).unwrap();
    let eye = Viewer::Eye([30.0, 31.0, 1.7]);
    let earth = EarthParams::default();
    let tree = TargetTree::new(&targets);
    let errors = [
        depth_map(&balls, &view, Profile::Sphere, ItemBuffer::With, &control).err(),
        scene.visibility_matrix(&targets, &directions, &control).err(),
        scene.visible_from(eye, &targets, &control).err(),
        scene.visible_in_views(&[view], Scope::View, &targets, &control).err(),
        CertifiedMap::new(&scene, &[view], Scope::View, &control).err(),
        scene.answer_among(eye, &tree, &control).err(),
        scene.visible_among(eye, &tree, &control, |_| ()).err(),
        scene.lines_of_sight(&random_pairs([0.0; 3], [60.0; 3], 50, 1), &earth, &control).err(),
        scene.skyline([30.0, 31.0, 1.7], 36, &earth, &control).err(),
        scene.query_view(&view, &targets, &control).err(),
    ];
    assert!(errors.iter().all(|error| matches!(error, Some(Error::Cancelled))), "{errors:?}");
    // and a query that was stopped can be repeated
    assert!(scene.visibility_matrix(&targets, &directions, &Control::none()).is_ok());
}
