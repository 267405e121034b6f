//! Meshes from files: closed forms for what is read, clear errors for what cannot be.
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::PathBuf;

use belvedere::io::{LevelOfDetail, read_cityjson};
use belvedere::io::{MeshReport, Source, read_mesh};
use belvedere::{Error, Mesh, Result};

fn read(name: &str, bytes: impl AsRef<[u8]>) -> Result<(Mesh, MeshReport)> {
    read_mesh(Source::bytes(name, bytes.as_ref()))
}

fn doubled_area_vector(mesh: &Mesh, index: usize) -> [f64; 3] {
    let [a, b, c] = mesh.corners(index).unwrap();
    let [u, v]: [[f64; 3]; 2] = [std::array::from_fn(|i| b[i] - a[i]), std::array::from_fn(|i| c[i] - a[i])];
    [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
}

/// Surface area, m².
fn area(mesh: &Mesh) -> f64 {
    (0..mesh.triangles.len())
        .map(|i| doubled_area_vector(mesh, i).map(|v| v * v).iter().sum::<f64>().sqrt() / 2.0)
        .sum()
}

/// Enclosed volume, positive where faces turn counter-clockwise seen from outside, m³.
fn volume(mesh: &Mesh) -> f64 {
    let base = mesh.vertices[0];
    (0..mesh.triangles.len())
        .map(|i| {
            let (n, a) = (doubled_area_vector(mesh, i), mesh.corners(i).unwrap()[0]);
            (0..3).map(|k| n[k] * (a[k] - base[k])).sum::<f64>() / 6.0
        })
        .sum()
}

const BOX_OBJ: &str = "mtllib missing.mtl\no house\nusemtl wall\nv 85000 447000 0\nv 85002 447000 0\nv 85002 447003 0\nv 85000 447003 0\n\
v 85000 447000 4\nv 85002 447000 4\nv 85002 447003 4\nv 85000 447003 4\nf 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nusemtl roof\nf 2 3 7 6\n\
o shed\nf 3 4 8 7\nf -8 -4 -1 -5\n";

#[test]
fn an_obj_box_in_national_coordinates_keeps_its_volume() {
    let (mesh, report) = read("box.obj", BOX_OBJ).unwrap();
    assert!((area(&mesh) - 52.0).abs() < 1e-9 && (volume(&mesh) - 24.0).abs() < 1e-9);
    assert_eq!((mesh.triangles.len(), report.polygon_count), (12, 6));
    assert_eq!(mesh.object_names, ["house", "shed"]);
    assert_eq!(mesh.objects, [0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1]);
}

#[test]
fn concave_and_degenerate_polygons_are_handled() {
    // an L, standing upright, whose fan from the first corner would leave it
    let l = "v 0 0 0\nv 2 0 0\nv 2 0 1\nv 1 0 1\nv 1 0 3\nv 0 0 3\nv 5 0 0\n";
    let (mesh, _) = read("l.obj", format!("{l}f 3 4 5 6 1 2\n")).unwrap();
    assert!((area(&mesh) - 4.0).abs() < 1e-12);
    assert!((0..4).all(|i| doubled_area_vector(&mesh, i)[1] < 0.0));
    assert!(mesh.objects.is_empty() && mesh.object_names.is_empty());
    let (mesh, report) = read("l.obj", format!("{l}f 1 2 3\nf 1 2 7\nf 1 1 2\nf 1 2 7 2\n")).unwrap();
    assert_eq!((mesh.triangles.len(), report.polygon_count, report.degenerate_polygon_count), (1, 4, 3));
    assert_eq!(mesh.triangles.len() + report.degenerate_triangle_count, 2);
}

#[test]
fn ply_of_every_encoding_is_the_same_mesh() {
    let vertices = [[0.0_f32, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0], [1.0, 1.0, 3.0]];
    let faces: [&[i32]; 5] = [&[3, 2, 1, 0], &[0, 1, 4], &[1, 2, 4], &[2, 3, 4], &[3, 0, 4]];
    let header = |format: &str| {
        format!(
            "ply\nformat {format} 1.0\ncomment a pyramid\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n\
             property uchar red\nelement face 5\nproperty list uchar int vertex_indices\nend_header\n"
        )
    };
    let mut text = header("ascii").into_bytes();
    let (mut little, mut big) = (header("binary_little_endian").into_bytes(), header("binary_big_endian").into_bytes());
    for v in vertices {
        text.extend(format!("{} {} {} 7\n", v[0], v[1], v[2]).bytes());
        for c in v {
            little.extend(c.to_le_bytes());
            big.extend(c.to_be_bytes());
        }
        little.push(7);
        big.push(7);
    }
    for face in faces {
        text.extend(format!("{} {}\n", face.len(), face.iter().map(|i| format!("{i} ")).collect::<String>()).bytes());
        little.push(u8::try_from(face.len()).unwrap());
        big.push(u8::try_from(face.len()).unwrap());
        for i in face {
            little.extend(i.to_le_bytes());
            big.extend(i.to_be_bytes());
        }
    }
    for bytes in [&text, &little, &big] {
        let (mesh, _) = read("pyramid.ply", bytes).unwrap();
        assert_eq!((mesh.vertices.len(), mesh.triangles.len()), (5, 6));
        assert!((volume(&mesh) - 4.0).abs() < 1e-9);
        for cut in 0..bytes.len() - 2 {
            assert!(read("cut.ply", &bytes[..cut]).is_err(), "{cut}");
        }
    }
}

/// A 10 x 10 x 3 block with a 2 x 2 shaft through it, millimetre vertices, as a Solid of the version.
fn block_with_shaft(version: &str, lod: &str) -> String {
    let mut vertices = String::new();
    for z in [0, 3000] {
        for [x, y] in
            [[0, 0], [10_000, 0], [10_000, 10_000], [0, 10_000], [4000, 4000], [6000, 4000], [6000, 6000], [4000, 6000]]
        {
            vertices += &format!("[{x},{y},{z}],");
        }
    }
    format!(
        r#"{{"type":"CityJSON","version":"{version}","metadata":{{"referenceSystem":"https://www.opengis.net/def/crs/EPSG/0/7415"}},
        "transform":{{"scale":[0.001,0.001,0.001],"translate":[85000,447000,0]}},"vertices":[{}],
        "CityObjects":{{"block":{{"type":"Building","geometry":[
          {{"type":"MultiPoint","lod":{lod},"boundaries":[0]}},
          {{"type":"MultiSurface","lod":"0","boundaries":[[[0,1,2,3]]]}},
          {{"type":"Solid","lod":{lod},"boundaries":[[
          [[8,9,10,11],[12,15,14,13]], [[3,2,1,0],[4,5,6,7]],
          [[0,1,9,8]],[[1,2,10,9]],[[2,3,11,10]],[[3,0,8,11]],
          [[5,4,12,13]],[[6,5,13,14]],[[7,6,14,15]],[[4,7,15,12]]]]}}]}}}}}}"#,
        vertices.trim_end_matches(',')
    )
}

#[test]
fn cityjson_rings_with_holes_keep_their_volume() {
    for (version, lod) in [("1.0", "2"), ("1.1", "\"2.2\""), ("2.0", "\"2\"")] {
        let (mesh, report) = read("block.city.json", block_with_shaft(version, lod)).unwrap();
        assert!((volume(&mesh) - 288.0).abs() < 1e-6, "{}", volume(&mesh));
        assert!((area(&mesh) - (2.0 * 96.0 + 120.0 + 24.0)).abs() < 1e-6);
        assert_eq!((mesh.crs.epsg, mesh.object_names.as_slice()), (Some(7415), &["block".to_owned()][..]));
        assert_eq!((report.skipped_geometry_count, report.other_level_of_detail_count), (1, 1));
    }
}

#[test]
fn one_level_of_detail_can_be_requested() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("block.json");
    std::fs::write(&path, block_with_shaft("2.0", "\"2.2\"")).unwrap();
    let (mesh, _) = read_cityjson(&path, &LevelOfDetail::Only("0".to_owned())).unwrap();
    assert!((area(&mesh) - 100.0).abs() < 1e-9);
    assert!(read_cityjson(&path, &LevelOfDetail::Only("1".to_owned())).is_err());
    assert!(read_cityjson(&path, &LevelOfDetail::Only("high".to_owned())).is_err());
}

const TREES: &str = r#"{"type":"CityJSON","version":"1.1","transform":{"scale":[1,1,1],"translate":[100,0,0]},"vertices":[[0,0,0],[50,0,5]],
  "geometry-templates":{"templates":[{"type":"MultiSurface","lod":"3","boundaries":[[[0,2,1]],[[0,1,3]],[[1,2,3]],[[2,0,3]]]}],
    "vertices-templates":[[0,0,0],[1,0,0],[0,1,0],[0,0,1]]},
  "CityObjects":{"a":{"type":"SolitaryVegetationObject","geometry":[{"type":"GeometryInstance","template":0,"boundaries":[1],
      "transformationMatrix":[2,0,0,0, 0,2,0,0, 0,0,3,1, 0,0,0,1]}]},
    "b":{"type":"SolitaryVegetationObject","geometry":[{"type":"GeometryInstance","template":0,"boundaries":[0],
      "transformationMatrix":[-1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]}]}}}"#;

#[test]
fn templates_are_placed_scaled_and_mirrored() {
    let (mesh, _) = read("trees.cityjson", TREES).unwrap();
    assert_eq!(mesh.object_names, ["a", "b"]);
    assert_eq!((mesh.vertices.len(), mesh.triangles.len()), (10, 8));
    assert!(mesh.vertices.contains(&[152.0, 0.0, 6.0]) && mesh.vertices.contains(&[150.0, 0.0, 9.0]));
    // 2 x 2 x 3 / 6 and, outward though mirrored, 1 / 6
    assert!((volume(&mesh) - (2.0 + 1.0 / 6.0)).abs() < 1e-9, "{}", volume(&mesh));
}

#[test]
fn hostile_files_are_errors_and_never_panics() {
    let block = block_with_shaft("2.0", "\"2\"");
    let bad = [
        ("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n".to_owned()),
        ("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -9\n".to_owned()),
        ("a.obj", "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".to_owned()),
        ("a.obj", "v 0 0 1e300\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".to_owned()),
        ("a.obj", "f 0 0 0\n".to_owned()),
        ("a.obj", String::new()),
        ("a.ply", "ply\nformat ascii 1.0\nelement vertex 99999999999\nend_header\n".to_owned()),
        ("a.ply", "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\nend_header\n".to_owned()),
        ("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n3 0 0 -1\n".to_owned()),
        ("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n".to_owned()),
        ("a.json", block.replace("[0,1,9,8]", "[0,1,16,8]")),
        ("a.json", block.replace("[0,1,9,8]", "[0,1,-1,8]")),
        ("a.json", block.replace("[[0,1,9,8]]", "[0,1,9,8]")),
        ("a.json", block.replace("[[0,1,9,8]]", "7")),
        ("a.json", block.replace("[10000,0,0]", "[10000,null,0]")),
        ("a.json", block.replace("[10000,0,0]", "[10000,1e999,0]")),
        ("a.json", block.replace("\"2.0\"", "\"0.9\"")),
        ("a.json", TREES.replace("\"template\":0", "\"template\":5")),
        ("a.json", TREES.replace("[[0,2,1]]", "[[0,2,9]]")),
        ("a.json", TREES.replace("\"boundaries\":[1]", "\"boundaries\":[2]")),
        ("a.json", TREES.replace("[2,0,0,0, ", "[")),
        ("a.json", "[".repeat(10_000)),
        ("a.json", "{\"type\":\"FeatureCollection\"}".to_owned()),
    ];
    for (name, text) in bad {
        let error = read(name, &text).expect_err(&text);
        assert!(matches!(error, Error::Malformed { .. }), "{error}");
    }
    assert!(matches!(read("a.stl", ""), Err(Error::UnknownFormat { .. })));
    assert!(matches!(read_mesh(&PathBuf::from("nowhere.obj")), Err(Error::Io { .. })));
    for cut in 0..block.len() {
        let _ = read("a.json", &block.as_bytes()[..cut]);
    }
}

#[test]
fn mutated_files_never_panic() {
    let ply = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 2\n\
               property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n4 0 1 2 3\n";
    // a list that claims four thousand million corners
    let mut liar = ply.replace("ascii", "binary_little_endian").replace("uchar int", "uint int").into_bytes();
    liar.truncate(liar.windows(11).position(|w| w == b"end_header\n").unwrap() + 11);
    liar.extend([0; 48]);
    liar.extend([0xff; 4]);
    assert!(read("liar.ply", &liar).is_err());
    let mut state = 7_u32;
    let mut random = |below: usize| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as usize % below
    };
    let block = block_with_shaft("2.0", "\"2\"");
    for (name, text) in [("a.obj", BOX_OBJ), ("a.ply", ply), ("a.json", TREES), ("a.json", &block)] {
        for _ in 0..1500 {
            let mut bytes = text.as_bytes().to_vec();
            for _ in 0..=random(4) {
                let place = random(bytes.len());
                match random(3) {
                    0 => bytes[place] = b"0123456789-[]{},. \nefvne+"[random(25)],
                    1 => drop(bytes.remove(place)),
                    _ => bytes.insert(place, b"0123456789-,[]"[random(14)]),
                }
            }
            let Ok((mesh, _)) = read(name, &bytes) else { continue };
            assert!((0..mesh.triangles.len()).all(|i| mesh.corners(i).is_some()));
        }
    }
}

#[test]
fn real_files_are_read_whole() {
    let test = "real_files_are_read_whole";
    for (file, triangles) in [
        ("data/meshes/stanford-bunny.obj", 69_451),
        ("data/meshes/spot.obj", 5856),
        ("data/house_dyke_tree/house_dyke_tree.mesh.ply", 5202),
    ] {
        let Some(path) = crate::common::data(test, file) else { continue };
        let (mesh, report) = read_mesh(&path).unwrap();
        println!("{file}: {} triangles, {report:?}", mesh.triangles.len());
        assert_eq!(mesh.triangles.len() + report.degenerate_triangle_count, triangles, "{file}");
    }
}

#[test]
fn delft_as_obj_and_as_cityjson_has_the_same_roofs_and_ground() {
    let test = "delft_as_obj_and_as_cityjson_has_the_same_roofs_and_ground";
    let (Some(obj), Some(city)) = (
        crate::common::data(test, "data/delft_ahn3/testarea.obj"),
        crate::common::data(test, "data/delft_ahn3/testarea.json"),
    ) else {
        return;
    };
    let mut areas = Vec::new();
    for path in [&obj, &city] {
        let (mesh, report) = read_mesh(path).unwrap();
        let upward: f64 = (0..mesh.triangles.len())
            .map(|i| doubled_area_vector(&mesh, i))
            .filter(|n| n[2] > 0.5 * n.map(|v| v * v).iter().sum::<f64>().sqrt())
            .map(|n| n.map(|v| v * v).iter().sum::<f64>().sqrt() / 2.0)
            .sum();
        println!("{upward:.1} m2 upward, {} objects, {report:?}", mesh.object_names.len());
        assert_eq!(mesh.objects.len(), mesh.triangles.len());
        assert_eq!(mesh.object_names.len(), 570);
        areas.push(upward);
    }
    // walls and floors differ by design: the solids of CityJSON are closed and reach deeper
    assert!((areas[0] / areas[1] - 1.0).abs() < 0.002, "{areas:?}");
    assert_eq!(read_mesh(&city).unwrap().0.crs.epsg, Some(7415));
}
