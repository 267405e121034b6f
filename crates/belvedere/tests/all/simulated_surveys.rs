//! Consistency of simulated surveys: returns with the exact mesh along their rays, angles and times with the written
//! trajectory, written meshes with the scene.

use crate::common::simulated::cloud_of;
use belvedere::control::Control;
use std::path::Path;

use belvedere::io::{
    LevelOfDetail, ReadOptions, VehicleHeading, read_cityjson, read_cloud, read_mesh, read_trajectory, write_cloud,
    write_trajectory,
};
use belvedere::summary::{CloudSummary, FacadeSummary};
use belvedere::trajectory::Trajectory;
use belvedere::{GpsTimeKind, PointCloud};
use belvedere_scenes::{
    AirborneParams, BeamParams, Material, MirrorMotion, Preset, Regime, Scan, ScanPattern, TerrestrialParams,
    TownParams, TriangleScene, Truth, scan_airborne, scan_terrestrial, town,
};

/// Cloud and trajectory as they come back from files: positions of the cloud in file coordinates, and of the scanner at
/// the time of each point.
struct Delivered {
    cloud: PointCloud,
    positions: Vec<[f64; 3]>,
    sensors: Vec<[f64; 3]>,
}

fn delivered(scan: &Scan, folder: &Path, trajectory_name: &str) -> Delivered {
    let cloud = cloud_of(scan);
    let (cloud_file, path_file) = (folder.join("cloud.laz"), folder.join(trajectory_name));
    write_cloud(&cloud_file, &cloud, &[]).unwrap();
    let path = &scan.sensor_path;
    let trajectory = Trajectory { times: path.times.clone(), positions: path.positions.clone() };
    let heading = VehicleHeading::Given(&path.headings);
    write_trajectory(&path_file, &trajectory, GpsTimeKind::AdjustedStandard, &cloud.frame.crs, heading).unwrap();

    let (cloud, _) = read_cloud(&[cloud_file], &ReadOptions::default(), &Control::none()).unwrap();
    let (trajectory, _) = read_trajectory(&path_file, &cloud.frame.crs).unwrap();
    let times = cloud.attributes.gps_time.clone().unwrap();
    let clock = trajectory.clock_offset_for(&times, cloud.attributes.gps_time_kind);
    assert_eq!(clock.known_count, cloud.len(), "the path is known at the time of every return");
    let sensors = times.iter().map(|&t| trajectory.position_at(clock.trajectory_time(t)).unwrap()).collect();
    let positions = cloud.positions.iter().map(|&p| cloud.frame.to_file_coordinates(p)).collect();
    Delivered { cloud, positions, sensors }
}

fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn unit(a: [f64; 3]) -> [f64; 3] {
    a.map(|v| v / dot(a, a).sqrt())
}

fn normal(scene: &TriangleScene, triangle: usize) -> [f64; 3] {
    let [a, b, c] = scene.corners(triangle).unwrap();
    let (u, v) = (sub(b, a), sub(c, a));
    unit([u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]])
}

/// Maximum shift of a return by the millimetres of the files, metres: half a step along each axis, and a tenth of it in
/// the trajectory.
const FILE_STEP: f64 = 0.000_87 + 0.000_1;

/// Checks that returns lie within four deviations of the mesh along their rays, all but the share that noise explains.
fn check_ranges(scene: &TriangleScene, scan: &Scan, files: &Delivered, range_sd: f64, what: &str) {
    let truth = Truth::new(scene);
    let (mut beyond, mut without_surface, mut squares) = (0, 0, 0.0);
    for i in 0..scan.len() {
        let ray = sub(files.positions[i], files.sensors[i]);
        let range = dot(ray, ray).sqrt();
        let direction = unit(ray);
        let normal = normal(scene, scan.triangle[i] as usize);
        let [corner, ..] = scene.corners(scan.triangle[i] as usize).unwrap();
        let cosine = dot(direction, normal).abs();
        // Along the ray to the plane of the surface met; a millimetre aside counts for more on slanting surfaces.
        let along = range - dot(sub(corner, files.sensors[i]), normal) / dot(direction, normal);
        let slack = FILE_STEP / cosine.max(1e-3);
        beyond += usize::from(along.abs() > 4.0 * range_sd + slack);
        squares += along * along * f64::from(u8::from(cosine > 0.1));
        // And by the mesh alone, without asking which triangle it was.
        let reach = 4.0 * range_sd + slack;
        let start: [f64; 3] = std::array::from_fn(|k| files.positions[i][k] - reach * direction[k]);
        without_surface += usize::from(truth.first_hit(start, direction, 2.0 * reach).is_none());
    }
    // A normal number lies beyond four deviations once in 16 000; the sum of twelve uniform numbers, whose tails are
    // shorter, once in 30 000. Four deviations of the count on top.
    let expected = scan.len() as f64 * 6.3e-5;
    assert!((beyond as f64) < expected + 4.0 * expected.sqrt() + 1.0, "{what}: {beyond} of {}", scan.len());
    // Some rays that just met an edge miss it by the millimetre of the files.
    assert!((without_surface as f64) < 5e-4 * scan.len() as f64, "{what}: {without_surface} of {}", scan.len());
    let sd = (squares / scan.len() as f64).sqrt();
    // The noise is all there: nothing else adds or takes away more than a few percent.
    assert!((sd / range_sd - 1.0).abs() < 0.05, "{what}: {sd}");
}

#[test]
fn airborne_returns_of_every_pattern_agree_with_mesh_trajectory_and_angle() {
    let scene = town(&TownParams::default());
    let folder = tempfile::tempdir().unwrap();
    for (pattern, trajectory_name) in [
        (ScanPattern::Rotating, "trajectory.csv"),
        (ScanPattern::Rotating, "trajectory.sbet"),
        (ScanPattern::Oscillating(MirrorMotion::Sinusoidal), "trajectory.sbet"),
        (ScanPattern::Oscillating(MirrorMotion::Triangular), "trajectory.csv"),
        (ScanPattern::CONICAL_20, "trajectory.sbet"),
    ] {
        // Directions without error and a beam without width, so that the line from the scanner to a return is the ray
        // that met the surface.
        let beam = BeamParams { divergence: 0.0, ..BeamParams::default() };
        let quiet = AirborneParams { pattern, beam, pointing_sd: 0.0, boresight_sd: 0.0, ..AirborneParams::default() };
        let params = AirborneParams { cross_strip_count: 1, ..quiet }.spread_over(&scene, None, 4.0);
        let scan = scan_airborne(&scene, &params);
        assert!(scan.len() > 40_000);
        let files = delivered(&scan, folder.path(), trajectory_name);
        let what = format!("{pattern:?} {trajectory_name}");
        check_ranges(&scene, &scan, &files, params.range_sd, &what);

        let path = &scan.sensor_path;
        let angles = files.cloud.attributes.scan_angle.as_ref().unwrap();
        for (i, &angle) in angles.iter().enumerate() {
            let record = path.times.partition_point(|&t| t <= scan.gps_time[i]);
            let (sin, cos) = path.headings[record].sin_cos();
            let ray = sub(files.positions[i], files.sensors[i]);
            let geometric = (ray[0] * cos - ray[1] * sin).atan2(-ray[2]);
            // Half a step of 0.006 degrees, and a millimetre at 450 m.
            let tolerance = 0.003_f64.to_radians() + 4e-6;
            assert!((geometric - f64::from(angle)).abs() < tolerance, "{what}: {geometric} {angle}");
            if let ScanPattern::Conical { half_angle } = pattern {
                let from_nadir = (-ray[2] / dot(ray, ray).sqrt()).acos();
                assert!((from_nadir - half_angle).abs() < tolerance, "{from_nadir}");
            }
        }
    }
}

#[test]
fn tripod_returns_agree_with_mesh_trajectory_and_angle() {
    let scene = town(&TownParams::default());
    let folder = tempfile::tempdir().unwrap();
    let usual = TerrestrialParams::default();
    let mut beam = usual.beam.clone();
    (beam.foliage_depth, beam.divergence) = (0.0, 0.0);
    let params =
        TerrestrialParams { beam, pointing_sd: 0.0, angular_step: 0.6_f64.to_radians(), range_sd: 0.01, ..usual };
    let scan = scan_terrestrial(&scene, &params);
    assert!(scan.len() > 100_000, "{}", scan.len());
    for name in ["trajectory.csv", "trajectory.sbet"] {
        let files = delivered(&scan, folder.path(), name);
        check_ranges(&scene, &scan, &files, params.range_sd, name);
        let angles = files.cloud.attributes.scan_angle.as_ref().unwrap();
        for (i, &angle) in angles.iter().enumerate() {
            let ray = sub(files.positions[i], files.sensors[i]);
            let range = dot(ray, ray).sqrt();
            let from_nadir = (-ray[2] / range).acos();
            let tolerance = 0.003_f64.to_radians() + 2.0 * FILE_STEP / range;
            assert!((from_nadir - f64::from(angle)).abs() < tolerance, "{from_nadir} {angle}");
        }
    }
}

#[test]
fn returns_from_inside_crowns_lie_within_noise_of_their_exact_range() {
    let scene = town(&TownParams::default());
    let folder = tempfile::tempdir().unwrap();
    let params = AirborneParams { pointing_sd: 0.0, boresight_sd: 0.0, ..AirborneParams::covering(&scene, 6.0) };
    let scan = scan_airborne(&scene, &params);
    let files = delivered(&scan, folder.path(), "trajectory.sbet");
    let mut beyond = 0;
    for i in 0..scan.len() {
        let ray = sub(files.positions[i], files.sensors[i]);
        let exact = sub(scan.exact_positions[i], files.sensors[i]);
        let along = dot(ray, unit(exact)) - dot(exact, exact).sqrt();
        let across = dot(ray, ray) - dot(ray, unit(exact)).powi(2);
        // the ray that met the surface is up to half the beam beside the axis, on which the return lies
        let beam = params.beam.divergence / 2.0 * dot(ray, ray).sqrt();
        assert!(across.max(0.0).sqrt() < beam + 2.0 * FILE_STEP + 1e-3, "within the beam");
        beyond += usize::from(along.abs() > 4.0 * params.range_sd + FILE_STEP);
    }
    let expected = scan.len() as f64 * 6.3e-5;
    assert!((beyond as f64) < expected + 4.0 * expected.sqrt() + 1.0, "{beyond} of {}", scan.len());
}

/// Area of the walls of `scene` above the ground, m²: by rows of samples that lie above `terrain`.
fn wall_area(scene: &TriangleScene, terrain: &belvedere_scenes::Terrain) -> f64 {
    let steps = 20_u32;
    let walls = (0..scene.triangles.len())
        .filter(|&t| scene.materials[t] == Material::Facade && normal(scene, t)[2].abs() < 0.3);
    walls
        .map(|t| {
            let [a, b, c] = scene.corners(t).unwrap();
            let (u, v) = (sub(b, a), sub(c, a));
            let area = (dot(u, u) * dot(v, v) - dot(u, v).powi(2)).sqrt() / 2.0;
            let (mut above, mut count) = (0, 0);
            for i in 0..steps {
                for j in 0..steps - i {
                    let [s, r] = [i, j].map(|k| (f64::from(k) + 1.0 / 3.0) / f64::from(steps));
                    let p: [f64; 3] = std::array::from_fn(|k| a[k] + s * u[k] + r * v[k]);
                    above += i32::from(p[2] > terrain.height(p[0], p[1]));
                    count += 1;
                }
            }
            area * f64::from(above) / f64::from(count)
        })
        .sum()
}

#[test]
fn info_reports_density_multi_returns_and_facade_density_as_the_simulation_knows_them() {
    let town_params = TownParams { extent: 120.0, ..TownParams::default() };
    let scene = town(&town_params);
    for (pattern, density) in [(ScanPattern::Rotating, 10.0), (ScanPattern::CONICAL_20, 20.0)] {
        let params = AirborneParams { pattern, ..AirborneParams::covering(&scene, 10.0) };
        let scan = scan_airborne(&scene, &params.spread_over(&scene, None, density));
        let cloud = cloud_of(&scan);
        let statistics = CloudSummary::of(&cloud, &Control::none()).unwrap();
        // Cells on the border count as a whole; they are a metre wide.
        assert!((statistics.occupied_area / 14_400.0 - 1.0).abs() < 0.03, "{}", statistics.occupied_area);
        assert!((statistics.density * statistics.occupied_area / scan.len() as f64 - 1.0).abs() < 1e-9);
        let pulses = statistics.pulses.unwrap();
        let firsts = || (0..scan.len()).filter(|&i| scan.return_number[i] == 1);
        let several = firsts().filter(|&i| scan.return_count[i] > 1).count() as f64;
        assert!((pulses.count - firsts().count() as f64).abs() < 1e-6);
        assert!((pulses.multi_return_count - several).abs() < 1e-6);

        let facades = FacadeSummary::of(&cloud, &Control::none()).unwrap().unwrap();
        let is_wall =
            |t: u32| scene.materials[t as usize] == Material::Facade && normal(&scene, t as usize)[2].abs() < 0.3;
        let on_walls = scan.triangle.iter().filter(|&&t| is_wall(t)).count() as f64;
        let found = facades.steep_point_count as f64 / on_walls;
        assert!((0.8..1.0).contains(&found), "{pattern:?}: {found} of the wall points");
        let exact = on_walls / wall_area(&scene, &town_params.terrain());
        // What the documentation of the estimate promises.
        assert!(
            (facades.walls.unwrap().density / exact - 1.0).abs() < 0.25,
            "{pattern:?}: {} for {exact}",
            facades.walls.unwrap().density
        );
    }
}

/// The triangles of a mesh by object, as text with millimetres, in order.
fn sorted_triangles<'a>(
    corners: impl Fn(usize) -> [[f64; 3]; 3],
    object: impl Fn(usize) -> &'a str,
    count: usize,
) -> Vec<(String, [[i64; 3]; 3])> {
    let mut triangles: Vec<_> = (0..count)
        .map(|t| {
            let mut corners = corners(t).map(|corner| corner.map(|v| (v * 1000.0).round() as i64));
            // from the least corner on, so that where a triangle begins does not matter, but which way round does
            let first = (0..3).min_by_key(|&i| corners[i]).unwrap();
            corners.rotate_left(first);
            (object(t).to_owned(), corners)
        })
        .collect();
    triangles.sort();
    triangles
}

#[test]
fn cityjson_and_obj_hold_the_triangles_of_the_scene_under_the_names_of_its_objects() {
    let folder = tempfile::tempdir().unwrap();
    for preset in Preset::ALL {
        let scene = town(&preset.params(120.0, 3));
        let name = |t: usize| scene.object_names[scene.objects[t] as usize].replace(' ', "_");
        let names: Vec<String> = (0..scene.triangles.len()).map(name).collect();
        let count = scene.triangles.len();
        let wanted = sorted_triangles(|t| scene.corners(t).unwrap(), |t| &names[t], count);

        let file = folder.path().join("town.city.json");
        std::fs::write(&file, scene.to_cityjson(&[], 7415)).unwrap();
        let (mesh, report) = read_cityjson(&file, &LevelOfDetail::Highest).unwrap();
        assert_eq!((mesh.crs.epsg, report.skipped_geometry_count), (Some(7415), 0));
        let object = |t: usize| {
            let full = mesh.object_names[mesh.objects[t] as usize].as_str();
            // parts are named after their building: building_3-1
            full.rsplit_once('-').map_or(full, |(building, _)| building)
        };
        let found = sorted_triangles(|t| mesh.corners(t).unwrap(), object, mesh.triangles.len());
        // Rounding to a millimetre of what was rounded to a millimetre: the same numbers.
        assert!(found == wanted, "{preset:?}: {} triangles of {}", found.len(), wanted.len());

        let file = folder.path().join("town.obj");
        std::fs::write(&file, scene.to_obj()).unwrap();
        let (mesh, _) = read_mesh(&file).unwrap();
        let object = |t: usize| mesh.object_names[mesh.objects[t] as usize].as_str();
        let found = sorted_triangles(|t| mesh.corners(t).unwrap(), object, mesh.triangles.len());
        assert!(found == wanted, "{preset:?}: {} triangles of {}", found.len(), wanted.len());
    }
}

#[test]
fn cityjson_parts_are_those_given_and_surfaces_say_what_they_are() {
    let scene = town(&TownParams::default());
    // one part for each object here, however many solids it has
    let text = scene.to_cityjson(&scene.objects, 28_992);
    let root: serde_json::Value = serde_json::from_str(&text).unwrap();
    let objects = root["CityObjects"].as_object().unwrap();
    assert_eq!(root["version"], "2.0");
    let of_type = |kind: &str| objects.values().filter(|object| object["type"] == kind).count();
    let named = |start: &str| scene.object_names.iter().filter(|name| name.starts_with(start)).count();
    assert_eq!(of_type("Building"), named("building"));
    assert_eq!(of_type("BuildingPart"), named("building"));
    assert_eq!(of_type("SolitaryVegetationObject"), named("tree"));
    assert_eq!(of_type("TINRelief"), 1);
    // without parts, each solid is one: the tower has its machine room
    let by_solid: serde_json::Value = serde_json::from_str(&scene.to_cityjson(&[], 28_992)).unwrap();
    let max = by_solid["CityObjects"]
        .as_object()
        .unwrap()
        .values()
        .filter_map(|object| Some(object["children"].as_array()?.len()))
        .max();
    assert_eq!(max, Some(2));

    let mut kinds = std::collections::BTreeMap::<String, f64>::new();
    for (name, object) in objects.iter().filter(|(_, object)| object["type"] == "BuildingPart") {
        let parent = object["parents"][0].as_str().unwrap();
        assert!(objects[parent]["children"].as_array().unwrap().iter().any(|child| child == name));
        let geometry = &object["geometry"][0];
        let surfaces = geometry["semantics"]["surfaces"].as_array().unwrap();
        let is_solid = geometry["type"] == "Solid";
        let (values, boundaries) = if is_solid {
            (&geometry["semantics"]["values"][0], &geometry["boundaries"][0])
        } else {
            (&geometry["semantics"]["values"], &geometry["boundaries"])
        };
        let (values, boundaries) = (values.as_array().unwrap(), boundaries.as_array().unwrap());
        assert_eq!(values.len(), boundaries.len(), "{name}: a meaning for every surface");
        for (value, surface) in values.iter().zip(boundaries) {
            let corner = |i: usize| scene.vertices[surface[0][i].as_u64().unwrap() as usize];
            let (u, v) = (sub(corner(1), corner(0)), sub(corner(2), corner(0)));
            let up = (u[0] * v[1] - u[1] * v[0]) / 2.0;
            let kind = surfaces[value.as_u64().unwrap() as usize]["type"].as_str().unwrap();
            *kinds.entry(kind.to_owned()).or_default() += up;
        }
    }
    // Seen from above, roofs cover what floors close below; walls cover nothing. The machine room of 5 by 4 m is closed
    // below within the tower.
    let (roof, ground) = (kinds["RoofSurface"], kinds["GroundSurface"]);
    assert!((kinds["OuterCeilingSurface"] + 20.0).abs() < 1e-6, "{kinds:?}");
    assert!(roof > 1000.0 && (roof + ground - 20.0).abs() < 1e-6 * roof, "{kinds:?}");
    assert!(kinds["WallSurface"].abs() < 1e-6 * roof && kinds.len() == 4, "{kinds:?}");
}

#[test]
fn scanners_that_fly_hit_the_ground_as_densely_as_wanted_and_others_from_where_they_stand() {
    for regime in Regime::ALL {
        let params = regime.town(Preset::Town.params(100.0, 3));
        let scene = regime.scene(&params);
        let scan = regime.scan(&scene, &params, 2.0);
        let highest = scan.sensor_path.positions.iter().map(|p| p[2]).fold(f64::NEG_INFINITY, f64::max);
        let density = scan.return_number.iter().filter(|&&number| number == 1).count() as f64 / 1e4;
        if regime.flies() {
            assert!(highest > 50.0 && (density / 2.0 - 1.0).abs() < 0.25, "{regime:?}: {highest} m, {density}");
        } else {
            assert!(highest < 20.0 && density > 20.0, "{regime:?}: {highest} m, {density}");
        }
    }
}
