//! Builds a scene model from a cloud.

use super::blocked_pulses::blocked_pulses;
use super::estimate_statistics::WholeStatistics;
use super::findings::SurveyFindings;
use super::flight_days::FlightDays;
use super::in_space_order::space_order;
use super::params::{BallParams, ModelParams};
use super::prepare::{OrientedSurvey, prepare};
use super::report::{BallsReport, BuildReport};
use super::statistics::SurveyStatistics;
use super::surfaces::close_surfaces;
use super::survey_sample::is_counted;
use super::{FINDINGS, FLIGHT_DAYS, LOOKS_UP, ModelParts, SceneModel};
use crate::medial::{
    CarvedBalls, CarvedInput, MedialBalls, ShrinkParams, Side, Trees, carved_balls, shrink, vegetation_of_classes,
    vegetation_of_transmission,
};
use crate::medium::{ExtinctionVoxels, MediumParams, PlantReturn, PlantReturns, estimate};
use crate::planes::BuildingOutlines;
use crate::query::{BallTree, BlockRule, BlockingTriangles};
use belvedere_data::cast::to_row;
use belvedere_data::control::Control;
use belvedere_data::patches::SurfacePatches;
use belvedere_data::{Error, Frame, PointCloud, Result};
use std::borrow::Cow;
use std::collections::BTreeMap;

impl SceneModel {
    /// The scene model of `cloud`, with counts of its points by step.
    ///
    /// The result is the same, bit by bit, for any number of threads.
    ///
    /// # Errors
    /// - [`Error::NoPoints`] if cleaning leaves none.
    /// - [`Error::NoSurface`] if it leaves too few for a surface.
    /// - [`Error::MissingAttribute`] if the cloud lacks a column that the parameters need.
    /// - [`Error::InvalidParameter`] for a parameter out of range.
    /// - [`Error::Cancelled`].
    pub fn build(cloud: &PointCloud, params: &ModelParams, control: &Control<'_>) -> Result<(Self, BuildReport)> {
        let whole = WholeStatistics::of_cloud(cloud, params, control)?;
        let (survey, report) = prepare(Cow::Borrowed(cloud), params, whole.as_ref(), control)?;
        let normals = survey.normals_of_rows(cloud.len());
        let (mut model, report) = of_survey(survey, cloud.frame.clone(), (params, whole.as_ref()), report, control)?;
        model.normals = Some(normals);
        Ok((model, report))
    }

    /// The result of [`SceneModel::build`] for a cloud that nothing else needs: its memory is freed on the way, and the
    /// model has no [`SceneModel::normals`].
    ///
    /// # Errors
    /// Those of [`SceneModel::build`].
    pub fn build_owned(cloud: PointCloud, params: &ModelParams, control: &Control<'_>) -> Result<(Self, BuildReport)> {
        let frame = cloud.frame.clone();
        let whole = WholeStatistics::of_cloud(&cloud, params, control)?;
        let (survey, report) = prepare(Cow::Owned(cloud), params, whole.as_ref(), control)?;
        of_survey(survey, frame, (params, whole.as_ref()), report, control)
    }

    /// Creates the model of a survey from models of its parts, each built with its `statistics`. `parts` has their
    /// balls one after the other, `counts` of each. Rows are those of `cloud`, which has all points.
    ///
    /// # Errors
    /// Those of [`SceneModel::from_parts`].
    pub fn joined(
        mut parts: ModelParts,
        counts: &[usize],
        cloud: &PointCloud,
        statistics: &SurveyStatistics,
    ) -> Result<Self> {
        let rows = (0..).zip(cloud.positions.iter().enumerate());
        let kept: Vec<u32> =
            rows.filter(|(_, (row, p))| is_counted(**p, *row, &cloud.attributes)).map(|(number, _)| number).collect();
        let counted = if kept.len() < cloud.len() { Cow::Owned(cloud.select(&kept)) } else { Cow::Borrowed(cloud) };
        let findings = SurveyFindings { strips: statistics.strips.clone(), ..SurveyFindings::of_cloud(&counted) };
        note_survey(&findings, &statistics.flight_days, &mut parts.provenance);
        let order = order_of_balls(&parts.balls, counts, cloud);
        if !parts.transmission.is_empty() {
            parts.transmission = order.iter().filter_map(|&ball| parts.transmission.get(ball).copied()).collect();
        }
        parts.balls = parts.balls.select(&order);
        Self::from_parts(parts)
    }
}

/// Returns the order of the balls in the model of a cloud, for balls of its parts: those of points in the order of
/// space, then those that fill gaps. The balls of each part are in this order, `counts` of them.
fn order_of_balls(balls: &MedialBalls, counts: &[usize], cloud: &PointCloud) -> Vec<usize> {
    let mut places: Vec<u32> = (0..to_row(cloud.len())).collect();
    if let Some(rows) = space_order(cloud) {
        (0..).zip(rows).for_each(|(place, row)| places[row as usize] = place);
    }
    let mut keys: Vec<(bool, u32, u32)> = Vec::with_capacity(balls.len());
    let mut sources = (0..).zip(&balls.source);
    for &count in counts {
        let (mut are_fills, mut before) = (false, None);
        for (ball, &source) in sources.by_ref().take(count) {
            let place = places.get(source as usize).copied().unwrap_or(u32::MAX);
            are_fills |= before >= Some(place);
            before = Some(place);
            keys.push((are_fills, if are_fills { 0 } else { place }, ball));
        }
    }
    keys.sort_unstable();
    keys.into_iter().map(|(_, _, ball)| ball as usize).collect()
}

/// Adds the findings about a survey, and the days of its flight, to the provenance of its model.
fn note_survey(findings: &SurveyFindings, days: &FlightDays, provenance: &mut BTreeMap<String, String>) {
    let findings = findings.to_text().filter(|_| !findings.is_empty());
    provenance.extend(findings.map(|text| (FINDINGS.to_owned(), text)));
    let days = days.to_text().filter(|_| !days.is_empty());
    provenance.extend(days.map(|text| (FLIGHT_DAYS.to_owned(), text)));
}

fn of_survey(
    survey: OrientedSurvey,
    frame: Frame,
    (params, whole): (&ModelParams, Option<&WholeStatistics>),
    mut report: BuildReport,
    control: &Control<'_>,
) -> Result<(SceneModel, BuildReport)> {
    let (mut balls, mut transmission);
    let mut medium = None;
    let (mut patches, mut outlines) = (SurfacePatches::default(), BuildingOutlines::default());
    let settled = match params.balls {
        BallParams::CarvedIfPossible(carved, _) if survey.carving.is_some() => BallParams::Carved(carved),
        BallParams::CarvedIfPossible(_, shrunk) => BallParams::Shrunk(shrunk),
        settled => settled,
    };
    match (&settled, &survey.carving) {
        (BallParams::Carved(carved), Some(input)) => {
            let is_assumed = input.is_assumed;
            let (attributes, free_segments, pulses) = (&input.attributes, &input.free_segments, input.pulses.as_ref());
            let (oriented, measured, index) = (&survey.oriented, &survey.measured[..], &survey.index);
            let statistics = params.statistics.as_deref().or(whole.map(|whole| &whole.statistics));
            let statistics = statistics.map(|statistics| &statistics.whole);
            let input = CarvedInput { oriented, measured, index, attributes, free_segments, pulses, statistics };
            let found;
            let returns;
            CarvedBalls { balls, transmission, returns, report: found } = carved_balls(&input, carved, control)?;
            // pulses that are only assumed enter too few crowns: what they do not enter would let all light through
            let is_measured = carved.crowns.is_some_and(|crowns| crowns.trees == Trees::Measured) && !is_assumed;
            if is_measured && !returns.is_empty() {
                medium = Some(survey.medium(&returns, &frame, control)?);
            }
            report.interior_balls = Some(BallsReport::Carved(found));
            if let Some(params) = &carved.planes {
                (patches, outlines, report.surfaces) =
                    close_surfaces((&mut balls, &mut transmission), &survey, &frame, params, control)?;
            }
        }
        (BallParams::Shrunk(params), _) => {
            let found;
            (balls, found) = survey.shrink(Side::Interior, *params, control)?;
            // as in a ball file, so that rows of balls mean the same
            balls = balls.shrunk();
            transmission = Vec::new();
            report.interior_balls = Some(found);
        }
        _ => {
            let (attribute, advice) = ("pulses that can carve", "build balls from the points only");
            return Err(Error::MissingAttribute { attribute, needed_for: "carving", advice });
        }
    }
    let vegetation = match &survey.classification {
        _ if !transmission.is_empty() => vegetation_of_transmission(&transmission),
        Some(classes) => vegetation_of_classes(&balls, classes),
        None => Vec::new(),
    };
    survey.restore_rows(&mut balls);
    let mut provenance = provenance("interior", &settled);
    // parts of surveys are not judged alone
    if params.statistics.is_none() && survey.looks_y_up(&frame) {
        provenance.insert(LOOKS_UP[0].to_owned(), LOOKS_UP[1].to_owned());
    }
    if params.statistics.is_none()
        && let Some(found) = survey.unit_contradiction(&frame, control)?
    {
        found.note_in(&mut provenance);
    }
    if let Some(offset) = report.scanner.as_ref().and_then(|scanner| scanner.time_offset) {
        offset.contradiction().note_in(&mut provenance);
    }
    // those of the whole are statistics of a part
    if params.statistics.is_none() {
        note_survey(&report.survey, &survey.flight_days, &mut provenance);
    }
    // pulses at the edge of a part lack the balls beyond
    let checked = report.pulses.as_mut().filter(|_| params.statistics.is_none());
    let triangles = BlockingTriangles::of_patches(&patches, None)?;
    let tree = match (&settled, &survey.carving, checked) {
        (BallParams::Carved(_), Some(input), Some(pulses)) => {
            let tree = control.stage("indexing balls", balls.len(), || BallTree::new(&balls, &BlockRule::carved()))?;
            let free = &input.free_segments;
            let check = || blocked_pulses(&tree, triangles.as_ref(), free, control);
            pulses.blocked = Some(control.stage("checking pulses", free.len(), check)?);
            Some(tree)
        }
        _ => None,
    };
    let (bounds, pulses) = (survey.bounds, survey.pulses());
    let parts = ModelParts { frame, bounds, balls, patches, outlines, transmission, medium, pulses, provenance };
    Ok((SceneModel { parts, vegetation, tree, triangles, ..SceneModel::default() }, report))
}

/// Describes how balls were made, for a saved model.
fn provenance(side: &str, made: &BallParams) -> BTreeMap<String, String> {
    let entries = [("side", side.to_owned()), ("method", made.name().to_owned()), ("parameters", format!("{made:?}"))];
    entries.into_iter().map(|(name, value)| (name.to_owned(), value)).collect()
}

impl OrientedSurvey {
    /// Balls from the points alone on one side, one for each point that was kept, rows as in [`OrientedSurvey::kept`].
    ///
    /// # Errors
    /// Those of [`shrink`].
    pub fn shrink(
        &self,
        side: Side,
        params: ShrinkParams,
        control: &Control<'_>,
    ) -> Result<(MedialBalls, BallsReport)> {
        let (oriented, index) = (&self.oriented, &self.index);
        let (balls, report) =
            control.stage("shrinking balls", oriented.len(), || shrink(oriented, index, side, &params, control))?;
        Ok((balls, BallsReport::Shrunk(report)))
    }

    /// Crowns as a medium, from the kinds of returns, (N) as the points kept, that tell plants apart.
    fn medium(&self, kinds: &[PlantReturn], frame: &Frame, control: &Control<'_>) -> Result<ExtinctionVoxels> {
        let Some(input) = &self.carving else { return Ok(ExtinctionVoxels::default()) };
        let returns = PlantReturns {
            positions: &self.measured,
            scanner: &input.scanner,
            return_count: input.attributes.return_count.as_deref(),
            kinds,
            origin: frame.origin,
        };
        control.stage("measuring crowns", kinds.len(), || estimate(&returns, &MediumParams::default(), control))
    }

    /// Turns the points that `balls` are tangent at and touch from rows of the points kept into rows of the cloud as
    /// given.
    pub fn restore_rows(&self, balls: &mut MedialBalls) {
        for row in balls.source.iter_mut().chain(&mut balls.touch) {
            // neither a pulse nor nothing has a row
            *row = self.kept.get(*row as usize).copied().unwrap_or(*row);
        }
    }

    /// The balls in free space, as they are saved. They block nothing: [`SceneModel::from_parts`] refuses them.
    ///
    /// # Errors
    /// Those of [`shrink`].
    pub fn exterior_parts(
        &self,
        frame: Frame,
        params: &ModelParams,
        control: &Control<'_>,
    ) -> Result<(ModelParts, BallsReport)> {
        let made = BallParams::Shrunk(params.balls.shrinking());
        let (balls, report) = self.shrink(Side::Exterior, params.balls.shrinking(), control)?;
        let mut balls = balls.shrunk();
        self.restore_rows(&mut balls);
        let provenance = provenance("exterior", &made);
        Ok((ModelParts { frame, bounds: self.bounds, balls, provenance, ..ModelParts::default() }, report))
    }
}
