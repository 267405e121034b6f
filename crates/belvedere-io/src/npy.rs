//! NumPy arrays of coordinates, (N, 3) or wider, f32 or f64, either order and byte order.

use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use npyz::{NpyFile, Order};

use super::part::{Coordinates, Part, guarded, open};
use belvedere_data::{Error, Result};

/// Headers that NumPy writes have some hundred bytes.
const MAX_HEADER: u32 = 1 << 16;

/// The first three columns of the array at `path` as coordinates.
pub(super) fn read(path: &Path) -> Result<Part> {
    let (rows, kind) = read_rows(path)?;
    let mut part = Part::new(path, format!("NPY, {} columns of {}", rows.width, kind));
    if rows.width > 3 {
        part.note(format!("columns dropped: all after the third of {}", rows.width));
    }
    part.single_precision = kind == "f32";
    part.coordinates = Coordinates::Real(rows.rows);
    Ok(part)
}

/// The first three columns of an array, and how many it has.
pub(super) struct Table {
    pub(super) rows: Vec<[f64; 3]>,
    pub(super) width: usize,
}

/// Reads an (N, 3) or wider array of f32 or f64; gives its type too.
pub(super) fn read_rows(path: &Path) -> Result<(Table, &'static str)> {
    let (mut file, size) = open(path)?;
    check_header_length(path, &mut file)?;
    guarded(path, || {
        let array = NpyFile::new(file).map_err(|e| Error::malformed(path, format!("is not a NumPy array: {e}")))?;
        let shape = array.shape().to_vec();
        let (Some(&count), Some(&width), 2) = (shape.first(), shape.get(1), shape.len()) else {
            return Err(Error::malformed(path, format!("has shape {shape:?}, but (N, 3) is needed")));
        };
        // One byte per number is the least an array can take.
        if width < 3 || count.checked_mul(width).is_none_or(|numbers| numbers > size) {
            let what = format!("has shape {shape:?}, which is no (N, 3) array that fits in its {size} bytes");
            return Err(Error::malformed(path, what));
        }
        let layout = Layout {
            count: usize::try_from(count).unwrap_or(0),
            width: usize::try_from(width).unwrap_or(0),
            order: array.order(),
        };
        match array.try_data::<f64>() {
            Ok(numbers) => Ok((layout.collect(path, numbers)?, "f64")),
            Err(array) => match array.try_data::<f32>() {
                Ok(numbers) => Ok((layout.collect(path, numbers.map(|v| v.map(f64::from)))?, "f32")),
                Err(array) => {
                    let what = format!("holds numbers of type {}, but f32 or f64 are needed", array.dtype().descr());
                    Err(Error::malformed(path, what))
                }
            },
        }
    })
}

struct Layout {
    count: usize,
    width: usize,
    order: Order,
}

impl Layout {
    fn collect(self, path: &Path, numbers: impl Iterator<Item = std::io::Result<f64>>) -> Result<Table> {
        let cut = |e: std::io::Error| Error::malformed(path, format!("ends within its numbers: {e}"));
        let mut rows = vec![[0.0; 3]; self.count];
        for (i, number) in numbers.enumerate() {
            let (row, column) = match self.order {
                Order::C => (i / self.width, i % self.width),
                Order::Fortran => (i % self.count, i / self.count),
            };
            let number = number.map_err(cut)?;
            if let Some(place) = rows.get_mut(row).and_then(|row| row.get_mut(column)) {
                *place = number;
            }
        }
        Ok(Table { rows, width: self.width })
    }
}

/// The npyz crate allocates the length of the header as written.
fn check_header_length(path: &Path, file: &mut BufReader<File>) -> Result<()> {
    let mut start = Vec::new();
    file.take(12).read_to_end(&mut start).map_err(Error::io(path))?;
    let long = start.get(6).is_some_and(|&version| version >= 2);
    let length = start.get(8..).and_then(|rest| rest.first_chunk()).map(|&bytes| u32::from_le_bytes(bytes));
    if !start.starts_with(b"\x93NUMPY") || (long && length.is_none_or(|length| length > MAX_HEADER)) {
        return Err(Error::malformed(path, "is not a NumPy array: its header is damaged"));
    }
    file.seek(SeekFrom::Start(0)).map_err(Error::io(path))?;
    Ok(())
}
