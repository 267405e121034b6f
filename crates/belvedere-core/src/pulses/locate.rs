//! Locates the scanner for each point, by the best means at hand.

use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};

use super::estimate::{self, height_offset, paths_from_angles, paths_from_returns};
use super::flight_parts::{
    AngleVerdict, HeightOffset, PartVerdict, ScanAngleParams, ScanAnglePart, SensorEstimateParams,
};
use super::group::{Pulses, group};
use super::line_path::{FoundBy, position_on};
use super::scanner_report::{FoundStation, ScannerReport};
use super::time_offset::{TimeOffset, time_offset};
use super::vertical::{VerticalParams, vertical_pulses};
use belvedere_data::cloud::to_local;
use belvedere_data::control::Control;
use belvedere_data::trajectory::Trajectory;
use belvedere_data::{Error, PointCloud, Result};

/// Sources of scanner positions.
#[derive(Clone, Copy, Debug, Default)]
pub enum Means<'a> {
    /// Tries poses in the file, then pulses with several returns, then trusted scan angles. If these locate the scanner
    /// of no point, tries stations of tripods that the points show, and at last assumes that pulses fall straight down.
    #[default]
    Automatic,
    /// Pulses with several returns, then scan angles, and no assumption.
    Pulses,
    /// Poses in the file: [`PointCloud::scanner_positions`].
    Poses,
    /// One scanner here, local metres.
    Position([f32; 3]),
    /// Stations by the point source id of their points, metres in the cloud's reference system.
    Stations(&'a [(u16, [f64; 3])]),
    /// A path known from elsewhere. Its heights are corrected by a constant where pulses with several returns say so.
    Trajectory(&'a Trajectory),
}

/// Parameters of [`locate`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LocateParams {
    /// Pulses with several returns.
    pub returns: SensorEstimateParams,
    /// Scan angles.
    pub angles: ScanAngleParams,
    /// Assumed pulses.
    pub vertical: VerticalParams,
}

/// Local position of the scanner for each point of `cloud`, (N, 3) metres, NaN where it is not known; and how it was
/// found.
///
/// The scanner of every point with a time on a known path is found, even if its pulse is unknown. Which points and
/// parts of lines are left out and why is in the report. The result is the same for any number of threads and, but for
/// points of the same pulse and number, any order of the points.
///
/// # Errors
/// - [`Error::MissingAttribute`] if the requested means find the scanner of no point. [`Means::Automatic`] finds at
///   least one, except in clouds with poses that no point refers to: a scanner on the ground does not look straight
///   down.
/// - [`Error::LengthMismatch`] for a column of another length than the positions.
/// - [`Error::InvalidParameter`] for parameters out of range, and for a trajectory that covers no time of the cloud.
/// - [`Error::Cancelled`].
pub fn locate(
    cloud: &PointCloud,
    means: &Means<'_>,
    params: &LocateParams,
    control: &Control<'_>,
) -> Result<(Vec<[f32; 3]>, ScannerReport)> {
    cloud.validate()?;
    let mut report = ScannerReport { point_count: cloud.len(), ..ScannerReport::default() };
    let positions = match means {
        Means::Position(position) => {
            report.count(FoundBy::Position, cloud.len());
            vec![*position; cloud.len()]
        }
        Means::Poses => by_poses(cloud, &mut report),
        Means::Stations(stations) => by_stations(cloud, stations, &mut report)?,
        Means::Trajectory(trajectory) => by_trajectory(cloud, trajectory, &mut report, control)?,
        Means::Automatic if !cloud.scanner_positions.is_empty() => by_poses(cloud, &mut report),
        Means::Automatic | Means::Pulses => by_pulses(cloud, params, &mut report, control)?,
    };
    if report.known_count() > 0 || cloud.is_empty() {
        return Ok((positions, report));
    }
    match means {
        Means::Automatic if cloud.scanner_positions.is_empty() => {
            let (positions, stations) = estimate::stations_of_tripods(cloud, control)?;
            if !stations.is_empty() {
                report.count(FoundBy::StationSearch, positions.iter().filter(|p| is_known(p)).count());
                report.stations = stations;
                remark_stations(&mut report);
                return Ok((positions, report));
            }
            let positions = vertical_pulses(&cloud.positions, &params.vertical, control)?;
            report.count(FoundBy::Assumed, positions.iter().filter(|p| is_known(p)).count());
            report.remarks.push("pulses are assumed to be vertical, onto points with nothing above them".to_owned());
            Ok((positions, report))
        }
        Means::Pulses => {
            // what grouping found missing says it best
            group(cloud, control)?;
            Err(Error::MissingAttribute {
                attribute: "pulses with several returns far enough apart, and no reliable scan angles",
                needed_for: "finding the scanner",
                advice: "give a trajectory",
            })
        }
        _ => Err(Error::MissingAttribute {
            attribute: "scanner position",
            needed_for: "finding the scanner positions",
            advice: "give the position of the scanner or a trajectory",
        }),
    }
}

fn is_known(position: &[f32; 3]) -> bool {
    position.iter().all(|v| v.is_finite())
}

fn by_poses(cloud: &PointCloud, report: &mut ScannerReport) -> Vec<[f32; 3]> {
    let unknown = [f32::NAN; 3];
    let position = |index: &u16| cloud.scanner_positions.get(usize::from(*index)).copied().unwrap_or(unknown);
    let positions = match (&cloud.attributes.scanner_index, &cloud.scanner_positions[..]) {
        (Some(indices), _) => indices.iter().map(position).collect(),
        (None, [only]) => vec![*only; cloud.len()],
        (None, _) => {
            report.remarks.push("the file has several scanner positions, but does not assign them to points".into());
            vec![unknown; cloud.len()]
        }
    };
    report.count(FoundBy::Pose, positions.iter().filter(|p| is_known(p)).count());
    positions
}

fn by_stations(cloud: &PointCloud, stations: &[(u16, [f64; 3])], report: &mut ScannerReport) -> Result<Vec<[f32; 3]>> {
    let Some(ids) = &cloud.attributes.point_source_id else {
        return Err(Error::MissingAttribute {
            attribute: "point source id",
            needed_for: "finding the station of each point",
            advice: "give the position of the scanner, or write each station as a file of its own with its number as point source id",
        });
    };
    let places: BTreeMap<u16, [f32; 3]> =
        stations.iter().map(|&(id, place)| (id, to_local(place, cloud.frame.origin))).collect();
    let unknown: BTreeSet<u16> = ids.iter().copied().filter(|id| !places.contains_key(id)).collect();
    if !unknown.is_empty() {
        let some: Vec<String> = unknown.iter().take(8).map(u16::to_string).collect();
        report.remarks.push(format!("no station is given for point source id {}", some.join(", ")));
    }
    let positions: Vec<[f32; 3]> = ids.iter().map(|id| places.get(id).copied().unwrap_or([f32::NAN; 3])).collect();
    report.count(FoundBy::Station, positions.iter().filter(|p| is_known(p)).count());
    Ok(positions)
}

fn by_trajectory(
    cloud: &PointCloud,
    trajectory: &Trajectory,
    report: &mut ScannerReport,
    control: &Control<'_>,
) -> Result<Vec<[f32; 3]>> {
    let (mut positions, mut clock) = trajectory.scanner_positions(cloud)?;
    control.check()?;
    let pulses = pulses_of(cloud, report, control)?;
    report.time_offset = pulses.as_ref().and_then(|pulses| time_offset(cloud, pulses, trajectory, &clock));
    if let Some(TimeOffset { seconds, is_applied: true, .. }) = report.time_offset {
        clock.leap_seconds += seconds;
        let times = cloud.attributes.gps_time.as_deref().unwrap_or_default();
        positions = trajectory.positions_by(&clock, times, cloud);
        clock.known_count = positions.iter().filter(|p| is_known(p)).count();
    }
    report.clock = Some(clock);
    report.count(FoundBy::Trajectory, positions.iter().filter(|p| is_known(p)).count());
    match pulses {
        Some(pulses) => {
            let per_pulse = trajectory.positions_by(&clock, &pulses.times, cloud);
            report.height_offset = height_offset(cloud, &pulses, &per_pulse);
            if report.height_offset.is_none() {
                report.remarks.push(
                    "too few pulses have several returns far enough apart to check the heights of the trajectory"
                        .into(),
                );
            }
        }
        None => report.remarks.push("the heights of the trajectory could not be checked".into()),
    }
    if let Some(HeightOffset { offset, is_applied: true, .. }) = report.height_offset {
        positions
            .par_iter_mut()
            .for_each(|p| *p = to_local([p[0].into(), p[1].into(), f64::from(p[2]) + offset], [0.0; 3]));
    }
    Ok(positions)
}

/// The pulses of the cloud, or `None` after a remark.
fn pulses_of(cloud: &PointCloud, report: &mut ScannerReport, control: &Control<'_>) -> Result<Option<Pulses>> {
    match group(cloud, control) {
        Ok((pulses, grouping)) => {
            report.grouping = Some(grouping);
            let mut remark = |count: usize, what: &str| {
                if count > 0 {
                    report.remarks.push(format!("{count} points {what}"));
                }
            };
            remark(grouping.without_time_count, "have no time, so they do not come from a scanner");
            remark(grouping.ambiguous_count, "share their time with others, so their pulses are unknown");
            remark(grouping.duplicate_count, "are there twice");
            Ok(Some(pulses))
        }
        Err(Error::Cancelled) => Err(Error::Cancelled),
        Err(error) => {
            report.remarks.push(error.to_string());
            Ok(None)
        }
    }
}

fn by_pulses(
    cloud: &PointCloud,
    params: &LocateParams,
    report: &mut ScannerReport,
    control: &Control<'_>,
) -> Result<Vec<[f32; 3]>> {
    let unknown = [f32::NAN; 3];
    let pulses = pulses_of(cloud, report, control)?;
    if !estimate::IS_BUILT {
        report
            .remarks
            .push("this build of Belvedere cannot find the scanner from the points (feature scanner-estimate)".into());
    }
    if let Some(pulses) = &pulses {
        (report.paths, report.parts) = paths_from_returns(cloud, pulses, &params.returns, control)?;
    }
    let Some(times) = &cloud.attributes.gps_time else { return Ok(vec![unknown; cloud.len()]) };
    let line = |row: usize| {
        let lines = cloud.attributes.point_source_id.as_ref();
        lines.and_then(|lines| lines.get(row)).copied().unwrap_or(0)
    };
    let is_known_everywhere = |report: &ScannerReport| {
        let is_on_path = |(row, time): (usize, &f64)| position_on(&report.paths, line(row), *time).is_some();
        times.par_iter().enumerate().all(is_on_path)
    };
    if !is_known_everywhere(report) {
        let (by_angle, parts) = paths_from_angles(cloud, pulses.as_ref(), &params.angles, control)?;
        report.paths.extend(by_angle);
        // by line; the sort keeps those by returns first
        report.paths.sort_by_key(|path| path.source_id);
        report.angle_parts = parts;
    }
    control.check()?;
    let found: Vec<Option<(FoundBy, [f32; 3])>> = times
        .par_iter()
        .enumerate()
        .map(|(row, &time)| {
            let (path, place) = position_on(&report.paths, line(row), time)?;
            Some((path.means, to_local(place, [0.0; 3])))
        })
        .collect();
    for means in [FoundBy::Returns, FoundBy::ScanAngle] {
        report.count(means, found.iter().flatten().filter(|(by, _)| *by == means).count());
    }
    remark_parts(report);
    Ok(found.into_iter().map(|found| found.map_or(unknown, |(_, place)| place)).collect())
}

/// Adds remarks on data that may be missing where stations of tripods were searched for.
fn remark_stations(report: &mut ScannerReport) {
    // why there are no pulses of an aircraft is beside the point
    report.remarks.clear();
    let unknown_count = report.point_count - report.known_count();
    if unknown_count > 0 {
        report.remarks.push(format!(
            "{unknown_count} points are of no station that was found: give the positions of all with --orient stations=FILE, by the point source ids of \
             their points"
        ));
    }
    let is_shared = |(i, station): (usize, &FoundStation)| {
        report.stations.iter().skip(i + 1).any(|other| other.source_id == station.source_id)
    };
    if report.stations.iter().enumerate().any(is_shared) {
        let remark =
            "points of several stations have no ids: each is taken for the nearest station that can have seen it";
        report.remarks.push(remark.to_owned());
    }
}

/// Says which parts of flight lines could not be used, and why.
fn remark_parts(report: &mut ScannerReport) {
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for part in &report.parts {
        let why = match part.verdict {
            PartVerdict::Accepted => continue,
            PartVerdict::Bridged => "parts of flight lines are interpolated from their neighbours",
            PartVerdict::TooFewPairs => {
                "parts of flight lines have too few pulses with several returns far enough apart"
            }
            PartVerdict::Uncertain => {
                "parts of flight lines have pulses that do not determine the scanner position well enough"
            }
            PartVerdict::Implausible => "parts of flight lines have pulses that give an impossible scanner position",
        };
        *counts.entry(why).or_default() += 1;
    }
    let is_needed = |part: &&ScanAnglePart| {
        let middle = f64::midpoint(part.times[0], part.times[1]);
        position_on(&report.paths, part.source_id, middle).is_none_or(|(path, _)| path.means != FoundBy::Returns)
    };
    for part in report.angle_parts.iter().filter(is_needed) {
        let why = match part.verdict {
            AngleVerdict::Accepted if part.pitch.total_cmp(&0.0).is_ne() => continue,
            AngleVerdict::Accepted => {
                "parts use only scan angles, which do not contain pitch: directions may have errors of a few degrees"
            }
            AngleVerdict::TooFewPoints => "parts have too few points with scan angles",
            AngleVerdict::TooNarrow => "parts have scan angles with too small a range",
            AngleVerdict::NotAcross => {
                "parts have scan angles that do not determine the position across the flight direction: a cone, a tilted scanner or rounded times"
            }
            AngleVerdict::Bent => "parts have scan lines that are curved like those of a cone, or too short",
            AngleVerdict::Contradicted => "parts have scan angles that contradict the pulses",
            AngleVerdict::Implausible => "parts have scan angles that give an impossible scanner position",
        };
        *counts.entry(why).or_default() += 1;
    }
    report.remarks.extend(counts.into_iter().map(|(why, count)| format!("{count} {why}")));
}
