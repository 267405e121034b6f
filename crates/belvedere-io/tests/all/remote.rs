//! Files on a web server are the same as on the disk, and no more of them is transferred than is needed.

use std::path::Path;

use belvedere_data::control::Control;
use belvedere_data::{Error, PointCloud};
use belvedere_io::{ReadOptions, Source, read_cloud, web_address};

use crate::sources::{FORMATS, cloud, file};
use crate::web_server::{KEY, Manner, WebServer};
use crate::windows::{copc, nodes, places, window};

fn read(address: &str) -> Result<PointCloud, Error> {
    Ok(read_cloud([Source::path(address)], &ReadOptions::default(), &Control::none())?.0)
}

#[test]
fn a_file_of_each_format_is_the_same_over_the_web() {
    let cloud = cloud(2000);
    let files = FORMATS.map(|name| (name, file(name, &cloud)));
    for manner in [Manner::Parts, Manner::Whole, Manner::FirstStatus(503), Manner::FirstCut] {
        let server = WebServer::start(files.clone(), manner);
        for (name, bytes) in &files {
            // trying again takes a third of a second
            if !matches!(manner, Manner::Parts | Manner::Whole) && *name != "cloud.laz" {
                continue;
            }
            let expected =
                read_cloud([Source::bytes(name, bytes)], &ReadOptions::default(), &Control::none()).unwrap().0;
            // the query of an address is not part of the name
            for address in [server.address(name), server.address(name) + "?key=a.b/c"] {
                let found = read(&address).unwrap_or_else(|e| panic!("{manner:?}: {e}"));
                assert_eq!(found.positions, expected.positions, "{name}, {manner:?}");
                assert_eq!(found.attributes.classification, expected.attributes.classification, "{name}");
                assert_eq!(found.frame, expected.frame, "{name}");
            }
        }
    }
}

#[test]
fn a_window_of_a_copc_kilometre_transfers_at_most_three_times_its_bytes() {
    let count = 3_000_000;
    let bytes = copc(&nodes(count), |_| {});
    let size = bytes.len() as f64;
    let own = |low| places(Source::bytes("tile.copc.laz", &bytes), &window(low, 100.0));
    let lows = [[480.0, 480.0], [0.0, 0.0], [333.0, 710.0]];
    let expected = lows.map(own);
    let server = WebServer::start([("tile.copc.laz", bytes.clone())], Manner::Parts);
    for (low, expected) in lows.into_iter().zip(expected) {
        let (requests, transferred) = server.sent();
        let found = places(Source::path(server.address("tile.copc.laz")), &window(low, 100.0));
        assert_eq!(found, expected, "{low:?}");
        let (requests, transferred) = (server.sent().0 - requests, server.sent().1 - transferred);
        let share = transferred as f64 / (size * expected.len() as f64 / f64::from(count));
        assert!(share < 3.0, "{low:?}: {share:.2} times the bytes of its points, in {requests} requests");
    }
}

#[test]
fn tiles_of_a_catalogue_lie_on_the_server_or_where_the_catalogue_says() {
    let tile = file("tile.laz", &cloud(500));
    let tiles = WebServer::start([("tile.laz", tile.clone()), ("dir/tile.laz", tile)], Manner::Parts);
    let catalogue = |href: &str| format!(r#"{{"features":[{{"assets":{{"data":{{"href":"{href}"}}}}}}]}}"#);
    let elsewhere = catalogue(&tiles.address("tile.laz"));
    let (cloud, report) =
        read_cloud([Source::bytes("all.vpc", &elsewhere)], &ReadOptions::default(), &Control::none()).unwrap();
    assert_eq!((cloud.len(), report.files[0].path.as_path()), (500, Path::new(&tiles.address("tile.laz"))));
    for href in ["tile.laz", "./tile.laz"] {
        let server = WebServer::start(
            [
                ("dir/all.vpc", catalogue(href).into_bytes()),
                ("dir/tile.laz", file("tile.laz", &crate::sources::cloud(70))),
            ],
            Manner::Parts,
        );
        assert_eq!(read(&server.address("dir/all.vpc")).unwrap().len(), 70, "{href}");
    }
}

#[test]
fn the_key_of_a_catalogue_is_that_of_its_tiles_on_the_same_server_only() {
    let tile = |count| file("tile.laz", &cloud(count));
    let elsewhere = WebServer::start([("tile.laz", tile(40))], Manner::Keyed);
    let catalogue =
        |href: &str| format!(r#"{{"features":[{{"assets":{{"data":{{"href":"{href}"}}}}}}]}}"#).into_bytes();
    let files = [
        ("dir/all.vpc", catalogue("./tile.laz")),
        ("dir/tile.laz", tile(70)),
        ("dir/far.vpc", catalogue(&elsewhere.address("tile.laz"))),
        ("dir/keyed.vpc", catalogue(&(elsewhere.address("tile.laz") + KEY))),
    ];
    let server = WebServer::start(files, Manner::Keyed);
    assert_eq!(read(&(server.address("dir/all.vpc") + KEY)).unwrap().len(), 70);
    assert_eq!(read(&(server.address("dir/keyed.vpc") + KEY)).unwrap().len(), 40);
    // no other server gets the key
    for address in [server.address("dir/far.vpc") + KEY, server.address("dir/all.vpc")] {
        let error = read(&address).unwrap_err().to_string();
        assert!(error.contains("refuses access (status 403)"), "{address}: {error}");
    }
}

#[test]
fn servers_that_fail_or_lie_are_named_with_what_to_do() {
    let large = file("cloud.las", &cloud(20_000));
    assert!(large.len() > 3 << 16);
    for (manner, expected) in [
        (Manner::Status(404), "no such file (status 404); check the address"),
        (Manner::Status(403), "refuses access (status 403)"),
        (Manner::Status(204), "no answer that fits (status 204)"),
        (Manner::Status(503), "cannot answer now (status 503); try again later"),
        (Manner::AnotherPart, "sends another part"),
        (Manner::Compressed, "compressed form only; download it first"),
        (Manner::Changing, "changed while it was read; run again"),
        (Manner::Shrinking, "changed while it was read; run again"),
        (Manner::Vanishing, "changed while it was read; run again"),
    ] {
        let server = WebServer::start([("cloud.las", large.clone())], manner);
        let address = server.address("cloud.las");
        let error = read(&address).unwrap_err().to_string();
        assert!(error.starts_with(&address) && error.contains(expected), "{manner:?}: {error}");
    }
    let empty = WebServer::start([("cloud.las", Vec::new())], Manner::Parts);
    let error = read(&empty.address("cloud.las")).unwrap_err().to_string();
    assert!(error.contains("cloud.las"), "{error}");
    // damage is reported as for files on the disk
    for bytes in [&large[..1000], &large[..large.len() / 2]] {
        let cut = WebServer::start([("cloud.las", bytes.to_vec())], Manner::Parts);
        let outcome = |source: Source<'_>| match read_cloud([source], &ReadOptions::default(), &Control::none()) {
            Ok((cloud, report)) => format!("{} {:?}", cloud.len(), report.files[0].notes),
            Err(error) => error.to_string().split_once("cloud.las").unwrap().1.to_owned(),
        };
        assert_eq!(outcome(Source::path(cut.address("cloud.las"))), outcome(Source::bytes("cloud.las", bytes)));
    }
    // nothing listens there
    let error = read("http://127.0.0.1:9/cloud.las").unwrap_err().to_string();
    assert!(error.contains("cannot be reached") && error.contains("check the address"), "{error}");
    let error = read("http://nowhere.invalid/cloud.las").unwrap_err().to_string();
    assert!(error.contains("check the address"), "{error}");
}

#[test]
fn addresses_are_those_of_the_web() {
    for (path, is_address) in [
        ("https://a.org/b.laz", true),
        ("HTTP://a.org/b.laz", true),
        ("https:/a.org/b.laz", false),
        ("a.laz", false),
        ("", false),
    ] {
        assert_eq!(web_address(Path::new(path)).is_some(), is_address, "{path}");
    }
}
