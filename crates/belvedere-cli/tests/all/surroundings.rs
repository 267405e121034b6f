//! Meshes as targets, landmarks, isovists and horizons on the command line.

use crate::common::{EAST, NORTH, Workplace, at, column, house_in_a_field};

/// A house as a cloud, and a wall of 10 m by 6 m as a mesh 30 m east of it that faces west.
fn place() -> Workplace {
    let place = Workplace::with_house();
    let corners = [[30.0, -5.0, 0.5], [30.0, 5.0, 0.5], [30.0, 5.0, 6.5], [30.0, -5.0, 6.5]];
    let vertices: String = corners
        .iter()
        .map(|&[x, y, z]| {
            let [x, y, z] = at(x, y, z);
            format!("v {x} {y} {z}\n")
        })
        .collect();
    place.write("wall.obj", format!("{vertices}o wall, west\nf 1 4 3 2\no back\nf 1 2 3 4\n"));
    place
}

/// The same with ground below the wall and those who look at it.
fn wide_place() -> Workplace {
    let place = place();
    place.write_cloud("house.laz", &house_in_a_field());
    place
}

const HOUSE: &str = "house.laz --orient given --scene-config ../tau.json";

/// Cells of a table below its header, by the names in it.
fn rows(place: &Workplace, name: &str) -> (Vec<String>, Vec<Vec<String>>) {
    let text = place.text(name);
    let mut lines = text.lines().map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
    (lines.next().unwrap(), lines.collect())
}

#[test]
fn a_mesh_as_target_is_answered_by_object_and_face() {
    let place = wide_place();
    let eye = at(15.0, 0.0, 3.0).map(|v| v.to_string()).join(",");
    let run = place.summary(&format!("query {HOUSE} --panorama {eye} --targets wall.obj -o seen.csv"));
    assert_eq!(run["faces"]["count"], 4);
    assert!((run["faces"]["visible_percent"].as_f64().unwrap() - 50.0).abs() < 1e-6);
    let text = place.text("seen.csv");
    // a name with a comma is quoted; objects come first, without a face
    assert!(text.lines().nth(1).unwrap().starts_with("\"wall, west\",,60.0000,60.0000,1.0000,"), "{text}");
    assert!(text.lines().nth(2).unwrap().starts_with("back,,60.0000,0.0000,0.0000,"), "{text}");
    assert_eq!(text.lines().count(), 1 + 2 + 4);
    // behind the house its 9 m hide the wall but for what shows beside it
    let eye = at(-13.0, 0.0, 1.7).map(|v| v.to_string()).join(",");
    let run = place
        .summary(&format!("query {HOUSE} --panorama {eye} --targets wall.obj --back-faces left-out -o hidden.csv"));
    assert!(run["faces"]["visible_percent"].as_f64().unwrap() < 2.0, "{run}");
    assert!((run["faces"]["area_m2"].as_f64().unwrap() - 60.0).abs() < 0.01);
    place.summary(&format!("query {HOUSE} --direction 1,0,0 --targets wall.obj --back-faces both-sides -o seen.ply"));
    let (mesh, _) = belvedere::io::read_mesh(&place.path("seen.ply")).unwrap();
    assert_eq!((mesh.triangles.len(), mesh.vertices.len()), (4, 12));
    assert!((mesh.area() - 120.0).abs() < 1e-6);
    assert!((mesh.vertices[0][0] - (EAST + 30.0)).abs() < 1e-9);
    // a PLY with faces is a mesh, too
    let run = place.summary(&format!("query {HOUSE} --direction 1,0,0 --targets seen.ply -o again.csv"));
    assert_eq!(run["faces"]["count"], 4);
}

#[test]
fn meshes_refuse_what_is_for_points_and_points_what_is_for_meshes() {
    let place = place();
    let wall = format!("query {HOUSE} --direction 1,0,0 --targets wall.obj");
    place.refusal(2, &format!("{wall} --bias 1 -o seen.csv"), &["--bias"]);
    place.refusal(2, &format!("{wall} -o seen.npy"), &["-o", ".csv"]);
    place.refusal(2, &format!("{wall} --spacing 0.00001 -o seen.csv"), &["--spacing", "50 million"]);
    let own = format!("query {HOUSE} --direction 1,0,0 --self");
    place.refusal(2, &format!("{own} --spacing 1 -o seen.csv"), &["--spacing", "mesh"]);
    place.refusal(2, &format!("{own} --back-faces left-out -o seen.csv"), &["--back-faces"]);
}

#[test]
fn landmarks_give_tables_rasters_and_maps() {
    let place = wide_place();
    let wall = format!("landmark {HOUSE} --targets wall.obj --object back");
    let (east, west) = (at(40.0, 0.0, 3.5), at(0.0, 0.0, 14.0));
    place.write(
        "eyes.csv",
        format!("x,y,z\n{},{},{}\n{},{},{}\n", east[0], east[1], east[2], west[0], west[1], west[2]),
    );
    let run = place.summary(&format!("{wall} --observers eyes.csv -o views.csv"));
    assert_eq!(run["observers"]["count"], 2);
    // the back faces east: 10 m before it, 10 m wide and 6 m high, all is seen
    assert_eq!(column(&place, "views.csv", "visible_share"), [1.0, 0.0]);
    let solid_angle = 4.0 * (60.0f64 / (2.0 * 10.0 * (400.0f64 + 136.0).sqrt())).atan();
    assert!((column(&place, "views.csv", "solid_angle_sr")[0] - solid_angle).abs() < 1e-3);
    let extent = 2.0 * 0.5f64.atan().to_degrees();
    assert!((column(&place, "views.csv", "horizontal_extent_deg")[0] - extent).abs() < 1e-2);
    assert!((column(&place, "views.csv", "horizon_share")[0] - extent / 360.0).abs() < 1e-4);
    assert!(column(&place, "views.csv", "nearest_m")[1].is_nan());
    let run = place.summary(&format!(
        "landmark {HOUSE} --ground found --targets wall.obj --cell 2 --measures all -o share.tif -o share.png -o grid.csv"
    ));
    let standing = run["observers"]["count"].as_u64().unwrap();
    // nobody stands where a roof covers the ground
    assert!(run["cells_under_cover_left_out"].as_u64().unwrap() > 0, "{run}");
    assert_eq!(column(&place, "grid.csv", "x").len() as u64, standing);
    let mut tif = tiff::decoder::Decoder::new(std::fs::File::open(place.path("share.tif")).unwrap()).unwrap();
    let tiff::decoder::DecodingResult::F32(shares) = tif.read_image().unwrap() else { unreachable!() };
    assert_eq!(shares.iter().filter(|share| **share >= 0.0).count() as u64, standing);
    assert!(shares.contains(&-9999.0) && shares.iter().any(|share| *share > 0.3));
    assert_eq!(std::fs::read_dir(place.path("all")).unwrap().count(), 9);
    assert!(place.bytes("share.png").starts_with(b"\x89PNG"));
    let ring = [[-6.0, -5.0], [6.0, -5.0], [6.0, 5.0], [-6.0, 5.0]];
    let ring: String = ring.iter().map(|[x, y]| format!("{},{}\n", EAST + x, NORTH + y)).collect();
    place.write("ring.csv", format!("x,y\n{ring}"));
    let run =
        place.summary(&format!("landmark {HOUSE} --ground found --target-polygon ring.csv --cell 6 -o house.csv"));
    assert!(run["landmark"]["area_m2"].as_f64().unwrap() > 150.0, "{run}");
}

#[test]
fn landmarks_say_what_is_wrong_with_them() {
    let place = place();
    place.refusal(1, &format!("landmark {HOUSE} --targets wall.obj --object tower -o a.csv"), &["tower", "wall, west"]);
    place.refusal(2, &format!("landmark {HOUSE} -o a.csv"), &["--targets"]);
    place.refusal(1, &format!("landmark {HOUSE} --target-class 6 -o a.csv"), &["class"]);
    place.write("eyes.csv", "x,y\n1,2\n");
    place.refusal(2, &format!("landmark {HOUSE} --targets wall.obj --observers eyes.csv -o a.tif"), &["grid", ".csv"]);
    place.refusal(
        1,
        &format!("landmark {HOUSE} --targets wall.obj --observers eyes.csv -o a.csv"),
        &["observer 1", "outside the cloud"],
    );
    place.write("line.csv", "x,y\n1,2\n3,4\n");
    place.refusal(1, &format!("landmark {HOUSE} --target-polygon line.csv -o a.csv"), &["three corners"]);
    assert!(!place.names().contains(&"a.csv".to_owned()));
}

#[test]
fn isovists_and_horizons_of_a_house_are_those_of_its_shape() {
    let place = place();
    let eye = at(0.0, -14.0, 1.7).map(|v| v.to_string()).join(",");
    let run =
        place.summary(&format!("isovist {HOUSE} --observer {eye} --max-distance 30 -o one.csv -o one.json -o one.png"));
    // the wall of the house is 10 m north of the eye
    let nearest = run["isovist"]["plan_range_min_m"].as_f64().unwrap();
    assert!((nearest - 10.0).abs() < 0.3, "{run}");
    // it takes 2 atan(1/2) of the plane, all else is open
    let open = 1.0 - 2.0 * 0.5f64.atan() / std::f64::consts::TAU;
    assert!((run["isovist"]["plan_openness"].as_f64().unwrap() - open).abs() < 0.01, "{run}");
    // one edge at each end of the wall, from 11.2 m to 30 m
    assert!((run["isovist"]["plan_occlusivity_m"].as_f64().unwrap() - 37.6).abs() < 3.0, "{run}");
    let json: serde_json::Value = serde_json::from_str(&place.text("one.json")).unwrap();
    assert_eq!(
        json["isovists"][0]["volume_m3"].as_f64().unwrap().round(),
        column(&place, "one.csv", "volume_m3")[0].round()
    );
    assert!(json["isovists"][0]["plan_corners_azimuth_deg_range_m"].as_array().unwrap().len() >= 1440);

    place
        .summary(&format!("horizon {HOUSE} --grid-north --observer {eye} -o sky.csv -o sky.txt -o sky.hor -o sky.png"));
    let (names, _) = rows(&place, "sky.csv");
    assert_eq!(names, ["azimuth", "elevation"]);
    assert_eq!(column(&place, "sky.csv", "azimuth"), (0..360).map(f64::from).collect::<Vec<_>>());
    let elevations = column(&place, "sky.csv", "elevation");
    // due north the ridge, 7.3 m above the eye at 14 m, stands above the eaves, 4.3 m at 10 m
    let ridge = (7.3f64 / 14.0).atan().to_degrees();
    assert!((elevations[0] - ridge).abs() < 1.0, "{} {ridge}", elevations[0]);
    assert!(elevations[180] < 2.0 && elevations[45] < 2.0);
    let lines: Vec<f64> = place.text("sky.txt").lines().map(|line| line.parse().unwrap()).collect();
    assert!(lines.iter().zip(&elevations).all(|(line, elevation)| (line - elevation).abs() < 0.0051));
    // azimuths of PV*SOL count from south, west positive
    let text = place.text("sky.hor");
    let lines: Vec<(f64, f64)> = text
        .lines()
        .map(|line| {
            line.split_once(' ').map(|(azimuth, elevation)| (azimuth.parse().unwrap(), elevation.parse().unwrap()))
        })
        .collect::<Option<_>>()
        .unwrap();
    assert_eq!((lines.len(), lines[0].0, lines[180].0, lines[359].0), (360, -180.0, 0.0, 179.0));
    assert!(lines.iter().zip(&elevations).all(|((_, elevation), other)| (elevation - other).abs() < 0.0051));
    // true north differs: west of the middle of the grid it is turned by some tenths of a degree
    let run = place.summary(&format!("horizon {HOUSE} --observer {eye} --angle-step-deg 7.5 --below keep -o true.csv"));
    let convergence = run["meridian_convergence_deg"].as_f64().unwrap();
    assert!((-1.2..-0.5).contains(&convergence), "{convergence}");
    assert_eq!(column(&place, "true.csv", "azimuth")[1], 7.5);
    assert!(column(&place, "true.csv", "elevation").iter().any(|v| *v < 0.0));

    // several eyes on the ground that is found below them: a column, or a row, each
    let eyes: String = [-13.0, 13.0].iter().map(|y| format!("{},{}\n", EAST, NORTH + y)).collect();
    place.write("eyes.csv", format!("x,y\n{eyes}"));
    place.summary(&format!("horizon {HOUSE} --observers eyes.csv -o two.csv"));
    assert_eq!(rows(&place, "two.csv").0, ["azimuth", "elevation_1", "elevation_2"]);
    place.summary(&format!("isovist {HOUSE} --observers eyes.csv -o two_isovists.csv"));
    let heights = column(&place, "two_isovists.csv", "z");
    assert!(heights.len() == 2 && heights.iter().all(|z| (z - 1.7).abs() < 0.1), "{heights:?}");
    place.refusal(2, &format!("horizon {HOUSE} --observers eyes.csv -o two.txt"), &[".csv"]);
    place.refusal(2, &format!("isovist {HOUSE} --observers eyes.csv -o two.png"), &["single observer"]);
    place.refusal(
        2,
        &format!("horizon {HOUSE} --observer {eye} --angle-step-deg 7 -o sky.csv"),
        &["--angle-step-deg", "360"],
    );
    place.refusal(2, &format!("isovist {HOUSE} --observer {eye} --angle-step-deg 100 -o a.csv"), &["--angle-step-deg"]);
    let far = format!("{},{}", EAST + 500.0, NORTH);
    place.refusal(1, &format!("horizon {HOUSE} --observer {far} -o sky.csv"), &["observer 1", "outside the cloud"]);
}
