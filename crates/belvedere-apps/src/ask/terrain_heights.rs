//! Heights of far terrain against those of the scene: a raster in feet is known by its ratio.

use super::remark::Remark;
use belvedere_data::ElevationGrid;
use belvedere_data::cast::{to_i64, to_index};
use belvedere_data::contradiction::{FoundContradiction, GROUND_HEIGHTS, TERRAIN_HEIGHTS};
use belvedere_data::report::rounded;
use std::collections::HashMap;

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
/// Accuracy of a ratio, as a share of the difference that it explains: cells of 30 m on slopes.
const RATIO_ERROR: f64 = 0.02;
/// Maximum spread of the heights of the terrain less those of a level of the scene, metres, for an offset to be
/// significant: noise and grass, cells of 10 m on slopes, cells of 30 m in hills.
const SPREADS: [f64; 3] = [1.0, 2.0, 4.0];
/// Minimum ratio of places at the level of the ground to those in the next range above it, of the same height.
const MIN_PEAK: f64 = 2.0;
/// Share of the places that may lie below the ground, as noise and pits do: with more of them the level is another one.
const MAX_SHARE_BELOW: f64 = 0.05;
/// A raster further off than this differs whatever its spread, metres: the ellipsoid is further from the sea than
/// slopes between coarse cells err.
const DIFFERS: f64 = 12.0;

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
        differences.get(to_index(differences.len() as f64 * GROUND_SHARE)).copied().unwrap_or(0.0)
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
    let rises: Vec<f64> = pairs.iter().map(|[top, terrain]| terrain - top).collect();
    let offset = common_offset(rises).filter(|&offset| TERRAIN_HEIGHTS.is_exceeded_by(offset));
    match offset {
        Some(offset) => Remark::of_contradiction(differing(offset)),
        None if as_read > DIFFERS => {
            let text = format!(
                "the terrain lies {difference} m off the ground of the scene: are both heights above the same level, and in the same unit?"
            );
            Remark::of_contradiction(TERRAIN_HEIGHTS.found(text).with("difference_m", difference))
        }
        None => None,
    }
}

/// Side of the squares in which points of a cloud that shows the ground are compared, metres: as wide as streets are.
const SQUARE: f64 = 5.0;

/// A warning where the lowest of `ground` points, (N, 3), are not at the level of `places` on surfaces of a scene, both
/// local metres.
pub(super) fn remark_on_ground_cloud(
    ground: &[[f32; 3]],
    places: impl ExactSizeIterator<Item = [f64; 3]>,
) -> Option<Remark> {
    let square = |x: f64, y: f64| [x, y].map(|v| to_i64((v / SQUARE).floor()));
    let mut lowest: HashMap<[i64; 2], f64> = HashMap::new();
    for [x, y, z] in ground.iter().map(|p| p.map(f64::from)) {
        let own = lowest.entry(square(x, y)).or_insert(z);
        *own = own.min(z);
    }
    let mut below: HashMap<[i64; 2], f64> = HashMap::new();
    for [x, y, z] in places {
        let own = below.entry(square(x, y)).or_insert(z);
        *own = own.min(z);
    }
    let rises: Vec<f64> = below.iter().filter_map(|(square, top)| Some(lowest.get(square)? - top)).collect();
    if rises.len() < MIN_PLACES {
        return None;
    }
    let offset = common_offset(rises).filter(|&offset| GROUND_HEIGHTS.is_exceeded_by(offset))?;
    let by = rounded(offset, 1);
    let way = if by < 0.0 { "below" } else { "above" };
    let text = format!(
        "the cloud that shows the ground lies {} m {way} the ground of the scene wherever both are known: do both count heights from the same level, and in the same unit?",
        by.abs()
    );
    Remark::of_contradiction(GROUND_HEIGHTS.found(text).with("offset_m", by))
}

/// A terrain that lies by `offset` above the ground of the scene everywhere, metres.
fn differing(offset: f64) -> FoundContradiction {
    let by = rounded(offset, 1);
    let [size, way, sign] = if by < 0.0 {
        [rounded(-by, 1).to_string(), "below".to_owned(), "+".to_owned()]
    } else {
        [by.to_string(), "above".to_owned(), "-".to_owned()]
    };
    let text = format!(
        "the terrain lies {size} m {way} the ground of the scene wherever both are known: one of them may count from the ellipsoid and the other from the sea, or from another national zero; far hills are as wrong. Bring it to the heights of the cloud: gdal_calc.py -A IN.tif --calc=A{sign}{size} --outfile=OUT.tif"
    );
    TERRAIN_HEIGHTS.found(text).with("difference_m", rounded(offset.abs(), 1)).with("offset_m", by)
}

/// Returns the height of the terrain above the ground, from its heights less those of places. A share of the places
/// shows the ground; the others stand above it. `None` without a common offset.
fn common_offset(mut rises: Vec<f64>) -> Option<f64> {
    // from the lowest places upwards: what stands on the ground follows
    rises.sort_by(|a, b| b.total_cmp(a));
    let share = |part: f64| to_index(rises.len() as f64 * part);
    let (needed, below) = (share(GROUND_SHARE).max(1), share(MAX_SHARE_BELOW));
    SPREADS.into_iter().find_map(|spread| {
        let is_level = |start: &usize| rises.get(start + needed - 1).is_some_and(|last| rises[*start] - last <= spread);
        let start = (0..=below).find(is_level)?;
        let within = |depth: f64| start + rises[start..].partition_point(|rise| rises[start] - rise <= depth);
        let (end, next) = (within(spread), within(2.0 * spread));
        // slopes and crowns are spread evenly, and have no level
        let is_apart = (end - start) as f64 >= MIN_PEAK * (next - end) as f64;
        rises.get(usize::midpoint(start, end - 1)).copied().filter(|offset| is_apart && offset.abs() > spread)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use belvedere_data::raster::Raster;
    use belvedere_data::vector::to_f32;

    /// Terrain that rises by 1 m in 10 m from a level, in units of so many metres; and places on it, with as many on
    /// roofs.
    fn found(level: f64, unit: f64, offset: f64) -> Option<&'static str> {
        remark_of(level, unit, offset).map(|remark| remark.key)
    }

    fn remark_of(level: f64, unit: f64, offset: f64) -> Option<Remark> {
        let height = |x: f64| level + 0.1 * x;
        let node = |i: usize| to_f32(height((i % 30) as f64 * 10.0) / unit + offset);
        let heights = Raster::from_values(30, 30, (0..900).map(node).collect()).unwrap();
        let grid = ElevationGrid::new(heights, [0.0, 290.0], [10.0, 10.0]).unwrap();
        let place = |i: usize| {
            let (x, y) = (100.0 + (i % 20) as f64 * 4.0, 100.0 + (i / 20) as f64 * 4.0);
            let roof = if i.is_multiple_of(2) { 9.0 } else { 0.0 };
            [x, y, height(x) + roof]
        };
        remark_on_terrain(&grid, (0..400).map(place), 0.0)
    }

    #[test]
    fn ground_of_another_level_is_said() {
        let ground = |rise: f64| -> Vec<[f32; 3]> {
            let at = |i: i32| [f64::from(i % 100), f64::from(i / 100)];
            (0..10_000).map(|i| [to_f32(at(i)[0]), to_f32(at(i)[1]), to_f32(0.05 * at(i)[0] + rise)]).collect()
        };
        let place = |i: i32| {
            let [x, y] = [f64::from(i % 50) * 2.0, f64::from(i / 50) * 2.0];
            [x, y, 0.05 * x + if (20.0..40.0).contains(&x) { 9.0 } else { 0.0 }]
        };
        let said = |rise: f64| remark_on_ground_cloud(&ground(rise), (0..2500).map(place));
        assert_eq!(said(0.0), None);
        assert_eq!(said(1.0), None);
        for rise in [43.0, 5.0, -3.0] {
            let remark = said(rise).unwrap_or_else(|| panic!("{rise}"));
            assert_eq!(remark.key, "ground-heights-differ");
            assert!((remark.numbers[0].1 - rise).abs() < 0.3, "{remark:?}");
        }
    }

    #[test]
    fn canopies_and_slopes_between_coarse_cells_tell_no_offset() {
        // one place in twenty-five on the ground, the others in crowns 9 to 21 m above it
        let below = |i: usize| if i.is_multiple_of(25) { 0.0 } else { -9.0 - (i % 13) as f64 };
        assert_eq!(common_offset((0..400).map(below).collect()), None);
        // cells that err by up to 9 m on steep slopes
        assert_eq!(common_offset((0..400).map(|i| 18.0 * f64::from(i) / 399.0 - 9.0).collect()), None);
        // a tenth is pits below the level: it is not the lowest
        let pits = |i: usize| if i.is_multiple_of(10) { 9.0 + (i % 7) as f64 } else { 0.1 * (i % 5) as f64 };
        assert_eq!(common_offset((0..400).map(pits).collect()), None);
    }

    #[test]
    fn units_of_terrain_are_known_by_the_ground_of_the_scene() {
        let foot = belvedere_data::crs::INTERNATIONAL_FOOT;
        for level in [0.0, 5.0, 120.0, 1500.0] {
            assert_eq!(found(level, 1.0, 0.0), None, "{level}");
            assert_eq!(found(level, foot, 0.0), Some("terrain-in-feet"), "{level}");
            assert_eq!(found(level, 1.0 / foot, 0.0), Some("terrain-in-metres"), "{level}");
            // the geoid of the Netherlands lies 43 m above the ellipsoid; national zeros differ by 2 to 12 m
            for offset in [43.0, 12.0, 6.0, 3.0, -3.0, -11.0, -40.0] {
                let remark = remark_of(level, 1.0, offset).unwrap_or_else(|| panic!("{level} {offset}"));
                assert_eq!(remark.key, "terrain-heights-differ", "{level} {offset}");
                let numbers = |name: &str| remark.numbers.iter().find(|(own, _)| *own == name).map(|(_, v)| *v);
                assert_eq!(numbers("offset_m"), Some(offset), "{level}: {remark:?}");
            }
            assert_eq!(found(level, 1.0, 1.5), None, "{level}");
        }
    }
}
