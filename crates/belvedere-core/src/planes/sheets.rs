//! Upright sheets of roofs: parapets, the inside of buildings, steps between roofs, and sides of objects on roofs.

use super::block::Block;
use super::boxes::{self, BoxParams};
use super::cell_runs::RowRuns;
use super::edges::{EdgeLine, Outline};
use super::fit::Plane;
use super::line::PlanLine;
use super::parapets::{self, ParapetParams};
use super::patches::{Patch, Sheet};
use super::roof_planes::Roofs;
use super::steps::{self, StepParams};
use super::walls::WallLine;
use belvedere_data::patches::PatchKind;

/// Parameters of upright sheets.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct SheetParams {
    pub(super) inside: InsideParams,
    pub(super) steps: StepParams,
    pub(super) boxes: BoxParams,
}

/// Parameters of sheets within buildings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct InsideParams {
    /// Width of the solid part of a building inside the edge of a roof, metres. Default 0.5.
    pub(super) width: f64,
    /// Minimum height of such an edge above the surface below it, metres. Default 2.
    pub(super) min_drop: f64,
    /// Minimum share of such edges of a roof that have a wall below them. Default 0.5: canopies and decks have none.
    pub(super) min_walled: f64,
    /// Minimum depth of such a wall below its edge, metres. Default 1: sides of slabs and canopies are lower.
    pub(super) min_wall_depth: f64,
    /// Minimum distance from both ends of a sheet of a pulse that contradicts it, metres. Default 0.3.
    pub(super) clear: f64,
    /// Length of the pieces of an edge that are open or closed, metres. Default 1.
    pub(super) piece: f64,
}

impl Default for InsideParams {
    fn default() -> Self {
        Self { width: 0.5, min_drop: 2.0, min_walled: 0.5, min_wall_depth: 1.0, clear: 0.3, piece: 1.0 }
    }
}

/// The sheets of all roofs.
pub(super) fn patches(
    block: &Block,
    roofs: &Roofs,
    outlines: &[Outline],
    walls: &[WallLine],
    params: &SheetParams,
    parapets: &ParapetParams,
) -> Vec<Patch> {
    let of_roof = |(plane, outline): (usize, &Outline)| {
        let roof = &roofs.planes[plane];
        let own: Vec<&WallLine> = walls.iter().filter(|wall| wall.plane == plane).collect();
        let is_walled = is_walled(outline, &own, &params.inside);
        let mut found = Vec::new();
        for (number, edge) in outline.edges.iter().enumerate().filter(|(_, edge)| edge.is_sure) {
            found.extend(parapets::faces(block, &roof.plane, &edge.line, &edge.parapet));
            if edge.drop >= params.inside.min_drop && is_walled {
                let eaves = own.iter().find(|wall| wall.edge == number).map_or(0.0, |wall| wall.eaves);
                let InsideParams { width, clear, .. } = params.inside;
                let line = PlanLine { point: edge.line.at(0.0, -width.max(eaves + clear)), ..edge.line };
                let line = PlanLine { ends: [line.ends[0] + width, line.ends[1] - width], ..line };
                found.extend(inner_sheet(block, &roof.plane, &line, edge.drop, &params.inside));
            }
        }
        found.extend(steps::patches(block, roofs, plane, outline, &params.steps));
        found.extend(boxes::patches(block, roof, outline, &params.boxes, parapets));
        found
    };
    outlines.iter().enumerate().flat_map(of_roof).collect()
}

/// Returns true if walls, given those below the roof, stand below enough of its high edges.
pub(super) fn is_walled(outline: &Outline, own: &[&WallLine], params: &InsideParams) -> bool {
    let high = |edge: &&EdgeLine| edge.is_sure && edge.drop >= params.min_drop;
    let all: f64 = outline.edges.iter().filter(high).map(|edge| edge.line.length()).sum();
    let is_high = |wall: &&&WallLine| high(&&outline.edges[wall.edge]) && wall.depth >= params.min_wall_depth;
    let walled: f64 = own.iter().filter(is_high).map(|wall| wall.line.length()).sum();
    walled >= params.min_walled * all
}

/// Returns the pieces of an upright sheet within an edge that no pulse runs through.
fn inner_sheet(block: &Block, top: &Plane, line: &PlanLine, drop: f64, params: &InsideParams) -> Vec<Patch> {
    let (piece, clear) = (params.piece, params.clear);
    if line.length() < piece {
        return Vec::new();
    }
    let pieces = line.pieces(piece);
    let ends = line.end_points();
    let heights = ends.map(|p| top.height(p));
    let shift = block.max_shift(heights[0].max(heights[1]));
    let low = [0, 1].map(|axis| ends[0][axis].min(ends[1][axis]) - shift);
    let high = [0, 1].map(|axis| ends[0][axis].max(ends[1][axis]) + shift);
    let bottom = heights[0].min(heights[1]) - drop;
    let mut is_open = vec![false; pieces.count];
    block.each_in(low, high, |_, pulse| {
        let [_, d] = line.of([pulse.p[0], pulse.p[1]]);
        let outward = line.outward();
        let up = -d / (pulse.lean[0] * outward[0] + pulse.lean[1] * outward[1]);
        // it runs through above its return
        if !(pulse.is_first && up > clear && up.is_finite()) {
            return;
        }
        let at = [pulse.p[0] + up * pulse.lean[0], pulse.p[1] + up * pulse.lean[1]];
        let z = pulse.p[2] + up;
        let [t, _] = line.of(at);
        if (line.ends[0]..line.ends[1]).contains(&t) && z > bottom + clear && z < top.height(at) - clear {
            let piece = pieces.number(t);
            is_open[piece.saturating_sub(1)..(piece + 2).min(pieces.count)].fill(true);
        }
    });
    let runs = RowRuns::new(0, (0..pieces.count).filter(|&piece| !is_open[piece])).runs;
    let sheet = |run: [usize; 2]| {
        let heights = [bottom, heights[0].max(heights[1])];
        let sheet = Sheet { line, ranges: run.map(|piece| pieces.start(piece)), heights, kind: PatchKind::Inside };
        sheet.patches(block, |p| top.height(p), |_| bottom)
    };
    runs.into_iter().flat_map(sheet).collect()
}
