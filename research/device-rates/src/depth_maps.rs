//! Depth maps of the same balls: how long each takes, how far it differs from the CPU's, and how many pixels the CPU
//! draws again.

use belvedere::control::Control;
use belvedere::depth::{BoundsParams, DepthBounds, DepthMap, ItemBuffer, Profile, depth_bounds, depth_map};
use belvedere::medial::MedialBalls;
use belvedere::query::{Backend, BallTree, BlockRule};
use belvedere::view::View;
use belvedere_data::Result;
use belvedere_gpu::{Choice, DeviceInfo, Gpu};
use std::sync::Arc;
use std::time::Instant;

fn best_of<T>(times: usize, mut work: impl FnMut() -> Result<T>) -> Result<(T, f64)> {
    let (mut best, mut last) = (f64::INFINITY, work()?);
    for _ in 0..times {
        let start = Instant::now();
        last = work()?;
        best = best.min(start.elapsed().as_secs_f64());
    }
    Ok((last, best))
}

/// Percent of pixels that some ball certainly covers.
fn percent_bounded(bounds: &DepthBounds) -> f64 {
    let pixels = bounds.bounds.values();
    100.0 * pixels.iter().filter(|[_, upper]| upper.is_finite()).count() as f64 / pixels.len() as f64
}

/// Views of a place of so many metres, in pictures of so many pixels on a side.
fn views(side: f64, pixels: usize) -> Result<Vec<(&'static str, View)>> {
    let (low, high) = ([0.0, 0.0, -4.0], [side, side, 18.0]);
    let middle = [0.5 * side, 0.5 * side, 4.0];
    let pixel = side / (pixels as f64 - 0.5);
    let corner = [-0.1 * side, -0.1 * side, 0.2 * side];
    Ok(vec![
        ("a plan", View::parallel([0.0, 0.0, -1.0], low, high, pixel)?),
        ("a camera above a corner", View::perspective(corner, middle, 1.0, [pixels; 2], 0.0, f64::INFINITY)?),
        ("a hemisphere from the middle", View::hemisphere([middle[0], middle[1], 1.6], [0.0, 0.0, 1.0], pixels)?),
    ])
}

/// The largest difference of depths as a share of the depth; without end where one map is empty and the other is not,
/// or the balls differ.
fn largest_difference(drawn: &DepthMap, expected: &DepthMap) -> f64 {
    if drawn.balls != expected.balls {
        return f64::INFINITY;
    }
    let of_pixel = |(&drawn, &expected): (&f32, &f32)| {
        let [drawn, expected] = [drawn, expected].map(f64::from);
        if drawn == expected { 0.0 } else { (drawn - expected).abs() / expected }
    };
    drawn.depth.values().iter().zip(expected.depth.values()).map(of_pixel).fold(0.0, f64::max)
}

/// Draws every kind of view on a device and on the CPU, and says what that took.
pub(crate) fn measure(
    info: &DeviceInfo,
    balls: &MedialBalls,
    side: f64,
    pixels: usize,
    say: &mut dyn FnMut(String),
) -> Result<()> {
    let control = Control::none();
    let tree = Arc::new(BallTree::new(balls, &BlockRule { shell: 0.0, ..BlockRule::default() })?);
    for (name, view) in views(side, pixels)? {
        let [width, height] = view.size_px;
        let gpu = Gpu::new(Choice::Number(info.number))?;
        let Some(drawable) = gpu.drawable(balls, pixels * pixels, &control)? else {
            say(format!("{} draws nothing: {:?}", info.name, gpu.notes()));
            return Ok(());
        };
        for items in [ItemBuffer::Without, ItemBuffer::With] {
            let (drawn, on_device) = best_of(3, || drawable.depth_map(&view, items, &control))?;
            let (expected, on_cpu) = best_of(1, || depth_map(balls, &view, Profile::Sphere, items, &control))?;
            say(format!(
                "{name}, {width} x {height}, {items:?} balls of pixels: {:.1} ms with all transfers, CPU {:.1} ms; depths differ by {:.1e}, \
                 {:.2} % of pixels drawn again",
                1e3 * on_device,
                1e3 * on_cpu,
                largest_difference(&drawn, &expected),
                100.0 * gpu.redone_share(),
            ));
        }
        let (of_device, on_device) = best_of(1, || gpu.prepare(&tree)?.depth(&view, 0.0, &control))?;
        let of_cpu = || depth_bounds(tree.balls(), &view, &BoundsParams::default(), &control);
        let (of_cpu, on_cpu) = best_of(1, of_cpu)?;
        say(format!(
            "{name}, bounds of certified maps: {:.1} ms, CPU {:.1} ms; {:.2} % of pixels have an upper bound, {:.2} % by the CPU",
            1e3 * on_device,
            1e3 * on_cpu,
            percent_bounded(&of_device),
            percent_bounded(&of_cpu)
        ));
        for note in gpu.notes() {
            say(note);
        }
    }
    Ok(())
}
