//! LoD1 blocks: closed prisms over the footprints, up to the height that 70 % of the roof lies below.

use std::collections::{HashMap, HashSet};

use belvedere_scenes::{
    Material, ObjectPart, PlanPlacement, Preset, TownParams, TriangleScene, blocks, extruded, ridged, town,
};

const UPRIGHT: PlanPlacement = PlanPlacement { origin: [155_000.0, 463_000.0], angle: 0.3 };

fn volume(scene: &TriangleScene, object: &str) -> f64 {
    let wanted = |t: &usize| scene.object_names[scene.objects[*t] as usize] == object;
    let triangles = (0..scene.triangles.len()).filter(wanted).map(|t| scene.triangles[t]).collect::<Vec<_>>();
    ObjectPart { vertices: scene.vertices.clone(), materials: Vec::new(), triangles }.volume()
}

/// Checks two volumes for equality. Volumes in the national grid are rounded at 1e-10 m times 1e2 m².
fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() < 1e-6 * expected, "{found} instead of {expected}");
}

#[test]
fn block_of_a_gable_roof_ends_at_seven_tenths_of_it() {
    let mut scene = TriangleScene::default();
    scene.add_object("house", &[ridged(&UPRIGHT.rectangle(10.0, 8.0), -1.0, 5.0, 9.0, 0.0)]);
    scene.add_object("hall", &[extruded(&UPRIGHT.moved(30.0, 0.0, 0.0).rectangle(12.0, 7.0), -1.0, 6.0)]);
    let generalised = blocks(&scene);
    // Heights of a gable roof are spread evenly from eaves to ridge.
    near(volume(&generalised, "house"), 10.0 * 8.0 * (1.0 + 5.0 + 0.7 * 4.0));
    near(volume(&generalised, "hall"), 12.0 * 7.0 * 7.0);
}

#[test]
fn block_of_a_pyramid_ends_where_it_has_shrunk_to_three_tenths() {
    let mut scene = TriangleScene::default();
    scene.add_object("tent", &[ridged(&UPRIGHT.rectangle(8.0, 8.0), 0.0, 4.0, 10.0, 3.999)]);
    // The plan of a pyramid above height share s is (1 − s)² of all: 0.3 at s = 1 − √0.3. A ridge of 2 mm is
    // negligible.
    let expected = 64.0 * (4.0 + 6.0 * (1.0 - 0.3_f64.sqrt()));
    let found = volume(&blocks(&scene), "tent");
    assert!((found / expected - 1.0).abs() < 1e-3, "{found} {expected}");
}

#[test]
fn what_sits_on_a_roof_counts_with_the_part_below_and_is_no_block() {
    let mut scene = TriangleScene::default();
    let vertices = vec![[154_900.0, 462_900.0, 0.0], [155_100.0, 462_900.0, 0.0], [155_000.0, 463_200.0, 0.0]];
    let ground = ObjectPart { vertices, triangles: vec![[0, 1, 2]], materials: vec![Material::Terrain] };
    scene.add_object("terrain", &[ground]);
    let tower = extruded(&UPRIGHT.rectangle(10.0, 10.0), -1.0, 30.0);
    let small = extruded(&UPRIGHT.rectangle(4.0, 4.0), 29.0, 33.0);
    let large = extruded(&UPRIGHT.rectangle(8.0, 8.0), 29.0, 33.0);
    let slab = extruded(&UPRIGHT.moved(20.0, 0.0, 0.0).rectangle(5.0, 5.0), 3.0, 3.2).with_material(Material::Slab);
    scene.add_object("small", &[tower.clone(), small]);
    scene.add_object("large", &[tower, large]);
    scene.add_object("canopy", &[slab]);
    let generalised = blocks(&scene);
    near(volume(&generalised, "small"), 100.0 * 31.0);
    // 64 of 164 m² of roof lie at 33 m, more than three tenths.
    near(volume(&generalised, "large"), 100.0 * 34.0);
    assert_eq!(generalised.object_names, ["terrain", "small", "large"]);
    assert!(generalised.triangles.len() == 1 + 24);
}

#[test]
fn every_building_of_every_preset_becomes_a_closed_block_of_its_whole_outline() {
    for preset in Preset::ALL {
        let scene = town(&preset.params(125.0, 2));
        let generalised = blocks(&scene);
        let expected: HashSet<&String> =
            scene.object_names.iter().filter(|n| n.starts_with("building") || *n == "terrain").collect();
        assert_eq!(generalised.object_names.iter().collect::<HashSet<_>>(), expected, "{preset:?}");

        let mut edges: HashMap<(u32, u32), u32> = HashMap::new();
        let mut plan_areas: HashMap<&str, f64> = HashMap::new();
        for (t, &triangle) in generalised.triangles.iter().enumerate() {
            if generalised.materials[t] == Material::Terrain {
                continue;
            }
            let [a, b, c] = triangle;
            for edge in [(a, b), (b, c), (c, a)] {
                *edges.entry(edge).or_default() += 1;
            }
            let corners = generalised.corners(t).unwrap();
            let name = generalised.object_names[generalised.objects[t] as usize].as_str();
            *plan_areas.entry(name).or_default() += upward_area(corners).max(0.0);
            let flat = corners.iter().all(|corner| corner[2] == corners[0][2]);
            assert!(flat || upward_area(corners).abs() < 1e-6, "blocks have level and upright faces only");
        }
        assert!(edges.iter().all(|(&(a, b), &count)| count == 1 && edges.get(&(b, a)) == Some(&1)), "{preset:?}");

        // The first part of a building stands on the ground; its roof covers its outline, arcades included.
        let mut first_roof: HashMap<&str, (u32, f64)> = HashMap::new();
        for t in (0..scene.triangles.len()).filter(|&t| scene.materials[t] == Material::Roof) {
            let name = scene.object_names[scene.objects[t] as usize].as_str();
            let (part, area) = first_roof.entry(name).or_insert((scene.parts[t], 0.0));
            if *part == scene.parts[t] {
                *area += upward_area(scene.corners(t).unwrap());
            }
        }
        let mut compared = 0;
        for (name, (_, roof)) in first_roof {
            let plan = plan_areas[name];
            // Churches have a second part on the ground, their tower of 36 m².
            assert!(
                (plan - roof).abs() < 1e-5 || (plan - roof - 36.0).abs() < 1e-5,
                "{preset:?} {name}: {plan} {roof}"
            );
            compared += 1;
        }
        assert_eq!(compared + 1, generalised.object_names.len());
    }
}

fn upward_area([a, b, c]: [[f64; 3]; 3]) -> f64 {
    ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2.0
}

#[test]
fn terrain_stays_and_scenes_without_roofs_lose_everything_else() {
    let scene = town(&TownParams::default());
    let terrain = |scene: &TriangleScene| -> Vec<[[f64; 3]; 3]> {
        let own = (0..scene.triangles.len()).filter(|&t| scene.materials[t] == Material::Terrain);
        own.map(|t| scene.corners(t).unwrap()).collect()
    };
    assert_eq!(terrain(&blocks(&scene)), terrain(&scene));
    assert!(blocks(&TriangleScene::default()).triangles.is_empty());
}
