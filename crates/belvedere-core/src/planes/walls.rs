//! Walls below edges of roofs: upright planes of their own, wherever the edge is.

use super::WallParams;
use super::block::Block;
use super::edges::{EdgeLine, Outline};
use super::line::PlanLine;
use super::roof_planes::{NONE, Roofs};

/// Maximum distance of the points of a wall behind and before its edge, metres.
const BEHIND: f64 = 1.2;
const BEFORE: f64 = 0.4;
/// Minimum depth of the points below the edge, metres.
const BELOW: f64 = 0.25;
/// Steepest turn of a wall from its edge: 3.4°.
const MAX_TURN: f64 = 0.06;
/// Minimum share of the edge that the points of a wall take, and minimum length instead, metres.
const MIN_SHARE: f64 = 0.4;
const MIN_LENGTH: f64 = 1.5;

/// Maximum distance from the end of its edge at which a wall may cross another one, metres.
const CORNER: f64 = 1.2;
/// Minimum distance of an edge before its wall that makes eaves, metres.
pub(super) const MIN_EAVES: f64 = 0.12;
/// Length of a wall below eaves beyond its points, metres.
const BEYOND_POINTS: f64 = 0.2;

/// Standard deviation of the errors that no number of points averages out, metres.
const COMMON_SD: f64 = 0.008;

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
}

/// The walls below the edges of all planes.
pub(super) fn find(block: &Block, roofs: &Roofs, outlines: &[Outline], params: &WallParams) -> Vec<WallLine> {
    let mut walls = Vec::new();
    for (plane, outline) in outlines.iter().enumerate() {
        let min_points = params.points_at(params.min_points, roofs.planes[plane].spacing);
        let edges = outline.edges.iter().enumerate().filter(|(_, edge)| edge.may_have_wall);
        let found = edges.filter_map(|(number, edge)| find_wall(block, roofs, [plane, number], edge, min_points));
        let min_closed = params.points_at(params.min_closed_points, roofs.planes[plane].spacing);
        let is_closed = |wall: &WallLine| wall.share >= params.min_share && wall.points.len() >= min_closed;
        walls.extend(found.map(|wall| WallLine { is_closed: is_closed(&wall), ..wall }));
    }
    meet(&mut walls);
    walls.retain(|wall| wall.line.length() >= MIN_LENGTH / 2.0);
    walls
}

/// Moves the ends of walls, which are those of their edges, to where they cross other walls near by. Where none is,
/// walls below eaves end with their points.
fn meet(walls: &mut [WallLine]) {
    let lines: Vec<PlanLine> = walls.iter().map(|wall| wall.line).collect();
    for (number, wall) in walls.iter_mut().enumerate() {
        let own = lines[number];
        for end in 0..2 {
            let at = own.ends[end];
            let crossings = lines.iter().enumerate().filter(|&(other, _)| other != number).filter_map(|(_, other)| {
                let crossing = own.crossing(other).filter(|crossing| (crossing - at).abs() <= CORNER)?;
                let [on_other, _] = other.of(own.at(crossing, 0.0));
                (other.ends[0] - CORNER..=other.ends[1] + CORNER).contains(&on_other).then_some(crossing)
            });
            let nearest = crossings.min_by(|a, b| (a - at).abs().total_cmp(&(b - at).abs()));
            let outermost = wall.points.iter().map(|p| p[0]);
            wall.line.ends[end] = match nearest {
                Some(crossing) => crossing,
                None if wall.eaves <= MIN_EAVES => at,
                None if end == 0 => at.max(outermost.fold(f64::INFINITY, f64::min) - BEYOND_POINTS),
                None => at.min(outermost.fold(f64::NEG_INFINITY, f64::max) + BEYOND_POINTS),
            };
        }
    }
}

/// The wall below an edge, given its plane and its number among those of the plane.
fn find_wall(
    block: &Block,
    roofs: &Roofs,
    [plane, number]: [usize; 2],
    edge: &EdgeLine,
    min_points: usize,
) -> Option<WallLine> {
    let (edge, sd) = (&edge.line, edge.sd);
    let corners = [[0, 0], [0, 1], [1, 0], [1, 1]]
        .map(|[end, side]| edge.at(edge.ends[end], if side == 0 { -BEHIND } else { BEFORE }));
    let low = [0, 1].map(|axis| corners.iter().map(|p| p[axis]).fold(f64::INFINITY, f64::min));
    let high = [0, 1].map(|axis| corners.iter().map(|p| p[axis]).fold(f64::NEG_INFINITY, f64::max));
    let top = &roofs.planes[plane].plane;
    // along the edge, to its right, height; and the row of the return
    let mut near: Vec<([f64; 3], usize)> = Vec::new();
    block.each_in(low, high, |row, found| {
        if !found.may_be_building() || roofs.plane_of_return[row] != NONE || top.distance_above(found.p) > -BELOW {
            return;
        }
        let [t, d] = edge.of([found.p[0], found.p[1]]);
        if (edge.ends[0]..=edge.ends[1]).contains(&t) && (-BEHIND..=BEFORE).contains(&d) {
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
        if turn.abs() > MAX_TURN {
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
    if points.len() < min_points || (length < MIN_SHARE * edge.length() && length < MIN_LENGTH) {
        return None;
    }
    line = turned(&line, edge, noise / (points.len() as f64).sqrt() / length, sd / edge.length());
    // as long as its edge
    let ends = edge.end_points().map(|p| line.of(p)[0]);
    line.ends = ends;
    let middle = line.at(f64::midpoint(ends[0], ends[1]), 0.0);
    let bottom = points.iter().map(|p| p[1]).fold(f64::INFINITY, f64::min);
    Some(WallLine {
        plane,
        edge: number,
        noise,
        sd: (noise.powi(2) / points.len() as f64 + COMMON_SD.powi(2)).sqrt(),
        share: points.len() as f64 / near.len() as f64,
        is_closed: false,
        bottom,
        depth: top.height(middle) - bottom,
        eaves: -edge.of(middle)[1],
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
