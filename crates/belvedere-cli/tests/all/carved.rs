//! `--method carved`: balls cut by the pulses of the cloud, against the exact light that the simulation wrote beside
//! each point.

use crate::common::Workplace;
use std::fs;

/// Answers of `belvedere query … --self` on the simulated town, row by row: 0 blocked, 1 visible, 2 unproven.
fn answers(place: &Workplace, flags: &str) -> Vec<u8> {
    let run = place.run(&format!("query town/cloud.laz --sun 240,35 --self {flags} -o answers.npy"));
    assert_eq!(run.status, 0, "{flags}: {run:?}");
    npyz::NpyFile::new(&fs::read(place.path("answers.npy")).unwrap()[..]).unwrap().into_vec().unwrap()
}

/// Returns the true answer for each point, and true if it lies on something else than a tree. Crowns let pulses in,
/// where points have no light by the mesh.
fn truth(place: &Workplace) -> Vec<(bool, bool)> {
    let mut reader = las::Reader::from_path(place.path("town/cloud.laz")).unwrap();
    let points = reader.read_all().unwrap();
    // three bytes are added to each point, in the order of the suns
    let points = points.points().map(Result::unwrap);
    points.map(|p| (p.extra_bytes[2] == 1, u8::from(p.classification) != 5)).collect()
}

/// Shares of the lit called blocked and of the shaded called visible or unproven, off trees.
fn errors(answers: &[u8], truth: &[(bool, bool)]) -> [f64; 2] {
    let share = |lit: bool| {
        let of = || answers.iter().zip(truth).filter(move |(_, (is_lit, counts))| *counts && *is_lit == lit);
        of().filter(|(answer, _)| (**answer != 0) != lit).count() as f64 / of().count() as f64
    };
    [share(true), share(false)]
}

#[test]
fn carved_balls_know_light_from_shade_better_than_balls_cut_to_a_fixed_radius() {
    let place = Workplace::new();
    place.summary("simulate town -o town --extent 120 --density 8");
    let truth = truth(&place);
    let by = |flags: &str| errors(&answers(&place, flags), &truth);
    let fixed = by("--scene-config ../tau.json --orient trajectory=town/trajectory.csv");
    let carved = by("--orient trajectory=town/trajectory.csv");
    let found = by("");
    // balanced over both kinds of error; the exact light is that of points 3 cm outside, so that neither can reach zero
    let mean = |errors: [f64; 2]| (errors[0] + errors[1]) / 2.0;
    assert!(mean(carved) < mean(fixed), "carved {carved:?}, cut to half a metre {fixed:?}");
    assert!(mean(carved) < 0.08, "{carved:?}");
    // the position of the scanner from the pulses is as accurate as its trajectory, within half a percent
    assert!((mean(found) - mean(carved)).abs() < 0.005, "{found:?} {carved:?}");
}

#[test]
fn a_carved_ball_file_answers_as_the_cloud_does_and_reports_what_was_cut() {
    let place = Workplace::new();
    place.summary("simulate village -o town --extent 100 --density 6");
    let made = place.summary("balls town/cloud.laz --method carved -o balls.npz");
    let cut = made["interior_balls"]["balls_cut_by_pulses"].as_u64().unwrap();
    assert!(cut > 1000 && made["scanner"]["scanner_known_percent"].as_f64().unwrap() > 90.0, "{made}");
    assert!(made["pulses"]["pulses_used"].as_u64().unwrap() > 10_000);
    let query = "--sun 200,40 --random 20000";
    let run = place.summary(&format!("query town/cloud.laz --scene-config ../carved.json {query} -o from_cloud.npy"));
    let cloud = place.npy::<u8>("from_cloud.npy").1;
    let answers = &run["answers"];
    assert_eq!(answers["method"], "lines of sight");
    let counts = ["blocked", "visible", "unproven", "inside_obstacle"].map(|name| answers[name].as_u64().unwrap());
    assert_eq!(counts, [0, 1, 2, 5].map(|code| cloud.iter().filter(|&&answer| answer == code).count() as u64));
    assert!(counts.iter().all(|&count| count > 10) && counts.iter().sum::<u64>() == 20_000, "{counts:?}");
    for file in ["balls.npz", "balls.ply", "balls.laz"] {
        let written = place.summary(&format!("balls town/cloud.laz --method carved -o {file}"));
        place.summary(&format!("query {file} {query} -o from_file.npy"));
        let saved = place.npy::<u8>("from_file.npy").1;
        let has_pulses = file == "balls.npz";
        assert_eq!(written["not_written"].is_string(), !has_pulses);
        // only .npz knows the pulses, and keeps every bit; LAZ keeps centres to a tenth of a millimetre
        let as_file = |answer: u8| if !has_pulses && answer == 2 { 1 } else { answer };
        let differ = cloud.iter().zip(&saved).filter(|(cloud, saved)| as_file(**cloud) != **saved).count();
        assert!(cloud.len() == saved.len() && differ <= if file == "balls.laz" { 20 } else { 0 }, "{file}: {differ}");
    }
    for (choice, as_code) in [("report", 2), ("as-visible", 1), ("as-blocked", 0)] {
        let run = place.summary(&format!("query balls.npz {query} --unproven {choice} -o settled.npy"));
        let expected: Vec<u8> = cloud.iter().map(|&answer| if answer == 2 { as_code } else { answer }).collect();
        assert_eq!(place.npy::<u8>("settled.npy").1, expected, "{choice}");
        let visible = expected.iter().filter(|&&answer| answer == 1).count() as u64;
        assert_eq!(run["answers"]["visible"].as_u64().unwrap(), visible, "{choice}");
    }
    // the column of a table holds the same
    place.summary(&format!("query balls.npz {query} -o answers.csv"));
    let column: Vec<u8> = place
        .text("answers.csv")
        .lines()
        .skip(1)
        .map(|line| line.rsplit(',').next().unwrap().parse().unwrap())
        .collect();
    assert_eq!(column, cloud);
    place.refusal(2, &format!("query balls.ply {query} --unproven as-blocked -o no.npy"), &["--unproven", ".npz"]);
    place.refusal(
        2,
        &format!("query town/cloud.laz --scene-config ../tau.json {query} --unproven report -o no.npy"),
        &["--unproven"],
    );
}

#[test]
fn proven_light_is_right_more_often_than_unproven_light() {
    let place = Workplace::new();
    place.summary("simulate town -o town --extent 120 --density 8");
    let answers = answers(&place, "--scene-config ../carved.json --orient trajectory=town/trajectory.csv");
    let truth = truth(&place);
    let right = |code: u8| {
        let of: Vec<bool> =
            answers.iter().zip(&truth).filter(|(answer, _)| **answer == code).map(|(_, (lit, _))| *lit).collect();
        assert!(of.len() > 300, "answer {code}: {}", of.len());
        of.iter().filter(|lit| **lit).count() as f64 / of.len() as f64
    };
    let [blocked, proven, unproven] = [0, 1, 2].map(right);
    assert!(blocked < unproven && unproven < proven, "lit in truth: {blocked} {unproven} {proven}");
}

#[test]
fn a_viewport_bounds_the_queries_of_carved_balls() {
    let place = Workplace::new();
    place.summary("simulate village -o town --extent 100 --density 6");
    let made = place.summary("balls town/cloud.laz --method carved -o balls.npz");
    assert!(made["points"].as_u64().unwrap() > 10_000);
    // the whole town straight from above, once as a direction and once through a picture of a part of it
    place.summary("query balls.npz --direction 0,0,-1 --random 5000 -o all.csv");
    let rows: Vec<Vec<f64>> = place
        .text("all.csv")
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(|v| v.parse().unwrap()).collect())
        .collect();
    let middle = [0, 1].map(|axis| rows.iter().map(|row| row[axis]).sum::<f64>() / rows.len() as f64);
    let corner = [middle[0].round() - 20.0, middle[1].round() + 20.0];
    let viewport = format!("{},{},500 40,0,0 0,-40,0 2", corner[0], corner[1]);
    place.write("targets.csv", place.text("all.csv"));
    place.summary_with("query balls.npz --targets targets.csv -o part.npy --viewport", &[viewport.as_str()]);
    let part = place.npy::<u8>("part.npy").1;
    let mut inside = 0;
    for (row, answer) in rows.iter().zip(part) {
        let off = [row[0] - corner[0], corner[1] - row[1]];
        if off.iter().all(|v| (0.001..39.999).contains(v)) {
            inside += 1;
            assert!((f64::from(answer) - row[3]).abs() < 0.5, "{row:?}: {answer}");
        } else if off.iter().any(|v| !(-0.001..40.001).contains(v)) {
            assert_eq!(answer, 3, "{row:?}");
        }
    }
    assert!((300..3000).contains(&inside), "{inside}");
}

#[test]
fn carving_needs_pulses_and_interior_balls() {
    let place = Workplace::new();
    place.summary("simulate village -o town --extent 60 --density 2");
    place.refusal(2, "balls town/cloud.laz --method carved -o FOLDER", &["folder"]);
    place.refusal(2, "balls town/cloud.laz --method carved --side exterior -o balls.npz", &["exterior"]);
    place.refusal(2, "balls town/cloud.laz --method carved --first-angle 30 -o balls.npz", &["--first-angle"]);
    let rows: String = (0..400).map(|i| format!("{},{},{}\n", i % 20, i / 20, (i * 7 % 5) as f64 * 0.01)).collect();
    fs::write(place.path("bare.csv"), format!("x,y,z\n{rows}")).unwrap();
    place.refusal(1, "query bare.csv --orient pulses --sun 100,30 --self -o lit.csv", &["GPS time"]);
}

#[test]
fn without_times_and_angles_carving_goes_on_with_an_assumption_that_is_stated() {
    let place = Workplace::new();
    place.summary("simulate village -o town --extent 80 --density 6");
    let truth = truth(&place);
    let by = |flags: &str| errors(&answers(&place, flags), &truth);
    let known = by("--scene-config ../carved.json");
    // positions alone, in the same order
    let mut reader = las::Reader::from_path(place.path("town/cloud.laz")).unwrap();
    let points = reader.read_all().unwrap();
    let rows: String = points.points().map(Result::unwrap).map(|p| format!("{},{},{}\n", p.x, p.y, p.z)).collect();
    place.write("bare.csv", format!("x,y,z\n{rows}"));
    let made = place.summary("balls bare.csv --method carved -o balls.npz");
    assert!(made["scanner"]["found_by"].as_str().unwrap().contains("assumed"), "{made}");
    assert!(made["normals"]["oriented_by"].as_str().unwrap().starts_with("up"), "{made}");
    place.summary("query bare.csv --scene-config ../carved.json --sun 240,35 --self -o answers.npy");
    let bytes = fs::read(place.path("answers.npy")).unwrap();
    let assumed = errors(&npyz::NpyFile::new(&bytes[..]).unwrap().into_vec::<u8>().unwrap(), &truth);
    let mean = |errors: [f64; 2]| (errors[0] + errors[1]) / 2.0;
    // the classes are gone as well as the pulses; guessing answers half of the points right
    assert!(mean(assumed) < mean(known) + 0.12, "{assumed:?} {known:?}");
    let info = place.summary("info bare.csv");
    assert!(info["usable_for"]["--method carved"].as_str().unwrap().contains("assumed"), "{info}");
    assert!(info["usable_for"]["--orient pulses"].as_str().unwrap().starts_with("no: "), "{info}");
}
