//! Measures of the cells of a grid as maps.

use crate::Result;
use crate::apps::targets::Measure;
use crate::figures::{MapLegend, MapPicture, Picture, map_picture, ramp_colors};
use crate::io::Georeference;
use crate::raster::Raster;

/// Colours of measures on a map.
const COLORS: usize = 101;

/// A measure of cells of `cell` metres over shaded `relief` that lies at `place`, with a legend.
///
/// # Errors
/// Those of [`map_picture`].
pub fn measure_map(
    measure: &Measure,
    relief: &Raster<f32>,
    cell: f64,
    place: &Georeference,
    title: &str,
) -> Result<Picture> {
    let values: Vec<f64> = measure.values.iter().map(|&v| f64::from(v)).collect();
    let [low, high] = measure.span(&values);
    let ramp = ramp_colors(&(0..COLORS).map(|i| i as f32).collect::<Vec<f32>>());
    let color = |&value: &f64| {
        let share = ((value - low) / (high - low)).clamp(0.0, 1.0);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a place in the ramp")]
        let place = (share * (COLORS - 1) as f64).round() as usize;
        if value.is_finite() { ramp.get(place).copied() } else { None }
    };
    let colors: Vec<Option<[u8; 3]>> = values.iter().map(color).collect();
    let legend = MapLegend::Ramp(measure.description, [low, high]);
    map_picture(&MapPicture { relief, cell, place: Some(place), colors: &colors, marks: &[], title, legend })
}
