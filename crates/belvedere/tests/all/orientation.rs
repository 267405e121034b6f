//! Signs of normals against solids in closed form, simulated scans, and an independent orientation of a real town.
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use belvedere::control::Control;
use std::path::Path;

use belvedere::io::read_mesh;
use belvedere::normals::{Normals, OrientReport, Orientation, OrientedCloud, orient};
use belvedere::trajectory::Trajectory;
use belvedere::{Attributes, Frame, GpsTimeKind, Mesh, PointCloud};

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The normals with signs changed at random (the same on every run).
fn scrambled(normals: &[[f32; 3]]) -> Normals {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let vectors = normals.iter().map(|n| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        if state & 1 == 0 { *n } else { n.map(|v| -v) }
    });
    Normals { vectors: vectors.collect(), quality: vec![1.0; normals.len()] }
}

/// Share of the points that `counts` says count, whose normals agree with the truth.
fn agreement(found: &[[f32; 3]], truth: &[[f32; 3]], counts: impl Fn(usize) -> bool) -> f64 {
    let rows: Vec<usize> = (0..truth.len()).filter(|&i| counts(i)).collect();
    rows.iter().filter(|&&i| dot(found[i], truth[i]) > 0.0).count() as f64 / rows.len() as f64
}

fn oriented(cloud: &PointCloud, truth: &[[f32; 3]], by: &Orientation<'_>) -> (OrientedCloud, OrientReport) {
    let (result, report) = orient(cloud, scrambled(truth), by, &Control::none()).unwrap();
    let counted = report.without_normal_count
        + report.by_file_count
        + report.by_scanner_count
        + report.by_face_count
        + report.by_parity_count
        + report.by_vote_count
        + report.by_up_count;
    assert_eq!(counted, cloud.len());
    (result, report)
}

fn cloud_of(positions: Vec<[f32; 3]>) -> PointCloud {
    PointCloud {
        positions,
        frame: Frame { origin: [85_000.0, 447_000.0, 0.0], ..Frame::default() },
        ..PointCloud::default()
    }
}

fn sphere(radius: f64, count: u32) -> (PointCloud, Vec<[f32; 3]>) {
    let normals: Vec<[f32; 3]> = (0..count)
        .map(|i| {
            let z = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(count);
            let turn = f64::from(i) * 2.399_963_229_728_653;
            let ring_radius = (1.0 - z * z).sqrt();
            [(ring_radius * turn.cos()) as f32, (ring_radius * turn.sin()) as f32, z as f32]
        })
        .collect();
    (cloud_of(normals.iter().map(|n| n.map(|v| v * radius as f32)).collect()), normals)
}

/// A torus around z, R 20 and r 5, as points with exact normals and as a closed mesh.
fn torus() -> (PointCloud, Vec<[f32; 3]>, Mesh) {
    let place = |i: u32, k: u32, shift: f64| {
        let (u, v) = (
            (f64::from(i) + shift) * std::f64::consts::TAU / 120.0,
            (f64::from(k) + shift) * std::f64::consts::TAU / 60.0,
        );
        let n = [v.cos() * u.cos(), v.cos() * u.sin(), v.sin()];
        ([u.cos() * 20.0 + 5.0 * n[0], u.sin() * 20.0 + 5.0 * n[1], 5.0 * n[2]], n)
    };
    let (mut mesh, mut positions, mut normals) = (Mesh::default(), Vec::new(), Vec::new());
    for i in 0..120 {
        for k in 0..60 {
            let p = place(i, k, 0.0).0;
            mesh.vertices.push([p[0] + 85_000.0, p[1] + 447_000.0, p[2]]);
            let corner = |i: u32, k: u32| (i % 120) * 60 + k % 60;
            mesh.triangles.push([corner(i, k), corner(i + 1, k), corner(i + 1, k + 1)]);
            mesh.triangles.push([corner(i, k), corner(i + 1, k + 1), corner(i, k + 1)]);
            let (p, n) = place(i, k, 0.37);
            positions.push(p.map(|v| v as f32));
            normals.push(n.map(|v| v as f32));
        }
    }
    (cloud_of(positions), normals, mesh)
}

/// Points on a box 20 x 12 x 8 standing on z = 0, and its mesh; `open` leaves the floor out of both.
fn box_solid(open: bool) -> (PointCloud, Vec<[f32; 3]>, Mesh) {
    let size = [20.0_f64, 12.0, 8.0];
    let vertices = (0..8_u8)
        .map(|c| {
            let at = |axis: usize| if c >> axis & 1 == 1 { size[axis] } else { 0.0 };
            [at(0) + 85_000.0, at(1) + 447_000.0, at(2)]
        })
        .collect();
    let mut triangles = vec![
        [4, 5, 7],
        [4, 7, 6],
        [0, 1, 5],
        [0, 5, 4],
        [2, 7, 3],
        [2, 6, 7],
        [0, 6, 2],
        [0, 4, 6],
        [1, 3, 7],
        [1, 7, 5],
    ];
    if !open {
        triangles.extend([[0, 2, 3], [0, 3, 1]]);
    }
    let (mut positions, mut normals) = (Vec::new(), Vec::new());
    for axis in 0..3 {
        for side in 0..2_u8 {
            if open && axis == 2 && side == 0 {
                continue;
            }
            for step in 0..900_u32 {
                let mut p = [0.0_f64; 3];
                p[axis] = f64::from(side) * size[axis];
                p[(axis + 1) % 3] = (f64::from(step % 30) + 0.5) / 30.0 * size[(axis + 1) % 3];
                p[(axis + 2) % 3] = (f64::from(step / 30) + 0.5) / 30.0 * size[(axis + 2) % 3];
                let mut n = [0.0_f32; 3];
                n[axis] = if side == 1 { 1.0 } else { -1.0 };
                positions.push(p.map(|v| v as f32));
                normals.push(n);
            }
        }
    }
    (cloud_of(positions), normals, Mesh { vertices, triangles, ..Mesh::default() })
}

#[test]
fn a_mesh_recovers_every_sign_of_closed_solids() {
    let (cloud, truth, mesh) = torus();
    let (result, report) = oriented(&cloud, &truth, &Orientation::Mesh(&mesh));
    assert!(agreement(result.normals(), &truth, |_| true) == 1.0);
    assert!(report.share(report.by_face_count) > 0.99, "{report:?}");
    let (cloud, truth, mesh) = box_solid(false);
    let (result, _) = oriented(&cloud, &truth, &Orientation::Mesh(&mesh));
    assert!(agreement(result.normals(), &truth, |_| true) == 1.0);
}

#[test]
fn a_box_without_floor_still_has_an_inside() {
    let (cloud, truth, mesh) = box_solid(true);
    let (result, _) = oriented(&cloud, &truth, &Orientation::Mesh(&mesh));
    assert!(agreement(result.normals(), &truth, |_| true) == 1.0);
}

#[test]
fn faces_turned_the_wrong_way_change_nothing() {
    for (cloud, truth, mut mesh) in [torus(), box_solid(false), box_solid(true)] {
        for (index, triangle) in mesh.triangles.iter_mut().enumerate() {
            if index % 3 != 0 {
                triangle.swap(1, 2);
            }
        }
        let (result, _) = oriented(&cloud, &truth, &Orientation::Mesh(&mesh));
        assert!(agreement(result.normals(), &truth, |_| true) == 1.0);
    }
}

#[test]
fn points_off_a_generalised_model_use_parity_or_up() {
    // normals at right angles to the nearest face, such as a dormer's: parity decides
    let (_, _, mesh) = box_solid(false);
    let cloud = cloud_of(vec![[19.9, 6.0, 4.0], [10.0, 6.0, 500.0], [10.0, 6.0, 8.0]]);
    let truth = [[0.4, 0.0, 0.9165], [0.0, 0.0, 1.0], [0.0; 3]];
    let (result, report) = oriented(&cloud, &truth, &Orientation::Mesh(&mesh));
    assert!(agreement(result.normals(), &truth, |i| i < 2) == 1.0);
    assert_eq!((report.by_parity_count, report.by_up_count, report.without_normal_count), (1, 1, 1));
    assert_eq!(result.confidence(), [0.5, 0.25, 0.0]);
    assert_eq!(result.normals()[2], [0.0; 3]);
}

#[test]
fn ground_near_the_floor_of_a_solid_faces_up() {
    let (_, _, mesh) = box_solid(false);
    // a court that the model filled, and the street in front of the house where the model has none
    let cloud = cloud_of(vec![[10.0, 6.0, 0.2], [10.0, 6.0, 0.8], [21.0, 6.0, 0.05]]);
    let truth = vec![[0.0, 0.0, 1.0]; 3];
    let (result, report) = oriented(&cloud, &truth, &Orientation::Mesh(&mesh));
    assert_eq!(result.normals(), truth);
    assert_eq!(report.by_up_count, 3);
}

#[test]
fn a_scanner_inside_sees_only_inward_normals() {
    let (mut cloud, truth) = sphere(10.0, 5000);
    let inward: Vec<[f32; 3]> = truth.iter().map(|n| n.map(|v| -v)).collect();
    let (result, report) = oriented(&cloud, &inward, &Orientation::ScannerAt(vec![[85_000.0, 447_000.0, 0.0]]));
    assert!(agreement(result.normals(), &inward, |_| true) == 1.0);
    assert!(result.confidence().iter().all(|&c| c > 0.999));
    assert_eq!(report.by_scanner_count, 5000);
    // each half of the points names the scanner on its own side, though another is nearer
    cloud.scanner_positions = vec![[100.0, 0.0, 0.0], [-1000.0, 0.0, 0.0]];
    cloud.attributes.scanner_index = Some(truth.iter().map(|n| u16::from(n[0] < 0.0)).collect());
    let (result, _) = oriented(&cloud, &truth, &Orientation::Scanner);
    let lit = |i: usize| dot(truth[i], cloud.scanner_positions[usize::from(truth[i][0] < 0.0)]) > 10.5;
    assert!(agreement(result.normals(), &truth, lit) == 1.0);
}

#[test]
fn a_trajectory_gives_every_point_its_own_sensor() {
    // flown along x above a row of walls: only the sensor's place tells their sides apart
    let flight = (0..400).map(|i| {
        let t = f64::from(i) * 0.5;
        (345_600.0 + t, [85_000.0 + 60.0 * t, 447_000.0 + 30.0 * (t / 30.0).sin(), 800.0])
    });
    let (trajectory, _) = Trajectory::from_records(flight.collect());
    let (mut positions, mut truth, mut times) = (Vec::new(), Vec::new(), Vec::new());
    for i in 0..1500_u32 {
        let t = f64::from(i) * 0.1 + 10.03;
        let side = if i % 2 == 0 { 1.0 } else { -1.0 };
        // a scanner mirror looks across the track; walls face it
        positions.push([(60.0 * t) as f32, side * 400.0, 5.0]);
        truth.push([0.0, -side, 0.0]);
        // adjusted standard GPS time, week 2000
        times.push(2000.0 * 604_800.0 + 345_600.0 + t - 1e9);
    }
    // the flight is over when the last ten are measured
    for time in times.iter_mut().rev().take(10) {
        *time += 1000.0;
    }
    let mut cloud = cloud_of(positions);
    let no_times =
        orient(&cloud, scrambled(&truth), &Orientation::Trajectory(&trajectory), &Control::none()).unwrap_err();
    assert!(no_times.to_string().contains("GPS time"));
    cloud.attributes =
        Attributes { gps_time: Some(times), gps_time_kind: GpsTimeKind::AdjustedStandard, ..Attributes::default() };
    let (result, report) = oriented(&cloud, &truth, &Orientation::Trajectory(&trajectory));
    assert!(agreement(result.normals(), &truth, |i| i < 1490) == 1.0);
    assert_eq!((report.by_scanner_count, report.by_up_count + report.by_vote_count), (1490, 10));
    assert_eq!(report.clock.unwrap().known_count, 1490);
    let elsewhere = Trajectory { times: vec![0.0, 1.0], positions: vec![[0.0; 3]; 2] };
    assert!(orient(&cloud, scrambled(&truth), &Orientation::Trajectory(&elsewhere), &Control::none()).is_err());
}

#[test]
fn positions_of_the_scanner_for_each_point_give_its_sign_and_the_rest_turns_up() {
    let (cloud, truth) = sphere(10.0, 4000);
    // each point is measured from its own place, 50 m straight outside; every fifth place is unknown
    let scanner: Vec<[f32; 3]> =
        truth.iter().enumerate().map(|(i, n)| if i % 5 == 0 { [f32::NAN; 3] } else { n.map(|v| 60.0 * v) }).collect();
    let (result, report) = oriented(&cloud, &truth, &Orientation::Pulses(&scanner));
    assert_eq!(report.by_scanner_count, 3200);
    assert!((agreement(result.normals(), &truth, |i| i % 5 != 0) - 1.0).abs() < 1e-12);
    let upward = |i: usize| i.is_multiple_of(5) && truth[i][2] > 0.4;
    assert!((agreement(result.normals(), &truth, upward) - 1.0).abs() < 1e-12);
    assert!(orient(&cloud, scrambled(&truth), &Orientation::Pulses(&scanner[1..]), &Control::none()).is_err());
}

#[test]
fn given_normals_replace_the_estimated() {
    let (mut cloud, truth) = sphere(10.0, 100);
    assert!(orient(&cloud, scrambled(&truth), &Orientation::Given, &Control::none()).is_err());
    let mut given: Vec<[f32; 3]> = truth.iter().map(|n| n.map(|v| 3.0 * v)).collect();
    given[0] = [f32::NAN, 0.0, 0.0];
    cloud.attributes.normals = Some(given);
    let (result, report) = orient(&cloud, Normals::default(), &Orientation::Given, &Control::none()).unwrap();
    assert!(agreement(result.normals(), &truth, |i| i > 0) == 1.0);
    assert!(result.normals().iter().skip(1).all(|n| (dot(*n, *n) - 1.0).abs() < 1e-5));
    assert_eq!((report.by_file_count, report.without_normal_count), (99, 1));
    assert_eq!((result.quality()[0], result.quality()[1], result.confidence()[0]), (0.0, 1.0, 0.0));
}

#[test]
fn wrong_lengths_and_empty_meshes_are_errors() {
    let (cloud, truth) = sphere(10.0, 100);
    let short = Normals { vectors: truth[1..].to_vec(), quality: vec![1.0; 100] };
    assert!(orient(&cloud, short, &Orientation::Up, &Control::none()).is_err());
    for by in [Orientation::Mesh(&Mesh::default()), Orientation::Scanner, Orientation::ScannerAt(Vec::new())] {
        assert!(orient(&cloud, scrambled(&truth), &by, &Control::none()).is_err());
    }
    let empty = orient(&PointCloud::default(), Normals::default(), &Orientation::Up, &Control::none()).unwrap();
    assert!(empty.0.is_empty());
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let (cloud, truth, mesh) = torus();
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| oriented(&cloud, &truth, &Orientation::Mesh(&mesh)))
    };
    let ((one, report_one), (three, report_three)) = (run(1), run(3));
    assert_eq!(one.normals(), three.normals());
    assert_eq!(one.confidence(), three.confidence());
    assert_eq!(report_one, report_three);
}

fn rows(path: &Path) -> Vec<[f32; 3]> {
    let bytes = std::fs::read(path).unwrap();
    let values: Vec<f32> = npyz::NpyFile::new(&bytes[..]).unwrap().into_vec().unwrap();
    values.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect()
}

#[test]
fn a_simulated_house_is_oriented_from_above() {
    let Some(folder) = crate::common::data("a_simulated_house_is_oriented_from_above", "reference/houseL") else {
        return;
    };
    let cloud = PointCloud { positions: rows(&folder.join("coords.npy")), ..PointCloud::default() };
    let lines = rows(&folder.join("normals.npy"));
    let mut archive = zip::ZipArchive::new(std::fs::File::open(folder.join("truth.npz")).unwrap()).unwrap();
    let values: Vec<f32> = npyz::NpyFile::new(archive.by_name("n_true.npy").unwrap()).unwrap().into_vec().unwrap();
    let truth: Vec<[f32; 3]> = values.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect();
    // trees have no true outside: their points are judged by none of the ways
    let solid = |i: usize| dot(lines[i], truth[i]).abs() > 0.5;
    let steep = |i: usize| solid(i) && lines[i][2].abs() < 0.3;
    let mut shares = Vec::new();
    for (name, by) in [("up", Orientation::Up), ("scanner", Orientation::ScannerAt(vec![[28.0, 25.0, 1000.0]]))] {
        let (result, report) = oriented(&cloud, &lines, &by);
        let share = [agreement(result.normals(), &truth, solid), agreement(result.normals(), &truth, steep)];
        println!("houseL {name}: all {:.4}, steep {:.4}, {report:?}", share[0], share[1]);
        shares.push(share);
    }
    let upward: Vec<[f32; 3]> = lines.iter().map(|n| if n[2] < 0.0 { n.map(|v| -v) } else { *n }).collect();
    let plain = agreement(&upward, &truth, steep);
    println!("houseL up without the vote: steep {plain:.4}");
    assert!(shares[0][0] > 0.98 && shares[1][0] > 0.97, "{shares:?}");
    // straight up is a coin flip for steep points, and so is a scanner straight above; roof and ground tell
    assert!(shares[0][1] > 0.95 && plain < 0.7, "{shares:?} {plain}");
}

#[test]
fn delft_by_its_city_model_agrees_with_a_scanner_above() {
    let test = "delft_by_its_city_model_agrees_with_a_scanner_above";
    let (Some(folder), Some(obj), Some(city)) = (
        crate::common::data(test, "reference/delft1"),
        crate::common::data(test, "data/delft_ahn3/testarea.obj"),
        crate::common::data(test, "data/delft_ahn3/testarea.json"),
    ) else {
        return;
    };
    // coords.npy is the tile minus this; found by comparing with the tile point by point
    let cloud = PointCloud {
        positions: rows(&folder.join("coords.npy")),
        frame: Frame { origin: [84_808.0, 447_412.0, -1.0], ..Frame::default() },
        ..PointCloud::default()
    };
    let by_scanner = rows(&folder.join("normals.npy"));
    let horizontal = |i: usize| by_scanner[i][2].abs() > 0.9;
    let mut results = Vec::new();
    for path in [&obj, &city] {
        let (mesh, mesh_report) = read_mesh(path).unwrap();
        let (result, report) = oriented(&cloud, &by_scanner, &Orientation::Mesh(&mesh));
        let all = agreement(result.normals(), &by_scanner, |i| dot(by_scanner[i], by_scanner[i]) > 0.0);
        let flat = agreement(result.normals(), &by_scanner, horizontal);
        println!("{}: all {all:.4}, horizontal {flat:.4}, {mesh_report:?}, {report:?}", path.display());
        // the model covers a quarter of the tile; steep points are a guess for a scanner straight above; ground that
        // lies within a decimetre of the floor of a solid takes the floor's sign
        assert!(all > 0.93 && flat > 0.998, "{all} {flat}");
        assert!(report.share(report.by_face_count) > 0.2, "{report:?}");
        results.push(result);
    }
    let same = agreement(results[0].normals(), results[1].normals(), |_| true);
    println!("OBJ and CityJSON agree on {same:.4}");
    assert!(same > 0.998, "{same}");
}

#[test]
fn random3dcity_normals_come_back_from_their_mesh() {
    let test = "random3dcity_normals_come_back_from_their_mesh";
    let (Some(folder), Some(obj)) = (
        crate::common::data(test, "data/random3dcity/NPY"),
        crate::common::data(test, "data/random3dcity/OBJ/LOD2_1_F0_DSM.obj"),
    ) else {
        return;
    };
    let cloud = PointCloud { positions: rows(&folder.join("coords.npy")), ..PointCloud::default() };
    let truth = rows(&folder.join("normals.npy"));
    let (mesh, mesh_report) = read_mesh(&obj).unwrap();
    let (result, report) = oriented(&cloud, &truth, &Orientation::Mesh(&mesh));
    // the signs in the file are no truth: its walls all have a positive x or y, whichever way they face. The mesh turns
    // all its walls and roofs outward (its ground it turns down); brute force finds the face each point lies on.
    let faces: Vec<([[f64; 3]; 3], [f64; 3])> = (0..mesh.triangles.len())
        .filter_map(|index| {
            let corners = mesh.corners(index)?;
            let [a, b, c] = corners;
            let [u, v]: [[f64; 3]; 2] = [std::array::from_fn(|i| b[i] - a[i]), std::array::from_fn(|i| c[i] - a[i])];
            let n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
            let size = n.map(|x| x * x).iter().sum::<f64>().sqrt();
            Some((corners, n.map(|x| x / size)))
        })
        .collect();
    let (mut judged, mut right, mut wrong_confidence) = (0, 0, 0.0_f32);
    for (i, p) in cloud.positions.iter().enumerate() {
        let p = p.map(f64::from);
        let line = truth[i].map(f64::from);
        // of the faces the point lies on (to 2 mm) that its normal fits; none or two that disagree: not judged
        let own: Vec<[f64; 3]> = faces
            .iter()
            .filter(|(corners, n)| {
                let d = (0..3).map(|k| (p[k] - corners[0][k]) * n[k]).sum::<f64>();
                let along = (0..3).map(|k| line[k] * n[k]).sum::<f64>();
                d.abs() < 0.002 && along.abs() > 0.9 && within(corners, n, p)
            })
            .map(|(_, n)| if p[2] < 0.01 && n[2].abs() > 0.9 { [0.0, 0.0, 1.0] } else { *n })
            .collect();
        let signs: Vec<bool> =
            own.iter().map(|n| (0..3).map(|k| f64::from(result.normals()[i][k]) * n[k]).sum::<f64>() > 0.0).collect();
        if signs.is_empty() || signs.iter().any(|&s| s != signs[0]) {
            continue;
        }
        judged += 1;
        if signs[0] {
            right += 1;
        } else {
            wrong_confidence = wrong_confidence.max(result.confidence()[i]);
        }
    }
    let share = f64::from(right) / f64::from(judged);
    let kept = agreement(result.normals(), &truth, |_| true);
    println!("random3dcity: {share:.5} of {judged}, as in the file {kept:.5}, wrong up to {wrong_confidence}");
    println!("{mesh_report:?} {report:?}");
    assert!(f64::from(judged) > 0.95 * truth.len() as f64, "{judged}");
    assert!(share > 0.995, "{share}");
}

/// Returns true if the projection of `p` lies in the triangle with unit normal `n`, with a tolerance of a tenth of a
/// millimetre.
fn within(corners: &[[f64; 3]; 3], n: &[f64; 3], p: [f64; 3]) -> bool {
    (0..3).all(|i| {
        let (a, b) = (corners[i], corners[(i + 1) % 3]);
        let [e, d]: [[f64; 3]; 2] = [std::array::from_fn(|k| b[k] - a[k]), std::array::from_fn(|k| p[k] - a[k])];
        let cross = [e[1] * d[2] - e[2] * d[1], e[2] * d[0] - e[0] * d[2], e[0] * d[1] - e[1] * d[0]];
        let length = e.map(|x| x * x).iter().sum::<f64>().sqrt();
        (0..3).map(|k| cross[k] * n[k]).sum::<f64>() > -1e-4 * length
    })
}

#[test]
fn a_mesh_in_feet_becomes_one_in_metres() {
    use belvedere::crs::{Crs, INTERNATIONAL_FOOT};
    let feet =
        Crs { metres_per_unit: INTERNATIONAL_FOOT, vertical_metres_per_unit: INTERNATIONAL_FOOT, ..Crs::default() };
    let square = Mesh {
        vertices: vec![[0.0, 0.0, 10.0], [100.0, 0.0, 10.0], [100.0, 100.0, 10.0], [0.0, 100.0, 10.0]],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    };
    let metres = square.scaled_to_metres(&feet);
    let corner = metres.corners(0).unwrap()[2];
    assert!((corner[0] - 30.48).abs() < 1e-12 && (corner[2] - 3.048).abs() < 1e-12, "{corner:?}");
}
