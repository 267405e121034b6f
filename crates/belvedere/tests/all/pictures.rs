//! Pictures: what hides what, what is light, and that threads do not matter.

use belvedere::control::Control;
use std::fs;
use std::io::BufReader;

use belvedere::depth::{ItemBuffer, Profile, depth_map};
use belvedere::figures::{Canvas, Colors, Picture, depth_picture, side_by_side, write_png};
use belvedere::medial::MedialBalls;
use belvedere::raster::Raster;
use belvedere::view::View;
use tempfile::TempDir;

/// Looks straight down on the square from (0, 0) to (`side`, `side`).
fn plan_view(side: f64, pixel: f64) -> View {
    View::parallel([0.0, 0.0, -1.0], [0.0, 0.0, 0.0], [side, side, 10.0], pixel).unwrap()
}

/// Draws balls by way of the depth map of `view`.
fn draw_balls(canvas: &mut Canvas, view: &View, centers: &[[f32; 3]], radii: &[f32], colors: Colors<'_>) {
    let balls = MedialBalls {
        centers: centers.to_vec(),
        radii: radii.to_vec(),
        source: vec![0; radii.len()],
        touch: vec![0; radii.len()],
        separation_angles: vec![1.0; radii.len()],
    };
    let map = depth_map(&balls, view, Profile::Sphere, ItemBuffer::With, &Control::none()).unwrap();
    let items = map.balls.as_ref().unwrap();
    canvas.draw_seen_balls((&map.depth, items), (centers, radii), colors).unwrap();
}

#[test]
fn nearer_balls_and_points_hide_farther_ones() {
    let view = plan_view(10.0, 0.1);
    let mut canvas = Canvas::new(&view, [255; 3]);
    let (red, green) = ([200, 0, 0], [0, 200, 0]);
    // the second ball lies higher, nearer to a viewer above
    draw_balls(&mut canvas, &view, &[[5.0, 5.0, 2.0], [6.0, 5.0, 6.0]], &[2.0, 1.0], Colors::Each(&[red, green]));
    canvas.draw_points(&[[6.0, 5.0, 1.0], [1.0, 9.0, 0.0]], Colors::One([0, 0, 255]), 3).unwrap();
    let picture = canvas.into_picture();
    let at = |x: f64, y: f64| picture.get((x * 10.0) as usize, ((10.0 - y) * 10.0) as usize).unwrap();
    assert!(at(6.0, 5.0)[1] > 100 && at(6.0, 5.0)[0] == 0, "the near ball hides ball and point");
    assert!(at(4.0, 5.0)[0] > 100 && at(4.0, 5.0)[1] == 0);
    assert_eq!(at(1.0, 9.0), [0, 0, 255]);
    assert_eq!(at(0.5, 0.5), [255; 3]);
    let brightness = |x: f64, y: f64| at(x, y)[0];
    assert!(brightness(4.2, 5.8) > brightness(5.0, 3.3), "lit from the upper left");
    let (depth, items) = (Raster::filled(2, 2, 1.0), Raster::filled(2, 2, 0));
    let other_size =
        Canvas::new(&view, [0; 3]).draw_seen_balls((&depth, &items), (&[[0.0; 3]], &[1.0]), Colors::One(red));
    assert!(other_size.is_err());
}

#[test]
fn drawing_does_not_depend_on_threads() {
    let view = plan_view(20.0, 0.05);
    let centers: Vec<[f32; 3]> =
        (0..5000_u32).map(|i| [(i * 37 % 2000) as f32 * 0.01, (i * 91 % 2000) as f32 * 0.01, 5.0]).collect();
    let radii: Vec<f32> = (0..5000_u16).map(|i| f32::from(i % 50) * 0.01).collect();
    let draw = || {
        let mut canvas = Canvas::new(&view, [255; 3]);
        draw_balls(&mut canvas, &view, &centers, &radii, Colors::One([90, 120, 200]));
        canvas.into_picture()
    };
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap().install(draw);
    assert_eq!(one, draw());
}

#[test]
fn depth_pictures_have_colours_and_a_legend() {
    let folder = TempDir::new().unwrap();
    let values: Vec<f32> = (0..100 * 60).map(|i| if i % 100 > 80 { f32::INFINITY } else { (i % 100) as f32 }).collect();
    let depth = Raster::from_values(100, 60, values).unwrap();
    let picture = depth_picture(&depth, "Depth map");
    assert!(picture.width > 500 && picture.height > 300, "small maps are enlarged");
    let lightness = |c: [u8; 3]| c.iter().map(|&v| u32::from(v)).sum::<u32>();
    let map_row = picture.height / 2;
    let near = picture.get(30, map_row).unwrap();
    let far = picture.get(30 + 70 * 5, map_row).unwrap();
    assert!(lightness(near) > lightness(far), "near is light: {near:?} {far:?}");
    let dark = |columns: std::ops::Range<usize>, rows: std::ops::Range<usize>| {
        rows.flat_map(|r| columns.clone().map(move |c| (c, r)))
            .filter(|&(c, r)| picture.get(c, r).is_some_and(|p| lightness(p) < 150))
            .count()
    };
    assert!(dark(0..200, 0..40) > 50, "title");
    assert!(dark(560..picture.width, 0..picture.height) > 200, "legend");
    let both = side_by_side(&[picture.clone(), Picture::filled(100, 50, [9; 3])], &["left", "right"]);
    assert!(both.width > picture.width && both.height > picture.height);
    let path = folder.path().join("p.png");
    write_png(&path, &both).unwrap();
    let mut reader = png::Decoder::new(BufReader::new(fs::File::open(&path).unwrap())).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    assert_eq!((info.width as usize, info.height as usize), (both.width, both.height));
    assert_eq!(bytes, both.rgb);
    assert!(write_png(&path, &Picture::filled(0, 0, [0; 3])).is_err());
    let nothing = Raster::filled(4, 4, f32::INFINITY);
    assert!(depth_picture(&nothing, "").width > 0);
    assert!(depth_picture(&Raster::filled(1, 1, 5.0), "a title much too long").width > 0);
}
