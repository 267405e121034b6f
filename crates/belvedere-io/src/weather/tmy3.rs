//! Typical years of the National Renewable Energy Laboratory, third edition.

use super::lines::{WeatherLine, WeatherLines, weather_at};
use belvedere_data::Result;
use belvedere_data::weather::{RowsHold, Weather, WeatherStep, unix_day};

pub(super) fn read(lines: &WeatherLines<'_>) -> Result<Weather> {
    let place = lines.line(1)?;
    let cells = place.cells();
    let zone = place.number_in(&cells, 3, "the time zone")?;
    let latitude = place.number_in(&cells, 4, "the latitude")?;
    let longitude = place.number_in(&cells, 5, "the longitude")?;
    let height = place.number_in(&cells, 6, "the height")?;
    let head = lines.line(2)?;
    let names = head.cells();
    let column = |name: &str| names.iter().position(|own| own.eq_ignore_ascii_case(name));
    let needed = |name: &str| column(name).ok_or_else(|| head.wrong(&format!("there is no column {name}")));
    let (date, time, global) = (needed("Date (MM/DD/YYYY)")?, needed("Time (HH:MM)")?, needed("GHI (W/m^2)")?);
    let (direct, diffuse) = (column("DNI (W/m^2)"), column("DHI (W/m^2)"));
    let air = [column("Dry-bulb (C)"), column("RHum (%)"), column("Wspd (m/s)"), None];
    let mut weather = weather_at("TMY3", [latitude, longitude], height, RowsHold::Means, zone);
    for line in lines.all().skip(2).filter(|line| !line.text.is_empty()) {
        let cells = line.row_of(&names)?;
        let text = |column: usize| cells.get(column).copied().unwrap_or_default();
        let date: Vec<&str> = text(date).split('/').collect();
        let whole = |column: usize| line.whole_in(&date, column, "a part of the date MM/DD/YYYY");
        let day = line.day(whole(2)?, whole(0)?, whole(1)?)?;
        let clock: Vec<&str> = text(time).split(':').collect();
        let part = |column: usize| line.whole_in(&clock, column, "a part of the time HH:MM");
        let (hour, minute) = (part(0)?, part(1)?);
        if !(0..=24).contains(&hour) || !(0..60).contains(&minute) {
            return Err(line.wrong(&format!("the time is {hour}:{minute:02}, but must be 00:00 to 24:00")));
        }
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
        let air = WeatherLine::air(&cells, air);
        let middle = f64::from(hour) + f64::from(minute) / 60.0 - 0.5 - zone;
        let instant = unix_day(day) as f64 * 86_400.0 + middle * 3600.0;
        weather.steps.push(WeatherStep { instant, hours: 1.0, month: day.month, ghi, dni, dhi, air });
    }
    Ok(weather)
}
