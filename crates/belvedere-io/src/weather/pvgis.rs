//! Typical years and series of the Photovoltaic Geographical Information System.

use super::lines::{WeatherLine, WeatherLines, shortened, weather_at};
use belvedere_data::Result;
use belvedere_data::weather::{RowsHold, Weather, WeatherStep, unix_day};

/// Lines among which the head of the table must be.
const MAX_HEAD_LINES: usize = 60;

/// Header above the table.
#[derive(Default)]
struct Head {
    latitude: Option<f64>,
    longitude: Option<f64>,
    height: f64,
    /// Hours from the time of a row to the instant of its radiation.
    offset: f64,
    slope_deg: f64,
    is_tracking: bool,
}

/// Columns of radiation.
#[derive(Clone, Copy)]
enum RadiationColumns {
    /// Global, direct and diffuse of a typical year.
    Typical([usize; 3]),
    /// Direct, diffuse and reflected of a series on a level plane.
    Parts([usize; 3]),
    /// Global of a series on a level plane.
    Global(usize),
}

pub(super) fn read(lines: &WeatherLines<'_>) -> Result<Weather> {
    let mut head = Head::default();
    let Some(names) = lines.all().take(MAX_HEAD_LINES).find(|line| line.text.starts_with("time")) else {
        return Err(lines
            .line(1)?
            .wrong("no line below begins with \"time\", as the header of the table does; use the CSV of PVGIS"));
    };
    for line in lines.all().take(names.number - 1) {
        read_head(&line, &mut head)?;
    }
    let missing = |what: &str| names.wrong(&format!("there is no line \"{what} (decimal degrees): …\" above"));
    let latitude = head.latitude.ok_or_else(|| missing("Latitude"))?;
    let longitude = head.longitude.ok_or_else(|| missing("Longitude"))?;
    let columns = names.cells();
    let column = |name: &str| columns.iter().position(|own| *own == name);
    let three = |names: [&str; 3]| match names.map(column) {
        [Some(a), Some(b), Some(c)] => Some([a, b, c]),
        _ => None,
    };
    let is_series = head.slope_deg != 0.0 || head.is_tracking;
    let found = if let Some(typical) = three(["G(h)", "Gb(n)", "Gd(h)"]) {
        RadiationColumns::Typical(typical)
    } else if is_series {
        let what = format!(
            "the series is that of a plane tilted by {} degrees{}; get one of slope 0 from PVGIS; it gives the radiation of any plane",
            head.slope_deg,
            if head.is_tracking { " or following the sun" } else { "" }
        );
        return Err(names.wrong(&what));
    } else if let Some(parts) = three(["Gb(i)", "Gd(i)", "Gr(i)"]) {
        RadiationColumns::Parts(parts)
    } else if let Some(global) = column("G(i)") {
        RadiationColumns::Global(global)
    } else {
        let what = format!("no radiation among the columns {}", shortened(names.text));
        return Err(names.wrong(&what));
    };
    let air = ["T2m", "RH", "WS10m", "IR(h)"].map(column);
    let mut weather = weather_at(
        if matches!(found, RadiationColumns::Typical(_)) { "PVGIS, typical year" } else { "PVGIS, series" },
        [latitude, longitude],
        head.height,
        RowsHold::Instants,
        0.0,
    );
    let is_row = |line: &WeatherLine<'_>| line.text.starts_with(|c: char| c.is_ascii_digit());
    for line in lines.all().skip(names.number).take_while(is_row) {
        match step(&line, &columns, found, air, head.offset)? {
            Some(step) => weather.steps.push(step),
            None => weather.left_out_count += 1,
        }
    }
    Ok(weather)
}

fn read_head(line: &WeatherLine<'_>, head: &mut Head) -> Result<()> {
    let Some((name, value)) = line.text.split_once(':') else { return Ok(()) };
    let (name, value) = (name.trim(), value.trim());
    let number = || line.number_in(&[value.split_whitespace().next().unwrap_or_default()], 0, name);
    match name {
        "Latitude (decimal degrees)" => head.latitude = Some(number()?),
        "Longitude (decimal degrees)" => head.longitude = Some(number()?),
        "Elevation (m)" => head.height = number()?,
        "Irradiance Time Offset (h)" => {
            head.offset = number()?;
            if head.offset.abs() > 1.0 {
                return Err(line.wrong(&format!("an offset of {} hours, but must be -1 to 1", head.offset)));
            }
        }
        // "0 deg. " or "35 deg. (optimum)"; two planes make a table that is none of ours
        "Slope" => head.slope_deg = number()?,
        _ if name.ends_with("axis") || value.contains("axis") => head.is_tracking = true,
        _ => {}
    }
    Ok(())
}

fn step(
    line: &WeatherLine<'_>,
    names: &[&str],
    columns: RadiationColumns,
    air: [Option<usize>; 4],
    offset: f64,
) -> Result<Option<WeatherStep>> {
    let cells = line.row_of(names)?;
    let time = cells.first().copied().unwrap_or_default();
    let digits = |from: usize, to: usize| time.get(from..to).and_then(|part| part.parse::<i32>().ok());
    let (Some(year), Some(month), Some(day), Some(":"), Some(hour), Some(minute)) =
        (digits(0, 4), digits(4, 6), digits(6, 8), time.get(8..9), digits(9, 11), digits(11, 13))
    else {
        return Err(line.wrong(&format!("the time is \"{}\", but must be like 20200131:0010", shortened(time))));
    };
    let date = line.day(year, month, day)?;
    if !(0..24).contains(&hour) || !(0..60).contains(&minute) {
        return Err(line.wrong(&format!("the time is {hour}:{minute:02}, but must be 00:00 to 23:59")));
    }
    let radiation = |column: usize, name: &str| line.radiation_in(&cells, column, name);
    let (ghi, dni, dhi) = match columns {
        RadiationColumns::Typical([ghi, dni, dhi]) => {
            (radiation(ghi, "G(h)")?, radiation(dni, "Gb(n)")?, radiation(dhi, "Gd(h)")?)
        }
        RadiationColumns::Parts([beam, diffuse, reflected]) => {
            let (beam, diffuse) = (radiation(beam, "Gb(i)")?, radiation(diffuse, "Gd(i)")?);
            let reflected = radiation(reflected, "Gr(i)")?.unwrap_or(0.0);
            let ghi = beam.zip(diffuse).map(|(beam, diffuse)| beam + diffuse + reflected);
            // towards the sun it follows from the sun's height
            (ghi, None, diffuse)
        }
        RadiationColumns::Global(global) => (radiation(global, "G(i)")?, None, None),
    };
    if ghi.is_none() && dni.zip(dhi).is_none() {
        return Ok(None);
    }
    let air = WeatherLine::air(&cells, air);
    let clock = f64::from(hour) + f64::from(minute) / 60.0 + offset;
    let instant = unix_day(date) as f64 * 86_400.0 + clock * 3600.0;
    Ok(Some(WeatherStep { instant, hours: 1.0, month: date.month, ghi, dni, dhi, air }))
}
