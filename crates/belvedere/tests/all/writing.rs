//! Written files can be read back, by the crates of the formats themselves, and never appear half done.

use std::fs;
use std::io::{BufReader, Write};

use belvedere::cloud::GpsTimeKind;
use belvedere::control::Control;
use belvedere::crs::Crs;
use belvedere::io::{
    ExtraColumn, ExtraValues, Georeference, MasbcppFolder, ReadOptions, atomic, read_cloud, write_cloud, write_masbcpp,
    write_npy_f32, write_npy_f32_2d, write_npy_u8, write_npy_u32_2d, write_tif_f32, write_tif_u32,
};
use belvedere::raster::Raster;
use belvedere::{Attributes, Error, Frame, PointCloud};
use tempfile::TempDir;

const FOOT: f64 = 0.3048;

fn dutch() -> Crs {
    Crs { epsg: Some(28992), ..Crs::default() }
}

/// 1000 points with every attribute, near Delft.
fn full_cloud() -> PointCloud {
    let n = 1000_u16;
    let column = |f: fn(u16) -> u8| Some((0..n).map(f).collect());
    PointCloud {
        frame: Frame { origin: [84_500.0, 446_700.0, 3.0], crs: dutch() },
        positions: (0..n).map(|i| [f32::from(i) * 0.25, f32::from(i % 37) * -1.5, f32::from(i % 11) * 0.125]).collect(),
        attributes: Attributes {
            normals: Some((0..n).map(|_| [0.0, 0.6, 0.8]).collect()),
            classification: column(|i| (i % 7) as u8),
            gps_time: Some((0..n).map(|i| 2.5e8 + f64::from(i) * 1e-5).collect()),
            gps_time_kind: GpsTimeKind::AdjustedStandard,
            return_number: column(|i| (i % 3 + 1) as u8),
            return_count: column(|_| 3),
            scan_angle: Some((0..n).map(|i| (f32::from(i % 40) - 20.0).to_radians()).collect()),
            point_source_id: Some((0..n).collect()),
            scanner_channel: column(|i| (i % 4) as u8),
            flags: column(|i| (i % 16) as u8),
            intensity: Some((0..n).map(|i| i * 60).collect()),
            color: Some((0..n).map(|i| [i * 65, 1000, 65535]).collect()),
            scanner_index: Some((0..n).map(|i| i % 2).collect()),
        },
        scanner_positions: vec![[0.0; 3]; 2],
        ..PointCloud::default()
    }
}

fn entries(folder: &TempDir) -> usize {
    fs::read_dir(folder.path()).unwrap().count()
}

#[test]
fn a_failed_write_changes_nothing() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("out.txt");
    fs::write(&path, "before").unwrap();
    let failed: Result<(), Error> = atomic::write(&path, |output| {
        output.write_all(b"half").unwrap();
        Err(Error::malformed(&path, "stopped"))
    });
    assert!(failed.is_err());
    let panicked = std::panic::catch_unwind(|| {
        atomic::write(&path, |output| -> Result<(), Error> {
            output.write_all(b"half").unwrap();
            panic!("stopped")
        })
    });
    assert!(panicked.is_err());
    assert_eq!(fs::read_to_string(&path).unwrap(), "before");
    assert_eq!(entries(&folder), 1, "a temporary file was left");
    atomic::write(&path, |output| output.write_all(b"after").map_err(Error::io(&path))).unwrap();
    assert_eq!(fs::read_to_string(&path).unwrap(), "after");
    assert_eq!(entries(&folder), 1);
}

#[test]
fn a_missing_folder_is_named() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("missing").join("out.ply");
    let message = write_cloud(&path, &full_cloud(), &[]).unwrap_err().to_string();
    assert!(message.contains("missing does not exist"), "{message}");
}

#[test]
fn las_and_laz_hold_every_attribute() {
    let folder = TempDir::new().unwrap();
    let cloud = full_cloud();
    let visible: Vec<u8> = (0..1000).map(|i| (i % 3) as u8).collect();
    let count: Vec<u32> = (0..1000).map(|i| i * 1_000_003).collect();
    let hours: Vec<f32> = (0..1000).map(|i| i as f32 * 0.01).collect();
    let extra = [
        ExtraColumn { name: "visible", description: "0 blocked, 1 visible", values: ExtraValues::U8(&visible) },
        ExtraColumn { name: "count", description: "", values: ExtraValues::U32(&count) },
        ExtraColumn { name: "sun_hours", description: "hours", values: ExtraValues::F32(&hours) },
    ];
    for name in ["cloud.las", "cloud.laz"] {
        let path = folder.path().join(name);
        let report = write_cloud(&path, &cloud, &extra).unwrap();
        assert_eq!((report.point_count, report.clamped_count), (1000, 0));
        assert_eq!(report.left_out, [""; 0]);
        let mut reader = las::Reader::from_path(&path).unwrap();
        let header = reader.header().clone();
        assert_eq!(header.point_format().to_u8().unwrap() & 0x3f, 7);
        assert_eq!(header.generating_software(), "belvedere");
        assert!(header.gps_time_type().is_standard());
        assert!(!header.has_synthetic_return_numbers());
        let wkt = String::from_utf8(header.get_wkt_crs_bytes().unwrap().to_vec()).unwrap();
        assert!(wkt.starts_with("PROJCS") && wkt.contains("28992"), "{wkt}");
        let descriptors = header.vlrs().iter().find(|v| v.user_id == "LASF_Spec" && v.record_id == 4).unwrap();
        assert_eq!(descriptors.data.len(), 7 * 192);
        let kinds: Vec<u8> = descriptors.data.chunks(192).map(|d| d[2]).collect();
        assert_eq!(kinds, [1, 5, 9, 3, 9, 9, 9]);
        assert!(descriptors.data[4..].starts_with(b"visible\0"));
        assert!(descriptors.data[160..].starts_with(b"0 blocked, 1 visible\0"));

        let points = reader.read_all().unwrap();
        assert_eq!(points.len(), 1000);
        let a = &cloud.attributes;
        for (i, point) in points.points().map(Result::unwrap).enumerate() {
            let expected = cloud.frame.to_file_coordinates(cloud.positions[i]);
            for (found, expected) in [point.x, point.y, point.z].into_iter().zip(expected) {
                assert!((found - expected).abs() <= 0.0005, "{found} {expected}");
            }
            assert_eq!(u8::from(point.classification), a.classification.as_ref().unwrap()[i]);
            assert_eq!(point.gps_time, Some(a.gps_time.as_ref().unwrap()[i]));
            assert_eq!(point.return_number, a.return_number.as_ref().unwrap()[i]);
            assert_eq!(point.number_of_returns, 3);
            assert!((point.scan_angle - a.scan_angle.as_ref().unwrap()[i].to_degrees()).abs() < 0.004);
            assert_eq!(point.point_source_id, a.point_source_id.as_ref().unwrap()[i]);
            assert_eq!(point.scanner_channel, a.scanner_channel.as_ref().unwrap()[i]);
            let flags = a.flags.as_ref().unwrap()[i];
            let found = u8::from(point.is_synthetic)
                | u8::from(point.is_key_point) << 1
                | u8::from(point.is_withheld) << 2
                | u8::from(point.is_overlap) << 3;
            assert_eq!(found, flags);
            assert_eq!(point.intensity, a.intensity.as_ref().unwrap()[i]);
            let color = point.color.unwrap();
            assert_eq!([color.red, color.green, color.blue], a.color.as_ref().unwrap()[i]);
            let bytes = &point.extra_bytes;
            assert_eq!(bytes[0], visible[i]);
            assert_eq!(bytes[1..5], count[i].to_le_bytes());
            assert_eq!(bytes[5..9], hours[i].to_le_bytes());
            assert_eq!(bytes[9..11], a.scanner_index.as_ref().unwrap()[i].to_le_bytes());
        }
    }
}

#[test]
fn a_cloud_in_feet_goes_back_out_in_feet() {
    let folder = TempDir::new().unwrap();
    let crs = Crs { epsg: Some(2992), metres_per_unit: FOOT, vertical_metres_per_unit: FOOT, ..Crs::default() };
    let feet = [[635_577.79, 848_882.15, 406.14], [639_000.0, 853_000.5, 520.25]];
    let metres = feet.map(|p| p.map(|v: f64| v * FOOT));
    let cloud = PointCloud::from_coordinates(&metres).0.with_crs(crs);
    let path = folder.path().join("feet.laz");
    write_cloud(&path, &cloud, &[]).unwrap();
    let mut reader = las::Reader::from_path(&path).unwrap();
    assert_eq!(reader.header().transforms().x.scale, 0.001);
    let points = reader.read_all().unwrap();
    for (found, expected) in points.x().zip(points.y()).zip(points.z()).zip(feet) {
        let ((x, y), z) = found;
        for (found, expected) in [x, y, z].into_iter().zip(expected) {
            assert!((found - expected).abs() < 0.0015, "{found} {expected}");
        }
    }
    assert!(reader.header().has_synthetic_return_numbers(), "no return numbers were given");
    let path = folder.path().join("feet.npy");
    write_cloud(&path, &cloud, &[]).unwrap();
    let array = npyz::NpyFile::new(BufReader::new(fs::File::open(path).unwrap())).unwrap();
    assert_eq!(array.shape(), [2, 3]);
    let values: Vec<f64> = array.into_vec().unwrap();
    for (found, expected) in values.iter().zip(feet.iter().flatten()) {
        assert!((found - expected).abs() < 0.0005);
    }
}

#[test]
fn empty_and_tiny_clouds_are_written() {
    let folder = TempDir::new().unwrap();
    for name in ["e.las", "e.laz", "e.ply", "e.csv", "e.npy"] {
        let path = folder.path().join(name);
        assert_eq!(write_cloud(&path, &PointCloud::default(), &[]).unwrap().point_count, 0);
    }
    assert_eq!(las::Reader::from_path(folder.path().join("e.laz")).unwrap().read_all().unwrap().len(), 0);
    let small = PointCloud { positions: vec![[0.0; 3], [0.1, 0.020_03, 0.0]], ..PointCloud::default() };
    let path = folder.path().join("small.las");
    write_cloud(&path, &small, &[]).unwrap();
    let points = las::Reader::from_path(path).unwrap().read_all().unwrap();
    assert!((points.y().nth(1).unwrap() - 0.020_03).abs() < 1e-7, "small objects keep their detail");
}

#[test]
fn ply_and_tables_hold_columns() {
    use ply_rs_bw::ply::{DefaultElement, Property};
    let folder = TempDir::new().unwrap();
    let cloud = full_cloud();
    let hours: Vec<f32> = (0..1000).map(|i| i as f32 * 0.01).collect();
    let extra = [ExtraColumn { name: "sun_hours", description: "hours", values: ExtraValues::F32(&hours) }];
    let path = folder.path().join("cloud.ply");
    write_cloud(&path, &cloud, &extra).unwrap();
    let ply = ply_rs_bw::parser::Parser::<DefaultElement>::new()
        .read_ply(&mut BufReader::new(fs::File::open(path).unwrap()))
        .unwrap();
    assert!(ply.header.comments.iter().any(|c| c.contains("EPSG:28992")));
    assert!(ply.header.comments.iter().all(|c| c.len() < 1000));
    let vertex = &ply.payload["vertex"][500];
    let expected = cloud.frame.to_file_coordinates(cloud.positions[500]);
    assert!(matches!(vertex["x"], Property::Double(v) if v == expected[0]));
    assert!(matches!(vertex["sun_hours"], Property::Float(5.0)));
    assert!(matches!(vertex["blue"], Property::UChar(255)));
    assert!(matches!(vertex["nz"], Property::Float(0.8)));

    let path = folder.path().join("cloud.csv");
    write_cloud(&path, &cloud, &extra).unwrap();
    let text = fs::read_to_string(path).unwrap();
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    assert_eq!(header[..3], ["x", "y", "z"]);
    assert_eq!(header.last(), Some(&"sun_hours"));
    let row: Vec<&str> = lines.nth(500).unwrap().split(',').collect();
    assert_eq!(row.len(), header.len());
    assert_eq!(row[0], "84625.0000");
    assert_eq!(*row.last().unwrap(), "5");
    assert_eq!(text.lines().count(), 1001);
}

#[test]
fn unsuitable_formats_and_columns_are_refused() {
    let folder = TempDir::new().unwrap();
    let cloud = full_cloud();
    let few = [1_u8; 3];
    let column = |name| ExtraColumn { name, description: "", values: ExtraValues::U8(&few) };
    let e57 = write_cloud(&folder.path().join("a.e57"), &cloud, &[]).unwrap_err();
    assert!(e57.to_string().contains(".laz"), "{e57}");
    assert!(matches!(
        write_cloud(&folder.path().join("a.ply"), &cloud, &[column("visible")]),
        Err(Error::LengthMismatch { expected: 1000, found: 3, .. })
    ));
    let small = PointCloud { positions: vec![[0.0; 3]; 3], ..PointCloud::default() };
    assert!(write_cloud(&folder.path().join("a.npy"), &small, &[column("visible")]).is_err());
    assert!(write_cloud(&folder.path().join("a.csv"), &small, &[column("a,b")]).is_err());
    assert_eq!(entries(&folder), 0);
}

#[test]
fn rasters_keep_values_place_and_nodata() {
    use tiff::decoder::{Decoder, DecodingResult};
    use tiff::tags::Tag;
    let folder = TempDir::new().unwrap();
    let values: Vec<f32> = (0..300 * 200).map(|i| if i == 7 { f32::INFINITY } else { i as f32 * 0.25 }).collect();
    let raster = Raster::from_values(300, 200, values.clone()).unwrap();
    let path = folder.path().join("depth.tif");
    let place = Georeference {
        upper_left: [84_500.0, 446_800.0],
        column_step: [0.5, 0.0],
        row_step: [0.0, -0.5],
        crs: dutch(),
    };
    write_tif_f32(&path, &raster, Some(&place), Some(-9999.0), None).unwrap();
    let mut decoder = Decoder::new(BufReader::new(fs::File::open(&path).unwrap())).unwrap();
    assert_eq!(decoder.dimensions().unwrap(), (300, 200));
    assert_eq!(decoder.get_tag_ascii_string(Tag::GdalNodata).unwrap(), "-9999");
    assert_eq!(decoder.get_tag_f64_vec(Tag::ModelPixelScaleTag).unwrap(), [0.5, 0.5, 0.0]);
    assert_eq!(decoder.get_tag_f64_vec(Tag::ModelTiepointTag).unwrap(), [0.0, 0.0, 0.0, 84_500.0, 446_800.0, 0.0]);
    let keys = decoder.get_tag_u16_vec(Tag::GeoKeyDirectoryTag).unwrap();
    assert!(keys.chunks(4).any(|k| k == [3072, 0, 1, 28992]), "{keys:?}");
    let DecodingResult::F32(found) = decoder.read_image().unwrap() else { panic!("not f32") };
    assert_eq!(found[7], -9999.0);
    assert_eq!(found[8..], values[8..]);

    let items = Raster::from_values(3, 2, vec![0, 1, 2, 3, 4, u32::MAX]).unwrap();
    let path = folder.path().join("items.tif");
    write_tif_u32(&path, &items, None, Some(u32::MAX), Some("view space")).unwrap();
    let mut decoder = Decoder::new(BufReader::new(fs::File::open(&path).unwrap())).unwrap();
    assert_eq!(decoder.get_tag_ascii_string(Tag::ImageDescription).unwrap(), "view space");
    assert!(decoder.get_tag(Tag::GeoKeyDirectoryTag).is_err());
    let DecodingResult::U32(found) = decoder.read_image().unwrap() else { panic!("not u32") };
    assert_eq!(found, items.values());
    assert!(write_tif_u32(&path, &Raster::filled(0, 0, 0), None, None, None).is_err());

    let path = folder.path().join("depth.npy");
    write_npy_f32_2d(&path, &raster).unwrap();
    let array = npyz::NpyFile::new(BufReader::new(fs::File::open(path).unwrap())).unwrap();
    assert_eq!(array.shape(), [200, 300]);
    assert_eq!(array.into_vec::<f32>().unwrap(), values);
}

/// Returns true if two columns are there and alike within `tolerance`.
fn alike<T: Copy + Into<f64>>(found: Option<&Vec<T>>, expected: Option<&Vec<T>>, tolerance: f64) -> bool {
    let (Some(found), Some(expected)) = (found, expected) else { return found.is_none() && expected.is_none() };
    let close = |(f, e): (&T, &T)| ((*f).into() - (*e).into()).abs() <= tolerance;
    found.len() == expected.len() && found.iter().zip(expected).all(close)
}

#[test]
fn written_clouds_read_back_the_same() {
    struct WritingCase {
        name: &'static str,
        /// Metres.
        position: f64,
        /// Radians.
        scan_angle: f64,
        color: u16,
        has_crs: bool,
    }
    let case = |name, position, scan_angle, color, has_crs| WritingCase { name, position, scan_angle, color, has_crs };
    // LAS keeps scan angles in steps of 0.006°, PLY and tables colours in 8 bits, tables a tenth of a millimetre
    let step = 0.003_01_f64.to_radians();
    let cases = [
        case("c.las", 0.000_51, step, 0, true),
        case("c.laz", 0.000_51, step, 0, true),
        case("c.ply", 0.0, 1e-7, 255, true),
        case("c.csv", 0.000_051, 1e-7, 255, false),
    ];
    let feet = Crs::parse("EPSG:2992").unwrap();
    let unnamed = Crs { metres_per_unit: FOOT, vertical_metres_per_unit: FOOT, ..Crs::default() };
    let compound = Crs::parse("EPSG:28992+5709").unwrap();
    assert!((feet.metres_per_unit - FOOT).abs() < 1e-12);
    let folder = TempDir::new().unwrap();
    for (crs, case) in [feet, unnamed, compound].iter().flat_map(|crs| cases.iter().map(move |case| (crs, case))) {
        let cloud = full_cloud().with_crs(crs.clone());
        let a = &cloud.attributes;
        let normals = a.normals.as_ref().unwrap();
        let part = |axis: usize| normals.iter().map(|n| n[axis]).collect::<Vec<f32>>();
        let parts = [part(0), part(1), part(2)];
        let normal = |i: usize, name| ExtraColumn { name, description: "", values: ExtraValues::F32(&parts[i]) };
        let las = [normal(0, "NormalX"), normal(1, "NormalY"), normal(2, "NormalZ")];
        let path = folder.path().join(case.name);
        let extra = if case.name.contains("la") { &las[..] } else { &[] };
        assert_eq!(write_cloud(&path, &cloud, extra).unwrap().left_out, [""; 0]);
        let code = crs.epsg.map(|code| format!("EPSG:{code}")).filter(|_| !case.has_crs);
        if code.is_none() && !case.has_crs {
            // a table says nothing of its unit
            continue;
        }
        let mut options = ReadOptions::new();
        options.crs = code;
        let (found, report) = read_cloud(std::slice::from_ref(&path), &options, &Control::none()).unwrap();
        let about = format!("{} {crs:?} {:?}", case.name, report.files);
        assert_eq!(found.frame.crs.epsg, crs.epsg, "{about}");
        assert!((found.frame.crs.metres_per_unit - crs.metres_per_unit).abs() < 1e-12, "{about}");
        assert!((found.frame.crs.vertical_metres_per_unit - crs.vertical_metres_per_unit).abs() < 1e-12, "{about}");
        if case.has_crs {
            assert_eq!(found.frame.crs.vertical_epsg, crs.vertical_epsg, "{about}");
        }
        assert_eq!(found.len(), cloud.len());
        for (&f, &e) in found.positions.iter().zip(&cloud.positions) {
            for axis in 0..3 {
                let off = f64::from(f[axis]) + found.frame.origin[axis] - f64::from(e[axis]) - cloud.frame.origin[axis];
                // positions near 250 m are f32 with steps of 0.015 mm
                assert!(off.abs() < case.position + 2e-5, "{about}: {off}");
            }
        }
        let b = &found.attributes;
        assert_eq!(b.normals, a.normals, "{about}");
        assert_eq!(b.classification, a.classification, "{about}");
        assert_eq!(b.gps_time, a.gps_time, "{about}");
        assert_eq!(b.gps_time_kind, a.gps_time_kind, "{about}");
        assert_eq!(b.return_number, a.return_number, "{about}");
        assert_eq!(b.return_count, a.return_count, "{about}");
        assert!(alike(b.scan_angle.as_ref(), a.scan_angle.as_ref(), case.scan_angle), "{about}");
        assert_eq!(b.point_source_id, a.point_source_id, "{about}");
        assert_eq!(b.scanner_channel, a.scanner_channel, "{about}");
        assert_eq!(b.flags, a.flags, "{about}");
        assert_eq!(b.intensity, a.intensity, "{about}");
        let (mine, theirs) = (b.color.as_ref().unwrap(), a.color.as_ref().unwrap());
        assert!(mine.as_flattened().iter().zip(theirs.as_flattened()).all(|(m, t)| m.abs_diff(*t) <= case.color));
    }
}

#[test]
fn arrays_have_the_shape_and_type_of_their_values() {
    let folder = TempDir::new().unwrap();
    let open =
        |name: &str| npyz::NpyFile::new(BufReader::new(fs::File::open(folder.path().join(name)).unwrap())).unwrap();
    write_npy_f32(&folder.path().join("f.npy"), &[1.5, f32::INFINITY]).unwrap();
    write_npy_u8(&folder.path().join("u.npy"), &[0, 255]).unwrap();
    let items = Raster::from_values(3, 2, vec![0, 1, 2, 3, 4, u32::MAX]).unwrap();
    write_npy_u32_2d(&folder.path().join("i.npy"), &items).unwrap();
    assert_eq!(open("f.npy").into_vec::<f32>().unwrap(), [1.5, f32::INFINITY]);
    assert_eq!(open("u.npy").into_vec::<u8>().unwrap(), [0, 255]);
    assert_eq!(open("i.npy").shape(), [2, 3]);
    assert_eq!(open("i.npy").into_vec::<u32>().unwrap(), items.values());
}

#[test]
fn masbcpp_folders_hold_its_arrays() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("mat");
    let points = [[1.0_f32, 2.0, 3.0], [4.0, 5.0, 6.0]];
    let arrays = MasbcppFolder {
        coords: Some(&points),
        ma_coords_in: Some(&points),
        ma_qidx_in: Some(&[-1, 0]),
        lfs: Some(&[0.5, 1.5]),
        decimate_lfs: Some(&[0, 1]),
        ..MasbcppFolder::default()
    };
    write_masbcpp(&path, &arrays).unwrap();
    let array = |name: &str| npyz::NpyFile::new(BufReader::new(fs::File::open(path.join(name)).unwrap())).unwrap();
    assert_eq!(array("ma_coords_in.npy").shape(), [2, 3]);
    assert_eq!(array("ma_coords_in.npy").into_vec::<f32>().unwrap(), points.as_flattened());
    assert_eq!(array("ma_qidx_in.npy").into_vec::<i32>().unwrap(), [-1, 0]);
    assert_eq!(array("decimate_lfs.npy").into_vec::<bool>().unwrap(), [false, true]);
    assert!(!path.join("normals.npy").exists());
    assert!(write_masbcpp(&path, &MasbcppFolder { lfs: Some(&[1.0]), ..arrays }).is_err());
}
