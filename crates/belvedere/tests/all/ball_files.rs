//! Ball files: what is written comes back, and what is damaged is an error.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use belvedere::crs::Crs;
use belvedere::io::{is_ball_file, read_balls, write_balls, write_cloud};
use belvedere::medial::MedialBalls;
use belvedere::model::ModelParts;
use belvedere::planes::BuildingOutlines;
use belvedere::pulses::FreeSegmentColumns;
use belvedere::{Bounds, Error, ExtinctionVoxels, Frame, PatchKind, PointCloud, SurfacePatches};
use tempfile::TempDir;

fn dutch() -> Crs {
    Crs { epsg: Some(28992), ..Crs::default() }
}

fn balls(crs: Crs) -> ModelParts {
    let n = 500_u16;
    ModelParts {
        frame: Frame { origin: [84_500.123_456_789, 446_700.0, 3.0], crs },
        bounds: Bounds { low: [-5.5, -400.25, 0.1], high: [70.0, 1.0, 30.7] },
        balls: MedialBalls {
            centers: (0..n).map(|i| [f32::from(i) * 0.1234, f32::from(i) * -0.77, f32::from(i).sqrt()]).collect(),
            radii: (0..n).map(|i| f32::from(i) * 0.0137).collect(),
            source: (0..u32::from(n)).rev().collect(),
            touch: (0..u32::from(n)).map(|i| if i % 10 == 0 { u32::MAX } else { i }).collect(),
            separation_angles: (0..n).map(|i| if i % 10 == 0 { f32::NAN } else { f32::from(i) * 0.006 }).collect(),
        },
        transmission: (0..n).map(|i| f32::from(i) / 499.0).collect(),
        patches: patches(),
        outlines: BuildingOutlines::default(),
        medium: Some(ExtinctionVoxels {
            voxels: (0..40).map(|i| [84_500 + i / 8, 446_700 + i % 8, 9 - i]).collect(),
            extinction: (0..40_u8).map(|i| f32::from(i) * 0.037).collect(),
        }),
        pulses: Some(FreeSegmentColumns {
            starts: (0..700_u16).map(|i| [f32::from(i) * 0.37, f32::from(i).sqrt(), 1.0 / f32::from(i + 3)]).collect(),
            ways: (0..700_u16).map(|i| u8::try_from(i % 6).unwrap()).collect(),
            slopes: (0..700_i16).map(|i| [i * 40 - 9000, 3000 - i]).collect(),
            lengths: (0..700_u16).map(|i| if i % 5 == 0 { f32::INFINITY } else { f32::from(i) * 0.11 }).collect(),
            top: 31.4159,
        }),
        provenance: BTreeMap::from([("parameters".to_owned(), "first_separation_angle = 32°".to_owned())]),
    }
}

/// Triangles of all kinds, more than a record of LAS before the points can hold.
fn patches() -> SurfacePatches {
    let mut patches = SurfacePatches::default();
    for i in 0..2000_u16 {
        let corner = |k: u16| [f32::from(i) * 0.031, f32::from(k) * 1.7 - 30.3, f32::from(i * k).sqrt() / 7.0];
        patches.push([corner(0), corner(1), corner(3)], PatchKind::ALL[usize::from(i % 4)]);
    }
    patches
}

fn same_bits(a: &[f32], b: &[f32]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(x, y)| x.to_bits() == y.to_bits())
}

#[test]
fn balls_come_back() {
    let folder = TempDir::new().unwrap();
    let foot = 0.3048;
    let feet = Crs { metres_per_unit: foot, vertical_metres_per_unit: foot, ..Crs::default() };
    let wkt = Crs { wkt: Some(format!("LOCAL_CS[\"{}  end\"]", "long  name ".repeat(200))), ..Crs::default() };
    for crs in [dutch(), feet, wkt] {
        let balls = balls(crs);
        for name in ["b.npz", "b.ply", "b.laz", "b.las"] {
            let path = folder.path().join(name);
            write_balls(&path, &balls).unwrap();
            assert!(is_ball_file(&path).unwrap(), "{name}");
            let found = read_balls(&path).unwrap();
            assert_eq!(found.frame.crs, balls.frame.crs, "{name}");
            assert_eq!(found.provenance, balls.provenance);
            assert_eq!(found.bounds, balls.bounds, "{name}");
            assert_eq!(found.balls.source, balls.balls.source);
            assert_eq!(found.balls.touch, balls.balls.touch);
            assert!(same_bits(&found.balls.separation_angles, &balls.balls.separation_angles));
            assert_eq!(found.transmission, balls.transmission, "{name}");
            assert_eq!(found.pulses.is_some(), name == "b.npz", "{name}");
            assert_eq!(found.medium, balls.medium.clone().filter(|_| name == "b.npz"), "{name}");
            assert_eq!(found.patches.kinds, balls.patches.kinds, "{name}");
            let corners = |parts: &ModelParts| parts.patches.triangles.as_flattened().as_flattened().to_vec();
            if name == "b.ply" {
                // a step of f32 at 70 m: coordinates of the file are f64 in its unit
                assert!(corners(&found).iter().zip(corners(&balls)).all(|(a, b)| (a - b).abs() < 1e-5));
            } else {
                assert!(same_bits(&corners(&found), &corners(&balls)), "{name}");
            }
            if name == "b.npz" {
                assert_eq!(found.frame.origin, balls.frame.origin);
                assert!(same_bits(found.balls.centers.as_flattened(), balls.balls.centers.as_flattened()));
                assert!(same_bits(&found.balls.radii, &balls.balls.radii));
                let [found, given] = [&found, &balls].map(|balls| balls.pulses.as_ref().unwrap());
                assert!(same_bits(found.starts.as_flattened(), given.starts.as_flattened()));
                assert!(same_bits(&found.lengths, &given.lengths) && same_bits(&[found.top], &[given.top]));
                assert_eq!((&found.slopes, &found.ways), (&given.slopes, &given.ways));
                continue;
            }
            for i in 0..balls.balls.radii.len() {
                assert!((found.balls.radii[i] - balls.balls.radii[i]).abs() <= balls.balls.radii[i] * 2e-7, "{name}");
                for axis in 0..3 {
                    let expected = f64::from(balls.balls.centers[i][axis]) + balls.frame.origin[axis];
                    let value = f64::from(found.balls.centers[i][axis]) + found.frame.origin[axis];
                    assert!((value - expected).abs() < 0.0006, "{name}: {value} {expected}");
                }
            }
        }
    }
}

#[test]
fn a_file_written_anew_has_the_same_bytes_and_pulses_take_sixteen_of_them_each() {
    let folder = TempDir::new().unwrap();
    let [first, again] = ["a.npz", "b.npz"].map(|name| folder.path().join(name));
    let mut balls = balls(dutch());
    balls.pulses.as_mut().unwrap().ways.clear();
    for name in ["c.ply", "c.laz", "c.las"] {
        let [first, again] = ["first", "again"].map(|stem| folder.path().join(format!("{stem}_{name}")));
        write_balls(&first, &balls).unwrap();
        write_balls(&again, &read_balls(&first).unwrap()).unwrap();
        assert!(fs::read(&first).unwrap() == fs::read(&again).unwrap(), "{name}");
    }
    let size = |path: &Path| fs::metadata(path).unwrap().len();
    write_balls(&first, &balls).unwrap();
    write_balls(&again, &read_balls(&first).unwrap()).unwrap();
    assert!(fs::read(&first).unwrap() == fs::read(&again).unwrap());
    let with_lengths = size(&first);
    balls.pulses.as_mut().unwrap().lengths.clear();
    write_balls(&first, &balls).unwrap();
    assert!(read_balls(&first).unwrap().pulses.unwrap().lengths.is_empty());
    let without_lengths = size(&first);
    balls.pulses = None;
    write_balls(&first, &balls).unwrap();
    // 700 pulses; the headers of an array in an archive take some 300 bytes
    assert!((16 * 700..16 * 700 + 1000).contains(&(without_lengths - size(&first))));
    assert!((4 * 700..4 * 700 + 350).contains(&(with_lengths - without_lengths)));
}

#[test]
fn pulses_and_transmissions_that_cannot_be_are_errors_that_name_the_file() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("odd.npz");
    let refused = |change: &dyn Fn(&mut ModelParts)| {
        let mut odd = balls(dutch());
        change(&mut odd);
        write_balls(&path, &odd).is_err()
    };
    assert!(refused(&|b| b.transmission[7] = 1.5));
    assert!(refused(&|b| b.transmission[7] = f32::INFINITY));
    assert!(refused(&|b| assert!(b.transmission.pop().is_some())));
    assert!(refused(&|b| assert!(b.pulses.as_mut().unwrap().slopes.pop().is_some())));
    assert!(refused(&|b| assert!(b.pulses.as_mut().unwrap().lengths.pop().is_some())));
    assert!(refused(&|b| b.pulses.as_mut().unwrap().lengths[1] = 0.0));
    assert!(refused(&|b| b.pulses.as_mut().unwrap().starts[1][2] = f32::NAN));
    assert!(refused(&|b| b.pulses.as_mut().unwrap().top = f32::INFINITY));
    assert!(!path.exists());
    // an array of pulses that lost its companion, as its name is written twice in an archive
    write_balls(&path, &balls(dutch())).unwrap();
    let mut bytes = fs::read(&path).unwrap();
    let name = b"pulse_slopes";
    let places: Vec<usize> = (0..bytes.len() - name.len()).filter(|&i| bytes[i..].starts_with(name)).collect();
    assert_eq!(places.len(), 2);
    places.iter().for_each(|&at| bytes[at] = b'q');
    fs::write(&path, bytes).unwrap();
    let message = read_balls(&path).unwrap_err().to_string();
    assert!(message.contains("odd.npz") && message.contains("slopes"), "{message}");
}

#[test]
fn patches_that_were_lost_or_cannot_be_are_errors_that_name_the_file() {
    let folder = TempDir::new().unwrap();
    let refused = |change: &dyn Fn(&mut SurfacePatches)| {
        let mut odd = balls(dutch());
        change(&mut odd.patches);
        write_balls(&folder.path().join("odd.npz"), &odd).is_err()
    };
    assert!(refused(&|patches| assert!(patches.kinds.pop().is_some())));
    assert!(refused(&|patches| patches.triangles[7][2][1] = f32::NAN));
    assert!(refused(&|patches| patches.triangles[7][2][1] = -3e7));
    // another name for what holds them, as if another program had dropped it
    for (name, word) in
        [("b.npz", "patch_kinds"), ("b.ply", "element patch"), ("b.las", "surface patches"), ("b.laz", "patches1")]
    {
        let path = folder.path().join(name);
        write_balls(&path, &balls(dutch())).unwrap();
        let mut bytes = fs::read(&path).unwrap();
        let places: Vec<usize> =
            (0..bytes.len() - word.len()).filter(|&i| bytes[i..].starts_with(word.as_bytes())).collect();
        assert!(!places.is_empty(), "{name}");
        for at in places {
            match name {
                // the number of the record stands four bytes and the length before its description
                "b.las" => bytes[at - 10] = 77,
                "b.ply" => bytes[at + word.len() - 1] = b'q',
                _ => bytes[at] = b'q',
            }
        }
        fs::write(&path, bytes).unwrap();
        let message = read_balls(&path).unwrap_err().to_string();
        assert!(message.contains(name) && message.contains("atch"), "{message}");
    }
    // files of earlier versions announce none
    let mut old = balls(dutch());
    old.patches = SurfacePatches::default();
    for name in ["b.npz", "b.ply", "b.laz", "b.las"] {
        let path = folder.path().join(name);
        write_balls(&path, &old).unwrap();
        let bytes = fs::read(&path).unwrap();
        assert!(!bytes.windows(7).any(|window| window == b"patches"), "{name}");
        assert!(read_balls(&path).unwrap().patches.is_empty());
    }
}

#[test]
fn no_balls_come_back_as_none() {
    let folder = TempDir::new().unwrap();
    let none = ModelParts {
        bounds: Bounds { low: [-1.0; 3], high: [2.0; 3] },
        frame: Frame { crs: dutch(), ..Frame::default() },
        ..ModelParts::default()
    };
    for name in ["b.npz", "b.ply", "b.laz", "b.las"] {
        let path = folder.path().join(name);
        write_balls(&path, &none).unwrap();
        assert!(is_ball_file(&path).unwrap(), "{name}");
        assert_eq!(read_balls(&path).unwrap(), none, "{name}");
    }
    let endless = ModelParts { bounds: Bounds { low: [0.0; 3], high: [f32::INFINITY; 3] }, ..none };
    assert!(matches!(write_balls(&folder.path().join("b.npz"), &endless), Err(Error::InvalidParameter { .. })));
}

#[test]
fn balls_without_metadata_have_the_bounds_of_their_centres() {
    let folder = TempDir::new().unwrap();
    let balls = balls(dutch());
    let path = folder.path().join("b.ply");
    write_balls(&path, &balls).unwrap();
    // as a program that does not know the comments would save it
    let bytes = fs::read(&path).unwrap();
    let end = bytes.windows(11).position(|w| w == b"end_header\n").unwrap();
    let header = String::from_utf8(bytes[..end].to_vec()).unwrap();
    let kept: Vec<&str> = header.lines().filter(|line| !line.starts_with("comment belvedere_balls")).collect();
    let edited = [format!("{}\n", kept.join("\n")).as_bytes(), &bytes[end..]].concat();
    fs::write(&path, edited).unwrap();
    let found = read_balls(&path).unwrap();
    assert_eq!((found.frame.crs.epsg, found.balls.radii.len()), (Some(28992), 500));
    let Bounds { low, high } = found.bounds;
    for axis in 0..3 {
        let centers = || found.balls.centers.iter().map(|c| c[axis]);
        assert_eq!(low[axis], centers().fold(f32::INFINITY, f32::min));
        assert_eq!(high[axis], centers().fold(f32::NEG_INFINITY, f32::max));
    }
}

#[test]
fn clouds_are_no_ball_files() {
    let folder = TempDir::new().unwrap();
    for name in ["c.las", "c.laz", "c.ply", "c.csv"] {
        let path = folder.path().join(name);
        write_cloud(&path, &PointCloud::from_coordinates(&[[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]).0, &[]).unwrap();
        assert!(!is_ball_file(&path).unwrap(), "{name}");
        assert!(read_balls(&path).is_err(), "{name}");
    }
    assert!(is_ball_file(&folder.path().join("missing.npz")).is_err());
    assert!(matches!(write_balls(Path::new("b.obj"), &balls(dutch())), Err(Error::UnknownFormat { .. })));
    let mut uneven = balls(dutch());
    uneven.balls.radii.pop();
    assert!(matches!(write_balls(Path::new("b.npz"), &uneven), Err(Error::LengthMismatch { .. })));
}

#[test]
fn damaged_ball_files_are_errors() {
    let folder = TempDir::new().unwrap();
    for name in ["b.npz", "b.ply", "b.laz", "b.las"] {
        let path = folder.path().join(name);
        write_balls(&path, &balls(dutch())).unwrap();
        let whole = fs::read(&path).unwrap();
        for share in 0..40 {
            fs::write(&path, &whole[..whole.len() * share / 40]).unwrap();
            assert!(read_balls(&path).is_err(), "{name} cut to {share}/40");
            is_ball_file(&path).unwrap();
        }
        // any byte may be wrong: an error or other numbers, but no panic
        for at in (0..whole.len()).step_by(whole.len() / 400 + 1) {
            let mut damaged = whole.clone();
            damaged[at] ^= 0xff;
            fs::write(&path, &damaged).unwrap();
            let _ = read_balls(&path);
        }
    }
}
