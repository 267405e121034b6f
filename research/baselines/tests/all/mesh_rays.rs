//! Mesh rays against the exact answers of the scenes and against shared edges; shadow maps against mesh rays.

use crate::common::{TestRandom, blocked, count_true, scan, small_town, targets};
use belvedere::Mesh;
use belvedere::query::{Viewer, Visibility};
use belvedere::ray_index::Ray;
use belvedere_baselines::mesh_rays::{MeshRays, MeshRaysParams};
use belvedere_baselines::shadow_map::{ShadowMap, ShadowMapParams};
use belvedere_scenes::Truth;

#[test]
fn mesh_rays_agree_with_the_exact_answers_beyond_a_centimetre() {
    let (scene, mesh) = small_town();
    let cloud = scan(&scene);
    let truth = Truth::new(&scene);
    let rays = MeshRays::new(&mesh, cloud.frame.origin, &MeshRaysParams::default()).unwrap();
    assert_eq!(rays.left_out(), 0);
    let targets = targets(&cloud, 20_000, 1);
    let absolute = |p: [f64; 3]| std::array::from_fn(|i| p[i] + cloud.frame.origin[i]);
    let (eye, sun) = ([3.0, -7.0, 30.0], [0.4, -0.3, 0.5]);
    let answers = [Viewer::Direction(sun), Viewer::Eye(eye)].map(|viewer| blocked(&rays, viewer, &targets));
    let mut skin = 0;
    for (i, &target) in targets.iter().enumerate() {
        let target = target.map(f64::from);
        let ahead = |direction: [f64; 3]| {
            let length = crate::common::dot(direction, direction).sqrt();
            absolute(std::array::from_fn(|i| target[i] + 0.01 * direction[i] / length))
        };
        let to_eye = crate::common::sub(eye, target);
        let exact = [
            [truth.occluded_towards(absolute(target), sun), truth.occluded_towards(ahead(sun), sun)],
            [truth.occluded(absolute(target), absolute(eye)), truth.occluded(ahead(to_eye), absolute(eye))],
        ];
        for (exact, answers) in exact.iter().zip(&answers) {
            // a surface within a centimetre of the target is the skin
            if exact[0] == exact[1] {
                assert_eq!(answers[i], exact[0], "target {target:?}");
            } else {
                skin += 1;
            }
        }
    }
    let shaded = count_true(&answers[0]);
    assert!(skin < 200 && shaded > 1000 && shaded < 19_000, "{skin} in the skin, {shaded} shaded");
}

#[test]
fn no_ray_slips_between_triangles_that_share_an_edge() {
    // a closed fan-shaped hull: two poles and a crooked ring, and an eye inside
    let mut random = TestRandom(5);
    let count = 40;
    let mut vertices = vec![[0.1, 0.2, 9.0], [-0.3, 0.4, -8.0]];
    for i in 0..count {
        let angle = f64::from(i) / f64::from(count) * std::f64::consts::TAU;
        vertices.push([angle.cos() * random.between(4.0, 9.0), angle.sin() * 7.0, random.between(-1.0, 1.0)]);
    }
    let ring = |i: u32| 2 + i % count;
    let triangles: Vec<[u32; 3]> =
        (0..count).flat_map(|i| [[0, ring(i), ring(i + 1)], [1, ring(i + 1), ring(i)]]).collect();
    let mesh = Mesh { vertices: vertices.clone(), triangles: triangles.clone(), ..Mesh::default() };
    let rays = MeshRays::new(&mesh, [0.0; 3], &MeshRaysParams::default()).unwrap();
    for triangle in &triangles {
        for (a, b) in [(0, 1), (1, 2), (2, 0)] {
            let [a, b] = [a, b].map(|corner: usize| vertices[triangle[corner] as usize]);
            for share in [0.0, 0.25, 1.0 / 3.0, 0.5, random.between(0.0, 1.0)] {
                let aim = std::array::from_fn(|i| a[i] + share * (b[i] - a[i]));
                let ray = Ray::new([0.0; 3], aim, [0.0, f64::INFINITY]).unwrap();
                assert!(rays.blocks(&ray), "slipped through {aim:?}");
            }
        }
    }
}

#[test]
fn only_triangles_beyond_the_clearance_and_before_the_eye_block() {
    let square = |z: f64| [[-1.0, -1.0, z], [3.0, -1.0, z], [-1.0, 3.0, z]];
    let rays = |z: f64| MeshRays::from_local_triangles(vec![square(z)], &MeshRaysParams { clearance: 0.5 }).unwrap();
    let seen = |z: f64, viewer| blocked(&rays(z), viewer, &[[0.0; 3]])[0];
    assert!(!seen(0.4, Viewer::Direction([0.0, 0.0, 1.0])));
    assert!(seen(0.6, Viewer::Direction([0.0, 0.0, 1.0])));
    assert!(!seen(0.6, Viewer::Direction([0.0, 0.0, -1.0])));
    assert!(seen(1.9, Viewer::Eye([0.0, 0.0, 2.0])) && !seen(2.1, Viewer::Eye([0.0, 0.0, 2.0])));
    let bad = [[f64::NAN, 0.0, 0.0], [0.0; 3], [1.0; 3]];
    let with_bad = MeshRays::from_local_triangles(vec![bad, square(1.0)], &MeshRaysParams::default()).unwrap();
    assert_eq!(with_bad.left_out(), 1);
    assert!(blocked(&with_bad, Viewer::Direction([0.0, 0.0, 1.0]), &[[0.0; 3]])[0]);
}

/// Ground of 40 m, a block of 10 × 8 × 12 m on it and a slab that floats.
fn blocks() -> Mesh {
    let mut mesh = Mesh::default();
    let mut quad = |corners: [[f64; 3]; 4]| {
        let first = mesh.vertices.len() as u32;
        mesh.vertices.extend(corners);
        mesh.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    };
    let mut solid = |[x0, y0, z0]: [f64; 3], [x1, y1, z1]: [f64; 3]| {
        for z in [z0, z1] {
            quad([[x0, y0, z], [x1, y0, z], [x1, y1, z], [x0, y1, z]]);
        }
        for x in [x0, x1] {
            quad([[x, y0, z0], [x, y1, z0], [x, y1, z1], [x, y0, z1]]);
        }
        for y in [y0, y1] {
            quad([[x0, y, z0], [x1, y, z0], [x1, y, z1], [x0, y, z1]]);
        }
    };
    solid([-20.0, -20.0, -1.0], [20.0, 20.0, 0.0]);
    solid([-5.0, -4.0, 0.0], [5.0, 4.0, 12.0]);
    solid([8.0, -10.0, 5.0], [15.0, 9.0, 5.5]);
    mesh
}

#[test]
fn shadow_maps_agree_with_mesh_rays_away_from_the_edges_of_shadows() {
    let mesh = blocks();
    let params = ShadowMapParams::default();
    let map = ShadowMap::new(&mesh, [0.0; 3], &params).unwrap();
    // a map cannot distinguish what lies within the greatest bias of a target from the target's own surface
    let bias = params.depth_bias + params.max_slope_bias;
    let [near, far] =
        [0.0, 2.0 * bias].map(|clearance| MeshRays::new(&mesh, [0.0; 3], &MeshRaysParams { clearance }).unwrap());
    let mut random = TestRandom(2);
    let points: Vec<[f32; 3]> = (0..30_000).map(|_| random.point([-19.0, -19.0, 0.1], [19.0, 19.0, 14.0])).collect();
    let eye = [-13.3, 2.1, 9.7];
    // a pixel of the map around the eye is nowhere in this scene wider than 40 m / 512
    for (viewer, step) in [
        (Viewer::Direction([0.5, -0.45, 0.4]), params.pixel_size),
        (Viewer::Direction([0.0, 0.0, 1.0]), params.pixel_size),
        (Viewer::Eye(eye), 0.1),
    ] {
        let expected = blocked(&near, viewer, &points);
        let mut even = blocked(&far, viewer, &points).iter().zip(&expected).map(|(a, b)| a == b).collect::<Vec<_>>();
        let (right, up) = match viewer {
            Viewer::Direction([x, y, _]) if x != 0.0 || y != 0.0 => ([-y, x, 0.0], [0.0, 0.0, 1.0]),
            Viewer::Direction(_) => ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
            _ => ([0.0; 3], [0.0; 3]),
        };
        for (a, b) in
            [(-1.0, -1.0), (-1.0, 0.0), (-1.0, 1.0), (0.0, -1.0), (0.0, 1.0), (1.0, -1.0), (1.0, 0.0), (1.0, 1.0)]
        {
            let moved: Vec<[f32; 3]> = points
                .iter()
                .map(|&p| {
                    let (right, up) = if let Viewer::Eye(eye) = viewer {
                        let d = crate::common::sub(p.map(f64::from), eye);
                        let right = [-d[1], d[0], 0.0];
                        (right, crate::common::cross(d, right))
                    } else {
                        (right, up)
                    };
                    let [right, up] = [right, up].map(|v| v.map(|c| c * 1.5 * step / crate::common::dot(v, v).sqrt()));
                    std::array::from_fn(|i| (f64::from(p[i]) + a * right[i] + b * up[i]) as f32)
                })
                .collect();
            for (even, (moved, expected)) in even.iter_mut().zip(blocked(&near, viewer, &moved).iter().zip(&expected)) {
                *even &= moved == expected;
            }
        }
        let answers = blocked(&map, viewer, &points);
        let wrong: Vec<_> = (0..points.len()).filter(|&i| even[i] && answers[i] != expected[i]).collect();
        assert!(wrong.is_empty(), "{viewer:?}: {} wrong, such as {:?}", wrong.len(), points[wrong[0]]);
        let shaded = (0..points.len()).filter(|&i| even[i] && expected[i]).count();
        assert!(count_true(&even) > 15_000 && shaded > 1000, "{} even, {shaded} shaded", count_true(&even));
    }
}

#[test]
fn a_flat_surface_does_not_shade_itself_whatever_the_sun() {
    let mesh = blocks();
    let map = ShadowMap::new(&mesh, [0.0; 3], &ShadowMapParams::default()).unwrap();
    let mut random = TestRandom(9);
    // the ground south and west of the blocks, which the sun from there reaches
    let points: Vec<[f32; 3]> = (0..5000).map(|_| random.point([-19.0, -19.0, 0.0], [-6.0, -11.0, 0.0])).collect();
    // from 45°: lower down, the greatest bias rules
    for elevation in [45.0_f64, 60.0, 90.0] {
        let sun = belvedere::view::to_sun(200_f64.to_radians(), elevation.to_radians());
        assert_eq!(count_true(&blocked(&map, Viewer::Direction(sun), &points)), 0, "{elevation}°");
    }
}

#[test]
fn a_shadow_map_has_no_eye_for_each_target() {
    let map = ShadowMap::new(&blocks(), [0.0; 3], &ShadowMapParams::default()).unwrap();
    let eyes = [[1.0; 3]];
    assert!(matches!(map.visible(Viewer::Each(&eyes), &eyes), Err(belvedere::Error::UnsupportedViewer { .. })));
    for params in [
        ShadowMapParams { pixel_size: 0.0, ..ShadowMapParams::default() },
        ShadowMapParams { face_px: 0, ..ShadowMapParams::default() },
        ShadowMapParams { depth_bias: f64::NAN, ..ShadowMapParams::default() },
    ] {
        assert!(ShadowMap::new(&blocks(), [0.0; 3], &params).is_err(), "{params:?}");
    }
}
