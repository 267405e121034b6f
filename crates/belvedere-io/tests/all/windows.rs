//! A window of a large cloud has the points of a search through all of them, and costs little more than its own bytes.

use std::io::{Cursor, Read, Seek, SeekFrom};
use std::sync::atomic::{AtomicU64, Ordering};

use belvedere_data::control::Control;
use belvedere_data::random::uniform;
use belvedere_io::{ReadOptions, Source, Within, read_batches, read_cloud, read_las_head};
use laz::laszip::{ChunkTable, LasZipCompressor, LazVlrBuilder};

use crate::common::data;

/// Side of the simulated tile, metres, and most points of a node of its octree that has nodes below it.
const SIDE: f64 = 1000.0;
const NODE: usize = 1024;
const LEVELS: u32 = 5;
const SCALE: f64 = 0.01;
const RECORD: usize = 30;

/// A chunk of the octree: level, x, y, z, and its points.
pub(crate) type OctreeNode = ([i32; 4], Vec<[i32; 3]>);

/// Points over a kilometre, spread over the nodes of an octree: some at each level, the rest at the deepest.
pub(crate) fn nodes(count: u32) -> Vec<OctreeNode> {
    let mut nodes: std::collections::BTreeMap<[i32; 4], Vec<[i32; 3]>> = std::collections::BTreeMap::new();
    for i in 0..u64::from(count) {
        let [x, y] = [2 * i, 2 * i + 1].map(|number| SIDE * uniform(11, number));
        let z = 30.0 * uniform(12, i);
        let key = |level: u32| {
            let cell = |v: f64| (v / SIDE * f64::from(1 << level)).floor() as i32;
            [level as i32, cell(x), cell(y), cell(z)]
        };
        let level = (0..LEVELS).find(|&level| nodes.get(&key(level)).is_none_or(|points| points.len() < NODE));
        let point = [x, y, z].map(|v| (v / SCALE).floor() as i32);
        nodes.entry(key(level.unwrap_or(LEVELS))).or_default().push(point);
    }
    nodes.into_iter().collect()
}

fn record(point: [i32; 3], number: usize) -> [u8; RECORD] {
    let mut record = [0; RECORD];
    for (place, v) in record.chunks_exact_mut(4).zip(point) {
        place.copy_from_slice(&v.to_le_bytes());
    }
    record[14] = 0x11;
    record[16] = (number % 3 + 1) as u8;
    record[22..30].copy_from_slice(&(number as f64).to_le_bytes());
    record
}

/// A COPC file of `nodes`, the hierarchy of levels from 2 on in pages of their own; `damage` may change the hierarchy.
pub(crate) fn copc(nodes: &[OctreeNode], damage: impl Fn(&mut Vec<u8>)) -> Vec<u8> {
    let vlr = LazVlrBuilder::default().with_point_format(6, 0).unwrap().with_variable_chunk_size().build();
    let mut laz_record = Vec::new();
    vlr.write_to(&mut laz_record).unwrap();
    let points_start = 375 + 54 + 160 + 54 + laz_record.len();
    let mut file = Cursor::new(vec![0; points_start]);
    file.set_position(points_start as u64);
    let mut compressor = LasZipCompressor::new(file, vlr.clone()).unwrap();
    let mut number = 0;
    for (_, points) in nodes {
        let records: Vec<u8> = points.iter().flat_map(|&p| (number += 1, record(p, number)).1).collect();
        compressor.compress_many(&records).unwrap();
        compressor.finish_current_chunk().unwrap();
    }
    compressor.done().unwrap();
    let mut file = compressor.into_inner();
    file.set_position(points_start as u64);
    let table = ChunkTable::read_from(&mut file, &vlr).unwrap();
    let mut bytes = file.into_inner();

    // entries of nodes, by the page that they stand in
    let mut start = points_start as u64 + 8;
    let mut pages: std::collections::BTreeMap<[i32; 4], Vec<u8>> = std::collections::BTreeMap::new();
    let entry = |key: [i32; 4], start: u64, length: i32, points: i32| {
        let mut entry: Vec<u8> = key.iter().flat_map(|v| v.to_le_bytes()).collect();
        entry.extend(start.to_le_bytes());
        entry.extend(length.to_le_bytes());
        entry.extend(points.to_le_bytes());
        entry
    };
    for ((key, points), chunk) in nodes.iter().zip(&table) {
        let [level, place @ ..] = *key;
        let [x, y, z] = if level < 2 { [0; 3] } else { place.map(|v| v >> (level - 2)) };
        let page = if level < 2 { [0; 4] } else { [2, x, y, z] };
        pages.entry(page).or_default().extend(entry(*key, start, chunk.byte_count as i32, points.len() as i32));
        start += chunk.byte_count;
    }
    let mut root = pages.remove(&[0; 4]).unwrap();
    let hierarchy_start = bytes.len() as u64;
    let mut hierarchy = vec![0; 60];
    for (key, page) in pages {
        root.extend(entry(key, hierarchy_start + hierarchy.len() as u64, page.len() as i32, -1));
        hierarchy.extend(page);
    }
    let root_start = hierarchy_start + hierarchy.len() as u64;
    let root_length = root.len();
    hierarchy.extend(root);
    damage(&mut hierarchy);
    hierarchy[2..6].copy_from_slice(b"copc");
    hierarchy[18..20].copy_from_slice(&1000_u16.to_le_bytes());
    let length = hierarchy.len() as u64 - 60;
    hierarchy[20..28].copy_from_slice(&length.to_le_bytes());
    bytes.extend(hierarchy);

    let count: u64 = nodes.iter().map(|(_, points)| points.len() as u64).sum();
    let mut put = |at: usize, field: &[u8]| bytes[at..at + field.len()].copy_from_slice(field);
    put(0, b"LASF");
    put(24, &[1, 4]);
    put(94, &375_u16.to_le_bytes());
    put(96, &(points_start as u32).to_le_bytes());
    put(100, &2_u32.to_le_bytes());
    put(104, &[6 | 0x80]);
    put(105, &(RECORD as u16).to_le_bytes());
    for axis in 0..3 {
        put(131 + 8 * axis, &SCALE.to_le_bytes());
        put(179 + 16 * axis, &[SIDE, SIDE, 30.0][axis].to_le_bytes());
    }
    put(235, &hierarchy_start.to_le_bytes());
    put(243, &1_u32.to_le_bytes());
    put(247, &count.to_le_bytes());
    put(375 + 2, b"copc");
    put(375 + 18, &1_u16.to_le_bytes());
    put(375 + 20, &160_u16.to_le_bytes());
    let half = SIDE / 2.0;
    for (number, value) in [half, half, half, half, 1.0].into_iter().enumerate() {
        put(375 + 54 + 8 * number, &value.to_le_bytes());
    }
    put(375 + 54 + 40, &root_start.to_le_bytes());
    put(375 + 54 + 48, &(root_length as u64).to_le_bytes());
    let at = 375 + 54 + 160;
    put(at + 2, b"laszip encoded");
    put(at + 18, &22204_u16.to_le_bytes());
    put(at + 20, &(laz_record.len() as u16).to_le_bytes());
    put(at + 54, &laz_record);
    bytes
}

/// A reader that counts the bytes it gives.
struct CountingReader<'a>(Cursor<&'a [u8]>, &'a AtomicU64);

impl Read for CountingReader<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let count = self.0.read(buffer)?;
        self.1.fetch_add(count as u64, Ordering::Relaxed);
        Ok(count)
    }
}

impl Seek for CountingReader<'_> {
    fn seek(&mut self, to: SeekFrom) -> std::io::Result<u64> {
        self.0.seek(to)
    }
}

pub(crate) fn window(low: [f64; 2], side: f64) -> ReadOptions {
    let within = Within::File { low: [low[0], low[1], -1.0], high: [low[0] + side, low[1] + side, 100.0] };
    ReadOptions::new().with_points_within(within)
}

/// Coordinates in the file, in the order of the cloud.
pub(crate) fn places(source: Source<'_>, options: &ReadOptions) -> Vec<[i64; 3]> {
    let (cloud, _) = read_cloud([source], options, &Control::none()).unwrap_or_else(|e| panic!("{e}"));
    let steps = |p: &[f32; 3]| cloud.frame.to_file_coordinates(*p).map(|v| (v / SCALE).round() as i64);
    cloud.positions.iter().map(steps).collect()
}

#[test]
fn a_window_of_a_copc_kilometre_reads_at_most_three_times_its_bytes_and_has_all_its_points() {
    let count = 3_000_000;
    let bytes = copc(&nodes(count), |_| {});
    let all = places(Source::bytes("tile.copc.laz", &bytes), &ReadOptions::new());
    assert_eq!(all.len(), count as usize);
    for low in [[480.0, 480.0], [0.0, 0.0], [333.0, 710.0]] {
        let read = AtomicU64::new(0);
        let source = Source::reader("tile.copc.laz", CountingReader(Cursor::new(&bytes), &read));
        let found = places(source, &window(low, 100.0));
        let is_in = |p: &&[i64; 3]| (0..2).all(|i| (low[i]..=low[i] + 100.0).contains(&(p[i] as f64 * SCALE)));
        let expected: Vec<[i64; 3]> = all.iter().filter(is_in).copied().collect();
        assert!(expected.len() > 15_000);
        assert_eq!(found, expected, "{low:?}");
        let own = bytes.len() as f64 * expected.len() as f64 / f64::from(count);
        let read = read.load(Ordering::Relaxed) as f64;
        assert!(read < 3.0 * own, "{low:?}: read {read}, the points of the window take {own:.0} of {}", bytes.len());
    }
}

#[test]
fn of_rows_that_hold_a_window_no_more_is_read_and_nothing_is_lost() {
    // along x, as a scanner flies, so that a window holds few rows
    let count = 300_000_u32;
    let positions = (0..count).map(|i| {
        let x = f64::from(i) / f64::from(count) * SIDE;
        [x, SIDE * uniform(3, i.into()), 5.0].map(|v| v as f32)
    });
    let cloud = belvedere_data::PointCloud { positions: positions.collect(), ..Default::default() };
    let options = window([400.0, 0.0], 100.0).with_frame(belvedere_data::Frame::default());
    // and a piece far from it, as rectangles around rows are never quite as small as the rows
    let rows = vec![118_000..155_000, 250_000..260_000, 290_000..999_999];
    for name in ["cloud.las", "cloud.laz"] {
        let mut bytes = Cursor::new(Vec::new());
        belvedere_io::write_cloud(belvedere_io::Output::writer(name, &mut bytes), &cloud, &[]).unwrap();
        let bytes = bytes.into_inner();
        let read = |rows: Option<Vec<std::ops::Range<u64>>>| {
            let read = AtomicU64::new(0);
            let source = Source::reader(name, CountingReader(Cursor::new(&bytes), &read));
            let source = if let Some(rows) = rows { source.with_likely_rows(rows) } else { source };
            let (cloud, report) = read_cloud([source], &options, &Control::none()).unwrap();
            (cloud.positions, report.left_out_count(), read.load(Ordering::Relaxed))
        };
        let (expected, left_out, whole) = read(None);
        let (found, passed_over, part) = read(Some(rows.clone()));
        assert!((2700..3300).contains(&expected.len()), "{name}: {}", expected.len());
        assert_eq!(found, expected, "{name}");
        assert_eq!(passed_over, left_out, "{name}");
        // 57,000 of 300,000 rows; chunks of LAZ have 50,000: rows 100,000 to 200,000 and 250,000 to 300,000
        let max = if name == "cloud.laz" { 0.55 } else { 0.2 };
        assert!((part as f64) < max * whole as f64, "{name}: {part} of {whole} bytes");
    }
}

/// The points of a window and the notes of the report on the hierarchy, which `damage` changed.
fn window_of(nodes: &[OctreeNode], damage: &dyn Fn(&mut Vec<u8>), options: &ReadOptions) -> (usize, String) {
    let bytes = copc(nodes, damage);
    let (cloud, report) = read_cloud([Source::bytes("tile.copc.laz", &bytes)], options, &Control::none())
        .unwrap_or_else(|e| panic!("{e}"));
    let about = report.files[0].notes.iter().find(|note| note.contains("hierarchy"));
    let head = read_las_head(Source::bytes("tile.copc.laz", &bytes)).unwrap();
    assert_eq!(head.notes.len(), usize::from(about.is_some()), "{:?}", head.notes);
    (cloud.len(), about.cloned().unwrap_or_default())
}

#[test]
fn a_hierarchy_that_is_not_that_of_the_points_is_passed_over() {
    let nodes = nodes(12_000);
    let options = window([10.0, 10.0], 50.0);
    let (expected, note) = window_of(&nodes, &|_| {}, &options);
    assert!(expected > 10 && note.is_empty(), "{note}");
    // the last 32 bytes are an entry of the root page; the first node stands in front of the pages' entries
    let root = |hierarchy: &mut Vec<u8>| hierarchy.len() - 32;
    let damaged = |damage: &dyn Fn(&mut Vec<u8>)| {
        let (found, note) = window_of(&nodes, damage, &options);
        assert_eq!(found, expected, "{note}");
        assert!(note.contains("read in the order of the file"), "{note}");
        note
    };
    for (at, field) in [
        // bytes of a page: negative, beyond the file
        (24, (-5_i32).to_le_bytes().to_vec()),
        (24, i32::MAX.to_le_bytes().to_vec()),
        // its place
        (16, u64::MAX.to_le_bytes().to_vec()),
        // points of a chunk in these bytes
        (28, i32::MAX.to_le_bytes().to_vec()),
        (28, (-2_i32).to_le_bytes().to_vec()),
        // a node that is hidden
        (28, 0_i32.to_le_bytes().to_vec()),
        // no octree is as deep, no cell there
        (0, 1000_i32.to_le_bytes().to_vec()),
        (0, (-1_i32).to_le_bytes().to_vec()),
        (4, (-1_i32).to_le_bytes().to_vec()),
    ] {
        damaged(&|hierarchy| {
            let first = root(hierarchy);
            // a node that meets the window
            hierarchy[first..first + 16].fill(0);
            hierarchy[first + at..first + at + field.len()].copy_from_slice(&field);
        });
    }
    // two entries of the root page name the same page
    let note = damaged(&|hierarchy| {
        let first = root(hierarchy);
        hierarchy[first..first + 16].fill(0);
        hierarchy.copy_within(first..first + 32, first - 32);
    });
    assert!(note.contains("named twice"), "{note}");
    // two chunks that change places, as where another program has sorted the points
    damaged(&|hierarchy| {
        let (a, b) = (60..92, 92..124);
        let [first, second] = [a.clone(), b.clone()].map(|at| hierarchy[at][16..28].to_vec());
        hierarchy[a][16..28].copy_from_slice(&second);
        hierarchy[b][16..28].copy_from_slice(&first);
    });
}

#[test]
fn records_of_copc_that_a_plain_file_kept_are_passed_over() {
    let nodes = nodes(12_000);
    let options = window([10.0, 10.0], 50.0);
    let expected = window_of(&nodes, &|_| {}, &options).0;
    let mut bytes = copc(&nodes, |_| {});
    // a program that does not know the extended record leaves it out, and the record of the octree in
    bytes[243..247].fill(0);
    for names_root in [true, false] {
        if !names_root {
            bytes[375 + 54 + 24..375 + 54 + 56].fill(0);
        }
        let source = Source::bytes("tile.laz", &bytes);
        let (cloud, report) = read_cloud([source], &options, &Control::none()).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(cloud.len(), expected);
        let (all, whole) =
            read_cloud([Source::bytes("tile.laz", &bytes)], &ReadOptions::new(), &Control::none()).unwrap();
        assert_eq!((all.len(), whole.files[0].format.as_str()), (12_000, "LAS 1.4, point format 6, LAZ"));
        assert!(whole.files[0].notes.iter().any(|note| note.contains("hierarchy is not that")), "{:?}", whole.files);
        assert!(report.files[0].notes.iter().any(|note| note.contains("hierarchy is not that")), "{:?}", report.files);
    }
}

#[test]
fn a_window_of_copc_files_of_others_is_that_of_all_their_points() {
    let Some(path) = data("a_window_of_copc_files_of_others", "data/io_cases/1.2-with-color.copc.laz") else { return };
    let (all, _) = read_cloud([&path], &ReadOptions::new(), &Control::none()).unwrap();
    let bounds = all.bounds().unwrap();
    let frame = all.frame.clone();
    let middle = [0, 1].map(|i| bounds.low[i] + 0.4 * (bounds.high[i] - bounds.low[i]));
    let low = [middle[0], middle[1], bounds.low[2]];
    let size = bounds.size();
    let high = [middle[0] + 0.3 * size[0], middle[1] + 0.3 * size[1], bounds.high[2]];
    let within = belvedere_data::Bounds { low, high };
    let options = ReadOptions::new().with_frame(frame).with_points_within(Within::Local(within));
    let (found, _) = read_cloud([&path], &options, &Control::none()).unwrap();
    let expected: Vec<[f32; 3]> = all.positions.iter().copied().filter(|&p| within.contains(p)).collect();
    assert!(expected.len() > 10 && expected.len() < all.len());
    assert_eq!(found.positions, expected);
}

/// A folder of three tiles beside each other and a catalogue of them; the third tile is no LAZ file at all.
fn tiles() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let mut features = Vec::new();
    for tile in 0..3 {
        let name = format!("tile_{tile}.laz");
        let x = f64::from(tile) * 100.0;
        let positions = (0..1000_u64).map(|i| {
            let [a, b] = [2 * i, 2 * i + 1].map(|number| (100.0 * uniform(5, number)) as f32);
            [a, b, 1.0]
        });
        let frame = belvedere_data::Frame { origin: [x, 0.0, 0.0], ..Default::default() };
        let cloud = belvedere_data::PointCloud {
            positions: positions.collect(),
            ..belvedere_data::PointCloud::in_frame(frame)
        };
        let path = folder.path().join(&name);
        belvedere_io::write_cloud(&path, &cloud, &[]).unwrap();
        if tile == 2 {
            std::fs::write(&path, b"nothing").unwrap();
        }
        features.push(format!(
            r#"{{"type":"Feature","assets":{{"data":{{"href":"./{name}"}}}},"properties":{{"proj:bbox":[{x},0,0,{},100,2]}}}}"#,
            x + 100.0
        ));
    }
    let catalogue = format!(r#"{{"type":"FeatureCollection","features":[{}]}}"#, features.join(","));
    std::fs::write(folder.path().join("all.vpc"), catalogue).unwrap();
    folder
}

#[test]
fn a_catalogue_opens_only_the_tiles_of_the_window() {
    let folder = tiles();
    let catalogue = folder.path().join("all.vpc");
    let options = window([50.0, 0.0], 100.0);
    let (cloud, report) = read_cloud([&catalogue], &options, &Control::none()).unwrap();
    assert_eq!(report.files.len(), 2);
    assert!((900..1100).contains(&cloud.len()), "{}", cloud.len());
    let batches: usize =
        read_batches([&catalogue], &options, &Control::none()).unwrap().map(|batch| batch.unwrap().cloud.len()).sum();
    assert_eq!(batches, cloud.len());
    // a tile that is needed and damaged is named
    let error = read_cloud([&catalogue], &ReadOptions::new(), &Control::none()).unwrap_err().to_string();
    assert!(error.contains("tile_2.laz"), "{error}");
    let error = read_cloud([&catalogue], &window([900.0, 0.0], 10.0), &Control::none()).unwrap_err().to_string();
    assert!(error.contains("all.vpc"), "{error}");
}

#[test]
fn what_is_no_catalogue_is_refused_by_name() {
    for (text, expected) in [
        ("{", "is no catalogue"),
        ("{}", "no `features`"),
        (r#"{"features":[{}]}"#, "no file for tile 1"),
        (r#"{"features":[{"assets":{"data":{"href":"s3://a.org/b.laz"}}}]}"#, "download it first"),
    ] {
        let source = Source::bytes("c.vpc", text);
        let error = read_cloud([source], &ReadOptions::new(), &Control::none()).unwrap_err().to_string();
        assert!(error.contains("c.vpc") && error.contains(expected), "{error}");
    }
}
