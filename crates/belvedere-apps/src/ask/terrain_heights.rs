//! Heights of far terrain against those of the scene: a raster in feet is known by its ratio.

use super::Remark;
use belvedere_data::ElevationGrid;
use belvedere_data::report::rounded;

/// Metres per foot, near enough for a ratio.
const FOOT: f64 = 0.3048;
/// Places that are compared at most: they only have to show the ground.
const MAX_PLACES: usize = 4000;
/// Fewer show nothing.
const MIN_PLACES: usize = 20;
/// Share of the places that show the ground at least: the others are roofs and trees.
const GROUND_SHARE: f64 = 0.2;
/// Ground and terrain that are this near agree, metres: a raster of coarse cells is no better.
const AGREES: f64 = 1.0;
/// How exact a ratio is, as a share of the difference that it explains: cells of 30 m on slopes.
const RATIO_ERROR: f64 = 0.02;
/// A raster further off than this has other heights, metres: slopes between coarse cells err less, the difference
/// between the ellipsoid and the sea is more.
const DIFFERS: f64 = 12.0;
/// Least difference that is no slope between coarse cells where many places share it, metres; how far these may differ
/// from each other, and their least share.
const DIFFERS_EVENLY: f64 = 3.0;
const EVENLY: f64 = 1.0;
const EVEN_SHARE: f64 = 0.25;

/// A warning where heights of the terrain are not those of `places` on surfaces of a scene, local metres, of which a
/// fifth or more lie on the ground. `base` is the height of local zero.
#[must_use]
pub fn remark_on_terrain(
    grid: &ElevationGrid,
    places: impl ExactSizeIterator<Item = [f64; 3]>,
    base: f64,
) -> Option<Remark> {
    let step = places.len().div_ceil(MAX_PLACES).max(1);
    let pairs: Vec<[f64; 2]> =
        places.step_by(step).filter_map(|[x, y, z]| Some([z + base, grid.height_at([x, y])? + base])).collect();
    if pairs.len() < MIN_PLACES {
        return None;
    }
    let differs_by = |factor: f64| {
        let mut differences: Vec<f64> = pairs.iter().map(|[top, terrain]| (top - factor * terrain).abs()).collect();
        differences.sort_by(f64::total_cmp);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share of a count")]
        let at = (differences.len() as f64 * GROUND_SHARE) as usize;
        differences.get(at).copied().unwrap_or(0.0)
    };
    let as_read = differs_by(1.0);
    if as_read <= AGREES {
        return None;
    }
    let as_feet = |factor: f64| differs_by(factor) < (as_read / 4.0).min(AGREES.max(RATIO_ERROR * as_read));
    let difference = rounded(as_read, 1);
    let remark = |key, text: String| Some(Remark::warning(key, text).with("difference_m", difference));
    if as_feet(FOOT) {
        let text = format!(
            "the heights of the terrain look like feet: they are 3.28 times those of the ground of the scene, {difference} m off; convert them: gdal_calc.py -A IN.tif --calc=A*0.3048 --outfile=OUT.tif"
        );
        return remark("terrain-in-feet", text);
    }
    if as_feet(1.0 / FOOT) {
        let text = format!(
            "the heights of the terrain look like metres that are read as feet: those of the ground of the scene are 3.28 times as much, {difference} m off; name the unit of the raster in its reference system"
        );
        return remark("terrain-in-metres", text);
    }
    if as_read > DIFFERS || (as_read > DIFFERS_EVENLY && differ_evenly(&pairs)) {
        let text = format!(
            "the terrain lies {difference} m off the ground of the scene: are both heights above the same level, and in the same unit?"
        );
        return remark("terrain-heights-differ", text);
    }
    None
}

/// Whether many places differ from the terrain by the same height.
fn differ_evenly(pairs: &[[f64; 2]]) -> bool {
    let mut differences: Vec<f64> = pairs.iter().map(|[top, terrain]| top - terrain).collect();
    differences.sort_by(f64::total_cmp);
    let (mut first, mut most) = (0, 0);
    for (last, difference) in differences.iter().enumerate() {
        while difference - differences[first] > EVENLY {
            first += 1;
        }
        most = most.max(last + 1 - first);
    }
    most as f64 >= EVEN_SHARE * differences.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use belvedere_data::raster::Raster;

    /// Terrain that rises by 1 m in 10 m from a level, in units of so many metres; and places on it, with as many on
    /// roofs.
    fn found(level: f64, unit: f64, offset: f64) -> Option<&'static str> {
        let height = |x: f64| level + 0.1 * x;
        #[expect(clippy::cast_possible_truncation, reason = "tests")]
        let node = |i: usize| (height((i % 30) as f64 * 10.0) / unit + offset) as f32;
        let heights = Raster::from_values(30, 30, (0..900).map(node).collect()).unwrap();
        let grid = ElevationGrid::new(heights, [0.0, 290.0], [10.0, 10.0]).unwrap();
        let place = |i: usize| {
            let (x, y) = (100.0 + (i % 20) as f64 * 4.0, 100.0 + (i / 20) as f64 * 4.0);
            let roof = if i.is_multiple_of(2) { 9.0 } else { 0.0 };
            [x, y, height(x) + roof]
        };
        remark_on_terrain(&grid, (0..400).map(place), 0.0).map(|remark| remark.key)
    }

    #[test]
    fn units_of_terrain_are_known_by_the_ground_of_the_scene() {
        let foot = belvedere_data::crs::INTERNATIONAL_FOOT;
        for level in [0.0, 5.0, 120.0, 1500.0] {
            assert_eq!(found(level, 1.0, 0.0), None, "{level}");
            assert_eq!(found(level, foot, 0.0), Some("terrain-in-feet"), "{level}");
            assert_eq!(found(level, 1.0 / foot, 0.0), Some("terrain-in-metres"), "{level}");
            // the geoid of the Netherlands lies 43 m above the ellipsoid
            assert_eq!(found(level, 1.0, 43.0), Some("terrain-heights-differ"), "{level}");
            // another zero
            assert_eq!(found(level, 1.0, 10.0), Some("terrain-heights-differ"), "{level}");
            assert_eq!(found(level, 1.0, -4.0), Some("terrain-heights-differ"), "{level}");
        }
    }
}
