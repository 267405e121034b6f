//! Edges of roofs: straight lines between returns on a plane and pulses that passed it.

use super::block::Block;
use super::likelihood::{LikelihoodParams, LikelihoodTable};
use super::line::PlanLine;
use super::parapets::{self, Parapet, ParapetParams};
use super::ridges::RidgeLine;
use super::roof_planes::Roofs;
use super::samples::{self, Passed, SampleParams, Samples};
use crate::ground::sides;

/// Required accuracy of edges of roofs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeParams {
    /// Maximum standard deviation of the position of a sure edge, one that cuts balls and ends patches, metres. Default
    /// 0.1: at five pulses per m² facades are falsely blocked a tenth more often with 0.08; at ten nothing changes.
    pub max_sd: f64,
    /// Maximum standard deviation of the mean of the middles along a sure edge, metres. Default 0.08.
    pub max_scatter: f64,
    /// Maximum standard deviation of the position of an edge below which walls are searched, in spacings of pulses,
    /// where that is more than `max_sd`. Default 0.35: at 2 pulses per m², 9 walls are found without it, and 199 at 10.
    pub max_sd_spacings: f64,
    /// The same of the mean of the middles. Default 0.28.
    pub max_scatter_spacings: f64,
    /// Parameters of returns and pulses from which edges are found.
    pub(super) samples: SampleParams,
    /// Parameters of lines between them.
    pub(super) lines: LineParams,
    /// Parameters of the likelihood of edges.
    pub(super) likelihood: LikelihoodParams,
    /// Parameters of parapets along edges.
    pub(super) parapets: ParapetParams,
}

/// Parameters of the lines that grow along middles of sides between returns and pulses that passed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LineParams {
    /// Maximum length of such a side, spacings. Default 4.
    pub(super) side_spacings: f64,
    /// Radius around a middle within which others show its direction, spacings. Default 5.
    pub(super) around_spacings: f64,
    /// Half width of the band about a line in which middles belong to it, spacings. Default 0.6.
    pub(super) band_spacings: f64,
    /// The same while a line begins to grow. Default 0.9.
    pub(super) wide_band_spacings: f64,
    /// Number of times that it grows so. Default 4.
    pub(super) wide_turns: usize,
    /// Maximum gap of a line, spacings. Default 5.
    pub(super) gap_spacings: f64,
    /// Distance beside a line within which middles are no lines of their own, spacings. Default 1.2.
    pub(super) beside_spacings: f64,
    /// Minimum number of middles on a line. Default 4.
    pub(super) min_middles: usize,
    /// Minimum length of a line, metres. Default 1.
    pub(super) min_length: f64,
    /// Cosine of the maximum turn between pieces of one line. Default 0.9, 26°.
    pub(super) joined_cosine: f64,
    /// Maximum increase of the root mean square distance of the middles of two joined pieces, over lines of their own,
    /// spacings. Default 0.36: a step of two thirds of a spacing between two halves.
    pub(super) joined_spacings: f64,
    /// Width inside a line within which returns on the plane itself are counted, spacings. Default 3.2.
    pub(super) own_spacings: f64,
    /// Minimum share of those among all returns there. Default 0.3.
    pub(super) min_own_share: f64,
    /// Maximum shift of an end to a crossing with another line of the plane, spacings. Default 3.5.
    pub(super) end_spacings: f64,
    /// Number of middles that count as one, as those of sides that share a return or a pulse are not independent.
    /// Default 6.
    pub(super) middles_as_one: f64,
    /// Standard deviation of the errors that no number of pulses averages out, metres: the maximum distance of an axis
    /// outside an edge whose beam is still partly returned. Default 0.02.
    pub(super) common_sd: f64,
}

impl Default for EdgeParams {
    fn default() -> Self {
        Self {
            max_sd: 0.1,
            max_scatter: 0.08,
            max_sd_spacings: 0.35,
            max_scatter_spacings: 0.28,
            samples: SampleParams::default(),
            lines: LineParams::default(),
            likelihood: LikelihoodParams::default(),
            parapets: ParapetParams::default(),
        }
    }
}

impl Default for LineParams {
    fn default() -> Self {
        Self {
            side_spacings: 4.0,
            around_spacings: 5.0,
            band_spacings: 0.6,
            wide_band_spacings: 0.9,
            wide_turns: 4,
            gap_spacings: 5.0,
            beside_spacings: 1.2,
            min_middles: 4,
            min_length: 1.0,
            joined_cosine: 0.9,
            joined_spacings: 0.36,
            own_spacings: 3.2,
            min_own_share: 0.3,
            end_spacings: 3.5,
            middles_as_one: 6.0,
            common_sd: 0.02,
        }
    }
}

/// An edge of a plane in plan.
#[derive(Clone, Debug)]
pub(super) struct EdgeLine {
    /// The roof lies to the left.
    pub(super) line: PlanLine,
    /// Standard deviation across, metres.
    pub(super) sd: f64,
    pub(super) count: usize,
    /// Median height of the returns below, metres below the plane.
    pub(super) drop: f64,
    /// True if it is known well enough to cut balls and to end patches.
    pub(super) is_sure: bool,
    /// True if it is known well enough to search for a wall below.
    pub(super) may_have_wall: bool,
    /// Parapet along it.
    pub(super) parapet: Parapet,
}

/// Boundary of a plane.
#[derive(Clone, Debug, Default)]
pub(super) struct Outline {
    pub(super) samples: Samples,
    pub(super) edges: Vec<EdgeLine>,
}

impl Outline {
    /// The edges that cut balls and end patches.
    pub(super) fn sure_edges(&self) -> impl Iterator<Item = &EdgeLine> + Clone {
        self.edges.iter().filter(|edge| edge.is_sure)
    }
}

/// A middle of a side between a return and a pulse that passed.
#[derive(Clone, Copy, Debug)]
struct Middle {
    p: [f64; 2],
    /// Unit vector from the return to the pulse.
    out: [f64; 2],
    depth: f64,
}

/// The outline of a plane.
pub(super) fn find(
    block: &Block,
    roofs: &Roofs,
    ridges: &[RidgeLine],
    plane: usize,
    params: &EdgeParams,
    table: &LikelihoodTable,
) -> Outline {
    let spacing = roofs.planes[plane].spacing;
    let samples = samples::find(block, roofs, ridges, plane, &params.samples);
    let search = EdgeSearch { samples: &samples, middles: middles(&samples, spacing, &params.lines), spacing, params };
    let mut edges: Vec<EdgeLine> = search.lines().iter().map(|line| search.edge(line, table)).collect();
    meet(&mut edges, ridges, plane, params.lines.end_spacings * spacing);
    edges.retain(|edge| edge.line.length() >= params.lines.min_length / 2.0);
    for edge in &mut edges {
        edge.parapet = parapets::find(&samples, &edge.line, &params.parapets);
    }
    Outline { samples, edges }
}

/// Middles of the sides between returns and pulses that passed, in the triangulation of both.
fn middles(samples: &Samples, spacing: f64, params: &LineParams) -> Vec<Middle> {
    let passed: Vec<&Passed> = samples.deep().collect();
    let inside = samples.inside.len();
    if passed.is_empty() {
        return Vec::new();
    }
    let points: Vec<[f64; 2]> = samples.inside.iter().copied().chain(passed.iter().map(|passed| passed.p)).collect();
    let mut middles = Vec::new();
    for [start, end] in sides(&points) {
        let (within, out) = (start.min(end), start.max(end));
        if within >= inside || out < inside {
            continue;
        }
        let (a, b) = (points[within], points[out]);
        let [x, y] = [b[0] - a[0], b[1] - a[1]];
        let length = x.hypot(y);
        if length > params.side_spacings * spacing || length < 1e-6 {
            continue;
        }
        middles.push(Middle {
            p: [f64::midpoint(a[0], b[0]), f64::midpoint(a[1], b[1])],
            out: [x / length, y / length],
            depth: passed[out - inside].depth,
        });
    }
    middles.sort_unstable_by(|a, b| a.p[0].total_cmp(&b.p[0]).then(a.p[1].total_cmp(&b.p[1])));
    middles
}

/// A line while it grows.
struct Grown {
    line: PlanLine,
    rows: Vec<usize>,
    rms: f64,
}

/// Search for the straight edges of a plane along the middles of its sides.
struct EdgeSearch<'a> {
    samples: &'a Samples,
    /// Sorted from west to east.
    middles: Vec<Middle>,
    /// Mean distance of pulses, metres.
    spacing: f64,
    params: &'a EdgeParams,
}

impl EdgeSearch<'_> {
    /// Straight lines that middles lie on, each grown from where they are straightest.
    fn lines(&self) -> Vec<Grown> {
        let (middles, spacing, params) = (&self.middles, self.spacing, &self.params.lines);
        let mut seeds: Vec<(f64, usize, PlanLine)> = Vec::new();
        for row in 0..middles.len() {
            if let Some((line, rms)) = self.line_about(row) {
                seeds.push((rms, row, line));
            }
        }
        seeds.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut is_free = vec![true; middles.len()];
        let mut pieces = Vec::new();
        for (_, seed, line) in seeds {
            if !is_free[seed] {
                continue;
            }
            let Some(grown) = self.grown(seed, line, &is_free) else { continue };
            // what lies beside a line is of it, too
            for (row, middle) in middles.iter().enumerate() {
                let [t, d] = grown.line.of(middle.p);
                let is_beside = d.abs() <= params.beside_spacings * spacing && faces(middle, grown.line.outward());
                is_free[row] &= !(is_beside && (grown.line.ends[0]..=grown.line.ends[1]).contains(&t));
            }
            pieces.push(grown);
        }
        let mut pieces = self.joined(pieces);
        pieces.retain(|piece| self.own_share(&piece.line) >= params.min_own_share);
        pieces
    }

    /// The edge that a line of middles shows.
    fn edge(&self, piece: &Grown, table: &LikelihoodTable) -> EdgeLine {
        let (spacing, params) = (self.spacing, &self.params.lines);
        let mut depths: Vec<f64> = piece.rows.iter().map(|&row| self.middles[row].depth).collect();
        depths.sort_unstable_by(f64::total_cmp);
        let (line, sd) = table.likeliest(self.samples, &piece.line, spacing);
        let sd = sd.hypot(params.common_sd);
        let scatter = piece.rms / (piece.rows.len() as f64 / params.middles_as_one).max(1.0).sqrt();
        let &EdgeParams { max_sd, max_scatter, max_sd_spacings, max_scatter_spacings, .. } = self.params;
        EdgeLine {
            line,
            sd,
            count: piece.rows.len(),
            drop: depths.get(depths.len() / 2).copied().unwrap_or(0.0),
            is_sure: sd <= max_sd && scatter <= max_scatter,
            may_have_wall: sd <= max_sd.max(max_sd_spacings * spacing)
                && scatter <= max_scatter.max(max_scatter_spacings * spacing),
            parapet: Parapet::default(),
        }
    }

    /// Joins pieces that follow each other on one line: those that began as short pieces have directions of their own.
    fn joined(&self, mut pieces: Vec<Grown>) -> Vec<Grown> {
        let (middles, spacing, params) = (&self.middles, self.spacing, &self.params.lines);
        let mut first = 0;
        while first < pieces.len() {
            let joined = (first + 1..pieces.len()).find_map(|other| {
                let (a, b) = (&pieces[first], &pieces[other]);
                let cosine = a.line.along[0] * b.line.along[0] + a.line.along[1] * b.line.along[1];
                let [s, t] = b.line.end_points().map(|p| a.line.of(p)[0]);
                let gap = (s - a.line.ends[1]).max(a.line.ends[0] - t);
                if cosine < params.joined_cosine || gap > params.gap_spacings * spacing {
                    return None;
                }
                let mut rows: Vec<usize> = a.rows.iter().chain(&b.rows).copied().collect();
                rows.sort_unstable();
                let (line, rms) = PlanLine::fit(rows.iter().map(|&row| middles[row].p), a.line.along)?;
                let [n, m] = [a.rows.len() as f64, b.rows.len() as f64];
                let apart = (n * a.rms.powi(2) + m * b.rms.powi(2)) / (n + m);
                let may_differ = apart + (params.joined_spacings * spacing).powi(2);
                (rms.powi(2) <= may_differ).then_some((other, Grown { line, rows, rms }))
            });
            match joined {
                Some((other, grown)) => {
                    pieces.swap_remove(other);
                    pieces[first] = grown;
                    // the longer line may reach others
                    first = 0;
                }
                None => first += 1,
            }
        }
        pieces
    }

    /// Share of the returns within a line that lie on the plane itself: the others may stand on something else.
    fn own_share(&self, line: &PlanLine) -> f64 {
        let reach = self.params.lines.own_spacings * self.spacing;
        let (mut own, mut all) = (0_usize, 0_usize);
        for (number, &p) in self.samples.inside.iter().enumerate() {
            let [t, d] = line.of(p);
            if (-reach..=0.0).contains(&d) && (line.ends[0]..=line.ends[1]).contains(&t) {
                all += 1;
                own += usize::from(number < self.samples.own);
            }
        }
        own as f64 / all.max(1) as f64
    }

    /// The line through the middles about one, with the roof to its left.
    fn line_about(&self, row: usize) -> Option<(PlanLine, f64)> {
        let (middles, params) = (&self.middles, &self.params.lines);
        let reach = params.around_spacings * self.spacing;
        let Middle { p, out, .. } = middles[row];
        let first = middles.partition_point(|middle| middle.p[0] < p[0] - reach);
        let near: Vec<[f64; 2]> = middles[first..]
            .iter()
            .take_while(|middle| middle.p[0] <= p[0] + reach)
            .filter(|middle| (middle.p[1] - p[1]).abs() <= reach && faces(middle, out))
            .map(|middle| middle.p)
            .collect();
        if near.len() < params.min_middles {
            return None;
        }
        PlanLine::fit(near.iter().copied(), [-out[1], out[0]])
    }

    /// The line that grows from a seed as far as free middles go on in its band.
    fn grown(&self, seed: usize, line: PlanLine, is_free: &[bool]) -> Option<Grown> {
        let (middles, spacing, params) = (&self.middles, self.spacing, &self.params.lines);
        let gap = params.gap_spacings * spacing;
        let mut grown = Grown { line, rows: Vec::new(), rms: 0.0 };
        for turn in 0..10 {
            // a short piece has another direction than the whole
            let band =
                if turn < params.wide_turns { params.wide_band_spacings } else { params.band_spacings } * spacing;
            let out = grown.line.outward();
            let mut on: Vec<(f64, usize)> = Vec::new();
            for (row, middle) in middles.iter().enumerate() {
                let [t, d] = grown.line.of(middle.p);
                if d.abs() <= band && is_free[row] && middle.out[0] * out[0] + middle.out[1] * out[1] > 0.3 {
                    on.push((t, row));
                }
            }
            on.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            let at = grown.line.of(middles[seed].p)[0];
            let (mut first, mut last) = (on.partition_point(|&(t, _)| t < at), on.partition_point(|&(t, _)| t <= at));
            while first > 0 && on.get(first).map_or(at, |&(t, _)| t) - on[first - 1].0 <= gap {
                first -= 1;
            }
            while last < on.len() && on[last].0 - (if last > 0 { on[last - 1].0 } else { at }) <= gap {
                last += 1;
            }
            let mut rows: Vec<usize> = on[first..last].iter().map(|&(_, row)| row).collect();
            if rows.len() < params.min_middles {
                return None;
            }
            rows.sort_unstable();
            let is_same = rows == grown.rows;
            let (line, rms) = PlanLine::fit(rows.iter().map(|&row| middles[row].p), grown.line.along)?;
            grown = Grown { line, rows, rms };
            if is_same && turn >= params.wide_turns {
                break;
            }
        }
        (grown.line.length() >= params.min_length).then_some(grown)
    }
}

/// Returns true if the outward direction at a middle is about the same.
fn faces(middle: &Middle, out: [f64; 2]) -> bool {
    middle.out[0] * out[0] + middle.out[1] * out[1] > 0.0
}

/// Moves ends of lines to where they cross others of the plane, or its ridges, near by.
fn meet(edges: &mut [EdgeLine], ridges: &[RidgeLine], plane: usize, reach: f64) {
    let of_plane = ridges.iter().filter(|ridge| ridge.planes.contains(&plane)).map(|ridge| ridge.line);
    let lines: Vec<PlanLine> = edges.iter().map(|edge| edge.line).chain(of_plane).collect();
    for (number, edge) in edges.iter_mut().enumerate() {
        for end in 0..2 {
            let at = lines[number].ends[end];
            let mut best: Option<f64> = None;
            for (_, other) in lines.iter().enumerate().filter(|&(other, _)| other != number) {
                let Some(crossing) = lines[number].crossing(other) else { continue };
                let [on_other, _] = other.of(lines[number].at(crossing, 0.0));
                let is_near = (other.ends[0] - reach..=other.ends[1] + reach).contains(&on_other);
                let moves = (crossing - at).abs();
                if is_near && moves <= reach && best.is_none_or(|best| moves < (best - at).abs()) {
                    best = Some(crossing);
                }
            }
            edge.line.ends[end] = best.unwrap_or(at);
        }
        if edge.line.length() < 0.0 {
            edge.line.ends = lines[number].ends;
        }
    }
}
