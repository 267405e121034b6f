//! Positions of balls in a view, in double precision, with the bits that the CPU draws with.

use super::{BEYOND, DevicePicture, Shows, scale_of};
use belvedere_core::blocking::holds_at;
use belvedere_core::query::Ball;
use belvedere_data::vector::{cross, length, to_f32};
use belvedere_data::view::{Projection, View};
use rayon::prelude::*;

/// More than the CPU and a device together err by at a ball in a view from an eye, as a share of its distance and
/// radius: 2⁻¹⁷. The shaders use the same.
const CENTRAL_ROOM: f64 = 7.629_394_6e-6;
/// The same for lengths too small for single precision, metres.
const MIN_ROOM: f64 = 1e-9;
/// Farther places, and larger balls, are the CPU's, metres or pixels.
const MAX_LENGTH: f64 = 1e9;
/// In a parallel view places farther from the picture's corner, and larger balls, are the CPU's, pixels.
const MAX_PIXELS: f64 = 1_048_576.0;

/// Balls in a view.
#[derive(Debug, Default)]
pub(crate) struct PlacedBalls {
    /// Centre and radius along right, down and forward, in pixels, pixels and metres in parallel views and in metres in
    /// all others. The radius of balls that a device does not draw is 0.
    pub(super) splats: Vec<[f32; 4]>,
    /// Rows of the balls that the CPU has to draw, ascending.
    pub(crate) left: Vec<u32>,
    /// Balls that hold the eye.
    pub(crate) around_eye_count: usize,
}

/// Position of a ball.
enum BallPlace {
    /// Beside the picture, or nowhere.
    Outside,
    AroundEye,
    /// Ball for which single precision does not suffice.
    OfCpu,
    At([f32; 4]),
}

/// Places `count` balls.
pub(crate) fn place(
    picture: &DevicePicture<'_>,
    count: usize,
    ball: impl Fn(usize) -> Option<Ball> + Sync,
) -> PlacedBalls {
    let min_pixel = min_pixel(picture.view);
    let place_one = |row: usize| match ball(row).filter(|ball| ball.radius > 0.0 && ball.radius.is_finite()) {
        None => BallPlace::Outside,
        // devices may take such a number for zero
        Some(ball) if ball.radius.is_subnormal() => BallPlace::OfCpu,
        Some(ball) if picture.view.is_central() => place_central(picture, ball, min_pixel),
        Some(ball) => place_parallel(picture, ball),
    };
    let places: Vec<BallPlace> = (0..count).into_par_iter().with_min_len(1 << 12).map(place_one).collect();
    let mut placed = PlacedBalls { splats: Vec::with_capacity(count), ..PlacedBalls::default() };
    for (row, place) in (0..).zip(places) {
        match place {
            BallPlace::OfCpu => placed.left.push(row),
            BallPlace::AroundEye => placed.around_eye_count += 1,
            BallPlace::Outside | BallPlace::At(_) => {}
        }
        placed.splats.push(if let BallPlace::At(splat) = place { splat } else { [0.0; 4] });
    }
    placed
}

/// A quarter of the diagonal of the smallest pixel of a view from an eye, radians.
fn min_pixel(view: &View) -> f64 {
    0.25 * length(cross(view.direction([0.0; 2]), view.direction([1.0; 2])))
}

fn place_parallel(picture: &DevicePicture<'_>, ball: Ball) -> BallPlace {
    let view = picture.view;
    let scale = scale_of(view);
    let [x, y, depth] = view.frame.view_from_local(ball.center);
    let (x, y, radius) = (x * scale, y * scale, f64::from(ball.radius));
    let reach = radius * scale + BEYOND;
    let [width, height] = view.size_px.map(|size| size as f64);
    // what is not finite is outside too
    let is_inside = x + reach > 0.0 && x - reach < width && y + reach > 0.0 && y - reach < height && depth.is_finite();
    let is_before = picture.shows != Shows::Bounds && depth + radius < 0.0;
    if !is_inside || is_before {
        return BallPlace::Outside;
    }
    if x.abs().max(y.abs()).max(reach) > MAX_PIXELS || depth.abs().max(radius) > MAX_LENGTH {
        return BallPlace::OfCpu;
    }
    BallPlace::At([to_f32(x), to_f32(y), to_f32(depth), ball.radius])
}

fn place_central(picture: &DevicePicture<'_>, ball: Ball, min_pixel: f64) -> BallPlace {
    let view = picture.view;
    let center = view.frame.view_from_local(ball.center);
    let (distance, radius) = (center.map(|v| v * v).iter().sum::<f64>().sqrt(), f64::from(ball.radius));
    if !distance.is_finite() {
        return BallPlace::Outside;
    }
    let [near, far] = picture.limits;
    let room = CENTRAL_ROOM * (distance + radius + near) + MIN_ROOM;
    let is_at_eye = (distance - radius).abs() <= room;
    if picture.shows == Shows::Bounds {
        // the CPU knows how balls around an eye, or just before it, give way where lines of sight end there; a limit
        // takes those that hold the eye away
        match picture.starts == [0.0; 2] {
            true if distance - radius <= picture.shell + room => return BallPlace::OfCpu,
            false if holds_at(radius, distance) && !is_at_eye => return BallPlace::AroundEye,
            _ => {}
        }
    } else if holds_at(radius, distance) {
        return BallPlace::AroundEye;
    }
    let middle = if matches!(view.projection, Projection::Perspective { .. }) { center[2] } else { distance };
    if !is_at_eye && (middle + radius < near - room || middle - radius - room > far) {
        return BallPlace::Outside;
    }
    // the CPU draws balls as far as their outlines in double precision: where a pixel is so small that single precision
    // misplaces them by a part of one, a device might show more of them
    let edge = ((distance - radius) * (distance + radius)).sqrt();
    let misplaced = 0.125 * CENTRAL_ROOM * (distance + radius);
    let is_at_near_limit = middle + radius <= near + room;
    if is_at_eye || is_at_near_limit || misplaced > 0.25 * min_pixel * edge || distance.max(radius) > MAX_LENGTH {
        return BallPlace::OfCpu;
    }
    let [x, y, z] = center.map(to_f32);
    BallPlace::At([x, y, z, ball.radius])
}
