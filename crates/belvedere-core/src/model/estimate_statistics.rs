//! Statistics of a whole survey from samples of it, and how far around a place they matter.

use super::flight_days::FlightDays;
use super::params::{BallParams, Carving, ModelParams, OrientBy};
use super::prepare::{OrientedSurvey, prepare};
use super::statistics::{SurveyStatistics, lean};
use super::survey_sample::{SampledRows, SurveySampler};
use crate::ground::GROUND_REACH;
use crate::medial::{BLOCK, CarvedInput, CarvedParams, RuleStatistics, rule_statistics};
use crate::neighbors::FARTHEST_NEIGHBOR;
use crate::pulses::{Means, ScannerReport, locate};
use belvedere_data::control::Control;
use belvedere_data::{Error, Parameter, PointCloud, Result};
use std::borrow::Cow;
use std::path::Path;

/// Reach of the rules for balls around a point, metres. Edges of roofs reach three spacings of pulses, at most 3 m
/// each; cells of a metre with their neighbours, crowns and relief reach less.
const RULES_REACH: f64 = 12.0;
/// Allowance for the lean of pulses over the maximum of a sample, as a share of that.
const LEAN_ROOM: f64 = 1.1;

/// Extremes of all points of a survey, from one pass.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SurveyExtremes {
    /// Highest point, local metres.
    pub top: f32,
    /// Relief, see [`SurveyStatistics::relief`].
    pub relief: f64,
    /// True if any point has class 2, ground.
    pub has_ground: bool,
    /// True if any point has a class of vegetation, 3 to 5.
    pub has_vegetation: bool,
}

/// Samples of a survey, in the frame that its parts will have.
struct SurveySamples<'a> {
    /// Whole pulses at random, all over the survey.
    along_lines: &'a PointCloud,
    /// All points of some places.
    places: &'a PointCloud,
    extremes: &'a SurveyExtremes,
}

/// Statistics of a survey, and how they were found.
struct Estimate {
    statistics: SurveyStatistics,
    is_from_the_ground: bool,
    /// Report of the search for the scanner along flight lines.
    scanner: ScannerReport,
}

/// Statistics of a whole survey that is in memory, and how they were found.
pub(super) struct WholeStatistics {
    pub(super) statistics: SurveyStatistics,
    /// Report of the search for the scanner.
    pub(super) scanner: ScannerReport,
}

impl WholeStatistics {
    /// Estimates the statistics of a cloud as those of a survey in parts, so that one model of it has the same balls.
    /// `None` for clouds that are no survey from the air with known times, and for scanners that are given.
    ///
    /// # Errors
    /// [`Error::Cancelled`].
    pub(super) fn of_cloud(cloud: &PointCloud, params: &ModelParams, control: &Control<'_>) -> Result<Option<Self>> {
        let is_survey = matches!(params.orient, OrientBy::Auto | OrientBy::Pulses)
            && params.balls.carving() != Carving::Unwanted
            && params.statistics.is_none()
            && cloud.scanner_positions.is_empty()
            && cloud.attributes.gps_time.is_some();
        let Some(bounds) = cloud.bounds().filter(|_| is_survey) else { return Ok(None) };
        let corner = |corner: [f32; 3]| [corner[0], corner[1]].map(f64::from);
        let mut sampler = SurveySampler::new([corner(bounds.low), corner(bounds.high)], cloud.len() as u64);
        let SampledRows { along_lines, in_places } = sampler.pass(cloud, cloud.attributes.gps_time.as_deref());
        let sample = (along_lines.len() < cloud.len()).then(|| cloud.select(&along_lines));
        let samples = SurveySamples {
            along_lines: sample.as_ref().unwrap_or(cloud),
            places: &cloud.select(&in_places),
            extremes: &sampler.finish().extremes,
        };
        match Estimate::new(&samples, params, control) {
            Ok(Estimate { statistics, is_from_the_ground: false, scanner })
                if statistics.carves && !statistics.are_pulses_assumed() =>
            {
                Ok(Some(Self { statistics, scanner }))
            }
            Err(Error::Cancelled) => Err(Error::Cancelled),
            // the model of the cloud says what is wrong
            Ok(_) | Err(_) => Ok(None),
        }
    }
}

impl Estimate {
    fn new(samples: &SurveySamples<'_>, params: &ModelParams, control: &Control<'_>) -> Result<Self> {
        let &SurveySamples { along_lines, places, extremes } = samples;
        let means = match params.orient {
            OrientBy::Pulses => Means::Pulses,
            OrientBy::Auto | OrientBy::Up => Means::Automatic,
            _ => {
                let value = "a scanner, a trajectory or a mesh that is given".to_owned();
                let expected = "auto, pulses or up where a survey is built in parts";
                return Err(Error::invalid(Parameter::Orientation, value, expected));
            }
        };
        let (positions, report) = control.stage("estimating scanner positions", along_lines.len(), || {
            locate(along_lines, &means, &params.locate, control)
        })?;
        let leans = along_lines.positions.iter().zip(&positions).filter_map(lean);
        let max_lean = if report.paths.is_empty() { 0.0 } else { leans.fold(0.0, f64::max) };
        let mut statistics = SurveyStatistics {
            paths: report.paths.clone(),
            max_lean: LEAN_ROOM * max_lean,
            carves: true,
            top: extremes.top,
            relief: extremes.relief,
            flight_days: FlightDays::of(&along_lines.attributes),
            measures_crowns: true,
            finds_ground: !(extremes.has_ground || extremes.has_vegetation),
            whole: RuleStatistics {
                // found otherwise
                has_ground: extremes.has_ground || !extremes.has_vegetation,
                has_vegetation: extremes.has_vegetation,
                ..RuleStatistics::default()
            },
            ..SurveyStatistics::default()
        };
        let scanner_report = report;
        // what the model of these places estimates for itself
        let cloud = places.clone();
        let scanner = OrientBy::ScannerOfEachPoint(statistics.scanner(&cloud, control)?);
        let free = if statistics.paths.is_empty() { params.clone() } else { params.clone().with_orient(scanner) };
        let (survey, report) = prepare(Cow::Owned(cloud), &free, None, control)?;
        statistics.isolation_radius = report.removed_by_cleaning.isolation_radius;
        statistics.strips = report.survey.strips;
        statistics.noise = report.smoothing.map(|smoothing| smoothing.noise);
        let mut estimate = Self { statistics, is_from_the_ground: false, scanner: scanner_report };
        let statistics = &mut estimate.statistics;
        let Some(input) = &survey.carving else {
            statistics.carves = false;
            return Ok(estimate);
        };
        if input.free_segments.are_from_the_ground() {
            estimate.is_from_the_ground = true;
            return Ok(estimate);
        }
        statistics.measures_crowns = input.pulses.is_some();
        if let BallParams::Carved(carved) | BallParams::CarvedIfPossible(carved, _) = &params.balls {
            let RuleStatistics { transmission, crown_spacing, spacing, .. } =
                statistics.crowns(&survey, carved, control)?;
            statistics.whole = RuleStatistics { transmission, crown_spacing, spacing, ..statistics.whole };
        }
        Ok(estimate)
    }
}

impl SurveyStatistics {
    /// Estimates the statistics of a survey. `along_lines` is a sample that is spread over all of it, whole pulses at
    /// random. `places` has all points of some places. Both are in the frame that its parts will have. Errors name it
    /// `name`.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for ways of orienting that need more than the points, [`Error::Malformed`] for
    /// scanners on the ground; those of [`super::SceneModel::build`].
    pub fn estimate(
        name: &Path,
        along_lines: &PointCloud,
        places: &PointCloud,
        extremes: &SurveyExtremes,
        params: &ModelParams,
        control: &Control<'_>,
    ) -> Result<Self> {
        let samples = SurveySamples { along_lines, places, extremes };
        match Estimate::new(&samples, params, control)? {
            Estimate { is_from_the_ground: true, .. } => Err(Error::malformed(
                name,
                "this survey was measured from the ground, and only surveys from the air can be worked on in tiles; \
                 ask about one cloud at a time, with `balls`, `shadow` or `viewshed`",
            )),
            Estimate { statistics, .. } => Ok(statistics),
        }
    }

    fn crowns(&self, survey: &OrientedSurvey, params: &CarvedParams, control: &Control<'_>) -> Result<RuleStatistics> {
        let Some(input) = &survey.carving else { return Ok(RuleStatistics::default()) };
        let input = CarvedInput {
            oriented: &survey.oriented,
            measured: &survey.measured,
            index: &survey.index,
            attributes: &input.attributes,
            free_segments: &input.free_segments,
            pulses: input.pulses.as_ref(),
            statistics: None,
        };
        rule_statistics(&input, params, control)
    }

    /// Returns the distance around a place, metres, within which points must be known for its balls to be those of the
    /// whole survey.
    #[must_use]
    pub fn buffer(&self, params: &ModelParams) -> f64 {
        let isolation = self.isolation_radius.unwrap_or(0.0);
        let (ball, noise) =
            (2.0 * f64::from(params.balls.shrinking_by(self).initial_radius), self.noise.unwrap_or(0.0));
        // a ball ends at points, whose planes and kinds follow from neighbours, and these from theirs
        let points = ball + 2.0 * f64::from(noise) + 2.0 * f64::from(FARTHEST_NEIGHBOR);
        // or at pulses that end lower, and these hold other returns
        let pulses = ball + (self.relief + ball) * self.max_lean;
        // or at a thin surface, which pulses prove that pass half a block away and end lower
        let thin = f64::from(BLOCK) / 2.0 + self.relief * self.max_lean;
        // and classes that are found follow from blocks of their own
        let ground = if self.finds_ground { GROUND_REACH } else { 0.0 };
        points.max(pulses).max(thin) + isolation + RULES_REACH + ground
    }
}
