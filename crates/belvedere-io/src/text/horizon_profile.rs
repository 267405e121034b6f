//! Horizon profiles from files.

use crate::files::source::Source;
use belvedere_data::horizon::HorizonProfile;
use belvedere_data::{Error, Result};
use serde_json::Value;

/// Reads the horizon from a file of PVGIS (JSON, or the table with the columns A and H_hor), whose azimuths count from
/// south. Or from a table of azimuth and elevation, two columns, whose azimuths count clockwise from north, as those of
/// pvlib and of `belvedere horizon`. All are in degrees. Lines that are neither a header nor numbers are skipped before
/// the first row.
///
/// # Errors
/// [`Error::Io`]; [`Error::Malformed`] for files without a profile, and for numbers that [`HorizonProfile::of_degrees`]
/// refuses.
pub fn read_horizon<'a>(source: impl Into<Source<'a>>) -> Result<HorizonProfile> {
    let (name, bytes) = source.into().read_text()?;
    let text = String::from_utf8_lossy(&bytes).into_owned();
    let rows = if text.trim_start().starts_with('{') { of_json(&text) } else { of_table(&text) };
    let rows = rows.map_err(|what| Error::malformed(&name, what))?;
    HorizonProfile::of_degrees(&rows).map_err(|error| Error::malformed(&name, error.to_string()))
}

/// An azimuth of PVGIS, from south and positive to the west, from north.
fn from_south(azimuth: f64) -> f64 {
    azimuth + 180.0
}

fn of_json(text: &str) -> std::result::Result<Vec<[f64; 2]>, String> {
    let value: Value = serde_json::from_str(text).map_err(|error| format!("is not JSON: {error}"))?;
    let rows = value.pointer("/outputs/horizon_profile").and_then(Value::as_array);
    let rows = rows.ok_or("has no outputs.horizon_profile; download the horizon of PVGIS (printhorizon)")?;
    let number = |row: &Value, key: &str| row.get(key).and_then(Value::as_f64);
    let row = |(i, row): (usize, &Value)| match (number(row, "A"), number(row, "H_hor")) {
        (Some(azimuth), Some(elevation)) => Ok([from_south(azimuth), elevation]),
        _ => Err(format!("row {} of the horizon lacks A or H_hor", i + 1)),
    };
    rows.iter().enumerate().map(row).collect()
}

fn of_table(text: &str) -> std::result::Result<Vec<[f64; 2]>, String> {
    let mut counts_from_south = false;
    let mut rows = Vec::new();
    for (i, line) in text.lines().enumerate() {
        let cells: Vec<&str> = line.split([',', ';', '\t']).map(str::trim).filter(|cell| !cell.is_empty()).collect();
        match (&cells[..], cells.iter().map(|cell| cell.parse::<f64>()).collect::<std::result::Result<Vec<_>, _>>()) {
            (["A", "H_hor", ..], _) => counts_from_south = true,
            (_, Ok(numbers)) if counts_from_south && numbers.len() >= 2 => {
                rows.push([from_south(numbers[0]), numbers[1]]);
            }
            (_, Ok(numbers)) if numbers.len() == 2 => rows.push([numbers[0], numbers[1]]),
            (_, Ok(numbers)) if numbers.len() > 2 => {
                return Err(format!("line {} has {} columns; keep azimuth and elevation", i + 1, numbers.len()));
            }
            // remarks of PVGIS stand below its table too
            (cells, _) if rows.is_empty() || cells.is_empty() || counts_from_south => {}
            _ => return Err(format!("line {} is not an azimuth and an elevation: {line}", i + 1)),
        }
    }
    if rows.is_empty() {
        return Err("has no rows of azimuth and elevation, in degrees".to_owned());
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn elevation(text: &str, azimuth_deg: f64) -> f64 {
        let profile = read_horizon(Source::bytes("horizon.csv", text.as_bytes())).unwrap();
        profile.elevation_at(azimuth_deg.to_radians()).to_degrees()
    }

    #[test]
    fn azimuths_of_pvgis_count_from_south_and_others_from_north() {
        let json = r#"{"outputs": {"horizon_profile": [{"A": -90.0, "H_hor": 4.0}, {"A": 0.0, "H_hor": 12.5}, {"A": 90.0, "H_hor": 1.0}]}}"#;
        let table = "Latitude (decimal degrees):\t45.0\nLongitude (decimal degrees):\t8.0\n\nA\tH_hor\tA_sun(w)\tH_sun(w)\n-90.0\t4.0\t-50.0\t0.0\n0.0\t12.5\t0.0\t20.0\n90.0\t1.0\t50.0\t0.0\n\nA: Azimuth (0 = S, 90 = W, -90 = E) (degree)\nPVGIS (c) European Union\n";
        for text in [json, table] {
            for (azimuth, expected) in [(90.0, 4.0), (180.0, 12.5), (270.0, 1.0)] {
                assert!((elevation(text, azimuth) - expected).abs() < 1e-9, "{azimuth} {text}");
            }
        }
        let plain = "azimuth,elevation\n0,3.0\n90,4\n180;12.5\n270,1\n";
        for (azimuth, expected) in [(0.0, 3.0), (90.0, 4.0), (180.0, 12.5), (270.0, 1.0), (315.0, 2.0)] {
            assert!((elevation(plain, azimuth) - expected).abs() < 1e-9, "{azimuth}");
        }
        for wrong in ["", "azimuth,elevation\n", "0,95\n", "0,1,2\n", "0,1\nx,y\n", "{}", "{\"outputs\": 1}", "0,nan\n"]
        {
            let error = read_horizon(Source::bytes("horizon.csv", wrong.as_bytes())).unwrap_err().to_string();
            assert!(error.contains("horizon.csv"), "{wrong}: {error}");
        }
    }
}
