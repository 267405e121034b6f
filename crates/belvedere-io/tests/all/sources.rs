//! Paths, bytes and readers give the same cloud; options choose points without changing them.

use std::io::Cursor;
use std::sync::atomic::{AtomicUsize, Ordering};

use belvedere_data::cloud::Attributes;
use belvedere_data::control::{Control, Watcher};
use belvedere_data::crs::Crs;
use belvedere_data::{Bounds, Error, Frame, PointCloud};
use belvedere_io::{Output, ReadOptions, ReadReport, Source, Within, read_batches, read_cloud, write_cloud};

/// A cloud of `count` points over a square of 100 m, a millimetre apart in the file, with classes 1 to 9.
pub(crate) fn cloud(count: u32) -> PointCloud {
    let whole = |v: u32| f64::from(v % 100_000) / 1000.0 - 50.0;
    let local = |i: u32| [whole(i.wrapping_mul(7919)), whole(i.wrapping_mul(104_729)), f64::from(i % 30)];
    let frame = Frame { origin: [155_000.0, 463_000.0, 0.0], crs: Crs::parse("EPSG:28992").unwrap() };
    let positions: Vec<[f32; 3]> = (0..count).map(|i| local(i).map(|v| v as f32)).collect();
    let classes = (0..count).map(|i| u8::try_from(i % 9 + 1).unwrap()).collect();
    let intensity = (0..count).map(|i| u16::try_from(i % 65_536).unwrap()).collect();
    let attributes = Attributes { classification: Some(classes), intensity: Some(intensity), ..Attributes::default() };
    PointCloud { positions, attributes, ..PointCloud::in_frame(frame) }
}

pub(crate) fn file(name: &str, cloud: &PointCloud) -> Vec<u8> {
    let mut cursor = Cursor::new(Vec::new());
    write_cloud(Output::writer(name, &mut cursor), cloud, &[]).unwrap();
    cursor.into_inner()
}

fn read(source: Source<'_>, options: &ReadOptions) -> (PointCloud, ReadReport) {
    read_cloud([source], options, &Control::none()).unwrap_or_else(|e| panic!("{e}"))
}

pub(crate) const FORMATS: [&str; 6] = ["cloud.las", "cloud.laz", "cloud.ply", "cloud.csv", "cloud.xyz", "cloud.npy"];

#[test]
fn a_path_bytes_and_a_reader_give_the_same_cloud() {
    let folder = tempfile::tempdir().unwrap();
    let cloud = cloud(2000);
    for name in FORMATS {
        let bytes = file(name, &cloud);
        let path = folder.path().join(name);
        std::fs::write(&path, &bytes).unwrap();
        let (expected, _) = read(Source::path(&path), &ReadOptions::default());
        assert_eq!(expected.len(), 2000, "{name}");
        // bytes that come in small pieces, as from a network
        let pieces = Trickle(Cursor::new(&bytes));
        for source in [Source::bytes(name, &bytes), Source::reader(name, pieces)] {
            let (found, report) = read(source, &ReadOptions::default());
            assert_eq!(found.positions, expected.positions, "{name}");
            assert_eq!(found.frame, expected.frame, "{name}");
            assert_eq!(found.attributes.classification, expected.attributes.classification, "{name}");
            assert_eq!(report.files[0].path.to_str(), Some(name));
        }
    }
}

/// A reader that gives at most 100 bytes at a time.
struct Trickle<'a>(Cursor<&'a Vec<u8>>);

impl std::io::Read for Trickle<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let max = buffer.len().min(100);
        std::io::Read::read(&mut self.0, &mut buffer[..max])
    }
}

impl std::io::Seek for Trickle<'_> {
    fn seek(&mut self, to: std::io::SeekFrom) -> std::io::Result<u64> {
        std::io::Seek::seek(&mut self.0, to)
    }
}

#[test]
fn a_box_and_classes_choose_the_points_that_a_look_at_all_of_them_chooses() {
    let cloud = cloud(5000);
    let frame = cloud.frame.clone();
    for name in FORMATS {
        let bytes = file(name, &cloud);
        let (all, _) = read(Source::bytes(name, &bytes), &ReadOptions::new().with_frame(frame.clone()));
        assert_eq!(all.frame.origin, frame.origin);
        let bounds = Bounds { low: [-20.0, -30.0, 2.0], high: [25.0, 10.0, 20.5] };
        let (low, high) = (frame.to_file_coordinates(bounds.low), frame.to_file_coordinates(bounds.high));
        let has_classes = all.attributes.classification.is_some();
        let class = |i: usize| all.attributes.classification.as_ref().map_or(2, |classes| classes[i]);
        let options = ReadOptions::new().with_frame(frame.clone()).with_row_numbers();
        let options = if has_classes { options.with_classes([2, 6]) } else { options };
        let chosen = (0..all.len()).filter(|&i| bounds.contains(all.positions[i]) && [2, 6].contains(&class(i)));
        let rows: Vec<u64> = chosen.map(|i| i as u64).collect();
        assert!(rows.len() > 50, "{name}: {}", rows.len());
        for within in [Within::Local(bounds), Within::File { low, high }] {
            let (some, report) = read(Source::bytes(name, &bytes), &options.clone().with_points_within(within));
            assert_eq!(report.rows, rows, "{name} {within:?}");
            assert_eq!(some.len(), rows.len());
            for (position, &row) in some.positions.iter().zip(&rows) {
                assert_eq!(*position, all.positions[usize::try_from(row).unwrap()], "{name}");
            }
            assert_eq!(report.left_out_count() + some.len(), all.len(), "what was not read is counted");
        }
    }
}

#[test]
fn tiles_that_are_read_apart_share_a_frame() {
    let cloud = cloud(3000);
    let frame = Frame { origin: [154_000.0, 462_000.0, -10.0], ..Frame::default() };
    let (west, east): (Vec<u32>, Vec<u32>) = (0..3000).partition(|&i| cloud.positions[i as usize][0] < 0.0);
    let options = ReadOptions::new().with_frame(frame);
    let tile = |indices: &[u32]| read(Source::bytes("tile.laz", &file("tile.laz", &cloud.select(indices))), &options).0;
    let (a, b) = (tile(&west), tile(&east));
    assert_eq!(a.frame, b.frame);
    assert_eq!(a.frame.origin, [154_000.0, 462_000.0, -10.0]);
    assert_eq!(a.frame.crs.epsg, Some(28_992), "a frame without a system takes that of the file");
    let (whole, _) = read(Source::bytes("all.laz", &file("all.laz", &cloud)), &options);
    for (tile, indices) in [(a, west), (b, east)] {
        for (position, &i) in tile.positions.iter().zip(&indices) {
            let expected = whole.positions[i as usize];
            assert!((0..3).all(|axis| (position[axis] - expected[axis]).abs() < 2e-4), "{position:?} {expected:?}");
        }
    }
}

#[test]
fn batches_joined_are_the_cloud_read_at_once() {
    // more than one batch of LAS, and two files of different formats
    let (large, small) = (cloud(1_200_000), cloud(500));
    let files = [file("large.las", &large), file("small.ply", &small)];
    let sources = || [Source::bytes("large.las", &files[0]), Source::bytes("small.ply", &files[1])];
    let options = ReadOptions::new().with_classes([3, 4]).with_row_numbers();
    let mut positions: Vec<[f32; 3]> = Vec::new();
    let mut rows = Vec::new();
    let mut batches = read_batches(sources(), &options, &Control::none()).unwrap();
    assert!(batches.frame().is_none());
    let mut count = 0;
    while let Some(batch) = batches.next() {
        let batch = batch.unwrap();
        assert_eq!(batches.frame(), Some(&batch.cloud.frame));
        count += 1;
        positions.extend(&batch.cloud.positions);
        rows.extend(batch.rows);
    }
    assert!(count >= 3, "{count} batches");
    let frame = batches.frame().unwrap().clone();
    let (whole, report) = read_cloud(sources(), &options.with_frame(frame), &Control::none()).unwrap();
    assert_eq!(positions, whole.positions);
    assert_eq!(rows, report.rows);
}

#[test]
fn rows_count_what_gave_no_point() {
    let text = b"1 2 3\nnot a point\n4 5 6\n7 8 9\n";
    let options = ReadOptions::new().with_row_numbers();
    let (_, report) = read(Source::bytes("a.xyz", text), &options);
    assert_eq!(report.rows, [0, 2, 3]);
    let ptx = b"4\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n1 1 1\n0 0 0\n0 0 0\n2 2 2\n";
    assert_eq!(read(Source::bytes("a.ptx", ptx), &options).1.rows, [0, 3]);
    let (_, report) = read(Source::bytes("a.xyz", b"1 2 3\nnan 1 1\n4 5 6\n"), &options);
    assert_eq!(report.rows, [0, 2]);
    assert!(read(Source::bytes("a.xyz", text), &ReadOptions::default()).1.rows.is_empty());
}

#[test]
fn messages_begin_with_the_name_of_the_source() {
    let read = |source: Source<'_>, options: &ReadOptions| {
        read_cloud([source], options, &Control::none()).unwrap_err().to_string()
    };
    assert!(read(Source::bytes("download.laz", b"<html>"), &ReadOptions::default()).starts_with("download.laz: "));
    assert!(read(Source::bytes("notes.doc", b""), &ReadOptions::default()).starts_with("notes.doc: "));
    let las = file("tile.las", &cloud(10));
    let elsewhere = Frame { origin: [0.0; 3], crs: Crs::parse("EPSG:2154").unwrap() };
    let error = read(Source::bytes("tile.las", &las), &ReadOptions::new().with_frame(elsewhere));
    assert!(error.starts_with("tile.las: ") && error.contains("frame"), "{error}");
    let error = read(Source::bytes("a.xyz", b"1 2 3\n"), &ReadOptions::new().with_classes([2]));
    assert!(error.contains("classification"), "{error}");
    let local = Within::Local(Bounds { low: [0.0; 3], high: [1.0; 3] });
    let error = read(Source::bytes("a.xyz", b"1 2 3\n"), &ReadOptions::new().with_points_within(local));
    assert!(error.contains("frame"), "{error}");
}

/// Cancels after so many points.
struct CancelAfterPoints {
    points: AtomicUsize,
    max: usize,
}

impl Watcher for CancelAfterPoints {
    fn advance(&self, count: usize) {
        self.points.fetch_add(count, Ordering::Relaxed);
    }
    fn is_cancelled(&self) -> bool {
        self.points.load(Ordering::Relaxed) >= self.max
    }
}

#[test]
fn reading_reports_its_points_and_stops_when_cancelled() {
    let las = file("cloud.las", &cloud(1_200_000));
    let with_max = |max| {
        let watcher = CancelAfterPoints { points: AtomicUsize::new(0), max };
        let source = [Source::bytes("cloud.las", &las)];
        let result = read_cloud(source, &ReadOptions::default(), &Control::new(&watcher));
        (result.map(|(cloud, _)| cloud.len()), watcher.points.into_inner())
    };
    assert!(matches!(with_max(usize::MAX), (Ok(1_200_000), 1_200_000)));
    let (result, points) = with_max(1);
    assert!(matches!(result, Err(Error::Cancelled)) && points < 1_200_000, "{points}");
    let none = CancelAfterPoints { points: AtomicUsize::new(0), max: 0 };
    let text = [Source::bytes("a.xyz", b"1 2 3\n4 5 6\n")];
    let result = read_cloud(text, &ReadOptions::default(), &Control::new(&none));
    assert!(matches!(result, Err(Error::Cancelled)));
}
