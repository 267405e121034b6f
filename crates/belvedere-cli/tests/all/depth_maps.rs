//! Depth maps in every format, with depths that can be worked out by hand.
#![expect(clippy::unwrap_used, clippy::panic, reason = "tests stop at the first surprise")]

use crate::common::{EAST, NORTH, Workplace, house};
use std::fs::File;
use tiff::decoder::{Decoder, DecodingResult};
use tiff::tags::Tag;

/// Looks straight down from 20 m at 30 m by 20 m around the house, 4 pixels a metre: 120 by 80 pixels.
const FROM_ABOVE: &str = "84985,446010,20 30,0,0 0,-20,0 4";
const NO_BALL: u32 = u32::MAX;

struct Tif {
    size: (u32, u32),
    values: DecodingResult,
    nodata: String,
    /// West and north edge of the picture and the size of a pixel, where it lies on the map.
    place: Option<([f64; 2], [f64; 2])>,
}

fn tif(place: &Workplace, name: &str) -> Tif {
    let mut decoder = Decoder::new(File::open(place.path(name)).unwrap()).unwrap();
    let nodata = decoder.get_tag_ascii_string(Tag::GdalNodata).unwrap();
    let scale = decoder.get_tag_f64_vec(Tag::ModelPixelScaleTag).ok();
    let tie = decoder.get_tag_f64_vec(Tag::ModelTiepointTag).ok();
    let on_map = scale.zip(tie).map(|(scale, tie)| ([tie[3], tie[4]], [scale[0], scale[1]]));
    let size = decoder.dimensions().unwrap();
    Tif { size, values: decoder.read_image().unwrap(), nodata, place: on_map }
}

fn floats(tif: &Tif) -> &[f32] {
    match &tif.values {
        DecodingResult::F32(values) => values,
        _ => panic!("not f32"),
    }
}

/// Value at a place relative to the middle of the house, in a picture of [`FROM_ABOVE`].
fn seen_at<T: Copy>(values: &[T], x: f64, y: f64) -> T {
    let (column, row) = ((x + 15.0) * 4.0, (10.0 - y) * 4.0);
    assert!((0.0..120.0).contains(&column) && (0.0..80.0).contains(&row));
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the picture")]
    values[row as usize * 120 + column as usize]
}

#[test]
fn depths_from_above_are_heights_below_the_plane() {
    let place = Workplace::with_house();
    let summary = place.summary_with("depth-map house.laz -o depth.npy --viewport", &[FROM_ABOVE]);
    assert_eq!((&summary["view"]["width_px"], &summary["view"]["height_px"]), (&120.into(), &80.into()));
    let (shape, depth) = place.npy::<f32>("depth.npy");
    assert_eq!(shape, [80, 120], "rows, columns");
    for (x, y, expected, tolerance) in [
        // the ground is rough by 0.08 m
        (10.125, 5.125, 20.0, 0.2),
        (-12.125, -8.125, 20.0, 0.2),
        // 0.05 m that a point may lie in a ball, and as much for the sag of balls between points half a metre apart;
        // the roof drops 0.75 m a metre from a ridge of 9 m
        (0.125, 2.125, 20.0 - (9.0 - 0.75 * 2.125), 0.1),
        (3.125, -3.125, 20.0 - (9.0 - 0.75 * 3.125), 0.1),
    ] {
        let found = f64::from(seen_at(&depth, x, y));
        assert!((found - expected).abs() < tolerance, "{found} for {expected} at {x}, {y}");
    }
}

#[test]
fn a_tif_of_a_view_straight_down_lies_on_the_map() {
    let place = Workplace::with_house();
    place.summary_with("depth-map house.laz -o depth.npy --viewport", &[FROM_ABOVE]);
    place.summary_with("depth-map house.laz -o depth.tif --ball-ids ids.tif --viewport", &[FROM_ABOVE]);
    let depth = tif(&place, "depth.tif");
    assert_eq!((depth.size, depth.nodata.as_str()), ((120, 80), "-9999"));
    assert_eq!(depth.place, Some(([EAST - 15.0, NORTH + 10.0], [0.25, 0.25])));
    let (_, expected) = place.npy::<f32>("depth.npy");
    let expected: Vec<f32> = expected.into_iter().map(|v| if v.is_finite() { v } else { -9999.0 }).collect();
    assert_eq!(floats(&depth), expected);
    let ids = tif(&place, "ids.tif");
    assert_eq!((ids.place, ids.nodata.as_str()), (depth.place, "4294967295"));
    // north up without a viewport too
    let summary = place.summary("depth-map house.laz -o down.tif --direction 0,0,-1 --pixel 0.5");
    assert_eq!(tif(&place, "down.tif").place, Some(([EAST - 15.0, NORTH + 15.0], [0.5, 0.5])));
    assert_eq!(summary["view"]["pixel_m"], 0.5);
    // seen from the sun there is no place on the map
    place.summary("depth-map house.laz -o oblique.tif --sun 180,30");
    assert_eq!(tif(&place, "oblique.tif").place, None);
}

#[test]
fn the_item_buffer_names_rows_of_the_ball_file() {
    let place = Workplace::with_house();
    // but for the balls that rules add, every ball touches its point
    place.summary("balls house.laz --without relief,slender,crowns,planes -o balls.npz");
    let centers: Vec<f32> = place.npz("balls.npz", "centers");
    let radii: Vec<f32> = place.npz("balls.npz", "radii");
    let origin: Vec<f64> = place.npz("balls.npz", "origin");
    place.summary_with("depth-map balls.npz -o depth.npy --ball-ids ids.npy --viewport", &[FROM_ABOVE]);
    let ((shape, ids), (_, depth)) = (place.npy::<u32>("ids.npy"), place.npy::<f32>("depth.npy"));
    assert_eq!(shape, [80, 120]);
    for (row, (&id, &depth)) in ids.iter().zip(&depth).enumerate() {
        assert_eq!(id == NO_BALL, depth.is_infinite());
        if id == NO_BALL {
            continue;
        }
        let i = id as usize;
        let pixel = [(row % 120) as f64 * 0.25 + 0.125 - 15.0, 10.0 - ((row / 120) as f64 * 0.25 + 0.125)];
        let center: [f64; 3] =
            std::array::from_fn(|k| f64::from(centers[3 * i + k]) + origin[k] - [EAST, NORTH, 0.0][k]);
        let (dx, dy) = (pixel[0] - center[0], pixel[1] - center[1]);
        let half_chord = (f64::from(radii[i]).powi(2) - dx * dx - dy * dy).max(0.0).sqrt();
        let expected = 20.0 - (center[2] + half_chord);
        // the root near the outline of a ball magnifies the rounding of f32
        assert!((expected - f64::from(depth)).abs() < 0.01, "ball {id}: {depth} for {expected}");
    }
    // a cloud names the rows of the ball file it would give
    place.summary("balls house.laz -o all.npz");
    place.summary_with("depth-map all.npz -o depth.npy --ball-ids ids.npy --viewport", &[FROM_ABOVE]);
    place.summary_with("depth-map house.laz -o cloud.npy --ball-ids cloud-ids.npy --viewport", &[FROM_ABOVE]);
    assert_eq!(place.bytes("ids.npy"), place.bytes("cloud-ids.npy"));
    assert_eq!(place.bytes("depth.npy"), place.bytes("cloud.npy"));
}

#[test]
fn the_rows_that_balls_come_from_are_rows_of_the_file() {
    let place = Workplace::new();
    let mut cloud = house();
    // noise first, so that cleaning moves all other points up
    let all: Vec<u32> = (0..3).chain(0..u32::try_from(cloud.len()).unwrap()).collect();
    cloud = cloud.select(&all);
    cloud.attributes.classification = Some((0..cloud.len()).map(|i| if i < 3 { 7 } else { 6 }).collect());
    place.write_cloud("house.laz", &cloud);
    // but for the balls that rules add, every ball touches its point
    place.summary("balls house.laz --without relief,slender,crowns,planes -o balls.npz");
    let centers: Vec<f32> = place.npz("balls.npz", "centers");
    let radii: Vec<f32> = place.npz("balls.npz", "radii");
    let origin: Vec<f64> = place.npz("balls.npz", "origin");
    for (i, source) in place.npz::<u32>("balls.npz", "source").into_iter().enumerate() {
        assert!(source >= 3);
        let point = cloud.frame.to_file_coordinates(cloud.positions[source as usize]);
        let square: f64 = (0..3).map(|k| (f64::from(centers[3 * i + k]) + origin[k] - point[k]).powi(2)).sum();
        // a millimetre is the step of the file
        assert!((square.sqrt() - f64::from(radii[i])).abs() < 2e-3, "ball {i}");
    }
}

#[test]
fn a_picture_is_a_png_whether_something_is_hit_or_not() {
    let place = Workplace::with_house();
    let summary = place.summary("depth-map house.laz -o sun.png --sun 160,35");
    let hit = summary["pixels_hit_percent"].as_f64().unwrap();
    assert!(hit > 30.0, "{hit}");
    // looks up into the sky from above the house
    let up = "84985,446010,20 0,20,0 30,0,0 4";
    let summary = place.summary_with("depth-map house.laz -o sky.png --ball-ids sky.npy --viewport", &[up]);
    assert_eq!(summary["view"]["view_direction"].as_array().unwrap()[2].as_f64(), Some(-1.0));
    let away = "84985,446010,20 30,0,0 0,20,0 4";
    let summary = place.summary_with("depth-map house.laz -o sky.png --ball-ids sky.npy --viewport", &[away]);
    assert_eq!(summary["view"]["view_direction"].as_array().unwrap()[2].as_f64(), Some(1.0));
    assert_eq!(summary["pixels_hit_percent"], 0.0);
    assert!(place.npy::<u32>("sky.npy").1.iter().all(|&id| id == NO_BALL));
    for name in ["sun.png", "sky.png"] {
        assert!(place.bytes(name).starts_with(b"\x89PNG\r\n\x1a\n"), "{name}");
    }
}

#[test]
fn negative_numbers_are_numbers_and_not_flags() {
    let place = Workplace::with_house();
    place.summary("depth-map house.laz -o a.npy --direction -1,-1,-1");
    place.summary("depth-map house.laz -o b.npy --direction=-1,-1,-1");
    place.summary("depth-map house.laz -o c.npy --sun -90,30");
    place.summary("depth-map house.laz -o d.npy --sun 270,30");
    assert_eq!(place.bytes("a.npy"), place.bytes("b.npy"));
    // sine and cosine of -90 and 270 degrees differ in the last bit
    let [c, d] = ["c.npy", "d.npy"].map(|name| place.npy::<f32>(name));
    assert_eq!(c.0, d.0);
    place.summary_with("depth-map house.laz -o e.npy --viewport", &["-1,-1,-1 -30,0,0 0,-20,0 4"]);
    assert_eq!(place.npy::<f32>("e.npy").0, [80, 120]);
}

#[test]
fn the_cone_of_the_paper_lies_behind_the_sphere() {
    let place = Workplace::with_house();
    let depths = ["sphere", "paper-cone"].map(|profile| {
        place.summary_with(&format!("depth-map house.laz --ball-profile {profile} -o d.npy --viewport"), &[FROM_ABOVE]);
        place.npy::<f32>("d.npy").1
    });
    let [sphere, cone] = depths;
    assert_ne!(sphere, cone);
    let nearer = sphere.iter().zip(&cone).filter(|(s, c)| **c < **s - 0.2).count();
    // moved to the middle of a pixel, a cone may stand out at the border of what is seen
    assert!(nearer * 50 < sphere.len(), "{nearer} of {}", sphere.len());
    let farther = sphere.iter().zip(&cone).filter(|(s, c)| c > s).count();
    assert!(farther * 2 > sphere.len(), "{farther} of {}", sphere.len());
}

/// South of the house at the height of its middle, looking north at the wall 16 m away.
fn camera(size: &str) -> String {
    format!("--eye {EAST},{},3 --look-at {EAST},{NORTH},3 --fov 60 --size {size}", NORTH - 20.0)
}

#[test]
fn a_camera_sees_a_wall_at_its_depth_wherever_it_looks_at_it() {
    let place = Workplace::with_house();
    // patches of walls have no balls
    place.summary("balls house.laz --without planes -o balls.npz");
    let summary = place.summary(&format!("depth-map balls.npz -o depth.npy --ball-ids ids.npy {}", camera("160x120")));
    assert_eq!(summary["balls_around_eye_ignored"], 0);
    let ((shape, depth), (_, ids)) = (place.npy::<f32>("depth.npy"), place.npy::<u32>("ids.npy"));
    assert_eq!(shape, [120, 160]);
    let focal = 80.0 / 30f64.to_radians().tan();
    let at = |x: f64, z: f64| {
        let (column, row) = (80.0 + focal * x / 16.0, 60.0 - focal * (z - 3.0) / 16.0);
        assert!((0.0..160.0).contains(&column) && (0.0..120.0).contains(&row));
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the picture")]
        let pixel = row as usize * 160 + column as usize;
        (f64::from(depth[pixel]), ids[pixel])
    };
    for (x, z) in [(0.0, 3.0), (-4.0, 1.5), (4.0, 5.0), (2.0, 4.0)] {
        // depth runs along the axis: the same over all of the wall; 0.05 m that a point may lie in a ball, and the sag
        // of balls between points half a metre apart
        assert!((at(x, z).0 - 16.0).abs() < 0.15, "{:?} at {x}, {z}", at(x, z));
        assert_ne!(at(x, z).1, NO_BALL);
    }
    // beside the house and above its ridge, 9 m high and 4 m behind the wall, there is sky
    for (x, z) in [(7.0, 5.0), (0.0, 8.2)] {
        assert_eq!(at(x, z), (f64::INFINITY, NO_BALL));
    }
    // beyond the limits nothing is seen
    let summary = place.summary(&format!("depth-map house.laz -o far.npy --far 10 --near 5 {}", camera("160x120")));
    assert!(summary["pixels_hit_percent"].as_f64().unwrap() < 20.0);
    assert!(place.npy::<f32>("far.npy").1.iter().all(|d| (5.0..=10.0).contains(d) || d.is_infinite()));
}

#[test]
fn a_panorama_has_north_in_the_middle_and_the_horizon_half_way_down() {
    let place = Workplace::with_house();
    let eye = format!("--panorama {EAST},{},3", NORTH - 20.0);
    let summary = place.summary(&format!("depth-map house.laz -o range.npy {eye} --size 360"));
    assert_eq!((&summary["view"]["width_px"], &summary["view"]["height_px"]), (&360.into(), &180.into()));
    let (shape, range) = place.npy::<f32>("range.npy");
    assert_eq!(shape, [180, 360]);
    let at = |azimuth: usize, below_zenith: usize| f64::from(range[below_zenith * 360 + (azimuth + 180) % 360]);
    // half a degree off the middle of a pixel, 0.14 m on the wall; the wall as above
    assert!((at(0, 90) - 16.0).abs() < 0.15, "{}", at(0, 90));
    assert!((at(10, 90) - 16.0 / 10.5f64.to_radians().cos()).abs() < 0.2, "{}", at(10, 90));
    // west and up is sky, straight down the ground 3 m below, which ends 15 m around the house
    assert_eq!((at(270, 80), at(0, 10)), (f64::INFINITY, f64::INFINITY));
    let down = 10f64.to_radians();
    assert!((at(45, 179) - 3.0).abs() < 0.2 || at(45, 179).is_infinite());
    assert!((at(0, 100) - 3.0 / down.sin()).abs() < 1.5, "{}", at(0, 100));
    for name in ["all-around.png", "all-around.tif"] {
        place.summary(&format!("depth-map house.laz -o {name} {eye} --size 200x100"));
    }
    assert_eq!(tif(&place, "all-around.tif").size, (200, 100));
    place.summary(&format!("depth-map house.laz -o camera.png {}", camera("100x80")));
    for name in ["all-around.png", "camera.png"] {
        assert!(place.bytes(name).starts_with(b"\x89PNG\r\n\x1a\n"), "{name}");
    }
}

#[test]
fn an_eye_within_a_ball_is_reported_and_sees() {
    let place = Workplace::with_house();
    let inside = format!("--eye {EAST},{NORTH},3 --look-at {},{NORTH},3 --size 40x30", EAST + 1.0);
    place.summary("balls house.laz --method tau --max-radius 5 -o balls.npz");
    let summary = place.summary(&format!("depth-map balls.npz -o depth.npy {inside}"));
    assert!(summary["balls_around_eye_ignored"].as_u64().unwrap() > 0, "{summary}");
}

#[test]
fn views_from_an_eye_that_make_no_sense_are_wrong_usage() {
    let place = Workplace::with_house();
    let eye = format!("--eye {EAST},{NORTH},30");
    let look = format!("{eye} --look-at {EAST},{NORTH},0");
    for (flags, words) in [
        (eye.clone(), vec!["--look-at"]),
        (format!("--look-at {EAST},{NORTH},0 --sun 180,30"), vec!["--look-at", "--sun"]),
        (format!("--look-at {EAST},{NORTH},0"), vec!["--eye"]),
        (format!("{eye} --look-at {EAST},{NORTH},30"), vec!["--look-at", "different from the eye"]),
        (format!("{look} --fov 180"), vec!["--fov", "175"]),
        (format!("{look} --size 100"), vec!["--size", "1280x720"]),
        (format!("{look} --size 0x5"), vec!["--size"]),
        (format!("{look} --size 100000x100000"), vec!["--size", "pixels"]),
        (format!("{look} --near 5 --far 4"), vec!["--near", "far"]),
        (format!("{look} --pixel 0.5"), vec!["--pixel"]),
        (format!("{look} --ball-profile paper-cone"), vec!["--ball-profile", "parallel"]),
        (format!("--panorama {EAST},{NORTH},30 --size 100x80"), vec!["--size", "twice"]),
        (format!("--panorama {EAST},{NORTH},30 --fov 80"), vec!["--fov"]),
        (format!("--panorama {EAST},{NORTH},30 --ball-profile paper-cone"), vec!["--ball-profile", "parallel"]),
        (format!("{look} --sun 180,30"), vec!["--sun"]),
        ("--sun 180,30 --size 100x80".to_owned(), vec!["--size"]),
    ] {
        place.refusal(2, &format!("depth-map house.laz -o out.png {flags}"), &words);
    }
    assert!(!place.path("out.png").exists());
}
