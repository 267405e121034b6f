//! Check of the clock of a weather file: days are as long before noon as after it.

use crate::sun::{Site, sun_times};
use belvedere_data::Result;
use belvedere_data::contradiction::{FoundContradiction, WEATHER_CLOCK};
use belvedere_data::report::rounded;
use belvedere_data::weather::{Weather, WeatherStep};

/// Radiation from which on it is day, W/m²: diffuse light reaches valleys too, and sensors show some watts at night.
const DAYLIGHT: f64 = 5.0;
/// Minimum number of days: single ones are lit by the row, and by clouds in the west.
const MIN_DAYS: usize = 60;
const DAY_S: f64 = 86_400.0;
/// Rows that are this long at most, hours.
const MAX_STEP: f64 = 1.01;
/// A row of no radiation is this near to the first and last ones of daylight, in rows: days that a gap cuts tell
/// nothing.
const NEXT: f64 = 1.5;

/// Describes the offset between the middle of the light of its days and solar noon. `None` without an offset, and with
/// too few usable days.
///
/// # Errors
/// Those of [`sun_times`].
pub(crate) fn clock_contradiction(weather: &Weather) -> Result<Option<FoundContradiction>> {
    let site = Site {
        latitude: weather.latitude,
        // the same meridian within half a turn
        longitude: (weather.longitude + std::f64::consts::PI).rem_euclid(std::f64::consts::TAU) - std::f64::consts::PI,
        height: 0.0,
        convergence: 0.0,
    };
    let mut steps: Vec<&WeatherStep> = weather.steps.iter().filter(|step| step.hours <= MAX_STEP).collect();
    steps.sort_by(|a, b| a.instant.total_cmp(&b.instant));
    // days by the sun: from one midnight to the next
    let day_of = |step: &WeatherStep| ((step.instant / DAY_S) + site.longitude / std::f64::consts::TAU).floor();
    let mut offsets = Vec::new();
    for day in steps.chunk_by(|a, b| day_of(a).total_cmp(&day_of(b)).is_eq()) {
        let Some(middle) = middle_of_light(day) else { continue };
        let noon = sun_times(&site, middle - DAY_S / 2.0, middle + DAY_S / 2.0)?.transits;
        let nearest = noon.iter().map(|noon| middle - noon).min_by(|a, b| a.abs().total_cmp(&b.abs()));
        offsets.extend(nearest.map(|seconds| seconds / 60.0));
    }
    if offsets.len() < MIN_DAYS {
        return Ok(None);
    }
    // the middle half: fog in the morning and storms in the evening are rare, and rows fall everywhere into the hour
    offsets.sort_by(f64::total_cmp);
    let quarter = offsets.len() / 4;
    let kept = &offsets[quarter..offsets.len() - quarter];
    let offset = kept.iter().sum::<f64>() / kept.len() as f64;
    if !WEATHER_CLOCK.is_exceeded_by(offset) {
        return Ok(None);
    }
    let minutes = rounded(offset, 0);
    let way = if offset < 0.0 { "before" } else { "after" };
    let text = format!(
        "the days of the weather lie {} minutes {way} those of the sun at its place: are its times the ends or the beginnings of intervals, or of another time zone? Radiation and sun do not belong together",
        minutes.abs()
    );
    Ok(Some(WEATHER_CLOCK.found(text).with("offset_min", minutes)))
}

/// The middle of the light of a day of rows in their order, seconds since 1970; `None` for a day without a night on
/// both sides.
fn middle_of_light(day: &[&WeatherStep]) -> Option<f64> {
    let light = |step: &WeatherStep| step.ghi.unwrap_or(step.dhi.unwrap_or(0.0) + step.dni.unwrap_or(0.0));
    let is_lit = |step: &&WeatherStep| light(step) > DAYLIGHT;
    let first = day.iter().position(is_lit)?;
    let last = day.iter().rposition(is_lit)?;
    let (before, after) = (day.get(first.checked_sub(1)?)?, day.get(last + 1)?);
    let is_next = |a: &WeatherStep, b: &WeatherStep| b.instant - a.instant <= NEXT * 3600.0 * a.hours;
    let (first, last) = (day.get(first)?, day.get(last)?);
    let half = |step: &WeatherStep| 1800.0 * step.hours;
    (is_next(before, first) && is_next(last, after))
        .then(|| f64::midpoint(first.instant - half(first), last.instant + half(last)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sun::sun_position;
    use belvedere_data::cast::to_u32;
    use belvedere_data::weather::{RowsHold, WeatherAir};

    /// Rows of so many hours on every fifth day of a year, under a clear sky and every third afternoon overcast, whose
    /// times are `late` minutes too late.
    fn weather(hours: f64, latitude_deg: f64, longitude_deg: f64, late: f64) -> Weather {
        let site = Site {
            latitude: latitude_deg.to_radians(),
            longitude: longitude_deg.to_radians(),
            height: 0.0,
            convergence: 0.0,
        };
        let start = 1_704_067_200.0;
        let count = to_u32(365.0 * 24.0 / hours);
        let middle = |i: u32| start + (f64::from(i) + 0.5) * hours * 3600.0;
        // by the sun, whose days begin up to half a day earlier or later
        let day = |i: &u32| (middle(*i) / DAY_S + site.longitude / std::f64::consts::TAU).floor();
        let step = |i: u32| {
            let middle = middle(i);
            // the mean of the interval
            let parts = [-0.4, -0.2, 0.0, 0.2, 0.4].map(|part| {
                let sun = sun_position(&site, middle + part * hours * 3600.0).unwrap();
                let is_overcast = (middle / DAY_S).floor() % 3.0 == 0.0 && sun.azimuth > std::f64::consts::PI;
                sun.elevation.sin().max(0.0) * if is_overcast { 200.0 } else { 900.0 }
            });
            WeatherStep {
                instant: middle + 60.0 * late,
                hours,
                month: 1,
                ghi: Some(parts.iter().sum::<f64>() / 5.0),
                dni: None,
                dhi: None,
                air: WeatherAir::default(),
            }
        };
        Weather {
            format: "EPW",
            latitude: site.latitude,
            longitude: site.longitude,
            height: 0.0,
            rows_hold: RowsHold::Means,
            utc_offset: 0.0,
            steps: (0..count).filter(|i| day(i) % 5.0 == 0.0).map(step).collect(),
            left_out_count: 0,
            notes: Vec::new(),
        }
    }

    #[test]
    fn rows_of_other_times_are_found_by_the_noon_of_the_sun() {
        for (hours, latitude, longitude) in
            [(1.0, 52.0, 4.4), (0.5, 52.0, 4.4), (0.5, -33.0, 151.2), (0.25, 35.0, -120.0)]
        {
            let found = |late: f64| clock_contradiction(&weather(hours, latitude, longitude, late)).unwrap();
            assert_eq!(found(0.0), None, "{hours} {latitude}");
            assert_eq!(found(5.0), None, "{hours} {latitude}");
            // half a row of half an hour or of an hour, and an hour of summer time
            for late in [15.0, -15.0, 30.0, -30.0, 60.0, -60.0] {
                let offset = found(late).unwrap_or_else(|| panic!("{hours} {latitude} {late}")).numbers[0].1;
                assert!((offset - late).abs() <= 4.0, "{hours} {latitude} {late}: {offset}");
            }
        }
        assert_eq!(clock_contradiction(&Weather { steps: Vec::new(), ..weather(1.0, 52.0, 4.4, 60.0) }).unwrap(), None);
    }
}
