//! `compare` scores honestly, goes on where it stopped, and takes places of one's own.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use belvedere::control::Control;
use belvedere::io::{ReadOptions, read_cloud, write_cloud};
use belvedere_baselines::simulated::flown;
use belvedere_scenes::{AirborneParams, Preset, scan_airborne, town};
use serde_json::Value;
use std::fs;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use tempfile::TempDir;

/// A folder in which the program runs, removed at the end.
struct Workplace(TempDir);

/// What a run left behind.
#[derive(Debug)]
struct Run {
    status: i32,
    stdout: String,
    stderr: String,
}

impl Workplace {
    fn new() -> Self {
        Self(TempDir::new().unwrap())
    }

    /// A place with a simulated town of 100 m and its survey: `town.laz`, `town.obj`, `trajectory.csv`.
    fn with_town(preset: Preset, pulses_per_m2: f64) -> Self {
        let place = Self::new();
        let scene = town(&preset.params(100.0, 1));
        let params = AirborneParams { seed: 1, ..AirborneParams::covering(&scene, pulses_per_m2) };
        let (cloud, _) = flown(&scene, &params).unwrap();
        write_cloud(&place.path("town.laz"), &cloud, &[]).unwrap();
        place.write("trajectory.csv", &scan_airborne(&scene, &params).sensor_path.to_csv());
        place.write("town.obj", &scene.to_obj());
        place
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn text(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap()
    }

    fn write(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).unwrap();
    }

    /// Runs with arguments parted by blanks.
    fn run(&self, arguments: &str) -> Run {
        let mut command = Command::new(env!("CARGO_BIN_EXE_compare"));
        command.current_dir(self.0.path()).args(arguments.split_ascii_whitespace()).stdin(Stdio::null());
        let output = command.output().unwrap();
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        let status = output.status.code().unwrap();
        let run = Run { status, stdout: text(output.stdout), stderr: text(output.stderr) };
        assert!(!run.stderr.contains("panicked"), "{arguments}: {run:?}");
        run
    }

    /// Runs what must succeed, and gives its summary.
    fn summary(&self, arguments: &str) -> Value {
        let run = self.run(&format!("--json {arguments}"));
        assert_eq!((run.status, run.stderr.as_str()), (0, ""), "{arguments}");
        serde_json::from_str(&run.stdout).unwrap()
    }

    /// Runs what must fail with `status`; its message must hold each of `words`.
    fn refusal(&self, status: i32, arguments: &str, words: &[&str]) {
        let run = self.run(arguments);
        assert_eq!((run.status, run.stdout.as_str()), (status, ""), "{arguments}: {run:?}");
        for word in words {
            assert!(run.stderr.contains(word), "{arguments}: {word:?} is not in {}", run.stderr);
        }
    }
}

const SMALL: &str = "--extent 100 --density 2 --target-count 1500 --methods paper-sphere,tau";

/// What is kept of `method` on one set and group of views, at the first place.
fn score<'a>(results: &'a Value, method: &str, set: &str, views: &str) -> &'a Value {
    let of_method = results["methods"].as_array().unwrap().iter().find(|r| r["method"] == method).unwrap();
    let scores = of_method["scores"].as_array().unwrap();
    scores.iter().find(|s| s["set"] == set && s["views"] == views).unwrap()
}

/// The share, 0 to 1, of a rate of `method` on one set and group of views, at the first place.
fn rate(results: &Value, method: &str, set: &str, views: &str, rate: &str) -> f64 {
    let score = score(results, method, set, views);
    let [value, low, high] = [0, 1, 2].map(|i| score[rate][i].as_f64().unwrap());
    assert!(low <= value + 1e-9 && value <= high + 1e-9 && (0.0..=1.0).contains(&value), "{score}");
    value
}

#[test]
fn every_method_gets_scores_costs_and_pictures() {
    let place = Workplace::new();
    let results = &place.summary(&format!("{SMALL} -o out"))["results"];
    for method in ["paper-sphere", "tau"] {
        for set in ["AIR", "PED", "GRD", "ROOF", "FACADE", "VOL", "OWN"] {
            for views in ["suns", "observers"] {
                let [blocked, visible, balanced] =
                    ["false_blocked", "false_visible", "balanced"].map(|r| rate(results, method, set, views, r));
                // each view's balanced accuracy is one minus the mean of its two errors, and so is the mean over views
                assert!((balanced - (1.0 - (blocked + visible) / 2.0)).abs() < 1e-9, "{method} {set} {views}");
            }
        }
        rate(results, method, "LOS", "pairs", "balanced");
        let mean = rate(results, method, "STREET", "street", "balanced");
        let street = score(results, method, "STREET", "street");
        assert!(street["tenth_balanced"].as_f64().unwrap() <= mean && street["observers"] == 40, "{street}");
        assert_eq!(street["targets"], 300);
        let picture = fs::read(place.path(&format!("out/pictures/town-100m-1--{method}.png"))).unwrap();
        assert!(picture.starts_with(b"\x89PNG"));
    }
    // the finding of the paper's comparison: union as published blocks the street, the default does not
    let street = |method| rate(results, method, "PED", "suns", "false_blocked");
    assert!(street("paper-sphere") > 0.5 && street("tau") < 0.3);
    let html = fs::read_to_string(place.path("out/report.html")).unwrap();
    assert!(html.contains("town-100m-1--tau.png") && html.contains("Wrong balls of the published method"));
    // of the four groups of views one holds the suns; each target of each sun gets one answer of three
    let answers = results["places"][0]["answers"].as_array().unwrap();
    let row = |set: &str, views: &str| {
        let row = answers.iter().find(|row| row["set"] == set && row["views"] == views).unwrap();
        ["visible", "unproven", "blocked"].map(|name| [0, 1].map(|i| row[name][i].as_u64().unwrap()))
    };
    for (set, views, expected) in [
        ("PED", "sun at 20°", 1500),
        ("AIR", "sun at 65°", 1500),
        ("PED", "observers", 3000),
        ("STREET", "street", 12_000),
    ] {
        let found = row(set, views);
        assert_eq!(found.iter().map(|[given, _]| given).sum::<u64>(), expected, "{set} {views}");
        assert!(found.iter().all(|[given, right]| right <= given && *given > 0), "{set} {views}: {found:?}");
    }
    let [visible, unproven, _] = row("PED", "sun at 65°").map(|[given, right]| right as f64 / given as f64);
    assert!(visible > unproven, "what pulses bear out is right more often: {visible} {unproven}");
    assert!(html.contains("Reliability of each answer of carved balls") && html.contains("People in streets"));
    let audit = results["places"][0]["audit"].as_array().unwrap();
    assert!(audit.iter().any(|row| row["surface"] == "facade" && row["balls"].as_u64() > row["wrong"].as_u64()));
}

#[test]
fn a_run_goes_on_where_it_stopped_and_redoes_what_is_stale() {
    let place = Workplace::new();
    let first = place.summary(&format!("{SMALL} -o out"));
    let [kept, lost] = ["tau", "paper-sphere"].map(|m| place.path(&format!("out/results/town-100m-1--{m}.json")));
    let untouched = fs::metadata(&kept).unwrap().modified().unwrap();
    let old = fs::read_to_string(&lost).unwrap();
    // an interruption leaves results out, or, at worst, a file of something else
    fs::write(&lost, "{\"half\": ").unwrap();
    let second = place.summary(&format!("{SMALL} -o out"));
    assert_eq!(fs::metadata(&kept).unwrap().modified().unwrap(), untouched, "was made anew");
    let scores = |text: &str| serde_json::from_str::<Value>(text).unwrap()["scores"].clone();
    assert_eq!(scores(&fs::read_to_string(&lost).unwrap()), scores(&old), "the same scores again");
    let methods = |run: &Value| run["results"]["methods"].as_array().unwrap().len();
    assert_eq!((methods(&first), methods(&second)), (2, 2));
    // other questions: what was kept does not answer them
    place.summary(&format!("{SMALL} --target-count 1000 -o out").replacen("--target-count 1500 ", "", 1));
    assert!(fs::metadata(&kept).unwrap().modified().unwrap() > untouched);
}

#[test]
fn tables_go_between_the_marks_of_a_page() {
    let place = Workplace::new();
    fs::write(place.path("page.md"), "# Ours\n<!-- tables -->\nold\n<!-- end of tables -->\nclosing words\n").unwrap();
    fs::write(place.path("bare.md"), "# Nothing\n").unwrap();
    place.summary(&format!("{SMALL} -o out --page page.md"));
    let page = fs::read_to_string(place.path("page.md")).unwrap();
    assert!(page.starts_with("# Ours\n<!-- tables -->\n") && page.ends_with("<!-- end of tables -->\nclosing words\n"));
    assert!(page.contains("| balls limited to half a metre |") && !page.contains("old"));
    place.refusal(1, &format!("{SMALL} -o out --page bare.md"), &["bare.md", "<!-- tables -->"]);
    assert_eq!(fs::read_to_string(place.path("bare.md")).unwrap(), "# Nothing\n");
}

#[test]
fn several_towns_give_differences_from_carved_balls_town_by_town() {
    let place = Workplace::new();
    let run =
        place.summary("--presets village --seeds 1,2,3 --extent 100 --target-count 400 --methods tau,carved -o out");
    let methods = run["results"]["methods"].as_array().unwrap().clone();
    let balanced = |method: &str| -> Vec<f64> {
        let of_method = methods.iter().filter(|result| result["method"] == method);
        let score = |result: &Value| {
            let scores = result["scores"].as_array().unwrap();
            let score = scores.iter().find(|score| score["set"] == "PED" && score["views"] == "suns").unwrap();
            score["balanced"][0].as_f64().unwrap()
        };
        of_method.map(score).collect()
    };
    let differences: Vec<f64> =
        balanced("tau").iter().zip(balanced("carved")).map(|(tau, carved)| 100.0 * (tau - carved)).collect();
    assert_eq!(differences.len(), 3);
    let report = place.text("out/report.md");
    let table = report.split("difference from carved balls").nth(1).unwrap();
    let row = table.lines().find(|line| line.starts_with("| balls limited to half a metre")).unwrap();
    // after the name and free air
    let cell = row.split('|').nth(3).unwrap().replace('−', "-");
    let numbers = cell.split([' ', '[', ']', ',']).filter_map(|number| number.parse::<f64>().ok());
    let [mean, low, high] = numbers.collect::<Vec<f64>>()[..] else { panic!("{cell}") };
    let ends = [f64::min, f64::max].map(|end| differences.iter().copied().reduce(end).unwrap());
    // printed to a tenth
    assert!((mean - differences.iter().sum::<f64>() / 3.0).abs() < 0.051, "{cell}: {differences:?}");
    // of 27 equally likely draws of three towns, one has only the worst
    assert!((low - ends[0]).abs() < 0.051 && (high - ends[1]).abs() < 0.051, "{cell}: {differences:?}");
    assert!(!table.split("###").next().unwrap().contains("| Belvedere: carved balls |"), "{table}");
}

#[test]
fn a_place_of_ones_own_takes_part() {
    let place = Workplace::with_town(Preset::Town, 10.0);
    let files = "--clouds town.laz --mesh town.obj --trajectory trajectory.csv --model city=town.obj";
    let run = place.summary(&format!("{files} --target-count 1500 --methods tau,mesh-city -o out"));
    let results = &run["results"];
    let street = rate(results, "tau", "PED", "suns", "false_blocked");
    assert!((0.01..0.3).contains(&street), "{street}");
    assert!(rate(results, "tau", "OWN", "suns", "balanced") > 0.8);
    // the exact mesh as a method: what is left is the millimetre of the file
    let exact = rate(results, "mesh-city", "PED", "suns", "balanced");
    assert!(exact > 0.999, "{exact}");
    let upward = place.summary("--clouds town.laz --mesh town.obj --target-count 800 --methods tau -o up");
    let sets = upward["results"]["methods"][0]["scores"].as_array().unwrap().clone();
    assert!(sets.iter().all(|score| score["set"] != "OWN"), "without a scanner own points have no truth");
    // half a file is a place all the same, which must not look whole
    let (cloud, _) =
        read_cloud(["town.laz"].map(|name| place.path(name)), &ReadOptions::default(), &Control::none()).unwrap();
    write_cloud(&place.path("whole.las"), &cloud, &[]).unwrap();
    let las = fs::read(place.path("whole.las")).unwrap();
    fs::write(place.path("half.las"), &las[..las.len() / 2]).unwrap();
    let run = place.run("--clouds half.las --mesh town.obj --target-count 300 --methods tau -o cut");
    assert!(run.status == 0 && run.stderr.contains("half.las: the file is cut off"), "{run:?}");
}

#[test]
fn clouds_are_judged_by_the_pulses_kept_from_the_methods() {
    let place = Workplace::with_town(Preset::Village, 6.0);
    let run = place.summary("--held-out town.laz --methods paper-sphere,carved,surfels,hidden-points -o out");
    let results = run["results"]["held_out"].as_array().unwrap().clone();
    assert!(run["results"]["methods"].as_array().unwrap().is_empty(), "no town was requested");
    let share = |method: &str, name: &str| {
        let result = results.iter().find(|r| r["method"] == method).unwrap();
        assert!(
            result["pulses"].as_u64().unwrap() > 4000 && result["scanner_known"].as_f64().unwrap() > 0.9,
            "{result}"
        );
        let shares = result["shares"].as_array().unwrap();
        shares.iter().find(|s| s[0] == name).and_then(|s| s[1].as_f64()).unwrap()
    };
    // pulses cut the balls that would block them, and their neighbours held out fly the same way
    assert!(share("carved", "ground") < 0.5 * share("paper-sphere", "ground"));
    assert!(share("carved", "false-visible 1 m behind building") < 0.1);
    let refused = results.iter().find(|r| r["method"] == "hidden-points").unwrap();
    assert!(refused["failed"].as_str().unwrap().contains("eye"), "{refused}");
    let markdown = fs::read_to_string(place.path("out/report.md")).unwrap();
    assert!(
        markdown.contains("### Held-out pulses of town") && markdown.contains("### Combinations without an answer")
    );
    let by_path = "--held-out town.laz --trajectory trajectory.csv --methods carved -o by_path";
    let known = place.summary(by_path)["results"]["held_out"][0]["scanner_known"].as_f64().unwrap();
    // the trajectory covers every pulse
    assert!((known - 1.0).abs() < 1e-9, "{known}");
    fs::write(place.path("bare.csv"), "x,y,z\n1,2,3\n2,3,4\n").unwrap();
    place.refusal(1, "--held-out bare.csv -o out", &["bare.csv", "GPS time"]);
}

#[test]
fn variants_run_only_when_named_in_full_and_costly_eyes_are_few() {
    let place = Workplace::new();
    let methods = |list: &str| -> Vec<Value> {
        let run = place.summary(&format!("--extent 60 --density 2 --target-count 200 --methods {list} -o out"));
        run["results"]["methods"].as_array().unwrap().clone()
    };
    let keys = |results: &[Value]| -> Vec<String> {
        results.iter().map(|result| result["method"].as_str().unwrap().to_owned()).collect()
    };
    // twice, the second time from what was kept
    for _ in 0..2 {
        assert_eq!(keys(&methods("carved")), ["carved"]);
        assert_eq!(keys(&methods("carved-without-crowns")), ["carved-without-crowns"]);
    }
    let results = methods("mesh-exact,shadow-map-exact");
    let eyes = |method: &str| {
        let result = results.iter().find(|result| result["method"] == method).unwrap();
        let scores = result["scores"].as_array().unwrap();
        scores.iter().find(|score| score["set"] == "STREET").unwrap()["observers"].as_u64().unwrap()
    };
    assert!(eyes("mesh-exact") > 20 && eyes("shadow-map-exact") == 4);
}

#[test]
fn the_help_shows_an_example() {
    let place = Workplace::new();
    let help = place.run("--help");
    assert!(help.status == 0 && help.stdout.contains("cargo research compare -- --extent 100"), "{help:?}");
}

#[test]
fn what_cannot_be_compared_is_refused() {
    let place = Workplace::new();
    place.refusal(2, "--clouds a.laz -o out", &["--mesh"]);
    place.refusal(2, "--presets metropolis -o out", &["metropolis", "old-town"]);
    place.refusal(2, "--clouds a.laz --mesh b.obj --model City=c.obj -o out", &["lower-case"]);
    place.refusal(1, "--clouds a.laz --mesh b.obj -o out", &["a.laz"]);
    assert!(!place.path("out").exists(), "a run without a result leaves no folder");
    place.write("file", "");
    place.refusal(1, "--extent 60 -o file", &["file", "a folder is needed"]);
    place.write("t.csv", "");
    place.refusal(2, "--trajectory t.csv -o out", &["--trajectory", "--held-out"]);
    place.refusal(1, "-o missing/out", &["missing"]);
    place.refusal(2, "--extent 60 --target-count 10 --methods magic -o out", &["magic", "paper-cone"]);
    place.refusal(2, "-o o --clouds junk.laz --mesh mesh.obj --methods voxels,nonsense", &["--methods", "nonsense"]);
    place.refusal(2, "-o o --target-count 1000000000", &["--target-count", "1 to 10000000"]);
}

#[test]
fn scanners_and_densities_are_kept_apart() {
    let place = Workplace::new();
    for name in ["c.laz", "m.obj"] {
        place.write(name, "never read");
    }
    for (flags, parts) in [
        ("--regimes tripods,room --density 4", &["--density", "tripods, room", "fly"][..]),
        ("--clouds c.laz --mesh m.obj --density 4", &["--density", "simulated towns"]),
        ("--held-out c.laz --density 4", &["--density", "simulated towns"]),
    ] {
        place.refusal(2, &format!("{flags} -o none"), parts);
        assert!(!place.path("none").exists());
    }
    let beside = "--extent 60 --regimes air,room --density 2 --target-count 200 --methods dsm -o beside";
    let run = place.run(beside);
    assert!(
        run.status == 0 && run.stderr.contains("--density does not apply to room, which is compared once"),
        "{run:?}"
    );
    let run = "--extent 60 --regimes air,conical --density 2,4 --target-count 300 --methods dsm -o out";
    let results = &place.summary(run)["results"];
    let scanners: Vec<(&str, f64)> = results["methods"]
        .as_array()
        .unwrap()
        .iter()
        .filter(|result| result["method"] == "dsm")
        .map(|result| {
            let scanner = &result["scanner"];
            (scanner["name"].as_str().unwrap(), scanner["pulses_per_m2"].as_f64().unwrap())
        })
        .collect();
    assert_eq!(scanners, [("air", 2.0), ("air", 4.0), ("conical", 2.0), ("conical", 4.0)]);
    let points = |at: usize| results["places"][at]["points"].as_f64().unwrap();
    assert!((points(1) / points(0) - 2.0).abs() < 0.2 && (points(3) / points(2) - 2.0).abs() < 0.2);
    let page = fs::read_to_string(place.path("out/report.md")).unwrap();
    assert!(page.contains("by scanner") && page.contains("| conical, 4 pulses/m² |"), "{page}");
    for picture in ["errors_by_density.png", "town-60m-1-conical-4--dsm.png"] {
        assert!(fs::read(place.path(&format!("out/pictures/{picture}"))).unwrap().starts_with(b"\x89PNG"));
    }
    place.refusal(2, "--regimes balloon -o out", &["--regimes", "balloon", "conical"]);
    place.refusal(1, "--regimes car --extent 60 --methods dsm -o no", &["the car passes nothing", "--extent"]);
}
