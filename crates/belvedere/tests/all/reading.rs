//! Reading point clouds: the figures come from laspy 2.7 with lazrs (LAS, LAZ), the XML of E57 files and the data
//! catalogue; none comes from this crate.

#![expect(clippy::unwrap_used, reason = "a test stops at the first surprise")]

use std::path::{Path, PathBuf};

use belvedere::Bounds;
use belvedere::control::Control;
use belvedere::crs::{Crs, CrsKind, US_SURVEY_FOOT};
use belvedere::io::{ReadOptions, ReadReport, read_cloud};
use belvedere::{Error, GpsTimeKind, PointCloud};

fn read(paths: &[PathBuf]) -> belvedere::Result<(PointCloud, ReadReport)> {
    read_cloud(paths, &ReadOptions::default(), &Control::none())
}

fn read_as(path: &Path, crs: &str) -> belvedere::Result<(PointCloud, ReadReport)> {
    read_cloud(&[path.to_owned()], &ReadOptions::new().with_crs(crs.to_owned()), &Control::none())
}

/// Properties of a LAS file by an outside reader.
struct ReaderTruth {
    file: &'static str,
    points: usize,
    low: [f64; 3],
    high: [f64; 3],
    /// Sum of the intensities.
    intensity: u64,
    /// Points of ASPRS class 2.
    ground: usize,
    max_return: u8,
    format: &'static str,
    epsg: Option<u32>,
    units: [f64; 2],
}

const METRES: [f64; 2] = [1.0, 1.0];

#[rustfmt::skip]
const LAS_TRUTH: &[ReaderTruth] = &[
    ReaderTruth { file: "amsterdam_ahn3/ahn_2386_9702.laz", points: 43536, low: [119_299.0, 485_099.002, -0.773], high: [119_350.999, 485_151.0, 21.067], intensity: 1_948_597, ground: 26668, max_return: 5, format: "LAS 1.2, point format 1, LAZ", epsg: None, units: METRES },
    ReaderTruth { file: "autzen/autzen_north_offices_520x240m.laz", points: 1_105_675, low: [635_840.29, 852_491.08, 408.07], high: [637_546.29, 853_278.47, 540.85], intensity: 84_918_635, ground: 0, max_return: 1, format: "LAS 1.2, point format 2, LAZ", epsg: None, units: METRES },
    ReaderTruth { file: "autzen/autzen_stadium_340x320m.laz", points: 762_536, low: [636_824.54, 851_441.23, 415.49], high: [637_939.98, 852_491.04, 598.15], intensity: 64_777_739, ground: 0, max_return: 1, format: "LAS 1.2, point format 2, LAZ", epsg: None, units: METRES },
    ReaderTruth { file: "bresse_lidarhd/870000_6618000.subset.50mx100m.las", points: 70840, low: [870_200.01, 6_617_083.28, 179.13], high: [870_299.99, 6_617_145.15, 194.36], intensity: 146_895_891, ground: 34316, max_return: 6, format: "LAS 1.4, point format 8", epsg: None, units: METRES },
    ReaderTruth { file: "delft_ahn3/ahn3_cropped_1.laz", points: 640_510, low: [84_808.3, 447_412.8, -0.568], high: [84_999.999, 447_641.299, 19.398], intensity: 96_620_494, ground: 195_988, max_return: 5, format: "LAS 1.2, point format 1, LAZ", epsg: None, units: METRES },
    ReaderTruth { file: "delft_ahn3/ahn3_cropped_2.laz", points: 208_432, low: [85_000.001, 447_412.8, -0.606], high: [85_072.299, 447_641.299, 26.329], intensity: 26_504_917, ground: 87130, max_return: 5, format: "LAS 1.2, point format 1, LAZ", epsg: None, units: METRES },
    ReaderTruth { file: "ign_decimated_towns/test_semis_2023_0292_6833_LA93_IGN69.laz", points: 289_055, low: [292_000.0, 6_832_000.0, 43.3], high: [292_999.98, 6_832_999.99, 107.61], intensity: 446_543_615, ground: 152_678, max_return: 9, format: "LAS 1.4, point format 6, LAZ", epsg: Some(2154), units: METRES },
    ReaderTruth { file: "io_cases/1.2-with-color.copc.laz", points: 1065, low: [635_619.85, 848_899.70, 406.59], high: [638_982.55, 853_535.43, 586.38], intensity: 81361, ground: 276, max_return: 4, format: "LAS 1.4, point format 7, LAZ (COPC)", epsg: Some(2991), units: [1.0, US_SURVEY_FOOT] },
    ReaderTruth { file: "io_cases/4_6_crop.las", points: 23875, low: [1_639_600.0, 1_454_500.02, 7077.92], high: [1_639_799.98, 1_454_700.0, 7139.7], intensity: 439_166, ground: 9003, max_return: 4, format: "LAS 1.2, point format 3", epsg: Some(2903), units: [US_SURVEY_FOOT, US_SURVEY_FOOT] },
    ReaderTruth { file: "io_cases/autzen-thin.las", points: 10653, low: [635_589.01, 848_886.45, 406.59], high: [638_994.75, 853_535.43, 593.73], intensity: 819_976, ground: 2719, max_return: 4, format: "LAS 1.2, point format 3", epsg: None, units: METRES },
    ReaderTruth { file: "io_cases/autzen_trim.laz", points: 110_000, low: [636_001.76, 848_935.20, 406.26], high: [637_179.22, 849_497.9, 520.51], intensity: 11_220_547, ground: 26107, max_return: 4, format: "LAS 1.2, point format 3, LAZ", epsg: None, units: [0.3048, 0.3048] },
    ReaderTruth { file: "io_cases/extrabytes.las", points: 1065, low: [635_619.85, 848_899.70, 406.59], high: [638_982.55, 853_535.43, 586.38], intensity: 81361, ground: 276, max_return: 4, format: "LAS 1.4, point format 3", epsg: None, units: METRES },
    ReaderTruth { file: "io_cases/las_with_several_extra_byte_bloc.laz", points: 697_721, low: [484_649.36, 6_632_629.73, 99.65], high: [484_999.99, 6_632_999.99, 120.42], intensity: 1_108_349_761, ground: 683_023, max_return: 6, format: "LAS 1.4, point format 8, LAZ", epsg: Some(2154), units: METRES },
    ReaderTruth { file: "io_cases/noise-dirty.las", points: 1065, low: [635_619.85, 848_899.70, 406.59], high: [638_982.55, 853_535.43, 586.38], intensity: 81361, ground: 276, max_return: 4, format: "LAS 1.2, point format 3", epsg: None, units: METRES },
    ReaderTruth { file: "io_cases/sample_c.las", points: 14408, low: [674_521.92, 1_206_740.08, 627.53], high: [674_605.32, 1_206_814.96, 656.23], intensity: 29_823_038, ground: 1368, max_return: 4, format: "LAS 1.2, point format 3", epsg: None, units: METRES },
    ReaderTruth { file: "io_cases/sample_nc.las", points: 14408, low: [674_521.92, 1_206_740.08, 627.53], high: [674_605.32, 1_206_814.96, 656.23], intensity: 29_823_038, ground: 0, max_return: 4, format: "LAS 1.2, point format 3", epsg: None, units: METRES },
    ReaderTruth { file: "io_cases/test1_4.las", points: 1000, low: [1_694_038.446, 1_816_492.706, 5592.750], high: [1_694_539.677, 1_816_497.976, 5599.070], intensity: 38007, ground: 1000, max_return: 4, format: "LAS 1.4, point format 6", epsg: Some(2903), units: [US_SURVEY_FOOT, US_SURVEY_FOOT] },
    ReaderTruth { file: "io_cases/warsaw_small.las", points: 3000, low: [639_913.26, 485_143.14, 84.7], high: [639_946.75, 485_175.91, 104.55], intensity: 7_534_588, ground: 1381, max_return: 4, format: "LAS 1.2, point format 3", epsg: None, units: METRES },
    ReaderTruth { file: "terrain/Topography.laz", points: 73403, low: [273_357.145, 5_274_357.144, 788.993], high: [273_642.857, 5_274_642.848, 829.758], intensity: 63_213_441, ground: 8159, max_return: 6, format: "LAS 1.2, point format 1, LAZ", epsg: Some(2949), units: METRES },
    ReaderTruth { file: "tudelft_ahn4_small/small.laz", points: 39233, low: [85_699.665, 447_195.328, -0.574], high: [85_740.506, 447_243.504, 15.966], intensity: 36_965_847, ground: 18392, max_return: 5, format: "LAS 1.4, point format 8, LAZ", epsg: Some(7415), units: METRES },
];

#[test]
fn las_files_read_as_laspy_reads_them() {
    for truth in LAS_TRUTH {
        let Some(path) = crate::common::data("las_files_read_as_laspy_reads_them", &format!("data/{}", truth.file))
        else {
            continue;
        };
        let (cloud, report) = read(&[path]).unwrap_or_else(|e| panic!("{e}"));
        let file = &report.files[0];
        assert_eq!(cloud.len(), truth.points, "{}", truth.file);
        assert_eq!(file.points, truth.points, "{}", truth.file);
        assert_eq!(file.left_out, [], "{}", truth.file);
        assert_eq!(file.format, truth.format, "{}", truth.file);
        assert_eq!(cloud.frame.crs.epsg, truth.epsg, "{}", truth.file);
        assert!((cloud.frame.crs.metres_per_unit - truth.units[0]).abs() < 1e-12, "{}", truth.file);
        assert!((cloud.frame.crs.vertical_metres_per_unit - truth.units[1]).abs() < 1e-12, "{}", truth.file);
        let Bounds { low, high } = cloud.bounds().unwrap();
        let (low, high) = (cloud.frame.to_file_coordinates(low), cloud.frame.to_file_coordinates(high));
        for i in 0..3 {
            assert!((low[i] - truth.low[i]).abs() < 1e-3, "{}: {low:?}", truth.file);
            assert!((high[i] - truth.high[i]).abs() < 1e-3, "{}: {high:?}", truth.file);
        }
        let attributes = &cloud.attributes;
        let intensity: u64 = attributes.intensity.as_ref().unwrap().iter().map(|&i| u64::from(i)).sum();
        assert_eq!(intensity, truth.intensity, "{}", truth.file);
        let ground = attributes.classification.as_ref().unwrap().iter().filter(|&&class| class == 2).count();
        assert_eq!(ground, truth.ground, "{}", truth.file);
        assert_eq!(attributes.return_number.as_ref().unwrap().iter().max(), Some(&truth.max_return), "{}", truth.file);
        cloud.validate().unwrap();
        let names: Vec<_> = attributes.columns().into_iter().map(|(name, _)| name).collect();
        assert_eq!(file.attributes, names);
    }
}

fn notes_of(path: PathBuf) -> String {
    let (_, report) = read(&[path]).unwrap();
    report.files[0].notes.join("\n")
}

#[test]
fn report_names_what_is_odd() {
    let test = "report_names_what_is_odd";
    for (file, expected) in [
        ("tudelft_ahn4_small/small.laz", "GPS times have only 7 different values"),
        (
            "tudelft_ahn4_small/small.laz",
            "values that are not used: Deviation, Reflectance, Amplitude (\"extra bytes\"); no answer depends on them",
        ),
        ("ign_decimated_towns/test_semis_2023_0292_6833_LA93_IGN69.laz", "12 of 289055 GPS times are zero"),
        ("delft_ahn3/ahn3_cropped_2.laz", "names no reference system; coordinates are taken as metres"),
        ("quantised/samp11-utm.pcd", "steps of up to 0.5 m"),
    ] {
        let Some(path) = crate::common::data(test, &format!("data/{file}")) else { continue };
        let notes = notes_of(path);
        assert!(notes.contains(expected), "{file}: {notes}");
    }
}

#[test]
fn gps_time_and_scan_angle_match_laspy() {
    let Some(path) = crate::common::data("gps_time_and_scan_angle_match_laspy", "data/delft_ahn3/ahn3_cropped_1.laz")
    else {
        return;
    };
    let (cloud, _) = read(&[path]).unwrap();
    let times = cloud.attributes.gps_time.as_ref().unwrap();
    let (low, high) = times.iter().fold((f64::MAX, f64::MIN), |(l, h), &t| (l.min(t), h.max(t)));
    assert_eq!((low, high), (228_671.755_606_575_17, 230_768.797_291_830_33));
    assert_eq!(cloud.attributes.gps_time_kind, GpsTimeKind::SecondsOfWeek);
    let angles = cloud.attributes.scan_angle.as_ref().unwrap();
    let widest = angles.iter().fold(0.0_f32, |w, a| w.max(a.abs())).to_degrees();
    assert!((30.0..=34.0).contains(&widest), "{widest}");
    let mut lines = cloud.attributes.point_source_id.unwrap();
    lines.sort_unstable();
    lines.dedup();
    assert_eq!(lines.len(), 4);
}

#[test]
fn adjoining_tiles_make_one_cloud_in_file_order() {
    let test = "adjoining_tiles_make_one_cloud_in_file_order";
    let (Some(one), Some(two)) = (
        crate::common::data(test, "data/delft_ahn3/ahn3_cropped_1.laz"),
        crate::common::data(test, "data/delft_ahn3/ahn3_cropped_2.laz"),
    ) else {
        return;
    };
    let (both, report) = read(&[one.clone(), two.clone()]).unwrap();
    assert_eq!(both.len(), 640_510 + 208_432);
    assert_eq!(report.files.iter().map(|file| file.points).collect::<Vec<_>>(), [640_510, 208_432]);
    let (first, _) = read(&[one]).unwrap();
    let (second, _) = read(&[two]).unwrap();
    for (i, (cloud, j)) in [(&first, 0), (&first, 640_509), (&second, 0), (&second, 208_431)].into_iter().enumerate() {
        let k = if i < 2 { j } else { j + 640_510 };
        let (a, b) =
            (cloud.frame.to_file_coordinates(cloud.positions[j]), both.frame.to_file_coordinates(both.positions[k]));
        assert!((0..3).all(|axis| (a[axis] - b[axis]).abs() < 1e-4), "{a:?} {b:?}");
    }
}

#[test]
fn result_is_the_same_for_any_number_of_threads() {
    let Some(path) =
        crate::common::data("result_is_the_same_for_any_number_of_threads", "data/delft_ahn3/ahn3_cropped_2.laz")
    else {
        return;
    };
    let with = |threads: usize| {
        let pool = rayon_pool(threads);
        pool.install(|| read(std::slice::from_ref(&path))).unwrap().0
    };
    let (one, four) = (with(1), with(4));
    assert_eq!(one.frame, four.frame);
    assert_eq!(one.positions, four.positions);
    assert_eq!(one.attributes.gps_time, four.attributes.gps_time);
    assert_eq!(one.attributes.intensity, four.attributes.intensity);
}

fn rayon_pool(threads: usize) -> rayon::ThreadPool {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap()
}

#[test]
fn degrees_and_earth_centred_files_are_refused_with_a_conversion() {
    let test = "degrees_and_earth_centred_files_are_refused_with_a_conversion";
    for (file, what, target) in [
        ("autzen-dd.las", "degrees", "EPSG:32610"),
        ("epsg_4326.las", "degrees", "EPSG:32615"),
        ("spurious.las", "degrees", "EPSG:32610"),
        ("lone-star.copc.laz", "earth-centred", "EPSG:32"),
    ] {
        let Some(path) = crate::common::data(test, &format!("data/io_cases/{file}")) else { continue };
        let error = read(&[path]).unwrap_err();
        assert!(matches!(error, Error::UnusableCrs { .. }), "{error}");
        let text = error.to_string();
        assert!(text.contains(file) && text.contains(what) && text.contains(target), "{text}");
        assert!(text.contains("pdal translate"), "{text}");
    }
}

#[test]
fn forced_system_overrides_the_file() {
    let test = "forced_system_overrides_the_file";
    if let Some(path) = crate::common::data(test, "data/autzen/autzen_stadium_340x320m.laz") {
        let (cloud, report) = read_as(&path, "EPSG:2992").unwrap();
        assert_eq!(report.crs_source, "option");
        let Bounds { low, high } = cloud.bounds().unwrap();
        // The crop is 340 x 320 m.
        assert!((high[0] - low[0] - 340.0).abs() < 1.0 && (high[1] - low[1] - 320.0).abs() < 1.0);
        assert!((cloud.frame.to_file_coordinates(low)[0] - 636_824.54).abs() < 1e-3);
    }
    if let Some(path) = crate::common::data(test, "data/delft_ahn3/ahn3_cropped_2.laz") {
        assert!(matches!(read_as(&path, "EPSG:4326"), Err(Error::UnusableCrs { .. })));
        assert!(matches!(read_as(&path, "EPSG:99999999"), Err(Error::InvalidParameter { .. })));
    }
}

#[test]
fn files_of_different_systems_are_refused() {
    let test = "files_of_different_systems_are_refused";
    let (Some(one), Some(two)) = (
        crate::common::data(test, "data/tudelft_ahn4_small/small.laz"),
        crate::common::data(test, "data/terrain/Topography.laz"),
    ) else {
        return;
    };
    let text = read(&[one, two]).unwrap_err().to_string();
    assert!(text.contains("2949") && text.contains("7415"), "{text}");
}

#[test]
fn e57_scans_read_with_poses_normals_and_colours() {
    let test = "e57_scans_read_with_poses_normals_and_colours";
    let open = |file: &str| crate::common::data(test, &format!("data/tls_e57/{file}")).map(|path| read(&[path]));
    if let Some(result) = open("pumpAVisualReferenceImage.e57") {
        let (cloud, _) = result.unwrap();
        assert_eq!(cloud.len(), 155_201);
        let Bounds { low, high } = cloud.bounds().unwrap();
        let (low, high) = (cloud.frame.to_file_coordinates(low), cloud.frame.to_file_coordinates(high));
        for (found, expected) in low.into_iter().zip([-2.903_764, -5.301_103, -1.899_705]) {
            assert!((found - expected).abs() < 1e-5, "{low:?}");
        }
        assert!((high[2] - 1.843_003).abs() < 1e-5);
        assert!(cloud.attributes.color.is_some() && cloud.attributes.intensity.is_some());
        assert_eq!(cloud.scanner_positions.len(), 1);
        let scanner = cloud.frame.to_file_coordinates(cloud.scanner_positions[0]);
        assert!(scanner.iter().all(|c| c.abs() < 1e-6), "{scanner:?}");
        assert!(cloud.attributes.scanner_index.unwrap().iter().all(|&index| index == 0));
    }
    for file in ["bunnyDouble.e57", "bunnyInt32.e57"] {
        let Some(result) = open(file) else { continue };
        let (cloud, _) = result.unwrap();
        assert_eq!(cloud.len(), 30571);
        let Bounds { low, high } = cloud.bounds().unwrap();
        assert!((f64::from(low[0]) + 0.094_689).abs() < 1e-6 && (f64::from(high[1]) - 0.187_321).abs() < 1e-6);
        assert!(cloud.scanner_positions.is_empty());
    }
    if let Some(result) = open("testWithNormals.e57") {
        let (cloud, _) = result.unwrap();
        assert_eq!(cloud.len(), 2);
        assert!(cloud.attributes.normals.is_some());
    }
    if let Some(result) = open("translationWithoutRotation.e57") {
        let (cloud, _) = result.unwrap();
        let Bounds { low, high } = cloud.bounds().unwrap();
        assert_eq!(cloud.frame.to_file_coordinates(low), [4.0, 5.0, 6.0]);
        assert_eq!(cloud.frame.to_file_coordinates(high), [5.0, 6.0, 6.0]);
        assert_eq!(cloud.frame.to_file_coordinates(cloud.scanner_positions[0]), [4.0, 5.0, 6.0]);
    }
    if let Some(result) = open("ColouredCubeFloat.e57") {
        let (cloud, _) = result.unwrap();
        assert_eq!(cloud.len(), 7680);
        assert_eq!(cloud.attributes.color.unwrap().iter().flatten().max(), Some(&65535));
    }
    if let Some(result) = open("ZeroPoints.e57") {
        let error = result.unwrap_err();
        assert!(matches!(error, Error::NoPoints { .. }), "{error}");
    }
    if let Some(result) = open("bad-crc.e57") {
        let text = result.unwrap_err().to_string();
        assert!(text.contains("checksum"), "{text}");
    }
}

#[test]
fn pcd_text_ply_and_npy_read() {
    let test = "pcd_text_ply_and_npy_read";
    let open = |file: &str| crate::common::data(test, &format!("data/{file}")).map(|path| read(&[path]).unwrap());
    if let Some((cloud, report)) = open("io_cases/autzen-utm.pcd") {
        assert_eq!((cloud.len(), report.files[0].format.as_str()), (1065, "PCD, binary"));
        // The same 1065 points as 1.2-with-color: 276 of ground, intensities 81361 in all.
        assert_eq!(cloud.attributes.classification.unwrap().iter().filter(|&&c| c == 2).count(), 276);
        assert_eq!(cloud.attributes.intensity.unwrap().iter().map(|&i| u64::from(i)).sum::<u64>(), 81361);
        assert!(cloud.attributes.color.is_some() && cloud.attributes.gps_time.is_some());
    }
    if let Some((cloud, report)) = open("quantised/samp11-utm.pcd") {
        assert_eq!((cloud.len(), report.files[0].format.as_str()), (38010, "PCD, binary_compressed"));
        assert_eq!(cloud.frame.origin[..2], [513_024.0, 5_403_648.0]);
    }
    if let Some((cloud, _)) = open("trees/ahn3_delft.xyz") {
        assert_eq!(cloud.len(), 2488);
        let p = cloud.frame.to_file_coordinates(cloud.positions[0]);
        assert!((p[0] - 127.480_003).abs() < 1e-4 && (p[2] - 5.644).abs() < 1e-4);
    }
    for file in ["points", "mesh"] {
        let Some((cloud, _)) = open(&format!("house_dyke_tree/house_dyke_tree.{file}.ply")) else { continue };
        assert_eq!(cloud.len(), 2690);
        let Bounds { low, high } = cloud.bounds().unwrap();
        for (axis, extent) in [9.3, 16.6, 3.6].into_iter().enumerate() {
            assert!((high[axis] - low[axis] - extent).abs() < 0.05);
        }
        let normals = cloud.attributes.normals.unwrap();
        assert!((normals[0][1] - 0.926_505).abs() < 1e-6 && (normals[0][2] - 0.376_282).abs() < 1e-6);
    }
    if let Some((cloud, report)) = open("random3dcity/NPY") {
        assert_eq!(cloud.len(), 186_577);
        assert!(report.files[0].format.starts_with("masbcpp folder"));
        assert!(cloud.attributes.normals.is_some());
        let (alone, _) = open("random3dcity/NPY/coords.npy").unwrap();
        assert_eq!(alone.positions, cloud.positions);
    }
}

#[test]
fn ptx_scans_read_with_their_scanners() {
    let test = "ptx_scans_read_with_their_scanners";
    if let Some(path) = crate::common::data(test, "data/io_cases/1.2-with-color.ptx") {
        let (cloud, report) = read(&[path]).unwrap();
        // The same points as 1.2-with-color.copc.laz, in one grid of 15 x 71.
        assert_eq!((cloud.len(), report.files[0].format.as_str()), (1065, "PTX, 1 scan"));
        let Bounds { low, high } = cloud.bounds().unwrap();
        let (low, high) = (cloud.frame.to_file_coordinates(low), cloud.frame.to_file_coordinates(high));
        for (found, expected) in low.into_iter().zip([635_619.85, 848_899.70, 406.59]) {
            assert!((found - expected).abs() < 1e-3, "{low:?}");
        }
        assert!((high[2] - 586.38).abs() < 1e-3, "{high:?}");
        assert!(cloud.attributes.color.is_some() && cloud.attributes.intensity.is_some());
        // Its header leaves the scanner at (0, 0, 0), 850 km away.
        assert!(cloud.scanner_positions.is_empty());
        assert!(report.files[0].notes.iter().any(|note| note.contains("scanner position")));
    }
    let folder = tempfile::tempdir().unwrap();
    // A quarter turn about z, then a shift by (10, 20, 30): x becomes y.
    let scan = "2\n1\n10 20 30\n0 1 0\n-1 0 0\n0 0 1\n0 1 0 0\n-1 0 0 0\n0 0 1 0\n10 20 30 1\n1 0 0 0.5\n0 0 0 0.5\n";
    let path = text_file(&folder, "two.ptx", &scan.repeat(2));
    let (cloud, report) = read(&[path]).unwrap();
    assert_eq!((cloud.len(), report.left_out_count()), (2, 2));
    assert_eq!(cloud.frame.to_file_coordinates(cloud.positions[0]), [10.0, 21.0, 30.0]);
    assert_eq!(cloud.attributes.scanner_index, Some(vec![0, 1]));
    assert_eq!(cloud.frame.to_file_coordinates(cloud.scanner_positions[1]), [10.0, 20.0, 30.0]);
}

#[test]
fn ply_whose_header_declares_more_than_its_lines_hold_is_refused() {
    let test = "ply_whose_header_declares_more_than_its_lines_hold_is_refused";
    let Some(path) = crate::common::data(test, "data/house_dyke_tree/house_dyke_tree.HEAD.ply") else { return };
    let text = read(&[path]).unwrap_err().to_string();
    assert!(text.contains("vertex 1 of 2690"), "{text}");
}

#[test]
fn unknown_extensions_and_missing_files_are_named() {
    let error = read(&[PathBuf::from("nowhere/cloud.dwg")]).unwrap_err();
    assert!(matches!(error, Error::UnknownFormat { .. }), "{error}");
    let error = read(&[PathBuf::from("nowhere/cloud.las")]).unwrap_err();
    assert!(matches!(error, Error::Io { .. }) && error.to_string().contains("nowhere"), "{error}");
    assert!(matches!(read(&[]), Err(Error::NoPoints { .. })));
}

fn text_file(folder: &tempfile::TempDir, name: &str, content: &str) -> PathBuf {
    let path = folder.path().join(name);
    std::fs::write(&path, content).unwrap();
    path
}

#[test]
fn text_variants_give_the_same_points() {
    let folder = tempfile::tempdir().unwrap();
    for (name, content) in [
        ("a.xyz", "1.5 2.5 3.5\n4.5 5.5 6.5\n"),
        ("b.csv", "X,Y,Z\n1.5,2.5,3.5\n4.5,5.5,6.5"),
        ("c.csv", "\u{feff}\"easting\";\"northing\";\"height\"\r\n1.5;2.5;3.5\r\n4.5;5.5;6.5\r\n"),
        ("d.txt", "# made by hand\n//X Y Z\n1.5\t2.5\t3.5\n\n4.5\t5.5\t6.5\n"),
        ("e.TXT", "2\n  1.5   2.5 3.5\n  4.5 5.5  6.5\n"),
        ("f.csv", "z, y, x\n3.5, 2.5, 1.5\n6.5, 5.5, 4.5\n"),
    ] {
        let (cloud, _) = read(&[text_file(&folder, name, content)]).unwrap_or_else(|e| panic!("{e}"));
        let points: Vec<_> = cloud.positions.iter().map(|&p| cloud.frame.to_file_coordinates(p)).collect();
        assert_eq!(points, [[1.5, 2.5, 3.5], [4.5, 5.5, 6.5]], "{name}");
    }
}

#[test]
fn text_columns_are_recognised_by_name_or_value() {
    let folder = tempfile::tempdir().unwrap();
    let named = text_file(&folder, "a.txt", "x y z nx ny nz r g b intensity class\n1 2 3 0 0 2 255 0 128 77 6\n");
    let (cloud, _) = read(&[named]).unwrap();
    let attributes = cloud.attributes;
    assert_eq!(attributes.normals, Some(vec![[0.0, 0.0, 1.0]]));
    assert_eq!(attributes.color, Some(vec![[65535, 0, 128 * 257]]));
    assert_eq!((attributes.intensity, attributes.classification), (Some(vec![77]), Some(vec![6])));
    let normals = text_file(&folder, "b.xyz", "1 2 3 0 0.6 0.8\n1 2 4 1 0 0\n");
    assert!(read(&[normals]).unwrap().0.attributes.normals.is_some());
    let colors = text_file(&folder, "c.xyz", "1 2 3 10 20 30\n1 2 4 255 0 0\n");
    assert!(read(&[colors]).unwrap().0.attributes.color.is_some());
}

#[test]
fn text_faults_are_counted_or_refused() {
    let folder = tempfile::tempdir().unwrap();
    let (cloud, report) = read(&[text_file(&folder, "a.xyz", "1 2 3\n4 5\n6 7 8\n9 x 9\n1 1 nan\n2 2 2\n")]).unwrap();
    assert_eq!((cloud.len(), report.left_out_count()), (3, 3));
    assert!(report.files[0].left_out[0].reason.contains("lines 2, 4"), "{:?}", report.files);
    for (name, content, expected) in [
        ("b.xyz", "1,5 2,5 3,5\n", "decimal comma"),
        ("c.csv", "1,5;2,5;3,5\n", "decimal comma"),
        ("d.xyz", "1 2 3\nfoo\nbar\n1 2\n", "3 of 4 lines"),
        ("e.csv", "a,b,c\n1,2,3\n", "without columns x, y and z"),
    ] {
        let text = read(&[text_file(&folder, name, content)]).unwrap_err().to_string();
        assert!(text.contains(expected) && text.contains(name), "{text}");
    }
}

#[test]
fn one_far_point_does_not_coarsen_the_others() {
    let folder = tempfile::tempdir().unwrap();
    let mut content = String::new();
    for i in 0..100 {
        content += &format!("{}.123 {}.456 7.5\n", 85000 + i, 447_000 + i);
    }
    // One point 111 km off, one that no scene can hold.
    content += "85000.0 558000.0 0\n1e12 0 0\n";
    let (cloud, report) = read(&[text_file(&folder, "a.xyz", &content)]).unwrap();
    assert_eq!((cloud.len(), report.left_out_count()), (101, 1));
    // The multiple of 1024 m next to the middle of the others.
    assert_eq!(cloud.frame.origin[..2], [84_992.0, 447_488.0]);
    let p = cloud.frame.to_file_coordinates(cloud.positions[3]);
    assert!((p[0] - 85003.123).abs() < 1e-5 && (p[1] - 447_003.456).abs() < 1e-5);
}

#[test]
fn folder_joins_its_files_by_name_and_drops_what_only_some_have() {
    let folder = tempfile::tempdir().unwrap();
    text_file(&folder, "b.xyz", "x y z intensity\n4 5 6 9\n");
    text_file(&folder, "a.xyz", "1 2 3\n");
    text_file(&folder, "notes.md", "no cloud");
    let (cloud, report) = read(&[folder.path().to_owned()]).unwrap();
    let points: Vec<_> = cloud.positions.iter().map(|&p| cloud.frame.to_file_coordinates(p)).collect();
    assert_eq!(points, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
    assert_eq!(report.dropped_attributes, ["intensity"]);
}

#[test]
fn systems_are_given_by_code_and_text() {
    for (text, kind, horizontal, vertical) in [
        ("EPSG:28992", CrsKind::Projected, 1.0, 1.0),
        ("7415", CrsKind::Projected, 1.0, 1.0),
        ("EPSG:28992+5709", CrsKind::Projected, 1.0, 1.0),
        ("EPSG:2154", CrsKind::Projected, 1.0, 1.0),
        ("EPSG:2992", CrsKind::Projected, 0.3048, 0.3048),
        ("EPSG:2263", CrsKind::Projected, US_SURVEY_FOOT, US_SURVEY_FOOT),
        ("EPSG:4326", CrsKind::Geographic, 1.0, 1.0),
        ("EPSG:4978", CrsKind::Geocentric, 1.0, 1.0),
        ("+proj=utm +zone=31 +datum=WGS84", CrsKind::Projected, 1.0, 1.0),
        (
            "PROJCRS[\"a\",CS[Cartesian,2],AXIS[\"e\",east,LENGTHUNIT[\"US survey foot\",0.304800609601219]]]",
            CrsKind::Projected,
            US_SURVEY_FOOT,
            US_SURVEY_FOOT,
        ),
        ("GEODCRS[\"a\",CS[Cartesian,3],LENGTHUNIT[\"metre\",1]]", CrsKind::Geocentric, 1.0, 1.0),
        ("LOCAL_CS[\"site\",UNIT[\"metre\",1]]", CrsKind::Local, 1.0, 1.0),
    ] {
        let crs = Crs::parse(text).unwrap_or_else(|e| panic!("{text}: {e}"));
        assert_eq!(crs.kind, kind, "{text}");
        assert!((crs.metres_per_unit - horizontal).abs() < 1e-12, "{text}: {crs:?}");
        assert!((crs.vertical_metres_per_unit - vertical).abs() < 1e-12, "{text}: {crs:?}");
    }
    for text in ["", "EPSG:1", "PROJCS[", "PROJCS[\"a\"", "hello", &"A[".repeat(10_000)] {
        assert!(Crs::parse(text).is_err(), "{text}");
    }
    let (rd, compound) = (Crs::parse("EPSG:28992").unwrap(), Crs::parse("EPSG:7415").unwrap());
    assert!(rd.same_system(&compound));
    assert!(!rd.same_system(&Crs::parse("EPSG:2154").unwrap()));
    assert_eq!(rd.describe(), "EPSG:28992 (Amersfoort / RD New), metres");
}

/// A LAS file of three points with everything its point format has; `edit` may add records.
fn write_las(path: &Path, format: u8, compressed: bool, edit: impl Fn(&mut las::Builder), extra: &[Vec<u8>]) {
    let version = if format >= 6 { (1, 4) } else { (1, 3) };
    let mut builder = las::Builder::from(version);
    builder.point_format = las::point::Format::new(format).unwrap();
    builder.point_format.is_compressed = compressed;
    builder.point_format.extra_bytes = u16::try_from(extra.first().map_or(0, Vec::len)).unwrap();
    let transform = |offset| las::Transform { scale: 0.01, offset };
    builder.transforms = las::Vector { x: transform(1000.0), y: transform(2000.0), z: transform(0.0) };
    edit(&mut builder);
    let mut writer = las::Writer::from_path(path, builder.into_header().unwrap()).unwrap();
    let point_format = *writer.header().point_format();
    for (i, number) in (0..3).zip(1_u8..) {
        let point = las::Point {
            x: 1000.25 + f64::from(number),
            y: 2000.5,
            z: 3.75,
            intensity: 40_000 + u16::from(number),
            return_number: number,
            number_of_returns: 3,
            scan_angle: -12.0,
            is_withheld: true,
            is_overlap: true,
            scanner_channel: if point_format.is_extended { 2 } else { 0 },
            point_source_id: 17,
            gps_time: point_format.has_gps_time.then_some(5.5),
            color: point_format.has_color.then(|| las::Color::new(65_000, 2, 3)),
            nir: point_format.has_nir.then_some(9),
            waveform: point_format.has_waveform.then(las::raw::point::Waveform::default),
            extra_bytes: extra.get(i).cloned().unwrap_or_default(),
            ..las::Point::default()
        };
        writer.write_point(point).unwrap();
    }
    writer.close().unwrap();
}

#[test]
fn every_las_point_format_reads() {
    let folder = tempfile::tempdir().unwrap();
    for format in 0..=10 {
        for compressed in [false, true] {
            let path = folder.path().join(format!("{format}.{}", if compressed { "laz" } else { "las" }));
            write_las(&path, format, compressed, |_| {}, &[]);
            let (cloud, _) = read(std::slice::from_ref(&path)).unwrap_or_else(|e| panic!("{e}"));
            let p = cloud.frame.to_file_coordinates(cloud.positions[1]);
            assert!((p[0] - 1002.25).abs() < 1e-4 && (p[1] - 2000.5).abs() < 1e-4 && (p[2] - 3.75).abs() < 1e-4);
            let attributes = cloud.attributes;
            assert_eq!(attributes.intensity, Some(vec![40_001, 40_002, 40_003]), "{format}");
            assert_eq!(attributes.return_number, Some(vec![1, 2, 3]), "{format}");
            assert_eq!(attributes.return_count, Some(vec![3; 3]), "{format}");
            assert_eq!(attributes.point_source_id, Some(vec![17; 3]), "{format}");
            // Withheld is 4, overlap 8.
            assert_eq!(attributes.flags, Some(vec![12; 3]), "{format}");
            let angle = attributes.scan_angle.unwrap()[0].to_degrees();
            assert!((angle + 12.0).abs() < 1e-3, "{format}: {angle}");
            assert_eq!(attributes.scanner_channel, (format >= 6).then(|| vec![2; 3]), "{format}");
            let timed = ![0, 2].contains(&format);
            assert_eq!(attributes.gps_time, timed.then(|| vec![5.5; 3]), "{format}");
            let colored = [2, 3, 5, 7, 8, 10].contains(&format);
            assert_eq!(attributes.color, colored.then(|| vec![[65_000, 2, 3]; 3]), "{format}");
        }
    }
}

#[test]
fn normals_in_extra_bytes_are_read() {
    let folder = tempfile::tempdir().unwrap();
    // A record of 192 bytes per extra field: type at 2 (9 is f32, 4 is i16), options at 3 (8: scaled), name at 4.
    let descriptor = |kind: u8, options: u8, name: &str, scale: f64| {
        let mut bytes = vec![0_u8; 192];
        (bytes[2], bytes[3]) = (kind, options);
        bytes[4..4 + name.len()].copy_from_slice(name.as_bytes());
        bytes[112..120].copy_from_slice(&scale.to_le_bytes());
        bytes
    };
    for (kind, options, scale) in [(9, 0, 0.0), (4, 8, 0.0001)] {
        let names = ["Radius", "NormalX", "NormalY", "NormalZ"];
        let data: Vec<u8> = names.iter().flat_map(|name| descriptor(kind, options, name, scale)).collect();
        let values: Vec<u8> = [50.0_f32, 0.0, 0.6, -0.8]
            .iter()
            .flat_map(|v| if kind == 9 { v.to_le_bytes().to_vec() } else { quantised(*v) })
            .collect();
        for (format, compressed) in [(6, true), (6, false), (1, true)] {
            let path = folder.path().join(if compressed { "normals.laz" } else { "normals.las" });
            let vlr = |builder: &mut las::Builder| {
                builder.vlrs.push(las::Vlr {
                    user_id: "LASF_Spec".to_owned(),
                    record_id: 4,
                    data: data.clone(),
                    ..las::Vlr::default()
                });
            };
            write_las(&path, format, compressed, vlr, &vec![values.clone(); 3]);
            let (cloud, report) = read(std::slice::from_ref(&path)).unwrap_or_else(|e| panic!("{e}"));
            let normals = cloud.attributes.normals.unwrap();
            assert!((normals[2][1] - 0.6).abs() < 1e-4 && (normals[2][2] + 0.8).abs() < 1e-4, "{normals:?}");
            assert!(report.files[0].notes.iter().any(|note| note.contains("not used: Radius (")), "{report:?}");
        }
    }
}

/// A component of a normal as an i16 of ten thousandths.
fn quantised(value: f32) -> Vec<u8> {
    ((value * 10_000.0) as i16).to_le_bytes().to_vec()
}
