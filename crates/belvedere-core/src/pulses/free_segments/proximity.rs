//! Distances between pulses and points or lines.

use super::segment::FreeSegment;
use super::tree::{SegmentAxis, SegmentNode};
use super::{FreeSegments, GAP_M};
use belvedere_data::vector::{dot, sub, to_f32, unit};
use std::ops::ControlFlow;

/// Minimum length of a piece of a line, metres, more than the padding of boxes in the tree. All free segments of a
/// tripod end at one place; a line that leaves its surroundings need not test them all.
const MIN_PIECE: f64 = 4e-3;
/// Minimum gain in distance for which the nearest-segment search continues, metres: where segments end at one place,
/// all are equally near.
const WORTH_LOOKING: f64 = 5e-3;

/// Share of pulses that are not upright from which on a scanner is taken to stand on the ground: those of aircraft are
/// steeper than 40°.
const MIN_FLAT_SHARE: f64 = 0.05;

impl FreeSegments {
    /// Number of free segments.
    #[must_use]
    pub fn len(&self) -> usize {
        self.free_segments.len()
    }

    /// Returns true if there are no free segments.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.free_segments.is_empty()
    }

    /// Returns the number of segments that rise by 0.3 m or more for each metre of their length, as all pulses of
    /// aircraft do.
    #[must_use]
    pub fn upright_count(&self) -> usize {
        match &self.trees[..] {
            [first, rest @ ..] if first.way == SegmentAxis::UP => {
                rest.first().map_or(self.free_segments.len(), |next| next.first)
            }
            _ => 0,
        }
    }

    /// Returns true if the pulses come from a scanner on the ground: many are too flat for an aircraft.
    #[must_use]
    pub fn are_from_the_ground(&self) -> bool {
        are_flat(self.len() - self.upright_count(), self.len())
    }

    /// Height that no segment rises above, local metres.
    #[must_use]
    pub fn top(&self) -> f32 {
        self.top
    }

    /// Returns the starts of the segments, local metres, in no particular order: just before the first returns. For
    /// pulses from above these are the lower ends.
    pub fn lower_ends(&self) -> impl ExactSizeIterator<Item = [f32; 3]> + '_ {
        self.free_segments.iter().map(|free_segment| free_segment.start)
    }

    /// Calls `visit` with the lower and upper end of every upright segment that may pass over a level rectangle. Ends
    /// and the corners `low` and `high` are local metres; the order is arbitrary.
    pub(crate) fn each_upright_over(&self, over: [[f64; 2]; 2], mut visit: impl FnMut([[f64; 3]; 2])) {
        for tree in self.trees.iter().filter(|tree| tree.way == SegmentAxis::UP) {
            let _ = tree.walk(
                &mut (),
                |node, ()| may_pass_over(node, over),
                |numbers, ()| {
                    for free_segment in &self.free_segments[numbers] {
                        let (start, up) = (free_segment.start.map(f64::from), free_segment.direction.map(f64::from));
                        visit([start, std::array::from_fn(|i| start[i] + f64::from(free_segment.length) * up[i])]);
                    }
                    ControlFlow::Continue(())
                },
            );
        }
    }

    /// Returns true if a free segment passes nearer than `distance` metres to `point`, local metres. The distance is
    /// computed in f64. The answer is false for a point or distance that is not a number.
    #[must_use]
    pub fn passes_within(&self, point: [f64; 3], distance: f64) -> bool {
        let found = self.visit_near(point, distance, |free_segments| {
            let near = |free_segment: &FreeSegment| free_segment.square_distance(point) < distance * distance;
            if free_segments.iter().any(near) { ControlFlow::Break(()) } else { ControlFlow::Continue(distance) }
        });
        found.is_some()
    }

    /// Distance of the nearest free segment to `point`, local metres, if it is less than `within` metres.
    #[must_use]
    pub fn nearest_distance(&self, point: [f64; 3], within: f64) -> Option<f64> {
        self.nearest_but(point, within, 0.0)
    }

    /// A distance from `point`, local metres, within which there is no free segment: that of the nearest one, or a few
    /// millimetres less, at most `within` metres.
    #[must_use]
    pub fn free_distance(&self, point: [f64; 3], within: f64) -> f64 {
        // near by first: where pulses are dense, many thousands pass within some metres
        let nearest =
            [0.25, 0.5, 1.0].into_iter().find_map(|share| self.nearest_but(point, share * within, WORTH_LOOKING));
        nearest.map_or(within, |distance| (distance - WORTH_LOOKING).max(0.0))
    }

    /// The distance of the nearest segment, or of one that is farther by at most `slack` metres, if any is nearer than
    /// `within` metres.
    fn nearest_but(&self, point: [f64; 3], within: f64, slack: f64) -> Option<f64> {
        let mut min = within * within;
        let mut found = false;
        let _: Option<()> = self.visit_near(point, within, |free_segments| {
            for free_segment in free_segments {
                let square = free_segment.square_distance(point);
                if square < min {
                    (min, found) = (square, true);
                }
            }
            ControlFlow::Continue((min.sqrt() - slack).max(0.0))
        });
        found.then(|| min.sqrt())
    }

    /// Largest radius of a ball about `center`, local metres, that no segment comes nearer to than a millimetre, at
    /// most `max` metres; 0 where there is none.
    #[must_use]
    pub fn clearance(&self, center: [f32; 3], max: f32) -> f32 {
        self.nearest_distance(center.map(f64::from), (max + GAP_M).into())
            .map_or(max, |distance| (to_f32(distance) - GAP_M).max(0.0))
    }

    /// Returns an interval of the line through `origin` along the unit vector `direction` on which one segment is
    /// nearer than `distance` metres everywhere. The interval, metres from the origin, contains `at`, well inside.
    /// `None` if no segment is that near at `at`, or if the interval is shorter than 4 mm.
    ///
    /// Of several segments it takes one that stays near over a long piece, not always the one with the longest piece.
    #[must_use]
    pub fn near_piece(&self, origin: [f64; 3], direction: [f64; 3], at: f64, distance: f64) -> Option<[f64; 2]> {
        // a piece that is long enough is near there as well
        let further = std::array::from_fn(|i| origin[i] + (at + MIN_PIECE) * direction[i]);
        self.visit_near(further, distance, |free_segments| {
            let near = |free_segment: &&FreeSegment| free_segment.square_distance(further) < distance * distance;
            let pieces = free_segments
                .iter()
                .filter(near)
                .filter_map(|free_segment| free_segment.near_piece(origin, direction, distance));
            let holding = pieces.filter(|[from, to]| *from <= at && *to > at + MIN_PIECE);
            match holding.max_by(|a, b| a[1].total_cmp(&b[1])) {
                Some(piece) => ControlFlow::Break(piece),
                None => ControlFlow::Continue(distance),
            }
        })
    }

    /// Calls `visit` with the segments of every leaf that may come nearer than `reach` metres to `point`, until it
    /// breaks off. The value that it continues with is the reach for the rest of the search.
    fn visit_near<T>(
        &self,
        point: [f64; 3],
        reach: f64,
        mut visit: impl FnMut(&[FreeSegment]) -> ControlFlow<T, f64>,
    ) -> Option<T> {
        // rounded up, and `may_enter` adds the rounding of coordinates
        let up = |reach: f64| to_f32(reach).next_up();
        let center = point.map(to_f32);
        if !(reach > 0.0) || !center.iter().all(|v| v.is_finite()) {
            return None;
        }
        let mut state = (up(reach), None);
        for tree in &self.trees {
            let may_enter = |node: &SegmentNode, (reach, _): &(f32, Option<T>)| tree.may_enter(node, center, *reach);
            let flow =
                tree.walk(&mut state, may_enter, |numbers, (reach, found)| match visit(&self.free_segments[numbers]) {
                    ControlFlow::Break(value) => {
                        *found = Some(value);
                        ControlFlow::Break(())
                    }
                    ControlFlow::Continue(shorter) => {
                        *reach = up(shorter);
                        ControlFlow::Continue(())
                    }
                });
            if flow.is_break() {
                break;
            }
        }
        state.1
    }
}

/// Returns true if pulses, not yet free segments, come from a scanner on the ground. Each is given by its first return
/// and scanner position, local metres; pulses with an unknown scanner do not count.
pub(crate) fn come_from_the_ground(pulses: impl Iterator<Item = ([f32; 3], [f32; 3])>) -> bool {
    let way =
        |(end, scanner): ([f32; 3], [f32; 3])| SegmentAxis::of(unit(sub(scanner.map(f64::from), end.map(f64::from)))?);
    let (mut flat_count, mut count) = (0, 0);
    for way in pulses.filter_map(way) {
        count += 1;
        flat_count += usize::from(way != SegmentAxis::UP);
    }
    are_flat(flat_count, count)
}

/// Returns true if the share of flat pulses is too large for an aircraft.
fn are_flat(flat_count: usize, count: usize) -> bool {
    count > 0 && flat_count as f64 >= MIN_FLAT_SHARE * count as f64
}

/// Returns true if the box of a node of upright segments lies over a rectangle at some height.
fn may_pass_over(node: &SegmentNode, [low, high]: [[f64; 2]; 2]) -> bool {
    // shares of the way between the planes, with room for what f32 rounds
    let mut shares: [f64; 2] = [-1e-4, 1.0 + 1e-4];
    for axis in 0..2 {
        let ends = |side: usize| [f64::from(node.below[side]), f64::from(node.above[side])];
        let ([west, to_west], [east, to_east]) = (ends(axis), ends(axis + 2));
        // west ≤ high and −east ≤ −low, both linear in the share
        for [at, slope, max] in [[west, to_west - west, high[axis]], [-east, east - to_east, -low[axis]]] {
            let left = max + 1e-2 - at;
            if slope > 0.0 {
                shares[1] = shares[1].min(left / slope);
            } else if slope < 0.0 {
                shares[0] = shares[0].max(left / slope);
            } else if left < 0.0 {
                return false;
            }
        }
    }
    shares[0] <= shares[1]
}

impl FreeSegment {
    /// Squared distance of a point to the segment, m².
    fn square_distance(&self, point: [f64; 3]) -> f64 {
        let (from, up) = (sub(point, self.start.map(f64::from)), self.direction.map(f64::from));
        let along = dot(from, up).clamp(0.0, f64::from(self.length));
        let off: [f64; 3] = std::array::from_fn(|i| from[i] - along * up[i]);
        dot(off, off)
    }

    /// The piece of a line nearer than `distance` to the segment: the intersection with a cylinder and two spheres,
    /// whose union is convex.
    fn near_piece(&self, origin: [f64; 3], direction: [f64; 3], distance: f64) -> Option<[f64; 2]> {
        let up = self.direction.map(f64::from);
        let length = f64::from(self.length);
        let from = sub(origin, self.start.map(f64::from));
        let square = distance * distance;
        // where |w + t d|² < distance²
        let roots = |a: f64, b: f64, c: f64| {
            let discriminant = b * b - a * c;
            (a > 1e-12 && discriminant > 0.0).then(|| [(-b - discriminant.sqrt()) / a, (-b + discriminant.sqrt()) / a])
        };
        let of_sphere = |from: [f64; 3]| roots(1.0, dot(from, direction), dot(from, from) - square);
        let low = of_sphere(from);
        let high = of_sphere(std::array::from_fn(|i| from[i] - length * up[i]));
        let (rise, base) = (dot(direction, up), dot(from, up));
        let across: [f64; 3] = std::array::from_fn(|i| direction[i] - rise * up[i]);
        let beside: [f64; 3] = std::array::from_fn(|i| from[i] - base * up[i]);
        let (a, c) = (dot(across, across), dot(beside, beside) - square);
        let endless = (a <= 1e-12 && c < 0.0).then_some([f64::NEG_INFINITY, f64::INFINITY]);
        let cylinder = roots(a, dot(across, beside), c).or(endless).and_then(|[mut from, mut to]| {
            // between the ends of the segment
            if rise.abs() > 1e-12 {
                let ends = [-base / rise, (length - base) / rise];
                from = from.max(ends[0].min(ends[1]));
                to = to.min(ends[0].max(ends[1]));
            } else if !(0.0..=length).contains(&base) {
                return None;
            }
            (from < to).then_some([from, to])
        });
        [low, high, cylinder].into_iter().flatten().reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
    }
}
