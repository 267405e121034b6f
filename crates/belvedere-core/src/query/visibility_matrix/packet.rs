//! Lines of sight of neighbours in one direction, which walk through the balls together.
//!
//! # Source
//! Wald, Slusallek, Benthin & Wagner 2001: packets of rays.

use super::super::ball_tree::{BallTree, MARGIN, near_reach};
use crate::ray_index::{END, Ray, Visit};
use belvedere_data::vector::{cross, dot, sub, to_f32, unit};

/// Maximum number of lines of a packet.
pub(super) const LANES: usize = 8;
/// Maximum distance between the targets of a packet along an axis, metres. The sky of the points of a town (10 per m²,
/// 256 directions) took 20.3 s with 0.5, 16.1 with 1, 15.4 with 2 and 16.3 with 4.
const SPREAD: f32 = 2.0;
/// The ball that blocks each line of a packet, in the order in which they were taken.
pub(super) type Blockers = [Option<u32>; LANES];

/// Lines of sight in one direction.
pub(super) struct Packet<'a> {
    tree: &'a BallTree,
    direction: [f64; 3],
    /// Range before which nothing blocks any of them, metres.
    start: f64,
    /// Two unit vectors across the direction and each other, and the direction itself.
    axes: [[f32; 3]; 3],
    margin: f32,
    targets: [[f32; 3]; LANES],
    count: usize,
    /// Corners of the box around the targets.
    low: [f32; 3],
    high: [f32; 3],
}

impl<'a> Packet<'a> {
    /// No lines yet, in the direction of a unit vector, that no ball blocks before the range `start`, metres.
    pub(super) fn new(tree: &'a BallTree, direction: [f64; 3], start: f64) -> Self {
        let flatter = |a: usize, b: usize| if direction[b].abs() < direction[a].abs() { b } else { a };
        let mut other = [0.0; 3];
        other[flatter(flatter(0, 1), 2)] = 1.0;
        let across = unit(cross(direction, other)).unwrap_or(other);
        Self {
            tree,
            direction,
            start: start.max(tree.rule().bias),
            axes: [across, cross(direction, across), direction].map(|axis| axis.map(to_f32)),
            margin: tree.near_margin(),
            targets: [[0.0; 3]; LANES],
            count: 0,
            low: [f32::INFINITY; 3],
            high: [f32::NEG_INFINITY; 3],
        }
    }

    /// Takes the line of sight of `target`; false where it does not fit, which the first of a packet always does.
    pub(super) fn take(&mut self, target: [f32; 3]) -> bool {
        let low: [f32; 3] = std::array::from_fn(|axis| self.low[axis].min(target[axis]));
        let high: [f32; 3] = std::array::from_fn(|axis| self.high[axis].max(target[axis]));
        if self.count == LANES || (0..3).any(|axis| high[axis] - low[axis] > SPREAD) {
            return false;
        }
        (self.low, self.high) = (low, high);
        self.targets[self.count] = target;
        self.count += 1;
        true
    }

    /// Returns the ball that blocks each line, and empties the packet.
    pub(super) fn find(&mut self) -> Blockers {
        let mut blockers = [None; LANES];
        if self.count > 0 {
            let middle = std::array::from_fn(|axis| 0.5 * (self.low[axis] + self.high[axis]));
            let room = std::array::from_fn(|axis| {
                f64::from(middle[axis] - self.low[axis]).max(f64::from(self.high[axis] - middle[axis])) + MARGIN
            });
            let ranges = [self.start, f64::INFINITY];
            let ray = Ray { origin: middle.map(f64::from), direction: self.direction, ranges };
            self.tree.index().visit_beside(&ray, room, Search::new(self, middle, &mut blockers));
        }
        (self.count, self.low, self.high) = (0, [f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
        blockers
    }
}

/// A packet on its way.
struct Search<'p, 'a> {
    packet: &'p Packet<'a>,
    /// Origin of the places, local metres.
    middle: [f32; 3],
    /// Start of each line along the axes of the packet, metres; infinite for slots that are not taken.
    starts: [[f32; LANES]; 3],
    /// A bit for each line that is not blocked yet.
    left: u32,
    blockers: &'p mut Blockers,
}

impl<'p, 'a> Search<'p, 'a> {
    fn new(packet: &'p Packet<'a>, middle: [f32; 3], blockers: &'p mut Blockers) -> Self {
        let mut starts = [[f32::INFINITY; LANES]; 3];
        for (lane, &target) in packet.targets[..packet.count].iter().enumerate() {
            for (starts, &axis) in starts.iter_mut().zip(&packet.axes) {
                starts[lane] = dot(sub(target, middle), axis);
            }
            starts[2][lane] += to_f32(packet.start);
        }
        Self { packet, middle, starts, left: u32::MAX >> (u32::BITS as usize - packet.count), blockers }
    }

    /// Tests exactly which lines a ball blocks, of those that come near to it. Few balls get so far: apart from
    /// [`Visit::visit`], which stays short enough to become part of the walk.
    #[inline(never)]
    fn test(&mut self, row: usize, is_near: [u32; LANES]) {
        let packet = self.packet;
        for (lane, &target) in packet.targets[..packet.count].iter().enumerate() {
            let bit = 1 << lane;
            if is_near[lane] == 0 || self.left & bit == 0 {
                continue;
            }
            let ray = packet.tree.ray(target.map(f64::from), packet.direction, f64::INFINITY);
            if packet.tree.front(row, &ray).is_some() {
                self.left &= !bit;
                #[expect(clippy::cast_possible_truncation, reason = "balls are numbered with 32 bits")]
                let row = row as u32;
                self.blockers[lane] = Some(row);
            }
        }
    }
}

impl Visit for Search<'_, '_> {
    /// A ball that blocks a line reaches it where it has started: it lies no farther than its radius from there or from
    /// a later place of the line.
    #[inline(always)]
    fn visit(&mut self, row: usize) -> f32 {
        let ball = self.packet.tree.ball(row);
        let offset = sub(ball.center, self.middle);
        let [x, y, z] = self.packet.axes.map(|axis| dot(offset, axis));
        let reach = near_reach(ball, self.packet.margin);
        let is_near = std::array::from_fn(|lane| {
            let [x, y, before] = [x - self.starts[0][lane], y - self.starts[1][lane], self.starts[2][lane] - z];
            let before = if before > 0.0 { before } else { 0.0 };
            u32::from(x * x + y * y + before * before < reach * reach)
        });
        if is_near != [0; LANES] {
            self.test(row, is_near);
        }
        if self.left == 0 { END } else { f32::INFINITY }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::blocking::BlockRule;
    use crate::medial::MedialBalls;
    use belvedere_data::random::uniform;

    #[test]
    fn packets_find_what_blocks_each_of_their_lines() {
        let random = |i: u32, k: u64| to_f32(uniform(12, 8 * u64::from(i) + k));
        // dense small ones, some large, a few that hold the whole scene or none of it
        let radius = |i: u32| match i % 1000 {
            0 => 3e5,
            1 => 1e-6,
            n if n < 20 => 5.0 * random(i, 3),
            _ => 0.3 * random(i, 3),
        };
        let count = 4000;
        let mut balls = MedialBalls::default();
        for i in 0..count {
            let center = [40.0 * random(i, 0), 40.0 * random(i, 1), 6.0 * random(i, 2)];
            balls.centers.push(if radius(i) > 1e3 { [center[0], center[1], -3e5] } else { center });
            balls.radii.push(radius(i));
        }
        balls.source = vec![0; balls.radii.len()];
        balls.touch = vec![0; balls.radii.len()];
        balls.separation_angles = vec![1.0; balls.radii.len()];
        let directions = [[0.0, 0.0, 1.0], [0.6, 0.0, 0.8], [-0.8, 0.6, 0.0], [0.36, -0.48, 0.8], [0.0, 0.96, -0.28]];
        let (mut free, mut blocked) = (0, 0);
        for rule in [BlockRule::carved(), BlockRule::uncarved(), BlockRule { bias: -0.3, ..BlockRule::carved() }] {
            let tree = BallTree::new(&balls, &rule).unwrap();
            for (round, direction) in (0..).zip(directions.into_iter().cycle().take(1000)) {
                let mut packet = Packet::new(&tree, direction, f64::NEG_INFINITY);
                let corner =
                    [45.0 * random(round, 5) - 2.0, 45.0 * random(round, 6) - 2.0, 8.0 * random(round, 7) - 1.0];
                // some in one place, in a line, in a plane
                let spread: [f32; 3] = std::array::from_fn(|axis| if round >> axis & 1 == 0 { SPREAD } else { 0.0 });
                let place = |i: u32| -> [f32; 3] {
                    std::array::from_fn(|axis| corner[axis] + 0.99 * spread[axis] * random(round * 16 + i, axis as u64))
                };
                let targets: Vec<[f32; 3]> = (0..1 + round % 8).map(place).collect();
                assert!(targets.iter().all(|target| packet.take(*target)));
                let blockers = packet.find();
                for (target, blocker) in targets.iter().zip(blockers) {
                    let ray = tree.ray(target.map(f64::from), direction, f64::INFINITY);
                    assert_eq!(blocker.is_some(), tree.blocks(&ray), "{rule:?} {ray:?}");
                    assert!(blocker.is_none_or(|ball| tree.front(ball as usize, &ray).is_some()));
                    free += usize::from(blocker.is_none());
                    blocked += usize::from(blocker.is_some());
                }
                assert!(blockers[targets.len()..].iter().all(Option::is_none));
            }
        }
        assert!(free > 2000 && blocked > 2000, "{free} free, {blocked} blocked");
    }

    #[test]
    fn a_packet_takes_neighbours_only() {
        let tree = BallTree::new(&MedialBalls::default(), &BlockRule::carved()).unwrap();
        let mut packet = Packet::new(&tree, [0.0, 0.0, 1.0], 0.0);
        assert!(packet.take([1e6; 3]));
        assert!(!packet.take([1e6, 1e6, 1e6 + 2.0 * SPREAD]));
        assert!((1..LANES).all(|_| packet.take([1e6 - 0.5; 3])));
        assert!(!packet.take([1e6; 3]));
        assert_eq!(packet.find(), [None; LANES]);
        assert!(packet.take([0.0; 3]));
    }
}
