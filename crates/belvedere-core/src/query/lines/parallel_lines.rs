//! Lines of sight parallel to one, beside it: if their answers differ, it passes an edge of an obstacle.

use crate::query::MedialScene;
use crate::query::ball_tree::{MARGIN, near_reach};
use crate::ray_index::{END, Ray, Visit};
use belvedere_data::vector::{cross, dot, sub, to_f32, unit};
use std::f64::consts::FRAC_PI_4;

/// Radii of the two rings of lines around the line itself, metres: half a spacing and a spacing at ten pulses per m². A
/// third ring at 0.08 m made probabilities no better.
const RINGS: [f64; 2] = [0.16, 0.32];
/// Lines of each ring.
pub(in crate::query) const RING_LINES: usize = 8;
/// All lines, the line itself first.
const LINES: usize = 1 + RINGS.len() * RING_LINES;
/// Slots for lines, a multiple of those that are tested at once.
const SLOTS: usize = 24;

/// Obstruction of a line of sight and of the lines beside it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ParallelLines {
    /// True if nothing blocks the line itself.
    pub is_free: bool,
    /// Numbers of free lines among the eight at 0.16 m and the eight at 0.32 m.
    pub free: [u8; 2],
    /// Number of lines of each ring that are blocked because an end is inside an obstacle; 0 if all lines agree.
    pub held: [u8; 2],
}

impl ParallelLines {
    /// Returns true if all lines are free, or all blocked.
    #[must_use]
    pub fn agree(&self) -> bool {
        #[expect(clippy::cast_possible_truncation, reason = "eight")]
        let all = if self.is_free { RING_LINES as u8 } else { 0 };
        self.free == [all; 2]
    }
}

/// Lines, of a line of sight and those beside it, that one part of a scene blocks. Parts are added up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BlockedLines {
    /// A bit for each line that is free, the line itself first.
    free: u32,
    /// The same for those of which an end is inside an obstacle.
    held: u32,
}

impl BlockedLines {
    /// No line blocked.
    pub const NONE: Self = Self { free: ALL, held: 0 };
    /// Maximum distance of the lines from the line of sight, metres.
    pub const WIDTH: f64 = RINGS[1];

    /// Returns true if an end of the line itself is inside an obstacle.
    #[must_use]
    pub fn is_inside_obstacle(self) -> bool {
        self.held & 1 == 1
    }

    /// Counts the free lines of each ring.
    #[must_use]
    pub fn lines(self) -> ParallelLines {
        let in_ring = |bits: u32, ring: usize| (bits >> (1 + ring * RING_LINES) & 0xFF).count_ones();
        #[expect(clippy::cast_possible_truncation, reason = "eight at most")]
        let counts = |bits: u32| [0, 1].map(|ring| in_ring(bits, ring) as u8);
        let found = ParallelLines { is_free: self.free & 1 == 1, free: counts(self.free), held: [0; 2] };
        let held = if found.agree() { [0; 2] } else { counts(self.held) };
        ParallelLines { held, ..found }
    }
}

impl MedialScene {
    /// Finds the obstacles of the line of sight from `target`, local metres, to `range` metres (infinite for a
    /// direction) along the unit vector `towards`, and of lines parallel to it. All numbers but the range must be
    /// finite. The line itself is free unless [`MedialScene::answer`] is blocked.
    #[must_use]
    pub fn parallel_lines(&self, target: [f64; 3], towards: [f64; 3], range: f64) -> ParallelLines {
        self.blocked_lines(BlockedLines::NONE, target, towards, range).lines()
    }

    /// Adds the lines of [`MedialScene::parallel_lines`] that this part of a scene blocks to those that others have
    /// `blocked`. If all lines are blocked, only the first is tested for ends inside an obstacle; for the others it
    /// makes no difference.
    #[must_use]
    pub fn blocked_lines(
        &self,
        blocked: BlockedLines,
        target: [f64; 3],
        towards: [f64; 3],
        range: f64,
    ) -> BlockedLines {
        let lines = self.lines_beside(target, towards, range);
        let mut free = blocked.free;
        if free != 0 {
            let mut left = Left::new(self, &lines, &Axes::along(towards), free);
            let room = [RINGS[1] + MARGIN; 3];
            let ray = self.ray(target, towards, range);
            self.tree().index().visit_beside(&ray, room, &mut left);
            free = left.free;
        }
        for (number, line) in lines.iter().enumerate() {
            if free >> number & 1 == 1 && self.is_behind_others(line.origin, towards, range) {
                free &= !(1 << number);
            }
        }
        let is_held = |line: &Ray| {
            self.is_inside_obstacle(line.origin) || (range.is_finite() && self.is_inside_obstacle(line.at(range)))
        };
        let looked_at = if free == 0 { 1 } else { ALL & !free };
        let held = (0..).zip(&lines).filter(|(number, line)| looked_at >> number & 1 == 1 && is_held(line));
        BlockedLines { free, held: held.fold(blocked.held, |bits, (number, _)| bits | 1_u32 << number) }
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
    lines: &'a [Ray; LINES],
    /// Origin of the places, local metres.
    middle: [f32; 3],
    /// Across the lines, and across these and the first.
    axes: [[f32; 3]; 2],
    /// Position of each line across the axes, metres; infinitely far away for slots without a line.
    places: [[f32; SLOTS]; 2],
    margin: f32,
    free: u32,
}

impl<'a> Left<'a> {
    fn new(scene: &'a MedialScene, lines: &'a [Ray; LINES], Axes([across, up, _]): &Axes, free: u32) -> Self {
        let middle = lines[0].origin.map(to_f32);
        let axes = [*across, *up].map(|axis| axis.map(to_f32));
        let mut places = [[f32::INFINITY; SLOTS]; 2];
        for (slot, line) in lines.iter().enumerate() {
            let offset = sub(line.origin.map(to_f32), middle);
            places[0][slot] = dot(offset, axes[0]);
            places[1][slot] = dot(offset, axes[1]);
        }
        Self { scene, lines, middle, axes, places, margin: scene.tree().near_margin(), free }
    }

    /// Tests exactly which of the lines that a ball comes near to it blocks.
    #[inline(never)]
    fn test(&mut self, row: usize, is_near: [u32; SLOTS]) {
        let mut open = self.free;
        while open != 0 {
            let number = open.trailing_zeros();
            open &= open - 1;
            if is_near[number as usize] != 0 && self.scene.front(row, &self.lines[number as usize]).is_some() {
                self.free &= !(1 << number);
            }
        }
    }
}

impl Visit for &mut Left<'_> {
    #[inline(always)]
    fn visit(&mut self, row: usize) -> f32 {
        let ball = self.scene.ball(row);
        let offset = sub(ball.center, self.middle);
        let [x, y] = self.axes.map(|axis| dot(offset, axis));
        let reach = near_reach(ball, self.margin);
        let is_near = std::array::from_fn(|slot| {
            let [x, y] = [x - self.places[0][slot], y - self.places[1][slot]];
            u32::from(x * x + y * y < reach * reach)
        });
        if is_near != [0; SLOTS] {
            self.test(row, is_near);
        }
        if self.free == 0 { END } else { f32::INFINITY }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::blocking::BlockRule;
    use crate::medial::MedialBalls;
    use crate::query::Answer;
    use belvedere_data::random::uniform;
    use belvedere_data::vector::length;

    fn scene(rule: &BlockRule) -> MedialScene {
        let random = |i: u64, k: u64| to_f32(uniform(5, 8 * i + k));
        let count = 600;
        let balls = MedialBalls {
            centers: (0..count).map(|i| [30.0 * random(i, 0), 30.0 * random(i, 1), 8.0 * random(i, 2)]).collect(),
            radii: (0..count).map(|i| 0.05 + 1.2 * random(i, 3)).collect(),
            source: vec![0; 600],
            touch: vec![0; 600],
            separation_angles: vec![1.0; 600],
        };
        MedialScene::new(&balls, rule).unwrap()
    }

    #[test]
    fn each_line_is_free_as_it_is_when_tested_alone() {
        let random = |i: u64, k: u64| uniform(6, 8 * i + k);
        let (mut agreeing, mut mixed) = (0, 0);
        for rule in [BlockRule::carved(), BlockRule::uncarved()] {
            let scene = scene(&rule);
            for i in 0..3000 {
                let place = |k: u64| [32.0 * random(i, k) - 1.0, 32.0 * random(i, k + 1) - 1.0, 9.0 * random(i, k + 2)];
                let target = place(0);
                let towards = unit(sub(place(3), target)).unwrap();
                let range = if i % 2 == 0 { f64::INFINITY } else { 25.0 * random(i, 6) };
                let found = scene.parallel_lines(target, towards, range);
                let is_free = |line: &Ray| scene.answer(line.origin, towards, range) == Answer::Visible;
                let lines = scene.lines_beside(target, towards, range);
                let count = |ring: usize| {
                    let of_ring = &lines[1 + ring * RING_LINES..][..RING_LINES];
                    u8::try_from(of_ring.iter().filter(|line| is_free(line)).count()).unwrap()
                };
                assert_eq!((found.is_free, found.free), (is_free(&lines[0]), [0, 1].map(count)), "{i} {rule:?}");
                for (ring, radius) in RINGS.into_iter().enumerate() {
                    for line in &lines[1 + ring * RING_LINES..][..RING_LINES] {
                        let offset = sub(line.origin, target);
                        assert!((length(offset) - radius).abs() < 1e-9 && dot(offset, towards).abs() < 1e-9);
                    }
                    assert!(found.held[ring] + found.free[ring] <= 8);
                }
                *(if found.agree() { &mut agreeing } else { &mut mixed }) += 1;
            }
        }
        assert!(agreeing > 1000 && mixed > 1000, "{agreeing} agree, {mixed} do not");
    }

    #[test]
    fn parts_of_a_scene_block_together_what_the_whole_does() {
        let rule = BlockRule::carved();
        let random = |i: u64, k: u64| to_f32(uniform(5, 8 * i + k));
        let balls = |rows: std::ops::Range<u64>| {
            let mut balls = MedialBalls::default();
            for i in rows {
                let center = [30.0 * random(i, 0), 30.0 * random(i, 1), 8.0 * random(i, 2)];
                balls.push(0, center, 0.05 + 1.2 * random(i, 3), 0);
            }
            balls
        };
        let [whole, first, second] =
            [0..600, 0..350, 350..600].map(|rows| MedialScene::new(&balls(rows), &rule).unwrap());
        let mut held = 0;
        for i in 600..3600 {
            let target = [0, 1, 2].map(|k| f64::from(random(i, k) * if k == 2 { 9.0 } else { 32.0 }));
            let towards = unit(sub([15.0, 15.0, 30.0], target)).unwrap();
            let range = if i % 2 == 0 { f64::INFINITY } else { 20.0 };
            let of = |scene: &MedialScene, blocked| scene.blocked_lines(blocked, target, towards, range);
            let expected = of(&whole, BlockedLines::NONE);
            for parts in [[&first, &second], [&second, &first]] {
                let found = parts.into_iter().fold(BlockedLines::NONE, |blocked, part| of(part, blocked));
                assert_eq!(
                    (found.lines(), found.is_inside_obstacle()),
                    (expected.lines(), expected.is_inside_obstacle()),
                    "{i}"
                );
            }
            held += u32::from(expected.lines().held != [0; 2]);
        }
        assert!(held > 100, "{held} with ends inside obstacles");
    }

    #[test]
    fn a_vertical_line_has_lines_beside_it() {
        let scene = scene(&BlockRule::carved());
        let found = scene.parallel_lines([10.0, 10.0, 20.0], [0.0, 0.0, 1.0], f64::INFINITY);
        assert_eq!(found, ParallelLines { is_free: true, free: [8; 2], held: [0; 2] });
    }
}
