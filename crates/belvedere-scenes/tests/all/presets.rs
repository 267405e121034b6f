//! Presets: closed solids, the promised features, no floating objects, and trees only in free places.

#![expect(clippy::unwrap_used, reason = "helpers of tests may panic like the tests themselves")]

use std::collections::{BTreeSet, HashMap};
use std::ops::Range;

use belvedere_scenes::{
    BlockPlan, CrownMaterial, Material, ObjectPart, Preset, RoofDetails, StreetTrees, TownParams, TriangleScene, Truth,
    blocks, town,
};

/// Returns the number of directed edges without exactly one opposite partner.
fn open_edges(triangles: &[[u32; 3]]) -> usize {
    let mut edges: HashMap<(u32, u32), u32> = HashMap::new();
    for &[a, b, c] in triangles {
        for edge in [(a, b), (b, c), (c, a)] {
            *edges.entry(edge).or_default() += 1;
        }
    }
    edges.iter().filter(|&(&(a, b), &count)| count != 1 || edges.get(&(b, a)) != Some(&1)).count()
}

/// Returns the triangles of each part.
fn parts(scene: &TriangleScene) -> Vec<Range<usize>> {
    let mut ranges: Vec<Range<usize>> = Vec::new();
    for t in 0..scene.triangles.len() {
        match ranges.last_mut() {
            Some(range) if scene.parts[range.start] == scene.parts[t] => range.end = t + 1,
            _ => ranges.push(t..t + 1),
        }
    }
    ranges
}

fn part(scene: &TriangleScene, range: Range<usize>) -> ObjectPart {
    let (triangles, materials) = (scene.triangles[range.clone()].to_vec(), scene.materials[range].to_vec());
    let (low, high) = triangles.as_flattened().iter().fold((u32::MAX, 0), |(a, b), &v| (a.min(v), b.max(v)));
    let vertices = scene.vertices[low as usize..=high as usize].to_vec();
    ObjectPart { vertices, triangles: triangles.iter().map(|t| t.map(|v| v - low)).collect(), materials }
}

fn kind(scene: &TriangleScene, triangle: usize) -> &str {
    scene.object_names[scene.objects[triangle] as usize].split(' ').next().unwrap()
}

fn count(scene: &TriangleScene, kind: &str) -> usize {
    scene.object_names.iter().filter(|name| name.split(' ').next() == Some(kind)).count()
}

/// Returns towns of every kind, in several sizes and with several seeds.
fn towns() -> Vec<(Preset, TownParams)> {
    let sizes = [(60.0, 0), (60.0, 4), (99.0, 1), (100.0, 2), (125.0, 3), (125.0, 7), (230.0, 5)];
    Preset::ALL.iter().flat_map(|&p| sizes.map(|(extent, seed)| (p, p.params(extent, seed)))).collect()
}

#[test]
fn every_part_of_every_preset_is_a_closed_solid_with_a_material_per_triangle() {
    for (preset, params) in towns() {
        let scene = town(&params);
        let count = scene.triangles.len();
        assert!([scene.materials.len(), scene.objects.len(), scene.parts.len()].iter().all(|&l| l == count));
        let ranges = parts(&scene);
        assert_eq!(ranges.len(), scene.parts[count - 1] as usize + 1, "parts are numbered without gaps");
        for range in ranges {
            assert_eq!(scene.objects[range.start], scene.objects[range.end - 1], "a part has one object");
            let (name, part) = (kind(&scene, range.start).to_owned(), part(&scene, range));
            if name == "terrain" {
                continue;
            }
            let open = open_edges(&part.triangles);
            assert_eq!(open, 0, "{preset:?} {} {}: {name}", params.extent, params.seed);
            // A wire of 30 m and 4 cm² is the smallest of all.
            assert!(part.volume() > 5e-3, "{preset:?}: {name} {}", part.volume());
            for triangle in &part.triangles {
                let [a, b, c] = triangle.map(|v| part.vertices[v as usize]);
                assert!(area(a, b, c) > 1e-6, "{preset:?}: {name} has a face without area");
            }
        }
    }
}

fn area(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> f64 {
    let (u, v): ([f64; 3], [f64; 3]) = (std::array::from_fn(|i| b[i] - a[i]), std::array::from_fn(|i| c[i] - a[i]));
    let n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    n.iter().map(|v| v * v).sum::<f64>().sqrt() / 2.0
}

/// Returns the features of a scene, from its geometry instead of its parameters.
fn features(scene: &TriangleScene) -> BTreeSet<&'static str> {
    let mut found = BTreeSet::new();
    for range in parts(scene) {
        let (name, part) = (kind(scene, range.start).to_owned(), part(scene, range));
        let has = |material: Material| part.materials.contains(&material);
        let (_, high) = bounds(&part);
        match name.as_str() {
            "building" if has(Material::Roof) && has(Material::Facade) => {
                // Euler's formula: vertices − edges + faces is 2 for a solid, 0 for one with a hole through it.
                let faces = part.triangles.len();
                if part.vertices.len() + faces - faces * 3 / 2 == 0 {
                    found.insert("courtyard");
                }
                let up = |t: &[u32; 3]| {
                    let [a, b, c] = t.map(|v| part.vertices[v as usize]);
                    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
                };
                let mut roof = part.triangles.iter().zip(&part.materials).filter(|(_, m)| **m == Material::Roof);
                let roof_faces = roof.clone().filter(|(t, _)| up(t) > 1e-6).count();
                if roof.any(|(t, _)| up(t) < -1e-6) {
                    found.insert("eaves");
                }
                // Two rings of an L-shaped wall with or without a ridge; four stations of a U. Eaves add two vertices
                // for each corner, verges two for each end of the ridge.
                match part.vertices.len() {
                    12 | 15 => found.insert("l shape"),
                    20 if faces == 36 => found.insert("u shape"),
                    40 => found.insert("u shape"),
                    // Two slopes of two triangles each; hips add a triangle at either end.
                    10 | 18 | 22 => found.insert(if roof_faces == 6 { "hip roof" } else { "gable roof" }),
                    8 if high[2] - bounds(&part).0[2] < 2.15 => found.insert("roof box"),
                    _ => false,
                };
                let ceiling = |(t, m): (&[u32; 3], &Material)| *m == Material::Slab && up(t) < 0.0;
                if part.triangles.iter().zip(&part.materials).any(ceiling) {
                    found.insert("arcade");
                }
                let sloped = |(t, m): (&[u32; 3], &Material)| {
                    let z = t.map(|v| part.vertices[v as usize][2]);
                    *m == Material::Roof && (z[0] - z[1]).abs().max((z[0] - z[2]).abs()) > 1.0
                };
                let any_sloped = part.triangles.iter().zip(&part.materials).any(sloped);
                found.insert(if any_sloped { "sloped roof" } else { "flat roof" });
                let (low, _) = bounds(&part);
                if high[2] - low[2] > 32.0 {
                    found.insert("tower");
                }
                if part.triangles.len() == 16 && high[2] - low[2] < 5.0 {
                    found.insert("dormer");
                }
            }
            "building" if has(Material::Slab) && part.triangles.len() == 28 => {
                found.insert("balcony");
            }
            // A ring of slab.
            "building"
                if part.materials.iter().all(|&m| m == Material::Slab)
                    && part.vertices.len() + part.triangles.len() == part.triangles.len() * 3 / 2 =>
            {
                found.insert("parapet");
            }
            "building" if part.materials.iter().all(|&m| m == Material::Facade) && part.volume() < 10.0 => {
                found.insert("chimney");
            }
            _ => {}
        }
        let materials = [
            (Material::Leaf, "porous crown"),
            (Material::TreeCrown, "opaque crown"),
            (Material::Bridge, "bridge"),
            (Material::Fence, "fence"),
            (Material::Mast, "mast"),
            (Material::Wire, "wire"),
            (Material::Car, "car"),
        ];
        found.extend(materials.iter().filter(|&&(material, _)| has(material)).map(|&(_, name)| name));
        found.extend(["deck", "canopy"].iter().copied().filter(|&slab| slab == name));
    }
    found
}

fn bounds(part: &ObjectPart) -> ([f64; 3], [f64; 3]) {
    part.vertices.iter().fold(([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]), |(low, high), v| {
        (std::array::from_fn(|i| low[i].min(v[i])), std::array::from_fn(|i| high[i].max(v[i])))
    })
}

#[test]
fn presets_hold_what_they_promise() {
    let street = ["car", "mast", "wire"];
    let promised = |preset: Preset| -> Vec<&str> {
        let own: &[&str] = match preset {
            Preset::Village => {
                &["gable roof", "hip roof", "flat roof", "eaves", "chimney", "dormer", "fence", "porous crown"]
            }
            Preset::Town => &[
                "sloped roof",
                "flat roof",
                "eaves",
                "chimney",
                "dormer",
                "balcony",
                "tower",
                "arcade",
                "deck",
                "canopy",
                "bridge",
                "fence",
                "opaque crown",
            ],
            Preset::OldTown => &[
                "sloped roof",
                "eaves",
                "chimney",
                "dormer",
                "balcony",
                "arcade",
                "courtyard",
                "canopy",
                "bridge",
                "opaque crown",
            ],
            Preset::Towers => {
                &["flat roof", "parapet", "roof box", "balcony", "tower", "deck", "canopy", "fence", "opaque crown"]
            }
            Preset::Park => &["canopy", "fence", "bridge", "porous crown"],
        };
        let with_streets: &[&str] = if preset == Preset::Park { &[] } else { &street };
        own.iter().chain(with_streets).copied().collect()
    };
    for preset in Preset::ALL {
        for seed in 0..3 {
            let found = features(&town(&preset.params(125.0, seed)));
            for feature in promised(preset) {
                assert!(found.contains(feature), "{preset:?}, seed {seed}: no {feature} in {found:?}");
            }
        }
    }
    // Features that need more than four blocks.
    let large = features(&town(&Preset::Town.params(300.0, 1)));
    for feature in ["gable roof", "hip roof", "l shape", "u shape", "courtyard", "parapet", "roof box"] {
        assert!(large.contains(feature), "no {feature} in {large:?}");
    }
    assert!(features(&town(&Preset::Park.params(230.0, 1))).contains("deck"));
}

#[test]
fn roofs_have_eaves_and_parapets_as_often_as_the_town_says() {
    let plain = town(&TownParams { roofs: RoofDetails::PLAIN, ..Preset::Town.params(230.0, 1) });
    let found = features(&plain);
    assert!(["eaves", "parapet", "roof box"].iter().all(|feature| !found.contains(feature)), "{found:?}");
    let share = |eaves: f64| {
        let roofs = RoofDetails { eaves, ..RoofDetails::PLAIN };
        let scene = town(&TownParams { roofs, ..Preset::Town.params(230.0, 1) });
        // The same houses in the same places.
        assert_eq!(count(&scene, "building"), count(&plain, "building"));
        let mut reaches = Vec::new();
        let mut houses = 0;
        for range in parts(&scene) {
            let part = part(&scene, range);
            let materials: BTreeSet<_> = part.materials.iter().map(|m| m.name()).collect();
            // Houses of two slopes that stand on a floor of their own; dormers are lower.
            let (low, high) = bounds(&part);
            let is_house = [10, 18, 22].contains(&part.vertices.len()) && high[2] - low[2] > 5.0;
            if materials != BTreeSet::from(["roof", "facade"]) || !is_house {
                continue;
            }
            houses += 1;
            if part.vertices.len() > 10 {
                // From the corner of the wall to that of the roof: the floor has the first vertices, eaves the last.
                let (wall, edge) = (part.vertices[0], part.vertices[11]);
                reaches.push((wall[0] - edge[0]).hypot(wall[1] - edge[1]));
            }
        }
        assert!(houses > 100, "{houses}");
        // 0.3 to 0.6 m, and more across the corner of a verge or of other eaves.
        assert!(reaches.iter().all(|reach| (0.29..0.85).contains(reach)), "{reaches:?}");
        reaches.len() as f64 / f64::from(houses)
    };
    assert_eq!((share(0.0), share(1.0)), (0.0, 1.0));
    // Three standard deviations of 0.035 for about two hundred houses. The random numbers of a house do not depend on
    // the share.
    let half = share(0.5);
    assert!((half - 0.5).abs() < 0.105, "{half}");
}

#[test]
fn presets_give_the_same_bits_again_and_others_for_another_seed() {
    for preset in Preset::ALL {
        let [one, same, other] = [1, 1, 2].map(|seed| town(&preset.params(125.0, seed)));
        let bits =
            |scene: &TriangleScene| scene.vertices.as_flattened().iter().map(|v| v.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&one), bits(&same));
        assert_eq!((&one.triangles, &one.materials, &one.parts), (&same.triangles, &same.materials, &same.parts));
        assert_ne!(bits(&one), bits(&other));
    }
}

#[test]
fn town_of_300_metres_has_hundreds_of_buildings_and_trees_and_cities_grow_with_their_area() {
    for seed in [1, 2] {
        let scene = town(&Preset::Town.params(300.0, seed));
        let counts = ["building", "tree", "deck", "canopy"].map(|kind| count(&scene, kind));
        assert!((250..600).contains(&counts[0]) && (200..500).contains(&counts[1]), "{counts:?}");
        assert!(counts[2] >= 2 && counts[3] >= 10, "{counts:?}");
    }
    for preset in Preset::ALL {
        let triangles = [300.0, 600.0].map(|extent| town(&preset.params(extent, 1)).triangles.len());
        assert!(triangles[0] < 1_000_000, "{preset:?}: {}", triangles[0]);
        let growth = triangles[1] as f64 / triangles[0] as f64;
        // Four times the area, but the ground along the edges has only trees.
        assert!((3.0..5.5).contains(&growth), "{preset:?}: {growth}");
    }
}

#[test]
fn objects_stand_in_the_ground_and_their_parts_hang_together() {
    for (preset, params) in towns() {
        let (scene, terrain) = (town(&params), params.terrain());
        let mut objects: HashMap<u32, Vec<ObjectPart>> = HashMap::new();
        for range in parts(&scene) {
            objects.entry(scene.objects[range.start]).or_default().push(part(&scene, range));
        }
        for (object, parts) in objects {
            let name = &scene.object_names[object as usize];
            if name == "terrain" {
                continue;
            }
            let in_ground = |part: &ObjectPart| part.vertices.iter().any(|v| v[2] < terrain.height(v[0], v[1]) - 0.1);
            if name.starts_with("wire") {
                assert!(!in_ground(&parts[0]), "{preset:?}: {name}");
                continue;
            }
            assert!(parts.iter().any(in_ground), "{preset:?} {} {}: {name} floats", params.extent, params.seed);
            let boxes: Vec<_> = parts.iter().map(bounds).collect();
            for (number, (part, (low, high))) in parts.iter().zip(&boxes).enumerate() {
                let touches = boxes.iter().enumerate().any(|(other, (other_low, other_high))| {
                    other != number && (0..3).all(|i| other_low[i] < high[i] && low[i] < other_high[i])
                });
                assert!(touches || in_ground(part), "{preset:?}: part {number} of {name} floats");
            }
        }
    }
}

/// Returns the triangles of the floors of buildings, seen from above.
fn floors(scene: &TriangleScene) -> Vec<(u32, [[f64; 2]; 3])> {
    let blocks = blocks(scene);
    (0..blocks.triangles.len())
        .filter(|&t| blocks.materials[t] == Material::Roof)
        .map(|t| (blocks.objects[t], blocks.corners(t).unwrap().map(|[x, y, _]| [x, y])))
        .collect()
}

fn inside([a, b, c]: [[f64; 2]; 3], p: [f64; 2]) -> bool {
    let side = |a: [f64; 2], b: [f64; 2]| (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
    side(a, b) > 0.0 && side(b, c) > 0.0 && side(c, a) > 0.0
}

#[test]
fn trees_and_cars_and_masts_stand_outside_buildings() {
    for (preset, params) in towns() {
        let scene = town(&params);
        let floors = floors(&scene);
        let mut looked_at = 0;
        for range in parts(&scene) {
            let material = scene.materials[range.start];
            if ![Material::Trunk, Material::Car, Material::Mast].contains(&material) {
                continue;
            }
            let part = part(&scene, range.clone());
            for v in &part.vertices {
                let name = &scene.object_names[scene.objects[range.start] as usize];
                let hit = floors.iter().find(|&&(_, floor)| inside(floor, [v[0], v[1]]));
                assert!(hit.is_none(), "{preset:?} {} {}: {name} in a building", params.extent, params.seed);
                looked_at += 1;
            }
        }
        assert!(looked_at > 0);
    }
}

#[test]
fn balconies_and_canopies_keep_out_of_other_buildings() {
    for (preset, params) in towns() {
        let scene = town(&params);
        let blocks = blocks(&scene);
        let floors: Vec<(&str, [[f64; 2]; 3])> =
            floors(&scene).into_iter().map(|(o, f)| (blocks.object_names[o as usize].as_str(), f)).collect();
        for range in parts(&scene) {
            let name = scene.object_names[scene.objects[range.start] as usize].as_str();
            // Decks run into the buildings that they join.
            if name.starts_with("deck") || !range.clone().all(|t| scene.materials[t] == Material::Slab) {
                continue;
            }
            for v in &part(&scene, range).vertices {
                let hit = floors.iter().find(|&&(other, floor)| other != name && inside(floor, [v[0], v[1]]));
                assert!(hit.is_none(), "{preset:?} {} {}: {name} in {hit:?}", params.extent, params.seed);
            }
        }
    }
}

#[test]
fn crowns_keep_clear_of_other_objects_seen_from_the_middle_of_each_crown() {
    // The trunk ends in the middle of the crown. Surfaces around it within the crown's reach must belong to its own
    // tree.
    let scene = town(&TownParams { crowns: CrownMaterial::Opaque, ..Preset::Village.params(125.0, 2) });
    let truth = Truth::new(&scene);
    let mut trees = 0;
    for range in parts(&scene).into_iter().filter(|r| scene.materials[r.start] == Material::TreeCrown) {
        let (low, high) = bounds(&part(&scene, range.clone()));
        let centre: [f64; 3] = std::array::from_fn(|i| (low[i] + high[i]) / 2.0);
        for step in 0..24 {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(step) / 24.0).sin_cos();
            let hit = truth.first_hit(centre, [cos, sin, 0.1], f64::INFINITY).unwrap();
            assert_eq!(scene.objects[hit.triangle as usize], scene.objects[range.start]);
        }
        trees += 1;
    }
    assert!(trees > 10, "{trees}");
}

#[test]
fn houses_of_a_row_share_their_walls() {
    let only = |plan| TownParams { blocks: vec![(plan, 1)], ..Preset::OldTown.params(125.0, 3) };
    for plan in [BlockPlan::Perimeter, BlockPlan::RowHouses] {
        let scene = town(&only(plan));
        let floors = floors(&scene);
        let corners: Vec<(u32, [f64; 2])> = floors.iter().flat_map(|&(o, c)| c.map(|p| (o, p))).collect();
        let inner = corners.iter().filter(|&&(o, p)| floors.iter().any(|&(other, f)| other != o && inside(f, p)));
        let walls: BTreeSet<u32> = inner.map(|&(object, _)| object).collect();
        assert!(walls.len() * 3 > count(&scene, "building"), "{plan:?}: {} of all", walls.len());
    }
}

#[test]
fn one_can_stand_below_decks_canopies_and_bridges() {
    let mut seen: BTreeSet<String> = BTreeSet::new();
    for (preset, params) in towns() {
        let (scene, terrain) = (town(&params), params.terrain());
        let truth = Truth::new(&scene);
        for range in parts(&scene) {
            let name = kind(&scene, range.start).to_owned();
            let (low, high) = bounds(&part(&scene, range.clone()));
            let wide = (0..2).all(|i| high[i] - low[i] > 1.0) && high[2] - low[2] < 2.0;
            if !["deck", "canopy", "bridge"].contains(&name.as_str()) || !wide {
                continue;
            }
            let middle = [(low[0] + high[0]) / 2.0, (low[1] + high[1]) / 2.0];
            let foot = [middle[0], middle[1], terrain.height(middle[0], middle[1]) + 0.5];
            let hit = truth.first_hit(foot, [0.0, 0.0, 1.0], 10.0).unwrap();
            // At least the height of a head, 1.8 m above the ground, from 0.5 m up; stalls are the lowest.
            assert!(hit.range > 1.3, "{preset:?} {name}: {}", hit.range);
            seen.insert(name);
        }
    }
    assert_eq!(seen.len(), 3, "{seen:?}");
}

#[test]
fn bridges_span_a_trench() {
    let params = Preset::Town.params(230.0, 1);
    let (scene, terrain) = (town(&params), params.terrain());
    let decks: Vec<_> = parts(&scene)
        .into_iter()
        .filter(|r| scene.materials[r.start] == Material::Bridge)
        .map(|r| part(&scene, r))
        .collect();
    assert!(decks.len() >= 9, "three bridges of a deck and two parapets");
    for deck in decks {
        // Rings run from one end to the other.
        let (first, last) = (deck.vertices[0], deck.vertices[deck.vertices.len() - 4]);
        let height = |share: f64| {
            terrain.height(first[0] + share * (last[0] - first[0]), first[1] + share * (last[1] - first[1]))
        };
        let banks = height(0.0).min(height(1.0));
        assert!(banks - height(0.5) > 0.8 * params.canal_depth, "{banks} {}", height(0.5));
    }
    // The mesh fits the formula as well as documented.
    let worst = (0..scene.triangles.len()).filter(|&t| scene.materials[t] == Material::Terrain).map(|t| {
        let [a, b, c] = scene.corners(t).unwrap();
        let middle: [f64; 3] = std::array::from_fn(|i| (a[i] + b[i] + c[i]) / 3.0);
        (terrain.height(middle[0], middle[1]) - middle[2]).abs()
    });
    let worst = worst.inspect(|difference| assert!(!difference.is_nan())).fold(0.0, f64::max);
    assert!(worst < 0.4, "{worst}");
}

#[test]
fn porous_crowns_let_two_in_five_lines_pass_bare_ones_most_and_opaque_ones_none() {
    let mut state = 12_345_u64;
    let mut uniform = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let kinds = [
        (CrownMaterial::Porous, Material::Leaf),
        (CrownMaterial::Bare, Material::Trunk),
        (CrownMaterial::Opaque, Material::TreeCrown),
    ];
    for (crowns, material) in kinds {
        let scene = town(&TownParams { crowns, ..Preset::Park.params(125.0, 1) });
        let (mut lines, mut free) = (0, 0);
        for range in parts(&scene).into_iter().filter(|r| scene.materials[r.start] == material) {
            let crown = part(&scene, range);
            let (low, high) = bounds(&crown);
            // Trunks have the material of branches.
            if high[0] - low[0] < 1.0 {
                continue;
            }
            let centre: [f64; 3] = std::array::from_fn(|i| (low[i] + high[i]) / 2.0);
            let mut alone = TriangleScene::default();
            alone.add_object("crown", &[crown]);
            let truth = Truth::new(&alone);
            for _ in 0..200 {
                // Through the inner two thirds of the crown, so that a miss is a gap and not a line beside it.
                let offset: [f64; 3] =
                    std::array::from_fn(|i| (uniform() - 0.5) * 0.66 * (high[i] - low[i]) / 3f64.sqrt());
                let direction = [uniform() - 0.5, uniform() - 0.5, -uniform()];
                let start: [f64; 3] = std::array::from_fn(|i| centre[i] + offset[i] - 40.0 * direction[i]);
                lines += 1;
                free += usize::from(!truth.occluded_towards(start, direction));
            }
        }
        let share = free as f64 / f64::from(lines);
        match crowns {
            CrownMaterial::Porous => assert!((0.33..0.47).contains(&share), "{share}"),
            // Branches block little more than a tenth of the lines through the inner crown.
            CrownMaterial::Bare => assert!((0.6..0.95).contains(&share), "{share}"),
            CrownMaterial::Opaque => assert_eq!(free, 0),
        }
    }
}

#[test]
fn odd_descriptions_give_a_scene_all_the_same() {
    let usual = Preset::Town.params(125.0, 1);
    let open = town(&TownParams { blocks: Vec::new(), street_furniture: 0.0, ..usual.clone() });
    assert_eq!(count(&open, "building"), 0);
    assert!(count(&open, "tree") > 0);
    let never = town(&TownParams { blocks: vec![(BlockPlan::Gardens, 0)], ..usual.clone() });
    assert!(count(&never, "building") >= 4, "the first block is one of each, weight or not");
    for odd in [
        TownParams { extent: f64::NAN, street_angle: 3.0, ..usual.clone() },
        TownParams { street_width: f64::NAN, block_pitch: 1e9, canal_depth: 99.0, ..usual.clone() },
        TownParams { extent: 0.0, area_per_garden_tree: 0.0, ..usual.clone() },
        TownParams { street_trees: StreetTrees::Without, tree_heights: [-5.0, 900.0], ..usual.clone() },
    ] {
        let scene = town(&odd);
        assert!(scene.triangles.len() > 1000);
        assert!(scene.vertices.as_flattened().iter().all(|v| v.is_finite()));
    }
    // These parameters make no sense, but the construction ends.
    for odd in [
        TownParams { origin: [f64::INFINITY, f64::NAN, 0.0], ..usual.clone() },
        TownParams { slope: f64::NAN, hill_height: f64::INFINITY, ..usual.clone() },
    ] {
        assert!(!blocks(&town(&odd)).triangles.is_empty());
    }
}
