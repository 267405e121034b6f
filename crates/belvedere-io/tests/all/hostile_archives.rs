//! Damaged ball files: archives of NumPy arrays, and meshes that claim long lists.

use std::collections::BTreeMap;
use std::io::{Cursor, Write};

use belvedere_data::balls::MedialBalls;
use belvedere_data::building_outlines::{BuildingOutlines, Edge, Ridge, RoofPlane, Wall};
use belvedere_data::crs::Crs;
use belvedere_data::free_segments::FreeSegmentColumns;
use belvedere_data::model::ModelParts;
use belvedere_data::{Bounds, ExtinctionVoxels, Frame, PatchKind, SurfacePatches};
use belvedere_io::{Output, Source, read_balls, read_mesh, write_balls};

/// A small ball file in the format of an extension.
fn balls(name: &str) -> Vec<u8> {
    let count = 40_usize;
    let axis = |i: usize| f32::from(u8::try_from(i).unwrap());
    let balls = MedialBalls {
        centers: (0..count).map(|i| [axis(i), 2.0, 3.0]).collect(),
        radii: vec![1.5; count],
        source: vec![7; count],
        touch: vec![u32::MAX; count],
        separation_angles: vec![0.5; count],
    };
    let frame = Frame { origin: [85_000.0, 447_000.0, 0.0], ..Frame::default() };
    let mut patches = SurfacePatches::default();
    patches.push([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.5, 9.0]], PatchKind::Wall);
    patches.push([[1.5, 2.0, 3.0], [4.0, 5.0, 6.5], [7.0, 8.0, 9.0]], PatchKind::Roof);
    let balls = ModelParts { frame, balls, patches, ..ModelParts::default() };
    let mut cursor = Cursor::new(Vec::new());
    write_balls(Output::writer(name, &mut cursor), &balls).unwrap();
    cursor.into_inner()
}

#[test]
fn damaged_ball_files_are_refused_or_hold_no_more_than_their_bytes() {
    let mut state = 3_u64;
    let mut below = |limit: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        usize::try_from(state >> 33).unwrap() % limit
    };
    let (mut refused, mut read) = (0, 0);
    for name in ["balls.npz", "balls.ply", "balls.laz", "balls.las"] {
        let valid = balls(name);
        assert_eq!(read_balls(Source::bytes(name, &valid)).unwrap().balls.radii.len(), 40);
        for trial in 0..400 {
            let mut bytes = valid.clone();
            if trial % 4 == 0 {
                bytes.truncate(below(valid.len()));
            } else {
                for _ in 0..=below(3) {
                    let place = below(bytes.len());
                    bytes[place] ^= 1 << below(8);
                }
            }
            match read_balls(Source::bytes(name, &bytes)) {
                Ok(parts) => {
                    let count = parts.balls.radii.len();
                    assert!(count <= bytes.len(), "{name}, trial {trial}: {count} balls");
                    read += 1;
                }
                Err(error) => {
                    assert!(error.to_string().starts_with(name), "{error}");
                    refused += 1;
                }
            }
        }
    }
    assert!(refused > 200 && read > 50, "{refused} refused, {read} read");
}

/// An archive with every array that a ball file can have.
fn full_archive() -> (ModelParts, Vec<u8>) {
    let count = 5_usize;
    let mut patches = SurfacePatches::default();
    patches.push([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.5, 9.0]], PatchKind::Inside);
    let roof = RoofPlane {
        normal: [0.0, 0.6, 0.8],
        center: [1.0, 2.0, 3.0],
        bounds: [[0.0; 3], [5.0; 3]],
        count: 30,
        noise: 0.02,
        sd: 0.004,
    };
    let ends = [[1.0, 2.0, 3.0], [4.0, 5.5, 6.0]];
    let wall = Wall {
        ends: [[1.0, 2.0], [4.0, 5.5]],
        heights: [0.5, 3.0],
        edge: 0,
        count: 9,
        noise: 0.03,
        sd: 0.01,
        share: 0.75,
        eaves: 0.2,
    };
    let outlines = BuildingOutlines {
        planes: vec![roof; 2],
        edges: vec![Edge { ends, plane: 1, sd: 0.05, count: 12, drop: 3.0 }],
        ridges: vec![Ridge { ends, planes: [0, 1], is_convex: true }],
        walls: vec![wall],
    };
    let parts = ModelParts {
        patches,
        outlines,
        frame: Frame { origin: [85_000.0, 447_000.0, 1.0], crs: Crs { epsg: Some(28_992), ..Crs::default() } },
        bounds: Bounds { low: [-5.0; 3], high: [9.0; 3] },
        balls: MedialBalls {
            centers: vec![[1.0, 2.0, 3.0]; count],
            radii: vec![1.5; count],
            source: vec![7; count],
            touch: vec![u32::MAX; count],
            separation_angles: vec![0.5; count],
        },
        transmission: vec![0.25; count],
        medium: Some(ExtinctionVoxels { voxels: vec![[85_001, 447_002, 3]], extinction: vec![0.5] }),
        pulses: Some(FreeSegmentColumns {
            starts: vec![[0.5; 3]; 3],
            ways: vec![0, 4, 5],
            slopes: vec![[10, -20]; 3],
            lengths: vec![4.0; 3],
            top: 12.0,
        }),
        provenance: BTreeMap::from([("method".to_owned(), "carved".to_owned())]),
    };
    let mut cursor = Cursor::new(Vec::new());
    write_balls(Output::writer("balls.npz", &mut cursor), &parts).unwrap();
    (parts, cursor.into_inner())
}

#[test]
fn no_flipped_bit_of_an_archive_changes_its_balls_without_an_error() {
    let (parts, valid) = full_archive();
    let mut unseen = 0;
    for place in 0..valid.len() {
        for bit in [place % 8, (place + 3) % 8] {
            let mut bytes = valid.clone();
            bytes[place] ^= 1 << bit;
            match read_balls(Source::bytes("balls.npz", &bytes)) {
                Ok(found) => {
                    assert!(found == parts, "bit {bit} of byte {place} of {}", valid.len());
                    unseen += 1;
                }
                Err(error) => assert!(error.to_string().contains("balls.npz: damaged"), "{error}"),
            }
        }
    }
    // dates, versions and the like mean nothing here
    assert!(unseen * 3 < valid.len() * 2, "{unseen} of {} bits", valid.len() * 2);
}

/// An archive with one array, whose values are all zero.
fn archive_of_zeros(name: &str, shape: &str, bytes: usize) -> Vec<u8> {
    let mut archive = zip::ZipWriter::new(Cursor::new(Vec::new()));
    let options = zip::write::SimpleFileOptions::default().compression_method(zip::CompressionMethod::Deflated);
    archive.start_file(format!("{name}.npy"), options).unwrap();
    let header = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': {shape}, }}\n");
    archive.write_all(b"\x93NUMPY\x01\x00").unwrap();
    archive.write_all(&u16::try_from(header.len()).unwrap().to_le_bytes()).unwrap();
    archive.write_all(header.as_bytes()).unwrap();
    let block = vec![0; 1 << 20];
    for start in (0..bytes).step_by(block.len()) {
        archive.write_all(&block[..block.len().min(bytes - start)]).unwrap();
    }
    archive.finish().unwrap().into_inner()
}

#[test]
fn archives_that_expand_beyond_reason_are_refused_before_they_do() {
    // 84 MB from a tenth of one
    let bomb = archive_of_zeros("centers", "(6999999, 3)", 83_999_988);
    assert!(bomb.len() < 100_000, "{}", bomb.len());
    let error = read_balls(Source::bytes("bomb.npz", &bomb)).unwrap_err().to_string();
    assert!(error.starts_with("bomb.npz: damaged") && error.contains("more than 100 times"), "{error}");
    // the directory and the header of the array claim less than there is
    let mut liar = archive_of_zeros("centers", "(6999999, 3)", 83_999_988);
    let length = u32::try_from(liar.windows(4).rev().position(|w| w == b"PK\x01\x02").unwrap()).unwrap();
    let entry = liar.len() - 4 - length as usize;
    liar[entry + 24..entry + 28].copy_from_slice(&1000_u32.to_le_bytes());
    let error = read_balls(Source::bytes("liar.npz", &liar)).unwrap_err().to_string();
    assert!(error.starts_with("liar.npz: damaged") && error.contains("does not fit its 1000 bytes"), "{error}");
    let mut liar = archive_of_zeros("centers", "(8, 3)", 83_999_988);
    let entry = liar.len() - 4 - length as usize;
    let header = liar[entry..].windows(2).position(|w| w == b"PK").map(|_| 10 + 58).unwrap();
    liar[entry + 24..entry + 28].copy_from_slice(&u32::try_from(header + 96).unwrap().to_le_bytes());
    let error = read_balls(Source::bytes("liar.npz", &liar)).unwrap_err().to_string();
    assert!(error.starts_with("liar.npz: damaged"), "{error}");
}

#[test]
fn numbers_that_no_scene_has_are_refused() {
    let refused = |change: fn(&mut ModelParts), what: &str| {
        let (mut parts, _) = full_archive();
        change(&mut parts);
        let mut cursor = Cursor::new(Vec::new());
        let error = write_balls(Output::writer("balls.npz", &mut cursor), &parts).unwrap_err().to_string();
        assert!(error.contains(what), "{error}");
    };
    refused(|parts| parts.balls.radii[2] = 1e38, "ball is of radius");
    refused(|parts| parts.balls.centers[1][2] = -1e30, "ball is at");
    refused(|parts| parts.bounds.high[0] = 1e30, "ball is in the bounds");
    refused(|parts| parts.bounds.low[0] = 100.0, "ball is in the bounds");
    refused(|parts| parts.frame.origin[0] = 1e300, "origin is");
    refused(|parts| parts.pulses.as_mut().unwrap().starts[0][1] = 1e20, "pulse is from");
    refused(|parts| parts.pulses.as_mut().unwrap().top = f32::NAN, "pulse is up to");
}

#[test]
fn archives_whose_arrays_claim_too_much_are_refused() {
    let valid = balls("balls.npz");
    let shape = b"'shape': (";
    let at = valid.windows(shape.len()).position(|window| window == shape).unwrap();
    // as many characters, so that the archive stays whole but for its checksum
    for claim in ["'shape': (9e9,3)", "'shape': (((((((", "'shape': [40, 3]", "'shape': (-4, 3)"] {
        let mut bytes = valid.clone();
        bytes[at..at + claim.len()].copy_from_slice(claim.as_bytes());
        assert!(read_balls(Source::bytes("balls.npz", &bytes)).is_err(), "{claim}");
    }
}

#[test]
fn meshes_that_claim_long_lists_are_refused() {
    for (encoding, face) in
        [("ascii", &b"4000000000 0 1 2\n"[..]), ("binary_little_endian", b"\x00\x28\x6b\xee\0\0\0\0")]
    {
        let header =
            format!("ply\nformat {encoding} 1.0\nelement face 1\nproperty list uint int vertex_indices\nend_header\n");
        let bytes = [header.as_bytes(), face].concat();
        let error = read_mesh(Source::bytes("mesh.ply", &bytes)).unwrap_err().to_string();
        assert!(error.contains("list") || error.contains("ends within"), "{error}");
    }
}
