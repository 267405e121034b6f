//! Lines of sight parallel to one, beside it: where they disagree, it passes an edge of what is known of the scene.

use super::MedialScene;
use crate::blocking::Ball;
use crate::ray_index::{END, Ray, Visit};
use belvedere_data::vector::{cross, dot, sub, unit};
use std::f64::consts::FRAC_PI_4;

/// How far the two rings of lines run beside the line itself, metres: half a spacing and a spacing at ten pulses per
/// m². With other distances (0.08 m, and multiples of the spacing of pulses) probabilities were no better.
const RINGS: [f64; 2] = [0.16, 0.32];
/// Lines of each ring.
pub(super) const RING_LINES: usize = 8;
/// All lines, the line itself first.
const LINES: usize = 1 + RINGS.len() * RING_LINES;
/// By how much more than a ring balls may lie beside the line before they are left out, metres.
const MARGIN: f64 = 1e-3;

/// What blocks a line of sight and those beside it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ParallelLines {
    /// Whether nothing blocks the line itself.
    pub is_free: bool,
    /// How many of eight lines 0.16 m beside it are free, and of eight 0.32 m beside it.
    pub free: [u8; 2],
    /// How many of each ring are blocked because an end is inside an obstacle; 0 where all lines agree.
    pub held: [u8; 2],
}

impl ParallelLines {
    /// Whether all lines are free, or all blocked.
    #[must_use]
    pub fn agree(&self) -> bool {
        #[expect(clippy::cast_possible_truncation, reason = "eight")]
        let all = if self.is_free { RING_LINES as u8 } else { 0 };
        self.free == [all; 2]
    }
}

impl MedialScene {
    /// What blocks the line of sight from `target`, local metres, to `range` metres (infinite for a direction) along
    /// the unit vector `towards`, and lines parallel to it. All numbers but the range must be finite. The line itself is
    /// free where [`MedialScene::answer`] is not blocked.
    #[must_use]
    pub fn parallel_lines(&self, target: [f64; 3], towards: [f64; 3], range: f64) -> ParallelLines {
        let lines = self.lines_beside(target, towards, range);
        let mut left = Left { scene: self, axes: Axes::along(towards), middle: target, lines: &lines, free: ALL };
        let room = [RINGS[1] + MARGIN; 3];
        let ray = self.ray(target, towards, range);
        self.tree().index().visit_beside(&ray, room, &mut left);
        let mut free = left.free;
        for (number, line) in lines.iter().enumerate() {
            if free >> number & 1 == 1 && self.is_behind_others(line.origin, towards, range) {
                free &= !(1 << number);
            }
        }
        let in_ring = |bits: u32, ring: usize| (bits >> (1 + ring * RING_LINES) & 0xFF).count_ones();
        #[expect(clippy::cast_possible_truncation, reason = "eight at most")]
        let counts = |bits: u32| [0, 1].map(|ring| in_ring(bits, ring) as u8);
        let mut found = ParallelLines { is_free: free & 1 == 1, free: counts(free), held: [0; 2] };
        if !found.agree() {
            let is_held = |line: &Ray| {
                self.is_inside_obstacle(line.origin) || (range.is_finite() && self.is_inside_obstacle(line.at(range)))
            };
            let held = (0..).zip(&lines).filter(|(number, line)| free >> number & 1 == 0 && is_held(line));
            found.held = counts(held.fold(0, |bits, (number, _)| bits | 1_u32 << number));
        }
        found
    }

    /// The line itself, and those around it.
    fn lines_beside(&self, target: [f64; 3], towards: [f64; 3], range: f64) -> [Ray; LINES] {
        let Axes([across, up, _]) = Axes::along(towards);
        std::array::from_fn(|number| {
            let Some(beside) = number.checked_sub(1) else { return self.ray(target, towards, range) };
            let (sin, cos) = (FRAC_PI_4 * (beside % RING_LINES) as f64).sin_cos();
            let radius = RINGS[beside / RING_LINES];
            self.ray(std::array::from_fn(|i| target[i] + radius * (cos * across[i] + sin * up[i])), towards, range)
        })
    }
}

/// A bit for each line.
const ALL: u32 = (1 << LINES) - 1;

/// Two unit vectors across a direction and each other, and the direction itself.
struct Axes([[f64; 3]; 3]);

impl Axes {
    fn along(towards: [f64; 3]) -> Self {
        let across = unit(cross(towards, [0.0, 0.0, 1.0])).unwrap_or([1.0, 0.0, 0.0]);
        Self([across, cross(across, towards), towards])
    }
}

/// The lines that no ball has blocked yet.
struct Left<'a> {
    scene: &'a MedialScene,
    axes: Axes,
    middle: [f64; 3],
    lines: &'a [Ray; LINES],
    free: u32,
}

impl Left<'_> {
    /// Whether a ball may come near to any of the lines.
    fn is_near(&self, ball: Ball) -> bool {
        let offset = sub(ball.center.map(f64::from), self.middle);
        let Axes([across, up, _]) = &self.axes;
        let reach = f64::from(ball.radius) + RINGS[1] + MARGIN;
        let [x, y] = [across, up].map(|axis| dot(offset, *axis));
        x * x + y * y < reach * reach
    }
}

impl Visit for &mut Left<'_> {
    fn visit(&mut self, row: usize) -> f32 {
        if !self.is_near(self.scene.ball(row)) {
            return f32::INFINITY;
        }
        let mut open = self.free;
        while open != 0 {
            let number = open.trailing_zeros();
            open &= open - 1;
            if self.scene.front(row, &self.lines[number as usize]).is_some() {
                self.free &= !(1 << number);
            }
        }
        if self.free == 0 { END } else { f32::INFINITY }
    }
}
