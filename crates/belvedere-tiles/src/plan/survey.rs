//! One pass over all points: their places, their heights, and samples of them.

use crate::columns::append;
use crate::grid::MapArea;
use crate::inputs::{NOWHERE, PIECE_ROWS, PieceCell, PointColumns, hold};
use belvedere::control::Control;
use belvedere::ground::GroundPoints;
use belvedere::io::{CloudBatch, ReadOptions, read_batches};
use belvedere::model::{SampledRows, SurveyCounts, SurveySampler};
use belvedere::{PointCloud, Result};
use std::collections::HashMap;
use std::path::PathBuf;

/// Result of a pass over a survey.
pub(crate) struct SurveyOverview {
    pub(crate) counts: SurveyCounts,
    /// Random sample of whole pulses.
    pub(crate) along_lines: PointCloud,
    /// All points of some places.
    pub(crate) places: PointCloud,
    /// Rectangles around the pieces of each file.
    pub(crate) pieces: HashMap<PathBuf, Vec<PieceCell>>,
}

impl SurveyOverview {
    /// Returns the kind of ground points for the whole survey, by the rule of [`GroundPoints::Auto`].
    pub(crate) fn ground_points(&self) -> GroundPoints {
        let SurveyCounts { points, ground, .. } = self.counts;
        if ground < points.div_ceil(1000) { GroundPoints::Found } else { GroundPoints::Classed }
    }
}

/// Reads all points of `files` in `area`. The files have about `point_count` points.
pub(crate) fn survey(
    files: &[PathBuf],
    options: &ReadOptions,
    columns: PointColumns,
    point_count: u64,
    area: &MapArea,
    control: &Control<'_>,
) -> Result<SurveyOverview> {
    let mut sampler = SurveySampler::new([area.low, area.high], point_count);
    let frame = options.frame.clone().unwrap_or_default();
    let mut along_lines = PointCloud::in_frame(frame.clone());
    let mut places = PointCloud::in_frame(frame);
    let mut pieces: HashMap<PathBuf, Vec<PieceCell>> = HashMap::new();
    // Sources must outlive the read.
    for batch in read_batches(files.to_vec(), &options.clone().with_row_numbers(), control)? {
        let CloudBatch { cloud, source, rows } = batch?;
        hold_rows(pieces.entry(source).or_default(), &rows, &cloud.positions);
        let times = cloud.attributes.gps_time.as_deref().filter(|_| columns.gps_times);
        let SampledRows { along_lines: of_lines, in_places } = sampler.pass(&cloud, times);
        append(&mut along_lines, cloud.select(&of_lines), columns);
        append(&mut places, cloud.select(&in_places), columns);
    }
    Ok(SurveyOverview { counts: sampler.finish(), along_lines, places, pieces })
}

/// Widens the rectangles of the pieces that contain `rows` of a file.
fn hold_rows(pieces: &mut Vec<PieceCell>, rows: &[u64], positions: &[[f32; 3]]) {
    for (&row, &p) in rows.iter().zip(positions) {
        let number = usize::try_from(row / PIECE_ROWS).unwrap_or(usize::MAX);
        if number >= pieces.len() {
            pieces.resize(number + 1, NOWHERE);
        }
        hold(&mut pieces[number], p);
    }
}
