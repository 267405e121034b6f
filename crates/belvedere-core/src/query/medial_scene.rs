//! A union of medial balls that exact lines of sight are cut with.

use super::certified::line_in_view;
use super::{Answer, Proof, Sight, Viewer, Visibility};
use crate::depth::{Profile, SHELL_SHARE, surface_bias};
use crate::medial::{MedialBalls, NO_TOUCH};
use crate::ray_index::{Ray, RayIndex};
use belvedere_data::Result;
use belvedere_data::vector::{length, sub};
use belvedere_data::view::View;
use rayon::prelude::*;

/// Targets handed to a thread at once.
const CHUNK: usize = 1024;

/// Medial balls indexed for exact lines of sight, for any number of viewers.
///
/// A target is blocked if its line of sight to the viewer leaves a ball more than [`SceneParams::depth_bias`] on: the same rule as
/// for a depth map ([`super::query_points`]), without pixels. Balls that hold the viewer are left out for that line of
/// sight, so that one wrong ball does not blind an observer; balls that hold the target are not, but give way by
/// [`SceneParams::shell`], which depth maps know nothing of.
///
/// With pulses ([`MedialScene::with_pulses`]) a target that nothing blocks is [`Answer::Unproven`] where too much of its
/// line of sight runs through space that no pulse came near to.
pub struct MedialScene {
    pub(super) index: RayIndex,
    /// Centre and radius in the order of the index.
    pub(super) balls: Vec<([f32; 3], f32)>,
    /// Row of each of them among the balls given.
    pub(super) rows: Vec<u32>,
    pub(super) params: SceneParams,
    pub(super) proof: Option<Proof>,
}

/// How balls block lines of sight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SceneParams {
    /// Surface that stands for a ball; the cone of the paper has its tip where the line of sight through the centre leaves it.
    pub profile: Profile,
    /// How far a target may lie inside a ball, along its line of sight, and still count as visible, metres, 0 or more.
    pub depth_bias: f64,
    /// How far a ball gives way to a target near its surface, metres, 0 or more: to a target less than this inside its surface it
    /// counts with a radius smaller by this, to one outside with less of that the farther it lies, and with none of
    /// it from this distance on. Balls bulge by centimetres between the points of a surface, and what lies on that surface
    /// must not vanish in them. Never more than half the radius, so that a wire does not vanish either. Default 0. In numbers:
    /// a ball of radius r whose centre lies d from the target counts with radius r − (s − max(d − r, 0)) where |d − r| < s
    /// for s the lesser of shell and r/2; whether it holds the viewer is asked of its whole radius. Depth maps have no
    /// shell: they do not know the target when balls are drawn.
    pub shell: f64,
}

impl SceneParams {
    /// For carved balls: spheres with a shell of 0.2 m and no bias. On simulated towns of another seed than those of `docs/accuracy.md` a
    /// bias of 0.25 m instead costs 1.7 points on facades and gains 0.7 on roofs; a shell of 0.3 m gains 0.4 and costs 0.3.
    #[must_use]
    pub fn carved() -> Self {
        Self { profile: Profile::Sphere, depth_bias: 0.0, shell: 0.2 }
    }

    /// Most that a ball of this radius gives way to a target, metres.
    pub(super) fn shell_of(&self, radius: f64) -> f64 {
        self.shell.min(SHELL_SHARE * radius)
    }

    /// For balls that no pulse cut, which are seen from outside only: spheres with the bias of [`surface_bias`] and no shell.
    #[must_use]
    pub fn uncarved() -> Self {
        Self { profile: Profile::Sphere, depth_bias: surface_bias(), shell: 0.0 }
    }
}

impl Default for SceneParams {
    fn default() -> Self {
        Self { profile: Profile::Sphere, depth_bias: 0.0, shell: 0.0 }
    }
}

impl MedialScene {
    /// Indexes `balls`. Those that never shrank, or whose centre or radius is not finite, are left out.
    ///
    /// # Errors
    /// Only those of [`RayIndex::new`], which balls of finite size do not cause.
    pub fn new(balls: &MedialBalls, params: &SceneParams) -> Result<Self> {
        let usable = |&i: &usize| {
            balls.touch[i] != NO_TOUCH
                && balls.radii[i].is_finite()
                && balls.radii[i] > 0.0
                && balls.centers[i].iter().all(|v| v.is_finite())
        };
        let rows: Vec<usize> = (0..balls.len()).filter(usable).collect();
        let boxes: Vec<[[f32; 3]; 2]> = rows
            .iter()
            .map(|&i| {
                let (center, radius) = (balls.centers[i], balls.radii[i]);
                // a step outward, since the sums are rounded
                [center.map(|c| (c - radius).next_down()), center.map(|c| (c + radius).next_up())]
            })
            .collect();
        let index = RayIndex::new(&boxes)?;
        #[expect(clippy::cast_possible_truncation, reason = "balls are numbered with 32 bits")]
        let rows: Vec<u32> = index.order().iter().map(|&number| rows[number as usize] as u32).collect();
        let balls = rows.iter().map(|&row| (balls.centers[row as usize], balls.radii[row as usize])).collect();
        Ok(Self { index, balls, rows, params: *params, proof: None })
    }

    /// The same balls, which from now on tell what is proven visible from what is not.
    #[must_use]
    pub fn with_pulses(mut self, proof: Proof) -> Self {
        self.proof = Some(proof);
        self
    }

    /// The pulses that prove what is visible, where they are known.
    #[must_use]
    pub fn proof(&self) -> Option<&Proof> {
        self.proof.as_ref()
    }

    /// The answer for one line of sight from `target`, local metres, to `range` metres (infinite for a direction) along the unit
    /// vector `towards`. All numbers but the range must be finite.
    #[must_use]
    pub fn answer(&self, target: [f64; 3], towards: [f64; 3], range: f64) -> Answer {
        if self.blocked(target, towards, range) {
            return Answer::Blocked;
        }
        self.answer_unblocked(target, towards, range)
    }

    /// The same for a line of sight of which it is known that no ball blocks it.
    pub(super) fn answer_unblocked(&self, target: [f64; 3], towards: [f64; 3], range: f64) -> Answer {
        match &self.proof {
            Some(proof) if proof.is_unproven(target, towards, range) => Answer::Unproven,
            _ => Answer::Visible,
        }
    }

    /// Visible or unproven, for a line of sight from `target` along the unit vector `towards` without end of which it is known that no ball
    /// blocks it.
    #[must_use]
    pub fn answer_unblocked_towards(&self, target: [f64; 3], towards: [f64; 3]) -> Answer {
        self.answer_unblocked(target, towards, f64::INFINITY)
    }

    /// Centre and radius of the balls that can block, in no particular order.
    pub(super) fn balls(&self) -> &[([f32; 3], f32)] {
        &self.balls
    }

    /// How its balls block.
    #[must_use]
    pub fn params(&self) -> &SceneParams {
        &self.params
    }

    /// How many balls hold `eye`, local metres: these are left out of lines of sight to it.
    #[must_use]
    pub fn around_eye_count(&self, eye: [f64; 3]) -> usize {
        let holds =
            |&&(center, radius): &&([f32; 3], f32)| length(sub(center.map(f64::from), eye)) <= f64::from(radius);
        self.balls.par_iter().with_min_len(CHUNK).filter(|ball| holds(ball)).count()
    }

    /// Answers for `targets`, (M, 3) local metres, in `view`, as [`super::query_points`] gives them from its depth map, but
    /// by exact lines of sight: each ends at the picture plane, or at the near limit of a view from an eye. What lies beside the
    /// picture or beyond its limits is [`Answer::OutsideView`], and balls that reach before the plane or the limit block
    /// nothing, as those that hold a viewer. [`super::CertifiedMap`] gives the same answers faster where there are many.
    #[must_use]
    pub fn query_view(&self, view: &View, targets: &[[f32; 3]]) -> Vec<Answer> {
        let answer = |&target: &[f32; 3]| match line_in_view(view, target) {
            None => Answer::OutsideView,
            Some((towards, range)) => self.answer(target.map(f64::from), towards, range),
        };
        targets.par_iter().with_min_len(CHUNK).map(answer).collect()
    }

    /// Number of balls that can block.
    #[must_use]
    pub fn ball_count(&self) -> usize {
        self.balls.len()
    }

    /// Centre and radius of a row of the index.
    pub(super) fn ball(&self, number: usize) -> ([f32; 3], f32) {
        self.balls[number]
    }

    /// The line of sight from `target` along the unit vector `towards`, as [`MedialScene::front`] takes it.
    pub(super) fn ray(&self, target: [f64; 3], towards: [f64; 3], range: f64) -> Ray {
        Ray { origin: target, direction: towards, ranges: [self.params.depth_bias, range] }
    }

    /// Whether any ball lies between a target and its viewer at `range` along the unit vector `towards`.
    pub(super) fn blocked(&self, target: [f64; 3], towards: [f64; 3], range: f64) -> bool {
        let ray = self.ray(target, towards, range);
        self.index.any(&ray, |number| self.front(number, &ray).is_some())
    }

    /// The ball that a line of sight from `target` meets first on its way to `range` metres along the unit vector `towards`: its
    /// row among the balls given, and where the line leaves it, metres from the target. `None` where nothing blocks.
    #[must_use]
    pub fn first_block(&self, target: [f64; 3], towards: [f64; 3], range: f64) -> Option<(usize, f64)> {
        let ray = self.ray(target, towards, range);
        let (number, front) = self.index.nearest(&ray, |number| self.front(number, &ray))?;
        Some((*self.rows.get(number)? as usize, front))
    }

    /// The radius that a ball counts with for a target `distance` metres from its centre.
    pub(super) fn radius_for(&self, radius: f64, distance: f64) -> f64 {
        let shell = self.params.shell_of(radius);
        let outside = distance - radius;
        if outside.abs() < shell { radius - (shell - outside.max(0.0)) } else { radius }
    }

    /// Where a line of sight leaves ball `number`, metres from its target, if that ball blocks it.
    pub(super) fn front(&self, number: usize, ray: &Ray) -> Option<f64> {
        let &(center, radius) = self.balls.get(number)?;
        let mut radius = f64::from(radius);
        let mut along = 0.0;
        let mut square = 0.0;
        for ((center, target), towards) in center.into_iter().zip(ray.origin).zip(ray.direction) {
            let offset = f64::from(center) - target;
            along += offset * towards;
            square += offset * offset;
        }
        let beside = (square - along * along).max(0.0);
        if beside >= radius * radius {
            return None;
        }
        let whole = along + (radius * radius - beside).sqrt();
        if whole >= ray.ranges[1] {
            return None;
        }
        let whole_radius = radius;
        radius = self.radius_for(radius, square.sqrt());
        if radius < whole_radius && (radius <= 0.0 || beside >= radius * radius) {
            return None;
        }
        let front = match self.params.profile {
            Profile::Sphere => along + (radius * radius - beside).sqrt(),
            Profile::PaperCone => along + (radius - beside.sqrt()),
        };
        (front > self.params.depth_bias).then_some(front)
    }
}

impl Visibility for MedialScene {
    fn seen_from<'a>(&'a self, viewer: Viewer<'a>) -> Result<Sight<'a>> {
        viewer.validate()?;
        Ok(Box::new(move |targets| {
            viewer.validate_count(targets)?;
            let answer = |(index, &target): (usize, &[f32; 3])| match viewer.line_of_sight(index, target) {
                None => Answer::OutsideView,
                Some((towards, range)) => self.answer(target.map(f64::from), towards, range),
            };
            Ok(targets.par_iter().enumerate().with_min_len(CHUNK).map(answer).collect())
        }))
    }
}
