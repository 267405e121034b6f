//! Scenes from given meshes, whose materials are guessed.

use crate::scene::{Material, TriangleScene};
use crate::truth::Truth;
use crate::vector::{add, scale};
use rayon::prelude::*;

/// Beginnings of object names, in lower case, with the material of the object.
const NAMED: [(&str, Material); 12] = [
    ("terrain", Material::Terrain),
    ("ground", Material::Terrain),
    ("relief", Material::Terrain),
    ("tin", Material::Terrain),
    ("tree", Material::TreeCrown),
    ("vegetation", Material::TreeCrown),
    ("bridge", Material::Bridge),
    ("fence", Material::Fence),
    ("car", Material::Car),
    ("mast", Material::Mast),
    ("wire", Material::Wire),
    ("canopy", Material::Slab),
];
/// Absolute vertical component of the unit normal below which a surface is a wall: steeper than 60°.
const STEEP: f64 = 0.5;

impl TriangleScene {
    /// Returns a scene of the triangles of a mesh. `vertices`, (V, 3), are absolute, metres. `triangles`, (T, 3), are
    /// counter-clockwise seen from outside. `objects`, (T), are indices into `object_names`, or empty for a mesh
    /// without objects.
    ///
    /// Materials follow the name of an object that begins with a word such as `terrain`, `tree` or `bridge`. Otherwise
    /// steep triangles are facades, gentle triangles with another surface below them are roofs, and the rest is
    /// terrain.
    #[must_use]
    pub fn from_model(
        vertices: Vec<[f64; 3]>,
        triangles: Vec<[u32; 3]>,
        objects: Vec<u32>,
        object_names: Vec<String>,
    ) -> Self {
        let materials = vec![Material::Facade; triangles.len()];
        let mut scene = Self { vertices, triangles, materials, objects, object_names, ..Self::default() };
        if scene.objects.len() != scene.triangles.len() {
            scene.objects = vec![0; scene.triangles.len()];
            scene.object_names = vec!["model".to_owned()];
        }
        let truth = Truth::new(&scene);
        let guess = |triangle: usize| {
            let object = *scene.objects.get(triangle)? as usize;
            let name = scene.object_names.get(object)?.to_lowercase();
            if let Some(&(_, material)) = NAMED.iter().find(|(start, _)| name.starts_with(start)) {
                return Some(material);
            }
            if scene.normal(triangle)?[2].abs() < STEEP {
                return Some(Material::Facade);
            }
            let [a, b, c] = scene.corners(triangle)?;
            let middle = scale(add(add(a, b), c), 1.0 / 3.0);
            let covers = truth.occluded_towards(middle, [0.0, 0.0, -1.0]);
            Some(if covers { Material::Roof } else { Material::Terrain })
        };
        let guessed: Vec<Material> =
            (0..scene.triangles.len()).into_par_iter().map(|t| guess(t).unwrap_or(Material::Facade)).collect();
        scene.materials = guessed;
        scene
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]
    use super::*;
    use crate::town::{TownParams, town};

    #[test]
    fn a_town_without_materials_gets_nearly_all_of_them_back() {
        let known = town(&TownParams::default());
        let names = known.object_names.iter().map(|n| n.replace("terrain", "surface").replace("tree", "plant"));
        let guessed = TriangleScene::from_model(
            known.vertices.clone(),
            known.triangles.clone(),
            known.objects.clone(),
            names.collect(),
        );
        let of = |material| known.materials.iter().zip(&guessed.materials).filter(move |(k, _)| **k == material);
        for material in [Material::Terrain, Material::Roof, Material::Facade] {
            let right = of(material).filter(|(k, g)| k == g).count();
            let all = of(material).count();
            // Floors of houses, which count as facades, lie level over no other surface.
            assert!(right as f64 > 0.8 * all as f64, "{material:?}: {right} of {all}");
        }
        let named = TriangleScene::from_model(known.vertices, known.triangles, known.objects, known.object_names);
        let trees = known.materials.iter().zip(&named.materials).filter(|(k, _)| **k == Material::TreeCrown);
        assert!(trees.clone().count() > 1000 && trees.clone().all(|(_, g)| *g == Material::TreeCrown));
    }
}
