//! Triangles that block lines of sight beside the balls: of added meshes, such as planned buildings, and of surface
//! patches that are known from the survey.

use super::{Blocker, Coverage};
use crate::blocking::{CONTACT, PATCH_DEPTH, Sheet};
use crate::ground::MapGrid;
use crate::ray_index::{Ray, RayIndex};
use crate::triangle_tree::{Corners, TriangleTree};
use belvedere_data::frame::FARTHEST;
use belvedere_data::raster::Raster;
use belvedere_data::vector::{cross, dot, sub, to_f32, unit};
use belvedere_data::{Error, Mesh, Parameter, Result, SurfacePatches};
use std::sync::Arc;

/// Coordinates up to which a mesh may be in degrees rather than metres.
const MAX_DEGREES: f64 = 360.0;

/// Triangles that block lines of sight, from both sides, watertight or not: of added meshes and of surface patches.
///
/// A triangle blocks a line of sight that passes through it, edges included, unless an end of the line lies on it
/// ([`Sheet`]). That is within 1 mm of the plane of a mesh, and up to 0.15 m behind that of a patch. A target on a roof
/// or a wall is therefore not hidden by that roof or wall. An eye inside a closed mesh sees its inside and nothing
/// beyond it.
#[derive(Clone)]
pub struct BlockingTriangles {
    tree: Arc<TriangleTree>,
    /// For each triangle of the tree.
    faces: Arc<[Face]>,
    /// Names of the meshes.
    names: Arc<[String]>,
}

impl std::fmt::Debug for BlockingTriangles {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "BlockingTriangles({} triangles, meshes {:?})", self.faces.len(), self.names)
    }
}

/// Properties of a triangle beside its corners.
#[derive(Clone, Copy)]
struct Face {
    sheet: Sheet,
    /// Mesh or patch that it belongs to.
    blocker: Blocker,
}

/// The ends of a line of sight.
#[derive(Clone, Copy)]
pub(super) struct LineEnds {
    pub(super) target: [f64; 3],
    /// `None` for a viewer infinitely far away.
    pub(super) viewer: Option<[f64; 3]>,
}

impl BlockingTriangles {
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
        let invalid = |value: String, expected| Err(Error::invalid(Parameter::AddedMesh, value, expected));
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
        let blocker = Blocker::Mesh(names.len());
        names.push(name.to_owned());
        let mut triangles: Vec<(Corners, Blocker)> = before.map_or(Vec::new(), |before| before.labelled().collect());
        triangles.extend(added.into_iter().map(|corners| (corners, blocker)));
        Self::of_triangles(&triangles, names)
    }

    /// The triangles of `patches` beside the meshes of `before`, whose own patches are left out; `None` without any.
    ///
    /// # Errors
    /// Those of [`SurfacePatches::validate`].
    pub fn of_patches(patches: &SurfacePatches, before: Option<&Self>) -> Result<Option<Self>> {
        patches.validate()?;
        let of_patch = patches.iter().map(|(corners, kind)| (corners.map(|p| p.map(f64::from)), Blocker::Patch(kind)));
        let mut triangles: Vec<(Corners, Blocker)> =
            of_patch.filter(|(corners, _)| normal(corners).is_some()).collect();
        let of_meshes = before.into_iter().flat_map(Self::labelled);
        triangles.extend(of_meshes.filter(|(_, blocker)| blocker.mesh().is_some()));
        let names = before.map_or(Vec::new(), |before| before.names.to_vec());
        if triangles.is_empty() { Ok(None) } else { Self::of_triangles(&triangles, names).map(Some) }
    }

    fn of_triangles(triangles: &[(Corners, Blocker)], names: Vec<String>) -> Result<Self> {
        let corners: Vec<Corners> = triangles.iter().map(|(corners, _)| *corners).collect();
        let tree = TriangleTree::new(&corners)?;
        let face = |(&row, corners): (&u32, &Corners)| {
            let blocker = triangles.get(row as usize).map_or(Blocker::Mesh(0), |(_, blocker)| *blocker);
            let depth = if blocker.patch().is_some() { PATCH_DEPTH } else { CONTACT };
            let normal = normal(corners).unwrap_or_default();
            Face { sheet: Sheet { normal, corner: corners[0], depth }, blocker }
        };
        let faces = tree.order().iter().zip(tree.triangles()).map(face).collect();
        Ok(Self { tree: Arc::new(tree), faces, names: names.into() })
    }

    fn labelled(&self) -> impl Iterator<Item = (Corners, Blocker)> + '_ {
        self.tree.triangles().iter().zip(self.faces.iter()).map(|(corners, face)| (*corners, face.blocker))
    }

    /// Corners of the triangles, local metres, and the obstacle of each.
    pub fn triangles(&self) -> impl Iterator<Item = (&Corners, Blocker)> {
        self.tree.triangles().iter().zip(self.faces.iter()).map(|(corners, face)| (corners, face.blocker))
    }

    /// Removes the triangles of meshes for whose middles, local metres, `is_cleared` is true; `None` if none is left.
    /// Patches stay.
    ///
    /// # Errors
    /// Those of [`TriangleTree::new`].
    pub fn without(&self, is_cleared: impl Fn([f64; 3]) -> bool) -> Result<Option<Self>> {
        let middle =
            |corners: &Corners| std::array::from_fn(|i| corners.iter().map(|corner| corner[i]).sum::<f64>() / 3.0);
        let stays = |(corners, blocker): &(Corners, Blocker)| blocker.mesh().is_none() || !is_cleared(middle(corners));
        let left: Vec<(Corners, Blocker)> = self.labelled().filter(stays).collect();
        if left.is_empty() { Ok(None) } else { Self::of_triangles(&left, self.names.to_vec()).map(Some) }
    }

    /// Returns true if any triangle is one of an added mesh.
    #[must_use]
    pub fn has_meshes(&self) -> bool {
        self.faces.iter().any(|face| face.blocker.mesh().is_some())
    }

    /// Names of the meshes, in the order in which they were added.
    #[must_use]
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Height of the highest mesh above a place on the map, local metres; `None` where there is none.
    #[must_use]
    pub fn top_at(&self, place: [f64; 2]) -> Option<f64> {
        let [low, high] = self.tree.bounds()?;
        let (start, depth) = (high[2] + 1.0, high[2] - low[2] + 1.0);
        let down = Ray { origin: [place[0], place[1], start], direction: [0.0, 0.0, -1.0], ranges: [0.0, depth] };
        let (_, range) = self.tree.nearest(&down, |row| self.is_of_mesh(row))?;
        Some(start - range)
    }

    /// Raises `heights`, local metres at the cells of `grid`, to the highest mesh above the middle of each cell.
    pub fn raise(&self, heights: &mut Raster<f32>, grid: &MapGrid) {
        for (cell, height) in heights.values_mut().iter_mut().enumerate() {
            let Some(top) = self.top_at(grid.center(cell % grid.width, cell / grid.width)) else { continue };
            let top = to_f32(top);
            if !(*height >= top) {
                *height = top;
            }
        }
    }

    /// Returns true if a place, local metres, lies inside a mesh. Rays upward, to the east and to the north must each
    /// cross an odd number of surfaces. The mesh may lack its bottom.
    #[must_use]
    pub fn encloses(&self, place: [f64; 3]) -> bool {
        if !place.iter().all(|v| v.is_finite()) {
            return false;
        }
        let is_inside = |mesh: Blocker| {
            [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].into_iter().all(|direction| {
                let ray = Ray { origin: place, direction, ranges: [0.0, f64::INFINITY] };
                self.passages(&ray).iter().filter(|passage| passage.0 == mesh).count() % 2 == 1
            })
        };
        let up = Ray { origin: place, direction: [0.0, 0.0, 1.0], ranges: [0.0, f64::INFINITY] };
        let mut above: Vec<Blocker> = self.passages(&up).into_iter().map(|(blocker, _)| blocker).collect();
        above.dedup();
        above.into_iter().filter(|blocker| blocker.mesh().is_some()).any(is_inside)
    }

    /// Returns true if a triangle blocks the line of sight from `target` to `range` metres (infinite for a direction)
    /// along the unit vector `towards`.
    #[must_use]
    pub fn blocks(&self, target: [f64; 3], towards: [f64; 3], range: f64) -> bool {
        let ray = Ray { origin: target, direction: towards, ranges: [0.0, range] };
        let ends = LineEnds { target, viewer: range.is_finite().then(|| ray.at(range)) };
        self.blocks_piece(&ray, &ends)
    }

    /// Calls `visit(index)` for each line of sight that a triangle blocks, as [`BlockingTriangles::blocks`] finds it.
    /// The lines start at `targets`, neighbours in space, and run along the unit vector `towards` without end.
    pub(super) fn each_blocked(&self, targets: &[[f64; 3]], towards: [f64; 3], mut visit: impl FnMut(usize)) {
        self.tree.any_of(targets, towards, |number, row| {
            let blocks = self.is_between(row, &LineEnds { target: targets[number], viewer: None });
            if blocks {
                visit(number);
            }
            blocks
        });
    }

    /// Returns true if a triangle blocks the piece `ray` of a line of sight between `ends`.
    pub(super) fn blocks_piece(&self, ray: &Ray, ends: &LineEnds) -> bool {
        self.tree.any(ray, |row| self.is_between(row, ends))
    }

    /// The range at which a line of sight that begins where `ray` does meets a triangle first.
    pub(crate) fn first_range(&self, ray: &Ray) -> Option<f64> {
        self.nearest(ray, &LineEnds { target: ray.origin, viewer: None }).map(|(_, range)| range)
    }

    /// Returns the last obstacle on the piece `ray` of a line of sight between `ends`, and its range.
    pub(super) fn farthest(&self, ray: &Ray, ends: &LineEnds) -> Option<(Blocker, f64)> {
        let mut last: Option<(usize, f64)> = None;
        self.tree.each(ray, |row, range| {
            if self.is_between(row, ends) && last.is_none_or(|(_, farthest)| range > farthest) {
                last = Some((row, range));
            }
        });
        let (row, range) = last?;
        Some((self.faces.get(row)?.blocker, range))
    }

    /// Returns the first obstacle on the piece `ray` of a line of sight between `ends`, and its range.
    pub(super) fn nearest(&self, ray: &Ray, ends: &LineEnds) -> Option<(Blocker, f64)> {
        let (row, range) = self.tree.nearest(ray, |row| self.is_between(row, ends))?;
        Some((self.faces.get(row)?.blocker, range))
    }

    /// Returns the same obstacle with the unit normal of its triangle towards the beginning of the line.
    pub(super) fn nearest_face(&self, ray: &Ray, ends: &LineEnds) -> Option<((Blocker, f64), [f64; 3])> {
        let (row, range) = self.tree.nearest(ray, |row| self.is_between(row, ends))?;
        let [a, b, c] = *self.tree.triangles().get(row)?;
        let normal = unit(cross(sub(b, a), sub(c, a))).unwrap_or(ray.direction.map(|v| -v));
        let is_turned = dot(normal, ray.direction) > 0.0;
        Some(((self.faces.get(row)?.blocker, range), normal.map(|v| if is_turned { -v } else { v })))
    }

    /// The triangles that the piece `ray` of a line of sight between `ends` passes through.
    pub(super) fn each_blocking(&self, ray: &Ray, ends: &LineEnds, mut visit: impl FnMut(&Corners, &Sheet)) {
        self.tree.each(ray, |row, _| {
            if self.is_between(row, ends)
                && let (Some(corners), Some(face)) = (self.tree.triangles().get(row), self.faces.get(row))
            {
                visit(corners, &face.sheet);
            }
        });
    }

    /// The triangles between `ends` whose boxes may meet one of `boxes`, given by their lowest and highest corner,
    /// local metres; each once.
    pub(super) fn triangles_near(
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

    /// Returns the surfaces that a line passes through, each with its range, sorted by both.
    pub(super) fn passages(&self, ray: &Ray) -> Vec<(Blocker, f64)> {
        let mut passages = Vec::new();
        self.tree.each(ray, |row, range| {
            passages.extend(self.faces.get(row).map(|face| (face.blocker, range)));
        });
        passages.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        // on an edge that two triangles share both are met
        passages.dedup_by(|a, b| a.0 == b.0 && a.1 - b.1 < CONTACT);
        passages
    }

    /// The triangles that do not give way to `eye`, and their obstacles.
    pub(super) fn triangles_before(&self, eye: [f64; 3]) -> impl Iterator<Item = (Corners, Blocker)> + '_ {
        let seen = move |(_, face): &(&Corners, &Face)| !face.sheet.gives_way_to(eye);
        let faces = self.tree.triangles().iter().zip(self.faces.iter()).filter(seen);
        faces.map(|(corners, face)| (*corners, face.blocker))
    }

    /// The tree of boxes around the triangles.
    pub(super) fn index(&self) -> &RayIndex {
        self.tree.index()
    }

    /// The corners of a triangle of the tree; `None` if it gives way to `eye`.
    pub(super) fn corners_before(&self, eye: [f64; 3], row: usize) -> Option<&Corners> {
        self.faces.get(row).filter(|face| !face.sheet.gives_way_to(eye))?;
        self.tree.triangles().get(row)
    }

    /// Lowest and highest corner of all triangles.
    pub(super) fn bounds(&self) -> [[f64; 3]; 2] {
        self.tree.bounds().unwrap_or([[f64::NAN; 3]; 2])
    }

    fn is_of_mesh(&self, row: usize) -> bool {
        self.faces.get(row).is_some_and(|face| face.blocker.mesh().is_some())
    }

    fn is_between(&self, row: usize, ends: &LineEnds) -> bool {
        let gives_way = |end: [f64; 3]| self.faces.get(row).is_none_or(|face| face.sheet.gives_way_to(end));
        !gives_way(ends.target) && !ends.viewer.is_some_and(gives_way)
    }
}

fn normal([a, b, c]: &Corners) -> Option<[f64; 3]> {
    unit(cross(sub(*b, *a), sub(*c, *a)))
}
