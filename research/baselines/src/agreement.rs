//! How accurate answers are: counts against the truth, rates, and the uncertainty of the rates.

use belvedere::apps::resampling::resampled;
pub use belvedere::apps::resampling::{Interval, Tiles};
use belvedere::cast::to_index;
use belvedere::query::{Answer, UnprovenAs};

/// Answers for targets of known truth, counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TruthCounts {
    /// Blocked in truth and answered so.
    pub blocked: u64,
    /// Blocked in truth, answered visible or unproven.
    pub false_visible: u64,
    /// Visible in truth and answered so, or unproven.
    pub visible: u64,
    /// Visible in truth, answered blocked.
    pub false_blocked: u64,
    /// Those of `visible` that were answered unproven.
    pub unproven_visible: u64,
    /// Those of `false_visible` that were answered unproven.
    pub unproven_blocked: u64,
    /// Not answered: outside the view.
    pub unanswered: u64,
}

impl TruthCounts {
    /// Counts one answer. Unproven counts as visible, since nothing blocks the line of sight, and beside that on its
    /// own.
    pub fn add(&mut self, visible_in_truth: bool, answer: Answer) {
        if answer == Answer::Unproven {
            *if visible_in_truth { &mut self.unproven_visible } else { &mut self.unproven_blocked } += 1;
        }
        let count = match (UnprovenAs::Visible.settle(answer), visible_in_truth) {
            (Answer::Blocked, false) => &mut self.blocked,
            (Answer::Visible, false) => &mut self.false_visible,
            (Answer::Visible, true) => &mut self.visible,
            (Answer::Blocked, true) => &mut self.false_blocked,
            _ => &mut self.unanswered,
        };
        *count += 1;
    }

    /// These and `times` those of `other`.
    #[must_use]
    pub fn plus(self, other: &Self, times: u64) -> Self {
        Self {
            blocked: self.blocked + other.blocked * times,
            false_visible: self.false_visible + other.false_visible * times,
            visible: self.visible + other.visible * times,
            false_blocked: self.false_blocked + other.false_blocked * times,
            unproven_visible: self.unproven_visible + other.unproven_visible * times,
            unproven_blocked: self.unproven_blocked + other.unproven_blocked * times,
            unanswered: self.unanswered + other.unanswered * times,
        }
    }

    /// Targets that got `answer`, as a share of all answered ones, and the share of them that are right: visible or
    /// blocked in truth as it says, visible for [`Answer::Unproven`]. `None` where none was answered, or none so.
    #[must_use]
    pub fn worth(&self, answer: Answer) -> [Option<f64>; 2] {
        let (right, wrong) = match answer {
            Answer::Blocked => (self.blocked, self.false_blocked),
            Answer::Visible => (self.visible - self.unproven_visible, self.false_visible - self.unproven_blocked),
            Answer::Unproven => (self.unproven_visible, self.unproven_blocked),
            _ => (0, 0),
        };
        let all = self.visible + self.false_visible + self.blocked + self.false_blocked;
        [(right + wrong, all), (right, right + wrong)]
            .map(|(part, whole)| (whole > 0).then(|| part as f64 / whole as f64))
    }
}

/// A rate derived from [`TruthCounts`]. Targets without an answer enter [`Rate::Unanswered`] only.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rate {
    /// Share of visible targets that are called blocked.
    FalseBlocked,
    /// Share of blocked targets that are called visible.
    FalseVisible,
    /// Mean of the shares of visible and blocked targets that are classified correctly.
    Balanced,
    /// Intersection over union for blocked targets: targets blocked both in truth and by answer, over targets blocked
    /// in truth, by answer or both.
    BlockedIou,
    /// Share of all targets without an answer.
    Unanswered,
}

impl Rate {
    /// Every rate.
    pub const ALL: [Self; 5] =
        [Self::FalseBlocked, Self::FalseVisible, Self::Balanced, Self::BlockedIou, Self::Unanswered];

    /// The rate, 0 to 1, or `None` where no target of this kind was queried.
    #[must_use]
    pub fn of(self, counts: &TruthCounts) -> Option<f64> {
        let share = |part: u64, whole: u64| (whole > 0).then(|| part as f64 / whole as f64);
        let visible = counts.visible + counts.false_blocked;
        let blocked = counts.blocked + counts.false_visible;
        match self {
            Self::FalseBlocked => share(counts.false_blocked, visible),
            Self::FalseVisible => share(counts.false_visible, blocked),
            Self::Balanced => Some((share(counts.visible, visible)? + share(counts.blocked, blocked)?) / 2.0),
            Self::BlockedIou => share(counts.blocked, blocked + counts.false_blocked),
            Self::Unanswered => share(counts.unanswered, visible + blocked + counts.unanswered),
        }
    }
}

/// The counts of one view, tile by tile.
///
/// `truth`, (M), is `None` for targets that are not scored.
#[must_use]
pub fn count_by_tile(tiles: &Tiles, truth: &[Option<bool>], answers: &[Answer]) -> Vec<TruthCounts> {
    let mut counts = vec![TruthCounts::default(); tiles.count];
    for ((&tile, &visible), &answer) in tiles.of_target.iter().zip(truth).zip(answers) {
        if let (Some(visible), Some(counts)) = (visible, counts.get_mut(tile as usize)) {
            counts.add(visible, answer);
        }
    }
    counts
}

/// The rate of that view, over all its tiles, below which `share` of the views lie, 0 to 1: 0.1 for the tenth
/// percentile. Views without the rate are left out; `None` where none has it.
#[must_use]
pub fn quantile(views: &[Vec<TruthCounts>], rate: Rate, share: f64) -> Option<f64> {
    let of_view = |tiles: &Vec<TruthCounts>| {
        rate.of(&tiles.iter().fold(TruthCounts::default(), |total, tile| total.plus(tile, 1)))
    };
    let mut rates: Vec<f64> = views.iter().filter_map(of_view).collect();
    rates.sort_by(f64::total_cmp);
    let index = to_index(share.clamp(0.0, 1.0) * rates.len() as f64);
    rates.get(index.min(rates.len().saturating_sub(1))).copied()
}

/// The mean of `rate` over `views`, each given by the counts of the same tiles, with its 95 % interval; `None` where no
/// view has the rate.
///
/// Whole tiles are drawn with replacement, the same in every view ([`resampled`]).
#[must_use]
pub fn interval(views: &[Vec<TruthCounts>], rate: Rate, seed: u64) -> Option<Interval> {
    let tile_count = views.iter().map(Vec::len).min()?;
    let mean = |weights: Option<&[u32]>| {
        let rates = views.iter().filter_map(|tiles| {
            let total =
                tiles.iter().take(tile_count).enumerate().fold(TruthCounts::default(), |total, (tile, counts)| {
                    let times = weights.map_or(1, |weights| u64::from(weights[tile]));
                    total.plus(counts, times)
                });
            rate.of(&total)
        });
        let (sum, count) = rates.fold((0.0, 0_u32), |(sum, count), rate| (sum + rate, count + 1));
        (count > 0).then(|| sum / f64::from(count))
    };
    resampled(tile_count, seed, mean)
}

/// The mean of the rates of several places, with its 95 % interval. Places are drawn with replacement: they differ more
/// than the tiles of one do. A single place keeps its own interval; `None` for none.
#[must_use]
pub fn over_places(places: &[Interval], seed: u64) -> Option<Interval> {
    if let [one] = places {
        return Some(*one);
    }
    let mean = |weights: Option<&[u32]>| {
        let weight = |number: usize| weights.map_or(1.0, |weights| f64::from(weights[number]));
        let sum: f64 = places.iter().enumerate().map(|(number, place)| weight(number) * place.value).sum();
        (!places.is_empty()).then(|| sum / places.len() as f64)
    };
    resampled(places.len(), seed, mean)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]
    use super::*;

    #[test]
    fn rates_of_a_small_table_are_those_computed_by_hand() {
        let counts = TruthCounts {
            blocked: 30,
            false_visible: 10,
            visible: 45,
            false_blocked: 5,
            unproven_visible: 15,
            unproven_blocked: 8,
            unanswered: 10,
        };
        let rates = Rate::ALL.map(|rate| rate.of(&counts).unwrap());
        let expected = [0.1, 0.25, 0.825, 30.0 / 45.0, 0.1];
        assert!(rates.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{rates:?}");
        // of 90 answers 35 are blocked, 30 of them rightly; 32 visible, 30 rightly; 23 unproven, 15 rightly
        let worths = [(Answer::Blocked, 35.0, 30.0), (Answer::Visible, 32.0, 30.0), (Answer::Unproven, 23.0, 15.0)];
        for (answer, answered, right) in worths {
            let [share, of_these] = counts.worth(answer).map(Option::unwrap);
            assert!((share - answered / 90.0).abs() < 1e-12 && (of_these - right / answered).abs() < 1e-12);
        }
        assert_eq!(TruthCounts::default().worth(Answer::Blocked), [None, None]);
        let nothing_blocked = TruthCounts { visible: 3, ..TruthCounts::default() };
        assert_eq!(Rate::FalseVisible.of(&nothing_blocked), None);
        assert_eq!(Rate::Balanced.of(&nothing_blocked), None);
        assert_eq!(Rate::FalseBlocked.of(&nothing_blocked), Some(0.0));
    }

    #[test]
    fn unproven_is_visible_and_counted_on_its_own() {
        let mut counts = TruthCounts::default();
        for (truth, answer) in [(true, Answer::Unproven), (false, Answer::Unproven), (true, Answer::Visible)] {
            counts.add(truth, answer);
        }
        let expected = TruthCounts {
            visible: 2,
            false_visible: 1,
            unproven_visible: 1,
            unproven_blocked: 1,
            ..TruthCounts::default()
        };
        assert_eq!(counts, expected);
    }

    #[test]
    fn the_tenth_percentile_of_twenty_views_is_the_third_lowest() {
        // two of twenty, a tenth, lie below it
        let view = |blocked: u64| vec![TruthCounts { blocked, false_visible: 20 - blocked, ..TruthCounts::default() }];
        let views: Vec<_> = (1..=20).rev().map(view).collect();
        assert_eq!(quantile(&views, Rate::FalseVisible, 0.1), Some(0.1));
        assert_eq!(quantile(&views, Rate::FalseVisible, 1.0), Some(0.95));
        assert_eq!(quantile(&views, Rate::FalseBlocked, 0.1), None);
    }

    #[test]
    fn the_interval_of_independent_tiles_is_that_of_the_binomial() {
        // 400 tiles with one visible target each, of which 100 are called blocked: 0.25 ± 1.96·√(0.25·0.75/400) = ±
        // 0.0424
        let tile = |i: u64| TruthCounts {
            false_blocked: u64::from(i.is_multiple_of(4)),
            visible: u64::from(!i.is_multiple_of(4)),
            ..TruthCounts::default()
        };
        let views = [(0..400).map(tile).collect::<Vec<_>>()];
        let found = interval(&views, Rate::FalseBlocked, 1).unwrap();
        assert!((found.value - 0.25).abs() < 1e-12);
        // the ends of 400 resamples scatter by about a sixth of the standard error of 0.022
        assert!((found.low - 0.2076).abs() < 0.012 && (found.high - 0.2924).abs() < 0.012, "{found:?}");
    }

    #[test]
    fn errors_in_one_patch_make_a_wide_interval() {
        let spread: Vec<TruthCounts> =
            (0..50).map(|_| TruthCounts { false_blocked: 10, visible: 90, ..TruthCounts::default() }).collect();
        let patch: Vec<TruthCounts> = (0..50)
            .map(|i| {
                if i < 5 {
                    TruthCounts { false_blocked: 100, ..TruthCounts::default() }
                } else {
                    TruthCounts { visible: 100, ..TruthCounts::default() }
                }
            })
            .collect();
        let [spread, patch] = [spread, patch].map(|view| interval(&[view], Rate::FalseBlocked, 1).unwrap());
        assert!((spread.value - patch.value).abs() < 1e-12);
        assert!(spread.high - spread.low < 1e-12 && patch.high - patch.low > 0.1, "{spread:?} {patch:?}");
    }

    #[test]
    fn views_without_the_rate_do_not_count_and_unscored_targets_do_not_either() {
        let tiles = Tiles::new(&[[0.0, 0.0, 0.0], [1.0, 0.0, 5.0], [30.0, 0.0, 0.0]], 25.0);
        assert_eq!((tiles.of_target.as_slice(), tiles.count), ([0, 0, 1].as_slice(), 2));
        let (v, b) = (Answer::Visible, Answer::Blocked);
        let view = count_by_tile(&tiles, &[Some(true), None, Some(true)], &[b, b, v]);
        assert_eq!(view[0], TruthCounts { false_blocked: 1, ..TruthCounts::default() });
        let all_blocked = count_by_tile(&tiles, &[Some(false); 3], &[b, b, Answer::OutsideView]);
        let found = interval(&[view.clone(), all_blocked.clone()], Rate::FalseBlocked, 3).unwrap();
        assert!((found.value - 0.5).abs() < 1e-12);
        let unanswered = interval(&[all_blocked], Rate::Unanswered, 3).unwrap();
        assert!((unanswered.value - 1.0 / 3.0).abs() < 1e-12);
        assert_eq!(interval(&[], Rate::Balanced, 1), None);
    }

    #[test]
    fn places_that_differ_widen_the_interval_and_one_place_keeps_its_own() {
        let at = |value: f64| Interval { value, low: value - 0.01, high: value + 0.01 };
        assert_eq!(over_places(&[at(0.3)], 1), Some(at(0.3)));
        assert_eq!(over_places(&[], 1), None);
        let found = over_places(&[at(0.0), at(0.0), at(0.6)], 1).unwrap();
        // of the 27 ways to draw three places 8 have none of the third, and 1 has it three times
        assert!((found.value - 0.2).abs() < 1e-12 && found.low.abs() < 1e-12 && (found.high - 0.6).abs() < 1e-12);
    }
}
