//! Plans of where to scan again, on the command line.

use crate::common::{Workplace, at, column, house_in_a_field, is_hidden};
use serde_json::Value;

/// Position of the tripod, from the middle of the house.
const TRIPOD: [f64; 3] = [-12.0, 0.5, 1.8];

/// Creates the points of a house in a field that a tripod in the west sees. Also creates two places for the next
/// station, with the height of a tripod: one in a corner of the field, and one beside lines behind the house.
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

/// Two flight lines of a scanner 12 m above the field: far in the west, and behind the house.
fn flight_lines(place: &Workplace) {
    let corners = |ends: [[f64; 2]; 2]| {
        let corner = |[x, y]: [f64; 2]| at(x, y, 12.0).map(|v| v.to_string()).join(",");
        format!("[[{}],[{}]]", corner(ends[0]), corner(ends[1]))
    };
    let line = |ends| {
        let geometry = format!(r#"{{"type":"LineString","coordinates":{}}}"#, corners(ends));
        format!(r#"{{"type":"Feature","properties":{{}},"geometry":{geometry}}}"#)
    };
    let lines = [line([[-40.0, -20.0], [-40.0, 20.0]]), line([[14.0, -10.0], [14.0, 10.0]])].join(",");
    place.write("flights.geojson", format!(r#"{{"type":"FeatureCollection","features":[{lines}]}}"#));
}

#[test]
fn light_of_a_sun_is_proven_from_the_air_behind_the_house() {
    let place = place();
    place.write("west.json", from_the_west());
    flight_lines(&place);
    let plan =
        "survey-plan house.laz --scene-config west.json --candidates flights.geojson --whole-lines --max-distance 30";
    let run = place.summary(&format!("{plan} --sun 90,40 --grid-north --cell 1 -o plan.csv"));
    assert!(run["survey_plan"]["unproven_lines"].as_u64().unwrap() > 100, "{run}");
    let [station, x, settled] = ["station", "x", "settles_alone"].map(|name| column(&place, "plan.csv", name));
    let [east, ..] = at(14.0, 0.0, 12.0);
    assert!((x[0] - east).abs() < 1e-3 && station[0] == 1.0 && settled[0] > 20.0, "{x:?} {settled:?} {run}");
    // a sun below the horizon lights nothing
    let night = place.summary(&format!("{plan} --sun 90,-5 --cell 1"));
    assert_eq!(night["survey_plan"]["unproven_lines"].as_u64(), Some(0), "{night}");
    place.refusal(2, &format!("{plan} --sun 90,20 --pairs lines.csv"), &["--sun", "--pairs"]);
}

#[test]
fn a_line_of_candidates_is_one_candidate_that_proves_what_its_places_do_together() {
    let place = place();
    place.write("west.json", from_the_west());
    flight_lines(&place);
    let plan = "survey-plan house.laz --scene-config west.json --pairs lines.csv --candidates flights.geojson --max-distance 30";
    let whole = place.summary(&format!("{plan} --whole-lines -o whole.csv"));
    place.summary(&format!("{plan} -o places.csv"));
    let [of_lines, of_places] = ["whole.csv", "places.csv"].map(|name| column(&place, name, "settles_alone"));
    assert!(of_lines.len() == 2 && of_places.len() > 10, "{of_lines:?} {of_places:?}");
    let best = of_places.iter().copied().fold(0.0, f64::max);
    assert!(of_lines[0] >= best && best > 0.0 && of_lines[1] == 0.0, "{of_lines:?} {of_places:?} {whole}");
    let of_table = plan.replace("flights.geojson", "stations.csv");
    place.refusal(1, &format!("{of_table} --whole-lines"), &["stations.csv", "no lines", "GeoJSON"]);
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
