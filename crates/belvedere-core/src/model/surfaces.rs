//! Surfaces of buildings that many points show: patches close them, and balls do not reach out of them.

use super::prepare::{CarvingInput, OrientedSurvey};
use super::report::SurfacesReport;
use crate::medial::MedialBalls;
use crate::planes::{BuildingOutlines, BuildingSurfaces, PlaneParams, SurveyPoints, cap, find};
use belvedere_data::balls::NO_TOUCH;
use belvedere_data::control::Control;
use belvedere_data::patches::SurfacePatches;
use belvedere_data::{Frame, Result};

impl OrientedSurvey {
    /// Finds the surfaces of the buildings, with rows of points as in the cloud as it was given. `None` for a survey
    /// that is not from the air. If its scanner is not known, pulses are assumed to fall straight down. The position of
    /// edges is then too uncertain to cut anything, and good enough to search for the wall below.
    ///
    /// # Errors
    /// Those of [`find`].
    pub fn building_surfaces(
        &self,
        frame: &Frame,
        params: &PlaneParams,
        control: &Control<'_>,
    ) -> Result<Option<BuildingSurfaces>> {
        let is_flown = |input: &&CarvingInput| !input.free_segments.are_from_the_ground();
        let Some(input) = self.carving.as_ref().filter(is_flown) else { return Ok(None) };
        let params = if input.is_assumed { params.for_assumed_pulses() } else { *params };
        let points = SurveyPoints {
            positions: &self.measured,
            scanner: &input.scanner,
            attributes: &input.attributes,
            origin: frame.origin,
        };
        let find = || find(&points, &params, control);
        let mut found = control.stage("finding roofs and walls", self.measured.len(), find)?;
        for point in &mut found.points {
            point.row = self.kept.get(point.row as usize).copied().unwrap_or(point.row);
        }
        Ok(Some(found))
    }
}

/// Finds the surfaces of buildings, and caps the balls, whose sources are rows of the points kept, and of which each
/// may have a transmission.
pub(super) fn close_surfaces(
    (balls, transmission): (&mut MedialBalls, &mut Vec<f32>),
    survey: &OrientedSurvey,
    frame: &Frame,
    params: &PlaneParams,
    control: &Control<'_>,
) -> Result<(SurfacePatches, BuildingOutlines, Option<SurfacesReport>)> {
    let Some(mut found) = survey.building_surfaces(frame, params, control)? else {
        return Ok((SurfacePatches::default(), BuildingOutlines::default(), None));
    };
    let balls_capped =
        control.stage("capping balls", balls.len(), || cap(balls, &survey.measured, &found.regions, control))?;
    let mut is_on_slab = vec![false; survey.measured.len()];
    for &row in &found.slab_rows {
        if let Some(is_on_slab) = is_on_slab.get_mut(row as usize) {
            *is_on_slab = true;
        }
    }
    let is_of_slab = |row: &usize| is_on_slab.get(balls.source[*row] as usize).copied().unwrap_or(false);
    let capped = (0..balls.len()).filter(|&row| balls.touch[row] != NO_TOUCH);
    let (of_slabs, left): (Vec<usize>, Vec<usize>) = capped.partition(is_of_slab);
    *transmission = left.iter().filter_map(|&row| transmission.get(row).copied()).collect();
    *balls = balls.select(&left);
    let report = SurfacesReport {
        roof_planes: found.outlines.planes.len(),
        roof_edges: found.outlines.edges.len(),
        ridges: found.outlines.ridges.len(),
        walls: found.outlines.walls.len(),
        triangles: found.patches.len(),
        balls_capped,
        slabs: found.slabs,
        balls_of_slabs: of_slabs.len(),
    };
    let patches = std::mem::take(&mut found.patches);
    Ok((patches, found.outlines, Some(report)))
}
