//! Pictures of a scene model: depth maps of its balls, drawn by its backend where that is faster, and of the triangles
//! beside them.

use super::SceneModel;
use crate::blocking::Profile;
use crate::depth::{BallDepth, DepthMap, ItemBuffer, NO_BALL, Panorama, depth_map, panorama, panorama_of_maps};
use crate::query::{Ball, DEPTH_MAP_TOLERANCE};
use crate::ray_index::Ray;
use belvedere_data::Result;
use belvedere_data::control::{Control, Stop};
use belvedere_data::raster::Raster;
use belvedere_data::vector::{length, sub, to_f32};
use belvedere_data::view::{View, panorama_direction};
use rayon::prelude::*;

impl SceneModel {
    /// The depth map of its balls in `view`, [`depth_map()`], and of the triangles that block beside them: surface
    /// patches and meshes that were added. Where the backend of the model draws the balls, each depth may differ by
    /// [`DEPTH_MAP_TOLERANCE`] of itself; without a backend and with that of the CPU none does.
    ///
    /// # Errors
    /// Those of [`depth_map()`].
    pub fn depth_map(
        &self,
        view: &View,
        profile: Profile,
        items: ItemBuffer,
        control: &Control<'_>,
    ) -> Result<DepthMap> {
        let pixel_count = view.size_px[0].saturating_mul(view.size_px[1]);
        let backend = self.backend.as_ref().filter(|_| profile == Profile::Sphere);
        let drawable = backend.map(|backend| backend.drawable(self.balls(), pixel_count, control)).transpose()?;
        let mut map = match drawable.flatten() {
            Some(drawable) => drawable.depth_map(view, items, control),
            None => depth_map(self.balls(), view, profile, items, control),
        }?;
        let [nearest, farthest] = view.limits();
        let sight = |[column, row]: [usize; 2]| {
            let place = [column as f64 + 0.5, row as f64 + 0.5];
            let [start, next] = [0.0, 1.0].map(|depth| view.frame.local_from_view(view.position(place, depth)));
            let range_per_depth = length(sub(next, start));
            let ray = Ray::new(start, sub(next, start), [nearest, farthest].map(|depth| depth * range_per_depth))?;
            Some(PixelSight { ray, range_per_depth })
        };
        // of a ball and a triangle the backend may not know which is the nearer
        let depths = BallDepth::new(view);
        let ball_depth = |at: [usize; 2], row: u32| {
            let ball = self.ball(row).filter(|_| profile == Profile::Sphere)?;
            Some(depths.at(ball, at))
        };
        self.draw_triangles(&mut map.depth, map.balls.as_mut(), sight, ball_depth, control)?;
        Ok(map)
    }

    fn ball(&self, row: u32) -> Option<Ball> {
        let balls = self.balls();
        let (center, radius) = (*balls.centers.get(row as usize)?, *balls.radii.get(row as usize)?);
        Some(Ball { center, radius })
    }

    /// The panorama around `eye` of its balls, [`panorama()`], and of the triangles beside them. The backend of the
    /// model may draw the depth maps of the balls, with the tolerance of [`SceneModel::depth_map`].
    ///
    /// # Errors
    /// Those of [`panorama()`].
    pub fn panorama(&self, eye: [f64; 3], width: usize, items: ItemBuffer, control: &Control<'_>) -> Result<Panorama> {
        let balls = self.balls();
        // two square maps
        let pixel_count = width.saturating_mul(width).saturating_mul(2);
        let drawable =
            self.backend.as_ref().map(|backend| backend.drawable(balls, pixel_count, control)).transpose()?;
        let mut drawn = match drawable.flatten() {
            Some(drawable) => {
                let draw = |view: &View| drawable.depth_map(view, ItemBuffer::With, control);
                panorama_of_maps(balls, eye, width, items, draw)
            }
            None => panorama(balls, eye, width, items, control),
        }?;
        let width = drawn.range.width();
        let sight = |pixel: [usize; 2]| {
            let ray = Ray::new(eye, panorama_direction(width, pixel), [0.0, f64::INFINITY])?;
            Some(PixelSight { ray, range_per_depth: 1.0 })
        };
        // ranges of panoramas are exact
        self.draw_triangles(&mut drawn.range, drawn.balls.as_mut(), sight, |_, _| None, control)?;
        Ok(drawn)
    }

    /// Lets pixels show the triangles that are nearer than the balls there. Where both are about as near,
    /// `ball_depth` of the pixel and the ball gives the exact depth of the ball.
    fn draw_triangles(
        &self,
        depth: &mut Raster<f32>,
        mut balls: Option<&mut Raster<u32>>,
        sight: impl Fn([usize; 2]) -> Option<PixelSight> + Sync,
        ball_depth: impl Fn([usize; 2], u32) -> Option<f32> + Sync,
        control: &Control<'_>,
    ) -> Result<()> {
        let Some(triangles) = &self.triangles else { return Ok(()) };
        let stop = Stop::new(control);
        let width = depth.width().max(1);
        let shown = balls.as_deref().map(Raster::values);
        let nearer = |(at, &drawn): (usize, &f32)| {
            let pixel = [at % width, at / width];
            let PixelSight { mut ray, range_per_depth } = sight(pixel).filter(|_| !stop.is_set())?;
            let room = 2.0 * DEPTH_MAP_TOLERANCE * drawn.abs();
            ray.ranges[1] = ray.ranges[1].min(f64::from(drawn + room) * range_per_depth);
            let found = to_f32(triangles.first_range(&ray)? / range_per_depth);
            let exact = || ball_depth(pixel, *shown?.get(at)?);
            let drawn = if (found - drawn).abs() <= room { exact().unwrap_or(drawn) } else { drawn };
            (found < drawn).then_some((at, found))
        };
        let found: Vec<(usize, f32)> =
            depth.values().par_iter().enumerate().with_min_len(1 << 12).filter_map(nearer).collect();
        stop.check()?;
        for (at, found) in found {
            depth.values_mut()[at] = found;
            if let Some(balls) = &mut balls {
                balls.values_mut()[at] = NO_BALL;
            }
        }
        Ok(())
    }
}

/// The line of sight through the middle of a pixel.
struct PixelSight {
    ray: Ray,
    /// Metres along the line for a metre of depth.
    range_per_depth: f64,
}
