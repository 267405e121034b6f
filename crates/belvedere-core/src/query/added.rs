//! Meshes that were added to a scene, such as planned buildings: their triangles block lines of sight exactly, beside
//! the balls.

use super::Coverage;
use crate::ground::MapGrid;
use crate::ray_index::Ray;
use crate::triangle_tree::{Corners, TriangleTree};
use belvedere_data::model::FARTHEST;
use belvedere_data::raster::Raster;
use belvedere_data::vector::{cross, dot, sub, unit};
use belvedere_data::{Error, Mesh, Parameter, Result};
use std::sync::Arc;

/// Distance from the plane of a triangle up to which an end of a line of sight lies on the triangle, metres: targets
/// are f32, which is off by 0.1 mm a kilometre from the origin, and a target on a triangle must not be hidden by it.
const CONTACT: f64 = 1e-3;
/// Coordinates up to which a mesh may be in degrees rather than metres.
const MAX_DEGREES: f64 = 360.0;

/// Triangles of meshes that block lines of sight, from both sides, watertight or not.
///
/// A triangle blocks a line of sight that passes through it, edges included, unless an end of the line lies on it:
/// within 1 mm of its plane. So a target on a roof or a wall is not hidden by that roof or wall, and an eye inside a
/// closed mesh sees its inside and nothing beyond it.
#[derive(Clone)]
pub struct AddedMeshes {
    tree: Arc<TriangleTree>,
    /// For each triangle of the tree.
    faces: Arc<[AddedFace]>,
    names: Arc<[String]>,
}

impl std::fmt::Debug for AddedMeshes {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "AddedMeshes({} triangles of {:?})", self.faces.len(), self.names)
    }
}

/// What is known of a triangle beside its corners.
#[derive(Clone, Copy)]
struct AddedFace {
    normal: [f64; 3],
    corner: [f64; 3],
    mesh: u32,
}

/// The ends of a line of sight.
#[derive(Clone, Copy)]
pub(super) struct LineEnds {
    pub(super) target: [f64; 3],
    /// `None` for a viewer infinitely far away.
    pub(super) viewer: Option<[f64; 3]>,
}

impl AddedMeshes {
    /// The triangles of `mesh`, metres of its reference system, called `name`, beside those of `before`, for local
    /// positions relative to `origin`.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a mesh without a triangle that has an area, with a corner that is missing or not
    /// finite, or that does not meet the space of `coverage`.
    pub fn new(
        mesh: &Mesh,
        name: &str,
        origin: [f64; 3],
        coverage: Option<&Coverage>,
        before: Option<&Self>,
    ) -> Result<Self> {
        let invalid =
            |value: String, expected| Err(Error::InvalidParameter { parameter: Parameter::AddedMesh, value, expected });
        let mut added: Vec<Corners> = Vec::with_capacity(mesh.triangles.len());
        for number in 0..mesh.triangles.len() {
            let Some(corners) = mesh.corners(number) else {
                return invalid(format!("{name}, of which triangle {number} lacks a vertex"), "complete");
            };
            let local = corners.map(|corner| sub(corner, origin));
            if !corners.as_flattened().iter().all(|v| v.is_finite()) {
                return invalid(format!("{name}, of which triangle {number} has a corner at {corners:?}"), "finite");
            }
            added.push(local);
        }
        added.retain(|corners| normal(corners).is_some());
        let tree = TriangleTree::new(&added)?;
        let Some([low, high]) = tree.bounds() else {
            return invalid(format!("{name}, without a triangle that has an area"), "a mesh with triangles");
        };
        let is_near = [low, high].as_flattened().iter().all(|v| v.abs() < f64::from(FARTHEST));
        if !is_near || coverage.is_some_and(|coverage| !coverage.meets(low, high)) {
            let file = |corner: [f64; 3]| corner.map(|v| (v * 10.0).round() / 10.0);
            let [from, to] = [low, high].map(|corner| file(std::array::from_fn(|i| corner[i] + origin[i])));
            let cloud = coverage.map_or(String::new(), |coverage| {
                let (low, high) = coverage.bounds().corners();
                let [from, to] = [low, high].map(|corner| file(std::array::from_fn(|i| corner[i] + origin[i])));
                format!(" while the cloud lies between {from:?} and {to:?} m")
            });
            let value = format!("{name}, which lies between {from:?} and {to:?} m,{cloud}");
            let in_degrees = from.iter().chain(&to).take(2).all(|v| v.abs() <= MAX_DEGREES);
            return match in_degrees {
                true => invalid(value, "in the coordinates of the cloud, on or above it; degrees must be converted"),
                false => invalid(value, "in the coordinates of the cloud, on or above it"),
            };
        }
        let mut names: Vec<String> = before.map_or(Vec::new(), |before| before.names.to_vec());
        #[expect(clippy::cast_possible_truncation, reason = "meshes are numbered with 32 bits")]
        let number = names.len() as u32;
        names.push(name.to_owned());
        let mut triangles: Vec<(Corners, u32)> = before.map_or(Vec::new(), |before| before.numbered().collect());
        triangles.extend(added.into_iter().map(|corners| (corners, number)));
        Self::of_triangles(&triangles, names)
    }

    fn of_triangles(triangles: &[(Corners, u32)], names: Vec<String>) -> Result<Self> {
        let corners: Vec<Corners> = triangles.iter().map(|(corners, _)| *corners).collect();
        let tree = TriangleTree::new(&corners)?;
        let face = |(&row, corners): (&u32, &Corners)| {
            let mesh = triangles.get(row as usize).map_or(0, |(_, mesh)| *mesh);
            AddedFace { normal: normal(corners).unwrap_or_default(), corner: corners[0], mesh }
        };
        let faces = tree.order().iter().zip(tree.triangles()).map(face).collect();
        Ok(Self { tree: Arc::new(tree), faces, names: names.into() })
    }

    fn numbered(&self) -> impl Iterator<Item = (Corners, u32)> + '_ {
        self.tree.triangles().iter().zip(self.faces.iter()).map(|(corners, face)| (*corners, face.mesh))
    }

    /// Corners of the triangles, local metres, (T, 3, 3).
    #[must_use]
    pub fn triangles(&self) -> &[Corners] {
        self.tree.triangles()
    }

    /// These meshes without the triangles for whose middles, local metres, `is_cleared` is true; `None` where none is
    /// left.
    ///
    /// # Errors
    /// Those of [`TriangleTree::new`].
    pub fn without(&self, is_cleared: impl Fn([f64; 3]) -> bool) -> Result<Option<Self>> {
        let middle =
            |corners: &Corners| std::array::from_fn(|i| corners.iter().map(|corner| corner[i]).sum::<f64>() / 3.0);
        let left: Vec<(Corners, u32)> = self.numbered().filter(|(corners, _)| !is_cleared(middle(corners))).collect();
        if left.is_empty() { Ok(None) } else { Self::of_triangles(&left, self.names.to_vec()).map(Some) }
    }

    /// Names of the meshes, in the order in which they were added.
    #[must_use]
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Height of the highest triangle above a place on the map, local metres; `None` where there is none.
    #[must_use]
    pub fn top_at(&self, place: [f64; 2]) -> Option<f64> {
        let [low, high] = self.tree.bounds()?;
        let (start, depth) = (high[2] + 1.0, high[2] - low[2] + 1.0);
        let down = Ray { origin: [place[0], place[1], start], direction: [0.0, 0.0, -1.0], ranges: [0.0, depth] };
        let (_, range) = self.tree.nearest(&down, |_| true)?;
        Some(start - range)
    }

    /// Raises `heights`, local metres at the cells of `grid`, to the highest triangle above the middle of each cell.
    pub fn raise(&self, heights: &mut Raster<f32>, grid: &MapGrid) {
        for (cell, height) in heights.values_mut().iter_mut().enumerate() {
            let Some(top) = self.top_at(grid.center(cell % grid.width, cell / grid.width)) else { continue };
            #[expect(clippy::cast_possible_truncation, reason = "local heights are f32")]
            let top = top as f32;
            if !(*height >= top) {
                *height = top;
            }
        }
    }

    /// Whether a place, local metres, lies inside a mesh, which may lack its bottom: lines up, east and north pass
    /// through an odd number of surfaces each.
    #[must_use]
    pub fn encloses(&self, place: [f64; 3]) -> bool {
        if !place.iter().all(|v| v.is_finite()) {
            return false;
        }
        let is_inside = |mesh: usize| {
            [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].into_iter().all(|direction| {
                let ray = Ray { origin: place, direction, ranges: [0.0, f64::INFINITY] };
                self.passages(&ray).iter().filter(|passage| passage.0 == mesh).count() % 2 == 1
            })
        };
        let up = Ray { origin: place, direction: [0.0, 0.0, 1.0], ranges: [0.0, f64::INFINITY] };
        let mut above: Vec<usize> = self.passages(&up).into_iter().map(|(mesh, _)| mesh).collect();
        above.dedup();
        above.into_iter().any(is_inside)
    }

    /// Whether a triangle blocks the line of sight from `target` to `range` metres (infinite for a direction) along the
    /// unit vector `towards`.
    #[must_use]
    pub fn blocks(&self, target: [f64; 3], towards: [f64; 3], range: f64) -> bool {
        let ray = Ray { origin: target, direction: towards, ranges: [0.0, range] };
        let ends = LineEnds { target, viewer: range.is_finite().then(|| ray.at(range)) };
        self.blocks_piece(&ray, &ends)
    }

    /// Whether a triangle blocks the piece `ray` of a line of sight between `ends`.
    pub(super) fn blocks_piece(&self, ray: &Ray, ends: &LineEnds) -> bool {
        self.tree.any(ray, |row| self.is_between(row, ends))
    }

    /// The mesh that the piece `ray` of a line of sight between `ends` meets last, by its number, and the range.
    pub(super) fn farthest(&self, ray: &Ray, ends: &LineEnds) -> Option<(usize, f64)> {
        let mut last: Option<(usize, f64)> = None;
        self.tree.each(ray, |row, range| {
            if self.is_between(row, ends) && last.is_none_or(|(_, farthest)| range > farthest) {
                last = Some((row, range));
            }
        });
        let (row, range) = last?;
        Some((self.faces.get(row)?.mesh as usize, range))
    }

    /// The mesh that the piece `ray` of a line of sight between `ends` meets first, by its number, and the range.
    pub(super) fn nearest(&self, ray: &Ray, ends: &LineEnds) -> Option<(usize, f64)> {
        let (row, range) = self.tree.nearest(ray, |row| self.is_between(row, ends))?;
        Some((self.faces.get(row)?.mesh as usize, range))
    }

    /// The triangles that the piece `ray` of a line of sight between `ends` passes through.
    pub(super) fn each_blocking(&self, ray: &Ray, ends: &LineEnds, mut visit: impl FnMut(&Corners)) {
        self.tree.each(ray, |row, _| {
            if self.is_between(row, ends)
                && let Some(corners) = self.tree.triangles().get(row)
            {
                visit(corners);
            }
        });
    }

    /// The triangles between `ends` whose boxes may meet one of `boxes`, given by their lowest and highest corner,
    /// local metres; each once.
    pub(super) fn near(
        &self,
        boxes: impl Iterator<Item = [[f64; 3]; 2]>,
        ends: &LineEnds,
    ) -> impl Iterator<Item = &Corners> {
        let mut rows = Vec::new();
        boxes.for_each(|[low, high]| self.tree.each_near(low, high, |row| rows.push(row)));
        rows.sort_unstable();
        rows.dedup();
        rows.retain(|&row| self.is_between(row, ends));
        rows.into_iter().filter_map(|row| self.tree.triangles().get(row))
    }

    /// Where a line passes through surfaces, by the number of the mesh and the range, in this order.
    pub(super) fn passages(&self, ray: &Ray) -> Vec<(usize, f64)> {
        let mut passages = Vec::new();
        self.tree.each(ray, |row, range| {
            passages.extend(self.faces.get(row).map(|face| (face.mesh as usize, range)));
        });
        passages.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        // on an edge that two triangles share both are met
        passages.dedup_by(|a, b| a.0 == b.0 && a.1 - b.1 < CONTACT);
        passages
    }

    /// The triangles in whose planes `eye` does not lie, with the numbers of their meshes.
    pub(super) fn before(&self, eye: [f64; 3]) -> impl Iterator<Item = (Corners, usize)> + '_ {
        let seen = move |(_, face): &(&Corners, &AddedFace)| !face.touches(eye);
        let faces = self.tree.triangles().iter().zip(self.faces.iter()).filter(seen);
        faces.map(|(corners, face)| (*corners, face.mesh as usize))
    }

    /// Lowest and highest corner of all triangles.
    pub(super) fn bounds(&self) -> [[f64; 3]; 2] {
        self.tree.bounds().unwrap_or([[f64::NAN; 3]; 2])
    }

    fn is_between(&self, row: usize, ends: &LineEnds) -> bool {
        let touches = |end: [f64; 3]| self.faces.get(row).is_none_or(|face| face.touches(end));
        !touches(ends.target) && !ends.viewer.is_some_and(touches)
    }
}

impl AddedFace {
    fn touches(&self, place: [f64; 3]) -> bool {
        dot(self.normal, sub(place, self.corner)).abs() <= CONTACT
    }
}

fn normal([a, b, c]: &Corners) -> Option<[f64; 3]> {
    unit(cross(sub(*b, *a), sub(*c, *a)))
}
