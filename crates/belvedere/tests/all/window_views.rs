//! The view from windows against closed forms and the exact rays of simulated towns.

use crate::common::simulated::cloud_of;
use crate::mountains::grid;
use belvedere::apps::targets::TARGET_LIFT;
use belvedere::apps::targets::{Targets, Window};
use belvedere::apps::window_views::{
    ClassMeanings, Kinds, Proving, SeenKind, VIEW_DIRECTIONS, WindowView, balls_seen, leave_out_level, view_directions,
    view_measures, window_views,
};
use belvedere::blocking::BlockRule;
use belvedere::control::Control;
use belvedere::horizon::HorizonProfile;
use belvedere::medial::MedialBalls;
use belvedere::model::{ModelParams, SceneModel};
use belvedere::query::{Ball, Blocker, BlockingTriangles, FarTerrain, MedialScene, UnprovenAs};
use belvedere::random::uniform;
use belvedere::vector::{cross, dot, unit};
use belvedere::{Error, Frame, Mesh};
use belvedere_scenes::{AirborneParams, Material, TownParams, TriangleScene, Truth, scan_airborne, town};
use std::f64::consts::{FRAC_PI_2, PI};

/// A ball so large that the ground that it is for windows at a few metres' height is level.
const RADIUS: f64 = 20_000.0;

fn balls(list: &[([f64; 3], f64)]) -> MedialBalls {
    let mut balls = MedialBalls::default();
    list.iter().for_each(|&(center, radius)| balls.push(0, center.map(|v| v as f32), radius as f32, 0));
    balls
}

fn level_ground() -> MedialScene {
    MedialScene::new(&balls(&[([0.0, 0.0, -RADIUS], RADIUS)]), &BlockRule::carved()).unwrap()
}

fn window(center: [f64; 3], azimuth: f64) -> Window {
    Window::new(center, azimuth, FRAC_PI_2, None)
}

fn views(scene: &MedialScene, windows: &[Window], kinds: Kinds<'_>, count: usize) -> Vec<WindowView> {
    let targets = Targets::of_windows(windows, Frame::default()).unwrap();
    window_views(scene, &targets, kinds, &view_directions(count).unwrap(), &Control::none()).unwrap()
}

/// By how much a share may err that is counted on `count` directions: two deviations of as many independent ones, of
/// which even ones err less.
fn sampling(share: f64, count: usize) -> f64 {
    2.0 * (share * (1.0 - share) / count as f64).sqrt()
}

#[test]
fn over_flat_ground_half_of_the_view_is_sky_and_half_ground() {
    let kinds = Kinds { balls: &[SeenKind::Ground], meshes: &[] };
    let height = 3.0;
    for azimuth in [0.0, 1.0, 2.5, PI] {
        let [view] = views(&level_ground(), &[window([0.0, 0.0, height], azimuth)], kinds, 10_000)[..] else {
            panic!()
        };
        // the half space holds half of the cap that the ball covers, whose edge lies √(2h/R) below level
        let missing = (2.0 * height / RADIUS).sqrt() / 2.0;
        assert!((view.shares[SeenKind::Sky as usize] - 0.5).abs() < sampling(0.5, 10_000), "{view:?}");
        assert!((view.cosine_shares[SeenKind::Sky as usize] - 0.5).abs() < sampling(0.5, 10_000), "{view:?}");
        let ground = view.shares[SeenKind::Ground as usize];
        assert!((view.shares.iter().sum::<f64>() - 1.0).abs() < 1e-12 && ground < 0.5, "{view:?}");
        assert!((0.5 - ground - missing).abs() < sampling(missing, 10_000), "{ground} {missing}");
        // the sine of the depression is even over solid angles, so that half of the ground is nearer than 2 h
        assert!((view.median_range / (2.0 * height) - 1.0).abs() < 0.03, "{view:?}");
        assert_eq!(view.unproven, 0.0);
    }
}

/// A wall that looks to the south at the distance `y`, endless for a window before it, from far below up to `top`.
fn endless_wall(y: f64, top: f64) -> BlockingTriangles {
    let far = 50_000.0;
    let mesh = Mesh {
        vertices: vec![[-far, y, -far], [far, y, -far], [far, y, top], [-far, y, top]],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    };
    BlockingTriangles::new(&mesh, "wall", [0.0; 3], None, None).unwrap()
}

#[test]
fn a_window_before_an_endless_wall_sees_what_the_closed_form_leaves() {
    let count = 20_000;
    for (distance, height, top) in [(10.0, 4.0, 15.0), (30.0, 2.0, 12.0), (5.0, 8.0, 9.0), (12.0, 9.0, 6.0)] {
        let scene = level_ground().with_triangles(Some(endless_wall(distance + TARGET_LIFT, top)));
        let kinds = Kinds { balls: &[SeenKind::Ground], meshes: &[SeenKind::Building] };
        let [view] = views(&scene, &[window([0.0, 0.0, height], 0.0)], kinds, count)[..] else { panic!() };
        // planes through the window that are level along the wall cut the half space in wedges, each with the share of
        // its angle in half a turn
        let up = ((top - height) / distance).atan();
        let down = (height / distance).atan();
        let cut = up.min(0.0);
        let expected = [
            (SeenKind::Sky, 0.5 - up.max(0.0) / PI, (1.0 - up.max(0.0).sin()) / 2.0),
            (SeenKind::Building, (up + down) / PI, (up.sin() + down.sin()) / 2.0),
            // over a wall that is lower than the window the ground behind it is seen
            (SeenKind::Ground, 0.5 - down / PI - cut / PI, (1.0 - down.sin() - cut.sin()) / 2.0),
        ];
        for (seen, share, cosine_share) in expected {
            let found = view.shares[seen as usize]
                + if seen == SeenKind::Ground { view.shares[SeenKind::Beyond as usize] } else { 0.0 };
            assert!((found - share).abs() < sampling(share, count), "{seen:?} {found} {share} of {view:?}");
            let found = view.cosine_shares[seen as usize]
                + if seen == SeenKind::Ground { view.cosine_shares[SeenKind::Beyond as usize] } else { 0.0 };
            // a direction counts by its cosine, twice the mean of it at most
            assert!(
                (found - cosine_share).abs() < 2.0 * sampling(cosine_share, count),
                "{seen:?} {found} {cosine_share}"
            );
        }
        assert!((view.shares.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        assert!((view.cosine_shares.iter().sum::<f64>() - 1.0).abs() < 1e-12);
    }
}

#[test]
fn what_is_seen_from_a_surface_is_what_the_matrix_has_as_blocked_and_what_is_entered_first() {
    let at = |i: u64| 40.0 * uniform(21, i) - 20.0;
    let list: Vec<([f64; 3], f64)> =
        (0..200).map(|i| ([at(4 * i), at(4 * i + 1), at(4 * i + 2)], 0.3 + 2.0 * uniform(22, i))).collect();
    let balls = balls(&list);
    for rule in [BlockRule::carved(), BlockRule::uncarved(), BlockRule { bias: -0.5, ..BlockRule::carved() }] {
        let scene = MedialScene::new(&balls, &rule).unwrap();
        let directions = view_directions(300).unwrap();
        // every other place lies on a ball
        let place = |i: u64| -> [f64; 3] {
            let (center, radius) = list[i as usize];
            let outward = unit([at(1000 + 3 * i), at(1001 + 3 * i), at(1002 + 3 * i)]).unwrap();
            let lift = if i.is_multiple_of(2) { 0.05 } else { 3.0 };
            std::array::from_fn(|axis| f64::from((center[axis] + (radius + lift) * outward[axis]) as f32))
        };
        let places: Vec<[f64; 3]> = (0..40).map(place).collect();
        let targets: Vec<[f32; 3]> = places.iter().map(|place| place.map(|v| v as f32)).collect();
        let matrix = scene.visibility_matrix(&targets, &directions, &Control::none()).unwrap();
        let mut blocked = 0;
        for (row, &place) in places.iter().enumerate() {
            for (column, &direction) in directions.iter().enumerate() {
                let found = scene.seen_from_surface(place, direction);
                assert_eq!(found.is_none(), matrix.is_free(row, column), "{place:?} {direction:?}");
                let Some((Blocker::Ball(first), range)) = found else { continue };
                blocked += 1;
                // of all balls that block alone, none is entered earlier
                let entered = |ball: usize| {
                    let (center, radius) = (balls.centers[ball].map(f64::from), f64::from(balls.radii[ball]));
                    let ball = Ball { center: balls.centers[ball], radius: balls.radii[ball] };
                    rule.blocks_line(ball, place, direction, f64::INFINITY)?;
                    let to_center: [f64; 3] = std::array::from_fn(|axis| center[axis] - place[axis]);
                    let radius = rule.radius_for(radius, dot(to_center, to_center).sqrt());
                    let along = dot(to_center, direction);
                    let half = (radius * radius - (dot(to_center, to_center) - along * along)).max(0.0).sqrt();
                    Some((along - half).max(0.0))
                };
                let min = (0..list.len()).filter_map(entered).fold(f64::INFINITY, f64::min);
                // the entry is found as a difference of numbers of a few tens of metres
                assert!((range - min).abs() < 1e-6, "{range} {min}");
                assert!((entered(first).unwrap() - range).abs() < 1e-6);
            }
        }
        assert!(blocked > 1000, "{blocked}");
    }
}

/// Returns the kind of a material for people at a window.
fn kind(material: Material) -> SeenKind {
    match material {
        Material::Terrain => SeenKind::Ground,
        Material::Roof | Material::Facade | Material::Slab => SeenKind::Building,
        Material::TreeCrown | Material::Trunk | Material::Leaf => SeenKind::Vegetation,
        _ => SeenKind::Other,
    }
}

/// Windows on facades of a town, none of them inside anything or so near to it that it is covered, with their centres
/// in the file.
fn facade_windows(exact: &TriangleScene, truth: &Truth, origin: [f64; 3], count: usize) -> Vec<Window> {
    let facades: Vec<usize> =
        (0..exact.triangles.len()).filter(|&row| exact.materials[row] == Material::Facade).collect();
    let mut windows = Vec::new();
    for draw in 0..20 * count as u64 {
        let random = |k: u64| uniform(31, 4 * draw + k);
        let [a, b, c] = exact.corners(facades[(random(0) * facades.len() as f64) as usize]).unwrap();
        let edge = |p: [f64; 3], q: [f64; 3]| -> [f64; 3] { std::array::from_fn(|i| q[i] - p[i]) };
        let (ab, ac) = (edge(a, b), edge(a, c));
        let Some(normal) = unit(cross(ab, ac)) else { continue };
        // evenly over the triangle
        let (root, part) = (random(1).sqrt(), random(2));
        let place: [f64; 3] = std::array::from_fn(|i| a[i] + root * (1.0 - part) * ab[i] + root * part * ac[i]);
        let before: [f64; 3] = std::array::from_fn(|i| place[i] + 0.01 * normal[i]);
        let is_open = truth.first_hit(before, normal, 3.0).is_none();
        let is_above = truth.first_hit(before, [0.0, 0.0, -1.0], 50.0).is_some_and(|hit| hit.range > 1.5);
        if normal[2].abs() < 0.01 && is_open && is_above {
            let local: [f64; 3] = std::array::from_fn(|i| place[i] - origin[i]);
            windows.push(window(local, normal[0].atan2(normal[1])));
        }
        if windows.len() == count {
            break;
        }
    }
    windows
}

/// The view of exact rays in `directions` from the place at which a window is tested, with the mean range of things.
fn exact_view(
    exact: &TriangleScene,
    truth: &Truth,
    window: &Window,
    origin: [f64; 3],
    directions: &[[f64; 3]],
) -> ([f64; 7], f64) {
    let (places, normal) = window.places().unwrap();
    let (mut counts, mut ranges, mut things) = ([0.0; 7], 0.0, 0.0);
    let place: [f64; 3] = std::array::from_fn(|i| f64::from(places[0][i] as f32) + origin[i]);
    let normal = normal.map(|v| f64::from(v as f32));
    for &direction in directions.iter().filter(|direction| dot(normal, **direction) > 0.0) {
        let seen = match truth.first_hit(place, direction, f64::INFINITY) {
            Some(hit) => {
                ranges += hit.range;
                things += 1.0;
                kind(exact.materials[hit.triangle as usize])
            }
            None if direction[2] >= 0.0 => SeenKind::Sky,
            None => SeenKind::Beyond,
        };
        counts[seen as usize] += 1.0;
    }
    let whole: f64 = counts.iter().sum();
    (counts.map(|count| count / whole), ranges / things)
}

#[test]
fn in_an_exact_town_shares_are_those_of_exact_rays_and_of_any_number_of_threads() {
    let exact = town(&TownParams { extent: 100.0, street_furniture: 1.0, ..TownParams::default() });
    let truth = Truth::new(&exact);
    let origin = [154_990.0, 463_010.0, 2.0];
    let mut added: Option<BlockingTriangles> = None;
    let kinds = [SeenKind::Ground, SeenKind::Building, SeenKind::Vegetation, SeenKind::Other];
    for seen in kinds {
        let rows = (0..exact.triangles.len()).filter(|&row| kind(exact.materials[row]) == seen);
        let triangles = rows.map(|row| exact.triangles[row]).collect();
        let mesh = Mesh { vertices: exact.vertices.clone(), triangles, ..Mesh::default() };
        added = Some(BlockingTriangles::new(&mesh, seen.name(), origin, None, added.as_ref()).unwrap());
    }
    let scene = MedialScene::new(&MedialBalls::default(), &BlockRule::carved()).unwrap().with_triangles(added);
    let windows = facade_windows(&exact, &truth, origin, 24);
    assert!(windows.len() >= 20, "{}", windows.len());
    let all = Kinds { balls: &[], meshes: &kinds };
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| views(&scene, &windows, all, VIEW_DIRECTIONS))
    };
    let found = run(2);
    let bits = |views: &[WindowView]| -> Vec<u64> {
        let of = |view: &WindowView| {
            let WindowView { shares, cosine_shares, mean_range, median_range, unproven } = *view;
            [&shares[..], &cosine_shares[..], &[mean_range, median_range, unproven][..]].concat()
        };
        views.iter().flat_map(of).map(f64::to_bits).collect()
    };
    assert_eq!(bits(&found), bits(&run(1)));

    let same = view_directions(VIEW_DIRECTIONS).unwrap();
    // other directions of a sphere, independent of each other
    let drawn = |i: u64| {
        let (azimuth, up) = (2.0 * PI * uniform(41, 2 * i), 2.0 * uniform(41, 2 * i + 1) - 1.0);
        let level = (1.0 - up * up).sqrt();
        [level * azimuth.sin(), level * azimuth.cos(), up]
    };
    let other: Vec<[f64; 3]> = (0..8000).map(drawn).collect();
    let mut kinds_met = [0; 7];
    for (window, view) in windows.iter().zip(&found) {
        let (expected, mean) = exact_view(&exact, &truth, window, origin, &same);
        // in the same directions the same is met, but for lines that pass an edge within a micrometre
        let differing: f64 = expected.iter().zip(view.shares).map(|(a, b)| (a - b).abs()).sum::<f64>() / 2.0;
        assert!(differing * VIEW_DIRECTIONS as f64 <= 1.5, "{expected:?} {view:?}");
        assert!((mean - view.mean_range).abs() < 0.2, "{mean} {view:?}");
        let (expected, _) = exact_view(&exact, &truth, window, origin, &other);
        for seen in SeenKind::ALL {
            let (a, b) = (expected[seen as usize], view.shares[seen as usize]);
            // two samples of the same share, about 4000 and 1000 directions: four deviations of their difference, and
            // one direction
            let share = f64::midpoint(a, b);
            let deviation = (share * (1.0 - share) * (1.0 / 4000.0 + 1.0 / VIEW_DIRECTIONS as f64)).sqrt();
            assert!((a - b).abs() < 4.0 * deviation + 1.0 / VIEW_DIRECTIONS as f64, "{seen:?} {a} {b}");
            kinds_met[seen as usize] += usize::from(b > 0.02);
        }
    }
    assert!(
        [SeenKind::Sky, SeenKind::Vegetation, SeenKind::Building, SeenKind::Ground]
            .iter()
            .all(|&s| kinds_met[s as usize] > 5),
        "{kinds_met:?}"
    );
}

#[test]
fn in_a_scanned_town_views_are_near_those_of_exact_rays() {
    let exact = town(&TownParams { extent: 80.0, ..TownParams::default() });
    let truth = Truth::new(&exact);
    let cloud = cloud_of(&scan_airborne(&exact, &AirborneParams { pulses_per_m2: 8.0, ..AirborneParams::default() }));
    let none = Control::none();
    let (model, _) = SceneModel::build(&cloud, &ModelParams::default(), &none).unwrap();
    let scene = model.scene(&model.rule(), UnprovenAs::Reported, &none).unwrap();
    let windows = facade_windows(&exact, &truth, cloud.frame.origin, 60);
    let classes = cloud.attributes.classification.as_deref();
    let kinds = balls_seen(model.balls(), classes, model.vegetation(), &ClassMeanings::default()).unwrap();
    let targets = Targets::of_windows(&windows, cloud.frame.clone()).unwrap();
    let directions = view_directions(500).unwrap();
    let all = Kinds { balls: &kinds, meshes: &[] };
    let found = window_views(&scene, &targets, all, &directions, &none).unwrap();
    let mut errors = [0.0; 7];
    for (window, view) in windows.iter().zip(&found) {
        let (expected, _) = exact_view(&exact, &truth, window, cloud.frame.origin, &directions);
        errors.iter_mut().zip(expected).zip(view.shares).for_each(|((sum, a), b)| *sum += (a - b).abs());
        // a scan from the air proves much of a view, and never all of it
        assert!(view.unproven < 1.0);
    }
    let errors = errors.map(|sum| 100.0 * sum / windows.len() as f64);
    assert!(found.iter().any(|view| view.unproven > 0.01) && windows.len() >= 40);
    // measured: 1.0 for sky, 0.8 for vegetation, 1.7 for buildings, 1.2 for ground, 0.4 for what is beyond; a half more
    // is a change for the worse
    assert!(errors.iter().all(|error| *error < 2.5), "{errors:?}");
    // the same without pulses has the same view, of which nothing is unproven
    let unasked = model.scene(&model.rule(), UnprovenAs::Visible, &none).unwrap();
    let again = window_views(&unasked, &targets, all, &directions, &none).unwrap();
    assert!(again.iter().zip(&found).all(|(a, b)| a.shares == b.shares && a.unproven == 0.0));
}

#[test]
fn far_terrain_is_ground_and_no_sky() {
    let count = 20_000;
    let seen = |far: FarTerrain, place: [f64; 3]| {
        let scene = MedialScene::new(&MedialBalls::default(), &BlockRule::carved()).unwrap().with_far_terrain(far);
        let kinds = Kinds { balls: &[], meshes: &[] };
        let [view] = views(&scene, &[window(place, 1.0)], kinds, count)[..] else { panic!() };
        assert!(view.mean_range.is_nan() && view.median_range.is_nan());
        assert!((view.shares.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        [SeenKind::Sky, SeenKind::Ground, SeenKind::Beyond].map(|kind| view.shares[kind as usize])
    };
    let close = |shares: [f64; 3], expected: [f64; 3]| {
        let errors =
            shares.iter().zip(expected).map(|(share, expected)| (share - expected).abs() - sampling(expected, count));
        assert!(errors.fold(f64::NEG_INFINITY, f64::max) < 1e-12, "{shares:?} {expected:?}");
    };
    // 10° high all around, for all places, and nothing is free below it
    let horizon = HorizonProfile::new([[0.0, 10f64.to_radians()]]).unwrap();
    let sky = (1.0 - 10f64.to_radians().sin()) / 2.0;
    close(seen(FarTerrain::default().with_profile(horizon), [0.0; 3]), [sky, 1.0 - sky, 0.0]);
    // a wall 1 km away all around a plain, which all lines that fall meet: the half space is as even in the sine of the
    // elevation as the sphere
    let plain = |x: f64, y: f64| if (x - 2000.0).hypot(y + 2000.0) < 1000.0 { 0.0 } else { 120.0 };
    let wall = FarTerrain::default().with_grid(grid(401, 10.0, plain), None);
    let sky = (1.0 - (118.3f64 / 1000.0).atan().sin()) / 2.0;
    close(seen(wall, [2000.0, -2000.0, 1.7]), [sky, 1.0 - sky, 0.0]);
    // with neither all below the horizon is beyond
    close(seen(FarTerrain::default(), [2000.0, -2000.0, 1.7]), [0.5, 0.0, 0.5]);
}

#[test]
fn windows_that_are_no_targets_have_no_view_and_wrong_input_is_refused() {
    let scene = level_ground();
    let kinds = Kinds { balls: &[SeenKind::Ground], meshes: &[] };
    let mut targets =
        Targets::of_windows(&[window([0.0, 0.0, 3.0], 0.0), window([5.0, 0.0, 3.0], 1.0)], Frame::default()).unwrap();
    targets.positions[0] = [f32::NAN; 3];
    let directions = view_directions(100).unwrap();
    let found = window_views(&scene, &targets, kinds, &directions, &Control::none()).unwrap();
    assert!(found[0].shares.iter().all(|share| share.is_nan()) && found[0].unproven.is_nan());
    let measures = view_measures(&found, Proving::NotTested);
    assert!(measures.iter().all(|m| m.values[0].is_nan() && m.name.len() <= 15 && m.description.len() <= 31));
    assert!((measures[..7].iter().map(|m| m.values[1]).sum::<f32>() - 100.0).abs() < 1e-4);
    assert_eq!(view_measures(&found, Proving::Tested).len(), measures.len() + 1);
    let run = |targets: &Targets, kinds| window_views(&scene, targets, kinds, &directions, &Control::none());
    let few = run(&targets, Kinds { balls: &[], meshes: &[] });
    assert!(matches!(few, Err(Error::LengthMismatch { expected: 1, found: 0, .. })), "{few:?}");
    let level = Targets { normals: None, ..targets.clone() };
    assert!(matches!(run(&level, kinds), Err(Error::UnsupportedTargets { .. })));
    let short = Targets { normals: Some(Vec::new()), ..targets.clone() };
    assert!(matches!(run(&short, kinds), Err(Error::LengthMismatch { .. })));
    assert!(view_directions(0).is_err());
    // a roof is left out, the window that is left out already is not counted among walls
    targets.normals.as_mut().unwrap()[1] = [0.0, 0.6, 0.8];
    assert_eq!((leave_out_level(&mut targets), targets.target_count()), (1, 0));
}
