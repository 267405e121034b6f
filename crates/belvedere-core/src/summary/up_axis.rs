//! Test of whether a cloud stands on its third axis, as surveys do, or lies on its side.

use super::room::{ALONG, is_room_along_y};
use crate::neighbors::NeighborIndex;
use crate::normals::estimate::{Neighborhood, estimate};
use belvedere_data::cloud::PointCloud;
use belvedere_data::control::Control;
use belvedere_data::crs::CrsKind;
use belvedere_data::{Bounds, Result};

/// Minimum share of the points on flat surfaces along y of a cloud whose y is up: ground is half of most clouds.
const MIN_SHARE: f64 = 0.15;
/// Minimum ratio of these points to those on flat surfaces along z: walls along one axis are no more than ground and
/// roofs.
const MIN_RATIO: f64 = 3.0;
/// Maximum height of such a cloud, as a share of its extent along x and z.
const MAX_HEIGHT: f32 = 0.75;

/// Returns true if `positions`, (N, 3), with unit `normals`, (N, 3), zero where a point has none, look as if y were up.
/// Most flat surfaces then face along y, few along z, and the cloud is lowest along y. Or it is a room whose floor and
/// ceiling face along y.
#[must_use]
pub fn looks_y_up(positions: &[[f32; 3]], normals: &[[f32; 3]]) -> bool {
    let along = |axis: usize| normals.iter().filter(|normal| normal[axis].abs() > ALONG).count() as f64;
    let [y, z] = [along(1), along(2)];
    let is_flat = is_lowest_along_y(positions) && y >= MIN_SHARE * normals.len() as f64 && y > MIN_RATIO * z;
    is_flat && y > 0.0 || is_room_along_y(positions, normals)
}

/// The same of a cloud whose normals are not known yet. Clouds with a reference system have z up.
///
/// # Errors
/// Those of [`NeighborIndex::new`] and [`estimate`].
pub fn cloud_looks_y_up(cloud: &PointCloud, control: &Control<'_>) -> Result<bool> {
    if cloud.frame.crs.kind != CrsKind::Unknown || !may_lie(&cloud.positions) {
        return Ok(false);
    }
    let index = NeighborIndex::new(&cloud.positions, control)?;
    let normals = estimate(&cloud.positions, &index, Neighborhood::default(), control)?;
    Ok(looks_y_up(&cloud.positions, &normals.vectors))
}

fn is_lowest_along_y(positions: &[[f32; 3]]) -> bool {
    extent_of(positions).is_some_and(|[x, y, z]| y < MAX_HEIGHT * x.min(z))
}

/// Returns true if the normals need a test: y is the shortest side.
fn may_lie(positions: &[[f32; 3]]) -> bool {
    extent_of(positions).is_some_and(|[x, y, z]| y < x.min(z))
}

fn extent_of(positions: &[[f32; 3]]) -> Option<[f32; 3]> {
    let Bounds { low, high } = Bounds::around(positions.iter().copied())?;
    Some([0, 1, 2].map(|axis: usize| high[axis] - low[axis]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use belvedere_data::random::uniform;
    use belvedere_data::vector::to_f32;

    /// Level ground of 60 by 50 m with a house of 12 by 10 m and 8 m on it, z up.
    fn house() -> PointCloud {
        let mut positions = Vec::new();
        let random = |seed: u64, i: u64| to_f32(uniform(seed, i));
        for i in 0..12_000 {
            let [x, y] = [60.0 * random(1, i), 50.0 * random(2, i)];
            let on_house = (20.0..32.0).contains(&x) && (20.0..30.0).contains(&y);
            positions.push([x, y, if on_house { 8.0 } else { 0.0 }]);
        }
        for i in 0..1500 {
            let [along, height] = [44.0 * random(3, i), 8.0 * random(4, i)];
            positions.push(match along {
                a if a < 12.0 => [20.0 + a, 20.0, height],
                a if a < 24.0 => [20.0 + (a - 12.0), 30.0, height],
                a if a < 34.0 => [20.0, 20.0 + (a - 24.0), height],
                a => [32.0, 20.0 + (a - 34.0), height],
            });
        }
        PointCloud { positions, ..PointCloud::default() }
    }

    fn looks(cloud: &PointCloud) -> bool {
        cloud_looks_y_up(cloud, &Control::none()).unwrap()
    }

    #[test]
    fn a_cloud_on_its_side_is_known_by_its_flat_surfaces() {
        let upright = house();
        assert!(!looks(&upright));
        let mut turned = upright.clone();
        turned.positions.iter_mut().for_each(|[_, y, z]| (*y, *z) = (*z, -*y));
        assert!(looks(&turned));
        // a survey says which axis is up
        turned.frame.crs.kind = CrsKind::Projected;
        assert!(!looks(&turned));
        // rooms are as high as wide, and have as many walls as floors
        let room: Vec<[f32; 3]> = upright.positions.iter().map(|[x, y, z]| [x / 12.0, z / 2.0, y / 12.0]).collect();
        assert!(!looks(&PointCloud { positions: room, ..PointCloud::default() }));
        assert!(!looks(&PointCloud::default()));
    }
}
