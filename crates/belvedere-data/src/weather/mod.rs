//! Measured or typical radiation of a place: the contents of weather files.

mod calendar;

pub use calendar::{CalendarDay, date_of_unix_day, day_of_year, unix_day};

use crate::{Error, Parameter, Result};

/// Radiation on a level plane and towards the sun, W/m², the mean of an interval or the value of an instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Irradiance {
    /// Global, on a level plane.
    pub ghi: f64,
    /// Direct, on a plane that faces the sun.
    pub dni: f64,
    /// Diffuse, on a level plane.
    pub dhi: f64,
}

/// The air of a row of a weather file, as far as the file has it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WeatherAir {
    /// Temperature, °C.
    pub temperature: Option<f64>,
    /// Relative humidity, %.
    pub relative_humidity: Option<f64>,
    /// Wind speed 10 m above the ground, m/s.
    pub wind_speed: Option<f64>,
    /// Longwave radiation of the sky on a level plane, W/m².
    pub sky_longwave: Option<f64>,
}

/// One row of a weather file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WeatherStep {
    /// The instant whose sun goes with the row: the middle of an interval, or the instant of a value, seconds since
    /// 1970-01-01 UTC.
    pub instant: f64,
    /// Duration of the row, hours.
    pub hours: f64,
    /// Month in the time of the file, 1 to 12.
    pub month: u8,
    /// Global radiation on a level plane, W/m²; without it there are both of the others, from which it follows.
    pub ghi: Option<f64>,
    /// Direct radiation towards the sun, W/m², where the file has it.
    pub dni: Option<f64>,
    /// Diffuse radiation on a level plane, W/m², where the file has it.
    pub dhi: Option<f64>,
    /// The air, where the file has it.
    pub air: WeatherAir,
}

/// Meaning of the value of a row in a weather file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RowsHold {
    /// The mean of the interval around [`WeatherStep::instant`].
    Means,
    /// The value at [`WeatherStep::instant`].
    Instants,
}

/// The radiation of a place over a year or another period.
#[derive(Clone, Debug, PartialEq)]
pub struct Weather {
    /// Kind of file, such as "EPW".
    pub format: &'static str,
    /// Latitude, radians, north positive.
    pub latitude: f64,
    /// Longitude, radians, east positive.
    pub longitude: f64,
    /// Height above the sea, metres; 0 where the file does not say.
    pub height: f64,
    /// Meaning of the values of rows.
    pub rows_hold: RowsHold,
    /// Clock of the file: hours that it is ahead of UTC.
    pub utc_offset: f64,
    /// The rows in the order of the file.
    pub steps: Vec<WeatherStep>,
    /// Rows of the file that hold no radiation, and are left out.
    pub left_out_count: usize,
    /// Further notes for people.
    pub notes: Vec<String>,
}

/// Hours of a year of the Gregorian calendar.
const HOURS_OF_YEAR: f64 = 8765.82;
/// Share of a year that may be missing or too much: two weeks, more than leap days and rows without values.
const YEAR_TOLERANCE: f64 = 0.04;

impl Weather {
    /// Hours of all rows together.
    #[must_use]
    pub fn hours(&self) -> f64 {
        self.steps.iter().map(|step| step.hours).sum()
    }

    /// Returns a remark on a period that is not one year: sums are those of its rows.
    #[must_use]
    pub fn period_remark(&self) -> Option<String> {
        let years = self.hours() / HOURS_OF_YEAR;
        let remark =
            || format!("the weather covers {:.0} hours, {years:.2} years: energies are sums over these", self.hours());
        ((years - 1.0).abs() > YEAR_TOLERANCE).then(remark)
    }

    /// Checks the guarantees of the readers of all formats.
    ///
    /// # Errors
    /// [`Error::NoPoints`] without rows, [`Error::InvalidParameter`] for rows of the same time, for a place that is not
    /// on earth, and for values that are not finite or below zero.
    pub fn validate(&self) -> Result<()> {
        if self.steps.is_empty() {
            return Err(Error::NoPoints { what: "the weather has no row with radiation".to_owned() });
        }
        let on_earth = self.latitude.abs() <= 90f64.to_radians() && self.longitude.abs() <= 360f64.to_radians();
        if !on_earth || !self.height.is_finite() {
            return Err(Error::invalid(
                Parameter::Weather,
                format!("at {}, {}", self.latitude.to_degrees(), self.longitude.to_degrees()),
                "at latitude -90 to 90 and longitude -360 to 360 degrees",
            ));
        }
        let mut instants: Vec<f64> = self.steps.iter().map(|step| step.instant).collect();
        instants.sort_unstable_by(f64::total_cmp);
        let repeated = instants.windows(2).filter(|pair| pair[0] >= pair[1]).count();
        if repeated > 0 {
            return Err(Error::invalid(
                Parameter::Weather,
                format!("{repeated} of {} rows with the time of another row", self.steps.len()),
                "one row for each time, or their energy counts twice",
            ));
        }
        for step in &self.steps {
            let values = [step.ghi, step.dni, step.dhi];
            let is_complete = step.ghi.is_some() || step.dni.zip(step.dhi).is_some();
            if !values.iter().flatten().all(|v| v.is_finite() && *v >= 0.0)
                || !is_complete
                || !(step.hours > 0.0)
                || step.hours > 8784.0
            {
                return Err(Error::invalid(
                    Parameter::Weather,
                    format!("a row of {step:?}"),
                    "finite, not below zero, and global radiation or both of its parts",
                ));
            }
        }
        Ok(())
    }
}

/// Wind speed where weather has none, m/s: a light breeze.
pub const USUAL_WIND: f64 = 2.0;

#[cfg(test)]
mod tests {
    use super::*;

    fn weather(hours: impl Iterator<Item = u32>) -> Weather {
        let step = |hour: u32| WeatherStep {
            instant: f64::from(hour) * 3600.0,
            hours: 1.0,
            month: 1,
            ghi: Some(100.0),
            dni: None,
            dhi: None,
            air: WeatherAir::default(),
        };
        Weather {
            format: "EPW",
            latitude: 0.9,
            longitude: 0.1,
            height: 0.0,
            rows_hold: RowsHold::Means,
            utc_offset: 0.0,
            steps: hours.map(step).collect(),
            left_out_count: 0,
            notes: Vec::new(),
        }
    }

    #[test]
    fn rows_of_the_same_time_are_refused_and_counted() {
        assert!(weather(0..8760).validate().is_ok());
        let twice = weather((0..8760).chain(0..8760)).validate().unwrap_err().to_string();
        assert!(twice.contains("8760 of 17520 rows"), "{twice}");
    }

    #[test]
    fn a_period_that_is_not_a_year_is_remarked() {
        assert_eq!(weather(0..8760).period_remark(), None);
        assert_eq!(weather(0..8784).period_remark(), None);
        assert!(weather(0..4380).period_remark().unwrap().contains("4380 hours, 0.50 years"));
        assert!(weather(0..3 * 8766).period_remark().unwrap().contains("3.00 years"));
    }
}
