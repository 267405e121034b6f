//! Targets fit their kind, by tests without the code that draws them.

use belvedere_scenes::{
    Hit, Material, PlanPlacement, Preset, QuerySet, QuerySite, RoofDetails, TownParams, TriangleScene, Truth, extruded,
    town,
};

fn site<'a>(scene: &'a TriangleScene, truth: &'a Truth) -> QuerySite<'a> {
    let (low, high) = scene.bounds().unwrap();
    QuerySite { scene, truth, bounds: [low, high] }
}

#[test]
fn a_point_is_inside_exactly_where_the_formulas_of_the_solids_say() {
    // Two boxes that overlap: the union counts, not the parity of its faces.
    let at = |x: f64| PlanPlacement { origin: [x, 0.0], angle: 0.3 };
    let mut scene = TriangleScene::default();
    let solids = [(at(0.0), 10.0, 6.0, 0.0, 8.0), (at(3.0), 9.0, 4.0, -2.0, 5.0)];
    for (place, length, width, bottom, top) in solids {
        scene.add_object("box", &[extruded(&place.rectangle(length, width), bottom, top)]);
    }
    let truth = Truth::new(&scene);
    let site = site(&scene, &truth);
    let mut inside_count = 0;
    for target in site.targets(QuerySet::Volume, 20_000, 5).positions {
        let expected = solids.iter().any(|(place, length, width, bottom, top)| {
            let (dx, dy) = (target[0] - place.origin[0], target[1] - place.origin[1]);
            let (sin, cos) = place.angle.sin_cos();
            let (u, v) = (dx * cos + dy * sin, dy * cos - dx * sin);
            u.abs() < length / 2.0 && v.abs() < width / 2.0 && (*bottom..*top).contains(&target[2])
        });
        inside_count += usize::from(expected);
        assert_eq!(site.is_inside(target), expected, "{target:?}");
    }
    assert!((2000..18_000).contains(&inside_count), "{inside_count}");
}

#[test]
fn targets_of_each_kind_lie_where_they_should() {
    let params = TownParams::default();
    let (scene, ground) = (town(&params), params.terrain());
    let truth = Truth::new(&scene);
    let site = site(&scene, &truth);
    for set in QuerySet::ALL {
        let targets = site.targets(set, 2000, 1);
        // Pairs over 100 m apart hardly fit into a town of 120 m: a quarter of all pairs, of which some are not found.
        let min = if set == QuerySet::LinesOfSight { 1500 } else { 2000 };
        assert!((min..=2000).contains(&targets.positions.len()), "{}: {}", set.name(), targets.positions.len());
        let above = |p: &[f64; 3]| p[2] - ground.height(p[0], p[1]);
        // The mesh departs from the formula of the ground by less than 5 mm.
        let at_height = |height: f64| targets.positions.iter().all(|p| (above(p) - height).abs() < 0.005);
        match set {
            QuerySet::Volume => assert!(targets.positions.iter().any(|p| site.is_inside(*p))),
            QuerySet::Air => assert!(targets.positions.iter().all(|p| !site.is_inside(*p) && above(p) > -0.005)),
            QuerySet::Pedestrians => assert!(at_height(1.5)),
            QuerySet::Ground => assert!(at_height(0.1)),
            QuerySet::Roofs | QuerySet::Facades => {
                let material = if set == QuerySet::Roofs { Material::Roof } else { Material::Facade };
                let near = |p: &[f64; 3]| {
                    // Within 0.1 m of a triangle of the material: its plane and, widened, its box.
                    (0..scene.triangles.len()).filter(|&t| scene.materials[t] == material).any(|t| {
                        let corners = scene.corners(t).unwrap();
                        let e = |k: usize| -> [f64; 3] { std::array::from_fn(|i| corners[k][i] - corners[0][i]) };
                        let (a, b) = (e(1), e(2));
                        let n = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
                        let size = n.iter().map(|v| v * v).sum::<f64>().sqrt();
                        let off = (0..3).map(|i| n[i] * (p[i] - corners[0][i])).sum::<f64>() / size;
                        let boxed = (0..3).all(|i| {
                            let values = corners.map(|c| c[i]);
                            let low = values.iter().copied().fold(f64::INFINITY, f64::min) - 0.101;
                            (low..=values.iter().copied().fold(f64::NEG_INFINITY, f64::max) + 0.101).contains(&p[i])
                        });
                        (off - 0.1).abs() < 1e-6 && boxed
                    })
                };
                assert!(targets.positions.iter().take(300).all(near), "{}", set.name());
            }
            QuerySet::LinesOfSight => {
                assert!(at_height(1.6));
                assert_eq!(targets.eyes.len(), targets.positions.len());
                let ranges: Vec<f64> = targets
                    .positions
                    .iter()
                    .zip(&targets.eyes)
                    .map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1]))
                    .collect();
                for class in [5.0..25.0, 25.0..50.0, 50.0..100.0] {
                    assert_eq!(ranges.iter().filter(|r| class.contains(*r)).count(), 500, "{class:?} m");
                }
                assert!(ranges.iter().all(|r| (5.0..=200.0).contains(r)));
            }
        }
    }
}

#[test]
fn targets_at_roofs_lie_above_them_and_those_at_walls_not_in_their_eaves() {
    let roofs = RoofDetails { eaves: 1.0, parapets: 1.0, boxes: 1.0, chimneys: 1.0 };
    let scene = town(&TownParams { roofs, ..Preset::Town.params(125.0, 2) });
    let truth = Truth::new(&scene);
    let site = site(&scene, &truth);
    let material = |hit: Option<Hit>| hit.map(|hit| scene.materials[hit.triangle as usize]);
    let above_roofs = site.targets(QuerySet::Roofs, 3000, 1).positions;
    let under = above_roofs.iter().map(|&p| material(truth.first_hit(p, [0.0, 0.0, -1.0], 0.5)));
    // A point 0.1 m off a slope of 45 degrees lies up to 7 cm beyond its eaves; slopes are 5 m long.
    let over_roof = under.filter(|m| matches!(m, Some(Material::Roof))).count();
    assert!(over_roof > 2940, "{over_roof}");
    let (mut under_eaves, mut level) = (0, 0);
    for p in site.targets(QuerySet::Facades, 3000, 1).positions {
        assert!(!site.is_inside(p));
        under_eaves += usize::from(material(truth.first_hit(p, [0.0, 0.0, 1.0], 30.0)) == Some(Material::Roof));
        // A wall is 0.1 m away in one of the horizontal directions.
        level += usize::from((0..360).any(|i| {
            let (sin, cos) = (f64::from(i) * std::f64::consts::TAU / 360.0).sin_cos();
            truth.first_hit(p, [cos, sin, 0.0], 0.1001).is_some()
        }));
    }
    // Most walls here have eaves or balconies above them, except those of towers and gables.
    assert!((600..2400).contains(&under_eaves), "{under_eaves}");
    assert_eq!(level, 3000, "upright faces only");
}

#[test]
fn a_longer_list_begins_with_the_shorter_one_and_threads_do_not_matter() {
    let scene = town(&TownParams::default());
    let truth = Truth::new(&scene);
    let site = site(&scene, &truth);
    let long = site.targets(QuerySet::Pedestrians, 500, 9);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let short = pool.install(|| site.targets(QuerySet::Pedestrians, 200, 9));
    assert_eq!(long.positions[..200], short.positions);
    assert_ne!(site.targets(QuerySet::Pedestrians, 200, 10).positions, short.positions);
}

#[test]
fn observers_stand_in_the_open_and_above_the_highest_roof() {
    let params = TownParams::default();
    let (scene, ground) = (town(&params), params.terrain());
    let truth = Truth::new(&scene);
    let site = site(&scene, &truth);
    let [street, tower] = site.observers(1).map(Option::unwrap);
    assert!((street[2] - ground.height(street[0], street[1]) - 1.6).abs() < 0.005);
    assert!(!truth.occluded_towards(street, [0.0, 0.0, 1.0]) && !site.is_inside(street));
    let roofs = scene.triangles.iter().zip(&scene.materials).filter(|(_, m)| **m == Material::Roof);
    let top = roofs.flat_map(|(t, _)| *t).map(|v| scene.vertices[v as usize][2]).fold(f64::NEG_INFINITY, f64::max);
    assert!((tower[2] - top - 6.0).abs() < 1e-9, "{tower:?} above {top}");
    let empty = TriangleScene::default();
    let nothing = Truth::new(&empty);
    let nowhere = QuerySite { scene: &empty, truth: &nothing, bounds: [[0.0; 3], [1.0; 3]] };
    assert_eq!(nowhere.observers(1), [None, None]);
    assert!(nowhere.targets(QuerySet::Roofs, 10, 1).positions.is_empty());
}
