//! Open surveys of a place, from a server of this test: no network is needed.

use crate::common::Workplace;
use crate::web_server::{Manner, WebServer};
use std::fs;

/// Place of the house, in degrees.
const AT: &str = "--at 51.99796,4.36789";

/// A folder with a table of two surveys: one that lists the house as a tile, and one for people only.
fn place() -> (Workplace, WebServer, Vec<u8>) {
    let place = Workplace::with_house();
    let tile = fs::read(place.path("house.laz")).unwrap();
    let files = WebServer::start([("house.laz", tile.clone())], Manner::Whole);
    let list = format!(r#"{{"features": [{{"properties": {{"url": "{}"}}}}]}}"#, files.address("house.laz"));
    let service = WebServer::start([("list", list.into_bytes())], Manner::Whole);
    let row = |name: &str, index: &str| {
        format!(
            r#"{{"name": "{name}", "title": "Survey of {name}", "licence": "CC BY 4.0", "attribution": "the {name}",
            "page": "https://example.invalid/{name}", "areas_deg": [[4, 51, 5, 53]], "points_per_m2": 9, "index": {index}}}"#
        )
    };
    let address = service.address("list") + "?bbox={west},{south},{east},{north}";
    let table = [row("town", &format!(r#"{{"list": {{"address": "{address}"}}}}"#)), row("club", r#""page""#)];
    place.write("surveys.json", format!("[{}]", table.join(",")));
    (place, files, tile)
}

#[test]
fn surveys_of_a_place_are_listed_with_licence_and_next_step() {
    let (place, _files, tile) = place();
    let run = place.run(&format!("fetch {AT} --surveys surveys.json"));
    assert_eq!((run.status, run.stderr.as_str()), (0, ""), "{run:?}");
    for words in
        ["town: Survey of town, 9 points/m², 1 tile", "CC BY 4.0", "https://example.invalid/club", "-o place.laz"]
    {
        assert!(run.stdout.contains(words), "{words}: {}", run.stdout);
    }
    let found = place.summary(&format!("fetch {AT} --surveys surveys.json"));
    assert_eq!(found["surveys"][0]["tiles"].as_array().unwrap().len(), 1);
    let wide = place.run(&format!("fetch {AT} --radius 3000 --surveys surveys.json"));
    assert!(wide.stdout.contains("-o tiles") && !wide.stdout.contains("place.laz"), "{wide:?}");
    // the next step works as printed
    let next = run.stdout.lines().find_map(|line| line.trim().strip_prefix("next: belvedere ")).unwrap();
    place.summary(next);
    assert!(fs::metadata(place.path("place.laz")).unwrap().len() <= tile.len() as u64);
}

#[test]
fn points_of_a_square_are_a_cloud_that_every_command_reads() {
    let (place, _files, tile) = place();
    let found = place.summary(&format!("fetch {AT} --radius 6 --surveys surveys.json -o garden.laz"));
    let all = place.summary("info house.laz")["points"].as_u64().unwrap();
    let points = found["points"].as_u64().unwrap();
    assert!(points > 100 && points < all, "{points} of {all}");
    assert_eq!(place.summary("info garden.laz")["points"].as_u64(), Some(points));
    let origin: serde_json::Value = serde_json::from_slice(&place.bytes("garden.origin.json")).unwrap();
    assert_eq!(origin["attribution"], "the town");
    place.summary(&format!("sun-hours garden.laz {AT} --date 2026-03-21 --trees opaque"));
    // whole tiles, twice
    for _ in 0..2 {
        let run = place.run(&format!("fetch {AT} --surveys surveys.json -o tiles"));
        assert!(run.status == 0 && run.stdout.contains("1 tile of Survey of town"), "{run:?}");
        assert!(place.bytes("tiles/house.laz") == tile);
    }
    assert_eq!(place.summary("info tiles")["points"].as_u64(), Some(all));
}

#[test]
fn fetch_refuses_what_no_survey_has_and_names_services_that_fail() {
    let (place, _files, _) = place();
    for (flags, words) in [
        ("--at 4.37,52.0", &["--at", "latitude first"][..]),
        ("--at 52.0,4.37 --survey ahn9", &["--survey", "town, club"]),
        ("--at 48.85,2.35 --survey town", &["--survey", "does not cover 48.85, 2.35"]),
        ("--at 52.0,4.37 --radius 20000", &["--radius", "5000"]),
        ("--at 52.0,4.37 -o garden.csv", &["-o", ".laz"]),
        ("--at 95,4", &["--at", "latitude"]),
        ("--at 52.0,4.37 --radius 3000 -o garden.laz", &["--radius", "1000"]),
    ] {
        place.refusal(2, &format!("fetch {flags} --surveys surveys.json"), words);
    }
    place.refusal(1, &format!("fetch {AT} --surveys surveys.json -o missing/garden.laz"), &["does not exist"]);
    let by_hand = format!("fetch {AT} --surveys surveys.json --survey club -o garden.laz");
    place.refusal(1, &by_hand, &["choose tiles on https://example.invalid/club"]);
    place.refusal(1, &format!("fetch {AT} --surveys house.laz"), &["house.laz", "table of surveys"]);
    let gone = WebServer::start([("list", Vec::new())], Manner::Status(403));
    let address = gone.address("list") + "?bbox={west},{south},{east},{north}";
    place.write(
        "gone.json",
        format!(
            r#"[{{"name": "gone", "title": "Gone", "licence": "", "attribution": "", "page": "https://example.invalid",
            "areas_deg": [[4, 51, 5, 53]], "index": {{"list": {{"address": "{address}"}}}}}}]"#
        ),
    );
    let run = place.run(&format!("fetch {AT} --surveys gone.json"));
    assert!(run.status == 0 && run.stderr.contains("Gone was not reached"), "{run:?}");
    place.refusal(1, &format!("fetch {AT} --surveys gone.json -o garden.laz"), &["refuses access"]);
    assert!(!place.path("garden.laz").exists() && !place.path("garden.origin.json").exists());
}
