//! LoD1 model of a town, as in 3D city models: upright blocks over footprints and no other shapes.

use std::collections::{BTreeMap, HashMap};
use std::ops::Range;

use crate::scene::{Material, ObjectPart, TriangleScene, index_u32};
use crate::vector::{cross, length, sub};

/// Share of the roof area that lies below the top of a block.
///
/// # Source
/// 3D BAG (Peters et al. 2022, "Automated 3D reconstruction of LoD2 and LoD1 models for all 10 million buildings of the
/// Netherlands", PE&RS 88(3)): its LoD1.2 and 1.3 blocks end at the 70th percentile of the roof.
const ROOF_SHARE: f64 = 0.7;
/// Minimum cosine between a face's normal and straight down for a face of the footprint.
const DOWNWARD: f64 = 0.5;
/// Side of the cells for look-ups of the ground, metres.
const CELL: f64 = 8.0;

/// Returns the scene generalised to LoD1: the terrain, and a prism for each part of a building that stands on the
/// ground.
///
/// A prism stands on the footprint of its part. It rises from the bottom of the part to the height that 70 % of the
/// roof area lies below. The area is seen from above and includes eaves. Dormers and other parts with a roof on the
/// footprint count too, and so does the roof beneath them.
///
/// A building is an object with faces of [`Material::Roof`]. Parts that do not stand in the ground, overhanging parts
/// and other objects are left out: balconies, decks, canopies, bridges, trees, cars, fences, masts, wires. Floors over
/// arcades belong to the footprint. Objects keep their names; objects without remaining parts are left out. Without
/// terrain, every part with a roof counts as standing on the ground.
///
/// The function needs [`TriangleScene::parts`]; without them each object counts as one part.
#[must_use]
pub fn blocks(scene: &TriangleScene) -> TriangleScene {
    let ground = TerrainLookup::new(scene);
    let mut objects: BTreeMap<u32, Vec<Range<usize>>> = BTreeMap::new();
    for range in scene.part_ranges() {
        let object = scene.objects.get(range.start).copied().unwrap_or(0);
        objects.entry(object).or_default().push(range);
    }
    let mut generalised = TriangleScene::default();
    for (object, ranges) in objects {
        let mut parts = Vec::new();
        let mut standing = Vec::new();
        let mut on_top = Vec::new();
        for range in ranges {
            if range.clone().all(|t| scene.materials.get(t) == Some(&Material::Terrain)) {
                parts.push(copy(scene, range));
                continue;
            }
            let roof: Vec<[[f64; 3]; 3]> = range.clone().filter_map(|t| roof_corners(scene, t)).collect();
            let corners = range.clone().filter_map(|t| scene.corners(t)).flatten();
            let Some(lowest) = corners.min_by(|a, b| a[2].total_cmp(&b[2])) else { continue };
            if roof.is_empty() {
                continue;
            }
            if ground.height(lowest).is_none_or(|ground| lowest[2] < ground) {
                standing.push((PartOutline::new(scene, range), lowest[2], roof));
            } else {
                on_top.extend(roof);
            }
        }
        for (footprint, bottom, mut roof) in standing {
            roof.extend(on_top.iter().filter(|corners| footprint.contains(centroid(corners))));
            let block = footprint.prism(bottom, height_below_which(&roof, ROOF_SHARE));
            if !block.triangles.is_empty() {
                parts.push(block);
            }
        }
        if !parts.is_empty() {
            let name = scene.object_names.get(object as usize).map_or("unnamed", String::as_str);
            generalised.add_object(name, &parts);
        }
    }
    generalised
}

/// Copies the triangles of `range` into a new part.
fn copy(scene: &TriangleScene, range: Range<usize>) -> ObjectPart {
    let mut part = ObjectPart::default();
    let mut vertices = HashMap::new();
    for t in range {
        let (Some(&triangle), Some(corners)) = (scene.triangles.get(t), scene.corners(t)) else { continue };
        let numbers: Vec<usize> = triangle
            .iter()
            .zip(corners)
            .map(|(&vertex, position)| {
                *vertices.entry(vertex).or_insert_with(|| {
                    part.vertices.push(position);
                    part.vertices.len() - 1
                })
            })
            .collect();
        part.add_polygon(&numbers, Material::Terrain);
    }
    part
}

/// Returns the corners of triangle `t` if it is roof and faces upward.
fn roof_corners(scene: &TriangleScene, t: usize) -> Option<[[f64; 3]; 3]> {
    let corners = scene.corners(t).filter(|_| scene.materials.get(t) == Some(&Material::Roof))?;
    (upward_area(&corners) > 0.0).then_some(corners)
}

/// Returns the area seen from above, m²; negative for faces that look down.
fn upward_area([a, b, c]: &[[f64; 3]; 3]) -> f64 {
    ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2.0
}

fn centroid(corners: &[[f64; 3]; 3]) -> [f64; 2] {
    [0, 1].map(|axis| corners.iter().map(|corner| corner[axis]).sum::<f64>() / 3.0)
}

/// Returns the height below which the given share of the triangles lies, metres, by area seen from above. NaN without
/// triangles.
fn height_below_which(triangles: &[[[f64; 3]; 3]], share: f64) -> f64 {
    let heights = || triangles.iter().flatten().map(|corner| corner[2]);
    let (mut low, mut high) = (heights().fold(f64::INFINITY, f64::min), heights().fold(f64::NEG_INFINITY, f64::max));
    let total: f64 = triangles.iter().map(upward_area).sum();
    // Halved until the bits are used up.
    for _ in 0..60 {
        let middle = low + (high - low) / 2.0;
        let below: f64 = triangles.iter().map(|triangle| upward_area(triangle) * share_below(triangle, middle)).sum();
        if below < share * total { low = middle } else { high = middle }
    }
    high
}

/// Returns the share of a triangle that lies below `height`.
fn share_below(corners: &[[f64; 3]; 3], height: f64) -> f64 {
    let mut z = corners.map(|corner| corner[2]);
    z.sort_unstable_by(f64::total_cmp);
    if height < z[0] {
        0.0
    } else if height >= z[2] {
        1.0
    } else if height < z[1] {
        (height - z[0]).powi(2) / ((z[2] - z[0]) * (z[1] - z[0]))
    } else {
        1.0 - (z[2] - height).powi(2) / ((z[2] - z[0]) * (z[2] - z[1]))
    }
}

/// Outline of a part on the ground, divided into triangles.
struct PartOutline {
    points: Vec<[f64; 2]>,
    /// Corners of the triangles, clockwise seen from above, as in the floor that they come from.
    triangles: Vec<[usize; 3]>,
}

impl PartOutline {
    /// Collects the faces of a part that look down, except roofs, whose undersides are eaves. Faces may meet above each
    /// other, as the floor and the ceiling of an arcade. Corners at the same place on the map then count as one.
    fn new(scene: &TriangleScene, range: Range<usize>) -> Self {
        let mut numbers: HashMap<[u64; 2], usize> = HashMap::new();
        let mut footprint = Self { points: Vec::new(), triangles: Vec::new() };
        let not_roof = range.filter(|&t| scene.materials.get(t) != Some(&Material::Roof));
        for corners in not_roof.filter_map(|t| scene.corners(t)) {
            let normal = cross(sub(corners[1], corners[0]), sub(corners[2], corners[0]));
            if normal[2] < -DOWNWARD * length(normal) {
                let triangle = corners.map(|[x, y, _]| {
                    *numbers.entry([x.to_bits(), y.to_bits()]).or_insert_with(|| {
                        footprint.points.push([x, y]);
                        footprint.points.len() - 1
                    })
                });
                footprint.triangles.push(triangle);
            }
        }
        footprint
    }

    fn contains(&self, point: [f64; 2]) -> bool {
        self.triangles.iter().any(|&[a, b, c]| {
            let [a, b, c] = [a, b, c].map(|corner| self.points[corner]);
            [(a, b), (b, c), (c, a)].iter().all(|&(from, to)| left_of(from, to, point) <= 0.0)
        })
    }

    /// Returns a closed prism over the footprint. The sides stand on the edges that no second triangle shares.
    fn prism(&self, bottom: f64, top: f64) -> ObjectPart {
        let mut part = ObjectPart::default();
        let count = self.points.len();
        for height in [bottom, top] {
            part.vertices.extend(self.points.iter().map(|&[x, y]| [x, y, height]));
        }
        let edges = |&[a, b, c]: &[usize; 3]| [(a, b), (b, c), (c, a)];
        let known: std::collections::HashSet<(usize, usize)> = self.triangles.iter().flat_map(edges).collect();
        for triangle in &self.triangles {
            let [a, b, c] = *triangle;
            part.add_polygon(&[a, b, c], Material::Facade);
            part.add_polygon(&[count + c, count + b, count + a], Material::Roof);
            for (from, to) in edges(triangle) {
                if !known.contains(&(to, from)) {
                    part.add_polygon(&[to, from, count + from, count + to], Material::Facade);
                }
            }
        }
        part
    }
}

/// Returns a positive number if `point` lies to the left of the line from `from` to `to`.
fn left_of(from: [f64; 2], to: [f64; 2], point: [f64; 2]) -> f64 {
    (to[0] - from[0]) * (point[1] - from[1]) - (to[1] - from[1]) * (point[0] - from[0])
}

/// Terrain of a scene, with look-ups by position.
struct TerrainLookup<'a> {
    scene: &'a TriangleScene,
    cells: HashMap<[i64; 2], Vec<u32>>,
}

impl<'a> TerrainLookup<'a> {
    fn new(scene: &'a TriangleScene) -> Self {
        let mut cells: HashMap<[i64; 2], Vec<u32>> = HashMap::new();
        for (t, _) in scene.materials.iter().enumerate().filter(|&(_, &material)| material == Material::Terrain) {
            let Some(corners) = scene.corners(t) else { continue };
            let range = |axis: usize| {
                let values = corners.map(|corner| corner[axis]);
                cell(values.into_iter().fold(f64::INFINITY, f64::min))
                    ..=cell(values.into_iter().fold(f64::NEG_INFINITY, f64::max))
            };
            for i in range(0) {
                for j in range(1) {
                    cells.entry([i, j]).or_default().push(index_u32(t));
                }
            }
        }
        Self { scene, cells }
    }

    /// Returns the height of the ground below or above a point; `None` for a point without ground.
    fn height(&self, [x, y, _]: [f64; 3]) -> Option<f64> {
        let here = self.cells.get(&[cell(x), cell(y)])?;
        here.iter().find_map(|&t| {
            let [a, b, c] = self.scene.corners(t as usize)?;
            let flat = |p: [f64; 3]| [p[0], p[1]];
            let weights = [(b, c), (c, a), (a, b)].map(|(from, to)| left_of(flat(from), flat(to), [x, y]));
            let total: f64 = weights.iter().sum();
            let inside = total > 0.0 && weights.iter().all(|&weight| weight >= 0.0);
            inside.then(|| (weights[0] * a[2] + weights[1] * b[2] + weights[2] * c[2]) / total)
        })
    }
}

#[expect(clippy::cast_possible_truncation, reason = "`as` saturates far outside any town")]
fn cell(coordinate: f64) -> i64 {
    (coordinate / CELL).floor() as i64
}
