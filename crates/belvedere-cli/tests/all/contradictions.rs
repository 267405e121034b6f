//! Contradictions between arguments and known data, through whole commands. Right values are closed forms of the
//! inputs.

use crate::common::{EAST, NORTH, Workplace, column, house, house_in_a_field, shared_data};
use belvedere::GpsTimeKind;
use belvedere::control::Control;
use belvedere::crs::Crs;
use belvedere::io::{ReadOptions, read_cloud};
use serde_json::Value;
use std::fmt::Write;
use std::fs;
use std::path::PathBuf;

/// Keys of the remarks of a run.
fn keys(summary: &Value) -> Vec<String> {
    let remarks = summary["remarks"].as_array().into_iter().flatten();
    remarks.map(|remark| remark["key"].as_str().unwrap().to_owned()).collect()
}

fn has(summary: &Value, key: &str) -> bool {
    keys(summary).iter().any(|own| own == key)
}

/// A folder of the small inputs that were once answered wrongly, or `None` with a line that says so.
fn quirk(test: &str, name: &str) -> Option<PathBuf> {
    let folder = shared_data(test)?.join("data/quirks").join(name);
    folder.is_dir().then_some(folder)
}

#[test]
fn a_scene_is_another_one_where_only_the_system_beside_its_file_changed() {
    let place = Workplace::new();
    let mut plain = house_in_a_field();
    plain.frame.crs = Crs::default();
    place.write_cloud("house.copc.laz", &plain);
    let scene = |system: &str, more: &str| {
        place.write("house.prj", system);
        place.summary(&format!("shadow house.copc.laz --sun 180,40 --cell 1 -o a.tif {more}"))
    };
    assert_eq!(scene("EPSG:28992", "")["scene"], "kept");
    assert_eq!(scene("EPSG:28992", "")["scene"], "found");
    let other = scene("EPSG:32631", "");
    assert_eq!(other["scene"], "kept", "{other}");
    // and in tiles
    for system in ["EPSG:28992", "EPSG:32631", "EPSG:28992"] {
        assert!(has(&scene(system, "--memory 106M"), "in-tiles"), "{system}");
    }
}

#[test]
fn ground_of_another_place_is_refused_and_of_another_level_is_said() {
    let place = Workplace::with_house();
    let moved = |by: [f64; 3]| {
        let mut cloud = house();
        (0..3).for_each(|axis| cloud.frame.origin[axis] += by[axis]);
        cloud
    };
    let shadow = "shadow house.laz --sun 180,40 --cell 1 -o a.tif --ground";
    for (name, by) in [("far.laz", 300_000.0), ("beside.laz", 400.0)] {
        place.write_cloud(name, &moved([by, 0.0, 0.0]));
        place.refusal(2, &format!("{shadow} cloud={name}"), &["--ground", "beside the scene"]);
    }
    place.write_cloud("higher.laz", &moved([0.0, 0.0, 6.0]));
    assert!(has(&place.summary(&format!("{shadow} cloud=higher.laz")), "ground-heights-differ"));
    place.write_cloud("same.laz", &moved([0.5, 0.0, 0.3]));
    let said = keys(&place.summary(&format!("{shadow} cloud=same.laz")));
    assert!(!said.contains(&"ground-heights-differ".to_owned()), "{said:?}");
}

#[test]
fn a_building_that_floats_or_sinks_is_said() {
    let place = Workplace::new();
    place.write_cloud("field.laz", &house_in_a_field());
    let building = |base: f64, height: f64| {
        let mut text = String::new();
        for z in [base, base + height] {
            for [x, y] in [[20.0, -4.0], [30.0, -4.0], [30.0, 4.0], [20.0, 4.0]] {
                writeln!(text, "v {} {} {z}", EAST + x, NORTH + y).unwrap();
            }
        }
        text + "f 1 2 3 4\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"
    };
    for (base, height, expected) in [
        (0.0, 9.0, None),
        (-3.0, 9.0, None),
        (4.0, 9.0, Some("mesh-floats")),
        (-7.0, 9.0, Some("mesh-sinks")),
        (0.0, 900.0, None),
        // millimetres
        (0.0, 9000.0, Some("mesh-is-huge")),
    ] {
        place.write("plan.obj", building(base, height));
        let summary = place.summary("shadow field.laz --sun 180,40 --cell 2 --add plan.obj -o a.tif");
        let said: Vec<String> = keys(&summary).into_iter().filter(|key| key.starts_with("mesh-")).collect();
        assert_eq!(said, expected.into_iter().collect::<Vec<_>>(), "{base} {height}");
    }
}

#[test]
fn suns_that_cannot_be_are_refused_and_shadows_of_two_suns_are_not_one_change() {
    let place = Workplace::with_house();
    let hours = "sun-hours house.laz --date 2026-12-21 --cell 4 -o a.tif --min-sun-elevation";
    // on the shortest day at 52° north the sun is 14.6° high
    for elevation in ["89", "20"] {
        place.refusal(2, &format!("{hours} {elevation}"), &["--min-sun-elevation", "stays below"]);
    }
    place.summary(&format!("{hours} 10"));
    let shadow = |sun: &str, name: &str| {
        place.summary(&format!("shadow house.laz --sun {sun} --cell 1 -o {name}"));
    };
    shadow("180,40", "noon.tif");
    shadow("180,40", "again.tif");
    shadow("240,20", "evening.tif");
    let change = |other: &str| place.summary(&format!("difference noon.tif {other} -o d.csv"));
    assert!(has(&change("evening.tif"), "different-suns"));
    assert!(!has(&change("again.tif"), "different-suns"));
    // radians, gon, one row
    for (rows, words) in [
        ("0,0.1\n1.57,0.1\n3.14,0.1\n4.71,0.1\n", "radians"),
        ("0,5\n100,5\n200,5\n400,5\n", "gon"),
        ("90,5\n", "180 degrees apart"),
    ] {
        place.write("horizon.csv", format!("azimuth,elevation\n{rows}"));
        place.refusal(1, "shadow house.laz --sun 180,40 --horizon horizon.csv -o a.tif", &["horizon.csv", words]);
    }
}

#[test]
fn heights_of_esri_systems_have_their_own_unit() {
    let Some(folder) = quirk("heights_of_esri_systems_have_their_own_unit", "88-esri-vertcs") else { return };
    let place = Workplace::new();
    // a box of 8 m, 15 m east of the eye, 0.1 m above the ground: atan(7.9/15), and half a spacing
    for (name, eye) in [("esri_m_ft.laz", "545010,5180030"), ("esri_ft_m.laz", "6000032.808,2100098.425")] {
        let file = folder.join(name);
        let file = file.to_str().unwrap();
        let question = format!("horizon --observer {eye} --observer-height 0.1 -o h.csv");
        place.summary_with(&question, &[file]);
        let (azimuths, elevations) = (column(&place, "h.csv", "azimuth"), column(&place, "h.csv", "elevation"));
        let east = azimuths.iter().position(|azimuth| (azimuth - 90.0).abs() < 1e-6).unwrap();
        assert!((elevations[east] - 28.2).abs() < 1.0, "{name}: {}", elevations[east]);
    }
}

#[test]
fn a_room_is_as_large_as_it_is_although_rays_leave_between_its_points() {
    let Some(folder) = quirk("a_room_is_as_large_as_it_is", "100-pinhole-in-a-room") else { return };
    let place = Workplace::new();
    let file = folder.join("room.ptx");
    for reach in ["", " --max-distance 10"] {
        let question = format!("isovist --observer 1004.5,2003,51.2 -o i.csv{reach}");
        let summary = place.summary_with(&question, &[file.to_str().unwrap()]);
        let value = |name: &str| column(&place, "i.csv", name)[0];
        // 6 by 4 by 3 m; where 7 % of the directions leave, points are 20 cm apart, and so uncertain is the surface
        assert!((value("volume_m3") - 72.0).abs() < 3.6, "{reach}: {}", value("volume_m3"));
        assert!((value("plan_area_m2") - 24.0).abs() < 0.7, "{reach}: {}", value("plan_area_m2"));
        assert!(has(&summary, "sight-leaves-room"), "{summary}");
    }
}

#[test]
fn a_trajectory_in_utc_is_brought_to_gps_time() {
    let Some(folder) = quirk("a_trajectory_in_utc_is_brought_to_gps_time", "94-trajectory-in-utc") else { return };
    let place = Workplace::new();
    let file = folder.join("pulses.laz");
    let shadow = |trajectory: &str, output: &str| {
        fs::copy(folder.join(trajectory), place.path(trajectory)).unwrap();
        let question = format!("shadow --orient trajectory={trajectory} --sun 235,40 --cell 1 -o {output}");
        place.summary_with(&question, &[file.to_str().unwrap()])
    };
    let right = shadow("gps_time.csv", "right.tif");
    assert!(!has(&right, "trajectory-time"), "{right}");
    let utc = shadow("utc.csv", "utc.tif");
    assert!(has(&utc, "trajectory-time"), "{utc}");
    assert_eq!(utc["scanner"]["trajectory_time_offset_s"].as_f64(), Some(-18.0), "{utc}");
    assert!(place.pixels("right.tif") == place.pixels("utc.tif"));
}

#[test]
fn terrain_at_another_level_than_the_cloud_is_said_with_its_offset() {
    let test = "terrain_at_another_level_than_the_cloud_is_said_with_its_offset";
    let (Some(folder), Some(base)) = (quirk(test, "93-terrain-ten-metres-off"), quirk(test, "base")) else { return };
    let place = Workplace::new();
    let cloud = base.join("base_s.laz");
    let horizon = |name: &str| {
        fs::copy(folder.join(name), place.path(name)).unwrap();
        let question = format!("horizon --observer 155050,463030 --observer-height 1 --terrain {name} -o h.csv");
        place.summary_with(&question, &[cloud.to_str().unwrap()])
    };
    assert!(!has(&horizon("terrain_00.tif"), "terrain-heights-differ"));
    let summary = horizon("terrain_10.tif");
    let remarks = summary["remarks"].as_array().unwrap();
    let remark = remarks.iter().find(|remark| remark["key"] == "terrain-heights-differ").unwrap();
    assert_eq!(remark["numbers"]["offset_m"].as_f64(), Some(10.0), "{remark}");
}

#[test]
fn info_says_what_answers_say_of_the_survey() {
    let test = "info_says_what_answers_say_of_the_survey";
    let said = ["surveys-apart", "ground-points-only"];
    let inputs = [
        ("96-two-surveys-years-apart", "folder", Some(said[0])),
        ("97-ground-points-only", "ground_only.laz", Some(said[1])),
        ("base", "base_s.laz", None),
    ];
    for (name, input, key) in inputs {
        let Some(folder) = quirk(test, name) else { return };
        let summary = Workplace::new().summary_with("info", &[folder.join(input).to_str().unwrap()]);
        for own in said {
            assert_eq!(has(&summary, own), Some(own) == key, "{name}: {summary}");
        }
    }
}

#[test]
fn clocks_of_another_continent_are_said() {
    let place = Workplace::with_house();
    // at 5 degrees east the sun is 0.4 hours ahead of UTC
    let times = [
        ("2026-06-21T12:00 --zone Europe/Amsterdam", false),
        ("2026-06-21T12:00Z", false),
        ("2026-06-21T12:00+04:00", false),
        ("2026-06-21T12:00-08:00", true),
        ("2026-06-21T18:00 --zone America/Los_Angeles", true),
        ("2026-06-21T12:00 --zone Asia/Tokyo", true),
    ];
    for (time, is_said) in times {
        let summary = place.summary(&format!("shadow house.laz --time {time} --cell 2 -o a.tif"));
        assert_eq!(has(&summary, "clock-of-zone"), is_said, "{time}: {summary}");
    }
}

#[test]
fn a_town_in_millimetres_is_said_by_info_and_by_answers() {
    let place = Workplace::new();
    let mut plain = house_in_a_field();
    plain.frame.crs = Crs::default();
    for (scale, is_said) in [(1.0_f32, false), (1000.0, true)] {
        let mut scaled = plain.clone();
        scaled.positions.iter_mut().flatten().for_each(|v| *v *= scale);
        place.write_cloud("town.laz", &scaled);
        for question in ["info town.laz", "balls town.laz -o b.npz"] {
            assert_eq!(has(&place.summary(question), "unit-of-survey"), is_said, "{scale} {question}");
        }
    }
}

#[test]
fn a_given_day_of_flight_stays_with_the_points_that_are_written() {
    let place = Workplace::new();
    let mut cloud = house();
    // Monday, 15 February 2021, 9:40:53 UTC, in seconds of the week and less 10⁹ s of GPS time
    let [seconds, adjusted] = [121_271.5, 297_417_271.5];
    cloud.attributes.gps_time = Some(vec![seconds; cloud.len()]);
    cloud.attributes.gps_time_kind = GpsTimeKind::SecondsOfWeek;
    place.write_cloud("house.laz", &cloud);
    let expected =
        [("", seconds, GpsTimeKind::SecondsOfWeek), ("--flown 2021-02-16", adjusted, GpsTimeKind::AdjustedStandard)];
    for (flags, time, kind) in expected {
        place.summary(&format!("normals house.laz {flags} -o n.laz"));
        let (written, _) = read_cloud([place.path("n.laz")], &ReadOptions::new(), &Control::none()).unwrap();
        assert_eq!(written.attributes.gps_time_kind, kind, "{flags}");
        assert!(written.attributes.gps_time.unwrap().iter().all(|&written| written == time), "{flags}");
    }
    place.refusal(2, "normals house.laz --flown 2021-02-30 -o n.laz", &["--flown", "2014-02-03"]);
}
