//! Sun calendars as tables and as appointments.

use crate::apps::ask::SunCalendarResults;
use crate::apps::result_columns::ResultColumn;
use crate::apps::sun::Date;
use crate::apps::sun_calendar::{SunObstacle, SunStretch};
use crate::io::{atomic, write_table};
use crate::{Error, Result};
use std::io::Write as _;
use std::path::Path;

/// Minimum duration of an appointment, hours.
const MIN_APPOINTMENT: f32 = 5.0 / 60.0;
/// Maximum length of a line of iCalendar, bytes (RFC 5545, section 3.1).
const MAX_LINE: usize = 75;

/// Writes sun calendars in the format of the extension: a table with a row for each stretch (.csv), or appointments of
/// sun and shade (.ics, iCalendar, RFC 5545). `names` are those of the places; the others have their number.
///
/// # Errors
/// [`Error::Io`], and those of instants for dates that clocks do not have.
pub fn write_calendar(path: &Path, found: &SunCalendarResults, names: &[String]) -> Result<()> {
    match path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("ics")) {
        true => write_appointments(path, found, names),
        false => write_rows(path, found, names),
    }
}

fn name_of(place: usize, found: &SunCalendarResults, names: &[String]) -> String {
    let kind = if found.windows.is_empty() { "place" } else { "window" };
    let own = names.get(place).filter(|name| !name.is_empty()).cloned();
    own.unwrap_or_else(|| format!("{kind} {}", place + 1))
}

fn write_rows(path: &Path, found: &SunCalendarResults, names: &[String]) -> Result<()> {
    let rows: Vec<(usize, Date, &SunStretch)> = found.stretches().collect();
    let real = |name: &str, of: &dyn Fn(&SunStretch) -> f32| {
        ResultColumn::real(name, rows.iter().map(|(.., stretch)| f64::from(of(stretch))), 3)
    };
    let clock = |name: &str, of: &dyn Fn(&SunStretch) -> f32| {
        ResultColumn::clock(name, rows.iter().map(|(.., stretch)| f64::from(of(stretch))))
    };
    let obstacles = || rows.iter().map(|(.., stretch)| stretch.obstacle);
    let place = if found.windows.is_empty() { "place" } else { "window" };
    write_table(
        path,
        &[
            ResultColumn::whole(place, rows.iter().map(|(place, ..)| place + 1)),
            ResultColumn::words("name", rows.iter().map(|(place, ..)| name_of(*place, found, names))),
            ResultColumn::words("date", rows.iter().map(|(_, date, _)| date.to_string())),
            clock("from", &|stretch| stretch.start),
            clock("to", &|stretch| stretch.end),
            real("hours", &SunStretch::hours),
            ResultColumn::words("state", obstacles().map(SunObstacle::name)),
            ResultColumn::words("object", obstacles().map(|obstacle| found.mesh_name(obstacle).unwrap_or_default())),
            real("unproven_hours", &|stretch| stretch.unproven),
        ],
    )
}

fn write_appointments(path: &Path, found: &SunCalendarResults, names: &[String]) -> Result<()> {
    let mut text = String::new();
    let mut line = |content: &str| fold(&mut text, content);
    line("BEGIN:VCALENDAR");
    line("VERSION:2.0");
    line("PRODID:-//Belvedere//sun calendar//EN");
    let kept = found
        .stretches()
        .filter(|(.., stretch)| stretch.hours() >= MIN_APPOINTMENT && stretch.obstacle != SunObstacle::OwnWall);
    for (number, (place, date, stretch)) in kept.enumerate() {
        let instant = |hours: f32| found.zone.instant_of(date, hours.into()).map(utc);
        let (start, end) = (instant(stretch.start)?, instant(stretch.end)?);
        let name = name_of(place, found, names);
        let what = match stretch.obstacle {
            SunObstacle::None => format!("Sun: {name}"),
            obstacle => format!("Shade of {}: {name}", found.mesh_name(obstacle).unwrap_or(obstacle.name())),
        };
        line("BEGIN:VEVENT");
        line(&format!("UID:{start}-{}-{number}@belvedere", place + 1));
        // the same file for the same question
        line(&format!("DTSTAMP:{start}"));
        line(&format!("DTSTART:{start}"));
        line(&format!("DTEND:{end}"));
        line(&format!("SUMMARY:{}", escaped(&what)));
        line("TRANSP:TRANSPARENT");
        line("END:VEVENT");
    }
    line("END:VCALENDAR");
    atomic::write(path, |output| output.write_all(text.as_bytes()).map_err(Error::io(path)))
}

/// An instant as iCalendar has it: 20260321T083000Z, to the minute.
fn utc(unix_s: f64) -> String {
    let to_minute = (unix_s / 60.0).round() * 60.0;
    let text: String = crate::apps::sun::Zone::utc().display(to_minute).chars().filter(char::is_ascii_digit).collect();
    let (date, time) = text.split_at(text.len().min(8));
    format!("{date}T{:0<6}Z", time.chars().take(6).collect::<String>())
}

fn escaped(text: &str) -> String {
    text.replace('\\', "\\\\").replace(';', "\\;").replace(',', "\\,").replace(['\n', '\r'], " ")
}

/// Adds a line, cut into pieces of [`MAX_LINE`] bytes that go on after a blank.
fn fold(text: &mut String, content: &str) {
    let mut length = 0;
    for character in content.chars() {
        if length + character.len_utf8() > MAX_LINE {
            text.push_str("\r\n ");
            length = 1;
        }
        text.push(character);
        length += character.len_utf8();
    }
    text.push_str("\r\n");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn instants_are_minutes_of_utc() {
        assert_eq!(utc(1_774_081_800.0), "20260321T083000Z");
    }

    #[test]
    fn long_lines_are_folded() {
        let mut text = String::new();
        fold(&mut text, &"ü".repeat(60));
        let lines: Vec<&str> = text.split("\r\n").collect();
        assert!(lines.iter().all(|line| line.len() <= MAX_LINE), "{lines:?}");
        assert_eq!(text.replace("\r\n ", "").trim_end(), "ü".repeat(60));
    }
}
