//! Ball files: medial balls saved for later runs and for other programs.

use std::collections::BTreeMap;
use std::path::Path;

use crate::ball_formats;
use crate::write_cloud::extension;
use belvedere_data::{Bounds, Error, Frame, Result};

/// Extensions of ball files.
pub(crate) const SUPPORTED: &str = ".npz .ply .laz .las";

/// Balls as files hold them, one per row, with what is needed to use them again.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SavedBalls {
    /// Frame of the cloud the balls were made from.
    pub frame: Frame,
    /// Lowest and highest local corner of the points the balls were made from, metres: what a view must hold to show
    /// the scene, whereas the balls may reach far beyond it. Files without it have the corners of the centres.
    pub bounds: Bounds,
    /// Centres, (B, 3), local metres.
    pub centers: Vec<[f32; 3]>,
    /// Radii, (B), metres.
    pub radii: Vec<f32>,
    /// Index of the point each ball is tangent at, (B).
    pub source: Vec<u32>,
    /// Index of the second point each ball touches, `u32::MAX` where it never shrank, (B).
    pub touch: Vec<u32>,
    /// Separation angle in radians, NaN where the ball never shrank, (B).
    pub separation_angles: Vec<f32>,
    /// Share of the pulses that got through the piece of crown that a ball is part of, 0 to 1, NaN where it is part of none, (B),
    /// where that was measured.
    pub transmission: Option<Vec<f32>>,
    /// The pulses that say what is proven visible, where they are known. Only `.npz` files hold them.
    pub pulses: Option<SavedPulses>,
    /// How the balls were made: parameters, version of the program, names of inputs.
    pub provenance: BTreeMap<String, String>,
}

/// The proven-empty lines above first returns, one per row.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SavedPulses {
    /// Lower ends, (P, 3), local metres.
    pub starts: Vec<[f32; 3]>,
    /// Shift to the east and to the north for each metre of height, in steps of 0.0001, (P, 2).
    pub slopes: Vec<[i16; 2]>,
    /// Lengths, (P), metres, infinite for a line that reaches `top`; empty where all do.
    pub lengths: Vec<f32>,
    /// Height that no line rises above, local metres.
    pub top: f32,
}

impl SavedPulses {
    fn validate(&self) -> Result<()> {
        let expected = self.starts.len();
        if self.slopes.len() != expected {
            return Err(Error::LengthMismatch { what: "slopes of pulses", expected, found: self.slopes.len() });
        }
        if !(self.lengths.is_empty() || self.lengths.len() == expected) {
            return Err(Error::LengthMismatch { what: "lengths of pulses", expected, found: self.lengths.len() });
        }
        let invalid = |name, value: String, expected| Err(Error::InvalidParameter { name, value, expected });
        if let Some(start) = self.starts.iter().find(|start| !start.iter().all(|v| v.is_finite())) {
            return invalid("lower end of a pulse", format!("{start:?}"), "finite");
        }
        if let Some(length) = self.lengths.iter().find(|length| !(**length > 0.0)) {
            return invalid("length of a pulse", length.to_string(), "above zero");
        }
        if !self.top.is_finite() {
            return invalid("top of all pulses", self.top.to_string(), "finite");
        }
        Ok(())
    }
}

impl SavedBalls {
    /// Checks that all columns are equally long, centres, bounds and origin finite, radii finite and not negative, shares of
    /// light between 0 and 1, and pulses likewise.
    ///
    /// # Errors
    /// [`Error::LengthMismatch`] or [`Error::InvalidParameter`] for the first fault.
    pub fn validate(&self) -> Result<()> {
        let expected = self.centers.len();
        let lengths = [
            ("radii of balls", self.radii.len()),
            ("source points of balls", self.source.len()),
            ("second points of balls", self.touch.len()),
            ("separation angles of balls", self.separation_angles.len()),
            ("transmissions of balls", self.transmission.as_ref().map_or(expected, Vec::len)),
        ];
        if let Some(&(what, found)) = lengths.iter().find(|&&(_, found)| found != expected) {
            return Err(Error::LengthMismatch { what, expected, found });
        }
        let invalid = |name, value: String, expected| Err(Error::InvalidParameter { name, value, expected });
        if let Some(c) = self.centers.iter().find(|c| c.iter().any(|v| !v.is_finite())) {
            return invalid("centre of a ball", format!("{c:?}"), "finite");
        }
        if let Some(r) = self.radii.iter().find(|&&r| !(r.is_finite() && r >= 0.0)) {
            return invalid("radius of a ball", r.to_string(), "finite and not negative");
        }
        if !self.bounds.is_finite() {
            return invalid("bounds of balls", format!("{:?}", (self.bounds.low, self.bounds.high)), "finite");
        }
        if self.frame.origin.iter().any(|v| !v.is_finite()) {
            return invalid("origin of balls", format!("{:?}", self.frame.origin), "finite");
        }
        if let Some(t) = self.transmission.iter().flatten().find(|t| !(t.is_nan() || (0.0..=1.0).contains(*t))) {
            return invalid("transmission of a ball", t.to_string(), "0 to 1, or NaN");
        }
        self.pulses.as_ref().map_or(Ok(()), SavedPulses::validate)
    }
}

/// Writes `balls` in the format that follows from the extension (.npz .ply .laz .las).
///
/// An `.npz` file keeps every bit: arrays `centers` (B, 3) f32 in metres relative to `origin` (3) f64 metres, `radii` (B)
/// f32 metres, `source` and `touch` (B) u32, `separation_angles` (B) f32 radians, and `metadata`, JSON text as u8, which
/// holds reference system, bounds and provenance; where known also `transmission` (B) f32, and the pulses that prove what
/// is visible: `pulse_starts` (P, 3) f32 metres relative to the origin, `pulse_slopes` (P, 2) i16 in steps of 0.0001,
/// `pulse_top` (1) f32 metres, and `pulse_lengths` (P) f32 metres unless all reach the top: 16 or 20 bytes each.
///
/// `.ply`, `.las` and `.laz` files are point clouds of the centres in the reference system and unit of the cloud (doubles
/// in PLY, steps of at most a millimetre in LAS) with the columns `radius`, in the horizontal unit of the file,
/// `separation_angle` in radians, `source` and `touch`, −1 where a ball never shrank, and `transmission` where that is known.
/// They are for looking at, with the radius as the size of a point, and answer as the balls alone do: they hold no
/// pulses.
///
/// # Errors
/// [`Error::UnknownFormat`] for other extensions, those of [`SavedBalls::validate`], and [`Error::Io`]. An existing file
/// is replaced only by a complete one.
pub fn write_balls(path: &Path, balls: &SavedBalls) -> Result<()> {
    balls.validate()?;
    match extension(path).as_str() {
        "npz" => ball_formats::write_npz(path, balls),
        "ply" => ball_formats::write_ply(path, balls),
        "las" | "laz" => ball_formats::write_las(path, balls),
        _ => unknown(path),
    }
}

/// The balls that [`write_balls`] wrote to `path`.
///
/// Bit for bit from `.npz`; rounded as the format demands from the others, which other programs may have filtered or
/// extended by columns since. Without a saved origin it is chosen near the middle of the centres.
///
/// # Errors
/// [`Error::UnknownFormat`], [`Error::Io`], and [`Error::Malformed`] for a file that is damaged or holds no balls.
pub fn read_balls(path: &Path) -> Result<SavedBalls> {
    let balls = match extension(path).as_str() {
        "npz" => ball_formats::read_npz(path),
        "ply" => ball_formats::read_ply(path),
        "las" | "laz" => ball_formats::read_las(path),
        _ => unknown(path),
    }?;
    balls.validate().map_err(|e| Error::malformed(path, e.to_string()))?;
    Ok(balls)
}

/// Whether `path` holds balls rather than a cloud, judged by its header; `false` also for what cannot be understood.
///
/// # Errors
/// [`Error::Io`] when the file cannot be opened.
pub fn is_ball_file(path: &Path) -> Result<bool> {
    std::fs::File::open(path).map_err(Error::io(path))?;
    Ok(match extension(path).as_str() {
        "npz" => ball_formats::npz_has_balls(path),
        "ply" => ball_formats::ply_has_balls(path),
        "las" | "laz" => ball_formats::las_has_balls(path),
        _ => false,
    })
}

fn unknown<T>(path: &Path) -> Result<T> {
    Err(Error::UnknownFormat { path: path.to_owned(), kind: "ball", supported: SUPPORTED })
}
