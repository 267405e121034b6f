//! Visible metres of masts behind a house, and what is refused.

use crate::common::{Workplace, at, column, remarks};

const TOWERS: &str = "towers house.laz --orient given --scene-config ../tau.json --towers masts.csv";

fn place() -> Workplace {
    let place = Workplace::with_house();
    let [x, y, _] = at(0.0, 200.0, 0.0);
    place.write(
        "masts.csv",
        format!("x,y,base,hub,tip,scheme,name\n{x},{y},0,120,300,a,M1\n{x},{},0,,40,b,M2\n", y + 9.0),
    );
    // south of the house, and beside it
    let places = [[0.0, -12.0, 1.7], [14.0, -12.0, 1.7]];
    place.write_places("places.csv", &places);
    place
}

#[test]
fn the_ridge_of_a_house_hides_the_foot_of_a_mast() {
    let place = place();
    let summary = place.summary(&format!("{TOWERS} --targets places.csv -o seen.csv"));
    let of = |name: &str| column(&place, "seen.csv", name);
    // the ridge is 9 m high, 12 m before the eye
    let hidden = 1.7 + (9.0 - 1.7) / 12.0 * 212.0;
    // balls lie within 0.15 m of the ridge: 0.0125 of slope
    assert!((of("metres")[0] - (300.0 - hidden)).abs() < 0.0125 * 212.0, "{:?}", of("metres"));
    assert_eq!(of("metres")[1], 340.0);
    assert_eq!([of("towers"), of("tips"), of("hubs"), of("schemes")], [[1.0, 2.0], [1.0, 2.0], [0.0, 1.0], [1.0, 3.0]]);
    assert_eq!(of("nearest_m")[0], 212.0);
    assert_eq!(summary["towers"]["schemes"], serde_json::json!(["a", "b"]));
    let each = &summary["towers"]["each"];
    assert_eq!([&each[0]["name"], &each[1]["name"]], ["M1", "M2"]);
    assert_eq!([&each[0]["tip_percent"], &each[1]["tip_percent"]], [100.0, 50.0]);
    assert!(remarks(&summary).iter().any(|text| text.contains("beyond the cloud and the terrain")));
    // on the map no place has more, and the nearer a place is to the house the less
    let [x, y, _] = at(14.0, -12.0, 0.0);
    let run = place.run(&format!("{TOWERS} --cell 1 -o seen.tif -o seen.png --at {x},{y}"));
    assert_eq!(run.status, 2, "cells and places are two questions");
    let summary = place.summary(&format!("{TOWERS} --cell 1 -o seen.tif -o seen.png"));
    assert!(summary["measures"]["metres"]["max"].as_f64().unwrap() <= 340.0 + 1e-3);
    let run = place.run(&format!("{TOWERS} --at {x},{y}"));
    assert!(
        run.stdout.contains("340 visible metres of towers (100.0 %), towers with a visible part: 2, tips: 2, hubs: 1"),
        "{}",
        run.stdout
    );
}

#[test]
fn wirelines_show_masts_from_places_and_list_them() {
    let place = place();
    let summary = place.summary(&format!("{TOWERS} --targets places.csv -o seen.csv --wirelines views"));
    assert_eq!(summary["wirelines_written"].as_array().unwrap().len(), 3);
    let of = |name: &str| column(&place, "views/wirelines.csv", name);
    assert_eq!([of("place"), of("visible_m")[1..].to_vec()], [vec![1.0, 1.0, 2.0, 2.0], vec![0.0, 300.0, 40.0]]);
    let angle = (298.3_f64 / 212.0).atan().to_degrees();
    assert!((of("tip_deg")[0] - angle).abs() < 0.01, "{:?}", of("tip_deg"));
    // the house hides the lower part of the disc
    assert!(of("disc_visible_share")[0] > 0.5 && of("disc_visible_share")[0] < 1.0);
    for number in [1, 2] {
        let bytes = std::fs::read(place.path(&format!("views/wireline_{number}.png"))).unwrap();
        assert!(bytes.starts_with(b"\x89PNG") && bytes.len() > 5000);
    }
    let run = place.run(&format!("{TOWERS} --targets places.csv -o seen.csv --wirelines masts.csv"));
    assert!(run.status > 0 && run.stderr.contains("a folder is needed"), "{}", run.stderr);
    for (rest, words) in [
        ("--cell 1 -o seen.tif --wirelines views", "--at X,Y or --targets"),
        ("--self -o seen.csv --wirelines views", "--at X,Y or --targets"),
        ("--at 5.39,52.15 --wirelines nowhere", "on the points of the cloud"),
        ("--targets places.csv -o views/wirelines.csv --wirelines views", "choose another"),
        ("--targets views/wirelines.csv -o seen.csv --wirelines views", "choose another"),
    ] {
        let run = place.run(&format!("{TOWERS} {rest}"));
        assert!(run.status > 0 && run.stderr.contains(words), "{}", run.stderr);
    }
    assert!(!place.path("nowhere").exists());
}

#[test]
fn towers_that_cannot_be_are_refused_before_a_cloud_is_read() {
    let place = place();
    for (table, words) in [
        ("x,y\n1,2\n", "no column tip"),
        ("x,y,tip\n1,2,-5\n", "a tip of -5 m"),
        ("x,y,tip,hub\n1,2,50,60\n", "a hub of 60 m"),
        ("x,y,tip\n1,2,\"1,5\"\n", "decimal points"),
        ("x,y,tip\n", "no towers"),
    ] {
        place.write("wrong.csv", table);
        let run = place.run("towers missing.laz --towers wrong.csv -o seen.tif");
        assert!(run.status > 0 && run.stderr.contains(words), "{table}: {}", run.stderr);
    }
    let [x, y, _] = at(0.0, 200.0, 0.0);
    for (table, words) in [
        (format!("x,y,tip\n{x},{y},50\n"), "no ground is known"),
        ("x,y,base,tip\n385000,463000,0,50\n".to_owned(), "from the cloud"),
    ] {
        place.write("wrong.csv", table);
        let run = place.run(&format!("{} -o seen.tif", TOWERS.replace("masts.csv", "wrong.csv")));
        assert!(run.status > 0 && run.stderr.contains(words), "{}", run.stderr);
        assert!(!place.path("seen.tif").exists());
    }
}
