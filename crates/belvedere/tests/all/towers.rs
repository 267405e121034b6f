//! Visible metres of towers: against closed forms, and against exact rays to many heights of each tower.

use crate::far_viewsheds::{around, open_scene};
use crate::mountains::{grid, mountains};
use belvedere::Mesh;
use belvedere::apps::towers::{Tower, TowersParams, towers_seen};
use belvedere::apps::wireline::wireline;
use belvedere::control::Control;
use belvedere::medial::MedialBalls;
use belvedere::query::{Answer, BlockRule, BlockingTriangles, EarthParams, MedialScene, VerticalLine};
use belvedere::random::uniform;

/// Distance of exact rays along a tower, metres.
const STEP: f64 = 0.1;

fn line(foot: [f64; 3], height: f64) -> VerticalLine {
    VerticalLine { foot, height }
}

fn seen_metres(scene: &MedialScene, line: VerticalLine, eye: [f64; 3], earth: &EarthParams) -> f64 {
    scene.vertical_sight(line, earth).seen_from(eye).iter().map(|[from, to]| to - from).sum()
}

/// Returns the visible metres of a line by exact rays to steps of it, each metres long.
fn metres_by_rays(line: VerticalLine, step: f64, is_seen: impl Fn([f64; 3]) -> bool) -> f64 {
    let count = (line.height / step).ceil() as usize;
    let place = |i: usize| [line.foot[0], line.foot[1], line.foot[2] + (i as f64 + 0.5) * line.height / count as f64];
    (0..count).filter(|&i| is_seen(place(i))).count() as f64 * line.height / count as f64
}

#[test]
fn a_ball_hides_what_lies_between_its_tangents() {
    let (center, radius, eye) = ([20.0, 0.0, 6.0], 3.0, [0.0, 0.0, 1.0]);
    let mut balls = MedialBalls::default();
    balls.push(0, center.map(|v: f64| v as f32), radius as f32, 0);
    let scene = MedialScene::new(&balls, &BlockRule::default()).unwrap();
    let flat = EarthParams::flat();
    let distance = (20f64 * 20.0 + 25.0).sqrt();
    let (middle, half) = (5f64.atan2(20.0), (radius / distance).asin());
    for span in [100.0, 500.0, 40.0] {
        let hidden = span * ((middle + half).tan() - (middle - half).tan());
        let tower = line([span, 0.0, 1.0], 300.0);
        let seen = scene.vertical_sight(tower, &flat).seen_from(eye);
        assert_eq!(seen.len(), 2, "below and above the ball");
        assert!((seen[0][1] - span * (middle - half).tan()).abs() < 1e-6, "{seen:?}");
        assert!((seen_metres(&scene, tower, eye, &flat) - (300.0 - hidden)).abs() < 1e-6);
    }
    // before the ball nothing is hidden, and in its middle the chord above and below it
    assert_eq!(seen_metres(&scene, line([10.0, 0.0, 0.0], 50.0), eye, &flat), 50.0);
    let inside = scene.vertical_sight(line([20.0, 0.0, 0.0], 50.0), &flat).seen_from(eye);
    assert!((inside[1][0] - 9.0).abs() < 0.5, "{inside:?}");
    // beside the ball
    assert_eq!(seen_metres(&scene, line([100.0, 40.0, 0.0], 50.0), eye, &flat), 50.0);
}

#[test]
fn a_ridge_cuts_the_disc_of_a_rotor_in_a_wireline() {
    // a ridge of 60 m, 2 km north of an eye on a plain, and turbines 6 km away: it hides
    // what is lower than 185 m
    let eye = [50_000.0, -50_000.0, 2.0];
    let ridge = |_, y: f64| if (y + 48_000.0).abs() < 150.0 { 60.0 } else { 0.0 };
    let scene = open_scene(grid(1001, 100.0, ridge), around(eye, 300.0));
    let turbine = |aside: f64, hub: f64, tip: f64| {
        let foot = [eye[0] + aside, eye[1] + 6000.0, 0.0];
        Tower { line: line(foot, tip), hub: Some(hub), scheme: 0 }
    };
    // the southern edge of its flat top counts
    let cut = 2.0 + 58.0 * 6000.0 / 1900.0;
    let towers = [turbine(0.0, 150.0, 220.0), turbine(300.0, 90.0, 150.0), turbine(-5000.0, 250.0, 300.0)];
    let flat = EarthParams::flat();
    let found = wireline(&scene, &towers, eye, (&flat, 20_000.0), &Control::none()).unwrap();
    assert_eq!(found.towers.iter().map(|tower| tower.number).collect::<Vec<_>>(), [2, 0, 1]);
    let [far, middle, hidden] = &found.towers[..] else { panic!("{}", found.towers.len()) };
    assert!((middle.visible_metres - (220.0 - cut)).abs() < 1e-6, "{}", middle.visible_metres);
    // the segment of the disc above the line
    let (radius, up): (f64, f64) = (70.0, cut - 150.0);
    let segment = radius * radius * (up / radius).acos() - up * (radius * radius - up * up).sqrt();
    let share = segment / (std::f64::consts::PI * radius * radius);
    let rotor = middle.rotor.as_ref().unwrap();
    // lines in the middle of strips: an error of the square of their width
    assert!((rotor.visible_share - share).abs() < 0.002, "{} {share}", rotor.visible_share);
    assert!(hidden.visible.is_empty() && hidden.rotor.as_ref().unwrap().visible_share == 0.0);
    assert_eq!(far.rotor.as_ref().unwrap().visible_share, 1.0);
    // north-west and north: 43 degrees, which one frame holds
    assert_eq!(found.frames.len(), 1);
    let outer = [-5000.0, 300.0].map(|aside: f64| (aside / 6000.0).atan());
    let azimuth = found.frames[0].azimuth - std::f64::consts::TAU;
    assert!((azimuth - f64::midpoint(outer[0], outer[1])).abs() < 1e-9, "{azimuth}");
    // the ridge is the last piece of terrain in the column of the tower
    let [column, row] = found.frames[0].on_plane(0.0, (58f64 / 1900.0).atan()).unwrap();
    let pieces = &found.frames[0].terrain[(column + 800.0) as usize];
    let [_, top] = found.frames[0].on_plane(0.0, pieces.last().unwrap().elevations[1]).unwrap();
    // steps of a hundredth of the distance
    assert!((top - row).abs() < 1.0, "{top} {row}");
    assert!(wireline(&scene, &towers, eye, (&flat, 100.0), &Control::none()).unwrap().frames.is_empty());
}

#[test]
fn the_sea_hides_the_foot_of_a_tower() {
    // h = d² (1 - k) / 2R of what lies beyond the horizon of the eye
    let eye = [50_000.0, -50_000.0, 20.0];
    let scene = open_scene(grid(101, 1000.0, |_, _| 0.0), around(eye, 300.0));
    let earth = EarthParams::default();
    let radius = earth.radius / (1.0 - earth.refraction);
    let horizon = (2.0 * radius * eye[2]).sqrt();
    for span in [5000.0, 20_000.0, 30_000.0, 45_000.0] {
        let tower = line([eye[0] + span, eye[1], 0.0], 200.0);
        let hidden = if span > horizon { (span - horizon).powi(2) / (2.0 * radius) } else { 0.0 };
        let found = seen_metres(&scene, tower, eye, &earth);
        // the sea between the nodes is a plane: 1000² / 8R' of a cell
        assert!((found - (200.0 - hidden)).abs() < 0.2, "{span}: {found} of {}", 200.0 - hidden);
    }
}

/// Balls about a street, with a mesh before some of the towers.
fn town() -> MedialScene {
    let mut balls = MedialBalls::default();
    for i in 0..900_u64 {
        let at = |k: u64| uniform(7, 4 * i + k);
        let center = [(300.0 * at(0)) as f32, (300.0 * at(1)) as f32, (25.0 * at(2).powi(2)) as f32];
        balls.push(i as usize, center, (0.4 + 2.5 * at(3)) as f32, i as u32);
    }
    let vertices = vec![[100.0, 100.0, 0.0], [140.0, 90.0, 0.0], [140.0, 90.0, 18.0], [100.0, 100.0, 12.0]];
    let mesh = Mesh { vertices, triangles: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() };
    let triangles = BlockingTriangles::new(&mesh, "wall", [0.0; 3], None, None).unwrap();
    MedialScene::new(&balls, &BlockRule::default()).unwrap().with_triangles(Some(triangles))
}

#[test]
fn visible_metres_are_those_of_exact_rays() {
    let scene = town();
    let earth = EarthParams::default();
    let towers: Vec<Tower> = (0..12_u32)
        .map(|i| {
            let (angle, distance) = (f64::from(i) * 0.52, 200.0 + 400.0 * f64::from(i));
            let foot = [150.0 + distance * angle.cos(), 150.0 + distance * angle.sin(), 3.0];
            Tower { line: line(foot, 40.0 + 15.0 * f64::from(i)), hub: Some(30.0), scheme: i as usize % 3 }
        })
        .collect();
    let eyes: Vec<[f32; 3]> = (0..250_u64)
        .map(|i| [20.0 + 260.0 * uniform(1, i), 20.0 + 260.0 * uniform(2, i), 1.7].map(|v| v as f32))
        .filter(|eye| !scene.is_inside_obstacle(eye.map(f64::from)))
        .collect();
    let params = TowersParams::default().with_earth(earth);
    let found = towers_seen(&scene, &towers, &eyes, &params, &Control::none()).unwrap();
    let (mut worst, mut partly, mut tips) = (0.0_f64, 0, vec![0; towers.len()]);
    let is_seen = |eye: [f64; 3], place: [f64; 3]| scene.sight_answer(eye, place, &earth) == Answer::Visible;
    for (eye, view) in eyes.iter().zip(&found.views) {
        let (eye, view) = (eye.map(f64::from), view.unwrap());
        let mut sum = 0.0;
        for (tower, tips) in towers.iter().zip(&mut tips) {
            let by_rays = metres_by_rays(tower.line, STEP, |place| is_seen(eye, place));
            let spans = scene.vertical_sight(tower.line, &earth).seen_from(eye);
            let exact: f64 = spans.iter().map(|[from, to]| to - from).sum();
            // each visible part begins and ends within half a step of where the rays do
            let difference = (exact - by_rays).abs();
            assert!(difference <= STEP * (spans.len() + 1) as f64, "{exact} {by_rays} {spans:?}");
            worst = worst.max(difference);
            partly += usize::from(exact > 0.0 && exact < tower.line.height);
            *tips += usize::from(is_seen(eye, tower.line.top()));
            sum += exact;
        }
        // whatever was looked at before: the very same bits
        assert_eq!(view.metres, sum);
    }
    assert_eq!(found.place_counts.iter().map(|counts| counts[1]).collect::<Vec<_>>(), tips);
    println!("worst difference {worst:.3} m, {partly} towers are partly visible");
    assert!(partly > 500, "{partly}");
}

#[test]
fn mountains_hide_what_exact_rays_say() {
    let terrain = mountains(121, 100.0, 600.0);
    let (low, high) = terrain.on_map();
    let middle = [f64::midpoint(low[0], high[0]), f64::midpoint(low[1], high[1])];
    let level = terrain.height_at(middle).unwrap();
    let eye = [middle[0], middle[1], level + 5.0];
    let scene = open_scene(terrain.clone(), around(eye, 50.0));
    let earth = EarthParams::default();
    let (mut partly, mut none) = (0, 0);
    for i in 0..300_u64 {
        let place =
            [0, 1].map(|axis| low[axis] + (0.02 + 0.96 * uniform(5 + axis as u64, i)) * (high[axis] - low[axis]));
        let from =
            [0, 1].map(|axis| low[axis] + (0.02 + 0.96 * uniform(8 + axis as u64, i)) * (high[axis] - low[axis]));
        let (Some(foot), Some(under)) = (terrain.height_at(place), terrain.height_at(from)) else { continue };
        let tower = line([place[0], place[1], foot], 180.0);
        for eye in [eye, [from[0], from[1], under + 1.7]] {
            let by_rays =
                metres_by_rays(tower, 0.25, |place| scene.far_sight_answer(eye, place, &earth) == Answer::Visible);
            let found = seen_metres(&scene, tower, eye, &earth);
            assert!((found - by_rays).abs() <= 0.25, "{place:?}: {found} {by_rays}");
            partly += usize::from(found > 0.0 && found < 180.0);
            none += usize::from(found == 0.0);
        }
    }
    assert!(partly > 30 && none > 30, "{partly} {none}");
}
