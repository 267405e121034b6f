//! Pulses as proven-empty lines, indexed so that a pencil of balls finds the one that cuts it most.

mod columns;
mod proximity;

pub use belvedere_data::needles::NeedleColumns;
pub(crate) use columns::lower_ends;

use crate::neighbors::Tangent;
use belvedere_data::control::{Control, Stop};
use belvedere_data::vector::{dot, sub};
use belvedere_data::{Error, PointCloud, Result};
use serde::Serialize;

/// Needles in a leaf.
const LEAF: usize = 8;
/// Below this many needles a thread goes on alone.
const PARALLEL: usize = 8192;
/// Pulses between two looks at whether to go on.
const CHECK_EACH: usize = 4096;
/// A needle that rises less than this per metre of its length is left out: its line leaves the scene before it reaches the
/// two planes that the index measures at.
const LEAST_RISE: f64 = 0.3;

/// How pulses become needles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NeedleParams {
    /// Length before the first return that is not counted as empty, metres, 0 to 1. Default 0.05: the noise of a range.
    pub end_margin: f32,
    /// Height above the highest return up to which needles reach, metres, above 0. Default 2; nothing stands higher.
    pub headroom: f32,
}

impl Default for NeedleParams {
    fn default() -> Self {
        Self { end_margin: 0.05, headroom: 2.0 }
    }
}

/// A proven-empty piece of a line, from just above a first return upward.
#[derive(Clone, Copy, Debug)]
struct Needle {
    start: [f32; 3],
    /// Unit vector towards the scanner.
    up: [f32; 3],
    length: f32,
}

/// Where the needles of a node lie: their box at the lower and at the upper plane, and the heights they span. Between the
/// planes lines are straight, so that at any height they lie within the box interpolated between the two.
#[derive(Clone, Copy, Debug)]
struct Node {
    /// West, south, east, north at the lower plane.
    below: [f32; 4],
    above: [f32; 4],
    heights: [f32; 2],
    /// The first needle of a leaf, or the second child; the first child follows its parent.
    next: u32,
    /// Needles of a leaf; 0 for an inner node.
    count: u32,
}

/// The needles of a survey.
pub struct Needles {
    needles: Vec<Needle>,
    nodes: Vec<Node>,
    /// Heights of the two planes.
    planes: [f32; 2],
}

/// How many pulses became needles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct NeedleReport {
    /// Needles.
    #[serde(rename = "pulses_used")]
    pub used: usize,
    /// First returns whose scanner position is unknown.
    #[serde(rename = "pulses_without_scanner")]
    pub without_scanner: usize,
    /// Pulses too flat for the index.
    #[serde(rename = "pulses_too_flat")]
    pub too_flat: usize,
}

impl Needles {
    /// Needles of the first returns of `cloud`, all its points where it has no return numbers, for scanners at `scanner`, (N, 3)
    /// local metres, NaN where unknown.
    ///
    /// # Errors
    /// [`Error::LengthMismatch`] unless there is a scanner position for each point; [`Error::Cancelled`].
    pub fn of_cloud(
        cloud: &PointCloud,
        scanner: &[[f32; 3]],
        params: &NeedleParams,
        control: &Control<'_>,
    ) -> Result<(Self, NeedleReport)> {
        cloud.validate()?;
        if scanner.len() != cloud.len() {
            return Err(Error::LengthMismatch {
                what: "scanner positions",
                expected: cloud.len(),
                found: scanner.len(),
            });
        }
        let numbers = cloud.attributes.return_number.as_deref();
        let is_first = |row: &usize| numbers.is_none_or(|numbers| numbers[*row] <= 1);
        let rows = || (0..cloud.len()).filter(is_first);
        let returns: Vec<[f32; 3]> = rows().map(|row| cloud.positions[row]).collect();
        let scanner: Vec<[f32; 3]> = rows().map(|row| scanner[row]).collect();
        Self::new(&returns, &scanner, params, control)
    }

    /// Needles from `first_returns`, (N, 3) local metres, towards `scanner`, (N, 3) local metres, NaN where unknown.
    ///
    /// # Errors
    /// [`Error::LengthMismatch`] where the two differ in length; [`Error::Cancelled`].
    pub fn new(
        first_returns: &[[f32; 3]],
        scanner: &[[f32; 3]],
        params: &NeedleParams,
        control: &Control<'_>,
    ) -> Result<(Self, NeedleReport)> {
        if scanner.len() != first_returns.len() {
            return Err(Error::LengthMismatch {
                what: "scanner positions",
                expected: first_returns.len(),
                found: scanner.len(),
            });
        }
        let heights = first_returns.iter().map(|p| p[2]).filter(|z| z.is_finite());
        let (low, high) = heights.fold((f32::INFINITY, f32::NEG_INFINITY), |(l, h), z| (l.min(z), h.max(z)));
        let planes = [low, high + params.headroom];
        let mut report = NeedleReport::default();
        let mut items: Vec<Item> = Vec::with_capacity(first_returns.len());
        for (number, (p, s)) in first_returns.iter().zip(scanner).enumerate() {
            if number % CHECK_EACH == 0 {
                control.check()?;
            }
            if !s.iter().chain(p).all(|v| v.is_finite()) {
                report.without_scanner += 1;
                continue;
            }
            let sight: [f64; 3] = std::array::from_fn(|i| f64::from(s[i]) - f64::from(p[i]));
            let range = dot(sight, sight).sqrt();
            let up = sight.map(|v| v / range);
            if !(up[2] > LEAST_RISE) {
                report.too_flat += 1;
                continue;
            }
            let margin = f64::from(params.end_margin);
            let start: [f64; 3] = std::array::from_fn(|i| f64::from(p[i]) + margin * up[i]);
            let length = ((f64::from(planes[1]) - start[2]) / up[2]).min(range - margin);
            if length > 0.0 {
                items.push(Item::new(start, up, length, planes));
            }
        }
        report.used = items.len();
        Ok((Self::index(items, planes, control)?, report))
    }

    fn index(mut items: Vec<Item>, planes: [f32; 2], control: &Control<'_>) -> Result<Self> {
        let stop = Stop::new(control);
        let mut nodes = vec![Node::EMPTY; node_count(items.len())];
        build(&mut items, 0, &mut nodes, 0, &stop, control);
        stop.check()?;
        Ok(Self { needles: items.into_iter().map(|item| item.needle).collect(), nodes, planes })
    }

    /// Where needle `number` begins, local metres; the unit vector along it, upward; and its length, metres. `None` from
    /// [`Needles::len`] on. Their order is that of the index.
    #[must_use]
    pub fn segment(&self, number: usize) -> Option<([f32; 3], [f32; 3], f32)> {
        self.needles.get(number).map(|needle| (needle.start, needle.up, needle.length))
    }

    /// The greatest radius, below `max_radius`, of the balls of a pencil that no needle enters, or `None` where no needle
    /// enters the ball of `max_radius`. Metres.
    ///
    /// # Source
    /// The closed form for a line is this project's: the ball of the pencil through a point at t metres along a needle
    /// has the radius |p′−a−tu|² / 2 n·(p′−a−tu), a convex function of t.
    #[must_use]
    pub fn smallest_tangent_ball(&self, tangent: &Tangent, max_radius: f32) -> Option<f32> {
        if self.needles.is_empty() || !(max_radius > 0.0) {
            return None;
        }
        let touching = tangent.center(0.0);
        let mut radius = max_radius;
        let mut cut = false;
        let mut stack = [0_u32; 64];
        let mut depth = 1;
        while depth > 0 {
            depth -= 1;
            let index = stack[depth] as usize;
            let node = &self.nodes[index];
            if !self.may_enter(node, tangent.center(radius), radius) {
                continue;
            }
            if node.count == 0 {
                #[expect(clippy::cast_possible_truncation, reason = "nodes are numbered with 32 bits")]
                let first = index as u32 + 1;
                stack[depth] = node.next;
                stack[depth + 1] = first;
                depth += 2;
                continue;
            }
            let first = node.next as usize;
            for needle in &self.needles[first..first + node.count as usize] {
                if let Some(found) = needle.tangent_radius(touching, tangent.inward)
                    && found < f64::from(radius)
                {
                    #[expect(clippy::cast_possible_truncation, reason = "a radius in metres")]
                    let found = found as f32;
                    radius = found.max(0.0);
                    cut = true;
                }
            }
        }
        cut.then_some(radius)
    }

    /// Whether a needle below `node` may enter the ball.
    fn may_enter(&self, node: &Node, center: [f32; 3], radius: f32) -> bool {
        // rounding of f32 at coordinates of kilometres is a tenth of a millimetre
        let reach = radius * (1.0 + 1e-5) + 1e-3;
        let low = node.heights[0].max(center[2] - reach);
        let high = node.heights[1].min(center[2] + reach);
        if low > high {
            return false;
        }
        let span = (self.planes[1] - self.planes[0]).max(1e-3);
        let share = |z: f32| (z - self.planes[0]) / span;
        let (s, t) = (share(low), share(high));
        let mut square = 0.0;
        for (axis, center) in center.into_iter().take(2).enumerate() {
            let at = |share: f32, side: usize| node.below[side] + share * (node.above[side] - node.below[side]);
            let least = at(s, axis).min(at(t, axis));
            let most = at(s, axis + 2).max(at(t, axis + 2));
            let off = (least - center).max(center - most).max(0.0);
            square += off * off;
        }
        let off = (low - center[2]).max(center[2] - high).max(0.0);
        square + off * off < reach * reach
    }
}

impl Needle {
    /// Radius of the ball of the pencil through `touching` along `inward` that this needle touches, or `None` where it touches
    /// none.
    fn tangent_radius(&self, touching: [f32; 3], inward: [f32; 3]) -> Option<f64> {
        let (start, up) = (self.start.map(f64::from), self.up.map(f64::from));
        let inward = inward.map(f64::from);
        // q = a + t u lies on the ball of radius |q−p|² / 2 m·(q−p) with m inward
        let from = sub(start, touching.map(f64::from));
        let (alpha, beta) = (dot(inward, from), dot(inward, up));
        let (b, c) = (dot(from, up), dot(from, from));
        let length = f64::from(self.length);
        let ends = [0.0, length];
        let radius = |t: f64| {
            let height = alpha + beta * t;
            (height > 0.0).then(|| (c + 2.0 * b * t + t * t) / (2.0 * height))
        };
        let best = if beta.abs() < 1e-12 {
            -b
        } else {
            // the derivative vanishes where β t² + 2 α t + 2 α b − β c = 0; of its roots the one on the inner side
            let discriminant = (alpha * alpha - beta * (2.0 * alpha * b - beta * c)).max(0.0).sqrt();
            (-alpha + discriminant) / beta
        };
        let inside = radius(best.clamp(0.0, length));
        let at_ends = ends.into_iter().filter_map(radius).reduce(f64::min);
        inside.into_iter().chain(at_ends).reduce(f64::min)
    }
}

/// A needle on its way into the tree, with where its line meets the two planes.
#[derive(Clone, Copy)]
struct Item {
    needle: Needle,
    /// East and north at the lower plane, then at the upper.
    at: [f32; 4],
}

impl Item {
    #[expect(clippy::cast_possible_truncation, reason = "local coordinates")]
    fn new(start: [f64; 3], up: [f64; 3], length: f64, planes: [f32; 2]) -> Self {
        let at = |plane: f32, axis: usize| (start[axis] + (f64::from(plane) - start[2]) / up[2] * up[axis]) as f32;
        Self {
            needle: Needle { start: start.map(|v| v as f32), up: up.map(|v| v as f32), length: length as f32 },
            at: [at(planes[0], 0), at(planes[0], 1), at(planes[1], 0), at(planes[1], 1)],
        }
    }
}

impl Node {
    const EMPTY: Self =
        Self { below: [0.0; 4], above: [0.0; 4], heights: [f32::INFINITY, f32::NEG_INFINITY], next: 0, count: 0 };
}

/// Nodes of the tree over `count` needles.
fn node_count(count: usize) -> usize {
    if count <= LEAF { 1 } else { 1 + node_count(cut(count)) + node_count(count - cut(count)) }
}

/// Where a run is cut: into two runs of whole leaves, as equal as can be.
fn cut(count: usize) -> usize {
    count.div_ceil(LEAF) / 2 * LEAF
}

/// Builds the node over `items`, whose first needle is number `first`, into `nodes[0]`, and what is below it behind.
/// What is left when the work is cancelled is no tree.
fn build(items: &mut [Item], first: usize, nodes: &mut [Node], index: usize, stop: &Stop<'_>, control: &Control<'_>) {
    if items.len() > PARALLEL && stop.is_set() {
        return;
    }
    let mut node = Node::EMPTY;
    (node.below, node.above) = ([f32::INFINITY; 4], [f32::INFINITY; 4]);
    for side in 2..4 {
        (node.below[side], node.above[side]) = (f32::NEG_INFINITY, f32::NEG_INFINITY);
    }
    for item in items.iter() {
        for axis in 0..2 {
            node.below[axis] = node.below[axis].min(item.at[axis]);
            node.below[axis + 2] = node.below[axis + 2].max(item.at[axis]);
            node.above[axis] = node.above[axis].min(item.at[axis + 2]);
            node.above[axis + 2] = node.above[axis + 2].max(item.at[axis + 2]);
        }
        let start = item.needle.start[2];
        node.heights[0] = node.heights[0].min(start);
        node.heights[1] = node.heights[1].max(start + item.needle.up[2] * item.needle.length);
    }
    let Some((own, below)) = nodes.split_first_mut() else { return };
    #[expect(clippy::cast_possible_truncation, reason = "needles and nodes are numbered with 32 bits")]
    let number = |value: usize| value as u32;
    if items.len() <= LEAF {
        (node.next, node.count) = (number(first), number(items.len()));
        *own = node;
        return;
    }
    let extent = |k: usize| {
        let (bounds, axis) = if k < 2 { (&node.below, k) } else { (&node.above, k - 2) };
        bounds[axis + 2] - bounds[axis]
    };
    let widest = (1..4).fold(0, |widest, k| if extent(k) > extent(widest) { k } else { widest });
    let middle = cut(items.len());
    items.select_nth_unstable_by(middle, |a, b| a.at[widest].total_cmp(&b.at[widest]));
    let (left, right) = items.split_at_mut(middle);
    let left_nodes = node_count(left.len());
    node.next = number(index + 1 + left_nodes);
    *own = node;
    let (near, far) = below.split_at_mut(left_nodes);
    let far_index = index + 1 + left_nodes;
    if left.len() + right.len() > PARALLEL {
        rayon::join(
            || build(left, first, near, index + 1, stop, control),
            || build(right, first + middle, far, far_index, stop, control),
        );
    } else {
        build(left, first, near, index + 1, stop, control);
        build(right, first + middle, far, far_index, stop, control);
        if left.len() + right.len() > PARALLEL / 2 {
            control.advance(left.len() + right.len());
        }
    }
}
