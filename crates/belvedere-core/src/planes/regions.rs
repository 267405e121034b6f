//! Space before known surfaces: balls of what lies behind them do not reach into it.

use super::BLOCK;
use super::block::Block;
use super::edges::Outline;
use super::fit::Plane;
use super::line::PlanLine;
use super::patches::Leaf;
use super::roof_planes::Roofs;
use super::walls::{MIN_EAVES, WallLine};
use crate::blocking::Ball;
use belvedere_data::Result;
use belvedere_data::balls::{LIMIT_TOUCH, MedialBalls, NO_TOUCH};
use belvedere_data::control::{Control, Stop};
use belvedere_data::vector::{dot, sub, unit};
use rayon::prelude::*;

/// How far before a surface its region begins, metres: balls stand out over points by as much.
const MARGIN: f64 = 0.02;
/// How far a region reaches, metres.
const DEPTH: f64 = 3.0;
/// How far before and behind a surface the points lie whose balls it bounds, metres.
const BEFORE: f64 = 0.1;
const BEHIND: f64 = 6.0;
/// How far beyond the ends of a line its region reaches, metres.
const BEYOND: f64 = 0.4;
/// How far above the top of a wall points may lie, metres.
const ABOVE: f64 = 0.5;
/// How far below a roof balls of its eaves may reach, metres.
const EAVES_DEPTH: f64 = 0.15;
/// How far beside a piece of a roof points lie whose balls it bounds, metres.
const BESIDE_ROOF: f64 = 3.0;
/// Side of the cells in which regions are looked up, metres.
const CELL: f64 = 4.0;

/// A convex piece of space before a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    /// Half-spaces that hold it: unit vectors outward, and their products with a point of the bounding plane, local
    /// metres.
    pub half_spaces: Vec<([f64; 3], f64)>,
}

impl Region {
    /// The piece of a line within the region, as ranges from its origin; `None` outside.
    #[must_use]
    pub fn interval(&self, origin: [f64; 3], direction: [f64; 3]) -> Option<[f64; 2]> {
        let mut range = [f64::NEG_INFINITY, f64::INFINITY];
        for &(normal, offset) in &self.half_spaces {
            let (at, per) = (dot(normal, origin) - offset, dot(normal, direction));
            if per.abs() < 1e-12 {
                if at > 0.0 {
                    return None;
                }
            } else if per > 0.0 {
                range[1] = range[1].min(-at / per);
            } else {
                range[0] = range[0].max(-at / per);
            }
        }
        (range[0] < range[1]).then_some(range)
    }

    /// How far a place lies outside at least, below zero within, metres.
    #[must_use]
    pub fn distance(&self, p: [f64; 3]) -> f64 {
        self.half_spaces.iter().map(|&(normal, offset)| dot(normal, p) - offset).fold(f64::NEG_INFINITY, f64::max)
    }
}

/// What a region lies before.
#[derive(Clone, Debug, PartialEq)]
enum Surface {
    /// An upright one on a line, below a plane: heights above that plane up to which it reaches, and the height of its
    /// foot; how far before it points of eaves lie.
    Upright { line: PlanLine, top: Plane, above: f64, foot: f64, eaves: f64 },
    /// A convex piece of a plane.
    Roof { polygon: Vec<[f64; 2]>, plane: Plane },
}

/// Regions of a block.
#[derive(Clone, Debug, Default, PartialEq)]
struct BlockRegions {
    corner: [f64; 3],
    surfaces: Vec<Surface>,
    /// Surfaces that may bound balls of the points in each cell.
    cells: Vec<Vec<u32>>,
}

/// Space before the surfaces of a survey, by block.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SurfaceRegions {
    blocks: Vec<BlockRegions>,
}

impl SurfaceRegions {
    pub(super) fn append(&mut self, other: Self) {
        self.blocks.extend(other.blocks);
    }

    /// The regions that the ball of a point does not reach into, for a point as measured, local metres.
    #[must_use]
    pub fn of_point(&self, p: [f32; 3]) -> Vec<Region> {
        let mut found = Vec::new();
        for block in &self.blocks {
            let at: [f64; 3] = std::array::from_fn(|i| f64::from(p[i]) - block.corner[i]);
            if (0..2).all(|axis| (0.0..BLOCK).contains(&at[axis])) {
                block.add(at, &mut found);
                break;
            }
        }
        found
    }
}

/// Caps balls so that none reaches into a region of its point: a ball keeps the place where it touches its surface, and
/// its middle moves there. `measured` are the points before they were moved onto their surface. Returns how many.
///
/// # Errors
/// [`Error::Cancelled`](belvedere_data::Error::Cancelled).
pub fn cap(
    balls: &mut MedialBalls,
    measured: &[[f32; 3]],
    regions: &SurfaceRegions,
    control: &Control<'_>,
) -> Result<usize> {
    let stop = Stop::new(control);
    let capped = |row: usize| -> Option<(usize, Ball)> {
        if balls.touch[row] == NO_TOUCH || stop.is_set() {
            return None;
        }
        let ball = Ball { center: balls.centers[row], radius: balls.radii[row] };
        let point = *measured.get(balls.source[row] as usize)?;
        Some((row, capped(ball, point, &regions.of_point(point))?))
    };
    let capped: Vec<(usize, Ball)> = (0..balls.len()).into_par_iter().with_min_len(256).filter_map(capped).collect();
    stop.check()?;
    for &(row, Ball { center, radius }) in &capped {
        balls.centers[row] = center;
        balls.radii[row] = radius;
        balls.touch[row] = LIMIT_TOUCH;
        balls.separation_angles[row] = f32::NAN;
    }
    Ok(capped.len())
}

/// The largest ball that touches the surface where `ball` does and lies outside of all regions; `None` where that is
/// `ball` itself.
fn capped(ball: Ball, point: [f32; 3], regions: &[Region]) -> Option<Ball> {
    let (center, whole) = (ball.center.map(f64::from), f64::from(ball.radius));
    let inward = unit(sub(center, point.map(f64::from)))?;
    let touched: [f64; 3] = std::array::from_fn(|i| center[i] - whole * inward[i]);
    let middle = |radius: f64| -> [f64; 3] { std::array::from_fn(|i| touched[i] + radius * inward[i]) };
    let mut radius = whole;
    for region in regions {
        let fits = |radius: f64| region.distance(middle(radius)) >= radius;
        if !fits(radius) {
            let mut range = [0.0, radius];
            for _ in 0..HALVINGS {
                let half = f64::midpoint(range[0], range[1]);
                range[usize::from(!fits(half))] = half;
            }
            radius = range[0];
        }
    }
    #[expect(clippy::cast_possible_truncation, reason = "balls are f32")]
    let capped = Ball { center: middle(radius).map(|v| v as f32), radius: radius as f32 };
    (radius < whole).then_some(capped)
}

/// Steps of a search for a radius: to a hundredth of a micrometre.
const HALVINGS: usize = 30;

const CELLS: usize = 16;

impl BlockRegions {
    fn add(&self, p: [f64; 3], found: &mut Vec<Region>) {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the block")]
        let [column, row] = [0, 1].map(|axis| (p[axis] / CELL) as usize);
        let Some(cell) = self.cells.get(row * CELLS + column) else { return };
        for &number in cell {
            let Some(mut region) = self.surfaces[number as usize].region_of(p) else { continue };
            for (normal, offset) in &mut region.half_spaces {
                *offset += dot(*normal, self.corner);
            }
            found.push(region);
        }
    }
}

impl Surface {
    /// Box in plan of the points whose balls it may bound.
    fn bounds(&self) -> [[f64; 2]; 2] {
        let (points, about): (Vec<[f64; 2]>, f64) = match self {
            Self::Upright { line, .. } => (line.end_points().to_vec(), BEHIND),
            Self::Roof { polygon, .. } => (polygon.clone(), BESIDE_ROOF),
        };
        let low = [0, 1].map(|axis| points.iter().map(|p| p[axis]).fold(f64::INFINITY, f64::min) - about);
        let high = [0, 1].map(|axis| points.iter().map(|p| p[axis]).fold(f64::NEG_INFINITY, f64::max) + about);
        [low, high]
    }

    /// The region that the ball of a point does not reach into.
    fn region_of(&self, p: [f64; 3]) -> Option<Region> {
        let plan = |[x, y]: [f64; 2]| [x, y, 0.0];
        match self {
            Self::Upright { line, top, above, foot, eaves } => {
                let [t, d] = line.of([p[0], p[1]]);
                let [from, to] = [line.ends[0] - BEYOND, line.ends[1] + BEYOND];
                let is_of_eaves = *eaves > MIN_EAVES && d <= eaves + EAVES_DEPTH && top.above(p).abs() < 0.3;
                if !(from..=to).contains(&t)
                    || d < -BEHIND
                    || (d > BEFORE && !is_of_eaves)
                    || top.above(p) > above.max(ABOVE)
                    || p[2] < foot - ABOVE
                {
                    return None;
                }
                let (outward, along) = (plan(line.outward()), plan(line.along));
                let opposite = |v: [f64; 3]| v.map(|v| -v);
                let at = |t: f64, d: f64| plan(line.at(t, d));
                Some(Region {
                    half_spaces: vec![
                        (opposite(outward), -dot(outward, at(0.0, MARGIN))),
                        (outward, dot(outward, at(0.0, DEPTH))),
                        (opposite(along), -dot(along, at(from, 0.0))),
                        (along, dot(along, at(to, 0.0))),
                        (top.normal, top.offset + above),
                        ([0.0, 0.0, -1.0], -foot),
                    ],
                })
            }
            Self::Roof { polygon, plane } => {
                let above = plane.above(p);
                if !(-BEHIND..=BEFORE).contains(&above) {
                    return None;
                }
                let mut half_spaces = Vec::with_capacity(polygon.len() + 2);
                for (i, &a) in polygon.iter().enumerate() {
                    let b = polygon[(i + 1) % polygon.len()];
                    let [x, y] = [b[0] - a[0], b[1] - a[1]];
                    let length = x.hypot(y);
                    if length < 1e-9 {
                        continue;
                    }
                    let out = [y / length, -x / length, 0.0];
                    if dot(out, p) - dot(out, plan(a)) > BESIDE_ROOF {
                        return None;
                    }
                    half_spaces.push((out, dot(out, plan(a))));
                }
                half_spaces.push((plane.normal.map(|v| -v), -(plane.offset + MARGIN)));
                half_spaces.push((plane.normal, plane.offset + DEPTH));
                Some(Region { half_spaces })
            }
        }
    }
}

/// The regions of a block.
pub(super) fn of_block(
    block: &Block,
    roofs: &Roofs,
    outlines: &[Outline],
    walls: &[WallLine],
    leaves: &[Leaf],
) -> SurfaceRegions {
    let mut surfaces = Vec::new();
    for (plane, outline) in outlines.iter().enumerate() {
        for edge in outline.edges.iter().filter(|edge| edge.is_sure) {
            let top = roofs.planes[plane].plane;
            let middle = edge.line.at(f64::midpoint(edge.line.ends[0], edge.line.ends[1]), 0.0);
            let foot = top.height(middle) - edge.drop - ABOVE;
            let above = edge.parapet.height + ABOVE;
            surfaces.push(Surface::Upright { line: edge.line, top, above, foot, eaves: 0.0 });
        }
    }
    for wall in walls {
        let edge = &outlines[wall.plane].edges[wall.edge];
        let top = roofs.planes[wall.plane].plane;
        let middle = edge.line.at(f64::midpoint(edge.line.ends[0], edge.line.ends[1]), 0.0);
        let foot = wall.bottom.min(top.height(middle) - edge.drop) - ABOVE;
        let above = if wall.eaves > MIN_EAVES { -EAVES_DEPTH } else { edge.parapet.height + ABOVE };
        surfaces.push(Surface::Upright { line: wall.line, top, above, foot, eaves: wall.eaves });
    }
    for leaf in leaves.iter().filter(|leaf| leaf.is_whole) {
        let plane = roofs.planes[leaf.plane].plane;
        surfaces.push(Surface::Roof { polygon: leaf.polygon.clone(), plane });
    }
    let mut cells = vec![Vec::new(); CELLS * CELLS];
    for (number, surface) in surfaces.iter().enumerate() {
        let [low, high] = surface.bounds();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the block")]
        let cell = |v: f64| (v / CELL).clamp(0.0, CELLS as f64) as usize;
        for row in cell(low[1])..(cell(high[1]) + 1).min(CELLS) {
            for column in cell(low[0])..(cell(high[0]) + 1).min(CELLS) {
                cells[row * CELLS + column].extend(u32::try_from(number));
            }
        }
    }
    SurfaceRegions { blocks: vec![BlockRegions { corner: block.corner, surfaces, cells }] }
}
