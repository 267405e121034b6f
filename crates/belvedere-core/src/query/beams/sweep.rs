//! One viewer's look at a tree of targets: the search itself.

use super::beam::{Apex, Beam};
use super::blockers::{BallBlock, BeamBlock, Blocks, IndexNode, LANES, NodeBlock};
use super::lanes::{HalfLine, Kernels, LaneBits, LaneColumns};
use crate::blocking::{Ball, Profile};
use crate::query::target_tree::{LEAF, TargetNode, TargetTree};
use crate::query::{MedialScene, Viewer};
use crate::ray_index::{Ray, RayIndex};
use belvedere_data::control::Control;
use belvedere_data::vector::{dot, sub, to_f32};
use belvedere_data::{Error, Result};
use std::ops::Range;

/// Maximum rounding error of f32 in the test of a beam, as a share of the largest coordinate: a dozen roundings of
/// 6e-8, fewer where products are fused. Sides of boxes are rounded twice more; boxes are padded by at least as much
/// ([`RayIndex`]).
const ROUNDING: f64 = 1e-6;
/// Margins by which a ball that is to hide a box is reduced, as shares of its squared radius and of squared distances.
/// They exceed the rounding of f64 in the exact test.
const COVER_MARGINS: [f64; 2] = [1e-9, 1e-14];
/// Maximum number of targets of a node that represent its shape themselves; more are represented by their box. At least
/// the number of corners of a box.
const MAX_OUTLINED: usize = 24;
/// Number of balls that blocked the last targets and are tested first for the next one; more would find little more.
const RECENT: usize = 4;

/// One viewer's look at a tree of targets.
pub(super) struct TreeSweep<'a> {
    scene: &'a MedialScene,
    index: &'a RayIndex,
    balls: &'a [Ball],
    targets: &'a TargetTree,
    viewer: Viewer<'a>,
    pub(super) apex: Apex,
    /// Widening of beams, metres: the maximum error of a position in the scene by f32.
    pub(super) room: f64,
    control: &'a Control<'a>,
}

impl<'a> TreeSweep<'a> {
    pub(super) fn new(
        scene: &'a MedialScene,
        viewer: Viewer<'a>,
        targets: &'a TargetTree,
        control: &'a Control<'a>,
    ) -> Result<Self> {
        viewer.validate()?;
        let apex = match viewer {
            Viewer::Eye(eye) => Apex::Eye(eye),
            Viewer::Direction(direction) => {
                Apex::Direction(belvedere_data::vector::unit(direction).unwrap_or(direction))
            }
            Viewer::Each(_) => {
                return Err(Error::UnsupportedViewer {
                    method: "a tree of targets",
                    what: "one viewer for all targets",
                });
            }
        };
        let index = scene.tree().index();
        let farthest = |v: [f64; 3]| v.into_iter().fold(0.0, |max: f64, v| max.max(v.abs()));
        let mut scale = (0..3).map(|i| index.half_size()[i] + index.center()[i].abs()).fold(0.0, f64::max);
        if let Apex::Eye(eye) = apex {
            scale = scale.max(farthest(eye));
        }
        if let Some(root) = targets.nodes.first() {
            scale = scale.max(farthest(root.low.map(f64::from))).max(farthest(root.high.map(f64::from)));
        }
        // with a bias below zero what lies that much behind a target blocks it too
        let behind = (-scene.params().bias).max(0.0);
        Ok(Self {
            scene,
            index,
            balls: scene.tree().balls(),
            targets,
            viewer,
            apex,
            room: ROUNDING * scale + behind,
            control,
        })
    }

    /// Calls `visit` with the places of the targets below `node` that no ball blocks, with the kernels `K`. All that it
    /// calls is inlined, so that it can be compiled for other instructions.
    #[inline(always)]
    pub(super) fn search<K: Kernels>(&self, node: usize, visit: &mut impl FnMut(usize)) {
        let mut lists = Lists::default();
        let index = self.scene.tree().index();
        if let Some(root) = index.root() {
            let side = |axis: usize, sign: f64| to_f32(index.center()[axis] + sign * index.half_size()[axis]);
            let sides = std::array::from_fn(|axis| [side(axis, -1.0), side(axis, 1.0)]);
            lists.nodes.push(IndexNode { sides, number: root });
        }
        let mut waiting = vec![BeamTask { node, given: [[0; 2], lists.end()] }];
        while let Some(BeamTask { node, given }) = waiting.pop() {
            if self.control.is_cancelled() {
                return;
            }
            lists.truncate(given[1]);
            let target = &self.targets.nodes[node];
            let Some(halves) = target.halves else {
                self.finish::<K>(target, &mut lists, given, visit);
                continue;
            };
            // what hides one box often hides the next
            if lists.hider.is_some_and(|ball| self.hides(ball, target)) {
                continue;
            }
            let beam = Beam::new(self.apex, self.room, self.outline(target, 0.0).points(), target);
            let [[first_node, first_ball], [end_node, end_ball]] = given;
            if self.narrow_balls::<K>(target, &beam, &mut lists, first_ball..end_ball)
                || self.open_large_nodes::<K>(target, &beam, &mut lists, first_node..end_node)
            {
                continue;
            }
            let left = [given[1], lists.end()];
            if left[0] == left[1] {
                (target.first..target.first + target.count).for_each(&mut *visit);
                continue;
            }
            // two levels at once: the list is looked through half as often; the first is answered first
            for half in halves.into_iter().rev() {
                match self.targets.nodes[half].halves {
                    Some([lower, upper]) => {
                        waiting.push(BeamTask { node: upper, given: left });
                        waiting.push(BeamTask { node: lower, given: left });
                    }
                    None => waiting.push(BeamTask { node: half, given: left }),
                }
            }
        }
    }

    /// Answers the targets of a leaf one by one. Balls that blocked the last targets come first, then the balls at
    /// hand. Balls of the nodes are tested only for targets that these leave visible.
    #[inline(always)]
    fn finish<K: Kernels>(
        &self,
        target: &TargetNode,
        lists: &mut Lists,
        given: [[usize; 2]; 2],
        visit: &mut impl FnMut(usize),
    ) {
        let mut visible = [true; LEAF];
        let mut rays = [None; LEAF];
        for (ray, place) in rays.iter_mut().zip(target.first..target.first + target.count) {
            *ray = self.ray(place);
        }
        let rays = &rays[..target.count];
        if !self.sift::<K>(rays, &mut visible, lists, By::Recent) {
            return;
        }
        let beam = Beam::new(self.apex, self.room, self.outline(target, 0.0).points(), target);
        let [[first_node, first_ball], [end_node, end_ball]] = given;
        if self.narrow_balls::<K>(target, &beam, lists, first_ball..end_ball)
            || !self.sift::<K>(rays, &mut visible, lists, By::BallsFrom(end_ball))
        {
            return;
        }
        let [_, opened] = lists.end();
        self.open_all_nodes::<K>(&beam, lists, first_node..end_node);
        self.sift::<K>(rays, &mut visible, lists, By::BallsFrom(opened));
        for (place, _) in (target.first..).zip(&visible[..target.count]).filter(|&(_, &visible)| visible) {
            visit(place);
        }
    }

    /// Tests those targets of a leaf that are visible so far against some balls, and unsets the ones that are blocked.
    /// False when no target is left.
    #[inline(always)]
    fn sift<K: Kernels>(&self, rays: &[Option<Ray>], visible: &mut [bool; LEAF], lists: &mut Lists, by: By) -> bool {
        let mut is_any_visible = false;
        for (visible, ray) in visible.iter_mut().zip(rays) {
            if !*visible {
                continue;
            }
            let blocker = match (ray, by) {
                (None, _) => None,
                (Some(ray), By::Recent) => self.blocked_by(ray, lists.recent),
                (Some(ray), By::BallsFrom(first)) => self.blocked_among::<K>(ray, lists.balls.from(first)),
            };
            let Some(ball) = blocker else {
                is_any_visible = true;
                continue;
            };
            *visible = false;
            if !lists.recent.contains(&ball) {
                lists.recent.rotate_right(1);
                lists.recent[0] = ball;
            }
        }
        is_any_visible
    }

    /// Returns points around the targets of a node, moved outward by `room` metres. A few targets are their own
    /// outline, since their hull is tighter than their box; otherwise it has the corners of the box.
    #[inline(always)]
    pub(super) fn outline(&self, target: &TargetNode, room: f64) -> Outline {
        let mut outline = Outline { points: [[0.0; 3]; MAX_OUTLINED], count: 8 };
        if target.count <= MAX_OUTLINED && room == 0.0 {
            outline.count = target.count;
            let targets = &self.targets.positions()[target.first..target.first + target.count];
            for (point, target) in outline.points.iter_mut().zip(targets) {
                *point = target.map(f64::from);
            }
            return outline;
        }
        for (corner, point) in outline.points[..8].iter_mut().enumerate() {
            *point = std::array::from_fn(|axis| match corner >> axis & 1 {
                0 => f64::from(target.low[axis]) - room,
                _ => f64::from(target.high[axis]) + room,
            });
        }
        outline
    }

    /// Appends those of the `given` blocks of balls that the beam may meet; true as soon as one hides all of the
    /// targets.
    #[inline(always)]
    fn narrow_balls<K: Kernels>(
        &self,
        target: &TargetNode,
        beam: &Beam,
        lists: &mut Lists,
        given: Range<usize>,
    ) -> bool {
        for block in given {
            let met = K::meet_balls(&beam.space, &lists.balls.at(block).columns);
            if met.0 == 0 {
                continue;
            }
            let covering = K::may_cover(&beam.space, &lists.balls.at(block).columns);
            for lane in met {
                let (ball, row) = lists.balls.at(block).get(lane);
                lists.balls.push((ball, row));
                if covering.holds(lane) && self.hides(row, target) {
                    lists.hider = Some(row);
                    return true;
                }
            }
        }
        false
    }

    /// Opens those of the `given` nodes that the beam may meet. It appends the balls that the beam may meet, and nodes
    /// that need no opening. Returns true as soon as a ball hides all of the targets.
    #[inline(always)]
    fn open_large_nodes<K: Kernels>(
        &self,
        target: &TargetNode,
        beam: &Beam,
        lists: &mut Lists,
        given: Range<usize>,
    ) -> bool {
        let Lists { nodes, unopened, balls, hider, .. } = lists;
        for block in given {
            let count = nodes.at(block).count;
            for lane in K::meet_boxes(&beam.space, &nodes.at(block).sides).first(count) {
                let node = nodes.at(block).get(lane);
                if beam.is_narrower_than(&node) {
                    unopened.push(node.number);
                } else {
                    nodes.push(node);
                }
            }
            while let Some(number) = unopened.pop() {
                let Some(node) = self.index.open(number) else { continue };
                let parts = K::meet_boxes(&beam.space, &node.sides);
                for part in LaneBits(node.nodes(parts.0)) {
                    let part = IndexNode::of(&node, part);
                    if beam.is_narrower_than(&part) {
                        unopened.push(part.number);
                    } else {
                        nodes.push(part);
                    }
                }
                let rows = node.rows(parts.0);
                for first in rows.clone().step_by(LANES) {
                    let columns = self.columns::<K>(first);
                    let met = K::meet_balls(&beam.space, &columns);
                    if met.0 == 0 {
                        continue;
                    }
                    let covering = K::may_cover(&beam.space, &columns);
                    for lane in met.first((rows.end - first) as usize) {
                        let row = row_at(first, lane);
                        balls.push((self.balls[row as usize], row));
                        if covering.holds(lane) && self.hides(row, target) {
                            *hider = Some(row);
                            unopened.clear();
                            return true;
                        }
                    }
                }
            }
        }
        false
    }

    /// Opens those of the `given` nodes that the beam may meet, and all below them: appends the balls that it may meet.
    #[inline(always)]
    fn open_all_nodes<K: Kernels>(&self, beam: &Beam, lists: &mut Lists, given: Range<usize>) {
        let Lists { nodes, unopened, balls, .. } = lists;
        for block in given {
            let block = nodes.at(block);
            for lane in K::meet_boxes(&beam.space, &block.sides).first(block.count) {
                unopened.push(block.number[lane]);
            }
            while let Some(number) = unopened.pop() {
                let Some(node) = self.index.open(number) else { continue };
                let parts = K::meet_boxes(&beam.space, &node.sides);
                for part in LaneBits(node.nodes(parts.0)) {
                    unopened.push(node.number(part));
                }
                let rows = node.rows(parts.0);
                for first in rows.clone().step_by(LANES) {
                    let met = K::meet_balls(&beam.space, &self.columns::<K>(first));
                    for lane in met.first((rows.end - first) as usize) {
                        let row = row_at(first, lane);
                        balls.push((self.balls[row as usize], row));
                    }
                }
            }
        }
    }

    /// Centres and radii of eight balls from a row on.
    #[inline(always)]
    fn columns<K: Kernels>(&self, first: u32) -> LaneColumns {
        let balls = self.balls.get(first as usize..).unwrap_or_default();
        if let Some(balls) = balls.first_chunk() {
            return K::columns(balls);
        }
        let mut block = BallBlock::EMPTY;
        balls.iter().enumerate().for_each(|(lane, &ball)| block.set(lane, (ball, 0)));
        block.columns
    }

    /// Returns true if a ball blocks every line of sight of the targets, wherever in their box they lie.
    ///
    /// The shadow of a ball is convex: a box lies in it if its corners do. Targets near its surface meet a ball that is
    /// smaller by up to the shell, so that the shadow of the smaller ball is used. A target counts as `bias` nearer to
    /// the viewer.
    #[inline(always)]
    fn hides(&self, ball: u32, target: &TargetNode) -> bool {
        let params = self.scene.params();
        if params.profile == Profile::PaperCone {
            return false;
        }
        let Ball { center, radius } = self.balls[ball as usize];
        let center = center.map(f64::from);
        let radius = params.min_radius(f64::from(radius));
        let outline = self.outline(target, params.bias.max(0.0));
        let corners = outline.points();
        let squared = |v: [f64; 3]| dot(v, v);
        let farthest = corners.iter().map(|&corner| squared(sub(center, corner))).fold(0.0, f64::max);
        match (self.apex, self.viewer) {
            (Apex::Direction(direction), _) => {
                let square = radius * radius * (1.0 - COVER_MARGINS[0]) - COVER_MARGINS[1] * farthest;
                corners.iter().all(|&corner| {
                    let offset = sub(center, corner);
                    let (along, distance) = (dot(offset, direction), squared(offset));
                    distance < square || (along > 0.0 && distance - along * along < square)
                })
            }
            (Apex::Eye(_), Viewer::Eye(eye)) => {
                let offset = sub(center, eye);
                let distance = squared(offset);
                // single lines decide about a ball at the eye
                let clear = radius + params.bias.max(0.0);
                if distance <= clear * clear * (1.0 + COVER_MARGINS[0]) {
                    return false;
                }
                let square = radius * radius * (1.0 - COVER_MARGINS[0]) - COVER_MARGINS[1] * (farthest + distance);
                let tangent = distance - square;
                corners.iter().all(|&corner| {
                    let sight = sub(corner, eye);
                    let (along, range) = (dot(offset, sight), squared(sight));
                    let is_behind = along > 0.0 && along * along > tangent * range && range > tangent;
                    is_behind || squared(sub(corner, center)) < square
                })
            }
            (Apex::Eye(_), _) => false,
        }
    }

    /// The line of sight of the target at `place`; `None` for one at the viewer itself, which nothing blocks.
    fn ray(&self, place: usize) -> Option<Ray> {
        let target = self.targets.positions()[place];
        let sight = self.viewer.sight(place, target)?;
        Some(self.scene.ray(sight.origin, sight.direction, sight.ranges[1]))
    }

    /// The first of these balls that blocks a line of sight.
    #[inline(always)]
    fn blocked_by(&self, ray: &Ray, balls: [u32; RECENT]) -> Option<u32> {
        balls.into_iter().find(|&ball| self.scene.front(ball as usize, ray).is_some())
    }

    /// The first ball of these blocks that blocks a line of sight; each is first tested with the fast bounds of `K`.
    #[inline(always)]
    fn blocked_among<K: Kernels>(&self, ray: &Ray, balls: &[BallBlock]) -> Option<u32> {
        let line =
            HalfLine { origin: ray.origin.map(to_f32), direction: ray.direction.map(to_f32), room: to_f32(self.room) };
        for block in balls {
            for lane in K::near_line(&block.columns, &line) {
                if self.scene.front(block.row[lane] as usize, ray).is_some() {
                    return Some(block.row[lane]);
                }
            }
        }
        None
    }
}

/// The row of one of the eight balls from `first` on.
#[inline(always)]
#[expect(clippy::cast_possible_truncation, reason = "one of eight")]
fn row_at(first: u32, lane: usize) -> u32 {
    first + lane as u32
}

/// The balls against which targets of a leaf are tested.
#[derive(Clone, Copy)]
enum By {
    /// Balls that blocked the last targets.
    Recent,
    /// Balls of the list from a block on.
    BallsFrom(usize),
}

/// A node of targets, and from where to where the blocks of nodes and of balls lie that its beam may meet.
struct BeamTask {
    node: usize,
    given: [[usize; 2]; 2],
}

/// Nodes and balls that the beams of a node of targets and of all above it may meet.
#[derive(Default)]
struct Lists {
    nodes: Blocks<NodeBlock>,
    balls: Blocks<BallBlock>,
    /// Nodes still to be looked at.
    unopened: Vec<u32>,
    /// The last ball that hid a whole box.
    hider: Option<u32>,
    /// The last balls that blocked single targets.
    recent: [u32; RECENT],
}

impl Lists {
    /// Numbers of blocks of nodes and of balls; the next entries get blocks of their own.
    fn end(&mut self) -> [usize; 2] {
        [self.nodes.end(), self.balls.end()]
    }

    fn truncate(&mut self, [nodes, balls]: [usize; 2]) {
        self.nodes.truncate(nodes);
        self.balls.truncate(balls);
    }
}

/// Points in whose convex hull all targets of a node lie.
pub(super) struct Outline {
    points: [[f64; 3]; MAX_OUTLINED],
    count: usize,
}

impl Outline {
    pub(super) fn points(&self) -> &[[f64; 3]] {
        &self.points[..self.count]
    }
}
