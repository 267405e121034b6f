//! Scenes as planned: meshes added to the house whose shadow is known.

use crate::common::{EAST, NORTH, Workplace, at, column, house};

const HOUSE: &str = "house.laz --orient given --method tau";

/// Corners of an upright box as an OBJ file, without a bottom.
pub(crate) fn box_obj([x0, y0]: [f64; 2], [x1, y1]: [f64; 2], top: f64) -> String {
    let corners = [[x0, y0], [x1, y0], [x1, y1], [x0, y1]];
    let mut text = "o planned\n".to_owned();
    for z in [0.0, top] {
        for [x, y] in corners {
            let [x, y, z] = at(x, y, z);
            text += &format!("v {x} {y} {z}\n");
        }
    }
    text + "f 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\nf 5 6 7 8\n"
}

#[test]
fn an_added_building_casts_its_shadow_and_carries_cells() {
    let place = Workplace::new();
    place.write_cloud("house.laz", &house());
    place.write("plan.obj", box_obj([8.0, -2.0], [11.0, 2.0], 4.0));
    let run = place.summary(&format!(
        "shadow {HOUSE} --ground found --add plan.obj --sun 180,45 --grid-north --cell 0.5 -o lit.csv"
    ));
    assert_eq!((&run["plan"]["meshes_added"], &run["plan"]["triangles"]), (&1.into(), &10.into()));
    let [x, y, lit] = ["x", "y", "lit"].map(|name| column(&place, "lit.csv", name));
    let mut shaded = 0;
    for i in 0..lit.len() {
        let [x, y] = [x[i] - EAST, y[i] - NORTH];
        // cells inside are left out
        assert!(!(x > 8.0 && x < 11.0 && y.abs() < 2.0), "{x} {y}");
        // the ground is 0.08 m rough, and cells are 0.1 m above it
        if x > 6.0 && !(5.75..6.05).contains(&y) {
            let in_shadow = x > 8.0 && x < 11.0 && y > 2.0 && y < 5.9;
            assert_eq!(lit[i], if in_shadow { 0.0 } else { 1.0 }, "{x} {y}");
            shaded += usize::from(in_shadow);
        }
    }
    assert!(shaded > 30, "{shaded}");
    // on top of it cells are higher than the cloud, and lit
    place.summary(&format!(
        "shadow {HOUSE} --ground found --add plan.obj --sun 180,45 --grid-north --cell 0.5 --surface -o top.csv"
    ));
    let [x, y, z, lit] = ["x", "y", "z", "lit"].map(|name| column(&place, "top.csv", name));
    let on_top = |i: &usize| (8.0..11.0).contains(&(x[*i] - EAST)) && (y[*i] - NORTH).abs() < 2.0;
    let tops: Vec<usize> = (0..lit.len()).filter(on_top).collect();
    assert!(tops.len() > 40 && tops.iter().all(|&i| (z[i] - 4.1).abs() < 2e-3 && lit[i] == 1.0));
}

#[test]
fn lines_of_sight_name_the_mesh_that_blocks_and_wrong_meshes_are_refused_by_name() {
    let place = Workplace::new();
    place.write_cloud("house.laz", &house());
    place.write("plan.obj", box_obj([8.0, -2.0], [11.0, 2.0], 4.0));
    let row = |a: [f64; 3], b: [f64; 3]| format!("{},{},{},{},{},{}\n", a[0], a[1], a[2], b[0], b[1], b[2]);
    let pairs = row(at(13.0, 0.0, 2.0), at(6.5, 0.5, 2.0))
        + &row(at(13.0, 0.0, 5.0), at(6.5, 0.5, 5.0))
        + &row(at(-9.0, 0.0, 2.0), at(6.5, 0.5, 2.0));
    place.write("pairs.csv", format!("ax,ay,az,bx,by,bz\n{pairs}"));
    let run = place.summary(&format!("line-of-sight {HOUSE} --add plan.obj --pairs pairs.csv -o lines.csv"));
    assert_eq!((&run["lines_of_sight"]["visible"], &run["lines_of_sight"]["blocked"]), (&1.into(), &2.into()));
    let lines = place.text("lines.csv");
    let meshes: Vec<&str> = lines.lines().map(|line| line.rsplit(',').next().unwrap()).collect();
    assert_eq!(meshes, ["block_mesh", "plan.obj", "", ""]);
    assert!(
        (column(&place, "lines.csv", "first_block_range_m")[0] - 2.0 * (1.0 + (0.5_f64 / 6.5).powi(2)).sqrt()).abs()
            < 1e-3
    );
    place.write("far.obj", box_obj([800.0, 0.0], [810.0, 9.0], 4.0));
    place.write("empty.obj", "v 0 0 0\n");
    let shadow = format!("shadow {HOUSE} --ground found --sun 270,45 -o lit.csv --add");
    place.refusal(2, &format!("{shadow} far.obj"), &["far.obj", "cloud"]);
    place.refusal(1, &format!("{shadow} empty.obj"), &["empty.obj"]);
    place.refusal(1, &format!("{shadow} missing.obj"), &["missing.obj"]);
}
