//! Depth maps and bounds of depth of a backend: what the device draws, joined with what it left to the CPU.

use crate::backend::{Ready, Shared};
use crate::depth::{Canvas, Drawn, Picture};
use belvedere_core::depth::{BoundsParams, DepthBounds, DepthMap, ItemBuffer, Profile, depth_bounds, depth_map};
use belvedere_core::query::{Ball, Drawable};
use belvedere_data::balls::{MedialBalls, NO_TOUCH};
use belvedere_data::control::Control;
use belvedere_data::raster::Raster;
use belvedere_data::view::View;
use belvedere_data::{Error, Result};
use std::sync::Arc;

/// Balls made ready to be drawn.
pub(crate) struct Drawing<'b> {
    shared: Arc<Shared>,
    ready: Arc<Ready>,
    balls: &'b MedialBalls,
    canvas: Canvas,
}

impl<'b> Drawing<'b> {
    /// `None` where the device fails, or is not made for so many balls.
    ///
    /// # Errors
    /// [`Error::Cancelled`].
    pub(crate) fn new(
        shared: Arc<Shared>,
        ready: Arc<Ready>,
        balls: &'b MedialBalls,
        control: &Control<'_>,
    ) -> Result<Option<Self>> {
        // what is refused is refused by the CPU
        if balls.is_empty() || u32::try_from(balls.len()).is_err() || balls.validate().is_err() {
            return Ok(None);
        }
        let ball = |row: usize| {
            let [x, y, z] = balls.centers[row];
            [x, y, z, if balls.touch[row] == NO_TOUCH { 0.0 } else { balls.radii[row] }]
        };
        match ready.painter.canvas(balls.len(), ball, control) {
            Ok(canvas) => Ok(Some(Self { shared, ready, balls, canvas })),
            Err(Error::Device { what }) => {
                shared.give_up(&ready.device, &what);
                Ok(None)
            }
            Err(other) => Err(other),
        }
    }

    fn on_cpu(&self, view: &View, items: ItemBuffer, control: &Control<'_>) -> Result<DepthMap> {
        depth_map(self.balls, view, Profile::Sphere, items, control)
    }
}

impl Drawable for Drawing<'_> {
    fn depth_map(&self, view: &View, items: ItemBuffer, control: &Control<'_>) -> Result<DepthMap> {
        let picture = Picture::depths(view, items);
        if !picture.can_be_drawn() {
            return self.on_cpu(view, items, control);
        }
        let drawn = match self.ready.painter.draw(&self.canvas, &picture, self.shared.fails_after, control) {
            Ok(drawn) => drawn,
            Err(Error::Device { what }) => {
                self.shared.give_up(&self.ready.device, &what);
                return self.on_cpu(view, items, control);
            }
            Err(other) => return Err(other),
        };
        self.shared.count(drawn.work);
        let Drawn { depth, rows, around_eye_count, left: Some(left), .. } = drawn else {
            return self.on_cpu(view, items, control);
        };
        self.shared.set_used(&self.ready.device);
        let [width, height] = view.size_px;
        let mut map = DepthMap {
            view: *view,
            profile: Profile::Sphere,
            depth: Raster::from_values(width, height, depth)?,
            balls: rows.map(|rows| Raster::from_values(width, height, rows)).transpose()?,
            around_eye_count,
        };
        if !left.is_empty() {
            let rest = depth_map(&of_rows(self.balls, &left), view, Profile::Sphere, items, control)?;
            join(&mut map, &rest, &left);
        }
        Ok(map)
    }
}

/// Bounds of depth as [`depth_bounds`] defines them, though not with the same bits; `None` where the device is not asked, or fails.
///
/// # Errors
/// Those of [`depth_bounds`].
pub(crate) fn bounds(
    shared: &Shared,
    balls: &[Ball],
    view: &View,
    params: &BoundsParams,
    control: &Control<'_>,
) -> Result<Option<DepthBounds>> {
    let [width, height] = view.size_px;
    let picture = Picture::bounds(view, params);
    if balls.is_empty() || u32::try_from(balls.len()).is_err() || !picture.can_be_drawn() {
        return Ok(None);
    }
    let Some(ready) = shared.ready_to_draw(balls.len(), width * height) else { return Ok(None) };
    let ball = |row: usize| {
        let Ball { center: [x, y, z], radius } = balls[row];
        [x, y, z, radius]
    };
    let canvas = ready.painter.canvas(balls.len(), ball, control);
    let drawn = canvas.and_then(|canvas| ready.painter.draw(&canvas, &picture, shared.fails_after, control));
    let Drawn { depth: upper, rows: Some(lower), left: Some(left), .. } = (match drawn {
        Ok(drawn) => drawn,
        Err(Error::Device { what }) => {
            shared.give_up(&ready.device, &what);
            return Ok(None);
        }
        Err(other) => return Err(other),
    }) else {
        return Ok(None);
    };
    shared.set_used(&ready.device);
    let drawn = lower.into_iter().zip(upper).map(|(lower, upper)| [f32::from_bits(lower), upper]);
    let mut bounds = Raster::from_values(width, height, drawn.collect())?;
    if !left.is_empty() {
        let rest: Vec<Ball> = left.iter().filter_map(|&row| balls.get(row as usize).copied()).collect();
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

/// Joins to a depth map that of other balls of the same scene, whose rows there are `rows`, ascending.
fn join(map: &mut DepthMap, other: &DepthMap, rows: &[u32]) {
    map.around_eye_count += other.around_eye_count;
    let depths = map.depth.values_mut().iter_mut().zip(other.depth.values());
    match (&mut map.balls, &other.balls) {
        (Some(balls), Some(others)) => {
            for ((depth, &nearer), (ball, &place)) in depths.zip(balls.values_mut().iter_mut().zip(others.values())) {
                let Some(&row) = rows.get(place as usize) else { continue };
                if nearer < *depth || (nearer == *depth && row < *ball) {
                    (*depth, *ball) = (nearer, row);
                }
            }
        }
        _ => depths.for_each(|(depth, &nearer)| *depth = depth.min(nearer)),
    }
}
