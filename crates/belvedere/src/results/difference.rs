//! Changes of cells as maps.

use crate::cast::to_index;
use crate::figures::{MapLegend, MapPicture, Picture, map_picture};
use crate::io::Georeference;
use crate::raster::Raster;
use crate::{PointCloud, Result};

/// Colours of losses and gains from small to large: blue and orange. People with any colour vision can distinguish
/// them, and they grow darker, so that they differ in print too.
///
/// # Source
/// Brewer, ColorBrewer 2.0, PuOr with its purples turned blue.
const LOSS: [[u8; 3]; 3] = [[166, 206, 235], [67, 147, 205], [8, 64, 129]];
const GAIN: [[u8; 3]; 3] = [[253, 208, 140], [241, 138, 40], [150, 62, 4]];
const SAME: [u8; 3] = [242, 242, 242];
/// Share of the changed cells whose change the darkest colours show.
const DARKEST: f64 = 0.2;

/// Returns the highest points of `cloud` in the cells of a raster of `size` (width, height) at `place`, local metres of
/// the cloud. The cloud has the reference system of the place. NaN for a cell without points.
///
/// # Errors
/// Those of [`Raster::from_values`].
pub fn relief_of(cloud: &PointCloud, place: &Georeference, [width, height]: [usize; 2]) -> Result<Raster<f32>> {
    let mut heights = vec![f32::NAN; width * height];
    let ([a, b], [c, d]) = (place.column_step, place.row_step);
    let determinant = a * d - b * c;
    for position in &cloud.positions {
        let [x, y, _] = cloud.frame.to_file_coordinates(*position);
        let [x, y] = [x - place.upper_left[0], y - place.upper_left[1]];
        let (column, row) = ((d * x - c * y) / determinant, (a * y - b * x) / determinant);
        if !(column >= 0.0 && row >= 0.0 && column < width as f64 && row < height as f64) {
            continue;
        }
        let at = to_index(row) * width + to_index(column);
        if let Some(highest) = heights.get_mut(at) {
            *highest = highest.max(position[2]);
        }
    }
    Raster::from_values(width, height, heights)
}

/// A map of `change`, NaN where there is none, of cells of `cell` metres at `place` over shaded `relief`, with a legend
/// of losses and gains. Without a relief all is level.
///
/// # Errors
/// Those of [`map_picture`].
pub fn difference_map(
    change: &Raster<f32>,
    relief: Option<&Raster<f32>>,
    cell: f64,
    place: Option<&Georeference>,
    title: &str,
) -> Result<Picture> {
    let mut sizes: Vec<f32> = change.values().iter().map(|v| v.abs()).filter(|v| *v > 0.0).collect();
    sizes.sort_by(f32::total_cmp);
    let large =
        sizes.get(to_index(sizes.len() as f64 * (1.0 - DARKEST))).or(sizes.last()).map_or(1.0, |v| f64::from(*v));
    let step = round_step(large / 2.0);
    let grade = |size: f64| to_index(size / step).min(2);
    let color = |&value: &f32| match f64::from(value) {
        value if value > 0.0 => Some(GAIN[grade(value)]),
        value if value < 0.0 => Some(LOSS[grade(-value)]),
        0.0 => Some(SAME),
        _ => None,
    };
    let colors: Vec<Option<[u8; 3]>> = change.values().iter().map(color).collect();
    let number = |value: f64| if step >= 1.0 { format!("{value:.0}") } else { format!("{value}") };
    let [first, second] = [step, 2.0 * step].map(number);
    // such as that of lit and not lit
    let only = sizes.first().filter(|min| sizes.last() == Some(min));
    let texts = |sign: &str| {
        let max = only.map_or(format!("{sign} of {second} or more"), |only| format!("{sign} of {only}"));
        [format!("{sign} below {first}"), format!("{sign} of {first} to {second}"), max]
    };
    let (gains, losses) = (texts("gain"), texts("loss"));
    let used = |color: [u8; 3]| colors.contains(&Some(color));
    let mut meanings: Vec<([u8; 3], &str)> = GAIN.into_iter().zip(gains.iter().map(String::as_str)).rev().collect();
    meanings.push((SAME, "no change"));
    meanings.extend(LOSS.into_iter().zip(losses.iter().map(String::as_str)));
    meanings.retain(|(color, _)| used(*color));
    let level = Raster::filled(change.width(), change.height(), 0.0);
    let legend = MapLegend::Colors(&meanings);
    map_picture(&MapPicture::of_colors(relief.unwrap_or(&level), cell, place, &colors, title, legend))
}

/// The largest of 1, 2 and 5 times a power of ten that is at most `value`.
fn round_step(value: f64) -> f64 {
    if !(value.is_finite() && value > 0.0) {
        return 1.0;
    }
    let power = value.log10().floor();
    let share = value / 10_f64.powf(power);
    let digit = if share >= 5.0 {
        5.0
    } else if share >= 2.0 {
        2.0
    } else {
        1.0
    };
    // divided rather than multiplied by a fraction, so that it prints short
    if power < 0.0 { digit / 10_f64.powf(-power) } else { digit * 10_f64.powf(power) }
}

#[cfg(test)]
mod tests {
    use super::round_step;

    #[test]
    fn steps_are_round() {
        let steps = [0.5, 0.3, 0.07, 1.0, 4.9, 730.0, 0.0].map(round_step);
        assert_eq!(steps, [0.5, 0.2, 0.05, 1.0, 2.0, 500.0, 1.0]);
    }
}
