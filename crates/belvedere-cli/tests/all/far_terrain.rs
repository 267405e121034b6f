//! Elevation rasters around the house whose ground is level.

use crate::common::{EAST, NORTH, Workplace, at, column};
use belvedere::crs::Crs;
use belvedere::io::{Georeference, read_tif_u8, read_tif_u16, write_tif_f32};
use belvedere::raster::Raster;

const HOUSE: &str = "house.laz --orient given --scene-config ../tau.json";
/// Cells of the raster, metres, and their number a side.
const CELL: f64 = 20.0;
const COUNT: usize = 200;

/// Writes a raster around the house, heights of (x, y) from its middle.
fn write_terrain(place: &Workplace, name: &str, code: u32, east: f64, height: impl Fn(f64, f64) -> f32) {
    let side = CELL * COUNT as f64 / 2.0;
    let middle = |i: usize| (i as f64 + 0.5) * CELL - side;
    let values = (0..COUNT * COUNT).map(|i| height(middle(i % COUNT), -middle(i / COUNT))).collect();
    let raster = Raster::from_values(COUNT, COUNT, values).unwrap();
    let georeference = Georeference {
        upper_left: [EAST - side + east, NORTH + side],
        column_step: [CELL, 0.0],
        row_step: [0.0, -CELL],
        crs: Crs::from_epsg(code).unwrap(),
    };
    write_tif_f32(place.path(name).as_path(), &raster, Some(&georeference), Some(-9999.0), Some("Height in metres"))
        .unwrap();
}

/// A plain with a mountain range in the south: 400 m high from 1510 m on.
fn range(_: f64, y: f64) -> f32 {
    if y < -1500.0 { 400.0 } else { 0.0 }
}

#[test]
fn eyes_stand_on_the_terrain_beyond_the_cloud_and_nowhere_else() {
    let place = Workplace::with_house();
    write_terrain(&place, "dtm.tif", 28992, 0.0, range);
    let [x, y, _] = at(0.0, -1800.0, 0.0);
    place.write("masts.csv", format!("x,y,base,tip\n{x},{y},400,100\n"));
    let towers = format!("towers {HOUSE} --towers masts.csv --terrain dtm.tif");
    // from the plain in the north of the house the edge hides what lies below its line; the range ends 1510 m south
    let [x, y, _] = at(1000.0, 1000.0, 0.0);
    let run = place.summary(&format!("{towers} --at {x},{y} -o seen.csv --wirelines views"));
    assert_eq!(run["at"][0]["height_from"], "ground", "{run}");
    assert!((column(&place, "seen.csv", "z")[0] - 1.7).abs() < 1e-3, "{:?}", column(&place, "seen.csv", "z"));
    // 398.3 m of 2510 m to the edge, of 2800 m to the mast; less than half a metre for the curved earth
    let hidden = 1.7 + 398.3 * 2800.0 / 2510.0 - 400.0;
    assert!(
        (column(&place, "seen.csv", "metres")[0] - (100.0 - hidden)).abs() < 0.5,
        "{:?}",
        column(&place, "seen.csv", "metres")
    );
    let [x, y, _] = at(9000.0, 0.0, 0.0);
    for wrong in [format!("{x},{y}"), "5.39,52.15".to_owned()] {
        let run = place.run(&format!("{towers} --at {wrong} --wirelines nowhere"));
        assert!(run.status > 0 && run.stderr.contains("the terrain beyond it"), "{wrong}: {}", run.stderr);
    }
    assert!(!place.path("nowhere").exists());
}

#[test]
fn each_place_has_the_horizon_of_the_terrain() {
    let place = Workplace::with_house();
    write_terrain(&place, "dtm.tif", 28992, 0.0, range);
    let [x, y, z] = at(0.0, 0.0, 12.0);
    place.write("places.csv", format!("x,y,z\n{x},{y},{z}\n"));
    // due south from 12 m above the plain, of which the curved earth takes 0.15 m
    let expected = (387.85f64 / 1510.0).atan().to_degrees();
    for (sun, lit) in
        [("180", expected - 0.02), ("180", expected + 0.02), ("0", 0.5), ("270", 0.5)].map(|(azimuth, elevation)| {
            (format!("{azimuth},{elevation:.3}"), f64::from(u8::from(azimuth != "180" || elevation > expected)))
        })
    {
        let flags = format!("--targets places.csv --terrain dtm.tif --grid-north --sun {sun}");
        let run = place.summary(&format!("shadow {HOUSE} {flags} -o lit.csv"));
        assert_eq!(column(&place, "lit.csv", "lit"), [lit], "{sun}");
        let report = &run["terrain"];
        assert_eq!((&report["cells"], &report["highest_m"]), (&40_000.into(), &400.0.into()));
        assert_eq!((&report["cell_m"], &report["without_height_percent"]), (&20.0.into(), &0.0.into()));
        assert_eq!(report["reach_m"], 1975.0);
    }
    // profiles for PVGIS and pvlib: elevations clockwise from north
    let eye = format!("--observer {x},{y},{z}");
    place.summary(&format!("horizon {HOUSE} {eye} --terrain dtm.tif --grid-north -o h.csv -o h.txt -o h.png"));
    let elevations = column(&place, "h.csv", "elevation");
    let lines: Vec<f64> = place.text("h.txt").lines().map(|line| line.parse().unwrap()).collect();
    assert_eq!((elevations.len(), lines.len()), (360, 360));
    assert!((elevations[180] - expected).abs() < 2e-4 && (lines[180] - expected).abs() < 0.006);
    for (azimuth, elevation) in elevations.iter().enumerate() {
        let south = -(azimuth as f64).to_radians().cos();
        let seen = if south > 0.8 { (387.85 / 1510.0 * south).atan().to_degrees() } else { 0.0 };
        if !(0.6..=0.8).contains(&south) {
            assert!((elevation - seen).abs() < 0.02, "{azimuth}: {elevation} {seen}");
        }
    }
    // such a profile, read back, hides the same of the sky
    place.summary(&format!("horizon {HOUSE} {eye} --terrain dtm.tif -o north.csv"));
    let share = |flags: &str| {
        place.summary(&format!("sky-view {HOUSE} --targets places.csv {flags} --directions 20000 -o sky.csv"));
        column(&place, "sky.csv", "sky_openness")[0]
    };
    let (by_terrain, by_profile, free) = (share("--terrain dtm.tif"), share("--horizon north.csv"), share(""));
    assert!((by_terrain - by_profile).abs() < 5e-4 && by_terrain < free - 0.02, "{by_terrain} {by_profile} {free}");
    let both = share("--terrain dtm.tif --horizon north.csv");
    assert!(both <= by_terrain.min(by_profile));
}

#[test]
fn terrain_beyond_the_cloud_is_visible_where_nothing_hides_it() {
    let place = Workplace::with_house();
    // the crest of the range stands 1510 m in the south, and all behind it is as high
    write_terrain(&place, "dtm.tif", 28992, 0.0, range);
    let [x, y, z] = at(0.0, 0.0, 12.0);
    let codes = |flags: &str| {
        let flags = format!("{flags} --terrain dtm.tif --far-output far.tif --far-output far.png");
        let run = place.summary(&format!("viewshed {HOUSE} {flags} --far-output far.geojson"));
        let raster = read_tif_u8(place.path("far.tif").as_path()).unwrap();
        let count = |code: u8| raster.values().iter().filter(|v| **v == code).count();
        assert_eq!(run["far_cells"]["visible"], count(1));
        let area = run["far_cells"]["visible_m2"].as_f64().unwrap();
        assert_eq!(area, 400.0 * count(1) as f64);
        assert!(place.text("far.geojson").contains(&format!("\"area_m2\":{area}")));
        let rows = (0..raster.height()).map(|row| (0..raster.width()).any(|c| raster.get(c, row) == Some(1)));
        let visible_rows = rows.filter(|is_visible| *is_visible).count();
        (raster.width(), visible_rows, [count(0), count(1), count(255)])
    };
    // 175 rows of plain and the crest
    let (width, rows, [blocked, visible, without]) = codes(&format!("--observer {x},{y},{z}"));
    assert_eq!((width, rows, blocked, blocked + visible + without), (200, 176, 24 * 200, 200 * 200));
    assert!((1..20).contains(&without), "{without}");
    // a line from 12 m to 408 m lies 402.8 m high over the crest on its way to the next row, and 397.8 m to the one
    // after it
    let (_, rows, [blocked, ..]) = codes(&format!("--observer {x},{y},{z} --target-height 8"));
    assert_eq!((rows, blocked), (177, 23 * 200));
    // to 420 m: 404.4 m on the way to the third row, 399.5 m to the fourth
    let (_, rows, [blocked, ..]) = codes(&format!("--observer {x},{y},{z} --target-height 20"));
    assert_eq!((rows, blocked), (179, 21 * 200));
    // the same lines, seen from their other ends
    let (_, rows, [blocked, ..]) = codes(&format!("--target {x},{y},{z} --observer-height 20"));
    assert_eq!((rows, blocked), (179, 21 * 200));
    // counts, and as far as observers look
    let observers = format!("--observer {x},{y},{z} --observer {x},{y},{}", z + 300.0);
    place.summary(&format!("viewshed {HOUSE} {observers} --max-distance 500 --terrain dtm.tif --far-output n.tif"));
    let raster = read_tif_u16(place.path("n.tif").as_path()).unwrap();
    assert_eq!((raster.width(), raster.get(25, 0), raster.get(0, 0)), (50, Some(2), Some(65_535)));
    for (wrong, status, parts) in [
        ("--far-output none.tif", 2, &["--terrain"][..]),
        ("--terrain dtm.tif --far-output none.laz", 2, &["--far-output", "none.laz"]),
        ("--terrain dtm.tif --far-output none.tif --max-distance 9", 2, &["--max-distance", "2 x 2"]),
        ("--terrain missing.tif --far-output none.tif -o none.png", 1, &["missing.tif"]),
    ] {
        place.refusal(status, &format!("viewshed {HOUSE} --observer {x},{y},{z} {wrong}"), parts);
    }
    write_terrain(&place, "holes.tif", 28992, 0.0, |x, y| if x.hypot(y) < 60.0 { 0.0 } else { f32::NAN });
    let flags = "--terrain holes.tif --max-distance 25 --far-output none.tif -o none.png";
    place.refusal(2, &format!("viewshed {HOUSE} --observer {x},{y},{z} {flags}"), &["--terrain", "beyond the cloud"]);
    assert!(!place.path("none.tif").exists() && !place.path("none.png").exists());
}

#[test]
fn lines_of_sight_reach_the_terrain_beyond_the_cloud() {
    let place = Workplace::with_house();
    write_terrain(&place, "dtm.tif", 28992, 0.0, range);
    let ([x, y, z], [_, mast, _]) = (at(0.0, 0.0, 12.0), at(0.0, -1800.0, 0.0));
    let flags = format!("line-of-sight {HOUSE} --terrain dtm.tif");
    // a mast 290 m behind the crest: from h above it the line to 12 m lies 62.51 m lower over the crest, and 29 mm for
    // the earth: h (1 - 290 / 1800) = 62.54
    for (height, answer) in [(74.4, "blocked"), (74.7, "visible")] {
        let ends = format!("--observer {x},{mast} --observer-height {height} --target {x},{y},{z}");
        assert_eq!(place.summary(&format!("{flags} {ends}"))["line"]["answer"], answer);
        let ends = format!("--target {x},{mast} --target-height {height} --observer {x},{y},{z}");
        assert_eq!(place.summary(&format!("{flags} {ends}"))["line"]["answer"], answer);
    }
    let (west, east, far) = (x - 1000.0, x + 1000.0, x + 3000.0);
    let rows = [
        format!("{x},{mast},,{x},{y},{z}"),
        format!("{x},{y},{z},{x},{mast},480"),
        format!("{west},{y},,{east},{},", y + 1500.0),
        format!("{x},{y},{z},{far},{y},5"),
        format!("{x},{y},{z},{far},{y},"),
    ];
    place.write("pairs.csv", format!("ax,ay,az,bx,by,bz\n{}\n", rows.join("\n")));
    let run = place.run(&format!("{flags} --pairs pairs.csv -o lines.csv"));
    assert!(run.status == 0 && run.stderr.contains("outside the cloud and the terrain"), "{run:?}");
    assert_eq!(column(&place, "lines.csv", "answer"), [0.0, 1.0, 1.0, 4.0, 3.0]);
    let [az, bz] = ["az", "bz"].map(|name| column(&place, "lines.csv", name));
    assert_eq!((az[0], az[2], bz[2], bz[4].is_nan()), (401.7, 1.7, 0.1, true));
    // the first leaves its hill, 1.7 m below its eye, after 7.848 m
    let blocked = |name: &str| column(&place, "lines.csv", name)[0];
    assert!((blocked("first_block_range_m") - 8.030).abs() < 2e-3 && (blocked("block_z") - 400.0).abs() < 2e-3);
    assert!((blocked("block_y") - mast - 7.848).abs() < 2e-3 && blocked("block_ball").is_nan());
    let by_terrain = column(&place, "lines.csv", "block_terrain");
    assert!(by_terrain[0] == 1.0 && by_terrain[1..].iter().all(|v| v.is_nan()), "{by_terrain:?}");
    let ends = format!("--observer {x},{mast} --target {x},{y},{z}");
    let run = place.summary(&format!("{flags} {ends} --profile-out profile.csv --distance-step-m 10"));
    assert_eq!(run["line"]["block_terrain"], true);
    let [ground, blocked] = ["ground", "blocked"].map(|name| column(&place, "profile.csv", name));
    assert_eq!((ground.len(), ground[0], ground[29], ground[30], ground[31]), (181, 400.0, 400.0, 200.0, 0.0));
    assert!(blocked[0] == 0.0 && blocked[1..30].iter().all(|v| *v == 1.0) && blocked[31..60] == [0.0; 29]);
    // zones of radio links over terrain: none of a blocked link, and no answer outside
    place.run(&format!("{flags} --pairs pairs.csv --frequency-ghz 5.8 -o zones.csv"));
    let free = column(&place, "zones.csv", "fresnel_free_percent");
    assert!(free[0] == 0.0 && (0.0..=100.0).contains(&free[1]) && free[1] > 0.0 && free[3].is_nan(), "{free:?}");
    place.refusal(1, &format!("line-of-sight {HOUSE} --terrain missing.tif {ends}"), &["missing.tif"]);
}

#[test]
fn observers_and_targets_of_viewsheds_stand_on_the_terrain() {
    let place = Workplace::with_house();
    write_terrain(&place, "dtm.tif", 28992, 0.0, range);
    let ([x, y, z], [_, hill, _]) = (at(0.0, 0.0, 12.0), at(0.0, -1800.0, 0.0));
    let flags = format!("viewshed {HOUSE} --terrain dtm.tif");
    // from the hill its top is seen, 25 rows of 200 cells, and nothing of the plain below the crest
    let run = place.summary(&format!("{flags} --observer {x},{hill} --far-output far.tif"));
    let rounded = |name: &str| run["observers"][name].clone();
    assert_eq!((rounded("eye")[2].as_f64(), rounded("above_ground_m").as_f64()), (Some(401.7), Some(1.7)));
    assert_eq!(run["far_cells"]["visible"], 5000);
    let run = place.summary(&format!("{flags} --target {x},{hill},401.7 --observer-height 0 --far-output from.tif"));
    assert_eq!(run["far_cells"]["visible"], 5000);
    assert!(place.pixels("far.tif") == place.pixels("from.tif"));
    // of the cloud, cells are seen from a mast of 90 m, and none from the ground (75 m: the line to 0 m lies 0.4 m
    // above the crest at 77 m)
    let codes = |observer: &str| {
        let run = place.run(&format!("{flags} {observer} --cell 1 -o seen.tif"));
        assert_eq!(run.status, 0, "{run:?}");
        let raster = read_tif_u8(place.path("seen.tif").as_path()).unwrap();
        [0, 1].map(|code: u8| raster.values().iter().filter(|v| **v == code).count())
    };
    let [blocked, visible] = codes(&format!("--observer {x},{hill},490"));
    assert!(visible > blocked && blocked > 0, "{blocked} {visible}");
    let [hidden, seen] = codes(&format!("--observer {x},{hill}"));
    assert_eq!((hidden, seen), (blocked + visible, 0));
    // with one in the cloud they count together
    let both = format!("--observer {x},{hill},490 --observer {x},{y},{z}");
    place.summary(&format!("{flags} {both} --cell 1 -o counts.tif --masks masks.tif"));
    let counts = read_tif_u16(place.path("counts.tif").as_path()).unwrap();
    assert!(counts.values().contains(&2));
    let run = place.run(&format!("{flags} --observer {x},{y},{z} --cell 1 -o near.tif"));
    assert!(run.status == 0 && run.stderr.contains("note: the far terrain changes nothing"), "{run:?}");
    for (wrong, status, parts) in [
        (format!("--observer {x},{hill},390 -o none.tif"), 1, &["10.00 m below the ground"][..]),
        (format!("--observer {x},{},5 -o none.tif", hill - 900.0), 1, &["outside the cloud"]),
        (format!("--observer {x},{hill} -o none.tif --heights none.npy"), 2, &["--heights", "observer 1", "terrain"]),
    ] {
        place.refusal(status, &format!("{flags} {wrong}"), parts);
    }
    assert!(!place.path("none.tif").exists() && !place.path("none.npy").exists());
}

#[test]
fn mountains_are_ground_in_the_view_of_a_window_and_maps_name_them() {
    let place = Workplace::with_house();
    // a wall all around, 1 km away, and a plain that changes nothing
    write_terrain(&place, "wall.tif", 28992, 0.0, |x, y| if x.hypot(y) < 1000.0 { 0.0 } else { 400.0 });
    write_terrain(&place, "plain.tif", 28992, 0.0, |_, _| -20.0);
    let [x, y, z] = at(0.0, 0.0, 12.0);
    place.write("window.csv", format!("x,y,z,azimuth\n{x},{y},{z},90\n"));
    let shares = |flags: &str| {
        let directions = "--windows window.csv --grid-north --directions 20000";
        place.summary(&format!("window-views {HOUSE} {directions} {flags} -o view.csv"));
        ["sky", "beyond"].map(|name| column(&place, "view.csv", name)[0])
    };
    // above the elevation of the wall, within a cell of where it begins, lies (1 - sin) / 2 of the half space
    let [sky, beyond] = shares("--terrain wall.tif");
    let expected = [990.0, 1030.0].map(|span: f64| 50.0 * (1.0 - (388.0 / span).atan().sin()));
    assert!((expected[0] - 0.7..expected[1] + 0.7).contains(&sky) && beyond == 0.0, "{sky} {beyond} {expected:?}");
    let [sky, beyond] = shares("");
    assert!((sky - 50.0).abs() < 0.7 && beyond > 1.0, "{sky} {beyond}");
    place.write("horizon.csv", "azimuth,elevation\n0,20\n180,20\n");
    let [sky, beyond] = shares("--horizon horizon.csv");
    let expected = 50.0 * (1.0 - 20f64.to_radians().sin());
    assert!((sky - expected).abs() < 0.7 && beyond == 0.0, "{sky} {beyond}");
    for (name, flags) in [("without", ""), ("with", "--terrain plain.tif")] {
        place.summary(&format!("sky-view {HOUSE} --cell 1 --directions 50 {flags} -o {name}.tif -o {name}.png"));
    }
    assert!(place.pixels("with.tif") == place.pixels("without.tif"));
    assert!(place.bytes("with.png") != place.bytes("without.png"), "the title of the map says nothing");
}

#[test]
fn terrain_that_does_not_fit_is_refused_by_name() {
    let place = Workplace::with_house();
    let shadow = format!("shadow {HOUSE} --sun 180,25 --cell 1 -o lit.csv --terrain");
    write_terrain(&place, "utm.tif", 25_831, 0.0, range);
    place.refusal(1, &format!("{shadow} utm.tif"), &["utm.tif", "EPSG:25831", "gdalwarp -t_srs EPSG:28992"]);
    write_terrain(&place, "degrees.tif", 4289, 0.0, range);
    place.refusal(1, &format!("{shadow} degrees.tif"), &["degrees.tif", "degrees", "gdalwarp"]);
    write_terrain(&place, "far.tif", 28992, 9000.0, range);
    place.refusal(2, &format!("{shadow} far.tif"), &["--terrain", "far.tif", "coordinates of the cloud"]);
    write_terrain(&place, "high.tif", 28992, 0.0, |_, _| 140.0);
    place.refusal(2, &format!("{shadow} high.tif"), &["--terrain", "high.tif", "140.0", "same zero"]);
    write_terrain(&place, "feet.tif", 28992, 0.0, |_, _| 100.0);
    place.refusal(2, &format!("{shadow} feet.tif"), &["feet.tif", "100.0 to 100.0 m", "look like feet", "A*0.3048"]);
    write_terrain(&place, "ellipsoid.tif", 28992, 0.0, |_, _| -43.0);
    place.refusal(2, &format!("{shadow} ellipsoid.tif"), &["ellipsoid.tif", "above the ellipsoid", "gdalwarp"]);
    for wrong in [32_767.0, f32::MAX, -32_768.0] {
        let height = move |x: f64, y: f64| if x < -900.0 && y > 900.0 { wrong } else { range(x, y) };
        write_terrain(&place, "wrong.tif", 28992, 0.0, height);
        let advice = format!("gdal_translate -a_nodata {wrong:?}");
        place.refusal(1, &format!("{shadow} wrong.tif"), &["wrong.tif", "column 1, row 1 ", &advice]);
    }
    write_terrain(&place, "empty.tif", 28992, 0.0, |_, _| f32::NAN);
    place.refusal(1, &format!("{shadow} empty.tif"), &["empty.tif", "values"]);
    place.write("text.tif", "no raster");
    place.refusal(1, &format!("{shadow} text.tif"), &["text.tif", "no TIFF file", "gdal_translate"]);
    place.refusal(1, &format!("{shadow} missing.tif"), &["missing.tif"]);
    // a result of Belvedere that lies where the terrain should, and whose values heights could have
    place.summary(&format!("sky-view {HOUSE} --cell 1 --directions 10 -o sky.tif"));
    place.refusal(1, &format!("{shadow} sky.tif"), &["sky.tif", "sky view factor", "no elevation raster"]);
    place.summary(&format!("viewshed {HOUSE} --observer {EAST},{NORTH},12 --cell 1 -o seen.tif"));
    place.refusal(1, &format!("{shadow} seen.tif"), &["seen.tif", "1 nothing blocks it"]);
    assert!(!place.path("lit.csv").exists());
}
