//! Viewshed as measures of its targets.

use super::{SEEN, SEEN_BY, Viewshed};
use crate::shadow::UNPROVEN;
use crate::targets::{Measure, ResultKind};
use belvedere_core::query::Answer;

/// Description of the measure of observers without proof.
const SEEN_WITHOUT_PROOF: &str = "from how many nothing blocks it, but no pulse proves it";

impl Viewshed {
    /// Returns the number of observers from which nothing blocks each target; for one observer 1 or 0. If proof was
    /// tested, a second measure has the unproven part. Targets outside the view have no value.
    #[must_use]
    pub fn to_measures(&self) -> Vec<Measure> {
        let is_target = |answer: Answer| !matches!(answer, Answer::OutsideView | Answer::OutsideCloud);
        let (name, description) = seen_words(self.seen_counts.len());
        let kind = if self.seen_counts.len() == 1 { ResultKind::Answer } else { ResultKind::Count };
        let measure = |name: &str, description, count: &dyn Fn(usize) -> u32| {
            let value = |(row, &answer): (usize, &Answer)| match (is_target(answer), kind) {
                (false, _) => f32::NAN,
                (true, ResultKind::Answer) => f32::from(u8::from(count(row) > 0)),
                (true, _) => f32::from(u16::try_from(count(row)).unwrap_or(u16::MAX)),
            };
            let values = self.answers.iter().enumerate().map(value).collect();
            let range = (kind == ResultKind::Answer).then_some([0.0, 1.0]);
            Measure::new(name, values).with_description(description).with_decimals(0).with_kind(kind).with_range(range)
        };
        let unproven = |row: usize| self.unproven_counts.get(row).copied().unwrap_or(0);
        let free = |row: usize| self.counts.get(row).map_or(0, |count| count + unproven(row));
        let is_tested = !self.unproven_counts.is_empty();
        let first = measure(name, description, &free);
        let second = is_tested.then(|| measure(UNPROVEN, SEEN_WITHOUT_PROOF, &unproven));
        [first].into_iter().chain(second).collect()
    }
}

/// Returns the name of the measure of the cells that so many observers see, and its description.
#[must_use]
pub fn seen_words(observer_count: usize) -> (&'static str, &'static str) {
    if observer_count == 1 { ("visible", SEEN) } else { ("observers", SEEN_BY) }
}
