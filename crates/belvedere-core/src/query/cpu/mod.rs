//! The first backend: the processor itself.
//!
//! Each direction is swept through cells of space, 64 lines of sight at a time. For most lines this shows that they
//! meet only cells that no ball reaches, or one that a ball fills. Near a target, where cells do not decide, balls are
//! gathered once for all directions. The rest is open.

mod nearby;
mod space_layers;
mod sweep;
mod whole_cells;

use super::backend::{BLOCK, Backend, PreparedBackend, Settled, WORD, WORDS, WordBits};
use super::ball_tree::BallTree;
use super::lazy::Lazy;
use crate::blocking::Profile;
use crate::depth::{BoundsParams, DepthBounds, depth_bounds};
use belvedere_data::Result;
use belvedere_data::control::Control;
use belvedere_data::view::View;
use nearby::{NEAR, Nearby};
use rayon::prelude::*;
use space_layers::SpaceLayers;
use std::sync::Arc;
use sweep::{Swept, sweep_all};
use whole_cells::{SweptDirection, TargetCell};

/// Minimum number of directions for which it pays to gather the obstacles near a target, and to sweep them.
const WORTH_GATHERING: usize = 16;
/// Lines of sight for each ball from which on it pays to sweep.
const WORTH_SWEEPING: f64 = 4.0;
/// Words of layers that are swept in the time that a line of sight takes, measured in towns of 100 and 300 m.
const WORDS_PER_LINE: usize = 150;
/// Targets for which balls near by are looked up together.
const TOGETHER: usize = 8;

/// The processor as a backend.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cpu;

impl Backend for Cpu {
    fn prepare(&self, balls: &Arc<BallTree>) -> Result<Box<dyn PreparedBackend>> {
        Ok(Box::new(PreparedBalls::new(balls)))
    }
}

/// Balls made ready for the processor, the fallback of other devices.
pub struct PreparedBalls {
    tree: Arc<BallTree>,
    layers: Lazy<SpaceLayers>,
}

impl PreparedBackend for PreparedBalls {
    fn depth(&self, view: &View, start: f64, control: &Control<'_>) -> Result<DepthBounds> {
        let params = BoundsParams { shell: self.tree.rule().shell, start };
        depth_bounds(self.tree.balls(), view, &params, control)
    }

    fn settle(&self, targets: &[[f32; 3]], directions: &[[f64; 3]], control: &Control<'_>) -> Result<Settled> {
        let mut settled = Settled::new(targets.len(), directions.len());
        let lines = targets.len() as f64 * directions.len() as f64;
        let is_worth_it = self.layers.is_made() || lines > WORTH_SWEEPING * self.tree.balls().len() as f64;
        if self.tree.rule().profile != Profile::Sphere || directions.len() < WORTH_GATHERING || !is_worth_it {
            return Ok(settled);
        }
        let layers = self.layers.get_or_make(|| SpaceLayers::new(self.tree.balls(), self.tree.rule(), control))?;
        if targets.len() * WORDS_PER_LINE < layers.word_count() {
            return Ok(settled);
        }
        let places: Vec<Option<TargetCell>> =
            targets.par_iter().map(|target| TargetCell::new(layers, *target)).collect();
        let near: Vec<f64> = directions.iter().map(|direction| near_range(*direction)).collect();
        let headings: Vec<Option<SweptDirection>> = directions
            .iter()
            .zip(&near)
            .map(|(direction, near)| SweptDirection::new(layers, *direction, near.max(self.tree.rule().bias)))
            .collect();
        let steep: Vec<SweptDirection> = headings.iter().flatten().cloned().collect();
        let mut of_steep = sweep_all(layers, &places, &steep, control)?.into_iter();
        let swept: Vec<Option<Swept>> =
            headings.iter().map(|heading| heading.as_ref().and_then(|_| of_steep.next())).collect();
        let blocks =
            settled.free.par_chunks_mut(directions.len()).zip(settled.blocked.par_chunks_mut(directions.len()));
        blocks.zip(targets.par_chunks(BLOCK)).enumerate().try_for_each(|(block, ((free, blocked), targets))| {
            control.check()?;
            for ((swept, free), blocked) in swept.iter().zip(&mut *free).zip(&mut *blocked) {
                let Some(swept) = swept else { continue };
                let of_block = |bits: &[u64]| -> WordBits {
                    std::array::from_fn(|word| bits.get(block * WORDS + word).copied().unwrap_or(0))
                };
                (*free, *blocked) = (of_block(&swept.free), of_block(&swept.blocked));
            }
            self.leave_near(targets, directions, free, blocked);
            Ok(())
        })?;
        for (number, (direction, near)) in directions.iter().zip(near).enumerate() {
            if direction[2] >= 0.0 {
                settled.set_open_from(number, near);
            }
        }
        Ok(settled)
    }
}

impl PreparedBalls {
    /// The balls of a tree.
    #[must_use]
    pub fn new(balls: &Arc<BallTree>) -> Self {
        Self { tree: Arc::clone(balls), layers: Lazy::new() }
    }

    /// Blocks those lines of a block of targets that a ball near the target blocks.
    fn leave_near(
        &self,
        targets: &[[f32; 3]],
        directions: &[[f64; 3]],
        free: &mut [WordBits],
        blocked: &mut [WordBits],
    ) {
        let mut nearby = Nearby::default();
        for (i, target) in targets.iter().enumerate() {
            if i % TOGETHER == 0 {
                nearby.gather(&self.tree, &targets[i..targets.len().min(i + TOGETHER)]);
            }
            let target = target.map(f64::from);
            nearby.select(&self.tree, target);
            if nearby.is_empty() {
                continue;
            }
            let (word, bit) = (i / WORD, 1 << (i % WORD));
            for ((direction, free), blocked) in directions.iter().zip(&mut *free).zip(&mut *blocked) {
                if blocked[word] & bit == 0
                    && direction[2] >= 0.0
                    && nearby.blocks(&self.tree, &self.tree.ray(target, *direction, f64::INFINITY))
                {
                    free[word] &= !bit;
                    blocked[word] |= bit;
                }
            }
        }
    }
}

/// Range at which a direction has left the near space of a target, metres.
fn near_range(direction: [f64; 3]) -> f64 {
    let across = direction[0].abs().max(direction[1].abs());
    (NEAR[1] / direction[2]).min(NEAR[0] / across)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::blocking::BlockRule;
    use crate::query::backend::LineAnswer;
    use belvedere_data::balls::{LIMIT_TOUCH, MedialBalls};
    use belvedere_data::cast::to_f32;
    use belvedere_data::random::uniform;

    #[test]
    fn many_targets_are_swept_and_few_are_not() {
        let place = |seed: u64, i: u64| {
            std::array::from_fn(|axis| to_f32(uniform(seed + axis as u64, i) * [100.0, 100.0, 20.0][axis]))
        };
        let count = 300;
        let balls = MedialBalls {
            centers: (0..count).map(|i| place(1, i)).collect(),
            radii: vec![1.0; 300],
            source: vec![0; 300],
            touch: vec![LIMIT_TOUCH; 300],
            separation_angles: vec![f32::NAN; 300],
        };
        let tree = Arc::new(BallTree::new(&balls, &BlockRule::default()).unwrap());
        let directions: Vec<[f64; 3]> = (0..64)
            .map(|i| {
                let (sine, azimuth) = ((f64::from(i) + 0.5) / 64.0, 2.4 * f64::from(i));
                let across = (1.0 - sine * sine).sqrt();
                [across * azimuth.cos(), across * azimuth.sin(), sine]
            })
            .collect();
        let prepared = Cpu.prepare(&tree).unwrap();
        let share_settled = |targets: &[[f32; 3]]| {
            let settled = prepared.settle(targets, &directions, &Control::none()).unwrap();
            let of_target =
                |target| (0..directions.len()).filter(|&d| settled.line(target, d) != LineAnswer::Open).count();
            let lines: usize = (0..targets.len()).map(of_target).sum();
            lines as f64 / (targets.len() as f64 * directions.len() as f64)
        };
        let targets: Vec<[f32; 3]> = (0..4096).map(|i| place(7, i)).collect();
        assert!(share_settled(&targets) > 0.5);
        assert_eq!(share_settled(&targets[..64]), 0.0);
    }
}
