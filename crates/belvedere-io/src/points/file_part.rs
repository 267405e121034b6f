//! Contents of one file, before all files of a cloud get a common origin.

use std::path::Path;

use crate::files::source::SystemBeside;
use crate::points::coordinates::Coordinates;
use crate::points::read_options::{PassedOver, Reading};
use crate::points::read_report::{FileReport, LeftOut};
use crate::points::sky::Skies;
use belvedere_data::Result;
use belvedere_data::cloud::Attributes;
use belvedere_data::contradiction::{FoundContradiction, RETURN_NUMBERS};
use belvedere_data::crs::evidence::Comparison;
use belvedere_data::crs::{Crs, CrsKind};
use belvedere_data::vector::to_f32;

/// GPS times are of no use to order pulses when a file of more points than this has only [`FEW_TIMES`] of them.
const MANY_POINTS: usize = 1000;
const FEW_TIMES: usize = 16;

/// Single precision that steps further than this, in metres, is worth a warning: finer steps drown in scanner noise.
pub(crate) const COARSE_STEP: f64 = 0.002;

/// The points of one file in the unit of the file.
#[derive(Debug, Default)]
pub(crate) struct FilePart {
    pub(crate) coordinates: Coordinates,
    pub(crate) attributes: Attributes,
    /// Scanner positions that `attributes.scanner_index` refers to.
    pub(crate) scanners: Vec<[f64; 3]>,
    /// Regions of these set-ups in which pulses met nothing up to the sky.
    pub(crate) skies: Skies,
    pub(crate) crs: Crs,
    /// Why the file names no system that is known; `None` where it names one.
    pub(crate) unnamed: Option<Unnamed>,
    /// A position of the file, in its unit, where one is known before its points are read.
    pub(crate) somewhere: Option<[f64; 3]>,
    /// Row of each point in the file where they are wanted and differ from 0, 1, 2 …
    pub(crate) rows: Option<Vec<u64>>,
    /// Number of points of the file where `rows`, or else 0, 1, 2 … are the rows of its points; `None` where these are
    /// not known.
    pub(crate) row_count: Option<u64>,
    /// Attributes of its points beside `attributes`, in words.
    pub(crate) other_attributes: Vec<String>,
    /// Records of its header that are not understood here, in words.
    pub(crate) records: Vec<String>,
    /// True if the file keeps its coordinates as f32.
    pub(crate) single_precision: bool,
    pub(crate) report: FileReport,
}

/// Why a file names no system that is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Unnamed {
    /// No record names one.
    Missing,
    /// Its well-known text cannot be read.
    Unreadable,
}

impl FilePart {
    pub(crate) fn new(path: &Path, format: impl Into<String>) -> Self {
        let report = FileReport { path: path.to_owned(), format: format.into(), ..FileReport::default() };
        Self { report, ..Self::default() }
    }

    pub(crate) fn note(&mut self, text: impl Into<String>) {
        self.report.notes.push(text.into());
    }

    pub(crate) fn contradict(&mut self, found: FoundContradiction) {
        self.report.contradictions.push(found);
    }

    /// Counts points that were in the file but are not in the part.
    pub(crate) fn leave_out(&mut self, count: usize, reason: impl Into<String>) {
        if count > 0 {
            self.report.left_out.push(LeftOut { count, reason: reason.into() });
        }
    }

    /// Counts points that the header announces but a file that is cut off lacks.
    pub(crate) fn leave_out_missing(&mut self, count: u64) {
        self.report.missing_points = usize::try_from(count).unwrap_or(usize::MAX);
        self.leave_out(self.report.missing_points, "announced by the header but not in the file");
    }

    /// Takes `crs` as the system of the file, found in `source`.
    pub(crate) fn set_crs(&mut self, crs: Crs, source: impl Into<String>) {
        self.report.crs = crs.describe();
        self.report.crs_source = source.into();
        self.crs = crs;
    }

    /// Takes the system beside a file where the file names none, and doubts that of the file where it says something
    /// else of the place `somewhere`.
    pub(crate) fn take_system(&mut self, beside: Option<SystemBeside>, somewhere: [f64; 2]) {
        match beside {
            Some(SystemBeside::Known { crs, found_in }) if self.crs.kind == CrsKind::Unknown => {
                self.set_crs(crs, found_in);
            }
            Some(SystemBeside::Known { crs, found_in }) => match crs.compare(&self.crs, somewhere) {
                Comparison::Apart(how) => {
                    let (own, other) = (self.crs.describe(), crs.describe());
                    let what =
                        format!("the file names {own}, but {found_in} beside it {other} ({how}); the first is used");
                    self.crs = self.crs.clone().doubted(what);
                }
                Comparison::Same | Comparison::Unknown => self.crs = self.crs.clone().with_heights_of(&crs),
            },
            Some(SystemBeside::Unreadable { found_in }) if self.crs.kind == CrsKind::Unknown => {
                self.note(format!("{found_in} beside it names no system that is known"));
            }
            Some(SystemBeside::Unreadable { .. }) | None => {}
        }
    }

    /// Turns a part whose y is up: positions, normals, scanners and directions (x, y, z) become (x, −z, y).
    pub(crate) fn turn_y_up(&mut self) {
        self.row_count = None;
        self.coordinates = Coordinates::Real(self.coordinates.positions().map(|[x, y, z]| [x, -z, y]).collect());
        self.scanners.iter_mut().for_each(|p| *p = [p[0], -p[2], p[1]]);
        self.attributes.normals.iter_mut().flatten().for_each(|n| *n = [n[0], -n[2], n[1]]);
        self.skies.turn_y_up();
    }

    /// Notes that the file names no system, as far as no other source does: an option and other files say theirs.
    pub(crate) fn note_unnamed(&mut self) {
        let is_known = self.crs.kind != CrsKind::Unknown;
        match self.unnamed.take() {
            Some(Unnamed::Missing) if !is_known => {
                self.note("it names no reference system; coordinates are taken as metres");
            }
            Some(Unnamed::Unreadable) if !is_known => {
                self.note("its WKT record is not readable; coordinates are taken as metres");
            }
            Some(Unnamed::Unreadable) => {
                let used = self.crs.describe();
                self.note(format!("its WKT record is not readable; {used} is used"));
            }
            Some(Unnamed::Missing) | None => {}
        }
    }

    /// Drops the points that `reading` does not ask for.
    ///
    /// # Errors
    /// [`belvedere_data::Error::MissingAttribute`] where classes are requested but the file has none.
    pub(crate) fn keep_selected(&mut self, reading: &Reading<'_>) -> Result<()> {
        let Some(selection) = reading.selection(&self.crs) else { return Ok(()) };
        let mut passed_over = PassedOver::default();
        let kept = selection.select(&self.coordinates, &self.attributes, &mut passed_over)?;
        self.keep(&kept);
        self.leave_out_passed(passed_over);
        Ok(())
    }

    /// Counts the points that a selection passed over in the report.
    pub(crate) fn leave_out_passed(&mut self, passed_over: PassedOver) {
        passed_over.counts().into_iter().for_each(|(count, reason)| self.leave_out(count, reason));
    }

    /// Keeps the points at `indices` only.
    pub(crate) fn keep(&mut self, indices: &[u32]) {
        if indices.len() == self.coordinates.len() {
            return;
        }
        self.rows = Some(match &self.rows {
            Some(rows) => indices.iter().filter_map(|&i| rows.get(i as usize).copied()).collect(),
            None => indices.iter().copied().map(u64::from).collect(),
        });
        self.coordinates = self.coordinates.select(indices);
        self.attributes = self.attributes.select(indices);
    }

    /// Checks the attributes for values that would mislead later stages. Drops GPS times that are all zero, makes
    /// normals unit or zero, widens 8-bit colours to 16 bits, and notes impossible times and returns.
    pub(crate) fn check_attributes(&mut self) {
        self.check_gps_times();
        let attributes = &mut self.attributes;
        let mut notes = Vec::new();
        if let (Some(numbers), Some(counts)) = (&attributes.return_number, &attributes.return_count) {
            let zero = numbers.iter().filter(|&&n| n == 0).count();
            let beyond = numbers.iter().zip(counts).filter(|&(n, count)| n > count).count();
            if zero > 0 {
                notes.push(format!("{zero} points have return number 0"));
            }
            if beyond > 0 {
                let text = format!("{beyond} points have a return number above their number of returns");
                let share = beyond as f64 / numbers.len() as f64;
                if RETURN_NUMBERS.is_exceeded_by(share) {
                    let text = format!("{text}: their pulses are not known, and prove nothing");
                    self.report.contradictions.push(RETURN_NUMBERS.found(text).with("points", beyond as f64));
                } else {
                    notes.push(text);
                }
            }
        }
        if let Some(normals) = &mut attributes.normals {
            let absent = make_unit(normals);
            if absent > 0 {
                notes.push(format!("{absent} points have no usable normal; it is set to (0, 0, 0)"));
            }
        }
        if let Some(colors) = &mut attributes.color {
            let highest = colors.as_flattened().iter().copied().max().unwrap_or(0);
            if (1..=255).contains(&highest) {
                colors.as_flattened_mut().iter_mut().for_each(|value| *value *= 257);
                notes.push("8-bit colours were widened to 16 bits".to_owned());
            }
        }
        self.report.notes.append(&mut notes);
        self.report.attributes = self.attributes.columns().into_iter().map(|(name, _)| name).collect();
    }

    /// Returns true if no point has a colour other than black.
    pub(crate) fn is_black(&self) -> bool {
        self.attributes.color.iter().flatten().flatten().all(|&value| value == 0)
    }

    /// Drops colours, all of which are black.
    pub(crate) fn drop_black(&mut self) {
        let Some(colors) = self.attributes.color.take() else { return };
        if !colors.is_empty() {
            self.note("all colours are zero, so the file has none");
        }
        self.report.attributes.retain(|name| *name != "color");
    }

    fn check_gps_times(&mut self) {
        let Some(times) = &mut self.attributes.gps_time else { return };
        let (count, zero) = (times.len(), times.iter().filter(|&&t| t == 0.0).count());
        if zero == count {
            self.attributes.gps_time = None;
            if count > 0 {
                self.note("all GPS times are zero, so the file has none");
            }
            return;
        }
        let not_finite = times.iter().filter(|t| !t.is_finite()).count();
        let mut distinct: Vec<f64> = Vec::new();
        for &time in times.iter() {
            if distinct.len() > FEW_TIMES {
                break;
            }
            if !distinct.contains(&time) {
                distinct.push(time);
            }
        }
        if zero > 0 {
            self.note(format!("{zero} of {count} GPS times are zero"));
        }
        if not_finite > 0 {
            self.note(format!("{not_finite} GPS times are not finite"));
        }
        if count > MANY_POINTS && distinct.len() <= FEW_TIMES {
            self.note(format!("GPS times have only {} different values, which cannot separate pulses", distinct.len()));
        }
    }

    /// Notes where single precision has thrown away more than scanner noise.
    pub(crate) fn check_precision(&mut self) {
        let Coordinates::Real(values) = &self.coordinates else { return };
        if !self.single_precision {
            return;
        }
        let units = self.crs.metres_per_unit_xyz();
        let mut step = 0.0_f64;
        for p in values {
            for (v, unit) in p.iter().zip(units) {
                if v.is_finite() {
                    step = step.max(single_step(*v) * unit);
                }
            }
        }
        if step <= COARSE_STEP {
            return;
        }
        let mut bits: Vec<[u64; 3]> = values.iter().map(|p| p.map(f64::to_bits)).collect();
        bits.sort_unstable();
        bits.dedup();
        let repeated = values.len() - bits.len();
        self.note(format!(
            "coordinates have single precision, with steps of up to {step} m here; {repeated} points coincide with another point. Export again with an offset or in double precision"
        ));
    }
}

/// Step of single precision at a coordinate, in its unit.
pub(crate) fn single_step(coordinate: f64) -> f64 {
    if coordinate == 0.0 { 0.0 } else { (coordinate.abs().log2().floor() - 23.0).exp2() }
}

/// Scales `normals` to unit length where they are not within a thousandth of it; those without a direction become zero
/// and are counted.
fn make_unit(normals: &mut [[f32; 3]]) -> usize {
    let mut absent = 0;
    for n in normals {
        let length = n.iter().map(|&c| f64::from(c) * f64::from(c)).sum::<f64>().sqrt();
        if !length.is_finite() || length == 0.0 {
            *n = [0.0; 3];
            absent += 1;
        } else if (length - 1.0).abs() > 1e-3 {
            *n = n.map(|c| to_f32(f64::from(c) / length));
        }
    }
    absent
}
