//! Pairs of sources that contradict each other: something is said of every one. What two agree on is taken in silence.

use belvedere::apps::ask::SunPlace;
use belvedere::apps::ask::scene::Whereabouts;
use belvedere::apps::ask::{Context, Remark};
use belvedere::control::Control;
use belvedere::crs::{Crs, US_SURVEY_FOOT, text};
use belvedere::io::{ReadOptions, Source, read_cloud, read_features, read_mesh_in, read_terrain};
use belvedere::{Bounds, Frame, PointCloud, Result};
use std::fs;
use std::path::Path;

/// A place in the area of use of a system, in its unit.
fn place_in(code: u32) -> [f64; 3] {
    match code {
        28_992 | 7415 => [85_000.0, 447_000.0, 3.0],
        2154 => [652_000.0, 6_862_000.0, 40.0],
        25_832 => [513_000.0, 5_402_000.0, 250.0],
        2263 => [985_000.0, 210_000.0, 50.0],
        26_910 | 26_911 => [545_010.0, 5_180_030.0, 60.0],
        other => panic!("no place for EPSG:{other}"),
    }
}

fn wkt(code: &str) -> String {
    text::wkt_line(&Crs::parse(code).unwrap()).unwrap()
}

/// A record of a LAS file: user, number, content.
type LasRecord = (&'static str, u16, Vec<u8>);

fn text_record(content: &str) -> LasRecord {
    ("LASF_Projection", 2112, [content.as_bytes(), b"\0"].concat())
}

fn keys_record(keys: &[[u16; 2]]) -> LasRecord {
    let mut words = vec![1, 1, 0, u16::try_from(keys.len()).unwrap()];
    words.extend(keys.iter().flat_map(|&[key, value]| [key, 0, 1, value]));
    ("LASF_Projection", 34_735, words.into_iter().flat_map(u16::to_le_bytes).collect())
}

/// Keys of a projected system.
fn keys(code: u16, more: &[[u16; 2]]) -> LasRecord {
    keys_record(&[&[[1024, 1], [3072, code]], more].concat())
}

/// A LAS 1.4 file of a few points around a place. Its header says whether well-known text decides.
fn las(records: &[LasRecord], wkt_decides: bool, place: [f64; 3]) -> Vec<u8> {
    const POINTS: u32 = 9;
    let length: usize = records.iter().map(|record| 54 + record.2.len()).sum();
    let mut bytes = vec![0; 375];
    let mut put = |at: usize, value: &[u8]| bytes[at..at + value.len()].copy_from_slice(value);
    put(0, b"LASF");
    put(6, &(if wkt_decides { 16_u16 } else { 0 }).to_le_bytes());
    put(24, &[1, 4]);
    put(94, &375_u16.to_le_bytes());
    put(96, &u32::try_from(375 + length).unwrap().to_le_bytes());
    put(100, &u32::try_from(records.len()).unwrap().to_le_bytes());
    put(105, &20_u16.to_le_bytes());
    put(107, &POINTS.to_le_bytes());
    put(247, &u64::from(POINTS).to_le_bytes());
    for (axis, low) in place.into_iter().enumerate() {
        put(131 + 8 * axis, &0.01_f64.to_le_bytes());
        put(155 + 8 * axis, &low.to_le_bytes());
        put(179 + 16 * axis, &(low + 2.0).to_le_bytes());
        put(187 + 16 * axis, &low.to_le_bytes());
    }
    for (user, id, content) in records {
        let mut head = vec![0; 54];
        head[2..2 + user.len()].copy_from_slice(user.as_bytes());
        head[18..20].copy_from_slice(&id.to_le_bytes());
        head[20..22].copy_from_slice(&u16::try_from(content.len()).unwrap().to_le_bytes());
        bytes.extend([head, content.clone()].concat());
    }
    for point in 0..POINTS {
        let at = [point % 3 * 100, point / 3 * 100, point % 2 * 50];
        bytes.extend(at.map(u32::to_le_bytes).concat());
        bytes.extend([0; 8]);
    }
    bytes
}

/// Returns the message of reading about the reference system: an error, or the doubt of the cloud.
fn said_of(path: &Path, options: &ReadOptions) -> Option<String> {
    match read_cloud([path], options, &Control::none()) {
        Ok((cloud, report)) => {
            let of_others =
                report.files.into_iter().flat_map(|file| file.notes).find(|note| note.contains("beside it"));
            cloud.frame.crs.doubt.or(of_others)
        }
        Err(error) => Some(error.to_string()),
    }
}

fn said_of_las(records: &[LasRecord], place: [f64; 3], crs: Option<&str>) -> Option<String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("tile.las");
    fs::write(&path, las(records, true, place)).unwrap();
    let mut options = ReadOptions::new();
    options.crs = crs.map(str::to_owned);
    said_of(&path, &options)
}

/// Returns the message about a file of text beside a `.prj`.
fn said_of_text(beside: Option<&str>, place: [f64; 3], crs: Option<&str>) -> Option<String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("tile.xyz");
    let line = |i: i32| format!("{} {} {}\n", place[0] + f64::from(i), place[1] + f64::from(i % 3), place[2]);
    fs::write(&path, (0..9).map(line).collect::<String>()).unwrap();
    if let Some(text) = beside {
        fs::write(path.with_extension("prj"), text).unwrap();
    }
    let mut options = ReadOptions::new();
    options.crs = crs.map(str::to_owned);
    said_of(&path, &options)
}

fn said_of_las_beside(record: LasRecord, beside: &str, place: [f64; 3]) -> Option<String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("tile.las");
    fs::write(&path, las(&[record], true, place)).unwrap();
    fs::write(path.with_extension("prj"), beside).unwrap();
    said_of(&path, &ReadOptions::new())
}

fn geojson(member: &str, at: [f64; 2]) -> String {
    format!(
        r#"{{"type": "FeatureCollection", "crs": {member}, "features": [{{"type": "Feature", "properties": {{}},
           "geometry": {{"type": "Point", "coordinates": [{}, {}]}}}}]}}"#,
        at[0], at[1]
    )
}

fn named(name: &str) -> String {
    format!(r#"{{"type": "name", "properties": {{"name": "{name}"}}}}"#)
}

fn said_of_geojson(member: &str, at: [f64; 2], cloud: &Crs) -> Option<String> {
    let text = geojson(member, at);
    read_features(Source::bytes("places.geojson", text.as_bytes()), cloud).err().map(|error| error.to_string())
}

fn said_of_cityjson(system: &str, scene: &str) -> Option<String> {
    let text = format!(
        r#"{{"type": "CityJSON", "version": "2.0", "metadata": {{"referenceSystem": "{system}"}}, "transform":
           {{"scale": [1, 1, 1], "translate": [0, 0, 0]}}, "vertices": [[0, 0, 0], [9, 0, 0], [9, 9, 0]], "CityObjects":
           {{"b": {{"type": "Building", "geometry": [{{"type": "MultiSurface", "lod": "1", "boundaries": [[[0, 1, 2]]]}}]}}}}}}"#
    );
    let scene = Crs::parse(scene).unwrap();
    read_mesh_in(Source::bytes("plan.city.json", text.as_bytes()), &scene).err().map(|error| error.to_string())
}

fn said_of_terrain(raster: &str, scene: &str) -> Option<String> {
    use belvedere::io::{Georeference, write_tif_f32};
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("dtm.tif");
    let crs = Crs::parse(raster).unwrap();
    let place = Georeference { upper_left: [1000.0, 2000.0], column_step: [10.0, 0.0], row_step: [0.0, -10.0], crs };
    let values = belvedere::raster::Raster::from_values(3, 3, vec![1.0; 9]).unwrap();
    write_tif_f32(path.as_path(), &values, Some(&place), None, None).unwrap();
    let frame = Frame { origin: [0.0; 3], crs: Crs::parse(scene).unwrap() };
    read_terrain(path.as_path(), &frame).err().map(|error| error.to_string())
}

/// Returns the message about a location for a scene at a place of a system: an error, or remarks.
fn said_of_location(crs: &str, place: [f64; 3], location: Option<[f64; 2]>) -> Option<String> {
    let frame = Frame { origin: place, crs: Crs::parse(crs).unwrap() };
    let bounds = Bounds { low: [-50.0, -50.0, 0.0], high: [50.0, 50.0, 10.0] };
    let whereabouts = Whereabouts { frame: &frame, bounds, has_far_terrain: false };
    let mut context = Context::default();
    whereabouts.remark(&mut context);
    let sun_place = SunPlace { location, ..SunPlace::default() };
    if let Err(error) = sun_place.site_at(&whereabouts, &mut context, None) {
        return Some(error.to_string());
    }
    let remarks: Vec<Remark> = context.into_answers().remarks;
    (!remarks.is_empty()).then(|| remarks.iter().map(|remark| format!("{}: {}; ", remark.key, remark.text)).collect())
}

/// Two sources, what was said of them, and words that must be in it.
type Pair = (&'static str, Option<String>, &'static [&'static str]);

fn pairs_within_a_file() -> Vec<Pair> {
    let northwest = place_in(26_910);
    let delft = place_in(28_992);
    let zone_10 = wkt("EPSG:26910");
    let unnamed = |text: &str| {
        // without codes nothing but the parameters is left
        let mut text = text.to_owned();
        while let Some(at) = text.find(",AUTHORITY[") {
            let end = at + text[at..].find(']').unwrap();
            text.replace_range(at..=end, "");
        }
        text
    };
    let other_meridian = unnamed(&zone_10).replace("-123", "-117");
    assert_ne!(other_meridian, unnamed(&zone_10));
    let in_feet = {
        let at = zone_10.rfind("UNIT[").unwrap();
        let end = at + zone_10[at..].find(']').unwrap();
        // what is left out has a code of its own
        format!("{}UNIT[\"US survey foot\",0.304800609601219{}", &zone_10[..at], &zone_10[end + 1..])
    };
    let twice = |first: &str, second: &str, place| said_of_las(&[text_record(first), text_record(second)], place, None);
    let liblas = ("liblas", 2112, wkt("EPSG:26911").into_bytes());
    vec![
        (
            "text and keys of two zones",
            said_of_las(&[text_record(&zone_10), keys(26_911, &[])], northwest, None),
            &["26910", "26911", "km apart"],
        ),
        (
            "text and keys of two countries",
            said_of_las(&[text_record(&wkt("EPSG:28992")), keys(2154, &[])], delft, None),
            &["28992", "2154"],
        ),
        (
            "text in metres, keys of a system in feet",
            said_of_las(&[text_record(&wkt("EPSG:32618")), keys(2263, &[])], [585_000.0, 4_510_000.0, 9.0], None),
            &["metres", "feet"],
        ),
        (
            "text in feet, keys in metres",
            said_of_las(&[text_record(&wkt("EPSG:2263")), keys(32_618, &[])], place_in(2263), None),
            &["metres", "feet"],
        ),
        (
            "text of a plane, keys of degrees",
            said_of_las(&[text_record(&zone_10), keys_record(&[[1024, 2], [2048, 4326]])], northwest, None),
            &["26910", "4326"],
        ),
        (
            "text of degrees, keys of a plane",
            said_of_las(&[text_record(&wkt("EPSG:4326")), keys(26_910, &[])], northwest, None),
            &["degrees"],
        ),
        (
            "keys: code in metres, unit feet",
            said_of_las(&[keys(26_910, &[[3076, 9003]])], northwest, None),
            &["US survey feet", "metres"],
        ),
        (
            "keys: code in feet, unit metres",
            said_of_las(&[keys(2263, &[[3076, 9001]])], place_in(2263), None),
            &["US survey feet", "metres"],
        ),
        (
            "keys: heights in feet by code, metres by unit",
            said_of_las(&[keys(26_910, &[[4096, 6360], [4099, 9001]])], northwest, None),
            &["US survey feet", "metres"],
        ),
        (
            "keys: heights in metres by code, feet by unit",
            said_of_las(&[keys(26_910, &[[4096, 5703], [4099, 9003]])], northwest, None),
            &["US survey feet", "metres"],
        ),
        (
            "heights of text in metres, of keys in feet",
            said_of_las(
                &[text_record(&wkt("EPSG:26910+5703")), keys(26_910, &[[4096, 6360], [4099, 9003]])],
                northwest,
                None,
            ),
            &["heights", "US survey feet", "metres"],
        ),
        (
            "heights of text in feet, of keys in metres",
            said_of_las(
                &[text_record(&wkt("EPSG:26910+6360")), keys(26_910, &[[4096, 5703], [4099, 9001]])],
                northwest,
                None,
            ),
            &["heights", "US survey feet", "metres"],
        ),
        (
            "two texts of other programs",
            said_of_las(&[text_record(&zone_10), liblas], northwest, None),
            &["26910", "26911"],
        ),
        (
            "name of a zone and its central meridian",
            twice(&other_meridian, &other_meridian, northwest),
            &["-117", "zone 10"],
        ),
        (
            "code in metres, unit of the text in feet",
            twice(&in_feet, &in_feet, northwest),
            &["26910", "US survey feet"],
        ),
        (
            "file and .prj of two countries",
            said_of_las_beside(text_record(&wkt("EPSG:28992")), &wkt("EPSG:2154"), delft),
            &["28992", "2154", "tile.prj"],
        ),
        (
            "file in metres and .prj in feet",
            said_of_las_beside(keys(32_618, &[]), &wkt("EPSG:2263"), [585_000.0, 4_510_000.0, 9.0]),
            &["metres", "feet"],
        ),
        ("a .prj that is no system", said_of_text(Some("nonsense"), delft, None), &["tile.prj"]),
    ]
}

fn pairs_with_a_given_system() -> Vec<Pair> {
    let (delft, paris, northwest) = (place_in(28_992), place_in(2154), place_in(26_910));
    let given = |record: LasRecord, place, crs: &str| said_of_las(&[record], place, Some(crs));
    let ply = {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("tile.ply");
        let (cloud, _) = PointCloud::from_coordinates(&[delft, [85_001.0, 447_001.0, 3.0], [85_002.0, 447_000.0, 3.0]]);
        belvedere::io::write_cloud(path.as_path(), &cloud.with_crs(Crs::parse("EPSG:28992").unwrap()), &[]).unwrap();
        said_of(&path, &ReadOptions::new().with_crs("EPSG:2154"))
    };
    let two_files = {
        let folder = tempfile::tempdir().unwrap();
        let [a, b] = ["a.las", "b.las"].map(|name| folder.path().join(name));
        fs::write(&a, las(&[keys(28_992, &[])], true, delft)).unwrap();
        fs::write(&b, las(&[keys(2154, &[])], true, paris)).unwrap();
        read_cloud([a, b], &ReadOptions::new(), &Control::none()).err().map(|error| error.to_string())
    };
    vec![
        (
            "given and text of two countries",
            given(text_record(&wkt("EPSG:2154")), paris, "EPSG:28992"),
            &["28992", "2154", "tile.las"],
        ),
        ("given and keys of two countries", given(keys(2154, &[]), paris, "EPSG:28992"), &["28992", "2154"]),
        (
            "given and .prj of two countries",
            said_of_text(Some(&wkt("EPSG:2154")), paris, Some("EPSG:28992")),
            &["28992", "2154"],
        ),
        ("given and comments of two countries", ply, &["28992", "2154"]),
        (
            "given and text of two zones",
            given(text_record(&wkt("EPSG:26910")), northwest, "EPSG:26911"),
            &["26910", "26911"],
        ),
        ("given in feet, file in metres", given(keys(26_910, &[]), northwest, "EPSG:2927"), &["metres", "feet"]),
        ("given in metres, file in feet", given(keys(2263, &[]), place_in(2263), "EPSG:32618"), &["metres", "feet"]),
        (
            "given in a plane, file in degrees",
            given(text_record(&wkt("EPSG:4326")), [4.37, 52.0, 3.0], "EPSG:28992"),
            &["28992", "4326"],
        ),
        ("given in degrees, file in a plane", given(keys(28_992, &[]), delft, "EPSG:4326"), &["28992", "4326"]),
        (
            "heights given in metres, of the file in feet",
            given(keys(26_910, &[[4096, 6360]]), northwest, "EPSG:26910+5703"),
            &["heights", "feet", "metres"],
        ),
        ("given text, keys of another country", given(keys(2154, &[]), paris, &wkt("EPSG:28992")), &["2154"]),
        (
            "given string of PROJ, keys of another zone",
            given(keys(26_911, &[]), northwest, "+proj=utm +zone=10 +datum=WGS84"),
            &["26911"],
        ),
        (
            "given outside of its area, file without a system",
            said_of_text(None, delft, Some("EPSG:2056")),
            &["2056", "area of use"],
        ),
        ("given in a country far away, file without a system", said_of_text(None, delft, Some("EPSG:2154")), &["2154"]),
        (
            "given in the other half of the world, file without a system",
            said_of_text(None, delft, Some("EPSG:2193")),
            &["2193"],
        ),
        ("two files of two countries", two_files, &["28992", "2154"]),
    ]
}

fn pairs_with_other_files() -> Vec<Pair> {
    let rd = Crs::parse("EPSG:28992").unwrap();
    let delft = [85_000.0, 447_000.0];
    let link = r#"{"type": "link", "properties": {"href": "http://example.com/a.prj"}}"#;
    let by_code = r#"{"type": "EPSG", "properties": {"code": 25832}}"#;
    vec![
        (
            "shapes in another plane",
            said_of_geojson(&named("urn:ogc:def:crs:EPSG::25832"), delft, &rd),
            &["25832", "28992"],
        ),
        ("shapes in another plane by code", said_of_geojson(by_code, delft, &rd), &["25832", "28992"]),
        (
            "shapes in another plane by address",
            said_of_geojson(&named("http://www.opengis.net/def/crs/EPSG/0/2154"), delft, &rd),
            &["2154", "28992"],
        ),
        (
            "shapes in degrees by name, metres by number",
            said_of_geojson(&named("urn:ogc:def:crs:OGC:1.3:CRS84"), delft, &rd),
            &["85000", "no longitude"],
        ),
        ("shapes in an unknown system", said_of_geojson(&named("EPSG:99999"), delft, &rd), &["99999"]),
        ("shapes in a system behind a link", said_of_geojson(link, delft, &rd), &["link"]),
        (
            "shapes in degrees, cloud without a system",
            said_of_geojson(&named("EPSG:4258"), [4.37, 52.0], &Crs::default()),
            &["4258"],
        ),
        (
            "shapes of a datum whose step is not known",
            said_of_geojson(&named("EPSG:4610"), [4.37, 52.0], &rd),
            &["4610"],
        ),
        (
            "city model in another zone",
            said_of_cityjson("urn:ogc:def:crs:EPSG::25832", "EPSG:28992"),
            &["25832", "28992"],
        ),
        (
            "city model in degrees",
            said_of_cityjson("https://www.opengis.net/def/crs/EPSG/0/4979", "EPSG:28992"),
            &["degrees", "28992"],
        ),
        (
            "city model in an unknown system",
            said_of_cityjson("urn:ogc:def:crs:EPSG::99999", "EPSG:28992"),
            &["99999", "28992"],
        ),
        ("city model in feet", said_of_cityjson("urn:ogc:def:crs:EPSG::2263", "EPSG:32618"), &["2263", "32618"]),
        ("terrain in another zone", said_of_terrain("EPSG:25832", "EPSG:28992"), &["25832", "28992"]),
        ("terrain in degrees of another datum", said_of_terrain("EPSG:4289", "EPSG:28992"), &["4289", "28992"]),
    ]
}

fn pairs_with_a_location() -> Vec<Pair> {
    let delft = place_in(28_992);
    let at = |location| said_of_location("EPSG:28992", delft, Some(location));
    vec![
        ("location swapped", at([4.37, 52.0]), &["swapped", "km"]),
        ("location in another country", at([48.85, 2.35]), &["km from where"]),
        ("location in the south", at([-52.0, 4.37]), &["km from where"]),
        ("location in the west", at([52.0, -4.37]), &["km from where"]),
        ("location in a town 55 km away", at([52.37, 4.9]), &["location-far-away"]),
        (
            "location six degrees beside the zone",
            said_of_location("EPSG:32631", [500_000.0, 5_800_000.0, 0.0], Some([52.3, 9.0])),
            &["km from where"],
        ),
        (
            "location of a scene that says nothing of north",
            said_of_location("LOCAL_CS[\"site\",UNIT[\"metre\",1]]", delft, Some([52.0, 4.37])),
            &["true-north-unknown"],
        ),
        (
            "coordinates far outside of their system",
            said_of_location("EPSG:28992", [0.0, 3_000_000.0, 0.0], None),
            &["28992"],
        ),
        (
            "coordinates far outside, and a location",
            said_of_location("EPSG:28992", [0.0, 3_000_000.0, 0.0], Some([52.0, 4.37])),
            &["outside-area-of-use"],
        ),
        (
            "coordinates beside the zone",
            said_of_location("EPSG:25831", [750_000.0, 5_800_000.0, 0.0], None),
            &["outside-area-of-use"],
        ),
    ]
}

#[test]
fn something_is_said_of_every_contradiction() {
    let pairs = [pairs_within_a_file(), pairs_with_a_given_system(), pairs_with_other_files(), pairs_with_a_location()]
        .concat();
    let mut missing = Vec::new();
    for (name, said, words) in &pairs {
        match said {
            None => missing.push(format!("{name}: silent")),
            Some(said) => {
                let lacks = words.iter().filter(|word| !said.contains(**word));
                missing.extend(lacks.map(|word| format!("{name}: {word:?} is not in {said:?}")));
            }
        }
    }
    assert!(missing.is_empty(), "{}", missing.join("\n"));
    assert!(pairs.len() >= 40, "{}", pairs.len());
}

#[test]
fn nothing_is_said_of_what_agrees() {
    let (delft, northwest) = (place_in(28_992), place_in(26_910));
    let rd = Crs::parse("EPSG:28992").unwrap();
    let alike: Vec<(&str, Option<String>)> = vec![
        ("text and keys", said_of_las(&[text_record(&wkt("EPSG:28992")), keys(28_992, &[])], delft, None)),
        (
            "text of WGS 84, keys of ETRS89",
            said_of_las(&[text_record(&wkt("EPSG:32632")), keys(25_832, &[])], place_in(25_832), None),
        ),
        (
            "text, and keys that describe nothing",
            said_of_las(&[text_record(&wkt("EPSG:2263")), keys(32_767, &[])], place_in(2263), None),
        ),
        ("given and text", said_of_las(&[text_record(&wkt("EPSG:28992"))], delft, Some("EPSG:28992"))),
        ("given with heights, file without", said_of_las(&[keys(28_992, &[])], delft, Some("EPSG:7415"))),
        ("given of a file without a system", said_of_text(None, delft, Some("EPSG:28992"))),
        ("file and .prj", said_of_las_beside(keys(28_992, &[]), &wkt("EPSG:28992"), delft)),
        (
            "given for a local grid",
            said_of_las(&[text_record("LOCAL_CS[\"site\",UNIT[\"metre\",1]]")], northwest, Some("EPSG:26910")),
        ),
        ("shapes of WGS 84", said_of_geojson(&named("urn:ogc:def:crs:OGC:1.3:CRS84"), [4.37, 52.0], &rd)),
        ("city model with heights", said_of_cityjson("urn:ogc:def:crs:EPSG::7415", "EPSG:28992")),
        ("location", said_of_location("EPSG:28992", delft, Some([52.0, 4.37]))),
    ];
    let loud: Vec<String> =
        alike.iter().filter_map(|(name, said)| said.as_ref().map(|said| format!("{name}: {said}"))).collect();
    assert!(loud.is_empty(), "{}", loud.join("\n"));
}

fn read_las(records: &[LasRecord], wkt_decides: bool, place: [f64; 3], options: &ReadOptions) -> Result<PointCloud> {
    let bytes = las(records, wkt_decides, place);
    read_cloud([Source::bytes("tile.las", &bytes)], options, &Control::none()).map(|(cloud, _)| cloud)
}

#[test]
fn of_two_records_the_header_says_which_one_holds() {
    let place = place_in(26_910);
    let records = [text_record(&wkt("EPSG:26910")), keys(26_911, &[])];
    for (wkt_decides, code) in [(true, 26_910), (false, 26_911)] {
        let cloud = read_las(&records, wkt_decides, place, &ReadOptions::new()).unwrap();
        assert_eq!(cloud.frame.crs.epsg, Some(code));
        assert!(cloud.frame.crs.doubt.is_some());
    }
}

#[test]
fn heights_of_the_keys_hold_where_the_text_names_none() {
    let place = place_in(26_910);
    let feet = [4099, 9003];
    for (text, more) in [("EPSG:26910", vec![[4096, 6360], feet]), ("EPSG:26910", vec![feet])] {
        let records = [text_record(&wkt(text)), keys(26_910, &more)];
        let given = ReadOptions::new().with_crs("EPSG:26910");
        for options in [ReadOptions::new(), given] {
            let cloud = read_las(&records, true, place, &options).unwrap();
            let crs = &cloud.frame.crs;
            assert!(
                (crs.vertical_metres_per_unit - US_SURVEY_FOOT).abs() < 1e-9 && crs.metres_per_unit == 1.0,
                "{crs:?}"
            );
            assert_eq!(crs.doubt, None);
            // and what is written says so too
            let again = match text::wkt_line(crs) {
                Some(line) => Crs::parse(&line).unwrap(),
                None => panic!("{crs:?}"),
            };
            assert!((again.vertical_metres_per_unit - US_SURVEY_FOOT).abs() < 1e-9, "{again:?}");
        }
    }
}

#[test]
fn an_override_insists() {
    let place = place_in(2154);
    let records = [keys(2154, &[])];
    let given = ReadOptions::new().with_crs("EPSG:28992");
    assert!(read_las(&records, true, place, &given).is_err());
    let cloud = read_las(&records, true, place, &given.insisting_on_crs()).unwrap();
    assert_eq!(cloud.frame.crs.epsg, Some(28_992));
    let error = read_las(&records, true, place, &ReadOptions::new().insisting_on_crs()).unwrap_err().to_string();
    assert!(error.contains("crs_override"), "{error}");
}

/// Name of the system, longitude and latitude, system of the cloud, and the place there.
type ShapeOfDatum = (&'static str, [f64; 2], &'static str, [f64; 2]);

const SHAPES_OF_DATUMS: [ShapeOfDatum; 5] = [
    ("urn:ogc:def:crs:EPSG::4230", [4.37, 52.01], "EPSG:32631", [593_940.2, 5_762_946.3]),
    ("EPSG:4314", [9.18, 48.78], "EPSG:32632", [513_146.3, 5_402_903.4]),
    ("urn:ogc:def:crs:OGC:1.3:CRS27", [-100.0, 40.0], "EPSG:32614", [414_604.1, 4_428_236.1]),
    ("http://www.opengis.net/def/crs/EPSG/0/4301", [139.7, 35.7], "EPSG:32654", [382_101.3, 3_951_816.3]),
    ("EPSG:4277", [-1.5, 52.5], "EPSG:32630", [601_719.7, 5_817_749.0]),
];

#[test]
fn shapes_of_another_datum_are_brought_to_the_cloud() {
    // values of pyproj 3.7 (PROJ 9.5)
    for (name, at, code, place) in SHAPES_OF_DATUMS {
        let text = geojson(&named(name), at);
        let crs = Crs::parse(code).unwrap();
        let found = read_features(Source::bytes("places.geojson", text.as_bytes()), &crs).unwrap();
        let belvedere::io::FeatureShape::Point([x, y, _]) = found[0].shape else { panic!("{found:?}") };
        let error = (x - place[0]).hypot(y - place[1]);
        // steps between datums that need no grid differ by a few metres
        assert!(error < 20.0, "{name}: {x} {y} is {error} m off");
    }
}
