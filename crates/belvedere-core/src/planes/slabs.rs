//! Slabs: decks, canopies, balconies and bridges, level planes that pulses run below.
//!
//! A ball below a slab would fill open space. A slab is closed by two level sheets instead, its top and its underside,
//! and its points have no balls. Below it, only objects with points of their own are solid.

use super::block::{Block, Return};
use super::fit::Plane;
use super::leaves::Leaf;
use super::patches::{Patch, fan};
use super::roof_planes::Roofs;
use belvedere_data::cast::{to_i64, to_u32};
use belvedere_data::patches::PatchKind;
use belvedere_data::vector::box_around;
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::TAU;

/// Parameters of slabs: detection and closing.
///
/// Thresholds except `around` and `open_radius`, which are those of thin surfaces, were set once, on a town of another
/// simulator. There 89 to 97 % of the points marked lay on slabs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlabParams {
    /// Minimum and maximum depth below a slab at which a pulse proves it, metres. Default 0.8 to 12.
    pub depths: [f64; 2],
    /// Minimum share of the cells of a square metre that hold points of a slab with pulses passing below, 0 to 1.
    /// Default 0.25.
    pub min_share: f64,
    /// Minimum upward part of the normal of a slab. Default 0.98, 11° of slope.
    pub min_up: f64,
    /// Maximum root mean square distance of its points from its plane, metres. Default 0.06.
    pub max_noise: f64,
    /// Distance from its top to its underside, metres. Default 0.3. With one sheet 0.2 to 0.7 points more are falsely
    /// visible.
    pub thickness: f64,
    /// Distance within which points of the slab must lie around a pulse below it, metres, and in spacings of pulses:
    /// the larger of both. Default 0.75 and 2.4.
    pub around: [f64; 2],
    /// Widest angle between neighbouring ones of those points, radians. Default 2.7.
    pub widest_gap: f64,
    /// Distance about a pulse within which hardly a point of a wall may lie below the slab, metres, and in spacings of
    /// pulses: the larger of both. Default 1.5 and 2.8: eaves stand out over walls.
    pub open_radius: [f64; 2],
    /// Points that may lie there all the same: posts, goods. Default 1.
    pub max_below: usize,
    /// Side of the cells of which pulses must run below a share, metres. Default 1.
    pub(super) cell: f64,
    /// Length of the steps along a pulse below a slab, metres in plan. Default 0.25.
    pub(super) step: f64,
    /// Minimum depth below the top of a slab, beyond its thickness, of points that are no part of it, metres. Default
    /// 0.2.
    pub(super) below: f64,
    /// Maximum height of points of a slab above its plane, metres, if their noise is less. Default 0.1.
    pub(super) above: f64,
    /// Share of the points of a plane with the class of bridge decks that makes it a slab without any pulse below it.
    /// Default 0.5.
    pub(super) deck_share: f64,
    /// Gap about a place that never lies below a slab, radians. Default 3.2: hardly more than the π of one below its
    /// outermost points.
    pub(super) max_gap: f64,
}

impl Default for SlabParams {
    fn default() -> Self {
        Self {
            depths: [0.8, 12.0],
            min_share: 0.25,
            min_up: 0.98,
            max_noise: 0.06,
            thickness: 0.3,
            around: [0.75, 2.4],
            widest_gap: 2.7,
            open_radius: [1.5, 2.8],
            max_below: 1,
            cell: 1.0,
            step: 0.25,
            below: 0.2,
            above: 0.1,
            deck_share: 0.5,
            max_gap: 3.2,
        }
    }
}

/// Flags the planes that are slabs.
pub(super) fn find(block: &Block, roofs: &Roofs, params: &SlabParams) -> Vec<bool> {
    (0..roofs.planes.len()).map(|number| is_slab(block, roofs, number, params)).collect()
}

/// Points in plan by square cells.
struct PlanIndex {
    side: f64,
    cells: BTreeMap<[i64; 2], Vec<[f64; 3]>>,
}

impl PlanIndex {
    fn new(points: impl Iterator<Item = [f64; 3]>, side: f64) -> Self {
        let mut cells: BTreeMap<[i64; 2], Vec<[f64; 3]>> = BTreeMap::new();
        for p in points {
            cells.entry(cell([p[0], p[1]], side)).or_default().push(p);
        }
        Self { side, cells }
    }

    /// Points of the cell of a place and the eight about it.
    fn points_near(&self, p: [f64; 3]) -> impl Iterator<Item = &[f64; 3]> {
        let [x, y] = cell([p[0], p[1]], self.side);
        let about = (y - 1..=y + 1).flat_map(move |y| (x - 1..=x + 1).map(move |x| [x, y]));
        about.filter_map(|cell| self.cells.get(&cell)).flatten()
    }
}

fn cell(p: [f64; 2], side: f64) -> [i64; 2] {
    p.map(|v| to_i64((v / side).floor()))
}

/// Returns true if a plane is a slab: level, flat, and with pulses passing below, or of the class of bridge decks.
fn is_slab(block: &Block, roofs: &Roofs, number: usize, params: &SlabParams) -> bool {
    let roof = &roofs.planes[number];
    if roof.plane.normal[2] < params.min_up || roof.plane.noise > params.max_noise {
        return false;
    }
    let of_rows = || roofs.returns_of(roof).map(|row| &block.returns[row]);
    if of_rows().filter(|found| found.is_deck).count() as f64 >= params.deck_share * roof.rows.len() as f64 {
        return true;
    }
    let [around, open] =
        [params.around, params.open_radius].map(|[metres, spacings]| metres.max(spacings * roof.spacing));
    let own = PlanIndex::new(of_rows().map(|found| found.p), around);
    let cells: BTreeSet<[i64; 2]> = of_rows().map(|found| cell([found.p[0], found.p[1]], params.cell)).collect();
    let [low, high] = box_around(of_rows().map(|found| found.p));
    let mut walls = Vec::new();
    block.each_in([low[0] - open, low[1] - open], [high[0] + open, high[1] + open], |_, found| {
        if found.is_solid() && roof.plane.distance_above(found.p) < -params.thickness - params.below {
            walls.push(found.p);
        }
    });
    let walls = PlanIndex::new(walls.into_iter(), open);
    let proves = |place: [f64; 3]| {
        let beside = |p: &&[f64; 3]| (0..3).map(|i| (p[i] - place[i]).powi(2)).sum::<f64>() <= open * open;
        walls.points_near(place).filter(beside).count() <= params.max_below && is_within(&own, place, around, params)
    };
    let mut proven: BTreeSet<[i64; 2]> = BTreeSet::new();
    let shift = block.max_shift(high[2]);
    block.each_in([low[0] - shift, low[1] - shift], [high[0] + shift, high[1] + shift], |_, pulse| {
        each_below(&roof.plane, pulse, params, |place| {
            let at = cell([place[0], place[1]], params.cell);
            if cells.contains(&at) && !proven.contains(&at) && proves(place) {
                proven.insert(at);
            }
        });
    });
    proven.len() as f64 >= params.min_share * cells.len() as f64
}

/// Calls `visit` with places along a pulse at these depths below a plane, a step apart.
fn each_below(plane: &Plane, pulse: &Return, params: &SlabParams, mut visit: impl FnMut([f64; 3])) {
    let depths = params.depths;
    let [x, y] = pulse.lean;
    // how much nearer to the plane for each metre up
    let nearer = plane.normal[0] * x + plane.normal[1] * y + plane.normal[2];
    let depth = -plane.distance_above(pulse.p);
    if !pulse.is_first || !(nearer > 0.2) || depth < depths[0] {
        return;
    }
    let [from, to] = [((depth - depths[1]) / nearer).max(0.0), (depth - depths[0]) / nearer];
    let length = (to - from) * x.hypot(y);
    let steps = to_u32((length / params.step).ceil().clamp(1.0, 1000.0));
    for step in 0..=steps {
        let up = from + (to - from) * f64::from(step) / f64::from(steps);
        visit([pulse.p[0] + up * x, pulse.p[1] + up * y, pulse.p[2] + up]);
    }
}

/// Returns true if points of a slab lie all around a place below it. Sparse points do not reach its edge. Each end of
/// the gap may lie one mean angle between them farther, as long as the whole is hardly more than half a turn.
fn is_within(own: &PlanIndex, place: [f64; 3], around: f64, params: &SlabParams) -> bool {
    let near =
        own.points_near(place).map(|p| [p[0] - place[0], p[1] - place[1]]).filter(|[x, y]| x.hypot(*y) <= around);
    let mut angles: Vec<f64> = near.map(|[x, y]| y.atan2(x)).collect();
    angles.sort_unstable_by(f64::total_cmp);
    let (Some(&first), Some(&last)) = (angles.first(), angles.last()) else { return false };
    let width = angles.windows(2).map(|pair| pair[1] - pair[0]).fold(first + TAU - last, f64::max);
    let between = (TAU - width) / angles.len() as f64;
    width < params.max_gap && width - 2.0 * between < params.widest_gap
}

/// Sheets that close a slab: both, or the underside of one that is closed as a roof already.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Sheets {
    Both,
    Underside,
}

/// Slabs as far as they lie in the block.
pub(super) struct Slabs {
    /// Triangles of their sheets.
    pub(super) patches: Vec<Patch>,
    /// Number of slabs.
    pub(super) count: usize,
    /// Rows in the survey of the points on them. A point may occur twice.
    pub(super) rows: Vec<u32>,
}

/// Closes slabs within the block.
pub(super) fn close(
    block: &Block,
    roofs: &Roofs,
    are_slabs: &[bool],
    leaves: &[Leaf],
    sheets: Sheets,
    params: &SlabParams,
) -> Slabs {
    let sheets_of = |leaf: &Leaf| {
        let polygon = block.clipped(&leaf.polygon);
        let plane = &roofs.planes[leaf.plane].plane;
        let sheet = |below: f64| polygon.iter().map(move |&[x, y]| [x, y, plane.height([x, y]) - below]);
        let top: Vec<[f64; 3]> = if sheets == Sheets::Both { sheet(0.0).collect() } else { Vec::new() };
        // counter-clockwise seen from below
        let underside: Vec<[f64; 3]> = sheet(params.thickness).rev().collect();
        [top, underside].into_iter().flat_map(|corners| fan(block, &corners, PatchKind::Slab))
    };
    let patches = leaves.iter().filter(|leaf| are_slabs[leaf.plane]).flat_map(sheets_of).collect();
    let slabs = (0..roofs.planes.len()).filter(|&number| are_slabs[number]);
    let rows: Vec<Vec<u32>> = slabs.map(|number| rows_of(block, roofs, number, leaves, params)).collect();
    Slabs { patches, count: rows.iter().filter(|rows| !rows.is_empty()).count(), rows: rows.concat() }
}

/// Returns the rows in the survey of the points of the block that lie on a slab.
fn rows_of(block: &Block, roofs: &Roofs, number: usize, leaves: &[Leaf], params: &SlabParams) -> Vec<u32> {
    let roof = &roofs.planes[number];
    let own: Vec<&Leaf> = leaves.iter().filter(|leaf| leaf.plane == number).collect();
    let [low, high] = box_around(roofs.returns_of(roof).map(|row| &block.returns[row]).map(|found| found.p));
    let reach = roof.spacing;
    let mut rows = Vec::new();
    block.each_in([0, 1].map(|i| low[i] - reach), [0, 1].map(|i| high[i] + reach), |row, at| {
        let place = [at.p[0], at.p[1]];
        let above = roof.plane.distance_above(at.p);
        let is_near = || {
            let heights = -params.thickness - params.below..=params.above.max(3.0 * roofs.noise);
            at.is_solid() && heights.contains(&above) && own.iter().any(|leaf| leaf.holds(place))
        };
        let is_own = roofs.plane_of_return[row].is_some_and(|plane| plane as usize == number);
        if block.holds(place) && (is_own || is_near()) {
            rows.push(at.row);
        }
    });
    rows
}
