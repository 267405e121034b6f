//! Clouds of hardly any points, or of no shape, give a result or a clear message.

use crate::common::{Workplace, house};

/// Commands for a cloud.
const COMMANDS: [&str; 8] = [
    "info",
    "normals -o out.laz",
    "normals -o out-folder",
    "balls -o out.npz",
    "balls -o out-balls --simplify 0.4",
    "depth-map --sun 180,30 -o out.tif",
    "depth-map --direction 0,0,-1 -o out.png",
    "query --sun 180,30 --random 10 -o out.csv",
];

/// Runs everything; what fails must say so in one line that begins with `error: `.
fn run_everything(place: &Workplace, name: &str) -> usize {
    let mut done = 0;
    for command in COMMANDS {
        for flags in ["", "--scene-config ../keeping.json", "--scene-config ../angles.json"] {
            let arguments = format!("{command} {name} {}", if command.starts_with("info") { "" } else { flags });
            let run = place.run(&arguments);
            if run.status == 0 {
                // of a handful of points some lie inside the balls of the others
                assert!(run.stderr.lines().all(|line| line.starts_with("note: ")), "{arguments}: {run:?}");
                done += 1;
            } else {
                assert_eq!(run.status, 1, "{arguments}: {run:?}");
                assert!(run.stderr.starts_with("error: ") && run.stderr.lines().count() == 1, "{arguments}: {run:?}");
                assert_eq!(run.stdout, "", "{arguments}");
            }
        }
    }
    assert!(place.names().iter().all(|name| !name.starts_with('.')), "{:?}", place.names());
    done
}

#[test]
fn a_handful_of_points_is_no_reason_to_crash() {
    let points = ["85000 446000 1", "85001 446000 1", "85000 446001 1.5", "85001 446001 2"];
    for count in 1..=4 {
        let place = Workplace::new();
        place.write("points.xyz", points[..count].join("\n"));
        // `info` at least, three times
        assert!(run_everything(&place, "points.xyz") >= 3, "{count} points");
    }
}

#[test]
fn points_in_one_place_or_on_a_line_are_no_reason_to_crash() {
    let rows = |row: fn(usize) -> String| (0..200).map(row).collect::<Vec<String>>().join("\n");
    for (name, text) in [
        ("equal.xyz", rows(|_| "85000.5 446000.5 3.25".to_owned())),
        ("line.xyz", rows(|i| format!("{} {} {}", 85_000.0 + i as f64 * 0.5, 446_000.0 + i as f64 * 0.25, 2.0))),
        ("upright.xyz", rows(|i| format!("85000 446000 {}", i as f64 * 0.25))),
        ("plane.xyz", rows(|i| format!("{} {} 0", i % 20, i / 20))),
    ] {
        let place = Workplace::new();
        place.write(name, text);
        assert!(run_everything(&place, name) >= 3, "{name}");
    }
}

#[test]
fn a_cloud_that_cleaning_empties_names_the_flags_that_keep_it() {
    let place = Workplace::new();
    place.write("noise.csv", "x,y,z,classification\n1,1,1,7\n2,2,2,7\n3,3,3,18\n4,4,4,7\n");
    place.refusal(1, "balls noise.csv -o out.npz", &["noise.csv: no points are left", "4 were read", "--keep-noise"]);
    assert_eq!(place.names(), ["noise.csv"]);
}

#[test]
fn a_ball_file_without_balls_shows_nothing() {
    let place = Workplace::new();
    // a plane has no inside: no ball meets a second point, and the paper's method uses none that does not
    let rows: Vec<String> = (0..400).map(|i| format!("{},{},0,0,0,1\n", i % 20, i / 20)).collect();
    place.write("plane.csv", format!("x,y,z,nx,ny,nz\n{}", rows.concat()));
    let summary = place.summary("balls plane.csv --method angles -o balls.npz");
    assert_eq!(summary["interior_balls"]["balls_shrunk"], 0);
    // the file knows where its scene is
    let summary = place.summary("depth-map balls.npz --direction 0,0,-1 -o out.npy");
    assert_eq!(summary["pixels_hit_percent"], 0.0);
    // by default its surface blocks: balls of half a metre, a metre apart, cover three quarters of it
    let summary = place.summary("balls plane.csv -o skin.npz");
    assert_eq!(summary["interior_balls"]["balls_limited"], 400);
    let summary = place.summary("depth-map skin.npz --direction 0,0,-1 -o out.npy");
    assert!(summary["pixels_hit_percent"].as_f64().unwrap() > 70.0, "{summary}");
}

#[test]
fn a_cloud_with_y_up_answers_as_the_same_cloud_with_z_up() {
    let place = Workplace::new();
    let cloud = house();
    let row = |[x, y, z]: [f32; 3], [nx, ny, nz]: [f32; 3]| format!("{x},{y},{z},{nx},{ny},{nz}\n");
    let rows = |turn: fn([f32; 3]) -> [f32; 3]| {
        let normals = cloud.attributes.normals.as_ref().unwrap();
        let rows: String = cloud.positions.iter().zip(normals).map(|(&p, &n)| row(turn(p), turn(n))).collect();
        format!("x,y,z,nx,ny,nz\n{rows}")
    };
    place.write("z.csv", rows(|v| v));
    // up is the second, and north runs away from the viewer
    place.write("y.csv", rows(|[x, y, z]| [x, z, -y]));
    let ask = "--scene-config ../tau.json --orient given --sun 180,30 --random 500 -o";
    place.summary(&format!("query z.csv {ask} z-answers.npy"));
    place.summary(&format!("query y.csv --up y {ask} y-answers.npy"));
    assert_eq!(place.bytes("z-answers.npy"), place.bytes("y-answers.npy"));
    place.summary("balls y.csv --up y --method tau --orient given -o y.npz");
    place.refusal(2, &format!("query y.npz --up y {ask} a.npy"), &["--up", "ball file"]);
}
