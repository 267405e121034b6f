//! Conventions of all commands: north of azimuths, the file of ball parameters, progress, and the list of commands.

use crate::common::{EAST, NORTH, Workplace, at, house};
use serde_json::Value;

/// The Dutch grid is turned by this angle at the house, degrees: `Proj.get_factors` of pyproj 3.7.2 says.
const CONVERGENCE_DEG: f64 = -0.8042;

#[test]
fn azimuths_of_the_sun_are_from_true_north_unless_grid_north_is_wanted() {
    let place = Workplace::with_house();
    let made = "--orient given --scene-config ../tau.json --pixel 1 -o depth.npy";
    let along = |flags: &str| {
        let run = place.summary(&format!("depth-map house.laz {made} {flags}"));
        let axis: Vec<f64> =
            run["view"]["view_direction"].as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect();
        // the sun is behind the viewer
        ((-axis[0]).atan2(-axis[1]).to_degrees().rem_euclid(360.0), run)
    };
    let (of_grid, run) = along("--sun 90,10 --grid-north");
    assert!((of_grid - 90.0).abs() < 0.02, "{of_grid}");
    assert_eq!(run["azimuths_from"], "grid north");
    let (of_truth, run) = along("--sun 90,10");
    assert!((of_truth - 90.0 + CONVERGENCE_DEG).abs() < 0.02, "{of_truth}");
    assert_eq!(run["azimuths_from"], "true north");
    assert!((run["meridian_convergence_deg"].as_f64().unwrap() - CONVERGENCE_DEG).abs() < 0.01);

    // without a reference system true north is unknown, and the summary says so
    let mut nowhere = house();
    nowhere.frame.crs = belvedere::crs::Crs::default();
    place.write_cloud("nowhere.ply", &nowhere);
    let run = place.summary(&format!("depth-map nowhere.ply {made} --sun 90,10"));
    assert!(run["azimuths_from"].as_str().unwrap().starts_with("grid north, because"), "{run}");
}

#[test]
fn a_range_of_azimuths_turns_with_its_north() {
    let place = Workplace::with_house();
    let [x, y, _] = at(0.0, -14.0, 0.0);
    let observer =
        format!("house.laz --orient given --scene-config ../tau.json --ground found --observer {x},{y} --cell 0.5");
    let seen = |flags: &str| {
        let run = place.summary(&format!("viewshed {observer} {flags} -o seen.tif"));
        run["cells"]["visible"].as_u64().unwrap()
    };
    // shifting the range by the convergence gives the same cells
    let shifted = format!("--azimuth-range {},{}", 270.0 + CONVERGENCE_DEG, 340.0 + CONVERGENCE_DEG);
    let (of_grid, of_truth) = (seen("--azimuth-range 270,340 --grid-north"), seen(&shifted));
    assert!(of_grid > 100 && of_grid.abs_diff(of_truth) <= 2, "{of_grid} {of_truth}");
}

#[test]
fn a_file_of_ball_parameters_is_the_same_as_their_flags_and_flags_override_it() {
    let place = Workplace::with_house();
    place.write("balls.json", r#"{"orient": "given", "method": "tau", "max_radius": 0.8, "keep_isolated": true}"#);
    let flags = "--orient given --method tau --keep-isolated";
    place.summary("balls house.laz --scene-config balls.json -o a.npz");
    place.summary(&format!("balls house.laz {flags} --max-radius 0.8 -o b.npz"));
    assert!(place.npz::<f32>("a.npz", "radii") == place.npz::<f32>("b.npz", "radii"));
    place.summary("balls house.laz --scene-config balls.json --max-radius 0.4 -o c.npz");
    assert!(place.npz::<f32>("c.npz", "radii").iter().all(|radius| *radius <= 0.4));

    let view = format!("--viewport \"{EAST},{NORTH},20 4,0,0 0,-4,0 2\" -o depth.npy");
    let viewport = view.split('"').nth(1).unwrap();
    for (name, scene) in [("x.npy", "house.laz --scene-config balls.json"), ("y.npy", "b.npz")] {
        place.summary_with(&format!("depth-map {scene} -o {name} --viewport"), &[viewport]);
    }
    assert_eq!(place.bytes("x.npy"), place.bytes("y.npy"));
    // the shape is of no use to `balls`, and a flag of the paper's commands
    place.write("cone.json", r#"{"ball_profile": "paper-cone"}"#);
    for (name, shape) in [("x.npy", "--ball-profile paper-cone"), ("y.npy", "--scene-config cone.json")] {
        place.summary_with(&format!("depth-map b.npz {shape} -o {name} --viewport"), &[viewport]);
    }
    assert_eq!(place.bytes("x.npy"), place.bytes("y.npy"));

    place.write("bad.json", r#"{"orientation": "given"}"#);
    place.refusal(2, "balls house.laz --scene-config bad.json -o a.npz", &["bad.json", "orientation", "orient"]);
    for (text, words) in [
        (r#"{"max_radius": "wide"}"#, &["bad.json: max_radius", "wide"][..]),
        (r#"{"max_radius": -1}"#, &["bad.json: max_radius", "above 0"]),
        (r#"{"keep_noise": "yes"}"#, &["bad.json: keep_noise", "yes"]),
        (r#"{"neighbors": 2, "orient": "up"}"#, &["bad.json: neighbors", "3 to 256"]),
        (r#"{"neighbors": "some"}"#, &["bad.json: neighbors", "adaptive"]),
        (r#"{"orient": "sideways"}"#, &["bad.json: orient", "trajectory=FILE"]),
        (r#"{"method": "best"}"#, &["bad.json: method", "carved"]),
        (r#"{"trees": "green"}"#, &["bad.json: trees", "green", "porous"]),
        (r#"{"without": ["crowns", "all"]}"#, &["bad.json: without", "unknown rule"]),
        (r#"{"without": 3}"#, &["bad.json: without", "names of rules"]),
        (r#"{"ball_profile": "cube"}"#, &["bad.json: ball_profile", "paper-cone"]),
        (r#"{"first_angle": 30}"#, &["bad.json: first_angle", "method angles"]),
        ("[1]", &["bad.json", "object"]),
        ("{", &["bad.json", "line 1"]),
    ] {
        place.write("bad.json", text);
        for command in ["balls house.laz -o a.npz", "shadow house.laz --sun 180,30 -o a.tif"] {
            place.refusal(2, &format!("{command} --scene-config bad.json"), words);
        }
    }
    place.refusal(1, "balls house.laz --scene-config missing.json -o a.npz", &["missing.json"]);
}

#[test]
fn progress_as_json_follows_each_stage_from_its_beginning_to_its_end() {
    let place = Workplace::with_house();
    let run = place.run("balls house.laz --orient given --method tau --progress json -o a.npz");
    assert_eq!(run.status, 0);
    let lines: Vec<Value> = run.stderr.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let mut open: Vec<(&str, u64)> = Vec::new();
    let mut finished = 0;
    for line in &lines {
        let (stage, done) = (line["stage"].as_str().unwrap(), line["done"].as_u64().unwrap());
        assert!(line["seconds"].as_f64().unwrap() >= 0.0, "{line}");
        assert!(line["total"].as_u64().is_none_or(|total| done <= total), "{line}");
        match open.iter().position(|(name, _)| *name == stage) {
            None => open.push((stage, done)),
            Some(at) => {
                assert!(open[at].1 <= done, "{line}");
                open[at].1 = done;
                if line["finished"] == true {
                    assert!(line["total"].is_null() || line["total"] == done, "{line}");
                    finished += 1;
                    open.remove(at);
                }
            }
        }
    }
    assert!(open.is_empty() && finished >= 3, "{}", run.stderr);
}

#[test]
fn every_parameter_is_described_in_one_short_line_with_its_type() {
    let place = Workplace::new();
    let program = place.summary("describe");
    let commands = program["commands"].as_array().unwrap();
    // four of them are the steps of `city`
    assert_eq!(commands.len(), 45);
    for command in commands {
        let name = command["name"].as_str().unwrap();
        assert!(!command["summary"].as_str().unwrap().contains('\n'), "{name}");
        assert!(!command["examples"].as_array().unwrap().is_empty(), "{name}");
        for parameter in command["parameters"].as_array().unwrap() {
            let (flag, text) = (&parameter["name"], parameter["text"].as_str().unwrap());
            assert!((4..=110).contains(&text.chars().count()), "{name} {flag}: {text}");
            assert!(!text.ends_with('.'), "{name} {flag}: {text}");
            let kind = parameter["type"].as_str().unwrap();
            assert!(
                ["flag", "choice", "number", "integer", "numbers", "path", "folder", "text"].contains(&kind),
                "{name} {flag}"
            );
        }
    }
    let parameter = |command: &str, name: &str| {
        let command = commands.iter().find(|one| one["name"] == command).unwrap();
        let found = command["parameters"].as_array().unwrap().iter().find(|one| one["name"] == name);
        found.unwrap_or_else(|| panic!("{command}: {name}")).clone()
    };
    let cell = parameter("viewshed", "--cell");
    assert_eq!((&cell["type"], &cell["unit"], &cell["required"]), (&"number".into(), &"m".into(), &false.into()));
    assert!(cell["default"].as_str().unwrap().starts_with("0.5"), "{cell}");
    assert_eq!(parameter("viewshed", "--max-height")["default"], "100");
    assert_eq!(parameter("query", "--orient")["builds_balls"], true);
    assert_eq!(parameter("balls", "--trees")["choices"][0]["name"], "opaque");
    let output = parameter("viewshed", "--output");
    assert_eq!((&output["written"], output["formats"].as_array().unwrap().len()), (&true.into(), 8), "{output}");
    assert_eq!(parameter("shadow", "--measures")["type"], "folder");
    let parcel = parameter("envelope", "--parcel");
    assert_eq!((&parcel["written"], &parcel["formats"][0]), (&false.into(), &".geojson".into()), "{parcel}");
    // its text names GeoJSON, but its value is a number
    assert_eq!(parameter("cameras", "--distance-step-m")["formats"].as_array().unwrap().len(), 0);
    let view = commands.iter().find(|one| one["name"] == "query").unwrap()["required_one_of"].to_string();
    assert!(view.contains("--sun") && view.contains("--self"), "{view}");
}

#[test]
fn flags_of_balls_belong_to_balls_and_a_file_of_them_to_all_commands() {
    let place = Workplace::new();
    let of_balls = place.run("balls --help").stdout;
    for flag in ["--orient", "--keep-noise", "--method", "--penetration", "--trees"] {
        assert!(of_balls.contains(&format!("      {flag}")), "{flag}");
    }
    let program = place.summary("describe");
    for command in program["commands"].as_array().unwrap() {
        let parameters = command["parameters"].as_array().unwrap();
        let of_balls = parameters.iter().filter(|one| one["builds_balls"] == true);
        let flags: Vec<&str> = of_balls.map(|one| one["name"].as_str().unwrap()).collect();
        match command["name"].as_str().unwrap() {
            "balls" => assert_eq!(flags.len(), 14),
            "normals" | "surfaces" => assert_eq!(flags.len(), 6),
            "depth-map" | "query" => assert_eq!(flags, ["--ball-profile", "--trees", "--orient"]),
            name => assert!(flags.is_empty() || flags == ["--trees", "--orient"], "{name}: {flags:?}"),
        }
    }
    let of_shadow = place.run("shadow --help").stdout;
    assert!(of_shadow.contains("belvedere balls --help") && of_shadow.contains("--scene-config"));
}
