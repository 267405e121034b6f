//! Lines of sight between pairs of points: the first obstacle, and all obstacles along them.

use crate::blocking::{Chord, Sheet};
use crate::query::ball_tree::PROBE;
use crate::query::blocker::{Blocker, nearest_blocker};
use crate::query::proof::freed_space::pieces_outside;
use crate::query::triangles::LineEnds;
use crate::query::{Answer, EarthParams, MedialScene};
use crate::ray_index::{Ray, in_order};
use crate::triangle_tree::Corners;
use belvedere_data::Result;
use belvedere_data::control::Control;
use belvedere_data::vector::{length, sub};
use rayon::prelude::*;

/// Pairs handed to a thread at once.
const CHUNK: usize = 256;

/// Result for a line of sight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineOfSight {
    /// Visible, blocked, unproven where pulses are known, or outside the cloud.
    pub answer: Answer,
    /// Obstacle that the observer sees instead of the target, if the line is blocked.
    pub first_block: Option<Obstruction>,
    /// Length that no pulse came near to, metres; 0 if pulses are not known or the line is blocked; NaN outside the
    /// cloud. On a line that leaves the cloud, only the part over the cloud counts.
    pub unproven_length: f64,
}

/// Obstacle before a target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Obstruction {
    /// Distance from the observer along the line of sight, metres; straight from the observer on a line that leaves the
    /// cloud.
    pub range: f64,
    /// Kind of the obstacle.
    pub blocker: Blocker,
    /// Point where the line meets it, local metres.
    pub place: [f64; 3],
}

/// The piece of a line of sight that lies in one ball, however it blocks, in one mesh, or in a patch: a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// The obstacle that the line crosses.
    pub blocker: Blocker,
    /// Distances at which the line enters and leaves it, metres from the observer, cut to the line.
    pub ranges: [f64; 2],
}

/// The balls that hold a point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Enclosure {
    /// Number of balls.
    pub ball_count: usize,
    /// Depth below the surface of the deepest of them, metres; 0 outside.
    pub depth: f64,
}

/// A piece of a line of sight between two ends.
struct LinePiece {
    /// All of it, from the side of the end that [`in_order`] puts first.
    ray: Ray,
    /// The ranges in which balls count: less the bias where it reaches an end of the whole line.
    for_balls: Ray,
    /// True if it is the whole line.
    is_whole: bool,
    /// Ends of the whole line, in order.
    ends: [[f64; 3]; 2],
}

impl LinePiece {
    fn line_ends(&self) -> LineEnds {
        LineEnds { target: self.ends[0], viewer: Some(self.ends[1]) }
    }

    fn length(&self) -> f64 {
        self.ray.ranges[1]
    }
}

impl MedialScene {
    /// Evaluates the line of sight from `observer` to `target`, local metres, over the earth of `earth`. `None` if a
    /// coordinate is not finite or both points coincide.
    ///
    /// The answer is that of [`MedialScene::answer`] for the same pair on a plane earth. It stays the same when the two
    /// change places. A curved line is cut into chords; the rules for the ends (balls near them give way) are applied
    /// to the ends of the whole line. [`Answer::InsideObstacle`] where balls block the line because an end is inside an
    /// obstacle ([`MedialScene::is_inside_obstacle`]).
    ///
    /// Where an end lies on far terrain ([`MedialScene::is_on_far_terrain`]) the answer is that of
    /// [`MedialScene::far_sight_answer`]: `None` also where one end is above the other.
    #[must_use]
    pub fn line_of_sight(&self, observer: [f64; 3], target: [f64; 3], earth: &EarthParams) -> Option<LineOfSight> {
        Ray::between(observer, target)?;
        if self.leaves_cloud([observer, target]) {
            return self.far_line_of_sight(observer, target, earth);
        }
        if [observer, target].into_iter().any(|end| self.is_outside_cloud(end)) {
            let answer = Answer::OutsideCloud;
            return Some(LineOfSight { answer, first_block: None, unproven_length: f64::NAN });
        }
        let ends = in_order([observer, target]);
        Some(self.sight_on_chords(observer, ends, &earth.corners(ends[0], ends[1])))
    }

    /// Returns the line of sight of `observer` along the part that [`MedialScene::answer_on_chords`] answers.
    pub(in crate::query) fn sight_on_chords(
        &self,
        observer: [f64; 3],
        ends: [[f64; 3]; 2],
        corners: &[[f64; 3]],
    ) -> LineOfSight {
        let pieces = self.chords(ends, corners);
        let is_from_start = observer == ends[0];
        let mut from_observer: Vec<&LinePiece> = pieces.iter().collect();
        if !is_from_start {
            from_observer.reverse();
        }
        let mut passed = 0.0;
        for piece in from_observer {
            if let Some((blocker, range)) = self.first_on(piece, is_from_start) {
                let place = piece.ray.at(if is_from_start { range } else { piece.length() - range });
                let block = Obstruction { range: passed + range, blocker, place };
                let answer = self.blocked_between(ends);
                return LineOfSight { answer, first_block: Some(block), unproven_length: 0.0 };
            }
            passed += piece.length();
        }
        let Some(proof) = &self.proof else {
            return LineOfSight { answer: Answer::Visible, first_block: None, unproven_length: 0.0 };
        };
        let unseen =
            |piece: &LinePiece| self.unproven_length(proof, piece.ray.origin, piece.ray.direction, piece.length());
        let unproven_length = pieces.iter().map(unseen).sum();
        let answer = if unproven_length > proof.tolerance() { Answer::Unproven } else { Answer::Visible };
        LineOfSight { answer, first_block: None, unproven_length }
    }

    /// The pieces of the line of sight between two points over the cloud that no pulse came near to, local metres: the
    /// two ends of each, whatever blocks the line. Together they are as long as [`LineOfSight::unproven_length`]. None
    /// where pulses are not known.
    #[must_use]
    pub fn unproven_pieces(&self, observer: [f64; 3], target: [f64; 3], earth: &EarthParams) -> Vec<[[f64; 3]; 2]> {
        let mut found = Vec::new();
        let Some(proof) = &self.proof else { return found };
        for LinePiece { ray, .. } in self.pieces(observer, target, earth) {
            for [from, to] in pieces_outside(&self.freed, &ray) {
                let pieces = proof.unproven_pieces(ray.at(from), ray.direction, to - from);
                found.extend(pieces.into_iter().map(|piece| piece.map(|at| ray.at(from + at))));
            }
        }
        found
    }

    /// [`MedialScene::line_of_sight`] for each of `pairs`, (N, observer and target), local metres, in their order.
    /// Progress counts pairs.
    ///
    /// # Errors
    /// [`Error::Cancelled`](belvedere_data::Error::Cancelled).
    pub fn lines_of_sight(
        &self,
        pairs: &[[[f64; 3]; 2]],
        earth: &EarthParams,
        control: &Control<'_>,
    ) -> Result<Vec<Option<LineOfSight>>> {
        let ask = |&[observer, target]: &[[f64; 3]; 2]| {
            control.check()?;
            let sight = self.line_of_sight(observer, target, earth);
            control.advance(1);
            Ok(sight)
        };
        pairs.par_iter().with_min_len(CHUNK).map(ask).collect()
    }

    /// The answer of [`MedialScene::line_of_sight`] alone, which is quicker; [`Answer::OutsideView`] for a point that
    /// is not finite or is the observer's own.
    #[must_use]
    pub fn sight_answer(&self, observer: [f64; 3], target: [f64; 3], earth: &EarthParams) -> Answer {
        let Some(ray) = Ray::between(observer, target) else { return Answer::OutsideView };
        if self.leaves_cloud([observer, target]) {
            return self.far_sight_answer(observer, target, earth);
        }
        if [observer, target].into_iter().any(|end| self.is_outside_cloud(end)) {
            return Answer::OutsideCloud;
        }
        if !earth.bends(target, observer) {
            return match self.answer(ray.origin, ray.direction, ray.ranges[1]) {
                Answer::Blocked => self.blocked_between([observer, target]),
                answer => answer,
            };
        }
        let ends = in_order([observer, target]);
        self.answer_on_chords(ends, &earth.corners(ends[0], ends[1]))
    }

    /// Returns the answer for the part of a line of sight that runs along chords through `corners`, from the side of
    /// the first end on. The two ends are given in order ([`in_order`]); the rules for ends apply to the whole line.
    pub(in crate::query) fn answer_on_chords(&self, ends: [[f64; 3]; 2], corners: &[[f64; 3]]) -> Answer {
        let pieces = self.chords(ends, corners);
        let is_blocked = |piece: &LinePiece| {
            self.triangles().is_some_and(|triangles| triangles.blocks_piece(&piece.ray, &piece.line_ends()))
                || self.tree().index().any(&piece.for_balls, |number| self.blocked_on(number, piece).is_some())
        };
        if pieces.iter().any(is_blocked) {
            return self.blocked_between(ends);
        }
        let Some(proof) = &self.proof else { return Answer::Visible };
        let mut unseen = 0.0;
        for piece in &pieces {
            unseen += self.unproven_length(proof, piece.ray.origin, piece.ray.direction, piece.length());
            if unseen > proof.tolerance() {
                return Answer::Unproven;
            }
        }
        Answer::Visible
    }

    /// Returns the answer for a blocked line of sight between two ends: blocked, or inside an obstacle.
    fn blocked_between(&self, ends: [[f64; 3]; 2]) -> Answer {
        match ends.into_iter().any(|end| self.is_inside_obstacle(end)) {
            true => Answer::InsideObstacle,
            false => Answer::Blocked,
        }
    }

    /// Returns every ball, mesh and patch on the line of sight from `observer` to `target`, local metres, in the order
    /// in which the line enters them. Balls count by their whole radius, also those around the ends and those that give
    /// way to the target. A mesh holds the space between every two of its surfaces, counted from the target; if their
    /// number is odd, also from the last one to the observer. A patch is a point. Empty for a line without length or
    /// with coordinates that are not finite.
    #[must_use]
    pub fn crossings(&self, observer: [f64; 3], target: [f64; 3], earth: &EarthParams) -> Vec<Crossing> {
        let corners = earth.corners(observer, target);
        let mut crossings: Vec<Crossing> = Vec::new();
        let mut passed = 0.0;
        for pair in corners.windows(2) {
            let &[from, to] = pair else { continue };
            let piece = length(sub(to, from));
            let Some(ray) = Ray::new(from, sub(to, from), [0.0, piece]) else { continue };
            self.tree().index().each(&ray, |number| {
                let inside = self.tree().balls().get(number).and_then(|ball| ball.interval(ray.origin, ray.direction));
                let Some([enters, leaves]) = inside else { return };
                let ranges = [enters.max(0.0), leaves.min(piece)];
                if ranges[0] < ranges[1] {
                    let blocker = self.blocker_of_ball(number);
                    let ranges = ranges.map(|range| passed + range);
                    crossings.extend(blocker.map(|blocker| Crossing { blocker, ranges }));
                }
            });
            let mut passages = self.triangles().map_or(Vec::new(), |triangles| triangles.passages(&ray));
            passages.reverse();
            for of_one in passages.chunk_by(|a, b| a.0 == b.0) {
                let together = if of_one[0].0.mesh().is_some() { 2 } else { 1 };
                for pair in of_one.chunks(together) {
                    let (blocker, leaves) = pair[0];
                    let alone = if together == 1 { leaves } else { 0.0 };
                    let enters = pair.get(1).map_or(alone, |(_, range)| *range);
                    let ranges = [enters, leaves].map(|range| passed + range);
                    crossings.push(Crossing { blocker, ranges });
                }
            }
            passed += piece;
        }
        crossings.sort_by(|a, b| a.ranges[0].total_cmp(&b.ranges[0]).then(a.blocker.cmp(&b.blocker)));
        crossings
    }

    /// The balls that hold `point`, local metres. An observer there is blind, unless it is so little that they give way
    /// ([`MedialScene::is_inside_obstacle`]).
    #[must_use]
    pub fn enclosure(&self, point: [f64; 3]) -> Enclosure {
        let mut enclosure = Enclosure::default();
        let Some(ray) = Ray::new(point, [0.0, 0.0, 1.0], [0.0, PROBE]) else { return enclosure };
        self.tree().index().each(&ray, |number| {
            let Some(ball) = self.tree().balls().get(number) else { return };
            let depth = ball.depth_of(point);
            if depth > 0.0 {
                enclosure.ball_count += 1;
                enclosure.depth = enclosure.depth.max(depth);
            }
        });
        enclosure
    }

    /// Calls `visit` with the number in the index of every ball that blocks the line of sight from `observer` to
    /// `target`.
    pub(in crate::query) fn each_blocker(
        &self,
        observer: [f64; 3],
        target: [f64; 3],
        earth: &EarthParams,
        mut visit: impl FnMut(usize),
    ) {
        for piece in self.pieces(observer, target, earth) {
            self.tree().index().each(&piece.for_balls, |number| {
                if self.blocked_on(number, &piece).is_some() {
                    visit(number);
                }
            });
        }
    }

    /// Calls `visit` with every triangle that blocks the line of sight from `observer` to `target`.
    pub(in crate::query) fn each_blocking_triangle(
        &self,
        observer: [f64; 3],
        target: [f64; 3],
        earth: &EarthParams,
        mut visit: impl FnMut(&Corners, &Sheet),
    ) {
        let Some(triangles) = self.triangles() else { return };
        for piece in self.pieces(observer, target, earth) {
            triangles.each_blocking(&piece.ray, &piece.line_ends(), &mut visit);
        }
    }

    /// The chords of the line of sight between two points, from the end on that [`in_order`] puts first.
    fn pieces(&self, observer: [f64; 3], target: [f64; 3], earth: &EarthParams) -> Vec<LinePiece> {
        let ends = in_order([observer, target]);
        self.chords(ends, &earth.corners(ends[0], ends[1]))
    }

    /// The chords through given corners of a line between two ends in order.
    fn chords(&self, ends: [[f64; 3]; 2], corners: &[[f64; 3]]) -> Vec<LinePiece> {
        let is_whole = corners == ends;
        let bias = self.tree().rule().bias;
        let at = |is_end: bool| if is_end { bias } else { 0.0 };
        let piece = |pair: &[[f64; 3]]| {
            let &[from, to] = pair else { return None };
            let size = length(sub(to, from));
            let ray = Ray::new(from, sub(to, from), [0.0, size])?;
            let for_balls = match is_whole {
                true => self.ray(from, ray.direction, size),
                false => Ray { ranges: [at(from == ends[0]), size - at(to == ends[1])], ..ray },
            };
            Some(LinePiece { ray, for_balls, is_whole, ends })
        };
        corners.windows(2).filter_map(piece).collect()
    }

    /// Returns the first obstacle on a piece for an observer beyond its start or its end, and the distance from the end
    /// of the piece on that side, metres.
    fn first_on(&self, piece: &LinePiece, is_from_start: bool) -> Option<(Blocker, f64)> {
        let reach = piece.length();
        // a bias below zero lets balls beyond the ends block
        let beyond = self.tree().rule().bias.min(0.0);
        let ranges = [beyond, reach - beyond];
        let look = match is_from_start {
            true => Ray { ranges, ..piece.ray },
            false => Ray { origin: piece.ray.at(reach), direction: piece.ray.direction.map(|v| -v), ranges },
        };
        let ball = self.tree().index().nearest(&look, |number| {
            let [enters, leaves] = self.blocked_on(number, piece)?;
            let range = if is_from_start { enters } else { reach - leaves };
            Some(range.max(0.0).min(reach))
        });
        let ball = ball.and_then(|(number, range)| Some((self.blocker_of_ball(number)?, range)));
        let ends = piece.line_ends();
        let triangle = self.triangles().and_then(|triangles| match is_from_start {
            true => triangles.nearest(&piece.ray, &ends),
            false => triangles.farthest(&piece.ray, &ends).map(|(blocker, range)| (blocker, reach - range)),
        });
        nearest_blocker(ball, triangle)
    }

    /// The piece of a chord that a ball blocks, from the start of the chord, as
    /// [`BlockRule::blocked_piece`](crate::query::BlockRule::blocked_piece) gives it.
    fn blocked_on(&self, number: usize, piece: &LinePiece) -> Option<[f64; 2]> {
        let LinePiece { ray, for_balls, is_whole, ends: [target, observer] } = *piece;
        if is_whole {
            return self.tree().blocked_piece(number, &for_balls);
        }
        let chord = Chord { start: ray.origin, towards: ray.direction, ranges: for_balls.ranges, target, observer };
        self.tree().rule().blocks_chord(*self.tree().balls().get(number)?, &chord)
    }
}

/// `count` pairs of points spread evenly at random over the local box from `low` to `high`, observer and target. The
/// same seed gives the same pairs for any number of threads.
#[must_use]
pub fn random_pairs(low: [f32; 3], high: [f32; 3], count: usize, seed: u64) -> Vec<[[f64; 3]; 2]> {
    let ends = crate::query::random_targets(low, high, 2 * count, seed);
    ends.as_chunks::<2>().0.iter().map(|pair| pair.map(|end| end.map(f64::from))).collect()
}

/// The ranges that `crossings` cover together: apart from each other, in order, (from, to) metres from the observer.
#[must_use]
pub fn merged_crossings(crossings: &[Crossing]) -> Vec<[f64; 2]> {
    let mut sorted: Vec<[f64; 2]> = crossings.iter().map(|crossing| crossing.ranges).collect();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut merged: Vec<[f64; 2]> = Vec::new();
    for ranges in sorted {
        match merged.last_mut() {
            Some(last) if ranges[0] <= last[1] => last[1] = last[1].max(ranges[1]),
            _ => merged.push(ranges),
        }
    }
    merged
}
