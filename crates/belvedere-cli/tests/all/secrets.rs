//! Users, passwords and keys of addresses are in nothing that is printed, written or kept, and names of files and
//! reference systems command no terminal.

use crate::common::Workplace;
use crate::web_server::{KEY, Manner, WebServer};
use std::fs;
use std::io::Read;
use std::path::Path;

/// Searched secrets: a user with a password, and the key of [`KEY`].
const SECRETS: [&str; 4] = ["s3cretpw", "ann:", "sig=a", "a/b.c"];

fn leaks(bytes: &[u8]) -> Option<&'static str> {
    SECRETS.into_iter().find(|secret| bytes.windows(secret.len()).any(|window| window == secret.as_bytes()))
}

/// Looks for secrets in all files below a folder, in their names, and in what archives hold.
fn search(folder: &Path, found: &mut Vec<String>) {
    for row in fs::read_dir(folder).unwrap() {
        let path = row.unwrap().path();
        if path.is_dir() {
            search(&path, found);
            continue;
        }
        let bytes = fs::read(&path).unwrap();
        found.extend(leaks(&bytes).map(|secret| format!("{}: {secret}", path.display())));
        found.extend(leaks(path.to_string_lossy().as_bytes()).map(|secret| format!("{}: {secret}", path.display())));
        let Ok(mut archive) = zip::ZipArchive::new(std::io::Cursor::new(&bytes)) else { continue };
        for number in 0..archive.len() {
            let mut content = Vec::new();
            archive.by_index(number).unwrap().read_to_end(&mut content).unwrap();
            found.extend(leaks(&content).map(|secret| format!("in {}: {secret}", path.display())));
        }
    }
}

const CATALOGUE: &str = r#"{"type":"FeatureCollection","features":[{"assets":{"data":{"href":"cloud.laz"}}}]}"#;
const AREA: &str = r#"{"type":"Polygon","coordinates":[[[154990,462990],[155005,462990],[155005,463005],[154990,463005],[154990,462990]]],"crs":{"type":"name","properties":{"name":"EPSG:28992"}}}"#;

#[test]
fn no_secret_of_an_address_is_printed_written_or_kept() {
    let place = Workplace::new();
    assert_eq!(place.run("simulate town -o town --extent 90 --density 4").status, 0);
    place.summary("balls town/cloud.laz -o balls.npz --no-cache");
    place.summary("shadow town/cloud.laz --sun 150,30 --cell 4 -o before.tif --no-cache");
    let files = [
        ("cloud.laz", place.bytes("town/cloud.laz")),
        ("balls.npz", place.bytes("balls.npz")),
        ("before.tif", place.bytes("before.tif")),
        ("house.obj", b"v 154980 462980 0\nv 154990 462980 0\nv 154985 462990 9\nf 1 2 3\n".to_vec()),
        ("all.vpc", CATALOGUE.as_bytes().to_vec()),
        ("area.geojson", AREA.as_bytes().to_vec()),
        ("broken.laz", b"LASF and nothing else".to_vec()),
        ("broken.csv", b"x,y\n1,two\n".to_vec()),
    ];
    let server = WebServer::start(files, Manner::Keyed);
    let address = |name: &str| server.address(name).replace("http://", "http://ann:s3cretpw@") + KEY;
    let other = |name: &str| server.address(name).replace("http://", "http://ann:s3cretpw@") + "?sig=a";
    let commands = [
        // what works
        "info CLOUD",
        "info CLOUD --json",
        "info BALLS",
        "balls CLOUD -o b.npz",
        "balls CLOUD -o b.ply -v",
        "balls CLOUD -o b.laz --progress json",
        "shadow CLOUD --sun 150,30 --cell 4 -o s.tif -o s.png",
        "shadow CLOUD --sun 150,30 --cell 4 -o again.tif --json",
        "shadow BALLS --ground cloud=CLOUD --sun 150,30 --cell 4 -o of_balls.tif",
        "shadow CLOUD --add MESH --sun 150,30 --cell 4 -o added.tif",
        "shadow CLOUD --clear AREA --sun 150,30 --cell 4 -o cleared.tif",
        "shadow CATALOGUE --sun 150,30 --cell 4 -o of_catalogue.tif",
        "shadow CLOUD --sun 150,30 --cell 4 -o in_tiles.tif --memory 118M",
        "shadow CLOUD --sun 150,30 --cell 4 -o beside.tif --memory 118M --no-cache",
        "sun-hours CLOUD --date 2026-06-21 --time-step-min 120 --cell 4 -o hours.tif",
        "sky-view CLOUD --cell 4 --directions 49 -o sky.tif",
        "viewshed CLOUD --observer 155000,463000 --cell 4 -o seen.tif",
        "line-of-sight CLOUD --observer 155000,463000,3 --target 155020,463020,9 -o line.csv",
        "isovist CLOUD --observer 155000,463000 -o isovist.csv",
        "horizon CLOUD --observer 155000,463000 -o horizon.csv",
        "normals CLOUD -o normals.laz",
        "trajectory CLOUD -o path.csv",
        "query CLOUD --sun 235,30 --self -o lit.laz",
        "query CLOUD --sun 235,30 --targets MESH -o lit.csv",
        "depth-map CLOUD --sun 235,30 -o depth.png",
        "surfaces CLOUD -o surfaces.geojson -o surfaces.laz",
        "view CLOUD --export page.html",
        "view CLOUD --add MESH --export plan.html --json",
        "difference RASTER again.tif -o change.tif",
        "cache",
        "cache --json",
        // what does not
        "city plan CLOUD --sun 150,30 -o run",
        "info GONE",
        "info OTHER",
        "info BROKEN",
        "info TABLE",
        "info ftp://ann:s3cretpw@example.org/a.laz?sig=a",
        "info http://ann:s3cretpw@127.0.0.1:1/a.laz?sig=a",
        "info http://ann:s3cretpw@[::1/a.laz?sig=a",
        "shadow CLOUD",
        "shadow CLOUD --sun",
        "shadow --sun CLOUD -o a.tif",
        "shadow CLOUD --nonsense=CLOUD",
        "nonsense CLOUD",
        "shadow CLOUD --sun 150,30 -o CLOUD",
        "shadow CLOUD --sun 150,30 -o a.nonsense",
        "shadow CLOUD --crs EPSG:99999 --sun 150,30 -o a.tif",
        "shadow CLOUD --scene-config CLOUD --sun 150,30 -o a.tif",
        "shadow CLOUD --observers CLOUD --sun 150,30 -o a.tif",
        "viewshed CLOUD --observers TABLE -o a.tif",
        "shadow CLOUD --cache CLOUD --sun 150,30 --cell 4 -o elsewhere.tif",
        "irradiance CLOUD --weather TABLE --cell 4 -o a.tif",
    ];
    let words = [
        ("CLOUD", address("cloud.laz")),
        ("BALLS", address("balls.npz")),
        ("MESH", address("house.obj")),
        ("AREA", address("area.geojson")),
        ("CATALOGUE", address("all.vpc")),
        ("RASTER", address("before.tif")),
        ("GONE", address("gone.laz")),
        ("OTHER", other("cloud.laz")),
        ("BROKEN", address("broken.laz")),
        ("TABLE", address("broken.csv")),
    ];
    let (mut found, mut worked) = (Vec::new(), 0);
    for command in commands {
        let line = words.iter().fold(command.to_owned(), |line, (word, address)| line.replace(word, address));
        let run = place.run(&line);
        worked += usize::from(run.status == 0);
        let said = format!("{}{}", run.stdout, run.stderr);
        found.extend(leaks(said.as_bytes()).map(|secret| format!("{command} says {secret}: {said}")));
        println!("{command}: {} {}", run.status, run.stderr.lines().next().unwrap_or_default());
    }
    search(&place.path(".."), &mut found);
    assert!(found.is_empty(), "{found:#?}");
    // all but those meant to fail
    assert!(worked >= 30, "{worked} commands worked");
    assert!(commands.len() - worked >= 15, "{worked} commands worked");
    assert!(!place.path("run").exists());
}

#[test]
fn names_that_command_a_terminal_are_printed_escaped() {
    let place = Workplace::new();
    let name = "red\u{1b}[31m\u{202e}\u{9b}2J.xyz";
    place.write(name, "x y z\n1 2 3\n1 2 4\n4 5 6\n7 8 5\n");
    place.write("red\u{1b}[31m\u{202e}\u{9b}2J.prj", "nonsense \u{1b}]0;title\u{7}");
    for (command, more) in [
        ("info --verbose", &[][..]),
        ("info --json", &[]),
        ("balls -o b.npz", &[]),
        ("info -v", &["--nonsense\u{1b}[31m"]),
        ("shadow -o a.tif", &["--sun", "a\u{1b}[31m"]),
    ] {
        let run = place.run_with(command, &[&[name], more].concat());
        let said = run.stdout + &run.stderr;
        let is_named = said.contains("u{1b}") || said.contains("\\u001b");
        // a summary of balls names its output alone, and the refusal of a flag its letters
        assert!(is_named || command.contains("balls") || said.contains("unexpected argument"), "{command}: {said:?}");
        let commands: Vec<char> =
            said.chars().filter(|c| c.is_control() && *c != '\n' || "\u{202e}".contains(*c)).collect();
        assert!(commands.is_empty(), "{command}: {said:?}");
        if command.contains("--json") {
            let value: serde_json::Value = serde_json::from_str(&said).unwrap();
            assert!(value["reading"]["files"][0]["path"].as_str().unwrap_or(name).ends_with(name), "{value}");
        }
    }
}
