//! Splats against brute force and known spacings; the implicit surface against a sphere and a plane.

use crate::common::{TestRandom, blocked, cloud_of, cross, dot, scan, small_town, sub, targets};
use belvedere::PointCloud;
use belvedere::query::Viewer;
use belvedere::ray_index::Ray;
use belvedere_baselines::MethodInput;
use belvedere_baselines::implicit_surface::{ImplicitSurface, ImplicitSurfaceParams, NormalSigns};
use belvedere_baselines::splatting::{SplatParams, SplatShape, Splats};

/// A level grid of points, `step_x` and `step_y` apart, about the origin.
fn grid(count: i16, step_x: f32, step_y: f32) -> PointCloud {
    let range = || -count..=count;
    cloud_of(range().flat_map(|i| range().map(move |j| [f32::from(i) * step_x, f32::from(j) * step_y, 0.0])).collect())
}

#[test]
fn splats_block_as_brute_force_over_all_of_them_says() {
    let (scene, _) = small_town();
    let cloud = scan(&scene);
    for params in [SplatParams::surfels(), SplatParams::depth_splats(), SplatParams::object_space()] {
        let splats = Splats::new(&cloud, &params).unwrap();
        let outlines = splats.outlines();
        assert_eq!(outlines.len(), cloud.len());
        let targets = targets(&cloud, 400, 3);
        let mut seen = [0; 2];
        for viewer in [Viewer::Direction([0.5, 0.3, 0.4]), Viewer::Eye([2.0, 5.0, 12.0])] {
            let answers = blocked(&splats, viewer, &targets);
            for (i, &target) in targets.iter().enumerate() {
                let (direction, range) = viewer.line_of_sight(i, target).unwrap();
                let expected = outlines.iter().any(|(center, axes, radius)| {
                    let to_center = sub(center.map(f64::from), target.map(f64::from));
                    let [u, v] = axes.map(|axis| axis.map(f64::from));
                    let normal = cross(u, v);
                    let facing = dot(normal, normal) == 0.0;
                    let normal = if facing { direction } else { normal };
                    let t = dot(to_center, normal) / dot(direction, normal);
                    let off: [f64; 3] = std::array::from_fn(|i| t * direction[i] - to_center[i]);
                    let inside = if facing {
                        dot(off, off) <= f64::from(*radius).powi(2)
                    } else {
                        (dot(off, u) / dot(u, u)).powi(2) + (dot(off, v) / dot(v, v)).powi(2) <= 1.0
                    };
                    inside && t >= params.clearance && t <= range
                });
                assert_eq!(answers[i], expected, "{:?} {target:?}", params.shape);
                seen[usize::from(expected)] += 1;
            }
        }
        assert!(seen.iter().all(|&n| n > 50), "{seen:?}");
    }
}

#[test]
fn splats_of_a_grid_have_the_radius_and_shape_of_its_spacing() {
    let middle = |cloud: &PointCloud, params: &SplatParams| {
        let outlines = Splats::new(cloud, params).unwrap().outlines();
        outlines.into_iter().find(|(center, _, _)| *center == [0.0; 3]).unwrap()
    };
    let length = |v: [f32; 3]| dot(v.map(f64::from), v.map(f64::from)).sqrt();
    // the sixth nearest of a square grid is a diagonal neighbour
    let (_, axes, radius) = middle(&grid(8, 0.5, 0.5), &SplatParams { radius_scale: 0.8, ..SplatParams::surfels() });
    let expected = 0.8 * 0.5 * 2.0_f64.sqrt();
    for axis in axes {
        // a ten-millionth: f32
        assert!((length(axis) - expected).abs() < 1e-7 && axis[2] == 0.0, "{axis:?}");
    }
    assert!((f64::from(radius) - expected).abs() < 1e-7);
    // rows twice as far apart as points within them: the ellipse reaches farther across the rows than along them, and
    // keeps the area of the disc
    let rows = grid(12, 1.0, 0.25);
    let [disc, ellipse] = [SplatParams::surfels(), SplatParams::object_space()].map(|params| middle(&rows, &params).1);
    let area = |[u, v]: [[f32; 3]; 2]| length(cross(u.map(f64::from), v.map(f64::from)).map(|v| v as f32));
    assert!((area(disc) - area(ellipse)).abs() < 1e-6);
    let (along, across) = (length(ellipse[0]), length(ellipse[1]));
    assert!(along / across < 3.001 && along > across, "{along} {across}");
    // a point far from the others is no wide disc
    let mut lonely = grid(8, 0.5, 0.5);
    lonely.positions.push([60.0, 0.0, 3.0]);
    let outlines = Splats::new(&lonely, &SplatParams::surfels()).unwrap().outlines();
    let widest = outlines.iter().map(|&(_, _, radius)| f64::from(radius)).fold(0.0, f64::max);
    assert!((widest - 4.0 * 0.6 * 0.5 * 2.0_f64.sqrt()).abs() < 1e-6, "{widest}");
}

#[test]
fn a_wide_enough_splatted_plane_blocks_and_narrow_splats_leave_holes() {
    let plane = grid(20, 0.5, 0.5);
    let mut random = TestRandom(8);
    let below: Vec<[f32; 3]> = (0..2000).map(|_| random.point([-9.0, -9.0, -3.0], [9.0, 9.0, -1.1])).collect();
    let up = Viewer::Direction([0.0, 0.0, 1.0]);
    let share = |radius_scale: f64, shape: SplatShape| {
        let splats = Splats::new(&plane, &SplatParams { radius_scale, shape, ..SplatParams::surfels() }).unwrap();
        crate::common::count_true(&blocked(&splats, up, &below)) as f64 / 2000.0
    };
    // radius as a share of the diagonal: discs of half the diagonal just cover the square
    assert_eq!(share(0.501, SplatShape::Disc), 1.0);
    assert_eq!(share(0.501, SplatShape::Facing), 1.0);
    // discs of 0.2 diagonals cover π · 0.2² · 2 of the plane; 2000 targets tell that to 1 % (one sigma)
    assert!((share(0.2, SplatShape::Disc) - std::f64::consts::PI * 0.08).abs() < 0.04);
}

/// About evenly spread points of a sphere about the origin.
fn sphere(radius: f64, count: u32) -> PointCloud {
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    cloud_of(
        (0..count)
            .map(|i| {
                let z = 1.0 - 2.0 * (f64::from(i) + 0.5) / f64::from(count);
                let (ring, angle) = ((1.0 - z * z).sqrt(), golden * f64::from(i));
                [ring * angle.cos(), ring * angle.sin(), z].map(|v| (radius * v) as f32)
            })
            .collect(),
    )
}

#[test]
fn rays_meet_the_implicit_surface_where_the_sphere_is() {
    let (radius, count) = (5.0, 8000);
    let cloud = sphere(radius, count);
    let spacing = (4.0 * std::f64::consts::PI * radius * radius / f64::from(count)).sqrt();
    // a known scanner above gives signs; without one they come from the neighbours
    let scanner = vec![[0.0, 0.0, 500.0]; cloud.len()];
    for signs in [NormalSigns::Agreeing, NormalSigns::Outward] {
        let params = ImplicitSurfaceParams { signs, ..ImplicitSurfaceParams::default() };
        let surface =
            ImplicitSurface::new(&MethodInput { cloud: &cloud, scanner: &scanner, models: &[] }, &params).unwrap();
        assert_eq!(surface.left_out(), 0);
        let mut random = TestRandom(3);
        for _ in 0..2000 {
            let from = random.direction().map(|v| 20.0 * v);
            let aim = random.direction().map(|v| 0.9 * radius * v);
            let ray = Ray::new(from, sub(aim, from), [0.0, f64::INFINITY]).unwrap();
            if signs == NormalSigns::Outward && aim[2].abs() < 2.0 {
                // signs towards a scanner straight above change at the equator, where the surface looks past it
                continue;
            }
            let hit = surface.first(&ray).map(|range| ray.at(range));
            if let Some(hit) = hit {
                let height = dot(hit, hit).sqrt() - radius;
                if signs == NormalSigns::Outward && hit[2].abs() < 2.0 {
                    continue;
                }
                // over a spacing the sphere falls away by spacing² / 2 radius, a fiftieth of the spacing; means over a
                // support, the plane of 16 neighbours and the bisection err by a few times that
                assert!(height.abs() < 0.1 * spacing, "{height} of {spacing} at {hit:?}");
            } else {
                panic!("{signs:?}: the ray to {aim:?} from {from:?} met nothing");
            }
        }
        // rays that pass by more than the support away meet nothing
        for _ in 0..2000 {
            let (normal, other) = (random.direction(), random.direction());
            let beside = normal.map(|v| (radius + 3.0 * spacing) * v);
            let ray = Ray::new(beside, cross(normal, other), [-50.0, 50.0]).unwrap();
            assert_eq!(surface.first(&ray), None);
        }
    }
}

#[test]
fn the_implicit_plane_ends_at_its_edge_and_at_a_hole() {
    let mut cloud = grid(20, 0.5, 0.5);
    cloud.positions.retain(|p| p[0].hypot(p[1]) > 3.0);
    let survey = MethodInput { cloud: &cloud, scanner: &[], models: &[] };
    let surface = ImplicitSurface::new(&survey, &ImplicitSurfaceParams::default()).unwrap();
    let mut random = TestRandom(11);
    // support: 0.9 diagonals of 0.5 m; at twice that distance from the edge there is no doubt on either side
    let margin = 2.0 * 0.9 * 0.5 * 2.0_f64.sqrt();
    let mut seen = [0; 2];
    for _ in 0..5000 {
        let [x, y] = [0, 1].map(|_| random.between(-15.0, 15.0));
        let tilt = [random.between(-0.5, 0.5), random.between(-0.5, 0.5), 1.0];
        let ray = Ray::new([x - 4.0 * tilt[0], y - 4.0 * tilt[1], -4.0], tilt, [0.0, f64::INFINITY]).unwrap();
        let from_hole = x.hypot(y) - 3.0;
        let within = 10.0 - x.abs().max(y.abs());
        let range = surface.first(&ray);
        if from_hole > margin && within > margin {
            let hit = ray.at(range.unwrap());
            // the surface is level: what is left is the bisection, 0.16 m / 2⁸, on slanted rays
            assert!(hit[2].abs() < 1e-3, "{hit:?}");
            seen[0] += 1;
        } else if from_hole < -margin || within < -margin {
            assert_eq!(range, None, "{x} {y}");
            seen[1] += 1;
        }
    }
    assert!(seen.iter().all(|&n| n > 500), "{seen:?}");
}

#[test]
fn the_implicit_surface_refuses_parameters_out_of_range() {
    let cloud = grid(3, 1.0, 1.0);
    let survey = MethodInput { cloud: &cloud, scanner: &[], models: &[] };
    let default = ImplicitSurfaceParams::default;
    for params in [
        ImplicitSurfaceParams { step: 0.0, ..default() },
        ImplicitSurfaceParams { step: 2.0, ..default() },
        ImplicitSurfaceParams { step: f64::NAN, ..default() },
        ImplicitSurfaceParams { support_scale: -1.0, ..default() },
        ImplicitSurfaceParams { support_neighbor: 0, ..default() },
        ImplicitSurfaceParams { edge: 0.0, ..default() },
        ImplicitSurfaceParams { normal_neighbors: 2, ..default() },
    ] {
        assert!(ImplicitSurface::new(&survey, &params).is_err(), "{params:?}");
    }
    assert!(Splats::new(&cloud, &SplatParams { radius_neighbor: 0, ..SplatParams::surfels() }).is_err());
    assert!(Splats::new(&cloud, &SplatParams { radius_scale: f64::NAN, ..SplatParams::surfels() }).is_err());
    let empty = cloud_of(Vec::new());
    let nothing = ImplicitSurface::new(&MethodInput { cloud: &empty, scanner: &[], models: &[] }, &default()).unwrap();
    assert!(!blocked(&nothing, Viewer::Eye([1.0; 3]), &[[0.0; 3]])[0]);
}
