//! Scans from tripods: free stations, and correct ranges, angles and times.

use std::f64::consts::{FRAC_PI_2, PI};

use belvedere_scenes::{
    BeamParams, Material, PlanPlacement, Scan, Stations, TerrestrialParams, TownParams, TriangleScene, Truth, extruded,
    scan_terrestrial, town,
};

fn coarse() -> TerrestrialParams {
    TerrestrialParams { angular_step: 1_f64.to_radians(), ..TerrestrialParams::default() }
}

fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

fn length(a: [f64; 3]) -> f64 {
    (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]).sqrt()
}

/// Returns a room of 20 x 12 x 6 m: its inside is the outside of six slabs.
fn room() -> TriangleScene {
    let mut scene = TriangleScene::default();
    let slab = |x: f64, y: f64, size: [f64; 2], bottom: f64, top: f64| {
        extruded(&PlanPlacement { origin: [x, y], angle: 0.0 }.rectangle(size[0], size[1]), bottom, top)
    };
    scene.add_object(
        "room",
        &[
            slab(0.0, 0.0, [22.0, 14.0], -1.0, 0.0),
            slab(0.0, 0.0, [22.0, 14.0], 6.0, 7.0),
            slab(-10.5, 0.0, [1.0, 14.0], -0.5, 6.5),
            slab(10.5, 0.0, [1.0, 14.0], -0.5, 6.5),
            slab(0.0, -6.5, [22.0, 1.0], -0.5, 6.5),
            slab(0.0, 6.5, [22.0, 1.0], -0.5, 6.5),
        ],
    );
    scene
}

#[test]
fn ranges_in_a_room_are_those_of_a_box() {
    let at = [3.0, -1.0, 1.8];
    let params = TerrestrialParams {
        stations: Stations::At(vec![at]),
        range_sd: 0.0,
        pointing_sd: 0.0,
        dropout: 0.0,
        lowest_elevation: -FRAC_PI_2,
        ..coarse()
    };
    let scan = scan_terrestrial(&room(), &params);
    // In corners the beam of 3 mm may meet two walls, which are too near each other to separate: one return per pulse.
    assert_eq!(scan.len(), 360 * 180);
    for i in 0..scan.len() {
        let p = [scan.x[i], scan.y[i], scan.z[i]];
        let walls = [10.0 - p[0].abs(), 6.0 - p[1].abs(), p[2].min(6.0 - p[2])];
        let nearest = walls.iter().fold(f64::INFINITY, |best, v| best.min(v.abs()));
        assert!(nearest < 1e-9 && walls.iter().all(|&v| v > -1e-9), "{p:?} on the walls, not behind them");
        let ray = sub(p, at);
        let from_nadir = (-ray[2] / length(ray)).acos();
        // Half the divergence, and the precision of f32.
        let tolerance = 1.5e-4 + 1e-6;
        assert!((from_nadir - f64::from(scan.scan_angle_deg[i]).to_radians()).abs() < tolerance);
    }
    // The pulse of each moment: columns clockwise from north, each from below upwards.
    let number = ((scan.gps_time[40_000] - scan.gps_time[0]) * params.pulse_rate).round();
    let ray = sub(scan.exact_positions[40_000], at);
    let azimuth = ray[0].atan2(ray[1]).rem_euclid(2.0 * PI).to_degrees();
    assert!((azimuth - ((number / 180.0).floor() + 0.5)).abs() < 0.02, "{azimuth} of pulse {number}");
}

#[test]
fn chosen_stations_stand_on_open_ground_far_apart() {
    let params = TownParams::default();
    let (scene, terrain) = (town(&params), params.terrain());
    let truth = Truth::new(&scene);
    let scan = scan_terrestrial(&scene, &TerrestrialParams { stations: Stations::Chosen(5), ..coarse() });
    assert_eq!(scan.stations.len(), 5);
    for (i, &[x, y, z]) in scan.stations.iter().enumerate() {
        // The mesh of the ground is within 5 mm of its formula.
        assert!((z - terrain.height(x, y) - 1.8).abs() < 0.005);
        assert!(!truth.occluded_towards([x, y, z], [0.0, 0.0, 1.0]), "open to the sky");
        let below = truth.first_hit([x, y, z], [0.0, 0.0, -1.0], 10.0).unwrap();
        assert_eq!(scene.materials[below.triangle as usize], Material::Terrain);
        for direction in [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0]] {
            assert!(truth.first_hit([x, y, z], direction, 2.5).is_none(), "room around the tripod");
        }
        for other in &scan.stations[..i] {
            // Five places on 120 m: farther apart than a quarter of the town.
            assert!(length(sub([x, y, z], *other)) > 30.0);
        }
    }
    let text = scan.stations_to_csv();
    assert_eq!(text.lines().next(), Some("station,x,y,z"));
    let rows: Vec<Vec<f64>> =
        text.lines().skip(1).map(|line| line.split(',').map(|v| v.parse().unwrap()).collect()).collect();
    for (row, (number, station)) in rows.iter().zip((1_u32..).zip(&scan.stations)) {
        assert!(row[0] == f64::from(number) && (0..3).all(|i| (row[i + 1] - station[i]).abs() <= 0.000_501));
    }
    assert_eq!(rows.len(), 5);
}

#[test]
fn returns_lie_on_the_mesh_within_noise_and_range_and_belong_to_their_station() {
    let scene = town(&TownParams::default());
    let beam = BeamParams { foliage_depth: 0.0, ..TerrestrialParams::default().beam };
    let params = TerrestrialParams { beam, max_range: 40.0, pointing_sd: 0.0, ..coarse() };
    let scan = scan_terrestrial(&scene, &params);
    assert!(scan.len() > 20_000, "{}", scan.len());
    let mut squares = 0.0;
    for i in 0..scan.len() {
        let station = scan.stations[usize::from(scan.point_source_id[i]) - 1];
        let at = scan.sensor_path.times.partition_point(|&t| t <= scan.gps_time[i]);
        assert_eq!(scan.sensor_path.positions[at], station);
        assert_eq!(scan.sensor_path.positions[at - 1], station, "the path stands still during a station");
        let exact = length(sub(scan.exact_positions[i], station));
        let along = length(sub([scan.x[i], scan.y[i], scan.z[i]], station)) - exact;
        assert!(exact <= 40.0 && along.abs() <= 6.0 * params.range_sd + 1e-9);
        squares += along * along;
        let [a, b, c] = scene.corners(scan.triangle[i] as usize).unwrap();
        let (u, v, p) = (sub(b, a), sub(c, a), sub(scan.exact_positions[i], a));
        let n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
        assert!((0..3).map(|k| n[k] * p[k]).sum::<f64>().abs() / length(n) < 1e-6);
    }
    let sd = (squares / scan.len() as f64).sqrt();
    // A sample of 20 000 has a relative standard error of half a percent.
    assert!((sd / params.range_sd - 1.0).abs() < 0.03, "{sd}");
    let report = scan.report;
    assert_eq!(report.pulses, params.pulses_per_station() * 4);
    assert!(report.dropped_pulses > 0 && report.missed_pulses > 0);
}

#[test]
fn tripod_scans_have_the_same_bits_for_any_number_of_threads() {
    let scene = town(&TownParams::default());
    let with_threads = |count: usize| -> Scan {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build().unwrap();
        pool.install(|| scan_terrestrial(&scene, &coarse()))
    };
    let (one, three) = (with_threads(1), with_threads(3));
    assert!(one.len() > 20_000 && one == three);
    assert_ne!(one, scan_terrestrial(&scene, &TerrestrialParams { seed: 2, ..coarse() }));
}

#[test]
fn nothing_to_scan_gives_an_empty_scan() {
    let scene = town(&TownParams::default());
    for params in [
        TerrestrialParams { angular_step: 0.0, ..coarse() },
        TerrestrialParams { max_range: f64::NAN, ..coarse() },
        TerrestrialParams { lowest_elevation: 1.0, highest_elevation: 0.5, ..coarse() },
        TerrestrialParams { stations: Stations::Chosen(0), ..coarse() },
    ] {
        assert!(scan_terrestrial(&scene, &params).is_empty());
    }
    assert!(scan_terrestrial(&TriangleScene::default(), &coarse()).is_empty());
    assert!(scan_terrestrial(&room(), &coarse()).stations.is_empty(), "no ground, no station");
}
