//! Columns of the hours of a plane: radiation, losses by shading and electricity.

use super::period_rows::{PeriodRow, PeriodRows, RowRadiation};
use super::yields::PlaneHour;
use crate::result_columns::ResultColumn;
use belvedere_data::weather::RowsHold;
use std::ops::Range;

/// Returns the columns of the `hours` of a plane, a row for each of `rows`; `peak_power` is that of its panels, kW.
/// Times are the begin of rows that hold means, and the instant of other rows, by the clock of the weather. Columns
/// that begin with `string_` hold if rows of panels are strings.
#[must_use]
pub fn hour_columns(rows: &PeriodRows, hours: &[PlaneHour], peak_power: f64) -> Vec<ResultColumn> {
    let time = |row: &PeriodRow| {
        let before = if rows.rows_hold == RowsHold::Means { 1800.0 * row.hours } else { 0.0 };
        rows.zone.display(row.instant - before)
    };
    let times: Vec<String> = rows.rows.iter().map(time).collect();
    // such as 2026-06-21T12:00:00+01:00
    let part = |name: &str, range: Range<usize>| {
        ResultColumn::words(name, times.iter().map(|text| text.get(range.clone()).unwrap_or_default()))
    };
    let real = |name: &str, decimals, value: &dyn Fn(&PlaneHour) -> f64| {
        ResultColumn::real(name, hours.iter().map(value), decimals)
    };
    let air = |name: &str, value: fn(&PeriodRow) -> Option<f64>| {
        ResultColumn::real(name, rows.rows.iter().map(|row| value(row).unwrap_or(f64::NAN)), 1)
    };
    let peak_w = 1000.0 * peak_power;
    vec![
        part("date", 0..10),
        part("time", 11..16),
        part("zone", 19..25),
        real("poa_w_m2", 1, &|hour| hour.mean.total()),
        real("string_poa_w_m2", 1, &|hour| hour.string_limited.total()),
        real("free_poa_w_m2", 1, &|hour| hour.free.total()),
        real("beam_loss_percent", 2, &|hour| beam_loss_percent(hour, &hour.mean)),
        real("string_beam_loss_percent", 2, &|hour| beam_loss_percent(hour, &hour.string_limited)),
        real("sky_loss_percent", 2, &|hour| lost_percent(hour.mean.diffuse, hour.free.diffuse)),
        air("air_c", |row| row.temperature),
        air("wind_m_s", |row| row.wind_speed),
        real("dc_w", 1, &|hour| peak_w * hour.mean_power.dc),
        real("ac_w", 1, &|hour| peak_w * hour.mean_power.ac),
        real("string_dc_w", 1, &|hour| peak_w * hour.string_power.dc),
        real("string_ac_w", 1, &|hour| peak_w * hour.string_power.ac),
    ]
}

/// Returns the share of the direct radiation of an hour that shading takes from `radiation`, percent.
fn beam_loss_percent(hour: &PlaneHour, radiation: &RowRadiation) -> f64 {
    lost_percent(radiation.beam, hour.free.beam)
}

/// Returns the share of the diffuse radiation of the sky that shading takes over all `hours` of a plane, percent.
#[must_use]
pub fn sky_loss_percent(hours: &[PlaneHour]) -> f64 {
    let sum = |part: fn(&PlaneHour) -> &RowRadiation| hours.iter().map(|hour| part(hour).diffuse).sum();
    lost_percent(sum(|hour| &hour.mean), sum(|hour| &hour.free))
}

/// Lost share of what would arrive, percent; 0 where nothing would.
fn lost_percent(arrives: f64, free: f64) -> f64 {
    if free > 0.0 { (100.0 * (1.0 - arrives / free)).clamp(0.0, 100.0) } else { 0.0 }
}
