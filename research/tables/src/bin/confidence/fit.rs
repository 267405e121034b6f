//! Fits the scores: logistic regression on classes of evidence.

use super::AnyResult;
use super::cases::{Case, TownSurvey};
use belvedere::query::ScoreKey;
use belvedere_scenes::{Preset, QuerySet, Regime};
use std::collections::BTreeMap;

/// Towns of each kind that are fitted.
const SEEDS: [u64; 2] = [101, 103];
/// Sum of squares of scores is weighed with this: a class that no case has gets 0.
const RIDGE: f64 = 1.0;
const STEPS: usize = 30;
/// Largest change of a score at which the search ends.
const ENOUGH: f64 = 1e-6;
/// How often each line between people counts: there are four suns for each other target.
const LINES_OF_SIGHT: f64 = 4.0;

/// Kinds of towns that are fitted.
const PRESETS: [Preset; 4] = [Preset::Village, Preset::Town, Preset::OldTown, Preset::Towers];

/// The surveys from the air that are fitted: with scanners and densities between which others lie.
pub(super) fn flown_surveys() -> Vec<TownSurvey> {
    let flown = [5.0, 10.0, 40.0].map(|density| (Regime::Air, density));
    let others = [Regime::Leaves, Regime::Drone].map(|regime| (regime, 10.0));
    let mut surveys = Vec::new();
    for preset in PRESETS {
        for seed in SEEDS {
            let all = flown.iter().chain(&others);
            surveys.extend(all.map(|&(regime, pulses_per_m2)| TownSurvey { preset, seed, regime, pulses_per_m2 }));
        }
    }
    surveys
}

/// The surveys from the ground that are fitted.
pub(super) fn ground_surveys() -> Vec<TownSurvey> {
    let from_ground =
        [(Preset::Town, Regime::Tripods), (Preset::OldTown, Regime::Tripods), (Preset::Town, Regime::Car)];
    from_ground.map(|(preset, regime)| TownSurvey { preset, seed: SEEDS[0], regime, pulses_per_m2: 10.0 }).into()
}

/// `text`, the scores as the program reads them, with new scores of the terms that only surveys from the ground have.
/// All others stay. What is unknown has no probability, and does not count.
pub(super) fn with_ground_scores(text: &str, cases: &[Case]) -> String {
    let split = |line: &str| line.rsplit_once(',').and_then(|(key, score)| Some((key.to_owned(), score.parse().ok()?)));
    let known: BTreeMap<String, f64> = text.lines().filter_map(split).collect();
    let is_of_ground = |key: &str| key.contains("from_ground");
    // the other scores of each case, and whether its target is visible, by the one term of the ground
    let mut by_term: BTreeMap<String, Vec<(f64, f64, f64)>> = BTreeMap::new();
    for case in cases.iter().filter(|case| !case.evidence.is_unknown()) {
        let keys: Vec<String> = case.evidence.score_keys().map(|key| key.to_string()).collect();
        let others = keys.iter().filter(|key| !is_of_ground(key)).filter_map(|key| known.get(key)).sum();
        let visible = f64::from(u8::from(case.is_visible));
        if let Some(key) = keys.into_iter().find(|key| is_of_ground(key)) {
            by_term.entry(key).or_default().push((others, visible, weight(case)));
        }
    }
    let line = |line: &str| match line.rsplit_once(',') {
        Some((key, _)) if is_of_ground(key) => {
            let cases = by_term.get(key).map_or(&[][..], Vec::as_slice);
            format!("{key},{:.4}\n", fitted_alone(cases))
        }
        _ => format!("{line}\n"),
    };
    text.lines().map(line).collect()
}

/// Newton's method for one score beside others that are known.
fn fitted_alone(cases: &[(f64, f64, f64)]) -> f64 {
    let mut score = 0.0;
    for _ in 0..STEPS {
        let (mut slope, mut curve) = (-RIDGE * score, RIDGE);
        for (others, visible, weight) in cases {
            let p = 1.0 / (1.0 + (-(others + score)).exp());
            slope += weight * (visible - p);
            curve += weight * p * (1.0 - p);
        }
        score += slope / curve;
    }
    score
}

/// Weight of a case.
fn weight(case: &Case) -> f64 {
    if case.set == QuerySet::LinesOfSight { LINES_OF_SIGHT } else { 1.0 }
}

/// The scores as the program reads them.
pub(super) fn scores(cases: &[Case]) -> AnyResult<String> {
    let mut columns: BTreeMap<ScoreKey, usize> = BTreeMap::new();
    // what is alike counts once, with its number
    let mut groups: BTreeMap<Vec<ScoreKey>, [f64; 2]> = BTreeMap::new();
    for case in cases {
        let keys: Vec<ScoreKey> = case.evidence.score_keys().collect();
        groups.entry(keys).or_default()[usize::from(case.is_visible)] += weight(case);
    }
    for key in groups.keys().flatten() {
        let next = columns.len();
        columns.entry(*key).or_insert(next);
    }
    let rows: Vec<(Vec<usize>, [f64; 2])> =
        groups.iter().map(|(keys, counts)| (keys.iter().map(|key| columns[key]).collect(), *counts)).collect();
    let found = fitted(&rows, columns.len())?;
    let mut text = "term,answer,class,score\n".to_owned();
    for (key, column) in &columns {
        text += &format!("{key},{:.4}\n", found[*column]);
    }
    Ok(text)
}

/// Newton's method for the likelihood with a ridge; rows name the columns that are 1, and count blocked and visible.
fn fitted(rows: &[(Vec<usize>, [f64; 2])], count: usize) -> AnyResult<Vec<f64>> {
    let mut scores = vec![0.0; count];
    for _ in 0..STEPS {
        let mut slope: Vec<f64> = scores.iter().map(|score| -RIDGE * score).collect();
        let mut curve = vec![vec![0.0; count]; count];
        (0..count).for_each(|i| curve[i][i] = RIDGE);
        for (columns, [blocked, visible]) in rows {
            let sum: f64 = columns.iter().map(|&column| scores[column]).sum();
            let p = 1.0 / (1.0 + (-sum).exp());
            let (all, error) = (blocked + visible, visible - (blocked + visible) * p);
            for &i in columns {
                slope[i] += error;
                columns.iter().for_each(|&j| curve[i][j] += all * p * (1.0 - p));
            }
        }
        let step = solved(curve, slope).ok_or("no scores fit: too few cases")?;
        scores.iter_mut().zip(&step).for_each(|(score, step)| *score += step);
        if step.iter().all(|step| step.abs() < ENOUGH) {
            return Ok(scores);
        }
    }
    Err("scores do not settle".into())
}

/// Solves a symmetric positive definite system by Gaussian elimination.
fn solved(mut matrix: Vec<Vec<f64>>, mut right: Vec<f64>) -> Option<Vec<f64>> {
    let count = right.len();
    for pivot in 0..count {
        let row = matrix[pivot].clone();
        if row[pivot] <= 0.0 {
            return None;
        }
        for below in pivot + 1..count {
            let factor = matrix[below][pivot] / row[pivot];
            if factor != 0.0 {
                (pivot..count).for_each(|column| matrix[below][column] -= factor * row[column]);
                right[below] -= factor * right[pivot];
            }
        }
    }
    for pivot in (0..count).rev() {
        let rest: f64 = (pivot + 1..count).map(|column| matrix[pivot][column] * right[column]).sum();
        right[pivot] = (right[pivot] - rest) / matrix[pivot][pivot];
    }
    Some(right)
}
