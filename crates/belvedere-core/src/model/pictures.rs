//! Pictures of a scene model: depth maps, drawn by its backend where that is faster.

use super::SceneModel;
use crate::blocking::Profile;
use crate::depth::{DepthMap, ItemBuffer, Panorama, depth_map, panorama, panorama_of_maps};
use belvedere_data::Result;
use belvedere_data::control::Control;
use belvedere_data::view::View;

impl SceneModel {
    /// The depth map of its balls in `view`: [`depth_map()`]. Where the backend of the model draws it, each depth may
    /// differ by [`DEPTH_MAP_TOLERANCE`](crate::query::DEPTH_MAP_TOLERANCE) of itself; without a backend and with that
    /// of the CPU none does.
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
        match drawable.flatten() {
            Some(drawable) => drawable.depth_map(view, items, control),
            None => depth_map(self.balls(), view, profile, items, control),
        }
    }

    /// The panorama of its balls around `eye`: [`panorama()`], whose depth maps the backend of the model may draw, with
    /// the tolerance of [`SceneModel::depth_map`].
    ///
    /// # Errors
    /// Those of [`panorama()`].
    pub fn panorama(&self, eye: [f64; 3], width: usize, items: ItemBuffer, control: &Control<'_>) -> Result<Panorama> {
        let balls = self.balls();
        // two square maps
        let pixel_count = width.saturating_mul(width).saturating_mul(2);
        let drawable =
            self.backend.as_ref().map(|backend| backend.drawable(balls, pixel_count, control)).transpose()?;
        match drawable.flatten() {
            Some(drawable) => {
                let draw = |view: &View| drawable.depth_map(view, ItemBuffer::With, control);
                panorama_of_maps(balls, eye, width, items, draw)
            }
            None => panorama(balls, eye, width, items, control),
        }
    }
}
