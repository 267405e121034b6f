//! Sections of a report about sun, sky and weather.

use super::NamedValues;
use crate::heat::{Body, SurfaceParams};
use crate::irradiance::PvSystem;
use crate::sun::{Date, DayParams, SunSchedule, Zone};
use crate::tree_light::{CrownLight, Transmissivity};
use belvedere_core::medium::ExtinctionVoxels;
use belvedere_core::model::FlightDays;
use belvedere_data::report::rounded;
use serde::Serialize;

/// Days of suns.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct PeriodSection {
    pub(in crate::ask) first_day: String,
    pub(in crate::ask) last_day: String,
    pub(in crate::ask) days: usize,
    pub(in crate::ask) time_zone: String,
    pub(in crate::ask) time_step_min: f64,
    pub(in crate::ask) suns: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) suns_below_horizon: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) directions: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) possible_hours_per_day: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) max_direction_error_deg: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) rms_direction_error_deg: Option<f64>,
    /// Description of each rule.
    #[serde(flatten)]
    pub(in crate::ask) rules: NamedValues<String>,
}

impl PeriodSection {
    pub(in crate::ask) fn of(schedule: &SunSchedule, zone: &Zone, params: &DayParams) -> Self {
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
    pub(in crate::ask) fn of_dates(dates: &[Date], zone: &Zone, params: &DayParams, [suns, below]: [usize; 2]) -> Self {
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
    pub(in crate::ask) instants: NamedValues<SunAt>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) time_zone: Option<String>,
    pub(in crate::ask) suns: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) suns_below_horizon: Option<usize>,
}

/// Position of the sun.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(in crate::ask) struct SunAt {
    pub(in crate::ask) azimuth_deg: f64,
    pub(in crate::ask) elevation_deg: f64,
}

/// Radiation of sun and sky over a period.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct RadiationSection {
    pub(in crate::ask) source: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) year: Option<i16>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) weather_rows: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) weather_hours: Option<f64>,
    pub(in crate::ask) global_kwh_m2: f64,
    pub(in crate::ask) direct_normal_kwh_m2: f64,
    pub(in crate::ask) diffuse_kwh_m2: f64,
    pub(in crate::ask) sun_directions: usize,
    pub(in crate::ask) diffuse_model: String,
    pub(in crate::ask) obstacle_reflection: &'static str,
}

/// Light through trees.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct TreesSection {
    pub(in crate::ask) vegetation_balls: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) transmissivity: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) transmissivity_in_leaf: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) transmissivity_without_leaves: Option<f64>,
    /// Voxels of crowns that pulses measured.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) crown_voxels: Option<usize>,
    /// Mean extinction in them, per metre.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) mean_extinction: Option<f64>,
    /// First and last day on which they were measured.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) crowns_measured: Option<[String; 2]>,
    /// Density of the crowns at that time, as a share of that in leaf.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) density_when_measured: Option<f64>,
}

impl TreesSection {
    pub(in crate::ask) fn of(
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

/// Roofs that were found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RoofsSection {
    pub(in crate::ask) source: &'static str,
    pub(in crate::ask) points: usize,
    pub(in crate::ask) points_on_planes: usize,
    pub(in crate::ask) planes: usize,
    pub(in crate::ask) buildings: usize,
    pub(in crate::ask) area_m2: f64,
    pub(in crate::ask) small_planes: usize,
    pub(in crate::ask) small_planes_area_m2: f64,
}

/// Photovoltaic system of a yield.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PvSection {
    pub(in crate::ask) model: &'static str,
    pub(in crate::ask) mounting: &'static str,
    #[serde(flatten)]
    pub(in crate::ask) system: PvSystem,
}

impl PvSection {
    pub(in crate::ask) fn of(system: &PvSystem) -> Self {
        Self { model: "PVWatts", mounting: "close to the roof", system: *system }
    }
}

/// Glare for reports.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GlareSection {
    pub(in crate::ask) observers: usize,
    pub(in crate::ask) reflectors: usize,
    /// Hours of glare of all observers together, each counted once however many reflectors dazzle.
    pub(in crate::ask) hours: f64,
    pub(in crate::ask) after_image_hours: f64,
    pub(in crate::ask) unproven_hours: f64,
    pub(in crate::ask) scatter_deg: f64,
    pub(in crate::ask) from_sun_deg: f64,
    pub(in crate::ask) clear_sky: String,
}

/// Weather and model of an answer about heat, for reports.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct HeatSection {
    pub(in crate::ask) weather: &'static str,
    pub(in crate::ask) time_zone: String,
    pub(in crate::ask) days: usize,
    pub(in crate::ask) hours: f64,
    pub(in crate::ask) mean_air_temperature_c: f64,
    pub(in crate::ask) max_air_temperature_c: f64,
    pub(in crate::ask) max_global_w_m2: f64,
    pub(in crate::ask) body: Body,
    #[serde(flatten)]
    pub(in crate::ask) surfaces: SurfaceParams,
    pub(in crate::ask) not_modelled: &'static str,
}

/// Exposure of routes or windows, for reports.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ExposureSection {
    /// Number of routes or windows.
    #[serde(flatten)]
    pub(in crate::ask) groups: NamedValues<usize>,
    pub(in crate::ask) targets: usize,
    pub(in crate::ask) sky_directions: usize,
    /// Means by weight.
    #[serde(flatten)]
    pub(in crate::ask) means: NamedValues<f64>,
}

/// The envelope, for reports.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EnvelopeSection {
    pub(in crate::ask) columns: usize,
    pub(in crate::ask) cell_m: f64,
    pub(in crate::ask) area_m2: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) volume_m3: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) mean_height_m: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) max_height_m: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) columns_unlimited: Option<usize>,
    pub(in crate::ask) columns_of_zero_height: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) columns_at_max_height: Option<usize>,
    pub(in crate::ask) cells_without_ground: usize,
    pub(in crate::ask) protected_pieces: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) facing_away_percent: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ask) existing_shadow_percent: Option<f64>,
    /// The suns that limit the largest areas.
    pub(in crate::ask) limiting_suns: Vec<String>,
    /// The places that do.
    pub(in crate::ask) limiting_places: Vec<String>,
}
