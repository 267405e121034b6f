//! Lenses and motion of cameras.

use crate::cameras::{Lens, Motion, MountingParams};
use belvedere_data::Result;
use serde::{Deserialize, Serialize};

/// Lens and mounting of cameras, where nothing else is said of one.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default)]
pub struct CameraLens {
    /// Horizontal field of view, degrees, above 0 to 360; `None` for 90. From 180 on it sees all around: a person, a
    /// fisheye lens, a mast.
    pub fov_deg: Option<f64>,
    /// Vertical field of view, degrees; `None` for that of a picture of 16:9, or 180 where the horizontal one is 180 or
    /// more.
    pub vertical_fov_deg: Option<f64>,
    /// Pixels across the picture; `None` for 1920.
    pub pixels: Option<f64>,
    /// Pixels per metre that are needed, 0 for none; `None` for 25 (detect), or none where the field of view is 180 or
    /// more.
    pub density: Option<f64>,
    /// Headings to choose from at each place, evenly spread, 1 to 360; `None` for 8.
    pub headings: Option<usize>,
    /// Angles below the horizon to choose from, degrees, -90 to 90; none for 15.
    pub tilts_deg: Vec<f64>,
    /// True if they turn and tilt to each target.
    pub is_turning: bool,
    /// Minimum horizontal distance, metres; `None` for 0.
    pub min_distance: Option<f64>,
    /// Maximum horizontal distance, metres; `None` for no limit.
    pub max_distance: Option<f64>,
}

impl CameraLens {
    /// The lens.
    ///
    /// # Errors
    /// Those of [`Lens::validate`].
    pub(super) fn lens(&self) -> Result<Lens> {
        let usual = Lens::default();
        let lens = usual
            .with_height(self.vertical_fov_deg.map(f64::to_radians))
            .with_width(self.fov_deg.map_or(usual.width, f64::to_radians))
            .with_pixels(self.pixels.unwrap_or(usual.pixels));
        lens.validate()?;
        Ok(lens)
    }

    /// Returns the mounting of cameras.
    ///
    /// # Errors
    /// Those of [`CameraLens::lens`].
    pub(super) fn mounting(&self) -> Result<MountingParams> {
        let mut params = MountingParams::default().with_lens(self.lens()?);
        let [min, max] = params.distance;
        params.distance = [self.min_distance.unwrap_or(min), self.max_distance.unwrap_or(max)];
        params.headings = self.headings.unwrap_or(params.headings);
        if !self.tilts_deg.is_empty() {
            params.tilts = self.tilts_deg.iter().map(|tilt| tilt.to_radians()).collect();
        }
        Ok(params.with_motion(if self.is_turning { Motion::Turning } else { Motion::Fixed }))
    }
}
