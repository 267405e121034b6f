//! Electricity of the planes of roofs over a period, between both ends of partial shade.

use super::period_rows::{PeriodRow, PeriodRows, RowRadiation};
use super::pvwatts::{PvPower, PvSystem, REFERENCE_RADIATION, cell_temperature};
use super::roofs::RoofIrradiation;
use crate::roof_planes::RoofPlane;
use belvedere_data::Result;
use belvedere_data::control::Control;
use belvedere_data::weather::USUAL_WIND;
use rayon::prelude::*;

/// Temperature of the air where weather has none, °C: that of PVWatts' reference conditions and pvlib.
pub const USUAL_TEMPERATURE: f64 = 20.0;

/// Electricity of each month, kWh, January first.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PvEnergy {
    /// Direct current.
    pub dc: [f64; 12],
    /// Alternating current.
    pub ac: [f64; 12],
}

impl PvEnergy {
    /// Direct and alternating current of all months, kWh.
    #[must_use]
    pub fn total(&self) -> PvPower {
        PvPower { dc: self.dc.iter().sum(), ac: self.ac.iter().sum() }
    }

    /// Adds the electricity of another system.
    pub fn add(&mut self, other: &Self) {
        for month in 0..12 {
            self.dc[month] += other.dc[month];
            self.ac[month] += other.ac[month];
        }
    }
}

/// Electricity of the panels of a plane over a period. Plants lie between the two ends.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PlaneYield {
    /// Peak power of the panels, kW.
    pub peak_power: f64,
    /// Electricity if each panel works for itself.
    pub mean: PvEnergy,
    /// Electricity if a row of panels is a string without bypass diodes.
    pub string_limited: PvEnergy,
}

impl PlaneYield {
    /// Adds the yield of another plane.
    pub fn add(&mut self, other: &Self) {
        self.peak_power += other.peak_power;
        self.mean.add(&other.mean);
        self.string_limited.add(&other.string_limited);
    }
}

/// Radiation and power of a plane in a row of the period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneHour {
    /// Radiation without obstacles.
    pub free: RowRadiation,
    /// Mean radiation of the cells.
    pub mean: RowRadiation,
    /// Radiation of strings.
    pub string_limited: RowRadiation,
    /// Power if each panel works for itself, as a share of the peak power.
    pub mean_power: PvPower,
    /// Power of strings.
    pub string_power: PvPower,
}

/// Returns the power of a system under the radiation of a row.
fn power(system: &PvSystem, row: &PeriodRow, radiation: &RowRadiation) -> PvPower {
    let (temperature, wind) = (row.temperature.unwrap_or(USUAL_TEMPERATURE), row.wind_speed.unwrap_or(USUAL_WIND));
    system.power(radiation.through_cover(), cell_temperature(radiation.total(), temperature, wind))
}

/// Returns the mean and the string-limited radiation of a plane in each row.
fn both_ends(rows: &PeriodRows, plane: &RoofPlane, energy: &RoofIrradiation) -> Result<[Vec<RowRadiation>; 2]> {
    let mean: Vec<&[f32]> = energy.light.iter().map(|light| &light.mean[..]).collect();
    let strings: Vec<&[f32]> = energy.light.iter().map(|light| &light.string_limited[..]).collect();
    Ok([rows.on_plane(plane.normal, Some(&mean))?, rows.on_plane(plane.normal, Some(&strings))?])
}

/// Computes the electricity of `planes` with their `energies` over the rows of a period. Each plane has an inverter of
/// its own, and one temperature of its cells. Progress counts planes.
///
/// # Errors
/// Those of [`PvSystem::validate`] and [`PeriodRows::on_plane`], and
/// [`Cancelled`](belvedere_data::Error::Cancelled).
pub fn roof_yields(
    planes: &[RoofPlane],
    energies: &[RoofIrradiation],
    rows: &PeriodRows,
    system: &PvSystem,
    control: &Control<'_>,
) -> Result<Vec<PlaneYield>> {
    system.validate()?;
    let of_plane = |(plane, energy): (&RoofPlane, &RoofIrradiation)| -> Result<PlaneYield> {
        control.check()?;
        let peak_power = system.module_efficiency * energy.panel_area(plane);
        let sum = |radiation: &[RowRadiation]| {
            let mut sum = PvEnergy::default();
            for (row, radiation) in rows.rows.iter().zip(radiation).filter(|(_, radiation)| radiation.total() > 0.0) {
                let (power, month) = (power(system, row, radiation), usize::from(row.month.clamp(1, 12)) - 1);
                sum.dc[month] += peak_power * power.dc * row.hours;
                sum.ac[month] += peak_power * power.ac * row.hours;
            }
            sum
        };
        let [mean, string_limited] = both_ends(rows, plane, energy)?;
        control.advance(1);
        Ok(PlaneYield { peak_power, mean: sum(&mean), string_limited: sum(&string_limited) })
    };
    planes.par_iter().zip(energies).map(of_plane).collect()
}

/// Returns the radiation and the power of a plane in each row of a period.
///
/// # Errors
/// Those of [`PeriodRows::on_plane`].
pub fn plane_hours(
    plane: &RoofPlane,
    energy: &RoofIrradiation,
    rows: &PeriodRows,
    system: &PvSystem,
) -> Result<Vec<PlaneHour>> {
    let free = rows.on_plane(plane.normal, None)?;
    let [mean, strings] = both_ends(rows, plane, energy)?;
    let of_row = |((row, free), (mean, string_limited)): ((&PeriodRow, _), (RowRadiation, RowRadiation))| PlaneHour {
        free,
        mean,
        string_limited,
        mean_power: power(system, row, &mean),
        string_power: power(system, row, &string_limited),
    };
    Ok(rows.rows.iter().zip(free).zip(mean.into_iter().zip(strings)).map(of_row).collect())
}

/// Returns the performance ratio: alternating current relative to a system that keeps its peak efficiency.
/// `radiation_kwh_m2` is what reaches the panels.
#[must_use]
pub fn performance_ratio(energy: &PvEnergy, peak_power: f64, radiation_kwh_m2: f64) -> f64 {
    energy.total().ac / (peak_power * radiation_kwh_m2 * 1000.0 / REFERENCE_RADIATION)
}
