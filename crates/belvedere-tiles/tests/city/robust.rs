//! What is missing or damaged is named, the rest goes on, and what was interrupted goes on where it stopped.

use crate::common::{plan, run_all, suns, write_town};
use belvedere::Error;
use belvedere::control::{Control, Watcher};
use belvedere::crs::Crs;
use belvedere::io::{ReadBands, ReadOptions, read_cloud, read_tif_bands, write_cloud};
use belvedere_tiles::{CellSizes, Plan, PlanParams, RunParams, Shard, Steps, merge, run, status};
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

/// All results of a run: file names below its folder, and their bytes.
fn results(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut found = Vec::new();
    for stage in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).filter(|path| path.is_dir()) {
        for file in std::fs::read_dir(&stage).unwrap().map(|entry| entry.unwrap().path()) {
            let name = file.strip_prefix(folder).unwrap().to_string_lossy().into_owned();
            assert!(file.extension().is_some_and(|e| e == "npz" || e == "tif" || e == "json"), "{name} is left");
            found.push((name, std::fs::read(&file).unwrap()));
        }
    }
    found.sort();
    found
}

/// Stops the work after some number of looks at whether to stop.
struct CancelAfterChecks(AtomicUsize);

impl Watcher for CancelAfterChecks {
    fn is_cancelled(&self) -> bool {
        self.0.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |left| left.checked_sub(1)).is_err()
    }
}

#[test]
fn a_run_that_is_stopped_again_and_again_has_the_results_of_one_that_is_not() {
    let place = tempfile::tempdir().unwrap();
    let clouds = write_town(place.path(), 100.0, 1.0);
    let (straight, stopped) = (place.path().join("straight"), place.path().join("stopped"));
    run_all(&plan(&clouds, &straight, 64.0, suns()), &straight);
    let plan = plan(&clouds, &stopped, 64.0, suns());
    let params = RunParams { shard: Shard::default(), steps: Steps::All, max_balls: None, seconds: &|| 0.0 };
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
    // nothing is done twice
    let report = run_all(&plan, &stopped);
    assert_eq!((report.balls_made, report.answers_made), (0, 0));
}

#[test]
fn shares_of_the_tiles_give_the_whole_together() {
    let place = tempfile::tempdir().unwrap();
    let clouds = write_town(place.path(), 100.0, 1.0);
    let (straight, shared) = (place.path().join("straight"), place.path().join("shared"));
    run_all(&plan(&clouds, &straight, 64.0, suns()), &straight);
    let plan = plan(&clouds, &shared, 64.0, suns());
    let run_share = |number: usize, steps: Steps| {
        let params = RunParams { shard: Shard { number, of: 3 }, steps, max_balls: None, seconds: &|| 0.0 };
        let report = run(&plan, &shared, &params, &Control::none()).unwrap();
        assert!(report.failed.is_empty());
        (report.balls_made, report.answers_made)
    };
    // balls first: then each is made once
    let balls = [3, 1, 2].map(|number| run_share(number, Steps::Balls));
    assert_eq!(balls.iter().map(|made| made.0).sum::<usize>(), plan.tiles.len());
    assert!(balls.iter().all(|made| made.1 == 0) && !shared.join("shadow_5").exists());
    let answers = [2, 1, 3].map(|number| run_share(number, Steps::All));
    assert!(answers.iter().all(|made| made.0 == 0 && made.1 > 0), "{answers:?}");
    assert!(results(&straight) == results(&shared));
    let params = RunParams { shard: Shard { number: 4, of: 3 }, steps: Steps::All, max_balls: None, seconds: &|| 0.0 };
    assert!(run(&plan, &shared, &params, &Control::none()).is_err());
}

#[test]
fn a_file_that_is_gone_is_named_and_what_it_may_block_is_unproven() {
    let place = tempfile::tempdir().unwrap();
    let clouds = write_town(place.path(), 300.0, 0.6);
    let (straight, broken) = (place.path().join("straight"), place.path().join("broken"));
    let sun = vec![suns()[2].clone()];
    let whole = plan(&clouds, &straight, 64.0, sun.clone());
    run_all(&whole, &straight);
    let plan = plan(&clouds, &broken, 64.0, sun.clone());
    // the eastern half is gone, and with it the balls of tiles next to it
    std::fs::rename(&clouds[1], place.path().join("away")).unwrap();
    let report = run_all(&plan, &broken);
    assert!(!report.failed.is_empty() && report.answers_made > 0);
    assert!(report.failed.iter().all(|why| why.contains("half_1.laz")), "{:?}", report.failed);
    assert!(!status(&plan, &broken).is_complete());
    let values = |plan: &Plan, folder: &Path| {
        let path = folder.join("merged.tif");
        merge(plan, folder, &sun[0], &path, &Control::none()).unwrap();
        let ReadBands::U8(bands) = read_tif_bands(&path).unwrap() else { panic!("bytes") };
        let pairs = bands[0].values().iter().zip(bands[1].values());
        pairs.map(|(&lit, &unproven)| [lit, unproven]).collect::<Vec<[u8; 2]>>()
    };
    let (expected, found) = (values(&whole, &straight), values(&plan, &broken));
    assert_eq!(expected.len(), found.len());
    let pairs = || expected.iter().zip(&found);
    assert!(pairs().filter(|(_, found)| **found == [1, 1]).count() > 100);
    assert!(pairs().filter(|(_, found)| **found == [1, 0]).count() > 500);
    let wrong = pairs().filter(|(expected, found)| expected[0] == 0 && **found == [1, 0]).count();
    assert_eq!(wrong, 0, "cells in shadow that are called lit beyond doubt");
    // back again, the next run completes it, and asks again what was unproven
    std::fs::rename(place.path().join("away"), &clouds[1]).unwrap();
    assert!(run_all(&plan, &broken).failed.is_empty());
    assert_eq!(values(&plan, &broken), expected);
}

#[test]
fn balls_and_answers_that_were_damaged_are_named_and_made_again() {
    let place = tempfile::tempdir().unwrap();
    let clouds = write_town(place.path(), 100.0, 1.0);
    let folder = place.path().join("run");
    let low = || vec![suns()[0].clone()];
    let plan = plan(&clouds, &folder, 64.0, low());
    run_all(&plan, &folder);
    let expected = results(&folder);
    let names = |stage: &str| -> Vec<String> {
        let of_stage =
            expected.iter().map(|(name, _)| name).filter(|name| name.starts_with(stage) && !name.ends_with("json"));
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
    // shorter than written, one bit changed, and an answer that is gone, so that balls are looked at
    damage(&balls[0], &|bytes| bytes.truncate(bytes.len() - 1));
    balls[1..].iter().for_each(|name| damage(name, &flip));
    answers.iter().for_each(|name| std::fs::remove_file(folder.join(name)).unwrap());
    let left = status(&plan, &folder).stages.iter().map(|stage| stage.left).collect::<Vec<_>>();
    assert_eq!(left, [1, answers.len()]);
    let report = run_all(&plan, &folder);
    assert!(report.failed.is_empty() && report.unproven_cells == 0, "{report:?}");
    for name in balls.iter().chain(&answers) {
        assert!(report.damaged.iter().any(|damage| damage.contains(name)), "{name}: {:?}", report.damaged);
    }
    assert!(results(&folder) == expected);
    // a changed answer is not merged
    damage(&answers[0], &flip);
    let merged = merge(&plan, &folder, &plan.questions[0], &place.path().join("all.tif"), &Control::none());
    let error = merged.unwrap_err().to_string();
    assert!(error.contains(&answers[0]) && error.contains("compute it again"), "{error}");
    assert!(!place.path().join("all.tif").exists());
    std::fs::remove_file(folder.join(&answers[0])).unwrap();
    assert_eq!(run_all(&plan, &folder).answers_made, 1);
    assert!(results(&folder) == expected);
}

#[test]
fn a_file_that_changed_since_the_plan_is_refused() {
    let place = tempfile::tempdir().unwrap();
    let clouds = write_town(place.path(), 100.0, 1.0);
    let folder = place.path().join("run");
    let plan = plan(&clouds, &folder, 128.0, suns());
    let mut bytes = std::fs::read(&clouds[0]).unwrap();
    let middle = bytes.len() - 300;
    bytes[middle] ^= 1;
    std::fs::write(&clouds[0], bytes).unwrap();
    let report = run_all(&plan, &folder);
    assert!(report.failed.iter().any(|why| why.contains("half_0.laz") && why.contains("make the plan again")));
}

#[test]
fn tiles_are_quartered_until_they_fit_into_the_memory_and_sizes_out_of_range_are_refused() {
    let place = tempfile::tempdir().unwrap();
    let params = PlanParams { clouds: write_town(place.path(), 200.0, 1.0), ..PlanParams::default() };
    let make = |params: &PlanParams| Plan::make(params, &Control::none());
    let whole = make(&params).unwrap();
    let memory = whole.estimate().memory_bytes - 1_000_000;
    let fitting = make(&PlanParams { memory: Some(memory), ..params.clone() }).unwrap();
    assert!(fitting.tile_size < whole.tile_size && fitting.estimate().memory_bytes <= memory);
    // no smaller than needed, and otherwise the plan of that size
    let larger = make(&PlanParams { tile_size: fitting.tile_size * 2.0, ..params.clone() }).unwrap();
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
    let path = write_town(place.path(), 84.0, 1.0).remove(0);
    let (mut cloud, _) = read_cloud([path.as_path()], &ReadOptions::default(), &Control::none()).unwrap();
    cloud.frame.crs = Crs { epsg: Some(9650), wkt: None, vertical_epsg: None, ..cloud.frame.crs };
    write_cloud(&path, &cloud, &[]).unwrap();
    let params = PlanParams { clouds: vec![path], ..PlanParams::default() };
    let error = Plan::make(&params, &Control::none()).unwrap_err().to_string();
    assert!(error.contains("half_0.laz") && error.contains("EPSG:9650") && error.contains("--crs"), "{error}");
    let params = PlanParams { crs: Some("EPSG:7415".to_owned()), ..params };
    assert!(Plan::make(&params, &Control::none()).is_ok());
}
