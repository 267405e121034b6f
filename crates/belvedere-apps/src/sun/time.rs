//! Instants, dates and zones as people write them, by the crate `jiff` and the zones it holds: no file of the system is
//! read.

use super::Site;
use belvedere_data::cast::{to_i32, to_i64};
use belvedere_data::{Error, Parameter, Result};
use jiff::civil::DateTime;
use jiff::fmt::temporal::{Pieces, PiecesOffset};
use jiff::tz::{AmbiguousOffset, Offset, TimeZone, TimeZoneDatabase};
use jiff::{Timestamp, ToSpan};
use std::fmt;
use std::ops::Range;

/// Years of dates and times.
const YEARS: Range<i16> = 1000..3000;

const MEAN_SOLAR: &str = "mean solar time";

/// Time zone of a place.
#[derive(Clone, Debug, PartialEq)]
pub struct Zone {
    zone: TimeZone,
    name: String,
}

impl Zone {
    /// The clock of UTC.
    #[must_use]
    pub fn utc() -> Self {
        Self { zone: TimeZone::UTC, name: "UTC".to_owned() }
    }

    /// A zone by its name, such as "Europe/Amsterdam", or an offset from UTC, such as "+02:00"; "Z" is UTC.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a text that is neither.
    pub fn parse(text: &str) -> Result<Self> {
        let text = text.trim();
        if text.eq_ignore_ascii_case("z") || text.eq_ignore_ascii_case("utc") {
            return Ok(Self::utc());
        }
        let zone = if text.starts_with(['+', '-']) {
            offset(text).map(TimeZone::fixed)
        } else {
            TimeZoneDatabase::bundled().get(text).ok()
        };
        let Some(zone) = zone else {
            let expected = "a name such as Europe/Amsterdam, or an offset such as +02:00";
            return Err(Error::invalid(Parameter::TimeZone, shortened(text), expected));
        };
        let name = zone.iana_name().unwrap_or(text).to_owned();
        Ok(Self { zone, name })
    }

    /// The mean solar time of a site: 4 minutes a degree of longitude from UTC, to the second.
    #[must_use]
    pub fn mean_solar(site: &Site) -> Self {
        let seconds = to_i32((site.longitude.to_degrees() * 240.0).round());
        let offset = Offset::from_seconds(seconds).unwrap_or(Offset::UTC);
        Self { zone: TimeZone::fixed(offset), name: MEAN_SOLAR.to_owned() }
    }

    /// Returns true for mean solar time, which no clock shows.
    #[must_use]
    pub fn is_mean_solar(&self) -> bool {
        self.name == MEAN_SOLAR
    }

    /// Returns its name: that of the zone database, an offset, or "mean solar time".
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the offset of its clocks from UTC at an instant, seconds; 0 for instants that no calendar holds.
    #[must_use]
    pub fn offset_at(&self, unix_s: f64) -> f64 {
        timestamp(unix_s).map_or(0.0, |t| f64::from(self.zone.to_offset(t).seconds()))
    }

    /// An instant as its clocks and calendar show it, to the second, with the offset: "2026-06-21T12:00:00+02:00";
    /// empty for instants that no calendar holds.
    #[must_use]
    pub fn display(&self, unix_s: f64) -> String {
        let Some(t) = timestamp(unix_s.round()) else { return String::new() };
        let offset = self.zone.to_offset(t);
        let seconds = offset.seconds();
        let [hours, minutes, rest] = [seconds.abs() / 3600, seconds.abs() / 60 % 60, seconds.abs() % 60];
        let sign = if seconds < 0 { '-' } else { '+' };
        let rest = if rest == 0 { String::new() } else { format!(":{rest:02}") };
        format!("{}{sign}{hours:02}:{minutes:02}{rest}", offset.to_datetime(t))
    }

    /// The date that its calendar shows at an instant.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for instants that no calendar holds.
    pub fn date_at(&self, unix_s: f64) -> Result<Date> {
        let t =
            timestamp(unix_s).ok_or_else(|| Error::invalid(Parameter::Instant, unix_s, "in the years 1000 to 3000"))?;
        Ok(Date(self.zone.to_datetime(t).date()))
    }

    /// Returns the instant at which its clocks show an hour of a date. Hours are added to the midnight of the calendar,
    /// as clocks show them in summer time or not. If clocks skip the hour, the result is that hour by the time before;
    /// if they show it twice, the first.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for an hour that is not from −48 to 48, and at the end of the calendar.
    pub fn instant_of(&self, date: Date, hour: f64) -> Result<f64> {
        let failed = || {
            Error::invalid(Parameter::HoursOfDay, format!("{hour} on {date}"), "-48 to 48, in the years 1000 to 3000")
        };
        if !(hour.abs() <= 48.0) {
            return Err(failed());
        }
        let milliseconds = to_i64((hour * 3.6e6).round());
        let shown = date.0.to_datetime(jiff::civil::Time::midnight()).checked_add(milliseconds.milliseconds());
        let instant = shown.and_then(|shown| self.zone.to_ambiguous_timestamp(shown).compatible());
        instant.map(seconds).map_err(|_| failed())
    }
}

/// A day of the Gregorian calendar.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Date(jiff::civil::Date);

impl Date {
    /// A date by year, month and day of the month.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for days that do not exist, and years outside 1000 to 3000.
    pub fn new(year: i16, month: i8, day: i8) -> Result<Self> {
        if !YEARS.contains(&year) {
            return Err(Error::invalid(Parameter::Year, year, "1000 to 2999"));
        }
        Self::checked(jiff::civil::Date::new(year, month, day).ok(), &format!("{year:04}-{month:02}-{day:02}"))
    }

    /// A date written as 2026-06-21.
    ///
    /// # Errors
    /// As [`Date::new`], and for other writings.
    pub fn parse(text: &str) -> Result<Self> {
        let text = text.trim();
        // the crate would take the date of an instant too
        let is_plain = text.len() == 10 && text.bytes().all(|b| b.is_ascii_digit() || b == b'-');
        Self::checked(text.parse().ok().filter(|_| is_plain), text)
    }

    fn checked(date: Option<jiff::civil::Date>, text: &str) -> Result<Self> {
        date.filter(|date| YEARS.contains(&date.year())).map(Self).ok_or_else(|| {
            Error::invalid(Parameter::Date, shortened(text), "a day such as 2026-06-21, in the years 1000 to 2999")
        })
    }

    /// Year.
    #[must_use]
    pub fn year(self) -> i16 {
        self.0.year()
    }

    /// Month, 1 to 12.
    #[must_use]
    pub fn month(self) -> i8 {
        self.0.month()
    }

    /// Day of the year, 1 to 366.
    #[must_use]
    pub fn day_of_year(self) -> u32 {
        u32::from(self.0.day_of_year().unsigned_abs())
    }

    /// Day of the month, 1 to 31.
    #[must_use]
    pub fn day(self) -> i8 {
        self.0.day()
    }

    /// Midday of this date on a clock of UTC, seconds since 1970.
    #[must_use]
    pub fn noon_utc(self) -> f64 {
        Offset::UTC.to_timestamp(self.0.at(12, 0, 0, 0)).map_or(0.0, seconds)
    }

    /// All dates from this one to `last`, both counted; none where `last` is earlier.
    pub fn to(self, last: Self) -> impl Iterator<Item = Self> {
        self.0.series(1.day()).take_while(move |&date| date <= last.0).map(Self)
    }
}

impl fmt::Display for Date {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

/// An instant written by ISO 8601, as seconds of UTC since 1970: "2026-06-21T12:00+02:00", "2026-06-21T10:00Z",
/// "2026-06-21T12:00[Europe/Amsterdam]", or with neither where a `zone` is given. A blank may replace the T, seconds
/// may have a fraction, and a leap second 23:59:60 counts as the second before it, as UTC since 1970 has none.
///
/// # Errors
/// [`Error::InvalidParameter`] for text that is no instant, and for times without zone or offset if `zone` is `None`.
/// Also if offset and named zone contradict each other, and for times that clocks skip or show twice when summer time
/// begins or ends; an offset resolves these.
pub fn parse_instant(text: &str, zone: Option<&Zone>) -> Result<f64> {
    let text = text.trim();
    let invalid = |expected| Error::invalid(Parameter::Time, shortened(text), expected);
    const WRITING: &str =
        "written as 2026-06-21T12:00+02:00, with a zone as 2026-06-21T12:00[Europe/Amsterdam], or with --zone";
    let pieces = Pieces::parse(text).map_err(|_| match Date::parse(text.get(..10).unwrap_or_default()) {
        Err(_) if is_like_date(text) => invalid("on a day of the calendar, in the years 1000 to 2999"),
        _ => invalid(WRITING),
    })?;
    let shown = DateTime::from_parts(pieces.date(), pieces.time().ok_or_else(|| invalid(WRITING))?);
    if !YEARS.contains(&shown.year()) {
        return Err(invalid("in the years 1000 to 2999"));
    }
    let named = pieces
        .to_time_zone_with(&TimeZoneDatabase::bundled())
        .map_err(|_| invalid("in a zone that is known, such as Europe/Amsterdam"))?;
    let named = if pieces.time_zone_annotation().is_some() { named } else { None };
    let offset = match pieces.offset() {
        Some(PiecesOffset::Zulu) => Some(Offset::UTC),
        Some(other) => Some(other.to_numeric_offset()),
        None => None,
    };
    let given = |zone: &TimeZone| match zone.to_ambiguous_timestamp(shown).offset() {
        AmbiguousOffset::Unambiguous { offset } => Ok(offset),
        AmbiguousOffset::Gap { .. } => Err(invalid(
            "a time that exists: clocks skip this time when summer time begins; give an offset such as +02:00",
        )),
        AmbiguousOffset::Fold { .. } => Err(invalid(
            "unambiguous: clocks show this time twice when summer time ends; give an offset such as +02:00",
        )),
    };
    let offset = match (offset, named, zone) {
        (Some(offset), None, _) => offset,
        (Some(offset), Some(named), _) => {
            let instant = offset.to_timestamp(shown).map_err(|_| invalid(WRITING))?;
            if named.to_offset(instant) != offset && pieces.offset() != Some(PiecesOffset::Zulu) {
                return Err(invalid("with the offset that its time zone has at that time"));
            }
            offset
        }
        (None, Some(named), _) => given(&named)?,
        (None, None, Some(zone)) => given(&zone.zone)?,
        (None, None, None) => return Err(invalid(WRITING)),
    };
    offset.to_timestamp(shown).map(seconds).map_err(|_| invalid(WRITING))
}

/// Returns true if a text begins with digits that are grouped as in 2026-06-21.
fn is_like_date(text: &str) -> bool {
    let is_so = |(at, byte): (usize, u8)| if matches!(at, 4 | 7) { byte == b'-' } else { byte.is_ascii_digit() };
    text.len() >= 10 && text.bytes().take(10).enumerate().all(is_so)
}

/// The zone, or else the offset, that an instant is written with; `None` where it has neither or is no instant.
#[must_use]
pub fn zone_of_instant(text: &str) -> Option<Zone> {
    let pieces = Pieces::parse(text.trim()).ok()?;
    let zone = pieces.to_time_zone_with(&TimeZoneDatabase::bundled()).ok().flatten();
    match (zone, pieces.offset()) {
        (Some(zone), _) if zone.iana_name().is_some_and(|name| name != "UTC") => {
            let name = zone.iana_name().unwrap_or_default().to_owned();
            Some(Zone { zone, name })
        }
        (_, None) => None,
        (_, Some(PiecesOffset::Zulu)) => Some(Zone::utc()),
        (_, Some(other)) => {
            let offset = other.to_numeric_offset();
            Some(Zone { zone: TimeZone::fixed(offset), name: offset.to_string() })
        }
    }
}

/// An offset written as +02, +0200, +02:00 or +02:00:30.
fn offset(text: &str) -> Option<Offset> {
    let sign = if text.starts_with('-') { -1 } else { 1 };
    let digits: String = text.chars().skip(1).filter(|c| *c != ':').collect();
    let is_written_so = matches!(digits.len(), 2 | 4 | 6) && digits.bytes().all(|b| b.is_ascii_digit());
    let mut parts =
        digits.as_bytes().as_chunks::<2>().0.iter().map(|&[a, b]| i32::from(a - b'0') * 10 + i32::from(b - b'0'));
    if !is_written_so {
        return None;
    }
    let mut next = || parts.next().unwrap_or(0);
    let [hours, minutes, seconds] = [next(), next(), next()];
    let is_clock = hours <= 18 && minutes < 60 && seconds < 60;
    Offset::from_seconds(sign * (hours * 3600 + minutes * 60 + seconds)).ok().filter(|_| is_clock)
}

fn timestamp(unix_s: f64) -> Option<Timestamp> {
    Timestamp::from_millisecond(to_i64((unix_s * 1e3).round())).ok().filter(|_| unix_s.is_finite())
}

fn seconds(t: Timestamp) -> f64 {
    t.as_second() as f64 + f64::from(t.subsec_nanosecond()) * 1e-9
}

fn shortened(text: &str) -> String {
    text.chars().take(80).collect()
}

/// Parses an hour of a day as clocks show it, 0 to 24: "9", "09:30"; `None` for other texts.
#[must_use]
pub fn parse_hour(text: &str) -> Option<f64> {
    let (hours, minutes) = text.split_once(':').unwrap_or((text, "0"));
    let (hours, minutes) = (hours.parse::<u8>().ok()?, minutes.parse::<u8>().ok()?);
    let value = f64::from(hours) + f64::from(minutes) / 60.0;
    (minutes < 60 && value <= 24.0).then_some(value)
}
