//! Selection of cameras.

use super::bound::{Best, BranchNode, CandidateFate, prices_of};
use super::greedy::{exchange, fill};
use super::problem::{CameraSelection, Problem, TOLERANCE};
use super::search::{improve, search};
use super::table::CoverageTable;
use belvedere_data::control::Control;
use belvedere_data::{Error, Parameter, Result};

/// Rounds of a bound before the cameras that it would choose are improved by exchanges.
const ROUNDS: usize = 80;
/// Number of repetitions with the prices that were found. With 6 in place of 1, selections of random towns are up to
/// 1.8 % better.
const RESTARTS: usize = 6;
/// Words, targets and covered pairs that the search may look at, if no limit is given: about half a minute.
const MAX_LOOKS: usize = 4_000_000_000;
/// Number of evaluations of each in a branch: the rounds of its bound.
const LOOKS_PER_BRANCH: usize = 40;
/// Maximum number of branches of a search, if no limit is given.
const MAX_BRANCHES: usize = 20_000;

/// Goal of a selection of cameras.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Goal {
    /// To cover as much as possible with so many new cameras.
    Count(usize),
    /// To cover this share of the weight of all targets, above 0 to 1, with as few new cameras as possible.
    Coverage(f64),
}

/// Parameters of the selection of cameras.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct PlacementParams {
    /// Goal of the selection.
    pub goal: Goal,
    /// Cameras that stand already: they are kept, and cost nothing. Default: none.
    pub existing: Vec<usize>,
    /// Number of cameras that each target needs, 1 or more. A target with fewer counts in proportion. Default 1.
    pub required: u32,
    /// Maximum number of branches of the search for the proven optimum; 0 for none. `None`, the default: by the size of
    /// the problem, about half a minute.
    pub search_limit: Option<usize>,
}

belvedere_data::setters!(PlacementParams {
    with_existing(existing: Vec<usize>),
    with_required(required: u32),
    with_search_limit(search_limit: Option<usize>),
});

impl PlacementParams {
    /// Cameras for `goal`, with defaults for everything else.
    #[must_use]
    pub fn new(goal: Goal) -> Self {
        Self { goal, existing: Vec::new(), required: 1, search_limit: None }
    }
}

/// Chosen cameras with the bounds proven for them.
#[derive(Clone, Debug, PartialEq)]
pub struct Placement {
    /// New cameras, those that add most first.
    pub chosen: Vec<usize>,
    /// Share of all weight that is covered by the existing cameras, and after each new one, (chosen + 1). A target with
    /// fewer cameras than it needs counts in proportion.
    pub curve: Vec<f64>,
    /// The share that no selection of as many cameras can exceed.
    pub bound: f64,
    /// The number of new cameras below which no selection reaches the goal; for [`Goal::Coverage`].
    pub min_count: Option<usize>,
    /// The share that all candidates together cover.
    pub reachable: f64,
    /// Branches of the search for the optimum.
    pub branches: usize,
    /// Number of cameras that cover each target, existing ones among them.
    pub counts: Vec<u32>,
}

impl Placement {
    /// Share of all weight that is covered.
    #[must_use]
    pub fn coverage(&self) -> f64 {
        self.curve.last().copied().unwrap_or(0.0)
    }

    /// Returns the maximum gap between the coverage and the best possible, as a share of the latter.
    #[must_use]
    pub fn gap(&self) -> f64 {
        if self.bound > 0.0 { ((self.bound - self.coverage()) / self.bound).max(0.0) } else { 0.0 }
    }

    /// Returns true if no other selection is better: none covers more, or none needs fewer cameras.
    #[must_use]
    pub fn is_optimal(&self) -> bool {
        match self.min_count {
            Some(min) => self.chosen.len() == min,
            None => self.bound <= self.coverage() + TOLERANCE,
        }
    }
}

/// Chooses cameras of `table` for targets with these `weights`, (M), 0 for one that does not count. The same for any
/// number of threads.
///
/// # Errors
/// [`Error::InvalidParameter`] for weights and parameters outside their range and for a coverage that all candidates
/// together do not reach; [`Error::LengthMismatch`]; [`Error::Cancelled`].
pub fn place_cameras(
    table: &CoverageTable,
    weights: &[f64],
    params: &PlacementParams,
    control: &Control<'_>,
) -> Result<Placement> {
    let problem = Problem::new(table, weights, params.required)?;
    if let Some(bad) = params.existing.iter().find(|&&camera| camera >= table.camera_count()) {
        let expected = "the number of a camera of the table, counted from 0";
        return Err(Error::invalid(Parameter::ExistingCamera, bad, expected));
    }
    let solver = PlacementSolver::new(&problem, params);
    match params.goal {
        Goal::Count(count) => {
            let found = solver.best_with(count, &|_, _| false, control)?;
            Ok(solver.placement(&found.best.chosen, found.bound, None, found.branches, control)?)
        }
        Goal::Coverage(share) => solver.fewest_for(share, control),
    }
}

/// A problem with the decisions fixed from the start.
struct PlacementSolver<'a> {
    problem: &'a Problem<'a>,
    existing: Vec<usize>,
    candidates: Vec<usize>,
    fates: Vec<CandidateFate>,
    limit: usize,
}

/// The best selection for a number of cameras.
struct BestSelection {
    best: Best,
    bound: f64,
    branches: usize,
}

impl<'a> PlacementSolver<'a> {
    fn new(problem: &'a Problem<'a>, params: &PlacementParams) -> Self {
        let mut fates = vec![CandidateFate::Open; problem.table.camera_count()];
        params.existing.iter().for_each(|&camera| fates[camera] = CandidateFate::In);
        let with =
            |fate: CandidateFate| (0..fates.len()).filter(|&camera| fates[camera] == fate).collect::<Vec<usize>>();
        let (cameras, targets) = (problem.table.camera_count(), problem.table.target_count());
        let looks = LOOKS_PER_BRANCH * (problem.table.pair_count() + targets + cameras * targets.div_ceil(64)).max(1);
        let limit = params.search_limit.unwrap_or((MAX_LOOKS / looks).min(MAX_BRANCHES));
        Self { problem, existing: with(CandidateFate::In), candidates: with(CandidateFate::Open), limit, fates }
    }

    /// The most that `count` new cameras cover, as far as it is found; stops early where `is_enough` of a value and a
    /// bound.
    fn best_with(
        &self,
        count: usize,
        is_enough: &dyn Fn(f64, f64) -> bool,
        control: &Control<'_>,
    ) -> Result<BestSelection> {
        let (problem, fixed) = (self.problem, self.existing.len());
        let mut selection = CameraSelection::of(problem, &self.existing);
        fill(&mut selection, &self.candidates, |selection| selection.chosen.len() >= fixed + count, control)?;
        let prices = prices_of(&selection);
        exchange(&mut selection, fixed, &self.candidates, control)?;
        let value = selection.value();
        let mut best = Best { chosen: selection.chosen, value };
        let question = BranchNode { problem, fates: &self.fates, left: count };
        let mut root = question.relax(prices, ROUNDS, &mut best, control)?;
        for _ in 0..RESTARTS {
            for picked in [root.picked.clone(), best.chosen.clone()] {
                improve(problem, &mut best, &picked, fixed, &self.candidates, control)?;
            }
            if !problem.is_better(root.bound, best.value) || is_enough(best.value, root.bound) {
                break;
            }
            root = question.relax(root.prices, ROUNDS, &mut best, control)?;
        }
        let (bound, branches) = if is_enough(best.value, root.bound) {
            (root.bound, 0)
        } else {
            let how = (self.limit, is_enough);
            search(problem, self.fates.clone(), count, root, &mut best, how, control)?
        };
        let bound = problem.rounded_down(bound).max(best.value);
        Ok(BestSelection { best, bound, branches })
    }

    /// The fewest new cameras that cover `share`, as far as they are found, and a number below which none do.
    fn fewest_for(&self, share: f64, control: &Control<'_>) -> Result<Placement> {
        let invalid = |value: String, expected| Err(Error::invalid(Parameter::Coverage, value, expected));
        if !(share > 0.0 && share <= 1.0) {
            return invalid(share.to_string(), "a share above 0, and at most 1");
        }
        let (reachable, goal) = (self.reachable(), share - TOLERANCE);
        if reachable < goal {
            let value = format!("{:.2} % (all candidates together cover {:.2} %)", 100.0 * share, 100.0 * reachable);
            return invalid(value, "at most what all candidates cover: lower it, or add candidates");
        }
        let fixed = self.existing.len();
        let mut selection = CameraSelection::of(self.problem, &self.existing);
        fill(&mut selection, &self.candidates, |selection| selection.value() >= goal, control)?;
        let mut best = BestSelection {
            bound: reachable,
            best: Best { value: selection.value(), chosen: selection.chosen },
            branches: 0,
        };
        let (mut min, mut branches) = (0, 0);
        let mut count = best.best.chosen.len() - fixed;
        let mut is_proven_above = false;
        while count > 0 && !is_proven_above {
            let found = self.best_with(count - 1, &|value, bound| value >= goal || bound < goal, control)?;
            branches += found.branches;
            count -= 1;
            if found.best.value >= goal {
                count = found.best.chosen.len() - fixed;
                best = found;
            } else if found.bound < goal {
                (is_proven_above, min) = (true, count + 1);
            } else {
                break;
            }
        }
        if !is_proven_above {
            min = self.min_count(count, goal, control)?;
        }
        let bound = best.bound.min(reachable);
        self.placement(&best.best.chosen, bound, Some(min), branches, control)
    }

    /// The least number of cameras, at most `max`, whose bound reaches `goal`: found by halving, for a bound never
    /// falls with more cameras.
    fn min_count(&self, max: usize, goal: f64, control: &Control<'_>) -> Result<usize> {
        let (mut low, mut high) = (0, max);
        while low < high {
            let count = low.midpoint(high);
            let mut selection = CameraSelection::of(self.problem, &self.existing);
            let enough = self.existing.len() + count;
            fill(&mut selection, &self.candidates, |selection| selection.chosen.len() >= enough, control)?;
            let mut best = Best { value: selection.value(), chosen: selection.chosen.clone() };
            let question = BranchNode { problem: self.problem, fates: &self.fates, left: count };
            let bound = question.relax(prices_of(&selection), ROUNDS, &mut best, control)?.bound;
            if self.problem.rounded_down(bound) < goal { low = count + 1 } else { high = count }
        }
        Ok(low)
    }

    fn reachable(&self) -> f64 {
        let all: Vec<usize> = (0..self.fates.len()).collect();
        CameraSelection::of(self.problem, &all).value()
    }

    /// The result, with the cameras in the order of their gains.
    fn placement(
        &self,
        chosen: &[usize],
        bound: f64,
        min_count: Option<usize>,
        branches: usize,
        control: &Control<'_>,
    ) -> Result<Placement> {
        let new: Vec<usize> =
            chosen.iter().copied().filter(|&camera| self.fates[camera] == CandidateFate::Open).collect();
        let mut selection = CameraSelection::of(self.problem, &self.existing);
        let fixed = self.existing.len();
        let mut curve = Vec::with_capacity(new.len() + 1);
        let note = |selection: &CameraSelection<'_>| {
            curve.push(selection.value());
            selection.chosen.len() >= fixed + new.len()
        };
        fill(&mut selection, &new, note, control)?;
        let reachable = self.reachable();
        Ok(Placement {
            chosen: selection.chosen[fixed..].to_vec(),
            curve,
            bound: bound.min(reachable),
            min_count,
            reachable,
            branches,
            counts: selection.counts,
        })
    }
}
