//! Many targets for one viewer at once: a tree of targets against the tree of balls.
//!
//! All lines of sight of a box of targets run within a beam: from an eye the hull of eye and box, from the sun the box drawn out
//! along the direction. Balls that the beam of a node misses are left out for all targets below it, a ball that covers
//! the whole beam answers them all, and where no ball is left all are visible. What remains are targets at the rim of
//! shadows and close to surfaces, which are asked one by one of the few balls in their beam. The answers are those of the exact
//! lines of sight, to the last bit: a beam only ever leaves out balls that no line of sight in it can meet, and a shadow being
//! convex, a ball that hides the corners of a box hides all in it.

mod beam;
mod blockers;

use super::backend::{Line, Settled, Viewers};
use super::medial_scene::MedialScene;
use super::target_tree::{LEAF, TargetNode, TargetTree};
use super::{Answer, Viewer};
use crate::blocking::{Ball, Profile};
use crate::ray_index::{Part, Ray};
use beam::Beam;
use belvedere_data::control::Control;
use belvedere_data::vector::{dot, sub};
use belvedere_data::{Error, Result};
use blockers::{BallColumns, LANES, Node};
use rayon::prelude::*;
use std::ops::Range;

/// A node of balls is opened where it is larger than so many widths of the beam: with less, balls that only a part of the beam meets
/// are looked at by all of it, with more, parts of the beam open the same nodes again. 4 suits targets high above the ground (a quarter
/// faster at 1.5 m), 2 those on it.
const OPENED_SHARE: f32 = 2.5;
/// Targets of a subtree that one thread answers.
const SHARE: usize = 4096;
/// What f32 may err by in the test of a beam, as a share of the largest coordinate: a dozen roundings of 6e-8.
const ROUNDING: f64 = 1e-6;
/// How much smaller a ball counts where it is to hide a box, as a share of its squared radius and of squared distances: whatever f64
/// rounds in the exact test, and then some.
const COVER_MARGINS: [f64; 2] = [1e-9, 1e-14];
/// Balls that blocked the last targets and are asked first for the next; more find little more.
const RECENT: usize = 4;

impl MedialScene {
    /// The answer for each target, in the order in which they were given: the same as those of
    /// [`super::Visibility::visible`], at a cost that grows with the rim of what is visible rather than with the number of targets.
    /// Targets that are not finite are [`Answer::OutsideView`], those beside or below the cloud [`Answer::OutsideCloud`].
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a viewer that is not finite, [`Error::UnsupportedViewer`] for [`Viewer::Each`], and
    /// [`Error::Cancelled`].
    pub fn answer_among(&self, viewer: Viewer<'_>, targets: &TargetTree, control: &Control<'_>) -> Result<Vec<Answer>> {
        let sweep = Sweep::new(self, viewer, targets, control)?;
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
                    None => sweep.run(subtree, &mut |place| seen[place - first] = true),
                }
                places
                    .map(|place| {
                        let target = targets.positions()[place];
                        let answer = match viewer.line_of_sight(place, target) {
                            _ if eye_outside || self.is_outside_cloud(target.map(f64::from)) => Answer::OutsideCloud,
                            None => Answer::OutsideView,
                            Some(_) if !seen[place - first] => Answer::Blocked,
                            Some((towards, range)) => self.answer_unblocked(target.map(f64::from), towards, range),
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

    /// Calls `visit` with the place, in the order of the tree, of every target that nothing blocks, one at the viewer itself among
    /// them, but none outside the cloud; what pulses prove is not asked. Runs on the calling thread; the places ascend.
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
        let sweep = Sweep::new(self, viewer, targets, control)?;
        if !targets.nodes.is_empty() && !is_eye_outside(self, viewer) {
            sweep.run(0, &mut |place| {
                if !self.is_hidden_otherwise(viewer, targets.positions()[place]) {
                    visit(place);
                }
            });
        }
        control.check()
    }

    /// The same for each of `eyes`, local metres, one after the other: `visit` gets the number of the eye too. An eye that is not finite sees nothing.
    /// `looked` is called with the number of each eye after it.
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

    /// What the backend settles of the targets of a tree at once, if it is fast at that.
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

    /// Whether no ball blocks the line of sight of a target of which `line` is known; true for one at the viewer itself.
    pub(super) fn sees(&self, viewer: Viewer<'_>, target: [f32; 3], line: Line) -> bool {
        match (line, viewer.line_of_sight(0, target)) {
            (Line::Free, _) | (Line::Open, None) => true,
            (Line::Blocked, _) => false,
            (Line::Open, Some((towards, range))) => {
                !self.tree().blocks(&self.ray(target.map(f64::from), towards, range))
            }
        }
    }

    /// Whether anything but balls hides a target, or it lies outside the cloud.
    fn is_hidden_otherwise(&self, viewer: Viewer<'_>, target: [f32; 3]) -> bool {
        let is_hidden = (self.added.is_some() || !self.far_terrain.is_empty())
            && viewer
                .line_of_sight(0, target)
                .is_some_and(|(towards, range)| self.is_behind_others(target.map(f64::from), towards, range));
        is_hidden || self.is_outside_cloud(target.map(f64::from))
    }

    /// Whether the view from `eye` of a target that no ball blocks is proven, both local metres; [`Answer::OutsideView`] where the two
    /// are one.
    #[must_use]
    pub fn answer_unblocked_from(&self, eye: [f64; 3], target: [f64; 3]) -> Answer {
        let towards = sub(eye, target);
        match belvedere_data::vector::unit(towards) {
            None => Answer::OutsideView,
            Some(unit) => self.answer_unblocked(target, unit, belvedere_data::vector::length(towards)),
        }
    }
}

/// Whether a viewer is an eye beside or below the cloud.
fn is_eye_outside(scene: &MedialScene, viewer: Viewer<'_>) -> bool {
    matches!(viewer, Viewer::Eye(eye) if scene.is_outside_cloud(eye))
}

/// One viewer's look at a tree of targets.
struct Sweep<'a> {
    scene: &'a MedialScene,
    targets: &'a TargetTree,
    viewer: Viewer<'a>,
    apex: Apex,
    /// By how much beams are widened, metres: what f32 may misplace anything in the scene by.
    room: f64,
    control: &'a Control<'a>,
}

/// Where beams come from.
#[derive(Clone, Copy)]
enum Apex {
    /// Local metres.
    Eye([f64; 3]),
    /// Unit vector.
    Direction([f64; 3]),
}

impl<'a> Sweep<'a> {
    fn new(
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
        let farthest = |v: [f64; 3]| v.into_iter().fold(0.0, |most: f64, v| most.max(v.abs()));
        let mut scale = (0..3).map(|i| index.half_size()[i] + index.center()[i].abs()).fold(0.0, f64::max);
        if let Apex::Eye(eye) = apex {
            scale = scale.max(farthest(eye));
        }
        if let Some(root) = targets.nodes.first() {
            scale = scale.max(farthest(root.low.map(f64::from))).max(farthest(root.high.map(f64::from)));
        }
        // with a bias below zero what lies that much behind a target blocks it too
        let behind = (-scene.params().bias).max(0.0);
        Ok(Self { scene, targets, viewer, apex, room: ROUNDING * scale + behind, control })
    }

    fn run(&self, node: usize, visit: &mut impl FnMut(usize)) {
        let mut lists = Lists::default();
        let index = self.scene.tree().index();
        if let Some(root) = index.root() {
            #[expect(clippy::cast_possible_truncation, reason = "beams are widened by more than what is rounded")]
            let [center, half] = [index.center(), index.half_size()].map(|v| v.map(|v| v as f32));
            lists.nodes.push(Node { center, half, number: root });
        }
        let given = lists.end();
        self.descend(node, &mut lists, [[0; 2], given], visit);
    }

    /// Answers the targets below `node`, whose beam can meet nothing but the `given` nodes and balls.
    fn descend(&self, node: usize, lists: &mut Lists, given: [[usize; 2]; 2], visit: &mut impl FnMut(usize)) {
        if self.control.is_cancelled() {
            return;
        }
        let target = &self.targets.nodes[node];
        let Some(halves) = target.halves else { return self.finish(target, lists, given, visit) };
        // what hides one box often hides the next
        if lists.hider.is_some_and(|ball| self.hides(ball, target)) {
            return;
        }
        let beam = Beam::new(self, target);
        let first = lists.end();
        let [[first_node, first_ball], [end_node, end_ball]] = given;
        let is_hidden = self.narrow_balls(target, &beam, lists, first_ball..end_ball) || {
            self.open_nodes(&beam, lists, first_node..end_node, Opening::WhatIsLarge);
            self.narrow_fresh(target, &beam, lists)
        };
        if !is_hidden && lists.end() == first {
            (target.first..target.first + target.count).for_each(&mut *visit);
        } else if !is_hidden {
            lists.balls.pad();
            let left = [first, lists.end()];
            // two levels at once: the list is looked through half as often
            for half in halves {
                match self.targets.nodes[half].halves {
                    Some(quarters) => quarters.into_iter().for_each(|node| self.descend(node, lists, left, visit)),
                    None => self.descend(half, lists, left, visit),
                }
            }
        }
        lists.truncate(first);
    }

    /// Answers the targets of a leaf one by one: by what blocked the last ones, then by the balls at hand, and only where these leave
    /// them visible by those of the nodes too.
    fn finish(&self, target: &TargetNode, lists: &mut Lists, given: [[usize; 2]; 2], visit: &mut impl FnMut(usize)) {
        let mut visible = [true; LEAF];
        let mut sift = |lists: &mut Lists, by: &dyn Fn(&Lists, usize) -> Option<u32>| {
            for (visible, place) in visible.iter_mut().zip(target.first..target.first + target.count) {
                if *visible && let Some(ball) = by(lists, place) {
                    *visible = false;
                    if !lists.recent.contains(&ball) {
                        lists.recent.rotate_right(1);
                        lists.recent[0] = ball;
                    }
                }
            }
            visible[..target.count].contains(&true)
        };
        if !sift(lists, &|lists, place| self.blocked_by(place, lists.recent.iter().copied())) {
            return;
        }
        let beam = Beam::new(self, target);
        let first = lists.end();
        let [[first_node, first_ball], [end_node, end_ball]] = given;
        let is_hidden = self.narrow_balls(target, &beam, lists, first_ball..end_ball) || {
            lists.balls.pad();
            !sift(lists, &|lists, place| self.blocked_among(place, &lists.balls, first[1]))
        };
        if !is_hidden {
            self.open_nodes(&beam, lists, first_node..end_node, Opening::Whole);
            lists.fresh.pad();
            sift(lists, &|lists, place| self.blocked_among(place, &lists.fresh, 0));
            for (place, _) in (target.first..).zip(&visible[..target.count]).filter(|&(_, &visible)| visible) {
                visit(place);
            }
        }
        lists.truncate(first);
    }

    /// Appends those of the `given` balls that the beam may meet; true as soon as one hides all of the targets.
    fn narrow_balls(&self, target: &TargetNode, beam: &Beam, lists: &mut Lists, given: Range<usize>) -> bool {
        given.step_by(LANES).any(|start| {
            let met = beam.meets(lists.balls.lanes(start));
            (0..LANES).any(|lane| {
                met.is_hit[lane] && {
                    let (ball, row) = lists.balls.get(start + lane);
                    lists.balls.push(ball, row);
                    met.may_be_covered[lane] && self.hides(row, target) && {
                        lists.hider = Some(row);
                        true
                    }
                }
            })
        })
    }

    /// The same for the fresh balls.
    fn narrow_fresh(&self, target: &TargetNode, beam: &Beam, lists: &mut Lists) -> bool {
        let Lists { balls, fresh, hider, .. } = lists;
        fresh.pad();
        (0..fresh.len()).step_by(LANES).any(|start| {
            let met = beam.meets(fresh.lanes(start));
            (0..LANES).any(|lane| {
                met.is_hit[lane] && {
                    let (ball, row) = fresh.get(start + lane);
                    balls.push(ball, row);
                    met.may_be_covered[lane] && self.hides(row, target) && {
                        *hider = Some(row);
                        true
                    }
                }
            })
        })
    }

    /// Opens those of the `given` nodes that the beam may meet: their balls become fresh, nodes that need no opening are appended.
    fn open_nodes(&self, beam: &Beam, lists: &mut Lists, given: Range<usize>, opening: Opening) {
        let Lists { nodes, unopened, fresh, .. } = lists;
        fresh.truncate(0);
        for place in given {
            if beam.meets_box(&nodes[place]) {
                unopened.push(nodes[place]);
            }
            while let Some(node) = unopened.pop() {
                let size = 2.0 * node.half.into_iter().fold(0.0, f32::max);
                if opening == Opening::WhatIsLarge && !beam.is_narrower_than(size, node.center) {
                    nodes.push(node);
                    continue;
                }
                let Some(parts) = self.scene.tree().index().parts(node.number) else { continue };
                let hits = beam.meets_boxes(&parts);
                for (lane, part) in parts.parts.into_iter().enumerate().filter(|&(lane, _)| hits[lane]) {
                    match part {
                        Part::Nothing => {}
                        Part::Node(number) => unopened.push(Node::of(number, &parts, lane)),
                        Part::Rows { first, count } => {
                            (first..first + count).for_each(|row| fresh.push(self.scene.ball(row as usize), row));
                        }
                    }
                }
            }
        }
    }

    /// Whether a ball blocks every line of sight of the targets, wherever in their box they lie.
    ///
    /// The shadow of a ball is convex: a box lies in it if its corners do. Targets near its surface meet a ball smaller by up
    /// to the shell, so the shadow of that one is asked; a target counts as `bias` nearer to the viewer.
    fn hides(&self, ball: u32, target: &TargetNode) -> bool {
        let params = self.scene.params();
        if params.profile == Profile::PaperCone {
            return false;
        }
        let Ball { center, radius } = self.scene.ball(ball as usize);
        let (center, whole) = (center.map(f64::from), f64::from(radius));
        let radius = params.least_radius(whole);
        let corners = target.corners(params.bias.max(0.0));
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
                // a ball that holds the viewer blocks nothing
                if distance <= whole * whole * (1.0 + COVER_MARGINS[0]) {
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
        let (towards, range) = self.viewer.line_of_sight(place, target)?;
        Some(self.scene.ray(target.map(f64::from), towards, range))
    }

    /// The first of these balls that blocks the target at `place`.
    fn blocked_by(&self, place: usize, mut balls: impl Iterator<Item = u32>) -> Option<u32> {
        let ray = self.ray(place)?;
        balls.find(|&ball| self.scene.front(ball as usize, &ray).is_some())
    }

    /// The first of the balls from place `first` on that blocks the target at `place`.
    fn blocked_among(&self, place: usize, balls: &BallColumns, first: usize) -> Option<u32> {
        let ray = self.ray(place)?;
        let origin = self.targets.positions()[place];
        #[expect(clippy::cast_possible_truncation, reason = "balls count as larger by more than what is rounded")]
        let (direction, room) = (ray.direction.map(|v| v as f32), self.room as f32);
        (first..balls.len()).step_by(LANES).find_map(|start| {
            let near = balls.near_line(start, origin, direction, room);
            let rows = balls.row[start..].iter().zip(near).filter(|&(_, near)| near).map(|(&row, _)| row);
            rows.into_iter().find(|&row| self.scene.front(row as usize, &ray).is_some())
        })
    }
}

/// Which nodes are opened.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Opening {
    WhatIsLarge,
    Whole,
}

/// What the beams of a node of targets and of all above it may meet.
#[derive(Default)]
struct Lists {
    nodes: Vec<Node>,
    balls: BallColumns,
    /// Nodes still to be looked at.
    unopened: Vec<Node>,
    /// Balls out of opened nodes.
    fresh: BallColumns,
    /// The last ball that hid a whole box.
    hider: Option<u32>,
    /// The last balls that blocked single targets.
    recent: [u32; RECENT],
}

impl Lists {
    /// Numbers of nodes and of balls.
    fn end(&self) -> [usize; 2] {
        [self.nodes.len(), self.balls.len()]
    }

    fn truncate(&mut self, [nodes, balls]: [usize; 2]) {
        self.nodes.truncate(nodes);
        self.balls.truncate(balls);
    }
}

impl TargetNode {
    /// Corners of the box, moved outward by `room` metres.
    fn corners(&self, room: f64) -> [[f64; 3]; 8] {
        std::array::from_fn(|corner| {
            std::array::from_fn(|axis| {
                let is_high = corner >> axis & 1 == 1;
                if is_high { f64::from(self.high[axis]) + room } else { f64::from(self.low[axis]) - room }
            })
        })
    }
}
