//! `belvedere city`: steps, interruptions, damaged tiles.

use crate::common::{Workplace, house, remarks};
use belvedere::control::Control;
use belvedere::io::{Georeference, ReadOptions, read_cloud, write_tif_f32};
use belvedere::raster::Raster;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

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

/// A plan as text with its checksum, after it was changed.
fn sealed(plan: &mut serde_json::Value) -> String {
    plan.as_object_mut().unwrap().remove("checksum");
    let text = plan.to_string();
    let rest = text.strip_prefix('{').unwrap();
    let crc = !rest.bytes().fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(byte), |crc, _| (crc >> 1) ^ if crc & 1 == 1 { 0xedb8_8320 } else { 0 })
    });
    format!("{{\"checksum\":\"{crc:08x}\",{rest}")
}

/// A survey of four tiles of 64 m.
fn town(place: &Workplace) {
    assert_eq!(place.run("simulate village -o town --extent 80 --density 3").status, 0);
}

/// Results that a record says are done, and when each was written.
fn recorded(folder: &Path) -> BTreeMap<String, SystemTime> {
    // one record for the balls of a tile, and the pulses and crowns beside them
    let has_record = |name: &&String| {
        folder.join(name.replace(".pulses.", ".").replace(".crowns.", ".")).with_extension("json").exists()
    };
    let written = |name: &String| std::fs::metadata(folder.join(name)).unwrap().modified().unwrap();
    results(folder).keys().filter(has_record).map(|name| (name.clone(), written(name))).collect()
}

/// Number of records of steps that are done, also while a run writes more.
fn record_count(folder: &Path) -> usize {
    let entries = |folder: PathBuf| folder.read_dir().into_iter().flatten().flatten().map(|entry| entry.path());
    let is_record = |path: &PathBuf| path.extension() == Some("json".as_ref());
    entries(folder.to_owned()).filter(|path| path.is_dir()).flat_map(entries).filter(is_record).count()
}

#[test]
fn a_run_that_is_killed_at_any_moment_goes_on_and_has_the_same_results() {
    let place = Workplace::new();
    town(&place);
    let plan = "city plan town/cloud.laz --sun 150,20 --tile-size 64";
    place.summary(&format!("{plan} -o straight"));
    let start = Instant::now();
    let done = place.summary("city run straight");
    let whole = start.elapsed();
    let steps = done["balls_made"].as_u64().unwrap() + done["answers_made"].as_u64().unwrap();
    assert!(steps >= 8, "{done}");
    place.summary(&format!("{plan} -o killed"));
    let mut moments = Vec::new();
    while moments.len() < 10 {
        let share = f64::from(UNIX_EPOCH.elapsed().unwrap().subsec_nanos() % 1_000_000) / 1e6;
        // at a random moment, or once a step is done: ten runs do not come to the end, however fast they are
        let moment = whole.mul_f64(0.01 + 0.15 * share);
        let (before, before_count) = (recorded(&place.path("killed")), record_count(&place.path("killed")));
        let mut run = place.command("city run killed").stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        let begun = Instant::now();
        while begun.elapsed() < moment && record_count(&place.path("killed")) == before_count {
            std::thread::sleep(Duration::from_millis(1));
        }
        let was_running = run.try_wait().unwrap().is_none();
        // SIGKILL on Unix: nothing is tidied up
        run.kill().unwrap();
        run.wait().unwrap();
        moments.push(moment);
        // what was recorded is not done again, and at most the files of one step are there that are not recorded
        let (after, folder) = (recorded(&place.path("killed")), place.path("killed"));
        assert!(before.iter().all(|(name, written)| after.get(name) == Some(written)), "{moments:?}");
        assert!(results(&folder).len() <= after.len() + 3, "{moments:?}");
        if !was_running {
            break;
        }
    }
    assert!(moments.len() >= 5, "{moments:?}");
    place.summary("city run killed");
    assert!(results(&place.path("straight")) == results(&place.path("killed")), "{moments:?}");
    // what is done is not done again
    let again = place.summary("city run killed");
    assert_eq!((&again["balls_made"], &again["answers_made"]), (&0.into(), &0.into()), "{again}");
    let status = place.summary("city status killed");
    assert_eq!(status["is_complete"], true, "{status}");
    let merged = place.summary("city merge killed -o all.tif");
    assert!(merged["tiles"].as_u64().unwrap() >= 4, "{merged}");
    let catalogue = std::fs::read_to_string(place.path("killed/shadow_150_20.vrt")).unwrap();
    assert_eq!(catalogue.matches("<SourceBand>1<").count() as u64, merged["tiles"].as_u64().unwrap());
}

#[test]
fn tasks_are_the_commands_of_a_run() {
    let place = Workplace::new();
    town(&place);
    place.summary("city plan town/cloud.laz --sun 150,20 --tile-size 64 -o run");
    let tasks = |flags: &str| -> Vec<String> {
        let found = place.summary(&format!("city tasks run {flags}"));
        found["tasks"].as_array().unwrap().iter().map(|task| task.as_str().unwrap().to_owned()).collect()
    };
    let all = tasks("--count 2");
    let expected =
        ["1/2 --balls-only", "2/2 --balls-only", "1/2", "2/2"].map(|s| format!("belvedere city run run --shard {s}"));
    assert_eq!(all, expected);
    assert_eq!([tasks("--count 2 --step balls"), tasks("--count 2 --step results")].concat(), all);
    assert!(tasks("").len() >= 8);
    for task in &all {
        place.summary(task.strip_prefix("belvedere ").unwrap());
    }
    assert_eq!(place.summary("city status run")["is_complete"], true);
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_is_named_leaves_nothing_half_written_and_the_run_goes_on_with_room() {
    let place = Workplace::new();
    town(&place);
    place.summary("city plan town/cloud.laz --sun 150,20 --tile-size 64 -o straight");
    place.summary("city run straight");
    // a file system in memory, in a namespace of its own, where a large file leaves room for the plan and a few tiles;
    // who is not root may not change its size later
    let script = r#"
        mkdir small && mount -t tmpfs -o size=50m tmpfs small || exit 77
        head -c 50700k /dev/zero > small/large
        cp straight/plan.json small/
        "$BELVEDERE" city run small > /dev/null 2> full.txt; echo $? > full.status
        find small -name '.*' -type f > left.txt
        ls small/balls | grep -c json > tiles.txt
        rm small/large && "$BELVEDERE" city run small > /dev/null && cp -r small copied
    "#;
    let run = std::process::Command::new("unshare")
        .args(["-rm", "sh", "-c", script])
        .current_dir(place.path(""))
        .env("BELVEDERE", env!("CARGO_BIN_EXE_belvedere"))
        .output();
    let Some(run) = run.ok().filter(|run| run.status.code() != Some(77) && place.path("small").exists()) else {
        crate::common::skipped("a full disk: this system gives no file system of its own to a test");
        return;
    };
    assert!(run.status.success(), "{run:?}");
    assert_eq!(place.text("full.status").trim(), "1");
    let message = place.text("full.txt");
    assert!(message.contains("small/") && message.contains("the disk is full"), "{message}");
    assert_eq!(place.text("left.txt"), "");
    assert!(place.text("tiles.txt").trim().parse::<u32>().unwrap() > 0);
    assert!(results(&place.path("straight")) == results(&place.path("copied")));
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
fn pieces_of_files_save_reading_and_change_no_result() {
    let place = Workplace::new();
    assert_eq!(place.run("simulate village -o town --extent 200 --density 3").status, 0);
    // a high sun, so that a quarter of the tiles needs few others
    let plan = "city plan town/cloud.laz --sun 150,80 --tile-size 64 --cell 2";
    place.summary(&format!("{plan} -o pieces"));
    place.summary(&format!("{plan} -o whole"));
    let mut whole: serde_json::Value = serde_json::from_str(&place.text("whole/plan.json")).unwrap();
    let pieces = whole["inputs"][0].as_object_mut().unwrap().remove("pieces").unwrap();
    let points = whole["inputs"][0]["points"].as_u64().unwrap();
    assert_eq!(pieces.as_array().unwrap().len() as u64, points.div_ceil(50_000));
    assert!(points > 100_000, "{points}");
    place.write("whole/plan.json", &sealed(&mut whole));
    for run in ["pieces", "whole"] {
        place.summary(&format!("city run {run} --shard 1/4"));
    }
    let [found, expected] = ["pieces", "whole"].map(|run| results(&place.path(run)));
    assert!(found.len() > 8, "{}", found.len());
    assert!(found == expected, "the results differ");
    // pieces of another file are no plan
    whole["inputs"][0]["pieces"] = serde_json::json!([[0, 0, 1, 1]]);
    place.write("whole/plan.json", &sealed(&mut whole));
    place.refusal(1, "city run whole", &["plan.json", "damaged"]);
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
    place.refusal(2, &format!("{plan} --sky-view --cell-for sky=2"), &["--cell-for", "sky-view", "viewshed"]);
    place.refusal(2, &format!("{plan} --sky-view --cell-for sky-view=-1"), &["--cell-for", "above zero"]);
    place.refusal(2, &format!("{plan} --sky-view --cell-for sky-view=0.3"), &["--cell-for", "sixty-fourths"]);
    place.refusal(2, &format!("{plan} --sky-view --cell-for shadow=2"), &["--cell-for shadow", "--sun"]);
    let twice = "--cell-for sky-view=2 --cell-for sky-view=4";
    place.refusal(2, &format!("{plan} --sky-view {twice}"), &["--cell-for", "sky-view is given twice"]);
    place.refusal(2, &format!("{plan} --sky-view --memory 3"), &["--memory", "3G"]);
    place.refusal(2, &format!("{plan} --sky-view --memory 101M"), &["--memory", "101 MB"]);
    place.refusal(2, &format!("{plan} --sun-hours"), &["--sun-hours", "--date"]);
    place.refusal(2, &format!("{plan} --sky-view --date 2026-03-21"), &["--date", "--sun-hours"]);
    place.refusal(2, &format!("{plan} --irradiance"), &["--weather", "--clear-sky"]);
    place.refusal(2, &format!("{plan} --clear-sky bird"), &["--irradiance"]);
    let through = "--through-trees seasons";
    place.refusal(2, &format!("{plan} --sky-view --interval {through}"), &["--interval", "trees"]);
    place.refusal(2, &format!("{plan} --sun 150,20 --probability {through}"), &["--probability", "trees"]);
    place.refusal(2, &format!("{plan} --sky-view --probability"), &["--probability", "--sun", "--observer"]);
    place.refusal(2, &format!("{plan} --sun 150,20 --interval"), &["--interval", "--sky-view"]);
    place.refusal(2, &format!("{plan} --time 2026-03-20T02:00+01:00"), &["--time", "horizon"]);
    place.refusal(2, &format!("{plan} --sun 150,20 --sun 150,20"), &["shadow_150_20 twice"]);
    place.refusal(2, &format!("{plan} --sky-view --clear class:2"), &["--clear", "stands on the ground"]);
    place.refusal(2, &format!("{plan} --sky-view --clear 0,0,9,9"), &["--clear", "on the cloud"]);
    place.refusal(2, &format!("{plan} --observer 10,10"), &["--observer", "10, 10", "height"]);
    place.refusal(1, "city run nowhere", &["plan.json", "belvedere city plan"]);
    // scans from the ground are no survey of tiles, and it is said what else to do
    assert_eq!(place.run("simulate village -o scans --extent 60 --scanner terrestrial --angle-step-deg 1").status, 0);
    let words = ["scans/cloud.laz", "from the ground", "`shadow`"];
    place.refusal(1, "city plan scans/cloud.laz -o other --sky-view", &words);
    // before the survey is read: no stage is reported
    place.write("no.obj", "o nothing\n");
    for (flags, words) in [
        ("-o other --sky-view --add no.obj", ["no.obj", "faces"]),
        ("-o other --sky-view --add .", ["error: .: ", "mesh"]),
        ("-o other --sky-view --clear gone.geojson", ["gone.geojson", "check the path"]),
        ("-o other --sky-view --terrain no.obj", ["no.obj", "TIFF"]),
        ("-o other --sky-view --terrain gone.tif", ["gone.tif", "check the path"]),
        ("-o other --sky-view --horizon no.obj", ["no.obj", "azimuth"]),
        ("-o other --irradiance --weather no.obj", ["no.obj", "weather"]),
        ("-o no.obj --sky-view", ["no.obj", "a folder is needed"]),
    ] {
        let run = place.run(&format!("--progress json city plan town/cloud.laz {flags}"));
        assert!(run.status == 1 && words.iter().all(|word| run.stderr.contains(word)), "{flags}: {run:?}");
        assert!(!run.stderr.contains("surveying") && !place.path("other").exists(), "{flags}: {run:?}");
    }
    place.summary(&format!("{plan} --sky-view --directions 49 --sun 150,20"));
    place.refusal(2, "city run run --shard 3/2", &["--shard", "1/N"]);
    place.refusal(2, "city merge run -o all.tif", &["--result", "sky_view_factor"]);
    let again = "again with `belvedere city plan`";
    let text = place.text("run/plan.json");
    let layout = text.replacen("\"layout\":", "\"layout\":9", 1);
    for (plan, word) in [("{}", "no plan"), (&text[..text.len() / 2], "damaged"), (&layout, "layout 9")] {
        std::fs::write(place.path("run/plan.json"), plan).unwrap();
        place.refusal(1, "city run run", &["plan.json", word, again]);
    }
    std::fs::write(place.path("run/plan.json"), text).unwrap();
    // a plan takes the place of another that has no results yet, and leaves one that has them as it is
    place.summary(&format!("{plan} --sun 150,30 --cell 2"));
    place.summary(&format!("{plan} --sun 150,20 --cell 2"));
    place.summary("city run run");
    place.refusal(1, &format!("{plan} --sun 150,30 --cell 2"), &["run/plan.json", "another plan", "another folder"]);
    // a damaged plan is made again, and its results are those that are there
    std::fs::write(place.path("run/plan.json"), "{").unwrap();
    place.summary(&format!("{plan} --sun 150,20 --cell 2"));
    assert_eq!(place.summary("city status run")["is_complete"], true);
}

#[test]
fn a_cleared_area_loses_its_shadow_and_keeps_its_cells() {
    let place = Workplace::new();
    town(&place);
    // all of the survey: only the ground is left
    let area = "[[154900,462900],[155100,462900],[155100,463100],[154900,463100],[154900,462900]]";
    let polygon = format!("{{\"type\": \"Polygon\", \"coordinates\": [{area}]}}");
    place.write("all.geojson", &polygon);
    let plan = "city plan town/cloud.laz --sun 150,20 --cell 2 --tile-size 64";
    let lit = |name: &str, flags: &str| {
        place.summary(&format!("{plan} {flags} -o {name}"));
        place.summary(&format!("city run {name}"));
        place.summary(&format!("city merge {name} -o {name}.tif"));
        let raster = belvedere::io::read_tif_u8(&place.path(&format!("{name}.tif"))).unwrap();
        [0, 1].map(|code| raster.values().iter().filter(|&&value| value == code).count())
    };
    let [dark, light] = lit("before", "");
    let [still_dark, now_light] = lit("polygon", "--clear all.geojson");
    assert!(dark > 200 && still_dark * 50 < now_light, "{dark} {light} {still_dark} {now_light}");
    assert!(still_dark + now_light >= dark + light, "{dark} {light} {still_dark} {now_light}");
    assert_eq!(lit("box", "--clear 154900,462900,155100,463100"), [still_dark, now_light]);
    let warnings = |flags: &str| place.summary(&format!("{plan} {flags} -o warned"))["remarks"].to_string();
    assert!(warnings("--clear class:77").contains("nothing stands there"));
    // one of two is enough
    assert!(!warnings("--clear class:77 --clear all.geojson").contains("nothing stands there"));
}

#[test]
fn questions_are_those_of_the_commands_they_are_named_after() {
    let place = Workplace::new();
    // a viewshed of 30 m lies on it
    assert_eq!(place.run("simulate village -o town --extent 130 --density 3").status, 0);
    let flags = "--time 2026-03-20T12:45+01:00 --sun-hours --date 2026-03-20 --time-step-min 60 --irradiance --clear-sky haurwitz \
                 --patch-division 1 --sun-cell-deg 20 --observer 155000,462985 --max-distance 30";
    let cells = "--cell 4 --cell-for shadow=2";
    let plan = place.summary(&format!("city plan town/cloud.laz -o run --tile-size 128 {cells} {flags}"));
    assert_eq!(plan["results"], serde_json::json!(["shadow_20260320_1245", "sun_hours", "irradiance", "viewshed"]));
    let kept: serde_json::Value = serde_json::from_slice(&place.bytes("run/plan.json")).unwrap();
    assert_eq!(kept["questions"][0]["question"]["shadow"]["suns"]["times"][0], "2026-03-20T12:45+01:00");
    place.summary("city run run");
    let grey = |name: &str| {
        place.summary(&format!("city merge run --result {name} -o {name}.tif"));
        belvedere::io::read_tif(place.path(&format!("{name}.tif")).as_path()).unwrap().values
    };
    let (hours, energy) = (grey("sun_hours"), grey("irradiance"));
    let max = |values: &[f32]| values.iter().copied().fold(0.0, f32::max);
    // half of a day at an equinox, and the energy of a clear year at 52 degrees, about 1700 kWh
    assert!((11.0..12.4).contains(&max(hours.values())), "{}", max(hours.values()));
    assert!((1600.0..1800.0).contains(&max(energy.values())), "{}", max(energy.values()));
    place.summary("city merge run --result viewshed -o seen.tif");
    let seen = belvedere::io::read_tif_u8(&place.path("seen.tif")).unwrap();
    let of_code = |code: u8| seen.values().iter().filter(|&&value| value == code).count();
    // a disc of 30 m, on cells of 16 m²
    assert!((150..200).contains(&(of_code(0) + of_code(1))), "{} {}", of_code(0), of_code(1));
    assert!(of_code(1) > 20 && of_code(2) == 0, "{}", of_code(1));
    let raster = |name: &str| belvedere::io::read_tif(place.path(&format!("{name}.tif")).as_path()).unwrap();
    let cell = |name: &str| raster(name).place.unwrap().column_step[0];
    // rasters say what they hold, as those of single scenes do: other quantities are neither subtracted without a word
    // nor taken for terrain
    let shadow = "shadow_20260320_1245";
    place.summary(&format!("city merge run --result {shadow} -o {shadow}.tif"));
    let what = |name: &str| belvedere::io::read_tif(place.path(name).as_path()).unwrap().description.unwrap();
    let title = "share of the sun, 0 in shadow; Shadow, 2026-03-20T12:45:00+01:00";
    assert_eq!(what(&format!("{shadow}.tif")), title);
    assert_eq!([cell(shadow), cell("sun_hours")], [2.0, 4.0]);
    let catalogue = place.text(&format!("run/{shadow}.vrt"));
    assert!(catalogue.contains(&format!(">{title}</MDI>")), "{catalogue}");
    for (band, name) in [(1, "lit"), (2, "unproven")] {
        let head = format!("band=\"{band}\">\n    <Description>{name}</Description>");
        assert!(catalogue.contains(&head), "{catalogue}");
    }
    assert_eq!(what("seen.tif"), "1 nothing blocks it, 0 blocked, 255 nodata");
    assert_eq!(raster("seen").further_bands[0].name, "unproven");
    let tile = std::fs::read_dir(place.path("run/sun_hours")).unwrap().map(|entry| entry.unwrap().path());
    let tile = tile.into_iter().find(|path| path.extension().is_some_and(|extension| extension == "tif")).unwrap();
    let of_tile = belvedere::io::read_tif(tile.as_path()).unwrap().description;
    assert_eq!(
        (of_tile, what("sun_hours.tif")),
        (Some("hours of sun a day".to_owned()), "hours of sun a day".to_owned())
    );
    place.summary("difference sun_hours.tif sun_hours.tif -o same.tif");
    let run = place.run("difference sun_hours.tif irradiance.tif -o other.tif");
    assert!(run.status == 0 && run.stderr.contains("different quantities"), "{run:?}");
    place.write_cloud("house.laz", &house());
    let shadow = "shadow house.laz --orient given --scene-config ../tau.json --sun 180,25 --cell 1 -o lit.csv";
    place.refusal(1, &format!("{shadow} --terrain irradiance.tif"), &["irradiance.tif", "energy of the period"]);
}

#[test]
fn a_plan_says_of_weather_and_terrain_what_single_commands_say() {
    let place = Workplace::new();
    town(&place);
    let (mut cloud, _) = read_cloud([place.path("town/cloud.laz")], &ReadOptions::default(), &Control::none()).unwrap();
    // near the sea, where feet are not far from metres
    cloud.frame.origin[2] += 10.0;
    place.write_cloud("high.laz", &cloud);
    // noons of a place a thousand kilometres away
    let mut weather = "Latitude (decimal degrees): 40\nLongitude (decimal degrees): 4.4\nElevation (m): 0.0\n\
                       Irradiance Time Offset (h): 0\nmonth,year\n1,2015\ntime(UTC),T2m,RH,G(h),Gb(n),Gd(h)\n"
        .to_owned();
    for month in 1..=12 {
        weather += &format!("2015{month:02}15:1200,10.0,80.0,300.0,200.0,150.0\n");
    }
    place.write("elsewhere.csv", weather);
    let write_terrain = |name: &str, metres_per_unit: f64| {
        #[expect(clippy::cast_possible_truncation, reason = "a height")]
        let height = (10.0 / metres_per_unit) as f32;
        let raster = Raster::from_values(40, 40, vec![height; 1600]).unwrap();
        let georeference = Georeference {
            upper_left: [cloud.frame.origin[0] - 1000.0, cloud.frame.origin[1] + 1000.0],
            column_step: [50.0, 0.0],
            row_step: [0.0, -50.0],
            crs: cloud.frame.crs.clone(),
        };
        write_tif_f32(place.path(name).as_path(), &raster, Some(&georeference), None, None).unwrap();
    };
    write_terrain("metres.tif", 1.0);
    write_terrain("feet.tif", 0.3048);
    let about = |summary: &serde_json::Value| -> Vec<String> {
        let is_about = |remark: &String| remark.contains("weather") || remark.contains("terrain");
        let mut found: Vec<String> = remarks(summary).into_iter().filter(is_about).collect();
        found.sort();
        found
    };
    for (terrain, count) in [("metres.tif", 0), ("feet.tif", 1)] {
        let flags = format!("--weather elsewhere.csv --terrain {terrain} --cell 4");
        let plan = place.summary(&format!("city plan high.laz --irradiance {flags} -o {terrain}.run"));
        let single = place.summary(&format!("irradiance high.laz {flags} -o single.tif"));
        let (said, expected) = (about(&plan), about(&single));
        assert!(said.iter().any(|remark| remark.contains("km away")), "{said:?}");
        assert_eq!(said.iter().filter(|remark| remark.contains("look like feet")).count(), count, "{said:?}");
        // the difference is measured on other points
        let without = |remarks: &[String]| -> Vec<String> {
            remarks.iter().filter(|remark| !remark.contains("look like feet")).cloned().collect()
        };
        assert_eq!(without(&said), without(&expected));
        assert_eq!(said.len(), expected.len(), "{said:?} {expected:?}");
    }
}
