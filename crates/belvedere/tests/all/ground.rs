//! The ground found in clouds, against the exact ground of simulated towns and against the classes of a survey.

use crate::common::simulated::cloud_of;
use belvedere::Bounds;
use belvedere::apps::ask::Scene;
use belvedere::apps::targets::grid_around;
use belvedere::control::Control;
use belvedere::ground::{
    FinderParams, Ground, GroundParams, GroundPoints, MapGrid, find_ground, ground_points, hidden_ground,
};
use belvedere::io::{ReadOptions, read_cloud};
use belvedere::model::{ModelParts, SceneModel};
use belvedere::raster::Raster;
use belvedere::{Attributes, PointCloud};
use belvedere_scenes::{AirborneParams, Preset, QuerySite, Truth, scan_airborne, town};
use std::sync::Arc;

fn grid_of(cloud: &PointCloud, cell: f64) -> MapGrid {
    let Bounds { low, high } = cloud.bounds().unwrap();
    let on_map = |p: [f32; 3]| [f64::from(p[0]), f64::from(p[1])];
    MapGrid::covering(on_map(low), on_map(high), cell, [cloud.frame.origin[0], cloud.frame.origin[1]]).unwrap()
}

/// Share of `truth` that `found` holds, and share of `found` that is in `truth`.
fn recall_and_precision(found: &[u32], truth: &[u32]) -> [f64; 2] {
    let truth_set: std::collections::HashSet<u32> = truth.iter().copied().collect();
    let both = found.iter().filter(|row| truth_set.contains(row)).count() as f64;
    [both / truth.len() as f64, both / found.len() as f64]
}

#[test]
fn ground_found_without_classes_lies_on_the_exact_ground() {
    // shares of cells within 0.2 m of the exact ground: (classed, found)
    for (preset, min) in
        [(Preset::Village, [0.99, 0.98]), (Preset::Town, [0.99, 0.95]), (Preset::OldTown, [0.99, 0.97])]
    {
        let scene = town(&preset.params(110.0, 5));
        let scan = scan_airborne(&scene, &AirborneParams { seed: 5, ..AirborneParams::covering(&scene, 8.0) });
        let cloud = cloud_of(&scan);
        let unclassed = PointCloud { attributes: Attributes::default(), ..cloud.clone() };
        let truth = Truth::new(&scene);
        let Bounds { low, high } = cloud.bounds().unwrap();
        let absolute = |p: [f32; 3]| -> [f64; 3] { std::array::from_fn(|i| f64::from(p[i]) + cloud.frame.origin[i]) };
        let site = QuerySite { scene: &scene, truth: &truth, bounds: [absolute(low), absolute(high)] };
        for (cloud, from, min) in [(&cloud, GroundPoints::Classed, min[0]), (&unclassed, GroundPoints::Found, min[1])] {
            let (ground, report) =
                Ground::of_cloud(cloud, grid_of(cloud, 1.0), &GroundParams::default(), &Control::none()).unwrap();
            assert_eq!(report.from, from);
            let mut errors = vec![];
            for row in 0..ground.grid.height {
                for column in 0..ground.grid.width {
                    let [x, y] = ground.grid.center(column, row);
                    let exact = site.ground_height([x + cloud.frame.origin[0], y + cloud.frame.origin[1]]);
                    let height = ground.heights.get(column, row).unwrap();
                    if let Some(exact) = exact.filter(|_| height.is_finite()) {
                        errors.push((f64::from(height) + cloud.frame.origin[2] - exact).abs());
                    }
                }
            }
            let good = errors.iter().filter(|e| **e < 0.2).count() as f64 / errors.len() as f64;
            errors.sort_by(f64::total_cmp);
            let [median, p95] = [2, 20].map(|part| errors[errors.len() - errors.len() / part]);
            println!("{} {from:?}: {good:.3} within 0.2 m, median {median:.3}, 95 % {p95:.3}", preset.name());
            assert!(good > min, "{} {from:?}: {good}", preset.name());
        }
    }
}

#[test]
fn ground_of_delft_is_found_as_its_makers_classed_it() {
    let Some(path) = crate::common::data("ground_of_delft", "data/delft_ahn3/ahn3_cropped_1.laz") else { return };
    let (cloud, _) = read_cloud(&[path], &ReadOptions::default(), &Control::none()).unwrap();
    let (truth, from) = ground_points(&cloud, &GroundParams::default(), &Control::none()).unwrap();
    assert_eq!(from, GroundPoints::Classed);
    let unclassed = PointCloud { attributes: Attributes::default(), ..cloud.clone() };
    let found = find_ground(&unclassed, &FinderParams::default(), &Control::none()).unwrap();
    let [recall, precision] = recall_and_precision(&found, &truth);
    println!("Delft: recall {recall:.3}, precision {precision:.3}");
    assert!(recall > 0.98 && precision > 0.92, "{recall} {precision}");
}

#[test]
fn heights_say_how_far_the_next_ground_point_is() {
    // ground on a lattice of 1 m with a hole of 20 m, as below a hall
    let mut points = vec![];
    for x in 0..=60_u8 {
        for y in 0..=60_u8 {
            if !(20..=40).contains(&x) || !(20..=40).contains(&y) {
                points.push([f32::from(x), f32::from(y), 0.1 * f32::from(x)]);
            }
        }
    }
    let grid = MapGrid::covering([-20.0; 2], [80.0; 2], 1.0, [0.0; 2]).unwrap();
    let ground = Ground::of_points(&points, grid, 8.0, &Control::none()).unwrap();
    let at =
        |p: [f64; 2]| grid.cell_of(p).map(|[c, r]| (ground.heights.get(c, r).unwrap(), ground.gaps.get(c, r).unwrap()));
    let (height, gap) = at([25.0, 30.0]).unwrap();
    // linear across the hole; the middle of the cell is at 25.5
    assert!((height - 2.55).abs() < 1e-4 && (gap - 6.5).abs() < 0.6, "{height} {gap}");
    // beyond the reach, and beyond the border of the survey
    assert!(at([30.0, 30.0]).unwrap().0.is_nan() && at([70.0, 30.0]).unwrap().0.is_nan());
    assert!(at([63.0, 30.0]).unwrap().0.is_finite());
    assert!((ground.height_at([10.25, 5.25]).unwrap() - 1.025).abs() < 1e-4);
    assert_eq!(ground.height_at([30.0, 30.0]), None);
    assert_eq!(ground.height_at([f64::NAN, 0.0]), None);
}

#[test]
fn a_cloud_without_ground_is_refused_with_advice() {
    let (cloud, _) = PointCloud::from_coordinates(&[[0.0; 3], [1.0, 1.0, 0.0], [2.0, 0.0, 1.0]]);
    let classed = GroundParams { points: GroundPoints::Classed, ..GroundParams::default() };
    assert!(ground_points(&cloud, &classed, &Control::none()).unwrap_err().to_string().contains("class 2"));
    assert!(ground_points(&PointCloud::default(), &GroundParams::default(), &Control::none()).is_err());
    let noise = Attributes { classification: Some(vec![7; 3]), ..Attributes::default() };
    assert!(
        find_ground(&PointCloud { attributes: noise, ..cloud.clone() }, &FinderParams::default(), &Control::none())
            .is_err()
    );
    for params in [
        FinderParams { cell: 0.0, ..FinderParams::default() },
        FinderParams { slope: f64::NAN, ..FinderParams::default() },
        FinderParams { window: 1e9, ..FinderParams::default() },
        FinderParams { tolerance: -1.0, ..FinderParams::default() },
    ] {
        assert!(find_ground(&cloud, &params, &Control::none()).is_err());
    }
}

#[test]
fn ground_is_hidden_under_buildings_and_not_under_cars() {
    // a roof over the square from 10 to 20 m, a car from 30 to 32 m, both without ground points below
    let under = |x: f32, y: f32, from: f32, to: f32| (from..to).contains(&x) && (from..to).contains(&y);
    let places = || (0..80).flat_map(|i| (0..80).map(move |j| [0.5 * i as f32 + 0.25, 0.5 * j as f32 + 0.25]));
    let covered = |[x, y]: [f32; 2]| under(x, y, 10.0, 20.0) || under(x, y, 30.0, 32.0);
    let ground: Vec<[f32; 3]> = places().filter(|p| !covered(*p)).map(|[x, y]| [x, y, 0.0]).collect();
    let top = |[x, y]: [f32; 2]| [x, y, if under(x, y, 10.0, 20.0) { 5.0 } else { 1.5 }];
    let all: Vec<[f32; 3]> = ground.iter().copied().chain(places().filter(|p| covered(*p)).map(top)).collect();
    let grid = MapGrid::covering([0.0, 0.0], [39.9, 39.9], 1.0, [0.0, 0.0]).unwrap();
    let hidden = hidden_ground(&all, &Ground::of_points(&ground, grid, 60.0, &Control::none()).unwrap());
    for (cell, is_hidden) in hidden.into_iter().enumerate() {
        let [x, y] = grid.center(cell % grid.width, cell / grid.width);
        let inside = |margin: f64| [x, y].iter().all(|v| (10.0 + margin..20.0 - margin).contains(v));
        // the next ground point lies a quarter of a metre beyond the wall
        let expected = inside(0.75);
        assert_eq!(is_hidden, expected, "{x} {y}");
    }
}

/// Returns the offset of ground over an area, metres.
fn shift_of(cloud: &PointCloud) -> Option<f32> {
    let (_, report) =
        Ground::of_cloud(cloud, grid_of(cloud, 20.0), &GroundParams::default(), &Control::none()).unwrap();
    report.shift.map(|shift| shift.rise)
}

#[test]
fn real_ground_is_not_said_to_lie_off_and_a_strip_of_it_is() {
    let files = [
        ("delft_ahn3/ahn3_cropped_1.laz", Some(57138)),
        ("delft_ahn3/ahn3_cropped_2.laz", Some(57138)),
        ("tudelft_ahn4_small/small.laz", None),
        ("amsterdam_ahn3/ahn_2386_9702.laz", Some(56030)),
        ("bresse_lidarhd/870000_6618000.subset.50mx100m.las", None),
        ("ign_decimated_towns/test_semis_2023_0292_6833_LA93_IGN69.laz", Some(2)),
        ("terrain/Topography.laz", None),
        ("exact_town/a/cloud.laz", Some(1)),
        ("io_cases/autzen_trim.laz", None),
        ("io_cases/las_with_several_extra_byte_bloc.laz", None),
        ("io_cases/sample_c.las", Some(56)),
    ];
    for (number, (file, strip)) in files.into_iter().enumerate() {
        let Some(path) = crate::common::data("real_ground", &format!("data/{file}")) else { continue };
        let (cloud, _) = read_cloud(&[path], &ReadOptions::default(), &Control::none()).unwrap();
        assert_eq!(shift_of(&cloud), None, "{file}");
        let raised = |is_raised: &dyn Fn(usize) -> bool, rise: f32| {
            let mut raised = cloud.clone();
            let classes = cloud.attributes.classification.as_ref().unwrap();
            let rows = (0..cloud.len()).filter(|&row| classes[row] == 2 && is_raised(row));
            rows.for_each(|row| raised.positions[row][2] += rise);
            raised
        };
        let sources = cloud.attributes.point_source_id.as_ref().unwrap();
        if let Some(strip) = strip {
            let rise = if number.is_multiple_of(2) { 1.5 } else { -1.5 };
            let found = shift_of(&raised(&|row| sources[row] == strip, rise));
            let found = found.unwrap_or_else(|| panic!("{file}: {rise}"));
            // of the two, the level with fewer points is said to lie off
            assert!((found.abs() - 1.5).abs() < 0.2, "{file}: {found}");
        }
    }
}

#[test]
fn places_one_after_the_other_stand_on_the_ground_of_the_whole_cloud() {
    let scene = town(&Preset::Village.params(80.0, 5));
    let scan = scan_airborne(&scene, &AirborneParams { seed: 5, ..AirborneParams::covering(&scene, 8.0) });
    let cloud = Arc::new(cloud_of(&scan));
    let fresh = || {
        let parts = ModelParts { frame: cloud.frame.clone(), ..ModelParts::default() };
        Scene::new(SceneModel::from_parts(parts).unwrap(), Arc::clone(&cloud))
    };
    let kept = fresh();
    let ([west, south, _], [east, north, _]) = cloud.bounds().unwrap().corners();
    for share in [0.5, 0.1, 0.9, 0.3, 0.7] {
        let place = [west + share * (east - west), south + share * share * (north - south), f64::NAN];
        let grid = grid_around([place], cloud.frame.origin).unwrap().unwrap();
        let [known, expected] =
            [&kept, &fresh()].map(|scene| scene.ground(grid, GroundPoints::Auto, &Control::none()).unwrap());
        let bits = |raster: &Raster<f32>| raster.values().iter().map(|value| value.to_bits()).collect::<Vec<u32>>();
        assert_eq!(bits(&known.ground.heights), bits(&expected.ground.heights));
        assert_eq!(bits(&known.ground.gaps), bits(&expected.ground.gaps));
        assert_eq!(known.report, expected.report);
        assert!(known.report.cell_count > 1000);
    }
}
