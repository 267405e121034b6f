//! Damaged and malicious files: every reader must answer with an error or a report, never panic, hang or allocate more
//! than the file can hold.

use std::io::Cursor;
use std::path::{Path, PathBuf};

use belvedere_data::control::Control;
use belvedere_io::{ReadOptions, read_cloud};

/// Points of each small valid file.
const POINTS: u32 = 60;

/// A named valid file to damage.
struct Valid {
    name: &'static str,
    bytes: Vec<u8>,
}

fn coordinates(i: u32) -> [f64; 3] {
    let t = f64::from(i);
    [85_000.0 + t, 447_000.0 + (t * 0.7).sin() * 10.0, 3.0 + (t * 0.3).cos()]
}

fn las(format: u8, compressed: bool) -> Vec<u8> {
    let mut builder = las::Builder::from((1, 4));
    builder.point_format = las::point::Format::new(format).unwrap();
    builder.point_format.is_compressed = compressed;
    builder.transforms = las::Vector {
        x: las::Transform { scale: 0.001, offset: 85_000.0 },
        y: las::Transform { scale: 0.001, offset: 447_000.0 },
        z: las::Transform { scale: 0.001, offset: 0.0 },
    };
    let mut writer = las::Writer::new(Cursor::new(Vec::new()), builder.into_header().unwrap()).unwrap();
    for i in 0..POINTS {
        let [x, y, z] = coordinates(i);
        let has = |yes: bool| yes.then_some(1000.0 + f64::from(i));
        let point_format = *writer.header().point_format();
        writer
            .write_point(las::Point {
                x,
                y,
                z,
                return_number: 1,
                number_of_returns: 2,
                intensity: 7,
                gps_time: has(point_format.has_gps_time),
                color: point_format.has_color.then(|| las::Color::new(300, 2, 3)),
                nir: point_format.has_nir.then_some(5),
                ..las::Point::default()
            })
            .unwrap();
    }
    writer.into_inner().unwrap().into_inner()
}

fn ply(encoding: &str) -> Vec<u8> {
    let mut bytes = format!(
        "ply\nformat {encoding} 1.0\nelement vertex {POINTS}\nproperty double x\nproperty double y\nproperty double z\n\
         property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n\
         property list uchar int vertex_indices\nend_header\n"
    )
    .into_bytes();
    for i in 0..POINTS {
        let p = coordinates(i);
        match encoding {
            "ascii" => bytes.extend(format!("{} {} {} 1 2 3\n", p[0], p[1], p[2]).bytes()),
            "binary_little_endian" => bytes.extend(p.iter().flat_map(|v| v.to_le_bytes()).chain([1, 2, 3])),
            _ => bytes.extend(p.iter().flat_map(|v| v.to_be_bytes()).chain([1, 2, 3])),
        }
    }
    match encoding {
        "ascii" => bytes.extend(b"3 0 1 2\n"),
        _ => bytes.extend([3, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 2]),
    }
    bytes
}

fn pcd(data: &str) -> Vec<u8> {
    let mut bytes = format!(
        "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z rgb\nSIZE 8 8 8 4\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH {POINTS}\nHEIGHT 1\n\
         VIEWPOINT 0 0 0 1 0 0 0\nPOINTS {POINTS}\nDATA {data}\n"
    )
    .into_bytes();
    let points: Vec<[f64; 3]> = (0..POINTS).map(coordinates).collect();
    match data {
        "ascii" => bytes.extend(points.iter().flat_map(|p| format!("{} {} {} 255\n", p[0], p[1], p[2]).into_bytes())),
        "binary" => {
            bytes.extend(points.iter().flat_map(|p| {
                p.iter().flat_map(|v| v.to_le_bytes()).chain(255_u32.to_le_bytes()).collect::<Vec<u8>>()
            }));
        }
        _ => {
            let mut plain: Vec<u8> =
                (0..3).flat_map(|axis| points.iter().flat_map(move |p| p[axis].to_le_bytes())).collect();
            plain.extend((0..POINTS).flat_map(|_| 255_u32.to_le_bytes()));
            // Literal runs are valid LZF, if no compression.
            let packed: Vec<u8> =
                plain.chunks(32).flat_map(|run| [&[u8::try_from(run.len() - 1).unwrap()], run].concat()).collect();
            bytes.extend(u32::try_from(packed.len()).unwrap().to_le_bytes());
            bytes.extend(u32::try_from(plain.len()).unwrap().to_le_bytes());
            bytes.extend(packed);
        }
    }
    bytes
}

fn npy(descr: &str, shape: &str) -> Vec<u8> {
    let mut header = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': {shape}, }}");
    while !(header.len() + 11).is_multiple_of(64) {
        header.push(' ');
    }
    header.push('\n');
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend(u16::try_from(header.len()).unwrap().to_le_bytes());
    bytes.extend(header.bytes());
    for v in (0..POINTS).flat_map(coordinates) {
        match descr {
            "<f8" => bytes.extend(v.to_le_bytes()),
            ">f8" => bytes.extend(v.to_be_bytes()),
            _ => bytes.extend((v as f32).to_le_bytes()),
        }
    }
    bytes
}

fn xyz() -> Vec<u8> {
    (0..POINTS).map(coordinates).flat_map(|p| format!("{} {} {}\n", p[0], p[1], p[2]).into_bytes()).collect()
}

fn ptx() -> Vec<u8> {
    let header = b"60\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";
    [header.to_vec(), xyz()].concat()
}

pub(crate) fn e57() -> Vec<u8> {
    let mut cursor = Cursor::new(Vec::new());
    let mut writer = e57::E57Writer::new(&mut cursor, "file").unwrap();
    let double = e57::RecordDataType::Double { min: None, max: None };
    let prototype = vec![
        e57::Record { name: e57::RecordName::CartesianX, data_type: double.clone() },
        e57::Record { name: e57::RecordName::CartesianY, data_type: double.clone() },
        e57::Record { name: e57::RecordName::CartesianZ, data_type: double },
        e57::Record {
            name: e57::RecordName::CartesianInvalidState,
            data_type: e57::RecordDataType::Integer { min: 0, max: 2 },
        },
    ];
    let mut scan = writer.add_pointcloud("scan", prototype).unwrap();
    for i in 0..POINTS {
        let mut values: Vec<e57::RecordValue> = coordinates(i).into_iter().map(e57::RecordValue::Double).collect();
        values.push(e57::RecordValue::Integer(i64::from(i % 10 == 0)));
        scan.add_point(values).unwrap();
    }
    scan.finalize().unwrap();
    writer.finalize().unwrap();
    drop(writer);
    cursor.into_inner()
}

fn valid_files() -> Vec<Valid> {
    vec![
        Valid { name: "pf3.las", bytes: las(3, false) },
        Valid { name: "pf8.las", bytes: las(8, false) },
        Valid { name: "pf1.laz", bytes: las(1, true) },
        Valid { name: "pf3.laz", bytes: las(3, true) },
        Valid { name: "pf6.laz", bytes: las(6, true) },
        Valid { name: "pf8.laz", bytes: las(8, true) },
        Valid { name: "ascii.ply", bytes: ply("ascii") },
        Valid { name: "little.ply", bytes: ply("binary_little_endian") },
        Valid { name: "big.ply", bytes: ply("binary_big_endian") },
        Valid { name: "ascii.pcd", bytes: pcd("ascii") },
        Valid { name: "binary.pcd", bytes: pcd("binary") },
        Valid { name: "packed.pcd", bytes: pcd("binary_compressed") },
        Valid { name: "f4.npy", bytes: npy("<f4", "(60, 3)") },
        Valid { name: "f8.npy", bytes: npy("<f8", "(60, 3)") },
        Valid { name: "text.xyz", bytes: xyz() },
        Valid { name: "scan.e57", bytes: e57() },
        Valid { name: "scan.ptx", bytes: ptx() },
    ]
}

/// Numbers that repeat from run to run (Knuth's multiplicative generator).
struct RepeatableRandom(u64);

impl RepeatableRandom {
    fn below(&mut self, limit: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        usize::try_from(self.0 >> 33).unwrap() % limit.max(1)
    }
}

/// Reads the file at `path`; a message where the reader misbehaves.
fn misbehaviour(path: &Path, size: usize) -> Option<String> {
    let paths = [path.to_owned()];
    match read_cloud(&paths, &ReadOptions::default(), &Control::none()) {
        Err(error) if error.to_string().is_empty() => Some("gives an empty error".to_owned()),
        Err(_) => None,
        Ok((cloud, report)) => {
            let reported: usize = report.files.iter().map(|file| file.points).sum();
            if cloud.len() > size {
                Some(format!("gives {} points from {size} bytes", cloud.len()))
            } else if reported != cloud.len() {
                Some(format!("reports {reported} points but gives {}", cloud.len()))
            } else {
                cloud.validate().err().map(|error| error.to_string())
            }
        }
    }
}

struct Trial {
    folder: tempfile::TempDir,
    faults: Vec<String>,
    inputs: usize,
}

impl Trial {
    fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap(), faults: Vec::new(), inputs: 0 }
    }

    fn read(&mut self, name: &str, what: &str, bytes: &[u8]) {
        let path = self.folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        self.inputs += 1;
        if let Some(fault) = misbehaviour(&path, bytes.len()) {
            self.faults.push(format!("{name}, {what}: {fault}"));
        }
    }

    fn finish(self, min: usize) {
        assert!(self.faults.is_empty(), "{} of {}:\n{}", self.faults.len(), self.inputs, self.faults.join("\n"));
        assert!(self.inputs >= min, "only {} inputs", self.inputs);
    }
}

#[test]
fn undamaged_files_read() {
    let folder = tempfile::tempdir().unwrap();
    for file in valid_files() {
        let path = folder.path().join(file.name);
        std::fs::write(&path, &file.bytes).unwrap();
        let (cloud, report) =
            read_cloud(&[path], &ReadOptions::default(), &Control::none()).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(cloud.len() + report.left_out_count(), POINTS as usize, "{}", file.name);
        let p = cloud.frame.to_file_coordinates(cloud.positions[1]);
        let expected = coordinates(if file.name == "scan.e57" { 2 } else { 1 });
        // Single precision at 447 km steps by 3 cm.
        let tolerance = if file.name == "f4.npy" { 0.05 } else { 0.001 };
        assert!((0..3).all(|i| (p[i] - expected[i]).abs() < tolerance), "{}: {p:?}", file.name);
    }
}

#[test]
fn truncated_files_are_refused_or_counted() {
    let mut trial = Trial::new();
    for file in valid_files() {
        let length = file.bytes.len();
        let ends = (0..40).map(|i| length * i / 40).chain([1, 4, 100, 226, 227, 374, 375, 376, length - 1]);
        for end in ends {
            let end = end.min(length);
            trial.read(file.name, &format!("cut at {end}"), &file.bytes[..end]);
        }
    }
    trial.finish(500);
}

#[test]
fn flipped_bits_are_survived() {
    let mut trial = Trial::new();
    let mut random = RepeatableRandom(1);
    for file in valid_files() {
        // The first half of the trials goes for the headers, where sizes and counts are.
        for i in 0..200 {
            let mut bytes = file.bytes.clone();
            let range = if i % 2 == 0 { bytes.len().min(500) } else { bytes.len() };
            let mut places = Vec::new();
            for _ in 0..=random.below(3) {
                let (place, bit) = (random.below(range), random.below(8));
                bytes[place] ^= 1 << bit;
                places.push((place, bit));
            }
            trial.read(file.name, &format!("bits {places:?} flipped"), &bytes);
        }
    }
    trial.finish(3000);
}

#[test]
fn overwritten_stretches_are_survived() {
    let mut trial = Trial::new();
    let mut random = RepeatableRandom(2);
    for file in valid_files() {
        for value in [0x00, 0xff, 0x7f] {
            for _ in 0..20 {
                let mut bytes = file.bytes.clone();
                let start = random.below(bytes.len());
                let end = (start + 1 + random.below(16)).min(bytes.len());
                bytes[start..end].fill(value);
                trial.read(file.name, &format!("{start}..{end} filled with {value}"), &bytes);
            }
        }
    }
    trial.finish(900);
}

#[test]
fn absurd_las_headers_are_survived() {
    let mut trial = Trial::new();
    for file in valid_files().into_iter().filter(|file| file.name.contains(".la")) {
        let mut with = |what: &str, at: usize, value: &[u8]| {
            let mut bytes = file.bytes.clone();
            bytes[at..at + value.len()].copy_from_slice(value);
            trial.read(file.name, what, &bytes);
        };
        for count in [0, 1, u32::MAX / 2, u32::MAX] {
            with("legacy point count", 107, &count.to_le_bytes());
            with("record count", 100, &count.to_le_bytes());
            with("points start", 96, &count.to_le_bytes());
            with("extended record count", 243, &count.to_le_bytes());
        }
        for count in [0, 1, u64::from(u32::MAX), u64::MAX / 40, u64::MAX] {
            with("point count", 247, &count.to_le_bytes());
            with("extended record start", 235, &count.to_le_bytes());
        }
        for length in [0, 1, 19, 20, 1000, u16::MAX] {
            with("record length", 105, &length.to_le_bytes());
            with("header size", 94, &length.to_le_bytes());
        }
        for scale in [0.0, -0.001, f64::NAN, f64::INFINITY, 1e300, 1e-300] {
            with("scale", 131, &scale.to_le_bytes());
            with("offset", 155, &scale.to_le_bytes());
        }
        for format in 0..=255_u8 {
            with("point format", 104, &[format]);
        }
    }
    trial.finish(1000);
}

#[test]
fn laz_chunk_sizes_are_checked_against_the_file() {
    let mut trial = Trial::new();
    for file in valid_files().into_iter().filter(|file| Path::new(file.name).extension().is_some_and(|e| e == "laz")) {
        let start = usize::try_from(u32::from_le_bytes(file.bytes[96..100].try_into().unwrap())).unwrap();
        let table = usize::try_from(u64::from_le_bytes(file.bytes[start..start + 8].try_into().unwrap())).unwrap();
        let vlr = file.bytes.windows(14).position(|w| w == b"laszip encoded").unwrap() + 52;
        let mut with = |what: &str, at: usize, value: &[u8]| {
            let mut bytes = file.bytes.clone();
            bytes[at..at + value.len()].copy_from_slice(value);
            trial.read(file.name, what, &bytes);
        };
        for value in [0, 1, 2, 59, 60, 61, 1 << 20, u32::MAX / 2, u32::MAX - 1, u32::MAX] {
            with("chunk count", table + 4, &value.to_le_bytes());
            with("chunk size", vlr + 12, &value.to_le_bytes());
        }
        for at in table + 8..file.bytes.len().min(table + 40) {
            with("chunk table", at, &[0xff]);
        }
        for value in [0, 1, start as u64, file.bytes.len() as u64, u64::MAX] {
            with("chunk table offset", start, &value.to_le_bytes());
        }
        // Types, sizes and versions of the items; a wrong type makes the decompressor misread the sizes of layers.
        for at in vlr + 32..vlr + 52 {
            for bit in 0..8 {
                with("item", at, &[file.bytes[at] ^ (1 << bit)]);
            }
        }
        for at in 0..150 {
            with("first chunk", start + 8 + at, &[0xff]);
        }
    }
    trial.finish(700);
}

#[test]
fn absurd_text_headers_are_survived() {
    let mut trial = Trial::new();
    for count in ["0", "-1", "4000000000", "18446744073709551615", "99999999999999999999999", "1e9", ""] {
        for file in valid_files() {
            let text = String::from_utf8_lossy(&file.bytes);
            let extension = Path::new(file.name).extension().unwrap();
            // Only the header of binary files is replaced, so that their bytes stay as they are.
            let header = match extension.to_str().unwrap() {
                "ply" => text.split_once("end_header").map(|(h, _)| h.replace("vertex 60", &format!("vertex {count}"))),
                "pcd" => text.split_once("DATA").map(|(h, _)| {
                    h.replace("POINTS 60", &format!("POINTS {count}")).replace("WIDTH 60", &format!("WIDTH {count}"))
                }),
                _ => None,
            };
            let Some(header) = header else { continue };
            let marker: &[u8] = if extension == "ply" { b"end_header" } else { b"DATA" };
            let body = file.bytes.windows(marker.len()).position(|w| w == marker).unwrap();
            trial.read(file.name, &format!("count {count}"), &[header.as_bytes(), &file.bytes[body..]].concat());
        }
        for shape in
            [format!("({count}, 3)"), format!("(3, {count})"), format!("({count}, {count}, 3)"), count.to_owned()]
        {
            trial.read("shape.npy", &format!("shape {shape}"), &npy("<f8", &shape));
        }
    }
    for (name, content) in [
        ("empty-element.ply", "ply\nformat ascii 1.0\nelement vertex 4000000000\nend_header\n"),
        (
            "list.ply",
            "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty list uint double x\nproperty float y\nproperty float z\nend_header\n\u{7f}\u{7f}\u{7f}\u{7f}",
        ),
        ("nested.npy", "\u{93}NUMPY"),
        ("fields.pcd", "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 4294967295 1 1\nPOINTS 1\nDATA binary\n"),
        ("fields2.pcd", "FIELDS x y z\nSIZE 3 4 4\nTYPE F F F\nCOUNT 1 1 1\nPOINTS 1\nDATA binary\n"),
        ("nofields.pcd", "POINTS 4000000000\nDATA ascii\n"),
        ("nan.xyz", "nan nan nan\ninf 1 2\n1e400 0 0\n"),
        ("zero.xyz", ""),
        ("comment.xyz", "# nothing\n"),
        ("binary.xyz", "\0\0\0\0\0\u{1}\u{2}"),
    ] {
        trial.read(name, "hand-made", content.as_bytes());
    }
    let deep = format!("{}1{}", "(".repeat(60_000), ")".repeat(60_000));
    trial.read("deep.npy", "nested header", &npy("<f8", &deep[..30_000]));
    trial.read("long.xyz", "one long line", &vec![b'1'; 1 << 20]);
    trial.finish(60);
}

/// An E57 file whose XML is changed by `edit` before its checksums are made.
fn e57_with_xml(edit: impl Fn(String) -> String) -> Vec<u8> {
    let mut cursor = Cursor::new(Vec::new());
    let mut writer = e57::E57Writer::new(&mut cursor, "file").unwrap();
    let integer = |name| e57::Record { name, data_type: e57::RecordDataType::Integer { min: 5, max: 6 } };
    let prototype = vec![
        integer(e57::RecordName::CartesianX),
        integer(e57::RecordName::CartesianY),
        integer(e57::RecordName::CartesianZ),
    ];
    let mut scan = writer.add_pointcloud("scan", prototype).unwrap();
    for i in 0..50 {
        scan.add_point((0..3).map(|axis| e57::RecordValue::Integer(5 + (i >> axis & 1))).collect()).unwrap();
    }
    scan.finalize().unwrap();
    writer.finalize_customized_xml(|xml| Ok(edit(xml))).unwrap();
    drop(writer);
    cursor.into_inner()
}

#[test]
fn absurd_e57_descriptions_are_survived() {
    let mut trial = Trial::new();
    for (from, to) in [
        // Records of no bits: nothing would ever run out.
        ("maximum=\"6\"", "maximum=\"5\""),
        ("maximum=\"6\"", "maximum=\"4\""),
        ("maximum=\"6\"", "maximum=\"9223372036854775807\""),
        ("minimum=\"5\"", "minimum=\"-9223372036854775808\""),
        ("type=\"Integer\"", "type=\"Float\" precision=\"single\""),
        ("type=\"Integer\"", "type=\"ScaledInteger\" scale=\"NaN\""),
        ("type=\"Integer\"", "type=\"ScaledInteger\" scale=\"1e308\" offset=\"inf\""),
        ("recordCount=\"50\"", "recordCount=\"18446744073709551615\""),
        ("recordCount=\"50\"", "recordCount=\"4000\""),
        ("recordCount=\"50\"", "recordCount=\"51\""),
        ("recordCount=\"50\"", "recordCount=\"0\""),
        ("recordCount=\"50\"", "recordCount=\"-1\""),
        ("fileOffset=\"48\"", "fileOffset=\"0\""),
        ("fileOffset=\"48\"", "fileOffset=\"47\""),
        ("fileOffset=\"48\"", "fileOffset=\"18446744073709551615\""),
        ("fileOffset=\"48\"", "fileOffset=\"1024\""),
        ("cartesianX", "cartesianQ"),
        ("cartesianX", "cartesianY"),
        ("cartesian", "spherical"),
        ("<prototype type=\"Structure\">", "<prototype type=\"Structure\"></prototype><other>"),
        ("</e57Root>", ""),
    ] {
        trial.read("edited.e57", &format!("{from} is {to}"), &e57_with_xml(|xml| xml.replace(from, to)));
    }
    let deep = e57_with_xml(|xml| xml.replace("</e57Root>", &format!("{}</e57Root>", "<a>".repeat(200_000))));
    trial.read("deep.e57", "nested", &deep);
    trial.finish(20);
}

#[test]
fn files_without_points_are_an_error_only_where_no_file_has_any() {
    let folder = tempfile::tempdir().unwrap();
    let empty = folder.path().join("empty.xyz");
    let full = folder.path().join("full.xyz");
    std::fs::write(&empty, "# no points\n").unwrap();
    std::fs::write(&full, xyz()).unwrap();
    let error = read_cloud(std::slice::from_ref(&empty), &ReadOptions::default(), &Control::none()).unwrap_err();
    assert!(
        matches!(error, belvedere_data::Error::NoPoints { .. }) && error.to_string().contains("empty.xyz"),
        "{error}"
    );
    let (cloud, report) = read_cloud(&[empty, full], &ReadOptions::default(), &Control::none()).unwrap();
    assert_eq!((cloud.len(), report.files.len()), (POINTS as usize, 2));
}

#[test]
fn wrong_las_counts_are_reported() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("short.las");
    let bytes = las(3, false);
    std::fs::write(&path, &bytes[..bytes.len() - 34 * 10 - 5]).unwrap();
    let (cloud, report) = read_cloud(&[path], &ReadOptions::default(), &Control::none()).unwrap();
    assert_eq!((cloud.len(), report.left_out_count()), (49, 11));
    assert!(report.files[0].notes.iter().any(|note| note.contains("holds only 49")), "{:?}", report.files[0]);
}

#[test]
fn truncated_shared_files_are_survived() {
    let mut trial = Trial::new();
    for file in [
        "io_cases/1.2-with-color.copc.laz",
        "io_cases/4_6_crop.las",
        "io_cases/autzen-utm.pcd",
        "io_cases/extrabytes.las",
        "io_cases/test1_4.las",
        "quantised/samp11-utm.pcd",
        "tls_e57/bunnyInt32.e57",
        "tls_e57/testWithNormals.e57",
        "tls_e57/translationWithoutRotation.e57",
        "tudelft_ahn4_small/small.laz",
        "trees/ahn3_delft.xyz",
        "house_dyke_tree/house_dyke_tree.points.ply",
        "random3dcity/NPY/coords.npy",
    ] {
        let Some(path) = crate::common::data("truncated_shared_files_are_survived", &format!("data/{file}")) else {
            continue;
        };
        let bytes = std::fs::read(&path).unwrap();
        let name = PathBuf::from(file).file_name().unwrap().to_string_lossy().into_owned();
        let mut random = RepeatableRandom(3);
        for i in 0..12 {
            let end = bytes.len() * i / 12;
            trial.read(&name, &format!("cut at {end}"), &bytes[..end]);
            let mut flipped = bytes.clone();
            let place = random.below(flipped.len());
            flipped[place] ^= 0x55;
            trial.read(&name, &format!("byte {place} changed"), &flipped);
        }
    }
    trial.finish(0);
}
