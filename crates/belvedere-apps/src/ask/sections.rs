//! Sections of a report that several questions share.

use super::scene::KnownGround;
use crate::edge::EdgeReport;
use crate::irradiance::PvSystem;
use crate::sun::{Date, DayParams, Site, SiteFrom, SunSchedule, Zone};
use crate::targets::{Measure, MeasureStatistics, Targets};
use crate::tree_light::{CrownLight, Transmissivity};
use belvedere_core::ground::GroundPoints;
use belvedere_core::medium::ExtinctionVoxels;
use belvedere_core::model::FlightDays;
use belvedere_core::query::{Answer, AnswerCounts, MedialScene, UnprovenAs};
use belvedere_data::report::{percent, rounded};
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};

/// Values by name, in order.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedValues<T>(pub Vec<(String, T)>);

impl<T> Default for NamedValues<T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<T: Serialize> Serialize for NamedValues<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        for (name, value) in &self.0 {
            map.serialize_entry(name, value)?;
        }
        map.end()
    }
}

/// Counts of the places of a question by outcome.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct PlacesReport {
    /// Cells on the ground under a cover, which have no answer.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cells_under_cover_left_out: Option<usize>,
    /// Targets outside the cloud, which have no answer.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub targets_outside_cloud: Option<usize>,
    /// Targets inside an obstacle, which have no answer.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub targets_inside_obstacle: Option<usize>,
    /// Targets near its edge.
    #[serde(flatten)]
    pub edge: Option<EdgeReport>,
}

/// Location of a scene on earth.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LocationSection {
    latitude_deg: f64,
    longitude_deg: f64,
    meridian_convergence_deg: f64,
    source: SiteFrom,
}

impl LocationSection {
    pub(super) fn of((site, source): &(Site, SiteFrom)) -> Self {
        Self {
            latitude_deg: rounded(site.latitude.to_degrees(), 5),
            longitude_deg: rounded(site.longitude.to_degrees(), 5),
            meridian_convergence_deg: rounded(site.convergence.to_degrees(), 4),
            source: *source,
        }
    }
}

/// Days of suns.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct PeriodSection {
    pub(super) first_day: String,
    pub(super) last_day: String,
    pub(super) days: usize,
    pub(super) time_zone: String,
    pub(super) time_step_min: f64,
    pub(super) suns: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) suns_below_horizon: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) directions: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) possible_hours_per_day: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) max_direction_error_deg: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) rms_direction_error_deg: Option<f64>,
    /// Description of each rule.
    #[serde(flatten)]
    pub(super) rules: NamedValues<String>,
}

impl PeriodSection {
    pub(super) fn of(schedule: &SunSchedule, zone: &Zone, params: &DayParams) -> Self {
        let dates: Vec<Date> = schedule.days.iter().map(|day| day.date).collect();
        let error = |radians: f64| (schedule.greatest_error > 0.0).then(|| rounded(radians.to_degrees(), 3));
        let possible = schedule.possible_hours() / dates.len().max(1) as f64;
        Self {
            suns: schedule.days.iter().map(|day| day.steps.len()).sum(),
            directions: Some(schedule.directions.len()),
            possible_hours_per_day: Some(rounded(possible, 3)),
            max_direction_error_deg: error(schedule.greatest_error),
            rms_direction_error_deg: error(schedule.rms_error),
            ..Self::between(&dates, zone, params)
        }
    }

    /// Suns of dates one by one, and how many of them are above and at or below the horizon.
    pub(super) fn of_dates(dates: &[Date], zone: &Zone, params: &DayParams, [suns, below]: [usize; 2]) -> Self {
        Self { suns, suns_below_horizon: Some(below), ..Self::between(dates, zone, params) }
    }

    fn between(dates: &[Date], zone: &Zone, params: &DayParams) -> Self {
        let [first_day, last_day] =
            [dates.first(), dates.last()].map(|date| date.map(ToString::to_string).unwrap_or_default());
        Self {
            first_day,
            last_day,
            days: dates.len(),
            time_zone: zone.name().to_owned(),
            time_step_min: rounded(params.step / 60.0, 3),
            ..Self::default()
        }
    }
}

/// Single suns.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct SunSection {
    /// Position of the sun at each instant, if there are few.
    #[serde(flatten)]
    pub(super) instants: NamedValues<SunAt>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) time_zone: Option<String>,
    pub(super) suns: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) suns_below_horizon: Option<usize>,
}

/// Position of the sun.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(super) struct SunAt {
    pub(super) azimuth_deg: f64,
    pub(super) elevation_deg: f64,
}

/// Radiation of sun and sky over a period.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct RadiationSection {
    pub(super) source: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) year: Option<i16>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) weather_rows: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) weather_hours: Option<f64>,
    pub(super) global_kwh_m2: f64,
    pub(super) direct_normal_kwh_m2: f64,
    pub(super) diffuse_kwh_m2: f64,
    pub(super) sun_directions: usize,
    pub(super) diffuse_model: String,
    pub(super) obstacle_reflection: &'static str,
}

/// The ground on a grid.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GroundSection {
    source: &'static str,
    points: usize,
    #[serde(skip_serializing_if = "is_zero")]
    points_not_believed: usize,
    grid_columns: usize,
    grid_rows: usize,
    cell_m: f64,
    cells_without_ground: usize,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde wants a reference")]
fn is_zero(count: &usize) -> bool {
    *count == 0
}

impl GroundSection {
    /// Describes a ground.
    #[must_use]
    pub fn of(known: &KnownGround) -> Self {
        let grid = known.ground.grid;
        let source = match known.report.from {
            GroundPoints::Found => "detected points (no class 2)",
            _ => "class 2",
        };
        Self {
            source,
            points: known.report.point_count,
            points_not_believed: known.report.doubted_count,
            grid_columns: grid.width,
            grid_rows: grid.height,
            cell_m: rounded(grid.cell, 4),
            cells_without_ground: grid.len() - known.report.cell_count,
        }
    }
}

/// Roofs that were found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RoofsSection {
    pub(super) source: &'static str,
    pub(super) points: usize,
    pub(super) points_on_planes: usize,
    pub(super) planes: usize,
    pub(super) buildings: usize,
    pub(super) area_m2: f64,
    pub(super) small_planes: usize,
    pub(super) small_planes_area_m2: f64,
}

/// Photovoltaic system of a yield.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PvSection {
    model: &'static str,
    mounting: &'static str,
    #[serde(flatten)]
    system: PvSystem,
}

impl PvSection {
    pub(super) fn of(system: &PvSystem) -> Self {
        Self { model: "PVWatts", mounting: "close to the roof", system: *system }
    }
}

/// Obstacles to lines of sight.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LinesSection {
    /// Answers of pairs.
    #[serde(flatten)]
    pairs: Option<PairsSection>,
    balls: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    patches: Option<usize>,
    depth_bias_m: f64,
    shell_m: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    proof_distance_m: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    max_unproven_length_m: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    directions: Option<usize>,
}

impl LinesSection {
    pub(super) fn of(blockers: &MedialScene, directions: Option<usize>) -> Self {
        let (rule, proof) = (blockers.params(), blockers.proof());
        Self {
            pairs: None,
            balls: blockers.ball_count(),
            patches: Some(blockers.patch_count()).filter(|count| *count > 0),
            depth_bias_m: rounded(rule.bias, 4),
            shell_m: rounded(rule.shell, 4),
            proof_distance_m: proof.map(|proof| rounded(proof.nearness(), 3)),
            max_unproven_length_m: proof.map(|proof| rounded(proof.tolerance(), 3)),
            directions,
        }
    }

    pub(super) fn with_pairs(self, pairs: PairsSection) -> Self {
        Self { pairs: Some(pairs), ..self }
    }
}

/// Light through trees.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct TreesSection {
    vegetation_balls: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    transmissivity: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    transmissivity_in_leaf: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    transmissivity_without_leaves: Option<f64>,
    /// Voxels of crowns that pulses measured.
    #[serde(skip_serializing_if = "Option::is_none")]
    crown_voxels: Option<usize>,
    /// Mean extinction in them, per metre.
    #[serde(skip_serializing_if = "Option::is_none")]
    mean_extinction: Option<f64>,
    /// First and last day on which they were measured.
    #[serde(skip_serializing_if = "Option::is_none")]
    crowns_measured: Option<[String; 2]>,
    /// Density of the crowns at that time, as a share of that in leaf.
    #[serde(skip_serializing_if = "Option::is_none")]
    density_when_measured: Option<f64>,
}

impl TreesSection {
    pub(super) fn of(
        crowns: &CrownLight,
        vegetation: &[bool],
        (medium, days): (Option<&ExtinctionVoxels>, &FlightDays),
    ) -> Self {
        let digits = |share: f64| rounded(share, 4);
        let section = Self { vegetation_balls: vegetation.iter().filter(|&&is| is).count(), ..Self::default() };
        match (crowns, medium) {
            (CrownLight::Share { transmissivity: Transmissivity { in_leaf, bare }, .. }, _) => {
                let is_constant = in_leaf == bare;
                Self {
                    transmissivity: is_constant.then(|| digits(*in_leaf)),
                    transmissivity_in_leaf: (!is_constant).then(|| digits(*in_leaf)),
                    transmissivity_without_leaves: (!is_constant).then(|| digits(*bare)),
                    ..section
                }
            }
            (CrownLight::Measured { density, .. }, Some(ExtinctionVoxels { extinction, .. })) => {
                let sum: f64 = extinction.iter().map(|&v| f64::from(v)).sum();
                Self {
                    crown_voxels: Some(extinction.len()),
                    mean_extinction: Some(digits(sum / extinction.len().max(1) as f64)),
                    crowns_measured: days
                        .iter()
                        .next()
                        .zip(days.iter().last())
                        .map(|(a, b)| [a.0, b.0].map(str::to_owned)),
                    density_when_measured: density.map(digits),
                    ..section
                }
            }
            (CrownLight::Measured { .. }, None) => section,
        }
    }
}

/// Statistics of measures over targets.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MeasuresSection {
    /// Targets with an answer.
    pub targets: usize,
    /// The spread of each measure.
    #[serde(flatten)]
    pub spread: NamedValues<Option<MeasureStatistics>>,
}

impl MeasuresSection {
    pub(super) fn of<'a>(targets: &Targets, measures: impl IntoIterator<Item = &'a Measure>) -> Self {
        Self::of_count(targets.target_count(), measures)
    }

    /// Creates the section for a number of targets.
    pub(super) fn of_count<'a>(targets: usize, measures: impl IntoIterator<Item = &'a Measure>) -> Self {
        let spread = measures.into_iter().map(|measure| (measure.name.clone(), measure.rounded_statistics()));
        Self { targets, spread: NamedValues(spread.collect()) }
    }
}

/// Number of pairs for each answer.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(super) struct PairsSection {
    pairs: usize,
    visible: usize,
    blocked: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    unproven: Option<usize>,
    no_line: usize,
    pub(super) outside_cloud: usize,
    /// Lines with an end inside an obstacle, which are neither visible nor blocked.
    pub(super) inside_obstacle: usize,
    visible_percent: f64,
    observers_inside_obstacle: usize,
    targets_inside_obstacle: usize,
}

impl PairsSection {
    pub(super) fn of(answers: &[Answer], unproven: UnprovenAs, inside: [usize; 2]) -> Self {
        let [observers_inside_obstacle, targets_inside_obstacle] = inside;
        let counts = AnswerCounts::of(answers);
        Self {
            pairs: answers.len(),
            visible: counts.visible,
            blocked: counts.blocked,
            unproven: (unproven == UnprovenAs::Reported).then_some(counts.unproven),
            no_line: counts.outside_view,
            outside_cloud: counts.outside_cloud,
            inside_obstacle: counts.inside_obstacle,
            visible_percent: percent(counts.visible, answers.len()),
            observers_inside_obstacle,
            targets_inside_obstacle,
        }
    }

    /// The answer in two lines.
    pub(super) fn headlines(&self) -> [String; 2] {
        let Self { pairs, visible, blocked, visible_percent, .. } = self;
        let unproven = self.unproven.map_or_else(String::new, |unproven| format!(", {unproven} unproven"));
        let rest = self.no_line + self.outside_cloud;
        let inside = match self.inside_obstacle {
            0 => String::new(),
            count => format!(", {count} with an end inside an obstacle"),
        };
        [
            format!("{visible} of {pairs} lines of sight ({visible_percent} %) are visible"),
            format!("{blocked} are blocked{unproven}{inside}, {rest} without an answer"),
        ]
    }
}
