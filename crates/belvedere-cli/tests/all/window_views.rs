//! The view from windows on the command line.

use crate::common::{Workplace, at, house_in_a_field, numbers};
use belvedere::control::Control;
use belvedere::io::{ReadOptions, read_cloud};
use serde_json::Value;

const BALLS: &str = "--orient given --scene-config ../tau.json";

/// A house in a field with classes, and three windows: one that looks at the house, one that looks away from it, one
/// inside it.
fn place() -> Workplace {
    let place = Workplace::new();
    let mut cloud = house_in_a_field();
    let class = |normal: &[f32; 3]| if normal[2] > 0.99 { 2 } else { 6 };
    cloud.attributes.classification = cloud.attributes.normals.as_ref().map(|all| all.iter().map(class).collect());
    place.write_cloud("house.laz", &cloud);
    let row = |[x, y, z]: [f64; 3], azimuth: u32, building: &str| {
        let [x, y, z] = at(x, y, z);
        format!("{x},{y},{z},{azimuth},{building},\"no. 1, left\"\n")
    };
    let rows =
        [row([12.0, 0.0, 3.0], 270, "mill"), row([12.0, 0.0, 3.0], 90, "barn"), row([-4.6, 0.15, 2.25], 0, "mill")];
    place.write("windows.csv", format!("x,y,z,azimuth,name,note\n{}", rows.concat()));
    place
}

/// A column of a table, NaN where a cell is empty.
fn column(place: &Workplace, name: &str, column: &str) -> Vec<f64> {
    numbers(&place.text(name).replace("\"no. 1, left\"", "note"), column)
}

#[test]
fn views_of_a_house_are_rows_points_maps_and_means_of_buildings() {
    let place = place();
    let run = place.summary(&format!(
        "window-views house.laz {BALLS} --windows windows.csv --grid-north -o views.csv -o views.geojson -o views.laz -o views.png --map-of building --buildings buildings.csv"
    ));
    assert_eq!((&run["windows"]["windows"], &run["targets_inside_obstacle"]), (&3.into(), &1.into()), "{run}");
    let shares: Vec<Vec<f64>> = ["sky", "vegetation", "water", "building", "ground", "other", "beyond"]
        .map(|name| column(&place, "views.csv", name))
        .to_vec();
    for row in 0..2 {
        // three decimals of seven shares
        assert!((shares.iter().map(|share| share[row]).sum::<f64>() - 100.0).abs() < 0.004, "{shares:?}");
    }
    assert!(shares.iter().all(|share| share[2].is_nan()), "the window inside has no view");
    let [sky, building, ground] = [&shares[0], &shares[3], &shares[4]];
    // 8 m wide and 6 to 9 m high, 7 m away: between the solid angles of the rectangles up to the eaves and to the ridge
    let corner = |a: f64, b: f64| 2.0 * (a * b / (7.0 * (49.0 + a * a + b * b).sqrt())).atan();
    let seen = |top: f64| 100.0 * (corner(4.0, top) + corner(4.0, 3.0)) / std::f64::consts::TAU;
    assert!(building[0] > seen(3.0) - 2.0 && building[0] < seen(6.0) + 2.0, "{building:?} {} {}", seen(3.0), seen(6.0));
    assert!(building[1] == 0.0 && (sky[1] - 50.0).abs() < 0.2 && ground[1] > 40.0, "{shares:?}");
    // what the table said of a window stays beside its view
    let text = place.text("views.csv");
    assert!(text.lines().nth(1).unwrap().contains(",mill,\"no. 1, left\","), "{text}");

    let json: Value = serde_json::from_str(&place.text("views.geojson")).unwrap();
    assert_eq!(json["features"].as_array().unwrap().len(), 3);
    let properties = &json["features"][0]["properties"];
    assert_eq!((properties["building"].as_f64().unwrap(), &properties["name"]), (building[0], &"mill".into()));
    assert_eq!((&json["features"][2]["properties"]["sky"], &properties["azimuth"]), (&Value::Null, &270.0.into()));
    let (points, _) = read_cloud(&[place.path("views.laz")], &ReadOptions::default(), &Control::none()).unwrap();
    assert_eq!(points.len(), 3);
    assert!(place.bytes("views.png").starts_with(b"\x89PNG"));
    let buildings = place.text("buildings.csv");
    let rows: Vec<&str> = buildings.lines().collect();
    assert!(rows.len() == 3 && rows[1].starts_with("mill,1,") && rows[2].starts_with("barn,1,"), "{buildings}");
    assert!((column(&place, "buildings.csv", "building")[0] - building[0]).abs() < 0.0011);

    // faces of a mesh: the wall is a window, the roof is none; the name of the object is the building
    let corners = [[12.0, -1.0, 2.0], [12.0, 1.0, 2.0], [12.0, 1.0, 4.0], [11.0, -1.0, 4.0], [11.0, 1.0, 4.0]];
    let vertices: String =
        corners.iter().map(|&[x, y, z]| format!("v {} {} {}\n", at(x, y, z)[0], at(x, y, z)[1], z)).collect();
    place.write("wall.obj", format!("{vertices}o wall\nf 1 2 3\no roof\nf 3 4 5\n"));
    let run = place.summary(&format!(
        "window-views house.laz {BALLS} --windows wall.obj --directions 100 -o faces.csv --buildings of_mesh.csv"
    ));
    assert!(run["windows"]["targets_on_roofs_and_floors"].as_u64().unwrap() > 0, "{run}");
    let sky = column(&place, "faces.csv", "sky");
    assert!(sky[0].is_finite() && sky[1].is_nan(), "{sky:?}");
    let roof = format!("window-views house.laz {BALLS} --windows wall.obj --object roof -o no.csv");
    place.refusal(1, &roof, &["wall.obj", "no window is left", "roofs"]);
    assert!(place.text("of_mesh.csv").lines().any(|line| line.starts_with("wall,1,")));
}

#[test]
fn a_ball_file_takes_the_classes_of_its_cloud_and_of_no_other() {
    let place = place();
    let views = "--windows windows.csv --grid-north --directions 200";
    place.summary(&format!("window-views house.laz {BALLS} {views} -o of_cloud.csv"));
    place.summary(&format!("balls house.laz {BALLS} -o house.npz"));
    let run =
        place.summary(&format!("window-views house.npz {views} --classes-of house.laz -o of_balls.csv -o map.png"));
    assert!(place.bytes("of_balls.csv") == place.bytes("of_cloud.csv"), "{run}");
    let run = place.summary(&format!("window-views house.npz {views} -o without.csv"));
    assert!(run["remarks"].to_string().contains("give the cloud that the balls were built from"), "{run}");
    assert_eq!(column(&place, "without.csv", "building")[0], 0.0);
    // a class can mean something else
    place.summary(&format!("window-views house.npz {views} --classes-of house.laz --class 6=water -o water.csv"));
    assert_eq!(column(&place, "water.csv", "water")[0], column(&place, "of_cloud.csv", "building")[0]);
    let mut other = house_in_a_field();
    other.positions.reverse();
    other.attributes.normals = None;
    place.write_cloud("other.laz", &other);
    place.refusal(1, &format!("window-views house.npz {views} --classes-of other.laz -o no.csv"), &["not built from"]);
    place.refusal(1, &format!("window-views house.npz {views} -o no.png"), &["--classes-of"]);
    place.refusal(
        2,
        &format!("window-views house.laz {BALLS} {views} --classes-of house.laz -o no.csv"),
        &["ball files"],
    );
}

#[test]
fn window_views_refuse_what_they_cannot_do() {
    let place = place();
    place.write("plain.csv", "x,y,z,azimuth\n100000,400000,3,0\n");
    let views = format!("window-views house.laz {BALLS} --windows windows.csv");
    for (flags, words) in [
        ("-o a.tif", &["-o", ".geojson"][..]),
        ("-o a.csv --class 6", &["--class", "26=ground"]),
        ("-o a.csv --class 6=sky", &["--class", "vegetation"]),
        ("-o a.csv --class 256=water", &["--class", "0 to 255"]),
        ("-o a.csv --map-of water", &["--map-of", "png"]),
        ("-o a.png --map-of beyond", &["--map-of", "vegetation"]),
        ("-o a.csv --directions 0", &["--directions"]),
        ("-o a.csv --directions 1000000", &["--directions", "100000"]),
        ("-o a.csv --spacing 1", &["--spacing", "mesh"]),
        ("-o a.csv --object mill", &["--object", "mesh"]),
        ("-o a.csv --unproven as-blocked", &["--unproven"]),
        ("-o a.csv --buildings b.tif", &["--buildings", ".csv"]),
    ] {
        place.refusal(2, &format!("{views} {flags}"), words);
    }
    let plain = format!("window-views house.laz {BALLS} --windows plain.csv -o a.csv");
    place.refusal(1, &format!("{plain} --buildings b.csv"), &["column name"]);
    place.refusal(2, &plain, &["--windows", "all outside of the cloud", "x 100000 to 100000"]);
}
