//! Edges of roofs: straight lines between returns on a plane and pulses that passed it.

use super::block::Block;
use super::likelihood::{LikelihoodTable, likeliest};
use super::line::PlanLine;
use super::ridges::RidgeLine;
use super::roof_planes::{NONE, Roofs};
use super::{EdgeParams, PlaneParams, sheets};
use crate::ground::sides;

/// Minimum depth below the plane at which a pulse that passed it ends, metres. With 0.3, pulses that meet the wall
/// close below an edge are left out, and edges lie a centimetre too far out.
pub(super) const PASSED: f64 = 0.15;
/// Maximum height above the plane of points of buildings that show that the building goes on, metres.
const ABOVE: f64 = 4.0;
/// Minimum share of the returns within that lie on the plane itself.
const MIN_OWN_SHARE: f64 = 0.3;
/// Width inside a line within which these are counted, spacings.
const OWN_SPACINGS: f64 = 3.2;
/// Maximum distance of samples from the returns of the plane, spacings.
const REACH_SPACINGS: f64 = 4.5;
/// Longest side between a return and a pulse that passed, spacings.
const SIDE_SPACINGS: f64 = 4.0;
/// Half width of the band about a line in which middles of sides belong to it, spacings.
const BAND_SPACINGS: f64 = 0.6;
/// The same while a line begins to grow, and how often.
const WIDE_BAND_SPACINGS: f64 = 0.9;
const WIDE_TURNS: usize = 4;
/// Cosine of the maximum turn between pieces of one line, 26°. Then the maximum increase of the root mean square
/// distance of their middles from it, over lines of their own, spacings: a step of two thirds of a spacing between two
/// halves.
const JOINED_COSINE: f64 = 0.9;
const JOINED_SPACINGS: f64 = 0.36;
/// Longest gap of a line, spacings.
const GAP_SPACINGS: f64 = 5.0;
/// Distance beside a line within which middles are no lines of their own, spacings.
const BESIDE_SPACINGS: f64 = 1.2;
/// Radius around a middle within which others show its direction, spacings.
const AROUND_SPACINGS: f64 = 5.0;
/// Middles on a line at least, and its least length, metres.
const MIN_MIDDLES: usize = 4;
const MIN_LENGTH: f64 = 1.0;
/// Maximum shift of an end to a crossing with another line of the plane, spacings.
const END_SPACINGS: f64 = 3.5;
/// Middles of sides that share a return or a pulse are not independent: how many count as one.
const MIDDLES_AS_ONE: f64 = 6.0;
/// Standard deviation of the errors that no number of pulses averages out, metres: the maximum distance of an axis
/// outside an edge whose beam is still partly returned.
const COMMON_SD: f64 = 0.02;

/// An edge of a plane in plan.
#[derive(Clone, Debug)]
pub(super) struct EdgeLine {
    /// The roof lies to the left.
    pub(super) line: PlanLine,
    /// Standard deviation across, metres.
    pub(super) sd: f64,
    pub(super) count: usize,
    /// Median height of the returns below, metres below the plane.
    pub(super) drop: f64,
    /// True if it is known well enough to cut balls and to end patches.
    pub(super) is_sure: bool,
    /// True if it is known well enough to search for a wall below.
    pub(super) may_have_wall: bool,
    /// Parapet along it.
    pub(super) parapet: Parapet,
}

/// Parapet of one height along an edge.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Parapet {
    /// Metres above the plane; 0 where nothing stands.
    pub(super) height: f64,
    /// Distance from the edge to its inner face, metres.
    pub(super) width: f64,
}

/// A place in plan where a pulse passed the plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Passed {
    pub(super) p: [f64; 2],
    /// Depth below the plane at which it ended, metres.
    pub(super) depth: f64,
    /// The plane it ended on, [`NONE`] for none.
    pub(super) on: u32,
}

/// A return of a building above a plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Standing {
    pub(super) p: [f64; 2],
    /// Height above the plane, metres.
    pub(super) above: f64,
    /// Height, metres.
    pub(super) height: f64,
    /// True if it lies on no plane of its own, or on one that is no larger than a box.
    pub(super) is_loose: bool,
}

/// Boundary of a plane.
#[derive(Clone, Debug, Default)]
pub(super) struct Outline {
    pub(super) edges: Vec<EdgeLine>,
    /// Returns within: of the plane, and of objects on it.
    pub(super) inside: Vec<[f64; 2]>,
    /// Number of these, from the first, that belong to the plane itself.
    pub(super) own: usize,
    /// Returns of the plane whose pulse went on beside it. Where a beam is split the edge lies in its middle, wherever
    /// the return is: it is no more within than without.
    pub(super) split: Vec<[f64; 2]>,
    /// Pulses that passed near it.
    pub(super) passed: Vec<Passed>,
    /// Points that stand on the plane.
    pub(super) standing: Vec<Standing>,
}

/// A middle of a side between a return and a pulse that passed.
#[derive(Clone, Copy, Debug)]
struct Middle {
    p: [f64; 2],
    /// Unit vector from the return to the pulse.
    out: [f64; 2],
    depth: f64,
}

/// The outline of a plane.
pub(super) fn find(
    block: &Block,
    roofs: &Roofs,
    ridges: &[RidgeLine],
    plane: usize,
    params: &PlaneParams,
    table: &LikelihoodTable,
) -> Outline {
    let roof = &roofs.planes[plane];
    let mut outline = samples(block, roofs, ridges, plane);
    let middles = middles(&outline, roof.spacing);
    outline.edges = lines(&outline, &middles, roof.spacing, params, table);
    meet(&mut outline.edges, ridges, plane, END_SPACINGS * roof.spacing);
    outline.edges.retain(|edge| edge.line.length() >= MIN_LENGTH / 2.0);
    let parapets: Vec<Parapet> = outline.edges.iter().map(|edge| sheets::parapet(&outline, &edge.line)).collect();
    for (edge, parapet) in outline.edges.iter_mut().zip(parapets) {
        edge.parapet = parapet;
    }
    outline
}

/// A coarse picture in plan of where a plane has returns.
struct Near {
    low: [f64; 2],
    cell: f64,
    size: [usize; 2],
    holds: Vec<bool>,
}

impl Near {
    /// The cells within about `reach` of points.
    fn new(points: &[[f64; 2]], reach: f64) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for p in points {
            for axis in 0..2 {
                low[axis] = low[axis].min(p[axis] - reach);
                high[axis] = high[axis].max(p[axis] + reach);
            }
        }
        let cell = reach / 2.0;
        let size = [0, 1].map(|axis| index(high[axis] - low[axis], cell) + 1);
        let mut near = Self { low, cell, size, holds: vec![false; size[0] * size[1]] };
        for p in points {
            let [column, row] = [0, 1].map(|axis| index(p[axis] - low[axis], cell));
            for row in row.saturating_sub(2)..=(row + 2).min(size[1] - 1) {
                for column in column.saturating_sub(2)..=(column + 2).min(size[0] - 1) {
                    near.holds[row * size[0] + column] = true;
                }
            }
        }
        near
    }

    fn high(&self) -> [f64; 2] {
        [0, 1].map(|axis| self.low[axis] + self.size[axis] as f64 * self.cell)
    }

    fn holds(&self, p: [f64; 2]) -> bool {
        if (0..2).any(|axis| p[axis] < self.low[axis]) {
            return false;
        }
        let [column, row] = [0, 1].map(|axis| index(p[axis] - self.low[axis], self.cell));
        column < self.size[0] && row < self.size[1] && self.holds[row * self.size[0] + column]
    }
}

fn index(length: f64, cell: f64) -> usize {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "cells of a block, and saturating")]
    let index = (length / cell).max(0.0) as usize;
    index
}

/// Returns within a plane and pulses that passed it.
fn samples(block: &Block, roofs: &Roofs, ridges: &[RidgeLine], plane: usize) -> Outline {
    let roof = &roofs.planes[plane];
    let mut inside: Vec<[f64; 2]> = Vec::with_capacity(roof.rows.len() * 5 / 4);
    let mut split = Vec::new();
    for &row in &roof.rows {
        let found = &block.returns[roofs.return_of[row as usize] as usize];
        let [x, y, _] = found.p;
        // where the pulse meets the plane noise of the range does not matter
        let p = roof.plane.crossing(found.p, found.lean).unwrap_or([x, y]);
        if found.is_split { &mut split } else { &mut inside }.push(p);
    }
    let own = inside.len();
    let all: Vec<[f64; 2]> = inside.iter().chain(&split).copied().collect();
    let near = Near::new(&all, REACH_SPACINGS * roof.spacing);
    let beyond: Vec<usize> = ridges
        .iter()
        .filter(|ridge| ridge.is_convex && ridge.planes.contains(&plane))
        .map(|ridge| if ridge.planes[0] == plane { ridge.planes[1] } else { ridge.planes[0] })
        .collect();
    let (mut passed, mut standing) = (Vec::new(), Vec::new());
    let (low, high) = (near.low, near.high());
    let corners = [[low[0], low[1]], [low[0], high[1]], [high[0], low[1]], [high[0], high[1]]];
    let top = corners.iter().map(|&p| roof.plane.height(p)).fold(f64::NEG_INFINITY, f64::max);
    let shift = block.max_shift(top);
    block.each_in([0, 1].map(|i| low[i] - shift), [0, 1].map(|i| high[i] + shift), |row, found| {
        let on = roofs.plane_of_return[row];
        if on as usize == plane {
            return;
        }
        let above = roof.plane.distance_above(found.p);
        let at = [found.p[0], found.p[1]];
        if above > 0.0 {
            if found.may_be_building() && above < ABOVE && above > 3.0 * roofs.noise && near.holds(at) {
                inside.push(at);
                let is_loose = roofs.planes.get(on as usize).is_none_or(|roof| roof.is_small);
                standing.push(Standing { p: at, above, height: found.p[2], is_loose });
            }
            return;
        }
        if !found.is_first || above > -(4.0 * roofs.noise).max(0.1) || (on != NONE && beyond.contains(&(on as usize))) {
            return;
        }
        if let Some(p) = roof.plane.crossing(found.p, found.lean).filter(|&p| near.holds(p)) {
            passed.push(Passed { p, depth: -above, on });
        }
    });
    Outline { edges: Vec::new(), inside, own, split, passed, standing }
}

/// Middles of the sides between returns and pulses that passed, in the triangulation of both.
fn middles(outline: &Outline, spacing: f64) -> Vec<Middle> {
    let passed: Vec<&Passed> = outline.passed.iter().filter(|passed| passed.depth > PASSED).collect();
    let inside = outline.inside.len();
    if passed.is_empty() {
        return Vec::new();
    }
    let points: Vec<[f64; 2]> = outline.inside.iter().copied().chain(passed.iter().map(|passed| passed.p)).collect();
    let mut middles = Vec::new();
    for [start, end] in sides(&points) {
        let (within, out) = (start.min(end), start.max(end));
        if within >= inside || out < inside {
            continue;
        }
        let (a, b) = (points[within], points[out]);
        let [x, y] = [b[0] - a[0], b[1] - a[1]];
        let length = x.hypot(y);
        if length > SIDE_SPACINGS * spacing || length < 1e-6 {
            continue;
        }
        middles.push(Middle {
            p: [f64::midpoint(a[0], b[0]), f64::midpoint(a[1], b[1])],
            out: [x / length, y / length],
            depth: passed[out - inside].depth,
        });
    }
    middles.sort_unstable_by(|a, b| a.p[0].total_cmp(&b.p[0]).then(a.p[1].total_cmp(&b.p[1])));
    middles
}

/// A line while it grows.
struct Grown {
    line: PlanLine,
    rows: Vec<usize>,
    rms: f64,
}

/// Straight lines that middles lie on, each grown from where they are straightest.
fn lines(
    outline: &Outline,
    middles: &[Middle],
    spacing: f64,
    params: &PlaneParams,
    table: &LikelihoodTable,
) -> Vec<EdgeLine> {
    let mut seeds: Vec<(f64, usize, PlanLine)> = Vec::new();
    for row in 0..middles.len() {
        if let Some((line, rms)) = line_through_middles(middles, row, AROUND_SPACINGS * spacing) {
            seeds.push((rms, row, line));
        }
    }
    seeds.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let mut is_free = vec![true; middles.len()];
    let mut pieces = Vec::new();
    for (_, seed, line) in seeds {
        if !is_free[seed] {
            continue;
        }
        let Some(grown) = grown(middles, seed, line, &is_free, spacing) else { continue };
        // what lies beside a line is of it, too
        for (row, middle) in middles.iter().enumerate() {
            let [t, d] = grown.line.of(middle.p);
            let is_beside = d.abs() <= BESIDE_SPACINGS * spacing && faces(middle, grown.line.outward());
            is_free[row] &= !(is_beside && (grown.line.ends[0]..=grown.line.ends[1]).contains(&t));
        }
        pieces.push(grown);
    }
    join(middles, &mut pieces, spacing);
    pieces.retain(|piece| own_share(outline, &piece.line, OWN_SPACINGS * spacing) >= MIN_OWN_SHARE);
    pieces.iter().map(|piece| edge(outline, middles, piece, spacing, params, table)).collect()
}

/// The edge that a line of middles shows.
fn edge(
    outline: &Outline,
    middles: &[Middle],
    piece: &Grown,
    spacing: f64,
    params: &PlaneParams,
    table: &LikelihoodTable,
) -> EdgeLine {
    let mut depths: Vec<f64> = piece.rows.iter().map(|&row| middles[row].depth).collect();
    depths.sort_unstable_by(f64::total_cmp);
    let (line, sd) = likeliest(outline, &piece.line, spacing, table);
    let sd = sd.hypot(COMMON_SD);
    let scatter = piece.rms / (piece.rows.len() as f64 / MIDDLES_AS_ONE).max(1.0).sqrt();
    let EdgeParams { max_sd, max_scatter, max_sd_spacings, max_scatter_spacings } = params.edges;
    EdgeLine {
        line,
        sd,
        count: piece.rows.len(),
        drop: depths.get(depths.len() / 2).copied().unwrap_or(0.0),
        is_sure: sd <= max_sd && scatter <= max_scatter,
        may_have_wall: sd <= max_sd.max(max_sd_spacings * spacing)
            && scatter <= max_scatter.max(max_scatter_spacings * spacing),
        parapet: Parapet::default(),
    }
}

/// Joins pieces that follow each other on one line: those that began as short pieces have directions of their own.
fn join(middles: &[Middle], pieces: &mut Vec<Grown>, spacing: f64) {
    let mut first = 0;
    while first < pieces.len() {
        let joined = (first + 1..pieces.len()).find_map(|other| {
            let (a, b) = (&pieces[first], &pieces[other]);
            let cosine = a.line.along[0] * b.line.along[0] + a.line.along[1] * b.line.along[1];
            let [s, t] = b.line.end_points().map(|p| a.line.of(p)[0]);
            let gap = (s - a.line.ends[1]).max(a.line.ends[0] - t);
            if cosine < JOINED_COSINE || gap > GAP_SPACINGS * spacing {
                return None;
            }
            let mut rows: Vec<usize> = a.rows.iter().chain(&b.rows).copied().collect();
            rows.sort_unstable();
            let (line, rms) = PlanLine::fit(rows.iter().map(|&row| middles[row].p), a.line.along)?;
            let [n, m] = [a.rows.len() as f64, b.rows.len() as f64];
            let apart = (n * a.rms.powi(2) + m * b.rms.powi(2)) / (n + m);
            let may_differ = apart + (JOINED_SPACINGS * spacing).powi(2);
            (rms.powi(2) <= may_differ).then_some((other, Grown { line, rows, rms }))
        });
        match joined {
            Some((other, grown)) => {
                pieces.swap_remove(other);
                pieces[first] = grown;
                // the longer line may reach others
                first = 0;
            }
            None => first += 1,
        }
    }
}

/// Share of the returns within a line that lie on the plane itself: the others may stand on something else.
fn own_share(outline: &Outline, line: &PlanLine, reach: f64) -> f64 {
    let (mut own, mut all) = (0_usize, 0_usize);
    for (number, &p) in outline.inside.iter().enumerate() {
        let [t, d] = line.of(p);
        if (-reach..=0.0).contains(&d) && (line.ends[0]..=line.ends[1]).contains(&t) {
            all += 1;
            own += usize::from(number < outline.own);
        }
    }
    own as f64 / all.max(1) as f64
}

/// The line through the middles about one, with the roof to its left.
fn line_through_middles(middles: &[Middle], row: usize, reach: f64) -> Option<(PlanLine, f64)> {
    let Middle { p, out, .. } = middles[row];
    let first = middles.partition_point(|middle| middle.p[0] < p[0] - reach);
    let near: Vec<[f64; 2]> = middles[first..]
        .iter()
        .take_while(|middle| middle.p[0] <= p[0] + reach)
        .filter(|middle| (middle.p[1] - p[1]).abs() <= reach && faces(middle, out))
        .map(|middle| middle.p)
        .collect();
    if near.len() < MIN_MIDDLES {
        return None;
    }
    PlanLine::fit(near.iter().copied(), [-out[1], out[0]])
}

/// Returns true if the outward direction at a middle is about the same.
fn faces(middle: &Middle, out: [f64; 2]) -> bool {
    middle.out[0] * out[0] + middle.out[1] * out[1] > 0.0
}

/// The line that grows from a seed as far as free middles go on in its band.
fn grown(middles: &[Middle], seed: usize, line: PlanLine, is_free: &[bool], spacing: f64) -> Option<Grown> {
    let gap = GAP_SPACINGS * spacing;
    let mut grown = Grown { line, rows: Vec::new(), rms: 0.0 };
    for turn in 0..10 {
        // a short piece has another direction than the whole
        let band = if turn < WIDE_TURNS { WIDE_BAND_SPACINGS } else { BAND_SPACINGS } * spacing;
        let out = grown.line.outward();
        let mut on: Vec<(f64, usize)> = Vec::new();
        for (row, middle) in middles.iter().enumerate() {
            let [t, d] = grown.line.of(middle.p);
            if d.abs() <= band && is_free[row] && middle.out[0] * out[0] + middle.out[1] * out[1] > 0.3 {
                on.push((t, row));
            }
        }
        on.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let at = grown.line.of(middles[seed].p)[0];
        let (mut first, mut last) = (on.partition_point(|&(t, _)| t < at), on.partition_point(|&(t, _)| t <= at));
        while first > 0 && on.get(first).map_or(at, |&(t, _)| t) - on[first - 1].0 <= gap {
            first -= 1;
        }
        while last < on.len() && on[last].0 - (if last > 0 { on[last - 1].0 } else { at }) <= gap {
            last += 1;
        }
        let mut rows: Vec<usize> = on[first..last].iter().map(|&(_, row)| row).collect();
        if rows.len() < MIN_MIDDLES {
            return None;
        }
        rows.sort_unstable();
        let is_same = rows == grown.rows;
        let (line, rms) = PlanLine::fit(rows.iter().map(|&row| middles[row].p), grown.line.along)?;
        grown = Grown { line, rows, rms };
        if is_same && turn >= WIDE_TURNS {
            break;
        }
    }
    (grown.line.length() >= MIN_LENGTH).then_some(grown)
}

/// Moves ends of lines to where they cross others of the plane, or its ridges, near by.
fn meet(edges: &mut [EdgeLine], ridges: &[RidgeLine], plane: usize, reach: f64) {
    let of_plane = ridges.iter().filter(|ridge| ridge.planes.contains(&plane)).map(|ridge| ridge.line);
    let lines: Vec<PlanLine> = edges.iter().map(|edge| edge.line).chain(of_plane).collect();
    for (number, edge) in edges.iter_mut().enumerate() {
        for end in 0..2 {
            let at = lines[number].ends[end];
            let mut best: Option<f64> = None;
            for (_, other) in lines.iter().enumerate().filter(|&(other, _)| other != number) {
                let Some(crossing) = lines[number].crossing(other) else { continue };
                let [on_other, _] = other.of(lines[number].at(crossing, 0.0));
                let is_near = (other.ends[0] - reach..=other.ends[1] + reach).contains(&on_other);
                let moves = (crossing - at).abs();
                if is_near && moves <= reach && best.is_none_or(|best| moves < (best - at).abs()) {
                    best = Some(crossing);
                }
            }
            edge.line.ends[end] = best.unwrap_or(at);
        }
        if edge.line.length() < 0.0 {
            edge.line.ends = lines[number].ends;
        }
    }
}
