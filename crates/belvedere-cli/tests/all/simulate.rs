//! Output of `simulate`: complete, consistent, and the same for the same seed.
#![expect(clippy::unwrap_used, reason = "tests stop at the first surprise")]

use std::collections::BTreeMap;

use crate::common::Workplace;
use belvedere::control::Control;
use belvedere::io::{LevelOfDetail, ReadOptions, read_cityjson, read_cloud, read_mesh, read_trajectory};
use belvedere::view::to_sun;
use belvedere::{GpsTimeKind, PointCloud};
use belvedere_scenes::{AirborneParams, Preset, Truth, scan_airborne, town};
use las::Reader;

fn cloud(place: &Workplace, name: &str) -> PointCloud {
    read_cloud(&[place.path(name)], &ReadOptions::default(), &Control::none()).unwrap().0
}

/// The three columns of light of each point.
fn light(place: &Workplace, name: &str) -> Vec<[u8; 3]> {
    let mut reader = Reader::from_path(place.path(name)).unwrap();
    let points = reader.read_all().unwrap();
    points.points().map(|point| point.unwrap().extra_bytes.try_into().unwrap()).collect()
}

#[test]
fn an_airborne_survey_comes_with_all_that_one_delivers() {
    let place = Workplace::new();
    let summary = place.summary("simulate village -o out --extent 120 --density 3");
    for name in ["cloud.laz", "trajectory.csv", "trajectory.sbet", "mesh.obj", "mesh.city.json", "blocks.obj"] {
        assert!(place.path("out").join(name).is_file(), "{name}");
        let listed = summary["files"].as_array().unwrap().iter().any(|f| f.as_str().unwrap().ends_with(name));
        assert!(listed, "{name} is named in the summary");
    }
    assert!(!place.path("out/stations.csv").exists());
    let header = Reader::from_path(place.path("out/cloud.laz")).unwrap().header().clone();
    assert_eq!((header.version(), header.point_format().to_u8().unwrap() & 0x3f), (las::Version::new(1, 4), 6));

    let cloud = cloud(&place, "out/cloud.laz");
    assert_eq!(summary["points"], cloud.len());
    assert_eq!(cloud.frame.crs.epsg, Some(7415));
    let a = &cloud.attributes;
    assert_eq!(a.gps_time_kind, GpsTimeKind::AdjustedStandard);
    assert!(a.classification.as_ref().unwrap().iter().all(|class| [1, 2, 5, 6, 14, 17].contains(class)));
    assert_eq!(a.point_source_id.as_ref().unwrap().iter().max(), Some(&2));
    let pulses: f64 = a.return_count.as_ref().unwrap().iter().map(|&count| 1.0 / f64::from(count)).sum();
    // 3 per square metre are requested; some 1 % are lost
    assert!((pulses / 120.0 / 120.0 - 2.97).abs() < 0.15, "{pulses}");
    assert_eq!(pulses.round(), summary["pulses"]["pulses_recorded"].as_f64().unwrap());

    // The path is known at all times, from either file.
    let times = a.gps_time.as_ref().unwrap();
    for name in ["out/trajectory.csv", "out/trajectory.sbet"] {
        let (trajectory, _) = read_trajectory(&place.path(name), &cloud.frame.crs).unwrap();
        let clock = trajectory.clock_offset_for(times, a.gps_time_kind);
        assert_eq!(clock.known_count, cloud.len(), "{name}");
    }
    // Both meshes are the town.
    let scene = town(&Preset::Village.params(120.0, 1));
    let (obj, _) = read_mesh(&place.path("out/mesh.obj")).unwrap();
    let (city, _) = read_cityjson(&place.path("out/mesh.city.json"), &LevelOfDetail::Highest).unwrap();
    assert_eq!([obj.triangles.len(), city.triangles.len()], [scene.triangles.len(); 2]);
    assert_eq!(city.crs.epsg, Some(7415));
    // And other commands take it as it is.
    let info = place.summary("info out/cloud.laz");
    assert_eq!(info["pulses"], summary["pulses"]["pulses_recorded"]);
    assert!(info["pulses_with_several_returns_percent"].as_f64().unwrap() > 1.0);
    assert!(info["facades"]["points_per_m2_of_wall"].as_f64().unwrap() > 0.05);
    place.summary("normals out/cloud.laz --orient trajectory=out/trajectory.sbet -o normals.laz");
}

#[test]
fn light_on_each_point_is_what_the_mesh_says() {
    let place = Workplace::new();
    place.summary("simulate town -o out --extent 100 --density 2 --seed 5");
    let scene = town(&Preset::Town.params(100.0, 5));
    let scan = scan_airborne(&scene, &AirborneParams { seed: 5, ..AirborneParams::covering(&scene, 2.0) });
    let truth = Truth::new(&scene);
    let lit = light(&place, "out/cloud.laz");
    assert_eq!(lit.len(), scan.len());
    for (column, [azimuth, elevation]) in [[110.0_f64, 20.0_f64], [180.0, 65.0], [240.0, 35.0]].iter().enumerate() {
        let exact = scan.lit_from(&scene, &truth, to_sun(azimuth.to_radians(), elevation.to_radians()));
        assert!(lit.iter().zip(&exact).all(|(lit, &exact)| lit[column] == u8::from(exact)), "column {column}");
        let share = exact.iter().filter(|&&lit| lit).count() as f64 / exact.len() as f64;
        assert!((0.2..0.95).contains(&share), "{share} lit: neither all nor nothing");
    }
}

#[test]
fn flags_of_the_airborne_scanner_do_what_they_say() {
    let place = Workplace::new();
    let with = |flags: &str| {
        let summary = place.summary(&format!("simulate town -o out --extent 100 --density 2 {flags}"));
        (summary, cloud(&place, "out/cloud.laz"))
    };
    let greatest_angle = |cloud: &PointCloud| {
        let angles = cloud.attributes.scan_angle.as_ref().unwrap();
        f64::from(angles.iter().fold(0.0_f32, |max, a| max.max(a.abs()))).to_degrees()
    };
    let (summary, conical) = with("--pattern conical");
    assert_eq!(summary["survey"]["pattern"], "conical");
    assert!(greatest_angle(&conical) < 20.01);
    let (summary, narrow) = with("--scan-angle 10 --pattern oscillating --flying-height 300 --speed 40");
    assert!(greatest_angle(&narrow) < 10.01);
    // twice 300 m times the tangent of 10 degrees
    assert!((summary["survey"]["strip_width_m"].as_f64().unwrap() - 105.8).abs() < 0.1);
    let (_, crossed) = with("--strips 3 --cross-strips 2");
    assert_eq!(crossed.attributes.point_source_id.as_ref().unwrap().iter().max(), Some(&5));
    let (summary, lossy) = with("--dropout 0.5");
    assert!(
        summary["pulses"]["pulses_lost"].as_f64().unwrap()
            > 0.9 * summary["pulses"]["pulses_recorded"].as_f64().unwrap()
    );
    assert!(lossy.len() < conical.len());
    let (_, hard) = with("--foliage-depth 0 --noise 0");
    let counts = |cloud: &PointCloud| {
        let mut counts = BTreeMap::<u8, usize>::new();
        cloud.attributes.return_count.as_ref().unwrap().iter().for_each(|&n| *counts.entry(n).or_default() += 1);
        counts
    };
    assert!(counts(&conical).keys().max() > Some(&2) && counts(&hard).keys().max() > Some(&1));
}

#[test]
fn a_terrestrial_survey_names_its_stations() {
    let place = Workplace::new();
    let flags = "--scanner terrestrial --stations 3 --angle-step-deg 1 --max-range 30";
    let summary = place.summary(&format!("simulate old-town -o out --extent 100 {flags}"));
    assert_eq!(summary["survey"]["stations"], 3);
    let text = place.text("out/stations.csv");
    let stations: Vec<Vec<f64>> =
        text.lines().skip(1).map(|line| line.split(',').map(|v| v.parse().unwrap()).collect()).collect();
    assert_eq!(stations.len(), 3);
    let cloud = cloud(&place, "out/cloud.laz");
    let sources = cloud.attributes.point_source_id.as_ref().unwrap();
    for (position, &source) in cloud.positions.iter().zip(sources) {
        let station = &stations[usize::from(source) - 1];
        let p = cloud.frame.to_file_coordinates(*position);
        let range = (0..3).map(|i| (p[i] - station[i + 1]).powi(2)).sum::<f64>().sqrt();
        // six deviations of the range, and the millimetres of both files
        assert!(range < 30.0 + 6.0 * 0.005 + 0.002, "{range} from station {source}");
    }
    place.summary("normals out/cloud.laz --orient trajectory=out/trajectory.csv -o normals.laz");
}

#[test]
fn a_structured_scan_has_a_cell_for_each_pulse_and_shows_the_sky() {
    let place = Workplace::new();
    let flags = "--scanner terrestrial --stations 2 --angle-step-deg 1 --ptx";
    let summary = place.summary(&format!("simulate old-town -o out --extent 100 {flags}"));
    let pulses = summary["survey"]["pulses_per_station"].as_u64().unwrap();
    // a grid begins with ten lines
    assert_eq!(place.text("out/scans.ptx").lines().count() as u64, 2 * (10 + pulses));
    let [structured, plain] = ["out/scans.ptx", "out/cloud.laz"].map(|name| cloud(&place, name));
    let firsts = plain.attributes.return_number.as_ref().unwrap().iter().filter(|&&number| number == 1).count();
    assert_eq!(structured.len(), firsts);
    assert_eq!(structured.scanner_positions.len(), 2);
    // each place has a sky above the roofs
    assert!(structured.sky_regions.len() >= 2, "{}", structured.sky_regions.len());
    let proven =
        |name: &str| place.summary(&format!("balls out/{name} --crs EPSG:7415 -o balls.npz"))["pulses"].clone();
    let (with, without) = (proven("scans.ptx"), proven("cloud.laz"));
    assert!(with["pulses_into_the_sky"].as_u64().is_some_and(|count| count > 0), "{with}");
    assert!(without["pulses_into_the_sky"].as_u64().unwrap_or(0) == 0, "{without}");
}

#[test]
fn surveys_have_the_same_bytes_for_any_number_of_threads_and_others_for_another_seed() {
    let place = Workplace::new();
    let files = ["cloud.laz", "trajectory.csv", "trajectory.sbet", "mesh.obj", "mesh.city.json", "blocks.obj"];
    let run = |flags: &str| {
        place.summary(&format!("simulate -o out --extent 100 --density 1 {flags}"));
        files.map(|name| place.bytes(&format!("out/{name}")))
    };
    let one = run("--threads 1");
    assert!(run("--threads 3") == one);
    let other = run("--seed 2");
    assert!(files.iter().zip(&one).zip(&other).all(|((name, a), b)| a != b || name.is_empty()));
}

#[test]
fn points_come_in_the_order_that_was_chosen_with_their_light() {
    let place = Workplace::new();
    let with = |order: &str| {
        place.summary(&format!("simulate town -o out --extent 80 --density 1 --order {order}"));
        let cloud = cloud(&place, "out/cloud.laz");
        let times = cloud.attributes.gps_time.clone().unwrap();
        let rows = cloud.positions.iter().zip(&times).zip(light(&place, "out/cloud.laz"));
        let rows = rows.map(|((p, time), light)| (p.map(f32::to_bits), time.to_bits(), light)).collect::<Vec<_>>();
        (times, rows, ["trajectory.csv", "mesh.obj"].map(|name| place.bytes(&format!("out/{name}"))))
    };
    let (times, flown, others) = with("flight");
    assert!(times.is_sorted());
    let sorted = |mut rows: Vec<_>| {
        rows.sort_unstable();
        rows
    };
    for order in ["shuffled", "squares"] {
        let (times, rows, beside) = with(order);
        assert!(!times.is_sorted() && rows != flown && beside == others, "{order}");
        assert_eq!(sorted(rows), sorted(flown.clone()), "{order}");
    }
}

#[test]
fn wrong_use_is_refused_with_the_way_out() {
    let place = Workplace::new();
    place.refusal(2, "simulate", &["--output"]);
    place.refusal(2, "simulate city -o out", &["city", "old-town"]);
    place.refusal(2, "simulate -o town.laz", &["town.laz", "folder", "without .laz"]);
    place.refusal(2, "demo -o town.laz", &["town.laz", "folder"]);
    place.write("taken", "a file");
    place.refusal(1, "simulate -o taken", &["taken", "folder is needed"]);
    place.refusal(2, "simulate -o out --stations 2", &["--stations", "--scanner terrestrial"]);
    place.refusal(2, "simulate -o out --ptx", &["--ptx", "--scanner terrestrial"]);
    place.refusal(2, "simulate -o out --scanner terrestrial --density 2", &["--density", "--scanner airborne"]);
    place.refusal(2, "simulate -o out --extent 20", &["60 to 5000"]);
    place.refusal(2, "simulate -o out --density -1", &["0.1 to 200"]);
    place.refusal(2, "simulate -o out --noise nan", &["0 to 1"]);
    place.refusal(2, "simulate -o out --order random", &["random", "shuffled"]);
    place.refusal(2, "simulate -o out --extent 5000 --density 200", &["--density", "memory"]);
    place.refusal(
        2,
        "simulate -o out --scanner terrestrial --angle-step-deg 0.01 --stations 9",
        &["--angle-step-deg", "memory"],
    );
    place.refusal(1, "simulate -o out --extent 60 --density 0.1 --dropout 1", &["--dropout"]);
    place.refusal(1, "simulate -o no/such/out --extent 60 --density 0.1", &["no/such"]);
    assert_eq!(place.names(), ["taken"], "nothing is left behind");
}
