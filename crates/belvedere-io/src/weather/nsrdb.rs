//! Series and typical years of the National Solar Radiation Database.

use super::lines::{WeatherLine, WeatherLines, weather_at};
use belvedere_data::Result;
use belvedere_data::weather::{RowsHold, Weather, WeatherStep, unix_day};

/// Steps that the database has, hours: where a file has a single row, the usual.
const USUAL_STEP: f64 = 1.0;

pub(super) fn read(lines: &WeatherLines<'_>) -> Result<Weather> {
    let (names, values, head) = (lines.line(1)?, lines.line(2)?, lines.line(3)?);
    let (names, cells, mut columns) = (names.cells(), values.cells(), head.cells());
    while columns.last().is_some_and(|name| name.is_empty()) {
        columns.pop();
    }
    let of_place = |name: &str| {
        let column = names.iter().position(|own| own.eq_ignore_ascii_case(name));
        let column = column.ok_or_else(|| values.wrong(&format!("the line above does not name {name}")))?;
        values.number_in(&cells, column, name)
    };
    let (latitude, longitude) = (of_place("Latitude")?, of_place("Longitude")?);
    let (height, zone) = (of_place("Elevation")?, of_place("Time Zone")?);
    let column = |name: &str| columns.iter().position(|own| own.eq_ignore_ascii_case(name));
    let needed = |name: &str| column(name).ok_or_else(|| head.wrong(&format!("there is no column {name}")));
    let [year, month, day, hour, minute, global] =
        [needed("Year")?, needed("Month")?, needed("Day")?, needed("Hour")?, needed("Minute")?, needed("GHI")?];
    let (direct, diffuse) = (column("DNI"), column("DHI"));
    let air = [column("Temperature"), column("Relative Humidity"), column("Wind Speed"), None];
    let mut weather = weather_at("NSRDB", [latitude, longitude], height, RowsHold::Instants, zone);
    // minutes of the day of all rows: their step is the least between two that follow each other
    let mut min_step = f64::INFINITY;
    let mut before: Option<f64> = None;
    for line in lines.all().skip(3).filter(|line| !line.text.trim_matches(',').is_empty()) {
        let cells = line.row_of(&columns)?;
        let whole = |column: usize, name: &str| line.whole_in(&cells, column, name);
        let date = line.day(whole(year, "Year")?, whole(month, "Month")?, whole(day, "Day")?)?;
        let (hour, minute) = (whole(hour, "Hour")?, whole(minute, "Minute")?);
        if !(0..24).contains(&hour) || !(0..60).contains(&minute) {
            return Err(line.wrong(&format!("hour {hour} and minute {minute}, but must be 0 to 23 and 0 to 59")));
        }
        let local = unix_day(date) as f64 * 86_400.0 + f64::from(hour * 60 + minute) * 60.0;
        if let Some(step) = before.map(|before| local - before).filter(|step| *step > 0.0) {
            min_step = min_step.min(step / 3600.0);
        }
        before = Some(local);
        let radiation = |column: usize, name: &str| line.radiation_in(&cells, column, name);
        let optional = |column: Option<usize>, name: &str| match column {
            Some(column) => radiation(column, name),
            None => Ok(None),
        };
        let (dni, dhi) = (optional(direct, "DNI")?, optional(diffuse, "DHI")?);
        let ghi = radiation(global, "GHI")?;
        if ghi.is_none() && dni.zip(dhi).is_none() {
            weather.left_out_count += 1;
            continue;
        }
        let instant = local - zone * 3600.0;
        let air = WeatherLine::air(&cells, air);
        weather.steps.push(WeatherStep { instant, hours: USUAL_STEP, month: date.month, ghi, dni, dhi, air });
    }
    if min_step <= 24.0 {
        weather.steps.iter_mut().for_each(|step| step.hours = min_step);
    }
    Ok(weather)
}
