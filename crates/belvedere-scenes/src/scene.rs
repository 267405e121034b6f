//! Scene: the exact triangles that a simulated scanner sees.

use crate::vector::{add, cross, dot, scale, sub};

/// Material of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Material {
    /// Bare ground.
    Terrain,
    /// Sloped or flat roof.
    Roof,
    /// Wall of a building, and its underside below the ground.
    Facade,
    /// Outer hull of the leaves of a tree.
    TreeCrown,
    /// Stem of a tree.
    Trunk,
    /// One leaf, or a few on a twig, of a porous crown.
    Leaf,
    /// Slab to walk on or below, or its parapet: balcony, deck, canopy, ceiling of an arcade; also the parapet of a
    /// roof.
    Slab,
    /// Deck of a bridge, with its sides and underside.
    Bridge,
    /// Fence or garden wall.
    Fence,
    /// Mast or lamp post.
    Mast,
    /// Wire between masts.
    Wire,
    /// Parked car.
    Car,
}

impl Material {
    /// All materials.
    pub const ALL: [Self; 12] = [
        Self::Terrain,
        Self::Roof,
        Self::Facade,
        Self::TreeCrown,
        Self::Trunk,
        Self::Leaf,
        Self::Slab,
        Self::Bridge,
        Self::Fence,
        Self::Mast,
        Self::Wire,
        Self::Car,
    ];

    /// Returns the standard class of a laser point on this material (ASPRS LAS 1.4, table 17). Classes are 1
    /// unclassified, 2 ground, 5 high vegetation, 6 building, 14 wire conductor, 17 bridge deck.
    #[must_use]
    pub fn asprs_class(self) -> u8 {
        match self {
            Self::Terrain => 2,
            Self::Roof | Self::Facade | Self::Slab => 6,
            Self::TreeCrown | Self::Trunk | Self::Leaf => 5,
            Self::Bridge => 17,
            Self::Wire => 14,
            Self::Fence | Self::Mast | Self::Car => 1,
        }
    }

    /// Returns the lower-case name without blanks, as in the OBJ text.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Terrain => "terrain",
            Self::Roof => "roof",
            Self::Facade => "facade",
            Self::TreeCrown => "tree_crown",
            Self::Trunk => "trunk",
            Self::Leaf => "leaf",
            Self::Slab => "slab",
            Self::Bridge => "bridge",
            Self::Fence => "fence",
            Self::Mast => "mast",
            Self::Wire => "wire",
            Self::Car => "car",
        }
    }

    /// Returns the reflectance of a surface that faces the laser (near infrared), 0 to 1. Values are typical, only for
    /// plausible intensities.
    pub(crate) fn reflectance(self) -> f64 {
        match self {
            Self::Terrain => 0.25,
            Self::Roof => 0.2,
            Self::Facade => 0.35,
            Self::TreeCrown | Self::Leaf => 0.5,
            Self::Trunk | Self::Slab | Self::Bridge | Self::Fence => 0.3,
            Self::Mast | Self::Wire | Self::Car => 0.15,
        }
    }
}

/// Piece of surface with a material per triangle: the output of the shape functions and the input of
/// [`TriangleScene::add_object`].
#[derive(Clone, Debug, Default)]
pub struct ObjectPart {
    /// Vertices, (V, 3), metres, absolute.
    pub vertices: Vec<[f64; 3]>,
    /// Corners of each triangle, counter-clockwise seen from outside, (T, 3), indices into `vertices`.
    pub triangles: Vec<[u32; 3]>,
    /// Material of each triangle, (T).
    pub materials: Vec<Material>,
}

impl ObjectPart {
    /// Adds a flat convex polygon, corners counter-clockwise seen from outside, as a fan about its first corner.
    /// Corners may coincide: triangles without area are left out.
    pub(crate) fn add_polygon(&mut self, corners: &[usize], material: Material) {
        if let [first, rest @ ..] = corners {
            for edge in rest.windows(2).filter(|edge| edge[0] != edge[1] && !edge.contains(first)) {
                self.triangles.push([index_u32(*first), index_u32(edge[0]), index_u32(edge[1])]);
                self.materials.push(material);
            }
        }
    }

    /// Returns this surface with `material` on all triangles.
    #[must_use]
    pub fn with_material(mut self, material: Material) -> Self {
        self.materials.fill(material);
        self
    }

    /// Returns the enclosed volume, m³: positive for a closed surface whose triangles are counter-clockwise seen from
    /// outside. The value has no meaning for an open surface.
    #[must_use]
    pub fn volume(&self) -> f64 {
        // Measured from a vertex: from the zero of a projected grid the terms would be 1e16 m³ and cancel badly.
        let Some(&reference) = self.vertices.first() else { return 0.0 };
        let corner = |i: u32| self.vertices.get(i as usize).map_or([0.0; 3], |&v| sub(v, reference));
        self.triangles.iter().map(|&[a, b, c]| dot(corner(a), cross(corner(b), corner(c))) / 6.0).sum()
    }
}

/// Scene of triangles, grouped in named objects.
///
/// All objects except the terrain consist of closed solids, one part each; all leaves of a crown are one part. Solids
/// may overlap, as a trunk with its crown and neighbouring houses with each other. The terrain is a sheet that ends at
/// the edge of the scene.
#[derive(Clone, Debug, Default)]
pub struct TriangleScene {
    /// Vertices, (V, 3), metres, absolute (the projected frame, not local).
    pub vertices: Vec<[f64; 3]>,
    /// Corners of each triangle, counter-clockwise seen from outside, (T, 3), indices into `vertices`.
    pub triangles: Vec<[u32; 3]>,
    /// Material of each triangle, (T).
    pub materials: Vec<Material>,
    /// Object of each triangle, (T), index into `object_names`; the triangles of one object are neighbours.
    pub objects: Vec<u32>,
    /// Part of each triangle, (T), counted from 0 over all objects in the order of their addition. The triangles of one
    /// part are neighbours. Empty for a scene without parts.
    pub parts: Vec<u32>,
    /// Name of each object, such as `building 3`.
    pub object_names: Vec<String>,
}

impl TriangleScene {
    /// Adds an object made of `parts`.
    pub fn add_object(&mut self, name: impl Into<String>, parts: &[ObjectPart]) {
        let object = index_u32(self.object_names.len());
        self.object_names.push(name.into());
        let first_part = self.parts.last().map_or(0, |last| last + 1);
        for (part, number) in parts.iter().filter(|part| !part.triangles.is_empty()).zip(first_part..) {
            let first = index_u32(self.vertices.len());
            self.vertices.extend_from_slice(&part.vertices);
            self.triangles.extend(part.triangles.iter().map(|t| t.map(|corner| corner + first)));
            self.materials.extend_from_slice(&part.materials);
            self.objects.extend(std::iter::repeat_n(object, part.triangles.len()));
            self.parts.extend(std::iter::repeat_n(number, part.triangles.len()));
        }
    }

    /// Returns the ranges of triangles with the same object and part. Triangles of one part are neighbours.
    pub(crate) fn part_ranges(&self) -> Vec<std::ops::Range<usize>> {
        let key = |t: usize| (self.objects.get(t), self.parts.get(t));
        let mut ranges: Vec<std::ops::Range<usize>> = Vec::new();
        for t in 0..self.triangles.len() {
            match ranges.last_mut() {
                Some(range) if key(range.start) == key(t) => range.end = t + 1,
                _ => ranges.push(t..t + 1),
            }
        }
        ranges
    }

    /// Returns the corners of triangle `index`; `None` for a missing triangle or vertex.
    #[must_use]
    pub fn corners(&self, index: usize) -> Option<[[f64; 3]; 3]> {
        let [a, b, c] = *self.triangles.get(index)?;
        let vertex = |i: u32| self.vertices.get(i as usize).copied();
        Some([vertex(a)?, vertex(b)?, vertex(c)?])
    }

    /// Returns the lowest and highest corner of the box around all vertices; `None` without vertices.
    #[must_use]
    pub fn bounds(&self) -> Option<([f64; 3], [f64; 3])> {
        let first = *self.vertices.first()?;
        Some(self.vertices.iter().fold((first, first), |(low, high), v| {
            (std::array::from_fn(|i| low[i].min(v[i])), std::array::from_fn(|i| high[i].max(v[i])))
        }))
    }

    /// Returns the mean height of the terrain vertices, metres. Without terrain it is the mean of all vertices, and 0
    /// for an empty scene.
    #[must_use]
    pub fn mean_ground_height(&self) -> f64 {
        let mean = |corners: &mut dyn Iterator<Item = u32>| {
            let (sum, count) = corners
                .filter_map(|i| self.vertices.get(i as usize))
                .fold((0.0, 0_u32), |(sum, count), v| (sum + v[2], count + 1));
            (count > 0).then(|| sum / f64::from(count))
        };
        let ground = self.triangles.iter().zip(&self.materials).filter(|&(_, &m)| m == Material::Terrain);
        mean(&mut ground.flat_map(|(t, _)| *t))
            .or_else(|| mean(&mut self.triangles.iter().flat_map(|t| *t)))
            .unwrap_or(0.0)
    }
}

/// Returns the middle of two points.
pub(crate) fn middle(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    scale(add(a, b), 0.5)
}

#[expect(clippy::cast_possible_truncation, reason = "a scene of four billion vertices would not fit into memory")]
pub(crate) fn index_u32(index: usize) -> u32 {
    index as u32
}
