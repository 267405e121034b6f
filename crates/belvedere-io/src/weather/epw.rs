//! EnergyPlus weather.

use super::lines::{DECIMAL_COMMAS, WeatherLine, WeatherLines, weather_at};
use belvedere_data::Result;
use belvedere_data::weather::{RowsHold, Weather, WeatherStep, unix_day};

/// Lines before the rows.
const HEAD: usize = 8;
/// Cells of a row.
const TEMPERATURE: usize = 6;
const HUMIDITY: usize = 8;
const SKY_LONGWAVE: usize = 12;
const GLOBAL: usize = 13;
const DIRECT: usize = 14;
const DIFFUSE: usize = 15;
const WIND: usize = 21;
/// Cells that a row has, and the line of the place. More are decimal commas.
const MAX_CELLS: usize = 35;
const PLACE_CELLS: usize = 10;

pub(super) fn read(lines: &WeatherLines<'_>) -> Result<Weather> {
    let place = lines.line(1)?;
    let mut cells = place.cells();
    while cells.last().is_some_and(|cell| cell.is_empty()) {
        cells.pop();
    }
    if cells.len() > PLACE_CELLS {
        let count = cells.len();
        return Err(place.wrong(&format!("has {count} cells, but LOCATION has {PLACE_CELLS}{DECIMAL_COMMAS}")));
    }
    let latitude = place.number_in(&cells, 6, "the latitude")?;
    let longitude = place.number_in(&cells, 7, "the longitude")?;
    let zone = place.number_in(&cells, 8, "the time zone")?;
    let height = place.number_in(&cells, 9, "the height")?;
    let periods = lines.line(HEAD)?;
    if !periods.text.starts_with("DATA PERIODS,") {
        return Err(periods.wrong("should begin with DATA PERIODS, as line 8 of every EPW file does"));
    }
    let per_hour = periods.whole_in(&periods.cells(), 2, "the number of records an hour")?;
    if !(1..=60).contains(&per_hour) {
        return Err(periods.wrong(&format!("{per_hour} records an hour, but must be 1 to 60")));
    }
    let mut weather = weather_at("EPW", [latitude, longitude], height, RowsHold::Means, zone);
    let mut first: Option<(usize, usize)> = None;
    for line in lines.all().skip(HEAD).filter(|line| !line.text.is_empty()) {
        let cells = line.cells();
        let (number, expected) = *first.get_or_insert((line.number, cells.len()));
        if cells.len() > MAX_CELLS {
            let count = cells.len();
            return Err(line.wrong(&format!("has {count} cells, but a row of EPW has {MAX_CELLS}{DECIMAL_COMMAS}")));
        }
        if cells.len() != expected {
            let count = cells.len();
            return Err(line.wrong(&format!("has {count} cells, but line {number} has {expected}{DECIMAL_COMMAS}")));
        }
        match step(&line, &cells, zone, per_hour)? {
            Some(step) => weather.steps.push(step),
            None => weather.left_out_count += 1,
        }
    }
    Ok(weather)
}

fn step(line: &WeatherLine<'_>, cells: &[&str], zone: f64, per_hour: i32) -> Result<Option<WeatherStep>> {
    let whole = |column: usize, name: &str| line.whole_in(cells, column, name);
    let day = line.day(whole(0, "the year")?, whole(1, "the month")?, whole(2, "the day")?)?;
    let (hour, minute) = (whole(3, "the hour")?, whole(4, "the minute")?);
    if !(1..=24).contains(&hour) || !(0..=60).contains(&minute) {
        return Err(line.wrong(&format!("hour {hour} and minute {minute}, but must be 1 to 24 and 0 to 60")));
    }
    let radiation = |column: usize, name: &str| line.radiation_in(cells, column, name);
    let (ghi, dni, dhi) = (
        radiation(GLOBAL, "global horizontal radiation")?,
        radiation(DIRECT, "direct normal radiation")?,
        radiation(DIFFUSE, "diffuse horizontal radiation")?,
    );
    if ghi.is_none() && dni.zip(dhi).is_none() {
        return Ok(None);
    }
    // a word in place of the temperature means that columns are shifted
    line.number_in(cells, TEMPERATURE, "the temperature")?;
    let air = WeatherLine::air(cells, [TEMPERATURE, HUMIDITY, WIND, SKY_LONGWAVE].map(Some));
    let hours = 1.0 / f64::from(per_hour);
    // with one record an hour programs write 0 or 60 for the minute, and mean the same
    let end = if per_hour == 1 { f64::from(hour) } else { f64::from(hour - 1) + f64::from(minute) / 60.0 };
    let instant = unix_day(day) as f64 * 86_400.0 + (end - 0.5 * hours - zone) * 3600.0;
    Ok(Some(WeatherStep { instant, hours, month: day.month, ghi, dni, dhi, air }))
}
