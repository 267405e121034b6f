//! Surveys with other parameters than the defaults: patterns, strips, crowns that pulses enter.

use belvedere_scenes::{
    AirborneParams, BeamParams, Material, MirrorMotion, PlanPlacement, PointOrder, Scan, ScanPattern, TownParams,
    TriangleScene, Truth, extruded, scan_airborne, town,
};

const PATTERNS: [ScanPattern; 4] = [
    ScanPattern::Rotating,
    ScanPattern::Oscillating(MirrorMotion::Sinusoidal),
    ScanPattern::Oscillating(MirrorMotion::Triangular),
    ScanPattern::CONICAL_20,
];

/// Returns flat ground of `side` metres about the zero of the grid.
fn plate(side: f64) -> TriangleScene {
    let mut scene = TriangleScene::default();
    let at = PlanPlacement { origin: [0.0, 0.0], angle: 0.0 };
    let ground = extruded(&at.rectangle(side, side), -1.0, 0.0).with_material(Material::Terrain);
    scene.add_object("ground", &[ground]);
    scene
}

/// Returns a house of 10 x 10 x 8 m on flat ground.
fn house_on_a_plate() -> TriangleScene {
    let mut scene = plate(60.0);
    let at = PlanPlacement { origin: [0.0, 0.0], angle: 0.0 };
    scene.add_object("house", &[extruded(&at.rectangle(10.0, 10.0), -0.5, 8.0)]);
    scene
}

fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Returns the outward unit normal of the triangle of return `i`, and the distance of its exact position outside that
/// plane.
fn plane_of(scene: &TriangleScene, scan: &Scan, i: usize) -> ([f64; 3], f64) {
    let [a, b, c] = scene.corners(scan.triangle[i] as usize).unwrap();
    let (u, v) = (sub(b, a), sub(c, a));
    let n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let n = n.map(|value| value / dot(n, n).sqrt());
    (n, dot(sub(scan.exact_positions[i], a), n))
}

#[test]
fn requested_density_is_flown_with_every_pattern_and_any_extent() {
    for pattern in PATTERNS {
        for (side, cross_strip_count) in [(120.0, 0), (500.0, 0), (120.0, 2)] {
            let scene = plate(side);
            let params = AirborneParams { pattern, cross_strip_count, dropout: 0.0, ..AirborneParams::default() };
            let params = params.spread_over(&scene, None, 1.0);
            let scan = scan_airborne(&scene, &params);
            let density = scan.len() as f64 / (side * side);
            // The mean over the ground is computed at 3600 places, and a strip starts and ends within a line.
            assert!((density - 1.0).abs() < 0.05, "{pattern:?} {side}: {density}");
            let strips = f64::from(*scan.point_source_id.iter().max().unwrap());
            assert!(strips <= f64::from(params.strip_count + params.cross_strip_count));
            // Every place lies between two strips that reach it; counted on a grid of 20 m.
            let mut seen = std::collections::HashMap::<[i64; 2], u64>::new();
            // Noise moves some points beside the ground.
            let within = |v: f64| v.abs() < side / 2.0 - 0.5;
            for i in (0..scan.len()).filter(|&i| within(scan.x[i]) && within(scan.y[i])) {
                let cell = [scan.x[i], scan.y[i]].map(|v| (v / 20.0).floor() as i64);
                *seen.entry(cell).or_default() |= 1 << scan.point_source_id[i];
            }
            let twice = seen.values().filter(|strips| strips.count_ones() >= 2).count() as f64 / seen.len() as f64;
            assert!(twice > 0.9, "{pattern:?} {side}: {twice} of the ground from two strips");
        }
    }
}

#[test]
fn strips_are_as_many_as_the_extent_needs() {
    let count = |side: f64| AirborneParams::covering(&plate(side), 10.0).strip_count;
    // Strips of 420 m with half of it between neighbours; the ground is 1.37 times as wide across a heading of 30
    // degrees.
    assert_eq!([150.0, 300.0, 1000.0].map(count), [2, 3, 8]);
    let requested = AirborneParams::default().spread_over(&plate(300.0), Some(5), 10.0);
    assert_eq!(requested.strip_count, 5);
    assert!((requested.strip_spacing * 4.0 - 300.0 * (0.5 + 0.75_f64.sqrt())).abs() < 1e-9);
}

#[test]
fn a_sinusoidal_mirror_crowds_pulses_at_the_edges_and_a_rotating_one_does_not() {
    let scene = plate(400.0);
    let edge_share = |pattern| {
        let params =
            AirborneParams { pattern, heading: 0.0, pulses_per_m2: 1.0, strip_count: 1, ..AirborneParams::default() };
        let scan = scan_airborne(&scene, &params);
        let outer = scan.scan_angle_deg.iter().filter(|angle| angle.abs() > 20.0).count();
        outer as f64 / scan.len() as f64
    };
    // The plate cuts the strip of 420 m at 24 degrees, of which the mirror spends arcsin(0.96) - arcsin(0.8) = 0.36 of
    // arcsin(0.96) = 1.287 beyond 20 degrees; equal steps spend 3.96 of 23.96 there.
    assert!((edge_share(ScanPattern::Rotating) - 0.165).abs() < 0.01);
    assert!((edge_share(ScanPattern::Oscillating(MirrorMotion::Triangular)) - 0.165).abs() < 0.01);
    assert!((edge_share(ScanPattern::Oscillating(MirrorMotion::Sinusoidal)) - 0.279).abs() < 0.01);
}

#[test]
fn a_cone_sees_three_walls_from_one_strip_and_a_line_scanner_one() {
    let scene = house_on_a_plate();
    let walls_seen = |pattern| {
        // 60 m beside the flight path to the north, so that a line scanner sees the house from the west.
        let params = AirborneParams {
            pattern,
            heading: 0.0,
            pulses_per_m2: 8.0,
            strip_count: 2,
            strip_spacing: 120.0,
            wander: 0.0,
            ..AirborneParams::default()
        };
        let scan = scan_airborne(&scene, &params);
        let mut counts = [0_usize; 4];
        for i in (0..scan.len()).filter(|&i| scan.point_source_id[i] == 1) {
            let (normal, _) = plane_of(&scene, &scan, i);
            for (wall, direction) in [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]].iter().enumerate() {
                counts[wall] += usize::from(normal[0] * direction[0] + normal[1] * direction[1] > 0.99);
            }
        }
        counts.iter().filter(|&&count| count > 20).count()
    };
    assert_eq!(walls_seen(ScanPattern::Rotating), 1);
    // Ahead, behind and the side that faces the path.
    assert_eq!(walls_seen(ScanPattern::CONICAL_20), 3);
}

#[test]
fn cross_strips_fly_at_right_angles_and_later() {
    let scene = plate(200.0);
    let params = AirborneParams { cross_strip_count: 2, pulses_per_m2: 0.2, ..AirborneParams::default() };
    let scan = scan_airborne(&scene, &params);
    assert_eq!(scan.point_source_id.iter().max(), Some(&4));
    let path = &scan.sensor_path;
    assert!(path.times.is_sorted_by(|a, b| a < b));
    let course_at = |strip: u16| {
        let i = scan.point_source_id.iter().position(|&s| s == strip).unwrap();
        let after = path.times.partition_point(|&t| t <= scan.gps_time[i]);
        let step = sub(path.positions[after], path.positions[after - 1]);
        // The wander turns the path by up to 0.7 degrees.
        let course = step[0].atan2(step[1]);
        let heading = path.headings[after];
        assert!(((course - heading + 0.1).rem_euclid(std::f64::consts::TAU) - 0.1).abs() < 0.015);
        heading
    };
    let turned = |a: u16, b: u16| (course_at(b) - course_at(a)).rem_euclid(std::f64::consts::TAU).to_degrees();
    assert!((turned(1, 2) - 180.0).abs() < 1e-9 && (turned(1, 3) - 90.0).abs() < 1e-9);
    assert!((turned(3, 4) - 180.0).abs() < 1e-9);
}

#[test]
fn pulses_enter_crowns_only_as_deep_as_leaves_let_them() {
    let scene = town(&TownParams::default());
    let truth = Truth::new(&scene);
    let scan = scan_airborne(&scene, &AirborneParams::covering(&scene, 8.0));
    let (mut inside, mut crown) = (0, 0);
    let mut depths = 0.0;
    for i in 0..scan.len() {
        let (normal, outside) = plane_of(&scene, &scan, i);
        let material = scene.materials[scan.triangle[i] as usize];
        if material != Material::TreeCrown {
            assert!(outside.abs() < 1e-6, "all but crowns are met on their surface");
            continue;
        }
        assert!(outside < 1e-6, "leaves stand behind the hull, never before it");
        crown += 1;
        if outside < -1e-6 {
            inside += 1;
            depths -= outside;
            // Backwards along the ray, with the direction from the noisy point and the sensor: the hull lies behind.
            let after = scan.sensor_path.times.partition_point(|&t| t <= scan.gps_time[i]);
            let back = sub(scan.sensor_path.positions[after], scan.exact_positions[i]);
            assert!(truth.occluded_towards(scan.exact_positions[i], back), "the crown is round this point");
        }
        assert_eq!(scan.classification[i], 5);
        assert!(normal.iter().all(|v| v.is_finite()));
    }
    let share = f64::from(inside) / f64::from(crown);
    assert!((0.3..0.8).contains(&share), "{share} of the returns of crowns come from inside");
    let mean_depth = depths / f64::from(inside);
    assert!(
        (0.3..1.5).contains(&mean_depth),
        "{mean_depth} m below the hull, less than the way of 1.5 m along the ray"
    );
    let pulses = scan.return_number.iter().filter(|&&n| n == 1).count() as f64;
    let several = (0..scan.len()).filter(|&i| scan.return_number[i] == 1 && scan.return_count[i] > 1).count() as f64;
    // A twelfth of the town lies under crowns; most of the pulses there give several returns, besides those on eaves.
    assert!((0.05..0.12).contains(&(several / pulses)), "{}", several / pulses);
}

#[test]
fn every_pattern_has_the_same_bits_for_any_number_of_threads() {
    let scene = town(&TownParams::default());
    for pattern in PATTERNS {
        let params = AirborneParams { pattern, beam: BeamParams::in_leaf(), ..AirborneParams::default() };
        let params = params.spread_over(&scene, None, 1.0);
        let with_threads = |count: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build().unwrap();
            pool.install(|| scan_airborne(&scene, &params))
        };
        let (one, three) = (with_threads(1), with_threads(3));
        assert!(one.len() > 10_000 && one == three, "{pattern:?}");
    }
}

#[test]
fn returns_of_an_edge_lie_on_both_sides_of_it_by_up_to_half_a_beam() {
    let scene = house_on_a_plate();
    let overshoot = |divergence: f64| {
        let quiet = AirborneParams { range_sd: 0.0, pointing_sd: 0.0, boresight_sd: 0.0, ..AirborneParams::default() };
        let beam = BeamParams { divergence, ..BeamParams::in_leaf() };
        let scan = scan_airborne(&scene, &AirborneParams { pulses_per_m2: 60.0, beam, ..quiet });
        let is_roof = |i: &usize| scene.materials[scan.triangle[*i] as usize] == Material::Roof;
        let roof: Vec<usize> = (0..scan.len()).filter(is_roof).collect();
        assert!(roof.len() > 10_000);
        for &i in &roof {
            let [x, y, z] = scan.exact_positions[i];
            assert!((z - 8.0).abs() < 1e-6 && x.abs().max(y.abs()) < 5.0 + 1e-6, "what was met lies on the roof");
            assert!((scan.z[i] - 8.0).abs() < 0.05 && scan.classification[i] == 6);
        }
        let beyond = roof.iter().map(|&i| scan.x[i].abs().max(scan.y[i].abs()) - 5.0);
        let (count, farthest) = beyond.filter(|d| *d > 1e-6).fold((0, 0.0_f64), |(n, far), d| (n + 1, far.max(d)));
        (count as f64 / roof.len() as f64, farthest)
    };
    assert_eq!(overshoot(0.0), (0.0, 0.0));
    // 18 cm at 450 m and up to 24 degrees aside: outer rays 6.4 to 7.2 cm from the axis, of which one is enough.
    let (share, farthest) = overshoot(4e-4);
    assert!((0.055..0.073).contains(&farthest), "{farthest}");
    // A ring of that width about a roof of 100 m², less the part without a ray of the six straight outwards.
    assert!((0.4..1.0).contains(&(share / (40.0 * 0.068 / 100.0))), "{share}");
}

#[test]
fn another_order_of_points_is_the_same_scan() {
    let scene = town(&TownParams::default());
    let params = AirborneParams { pulses_per_m2: 0.5, ..AirborneParams::default() };
    let scan = || scan_airborne(&scene, &params);
    let flown = scan();
    assert_eq!(scan().in_order(PointOrder::Flight, 1), flown);
    let row = |scan: &Scan, i: usize| {
        let exact = scan.exact_positions[i].map(f64::to_bits);
        let attributes = (scan.return_number[i], scan.return_count[i], scan.classification[i], scan.intensity[i]);
        let angle = scan.scan_angle_deg[i].to_bits();
        let place = [scan.x[i], scan.y[i], scan.z[i], scan.gps_time[i]].map(f64::to_bits);
        (place, attributes, angle, scan.point_source_id[i], scan.triangle[i], exact)
    };
    let rows = |scan: &Scan| -> std::collections::HashSet<_> { (0..scan.len()).map(|i| row(scan, i)).collect() };
    let square = |scan: &Scan, i: usize| [scan.y[i], scan.x[i]].map(|v| (v / 20.0).floor());
    for order in [PointOrder::Squares, PointOrder::Shuffled] {
        let other = scan().in_order(order, 1);
        assert_eq!((other.len(), rows(&other)), (flown.len(), rows(&flown)));
        assert_eq!((&other.sensor_path, other.report), (&flown.sensor_path, flown.report));
        assert_ne!(other.gps_time, flown.gps_time);
        assert_eq!(other, scan().in_order(order, 1));
        assert_eq!(other == scan().in_order(order, 2), order == PointOrder::Squares);
        let later = other.gps_time.windows(2).filter(|times| times[1] > times[0]).count() as f64 / other.len() as f64;
        if order == PointOrder::Shuffled {
            // Half of all, with a tolerance of a tenth.
            assert!((0.4..0.6).contains(&later), "{later}");
        } else {
            assert!((1..other.len()).all(|i| square(&other, i - 1) <= square(&other, i)), "row by row");
            assert!(later > 0.9, "as flown within a square: {later}");
        }
    }
}

#[test]
fn light_on_a_scan_is_that_of_the_shadow_of_a_box() {
    let scene = house_on_a_plate();
    let quiet = AirborneParams { range_sd: 0.0, pointing_sd: 0.0, boresight_sd: 0.0, ..AirborneParams::default() };
    let scan = scan_airborne(&scene, &AirborneParams { pulses_per_m2: 4.0, ..quiet });
    // Sun in the west, 45 degrees high: 8 m of shadow to the east of a house of 8 m.
    let lit = scan.lit_from(&scene, &Truth::new(&scene), [-1.0, 0.0, 1.0]);
    let mut shaded = 0;
    for (i, lit) in lit.iter().enumerate() {
        let [x, y, z] = scan.exact_positions[i];
        if z < -1e-6 {
            // A return on the side of the plate.
            continue;
        }
        let on_ground = z.abs() < 1e-6;
        // Light is tested 3 cm above the ground, which shortens the shadow by as much.
        let in_shadow = on_ground && y.abs() < 5.0 && x > 4.999 && x < 13.0 - 0.03;
        let on_dark_wall = (x - 5.0).abs() < 1e-6 && !on_ground;
        let near_edge = on_ground && ((x - 12.97).abs() < 1e-6 || (y.abs() - 5.0).abs() < 1e-6);
        assert!(near_edge || *lit != (in_shadow || on_dark_wall), "{:?}", scan.exact_positions[i]);
        shaded += usize::from(!lit);
    }
    // 10 by 8 m of ground at two strips of 4 pulses per m².
    assert!(shaded > 400, "{shaded}");
}
