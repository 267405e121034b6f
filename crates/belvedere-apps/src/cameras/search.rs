//! The search for the proven optimum: branch and bound.

use super::bound::{Best, BranchNode, CandidateFate, Relaxation};
use super::greedy::exchange;
use super::problem::{CameraSelection, Problem};
use belvedere_data::Result;
use belvedere_data::control::Control;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Rounds of a bound below the first.
const ROUNDS: usize = 40;

/// Decisions that are not yet divided further.
struct Branch {
    bound: f64,
    /// Branches made before this one.
    number: usize,
    fates: Vec<CandidateFate>,
    left: usize,
    prices: Vec<f64>,
    /// The candidate to decide on next.
    next: usize,
}

impl PartialEq for Branch {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Branch {}

impl PartialOrd for Branch {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Branch {
    fn cmp(&self, other: &Self) -> Ordering {
        self.bound.total_cmp(&other.bound).then(other.number.cmp(&self.number))
    }
}

/// Improves `best` and lowers its bound until they meet, `limit` branches were looked at, or `is_enough` of value and
/// bound; returns the bound and the number of branches.
pub(super) fn search(
    problem: &Problem<'_>,
    fates: Vec<CandidateFate>,
    left: usize,
    root: Relaxation,
    best: &mut Best,
    (limit, is_enough): (usize, &dyn Fn(f64, f64) -> bool),
    control: &Control<'_>,
) -> Result<(f64, usize)> {
    let fixed = fates.iter().filter(|fate| **fate == CandidateFate::In).count();
    let candidates: Vec<usize> = (0..fates.len()).filter(|&camera| fates[camera] == CandidateFate::Open).collect();
    let root_bound = root.bound;
    let mut made = 0;
    let mut open = BinaryHeap::new();
    open.extend(branch(problem, fates, left, root, best, made));
    while let Some(top) = open.peek() {
        if made >= limit || is_enough(best.value, top.bound) || !problem.is_better(top.bound, best.value) {
            break;
        }
        let Some(Branch { fates, left, prices, next, .. }) = open.pop() else { break };
        for fate in [CandidateFate::In, CandidateFate::Out] {
            control.check()?;
            let mut fates = fates.clone();
            fates[next] = fate;
            let left = left - usize::from(fate == CandidateFate::In);
            let before = best.value;
            let question = BranchNode { problem, fates: &fates, left };
            let relaxed = question.relax(prices.clone(), ROUNDS, best, control)?;
            if best.value > before {
                let better = best.chosen.clone();
                improve(problem, best, &better, fixed, &candidates, control)?;
            }
            improve(problem, best, &relaxed.picked, fixed, &candidates, control)?;
            made += 1;
            open.extend(branch(problem, fates, left, relaxed, best, made));
        }
    }
    let left_open = open.peek().map(|top| top.bound).filter(|bound| problem.is_better(*bound, best.value));
    Ok((left_open.map_or(best.value, |bound| bound.min(root_bound)), made))
}

/// Exchanges cameras of a selection, but none of the `fixed`, and keeps the result if it is the best.
pub(super) fn improve(
    problem: &Problem<'_>,
    best: &mut Best,
    picked: &[usize],
    fixed: usize,
    candidates: &[usize],
    control: &Control<'_>,
) -> Result<()> {
    // those that must stay come first
    let mut order = picked.to_vec();
    order.sort_by_key(|camera| candidates.binary_search(camera).is_ok());
    let mut selection = CameraSelection::of(problem, &order);
    exchange(&mut selection, fixed, candidates, control)?;
    let value = selection.value();
    if value > best.value {
        (best.value, best.chosen) = (value, selection.chosen);
    }
    Ok(())
}

/// Creates the branch that remains after a bound; `None` if nothing better than `best` remains.
fn branch(
    problem: &Problem<'_>,
    mut fates: Vec<CandidateFate>,
    mut left: usize,
    relaxed: Relaxation,
    best: &mut Best,
    number: usize,
) -> Option<Branch> {
    if !problem.is_better(relaxed.bound, best.value) {
        return None;
    }
    decide(problem, &mut fates, &mut left, &relaxed, best);
    let is_open = |camera: &usize| fates[*camera] == CandidateFate::Open;
    let undecided = |camera: &usize| (relaxed.shares[*camera] - 0.5).abs();
    let next = (0..fates.len())
        .filter(is_open)
        .min_by(|a, b| undecided(a).total_cmp(&undecided(b)).then(relaxed.covered[*b].total_cmp(&relaxed.covered[*a])));
    match next {
        Some(next) if left > 0 => {
            Some(Branch { bound: relaxed.bound, number, fates, left, prices: relaxed.prices, next })
        }
        _ => {
            let chosen: Vec<usize> = (0..fates.len()).filter(|&camera| fates[camera] == CandidateFate::In).collect();
            let value = CameraSelection::of(problem, &chosen).value();
            if value > best.value {
                (best.value, best.chosen) = (value, chosen);
            }
            None
        }
    }
}

/// Decides on candidates whose other fate could give nothing better than `best`.
fn decide(problem: &Problem<'_>, fates: &mut [CandidateFate], left: &mut usize, relaxed: &Relaxation, best: &Best) {
    let mut order: Vec<usize> = (0..fates.len()).filter(|&camera| fates[camera] == CandidateFate::Open).collect();
    order.sort_by(|a, b| relaxed.covered[*b].total_cmp(&relaxed.covered[*a]).then(a.cmp(b)));
    if order.len() <= *left || *left == 0 {
        return;
    }
    let (picked, others) = order.split_at(*left);
    let (Some(&last), Some(&first)) = (picked.last(), others.first()) else { return };
    let (lowest, next) = (relaxed.covered[last], relaxed.covered[first]);
    let decided_in: Vec<usize> = picked
        .iter()
        .copied()
        .filter(|&camera| !problem.is_better(relaxed.bound - relaxed.covered[camera] + next, best.value))
        .collect();
    for &camera in others {
        if !problem.is_better(relaxed.bound - lowest + relaxed.covered[camera], best.value) {
            fates[camera] = CandidateFate::Out;
        }
    }
    *left -= decided_in.len();
    decided_in.into_iter().for_each(|camera| fates[camera] = CandidateFate::In);
}
