//! Selection of the part of a cloud to read, and its frame.

use belvedere_data::cloud::{ADJUSTED_GPS_EPOCH, Attributes, to_local};
use belvedere_data::control::Control;
use belvedere_data::crs::{Crs, CrsKind};
use belvedere_data::weather::{CalendarDay, unix_day};
use belvedere_data::{Bounds, Error, Frame, GpsTimeKind, Parameter, Result};

use std::collections::BTreeSet;

use std::path::Path;

use crate::points::coordinates::Coordinates;

/// Interval between checks for cancellation of readers that go point by point: a few milliseconds of points.
const POINTS_PER_CHECK: u64 = 1 << 14;

/// Options of reading.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct ReadOptions {
    /// Reference system as for [`Crs::parse`] of files that name none, or the same. Default: none, the files are
    /// believed.
    pub crs: Option<String>,
    /// Precedence of `crs` over the files and the coordinates. Default: contradictions are errors.
    pub crs_against_files: Insistence,
    /// Frame of the cloud, so that clouds that are read separately have comparable local positions. A frame without a
    /// reference system takes that of the files. Default: none, the origin is chosen near the middle of the points.
    pub frame: Option<Frame>,
    /// Only points in this box are read. Default: all.
    pub within: Option<Within>,
    /// Only points of these ASPRS classes are read. Default: all.
    pub classes: Option<Vec<u8>>,
    /// Only points of these flight lines (point source ids) are read. Default: all.
    pub lines: Option<Vec<u16>>,
    /// Only points that were measured from one day to another, both included, in UTC, are read. Default: all.
    pub dates: Option<[CalendarDay; 2]>,
    /// Day of the flight of LAS files whose GPS times are seconds of a week: these get the times of that week. Default:
    /// the day is not known.
    pub flown: Option<CalendarDay>,
    /// True to give the row of each point in its file. Default: false.
    pub row_numbers: RowNumbers,
    /// Axis of the files that is up. Default: z.
    pub up: UpAxis,
    /// Treatment of a file of a set that lies as a whole more than 1000 km from the others. Default: refused.
    pub distant: DistantFiles,
}

/// Treatment of a file whose points all lie too far from those of the other files.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DistantFiles {
    /// It is an error: mostly such a file is in another reference system.
    #[default]
    Refused,
    /// It is left out, and its points are counted.
    LeftOut,
}

/// Treatment of a given reference system that contradicts other evidence.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Insistence {
    /// It is refused.
    #[default]
    Refuse,
    /// It holds.
    Insist,
}

/// Axis of a file that is up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum UpAxis {
    /// The third, as in surveys.
    #[default]
    Z,
    /// The second, as in computer graphics: (x, y, z) is read as (x, −z, y).
    Y,
}

/// A box that points must lie in, or on the faces of, to be read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Within {
    /// Lowest and highest corner in the coordinates and unit of the file.
    File {
        /// Lowest corner.
        low: [f64; 3],
        /// Highest corner.
        high: [f64; 3],
    },
    /// A box in the local metres of [`ReadOptions::frame`], which must be given.
    Local(Bounds),
}

/// Choice to keep the rows of points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RowNumbers {
    /// [`crate::ReadReport::rows`] stays empty.
    #[default]
    Dropped,
    /// [`crate::ReadReport::rows`] has a row for each point.
    Kept,
}

belvedere_data::setters!(ReadOptions {
    with_frame(frame: Frame),
    with_points_within(within: Within),
    with_flown(flown: CalendarDay),
    with_dates(dates: [CalendarDay; 2]),
    with_up(up: UpAxis),
});

impl ReadOptions {
    /// Every point, in the reference system that the files name.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// The same, and the given reference system holds whatever the files and the coordinates say.
    #[must_use]
    pub fn insisting_on_crs(mut self) -> Self {
        self.crs_against_files = Insistence::Insist;
        self
    }

    /// The same with a reference system for files that name none, or the same.
    #[must_use]
    pub fn with_crs(mut self, crs: impl Into<String>) -> Self {
        self.crs = Some(crs.into());
        self
    }

    /// The same for the points of some ASPRS classes only.
    #[must_use]
    pub fn with_classes(mut self, classes: impl Into<Vec<u8>>) -> Self {
        self.classes = Some(classes.into());
        self
    }

    /// The same for the points of some flight lines (point source ids) only.
    #[must_use]
    pub fn with_lines(mut self, lines: impl Into<Vec<u16>>) -> Self {
        self.lines = Some(lines.into());
        self
    }

    /// The same without files that lie too far from the others.
    #[must_use]
    pub fn without_distant_files(mut self) -> Self {
        self.distant = DistantFiles::LeftOut;
        self
    }

    /// The same with the row of each point in the report.
    #[must_use]
    pub fn with_row_numbers(mut self) -> Self {
        self.row_numbers = RowNumbers::Kept;
        self
    }

    /// Checks the options that need no file, and gives the reference system of the option.
    pub(crate) fn forced_crs(&self) -> Result<Option<Crs>> {
        let corners = "from the lowest to the highest corner";
        let in_local = || "in local coordinates".to_owned();
        let origin = self.frame.as_ref().map_or([0.0; 3], |frame| frame.origin);
        let refused = match self.within {
            _ if !origin.iter().all(|v| v.is_finite()) => Some((Parameter::Origin, format!("{origin:?}"), "finite")),
            Some(Within::File { low, high }) if !(0..3).all(|i| low[i] <= high[i]) => {
                Some((Parameter::ReadBox, format!("{low:?} to {high:?}"), corners))
            }
            Some(Within::Local(Bounds { low, high })) if !(0..3).all(|i| low[i] <= high[i]) => {
                Some((Parameter::ReadBox, format!("{low:?} to {high:?}"), corners))
            }
            Some(Within::Local(_)) if self.up == UpAxis::Y => {
                Some((Parameter::ReadBox, in_local(), "in those of the file where its y is up"))
            }
            Some(Within::Local(_)) if self.frame.is_none() => {
                Some((Parameter::ReadBox, in_local(), "given together with a frame"))
            }
            _ if self.crs.is_none() && self.crs_against_files == Insistence::Insist => {
                Some((Parameter::CrsOverride, "given".to_owned(), "given together with a reference system"))
            }
            _ => None,
        };
        if let Some((parameter, value, expected)) = refused {
            return Err(Error::invalid(parameter, value, expected));
        }
        self.crs.as_deref().map(Crs::parse).transpose()
    }
}

/// Input of the reader of one format besides its source.
#[derive(Clone, Copy)]
pub(crate) struct Reading<'r> {
    pub(crate) options: &'r ReadOptions,
    /// The reference system of the option.
    pub(crate) forced: Option<&'r Crs>,
    pub(crate) control: &'r Control<'r>,
}

impl Reading<'_> {
    /// Called for every point by readers that go point by point; `done` points were read before.
    ///
    /// # Errors
    /// [`Error::Cancelled`].
    pub(crate) fn check(&self, done: u64) -> Result<()> {
        if done.is_multiple_of(POINTS_PER_CHECK) { self.control.check() } else { Ok(()) }
    }

    /// Returns a box that holds every requested point, in the coordinates of files that were not opened yet. `None`
    /// without a box, and if the unit of the files is not known.
    pub(crate) fn box_of_unopened(&self) -> Option<FileBox> {
        let of_frame = self.options.frame.as_ref().map(|frame| &frame.crs).filter(|crs| crs.kind != CrsKind::Unknown);
        let known = self.forced.or(of_frame);
        match self.options.within? {
            // the unit does not matter
            Within::File { .. } => self.selection(&Crs::default())?.file_box(),
            Within::Local(_) => self.selection(known?)?.file_box(),
        }
    }

    /// Refuses the system of the option for a file at `path` that names `of_file`, at coordinates in its unit.
    ///
    /// # Errors
    /// Those of [`Crs::check_given`].
    pub(crate) fn check_given(&self, of_file: &Crs, coordinates: [f64; 2], path: &Path) -> Result<()> {
        match (self.forced, self.options.crs_against_files) {
            (Some(given), Insistence::Refuse) => given.check_given(of_file, coordinates, path),
            _ => Ok(()),
        }
    }

    /// The system of a file that names `of_file`: the one of the option, with the heights of the file where it names
    /// none.
    pub(crate) fn system(&self, of_file: &Crs) -> Crs {
        match (self.forced, self.options.crs_against_files) {
            (None, _) => of_file.clone(),
            (Some(given), Insistence::Insist) => given.clone(),
            (Some(given), Insistence::Refuse) => given.clone().with_heights_of(of_file),
        }
    }

    /// Returns the selection of the points of a file in the system `crs`, or `None` for all.
    pub(crate) fn selection(&self, crs: &Crs) -> Option<Selection> {
        let crs = &self.system(crs);
        let place = match (self.options.within, &self.options.frame) {
            (Some(Within::File { low, high }), _) => Some(SelectedBox::File { low, high }),
            (Some(Within::Local(bounds)), Some(frame)) => {
                let known = if *crs == Crs::default() { &frame.crs } else { crs };
                Some(SelectedBox::Local { bounds, origin: frame.origin, units: known.metres_per_unit_xyz() })
            }
            _ => None,
        };
        let classes = self.options.classes.as_ref().map(|classes| {
            let mut kept = [false; 256];
            classes.iter().for_each(|&class| kept[usize::from(class)] = true);
            kept
        });
        let lines = self.options.lines.as_ref().map(|lines| lines.iter().copied().collect::<BTreeSet<u16>>());
        let times = self.options.dates.map(|[first, last]| [gps_time_of(first, 0), gps_time_of(last, 1)]);
        let selection = Selection { place, classes, lines, times };
        let chooses = selection.place.is_some() || selection.chooses_by_attribute();
        chooses.then_some(selection)
    }
}

/// Selection of the points of a file.
pub(crate) struct Selection {
    place: Option<SelectedBox>,
    classes: Option<[bool; 256]>,
    lines: Option<BTreeSet<u16>>,
    /// First GPS time, and the one that is too late, less 10⁹ s.
    times: Option<[f64; 2]>,
}

/// GPS time at the beginning of a day, so many days later, as files have it: less 10⁹ s.
fn gps_time_of(day: CalendarDay, later: i64) -> f64 {
    (unix_day(day) + later) as f64 * 86_400.0 - ADJUSTED_GPS_EPOCH
}

enum SelectedBox {
    File { low: [f64; 3], high: [f64; 3] },
    Local { bounds: Bounds, origin: [f64; 3], units: [f64; 3] },
}

/// Minimum widening of a box in local coordinates when files are searched for it, metres.
const MIN_BOX_ROOM: f64 = 1e-3;

/// Points that a selection passed over.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PassedOver {
    outside: usize,
    other_class: usize,
    other_line: usize,
    other_date: usize,
}

impl PassedOver {
    /// Counts points that need not even be looked at, because their piece of the file lies outside.
    #[cfg(feature = "las")]
    pub(crate) fn count_outside(&mut self, count: u64) {
        self.outside = self.outside.saturating_add(usize::try_from(count).unwrap_or(usize::MAX));
    }

    /// Their numbers, each with the reason.
    pub(crate) fn counts(self) -> [(usize, &'static str); 4] {
        [
            (self.outside, "outside the box to read"),
            (self.other_class, "of a class that is not read"),
            (self.other_line, "of a flight line that is not read"),
            (self.other_date, "of a date that is not read"),
        ]
    }
}

/// A box in the coordinates of a file that holds every point of a selection.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FileBox {
    low: [f64; 3],
    high: [f64; 3],
}

impl FileBox {
    /// Returns true if the box from `low` to `high` shares a point with this one.
    pub(crate) fn meets(&self, low: [f64; 3], high: [f64; 3]) -> bool {
        (0..3).all(|i| low[i] <= self.high[i] && self.low[i] <= high[i])
    }
}

impl Selection {
    /// A box that every point of the selection lies in; `None` where points are not chosen by their place.
    pub(crate) fn file_box(&self) -> Option<FileBox> {
        match self.place.as_ref()? {
            SelectedBox::File { low, high } => Some(FileBox { low: *low, high: *high }),
            SelectedBox::Local { bounds, origin, units } => {
                // local positions are rounded to f32 before they are compared
                let room = |v: f32| MIN_BOX_ROOM + f64::from(v.abs()) * f64::from(f32::EPSILON);
                let file = |i: usize, v: f64| (v + origin[i]) / units[i];
                Some(FileBox {
                    low: std::array::from_fn(|i| file(i, f64::from(bounds.low[i]) - room(bounds.low[i]))),
                    high: std::array::from_fn(|i| file(i, f64::from(bounds.high[i]) + room(bounds.high[i]))),
                })
            }
        }
    }

    fn chooses_by_attribute(&self) -> bool {
        self.classes.is_some() || self.lines.is_some() || self.times.is_some()
    }

    /// Refuses points without the attributes that they are chosen by.
    fn check(&self, attributes: &Attributes) -> Result<()> {
        let is_dated = attributes.gps_time.is_some() && attributes.gps_time_kind == GpsTimeKind::AdjustedStandard;
        let lacking = [
            (
                self.classes.is_some() && attributes.classification.is_none(),
                ("classification", "reading some classes only", "read all points, or classify them first"),
            ),
            (
                self.lines.is_some() && attributes.point_source_id.is_none(),
                ("point source ids", "reading some flight lines only", "read all points, or files with these ids"),
            ),
            (
                self.times.is_some() && !is_dated,
                (
                    "GPS times that tell the day",
                    "reading some dates only",
                    "read all points, or choose by flight lines",
                ),
            ),
        ];
        match lacking.into_iter().find(|(lacks, _)| *lacks) {
            Some((_, (attribute, needed_for, advice))) => {
                Err(Error::MissingAttribute { attribute, needed_for, advice })
            }
            None => Ok(()),
        }
    }

    fn holds(&self, p: [f64; 3]) -> bool {
        match &self.place {
            None => true,
            Some(SelectedBox::File { low, high }) => (0..3).all(|i| low[i] <= p[i] && p[i] <= high[i]),
            Some(SelectedBox::Local { bounds, origin, units }) => {
                bounds.contains(to_local(std::array::from_fn(|i| p[i] * units[i]), *origin))
            }
        }
    }

    /// Indices of the points that are read; the others are counted in `passed_over`.
    ///
    /// # Errors
    /// [`Error::MissingAttribute`] where classes, lines or dates are requested but the points have none.
    pub(crate) fn select(
        &self,
        coordinates: &Coordinates,
        attributes: &Attributes,
        passed_over: &mut PassedOver,
    ) -> Result<Vec<u32>> {
        if coordinates.len() > 0 {
            self.check(attributes)?;
        }
        let mut kept = Vec::new();
        for (index, position) in (0_u32..).zip(coordinates.positions()) {
            let class = attributes.classification.as_ref().and_then(|classes| classes.get(index as usize));
            if !self.holds(position) {
                passed_over.outside += 1;
            } else if let (Some(classes), Some(&class)) = (&self.classes, class)
                && !classes[usize::from(class)]
            {
                passed_over.other_class += 1;
            } else if let (Some(lines), Some(of_points)) = (&self.lines, &attributes.point_source_id)
                && !of_points.get(index as usize).is_some_and(|line| lines.contains(line))
            {
                passed_over.other_line += 1;
            } else if let (Some([from, to]), Some(of_points)) = (self.times, &attributes.gps_time)
                && !of_points.get(index as usize).is_some_and(|time| (from..to).contains(time))
            {
                passed_over.other_date += 1;
            } else {
                kept.push(index);
            }
        }
        Ok(kept)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The rows that options choose of three points of lines 1, 2 and 2 on three days.
    fn chosen(options: &ReadOptions, kind: GpsTimeKind) -> Result<Vec<u32>> {
        // GPS times of 29 April 2025, 22:30; of the same night, 0:30; and of 1 May
        let day = 86_400.0;
        let first = 1_745_965_800.0 - ADJUSTED_GPS_EPOCH;
        let attributes = Attributes {
            gps_time: Some(vec![first, first + day / 12.0, first + 1.5 * day]),
            gps_time_kind: kind,
            point_source_id: Some(vec![1, 2, 2]),
            ..Attributes::default()
        };
        let control = Control::none();
        let selection = Reading { options, forced: None, control: &control }.selection(&Crs::default());
        let coordinates = Coordinates::Real(vec![[0.0; 3]; 3]);
        let Some(selection) = selection else { return Ok(vec![0, 1, 2]) };
        selection.select(&coordinates, &attributes, &mut PassedOver::default())
    }

    #[test]
    fn lines_and_dates_choose_points() {
        let chosen_of = |options: ReadOptions| chosen(&options, GpsTimeKind::AdjustedStandard).unwrap();
        let day = |month, day| CalendarDay { year: 2025, month, day };
        assert_eq!(chosen_of(ReadOptions::new()), [0, 1, 2]);
        assert_eq!(chosen_of(ReadOptions::new().with_lines([2, 7])), [1, 2]);
        assert_eq!(chosen_of(ReadOptions::new().with_dates([day(4, 29); 2])), [0]);
        assert_eq!(chosen_of(ReadOptions::new().with_dates([day(4, 30), day(5, 31)])), [1, 2]);
        assert_eq!(chosen_of(ReadOptions::new().with_lines([2]).with_dates([day(4, 30); 2])), [1]);
        // seconds of a week have no date
        let dated = ReadOptions::new().with_dates([day(4, 29); 2]);
        assert!(matches!(chosen(&dated, GpsTimeKind::SecondsOfWeek), Err(Error::MissingAttribute { .. })));
        assert_eq!(chosen(&ReadOptions::new().with_lines([1]), GpsTimeKind::SecondsOfWeek).unwrap(), [0]);
    }
}
