//! Answers that can be worked out by hand, in every kind of file.
#![expect(clippy::unwrap_used, reason = "tests stop at the first surprise")]

use crate::common::{Workplace, at, cells, house, numbers, remarks};
use belvedere::Frame;
use belvedere::PointCloud;
use belvedere::crs::Crs;
use serde_json::Value;

/// Looks straight down from 20 m at 30 m by 20 m around the house, 4 pixels a metre.
const FROM_ABOVE: &str = "84985,446010,20 30,0,0 0,-20,0 4";

const BLOCKED: u8 = 0;
const INSIDE: u8 = 5;
const VISIBLE: u8 = 1;
const OUTSIDE: u8 = 3;

/// Targets around the house as seen by [`FROM_ABOVE`], with their answers.
fn targets_seen_from_above() -> Vec<([f64; 3], u8)> {
    vec![
        (at(0.0, 0.0, 3.0), INSIDE),    // in the living room
        (at(-4.0, 3.0, 5.0), INSIDE),   // below the eaves
        (at(0.0, 2.0, 8.5), VISIBLE),   // a metre above the roof
        (at(0.0, 0.0, 12.0), VISIBLE),  // above the ridge
        (at(10.0, 5.0, 1.0), VISIBLE),  // in the garden
        (at(10.0, 5.0, -1.0), INSIDE),  // below the garden
        (at(100.0, 0.0, 3.0), 4),       // outside the cloud
        (at(0.0, 12.0, 1.0), OUTSIDE),  // on the ground, but north of the picture
        (at(10.0, 5.0, 25.0), OUTSIDE), // behind the picture plane
    ]
}

fn split(targets: &[([f64; 3], u8)]) -> (Vec<[f64; 3]>, Vec<u8>) {
    targets.iter().copied().unzip()
}

fn count(summary: &Value, name: &str) -> usize {
    summary["answers"][name].as_u64().and_then(|v| usize::try_from(v).ok()).unwrap()
}

/// The column `answer` of a table with a header row.
fn answers_of_csv(text: &str) -> Vec<u8> {
    cells(text, "answer").iter().map(|cell| cell.parse().unwrap()).collect()
}

#[test]
fn arrays_and_tables_of_targets_get_answers_in_their_order() {
    let place = Workplace::with_house();
    let (mut targets, mut expected) = split(&targets_seen_from_above());
    // and the other way round
    for _ in 0..2 {
        place.write_targets("targets.npy", &targets);
        let arguments = "query house.laz --targets targets.npy -o answers.npy --viewport";
        let summary = place.summary_with(arguments, &[FROM_ABOVE]);
        assert_eq!(place.npy::<u8>("answers.npy"), (vec![targets.len() as u64], expected.clone()));
        let names = ["visible", "blocked", "inside_obstacle", "outside_view", "outside_cloud"];
        assert_eq!(names.map(|name| count(&summary, name)), [3, 0, 3, 2, 1]);
        targets.reverse();
        expected.reverse();
    }
    let rows: String = targets.iter().map(|[x, y, z]| format!("{x},{y},{z}\n")).collect();
    place.write("targets.csv", format!("x,y,z\n{rows}"));
    place.summary_with("query house.laz --targets targets.csv -o answers.csv --viewport", &[FROM_ABOVE]);
    let text = place.text("answers.csv");
    assert_eq!(answers_of_csv(&text), expected);
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        // a tenth of a millimetre is what tables resolve
        assert!(numbers(&text, name).iter().zip(&targets).all(|(a, b)| (a - b[axis]).abs() < 2e-4), "{text}");
    }
}

#[test]
fn a_target_that_is_not_finite_is_refused_instead_of_shifting_the_answers() {
    let place = Workplace::with_house();
    place.write_targets("targets.npy", &[at(0.0, 0.0, 3.0), [f64::NAN, 0.0, 0.0], at(10.0, 5.0, 1.0)]);
    place.write("targets.csv", "x,y,z\n85000,446000,3\n85000,inf,3\n85010,446005,1\n");
    place.write("gap.csv", "x,y,z\n85000,446000,3\n85000,,3\n85010,446005,1\n");
    for (name, word) in [("targets.npy", "not finite"), ("targets.csv", "not finite"), ("gap.csv", "lines 3")] {
        let arguments = format!("query house.laz --sun 180,30 -o out.csv --targets {name}");
        place.refusal(1, &arguments, &[name, "1 rows", word]);
    }
    assert!(!place.path("out.csv").exists());
}

#[test]
fn a_low_southern_sun_lights_the_south_of_a_house_and_not_its_north() {
    let place = Workplace::with_house();
    let targets = [
        (at(0.0, -6.0, 0.5), VISIBLE),
        // a ray climbs 1.2 m on the 2 m to the north wall, which is 6 m high
        (at(0.0, 6.0, 0.5), BLOCKED),
        // the shadow of the ridge ends 15.6 m north of it; seen from 12 m north it still hides what is below 2 m
        (at(0.0, 12.0, 1.0), BLOCKED),
        (at(0.0, 12.0, 4.0), VISIBLE),
        (at(12.0, 6.0, 0.5), VISIBLE),
        // higher and nearer to the sun than all points of the cloud, so before the plane of the picture that fits them
        (at(0.0, -14.0, 14.0), VISIBLE),
        // higher than the picture
        (at(0.0, 0.0, 30.0), OUTSIDE),
    ];
    let (positions, expected) = split(&targets);
    place.write_targets("targets.npy", &positions);
    for angles in ["180,30", "-180,30"] {
        place.summary(&format!(
            "query house.laz --scene-config ../tau.json --targets targets.npy -o answers.npy --sun {angles}"
        ));
        assert_eq!(place.npy::<u8>("answers.npy").1, expected, "{angles}");
    }
    let wrong = "query house.laz --scene-config ../tau.json --targets targets.npy -o none.npy --sun 540,30";
    place.refusal(2, wrong, &["--sun", "540,30", "azimuth of 0 to 360 degrees"]);
    // the same sun as a direction of sight, which goes from the sun to the scene
    place.summary(
        "query house.laz --scene-config ../tau.json --targets targets.npy -o answers.npy --direction 0,0.8660254,-0.5",
    );
    assert_eq!(place.npy::<u8>("answers.npy").1, expected);
    // north and south change roles
    place.summary("query house.laz --scene-config ../tau.json --targets targets.npy -o answers.npy --sun 0,30");
    assert_eq!(place.npy::<u8>("answers.npy").1[..2], [BLOCKED, VISIBLE]);
}

#[test]
fn a_ball_file_gives_the_answers_of_its_cloud() {
    let place = Workplace::new();
    let mut cloud = house();
    // noise far above must not widen the view
    cloud.positions.push([0.0, 0.0, 400.0]);
    cloud.attributes.normals.as_mut().unwrap().push([0.0, 0.0, 1.0]);
    place.write_cloud("house.laz", &cloud);
    for config in [
        "{}",
        r#"{"method": "angles", "initial_radius": 100}"#,
        r#"{"orient": "up", "neighbors": 10, "max_radius": 2}"#,
    ] {
        place.write("balls.json", config);
        let flags = "--scene-config balls.json";
        place.summary(&format!("query house.laz {flags} --sun 200,40 --random 5000 -o cloud.csv"));
        assert!(answers_of_csv(&place.text("cloud.csv")).contains(&BLOCKED));
        for balls in ["balls.npz", "balls.ply", "balls.laz"] {
            place.summary(&format!("balls house.laz {flags} -o {balls}"));
            place.summary(&format!("query {balls} --sun 200,40 --random 5000 -o balls.csv"));
            let [expected, found] = ["cloud.csv", "balls.csv"].map(|name| place.text(name));
            if balls == "balls.npz" {
                assert!(expected == found, "{config}: the archive keeps every bit");
                continue;
            }
            let [expected, found] = [expected, found].map(|text| answers_of_csv(&text));
            let same = expected.iter().zip(&found).filter(|(a, b)| a == b).count();
            // centres and radii are rounded to a millimetre at most: targets that near to the depth may tip over
            assert!(same >= 4990, "{balls} {config}: {same} of 5000");
        }
    }
}

#[test]
fn the_same_scene_in_feet_gives_the_same_answers() {
    let place = Workplace::new();
    let metres = PointCloud {
        frame: Frame { origin: [200_000.0, 300_000.0, 10.0], crs: Crs::from_epsg(32610).unwrap() },
        ..house()
    };
    let feet = metres.clone().with_crs(Crs::from_epsg(2992).unwrap());
    let foot = feet.frame.crs.metres_per_unit;
    assert_eq!(foot, 0.3048);
    let [(metre_targets, _), (foot_targets, _)] = [1.0, foot].map(|unit| {
        let scaled = targets_seen_from_above().into_iter().map(|(t, answer)| {
            let local = [t[0] - crate::common::EAST, t[1] - crate::common::NORTH, t[2]];
            (std::array::from_fn(|i| (local[i] + metres.frame.origin[i]) / unit), answer)
        });
        split(&scaled.collect::<Vec<([f64; 3], u8)>>())
    });
    let expected = split(&targets_seen_from_above()).1;
    place.write_cloud("metres.laz", &metres);
    place.write_cloud("feet.laz", &feet);
    // a table of targets has no unit of its own: it is in the scene's
    place.write_targets("metres.npy", &metre_targets);
    place.write_targets("feet.npy", &foot_targets);
    let number = |v: f64| format!("{v:.9}");
    let viewport = |unit: f64| {
        let [x, y, z] = [199_985.0, 300_010.0, 30.0].map(|v| number(v / unit));
        format!("{x},{y},{z} {},0,0 0,-{},0 {}", number(30.0 / unit), number(20.0 / unit), number(4.0 * unit))
    };
    for (name, unit) in [("metres", 1.0), ("feet", foot)] {
        let arguments = format!("query {name}.laz --targets {name}.npy -o {name}-answers.npy --viewport");
        let summary = place.summary_with(&arguments, &[&viewport(unit)]);
        assert_eq!((&summary["view"]["width_px"], &summary["view"]["height_px"]), (&120.into(), &80.into()));
        assert_eq!(place.npy::<u8>(&format!("{name}-answers.npy")).1, expected, "{name}");
    }
    // ball files keep the unit
    place.summary("balls feet.laz -o balls.npz");
    place.summary_with("query balls.npz --targets feet.npy -o balls-answers.npy --viewport", &[&viewport(foot)]);
    assert_eq!(place.npy::<u8>("balls-answers.npy").1, expected);
    // a table of answers is in the file's feet again
    place.summary_with("query feet.laz --targets feet.npy -o feet.csv --viewport", &[&viewport(foot)]);
    let first = place.text("feet.csv").lines().nth(1).unwrap().to_owned();
    let x: f64 = first.split(',').next().unwrap().parse().unwrap();
    assert!((x - foot_targets[0][0]).abs() < 1e-3, "{first}");
}

#[test]
fn targets_in_another_reference_system_are_refused() {
    let place = Workplace::with_house();
    place.write_cloud("belgian.laz", &house().with_crs(Crs::from_epsg(31370).unwrap()));
    let words = ["belgian.laz", "EPSG:31370", "EPSG:28992", "convert"];
    place.refusal(1, "query house.laz --sun 180,30 --targets belgian.laz -o out.laz", &words);
    assert!(!place.path("out.laz").exists());
    // said to be the same for all, against what one file says
    let arguments = "query house.laz --sun 180,30 --targets belgian.laz -o out.laz --crs EPSG:28992";
    place.refusal(2, arguments, &["--crs", "belgian.laz", "EPSG:31370", "EPSG:28992"]);
    let arguments = &format!("{arguments} --crs-override");
    assert_eq!(count(&place.summary(arguments), "targets"), house().len());
}

#[test]
fn the_points_of_the_cloud_keep_number_order_and_attributes_beside_their_answer() {
    let place = Workplace::new();
    let mut cloud = house();
    // noise and repeated points make no balls, but are targets like all others
    let all: Vec<u32> = (0..u32::try_from(cloud.len()).unwrap()).chain([7, 7]).collect();
    cloud = cloud.select(&all);
    let n = cloud.len();
    let byte = |i: usize, modulus: usize| u8::try_from(i % modulus).unwrap();
    cloud.attributes.classification = Some((0..n).map(|i| if i % 50 == 0 { 7 } else { 6 }).collect());
    cloud.attributes.intensity = Some((0..n).map(|i| u16::try_from(i * 7 % 60_000).unwrap()).collect());
    cloud.attributes.gps_time = Some((0..n).map(|i| 1000.0 + i as f64).collect());
    cloud.attributes.return_number = Some((0..n).map(|i| 1 + byte(i, 3)).collect());
    cloud.attributes.return_count = Some(vec![3; n]);
    cloud.attributes.point_source_id = Some((0..n).map(|i| u16::from(byte(i, 5))).collect());
    place.write_cloud("house.laz", &cloud);
    // with much finer pixels the default bias no longer covers what balls may stand out from a wall seen aslant
    let summary = place.summary("query house.laz --sun 180,45 --pixel 0.25 --self -o lit.laz");
    assert_eq!(count(&summary, "targets"), n);
    place.summary("query house.laz --sun 180,45 --pixel 0.25 --self -o lit.npy");
    let answers = place.npy::<u8>("lit.npy").1;
    let mut reader = las::Reader::from_path(place.path("lit.laz")).unwrap();
    let points: Vec<las::Point> = reader.read_all().unwrap().points().map(Result::unwrap).collect();
    assert_eq!((points.len(), answers.len()), (n, n));
    for (i, point) in points.iter().enumerate() {
        let position = cloud.frame.to_file_coordinates(cloud.positions[i]);
        // LAS files are written in steps of at most a millimetre
        assert!([point.x, point.y, point.z].iter().zip(position).all(|(a, b)| (a - b).abs() < 1e-3), "{i}");
        assert_eq!(u8::from(point.classification), if i % 50 == 0 { 7 } else { 6 });
        assert_eq!(usize::from(point.intensity), i * 7 % 60_000);
        assert_eq!(point.gps_time, Some(1000.0 + i as f64));
        assert_eq!((point.return_number, point.number_of_returns), (1 + byte(i, 3), 3));
        assert_eq!(point.point_source_id, u16::from(byte(i, 5)));
        let normal = cloud.attributes.normals.as_ref().unwrap()[i];
        let columns: Vec<u8> = normal.iter().flat_map(|v| v.to_le_bytes()).chain([answers[i]]).collect();
        assert_eq!(point.extra_bytes, columns);
    }
    // the north wall lies in the shadow of the house, the south wall in the sun; at the border of a wall either answer
    // is right
    let share = |north: f32| {
        let wall = (0..n).filter(|&i| cloud.positions[i][1] == north && cloud.positions[i][0].abs() < 4.0);
        let wall: Vec<u8> = wall.filter(|&i| (1.0..5.0).contains(&cloud.positions[i][2])).map(|i| answers[i]).collect();
        assert!(wall.len() > 50);
        wall.iter().filter(|&&answer| answer == VISIBLE).count() as f64 / wall.len() as f64
    };
    assert!(share(-4.0) > 0.95 && share(4.0) < 0.05, "south {}, north {}", share(-4.0), share(4.0));
}

#[test]
fn the_bias_decides_about_targets_just_behind_the_surface() {
    let place = Workplace::with_house();
    // 40 cm below the roof, whose height there is 7.5 m
    place.write_targets("targets.npy", &[at(0.0, 2.0, 7.1)]);
    let arguments = "query house.laz --scene-config ../balls_alone.json --targets targets.npy -o answers.npy";
    for (bias, expected) in [("0", INSIDE), ("0.2", BLOCKED), ("0.6", VISIBLE), ("-0.5", INSIDE)] {
        place.summary_with(&format!("{arguments} --bias {bias} --viewport"), &[FROM_ABOVE]);
        assert_eq!(place.npy::<u8>("answers.npy").1, [expected], "{bias}");
    }
    place.write_targets("targets.npy", &[at(0.0, 2.0, 7.9)]);
    for (bias, expected) in [("0", VISIBLE), ("-0.6", BLOCKED)] {
        place.summary_with(&format!("{arguments} --bias {bias} --viewport"), &[FROM_ABOVE]);
        assert_eq!(place.npy::<u8>("answers.npy").1, [expected], "{bias}");
    }
}

/// The law of both shapes is `the_cone_only_ever_reveals` of the library.
#[test]
fn the_cone_of_the_paper_blocks_less_than_the_sphere() {
    let place = Workplace::with_house();
    let query = "query house.laz --scene-config ../balls_alone.json --random 50000 --bias 0 -o a.npy --viewport";
    let blocked = ["sphere", "paper-cone"].map(|profile| {
        let summary = place.summary_with(query, &[FROM_ABOVE, "--ball-profile", profile]);
        count(&summary, "blocked") + count(&summary, "inside_obstacle")
    });
    assert!(blocked[1] < blocked[0], "{blocked:?}");
}

#[test]
fn several_files_and_a_folder_of_files_are_one_cloud() {
    let place = Workplace::new();
    let cloud = house();
    let half = u32::try_from(cloud.len() / 2).unwrap();
    let all = u32::try_from(cloud.len()).unwrap();
    std::fs::create_dir(place.path("tiles")).unwrap();
    place.write_cloud("tiles/a.laz", &cloud.select(&(0..half).collect::<Vec<u32>>()));
    place.write_cloud("tiles/b.laz", &cloud.select(&(half..all).collect::<Vec<u32>>()));
    let mut answers = Vec::new();
    for input in ["tiles", "tiles/a.laz tiles/b.laz"] {
        let summary = place.summary(&format!("query {input} --sun 180,45 --self -o lit.npy"));
        assert_eq!(summary["points"], cloud.len());
        answers.push(place.bytes("lit.npy"));
    }
    assert_eq!(answers[0], answers[1]);
}

#[test]
fn balls_in_free_space_are_not_taken_for_what_blocks() {
    let place = Workplace::with_house();
    place.summary("balls house.laz --side exterior -o air.npz");
    place.refusal(1, "query air.npz --sun 180,45 --random 10 -o out.csv", &["air.npz", "--side exterior"]);
    place.refusal(1, "depth-map air.npz --sun 180,45 -o out.tif", &["air.npz", "--side exterior"]);
}

#[test]
fn a_camera_and_a_panorama_answer_by_exact_lines_of_sight() {
    let place = Workplace::with_field();
    let targets = [
        (at(0.0, -5.0, 3.0), [VISIBLE, VISIBLE]),   // before the south wall
        (at(0.0, 0.0, 3.0), [INSIDE, INSIDE]),      // in the living room
        (at(0.0, 10.0, 3.0), [BLOCKED, BLOCKED]),   // behind the house
        (at(0.0, 0.0, 12.0), [VISIBLE, VISIBLE]),   // above the ridge
        (at(14.0, -20.0, 3.0), [OUTSIDE, VISIBLE]), // right of the camera
        (at(0.0, -30.0, 3.0), [OUTSIDE, VISIBLE]),  // behind the camera
        (at(0.0, -19.0, 2.9), [OUTSIDE, VISIBLE]),  // nearer than its near limit
    ];
    let positions: Vec<[f64; 3]> = targets.iter().map(|t| t.0).collect();
    place.write_targets("targets.npy", &positions);
    let [x, y, z] = at(0.0, -20.0, 3.0);
    let [ahead_x, ahead_y, ahead_z] = at(0.0, 0.0, 3.0);
    let camera = format!("--eye {x},{y},{z} --look-at {ahead_x},{ahead_y},{ahead_z} --fov 70 --size 400x400 --near 2");
    let panorama = format!("--panorama {x},{y},{z}");
    for (i, view) in [&camera, &panorama].into_iter().enumerate() {
        let summary = place.summary(&format!("query house.laz --targets targets.npy -o answers.npy {view}"));
        let expected: Vec<u8> = targets.iter().map(|t| t.1[i]).collect();
        assert_eq!(place.npy::<u8>("answers.npy").1, expected, "{view}");
        assert_eq!(summary["answers"]["method"], "lines of sight");
        assert_eq!(summary["answers"]["balls_around_eye"], 0);
    }
    place.refusal(
        2,
        &format!("query house.laz --targets targets.npy -o a.npy --ball-profile paper-cone {camera}"),
        &["cone"],
    );
}

#[test]
fn many_targets_for_few_pixels_are_settled_by_a_certified_map_with_the_same_answers() {
    let place = Workplace::with_field();
    place.summary("balls house.laz -o balls.npz");
    let [x, y, z] = at(-20.0, -25.0, 12.0);
    let [ahead_x, ahead_y, ahead_z] = at(0.0, 0.0, 3.0);
    let view = |size: &str| format!("--eye {x},{y},{z} --look-at {ahead_x},{ahead_y},{ahead_z} --fov 40 --size {size}");
    // pictures of the same proportions differ in nothing but their pixels
    let ask =
        |size: &str, name: &str| place.summary(&format!("query balls.npz --random 30000 -o {name} {}", view(size)));
    let (few, many) = (ask("80x60", "few.npy"), ask("800x600", "many.npy"));
    assert!(few["answers"]["decided_by_map_percent"].as_f64().unwrap() > 50.0, "{few}");
    assert_eq!(many["answers"]["method"], "lines of sight");
    let [few, many] = ["few.npy", "many.npy"].map(|name| place.npy::<u8>(name).1);
    assert!(few == many && few.contains(&BLOCKED) && few.contains(&VISIBLE) && few.contains(&OUTSIDE));
}

#[test]
fn what_the_input_has_and_the_output_has_not_is_one_remark() {
    let place = Workplace::with_house();
    let query = "--orient given --scene-config ../tau.json --direction 0,0,-1 --self";
    place.summary(&format!("query house.laz {query} -o first.laz"));
    // the records of the first result are copied, and its column is replaced
    let again = place.summary(&format!("query first.laz {query} -o again.laz"));
    let lost = remarks(&again);
    assert_eq!(lost.iter().filter(|remark| remark.contains("the earlier values of answer")).count(), 1, "{lost:?}");
    let table = place.summary(&format!("query first.laz {query} -o again.csv"));
    assert!(
        remarks(&table).iter().any(|remark| remark.contains("does not have what the input has: answer")),
        "{table}"
    );
    assert!(remarks(&place.summary(&format!("query house.laz {query} -o plain.csv"))).is_empty());
}
