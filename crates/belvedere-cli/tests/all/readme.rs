//! Figures in the README are those that a program or a page of results wrote.

use crate::common::Workplace;
use serde_json::Value;
use std::path::Path;

fn page(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(name);
    std::fs::read_to_string(path).unwrap()
}

/// The README in one line.
fn readme() -> String {
    page("README.md").split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn figures_of_the_demo_are_those_that_it_writes() {
    let place = Workplace::new();
    place.summary("demo -o demo");
    let numbers: Value = serde_json::from_str(&place.text("demo/numbers.json")).unwrap();
    let scores = &numbers["errors_by_ground_truth"]["pedestrians"];
    let points = numbers["town"]["points"].as_f64().unwrap();
    // a town of 120 m
    let density = points / (120.0 * 120.0);
    let sentences = [
        format!("({density:.0} points per square metre"),
        // as the page groups digits
        format!("a tile of {:.0} {:03.0} points", (points / 1000.0).floor(), points % 1000.0),
        format!("{} % of the lit places are called shadowed", scores["false_blocked_percent"]),
        format!("and {} % of the shadowed places are called lit", scores["false_visible_percent"]),
    ];
    let readme = readme();
    for sentence in sentences {
        assert!(readme.contains(&sentence), "README.md: the demo writes \"{sentence}\"; change the page");
    }
}

#[test]
fn figures_of_towns_are_those_of_their_page() {
    let page = page("docs/methods/sun-and-sky-accuracy.md");
    let row = |line: &str| line.split('|').map(|cell| cell.trim().to_owned()).collect::<Vec<String>>();
    // the rows of targets on and above the ground, whose cells end with those of the raster
    let rows: Vec<Vec<String>> =
        page.lines().map(row).filter(|row| row.len() == 11 && row[2].contains("ground")).collect();
    assert_eq!(rows.len(), 12, "{rows:?}");
    let range = |column: usize, decimals: usize| {
        let values: Vec<f64> = rows.iter().map(|row| row[column].parse().unwrap()).collect();
        let (low, high) = values.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), &v| (low.min(v), high.max(v)));
        format!("{low:.decimals$} to {high:.decimals$}")
    };
    let sentences = [
        format!("have a mean error of {} h, and sky view factors one of {}.", range(3, 2), range(6, 3)),
        format!("A raster of highest points has {} h and {} at the same places", range(8, 2), range(9, 2)),
    ];
    let readme = readme();
    for sentence in sentences {
        assert!(readme.contains(&sentence), "README.md: the page has \"{sentence}\"; change the README");
    }
}
