//! A union of medial balls that exact lines of sight are cut with.

use super::backend::{Backend, PreparedBackend};
use super::ball_tree::BallTree;
use super::blocker::nearest_blocker;
use super::cpu::Cpu;
use super::far_terrain::FarTerrain;
use super::lazy::Lazy;
use super::proof::freed_space::{FreedSpace, pieces_outside};
use super::triangles::{BlockingTriangles, LineEnds};
use super::view_line::{LineEnd, LineInView, line_in_view, viewer_of};
use super::{Answer, Blocker, Coverage, Proof, Sight, Viewer, Visibility};
use crate::blocking::{Ball, BlockRule};
use crate::medial::MedialBalls;
use crate::ray_index::Ray;
use belvedere_data::control::Control;
use belvedere_data::view::View;
use belvedere_data::{Error, Result};
use rayon::prelude::*;
use std::sync::Arc;

/// Targets handed to a thread at once.
const CHUNK: usize = 1024;

/// Medial balls indexed for exact lines of sight, for any number of viewers.
///
/// A target is blocked if its line of sight to the viewer runs through a ball more than [`BlockRule::bias`] metres from
/// both ends. Balls give way to both ends by [`BlockRule::shell`], so that a ball that bulges a little neither blinds
/// an observer nor hides a target. Depth maps ([`super::query_points`]) do not. The two ends of a line can change
/// places.
///
/// Ends that lie deeper in a ball are inside an obstacle: all their lines of sight are blocked, and
/// [`MedialScene::mark_inside_obstacles`] marks them.
///
/// With pulses ([`MedialScene::with_pulses`]) a target that nothing blocks is [`Answer::Unproven`] where too much of
/// its line of sight runs through space that no pulse came near to.
///
/// Triangles of added meshes and of surface patches ([`MedialScene::with_triangles`]) block too, exactly. They do not
/// change which space inside and around them is proven.
///
/// With a coverage ([`MedialScene::with_coverage`]) targets beside or below the cloud are [`Answer::OutsideCloud`].
pub struct MedialScene {
    tree: Arc<BallTree>,
    pub(super) proof: Option<Proof>,
    coverage: Option<Coverage>,
    triangles: Option<BlockingTriangles>,
    pub(super) freed: Vec<FreedSpace>,
    pub(super) far_terrain: FarTerrain,
    backend: Arc<dyn Backend>,
    prepared: Lazy<Box<dyn PreparedBackend>>,
}

impl MedialScene {
    /// Indexes `balls`.
    ///
    /// # Errors
    /// Those of [`BallTree::new`].
    pub fn new(balls: &MedialBalls, rule: &BlockRule) -> Result<Self> {
        Ok(Self::of_tree(BallTree::new(balls, rule)?))
    }

    /// The scene of balls that are in a tree already.
    #[must_use]
    pub fn of_tree(tree: BallTree) -> Self {
        let tree = Arc::new(tree);
        Self {
            tree,
            proof: None,
            coverage: None,
            triangles: None,
            freed: Vec::new(),
            far_terrain: FarTerrain::default(),
            backend: Arc::new(Cpu),
            prepared: Lazy::new(),
        }
    }

    /// The same balls, whose lines of sight are settled in bulk by another backend. Answers stay the same.
    #[must_use]
    pub fn with_backend(mut self, backend: Arc<dyn Backend>) -> Self {
        self.backend = backend;
        self.prepared = Lazy::new();
        self
    }

    /// The balls in their tree, and how they block.
    #[must_use]
    pub fn tree(&self) -> &BallTree {
        &self.tree
    }

    /// The balls as the backend made them ready.
    ///
    /// # Errors
    /// Those of [`Backend::prepare`].
    pub fn prepared(&self) -> Result<&dyn PreparedBackend> {
        self.prepared.get_or_make(|| self.backend.prepare(&self.tree)).map(AsRef::as_ref)
    }

    /// The same balls, with proven and unproven lines of sight separated.
    #[must_use]
    pub fn with_pulses(mut self, proof: Proof) -> Self {
        self.proof = Some(proof);
        self
    }

    /// The same balls, of which it is known over which space the cloud lies that they were made from.
    #[must_use]
    pub fn with_coverage(mut self, coverage: Option<Coverage>) -> Self {
        self.coverage = coverage;
        self
    }

    /// The same balls, beside which `triangles` block.
    #[must_use]
    pub fn with_triangles(mut self, triangles: Option<BlockingTriangles>) -> Self {
        self.triangles = triangles;
        self
    }

    /// The triangles that block beside the balls, if there are any.
    #[must_use]
    pub fn triangles(&self) -> Option<&BlockingTriangles> {
        self.triangles.as_ref()
    }

    /// The same balls, of which it is known that all of `freed` is free whatever pulses say.
    #[must_use]
    pub fn with_freed(mut self, freed: &[FreedSpace]) -> Self {
        self.freed = freed.to_vec();
        self
    }

    /// The same balls before far terrain: every direction below its horizon is blocked. Of lines of sight that end, its
    /// raster blocks those that leave the cloud ([`MedialScene::line_of_sight`]).
    #[must_use]
    pub fn with_far_terrain(mut self, far_terrain: FarTerrain) -> Self {
        self.far_terrain = far_terrain;
        self
    }

    /// Returns the terrain beyond the cloud, as far as it was given.
    #[must_use]
    pub fn far_terrain(&self) -> &FarTerrain {
        &self.far_terrain
    }

    /// Returns the length of a line of sight that `proof` does not prove, metres: [`Proof::unproven_length`] outside
    /// the freed space.
    pub(super) fn unproven_length(&self, proof: &Proof, target: [f64; 3], towards: [f64; 3], range: f64) -> f64 {
        let pieces = self.pieces_outside_freed(target, towards, range);
        pieces.map(|(from, piece)| proof.unproven_length(from, towards, piece)).sum()
    }

    /// About the same, or `enough` or more: [`Proof::sampled_unproven_length`].
    pub(super) fn sampled_unproven_length(
        &self,
        proof: &Proof,
        (target, towards, range): ([f64; 3], [f64; 3], f64),
        enough: f64,
    ) -> f64 {
        let pieces = self.pieces_outside_freed(target, towards, range);
        pieces.map(|(from, piece)| proof.sampled_unproven_length(from, towards, piece, enough)).sum()
    }

    /// Returns the start and length of each piece of a line of sight outside the freed space.
    fn pieces_outside_freed(
        &self,
        target: [f64; 3],
        towards: [f64; 3],
        range: f64,
    ) -> impl Iterator<Item = ([f64; 3], f64)> {
        let ray = Ray { origin: target, direction: towards, ranges: [0.0, range] };
        pieces_outside(&self.freed, &ray).into_iter().map(move |[from, to]| (ray.at(from), to - from))
    }

    /// Over which space the cloud lies, where that is known.
    #[must_use]
    pub fn coverage(&self) -> Option<&Coverage> {
        self.coverage.as_ref()
    }

    /// Returns true if an end of lines of sight, local metres, lies inside an obstacle: deeper in a ball than the ball
    /// gives way ([`BlockRule::holds_end`]). Nothing is visible from there or to there.
    #[must_use]
    pub fn is_inside_obstacle(&self, end: [f64; 3]) -> bool {
        self.tree.holds_end(end)
    }

    /// Makes those of `answers`, (M,), of `targets`, (M, 3) local metres, seen by `viewer`, that are
    /// [`Answer::Blocked`] because the target or the eye is inside an obstacle [`Answer::InsideObstacle`].
    ///
    /// # Errors
    /// [`Error::LengthMismatch`] for lists of unequal length, and [`Error::Cancelled`].
    pub fn mark_inside_obstacles(
        &self,
        viewer: Viewer<'_>,
        targets: &[[f32; 3]],
        answers: &mut [Answer],
        control: &Control<'_>,
    ) -> Result<()> {
        if answers.len() != targets.len() {
            let (expected, found) = (targets.len(), answers.len());
            return Err(Error::LengthMismatch { what: "answers of targets", expected, found });
        }
        viewer.validate_count(targets)?;
        let is_eye_inside = matches!(viewer, Viewer::Eye(eye) if self.is_inside_obstacle(eye));
        let each_eye = |number: usize| match viewer {
            Viewer::Each(eyes) => eyes.get(number).map(|eye| eye.map(f64::from)),
            _ => None,
        };
        let chunks = answers.par_chunks_mut(CHUNK).zip(targets.par_chunks(CHUNK)).enumerate();
        chunks.try_for_each(|(chunk, (answers, targets))| {
            control.check()?;
            for (i, (answer, &target)) in answers.iter_mut().zip(targets).enumerate() {
                if *answer == Answer::Blocked
                    && (is_eye_inside
                        || self.is_inside_obstacle(target.map(f64::from))
                        || each_eye(chunk * CHUNK + i).is_some_and(|eye| self.is_inside_obstacle(eye)))
                {
                    *answer = Answer::InsideObstacle;
                }
            }
            Ok(())
        })
    }

    /// Returns true if a position, local metres, lies beside or below the cloud, so that no line of sight ends there
    /// ([`Coverage::holds_end`]). Lines may end in the air beside the cloud and above all of it.
    #[must_use]
    pub fn is_outside_cloud(&self, position: [f64; 3]) -> bool {
        self.coverage.is_some_and(|coverage| !coverage.holds_end(position))
    }

    /// `answers` of `targets`, with those of targets outside the cloud replaced by [`Answer::OutsideCloud`].
    pub(super) fn marked(&self, viewer: Viewer<'_>, targets: &[[f32; 3]], mut answers: Vec<Answer>) -> Vec<Answer> {
        if let Some(coverage) = &self.coverage {
            coverage.mark_outside(viewer, targets, &mut answers);
        }
        answers
    }

    /// The pulses that prove lines of sight free, where they are known.
    #[must_use]
    pub fn proof(&self) -> Option<&Proof> {
        self.proof.as_ref()
    }

    /// The answer for one line of sight from `target`, local metres, to `range` metres (infinite for a direction) along
    /// the unit vector `towards`. All numbers but the range must be finite.
    #[must_use]
    pub fn answer(&self, target: [f64; 3], towards: [f64; 3], range: f64) -> Answer {
        // the triangles first: they are far fewer than balls, and block much of what balls block
        if self.is_behind_triangles(target, towards, range) || self.tree.blocks(&self.tree.ray(target, towards, range))
        {
            return Answer::Blocked;
        }
        self.answer_free(target, towards, range)
    }

    /// Returns the answer of [`MedialScene::answer`] for a line that ends at a viewer. At a picture plane or a near
    /// limit, balls that reach past it block nothing.
    pub(super) fn answer_of(&self, line: &LineInView) -> Answer {
        let &LineInView { sight: Ray { origin, direction, ranges: [_, range] }, end } = line;
        let is_blocked = match end {
            LineEnd::Viewer => self.tree.blocks(&self.tree.ray(origin, direction, range)),
            LineEnd::Plane => self.tree.blocks_before_plane(origin, direction, range),
        };
        if is_blocked { Answer::Blocked } else { self.answer_unblocked(origin, direction, range) }
    }

    /// The answer for a line of sight of which it is known that no ball blocks it.
    pub(super) fn answer_unblocked(&self, target: [f64; 3], towards: [f64; 3], range: f64) -> Answer {
        match self.is_behind_triangles(target, towards, range) {
            true => Answer::Blocked,
            false => self.answer_free(target, towards, range),
        }
    }

    /// The answer for a line of sight of which it is known that neither a ball nor a triangle blocks it.
    fn answer_free(&self, target: [f64; 3], towards: [f64; 3], range: f64) -> Answer {
        if self.is_behind_terrain(target, towards, range) {
            return Answer::Blocked;
        }
        if self.is_unproven(target, towards, range) { Answer::Unproven } else { Answer::Visible }
    }

    /// Returns true if too much of a line runs through space that no pulse came near to. The line starts at `target`,
    /// local metres, and runs `range` metres (may be infinite) along the unit vector `towards`. False if pulses are not
    /// known. Obstacles on the line are not considered.
    #[must_use]
    pub fn is_unproven(&self, target: [f64; 3], towards: [f64; 3], range: f64) -> bool {
        self.proof.as_ref().is_some_and(|proof| {
            proof.is_unproven(target, towards, range)
                && (self.freed.is_empty() || self.unproven_length(proof, target, towards, range) > proof.tolerance())
        })
    }

    /// Returns the answer for a line of sight from `target` along the unit vector `towards` without end that no ball
    /// blocks. It is visible, unproven, or blocked by a triangle or by far terrain.
    #[must_use]
    pub fn answer_unblocked_towards(&self, target: [f64; 3], towards: [f64; 3]) -> Answer {
        self.answer_unblocked(target, towards, f64::INFINITY)
    }

    /// Returns the rule by which its balls block.
    #[must_use]
    pub fn params(&self) -> &BlockRule {
        self.tree.rule()
    }

    /// Returns the number of balls that hold `eye`, local metres: they give way to it, or it is inside an obstacle.
    #[must_use]
    pub fn around_eye_count(&self, eye: [f64; 3]) -> usize {
        self.tree.balls().par_iter().with_min_len(CHUNK).filter(|ball| ball.depth_of(eye) >= 0.0).count()
    }

    /// The answer for each of `targets`, (M, 3) local metres, seen by `viewer`, by an exact line of sight; the cloud is
    /// not considered.
    pub(super) fn answer_each(
        &self,
        viewer: Viewer<'_>,
        targets: &[[f32; 3]],
        control: &Control<'_>,
    ) -> Result<Vec<Answer>> {
        self.answer_by(targets, control, |number, target| {
            let Ray { origin, direction, ranges: [_, range] } = viewer.sight(number, target)?;
            Some(self.answer(origin, direction, range))
        })
    }

    /// Evaluates `answer_of` for each of `targets`, (M, 3) local metres, and its index; `None` gives outside the view.
    pub(super) fn answer_by(
        &self,
        targets: &[[f32; 3]],
        control: &Control<'_>,
        answer_of: impl Fn(usize, [f32; 3]) -> Option<Answer> + Sync,
    ) -> Result<Vec<Answer>> {
        let mut answers = vec![Answer::OutsideView; targets.len()];
        let chunks = answers.par_chunks_mut(CHUNK).zip(targets.par_chunks(CHUNK)).enumerate();
        chunks.try_for_each(|(chunk, (answers, targets))| {
            control.check()?;
            for (i, (answer, &target)) in answers.iter_mut().zip(targets).enumerate() {
                *answer = answer_of(chunk * CHUNK + i, target).unwrap_or(Answer::OutsideView);
            }
            control.advance(targets.len());
            Ok(())
        })?;
        Ok(answers)
    }

    /// Returns answers for `targets`, (M, 3) local metres, in `view`, as [`super::query_points`] does from its depth
    /// map, but by exact lines of sight. Each ends at the picture plane, or at the near limit of a view from an eye.
    /// Targets beside the picture or beyond its limits are [`Answer::OutsideView`]. Balls that reach before the plane
    /// or the limit block nothing. [`MedialScene::visible_in_views`] returns the same answers, faster for many targets.
    ///
    /// # Errors
    /// [`Error::Cancelled`].
    pub fn query_view(&self, view: &View, targets: &[[f32; 3]], control: &Control<'_>) -> Result<Vec<Answer>> {
        let answer = |_, target: [f32; 3]| Some(self.answer_of(&line_in_view(view, target)?));
        let answers = self.answer_by(targets, control, answer)?;
        Ok(self.marked(viewer_of(view), targets, answers))
    }

    /// Number of balls that can block.
    #[must_use]
    pub fn ball_count(&self) -> usize {
        self.tree.balls().len()
    }

    /// Number of triangles of surface patches.
    #[must_use]
    pub fn patch_count(&self) -> usize {
        let triangles = self.triangles().into_iter().flat_map(BlockingTriangles::triangles);
        triangles.filter(|(_, blocker)| blocker.patch().is_some()).count()
    }

    /// The ball of a row of the index.
    pub(super) fn ball(&self, number: usize) -> Ball {
        self.tree.ball(number)
    }

    /// The line of sight from `target` along the unit vector `towards`, as [`MedialScene::front`] takes it.
    pub(super) fn ray(&self, target: [f64; 3], towards: [f64; 3], range: f64) -> Ray {
        self.tree.ray(target, towards, range)
    }

    /// Returns the first obstacle of a line of sight from `target` to `range` metres along the unit vector `towards`,
    /// and the distance from the target at which the line leaves it, metres. `None` if nothing blocks.
    #[must_use]
    pub fn first_block(&self, target: [f64; 3], towards: [f64; 3], range: f64) -> Option<(Blocker, f64)> {
        let ray = self.ray(target, towards, range);
        let ball = self.tree.index().nearest(&ray, |number| self.front(number, &ray));
        let ball = ball.and_then(|(number, front)| Some((self.blocker_of_ball(number)?, front)));
        let ends = LineEnds { target, viewer: range.is_finite().then(|| ray.at(range)) };
        let line = Ray { ranges: [0.0, range], ..ray };
        nearest_blocker(ball, self.triangles().and_then(|triangles| triangles.nearest(&line, &ends)))
    }

    /// Returns true if anything but balls blocks a line of sight: a triangle, or far terrain.
    #[inline]
    pub(super) fn is_behind_others(&self, target: [f64; 3], towards: [f64; 3], range: f64) -> bool {
        self.is_behind_triangles(target, towards, range) || self.is_behind_terrain(target, towards, range)
    }

    #[inline]
    fn is_behind_triangles(&self, target: [f64; 3], towards: [f64; 3], range: f64) -> bool {
        self.triangles().is_some_and(|triangles| triangles.blocks(target, towards, range))
    }

    #[inline]
    fn is_behind_terrain(&self, target: [f64; 3], towards: [f64; 3], range: f64) -> bool {
        range == f64::INFINITY && self.far_terrain.hides(target, towards)
    }

    /// The ball of a row of the index as a blocker.
    pub(super) fn blocker_of_ball(&self, number: usize) -> Option<Blocker> {
        self.tree.rows().get(number).map(|&row| Blocker::Ball(row as usize))
    }

    /// Returns the distance from its target at which a line of sight leaves ball `number`, metres, if that ball blocks
    /// it.
    #[inline]
    pub(super) fn front(&self, number: usize, ray: &Ray) -> Option<f64> {
        self.tree.front(number, ray)
    }
}

impl Visibility for MedialScene {
    fn seen_from<'a>(&'a self, viewer: Viewer<'a>) -> Result<Sight<'a>> {
        viewer.validate()?;
        Ok(Box::new(move |targets| {
            viewer.validate_count(targets)?;
            Ok(self.marked(viewer, targets, self.answer_each(viewer, targets, &Control::none())?))
        }))
    }
}
