//! Inputs that contradict themselves or the files beside them: each contradiction is reported or refused, and
//! consistent inputs are read in silence. Numbers of points and bounds are known from the making of the inputs.

use std::io::{Cursor, Read, Write};
use std::path::Path;

use belvedere_data::control::Control;
use belvedere_data::model::ModelParts;
use belvedere_data::{Bounds, Frame};
use belvedere_io::{
    Output, ReadOptions, Source, Within, read_balls, read_cloud, read_las_head, read_table, write_balls,
};

use crate::hostile_input::e57;
use crate::odd_clouds::{ept, ptx};
use crate::sources::{cloud, file};

/// Keys of the contradictions reported for a source, or the error.
fn said<'a>(source: impl Into<Source<'a>>, options: &ReadOptions) -> Result<Vec<&'static str>, String> {
    match read_cloud([source.into()], options, &Control::none()) {
        Ok((_, report)) => Ok(report.contradictions().iter().map(|found| found.row.key).collect()),
        Err(error) => Err(error.to_string()),
    }
}

fn said_of(name: &str, bytes: &[u8]) -> Result<Vec<&'static str>, String> {
    said(Source::bytes(name, bytes), &ReadOptions::default())
}

/// Expected result of an input with this name: a key, words of an error, or nothing.
#[derive(Debug)]
enum Expected {
    Key(&'static str),
    Refused(&'static str),
    Nothing,
}

fn check(name: &str, found: Result<Vec<&'static str>, String>, expected: &Expected) {
    match (expected, found) {
        (Expected::Key(key), Ok(keys)) => assert_eq!(keys.first(), Some(key), "{name}: {keys:?}"),
        (Expected::Refused(words), Err(error)) => assert!(error.contains(words), "{name}: {error}"),
        (Expected::Nothing, Ok(keys)) => assert!(keys.is_empty(), "{name}: {keys:?}"),
        (expected, found) => panic!("{name}: {expected:?}, but {found:?}"),
    }
}

/// A folder of entwine point tiles, of which texts of some files are replaced.
fn ept_with(changes: &[(&str, &str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in ept() {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        let mut bytes = bytes;
        for (_, from, to) in changes.iter().filter(|(changed, ..)| *changed == name) {
            let text = String::from_utf8(bytes).unwrap();
            assert!(text.contains(from), "{name} has no {from}");
            bytes = text.replace(from, to).into_bytes();
        }
        std::fs::write(path, bytes).unwrap();
    }
    folder
}

/// The cube of all points in the description, and others of the same side.
const CUBE: &str = "[154936, 462936, -50, 155064";
const FAR_CUBE: &str = "[164936, 462936, -50, 165064";
const ROOT_PAGE: &str = "ept-hierarchy/0-0-0-0.json";

#[test]
fn hierarchies_of_point_tiles_are_compared_with_their_files() {
    let count = |name: &str| {
        let bytes = ept().into_iter().find(|(own, _)| own.contains(name)).unwrap().1;
        read_las_head(Source::bytes("a.laz", &bytes)).unwrap().points
    };
    let (first, west) = (count("0-0-0-0.laz"), count("1-0-0-0.laz"));
    let entry = format!("\"1-0-0-0\": {west}, ");
    let (fewer, more) = (format!("\"1-0-0-0\": {}, ", west / 2), format!("\"1-0-0-0\": {}, ", west + 7));
    let root = format!("\"0-0-0-0\": {first}");
    let renamed = ("ept.json", "\"points\": 900", "\"points\": 907");
    let cases = [
        ("as it is", vec![], Expected::Nothing),
        ("a node is missing", vec![(ROOT_PAGE, entry.as_str(), "")], Expected::Key("hierarchy-points")),
        ("a page is missing", vec![(ROOT_PAGE, "\"1-1-1-0\": -1, ", "")], Expected::Key("hierarchy-points")),
        ("a count is too low", vec![(ROOT_PAGE, &entry, &fewer)], Expected::Key("hierarchy-points")),
        ("a count is too high", vec![(ROOT_PAGE, &entry, &more), renamed], Expected::Key("announced-points")),
        ("more than announced", vec![(ROOT_PAGE, &entry, &more)], Expected::Refused("more points than the 900")),
        ("a page without its node", vec![(ROOT_PAGE, &root, "\"2-0-0-0\": 0")], Expected::Refused("no points of node")),
        (
            "a page that goes on",
            vec![("ept-hierarchy/1-1-1-0.json", "1-1-1-0", "2-2-2-0")],
            Expected::Refused("no points"),
        ),
        ("the cube lies beside", vec![("ept.json", CUBE, FAR_CUBE)], Expected::Key("announced-bounds")),
    ];
    for (name, changes, expected) in cases {
        check(name, said(ept_with(&changes).path(), &ReadOptions::default()), &expected);
    }
    // a box of wrong bounds would miss points
    let within = Within::File { low: [154_955.0, 462_955.0, -10.0], high: [154_990.0, 462_990.0, 100.0] };
    let window = ReadOptions::new().with_points_within(within);
    for (from, to, expected) in [
        (CUBE, CUBE, Expected::Nothing),
        (CUBE, FAR_CUBE, Expected::Refused("`bounds`")),
        (CUBE, "[154970, 462936, -50, 155098", Expected::Refused("`bounds`")),
    ] {
        check(to, said(ept_with(&[("ept.json", from, to)]).path(), &window), &expected);
    }
    // a file that is not that of its node
    let folder = ept_with(&[]);
    std::fs::write(folder.path().join("ept-data/1-0-0-0.laz"), file("a.laz", &cloud(12))).unwrap();
    check("another file", said(folder.path(), &ReadOptions::default()), &Expected::Key("announced-points"));
    std::fs::remove_file(folder.path().join("ept-data/1-0-0-0.laz")).unwrap();
    check("no file", said(folder.path(), &ReadOptions::default()), &Expected::Refused("1-0-0-0.laz"));
}

/// A catalogue of one tile with this box and count.
fn catalogue(folder: &Path, bounds: &str, count: &str) -> std::path::PathBuf {
    let text = format!(
        r#"{{"type": "FeatureCollection", "features": [{{"type": "Feature", "properties": {{"pc:count": {count}, "proj:bbox": {bounds}}},
        "assets": {{"data": {{"href": "./tile.laz"}}}}}}]}}"#
    );
    let path = folder.join("all.vpc");
    std::fs::write(&path, text).unwrap();
    path
}

#[test]
fn catalogues_are_compared_with_the_headers_of_their_tiles() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("tile.laz"), file("tile.laz", &cloud(300))).unwrap();
    let around = "[154949, 462949, -1, 155051, 463051, 30]";
    for (bounds, count, expected) in [
        (around, "300", Expected::Nothing),
        ("[154949, 462949, 155051, 463051]", "null", Expected::Nothing),
        (around, "299", Expected::Key("announced-points")),
        (around, "0", Expected::Key("announced-points")),
        ("[154949, 462949, 155001, 463051]", "300", Expected::Key("announced-bounds")),
        ("[4.3, 52.0, 4.4, 52.1]", "300", Expected::Key("announced-bounds")),
        ("[154949, 462949, -1, 155051, 463051, 3]", "300", Expected::Key("announced-bounds")),
    ] {
        check(bounds, said(catalogue(folder.path(), bounds, count).as_path(), &ReadOptions::default()), &expected);
    }
}

/// A file whose header counts so many points.
fn with_count(mut bytes: Vec<u8>, count: u32) -> Vec<u8> {
    bytes[107..111].copy_from_slice(&count.to_le_bytes());
    if bytes[25] >= 4 {
        bytes[247..255].copy_from_slice(&u64::from(count).to_le_bytes());
    }
    bytes
}

#[test]
fn files_with_more_points_than_their_header_counts_are_said() {
    let las = file("a.las", &cloud(1000));
    let laz = file("a.laz", &cloud(120_000));
    let cases = [
        ("a.las", las.clone(), Expected::Nothing),
        ("a.las", with_count(las.clone(), 500), Expected::Key("points-not-counted")),
        ("a.las", with_count(las.clone(), 999), Expected::Key("points-not-counted")),
        ("a.las", with_count(las.clone(), 0), Expected::Refused("its writer was interrupted")),
        // room that a writer reserved is no point
        ("a.las", [las, vec![0; 1 << 12]].concat(), Expected::Nothing),
        ("a.laz", laz.clone(), Expected::Nothing),
        ("a.laz", with_count(laz.clone(), 50_000), Expected::Key("points-not-counted")),
        ("a.laz", with_count(laz, 0), Expected::Refused("its writer was interrupted")),
    ];
    for (name, bytes, expected) in cases {
        check(name, said_of(name, &bytes), &expected);
    }
    let head = read_las_head(Source::bytes("a.las", &with_count(file("a.las", &cloud(1000)), 400))).unwrap();
    assert_eq!((head.points, head.contradictions[0].row.key), (400, "points-not-counted"));
    assert_eq!(head.contradictions[0].numbers, [("counted", 400.0), ("beyond", 600.0)]);
}

/// CRC-32C of a page of an E57 file (Castagnoli, reflected).
fn crc32c(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |crc, _| crc >> 1 ^ if crc & 1 == 1 { 0x82F6_3B78 } else { 0 })
    })
}

#[test]
fn e57_scans_with_more_points_than_they_count_are_said() {
    let whole = e57();
    check("a.e57", said_of("a.e57", &whole), &Expected::Nothing);
    let text = |bytes: &[u8], wanted: &[u8]| bytes.windows(wanted.len()).position(|own| own == wanted);
    let at = text(&whole, b"recordCount=\"60\"").unwrap();
    let mut half = whole;
    half[at + 13..at + 15].copy_from_slice(b"30");
    for page in half.chunks_exact_mut(1024) {
        let sum = crc32c(&page[..1020]);
        page[1020..].copy_from_slice(&sum.to_be_bytes());
    }
    check("half of a.e57", said_of("a.e57", &half), &Expected::Key("points-not-counted"));
}

#[test]
fn columns_of_one_name_are_said_and_a_plain_name_stands_above_others() {
    let pcd = |fields: &str, rows: &str| {
        let count = fields.split(' ').count();
        let each = |word: &str| vec![word; count].join(" ");
        format!(
            "VERSION .7\nFIELDS {fields}\nSIZE {}\nTYPE {}\nCOUNT {}\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA ascii\n{rows}",
            each("4"),
            each("F"),
            each("1")
        )
    };
    let ply = |properties: &[&str], rows: &str| {
        let lines: String = properties.iter().map(|name| format!("property float {name}\n")).collect();
        format!("ply\nformat ascii 1.0\nelement vertex 2\n{lines}end_header\n{rows}")
    };
    let four = "1 2 3 9\n4 5 6 9\n";
    for (name, text, expected) in [
        ("a.xyz", format!("x y z z\n{four}"), Expected::Key("column-twice")),
        ("a.csv", format!("X,Y,Z,Intensity,intensity\n1,2,3,4,5\n{}", "4,5,6,7,8\n"), Expected::Key("column-twice")),
        ("a.xyz", format!("x y z height\n{four}"), Expected::Nothing),
        ("a.pcd", pcd("x y z z", four), Expected::Key("column-twice")),
        ("a.pcd", pcd("x y z altitude", four), Expected::Nothing),
        ("a.ply", ply(&["x", "y", "z", "z"], four), Expected::Refused("two properties z")),
        ("a.ply", ply(&["x", "y", "z", "height"], four), Expected::Nothing),
    ] {
        check(&text, said_of(name, text.as_bytes()), &expected);
    }
    let heights = |name: &str, text: &str| {
        let (cloud, _) =
            read_cloud([Source::bytes(name, text.as_bytes())], &ReadOptions::new(), &Control::none()).unwrap();
        cloud.positions.iter().map(|&p| cloud.frame.to_file_coordinates(p)[2]).collect::<Vec<_>>()
    };
    let swapped = "9 1 2 3\n9 4 5 6\n";
    for (name, text) in [
        ("a.xyz", format!("x y z z\n{four}")),
        ("a.xyz", format!("x y z height\n{four}")),
        ("a.xyz", format!("height x y z\n{swapped}")),
        ("a.pcd", pcd("height x y z", swapped)),
        ("a.ply", ply(&["x", "y", "z", "elevation"], four)),
        ("a.ply", ply(&["elevation", "x", "y", "z"], swapped)),
    ] {
        assert_eq!(heights(name, &text), [3.0, 6.0], "{text}");
    }
    let table = read_table(Source::bytes("a.csv", b"x,y,x\n1,2,3\n")).unwrap();
    assert!(table.column(Path::new("a.csv"), "y").unwrap().is_some());
    let error = table.column(Path::new("a.csv"), "x").unwrap_err().to_string();
    assert!(error.contains("two columns x"), "{error}");
}

#[test]
fn the_head_of_a_scan_is_compared_with_its_matrix() {
    // the scanner stands at 10, 20, 30 by the head
    let level = ["1 0 0 0", "0 1 0 0", "0 0 1 0"];
    for (rows, expected) in [
        ([level[0], level[1], level[2], "10 20 30 1"], Expected::Nothing),
        ([level[0], level[1], level[2], "10 20.005 30 1"], Expected::Nothing),
        ([level[0], level[1], level[2], "10 20 31 1"], Expected::Key("scan-pose")),
        ([level[0], level[1], level[2], "0 0 0 1"], Expected::Key("scan-pose")),
        (["0.8 0.6 0 0", "-0.6 0.8 0 0", level[2], "10 20 30 1"], Expected::Key("scan-pose")),
    ] {
        check(rows[3], said_of("a.ptx", ptx(rows).as_bytes()), &expected);
    }
    // a head that was not filled says nothing
    let unfilled = ptx([level[0], level[1], level[2], "10 20 30 1"]).replace("\n10 20 30\n", "\n0 0 0\n");
    check("no head", said_of("a.ptx", unfilled.as_bytes()), &Expected::Nothing);
}

#[test]
fn balls_that_lost_their_metadata_are_said() {
    let parts = ModelParts {
        frame: Frame { origin: [155_000.0, 463_000.0, 0.0], ..cloud(1).frame },
        bounds: Bounds { low: [-9.0; 3], high: [9.0; 3] },
        ..ModelParts::default()
    };
    let mut whole = Cursor::new(Vec::new());
    write_balls(Output::writer("balls.npz", &mut whole), &parts).unwrap();
    assert_eq!(read_balls(Source::bytes("balls.npz", whole.get_ref())).unwrap().frame.crs.doubt, None);
    let mut archive = zip::ZipArchive::new(whole).unwrap();
    let mut less = zip::ZipWriter::new(Cursor::new(Vec::new()));
    for index in 0..archive.len() {
        let mut entry = archive.by_index(index).unwrap();
        let (name, mut bytes) = (entry.name().to_owned(), Vec::new());
        if name != "metadata.npy" {
            entry.read_to_end(&mut bytes).unwrap();
            less.start_file(name, zip::write::SimpleFileOptions::default()).unwrap();
            less.write_all(&bytes).unwrap();
        }
    }
    let less = less.finish().unwrap().into_inner();
    let doubt = read_balls(Source::bytes("balls.npz", &less)).unwrap().frame.crs.doubt.unwrap_or_default();
    assert!(doubt.contains("lost its metadata"), "{doubt}");
}
