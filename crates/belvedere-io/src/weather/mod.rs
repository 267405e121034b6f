//! Weather files: EPW, PVGIS, TMY3 and NSRDB. The format is found from the content.
//!
//! | format | time of a row | the sun that goes with it |
//! |---|---|---|
//! | EPW | hour 1 to 24 of local standard time, the end of its interval | the middle of the interval |
//! | TMY3 | 01:00 to 24:00 of local standard time, the end of its interval | the middle of the interval |
//! | PVGIS, typical year | UTC, plus an offset in the head | that instant |
//! | PVGIS, series | UTC with minutes | that instant |
//! | NSRDB | local standard time or UTC with minutes | that instant |

mod epw;
mod lines;
mod nsrdb;
mod pvgis;
mod tmy3;

use crate::files::source::{Input, Source};
use belvedere_data::weather::{Weather, WeatherStep};
use belvedere_data::{Error, Result};
use lines::WeatherLines;
use std::io::Read;

/// Larger files are no weather: a year in steps of a minute has 50 MB.
const MAX_BYTES: u64 = 500_000_000;

/// Reads the radiation of a weather file. Its rows keep their own years, of which a typical year has several.
///
/// Values missing in a row, or marked as missing, stay missing if other columns replace them, which the notes count.
/// Rows with neither global radiation, nor direct and diffuse radiation, are left out and counted. Values below zero
/// that are noise of sensors at night, down to −20 W/m², count as zero.
///
/// # Errors
/// - [`Error::Io`].
/// - [`Error::Malformed`], which names the line, for files of another kind, columns that are missing, dates that do not
///   exist, and text in place of numbers. Also for radiation beyond 3000 W/m² or below −20, series of PVGIS on tilted
///   planes, and files without rows.
///
/// # Source
/// - EnergyPlus, Auxiliary Programs, "EnergyPlus Weather File (EPW) Data Dictionary".
/// - Wilcox & Marion 2008, User's manual for TMY3 data sets.
/// - PVGIS user manual, sections 4 and 6.
/// - NSRDB, "PSM v3 and v4 CSV".
pub fn read_weather<'a>(source: impl Into<Source<'a>>) -> Result<Weather> {
    let Input { name, mut reader, size } = source.into().open_text()?;
    let path = name.as_path();
    if size > MAX_BYTES {
        return Err(Error::malformed(path, format!("{size} bytes are too many for a weather file")));
    }
    let mut bytes = Vec::new();
    reader.read_to_end(&mut bytes).map_err(Error::io(path))?;
    // station names are in any encoding; figures are not
    let text = String::from_utf8_lossy(&bytes);
    let text = text.trim_start_matches('\u{feff}');
    let lines = WeatherLines::new(path, text);
    let first = text.lines().next().unwrap_or("");
    let second = text.lines().nth(1).unwrap_or("");
    let mut weather = if first.starts_with("LOCATION,") {
        epw::read(&lines)?
    } else if first.trim_start().starts_with("Latitude") {
        pvgis::read(&lines)?
    } else if second.contains("Date (MM/DD/YYYY)") {
        tmy3::read(&lines)?
    } else if first.starts_with("Source,") {
        nsrdb::read(&lines)?
    } else if first.starts_with("LOCATION;") {
        return Err(Error::malformed(
            path,
            "is EPW with semicolons, as a spreadsheet saves it; EPW has commas and decimal points",
        ));
    } else {
        let what = "not a known weather file: EPW begins with LOCATION, PVGIS (as CSV) with Latitude, NSRDB with Source, and TMY3 has \
                    Date (MM/DD/YYYY) in its second line";
        return Err(Error::malformed(path, what));
    };
    weather.notes.extend(missing_values(&weather));
    weather.validate().map_err(|error| Error::malformed(path, error.to_string()))?;
    Ok(weather)
}

/// Notes on rows without values that other rows of the file have.
fn missing_values(weather: &Weather) -> Vec<String> {
    let note = |name: &str, follows_from: &str, value: fn(&WeatherStep) -> Option<f64>| {
        let missing = weather.steps.iter().filter(|step| value(step).is_none()).count();
        // every row of EPW has a cell for it; other formats may have no column
        let is_meant = missing < weather.steps.len() || weather.format == "EPW";
        let all = weather.steps.len();
        (missing > 0 && is_meant)
            .then(|| format!("{missing} of {all} rows have no {name}; it follows from {follows_from}"))
    };
    let notes = [
        note("global radiation", "direct and diffuse radiation and the height of the sun", |step| step.ghi),
        note("direct radiation", "global and diffuse radiation and the height of the sun", |step| step.dni),
        note("diffuse radiation", "global and direct radiation and the height of the sun", |step| step.dhi),
    ];
    notes.into_iter().flatten().collect()
}
