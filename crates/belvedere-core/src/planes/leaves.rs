//! Leaves of roofs: convex pieces up to their edges and ridges.

use super::block::Block;
use super::cell_runs::{RowRuns, rectangles};
use super::edges::Outline;
use super::line::{PlanLine, SLIVER, area, clip};
use super::patches::{Patch, fan};
use super::ridges::{RidgeLine, convex};
use super::roof_planes::Roofs;
use belvedere_data::cast::to_index;
use belvedere_data::patches::PatchKind;
use belvedere_data::vector::{box_around, to_f32};

/// Parameters of the leaves of roofs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LeafParams {
    /// Side of the cells in which it is decided whether a surface is there, metres. Default 0.25.
    pub(super) cell: f64,
    /// Maximum distance of a roof from its returns, spacings. Default 1.5.
    pub(super) near_spacings: f64,
    /// The same beside an edge. Default 2.2.
    pub(super) beside_spacings: f64,
    /// Radius of the opening around a pulse that passed a roof, spacings. Default 0.5.
    pub(super) open_spacings: f64,
    /// Width beyond an edge within which the outside is cut off, spacings. Default 4.
    pub(super) outside_spacings: f64,
    /// Minimum area of a piece made of cells, m². Default 0.6: smaller ones lie beyond edges more often than they close
    /// anything.
    pub(super) min_area: f64,
    /// Length of a cut beyond the ends of a ridge, metres. Default 0.6.
    pub(super) ridge_beyond: f64,
    /// Minimum length of a line within a piece of a roof that splits it, metres. Default 0.3.
    pub(super) min_split: f64,
}

impl Default for LeafParams {
    fn default() -> Self {
        Self {
            cell: 0.25,
            near_spacings: 1.5,
            beside_spacings: 2.2,
            open_spacings: 0.5,
            outside_spacings: 4.0,
            min_area: 0.6,
            ridge_beyond: 0.6,
            min_split: 0.3,
        }
    }
}

/// A convex piece of a roof in plan, counter-clockwise.
#[derive(Clone, Debug)]
pub(super) struct Leaf {
    pub(super) plane: usize,
    pub(super) polygon: Vec<[f64; 2]>,
    /// True if lines bound it, false for cells.
    pub(super) is_whole: bool,
}

impl Leaf {
    /// Returns true if it holds a place in plan.
    pub(super) fn holds(&self, p: [f64; 2]) -> bool {
        self.polygon.iter().enumerate().all(|(i, a)| {
            let b = self.polygon[(i + 1) % self.polygon.len()];
            (b[0] - a[0]) * (p[1] - a[1]) >= (b[1] - a[1]) * (p[0] - a[0])
        })
    }
}

/// The leaves of all roofs.
pub(super) fn find(roofs: &Roofs, ridges: &[RidgeLine], outlines: &[Outline], params: &LeafParams) -> Vec<Leaf> {
    let has_points = |plane: &usize| {
        let samples = &outlines[*plane].samples;
        !(samples.inside.is_empty() && samples.split.is_empty())
    };
    let planes = (0..roofs.planes.len()).filter(has_points);
    planes.flat_map(|plane| leaves_of(roofs, ridges, &outlines[plane], plane, params)).collect()
}

/// The triangles of leaves within the block.
pub(super) fn patches(block: &Block, roofs: &Roofs, leaves: &[Leaf]) -> Vec<Patch> {
    let of_leaf = |leaf: &Leaf| {
        let plane = &roofs.planes[leaf.plane].plane;
        let polygon = block.clipped(&leaf.polygon);
        let corners: Vec<[f64; 3]> = polygon.iter().map(|&[x, y]| [x, y, plane.height([x, y])]).collect();
        fan(block, &corners, PatchKind::Roof)
    };
    leaves.iter().flat_map(of_leaf).collect()
}

/// The cells of a roof.
struct Cover {
    low: [f64; 2],
    size: [usize; 2],
    /// Side of a cell, metres.
    cell: f64,
    counts: Vec<bool>,
}

impl Cover {
    fn middle(&self, column: usize, row: usize) -> [f64; 2] {
        [self.low[0] + (column as f64 + 0.5) * self.cell, self.low[1] + (row as f64 + 0.5) * self.cell]
    }

    /// Columns, or rows, whose middles lie between two places.
    fn range(&self, axis: usize, from: f64, to: f64) -> std::ops::Range<usize> {
        let cells = |v: f64| ((v - self.low[axis]) / self.cell - 0.5).ceil().clamp(0.0, self.size[axis] as f64);
        let range = to_index(cells(from))..to_index(cells(to));
        range
    }

    /// Returns true if the cell of a place counts.
    fn holds(&self, p: [f64; 2]) -> bool {
        let [columns, rows] = [0, 1].map(|axis| self.range(axis, p[axis] - self.cell / 2.0, p[axis] + self.cell / 2.0));
        columns.start < self.size[0]
            && rows.start < self.size[1]
            && self.counts[rows.start * self.size[0] + columns.start]
    }

    /// Lessens the squared distances of cells within `reach` of a place to theirs.
    fn stamp(&self, distances: &mut [f32], p: [f64; 2], reach: f64) {
        for row in self.range(1, p[1] - reach, p[1] + reach) {
            for column in self.range(0, p[0] - reach, p[0] + reach) {
                let m = self.middle(column, row);
                let square = to_f32((m[0] - p[0]).powi(2) + (m[1] - p[1]).powi(2));
                let distance = &mut distances[row * self.size[0] + column];
                *distance = distance.min(square);
            }
        }
    }

    /// The cells of a plane that count.
    fn new(roofs: &Roofs, ridges: &[RidgeLine], outline: &Outline, plane: usize, params: &LeafParams) -> Self {
        let samples = &outline.samples;
        let roof = &roofs.planes[plane];
        let spacing = roof.spacing;
        let reach = params.beside_spacings * spacing;
        let [low, high] = box_around(samples.inside.iter().chain(&samples.split).copied());
        // cells of one grid, wherever the roof begins
        let low = low.map(|v| ((v - reach) / params.cell).floor() * params.cell);
        let high = high.map(|v| v + reach);
        let size = [0, 1].map(|axis| to_index(((high[axis] - low[axis]) / params.cell).ceil().max(1.0)));
        let mut cover = Self { low, size, cell: params.cell, counts: Vec::new() };
        let (mut to_return, mut to_passed) =
            (vec![f32::INFINITY; size[0] * size[1]], vec![f32::INFINITY; size[0] * size[1]]);
        for &p in samples.inside.iter().chain(&samples.split) {
            cover.stamp(&mut to_return, p, reach);
        }
        let lines: Vec<&PlanLine> = outline.sure_edges().map(|edge| &edge.line).collect();
        let beyond = params.outside_spacings * spacing;
        for passed in &samples.passed {
            let is_explained = lines.iter().any(|line| {
                let [t, d] = line.of(passed.p);
                (line.ends[0] - spacing..=line.ends[1] + spacing).contains(&t) && d > -0.1 && d < beyond + spacing
            });
            if !is_explained {
                cover.stamp(&mut to_passed, passed.p, params.near_spacings * spacing);
            }
        }
        let ridges: Vec<(&RidgeLine, usize)> = convex(ridges, plane).collect();
        let [near, beside, open] =
            [params.near_spacings, params.beside_spacings, params.open_spacings].map(|n| to_f32((n * spacing).powi(2)));
        let mut counts = vec![false; size[0] * size[1]];
        for row in 0..size[1] {
            for column in 0..size[0] {
                let cell = row * size[0] + column;
                let (a, b) = (to_return[cell], to_passed[cell]);
                if a > beside || a >= b || b < open {
                    continue;
                }
                let m = cover.middle(column, row);
                let mut is_beside = false;
                let is_within = lines.iter().all(|line| {
                    let [t, d] = line.of(m);
                    let is_along = (line.ends[0]..=line.ends[1]).contains(&t);
                    is_beside |= is_along && d <= 0.0 && d > -reach;
                    !(is_along && d > 0.0 && d < beyond)
                });
                let is_below = || {
                    ridges.iter().all(|(ridge, other)| {
                        let [t, d] = ridge.line.of(m);
                        let [from, to] =
                            [ridge.line.ends[0] - params.ridge_beyond, ridge.line.ends[1] + params.ridge_beyond];
                        let is_near = (from..=to).contains(&t) && d.abs() < beyond + 1.0;
                        !is_near || roof.plane.height(m) <= roofs.planes[*other].plane.height(m)
                    })
                };
                is_beside |= ridges.iter().any(|(ridge, _)| {
                    let [t, d] = ridge.line.of(m);
                    (ridge.line.ends[0]..=ridge.line.ends[1]).contains(&t) && d.abs() < reach
                });
                counts[cell] = is_within && (a <= near || is_beside) && is_below();
            }
        }
        cover.counts = counts;
        cover
    }
}

/// The leaves of one roof: a part split by lines is taken whole where its cells count, and in rows of cells elsewhere.
fn leaves_of(roofs: &Roofs, ridges: &[RidgeLine], outline: &Outline, plane: usize, params: &LeafParams) -> Vec<Leaf> {
    let cover = Cover::new(roofs, ridges, outline, plane, params);
    let high = [0, 1].map(|axis| cover.low[axis] + cover.size[axis] as f64 * params.cell);
    let [a, b] = [cover.low, high];
    let mut parts = vec![vec![a, [b[0], a[1]], b, [a[0], b[1]]]];
    let mut lines: Vec<PlanLine> = outline.sure_edges().map(|edge| edge.line).collect();
    lines.extend(convex(ridges, plane).map(|(ridge, _)| {
        let [from, to] = ridge.line.ends;
        PlanLine { ends: [from - params.ridge_beyond, to + params.ridge_beyond], ..ridge.line }
    }));
    lines.sort_by(|a, b| b.length().total_cmp(&a.length()));
    for line in &lines {
        parts = parts.into_iter().flat_map(|part| split(part, line, params.min_split)).collect();
    }
    parts.into_iter().flat_map(|polygon| pieces(&cover, polygon, plane, params.min_area)).collect()
}

/// A convex polygon, in two where a line runs through it for long enough.
fn split(polygon: Vec<[f64; 2]>, line: &PlanLine, min_length: f64) -> Vec<Vec<[f64; 2]>> {
    // the piece of the line within the polygon
    let mut range = line.ends;
    for (i, &p) in polygon.iter().enumerate() {
        let q = polygon[(i + 1) % polygon.len()];
        let side = PlanLine { point: p, along: [q[0] - p[0], q[1] - p[1]], ends: [0.0; 2] };
        let [at, per] = [line.at(0.0, 0.0), line.at(1.0, 0.0)].map(|p| side.of(p)[1]);
        let step = per - at;
        if step.abs() < 1e-12 {
            if at > 0.0 {
                return vec![polygon];
            }
        } else if step > 0.0 {
            range[1] = range[1].min(-at / step);
        } else {
            range[0] = range[0].max(-at / step);
        }
    }
    if range[1] - range[0] < min_length {
        return vec![polygon];
    }
    let left = clip(&polygon, |p| line.of(p)[1]);
    let right = clip(&polygon, |p| -line.of(p)[1]);
    [left, right].into_iter().filter(|part| area(part) > 1e-9).collect()
}

/// The counting cells of a part of a roof, whole or in pieces of `min_area` at least.
fn pieces(cover: &Cover, polygon: Vec<[f64; 2]>, plane: usize, min_area: f64) -> Vec<Leaf> {
    if area(&polygon) < SLIVER {
        return Vec::new();
    }
    let mut rows: Vec<RowRuns> = Vec::new();
    let mut total = 0_usize;
    let lows = [0, 1].map(|axis| polygon.iter().map(|p| p[axis]).fold(f64::INFINITY, f64::min));
    let highs = [0, 1].map(|axis| polygon.iter().map(|p| p[axis]).fold(f64::NEG_INFINITY, f64::max));
    for row in cover.range(1, lows[1], highs[1]) {
        let y = cover.middle(0, row)[1];
        let Some([from, to]) = span(&polygon, y) else { continue };
        let columns = cover.range(0, from, to);
        total += columns.len();
        rows.push(RowRuns::new(row, columns.filter(|column| cover.counts[row * cover.size[0] + column])));
    }
    let covered: usize = rows.iter().map(RowRuns::cell_count).sum();
    let is_whole = if total < 4 {
        let n = polygon.len() as f64;
        let middle = [0, 1].map(|axis| polygon.iter().map(|p| p[axis]).sum::<f64>() / n);
        if !cover.holds(middle) {
            return Vec::new();
        }
        true
    } else {
        covered > 0 && covered + 2 + total / 100 >= total
    };
    if is_whole {
        return vec![Leaf { plane, polygon, is_whole }];
    }
    let piece = |rectangle: [[usize; 2]; 2]| {
        let [[x0, y0], [x1, y1]] =
            rectangle.map(|[column, row]| [0, 1].map(|axis| cover.low[axis] + [column, row][axis] as f64 * cover.cell));
        let mut piece = clip(&polygon, |p| x0 - p[0]);
        piece = clip(&piece, |p| p[0] - x1);
        piece = clip(&piece, |p| y0 - p[1]);
        clip(&piece, |p| p[1] - y1)
    };
    let pieces = rectangles(rows).into_iter().map(piece).filter(|piece| area(piece) >= min_area);
    pieces.map(|polygon| Leaf { plane, polygon, is_whole }).collect()
}

/// The span of a convex polygon at a height in plan.
fn span(polygon: &[[f64; 2]], y: f64) -> Option<[f64; 2]> {
    let mut range = [f64::INFINITY, f64::NEG_INFINITY];
    for (i, p) in polygon.iter().enumerate() {
        let q = polygon[(i + 1) % polygon.len()];
        if (p[1] <= y) != (q[1] <= y) {
            let x = p[0] + (y - p[1]) / (q[1] - p[1]) * (q[0] - p[0]);
            range = [range[0].min(x), range[1].max(x)];
        }
    }
    (range[0] < range[1]).then_some(range)
}
