//! An elevation raster and the maxima of its blocks: exact horizons without a look at every cell.

use super::super::EarthParams;
use super::line::{FarLine, piece_over};
use belvedere_data::ElevationGrid;
use belvedere_data::cast::to_index;
use std::ops::ControlFlow;

/// Smallest step of a line in cells for each metre: a line along an axis is turned by less than its rounding, so that
/// no quotient is 0 / 0.
const MIN_SLOPE: f64 = 1e-14;

/// Terrain nearer to the first end of a line of sight than this does not block it, metres: the ground at the feet of an
/// eye that lies on it.
const FOOT: f64 = 0.1;

/// Part of the distance on both sides of a guess that is looked through first: a cell or two of usual rasters where
/// mountains are.
const NEAR: f64 = 0.003;

/// Halvings in which the place is found where terrain rises above a line: a patch of a kilometre becomes less than a
/// nanometre.
const HALVINGS: usize = 50;

/// Heights between the nodes of a raster, bilinear in each patch of four nodes, with the highest node of all blocks of
/// patches of 2, 4, 8, … a side.
#[derive(Debug)]
pub(super) struct TerrainHeights {
    grid: ElevationGrid,
    /// For blocks of 2, 4, 8, … patches a side; the last is one block.
    levels: Vec<HeightLevel>,
    /// The box on the map, local metres, within which terrain blocks nothing: that of the cloud, and a cell around it.
    within: [[f64; 2]; 2],
}

#[derive(Debug)]
struct HeightLevel {
    width: usize,
    /// The highest node of each block, −∞ where no patch of it is known.
    highest: Vec<f32>,
}

/// Places on the map with heights, from which lines leave alike: a box, or one place.
#[derive(Clone, Copy)]
pub(super) struct LineStarts {
    pub(super) low: [f64; 3],
    pub(super) high: [f64; 3],
}

/// Highest point of the terrain before a place.
#[derive(Clone, Copy)]
pub(super) struct Top {
    /// Tangent of its elevation.
    pub(super) tangent: f64,
    /// Its distance on the map, metres.
    pub(super) span: f64,
}

/// Distance on the map at which terrain hid most from the last place, metres, if it hid anything. It saves time for
/// neighbouring places and changes no result.
#[derive(Clone, Copy, Debug, Default)]
pub(in super::super) struct TerrainGuess(Option<f64>);

/// Lines from places in one direction on the map. Distances along them count from each place: there a line lies as far
/// from that of the middle as its place from the middle.
struct MapLines {
    /// The middle of the places in columns and rows of nodes, and their half size in both.
    start: [f64; 2],
    half: [f64; 2],
    /// Columns and rows for each metre, and the inverse.
    step: [f64; 2],
    inverse: [f64; 2],
    /// Distance that a line of another place than the middle needs more or less to the same column and row, metres at
    /// most.
    room: [f64; 2],
    /// The lowest height, metres.
    low: f64,
    /// Distances from which terrain counts for the first and for all of the places, metres.
    from: [f64; 2],
    /// Fall of the terrain for each square metre of squared distance, 1/m.
    fall: f64,
}

impl TerrainHeights {
    /// The terrain of `grid` beyond the box `cloud` on the map, local metres.
    pub(super) fn new(grid: ElevationGrid, cloud: Option<([f64; 2], [f64; 2])>) -> Self {
        let (width, height) = (grid.heights().width(), grid.heights().height());
        let patch = |column, row| {
            let corners = corners(&grid, column, row);
            if corners.iter().any(|v| v.is_nan()) {
                f32::NEG_INFINITY
            } else {
                corners.into_iter().fold(f32::NEG_INFINITY, f32::max)
            }
        };
        let mut levels = vec![HeightLevel::halved([width - 1, height - 1], patch)];
        while let Some(last) = levels.last().filter(|level| level.highest.len() > 1) {
            let size = [last.width, last.highest.len() / last.width];
            let next = HeightLevel::halved(size, |column, row| last.highest[row * last.width + column]);
            levels.push(next);
        }
        // between the last points of the cloud and the first whole patch beyond them neither says what stands there
        let room = grid.cell()[0].max(grid.cell()[1]);
        let within = cloud.map_or([[f64::NAN; 2]; 2], |(low, high)| [low.map(|v| v - room), high.map(|v| v + room)]);
        Self { grid, levels, within }
    }

    pub(super) fn grid(&self) -> &ElevationGrid {
        &self.grid
    }

    /// Returns the low and the high corner of the box on the map within which terrain blocks nothing, local metres.
    pub(super) fn within(&self) -> [[f64; 2]; 2] {
        self.within
    }

    /// The highest node of a patch without gaps; −∞ where there is none.
    pub(super) fn highest(&self) -> f32 {
        self.levels.last().and_then(|level| level.highest.first()).copied().unwrap_or(f32::NEG_INFINITY)
    }

    /// The highest terrain from a place in a direction on the map, a unit vector. Exact for the bilinear surface over
    /// the curved earth, whatever `guess` is: a distance where terrain may be high, which saves time if it is.
    pub(super) fn top(&self, place: [f64; 3], along: [f64; 2], earth: &EarthParams, guess: Option<f64>) -> Option<Top> {
        let lines = self.lines(&LineStarts { low: place, high: place }, along, earth);
        let mut top = Top { tangent: f64::NEG_INFINITY, span: f64::NAN };
        if let Some(span) = guess {
            self.raise(&lines, [span * (1.0 - NEAR), span * (1.0 + NEAR)], &mut top);
        }
        self.raise(&lines, [lines.from[0], f64::INFINITY], &mut top);
        (top.tangent > f64::NEG_INFINITY).then_some(top)
    }

    /// Raises `top` to the highest terrain on a line between two distances.
    fn raise(&self, lines: &MapLines, spans: [f64; 2], top: &mut Top) {
        let spans = [spans[0].max(lines.from[0]), spans[1]];
        let _ = self.descend(lines, spans, top, &mut |corners, place, spans, top| {
            if let Some(found) = lines.top_of_patch(corners, place, spans)
                && found.tangent > top.tangent
            {
                *top = found;
            }
            ControlFlow::Continue(())
        });
    }

    /// Returns true if terrain rises above the line from a place in a horizontal direction with the tangent of its
    /// elevation.
    pub(super) fn hides(&self, place: [f64; 3], along: [f64; 2], tangent: f64, earth: &EarthParams) -> bool {
        let lines = self.lines(&LineStarts { low: place, high: place }, along, earth);
        let mut limit = Top { tangent, span: 0.0 };
        let hit =
            self.descend(&lines, [lines.from[0], f64::INFINITY], &mut limit, &mut |corners, place, spans, limit| {
                match lines.top_of_patch(corners, place, spans) {
                    Some(found) if found.tangent > limit.tangent => ControlFlow::Break(()),
                    _ => ControlFlow::Continue(()),
                }
            });
        hit.is_break()
    }

    /// Returns true if terrain rises above a line of sight, apart from its ends.
    pub(super) fn blocks_sight(&self, line: &FarLine<'_>) -> bool {
        self.first_patch(line).is_some()
    }

    /// Returns the greatest tangent of an elevation between two, at which terrain rises above lines from the observer
    /// of `line` up to its target: the first of `tangents` where it does not rise above that.
    pub(super) fn highest_before(&self, line: &FarLine<'_>, tangents: [f64; 2], guess: &mut TerrainGuess) -> f64 {
        let FarLine { observer: from, along, earth, .. } = *line;
        let lines = self.lines(&LineStarts { low: from, high: from }, along, earth);
        let mut top = Top { tangent: tangents[0], span: f64::NAN };
        let raise = |spans: [f64; 2], top: &mut Top| {
            let _ = self.descend(&lines, spans, top, &mut |corners, patch, spans, top| {
                if let Some(found) = lines.top_of_patch(corners, patch, spans)
                    && found.tangent > top.tangent
                {
                    *top = found;
                }
                if top.tangent < tangents[1] { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
            });
        };
        let pieces = self.pieces_beyond_cloud(line);
        if let Some(last) = guess.0 {
            for piece in pieces {
                raise([piece[0].max(last * (1.0 - NEAR)), piece[1].min(last * (1.0 + NEAR))], &mut top);
            }
        }
        for piece in pieces {
            if top.tangent < tangents[1] && piece[0] < piece[1] {
                raise(piece, &mut top);
            }
        }
        *guess = TerrainGuess(Some(top.span).filter(|span| !span.is_nan()));
        top.tangent.min(tangents[1])
    }

    /// Distances of a line of sight, from and to, metres, before and behind the box of the cloud.
    fn pieces_beyond_cloud(&self, line: &FarLine<'_>) -> [[f64; 2]; 2] {
        let span = line.span;
        let [enter, leave] = piece_over(self.within, line.observer, line.along, span).unwrap_or([span; 2]);
        [[FOOT, enter], [leave.max(FOOT), span]]
    }

    /// Returns the horizontal distance from the observer, metres, at which terrain first rises above a line of sight;
    /// `None` if it does not.
    pub(super) fn meets_sight(&self, line: &FarLine<'_>) -> Option<f64> {
        let (patch, [from, _], top) = self.first_patch(line)?;
        let lines = self.lines(&LineStarts { low: line.observer, high: line.observer }, line.along, line.earth);
        let limit = line.tangent + rounding(line.tangent);
        let corners = corners(&self.grid, patch[0], patch[1]);
        // between the near side of the patch and its highest place the terrain comes through the line once
        let [mut below, mut above] = [from, top];
        for _ in 0..HALVINGS {
            let middle = f64::midpoint(below, above);
            let rises = lines.top_of_patch(corners, patch, [middle; 2]);
            if rises.is_some_and(|top| top.tangent > limit) { above = middle } else { below = middle }
        }
        Some(above)
    }

    /// Returns the first patch in which terrain rises above a line of sight: its column and row, the interval of
    /// distances of the line over it, and the distance of its highest place.
    fn first_patch(&self, line: &FarLine<'_>) -> Option<([usize; 2], [f64; 2], f64)> {
        let FarLine { observer: from, along, tangent, earth, .. } = *line;
        let lines = self.lines(&LineStarts { low: from, high: from }, along, earth);
        // a target on the surface is not hidden by what is rounded
        let mut limit = Top { tangent: tangent + rounding(tangent), span: 0.0 };
        let mut first = None;
        for spans in self.pieces_beyond_cloud(line) {
            if spans[0] < spans[1] && first.is_none() {
                let _ = self.descend(&lines, spans, &mut limit, &mut |corners, patch, spans, limit| match lines
                    .top_of_patch(corners, patch, spans)
                {
                    Some(found) if found.tangent > limit.tangent => {
                        first = Some((patch, spans, found.span));
                        ControlFlow::Break(())
                    }
                    _ => ControlFlow::Continue(()),
                });
            }
        }
        first
    }

    /// Returns true if terrain may rise above a line from any of these places. Never false if [`TerrainHeights::hides`]
    /// is true for one of them.
    pub(super) fn may_hide(&self, places: &LineStarts, along: [f64; 2], tangent: f64, earth: &EarthParams) -> bool {
        let lines = self.lines(places, along, earth);
        let mut limit = Top { tangent: tangent - rounding(tangent), span: 0.0 };
        // a patch is only reached if its highest corner, as near as it may be, rises above the lines
        let hit = self.descend(&lines, [lines.from[0], f64::INFINITY], &mut limit, &mut |corners, _, spans, limit| {
            let highest = corners.into_iter().fold(f32::NEG_INFINITY, f32::max);
            let rises = !corners.iter().any(|v| v.is_nan()) && lines.may_rise(highest, spans, limit.tangent);
            if rises { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        hit.is_break()
    }

    /// Returns true if terrain is known to rise above the lines from all of these places `span` metres away. Never true
    /// if [`TerrainHeights::hides`] is false for one of them.
    pub(super) fn hides_all(
        &self,
        places: &LineStarts,
        along: [f64; 2],
        tangent: f64,
        span: f64,
        earth: &EarthParams,
    ) -> bool {
        let lines = self.lines(places, along, earth);
        if !(span > lines.from[1]) {
            return false;
        }
        let line = places.high[2] + (tangent + rounding(tangent)) * span + lines.fall * span * span;
        let size = [self.grid.heights().width(), self.grid.heights().height()];
        let bounds = [0, 1].map(|axis| {
            let middle = lines.start[axis] + lines.step[axis] * span;
            // wider by more than what is rounded
            [middle - lines.half[axis] - 1e-6, middle + lines.half[axis] + 1e-6]
        });
        if (0..2).any(|axis| bounds[axis][0] < 0.0 || bounds[axis][1] >= (size[axis] - 1) as f64) {
            return false;
        }
        let [columns, rows] = bounds.map(|[from, to]| to_index(from)..=to_index(to) + 1);
        rows.into_iter().all(|row| {
            columns.clone().all(|column| self.grid.heights().get(column, row).is_some_and(|v| f64::from(v) > line))
        })
    }

    /// Describes the lines that leave `places`.
    fn lines(&self, places: &LineStarts, along: [f64; 2], earth: &EarthParams) -> MapLines {
        let ([west, north], cell) = (self.grid.north_west(), self.grid.cell());
        let middle = [0, 1].map(|i| f64::midpoint(places.low[i], places.high[i]));
        let half = [0, 1].map(|i| (places.high[i] - places.low[i]) / 2.0);
        let away = |slope: f64| if slope.abs() < MIN_SLOPE { MIN_SLOPE } else { slope };
        let step = [away(along[0] / cell[0]), away(-along[1] / cell[1])];
        let corner = |is_forward: bool| {
            [0, 1].map(|i| if (along[i] > 0.0) == is_forward { places.high[i] } else { places.low[i] })
        };
        let [forward, rear] = [true, false].map(corner);
        let from = match [forward, rear].map(|place| self.exit(place, along)) {
            [Some(first), Some(last)] => [first, last],
            [None, None] => [self.nearest(); 2],
            _ => [self.nearest(), f64::INFINITY],
        };
        MapLines {
            start: [(middle[0] - west) / cell[0], (north - middle[1]) / cell[1]],
            half: [half[0] / cell[0], half[1] / cell[1]],
            step,
            inverse: step.map(|v| 1.0 / v),
            room: [0, 1].map(|i| half[i] / cell[i] / step[i].abs()),
            low: places.low[2],
            from,
            fall: earth.fall_rate(),
        }
    }

    /// Returns the minimum distance of terrain that counts, metres.
    fn nearest(&self) -> f64 {
        self.grid.cell()[0].max(self.grid.cell()[1])
    }

    /// Returns the distance at which the line from a place leaves the box of the cloud, metres, at least
    /// [`TerrainHeights::nearest`]; `None` for a place outside.
    fn exit(&self, place: [f64; 2], along: [f64; 2]) -> Option<f64> {
        let [low, high] = self.within;
        let to_side = |axis: usize| match along[axis] {
            slope if slope > 0.0 => (high[axis] - place[axis]) / slope,
            slope if slope < 0.0 => (low[axis] - place[axis]) / slope,
            _ => f64::INFINITY,
        };
        let is_inside = (0..2).all(|i| low[i] <= place[i] && place[i] <= high[i]);
        is_inside.then(|| to_side(0).min(to_side(1)).max(self.nearest()))
    }

    /// Numbers of patches.
    fn size(&self) -> [usize; 2] {
        [self.grid.heights().width() - 1, self.grid.heights().height() - 1]
    }

    /// Calls `visit` for every patch within `spans` of the lines that may rise above `top`, nearest blocks first, until
    /// it breaks off.
    fn descend(
        &self,
        lines: &MapLines,
        spans: [f64; 2],
        top: &mut Top,
        visit: &mut impl FnMut([f32; 4], [usize; 2], [f64; 2], &mut Top) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let spans = lines.spans_over(self.size(), spans);
        if spans[0] > spans[1] {
            return ControlFlow::Continue(());
        }
        self.descend_from(self.levels.len(), [0, 0], lines, spans, top, visit)
    }

    /// Does the work of [`TerrainHeights::descend`] below a block of `1 << level` patches a side.
    fn descend_from(
        &self,
        level: usize,
        block: [usize; 2],
        lines: &MapLines,
        spans: [f64; 2],
        top: &mut Top,
        visit: &mut impl FnMut([f32; 4], [usize; 2], [f64; 2], &mut Top) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let size = self.size();
        let Some(below) = level.checked_sub(1) else {
            return visit(corners(&self.grid, block[0], block[1]), block, spans, top);
        };
        let of_level = &self.levels[below];
        let highest = of_level.highest[block[1] * of_level.width + block[0]];
        if !lines.may_rise(highest, spans, top.tangent) {
            return ControlFlow::Continue(());
        }
        // where the lines pass the middle of the block: the nearer half of each axis ends there, and the farther one
        // begins
        let middle = [0, 1].map(|axis| {
            let line = ((2 * block[axis] + 1) << below) as f64;
            (line - lines.start[axis]) * lines.inverse[axis]
        });
        for part in 0..4_usize {
            let (mut spans, mut child) = (spans, [0; 2]);
            for axis in 0..2 {
                let is_farther = part >> axis & 1 == 1;
                if is_farther {
                    spans[0] = spans[0].max(middle[axis] - lines.room[axis]);
                } else {
                    spans[1] = spans[1].min(middle[axis] + lines.room[axis]);
                }
                child[axis] = 2 * block[axis] + usize::from(is_farther == (lines.step[axis] > 0.0));
            }
            if spans[0] <= spans[1] && child[0] << below < size[0] && child[1] << below < size[1] {
                self.descend_from(below, child, lines, spans, top, visit)?;
            }
        }
        ControlFlow::Continue(())
    }
}

impl HeightLevel {
    /// The level above one of `size` blocks with these maxima.
    fn halved(size: [usize; 2], highest: impl Fn(usize, usize) -> f32) -> Self {
        let [width, height] = size.map(|count| count.div_ceil(2));
        let block = |i: usize| {
            let (column, row) = (2 * (i % width), 2 * (i / width));
            let rows = row..(row + 2).min(size[1]);
            let values = rows.flat_map(|row| (column..(column + 2).min(size[0])).map(move |column| [column, row]));
            values.map(|[column, row]| highest(column, row)).fold(f32::NEG_INFINITY, f32::max)
        };
        Self { width, highest: (0..width * height).map(block).collect() }
    }
}

impl MapLines {
    /// The part of `spans` in which any of the lines is over the first `size` patches; empty where the first is above
    /// the second.
    fn spans_over(&self, size: [usize; 2], mut spans: [f64; 2]) -> [f64; 2] {
        for (axis, count) in size.into_iter().enumerate() {
            let one = -self.start[axis] * self.inverse[axis];
            let other = (count as f64 - self.start[axis]) * self.inverse[axis];
            spans = [spans[0].max(one.min(other) - self.room[axis]), spans[1].min(one.max(other) + self.room[axis])];
        }
        spans
    }

    /// Returns true if terrain as high as `highest` somewhere within `spans` may rise above the lines with the tangent
    /// `tangent`.
    #[inline]
    fn may_rise(&self, highest: f32, [from, to]: [f64; 2], tangent: f64) -> bool {
        let rise = f64::from(highest) - self.low;
        let slope = tangent + self.fall * from;
        rise > slope * if slope > 0.0 { from } else { to }
    }

    /// The highest place of a patch on the line between two distances, the tangent of its elevation and its distance;
    /// `None` where it is not known.
    fn top_of_patch(&self, corners: [f32; 4], patch: [usize; 2], [from, to]: [f64; 2]) -> Option<Top> {
        let [a, b, c, d] = corners.map(f64::from);
        if !(a + b + c + d).is_finite() {
            return None;
        }
        let (u, v) = (self.start[0] - patch[0] as f64, self.start[1] - patch[1] as f64);
        let ([du, dv], (east, south, twist)) = (self.step, (b - a, c - a, a - b - c + d));
        // height above the place less the fall, as a quadratic of the distance
        let constant = a + east * u + south * v + twist * u * v - self.low;
        let linear = east * du + south * dv + twist * (u * dv + v * du);
        let square = twist * du * dv - self.fall;
        let tangent = |span: f64| square * span + linear + constant / span;
        let mut top = Top { tangent: tangent(from), span: from };
        let mut consider = |span: f64| {
            let tangent = tangent(span);
            if tangent > top.tangent {
                top = Top { tangent, span };
            }
        };
        consider(to);
        if constant < 0.0 && square < 0.0 {
            consider((constant / square).sqrt().clamp(from, to));
        }
        Some(top)
    }
}

/// Upper bound of the rounding error in the tangent of an elevation.
fn rounding(tangent: f64) -> f64 {
    1e-9 * (1.0 + tangent.abs())
}

/// Heights of the nodes of a patch: north-west, north-east, south-west, south-east.
#[inline]
fn corners(grid: &ElevationGrid, column: usize, row: usize) -> [f32; 4] {
    let (heights, width) = (grid.heights().values(), grid.heights().width());
    let first = row * width + column;
    [heights[first], heights[first + 1], heights[first + width], heights[first + width + 1]]
}
