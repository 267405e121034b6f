//! Calendar of the sun at places: from when to when it shines there, and what shades it otherwise.

use crate::rows::check_normals;
use crate::sun::SunSchedule;
use crate::targets::Targets;
use crate::window_views::{SeenKind, check_kinds};
use belvedere_core::query::{Blocker, MedialScene};
use belvedere_data::Result;
use belvedere_data::control::Control;
use belvedere_data::vector::dot;
use rayon::prelude::*;

/// Maximum difference of the end of a step and the start of the next that follows it, hours: rounding of f32.
const ROUNDING: f32 = 1e-4;

/// First obstacle between a place and the sun.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SunObstacle {
    /// None: the sun shines there.
    None,
    /// The wall of the window itself: the sun is behind it.
    OwnWall,
    /// A thing of the survey.
    Seen(SeenKind),
    /// A mesh that was added, by its number.
    Mesh(usize),
    /// Far terrain.
    Terrain,
}

impl SunObstacle {
    /// Its name in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "sun",
            Self::OwnWall => "own wall",
            Self::Seen(SeenKind::Vegetation) => "trees",
            Self::Seen(kind) => kind.name(),
            Self::Mesh(_) => "plan",
            Self::Terrain => "terrain",
        }
    }
}

/// Line from a place to the sun.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SunLine {
    /// First obstacle on it.
    pub obstacle: SunObstacle,
    /// True for a free line of which too much runs through space that no pulse came near to.
    pub is_unproven: bool,
}

/// Part of a day with the same obstacle throughout.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SunStretch {
    /// Start, hours on the clocks of the zone from the beginning of the date.
    pub start: f32,
    /// End, likewise.
    pub end: f32,
    /// The obstacle.
    pub obstacle: SunObstacle,
    /// Hours of sun that are unproven.
    pub unproven: f32,
}

impl SunStretch {
    /// Duration, hours.
    #[must_use]
    pub fn hours(&self) -> f32 {
        self.end - self.start
    }
}

/// Stretches of a day from sunrise to sunset, in the order of time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CalendarDay(pub Vec<SunStretch>);

impl CalendarDay {
    /// Hours with an obstacle that `counts`.
    #[must_use]
    pub fn hours(&self, counts: impl Fn(SunObstacle) -> bool) -> f64 {
        self.0.iter().filter(|stretch| counts(stretch.obstacle)).map(|stretch| f64::from(stretch.hours())).sum()
    }

    /// Hours of sun of all its stretches.
    #[must_use]
    pub fn sun_hours(&self) -> f64 {
        self.hours(|obstacle| obstacle == SunObstacle::None)
    }

    /// Stretches of sun.
    pub fn sun(&self) -> impl DoubleEndedIterator<Item = &SunStretch> {
        self.0.iter().filter(|stretch| stretch.obstacle == SunObstacle::None)
    }

    /// Start of the first sun and end of the last, hours on the clocks; `None` without sun.
    #[must_use]
    pub fn first_and_last(&self) -> Option<[f32; 2]> {
        Some([self.sun().next()?.start, self.sun().next_back()?.end])
    }

    /// Longest sun without a break, hours.
    #[must_use]
    pub fn longest(&self) -> f64 {
        self.sun().map(|stretch| f64::from(stretch.hours())).fold(0.0, f64::max)
    }
}

/// Returns the sun of a day that shines on any of several places, such as the windows of a room: its stretches of sun
/// joined, without those of shade. Unproven hours are at most as many as given.
#[must_use]
pub fn sun_of_any<'a>(days: impl IntoIterator<Item = &'a CalendarDay>) -> CalendarDay {
    let mut all: Vec<SunStretch> = days.into_iter().flat_map(CalendarDay::sun).copied().collect();
    all.sort_by(|a, b| a.start.total_cmp(&b.start));
    let mut joined: Vec<SunStretch> = Vec::new();
    for stretch in all {
        match joined.last_mut() {
            Some(last) if stretch.start <= last.end + ROUNDING => {
                last.end = last.end.max(stretch.end);
                last.unproven = (last.unproven + stretch.unproven).min(last.hours());
            }
            _ => joined.push(stretch),
        }
    }
    CalendarDay(joined)
}

/// Computes the lines from `place`, local metres, to suns in `directions`, (D, 3) unit vectors: [`sun_obstacle`] of
/// each.
#[must_use]
pub fn sun_lines(
    scene: &MedialScene,
    place: [f64; 3],
    normal: Option<[f64; 3]>,
    kinds: &[SeenKind],
    directions: &[[f64; 3]],
) -> Vec<SunLine> {
    let of_direction = |&direction: &[f64; 3]| {
        let obstacle = sun_obstacle(scene, place, normal, kinds, direction);
        let is_unproven = obstacle == SunObstacle::None && scene.is_unproven(place, direction, f64::INFINITY);
        SunLine { obstacle, is_unproven }
    };
    directions.iter().map(of_direction).collect()
}

/// Returns the first obstacle between `place`, local metres, and a sun in `direction`, a unit vector. A sun behind the
/// plane of `normal` has the wall of the place before it. `kinds` are those of the balls of the model, (B).
#[must_use]
pub fn sun_obstacle(
    scene: &MedialScene,
    place: [f64; 3],
    normal: Option<[f64; 3]>,
    kinds: &[SeenKind],
    direction: [f64; 3],
) -> SunObstacle {
    if normal.is_some_and(|normal| !(dot(normal, direction) > 0.0)) {
        return SunObstacle::OwnWall;
    }
    match scene.first_block(place, direction, f64::INFINITY) {
        Some((Blocker::Ball(row), _)) => SunObstacle::Seen(kinds.get(row).copied().unwrap_or_default()),
        Some((Blocker::Patch(_), _)) => SunObstacle::Seen(SeenKind::Building),
        Some((Blocker::Mesh(number), _)) => SunObstacle::Mesh(number),
        Some((Blocker::Terrain, _)) => SunObstacle::Terrain,
        None if scene.far_terrain().hides(place, direction) => SunObstacle::Terrain,
        None => SunObstacle::None,
    }
}

/// Computes the calendar of each of `targets` over the days of `schedule`: a list of days for each, without stretches
/// where a target has no position. Progress counts targets.
///
/// # Errors
/// [`Error::LengthMismatch`](belvedere_data::Error::LengthMismatch) unless each target has a normal, or none has, and
/// each ball a kind;
/// [`Error::Cancelled`](belvedere_data::Error::Cancelled).
///
/// # Source
/// This project's own. Exact lines of sight from the definition of blocking: Peters, Ledoux & Biljecki 2015, section 3.
pub fn sun_calendars(
    scene: &MedialScene,
    targets: &Targets,
    kinds: &[SeenKind],
    schedule: &SunSchedule,
    control: &Control<'_>,
) -> Result<Vec<Vec<CalendarDay>>> {
    check_normals(targets.normals.as_deref(), targets.len())?;
    check_kinds(scene, kinds)?;
    let of_target = |row: usize| {
        control.check()?;
        let days = match targets.is_target(row) {
            false => vec![CalendarDay::default(); schedule.days.len()],
            true => {
                let place = targets.positions[row].map(f64::from);
                let normal = targets.normals.as_ref().map(|normals| normals[row].map(f64::from));
                // each direction once, in parallel: a single window has suns of a year
                let chunks = schedule.directions.par_chunks(DIRECTIONS_AT_ONCE);
                let lines = chunks.map(|directions| {
                    control.check()?;
                    Ok(sun_lines(scene, place, normal, kinds, directions))
                });
                let lines = lines.collect::<Result<Vec<_>>>()?.concat();
                stretches(schedule, &lines)
            }
        };
        control.advance(1);
        Ok(days)
    };
    (0..targets.len()).into_par_iter().map(of_target).collect()
}

/// Directions of a target handed to a thread at once.
const DIRECTIONS_AT_ONCE: usize = 512;

/// Joins the steps of each day that follow each other with the same obstacle.
fn stretches(schedule: &SunSchedule, lines: &[SunLine]) -> Vec<CalendarDay> {
    let of_day = |day: &crate::sun::DayOfLight| {
        let mut found: Vec<SunStretch> = Vec::new();
        for step in &day.steps {
            let line = lines[step.direction as usize];
            let (start, end) = (step.start, step.start + step.hours);
            let unproven = if line.is_unproven { step.hours } else { 0.0 };
            match found.last_mut() {
                Some(last) if last.obstacle == line.obstacle && (step.continues || start - last.end < ROUNDING) => {
                    last.end = end;
                    last.unproven += unproven;
                }
                _ => found.push(SunStretch { start, end, obstacle: line.obstacle, unproven }),
            }
        }
        CalendarDay(found)
    };
    schedule.days.iter().map(of_day).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sun::{Date, DayOfLight, LightStep};

    fn line(obstacle: SunObstacle, is_unproven: bool) -> SunLine {
        SunLine { obstacle, is_unproven }
    }

    #[test]
    fn steps_of_the_same_obstacle_are_one_stretch() {
        let step = |number: u8, start: f32| LightStep {
            start,
            hours: 0.5,
            direction: u32::from(number),
            continues: number > 0 && number != 3,
        };
        // a window of the clock cuts the day between the third step and the fourth
        let steps = vec![step(0, 8.0), step(1, 8.5), step(2, 9.0), step(3, 12.0), step(4, 12.5)];
        let day = DayOfLight { date: Date::new(2026, 3, 21).unwrap(), steps, possible_hours: 2.5 };
        let schedule = SunSchedule { days: vec![day], directions: Vec::new(), greatest_error: 0.0, rms_error: 0.0 };
        let tree = SunObstacle::Seen(SeenKind::Vegetation);
        let sun = SunObstacle::None;
        let lines = [line(tree, false), line(sun, true), line(sun, false), line(sun, false), line(sun, true)];
        let [day] = &stretches(&schedule, &lines)[..] else { panic!("one day") };
        let found: Vec<_> = day.0.iter().map(|s| (s.start, s.end, s.obstacle, s.unproven)).collect();
        assert_eq!(found, [(8.0, 8.5, tree, 0.0), (8.5, 9.5, sun, 0.5), (12.0, 13.0, sun, 0.5)]);
        assert_eq!((day.sun_hours(), day.longest()), (2.0, 1.0));
        assert_eq!(day.first_and_last(), Some([8.5, 13.0]));
        assert_eq!(CalendarDay::default().first_and_last(), None);
    }

    #[test]
    fn windows_of_a_room_add_up_where_the_sun_is_not_in_both() {
        let sun = |start: f32, end: f32| SunStretch { start, end, obstacle: SunObstacle::None, unproven: 0.0 };
        let shade = SunStretch { obstacle: SunObstacle::OwnWall, ..sun(12.0, 18.0) };
        let east = CalendarDay(vec![sun(7.0, 9.0), sun(10.0, 12.0), shade]);
        let south = CalendarDay(vec![sun(11.0, 14.0), sun(14.0, 15.0)]);
        let both = sun_of_any([&east, &south]);
        assert_eq!((both.sun_hours(), both.longest()), (7.0, 5.0));
        assert_eq!(both.first_and_last(), Some([7.0, 15.0]));
        assert_eq!(sun_of_any([&CalendarDay::default()]), CalendarDay::default());
    }
}
