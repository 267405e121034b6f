//! Clouds as programs leave them in folders, with the files beside them.

use std::fmt::Write;
use std::path::Path;

use belvedere_data::control::Control;
use belvedere_data::{PointCloud, Result};
use belvedere_io::{ReadOptions, ReadReport, Source, SystemBeside, Within, cloud_files, read_cloud, read_las_head};

use crate::sources::{cloud, file};
use crate::web_server::{KEY, Manner, WebServer};

fn read(path: &Path) -> Result<(PointCloud, ReadReport)> {
    read_cloud([path], &ReadOptions::default(), &Control::none())
}

fn read_bytes(name: &str, text: &[u8]) -> Result<(PointCloud, ReadReport)> {
    read_cloud([Source::bytes(name, text)], &ReadOptions::default(), &Control::none())
}

fn error(name: &str, text: &str) -> String {
    read_bytes(name, text.as_bytes()).map(|(cloud, _)| cloud.len()).unwrap_err().to_string()
}

/// Rows of PTS: x, y, z, intensity and colour.
fn rows(count: u32) -> String {
    (0..count).fold(String::new(), |mut text, i| {
        let _ = writeln!(text, "{}.5 {}.25 {} -500 10 20 30", 155_000 + i, 463_000 + i % 10, i % 7);
        text
    })
}

#[test]
fn pts_is_read_with_all_its_scans_and_what_it_lacks_is_counted() {
    let (cloud, report) = read_bytes("a.pts", format!("100\r\n{}", rows(100)).as_bytes()).unwrap();
    assert_eq!((cloud.len(), report.left_out_count()), (100, 0));
    assert_eq!(cloud.attributes.color.as_ref().unwrap()[0], [10 * 257, 20 * 257, 30 * 257]);
    assert_eq!(cloud.frame.to_file_coordinates(cloud.positions[3]), [155_003.5, 463_003.25, 3.0]);
    let (cloud, report) = read_bytes("a.pts", format!("60\n{}40\n{}", rows(60), rows(40)).as_bytes()).unwrap();
    assert_eq!((cloud.len(), report.left_out_count()), (100, 0));
    let (cloud, report) = read_bytes("a.pts", format!("100\n{}", rows(70)).as_bytes()).unwrap();
    assert_eq!((cloud.len(), report.files[0].missing_points), (70, 30));
    assert!(report.files[0].notes.iter().any(|note| note.contains("announce 100")), "{:?}", report.files[0].notes);
    // without a count, a line of one number is no point
    assert_eq!(read_bytes("a.pts", format!("{}7\n", rows(5)).as_bytes()).unwrap().1.left_out_count(), 1);
}

#[test]
fn asc_is_a_cloud_or_a_grid_by_its_content() {
    let (cloud, _) = read_bytes("a.asc", b"//X Y Z R G B\n1.5 2.5 3.5 1 2 3\n4.5 5.5 6.5 4 5 6\n").unwrap();
    assert_eq!(cloud.len(), 2);
    let grid = "ncols 3\nnrows 2\nxllcorner 155000\nyllcorner 463000\ncellsize 1\nNODATA_value -9999\n1 2 3\n4 5 6\n";
    for name in ["a.asc", "a.txt", "A.ASC"] {
        let what = error(name, &grid.replace("ncols", "NCOLS"));
        assert!(
            what.contains("grid of heights") && what.contains("gdal_translate") && what.starts_with(name),
            "{what}"
        );
    }
}

#[test]
fn clouds_in_utf_16_are_read() {
    let text = "\u{feff}x;y;z\n1.5;2.5;3.5\n4.5;5.5;6.5\n";
    let little: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
    let big: Vec<u8> = text.encode_utf16().flat_map(u16::to_be_bytes).collect();
    for bytes in [&little, &big, &little[2..].to_vec(), &big[2..].to_vec()] {
        assert_eq!(read_bytes("a.csv", bytes).unwrap().0.len(), 2);
    }
    assert!(read_bytes("a.csv", b"\xff\xfe\0\0x\0\0\0").unwrap_err().to_string().contains("UTF-32"));
}

#[test]
fn a_folder_is_read_whatever_programs_left_in_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    std::fs::write(path("tile.laz"), file("tile.laz", &cloud(500))).unwrap();
    std::fs::write(path("scan.pts"), format!("20\n{}", rows(20))).unwrap();
    std::fs::write(path("part.txt"), "//X Y Z\n1 2 3\n").unwrap();
    let left = [
        "._tile.laz",
        ".DS_Store",
        "~$list.csv",
        "Thumbs.db",
        "desktop.ini",
        "tile.lax",
        "tile.lasx",
        "tile.aux.xml",
        "cloud.bin",
        "half.laz.tmp",
        "half.laz.part",
        "plan.gpkg",
        "README",
    ];
    for name in left {
        std::fs::write(path(name), b"\0\x05\x16\x07 what is no cloud").unwrap();
    }
    std::fs::write(path("dtm.asc"), "ncols 1\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 1\n7\n").unwrap();
    // trajectories and positions of scanners have x, y and z too
    std::fs::write(path("flight.csv"), "time,x,y,z\n1,2,3,400\n2,2,4,400\n").unwrap();
    std::fs::write(path("stations.txt"), "station x y z\n1 2 3 1.8\n").unwrap();
    std::fs::create_dir(path("old.laz")).unwrap();
    let (found, report) = read(folder.path()).unwrap();
    assert_eq!(found.len(), 521);
    assert_eq!(report.skipped_files, ["dtm.asc", "flight.csv", "stations.txt"].map(path));
    let notes: Vec<&String> = report.notes.iter().filter(|note| note.contains("passed over")).collect();
    assert!(matches!(notes[..], [note] if note.contains(": 13 (") && note.contains("…")), "{notes:?}");
    assert_eq!(cloud_files(&[folder.path().to_owned()]).unwrap().len(), 3);
    // nothing but leftovers is no cloud
    std::fs::remove_file(path("tile.laz")).unwrap();
    std::fs::remove_file(path("scan.pts")).unwrap();
    std::fs::remove_file(path("part.txt")).unwrap();
    // alone, a table with x, y and z is a cloud, whatever else it has
    assert_eq!(read(folder.path()).unwrap().0.len(), 3);
    for name in ["flight.csv", "stations.txt"] {
        std::fs::remove_file(path(name)).unwrap();
    }
    assert!(read(folder.path()).is_err());
}

#[test]
fn a_file_without_a_system_has_that_of_the_prj_beside_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let plain = PointCloud { frame: belvedere_data::Frame { crs: Default::default(), ..cloud(1).frame }, ..cloud(300) };
    for (name, prj) in [("a.laz", "a.prj"), ("b.copc.laz", "b.PRJ"), ("c.xyz", "c.prj"), ("d.ply", "d.prj")] {
        std::fs::write(path(name), file(name, &plain)).unwrap();
        assert_eq!(Source::path(path(name)).system_beside(), None);
        assert_eq!(read(&path(name)).unwrap().0.frame.crs.epsg, None, "{name}");
        std::fs::write(path(prj), "EPSG:28992").unwrap();
        let (found, report) = read(&path(name)).unwrap();
        assert_eq!((found.frame.crs.epsg, report.files[0].crs_source.as_str()), (Some(28_992), prj), "{name}");
        let notes = &report.files[0].notes;
        assert!(found.len() == 300 && !notes.iter().any(|note| note.contains("reference system")), "{notes:?}");
    }
    assert_eq!(read_las_head(&path("a.laz")).unwrap().crs.epsg, Some(28_992));
    // the unit counts for windows too
    std::fs::write(path("a.prj"), "EPSG:2263").unwrap();
    let frame = read(&path("a.laz")).unwrap().0.frame;
    let bounds = belvedere_data::Bounds { low: [-5.0; 3], high: [5.0; 3] };
    let options = ReadOptions::new().with_frame(frame).with_points_within(Within::Local(bounds));
    let (part, _) = read_cloud([path("a.laz")], &options, &Control::none()).unwrap();
    assert!((1..300).contains(&part.len()) && part.positions.iter().all(|&p| bounds.contains(p)));
    // a file that names its system keeps it, and what cannot be read is said
    std::fs::write(path("own.laz"), file("own.laz", &cloud(10))).unwrap();
    std::fs::write(path("own.prj"), "EPSG:2154").unwrap();
    assert_eq!(read(&path("own.laz")).unwrap().0.frame.crs.epsg, Some(28_992));
    std::fs::write(path("c.prj"), "no system").unwrap();
    assert_eq!(
        Source::path(path("c.xyz")).system_beside(),
        Some(SystemBeside::Unreadable { found_in: "c.prj".to_owned() })
    );
    assert!(read(&path("c.xyz")).unwrap().1.files[0].notes.iter().any(|note| note.contains("c.prj")));
}

/// Entwine point tiles of 900 points in four nodes, the deepest in a page of its own: names and contents of the files.
pub(crate) fn ept() -> Vec<(&'static str, Vec<u8>)> {
    let plain = PointCloud { frame: belvedere_data::Frame { crs: Default::default(), ..cloud(1).frame }, ..cloud(900) };
    // the cube of the root is 128 m wide, from the south-west of the points on
    let [x, y] = [154_936.0, 462_936.0];
    let is_west = |p: &[f32; 3]| p[0] < 0.0;
    let part = |keep: &dyn Fn(usize, &[f32; 3]) -> bool| {
        let kept = plain.positions.iter().copied().enumerate().filter(|(i, p)| keep(*i, p)).map(|(_, p)| p);
        PointCloud { positions: kept.collect(), ..PointCloud::in_frame(plain.frame.clone()) }
    };
    let nodes = [
        ("ept-data/0-0-0-0.laz", part(&|i, _| i % 3 == 0)),
        ("ept-data/1-0-0-0.laz", part(&|i, p| i % 3 != 0 && is_west(p) && p[1] < 0.0)),
        ("ept-data/1-0-1-0.laz", part(&|i, p| i % 3 != 0 && is_west(p) && p[1] >= 0.0)),
        ("ept-data/1-1-0-0.laz", part(&|i, p| i % 3 != 0 && !is_west(p) && p[1] < 0.0)),
        ("ept-data/1-1-1-0.laz", part(&|i, p| i % 3 != 0 && !is_west(p) && p[1] >= 0.0)),
    ];
    let counts = nodes.each_ref().map(|(_, cloud)| cloud.len());
    assert_eq!(counts.iter().sum::<usize>(), 900);
    let description = format!(
        r#"{{"bounds": [{x}, {y}, -50, {}, {}, 78], "dataType": "laszip", "hierarchyType": "json", "points": 900, "span": 128, "version": "1.1.0",
        "schema": [{{"name": "X", "scale": 0.001, "offset": 0, "type": "signed", "size": 4}}],
        "srs": {{"authority": "EPSG", "horizontal": "28992", "vertical": "5709"}}}}"#,
        x + 128.0,
        y + 128.0
    );
    let root = format!(
        r#"{{"0-0-0-0": {}, "1-0-0-0": {}, "1-0-1-0": {}, "1-1-0-0": {}, "1-1-1-0": -1, "1-0-0-1": 0}}"#,
        counts[0], counts[1], counts[2], counts[3]
    );
    let page = format!(r#"{{"1-1-1-0": {}}}"#, counts[4]);
    let mut files = vec![
        ("ept.json", description.into_bytes()),
        ("ept-hierarchy/0-0-0-0.json", root.into_bytes()),
        ("ept-hierarchy/1-1-1-0.json", page.into_bytes()),
    ];
    files.extend(nodes.iter().map(|(name, cloud)| (*name, file(name, cloud))));
    files
}

fn sorted(cloud: &PointCloud) -> Vec<[i64; 3]> {
    let steps = |p: &[f32; 3]| cloud.frame.to_file_coordinates(*p).map(|v| (v * 1000.0).round() as i64);
    let mut all: Vec<[i64; 3]> = cloud.positions.iter().map(steps).collect();
    all.sort_unstable();
    all
}

#[test]
fn entwine_point_tiles_are_read_here_and_over_the_web() {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in ept() {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, bytes).unwrap();
    }
    let server = WebServer::start(ept(), Manner::Parts);
    let keyed = WebServer::start(ept(), Manner::Keyed);
    let expected = sorted(&cloud(900));
    let low = [154_955.0, 462_955.0, -10.0];
    let within = Within::File { low, high: [154_990.0, 462_990.0, 100.0] };
    let window = ReadOptions::new().with_points_within(within);
    let in_window =
        |p: &&[i64; 3]| (154_955_000..=154_990_000).contains(&p[0]) && (462_955_000..=462_990_000).contains(&p[1]);
    let part: Vec<[i64; 3]> = expected.iter().filter(in_window).copied().collect();
    assert!(part.len() > 50 && part.len() < 300, "{}", part.len());
    let paths = [
        folder.path().to_owned(),
        folder.path().join("ept.json"),
        server.address("ept.json").into(),
        (keyed.address("ept.json") + KEY).into(),
        (keyed.address("ept.json") + KEY + "#part").into(),
    ];
    for path in paths {
        let (all, report) = read(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        assert_eq!((sorted(&all), all.frame.crs.epsg), (expected.clone(), Some(28_992)), "{}", path.display());
        assert_eq!((all.frame.crs.vertical_epsg, report.files.len()), (Some(5709), 5));
        let (requests, bytes) = server.sent();
        let (found, report) = read_cloud([&path], &window, &Control::none()).unwrap();
        assert_eq!(sorted(&found), part, "{}", path.display());
        // the root and the south-west; the page of the north-east is not even read
        assert_eq!(report.files.len(), 2, "{}", path.display());
        assert!(server.sent().0 - requests < 12 && server.sent().1 - bytes < 20_000, "{:?}", server.sent());
        let nodes = cloud_files(&[path]).unwrap();
        assert_eq!((nodes.len(), read_las_head(&nodes[4]).unwrap().crs.epsg), (5, Some(28_992)));
    }
}

#[test]
fn entwine_point_tiles_that_are_damaged_are_named() {
    let with = |name: &str, from: &str, to: &str| {
        let folder = tempfile::tempdir().unwrap();
        for (own, bytes) in ept() {
            let path = folder.path().join(own);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            let text = String::from_utf8_lossy(&bytes).replace(from, to);
            std::fs::write(path, if own == name { text.into_bytes() } else { bytes }).unwrap();
        }
        read(folder.path()).unwrap_err().to_string()
    };
    for (name, from, to, expected) in [
        ("ept.json", "laszip", "binary", "only laszip is read"),
        ("ept.json", "\"bounds\": [", "\"bounds\": [7, ", "`bounds`"),
        ("ept.json", "{", "", "not readable JSON"),
        ("ept-hierarchy/0-0-0-0.json", "1-0-1-0", "1-0-1", "node 1-0-1"),
        ("ept-hierarchy/0-0-0-0.json", "\"1-0-1-0\": ", "\"1-0-1-0\": -", "node 1-0-1-0 with -"),
        ("ept-hierarchy/1-1-1-0.json", "1-1-1-0", "../../secret", "node ../../secret"),
        ("ept-hierarchy/1-1-1-0.json", "{\"1-1-1-0\": ", "[", "is not readable JSON"),
    ] {
        let what = with(name, from, to);
        assert!(what.contains(expected), "{expected}: {what}");
    }
}

/// A PTX file of two scans of two points, the second with these rows of its matrix.
pub(crate) fn ptx(rows: [&str; 4]) -> String {
    let head = "2\n1\n10 20 30\n1 0 0\n0 1 0\n0 0 1\n";
    let points = "1 0 0 0.5\n2 1 0 0.5\n";
    format!("{head}1 0 0 0\n0 1 0 0\n0 0 1 0\n10 20 30 1\n{points}{head}{}\n{points}", rows.join("\n"))
}

#[test]
fn scans_of_ptx_with_a_pose_that_is_no_rotation_are_refused() {
    let turned = ["0.8 0.6 0 0", "-0.6 0.8 0 0", "0 0 1 0", "10 20 30 1"];
    assert_eq!(read_bytes("a.ptx", ptx(turned).as_bytes()).unwrap().0.len(), 4);
    for (row, text, expected) in [
        (2, "0 0 0 0", "flat"),
        (2, "0 0 -1 0", "mirrors"),
        (2, "0 0 2 0", "scales by 1.0000, 1.0000 and 2.0000"),
        (1, "0 1 0 0", "shears"),
        (1, "nan 0.8 0 0", "not finite"),
        (3, "10 inf 30 1", "not finite"),
        (0, "0.8 0.6 0 10", "last column"),
        (3, "10 20 30 0", "last column"),
    ] {
        let mut rows = turned;
        rows[row] = text;
        let what = error("a.ptx", &ptx(rows));
        assert!(what.contains("scan 2: its transformation, in lines 19 to 22,") && what.contains(expected), "{what}");
    }
    let zero = error("a.ptx", &ptx(["0 0 0 0", "0 0 0 0", "0 0 0 0", "0 0 0 1"]));
    assert!(zero.contains("is zero"), "{zero}");
}

/// An E57 file of one scan of two points with this pose.
fn e57([w, x, y, z]: [f64; 4], shift: [f64; 3]) -> Vec<u8> {
    let mut cursor = std::io::Cursor::new(Vec::new());
    let mut writer = e57::E57Writer::new(&mut cursor, "file").unwrap();
    let double = e57::RecordDataType::Double { min: None, max: None };
    let axes = [e57::RecordName::CartesianX, e57::RecordName::CartesianY, e57::RecordName::CartesianZ];
    let prototype = axes.map(|name| e57::Record { name, data_type: double.clone() }).to_vec();
    let mut scan = writer.add_pointcloud("scan", prototype).unwrap();
    scan.set_name(Some("Hall".to_owned()));
    scan.set_transform(Some(e57::Transform {
        rotation: e57::Quaternion { w, x, y, z },
        translation: e57::Translation { x: shift[0], y: shift[1], z: shift[2] },
    }));
    for point in [[1.0, 0.0, 0.0], [2.0, 1.0, 0.0]] {
        scan.add_point(point.map(e57::RecordValue::Double).to_vec()).unwrap();
    }
    scan.finalize().unwrap();
    writer.finalize().unwrap();
    drop(writer);
    cursor.into_inner()
}

#[test]
fn scans_of_e57_with_a_pose_that_is_no_rotation_are_refused_or_noted() {
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let (cloud, report) = read_bytes("a.e57", &e57([half, 0.0, 0.0, half], [10.0, 20.0, 30.0])).unwrap();
    assert_eq!(cloud.len(), 2);
    assert!(report.files[0].notes.is_empty(), "{:?}", report.files[0].notes);
    let (longer, report) = read_bytes("a.e57", &e57([1.0, 0.0, 0.0, 1.0], [10.0, 20.0, 30.0])).unwrap();
    assert_eq!(longer.positions, cloud.positions);
    let notes = &report.files[0].notes;
    assert!(notes.iter().any(|note| note.contains("scan 1 (\"Hall\")") && note.contains("1.4142")), "{notes:?}");
    for (rotation, shift, expected) in [
        ([0.0; 4], [0.0; 3], "rotation of zeros"),
        ([f64::NAN, 0.0, 0.0, 0.0], [0.0; 3], "not finite"),
        ([1.0, 0.0, 0.0, 0.0], [0.0, f64::INFINITY, 0.0], "not finite"),
    ] {
        let what = read_bytes("a.e57", &e57(rotation, shift)).map(|(cloud, _)| cloud.len()).unwrap_err().to_string();
        assert!(what.contains("scan 1 (\"Hall\")") && what.contains(expected), "{expected}: {what}");
    }
}
