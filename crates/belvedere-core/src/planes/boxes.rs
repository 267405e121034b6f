//! Boxes: objects on a roof that are too small for a plane, chimneys and the like.

use super::block::Block;
use super::edges::Outline;
use super::line::PlanLine;
use super::parapets::ParapetParams;
use super::patches::{Patch, Sheet};
use super::roof_planes::Roof;
use super::samples::Standing;
use belvedere_data::patches::PatchKind;

/// Parameters of boxes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct BoxParams {
    /// Minimum height of an object above its roof, metres. Default 0.25.
    pub(super) min_height: f64,
    /// Minimum number of its points. Default 3.
    pub(super) min_points: usize,
    /// Maximum length of its sides, metres. Default 4.
    pub(super) max_side: f64,
    /// Maximum distance from the height of its top of half of its points, metres. Default 0.15: those of a wall lie
    /// farther.
    pub(super) level: f64,
    /// Minimum share of the pulses over it that it stopped. Default 0.4.
    pub(super) min_density: f64,
    /// Maximum depth below its foot at which pulses that pass it may end, metres. Default 1: deeper ones pass the roof,
    /// too.
    pub(super) below_roof: f64,
    /// Maximum distance between its points, spacings. Default 1.3.
    pub(super) gap_spacings: f64,
}

impl Default for BoxParams {
    fn default() -> Self {
        Self {
            min_height: 0.25,
            min_points: 3,
            max_side: 4.0,
            level: 0.15,
            min_density: 0.4,
            below_roof: 1.0,
            gap_spacings: 1.3,
        }
    }
}

/// A box with a level top.
struct RoofBox {
    /// Line along the roof. Corners are ranges along it and distances to its right.
    frame: PlanLine,
    low: [f64; 2],
    high: [f64; 2],
    /// Height of the top, metres.
    top: f64,
    /// Number of its points.
    count: usize,
}

/// Returns the sides of the boxes on a roof.
pub(super) fn patches(
    block: &Block,
    roof: &Roof,
    outline: &Outline,
    params: &BoxParams,
    parapets: &ParapetParams,
) -> Vec<Patch> {
    let is_wanted = |standing: &&Standing| {
        standing.is_loose && standing.above >= params.min_height && !is_of_parapet(outline, standing, parapets)
    };
    let loose: Vec<&Standing> = outline.samples.standing.iter().filter(is_wanted).collect();
    let longest = outline.sure_edges().max_by(|a, b| a.line.length().total_cmp(&b.line.length()));
    let along = longest.map_or([1.0, 0.0], |edge| edge.line.along);
    let groups = groups(&loose, params.gap_spacings * roof.spacing);
    let boxes = groups.iter().filter_map(|group| RoofBox::around(group, along, roof.spacing, params));
    boxes.flat_map(|found| found.widened(block, roof, params).sides(block, roof)).collect()
}

/// Returns true if a point lies on a parapet.
fn is_of_parapet(outline: &Outline, standing: &Standing, params: &ParapetParams) -> bool {
    outline.sure_edges().filter(|edge| edge.parapet.height > 0.0).any(|edge| {
        let [t, d] = edge.line.of(standing.p);
        (edge.line.ends[0]..=edge.line.ends[1]).contains(&t)
            && (-edge.parapet.width - params.level..=params.max_outside).contains(&d)
            && standing.above <= edge.parapet.height + params.level
    })
}

/// Groups of points of which each lies within `gap` of another one.
fn groups<'a>(points: &[&'a Standing], gap: f64) -> Vec<Vec<&'a Standing>> {
    let mut is_used = vec![false; points.len()];
    let mut groups = Vec::new();
    for (first, &seed) in points.iter().enumerate() {
        if is_used[first] {
            continue;
        }
        is_used[first] = true;
        let mut group = vec![seed];
        let mut next = 0;
        while let Some(&from) = group.get(next) {
            next += 1;
            for (other, &to) in points.iter().enumerate() {
                let [x, y] = [0, 1].map(|axis| to.p[axis] - from.p[axis]);
                if !is_used[other] && x.hypot(y) <= gap {
                    is_used[other] = true;
                    group.push(to);
                }
            }
        }
        groups.push(group);
    }
    groups
}

impl RoofBox {
    /// The box about points, if they are dense and most of them lie on a top that is level, whatever the slope of the
    /// roof.
    fn around(points: &[&Standing], along: [f64; 2], spacing: f64, params: &BoxParams) -> Option<Self> {
        if points.len() < params.min_points {
            return None;
        }
        let frame = PlanLine { point: points.first()?.p, along, ends: [0.0; 2] };
        let places: Vec<[f64; 2]> = points.iter().map(|point| frame.of(point.p)).collect();
        let low = [0, 1].map(|axis| places.iter().map(|p| p[axis]).fold(f64::INFINITY, f64::min));
        let high = [0, 1].map(|axis| places.iter().map(|p| p[axis]).fold(f64::NEG_INFINITY, f64::max));
        if (0..2).any(|axis| high[axis] - low[axis] > params.max_side) {
            return None;
        }
        let mut heights: Vec<f64> = points.iter().map(|point| point.height).collect();
        heights.sort_unstable_by(f64::total_cmp);
        let top = heights[heights.len() * 3 / 4];
        let on_level = heights.iter().filter(|&height| (height - top).abs() <= params.level).count();
        let area = (high[0] - low[0]) * (high[1] - low[1]);
        let is_dense = points.len() as f64 >= params.min_density * area / spacing.powi(2);
        (2 * on_level >= heights.len() && is_dense).then_some(Self { frame, low, high, top, count: points.len() })
    }

    /// The corners in plan.
    fn corners(&self) -> [[f64; 2]; 4] {
        let (low, high) = (self.low, self.high);
        [low, [low[0], high[1]], high, [high[0], low[1]]].map(|[t, d]| self.frame.at(t, d))
    }

    /// Returns the places where pulses pass it, in its frame: at the height of its top, and at their ends. A pulse that
    /// meets the roof beside the box bounds its foot, and one that slants past it its top.
    fn passing(&self, block: &Block, roof: &Roof, params: &BoxParams) -> Vec<[f64; 2]> {
        let (corners, top) = (self.corners(), self.top);
        let foot = corners.iter().map(|&p| roof.plane.height(p)).fold(f64::INFINITY, f64::min);
        let lowest = foot - params.below_roof;
        let reach = roof.spacing + block.max_lean * (top - lowest).max(0.0);
        let lows = [0, 1].map(|axis| corners.iter().map(|p| p[axis]).fold(f64::INFINITY, f64::min) - reach);
        let highs = [0, 1].map(|axis| corners.iter().map(|p| p[axis]).fold(f64::NEG_INFINITY, f64::max) + reach);
        let mut past = Vec::new();
        block.each_in(lows, highs, |_, found| {
            let rise = top - found.p[2];
            if found.is_first && rise > params.level && found.p[2] > lowest {
                let at_top = [0, 1].map(|axis| found.p[axis] + rise * found.lean[axis]);
                let places = [at_top, [found.p[0], found.p[1]]];
                let known = places.into_iter().filter(|p| p.iter().all(|v| v.is_finite()));
                past.extend(known.map(|p| self.frame.of(p)));
            }
        });
        past
    }

    /// The box as wide as pulses that pass it leave room.
    fn widened(mut self, block: &Block, roof: &Roof, params: &BoxParams) -> Self {
        let past = self.passing(block, roof, params);
        let (low, high) = (&mut self.low, &mut self.high);
        for axis in 0..2 {
            let wider = ((high[axis] - low[axis]) / (self.count - 1) as f64).min(roof.spacing / 2.0);
            let beside = 1 - axis;
            let (mut room_low, mut room_high) = (wider, wider);
            for q in past.iter().filter(|q| (low[beside]..=high[beside]).contains(&q[beside])) {
                if q[axis] <= low[axis] {
                    room_low = room_low.min((low[axis] - q[axis]) / 2.0);
                }
                if q[axis] >= high[axis] {
                    room_high = room_high.min((q[axis] - high[axis]) / 2.0);
                }
            }
            (low[axis], high[axis]) = (low[axis] - room_low, high[axis] + room_high);
        }
        self
    }

    /// Its sides.
    fn sides(&self, block: &Block, roof: &Roof) -> Vec<Patch> {
        let corners = self.corners();
        let side = |number: usize| {
            let (from, to) = (corners[number], corners[(number + 1) % 4]);
            let length = (to[0] - from[0]).hypot(to[1] - from[1]);
            if length < 0.05 {
                return Vec::new();
            }
            let along = [0, 1].map(|axis| (to[axis] - from[axis]) / length);
            let line = PlanLine { point: from, along, ends: [0.0, length] };
            let ends = [from, to].map(|p| roof.plane.height(p));
            let heights = [ends[0].min(ends[1]), self.top];
            let sheet = Sheet { line: &line, ranges: line.ends, heights, kind: PatchKind::Box };
            sheet.patches(block, |_| self.top, |p| roof.plane.height(p))
        };
        (0..4).flat_map(side).collect()
    }
}
