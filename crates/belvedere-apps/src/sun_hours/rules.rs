//! Rules of sunlight as planners know them: so many hours on such days.

use crate::sun::{Date, DayParams, Period, Site, SunDay, Zone, declination, parse_hour, sun_day, sun_days};
use belvedere_data::{Error, Parameter, Result};
use rayon::prelude::*;

/// Days that a rule is about; months and days of the month.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RuleDays {
    /// One day of each year.
    On([i8; 2]),
    /// Each day from the first to the last, over the turn of the year where the first comes later.
    Each([[i8; 2]; 2]),
    /// 21 March and 23 September.
    Equinoxes,
    /// The day on which the sun stays up longest at the site, in June in the north and in December in the south.
    Longest,
    /// The day on which it stays up shortest.
    Shortest,
}

/// Part of the day that a rule counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RuleWindow {
    /// First and last hour, 0 to 24.
    pub hours: [f64; 2],
    /// Their clock.
    pub clock: WindowClock,
}

/// Clock of the hours of a rule.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WindowClock {
    /// That of the zone.
    Zone,
    /// The sun: it is highest at 12.
    Sun,
}

/// Hours of a day that must suffice.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Counted {
    /// All together. Default.
    #[default]
    All,
    /// The longest piece without a break.
    LongestPiece,
}

/// Days of a rule that must have enough sun.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NeededDays {
    /// Each of them.
    All,
    /// One of them, whichever.
    Any,
}

impl NeededDays {
    /// Returns true if `sufficient` of `count` days are enough.
    #[must_use]
    pub fn are_met(self, sufficient: usize, count: usize) -> bool {
        match self {
            Self::All => sufficient == count,
            Self::Any => sufficient > 0,
        }
    }
}

/// A rule: so many hours of sun on its days.
#[derive(Clone, Debug, PartialEq)]
pub struct SunRule {
    /// Its name; as typed for rules of one's own.
    pub name: String,
    /// Requirement of the rule, and its source.
    pub description: String,
    /// Days that it is about.
    pub days: RuleDays,
    /// Days among them that must have enough sun.
    pub needed: NeededDays,
    /// Hours of sun that a day must have, 0 to 24.
    pub hours: f64,
    /// Hours of a day that must suffice.
    pub counted: Counted,
    /// Part of the day that counts; `None` for all of it.
    pub window: Option<RuleWindow>,
    /// Elevation of the sun from which on hours count, radians.
    pub min_elevation: f64,
}

/// A rule with a name: name, name of its column, the rule as one would write it, description of its requirement.
struct NamedRule(&'static str, &'static str, &'static str, &'static str);

const NAMED: [NamedRule; 17] = [
    NamedRule(
        "nl-light",
        "nl_light",
        "2@02-19..10-21",
        "2 h a day from 19 February to 21 October (Netherlands: TNO, light)",
    ),
    NamedRule(
        "nl-strict",
        "nl_strict",
        "3@01-21..11-22",
        "3 h a day from 21 January to 22 November (Netherlands: TNO, strict)",
    ),
    NamedRule(
        "the-hague",
        "the_hague",
        "2@02-19..10-21>10",
        "2 h a day from 19 February to 21 October with the sun above 10 degrees (The Hague)",
    ),
    NamedRule(
        "bre-equinox",
        "bre_equinox",
        "2@03-21",
        "2 h on 21 March, on at least half of an open space (United Kingdom: BRE 209)",
    ),
    NamedRule(
        "en17037-minimum",
        "en17037_minimum",
        "1.5@02-01..03-21,any",
        "1.5 h on one day from 1 February to 21 March (EN 17037:2018, minimum)",
    ),
    NamedRule(
        "en17037-medium",
        "en17037_medium",
        "3@02-01..03-21,any",
        "3 h on one day from 1 February to 21 March (EN 17037:2018, medium)",
    ),
    NamedRule(
        "en17037-high",
        "en17037_high",
        "4@02-01..03-21,any",
        "4 h on one day from 1 February to 21 March (EN 17037:2018, high)",
    ),
    NamedRule(
        "din-winter",
        "din_winter",
        "1@01-17>6",
        "1 h on 17 January with the sun above 6 degrees (Germany: DIN 5034-1)",
    ),
    NamedRule(
        "din-equinox",
        "din_equinox",
        "4@equinox>6",
        "4 h at the equinox with the sun above 6 degrees (Germany: DIN 5034-1)",
    ),
    NamedRule(
        "pl",
        "pl",
        "3@equinoxes@7-17",
        "3 h between 7 and 17 o'clock at both equinoxes (Poland: building regulations, paragraph 60)",
    ),
    NamedRule(
        "pl-centre",
        "pl_centre",
        "1.5@equinoxes@7-17",
        "1.5 h between 7 and 17 o'clock at both equinoxes (Poland: the same, in town centres)",
    ),
    NamedRule("cz", "cz", "1.5@03-01>5", "1.5 h on 1 March with the sun above 5 degrees (Czechia: CSN 73 4301)"),
    NamedRule("se", "se", "5@equinox@9-17", "5 h between 9 and 17 o'clock at the equinox (Sweden: Solklart, 1991)"),
    NamedRule(
        "nsw",
        "nsw",
        "2@06-21@9-15",
        "2 h between 9 and 15 o'clock on 21 June (New South Wales: Apartment Design Guide)",
    ),
    NamedRule(
        "nsw-outer",
        "nsw_outer",
        "3@06-21@9-15",
        "3 h between 9 and 15 o'clock on 21 June (the same, outside the metropolitan areas)",
    ),
    NamedRule(
        "cn",
        "cn",
        "2@01-20@8-16,solar",
        "2 h between 8 and 16 solar time on 20 January (China: GB 50180, great cold)",
    ),
    NamedRule(
        "kr",
        "kr",
        "2@shortest-day@9-15,piece",
        "2 h in one piece between 9 and 15 o'clock on the shortest day (Korea)",
    ),
];

impl SunRule {
    /// Names of the rules that have one, and the columns that results stand in.
    pub fn columns() -> impl Iterator<Item = (&'static str, &'static str)> {
        NAMED.iter().map(|named| (named.0, named.1))
    }

    /// Parses a rule from its name, or one's own, written as HOURS@DAYS with days as in [`RuleDays::parse`]. A sign and
    /// degrees add a minimum elevation of the sun: "2@02-19..10-21>10". A second @ adds hours of the day that count:
    /// "3@equinoxes@7-17". Words behind commas say more: "solar" (hours by the sun), "piece" (without a break), "any"
    /// (one day is enough).
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a name that is not known, and for days, hours (above 0 to 24), elevations (0 to
    /// below 90°) and words that do not exist.
    pub fn parse(text: &str) -> Result<Self> {
        let text = text.trim();
        let named = NAMED.iter().find(|named| named.0 == text);
        let rule = match named {
            Some(NamedRule(name, _, rule, description)) => Self::of_text(rule).map(|rule| Self {
                name: (*name).into(),
                description: (*description).into(),
                ..rule
            }),
            None => Self::of_text(text),
        };
        let expected = "a name such as nl-light, en17037-minimum or pl (all are in the help), \
             or your own rule such as 1.5@03-21, 2@02-19..10-21>10 or 2@shortest-day@9-15,piece";
        rule.ok_or_else(|| Error::invalid(Parameter::Rule, text.chars().take(80).collect::<String>(), expected))
    }

    fn of_text(text: &str) -> Option<Self> {
        let mut words = text.split(',');
        let mut parts = words.next()?.split('@');
        let hours: f64 = parts.next()?.parse().ok().filter(|&hours| hours > 0.0 && hours <= 24.0)?;
        let days = parts.next()?;
        let (days, degrees) = match days.split_once('>') {
            Some((days, degrees)) => (days, degrees.parse().ok().filter(|d| (0.0..90.0).contains(d))?),
            None => (days, 0.0_f64),
        };
        let window = parts.next().map(|hours| Some(RuleWindow { hours: window(hours)?, clock: WindowClock::Zone }));
        let mut rule = Self {
            name: text.to_owned(),
            description: String::new(),
            days: RuleDays::parse(days)?,
            needed: NeededDays::All,
            hours,
            counted: Counted::All,
            window: match window {
                Some(window) => Some(window?),
                None => None,
            },
            min_elevation: degrees.to_radians(),
        };
        if parts.next().is_some() {
            return None;
        }
        for word in words {
            match (word.trim(), &mut rule.window) {
                ("piece", _) => rule.counted = Counted::LongestPiece,
                ("any", _) => rule.needed = NeededDays::Any,
                ("solar", Some(window)) => window.clock = WindowClock::Sun,
                _ => return None,
            }
        }
        rule.description = rule.in_words(degrees);
        Some(rule)
    }

    fn in_words(&self, degrees: f64) -> String {
        let day = |[month, day]: [i8; 2]| format!("{month:02}-{day:02}");
        let each = if self.needed == NeededDays::Any { "on one day" } else { "a day" };
        let mut text = format!("{} h ", self.hours);
        if self.counted == Counted::LongestPiece {
            text += "in one piece ";
        }
        text += &match self.days {
            RuleDays::On(one) => format!("on {}", day(one)),
            RuleDays::Each([first, last]) => format!("{each} from {} to {}", day(first), day(last)),
            RuleDays::Equinoxes => "at both equinoxes".to_owned(),
            RuleDays::Longest => "on the longest day".to_owned(),
            RuleDays::Shortest => "on the shortest day".to_owned(),
        };
        if let Some(RuleWindow { hours: [from, to], clock }) = self.window {
            let clock = if clock == WindowClock::Sun { "solar time" } else { "o'clock" };
            text += &format!(" between {from} and {to} {clock}");
        }
        if degrees > 0.0 {
            text += &format!(" with the sun above {degrees} degrees");
        }
        text
    }

    /// The light of dates that counts, day by day.
    ///
    /// # Errors
    /// Those of [`sun_days`] and [`sun_day`].
    pub fn sun_days(&self, dates: Vec<Date>, site: &Site, zone: &Zone, params: &DayParams) -> Result<Vec<SunDay>> {
        let Some(RuleWindow { hours, clock }) = self.window else {
            return sun_days(site, zone, &Period::Days(dates), params);
        };
        let of_date = |date: Date| {
            let within = match clock {
                WindowClock::Zone => [zone.instant_of(date, hours[0])?, zone.instant_of(date, hours[1])?],
                WindowClock::Sun => {
                    let noon = sun_day(site, zone, date, None, params)?.noon;
                    hours.map(|hour| noon + (hour - 12.0) * 3600.0)
                }
            };
            sun_day(site, zone, date, Some(within), params)
        };
        dates.into_par_iter().map(of_date).collect()
    }
}

/// Hours of a day, written as 9-15 or 08:30-16:00.
fn window(text: &str) -> Option<[f64; 2]> {
    let (from, to) = text.split_once('-')?;
    let hours = [parse_hour(from)?, parse_hour(to)?];
    (hours[0] < hours[1]).then_some(hours)
}

impl RuleDays {
    /// Days written as MM-DD or MM-DD..MM-DD, or by a name: "equinox" (21 March, as rules have it), "equinoxes",
    /// "shortest-day" or "winter-solstice", "longest-day" or "summer-solstice"; `None` for other texts.
    #[must_use]
    pub fn parse(text: &str) -> Option<Self> {
        match text {
            "equinox" => return Some(Self::On([3, 21])),
            "equinoxes" => return Some(Self::Equinoxes),
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
            Self::Equinoxes => vec![date([3, 21])?, date([9, 23])?],
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
