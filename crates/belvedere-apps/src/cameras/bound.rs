//! Upper bound for any selection of cameras: the linear relaxation, by prices on the targets.
//!
//! Each target t has a price between 0 and its worth w. A selection S of at most k cameras, each target needing r of
//! them, is worth Σ w·min(count, r). This is at most Σ r·(w − price) plus, over S, the sum of the prices that a camera
//! covers, since for each count w·min(count, r) ≤ r·(w − price) + price·count. The k cameras that cover the highest
//! prices bound the last sum for any S. Any prices therefore give a valid bound, and the least of these bounds is that
//! of the linear relaxation.
//!
//! Prices equal to the worth of the targets that a greedy selection leaves open, and 0 elsewhere, give a bound no worse
//! than that of Nemhauser, Wolsey & Fisher (1978).
//!
//! # Source
//! Galvão & ReVelle 1996 (Lagrangean relaxation of maximal covering), Held, Wolfe & Crowder 1974 (subgradients),
//! Camerini, Fratta & Maffioli 1975 (their direction).

use super::problem::{CameraSelection, Problem, TOLERANCE};
use belvedere_data::Result;
use belvedere_data::control::Control;
use rayon::prelude::*;

/// Cameras handed to a thread at once.
const CHUNK: usize = 32;
/// Rounds without a better bound after which steps are halved.
const PATIENCE: usize = 12;
/// Share of the last direction that the next one keeps. Of 0, 0.3, 0.5 and 0.7, the last gave the lowest bound in seven
/// of eight random towns.
const MEMORY: f64 = 0.7;
/// Steps below this share of their size at the start move nothing.
const MIN_STEP: f64 = 1e-4;

/// Decision on a candidate.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum CandidateFate {
    Open,
    In,
    Out,
}

/// Candidates with the decision on each, and the number that may still be chosen.
pub(super) struct BranchNode<'q> {
    pub(super) problem: &'q Problem<'q>,
    pub(super) fates: &'q [CandidateFate],
    pub(super) left: usize,
}

/// The best selection that is known.
pub(super) struct Best {
    pub(super) chosen: Vec<usize>,
    pub(super) value: f64,
}

/// A bound and how it came about.
pub(super) struct Relaxation {
    pub(super) bound: f64,
    pub(super) prices: Vec<f64>,
    /// Prices that each camera covers.
    pub(super) covered: Vec<f64>,
    /// Share of the rounds in which each camera was among the best.
    pub(super) shares: Vec<f64>,
    /// The cameras that the bound would choose.
    pub(super) picked: Vec<usize>,
}

/// The bound at some prices, and the cameras that it would choose.
struct AtPrices {
    bound: f64,
    covered: Vec<f64>,
    picked: Vec<usize>,
}

impl Relaxation {
    /// Creates the relaxation of the cameras at some prices, without shares.
    fn of(at: &AtPrices, prices: &[f64]) -> Self {
        let (covered, picked) = (at.covered.clone(), at.picked.clone());
        Self { bound: at.bound, prices: prices.to_vec(), covered, shares: Vec::new(), picked }
    }
}

/// Turns the direction in which prices fall after a selection; returns its squared length.
fn turn(direction: &mut [f64], problem: &Problem<'_>, selection: &CameraSelection<'_>, prices: &[f64]) -> f64 {
    let mut size = 0.0;
    for (target, slope) in direction.iter_mut().enumerate() {
        let (price, worth) = (prices[target], problem.worth[target]);
        // more cameras than needed ask for a lower price; at either end of the range prices only move inwards
        let excess = f64::from(selection.counts[target]) - f64::from(problem.required);
        *slope = excess + MEMORY * *slope;
        if (price >= worth && *slope < 0.0) || (price <= 0.0 && *slope > 0.0) {
            *slope = 0.0;
        }
        size += *slope * *slope;
    }
    size
}

impl BranchNode<'_> {
    fn at(&self, prices: &[f64]) -> AtPrices {
        let covered_by = |(camera, fate): (usize, &CandidateFate)| match fate {
            CandidateFate::Out => 0.0,
            _ => self.problem.table.covered_by(camera).map(|target| prices[target]).sum(),
        };
        let covered: Vec<f64> = self.fates.par_iter().enumerate().with_min_len(CHUNK).map(covered_by).collect();
        let with = |fate: CandidateFate| (0..self.fates.len()).filter(move |&camera| self.fates[camera] == fate);
        let mut picked: Vec<usize> = with(CandidateFate::Open).collect();
        if self.left < picked.len() {
            let order = |a: &usize, b: &usize| covered[*b].total_cmp(&covered[*a]).then(a.cmp(b));
            picked.select_nth_unstable_by(self.left, order);
            picked.truncate(self.left);
        }
        let free: f64 = self.problem.worth.iter().zip(prices).map(|(worth, price)| worth - price).sum();
        let covered_all: f64 =
            with(CandidateFate::In).chain(picked.iter().copied()).map(|camera| covered[camera]).sum();
        AtPrices { bound: f64::from(self.problem.required) * free + covered_all, covered, picked }
    }

    /// Lowers the bound from `prices` for so many rounds, or until nothing better than `best` remains; better
    /// selections met on the way replace it.
    pub(super) fn relax(
        &self,
        prices: Vec<f64>,
        rounds: usize,
        best: &mut Best,
        control: &Control<'_>,
    ) -> Result<Relaxation> {
        let problem = self.problem;
        let ins: Vec<usize> = (0..self.fates.len()).filter(|&camera| self.fates[camera] == CandidateFate::In).collect();
        let base = CameraSelection::of(problem, &ins);
        let mut at = self.at(&prices);
        let mut found = Relaxation { shares: vec![0.0; self.fates.len()], ..Relaxation::of(&at, &prices) };
        let mut prices = prices;
        let mut direction = vec![0.0; prices.len()];
        let (mut scale, mut waited, mut done) = (1.0, 0, 0.0);
        for _ in 0..rounds {
            control.check()?;
            let mut selection = base.clone();
            at.picked.iter().for_each(|&camera| selection.add(camera));
            done += 1.0;
            at.picked.iter().for_each(|&camera| found.shares[camera] += 1.0);
            let value = selection.value();
            if value > best.value + TOLERANCE {
                (best.value, best.chosen) = (value, selection.chosen.clone());
            }
            if self.left == 0 {
                found.bound = value;
            }
            if !problem.is_better(found.bound, best.value) || scale < MIN_STEP || self.left == 0 {
                break;
            }
            let size = turn(&mut direction, problem, &selection, &prices);
            if size == 0.0 {
                break;
            }
            let step = scale * (at.bound - best.value).max(TOLERANCE) / size;
            for ((price, slope), worth) in prices.iter_mut().zip(&direction).zip(&problem.worth) {
                *price = (*price - step * slope).clamp(0.0, *worth);
            }
            at = self.at(&prices);
            if at.bound < found.bound - TOLERANCE * found.bound {
                found = Relaxation { shares: found.shares, ..Relaxation::of(&at, &prices) };
                waited = 0;
            } else {
                waited += 1;
                if waited == PATIENCE {
                    (scale, waited) = (scale / 2.0, 0);
                    prices.clone_from(&found.prices);
                    direction.fill(0.0);
                    at = self.at(&prices);
                }
            }
        }
        found.shares.iter_mut().for_each(|share| *share /= f64::max(done, 1.0));
        found.picked.splice(0..0, ins);
        Ok(found)
    }
}

/// Prices equal to the worth of the targets that a selection leaves open.
pub(super) fn prices_of(selection: &CameraSelection<'_>) -> Vec<f64> {
    let problem = selection.problem;
    let price = |(count, worth): (&u32, &f64)| if *count < problem.required { *worth } else { 0.0 };
    selection.counts.iter().zip(&problem.worth).map(price).collect()
}
