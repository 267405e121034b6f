//! Landmarks against the geometry of a wall.

use belvedere::apps::landmark::{
    LandmarkParams, LandmarkPoints, LandmarkView, landmark_points, landmark_view, landmark_views, observer_cell_for,
    spacing_for,
};
use belvedere::control::Control;
use belvedere::medial::MedialBalls;
use belvedere::query::{BackFaces, BlockRule, MedialScene, MeshTargetParams, SurfacePieces};
use belvedere::{Attributes, Mesh, PointCloud};
use std::f64::consts::TAU;

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

/// A wall of 10 m by 10 m in the plane y = 0 about the origin that faces south.
fn wall(spacing: f64) -> SurfacePieces {
    let mesh = Mesh {
        vertices: vec![[-5.0, 0.0, -5.0], [5.0, 0.0, -5.0], [5.0, 0.0, 5.0], [-5.0, 0.0, 5.0]],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    };
    SurfacePieces::of_mesh(&mesh, [0.0; 3], spacing, 3).unwrap()
}

fn near(found: f64, expected: f64, share: f64) {
    assert!((found - expected).abs() <= share * expected.abs(), "{found}, expected {expected}");
}

#[test]
fn a_wall_in_the_open_has_the_solid_angle_and_extents_of_a_rectangle() {
    for distance in [3.0, 50.0] {
        let view = landmark_view(&scene(&[]), &wall(0.5), [0.0, -distance, 0.0], &LandmarkParams::default());
        // corners are f32: 1e-7 of their size
        near(view.visible_share(), 1.0, 1e-9);
        near(view.visible_area, 100.0, 1e-5);
        let solid_angle = 4.0 * (100.0 / (2.0 * distance * (4.0 * distance * distance + 200.0).sqrt())).atan();
        near(view.solid_angle, solid_angle, 1e-5);
        let extent = 2.0 * (5.0 / distance).atan();
        near(view.horizontal_extent, extent, 1e-5);
        near(view.horizon_share, extent / TAU, 1e-5);
        // highest above the middle; corners of pieces lie up to half a piece beside it
        near(view.vertical_extent, extent, 5e-3);
        let [nearest, farthest] = view.ranges.unwrap();
        near(nearest, distance, 5e-3);
        near(farthest, (distance * distance + 50.0).sqrt(), 1e-6);
    }
}

#[test]
fn a_screen_that_hides_the_west_half_leaves_half_of_everything() {
    // a ball of 20 m beside the line of sight to the middle, which touches the plane x = 0 at 30 m
    let distance = 100.0;
    let screen = scene(&[([-20.0, -70.0, 0.0], 20.0)]);
    let eye = [0.0, -distance, 0.0];
    let view = landmark_view(&screen, &wall(0.25), eye, &LandmarkParams::default());
    // at the height h of the wall a line of sight passes 0.3 h above the ball's middle, where its outline has moved
    // back by (0.3 h)² / 40 m; thrown on the wall that is (h / 3.65)² / 10 m, 0.06 m on average
    assert!(view.visible_share() > 0.49 && view.visible_share() < 0.53, "{}", view.visible_share());
    near(view.solid_angle / view.visible_area, 1.0 / (distance * distance), 5e-3);
    near(view.horizontal_extent, (5.0 / distance).atan(), 0.12);
    // the other half of the wall is all there to see
    near(view.vertical_extent, 2.0 * (5.0 / distance).atan(), 5e-3);
}

#[test]
fn a_post_splits_the_wall_whose_extent_stays_while_its_azimuths_shrink() {
    let posts: Vec<([f32; 3], f32)> = (-40..=40).map(|i| ([0.0, -25.0, 0.25 * i as f32], 0.5)).collect();
    let view = landmark_view(&scene(&posts), &wall(0.1), [0.0, -50.0, 0.0], &LandmarkParams::default());
    let whole = 2.0 * 0.1f64.atan();
    near(view.horizontal_extent, whole, 1e-5);
    // a post of 0.5 m at 25 m hides 2 asin(0.02); both edges are found to a piece of 0.1 m, 2.5 % of what is left
    near(view.horizon_share * TAU, whole - 2.0 * 0.02f64.asin(), 0.0255);
    near(view.visible_area, 100.0 - 10.0 * 100.0 * 0.02f64.asin().tan(), 0.01);
}

#[test]
fn backs_count_as_requested_and_nothing_seen_is_all_zero() {
    let open = scene(&[]);
    let behind = [0.0, 30.0, 0.0];
    let with = |back_faces| {
        landmark_view(
            &open,
            &wall(0.5),
            behind,
            &LandmarkParams::default().with_faces(MeshTargetParams { back_faces, ..MeshTargetParams::default() }),
        )
    };
    let whole = with(BackFaces::NotVisible);
    assert_eq!(LandmarkView { area: 0.0, ..whole }, LandmarkView::default());
    near(whole.area, 100.0, 1e-5);
    assert_eq!(with(BackFaces::LeftOut), LandmarkView::default());
    near(with(BackFaces::BothSides).visible_share(), 1.0, 1e-9);
    let params = LandmarkParams::default().with_max_range(20.0);
    assert_eq!(landmark_view(&open, &wall(0.5), [0.0, -30.0, 0.0], &params).visible_area, 0.0);
}

#[test]
fn observers_are_answered_in_order_on_any_number_of_threads() {
    let balls: Vec<([f32; 3], f32)> =
        (0..20).map(|i| ([(i as f32 * 1.7) % 11.0 - 5.0, -10.0, (i as f32 * 2.3) % 9.0 - 4.0], 0.6)).collect();
    let (scene, wall) = (scene(&balls), wall(0.5));
    let eyes: Vec<[f64; 3]> =
        (0..200).map(|i| [f64::from(i) * 0.2 - 20.0, -40.0, 1.7]).chain([[f64::NAN; 3]]).collect();
    let params = LandmarkParams::default();
    let all = landmark_views(&scene, &wall, &eyes, &params, &Control::none()).unwrap();
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let alone = one.install(|| landmark_views(&scene, &wall, &eyes, &params, &Control::none())).unwrap();
    assert_eq!(all, alone);
    assert_eq!(all[200], LandmarkView::default());
    assert!(all[..200].iter().any(|view| view.visible_share() < 0.95));
    assert_eq!(all[7], landmark_view(&scene, &wall, eyes[7], &params));
    let wrong = params.with_max_range(0.0);
    assert!(landmark_views(&scene, &wall, &eyes, &wrong, &Control::none()).is_err());
    let nothing = SurfacePieces { pieces: Vec::new(), ..wall };
    assert!(landmark_views(&scene, &nothing, &eyes, &params, &Control::none()).is_err());
}

/// Level ground of class 2 with a block of 6 m by 6 m, 10 m high, of class 6 on it; a point every 0.25 m.
fn block() -> PointCloud {
    let mut points: Vec<([f64; 3], u8)> = Vec::new();
    let steps = |from: f64, to: f64| (0..).map(move |i| from + 0.25 * f64::from(i)).take_while(move |v| *v < to + 1e-9);
    for x in steps(-20.0, 20.0) {
        for y in steps(-20.0, 20.0) {
            let top = x.abs() <= 3.0 && y.abs() <= 3.0;
            points.push(([x, y, if top { 10.0 } else { 0.0 }], if top { 6 } else { 2 }));
        }
    }
    for along in steps(-3.0, 3.0) {
        for z in steps(0.25, 9.75) {
            for p in [[along, -3.0, z], [along, 3.0, z], [-3.0, along, z], [3.0, along, z]] {
                points.push((p, 6));
            }
        }
    }
    PointCloud {
        positions: points.iter().map(|(p, _)| p.map(|v| v as f32)).collect(),
        attributes: Attributes { classification: Some(points.iter().map(|p| p.1).collect()), ..Attributes::default() },
        ..PointCloud::default()
    }
}

#[test]
fn points_of_a_class_or_above_a_polygon_have_the_surface_they_lie_on() {
    let cloud = block();
    let (rows, of_class) = landmark_points(&cloud, &LandmarkPoints::Class(6)).unwrap();
    let ring = vec![[-4.0, -4.0], [4.0, -4.0], [4.0, 4.0], [-4.0, 4.0]];
    let (inside, of_polygon) = landmark_points(&cloud, &LandmarkPoints::Inside(&[vec![ring]])).unwrap();
    assert_eq!(rows, inside, "ground in the polygon is no landmark");
    assert_eq!(of_class.area(), of_polygon.area());
    // four walls of 60 m² and a roof of 36; disc areas of a grid's eighth neighbour lie within a quarter of its cells
    near(of_class.area(), 276.0, 0.25);
    let far = vec![[50.0, 50.0], [60.0, 50.0], [60.0, 60.0]];
    let error = landmark_points(&cloud, &LandmarkPoints::Inside(&[vec![far]])).unwrap_err().to_string();
    assert!(error.contains("polygon"), "{error}");
    assert!(landmark_points(&cloud, &LandmarkPoints::Class(9)).unwrap_err().to_string().contains("class 9"));
    let bare = PointCloud { attributes: Attributes::default(), ..cloud };
    assert!(landmark_points(&bare, &LandmarkPoints::Class(6)).is_err());
}

#[test]
fn default_spacings_and_cells_keep_work_in_bounds() {
    let pieces = wall(spacing_for(100.0)).pieces.len();
    assert!((500..2500).contains(&pieces), "{pieces}");
    assert_eq!(spacing_for(0.0), 0.25);
    assert_eq!(observer_cell_for([0.0; 2], [100.0; 2]), 2.0);
    let cell = observer_cell_for([0.0; 2], [10_000.0; 2]);
    assert!(1e8 / (cell * cell) <= 40_000.0);
}
