//! Measures of the cells of a grid as maps.

use crate::Result;
use crate::apps::ask::Scene;
use crate::apps::targets::{Measure, Targets};
use crate::figures::{MapLegend, MapPicture, Picture, map_picture, ramp};
use crate::ground::highest_points;
use crate::io::Georeference;
use crate::raster::Raster;

/// Heights of the highest points in the cells of targets, metres, on the meshes that were added where these are higher;
/// `None` for targets that are no cells, and without points.
#[must_use]
pub fn relief_of_cells(targets: &Targets, scene: &Scene) -> Option<Raster<f32>> {
    let (ground, cloud) = (targets.ground()?, scene.ground_cloud().ok()?);
    let mut heights = highest_points(&cloud.positions, ground);
    if let Some(added) = scene.model().added() {
        added.raise(&mut heights, &ground.grid);
    }
    Some(heights)
}

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
