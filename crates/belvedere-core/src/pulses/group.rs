//! Returns that share a laser pulse.

use belvedere_data::cast::to_row;
use std::cmp::Ordering;

use rayon::prelude::*;

use belvedere_data::control::Control;
use belvedere_data::{Error, PointCloud, Result};

/// Maximum number of points of one time, line and channel: LAS counts returns to 15, and two full pulses in one tick of
/// a clock do not occur.
const MAX_PER_TIME: usize = 15;
/// Times between two looks at whether to go on.
const CHECK_EACH: usize = 4096;

/// Returns grouped by pulse. Pulses are ordered by flight line, channel and time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pulses {
    /// Rows of the cloud, the returns of a pulse side by side in order of their numbers.
    pub returns: Vec<u32>,
    /// First index of each pulse in `returns`, (P + 1).
    pub offsets: Vec<u32>,
    /// GPS time of each pulse, (P), seconds as in the cloud.
    pub times: Vec<f64>,
    /// Flight line of each pulse, (P); 0 where the cloud names none.
    pub source_ids: Vec<u16>,
    /// True if return number 1 is present, (P).
    first_present: Vec<bool>,
    /// True if the last return, by the count of returns, is present, (P).
    last_present: Vec<bool>,
}

/// Counts of points by outcome of the grouping. The counts of points left out and those of [`Pulses::returns`] add up
/// to all points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PulseReport {
    /// Points in all.
    pub point_count: usize,
    /// Pulses found.
    pub pulse_count: usize,
    /// Pulses of which more than one return is there.
    pub multi_return_count: usize,
    /// Pulses of which a return is missing: outside the tile, or taken out as noise.
    pub incomplete_count: usize,
    /// Points left out because their time is zero or not finite: written by a program, not by a scanner.
    pub without_time_count: usize,
    /// Points left out because another has the same time, return number and position.
    pub duplicate_count: usize,
    /// Points left out because their time belongs to several pulses that cannot be distinguished.
    pub ambiguous_count: usize,
}

/// Groups the returns of `cloud` by flight line, scanner channel and GPS time.
///
/// Pulses of the same time are distinguished by their number of returns; single returns are a pulse each. Points that
/// cannot be assigned to one pulse are left out and counted. A cloud of ground-based scans, whose times belong to a
/// single point each, gives a pulse for each point.
///
/// # Errors
/// [`Error::MissingAttribute`] without GPS times or return numbers, or where no pulse at all can be distinguished from
/// another because times are missing or too coarse. [`Error::LengthMismatch`] for a column of another length than the
/// positions. [`Error::Cancelled`].
pub fn group(cloud: &PointCloud, control: &Control<'_>) -> Result<(Pulses, PulseReport)> {
    cloud.validate()?;
    let attributes = &cloud.attributes;
    let missing = |attribute| Error::MissingAttribute {
        attribute,
        needed_for: "grouping returns into pulses",
        advice: "use the cloud as delivered by the survey, before a program dropped or rounded its columns",
    };
    let times = attributes.gps_time.as_deref().ok_or_else(|| missing("GPS time"))?;
    let numbers = attributes.return_number.as_deref().ok_or_else(|| missing("return number"))?;
    let lines = attributes.point_source_id.as_deref();
    let channels = attributes.scanner_channel.as_deref();
    let counts = attributes.return_count.as_deref();
    let column = |row: usize| {
        let line = lines.and_then(|lines| lines.get(row)).copied().unwrap_or(0);
        let channel = channels.and_then(|channels| channels.get(row)).copied().unwrap_or(0);
        (line, channel)
    };
    let mut report = PulseReport { point_count: cloud.len(), ..PulseReport::default() };
    let mut keys: Vec<SortKey> = (0_u32..)
        .zip(times.iter().zip(numbers))
        .filter(|(_, (time, _))| time.is_finite() && **time != 0.0)
        .map(|(row, (&time, &number))| {
            let count = counts.and_then(|counts| counts.get(row as usize)).copied().unwrap_or(number);
            // a count below the number says nothing
            SortKey { shot: column(row as usize), time, count: count.max(number), number, row }
        })
        .collect();
    report.without_time_count = cloud.len() - keys.len();
    control.check()?;
    keys.par_sort_unstable_by(SortKey::compare);

    let mut pulses = Pulses { offsets: vec![0], ..Pulses::default() };
    for (number, mut same_time) in keys.chunk_by(SortKey::same_time).map(<[SortKey]>::to_vec).enumerate() {
        if number % CHECK_EACH == 0 {
            control.check()?;
        }
        let place = |key: &SortKey| cloud.positions.get(key.row as usize);
        let count = same_time.len();
        same_time.dedup_by(|later, earlier| later.same_return(earlier) && place(later) == place(earlier));
        report.duplicate_count += count - same_time.len();
        if same_time.len() > MAX_PER_TIME {
            report.ambiguous_count += same_time.len();
            continue;
        }
        // clocks tick nearly as slowly as scanners shoot: two pulses of one tick are distinguished by their return
        // counts
        for same_count in same_time.chunk_by(|a, b| a.count == b.count && a.count > 1) {
            if same_count.windows(2).any(|pair| pair[0].number == pair[1].number) {
                report.ambiguous_count += same_count.len();
            } else {
                pulses.add(same_count, &mut report);
            }
        }
    }
    if pulses.is_empty() && !cloud.is_empty() {
        return Err(missing("GPS time with enough digits to separate pulses"));
    }
    Ok((pulses, report))
}

/// Sort key of points.
#[derive(Clone, Copy)]
struct SortKey {
    /// Flight line and channel.
    shot: (u16, u8),
    time: f64,
    /// Returns that the pulse had.
    count: u8,
    number: u8,
    row: u32,
}

impl SortKey {
    fn compare(&self, other: &Self) -> Ordering {
        let rest = |key: &Self| (key.count, key.number, key.row);
        self.shot.cmp(&other.shot).then(self.time.total_cmp(&other.time)).then_with(|| rest(self).cmp(&rest(other)))
    }

    fn same_time(&self, other: &Self) -> bool {
        self.shot == other.shot && self.time.total_cmp(&other.time).is_eq()
    }

    fn same_return(&self, other: &Self) -> bool {
        (self.count, self.number) == (other.count, other.number)
    }
}

impl Pulses {
    /// A pulse for each of `count` points, the only return of it: of scanners that measure one return and write no
    /// times.
    #[must_use]
    pub fn of_points(count: u32) -> Self {
        let each = count as usize;
        Self {
            returns: (0..count).collect(),
            offsets: (0..=count).collect(),
            times: vec![0.0; each],
            source_ids: vec![0; each],
            first_present: vec![true; each],
            last_present: vec![true; each],
        }
    }

    /// Adds the pulse of `returns`, at least one, in order of their numbers.
    fn add(&mut self, returns: &[SortKey], report: &mut PulseReport) {
        let (Some(first), Some(last)) = (returns.first(), returns.last()) else { return };
        self.returns.extend(returns.iter().map(|key| key.row));
        self.times.push(first.time);
        self.source_ids.push(first.shot.0);
        self.first_present.push(first.number <= 1);
        self.last_present.push(last.number >= last.count);
        self.offsets.push(to_row(self.returns.len()));
        report.pulse_count += 1;
        report.multi_return_count += usize::from(returns.len() > 1);
        report.incomplete_count += usize::from(returns.len() < usize::from(last.count));
    }

    /// Number of pulses.
    #[must_use]
    pub fn len(&self) -> usize {
        self.times.len()
    }

    /// Returns true if there is no pulse.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.times.is_empty()
    }

    /// Rows of the returns of pulse number `pulse` in order of their numbers; none for a number out of range.
    #[must_use]
    pub fn returns_of(&self, pulse: usize) -> &[u32] {
        let bounds = self.offsets.get(pulse).zip(self.offsets.get(pulse + 1));
        bounds.and_then(|(&from, &to)| self.returns.get(from as usize..to as usize)).unwrap_or_default()
    }

    /// Row of the return numbered 1, before which nothing was hit; `None` where it is missing.
    #[must_use]
    pub fn first_return(&self, pulse: usize) -> Option<u32> {
        self.first_present.get(pulse)?.then(|| self.returns_of(pulse).first().copied())?
    }

    /// Row of the last return that the pulse had; `None` where it is missing.
    #[must_use]
    pub fn last_return(&self, pulse: usize) -> Option<u32> {
        self.last_present.get(pulse)?.then(|| self.returns_of(pulse).last().copied())?
    }
}
