//! Messages about positions of eyes, targets and the sun that contradict the cloud.

use crate::common::{Workplace, at, column, remarks};
use belvedere::random::uniform;
use std::fmt::Write;

const HOUSE: &str = "house.laz --scene-config ../tau.json --orient given";

/// A table of level ground of 60 m with a block of 12 by 10 m, 8 m high, and points of class 2 that were added.
fn field(added: &[[f64; 3]]) -> String {
    let mut text = "x,y,z,classification\n".to_owned();
    for i in 0..15_000 {
        let [x, y] = [60.0 * uniform(1, i), 60.0 * uniform(2, i)];
        let is_on_block = (24.0..36.0).contains(&x) && (25.0..35.0).contains(&y);
        let (z, class) = if is_on_block { (18.0, 6) } else { (10.0, 2) };
        let _ = writeln!(text, "{},{},{},{class}", 155_000.0 + x, 463_000.0 + y, z + 0.02 * uniform(3, i));
    }
    for [x, y, z] in added {
        let _ = writeln!(text, "{},{},{},2", 155_000.0 + x, 463_000.0 + y, 10.0 + z);
    }
    text
}

fn key_of(summary: &serde_json::Value, key: &str) -> Option<serde_json::Value> {
    summary["remarks"].as_array()?.iter().find(|remark| remark["key"] == key).cloned()
}

#[test]
fn an_eye_does_not_stand_on_points_that_lie_metres_off_the_ground_around() {
    let place = Workplace::new();
    let group = |count: u64, height: f64| -> Vec<[f64; 3]> {
        (0..count).map(|i| [10.0 + 0.9 * uniform(5, i), 10.0 + 0.9 * uniform(6, i), height]).collect()
    };
    for (count, height) in [(3_u32, -60.0), (1, -5.0), (30, -25.0), (12, 9.0)] {
        place.write("field.csv", field(&group(u64::from(count), height)));
        for (command, output) in [("viewshed", "v.tif"), ("isovist", "i.csv")] {
            let summary =
                place.summary(&format!("{command} field.csv --orient up --observer 155010.4,463010.4 -o {output}"));
            let eye = summary["observers"]["eye"][2].as_f64().unwrap();
            assert!((eye - 11.7).abs() < 0.1, "{command}: {count} points at {height}: an eye at {eye}");
            let doubted = key_of(&summary, "ground-not-believed").unwrap();
            assert_eq!(doubted["numbers"]["count"], f64::from(count), "{doubted}");
        }
    }
    // a hundred points are believed, and what is odd about the eye is said
    place.write("field.csv", field(&group(100, -25.0)));
    for (command, output) in [("viewshed", "v.tif"), ("isovist", "i.csv")] {
        let summary =
            place.summary(&format!("{command} field.csv --orient up --observer 155010.4,463010.4 -o {output}"));
        let odd = key_of(&summary, "odd-ground").unwrap();
        assert!(odd["text"].as_str().unwrap().contains("below the ground within 10 m"), "{odd}");
    }
}

#[test]
fn ground_that_lies_off_over_an_area_is_said_with_its_place() {
    let place = Workplace::new();
    let observed = |name: &str| {
        let flags = "--orient up --observer 155010.4,463010.4 -o v.tif --no-cache";
        place.summary(&format!("viewshed {name} {flags}"))
    };
    // every third point of class 2 of the western half lies 1.5 m too low
    let mut row = 0;
    let shifted: Vec<String> = field(&[])
        .lines()
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            row += 1;
            match cells[..] {
                [x, y, z, "2"] if row % 3 == 0 && x.parse::<f64>().unwrap() < 155_030.0 => {
                    format!("{x},{y},{},2", z.parse::<f64>().unwrap() - 1.5)
                }
                _ => line.to_owned(),
            }
        })
        .collect();
    place.write("shifted.csv", shifted.join("\n") + "\n");
    place.write("field.csv", field(&[]));
    assert_eq!(key_of(&observed("field.csv"), "ground-shifted"), None);
    let said = key_of(&observed("shifted.csv"), "ground-shifted").unwrap();
    let number = |name: &str| said["numbers"][name].as_f64().unwrap();
    assert!((number("rise_m") + 1.5).abs() < 0.02 && number("count") > 1500.0, "{said}");
    assert!((number("east") - 155_030.0).abs() < 8.0 && number("west") < 155_002.0, "{said}");
    assert!(said["severity"] == "warning" && said["text"].as_str().unwrap().contains("1.50 m below"), "{said}");
}

#[test]
fn a_drone_beside_the_cloud_and_above_it_sees_it() {
    let place = Workplace::new();
    place.write("field.csv", field(&[]));
    let flags = "viewshed field.csv --orient up --cell 1 -o v.tif --observer";
    let summary = place.summary(&format!("{flags} 155530,463030,510"));
    assert!(summary["cells"]["visible_percent"].as_f64().unwrap() > 70.0, "{summary}");
    assert_eq!(summary["cells"]["outside_cloud"], 0);
    assert!(key_of(&summary, "eye-beside-cloud").is_some(), "{summary}");
    // who stands beside it on the ground, or on another continent, is refused
    place.refusal(1, &format!("{flags} 155530,463030,12"), &["outside the cloud"]);
    place.refusal(1, &format!("{flags} 555530,463030,510"), &["outside the cloud"]);
    // and the way back has the same answer
    let line = |a: &str, b: &str| {
        place.summary(&format!("line-of-sight field.csv --orient up --observer {a} --target {b}"))["line"]["answer"]
            .clone()
    };
    let (drone, ground) = ("155530,463030,510", "155010,463030,10.1");
    assert_eq!([line(drone, ground), line(ground, drone)], ["visible", "visible"]);
}

#[test]
fn an_end_inside_an_obstacle_is_an_answer_of_its_own() {
    let place = Workplace::with_house();
    let (inside, free) = (at(0.0, 0.0, 3.0), at(-12.0, 0.0, 2.0));
    let row = |a: [f64; 3], b: [f64; 3]| a.iter().chain(&b).map(f64::to_string).collect::<Vec<_>>().join(",");
    let rows = [row(inside, free), row(free, inside), row(free, at(-12.0, 7.0, 2.0))];
    place.write("pairs.csv", format!("ax,ay,az,bx,by,bz\n{}\n", rows.join("\n")));
    let summary = place.summary("line-of-sight house.laz --pairs pairs.csv -o out.csv");
    assert_eq!(column(&place, "out.csv", "answer"), [5.0, 5.0, 1.0]);
    let lines = &summary["lines_of_sight"];
    let counts = ["inside_obstacle", "observers_inside_obstacle", "targets_inside_obstacle"]
        .map(|name| lines[name].as_u64().unwrap());
    assert_eq!(counts, [2, 1, 1], "{lines}");
    assert!(remarks(&summary).iter().any(|text| text.contains("2 of 3 lines of sight")), "{summary}");
    place.write_targets("targets.npy", &[inside, at(-12.0, 7.0, 2.0)]);
    let [x, y, z] = free;
    let from = |eye: &str| {
        let summary = place.summary(&format!("query house.laz --targets targets.npy -o q.npy --panorama {eye}"));
        (place.npy::<u8>("q.npy").1, summary)
    };
    let (answers, summary) = from(&format!("{x},{y},{z}"));
    assert_eq!(answers, [5, 1], "{summary}");
    assert_eq!(summary["answers"]["inside_obstacle"], 1);
    let [x, y, z] = inside;
    let (answers, summary) = from(&format!("{x},{y},{z}"));
    // no line leads from a place to itself
    assert_eq!(answers, [3, 5], "{summary}");
    assert!(key_of(&summary, "end-inside-obstacle").is_some(), "{summary}");
    // a target in the middle of the house is seen from nowhere, and that is said
    let summary = place.summary(&format!("viewshed house.laz --ground found --target {x},{y},{z} --cell 1 -o who.tif"));
    assert!(
        remarks(&summary).iter().any(|text| text.contains("inside an obstacle") && text.contains("deep")),
        "{summary}"
    );
}

#[test]
fn observers_in_degrees_stand_where_their_coordinates_are() {
    let place = Workplace::new();
    place.write("field.csv", field(&[]));
    place.summary("normals field.csv --crs EPSG:28992 --orient up -o field.laz");
    // tables have no header that says where they lie
    for (cloud, status) in [("field.laz", 2), ("field.csv --crs EPSG:28992 --orient up", 1)] {
        let eye = |observer: &str| {
            let run = place.summary(&format!("isovist {cloud} --observer {observer} -o i.csv"));
            [0, 1].map(|axis| run["observers"]["eye"][axis].as_f64().unwrap())
        };
        assert_eq!(eye("155010.4,463010.4"), [155_010.4, 463_010.4]);
        // 10.4 m north and east of the origin of the Dutch grid, by the lengths of a degree there; the step between the
        // datums is known to half a metre
        let [x, y] = eye("52.1552679,5.3873585");
        assert!((x - 155_010.4).abs() < 0.6 && (y - 463_010.4).abs() < 0.6, "{x} {y}");
        place.refusal(status, &format!("isovist {cloud} --observer 5.3873585,52.1552679 -o i.csv"), &["swapped"]);
    }
    for (command, flags) in [
        ("viewshed", "--observer 52.1552679,5.3873585 --cell 4 -o v.tif"),
        ("horizon", "--observer 52.1552679,5.3873585 -o h.csv"),
        ("line-of-sight", "--observer 52.1552679,5.3873585 --target 155040,463040"),
    ] {
        place.summary(&format!("{command} field.laz {flags}"));
    }
}

#[test]
fn the_sun_of_a_place_needs_no_cloud() {
    let place = Workplace::new();
    let times = "--time 2026-06-21T11:44Z --time 2026-12-21T12:00Z";
    place.summary(&format!("sun-position --location 52,4.4 {times} -o sun.csv"));
    let elevations = column(&place, "sun.csv", "elevation_deg");
    // noon of the longest day: 90 - 52 + 23.44 degrees; of the shortest: 90 - 52 - 23.44, and 0.06 of refraction
    assert!((elevations[0] - 61.44).abs() < 0.05 && (elevations[1] - 14.6).abs() < 0.1, "{elevations:?}");
    place.refusal(2, &format!("sun-position {times}"), &["CLOUD"]);
}

#[test]
fn a_sun_that_cannot_stand_there_is_refused_or_said() {
    let place = Workplace::with_house();
    for (sun, word) in
        [("400,30", "azimuth of 0 to 360"), ("30,135", "swapped"), ("180,-91", "elevation"), ("nan,30", "--sun")]
    {
        for command in [
            "shadow -o a.tif",
            "envelope --parcel p.geojson -o e.tif",
            "depth-map -o d.tif",
            "query --random 9 -o q.csv",
        ] {
            let run = place.run(&format!("{command} {HOUSE} --sun {sun}"));
            assert!(
                run.status != 0 && (run.stderr.contains(word) || run.stderr.contains("--sun")),
                "{command} {sun}: {run:?}"
            );
        }
    }
    for command in ["depth-map -o d.tif", "query --random 9 -o q.csv"] {
        place.refusal(2, &format!("{command} {HOUSE} --sun 180,-10"), &["--sun", "elevation of 0 to 90"]);
    }
    let summary = place.summary(&format!("shadow {HOUSE} --ground found --sun 180,-10 --cell 2 -o a.tif"));
    assert!(key_of(&summary, "suns-below-horizon").is_some(), "{summary}");
    // at 52 degrees north the sun is never in the north, 60 degrees high; swapped it stands low in the north-east
    let shadow = "shadow house.laz --scene-config ../tau.json --orient given --ground found --cell 2 -o a.tif --sun";
    let summary = place.summary(&format!("{shadow} 20,80"));
    let said = key_of(&summary, "sun-never-there").unwrap();
    assert!(said["severity"] == "warning" && said["text"].as_str().unwrap().contains("azimuth comes first"), "{said}");
    assert!(key_of(&place.summary(&format!("{shadow} 180,30")), "sun-never-there").is_none());
}

#[test]
fn a_cloud_on_its_side_and_a_file_far_away_are_not_read_without_a_word() {
    let place = Workplace::new();
    place.write("field.csv", field(&[]));
    let turned = field(&[]).lines().skip(1).fold("x,y,z\n".to_owned(), |mut text, line| {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        let _ = writeln!(text, "{},{},{}", cells[0], cells[2], -cells[1]);
        text
    });
    place.write("turned.csv", turned);
    let looks = |arguments: &str| key_of(&place.summary(arguments), "y-looks-up").is_some();
    for command in [
        "info",
        "query --orient up --random 9 --direction 0,0,-1 -o q.csv",
        "sky-view --orient up --ground found --cell 5 -o s.csv",
        "balls --orient up -o b.npz",
        "balls --orient up --side exterior -o b.ply",
        "balls --orient up -o folder",
        "normals --orient up -o n.ply",
        "normals --orient up -o normals",
    ] {
        assert!(looks(&format!("{command} turned.csv")), "{command}");
        assert!(
            !looks(&format!("{command} turned.csv --up y")) && !looks(&format!("{command} field.csv")),
            "{command}"
        );
    }
    let far = "x,y,z\n5155000,463000,1\n5155001,463000,1\n5155001,463002,1\n";
    place.write("far.csv", far);
    place.refusal(1, "info field.csv far.csv", &["far.csv", "1000 km"]);
    assert_eq!(place.summary("info field.csv far.csv --skip-distant")["points"], 15_000);
}
