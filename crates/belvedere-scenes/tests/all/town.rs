//! Town as a mesh: closed, with outward faces, standing in the ground, and the same for the same seed.

#![expect(clippy::unwrap_used, reason = "helpers of tests may panic like the tests themselves")]

use std::collections::{HashMap, HashSet};

use belvedere_scenes::{
    Material, ObjectPart, PlanPlacement, TownParams, TriangleScene, extruded, l_shaped_ridged, ridged, town,
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

/// Returns the connected solids of one object as parts of their own.
fn solids(scene: &TriangleScene, object: u32) -> Vec<ObjectPart> {
    let own: Vec<usize> = (0..scene.triangles.len()).filter(|&t| scene.objects[t] == object).collect();
    let mut group: HashMap<u32, u32> = HashMap::new();
    for &t in &own {
        for v in scene.triangles[t] {
            group.entry(v).or_insert(v);
        }
    }
    // The lowest vertex number spreads over each solid until nothing changes.
    loop {
        let mut changed = false;
        for &t in &own {
            let corners = scene.triangles[t];
            let lowest = corners.iter().map(|v| group[v]).min().unwrap();
            for v in corners {
                changed |= group.insert(v, lowest) != Some(lowest);
            }
        }
        if !changed {
            break;
        }
    }
    let names: HashSet<u32> = group.values().copied().collect();
    names
        .into_iter()
        .map(|name| {
            let triangles: Vec<usize> =
                own.iter().copied().filter(|&t| group[&scene.triangles[t][0]] == name).collect();
            ObjectPart {
                vertices: scene.vertices.clone(),
                materials: triangles.iter().map(|&t| scene.materials[t]).collect(),
                triangles: triangles.iter().map(|&t| scene.triangles[t]).collect(),
            }
        })
        .collect()
}

#[test]
fn every_solid_of_the_town_is_closed_and_outward() {
    let scene = town(&TownParams::default());
    let (mut building_solids, mut tree_solids) = (0, 0);
    for (object, name) in (0_u32..).zip(&scene.object_names) {
        if name == "terrain" {
            continue;
        }
        for solid in solids(&scene, object) {
            assert_eq!(open_edges(&solid.triangles), 0, "{name}");
            assert!(solid.volume() > 0.1, "{name}: {}", solid.volume());
            if name.starts_with("tree") {
                tree_solids += 1;
            } else {
                building_solids += 1;
            }
        }
    }
    assert!(building_solids >= 18 && tree_solids >= 60, "{building_solids} {tree_solids}");
    assert_eq!(tree_solids % 2, 0, "each tree is a trunk and a crown");
}

#[test]
fn removing_a_triangle_is_noticed_as_a_hole() {
    let mut part = extruded(&PlanPlacement { origin: [0.0; 2], angle: 0.3 }.rectangle(4.0, 3.0), 0.0, 2.0);
    assert_eq!(open_edges(&part.triangles), 0);
    part.triangles.pop();
    assert_ne!(open_edges(&part.triangles), 0);
}

#[test]
fn volumes_of_solids_match_closed_forms() {
    let placement = PlanPlacement { origin: [155_000.0, 463_000.0], angle: 0.4 };
    let near = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-6 * expected, "{found} {expected}");
    near(extruded(&placement.rectangle(10.0, 6.0), -1.0, 4.0).volume(), 10.0 * 6.0 * 5.0);
    near(extruded(&placement.l_shape(12.0, 9.0, 4.0), 0.0, 5.0).volume(), (12.0 * 4.0 + 5.0 * 4.0) * 5.0);
    // A gable roof is half a box. A hip takes away a third of the end prism: base 6 m, roof height 3 m, 2 m deep.
    near(ridged(&placement.rectangle(10.0, 6.0), 0.0, 5.0, 8.0, 0.0).volume(), 300.0 + 90.0);
    near(
        ridged(&placement.rectangle(10.0, 6.0), 0.0, 5.0, 8.0, 2.0).volume(),
        300.0 + 90.0 - 2.0 * 6.0 * 3.0 * 2.0 / 6.0,
    );
    // Two half boxes of roof, less one pair of pyramids over the shared square: w² h (1/2 + 1/2 − 1/3) there.
    let (w, h) = (4.0, 2.0);
    let roof = (8.0 + 5.0) * w * h / 2.0 + w * w * h * (1.0 / 3.0 + 1.0 / 6.0);
    near(l_shaped_ridged(&placement, [12.0, 9.0], w, 0.0, 5.0, 5.0 + h).volume(), (12.0 * w + 5.0 * w) * 5.0 + roof);
}

#[test]
fn same_seed_gives_the_same_bits_and_another_seed_another_town() {
    let params = TownParams::default();
    let (one, same) = (town(&params), town(&params));
    assert_eq!((&one.vertices, &one.triangles, &one.objects), (&same.vertices, &same.triangles, &same.objects));
    let other = town(&TownParams { seed: 2, ..params });
    assert_ne!(one.vertices, other.vertices);
}

#[test]
fn default_town_stays_the_one_that_numbers_were_published_for() {
    for (extent, seed, [vertices, triangles, objects], fingerprint) in
        [(120.0, 1, [9374, 18090, 62], 6_202_292.680_188), (300.0, 5, [66966, 130_170, 456], 40_951_827.165_4)]
    {
        let params = TownParams { extent, seed, ..TownParams::default() };
        let scene = town(&params);
        assert_eq!(
            [scene.vertices.len(), scene.triangles.len(), scene.object_names.len()],
            [vertices, triangles, objects]
        );
        let weighted = scene.vertices.iter().enumerate().map(|(i, v)| {
            (i % 97 + 1) as f64 * ((v[0] - params.origin[0]) + 2.0 * (v[1] - params.origin[1]) + 3.0 * v[2])
        });
        // Sums of 1e5 numbers of 1e4, and sines with last bits that depend on the platform: 1e-10 each. 1e-2 is a
        // thousandth of any visible change of one vertex.
        let sum: f64 = weighted.sum();
        assert!((sum - fingerprint).abs() < 1e-2, "{sum}");
    }
}

#[test]
fn town_has_gables_flat_roofs_an_l_a_tower_and_trees_on_a_slope() {
    for seed in 0..6 {
        let params = TownParams { seed, ..TownParams::default() };
        let scene = town(&params);
        let named = |start: &str| scene.object_names.iter().filter(|n| n.starts_with(start)).count();
        assert!(named("building") >= 18 && named("tree") >= 25, "{} {}", named("building"), named("tree"));
        let (low, high) = scene.bounds().unwrap();
        assert!((high[2] - low[2]) > 34.0, "the tower stands out");
        assert!((low[0] - (155_000.0 - 60.0)).abs() < 1e-6 && (high[1] - (463_000.0 + 60.0)).abs() < 1e-6);
        let ground: Vec<f64> = (0..scene.triangles.len())
            .filter(|&t| scene.materials[t] == Material::Terrain)
            .map(|t| scene.corners(t).unwrap()[0][2])
            .collect();
        let relief = ground.iter().copied().fold(f64::MIN, f64::max) - ground.iter().copied().fold(f64::MAX, f64::min);
        assert!((2.0..9.0).contains(&relief), "{relief}");
        let plain = [Material::Terrain, Material::Roof, Material::Facade, Material::TreeCrown, Material::Trunk];
        for material in plain {
            assert!(scene.materials.contains(&material), "{material:?}");
        }
    }
}

#[test]
fn buildings_reach_below_the_ground_and_rise_above_it() {
    let params = TownParams { hill_height: 3.0, slope: 0.06, ..TownParams::default() };
    let (scene, terrain) = (town(&params), params.terrain());
    for (object, name) in (0_u32..).zip(&scene.object_names).skip(1) {
        let vertices: HashSet<u32> = (0..scene.triangles.len())
            .filter(|&t| scene.objects[t] == object)
            .flat_map(|t| scene.triangles[t])
            .collect();
        let depth = |v: &u32| {
            let [x, y, z] = scene.vertices[*v as usize];
            terrain.height(x, y) - z
        };
        let deepest = vertices.iter().map(depth).fold(f64::MIN, f64::max);
        assert!(deepest > 0.5, "{name} ends {deepest} m below the ground");
        assert!(vertices.iter().any(|v| depth(v) < -1.5), "{name}");
        // Between the floor and the eaves no vertex may lie near the ground: a gap would open there.
        assert!(vertices.iter().all(|v| !(-1.0..0.5).contains(&depth(v))), "{name}");
    }
}

#[test]
fn terrain_mesh_keeps_to_the_formula() {
    let params = TownParams::default();
    let (scene, terrain) = (town(&params), params.terrain());
    let mut worst: f64 = 0.0;
    for t in (0..scene.triangles.len()).filter(|&t| scene.materials[t] == Material::Terrain) {
        let [a, b, c] = scene.corners(t).unwrap();
        let middle: [f64; 3] = std::array::from_fn(|i| (a[i] + b[i] + c[i]) / 3.0);
        worst = worst.max((terrain.height(middle[0], middle[1]) - middle[2]).abs());
        assert!((terrain.height(a[0], a[1]) - a[2]).abs() < 1e-9);
        let upward = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        assert!(upward > 0.0);
    }
    assert!(worst > 1e-5 && worst < 0.004 * params.hill_height, "{worst}");
}

#[test]
fn objects_keep_clear_of_roofs_of_others() {
    let usual = TownParams::default();
    for (seed, extent, street_width) in [(1, 120.0, 9.0), (2, 100.0, 12.0), (3, 100.0, 4.0), (4, 200.0, 9.0)] {
        let scene = town(&TownParams { seed, extent, street_width, ..usual.clone() });
        let above_ground = |t: &usize| scene.materials[*t] != Material::Terrain;
        let owned: HashSet<(u32, u32)> = (0..scene.triangles.len())
            .filter(above_ground)
            .flat_map(|t| scene.triangles[t].map(|v| (v, scene.objects[t])))
            .collect();
        for t in (0..scene.triangles.len()).filter(|&t| scene.materials[t] == Material::Roof) {
            let [a, b, c] = scene.corners(t).unwrap();
            for &(v, _) in owned.iter().filter(|&&(_, object)| object != scene.objects[t]) {
                let p = scene.vertices[v as usize];
                let side = |a: [f64; 3], b: [f64; 3]| (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
                let inside = side(a, b) > 0.0 && side(b, c) > 0.0 && side(c, a) > 0.0;
                assert!(!inside, "seed {seed}, extent {extent}: {p:?} lies over or under the roof of another");
            }
        }
    }
}

#[test]
fn obj_text_keeps_vertices_faces_and_objects() {
    let scene = town(&TownParams::default());
    let text = scene.to_obj();
    let starting = |start: &str| text.lines().filter(|l| l.starts_with(start)).count();
    assert_eq!(starting("v "), scene.vertices.len());
    assert_eq!(starting("f "), scene.triangles.len());
    assert_eq!(starting("o "), scene.object_names.len());
    assert!(text.contains("o building_1\nusemtl facade\n") && text.contains("usemtl tree_crown\n"));
    let first: Vec<f64> =
        text.lines().find(|l| l.starts_with("v ")).unwrap().split(' ').skip(1).map(|v| v.parse().unwrap()).collect();
    assert!(first.iter().zip(scene.vertices[0]).all(|(read, exact)| (read - exact).abs() <= 0.000_501));
}
