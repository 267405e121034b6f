//! Where the scanner was, and what that gives to carve with.

use super::Carving;
use crate::arguments::{OrientChoice, Orienting};
use crate::progress::Stages;
use crate::summary::{Summary, percent, rounded};
use anyhow::Result;
use belvedere::io::read_trajectory;
use belvedere::pulses::{
    HeightOffset, LocateParams, Means, NeedleParams, Needles, Pulses, ScannerReport, SensorPart, ServedBy, group,
    locate,
};
use belvedere::trajectory::Trajectory;
use belvedere::{Attributes, PointCloud};

/// What carving needs beside an oriented cloud.
pub(crate) struct CarvingInput {
    pub(super) needles: Needles,
    /// Classes, numbers and counts of returns.
    pub(super) kinds: Attributes,
    /// Whether pulses are merely assumed.
    pub(super) is_assumed: bool,
    /// Which returns share a pulse, where times tell.
    pub(super) pulses: Option<Pulses>,
}

/// The needles of a cloud's pulses, reported, and the columns that carving asks for; `None` where pulses are too flat to carve
/// and need not.
pub(super) fn carving_input(
    cloud: &PointCloud,
    (scanner, is_assumed): (&[[f32; 3]], bool),
    carving: Carving,
    stages: &mut Stages,
    summary: &mut Summary,
) -> Result<Option<CarvingInput>> {
    let (needles, report) =
        stages.run("indexing pulses", 0, |_| Needles::of_cloud(cloud, scanner, &NeedleParams::default()))?;
    let mut section = Summary::default();
    section
        .add("used_to_carve", report.used)
        .add("without_scanner", report.without_scanner)
        .add("too_flat", report.too_flat);
    let is_possible = report.used > report.too_flat;
    if !is_possible && carving == Carving::IfPossible {
        section.add(
            "remark",
            "pulses cannot carve here: most are too flat, as of a scanner on the ground; balls are cut to half a metre",
        );
    }
    summary.add("pulses", section);
    if !is_possible && carving == Carving::IfPossible {
        return Ok(None);
    }
    let kinds = Attributes {
        classification: cloud.attributes.classification.clone(),
        return_number: cloud.attributes.return_number.clone(),
        return_count: cloud.attributes.return_count.clone(),
        ..Attributes::default()
    };
    let pulses = group(cloud).ok().map(|(pulses, _)| pulses);
    Ok(Some(CarvingInput { needles, kinds, is_assumed, pulses }))
}

/// Where the scanner was.
#[derive(Default)]
pub(super) struct Located {
    /// For each point, local metres, NaN where unknown.
    pub(super) positions: Vec<[f32; 3]>,
    /// The trajectory where that was read for it.
    pub(super) trajectory: Option<Trajectory>,
    /// Whether pulses are merely assumed to fall straight down.
    pub(super) is_assumed: bool,
}

/// Where the scanner was for each point, reported.
pub(super) fn of_each_point(
    cloud: &PointCloud,
    orienting: &Orienting,
    stages: &mut Stages,
    summary: &mut Summary,
) -> Result<Located> {
    let trajectory = match &orienting.orient {
        OrientChoice::Trajectory(path) => {
            Some(stages.run("reading trajectory", 0, |_| read_trajectory(path, &cloud.frame.crs))?.0)
        }
        _ => None,
    };
    let means = match (&orienting.orient, &trajectory) {
        (_, Some(trajectory)) => Means::Trajectory(trajectory),
        (OrientChoice::ScannerAt(position), _) => Means::Position(cloud.frame.from_file_coordinates(*position)),
        (OrientChoice::Scanner, _) => Means::Poses,
        (OrientChoice::Pulses, _) => Means::Pulses,
        _ => Means::Automatic,
    };
    let (positions, report) =
        stages.run("finding the scanner", 0, |_| locate(cloud, &means, &LocateParams::default()))?;
    summary.add("scanner", section(&report));
    let is_assumed = report.is_assumed();
    Ok(Located { positions, trajectory, is_assumed })
}

/// How the scanner was found.
pub(crate) fn section(report: &ScannerReport) -> Summary {
    let mut section = Summary::default();
    let found_by: Vec<&str> = report.served.keys().map(|&means| name(means)).collect();
    section.add("found_by", found_by.join(", then "));
    section.add("served_percent", percent(report.served_count(), report.point_count));
    if report.served.len() > 1 {
        for (&means, &count) in &report.served {
            section.add(&format!("{}_percent", name(means).replace(' ', "_")), percent(count, report.point_count));
        }
    }
    let used = || report.parts.iter().filter(|part| part.verdict.is_used());
    let mut lines: Vec<u16> = report.paths.iter().map(|path| path.source_id).collect();
    lines.dedup();
    if !lines.is_empty() {
        section.add("flight_lines", lines.len());
    }
    if used().next().is_some() {
        add_typical(&mut section, &used().collect::<Vec<_>>());
    }
    if let Some(HeightOffset { offset, sd, is_applied, .. }) = report.height_offset {
        section.add("height_offset_of_trajectory_m", rounded(offset, 2));
        section.add("height_offset_deviation_m", rounded(sd, 2));
        section.add("height_offset_corrected", if is_applied { "yes" } else { "no: it does not stand out" });
    }
    if let Some(clock) = report.clock
        && clock.leap_seconds != 0.0
    {
        section.add("leap_seconds_added_to_times", clock.leap_seconds);
    }
    section.add("remarks", report.remarks.clone());
    section
}

/// Figures of each flight line.
pub(crate) fn line_sections(report: &ScannerReport) -> Vec<serde_json::Value> {
    let mut lines: Vec<u16> = report.paths.iter().map(|path| path.source_id).collect();
    lines.dedup();
    let section = |line: u16| {
        let mut section = Summary::default();
        section.add("number", line);
        let by: Vec<&str> = report.paths.iter().filter(|p| p.source_id == line).map(|p| name(p.means)).collect();
        section.add("found_by", by.first().copied().unwrap_or_default());
        let parts = report.parts.iter().filter(|part| part.source_id == line && part.verdict.is_used());
        add_typical(&mut section, &parts.collect::<Vec<_>>());
        serde_json::Value::from(section)
    };
    lines.into_iter().map(section).collect()
}

/// Medians over parts of flight lines.
fn add_typical(section: &mut Summary, parts: &[&SensorPart]) {
    let mut add = |name: &str, digits: i32, value: &dyn Fn(&SensorPart) -> f64| {
        let mut values: Vec<f64> = parts.iter().map(|part| value(part)).filter(|v| v.is_finite()).collect();
        values.sort_by(f64::total_cmp);
        if let Some(&middle) = values.get(values.len() / 2) {
            section.add(name, rounded(middle, digits));
        }
    };
    let length = |v: [f64; 3]| v.iter().map(|v| v * v).sum::<f64>().sqrt();
    add("speed_m_per_s", 1, &|part| length(part.velocity));
    add("height_above_ground_m", 0, &|part| part.height);
    add("position_deviation_m", 2, &|part| length(part.position_sd));
    add("angle_residual_deg", 3, &|part| part.median_angle.to_degrees());
}

fn name(means: ServedBy) -> &'static str {
    match means {
        ServedBy::Pose => "poses in the file",
        ServedBy::Position => "the position given",
        ServedBy::Trajectory => "trajectory",
        ServedBy::Returns => "pulses with several returns",
        ServedBy::ScanAngle => "scan angles",
        ServedBy::Assumed => "nothing: pulses are assumed to be vertical",
    }
}
