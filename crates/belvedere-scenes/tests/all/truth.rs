//! Ray answers against a plain loop over all triangles and against closed forms.

#![expect(clippy::unwrap_used, reason = "helpers of tests may panic like the tests themselves")]

use belvedere_scenes::{
    BlockPlan, CONTACT, CrownMaterial, Hit, Material, ObjectPart, PlanPlacement, Preset, StreetTrees, TownParams,
    TriangleScene, Truth, extruded, town,
};
use rayon::prelude::*;

/// Small generator of the tests' own, so that the crate's generator does not judge itself.
struct Lcg(u64);

impl Lcg {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }

    fn direction(&mut self) -> [f64; 3] {
        loop {
            let d: [f64; 3] = std::array::from_fn(|_| self.between(-1.0, 1.0));
            let length = dot(d, d).sqrt();
            if (0.1..1.0).contains(&length) {
                return d.map(|v| v / length);
            }
        }
    }
}

fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Returns the range and the least barycentric coordinate of the crossing of a line with a triangle's plane, by Möller
/// & Trumbore 1997.
fn moeller_trumbore(corners: [[f64; 3]; 3], origin: [f64; 3], direction: [f64; 3]) -> Option<(f64, f64)> {
    let (e1, e2) = (sub(corners[1], corners[0]), sub(corners[2], corners[0]));
    let p = cross(direction, e2);
    let determinant = dot(e1, p);
    if determinant == 0.0 {
        return None;
    }
    let s = sub(origin, corners[0]);
    let u = dot(s, p) / determinant;
    let q = cross(s, e1);
    let v = dot(direction, q) / determinant;
    Some((dot(e2, q) / determinant, u.min(v).min(1.0 - u - v)))
}

/// Returns the range of [`moeller_trumbore`] if the line meets the triangle, with an exit as early as possible.
fn range_to(corners: [[f64; 3]; 3], origin: [f64; 3], direction: [f64; 3]) -> Option<f64> {
    let (e1, e2) = (sub(corners[1], corners[0]), sub(corners[2], corners[0]));
    let p = cross(direction, e2);
    let determinant = dot(e1, p);
    let s = sub(origin, corners[0]);
    let u = dot(s, p) / determinant;
    if !(0.0..=1.0).contains(&u) {
        return None;
    }
    let q = cross(s, e1);
    let v = dot(direction, q) / determinant;
    (v >= 0.0 && u + v <= 1.0).then(|| dot(e2, q) / determinant)
}

/// Returns the first hit by brute force, and true if the ray passes within `EDGE` of the edge of any tested triangle.
fn brute_force(scene: &TriangleScene, origin: [f64; 3], direction: [f64; 3], max_range: f64) -> (Option<Hit>, bool) {
    let (mut best, mut near_edge): (Option<Hit>, bool) = (None, false);
    for (t, triangle) in (0..scene.triangles.len()).zip(0_u32..) {
        let Some((range, inside)) = moeller_trumbore(scene.corners(t).unwrap(), origin, direction) else { continue };
        if range < CONTACT || range > max_range {
            continue;
        }
        near_edge |= inside.abs() < EDGE;
        if inside >= 0.0 && best.is_none_or(|b| range < b.range) {
            best = Some(Hit { range, triangle });
        }
    }
    (best, near_edge)
}

/// Barycentric distance from an edge below which f64 rounding decides. Coordinates of 5e5 m have 6e-11 m, triangles are
/// a few decimetres to metres.
const EDGE: f64 = 1e-8;

fn random_rays(scene: &TriangleScene, count: usize, seed: u64) -> Vec<([f64; 3], [f64; 3])> {
    let (low, high) = scene.bounds().unwrap();
    let mut random = Lcg(seed);
    (0..count)
        .map(|i| {
            let point: [f64; 3] = std::array::from_fn(|k| random.between(low[k] - 5.0, high[k] + 5.0));
            match i % 4 {
                // From the air, as for a scanner.
                0 => {
                    let target: [f64; 3] = std::array::from_fn(|k| random.between(low[k], high[k]));
                    let sensor = [point[0] + 200.0, point[1] - 100.0, 450.0];
                    (sensor, sub(target, sensor))
                }
                // Along the axes, where slab tests divide by zero.
                1 => {
                    let mut direction = if i % 16 < 8 { [0.0; 3] } else { [-0.0; 3] };
                    direction[i / 4 % 3] = if i % 8 < 4 { 1.0 } else { -2.0 };
                    (point, direction)
                }
                _ => (point, random.direction()),
            }
        })
        .collect()
}

#[test]
fn first_hits_equal_brute_force_on_random_rays() {
    let scene = town(&TownParams::default());
    let truth = Truth::new(&scene);
    let (mut hits, mut near_edges) = (0, 0);
    for (number, (origin, direction)) in random_rays(&scene, 6000, 7).into_iter().enumerate() {
        let length = dot(direction, direction).sqrt();
        let unit = direction.map(|v| v / length);
        let max_range = if number % 5 == 0 { 40.0 } else { f64::INFINITY };
        let (expected, near_edge) = brute_force(&scene, origin, unit, max_range);
        near_edges += usize::from(near_edge);
        let found = truth.first_hit(origin, direction, max_range);
        if near_edge {
            continue;
        }
        match (found, expected) {
            (Some(found), Some(expected)) => {
                hits += 1;
                assert_eq!(found.triangle, expected.triangle, "{origin:?} {direction:?}");
                assert!((found.range - expected.range).abs() < 1e-7, "{found:?} {expected:?}");
            }
            (None, None) => {}
            _ => panic!("{found:?} instead of {expected:?} from {origin:?} along {direction:?}"),
        }
    }
    assert!(hits > 2000, "{hits}");
    assert!(near_edges <= 3, "{near_edges} of 6000 rays pass within {EDGE} of an edge");
}

#[test]
fn occlusion_equals_brute_force_between_random_points() {
    let scene = town(&TownParams::default());
    let truth = Truth::new(&scene);
    let (low, mut high) = scene.bounds().unwrap();
    // The heights of houses and trees, with no obstacle above them.
    high[2] = 15.0;
    let mut random = Lcg(11);
    let mut counts = [0; 2];
    for _ in 0..3000 {
        let [a, b]: [[f64; 3]; 2] = std::array::from_fn(|_| std::array::from_fn(|k| random.between(low[k], high[k])));
        let between = sub(b, a);
        let length = dot(between, between).sqrt();
        let unit = between.map(|v| v / length);
        let (segment, near_edge) = brute_force(&scene, a, unit, length - CONTACT);
        let (ray, near_edge_beyond) = brute_force(&scene, a, unit, f64::INFINITY);
        if near_edge || near_edge_beyond {
            continue;
        }
        counts[usize::from(segment.is_some())] += 1;
        assert_eq!(truth.occluded(a, b), segment.is_some());
        assert_eq!(truth.occluded(b, a), segment.is_some());
        assert_eq!(truth.occluded_towards(a, between), ray.is_some());
    }
    assert!(counts[0] > 150 && counts[1] > 1500, "{counts:?}");
}

/// Returns a small town with all objects of presets, courtyards and porous crowns included.
fn rich_town() -> TriangleScene {
    let blocks = [BlockPlan::RowHouses, BlockPlan::HighRise, BlockPlan::Square, BlockPlan::Courtyard];
    town(&TownParams {
        blocks: blocks.map(|plan| (plan, 1)).to_vec(),
        crowns: CrownMaterial::Porous,
        area_per_garden_tree: 2000.0,
        street_trees: StreetTrees::Without,
        ..Preset::Town.params(120.0, 4)
    })
}

#[test]
fn random_rays_through_a_town_with_everything_agree_with_the_plain_loop() {
    let scene = rich_town();
    for material in Material::ALL {
        let expected = material != Material::TreeCrown;
        assert_eq!(scene.materials.contains(&material), expected, "{material:?}");
    }
    let truth = Truth::new(&scene);
    let (low, high) = scene.bounds().unwrap();
    let centre: [f64; 3] = std::array::from_fn(|i| (low[i] + high[i]) / 2.0);
    // About the centre, where the loop rounds a thousand times less than in the national grid. A ray that passes an
    // edge within the rounding might have another answer than the truth. No ray does, so none is left out.
    let triangles: Vec<[[f64; 3]; 3]> =
        (0..scene.triangles.len()).map(|t| scene.corners(t).unwrap().map(|corner| sub(corner, centre))).collect();
    let rays: Vec<_> = random_rays(&scene, 30_000, 77).into_iter().enumerate().collect();
    let outcomes: Vec<Option<bool>> = rays
        .par_iter()
        .map(|&(number, (origin, direction))| {
            let length = dot(direction, direction).sqrt();
            let unit = direction.map(|v| v / length);
            let max_range = if number % 5 == 0 { 40.0 } else { f64::INFINITY };
            let local = sub(origin, centre);
            let nearest = triangles
                .iter()
                .filter_map(|&corners| range_to(corners, local, unit))
                .filter(|&range| range >= CONTACT && range <= max_range)
                .fold(f64::INFINITY, f64::min);
            let found = truth.first_hit(origin, direction, max_range);
            let end: [f64; 3] = std::array::from_fn(|i| origin[i] + unit[i] * 40.0);
            let blocked =
                if number % 5 == 0 { truth.occluded(origin, end) } else { truth.occluded_towards(origin, direction) };
            // Two surfaces may cross at the hit. The found triangle must be met at that range.
            let agrees = match found {
                None => nearest.is_infinite(),
                Some(hit) => {
                    let own = range_to(triangles[hit.triangle as usize], local, unit).unwrap_or(f64::NAN);
                    // 1e-9 m of rounding in the national grid, a hundred times that for grazing rays.
                    (hit.range - nearest).abs() < 1e-7 && (own - nearest).abs() < 1e-7
                }
            };
            (agrees && blocked == found.is_some()).then_some(blocked)
        })
        .collect();
    let disagreements = outcomes.iter().filter(|outcome| outcome.is_none()).count();
    assert_eq!(disagreements, 0, "of {} rays through {} triangles", rays.len(), triangles.len());
    let hits = outcomes.iter().filter(|outcome| **outcome == Some(true)).count();
    assert!((9_000..27_000).contains(&hits), "{hits}");
}

/// Returns a square of ground, 400 m wide, at height 0, with a box of height 10 over −5…5 (x) and −8…8 (y).
fn box_on_plane() -> TriangleScene {
    let mut scene = TriangleScene::default();
    let vertices = vec![[-200.0, -200.0, 0.0], [200.0, -200.0, 0.0], [200.0, 200.0, 0.0], [-200.0, 200.0, 0.0]];
    let ground = ObjectPart { vertices, triangles: vec![[0, 1, 2], [0, 2, 3]], materials: vec![Material::Terrain; 2] };
    scene.add_object("ground", &[ground]);
    let footprint = PlanPlacement { origin: [0.0; 2], angle: 0.0 }.rectangle(10.0, 16.0);
    scene.add_object("box", &[extruded(&footprint, -1.0, 10.0)]);
    scene
}

#[test]
fn ray_onto_plane_has_the_closed_form_range() {
    let truth = Truth::new(&box_on_plane());
    let mut random = Lcg(3);
    for _ in 0..2000 {
        let origin = [random.between(20.0, 60.0), random.between(-60.0, 60.0), random.between(1.0, 900.0)];
        let target = [random.between(10.0, 150.0), random.between(-150.0, 150.0), 0.0];
        let direction = sub(target, origin);
        let hit = truth.first_hit(origin, direction, f64::INFINITY).unwrap();
        assert!((hit.range - dot(direction, direction).sqrt()).abs() < 1e-9, "{hit:?}");
    }
}

#[test]
fn shadow_of_a_box_is_height_over_tangent_of_elevation_long() {
    let truth = Truth::new(&box_on_plane());
    for elevation_deg in [5.0_f64, 20.0, 45.0, 70.0, 89.0] {
        let elevation = elevation_deg.to_radians();
        let to_sun = [elevation.cos(), 0.0, elevation.sin()];
        let edge = -5.0 - 10.0 / elevation.tan();
        // Queries lie on the ground itself, which must not shade them.
        for y in [-7.9, -3.3, 0.0, 4.1, 7.9] {
            assert!(truth.occluded_towards([edge + 1e-4, y, 0.0], to_sun), "{elevation_deg}");
            assert!(!truth.occluded_towards([edge - 1e-4, y, 0.0], to_sun), "{elevation_deg}");
        }
        assert!(!truth.occluded_towards([edge + 1.0, 8.001, 0.0], to_sun));
        assert!(!truth.occluded_towards([5.001, 0.0, 0.0], to_sun), "the sunny side stays lit");
    }
}

#[test]
fn points_on_a_surface_are_not_hidden_by_it_but_by_what_lies_behind() {
    let truth = Truth::new(&box_on_plane());
    assert!(!truth.occluded([0.0, 0.0, 10.0], [30.0, 0.0, 40.0]));
    assert!(truth.occluded([0.0, 0.0, 10.0], [30.0, 0.0, 5.0]), "below the horizon of the roof");
    assert!(!truth.occluded([5.0, 0.0, 3.0], [50.0, 0.0, 0.0]), "a wall sees the ground before it");
    assert!(truth.occluded([5.0, 0.0, 3.0], [-50.0, 0.0, 3.0]));
}

#[test]
fn surfaces_are_met_from_micrometres_to_kilometres_away() {
    let scene = town(&TownParams::default());
    let truth = Truth::new(&scene);
    for t in (0..scene.triangles.len()).step_by(7) {
        let [a, b, c] = scene.corners(t).unwrap();
        let normal = cross(sub(b, a), sub(c, a));
        let length = dot(normal, normal).sqrt();
        let middle: [f64; 3] = std::array::from_fn(|i| (a[i] + b[i] + c[i]) / 3.0);
        for range in [3e-6, 1e-5, 1e-4, 1e-3, 1e-2] {
            let origin: [f64; 3] = std::array::from_fn(|i| middle[i] + normal[i] / length * range);
            let hit = truth.first_hit(origin, normal.map(|v| -v), f64::INFINITY).unwrap();
            assert!(hit.range < range + 1e-8, "{hit:?} instead of {t} at {range}");
            let hit = truth.first_hit(origin, normal.map(|v| -v), range + 1e-7).unwrap();
            assert!(hit.range < range + 1e-8, "a reach that ends just beyond must not lose the surface");
        }
    }
    let tower_top = (0..scene.vertices.len()).map(|v| scene.vertices[v]).max_by(|a, b| a[2].total_cmp(&b[2])).unwrap();
    let below_top = [tower_top[0], tower_top[1], tower_top[2] - 0.1];
    for kilometres in [1.0, 30.0, 1000.0] {
        let direction = [0.6, 0.5, 0.4];
        let origin: [f64; 3] = std::array::from_fn(|i| below_top[i] + direction[i] * kilometres * 1e3);
        let hit = truth.first_hit(origin, direction.map(|v| -v), f64::INFINITY).unwrap();
        let expected = kilometres * 1e3 * dot(direction, direction).sqrt();
        assert!((hit.range - expected).abs() < 8.0, "{kilometres} km: {hit:?} {expected}");
    }
}

#[test]
fn no_ray_slips_through_the_edges_of_a_closed_solid() {
    let mut scene = TriangleScene::default();
    let placement = PlanPlacement { origin: [155_000.0, 463_000.0], angle: 0.37 };
    scene.add_object("box", &[extruded(&placement.rectangle(10.0, 6.0), 0.0, 5.0)]);
    let truth = Truth::new(&scene);
    let centre = [155_000.0, 463_000.0, 2.5];
    for t in 0..scene.triangles.len() {
        let [a, b, c] = scene.corners(t).unwrap();
        for (p, q) in [(a, b), (b, c), (c, a)] {
            for step in 0..=50 {
                let on_edge: [f64; 3] = std::array::from_fn(|i| p[i] + (q[i] - p[i]) * f64::from(step) / 50.0);
                assert!(truth.first_hit(centre, sub(on_edge, centre), f64::INFINITY).is_some(), "{on_edge:?}");
            }
        }
    }
}

#[test]
fn batches_equal_single_queries() {
    let scene = town(&TownParams::default());
    let truth = Truth::new(&scene);
    let (origins, directions): (Vec<_>, Vec<_>) = random_rays(&scene, 2000, 5).into_iter().unzip();
    let hits = truth.first_hits(&origins, &directions, 500.0);
    let sun = [0.5, -0.4, 0.6];
    let lit = truth.occluded_towards_each(&origins, sun);
    let seen = truth.occluded_each(&origins, [155_003.0, 463_004.0, 30.0]);
    for i in 0..origins.len() {
        assert_eq!(hits[i], truth.first_hit(origins[i], directions[i], 500.0));
        assert_eq!(lit[i], truth.occluded_towards(origins[i], sun));
        assert_eq!(seen[i], truth.occluded(origins[i], [155_003.0, 463_004.0, 30.0]));
    }
}

#[test]
fn hostile_queries_and_scenes_block_nothing() {
    let empty = Truth::new(&TriangleScene::default());
    assert_eq!(empty.first_hit([0.0; 3], [0.0, 0.0, -1.0], f64::INFINITY), None);
    assert!(!empty.occluded([0.0; 3], [1.0; 3]));

    let mut broken = box_on_plane();
    broken.triangles.push([0, 1, 999_999]);
    broken.vertices.push([f64::NAN; 3]);
    broken.triangles.push([0, 1, u32::try_from(broken.vertices.len()).unwrap() - 1]);
    let truth = Truth::new(&broken);
    let down = [0.0, 0.0, -1.0];
    assert!((truth.first_hit([0.0, 0.0, 50.0], down, f64::INFINITY).unwrap().range - 40.0).abs() < 1e-9);
    for direction in [[0.0; 3], [f64::NAN, 0.0, 1.0], [f64::INFINITY, 0.0, 0.0]] {
        assert_eq!(truth.first_hit([0.0, 0.0, 50.0], direction, f64::INFINITY), None);
    }
    assert_eq!(truth.first_hit([f64::NAN; 3], down, f64::INFINITY), None);
    assert_eq!(truth.first_hit([0.0, 0.0, 50.0], down, f64::NAN), None);
    assert_eq!(truth.first_hit([0.0, 0.0, 50.0], down, 39.9), None);
    assert!(!truth.occluded([1.0; 3], [1.0; 3]));

    let mut single = TriangleScene::default();
    let corners = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    single.add_object(
        "one",
        &[ObjectPart { vertices: corners, triangles: vec![[0, 1, 2]], materials: vec![Material::Roof] }],
    );
    assert!(Truth::new(&single).occluded([0.2, 0.2, 1.0], [0.2, 0.2, -1.0]));
}
