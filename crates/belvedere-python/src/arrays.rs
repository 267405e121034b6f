//! Arrays of numpy as columns of the library.

use crate::errors::wrong;
use belvedere::Frame;
use numpy::{Element, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2, ToPyArray};
use pyo3::prelude::*;
use rayon::prelude::*;

/// Rows handed to a thread at once.
const CHUNK: usize = 1 << 14;

/// Places, (N, 3), in the coordinates and unit of the file, 32 or 64 bit, with any strides.
#[derive(FromPyObject)]
pub(crate) enum Places<'py> {
    Double(PyReadonlyArray2<'py, f64>),
    Single(PyReadonlyArray2<'py, f32>),
}

impl Places<'_> {
    /// The rows as numbers of 64 bits.
    ///
    /// # Errors
    /// Unless there are three columns of finite numbers; `what` names the argument.
    pub(crate) fn rows(&self, what: &str) -> PyResult<Vec<[f64; 3]>> {
        match self {
            Self::Double(array) => rows(array, what, |v| v),
            Self::Single(array) => rows(array, what, f64::from),
        }
    }
}

fn rows<T: Element + Copy + Sync>(
    array: &PyReadonlyArray2<'_, T>,
    what: &str,
    to_f64: impl Fn(T) -> f64 + Sync,
) -> PyResult<Vec<[f64; 3]>> {
    let view = array.as_array();
    if view.ncols() != 3 {
        let shape = format!("an array of shape ({}, {})", view.nrows(), view.ncols());
        return Err(wrong(what, &shape, "give x, y and z in three columns, shape (N, 3)"));
    }
    let row = |i: usize| [to_f64(view[[i, 0]]), to_f64(view[[i, 1]]), to_f64(view[[i, 2]])];
    let rows: Vec<[f64; 3]> = match view.as_slice() {
        Some(slice) => {
            let place = |row: &[T; 3]| row.map(&to_f64);
            slice.as_chunks::<3>().0.par_iter().with_min_len(CHUNK).map(place).collect()
        }
        None => (0..view.nrows()).into_par_iter().with_min_len(CHUNK).map(row).collect(),
    };
    match rows.par_iter().position_first(|row| !row.iter().all(|v| v.is_finite())) {
        None => Ok(rows),
        Some(at) => Err(wrong(what, &format!("{:?} in row {at}", rows[at]), "remove rows that are not finite numbers")),
    }
}

/// Local positions of places of the file.
pub(crate) fn local(frame: &Frame, places: &[[f64; 3]]) -> Vec<[f32; 3]> {
    places.par_iter().with_min_len(CHUNK).map(|&place| frame.from_file_coordinates(place)).collect()
}

/// The values of a column; a copy, because the work does not hold the interpreter.
pub(crate) fn column<T: Element + Copy>(array: &PyReadonlyArray1<'_, T>) -> Vec<T> {
    array.as_array().iter().copied().collect()
}

/// Rows of a fixed number of values, (N, K).
pub(crate) fn fixed_rows<const K: usize, T: Element + Copy>(
    array: &PyReadonlyArray2<'_, T>,
    what: &str,
) -> PyResult<Vec<[T; K]>> {
    let view = array.as_array();
    if view.ncols() != K {
        let shape = format!("an array of shape ({}, {})", view.nrows(), view.ncols());
        return Err(wrong(what, &shape, &format!("give {K} columns")));
    }
    Ok(view.rows().into_iter().map(|row| std::array::from_fn(|i| row[i])).collect())
}

/// Rows as an array, (N, K).
pub(crate) fn to_2d<'py, const K: usize, T: Element + Copy>(
    py: Python<'py>,
    rows: &[[T; K]],
) -> PyResult<Bound<'py, PyArray2<T>>> {
    rows.as_flattened().to_pyarray(py).reshape([rows.len(), K])
}

/// A column as an array that takes the memory over.
pub(crate) fn to_1d<T: Element>(py: Python<'_>, values: Vec<T>) -> Bound<'_, PyArray1<T>> {
    PyArray1::from_vec(py, values)
}
