//! Refused answers: places outside the cloud, and observers that cannot look.

use crate::common::{EAST, NORTH, Workplace, at, column, remarks};

const HOUSE: &str = "house.laz --scene-config ../tau.json --orient given --ground found";
/// Three kilometres beside the house.
const FAR: f64 = 3_000.0;

fn table(header: &str, rows: &[Vec<f64>]) -> String {
    let line = |row: &Vec<f64>| row.iter().map(f64::to_string).collect::<Vec<_>>().join(",");
    format!("{header}\n{}\n", rows.iter().map(line).collect::<Vec<_>>().join("\n"))
}

#[test]
fn places_outside_the_cloud_have_an_answer_of_their_own_in_all_ways_of_asking() {
    let place = Workplace::with_house();
    let places = [at(-12.0, 0.0, 2.0), at(FAR, 0.0, 2.0), at(0.0, 0.0, -50.0), at(-12.0, 0.0, 100.0)];
    place.write("targets.csv", table("x,y,z", &places.map(Vec::from)));
    let targets = "--targets targets.csv -o out.csv";
    // by a depth map, whose picture ends above the house, by lines of sight, and from a camera
    for (view, above) in [
        ("--sun 180,60 --scene-config ../tau.json", 3.0),
        ("--sun 180,60 --scene-config ../carved.json", 1.0),
        ("--panorama 85000,446000,20 --scene-config ../tau.json", 1.0),
    ] {
        let summary = place.summary(&format!("query house.laz --orient given {targets} {view}"));
        assert_eq!(column(&place, "out.csv", "answer"), [1.0, 4.0, 4.0, above], "{view}");
        assert_eq!(summary["answers"]["outside_cloud"], 2);
        let warning = &remarks(&summary)[0];
        assert!(warning.contains("2 of 4 targets (50 %) are outside the cloud"), "{warning}");
    }
    // beside the cloud an eye sees from above all of it, not from below
    for (height, outside, said) in [(20, 2, "the eye is beside the cloud"), (2, 4, "the eye is outside the cloud")] {
        let beside = format!("--panorama {},{NORTH},{height}", EAST + FAR);
        let summary =
            place.summary(&format!("query house.laz --scene-config ../tau.json --orient given {targets} {beside}"));
        assert_eq!(summary["answers"]["outside_cloud"], outside, "{height}");
        assert!(remarks(&summary).iter().any(|remark| remark.contains(said)), "{:?}", remarks(&summary));
    }

    let pair = |a: [f64; 3], b: [f64; 3]| a.into_iter().chain(b).collect::<Vec<f64>>();
    let pairs = [pair(places[0], places[3]), pair(places[0], places[1]), pair(at(FAR, 0.0, 2.0), at(FAR, 9.0, 2.0))];
    place.write("pairs.csv", table("ax,ay,az,bx,by,bz", &pairs));
    let summary = place
        .summary("line-of-sight house.laz --scene-config ../tau.json --orient given --pairs pairs.csv -o sights.csv");
    assert_eq!(column(&place, "sights.csv", "answer"), [1.0, 4.0, 4.0]);
    assert_eq!(summary["lines_of_sight"]["outside_cloud"], 2);

    for command in ["shadow --sun 180,60", "sky-view"] {
        let summary =
            place.summary(&format!("{command} house.laz --scene-config ../tau.json --orient given {targets}"));
        let name = if command == "sky-view" { "sky_view_factor" } else { "lit" };
        let known: Vec<bool> = column(&place, "out.csv", name).iter().map(|v| v.is_finite()).collect();
        assert_eq!(known, [true, false, false, true], "{command}");
        assert_eq!(summary["targets_outside_cloud"], 2);
    }
}

#[test]
fn without_json_warnings_go_to_standard_error() {
    let place = Workplace::with_house();
    place.write("targets.csv", table("x,y,z", &[at(FAR, 0.0, 2.0).to_vec()]));
    let run = place
        .run("query house.laz --scene-config ../tau.json --orient given --sun 180,60 --targets targets.csv -o out.csv");
    assert!(run.status == 0 && !run.stdout.contains("warning"), "{run:?}");
    assert!(run.stderr.starts_with("warning: 1 of 1 targets (100 %) are outside the cloud"), "{}", run.stderr);
}

#[test]
fn observers_that_cannot_look_are_named_skipped_and_counted() {
    let place = Workplace::with_house();
    // before the house, half a metre deep in its west wall, below the ground, and three kilometres away
    let eyes = [at(-12.0, 0.0, 1.7), at(-4.6, 0.25, 2.25), at(-12.0, 5.0, -0.7), at(FAR, 0.0, 1.7)];
    place.write("observers.csv", table("x,y,z", &eyes.map(Vec::from)));
    let summary =
        place.summary(&format!("viewshed {HOUSE} --observers observers.csv --cell 1 -o seen.tif --masks m.npy"));
    let observers = &summary["observers"];
    assert_eq!((&observers["count"], &observers["skipped"]), (&4.into(), &3.into()), "{observers}");
    assert_eq!(observers["skipped_inside_obstacle"], 1);
    assert_eq!(observers["skipped_below_ground"], 1);
    assert_eq!(observers["skipped_outside_cloud"], 1);
    let warnings = remarks(&summary);
    assert!(warnings[0].starts_with("observer 2 at 84995.400,446000.250 is skipped: it is inside an obstacle, 0."));
    assert!(warnings[1].contains("observer 3") && warnings[1].contains("below the ground"), "{warnings:?}");
    assert!(warnings[2].contains("observer 4") && warnings[2].contains("outside the cloud"), "{warnings:?}");
    // observers keep their bits
    let (_, masks) = place.npy::<u32>("m.npy");
    assert!(masks.contains(&1) && masks.iter().all(|bits| *bits <= 1));

    place.summary(
        "horizon house.laz --scene-config ../tau.json --orient given --observers observers.csv -o horizon.csv",
    );
    let text = place.text("horizon.csv");
    let cells: Vec<&str> = text.lines().nth(1).unwrap().split(',').collect();
    assert!(cells.len() == 5 && !cells[1].is_empty() && cells[2].is_empty() && cells[4].is_empty(), "{cells:?}");
    place.summary(
        "isovist house.laz --scene-config ../tau.json --orient given --observers observers.csv -o isovist.csv",
    );
    let volumes = column(&place, "isovist.csv", "volume_m3");
    assert!(volumes.len() == 4 && volumes[0] > 0.0 && volumes[1].is_nan() && volumes[3].is_nan(), "{volumes:?}");
    place.write(
        "wall.obj",
        format!("v {0} {NORTH} 0\nv {0} {1} 0\nv {0} {NORTH} 5\nf 1 3 2\n", EAST - 6.0, NORTH + 5.0),
    );
    let landmark = "--targets wall.obj --observers observers.csv -o landmark.csv";
    let summary = place.summary(&format!("landmark {HOUSE} {landmark}"));
    assert_eq!(summary["observers_given"]["skipped"], 3);
    let shares = column(&place, "landmark.csv", "visible_share");
    assert!(shares.len() == 4 && shares[0] > 0.9 && shares[1].is_nan(), "{shares:?}");
}

#[test]
fn a_run_fails_only_when_no_observer_is_left() {
    let place = Workplace::with_house();
    let inside = format!("--observer {},{},2.25", EAST - 4.6, NORTH + 0.25);
    for command in ["viewshed -o a.tif --ground found", "isovist -o a.csv", "horizon -o a.csv"] {
        let arguments = format!("{command} house.laz --scene-config ../tau.json --orient given {inside}");
        place.refusal(1, &arguments, &["no observer is left", "observer 1", "inside an obstacle"]);
    }
    place.write("inside.csv", format!("x,y,z\n{0},{1},2.25\n{0},{1},3.25\n", EAST - 4.6, NORTH + 0.25));
    let all = ["observer 1 at", "observer 2 at", "inside an obstacle", "heights above them"];
    place.refusal(1, &format!("viewshed {HOUSE} --observers inside.csv --cell 2 -o a.tif"), &all);
    // a target is often inside an obstacle: the answer is from where its place is seen
    place.summary(&format!("viewshed {HOUSE} --target {},{},2.25 --cell 2 -o a.tif", EAST - 4.6, NORTH + 0.25));
}

#[test]
fn places_near_the_edge_of_the_cloud_are_counted_and_mapped() {
    let place = Workplace::with_house();
    // the ridge is 8.8 m above the ground: at 30° a shadow is up to 15 m long, and the sun stands in the south
    let summary =
        place.summary(&format!("shadow {HOUSE} --sun 180,30 --grid-north --cell 1 -o lit.tif --edge-mask edge.tif"));
    let share = summary["targets_near_edge_percent"].as_f64().unwrap();
    assert!((share - 50.0).abs() < 4.0, "{summary}");
    let warning = remarks(&summary).remove(0);
    assert!(warning.contains("targets") && warning.contains("near the edge of the cloud"), "{warning}");
    let file = std::fs::File::open(place.path("edge.tif")).unwrap();
    let mut tiff = tiff::decoder::Decoder::new(file).unwrap();
    let (width, height) = tiff.dimensions().unwrap();
    let tiff::decoder::DecodingResult::U8(flags) = tiff.read_image().unwrap() else { panic!("no bytes") };
    let count = |flag: u8| flags.iter().filter(|&&own| own == flag).count() as u64;
    assert_eq!(summary["targets_near_edge"], count(1));
    // rows run from the north: those in the south are near the edge. The last column has its middle outside
    let row = |row: u32| flags[(row * width) as usize..((row + 1) * width - 1) as usize].to_vec();
    assert!(row(1).contains(&0) && !row(1).contains(&1), "{:?}", row(1));
    assert!(row(height - 2).contains(&1) && !row(height - 2).contains(&0), "{:?}", row(height - 2));
    // under the sky all of so small a cloud is, and a high sun leaves little in doubt
    let summary = place.summary(&format!("sky-view {HOUSE} --cell 1 -o sky.tif"));
    assert!(summary["targets_near_edge_percent"].as_f64().unwrap() > 90.0, "{summary}");
    let summary = place.summary(&format!("shadow {HOUSE} --sun 180,85 --cell 1 -o lit.tif"));
    assert!(summary["targets_near_edge_percent"].as_f64().unwrap() < 8.0, "{summary}");
    place.refusal(
        2,
        &format!("shadow {HOUSE} --sun 180,30 --self -o a.csv --edge-mask e.tif"),
        &["--edge-mask", "grid"],
    );
    let horizon = format!(
        "horizon house.laz --scene-config ../tau.json --orient given --observer {},{NORTH},1.7 -o h.csv",
        EAST - 12.0
    );
    let summary = place.summary(&horizon);
    let share = summary["horizons"]["azimuths_near_edge_percent"].as_f64().unwrap();
    // all but where the house stands before the far edge
    assert!((60.0..100.0).contains(&share), "{share}");
    let remarks = summary["remarks"].as_array().unwrap();
    let remark = remarks.iter().find(|remark| remark["key"] == "horizon-near-edge").unwrap();
    assert_eq!((&remark["severity"], &remark["numbers"]["percent"]), (&"warning".into(), &share.into()));
}
