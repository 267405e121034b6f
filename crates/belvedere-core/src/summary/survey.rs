//! Kind of the survey of a cloud, source of the carving of its balls, and advice for better answers.

use crate::pulses::{MIN_ASSUMED_SHARE, ScannerReport, come_from_the_ground};
use crate::summary::CloudSummary;
use belvedere_data::PointCloud;
use belvedere_data::cast::to_cell;
use std::fmt;

/// Minimum share of the points whose scanner must be known for nothing to be missing, percent: points beside the first
/// and last pulses of a flight line stay unknown.
const NEARLY_ALL_PERCENT: f64 = 99.0;

/// Share of the points in the densest twentieth of the ground from which on the scanner stood on it. Measured: 0.10 to
/// 0.20 from the air (Delft, Amsterdam, Bresse, simulated towns), 0.35 from a car, 0.5 from tripods.
const UNEVEN_SHARE: f64 = 0.28;

/// A survey in one line: [`fmt::Display`] joins the three parts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SurveyKind {
    /// Source of the points.
    pub kind: String,
    /// Source of the carving.
    pub carved_by: String,
    /// Advice for better answers.
    pub advice: String,
}

impl fmt::Display for SurveyKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}; {}; {}", self.kind, self.carved_by, self.advice)
    }
}

impl SurveyKind {
    /// Classifies `cloud` by its summary `counted` and by `scanner`, (N, 3) local metres, NaN where unknown. `scanner`
    /// is that of [`locate`](crate::pulses::locate) without further input; it may be empty if nothing was found.
    ///
    /// Whether pulses carve is decided as [`SceneModel::build`](crate::model::SceneModel::build) decides it.
    #[must_use]
    pub fn of(cloud: &PointCloud, counted: &CloudSummary, scanner: &[[f32; 3]], report: &ScannerReport) -> Self {
        if cloud.len() < 4 {
            return Self::new("fewer than four points", "nothing to carve", "add points");
        }
        if report.found.is_empty() {
            let carved_by = "not carved, because the scanner positions are unknown";
            return Self::new("laser scan", carved_by, "give the positions of the scanner");
        }
        if report.is_assumed() {
            return Self::without_pulses(cloud, counted, scanner);
        }
        let means: Vec<&str> = report.found.keys().map(|means| means.name()).collect();
        let known = 100.0 * report.known_count() as f64 / cloud.len() as f64;
        let is_ground = come_from_the_ground(pulses(cloud, scanner));
        let kind = if is_ground {
            let count = cloud.scanner_positions.len().max(report.stations.len());
            let positions = format!(", {count} scanner position{}", plural(count));
            format!("laser scan from the ground{}", if count > 0 { positions.as_str() } else { "" })
        } else {
            let lines = counted.flight_lines.len();
            format!("laser survey from the air, {lines} flight line{}", plural(lines))
        };
        let carved_by = format!("carved by its pulses, whose scanner is known from {}", means.join(" and "));
        let advice = if known < NEARLY_ALL_PERCENT {
            format!("for {:.0} % of the points the scanner is unknown: give its trajectory or positions", 100.0 - known)
        } else if !is_ground && !has_vegetation(counted) {
            "classes of vegetation would improve trees".to_owned()
        } else {
            "nothing is missing".to_owned()
        };
        Self { kind, carved_by, advice }
    }

    /// Classifies a cloud whose scanner could not be found.
    fn without_pulses(cloud: &PointCloud, counted: &CloudSummary, scanner: &[[f32; 3]]) -> Self {
        let open = pulses(cloud, scanner).filter(|(_, scanner)| scanner[2].is_finite()).count();
        let is_from_above = open as f64 >= MIN_ASSUMED_SHARE * cloud.len() as f64;
        let has_times = counted.gps_time.is_some_and(|times| times.can_separate_pulses(cloud.len()));
        let has_angles = counted.scan_angle_deg.is_some_and(|[min, max]| min < max);
        let has_returns = counted.multi_return_share.is_some_and(|share| share > 0.0);
        // readers of LAS give the column in any case, and what was made from photographs leaves it empty
        let has_intensities = cloud.attributes.intensity.iter().flatten().any(|&intensity| intensity > 0);
        let is_laser = has_times || has_angles || has_returns || has_intensities;
        let is_ground = !is_from_above || is_uneven(&cloud.positions, counted.cell_size);
        let carved_by = if is_from_above {
            "carved by pulses that are assumed to be vertical, which prove nothing"
        } else {
            "not carved: balls come from the points alone"
        };
        match (is_ground, is_laser) {
            (false, true) => {
                let advice = if has_times {
                    "give the trajectory of the flight"
                } else {
                    "use the files as delivered, with GPS times and return numbers, before they were merged or reduced"
                };
                Self::new("laser survey from the air without pulses that show the scanner", carved_by, advice)
            }
            (false, false) => Self::new(
                "points without pulses, as from photographs",
                carved_by,
                "a laser survey of the same place would show what is free below roofs and trees",
            ),
            (true, _) => Self::new(
                "points as from a scanner on the ground or in a building, whose positions are unknown",
                carved_by,
                if has_times {
                    "give the trajectory of the scanner, or its positions"
                } else {
                    "give the positions of the scanner, or use the scans as delivered, with poses (E57, PTX)"
                },
            ),
        }
    }

    fn new(kind: &str, carved_by: &str, advice: &str) -> Self {
        Self { kind: kind.to_owned(), carved_by: carved_by.to_owned(), advice: advice.to_owned() }
    }
}

/// Returns true if the densest twentieth of the cells, in plan, holds [`UNEVEN_SHARE`] of the points, as near a scanner
/// on the ground.
fn is_uneven(positions: &[[f32; 3]], side: f64) -> bool {
    let cell = |v: f32| to_cell(f64::from(v) / side);
    let mut cells: Vec<[i32; 2]> = positions.iter().map(|p| [cell(p[0]), cell(p[1])]).collect();
    cells.sort_unstable();
    let mut counts: Vec<usize> = cells.chunk_by(|a, b| a == b).map(<[_]>::len).collect();
    counts.sort_unstable_by(|a, b| b.cmp(a));
    let densest: usize = counts.iter().take(counts.len().div_ceil(20)).sum();
    densest as f64 > UNEVEN_SHARE * positions.len() as f64
}

/// First returns, and where the scanner was.
fn pulses<'a>(cloud: &'a PointCloud, scanner: &'a [[f32; 3]]) -> impl Iterator<Item = ([f32; 3], [f32; 3])> + 'a {
    let numbers = cloud.attributes.return_number.as_deref();
    let is_first = move |row: usize| numbers.and_then(|numbers| numbers.get(row)).is_none_or(|&number| number <= 1);
    let pairs = cloud.positions.iter().copied().zip(scanner.iter().copied()).enumerate();
    pairs.filter(move |(row, _)| is_first(*row)).map(|(_, pair)| pair)
}

/// Returns true if any point has a class of vegetation (ASPRS LAS 1.4, table 17).
fn has_vegetation(counted: &CloudSummary) -> bool {
    (3..=5).any(|class| counted.classes.contains_key(&class))
}

fn plural(count: usize) -> &'static str {
    if count == 1 { "" } else { "s" }
}
