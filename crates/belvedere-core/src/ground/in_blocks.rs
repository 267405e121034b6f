//! Ground found block by block, so that a part of a survey gives the same ground as the whole.

use super::find::{FinderParams, find_ground};
use belvedere_data::cast::to_i64;
use belvedere_data::control::Control;
use belvedere_data::{Attributes, Error, PointCloud, Result};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Side of the blocks, metres, on the grid of the reference system.
const BLOCK: f64 = 64.0;
/// Margin around a block within which points are used, metres: more than half the widest building.
const MARGIN: f64 = 48.0;

/// Radius around a point within which others decide whether it is ground, metres.
pub(crate) const GROUND_REACH: f64 = BLOCK + MARGIN;

/// Flags the ground points of a cloud by [`find_ground`], in blocks of 64 m with 48 m around them. A block without
/// ground has no ground points.
///
/// # Errors
/// [`Error::Cancelled`].
pub(crate) fn ground_in_blocks(cloud: &PointCloud, control: &Control<'_>) -> Result<Vec<bool>> {
    let mut blocks: BTreeMap<[i64; 2], Vec<u32>> = BTreeMap::new();
    for (row, p) in (0_u32..).zip(&cloud.positions) {
        blocks.entry([0, 1].map(|axis| number(place(p, cloud, axis)))).or_default().push(row);
    }
    let numbers: Vec<[i64; 2]> = blocks.keys().copied().collect();
    let found: Vec<Result<Vec<u32>>> = numbers.par_iter().map(|&at| of_block(cloud, &blocks, at, control)).collect();
    let mut is_ground = vec![false; cloud.len()];
    for rows in found {
        for row in rows? {
            if let Some(is_ground) = is_ground.get_mut(row as usize) {
                *is_ground = true;
            }
        }
    }
    Ok(is_ground)
}

/// A coordinate of the reference system, metres.
fn place(p: &[f32; 3], cloud: &PointCloud, axis: usize) -> f64 {
    f64::from(p[axis]) + cloud.frame.origin[axis]
}

/// Number of the block of a coordinate.
fn number(v: f64) -> i64 {
    to_i64((v / BLOCK).floor())
}

/// Rows of the ground of a block.
fn of_block(
    cloud: &PointCloud,
    blocks: &BTreeMap<[i64; 2], Vec<u32>>,
    [x, y]: [i64; 2],
    control: &Control<'_>,
) -> Result<Vec<u32>> {
    control.check()?;
    let is_near = |row: &u32| {
        let Some(p) = cloud.positions.get(*row as usize) else { return false };
        [x, y].iter().enumerate().all(|(axis, &number)| {
            let low = number as f64 * BLOCK;
            (low - MARGIN..low + BLOCK + MARGIN).contains(&place(p, cloud, axis))
        })
    };
    let about = (y - 1..=y + 1).flat_map(|y| (x - 1..=x + 1).map(move |x| [x, y]));
    let mut rows: Vec<u32> = about.filter_map(|at| blocks.get(&at)).flatten().copied().filter(is_near).collect();
    // in an order that follows from positions: of points equally low in a cell the first counts
    let position = |row: u32| cloud.positions.get(row as usize).copied().unwrap_or_default();
    rows.sort_unstable_by(|&a, &b| {
        let (p, q) = (position(a), position(b));
        (0..3).fold(std::cmp::Ordering::Equal, |order, axis| order.then(p[axis].total_cmp(&q[axis])))
    });
    let of_rows = |column: &Option<Vec<u8>>| {
        column.as_ref().map(|v| rows.iter().map(|&row| v.get(row as usize).copied().unwrap_or_default()).collect())
    };
    let attributes = Attributes {
        classification: of_rows(&cloud.attributes.classification),
        flags: of_rows(&cloud.attributes.flags),
        ..Attributes::default()
    };
    let positions = rows.iter().map(|&row| position(row)).collect();
    let part = PointCloud { frame: cloud.frame.clone(), positions, attributes, ..PointCloud::default() };
    let own = |row: &u32| {
        let p = position(*row);
        [0, 1].map(|axis| number(place(&p, cloud, axis))) == [x, y]
    };
    match find_ground(&part, &FinderParams::default(), control) {
        Ok(found) => Ok(found.iter().filter_map(|&row| rows.get(row as usize)).copied().filter(own).collect()),
        Err(Error::Cancelled) => Err(Error::Cancelled),
        // none here, or too wide for cells
        Err(_) => Ok(Vec::new()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A slope of 160 m with halls of 30 m, a point each metre, in an order that mixes them.
    fn town() -> PointCloud {
        let mut cloud = PointCloud::default();
        cloud.frame.origin = [1000.0, 2000.0, 0.0];
        for i in 0..25_600_u32 {
            let i = i * 7919 % 25_600;
            let [x, y] = [i % 160, i / 160].map(|v| f32::from(u16::try_from(v).unwrap()));
            let is_hall = x % 50.0 < 30.0 && y % 50.0 < 30.0;
            cloud.positions.push([x, y, 0.05 * x + if is_hall { 6.0 } else { 0.0 }]);
        }
        cloud
    }

    #[test]
    fn halls_are_no_ground_and_a_part_finds_what_the_whole_finds() {
        let cloud = town();
        let whole = ground_in_blocks(&cloud, &Control::none()).unwrap();
        let is_hall = |p: &[f32; 3]| p[2] > 0.05 * p[0] + 3.0;
        let wrong = cloud.positions.iter().zip(&whole).filter(|(p, ground)| is_hall(p) == **ground).count();
        assert!(wrong < cloud.len() / 100, "{wrong}");
        // the block from 1024 to 1088 east and 2048 to 2112 north, and all about it
        let near = |v: f32, low: f32| (low - 48.0..low + 112.0).contains(&v);
        let is_near = |row: &u32| {
            let p = cloud.positions[*row as usize];
            near(p[0] + 1000.0, 1024.0) && near(p[1] + 2000.0, 2048.0)
        };
        let rows: Vec<u32> = (0..25_600).rev().filter(is_near).collect();
        let part = ground_in_blocks(&cloud.select(&rows), &Control::none()).unwrap();
        let mut compared = 0;
        for (&row, ground) in rows.iter().zip(part) {
            let p = cloud.positions[row as usize];
            if (24.0..88.0).contains(&p[0]) && (48.0..112.0).contains(&p[1]) {
                assert_eq!(ground, whole[row as usize], "{p:?}");
                compared += 1;
            }
        }
        assert_eq!(compared, 64 * 64);
    }
}
