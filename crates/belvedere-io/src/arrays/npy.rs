//! NumPy arrays of coordinates, (N, 3) or wider, f32 or f64, either order and byte order.

use std::path::Path;

use npyz::{NpyFile, Order};

use crate::arrays::header::read_header;
use crate::files::source::Input;
use crate::points::coordinates::Coordinates;
use crate::points::file_part::FilePart;
use belvedere_data::{Error, Result};

/// The first three columns of the array as coordinates.
pub(crate) fn read(input: Input<'_>) -> Result<FilePart> {
    let path = input.name.clone();
    let (rows, kind) = read_rows(input)?;
    let mut part = FilePart::new(&path, format!("NPY, {} columns of {}", rows.width, kind));
    if rows.width > 3 {
        part.note(format!("columns ignored: all after the third of {}", rows.width));
    }
    part.single_precision = kind == "f32";
    part.coordinates = Coordinates::Real(rows.rows);
    Ok(part)
}

/// The first three columns of an array, and how many it has.
pub(crate) struct NpyTable {
    pub(crate) rows: Vec<[f64; 3]>,
    pub(crate) width: usize,
}

/// Reads an (N, 3) or wider array of f32 or f64; gives its type too.
pub(crate) fn read_rows(input: Input<'_>) -> Result<(NpyTable, &'static str)> {
    let Input { name, mut reader, size } = input;
    let path = name.as_path();
    let header = read_header(&mut reader).map_err(|e| Error::malformed(path, format!("is not a NumPy array: {e}")))?;
    let array = NpyFile::with_header(header, reader);
    let shape = array.shape().to_vec();
    let (Some(&count), Some(&width), 2) = (shape.first(), shape.get(1), shape.len()) else {
        return Err(Error::malformed(path, format!("has shape {shape:?}, but (N, 3) is needed")));
    };
    // Four bytes a number is the least that is read.
    if width < 3 || count.checked_mul(width).and_then(|numbers| numbers.checked_mul(4)).is_none_or(|min| min > size) {
        let what = format!("has shape {shape:?}, which is not an (N, 3) array that fits in its {size} bytes");
        return Err(Error::malformed(path, what));
    }
    let layout = ArrayLayout {
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
}

struct ArrayLayout {
    count: usize,
    width: usize,
    order: Order,
}

impl ArrayLayout {
    fn collect(self, path: &Path, numbers: impl Iterator<Item = std::io::Result<f64>>) -> Result<NpyTable> {
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
        Ok(NpyTable { rows, width: self.width })
    }
}
