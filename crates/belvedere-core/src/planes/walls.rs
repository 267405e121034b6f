//! Walls below edges of roofs: upright planes of their own, wherever the edge is.

use super::block::Block;
use super::cell_runs::{RowRuns, rectangles};
use super::edges::{EdgeLine, Outline};
use super::line::PlanLine;
use super::patches::{Patch, Sheet};
use super::roof_planes::Roofs;
use belvedere_data::cast::to_index;
use belvedere_data::patches::PatchKind;

/// Parameters of walls below edges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WallParams {
    /// Minimum number of points on a wall at `spacing` and closer. Default 8. Sparser pulses need fewer, in proportion
    /// to the number in a row along the wall.
    pub min_points: f64,
    /// The same for a wall that is closed between its points. Default 10.
    pub min_closed_points: f64,
    /// Spacing of pulses from which on fewer points are enough, metres. Default 0.32, of ten pulses per m².
    pub spacing: f64,
    /// Minimum number of points at any spacing. Default 4: at 2 pulses per m² facades are falsely visible in 5.4 %,
    /// instead of 7.3 with 8 and 10.
    pub fewest_points: f64,
    /// Minimum share of the points below an edge that lie on a wall, for it to be closed between its points. Default
    /// 0.5: fronts of stacked balconies have 0.3 to 0.4.
    pub min_share: f64,
    /// Maximum distance from its points at which a wall is closed, in spacings of pulses. Default 4.7, which is 1.5 m
    /// at ten pulses per m². With 1 m more is seen through walls, with 2 m arcades close.
    pub reach_spacings: f64,
    /// Maximum distance of the points of a wall behind its edge, metres. Default 1.2.
    pub(super) behind: f64,
    /// Maximum distance of the points of a wall before its edge, metres. Default 0.4.
    pub(super) before: f64,
    /// Minimum depth of the points below the edge, metres. Default 0.25.
    pub(super) below: f64,
    /// Maximum turn of a wall from its edge, sine of the angle. Default 0.06, 3.4°.
    pub(super) max_turn: f64,
    /// Minimum share of the edge that the points of a wall take. Default 0.4.
    pub(super) min_length_share: f64,
    /// Length that is enough instead, metres. Default 1.5.
    pub(super) min_length: f64,
    /// Maximum distance from the end of its edge at which a wall may cross another one, metres. Default 1.2.
    pub(super) corner: f64,
    /// Minimum distance of an edge before its wall that makes eaves, metres. Default 0.12.
    pub(super) min_eaves: f64,
    /// Length of a wall below eaves beyond its points, metres. Default 0.2.
    pub(super) beyond_points: f64,
    /// Standard deviation of the errors that no number of points averages out, metres. Default 0.008.
    pub(super) common_sd: f64,
    /// Side of the cells in which a wall is closed, metres. Default 0.5.
    pub(super) cell: f64,
}

impl Default for WallParams {
    fn default() -> Self {
        Self {
            min_points: 8.0,
            min_closed_points: 10.0,
            spacing: 0.32,
            fewest_points: 4.0,
            min_share: 0.5,
            reach_spacings: 4.7,
            behind: 1.2,
            before: 0.4,
            below: 0.25,
            max_turn: 0.06,
            min_length_share: 0.4,
            min_length: 1.5,
            corner: 1.2,
            min_eaves: 0.12,
            beyond_points: 0.2,
            common_sd: 0.008,
            cell: 0.5,
        }
    }
}

impl WallParams {
    /// Number of points that a wall needs where pulses are `spacing` metres apart, of one that needs `full` at most.
    fn points_at(&self, full: f64, spacing: f64) -> usize {
        let wanted = (full * self.spacing / spacing).clamp(self.fewest_points.min(full), full).round();
        to_index(wanted)
    }
}

/// A wall in plan.
#[derive(Clone, Debug)]
pub(super) struct WallLine {
    /// The house lies to the left.
    pub(super) line: PlanLine,
    pub(super) plane: usize,
    /// Number of the edge among those of the plane.
    pub(super) edge: usize,
    /// Points on it: range along the line and height, metres.
    pub(super) points: Vec<[f64; 2]>,
    /// Their rows among the returns of the block, in another order.
    pub(super) rows: Vec<usize>,
    pub(super) noise: f64,
    pub(super) sd: f64,
    pub(super) share: f64,
    /// True if it is closed near its points.
    pub(super) is_closed: bool,
    /// Lowest point.
    pub(super) bottom: f64,
    /// Depth of its lowest point below the edge, metres.
    pub(super) depth: f64,
    /// Overhang of the edge before it, metres.
    pub(super) eaves: f64,
    /// True if that makes eaves.
    pub(super) has_eaves: bool,
}

/// The walls below the edges of all planes.
pub(super) fn find(block: &Block, roofs: &Roofs, outlines: &[Outline], params: &WallParams) -> Vec<WallLine> {
    let mut walls = Vec::new();
    for (plane, outline) in outlines.iter().enumerate() {
        let min_points = params.points_at(params.min_points, roofs.planes[plane].spacing);
        let edges = outline.edges.iter().enumerate().filter(|(_, edge)| edge.may_have_wall);
        let found = edges.filter_map(|(number, edge)| find_wall(block, roofs, plane, number, min_points, edge, params));
        let min_closed = params.points_at(params.min_closed_points, roofs.planes[plane].spacing);
        let is_closed = |wall: &WallLine| wall.share >= params.min_share && wall.points.len() >= min_closed;
        walls.extend(found.map(|wall| WallLine { is_closed: is_closed(&wall), ..wall }));
    }
    meet(&mut walls, params);
    walls.retain(|wall| wall.line.length() >= params.min_length / 2.0);
    walls
}

/// Moves the ends of walls, which are those of their edges, to where they cross other walls near by. Where none is,
/// walls below eaves end with their points.
fn meet(walls: &mut [WallLine], params: &WallParams) {
    let corner = params.corner;
    let lines: Vec<PlanLine> = walls.iter().map(|wall| wall.line).collect();
    for (number, wall) in walls.iter_mut().enumerate() {
        let own = lines[number];
        for end in 0..2 {
            let at = own.ends[end];
            let crossings = lines.iter().enumerate().filter(|&(other, _)| other != number).filter_map(|(_, other)| {
                let crossing = own.crossing(other).filter(|crossing| (crossing - at).abs() <= corner)?;
                let [on_other, _] = other.of(own.at(crossing, 0.0));
                (other.ends[0] - corner..=other.ends[1] + corner).contains(&on_other).then_some(crossing)
            });
            let nearest = crossings.min_by(|a, b| (a - at).abs().total_cmp(&(b - at).abs()));
            let outermost = wall.points.iter().map(|p| p[0]);
            wall.line.ends[end] = match nearest {
                Some(crossing) => crossing,
                None if !wall.has_eaves => at,
                None if end == 0 => at.max(outermost.fold(f64::INFINITY, f64::min) - params.beyond_points),
                None => at.min(outermost.fold(f64::NEG_INFINITY, f64::max) + params.beyond_points),
            };
        }
    }
}

/// The wall below an edge, given its plane and its number among those of the plane.
fn find_wall(
    block: &Block,
    roofs: &Roofs,
    plane: usize,
    number: usize,
    min_points: usize,
    edge: &EdgeLine,
    params: &WallParams,
) -> Option<WallLine> {
    let (edge, sd) = (&edge.line, edge.sd);
    let (behind, before) = (params.behind, params.before);
    let corners = [[0, 0], [0, 1], [1, 0], [1, 1]]
        .map(|[end, side]| edge.at(edge.ends[end], if side == 0 { -behind } else { before }));
    let low = [0, 1].map(|axis| corners.iter().map(|p| p[axis]).fold(f64::INFINITY, f64::min));
    let high = [0, 1].map(|axis| corners.iter().map(|p| p[axis]).fold(f64::NEG_INFINITY, f64::max));
    let top = &roofs.planes[plane].plane;
    // along the edge, to its right, height; and the row of the return
    let mut near: Vec<([f64; 3], usize)> = Vec::new();
    block.each_in(low, high, |row, found| {
        if !found.may_be_building()
            || roofs.plane_of_return[row].is_some()
            || top.distance_above(found.p) > -params.below
        {
            return;
        }
        let [t, d] = edge.of([found.p[0], found.p[1]]);
        if (edge.ends[0]..=edge.ends[1]).contains(&t) && (-behind..=before).contains(&d) {
            near.push(([t, d, found.p[2]], row));
        }
    });
    if near.len() < min_points {
        return None;
    }
    near.sort_unstable_by(|(a, _), (b, _)| (0..3).fold(a[1].total_cmp(&b[1]), |o, i| o.then(a[i].total_cmp(&b[i]))));
    let width = 3.0 * roofs.noise + 0.02;
    let (mut best, mut last) = ((0, 0), 0);
    for first in 0..near.len() {
        while last < near.len() && near[last].0[1] <= near[first].0[1] + width {
            last += 1;
        }
        if last - first > best.1 - best.0 {
            best = (first, last);
        }
    }
    let mut on: Vec<([f64; 3], usize)> = near[best.0..best.1].to_vec();
    let (mut line, mut noise) = (PlanLine::default(), 0.0);
    for _ in 0..4 {
        if on.len() < min_points {
            return None;
        }
        (line, noise) = PlanLine::fit(on.iter().map(|(p, _)| edge.at(p[0], p[1])), edge.along)?;
        let turn = line.along[0] * edge.along[1] - line.along[1] * edge.along[0];
        if turn.abs() > params.max_turn {
            // too short to have a direction of its own
            let mean = on.iter().map(|(p, _)| p[1]).sum::<f64>() / on.len() as f64;
            line = PlanLine { point: edge.at(0.0, mean), ..*edge };
            noise = (on.iter().map(|(p, _)| (p[1] - mean).powi(2)).sum::<f64>() / on.len() as f64).sqrt();
        }
        let reach = 2.7 * roofs.noise.max(noise.min(2.0 * roofs.noise));
        on = near.iter().copied().filter(|(p, _)| line.of(edge.at(p[0], p[1]))[1].abs() <= reach).collect();
    }
    let mut points: Vec<[f64; 2]> = on.iter().map(|(p, _)| [line.of(edge.at(p[0], p[1]))[0], p[2]]).collect();
    points.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let length = points.last()?[0] - points.first()?[0];
    if points.len() < min_points || (length < params.min_length_share * edge.length() && length < params.min_length) {
        return None;
    }
    line = turned(&line, edge, noise / (points.len() as f64).sqrt() / length, sd / edge.length());
    // as long as its edge
    let ends = edge.end_points().map(|p| line.of(p)[0]);
    line.ends = ends;
    let middle = line.at(f64::midpoint(ends[0], ends[1]), 0.0);
    let eaves = -edge.of(middle)[1];
    let bottom = points.iter().map(|p| p[1]).fold(f64::INFINITY, f64::min);
    Some(WallLine {
        plane,
        edge: number,
        noise,
        sd: (noise.powi(2) / points.len() as f64 + params.common_sd.powi(2)).sqrt(),
        share: points.len() as f64 / near.len() as f64,
        is_closed: false,
        bottom,
        depth: top.height(middle) - bottom,
        eaves,
        has_eaves: eaves > params.min_eaves,
        points,
        rows: on.iter().map(|(_, row)| *row).collect(),
        line,
    })
}

/// A line through its points, turned towards the edge above it as far as that one's direction is known better. Both
/// errors are those across, metres, over the length.
fn turned(line: &PlanLine, edge: &PlanLine, own: f64, of_edge: f64) -> PlanLine {
    let share = of_edge.powi(2) / (own.powi(2) + of_edge.powi(2)).max(1e-12);
    let along = [0, 1].map(|axis| share * line.along[axis] + (1.0 - share) * edge.along[axis]);
    let length = along[0].hypot(along[1]);
    PlanLine { along: along.map(|v| v / length), ..*line }
}

/// Returns the triangles of walls that are closed, in the block.
pub(super) fn patches(block: &Block, roofs: &Roofs, walls: &[WallLine], params: &WallParams) -> Vec<Patch> {
    walls.iter().filter(|wall| wall.is_closed).flat_map(|wall| patches_of(block, roofs, wall, params)).collect()
}

/// Returns the triangles of a wall near its points.
fn patches_of(block: &Block, roofs: &Roofs, wall: &WallLine, params: &WallParams) -> Vec<Patch> {
    let (cell, reach) = (params.cell, params.reach_spacings * roofs.planes[wall.plane].spacing);
    let [from, to] = wall.line.ends;
    let top = &roofs.planes[wall.plane].plane;
    let heights = wall.line.end_points().map(|p| top.height(p));
    let [low, high] = [wall.bottom - reach, heights[0].max(heights[1])];
    let count = |length: f64| to_index((length / cell).ceil());
    let size = [count(to - from), count(high - low)];
    let mut counts = vec![false; size[0] * size[1]];
    for &[t, z] in &wall.points {
        let columns = count(t - reach - from).saturating_sub(1)..count(t + reach - from).min(size[0]);
        for column in columns {
            for row in count(z - reach - low).saturating_sub(1)..count(z + reach - low).min(size[1]) {
                let [x, y] = [from + (column as f64 + 0.5) * cell - t, low + (row as f64 + 0.5) * cell - z];
                counts[row * size[0] + column] |= x.hypot(y) <= reach;
            }
        }
    }
    let row = |row: usize| RowRuns::new(row, (0..size[0]).filter(|column| counts[row * size[0] + column]));
    let sheet = |rectangle: [[usize; 2]; 2]| {
        let [[t0, z0], [t1, z1]] =
            rectangle.map(|[column, row]| [(from + column as f64 * cell).min(to), low + row as f64 * cell]);
        let sheet = Sheet { line: &wall.line, ranges: [t0, t1], heights: [z0, z1], kind: PatchKind::Wall };
        sheet.patches(block, |p| top.height(p), |_| z0)
    };
    rectangles((0..size[1]).map(row).collect()).into_iter().flat_map(sheet).collect()
}
