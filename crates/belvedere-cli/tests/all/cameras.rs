//! Camera placement on the command line.

use crate::common::{Workplace, at, column, is_hidden};
use serde_json::Value;

const HOUSE: &str = "cameras house.laz --orient given --scene-config ../tau.json";

/// A house in a field, and three posts beside it: in the west, in the east, and next to the one in the east.
fn place() -> Workplace {
    let place = Workplace::with_field();
    let posts = POSTS.map(|[x, y]| {
        let [x, y, _] = at(x, y, 0.0);
        format!("{x},{y}\n")
    });
    place.write("posts.csv", format!("x,y\n{}", posts.concat()));
    place
}

const POSTS: [[f64; 2]; 3] = [[-12.0, 0.5], [12.0, 0.5], [13.0, 1.5]];
/// Height of cameras and of targets above the ground.
const HEIGHTS: [f64; 2] = [4.0, 1.5];

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

#[test]
fn two_of_three_posts_see_all_but_what_the_house_hides_from_both() {
    let place = place();
    let run = place.summary(&format!(
        "{HOUSE} --candidates posts.csv --fov 360 --max-distance 30 --count 2 -o cameras.geojson -o count.tif -o map.png -o cells.csv --curve curve.csv --footprints areas.geojson"
    ));
    let coverage = &run["coverage"];
    assert_eq!((&coverage["new_cameras"], &coverage["is_proven_optimum"]), (&2.into(), &true.into()), "{run}");
    assert_eq!(coverage["coverage_percent"], coverage["best_possible_percent"]);
    let cameras: Value = serde_json::from_str(&place.text("cameras.geojson")).unwrap();
    let features = cameras["features"].as_array().unwrap();
    assert_eq!(features.len(), 2);
    assert_eq!(features[0]["geometry"]["coordinates"].as_array().unwrap().len(), 3);
    let areas: Value = serde_json::from_str(&place.text("areas.geojson")).unwrap();
    let area = |i: usize| number(&areas["features"][i]["properties"]["covered_m2"]);
    let cells = |i: usize| number(&features[i]["properties"]["covered_targets"]);
    assert!((0..2).all(|i| area(i) == 4.0 * cells(i) && area(i) > 1000.0), "cells of two metres: {areas}");
    // the plan of one day is what exists on the next
    let flags = "--candidates posts.csv --fov 360 --max-distance 30 --count 1";
    let next = place.summary(&format!("{HOUSE} {flags} --existing cameras.geojson -o next.tif"));
    let [before, after] = [number(&coverage["coverage_percent"]), number(&next["coverage"]["existing_only_percent"])];
    // coordinates of the file are rounded to a centimetre
    assert!((before - after).abs() < 0.3, "{before} {after}");

    // which posts were chosen follows from what they cover; truth is the exact house
    let [x, y, counts, by] = ["x", "y", "cameras", "covered_by"].map(|name| column(&place, "cells.csv", name));
    let covers = |[px, py]: [f64; 2], cell: usize| {
        let [east, north, _] = at(0.0, 0.0, 0.0);
        let eye = [px, py, HEIGHTS[0]];
        let way = [x[cell] - east - px, y[cell] - north - py, HEIGHTS[1] - HEIGHTS[0]];
        // both rays meet the house only if it lies between
        let is_between = is_hidden(eye, way) && is_hidden([px + way[0], py + way[1], HEIGHTS[1]], way.map(|v| -v));
        way[0].hypot(way[1]) <= 30.0 && !is_between
    };
    let expected = |posts: [usize; 2], cell: usize| posts.iter().filter(|&&post| covers(POSTS[post], cell)).count();
    let agreement = |posts: [usize; 2]| {
        (0..x.len()).filter(|&cell| expected(posts, cell) as f64 == counts[cell]).count() as f64 / x.len() as f64
    };
    let best = [[0, 1], [0, 2], [1, 2]].map(agreement);
    // cells of two metres at the edge of what the house hides are the rest
    assert!(best[0].max(best[1]) > 0.95 && best[2] < 0.9, "{best:?}");
    let covered = counts.iter().filter(|count| **count > 0.0).count() as f64 / counts.len() as f64;
    assert!((100.0 * covered - number(&coverage["coverage_percent"])).abs() < 0.01, "{covered} {run}");
    assert!(by.iter().zip(&counts).all(|(by, count)| (*count == 1.0) == by.is_finite()), "one number, or none, or two");
    let curve = column(&place, "curve.csv", "coverage_percent");
    assert!(curve.len() == 3 && curve[0] == 0.0 && (curve[2] - number(&coverage["coverage_percent"])).abs() < 1e-3);
    assert!(place.bytes("map.png").starts_with(b"\x89PNG") && !place.bytes("count.tif").is_empty());
}

#[test]
fn existing_cameras_private_places_and_weights_change_what_is_chosen() {
    let place = place();
    let row = |[x, y]: [f64; 2], rest: &str| {
        let [x, y, _] = at(x, y, 0.0);
        format!("{x},{y},{rest}\n")
    };
    // an existing camera in the west looks west, where there is nothing
    place.write("old.csv", format!("x,y,heading,tilt\n{}", row(POSTS[0], "270,15")));
    place.write("doors.csv", format!("x,y,weight\n{}{}", row([-6.0, 0.0], "1"), row([6.0, 0.0], "5")));
    place.write("garden.csv", format!("x,y,z\n{}", row([20.0, 0.5], "1.5")));
    let doors = format!("{HOUSE} --candidates posts.csv --targets doors.csv --density none");
    let run = place.summary(&format!("{doors} --count 1 -o a.geojson"));
    assert!((number(&run["coverage"]["coverage_percent"]) - 100.0 * 5.0 / 6.0).abs() < 1e-3, "{run}");
    let run = place.summary(&format!("{doors} --coverage 100 --existing old.csv -o b.geojson"));
    assert_eq!(run["coverage"]["new_cameras"], 2, "{run}");
    assert_eq!(run["coverage"]["least_possible_cameras"], 2);
    let found: Value = serde_json::from_str(&place.text("b.geojson")).unwrap();
    let first = &found["features"][0]["properties"];
    assert_eq!(
        (&first["existing"], &first["heading"], &first["targets"]),
        (&true.into(), &270.0.into(), &Value::Array(vec![]))
    );
    assert_eq!(found["features"].as_array().unwrap().len(), 3);
    // posts in the east that look east see the garden, the others do not
    let run = place.summary(&format!("{doors} --headings 4 --count 1 --private garden.csv -o c.geojson"));
    assert_eq!(run["cameras_to_choose_from"]["see_private_places"], 2, "{run}");
    // two cameras on each door are four
    let run = place.summary(&format!("{doors} --coverage 75 --per-target 2 -o d.csv"));
    assert_eq!(run["coverage"]["new_cameras"], 2, "{run}");
    let numbers = column(&place, "d.csv", "cameras");
    assert_eq!(numbers, [0.0, 2.0]);
}

#[test]
fn a_mast_covers_less_where_its_fresnel_zone_must_be_free_too() {
    let place = place();
    let mast = format!("{HOUSE} --candidates posts.csv --fov 360 --max-distance 30 --count 2 -o out.csv");
    let covered = |flags: &str| number(&place.summary(&format!("{mast} {flags}"))["coverage"]["coverage_percent"]);
    // a longer wave has a wider zone, and a wider part of it reaches more
    let all = [
        covered(""),
        covered("--frequency-ghz 60"),
        covered("--frequency-ghz 2.4"),
        covered("--frequency-ghz 2.4 --fresnel-percent 100"),
        covered("--frequency-ghz 0.4 --fresnel-percent 100"),
    ];
    assert!(all.is_sorted_by(|wide, narrow| wide >= narrow) && all[0] > all[2] && all[2] > all[4], "{all:?}");
    let pictures = &place.summary(&format!("{mast} --frequency-ghz 2.4"))["pictures"];
    assert!(pictures["fresnel_zone_blocked"].as_u64().unwrap() > 0, "{pictures}");
    place.refusal(2, &format!("{mast} --fresnel-percent 60"), &["--frequency-ghz"]);
    place.refusal(2, &format!("{mast} --frequency-ghz 2.4 --fresnel-percent 101"), &["--fresnel-percent", "100 %"]);
    place.refusal(2, &format!("{mast} --frequency-ghz 2400"), &["--frequency-ghz", "1000 GHz"]);
}

#[test]
fn camera_plans_that_cannot_be_are_refused_with_the_reason() {
    let place = place();
    place.write("doors.csv", "x,y\n85006,446000\n");
    let posts = format!("{HOUSE} --candidates posts.csv");
    place.refusal(2, &format!("{posts} -o a.tif"), &["--count"]);
    place.refusal(2, &format!("{HOUSE} --count 2 -o a.tif"), &["--candidates"]);
    place.refusal(2, &format!("{posts} --count 1 --targets doors.csv -o a.tif"), &["a.tif", "cells"]);
    place.refusal(
        2,
        &format!("{posts} --count 1 --fov 360 --density identify -o a.tif"),
        &["--density", "limit the distance"],
    );
    place.refusal(2, &format!("{posts} --count 1 --fov 400 -o a.tif"), &["field of view", "360"]);
    place.refusal(2, &format!("{posts} --coverage 120 -o a.tif"), &["--coverage", "100"]);
    place.refusal(2, &format!("{posts} --count 1 --density sharp -o a.tif"), &["recognise"]);
    // beside all posts, so that a camera that sees all around has it in its picture
    place.write(
        "yard.csv",
        format!("x,y\n{}", POSTS.map(|[x, y]| format!("{},{}\n", at(x, y, 0.0)[0], at(x, y - 2.0, 0.0)[1])).concat()),
    );
    let around = format!("{posts} --count 1 --fov 360 --private yard.csv -o a.tif");
    place.refusal(1, &around, &["no camera is left", "all 3 have a private place", "headings"]);
    let run = place.run(&format!("{posts} --coverage 100 --fov 360 --max-distance 20 -o a.tif"));
    assert!(run.status != 0 && run.stderr.contains("all candidates together cover"), "{run:?}");
    let run = place.run(&format!("{posts} --existing posts.csv --count 1 -o a.tif"));
    assert!(run.status != 0 && run.stderr.contains("--existing") && run.stderr.contains("heading"), "{run:?}");
}
