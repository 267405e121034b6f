//! Damaged ball files: archives of NumPy arrays, and meshes that claim long lists.

use std::io::Cursor;

use belvedere_data::Frame;
use belvedere_data::balls::MedialBalls;
use belvedere_data::model::ModelParts;
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
    let balls = ModelParts { frame, balls, ..ModelParts::default() };
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
