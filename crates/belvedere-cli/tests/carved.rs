//! `--method carved`: balls cut by the pulses of the cloud, against the exact light that the simulation wrote beside each point.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod common;

use common::Workplace;
use std::fs;

/// Answers of `belvedere query … --self` on the simulated town, row by row: 0 blocked, 1 visible.
fn answers(place: &Workplace, flags: &str) -> Vec<u8> {
    let run = place.run(&format!("query town/cloud.laz --sun 240,35 --self {flags} -o answers.npy"));
    assert_eq!(run.status, 0, "{flags}: {run:?}");
    npyz::NpyFile::new(&fs::read(place.path("answers.npy")).unwrap()[..]).unwrap().into_vec().unwrap()
}

/// What is true of each point, and whether it lies on something else than a tree: crowns let pulses in, where points have no
/// light by the mesh.
fn truth(place: &Workplace) -> Vec<(bool, bool)> {
    let mut reader = las::Reader::from_path(place.path("town/cloud.laz")).unwrap();
    let points = reader.read_all().unwrap();
    // three bytes are added to each point, in the order of the suns
    let points = points.points().map(Result::unwrap);
    points.map(|p| (p.extra_bytes[2] == 1, u8::from(p.classification) != 5)).collect()
}

/// Shares of the lit called blocked and of the shaded called visible, off trees.
fn errors(answers: &[u8], truth: &[(bool, bool)]) -> [f64; 2] {
    let share = |lit: bool| {
        let of = || answers.iter().zip(truth).filter(move |(_, (is_lit, counts))| *counts && *is_lit == lit);
        of().filter(|(answer, _)| (**answer == 1) != lit).count() as f64 / of().count() as f64
    };
    [share(true), share(false)]
}

#[test]
fn carved_balls_know_light_from_shade_better_than_balls_cut_to_a_fixed_radius() {
    let place = Workplace::new();
    place.summary("simulate town -o town --extent 120 --density 8");
    let truth = truth(&place);
    let by = |flags: &str| errors(&answers(&place, flags), &truth);
    let fixed = by("--orient trajectory=town/trajectory.csv");
    let carved = by("--method carved --orient trajectory=town/trajectory.csv");
    let found = by("--method carved");
    // balanced over both kinds of error; the exact light is that of points 3 cm outside, so that neither can reach zero
    let mean = |errors: [f64; 2]| (errors[0] + errors[1]) / 2.0;
    assert!(mean(carved) < mean(fixed), "carved {carved:?}, cut to half a metre {fixed:?}");
    assert!(mean(carved) < 0.08, "{carved:?}");
    // the scanner found from the pulses themselves serves as well as its trajectory, within half a percent
    assert!((mean(found) - mean(carved)).abs() < 0.005, "{found:?} {carved:?}");
}

#[test]
fn a_carved_ball_file_answers_as_the_cloud_does_and_reports_what_was_cut() {
    let place = Workplace::new();
    place.summary("simulate village -o town --extent 100 --density 6");
    let made = place.summary("balls town/cloud.laz --method carved -o balls.npz");
    let cut = made["interior_balls"]["cut_by_pulses"].as_u64().unwrap();
    assert!(cut > 1000 && made["scanner"]["served_percent"].as_f64().unwrap() > 90.0, "{made}");
    assert!(made["pulses"]["used_to_carve"].as_u64().unwrap() > 10_000);
    place.summary("query town/cloud.laz --method carved --sun 200,40 --random 20000 -o from_cloud.npy");
    for file in ["balls.npz", "balls.ply", "balls.laz"] {
        place.summary(&format!("balls town/cloud.laz --method carved -o {file}"));
        place.summary(&format!("query {file} --sun 200,40 --random 20000 -o from_file.npy"));
        let [cloud, saved] = ["from_cloud.npy", "from_file.npy"].map(|name| fs::read(place.path(name)).unwrap());
        // LAZ keeps centres to a tenth of a millimetre
        let differ = cloud.iter().zip(&saved).filter(|(a, b)| a != b).count();
        assert!(cloud.len() == saved.len() && differ <= if file == "balls.laz" { 20 } else { 0 }, "{file}: {differ}");
    }
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
    let known = by("--method carved");
    // positions alone, in the same order
    let mut reader = las::Reader::from_path(place.path("town/cloud.laz")).unwrap();
    let points = reader.read_all().unwrap();
    let rows: String = points.points().map(Result::unwrap).map(|p| format!("{},{},{}\n", p.x, p.y, p.z)).collect();
    place.write("bare.csv", format!("x,y,z\n{rows}"));
    let made = place.summary("balls bare.csv --method carved -o balls.npz");
    assert!(made["scanner"]["found_by"].as_str().unwrap().contains("assumed"), "{made}");
    assert!(made["normals"]["oriented_by"].as_str().unwrap().starts_with("up"), "{made}");
    place.summary("query bare.csv --method carved --sun 240,35 --self -o answers.npy");
    let bytes = fs::read(place.path("answers.npy")).unwrap();
    let assumed = errors(&npyz::NpyFile::new(&bytes[..]).unwrap().into_vec::<u8>().unwrap(), &truth);
    let mean = |errors: [f64; 2]| (errors[0] + errors[1]) / 2.0;
    // the classes are gone as well as the pulses; guessing answers half of the points right
    assert!(mean(assumed) < mean(known) + 0.12, "{assumed:?} {known:?}");
    let facts = place.summary("info bare.csv");
    assert!(facts["can_serve"]["--method carved"].as_str().unwrap().contains("assumed"), "{facts}");
    assert!(facts["can_serve"]["--orient pulses"].as_str().unwrap().starts_with("no: "), "{facts}");
}
