//! `belvedere city`: steps, interruptions, damaged tiles.

use crate::common::Workplace;
use std::collections::BTreeMap;
use std::path::Path;
use std::process::Stdio;
use std::time::Duration;

/// The results of a run: names of balls and rasters below its folder, and their bytes.
fn results(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for stage in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).filter(|path| path.is_dir()) {
        for file in std::fs::read_dir(&stage).unwrap().map(|entry| entry.unwrap().path()) {
            if file.extension().is_some_and(|e| e == "npz" || e == "tif") {
                let name = file.strip_prefix(folder).unwrap().to_string_lossy().into_owned();
                found.insert(name, std::fs::read(&file).unwrap());
            }
        }
    }
    found
}

fn town(place: &Workplace) {
    assert_eq!(place.run("simulate village -o town --extent 130 --density 3").status, 0);
}

#[test]
fn a_run_that_is_killed_at_any_moment_goes_on_and_has_the_same_results() {
    let place = Workplace::new();
    town(&place);
    let plan = "city plan town/cloud.laz --sun 150,20 --tile-size 64";
    place.summary(&format!("{plan} -o straight"));
    let done = place.summary("city run straight");
    let steps = done["balls_made"].as_u64().unwrap() + done["answers_made"].as_u64().unwrap();
    assert!(steps >= 8, "{done}");
    place.summary(&format!("{plan} -o killed"));
    let mut killed = 0;
    for number in 1..=6_u64 {
        let mut run = place.command("city run killed").stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        std::thread::sleep(Duration::from_millis(170 * number));
        if run.try_wait().unwrap().is_none() {
            // SIGKILL on Unix: nothing is tidied up
            run.kill().unwrap();
            killed += 1;
        }
        run.wait().unwrap();
    }
    assert!(killed >= 2, "{killed}");
    place.summary("city run killed");
    assert!(results(&place.path("straight")) == results(&place.path("killed")));
    // what is done is not done again
    let again = place.summary("city run killed");
    assert_eq!((&again["balls_made"], &again["answers_made"]), (&0.into(), &0.into()), "{again}");
    let status = place.summary("city status killed");
    assert_eq!(status["is_complete"], true, "{status}");
    let merged = place.summary("city merge killed -o all.tif");
    assert!(merged["tiles"].as_u64().unwrap() >= 4, "{merged}");
    let catalogue = std::fs::read_to_string(place.path("killed/shadow_150_20.vrt")).unwrap();
    assert_eq!(catalogue.matches("<SimpleSource>").count() as u64, merged["tiles"].as_u64().unwrap());
}

#[test]
fn a_damaged_file_is_named_and_the_exit_status_says_so() {
    let place = Workplace::new();
    town(&place);
    place.summary("city plan town/cloud.laz --sun 150,20 --tile-size 64 -o run");
    let path = place.path("town/cloud.laz");
    let whole = std::fs::read(&path).unwrap();
    let mut bytes = whole.clone();
    // in the middle, where the quick look at a file does not see it
    let middle = bytes.len() / 2;
    bytes[middle - 40_000..middle + 40_000].fill(0xff);
    std::fs::write(&path, bytes).unwrap();
    let run = place.run("city run run");
    assert_eq!(run.status, 1, "{run:?}");
    assert!(run.stderr.contains("cloud.laz"), "{}", run.stderr);
    assert_eq!(place.summary("city status run")["is_complete"], false);
    std::fs::write(&path, whole).unwrap();
    place.summary("city run run");
    assert_eq!(place.summary("city status run")["is_complete"], true);
}

#[test]
fn wrong_plans_are_refused_with_advice() {
    let place = Workplace::new();
    town(&place);
    let plan = "city plan town/cloud.laz -o run";
    place.refusal(2, plan, &["--sun", "--sky-view"]);
    place.refusal(2, &format!("{plan} --sun 150,-3"), &["--sun", "horizon"]);
    place.refusal(2, &format!("{plan} --sky-view --cell 0.3"), &["--cell", "sixty-fourths"]);
    place.refusal(2, &format!("{plan} --sky-view --tile-size 100.5"), &["--tile-size", "whole number of cells"]);
    place.refusal(2, &format!("{plan} --sky-view --memory 3"), &["--memory", "3G"]);
    place.refusal(2, &format!("{plan} --sky-view --memory 101M"), &["--memory", "101 MB"]);
    place.refusal(1, "city run nowhere", &["plan.json"]);
    place.summary(&format!("{plan} --sky-view --directions 49 --sun 150,20"));
    place.refusal(2, "city run run --shard 3/2", &["--shard", "1/N"]);
    place.refusal(2, "city merge run -o all.tif", &["--result", "sky_view_factor"]);
    std::fs::write(place.path("run/plan.json"), "{}").unwrap();
    place.refusal(1, "city run run", &["plan.json", "make it again"]);
}
