//! GeoPackage and Shapefile: the same features as GeoJSON, and what is refused.

use belvedere_data::crs::Crs;
use belvedere_data::frame::Frame;
use belvedere_io::{
    FeatureCoordinates, FeatureShape, MapFeature, Output, PathLine, PolygonArea, Source, Spot, holds_polygons,
    read_features, read_footprints, write_areas, write_places,
};
use serde_json::{Map, Value, json};
use std::io::Cursor;

fn properties(value: Value) -> Map<String, Value> {
    value.as_object().unwrap().clone()
}

fn rd() -> Crs {
    Crs::from_epsg(28_992).unwrap()
}

fn written(name: &str, write: impl FnOnce(Output<'_>) -> FeatureCoordinates) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    write(Output::writer(name, &mut bytes));
    bytes.into_inner()
}

fn areas() -> Vec<PolygonArea> {
    let ring = |[x, y]: [f64; 2], side: f64| vec![[x, y], [x + side, y], [x + side, y + side], [x, y + side], [x, y]];
    let hole = ring([155_002.0, 463_002.0], 2.0).into_iter().rev().collect();
    vec![
        PolygonArea {
            polygons: vec![vec![ring([155_000.0, 463_000.0], 10.0), hole]],
            properties: properties(json!({"name": "garden", "area_m2": 96, "is_open": true})),
        },
        PolygonArea {
            polygons: vec![vec![ring([155_100.0, 463_000.0], 5.0)], vec![ring([155_110.0, 463_000.0], 5.0)]],
            properties: properties(json!({"name": "O'Hara \"yard\"", "area_m2": 50.5})),
        },
    ]
}

/// Greatest difference of coordinates of two features of the same shape, metres.
fn difference(a: &MapFeature, b: &MapFeature) -> f64 {
    let [a, b] = [a, b].map(|feature| feature.shape.corners().copied().collect::<Vec<_>>());
    assert_eq!(a.len(), b.len());
    a.iter()
        .zip(&b)
        .flat_map(|(a, b)| (0..2).map(|i| (a[i] - b[i]).abs()))
        .inspect(|difference| assert!(!difference.is_nan()))
        .fold(0.0, f64::max)
}

#[test]
fn a_geopackage_has_the_features_of_the_geojson() {
    let of = |name: &str| written(name, |output| write_areas(output, &areas(), &rd()).unwrap());
    let (json, package) = (of("areas.geojson"), of("areas.gpkg"));
    assert!(package.starts_with(b"SQLite format 3\0"));
    assert_eq!(package, of("areas.gpkg"), "the same features are the same bytes");
    let read = |name: &str, bytes: &[u8], crs: &Crs| read_features(Source::bytes(name, bytes), crs);
    let by_json = read("areas.geojson", &json, &rd()).unwrap();
    let by_package = read("areas.gpkg", &package, &rd()).unwrap();
    assert_eq!([by_json.len(), by_package.len()], [3, 3]);
    for (a, b) in by_json.iter().zip(&by_package) {
        // seven decimals of a degree
        assert!(difference(a, b) < 0.02, "{}", difference(a, b));
        assert_eq!(a.properties["name"], b.properties["name"]);
        assert_eq!(a.properties["area_m2"].as_f64(), b.properties["area_m2"].as_f64());
    }
    assert_eq!(by_package[1].properties["name"], "O'Hara \"yard\"");
    let FeatureShape::Polygon(rings) = &by_package[0].shape else { panic!("a polygon") };
    assert_eq!((rings.len(), rings[0][0][0], rings[0][0][1]), (2, 155_000.0, 463_000.0));
    // another plane leads nowhere
    let error = read("areas.gpkg", &package, &Crs::from_epsg(25_832).unwrap()).unwrap_err().to_string();
    assert!(error.contains("28992") && error.contains("WGS 84"), "{error}");
    // outlines of buildings too
    let frame = Frame { origin: [155_000.0, 463_000.0, 0.0], crs: rd() };
    let footprints = read_footprints(Source::bytes("areas.gpkg", &package), &frame).unwrap();
    assert_eq!(footprints.iter().map(|one| one.polygons.len()).collect::<Vec<_>>(), [1, 2]);
}

#[test]
fn places_and_lines_keep_their_heights_in_a_geopackage() {
    let spots = [Spot { place: [155_000.5, 463_000.25, 12.5], properties: properties(json!({"id": 7})) }];
    let lines =
        [PathLine { places: vec![[155_000.0, 463_000.0, 1.0], [155_010.0, 463_000.0, 2.0]], ..PathLine::default() }];
    let bytes = written("places.gpkg", |output| write_places(output, &spots, &lines, &rd()).unwrap());
    let found = read_features(Source::bytes("places.gpkg", &bytes), &rd()).unwrap();
    assert_eq!(found[0].shape, FeatureShape::Point([155_000.5, 463_000.25, 12.5]));
    assert_eq!(found[0].properties["id"], 7);
    assert_eq!(found[1].shape, FeatureShape::Line(vec![[155_000.0, 463_000.0, 1.0], [155_010.0, 463_000.0, 2.0]]));
    // and nothing at all is a table without rows
    let bytes = written("none.gpkg", |output| write_areas(output, &[], &Crs::default()).unwrap());
    assert_eq!(read_features(Source::bytes("none.gpkg", &bytes), &rd()).unwrap(), []);
}

#[test]
fn damaged_geopackages_are_refused_or_read() {
    let bytes = written("areas.gpkg", |output| write_areas(output, &areas(), &rd()).unwrap());
    let names = |bytes: &[u8]| read_features(Source::bytes("damaged.gpkg", bytes), &rd()).map(|found| found.len());
    for end in [0, 1, 17, 99, 100, 4096, bytes.len() / 2, bytes.len() - 1] {
        if let Err(error) = names(&bytes[..end]) {
            assert!(error.to_string().starts_with("damaged.gpkg"), "{error}");
        }
    }
    assert!(names(b"not a database at all, but long enough to look like one").is_err());
    let mut refused = 0;
    for i in 0..3000_u64 {
        let mut damaged = bytes.clone();
        for k in 0..4 {
            let at = belvedere_data::random::uniform(3, 8 * i + k) * damaged.len() as f64;
            let at = at as usize;
            damaged[at] ^= 1 << (i % 8);
        }
        refused += usize::from(names(&damaged).is_err());
    }
    assert!(refused > 100, "{refused}");
}

#[test]
fn odd_names_and_columns_of_packages_are_kept() {
    let place = [155_000.0, 463_000.0, 1.0];
    let own = json!({"fid": 9, "geom": "g", "Name": "a", "name": "b", "nothing": null, "is_virtual": true});
    let spots = [Spot { place, properties: properties(own) }];
    for name in ["gpkg_contents.gpkg", "sqlite_x.gpkg", "A \"quoted\" name.GPKG"] {
        let bytes = written(name, |output| write_places(output, &spots, &[], &rd()).unwrap());
        let found = read_features(Source::bytes("odd.gpkg", &bytes), &rd()).unwrap();
        let values = ["fid_1", "geom_1", "Name", "name_1", "is_virtual"].map(|key| found[0].properties[key].clone());
        assert_eq!(values, [json!(9), json!("g"), json!("a"), json!("b"), json!(1)], "{name}");
    }
    // places without coordinates are refused in each format
    let nowhere = [Spot { place: [f64::NAN, 463_000.0, 1.0], ..Spot::default() }];
    let bytes = written("nowhere.gpkg", |output| write_places(output, &nowhere, &[], &rd()).unwrap());
    let found = read_features(Source::bytes("nowhere.gpkg", &bytes), &rd());
    assert!(found.is_ok_and(|found| found.is_empty()), "a point without coordinates is empty");
    let line = [PathLine { places: vec![place, [1.0, f64::INFINITY, 0.0]], ..PathLine::default() }];
    let bytes = written("nowhere.gpkg", |output| write_places(output, &[], &line, &rd()).unwrap());
    let error = read_features(Source::bytes("nowhere.gpkg", &bytes), &rd()).unwrap_err().to_string();
    assert!(error.contains("not finite"), "{error}");
    assert!(
        read_features(Source::bytes("empty.gpkg", b""), &rd()).unwrap_err().to_string().contains("is no GeoPackage")
    );
}

#[test]
fn a_package_with_changes_beside_it_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("areas.gpkg");
    write_areas(&path, &areas(), &rd()).unwrap();
    assert_eq!(read_features(&path, &rd()).unwrap().len(), 3);
    assert!(holds_polygons(&path).unwrap());
    std::fs::write(folder.path().join("areas.gpkg-wal"), b"changes").unwrap();
    let error = read_features(&path, &rd()).unwrap_err().to_string();
    assert!(error.contains("not saved"), "{error}");
}

/// Writes a Shapefile of two polygons, of which the first has a hole, into a folder; returns its path.
fn shapefile_in(folder: &std::path::Path) -> std::path::PathBuf {
    use shapefile::dbase::{FieldName, FieldValue, Record, TableWriterBuilder};
    use shapefile::record::polygon::PolygonRing;
    use shapefile::{Point, Polygon, Writer};
    let path = folder.join("yards.shp");
    let ring = |[x, y]: [f64; 2], side: f64| {
        [[x, y], [x, y + side], [x + side, y + side], [x + side, y], [x, y]].map(|[x, y]| Point::new(x, y)).to_vec()
    };
    let hole = ring([155_002.0, 463_002.0], 2.0).into_iter().rev().collect();
    let polygons = [
        Polygon::with_rings(vec![PolygonRing::Outer(ring([155_000.0, 463_000.0], 10.0)), PolygonRing::Inner(hole)]),
        Polygon::new(PolygonRing::Outer(ring([155_100.0, 463_000.0], 5.0))),
    ];
    let table = TableWriterBuilder::new()
        .add_character_field(FieldName::try_from("name").unwrap(), 20)
        .add_numeric_field(FieldName::try_from("height").unwrap(), 10, 2);
    let mut writer = Writer::from_path(&path, table).unwrap();
    for (polygon, name) in polygons.iter().zip(["garden", "yard"]) {
        let mut record = Record::default();
        record.insert("name".to_owned(), FieldValue::Character(Some(name.to_owned())));
        record.insert("height".to_owned(), FieldValue::Numeric(Some(2.5)));
        writer.write_shape_and_record(polygon, &record).unwrap();
    }
    path
}

#[test]
fn a_shapefile_has_its_attributes_and_its_system_beside_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = shapefile_in(folder.path());
    let found = read_features(&path, &rd()).unwrap();
    let FeatureShape::Polygon(rings) = &found[0].shape else { panic!("a polygon") };
    assert_eq!((found.len(), rings.len(), rings[1].len()), (2, 2, 5));
    assert_eq!((rings[0][0][0], rings[0][0][1], rings[0][0][2].is_nan()), (155_000.0, 463_000.0, true));
    assert_eq!((&found[1].properties["name"], found[1].properties["height"].as_f64()), (&json!("yard"), Some(2.5)));
    // a system beside it that is another one
    let utm = "PROJCS[\"ETRS89 / UTM zone 32N\",GEOGCS[\"ETRS89\",DATUM[\"D_ETRS_1989\",SPHEROID[\"GRS_1980\",6378137,\
               298.257222101]],PRIMEM[\"Greenwich\",0],UNIT[\"Degree\",0.017453292519943295]],PROJECTION[\"Transverse_Mercator\"],\
               PARAMETER[\"latitude_of_origin\",0],PARAMETER[\"central_meridian\",9],PARAMETER[\"scale_factor\",0.9996],\
               PARAMETER[\"false_easting\",500000],PARAMETER[\"false_northing\",0],UNIT[\"Meter\",1]]";
    std::fs::write(path.with_extension("prj"), utm).unwrap();
    let error = read_features(&path, &rd()).unwrap_err().to_string();
    assert!(error.contains("yards.shp") && error.contains("UTM zone 32N"), "{error}");
    std::fs::write(path.with_extension("prj"), "nonsense").unwrap();
    assert!(read_features(&path, &rd()).unwrap_err().to_string().contains("yards.prj"));
    std::fs::remove_file(path.with_extension("prj")).unwrap();
    assert!(holds_polygons(&path).unwrap());
    // a deleted row is a star in its first byte, after 32 bytes of head and for each of two columns, and one at the end
    let table = path.with_extension("dbf");
    let mut bytes = std::fs::read(&table).unwrap();
    let first = 32 * 3 + 1;
    assert_eq!(bytes[first], b' ');
    bytes[first] = b'*';
    std::fs::write(&table, bytes).unwrap();
    let error = read_features(&path, &rd()).unwrap_err().to_string();
    assert!(error.contains("1 rows for 2 shapes"), "{error}");
    std::fs::remove_file(&table).unwrap();
    assert!(read_features(&path, &rd()).unwrap()[0].properties.is_empty());
    let error = read_features(folder.path().join("none.shp"), &rd()).unwrap_err().to_string();
    assert!(error.contains("none.shp"), "{error}");
}

#[test]
fn names_of_a_shapefile_are_in_the_encoding_that_it_names() {
    let folder = tempfile::tempdir().unwrap();
    let path = shapefile_in(folder.path());
    let [table, beside] = ["dbf", "cpg"].map(|extension| path.with_extension(extension));
    let original = std::fs::read(&table).unwrap();
    // "garden" of six bytes, in encodings of one byte a letter and of two
    let named = |bytes: &[u8; 6], mark: u8, encoding: Option<&str>| {
        let mut table_bytes = original.clone();
        let at = table_bytes.windows(6).position(|window| window == b"garden").unwrap();
        table_bytes[at..at + 6].copy_from_slice(bytes);
        table_bytes[29] = mark;
        std::fs::write(&table, table_bytes).unwrap();
        let _ = std::fs::remove_file(&beside);
        if let Some(name) = encoding {
            std::fs::write(&beside, name).unwrap();
        }
        read_features(&path, &rd()).map(|features| features[0].properties["name"].as_str().unwrap().to_owned())
    };
    let (latin, utf8, cyrillic) = (b"Stra\xdfe", b"Gr\xc3\xbc_ ", b"\xd1\xe0\xe4   ");
    for encoding in ["ISO-8859-1", "1252", "LATIN1"] {
        assert_eq!(named(latin, 0, Some(encoding)).unwrap(), "Straße");
    }
    assert_eq!(named(utf8, 0, Some("UTF-8")).unwrap(), "Grü_");
    assert_eq!(named(cyrillic, 0, Some("1251")).unwrap(), "Сад");
    // without a file the header counts, 0x57 for Western European and 0xC9 for Cyrillic, and else Western European
    assert_eq!(named(latin, 0x57, None).unwrap(), "Straße");
    assert_eq!(named(cyrillic, 0xc9, None).unwrap(), "Сад");
    assert_eq!(named(latin, 0, None).unwrap(), "Straße");
    let error = named(latin, 0, Some("EBCDIC")).unwrap_err().to_string();
    assert!(error.contains("yards.cpg") && error.contains("EBCDIC") && error.contains("UTF-8"), "{error}");
}

#[test]
fn damaged_shapefiles_are_refused_or_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = shapefile_in(folder.path());
    for extension in ["shp", "dbf"] {
        let own = path.with_extension(extension);
        let bytes = std::fs::read(&own).unwrap();
        let mut refused = 0;
        for i in 0..1000_u64 {
            let mut damaged = bytes.clone();
            if i % 10 == 0 {
                damaged.truncate(usize::try_from(i).unwrap() * bytes.len() / 1000);
            }
            for k in 0..3 {
                let at = belvedere_data::random::uniform(4, 8 * i + k) * damaged.len() as f64;
                if let Some(byte) = damaged.get_mut(at as usize) {
                    *byte ^= 1 << (i % 8);
                }
            }
            std::fs::write(&own, &damaged).unwrap();
            if let Err(error) = read_features(&path, &rd()) {
                assert!(error.to_string().contains("yards."), "{error}");
                refused += 1;
            }
        }
        assert!(refused > 50, "{extension}: {refused}");
        std::fs::write(&own, &bytes).unwrap();
    }
}
