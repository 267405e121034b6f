//! Rules of sunlight as planners know them: so many hours on such days.

use crate::sun::{Date, Site, Zone, declination};
use belvedere_data::{Error, Parameter, Result};

/// Days that a rule is about; months and days of the month.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RuleDays {
    /// One day of each year.
    On([i8; 2]),
    /// Each day from the first to the last, over the turn of the year where the first comes later.
    Each([[i8; 2]; 2]),
    /// The day on which the sun stays up longest at the site, in June in the north and in December in the south.
    Longest,
    /// The day on which it stays up shortest.
    Shortest,
}

/// A rule: so many hours of sun on each of its days.
#[derive(Clone, Debug, PartialEq)]
pub struct SunRule {
    /// Its name; as typed for rules of one's own.
    pub name: String,
    /// Requirement of the rule, and its source.
    pub description: String,
    /// Days on which it must be met.
    pub days: RuleDays,
    /// Hours of sun that a day must have, 0 to 24.
    pub hours: f64,
    /// Elevation of the sun from which on hours count, radians.
    pub min_elevation: f64,
}

/// A rule with a name: name, name of its column, days, hours, minimum elevation in degrees, description of its
/// requirement.
struct NamedRule(&'static str, &'static str, RuleDays, f64, f64, &'static str);

const EIGHT_MONTHS: RuleDays = RuleDays::Each([[2, 19], [10, 21]]);

const NAMED: [NamedRule; 4] = [
    NamedRule("nl-light", "nl_light", EIGHT_MONTHS, 2.0, 0.0, "2 h a day from 19 February to 21 October (TNO, light)"),
    NamedRule(
        "nl-strict",
        "nl_strict",
        RuleDays::Each([[1, 21], [11, 22]]),
        3.0,
        0.0,
        "3 h a day from 21 January to 22 November (TNO, strict)",
    ),
    NamedRule(
        "the-hague",
        "the_hague",
        EIGHT_MONTHS,
        2.0,
        10.0,
        "2 h a day from 19 February to 21 October with the sun above 10 degrees (The Hague)",
    ),
    NamedRule(
        "bre-equinox",
        "bre_equinox",
        RuleDays::On([3, 21]),
        2.0,
        0.0,
        "2 h on 21 March, on at least half of an open space (BRE 209)",
    ),
];

impl SunRule {
    /// Names of the rules that have one, and the columns that results stand in.
    pub fn columns() -> impl Iterator<Item = (&'static str, &'static str)> {
        NAMED.iter().map(|named| (named.0, named.1))
    }

    /// Parses a rule from its name, or one's own, written as HOURS@DAYS with days as in [`RuleDays::parse`]. A sign and
    /// degrees add a minimum elevation of the sun: "2@02-19..10-21>10".
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a name that is not known, and for days, hours (above 0 to 24) and elevations (0
    /// to below 90°) that do not exist.
    pub fn parse(text: &str) -> Result<Self> {
        let text = text.trim();
        if let Some(NamedRule(name, _, days, hours, degrees, description)) = NAMED.iter().find(|named| named.0 == text)
        {
            return Ok(Self {
                name: (*name).to_owned(),
                description: (*description).to_owned(),
                days: *days,
                hours: *hours,
                min_elevation: degrees.to_radians(),
            });
        }
        Self::of_text(text).ok_or_else(|| Error::InvalidParameter {
            parameter: Parameter::Rule,
            value: text.chars().take(80).collect(),
            expected: "nl-light, nl-strict, the-hague, bre-equinox, or your own rule such as 1.5@03-21, 1@shortest-day or 2@02-19..10-21>10",
        })
    }

    fn of_text(text: &str) -> Option<Self> {
        let (hours, rest) = text.split_once('@')?;
        let hours: f64 = hours.parse().ok().filter(|&hours| hours > 0.0 && hours <= 24.0)?;
        let (days, degrees) = match rest.split_once('>') {
            Some((days, degrees)) => (days, degrees.parse().ok().filter(|d| (0.0..90.0).contains(d))?),
            None => (rest, 0.0_f64),
        };
        let days = RuleDays::parse(days)?;
        let (name, description) = (text.to_owned(), format!("{hours} h {}", described(days, degrees)));
        Some(Self { name, description, days, hours, min_elevation: degrees.to_radians() })
    }
}

impl RuleDays {
    /// Days written as MM-DD or MM-DD..MM-DD, or by a name: "equinox" (21 March, as rules have it), "shortest-day" or
    /// "winter-solstice", "longest-day" or "summer-solstice"; `None` for other texts.
    #[must_use]
    pub fn parse(text: &str) -> Option<Self> {
        match text {
            "equinox" => return Some(Self::On([3, 21])),
            "shortest-day" | "winter-solstice" => return Some(Self::Shortest),
            "longest-day" | "summer-solstice" => return Some(Self::Longest),
            _ => {}
        }
        Some(match text.split_once("..") {
            Some((first, last)) => Self::Each([month_and_day(first)?, month_and_day(last)?]),
            None => Self::On(month_and_day(text)?),
        })
    }

    /// These days in a year, in the order of the calendar, of a span over the turn of the year its end first. 29
    /// February is 28 February in years without.
    ///
    /// # Errors
    /// Those of [`Date::new`], and of the position of the sun.
    pub fn dates(self, year: i16, site: &Site, zone: &Zone) -> Result<Vec<Date>> {
        let date = |[month, day]: [i8; 2]| {
            Date::new(year, month, day)
                .or_else(|e| if [month, day] == [2, 29] { Date::new(year, 2, 28) } else { Err(e) })
        };
        let whole = [date([1, 1])?, date([12, 31])?];
        Ok(match self {
            Self::On(day) => vec![date(day)?],
            Self::Each([first, last]) => {
                let [first, last] = [date(first)?, date(last)?];
                match first <= last {
                    true => first.to(last).collect(),
                    false => whole[0].to(last).chain(first.to(whole[1])).collect(),
                }
            }
            Self::Longest => vec![highest(whole, site, zone, 1.0)?],
            Self::Shortest => vec![highest(whole, site, zone, -1.0)?],
        })
    }
}

/// The date of the solstice at which the sun stands `sign` times highest at noon; at the equator that of the north.
fn highest([first, last]: [Date; 2], site: &Site, zone: &Zone, sign: f64) -> Result<Date> {
    let towards = if site.latitude < 0.0 { -sign } else { sign };
    let mut best = (f64::NEG_INFINITY, first);
    for date in first.to(last) {
        let declination = towards * declination(zone.instant_of(date, 12.0)?)?;
        if declination > best.0 {
            best = (declination, date);
        }
    }
    Ok(best.1)
}

fn month_and_day(text: &str) -> Option<[i8; 2]> {
    // a leap year, so that 29 February is a day
    let date = (text.len() == 5).then(|| Date::parse(&format!("2024-{text}")).ok())??;
    Some([date.month(), date.day()])
}

fn described(days: RuleDays, degrees: f64) -> String {
    let day = |[month, day]: [i8; 2]| format!("{month:02}-{day:02}");
    let days = match days {
        RuleDays::On(one) => format!("on {}", day(one)),
        RuleDays::Each([first, last]) => format!("a day from {} to {}", day(first), day(last)),
        RuleDays::Longest => "on the longest day".to_owned(),
        RuleDays::Shortest => "on the shortest day".to_owned(),
    };
    if degrees > 0.0 { format!("{days} with the sun above {degrees} degrees") } else { days }
}
