//! The days on which a survey was measured.

use super::findings::{day_in_words, unix_day_of};
use belvedere_data::{Attributes, GpsTimeKind};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Days on which points were measured, by their GPS times. Empty where these do not tell the day.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct FlightDays {
    /// Number of points of each date, such as 2020-02-12.
    points: BTreeMap<String, usize>,
}

impl FlightDays {
    /// Counts the days of points with these attributes. GPS times name a day if they count from 1980, not from the
    /// beginning of a week.
    #[must_use]
    pub fn of(attributes: &Attributes) -> Self {
        let mut days: BTreeMap<i64, usize> = BTreeMap::new();
        if attributes.gps_time_kind == GpsTimeKind::AdjustedStandard {
            for day in attributes.gps_time.iter().flatten().filter_map(|&time| unix_day_of(time)) {
                *days.entry(day).or_default() += 1;
            }
        }
        Self { points: days.into_iter().map(|(day, points)| (day_in_words(day), points)).collect() }
    }

    /// Returns true if no day is known.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// Each date, such as 2020-02-12, with its number of points, the earliest first.
    pub fn iter(&self) -> impl Iterator<Item = (&str, usize)> {
        self.points.iter().map(|(date, &points)| (date.as_str(), points))
    }

    /// Writes the days as text for the provenance of a model.
    pub(super) fn to_text(&self) -> Option<String> {
        serde_json::to_string(self).ok()
    }

    /// Reads the text of [`FlightDays::to_text`]; no days for other text.
    pub(super) fn from_text(text: &str) -> Self {
        serde_json::from_str(text).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_are_those_of_the_calendar_and_survive_as_text() {
        // 10⁹ s after the beginning of GPS time are 14 September 2011, 1:46:40 of GPS, 15 s before which it is UTC
        let times = vec![0.0, 10.0, 86_400.0];
        let mut attributes =
            Attributes { gps_time: Some(times), gps_time_kind: GpsTimeKind::AdjustedStandard, ..Attributes::default() };
        let days = FlightDays::of(&attributes);
        assert_eq!(days.iter().collect::<Vec<_>>(), [("2011-09-14", 2), ("2011-09-15", 1)]);
        assert_eq!(FlightDays::from_text(&days.to_text().unwrap()), days);
        assert!(FlightDays::from_text("no days").is_empty());
        attributes.gps_time_kind = GpsTimeKind::SecondsOfWeek;
        assert!(FlightDays::of(&attributes).is_empty());
    }
}
