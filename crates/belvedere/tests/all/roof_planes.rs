//! Roofs as planes, against roofs whose tilt, azimuth and area are known.

use belvedere::apps::horizon::{HorizonParams, horizons};
use belvedere::apps::irradiance::horizon_places;
use belvedere::apps::roof_planes::{RoofPlane, RoofPlaneParams, RoofsFrom, roof_planes, roof_points};
use belvedere::control::Control;
use belvedere::ground::{Ground, MapGrid};
use belvedere::io::outlines;
use belvedere::medial::MedialBalls;
use belvedere::query::{BlockRule, MedialScene};
use belvedere::random::uniform;
use belvedere::{Attributes, PointCloud};
use std::f64::consts::FRAC_PI_2;

/// Noise of airborne scans, metres, evenly spread.
const NOISE: f64 = 0.04;

/// Points drawn evenly at `density` a square metre of the map over `[x0, x1] x [y0, y1]`, at a height.
fn sheet(
    seed: u64,
    density: f64,
    [x0, x1]: [f64; 2],
    [y0, y1]: [f64; 2],
    height: impl Fn(f64, f64) -> f64,
) -> Vec<[f32; 3]> {
    let count = ((x1 - x0) * (y1 - y0) * density) as u64;
    let point = |i: u64| {
        let (x, y) = (x0 + (x1 - x0) * uniform(seed, 3 * i), y0 + (y1 - y0) * uniform(seed, 3 * i + 1));
        [x, y, height(x, y) + NOISE * (2.0 * uniform(seed, 3 * i + 2) - 1.0)].map(|v| v as f32)
    };
    (0..count).map(point).collect()
}

/// A house of 12 m by 8 m under a roof of 40 degrees whose ridge runs east, and a flat annex of 6 m by 5 m.
fn house(density: f64) -> Vec<[f32; 3]> {
    let slope = 40f64.to_radians().tan();
    let mut points = sheet(1, density, [0.0, 12.0], [0.0, 8.0], |_, y| 9.0 - slope * (y - 4.0).abs());
    points.extend(sheet(2, density, [20.0, 26.0], [0.0, 5.0], |_, _| 3.0));
    points
}

fn faces(plane: &RoofPlane, azimuth_deg: f64) -> bool {
    plane.azimuth().is_some_and(|azimuth| (azimuth.to_degrees() - azimuth_deg).abs() < 2.0)
}

#[test]
fn tilt_azimuth_and_area_of_a_house_are_found() {
    for density in [4.0, 12.0, 40.0] {
        let planes = roof_planes(&house(density), &RoofPlaneParams::default(), &Control::none()).unwrap();
        assert_eq!(planes.len(), 3, "{density}: {planes:?}");
        let side = 12.0 * 4.0 / 40f64.to_radians().cos();
        // points end half their distance before the edge, which makes the area smaller; cells of a metre round the rest
        let tolerance = |area: f64| 0.1 * area;
        for plane in &planes[..2] {
            assert!((plane.tilt().to_degrees() - 40.0).abs() < 1.0, "{}", plane.tilt().to_degrees());
            assert!((plane.area - side).abs() < tolerance(side), "{density}: {} {side}", plane.area);
            assert!(plane.roughness < NOISE);
        }
        assert!(planes[..2].iter().any(|plane| faces(plane, 0.0) || faces(plane, 360.0)));
        assert!(planes[..2].iter().any(|plane| faces(plane, 180.0)));
        assert!(
            planes[2].tilt().to_degrees() < 1.0 && (planes[2].area - 30.0).abs() < tolerance(30.0),
            "{}",
            planes[2].area
        );
    }
}

#[test]
fn cells_lie_in_their_plane_in_level_rows() {
    let planes = roof_planes(&house(12.0), &RoofPlaneParams::default(), &Control::none()).unwrap();
    for plane in &planes {
        let cells = plane.cells.middles();
        assert!(cells.windows(2).all(|pair| pair[0].1 <= pair[1].1));
        for (place, row) in &cells {
            let offset: f64 = (0..3).map(|i| (place[i] - plane.middle[i]) * plane.normal[i]).sum();
            assert!(offset.abs() < 1e-9, "{offset}");
            let first = cells.iter().find(|(_, other)| other == row).unwrap().0;
            assert!((first[2] - place[2]).abs() < 1e-6, "a row is a contour line");
        }
    }
}

#[test]
fn area_is_that_of_a_turned_rectangle() {
    // edges that run across the cells
    for turn in [0.0, 17.0, 45.0_f64] {
        let (sin, cos) = turn.to_radians().sin_cos();
        let turned: Vec<[f32; 3]> = sheet(3, 200.0, [0.0, 14.0], [0.0, 9.0], |_, _| 5.0)
            .iter()
            .map(|p| {
                let [x, y, z] = p.map(f64::from);
                [x * cos - y * sin, x * sin + y * cos, z].map(|v| v as f32)
            })
            .collect();
        let planes = roof_planes(&turned, &RoofPlaneParams::default(), &Control::none()).unwrap();
        assert_eq!(planes.len(), 1);
        // cells at the edge are chance: a twentieth of 126 m²
        assert!((planes[0].area - 126.0).abs() < 6.3, "{turn}: {}", planes[0].area);
    }
}

/// A flat roof of 12 m by 9 m with a parapet 0.5 m high and 0.4 m wide around it, and two chimneys of 1.2 m.
fn flat_roof() -> Vec<[f32; 3]> {
    let chimneys = [[3.0, 3.0], [8.0, 5.5]];
    sheet(6, 12.0, [0.0, 12.0], [0.0, 9.0], |x, y| {
        let is_parapet = !(0.4..=11.6).contains(&x) || !(0.4..=8.6).contains(&y);
        let is_chimney = chimneys.iter().any(|[cx, cy]| (x - cx).abs() < 0.6 && (y - cy).abs() < 0.6);
        match (is_parapet, is_chimney) {
            (true, _) => 5.5,
            (_, true) => 6.2,
            _ => 5.0,
        }
    })
}

#[test]
fn no_panel_lies_on_chimneys_parapets_or_beyond_an_edge() {
    let planes = roof_planes(&flat_roof(), &RoofPlaneParams::default().with_cell(0.5), &Control::none()).unwrap();
    let flat = &planes[0];
    assert!((flat.middle[2] - 5.0).abs() < 0.01, "{:?}", flat.middle);
    for (middle, _) in flat.cells.middles() {
        let [x, y, _] = middle;
        assert!((0.4..11.6).contains(&x) && (0.4..8.6).contains(&y), "on the parapet: {middle:?}");
        for [cx, cy] in [[3.0, 3.0], [8.0, 5.5]] {
            // the edge of a chimney is known to the distance between points, 0.29 m
            assert!((x - cx).abs() > 0.31 || (y - cy).abs() > 0.31, "on a chimney: {middle:?}");
        }
    }
    // of 11.2 m x 8.2 m less two chimneys; cells of half a metre beside something that stands are lost, a third of a
    // metre on the mean
    let free = 11.2 * 8.2 - 2.0 * 1.44;
    let lost = 0.35 * (2.0 * (11.2 + 8.2) + 2.0 * 4.8);
    assert!(flat.panel_area() < free && flat.panel_area() > free - 1.5 * lost, "{} of {free}", flat.panel_area());
}

#[test]
fn cells_cover_the_area_of_a_plain_roof() {
    for density in [4.0, 12.0, 40.0] {
        for plane in roof_planes(&house(density), &RoofPlaneParams::default(), &Control::none()).unwrap() {
            // middles of cells of a metre in and out of planes 5 m wide, whose points end half their distance before
            // the edge
            let ratio = plane.panel_area() / plane.area;
            assert!((0.75..1.15).contains(&ratio), "{density}: {} {}", plane.panel_area(), plane.area);
        }
    }
}

#[test]
fn crowns_and_walls_are_no_roofs() {
    let crown: Vec<[f32; 3]> =
        (0..3000).map(|i| [0, 1, 2].map(|axis| (6.0 * uniform(9, 3 * i + axis)) as f32)).collect();
    let planes = roof_planes(&crown, &RoofPlaneParams::default(), &Control::none()).unwrap();
    let area: f64 = planes.iter().map(|plane| plane.area).sum();
    // chance makes no plane of 6 m by 6 m
    assert!(area < 10.0, "{area} m² in {} planes", planes.len());
    let wall: Vec<[f32; 3]> =
        sheet(4, 12.0, [0.0, 10.0], [0.0, 6.0], |_, _| 0.0).iter().map(|p| [p[0], p[2], p[1]]).collect();
    assert!(roof_planes(&wall, &RoofPlaneParams::default(), &Control::none()).unwrap().is_empty());
    assert!(roof_planes(&[], &RoofPlaneParams::default(), &Control::none()).unwrap().is_empty());
    assert!(roof_planes(&[[1.0, 2.0, 3.0]; 50], &RoofPlaneParams::default(), &Control::none()).unwrap().is_empty());
}

#[test]
fn roofs_are_found_by_class_or_by_height() {
    let mut positions = sheet(5, 4.0, [-10.0, 40.0], [-10.0, 20.0], |_, _| 0.0);
    let ground_count = positions.len();
    positions.extend(house(4.0));
    let grid = MapGrid::covering([-10.0, -10.0], [40.0, 20.0], 1.0, [0.0, 0.0]).unwrap();
    let ground = Ground::of_points(&positions[..ground_count], grid, 60.0, &Control::none()).unwrap();
    let classed = |class: u8| {
        let of_point = |i: usize| if i < ground_count { 2 } else { class };
        let classification = Some((0..positions.len()).map(of_point).collect());
        let attributes = Attributes { classification, ..Attributes::default() };
        PointCloud { positions: positions.clone(), attributes, ..PointCloud::default() }
    };
    let (rows, from) = roof_points(&classed(6), &ground).unwrap();
    assert_eq!((rows.len(), from), (positions.len() - ground_count, RoofsFrom::Class));
    let (rows, from) = roof_points(&classed(1), &ground).unwrap();
    assert_eq!((rows.len(), from), (positions.len() - ground_count, RoofsFrom::Height));
    assert!(roof_points(&classed(5), &ground).is_err(), "trees");
}

#[test]
fn parameters_out_of_range_are_refused() {
    let usual = RoofPlaneParams::default();
    for params in [
        usual.with_distance(0.0),
        usual.with_reach(f64::NAN),
        usual.with_cell(-1.0),
        // would be 10^18 cells a square metre
        usual.with_cell(1e-9),
        usual.with_angle(2.0),
        usual.with_min_area(f64::NAN),
    ] {
        assert!(roof_planes(&house(4.0), &params, &Control::none()).is_err(), "{params:?}");
    }
}

#[test]
fn the_extent_of_a_plane_has_its_area_and_no_holes_of_chimneys() {
    for density in [4.0, 12.0, 40.0] {
        for plane in roof_planes(&house(density), &RoofPlaneParams::default(), &Control::none()).unwrap() {
            let area = plane.extent.count() as f64 * plane.extent.cell.powi(2);
            // squares at the outline reach over it by chance: a tenth of small planes
            assert!((area / plane.area - 1.0).abs() < 0.12, "{density}: {area} of {} m²", plane.area);
            assert!(plane.panel_area() < area);
        }
    }
    let planes = roof_planes(&flat_roof(), &RoofPlaneParams::default(), &Control::none()).unwrap();
    let outlines = outlines(&planes[0].extent.filled);
    assert_eq!((outlines.len(), outlines[0].holes.len()), (1, 0), "{outlines:?}");
}

#[test]
fn a_level_plane_faces_nowhere() {
    let planes = roof_planes(&house(12.0), &RoofPlaneParams::default(), &Control::none()).unwrap();
    assert_eq!(planes.iter().map(|plane| plane.azimuth().is_some()).collect::<Vec<_>>(), [true, true, false]);
    // three degrees are a slope, which is seen in its normals
    let slope = 3f64.to_radians().tan();
    let sloped = sheet(4, 20.0, [0.0, 12.0], [0.0, 9.0], |x, _| 5.0 + slope * x);
    let planes = roof_planes(&sloped, &RoofPlaneParams::default(), &Control::none()).unwrap();
    assert!((planes[0].azimuth().unwrap().to_degrees() - 270.0).abs() < 5.0, "{:?}", planes[0].azimuth());
}

#[test]
fn the_horizon_of_a_roof_is_that_of_a_cell_with_nothing_above() {
    let planes = roof_planes(
        &sheet(5, 12.0, [0.0, 12.0], [0.0, 8.0], |_, _| 5.0),
        &RoofPlaneParams::default(),
        &Control::none(),
    );
    let planes = planes.unwrap();
    let under = |center: [f32; 3], radius: f32| {
        let (centers, radii) = (vec![center], vec![radius]);
        let balls = MedialBalls { centers, radii, source: vec![0], touch: vec![0], separation_angles: vec![1.0] };
        let scene = MedialScene::new(&balls, &BlockRule::default()).unwrap();
        let (place, is_open) = horizon_places(&planes, &scene)[0];
        let eyes = [place.map(f64::from)];
        let skyline = horizons(&scene, &eyes, &HorizonParams::default(), &Control::none()).unwrap().remove(0);
        let is_closed = skyline.iter().all(|point| point.elevation >= FRAC_PI_2);
        (place, is_open, is_closed)
    };
    // a crown above the middle of the roof: no ball holds the middle, yet it sees no zenith
    let (place, is_open, is_closed) = under([6.0, 4.0, 8.5], 1.5);
    let away = f64::from(place[0] - 6.0).hypot(f64::from(place[1] - 4.0));
    assert!(is_open && !is_closed && away > 1.5 && away < 4.0, "{place:?}");
    let (_, is_open, is_closed) = under([6.0, 4.0, 40.0], 20.0);
    assert!(!is_open && is_closed, "a crown above all of it");
}
