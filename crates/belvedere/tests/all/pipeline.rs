//! From a LAZ file to answers on a simulated town: the same bits for any number of threads, and how often the answers
//! are wrong against the exact mesh.

use crate::common::simulated::cloud_of;
use belvedere::Bounds;
use belvedere::clean::{CleanParams, clean};
use belvedere::cloud::to_local;
use belvedere::control::Control;
use belvedere::depth::{ItemBuffer, Profile, depth_map};
use belvedere::io::{ReadOptions, read_cloud, write_cloud};
use belvedere::medial::{MedialBalls, ShrinkParams, Side, shrink};
use belvedere::neighbors::NeighborIndex;
use belvedere::normals::estimate::{Neighborhood, estimate};
use belvedere::normals::{Orientation, OrientedCloud, orient};
use belvedere::query::{Answer, query_points, random_targets};
use belvedere::trajectory::Trajectory;
use belvedere::view::{View, to_sun};
use belvedere::{PointCloud, Result};
use belvedere_scenes::{AirborneParams, Scan, TownParams, TriangleScene, Truth, scan_airborne, town};
use std::path::Path;

fn simulated(pulses_per_m2: f64) -> (TriangleScene, Scan) {
    let scene = town(&TownParams::default());
    let scan = scan_airborne(&scene, &AirborneParams { pulses_per_m2, ..AirborneParams::default() });
    (scene, scan)
}

fn write_scan(path: &Path, scan: &Scan) {
    write_cloud(path, &cloud_of(scan), &[]).unwrap();
}

fn trajectory(scan: &Scan) -> Trajectory {
    Trajectory { times: scan.sensor_path.times.clone(), positions: scan.sensor_path.positions.clone() }
}

struct PreparedCloud {
    cloud: PointCloud,
    index: NeighborIndex,
    oriented: OrientedCloud,
}

fn prepare(path: &Path, by: &Orientation<'_>) -> Result<PreparedCloud> {
    let (cloud, _) = read_cloud(&[path.to_owned()], &ReadOptions::default(), &Control::none())?;
    let (kept, _) = clean(&cloud, &CleanParams::default(), &Control::none())?;
    let cloud = cloud.select(&kept);
    let index = NeighborIndex::new(&cloud.positions, &Control::none())?;
    let normals = estimate(&cloud.positions, &index, Neighborhood::default(), &Control::none())?;
    let (oriented, _) = orient(&cloud, normals, by, &Control::none())?;
    Ok(PreparedCloud { cloud, index, oriented })
}

fn sun_view(cloud: &PointCloud) -> View {
    let sun = to_sun(235f64.to_radians(), 30f64.to_radians());
    let Bounds { low, high } = cloud.bounds().unwrap();
    View::parallel(sun.map(|v| -v), low.map(f64::from), high.map(f64::from), 0.25).unwrap()
}

fn interior(prepared: &PreparedCloud, params: &ShrinkParams) -> MedialBalls {
    shrink(&prepared.oriented, &prepared.index, Side::Interior, params, &Control::none()).unwrap().0
}

fn bits(triples: &[[f32; 3]]) -> Vec<[u32; 3]> {
    triples.iter().map(|p| p.map(f32::to_bits)).collect()
}

#[test]
fn every_stage_gives_the_same_bits_for_one_two_and_seven_threads() {
    let folder = tempfile::tempdir().unwrap();
    let (_, scan) = simulated(1.5);
    let path = folder.path().join("town.laz");
    write_scan(&path, &scan);
    let flight = trajectory(&scan);
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let prepared = prepare(&path, &Orientation::Trajectory(&flight)).unwrap();
            let mut stages = vec![bits(&prepared.cloud.positions), bits(prepared.oriented.normals())];
            let mut answers = Vec::new();
            for params in [ShrinkParams::tau(), ShrinkParams::angles()] {
                let balls = interior(&prepared, &params);
                stages.push(bits(&balls.centers));
                let map =
                    depth_map(&balls, &sun_view(&prepared.cloud), Profile::Sphere, ItemBuffer::With, &Control::none())
                        .unwrap();
                let depths = map.depth.values().iter().zip(map.balls.as_ref().unwrap().values());
                stages.push(depths.map(|(d, &b)| [d.to_bits(), b, 0]).collect());
                let Bounds { low, high } = prepared.cloud.bounds().unwrap();
                answers.push(query_points(&map, &random_targets(low, high, 50_000, 3), 0.1));
            }
            (stages, answers)
        })
    };
    let one = run(1);
    assert!(one.1[0].contains(&Answer::Blocked) && one.1[0].contains(&Answer::Visible));
    for threads in [2, 7] {
        assert!(one == run(threads), "{threads} threads give other bits than one");
    }
}

#[test]
fn default_balls_are_right_about_nine_in_ten_pedestrians_of_either_kind() {
    let folder = tempfile::tempdir().unwrap();
    let (scene, scan) = simulated(AirborneParams::default().pulses_per_m2);
    let path = folder.path().join("town.laz");
    write_scan(&path, &scan);
    let flight = trajectory(&scan);
    let prepared = prepare(&path, &Orientation::Trajectory(&flight)).unwrap();
    let pedestrians: Vec<[f64; 3]> = scan
        .exact_positions
        .iter()
        .zip(&scan.classification)
        .filter(|(_, class)| **class == 2)
        .map(|(p, _)| [p[0], p[1], p[2] + 1.5])
        .collect();
    let sun = to_sun(235f64.to_radians(), 30f64.to_radians());
    let shadowed = Truth::new(&scene).occluded_towards_each(&pedestrians, sun);
    let targets: Vec<[f32; 3]> = pedestrians.iter().map(|&p| to_local(p, prepared.cloud.frame.origin)).collect();
    let rates = |params: &ShrinkParams| {
        let map = depth_map(
            &interior(&prepared, params),
            &sun_view(&prepared.cloud),
            Profile::Sphere,
            ItemBuffer::Without,
            &Control::none(),
        )
        .unwrap();
        let answers = query_points(&map, &targets, map.default_depth_bias());
        let share = |answer: Answer, truly_shadowed: bool| {
            let of = shadowed.iter().filter(|&&s| s == truly_shadowed).count();
            let wrong = answers.iter().zip(&shadowed).filter(|&(a, s)| *a == answer && *s == truly_shadowed).count();
            wrong as f64 / of as f64
        };
        [share(Answer::Blocked, false), share(Answer::Visible, true)]
    };
    let [false_blocked, false_visible] = rates(&ShrinkParams::tau());
    println!("default: false-blocked {false_blocked:.3}, false-visible {false_visible:.3}");
    // measured 0.091 and 0.021 on this town; the room is for changes of the last bits, not of the method
    assert!(false_blocked < 0.10 && false_visible < 0.025, "{false_blocked} {false_visible}");
    let [false_blocked, false_visible] = rates(&ShrinkParams::angles());
    println!("paper: false-blocked {false_blocked:.3}, false-visible {false_visible:.3}");
    // the published balls on airborne data: nearly everything lies in their shadow, and no shadow is missed
    assert!(false_blocked > 0.8 && false_visible < 0.01, "{false_blocked} {false_visible}");
}
