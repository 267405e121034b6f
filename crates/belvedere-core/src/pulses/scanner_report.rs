//! Report of the scanner positions, and its text for a reader.

use super::flight_parts::{HeightOffset, ScanAnglePart, SensorPart};
use super::group::PulseReport;
use super::line_path::{FoundBy, LinePath};
use super::time_offset::TimeOffset;
use belvedere_data::report::{percent, rounded};
use belvedere_data::trajectory::ClockOffset;
use serde::{Serialize, Serializer, ser::SerializeMap};
use std::collections::BTreeMap;

/// Report of [`locate`](super::locate).
///
/// Serialised, it gives shares and medians for a reader and leaves out the parts of flight lines;
/// [`ScannerReport::lines`] gives each line.
#[derive(Clone, Debug, Default)]
pub struct ScannerReport {
    /// Points in all.
    pub point_count: usize,
    /// Points whose scanner each means found; those not counted are unknown.
    pub found: BTreeMap<FoundBy, usize>,
    /// Outcome of grouping returns into pulses, where that was tried and possible.
    pub grouping: Option<PulseReport>,
    /// Parts of flight lines by their pulses with several returns.
    pub parts: Vec<SensorPart>,
    /// Parts of flight lines by their scan angles.
    pub angle_parts: Vec<ScanAnglePart>,
    /// Paths of the scanner, by line; those from returns come before those from scan angles.
    pub paths: Vec<LinePath>,
    /// Conversion of GPS times to those of the trajectory, if one was given.
    pub clock: Option<ClockOffset>,
    /// Time offset of that trajectory; `None` if it fits, and if pulses do not show it.
    pub time_offset: Option<TimeOffset>,
    /// Height offset of that trajectory; `None` if pulses do not show it.
    pub height_offset: Option<HeightOffset>,
    /// Stations of tripods that were found in the points, by point source id.
    pub stations: Vec<FoundStation>,
    /// Inputs that could not be used, with the reason.
    pub remarks: Vec<String>,
}

/// A station of a tripod that was found in the points.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FoundStation {
    /// Point source id of the points that it was found in; `None` where all have the same.
    #[serde(rename = "point_source_id", skip_serializing_if = "Option::is_none")]
    pub source_id: Option<u16>,
    /// Position of the station, in the coordinates of the cloud's file.
    #[serde(serialize_with = "to_three_digits")]
    pub position: [f64; 3],
    /// Steps from pulse to pulse, around and up, degrees: the evidence is that directions form this grid.
    #[serde(rename = "grid_of_pulses_deg", serialize_with = "to_three_digits")]
    pub step_deg: [f64; 2],
    /// Points that were measured from it.
    #[serde(rename = "points")]
    pub point_count: usize,
}

fn to_three_digits<S: Serializer, const N: usize>(values: &[f64; N], serializer: S) -> Result<S::Ok, S::Error> {
    values.map(|v| rounded(v, 3)).as_slice().serialize(serializer)
}

/// Flight of a scanner: medians over parts of flight lines, `None` where nothing is known.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct TypicalFlight {
    /// Speed over the ground and upward, metres per second.
    #[serde(rename = "speed_m_per_s", skip_serializing_if = "Option::is_none")]
    pub speed: Option<f64>,
    /// Height above the ground, metres.
    #[serde(rename = "height_above_ground_m", skip_serializing_if = "Option::is_none")]
    pub height: Option<f64>,
    /// Standard deviation of the position, metres.
    #[serde(rename = "position_deviation_m", skip_serializing_if = "Option::is_none")]
    pub position_sd: Option<f64>,
    /// Angle between the pulses and the directions to the scanner, degrees.
    #[serde(rename = "angle_residual_deg", skip_serializing_if = "Option::is_none")]
    pub angle_residual_deg: Option<f64>,
}

/// One flight line of a cloud.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FlightLine {
    /// Its number (point source id).
    pub number: u16,
    /// Source of the scanner position, in words.
    pub found_by: &'static str,
    /// Its flight.
    #[serde(flatten)]
    pub flight: TypicalFlight,
}

impl TypicalFlight {
    fn of(parts: &[&SensorPart]) -> Self {
        let median = |digits: i32, value: &dyn Fn(&SensorPart) -> f64| {
            let mut values: Vec<f64> = parts.iter().map(|part| value(part)).filter(|v| v.is_finite()).collect();
            values.sort_by(f64::total_cmp);
            values.get(values.len() / 2).map(|&middle| rounded(middle, digits))
        };
        let length = |v: [f64; 3]| v.iter().map(|v| v * v).sum::<f64>().sqrt();
        Self {
            speed: median(1, &|part| length(part.velocity)),
            height: median(0, &|part| part.height),
            position_sd: median(2, &|part| length(part.position_sd)),
            angle_residual_deg: median(3, &|part| part.median_angle.to_degrees()),
        }
    }
}

impl ScannerReport {
    /// Points whose scanner position is known, or assumed.
    #[must_use]
    pub fn known_count(&self) -> usize {
        self.found.values().sum()
    }

    /// Returns true if some positions are an assumption.
    #[must_use]
    pub fn is_assumed(&self) -> bool {
        self.found.contains_key(&FoundBy::Assumed)
    }

    /// Numbers of the flight lines whose path was found, ascending.
    fn line_numbers(&self) -> Vec<u16> {
        let mut lines: Vec<u16> = self.paths.iter().map(|path| path.source_id).collect();
        lines.dedup();
        lines
    }

    /// The flight of the whole survey.
    #[must_use]
    pub fn flight(&self) -> TypicalFlight {
        TypicalFlight::of(&self.parts.iter().filter(|part| part.verdict.is_used()).collect::<Vec<_>>())
    }

    /// Each flight line whose path was found, by number.
    #[must_use]
    pub fn lines(&self) -> Vec<FlightLine> {
        let line = |number: u16| {
            let by = self.paths.iter().find(|path| path.source_id == number).map(|path| path.means.name());
            let parts = self.parts.iter().filter(|part| part.source_id == number && part.verdict.is_used());
            let flight = TypicalFlight::of(&parts.collect::<Vec<_>>());
            FlightLine { number, found_by: by.unwrap_or_default(), flight }
        };
        self.line_numbers().into_iter().map(line).collect()
    }

    pub(super) fn count(&mut self, means: FoundBy, count: usize) {
        if count > 0 {
            *self.found.entry(means).or_default() += count;
        }
    }
}

impl Serialize for ScannerReport {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        let names: Vec<&str> = self.found.keys().map(|means| means.name()).collect();
        map.serialize_entry("found_by", &names.join(", then "))?;
        map.serialize_entry("scanner_known_percent", &percent(self.known_count(), self.point_count))?;
        if self.found.len() > 1 {
            for (means, &count) in &self.found {
                map.serialize_entry(means.key(), &percent(count, self.point_count))?;
            }
        }
        let lines = self.line_numbers();
        if !lines.is_empty() {
            map.serialize_entry("flight_lines", &lines.len())?;
        }
        let flight = self.flight();
        let entries = [
            ("speed_m_per_s", flight.speed),
            ("height_above_ground_m", flight.height),
            ("position_deviation_m", flight.position_sd),
            ("angle_residual_deg", flight.angle_residual_deg),
        ];
        for (key, value) in entries {
            if let Some(value) = value {
                map.serialize_entry(key, &value)?;
            }
        }
        if !self.stations.is_empty() {
            map.serialize_entry("stations_found", &self.stations.len())?;
            map.serialize_entry("stations", &self.stations)?;
        }
        if let Some(TimeOffset { seconds, is_applied, .. }) = self.time_offset {
            map.serialize_entry("trajectory_time_offset_s", &rounded(seconds, 2))?;
            map.serialize_entry("trajectory_time_offset_corrected", if is_applied { "yes" } else { "no" })?;
        }
        if let Some(HeightOffset { offset, sd, is_applied, .. }) = self.height_offset {
            map.serialize_entry("trajectory_height_offset_m", &rounded(offset, 2))?;
            map.serialize_entry("trajectory_height_offset_deviation_m", &rounded(sd, 2))?;
            let is_corrected = if is_applied { "yes" } else { "no: it may be chance" };
            map.serialize_entry("trajectory_height_offset_corrected", is_corrected)?;
        }
        if let Some(clock) = self.clock.filter(|clock| clock.leap_seconds != 0.0) {
            map.serialize_entry("leap_seconds_added_to_times", &clock.leap_seconds)?;
        }
        if !self.remarks.is_empty() {
            map.serialize_entry("remarks", &self.remarks)?;
        }
        map.end()
    }
}
