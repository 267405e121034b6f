//! Surveys of a table are found at a place, and their points are those of their files.

use belvedere_data::control::Control;
use belvedere_data::crs::Crs;
use belvedere_data::{Error, PointCloud};
use belvedere_io::open_surveys::{
    FoundSurvey, OpenSurvey, SurveyArea, SurveyTile, TileIndex, best_covering, download_tiles, find_surveys,
    find_tiles, read_area, surveys_at, write_origin,
};

use crate::sources::{cloud, file};
use crate::web_server::{Manner, WebServer};

/// South-west corners of the four squares of 100 m around the middle of the cloud.
const CORNERS: [[f64; 2]; 4] =
    [[154_900.0, 462_900.0], [155_000.0, 462_900.0], [154_900.0, 463_000.0], [155_000.0, 463_000.0]];
const NAMES: [&str; 4] = ["t_154900_462900.laz", "t_155000_462900.laz", "t_154900_463000.laz", "t_155000_463000.laz"];

fn survey(name: &str, index: TileIndex) -> OpenSurvey {
    OpenSurvey {
        name: name.to_owned(),
        title: format!("Survey {name}"),
        points_per_m2: None,
        licence: "CC BY 4.0".to_owned(),
        attribution: "nobody".to_owned(),
        page: "https://example.invalid".to_owned(),
        crs: Some("EPSG:28992".to_owned()),
        areas_deg: vec![[5.0, 52.0, 6.0, 53.0]],
        index,
    }
}

fn squares(server: &WebServer) -> OpenSurvey {
    survey("squares", TileIndex::Squares { side_m: 100.0, address: server.address("t_{x_m}_{y_m}.laz") })
}

/// The area of `radius` around coordinates.
fn area(middle: [f64; 2], radius: f64) -> SurveyArea {
    let projection = Crs::parse("EPSG:28992").unwrap().geographic_projection().unwrap();
    SurveyArea::around(projection.unproject(middle).unwrap().map(f64::to_degrees), radius).unwrap()
}

/// The points of a cloud in one square.
fn part(cloud: &PointCloud, [x, y]: [f64; 2]) -> PointCloud {
    let inside = |&index: &u32| {
        let [east, north, _] = cloud.positions[index as usize].map(f64::from);
        let [east, north] = [east + cloud.frame.origin[0] - x, north + cloud.frame.origin[1] - y];
        (0.0..100.0).contains(&east) && (0.0..100.0).contains(&north)
    };
    let chosen: Vec<u32> = (0..u32::try_from(cloud.len()).unwrap()).filter(inside).collect();
    cloud.select(&chosen)
}

fn tiles(cloud: &PointCloud) -> Vec<(&'static str, Vec<u8>)> {
    NAMES.into_iter().zip(CORNERS).map(|(name, corner)| (name, file(name, &part(cloud, corner)))).collect()
}

/// Coordinates of a cloud in millimetres, and intensities, in an order of their own.
fn sorted(cloud: &PointCloud) -> Vec<([i64; 3], u16)> {
    let intensity = cloud.attributes.intensity.as_ref().unwrap();
    let place = |p: &[f32; 3]| {
        std::array::from_fn(|axis| ((f64::from(p[axis]) + cloud.frame.origin[axis]) * 1000.0).round() as i64)
    };
    let mut points: Vec<_> = cloud.positions.iter().map(place).zip(intensity.iter().copied()).collect();
    points.sort_unstable();
    points
}

fn found(survey: &OpenSurvey, area: &SurveyArea) -> FoundSurvey {
    find_tiles(survey, area, &Control::none()).unwrap()
}

#[test]
fn points_of_an_area_are_those_of_its_squares_within_it() {
    let cloud = cloud(20_000);
    let server = WebServer::start(tiles(&cloud), Manner::Parts);
    let middle = [154_995.0, 463_003.0];
    let area = area(middle, 20.0);
    let found = found(&squares(&server), &area);
    assert_eq!(found.tiles.len(), 4);
    let (taken, _) = read_area(&found, &area, &Control::none()).unwrap();
    // a place in degrees comes back within a micrometre, and points lie on millimetres
    let mut expected = sorted(&cloud);
    expected.retain(|&([x, y, _], _)| {
        [x, y].into_iter().zip(middle).all(|(v, middle)| (v as f64 / 1000.0 - middle).abs() <= 20.0)
    });
    assert!(expected.len() > 2000);
    assert_eq!(sorted(&taken), expected);
    assert_eq!(taken.frame.crs.epsg, Some(28992));
}

#[test]
fn squares_without_a_file_are_no_tiles_and_a_place_without_any_is_left_out() {
    let cloud = cloud(1000);
    let mut files = tiles(&cloud);
    files.remove(0);
    let server = WebServer::start(files, Manner::Parts);
    let there = find_tiles(&squares(&server), &area([155_000.0, 463_000.0], 20.0), &Control::none()).unwrap();
    // a quarter of the square is missing
    assert_eq!((there.covered_percent, there.is_whole()), (75.0, false));
    assert!(there.part_in_words().unwrap().contains("75 %"));
    let addresses: Vec<_> = there.tiles.iter().map(|tile| tile.address.clone()).collect();
    assert_eq!(addresses, NAMES[1..].iter().map(|name| server.address(name)).collect::<Vec<_>>());
    let elsewhere = area([150_000.0, 463_000.0], 20.0);
    assert_eq!(find_surveys(&[squares(&server)], &elsewhere, &Control::none()).unwrap(), []);
    // one that covers all of it comes before a newer one that does not
    let older = FoundSurvey { covered_percent: 100.0, ..there.clone() };
    let least = FoundSurvey { covered_percent: 10.0, ..there.clone() };
    let best = |found: &[FoundSurvey]| best_covering(found).unwrap().covered_percent;
    assert_eq!(best(&[there.clone(), older]), 100.0);
    assert_eq!(best(&[least, there]), 75.0);
}

#[test]
fn a_list_gives_the_tiles_that_meet_the_area_and_a_failing_service_is_named() {
    let cloud = cloud(5000);
    let files = WebServer::start(tiles(&cloud), Manner::Parts);
    let rows = NAMES.into_iter().zip(CORNERS).map(|(name, [x, y])| {
        let ring = [[x, y], [x + 100.0, y], [x + 100.0, y + 100.0], [x, y + 100.0], [x, y]];
        format!(
            r#"{{"type": "Feature", "geometry": {{"type": "Polygon", "coordinates": [{ring:?}]}},
            "properties": {{"name": "{name}", "url": "{}"}}}}"#,
            files.address(name)
        )
    });
    let list = format!(r#"{{"features": [{}]}}"#, rows.collect::<Vec<_>>().join(","));
    let service = WebServer::start([("wfs", list.into_bytes())], Manner::Whole);
    let refused = WebServer::start([("wfs", Vec::new())], Manner::Status(403));
    let query = |server: &WebServer| {
        let address = server.address("wfs") + "?BBOX={x_min},{y_min},{x_max},{y_max}";
        TileIndex::List { address }
    };
    let surveys = [
        survey("refused", query(&refused)),
        survey("listed", query(&service)),
        survey("by-hand", TileIndex::Page),
        OpenSurvey { areas_deg: vec![[0.0, 0.0, 1.0, 1.0]], ..survey("elsewhere", query(&service)) },
    ];
    let area = area([154_950.0, 462_950.0], 20.0);
    let there = surveys_at(surveys.to_vec(), None, &area).unwrap();
    let found = find_surveys(&there, &area, &Control::none()).unwrap();
    let names: Vec<_> = found.iter().map(|found| &found.survey.name[..]).collect();
    assert_eq!(names, ["refused", "listed", "by-hand"]);
    let failure = found[0].failure.as_ref().unwrap();
    assert!(failure.contains("refuses access (status 403)") && failure.contains("/wfs"), "{failure}");
    assert_eq!(found[1].tiles.iter().map(|tile| &tile.address).collect::<Vec<_>>(), [&files.address(NAMES[0])]);
    assert_eq!(found[2].tiles, []);
    let (taken, _) = read_area(&found[1], &area, &Control::none()).unwrap();
    assert!(taken.len() > 100 && taken.len() < cloud.len());
    for (found, words) in [(&found[0], "status 403"), (&found[2], "https://example.invalid")] {
        let error = read_area(found, &area, &Control::none()).unwrap_err();
        assert!(matches!(error, Error::NoSurvey { .. }) && error.to_string().contains(words), "{error}");
    }
}

#[test]
fn whole_tiles_are_files_byte_for_byte_and_come_once() {
    let folder = tempfile::tempdir().unwrap();
    let files = tiles(&cloud(20_000));
    for manner in [Manner::Parts, Manner::Whole, Manner::FirstCut] {
        let server = WebServer::start(files.clone(), manner);
        let folder = folder.path().join(format!("{manner:?}"));
        std::fs::create_dir(&folder).unwrap();
        let found = found(&squares(&server), &area([154_950.0, 462_950.0], 20.0));
        assert_eq!(found.tiles[0].bytes, Some(files[0].1.len() as u64), "{manner:?}");
        let download = || download_tiles(&found, &folder, &Control::none()).unwrap();
        assert_eq!(download(), [folder.join(NAMES[0])]);
        let path = folder.join(NAMES[0]);
        assert!(std::fs::read(&path).unwrap() == files[0].1, "{manner:?}");
        let written = std::fs::metadata(&path).unwrap().modified().unwrap();
        download();
        assert_eq!(std::fs::metadata(&path).unwrap().modified().unwrap(), written);
        // an unfinished one of another program
        std::fs::write(&path, b"LASF").unwrap();
        download();
        assert!(std::fs::read(&path).unwrap() == files[0].1);
        assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 1);
    }
}

#[test]
fn tiles_of_one_name_are_two_files_and_keys_are_not_written_down() {
    let files = tiles(&cloud(1000));
    let servers = [0, 1].map(|number: usize| WebServer::start([("t.laz", files[number].1.clone())], Manner::Parts));
    let tile = |server: &WebServer| SurveyTile { address: server.address("t.laz?sig=secret"), bytes: None, date: None };
    let found = FoundSurvey {
        tiles: servers.iter().map(tile).collect(),
        ..found(&survey("two", TileIndex::Page), &area([155e3, 463e3], 5.0))
    };
    let folder = tempfile::tempdir().unwrap();
    let paths = download_tiles(&found, folder.path(), &Control::none()).unwrap();
    assert_eq!(paths, ["t.laz", "2_t.laz"].map(|name| folder.path().join(name)));
    for (path, (_, bytes)) in paths.iter().zip(&files) {
        assert!(std::fs::read(path).unwrap() == *bytes);
    }
    let text = serde_json::to_string(&found).unwrap();
    assert!(text.contains("t.laz") && !text.contains("secret"), "{text}");
}

#[test]
fn lists_that_hold_a_part_of_their_rows_are_refused() {
    let list = r#"{"items": [{"properties": {"url": "https://a.example/b.laz"}}], "total": 201}"#;
    let server = WebServer::start([("list", list.as_bytes().to_vec())], Manner::Whole);
    let address = server.address("list") + "?{west},{south},{east},{north}";
    let error = find_tiles(&survey("cut", TileIndex::List { address }), &area([155e3, 463e3], 5.0), &Control::none());
    let error = error.unwrap_err().to_string();
    assert!(error.contains("1 rows, and not all") && error.contains("smaller radius"), "{error}");
    // small squares would be a million requests
    let address = server.address("{x_m}_{y_m}.laz");
    let small = survey("small", TileIndex::Squares { side_m: 10.0, address });
    let error = find_tiles(&small, &area([155e3, 463e3], 5000.0), &Control::none()).unwrap_err().to_string();
    assert!(error.contains("more than 1000"), "{error}");
    assert_eq!(server.sent().0, 1);
}

#[test]
fn names_and_places_beyond_the_table_are_refused_and_the_origin_is_written() {
    let surveys = vec![survey("a", TileIndex::Page), survey("b", TileIndex::Page)];
    let here = area([155e3, 463e3], 50.0);
    let names = |name| surveys_at(surveys.clone(), name, &here).map(|found| found.len());
    assert_eq!((names(None).unwrap(), names(Some("b")).unwrap()), (2, 1));
    let error = names(Some("ahn3")).unwrap_err().to_string();
    assert!(error.contains("\"ahn3\"") && error.contains("a, b"), "{error}");
    let elsewhere = SurveyArea::around([48.85, 2.35], 50.0).unwrap();
    let error = surveys_at(surveys.clone(), Some("a"), &elsewhere).unwrap_err().to_string();
    assert!(error.contains("does not cover 48.85, 2.35"), "{error}");
    let swapped = SurveyArea::around([5.4, 52.2], 50.0).unwrap();
    let error = surveys_at(surveys.clone(), None, &swapped).unwrap_err().to_string();
    assert!(error.contains("5.4, 52.2") && error.contains("latitude first"), "{error}");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("place.origin.json");
    let tile = SurveyTile { address: "https://a.example/b.laz?sig=secret".to_owned(), bytes: None, date: None };
    write_origin(
        &path,
        &FoundSurvey { survey: surveys[0].clone(), tiles: vec![tile], covered_percent: 100.0, failure: None },
        &here,
    )
    .unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    let origin: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!((&origin["licence"], &origin["radius_m"]), (&"CC BY 4.0".into(), &50.0.into()));
    assert!(text.contains("https://a.example/b.laz") && !text.contains("secret"), "{text}");
}

#[test]
fn archives_are_refused_with_the_way_around() {
    let server = WebServer::start(tiles(&cloud(100)), Manner::Parts);
    let mut found = found(&squares(&server), &area([155e3, 463e3], 5.0));
    found.tiles[0].address = "https://a.example/b.las.zip".to_owned();
    let error = read_area(&found, &area([155e3, 463e3], 5.0), &Control::none()).unwrap_err().to_string();
    assert!(error.contains("b.las.zip") && error.contains("unpack"), "{error}");
}
