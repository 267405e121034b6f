//! Kept scenes are those that were built, and never in the way.

use crate::common::simulated::cloud_of;
use belvedere::PointCloud;
use belvedere::cache::{BuiltScene, CloudKey, ReadBefore, SceneCache, SceneOrigin, model_of_balls, scene_model};
use belvedere::cloud::{CloudFile, CloudFiles, FileRows, GpsTimeKind};
use belvedere::control::Control;
use belvedere::io::{ReadOptions, write_balls};
use belvedere::medial::ShrinkParams;
use belvedere::model::{BallParams, ModelParams, OrientBy, SceneModel};
use belvedere::query::{Answer, UnprovenAs};
use belvedere_scenes::{AirborneParams, TownParams, scan_airborne, town};
use std::borrow::Cow;
use std::fs;
use std::path::PathBuf;
use tempfile::TempDir;

fn cloud(seed: u64) -> PointCloud {
    cloud_of_density(3.0, seed)
}

/// A scan of a town of 60 m with so many pulses per m².
fn cloud_of_density(pulses_per_m2: f64, seed: u64) -> PointCloud {
    let scene = town(&TownParams { extent: 60.0, seed, ..TownParams::default() });
    cloud_of(&scan_airborne(&scene, &AirborneParams { pulses_per_m2, ..AirborneParams::default() }))
}

fn scene_of(cloud: &PointCloud, params: &ModelParams, cache: &SceneCache) -> BuiltScene {
    scene_model(Cow::Borrowed(cloud), params, Some(cache), &Control::none()).unwrap()
}

/// The scene files in a folder.
fn scenes(folder: &TempDir) -> Vec<PathBuf> {
    let paths = fs::read_dir(folder.path()).unwrap().map(|row| row.unwrap().path());
    paths.filter(|path| path.to_string_lossy().ends_with("scene.npz")).collect()
}

#[test]
fn a_scene_that_is_found_is_the_one_that_was_built() {
    let folder = tempfile::tempdir().unwrap();
    let (cache, cloud) = (SceneCache::new(folder.path()), cloud(1));
    let uncarved = ModelParams::default().with_orient(OrientBy::Up).with_balls(BallParams::Shrunk(ShrinkParams::tau()));
    for (count, params) in [ModelParams::default(), uncarved].into_iter().enumerate() {
        let built = scene_of(&cloud, &params, &cache);
        assert!(matches!(built.origin, SceneOrigin::Kept), "{:?}", built.origin);
        assert_eq!(scenes(&folder).len(), count + 1);
        let found = scene_of(&cloud, &params, &cache);
        assert!(matches!(found.origin, SceneOrigin::Found), "{:?}", found.origin);
        assert_eq!(found.model.parts().balls.centers, built.model.parts().balls.centers);
        // angles that are not known are NaN, which equals nothing
        let bits = |scene: &BuiltScene| format!("{:?}", (scene.model.parts(), scene.model.derived(), &scene.report));
        assert!(bits(&found) == bits(&built), "a part differs");
        let derived = built.model.derived();
        assert!(derived.tree.is_some() && derived.normals.is_some());
        assert_eq!(derived.proof.is_none(), built.model.pulses().is_none());
        // also once lines of sight have used what was kept
        let [answers, again] = [&built, &found].map(|scene| {
            let blockers = scene.model.scene(&scene.model.rule(), UnprovenAs::Reported, &Control::none()).unwrap();
            let line = |step: u8| blockers.answer([f64::from(step) - 20.0, 0.0, 1.5], [0.6, 0.0, 0.8], f64::INFINITY);
            (0..40).map(line).collect::<Vec<Answer>>()
        });
        assert_eq!(answers, again);
        assert!(found.model.derived() == derived);
        // who needs no normals can use a scene with them
        let given = scene_model(Cow::Owned(cloud.clone()), &params, Some(&cache), &Control::none()).unwrap();
        assert!(matches!(given.origin, SceneOrigin::Found), "{:?}", given.origin);
    }
    let mut moved = cloud.clone();
    moved.positions[0][0] += 0.01;
    assert!(matches!(scene_of(&moved, &ModelParams::default(), &cache).origin, SceneOrigin::Kept));
    let without = scene_model(Cow::Borrowed(&cloud), &ModelParams::default(), None, &Control::none()).unwrap();
    assert!(matches!(without.origin, SceneOrigin::Built), "{:?}", without.origin);
}

#[test]
fn a_damaged_scene_is_built_again() {
    let folder = tempfile::tempdir().unwrap();
    // it is built 44 times
    let (cache, cloud, params) = (SceneCache::new(folder.path()), cloud_of_density(0.4, 2), ModelParams::default());
    let centers = scene_of(&cloud, &params, &cache).model.parts().balls.centers.clone();
    let path = scenes(&folder).pop().unwrap();
    let whole = fs::read(&path).unwrap();
    let mut kinds_of_damage: Vec<Vec<u8>> = (1..40)
        .map(|part| {
            let mut bytes = whole.clone();
            let at = bytes.len() * part / 40;
            bytes[at] ^= 0x10;
            bytes
        })
        .collect();
    kinds_of_damage.extend([0, 1, 100, whole.len() / 2, whole.len() - 1].map(|length| whole[..length].to_vec()));
    for damaged in kinds_of_damage {
        fs::write(&path, &damaged).unwrap();
        let again = scene_of(&cloud, &params, &cache);
        assert!(again.model.parts().balls.centers == centers);
        // a byte that no reader looks at may differ: then it is found
        if matches!(again.origin, SceneOrigin::Kept) {
            assert!(fs::read(&path).unwrap() == whole);
        }
        fs::write(&path, &whole).unwrap();
    }
}

#[test]
fn what_was_not_used_for_longest_makes_room() {
    let folder = tempfile::tempdir().unwrap();
    let clouds = [3, 4, 5].map(cloud);
    let params = ModelParams::default();
    let cache = SceneCache::new(folder.path());
    for cloud in &clouds[..2] {
        scene_of(cloud, &params, &cache);
    }
    let bytes: u64 = cache.entries().unwrap().iter().map(|entry| entry.bytes).sum();
    // the first is used again, so that the second goes
    std::thread::sleep(std::time::Duration::from_millis(20));
    assert!(matches!(scene_of(&clouds[0], &params, &cache).origin, SceneOrigin::Found));
    scene_of(&clouds[2], &params, &cache.clone().with_max_bytes(bytes));
    assert_eq!(scenes(&folder).len(), 2);
    assert!(matches!(scene_of(&clouds[0], &params, &cache).origin, SceneOrigin::Found));
    assert!(matches!(scene_of(&clouds[1], &params, &cache).origin, SceneOrigin::Kept));
    // one that is larger than the bound alone is kept, and nothing beside it
    let bytes = cache.clear().unwrap();
    assert!(bytes > 0 && scenes(&folder).is_empty());
    scene_of(&clouds[0], &params, &cache.clone().with_max_bytes(1));
    scene_of(&clouds[1], &params, &cache.clone().with_max_bytes(1));
    assert_eq!(scenes(&folder).len(), 1);
}

#[test]
fn a_cache_that_cannot_be_written_is_said_and_changes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "").unwrap();
    let (cloud, params) = (cloud(6), ModelParams::default());
    let cache = SceneCache::new(file.join("below"));
    let built = scene_of(&cloud, &params, &cache);
    assert!(matches!(built.origin, SceneOrigin::NotKept(_)), "{:?}", built.origin);
    assert!(!built.model.balls().is_empty());
    assert!(cache.entries().is_ok_and(|entries| entries.is_empty()) || cache.entries().is_err());
}

#[test]
fn two_that_build_the_same_at_once_keep_it_once() {
    let folder = tempfile::tempdir().unwrap();
    let (cache, cloud, params) = (SceneCache::new(folder.path()), cloud(7), ModelParams::default());
    let centers: Vec<Vec<[f32; 3]>> = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..3).map(|_| scope.spawn(|| scene_of(&cloud, &params, &cache))).collect();
        threads.into_iter().map(|thread| thread.join().unwrap().model.parts().balls.centers.clone()).collect()
    });
    assert!(centers.iter().all(|own| *own == centers[0]));
    assert_eq!(scenes(&folder).len(), 1);
    assert!(matches!(scene_of(&cloud, &params, &cache).origin, SceneOrigin::Found));
}

#[test]
fn what_reading_gave_is_known_until_a_file_changes() {
    let folder = tempfile::tempdir().unwrap();
    let cache = SceneCache::new(folder.path().join("made/when/needed"));
    let file = folder.path().join("tile.xyz");
    fs::write(&file, "1 2 3\n").unwrap();
    let (paths, options, cloud) = ([file.clone()], ReadOptions::default(), cloud(8));
    assert!(cache.read_before(&paths, &options).is_none());
    let notes = serde_json::from_str(r#"{"points": 1, "reading": {"a": [0.1, "b"]}}"#).unwrap();
    let found = ReadBefore::new(CloudKey::of(&cloud), cloud.frame.clone(), notes);
    cache.keep_reading(&paths, &options, &found, None).unwrap();
    let before = cache.read_before(&paths, &options).unwrap();
    assert_eq!((before.frame, before.cloud, before.notes), (found.frame, found.cloud, found.notes));
    fs::write(&file, "1 2 4\n").unwrap();
    assert!(cache.read_before(&paths, &options).is_none());
}

#[test]
fn points_that_are_found_are_those_that_were_read() {
    let folder = tempfile::tempdir().unwrap();
    let (cache, mut cloud) = (SceneCache::new(folder.path().join("kept")), cloud(9));
    cloud.attributes.color = Some((0..cloud.len()).map(|row| [1, 2, u16::try_from(row % 900).unwrap()]).collect());
    cloud.attributes.gps_time_kind = GpsTimeKind::AdjustedStandard;
    cloud.scanner_positions.push([0.1, -2.5, 1e3]);
    let row_count = 3 * cloud.len() as u64;
    let (path, other_attributes) = (PathBuf::from("tile.las"), vec!["amplitude".to_owned()]);
    let file = CloudFile { path, row_count, other_attributes, records: Vec::new() };
    let rows = FileRows::Of((0..row_count).step_by(3).collect());
    cloud.files = CloudFiles { files: vec![file], rows };
    let contents = CloudKey::of(&cloud);
    let read = folder.path().join("tile.xyz");
    fs::write(&read, "1 2 3\n").unwrap();
    let (paths, options) = ([read], ReadOptions::default());
    let given = ReadBefore::new(contents.clone(), cloud.frame.clone(), serde_json::Map::new());
    assert!(cache.points(&given).is_none());
    cache.keep_reading(&paths, &options, &given, Some(&cloud)).unwrap();
    let before = cache.read_before(&paths, &options).unwrap();
    let found = cache.points(&before).unwrap();
    assert!(CloudKey::of(&found) == contents && found.files == cloud.files);
    // a file that is damaged is none, and goes
    let path = fs::read_dir(cache.folder()).unwrap().map(|row| row.unwrap().path());
    let path = path.filter(|path| path.to_string_lossy().ends_with("points.npz")).last().unwrap();
    let mut bytes = fs::read(&path).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 0x10;
    fs::write(&path, bytes).unwrap();
    assert!(cache.points(&before).is_none() && !path.exists());
}

#[test]
fn a_ball_file_that_is_found_has_its_trees_until_it_changes() {
    let folder = tempfile::tempdir().unwrap();
    let (cache, path) = (SceneCache::new(folder.path().join("kept")), folder.path().join("balls.npz"));
    let (control, params) = (Control::none(), ModelParams::default());
    let write = |cloud: &PointCloud| {
        let built = scene_model(Cow::Borrowed(cloud), &params, None, &control).unwrap();
        write_balls(&path, built.model.parts()).unwrap();
    };
    write(&cloud(10));
    let given = model_of_balls(&path, None, &control).unwrap();
    assert!(given.derived().tree.is_none() && given.derived().proof.is_none());
    let kept = model_of_balls(&path, Some(&cache), &control).unwrap();
    let found = model_of_balls(&path, Some(&cache), &control).unwrap();
    let bits = |model: &SceneModel| format!("{:?}", (model.parts(), model.derived()));
    assert!(bits(&found) == bits(&kept) && found.derived().tree.is_some() && found.derived().proof.is_some());
    let answers = [&given, &found].map(|model| {
        let blockers = model.scene(&model.rule(), UnprovenAs::Reported, &control).unwrap();
        let line = |step: u8| blockers.answer([f64::from(step) - 20.0, 0.0, 1.5], [0.6, 0.0, 0.8], f64::INFINITY);
        (0..40).map(line).collect::<Vec<Answer>>()
    });
    assert_eq!(answers[0], answers[1]);
    write(&cloud(11));
    let other = model_of_balls(&path, Some(&cache), &control).unwrap();
    assert_ne!(other.balls().centers, found.balls().centers);
}
