//! The envelope as closed solids.

use super::{ConvexPolygon, EnvelopeColumn, SolarEnvelope};
use belvedere_data::{Error, Mesh, Parameter, Result};
use std::collections::HashMap;

/// Columns lower than this have no room for anything, metres.
const MIN_HEIGHT: f64 = 1e-3;

/// Vertices that are shared where they are the same number for number.
#[derive(Default)]
struct VertexMerger {
    mesh: Mesh,
    known: HashMap<[u64; 3], u32>,
}

impl VertexMerger {
    fn vertex(&mut self, place: [f64; 3]) -> u32 {
        let count = u32::try_from(self.mesh.vertices.len()).unwrap_or(u32::MAX);
        // zero has two signs
        *self.known.entry(place.map(|v| (v + 0.0).to_bits())).or_insert_with(|| {
            self.mesh.vertices.push(place);
            count
        })
    }

    fn triangle(&mut self, corners: [[f64; 3]; 3]) {
        let corners = corners.map(|corner| self.vertex(corner));
        self.mesh.triangles.push(corners);
    }

    /// A level polygon, seen from above where `corners` run counter-clockwise.
    fn level(&mut self, corners: &[[f64; 2]], height: f64) {
        let at = |corner: &[f64; 2]| [corner[0], corner[1], height];
        for pair in corners.get(1..).unwrap_or_default().windows(2) {
            if let ([first, ..], [b, c]) = (corners, pair) {
                self.triangle([at(first), at(b), at(c)]);
            }
        }
    }

    /// An upright wall from place `a` to place `b`, its outside on the right hand, between rising heights at each; the
    /// lowest is the same at both, and the highest.
    fn wall(&mut self, [a, b]: [[f64; 2]; 2], [at_a, at_b]: [&[f64]; 2]) {
        let up = |[x, y]: [f64; 2], z: f64| [x, y, z];
        let (mut i, mut j) = (0, 0);
        while i + 1 < at_a.len() || j + 1 < at_b.len() {
            let climbs_a = match (at_a.get(i + 1), at_b.get(j + 1)) {
                (Some(next_a), Some(next_b)) => next_a < next_b,
                (next_a, _) => next_a.is_some(),
            };
            if climbs_a {
                self.triangle([up(a, at_a[i]), up(b, at_b[j]), up(a, at_a[i + 1])]);
                i += 1;
            } else {
                self.triangle([up(a, at_a[i]), up(b, at_b[j]), up(b, at_b[j + 1])]);
                j += 1;
            }
        }
    }

    /// A closed prism.
    fn prism(&mut self, piece: &ConvexPolygon, [low, high]: [f64; 2]) {
        let corners = distinct(piece.corners());
        if corners.len() < 3 {
            return;
        }
        self.level(&corners, high);
        let below: Vec<[f64; 2]> = corners.iter().rev().copied().collect();
        self.level(&below, low);
        for (i, &a) in corners.iter().enumerate() {
            let b = corners[(i + 1) % corners.len()];
            self.wall([a, b], [&[low, high], &[low, high]]);
        }
    }
}

/// A polygon without corners that follow each other in the same place.
fn distinct(corners: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut corners = corners.to_vec();
    corners.dedup();
    while corners.len() > 1 && corners.first() == corners.last() {
        corners.pop();
    }
    corners
}

impl SolarEnvelope {
    /// Converts the envelope into a mesh in metres of the system of `origin`. It consists of closed solids whose
    /// volumes add up to [`SolarEnvelope::volume`]. The whole cells of the parcel are blocks that touch each other
    /// without gap; the cells that its outline cuts are prisms beside them. Columns lower than a millimetre are left
    /// out.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] where a column is bounded by nothing.
    pub fn to_mesh(&self, origin: [f64; 3]) -> Result<Mesh> {
        if let Some(count) = Some(self.unbounded_count()).filter(|count| *count > 0) {
            return Err(Error::invalid(
                Parameter::Envelope,
                format!("infinitely high in {count} columns, which no sun limits"),
                "limited, to be a solid; give a maximum height",
            ));
        }
        let mut builder = VertexMerger::default();
        let mut blocks: HashMap<usize, [f64; 2]> = HashMap::new();
        for column in self.columns.iter().filter(|column| column.height() >= MIN_HEIGHT) {
            if column.footprint.is_whole {
                blocks.insert(column.footprint.cell, [column.ground, column.top]);
            } else {
                for piece in &column.footprint.pieces {
                    builder.prism(piece, [column.ground, column.top]);
                }
            }
        }
        for column in &self.columns {
            if let Some(&span) = blocks.get(&column.footprint.cell) {
                self.block(column, span, &blocks, &mut builder);
            }
        }
        let mut mesh = builder.mesh;
        for vertex in &mut mesh.vertices {
            *vertex = [0, 1, 2].map(|i| vertex[i] + origin[i]);
        }
        Ok(mesh)
    }

    /// Number of columns that nothing bounds.
    #[must_use]
    pub fn unbounded_count(&self) -> usize {
        self.columns.iter().filter(|column| column.top.is_infinite()).count()
    }

    /// Top, bottom and those parts of the walls of a whole cell that no neighbour covers.
    fn block(
        &self,
        column: &EnvelopeColumn,
        span: [f64; 2],
        blocks: &HashMap<usize, [f64; 2]>,
        builder: &mut VertexMerger,
    ) {
        let width = self.grid.width;
        let (x, y) = (column.footprint.cell % width, column.footprint.cell / width);
        let at = |x: Option<usize>, y: Option<usize>| {
            let (x, y) = (x?, y?);
            (x < width).then(|| blocks.get(&(y * width + x)).copied()).flatten()
        };
        // counter-clockwise from the south-west, as corners of cells
        let corners = [[x, y + 1], [x + 1, y + 1], [x + 1, y], [x, y]];
        let places = corners.map(|corner| self.grid.corner_at(corner));
        builder.level(&places, span[1]);
        let below = [places[0], places[3], places[2], places[1]];
        builder.level(&below, span[0]);
        // heights at which something ends at a corner: walls have a vertex there, so that edges meet end to end
        let levels = corners.map(|[x, y]| {
            let around = [
                (x.checked_sub(1), y.checked_sub(1)),
                (Some(x), y.checked_sub(1)),
                (x.checked_sub(1), Some(y)),
                (Some(x), Some(y)),
            ];
            let mut levels: Vec<f64> = around.into_iter().filter_map(|(x, y)| at(x, y)).flatten().collect();
            levels.sort_by(f64::total_cmp);
            levels.dedup();
            levels
        });
        let beside =
            [(Some(x), Some(y + 1)), (Some(x + 1), Some(y)), (Some(x), y.checked_sub(1)), (x.checked_sub(1), Some(y))];
        for (side, (x, y)) in beside.into_iter().enumerate() {
            let open = match at(x, y) {
                None => vec![span],
                Some([low, high]) => {
                    vec![[span[0], span[1].min(low)], [span[0].max(high), span[1]]]
                }
            };
            let next = (side + 1) % 4;
            for [low, high] in open.into_iter().filter(|[low, high]| low < high) {
                let within = |levels: &[f64]| -> Vec<f64> {
                    levels.iter().copied().filter(|level| (low..=high).contains(level)).collect()
                };
                builder.wall([places[side], places[next]], [&within(&levels[side]), &within(&levels[next])]);
            }
        }
    }
}
