//! Shadows on the command line, around a house whose shadow is known.

use crate::common::{EAST, NORTH, Workplace, at, column, house, house_in_a_field, is_hidden, remarks};
use belvedere::crs::Crs;

const HOUSE: &str = "house.laz --orient given --scene-config ../tau.json --ground found";

/// A mesh of a block with these corners on the map, relative to the middle of the house.
fn block(low: [f64; 2], high: [f64; 2], height: f64) -> String {
    let corner = |i: usize| at([low[0], high[0]][i & 1], [low[1], high[1]][i >> 1 & 1], [0.0, height][i >> 2]);
    let corners: String = (0..8).map(corner).map(|[x, y, z]| format!("v {x} {y} {z}\n")).collect();
    corners + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n"
}

fn to_sun(azimuth_deg: f64, elevation_deg: f64) -> [f64; 3] {
    let ((sin, cos), (up, along)) = (azimuth_deg.to_radians().sin_cos(), elevation_deg.to_radians().sin_cos());
    [along * sin, along * cos, up]
}

#[test]
fn the_shadow_of_a_house_is_the_exact_one() {
    let place = Workplace::with_house();
    for (azimuth, elevation) in [(180.0, 45.0), (110.0, 30.0), (300.0, 55.0)] {
        let run = place.summary(&format!(
            "shadow {HOUSE} --sun {azimuth},{elevation} --cell 0.5 -o lit.csv -o lit.tif -o lit.png"
        ));
        assert_eq!(run["sun"]["suns"], 1);
        let [x, y, z, lit] = ["x", "y", "z", "lit"].map(|name| column(&place, "lit.csv", name));
        let sun = to_sun(azimuth, elevation);
        let (mut shaded, mut queried) = (0, 0);
        for i in 0..lit.len() {
            let spot = [x[i] - EAST, y[i] - NORTH, z[i]];
            if spot[0].abs() < 5.8 && spot[1].abs() < 4.8 {
                continue;
            }
            // balls end up to half a metre beside edges where points stand half a metre apart: the outline itself is
            // not tested
            let hidden = |east: f64, north: f64| is_hidden([spot[0] + east, spot[1] + north, spot[2]], sun);
            let expected = hidden(0.0, 0.0);
            if [(-0.7, 0.0), (0.7, 0.0), (0.0, -0.7), (0.0, 0.7)].iter().any(|&(e, n)| hidden(e, n) != expected) {
                continue;
            }
            assert_eq!(lit[i], if expected { 0.0 } else { 1.0 }, "sun {azimuth},{elevation} at {spot:?}");
            shaded += usize::from(expected);
            queried += 1;
        }
        assert!(shaded > 30 && queried > 2000, "{shaded} of {queried}");
        assert!(place.bytes("lit.png").starts_with(b"\x89PNG") && place.path("lit.tif").is_file());
    }
}

#[test]
fn a_house_and_a_plan_cast_shadows_of_their_own() {
    let place = Workplace::new();
    let mut cloud = house();
    let class = |position: &[f32; 3]| if position[2] < 0.2 { 2 } else { 6 };
    cloud.attributes.classification = Some(cloud.positions.iter().map(class).collect());
    place.write_cloud("house.laz", &cloud);
    // east of the house; the sun in the east
    place.write("hall.obj", block([8.0, -3.0], [11.0, 3.0], 6.0));
    let sun = "--sun 90,45 --grid-north --cell 0.5 --casters";
    place.summary(&format!("shadow {HOUSE} {sun} --add hall.obj -o lit.csv -o lit.tif --outlines casters.geojson"));
    let [x, y, lit, caster] = ["x", "y", "lit", "caster"].map(|name| column(&place, "lit.csv", name));
    let mut tested = [0; 2];
    for row in 0..lit.len() {
        let [east, north] = [x[row] - EAST, y[row] - NORTH];
        assert_eq!(lit[row] < 0.5, caster[row] > 0.0, "{east} {north}");
        // half a metre from edges, as above; what the hall shades is before the wall of the house
        if (6.0..7.5).contains(&east) && north.abs() < 2.0 {
            assert_eq!(caster[row], 8.0, "{east} {north}");
            tested[0] += 1;
        }
        if (-8.5..-6.0).contains(&east) && north.abs() < 2.5 {
            assert_eq!(caster[row], 1.0, "{east} {north}");
            tested[1] += 1;
        }
    }
    assert!(tested.iter().all(|&count| count > 15), "{tested:?}");
    let areas: serde_json::Value = serde_json::from_str(&place.text("casters.geojson")).unwrap();
    let of = |caster: &str| {
        let is_of = |area: &&serde_json::Value| area["properties"]["caster"] == caster;
        areas["features"].as_array().unwrap().iter().find(is_of).unwrap()["properties"]["area_m2"].as_f64().unwrap()
    };
    let cells = |number: f64| caster.iter().filter(|caster| **caster == number).count() as f64 * 0.25;
    assert_eq!([of("hall.obj"), of("building")], [cells(8.0), cells(1.0)]);
    let [x, y, _] = at(7.0, 0.0, 0.0);
    let run = place.run(&format!("shadow {HOUSE} --sun 90,45 --grid-north --casters --add hall.obj --at {x},{y}"));
    assert!(run.stdout.contains("in shadow, shaded by: plan"), "{}", run.stdout);
    // no sun casts no shadow
    place.summary(&format!(
        "shadow {HOUSE} --time 2026-06-21T01:00+02:00 --location 52,5 --cell 2 --casters -o night.csv"
    ));
    assert!(column(&place, "night.csv", "caster").iter().all(|caster| caster.is_nan()));
    let run = place.run(&format!("shadow {HOUSE} --sun 90,45 --casters --targets hall.obj -o mesh.csv"));
    assert!(run.status == 2 && run.stderr.contains("--casters applies only to cells and points"), "{}", run.stderr);
}

#[test]
fn shadows_are_as_long_as_two_offices_say() {
    let place = Workplace::new();
    let mut cloud = house_in_a_field();
    cloud.frame.crs = Crs::default();
    place.write_cloud("field.laz", &cloud);
    let (foot, height) = ([-42.0, -42.0], 10.0);
    place.write("mast.obj", block(foot.map(|v| v - 0.25), foot.map(|v| v + 0.25), height));
    // San Rafael (California), "Preparing a Shadow Diagram": direction of the shadow, degrees from north, and its
    // length for each metre of height on 21 December. Tolerances are its rounding, and 0.3 m for cells and the mast.
    // The length of the afternoon is 2 % less than the sun says (3.37).
    let san_rafael = "--location 37.9735,-122.5311 --zone America/Los_Angeles";
    // Landkreis Ostallgäu, guide to local plans: at noon on 21 December the sun stands 18.8 degrees high
    let ostallgaeu = "--location 47.78,10.62 --zone Europe/Berlin";
    for (where_and_when, direction, length, tolerance) in [
        (format!("{san_rafael} --time 2026-12-21T12:00"), -2.0, 1.8, 0.05 + 0.03),
        (format!("{san_rafael} --time 2026-12-21T15:00"), 41.0, 3.3, 0.07 + 0.03),
        (format!("{ostallgaeu} --time 2026-12-21T12:15"), 0.0, 2.94, 0.01 + 0.03),
    ] {
        place.summary(&format!(
            "shadow field.laz --orient given --scene-config ../tau.json --ground found {where_and_when} --cell 0.25 \
             --add mast.obj --casters -o lit.csv"
        ));
        let [x, y, caster] = ["x", "y", "caster"].map(|name| column(&place, "lit.csv", name));
        let shaded = (0..caster.len()).filter(|&row| caster[row] == 8.0);
        let from_foot = shaded.map(|row| [x[row] - EAST - foot[0], y[row] - NORTH - foot[1]]);
        let end = from_foot.max_by(|a, b| a[0].hypot(a[1]).total_cmp(&b[0].hypot(b[1]))).unwrap();
        let (found, azimuth) = (end[0].hypot(end[1]) / height, end[0].atan2(end[1]).to_degrees());
        assert!((found - length).abs() <= tolerance, "{where_and_when}: {found} {length}");
        // half a degree of rounding, and half the width of the mast at its end
        let side = (0.35 / (found * height)).to_degrees();
        assert!((azimuth - direction).abs() <= 0.5 + side, "{where_and_when}: {azimuth} {direction}");
    }
}

#[test]
fn a_time_is_the_same_however_it_is_written_and_nothing_is_lit_at_night() {
    let place = Workplace::with_house();
    place.write_places("places.csv", &[[0.0, 8.0, 0.5], [0.0, -9.0, 0.5], [9.0, 0.0, 0.5], [-9.0, 0.0, 0.5]]);
    let lit = |flags: &str| {
        let run = place.summary(&format!("shadow {HOUSE} {flags} --targets places.csv -o lit.csv"));
        (column(&place, "lit.csv", "lit"), run)
    };
    let (first, run) = lit("--time 2026-12-21T12:00+01:00");
    // the noon sun of the shortest day stands 15 degrees high: north of the house is shade
    assert_eq!(first, [0.0, 1.0, 1.0, 1.0]);
    let sun = run["sun"].as_object().unwrap().values().find(|value| value.is_object()).unwrap();
    // pvlib 0.16.1 at 51.998 N, 4.366 E, 4.5 m up; 0.001 degrees of place
    assert!((sun["elevation_deg"].as_f64().unwrap() - 14.1057).abs() < 0.003, "{sun}");
    assert!((sun["azimuth_deg"].as_f64().unwrap() - 170.4106).abs() < 0.004, "{sun}");
    for flags in [
        "--time 2026-12-21T11:00Z",
        "--time 2026-12-21T12:00 --zone Europe/Amsterdam",
        "--time 2026-12-21T12:00[Europe/Amsterdam]",
        "--time 2026-12-21T12:00 --zone +01:00",
        // the clocks of the place
        "--time 2026-12-21T12:00",
        // mean solar time of 4.366 E is 17 minutes and 28 seconds ahead of UTC
        "--time 2026-12-21T11:17:28 --zone solar",
    ] {
        let (same, other) = lit(flags);
        let other = other["sun"].as_object().unwrap().values().find(|value| value.is_object()).unwrap().clone();
        assert_eq!((&same, &other), (&first, sun), "{flags}");
    }
    // in the morning the east is lit and the west is shade
    let (morning, _) = lit("--time 2026-06-21T07:30+02:00");
    assert_eq!(morning[2..], [1.0, 0.0]);
    let (night, run) = lit("--time 2026-06-21T01:00+02:00");
    assert_eq!(night, [0.0; 4]);
    assert_eq!(run["sun"]["suns_below_horizon"], 1);
    let (below, _) = lit("--sun 180,-5");
    assert_eq!(below, [0.0; 4]);
    // several times have a column each, in their order
    place.summary(&format!(
        "shadow {HOUSE} --time 2026-12-21T12:00+01:00 --time 2026-06-21T01:00+02:00 --targets places.csv -o two.csv"
    ));
    let header = place.text("two.csv").lines().next().unwrap().to_owned();
    let names: Vec<&str> = header.split(',').filter(|name| name.starts_with("lit_")).collect();
    assert_eq!(names.len(), 2, "{header}");
    assert_eq!((column(&place, "two.csv", names[0]), column(&place, "two.csv", names[1])), (first, night));
}

#[test]
fn soft_edges_are_as_wide_as_the_sun_and_hard_ones_cut_them_in_half() {
    let place = Workplace::with_house();
    // across the edge of the shadow of the eaves, 6 m high: it lies 10 m north of the middle under a sun of 45 degrees
    let places: Vec<[f64; 3]> = (0..200).map(|i| [0.25, 9.0 + 0.01 * f64::from(i), 0.1]).collect();
    place.write_places("line.csv", &places);
    let lit = |flags: &str| {
        place.summary(&format!("shadow {HOUSE} --sun 180,45 {flags} --targets line.csv -o lit.csv"));
        column(&place, "lit.csv", "lit")
    };
    let (soft, hard) = (lit("--soft"), lit(""));
    assert!(soft.iter().all(|lit| (0.0..=1.0).contains(lit)) && hard.iter().all(|lit| [0.0, 1.0].contains(lit)));
    assert_eq!((soft[0], soft[199], hard[0], hard[199]), (0.0, 1.0, 0.0, 1.0));
    assert!(soft.windows(2).all(|pair| pair[0] <= pair[1]), "{soft:?}");
    let partly = soft.iter().filter(|lit| **lit > 0.0 && **lit < 1.0).count();
    // half a degree over the 8.4 m from the eaves, laid on level ground at 45 degrees, is 0.11 m; the edge of a ball is
    // as sharp as a wall's
    assert!((7..=15).contains(&partly), "{partly} of a centimetre");
    let (edge, half) = (hard.iter().position(|&lit| lit == 1.0), soft.iter().position(|&lit| lit > 0.5));
    assert!(edge.unwrap().abs_diff(half.unwrap()) <= 2, "{edge:?} {half:?}");
}

#[test]
fn faces_that_are_turned_away_are_not_lit() {
    let place = Workplace::with_house();
    // a cube of 1 m, far above everything, outward faces: top, bottom, south, north
    let mut obj = String::new();
    for [x, y, z] in (0..8).map(|i| [f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2 & 1)]) {
        let [x, y, z] = at(10.0 + x, 10.0 + y, 20.0 + z);
        obj += &format!("v {x} {y} {z}\n");
    }
    obj += "o cube\nf 5 6 8\nf 5 8 7\nf 1 4 2\nf 1 3 4\nf 1 2 6\nf 1 6 5\nf 3 8 4\nf 3 7 8\n";
    place.write("cube.obj", obj);
    place.summary(&format!("shadow {HOUSE} --sun 180,45 --targets cube.obj -o faces.csv -o faces.ply"));
    let (faces, lit) = (column(&place, "faces.csv", "face"), column(&place, "faces.csv", "lit"));
    let of = |face: f64| lit[faces.iter().position(|&own| own == face).unwrap()];
    assert_eq!([0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0].map(of), [1.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0]);
    // four of the faces as large as each other are lit
    assert!((lit[0] - 0.5).abs() < 1e-6, "{}", lit[0]);
    assert!(place.path("faces.ply").is_file());
    // as level ones all are lit: nothing stands above them
    place.summary(&format!("shadow {HOUSE} --sun 180,45 --targets cube.obj --facing level -o level.csv"));
    assert!(column(&place, "level.csv", "lit").iter().all(|&lit| lit == 1.0));
}

#[test]
fn a_film_has_a_frame_for_each_sun() {
    let place = Workplace::with_house();
    let run = place.summary(&format!(
        "shadow {HOUSE} --date 2026-12-21 --zone Europe/Amsterdam --time-step-min 60 --cell 1 -o day.csv --film day.png --frames frames --frame-duration-s 0.5"
    ));
    let suns = run["sun"]["suns"].as_u64().unwrap();
    // the sun is up from 8:48 to 16:29: at each full hour from 9 to 16
    assert_eq!(suns, 8);
    let film = place.bytes("day.png");
    let at = film.windows(4).position(|word| word == b"acTL").unwrap() + 4;
    assert_eq!(u64::from(u32::from_be_bytes(film[at..at + 4].try_into().unwrap())), suns);
    let frames = std::fs::read_dir(place.path("frames")).unwrap().count();
    assert_eq!(frames as u64, suns);
    let header = place.text("day.csv").lines().next().unwrap().to_owned();
    let names: Vec<&str> = header.split(',').filter(|name| name.starts_with("lit_")).collect();
    assert_eq!(names, (9..=16).map(|hour| format!("lit_20261221_{hour:02}00")).collect::<Vec<_>>());
    // one map cannot show them all
    let two = format!("shadow {HOUSE} --sun 180,30 --sun 200,30 --cell 1 -o map.png");
    let warnings = &place.summary(&two)["remarks"];
    assert!(warnings.to_string().contains("only the first of 2 suns; --film"), "{warnings}");
    let with_film = &place.summary(&format!("{two} --film film.png"))["remarks"];
    assert!(!with_film.to_string().contains("only the first"), "{with_film}");
}

#[test]
fn what_cannot_be_is_refused_with_advice() {
    let place = Workplace::with_house();
    place.write_places("places.csv", &[[0.0, 8.0, 0.5]]);
    for (flags, words) in [
        ("-o no.csv", "--time"),
        ("--time noon -o no.csv", "--time"),
        ("--time 2026-03-29T02:30 --zone Europe/Amsterdam -o no.csv", "skip"),
        ("--time 2026-06-21T15:00Z --date 2026-06-21 -o no.csv", "--date"),
        ("--sun 180,91 -o no.csv", "elevation"),
        ("--sun 180 -o no.csv", "2 numbers"),
        ("--sun nan,30 -o no.csv", "finite"),
        ("--sun 180,30 --time 2026-06-21T15:00Z -o no.csv", "--time"),
        ("--date shortest-day --location 80,15 -o no.csv", "km from where the reference system puts the scene"),
        ("--date 2026-06-21 --min-sun-elevation 80 -o no.csv", "the sun stays below it"),
        ("--date 2026-06-21 --min-sun-elevation 95 -o no.csv", "--min-sun-elevation: minimum elevation"),
        ("--date 2026-06-21 --time-step-min 120 -o no.csv", "--time-step-min: "),
        ("--time 2026-02-30T10:00+01:00 -o no.csv", "a day of the calendar"),
        ("--sun 180,30 --target-height -500 -o no.csv", "--target-height"),
        ("--date 2026-06-21 --time-step-min 0 -o no.csv", "--time-step-min"),
        ("--sun 180,30 --unproven report -o no.csv", "pulses"),
        ("--sun 180,30 --soft --unproven report -o no.csv", "hard edges"),
        ("--sun 180,30 --sun 180,40 --unproven report -o no.csv", "one sun"),
        ("--sun 180,30 --film film.gif -o no.csv", "png"),
        ("--sun 180,30 --film no.png -o no.png", "two results"),
        ("--sun 180,30 --film film.png --targets places.csv -o no.csv", "grid"),
        ("--sun 180,30 --frames frames --targets places.csv -o no.csv", "grid"),
        ("--sun 180,30 --frame-duration-s 0.1 -o no.csv", "--film"),
        ("--sun 180,30 --film film.png --frame-duration-s 0 -o no.csv", "--frame-duration-s"),
        ("--sun 180,30 --targets places.csv --cell 2 -o no.csv", "--cell"),
        ("--sun 180,30 --targets places.csv -o no.tif", "csv"),
        ("--sun 180,30 --facing normals -o no.csv", "horizontal"),
        ("--sun 180,30 --spacing 1 -o no.csv", "--spacing"),
    ] {
        let run = place.run(&format!("shadow {HOUSE} {flags}"));
        assert!(run.status == 2 && run.stderr.contains(words), "{flags}: {run:?}");
    }
    assert!(
        place.names().iter().all(|name| !name.starts_with("no.") && !name.starts_with("film")),
        "{:?}",
        place.names()
    );
}

#[test]
fn a_raster_has_a_band_for_each_sun_named_by_its_time() {
    let place = Workplace::with_house();
    let day = "--date 2026-06-21 --zone Europe/Amsterdam --time-step-min 60 --cell 2";
    let outputs = "-o day.tif -o day.csv -o day.png --outlines day.geojson";
    let run = place.summary(&format!("shadow {HOUSE} {day} {outputs}"));
    let columns: Vec<String> =
        place.text("day.csv").lines().next().unwrap().split(',').skip(3).map(str::to_owned).collect();
    assert!(columns.len() > 5 && columns.iter().all(|name| name.starts_with("lit_20260621_")), "{columns:?}");
    let raster = belvedere::io::read_tif(place.path("day.tif")).unwrap();
    let bands: Vec<&str> = std::iter::once(raster.name.as_str())
        .chain(raster.further_bands.iter().map(|band| band.name.as_str()))
        .collect();
    assert_eq!(bands, columns);
    // an area for each sun, as large as its cells
    let areas: serde_json::Value = serde_json::from_str(&place.text("day.geojson")).unwrap();
    let areas = areas["features"].as_array().unwrap();
    assert_eq!(areas.len(), columns.len());
    for (area, name) in areas.iter().zip(&columns) {
        let shaded = column(&place, "day.csv", name).iter().filter(|lit| **lit == 0.0).count();
        assert_eq!(area["properties"]["area_m2"], 4.0 * shaded as f64, "{name}");
        assert_eq!(area["properties"]["sun"], name.trim_start_matches("lit_"));
        assert!(area["properties"]["time"].as_str().unwrap().starts_with("2026-06-21T"));
    }
    // a picture has room for one
    assert!(remarks(&run).iter().any(|remark| remark.contains("day.png") && remark.contains("first of")), "{run}");
}

#[test]
fn areas_have_the_means_of_their_cells() {
    let place = Workplace::with_house();
    // behind the house, before it with a second part beside it, and far away
    let ring = |[west, south, east, north]: [f64; 4]| {
        let corner = |x: f64, y: f64| format!("[{},{}]", at(x, y, 0.0)[0], at(x, y, 0.0)[1]);
        let corners = [corner(west, south), corner(east, south), corner(east, north), corner(west, north)];
        format!("[[{},{}]]", corners.join(","), corners[0])
    };
    let parcels = [
        vec![[-4.0, 5.0, 4.0, 14.5]],
        vec![[-4.0, -12.0, 4.0, -5.0], [8.0, -3.0, 12.0, 3.0]],
        vec![[5e3, 0.0, 6e3, 9.0]],
    ];
    let feature = |(number, boxes): (usize, &Vec<[f64; 4]>)| {
        let rings: Vec<String> = boxes.iter().map(|one| ring(*one)).collect();
        let geometry = format!(r#"{{"type":"MultiPolygon","coordinates":[{}]}}"#, rings.join(","));
        format!(r#"{{"type":"Feature","properties":{{"parcel":"P{number}"}},"geometry":{geometry}}}"#)
    };
    let features: Vec<String> = parcels.iter().enumerate().map(feature).collect();
    let crs = r#""crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::28992"}}"#;
    place.write(
        "parcels.geojson",
        format!(r#"{{"type":"FeatureCollection",{crs},"features":[{}]}}"#, features.join(",")),
    );
    place.write_places("places.csv", &[[0.0, 8.0, 0.5]]);
    let shadow = format!("shadow {HOUSE} --sun 180,35 --cell 0.5 --areas parcels.geojson");
    let run = place.run(&format!("{shadow} -o cells.csv --by-area parcels.csv"));
    assert!(run.status == 0 && run.stderr.contains("1 of 3 areas (33.33 %) hold no cell"), "{run:?}");
    let [x, y, lit] = ["x", "y", "lit"].map(|name| column(&place, "cells.csv", name));
    let [cells, means, lows, highs] =
        ["cells", "lit", "lit_min", "lit_max"].map(|name| column(&place, "parcels.csv", name));
    for (number, boxes) in parcels.iter().enumerate() {
        let is_inside = |row: &usize| {
            let [west, south, _] = at(0.0, 0.0, 0.0);
            let (x, y) = (x[*row] - west, y[*row] - south);
            boxes.iter().any(|[w, s, e, n]| x > *w && x < *e && y > *s && y < *n)
        };
        let values: Vec<f64> = (0..lit.len()).filter(is_inside).map(|row| lit[row]).collect();
        assert_eq!(cells[number], values.len() as f64);
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        assert!(values.is_empty() && means[number].is_nan() || (means[number] - mean).abs() < 1e-4, "{number}: {mean}");
    }
    // the house shades a part of the first area; its second has sun alone
    assert!(means[0] > 0.0 && means[0] < 1.0 && [lows[0], highs[0]] == [0.0, 1.0], "{means:?}");
    assert_eq!([means[1], lows[1]], [1.0, 1.0]);
    assert!(place.text("parcels.csv").lines().nth(1).unwrap().starts_with("P0,"), "{}", place.text("parcels.csv"));
    let again = place.run(&format!("{shadow} --by-area parcels.gpkg"));
    assert!(again.status == 0 && again.stdout.contains("written: parcels.gpkg"), "{again:?}");
    let nested = format!("shadow {HOUSE} --sun 180,35 --cell 0.5 --areas parcels.gpkg --by-area twice.csv");
    place.summary(&nested);
    assert_eq!(column(&place, "twice.csv", "lit")[..2], means[..2]);
    place.write("line.geojson", r#"{"type":"LineString","coordinates":[[85000,446000],[85001,446000]]}"#);
    for (flags, words) in [
        ("--areas parcels.geojson -o no.tif", "--by-area"),
        ("--areas parcels.geojson --by-area no.tif", "csv"),
        ("--areas parcels.geojson --by-area no.csv --targets places.csv", "grid"),
    ] {
        let run = place.run(&format!("shadow {HOUSE} --sun 180,35 {flags}"));
        assert!(run.status == 2 && run.stderr.contains(words), "{flags}: {run:?}");
    }
}
