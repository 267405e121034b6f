//! Balls in a bounding volume hierarchy, for exact tracing of lines of sight.

use crate::blocking::{Ball, BlockRule};
use crate::ray_index::{Ray, RayIndex};
use belvedere_data::balls::{MedialBalls, NO_TOUCH};
use belvedere_data::cast::to_row;
use belvedere_data::model::TreeParts;
use belvedere_data::vector::{length, to_f32};
use belvedere_data::{Error, Parameter, Result};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;

/// Length of the ray that finds the balls around a point, metres: any will do.
pub(super) const PROBE: f64 = 1e-3;

/// Balls, the rule by which they block, and a tree of boxes around them. A backend takes its balls from here.
#[derive(Clone)]
pub struct BallTree {
    index: Arc<RayIndex>,
    balls: Arc<[Ball]>,
    /// For each ball its row among those given.
    rows: Arc<[u32]>,
    rule: BlockRule,
}

/// Margin of radii until lines are tested exactly: far more than f32 errs. Metres, a share of the size of the scene, a
/// share of the radius.
pub(super) const MARGIN: f64 = 1e-3;
const MARGIN_OF_SCENE: f64 = 1e-6;
const MARGIN_OF_RADIUS: f32 = 1e-5;

/// Within how much of a line, in f32, the middle of a ball lies that may block it, with [`BallTree::near_margin`].
#[inline(always)]
pub(super) fn near_reach(ball: Ball, margin: f32) -> f32 {
    ball.radius * (1.0 + MARGIN_OF_RADIUS) + margin
}

/// The balls that can be ordered into a tree, and their rows.
fn usable(balls: &MedialBalls, rule: &BlockRule) -> Result<(Vec<Ball>, Vec<u32>)> {
    rule.validate()?;
    balls.validate()?;
    let ball_of = |row: usize| Ball { center: balls.centers[row], radius: balls.radii[row] };
    let rows = (0..balls.len()).filter(|&row| balls.touch[row] != NO_TOUCH && ball_of(row).is_usable());
    Ok(rows.map(|row| (ball_of(row), to_row(row))).unzip())
}

impl std::fmt::Debug for BallTree {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "BallTree({} balls, {:?})", self.balls.len(), self.rule)
    }
}

impl BallTree {
    /// Orders `balls` into a tree. Those that are not bounded, or whose centre or radius is beyond
    /// [`FARTHEST`](belvedere_data::frame::FARTHEST), are left out.
    ///
    /// # Errors
    /// [`Error::LengthMismatch`] for columns of unequal length, those of
    /// [`BlockRule::validate`] and of [`RayIndex::new`].
    pub fn new(balls: &MedialBalls, rule: &BlockRule) -> Result<Self> {
        let (balls, rows) = usable(balls, rule)?;
        Self::ordered(&balls, &rows, rule)
    }

    /// Orders balls with their rows into a tree.
    fn ordered(balls: &[Ball], rows: &[u32], rule: &BlockRule) -> Result<Self> {
        let boxes: Vec<[[f32; 3]; 2]> = balls.par_iter().map(|ball| ball.bounds()).collect();
        Ok(Self::of_index(RayIndex::new(&boxes)?, balls, rows, rule))
    }

    fn of_index(index: RayIndex, balls: &[Ball], rows: &[u32], rule: &BlockRule) -> Self {
        let order = index.order();
        let balls = order.par_iter().map(|&place| balls[place as usize]).collect();
        let rows = order.iter().map(|&place| rows[place as usize]).collect();
        Self { index: Arc::new(index), balls, rows, rule: *rule }
    }

    /// The tree of boxes as numbers, for [`BallTree::from_parts`].
    pub(crate) fn to_parts(&self) -> TreeParts {
        self.index.to_parts()
    }

    /// The tree that [`BallTree::new`] makes, of the numbers of [`BallTree::to_parts`] for the same balls.
    ///
    /// # Errors
    /// Those of [`BallTree::new`]; [`Error::InvalidParameter`] for numbers that are not those of a tree of as many
    /// balls.
    pub(crate) fn from_parts(parts: TreeParts, balls: &MedialBalls, rule: &BlockRule) -> Result<Self> {
        let (balls, rows) = usable(balls, rule)?;
        Ok(Self::of_index(RayIndex::from_parts(parts, balls.len())?, &balls, &rows, rule))
    }

    /// The balls of a part of [`BallTree::balls`] as a tree of their own.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a part that the tree does not have.
    pub fn part(&self, part: Range<usize>) -> Result<Self> {
        match (self.balls.get(part.clone()), self.rows.get(part.clone())) {
            (Some(balls), Some(rows)) => Self::ordered(balls, rows, &self.rule),
            _ => Err(Error::invalid(
                Parameter::Ball,
                format!("a part of a tree: {part:?}"),
                "within the balls of the tree",
            )),
        }
    }

    /// The same balls, which block by another rule.
    ///
    /// # Errors
    /// Those of [`BlockRule::validate`].
    pub fn with_rule(&self, rule: &BlockRule) -> Result<Self> {
        rule.validate()?;
        Ok(Self { rule: *rule, ..self.clone() })
    }

    /// For each of [`BallTree::balls`] its row among the balls that the tree was made of.
    #[must_use]
    pub fn rows(&self) -> &[u32] {
        &self.rows
    }

    /// The tree of boxes; its rows are those of [`BallTree::balls`].
    #[must_use]
    pub fn index(&self) -> &RayIndex {
        &self.index
    }

    /// The balls in the order of the tree: neighbours in space are close together.
    #[must_use]
    pub fn balls(&self) -> &[Ball] {
        &self.balls
    }

    /// Returns the rule by which the balls block.
    #[must_use]
    pub fn rule(&self) -> &BlockRule {
        &self.rule
    }

    /// The ball of a row.
    #[inline]
    pub(super) fn ball(&self, row: usize) -> Ball {
        self.balls[row]
    }

    /// The line of sight from `target` along `towards`, as `BallTree::front` takes it.
    #[inline]
    pub(crate) fn ray(&self, target: [f64; 3], towards: [f64; 3], range: f64) -> Ray {
        // where the bias leaves nothing between the ends, what blocks holds the middle; below zero it reaches past both
        let bias = self.rule.bias;
        Ray { origin: target, direction: towards, ranges: [bias.min(0.5 * range), range - bias.min(0.0)] }
    }

    /// Returns the distance from its target at which a line of sight leaves the ball of a row, metres, if that ball
    /// blocks it.
    #[inline]
    pub(super) fn front(&self, row: usize, ray: &Ray) -> Option<f64> {
        self.rule.blocks_line(*self.balls.get(row)?, ray.origin, ray.direction, self.reach(ray))
    }

    /// The piece of a line of sight that the ball of a row blocks, as [`BlockRule::blocked_piece`] gives it.
    #[inline]
    pub(super) fn blocked_piece(&self, row: usize, ray: &Ray) -> Option<[f64; 2]> {
        self.rule.blocked_piece(*self.balls.get(row)?, ray.origin, ray.direction, self.reach(ray))
    }

    /// Returns the reach of a line of sight of `BallTree::ray`, metres.
    #[inline]
    fn reach(&self, ray: &Ray) -> f64 {
        ray.ranges[1] + self.rule.bias.min(0.0)
    }

    /// Returns the margin for comparing balls with lines in f32, metres: balls that far beyond their radius are tested
    /// exactly. [`near_reach`] adds a share of the radius.
    pub(super) fn near_margin(&self) -> f32 {
        to_f32(MARGIN + MARGIN_OF_SCENE * length(self.index.half_size()))
    }

    /// Returns true if a ball blocks a line of sight.
    pub(crate) fn blocks(&self, ray: &Ray) -> bool {
        self.index.any(ray, |row| self.front(row, ray).is_some())
    }

    /// Returns true if a ball blocks the line from `target` along `towards` to a picture plane or a near limit `range`
    /// metres away.
    pub(super) fn blocks_before_plane(&self, target: [f64; 3], towards: [f64; 3], range: f64) -> bool {
        let ray = Ray { origin: target, direction: towards, ranges: [self.rule.bias, range] };
        let blocks = |ball: &Ball| self.rule.blocks_before_plane(*ball, target, towards, range).is_some();
        self.index.any(&ray, |row| self.balls.get(row).is_some_and(blocks))
    }

    /// Returns true if a ball holds an end of lines of sight, so that all of them are blocked
    /// ([`BlockRule::holds_end`]).
    pub(super) fn holds_end(&self, end: [f64; 3]) -> bool {
        let holds = |row: usize| self.balls.get(row).is_some_and(|ball| self.rule.holds_end(*ball, end));
        Ray::new(end, [0.0, 0.0, 1.0], [0.0, PROBE]).is_some_and(|ray| self.index.any(&ray, holds))
    }
}
