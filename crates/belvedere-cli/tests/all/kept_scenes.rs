//! Scenes are kept for the next command.

use crate::common::{Workplace, house};
use std::fs;

#[test]
fn the_second_question_finds_the_scene_and_answers_the_same() {
    let place = Workplace::with_house();
    let question = "shadow house.laz --sun 180,40 --grid-north --cell 1 -o";
    let first = place.summary(&format!("{question} first.tif"));
    let second = place.summary(&format!("{question} second.tif"));
    assert_eq!((&first["scene"], &second["scene"]), (&"kept".into(), &"found".into()));
    assert!(place.bytes("first.tif") == place.bytes("second.tif"));
    // all figures but durations and the name of the file
    let figures = |mut summary: serde_json::Value| {
        for name in ["seconds", "scene", "written"] {
            summary.as_object_mut().unwrap().remove(name);
        }
        summary
    };
    let made = second["seconds"].clone();
    assert_eq!(figures(first), figures(second));
    assert!(made.get("estimating_normals").is_none() && made.get("reading_kept_scene").is_some(), "{made}");
    // a saved ball file is that of a scene found
    place.summary("balls house.laz -o found.npz");
    place.summary("balls house.laz -o built.npz --no-cache");
    assert!(place.bytes("found.npz") == place.bytes("built.npz"));

    let listed = place.summary("cache");
    assert_eq!((&listed["scenes"], &listed["scene"][0]["of"]), (&1.into(), &"house.laz".into()));
    let removed = place.summary("cache --clear");
    assert_eq!(removed["scenes_removed"], 1);
    assert_eq!(place.summary("cache")["scenes"], 0);
    assert_eq!(place.summary(&format!("{question} third.tif"))["scene"], "kept");
}

#[test]
fn another_file_or_another_flag_is_another_scene_and_no_cache_leaves_nothing() {
    let place = Workplace::with_house();
    let scene = |more: &str| {
        place.summary(&format!("shadow house.laz --sun 180,40 --grid-north -o a.tif {more}"))["scene"].clone()
    };
    assert_eq!(scene("--no-cache"), "built");
    assert!(!place.cache().exists());
    assert_eq!(scene(""), "kept");
    assert_eq!(scene("--trees opaque"), "kept");
    assert_eq!(scene("--trees opaque"), "found");
    assert_eq!(scene("--cache own"), "kept");
    assert_eq!(scene("--cache own"), "found");
    // the same name, other points
    let mut moved = house();
    moved.positions[7][2] += 0.5;
    place.write_cloud("house.laz", &moved);
    assert_eq!(scene(""), "kept");
    assert_eq!(scene(""), "found");
    place.refusal(2, "shadow house.laz --sun 180,40 -o a.tif --cache own --no-cache", &["--no-cache"]);
}

#[test]
fn a_cache_that_cannot_be_written_is_named_and_the_answer_is_there() {
    let place = Workplace::with_house();
    place.write("file", "");
    let run = place.run("shadow house.laz --sun 180,40 --grid-north -o a.tif --cache file");
    assert_eq!(run.status, 0, "{run:?}");
    assert!(run.stderr.contains("could not be kept") && run.stderr.contains("another folder"), "{run:?}");
    assert!(fs::metadata(place.path("a.tif")).unwrap().len() > 0);
}

#[test]
fn a_folder_of_others_is_no_cache_and_stays() {
    let place = Workplace::with_house();
    fs::create_dir_all(place.path("mine/tiles/run/balls")).unwrap();
    for name in ["mine/anything_scene.npz", "mine/tiles/run/plan.json", "mine/tiles/run/balls/e1_n2.npz"] {
        place.write(name, "mine");
    }
    let run = place.run("shadow house.laz --sun 180,40 --grid-north -o a.tif --cache mine");
    assert!(
        run.status == 0 && run.stderr.contains("could not be kept") && run.stderr.contains("new or empty"),
        "{run:?}"
    );
    let cleared = place.summary("cache --clear --cache mine");
    assert_eq!((&cleared["scenes_removed"], &cleared["remarks"][0]["key"]), (&0.into(), &"cache-of-others".into()));
    for name in ["mine/anything_scene.npz", "mine/tiles/run/plan.json", "mine/tiles/run/balls/e1_n2.npz"] {
        assert_eq!(place.text(name), "mine");
    }
    assert_eq!(fs::read_dir(place.path("mine")).unwrap().count(), 2);
}

#[cfg(unix)]
#[test]
fn a_pipe_is_refused_at_once_and_never_waited_for() {
    let place = Workplace::new();
    fs::create_dir(place.path("folder")).unwrap();
    place.write_cloud("house.laz", &house());
    place.write_cloud("folder/house.laz", &house());
    for name in ["pipe.laz", "pipe.obj", "pipe.csv", "pipe.npz", "house.prj", "folder/pipe.laz"] {
        assert!(std::process::Command::new("mkfifo").arg(place.path(name)).status().unwrap().success());
    }
    let shadow = "shadow house.laz --sun 180,40 --grid-north -o a.tif";
    for command in ["info pipe.laz", "city plan pipe.laz --sun 180,40 -o run"] {
        place.refusal(1, command, &["is not a file"]);
    }
    place.refusal(1, &format!("{shadow} --add pipe.obj"), &["pipe.obj: is not a file"]);
    place.refusal(1, "viewshed house.laz --observers pipe.csv -o a.tif", &["pipe.csv: is not a file"]);
    assert_eq!(place.summary("info folder")["file"].as_array().map(Vec::len), Some(1));
    assert_eq!(place.run(shadow).status, 0);
}
