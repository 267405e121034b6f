//! Files of what places see of directions, kept for later questions about the same places.

use std::fs::File;
use std::io::{self, BufReader, Seek, Write};
use std::path::Path;

use npyz::npz::{NpzArchive, NpzWriter};

use crate::atomic;
use crate::npz_arrays::{array, rows, values};
use belvedere_data::{Error, Result};

/// Bits in a word.
const WORD: usize = 64;

/// Bits for targets and directions as a file holds them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SavedMatrix {
    /// Where local (0, 0, 0) lies, metres.
    pub origin: [f64; 3],
    /// Targets, (M, 3), local metres; NaN where there is none.
    pub targets: Vec<[f32; 3]>,
    /// Directions, (D, 3), unit vectors in the axes of the grid.
    pub directions: Vec<[f64; 3]>,
    /// Bits, row after row, each of as many words of 64 as hold a bit for each direction, lowest first: 1 where the target sees the
    /// sky. Bits beyond the last direction are 0.
    pub words: Vec<u64>,
    /// What the scene was: a number that differs where balls or their parameters differ.
    pub scene: u64,
}

impl SavedMatrix {
    /// Whether the parts fit each other.
    ///
    /// # Errors
    /// [`Error::LengthMismatch`] where they do not, [`Error::InvalidParameter`] for directions that are not of unit length.
    pub fn validate(&self) -> Result<()> {
        let width = self.directions.len().div_ceil(WORD);
        let (expected, found) = (self.targets.len().saturating_mul(width), self.words.len());
        if expected != found {
            return Err(Error::LengthMismatch { what: "words of the matrix", expected, found });
        }
        let is_unit = |d: &[f64; 3]| (belvedere_data::vector::length(*d) - 1.0).abs() < 1e-6;
        if let Some(bad) = self.directions.iter().find(|d| !is_unit(d)) {
            let value = format!("{bad:?}");
            return Err(Error::InvalidParameter { name: "direction", value, expected: "a vector of length 1" });
        }
        let last = self.directions.len() % WORD;
        let beyond = if last == 0 { 0 } else { u64::MAX << last };
        if width > 0 && self.words.chunks(width).any(|row| row.last().is_some_and(|word| word & beyond != 0)) {
            let value = "1".to_owned();
            return Err(Error::InvalidParameter { name: "bit beyond the last direction", value, expected: "0" });
        }
        Ok(())
    }
}

/// Writes a matrix as a NumPy archive with the arrays `bits` (M, W) u64, `directions` (D, 3), `targets` (M, 3), `origin` (3) and `scene` (1).
///
/// # Errors
/// [`Error::Io`], and those of [`SavedMatrix::validate`].
pub fn write_matrix(path: &Path, matrix: &SavedMatrix) -> Result<()> {
    matrix.validate()?;
    atomic::write(path, |output| write_arrays(&mut NpzWriter::new(output), matrix).map_err(Error::io(path)))
}

fn write_arrays<W: Write + Seek>(archive: &mut NpzWriter<W>, matrix: &SavedMatrix) -> io::Result<()> {
    let [m, d] = [matrix.targets.len(), matrix.directions.len()].map(|n| n as u64);
    array(archive, "bits", &[m, d.div_ceil(WORD as u64)], matrix.words.iter().copied())?;
    array(archive, "directions", &[d, 3], matrix.directions.iter().flatten().copied())?;
    array(archive, "targets", &[m, 3], matrix.targets.iter().flatten().copied())?;
    array(archive, "origin", &[3], matrix.origin.into_iter())?;
    array(archive, "scene", &[1], [matrix.scene].into_iter())?;
    archive.zip_writer().finish()?.flush()
}

/// Reads what [`write_matrix`] wrote.
///
/// # Errors
/// [`Error::Io`] where the file cannot be read, [`Error::Malformed`] for files that are damaged or hold something else.
pub fn read_matrix(path: &Path) -> Result<SavedMatrix> {
    let file = BufReader::new(File::open(path).map_err(Error::io(path))?);
    let read = || -> io::Result<SavedMatrix> {
        let mut archive = NpzArchive::new(file)?;
        let one = |values: Vec<u64>| values.first().copied().unwrap_or(0);
        let origin = values::<f64, _>(&mut archive, "origin", 3)?.0;
        let origin = <[f64; 3]>::try_from(origin).map_err(|_| io::Error::other("origin must have 3 numbers"))?;
        Ok(SavedMatrix {
            origin,
            targets: rows::<f32, 3, _>(&mut archive, "targets")?,
            directions: rows::<f64, 3, _>(&mut archive, "directions")?,
            words: values(&mut archive, "bits", u64::MAX)?.0,
            scene: one(values(&mut archive, "scene", 1)?.0),
        })
    };
    let matrix = read().map_err(|e| Error::malformed(path, format!("not a file of what places see: {e}")))?;
    matrix.validate().map_err(|e| Error::malformed(path, format!("damaged: {e}")))?;
    Ok(matrix)
}
