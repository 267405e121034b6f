//! A period row by row, and the radiation on a plane in each row.

use super::instants::{HOUR_S, row_of_step};
use super::irradiation::{Irradiation, on_plane};
use super::period::{IrradianceParams, PeriodRadiation};
use super::pvwatts::cover_transmission;
use super::seasons::{RadiationSource, season_instants};
use crate::sun::{Date, Site, Zone};
use crate::tree_light::CrownLight;
use belvedere_data::Result;
use belvedere_data::control::Control;
use belvedere_data::error::check_length;
use belvedere_data::vector::{dot, length};
use belvedere_data::weather::{RowsHold, Weather, WeatherStep};

/// A row of weather of an hour or more, an hour of shorter rows, or an hour of a clear sky.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PeriodRow {
    /// Its middle, or the instant of its values, seconds since 1970-01-01 UTC.
    pub instant: f64,
    /// Duration, hours.
    pub hours: f64,
    /// Month, 1 to 12.
    pub month: u8,
    /// Temperature of the air, °C, where it is known.
    pub temperature: Option<f64>,
    /// Wind speed 10 m above the ground, m/s, where it is known.
    pub wind_speed: Option<f64>,
}

/// Mean of what is known.
#[derive(Clone, Copy, Default)]
struct KnownMean {
    sum: f64,
    count: f64,
}

impl KnownMean {
    fn add(&mut self, value: Option<f64>) {
        if let Some(value) = value {
            self.sum += value;
            self.count += 1.0;
        }
    }

    fn value(self) -> Option<f64> {
        (self.count > 0.0).then(|| self.sum / self.count)
    }
}

fn weather_rows(weather: &Weather) -> Vec<PeriodRow> {
    let is_of_row = |a: &WeatherStep, b: &WeatherStep| row_of_step(weather, a) == row_of_step(weather, b);
    let row = |steps: &[WeatherStep]| {
        let first = steps.first()?;
        let [mut temperature, mut wind_speed] = [KnownMean::default(); 2];
        for step in steps {
            temperature.add(step.air.temperature);
            wind_speed.add(step.air.wind_speed);
        }
        Some(PeriodRow {
            instant: row_of_step(weather, first),
            hours: steps.iter().map(|step| step.hours).sum(),
            month: first.month,
            temperature: temperature.value(),
            wind_speed: wind_speed.value(),
        })
    };
    weather.steps.chunk_by(is_of_row).filter_map(row).collect()
}

fn clear_rows(year: i16, zone: &Zone) -> Result<Vec<PeriodRow>> {
    let begin = |year: i16| zone.instant_of(Date::new(year, 1, 1)?, 0.0);
    let (mut instant, end) = (begin(year)? + 0.5 * HOUR_S, begin(year.saturating_add(1))?);
    let mut rows = Vec::new();
    while instant < end {
        let month = u8::try_from(zone.date_at(instant)?.month()).unwrap_or(1);
        rows.push(PeriodRow { instant, hours: 1.0, month, temperature: None, wind_speed: None });
        instant += HOUR_S;
    }
    Ok(rows)
}

/// Radiation on a plane in a row, W/m².
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RowRadiation {
    /// Direct radiation.
    pub beam: f64,
    /// Radiation of the sky, with the part around the sun.
    pub diffuse: f64,
    /// Radiation of the ground and of obstacles.
    pub reflected: f64,
    /// Direct radiation that passes the cover of panels.
    pub beam_through_cover: f64,
}

impl RowRadiation {
    /// All that reaches the plane.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.beam + self.diffuse + self.reflected
    }

    /// All that reaches the cells of panels. Only direct radiation loses by its angle, as in PVWatts and pvlib.
    #[must_use]
    pub fn through_cover(&self) -> f64 {
        self.beam_through_cover + self.diffuse + self.reflected
    }
}

/// Radiation of sun and sky in each row of a period.
#[derive(Clone, Debug)]
pub struct PeriodRows {
    /// The rows, in the order of the weather or of time.
    pub rows: Vec<PeriodRow>,
    /// Clock of the rows.
    pub zone: Zone,
    /// Meaning of the values of a row.
    pub rows_hold: RowsHold,
    seasons: Vec<SeasonRows>,
}

/// Radiation of the rows of a season that have some.
#[derive(Clone, Debug)]
struct SeasonRows {
    radiation: PeriodRadiation,
    /// Number of the row of each group.
    numbers: Vec<usize>,
}

impl PeriodRows {
    /// Gathers the rows of a period, whose seasons are those of [`period_seasons`](super::period_seasons). A clear sky
    /// has the hours of the zone of its longitude, a whole number of hours from UTC.
    ///
    /// # Errors
    /// Those of [`period_seasons`](super::period_seasons).
    pub fn gather(
        source: &RadiationSource<'_>,
        site: &Site,
        crowns: Option<CrownLight>,
        params: &IrradianceParams,
        control: &Control<'_>,
    ) -> Result<Self> {
        let (rows, zone, rows_hold) = match *source {
            RadiationSource::Weather { weather, .. } => {
                (weather_rows(weather), clock(weather.utc_offset)?, weather.rows_hold)
            }
            RadiationSource::ClearSky { year, .. } => {
                let zone = clock((site.longitude.to_degrees() / 15.0).round())?;
                (clear_rows(year, &zone)?, zone, RowsHold::Means)
            }
        };
        let mut order: Vec<usize> = (0..rows.len()).collect();
        order.sort_by(|&a, &b| rows[a].instant.total_cmp(&rows[b].instant));
        // a clear year begins by the sun, up to half an hour beside its first hour
        let number = |instant: &f64| {
            let after = order.partition_point(|&row| rows[row].instant < *instant);
            order.get(after.min(order.len().saturating_sub(1))).copied().unwrap_or_default()
        };
        let mut seasons = Vec::new();
        for (_, instants) in season_instants(source, site, crowns, control)? {
            control.check()?;
            let (radiation, instants) = PeriodRadiation::gather_rows(&instants, params)?;
            seasons.push(SeasonRows { radiation, numbers: instants.iter().map(number).collect() });
        }
        Ok(Self { rows, zone, rows_hold, seasons })
    }

    /// Returns the radiation in each row on a plane with a unit `normal`, reached by these shares of the light of each
    /// direction, season by season; `None` for a plane without obstacles.
    ///
    /// # Errors
    /// [`Error::LengthMismatch`](belvedere_data::Error::LengthMismatch) for shares of other seasons or directions.
    pub fn on_plane(&self, normal: [f64; 3], light: Option<&[&[f32]]>) -> Result<Vec<RowRadiation>> {
        let mut found = vec![RowRadiation::default(); self.rows.len()];
        check_length("seasons of a plane", self.seasons.len(), light.map_or(self.seasons.len(), <[_]>::len))?;
        for (season, SeasonRows { radiation, numbers }) in self.seasons.iter().enumerate() {
            let own = light.and_then(|light| light.get(season).copied());
            let expected = radiation.sun_directions.len() + radiation.sky.directions.len();
            check_length("directions of sun and sky", expected, own.map_or(expected, <[_]>::len))?;
            let share = |direction: usize| own.map_or(1.0, |own| own.get(direction).copied().map_or(0.0, f64::from));
            let mut groups = vec![Irradiation::default(); numbers.len()];
            on_plane(radiation, normal, share, &mut groups);
            let mut through_cover = vec![0.0; numbers.len()];
            for sun in &radiation.sun {
                let beam = dot(sun.beam, normal);
                if let Some(sum) = through_cover.get_mut(sun.group).filter(|_| beam > 0.0) {
                    *sum += share(sun.direction) * beam * cover_transmission(beam / length(sun.beam));
                }
            }
            for ((&number, group), through_cover) in numbers.iter().zip(&groups).zip(through_cover) {
                let (Some(row), Some(found)) = (self.rows.get(number), found.get_mut(number)) else { continue };
                found.beam += 1000.0 * group.beam / row.hours;
                found.diffuse += 1000.0 * group.diffuse / row.hours;
                found.reflected += 1000.0 * group.reflected / row.hours;
                found.beam_through_cover += through_cover / row.hours;
            }
        }
        Ok(found)
    }
}

/// A clock that is so many hours ahead of UTC.
fn clock(hours: f64) -> Result<Zone> {
    let sign = if hours < 0.0 { '-' } else { '+' };
    let minutes = (hours.abs() * 60.0).round();
    Zone::parse(&format!("{sign}{:02}:{:02}", (minutes / 60.0).floor(), minutes % 60.0))
}

#[cfg(test)]
mod tests {
    use super::super::instants::hour_around;
    use super::*;
    use belvedere_data::weather::WeatherAir;

    #[test]
    fn short_rows_are_gathered_in_hours_of_the_clock_of_the_file() {
        // half hours of India, whose hours begin at half past by UTC
        let step = |number: u32| WeatherStep {
            instant: 1_800_000_000.0 + 900.0 + 1800.0 * f64::from(number),
            hours: 0.5,
            month: 1,
            ghi: Some(0.0),
            dni: None,
            dhi: None,
            air: WeatherAir { temperature: (number != 1).then_some(f64::from(number)), ..WeatherAir::default() },
        };
        let weather = Weather {
            format: "NSRDB",
            latitude: 0.3,
            longitude: 1.3,
            height: 0.0,
            rows_hold: RowsHold::Instants,
            utc_offset: 5.5,
            steps: (0..5).map(step).collect(),
            left_out_count: 0,
            notes: Vec::new(),
        };
        let rows = weather_rows(&weather);
        // 1 800 000 000 is a whole hour of UTC, the middle of one there
        assert_eq!(rows.iter().map(|row| row.hours).collect::<Vec<_>>(), [0.5, 1.0, 1.0]);
        assert_eq!(rows.iter().map(|row| row.temperature).collect::<Vec<_>>(), [Some(0.0), Some(2.0), Some(3.5)]);
        assert_eq!(rows[1].instant, 1_800_000_000.0 + 3600.0);
        assert!(rows.iter().all(|row| row.wind_speed.is_none()));
        assert_eq!(clock(-3.5).unwrap().display(0.0), "1969-12-31T20:30:00-03:30");
    }

    #[test]
    fn a_clear_year_has_the_hours_of_its_zone() {
        let rows = clear_rows(2026, &clock(1.0).unwrap()).unwrap();
        assert_eq!(rows.len(), 8760);
        assert_eq!(hour_around(rows[5].instant + 1000.0, 0.0), rows[5].instant);
        assert_eq!((rows[0].month, rows[8759].month), (1, 12));
    }
}
