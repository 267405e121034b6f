//! Lines of sight and viewsheds around a house, worked out by hand, in every kind of file.
#![expect(clippy::cast_possible_truncation, reason = "cells of a small grid")]

use crate::common::{EAST, NORTH, ROUGHNESS, Workplace, at, cells, is_hidden, numbers};

/// The house's flags: its normals are given and no pulses are known.
const HOUSE: &str = "house.laz --scene-config ../tau.json --orient given --ground found";

fn words(words: &[&str]) -> Vec<String> {
    words.iter().map(|&word| word.to_owned()).collect()
}

#[test]
fn pairs_around_a_house_are_blocked_where_its_walls_stand() {
    let place = Workplace::with_house();
    let pairs = [
        (at(-12.0, 0.0, 2.0), at(12.0, 0.0, 2.0)),   // through both gables
        (at(12.0, 0.0, 2.0), at(-12.0, 0.0, 2.0)),   // and back
        (at(-12.0, 7.0, 2.0), at(12.0, 7.0, 2.0)),   // past its north side
        (at(-12.0, 0.0, 12.0), at(12.0, 0.0, 12.0)), // over its ridge
        (at(0.0, 10.0, 2.0), at(0.0, 10.0, 2.0)),    // no line
    ];
    let rows: Vec<String> =
        pairs.iter().map(|(a, b)| a.iter().chain(b).map(f64::to_string).collect::<Vec<_>>().join(",")).collect();
    place.write("pairs.csv", format!("ax,ay,az,bx,by,bz\n{}\n", rows.join("\n")));
    let line = "line-of-sight house.laz --scene-config ../tau.json --orient given --pairs pairs.csv -o out.csv";
    let summary = place.summary(&format!("{line} --frequency-ghz 5.8"));
    assert_eq!(summary["lines_of_sight"]["blocked"], 2);
    let text = place.text("out.csv");
    assert_eq!(cells(&text, "answer"), ["0", "0", "1", "1", "3"]);
    // a blocked link has no free zone; past the house 1.9 m are free, of a zone that is 0.6 m wide
    assert_eq!(cells(&text, "fresnel_free_percent")[..4], ["0.0", "0.0", "100.0", "100.0"]);
    // the wall is 7 m off, seen from either side; balls may bulge by what points half a metre apart allow
    let ranges = numbers(&text, "first_block_range_m");
    assert!((ranges[0] - 7.0).abs() < 0.3 && (ranges[1] - 7.0).abs() < 0.3, "{ranges:?}");
    assert!((numbers(&text, "block_x")[0] - (EAST - 5.0)).abs() < 0.3);
    assert!(ranges[2].is_nan() && cells(&text, "block_ball")[2].is_empty());
}

#[test]
fn lines_without_heights_run_from_the_eye_of_a_person_to_the_ground() {
    let place = Workplace::with_house();
    // through the house, and past its north side; once as lines, and once as a table with the heights that follow from
    // the ground
    let lines = [[[-12.0, 0.0], [12.0, 0.0]], [[-12.0, 7.0], [12.0, 7.0]]];
    let corner = |[x, y]: [f64; 2]| format!("[{}, {}]", EAST + x, NORTH + y);
    let feature = |&[a, b]: &[[f64; 2]; 2]| {
        let middle = corner([(a[0] + b[0]) / 2.0, 9.0]);
        let corners = [corner(a), middle, corner(b)].join(",");
        format!(
            r#"{{"type":"Feature","properties":null,"geometry":{{"type":"LineString","coordinates":[{corners}]}}}}"#
        )
    };
    let features: Vec<String> = lines.iter().map(feature).collect();
    place.write("lines.geojson", format!(r#"{{"type":"FeatureCollection","features":[{}]}}"#, features.join(",")));
    let summary =
        place.summary(&format!("line-of-sight {HOUSE} --pairs lines.geojson --target-height 0.5 -o lines.csv"));
    assert_eq!(summary["lines_of_sight"]["blocked"], 1);
    let text = place.text("lines.csv");
    assert_eq!(cells(&text, "answer"), ["0", "1"]);
    // the corner in the middle is no end; the ground lies at 0, as rough as its points
    for (name, expected) in [("az", 1.7), ("bz", 0.5)] {
        assert!(numbers(&text, name).iter().all(|z| (z - expected).abs() <= f64::from(ROUGHNESS)), "{text}");
    }
    let rows = lines.iter().map(|[a, b]| {
        let [ax, ay, bx, by] = [EAST + a[0], NORTH + a[1], EAST + b[0], NORTH + b[1]];
        format!("{ax},{ay},{bx},{by}\n")
    });
    place.write("pairs.csv", format!("ax,ay,bx,by\n{}", rows.collect::<String>()));
    place.summary(&format!("line-of-sight {HOUSE} --pairs pairs.csv --target-height 0.5 -o pairs-out.csv"));
    let table = place.text("pairs-out.csv");
    for name in ["ax", "ay", "az", "bx", "by", "bz", "answer", "block_ball"] {
        let (of_lines, of_table) = (numbers(&text, name), numbers(&table, name));
        assert!(of_lines.iter().zip(&of_table).all(|(a, b)| a == b || a.is_nan() && b.is_nan()), "{name}: {table}");
    }
    // the same line typed, with its profile
    let typed = format!("--observer {},{} --target {},{}", EAST - 12.0, NORTH, EAST + 12.0, NORTH);
    let one = place.summary(&format!("line-of-sight {HOUSE} {typed} --target-height 0.5 --profile-out profile.csv"));
    assert_eq!(one["line"]["answer"], "blocked");
    let point = r#"{"type":"Point","coordinates":[84990, 446000]}"#;
    place.write("point.geojson", point);
    place.refusal(
        1,
        &format!("line-of-sight {HOUSE} --pairs point.geojson -o x.csv"),
        &["point.geojson", "not a line"],
    );
}

#[test]
fn a_profile_shows_the_house_between() {
    let place = Workplace::with_house();
    let line = format!("--observer {},{},2 --target {},{},2", EAST - 12.0, NORTH, EAST + 12.0, NORTH);
    place.summary(&format!("line-of-sight {HOUSE} {line} --profile-out profile.csv --distance-step-m 0.5"));
    let text = place.text("profile.csv");
    let (distances, blocked, ground) =
        (numbers(&text, "distance_m"), numbers(&text, "blocked"), numbers(&text, "ground"));
    assert_eq!(distances.len(), 49);
    for ((distance, blocked), ground) in distances.iter().zip(blocked).zip(ground) {
        // in the walls, which stand at 7 m and 17 m and get balls of half a metre, and well outside
        if (7.4..7.6).contains(distance) || (16.4..16.6).contains(distance) {
            assert_eq!(blocked, 1.0, "{distance}");
        }
        if !(6.5..17.5).contains(distance) {
            assert_eq!(blocked, 0.0, "{distance}");
        }
        // the finder takes what lies within 0.3 m of the ground for ground, such as the feet of walls
        assert!(ground.abs() <= f64::from(ROUGHNESS) + 0.3, "{ground}");
    }
    place.summary(&format!("line-of-sight {HOUSE} {line} --profile-out profile.png"));
    assert!(place.bytes("profile.png").starts_with(b"\x89PNG"));
}

#[test]
fn a_viewshed_hides_what_lies_behind_the_house() {
    let place = Workplace::with_house();
    let observer = format!("--observer {},{}", EAST - 12.0, NORTH);
    let outputs = "-o seen.tif -o seen.png -o seen.geojson -o seen.csv --heights heights.npy --masks masks.npy";
    let summary = place.summary(&format!("viewshed {HOUSE} {observer} --cell 1 {outputs}"));
    assert_eq!(summary["observers"]["count"], 1);
    let file = std::fs::File::open(place.path("seen.tif")).unwrap();
    let mut tiff = tiff::decoder::Decoder::new(file).unwrap();
    let (width, height) = tiff.dimensions().unwrap();
    let tiff::decoder::DecodingResult::U8(cells) = tiff.read_image().unwrap() else { panic!("no bytes") };
    let scale = tiff.get_tag_f64_vec(tiff::tags::Tag::ModelPixelScaleTag).unwrap();
    let tie = tiff.get_tag_f64_vec(tiff::tags::Tag::ModelTiepointTag).unwrap();
    assert_eq!(&scale[..2], [1.0, 1.0]);
    let index = |[x, y, _]: [f64; 3]| {
        let (column, row) = ((x - tie[3]).floor(), (tie[4] - y).floor());
        row as usize * width as usize + column as usize
    };
    assert_eq!(cells.len(), (width * height) as usize);
    let cell = |x: f64, y: f64| cells[index(at(x, y, 0.0))];
    // before the house, behind it, below its roof, where no place is, and beside it
    assert_eq!((cell(-8.5, 0.5), cell(8.5, 0.5), cell(0.5, 0.5), cell(-6.5, 10.5)), (1, 0, 255, 1));
    let (shape, heights) = place.npy::<f32>("heights.npy");
    assert_eq!(shape, [u64::from(height), u64::from(width)]);
    // the eye at 1.7 m looks over the west end of the ridge, 7 m off and 8.9 m high where the line passes: 20.5 m off a
    // thing must reach 1.7 + 20.5 · 7.2/7 = 22.8 m; balls lie inside the roof by what points half a metre apart leave
    let behind = heights[index(at(8.5, 0.5, 0.0))];
    assert!((21.8..23.1).contains(&behind), "{behind}");
    assert_eq!(heights[index(at(-8.5, 0.5, 0.0))], 0.0);
    let (shape, masks) = place.npy::<u32>("masks.npy");
    assert_eq!(shape, [1, u64::from(height), u64::from(width)]);
    assert!(masks.iter().zip(&cells).all(|(bits, cell)| (*bits == 1) == (*cell == 1)));
    assert!(place.text("seen.geojson").contains("MultiPolygon"));
    assert!(numbers(&place.text("seen.csv"), "answer").contains(&0.0));
}

#[test]
fn a_target_is_seen_from_where_an_observer_there_would_see_the_eyes() {
    let place = Workplace::with_house();
    let target = format!("--target {},{} --target-height 2 --observer-height 1.7", EAST + 12.0, NORTH);
    place.summary(&format!("viewshed {HOUSE} {target} --cell 1 -o reverse.csv -o reverse.tif"));
    let observer = format!("--observer {},{} --observer-height 2 --target-height 1.7", EAST + 12.0, NORTH);
    place.summary(&format!("viewshed {HOUSE} {observer} --cell 1 -o forward.tif"));
    assert!(place.pixels("reverse.tif") == place.pixels("forward.tif"));
}

#[test]
fn observers_come_from_tables_and_geojson_and_paths_have_a_step() {
    let place = Workplace::with_house();
    place.write(
        "observers.csv",
        format!("x,y,z,height,max_distance,name\n{0},{1},,1.7,5,a\n{0},{2},3,,,b\n", EAST - 12.0, NORTH, NORTH + 10.0),
    );
    let summary = place.summary(&format!("viewshed {HOUSE} --observers observers.csv --cell 1 -o count.tif"));
    assert_eq!(summary["observers"]["count"], 2);
    let walk = format!("viewshed {HOUSE} --observers observers.csv --distance-step-m 2 --cell 2 -o count.tif");
    assert_eq!(place.summary(&walk)["observers"]["count"], 6, "10 m in steps of 2 m, and the end is one of them");
    // the older member `crs` and its plane coordinates
    let line = format!(
        r#"{{"type":"FeatureCollection","crs":{{"type":"name","properties":{{"name":"urn:ogc:def:crs:EPSG::28992"}}}},
        "features":[{{"type":"Feature","properties":{{"height":2}},"geometry":{{"type":"LineString","coordinates":[[{0},{1}],[{0},{2}]]}}}}]}}"#,
        EAST - 12.0,
        NORTH - 10.0,
        NORTH + 10.0
    );
    place.write("walk.geojson", line);
    let summary = place.summary(&format!("viewshed {HOUSE} --observers walk.geojson --cell 2 -o count.tif"));
    assert_eq!(summary["observers"]["count"], 5);
}

#[test]
fn what_cannot_be_is_refused_with_advice() {
    let place = Workplace::with_house();
    let observer = format!("--observer {EAST},{NORTH}");
    place.refusal(
        1,
        &format!("viewshed {HOUSE} --observer 0,0 -o seen.tif"),
        &["observer 1", "coordinates of the cloud"],
    );
    place.refusal(2, &format!("viewshed {HOUSE} {observer} -o seen.doc"), &["extension"]);
    let far = format!("--observer {EAST},{}", NORTH + 9.0);
    place.refusal(2, &format!("viewshed {HOUSE} {far} {observer} {far} -o seen.tif"), &[&far, "given twice"]);
    for (given, words) in [
        ("abc,447527", "\"abc\" is not a number\n"),
        ("NaN,447527", "NaN is not finite\n"),
        ("1", "2 or 3 numbers"),
        ("1,2,3,4", "2 or 3 numbers"),
    ] {
        place.refusal(2, &format!("viewshed {HOUSE} --observer {given} -o seen.tif"), &["--observer", words]);
    }
    place.refusal(2, &format!("viewshed {HOUSE} {observer} -o seen.tif -o seen.tif"), &["two results"]);
    place.refusal(2, &format!("viewshed {HOUSE} {observer} --cell 1e-9 -o seen.tif"), &["--cell", "100 million"]);
    place.refusal(2, &format!("viewshed {HOUSE} {observer} --refraction 2 -o seen.tif"), &["refraction"]);
    place.refusal(2, &format!("viewshed {HOUSE} {observer} --unproven report -o seen.tif"), &["--unproven", "pulses"]);
    place.refusal(
        2,
        &format!("viewshed {HOUSE} {observer} --min-distance 9 --max-distance 5 -o seen.tif"),
        &["distance"],
    );
    place.refusal(
        2,
        &format!("viewshed {HOUSE} --target {EAST},{NORTH} --azimuth-range 0,90 -o seen.tif"),
        &["--azimuth-range"],
    );
    place.refusal(
        1,
        "viewshed house.laz --scene-config ../tau.json --ground classed --observer 85000,446000 -o a.tif",
        &["class 2"],
    );
    place.write("pairs.csv", "ax,ay,az,bx\n1,2,3,4\n");
    place.refusal(
        1,
        "line-of-sight house.laz --scene-config ../tau.json --pairs pairs.csv -o out.csv",
        &["by", "ax, ay"],
    );
    place.write("low.csv", format!("x,y,height\n{EAST},{NORTH},-0.5\n"));
    place.refusal(
        1,
        "viewshed house.laz --scene-config ../tau.json --observers low.csv -o low.tif",
        &["low.csv", "height -0.5"],
    );
    place.write("pairs.csv", "ax,ay,az,bx,by,bz\n1,2,3,4,5,six\n");
    place.refusal(
        1,
        "line-of-sight house.laz --scene-config ../tau.json --pairs pairs.csv -o out.csv",
        &["row 1", "six", "bz"],
    );
    place.write("pairs.csv", "ax,ay,az,bx,by,bz\n1,2,3,4,5\n");
    place.refusal(1, "line-of-sight house.laz --scene-config ../tau.json --pairs pairs.csv -o out.csv", &["5 cells"]);
    place.write("walk.geojson", "{\"type\":\"Feature\",\"geometry\":{\"type\":\"Blob\"}}");
    place.refusal(1, &format!("viewshed {HOUSE} --observers walk.geojson -o seen.tif"), &["Blob"]);
    place.refusal(1, &format!("viewshed {HOUSE} {observer},-0.7 --cell 2 -o seen.tif"), &["below the ground"]);
    place.refusal(
        1,
        &format!("viewshed {HOUSE} {observer},-50 --cell 2 -o seen.tif"),
        &["its height is below the cloud"],
    );
    place.write("none.csv", "x,y\n");
    place.refusal(
        1,
        &format!("viewshed {HOUSE} --observers none.csv --cell 2 -o seen.tif"),
        &["none.csv", "give a row"],
    );
}

#[test]
fn places_around_a_house_are_a_network_whatever_their_order() {
    let place = Workplace::with_house();
    // west and east of the house, north of it, and north-west
    let places = [("west", -12.0, 0.0), ("east", 12.0, 0.0), ("north", 0.0, 10.0), ("north-west", -12.0, 7.0)];
    let row = |(name, x, y): &(&str, f64, f64)| format!("\"{name}\",{},{},2\n", EAST + x, NORTH + y);
    let header = "id,x,y,z\n".to_owned();
    place.write("places.csv", header.clone() + &places.iter().map(row).collect::<String>());
    place.write("turned.csv", header + &places.iter().rev().map(row).collect::<String>());
    let outputs = "-o net.csv -o net.geojson -o net.graphml";
    let summary = place.summary(&format!("line-of-sight {HOUSE} --among places.csv {outputs}"));
    // the house stands between west and east, and between east and north-west
    let network = &summary["network"];
    assert_eq!((&network["places"], &network["links"], &network["groups"]), (&4.into(), &4.into(), &1.into()));
    let text = place.text("net.csv");
    assert_eq!(cells(&text, "answer").iter().filter(|answer| *answer == "0").count(), 2, "{text}");
    assert!(text.lines().any(|line| line.starts_with("west,east,") && line.contains(",24.000,0,")), "{text}");
    let lines: serde_json::Value = serde_json::from_str(&place.text("net.geojson")).unwrap();
    let lines = lines["features"].as_array().unwrap();
    assert_eq!(lines.len(), 6);
    let of = |a: &str, b: &str| lines.iter().find(|l| l["properties"]["a"] == a && l["properties"]["b"] == b).unwrap();
    assert_eq!(of("west", "north-west")["properties"]["answer"], 1);
    assert_eq!(of("west", "north-west")["properties"]["length_m"], 7.0);
    let graph = place.text("net.graphml");
    assert_eq!((graph.matches("<node ").count(), graph.matches("<edge ").count()), (4, 4), "{graph}");

    let turned = place.summary(&format!("line-of-sight {HOUSE} --among turned.csv -o net.csv"));
    assert_eq!(turned["network"]["links"], 4);
    // 13 m reach from north-west to west and to north alone
    let near = place.summary(&format!("line-of-sight {HOUSE} --among places.csv --max-distance 13 -o near.csv"));
    let near = &near["network"];
    assert_eq!((&near["links"], &near["groups"], &near["largest_group"]), (&2.into(), &2.into(), &3.into()));
    assert_eq!((&near["places_without_link"], &near["max_links"][0]), (&1.into(), &"north-west".into()));
}

#[test]
fn networks_name_what_cannot_see_and_refuse_what_is_no_network() {
    let place = Workplace::with_house();
    let [outside, inside] = [EAST - 12.0, EAST - 4.6];
    let north = NORTH + 0.25;
    place.write("places.csv", format!("x,y,z\n{outside},{north},2.25\n{inside},{north},2.25\n"));
    let run = place.run(&format!("line-of-sight {HOUSE} --among places.csv -o net.csv"));
    assert_eq!(run.status, 0, "{run:?}");
    assert!(run.stderr.contains("1 of 2 places (50 %) are inside an obstacle, and see no other: 2"), "{run:?}");
    place.write("one.csv", format!("x,y,z\n{EAST},{NORTH},2\n"));
    place.refusal(2, &format!("line-of-sight {HOUSE} --among one.csv -o net.csv"), &["two places or more"]);
    let pairs = format!("line-of-sight {HOUSE} --observer {EAST},{NORTH},20 --target {EAST},{NORTH},30 -o net.graphml");
    let apart = format!("line-of-sight {HOUSE} --among places.csv --max-distance 2 -o net.csv");
    place.refusal(2, &apart, &["--max-distance", "no pair is nearer"]);
    // a row from south to north, with an id where there is no name
    let rows: String = (0..4).map(|i| format!(",{},{outside},{},9\n", 7 + i, NORTH + 4.0 * f64::from(i))).collect();
    place.write("row.csv", format!("name,id,x,y,z\n{rows}"));
    place.summary(&format!("line-of-sight {HOUSE} --among row.csv --max-distance 5 -o net.csv"));
    let text = place.text("net.csv");
    assert_eq!((cells(&text, "a"), cells(&text, "b")), (words(&["7", "8", "9"]), words(&["8", "9", "10"])), "{text}");
    place.refusal(2, &pairs, &["--among"]);
    place.refusal(2, &pairs.replace("graphml", "csv --max-distance 9"), &["--max-distance", "--among"]);
}

#[test]
fn observers_of_a_total_viewshed_fill_the_map_and_stand_in_no_house() {
    let place = Workplace::with_house();
    let spread = |count: usize, output: &str| {
        place.summary(&format!("viewshed {HOUSE} --spread {count} --target-height 1.7 --cell 2 -o {output}"))
    };
    let summary = spread(200, "total.tif");
    assert_eq!(
        (&summary["observers"]["count"], &summary["observers"]["skipped"]),
        (&200.into(), &0.into()),
        "{summary}"
    );
    // the same share of pairs of places on a fine grid has a free line of sight past the house
    let places: Vec<[f64; 3]> = (0..29 * 29)
        .map(|i| [f64::from(i % 29 - 14), f64::from(i / 29 - 14), 1.7])
        .filter(|[x, y, _]| x.abs() > 5.0 || y.abs() > 4.0)
        .collect();
    let is_free = |a: [f64; 3], b: [f64; 3]| {
        let ahead = [0, 1, 2].map(|i| b[i] - a[i]);
        !is_hidden(a, ahead) || !is_hidden(b, ahead.map(|v| -v))
    };
    let free = places.iter().flat_map(|&a| places.iter().map(move |&b| (a, b))).filter(|&(a, b)| is_free(a, b)).count();
    let expected = free as f64 / (places.len() * places.len()) as f64;
    let raster = belvedere::io::read_tif(place.path("total.tif").as_path()).unwrap();
    // nobody sees cells whose middles are below the edge of the roof
    let counts: Vec<f32> = raster.values.values().iter().copied().filter(|count| *count > 0.0).collect();
    let found = f64::from(counts.iter().sum::<f32>()) / counts.len() as f64 / 200.0;
    // two hundred places and cells of 2 m miss it by a hundredth or two
    assert!((found - expected).abs() < 0.03, "{found} {expected}");
    place.refusal(2, &format!("viewshed {HOUSE} --spread 0 -o total.tif"), &["--spread", "1 to 65534"]);
    place.refusal(2, &format!("viewshed {HOUSE} --spread 9 --distance-step-m 2 -o total.tif"), &["--observers"]);
    // a corridor that is 1 % of its box
    let corridor =
        |i: i32| format!("{},{},0\n", EAST + f64::from(i) * 0.5, NORTH + f64::from(i) * 0.5 + f64::from(i % 3));
    place.write("corridor.xyz", (0..1200).map(corridor).collect::<String>());
    place.summary("viewshed corridor.xyz --crs EPSG:28992 --ground found --spread 5 --cell 2 -o total.tif");
}
