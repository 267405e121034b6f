//! Depth all around an eye, as a picture that people read: azimuth across, elevation down.

use super::depth_map::{DepthMap, depth_map};
use super::tiles::{ItemBuffer, NO_BALL};
use crate::blocking::Profile;
use crate::medial::MedialBalls;
use belvedere_data::Result;
use belvedere_data::control::Control;
use belvedere_data::raster::Raster;
use belvedere_data::vector::{cross, dot, length, sub, to_f32};
use belvedere_data::view::{View, panorama_direction};
use rayon::prelude::*;

/// Range in every direction from an eye. A column is an azimuth: clockwise from south at the left edge over west, north
/// in the middle and east to south again. A row is an elevation, from the zenith to the nadir. All pixels are equally
/// wide and high in angle.
#[derive(Clone, Debug, PartialEq)]
pub struct Panorama {
    /// Range in metres from the eye; +∞ where nothing is hit.
    pub range: Raster<f32>,
    /// Index of the ball in each pixel, see [`DepthMap::balls`](super::DepthMap::balls).
    pub balls: Option<Raster<u32>>,
    /// Number of balls around the eye, see [`DepthMap::around_eye_count`](super::DepthMap::around_eye_count).
    pub around_eye_count: usize,
}

/// Range from `eye` to a ball along a unit vector, both local, if it meets the ball.
fn front(balls: &MedialBalls, ball: usize, eye: [f64; 3], direction: [f64; 3]) -> Option<f32> {
    // by the vector product, which keeps more digits at the edge of a ball: the pixel may just touch it
    let (center, radius) = (balls.centers.get(ball)?, f64::from(*balls.radii.get(ball)?));
    let offset = sub(center.map(f64::from), eye);
    let along = dot(offset, direction);
    let beside = length(cross(offset, direction));
    let range = to_f32(along - (radius * radius - beside * beside).max(0.0).sqrt());
    (beside < radius).then_some(range)
}

/// The panorama of `balls` around `eye`, local metres, `width` pixels wide (made even) and half as high.
///
/// The ball of a pixel is looked up in two stereographic depth maps with pixels of a third to two thirds of its own.
/// The range is that of this ball in the very direction of the pixel. If the direction just misses the ball, it is that
/// of the map.
///
/// # Errors
/// As [`View::panorama`] and [`depth_map`].
pub fn panorama(
    balls: &MedialBalls,
    eye: [f64; 3],
    width: usize,
    items: ItemBuffer,
    control: &Control<'_>,
) -> Result<Panorama> {
    let draw = |view: &View| depth_map(balls, view, Profile::Sphere, ItemBuffer::With, control);
    panorama_of_maps(balls, eye, width, items, draw)
}

/// The panorama of [`panorama`], from two depth maps with item buffers that `draw` makes.
pub(crate) fn panorama_of_maps(
    balls: &MedialBalls,
    eye: [f64; 3],
    width: usize,
    items: ItemBuffer,
    draw: impl FnMut(&View) -> Result<DepthMap>,
) -> Result<Panorama> {
    let maps = View::panorama(eye, width.max(1))?.iter().map(draw).collect::<Result<Vec<_>>>()?;
    let width = width.max(1).next_multiple_of(2);
    let height = width / 2;
    let pixels: Vec<(f32, u32)> = (0..width * height)
        .into_par_iter()
        .with_min_len(1 << 12)
        .map(|at| {
            let direction = panorama_direction(width, [at % width, at / width]);
            let place = maps.iter().find_map(|map| {
                let place = map.view.place_of_direction(direction)?;
                map.view.pixel([place[0], place[1], 0.0]).map(|pixel| (map, pixel))
            });
            let Some((map, [column, row])) = place else { return (f32::INFINITY, NO_BALL) };
            let sampled = map.depth.get(column, row).unwrap_or(f32::INFINITY);
            let ball = map.balls.as_ref().and_then(|balls| balls.get(column, row)).unwrap_or(NO_BALL);
            let exact = (ball != NO_BALL).then(|| front(balls, ball as usize, eye, direction)).flatten();
            (exact.unwrap_or(sampled), ball)
        })
        .collect();
    let range = Raster::from_values(width, height, pixels.iter().map(|pixel| pixel.0).collect())?;
    let balls = match items {
        ItemBuffer::With => Some(Raster::from_values(width, height, pixels.iter().map(|pixel| pixel.1).collect())?),
        ItemBuffer::Without => None,
    };
    Ok(Panorama { range, balls, around_eye_count: maps.first().map_or(0, |map| map.around_eye_count) })
}
