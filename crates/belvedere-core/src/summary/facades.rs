//! Density of points on the walls of buildings, which airborne scans cover worst.

use belvedere_data::cast::to_i64;
use std::f64::consts::PI;

use rayon::prelude::*;

use crate::neighbors::NeighborIndex;
use crate::normals::estimate::{Neighborhood, estimate};
use belvedere_data::Result;
use belvedere_data::cloud::PointCloud;
use belvedere_data::control::{Control, Stop};

/// Class of points on buildings (ASPRS LAS 1.4, table 17).
const BUILDING: u8 = 6;
/// A surface counts as a wall where its normal rises or falls by less than this, as a sine: 17°.
const STEEPEST_NORMAL: f32 = 0.3;
/// Number of neighbours that give the area of wall that a point represents.
const NEIGHBORS: u8 = 8;
/// Maximum distance to the eighth neighbour on a wall of a point that represents wall, metres. At this distance a wall
/// has a tenth of a point per square metre, fewer than in any survey of buildings.
const MAX_REACH: f64 = 5.0;
/// Fewest points on walls, near each other, whose area is estimated.
const MIN_STEEP: usize = 50;
/// Building points looked at; of larger clouds every so manieth square is taken, so that this stays a matter of
/// seconds.
const MAX_POINTS: usize = 2_000_000;
/// Side of those squares, metres: a few houses, of which little is cut at the edge.
const SQUARE: f32 = 64.0;

/// Walls of the buildings in a cloud.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FacadeSummary {
    /// Building points that were looked at.
    pub building_point_count: usize,
    /// Number of them on steep surfaces.
    pub steep_point_count: usize,
    /// The walls; `None` where fewer than 50 of these lie near each other, which is too few to estimate them.
    pub walls: Option<Walls>,
}

/// Walls that points represent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Walls {
    /// Their area, m².
    pub area: f64,
    /// Points per square metre of it.
    pub density: f64,
}

impl FacadeSummary {
    /// Facade density of `cloud`; `None` where it has no points of class 6 (building).
    ///
    /// Points of class 6 are on a wall if the normal of their 16 neighbours of that class is within 17° of the horizon.
    /// Each represents an eighth of the disc that reaches to its eighth neighbour on a wall, unless that is farther
    /// than 5 m. On simulated scans a tenth of the wall points, near eaves and corners, is taken for roof, and the
    /// density is within a quarter of that of the walls above ground. Walls without any points do not count; roofs
    /// steeper than 73° do. Clouds of more than two million building points are sampled by a part of their area.
    ///
    /// # Errors
    /// Those of [`NeighborIndex::new`] and [`estimate`].
    pub fn of(cloud: &PointCloud, control: &Control<'_>) -> Result<Option<Self>> {
        let Some(classes) = cloud.attributes.classification.as_ref() else { return Ok(None) };
        let building_count = classes.iter().filter(|&&class| class == BUILDING).count();
        let stride = i64::try_from(building_count.div_ceil(MAX_POINTS)).unwrap_or(i64::MAX).max(1);
        let square = |v: f32| to_i64(f64::from((v / SQUARE).floor()));
        // Neighbouring squares of a row and of a column fall into different parts.
        let is_chosen = |p: &[f32; 3]| (square(p[0]) + 7 * square(p[1])).rem_euclid(stride) == 0;
        let buildings: Vec<[f32; 3]> = cloud
            .positions
            .iter()
            .zip(classes)
            .filter(|&(p, &class)| class == BUILDING && is_chosen(p))
            .map(|(&p, _)| p)
            .collect();
        let index = NeighborIndex::new(&buildings, control)?;
        let normals = estimate(&buildings, &index, Neighborhood::default(), control)?;
        drop(index);
        let steep: Vec<[f32; 3]> = buildings
            .iter()
            .zip(&normals.vectors)
            .filter(|(_, normal)| normal[2].abs() < STEEPEST_NORMAL && **normal != [0.0; 3])
            .map(|(&p, _)| p)
            .collect();
        let walls = walls_of(&steep, control)?;
        let (building_point_count, steep_point_count) = (buildings.len(), steep.len());
        Ok((building_point_count > 0).then_some(Self { building_point_count, steep_point_count, walls }))
    }
}

/// The surface that `points` lie on, or `None` for too few of them near each other or all in one spot.
fn walls_of(points: &[[f32; 3]], control: &Control<'_>) -> Result<Option<Walls>> {
    let stop = Stop::new(control);
    let count = usize::from(NEIGHBORS);
    if points.len() < MIN_STEEP {
        return Ok(None);
    }
    let index = NeighborIndex::new(points, control)?;
    let discs: Vec<f64> = points
        .par_iter()
        .map_init(Vec::new, |found, &point| {
            if stop.is_set() {
                return 0.0;
            }
            // the point itself comes first
            index.k_nearest(point, count + 1, found);
            found.last().map_or(0.0, |farthest| PI * f64::from(farthest.distance_squared))
        })
        .collect();
    stop.check()?;
    // in order, so that the sum is the same for any number of threads
    let near = || discs.iter().filter(|&&disc| disc <= PI * MAX_REACH * MAX_REACH);
    let (area, used) = (near().sum::<f64>() / f64::from(NEIGHBORS), near().count());
    Ok((area > 0.0 && used >= MIN_STEEP).then(|| Walls { area, density: used as f64 / area }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use belvedere_data::cloud::Attributes;
    use belvedere_data::random::uniform;
    use belvedere_data::vector::to_f32;

    /// Walls and roof of a box of 40 x 30 x 20 m, the roof with 4 points per m² and the walls with `density`, 2 cm
    /// rough.
    fn box_cloud(density: u32, class: u8) -> PointCloud {
        let mut positions = Vec::new();
        let mut number = 0;
        let mut random = || {
            number += 1;
            to_f32(uniform(4, number))
        };
        for _ in 0..4 * 40 * 30 {
            positions.push([40.0 * random(), 30.0 * random(), 20.0 + 0.02 * random()]);
        }
        for _ in 0..density * 140 * 20 {
            let (along, height, rough) = (140.0 * random(), 20.0 * random(), 0.02 * random());
            positions.push(match along {
                a if a < 40.0 => [a, rough, height],
                a if a < 70.0 => [40.0 + rough, a - 40.0, height],
                a if a < 110.0 => [a - 70.0, 30.0 + rough, height],
                a => [rough, a - 110.0, height],
            });
        }
        let classification = Some(vec![class; positions.len()]);
        PointCloud {
            positions,
            attributes: Attributes { classification, ..Attributes::default() },
            ..PointCloud::default()
        }
    }

    #[test]
    fn a_box_has_the_wall_area_of_a_box() {
        for density in [1, 3] {
            let facades = FacadeSummary::of(&box_cloud(density, 6), &Control::none()).unwrap().unwrap();
            // Points near the eaves have mixed neighbours: a strip as wide as these reach, up to a fifth of a wall of
            // 20 m at the lower density. The area loses those points, but discs at the edge reach beyond it.
            let walls = facades.walls.unwrap();
            assert!((0.8..1.1).contains(&(walls.area / 2800.0)), "{facades:?}");
            assert!((0.8..1.2).contains(&(walls.density / f64::from(density))), "{facades:?}");
            assert!(facades.steep_point_count > facades.building_point_count / 5);
        }
    }

    #[test]
    fn clouds_without_walls_or_buildings_have_no_facades() {
        assert_eq!(FacadeSummary::of(&PointCloud::default(), &Control::none()).unwrap(), None);
        assert_eq!(FacadeSummary::of(&box_cloud(1, 2), &Control::none()).unwrap(), None);
        let walls = |cloud: &PointCloud| FacadeSummary::of(cloud, &Control::none()).unwrap().unwrap().walls;
        assert_eq!(walls(&box_cloud(0, 6)), None);
        let mut spot = box_cloud(1, 6);
        spot.positions.iter_mut().for_each(|p| *p = [1.0, 2.0, 3.0]);
        assert_eq!(walls(&spot), None);
    }

    #[test]
    fn a_few_steep_points_far_apart_are_no_wall() {
        // three zigzags of 17 points, 9 m apart
        let mut cloud = box_cloud(0, 6);
        for pole in 0..3_i16 {
            for step in 0..17_i16 {
                cloud.positions.push([
                    400.0 + 700.0 * f32::from(pole),
                    9.0 * f32::from(step % 2),
                    9.0 * f32::from(step),
                ]);
            }
        }
        cloud.attributes.classification = Some(vec![6; cloud.positions.len()]);
        assert_eq!(FacadeSummary::of(&cloud, &Control::none()).unwrap().unwrap().walls, None);
    }
}
