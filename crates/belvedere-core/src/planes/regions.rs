//! Empty space before known surfaces, which balls behind them do not enter.

use super::block::{BLOCK, Block, block_of};
use super::edges::Outline;
use super::fit::Plane;
use super::leaves::Leaf;
use super::line::PlanLine;
use super::roof_planes::Roofs;
use super::walls::WallLine;
use belvedere_data::Result;
use belvedere_data::balls::{LIMIT_TOUCH, MedialBalls, NO_TOUCH};
use belvedere_data::cast::{to_f32, to_index};
use belvedere_data::control::{Control, Stop};
use belvedere_data::vector::{dot, sub, unit};
use rayon::prelude::*;

/// Columns, and rows, of the cells of a block in which regions are looked up.
const CELLS: usize = 16;
/// Side of these cells, metres.
const CELL: f64 = BLOCK / 16.0;
/// Balls that a thread looks at in one go.
const CHUNK: usize = 256;

/// Parameters of regions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RegionParams {
    /// Distance before a surface at which its region begins, metres. Default 0.02: balls stand out over points by as
    /// much.
    pub(super) margin: f64,
    /// Depth of a region, metres. Default 3.
    pub(super) depth: f64,
    /// Maximum distance before a surface of points whose balls it bounds, metres. Default 0.1.
    pub(super) before: f64,
    /// Maximum distance behind a surface of points whose balls it bounds, metres. Default 6.
    pub(super) behind: f64,
    /// Length of a region beyond the ends of its line, metres. Default 0.4.
    pub(super) beyond: f64,
    /// Maximum height of points above the top of a wall, metres. Default 0.5.
    pub(super) above: f64,
    /// Maximum depth of balls of eaves below their roof, metres. Default 0.15.
    pub(super) eaves_depth: f64,
    /// Maximum distance beside a piece of a roof of points whose balls it bounds, metres. Default 3.
    pub(super) beside_roof: f64,
    /// Minimum radius of a capped ball, metres. Default 0.01: smaller ones block nothing that patches do not.
    pub(super) min_radius: f32,
}

impl Default for RegionParams {
    fn default() -> Self {
        Self {
            margin: 0.02,
            depth: 3.0,
            before: 0.1,
            behind: 6.0,
            beyond: 0.4,
            above: 0.5,
            eaves_depth: 0.15,
            beside_roof: 3.0,
            min_radius: 0.01,
        }
    }
}

/// A convex piece of space before a surface.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Region {
    /// Half-spaces that hold it: unit vectors outward, and their products with a point of the bounding plane, local
    /// metres.
    half_spaces: Vec<([f64; 3], f64)>,
}

#[cfg(test)]
impl Region {
    /// Returns a lower bound of the distance of a place outside, metres; negative inside.
    pub(super) fn distance(&self, p: [f64; 3]) -> f64 {
        self.half_spaces.iter().map(|&(normal, offset)| dot(normal, p) - offset).fold(f64::NEG_INFINITY, f64::max)
    }
}

/// Surface that bounds a region.
#[derive(Clone, Debug, PartialEq)]
enum Surface {
    /// Upright surface on a line, below a plane: its maximum height above that plane, the height of its foot, and the
    /// distance before it of the points of its eaves, if it has some.
    Upright { line: PlanLine, top: Plane, above: f64, foot: f64, eaves: Option<f64> },
    /// A convex piece of a plane.
    Roof { polygon: Vec<[f64; 2]>, plane: Plane },
}

/// Regions of a block.
#[derive(Clone, Debug, Default, PartialEq)]
struct BlockRegions {
    number: [i64; 2],
    corner: [f64; 3],
    surfaces: Vec<Surface>,
    /// Surfaces that may bound balls of the points in each cell.
    cells: Vec<Vec<u32>>,
}

/// Space before the surfaces of a survey, by block.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SurfaceRegions {
    /// Origin of local positions in plan.
    origin: [f64; 2],
    params: RegionParams,
    /// Sorted by number.
    blocks: Vec<BlockRegions>,
}

impl SurfaceRegions {
    pub(super) fn append(&mut self, other: Self) {
        self.origin = other.origin;
        self.params = other.params;
        self.blocks.extend(other.blocks);
    }

    /// The regions that the ball of a point does not reach into, for a point as measured, local metres.
    #[cfg(test)]
    pub(super) fn of_point(&self, p: [f32; 3]) -> Vec<Region> {
        self.regions_that(p, |_, _| true)
    }

    /// The regions of a point before those of its surfaces that `counts`, given the surface and the corner of its
    /// block, is true for.
    fn regions_that(&self, p: [f32; 3], counts: impl Fn(&Surface, [f64; 3]) -> bool) -> Vec<Region> {
        let number = block_of(p, self.origin);
        let Ok(place) = self.blocks.binary_search_by_key(&number, |block| block.number) else { return Vec::new() };
        self.blocks[place].regions(p.map(f64::from), &self.params, counts)
    }

    /// The greatest radius, at most `radius`, of the ball about `center` that keeps the place where it touches its
    /// point, and reaches into none of the regions of this point. `point` is as measured; local metres. Below zero and
    /// 0 mean that no ball is left.
    ///
    /// # Source
    /// This project's. A ball touches at a, with its centre in the direction m. It lies outside a half-space with
    /// outward normal n and distance s = n·a − d as long as r ≤ s / (1 − n·m). It lies outside a convex region as long
    /// as this holds for one of its half-spaces.
    #[must_use]
    pub fn radius_of(&self, point: [f32; 3], center: [f32; 3], radius: f32) -> f32 {
        let (p, c) = (point.map(f64::from), center.map(f64::from));
        let whole = f64::from(radius);
        let mut most = whole;
        let Some(inward) = unit(sub(c, p)) else { return radius };
        let touch: [f64; 3] = std::array::from_fn(|i| c[i] - most * inward[i]);
        let reaches_out =
            |surface: &Surface, corner: [f64; 3]| surface.distance_before(sub(c, corner)) + whole > self.params.margin;
        for region in self.regions_that(point, reaches_out) {
            let fits = region.half_spaces.iter().map(|&(normal, offset)| {
                let (apart, away) = (dot(normal, touch) - offset, 1.0 - dot(normal, inward));
                if apart <= 0.0 { 0.0 } else { apart / away.max(1e-9) }
            });
            most = most.min(fits.fold(0.0, f64::max));
        }
        let most = to_f32(most);
        most.min(radius)
    }
}

/// Caps balls so that none reaches into a region of its point: a ball keeps the place where it touches its surface, and
/// its middle moves there. Nothing is left of one that becomes smaller than a centimetre ([`NO_TOUCH`]). `measured` are
/// the points before they were moved onto their surface. Returns how many were capped.
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
    let capped = |row: usize| -> Option<(usize, [f32; 3], f32)> {
        if balls.touch[row] == NO_TOUCH || stop.is_set() {
            return None;
        }
        let (center, whole) = (balls.centers[row], balls.radii[row]);
        let point = *measured.get(balls.source[row] as usize)?;
        let radius = regions.radius_of(point, center, whole);
        let inward = unit(sub(center.map(f64::from), point.map(f64::from)))?;
        let by = f64::from(whole - radius);
        let moved = std::array::from_fn(|i| to_f32(f64::from(center[i]) - by * inward[i]));
        (radius < whole).then_some((row, moved, radius))
    };
    let capped: Vec<_> = (0..balls.len()).into_par_iter().with_min_len(CHUNK).filter_map(capped).collect();
    stop.check()?;
    for &(row, center, radius) in &capped {
        balls.centers[row] = center;
        balls.radii[row] = radius;
        balls.touch[row] = if radius < regions.params.min_radius { NO_TOUCH } else { LIMIT_TOUCH };
        balls.separation_angles[row] = f32::NAN;
    }
    Ok(capped.len())
}

impl BlockRegions {
    /// The regions of a point, local metres, before surfaces that count.
    fn regions(&self, p: [f64; 3], params: &RegionParams, counts: impl Fn(&Surface, [f64; 3]) -> bool) -> Vec<Region> {
        let p = sub(p, self.corner);
        let [column, row] = [0, 1].map(|axis| to_index(p[axis] / CELL).min(CELLS - 1));
        let near = self.cells.get(row * CELLS + column).into_iter().flatten();
        let surfaces = near.filter_map(|&number| self.surfaces.get(number as usize));
        let mut found: Vec<Region> = surfaces
            .filter(|surface| counts(surface, self.corner))
            .filter_map(|surface| surface.region_of(p, params))
            .collect();
        for (normal, offset) in found.iter_mut().flat_map(|region| &mut region.half_spaces) {
            *offset += dot(*normal, self.corner);
        }
        found
    }
}

impl Surface {
    /// Returns the distance of a place before the surface, metres.
    fn distance_before(&self, p: [f64; 3]) -> f64 {
        match self {
            Self::Upright { line, .. } => line.of([p[0], p[1]])[1],
            Self::Roof { plane, .. } => plane.distance_above(p),
        }
    }

    /// Box in plan of the points whose balls it may bound.
    fn bounds(&self, params: &RegionParams) -> [[f64; 2]; 2] {
        let (points, about): (Vec<[f64; 2]>, f64) = match self {
            Self::Upright { line, .. } => (line.end_points().to_vec(), params.behind),
            Self::Roof { polygon, .. } => (polygon.clone(), params.beside_roof),
        };
        let low = [0, 1].map(|axis| points.iter().map(|p| p[axis]).fold(f64::INFINITY, f64::min) - about);
        let high = [0, 1].map(|axis| points.iter().map(|p| p[axis]).fold(f64::NEG_INFINITY, f64::max) + about);
        [low, high]
    }

    /// The region that the ball of a point does not reach into.
    fn region_of(&self, p: [f64; 3], params: &RegionParams) -> Option<Region> {
        let &RegionParams { margin, depth, before, behind, beyond, above: max_above, eaves_depth, .. } = params;
        let plan = |[x, y]: [f64; 2]| [x, y, 0.0];
        match self {
            Self::Upright { line, top, above, foot, eaves } => {
                let [t, d] = line.of([p[0], p[1]]);
                let [from, to] = [line.ends[0] - beyond, line.ends[1] + beyond];
                let is_of_eaves =
                    eaves.is_some_and(|eaves| d <= eaves + eaves_depth && top.distance_above(p).abs() < 0.3);
                if !(from..=to).contains(&t)
                    || d < -behind
                    || (d > before && !is_of_eaves)
                    || top.distance_above(p) > above.max(max_above)
                    || p[2] < foot - max_above
                {
                    return None;
                }
                let (outward, along) = (plan(line.outward()), plan(line.along));
                let opposite = |v: [f64; 3]| v.map(|v| -v);
                let at = |t: f64, d: f64| plan(line.at(t, d));
                Some(Region {
                    half_spaces: vec![
                        (opposite(outward), -dot(outward, at(0.0, margin))),
                        (outward, dot(outward, at(0.0, depth))),
                        (opposite(along), -dot(along, at(from, 0.0))),
                        (along, dot(along, at(to, 0.0))),
                        (top.normal, top.offset + above),
                        ([0.0, 0.0, -1.0], -foot),
                    ],
                })
            }
            Self::Roof { polygon, plane } => {
                let above = plane.distance_above(p);
                if !(-behind..=before).contains(&above) {
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
                    if dot(out, p) - dot(out, plan(a)) > params.beside_roof {
                        return None;
                    }
                    half_spaces.push((out, dot(out, plan(a))));
                }
                half_spaces.push((plane.normal.map(|v| -v), -(plane.offset + margin)));
                half_spaces.push((plane.normal, plane.offset + depth));
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
    params: &RegionParams,
) -> SurfaceRegions {
    let mut surfaces = Vec::new();
    for (plane, outline) in outlines.iter().enumerate() {
        for edge in outline.sure_edges() {
            let top = roofs.planes[plane].plane;
            let middle = edge.line.at(f64::midpoint(edge.line.ends[0], edge.line.ends[1]), 0.0);
            let foot = top.height(middle) - edge.drop - params.above;
            let above = edge.parapet.height + params.above;
            surfaces.push(Surface::Upright { line: edge.line, top, above, foot, eaves: None });
        }
    }
    for wall in walls {
        let edge = &outlines[wall.plane].edges[wall.edge];
        if !(edge.is_sure || wall.is_closed) {
            continue;
        }
        let top = roofs.planes[wall.plane].plane;
        let middle = edge.line.at(f64::midpoint(edge.line.ends[0], edge.line.ends[1]), 0.0);
        let foot = wall.bottom.min(top.height(middle) - edge.drop) - params.above;
        let above = if wall.has_eaves { -params.eaves_depth } else { edge.parapet.height + params.above };
        let eaves = wall.has_eaves.then_some(wall.eaves);
        surfaces.push(Surface::Upright { line: wall.line, top, above, foot, eaves });
    }
    for leaf in leaves.iter().filter(|leaf| leaf.is_whole) {
        let plane = roofs.planes[leaf.plane].plane;
        surfaces.push(Surface::Roof { polygon: leaf.polygon.clone(), plane });
    }
    let mut cells = vec![Vec::new(); CELLS * CELLS];
    for (number, surface) in surfaces.iter().enumerate() {
        let [low, high] = surface.bounds(params);
        let cell = |v: f64| to_index((v / CELL).clamp(0.0, CELLS as f64));
        for row in cell(low[1])..(cell(high[1]) + 1).min(CELLS) {
            for column in cell(low[0])..(cell(high[0]) + 1).min(CELLS) {
                cells[row * CELLS + column].extend(u32::try_from(number));
            }
        }
    }
    let origin = [0, 1].map(|axis| block.origin[axis]);
    SurfaceRegions {
        origin,
        params: *params,
        blocks: vec![BlockRegions { number: block.number, corner: block.corner, surfaces, cells }],
    }
}
