//! A triangulated surface through the highest returns: the model that surveyors' software makes of a cloud.

use crate::lines_of_sight::check_positive;
use crate::mesh_rays::{MeshRays, MeshRaysParams};
use belvedere::query::{Sight, Viewer, Visibility};
use belvedere::{PointCloud, Result};
use delaunator::{Point, triangulate};
use std::collections::HashMap;
use std::collections::hash_map::Entry;

/// How a [`Tin`] is made and traced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TinParams {
    /// Side of the square cells of which each keeps its highest point, metres, above 0. Default 0.25: below the spacing
    /// of airborne scans, so that it takes out the lower of two points on one wall and little else.
    pub cell: f64,
    /// A triangle blocks only if it lies farther than this from the target, metres, 0 or more. Default 1: walls lean in
    /// a triangulation, by about a cell and a point spacing. On a simulated town of 11 points/m² (seed 7, not one that
    /// is reported) facade points 0.1 m off their wall are right 94.0 % of the time (balanced; 79.3 % at 0.1 m), roofs
    /// 94.3 % (95.5 %).
    pub clearance: f64,
}

impl Default for TinParams {
    fn default() -> Self {
        Self { cell: 0.25, clearance: 1.0 }
    }
}

/// A height field of triangles between the highest points, which block from both sides.
///
/// It ends at the convex hull of the points. A target or an eye below it is shut in.
pub struct Tin {
    rays: MeshRays,
}

impl Tin {
    /// Triangulates the first returns of `cloud`, or all its points where it knows no return numbers.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`](belvedere::Error::InvalidParameter) for a parameter out of its range.
    pub fn new(cloud: &PointCloud, params: &TinParams) -> Result<Self> {
        check_positive("cell of the triangulation", params.cell)?;
        let kept = highest_per_cell(cloud, params.cell);
        let points: Vec<Point> = kept.iter().map(|p| Point { x: p[0], y: p[1] }).collect();
        let corners = triangulate(&points).triangles;
        let triangles = corners.as_chunks::<3>().0.iter().map(|t| t.map(|corner| kept[corner])).collect();
        let rays = MeshRays::from_local_triangles(triangles, &MeshRaysParams { clearance: params.clearance })?;
        Ok(Self { rays })
    }

    /// The triangles as something rays are traced against.
    #[must_use]
    pub fn rays(&self) -> &MeshRays {
        &self.rays
    }
}

impl Visibility for Tin {
    fn seen_from<'a>(&'a self, viewer: Viewer<'a>) -> Result<Sight<'a>> {
        self.rays.seen_from(viewer)
    }
}

/// The highest first return of each cell, the first of equally high ones, in the order of the cloud.
fn highest_per_cell(cloud: &PointCloud, cell: f64) -> Vec<[f64; 3]> {
    let returns = cloud.attributes.return_number.as_deref();
    let mut highest: HashMap<[i64; 2], usize> = HashMap::new();
    for (index, &[x, y, z]) in cloud.positions.iter().enumerate() {
        let is_first = returns.and_then(|numbers| numbers.get(index)).is_none_or(|&number| number <= 1);
        if !is_first || ![x, y, z].iter().all(|v| v.is_finite()) {
            continue;
        }
        #[expect(clippy::cast_possible_truncation, reason = "saturates far beyond any place on Earth")]
        let key = [x, y].map(|v| (f64::from(v) / cell).floor() as i64);
        match highest.entry(key) {
            Entry::Vacant(entry) => drop(entry.insert(index)),
            Entry::Occupied(mut entry) if z > cloud.positions[*entry.get()][2] => drop(entry.insert(index)),
            Entry::Occupied(_) => {}
        }
    }
    let mut kept: Vec<usize> = highest.into_values().collect();
    kept.sort_unstable();
    kept.into_iter().map(|index| cloud.positions[index].map(f64::from)).collect()
}
