//! Plans of where to scan again, on the command line.

use crate::common::{Workplace, at, column, house_in_a_field, is_hidden};
use serde_json::Value;

/// Where the tripod stood, from the middle of the house.
const TRIPOD: [f64; 3] = [-12.0, 0.5, 1.8];

/// The points of a house in a field that a tripod in the west sees; and two places for the next station, with the
/// height of a tripod: one in a corner of the field, and one beside lines that run behind the house.
fn place() -> Workplace {
    let place = Workplace::new();
    let cloud = house_in_a_field();
    let is_seen = |row: &u32| {
        let point = cloud.positions[*row as usize].map(f64::from);
        let back: [f64; 3] = std::array::from_fn(|i| TRIPOD[i] - point[i]);
        // a little before the surface that the point lies on
        !is_hidden(std::array::from_fn(|i| point[i] + 0.02 * back[i]), back)
    };
    let rows: Vec<u32> = (0..u32::try_from(cloud.len()).unwrap()).filter(is_seen).collect();
    assert!(rows.len() < cloud.len() && rows.len() > cloud.len() / 3);
    place.write_cloud("house.laz", &cloud.select(&rows));
    let rows = [[-42.0, -42.0], [13.0, 0.5]].map(|[x, y]| {
        let [x, y, z] = at(x, y, 1.8);
        format!("{x},{y},{z}\n")
    });
    place.write("stations.csv", format!("x,y,z\n{}", rows.concat()));
    // lines behind the house
    let lines = [-4.0, -2.0, 0.0, 2.0].map(|south| {
        let ([ax, ay, az], [bx, by, bz]) = (at(9.0, south, 1.5), at(11.0, south + 4.0, 1.5));
        format!("{ax},{ay},{az},{bx},{by},{bz}\n")
    });
    place.write("lines.csv", format!("ax,ay,az,bx,by,bz\n{}", lines.concat()));
    place
}

fn from_the_west() -> String {
    let [x, y, z] = at(TRIPOD[0], TRIPOD[1], TRIPOD[2]);
    format!("{{\"orient\": \"scanner={x},{y},{z}\"}}")
}

#[test]
fn the_station_within_reach_of_the_lines_is_chosen() {
    let place = place();
    place.write("west.json", from_the_west());
    let run = place.summary(
        "survey-plan house.laz --scene-config west.json --pairs lines.csv --candidates stations.csv --max-distance 20 -o plan.csv -o plan.geojson",
    );
    let plan = &run["survey_plan"];
    let unproven = plan["unproven_lines"].as_u64().unwrap();
    assert!(unproven > 0, "{run}");
    let [station, x, settled] = ["station", "x", "settles_alone"].map(|name| column(&place, "plan.csv", name));
    let [east, ..] = at(13.0, 0.5, 1.8);
    assert!(station.len() == 2 && station[0] == 1.0 && station[1].is_nan(), "{station:?}");
    assert!((x[0] - east).abs() < 1e-3 && settled[0] > 0.0 && settled[1] == 0.0, "{x:?} {settled:?} {run}");
    let points: Value = serde_json::from_str(&place.text("plan.geojson")).unwrap();
    let first = &points["features"][0]["properties"];
    assert_eq!((&first["station"], first["settled"].as_f64().unwrap()), (&1.into(), settled[0]), "{points}");
}

#[test]
fn scenes_without_known_pulses_are_refused_with_what_to_do() {
    let place = place();
    let flags = "--pairs lines.csv --candidates stations.csv";
    place.refusal(
        1,
        &format!("survey-plan house.laz --orient given --scene-config ../tau.json {flags}"),
        &["pulses", "--orient", "trajectory=FILE"],
    );
    place.refusal(2, "survey-plan house.laz --candidates stations.csv", &["--pairs"]);
    place.refusal(2, "survey-plan house.laz --pairs lines.csv", &["--candidates"]);
}
