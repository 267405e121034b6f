//! What one file gave, before all files of a cloud get a common origin.

use std::fs::File;
use std::io::BufReader;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use super::read_cloud::{FileReport, LeftOut};
use belvedere_data::cloud::Attributes;
use belvedere_data::crs::Crs;
use belvedere_data::{Error, Result};

/// GPS times are of no use to order pulses when a file of more points than this has only [`FEW_TIMES`] of them.
const MANY_POINTS: usize = 1000;
const FEW_TIMES: usize = 16;

/// Single precision that steps further than this, in metres, is worth a warning: finer steps drown in scanner noise.
const COARSE_STEP: f64 = 0.002;

/// The points of one file in the unit of the file.
#[derive(Debug, Default)]
pub(super) struct Part {
    pub(super) coordinates: Coordinates,
    pub(super) attributes: Attributes,
    /// Scanner positions that `attributes.scanner_index` refers to.
    pub(super) scanners: Vec<[f64; 3]>,
    pub(super) crs: Crs,
    /// Whether the file keeps its coordinates as f32.
    pub(super) single_precision: bool,
    pub(super) report: FileReport,
}

/// Coordinates as a file keeps them.
#[derive(Debug)]
pub(super) enum Coordinates {
    /// `values × scale + offset`: half the memory of f64, and nothing is rounded before the origin is known.
    Quantised { values: Vec<[i32; 3]>, scale: [f64; 3], offset: [f64; 3] },
    /// Plain numbers.
    Real(Vec<[f64; 3]>),
}

impl Default for Coordinates {
    fn default() -> Self {
        Self::Real(Vec::new())
    }
}

impl Coordinates {
    pub(super) fn len(&self) -> usize {
        match self {
            Self::Quantised { values, .. } => values.len(),
            Self::Real(values) => values.len(),
        }
    }
}

impl Part {
    pub(super) fn new(path: &Path, format: impl Into<String>) -> Self {
        let report = FileReport { path: path.to_owned(), format: format.into(), ..FileReport::default() };
        Self { report, ..Self::default() }
    }

    pub(super) fn note(&mut self, text: impl Into<String>) {
        self.report.notes.push(text.into());
    }

    /// Counts points that were in the file but are not in the part.
    pub(super) fn leave_out(&mut self, count: usize, reason: impl Into<String>) {
        if count > 0 {
            self.report.left_out.push(LeftOut { count, reason: reason.into() });
        }
    }

    /// Takes `crs` as the system of the file, found in `source`.
    pub(super) fn set_crs(&mut self, crs: Crs, source: impl Into<String>) {
        self.report.crs = crs.describe();
        self.report.crs_source = source.into();
        self.crs = crs;
    }

    /// Looks over the attributes for what would mislead later stages: drops GPS times that are all zero, makes normals
    /// unit or zero, widens 8-bit colours to 16 bits, notes times and returns that cannot be right.
    pub(super) fn check_attributes(&mut self) {
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
                notes.push(format!("{beyond} points have a return number above their number of returns"));
            }
        }
        if let Some(normals) = &mut attributes.normals {
            let absent = make_unit(normals);
            if absent > 0 {
                notes.push(format!("{absent} points have no usable normal; theirs is (0, 0, 0)"));
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

    fn check_gps_times(&mut self) {
        let Some(times) = &mut self.attributes.gps_time else { return };
        let (count, zero) = (times.len(), times.iter().filter(|&&t| t == 0.0).count());
        if zero == count {
            self.attributes.gps_time = None;
            if count > 0 {
                self.note("every GPS time is zero: the file has none");
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
            self.note(format!("GPS times take only {} values: pulses cannot be told apart by them", distinct.len()));
        }
    }

    /// Notes where single precision has thrown away more than scanner noise.
    pub(super) fn check_precision(&mut self) {
        let Coordinates::Real(values) = &self.coordinates else { return };
        if !self.single_precision {
            return;
        }
        let units = self.crs.metres_per_unit_xyz();
        let mut step = 0.0_f64;
        for p in values {
            for (v, unit) in p.iter().zip(units) {
                if v.is_finite() && *v != 0.0 {
                    step = step.max((v.abs().log2().floor() - 23.0).exp2() * unit);
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
            "coordinates are kept in single precision, which steps by up to {step} m here; {repeated} points fall on \
             another one. Export again with an offset or in double precision"
        ));
    }
}

/// Scales `normals` to unit length where they are not within a thousandth of it; what has no direction becomes zero
/// and is counted.
fn make_unit(normals: &mut [[f32; 3]]) -> usize {
    let mut absent = 0;
    for n in normals {
        let length = n.iter().map(|&c| f64::from(c) * f64::from(c)).sum::<f64>().sqrt();
        if !length.is_finite() || length == 0.0 {
            *n = [0.0; 3];
            absent += 1;
        } else if (length - 1.0).abs() > 1e-3 {
            *n = n.map(|c| narrow(f64::from(c) / length));
        }
    }
    absent
}

/// f64 to f32.
#[expect(clippy::cast_possible_truncation, reason = "rounding to the nearest f32 is meant")]
pub(super) fn narrow(value: f64) -> f32 {
    value as f32
}

/// A number of a file as u8: rounded, clamped to the range, zero for NaN.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "float casts saturate, which is meant")]
pub(super) fn to_u8(value: f64) -> u8 {
    value.round() as u8
}

/// A number of a file as u16: rounded, clamped to the range, zero for NaN.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "float casts saturate, which is meant")]
pub(super) fn to_u16(value: f64) -> u16 {
    value.round() as u16
}

/// Opens a file; gives its size too.
pub(super) fn open(path: &Path) -> Result<(BufReader<File>, u64)> {
    let file = File::open(path).map_err(Error::io(path))?;
    let metadata = file.metadata().map_err(Error::io(path))?;
    if !metadata.is_file() {
        return Err(Error::malformed(path, "is not a file"));
    }
    Ok((BufReader::with_capacity(1 << 16, file), metadata.len()))
}

/// Runs `read`, a call into a crate that can panic on damaged bytes, and makes such a panic an error about `path`.
pub(super) fn guarded<T>(path: &Path, read: impl FnOnce() -> Result<T>) -> Result<T> {
    // What `read` borrows is dropped with the error, so nothing half-changed is seen afterwards.
    catch_unwind(AssertUnwindSafe(read))
        .unwrap_or_else(|_| Err(Error::malformed(path, "the content is damaged: it cannot be decoded")))
}
