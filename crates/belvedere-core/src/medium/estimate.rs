//! The extinction of each voxel, from the returns of pulses.

use super::blocks::{BlockTable, SIDE, VOXELS, block_of, place_in_block};
use super::walk::GridLine;
use belvedere_data::cast::{to_f32, to_i32, to_u32};
use belvedere_data::control::{Control, Stop};
use belvedere_data::medium::{ExtinctionVoxels, MAX_EXTINCTION, VOXEL_SIDE};
use belvedere_data::vector::unit;
use belvedere_data::{Error, Result};
use rayon::prelude::*;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU32, Ordering};

/// Parts of a pulse, and of a metre, that hits and paths are counted in. Whole numbers add up to the same in any order.
const STEPS: f64 = 1024.0;
/// Returns handed to a thread at once.
const CHUNK: usize = 4096;

/// How extinction is estimated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MediumParams {
    /// Path through a voxel that its surroundings count for, metres, above 0. Default 2; 1 and 4 measure the same.
    pub own_path: f64,
    /// Path through the 27 voxels around one that [`MediumParams::mean`] counts for, metres, above 0. Default 5; 2
    /// measures the same.
    pub near_path: f64,
    /// Extinction that voxels without paths tend to, per metre, 0 or more. Default 0.15, between the means of voxels
    /// with returns, 0.27, and of all voxels around these, 0.09, of eleven photographed plots; 0.05 to 0.3 measure the
    /// same.
    pub mean: f64,
}

impl Default for MediumParams {
    fn default() -> Self {
        Self { own_path: 2.0, near_path: 5.0, mean: 0.15 }
    }
}

/// What a return tells of plants.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PlantReturn {
    /// It came from something else: its way to there was free.
    #[default]
    Elsewhere,
    /// It came from a plant if it lies among plants.
    Perhaps,
    /// It came from a plant.
    Plant,
}

/// Returns of pulses. Columns have a row for each.
#[derive(Clone, Copy)]
pub struct PlantReturns<'a> {
    /// Where they lie, (N, 3) local metres.
    pub positions: &'a [[f32; 3]],
    /// Where the scanner was, (N, 3) local metres, NaN where that is unknown and pulses are taken for upright; empty
    /// where it is unknown of all.
    pub scanner: &'a [[f32; 3]],
    /// Number of returns of their pulses; `None` where each is the only one.
    pub return_count: Option<&'a [u8]>,
    /// What they tell of plants.
    pub kinds: &'a [PlantReturn],
    /// Zero of local positions, metres of the reference system.
    pub origin: [f64; 3],
}

/// What pulses did in a voxel, in steps.
#[derive(Clone, Copy, Default)]
struct Counts {
    hits: u64,
    path: u64,
}

/// Extinction in all voxels with a plant and those around them: the maximum likelihood of hits among the paths of
/// pulses, shrunk towards the surroundings and the mean. A return is 1/n of a pulse of n returns; it travelled free
/// from the scanner to where it
/// stopped. The order of returns and the number of threads make no difference.
///
/// # Errors
/// [`Error::LengthMismatch`] for columns of unequal length, [`Error::Cancelled`].
///
/// # Source
/// Pimont, Allard, Soma & Dupuy 2018, "Estimators and confidence intervals for plant area density at voxel scale with
/// T-LiDAR", Remote Sensing of Environment 215; Vincent et al. 2021, AMAPVox. The prior is Gamma: its posterior mean
/// adds hits and path.
pub fn estimate(returns: &PlantReturns<'_>, params: &MediumParams, control: &Control<'_>) -> Result<ExtinctionVoxels> {
    let expected = returns.positions.len();
    let optional = |found: usize| if found == 0 { expected } else { found };
    let counts = returns.return_count.map_or(0, <[u8]>::len);
    for (what, found) in [
        ("kinds of returns", returns.kinds.len()),
        ("scanner positions", optional(returns.scanner.len())),
        ("numbers of returns", optional(counts)),
    ] {
        if found != expected {
            return Err(Error::LengthMismatch { what, expected, found });
        }
    }
    let grid = Grid::of(returns);
    let (hits, paths) = grid.counted(returns, control)?;
    let counts_at = |voxel: [i32; 3]| match grid.table.find(block_of(voxel)) {
        Some(at) => {
            let place = at * VOXELS + place_in_block(voxel);
            let read = |of: &[AtomicU32]| u64::from(of[place].load(Ordering::Relaxed));
            Counts { hits: read(&hits), path: read(&paths) }
        }
        None => Counts::default(),
    };
    let extinction = |voxel: &[i32; 3]| {
        let own = counts_at(*voxel);
        let near = around(*voxel)
            .map(counts_at)
            .fold(Counts::default(), |sum, one| Counts { hits: sum.hits + one.hits, path: sum.path + one.path });
        let shrunk = |counts: Counts, towards: f64, path: f64| {
            (counts.hits as f64 / STEPS + path * towards) / (counts.path as f64 / STEPS + path)
        };
        let around = shrunk(near, params.mean, params.near_path);
        let found = to_f32(shrunk(own, around, params.own_path) / VOXEL_SIDE);
        found.clamp(0.0, MAX_EXTINCTION)
    };
    let voxels = grid.near_plants();
    let extinction = voxels.par_iter().with_min_len(CHUNK).map(extinction).collect();
    control.check()?;
    let voxels = voxels.iter().map(|voxel| std::array::from_fn(|axis| voxel[axis] + grid.base[axis])).collect();
    Ok(ExtinctionVoxels { voxels, extinction })
}

/// A voxel and the 26 around it.
fn around(voxel: [i32; 3]) -> impl Iterator<Item = [i32; 3]> {
    (0..27).map(move |number| {
        let offset = [number % 3 - 1, number / 3 % 3 - 1, number / 9 - 1];
        std::array::from_fn(|axis| voxel[axis] + offset[axis])
    })
}

/// The voxels around plants.
struct Grid {
    /// Number of the voxel that others are counted from: near the origin, so that local positions keep all digits.
    base: [i32; 3],
    /// From local positions to places on the grid: what is added.
    shift: [f64; 3],
    /// Blocks that hold plants or lie beside them.
    table: BlockTable,
    /// Voxels with plants, ascending.
    plants: Vec<[i32; 3]>,
}

impl Grid {
    fn of(returns: &PlantReturns<'_>) -> Self {
        let base = returns.origin.map(|v| (v / VOXEL_SIDE).floor());
        let shift = std::array::from_fn(|axis| returns.origin[axis] / VOXEL_SIDE - base[axis]);
        let base = base.map(to_i32);
        let mut grid = Self { base, shift, table: BlockTable::default(), plants: Vec::new() };
        let is_plant = |(_, kind): &(&[f32; 3], &PlantReturn)| **kind == PlantReturn::Plant;
        let rows = returns.positions.par_iter().zip(returns.kinds);
        grid.plants = rows.filter(is_plant).map(|(p, _)| grid.voxel(grid.place(*p))).collect();
        grid.plants.par_sort_unstable();
        grid.plants.dedup();
        let corners = |voxel: &[i32; 3]| {
            let [low, high] = [-1, 1].map(|by| block_of(voxel.map(|v| v + by)));
            (0..8).map(move |bits: i32| {
                std::array::from_fn(|axis| if bits >> axis & 1 == 1 { high[axis] } else { low[axis] })
            })
        };
        let mut blocks: Vec<[i32; 3]> = grid.plants.iter().flat_map(corners).collect();
        blocks.sort_unstable();
        blocks.dedup();
        grid.table = BlockTable::new(blocks);
        grid
    }

    /// A local position on the grid.
    fn place(&self, position: [f32; 3]) -> [f64; 3] {
        std::array::from_fn(|axis| f64::from(position[axis]) / VOXEL_SIDE + self.shift[axis])
    }

    fn voxel(&self, place: [f64; 3]) -> [i32; 3] {
        // clear of the ends of i32, so that neighbours never overflow
        place.map(|v| to_i32(v.floor().clamp(-1e9, 1e9)))
    }

    /// Voxels with plants and all around them, ascending. Between returns a crown goes on: of 4 to 8 returns/m² half of
    /// its voxels hold none, and without them shadows of crowns are a third too small.
    fn near_plants(&self) -> Vec<[i32; 3]> {
        let mut is_near = vec![[0_u64; SIDE as usize]; self.table.numbers.len()];
        for voxel in self.plants.iter().flat_map(|&voxel| around(voxel)) {
            if let Some(bits) = self.table.find(block_of(voxel)).and_then(|at| is_near.get_mut(at)) {
                let place = place_in_block(voxel);
                bits[place / 64] |= 1 << (place % 64);
            }
        }
        let of_block = |(block, bits): (&[i32; 3], &[u64; SIDE as usize])| {
            let (block, bits) = (*block, *bits);
            let is_set = move |place: &i32| bits[*place as usize / 64] >> (place % 64) & 1 == 1;
            let voxel = move |place: i32| {
                let own = [place % SIDE, place / SIDE % SIDE, place / (SIDE * SIDE)];
                std::array::from_fn(|axis| block[axis] * SIDE + own[axis])
            };
            (0..SIDE * SIDE * SIDE).filter(is_set).map(voxel)
        };
        let mut voxels: Vec<[i32; 3]> = self.table.numbers.par_iter().zip(&is_near).flat_map_iter(of_block).collect();
        voxels.par_sort_unstable();
        voxels
    }

    /// Hits and paths in each voxel of the blocks, in steps.
    fn counted(&self, returns: &PlantReturns<'_>, control: &Control<'_>) -> Result<(Vec<AtomicU32>, Vec<AtomicU32>)> {
        let stop = Stop::new(control);
        let zeros = || {
            let mut zeros = Vec::new();
            zeros.resize_with(self.table.numbers.len() * VOXELS, AtomicU32::default);
            zeros
        };
        let (hits, paths) = (zeros(), zeros());
        let one = |row: usize| {
            let position = returns.positions[row];
            if !position.iter().all(|v| v.is_finite()) {
                return;
            }
            let of_pulse = returns.return_count.and_then(|counts| counts.get(row)).map_or(1, |&count| count.max(1));
            let weight = STEPS / f64::from(of_pulse);
            let place = self.place(position);
            if returns.kinds[row] != PlantReturn::Elsewhere {
                add(&hits, self.find(self.voxel(place)), weight);
            }
            let to_scanner = returns.scanner.get(row).and_then(|scanner| {
                unit(std::array::from_fn(|axis| f64::from(scanner[axis]) - f64::from(position[axis])))
            });
            let line = GridLine::new(place, to_scanner.unwrap_or([0.0, 0.0, 1.0]));
            let Some(ranges) = line.within(self.table.bounds, [0.0, f64::INFINITY]) else { return };
            let _ = line.each_cell::<()>(SIDE, self.table.bounds, ranges, |block, ranges| {
                let Some(at) = self.table.get(block) else { return ControlFlow::Continue(()) };
                let low = block.map(|v| v * SIDE);
                line.each_cell(1, [low, low.map(|v| v + SIDE)], ranges, |voxel, [from, to]| {
                    add(&paths, Some(at * VOXELS + place_in_block(voxel)), (to - from) * VOXEL_SIDE * weight);
                    ControlFlow::Continue(())
                })
            });
        };
        if !self.plants.is_empty() {
            let rows = 0..returns.positions.len();
            rows.into_par_iter().with_min_len(CHUNK).filter(|_| !stop.is_set()).for_each(one);
        }
        stop.check()?;
        Ok((hits, paths))
    }

    fn find(&self, voxel: [i32; 3]) -> Option<usize> {
        Some(self.table.find(block_of(voxel))? * VOXELS + place_in_block(voxel))
    }
}

/// Adds steps to a sum.
fn add(sums: &[AtomicU32], place: Option<usize>, steps: f64) {
    if let Some(sum) = place.and_then(|place| sums.get(place)) {
        sum.fetch_add(to_u32(steps.round()), Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::medium::Medium;
    use belvedere_data::random::uniform;
    use belvedere_data::vector::unit;

    /// Pulses from 500 m above into a crown, a box of leaves of this extinction from 2 to 10 m above level ground, each
    /// of which returns once.
    fn scan(extinction: f64, count: u64) -> (Vec<[f32; 3]>, Vec<[f32; 3]>, Vec<PlantReturn>) {
        let (mut positions, mut scanner, mut kinds) = (Vec::new(), Vec::new(), Vec::new());
        for i in 0..count {
            let random = |k: u64| uniform(17, 4 * i + k);
            let ground = [30.0 * random(0) - 5.0, 30.0 * random(1) - 5.0, 0.0];
            // from either side
            let eye = [10.0 + if i % 2 == 0 { 150.0 } else { -150.0 }, 10.0, 500.0];
            let up = unit(std::array::from_fn(|axis| eye[axis] - ground[axis])).unwrap();
            // free path through leaves, from the top down
            let free = -random(2).ln() / extinction;
            let at = 10.0 - free * up[2];
            let place: [f64; 3] = std::array::from_fn(|axis| ground[axis] + up[axis] * at / up[2]);
            let is_hit = at > 2.0 && (0..2).all(|axis| (0.0..20.0).contains(&place[axis]));
            let end = if is_hit { place } else { ground };
            positions.push(end.map(to_f32));
            scanner.push(eye.map(to_f32));
            kinds.push(if is_hit { PlantReturn::Plant } else { PlantReturn::Elsewhere });
        }
        (positions, scanner, kinds)
    }

    #[test]
    fn extinction_of_a_box_of_leaves_is_found_by_pulses_that_lean() {
        for extinction in [0.1, 0.4] {
            let (positions, scanner, kinds) = scan(extinction, 20_000);
            let origin = [100_000.5, 400_000.25, 3.0];
            let returns =
                PlantReturns { positions: &positions, scanner: &scanner, return_count: None, kinds: &kinds, origin };
            let found = estimate(&returns, &MediumParams::default(), &Control::none()).unwrap();
            assert!(found.validate().is_ok() && found.len() > 2000);
            let medium = Medium::new(&found, origin);
            let (mut sum, mut count) = (0.0, 0.0);
            for i in 0..400 {
                let random = |k: u64| uniform(19, 4 * i + k);
                let start = [4.0 + 12.0 * random(0), 4.0 + 12.0 * random(1), 0.0];
                let towards = unit([0.6 * random(2) - 0.3, 0.6 * random(3) - 0.3, 1.0]).unwrap();
                sum += medium.optical_depth(start, towards, f64::INFINITY) * towards[2] / 8.0;
                count += 1.0;
            }
            // voxels around the crown hold a little, and few pulses reach the lower half of the denser one
            assert!((sum / count / extinction - 1.0).abs() < 0.15, "{extinction}: {}", sum / count);
        }
    }

    #[test]
    fn order_and_threads_make_no_difference_and_each_return_is_a_share_of_its_pulse() {
        let (positions, scanner, kinds) = scan(0.3, 3000);
        let returns = PlantReturns {
            positions: &positions,
            scanner: &scanner,
            return_count: None,
            kinds: &kinds,
            origin: [0.0; 3],
        };
        let params = MediumParams::default();
        let found = estimate(&returns, &params, &Control::none()).unwrap();
        let turned = |v: &[[f32; 3]]| v.iter().rev().copied().collect::<Vec<_>>();
        let kinds_turned: Vec<PlantReturn> = kinds.iter().rev().copied().collect();
        let (p, s) = (turned(&positions), turned(&scanner));
        let other = PlantReturns { positions: &p, scanner: &s, kinds: &kinds_turned, ..returns };
        assert_eq!(estimate(&other, &params, &Control::none()).unwrap(), found);
        // two halves of a pulse at the same place are the pulse
        let twice = |v: &[[f32; 3]]| v.iter().chain(v).copied().collect::<Vec<_>>();
        let (p, s, k) = (twice(&positions), twice(&scanner), [&kinds[..], &kinds].concat());
        let counts = vec![2; p.len()];
        let halves = PlantReturns { positions: &p, scanner: &s, return_count: Some(&counts), kinds: &k, ..returns };
        let halves = estimate(&halves, &params, &Control::none()).unwrap();
        assert_eq!(halves.voxels, found.voxels);
        let worst = halves.extinction.iter().zip(&found.extinction).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(worst < 2e-3, "{worst}");
        let short = PlantReturns { kinds: &k[..5], ..returns };
        assert!(estimate(&short, &params, &Control::none()).is_err());
    }
}
