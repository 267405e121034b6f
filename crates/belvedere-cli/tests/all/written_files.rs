//! Inputs stay as they are, and every output has a name of its own.

use crate::common::{EAST, NORTH, Workplace, house};

#[test]
fn an_output_that_is_an_input_is_refused_before_anything_is_read() {
    let place = Workplace::with_house();
    std::fs::create_dir(place.path("tiles")).unwrap();
    place.write_cloud("tiles/a.laz", &house());
    place.write("targets.csv", format!("x,y,z\n{EAST},{NORTH},20\n"));
    place.write("pairs.csv", "ax,ay,az,bx,by,bz\n");
    place.write("path.csv", "t,x,y,z\n");
    place.write("balls.json", "{}");
    place.write("parcel.geojson", "{}");
    let mut copies = vec!["./house.laz", "tiles/../house.laz"];
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(place.path("house.laz"), place.path("link.laz")).unwrap();
        std::fs::hard_link(place.path("house.laz"), place.path("twin.laz")).unwrap();
        copies.extend(["link.laz", "twin.laz"]);
    }
    let before = place.names().into_iter().filter(|name| name != "tiles");
    let before: Vec<(String, Vec<u8>)> = before.map(|name| (name.clone(), place.bytes(&name))).collect();

    let refused = |arguments: &str, flag: &str, input: &str| {
        let run = place.refusal(2, &format!("-v {arguments}"), &[flag, input, "replace", "another name"]);
        assert_eq!(run.stderr.lines().count(), 1, "nothing is read before: {}", run.stderr);
    };
    for copy in copies {
        refused(&format!("query house.laz --sun 180,30 --self -o {copy}"), copy, "house.laz");
    }
    refused("normals tiles -o tiles/a.laz", "-o tiles/a.laz", "tiles/a.laz");
    refused("query house.laz --sun 180,30 --targets targets.csv -o targets.csv", "-o", "targets.csv");
    refused("line-of-sight house.laz --pairs pairs.csv -o pairs.csv", "-o", "pairs.csv");
    refused("isovist house.laz --observers targets.csv -o out.json -o targets.csv", "-o", "targets.csv");
    refused("viewshed house.laz --observers targets.csv -o out.tif --ground cloud=house.laz -o house.laz", "-o", "laz");
    refused("trajectory house.laz -o house.laz", "-o", "house.laz");
    refused("balls house.laz --orient trajectory=path.csv -o path.csv", "-o", "path.csv");
    refused("balls house.laz --scene-config balls.json -o balls.json", "-o", "balls.json");
    refused(
        "irradiance house.laz --clear-sky bird -o out.tif --planes parcel.geojson --targets parcel.geojson",
        "--planes",
        "parcel.geojson",
    );
    let land = "--parcel parcel.geojson --protect targets.csv";
    refused(&format!("envelope house.laz {land} --tops parcel.geojson -o out.tif"), "--tops", "parcel.geojson");
    refused("comfort house.laz --route targets.csv --routes targets.csv -o out.csv", "--routes", "targets.csv");
    for (name, bytes) in before {
        assert!(place.bytes(&name) == bytes, "{name}");
    }
    assert!(place.names().iter().all(|name| !name.starts_with("out")));
}

#[test]
fn two_results_do_not_share_a_file() {
    let place = Workplace::new();
    place.write("out.tif", "before");
    place.write("a.csv", "x,y\n");
    for (arguments, words) in [
        ("depth-map house.laz --sun 180,30 -o out.npy --ball-ids ./out.npy", ["--ball-ids", "also -o"]),
        ("viewshed house.laz --observer 1,1 -o out.tif --masks out.tif", ["--masks", "two results"]),
        ("comfort house.laz --route a.csv -o out.csv --times out.csv", ["--times", "two results"]),
    ] {
        place.refusal(2, arguments, &words);
    }
    assert_eq!(place.names(), ["a.csv", "out.tif"]);
}

#[test]
fn a_folder_that_was_read_through_its_coordinates_keeps_them() {
    let place = Workplace::new();
    place.write_folder("house", &house());
    let coords = place.bytes("house/coords.npy");
    place.summary("normals house/coords.npy -o house");
    assert!(place.bytes("house/coords.npy") == coords);
}

#[test]
fn every_path_of_a_result_is_known_as_an_output() {
    let program = Workplace::new().summary("describe");
    let mut count = 0;
    for command in program["commands"].as_array().unwrap() {
        for parameter in command["parameters"].as_array().unwrap() {
            let is_result = parameter["heading"] == "Result" || parameter["name"] == "--output";
            // a page gets tables between two of its lines
            if ["path", "folder"].iter().any(|kind| parameter["type"] == *kind)
                && is_result
                && parameter["name"] != "--page"
            {
                let name = parameter["value_name"].as_str().unwrap();
                assert!(["OUT", "DIR"].contains(&name), "{} {}: {name}", command["name"], parameter["name"]);
                count += 1;
            }
        }
    }
    assert!(count > 30, "{count}");
}

/// Message about a file that the system does not let grow.
#[cfg(target_os = "linux")]
const TOO_LARGE: &str =
    "it would be larger than the system lets a file be; raise the limit (ulimit -f), or write to another disk";

/// Runs with files of at most 16 KiB, and what a full disk says: an error of each write.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_leaves_one_clear_line_and_no_file() {
    let place = Workplace::with_house();
    place.summary("balls house.laz -o balls.npz");
    for (arguments, file) in [
        ("balls house.laz -o out.npz", "out.npz"),
        ("balls house.laz -o out", "out/coords.npy"),
        ("query balls.npz --sun 180,30 --random 9999 -o out.csv", "out.csv"),
        ("depth-map balls.npz --sun 180,30 -o out.npy -o out.tif", "out.npy"),
    ] {
        let program = place.command(arguments);
        let mut shell = std::process::Command::new("sh");
        shell.current_dir(place.path(".")).args(["-c", "trap '' XFSZ; ulimit -f 32; exec \"$0\" \"$@\""]);
        let output = shell.arg(program.get_program()).args(program.get_args()).output().unwrap();
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "{arguments}: {stderr}");
        assert_eq!(stderr, format!("error: {file}: {TOO_LARGE}\n"), "{arguments}");
        assert_eq!(place.names(), ["balls.npz", "house.laz"], "{arguments}");
    }
}

#[test]
fn a_depth_map_has_several_outputs() {
    let place = Workplace::with_house();
    let run = place.summary("depth-map house.laz --sun 180,30 -o depth.tif -o depth.png -o depth.npy");
    assert_eq!(run["written"], serde_json::json!(["depth.tif", "depth.png", "depth.npy"]));
    assert_eq!(place.names(), ["depth.npy", "depth.png", "depth.tif", "house.laz"]);
}

#[test]
fn geojson_without_a_reference_system_comes_with_a_warning() {
    let place = Workplace::new();
    let mut nowhere = house();
    nowhere.frame.crs = belvedere::crs::Crs::default();
    place.write_cloud("nowhere.ply", &nowhere);
    let viewshed = format!("viewshed nowhere.ply --observer {EAST},{},5 --cell 2 -o seen.geojson", NORTH - 12.0);
    let run = place.run(&viewshed);
    assert_eq!(run.status, 0, "{run:?}");
    assert!(run.stderr.starts_with("warning: GeoJSON") && run.stderr.contains("--crs EPSG:CODE"), "{run:?}");
    assert_eq!(place.run(&format!("{viewshed} --quiet")).stderr, "");
    assert_eq!(place.run(&format!("{viewshed} --crs EPSG:28992")).stderr, "");
}

#[test]
fn shapes_of_other_formats_are_refused_with_the_conversion_to_run() {
    let place = Workplace::with_house();
    place.write("targets.csv", format!("x,y\n{EAST},{NORTH}\n"));
    let parcel = "envelope house.laz -o out.tif --date 2024-03-21 --protect targets.csv --parcel";
    for (flags, name, words) in [
        ("viewshed house.laz -o out.tif --observers", "cameras.gpkg", "cameras.gpkg: is no GeoPackage"),
        ("isovist house.laz -o out.csv --observers", "cameras.shp", "cameras.shp: is no Shapefile"),
        ("isovist house.laz -o out.csv --observers", "cameras.kml", "ogr2ogr -f GeoJSON cameras.geojson cameras.kml"),
        (parcel, "parcel.gml", "ogr2ogr -f GeoJSON parcel.geojson parcel.gml"),
    ] {
        place.write(name, "binary");
        place.refusal(1, &format!("{flags} {name}"), &[words]);
    }
}

#[test]
fn a_stray_table_in_a_folder_of_tiles_is_skipped_and_named() {
    let place = Workplace::new();
    std::fs::create_dir(place.path("tiles")).unwrap();
    place.write_cloud("tiles/house.laz", &house());
    place.write("tiles/index.csv", "tile,year\nhouse.laz,2024\n");
    let run = place.summary("info tiles");
    assert_eq!(run["points"], house().len());
    let reading = place.summary("balls tiles -o balls.npz")["reading"].clone();
    assert_eq!(reading["skipped_file_count"], 1);
    assert_eq!(reading["skipped_tables"], serde_json::json!(["tiles/index.csv"]));
    // named by itself it is an error, and so is a folder with nothing else
    place.refusal(1, "info tiles/index.csv", &["tiles/index.csv", "without columns x, y and z"]);
    std::fs::remove_file(place.path("tiles/house.laz")).unwrap();
    place.refusal(1, "info tiles", &["tiles", "none with columns x, y and z"]);
}
