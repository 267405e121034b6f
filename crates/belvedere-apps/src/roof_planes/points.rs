//! Selection of the points of roofs.

use super::BUILDING;
use belvedere_core::ground::Ground;
use belvedere_data::{Error, PointCloud, Result};

/// ASPRS classes that are no roofs: ground, low to high vegetation, noise, water, rail, road, wires and towers,
/// bridges, and high noise.
const NO_ROOFS: [u8; 15] = [2, 3, 4, 5, 7, 9, 10, 11, 13, 14, 15, 16, 17, 18, 19];
/// Height above the ground from which something is a roof where classes do not tell, metres: that of low sheds.
const MIN_HEIGHT: f64 = 2.0;
/// One point in so many must be classed as a building for that class to be believed.
const FEW: usize = 1000;

/// Side of the cells of the ground that roofs are separated from, metres.
pub const GROUND_CELL: f64 = 1.0;

/// Criterion that separates roofs from other objects.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RoofsFrom {
    /// Class of buildings.
    Class,
    /// Height above the ground.
    Height,
}

/// Returns the rows of the points of `cloud` that may lie on roofs, ascending. These are points of class 6, if at least
/// one in a thousand has it. Otherwise they are points at least 2 m above `ground` without another class.
///
/// # Errors
/// [`Error::NoPoints`] where there is none.
pub fn roof_points(cloud: &PointCloud, ground: &Ground) -> Result<(Vec<u32>, RoofsFrom)> {
    let classes = cloud.attributes.classification.as_deref().unwrap_or_default();
    let classed: Vec<u32> =
        (0_u32..).zip(classes).filter(|(_, class)| **class == BUILDING).map(|(row, _)| row).collect();
    if !classed.is_empty() && classed.len() >= cloud.len().div_ceil(FEW) {
        return Ok((classed, RoofsFrom::Class));
    }
    let is_high = |row: usize, p: &[f32; 3]| {
        let [x, y, z] = p.map(f64::from);
        let other = classes.get(row).is_some_and(|class| NO_ROOFS.contains(class));
        !other && ground.height_at([x, y]).is_some_and(|height| z - height >= MIN_HEIGHT)
    };
    let high: Vec<u32> = (0_u32..)
        .zip(cloud.positions.iter().enumerate())
        .filter(|(_, (row, p))| is_high(*row, p))
        .map(|(row, _)| row)
        .collect();
    if high.is_empty() {
        let what = "there are no roofs: no point has class 6 (building) or is 2 m above the ground".to_owned();
        return Err(Error::NoPoints { what });
    }
    Ok((high, RoofsFrom::Height))
}
