//! Where the scanner was, and what that gives to carve with.

use crate::arguments::{OrientChoice, Orienting};
use crate::progress::Stages;
use crate::summary::{Summary, percent};
use anyhow::{Result, bail};
use belvedere::io::read_trajectory;
use belvedere::pulses::{NeedleParams, Needles, Pulses, SensorEstimateParams, SensorPositions, group};
use belvedere::trajectory::Trajectory;
use belvedere::{Attributes, PointCloud};

/// What carving needs beside an oriented cloud.
pub(crate) struct CarvingInput {
    pub(super) needles: Needles,
    /// Classes, numbers and counts of returns.
    pub(super) kinds: Attributes,
    /// Which returns share a pulse, where times tell.
    pub(super) pulses: Option<Pulses>,
}

/// The needles of a cloud's pulses, reported, and the columns that carving asks for.
pub(super) fn carving_input(
    cloud: &PointCloud,
    scanner: &[[f32; 3]],
    stages: &mut Stages,
    summary: &mut Summary,
) -> Result<CarvingInput> {
    let (needles, report) =
        stages.run("indexing pulses", 0, |_| Needles::of_cloud(cloud, scanner, &NeedleParams::default()))?;
    let mut section = Summary::default();
    section
        .add("used_to_carve", report.used)
        .add("without_scanner", report.without_scanner)
        .add("too_flat", report.too_flat);
    summary.add("pulses", section);
    let kinds = Attributes {
        classification: cloud.attributes.classification.clone(),
        return_number: cloud.attributes.return_number.clone(),
        return_count: cloud.attributes.return_count.clone(),
        ..Attributes::default()
    };
    let pulses = group(cloud).ok().map(|(pulses, _)| pulses);
    Ok(CarvingInput { needles, kinds, pulses })
}

/// Where the scanner was for each point, and the trajectory where that was read for it.
pub(super) fn of_each_point(
    cloud: &PointCloud,
    orienting: &Orienting,
    stages: &mut Stages,
    summary: &mut Summary,
) -> Result<(Vec<[f32; 3]>, Option<Trajectory>)> {
    let one_for_all = |position: [f32; 3]| Ok((vec![position; cloud.len()], None));
    match &orienting.orient {
        OrientChoice::Trajectory(path) => {
            let (trajectory, _) = stages.run("reading trajectory", 0, |_| read_trajectory(path, &cloud.crs))?;
            Ok((trajectory.scanner_positions(cloud)?.0, Some(trajectory)))
        }
        OrientChoice::ScannerAt(position) => one_for_all(cloud.from_file_coordinates(*position)),
        OrientChoice::Scanner | OrientChoice::Auto if !cloud.scanner_positions.is_empty() => {
            let unknown = [f32::NAN; 3];
            let position = |index: &u16| cloud.scanner_positions.get(usize::from(*index)).copied().unwrap_or(unknown);
            match (&cloud.attributes.scanner_index, &cloud.scanner_positions[..]) {
                (Some(indices), _) => Ok((indices.iter().map(position).collect(), None)),
                (None, [only]) => one_for_all(*only),
                (None, _) => one_for_all(unknown),
            }
        }
        _ => {
            let (pulses, _) = group(cloud)?;
            let (positions, report) = stages.run("finding the scanner", 0, |_| {
                SensorPositions::from_returns(cloud, &pulses, &SensorEstimateParams::default())
            })?;
            if report.known_count == 0 {
                bail!(
                    "where the scanner was cannot be told from the pulses: too few have several returns far enough apart; \
                     give --orient trajectory=FILE"
                );
            }
            let mut section = Summary::default();
            section
                .add("pulses", report.pulse_count)
                .add("served_percent", percent(report.known_count, report.pulse_count))
                .add("parts_of_flight_lines", report.parts.len());
            summary.add("scanner_found_from_pulses", section);
            Ok((positions.per_point(&pulses, cloud.len()), None))
        }
    }
}
