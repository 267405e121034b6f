//! Polygons of any shape, with or without holes, to the triangles of a [`Mesh`].

use std::path::Path;

use earcut::Earcut;

use crate::mesh::simple_faces::{crosses_itself, without_repeats};
use belvedere_data::vector::{cross, dot, length, sub};
use belvedere_data::{Error, Mesh, Result};

/// Coordinates beyond this are no place on earth in any unit; kept below, products of three never overflow.
const MAX_COORDINATE: f64 = 1e9;

/// Maximum ratio of the doubled area of a degenerate triangle to its longest edge squared. f64 coordinates of 1e6 m
/// determine a height over a 1 m edge to 1e-10 at best.
const DEGENERATE_AREA_RATIO: f64 = 1e-10;

/// Corners up to which no face takes longer than microseconds, whatever its shape.
const FEW_CORNERS: usize = 16;

/// A face that crosses itself is triangulated as well as that goes, in a time that grows with the cube of its corners.
/// More than this for all such faces of a file would take more than a few seconds.
const MAX_CROSSED_CUBES: f64 = 1e10;

/// Maximum number of corners of a face, in all its rings: the time grows with their square for a face that winds around
/// itself.
const MAX_CORNERS: usize = 20_000;

/// Counts of a mesh file: contents and parts left out.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct MeshReport {
    /// Polygons in the file, triangles included.
    pub polygon_count: usize,
    /// Triangles without area that were dropped.
    pub degenerate_triangle_count: usize,
    /// Polygons that gave no triangle at all: fewer than three distinct corners, or all in one line.
    pub degenerate_polygon_count: usize,
    /// Polygons that pass their corners so often that they can only turn around in themselves: each corner was kept
    /// once.
    pub repeated_polygon_count: usize,
    /// Geometries without surfaces (points, lines) or of an unknown kind that were passed over.
    pub skipped_geometry_count: usize,
    /// Geometries passed over for another level of detail of the same object.
    pub other_level_of_detail_count: usize,
}

/// Collects vertices and polygons of one file.
pub(crate) struct MeshBuilder<'a> {
    path: &'a Path,
    /// Line of the file that is being read, from 1, for messages; 0 in files without lines.
    pub(crate) line: usize,
    pub(crate) mesh: Mesh,
    pub(crate) report: MeshReport,
    earcut: Earcut<f64>,
    /// Sum of the cubes of the corners of faces that cross themselves.
    crossed_cubes: f64,
}

impl<'a> MeshBuilder<'a> {
    pub(crate) fn new(path: &'a Path) -> Self {
        Self {
            path,
            line: 0,
            mesh: Mesh::default(),
            report: MeshReport::default(),
            earcut: Earcut::new(),
            crossed_cubes: 0.0,
        }
    }

    /// An error that names the line.
    pub(crate) fn malformed(&self, what: impl std::fmt::Display) -> Error {
        match self.line {
            0 => Error::malformed(self.path, what.to_string()),
            line => Error::malformed(self.path, format!("line {line}: {what}")),
        }
    }

    /// Appends a vertex, metres; returns its index.
    ///
    /// # Errors
    /// [`Error::Malformed`] for coordinates that are not finite or lie beyond a million kilometres, and where u32
    /// indices run out.
    pub(crate) fn push_vertex(&mut self, vertex: [f64; 3]) -> Result<u32> {
        if !vertex.iter().all(|v| v.abs() < MAX_COORDINATE) {
            let what =
                format!("a vertex lies at {vertex:?}; coordinates must be numbers of metres below {MAX_COORDINATE:e}");
            return Err(self.malformed(what));
        }
        let index = u32::try_from(self.mesh.vertices.len())
            .map_err(|_| self.malformed("more than 4294967295 vertices; split the file"))?;
        self.mesh.vertices.push(vertex);
        Ok(index)
    }

    /// Starts an object of this name, or continues it where it was the last; returns its index.
    pub(crate) fn push_object(&mut self, name: &str) -> u32 {
        if self.mesh.object_names.last().is_none_or(|last| last != name) {
            self.mesh.object_names.push(name.to_owned());
        }
        u32::try_from(self.mesh.object_names.len() - 1).unwrap_or(u32::MAX)
    }

    /// Triangulates a polygon whose first ring is its outline and whose others are holes, (R, corners), and appends the
    /// triangles to `object` with the turning sense of the outline.
    ///
    /// # Errors
    /// [`Error::Malformed`] for an index without a vertex, for a polygon of more than 20 000 corners, and for those
    /// with many corners that cross themselves: they cannot be triangulated in bounded time.
    pub(crate) fn push_polygon(&mut self, rings: &[Vec<u32>], object: Option<u32>) -> Result<()> {
        self.report.polygon_count += 1;
        let mut corners: Vec<u32> = Vec::new();
        let mut hole_starts: Vec<u32> = Vec::new();
        let mut is_repeating = false;
        for (ring_index, ring) in rings.iter().enumerate() {
            if let Some(bad) = ring.iter().find(|&&i| i as usize >= self.mesh.vertices.len()) {
                let what = format!(
                    "polygon {} refers to vertex {bad} (from 0), but there are only {}",
                    self.report.polygon_count,
                    self.mesh.vertices.len()
                );
                return Err(self.malformed(what));
            }
            let start = corners.len();
            let (tail, is_repeated) = without_repeats(ring, &self.mesh.vertices);
            is_repeating |= is_repeated;
            if ring_index == 0 && tail.len() < 3 {
                self.report.degenerate_polygon_count += 1;
                return Ok(());
            }
            if tail.len() >= 3 {
                if ring_index > 0 {
                    hole_starts.push(u32::try_from(start).unwrap_or(u32::MAX));
                }
                corners.extend(tail);
            }
        }
        self.report.repeated_polygon_count += usize::from(is_repeating);
        let before = self.mesh.triangles.len();
        if let [a, b, c] = *corners {
            self.push_triangle([a, b, c], object);
        } else {
            self.push_triangulated(&corners, &hole_starts, object)?;
        }
        if self.mesh.triangles.len() == before {
            self.report.degenerate_polygon_count += 1;
        }
        Ok(())
    }

    fn push_triangulated(&mut self, corners: &[u32], hole_starts: &[u32], object: Option<u32>) -> Result<()> {
        if corners.len() > MAX_CORNERS {
            let what = format!("a face has {} corners; split it into faces of at most {MAX_CORNERS}", corners.len());
            return Err(self.malformed(what));
        }
        let outline_length = hole_starts.first().map_or(corners.len(), |&start| start as usize);
        let Some(flat) = flatten(&self.mesh.vertices, corners, outline_length) else { return Ok(()) };
        if corners.len() > FEW_CORNERS && crosses_itself(&flat, hole_starts) {
            self.crossed_cubes += (corners.len() as f64).powi(3);
            if self.crossed_cubes > MAX_CROSSED_CUBES {
                let number = self.report.polygon_count;
                let what = format!("face {number}, of {} corners, crosses itself; repair the mesh", corners.len());
                return Err(self.malformed(what));
            }
        }
        let mut triangles: Vec<u32> = Vec::new();
        self.earcut.earcut_slice(&flat, hole_starts, &mut triangles);
        for triangle in triangles.chunks_exact(3) {
            let [i, j, k] = [triangle[0] as usize, triangle[1] as usize, triangle[2] as usize];
            let area = (flat[j][0] - flat[i][0]) * (flat[k][1] - flat[i][1])
                - (flat[k][0] - flat[i][0]) * (flat[j][1] - flat[i][1]);
            // the plane is seen from where the outline turns counter-clockwise
            let ordered = if area >= 0.0 { [i, j, k] } else { [i, k, j] };
            self.push_triangle(ordered.map(|n| corners[n]), object);
        }
        Ok(())
    }

    fn push_triangle(&mut self, triangle: [u32; 3], object: Option<u32>) {
        let [a, b, c] = triangle.map(|i| self.mesh.vertices[i as usize]);
        let (ab, ac, bc) = (sub(b, a), sub(c, a), sub(c, b));
        let longest = dot(ab, ab).max(dot(ac, ac)).max(dot(bc, bc));
        let doubled_area = length(cross(ab, ac));
        if doubled_area > DEGENERATE_AREA_RATIO * longest {
            self.mesh.triangles.push(triangle);
            self.mesh.objects.extend(object);
        } else {
            self.report.degenerate_triangle_count += 1;
        }
    }

    /// The finished mesh.
    ///
    /// # Errors
    /// [`Error::Malformed`] where no triangle is left.
    pub(crate) fn finish(self) -> Result<(Mesh, MeshReport)> {
        if self.mesh.triangles.is_empty() {
            let what = match self.report.polygon_count {
                0 => "has no faces; export it as a mesh with faces".to_owned(),
                count => format!("has no triangle with an area among its {count} polygons"),
            };
            return Err(Error::malformed(self.path, what));
        }
        Ok((self.mesh, self.report))
    }
}

/// Coordinates of the corners in the plane of the outline (Newell's normal, which also suits concave and slightly bent
/// rings), or `None` where the outline has no area.
fn flatten(vertices: &[[f64; 3]], corners: &[u32], outline_length: usize) -> Option<Vec<[f64; 2]>> {
    let base = vertices[*corners.first()? as usize];
    let points: Vec<[f64; 3]> = corners.iter().map(|&i| sub(vertices[i as usize], base)).collect();
    let outline = points.get(..outline_length)?;
    let mut normal = [0.0; 3];
    for (i, &p) in outline.iter().enumerate() {
        let step = cross(p, outline[(i + 1) % outline.len()]);
        normal = std::array::from_fn(|axis| normal[axis] + step[axis]);
    }
    let size = length(normal);
    if !(size > 0.0 && size.is_finite()) {
        return None;
    }
    let normal = normal.map(|v| v / size);
    let min = if normal[2].abs() < 0.7 { [0.0, 0.0, 1.0] } else { [1.0, 0.0, 0.0] };
    let u = cross(min, normal);
    let u = u.map(|v| v / length(u));
    let v = cross(normal, u);
    Some(points.iter().map(|&p| [dot(u, p), dot(v, p)]).collect())
}
