//! The view of the sky on the command line, around a house whose outline is known.

use crate::common::{EAST, NORTH, Workplace, at, column, is_hidden};
use std::f64::consts::TAU;

const HOUSE: &str = "house.laz --orient given --scene-config ../tau.json --ground found";

/// Sky view factor and openness of a level place beside the exact house, over a fine grid of azimuths and elevations.
fn exact(spot: [f64; 3]) -> [f64; 2] {
    let (azimuths, elevations) = (360, 180);
    let (mut factor, mut openness) = (0.0, 0.0);
    for row in 0..elevations {
        // rings of equal solid angle
        let up = (f64::from(row) + 0.5) / f64::from(elevations);
        let along = (1.0 - up * up).sqrt();
        for column in 0..azimuths {
            let (sin, cos) = (TAU * (f64::from(column) + 0.5) / f64::from(azimuths)).sin_cos();
            if !is_hidden(spot, [along * sin, along * cos, up]) {
                factor += 2.0 * up;
                openness += 1.0;
            }
        }
    }
    [factor, openness].map(|sum| sum / f64::from(azimuths * elevations))
}

#[test]
fn cells_and_points_see_as_much_sky_as_beside_the_exact_house() {
    let place = Workplace::with_house();
    let run = place.summary(&format!(
        "sky-view {HOUSE} --cell 2 --target-height 0.5 -o sky.csv -o sky.tif -o sky.png --measures all"
    ));
    assert_eq!(run["lines_of_sight"]["directions"], 577);
    let columns = ["x", "y", "z", "sky_view_factor", "sky_openness"];
    let [x, y, z, factor, openness] = columns.map(|name| column(&place, "sky.csv", name));
    assert!(factor.len() > 200);
    let (mut queried, mut min) = (0, 1.0_f64);
    for i in 0..factor.len() {
        let spot = [x[i] - EAST, y[i] - NORTH, z[i]];
        if spot[0].abs() < 6.0 && spot[1].abs() < 5.0 {
            continue;
        }
        // walls stand a quarter of a metre forward or back where points are half a metre apart: 0.02 of the sky at a
        // metre from them
        for (found, expected) in [factor[i], openness[i]].into_iter().zip(exact(spot)) {
            assert!((found - expected).abs() < 0.03, "{spot:?}: {found} instead of {expected}");
        }
        assert!((z[i] - 0.5).abs() < 0.2, "targets of cells lie above the ground: {}", z[i]);
        queried += 1;
        min = min.min(openness[i]);
    }
    assert!(queried > 150 && min < 0.75, "{queried} {min}");
    assert!(place.path("all/sky_view_factor.tif").is_file() && place.path("all/sky_openness.tif").is_file());
    assert!(place.path("sky.tif").is_file() && place.bytes("sky.png").starts_with(b"\x89PNG"));

    let spots = [[0.0, 6.0, 0.5], [7.0, 0.0, 2.0], [0.0, 0.0, 9.3], [0.0, 0.0, 50.0]];
    place.write_places("places.csv", &spots);
    for (flags, tolerance) in [("--directions 2305", 0.02), ("--patches tregenza", 0.05), ("--patches reinhart", 0.03)]
    {
        place.summary(&format!("sky-view {HOUSE} --targets places.csv {flags} -o points.csv"));
        let found = ["sky_view_factor", "sky_openness"].map(|name| column(&place, "points.csv", name));
        for (i, &spot) in spots.iter().enumerate() {
            for (found, expected) in found.iter().zip(exact(spot)) {
                assert!(
                    (found[i] - expected).abs() < tolerance,
                    "{flags} {spot:?}: {} instead of {expected}",
                    found[i]
                );
            }
        }
        // from high above nothing is in the way; what patches sum up to is a little off
        assert!(found.iter().all(|found| (found[3] - 1.0).abs() < 1e-3), "{found:?}");
    }
}

#[test]
fn faces_of_a_mesh_see_the_half_that_they_are_turned_to() {
    let place = Workplace::with_house();
    // squares far above the house: up, south, down
    let corners =
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 1.0]];
    let lines: String =
        corners.iter().map(|&[x, y, z]| at(x, y, 60.0 + z)).map(|[x, y, z]| format!("v {x} {y} {z}\n")).collect();
    place.write(
        "squares.obj",
        format!("{lines}o up\nf 1 2 3\nf 1 3 4\no south\nf 1 2 6\nf 1 6 5\no down\nf 1 3 2\nf 1 4 3\n"),
    );
    place.summary(&format!("sky-view {HOUSE} --targets squares.obj --directions 2305 -o faces.csv"));
    // a row for each object, then one for each face
    let [factor, openness] = ["sky_view_factor", "sky_openness"].map(|name| column(&place, "faces.csv", name));
    assert_eq!(factor.len(), 9);
    // half of the sky above a wall; the error of 2305 directions is 0.0015
    for (found, expected) in
        [(factor[0], 1.0), (factor[1], 0.5), (factor[2], 0.0), (openness[0], 1.0), (openness[2], 0.0)]
    {
        assert!((found - expected).abs() < 0.005, "{factor:?} {openness:?}");
    }
    assert!((openness[1] - 0.5).abs() < 0.005, "{openness:?}");
    place.summary(&format!("sky-view {HOUSE} --targets squares.obj --facing level -o level.csv"));
    assert!(column(&place, "level.csv", "sky_view_factor").iter().all(|&factor| factor > 0.999));
}

#[test]
fn cells_of_the_surface_stand_on_the_roof() {
    let place = Workplace::with_house();
    place.summary(&format!("sky-view {HOUSE} --surface --cell 1 --target-height 0 --directions 64 -o roof.csv"));
    let [x, y, z] = ["x", "y", "z"].map(|name| column(&place, "roof.csv", name));
    let mut on_roof = 0;
    for i in 0..x.len() {
        let (east, north) = (x[i] - EAST, y[i] - NORTH);
        if east.abs() < 4.0 && north.abs() < 3.0 {
            // the plane of the roof, and at the ridge the plane through both sides
            assert!((z[i] - (9.0 - 0.75 * north.abs())).abs() < 0.3, "{east} {north}: {}", z[i]);
            on_roof += 1;
        }
    }
    assert_eq!(on_roof, 48);
}

#[test]
fn what_cannot_be_is_refused_with_advice() {
    let place = Workplace::with_house();
    place.write("places.csv", "x,y,z\n85000,446008,0.5\n");
    for (flags, words) in [
        ("--directions 0 -o no.csv", "--directions"),
        ("--directions 100001 -o no.csv", "--directions"),
        ("--directions 145 --patches tregenza -o no.csv", "--patches"),
        ("--patches moonlight -o no.csv", "tregenza"),
        ("--surface --self -o no.csv", "--self"),
        ("--cell 0 -o no.csv", "--cell"),
        ("--cell 1e-9 -o no.csv", "--cell"),
        ("--target-height nan -o no.csv", "--target-height"),
        ("--targets places.csv --target-height 1 -o no.csv", "--target-height"),
        ("--targets places.csv --measures all -o no.csv", "--measures"),
        ("--targets places.csv --facing normals -o no.csv", "belvedere normals"),
        ("--cell 2 -o no.xls", "-o"),
        ("--cell 2 -o no.csv -o no.csv", "two results"),
        ("--cell 2 --shell -1 -o no.csv", "--shell"),
        ("--cell 2 --shell 0.1 -o no.csv", "carved"),
        ("--cell 2", "--output"),
    ] {
        let run = place.run(&format!("sky-view {HOUSE} {flags}"));
        assert!(run.status == 2 && run.stderr.contains(words), "{flags}: {run:?}");
    }
    assert!(place.names().iter().all(|name| !name.starts_with("no.")), "{:?}", place.names());
}
