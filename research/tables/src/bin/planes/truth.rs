//! True edges, ridges and walls of a mesh, and the errors of those found.

use belvedere::cast::{to_i64, to_index, to_row};
use belvedere::planes::BuildingSurfaces;
use belvedere::vector::{cross, dot, sub, unit};
use belvedere_scenes::{Material, TriangleScene, Truth};
use std::collections::BTreeMap;
use std::fmt;

/// Distance between the places on a line at which it is judged, metres.
const STEP: f64 = 0.25;
/// How far beside a true line its surfaces are looked at, metres.
const BESIDE: f64 = 0.03;
/// How much lower than an edge the other side must lie, metres.
const MIN_DROP: f64 = 0.5;
/// Strips narrower than this are parapets, of which only the outer side is an edge, metres, and how much lower that
/// lies.
const STRIP: f64 = 0.4;
const STRIP_DROP: f64 = 1.2;
/// How far from a true line one that was found may lie, metres, across and in height: a parapet stands on its roof.
const REACH: [f64; 2] = [0.5, 0.75];
/// Largest sine of the angle between both.
const SAME_WAY: f64 = 0.17;
/// Height that nothing rises above, metres above the mesh.
const ABOVE: f64 = 100.0;

/// A true line, absolute metres.
#[derive(Clone, Copy)]
pub(crate) struct Line {
    ends: [[f64; 3]; 2],
}

impl Line {
    /// Length in plan, metres.
    pub(crate) fn length(&self) -> f64 {
        let [a, b] = self.ends;
        (b[0] - a[0]).hypot(b[1] - a[1])
    }

    fn at(&self, share: f64) -> [f64; 3] {
        let [a, b] = self.ends;
        std::array::from_fn(|i| a[i] + share * (b[i] - a[i]))
    }

    /// Unit vector in plan along the line.
    fn along(&self) -> [f64; 2] {
        let [a, b] = self.ends;
        [0, 1].map(|i| (b[i] - a[i]) / self.length())
    }
}

/// A side of triangles, and the unit normals of these.
struct Side {
    line: Line,
    normals: Vec<[f64; 3]>,
}

/// A line that was found, with its ends, absolute metres, and its standard deviation across, metres.
pub(crate) struct FoundLine {
    pub(crate) ends: [[f64; 3]; 2],
    pub(crate) sd: f64,
}

/// Share found and errors across.
#[derive(Default)]
pub(crate) struct Errors {
    metres: f64,
    found: f64,
    outward: Vec<f64>,
    over_sd: Vec<f64>,
}

impl fmt::Display for Errors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size: Vec<f64> = self.outward.iter().map(|v| v.abs()).collect();
        write!(
            f,
            "{:.0} | {:.2} | {:.1} | {:.1} | {:+.1} | {:.2}",
            self.metres,
            self.found / self.metres,
            100.0 * quantile(&size, 0.5),
            100.0 * quantile(&size, 0.95),
            100.0 * quantile(&self.outward, 0.5),
            quantile(&self.over_sd, 0.5)
        )
    }
}

fn quantile(values: &[f64], share: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let place = to_index(sorted.len().saturating_sub(1) as f64 * share);
    sorted.get(place).copied().unwrap_or(f64::NAN)
}

/// Pieces of so many metres in a length.
fn pieces(length: f64) -> u32 {
    to_row(to_index((length / STEP).max(1.0)))
}

/// The edges of the roofs of a scene, seen from above, and the convex lines in which two roofs meet.
pub(crate) fn lines_of(scene: &TriangleScene, exact: &Truth) -> (Vec<Line>, Vec<Line>) {
    let top = scene.bounds().map_or(0.0, |bounds| bounds.1[2]) + ABOVE;
    let height = |[x, y]: [f64; 2]| {
        exact.first_hit([x, y, top], [0.0, 0.0, -1.0], f64::INFINITY).map_or(f64::NEG_INFINITY, |hit| top - hit.range)
    };
    let key = |p: [f64; 3]| p.map(|v| to_i64((1000.0 * v).round()));
    let mut sides: BTreeMap<[[i64; 3]; 2], Side> = BTreeMap::new();
    for number in (0..scene.triangles.len()).filter(|&number| scene.materials.get(number) == Some(&Material::Roof)) {
        let Some(corners) = scene.corners(number) else { continue };
        let normal = unit(cross(sub(corners[1], corners[0]), sub(corners[2], corners[0]))).unwrap_or_default();
        for side in 0..3 {
            let ends = [corners[side], corners[(side + 1) % 3]];
            let mut keys = ends.map(key);
            keys.sort_unstable();
            let side = sides.entry(keys).or_insert_with(|| Side { line: Line { ends }, normals: Vec::new() });
            side.normals.push(normal);
        }
    }
    let (mut edges, mut ridges) = (Vec::new(), Vec::new());
    for Side { line, normals } in sides.into_values().filter(|side| side.line.length() >= 1.0) {
        let up = normals.iter().filter(|normal| normal[2] > 0.3).count();
        if let (2, [a, b]) = (up, &normals[..]) {
            let seen = (0..20_u32).filter(|step| {
                let p = line.at((f64::from(*step) + 0.5) / 20.0);
                height([p[0], p[1]]) < p[2] + 0.05
            });
            if dot(*a, *b) < 0.985 && seen.count() >= 16 {
                ridges.push(line);
            }
        } else if up > 0 {
            edges.extend(free_pieces(&line, height));
        }
    }
    (edges, ridges)
}

/// The pieces of a side of a roof beside which it falls off, seen from above.
fn free_pieces(line: &Line, height: impl Fn([f64; 2]) -> f64) -> Vec<Line> {
    let count = pieces(line.length());
    let [x, y] = line.along();
    let is_free = |piece: u32| {
        let p = line.at((f64::from(piece) + 0.5) / f64::from(count));
        let beside = |right: f64| height([p[0] + right * y, p[1] - right * x]);
        let [right, left] = [beside(BESIDE), beside(-BESIDE)];
        let within = if right > left { STRIP } else { -STRIP };
        let drop = if (beside(within) - p[2]).abs() > MIN_DROP - 0.05 { STRIP_DROP } else { MIN_DROP };
        (right.max(left) - p[2]).abs() < 0.1 && right.min(left) < p[2] - drop
    };
    let mut found = Vec::new();
    let mut first = None;
    for piece in 0..=count {
        match (first, piece < count && is_free(piece)) {
            (None, true) => first = Some(piece),
            (Some(from), false) => {
                let part = Line { ends: [from, piece].map(|end| line.at(f64::from(end) / f64::from(count))) };
                found.extend((part.length() >= 1.0).then_some(part));
                first = None;
            }
            _ => {}
        }
    }
    found
}

/// Errors across of the lines found, at places along the true ones.
pub(crate) fn errors_on(lines: &[Line], found: &[FoundLine]) -> Errors {
    let mut errors = Errors::default();
    for line in lines {
        let count = pieces(line.length());
        let step = line.length() / f64::from(count);
        for piece in 0..count {
            let p = line.at((f64::from(piece) + 0.5) / f64::from(count));
            errors.metres += step;
            let near = found.iter().filter_map(|found| Some((outward(found, p, line.along())?, found.sd)));
            if let Some((error, sd)) = near.min_by(|a, b| a.0.abs().total_cmp(&b.0.abs())) {
                errors.found += step;
                errors.outward.push(error);
                errors.over_sd.push(error.abs() / sd);
            }
        }
    }
    errors
}

/// How far outside a true place a line that was found runs, if it is that line, metres.
fn outward(found: &FoundLine, p: [f64; 3], way: [f64; 2]) -> Option<f64> {
    let own = Line { ends: found.ends };
    let length = own.length();
    if length < STEP {
        return None;
    }
    let ([x, y], from) = (own.along(), own.ends[0]);
    let (along, right) = ((p[0] - from[0]) * x + (p[1] - from[1]) * y, (p[0] - from[0]) * y - (p[1] - from[1]) * x);
    let is_beside = (-STEP..=length + STEP).contains(&along) && right.abs() < REACH[0];
    let height = own.at(along / length)[2];
    (is_beside && (height - p[2]).abs() < REACH[1] && (x * way[1] - y * way[0]).abs() < SAME_WAY).then_some(-right)
}

/// Errors across of the walls found, from the true surface behind and before them half way up.
pub(crate) fn errors_of_walls(found: &BuildingSurfaces, origin: [f64; 3], exact: &Truth) -> Errors {
    let mut errors = Errors::default();
    for wall in &found.outlines.walls {
        let [a, b] = wall.ends;
        let line = Line { ends: [a, b].map(|p| [p[0] + origin[0], p[1] + origin[1], 0.0]) };
        if line.length() < 2.0 * STEP {
            continue;
        }
        let [x, y] = line.along();
        let z = f64::midpoint(wall.heights[0], wall.heights[1]) + origin[2];
        for piece in 0..5_u32 {
            let p = line.at((f64::from(piece) + 0.5) / 5.0);
            errors.metres += line.length() / 5.0;
            let from = [p[0] + 0.6 * y, p[1] - 0.6 * x, z];
            if let Some(hit) = exact.first_hit(from, [-y, x, 0.0], 1.2) {
                errors.found += line.length() / 5.0;
                errors.outward.push(hit.range - 0.6);
                errors.over_sd.push((hit.range - 0.6).abs() / wall.sd);
            }
        }
    }
    errors
}
