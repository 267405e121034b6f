//! Meshes as other programs and bad luck make them: faces that wind around themselves, city models in sequences, lines
//! that go on, numbers with commas.

use std::time::Instant;

use belvedere_data::{Mesh, Result};
use belvedere_io::{MeshReport, Source, read_mesh};

/// Duration that only work without end reaches, on any machine, in seconds: most files take milliseconds.
const SECONDS: f64 = 120.0;

fn read(name: &str, text: &str) -> Result<(Mesh, MeshReport)> {
    let start = Instant::now();
    let found = read_mesh(Source::bytes(name, text.as_bytes()));
    let seconds = start.elapsed().as_secs_f64();
    assert!(seconds < SECONDS, "{name} of {} bytes: {seconds} s", text.len());
    found
}

fn error(name: &str, text: &str) -> String {
    read(name, text).map(|(mesh, _)| mesh.triangles.len()).unwrap_err().to_string()
}

/// A mesh of one face in each format.
fn one_face(vertices: &[[f64; 3]], corners: &[usize]) -> [(&'static str, String); 3] {
    let join = |numbers: Vec<String>, by: &str| numbers.join(by);
    let words = |p: &[f64; 3]| p.iter().map(ToString::to_string).collect::<Vec<_>>();
    let all = |by: &str, first: usize| join(corners.iter().map(|i| (i + first).to_string()).collect(), by);
    let obj = vertices.iter().map(|p| format!("v {}\n", join(words(p), " "))).collect::<String>();
    let ply = vertices.iter().map(|p| join(words(p), " ") + "\n").collect::<String>();
    let city = join(vertices.iter().map(|p| format!("[{}]", join(words(p), ","))).collect(), ",");
    [
        ("face.obj", format!("{obj}f {}\n", all(" ", 1))),
        (
            "face.ply",
            format!(
                "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty double z\nelement face 1\n\
                 property list int int vertex_indices\nend_header\n{ply}{} {}\n",
                vertices.len(),
                corners.len(),
                all(" ", 0)
            ),
        ),
        (
            "face.city.json",
            format!(
                "{{\"type\":\"CityJSON\",\"version\":\"1.0\",\"CityObjects\":{{\"a\":{{\"type\":\"Building\",\"geometry\":[{{\
                 \"type\":\"MultiSurface\",\"lod\":2,\"boundaries\":[[[{}]]]}}]}}}},\"vertices\":[{city}]}}",
                all(",", 0)
            ),
        ),
    ]
}

/// Places on a circle of 10 m, which stands upright.
fn circle(count: usize, turns: f64) -> Vec<[f64; 3]> {
    let at = |i: usize| turns * std::f64::consts::TAU * i as f64 / count as f64;
    (0..count).map(|i| [10.0 * at(i).cos(), 5.0, 10.0 * at(i).sin()]).collect()
}

#[test]
fn corners_that_repeat_are_passed_once() {
    let triangle = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let again: Vec<usize> = (0..3000).map(|i| i % 3).collect();
    // the same places under other numbers
    let copies: Vec<[f64; 3]> = again.iter().map(|&i| triangle[i]).collect();
    let numbers: Vec<usize> = (0..copies.len()).collect();
    let decagon: Vec<usize> = (0..30_000).map(|i| i % 10).collect();
    for (vertices, corners, triangles) in
        [(&triangle[..], &again, 1), (&copies, &numbers, 1), (&circle(10, 1.0), &decagon, 8)]
    {
        for (name, text) in one_face(vertices, corners) {
            let (mesh, report) = read(name, &text).unwrap();
            assert_eq!((mesh.triangles.len(), report.repeated_polygon_count), (triangles, 1), "{name}");
        }
    }
}

#[test]
fn faces_of_many_corners_take_no_longer_than_they_must() {
    let around = |count: usize| (0..count).collect::<Vec<_>>();
    let zigzag: Vec<[f64; 3]> =
        (0..3000).map(|i| [f64::from(i * 7919 % 3000), f64::from(i % 2 * (i + 9)), 0.0]).collect();
    let star: Vec<[f64; 3]> = circle(3000, 1.0);
    let across: Vec<usize> = (0..3000).map(|i| i * 1499 % 3000).collect();
    let line: Vec<[f64; 3]> = (0..3000).map(|i| [f64::from(i * 7919 % 3000), 0.0, 0.0]).collect();
    for (vertices, corners, expected) in [
        (zigzag, around(3000), "crosses itself"),
        (star, across, "crosses itself"),
        (line, around(3000), "no triangle"),
    ] {
        for (name, text) in one_face(&vertices, &corners) {
            let what = error(name, &text);
            assert!(what.contains(expected) && what.starts_with(name), "{what}");
        }
    }
    for (name, text) in one_face(&circle(20_000, 1.0), &around(20_000)) {
        assert_eq!(read(name, &text).unwrap().0.triangles.len(), 19_998, "{name}");
    }
    let what = error("large.obj", &one_face(&circle(20_001, 1.0), &around(20_001))[0].1);
    assert!(what.contains("line 20002: a face has 20001 corners; split it"), "{what}");
    // a bow, of few corners, gives what it has
    let bow = [[0.0, 0.0, 0.0], [2.0, 2.0, 0.0], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    assert!(read("bow.obj", &one_face(&bow, &around(4))[0].1).is_ok());
}

const BOX: &str = "v 155040 463040 10\nv 155050 463040 10\nv 155040 463050 10\nv 155050 463050 10\n\
v 155040 463040 22\nv 155050 463040 22\nv 155040 463050 22\nv 155050 463050 22\n";

#[test]
fn a_backslash_continues_a_line_of_obj() {
    let faces = "f 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
    let (plain, _) = read("box.obj", &format!("{BOX}f 1 3 4 2\n{faces}")).unwrap();
    for first in ["f 1 3 \\\n4 2\n", "f \\\r\n1 \\  \r\n3 4\\\n2\n", "f 1 3\\\n\\\n 4 2 # the ground\n"] {
        let (mesh, _) = read("box.obj", &format!("{BOX}{first}{faces}")).unwrap();
        assert_eq!((&mesh.vertices, &mesh.triangles), (&plain.vertices, &plain.triangles), "{first}");
    }
    // the last line goes on to nowhere; a file of nothing else is no more than empty
    assert_eq!(read("box.obj", &format!("{BOX}{faces}f 1 3 4 2\\")).unwrap().0.triangles.len(), 12);
    assert!(error("empty.obj", &"\\\n".repeat(300_000)).contains("no faces"));
}

#[test]
fn errors_of_obj_name_line_and_reason() {
    let faces = "f 1 3 4 2\n";
    for (text, words) in [
        (BOX.replace(" 10\n", ",000 10,000\n"), ["line 1", "decimal commas"]),
        (BOX.replace("v 155050 463040 10", "v 155050 463040"), ["line 2", "x, y and z"]),
        (BOX.replace("v 155050 463040 10", "v 155050 north 10"), ["line 2", "\"north\" is not a number"]),
        (BOX.replace("463050 10", "463050 nan"), ["line 3", "NaN"]),
        (BOX.replace("463050 10", "463050 1e300"), ["line 3", "below"]),
        (format!("{BOX}f 1 2 9\n"), ["line 9", "vertex 9, but there are only 8"]),
        (format!("{BOX}f 1 2 -9\n"), ["line 9", "vertex -9, but only 8"]),
        (format!("{BOX}f 0 1 2\n"), ["line 9", "counted from 1"]),
        (format!("{BOX}\n# roof\nf 1 2 roof\n"), ["line 11", "\"roof\" is not a corner"]),
        (format!("{BOX}f 1 2 99999999999999999999\n"), ["line 9", "not a corner"]),
    ] {
        let what = error("m.obj", &format!("{text}{faces}"));
        assert!(words.iter().all(|word| what.contains(word)) && what.starts_with("m.obj"), "{words:?}: {what}");
    }
    // faces may stand before their vertices, and lines of other kinds mean nothing here
    let (mesh, _) = read("m.obj", &format!("mtllib a.mtl\nvn 0 0 1\n{faces}l 1 2\np 1\ns off\n{BOX}")).unwrap();
    assert_eq!(mesh.triangles.len(), 2);
    let utf16: Vec<u8> = format!("\u{feff}{BOX}{faces}").encode_utf16().flat_map(u16::to_le_bytes).collect();
    assert_eq!(read_mesh(Source::bytes("m.obj", &utf16)).unwrap().0.triangles.len(), 2);
}

/// A city of two boxes of 10 x 10 x 12 m as a sequence: each feature has its own vertices.
fn sequence() -> String {
    let head = r#"{"type": "CityJSON", "version": "2.0", "CityObjects": {}, "vertices": [],
        "transform": {"scale": [0.001, 0.001, 0.001], "translate": [155000, 463000, 0]},
        "metadata": {"referenceSystem": "https://www.opengis.net/def/crs/EPSG/0/7415"}}"#
        .replace('\n', " ");
    let feature = |name: &str, x: i32| {
        let corner = |i: i32| format!("[{}, {}, {}]", x + i % 2 * 10_000, 40_000 + i / 2 % 2 * 10_000, i / 4 * 12_000);
        let vertices = (0..8).map(corner).collect::<Vec<_>>().join(", ");
        format!(
            r#"{{"type": "CityJSONFeature", "id": "{name}", "CityObjects": {{"{name}": {{"type": "Building", "geometry": [{{"type": "Solid",
            "lod": "2.2", "boundaries": [[[[0, 2, 3, 1]], [[4, 5, 7, 6]], [[0, 1, 5, 4]], [[2, 6, 7, 3]], [[0, 4, 6, 2]], [[1, 3, 7, 5]]]]}}]}}}},
            "vertices": [{vertices}]}}"#
        )
        .replace('\n', " ")
    };
    format!("{head}\n{}\r\n\n{}\n", feature("b1", 40_000), feature("b2", 80_000))
}

#[test]
fn a_sequence_of_city_features_is_one_city() {
    // roofer and others name them .city.jsonl; the content decides
    for name in ["a.city.jsonl", "a.jsonl", "a.city.json"] {
        let (mesh, report) = read(name, &sequence()).unwrap();
        assert_eq!((mesh.triangles.len(), report.polygon_count, mesh.crs.epsg), (24, 12, Some(7415)), "{name}");
        assert_eq!(mesh.object_names, ["b1", "b2"]);
        assert!((mesh.area() - 2.0 * (2.0 * 100.0 + 4.0 * 120.0)).abs() < 1e-6);
        let east = mesh.vertices.iter().map(|v| v[0]).fold(0.0, f64::max);
        assert!((east - 155_090.0).abs() < 1e-6);
    }
    let cut = sequence();
    for (text, expected) in [
        (cut[..cut.len() - 40].to_owned(), "not readable JSON"),
        (cut.replace("CityJSONFeature", "Feature"), "object 2 of the sequence is no CityJSONFeature"),
        (cut.lines().skip(1).collect::<Vec<_>>().join("\n"), "not CityJSON"),
        // a vertex of the other feature is none
        (cut.replace("[[0, 2, 3, 1]]", "[[0, 2, 8, 1]]"), "missing vertex 8"),
    ] {
        let what = error("a.city.jsonl", &text);
        assert!(what.contains(expected), "{expected}: {what}");
    }
}

#[test]
fn a_mesh_has_the_system_beside_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("plan.obj");
    std::fs::write(&path, format!("{BOX}f 1 3 4 2\n")).unwrap();
    assert_eq!(read_mesh(&path).unwrap().0.crs.epsg, None);
    std::fs::write(folder.path().join("plan.prj"), "EPSG:28992").unwrap();
    let (mesh, _) = read_mesh(&path).unwrap();
    assert_eq!(mesh.crs.epsg, Some(28_992));
    let french = belvedere_data::crs::Crs::from_epsg(2154).unwrap();
    assert!(belvedere_io::read_mesh_in(&path, &french).unwrap_err().to_string().contains("2154"));
}
