//! Do certified maps answer as exact lines of sight do, what share of the targets do they settle, and how fast are
//! they?
//!
//!     belvedere demo -o demo
//!     cargo research certified -- demo/balls.npz [TARGETS]
//!
//! Ten million targets by default, spread evenly over the box of the balls' points, by three projections; exit status 1
//! if one answer differs.
#![allow(clippy::print_stdout, reason = "the table is what this example is for")]

use belvedere::Bounds;
use belvedere::control::Control;
use belvedere::depth::{ItemBuffer, Profile, depth_map};
use belvedere::io::read_balls;
use belvedere::model::SceneModel;
use belvedere::query::certified::CertifiedMap;
use belvedere::query::{Answer, BlockRule, Scope, UnprovenAs, Viewer, Visibility, random_targets};
use belvedere::view::{View, to_sun};
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

/// Targets queried at once, to bound memory.
const BATCH: usize = 1_000_000;

fn main() -> Result<ExitCode, Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().ok_or("name a ball file")?;
    let count: usize = arguments.next().map_or(Ok(10_000_000), |n| n.parse())?;
    let model = SceneModel::from_parts(read_balls(Path::new(&path))?)?;
    let Bounds { low, high } = model.bounds();
    let balls = model.balls();
    let scene = model.scene(&BlockRule::carved(), UnprovenAs::Visible, &Control::none())?;
    println!("{} balls, {count} targets", scene.ball_count());
    let [l, h] = [low, high].map(|corner| corner.map(f64::from));
    let middle: [f64; 3] = std::array::from_fn(|i| (l[i] + h[i]) / 2.0);
    let sun = to_sun(235f64.to_radians(), 30f64.to_radians());
    // an eye above the roofs at a corner, for which no pixel is wider than the 0.25 m of the parallel view anywhere in
    // the scene
    let corner = [l[0], l[1], h[2] + 10.0];
    let distance = (0..3).map(|i| (if i == 2 { l[i] } else { h[i] } - corner[i]).powi(2)).sum::<f64>().sqrt();
    let width = (4.0 * distance * 2.0 * 0.7f64.tan()).round();
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a picture of some thousand pixels")]
    let width = width as usize;
    let camera = View::perspective(corner, middle, 1.4, [width, width * 3 / 4], 0.0, f64::INFINITY)?;
    let extent = (h[0] - l[0]).max(h[1] - l[1]);
    // pixels of 0.25 m at the axis, half the extent away, and half as wide at the horizon
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a picture of some thousand pixels")]
    let sphere = (4.0 * extent).round().max(16.0) as usize * 2;
    let street = [middle[0], middle[1], l[2] + 1.7];
    println!(
        "| view | pixels | depth map | bounds | settled | certified | lines of sight | differ |\n|---|---|---|---|---|---|---|---|"
    );
    let mut differ_in_all = 0;
    for (name, views) in [
        ("sun, 0.25 m", vec![View::parallel(sun.map(|v| -v), l, h, 0.25)?]),
        ("camera over a corner", vec![camera]),
        ("sphere over the middle", View::panorama([middle[0], middle[1], h[2] + 5.0], sphere)?.to_vec()),
        ("sphere near the ground", View::panorama(street, sphere)?.to_vec()),
    ] {
        let viewer = match views[0].is_central() {
            true => Viewer::Eye(views[0].frame.eye),
            false => Viewer::Direction(sun),
        };
        let start = Instant::now();
        let map = CertifiedMap::new(&scene, &views, Scope::Viewer, &Control::none())?;
        let drawn = start.elapsed();
        let start = Instant::now();
        for view in &views {
            depth_map(balls, view, Profile::Sphere, ItemBuffer::Without, &Control::none())?;
        }
        let plain = start.elapsed();
        let (mut settled, mut differ, mut visible, mut queried) = (0, 0, 0, 0);
        let (mut by_map, mut by_rays) = (0.0, 0.0);
        while queried < count {
            let seed = u64::try_from(queried)?;
            let targets = random_targets(low, high, BATCH.min(count - queried), seed);
            let start = Instant::now();
            let (answers, report) = map.answers(&targets, &Control::none())?;
            by_map += start.elapsed().as_secs_f64();
            let start = Instant::now();
            let exact = scene.visible(viewer, &targets)?;
            by_rays += start.elapsed().as_secs_f64();
            settled += report.settled_count;
            differ += answers.iter().zip(&exact).filter(|(a, b)| a != b).count();
            visible += exact.iter().filter(|&&a| a == Answer::Visible).count();
            queried += targets.len();
        }
        let percent = |n: usize| 100.0 * n as f64 / count as f64;
        let pixels: usize = views.iter().map(|v| v.size_px[0] * v.size_px[1]).sum();
        println!(
            "| {name} ({:.0} % visible) | {pixels} | {:.2} s | {:.2} s | {:.1} % | {by_map:.2} s | {by_rays:.2} s | {differ} |",
            percent(visible),
            plain.as_secs_f64(),
            drawn.as_secs_f64(),
            percent(settled),
        );
        differ_in_all += differ;
    }
    Ok(if differ_in_all == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
