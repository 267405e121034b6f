//! Depth maps of the same balls: how long each takes, how much work it is, and how far that is from what a data-centre card can do.

use belvedere::control::Control;
use belvedere::depth::{BoundsParams, DepthBounds, ItemBuffer, Profile, depth_bounds, depth_map};
use belvedere::medial::MedialBalls;
use belvedere::query::{Backend, BallTree, BlockRule};
use belvedere::view::View;
use belvedere_data::Result;
use belvedere_gpu::{DeviceInfo, Gpu, Work};
use std::sync::Arc;
use std::time::Instant;

/// Instructions and bytes that the memory of the device moves: those of the shaders in SPIR-V, both sides of each branch and each turn of a loop.
const OF_A_BALL: [f64; 2] = [5900.0, 16.0 + 16.0 + 3.0 * 8.0];
const OF_AN_ENTRY: [f64; 2] = [60.0, 2.0 * 8.0 + 4.0];
const OF_A_LOOK: [f64; 2] = [300.0, 4.0 + 16.0];
const OF_A_TEST: [f64; 2] = [70.0, 0.0];
const OF_AN_EXACT_DEPTH: [f64; 2] = [1600.0, 16.0];
const OF_A_CENTRAL_DEPTH: [f64; 2] = [3300.0, 16.0];
const OF_A_DIRECTION: [f64; 2] = [4600.0, 0.0];
const OF_A_PIXEL: [f64; 2] = [450.0, 8.0];
/// A data-centre card: instructions on whole numbers a second (an H100: 132 groups of 64 at 1.7 GHz), and bytes of memory a second.
const CARD: [f64; 2] = [1.4e13, 3e12];

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

/// Draws every kind of view on a device and on the CPU, and says what that took.
pub(crate) fn measure(
    info: &DeviceInfo,
    balls: &MedialBalls,
    side: f64,
    pixels: usize,
    say: &mut dyn FnMut(String),
) -> Result<()> {
    let control = Control::none();
    let (gpu, counting) = (Gpu::new(belvedere_gpu::Choice::Number(info.number))?, Gpu::counting(info.number)?);
    let start = Instant::now();
    let drawable = gpu.drawable(balls, pixels * pixels, &control)?;
    say(format!(
        "depth maps on {}: {:.3} s to bring {} balls there",
        info.name,
        start.elapsed().as_secs_f64(),
        balls.len()
    ));
    let Some(drawable) = drawable else {
        say(format!("the device draws nothing: {:?}", gpu.notes()));
        return Ok(());
    };
    let tree = Arc::new(BallTree::new(balls, &BlockRule { shell: 0.0, ..BlockRule::default() })?);
    let prepared = gpu.prepare(&tree)?;
    let mut work_before = Work::default();
    for (name, view) in views(side, pixels)? {
        let [width, height] = view.size_px;
        for items in [ItemBuffer::Without, ItemBuffer::With] {
            let (drawn, on_device) = best_of(3, || drawable.depth_map(&view, items, &control))?;
            let start = Instant::now();
            let expected = depth_map(balls, &view, Profile::Sphere, items, &control)?;
            let on_cpu = start.elapsed().as_secs_f64();
            let equal = if drawn == expected { "the same bits" } else { "OTHER BITS" };
            say(format!(
                "{name}, {width} x {height}, {items:?} balls of pixels: {:.1} ms with the picture on its way back, CPU {:.1} ms, {equal}",
                1e3 * on_device,
                1e3 * on_cpu
            ));
        }
        let start = Instant::now();
        let of_cpu = depth_bounds(tree.balls(), &view, &BoundsParams::default(), &control)?;
        let on_cpu = start.elapsed().as_secs_f64();
        let (of_device, on_device) = best_of(1, || prepared.depth(&view, 0.0, &control))?;
        say(format!(
            "{name}, bounds of certified maps: {:.1} ms with the balls on their way there, CPU {:.1} ms; {:.2} % of pixels have an upper bound, {:.2} % by the CPU",
            1e3 * on_device,
            1e3 * on_cpu,
            percent_bounded(&of_device),
            percent_bounded(&of_cpu)
        ));
        if let Some(drawable) = counting.drawable(balls, pixels * pixels, &control)? {
            drawable.depth_map(&view, ItemBuffer::Without, &control)?;
        }
        let total = counting.work();
        say_work(&view, balls.len(), [work_before, total], say);
        work_before = total;
    }
    for note in gpu.notes() {
        say(note);
    }
    Ok(())
}

/// The work of a view: what was counted before and after it.
fn say_work(view: &View, ball_count: usize, [before, after]: [Work; 2], say: &mut dyn FnMut(String)) {
    let count = |of: fn(&Work) -> u64| (of(&after) - of(&before)) as f64;
    let (entries, looks) = (count(|work| work.listed), count(|work| work.looked_at));
    // each ball is tested with the 64 pixels of a block
    let (tests, exact) = (64.0 * count(|work| work.tested), count(|work| work.exact));
    let (balls, pixels) = (ball_count as f64, (view.size_px[0] * view.size_px[1]) as f64);
    let (of_depth, of_pixel) = if view.is_central() {
        (OF_A_CENTRAL_DEPTH, [OF_A_DIRECTION[0] + OF_A_PIXEL[0], OF_A_PIXEL[1]])
    } else {
        (OF_AN_EXACT_DEPTH, OF_A_PIXEL)
    };
    let stages = [
        ("balls placed", balls, OF_A_BALL),
        ("entries of lists", entries, OF_AN_ENTRY),
        ("entries looked at", looks, OF_A_LOOK),
        ("tests of a pixel and a ball", tests, OF_A_TEST),
        ("exact depths", exact, of_depth),
        ("pixels", pixels, of_pixel),
    ];
    let mut sum = [0.0; 2];
    for (name, count, of_one) in stages {
        let cost = of_one.map(|of_one| count * of_one);
        sum = [sum[0] + cost[0], sum[1] + cost[1]];
        say(format!(
            "  {:.2} million {name}: {:.2} billion instructions, {:.3} GB",
            count / 1e6,
            cost[0] / 1e9,
            cost[1] / 1e9
        ));
    }
    say(format!(
        "  projected for an H100, picture on its way back not included: {:.1} ms of instructions, {:.1} ms of memory",
        1e3 * sum[0] / CARD[0],
        1e3 * sum[1] / CARD[1]
    ));
}
