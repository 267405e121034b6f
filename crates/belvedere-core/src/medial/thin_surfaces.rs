//! Surfaces with open space close below them, found by the pulses that run there: decks, canopies, balconies, bridges.

use super::chains::MIN_SHARE;
use super::layers::Layers;
use super::marking_rule::{MarkingRule, Phase};
use super::marks::{Cap, Fill, FillPlace, Marks};
use super::midway::{neighbors_after, one_in_each_cell};
use super::survey::{CarvedInput, Survey};
use crate::neighbors::NeighborIndex;
use crate::pulses::FreeSegments;
use belvedere_data::Result;
use belvedere_data::balls::MedialBalls;
use belvedere_data::control::{Control, Stop};
use rayon::prelude::*;
use std::f32::consts::TAU;
use std::sync::atomic::{AtomicBool, Ordering};

/// Cells beside a voxel, of eight, that must hold points of its height for pulses below it to be looked at. On a
/// straight edge five do; one of these may be empty where points are sparse.
const MIN_BESIDE: usize = 4;
/// Maximum vertical distance between points of one surface that a pulse passes below, metres: a voxel and half of
/// another, so that slopes up to 40° count.
const SAME_SURFACE: f32 = 0.6;
/// Gap about a pulse that is never taken for one below a surface, radians: hardly more than the π of a pulse below the
/// outermost points. The edge of the surface lies farther out than these points by half their spacing, and a wall below
/// it would have stopped the pulse.
const WIDEST_OF_ALL: f32 = 3.2;
/// Minimum depth below a voxel of points that are not part of its surface, metres: more than the height of a voxel.
const OF_THE_SURFACE: f32 = 0.5;
/// Maximum distance of neighbours on one surface, in spacings of pulses: hardly any of a surface are farther apart.
const FARTHEST_APART_SPACINGS: f32 = 3.0;
/// Share of the gap between neighbours, around its middle, that is clear of others. With points at random places, 0.75
/// leaves 1.8 % of a surface uncovered and adds 3.4 balls for each point; 1 leaves 7.7 % and adds 1.9. Balls at points
/// only, half as large again, left 5 %.
const CLEAR_SHARE: f32 = 0.75;
/// Nearest neighbours that anything is filled between, metres: above noise.
const MIN_APART: f32 = 0.05;
/// Maximum difference in height of neighbours on a surface, metres.
const SAME_LEVEL: f32 = 0.3;
/// FreeSegments, or points, handed to a thread at once.
const CHUNK: usize = 1024;
/// FreeSegments between two looks at whether to go on.
const CHECK_EACH: usize = 64;

/// Parameters of thin surfaces: detection, and maximum size of balls.
///
/// Defaults were chosen on three simulated towns of seed 7 at 8 pulses per m². `widest_gap`, and the depth to which a
/// pulse must pass below an edge, were chosen later, on towns of seeds 1 to 3 at 10, where small stalls were missed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinSurfaceParams {
    /// Maximum radius of balls at points of a thin surface, and midway between neighbours among them, in spacings of
    /// pulses, above 0. Default 0.6. With balls at points only it took 0.95 to close the surface, which made it half as
    /// thick again.
    pub radius_spacings: f32,
    /// Minimum and maximum depth below a surface at which a pulse proves it thin, metres. Default 1 to 5: nearer is
    /// noise and relief, farther the arcade of a house, whose roof is not thin.
    pub depths: [f32; 2],
    /// Minimum side of the cells of surfaces, metres, and in mean spacings of pulses: the larger of both, above 0.
    /// Default 0.5 and 1.56, which is 0.5 m at ten pulses per m². At 2 pulses, half of the cells of 0.5 m are empty. A
    /// factor of 2.1 raises the false-visible rate in streets by a third at 12 pulses (2.6 to 3.5 %), and not at 2 and
    /// 5.
    pub cell: [f32; 2],
    /// Distance within which points of the surface must lie around a pulse below it, metres, and in mean spacings of
    /// pulses: the larger of both, above 0. Default 0.75 and 2.4, chosen with `cell`.
    pub around: [f32; 2],
    /// Maximum angle between neighbouring ones of those points where points are dense, radians. Default 2.7: at 2
    /// pulses, too few look a few decimetres below a canopy of 3 m to find it. Sparse points do not reach the edge of a
    /// surface. Each end of the gap may lie one mean angle farther, as long as the whole stays below 3.2.
    pub widest_gap: f32,
    /// Minimum number of proven cells of a surface, in square roots of its number of cells, above 0. Pulses reach below
    /// an edge, and the length of the edge grows with that root. Default 0.5: at 0.3 more of the roofs of a real tile
    /// (Delft) are taken for thin.
    pub min_proof: f32,
    /// Radius around a pulse below a surface that is nearly free of solid points below that surface, metres, and in
    /// mean spacings of pulses: the larger of both. Default 1.5 and 2.8. Eaves stand out over walls, whose points
    /// betray them. Without this rule two thirds of the roofs of real tiles (Delft, Bresse) were taken for thin; with
    /// it 13 % and next to none.
    pub open_radius: [f32; 2],
    /// Points that may lie there all the same: posts, goods, the foot of the pulse itself. Default 1.
    pub max_below: usize,
}

impl Default for ThinSurfaceParams {
    fn default() -> Self {
        Self {
            radius_spacings: 0.6,
            depths: [1.0, 5.0],
            cell: [0.5, 1.56],
            around: [0.75, 2.4],
            widest_gap: 2.7,
            min_proof: 0.5,
            open_radius: [1.5, 2.8],
            max_below: 1,
        }
    }
}

/// Flags the points of `input` that lie on a thin surface. The result depends on neither the order of points and pulses
/// nor the number of threads.
///
/// # Errors
/// [`Error::Cancelled`](belvedere_data::Error::Cancelled).
pub fn on_thin_surfaces(
    input: &CarvedInput<'_>,
    params: &ThinSurfaceParams,
    control: &Control<'_>,
) -> Result<Vec<bool>> {
    params.thin_points(&Survey::of(input), control)
}

impl MarkingRule for ThinSurfaceParams {
    fn stage(&self) -> Option<(Phase, &'static str)> {
        Some((Phase::Points, "finding thin surfaces"))
    }

    /// Caps at the points of thin surfaces, and fills midway between neighbours among them.
    fn marks(&self, survey: &Survey<'_>, _: &MedialBalls, control: &Control<'_>) -> Result<Marks> {
        let thin = self.thin_points(survey, control)?;
        let rows: Vec<usize> = (0..thin.len()).filter(|&row| thin[row]).collect();
        let cap =
            |&row: &usize| Cap { is_claimed: true, ..Cap::tangent(row, self.radius_spacings * survey.spacing[row]) };
        let caps = rows.iter().map(cap).collect();
        let counts = vec![("points_on_thin_surfaces", rows.len())];
        Ok(Marks { caps, fills: self.fills(survey, rows, control)?, counts, ..Marks::default() })
    }

    fn fills_name(&self) -> &'static str {
        "balls_in_thin_surfaces"
    }
}

impl ThinSurfaceParams {
    /// Flags the points that lie on a thin surface. Surfaces end at blocks of 64 m, so that every part of a survey that
    /// holds a block and its surroundings finds the same. The result depends on neither the order of points and pulses
    /// nor the number of threads.
    fn thin_points(&self, survey: &Survey<'_>, control: &Control<'_>) -> Result<Vec<bool>> {
        let stop = Stop::new(control);
        let (positions, index) = (survey.positions(), survey.index);
        let solid = |row: usize| survey.is_solid(row);
        let mean_spacing = survey.statistics.spacing;
        let [cell, around, open_radius] =
            [self.cell, self.around, self.open_radius].map(|[metres, spacings]| metres.max(spacings * mean_spacing));
        let Some(layers) = Layers::new(survey.measured, survey.oriented.origin(), cell, solid) else {
            return Ok(vec![false; positions.len()]);
        };
        control.check()?;
        let beside: Vec<usize> = (0..layers.len())
            .into_par_iter()
            .map(|voxel| if stop.is_set() { 0 } else { layers.count_beside(voxel) })
            .collect();
        stop.check()?;
        let is_roof = |at: [f32; 3]| {
            let near = |row: usize| solid(row) && (positions[row][2] - at[2]).abs() < SAME_SURFACE;
            let Gap { width, count, .. } = widest_gap(positions, index, at, around, near);
            let between_points = (TAU - width) / f32::from(count.max(1));
            width < WIDEST_OF_ALL && width - 2.0 * between_points < self.widest_gap
        };
        let is_open = |pulse: [f32; 3], bottom: f32| {
            let mut walls = 0;
            index.within_radius(pulse, open_radius, |found| {
                let row = found.index as usize;
                walls += usize::from(solid(row) && positions[row][2] < bottom - OF_THE_SURFACE);
            });
            walls <= self.max_below
        };
        let proven = run_below(&layers, &beside, survey.free_segments, self.depths, is_roof, is_open, control)?;
        let thin = surfaces(&layers, &beside, &proven, self.min_proof);
        control.check()?;
        let is_thin = |row| solid(row) && layers.voxel_of(survey.measured[row]).is_some_and(|voxel| thin[voxel]);
        Ok((0..positions.len()).into_par_iter().map(is_thin).collect())
    }

    /// Fills midway between neighbours among the points `rows` of thin surfaces, where no other comes close to the
    /// middle.
    fn fills(&self, survey: &Survey<'_>, rows: Vec<usize>, control: &Control<'_>) -> Result<Vec<Fill>> {
        let stop = Stop::new(control);
        let rows = one_in_each_cell(survey.positions(), rows, MIN_APART);
        let places: Vec<[f32; 3]> = rows.iter().map(|&row| survey.positions()[row]).collect();
        let index = NeighborIndex::new(&places, control)?;
        let fills = |number: usize| {
            let (p, row) = (places[number], rows[number]);
            let radius = self.radius_spacings * survey.spacing[row];
            let mut near = Vec::new();
            index.within_radius(p, FARTHEST_APART_SPACINGS * survey.spacing[row], |found| {
                let q = places[found.index as usize];
                if q != p && (q[2] - p[2]).abs() < SAME_LEVEL {
                    near.push(q);
                }
            });
            let between = |other: usize| {
                let q: [f32; 3] = near[other];
                let center = [(p[0] + q[0]) / 2.0, (p[1] + q[1]) / 2.0, (p[2] + q[2]) / 2.0 - radius];
                let place = FillPlace::Center(center);
                Fill { row, place, max_radius: radius, min_radius: MIN_SHARE * radius }
            };
            neighbors_after(p, &near, MIN_APART, CLEAR_SHARE).map(between).collect::<Vec<_>>()
        };
        let numbers = (0..rows.len()).into_par_iter().with_min_len(CHUNK);
        let found = numbers.filter(|_| !stop.is_set()).flat_map_iter(fills).collect();
        stop.check()?;
        Ok(found)
    }
}

/// Flags the voxels that a pulse passes below at these `depths`. `is_roof` tells whether points lie around the place
/// straight above, `is_open` whether none stand beside it below the height given.
fn run_below(
    layers: &Layers,
    beside: &[usize],
    free_segments: &FreeSegments,
    depths: [f32; 2],
    is_roof: impl Fn([f32; 3]) -> bool + Sync,
    is_open: impl Fn([f32; 3], f32) -> bool + Sync,
    control: &Control<'_>,
) -> Result<Vec<bool>> {
    let proven: Vec<AtomicBool> = beside.iter().map(|_| AtomicBool::new(false)).collect();
    let top = layers.top();
    (0..free_segments.len()).into_par_iter().with_min_len(CHUNK).try_for_each(|number| {
        if number % CHECK_EACH == 0 {
            control.check()?;
        }
        let Some((start, up, length)) = free_segments.segment(number) else { return Ok(()) };
        layers.walk(start, up, length, |column, [from, to]| {
            let low: [f32; 3] = std::array::from_fn(|axis| start[axis] + from * up[axis]);
            let high = start[2] + to * up[2];
            for voxel in column {
                let bottom = layers.bottom(voxel);
                // that a voxel is proven already only saves time: the outcome is the same
                if beside[voxel] >= MIN_BESIDE
                    && bottom - low[2] >= depths[0]
                    && bottom - high <= depths[1]
                    && !proven[voxel].load(Ordering::Relaxed)
                    && is_roof([low[0], low[1], layers.middle(voxel)])
                    && is_open(low, bottom)
                {
                    proven[voxel].store(true, Ordering::Relaxed);
                }
            }
            low[2] < top
        });
        Ok(())
    })?;
    Ok(proven.into_iter().map(AtomicBool::into_inner).collect())
}

/// The widest angle between neighbours about a place, seen from above.
pub(super) struct Gap {
    /// Radians; a whole turn for fewer than two points.
    pub(super) width: f32,
    /// Azimuth of its middle, radians, counter-clockwise from east.
    pub(super) middle: f32,
    /// Number of points about the place, at most 65 535.
    pub(super) count: u16,
}

/// The widest gap between those points within `radius` of `at` whose row is `wanted`.
pub(super) fn widest_gap(
    positions: &[[f32; 3]],
    index: &NeighborIndex,
    at: [f32; 3],
    radius: f32,
    wanted: impl Fn(usize) -> bool,
) -> Gap {
    let mut angles: Vec<f32> = Vec::new();
    index.within_radius(at, radius, |found| {
        let row = found.index as usize;
        if wanted(row) {
            angles.push((positions[row][1] - at[1]).atan2(positions[row][0] - at[0]));
        }
    });
    angles.sort_unstable_by(f32::total_cmp);
    let count = u16::try_from(angles.len()).unwrap_or(u16::MAX);
    let (Some(&first), Some(&last)) = (angles.first(), angles.last()) else {
        return Gap { width: TAU, middle: 0.0, count };
    };
    let gap = |from: f32, to: f32| (to - from, (from + to) / 2.0);
    let wider = |a: (f32, f32), b: (f32, f32)| if b.0 > a.0 { b } else { a };
    let (width, middle) = angles.windows(2).map(|pair| gap(pair[0], pair[1])).fold(gap(last, first + TAU), wider);
    Gap { width, middle, count }
}

/// Flags the voxels of surfaces of which enough is proven. Surfaces end at blocks, so that every part of a survey that
/// holds a block finds the same. Blocks are laid four times, moved by half their side: a surface up to that wide lies
/// in one of them.
fn surfaces(layers: &Layers, beside: &[usize], proven: &[bool], min_proof: f32) -> Vec<bool> {
    let offsets = [[0, 0], [1, 0], [0, 1], [1, 1]];
    let blocks = offsets.map(|offset| move |voxel: usize| layers.block(voxel, offset));
    let found = blocks.par_iter().map(|block| surfaces_in_blocks(layers, beside, proven, min_proof, block));
    let either = |a: Vec<bool>, b: Vec<bool>| a.into_iter().zip(b).map(|(a, b)| a || b).collect();
    found.reduce_with(either).unwrap_or_default()
}

/// [`surfaces`] for one partition into blocks. A surface is a connected set of voxels that go on to all sides or are
/// proven, with the voxels beside them.
fn surfaces_in_blocks(
    layers: &Layers,
    beside: &[usize],
    proven: &[bool],
    min_proof: f32,
    block: impl Fn(usize) -> [i64; 2],
) -> Vec<bool> {
    let mut seen = vec![false; layers.len()];
    let mut thin = vec![false; layers.len()];
    let mut surface = Vec::new();
    for first in (0..layers.len()).filter(|&voxel| proven[voxel]) {
        if seen[first] {
            continue;
        }
        seen[first] = true;
        surface.clear();
        surface.push(first);
        let mut next = 0;
        while let Some(&voxel) = surface.get(next) {
            next += 1;
            layers.adjoining(voxel, |other| {
                if (beside[other] == 8 || proven[other]) && !seen[other] && block(other) == block(first) {
                    seen[other] = true;
                    surface.push(other);
                }
            });
        }
        let count = surface.iter().filter(|&&voxel| proven[voxel]).count();
        if count as f64 >= f64::from(min_proof) * (surface.len() as f64).sqrt() {
            for &voxel in &surface {
                layers.visit_around(voxel, |other| thin[other] |= block(other) == block(first));
            }
        }
    }
    thin
}
