//! Faces of meshes: areas seen against closed forms.

use belvedere::control::Control;
use belvedere::medial::MedialBalls;
use belvedere::query::{
    Answer, BackFaces, BlockRule, MedialScene, MeshTargetParams, SeenArea, Sides, SurfacePieces, Viewer, Visibility,
    seen_faces, seen_in_all, seen_objects,
};
use belvedere::{Error, Mesh};
use std::f64::consts::PI;

fn scene(list: &[([f32; 3], f32)]) -> MedialScene {
    let balls = MedialBalls {
        centers: list.iter().map(|b| b.0).collect(),
        radii: list.iter().map(|b| b.1).collect(),
        source: vec![0; list.len()],
        touch: vec![0; list.len()],
        separation_angles: vec![1.0; list.len()],
    };
    MedialScene::new(&balls, &BlockRule::default()).unwrap()
}

/// A cube of 2 m about `middle`, two triangles to each side: east, west, north, south, up, down; each an object.
fn cube(middle: [f64; 3]) -> Mesh {
    let corner = |i: usize| std::array::from_fn(|axis| middle[axis] + if i >> axis & 1 == 1 { 1.0 } else { -1.0 });
    let sides = [[1, 3, 7, 5], [0, 4, 6, 2], [2, 6, 7, 3], [0, 1, 5, 4], [4, 5, 7, 6], [0, 2, 3, 1]];
    Mesh {
        vertices: (0..8).map(corner).collect(),
        triangles: sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect(),
        objects: (0..6).flat_map(|side| [side, side]).collect(),
        object_names: ["east", "west", "north", "south", "up", "down"].map(str::to_owned).to_vec(),
        ..Mesh::default()
    }
}

/// A wall of 10 m by 10 m in the plane y = 0 that faces south, with its lower left corner at the origin.
fn wall() -> Mesh {
    Mesh {
        vertices: vec![[0.0, 0.0, 0.0], [10.0, 0.0, 0.0], [10.0, 0.0, 10.0], [0.0, 0.0, 10.0]],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    }
}

/// Places exactly on their faces, as closed forms have them.
fn on_faces(back_faces: BackFaces) -> MeshTargetParams {
    MeshTargetParams { back_faces, lift: 0.0 }
}

fn seen(scene: &MedialScene, mesh: &Mesh, viewer: Viewer<'_>, spacing: f64, back: BackFaces) -> Vec<SeenArea> {
    let surface = SurfacePieces::of_mesh(mesh, [0.0; 3], spacing, 5).unwrap();
    seen_faces(&surface, viewer, &on_faces(back), |places| scene.visible(viewer, places)).unwrap()
}

#[test]
fn a_cube_in_the_open_shows_the_sides_that_face_the_viewer() {
    let (empty, mesh) = (scene(&[]), cube([100.0, 50.0, 3.0]));
    let shares = |viewer, back| {
        let faces = seen(&empty, &mesh, viewer, 0.3, back);
        let objects = seen_objects(&faces, &mesh.objects, 6);
        // areas are summed twice, in the order of f64
        objects.iter().map(|object| (1e9 * object.visible_share()).round() / 1e9).collect::<Vec<_>>()
    };
    // from the south-west and above; the sides to the east, north and below are turned away
    let eye = Viewer::Eye([80.0, 30.0, 20.0]);
    assert_eq!(shares(eye, BackFaces::NotVisible), [0.0, 1.0, 0.0, 1.0, 1.0, 0.0]);
    assert_eq!(shares(eye, BackFaces::BothSides), [1.0; 6]);
    let left_out = shares(eye, BackFaces::LeftOut);
    assert_eq!([left_out[1], left_out[3], left_out[4]], [1.0; 3]);
    assert!([0, 2, 5].iter().all(|&side| left_out[side].is_nan()));
    // level with the top its plane is seen edge-on, which is not seen
    assert_eq!(shares(Viewer::Eye([80.0, 30.0, 4.0]), BackFaces::NotVisible)[4], 0.0);
    assert_eq!(shares(Viewer::Direction([0.0, -1.0, 0.0]), BackFaces::NotVisible), [0.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
    let all = seen_in_all(&seen(&empty, &mesh, eye, 0.3, BackFaces::NotVisible));
    assert!((all.area - 24.0).abs() < 1e-4 && (all.visible - 12.0).abs() < 1e-4);
    assert_eq!(all.standard_error(), 0.0);
}

#[test]
fn the_shadow_of_a_ball_on_a_wall_is_its_disc_within_the_error_stated() {
    let ball = scene(&[([5.0, -20.0, 5.0], 2.0)]);
    let (mut outside, mut last) = (0, f64::INFINITY);
    for (spacing, max) in [(2.0, 3.0), (1.0, 1.2), (0.5, 0.4), (0.25, 0.15)] {
        let (mut sum, mut error) = (0.0, 0.0_f64);
        for seed in 0..10 {
            let surface = SurfacePieces::of_mesh(&wall(), [0.0; 3], spacing, seed).unwrap();
            let viewer = Viewer::Direction([0.0, -1.0, 0.0]);
            let ask = |places: &[[f32; 3]]| ball.visible(viewer, places);
            let all = seen_in_all(&seen_faces(&surface, viewer, &on_faces(BackFaces::NotVisible), ask).unwrap());
            assert!((all.area - 100.0).abs() < 1e-3);
            let off = (all.visible - (100.0 - PI * 4.0)).abs();
            outside += usize::from(off > 2.0 * all.standard_error());
            sum += off * off;
            error = error.max(all.standard_error());
        }
        let found = (sum / 10.0).sqrt();
        // the stated error shrinks faster than the spacing and is not overstated tenfold
        assert!(error < max && error > found / 3.0 && error < 10.0 * found, "{spacing}: {found} {error}");
        assert!(error < last);
        last = error;
    }
    // two standard errors hold 95 % and more: of 40 draws 2 are to be expected outside
    assert!(outside <= 4, "{outside}");
}

#[test]
fn a_near_ball_hides_its_central_projection_from_an_eye() {
    // the eye 20 m before the wall, a ball of 0.5 m half way: its cone cuts a disc of 20 · tan(asin(0.05)) m from the
    // wall
    let ball = scene(&[([5.0, -10.0, 5.0], 0.5)]);
    let faces = seen(&ball, &wall(), Viewer::Eye([5.0, -20.0, 5.0]), 0.1, BackFaces::NotVisible);
    let all = seen_in_all(&faces);
    let radius = 20.0 * (0.05f64).asin().tan();
    let expected = 100.0 - PI * radius * radius;
    assert!((all.visible - expected).abs() < 3.0 * all.standard_error(), "{} {expected}", all.visible);
    assert!(all.standard_error() < 0.05);
}

#[test]
fn targets_lie_before_their_faces_on_the_side_of_the_viewer() {
    let surface = SurfacePieces::of_mesh(&wall(), [0.0; 3], 1.0, 1).unwrap();
    for (south, expected) in [(-1.0, -0.25), (1.0, 0.25)] {
        let params = MeshTargetParams { back_faces: BackFaces::BothSides, lift: 0.25 };
        let ask = |places: &[[f32; 3]]| {
            assert!(!places.is_empty() && places.iter().all(|p| (p[1] - expected).abs() < 1e-6));
            Ok(vec![Answer::Visible; places.len()])
        };
        seen_faces(&surface, Viewer::Direction([0.0, south, 0.0]), &params, ask).unwrap();
        seen_faces(&surface, Viewer::Eye([3.0, 20.0 * south, 9.0]), &params, ask).unwrap();
    }
    let params = MeshTargetParams { lift: f64::NAN, ..MeshTargetParams::default() };
    let refused = seen_faces(&surface, Viewer::Direction([0.0, -1.0, 0.0]), &params, |_| Ok(Vec::new()));
    assert!(matches!(refused, Err(Error::InvalidParameter { .. })));
}

#[test]
fn every_face_gets_a_sample_however_small_and_a_single_one_has_the_greatest_error() {
    let faces = seen(&scene(&[]), &cube([0.0; 3]), Viewer::Eye([0.0, -9.0, 0.0]), 50.0, BackFaces::NotVisible);
    let south: Vec<&SeenArea> = faces.iter().filter(|face| face.visible > 0.0).collect();
    assert_eq!(south.len(), 2);
    assert!(south.iter().all(|face| (face.standard_error() - face.area / 2.0).abs() < 1e-12));
}

#[test]
fn unproven_and_outside_are_not_visible_and_wrong_viewers_are_refused() {
    let surface = SurfacePieces::of_mesh(&wall(), [0.0; 3], 1.0, 1).unwrap();
    let viewer = Viewer::Direction([0.0, -1.0, 0.0]);
    let with = |answer| {
        let ask = |places: &[[f32; 3]]| Ok(vec![answer; places.len()]);
        seen_in_all(&seen_faces(&surface, viewer, &on_faces(BackFaces::NotVisible), ask).unwrap())
    };
    let unproven = with(Answer::Unproven);
    assert!(unproven.visible == 0.0 && (unproven.unproven - 100.0).abs() < 1e-3);
    assert_eq!((with(Answer::OutsideView).visible, with(Answer::OutsideView).unproven), (0.0, 0.0));
    let ask = |_: &[[f32; 3]]| Ok(vec![Answer::Visible]);
    assert!(matches!(
        seen_faces(&surface, viewer, &on_faces(BackFaces::NotVisible), ask),
        Err(Error::LengthMismatch { .. })
    ));
    let eyes = [[0.0; 3]];
    let each = seen_faces(&surface, Viewer::Each(&eyes), &on_faces(BackFaces::NotVisible), ask);
    assert!(matches!(each, Err(Error::UnsupportedViewer { .. })));
    let nowhere = seen_faces(&surface, Viewer::Eye([f64::NAN; 3]), &on_faces(BackFaces::NotVisible), ask);
    assert!(matches!(nowhere, Err(Error::InvalidParameter { .. })));
}

#[test]
fn points_represent_the_surface_between_them() {
    // a wall of 8 m by 8 m with a point every 0.25 m, off the grid by up to a third of that
    let shift = |seed, i| 0.16 * (belvedere::random::uniform(seed, i) - 0.5);
    let points: Vec<[f32; 3]> = (0..1024)
        .map(|i| [0.25 * (i % 32) as f64 + shift(1, i), 0.0, 0.25 * (i / 32) as f64 + shift(2, i)].map(|v| v as f32))
        .collect();
    let surface = SurfacePieces::of_points(&points, &vec![[0.0, 1.0, 0.0]; 1024], 1.0, &Control::none()).unwrap();
    assert_eq!((surface.sides, surface.pieces.len()), (Sides::Both, 1024));
    // 1024 cells of 0.0625 m²; at the border neighbours lie farther, and those of a grid nearer than by chance
    assert!((surface.area() / 64.0 - 1.0).abs() < 0.2, "{}", surface.area());
    for piece in &surface.pieces {
        let [a, b, c] = piece.corners.map(|corner| corner.map(f64::from));
        let area = belvedere::vector::length(belvedere::vector::cross(
            belvedere::vector::sub(b, a),
            belvedere::vector::sub(c, a),
        )) / 2.0;
        assert!((area - f64::from(piece.area)).abs() < 1e-4 && a[1].abs() < 1e-6);
    }
    assert!(SurfacePieces::of_points(&points, &[], 1.0, &Control::none()).is_err());
    assert!(SurfacePieces::of_points(&points, &vec![[0.0; 3]; 1024], 0.0, &Control::none()).is_err());
    let alone = SurfacePieces::of_points(&[[1.0, 2.0, 3.0]], &[[0.0; 3]], 1.0, &Control::none()).unwrap();
    assert!((alone.area() - PI).abs() < 1e-6);
}
