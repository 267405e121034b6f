//! No raster has a value in a hole of the survey, under a roof or inside what is planned, and rasters say with a second
//! band what is not proven.

use crate::common::{EAST, NORTH, ROUGHNESS, Workplace, at, house};
use belvedere::io::{PlacedRaster, ReadBands, read_tif, read_tif_bands};
use belvedere::{Attributes, PointCloud};

/// Half the width of the hole, metres.
const HOLE: f64 = 25.0;
/// Maximum distance of a cell with a value from the nearest return, metres.
const NEAR: f64 = 5.0;

/// A field of 100 m with the house in its south-west, and a hole of 50 m in its middle.
fn field_with_a_hole() -> PointCloud {
    let mut points: Vec<([f32; 3], [f32; 3])> = Vec::new();
    let house = house();
    let normals = house.attributes.normals.as_deref().unwrap_or_default();
    for (&[x, y, z], &normal) in house.positions.iter().zip(normals) {
        points.push(([x - 43.0, y - 43.0, z], normal));
    }
    let steps = || (0..=100_u16).map(|i| f32::from(i) - 50.0);
    for x in steps() {
        for y in steps() {
            let is_in_hole = x.abs() < HOLE as f32 && y.abs() < HOLE as f32;
            if !is_in_hole && (x > -28.0 || y > -28.0) {
                let height = if (x + y).rem_euclid(2.0) < 0.5 { ROUGHNESS } else { -ROUGHNESS };
                points.push(([x, y, height], [0.0, 0.0, 1.0]));
            }
        }
    }
    PointCloud {
        positions: points.iter().map(|point| point.0).collect(),
        attributes: Attributes { normals: Some(points.iter().map(|point| point.1).collect()), ..Attributes::default() },
        ..house
    }
}

/// Cells with a value deeper in the hole than 5 m, and cells with one elsewhere.
fn with_a_value(raster: &PlacedRaster) -> [usize; 2] {
    let place = raster.place.as_ref().unwrap();
    let mut counts = [0; 2];
    for row in 0..raster.values.height() {
        for column in 0..raster.values.width() {
            let x = place.upper_left[0] + (column as f64 + 0.5) * place.column_step[0] - EAST;
            let y = place.upper_left[1] + (row as f64 + 0.5) * place.row_step[1] - NORTH;
            let is_deep = x.abs() < HOLE - NEAR && y.abs() < HOLE - NEAR;
            if raster.values.get(column, row).unwrap().is_finite() {
                counts[usize::from(!is_deep)] += 1;
            }
        }
    }
    counts
}

#[test]
fn a_hole_of_the_survey_has_no_value_in_any_raster() {
    let place = Workplace::new();
    place.write_cloud("field.laz", &field_with_a_hole());
    place.write(
        "wall.obj",
        format!(
            "v {0} {1} 0\nv {0} {2} 0\nv {0} {2} 6\nv {0} {1} 6\nf 1 2 3\nf 1 3 4\n",
            EAST + 45.0,
            NORTH - 5.0,
            NORTH + 5.0
        ),
    );
    let scene = "field.laz --scene-config ../tau.json --orient given";
    let [x, y, z] = at(0.0, 40.0, 8.0);
    let day = "--date 2026-06-21 --time-step-min 60";
    for (command, flags) in [
        ("shadow", "--sun 200,30 --ground found --measures all".to_owned()),
        ("shadow", "--sun 200,30 --ground found --surface".to_owned()),
        ("sky-view", "--directions 16 --ground found --measures all".to_owned()),
        ("sky-view", "--directions 16 --ground found --surface".to_owned()),
        ("sun-hours", format!("{day} --ground found --measures all")),
        ("irradiance", "--clear-sky haurwitz --year 2026 --ground found --surface".to_owned()),
        ("viewshed", format!("--observer {x},{y},{z} --ground found --heights all/heights.tif")),
        ("viewshed", format!("--target {x},{y},{z} --ground found")),
        ("landmark", "--targets wall.obj --ground found --measures all".to_owned()),
    ] {
        std::fs::create_dir_all(place.path("all")).unwrap();
        place.summary(&format!("{command} {scene} {flags} --cell 2 -o all/one.tif"));
        for file in std::fs::read_dir(place.path("all")).unwrap() {
            let path = file.unwrap().path();
            let [in_hole, elsewhere] = with_a_value(&read_tif(path.as_path()).unwrap());
            // some measures have a value in few cells: distances to a landmark where it is visible, hours of sun where
            // there is sun
            let min = if path.ends_with("one.tif") { 300 } else { 50 };
            assert!(in_hole == 0 && elsewhere > min, "{command} {flags} {path:?}: {in_hole} {elsewhere}");
        }
        std::fs::remove_dir_all(place.path("all")).unwrap();
    }
}

#[test]
fn suns_and_counts_are_bands_with_names_in_the_type_of_their_kind() {
    let place = Workplace::with_house();
    let scene = "house.laz --scene-config ../tau.json --orient given --ground found --cell 1";
    place.summary(&format!("shadow {scene} --sun 180,30 --sun 240,20 -o lit.tif -o lit.csv --measures each"));
    let ReadBands::U8(bands) = read_tif_bands(place.path("lit.tif").as_path()).unwrap() else { panic!("bytes") };
    let ReadBands::U8(second) = read_tif_bands(place.path("each/lit_2.tif").as_path()).unwrap() else {
        panic!("bytes")
    };
    assert_eq!((bands.len(), &bands[1]), (2, &second[0]));
    assert!(bands[0] != bands[1] && bands[0].values().contains(&255));
    let further = read_tif(place.path("lit.tif").as_path()).unwrap().further_bands;
    assert_eq!(further.iter().map(|band| band.name.as_str()).collect::<Vec<_>>(), ["lit_2"]);
    place.summary(&format!("shadow {scene} --sun 180,30 --soft -o soft.tif"));
    assert!(matches!(read_tif_bands(place.path("soft.tif").as_path()).unwrap(), ReadBands::F32(_)));
    // of balls that no pulses cut, nothing is proven or unproven
    let [x, y, z] = at(-10.0, -10.0, 2.0);
    place.summary(&format!("viewshed {scene} --observer {x},{y},{z} -o one.tif"));
    let ReadBands::U8(one) = read_tif_bands(place.path("one.tif").as_path()).unwrap() else { panic!("bytes") };
    assert_eq!(one.len(), 1);
    // ground under the roof is no place
    assert_eq!(one[0].get(one[0].width() / 2, one[0].height() / 2), Some(255));
    place.summary(&format!("viewshed {scene} --observer {x},{y},{z} --observer {x},{},{z} -o two.tif", y + 20.0));
    let ReadBands::U16(two) = read_tif_bands(place.path("two.tif").as_path()).unwrap() else { panic!("counts") };
    assert!(two.len() == 1 && two[0].values().contains(&2) && two[0].values().contains(&65_535));
}

#[test]
fn a_second_band_says_what_pulses_do_not_prove() {
    let place = Workplace::new();
    place.summary("simulate town -o town --extent 60 --density 8");
    let scene = "town/cloud.laz --cell 1";
    let run = place.summary(&format!("shadow {scene} --sun 180,30 -o lit.tif"));
    let ReadBands::U8(lit) = read_tif_bands(place.path("lit.tif").as_path()).unwrap() else { panic!("bytes") };
    let [lit, unproven] = &lit[..] else { panic!("{} bands", lit.len()) };
    let cells = || lit.values().iter().zip(unproven.values());
    assert!(cells().all(|cell| matches!(cell, (0, 0) | (1, 0 | 1) | (255, 255))));
    assert!(cells().any(|cell| cell == (&1, &1)) && cells().any(|cell| cell == (&1, &0)), "{run}");
    let names = |name: &str| -> Vec<String> {
        read_tif(place.path(name).as_path()).unwrap().further_bands.into_iter().map(|band| band.name).collect()
    };
    assert_eq!(names("lit.tif"), ["unproven"]);
    let place_of = |dx: f64| format!("--observer {},462985,10", 155_000.0 + dx);
    let run = place.summary(&format!("viewshed {scene} {} -o one.tif", place_of(0.0)));
    let ReadBands::U8(one) = read_tif_bands(place.path("one.tif").as_path()).unwrap() else { panic!("bytes") };
    let count = |wanted: [u8; 2]| {
        one[0].values().iter().zip(one[1].values()).filter(|(a, b)| [**a, **b] == wanted).count() as u64
    };
    assert_eq!(
        [count([1, 0]), count([1, 1]), count([0, 0])].map(Some),
        ["visible", "unproven", "blocked"].map(|name| run["cells"][name].as_u64())
    );
    assert!(count([1, 1]) > 0);
    place.summary(&format!("viewshed {scene} {} {} -o many.tif --masks masks.npy", place_of(0.0), place_of(2.0)));
    let ReadBands::U16(many) = read_tif_bands(place.path("many.tif").as_path()).unwrap() else { panic!("counts") };
    let (_, masks) = place.npy::<u32>("masks.npy");
    assert_eq!(names("many.tif"), ["unproven"]);
    for ((free, unproven), mask) in many[0].values().iter().zip(many[1].values()).zip(&masks) {
        let proven = if *free == 65_535 { 0 } else { free - unproven };
        assert_eq!(u32::from(proven), mask.count_ones());
    }
    // as the user settles them, nothing is left open
    place.summary(&format!("viewshed {scene} {} --unproven as-blocked -o one.tif", place_of(0.0)));
    let ReadBands::U8(settled) = read_tif_bands(place.path("one.tif").as_path()).unwrap() else { panic!("bytes") };
    assert_eq!(settled.len(), 1);
    assert_eq!(settled[0].values().iter().filter(|v| **v == 1).count() as u64, count([1, 0]));
}
