//! Measures of the cells of a grid as maps.

use crate::Result;
use crate::apps::targets::Measure;
use crate::figures::{MapLegend, MapPicture, Picture, map_picture, ramp};
use crate::io::Georeference;
use crate::raster::Raster;

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
    let color = |&value: &f64| value.is_finite().then(|| ramp((value - low) / (high - low)));
    let colors: Vec<Option<[u8; 3]>> = values.iter().map(color).collect();
    let legend = MapLegend::Ramp(measure.description, [low, high], &[]);
    map_picture(&MapPicture::of_colors(relief, cell, Some(place), &colors, title, legend))
}
