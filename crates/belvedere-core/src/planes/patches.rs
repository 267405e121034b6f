//! Surfaces that close: roofs up to their edges and ridges, walls near their points, and sheets within buildings.

use super::block::Block;
use super::edges::Outline;
use super::line::{PlanLine, area, clip};
use super::ridges::RidgeLine;
use super::roof_planes::Roofs;
use super::sheets::Sheet;
use super::walls::WallLine;
use super::{BLOCK, BuildingSurfaces, PatchKind, WallParams};
use belvedere_data::vector::to_f32;

/// Side of the cells in which it is decided whether a surface is there, metres.
const CELL: f64 = 0.25;
/// Side of the cells of walls, metres.
const WALL_CELL: f64 = 0.5;
/// Maximum distance of a roof from its returns, spacings: elsewhere, and beside an edge.
const NEAR_SPACINGS: f64 = 1.5;
const BESIDE_SPACINGS: f64 = 2.2;
/// Radius of the opening around a pulse that passed a roof, spacings.
const OPEN_SPACINGS: f64 = 0.5;
/// Width beyond an edge within which the outside is cut off, spacings.
const OUTSIDE_SPACINGS: f64 = 4.0;
/// Smallest piece of a roof made of cells, m²: smaller ones lie beyond edges more often than they close anything.
const MIN_PIECE: f64 = 0.6;
/// Length of a cut beyond the ends of a ridge, metres.
const RIDGE_BEYOND: f64 = 0.6;
/// Shortest piece of a line within a piece of a roof that splits it, metres.
const MIN_SPLIT: f64 = 0.3;
/// Smallest piece of a surface, m².
const MIN_AREA: f64 = 0.005;

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

/// The pieces of all roofs.
pub(super) fn roofs(block: &Block, roofs: &Roofs, ridges: &[RidgeLine], outlines: &[Outline]) -> Vec<Leaf> {
    let _ = block;
    let has_points = |plane: &usize| !(outlines[*plane].inside.is_empty() && outlines[*plane].split.is_empty());
    let planes = (0..roofs.planes.len()).filter(has_points);
    planes.flat_map(|plane| pieces(roofs, ridges, &outlines[plane], plane)).collect()
}

/// The cells of a roof.
struct Cover {
    low: [f64; 2],
    size: [usize; 2],
    counts: Vec<bool>,
}

impl Cover {
    fn middle(&self, column: usize, row: usize) -> [f64; 2] {
        [self.low[0] + (column as f64 + 0.5) * CELL, self.low[1] + (row as f64 + 0.5) * CELL]
    }

    /// Columns, or rows, whose middles lie between two places.
    fn range(&self, axis: usize, from: f64, to: f64) -> std::ops::Range<usize> {
        let cells = |v: f64| ((v - self.low[axis]) / CELL - 0.5).ceil().clamp(0.0, self.size[axis] as f64);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the grid")]
        let range = cells(from) as usize..cells(to) as usize;
        range
    }

    /// Returns true if the cell of a place counts.
    fn holds(&self, p: [f64; 2]) -> bool {
        let [columns, rows] = [0, 1].map(|axis| self.range(axis, p[axis] - CELL / 2.0, p[axis] + CELL / 2.0));
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
    fn new(roofs: &Roofs, ridges: &[RidgeLine], outline: &Outline, plane: usize) -> Self {
        let roof = &roofs.planes[plane];
        let spacing = roof.spacing;
        let reach = BESIDE_SPACINGS * spacing;
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for p in outline.inside.iter().chain(&outline.split) {
            for axis in 0..2 {
                low[axis] = low[axis].min(p[axis] - reach);
                high[axis] = high[axis].max(p[axis] + reach);
            }
        }
        // cells of one grid, wherever the roof begins
        let low = low.map(|v| (v / CELL).floor() * CELL);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "cells of a block")]
        let size = [0, 1].map(|axis| ((high[axis] - low[axis]) / CELL).ceil().max(1.0) as usize);
        let mut cover = Self { low, size, counts: Vec::new() };
        let (mut to_return, mut to_passed) =
            (vec![f32::INFINITY; size[0] * size[1]], vec![f32::INFINITY; size[0] * size[1]]);
        for &p in outline.inside.iter().chain(&outline.split) {
            cover.stamp(&mut to_return, p, reach);
        }
        let lines: Vec<&PlanLine> = outline.edges.iter().filter(|edge| edge.is_sure).map(|edge| &edge.line).collect();
        let beyond = OUTSIDE_SPACINGS * spacing;
        for passed in &outline.passed {
            let is_explained = lines.iter().any(|line| {
                let [t, d] = line.of(passed.p);
                (line.ends[0] - spacing..=line.ends[1] + spacing).contains(&t) && d > -0.1 && d < beyond + spacing
            });
            if !is_explained {
                cover.stamp(&mut to_passed, passed.p, NEAR_SPACINGS * spacing);
            }
        }
        let ridges: Vec<(&RidgeLine, usize)> = convex(ridges, plane).collect();
        let [near, beside, open] =
            [NEAR_SPACINGS, BESIDE_SPACINGS, OPEN_SPACINGS].map(|n| to_f32((n * spacing).powi(2)));
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
                        let [from, to] = [ridge.line.ends[0] - RIDGE_BEYOND, ridge.line.ends[1] + RIDGE_BEYOND];
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

/// The convex ridges of a plane, and the planes beyond.
fn convex(ridges: &[RidgeLine], plane: usize) -> impl Iterator<Item = (&RidgeLine, usize)> {
    ridges
        .iter()
        .filter(move |ridge| ridge.is_convex && ridge.planes.contains(&plane))
        .map(move |ridge| (ridge, if ridge.planes[0] == plane { ridge.planes[1] } else { ridge.planes[0] }))
}

/// The pieces of one roof: a part split by lines is taken whole where its cells count, and in rows of cells elsewhere.
fn pieces(roofs: &Roofs, ridges: &[RidgeLine], outline: &Outline, plane: usize) -> Vec<Leaf> {
    let cover = Cover::new(roofs, ridges, outline, plane);
    let high = [0, 1].map(|axis| cover.low[axis] + cover.size[axis] as f64 * CELL);
    let [a, b] = [cover.low, high];
    let mut parts = vec![vec![a, [b[0], a[1]], b, [a[0], b[1]]]];
    let of_edges = outline.edges.iter().filter(|edge| edge.is_sure).map(|edge| edge.line);
    let mut lines: Vec<PlanLine> = of_edges.collect();
    lines.extend(convex(ridges, plane).map(|(ridge, _)| {
        let [from, to] = ridge.line.ends;
        PlanLine { ends: [from - RIDGE_BEYOND, to + RIDGE_BEYOND], ..ridge.line }
    }));
    lines.sort_by(|a, b| b.length().total_cmp(&a.length()));
    for line in &lines {
        parts = parts.into_iter().flat_map(|part| split(part, line)).collect();
    }
    let mut leaves = Vec::new();
    for polygon in parts {
        pieces_of_part(&cover, polygon, plane, &mut leaves);
    }
    leaves
}

/// A convex polygon, in two where a line runs through it for long enough.
fn split(polygon: Vec<[f64; 2]>, line: &PlanLine) -> Vec<Vec<[f64; 2]>> {
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
    if range[1] - range[0] < MIN_SPLIT {
        return vec![polygon];
    }
    let left = clip(&polygon, |p| line.of(p)[1]);
    let right = clip(&polygon, |p| -line.of(p)[1]);
    [left, right].into_iter().filter(|part| area(part) > 1e-9).collect()
}

/// Adds the counting cells of a part of a roof.
fn pieces_of_part(cover: &Cover, polygon: Vec<[f64; 2]>, plane: usize, leaves: &mut Vec<Leaf>) {
    let size = area(&polygon);
    if size < MIN_AREA {
        return;
    }
    let mut rows: Vec<(usize, Vec<[usize; 2]>)> = Vec::new();
    let (mut total, mut covered) = (0_usize, 0_usize);
    let lows = [0, 1].map(|axis| polygon.iter().map(|p| p[axis]).fold(f64::INFINITY, f64::min));
    let highs = [0, 1].map(|axis| polygon.iter().map(|p| p[axis]).fold(f64::NEG_INFINITY, f64::max));
    for row in cover.range(1, lows[1], highs[1]) {
        let y = cover.middle(0, row)[1];
        let Some([from, to]) = span(&polygon, y) else { continue };
        let mut runs: Vec<[usize; 2]> = Vec::new();
        for column in cover.range(0, from, to) {
            total += 1;
            if !cover.counts[row * cover.size[0] + column] {
                continue;
            }
            covered += 1;
            match runs.last_mut() {
                Some(run) if run[1] == column => run[1] = column + 1,
                _ => runs.push([column, column + 1]),
            }
        }
        rows.push((row, runs));
    }
    if total < 4 {
        let n = polygon.len() as f64;
        let middle = [0, 1].map(|axis| polygon.iter().map(|p| p[axis]).sum::<f64>() / n);
        if cover.holds(middle) {
            leaves.push(Leaf { plane, polygon, is_whole: true });
        }
        return;
    }
    if covered == 0 {
        return;
    }
    if covered + 2 + total / 100 >= total {
        leaves.push(Leaf { plane, polygon, is_whole: true });
        return;
    }
    for rectangle in merged(rows) {
        let [[x0, y0], [x1, y1]] =
            rectangle.map(|[column, row]| [0, 1].map(|axis| cover.low[axis] + [column, row][axis] as f64 * CELL));
        let mut piece = polygon.clone();
        piece = clip(&piece, |p| x0 - p[0]);
        piece = clip(&piece, |p| p[0] - x1);
        piece = clip(&piece, |p| y0 - p[1]);
        piece = clip(&piece, |p| p[1] - y1);
        if area(&piece) >= MIN_PIECE {
            leaves.push(Leaf { plane, polygon: piece, is_whole: false });
        }
    }
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

/// Runs of cells in rows as rectangles, first and last corner in cells. Runs above each other whose ends differ by a
/// cell at most are one, as narrow as the narrowest.
fn merged(rows: Vec<(usize, Vec<[usize; 2]>)>) -> Vec<[[usize; 2]; 2]> {
    let mut done = Vec::new();
    // the rectangle so far, and its first ends
    let mut open: Vec<([[usize; 2]; 2], [usize; 2])> = Vec::new();
    for (row, runs) in rows {
        let mut next = Vec::new();
        for run in runs {
            let goes_on = |(rectangle, first): &([[usize; 2]; 2], [usize; 2])| {
                rectangle[1][1] == row && (0..2).all(|end| first[end].abs_diff(run[end]) <= 1)
            };
            match open.iter().position(goes_on) {
                Some(place) => {
                    let ([low, high], first) = open.swap_remove(place);
                    let rectangle = [[low[0].max(run[0]), low[1]], [high[0].min(run[1]), row + 1]];
                    next.push((rectangle, first));
                }
                None => next.push(([[run[0], row], [run[1], row + 1]], run)),
            }
        }
        done.extend(open.drain(..).map(|(rectangle, _)| rectangle));
        open = next;
    }
    done.extend(open.into_iter().map(|(rectangle, _)| rectangle));
    done.retain(|[low, high]| low[0] < high[0]);
    done.sort_unstable();
    done
}

/// Gives out the triangles of roofs, walls and sheets within the block.
pub(super) fn append_to(
    block: &Block,
    roofs: &Roofs,
    leaves: &[Leaf],
    walls: &[WallLine],
    params: &WallParams,
    found: &mut BuildingSurfaces,
) {
    for leaf in leaves {
        let mut polygon = leaf.polygon.clone();
        for axis in 0..2 {
            polygon = clip(&polygon, |p| -p[axis]);
            polygon = clip(&polygon, |p| p[axis] - BLOCK);
        }
        let plane = &roofs.planes[leaf.plane].plane;
        let corners: Vec<[f64; 3]> = polygon.iter().map(|&[x, y]| [x, y, plane.height([x, y])]).collect();
        fan(block, &corners, PatchKind::Roof, found);
    }
    for wall in walls {
        if wall.is_closed {
            let reach = params.reach_spacings * roofs.planes[wall.plane].spacing;
            close_wall(block, roofs, wall, reach, found);
        }
    }
}

/// Adds a convex polygon, counter-clockwise seen from outside, as triangles about its first corner.
pub(super) fn fan(block: &Block, corners: &[[f64; 3]], kind: PatchKind, found: &mut BuildingSurfaces) {
    let local = |p: [f64; 3]| block.local(p).map(to_f32);
    let Some((&first, rest)) = corners.split_first() else { return };
    for pair in rest.windows(2) {
        found.patches.push([local(first), local(pair[0]), local(pair[1])], kind);
    }
}

/// Closes a wall near its points.
fn close_wall(block: &Block, roofs: &Roofs, wall: &WallLine, reach: f64, found: &mut BuildingSurfaces) {
    let [from, to] = wall.line.ends;
    let top = &roofs.planes[wall.plane].plane;
    let heights = wall.line.end_points().map(|p| top.height(p));
    let [low, high] = [wall.bottom - reach, heights[0].max(heights[1])];
    let count = |length: f64| {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "cells of a wall, and saturating")]
        let count = (length / WALL_CELL).ceil().max(0.0) as usize;
        count
    };
    let size = [count(to - from), count(high - low)];
    let mut counts = vec![false; size[0] * size[1]];
    for &[t, z] in &wall.points {
        let columns = count(t - reach - from).saturating_sub(1)..count(t + reach - from).min(size[0]);
        for column in columns {
            for row in count(z - reach - low).saturating_sub(1)..count(z + reach - low).min(size[1]) {
                let [x, y] = [from + (column as f64 + 0.5) * WALL_CELL - t, low + (row as f64 + 0.5) * WALL_CELL - z];
                counts[row * size[0] + column] |= x.hypot(y) <= reach;
            }
        }
    }
    let mut rows = Vec::new();
    for row in 0..size[1] {
        let mut runs: Vec<[usize; 2]> = Vec::new();
        for column in (0..size[0]).filter(|column| counts[row * size[0] + column]) {
            match runs.last_mut() {
                Some(run) if run[1] == column => run[1] = column + 1,
                _ => runs.push([column, column + 1]),
            }
        }
        rows.push((row, runs));
    }
    for rectangle in merged(rows) {
        let [[t0, z0], [t1, z1]] =
            rectangle.map(|[column, row]| [(from + column as f64 * WALL_CELL).min(to), low + row as f64 * WALL_CELL]);
        let sheet = Sheet { line: &wall.line, ranges: [t0, t1], heights: [z0, z1], kind: PatchKind::Wall };
        sheet.append_to(block, |p| top.height(p), |_| z0, found);
    }
}
