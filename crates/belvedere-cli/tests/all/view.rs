//! `belvedere view`: what the page is answered is what the commands that it shows give. No browser is needed.

use crate::common::page::Page;
use crate::common::{Workplace, column};
use serde_json::{Value, json};
use std::net::TcpStream;

/// Runs the command lines of an answer as a shell would, the table of places written by the test.
fn run_shown(place: &Workplace, answer: &Value) {
    for line in answer["command"].as_str().unwrap().lines() {
        if let Some(table) = line.strip_prefix("printf '") {
            let (text, name) = table.split_once("' > ").unwrap();
            place.write(name, text.replace("\\n", "\n"));
        } else {
            place.summary(line.strip_prefix("belvedere ").unwrap());
        }
    }
}

/// A town of 60 m, its page, and a place on a street of it.
fn town(place: &Workplace) -> (Page, [f64; 3]) {
    assert_eq!(place.run("simulate town -o town --extent 60").status, 0);
    let page = Page::open(place, "town/cloud.laz");
    let points = page.points();
    let middle = [0, 1].map(|i| points.iter().map(|p| p[i]).sum::<f64>() / points.len() as f64);
    // low points near the middle lie on the ground
    let near = |p: &&[f64; 3]| (p[0] - middle[0]).hypot(p[1] - middle[1]) < 12.0;
    let low = points.iter().filter(near).min_by(|a, b| a[2].total_cmp(&b[2])).unwrap();
    (page, low.map(|v| (v * 1000.0).round() / 1000.0))
}

/// Returns true if a place lies in the inner part of the cloud, where roofs are whole.
fn is_in_the_middle(place: &[f64; 3], points: &[[f64; 3]]) -> bool {
    let middle = [0, 1].map(|i| points.iter().map(|p| p[i]).sum::<f64>() / points.len() as f64);
    (0..2).all(|i| (place[i] - middle[i]).abs() < 20.0)
}

/// The values that the command line wrote for points, in the order in which the page gets points.
fn as_sent(points: &[[f64; 3]], place: &Workplace, table: &str, name: &str, byte: fn(f64) -> u8) -> Vec<u8> {
    let [x, y, z] = ["x", "y", "z"].map(|axis| column(place, table, axis));
    let values = column(place, table, name);
    let mut rows: Vec<([i64; 3], u8)> =
        (0..x.len()).map(|i| (millimetres([x[i], y[i], z[i]]), byte(values[i]))).collect();
    rows.sort_unstable();
    let find = |&point: &[f64; 3]| {
        let key = millimetres(point);
        // what is sent is rounded to the steps of its chunk
        let near = |row: &&([i64; 3], u8)| (0..3).all(|i| (row.0[i] - key[i]).abs() <= 3);
        let from = rows.partition_point(|row| row.0[0] < key[0] - 3);
        rows[from..].iter().take_while(|row| row.0[0] <= key[0] + 3).find(near).unwrap_or_else(|| panic!("{point:?}")).1
    };
    points.iter().map(find).collect()
}

/// 1 for what is lit, proven or not.
fn lit(codes: &[u8]) -> Vec<u8> {
    codes.iter().map(|&code| if code == 2 { 1 } else { code }).collect()
}

/// 1 for what is lit without proof.
fn unproven(codes: &[u8]) -> Vec<u8> {
    codes.iter().map(|&code| if code > 2 { code } else { u8::from(code == 2) }).collect()
}

/// Answers as tables have them.
fn codes_of(question: &str, codes: &[u8]) -> Vec<u8> {
    if question == "shadow" { lit(codes) } else { codes.to_vec() }
}

fn millimetres(point: [f64; 3]) -> [i64; 3] {
    point.map(|v| (v * 1000.0).round() as i64)
}

#[test]
fn each_answer_of_the_page_is_that_of_the_command_it_shows() {
    let place = Workplace::new();
    let (page, ground) = town(&place);
    let eye = [ground[0], ground[1], ground[2] + 1.7];
    let same = |sent: &[u8], table: &str, name: &str| {
        let written = as_sent(&page.points(), &place, table, name, |code| code as u8);
        assert_eq!(sent.len(), written.len());
        let differing = sent.iter().zip(&written).filter(|(a, b)| a != b).count();
        // points nearer to each other than the steps in which they are sent may be taken for one another
        assert!(differing * 10_000 <= sent.len(), "{differing} of {}", sent.len());
    };

    let (head, answers) = page.ask("seen", &json!({ "place": eye }));
    let as_table =
        |head: &Value, from: &str, to: &str| json!({ "command": head["command"].as_str().unwrap().replace(from, to) });
    run_shown(&place, &as_table(&head, "seen.laz", "seen.csv"));
    same(&answers, "seen.csv", "answer");
    assert!(head["visible"].as_u64().unwrap() > 100 && head["blocked"].as_u64().unwrap() > 100, "{head}");
    assert_eq!(head["visible"].as_u64().unwrap() as usize, answers.iter().filter(|&&code| code == 1).count());

    let (head, answers) = page.ask("shadow", &json!({ "time": "2026-06-21T17:00", "zone": "Europe/Amsterdam" }));
    run_shown(&place, &as_table(&head, "shadow.laz", "shadow.csv"));
    same(&lit(&answers), "shadow.csv", "lit");
    same(&unproven(&answers), "shadow.csv", "unproven");
    // probabilities stand behind the answers, in steps of 1/200
    for (name, question) in [
        ("seen", json!({ "place": eye, "probability": true })),
        ("shadow", json!({ "time": "2026-06-21T17:00", "zone": "Europe/Amsterdam", "probability": true })),
    ] {
        let [from, to] = ["laz", "csv"].map(|extension| format!("{name}.{extension}"));
        let (head, body) = page.ask(name, &question);
        let (codes, probabilities) = body.split_at(body.len() / 2);
        run_shown(&place, &as_table(&head, &from, &to));
        same(codes_of(name, codes).as_slice(), &to, if name == "seen" { "answer" } else { "lit" });
        let in_steps = |v: f64| if v.is_nan() { 255 } else { (v * 200.0).round() as u8 };
        let written = as_sent(&page.points(), &place, &to, "probability", in_steps);
        // tables have three decimals
        let differing = probabilities.iter().zip(&written).filter(|(a, b)| a.abs_diff(**b) > 1).count();
        assert!(differing * 10_000 <= written.len(), "{name}: {differing} of {}", written.len());
        assert!(written.iter().filter(|&&byte| (20..180).contains(&byte)).count() > 100, "{name}");
        let known: Vec<f64> = column(&place, &to, "uncertain").into_iter().filter(|is| is.is_finite()).collect();
        let uncertain = 100.0 * known.iter().sum::<f64>() / known.len() as f64;
        // reports have two decimals
        let given = head["certainty"]["uncertain_percent"].as_f64().unwrap();
        assert!((given - uncertain).abs() < 0.006 && uncertain > 0.0, "{name}: {given} and {uncertain}");
    }
    // the first answer: of a sample, which answers for its neighbours
    let (of_sample, first) =
        page.ask("shadow", &json!({ "time": "2026-06-21T17:00", "zone": "Europe/Amsterdam", "points": "sample" }));
    assert_eq!(first.len(), answers.len());
    let differing = first.iter().zip(&answers).filter(|(a, b)| a != b).count();
    assert!(differing * 6 < answers.len(), "{differing} of {}", answers.len());
    let [count, lit] = ["points", "lit"].map(|key| of_sample[key].as_f64().unwrap());
    assert!(count > 10_000.0 && count <= 30_000.0 && count < answers.len() as f64, "{count} of {}", answers.len());
    let whole = head["lit"].as_f64().unwrap() / answers.len() as f64;
    // five standard errors
    assert!((lit / count - whole).abs() < 2.5 / count.sqrt(), "{lit} of {count}, {whole}");

    let target = [ground[0] + 20.0, ground[1] + 9.0, ground[2] + 2.0];
    let (head, _) = page.ask("line", &json!({ "observer": eye, "target": target }));
    run_shown(&place, &json!({ "command": head["command"].as_str().unwrap().replace("profile.png", "profile.csv") }));
    let codes = ["blocked", "visible", "unproven"];
    assert_eq!(head["answer"], codes[column(&place, "line.csv", "answer")[0] as usize]);
    let range = column(&place, "line.csv", "first_block_range_m")[0];
    assert!(head["first_block"]["range_m"].as_f64().is_none_or(|v| (v - range).abs() < 1e-9), "{range}");
    let heights: Vec<f64> = head["profile"]["line"].as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect();
    let written = column(&place, "profile.csv", "line");
    assert!(heights.len() == written.len() && heights.iter().zip(&written).all(|(a, b)| (a - b).abs() < 0.006));

    // through crowns hours count by their share of light, and dots do not
    let sun = json!({ "place": eye, "date": "2026-03-21", "zone": "Europe/Amsterdam", "trees": "opaque" });
    let (head, _) = page.ask("sun", &sun);
    run_shown(&place, &head);
    for (key, name) in [("sun_hours", "sun_hours"), ("first_light", "first_light"), ("last_light", "last_light")] {
        let written = column(&place, "sun.csv", name)[0];
        // the page shows three decimals
        assert!((head[key].as_f64().unwrap() - written).abs() < 0.000_51, "{name}: {written}, {}", head[key]);
    }
    // the dots of the diagram add up to the hours
    let lit = head["lit"].as_array().unwrap().iter().filter(|lit| lit.as_bool().unwrap()).count() as f64 / 6.0;
    assert!((lit - head["sun_hours"].as_f64().unwrap()).abs() < 0.34, "{lit}");

    let (head, _) = page.ask("around", &json!({ "place": eye }));
    run_shown(&place, &head);
    let written = column(&place, "sky.csv", "sky_view_factor")[0];
    assert!(
        (head["sky_view_factor"].as_f64().unwrap() - written).abs() < 0.000_051,
        "{written} {}",
        head["sky_view_factor"]
    );
    let isovist: Value = serde_json::from_str(&place.text("isovist.json")).unwrap();
    let volume = isovist["isovists"][0]["volume_m3"].as_f64().unwrap();
    assert!((head["isovist"]["volume_m3"].as_f64().unwrap() - volume).abs() < 0.0051, "{volume}");

    let (head, body) = page.ask("who", &json!({ "place": eye }));
    let command = head["command"].as_str().unwrap().strip_prefix("belvedere ").unwrap();
    let run = place.summary(command);
    for name in ["visible", "blocked", "unproven"] {
        assert_eq!(head[name], run["cells"][name], "{name}");
    }
    let cells = head["grid"]["columns"].as_u64().unwrap() * head["grid"]["rows"].as_u64().unwrap();
    assert_eq!(body.len() as u64, 5 * cells);

    // one of the highest places of the town is a roof
    let points = page.points();
    let mut high: Vec<&[f64; 3]> = points.iter().filter(|p| is_in_the_middle(p, &points)).collect();
    high.sort_by(|a, b| b[2].total_cmp(&a[2]));
    let is_roof =
        |place: &&&[f64; 3]| page.request("POST", "ask/roof", &json!({ "place": place }).to_string()).0 == 200;
    let roof = high.iter().step_by(20).find(is_roof).unwrap();
    let (head, _) = page.ask("roof", &json!({ "place": roof }));
    run_shown(&place, &head);
    let row = head["plane"].as_u64().unwrap() as usize - 1;
    for name in ["kwh_m2", "max_loss", "tilt_deg", "azimuth_deg", "radiation_kwh"] {
        // the page has no electricity that its radiation could be taken for
        let written = column(&place, "roofs.csv", name)[row];
        // whole kilowatt hours, rounded from single precision in tables
        let tolerance = if name == "radiation_kwh" { 1.0 } else { 1e-9 };
        assert!((head[name].as_f64().unwrap() - written).abs() <= tolerance, "{name}: {written}, {}", head[name]);
    }

    let corners = [[-6.0, -6.0], [6.0, -6.0], [6.0, 6.0], [-6.0, 6.0]].map(|[x, y]| [ground[0] + x, ground[1] + y]);
    let (head, body) =
        page.ask("sun_area", &json!({ "corners": corners, "date": "2026-06-21", "zone": "Europe/Amsterdam" }));
    run_shown(&place, &as_table(&head, "sun.tif", "cells.csv"));
    let [x, y, hours] = ["x", "y", "sun_hours"].map(|name| column(&place, "cells.csv", name));
    let inside = |i: &usize| (x[*i] - ground[0]).abs() < 6.0 && (y[*i] - ground[1]).abs() < 6.0;
    let inside: Vec<usize> = (0..x.len()).filter(inside).collect();
    assert_eq!(head["cells"].as_u64().unwrap() as usize, inside.len());
    let mean = inside.iter().map(|&i| hours[i]).sum::<f64>() / inside.len() as f64;
    assert!((head["mean_hours"].as_f64().unwrap() - mean).abs() < 0.0011, "{mean}");
    assert_eq!(body.len(), 16 * inside.len());
}

#[test]
fn what_cannot_be_answered_is_refused_in_words() {
    let place = Workplace::new();
    let (page, ground) = town(&place);
    let far = [ground[0] + 5000.0, ground[1], ground[2]];
    assert!(page.refusal("seen", &json!({ "place": far })).contains("outside the cloud"));
    assert!(
        page.refusal("seen", &json!({ "place": [ground[0], ground[1], ground[2] - 0.5] })).contains("below the ground")
    );
    assert!(
        page.refusal("sun", &json!({ "place": ground, "date": "2026-02-30", "zone": "UTC" })).contains("2026-02-30")
    );
    assert!(page.refusal("shadow", &json!({ "time": "2026-06-21T12:00", "zone": "Mars" })).contains("Mars"));
    assert!(page.refusal("line", &json!({ "observer": ground, "target": ground })).contains("same place"));
    assert!(page.refusal("nothing", &json!({})).contains("no such question"));
    assert!(page.refusal("seen", &json!({ "place": ground, "and": 1 })).contains("and"));

    place.refusal(1, "view missing.laz --no-browser", &["missing.laz"]);
    place.refusal(2, "view town/cloud.laz --port 99999 --no-browser", &["--port"]);
    // two tabs get the same page
    assert_eq!(page.request("GET", "", "").0, 200);
    assert_eq!(page.request("GET", "page.js", "").0, 200);
}

#[test]
fn a_ball_file_and_its_cloud_are_ready_without_building() {
    let place = Workplace::new();
    assert_eq!(place.run("simulate town -o town --extent 60").status, 0);
    place.summary("balls town/cloud.laz -o balls.npz");
    let page = Page::open(&place, "balls.npz town/cloud.laz");
    let state = page.state();
    let count = state["shown"]["point_count"].as_u64().unwrap();
    assert!(count > 1000 && state["scene"]["tells_unproven"] == true, "{state}");
    let balls = page.request("GET", "balls", "").1;
    assert_eq!(balls.len() as u64, 16 * state["scene"]["ball_count"].as_u64().unwrap());

    let clear = json!({ "clear": [[[0, 0], [1, 0], [1, 1]]] });
    assert!(page.refusal("plan", &clear).contains("cloud alone"));
    // commands take the ground and the points from the cloud
    let (head, answers) = page.ask("shadow", &json!({ "time": "2026-06-21T17:00", "zone": "Europe/Amsterdam" }));
    run_shown(&place, &json!({ "command": head["command"].as_str().unwrap().replace("shadow.laz", "shadow.csv") }));
    let lit = column(&place, "shadow.csv", "lit").iter().filter(|lit| **lit > 0.0).count();
    assert_eq!(answers.iter().filter(|&&code| matches!(code, 1 | 2)).count(), lit);
    let middle = [0, 1].map(|i| state["shown"]["origin"][i].as_f64().unwrap());
    let (head, _) = page.ask("who", &json!({ "place": [middle[0], middle[1], 60.0] }));
    let run = place.summary(head["command"].as_str().unwrap().strip_prefix("belvedere ").unwrap());
    assert_eq!(head["visible"], run["cells"]["visible"]);

    let with_mesh = Page::open(&place, "balls.npz town/mesh.obj town/cloud.laz");
    assert_eq!(with_mesh.state()["mesh_count"], 1);
    let triangles = with_mesh.request("GET", "meshes/0", "").1.len() / 36;
    let written = place.text("town/mesh.obj").lines().filter(|line| line.starts_with("f ")).count();
    assert_eq!(triangles, written);
    assert_eq!(with_mesh.request("GET", "meshes/1", "").0, 404);
    let (head, _) = with_mesh.ask("shadow", &json!({ "time": "2026-06-21T17:00", "zone": "Europe/Amsterdam" }));
    assert!(!head["command"].as_str().unwrap().contains("mesh"), "{}", head["command"]);
    place.refusal(2, "view town/mesh.obj --no-browser", &["mesh", "cloud"]);
    place.refusal(2, "view balls.npz town/cloud.laz town --no-browser", &["ball file", "one cloud"]);

    let alone = Page::open(&place, "balls.npz");
    assert_eq!(alone.state()["shown"]["point_count"], 0);
    assert!(alone.refusal("seen", &json!({ "place": [0, 0, 0] })).contains("together with its cloud"));
}

#[test]
fn a_page_is_written_as_one_file_with_the_shadows_of_a_day_and_views() {
    let place = Workplace::new();
    assert_eq!(place.run("simulate town -o town --extent 60").status, 0);
    let viewpoints = "--observer 155000,463000 --observer 154985,463010,30";
    let run = place.summary(&format!(
        "view town/cloud.laz --export page.html --date 2026-06-21 --zone Europe/Amsterdam {viewpoints}"
    ));
    let text = place.text("page.html");
    place.summary(&format!("view {} --export far.html --date 2026-06-21", place.path("town/cloud.laz").display()));
    let folder = place.path("town").display().to_string();
    assert!(place.text("far.html").contains("belvedere shadow cloud.laz --time 2026-06-21T"));
    assert!(!place.text("far.html").contains(&folder), "{folder}");
    // the sun rises at 5:18 and sets at 22:03 there
    assert_eq!(run["suns"], 17);
    assert!(!text.contains("src=\"page.js\"") && !text.contains("href=\"style.css\""));
    let data = text.split("id=\"exported\">").nth(1).unwrap().split("</script>").next().unwrap();
    let data: Value = serde_json::from_str(data).unwrap();
    assert_eq!(data["state"]["shown"]["point_count"], run["points"]);
    // the shadow of a sun is that of the command: as many points are lit
    let sun = &data["suns"][10];
    // it names the file without its folder
    let command =
        sun["command"].as_str().unwrap().replace(" cloud.laz", " town/cloud.laz").replace("shadow.laz", "shadow.csv");
    place.summary(command.strip_prefix("belvedere ").unwrap());
    let lit = column(&place, "shadow.csv", "lit").iter().filter(|lit| **lit > 0.0).count();
    let digit = |c: u8| match c {
        b'A'..=b'Z' => c - b'A',
        b'a'..=b'z' => c - b'a' + 26,
        b'0'..=b'9' => c - b'0' + 52,
        b'+' => 62,
        b'/' => 63,
        _ => 0,
    };
    let unproven = column(&place, "shadow.csv", "unproven").iter().filter(|unproven| **unproven > 0.0).count();
    assert!(unproven > 0 && sun["lit"] == lit && sun["unproven"] == unproven, "{lit} {unproven}: {}", sun["lit"]);
    // three points a digit: 1 lit, 2 unproven
    let digits = sun["answers"].as_str().unwrap().bytes().map(digit);
    let codes: Vec<u8> = digits.flat_map(|digit| [4, 2, 0].map(|shift| digit >> shift & 3)).collect();
    assert_eq!([1, 2].map(|code| codes.iter().filter(|&&own| own == code).count()), [lit - unproven, unproven]);
    // remarks go along, and no folder of the sender does
    assert!(sun["remarks"].as_array().unwrap().iter().any(|remark| remark["key"] == "light-unproven"), "{sun}");
    // as much is visible from a viewpoint as the command says; each point has two bits there
    assert_eq!(run["viewpoints"], 2);
    for viewpoint in data["viewpoints"].as_array().unwrap() {
        let command = viewpoint["command"].as_str().unwrap();
        let command = command.replace(" cloud.laz", " town/cloud.laz").replace("seen.laz", "seen.csv");
        place.summary(command.strip_prefix("belvedere ").unwrap());
        let answers = column(&place, "seen.csv", "answer");
        for (key, code) in [("visible", 1.0), ("unproven", 2.0), ("blocked", 0.0)] {
            let count = answers.iter().filter(|answer| **answer == code).count();
            assert_eq!(viewpoint[key], count, "{key}");
        }
        assert_eq!(viewpoint["answers"].as_str().unwrap().len(), answers.len().div_ceil(4).div_ceil(3) * 4);
    }
    place.refusal(2, "view town/cloud.laz --export page.txt", &["--export", "html"]);
    place.refusal(2, "view town/cloud.laz --export page.html --date yesterday", &["--date"]);
    place.refusal(2, "view town/cloud.laz --observer 155000,463000", &["--export"]);
    for flag in ["--date 2026-06-21", "--observer 155000,463000"] {
        place.refusal(2, &format!("view town/cloud.laz --no-browser {flag}"), &["needs --export"]);
    }
    place.refusal(
        2,
        "view town/cloud.laz --export page.html --observer 1,2 --observer 1,2",
        &["--observer 1,2", "twice"],
    );
    place.refusal(
        2,
        "view town/cloud.laz --export page.html --observer 155000,463000,-90",
        &["--observer", "viewpoint", "its height is below the cloud"],
    );
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_the_page_with_success() {
    let place = Workplace::new();
    assert_eq!(place.run("simulate town -o town --extent 60").status, 0);
    let mut page = Page::open(&place, "town/cloud.laz");
    let id = page.program.id().to_string();
    assert!(std::process::Command::new("kill").args(["-INT", &id]).status().unwrap().success());
    assert_eq!(page.program.wait().unwrap().code(), Some(0));
    assert!(TcpStream::connect(&page.host).is_err(), "nobody listens any more");
}

#[test]
fn answers_with_a_plan_are_those_of_the_command_with_its_files() {
    let place = Workplace::new();
    let (page, ground) = town(&place);
    let points = page.points();
    let around = |[x, y, _]: [f64; 3], half: f64| {
        [[-half, -half], [half, -half], [half, half], [-half, half]].map(|[dx, dy]| [x + dx, y + dy])
    };
    // what stands highest goes, and beside the street a building comes
    let middle = points.iter().filter(|point| is_in_the_middle(point, &points));
    let top = *middle.max_by(|a, b| a[2].total_cmp(&b[2])).unwrap();
    let away = |point: &[f64; 3]| (point[0] - ground[0]).hypot(point[1] - ground[1]);
    let is_beside = |point: &&[f64; 3]| point[2] < ground[2] + 0.3 && (6.0..15.0).contains(&away(point));
    let foot = *points.iter().find(is_beside).unwrap();
    let building = json!({ "corners": around(foot, 2.5), "base": foot[2], "height_m": 14.5 });
    let drawn = json!({ "clear": [around(top, 6.0)], "buildings": [building] });
    let (plan, body) = page.ask("plan", &drawn);
    let cleared = plan["points_cleared"].as_u64().unwrap() as usize;
    let triangles = plan["triangle_bytes"].as_u64().unwrap() as usize;
    // floor and roof of two triangles each, four walls
    assert_eq!(triangles, 12 * 36);
    assert!(cleared > 50 && body[triangles..].iter().filter(|&&is_cleared| is_cleared == 1).count() == cleared);
    for file in plan["files"].as_array().unwrap() {
        place.write(file["name"].as_str().unwrap(), file["content"].as_str().unwrap());
    }

    let time = json!({ "time": "2026-06-21T17:00", "zone": "Europe/Amsterdam" });
    let as_table = |head: &Value, from: &str, to: &str| {
        run_shown(&place, &json!({ "command": head["command"].as_str().unwrap().replace(from, to) }));
    };
    let same = |sent: &[u8], table: &str, name: &str| {
        let left: Vec<usize> = (0..sent.len()).filter(|&i| sent[i] != 254).collect();
        assert_eq!(sent.len() - left.len(), cleared);
        let of_left: Vec<[f64; 3]> = left.iter().map(|&i| points[i]).collect();
        let written = as_sent(&of_left, &place, table, name, |code| code as u8);
        let differing = left.iter().zip(&written).filter(|(i, written)| sent[**i] != **written).count();
        assert!(differing * 10_000 <= sent.len(), "{name}: {differing} of {}", sent.len());
    };
    let (head, codes) = page.ask_of_plan(&plan, "shadow", &time);
    assert!(head["command"].as_str().unwrap().contains("--clear cleared.geojson --add planned.obj"), "{head}");
    as_table(&head, "shadow.laz", "shadow.csv");
    same(&lit(&codes), "shadow.csv", "lit");
    let (_, before) = page.ask("shadow", &time);
    let (before, lit) = (lit(&before), lit(&codes));
    let of = |from: u8, to: u8| before.iter().zip(&lit).filter(|(a, b)| (**a, **b) == (from, to)).count();
    assert!(of(0, 1) > 50 && of(1, 0) > 50, "gains {}, losses {}", of(0, 1), of(1, 0));

    let eye = json!({ "place": [ground[0], ground[1], ground[2] + 1.7] });
    let (head, seen) = page.ask_of_plan(&plan, "seen", &eye);
    as_table(&head, "seen.laz", "seen.csv");
    same(&seen, "seen.csv", "answer");

    // the ground in the planned building is no cell any more
    let area = json!({ "corners": around(foot, 7.0), "date": "2026-06-21", "zone": "Europe/Amsterdam" });
    let (head, _) = page.ask_of_plan(&plan, "sun_area", &area);
    as_table(&head, "sun.tif", "cells.csv");
    let [x, y, hours] = ["x", "y", "sun_hours"].map(|name| column(&place, "cells.csv", name));
    let inside = (0..x.len()).filter(|&i| (x[i] - foot[0]).abs() < 7.0 && (y[i] - foot[1]).abs() < 7.0);
    let inside: Vec<f64> = inside.map(|i| hours[i]).collect();
    assert_eq!(head["cells"].as_u64().unwrap() as usize, inside.len());
    assert!((head["mean_hours"].as_f64().unwrap() - inside.iter().sum::<f64>() / inside.len() as f64).abs() < 0.0011);
    assert!(page.ask("sun_area", &area).0["cells"].as_u64().unwrap() as usize > inside.len());

    // a loaded mesh blocks as a drawn one does
    let obj = plan["files"].as_array().unwrap().iter().find(|file| file["name"] == "planned.obj").unwrap();
    let load = |name: &str, text: &str| {
        page.request_of("application/octet-stream", "POST", &format!("plan-meshes/{name}"), text)
    };
    let (status, reply) = load("my%20tower.obj", obj["content"].as_str().unwrap());
    assert_eq!(status, 200);
    let number = serde_json::from_slice::<Value>(&reply[4..]).unwrap()["mesh"].clone();
    let (loaded, _) = page.ask("plan", &json!({ "clear": drawn["clear"], "meshes": [number] }));
    assert!(loaded["command"].as_str().unwrap().ends_with("--add 'my tower.obj'"), "{loaded}");
    assert_eq!(page.ask_of_plan(&loaded, "shadow", &time).1, codes);

    let refused = |(status, reply): (u16, Vec<u8>), text: &str| {
        let reply = String::from_utf8(reply).unwrap();
        assert!(status == 422 && reply.contains(text), "{status} {reply}");
    };
    refused(load("bad.obj", "v 1 2\n"), "bad.obj");
    refused(load("picture.png", "PNG"), "picture.png");
    refused(page.request("POST", "plans/999/ask/shadow", &time.to_string()), "not kept");
    for (broken, text) in [
        (json!({ "buildings": [{ "corners": [[0, 0], [1, 1]], "base": 0, "height_m": 5 }] }), "three corners"),
        (json!({ "buildings": [{ "corners": around(foot, 3.0), "base": 0, "height_m": -5 }] }), "above 0"),
        (json!({ "buildings": [{ "corners": around([0.0; 3], 3.0), "base": 0, "height_m": 5 }] }), "planned.obj"),
        (json!({ "clear": [around([0.0; 3], 3.0)] }), "on the cloud"),
        (json!({ "meshes": [77] }), "not kept"),
    ] {
        refused(page.request("POST", "ask/plan", &broken.to_string()), text);
    }
}

#[test]
fn a_city_run_is_shown_with_its_cloud_or_a_part_of_it() {
    let place = Workplace::new();
    assert_eq!(place.run("simulate town -o town --extent 60").status, 0);
    place.summary("city plan town/cloud.laz --sun 235,30 --sky-view --tile-size 32 -o run");
    place.summary("city run run");
    place.summary("city merge run --result sky_view_factor -o sky.tif");
    let of_run = Page::open(&place, "run");
    let of_file = Page::open(&place, "town/cloud.laz sky.tif");
    let names = |page: &Page| -> Vec<Value> {
        page.state()["results"].as_array().unwrap().iter().map(|result| result["name"].clone()).collect()
    };
    assert_eq!(names(&of_run)[..2], ["shadow_235_30", "sky_view_factor"]);
    let cells = |page: &Page, number: usize| page.answer("GET", &format!("results/{number}"), "").1;
    assert!(cells(&of_run, 1) == cells(&of_file, 0) && cells(&of_run, 1).len() > 10_000);
    // commands name the cloud, and not the run
    let (head, _) = of_run.ask("shadow", &json!({ "time": "2026-06-21T17:00", "zone": "Europe/Amsterdam" }));
    let command = head["command"].as_str().unwrap();
    assert!(command.starts_with("belvedere shadow") && command.contains("town/cloud.laz --time"), "{command}");
}

#[test]
fn results_of_other_commands_are_shown_where_they_lie() {
    let place = Workplace::new();
    assert_eq!(place.run("simulate town -o town --extent 60").status, 0);
    let shadow = "shadow town/cloud.laz --time 2026-06-21T17:00 --zone Europe/Amsterdam";
    for targets in ["--cell 1 -o lit.tif", "--cell 1 -o cells.csv", "--self -o lit.laz", "--self -o points.csv"] {
        place.summary(&format!("{shadow} {targets}"));
    }
    let [x, y, z, lit] = ["x", "y", "z", "lit"].map(|name| column(&place, "cells.csv", name));
    let start = [&x, &y].map(|values| (values.iter().sum::<f64>() / values.len() as f64).round());
    let walk = json!({ "type": "FeatureCollection", "features": [
        { "type": "Feature", "properties": {}, "geometry": { "type": "LineString", "coordinates": [start, [start[0] + 10.0, start[1]]] } },
        { "type": "Feature", "properties": {}, "geometry": { "type": "Point", "coordinates": [start[0], start[1], 50.0] } },
    ] });
    place.write("walk.geojson", walk.to_string());
    let page = Page::open(&place, "town/cloud.laz lit.tif lit.laz walk.geojson");
    let state = page.state();
    let described: Vec<Value> =
        state["results"].as_array().unwrap().iter().map(|file| json!([file["name"], file["columns"]])).collect();
    // the columns of the simulated cloud itself come last
    let own = json!(["cloud.laz", ["lit_110_20", "lit_180_65", "lit_240_35"]]);
    // and stay in a shadow of its points, behind it
    let of_shadow = json!(["lit.laz", ["lit", "unproven", "lit_110_20", "lit_180_65", "lit_240_35"]]);
    assert_eq!(described, [json!(["lit.tif", [""]]), of_shadow, json!(["walk.geojson", []]), own]);
    let (head, _) = page.ask("shadow", &json!({ "time": "2026-06-21T17:00", "zone": "Europe/Amsterdam" }));
    assert!(head["command"].as_str().unwrap().starts_with("belvedere shadow town/cloud.laz --time"), "{head}");

    let origin = [0, 1, 2].map(|i| state["shown"]["origin"][i].as_f64().unwrap());
    let layer = |number: usize| -> (Vec<[f64; 3]>, Vec<u8>) {
        let (head, mut body) = page.answer("GET", &format!("results/{number}"), "");
        let count = head["count"].as_u64().unwrap() as usize;
        let mut values = body.split_off(8 * count);
        values.truncate(count);
        let at = |key: &str, axis: usize| head[key][axis].as_f64().unwrap();
        let place = |bytes: &[u8]| {
            let steps = |axis: usize| f64::from(u16::from_le_bytes([bytes[2 * axis], bytes[2 * axis + 1]]));
            [0, 1, 2].map(|axis| origin[axis] + at("low", axis) + steps(axis) * at("step", axis))
        };
        assert_eq!(head["columns"][0]["are_codes"], true, "{head}");
        (body.chunks(8).map(place).collect(), values)
    };
    // the cells of the raster, on the ground
    let (places, values) = layer(0);
    let rows = |rows: &mut dyn Iterator<Item = ([f64; 2], f64)>| {
        let mut rows: Vec<[i64; 3]> =
            rows.map(|([x, y], v)| [(x * 2.0).round() as i64, (y * 2.0).round() as i64, v as i64]).collect();
        rows.sort_unstable();
        rows
    };
    let sent = rows(&mut places.iter().zip(&values).map(|(place, &value)| ([place[0], place[1]], f64::from(value))));
    let known = (0..x.len()).filter(|&i| lit[i].is_finite());
    let written = rows(&mut known.map(|i| ([x[i], y[i]], lit[i])));
    assert_eq!(sent, written);
    let (lowest, highest) =
        z.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &z| (low.min(z), high.max(z)));
    assert!(places.iter().all(|place| place[2] > lowest - 0.3 && place[2] < highest + 0.5), "{lowest} to {highest}");
    // the points of the cloud with their column
    let (places, values) = layer(1);
    let of_points = column(&place, "points.csv", "lit");
    assert!(places.len() == of_points.len() && values.len() == of_points.len());
    let count = |values: &mut dyn Iterator<Item = f64>| values.filter(|&v| v == 1.0).count();
    assert_eq!(count(&mut values.iter().map(|&v| f64::from(v))), count(&mut of_points.into_iter()));
    // a line of 10 m in pieces of 2 m along the ground, and a pin of three lines
    let (head, body) = page.answer("GET", "results/2", "");
    assert!(head["lines"] == 8 && body.len() == 8 * 24, "{head}");
    let end = |number: usize| -> [f64; 3] {
        let number = |i: usize| f64::from(f32::from_le_bytes(body[12 * number + 4 * i..][..4].try_into().unwrap()));
        [0, 1, 2].map(|i| number(i) + origin[i])
    };
    assert!(
        (end(0)[0] - start[0]).abs() < 0.01 && (end(9)[0] - start[0] - 10.0).abs() < 0.01,
        "{:?} {:?}",
        end(0),
        end(9)
    );
    assert!((end(10)[2] - 50.0).abs() < 0.01 && (end(11)[2] - 54.0).abs() < 0.01, "{:?}", end(11));
    assert_eq!(page.request("GET", "results/4", "").0, 404);
    drop(page);

    // alone, points with results are the cloud too
    let alone = Page::open(&place, "lit.laz").state();
    assert!(alone["results"][0]["columns"][0] == "lit" && alone["shown"]["point_count"].as_u64().unwrap() > 1000);

    place.write("far.geojson", "{\"type\":\"Point\",\"coordinates\":[100000,400000]}");
    place.write("bad.tif", "not a raster");
    for (file, message) in [("far.geojson", "far.geojson: lies beside the cloud"), ("bad.tif", "bad.tif")] {
        let run = place.run(&format!("view town/cloud.laz {file} --no-browser"));
        assert!(run.status == 1 && run.stderr.contains(message), "{run:?}");
    }
    place.refusal(2, "view lit.tif --no-browser", &["give one too"]);
}
