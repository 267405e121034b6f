//! Properties of a survey that answers should mention: lines that do not fit, surveys years apart, ground points only,
//! swapped classes.

use crate::strips::{StripOffset, StripReport};
use belvedere_data::cast::{to_cell, to_i64};
use belvedere_data::cloud::ADJUSTED_GPS_EPOCH;
use belvedere_data::weather::date_of_unix_day;
use belvedere_data::{Attributes, GpsTimeKind, PointCloud};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};

/// Findings about a survey beside its surfaces.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SurveyFindings {
    /// Heights of flight lines, where some of them differ.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub strips: Option<StripReport>,
    /// Surveys months apart, oldest first. Empty for a single one.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub surveys: Vec<DatedSurvey>,
    /// Objects that stand in one of these surveys only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub change: Option<SurveyChange>,
    /// True if all points are ground or water, as in files that are sold for terrain models.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub is_ground_only: bool,
    /// True if all points have one height, as exports of a map have.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub is_level: bool,
    /// Share of the cells with ground in which all ground lies above points of buildings or plants, where that is
    /// more than surveys have.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ground_on_top: Option<f64>,
    /// Median angle between pulses with several returns and their direction by the trajectory, degrees, where that is
    /// more than any trajectory of the same flight errs by.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub trajectory_miss_deg: Option<f64>,
}

/// Flight lines within months of each other.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct DatedSurvey {
    /// First and last day, as 2026-11-28.
    pub days: [String; 2],
    /// Point source ids.
    pub lines: Vec<u16>,
    /// Number of points.
    pub points: usize,
}

/// Places where one of two surveys has something that the other has not.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SurveyChange {
    /// Area on the map, m².
    pub area_m2: f64,
    /// Maximum difference in height, metres.
    pub max_m: f64,
    /// Position of the change, local metres.
    pub at: [f64; 2],
}

/// Days without a point between two surveys: a season.
const MAX_GAP_DAYS: i64 = 60;
/// Seconds of a day.
const DAY: f64 = 86_400.0;
/// Fewest points that show that a survey holds nothing but ground.
const MIN_GROUND_POINTS: usize = 100;
/// Side of the cells in which surveys are compared, metres, and the fewest points of each in a cell.
const CELL: f64 = 2.0;
const MIN_POINTS: u32 = 3;
/// Minimum difference of the highest points that is a change, metres.
const MIN_CHANGE: f64 = 2.0;
/// Neighbouring cells that must have changed as well: an edge changes with every flight.
const MIN_CHANGED_ABOUT: usize = 3;
/// Fewest points whose equal heights are no survey: noise of centimetres is in each.
const MIN_LEVEL_POINTS: usize = 1000;
/// Distance of ground above other classes, metres, and the share of cells from which on classes are swapped. Surveys
/// of towns have less than 1 %, beside bridges and cellars.
const MIN_ON_TOP: f32 = 1.0;
const MIN_ON_TOP_SHARE: f64 = 0.2;
/// Fewest cells with both.
const MIN_ON_TOP_CELLS: usize = 20;

impl SurveyFindings {
    /// Finds the surveys and changes of a cloud. Its strips are compared elsewhere.
    #[must_use]
    pub fn of_cloud(cloud: &PointCloud) -> Self {
        let (surveys, change) = dated(cloud);
        Self {
            surveys,
            change,
            is_ground_only: is_ground_only(&cloud.attributes),
            is_level: is_level(&cloud.positions),
            ground_on_top: ground_on_top(cloud),
            ..Self::default()
        }
    }

    /// Returns true if there are no findings.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// Writes it for the provenance of a model.
    pub(super) fn to_text(&self) -> Option<String> {
        serde_json::to_string(self).ok()
    }

    /// Reads the text of [`SurveyFindings::to_text`]; other text gives no findings.
    pub(super) fn from_text(text: &str) -> Self {
        serde_json::from_str(text).unwrap_or_default()
    }

    /// Returns the offsets of the flight lines that were moved.
    #[must_use]
    pub fn moved_strips(&self) -> &[StripOffset] {
        self.strips.as_ref().map_or(&[], |strips| &strips.moved)
    }
}

fn is_ground_only(attributes: &Attributes) -> bool {
    let classes = attributes.classification.as_deref().unwrap_or_default();
    // ground, key points of it, water, and noise
    classes.len() >= MIN_GROUND_POINTS
        && classes.contains(&2)
        && classes.iter().all(|class| matches!(class, 2 | 7..=9 | 18 | 20 | 40 | 41))
}

/// Returns true if all of many points have one height.
fn is_level(positions: &[[f32; 3]]) -> bool {
    positions.len() >= MIN_LEVEL_POINTS && positions.iter().all(|p| p[2] == positions[0][2])
}

/// Share of the cells with ground, and with buildings or plants, whose ground lies above these.
fn ground_on_top(cloud: &PointCloud) -> Option<f64> {
    let classes = cloud.attributes.classification.as_deref()?;
    let mut cells: BTreeMap<[i32; 2], [f32; 2]> = BTreeMap::new();
    for (p, class) in cloud.positions.iter().zip(classes) {
        let side = match class {
            2 => 0,
            3..=6 => 1,
            _ => continue,
        };
        let lowest = &mut cells.entry(cell_of(*p)).or_insert([f32::INFINITY; 2])[side];
        *lowest = lowest.min(p[2]);
    }
    cells.retain(|_, lowest| lowest.iter().all(|height| height.is_finite()));
    let on_top = cells.values().filter(|[ground, other]| ground - other >= MIN_ON_TOP).count();
    let share = on_top as f64 / cells.len().max(1) as f64;
    (cells.len() >= MIN_ON_TOP_CELLS && share >= MIN_ON_TOP_SHARE).then_some(share)
}

/// Cell of a position in which surveys and classes are compared.
fn cell_of(position: [f32; 3]) -> [i32; 2] {
    [0, 1].map(|i| to_cell(f64::from(position[i]) / CELL))
}

/// Day of a GPS time, days since 1970.
pub(super) fn unix_day_of(gps_time: f64) -> Option<i64> {
    let day = ((gps_time + ADJUSTED_GPS_EPOCH) / DAY).floor();
    (day.abs() < 1e7).then_some(to_i64(day))
}

/// The surveys of a cloud by gaps of months, where there are several, and the changes between the first and the last.
fn dated(cloud: &PointCloud) -> (Vec<DatedSurvey>, Option<SurveyChange>) {
    let attributes = &cloud.attributes;
    let Some(times) = attributes.gps_time.as_deref().filter(|_| is_dated(attributes)) else {
        return Default::default();
    };
    let lines = attributes.point_source_id.as_deref().unwrap_or_default();
    let mut days: BTreeMap<i64, (usize, BTreeSet<u16>)> = BTreeMap::new();
    let mut last = None;
    for (row, &time) in times.iter().enumerate() {
        let Some(day) = unix_day_of(time) else { continue };
        let line = lines.get(row).copied();
        let of_day = days.entry(day).or_default();
        of_day.0 += 1;
        if last != Some((day, line)) {
            of_day.1.extend(line);
            last = Some((day, line));
        }
    }
    let mut surveys: Vec<([i64; 2], usize, BTreeSet<u16>)> = Vec::new();
    for (day, (points, lines)) in days {
        match surveys.last_mut().filter(|survey| day - survey.0[1] <= MAX_GAP_DAYS) {
            Some(survey) => {
                survey.0[1] = day;
                survey.1 += points;
                survey.2.extend(lines);
            }
            None => surveys.push(([day; 2], points, lines)),
        }
    }
    let [([_, first_ends], ..), .., ([last_begins, _], ..)] = surveys[..] else { return Default::default() };
    let change = change(cloud, times, [first_ends, last_begins]);
    let in_words = |(days, points, lines): ([i64; 2], usize, BTreeSet<u16>)| DatedSurvey {
        days: days.map(day_in_words),
        lines: lines.into_iter().collect(),
        points,
    };
    (surveys.into_iter().map(in_words).collect(), change)
}

/// Returns true if GPS times of a cloud determine the day.
fn is_dated(attributes: &Attributes) -> bool {
    attributes.gps_time_kind == GpsTimeKind::AdjustedStandard
}

pub(super) fn day_in_words(day: i64) -> String {
    date_of_unix_day(day).map_or_else(|| format!("day {day}"), |date| date.to_string())
}

/// Finds the place where the highest points up to one day and those from another day on differ, without plants and
/// water.
fn change(cloud: &PointCloud, times: &[f64], [until, from]: [i64; 2]) -> Option<SurveyChange> {
    let classes = cloud.attributes.classification.as_deref().unwrap_or_default();
    let mut cells: BTreeMap<[i32; 2], [(u32, f32); 2]> = BTreeMap::new();
    for (row, (p, &time)) in cloud.positions.iter().zip(times).enumerate() {
        let Some(day) = unix_day_of(time).filter(|day| *day <= until || *day >= from) else { continue };
        if classes.get(row).is_some_and(|class| matches!(class, 3..=5 | 7 | 9 | 18)) {
            continue;
        }
        let of_cell = cells.entry(cell_of(*p)).or_insert([(0, f32::NEG_INFINITY); 2]);
        let (count, highest) = &mut of_cell[usize::from(day >= from)];
        (*count, *highest) = (*count + 1, highest.max(p[2]));
    }
    let changes: BTreeMap<[i32; 2], f64> = cells
        .into_iter()
        .filter(|(_, of_cell)| of_cell.iter().all(|(count, _)| *count >= MIN_POINTS))
        .map(|(cell, [(_, a), (_, b)])| (cell, f64::from((b - a).abs())))
        .filter(|(_, change)| *change >= MIN_CHANGE)
        .collect();
    let is_large = |[x, y]: [i32; 2]| {
        let about = (y - 1..=y + 1).flat_map(|y| (x - 1..=x + 1).map(move |x| [x, y]));
        about.filter(|cell| changes.contains_key(cell)).count() > MIN_CHANGED_ABOUT
    };
    let mut found: Option<SurveyChange> = None;
    for (&cell, &change) in changes.iter().filter(|(cell, _)| is_large(**cell)) {
        let area = CELL * CELL;
        let at = cell.map(|v| (f64::from(v) + 0.5) * CELL);
        let so_far = found.get_or_insert(SurveyChange { area_m2: 0.0, max_m: change, at });
        so_far.area_m2 += area;
        if change > so_far.max_m {
            (so_far.max_m, so_far.at) = (change, at);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A field of 40 m with a hut of 12 m in the first survey, four years before the second.
    fn surveys() -> PointCloud {
        let mut cloud = PointCloud::default();
        let (mut times, mut lines, mut classes) = (Vec::new(), Vec::new(), Vec::new());
        for (survey, second) in [(0_u16, 300_001_000.0), (1, 430_001_000.0)] {
            for i in 0..6400_u16 {
                let [x, y] = [i % 80, i / 80].map(|v| 0.5 * f32::from(v));
                let is_hut = survey == 0 && (10.0..22.0).contains(&x) && (10.0..22.0).contains(&y);
                cloud.positions.push([x, y, if is_hut { 5.0 } else { 0.0 }]);
                classes.push(if is_hut { 6 } else { 2 });
                times.push(second + f64::from(i) / 1000.0);
                lines.push(1 + 10 * survey);
            }
        }
        cloud.attributes = Attributes {
            gps_time: Some(times),
            gps_time_kind: GpsTimeKind::AdjustedStandard,
            point_source_id: Some(lines),
            classification: Some(classes),
            ..Attributes::default()
        };
        cloud
    }

    #[test]
    fn surveys_years_apart_are_named_with_what_changed() {
        let found = SurveyFindings::of_cloud(&surveys());
        // 1.3·10⁹ s and 1.43·10⁹ s of GPS time: 17 March 2021 and 29 April 2025
        let days: Vec<&str> = found.surveys.iter().map(|survey| survey.days[0].as_str()).collect();
        assert_eq!(days, ["2021-03-17", "2025-04-29"]);
        assert_eq!(found.surveys.iter().map(|survey| survey.lines.clone()).collect::<Vec<_>>(), [vec![1], vec![11]]);
        let change = found.change.unwrap();
        // 36 cells of the hut, four of which have too few neighbours
        assert!((128.0..=144.0).contains(&change.area_m2) && change.max_m == 5.0, "{change:?}");
        assert!(!found.is_ground_only);
        let mut first = surveys();
        first = first.select(&(0..6400).collect::<Vec<u32>>());
        assert!(SurveyFindings::of_cloud(&first).is_empty());
        // without dates nothing is known
        let mut weekly = surveys();
        weekly.attributes.gps_time_kind = GpsTimeKind::SecondsOfWeek;
        assert!(SurveyFindings::of_cloud(&weekly).is_empty());
    }

    #[test]
    fn ground_alone_is_said() {
        let mut cloud = surveys();
        cloud.attributes.gps_time = None;
        cloud.attributes.classification = Some(vec![2; cloud.len()]);
        assert!(SurveyFindings::of_cloud(&cloud).is_ground_only);
        cloud.attributes.classification = Some(vec![1; cloud.len()]);
        assert!(!SurveyFindings::of_cloud(&cloud).is_ground_only);
    }

    #[test]
    fn one_height_and_swapped_classes_are_said() {
        let mut cloud = surveys();
        cloud.attributes.gps_time = None;
        assert!(SurveyFindings::of_cloud(&cloud).is_empty());
        // a second layer of points below the hut, as ground, and their classes swapped
        let below: Vec<[f32; 3]> = cloud.positions.iter().filter(|p| p[2] > 0.0).map(|p| [p[0], p[1], 0.0]).collect();
        let classes = cloud.attributes.classification.as_mut().unwrap();
        classes.extend(below.iter().map(|_| 2));
        cloud.positions.extend(below);
        cloud.attributes =
            Attributes { classification: cloud.attributes.classification.take(), ..Attributes::default() };
        assert!(SurveyFindings::of_cloud(&cloud).is_empty());
        let classes = cloud.attributes.classification.as_mut().unwrap();
        classes.iter_mut().for_each(|class| *class = 8 - *class);
        assert_eq!(SurveyFindings::of_cloud(&cloud).ground_on_top, Some(1.0));
        cloud.positions.iter_mut().for_each(|p| p[2] = 7.0);
        let level = SurveyFindings::of_cloud(&cloud);
        assert!(level.is_level && level.ground_on_top.is_none());
    }
}
