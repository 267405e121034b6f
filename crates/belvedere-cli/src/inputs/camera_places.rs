//! Positions and lenses of cameras, from flags and files to a question.

use crate::arguments::CameraLensArguments;
use crate::inputs::observers::{ObserverUse, observer_rows};
use crate::run::CommandContext;
use anyhow::Result;
use belvedere::Frame;
use belvedere::apps::ask::{self, GivenCamera};
use belvedere::apps::viewshed::places_along;
use belvedere::io::{ObserverRow, RowsAre};
use std::path::Path;

/// Metres between the candidates on a line of GeoJSON.
const STEP: f64 = 5.0;

/// Returns the lenses of cameras from the flags.
pub(crate) fn lens(flags: &CameraLensArguments) -> ask::CameraLens {
    ask::CameraLens {
        fov_deg: flags.fov,
        vertical_fov_deg: flags.vertical_fov,
        pixels: flags.pixels.map(|pixels| pixels as f64),
        density: flags.density.map(|density| density.0),
        headings: flags.headings,
        tilts_deg: flags.tilt.clone(),
        is_turning: flags.turning,
        min_distance: flags.min_distance.map(f64::from),
        max_distance: flags.max_distance,
    }
}

/// The cameras or stations of a file, those on lines `step` metres apart, or [`STEP`].
pub(crate) fn candidates_on_path(
    path: &Path,
    step: Option<f64>,
    needed: ObserverUse,
    frame: &Frame,
    run: &mut CommandContext,
) -> Result<Vec<GivenCamera>> {
    let step = step.unwrap_or(STEP);
    let mut cameras = Vec::new();
    for (number, row) in observer_rows(path, frame, RowsAre::Places, needed, run)?.into_iter().enumerate() {
        let line = (row.corners.len() > 1).then_some(number);
        let on_line = |place| GivenCamera { line, ..camera(place, &row) };
        cameras.extend(places_along(&row.corners, step)?.into_iter().map(on_line));
    }
    Ok(cameras)
}

fn camera(place: [f64; 3], row: &ObserverRow) -> GivenCamera {
    let pair = |[from, to]: [Option<f64>; 2]| Some([from?, to?]);
    GivenCamera {
        place,
        height: row.height,
        heading_deg: row.heading_deg,
        tilt_deg: row.tilt_deg,
        fov_deg: row.fov_deg,
        distance: row.distance,
        azimuth_deg: pair(row.azimuth_deg),
        elevation_deg: pair(row.elevation_deg),
        line: None,
    }
}
