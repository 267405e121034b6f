//! Runs with missing or damaged files: damage is named, the rest continues, and an interrupted run continues.

use crate::common::{MIDDLE, SMALL, WIDE, plan, run_all, run_params, suns, write_town};
use belvedere::Error;
use belvedere::control::{Control, Watcher};
use belvedere::crs::Crs;
use belvedere::io::{ReadBands, ReadOptions, read_cloud, read_tif_bands, write_cloud};
use belvedere_tiles::{CellSizes, Plan, PlanParams, RunParams, Shard, Steps, UnfinishedRun, merge, run, status};
use std::fs::File;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, SystemTime};

/// Returns all results of a run: file names below its folder, and their bytes.
fn results(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut found = Vec::new();
    for stage in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).filter(|path| path.is_dir()) {
        for file in std::fs::read_dir(&stage).unwrap().map(|entry| entry.unwrap().path()) {
            let name = file.strip_prefix(folder).unwrap().to_string_lossy().into_owned();
            assert!(file.extension().is_some_and(|e| e == "npz" || e == "tif" || e == "json"), "{name} is left");
            let mut bytes = std::fs::read(&file).unwrap();
            if name.ends_with("json") {
                bytes = without_times(&bytes);
            }
            found.push((name, bytes));
        }
    }
    found.sort();
    found
}

/// Returns a record without the time of writing of its result, and without its checksum.
fn without_times(record: &[u8]) -> Vec<u8> {
    let mut record: serde_json::Value = serde_json::from_slice(record).unwrap();
    record.as_object_mut().unwrap().remove("checksum");
    for file in ["result", "pulses", "crowns"] {
        if let Some(stamp) = record.get_mut(file) {
            stamp.as_object_mut().unwrap().remove("modified");
        }
    }
    record.to_string().into_bytes()
}

/// Watcher that cancels the work after a number of checks.
struct CancelAfterChecks(AtomicUsize);

impl Watcher for CancelAfterChecks {
    fn is_cancelled(&self) -> bool {
        self.0.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |left| left.checked_sub(1)).is_err()
    }
}

#[test]
fn a_run_that_is_stopped_again_and_again_has_the_results_of_one_that_is_not() {
    let place = tempfile::tempdir().unwrap();
    let clouds = &MIDDLE.clouds;
    let (straight, stopped) = (place.path().join("straight"), place.path().join("stopped"));
    MIDDLE.run(&plan(clouds, &straight, 64.0, suns()), &straight, None);
    let plan = plan(clouds, &stopped, 64.0, suns());
    let params = run_params(None);
    let (mut stops, mut patience) = (0, 500);
    loop {
        let watcher = CancelAfterChecks(AtomicUsize::new(patience));
        match run(&plan, &stopped, &params, &Control::new(&watcher)) {
            Err(Error::Cancelled) => stops += 1,
            other => {
                assert!(other.unwrap().failed.is_empty());
                break;
            }
        }
        assert!(!status(&plan, &stopped).is_complete());
        patience *= 4;
    }
    assert!(stops >= 3, "{stops}");
    assert!(results(&straight) == results(&stopped));
    // No work is done twice.
    let report = run_all(&plan, &stopped);
    assert_eq!((report.balls_made, report.answers_made), (0, 0));
}

#[test]
fn shares_of_the_tiles_give_the_whole_together() {
    let place = tempfile::tempdir().unwrap();
    let clouds = &MIDDLE.clouds;
    let (straight, shared) = (place.path().join("straight"), place.path().join("shared"));
    MIDDLE.run(&plan(clouds, &straight, 64.0, suns()), &straight, None);
    let plan = plan(clouds, &shared, 64.0, suns());
    let run_share = |number: usize, steps: Steps| {
        let params = RunParams { shard: Shard { number, of: 3 }, steps, ..run_params(None) };
        let report = run(&plan, &shared, &params, &Control::none()).unwrap();
        assert!(report.failed.is_empty());
        (report.balls_made, report.answers_made)
    };
    // Balls first: then each is made once.
    let balls = [3, 1, 2].map(|number| run_share(number, Steps::Balls));
    assert_eq!(balls.iter().map(|made| made.0).sum::<usize>(), plan.tiles.len());
    assert!(balls.iter().all(|made| made.1 == 0) && !shared.join("shadow_5").exists());
    let answers = [2, 1, 3].map(|number| run_share(number, Steps::All));
    assert!(answers.iter().all(|made| made.0 == 0 && made.1 > 0), "{answers:?}");
    assert!(results(&straight) == results(&shared));
    // Answers before the balls of other shares: the balls that they need are made.
    std::fs::remove_dir_all(shared.join("balls")).unwrap();
    for sun in suns() {
        std::fs::remove_dir_all(shared.join(&sun.name)).unwrap();
    }
    let mixed = [3, 1, 2].map(|number| run_share(number, Steps::All));
    assert!(mixed.iter().all(|made| made.1 > 0), "{mixed:?}");
    assert!(results(&straight) == results(&shared));
    let params = RunParams { shard: Shard { number: 4, of: 3 }, ..run_params(None) };
    assert!(run(&plan, &shared, &params, &Control::none()).is_err());
}

#[test]
fn a_file_that_is_gone_is_named_and_what_it_may_block_is_unproven() {
    let place = tempfile::tempdir().unwrap();
    let clouds = write_town(place.path(), 300.0, 0.25);
    let (straight, broken) = (place.path().join("straight"), place.path().join("broken"));
    let sun = vec![suns()[2].clone()];
    let whole = plan(&clouds, &straight, 64.0, sun.clone());
    run_all(&whole, &straight);
    let plan = plan(&clouds, &broken, 64.0, sun.clone());
    // The eastern half is missing, and with it the balls of tiles next to it.
    std::fs::rename(&clouds[1], place.path().join("away")).unwrap();
    let report = run_all(&plan, &broken);
    assert!(!report.failed.is_empty() && report.answers_made > 0);
    assert!(report.failed.iter().all(|why| why.contains("half_1.laz")), "{:?}", report.failed);
    assert!(!status(&plan, &broken).is_complete());
    let values = |plan: &Plan, folder: &Path| {
        let path = folder.join("merged.tif");
        merge(plan, folder, &sun[0], &path, UnfinishedRun::Merged, &Control::none()).unwrap();
        let ReadBands::U8(bands) = read_tif_bands(&path).unwrap() else { panic!("bytes") };
        let pairs = bands[0].values().iter().zip(bands[1].values());
        pairs.map(|(&lit, &unproven)| [lit, unproven]).collect::<Vec<[u8; 2]>>()
    };
    let (expected, found) = (values(&whole, &straight), values(&plan, &broken));
    // It is merged only if that is wanted.
    let path = place.path().join("refused.tif");
    let error = merge(&plan, &broken, &sun[0], &path, UnfinishedRun::Refused, &Control::none()).unwrap_err();
    let words = ["broken", "not finished", "--unfinished", "belvedere city run"];
    assert!(words.iter().all(|word| error.to_string().contains(word)) && !path.exists(), "{error}");
    assert_eq!(expected.len(), found.len());
    let pairs = || expected.iter().zip(&found);
    assert!(pairs().filter(|(_, found)| **found == [1, 1]).count() > 100);
    assert!(pairs().filter(|(_, found)| **found == [1, 0]).count() > 500);
    let wrong = pairs().filter(|(expected, found)| expected[0] == 0 && **found == [1, 0]).count();
    assert_eq!(wrong, 0, "cells in shadow that are called lit beyond doubt");
    // With the file back, the next run completes the result, and computes unproven answers again.
    std::fs::rename(place.path().join("away"), &clouds[1]).unwrap();
    assert!(run_all(&plan, &broken).failed.is_empty());
    assert_eq!(values(&plan, &broken), expected);
}

#[test]
fn balls_and_answers_that_were_damaged_are_named_and_made_again() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path().join("run");
    let plan = plan(&MIDDLE.clouds, &folder, 64.0, vec![suns()[0].clone()]);
    MIDDLE.run(&plan, &folder, None);
    let expected = results(&folder);
    let names = |stage: &str| -> Vec<String> {
        let of_stage =
            expected.iter().map(|(name, _)| name).filter(|name| name.starts_with(stage) && !name.ends_with("json"));
        // Pulses and crowns lie beside balls.
        let of_stage = of_stage.filter(|name| ![".pulses.", ".crowns."].iter().any(|part| name.contains(part)));
        of_stage.cloned().collect()
    };
    let (balls, answers) = (names("balls/"), names("shadow_5/"));
    let damage = |name: &str, change: &dyn Fn(&mut Vec<u8>)| {
        let mut bytes = std::fs::read(folder.join(name)).unwrap();
        change(&mut bytes);
        std::fs::write(folder.join(name), bytes).unwrap();
    };
    let flip = |bytes: &mut Vec<u8>| {
        let middle = bytes.len() / 2;
        bytes[middle] ^= 4;
    };
    // One file is shorter than written, the others have one changed bit. The answers are missing, so that balls are
    // read.
    damage(&balls[0], &|bytes| bytes.truncate(bytes.len() - 1));
    balls[1..].iter().for_each(|name| damage(name, &flip));
    answers.iter().for_each(|name| std::fs::remove_file(folder.join(name)).unwrap());
    let left = status(&plan, &folder).stages.iter().map(|stage| stage.left).collect::<Vec<_>>();
    assert_eq!(left, [balls.len(), answers.len()]);
    let report = run_all(&plan, &folder);
    assert!(report.failed.is_empty() && report.unproven_cells == 0, "{report:?}");
    for name in balls.iter().chain(&answers) {
        assert!(report.damaged.iter().any(|damage| damage.contains(name)), "{name}: {:?}", report.damaged);
    }
    assert!(results(&folder) == expected);
    // A changed answer is not merged, and made again.
    damage(&answers[0], &flip);
    assert_eq!(status(&plan, &folder).stages.iter().map(|stage| stage.left).collect::<Vec<_>>(), [0, 1]);
    let merged = merge(
        &plan,
        &folder,
        &plan.questions[0],
        &place.path().join("all.tif"),
        UnfinishedRun::Refused,
        &Control::none(),
    );
    let error = merged.unwrap_err().to_string();
    assert!(error.contains(&answers[0]) && error.contains("compute it again"), "{error}");
    assert!(!place.path().join("all.tif").exists());
    assert_eq!(run_all(&plan, &folder).answers_made, 1);
    assert!(results(&folder) == expected);
    // A copied answer is not made again.
    let (path, copy) = (folder.join(&answers[0]), place.path().join("copy"));
    std::fs::copy(&path, &copy).unwrap();
    std::fs::rename(&copy, &path).unwrap();
    assert_eq!(run_all(&plan, &folder).answers_made, 0);
    // An edited record does not count.
    let record = path.with_extension("json");
    let text = std::fs::read_to_string(&record).unwrap();
    std::fs::write(&record, text.replacen("\"points\":", "\"points\":1", 1)).unwrap();
    assert_eq!(run_all(&plan, &folder).answers_made, 1);
    assert!(results(&folder) == expected);
}

#[test]
fn a_file_that_changed_since_the_plan_is_refused_and_one_that_was_copied_is_not() {
    let place = tempfile::tempdir().unwrap();
    let clouds = SMALL.copied(place.path());
    let folder = place.path().join("run");
    let plan = plan(&clouds, &folder, 128.0, suns());
    let written = std::fs::read(&clouds[0]).unwrap();
    let time = std::fs::metadata(&clouds[0]).unwrap().modified().unwrap();
    let middle = written.len() / 2;
    let flip = |range: std::ops::Range<usize>| {
        let mut bytes = written.clone();
        bytes[range].iter_mut().for_each(|byte| *byte ^= 1);
        bytes
    };
    let with_time = |bytes: &[u8], time: SystemTime| {
        std::fs::write(&clouds[0], bytes).unwrap();
        File::options().write(true).open(&clouds[0]).unwrap().set_modified(time).unwrap();
    };
    let refused = |why: &str| {
        let report = run_all(&plan, &folder);
        let is_refusal = |why: &String| why.contains("half_0.laz") && why.contains("make the plan again");
        assert!(report.failed.iter().any(is_refusal), "{why}: {:?}", report.failed);
    };
    // One byte in the middle, one near the end, and a third change that keeps the time of the file.
    let later = time + Duration::from_secs(3);
    with_time(&flip(middle..middle + 1), later);
    refused("a byte in the middle");
    with_time(&flip(written.len() - 300..written.len() - 299), later);
    refused("a byte near the end");
    with_time(&flip(middle..middle + written.len() / 3), time);
    refused("a third with the time as before");
    with_time(&written[..middle], time);
    refused("a half");
    // The same bytes at another time are the same file.
    with_time(&written, later);
    assert!(run_all(&plan, &folder).failed.is_empty());
}

#[test]
fn a_plan_that_was_edited_or_leads_out_of_its_folder_is_refused() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path().join("run");
    let good = plan(&SMALL.clouds, &folder, 64.0, suns()[..2].to_vec());
    let path = Plan::path(&folder);
    let text = std::fs::read_to_string(&path).unwrap();
    let refused = |text: &str, word: &str| {
        std::fs::write(&path, text).unwrap();
        let error = Plan::read(&folder).unwrap_err().to_string();
        assert!(
            error.contains("plan.json") && error.contains(word) && error.contains("belvedere city plan"),
            "{error}"
        );
    };
    refused(&text.replacen("\"tile_size\":64", "\"tile_size\":65", 1), "checksum");
    refused(&text.replacen("shadow_5", "shadow_6", 1), "checksum");
    // With the right checksum, names are still checked.
    let named = |name: &str| {
        let rest = text.split_once(',').unwrap().1.replacen("shadow_5", name, 1);
        format!("{{\"checksum\":\"{:08x}\",{rest}", crc32fast::hash(rest.as_bytes()))
    };
    for name in ["../out", "/tmp/out", "a/b", "a\\\\b", ".", "..", "", "balls", "shadow_20", "c:out", "a\\u0000b"] {
        refused(&named(name), "questions is");
    }
    std::fs::write(&path, named("shadow-5.5+a")).unwrap();
    assert!(Plan::read(&folder).is_ok());
    let question = |name: &str| suns().remove(0).named(name);
    assert!(good.with_questions(vec![question("../out")], &Control::none()).is_err());
}

#[test]
fn a_run_without_a_result_is_not_merged_and_a_raster_ends_where_points_do() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path().join("run");
    let plan = plan(&SMALL.clouds, &folder, 512.0, suns()[2..].to_vec());
    let path = place.path().join("all.tif");
    let merged = |unfinished| merge(&plan, &folder, &plan.questions[0], &path, unfinished, &Control::none());
    for unfinished in [UnfinishedRun::Refused, UnfinishedRun::Merged] {
        let error = merged(unfinished).unwrap_err().to_string();
        assert!(error.contains("no result of shadow_60") && error.contains("belvedere city run"), "{error}");
        assert!(!path.exists());
    }
    run_all(&plan, &folder);
    assert_eq!(merged(UnfinishedRun::Refused).unwrap().missing, 0);
    let ReadBands::U8(bands) = read_tif_bands(&path).unwrap() else { panic!("bytes") };
    let with_value = bands[0].values().iter().filter(|&&value| value != 255).count();
    let bounds = plan.bounds().size();
    // Cells of 1 m may have a value 2 m beside the points.
    assert!(bands[0].width() as f32 <= bounds[0] + 6.0 && bands[0].height() as f32 <= bounds[1] + 6.0);
    assert!(with_value * 10 > bands[0].values().len() * 7, "{with_value} of {}", bands[0].values().len());
}

/// A COPC file may hide points, or a file may have fewer points than the plan counted. Here the plan is of one file,
/// and the run reads a file with other points and the fingerprint of the first.
#[test]
fn points_that_the_plan_counted_and_the_run_does_not_find_are_an_error() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path().join("run");
    plan(&SMALL.clouds, &folder, 64.0, suns()[2..].to_vec());
    let path = Plan::path(&folder);
    let text = std::fs::read_to_string(&path).unwrap();
    let mut rest: serde_json::Value = serde_json::from_str(&text).unwrap();
    rest.as_object_mut().unwrap().remove("checksum");
    let points = rest["blocks"][0]["points"].as_u64().unwrap();
    rest["blocks"][0]["points"] = (points + 1).into();
    let rest = rest.to_string()[1..].to_owned();
    std::fs::write(&path, format!("{{\"checksum\":\"{:08x}\",{rest}", crc32fast::hash(rest.as_bytes()))).unwrap();
    let report = run_all(&Plan::read(&folder).unwrap(), &folder);
    let words = [format!("gives {points} points"), format!("counted {}", points + 1), "make the plan again".to_owned()];
    assert!(report.failed.iter().any(|why| words.iter().all(|word| why.contains(word))), "{:?}", report.failed);
}

#[test]
fn tiles_are_made_smaller_until_they_fit_into_the_memory_and_sizes_out_of_range_are_refused() {
    let params = PlanParams { clouds: WIDE.clouds.clone(), ..PlanParams::default() };
    let make = |params: &PlanParams| Plan::make(params, &Control::none());
    let whole = make(&params).unwrap();
    let memory = whole.estimate().memory_bytes - 1_000_000;
    let fitting = make(&PlanParams { memory: Some(memory), ..params.clone() }).unwrap();
    assert!(fitting.tile_size < whole.tile_size && fitting.estimate().memory_bytes <= memory);
    // The size is no smaller than needed, and otherwise the plan is that of the size.
    assert!(fitting.tile_size % 64.0 == 0.0, "{}", fitting.tile_size);
    let larger = make(&PlanParams { tile_size: fitting.tile_size + 64.0, ..params.clone() }).unwrap();
    assert!(larger.estimate().memory_bytes > memory);
    assert_eq!(fitting, make(&PlanParams { tile_size: fitting.tile_size, ..params.clone() }).unwrap());
    let error = make(&PlanParams { memory: Some(1_000_000), ..params.clone() }).unwrap_err().to_string();
    assert!(error.contains("1 MB") && error.contains("of 16 m"), "{error}");
    for (tile_size, cell) in [(100.0, 0.3), (100.5, 1.0), (4.0, 1.0), (f64::NAN, 1.0)] {
        let params = PlanParams { tile_size, cells: CellSizes::all(cell), ..params.clone() };
        assert!(Plan::make(&params, &Control::none()).is_err(), "{tile_size} {cell}");
    }
}

#[test]
fn a_reference_system_that_is_not_known_is_named_with_its_file() {
    let place = tempfile::tempdir().unwrap();
    let path = SMALL.copied(place.path()).remove(0);
    let (mut cloud, _) = read_cloud([path.as_path()], &ReadOptions::default(), &Control::none()).unwrap();
    cloud.frame.crs = Crs { epsg: Some(9650), wkt: None, vertical_epsg: None, ..cloud.frame.crs };
    write_cloud(&path, &cloud, &[]).unwrap();
    let params = PlanParams { clouds: vec![path], ..PlanParams::default() };
    let error = Plan::make(&params, &Control::none()).unwrap_err().to_string();
    assert!(error.contains("half_0.laz") && error.contains("EPSG:9650") && error.contains("--crs"), "{error}");
    let params = PlanParams { crs: Some("EPSG:7415".to_owned()), ..params };
    assert!(Plan::make(&params, &Control::none()).is_ok());
}
