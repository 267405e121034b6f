//! Fewer balls for the same surface.

use super::marking_rule::{MarkingRule, Phase};
use super::marks::{Cut, Marks, cut};
use super::survey::{BLOCK, Survey};
use crate::neighbors::NeighborIndex;
use crate::normals::OrientedCloud;
use belvedere_data::balls::{MedialBalls, NO_TOUCH};
use belvedere_data::cast::to_i64;
use belvedere_data::control::{Control, Stop};
use belvedere_data::vector::{dot, sub};
use belvedere_data::{Error, Result};
use rayon::prelude::*;
use std::cmp::Ordering;
use std::sync::atomic::{AtomicBool, Ordering as Memory};

/// Minimum cosine between the direction to a ball's centre and the inward normal for it to lie on the inner side.
const SAME_SIDE: f32 = 0.5;

/// Parameters of [`prune`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PruneParams {
    /// Maximum distance between a point and the surface of the ball that replaces its own, metres, 0 or more. Default
    /// 0.03: the noise of a range.
    pub deviation: f32,
}

impl Default for PruneParams {
    fn default() -> Self {
        Self { deviation: 0.03 }
    }
}

/// Leaves out balls that larger ones make superfluous, and returns how many. Row i of `balls` must be the interior ball
/// of point i of `oriented`, whose positions `index` holds; balls left out get [`NO_TOUCH`].
///
/// Larger balls come first; of equal ones, that with the point of smallest x, then y, then z. A ball is removed if its
/// point lies within [`PruneParams::deviation`] of the surface of a ball kept before, on its inner side. The remaining
/// balls therefore reach every point that had a ball, up to the deviation. Between points spaced by h, balls of radius
/// r fall short of their common tangent plane by h²/8r more.
///
/// Blocks of 64 m, counted from the origin of the reference system, are pruned independently. The result depends on
/// neither order nor number of threads, and on the tile only within its margin.
///
/// # Errors
/// [`Error::LengthMismatch`] where they differ in length, [`Error::Cancelled`].
///
/// # Source
/// This project's own greedy rule; medial balls chosen as a set cover of the surface are in Dou et al. 2022 (Coverage
/// Axis).
pub fn prune(
    balls: &mut MedialBalls,
    oriented: &OrientedCloud,
    index: &NeighborIndex,
    params: &PruneParams,
    control: &Control<'_>,
) -> Result<usize> {
    let cuts = superfluous(oriented.positions(), balls, oriented, index, params, control)?;
    cut(balls, oriented, &cuts);
    Ok(cuts.len())
}

impl MarkingRule for PruneParams {
    fn stage(&self) -> Option<(Phase, &'static str)> {
        Some((Phase::Balls, "pruning balls"))
    }

    fn marks(&self, survey: &Survey<'_>, balls: &MedialBalls, control: &Control<'_>) -> Result<Marks> {
        let cuts = superfluous(survey.measured, balls, survey.oriented, survey.index, self, control)?;
        Ok(Marks { counts: vec![("balls_superfluous", cuts.len())], cuts, ..Marks::default() })
    }
}

/// The balls that [`prune`] leaves out, by row. Blocks are those of `placed`, the points before they were moved.
fn superfluous(
    placed: &[[f32; 3]],
    balls: &MedialBalls,
    oriented: &OrientedCloud,
    index: &NeighborIndex,
    params: &PruneParams,
    control: &Control<'_>,
) -> Result<Vec<Cut>> {
    let stop = Stop::new(control);
    let expected = oriented.len();
    for (what, found) in [("balls", balls.len()), ("neighbour index", index.len()), ("places", placed.len())] {
        if found != expected {
            return Err(Error::LengthMismatch { what, expected, found });
        }
    }
    let (positions, normals) = (oriented.positions(), oriented.normals());
    let origin = oriented.origin();
    let block = |row: u32| -> [i64; 2] {
        let p = placed[row as usize];
        [0, 1].map(|axis| to_i64(((f64::from(p[axis]) + origin[axis]) / f64::from(BLOCK)).floor()))
    };
    let is_usable = |row: &u32| balls.touch[*row as usize] != NO_TOUCH && balls.radii[*row as usize] > 0.0;
    let mut rows: Vec<([i64; 2], u32)> =
        index.tree_order().iter().copied().filter(is_usable).map(|row| (block(row), row)).collect();
    let larger_first = |a: u32, b: u32| {
        let (a, b) = (a as usize, b as usize);
        let place = |axis: usize| positions[a][axis].total_cmp(&positions[b][axis]);
        let by_radius = balls.radii[b].total_cmp(&balls.radii[a]);
        (0..3).fold(by_radius, |order, axis| order.then(place(axis))).then(a.cmp(&b))
    };
    rows.par_sort_unstable_by(|a, b| match a.0.cmp(&b.0) {
        Ordering::Equal => larger_first(a.1, b.1),
        other => other,
    });
    // each block writes and reads its own points only
    let covered: Vec<AtomicBool> = (0..expected).map(|_| AtomicBool::new(false)).collect();
    let kept: Vec<u32> = rows
        .par_chunk_by(|a, b| a.0 == b.0)
        .flat_map_iter(|rows| {
            let mut kept = Vec::new();
            for &(of_block, row) in rows {
                if stop.is_set() {
                    break;
                }
                if covered[row as usize].load(Memory::Relaxed) {
                    continue;
                }
                kept.push(row);
                let (center, radius) = (balls.centers[row as usize], balls.radii[row as usize]);
                index.within_radius(center, radius + params.deviation, |found| {
                    let distance = found.distance_squared.sqrt();
                    let other = found.index as usize;
                    let inward = -dot(sub(center, positions[other]), normals[other]);
                    if distance >= radius - params.deviation
                        && inward >= SAME_SIDE * distance
                        && block(found.index) == of_block
                    {
                        covered[other].store(true, Memory::Relaxed);
                    }
                });
            }
            control.advance(rows.len());
            kept
        })
        .collect();
    stop.check()?;
    let mut is_kept = vec![false; expected];
    for &row in &kept {
        is_kept[row as usize] = true;
    }
    let left_out = rows.iter().filter(|(_, row)| !is_kept[*row as usize]);
    Ok(left_out.map(|&(_, row)| Cut { row: row as usize, radius: None }).collect())
}
