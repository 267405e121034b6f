//! CityJSON text of a scene.

use std::collections::{BTreeMap, HashSet};
use std::fmt::Write as _;

use crate::scene::{Material, TriangleScene, index_u32};
use crate::vector::{cross, sub, unit};

/// Size of a step of the integer coordinates, metres.
const STEP: f64 = 0.001;
/// Level of detail of every geometry: the exact shape, roof overhangs and balconies included.
const LEVEL_OF_DETAIL: &str = "3";
/// Minimum absolute sine of the elevation of the normal of a level surface: 45°.
const LEVEL_SINE: f64 = 0.707;
/// Maximum height of a floor on the ground above the lowest corner of its part, metres.
const FLOOR_REACH: f64 = 1.0;

impl TriangleScene {
    /// Returns CityJSON 2.0 text: one city object per object of the scene, with its name. Blanks and other signs become
    /// underscores.
    ///
    /// Objects with roofs or walls become a `Building` with a `BuildingPart` for each part, named `building_3-1`….
    /// Their triangles have the types `RoofSurface`, `WallSurface`, `GroundSurface`, `OuterFloorSurface` or
    /// `OuterCeilingSurface`, by material and slope. Ground is a `TINRelief`, trees are `SolitaryVegetationObject`s,
    /// bridges `Bridge`s, fences, masts and wires `CityFurniture`. Other objects are `GenericCityObject`s. A closed
    /// part is a `Solid`. Several closed pieces make a `MultiSolid`, or a `MultiSurface` within a building. Coordinates
    /// have millimetres.
    ///
    /// `parts` (T) gives the number of the part of each triangle, within its object. If it is empty, triangles that
    /// share vertices form a part. `epsg` is the code of the reference system.
    ///
    /// # Source
    /// CityJSON 2.0.1 specification, sections 2 (city objects), 3 (geometry and semantics) and 4 (transform).
    #[must_use]
    pub fn to_cityjson(&self, parts: &[u32], epsg: u32) -> String {
        let pieces = self.connected_pieces();
        let part_of = |t: usize| parts.get(t).or_else(|| pieces.get(t)).copied().unwrap_or(0);
        let translate = self.bounds().map_or([0.0; 3], |(low, _)| low.map(f64::floor));
        let mut text = String::with_capacity(self.vertices.len() * 24 + self.triangles.len() * 40);
        // Writing to a String cannot fail, so the results of write! carry nothing.
        let _ = write!(
            text,
            "{{\"type\":\"CityJSON\",\"version\":\"2.0\",\"transform\":{{\"scale\":[{STEP},{STEP},{STEP}],\
             \"translate\":[{},{},{}]}},\"metadata\":{{\"referenceSystem\":\
             \"https://www.opengis.net/def/crs/EPSG/0/{epsg}\"}},\n\"CityObjects\":{{",
            translate[0], translate[1], translate[2]
        );
        let mut names = HashSet::new();
        let mut first = true;
        for object in self.triangles_by(|t| self.objects.get(t).copied().unwrap_or(0)) {
            let number = object.first().and_then(|&t| self.objects.get(t)).copied().unwrap_or(0);
            let name =
                unused_name(&mut names, self.object_names.get(number as usize).map_or("unnamed", String::as_str));
            let mut entries = Vec::new();
            let kind = self.kind_of(&object);
            if kind == "Building" {
                let mut children = Vec::new();
                for part in group(&object, part_of) {
                    let child = unused_name(&mut names, &format!("{name}-{}", children.len() + 1));
                    let geometry = self.geometry(&part, &pieces, Semantics::Building);
                    let parents = format!("\"parents\":[\"{name}\"],");
                    entries
                        .push(format!("\"{child}\":{{\"type\":\"BuildingPart\",{parents}\"geometry\":[{geometry}]}}"));
                    children.push(format!("\"{child}\""));
                }
                let children = children.join(",");
                entries.insert(0, format!("\"{name}\":{{\"type\":\"Building\",\"children\":[{children}]}}"));
            } else {
                let geometry = self.geometry(&object, &pieces, Semantics::Without);
                entries.push(format!("\"{name}\":{{\"type\":\"{kind}\",\"geometry\":[{geometry}]}}"));
            }
            for entry in entries {
                text.push_str(if first { "\n" } else { ",\n" });
                text.push_str(&entry);
                first = false;
            }
        }
        text.push_str("},\n\"vertices\":[");
        for (i, vertex) in self.vertices.iter().enumerate() {
            let [x, y, z] = std::array::from_fn(|axis| steps(vertex[axis] - translate[axis]));
            let _ = write!(text, "{}[{x},{y},{z}]", if i == 0 { "\n" } else { ",\n" });
        }
        text.push_str("]}\n");
        text
    }

    /// Returns the number of the connected piece of each triangle, (T): triangles that share a vertex are of one piece.
    fn connected_pieces(&self) -> Vec<u32> {
        let mut parent: Vec<u32> = (0..index_u32(self.vertices.len())).collect();
        let root = |parent: &mut Vec<u32>, mut vertex: u32| {
            while let Some(&above) = parent.get(vertex as usize) {
                if above == vertex {
                    break;
                }
                let higher = parent.get(above as usize).copied().unwrap_or(above);
                if let Some(slot) = parent.get_mut(vertex as usize) {
                    *slot = higher;
                }
                vertex = higher;
            }
            vertex
        };
        for &[a, b, c] in &self.triangles {
            for other in [b, c] {
                let (one, two) = (root(&mut parent, a), root(&mut parent, other));
                // The lower number leads, so that pieces keep the order of their first vertices.
                if let Some(slot) = parent.get_mut(one.max(two) as usize) {
                    *slot = one.min(two);
                }
            }
        }
        self.triangles.iter().map(|&[a, ..]| root(&mut parent, a)).collect()
    }

    /// Groups triangles by `key`, in the order of their first one.
    fn triangles_by(&self, key: impl Fn(usize) -> u32) -> Vec<Vec<usize>> {
        group(&(0..self.triangles.len()).collect::<Vec<_>>(), key)
    }

    fn material(&self, triangle: usize) -> Material {
        self.materials.get(triangle).copied().unwrap_or(Material::Slab)
    }

    /// Returns the type of the city object of `triangles`.
    fn kind_of(&self, triangles: &[usize]) -> &'static str {
        let has = |wanted: &[Material]| triangles.iter().any(|&t| wanted.contains(&self.material(t)));
        let kinds: [(&[Material], &str); 5] = [
            (&[Material::Roof, Material::Facade], "Building"),
            (&[Material::Terrain], "TINRelief"),
            (&[Material::TreeCrown, Material::Trunk, Material::Leaf], "SolitaryVegetationObject"),
            (&[Material::Bridge], "Bridge"),
            (&[Material::Fence, Material::Mast, Material::Wire], "CityFurniture"),
        ];
        kinds.iter().find(|(materials, _)| has(materials)).map_or("GenericCityObject", |(_, kind)| kind)
    }

    /// Returns the geometry object of `triangles`.
    fn geometry(&self, triangles: &[usize], pieces: &[u32], semantics: Semantics) -> String {
        let is_sheet = triangles.iter().all(|&t| self.material(t) == Material::Terrain);
        let shells = group(triangles, |t| pieces.get(t).copied().unwrap_or(0));
        let surface = |t: &usize| {
            let [a, b, c] = self.triangles.get(*t).copied().unwrap_or_default();
            format!("[[{a},{b},{c}]]")
        };
        let list = |triangles: &[usize]| triangles.iter().map(surface).collect::<Vec<_>>().join(",");
        let kind = match (shells.len(), semantics) {
            _ if is_sheet => "CompositeSurface",
            (1, _) => "Solid",
            (_, Semantics::Building) => "MultiSurface",
            (_, Semantics::Without) => "MultiSolid",
        };
        let boundaries = match kind {
            "Solid" => format!("[{}]", list(triangles)),
            "MultiSolid" => shells.iter().map(|shell| format!("[[{}]]", list(shell))).collect::<Vec<_>>().join(","),
            _ => list(triangles),
        };
        let mut text = format!("{{\"type\":\"{kind}\",\"lod\":\"{LEVEL_OF_DETAIL}\",\"boundaries\":[{boundaries}]");
        if semantics == Semantics::Building {
            let (types, values) = self.building_surfaces(triangles);
            let types: Vec<String> = types.iter().map(|kind| format!("{{\"type\":\"{kind}\"}}")).collect();
            let values: Vec<String> = values.iter().map(usize::to_string).collect();
            let values = format!("[{}]", values.join(","));
            let values = if kind == "Solid" { format!("[{values}]") } else { values };
            let _ = write!(text, ",\"semantics\":{{\"surfaces\":[{}],\"values\":{values}}}", types.join(","));
        }
        text.push('}');
        text
    }

    /// Returns the kinds of surface among `triangles`, and for each triangle the index of its kind.
    fn building_surfaces(&self, triangles: &[usize]) -> (Vec<&'static str>, Vec<usize>) {
        let corners = |t: usize| self.corners(t).unwrap_or_default();
        let lowest = triangles.iter().flat_map(|&t| corners(t)).map(|corner| corner[2]).fold(f64::INFINITY, f64::min);
        let mut kinds: Vec<&'static str> = Vec::new();
        let values = triangles.iter().map(|&t| {
            let [a, b, c] = corners(t);
            let up = unit(cross(sub(b, a), sub(c, a))).map_or(0.0, |normal| normal[2]);
            let middle = (a[2] + b[2] + c[2]) / 3.0;
            let kind = match self.material(t) {
                _ if up < -LEVEL_SINE && middle < lowest + FLOOR_REACH => "GroundSurface",
                _ if up < -LEVEL_SINE => "OuterCeilingSurface",
                Material::Roof => "RoofSurface",
                _ if up > LEVEL_SINE => "OuterFloorSurface",
                _ => "WallSurface",
            };
            kinds.iter().position(|&known| known == kind).unwrap_or_else(|| {
                kinds.push(kind);
                kinds.len() - 1
            })
        });
        let values = values.collect();
        (kinds, values)
    }
}

/// Semantics of surfaces: types for buildings, or none.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Semantics {
    Building,
    Without,
}

/// Groups `triangles` by `key`, in the order of their first one.
fn group(triangles: &[usize], key: impl Fn(usize) -> u32) -> Vec<Vec<usize>> {
    let mut places: BTreeMap<u32, usize> = BTreeMap::new();
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for &t in triangles {
        let place = *places.entry(key(t)).or_insert(groups.len());
        match groups.get_mut(place) {
            Some(members) => members.push(t),
            None => groups.push(vec![t]),
        }
    }
    groups
}

/// Returns `wanted` in letters, digits, `-` and `_`, made different from all earlier names.
fn unused_name(names: &mut HashSet<String>, wanted: &str) -> String {
    let plain: String =
        wanted.chars().map(|c| if c.is_alphanumeric() || c == '-' || c == '_' { c } else { '_' }).collect();
    let mut name = plain.clone();
    let mut number = 1_u32;
    while !names.insert(name.clone()) {
        number += 1;
        name = format!("{plain}_{number}");
    }
    name
}

#[expect(clippy::cast_possible_truncation, reason = "`as` saturates; no scene is 10^16 m wide")]
fn steps(metres: f64) -> i64 {
    (metres / STEP).round() as i64
}
