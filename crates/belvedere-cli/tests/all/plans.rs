//! Scenes as planned: meshes added to the house whose shadow is known.

use crate::common::{EAST, NORTH, Workplace, at, column, house, remarks};
use belvedere::apps::viewshed::SEEN;
use belvedere::io::{BandLabel, PlacedRaster, read_tif};
use belvedere::results::{Pixels, ResultRaster};

const HOUSE: &str = "house.laz --orient given --scene-config ../tau.json";

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
    let place = Workplace::with_house();
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
    let place = Workplace::with_house();
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

#[test]
fn a_cleared_house_casts_no_shadow_and_another_can_replace_it() {
    let place = Workplace::new();
    let mut cloud = house();
    let class = |position: &[f32; 3]| if position[2].abs() < 0.1 { 2 } else { 6 };
    cloud.attributes.classification = Some(cloud.positions.iter().map(class).collect());
    place.write_cloud("house.laz", &cloud);
    let [[x0, y0, _], [x1, y1, _]] = [at(-5.5, -4.5, 0.0), at(5.5, 4.5, 0.0)];
    let area = format!("{x0},{y0},{x1},{y1}");
    let shadow = format!("shadow {HOUSE} --sun 180,45 --grid-north --cell 0.5 -o lit.csv --clear {area}");
    let run = place.summary(&shadow);
    assert!(run["cleared"]["points_cleared"].as_u64().unwrap() > 500, "{run}");
    let lit = column(&place, "lit.csv", "lit");
    let [x, y] = ["x", "y"].map(|name| column(&place, "lit.csv", name));
    let unlit: Vec<[f64; 3]> =
        (0..lit.len()).filter(|&i| lit[i] != 1.0).map(|i| [x[i] - EAST, y[i] - NORTH, lit[i]]).collect();
    assert!(unlit.is_empty() && lit.len() > 3500, "{unlit:?}");
    // cells where it stood are targets too
    let inside = x.iter().zip(&y).filter(|(x, y)| (**x - EAST).abs() < 4.0 && (**y - NORTH).abs() < 3.0).count();
    assert!(inside > 100, "{inside}");
    place.summary(&shadow.replace(&area, "class:6"));
    assert!(column(&place, "lit.csv", "lit").iter().all(|&lit| lit == 1.0));
    place.write("plan.obj", box_obj([-3.0, -2.0], [3.0, 2.0], 4.0));
    place.summary(&format!("{shadow} --add plan.obj"));
    let [x, y, lit] = ["x", "y", "lit"].map(|name| column(&place, "lit.csv", name));
    let is_right = |i: usize| {
        let [x, y] = [x[i] - EAST, y[i] - NORTH];
        let in_shadow = x.abs() < 3.0 && y > 2.0 && y < 5.9;
        (5.7..6.1).contains(&y) || lit[i] == if in_shadow { 0.0 } else { 1.0 }
    };
    assert!((0..lit.len()).all(is_right) && lit.contains(&0.0));
    place.write("area.geojson", format!(
        r#"{{"type": "Polygon", "crs": {{"type": "name", "properties": {{"name": "EPSG:28992"}}}}, "coordinates": [[[{x0},{y0}],[{x1},{y0}],[{x1},{y1}],[{x0},{y1}],[{x0},{y0}]]]}}"#
    ));
    let of_file = place.summary(&shadow.replace(&area, "area.geojson"));
    assert_eq!(of_file["cleared"], run["cleared"]);
    place.refusal(2, &shadow.replace(&area, "0,0,9,9"), &["--clear", "cloud"]);
    place.refusal(2, &shadow.replace(&area, "5,5,1,1"), &["X0,Y0,X1,Y1"]);
    place.refusal(2, &shadow.replace(&area, "class:2"), &["--clear", "class 2"]);
    place.summary(&format!("balls {HOUSE} -o balls.npz"));
    place.refusal(1, &format!("line-of-sight balls.npz --random 5 -o lines.csv --clear {area}"), &["--clear", "cloud"]);
}

#[test]
fn tables_are_compared_row_by_row_whatever_their_order() {
    let place = Workplace::new();
    std::fs::write(place.path("before.csv"), "name,x,y,hours,class\nb,1,2,4.5,6\na,3,4,2,6\nc,5,6,1,6\n").unwrap();
    std::fs::write(place.path("after.csv"), "name,x,y,hours,class\na,3,4,2.25,6\nb,1,2,1.5,6\nd,7,8,9,6\n").unwrap();
    let run = place.summary("difference before.csv after.csv -o change.csv");
    assert_eq!(
        place.text("change.csv"),
        "name,x,y,class,hours_before,hours_after,hours_change\n\
         b,1,2,6,4.5000,1.5000,-3.0000\na,3,4,6,2.0000,2.2500,0.2500\n"
    );
    let hours = &run["difference"]["columns"]["hours"];
    assert_eq!((hours["rows_gain"].as_u64(), hours["largest_loss"].as_f64()), (Some(1), Some(-3.0)), "{run}");
    assert!(remarks(&run)[0].contains("1 before, 1 after"), "{run}");
    // a value that is gone is a change
    std::fs::write(place.path("light.csv"), "id,first_light\n1,9.5\n2,10\n").unwrap();
    std::fs::write(place.path("dark.csv"), "id,first_light\n1,\n2,10\n").unwrap();
    let gone = place.summary("difference light.csv dark.csv -o gone.csv");
    assert_eq!(gone["difference"]["columns"]["first_light"]["rows_only_before"], 1, "{gone}");
    assert!(place.text("gone.csv").contains("\n1,9.5000,,\n"), "{}", place.text("gone.csv"));
    // without a name, rows are those of the same place
    std::fs::write(place.path("here.csv"), "x,y,hours\n1,2,4\n3,4,5\n").unwrap();
    std::fs::write(place.path("then.csv"), "x,y,hours\n3,4,5\n1,2,4\n").unwrap();
    let same = place.run("difference here.csv then.csv -o same.csv");
    assert!(same.status == 0 && same.stdout.contains("nothing changes in 2 rows"), "{same:?}");
    std::fs::write(place.path("twice.csv"), "x,y,hours\n1,2,4\n1,2,5\n").unwrap();
    std::fs::write(place.path("words.csv"), "x,y,hours\n1,2,many\n3,4,5\n").unwrap();
    for (words, status, said) in [
        ("twice.csv then.csv -o no.csv", 1, "rows 1 and 2 have the same x, y: 1,2"),
        ("here.csv words.csv -o no.csv", 1, "words.csv: row 1: \"many\" in column hours is not a number"),
        ("before.csv words.csv -o no.csv", 1, "words.csv"),
        ("before.csv then.csv -o no.tif", 2, "is a table (.csv)"),
        ("before.csv here.csv -o no.csv --title T", 2, "--title"),
    ] {
        place.refusal(status, &format!("difference {words}"), &[said]);
    }
    assert!(!place.path("no.csv").exists());
}

#[test]
fn differences_are_those_of_the_two_results_cell_by_cell() {
    let place = Workplace::with_house();
    place.write("plan.obj", box_obj([8.0, -2.0], [11.0, 2.0], 4.0));
    let shadow = format!("shadow {HOUSE} --ground found --sun 180,45 --grid-north --cell 0.5");
    place.summary(&format!("{shadow} -o before.tif -o before.csv"));
    place.summary(&format!("{shadow} --add plan.obj -o after.tif -o after.csv"));
    let run = place.summary("difference before.tif after.tif -o change.tif -o change.png -o change.csv");
    let lit = |name: &str| -> std::collections::BTreeMap<[i64; 2], f64> {
        let [x, y, lit] = ["x", "y", "lit"].map(|of| column(&place, name, of));
        (0..lit.len()).map(|i| ([x[i], y[i]].map(|v| (v * 4.0).round() as i64), lit[i])).collect()
    };
    let (before, after) = (lit("before.csv"), lit("after.csv"));
    let lost = before.iter().filter(|(cell, lit)| after.get(*cell).is_some_and(|after| after < lit)).count();
    let gone = before.keys().filter(|cell| !after.contains_key(*cell)).count();
    assert!(lost > 30 && gone > 30);
    let figures = &run["difference"];
    let figure = |name: &str| figures[name].as_f64().unwrap();
    assert_eq!(
        (figure("cells_loss"), figure("cells_gain"), figure("cells_only_before")),
        (lost as f64, 0.0, gone as f64)
    );
    assert_eq!((figure("sum_loss"), figure("area_loss_m2")), (lost as f64 * -0.25, lost as f64 * 0.25));
    for name in ["cells", "cells_loss", "mean_before", "mean_after", "sum_loss"] {
        assert_eq!(column(&place, "change.csv", name), [figure(name)], "{name}");
    }
    assert!(place.bytes("change.png").starts_with(b"\x89PNG"));
    // the raster of the change, read back, lies where the others do
    let again = place.summary("difference before.tif before.tif -o same.tif");
    assert_eq!((&again["difference"]["cells_loss"], &again["difference"]["cells_gain"]), (&0.into(), &0.into()));
    assert!(again["remarks"].is_null() && run["remarks"].is_null());
    let mixed = place.summary("difference before.tif change.tif -o mixed.tif");
    let warning = &remarks(&mixed)[0];
    assert!(["before.tif", "change.tif", "after less before"].iter().all(|part| warning.contains(part)), "{warning}");
    place.summary("difference change.tif change.tif -o same.tif");
    place.summary(&format!("{shadow} --cell 1 -o coarse.tif").replace("--cell 0.5 ", ""));
    place.refusal(1, "difference before.tif coarse.tif -o change.tif", &["coarse.tif", "--cell"]);
    place.refusal(1, "difference before.tif before.csv -o change.tif", &["before.csv"]);
    place.refusal(2, "difference before.tif after.tif -o change.gif", &["extension"]);
}

#[test]
fn the_top_of_what_is_added_is_no_gain_and_a_map_shows_relief() {
    let place = Workplace::with_house();
    place.write("plan.obj", box_obj([8.0, -2.0], [11.0, 2.0], 9.0));
    let hours =
        format!("sun-hours {HOUSE} --ground found --date 2026-03-21 --zone Europe/Amsterdam --cell 1 --surface");
    place.summary(&format!("{hours} -o before.tif"));
    place.summary(&format!("{hours} --add plan.obj -o after.tif"));
    let run = place.summary("difference before.tif after.tif -o level.png -o change.tif");
    let relief = place.summary("difference before.tif after.tif --relief house.laz -o relief.png");
    let note = remarks(&run).into_iter().find(|remark| remark.contains("on top of what was added")).unwrap();
    // cells whose middle is in 3 m by 4 m
    assert!(note.starts_with("12 cells"), "{note}");
    assert_eq!((run["difference"]["cells_gain"].as_u64(), &relief["difference"]), (Some(0), &run["difference"]));
    assert!(run["difference"]["cells_loss"].as_u64().unwrap() > 10, "{run}");
    assert_ne!(place.bytes("level.png"), place.bytes("relief.png"));
    // a band for each result, and its change
    let raster = |name: &str| read_tif(place.path(name)).unwrap();
    let names = |raster: &PlacedRaster| -> Vec<String> {
        std::iter::once(&raster.name).chain(raster.further_bands.iter().map(|band| &band.name)).cloned().collect()
    };
    let (before, after, change) =
        (names(&raster("before.tif")), names(&raster("after.tif")), names(&raster("change.tif")));
    assert!(before.len() > 2 && before == change, "{before:?} {change:?}");
    assert_eq!(after, [&before[..], &["added".to_owned()]].concat());
}

#[test]
fn cells_that_become_unproven_are_neither_gain_nor_loss() {
    let place = Workplace::new();
    let labels = ["visible", "unproven"].map(|name| BandLabel::new(name, "1")).to_vec();
    for (name, seen, unproven) in [
        ("before.tif", vec![0, 1, 1, 1, 255, 0], vec![0, 0, 0, 1, 255, 0]),
        ("after.tif", vec![1, 1, 0, 1, 0, 1], vec![1, 1, 0, 0, 0, 0]),
    ] {
        let pixels = Pixels::answers([seen, unproven], [3, 2]).unwrap();
        let raster = ResultRaster { pixels, labels: labels.clone(), tags: Vec::new(), description: SEEN.to_owned() };
        raster.write(&place.path(name), None).unwrap();
    }
    let run = place.summary("difference before.tif after.tif -o change.csv");
    let cells = ["cells", "cells_gain", "cells_loss", "cells_only_before", "cells_only_after"];
    assert_eq!(cells.map(|name| run["difference"][name].as_u64().unwrap()), [2, 1, 1, 2, 2]);
    let warnings = remarks(&run);
    assert!(warnings[0].contains("before.tif: unproven cells count as cells without a value (1)"), "{warnings:?}");
    assert!(warnings[1].contains("after.tif: unproven cells count as cells without a value (2)"), "{warnings:?}");
}

#[test]
fn far_terrain_hides_what_lies_below_its_horizon() {
    let place = Workplace::with_house();
    let [x, y, z] = at(0.0, 0.0, 12.0);
    place.write("places.csv", format!("x,y,z\n{x},{y},{z}\n"));
    // 30 degrees all around: cos² 30 of the light of an even sky, half of its directions
    place.write("even.csv", "azimuth,elevation\n0,30\n120,30\n240,30\n");
    place.summary(&format!("sky-view {HOUSE} --targets places.csv --horizon even.csv --directions 20000 -o sky.csv"));
    let names = place.text("sky.csv").lines().next().unwrap().to_owned();
    let value = |name: &str| column(&place, "sky.csv", name)[0];
    let found: Vec<f64> =
        names.split(',').filter(|name| name.contains("sky") || name.contains("open")).map(value).collect();
    assert!(found.len() == 2 && (found[0] - 0.75).abs() < 0.003 && (found[1] - 0.5).abs() < 0.003, "{names} {found:?}");
    // a mountain in the south: azimuths of PVGIS count from there, and those of the program from north
    place.write("pvgis.csv", "A\tH_hor\n-90\t0\n0\t30\n90\t0\n180\t0\n");
    place.write("north.csv", "azimuth,elevation\n0,0\n90,0\n180,30\n270,0\n");
    for horizon in ["pvgis.csv", "north.csv"] {
        for (sun, lit) in [("180,25", 0.0), ("180,35", 1.0), ("0,5", 1.0), ("225,14", 0.0), ("225,16", 1.0)] {
            place.summary(&format!("shadow {HOUSE} --targets places.csv --horizon {horizon} --sun {sun} -o lit.csv"));
            assert_eq!(column(&place, "lit.csv", "lit"), [lit], "{horizon} {sun}");
        }
    }
    place.write("wrong.csv", "azimuth,elevation\n0,95\n");
    let shadow = format!("shadow {HOUSE} --targets places.csv --sun 180,25 -o lit.csv --horizon");
    place.refusal(1, &format!("{shadow} wrong.csv"), &["wrong.csv", "90"]);
    place.refusal(1, &format!("{shadow} missing.csv"), &["missing.csv"]);
}
