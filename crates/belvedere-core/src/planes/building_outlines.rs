//! Planes, edges, ridges and walls of a block in local metres, and the points on them.

use super::block::Block;
use super::edges::Outline;
use super::ridges::RidgeLine;
use super::roof_planes::Roofs;
use super::walls::WallLine;
use belvedere_data::building_outlines::{BuildingOutlines, Edge, Ridge, RoofPlane, Wall};
use belvedere_data::vector::box_around;
use std::collections::BTreeMap;

/// A plane that points lie on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Surface {
    /// Row among [`BuildingOutlines::planes`].
    Roof(usize),
    /// Row among [`BuildingOutlines::walls`].
    Wall(usize),
}

/// A point that a plane of a roof or a wall was fitted to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PointOnSurface {
    /// Its row in the survey.
    pub row: u32,
    /// Surface of the point.
    pub surface: Surface,
}

/// Returns planes, edges, ridges and walls as far as they lie in the block, and the points of the block on planes and
/// walls.
pub(super) fn of_block(
    block: &Block,
    roofs: &Roofs,
    ridges: &[RidgeLine],
    outlines: &[Outline],
    walls: &[WallLine],
) -> (BuildingOutlines, Vec<PointOnSurface>) {
    let (mut found, mut points) = (BuildingOutlines::default(), Vec::new());
    let mut row_of = vec![None; roofs.planes.len()];
    for (number, roof) in roofs.planes.iter().enumerate() {
        let points_of = || roof.rows.iter().map(|&row| roofs.points[row]);
        let bounds = box_around(points_of());
        let is_here = points_of().any(|[x, y, _]| block.holds([x, y]));
        if is_here {
            row_of[number] = Some(found.planes.len());
            points.extend(points_on(block, roofs.returns_of(roof), Surface::Roof(found.planes.len())));
            found.planes.push(RoofPlane {
                normal: roof.plane.normal,
                center: block.local(roof.center),
                bounds: bounds.map(|corner| block.local(corner)),
                count: roof.rows.len(),
                noise: roof.plane.noise,
                sd: roof.sd(),
            });
        }
    }
    let lifted = |plane: usize, [a, b]: [[f64; 2]; 2], [from, to]: [f64; 2]| {
        [from, to].map(|share| {
            let p = [a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])];
            block.local([p[0], p[1], roofs.planes[plane].plane.height(p)])
        })
    };
    let mut edge_row: BTreeMap<(usize, usize), usize> = BTreeMap::new();
    for (plane, outline) in outlines.iter().enumerate() {
        for (number, edge) in outline.edges.iter().enumerate() {
            let ends = edge.line.end_points();
            let (Some(range), Some(plane_row)) = (block.piece(ends), row_of[plane]) else { continue };
            edge_row.insert((plane, number), found.edges.len());
            found.edges.push(Edge {
                ends: lifted(plane, ends, range),
                plane: plane_row,
                sd: edge.sd,
                count: edge.count,
                drop: edge.drop,
            });
        }
    }
    for ridge in ridges {
        let ends = ridge.line.end_points();
        if let (Some(range), [Some(a), Some(b)]) = (block.piece(ends), ridge.planes.map(|plane| row_of[plane])) {
            found.ridges.push(Ridge {
                ends: lifted(ridge.planes[0], ends, range),
                planes: [a, b],
                is_convex: ridge.is_convex,
            });
        }
    }
    for wall in walls {
        let ends = wall.line.end_points();
        let edge = edge_row.get(&(wall.plane, wall.edge));
        if let (Some(range), Some(&edge)) = (block.piece(ends), edge) {
            let ends = lifted(wall.plane, ends, range);
            let middle = f64::midpoint(ends[0][2], ends[1][2]);
            points.extend(points_on(block, wall.rows.iter().copied(), Surface::Wall(found.walls.len())));
            found.walls.push(Wall {
                ends: ends.map(|p| [p[0], p[1]]),
                heights: [wall.bottom, middle],
                edge,
                count: wall.points.len(),
                noise: wall.noise,
                sd: wall.sd,
                share: wall.share,
                eaves: wall.eaves,
            });
        }
    }
    (found, points)
}

/// Returns the points of the block that lie on a surface, given the rows of its returns.
fn points_on(
    block: &Block,
    returns: impl Iterator<Item = usize>,
    surface: Surface,
) -> impl Iterator<Item = PointOnSurface> {
    let here = returns.map(|row| &block.returns[row]).filter(|found| block.holds([found.p[0], found.p[1]]));
    here.map(move |found| PointOnSurface { row: found.row, surface })
}
