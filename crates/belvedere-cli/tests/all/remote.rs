//! Clouds, tiles and other files on a web server work as files do.

use crate::common::Workplace;
use crate::web_server::{Manner, WebServer};

#[test]
fn results_are_the_same_from_a_server_and_from_the_disk() {
    let place = Workplace::new();
    place.run("simulate village -o town --extent 80 --density 3");
    place.run("balls town/cloud.laz -o balls.laz");
    place.write("house.obj", "v 154980 462980 0\nv 154990 462980 0\nv 154985 462990 9\nf 1 2 3\n");
    let files = [("cloud.laz", "town/cloud.laz"), ("balls.laz", "balls.laz"), ("house.obj", "house.obj")];
    let bytes = files.map(|(name, path)| (name, std::fs::read(place.path(path)).unwrap()));
    let server = WebServer::start(bytes, Manner::Parts);
    for (name, path) in files {
        let input = match name {
            "house.obj" => format!("town/cloud.laz --add {path}"),
            "balls.laz" => format!("{path} --ground cloud=town/cloud.laz"),
            _ => path.to_owned(),
        };
        let remote = input.replace(path, &server.address(name));
        place.summary(&format!("shadow {input} --sun 150,25 --cell 1 -o disk.tif"));
        place.summary(&format!("shadow {remote} --sun 150,25 --cell 1 -o web.tif"));
        assert_eq!(
            std::fs::read(place.path("web.tif")).unwrap(),
            std::fs::read(place.path("disk.tif")).unwrap(),
            "{name}"
        );
    }
    let plan = "city plan --sun 150,20 --tile-size 64 --cell 1";
    place.summary(&format!("{plan} town/cloud.laz --add house.obj -o disk"));
    let [cloud, house] = ["cloud.laz", "house.obj"].map(|name| server.address(name));
    place.summary(&format!("{plan} {cloud} --add {house} -o web"));
    for run in ["disk", "web"] {
        place.summary(&format!("city run {run}"));
        place.summary(&format!("city merge {run} -o {run}.tif"));
    }
    assert_eq!(std::fs::read(place.path("web.tif")).unwrap(), std::fs::read(place.path("disk.tif")).unwrap());
}

#[test]
fn a_server_that_has_no_such_file_is_named() {
    let place = Workplace::new();
    let server = WebServer::start([], Manner::Parts);
    let address = server.address("gone.laz");
    for command in ["info", "shadow --sun 150,20 -o a.tif", "city plan --sun 150,20 -o run"] {
        place.refusal(1, &format!("{command} {address}"), &[&address, "no such file (status 404)"]);
    }
    assert!(!place.path("a.tif").exists() && !place.path("run").exists());
}
