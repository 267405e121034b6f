//! `belvedere surfaces`: roofs, edges and walls as features, against the exact mesh of a simulated town.

use crate::common::Workplace;
use belvedere::control::Control;
use belvedere::io::{
    FeatureShape, MapFeature, PointResults, ReadOptions, read_cloud, read_features, read_mesh, read_point_results,
};
use belvedere::vector::{cross, dot, length, sub};
use serde_json::Value;

fn text<'a>(feature: &'a MapFeature, name: &str) -> &'a str {
    feature.properties.get(name).and_then(Value::as_str).unwrap_or("")
}

/// The middle of some numbers.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Distance in plan from a place to a line between two corners.
fn beside([x, y, _]: [f64; 3], [a, b]: [[f64; 3]; 2]) -> f64 {
    let way = [b[0] - a[0], b[1] - a[1]];
    let square = way[0] * way[0] + way[1] * way[1];
    let share = if square > 0.0 { ((x - a[0]) * way[0] + (y - a[1]) * way[1]) / square } else { 0.0 }.clamp(0.0, 1.0);
    (x - a[0] - share * way[0]).hypot(y - a[1] - share * way[1])
}

/// Returns true if a place lies within a triangle in plan.
fn holds(corners: &[[f64; 3]; 3], [x, y, _]: [f64; 3]) -> bool {
    let side = |a: [f64; 3], b: [f64; 3]| (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
    let [a, b, c] = *corners;
    let sides = [side(a, b), side(b, c), side(c, a)];
    sides.iter().all(|side| *side >= 0.0) || sides.iter().all(|side| *side <= 0.0)
}

#[test]
fn roofs_and_edges_lie_where_those_of_the_mesh_do() {
    let place = Workplace::new();
    place.summary("simulate town -o town --extent 80 --density 10");
    let made = place.summary("surfaces town/cloud.laz -o found.geojson -o found.laz");
    let (mut cloud, _) = read_cloud([&place.path("town/cloud.laz")], &ReadOptions::new(), &Control::none()).unwrap();
    let features = read_features(&place.path("found.geojson"), &cloud.frame.crs).unwrap();
    let of = |kind: &str| features.iter().filter(|feature| text(feature, "kind") == kind).collect::<Vec<_>>();
    let (roofs, edges, walls) = (of("roof"), of("edge"), of("wall"));
    let lines = of("ridge").len() + of("valley").len();
    for (name, count) in
        [("roofs", roofs.len()), ("edges", edges.len()), ("walls", walls.len()), ("ridges_and_valleys", lines)]
    {
        assert!(count > 3 && made[name] == count, "{name}: {count}, {made}");
    }
    let (mesh, _) = read_mesh(&place.path("town/mesh.obj")).unwrap();
    let triangles: Vec<[[f64; 3]; 3]> =
        mesh.triangles.iter().map(|corners| corners.map(|corner| mesh.vertices[corner as usize])).collect();
    // how far the nearest face with the slope of the roof lies from its middle
    let off = roofs.iter().map(|roof| {
        let FeatureShape::Point(p) = roof.shape else { panic!("{roof:?}") };
        let slope = roof.properties["slope_deg"].as_f64().unwrap();
        let far = |corners: &[[f64; 3]; 3]| {
            let normal = cross(sub(corners[1], corners[0]), sub(corners[2], corners[0]));
            let up = (normal[2].abs() / length(normal)).min(1.0).acos().to_degrees();
            let is_face = holds(corners, p) && (up - slope).abs() < 2.0;
            if is_face { dot(normal, sub(p, corners[0])).abs() / length(normal) } else { f64::INFINITY }
        };
        triangles.iter().map(far).fold(f64::INFINITY, f64::min)
    });
    let off: Vec<f64> = off.collect();
    let near = off.iter().filter(|off| **off < 0.05).count();
    // middles of roofs that enclose a court lie on none of their faces
    assert!(10 * near >= 9 * off.len(), "{off:?}");
    // in plan, from the middle of an edge to the nearest side of a face; noise of a simulated range is 2 cm
    let beside_edges = edges.iter().map(|edge| {
        let FeatureShape::Line(ends) = &edge.shape else { panic!("{edge:?}") };
        let middle = std::array::from_fn(|i| f64::midpoint(ends[0][i], ends[1][i]));
        let sides = triangles.iter().flat_map(|t| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]]);
        sides.map(|side| beside(middle, side)).fold(f64::INFINITY, f64::min)
    });
    assert!(median(beside_edges.collect()) < 0.06, "{made}");
    assert!(made["edge_deviation_m"].as_f64().unwrap() < 0.06, "{made}");
    assert!(!made["remarks"].to_string().contains("no roof was found"), "{made}");
    points_lie_on_their_surfaces(&place, &triangles, &features);
    // a ball file keeps what was found
    place.summary("balls town/cloud.laz -o town.npz");
    let kept = &place.summary("info town.npz")["building_surfaces"];
    for name in ["roofs", "edges", "ridges_and_valleys", "walls", "edge_deviation_m"] {
        assert_eq!(kept[name], made[name], "{name}");
    }
    // without classes the ground is found, and what stands on it
    cloud.attributes.classification = Some(vec![1; cloud.len()]);
    place.write_cloud("bare.laz", &cloud);
    let bare = place.summary("surfaces bare.laz -o none.geojson -o none.laz");
    assert!(bare["roofs"].as_u64().unwrap() > 0, "{bare}");
}

/// Points of roofs and walls lie on faces of the mesh that face the same way, and scatter about their planes as these
/// say.
fn points_lie_on_their_surfaces(place: &Workplace, triangles: &[[[f64; 3]; 3]], features: &[MapFeature]) {
    let PointResults { places, columns } = read_point_results(&place.path("found.laz")).unwrap();
    let column = |name: &str| columns.iter().find(|(own, _)| own == name).unwrap().1.clone();
    let [kinds, numbers, distances] = ["kind", "number", "distance"].map(column);
    for (kind, name) in [(1.0_f32, "roof"), (2.0, "wall")] {
        let rows: Vec<usize> = (0..places.len()).filter(|&row| kinds[row] == kind).collect();
        // three deviations of a range, of 2 cm; walls are met aslant, so that their points scatter by 3 cm
        let most = if kind == 1.0 { 0.06 } else { 0.1 };
        let is_on = |row: usize| {
            triangles.iter().any(|corners| {
                let normal = cross(sub(corners[1], corners[0]), sub(corners[2], corners[0]));
                let (p, up) = (places[row], normal[2].abs() / length(normal));
                let is_near = (dot(normal, sub(p, corners[0])) / length(normal)).abs() < most;
                let is_beside = || (0..3).any(|i| beside(p, [corners[i], corners[(i + 1) % 3]]) < most);
                is_near && if kind == 1.0 { up > 0.3 && holds(corners, p) } else { up < 0.01 && is_beside() }
            })
        };
        let on = rows.iter().filter(|&&row| is_on(row)).count();
        assert!(rows.len() > 300 && 100 * on >= 97 * rows.len(), "{on} of {} lie on a {name}", rows.len());
        let mut whole = 0;
        for feature in features.iter().filter(|feature| text(feature, "kind") == name) {
            let [number, count, noise] = [name, "points", "noise_m"].map(|of| feature.properties[of].as_f64().unwrap());
            let of_it = rows.iter().filter(|&&row| f64::from(numbers[row]) == number);
            let own: Vec<f64> = of_it.map(|&row| f64::from(distances[row])).collect();
            // surfaces that reach into other blocks have some of their points there
            if own.len() as f64 == count {
                whole += 1;
                let root_mean_square = (own.iter().map(|v| v * v).sum::<f64>() / count).sqrt();
                // the direction of a wall is in part that of its edge
                let most = if kind == 1.0 { 0.0002 } else { 0.01 };
                assert!((root_mean_square - noise).abs() < most, "{name} {number}: {root_mean_square}, {noise}");
            }
        }
        assert!(whole > 3, "{name}");
    }
}

#[test]
fn surveys_that_show_no_surfaces_say_so() {
    let place = Workplace::new();
    place.write("bare.xyz", "1 1 1\n2 2 2\n3 4 4\n4 4 5\n");
    let found = place.summary("surfaces bare.xyz -o found.geojson");
    assert!(found["roofs"] == 0 && found["remarks"].to_string().contains("no roof was found"), "{found}");
    place.refusal(2, "surfaces bare.xyz -o found.tif", &[".geojson", ".laz"]);
}
