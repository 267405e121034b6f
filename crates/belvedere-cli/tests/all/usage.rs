//! Exit status, output streams, and what stays in the folder when a run fails.

use crate::common::{Workplace, house};
use belvedere::Frame;
use belvedere::PointCloud;
use belvedere::crs::Crs;
use std::process::Stdio;

#[test]
fn a_run_that_succeeds_speaks_on_standard_output_alone_and_leaves_only_its_output() {
    let place = Workplace::with_house();
    let run = place.run("balls house.laz -o balls.npz");
    assert_eq!((run.status, run.stderr.as_str()), (0, ""));
    assert!(run.stdout.ends_with("written: balls.npz\n"), "{}", run.stdout);
    // no bar and no escape sequence in a pipe
    assert!(!run.stdout.contains(['\u{1b}', '\r']), "{:?}", run.stdout);
    assert_eq!(place.names(), ["balls.npz", "house.laz"]);
}

/// Lines of a summary without `--verbose`.
const SHORT: usize = 12;

#[test]
fn the_answer_comes_first_in_twelve_lines_and_all_figures_with_verbose() {
    let place = Workplace::with_house();
    let outputs = |ending: &str| (0..6).map(|i| format!(" -o {i}.{ending}")).collect::<String>();
    let (maps, tables) = (outputs("tif"), outputs("csv"));
    for (command, answer) in [
        ("balls house.laz -o balls.npz".to_owned(), "balls from "),
        ("normals house.laz -o normals.laz".to_owned(), "normals of "),
        (format!("shadow house.laz --sun 180,30 --cell 1{maps}"), "lit"),
        (format!("viewshed house.laz --observer 85000,445988 --cell 1{maps}"), "visible "),
        ("query house.laz --sun 180,30 --random 500 -o answers.csv".to_owned(), "visible "),
        (
            "line-of-sight house.laz --observer 85000,445988,2 --target 85000,446012,2".to_owned(),
            "line of sight: blocked",
        ),
        (format!("sky-view house.laz --cell 4{maps}"), "sky view factor"),
        (format!("isovist house.laz --observer 85000,445988,2{tables}"), "space seen by 1 observer: "),
    ] {
        let run = place.run(&command);
        let lines: Vec<&str> = run.stdout.lines().collect();
        assert_eq!(run.status, 0, "{command}: {run:?}");
        assert!((2..=SHORT).contains(&lines.len()), "{command}: {}", run.stdout);
        assert!(lines.iter().any(|line| line.contains(answer)), "{command}: {}", run.stdout);
        if command.matches(" -o ").count() == 6 {
            assert_eq!(
                lines[lines.len() - 2..],
                ["written: 3.".to_owned() + &command[command.len() - 3..], "and 2 more files".to_owned()]
            );
        }
        let (whole, json) = (place.run(&format!("{command} -v")).stdout, place.summary(&command));
        assert!(whole.lines().count() > SHORT && whole.contains("\nseconds\n"), "{command}: {whole}");
        for name in json.as_object().unwrap().keys().filter(|name| !["headline", "remarks"].contains(&name.as_str())) {
            let is_empty = json[name].as_array().is_some_and(Vec::is_empty);
            assert!(is_empty || whole.contains(&name.replace('_', " ")), "{command}: {name} is not in {whole}");
        }
        if let Some(headline) = json["headline"].as_array() {
            assert!(headline.iter().all(|line| lines.contains(&line.as_str().unwrap())), "{command}: {headline:?}");
        }
    }
}

#[test]
fn json_is_one_object_with_the_content_of_the_text() {
    let place = Workplace::with_house();
    let text = place.run("info house.laz --verbose").stdout;
    let json = place.summary("info house.laz");
    let object = json.as_object().unwrap();
    for (name, value) in object.iter().filter(|(name, _)| *name != "headline") {
        let is_empty = value.as_array().is_some_and(Vec::is_empty) || value.as_object().is_some_and(|o| o.is_empty());
        assert_eq!(text.contains(&name.replace('_', " ")), !is_empty, "{name} in {text}");
    }
    assert!(text.contains(&format!("points: {}\n", object["points"])));
}

#[test]
fn quiet_prints_nothing_but_does_the_work() {
    let place = Workplace::with_house();
    let run = place.run("balls house.laz -o balls.npz --quiet");
    assert_eq!((run.status, run.stdout.as_str(), run.stderr.as_str()), (0, "", ""));
    assert!(place.path("balls.npz").is_file());
    place.refusal(1, "info missing.laz --quiet", &["missing.laz"]);
}

#[test]
fn verbose_prints_the_time_of_each_stage_on_standard_error() {
    let place = Workplace::with_house();
    let run = place.run("balls house.laz -o balls.npz -v");
    assert!(run.stderr.contains("shrinking balls: ") && run.stderr.ends_with(" s\n"), "{}", run.stderr);
    assert!(!run.stderr.contains('\u{1b}'));
}

#[test]
fn a_reader_that_stops_listening_is_no_failure() {
    let place = Workplace::with_house();
    for arguments in ["completions bash", "man", "info house.laz", "--help", "help query"] {
        let mut command = place.command(arguments);
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!((output.status.code(), stderr.as_str()), (Some(0), ""), "{arguments}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_behind_standard_output_is_a_failure() {
    let place = Workplace::with_house();
    for arguments in ["completions bash", "man", "info house.laz"] {
        let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        let output = place.command(arguments).stdout(full).output().unwrap();
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "{arguments}");
        assert!(stderr.contains("standard output"), "{arguments}: {stderr}");
    }
}

#[test]
fn files_that_cannot_be_used_are_named() {
    let place = Workplace::with_house();
    let laz = place.bytes("house.laz");
    place.write("truncated.laz", &laz[..laz.len() * 6 / 10]);
    place.write("empty.laz", "");
    place.write("empty.xyz", "");
    place.write("words.xyz", "lorem ipsum dolor\nsit amet consectetur\n");
    place.write("comma.csv", "1,5 2,5 3,5\n2,5 2,5 3,5\n");
    place.write("other.docx", "1 2 3\n");
    for (name, word) in [
        ("missing.laz", "there is no such file or folder; check the path\n"),
        ("truncated.laz", ""),
        ("empty.laz", ""),
        ("empty.xyz", "no points"),
        ("words.xyz", ""),
        ("comma.csv", "decimal commas"),
        ("other.docx", ".laz"),
        ("missing.npz", ""),
    ] {
        for command in ["info", "normals -o out.laz", "balls -o out.npz", "depth-map --sun 180,30 -o out.tif"] {
            place.refusal(1, &format!("{command} {name}"), &["error: ", name, word]);
        }
        place.refusal(1, &format!("query --sun 180,30 --self -o out.laz {name}"), &["error: ", name]);
        place.refusal(1, &format!("query --sun 180,30 --targets {name} -o out.csv house.laz"), &["error: ", name]);
    }
    // what is left of a file that is not compressed is a cloud, which must not look whole
    place.write_cloud("whole.las", &house());
    let las = place.bytes("whole.las");
    place.write("half.las", &las[..las.len() / 2]);
    for command in ["info", "balls -o half.npz", "query --sun 180,30 --random 9 -o half.csv"] {
        let run = place.run(&format!("{command} half.las"));
        assert!(run.status == 0 && run.stderr.contains("half.las: the file is cut off"), "{run:?}");
    }
    place.refusal(1, "city plan half.las --sky-view -o out", &["half.las", "cut off"]);
    place.write("damaged.npz", "PK but no archive");
    place.refusal(1, "query --sun 180,30 --random 9 -o out.csv damaged.npz", &["damaged.npz: damaged, or not a ball"]);
    assert!(place.names().iter().all(|name| !name.contains("out")), "{:?}", place.names());
}

#[test]
fn damaged_laz_files_give_one_line_or_a_result_whatever_happens_in_the_decoder() {
    let place = Workplace::with_house();
    let laz = place.bytes("house.laz");
    let mut refused = 0;
    for at in (laz.len() / 3..laz.len()).step_by(laz.len() / 40) {
        let mut damaged = laz.clone();
        // a stretch of set bits makes the decoder panic where a single flipped bit seldom does
        damaged[at..(at + 12).min(laz.len())].fill(0xff);
        place.write("damaged.laz", &damaged);
        let run = place.run("info damaged.laz");
        let lines: Vec<&str> = run.stderr.lines().collect();
        match run.status {
            0 => assert!(lines.is_empty(), "{lines:?}"),
            _ => {
                refused += 1;
                assert!(lines.len() == 1 && lines[0].contains("damaged.laz"), "{lines:?}");
            }
        }
    }
    assert!(refused > 3, "only {refused} files were refused");
}

#[test]
fn degrees_are_refused_with_the_conversion_to_run() {
    let place = Workplace::new();
    let degrees =
        PointCloud { frame: Frame { origin: [5.4, 52.2, 0.0], crs: Crs::from_epsg(4326).unwrap() }, ..house() };
    let small = degrees.positions.iter().map(|p| [p[0] * 1e-5, p[1] * 1e-5, p[2]]).collect();
    place.write_cloud("degrees.las", &PointCloud { positions: small, ..degrees });
    for command in ["info", "balls -o out.npz", "query --sun 180,30 --self -o out.laz"] {
        let words = ["degrees.las", "in degrees", "pdal translate", "EPSG:32631"];
        place.refusal(1, &format!("{command} degrees.las"), &words);
    }
    assert_eq!(place.names(), ["degrees.las"]);
}

#[test]
fn wrong_usage_names_the_flag_and_ends_with_status_2() {
    let place = Workplace::with_house();
    place.write("targets.csv", "x,y,z\n85000,446000,1\n");
    place.summary("balls house.laz -o balls.npz");
    for (arguments, words) in [
        ("info house.laz --no-such-flag", &["--no-such-flag"][..]),
        ("no-such-command", &["no-such-command"]),
        ("info", &["<CLOUD>"]),
        ("info house.laz --threads 0", &["--threads", "1 to 1024"]),
        ("info house.laz --threads many", &["--threads", "1 to 1024"]),
        ("info house.laz --seed -1", &["-1"]),
        ("info house.laz --device quick", &["--device", "give auto"]),
        #[cfg(not(feature = "gpu"))]
        ("info house.laz --device gpu", &["--device gpu", "--features gpu"]),
        #[cfg(not(feature = "gpu"))]
        ("info house.laz --device 7", &["--device 7", "--features gpu"]),
        ("info house.laz --device -1", &["'-1'", "give auto"]),
        ("info house.laz --json --quiet", &["--json", "--quiet"]),
        ("balls house.laz -o out.docx", &["-o out.docx", ".npz .ply .laz .las"]),
        ("balls house.laz -o out.npz --nan", &["--nan", "without extension"]),
        ("balls house.laz -o out --simplify 0", &["--simplify", "above zero"]),
        ("balls house.laz -o out --simplify -1", &["--simplify", "above zero"]),
        ("balls house.laz -o out --cell 1", &["--simplify"]),
        ("balls house.laz -o out.npz --method tau --first-angle 30", &["--first-angle", "--method angles"]),
        ("balls house.laz -o out.npz --first-angle 30", &["--first-angle", "--method angles"]),
        ("balls house.laz -o out --penetration 0.1", &["--penetration", "--method tau"]),
        ("balls house.laz -o out.npz --penetration -1", &["--penetration", "above 0"]),
        ("balls house.laz -o out.npz --initial-radius 0", &["--initial-radius", "above 0"]),
        ("balls house.laz -o out.npz --max-radius -1", &["--max-radius", "above 0"]),
        ("balls house.laz -o out.npz --initial-radius nan", &["--initial-radius"]),
        ("balls house.laz -o out --first-angle 200", &["--first-angle", "180"]),
        ("balls house.laz -o out.npz --neighbors some", &["--neighbors", "adaptive"]),
        ("balls house.laz -o out.npz --orient up --neighbors 2", &["--neighbors", "3 to 256"]),
        ("balls house.laz -o out.npz --orient sideways", &["--orient", "trajectory=FILE"]),
        ("balls house.laz -o out.npz --orient scanner=1,2", &["--orient", "3 numbers"]),
        ("balls house.laz -o out.npz --side both", &["--side", "interior"]),
        ("normals house.laz -o out.npy", &["-o out.npy", ".laz"]),
        ("depth-map house.laz -o out.tif", &["--viewport", "--sun", "--direction"]),
        ("depth-map house.laz --sun 180,30 --direction 0,0,-1 -o out.tif", &["--sun", "--direction"]),
        ("depth-map house.laz --sun 180,30 -o out.jpg", &["-o out.jpg", ".tif"]),
        ("depth-map house.laz --sun 180,30 -o out.tif --ball-ids out.png", &["--ball-ids out.png", ".npy"]),
        ("depth-map house.laz --sun 180,30 -o out.tif --ball-ids out.tif", &["--ball-ids"]),
        ("depth-map house.laz --sun 180,30 --pixel 0 -o out.tif", &["--pixel", "above zero"]),
        ("depth-map house.laz --sun 180,30 --pixel -1 -o out.tif", &["--pixel", "above zero"]),
        ("depth-map house.laz --sun 180,30 --pixel nan -o out.tif", &["--pixel", "above zero"]),
        ("depth-map house.laz --sun 180 -o out.tif", &["--sun", "2 numbers"]),
        ("depth-map house.laz --sun 180,-5 -o out.tif", &["--sun", "0 to 90"]),
        ("depth-map house.laz --sun south,30 -o out.tif", &["--sun", "not a number"]),
        ("depth-map house.laz --sun inf,30 -o out.tif", &["--sun", "finite"]),
        ("depth-map house.laz --direction 0,0,0 -o out.tif", &["--direction"]),
        ("depth-map house.laz --viewport 1,2,3 -o out.tif", &["--viewport", "four parts"]),
        ("query house.laz --sun 180,30 -o out.csv", &["--targets", "--random", "--self"]),
        ("query house.laz --sun 180,30 --self --random 5 -o out.csv", &["--self", "--random"]),
        ("query house.laz --self -o out.csv", &["--viewport", "--sun", "--direction"]),
        ("query house.laz --sun 180,30 --self -o out.tif", &["-o out.tif", ".csv"]),
        ("query house.laz --sun 180,30 --random 0 -o out.csv", &["--random", "1 to"]),
        ("query house.laz --sun 180,30 --random 1e3 -o out.csv", &["--random", "whole number"]),
        ("query house.laz --sun 180,30 --random 999999999999 -o out.csv", &["--random", "1 to"]),
        ("query house.laz --sun 180,30 --random 5 --bias inf -o out.csv", &["--bias", "finite"]),
        ("query balls.npz --sun 180,30 --self -o out.csv", &["--self", "ball file"]),
        (
            "query balls.npz --sun 180,30 --random 5 --scene-config ../angles.json -o out.csv",
            &["angles.json", "method", "balls.npz"],
        ),
        ("shadow house.laz --sun 180,30 --keep-noise -o out.tif", &["--keep-noise", "--scene-config", "keep_noise"]),
        ("viewshed house.laz --observer 1,2 --method tau -o out.tif", &["--method", "'viewshed'", "belvedere balls"]),
        ("isovist house.laz --observer 1,2 --ball-profile sphere -o out.csv", &["--scene-config", "ball_profile"]),
        ("query balls.npz --sun 180,30 --random 5 --orient up -o out.csv", &["--orient", "balls.npz"]),
        ("query balls.npz --sun 180,30 --random 5 --crs EPSG:28992 -o out.csv", &["--crs", "balls.npz", "--location"]),
    ] {
        place.refusal(2, arguments, words);
    }
    assert_eq!(place.names(), ["balls.npz", "house.laz", "targets.csv"]);
}

#[test]
fn flags_that_would_change_nothing_are_refused() {
    let place = Workplace::with_house();
    place.write("w.epw", "");
    for arguments in [
        "sun-calendar a.laz --windows w.csv --date 2026-06-21 --target-height 5 -o c.csv",
        "comfort a.laz --windows w.csv --date 2026-06-21 --distance-step-m 1 -o c.csv",
        "comfort a.laz --windows w.csv --date 2026-06-21 --target-height 5 -o c.csv",
        "comfort a.laz --windows w.csv --date 2026-06-21 --routes r.csv -o c.csv",
        "comfort a.laz --windows w.csv --date 2026-06-21 --times t.csv -o c.csv",
        "comfort a.laz --route r.geojson --date 2026-06-21 --spacing 2 -o c.csv",
        "landmark a.laz --target-class 6 --object x -o l.csv",
        "landmark a.laz --target-polygon p.geojson --spacing 2 -o l.csv",
        "landmark a.laz --target-class 6 --back-faces left-out -o l.csv",
        "protected-view a.laz --target-class 6 --observer 1,2,3 --object x -o p.tif",
        "cameras a.laz --on-ground 15 --distance-step-m 1 -o c.csv",
        "survey-plan a.laz --sun 180,30 --on-ground 20 --whole-lines -o s.csv",
        "survey-plan a.laz --sun 180,30 --on-roofs 20 --distance-step-m 1 -o s.csv",
        "irradiance a.laz --weather w.epw --year 2020 -o i.tif",
        "irradiance house.laz --weather w.epw --planes p.csv --edge-mask e.tif",
        "irradiance house.laz --weather w.epw --planes p.csv --cell 3",
        "line-of-sight a.laz --random 10 --profile-out p.csv -o s.csv",
        "line-of-sight a.laz --random 10 --distance-step-m 1 -o s.csv",
        "envelope a.laz --parcel p.geojson --protect q.geojson --sun 180,30 --from 2026-06-21 --to 2026-06-22 -o e.tif",
    ] {
        let run = place.run(arguments);
        assert!(run.status == 2 && !run.stderr.contains("No such file"), "{arguments}: {}", run.stderr);
    }
}

#[test]
fn errors_about_parameters_name_the_flag_that_gave_them() {
    let place = Workplace::with_house();
    let look = "depth-map house.laz -o out.png --eye 1,1,1 --look-at 2,1,1";
    for (arguments, message) in [
        ("balls house.laz -o out.npz --method tau --penetration -1", "--penetration: penetration is -1, but must be"),
        (
            "sky-view house.laz -o out.csv --directions 100001",
            "--directions: number of directions is 100001, but must be",
        ),
        ("horizon house.laz -o out.csv --observer 1,2 --angle-step-deg 7", "--angle-step-deg: step of angles"),
        // one parameter that either of two flags gives
        ("balls house.laz -o out.npz --method angles --first-angle 200", "--first-angle: separation angle is 200"),
        ("balls house.laz -o out.npz --method angles --next-angle 200", "--next-angle: separation angle is 200"),
        (&format!("{look} --near 5 --far 4"), "--near: near and far limit is"),
    ] {
        place.refusal(2, arguments, &[&format!("error: {message}")]);
    }
}

#[test]
fn sizes_beyond_reason_are_refused_before_memory_is_reserved() {
    let place = Workplace::with_house();
    for flags in ["--sun 180,30 --pixel 1e-9", "--direction 0,0,-1 --pixel 1e-300"] {
        let words = ["error: --pixel: ", "268435456 pixels"];
        place.refusal(2, &format!("depth-map house.laz {flags} -o out.tif"), &words);
        place.refusal(2, &format!("query house.laz --self {flags} -o out.laz"), &words);
    }
    for viewport in ["0,0,0 1e9,0,0 0,-1e9,0 100", "0,0,0 1e100,0,0 0,-1e100,0 1e100", "0,0,0 1,0,0 0,-1,0 1e200"] {
        let words = ["--viewport", "268435456 pixels"];
        place.refusal_with(2, "depth-map house.laz -o out.tif --viewport", &[viewport], &words);
    }
    for viewport in ["0,0,0 1,0,0 1,1,0 4", "0,0,0 1,0,0 0,-1,0 0", "0,0,0 0,0,0 0,-1,0 4", "0,0,0 1,0,0 0,-1,0 -4"] {
        place.refusal_with(2, "depth-map house.laz -o out.tif --viewport", &[viewport], &["--viewport"]);
    }
    assert_eq!(place.names(), ["house.laz"]);
}

#[test]
fn an_output_in_a_folder_that_is_not_there_is_refused_at_once() {
    let place = Workplace::with_house();
    for arguments in [
        "normals house.laz -o nowhere/out.laz",
        "normals house.laz -o nowhere/out",
        "balls house.laz -o nowhere/out.npz",
        "balls house.laz -o nowhere/out",
        "depth-map house.laz --sun 180,30 -o nowhere/out.tif",
        "depth-map house.laz --sun 180,30 -o out.tif --ball-ids nowhere/out.npy",
        "query house.laz --sun 180,30 --self -o nowhere/out.csv",
    ] {
        let run = place.refusal(1, &format!("{arguments} -v"), &["nowhere/out", "does not exist", "create it"]);
        assert!(!run.stderr.contains("reading"), "nothing is read before: {}", run.stderr);
    }
    assert_eq!(place.names(), ["house.laz"]);
}

#[test]
fn a_run_that_fails_leaves_an_earlier_output_as_it_was() {
    let place = Workplace::with_house();
    let laz = place.bytes("house.laz");
    place.write("truncated.laz", &laz[..laz.len() / 2]);
    place.write("far.csv", "x,y,z\n85000,446000,1\nnan,446000,1\n");
    for (output, arguments) in [
        ("out.laz", "normals truncated.laz"),
        ("out.npz", "balls truncated.laz"),
        ("out.tif", "depth-map truncated.laz --sun 180,30"),
        ("out.csv", "query house.laz --sun 180,30 --targets far.csv"),
        ("out.csv", "query house.laz --sun 180,30 --targets missing.csv"),
    ] {
        place.write(output, "before");
        place.refusal(1, &format!("{arguments} -o {output}"), &["error: "]);
        assert_eq!(place.text(output), "before");
    }
    let names = ["far.csv", "house.laz", "out.csv", "out.laz", "out.npz", "out.tif", "truncated.laz"];
    assert_eq!(place.names(), names);
}

#[test]
fn an_earlier_output_is_replaced_by_a_complete_one() {
    let place = Workplace::with_house();
    place.write("balls.npz", "before");
    place.summary("balls house.laz -o balls.npz");
    assert!(place.npz::<f32>("balls.npz", "radii").len() > 1000);
    assert_eq!(place.names(), ["balls.npz", "house.laz"]);
}

#[test]
fn help_shows_the_options_of_a_command_before_those_of_all_commands() {
    let place = Workplace::new();
    for (command, own) in
        [("shadow", "Sun:"), ("viewshed", "Observers (one of):"), ("sky-view", "Sky:"), ("balls", "Normals:")]
    {
        for flag in ["--help", "-h"] {
            let help = place.run(&format!("{command} {flag}")).stdout;
            let place_of =
                |heading: &str| help.find(&format!("\n{heading}\n")).unwrap_or_else(|| panic!("{heading}: {help}"));
            assert!(place_of("Arguments:") < place_of(own), "{help}");
            assert!(place_of(own) < place_of("Scene:") && place_of("Scene:") < place_of("Global options:"), "{help}");
            assert!(!help.contains("\nOptions:\n"), "{help}");
        }
    }
    assert!(place.run("--version").stdout.starts_with("belvedere "));
}
