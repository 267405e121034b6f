//! Balls in a tree of boxes: what exact lines of sight are traced through.

use crate::blocking::{Ball, BlockRule};
use crate::ray_index::{Ray, RayIndex};
use belvedere_data::Result;
use rayon::prelude::*;

/// Balls, the rule by which they block, and a tree of boxes around them. A backend takes its balls from here.
pub struct BallTree {
    index: RayIndex,
    balls: Vec<Ball>,
    rule: BlockRule,
}

impl BallTree {
    /// Orders `balls`, which must be [usable](Ball::is_usable), into a tree. Beside it, for each row of the tree, the place of its ball
    /// among those given.
    ///
    /// # Errors
    /// Those of [`BlockRule::validate`] and of [`RayIndex::new`].
    pub fn new(balls: &[Ball], rule: &BlockRule) -> Result<(Self, Vec<u32>)> {
        rule.validate()?;
        let boxes: Vec<[[f32; 3]; 2]> = balls.par_iter().map(Ball::bounds).collect();
        let index = RayIndex::new(&boxes)?;
        let order = index.order().to_vec();
        let balls = order.par_iter().map(|&place| balls[place as usize]).collect();
        Ok((Self { index, balls, rule: *rule }, order))
    }

    /// The tree of boxes; its rows are those of [`BallTree::balls`].
    #[must_use]
    pub fn index(&self) -> &RayIndex {
        &self.index
    }

    /// The balls in the order of the tree: what lies close together in space does so here.
    #[must_use]
    pub fn balls(&self) -> &[Ball] {
        &self.balls
    }

    /// How the balls block.
    #[must_use]
    pub fn rule(&self) -> &BlockRule {
        &self.rule
    }

    /// The ball of a row.
    #[inline]
    pub(super) fn ball(&self, row: usize) -> Ball {
        self.balls[row]
    }

    /// The line of sight from `target` along `towards`, as [`BallTree::front`] takes it.
    #[inline]
    pub(super) fn ray(&self, target: [f64; 3], towards: [f64; 3], range: f64) -> Ray {
        Ray { origin: target, direction: towards, ranges: [self.rule.bias, range] }
    }

    /// Where a line of sight leaves the ball of a row, metres from its target, if that ball blocks it.
    #[inline]
    pub(super) fn front(&self, row: usize, ray: &Ray) -> Option<f64> {
        self.rule.blocks_line(*self.balls.get(row)?, ray.origin, ray.direction, ray.ranges[1])
    }

    /// Whether any ball blocks a line of sight.
    pub(super) fn blocks(&self, ray: &Ray) -> bool {
        self.index.any(ray, |row| self.front(row, ray).is_some())
    }
}
