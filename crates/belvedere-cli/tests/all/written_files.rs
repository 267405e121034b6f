//! Inputs stay as they are, and every output has a name of its own.

use crate::common::{EAST, NORTH, Workplace, house};

#[test]
fn an_output_that_is_an_input_is_refused_before_anything_is_read() {
    let place = Workplace::new();
    place.write_cloud("house.laz", &house());
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
            if parameter["type"] == "path" && is_result && parameter["name"] != "--page" {
                let name = parameter["value_name"].as_str().unwrap();
                assert!(["OUT", "DIR"].contains(&name), "{} {}: {name}", command["name"], parameter["name"]);
                count += 1;
            }
        }
    }
    assert!(count > 30, "{count}");
}
