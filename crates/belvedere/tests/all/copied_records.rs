//! Points of LAS files are written with all that their files hold: records are copied, and results added.

use std::fs;
use std::path::{Path, PathBuf};

use belvedere::PointCloud;
use belvedere::cloud::FileRows;
use belvedere::control::Control;
use belvedere::io::{ExtraColumn, ExtraValues, ReadOptions, WriteReport, read_cloud, read_point_results, write_cloud};
use belvedere::random::uniform;
use las::point::Format;
use las::{Builder, PointDataBuilder, Transform, Vector, Vlr, Writer};
use tempfile::TempDir;

const COUNT: usize = 500;

/// A file to be made: its point format and extra bytes (name and type of each), and what differs from file to file.
#[derive(Clone)]
struct RichFile {
    format: u8,
    extra: Vec<(&'static str, u8)>,
    scale: f64,
    offset: f64,
    seed: u64,
}

impl RichFile {
    fn new(format: u8, extra: &[(&'static str, u8)]) -> Self {
        Self { format, extra: extra.to_vec(), scale: 0.001, offset: 100.0, seed: 1 }
    }
}

const U16: u8 = 3;
const F32: u8 = 9;

fn width(kind: u8) -> usize {
    [0, 1, 1, 2, 2, 4, 4, 8, 8, 4, 8][usize::from(kind)]
}

fn vlr(user: &str, record_id: u16, data: &[u8]) -> Vlr {
    Vlr { user_id: user.to_owned(), record_id, description: "of a test".to_owned(), data: data.to_vec() }
}

/// Writes a file whose records are random beyond their coordinates.
fn write(path: &Path, file: &RichFile) {
    let mut builder = Builder::from((1, 4));
    builder.point_format = Format::new(file.format).unwrap();
    builder.point_format.is_compressed = path.extension().is_some_and(|e| e == "laz");
    builder.point_format.extra_bytes = file.extra.iter().map(|(_, kind)| width(*kind) as u16).sum();
    let transform = Transform { scale: file.scale, offset: file.offset };
    builder.transforms = Vector { x: transform, y: transform, z: transform };
    builder.file_source_id = 4711;
    builder.system_identifier = "SCANNER X".to_owned();
    builder.vlrs.push(vlr("MyCompany", 7, b"flight 12"));
    builder.evlrs.push(vlr("MyCompany", 8, &[5; 70_000]));
    if !file.extra.is_empty() {
        let describe = |(name, kind): &(&str, u8)| {
            let mut bytes = [0; 192];
            bytes[2] = *kind;
            bytes[4..4 + name.len()].copy_from_slice(name.as_bytes());
            bytes
        };
        builder.vlrs.push(vlr("LASF_Spec", 4, &file.extra.iter().flat_map(describe).collect::<Vec<u8>>()));
    }
    let header = builder.into_header().unwrap();
    let mut writer = Writer::new(fs::File::create(path).unwrap(), header).unwrap();
    let mut points = PointDataBuilder::new().for_header(writer.header()).build();
    let length = points.record_len();
    let is_extended = file.format >= 6;
    for (row, record) in points.resize_for(COUNT).chunks_exact_mut(length).enumerate() {
        let byte = |at: usize| (uniform(file.seed, (row * 256 + at) as u64) * 256.0) as u8;
        record.iter_mut().enumerate().for_each(|(at, own)| *own = byte(at));
        for (axis, steps) in [(row % 20) * 1000, (row / 20) * 1000, (row % 7) * 100].into_iter().enumerate() {
            record[4 * axis..4 * axis + 4].copy_from_slice(&(steps as i32).to_le_bytes());
        }
        // one return of one, or the reader notes it
        record[14] = if is_extended { 0x11 } else { record[14] & 0xc0 | 0b1001 };
        let time_at = if is_extended { 22 } else { 20 };
        if ![0, 2].contains(&file.format) {
            record[time_at..time_at + 8].copy_from_slice(&(1000.0 + row as f64).to_le_bytes());
        }
    }
    writer.write_points(&points).unwrap();
    writer.close().unwrap();
}

/// Header and records of a file.
fn raw(path: &Path) -> (las::Header, Vec<Vec<u8>>) {
    let mut reader = las::Reader::from_path(path).unwrap();
    let header = reader.header().clone();
    let points = reader.read_all().unwrap();
    let records = points.raw_bytes().chunks_exact(points.record_len()).map(<[u8]>::to_vec).collect();
    (header, records)
}

fn read(paths: &[PathBuf]) -> PointCloud {
    read_cloud(paths, &ReadOptions::new(), &Control::none()).unwrap().0
}

/// Writes a cloud with a column "answer", 0 1 2 0 1 2 …
fn with_answers(path: &Path, cloud: &PointCloud) -> WriteReport {
    let codes: Vec<u8> = (0..cloud.len()).map(|row| (row % 3) as u8).collect();
    let column = ExtraColumn { name: "answer", description: "", values: ExtraValues::U8(&codes) };
    write_cloud(path, cloud, &[column]).unwrap()
}

#[test]
fn every_byte_of_a_record_stays_in_every_point_format() {
    let folder = TempDir::new().unwrap();
    for format in [0, 1, 2, 3, 6, 7, 8] {
        for (from, to) in [("a.las", "b.laz"), ("a.laz", "b.las")] {
            let [from, to] = [from, to].map(|name| folder.path().join(name));
            write(&from, &RichFile::new(format, &[("Amplitude", U16), ("Pulse width", F32)]));
            let cloud = read(std::slice::from_ref(&from));
            let report = with_answers(&to, &cloud);
            assert_eq!(report.left_out, [""; 0], "format {format}");
            let ((own, records), (header, copies)) = (raw(&from), raw(&to));
            assert_eq!(header.point_format().to_u8().unwrap() & 0x3f, format);
            assert_eq!(header.transforms(), own.transforms());
            assert_eq!((header.file_source_id(), header.system_identifier()), (4711, "SCANNER X"));
            assert_eq!(copies.len(), COUNT);
            for (row, (record, copy)) in records.iter().zip(&copies).enumerate() {
                let (same, column) = copy.split_at(record.len());
                assert!(same == record && column == [(row % 3) as u8], "format {format}, point {row}");
            }
            let of_company: Vec<&Vlr> = header.vlrs().iter().filter(|vlr| vlr.user_id == "MyCompany").collect();
            assert_eq!((of_company.len(), &of_company[0].data[..]), (1, &b"flight 12"[..]));
            assert_eq!(header.evlrs().iter().find(|vlr| vlr.record_id == 8).unwrap().data, [5; 70_000]);
            // what the file had is no result
            let results = read_point_results(&to).unwrap();
            assert_eq!(results.columns.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>(), ["answer"]);
        }
    }
}

#[test]
fn a_second_result_replaces_its_own_column_and_keeps_the_others() {
    let folder = TempDir::new().unwrap();
    let [first, second] = ["first.laz", "second.laz"].map(|name| folder.path().join(name));
    write(&first, &RichFile::new(6, &[("Amplitude", U16), ("answer", F32), ("Width", U16)]));
    let report = with_answers(&second, &read(std::slice::from_ref(&first)));
    assert_eq!(report.left_out, ["the earlier values of answer"]);
    let ((_, records), (_, copies)) = (raw(&first), raw(&second));
    for (row, (record, copy)) in records.iter().zip(&copies).enumerate() {
        assert_eq!((&copy[..32], &copy[32..34], copy[34]), (&record[..32], &record[36..38], (row % 3) as u8));
    }
    // an output over its own input
    assert_eq!(with_answers(&second, &read(std::slice::from_ref(&second))).left_out.len(), 1);
    assert_eq!(raw(&second).1, copies);
}

#[test]
fn points_that_are_selected_keep_their_own_records() {
    let folder = TempDir::new().unwrap();
    let [from, to] = ["from.laz", "to.laz"].map(|name| folder.path().join(name));
    write(&from, &RichFile::new(8, &[("Amplitude", U16)]));
    let whole = read(std::slice::from_ref(&from));
    let records = raw(&from).1;
    let classes: Vec<u8> = records.iter().map(|record| record[16]).collect();
    let wanted: Vec<u8> = (0..100).collect();
    let options = ReadOptions::new().with_classes(wanted.clone());
    let (of_classes, _) = read_cloud([&from], &options, &Control::none()).unwrap();
    let rows: Vec<usize> = (0..COUNT).filter(|&row| wanted.contains(&classes[row])).collect();
    let third: Vec<u32> = (0..COUNT as u32).step_by(3).collect();
    for (cloud, rows) in
        [(of_classes, rows), (whole.select(&third), third.iter().map(|&row| row as usize).collect::<Vec<_>>())]
    {
        assert!(matches!(cloud.files.rows, FileRows::Of(_)));
        assert_eq!(with_answers(&to, &cloud).left_out, [""; 0]);
        let copies = raw(&to).1;
        assert_eq!(copies.len(), rows.len());
        for (copy, row) in copies.iter().zip(rows) {
            assert_eq!(copy[..records[row].len()], records[row]);
        }
    }
}

#[test]
fn of_several_files_what_all_have_stays_and_the_rest_is_listed() {
    let folder = TempDir::new().unwrap();
    let [a, b, to] = ["a.laz", "b.las", "to.laz"].map(|name| folder.path().join(name));
    write(&a, &RichFile::new(8, &[("Amplitude", U16), ("Width", F32)]));
    write(&b, &RichFile { scale: 0.01, seed: 2, ..RichFile::new(1, &[("Width", F32), ("Amplitude", F32)]) });
    let cloud = read(&[a.clone(), b.clone()]);
    let report = with_answers(&to, &cloud);
    assert_eq!(report.left_out, ["colours", "near infrared", "Amplitude"]);
    let (header, copies) = raw(&to);
    let format = header.point_format();
    // the time is common, the extended fields hold those of both
    assert_eq!((format.to_u8().unwrap() & 0x3f, format.extra_bytes), (6, 4 + 1));
    assert!((header.transforms().x.scale - 0.001).abs() < 1e-12);
    let (of_a, of_b) = (raw(&a).1, raw(&b).1);
    for (record, copy) in of_a.iter().zip(&copies) {
        assert_eq!((&copy[..30], &copy[30..34]), (&record[..30], &record[40..44]));
    }
    for (record, copy) in of_b.iter().zip(&copies[COUNT..]) {
        // ten times finer steps
        let x = i32::from_le_bytes(record[..4].try_into().unwrap());
        assert_eq!(copy[..4], (10 * x).to_le_bytes());
        assert_eq!((copy[14], copy[15] & 0xc0, copy[16]), (0x11, record[14] & 0xc0, record[15] & 0x1f));
        assert_eq!((copy[17], &copy[20..22], &copy[22..30]), (record[17], &record[18..20], &record[20..28]));
        let angle = f64::from(i16::from_le_bytes(copy[18..20].try_into().unwrap())) * 0.006;
        assert!((angle - f64::from(record[16].cast_signed())).abs() < 0.0031);
        assert_eq!(copy[30..34], record[28..32]);
    }
}

#[test]
fn waveforms_are_left_out_with_a_word() {
    let folder = TempDir::new().unwrap();
    let [from, to] = ["from.las", "to.las"].map(|name| folder.path().join(name));
    for (format, kept, length) in [(4, 1, 28), (5, 3, 34), (9, 6, 30), (10, 8, 38)] {
        write(&from, &RichFile::new(format, &[("Amplitude", U16)]));
        assert_eq!(with_answers(&to, &read(std::slice::from_ref(&from))).left_out, ["waveforms"]);
        let ((_, records), (header, copies)) = (raw(&from), raw(&to));
        assert_eq!(header.point_format().to_u8().unwrap(), kept);
        for (record, copy) in records.iter().zip(&copies) {
            assert_eq!(copy[..length], record[..length]);
            assert_eq!(copy[length..length + 2], record[length + 29..length + 31]);
        }
    }
}

#[test]
fn a_file_that_changed_is_not_copied_and_what_is_lost_is_listed() {
    let folder = TempDir::new().unwrap();
    let [from, to] = ["from.laz", "to.laz"].map(|name| folder.path().join(name));
    let file = RichFile::new(6, &[("Amplitude", U16)]);
    write(&from, &file);
    let cloud = read(std::slice::from_ref(&from));
    let edited = || {
        let mut cloud = cloud.clone();
        cloud.attributes.classification.iter_mut().flatten().for_each(|class| *class = 6);
        cloud
    };
    let lost = |report: &WriteReport| {
        ["Amplitude", "user data", "MyCompany", "steps of coordinates"].map(|what| {
            assert!(report.left_out.iter().any(|name| name.contains(what)), "{what}: {:?}", report.left_out);
        })
    };
    // classes of one's own are written, not those of the file
    lost(&with_answers(&to, &edited()));
    assert!(raw(&to).1.iter().all(|record| record[16] == 6));
    write(&from, &RichFile { seed: 9, ..file });
    lost(&with_answers(&to, &cloud));
    let classes = cloud.attributes.classification.as_ref().unwrap();
    assert!(raw(&to).1.iter().zip(classes).all(|(record, class)| record[16] == *class));
    fs::remove_file(&from).unwrap();
    lost(&with_answers(&to, &cloud));
    // formats of other programs hold the attributes of a cloud
    let report = with_answers(&folder.path().join("to.ply"), &cloud);
    assert!(report.left_out.contains(&"Amplitude".to_owned()), "{:?}", report.left_out);
}

#[test]
fn colours_that_are_all_zero_are_none_and_the_field_stays() {
    let folder = TempDir::new().unwrap();
    let [from, to] = ["from.laz", "to.laz"].map(|name| folder.path().join(name));
    let mut builder = Builder::from((1, 4));
    builder.point_format = Format::new(7).unwrap();
    let mut writer = Writer::new(fs::File::create(&from).unwrap(), builder.into_header().unwrap()).unwrap();
    let mut points = PointDataBuilder::new().for_header(writer.header()).build();
    let length = points.record_len();
    for (row, record) in points.resize_for(COUNT).chunks_exact_mut(length).enumerate() {
        record[..4].copy_from_slice(&(row as i32 * 100).to_le_bytes());
        record[14] = 0x11;
    }
    writer.write_points(&points).unwrap();
    writer.close().unwrap();
    let (cloud, report) = read_cloud([&from], &ReadOptions::new(), &Control::none()).unwrap();
    assert!(cloud.attributes.color.is_none() && !report.files[0].attributes.contains(&"color"));
    assert!(report.files[0].notes.iter().any(|note| note.contains("colours are zero")), "{:?}", report.files);
    with_answers(&to, &cloud);
    assert_eq!(raw(&to).0.point_format().to_u8().unwrap() & 0x3f, 7);
}
