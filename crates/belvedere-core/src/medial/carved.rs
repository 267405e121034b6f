//! The model that Belvedere answers from: balls cut by pulses, and the rules for objects that balls alone represent
//! badly.

use super::carve::{CarveReport, carve};
use super::close_range::CloseRangeBalls;
use super::crowns;
use super::kinds::Kind;
use super::marking_rule::{MarkingRule, Phase};
use super::marks::{self, RadiusCaps};
use super::rules::CarvedParams;
use super::shrinking_ball::{ShrinkReport, shrink};
use super::survey::{CarvedInput, RuleStatistics, Survey};
use super::vegetation::find_vegetation;
use crate::medium::PlantReturn;
use belvedere_data::Result;
use belvedere_data::balls::{MedialBalls, Side};
use belvedere_data::control::Control;
use serde::Serialize;
use std::collections::BTreeMap;

/// Counts of balls by outcome of [`carved_balls`].
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct CarvedReport {
    /// Counts of shrinking by the points.
    #[serde(flatten)]
    pub shrinking: ShrinkReport,
    /// Counts of carving by the pulses.
    #[serde(flatten)]
    pub carving: CarveReport,
    /// Counts of the rules: names of the report and numbers of points or balls.
    #[serde(flatten)]
    pub rules: BTreeMap<&'static str, usize>,
}

impl CarvedReport {
    /// A number of [`CarvedReport::rules`], 0 where its rule was not applied.
    #[must_use]
    pub fn count(&self, name: &str) -> usize {
        self.rules.get(name).copied().unwrap_or(0)
    }
}

/// Balls of a survey.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CarvedBalls {
    /// The balls. [`MedialBalls::source`] and [`MedialBalls::touch`] are rows of the cloud; several balls may have the
    /// same source.
    pub balls: MedialBalls,
    /// Share of the pulses that passed the piece of crown that a ball is part of, (B), 0 to 1. NaN for balls that are
    /// not vegetation; 0 for vegetation where pulses cannot be separated. Empty if nothing is vegetation.
    pub transmission: Vec<f32>,
    /// Evidence of each return about plants, (N); empty for scanners on the ground.
    pub returns: Vec<PlantReturn>,
    /// Counts of balls by outcome.
    pub report: CarvedReport,
}

/// The interior balls of a survey as far as its pulses leave them, and those that rules add.
///
/// A part of a survey ([`CarvedInput::statistics`]) and the whole give the same balls, bit by bit, for points far
/// enough from the edge of the part. The distance follows from the rules ([`crate::model::SurveyStatistics::buffer`]).
///
/// # Errors
/// Those of [`shrink`] and [`carve`]. Each rule is a stage of `control`.
pub fn carved_balls(input: &CarvedInput<'_>, params: &CarvedParams, control: &Control<'_>) -> Result<CarvedBalls> {
    match params.close_range.filter(|_| input.free_segments.are_from_the_ground()) {
        Some(sizes) => {
            let CloseRangeBalls { balls, shrinking, carving, below_tripods } = sizes.balls(input, control)?;
            let rules = BTreeMap::from([("balls_below_tripods", below_tripods)]);
            let report = CarvedReport { shrinking, carving, rules };
            Ok(CarvedBalls { balls: balls.shrunk(), report, ..CarvedBalls::default() })
        }
        None => carve_survey(survey(input, params, control)?, &params.rules(), params, control),
    }
}

/// Statistics of a whole survey that rules need.
///
/// # Errors
/// Those of [`carved_balls`].
pub(crate) fn rule_statistics(
    input: &CarvedInput<'_>,
    params: &CarvedParams,
    control: &Control<'_>,
) -> Result<RuleStatistics> {
    Ok(survey(input, params, control)?.statistics)
}

/// The survey of `input`, with vegetation found and crowns measured as `params` want it.
///
/// # Errors
/// [`Error::InvalidParameter`](belvedere_data::Error::InvalidParameter) for parameters of vegetation out of range,
/// [`Error::Cancelled`](belvedere_data::Error::Cancelled).
fn survey<'a>(input: &CarvedInput<'a>, params: &CarvedParams, control: &Control<'_>) -> Result<Survey<'a>> {
    let CarvedInput { oriented, index, attributes, pulses, statistics, .. } = *input;
    let mut survey = Survey::of(input);
    // where classes tell vegetation, its shape need not
    if let Some(vegetation) = params.vegetation.as_ref().filter(|_| !survey.statistics.has_vegetation) {
        survey.found_vegetation = control.stage("finding vegetation", oriented.len(), || {
            find_vegetation(&mut survey.kinds, oriented, index, attributes, vegetation, control)
        })?;
    }
    if let Some(params) = &params.crowns {
        control.stage("measuring crowns", 0, || {
            if let Some(pulses) = pulses {
                crowns::measure_transmission(&mut survey, pulses, params, statistics, control)?;
            }
            crowns::measure_spacing(&mut survey, params, statistics, control)
        })?;
    }
    Ok(survey)
}

/// Applies `rules` to a survey: caps before the pulses carve, cuts after, fills at the end.
fn carve_survey(
    mut survey: Survey<'_>,
    rules: &[&dyn MarkingRule],
    params: &CarvedParams,
    control: &Control<'_>,
) -> Result<CarvedBalls> {
    let (oriented, index) = (survey.oriented, survey.index);
    let mut report = CarvedReport::default();
    report.rules.insert("points_found_to_be_vegetation", survey.found_vegetation);
    let mut caps = RadiusCaps::by_kind(&survey.kinds, survey.attributes, &survey.spacing, &params.kind_caps);
    let mut fills = Vec::new();
    let in_phase = |phase: Phase| {
        let stage = move |rule: &&dyn MarkingRule| rule.stage().filter(|stage| stage.0 == phase).map(|stage| stage.1);
        rules.iter().filter_map(move |rule| Some((rule, stage(rule)?)))
    };
    for (rule, stage) in in_phase(Phase::Points) {
        let none = MedialBalls::default();
        let marks = control.stage(stage, oriented.len(), || rule.marks(&survey, &none, control))?;
        survey.claim(marks.caps.iter().filter(|cap| cap.is_claimed).map(|cap| cap.row));
        caps.tighten(&marks.caps);
        report.rules.extend(marks.counts);
        fills.push((rule.fills_name(), marks.fills));
    }
    let shrinking = params.shrinking();
    let mut balls;
    (balls, report.shrinking) = control
        .stage("shrinking balls", oriented.len(), || shrink(oriented, index, Side::Interior, &shrinking, control))?;
    report.carving = control
        .stage("carving balls", oriented.len(), || carve(&mut balls, oriented, survey.free_segments, &caps, control))?;
    for (rule, stage) in in_phase(Phase::Balls) {
        let marks = control.stage(stage, oriented.len(), || rule.marks(&survey, &balls, control))?;
        marks::cut(&mut balls, oriented, &marks.cuts);
        report.rules.extend(marks.counts);
        fills.push((rule.fills_name(), marks.fills));
    }
    control.stage("filling", 0, || {
        for (name, fills) in fills.iter().filter(|(name, _)| !name.is_empty()) {
            report.rules.insert(name, marks::fill(&mut balls, &survey, fills, control)?);
        }
        Ok(())
    })?;
    let balls = balls.shrunk();
    let is_plant = |row: usize| survey.kinds.get(row) == Some(&Kind::Vegetation);
    let of = |&source: &u32| match survey.transmission.get(source as usize) {
        Some(&share) => share,
        // known to be a plant, and no more
        None if is_plant(source as usize) => 0.0,
        None => f32::NAN,
    };
    let is_known = !survey.transmission.is_empty() || survey.kinds.contains(&Kind::Vegetation);
    let transmission = if is_known { balls.source.iter().map(of).collect() } else { Vec::new() };
    Ok(CarvedBalls { balls, transmission, returns: survey.plant_returns(), report })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::medial::marks::{Cap, Cut, Fill, FillPlace, Marks};
    use crate::medial::survey::tests::with_survey;
    use crate::normals::OrientedCloud;
    use belvedere_data::balls::PULSE_TOUCH;

    /// A tenth rule: its file, whose line in `rules.rs` would add it to all others. It caps the first ball, cuts the
    /// second, fills below the third.
    struct Tenth(Phase);

    impl MarkingRule for Tenth {
        fn stage(&self) -> Option<(Phase, &'static str)> {
            Some((self.0, "marking three points"))
        }

        fn marks(&self, survey: &Survey<'_>, _: &MedialBalls, _: &Control<'_>) -> Result<Marks> {
            let place = FillPlace::Below(survey.positions()[2]);
            let fills = vec![Fill { row: 2, place, max_radius: 4.0, min_radius: 0.0 }];
            Ok(match self.0 {
                Phase::Points => Marks { caps: vec![Cap::tangent(0, 0.25)], fills, ..Marks::default() },
                Phase::Balls => Marks { cuts: vec![Cut { row: 1, radius: Some(0.125) }], ..Marks::default() },
            })
        }

        fn fills_name(&self) -> &'static str {
            if self.0 == Phase::Points { "balls_of_the_tenth_rule" } else { "" }
        }
    }

    #[test]
    fn a_tenth_rule_is_a_type_and_caps_cuts_and_fills() {
        let grid = (0_u8..100).map(|i| [f32::from(i % 10), f32::from(i / 10), 0.0]).collect::<Vec<_>>();
        let oriented = OrientedCloud::with_known_normals(grid, vec![[0.0, 0.0, 1.0]; 100]).unwrap();
        let scanner = vec![[0.0, 0.0, 500.0]; 100];
        let carve = |rules: &[&dyn MarkingRule]| {
            with_survey(&oriented, Some(vec![1; 100]), &scanner, |survey| {
                carve_survey(survey, rules, &CarvedParams::default(), &Control::none()).unwrap()
            })
        };
        let (without, with) = (carve(&[]), carve(&[&Tenth(Phase::Points), &Tenth(Phase::Balls)]));
        // nothing bounds the balls of a plane: half a metre
        assert!(without.balls.len() == 100 && without.balls.radii.iter().all(|&radius| radius == 0.5));
        assert_eq!(with.balls.radii[..4], [0.25, 0.125, 0.5, 0.5]);
        assert_eq!((with.balls.touch[1], with.balls.centers[1]), (PULSE_TOUCH, [1.0, 0.0, -0.125]));
        assert_eq!((with.balls.len(), with.balls.radii[100], with.balls.source[100]), (101, 4.0, 2));
        assert_eq!(with.report.count("balls_of_the_tenth_rule"), 1);
    }
}
