//! What every method must keep: its viewers agree with each other, threads and more obstacles change nothing for the
//! worse.

use crate::common::{blocked, count_true, scan, small_town, targets};
use belvedere::query::{Answer, Viewer, Visibility};
use belvedere::{Error, Mesh, PointCloud};
use belvedere_baselines::MethodInput;
use belvedere_baselines::dsm::{Dsm, DsmParams, DsmSurface, GapFill};
use belvedere_baselines::implicit_surface::{ImplicitSurface, ImplicitSurfaceParams};
use belvedere_baselines::mesh_rays::{MeshRays, MeshRaysParams};
use belvedere_baselines::shadow_map::{ShadowMap, ShadowMapParams};
use belvedere_baselines::splatting::{SplatParams, Splats};
use belvedere_baselines::voxels::{VoxelParams, Voxels};

type NamedMethod = (&'static str, Box<dyn Visibility>);

/// Every method that answers each kind of viewer, of one place.
fn ray_methods(cloud: &PointCloud, mesh: &Mesh) -> Vec<NamedMethod> {
    let survey = MethodInput { cloud, scanner: &[], models: &[] };
    let dsm = |relief| Dsm::from_points(&cloud.positions, &DsmParams { relief, ..DsmParams::default() }).unwrap();
    vec![
        ("mesh rays", Box::new(MeshRays::new(mesh, cloud.frame.origin, &MeshRaysParams::default()).unwrap())),
        ("columns", Box::new(dsm(DsmSurface::Columns))),
        ("bilinear", Box::new(dsm(DsmSurface::Bilinear))),
        ("exact DSM", Box::new(Dsm::from_mesh(mesh, cloud.frame.origin, &DsmParams::default()).unwrap())),
        ("voxels", Box::new(Voxels::new(&cloud.positions, &VoxelParams::default()).unwrap())),
        ("surfels", Box::new(Splats::new(cloud, &SplatParams::surfels()).unwrap())),
        ("depth splats", Box::new(Splats::new(cloud, &SplatParams::depth_splats()).unwrap())),
        ("object space", Box::new(Splats::new(cloud, &SplatParams::object_space()).unwrap())),
        ("implicit", Box::new(ImplicitSurface::new(&survey, &ImplicitSurfaceParams::default()).unwrap())),
    ]
}

fn all_methods(cloud: &PointCloud, mesh: &Mesh) -> Vec<NamedMethod> {
    let mut methods = ray_methods(cloud, mesh);
    methods.push(("shadow map", Box::new(small_shadow_map(cloud, mesh))));
    methods
}

/// Few pixels: these tests require equal results, not accuracy.
fn small_shadow_map(cloud: &PointCloud, mesh: &Mesh) -> ShadowMap {
    let params = ShadowMapParams { pixel_size: 0.5, face_px: 128, ..ShadowMapParams::default() };
    ShadowMap::new(mesh, cloud.frame.origin, &params).unwrap()
}

const SUN: [f64; 3] = [0.48, -0.6, 0.64];

#[test]
fn an_eye_for_each_target_answers_as_the_common_eye_and_far_away_as_the_direction() {
    let (scene, mesh) = small_town();
    let cloud = scan(&scene);
    let targets = targets(&cloud, 3000, 1);
    let eye = [4.0_f32, -9.0, 6.0];
    let same_eye = vec![eye; targets.len()];
    let far: Vec<[f32; 3]> =
        targets.iter().map(|t| std::array::from_fn(|i| (f64::from(t[i]) + 1e6 * SUN[i]) as f32)).collect();
    for (name, method) in ray_methods(&cloud, &mesh) {
        let common = blocked(method.as_ref(), Viewer::Eye(eye.map(f64::from)), &targets);
        assert_eq!(blocked(method.as_ref(), Viewer::Each(&same_eye), &targets), common, "{name}");
        let sun = blocked(method.as_ref(), Viewer::Direction(SUN), &targets);
        let sun_10 = blocked(method.as_ref(), Viewer::Direction(SUN.map(|v| 10.0 * v)), &targets);
        assert_eq!(sun, sun_10, "{name}");
        let each = blocked(method.as_ref(), Viewer::Each(&far), &targets);
        // f32 turns a far eye by 6e-8, which moves a line by some µm: only one that grazes an edge that closely changes
        let changed = sun.iter().zip(&each).filter(|(a, b)| a != b).count();
        assert!(changed <= 3, "{name}: {changed} changed");
        assert!((100..2900).contains(&count_true(&sun)), "{name}: {} in shade", count_true(&sun));
    }
}

#[test]
fn any_number_of_threads_gives_the_same_answers() {
    let (scene, mesh) = small_town();
    let cloud = scan(&scene);
    let targets = targets(&cloud, 3000, 2);
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let answer = |(name, method): NamedMethod| {
                let viewers = [Viewer::Direction(SUN), Viewer::Eye([1.0, 2.0, 9.0])];
                (name, viewers.map(|viewer| method.visible(viewer, &targets).unwrap()))
            };
            all_methods(&cloud, &mesh).into_iter().map(answer).collect::<Vec<_>>()
        })
    };
    let one = run(1);
    assert_eq!(run(2), one);
    assert_eq!(run(7), one);
}

#[test]
fn targets_without_an_answer_are_outside_the_view_and_wrong_viewers_are_errors() {
    let (scene, mesh) = small_town();
    let cloud = scan(&scene);
    let eye = [1.0_f32, 2.0, 30.0];
    let targets = [eye, [f32::NAN, 0.0, 0.0], [0.0, f32::INFINITY, 0.0], [1.0, 2.0, 29.0]];
    for (name, method) in all_methods(&cloud, &mesh) {
        let answers = method.visible(Viewer::Eye(eye.map(f64::from)), &targets).unwrap();
        assert_eq!(answers[..3], [Answer::OutsideView; 3], "{name}");
        assert_ne!(answers[3], Answer::OutsideView, "{name}");
        let sun = method.visible(Viewer::Direction(SUN), &targets).unwrap();
        assert_eq!(sun.map_outside(), [false, true, true, false], "{name}");
        // high above everything there is nothing between a target and a high sun
        assert_eq!(method.visible(Viewer::Direction(SUN), &[[0.0, 0.0, 300.0]]).unwrap(), [Answer::Visible], "{name}");
        for viewer in [Viewer::Direction([0.0; 3]), Viewer::Eye([f64::NAN; 3]), Viewer::Direction([f64::INFINITY; 3])] {
            assert!(matches!(method.seen_from(viewer), Err(Error::InvalidParameter { .. })), "{name}");
        }
        if name != "shadow map" {
            let short = method.visible(Viewer::Each(&targets[..1]), &targets);
            assert!(matches!(short, Err(Error::LengthMismatch { .. })), "{name}");
        }
    }
}

trait MapOutside {
    fn map_outside(&self) -> Vec<bool>;
}

impl MapOutside for Vec<Answer> {
    fn map_outside(&self) -> Vec<bool> {
        self.iter().map(|&answer| answer == Answer::OutsideView).collect()
    }
}

#[test]
fn adding_obstacles_never_reveals() {
    let (scene, mesh) = small_town();
    let cloud = scan(&scene);
    let targets = targets(&cloud, 3000, 5);
    // as a second obstacle a copy of the town, 128 m up: the neighbours of each point stay the same, so that what is
    // made of them does too
    let mut more = cloud.clone();
    more.positions.extend(cloud.positions.iter().map(|p| [p[0], p[1], p[2] + 128.0]));
    more.attributes.return_number = None;
    let mut more_mesh = mesh.clone();
    let count = u32::try_from(mesh.vertices.len()).unwrap();
    more_mesh.vertices.extend(mesh.vertices.iter().map(|v| [v[0], v[1], v[2] + 128.0]));
    more_mesh.triangles.extend(mesh.triangles.iter().map(|t| t.map(|corner| corner + count)));
    let methods = |cloud: &PointCloud, mesh: &Mesh| -> Vec<NamedMethod> {
        let dsm = |relief| {
            let params = DsmParams { relief, gap_fill: GapFill::Leave, ..DsmParams::default() };
            Box::new(Dsm::from_points(&cloud.positions, &params).unwrap())
        };
        let mut methods = all_methods(cloud, mesh);
        // what is filled into gaps may sink
        methods.retain(|(name, _)| !["columns", "bilinear"].contains(name));
        methods.push(("columns, no gaps filled", dsm(DsmSurface::Columns)));
        methods.push(("bilinear, no gaps filled", dsm(DsmSurface::Bilinear)));
        methods
    };
    // a sun high enough to reach the town under its copy, and an eye between the two
    for viewer in [Viewer::Direction([0.1, 0.2, 0.97]), Viewer::Eye([5.0, 3.0, 90.0])] {
        let after = methods(&more, &more_mesh);
        for ((name, before), (_, after)) in methods(&cloud, &mesh).into_iter().zip(after) {
            let before = blocked(before.as_ref(), viewer, &targets);
            let after = blocked(after.as_ref(), viewer, &targets);
            let revealed = before.iter().zip(&after).filter(|&(&before, &after)| before && !after).count();
            // the pixels of a shadow map lie elsewhere when its picture grows: edges of shadows move by a pixel
            let allowed = if name == "shadow map" { 90 } else { 0 };
            assert!(revealed <= allowed, "{name}: {revealed} of {} revealed", count_true(&before));
            if matches!(viewer, Viewer::Direction(_)) {
                assert!(count_true(&after) > count_true(&before), "{name}");
            }
        }
    }
}
