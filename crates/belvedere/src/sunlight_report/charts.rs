//! Charts of a report as SVG: strips of days, and the sky before a window with the paths of the sun.

use super::SunlightReport;
use super::words::Words;
use crate::apps::sun_calendar::{CalendarDay, SunLine, SunObstacle};
use crate::apps::window_views::SeenKind;
use crate::cast::to_index;
use crate::report::clock_time;
use std::f64::consts::{FRAC_PI_2, PI};
use std::fmt::Write as _;

/// Width of charts, and height of a strip, in units of the drawing.
const WIDTH: f64 = 680.0;
const STRIP: f64 = 13.0;
/// Room at the right for the ends of scales.
const RIGHT: f64 = 12.0;
/// Room for the names of strips.
const LABELS: f64 = 132.0;
/// Steps of the sky, degrees of azimuth and elevation.
const SKY_STEP: [f64; 2] = [2.0, 1.5];
/// Range of azimuths on each side of a window, and highest elevation, degrees.
const SKY_REACH: [f64; 2] = [90.0, 72.0];

/// Colour of an obstacle.
pub(super) fn color(obstacle: SunObstacle) -> &'static str {
    match obstacle {
        SunObstacle::None => "#f7c948",
        SunObstacle::OwnWall => "#e3e6ea",
        SunObstacle::Seen(SeenKind::Building) => "#6b7684",
        SunObstacle::Seen(SeenKind::Vegetation) => "#6aa36f",
        SunObstacle::Mesh(_) => "#c2352b",
        SunObstacle::Terrain | SunObstacle::Seen(SeenKind::Ground) => "#b08d5b",
        SunObstacle::Seen(_) => "#9aa3b5",
    }
}

/// Obstacles of the legend with the keys of their names.
pub(super) const LEGEND: [(SunObstacle, &str); 7] = [
    (SunObstacle::None, "sun"),
    (SunObstacle::Mesh(0), "plan"),
    (SunObstacle::Seen(SeenKind::Building), "buildings"),
    (SunObstacle::Seen(SeenKind::Vegetation), "trees"),
    (SunObstacle::Terrain, "terrain"),
    (SunObstacle::Seen(SeenKind::Other), "others"),
    (SunObstacle::OwnWall, "own-wall"),
];

/// Name of an obstacle in the language of the words.
pub(super) fn name_of(obstacle: SunObstacle, words: &Words) -> &'static str {
    let key = match obstacle {
        SunObstacle::None => "sun",
        SunObstacle::OwnWall => "own-wall",
        SunObstacle::Mesh(_) => "plan",
        SunObstacle::Seen(SeenKind::Building) => "buildings",
        SunObstacle::Seen(SeenKind::Vegetation) => "trees",
        SunObstacle::Terrain | SunObstacle::Seen(SeenKind::Ground) => "terrain",
        SunObstacle::Seen(_) => "others",
    };
    words.get(key)
}

/// The view from a window: the first obstacle in each direction.
pub(super) struct SkyView {
    /// Azimuth of the window from grid north, radians.
    azimuth: f64,
    /// Obstacles in columns from left to right, each from the horizon up.
    columns: Vec<Vec<SunObstacle>>,
}

impl SkyView {
    /// Looks with `lines` from a window that faces `azimuth` from grid north, radians; south where it faces up.
    pub(super) fn new(azimuth: f64, lines: impl Fn(&[[f64; 3]]) -> Vec<SunLine>) -> Self {
        let azimuth = if azimuth.is_finite() { azimuth } else { PI };
        let count = |reach: f64, step: f64| to_index((reach / step).round());
        let [across, up] = [count(2.0 * SKY_REACH[0], SKY_STEP[0]), count(SKY_REACH[1], SKY_STEP[1])];
        let column = |number: usize| {
            let from_middle = (number as f64 + 0.5) * SKY_STEP[0] - SKY_REACH[0];
            let (east, north) = (azimuth + from_middle.to_radians()).sin_cos();
            let direction = |row: usize| {
                let (sine, cosine) = ((row as f64 + 0.5) * SKY_STEP[1]).to_radians().sin_cos();
                [east * cosine, north * cosine, sine]
            };
            lines(&(0..up).map(direction).collect::<Vec<_>>()).into_iter().map(|line| line.obstacle).collect()
        };
        Self { azimuth, columns: (0..across).map(column).collect() }
    }
}

/// Strips of the days in detail: one for each state of the scene, and one without trees.
pub(super) fn strips(report: &SunlightReport, window: usize, words: &Words) -> String {
    let schedule = &report.before.calendar.schedule;
    let steps = || schedule.days.iter().flat_map(|day| &day.steps);
    let first = steps().map(|step| f64::from(step.start)).fold(f64::INFINITY, f64::min).floor();
    let last = steps().map(|step| f64::from(step.start + step.hours)).fold(0.0, f64::max).ceil();
    if !(last > first) {
        return String::new();
    }
    let at = |hour: f64| LABELS + (hour - first) / (last - first) * (WIDTH - LABELS - RIGHT);
    let mut body = String::new();
    let mut top = 2.0;
    for (title, strips) in groups_of(report, window, words) {
        let _ = write!(body, "<text class='day' x='0' y='{:.1}'>{title}</text>", top + STRIP - 3.0);
        top += STRIP + 2.0;
        for (name, day) in strips {
            let _ = write!(body, "<text x='8' y='{:.1}'>{name}</text>", top + STRIP - 3.5);
            let (from, to) = (at(first), at(last));
            let _ = write!(
                body,
                "<rect class='night' x='{from:.1}' y='{top:.1}' width='{:.1}' height='{STRIP}'/>",
                to - from
            );
            for stretch in &day.0 {
                let [from, to] = [stretch.start, stretch.end].map(|hour| at(f64::from(hour).clamp(first, last)));
                let what = name_of(stretch.obstacle, words);
                let times = [stretch.start, stretch.end].map(|hour| clock_time(hour.into())).join("–");
                let _ = write!(
                    body,
                    "<rect x='{from:.2}' y='{top:.1}' width='{:.2}' height='{STRIP}' fill='{}'><title>{times} {what}</title></rect>",
                    to - from,
                    color(stretch.obstacle),
                );
            }
            top += STRIP + 2.0;
        }
        top += 5.0;
    }
    let mut hour = first;
    while hour <= last {
        let _ = write!(body, "<line class='grid' x1='{0:.1}' x2='{0:.1}' y1='2' y2='{top:.1}'/>", at(hour));
        if (hour - first) % 2.0 < 0.5 {
            let _ = write!(
                body,
                "<text class='hour' x='{:.1}' y='{:.1}'>{}</text>",
                at(hour),
                top + 10.0,
                hour.rem_euclid(24.0)
            );
        }
        hour += 1.0;
    }
    format!("<svg class='strips' viewBox='0 0 {WIDTH} {:.0}'>{body}</svg>", top + 14.0)
}

/// The strips of a window: for each day in detail, and for the critical day of the rule, with their names.
fn groups_of<'a>(
    report: &'a SunlightReport,
    window: usize,
    words: &Words,
) -> Vec<(String, Vec<(String, &'a CalendarDay)>)> {
    let days = report.before.calendar.schedule.days.iter().enumerate();
    let without = report.last().calendar.without_trees.as_ref();
    let of_day = |(row, day): (usize, &crate::apps::sun::DayOfLight)| {
        let states = report.states().map(|(name, state)| (words.get(name), &state.calendar.days[window][row]));
        let without = without.map(|days| (words.get("without-trees"), &days[window][row]));
        (words.date(day.date), states.chain(without).map(|(name, day)| (name.to_owned(), day)).collect())
    };
    let mut groups: Vec<_> = days.map(of_day).collect();
    let critical = report.states().filter_map(|(name, state)| {
        let (found, rule) = (state.of_rule.as_ref()?, state.windows[window].rule?);
        let name = format!("{}, {}", words.get(name), words.short_date(rule.date));
        Some((name, found.days.get(window)?.get(rule.row)?))
    });
    let critical: Vec<(String, &CalendarDay)> = critical.collect();
    if !critical.is_empty() {
        groups.push((words.get("deciding-day").to_owned(), critical));
    }
    groups
}

/// The sky before a window with the paths of the sun, as the last state of the scene has it.
pub(super) fn sky(report: &SunlightReport, window: usize, words: &Words) -> String {
    let state = report.last();
    let (Some(sky), schedule) = (state.skies.get(window), &state.calendar.schedule) else { return String::new() };
    let [reach, highest] = SKY_REACH;
    let (left, bottom) = (26.0, 214.0);
    let x = |from_middle: f64| left + (from_middle + reach) / (2.0 * reach) * (WIDTH - left - RIGHT);
    let y = |elevation: f64| bottom - elevation / highest * (bottom - 6.0);
    let mut body = format!(
        "<rect class='sky' x='{left}' y='6' width='{:.1}' height='{:.1}'/>",
        WIDTH - left - RIGHT,
        bottom - 6.0
    );
    for (number, column) in sky.columns.iter().enumerate() {
        let from = number as f64 * SKY_STEP[0] - reach;
        let mut row = 0;
        while row < column.len() {
            let end = (row..column.len()).find(|&other| column[other] != column[row]).unwrap_or(column.len());
            if column[row] != SunObstacle::None {
                let (low, high) = (y(row as f64 * SKY_STEP[1]), y(end as f64 * SKY_STEP[1]));
                let (from, to) = (x(from), x(from + SKY_STEP[0]));
                let _ = write!(
                    body,
                    "<rect x='{from:.1}' y='{high:.1}' width='{:.1}' height='{:.1}' fill='{}'/>",
                    to - from + 0.2,
                    low - high,
                    color(column[row])
                );
            }
            row = end;
        }
    }
    for (number, day) in schedule.days.iter().enumerate() {
        let mut highest_point = [f64::NAN, f64::NEG_INFINITY];
        let mut path = String::new();
        let mut is_drawing = false;
        for step in &day.steps {
            let [azimuth, elevation] = schedule.grid_azimuth_and_elevation(step.direction as usize);
            let from_middle = ((azimuth - sky.azimuth + PI).rem_euclid(2.0 * PI) - PI).to_degrees();
            let elevation = elevation.to_degrees();
            if from_middle.abs() > reach || elevation > highest {
                is_drawing = false;
                continue;
            }
            let _ = write!(path, "{}{:.1} {:.1}", if is_drawing { " " } else { "M" }, x(from_middle), y(elevation));
            is_drawing = true;
            if elevation > highest_point[1] {
                highest_point = [from_middle, elevation];
            }
        }
        if path.is_empty() {
            continue;
        }
        let _ = write!(body, "<path class='outline' d='{path}'/><path class='sun-path' d='{path}'/>");
        let [at, elevation] = highest_point;
        let anchor = if at > reach - 25.0 {
            "end"
        } else if at < 25.0 - reach {
            "start"
        } else {
            "middle"
        };
        let _ = write!(
            body,
            "<text class='path-name' text-anchor='{anchor}' x='{:.1}' y='{:.1}'>{}</text>",
            x(at),
            y(elevation) - 4.0,
            words.short_date(schedule.days[number].date)
        );
    }
    for elevation in [0.0, 15.0, 30.0, 45.0, 60.0] {
        let height = y(elevation);
        let _ = write!(
            body,
            "<line class='grid' x1='{left}' x2='{:.1}' y1='{height:.1}' y2='{height:.1}'/>",
            WIDTH - RIGHT
        );
        let _ = write!(body, "<text class='scale' x='{:.1}' y='{:.1}'>{elevation}°</text>", left - 4.0, height + 3.0);
    }
    let true_azimuth = sky.azimuth + state.calendar.grid_north;
    for (number, name) in words.get("compass").split('|').enumerate() {
        let azimuth = number as f64 * FRAC_PI_2 / 2.0;
        let from_middle = ((azimuth - true_azimuth + PI).rem_euclid(2.0 * PI) - PI).to_degrees();
        if from_middle.abs() <= reach {
            let _ = write!(body, "<text class='hour' x='{:.1}' y='{:.1}'>{name}</text>", x(from_middle), bottom + 12.0);
        }
    }
    format!("<svg class='sky-view' viewBox='0 0 {WIDTH} {:.0}'>{body}</svg>", bottom + 18.0)
}
