//! Upright sheets: parapets, steps between roofs, objects on roofs, and the inside of buildings.

use super::block::Block;
use super::edges::{EdgeLine, Outline, Parapet, Standing};
use super::line::{PlanLine, area, clip};
use super::patches::fan;
use super::roof_planes::{NONE, Roof, Roofs};
use super::walls::WallLine;
use super::{BLOCK, BuildingSurfaces, PatchKind};
use std::cmp::Ordering;

/// Smallest piece of a sheet, m².
const MIN_AREA: f64 = 0.005;
/// Width of the solid part of a building inside the edge of a roof, metres.
const WITHIN: f64 = 0.5;
/// Minimum height of such an edge above the surface below it, metres.
const MIN_DROP: f64 = 2.0;
/// Minimum share of such edges of a roof that have a wall below them: canopies and decks have none.
const MIN_WALLED: f64 = 0.5;
/// Minimum depth of such a wall below its edge, metres: sides of slabs and canopies are lower.
const MIN_WALL_DEPTH: f64 = 1.0;
/// Minimum distance from both ends of an upright sheet of a pulse that contradicts it, metres.
const CLEAR: f64 = 0.3;
/// Heights of the points of parapets above the roof, metres.
const PARAPET: [f64; 2] = [0.15, 1.6];
/// Maximum distance of its points inside and outside the edge, metres.
const PARAPET_WITHIN: f64 = 0.6;
const PARAPET_WITHOUT: f64 = 0.25;
/// Half the difference of their heights, metres.
const PARAPET_LEVEL: f64 = 0.06;
/// Length of the pieces of an edge that they must be on, metres, and the least share of these.
const PARAPET_PIECE: f64 = 0.8;
const PARAPET_SHARE: f64 = 0.55;
/// Minimum and maximum height of a step between roofs, metres: balconies lie farther below each other.
const STEP: [f64; 2] = [0.25, 1.8];
/// Maximum height of a step all round onto one roof, metres: of an object on it.
const MAX_BOX_STEP: f64 = 3.5;
/// Minimum share of the pulses that pass an edge which end on the roof below, and their minimum number.
const STEP_SHARE: f64 = 0.6;
const STEP_PULSES: usize = 3;
/// Distance of the pulses beyond an edge, spacings.
const STEP_SPACINGS: f64 = 2.5;
/// Minimum height of an object on a roof, metres, its minimum number of points, and its longest side, metres.
const BOX_HEIGHT: f64 = 0.25;
const BOX_POINTS: usize = 3;
const BOX_SIDE: f64 = 4.0;
/// Half of its points at least lie so near to the height of its top, metres: those of a wall do not.
const BOX_LEVEL: f64 = 0.15;
/// Minimum share of the pulses over it that it stopped.
const BOX_DENSITY: f64 = 0.4;
/// Maximum depth below the foot of a box at which pulses that pass it may end, metres: deeper ones pass the roof, too.
const BELOW_ROOF: f64 = 1.0;
/// Maximum distance between its points, spacings.
const BOX_SPACINGS: f64 = 1.3;

/// An upright rectangle on a line.
pub(super) struct Sheet<'a> {
    pub(super) line: &'a PlanLine,
    pub(super) ranges: [f64; 2],
    pub(super) heights: [f64; 2],
    pub(super) kind: PatchKind,
}

impl Sheet<'_> {
    /// Adds it as far as it lies below and above two heights, linear in plan, and in the block.
    pub(super) fn append_to(
        &self,
        block: &Block,
        below: impl Fn([f64; 2]) -> f64,
        above: impl Fn([f64; 2]) -> f64,
        found: &mut BuildingSurfaces,
    ) {
        let ([t0, t1], [z0, z1], line) = (self.ranges, self.heights, self.line);
        if !(t0 < t1 && z0 < z1) {
            return;
        }
        let mut polygon = vec![[t0, z0], [t1, z0], [t1, z1], [t0, z1]];
        polygon = clip(&polygon, |[t, z]| z - below(line.at(t, 0.0)));
        polygon = clip(&polygon, |[t, z]| above(line.at(t, 0.0)) - z);
        for axis in 0..2 {
            polygon = clip(&polygon, |[t, _]| -line.at(t, 0.0)[axis]);
            polygon = clip(&polygon, |[t, _]| line.at(t, 0.0)[axis] - BLOCK);
        }
        if area(&polygon) < MIN_AREA {
            return;
        }
        let corner = |&[t, z]: &[f64; 2]| {
            let [x, y] = line.at(t, 0.0);
            [x, y, z]
        };
        let corners: Vec<[f64; 3]> = polygon.iter().map(corner).collect();
        fan(block, &corners, self.kind, found);
    }
}

/// Gives out the sheets of all roofs.
pub(super) fn append_to(
    block: &Block,
    roofs: &Roofs,
    outlines: &[Outline],
    walls: &[WallLine],
    found: &mut BuildingSurfaces,
) {
    for (plane, outline) in outlines.iter().enumerate() {
        let own: Vec<&WallLine> = walls.iter().filter(|wall| wall.plane == plane).collect();
        let is_walled = is_walled(outline, &own);
        for (number, edge) in outline.edges.iter().enumerate().filter(|(_, edge)| edge.is_sure) {
            upstand(block, roofs, plane, edge, found);
            if edge.drop >= MIN_DROP && is_walled {
                let eaves = own.iter().find(|wall| wall.edge == number).map_or(0.0, |wall| wall.eaves);
                let line = PlanLine { point: edge.line.at(0.0, -WITHIN.max(eaves + CLEAR)), ..edge.line };
                let line = PlanLine { ends: [line.ends[0] + WITHIN, line.ends[1] - WITHIN], ..line };
                add_inner_sheet(block, roofs, plane, &line, edge.drop, found);
            }
        }
        steps(block, roofs, plane, outline, found);
        boxes(block, roofs, plane, outline, found);
    }
}

/// Returns true if walls, given those below the roof, stand below enough of its high edges.
pub(super) fn is_walled(outline: &Outline, own: &[&WallLine]) -> bool {
    let high = |edge: &&EdgeLine| edge.is_sure && edge.drop >= MIN_DROP;
    let all: f64 = outline.edges.iter().filter(high).map(|edge| edge.line.length()).sum();
    let is_high = |wall: &&&WallLine| high(&&outline.edges[wall.edge]) && wall.depth >= MIN_WALL_DEPTH;
    let walled: f64 = own.iter().filter(is_high).map(|wall| wall.line.length()).sum();
    walled >= MIN_WALLED * all
}

/// Pieces of so many metres that a length is cut into, and their length.
fn pieces(length: f64, of: f64) -> (usize, f64) {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "metres of an edge, and saturating")]
    let count = ((length / of).ceil().max(1.0) as usize).min(10_000);
    (count, length / count as f64)
}

/// Number of the piece of a range.
fn piece_at(range: f64, step: f64, count: usize) -> usize {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the edge, and saturating")]
    let piece = ((range / step).max(0.0) as usize).min(count - 1);
    piece
}

/// The points that stand along an edge at one height; none where there are too few.
pub(super) fn parapet(outline: &Outline, line: &PlanLine) -> Parapet {
    // height above the roof, range, distance from the edge
    let mut on: Vec<[f64; 3]> = Vec::new();
    for standing in &outline.standing {
        let [t, d] = line.of(standing.p);
        let is_beside = (-PARAPET_WITHIN..=PARAPET_WITHOUT).contains(&d) && (line.ends[0]..=line.ends[1]).contains(&t);
        if is_beside && (PARAPET[0]..=PARAPET[1]).contains(&standing.above) {
            on.push([standing.above, t - line.ends[0], d]);
        }
    }
    on.sort_unstable_by(|a, b| (0..3).fold(Ordering::Equal, |order, i| order.then(a[i].total_cmp(&b[i]))));
    let (mut best, mut last) = ((0, 0), 0);
    for first in 0..on.len() {
        while last < on.len() && on[last][0] <= on[first][0] + 2.0 * PARAPET_LEVEL {
            last += 1;
        }
        if last - first > best.1 - best.0 {
            best = (first, last);
        }
    }
    let on = &on[best.0..best.1];
    let (count, step) = pieces(line.length(), PARAPET_PIECE);
    let mut holds = vec![false; count];
    for &[_, t, _] in on {
        holds[piece_at(t, step, count)] = true;
    }
    let held = holds.iter().filter(|&&holds| holds).count();
    if held < 2 || (held as f64) < PARAPET_SHARE * count as f64 {
        return Parapet::default();
    }
    // how far right of the edge, and whether it is on top
    let mut across: Vec<(f64, bool)> = on.iter().map(|p| (p[2], true)).collect();
    across.extend(outline.inside[..outline.own].iter().filter_map(|&p| {
        let [t, d] = line.of(p);
        let is_beside = (-PARAPET_WITHIN..=0.0).contains(&d) && (line.ends[0]..=line.ends[1]).contains(&t);
        is_beside.then_some((d, false))
    }));
    Parapet { height: on[on.len() / 2][0], width: -inner_face(across) }
}

/// Returns the position of the inner face of a parapet, metres to the right of its edge. It minimises the number of
/// points of its top to the left, and of the roof to the right.
fn inner_face(mut across: Vec<(f64, bool)>) -> f64 {
    across.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let mut wrong = across.iter().filter(|point| !point.1).count();
    let (mut least, mut face) = (wrong, -PARAPET_WITHIN);
    for (number, &(d, is_on_top)) in across.iter().enumerate() {
        wrong = if is_on_top { wrong + 1 } else { wrong - 1 };
        if wrong < least {
            let next = across.get(number + 1).map_or(0.0, |point| point.0);
            (least, face) = (wrong, f64::midpoint(d, next));
        }
    }
    face.min(0.0)
}

/// Adds both faces of the parapet of an edge.
fn upstand(block: &Block, roofs: &Roofs, plane: usize, edge: &EdgeLine, found: &mut BuildingSurfaces) {
    let roof = &roofs.planes[plane].plane;
    let rise = edge.parapet.height / roof.normal[2];
    let inner = edge.line.moved(-edge.parapet.width).turned();
    for line in [&edge.line, &inner] {
        let ends = line.end_points().map(|p| roof.height(p));
        let heights = [ends[0].min(ends[1]), ends[0].max(ends[1]) + rise];
        let sheet = Sheet { line, ranges: line.ends, heights, kind: PatchKind::Parapet };
        sheet.append_to(block, |p| roof.height(p) + rise, |p| roof.height(p), found);
    }
}

/// The plane that most pulses end on which pass an edge close to it.
fn find_lower_roof(roofs: &Roofs, plane: usize, outline: &Outline, line: &PlanLine) -> Option<usize> {
    let reach = STEP_SPACINGS * roofs.planes[plane].spacing;
    let mut on: Vec<u32> = Vec::new();
    for passed in &outline.passed {
        let [t, d] = line.of(passed.p);
        if (line.ends[0]..=line.ends[1]).contains(&t) && (-0.1..=reach).contains(&d) {
            on.push(passed.on);
        }
    }
    on.sort_unstable();
    let most = on.chunk_by(|a, b| a == b).filter(|same| same[0] != NONE).max_by_key(|same| (same.len(), same[0]))?;
    (most.len() >= STEP_PULSES && most.len() as f64 >= STEP_SHARE * on.len() as f64).then_some(most[0] as usize)
}

/// Adds sheets from the edges of a roof down to roofs close below them, and down to the roof that it stands on.
fn steps(block: &Block, roofs: &Roofs, plane: usize, outline: &Outline, found: &mut BuildingSurfaces) {
    let steps: Vec<(&EdgeLine, usize)> = outline
        .edges
        .iter()
        .filter(|edge| edge.is_sure && (STEP[0]..=MAX_BOX_STEP).contains(&edge.drop))
        .filter_map(|edge| Some((edge, find_lower_roof(roofs, plane, outline, &edge.line)?)))
        .collect();
    let all: f64 = outline.edges.iter().filter(|edge| edge.is_sure).map(|edge| edge.line.length()).sum();
    for &(edge, lower) in &steps {
        let onto: f64 = steps.iter().filter(|step| step.1 == lower).map(|step| step.0.line.length()).sum();
        if edge.drop > STEP[1] && onto < STEP_SHARE * all {
            continue;
        }
        let (line, roof, below) = (&edge.line, &roofs.planes[plane].plane, &roofs.planes[lower].plane);
        let ends = line.end_points().map(|p| [below.height(p), roof.height(p)]);
        let heights = [ends[0][0].min(ends[1][0]), ends[0][1].max(ends[1][1])];
        let sheet = Sheet { line, ranges: line.ends, heights, kind: PatchKind::Step };
        sheet.append_to(block, |p| roof.height(p), |p| below.height(p), found);
    }
}

/// Adds the pieces of an upright sheet within an edge that no pulse runs through.
fn add_inner_sheet(
    block: &Block,
    roofs: &Roofs,
    plane: usize,
    line: &PlanLine,
    drop: f64,
    found: &mut BuildingSurfaces,
) {
    if line.length() < 1.0 {
        return;
    }
    let (count, step) = pieces(line.length(), 1.0);
    let top = &roofs.planes[plane].plane;
    let ends = line.end_points();
    let heights = ends.map(|p| top.height(p));
    let shift = block.max_shift(heights[0].max(heights[1]));
    let low = [0, 1].map(|axis| ends[0][axis].min(ends[1][axis]) - shift);
    let high = [0, 1].map(|axis| ends[0][axis].max(ends[1][axis]) + shift);
    let bottom = heights[0].min(heights[1]) - drop;
    let mut is_open = vec![false; count];
    block.each_in(low, high, |_, pulse| {
        let [_, d] = line.of([pulse.p[0], pulse.p[1]]);
        let outward = line.outward();
        let up = -d / (pulse.lean[0] * outward[0] + pulse.lean[1] * outward[1]);
        // it runs through above its return
        if !(pulse.is_first && up > CLEAR && up.is_finite()) {
            return;
        }
        let at = [pulse.p[0] + up * pulse.lean[0], pulse.p[1] + up * pulse.lean[1]];
        let z = pulse.p[2] + up;
        let [t, _] = line.of(at);
        if (line.ends[0]..line.ends[1]).contains(&t) && z > bottom + CLEAR && z < top.height(at) - CLEAR {
            let piece = piece_at(t - line.ends[0], step, count);
            is_open[piece.saturating_sub(1)..(piece + 2).min(count)].fill(true);
        }
    });
    let mut first = None;
    for (piece, is_open) in is_open.into_iter().chain([true]).enumerate() {
        let goes_on = !is_open;
        match (first, goes_on) {
            (None, true) => first = Some(piece),
            (Some(from), false) => {
                let ranges = [from, piece].map(|piece| line.ends[0] + piece as f64 * step);
                let heights = [bottom, heights[0].max(heights[1])];
                let sheet = Sheet { line, ranges, heights, kind: PatchKind::Inside };
                sheet.append_to(block, |p| top.height(p), |_| bottom, found);
                first = None;
            }
            _ => {}
        }
    }
}

/// Returns true if a point lies on a parapet.
fn is_of_parapet(outline: &Outline, standing: &Standing) -> bool {
    outline.edges.iter().filter(|edge| edge.is_sure && edge.parapet.height > 0.0).any(|edge| {
        let [t, d] = edge.line.of(standing.p);
        (edge.line.ends[0]..=edge.line.ends[1]).contains(&t)
            && (-edge.parapet.width - PARAPET_LEVEL..=PARAPET_WITHOUT).contains(&d)
            && standing.above <= edge.parapet.height + PARAPET_LEVEL
    })
}

/// Returns the places where pulses pass a box, in its frame: at the height of its top, and at their ends. A pulse that
/// meets the roof beside the box bounds its foot, and one that slants past it its top.
fn past_box(block: &Block, roof: &Roof, frame: &PlanLine, [low, high]: [[f64; 2]; 2], top: f64) -> Vec<[f64; 2]> {
    let corners = [low, [low[0], high[1]], high, [high[0], low[1]]].map(|[t, d]| frame.at(t, d));
    let foot = corners.iter().map(|&p| roof.plane.height(p)).fold(f64::INFINITY, f64::min);
    let lowest = foot - BELOW_ROOF;
    let reach = roof.spacing + block.max_lean * (top - lowest).max(0.0);
    let lows = [0, 1].map(|axis| corners.iter().map(|p| p[axis]).fold(f64::INFINITY, f64::min) - reach);
    let highs = [0, 1].map(|axis| corners.iter().map(|p| p[axis]).fold(f64::NEG_INFINITY, f64::max) + reach);
    let mut past = Vec::new();
    block.each_in(lows, highs, |_, found| {
        let rise = top - found.p[2];
        if found.is_first && rise > BOX_LEVEL && found.p[2] > lowest {
            let at_top = [0, 1].map(|axis| found.p[axis] + rise * found.lean[axis]);
            let places = [at_top, [found.p[0], found.p[1]]];
            past.extend(places.into_iter().filter(|p| p.iter().all(|v| v.is_finite())).map(|p| frame.of(p)));
        }
    });
    past
}

/// Adds the sides of objects on a roof that are too small for a plane: chimneys and the like.
fn boxes(block: &Block, roofs: &Roofs, plane: usize, outline: &Outline, found: &mut BuildingSurfaces) {
    let roof = &roofs.planes[plane];
    let is_wanted =
        |standing: &&Standing| standing.is_loose && standing.above >= BOX_HEIGHT && !is_of_parapet(outline, standing);
    let loose: Vec<&Standing> = outline.standing.iter().filter(is_wanted).collect();
    let longest =
        outline.edges.iter().filter(|edge| edge.is_sure).max_by(|a, b| a.line.length().total_cmp(&b.line.length()));
    let along = longest.map_or([1.0, 0.0], |edge| edge.line.along);
    let mut is_used = vec![false; loose.len()];
    for first in 0..loose.len() {
        if is_used[first] {
            continue;
        }
        is_used[first] = true;
        let mut of_box = vec![first];
        let mut next = 0;
        while let Some(&row) = of_box.get(next) {
            next += 1;
            for other in 0..loose.len() {
                let [x, y] = [0, 1].map(|axis| loose[other].p[axis] - loose[row].p[axis]);
                if !is_used[other] && x.hypot(y) <= BOX_SPACINGS * roof.spacing {
                    is_used[other] = true;
                    of_box.push(other);
                }
            }
        }
        if of_box.len() < BOX_POINTS {
            continue;
        }
        let frame = PlanLine { point: loose[first].p, along, ends: [0.0; 2] };
        let places: Vec<[f64; 2]> = of_box.iter().map(|&row| frame.of(loose[row].p)).collect();
        let mut low = [0, 1].map(|axis| places.iter().map(|p| p[axis]).fold(f64::INFINITY, f64::min));
        let mut high = [0, 1].map(|axis| places.iter().map(|p| p[axis]).fold(f64::NEG_INFINITY, f64::max));
        if (0..2).any(|axis| high[axis] - low[axis] > BOX_SIDE) {
            continue;
        }
        // tops are level, whatever the slope of the roof
        let mut heights: Vec<f64> = of_box.iter().map(|&row| loose[row].height).collect();
        heights.sort_unstable_by(f64::total_cmp);
        let top = heights[heights.len() * 3 / 4];
        let on_level = heights.iter().filter(|&height| (height - top).abs() <= BOX_LEVEL).count();
        let area = (high[0] - low[0]) * (high[1] - low[1]);
        if 2 * on_level < heights.len() || (of_box.len() as f64) < BOX_DENSITY * area / roof.spacing.powi(2) {
            continue;
        }
        // as far as pulses that pass it leave room
        let past = past_box(block, roof, &frame, [low, high], top);
        for axis in 0..2 {
            let wider = ((high[axis] - low[axis]) / (of_box.len() - 1) as f64).min(roof.spacing / 2.0);
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
        let corners = [[low[0], low[1]], [low[0], high[1]], [high[0], high[1]], [high[0], low[1]]];
        for (number, &[t, d]) in corners.iter().enumerate() {
            let [u, e] = corners[(number + 1) % 4];
            let (from, to) = (frame.at(t, d), frame.at(u, e));
            let length = (to[0] - from[0]).hypot(to[1] - from[1]);
            if length < 0.05 {
                continue;
            }
            let along = [0, 1].map(|axis| (to[axis] - from[axis]) / length);
            let line = PlanLine { point: from, along, ends: [0.0, length] };
            let ends = [from, to].map(|p| roof.plane.height(p));
            let heights = [ends[0].min(ends[1]), top];
            let sheet = Sheet { line: &line, ranges: line.ends, heights, kind: PatchKind::Box };
            sheet.append_to(block, |_| top, |p| roof.plane.height(p), found);
        }
    }
}
