//! Sunlight reports: what a plan changes for windows and areas, as one HTML file that prints well.
//!
//! | step | file |
//! |---|---|
//! | questions to the scene as it is and as planned | here |
//! | areas, and the shade that a plan adds to them | `areas.rs` |
//! | verdicts on rules | `verdict.rs` |
//! | maps of shadow | `maps.rs` |
//! | strips of days and diagrams of the sky | `charts.rs` |
//! | the answer in sentences | `sentences.rs` |
//! | numbers for a reader | `numbers.rs` |
//! | the page | `page.rs`, `report.css` |
//! | its texts in four languages | `words.rs`, `words.csv` |

mod area_tables;
mod areas;
mod charts;
mod maps;
mod numbers;
mod page;
mod sentences;
mod sources;
mod studies;
mod verdict;
mod words;

pub use sources::ReportSource;
pub use studies::ShadowStudy;
pub use words::Language;

use crate::apps::ask::{
    self, Answers, Days, GivenWindow, GivenWindows, Places, Remark, Scene, SunCalendarQuestion, SunCalendarResults,
    SunHoursQuestion, SunPlace, knows_intervals,
};
use crate::apps::sun::{Date, Zone};
use crate::apps::sun_calendar::sun_lines;
use crate::apps::sun_hours::SunRule;
use crate::apps::targets::{Measure, Targets};
use crate::cloud::ADJUSTED_GPS_EPOCH;
use crate::control::Control;
use crate::crs::CrsKind;
use crate::io::atomic;
use crate::query::UnprovenAs;
use crate::{Error, GpsTimeKind, Parameter, Result};
use areas::{AreaState, CountedSuns};
use charts::SkyView;
use maps::ShadowMaps;
use std::collections::BTreeSet;
use std::io::Write as _;
use std::path::Path;
use std::sync::Arc;
use verdict::RuleFinding;

/// Days that are shown in detail unless others are given.
const DAYS: [&str; 3] = ["equinox", "longest-day", "shortest-day"];
/// Rule of areas unless another is given.
pub const AREA_RULE: &str = "bre-equinox";

/// An area that keeps its sun: a garden, a square.
#[derive(Clone, Debug, PartialEq)]
pub struct ReportArea {
    /// Its name; empty for its number.
    pub name: String,
    /// Its rings on the map, local metres.
    pub rings: Vec<Vec<[f64; 2]>>,
}

/// Content of a sunlight report.
#[derive(Clone, Debug, Default)]
pub struct ReportParams {
    /// Title; empty for the usual one.
    pub title: String,
    /// Language of the texts.
    pub language: Language,
    /// The windows, of which the middle counts.
    pub windows: Vec<GivenWindow>,
    /// Name of each window; empty or missing for its number.
    pub names: Vec<String>,
    /// Room of each window; empty or missing for none. The sun of windows of one room adds up.
    pub rooms: Vec<String>,
    /// The areas.
    pub areas: Vec<ReportArea>,
    /// Daylight rule of the windows; `None` for hours without a verdict.
    pub rule: Option<String>,
    /// Daylight rule of the areas; `None` for [`AREA_RULE`].
    pub area_rule: Option<String>,
    /// Study of a city, whose days and hours count for the shade that the plan adds to areas.
    pub study: Option<ShadowStudy>,
    /// Days in detail: the equinox, the longest and the shortest day unless others are given; without a year that of
    /// the date.
    pub days: Days,
    /// Location on earth, clock, and the north of azimuths of windows.
    pub place: SunPlace,
    /// Files that the report rests on.
    pub sources: Vec<ReportSource>,
    /// Command or code that makes the report again.
    pub command: String,
    /// Day of the report, such as 2026-11-29.
    pub date: String,
    /// Lines below the title, such as the client, the address and the author.
    pub notes: Vec<String>,
}

/// Sun of a window in one state of the scene.
struct WindowState {
    /// True for a window inside an obstacle, or inside the plan.
    is_inside: bool,
    /// Interval of the hours of each day in detail that holds the truth in nine of ten cases; empty if not known.
    intervals: Vec<[f64; 2]>,
    rule: Option<RuleFinding>,
}

/// Findings on the scene as it is, or as it is planned.
struct State {
    calendar: SunCalendarResults,
    /// The same on the days of the rule of windows; `None` without a rule.
    of_rule: Option<SunCalendarResults>,
    windows: Vec<WindowState>,
    /// Rule in each room.
    rooms: Vec<Option<RuleFinding>>,
    areas: Vec<AreaState>,
    maps: Option<ShadowMaps>,
    skies: Vec<SkyView>,
}

/// A sunlight report.
pub struct SunlightReport {
    params: ReportParams,
    rule: Option<SunRule>,
    area_rule: SunRule,
    before: State,
    after: Option<State>,
    /// Number of points of the cloud, and points per m² of its bounds.
    points: [f64; 2],
    /// First and last day of the survey in UTC, where its pulses have such times.
    flown: Option<[Date; 2]>,
    reference_system: String,
    /// True if the survey names no reference system, so that metres are assumed.
    is_without_system: bool,
    /// Warnings and notes on the scene and its windows.
    pub remarks: Vec<Remark>,
}

impl ReportParams {
    /// Checks all that does not depend on a scene.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for rules, days and places that cannot be, and without windows and areas.
    pub fn check(&self) -> Result<()> {
        self.check_rules()?;
        if self.windows.is_empty() && self.areas.is_empty() {
            let (value, expected) = ("missing".to_owned(), "windows or areas that keep their sun");
            return Err(Error::invalid(Parameter::Targets, value, expected));
        }
        GivenWindows::Each(self.windows.clone()).check()
    }

    /// Checks rules, days and place, which do not need windows or areas.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`].
    pub fn check_rules(&self) -> Result<()> {
        self.rule.as_deref().map(SunRule::parse).transpose()?;
        SunRule::parse(self.area_rule())?;
        self.detailed_days().check(&self.place)
    }

    fn area_rule(&self) -> &str {
        self.area_rule.as_deref().unwrap_or(AREA_RULE)
    }

    fn detailed_days(&self) -> Days {
        let mut days = self.days.clone();
        days.year = days.year.or_else(|| Date::parse(&self.date).ok().map(Date::year));
        if days.is_empty() {
            days.dates = match (self.study, days.year) {
                (Some(study), Some(year)) => study.dates(year),
                _ => DAYS.map(str::to_owned).to_vec(),
            };
        }
        let mut named = BTreeSet::new();
        days.dates.retain(|date| named.insert(date.clone()));
        days
    }

    fn calendar_question(&self, rule: Option<String>) -> SunCalendarQuestion {
        SunCalendarQuestion {
            windows: GivenWindows::Each(self.windows.clone()),
            days: self.detailed_days(),
            rule,
            place: self.place.clone(),
            without_trees: true,
            ..SunCalendarQuestion::default()
        }
    }

    /// Name of a window.
    fn window_name(&self, number: usize, words: &words::Words) -> String {
        let own = self.names.get(number).filter(|name| !name.trim().is_empty()).cloned();
        own.unwrap_or_else(|| format!("{} {}", words.get("window"), number + 1))
    }

    /// Rooms in the order of their first windows, with their windows.
    fn rooms(&self) -> Vec<(&str, Vec<usize>)> {
        let mut rooms: Vec<(&str, Vec<usize>)> = Vec::new();
        for (window, room) in self.rooms.iter().enumerate().take(self.windows.len()) {
            match rooms.iter_mut().find(|(name, _)| name == room) {
                _ if room.trim().is_empty() => {}
                Some((_, windows)) => windows.push(window),
                None => rooms.push((room, vec![window])),
            }
        }
        rooms
    }

    /// Name of an area.
    fn area_name(&self, number: usize, words: &words::Words) -> String {
        let own = self.areas.get(number).map(|area| area.name.clone()).filter(|name| !name.trim().is_empty());
        own.unwrap_or_else(|| format!("{} {}", words.get("area"), number + 1))
    }
}

/// Computes a report on the scene as it is, and as it is `planned` if a plan is given. The grids and the cloud of both
/// scenes must be the same.
///
/// # Errors
/// Those of [`ReportParams::check`], and of the questions that it asks: sun calendars, sun hours and shadow.
pub fn sunlight_report(
    present: &Scene,
    planned: Option<&Scene>,
    params: &ReportParams,
    control: &Control<'_>,
) -> Result<SunlightReport> {
    params.check()?;
    if let Some(study) = params.study.filter(|_| planned.is_none() || params.areas.is_empty()) {
        let expected = "given with areas and a plan: it counts the shade that the plan adds to them";
        return Err(Error::invalid(Parameter::Study, study.name().to_owned(), expected));
    }
    let mut remarks = Vec::new();
    let box_of_maps = maps::extent(present, planned, params);
    let before = State::of(present, params, box_of_maps, &mut remarks, control)?;
    if let Some(number) = before.areas.iter().position(|area| area.cells == 0) {
        let name = params.area_name(number, &words::Words::of(Language::English));
        let what = format!(
            "{name}: no ground of the scene is in this area; give its corners in the coordinates of the cloud, over the cloud"
        );
        return Err(Error::NoPoints { what });
    }
    let mut after = planned.map(|scene| State::of(scene, params, box_of_maps, &mut remarks, control)).transpose()?;
    let suns = CountedSuns::new(&before.calendar, params)?;
    for (area, was) in after.iter_mut().flat_map(|state| &mut state.areas).zip(&before.areas) {
        area.compare(was, &suns);
    }
    let (low, high) = present.model().bounds().on_map();
    let count = present.cloud().len() as f64;
    Ok(SunlightReport {
        rule: params.rule.as_deref().map(SunRule::parse).transpose()?,
        area_rule: SunRule::parse(params.area_rule())?,
        before,
        after,
        points: [count, count / ((high[0] - low[0]) * (high[1] - low[1]))],
        flown: flown(present),
        reference_system: present.frame().crs.describe(),
        is_without_system: present.frame().crs.kind == CrsKind::Unknown,
        remarks,
        params: params.clone(),
    })
}

/// First and last day of the pulses of a scene.
fn flown(scene: &Scene) -> Option<[Date; 2]> {
    let attributes = &scene.cloud().attributes;
    let times = attributes.gps_time.as_ref().filter(|_| attributes.gps_time_kind == GpsTimeKind::AdjustedStandard)?;
    let known = || times.iter().copied().filter(|time| time.is_finite());
    let day = |time: f64| Zone::utc().date_at(ADJUSTED_GPS_EPOCH + time).ok();
    Some([day(known().reduce(f64::min)?)?, day(known().reduce(f64::max)?)?])
}

/// Adds remarks that are new.
fn add_remarks<F>(remarks: &mut Vec<Remark>, answers: &Answers<F>) {
    for remark in &answers.remarks {
        if !remarks.contains(remark) {
            remarks.push(remark.clone());
        }
    }
}

impl State {
    fn of(
        scene: &Scene,
        params: &ReportParams,
        box_of_maps: ([f64; 2], [f64; 2]),
        remarks: &mut Vec<Remark>,
        control: &Control<'_>,
    ) -> Result<Self> {
        let has_windows = !params.windows.is_empty();
        // areas alone still need suns and clock
        let places = if has_windows { Places::Scene } else { Places::Points(Vec::new(), None) };
        let answers = ask::ask(scene, &params.calendar_question(None), &places, control)?;
        add_remarks(remarks, &answers);
        let calendar = answers.found;
        let of_rule = match (&params.rule, has_windows) {
            (Some(rule), true) => {
                let answers = ask::ask(scene, &params.calendar_question(Some(rule.clone())), &places, control)?;
                add_remarks(remarks, &answers);
                Some(answers.found)
            }
            _ => None,
        };
        let blockers = scene.blockers(UnprovenAs::Reported, control)?;
        let mut intervals = Intervals::new(scene, params, &calendar, control)?;
        let counted = of_rule.as_ref().and_then(|found| found.rule.as_ref());
        let min_elevation_deg = counted.map(|rule| rule.min_elevation.to_degrees()).filter(|degrees| *degrees > 0.0);
        let mut windows = Vec::with_capacity(params.windows.len());
        for number in 0..params.windows.len() {
            let dates = calendar.schedule.days.iter().map(|day| day.date);
            let of_days =
                dates.map(|date| intervals.of((date, None), number, control)).collect::<Result<Option<Vec<_>>>>()?;
            let mut rule = of_rule.as_ref().and_then(|found| RuleFinding::of(found, number));
            if let Some(rule) = &mut rule {
                rule.widen(intervals.of((rule.date, min_elevation_deg), number, control)?);
            }
            let place = calendar.targets.positions[number].map(f64::from);
            let is_inside = blockers.is_inside_obstacle(place)
                || blockers.triangles().is_some_and(|triangles| triangles.encloses(place));
            windows.push(WindowState { is_inside, intervals: of_days.unwrap_or_default(), rule });
        }
        let mut rooms = Vec::new();
        for (_, of_room) in params.rooms() {
            let mut rule = of_rule.as_ref().and_then(|found| RuleFinding::of_room(found, &of_room));
            if let Some(rule) = &mut rule {
                // errors of windows add up at worst
                let mut ends = Some([0.0; 2]);
                for &window in of_room.iter().filter(|&&window| calendar.targets.is_target(window)) {
                    let of_window = intervals.of((rule.date, min_elevation_deg), window, control)?;
                    ends = ends.zip(of_window).map(|(sum, of_window)| [0, 1].map(|end| sum[end] + of_window[end]));
                }
                rule.widen(ends);
            }
            rooms.push(rule);
        }
        let suns = CountedSuns::new(&calendar, params)?;
        let mut areas = Vec::with_capacity(params.areas.len());
        for area in &params.areas {
            areas.push(AreaState::of(scene, (area, params), &suns, remarks, control)?);
        }
        let maps = maps::shadow_maps(scene, params, &calendar, box_of_maps, control)?;
        let sky = |window: usize| {
            let place = calendar.targets.positions[window].map(f64::from);
            let azimuth = calendar.windows[window].azimuth;
            SkyView::new(azimuth, |directions| match calendar.targets.is_target(window) {
                true => sun_lines(&blockers, place, None, &calendar.kinds, directions),
                false => Vec::new(),
            })
        };
        let skies = (0..calendar.windows.len()).map(sky).collect();
        Ok(Self { calendar, of_rule, windows, rooms, areas, maps, skies })
    }
}

/// A day, and the lowest sun that counts on it, degrees; `None` for the horizon.
type SunsOfDay = (Date, Option<f64>);
/// Hours of sun, and the low and high end of their interval.
type HoursAndEnds = [f64; 3];

/// Finds intervals of hours of sun of windows, day by day.
struct Intervals<'a> {
    scene: &'a Scene,
    question: SunHoursQuestion,
    targets: Arc<Targets>,
    kept: Vec<(SunsOfDay, Vec<HoursAndEnds>)>,
    are_known: bool,
}

impl<'a> Intervals<'a> {
    fn new(
        scene: &'a Scene,
        params: &ReportParams,
        calendar: &SunCalendarResults,
        control: &Control<'_>,
    ) -> Result<Self> {
        Ok(Self {
            scene,
            question: SunHoursQuestion { place: params.place.clone(), interval: true, ..SunHoursQuestion::default() },
            targets: Arc::clone(&calendar.targets),
            kept: Vec::new(),
            are_known: !params.windows.is_empty() && knows_intervals(scene, control)?,
        })
    }

    /// Returns the interval of the hours of a window on a day, less those hours; `None` where it is not known.
    fn of(&mut self, of_day: SunsOfDay, window: usize, control: &Control<'_>) -> Result<Option<[f64; 2]>> {
        if !self.are_known {
            return Ok(None);
        }
        if !self.kept.iter().any(|(day, _)| *day == of_day) {
            let (date, min_sun_elevation_deg) = (of_day.0.to_string(), of_day.1);
            let days = Days { dates: vec![date], min_sun_elevation_deg, ..Days::default() };
            let question = SunHoursQuestion { days, ..self.question.clone() };
            let answers = ask::ask(self.scene, &question, &Places::Targets(Arc::clone(&self.targets)), control)?;
            let column = |name: &str| -> &[f32] {
                let found = answers.measures.iter().find(|measure: &&Measure| measure.name == name);
                found.map_or(&[], |measure| &measure.values)
            };
            let ends = column("hours_low").iter().zip(column("hours_high"));
            let rows = column("sun_hours").iter().zip(ends);
            let rows = rows.map(|(&hours, (&low, &high))| [hours, low, high].map(f64::from)).collect();
            self.kept.push((of_day, rows));
        }
        let rows = self.kept.iter().find(|(day, _)| *day == of_day).map(|(_, rows)| rows);
        let row = rows.and_then(|rows| rows.get(window)).filter(|row| row.iter().all(|v| v.is_finite()));
        Ok(row.map(|[hours, low, high]| [(low - hours).min(0.0), (high - hours).max(0.0)]))
    }
}

impl SunlightReport {
    /// The answer in a few lines, one for each window and area.
    #[must_use]
    pub fn headlines(&self) -> Vec<String> {
        sentences::sentences(self, &words::Words::of(Language::English))
    }

    /// The report as one HTML file that needs no other file and no network.
    ///
    /// # Errors
    /// Those of drawing maps.
    pub fn to_html(&self) -> Result<String> {
        page::html(self)
    }

    /// Writes the HTML file, which appears only when it is complete.
    ///
    /// # Errors
    /// [`Error::Io`], and those of [`SunlightReport::to_html`].
    pub fn write(&self, path: &Path) -> Result<()> {
        let page = self.to_html()?;
        atomic::write(path, |file| file.write_all(page.as_bytes()).map_err(Error::io(path)))
    }

    /// The states of the scene, each with the key of its name.
    fn states(&self) -> impl Iterator<Item = (&'static str, &State)> {
        let first = if self.after.is_some() { "before" } else { "now" };
        std::iter::once((first, &self.before)).chain(self.after.iter().map(|state| ("after", state)))
    }

    /// The state that the report is about: as planned, else as it is.
    fn last(&self) -> &State {
        self.after.as_ref().unwrap_or(&self.before)
    }
}
