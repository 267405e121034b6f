//! Planned buildings and light through trees, tile by tile: correct, and the same as in one tile over all.

use crate::common::{MIDDLE, cells, clear_year, plan, shadow, sky_view, solar, sun_hours, suns};
use belvedere::apps::ask::{Days, SunHoursQuestion};
use belvedere::apps::irradiance::IrradianceParams;
use belvedere::apps::shadow::ShadowSun;
use belvedere::apps::tree_light::{CrownLight, CrownShadows, Foliage, Leaves, Transmissivity, crown_density};
use belvedere::control::Control;
use belvedere::crs::Crs;
use belvedere::io::{Georeference, read_balls, read_tif_f32, read_tif_u8, write_tif_f32};
use belvedere::raster::Raster;
use belvedere_tiles::{Plan, SideFile, TileQuestion, UnfinishedRun, merge};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Planned block across a corner of four tiles, higher than all other objects, file coordinates.
const LOW: [f64; 3] = [155_000.0, 462_970.0, -50.0];
const HIGH: [f64; 3] = [155_016.0, 462_984.0, 60.0];

/// Maximum number of balls at a time in small tiles.
const MAX_BALLS: usize = 700;

type CellMap<T> = BTreeMap<[i64; 2], T>;

/// Writes the block as a mesh file.
fn block(folder: &Path) -> PathBuf {
    let corner = |i: usize| [i & 1, i >> 1 & 1, i >> 2 & 1].map(|end| end == 1);
    let mut text = String::new();
    for i in 0..8 {
        let ends = corner(i);
        let [x, y, z]: [f64; 3] = std::array::from_fn(|axis| if ends[axis] { HIGH[axis] } else { LOW[axis] });
        text.push_str(&format!("v {x} {y} {z}\n"));
    }
    for [a, b, c, d] in [[1, 2, 4, 3], [5, 6, 8, 7], [1, 2, 6, 5], [3, 4, 8, 7], [1, 3, 7, 5], [2, 4, 8, 6]] {
        text.push_str(&format!("f {a} {b} {c}\nf {a} {c} {d}\n"));
    }
    let path = folder.join("block.obj");
    std::fs::write(&path, text).unwrap();
    path
}

/// Returns true if a line from `place` meets the block.
fn meets_block(place: [f64; 3], towards: [f64; 3]) -> bool {
    let (mut from, mut to) = (0.0_f64, f64::INFINITY);
    for axis in 0..3 {
        let [a, b] = [LOW[axis], HIGH[axis]].map(|end| (end - place[axis]) / towards[axis]);
        (from, to) = (from.max(a.min(b)), to.min(a.max(b)));
    }
    from <= to
}

fn codes(plan: &Plan, folder: &Path, question: &TileQuestion) -> CellMap<u8> {
    let path = folder.join("merged.tif");
    merge(plan, folder, question, &path, UnfinishedRun::Refused, &Control::none()).unwrap();
    let raster = read_tif_u8(&path).unwrap();
    cells(&path, raster.values(), raster.width(), 255)
}

fn numbers(plan: &Plan, folder: &Path, question: &TileQuestion) -> CellMap<f32> {
    let path = folder.join("merged.tif");
    merge(plan, folder, question, &path, UnfinishedRun::Refused, &Control::none()).unwrap();
    let raster = read_tif_f32(&path).unwrap();
    cells(&path, raster.values(), raster.width(), -9999.0)
}

/// Returns a changed plan after its complete run. Small tiles have so few balls at a time that each needs many parts.
fn done(folder: &Path, size: f64, questions: &[TileQuestion], change: impl FnOnce(Plan) -> Plan) -> Plan {
    change(plan(&MIDDLE.clouds, folder, size, questions.to_vec())).write(folder).unwrap();
    let plan = Plan::read(folder).unwrap();
    let max_balls = (size < 100.0).then_some(MAX_BALLS);
    let report = MIDDLE.run(&plan, folder, max_balls);
    assert!(report.failed.is_empty() && report.unproven_cells == 0, "{report:?}");
    assert_eq!(report.max_balls == MAX_BALLS, max_balls.is_some(), "{report:?}");
    plan
}

/// Returns a rule of two hours of sun on a day in spring, with few suns.
fn rule(plan: &Plan) -> TileQuestion {
    let days =
        Days { year: Some(2026), time_step_min: Some(60.0), min_sun_elevation_deg: Some(8.0), ..Days::default() };
    let rules = vec!["bre-equinox".to_owned()];
    let question = SunHoursQuestion { days, rules, place: solar(), ..SunHoursQuestion::default() };
    let frame = plan.frame().unwrap();
    let of_plan = (plan, &plan.whereabouts(&frame));
    TileQuestion::one_by_one(&question.into(), of_plan, &Control::none()).unwrap().remove(0)
}

#[test]
fn a_planned_building_blocks_exactly_whatever_the_tiles() {
    let place = tempfile::tempdir().unwrap();
    let mesh = block(place.path());
    let survey = plan(&MIDDLE.clouds, &place.path().join("survey"), 512.0, Vec::new());
    let questions = [suns()[1].clone(), sky_view(25), rule(&survey)];
    let folders = ["plain", "whole", "tiles"].map(|name| place.path().join(name));
    let add = |plan: Plan| plan.with_meshes(vec![SideFile::new(&mesh).unwrap()]).unwrap();
    let plain = done(&folders[0], 512.0, &questions, |plan| plan);
    let whole = done(&folders[1], 512.0, &questions, add);
    let tiles = done(&folders[2], 64.0, &questions, add);
    assert!(tiles.tiles.len() >= 4 && whole.tiles.len() == 1);
    let shadows = [(&plain, 0), (&whole, 1), (&tiles, 2)].map(|(plan, i)| codes(plan, &folders[i], &questions[0]));
    assert!(shadows[1] == shadows[2], "shadows of tiles differ");
    let skies = [(&whole, 1), (&tiles, 2)].map(|(plan, i)| numbers(plan, &folders[i], &questions[1]));
    assert!(skies[0] == skies[1], "sky views of tiles differ");
    let rules = [(&plain, 0), (&whole, 1), (&tiles, 2)].map(|(plan, i)| codes(plan, &folders[i], &questions[2]));
    assert!(rules[1] == rules[2], "rules of tiles differ");
    assert!(rules[0].values().filter(|&&code| code == 1).count() > 2000);
    // A building takes light and gives none, except on its top.
    let to_sun = ShadowSun::at(2.2, 20_f64.to_radians()).to_sun;
    let origin = whole.frame().unwrap().origin;
    let [bottom, top] = [whole.bounds().low[2], whole.bounds().high[2]].map(|z| f64::from(z) + origin[2]);
    let mut counts = [0; 3];
    for (&[east, north], &code) in &shadows[1] {
        let [x, y] = [east as f64 + 0.5, north as f64 - 0.5];
        if (LOW[0]..HIGH[0]).contains(&x) && (LOW[1]..HIGH[1]).contains(&y) {
            assert_eq!((code, rules[1][&[east, north]]), (1, 1), "{x} {y} on top of it");
            assert!(skies[0][&[east, north]] > 0.999, "{x} {y} on top of it");
            counts[0] += 1;
            continue;
        }
        // Cells lie between the lowest and the highest point.
        let heights = (0..=40).map(|step| bottom + (top - bottom + 0.1) * f64::from(step) / 40.0);
        let hits = heights.filter(|&z| meets_block([x, y, z], to_sun)).count();
        match hits {
            41 => assert_eq!(code, 0, "{x} {y} in its shadow"),
            0 => assert_eq!(code, shadows[0][&[east, north]], "{x} {y} out of its shadow"),
            _ => continue,
        }
        counts[if hits == 41 { 1 } else { 2 }] += 1;
        assert!(rules[1][&[east, north]] <= rules[0][&[east, north]], "{x} {y}");
    }
    assert!(counts[0] == 16 * 14 && counts[1] > 300 && counts[2] > 5000, "{counts:?}");
    assert!(rules[1].iter().any(|(cell, &code)| code < rules[0][cell]), "no cell loses its hours");
    // A mesh that changed after the plan is refused by name.
    std::fs::write(&mesh, "v 0 0 0\n").unwrap();
    std::fs::remove_dir_all(folders[2].join("sky_view_factor")).unwrap();
    let run = belvedere_tiles::run(
        &tiles,
        &folders[2],
        &belvedere_tiles::RunParams {
            shard: Default::default(),
            steps: Default::default(),
            max_balls: None,
            seconds: &|| 0.0,
        },
        &Control::none(),
    );
    let error = run.unwrap_err().to_string();
    assert!(error.contains("block.obj") && error.contains("make the plan again"), "{error}");
}

#[test]
fn light_through_trees_lies_between_opaque_trees_and_none_whatever_the_tiles() {
    let place = tempfile::tempdir().unwrap();
    let energy = clear_year(IrradianceParams::default().with_patch_division(1).with_sun_cell(0.6));
    let questions = [suns()[1].clone(), sky_view(25), energy];
    let through = |share: f64| {
        move |plan: Plan| {
            let transmissivity = Transmissivity::constant(share).unwrap();
            plan.with_light_through_trees(CrownLight::Share { transmissivity, leaves: Leaves::ByDate }).unwrap()
        }
    };
    let folder = |name: &str| place.path().join(name);
    let opaque = done(&folder("opaque"), 512.0, &questions, |plan| plan);
    let none = done(&folder("none"), 512.0, &questions, through(1.0));
    let half = done(&folder("half"), 512.0, &questions, through(0.5));
    let tiles = done(&folder("tiles"), 64.0, &questions, through(0.5));
    let shadow = codes(&opaque, &folder("opaque"), &questions[0]);
    let [without, found, of_tiles] = [(&none, "none"), (&half, "half"), (&tiles, "tiles")]
        .map(|(plan, name)| numbers(plan, &folder(name), &questions[0]));
    assert!(found == of_tiles, "shadows of tiles differ");
    let mut counts = [0; 3];
    for (cell, &share) in &found {
        let (expected, kind) = match (shadow[cell], without[cell]) {
            (1, 1.0) => (1.0, 2),
            (0, 1.0) => (0.5, 1),
            (0, 0.0) => (0.0, 0),
            odd => panic!("{cell:?}: {odd:?}"),
        };
        assert_eq!(share, expected, "{cell:?}");
        counts[kind] += 1;
    }
    assert!(counts.iter().all(|&count| count > 100), "{counts:?}");
    for question in &questions[1..] {
        let [opaque, none, half, tiles] = [(&opaque, "opaque"), (&none, "none"), (&half, "half"), (&tiles, "tiles")]
            .map(|(plan, name)| numbers(plan, &folder(name), question));
        assert!(half == tiles, "{}: tiles differ", question.name);
        // Rounding of f32: a ten-millionth of the values, which are up to 1 and up to about a thousand.
        let is_between =
            |(cell, &v): (_, &f32)| (v - 0.5 * (opaque[cell] + none[cell])).abs() <= 1e-6 * none[cell].max(1.0);
        assert!(half.iter().all(is_between), "{}", question.name);
        let more = none.iter().filter(|(cell, v)| **v > opaque[*cell]).count();
        assert!(more > 100, "{}: {more} cells see more without trees", question.name);
    }
}

#[test]
fn light_through_measured_crowns_is_the_same_in_tiles_of_any_size() {
    let place = tempfile::tempdir().unwrap();
    let hours = |date: &str| {
        let days = Days { dates: vec![date.to_owned()], time_step_min: Some(60.0), ..Days::default() };
        sun_hours(days)
    };
    let questions = [suns()[1].clone(), sky_view(25), hours("2026-01-10")];
    let density = |plan: &Plan| plan.crown_density(None).unwrap();
    let measured = |plan: Plan| {
        let crowns =
            CrownLight::Measured { leaves: Leaves::ByDate, density: density(&plan), shadows: CrownShadows::Answers };
        plan.with_light_through_trees(crowns).unwrap()
    };
    let folder = |name: &str| place.path().join(name);
    let opaque = done(&folder("opaque"), 512.0, &questions, |plan| plan);
    let whole = done(&folder("whole"), 512.0, &questions, measured);
    let tiles = done(&folder("tiles"), 64.0, &questions, measured);
    // The simulated survey is of 17 March: without leaves, as in January.
    assert_eq!([&whole, &tiles].map(density), [Some(crown_density(Foliage::Bare)); 2]);
    let says_leaves = |plan: &Plan, date: &str| {
        let plan = plan.clone().with_questions(vec![hours(date)], &Control::none()).unwrap();
        plan.remarks.iter().any(|remark| remark.key == "leaves-unlike-measured")
    };
    for plan in [&whole, &tiles] {
        assert!(says_leaves(plan, "2026-06-10") && !says_leaves(plan, "2026-01-10"));
    }
    let [of_whole, of_tiles] = [(&whole, "whole"), (&tiles, "tiles")].map(|(plan, name)| crowns(plan, &folder(name)));
    assert!(of_whole.len() > 1000 && of_whole == of_tiles, "{} {}", of_whole.len(), of_tiles.len());
    let [solid, found, of_tiles] = [(&opaque, "opaque"), (&whole, "whole"), (&tiles, "tiles")]
        .map(|(plan, name)| codes(plan, &folder(name), &questions[0]));
    assert!(found == of_tiles, "shadows of tiles differ");
    let changed = found.iter().filter(|(cell, lit)| solid[*cell] != **lit).count();
    assert!(changed > 20, "{changed} cells differ from those among solid crowns");
    let [solid, found, of_tiles] = [(&opaque, "opaque"), (&whole, "whole"), (&tiles, "tiles")]
        .map(|(plan, name)| numbers(plan, &folder(name), &questions[1]));
    assert!(found == of_tiles, "views of the sky from tiles differ");
    let more = found.iter().filter(|(cell, v)| **v > solid[*cell]).count();
    assert!(more > 100, "{more} cells see more of the sky through crowns");
    let [solid, found, of_tiles] = [(&opaque, "opaque"), (&whole, "whole"), (&tiles, "tiles")]
        .map(|(plan, name)| numbers(plan, &folder(name), &questions[2]));
    assert!(found == of_tiles, "sun hours of tiles differ");
    let more = found.iter().filter(|(cell, v)| **v > solid[*cell] + 0.1).count();
    assert!(more > 100, "{more} cells get more sun through crowns");
}

/// Returns the voxels of the crowns of all tiles, with the bits of their extinction.
fn crowns(plan: &Plan, folder: &Path) -> BTreeMap<[i32; 3], u32> {
    let mut all = BTreeMap::new();
    for tile in &plan.tiles {
        let path = folder.join("balls").join(format!("{}.crowns.npz", tile.name()));
        let Some(medium) = path.exists().then(|| read_balls(&path).unwrap().medium.unwrap()) else { continue };
        let of_tile = medium.voxels.iter().zip(&medium.extinction);
        let before = all.len();
        all.extend(of_tile.map(|(voxel, extinction)| (*voxel, extinction.to_bits())));
        assert_eq!(all.len(), before + medium.len(), "a voxel belongs to one tile");
    }
    all
}

/// Height of a ridge north of the town, and the northing of its side, file coordinates.
const RIDGE: [f32; 2] = [900.0, 464_000.0];

/// Writes level ground as low as the town, with the ridge, in cells of 20 m.
fn ridge(folder: &Path, ground: f32, crs: Crs) -> PathBuf {
    let (size, cell, west, north) = (200, 20.0, 153_000.0, 466_000.0);
    let height = |row: usize| if north - cell * (row as f64 + 0.5) > f64::from(RIDGE[1]) { RIDGE[0] } else { ground };
    let heights = (0..size * size).map(|i| height(i / size)).collect();
    let place = Georeference { upper_left: [west, north], column_step: [cell, 0.0], row_step: [0.0, -cell], crs };
    let path = folder.join("dtm.tif");
    write_tif_f32(path.as_path(), &Raster::from_values(size, size, heights).unwrap(), Some(&place), None, None)
        .unwrap();
    path
}

#[test]
fn mountains_beyond_a_survey_take_the_light_of_all_tiles() {
    let place = tempfile::tempdir().unwrap();
    let plain = plan(&MIDDLE.clouds, &place.path().join("plain"), 512.0, Vec::new());
    let frame = plain.frame().unwrap();
    let lowest = (f64::from(plain.bounds().low[2]) + frame.origin[2]) as f32;
    let terrain = ridge(place.path(), lowest, frame.crs.clone());
    let horizon = place.path().join("horizon.csv");
    std::fs::write(&horizon, "azimuth,elevation\n90,0\n180,30\n270,0\n").unwrap();
    // The sun stands over the ridge and below its top, over it and above its top, and beside it. 31 degrees in the
    // south are above the given horizon.
    let sun = |azimuth: f64, elevation: f64| {
        shadow(&format!("shadow_{azimuth}_{elevation}"), azimuth.to_radians(), elevation.to_radians())
    };
    let suns = [sun(0.0, 39.0), sun(0.0, 60.0), sun(180.0, 29.0), sun(180.0, 31.0)];
    let questions: Vec<TileQuestion> = suns.iter().cloned().chain([sky_view(25)]).collect();
    let folders = ["without", "whole", "tiles"].map(|name| place.path().join(name));
    let far = |plan: Plan| {
        let [terrain, horizon] = [&terrain, &horizon].map(|path| Some(SideFile::new(path).unwrap()));
        plan.with_far_terrain(terrain, horizon).unwrap()
    };
    let without = done(&folders[0], 512.0, &questions, |plan| plan);
    let whole = done(&folders[1], 512.0, &questions, far);
    let tiles = done(&folders[2], 64.0, &questions, far);
    // The ridge is 950 m from the north edge of the town and 1070 m from the south edge, and 870 to 900 m higher. Its
    // top appears above 39 and below 44 degrees.
    for (number, is_hidden) in [true, false, true, false].into_iter().enumerate() {
        let [before, of_whole, of_tiles] =
            [(&without, 0), (&whole, 1), (&tiles, 2)].map(|(plan, i)| codes(plan, &folders[i], &questions[number]));
        assert!(of_whole == of_tiles, "{:?}", questions[number]);
        assert!(before.values().filter(|&&code| code == 1).count() > 2000);
        let expected = |code: u8| if is_hidden { 0 } else { code };
        let wrong = before.iter().filter(|(cell, code)| of_whole[*cell] != expected(**code)).count();
        assert_eq!(wrong, 0, "{:?}", questions[number]);
    }
    let [before, of_whole, of_tiles] =
        [(&without, 0), (&whole, 1), (&tiles, 2)].map(|(plan, i)| numbers(plan, &folders[i], &questions[4]));
    assert!(of_whole == of_tiles, "sky views of tiles differ");
    // The ridge hides an eighth of an open sky, and the horizon 4 %; with few directions less is certain.
    let loses = |(cell, sky): (&[i64; 2], &f32)| of_whole[cell] <= sky - if *sky > 0.95 { 0.08 } else { 0.0 };
    assert!(before.iter().all(loses) && before.values().filter(|&&sky| sky > 0.95).count() > 500);
    // Files without a horizon are refused by name.
    let moved = place.path().join("moved.csv");
    std::fs::write(&moved, "no table\n").unwrap();
    let refused = plain.with_far_terrain(None, Some(SideFile::new(&moved).unwrap())).unwrap_err().to_string();
    assert!(refused.contains("moved.csv"), "{refused}");
}
