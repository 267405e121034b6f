//! Depth maps and bounds of depth of a backend: the pixels drawn by the device, joined with those left to the CPU.

use crate::depth::{Candidate, DevicePicture, Drawn, PlacedBalls, place};
use crate::gpu_state::{GpuState, Ready};
use belvedere_core::depth::{
    BallDepth, BoundsParams, DepthBounds, DepthMap, ItemBuffer, NO_BALL, Profile, depth_bounds, depth_map,
};
use belvedere_core::query::{Ball, DEPTH_MAP_TOLERANCE, Drawable};
use belvedere_data::balls::{MedialBalls, NO_TOUCH};
use belvedere_data::control::Control;
use belvedere_data::raster::Raster;
use belvedere_data::view::View;
use belvedere_data::{Error, Result};
use rayon::prelude::*;
use std::sync::Arc;

/// Balls made ready to be drawn.
pub(crate) struct Drawing<'b> {
    shared: Arc<GpuState>,
    ready: Arc<Ready>,
    balls: &'b MedialBalls,
}

impl<'b> Drawing<'b> {
    /// `None` where the device is not made for so many balls.
    pub(crate) fn new(shared: Arc<GpuState>, ready: Arc<Ready>, balls: &'b MedialBalls) -> Option<Self> {
        // what is refused is refused by the CPU
        let is_usual = !balls.is_empty() && u32::try_from(balls.len()).is_ok() && balls.validate().is_ok();
        is_usual.then_some(Self { shared, ready, balls })
    }

    fn on_cpu(&self, view: &View, items: ItemBuffer, control: &Control<'_>) -> Result<DepthMap> {
        depth_map(self.balls, view, Profile::Sphere, items, control)
    }

    /// The ball of a row, if it counts.
    fn ball(&self, row: usize) -> Option<Ball> {
        let (center, radius) = (*self.balls.centers.get(row)?, *self.balls.radii.get(row)?);
        (*self.balls.touch.get(row)? != NO_TOUCH).then_some(Ball { center, radius })
    }

    /// The exact depth of a ball at a pixel.
    fn exact(&self, depths: &BallDepth, view: &View, pixel: usize, row: u32) -> f32 {
        let [width, _] = view.size_px;
        let at = [pixel % width, pixel / width];
        self.ball(row as usize).map_or(f32::INFINITY, |ball| depths.at(ball, at))
    }

    /// Draws marked pixels again, with the bits of the CPU. Returns how many there are.
    fn redo(&self, map: &mut DepthMap, candidates: &[Candidate]) -> usize {
        let view = map.view;
        let depths = BallDepth::new(&view);
        let exact: Vec<f32> = (candidates.par_iter().with_min_len(1 << 10))
            .map(|candidate| self.exact(&depths, &view, candidate.pixel, candidate.row))
            .collect();
        let values = map.depth.values_mut();
        let mut count = 0;
        for (pixel, depth) in values.iter_mut().enumerate().filter(|(_, depth)| depth.is_sign_negative()) {
            count += 1;
            *depth = f32::INFINITY;
            if let Some(ball) = map.balls.as_mut().and_then(|balls| balls.values_mut().get_mut(pixel)) {
                *ball = NO_BALL;
            }
        }
        for (&Candidate { pixel, row }, depth) in candidates.iter().zip(exact) {
            let Some(shown) = values.get_mut(pixel) else { continue };
            let ball = map.balls.as_mut().and_then(|balls| balls.values_mut().get_mut(pixel));
            let is_lower_row = ball.as_ref().is_some_and(|ball| depth.is_finite() && row < **ball);
            if depth < *shown || (depth == *shown && is_lower_row) {
                *shown = depth;
                if let Some(ball) = ball {
                    *ball = row;
                }
            }
        }
        count
    }

    /// Joins to a depth map that of other balls of the same scene, whose rows there are `rows`, ascending.
    fn join(&self, map: &mut DepthMap, other: &DepthMap, rows: &[u32]) {
        map.around_eye_count += other.around_eye_count;
        let view = map.view;
        let depths = map.depth.values_mut().iter_mut().zip(other.depth.values());
        let (Some(balls), Some(others)) = (&mut map.balls, &other.balls) else {
            return depths.for_each(|(depth, &nearer)| *depth = depth.min(nearer));
        };
        let exact = BallDepth::new(&view);
        let pairs = balls.values_mut().iter_mut().zip(others.values());
        for (pixel, ((depth, &nearer), (ball, &place))) in depths.zip(pairs).enumerate() {
            let Some(&row) = rows.get(place as usize) else { continue };
            // which of both is the nearer the device may not have known
            if (nearer - *depth).abs() <= 2.0 * DEPTH_MAP_TOLERANCE * nearer {
                *depth = self.exact(&exact, &view, pixel, *ball);
            }
            if nearer < *depth || (nearer == *depth && row < *ball) {
                (*depth, *ball) = (nearer, row);
            }
        }
    }

    fn joined(
        &self,
        view: &View,
        placed: &PlacedBalls,
        drawn: Drawn,
        items: ItemBuffer,
        control: &Control<'_>,
    ) -> Result<DepthMap> {
        let Drawn { depth, rows, candidates: Some(candidates) } = drawn else {
            return self.on_cpu(view, items, control);
        };
        self.shared.set_used(&self.ready.device);
        let [width, height] = view.size_px;
        let mut map = DepthMap {
            view: *view,
            profile: Profile::Sphere,
            depth: Raster::from_values(width, height, depth)?,
            balls: rows.map(|rows| Raster::from_values(width, height, rows)).transpose()?,
            around_eye_count: placed.around_eye_count,
        };
        let redone = self.redo(&mut map, &candidates);
        self.shared.count_pixels(width * height, redone);
        if !placed.left.is_empty() {
            let rest = depth_map(&of_rows(self.balls, &placed.left), view, Profile::Sphere, items, control)?;
            self.join(&mut map, &rest, &placed.left);
        }
        Ok(map)
    }
}

impl Drawable for Drawing<'_> {
    fn depth_map(&self, view: &View, items: ItemBuffer, control: &Control<'_>) -> Result<DepthMap> {
        let picture = DevicePicture::depths(view, items);
        if !picture.can_be_drawn() {
            return self.on_cpu(view, items, control);
        }
        let placed = place(&picture, self.balls.len(), |row| self.ball(row));
        match self.ready.painter.draw(&placed, &picture, self.shared.fails_after, control) {
            Ok(drawn) => self.joined(view, &placed, drawn, items, control),
            Err(Error::Device { what }) => {
                self.shared.give_up(&self.ready.device, &what);
                self.on_cpu(view, items, control)
            }
            Err(other) => Err(other),
        }
    }
}

/// Bounds of depth as [`depth_bounds`] defines them, though not with the same bits; `None` where the device does not
/// draw them, or fails.
///
/// # Errors
/// Those of [`depth_bounds`].
pub(crate) fn bounds(
    shared: &GpuState,
    balls: &[Ball],
    view: &View,
    params: &BoundsParams,
    control: &Control<'_>,
) -> Result<Option<DepthBounds>> {
    let [width, height] = view.size_px;
    let picture = DevicePicture::bounds(view, params);
    if balls.is_empty() || u32::try_from(balls.len()).is_err() || !picture.can_be_drawn() {
        return Ok(None);
    }
    let Some(ready) = shared.ready_to_draw(balls.len(), width * height) else { return Ok(None) };
    let placed = place(&picture, balls.len(), |row| balls.get(row).copied());
    let Drawn { depth: upper, rows: Some(lower), .. } =
        (match ready.painter.draw(&placed, &picture, shared.fails_after, control) {
            Ok(drawn) => drawn,
            Err(Error::Device { what }) => {
                shared.give_up(&ready.device, &what);
                return Ok(None);
            }
            Err(other) => return Err(other),
        })
    else {
        return Ok(None);
    };
    shared.set_used(&ready.device);
    let drawn = lower.into_iter().zip(upper).map(|(lower, upper)| [f32::from_bits(lower), upper]);
    let mut bounds = Raster::from_values(width, height, drawn.collect())?;
    if !placed.left.is_empty() {
        let rest: Vec<Ball> = placed.left.iter().filter_map(|&row| balls.get(row as usize).copied()).collect();
        let rest = depth_bounds(&rest, view, params, control)?;
        for (bounds, rest) in bounds.values_mut().iter_mut().zip(rest.bounds.values()) {
            *bounds = [bounds[0].min(rest[0]), bounds[1].min(rest[1])];
        }
    }
    Ok(Some(DepthBounds { view: *view, bounds }))
}

/// The balls of some rows.
fn of_rows(balls: &MedialBalls, rows: &[u32]) -> MedialBalls {
    fn pick<T: Copy>(rows: &[u32], column: &[T]) -> Vec<T> {
        rows.iter().filter_map(|&row| column.get(row as usize).copied()).collect()
    }
    MedialBalls {
        centers: pick(rows, &balls.centers),
        radii: pick(rows, &balls.radii),
        source: pick(rows, &balls.source),
        touch: pick(rows, &balls.touch),
        separation_angles: pick(rows, &balls.separation_angles),
    }
}
