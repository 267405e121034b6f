//! Files of what places see of directions, kept for later questions about the same places.

use std::io::{self, Seek, Write};
use std::path::Path;
use zip::{ZipArchive, ZipWriter};

use crate::npz_arrays::{array, begin_array, in_blocks, open, rows, values, write_archive};
use crate::output::Output;
use crate::source::{Input, Source, SourceReader};
use belvedere_data::{Error, Parameter, Result};

/// Bits in a word.
const WORD: usize = 64;

/// Rows read or checked at a time: a few megabytes.
const ROWS: usize = 8192;

/// What the bits of a matrix are about.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MatrixHead {
    /// Where local (0, 0, 0) lies, metres.
    pub origin: [f64; 3],
    /// Targets, (M, 3), local metres; NaN where there is none.
    pub targets: Vec<[f32; 3]>,
    /// Directions, (D, 3), unit vectors in the axes of the grid.
    pub directions: Vec<[f64; 3]>,
    /// What the scene was: a number that differs where balls or their parameters differ.
    pub scene: u64,
}

impl MatrixHead {
    /// Words of 64 bits of a row.
    #[must_use]
    pub fn words_of_row(&self) -> usize {
        self.directions.len().div_ceil(WORD)
    }

    fn check_directions(&self) -> Result<()> {
        let is_unit = |d: &[f64; 3]| (belvedere_data::vector::length(*d) - 1.0).abs() < 1e-6;
        if let Some(bad) = self.directions.iter().find(|d| !is_unit(d)) {
            let value = format!("{bad:?}");
            return Err(Error::InvalidParameter {
                parameter: Parameter::Direction,
                value,
                expected: "a vector of length 1",
            });
        }
        Ok(())
    }

    /// Checks whole rows.
    fn check_rows(&self, words: &[u64]) -> Result<()> {
        let (width, last) = (self.words_of_row(), self.directions.len() % WORD);
        let beyond = if last == 0 { 0 } else { u64::MAX << last };
        if width > 0 && words.chunks(width).any(|row| row.last().is_some_and(|word| word & beyond != 0)) {
            let value = "marked beyond the last".to_owned();
            return Err(Error::InvalidParameter {
                parameter: Parameter::Direction,
                value,
                expected: "one that there is",
            });
        }
        Ok(())
    }

    fn check_count(&self, found: usize) -> Result<()> {
        let expected = self.targets.len().saturating_mul(self.words_of_row());
        if expected == found {
            return Ok(());
        }
        Err(Error::LengthMismatch { what: "words of the matrix", expected, found })
    }
}

/// Bits for targets and directions as a file holds them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SavedMatrix {
    /// What the bits are about.
    pub head: MatrixHead,
    /// Bits, row after row, each of as many words of 64 as hold a bit for each direction, lowest first: 1 where the
    /// target sees the sky. Bits beyond the last direction are 0.
    pub words: Vec<u64>,
}

impl SavedMatrix {
    /// Whether the parts fit each other.
    ///
    /// # Errors
    /// [`Error::LengthMismatch`] where they do not, [`Error::InvalidParameter`] for directions that are not of unit
    /// length.
    pub fn validate(&self) -> Result<()> {
        self.head.check_count(self.words.len())?;
        self.head.check_directions()?;
        self.head.check_rows(&self.words)
    }
}

/// Takes rows of a matrix, whole ones, in the order of the targets.
pub type RowSink<'a> = dyn FnMut(&[u64]) -> Result<()> + 'a;

/// Writes a matrix as a NumPy archive with the arrays `bits` (M, W) u64, `directions` (D, 3), `targets` (M, 3),
/// `origin` (3) and `scene` (1).
///
/// # Errors
/// [`Error::Io`], and those of [`SavedMatrix::validate`].
pub fn write_matrix<'a>(output: impl Into<Output<'a>>, matrix: &SavedMatrix) -> Result<()> {
    matrix.validate()?;
    write_matrix_rows(output, &matrix.head, |sink| sink(&matrix.words))
}

/// Writes the same with rows that `rows` hands to a sink as it makes them, so that the bits are never held all at once.
/// The file appears once all rows are there.
///
/// # Errors
/// [`Error::Io`], those of `rows`, [`Error::LengthMismatch`] unless there is a row for each target, and
/// [`Error::InvalidParameter`] for directions that are not of unit length and for bits beyond the last.
pub fn write_matrix_rows<'a>(
    output: impl Into<Output<'a>>,
    head: &MatrixHead,
    rows: impl FnOnce(&mut RowSink<'_>) -> Result<()>,
) -> Result<()> {
    head.check_directions()?;
    let [m, d] = [head.targets.len(), head.directions.len()].map(|n| n as u64);
    output.into().write(|path, output| {
        let written = write_archive(output, |archive| {
            let mut bits = begin_array(archive, "bits", &[m, d.div_ceil(WORD as u64)])?;
            let mut count = 0;
            rows(&mut |words| {
                head.check_rows(words)?;
                count += words.len();
                bits.extend(words.iter().copied()).map_err(Error::io(path))
            })
            .map_err(RowsStopped::BySink)?;
            head.check_count(count).map_err(RowsStopped::BySink)?;
            bits.finish()?;
            Ok(write_head(archive, head)?)
        });
        written.map_err(|stopped| match stopped {
            RowsStopped::ByFile(error) => Error::io(path)(error),
            RowsStopped::BySink(error) => error,
        })
    })
}

fn write_head<W: Write + Seek>(archive: &mut ZipWriter<W>, head: &MatrixHead) -> io::Result<()> {
    let [m, d] = [head.targets.len(), head.directions.len()].map(|n| n as u64);
    array(archive, "directions", &[d, 3], head.directions.iter().flatten().copied())?;
    array(archive, "targets", &[m, 3], head.targets.iter().flatten().copied())?;
    array(archive, "origin", &[3], head.origin.into_iter())?;
    array(archive, "scene", &[1], [head.scene].into_iter())
}

fn unreadable(path: &Path) -> impl Fn(io::Error) -> Error + '_ {
    move |e| Error::malformed(path, format!("damaged, or not a visibility matrix: {e}"))
}

fn damaged(path: &Path) -> impl Fn(Error) -> Error + '_ {
    move |e| Error::malformed(path, format!("damaged: {e}"))
}

/// Reads what [`write_matrix`] wrote, but for its bits.
///
/// # Errors
/// [`Error::Io`] where the file cannot be read, [`Error::Malformed`] for files that are damaged or hold something else.
pub fn read_matrix_head<'a>(source: impl Into<Source<'a>>) -> Result<MatrixHead> {
    let Input { name, reader, size } = source.into().open()?;
    let mut archive = open(reader, size).map_err(unreadable(&name))?;
    head_of(&name, &mut archive)
}

fn head_of(path: &Path, archive: &mut ZipArchive<SourceReader<'_>>) -> Result<MatrixHead> {
    let mut read = || -> io::Result<MatrixHead> {
        let one = |values: Vec<u64>| values.first().copied().unwrap_or(0);
        let origin = values::<f64, _>(archive, "origin", 3)?.0;
        let origin = <[f64; 3]>::try_from(origin).map_err(|_| io::Error::other("origin must have 3 numbers"))?;
        Ok(MatrixHead {
            origin,
            targets: rows::<f32, 3, _>(archive, "targets")?,
            directions: rows::<f64, 3, _>(archive, "directions")?,
            scene: one(values(archive, "scene", 1)?.0),
        })
    };
    let head = read().map_err(unreadable(path))?;
    head.check_directions().map_err(damaged(path))?;
    Ok(head)
}

/// Why rows were read or written no further.
enum RowsStopped {
    ByFile(io::Error),
    BySink(Error),
}

impl From<io::Error> for RowsStopped {
    fn from(error: io::Error) -> Self {
        Self::ByFile(error)
    }
}

impl From<Error> for RowsStopped {
    fn from(error: Error) -> Self {
        Self::BySink(error)
    }
}

/// Reads the bits of a file whose `head` was read, and hands some whole rows at a time to `sink`, in the order of the
/// targets.
///
/// # Errors
/// Those of [`read_matrix_head`] and of `sink`.
pub fn read_matrix_rows<'a>(
    source: impl Into<Source<'a>>,
    head: &MatrixHead,
    sink: impl FnMut(&[u64]) -> Result<()>,
) -> Result<()> {
    let Input { name, reader, size } = source.into().open()?;
    let mut archive = open(reader, size).map_err(unreadable(&name))?;
    rows_of(&name, &mut archive, head, sink)
}

fn rows_of(
    path: &Path,
    archive: &mut ZipArchive<SourceReader<'_>>,
    head: &MatrixHead,
    mut sink: impl FnMut(&[u64]) -> Result<()>,
) -> Result<()> {
    let max = ROWS * head.words_of_row().max(1);
    let mut count = 0;
    let read = in_blocks(archive, "bits", max, |words: &[u64]| {
        count += words.len();
        if count > head.targets.len().saturating_mul(head.words_of_row()) {
            head.check_count(count).map_err(damaged(path))?;
        }
        head.check_rows(words).map_err(damaged(path))?;
        sink(words).map_err(RowsStopped::BySink)
    });
    match read {
        Ok(()) => {}
        Err(RowsStopped::ByFile(error)) => return Err(unreadable(path)(error)),
        Err(RowsStopped::BySink(error)) => return Err(error),
    }
    head.check_count(count).map_err(damaged(path))
}

/// Reads what [`write_matrix`] wrote.
///
/// # Errors
/// Those of [`read_matrix_head`].
pub fn read_matrix<'a>(source: impl Into<Source<'a>>) -> Result<SavedMatrix> {
    let Input { name, reader, size } = source.into().open()?;
    let mut archive = open(reader, size).map_err(unreadable(&name))?;
    let head = head_of(&name, &mut archive)?;
    let mut words = Vec::new();
    rows_of(&name, &mut archive, &head, |rows| {
        words.extend_from_slice(rows);
        Ok(())
    })?;
    Ok(SavedMatrix { head, words })
}
