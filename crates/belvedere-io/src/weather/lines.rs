//! Lines of cells parted by commas, and errors that name them.

use belvedere_data::cast::to_i32;
use belvedere_data::weather::{CalendarDay, RowsHold, Weather, WeatherAir};
use belvedere_data::{Error, Result};
use std::ops::RangeInclusive;
use std::path::Path;

/// Maximum radiation that any instrument below the atmosphere shows, W/m², with room for clouds that reflect.
const MAX_RADIATION: f64 = 3000.0;
/// Values that mark missing radiation: nines, in some files with zeros behind.
const MISSING: RangeInclusive<f64> = 9999.0..=1e7;
const MISSING_BELOW_ZERO: [f64; 5] = [-99.0, -999.0, -9999.0, -9900.0, -99900.0];
/// Noise of sensors at night, W/m².
const NOISE: f64 = -20.0;

/// Advice for more cells than names.
pub(super) const DECIMAL_COMMAS: &str = "; are there decimal commas? Numbers need points: 10.5";

/// The lines of a weather file.
pub(super) struct WeatherLines<'a> {
    pub(super) path: &'a Path,
    text: &'a str,
}

/// One line, its number counted from 1.
#[derive(Clone, Copy)]
pub(super) struct WeatherLine<'a> {
    path: &'a Path,
    pub(super) number: usize,
    pub(super) text: &'a str,
}

impl<'a> WeatherLines<'a> {
    pub(super) fn new(path: &'a Path, text: &'a str) -> Self {
        Self { path, text }
    }

    pub(super) fn all(&self) -> impl Iterator<Item = WeatherLine<'a>> {
        let path = self.path;
        self.text.lines().enumerate().map(move |(row, text)| WeatherLine {
            path,
            number: row + 1,
            text: text.trim_end(),
        })
    }

    /// Line `number`, from 1.
    pub(super) fn line(&self, number: usize) -> Result<WeatherLine<'a>> {
        self.all().nth(number - 1).ok_or_else(|| Error::malformed(self.path, format!("ends before line {number}")))
    }
}

impl<'a> WeatherLine<'a> {
    pub(super) fn wrong(&self, what: &str) -> Error {
        Error::malformed(self.path, format!("line {}: {what}", self.number))
    }

    /// The cells of a row, of which there must be as many as the head of the table has.
    pub(super) fn row_of(&self, names: &[&str]) -> Result<Vec<&'a str>> {
        let mut cells = self.cells();
        while cells.len() > names.len() && cells.last().is_some_and(|cell| cell.is_empty()) {
            cells.pop();
        }
        if cells.len() != names.len() {
            let (count, expected) = (cells.len(), names.len());
            let advice = if count > expected { DECIMAL_COMMAS } else { "" };
            return Err(self.wrong(&format!("has {count} cells, but the header of the table has {expected}{advice}")));
        }
        Ok(cells)
    }

    pub(super) fn cells(&self) -> Vec<&'a str> {
        self.text.split(',').map(|cell| cell.trim().trim_matches('"')).collect()
    }

    /// The number in a cell, which `name` is said to hold.
    pub(super) fn number_in(&self, cells: &[&str], column: usize, name: &str) -> Result<f64> {
        let cell = cells.get(column).ok_or_else(|| {
            self.wrong(&format!("{name} should stand in cell {}, but there are {}", column + 1, cells.len()))
        })?;
        match cell.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => Err(self.wrong(&format!("{name} is \"{}\", which is not a number", shortened(cell)))),
        }
    }

    /// The same where a whole number is meant.
    pub(super) fn whole_in(&self, cells: &[&str], column: usize, name: &str) -> Result<i32> {
        let value = self.number_in(cells, column, name)?;
        if value.fract() == 0.0 && value.abs() < 1e6 {
            Ok(to_i32(value))
        } else {
            Err(self.wrong(&format!("{name} is {value}, which is not a whole number")))
        }
    }

    /// Radiation in a cell, W/m²; `None` where the cell is empty, or has a value that formats and programs mark as
    /// missing: 9999 and more, -99, -999 and so on.
    pub(super) fn radiation_in(&self, cells: &[&str], column: usize, name: &str) -> Result<Option<f64>> {
        if cells.get(column).is_some_and(|cell| cell.is_empty()) {
            return Ok(None);
        }
        let value = self.number_in(cells, column, name)?;
        if MISSING.contains(&value) || MISSING_BELOW_ZERO.contains(&value) {
            return Ok(None);
        }
        if !(NOISE..=MAX_RADIATION).contains(&value) {
            return Err(self.wrong(&format!("{name} is {value} W/m², but must be {NOISE} to {MAX_RADIATION}")));
        }
        Ok(Some(value.max(0.0)))
    }

    /// The air of a row, from the columns of temperature, relative humidity, wind and longwave radiation of the sky.
    /// Values that are missing, or that no air has, are left out.
    pub(super) fn air(cells: &[&str], columns: [Option<usize>; 4]) -> WeatherAir {
        let value = |number: usize, range: RangeInclusive<f64>| {
            let value: f64 = cells.get(columns[number]?)?.parse().ok()?;
            range.contains(&value).then_some(value)
        };
        WeatherAir {
            temperature: value(0, -90.0..=70.0),
            relative_humidity: value(1, 0.0..=110.0).map(|percent| percent.min(100.0)),
            wind_speed: value(2, 0.0..=100.0),
            sky_longwave: value(3, 50.0..=700.0),
        }
    }

    pub(super) fn day(&self, year: i32, month: i32, day: i32) -> Result<CalendarDay> {
        let known = |v: i32| u8::try_from(v).unwrap_or(0);
        CalendarDay::new(year, known(month), known(day))
            .ok_or_else(|| self.wrong(&format!("there is no day {year}-{month:02}-{day:02}")))
    }
}

pub(super) fn shortened(text: &str) -> String {
    text.chars().take(40).collect()
}

/// Creates weather without rows yet, at a place in degrees.
pub(super) fn weather_at(
    format: &'static str,
    [latitude, longitude]: [f64; 2],
    height: f64,
    rows_hold: RowsHold,
    utc_offset: f64,
) -> Weather {
    let [latitude, longitude] = [latitude, longitude].map(f64::to_radians);
    let (steps, notes) = (Vec::new(), Vec::new());
    Weather { format, latitude, longitude, height, rows_hold, utc_offset, steps, left_out_count: 0, notes }
}
