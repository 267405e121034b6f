//! The Poisson surface against a sphere and the exact mesh of a town.

use crate::common::{TestRandom, blocked, cloud_of, count_true, dot, targets};
use belvedere::query::Viewer;
use belvedere::ray_index::Ray;
use belvedere::{Error, PointCloud};
use belvedere_baselines::MethodInput;
use belvedere_baselines::mesh_rays::MeshRays;
use belvedere_baselines::poisson::{Poisson, PoissonParams};
use belvedere_baselines::simulated::flown;
use belvedere_scenes::{AirborneParams, TownParams, Truth, town};

/// About evenly spread points of a sphere about the origin, each seen from outside along its normal.
fn seen_sphere(radius: f64, count: u32) -> (PointCloud, Vec<[f32; 3]>) {
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let unit: Vec<[f64; 3]> = (0..count)
        .map(|i| {
            let z = 1.0 - 2.0 * (f64::from(i) + 0.5) / f64::from(count);
            let (ring, angle) = ((1.0 - z * z).sqrt(), golden * f64::from(i));
            [ring * angle.cos(), ring * angle.sin(), z]
        })
        .collect();
    let scaled = |scale: f64| unit.iter().map(|p| p.map(|v| (scale * v) as f32)).collect();
    (cloud_of(scaled(radius)), scaled(20.0 * radius))
}

/// Follows rays that hit and miss a sphere of 5 m; hits are within `tolerance`.
fn check_sphere(rays: &MeshRays, tolerance: f64) {
    let mut random = TestRandom(4);
    let mut seen = [0; 2];
    for _ in 0..12_000 {
        let direction = random.direction();
        let origin: [f64; 3] = random.point([-9.0; 3], [9.0; 3]).map(f64::from);
        let towards = dot(origin, direction);
        let from_center = (dot(origin, origin) - towards * towards).sqrt();
        let ray = Ray::new(origin, direction, [0.0, f64::INFINITY]).unwrap();
        let hit = rays.first(&ray).map(|(range, _)| range);
        if from_center > 5.0 + tolerance || towards > 0.0 && dot(origin, origin).sqrt() > 5.0 + tolerance {
            assert_eq!(hit, None, "{origin:?} {direction:?}");
            seen[0] += 1;
        } else if from_center < 4.0 && dot(origin, origin).sqrt() > 5.0 + tolerance {
            let at = ray.at(hit.unwrap());
            assert!((dot(at, at).sqrt() - 5.0).abs() < tolerance, "{at:?}");
            seen[1] += 1;
        }
    }
    assert!(seen.iter().all(|&n| n > 300), "{seen:?}");
}

#[test]
fn rays_meet_a_reconstructed_sphere_where_the_sphere_is() {
    let (cloud, scanner) = seen_sphere(5.0, 3000);
    let survey = MethodInput { cloud: &cloud, scanner: &scanner, models: &[] };
    let spacing = (4.0 * std::f64::consts::PI * 25.0 / 3000.0_f64).sqrt();
    let smooth = Poisson::new(&survey, &PoissonParams::default()).unwrap();
    assert_eq!(smooth.left_out(), 0);
    // cells are as wide as the spacing: half of one
    check_sphere(smooth.rays(), 0.5 * spacing);
}

#[test]
fn any_number_of_threads_reconstructs_the_same_surface() {
    let (cloud, scanner) = seen_sphere(5.0, 1000);
    let survey = MethodInput { cloud: &cloud, scanner: &scanner, models: &[] };
    let mut random = TestRandom(6);
    let rays: Vec<Ray> = (0..500)
        .map(|_| Ray::new(random.point([-1.0; 3], [1.0; 3]).map(f64::from), random.direction(), [0.0, 99.0]).unwrap())
        .collect();
    let ranges = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let smooth = Poisson::new(&survey, &PoissonParams::default()).unwrap();
            rays.iter().map(|ray| smooth.rays().first(ray)).collect::<Vec<_>>()
        })
    };
    let one = ranges(1);
    assert!(one.iter().all(Option::is_some));
    assert_eq!(ranges(2), one);
    assert_eq!(ranges(7), one);
}

#[test]
fn most_of_a_town_is_reconstructed() {
    let scene = town(&TownParams { extent: 60.0, seed: 5, ..TownParams::default() });
    let (cloud, scanner) = flown(&scene, &AirborneParams { pulses_per_m2: 2.0, ..AirborneParams::default() }).unwrap();
    let survey = MethodInput { cloud: &cloud, scanner: &scanner, models: &[] };
    let truth = Truth::new(&scene);
    let targets = targets(&cloud, 3000, 8);
    let exact: Vec<[f64; 3]> =
        targets.iter().map(|t| std::array::from_fn(|i| f64::from(t[i]) + cloud.frame.origin[i])).collect();
    let sun = [0.48, -0.6, 0.64];
    let expected = truth.occluded_towards_each(&exact, sun);
    let smooth = Poisson::new(&survey, &PoissonParams::default()).unwrap();
    let found = blocked(&smooth, Viewer::Direction(sun), &targets);
    let wrong = found.iter().zip(&expected).filter(|(a, b)| a != b).count();
    // targets are anywhere in the box; splats at 2 points/m² are wrong in one of eight
    assert!(wrong < 3000 / 8, "{wrong} wrong");
    assert!((300..2700).contains(&count_true(&expected)));
}

#[test]
fn clouds_that_have_no_surface_block_nothing_and_wrong_parameters_are_refused() {
    let scanner = [[0.0, 0.0, 100.0]; 5];
    for positions in [Vec::new(), vec![[0.0; 3]], vec![[1.0; 3]; 5], vec![[0.0; 3], [1.0; 3], [2.0; 3], [3.0; 3]]] {
        let cloud = cloud_of(positions);
        let survey = MethodInput { cloud: &cloud, scanner: &scanner[..cloud.len()], models: &[] };
        let smooth = Poisson::new(&survey, &PoissonParams::default()).unwrap();
        assert_eq!(blocked(&smooth, Viewer::Eye([0.4, 0.3, 9.0]), &[[0.0, 0.0, -9.0]]), [false]);
    }
    let cloud = cloud_of(vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [f32::NAN; 3]]);
    let survey = MethodInput { cloud: &cloud, scanner: &[], models: &[] };
    let error = Poisson::new(&survey, &PoissonParams::default()).err().unwrap();
    assert!(error.to_string().contains("finite"), "{error}");
    let cloud = cloud_of(cloud.positions[..4].to_vec());
    let survey = MethodInput { cloud: &cloud, scanner: &[], models: &[] };
    let short = MethodInput { cloud: &cloud, scanner: &scanner[..2], models: &[] };
    assert!(matches!(Poisson::new(&short, &PoissonParams::default()), Err(Error::LengthMismatch { .. })));
    let default = PoissonParams::default;
    for params in [
        PoissonParams { area_neighbor: 0, ..default() },
        PoissonParams { cell_in_spacings: 0.1, ..default() },
        PoissonParams { min_cell: f64::NAN, ..default() },
        PoissonParams { screening: -1.0, ..default() },
        PoissonParams { trim: 0.0, ..default() },
        PoissonParams { clearance: f64::NAN, ..default() },
    ] {
        assert!(matches!(Poisson::new(&survey, &params), Err(Error::InvalidParameter { .. })), "{params:?}");
    }
    // two floors with points a metre apart, ten thousand kilometres from each other
    let floor = |x: f32| (0..100_i16).map(move |i| [x + f32::from(i % 10), f32::from(i / 10), 0.0]);
    let far: Vec<[f32; 3]> = floor(0.0).chain(floor(1e7)).collect();
    let cloud = cloud_of(far);
    let survey = MethodInput { cloud: &cloud, scanner: &[], models: &[] };
    let error = Poisson::new(&survey, &PoissonParams::default()).err().unwrap();
    assert!(error.to_string().contains("stray points"), "{error}");
}
