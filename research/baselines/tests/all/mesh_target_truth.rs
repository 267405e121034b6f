//! What is seen of buildings: carved balls against the exact mesh of a simulated town.

use belvedere::Bounds;
use belvedere::Mesh;
use belvedere::query::{
    Answer, BackFaces, BlockRule, MedialScene, MeshTargetParams, SeenArea, SurfacePieces, Viewer, Visibility,
    seen_faces, seen_objects,
};
use belvedere::view::to_sun;
use belvedere_baselines::MethodInput;
use belvedere_baselines::medial::{MedialBaseline, MedialParams, Outward};
use belvedere_baselines::simulated::flown;
use belvedere_scenes::{AirborneParams, Material, Preset, QuerySite, TriangleScene, Truth, town};

/// Distance from its face at which the truth of a place is computed, metres: places are f32, to hundredths of a
/// millimetre here.
const OUTSIDE: f64 = 0.01;
/// Longest side of pieces, metres.
const SPACING: f64 = 1.0;

/// The faces of buildings of one material.
fn buildings(scene: &TriangleScene, material: Material) -> Mesh {
    let is_wanted = |&t: &usize| {
        scene.materials[t] == material && scene.object_names[scene.objects[t] as usize].starts_with("building")
    };
    let kept: Vec<usize> = (0..scene.triangles.len()).filter(is_wanted).collect();
    Mesh {
        vertices: scene.vertices.clone(),
        triangles: kept.iter().map(|&t| scene.triangles[t]).collect(),
        objects: kept.iter().map(|&t| scene.objects[t]).collect(),
        object_names: scene.object_names.clone(),
        ..Mesh::default()
    }
}

/// Areas, m², over all viewers, and errors of the shares of buildings.
#[derive(Clone, Copy, Debug, Default)]
struct MeshScore {
    truly_visible: f64,
    truly_blocked: f64,
    false_visible: f64,
    false_blocked: f64,
    square_error: f64,
    buildings: f64,
}

#[test]
fn shares_of_buildings_that_are_seen_are_those_of_the_mesh() {
    let scene = town(&Preset::Town.params(120.0, 11));
    let params = AirborneParams { seed: 11, ..AirborneParams::covering(&scene, 8.0) };
    let (cloud, scanner) = flown(&scene, &params).unwrap();
    let origin = cloud.frame.origin;
    let survey = MethodInput { cloud: &cloud, scanner: &scanner, models: &[] };
    let made = MedialBaseline::new(&survey, Outward::Survey, &MedialParams::carved()).unwrap();
    let truth = Truth::new(&scene);
    let Bounds { low, high } = cloud.bounds().unwrap();
    let absolute = |p: [f32; 3]| -> [f64; 3] { std::array::from_fn(|i| f64::from(p[i]) + origin[i]) };
    let site = QuerySite { scene: &scene, truth: &truth, bounds: [absolute(low), absolute(high)] };
    let mut viewers: Vec<(&str, Viewer<'_>)> = site
        .street_observers(12, 3)
        .into_iter()
        .map(|eye| ("street", Viewer::Eye(std::array::from_fn(|i| eye[i] - origin[i]))))
        .collect();
    assert!(viewers.len() >= 8, "{}", viewers.len());
    for (azimuth, elevation) in [(110.0f64, 20.0f64), (180.0, 65.0), (240.0, 35.0)] {
        viewers.push(("sun", Viewer::Direction(to_sun(azimuth.to_radians(), elevation.to_radians()))));
    }
    let balls = MedialScene::new(made.balls(), &BlockRule::carved()).unwrap();
    for (material, name) in [(Material::Facade, "facades"), (Material::Roof, "roofs")] {
        let mesh = buildings(&scene, material);
        let surface = SurfacePieces::of_mesh(&mesh, origin, SPACING, 1).unwrap();
        for kind in ["street", "sun"] {
            let mut score = MeshScore::default();
            for (_, viewer) in viewers.iter().filter(|(own, _)| *own == kind) {
                judge(&balls, &truth, &mesh, &surface, *viewer, origin, &mut score);
            }
            let false_visible = score.false_visible / score.truly_blocked;
            let false_blocked = score.false_blocked / score.truly_visible;
            let error = (score.square_error / score.buildings).sqrt();
            println!(
                "{name}, {kind}: {:.0} m² visible, {:.0} blocked, false-visible {false_visible:.4}, \
                     false-blocked {false_blocked:.4}, share of a building off by {error:.4} over {}",
                score.truly_visible, score.truly_blocked, score.buildings
            );
            let [max_visible, max_blocked, max_error] = bars(name, kind);
            assert!(false_visible < max_visible && false_blocked < max_blocked, "{name} {kind}");
            assert!(error < max_error, "{name} {kind}: {error}");
        }
    }
}

/// Greatest false-visible and false-blocked share and error of the share of a building: half as much again as was
/// measured.
fn bars(name: &str, kind: &str) -> [f64; 3] {
    match (name, kind) {
        ("facades", "street") => [0.046, 0.21, 0.11],
        ("facades", _) => [0.14, 0.14, 0.08],
        (_, "street") => [0.065, 0.076, 0.18],
        _ => [0.19, 0.015, 0.05],
    }
}

/// Adds what the balls make of the faces turned to `viewer`, against the rays of the mesh; shares are of buildings with
/// 10 m² turned to it.
fn judge(
    balls: &MedialScene,
    truth: &Truth,
    mesh: &Mesh,
    surface: &SurfacePieces,
    viewer: Viewer<'_>,
    origin: [f64; 3],
    score: &mut MeshScore,
) {
    let facing = belvedere::query::facing(surface, viewer).unwrap();
    let exact: Vec<Answer> = surface
        .pieces
        .iter()
        .zip(&facing)
        .filter(|(_, facing)| **facing)
        .map(|(piece, _)| {
            let normal = piece.normal.map(f64::from);
            let place: [f64; 3] = std::array::from_fn(|i| f64::from(piece.place[i]) + origin[i] + OUTSIDE * normal[i]);
            let blocked = match viewer {
                Viewer::Direction(direction) => truth.occluded_towards(place, direction),
                Viewer::Eye(eye) => truth.occluded(place, std::array::from_fn(|i| eye[i] + origin[i])),
                Viewer::Each(_) => true,
            };
            if blocked { Answer::Blocked } else { Answer::Visible }
        })
        .collect();
    let params = MeshTargetParams { back_faces: BackFaces::LeftOut, ..MeshTargetParams::default() };
    let shares = |ask: &dyn Fn(&[[f32; 3]]) -> Vec<Answer>| {
        let faces = seen_faces(surface, viewer, &params, |places| Ok(ask(places))).unwrap();
        seen_objects(&faces, &mesh.objects, mesh.object_names.len())
    };
    let answers = std::cell::RefCell::new(Vec::new());
    let found: Vec<SeenArea> = shares(&|places| {
        *answers.borrow_mut() = balls.visible(viewer, places).unwrap();
        answers.borrow().clone()
    });
    let expected = shares(&|_| exact.clone());
    for (found, expected) in found.iter().zip(&expected).filter(|(_, expected)| expected.area > 10.0) {
        score.square_error += (found.visible_share() - expected.visible_share()).powi(2);
        score.buildings += 1.0;
    }
    let areas =
        surface.pieces.iter().zip(&facing).filter(|(_, facing)| **facing).map(|(piece, _)| f64::from(piece.area));
    for ((area, exact), answer) in areas.zip(&exact).zip(answers.borrow().iter()) {
        if *exact == Answer::Visible {
            score.truly_visible += area;
            score.false_blocked += if *answer == Answer::Blocked { area } else { 0.0 };
        } else {
            score.truly_blocked += area;
            score.false_visible += if *answer == Answer::Blocked { 0.0 } else { area };
        }
    }
}
