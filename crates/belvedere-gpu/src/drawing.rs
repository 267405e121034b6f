//! Depth maps of a backend: what the device draws, joined with what it left to the CPU.

use crate::backend::{Ready, Shared};
use crate::depth::{Canvas, Drawn, Painter};
use belvedere_core::depth::{DepthMap, ItemBuffer, Profile, depth_map};
use belvedere_core::query::Drawable;
use belvedere_data::balls::MedialBalls;
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
        match ready.painter.canvas(balls, control) {
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
        if !Painter::can_draw(view) {
            return self.on_cpu(view, items, control);
        }
        let drawn = match self.ready.painter.draw(&self.canvas, view, items, self.shared.fails_after, control) {
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
