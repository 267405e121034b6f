//! Tables and shapes of other programs: names of QGIS and ArcGIS, encodings of spreadsheets, the meridian of 180
//! degrees.

use std::io::Cursor;

use belvedere_data::crs::Crs;
use belvedere_io::{
    FeatureShape, ObserverRow, ObserverRows, Output, PolygonArea, RowsAre, Source, read_features, read_observers,
    read_table, write_areas,
};

fn dutch() -> Crs {
    Crs::from_epsg(28_992).unwrap()
}

fn read(name: &str, bytes: &[u8], crs: &Crs) -> ObserverRows {
    read_observers(Source::bytes(name, bytes), crs, RowsAre::Places).unwrap_or_else(|e| panic!("{name}: {e}"))
}

/// The same observer as a table and as GeoJSON.
fn both_ways(values: &[(&str, &str)], crs: &Crs) -> [ObserverRows; 2] {
    let names: String = values.iter().map(|(name, _)| format!(",{name}")).collect();
    let cells: String = values.iter().map(|(_, value)| format!(",{value}")).collect();
    let table = format!("X,Y{names}\n155010,463010{cells}\n");
    let properties: Vec<String> = values.iter().map(|(name, value)| format!("\"{name}\": {value}")).collect();
    let geojson = format!(
        r#"{{"type": "Feature", "properties": {{{}}}, "geometry": {{"type": "Point", "coordinates": [155010, 463010]}}}}"#,
        properties.join(", ")
    );
    let found = [read("a.csv", table.as_bytes(), crs), read("a.geojson", geojson.as_bytes(), crs)];
    let order = |names: &[String]| {
        let mut names = names.to_vec();
        names.sort_unstable();
        names
    };
    assert_eq!(order(&found[0].unused), order(&found[1].unused));
    assert_eq!(order(&found[0].limits), order(&found[1].limits));
    assert_eq!(format!("{:?}", found[0].rows), format!("{:?}", found[1].rows), "{values:?}");
    found
}

fn one(values: &[(&str, &str)], crs: &Crs) -> ObserverRow {
    both_ways(values, crs)[0].rows[0].clone()
}

#[test]
fn tables_and_geojson_have_the_same_names_in_any_case() {
    let crs = dutch();
    assert_eq!(one(&[("z", "30.0")], &crs).corners[0][2], 30.0);
    assert_eq!(one(&[("HEIGHT", "20")], &crs).height, Some(20.0));
    let row =
        one(&[("Min_Distance", "5"), ("MAX_DISTANCE", "80"), ("Heading", "90"), ("FOV", "60"), ("Tilt", "10")], &crs);
    assert_eq!((row.distance, row.heading_deg, row.fov_deg), ([Some(5.0), Some(80.0)], Some(90.0), Some(60.0)));
    // a property stands above the third coordinate
    let text = r#"{"type": "Feature", "properties": {"Z": 30}, "geometry": {"type": "Point", "coordinates": [155010, 463010, 4]}}"#;
    assert_eq!(read("a.json", text.as_bytes(), &crs).rows[0].corners[0][2], 30.0);
}

#[test]
fn names_of_qgis_and_arcgis_are_understood_or_named() {
    let crs = dutch();
    let values = [("observ_hgt", "30"), ("radius", "500"), ("radius_in", "10"), ("azim_1", "300"), ("azim_2", "60")];
    let row = one(&values, &crs);
    assert_eq!(
        (row.height, row.distance, row.azimuth_deg),
        (Some(30.0), [Some(10.0), Some(500.0)], [Some(300.0), Some(60.0)])
    );
    let values = [
        ("OFFSETA", "2"),
        ("RADIUS1", "10"),
        ("RADIUS2", "-500"),
        ("AZIMUTH1", "0"),
        ("AZIMUTH2", "90"),
        ("VERT1", "45"),
        ("VERT2", "-30"),
        ("OFFSETB", "1"),
        ("ID", "7"),
    ];
    let found = &both_ways(&values, &crs)[0];
    let row = &found.rows[0];
    assert_eq!(
        (row.height, row.distance, row.azimuth_deg),
        (Some(2.0), [Some(10.0), Some(500.0)], [Some(0.0), Some(90.0)])
    );
    assert_eq!(row.elevation_deg, [Some(-30.0), Some(45.0)]);
    assert_eq!((&found.unused[..], found.limits.len()), (&["OFFSETB".to_owned()][..], 6));
    // the eye stands above SPOT
    let row = one(&[("SPOT", "12.5"), ("OFFSETA", "2")], &crs);
    assert_eq!(row.corners[0][2], 14.5);
    assert_eq!(one(&[("SPOT", "12.5")], &crs).corners[0][2], 13.5);
    // of a range with one end the other is that of all directions
    assert_eq!(one(&[("AZIMUTH1", "90")], &crs).azimuth_deg, [Some(90.0), Some(360.0)]);
    assert_eq!(one(&[("elevation_to", "20")], &crs).elevation_deg, [Some(-90.0), Some(20.0)]);
    let found = &both_ways(&[("target_hgt", "2"), ("eyeHeightM", "3"), ("name", "4"), ("bearing", "5")], &crs)[0];
    assert_eq!((found.unused.len(), found.rows[0].height), (3, None), "{:?}", found.unused);
    // where two say the same, our own name counts, and the other is named
    let found = &both_ways(&[("observ_hgt", "30"), ("height", "4")], &crs)[0];
    assert_eq!((found.rows[0].height, &found.unused[..]), (Some(4.0), &["observ_hgt".to_owned()][..]));
}

#[test]
fn lengths_of_other_programs_are_in_the_unit_of_the_file() {
    let feet = Crs::from_epsg(2263).unwrap();
    let foot = feet.metres_per_unit;
    assert!((foot - 0.3048).abs() < 1e-5);
    let text = "x,y,OFFSETA,RADIUS2\n980000,200000,10,1000\n";
    let row = read("a.csv", text.as_bytes(), &feet).rows[0].clone();
    assert!(
        (row.height.unwrap() - 10.0 * foot).abs() < 1e-9 && (row.distance[1].unwrap() - 1000.0 * foot).abs() < 1e-9
    );
    let text = "x,y,height,max_distance\n980000,200000,10,1000\n";
    let row = read("a.csv", text.as_bytes(), &feet).rows[0].clone();
    assert_eq!((row.height, row.distance[1]), (Some(10.0), Some(1000.0)));
}

#[test]
fn tables_in_utf_16_are_read() {
    let text = "\u{feff}x,y,name\n155010,463010,Köln\n";
    for bytes in [
        text.encode_utf16().flat_map(u16::to_le_bytes).collect::<Vec<u8>>(),
        text.encode_utf16().flat_map(u16::to_be_bytes).collect(),
        // "Unicode text" of a spreadsheet has tabs
        text.replace(',', "\t").encode_utf16().flat_map(u16::to_le_bytes).collect(),
        text.as_bytes().to_vec(),
    ] {
        let table = read_table(Source::bytes("a.txt", &bytes)).unwrap();
        assert_eq!(table.names(), ["x", "y", "name"]);
        assert_eq!(table.into_text().columns(0..1)[2].1, ["Köln"]);
        assert_eq!(read("a.csv", &bytes, &dutch()).rows.len(), 1);
    }
    let geojson = "\u{feff}{\"type\": \"Point\", \"coordinates\": [155010, 463010]}";
    let bytes: Vec<u8> = geojson.encode_utf16().flat_map(u16::to_le_bytes).collect();
    assert_eq!(read_features(Source::bytes("a.geojson", &bytes), &dutch()).unwrap().len(), 1);
    // half a character at the end, and halves of pairs, are no reason to fail
    let odd: Vec<u8> =
        [0xff, 0xfe].into_iter().chain("x,y\n1,2\n".encode_utf16().flat_map(u16::to_le_bytes)).chain([0x33]).collect();
    assert_eq!(read_table(Source::bytes("a.csv", &odd)).unwrap().row_count(), 1);
}

#[test]
fn polygons_across_180_degrees_are_cut_on_writing_and_whole_again_on_reading() {
    // UTM zones 1 and 60 meet there; the Fiji grid runs across
    for (code, middle) in
        [(32_701, [166_021.0, 8_100_000.0]), (32_760, [833_978.0, 8_100_000.0]), (3460, [2_133_000.0, 4_000_000.0])]
    {
        let crs = Crs::from_epsg(code).unwrap();
        let projection = crs.geographic_projection().unwrap();
        // a square of 20 km around a place on the meridian
        let [latitude, _] = projection.unproject(middle).unwrap();
        let [x, y] = projection.project(latitude, std::f64::consts::PI).unwrap();
        let side = 10_000.0;
        let square: Vec<[f64; 2]> = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]]
            .map(|[dx, dy]: [f64; 2]| [x + side * dx, y + side * dy])
            .to_vec();
        let area = PolygonArea { polygons: vec![vec![square]], ..PolygonArea::default() };
        let mut cursor = Cursor::new(Vec::new());
        write_areas(Output::writer("a.geojson", &mut cursor), &[area], &crs).unwrap();
        let bytes = cursor.into_inner();
        let text = String::from_utf8(bytes.clone()).unwrap();
        let found = read_features(Source::bytes("a.geojson", &bytes), &crs).unwrap();
        assert_eq!(found.len(), 2, "EPSG:{code}: {text}");
        assert!(text.contains("180.0") && text.contains("-180.0"), "EPSG:{code}: {text}");
        let mut sum = 0.0;
        for feature in &found {
            let FeatureShape::Polygon(rings) = &feature.shape else { panic!("{feature:?}") };
            for corner in rings.iter().flatten() {
                let away = [corner[0] - x, corner[1] - y];
                assert!(away.iter().all(|v| v.abs() < side + 100.0), "EPSG:{code}: {away:?}");
            }
            sum +=
                rings[0].windows(2).map(|p| (p[0][0] - x) * (p[1][1] - y) - (p[1][0] - x) * (p[0][1] - y)).sum::<f64>()
                    / 2.0;
        }
        // the meridian is a straight line on the map to within metres over 20 km
        assert!((sum / (4.0 * side * side) - 1.0).abs() < 1e-4, "EPSG:{code}: {sum}");
        // other programs write it whole, with longitudes beyond 180 or with a jump
        let longitude = |x: f64| if x < 0.0 { x + 360.0 } else { x };
        for beyond in [true, false] {
            let ring: Vec<String> =
                [[179.95, -17.0], [-179.95, -17.0], [-179.95, -16.9], [179.95, -16.9], [179.95, -17.0]]
                    .map(|[x, y]| format!("[{}, {y}]", if beyond { longitude(x) } else { x }))
                    .to_vec();
            let text = format!("{{\"type\": \"Polygon\", \"coordinates\": [[{}]]}}", ring.join(", "));
            let found = read_features(Source::bytes("a.geojson", text.as_bytes()), &crs).unwrap();
            let FeatureShape::Polygon(rings) = &found[0].shape else { panic!("{found:?}") };
            let xs = rings[0].iter().map(|corner| corner[0]);
            let width = xs.clone().fold(f64::MIN, f64::max) - xs.fold(f64::MAX, f64::min);
            assert!((10_000.0..11_500.0).contains(&width), "EPSG:{code}: {width}");
        }
    }
}
