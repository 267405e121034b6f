//! The unit of a cloud that names none: rooms tell it by their height, towns by the distance of points on walls.

use super::room::{may_be_room, unit_of_room_contradiction};
use crate::neighbors::NeighborIndex;
use crate::normals::estimate::{Neighborhood, estimate};
use belvedere_data::contradiction::{COORDINATES_IN_DEGREES, FoundContradiction, UNIT_OF_SURVEY};
use belvedere_data::control::Control;
use belvedere_data::report::rounded;
use belvedere_data::{Bounds, Result};

/// A surface is upright where the third component of its normal is less than this: within 12° of the plumb line.
const UPRIGHT: f32 = 0.2;
/// Least share of the points on such surfaces. Surveys of towns from the air have 2 to 10 %; terrain with points metres
/// apart has none, since cliffs between two of its points are slopes.
const MIN_UPRIGHT_SHARE: f64 = 0.02;
/// Minimum ratio of height and width of a cloud whose width is in degrees: a town has a kilometre in a hundredth of a
/// degree. Then the minimum number of its points.
const MIN_SLENDERNESS: f32 = 20.0;
const MIN_POINTS: usize = 100;
/// Minimum height of such a cloud, metres: less is a pile of points in one place.
const MIN_HEIGHT: f32 = 1.0;
/// Points of which the distance to the next one is measured.
const SAMPLE: usize = 1000;

/// Returns the contradiction between metres and a cloud, (N, 3), without a named unit. Normals are estimated here:
/// those of a model are none where points are far apart.
///
/// # Errors
/// Those of [`NeighborIndex::new`] and [`estimate`].
pub fn unit_contradiction_of(positions: &[[f32; 3]], control: &Control<'_>) -> Result<Option<FoundContradiction>> {
    let Some(bounds) = Bounds::around(positions.iter().copied()) else { return Ok(None) };
    if let Some(found) = degrees_contradiction(&bounds, positions.len()) {
        return Ok(Some(found));
    }
    // normals are worth their time where the extent of the cloud can be in another unit
    let is_sparse = UNIT_OF_SURVEY.is_exceeded_by(mean_spacing(&bounds, positions.len()));
    if !is_sparse && !may_be_room(&bounds) {
        return Ok(None);
    }
    let index = NeighborIndex::new(positions, control)?;
    let normals = estimate(positions, &index, Neighborhood::default(), control)?;
    let of_room = unit_of_room_contradiction(positions, &normals.vectors);
    Ok(of_room.or_else(|| unit_of_survey_contradiction(positions, &normals.vectors, &index)))
}

/// Returns the contradiction between metres and the extents of a cloud, where x and y look like degrees.
fn degrees_contradiction(bounds: &Bounds, count: usize) -> Option<FoundContradiction> {
    let [width, depth, height] = bounds.size();
    let side = width.max(depth);
    let is_volume = width.min(depth) > 0.0 && height >= MIN_HEIGHT;
    if count < MIN_POINTS
        || !is_volume
        || COORDINATES_IN_DEGREES.is_exceeded_by(side.into())
        || height < MIN_SLENDERNESS * side
    {
        return None;
    }
    let text = format!(
        "all points lie within {width:.5} by {depth:.5} m on the map, and are {height:.1} m high: x and y look like \
         longitude and latitude in degrees; bring the cloud to a system in metres first, such as UTM"
    );
    Some(COORDINATES_IN_DEGREES.found(text).with("width", width.into()).with("depth", depth.into()))
}

/// Distance between points that lie evenly on the map.
fn mean_spacing(bounds: &Bounds, count: usize) -> f64 {
    let [width, depth, _] = bounds.size().map(f64::from);
    (width * depth / count.max(1) as f64).sqrt()
}

fn unit_of_survey_contradiction(
    positions: &[[f32; 3]],
    normals: &[[f32; 3]],
    index: &NeighborIndex,
) -> Option<FoundContradiction> {
    let upright = normals.iter().filter(|normal| **normal != [0.0; 3] && normal[2].abs() < UPRIGHT).count();
    let share = upright as f64 / positions.len() as f64;
    let spacing = median_spacing(positions, index)?;
    if share < MIN_UPRIGHT_SHARE || !UNIT_OF_SURVEY.is_exceeded_by(spacing) {
        return None;
    }
    let text = format!(
        "points lie {} m apart, and {} % of them on upright surfaces, which no survey shows from so few: this cloud \
         looks like one in millimetres or centimetres, and was read in metres; give its unit: \
         --crs 'LOCAL_CS[\"site\",UNIT[\"millimetre\",0.001]]'",
        rounded(spacing, 1),
        rounded(100.0 * share, 1)
    );
    Some(UNIT_OF_SURVEY.found(text).with("spacing_m", spacing))
}

/// Median distance of some of the points to the nearest other one.
fn median_spacing(positions: &[[f32; 3]], index: &NeighborIndex) -> Option<f64> {
    let step = positions.len().div_ceil(SAMPLE).max(1);
    let mut nearest = Vec::new();
    let mut found = Vec::new();
    for &position in positions.iter().step_by(step) {
        // the first one is the point itself
        index.k_nearest(position, 2, &mut found);
        nearest.extend(found.get(1).map(|neighbor| f64::from(neighbor.distance_squared).sqrt()));
    }
    if nearest.is_empty() {
        return None;
    }
    let middle = nearest.len() / 2;
    Some(*nearest.select_nth_unstable_by(middle, f64::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use belvedere_data::cast::to_f32;
    use belvedere_data::random::uniform;

    fn unit_says(positions: &[[f32; 3]]) -> Option<&'static str> {
        unit_contradiction_of(positions, &Control::none()).unwrap().map(|found| found.row.key)
    }

    fn random(seed: u64, i: u64) -> f32 {
        to_f32(uniform(seed, i))
    }

    /// Level ground of 60 by 50 m with a house of 12 by 10 m and 8 m, two points for each square metre.
    fn house(scale: f32) -> Vec<[f32; 3]> {
        let ground = (0..6000).map(|i| {
            let [x, y] = [60.0 * random(1, i), 50.0 * random(2, i)];
            let is_house = (20.0..32.0).contains(&x) && (20.0..30.0).contains(&y);
            [x, y, if is_house { 8.0 } else { 0.0 }]
        });
        let walls = (0..700).map(|i| {
            let [along, height] = [44.0 * random(3, i), 8.0 * random(4, i)];
            match along {
                a if a < 12.0 => [20.0 + a, 20.0, height],
                a if a < 24.0 => [20.0 + (a - 12.0), 30.0, height],
                a if a < 34.0 => [20.0, 20.0 + (a - 24.0), height],
                a => [32.0, 20.0 + (a - 34.0), height],
            }
        });
        ground.chain(walls).map(|p| p.map(|v| scale * v)).collect()
    }

    #[test]
    fn a_town_in_millimetres_is_no_terrain() {
        assert_eq!(unit_says(&house(1.0)), None);
        assert_eq!(unit_says(&house(3.28)), None);
        assert_eq!(unit_says(&house(100.0)), Some("unit-of-survey"));
        assert_eq!(unit_says(&house(1000.0)), Some("unit-of-survey"));
        // terrain on a grid of 25 m, with slopes of up to 60 degrees
        let height = |x: f32, y: f32| 1000.0 + 350.0 * ((x / 200.0).sin() + (y / 260.0).cos());
        let terrain: Vec<[f32; 3]> = (0..120)
            .flat_map(|i| (0..120).map(move |j| (25.0 * i as f32, 25.0 * j as f32)))
            .map(|(x, y)| [x, y, height(x, y)])
            .collect();
        assert_eq!(unit_says(&terrain), None);
        assert_eq!(unit_says(&[]), None);
    }

    #[test]
    fn longitude_and_latitude_are_no_metres() {
        // a degree of longitude at 52 degrees is 68.5 km long, and one of latitude 111.2 km
        let degrees: Vec<[f32; 3]> = house(1.0).iter().map(|[x, y, z]| [x / 68_500.0, y / 111_200.0, *z]).collect();
        assert_eq!(unit_says(&degrees), Some("coordinates-in-degrees"));
        // a rod of 6 cm
        let rod: Vec<[f32; 3]> =
            (0..2000).map(|i| [0.06 * random(5, i), 0.06 * random(6, i), 2.0 * random(7, i)]).collect();
        assert_eq!(unit_says(&rod), None);
    }
}
