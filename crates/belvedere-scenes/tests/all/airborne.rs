//! Simulated airborne scan: on the mesh, consistent with its path, as dense as real scans, and the same for the same
//! seed.

#![expect(clippy::unwrap_used, reason = "helpers of tests may panic like the tests themselves")]

use std::collections::HashMap;

use belvedere_scenes::{
    AirborneParams, BeamParams, Material, Scan, SensorPath, TownParams, TriangleScene, scan_airborne, town,
};

fn default_scan() -> (TriangleScene, Scan) {
    let scene = town(&TownParams::default());
    let scan = scan_airborne(&scene, &AirborneParams::default());
    (scene, scan)
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

fn unit(a: [f64; 3]) -> [f64; 3] {
    let length = dot(a, a).sqrt();
    a.map(|v| v / length)
}

/// Returns the position on the straight line between the two neighbours in time.
fn sensor_at(path: &SensorPath, time: f64) -> [f64; 3] {
    let after = path.times.partition_point(|&t| t <= time);
    let (t0, t1) = (path.times[after - 1], path.times[after]);
    assert!(t1 - t0 < 0.06, "no gap in the path at {time}");
    let (p0, p1) = (path.positions[after - 1], path.positions[after]);
    std::array::from_fn(|i| p0[i] + (p1[i] - p0[i]) * (time - t0) / (t1 - t0))
}

/// Returns the ranges of rows that belong to one pulse.
fn pulses(scan: &Scan) -> Vec<std::ops::Range<usize>> {
    let mut pulses = Vec::new();
    let mut start = 0;
    for i in 1..=scan.len() {
        if i == scan.len() || scan.return_number[i] == 1 {
            pulses.push(start..i);
            start = i;
        }
    }
    pulses
}

#[test]
fn exact_positions_lie_on_the_mesh_and_noisy_ones_within_their_noise() {
    let (scene, scan) = default_scan();
    let params = AirborneParams::default();
    let mut along_squares = 0.0;
    for i in 0..scan.len() {
        let exact = scan.exact_positions[i];
        let [a, b, c] = scene.corners(scan.triangle[i] as usize).unwrap();
        let normal = cross(sub(b, a), sub(c, a));
        let area = dot(normal, normal).sqrt();
        assert!((dot(sub(exact, a), normal) / area).abs() < 1e-6, "on the plane of its triangle");
        for (p, q) in [(a, b), (b, c), (c, a)] {
            assert!(dot(cross(sub(q, p), sub(exact, p)), normal) / (area * area) > -1e-6, "and inside it");
        }
        let sensor = sensor_at(&scan.sensor_path, scan.gps_time[i]);
        let ray = sub(exact, sensor);
        let range = dot(ray, ray).sqrt();
        let error = sub([scan.x[i], scan.y[i], scan.z[i]], exact);
        let along = dot(error, unit(ray));
        along_squares += along * along;
        // Half a million normal numbers: one in 600 000 lies beyond five deviations.
        assert!(along.abs() < 5.0 * params.range_sd + 1e-3, "{along}");
        let across = (dot(error, error) - along * along).max(0.0).sqrt();
        let pointing = (params.pointing_sd.powi(2) + params.boresight_sd.powi(2)).sqrt();
        // The part of the beam that met the surface lies up to half the beam beside its axis.
        let beam = params.beam.divergence / 2.0;
        assert!(across < (beam + 5.0 * 2_f64.sqrt() * pointing) * range, "{across}");
    }
    let sd = (along_squares / scan.len() as f64).sqrt();
    assert!((sd / params.range_sd - 1.0).abs() < 0.02, "{sd}");
}

#[test]
fn returns_without_noise_have_the_exact_range_on_the_axis_of_the_beam() {
    let scene = town(&TownParams::default());
    let quiet = AirborneParams { range_sd: 0.0, pointing_sd: 0.0, boresight_sd: 0.0, ..AirborneParams::default() };
    for divergence in [0.0, 4e-4] {
        let beam = BeamParams { divergence, ..BeamParams::default() };
        let scan = scan_airborne(&scene, &AirborneParams { pulses_per_m2: 0.5, beam, ..quiet.clone() });
        assert!(scan.len() > 10_000);
        let mut beside = 0;
        for (i, &exact) in scan.exact_positions.iter().enumerate() {
            let error = sub([scan.x[i], scan.y[i], scan.z[i]], exact);
            let sensor = sensor_at(&scan.sensor_path, scan.gps_time[i]);
            let ray = sub(exact, sensor);
            // The edge of a beam of 18 cm is 9 cm aside, which makes a ray longer by 10 µm.
            assert!(dot(error, unit(ray)).abs() < 2e-5, "{error:?}");
            let aside = dot(error, error).sqrt();
            assert!(aside < divergence / 2.0 * dot(ray, ray).sqrt() + 1e-6, "{error:?}");
            beside += usize::from(aside > 1e-6);
        }
        // Only where the middle of the beam meets another surface: at edges and crowns.
        let share = beside as f64 / scan.len() as f64;
        assert!(if divergence > 0.0 { (0.01..0.2).contains(&share) } else { beside == 0 }, "{share}");
    }
}

#[test]
fn path_and_time_reproduce_direction_and_scan_angle() {
    let (_, scan) = default_scan();
    let params = AirborneParams::default();
    let (sin, cos) = params.heading.sin_cos();
    let mut seen = HashMap::new();
    for i in 0..scan.len() {
        let sense = if scan.point_source_id[i] % 2 == 1 { 1.0 } else { -1.0 };
        let (forward, right) = ([sense * sin, sense * cos, 0.0], [sense * cos, -sense * sin, 0.0]);
        let sensor = sensor_at(&scan.sensor_path, scan.gps_time[i]);
        let ray = sub([scan.x[i], scan.y[i], scan.z[i]], sensor);
        let angle = dot(ray, right).atan2(-ray[2]);
        // Five deviations of the pointing and a millimetre or so of interpolation; the beam has no part in it.
        let tolerance = 5.0 * (params.pointing_sd + params.boresight_sd) + 1e-5;
        assert!((angle - f64::from(scan.scan_angle_deg[i]).to_radians()).abs() < tolerance);
        assert!((dot(ray, forward) / dot(ray, ray).sqrt()).abs() < tolerance, "lines lie across the flight");
        *seen.entry((scan.point_source_id[i], scan.scan_angle_deg[i] > 0.0)).or_insert(0) += 1;
    }
    // Both passes have the town on the left or both on the right, since the second is flown back.
    assert_eq!(seen.len(), 2, "{seen:?}");
    let path = &scan.sensor_path;
    assert!(path.times.is_sorted_by(|a, b| a < b) && path.times.len() == path.positions.len());
    assert!(path.times[0] <= scan.gps_time[0] - 0.9 && path.times.last() > scan.gps_time.last());
    for height in path.positions.iter().map(|p| p[2]) {
        assert!((height - 450.0).abs() < 3.0, "{height}");
    }
}

#[test]
fn scan_angle_is_negative_to_the_left_of_the_flight() {
    let scene = town(&TownParams::default());
    let north = AirborneParams { heading: 0.0, strip_count: 1, pulses_per_m2: 0.5, ..AirborneParams::default() };
    let scan = scan_airborne(&scene, &north);
    let middle = scan.sensor_path.positions[0][0];
    for i in 0..scan.len() {
        // A metre of wander and a tolerance of a wall's width.
        if (scan.x[i] - middle).abs() > 3.0 {
            assert_eq!(scan.x[i] < middle, scan.scan_angle_deg[i] < 0.0, "west is left of north");
        }
    }
}

#[test]
fn returns_of_a_pulse_share_time_and_count_and_are_ordered_by_range() {
    let (_, scan) = default_scan();
    let pulses = pulses(&scan);
    for pulse in &pulses {
        let count = pulse.len();
        let sensor = sensor_at(&scan.sensor_path, scan.gps_time[pulse.start]);
        let mut before = 0.0;
        for (number, i) in pulse.clone().enumerate() {
            assert_eq!(usize::from(scan.return_number[i]), number + 1);
            assert_eq!(usize::from(scan.return_count[i]), count);
            assert_eq!(scan.gps_time[i].to_bits(), scan.gps_time[pulse.start].to_bits());
            assert_eq!(scan.scan_angle_deg[i], scan.scan_angle_deg[pulse.start]);
            assert_eq!(scan.point_source_id[i], scan.point_source_id[pulse.start]);
            let ray = sub([scan.x[i], scan.y[i], scan.z[i]], sensor);
            let range = dot(ray, ray).sqrt();
            assert!(range > before + 0.5, "{range} after {before}");
            before = range;
        }
    }
    for pair in pulses.windows(2) {
        let gap = scan.gps_time[pair[1].start] - scan.gps_time[pair[0].start];
        let same_strip = scan.point_source_id[pair[0].start] == scan.point_source_id[pair[1].start];
        assert!(if same_strip { gap > 1e-6 && gap < 1.0 } else { gap > 200.0 }, "{gap}");
    }
    assert!((3.0e8..3.1e8).contains(&scan.gps_time[0]));
}

#[test]
fn columns_have_one_value_per_return_and_classes_follow_materials() {
    let (scene, scan) = default_scan();
    let n = scan.len();
    assert!([scan.y.len(), scan.z.len(), scan.gps_time.len(), scan.return_number.len()].iter().all(|&l| l == n));
    assert!([scan.return_count.len(), scan.scan_angle_deg.len(), scan.intensity.len()].iter().all(|&l| l == n));
    assert!([scan.point_source_id.len(), scan.triangle.len(), scan.exact_positions.len()].iter().all(|&l| l == n));
    for i in 0..n {
        assert_eq!(scan.classification[i], scene.materials[scan.triangle[i] as usize].asprs_class());
    }
    let mut intensities = scan.intensity.clone();
    intensities.sort_unstable();
    assert!(intensities[n / 20] > 1000 && intensities[n - 1] < u16::MAX, "neither black nor saturated");
    let report = scan.report;
    let accounted = pulses(&scan).len() as u64 + report.dropped_pulses + report.missed_pulses;
    assert!(report.pulses >= accounted && report.pulses - accounted <= report.dropped_echoes);
}

/// Returns the number of returns of the walls of `scene` per area above the ground, 1/m².
fn facade_density(scene: &TriangleScene, scan: &Scan, params: &TownParams) -> f64 {
    let terrain = params.terrain();
    let mut area_above_ground = 0.0;
    for t in (0..scene.triangles.len()).filter(|&t| scene.materials[t] == Material::Facade) {
        let [a, b, c] = scene.corners(t).unwrap();
        let normal = cross(sub(b, a), sub(c, a));
        let area = dot(normal, normal).sqrt() / 2.0;
        if normal[2].abs() > area {
            continue;
        }
        let steps = 30_u32;
        let samples = (0..steps).flat_map(|i| (0..steps - i).map(move |j| (i, j))).map(|(i, j)| {
            let (s, r) = ((f64::from(i) + 1.0 / 3.0) / f64::from(steps), (f64::from(j) + 1.0 / 3.0) / f64::from(steps));
            let point: [f64; 3] = std::array::from_fn(|k| a[k] + s * (b[k] - a[k]) + r * (c[k] - a[k]));
            f64::from(u8::from(point[2] > terrain.height(point[0], point[1])))
        });
        let (above, count) = samples.fold((0.0, 0.0), |(above, count), v| (above + v, count + 1.0));
        area_above_ground += area * above / count;
    }
    let returns = scan.triangle.iter().filter(|&&t| scene.materials[t as usize] == Material::Facade).count();
    returns as f64 / area_above_ground
}

#[test]
fn density_returns_and_overlap_are_those_of_a_real_survey() {
    let (scene, scan) = default_scan();
    let town_params = TownParams::default();
    let area = town_params.extent.powi(2);
    let n = scan.len() as f64;
    assert!((130_000.0..220_000.0).contains(&n), "{n}");

    // Two strips of 5.5 pulses per m² on average. With equal steps of the angle, the density is cos² θ of that at
    // nadir.
    let pulses = pulses(&scan);
    let pulse_density = pulses.len() as f64 / area;
    assert!((9.5..12.0).contains(&pulse_density), "{pulse_density}");
    for strip in 1..=2 {
        let own = pulses.iter().filter(|p| scan.point_source_id[p.start] == strip).count() as f64 / area;
        assert!((4.5..6.5).contains(&own), "strip {strip}: {own}");
    }

    let multiple = pulses.iter().filter(|p| p.len() > 1).count() as f64 / pulses.len() as f64;
    assert!((0.03..0.2).contains(&multiple), "{multiple}");
    assert!(scan.return_count.iter().max() >= Some(&3));

    let facade = facade_density(&scene, &scan, &town_params);
    assert!((0.6..2.0).contains(&facade), "{facade} per m²");

    // Cells of 2 m that both strips reach; the rest lies in the lee of the tower.
    let cell = |i: usize| [scan.x[i], scan.y[i]].map(|v| (v / 2.0).floor().to_bits());
    let mut strips: HashMap<[u64; 2], u8> = HashMap::new();
    for i in 0..scan.len() {
        *strips.entry(cell(i)).or_default() |= 1 << scan.point_source_id[i];
    }
    let both = strips.values().filter(|&&s| s == 0b110).count() as f64 / strips.len() as f64;
    assert!(both > 0.85, "{both}");
}

#[test]
fn pulses_reach_the_ground_below_crowns_only_where_crowns_are_porous() {
    let scene = town(&TownParams::default());
    let ground_after_crown = |crown_porosity: f64| {
        let beam = BeamParams { crown_porosity, ..BeamParams::default() };
        let scan = scan_airborne(&scene, &AirborneParams { beam, ..AirborneParams::default() });
        let crowned: Vec<_> = pulses(&scan)
            .into_iter()
            .filter(|p| scene.materials[scan.triangle[p.start] as usize] == Material::TreeCrown)
            .collect();
        let through = crowned.iter().filter(|p| scan.classification[p.end - 1] == 2).count();
        through as f64 / crowned.len() as f64
    };
    let (open, closed) = (ground_after_crown(0.35), ground_after_crown(0.0));
    assert!((0.1..0.5).contains(&open), "{open}");
    // Behind an opaque crown only pulses at its outline reach the ground: 13 cm of a radius of about 2.5 m, twice 5 %
    // of its area.
    assert!(closed < 0.1 && closed > 0.0 && open > 2.0 * closed, "{closed} {open}");
}

#[test]
fn scan_has_the_same_bits_for_any_number_of_threads_and_others_for_another_seed() {
    let scene = town(&TownParams::default());
    let params = AirborneParams { pulses_per_m2: 1.0, ..AirborneParams::default() };
    let with_threads = |count: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build().unwrap();
        pool.install(|| scan_airborne(&scene, &params))
    };
    let (one, three) = (with_threads(1), with_threads(3));
    assert!(one.len() > 20_000);
    assert_eq!(one, three);
    let bits = |scan: &Scan| scan.x.iter().chain(&scan.y).chain(&scan.z).map(|v| v.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&one), bits(&three));
    let other = scan_airborne(&scene, &AirborneParams { seed: 2, ..params });
    assert_ne!(bits(&one), bits(&other));
}

#[test]
fn rates_follow_from_density_speed_and_swath() {
    let params = AirborneParams::default();
    let density = params.pulse_rate() / (params.speed * params.swath());
    assert!((density / params.pulses_per_m2 - 1.0).abs() < 0.01, "{density}");
    assert!((80_000.0..300_000.0).contains(&params.pulse_rate()), "a rate that scanners reach");
}

#[test]
fn nothing_to_fly_gives_an_empty_scan() {
    let scene = town(&TownParams::default());
    let usual = AirborneParams::default();
    for params in [
        AirborneParams { pulses_per_m2: 0.0, ..usual.clone() },
        AirborneParams { speed: f64::NAN, ..usual.clone() },
        AirborneParams { strip_count: 0, ..usual.clone() },
    ] {
        assert!(scan_airborne(&scene, &params).is_empty());
    }
    let lost = scan_airborne(&scene, &AirborneParams { dropout: 1.0, pulses_per_m2: 0.2, ..usual.clone() });
    assert!(lost.is_empty() && lost.report.dropped_pulses > 1000);
    assert!(scan_airborne(&TriangleScene::default(), &usual).is_empty());
}

#[test]
fn path_text_has_a_header_and_a_line_per_position() {
    let scene = town(&TownParams::default());
    let scan = scan_airborne(&scene, &AirborneParams { pulses_per_m2: 0.05, ..AirborneParams::default() });
    let text = scan.sensor_path.to_csv();
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("time,x,y,z"));
    let rows: Vec<Vec<f64>> = lines.map(|l| l.split(',').map(|v| v.parse().unwrap()).collect()).collect();
    assert_eq!(rows.len(), scan.sensor_path.times.len());
    for (row, (time, position)) in rows.iter().zip(scan.sensor_path.times.iter().zip(&scan.sensor_path.positions)) {
        assert!((row[0] - time).abs() < 1e-6 && (0..3).all(|i| (row[i + 1] - position[i]).abs() <= 0.000_501));
    }
}
