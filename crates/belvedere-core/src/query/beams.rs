//! Many targets for one viewer at once: a tree of targets against the tree of balls.
//!
//! All lines of sight of a box of targets lie within a beam: the hull of eye and box, or for the sun the box swept
//! along the direction. Balls that the beam of a node misses are left out for all targets below it. A ball that covers
//! the whole beam answers them all; if no ball is left, all are visible. Targets at the edge of shadows and close to
//! surfaces remain, and are tested one by one against the few balls in their beam.
//!
//! The answers are those of the exact lines of sight, to the last bit. A beam leaves out only balls that no line of
//! sight in it can meet. A shadow is convex, so that a ball that hides the corners of a box hides all in it.

#[cfg(target_arch = "x86_64")]
mod avx2;
mod beam;
mod blockers;
mod lanes;
#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
mod simd128;
mod sweep;

use super::backend::{LineAnswer, Settled, Viewers};
use super::medial_scene::MedialScene;
use super::target_tree::TargetTree;
use super::{Answer, Viewer};
use crate::ray_index::Ray;
use belvedere_data::Result;
use belvedere_data::control::Control;
use rayon::prelude::*;
#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
use simd128::BeamSimd128 as BeamPlain;
use sweep::TreeSweep;

/// Scalar kernels for machines without AVX2.
#[cfg(not(all(target_arch = "wasm32", target_feature = "simd128")))]
type BeamPlain = lanes::BeamScalar<false>;

/// Targets of a subtree that one thread answers.
const SHARE: usize = 4096;

/// Calls `visit` with the places of the targets below `node` that no ball blocks.
fn search(sweep: &TreeSweep<'_>, node: usize, visit: &mut impl FnMut(usize)) {
    #[cfg(target_arch = "x86_64")]
    if avx2::search(sweep, node, visit) {
        return;
    }
    sweep.search::<BeamPlain>(node, visit);
}

impl MedialScene {
    /// Returns the answer for each target, in the order given. Answers equal those of [`super::Visibility::visible`],
    /// at a cost that grows with the border of the visible region instead of the number of targets. Targets that are
    /// not finite are [`Answer::OutsideView`], those beside or below the cloud [`Answer::OutsideCloud`].
    ///
    /// # Errors
    /// [`Error::InvalidParameter`](belvedere_data::Error::InvalidParameter) for a viewer that is not finite,
    /// [`Error::UnsupportedViewer`](belvedere_data::Error::UnsupportedViewer) for [`Viewer::Each`], and
    /// [`Error::Cancelled`](belvedere_data::Error::Cancelled).
    pub fn answer_among(&self, viewer: Viewer<'_>, targets: &TargetTree, control: &Control<'_>) -> Result<Vec<Answer>> {
        let sweep = TreeSweep::new(self, viewer, targets, control)?;
        let settled = match viewer {
            Viewer::Eye(eye) => self.settled_few(targets, Viewers::Eyes(&[eye]), control)?,
            _ => None,
        };
        let mut answers = vec![Answer::OutsideView; targets.len()];
        let subtrees = targets.subtrees(SHARE);
        let eye_outside = is_eye_outside(self, viewer);
        let answered: Vec<Vec<(u32, Answer)>> = subtrees
            .into_par_iter()
            .map(|subtree| {
                control.check()?;
                let places = targets.nodes[subtree].first..targets.nodes[subtree].first + targets.nodes[subtree].count;
                let first = places.start;
                let mut seen = vec![false; places.len()];
                match &settled {
                    Some(settled) => {
                        for (place, seen) in places.clone().zip(&mut seen) {
                            *seen = self.sees(viewer, targets.positions()[place], settled.line(place, 0));
                        }
                    }
                    None => search(&sweep, subtree, &mut |place| seen[place - first] = true),
                }
                places
                    .map(|place| {
                        let target = targets.positions()[place];
                        let answer = match viewer.sight(place, target) {
                            _ if eye_outside || self.is_outside_cloud(target.map(f64::from)) => Answer::OutsideCloud,
                            None => Answer::OutsideView,
                            Some(_) if !seen[place - first] => Answer::Blocked,
                            Some(sight) => self.answer_unblocked(sight.origin, sight.direction, sight.ranges[1]),
                        };
                        Ok((targets.rows()[place], answer))
                    })
                    .collect()
            })
            .collect::<Result<_>>()?;
        control.check()?;
        for (row, answer) in answered.into_iter().flatten() {
            answers[row as usize] = answer;
        }
        Ok(answers)
    }

    /// Calls `visit` with the place, in the order of the tree, of every target that nothing blocks. A target at the
    /// viewer itself is one of them, a target outside the cloud is not; proof by pulses is not considered. Runs on the
    /// calling thread; the places ascend.
    ///
    /// # Errors
    /// As [`MedialScene::answer_among`].
    pub fn visible_among(
        &self,
        viewer: Viewer<'_>,
        targets: &TargetTree,
        control: &Control<'_>,
        mut visit: impl FnMut(usize),
    ) -> Result<()> {
        let sweep = TreeSweep::new(self, viewer, targets, control)?;
        if !targets.nodes.is_empty() && !is_eye_outside(self, viewer) {
            search(&sweep, 0, &mut |place| {
                if !self.is_hidden_otherwise(viewer, targets.positions()[place]) {
                    visit(place);
                }
            });
        }
        control.check()
    }

    /// Calls `visit` as [`MedialScene::visible_among`] does, for each of `eyes`, local metres, one after the other;
    /// `visit` gets the number of the eye too. An eye that is not finite sees nothing. `looked` is called with the
    /// number of each eye after it.
    ///
    /// # Errors
    /// As [`MedialScene::answer_among`].
    pub fn visible_among_each(
        &self,
        eyes: &[[f64; 3]],
        targets: &TargetTree,
        control: &Control<'_>,
        mut visit: impl FnMut(usize, usize),
        looked: impl Fn(usize),
    ) -> Result<()> {
        let settled = self.settled_few(targets, Viewers::Eyes(eyes), control)?;
        for (number, &eye) in eyes.iter().enumerate() {
            control.check()?;
            let viewer = Viewer::Eye(eye);
            match &settled {
                _ if !eye.iter().all(|v| v.is_finite()) => {}
                None => self.visible_among(viewer, targets, control, |place| visit(number, place))?,
                Some(_) if is_eye_outside(self, viewer) => {}
                Some(settled) => {
                    for (place, &target) in targets.positions().iter().enumerate() {
                        let sees = self.sees(viewer, target, settled.line(place, number));
                        if sees && !self.is_hidden_otherwise(viewer, target) {
                            visit(number, place);
                        }
                    }
                }
            }
            looked(number);
        }
        Ok(())
    }

    /// Settles the targets of a tree on the backend, if that is fast.
    fn settled_few(
        &self,
        targets: &TargetTree,
        viewers: Viewers<'_>,
        control: &Control<'_>,
    ) -> Result<Option<Settled>> {
        if self.ball_count() == 0 {
            return Ok(None);
        }
        self.prepared()?.settle_few(targets.positions(), viewers, control)
    }

    /// Returns true if no ball blocks the line of sight of a target, given the state of its `line`. A target at the
    /// viewer itself is visible.
    pub(super) fn sees(&self, viewer: Viewer<'_>, target: [f32; 3], line: LineAnswer) -> bool {
        match (line, viewer.sight(0, target)) {
            (LineAnswer::Free, _) | (LineAnswer::Open, None) => true,
            (LineAnswer::Blocked, _) => false,
            (LineAnswer::Open, Some(sight)) => {
                !self.tree().blocks(&self.ray(sight.origin, sight.direction, sight.ranges[1]))
            }
        }
    }

    /// Returns true if anything but balls hides a target, or it lies outside the cloud.
    fn is_hidden_otherwise(&self, viewer: Viewer<'_>, target: [f32; 3]) -> bool {
        let is_hidden = (self.triangles().is_some() || !self.far_terrain.is_empty())
            && viewer
                .sight(0, target)
                .is_some_and(|sight| self.is_behind_others(sight.origin, sight.direction, sight.ranges[1]));
        is_hidden || self.is_outside_cloud(target.map(f64::from))
    }

    /// Returns the answer for a `target` that no ball blocks from `eye`, both local metres: visible or unproven, unless
    /// other obstacles block it. [`Answer::OutsideView`] if the two coincide.
    #[must_use]
    pub fn answer_unblocked_from(&self, eye: [f64; 3], target: [f64; 3]) -> Answer {
        match Ray::between(eye, target) {
            None => Answer::OutsideView,
            Some(sight) => self.answer_unblocked(sight.origin, sight.direction, sight.ranges[1]),
        }
    }
}

/// Returns true if a viewer is an eye beside or below the cloud.
fn is_eye_outside(scene: &MedialScene, viewer: Viewer<'_>) -> bool {
    matches!(viewer, Viewer::Eye(eye) if scene.is_outside_cloud(eye))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::blocking::BlockRule;
    use crate::medial::MedialBalls;
    use crate::query::Visibility;
    use belvedere_data::cast::to_f32;
    use belvedere_data::random::uniform;

    fn random(seed: u64, i: usize, k: u64) -> f32 {
        to_f32(uniform(seed, 8 * i as u64 + k))
    }

    /// Ground of large balls, with tiny ones over it and a few that are larger than all the rest.
    fn balls(seed: u64) -> MedialBalls {
        let mut balls = MedialBalls::default();
        for i in 0..3000 {
            let (x, y) = (60.0 * random(seed, i, 0), 60.0 * random(seed, i, 1));
            let (center, radius) = match i % 500 {
                0 => ([x, y, -3000.0 + random(seed, i, 2)], 3000.0),
                1 => ([x, 500.0 + y, 0.0], 470.0),
                n if n % 3 == 0 => ([x, y, 6.0 * random(seed, i, 2)], 0.02 + 0.6 * random(seed, i, 3)),
                _ => ([x, y, 0.3 * (0.2 * x).sin() - 2.0 + 0.05 * random(seed, i, 2)], 2.0),
            };
            balls.centers.push(center);
            balls.radii.push(radius);
        }
        balls.source = vec![0; balls.radii.len()];
        balls.touch = vec![0; balls.radii.len()];
        balls.separation_angles = vec![1.0; balls.radii.len()];
        balls
    }

    /// Few targets that lie as no shape of a beam is made for: in one place, in a line with the eye, in a plane with
    /// it, around it.
    fn odd_targets(eye: [f32; 3], seed: u64) -> Vec<Vec<[f32; 3]>> {
        let along = |i: usize, way: [f32; 3]| std::array::from_fn(|k| eye[k] + way[k] * 0.37 * i as f32);
        let scattered =
            |i: usize, size: f32| std::array::from_fn(|k| eye[k] + size * (random(seed, i, k as u64) - 0.5));
        vec![
            vec![[20.0, 21.0, 0.5]; 40],
            (0..60).map(|i| along(i, [1.0, 0.5, -0.02])).collect(),
            (0..60).map(|i| along(i, [0.0, 0.0, -0.1])).collect(),
            (0..60).map(|i| along(i, [0.0, 0.0, 1.0])).collect(),
            (0..200).map(|i| scattered(i, 0.001)).collect(),
            (0..200).map(|i| scattered(i, 3.0)).collect(),
            (0..200).map(|i| scattered(i, 90.0)).map(|[x, y, _]| [x, y, eye[2]]).collect(),
            (0..900).map(|i| [2.0 * (i % 30) as f32, 2.0 * (i / 30) as f32, 0.35]).collect(),
        ]
    }

    #[test]
    fn odd_targets_and_huge_balls_are_answered_as_single_lines() {
        let rules = [BlockRule::carved(), BlockRule::uncarved(), BlockRule { bias: -0.3, ..BlockRule::carved() }];
        // over the ground, in a ball of the ground, far away, straight above
        let eyes = [[30.0, 30.0, 2.0], [12.0, 40.0, -0.5], [-900.0, 20.0, 80.0], [30.0, 30.0, 200.0]];
        let (mut visible, mut blocked) = (0, 0);
        for (seed, rule) in (0..).zip(rules) {
            let scene = MedialScene::new(&balls(seed), &rule).unwrap();
            for eye in eyes {
                let viewers = [Viewer::Eye(eye.map(f64::from)), Viewer::Direction([0.0, 0.0, 1.0])];
                for targets in odd_targets(eye, seed) {
                    let tree = TargetTree::new(&targets);
                    for viewer in viewers {
                        let single = scene.visible(viewer, &targets).unwrap();
                        let among = scene.answer_among(viewer, &tree, &Control::none()).unwrap();
                        assert_eq!(single, among, "{rule:?} {viewer:?}");
                        visible += single.iter().filter(|&&answer| answer == Answer::Visible).count();
                        blocked += single.iter().filter(|&&answer| answer == Answer::Blocked).count();
                    }
                }
            }
        }
        assert!(visible > 1000 && blocked > 1000, "{visible} visible, {blocked} blocked");
    }
}
