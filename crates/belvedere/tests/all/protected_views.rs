//! Protected views against closed forms and against the lines of sight that they keep free.

use belvedere::apps::landmark::LandmarkParams;
use belvedere::apps::protected_view::{ProtectedView, protected_view};
use belvedere::blocking::BlockRule;
use belvedere::control::Control;
use belvedere::ground::{Ground, MapGrid};
use belvedere::medial::MedialBalls;
use belvedere::query::{Answer, BlockingTriangles, EarthParams, MedialScene, SurfacePieces, Viewer};
use belvedere::random::uniform;
use belvedere::raster::Raster;
use belvedere::{Error, Mesh};
use belvedere_scenes::{PlanPlacement, TriangleScene, extruded};

fn nothing() -> MedialScene {
    MedialScene::new(&MedialBalls::default(), &BlockRule::carved()).unwrap()
}

/// A wall of the given heights at y = 100 that looks to the south, 40 m wide.
fn wall(low: f64, high: f64) -> SurfacePieces {
    let mesh = Mesh {
        vertices: vec![[-20.0, 100.0, low], [20.0, 100.0, low], [20.0, 100.0, high], [-20.0, 100.0, high]],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    };
    SurfacePieces::of_mesh(&mesh, [0.0; 3], 2.0, 1).unwrap()
}

/// Cells of a metre, whose corners lie on whole metres.
fn grid() -> MapGrid {
    MapGrid { corner: [-40.0, 120.0], cell: 1.0, width: 80, height: 130 }
}

fn run(scene: &MedialScene, object: &SurfacePieces, eyes: &[[f64; 3]], grid: &MapGrid) -> ProtectedView {
    protected_view(scene, object, eyes, grid, &LandmarkParams::default(), &Control::none()).unwrap()
}

/// Each cell with its middle and limit.
fn cells(found: &ProtectedView, grid: &MapGrid) -> Vec<([f64; 2], f32)> {
    let of = |row: usize| (row % grid.width, row / grid.width);
    (0..grid.len())
        .map(of)
        .map(|(column, row)| (grid.center(column, row), found.limits.get(column, row).unwrap()))
        .collect()
}

#[test]
fn the_limit_below_a_level_edge_is_the_plane_through_eye_and_edge() {
    let (eye, grid) = ([0.0, 0.0, 2.0], grid());
    let found = run(&nothing(), &wall(30.0, 40.0), &[eye], &grid);
    let (mut inside, mut outside) = (0, 0);
    for ([x, y], limit) in cells(&found, &grid) {
        // in the fan from the eye to the ends of the wall, with and without the half metre to the sides of a cell
        let reach = |room: f64| x.abs() + room < 20.0 * (y - room) / 100.0;
        if y > 0.5 && y < 99.0 && reach(0.5) {
            inside += 1;
            // lowest at the southern side of the cell; corners of pieces are f32, of 8 µm there
            let plane = 2.0 + 28.0 * (y - 0.5) / 100.0;
            assert!((f64::from(limit) - plane).abs() < 1e-4, "{x} {y}: {limit} {plane}");
        } else if !(-1.0..=101.0).contains(&y) || !reach(-0.6) {
            // a cell that only touches the fan at a corner has the limit there
            outside += 1;
            assert!(limit.is_nan(), "{x} {y}: {limit}");
        }
    }
    assert!(inside > 1500 && outside > 5000, "{inside} {outside}");
    let pieces = wall(30.0, 40.0).pieces.len();
    assert_eq!((found.viewpoints[0].lines_protected, found.viewpoints[0].lines_blocked), (pieces, 0));
    // an edge below the eye: lowest at the northern side
    let found = run(&nothing(), &wall(10.0, 40.0), &[[0.0, 0.0, 25.0]], &grid);
    for ([x, y], limit) in
        cells(&found, &grid).into_iter().filter(|([x, y], _)| *y > 4.0 && *y < 99.0 && x.abs() < 0.1 * y)
    {
        let plane = 25.0 - 15.0 * (y + 0.5) / 100.0;
        assert!((f64::from(limit) - plane).abs() < 1e-4, "{x} {y}: {limit} {plane}");
    }
}

#[test]
fn several_viewpoints_have_the_lowest_of_their_limits_in_any_order_and_on_any_threads() {
    let (grid, object) = (grid(), wall(20.0, 30.0));
    let eyes = [[-15.0, 0.0, 2.0], [10.0, 20.0, 6.0], [3.0, 50.0, 1.0], [f64::NAN; 3]];
    let all = run(&nothing(), &object, &eyes, &grid);
    let single: Vec<ProtectedView> = eyes.iter().map(|&eye| run(&nothing(), &object, &[eye], &grid)).collect();
    for (row, &limit) in all.limits.values().iter().enumerate() {
        let min = single.iter().map(|one| one.limits.values()[row]).fold(f32::NAN, f32::min);
        assert!(limit == min || limit.is_nan() && min.is_nan());
    }
    assert_eq!(all.viewpoints[3].lines_not_tested, object.pieces.len());
    let mut turned = eyes;
    turned.reverse();
    let bits = |found: &ProtectedView| -> Vec<u32> { found.limits.values().iter().map(|v| v.to_bits()).collect() };
    assert_eq!(bits(&all), bits(&run(&nothing(), &object, &turned, &grid)));
    for threads in [1, 2] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        assert_eq!(bits(&all), bits(&pool.install(|| run(&nothing(), &object, &eyes, &grid))));
    }
}

/// Upright boxes with middle, size and top, from far below the ground up.
fn boxes(list: &[([f64; 2], f64, f64)]) -> BlockingTriangles {
    let mut scene = TriangleScene::default();
    for &(origin, size, top) in list {
        let place = PlanPlacement { origin, angle: 0.0 };
        scene.add_object("box", &[extruded(&place.rectangle(size, size), -50.0, top)]);
    }
    let mesh = Mesh { vertices: scene.vertices, triangles: scene.triangles, ..Mesh::default() };
    BlockingTriangles::new(&mesh, "boxes", [0.0; 3], None, None).unwrap()
}

#[test]
fn what_is_hidden_today_is_not_protected() {
    let (eye, grid, object) = ([0.0, 0.0, 2.0], grid(), wall(30.0, 40.0));
    // hides the western half
    let scene = nothing().with_triangles(Some(boxes(&[([-10.0, 45.0], 20.0, 90.0)])));
    let found = run(&scene, &object, &[eye], &grid);
    let free = run(&nothing(), &object, &[eye], &grid);
    let report = found.viewpoints[0];
    assert!(
        report.lines_blocked > 200 && report.lines_blocked + report.lines_protected == object.pieces.len(),
        "{report:?}"
    );
    for (([x, y], limit), (_, whole)) in cells(&found, &grid).into_iter().zip(cells(&free, &grid)) {
        // pieces of up to 2 m at the seam are hidden or seen as a whole
        match x {
            x if x < -2.5 => assert!(limit.is_nan(), "{x} {y}: {limit}"),
            x if x > 2.5 => assert!(limit == whole || limit.is_nan() && whole.is_nan(), "{x} {y}: {limit} {whole}"),
            _ => {}
        }
    }
    // nearer than the wall nothing is protected, and the wall is not seen from behind
    let near = LandmarkParams::default().with_max_range(90.0);
    let found = protected_view(&nothing(), &object, &[eye], &grid, &near, &Control::none()).unwrap();
    assert!(found.limits.values().iter().all(|limit| limit.is_nan()));
    let behind = run(&nothing(), &object, &[[0.0, 110.0, 2.0]], &grid);
    assert_eq!(behind.viewpoints[0].lines_not_tested, object.pieces.len());
}

#[test]
fn building_up_to_the_limit_everywhere_hides_nothing_and_half_a_metre_more_does() {
    let grid = MapGrid { corner: [-20.0, 40.0], cell: 2.0, width: 20, height: 20 };
    let random = |i: u64, low: f64, high: f64| low + (high - low) * uniform(51, i);
    let mut mesh = Mesh::default();
    for i in 0..12_u32 {
        for corner in 0..3_u64 {
            let at = |axis: u64| 20 * u64::from(i) + 3 * corner + axis;
            mesh.vertices.push([random(at(0), -15.0, 15.0), random(at(1), 30.0, 39.0), random(at(2), 6.0, 20.0)]);
        }
        mesh.triangles.push([3 * i, 3 * i + 1, 3 * i + 2]);
    }
    let object = SurfacePieces::of_mesh(&mesh, [0.0; 3], 1.0, 3).unwrap();
    let eyes: Vec<[f64; 3]> =
        (0..5).map(|i| [random(900 + 3 * i, -18.0, 18.0), random(901 + 3 * i, 1.0, 6.0), 2.0 + i as f64]).collect();
    let found = run(&nothing(), &object, &eyes, &grid);
    let built = |more: f64| {
        // a box as wide as its cell; cells that hold an eye or the object stay as they are
        let limited =
            cells(&found, &grid).into_iter().filter(|([_, y], limit)| limit.is_finite() && (8.0..28.0).contains(y));
        boxes(&limited.map(|(place, limit)| (place, grid.cell, f64::from(limit) + more)).collect::<Vec<_>>())
    };
    // limits of rasters are f32: a micrometre, and one more for the sides of boxes
    let full = nothing().with_triangles(Some(built(-1e-5)));
    let more = nothing().with_triangles(Some(built(0.5)));
    let (mut kept, mut lost) = (0, 0);
    for &eye in &eyes {
        for piece in &object.pieces {
            if !piece.is_before(Viewer::Eye(eye)) {
                continue;
            }
            let place = piece.place.map(f64::from);
            let answer = |scene: &MedialScene| scene.sight_answer(eye, place, &EarthParams::flat());
            assert_eq!(answer(&full), Answer::Visible, "{eye:?} {place:?}");
            kept += 1;
            lost += usize::from(answer(&more) == Answer::Blocked);
        }
    }
    assert!(kept > 1000 && lost > 50, "{kept} {lost}");
}

#[test]
fn limits_above_the_ground_are_never_below_it_and_wrong_input_is_refused() {
    let grid = grid();
    let found = run(&nothing(), &wall(30.0, 40.0), &[[0.0, 0.0, 2.0]], &grid);
    let ground = |height: f32, grid: MapGrid| Ground {
        grid,
        heights: Raster::filled(grid.width, grid.height, height),
        gaps: Raster::filled(grid.width, grid.height, 0.0),
    };
    let above = found.above_ground(&ground(10.0, grid)).unwrap();
    for (room, limit) in above.values().iter().zip(found.limits.values()) {
        assert!(room.is_nan() && limit.is_nan() || *room == (limit - 10.0).max(0.0));
    }
    assert!(above.values().contains(&0.0) && above.values().iter().any(|room| *room > 5.0));
    let unknown = found.above_ground(&ground(f32::NAN, grid)).unwrap();
    assert!(unknown.values().iter().all(|room| room.is_nan()));
    let other = found.above_ground(&ground(1.0, MapGrid { width: 3, ..grid }));
    assert!(matches!(other, Err(Error::LengthMismatch { .. })));
    for range in [0.0, -1.0, f64::NAN] {
        let params = LandmarkParams::default().with_max_range(range);
        let refused = protected_view(&nothing(), &wall(1.0, 2.0), &[], &grid, &params, &Control::none());
        assert!(matches!(refused, Err(Error::InvalidParameter { .. })));
    }
}
