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
pub(crate) enum PositionArray<'py> {
    Double(PyReadonlyArray2<'py, f64>),
    Single(PyReadonlyArray2<'py, f32>),
}

impl PositionArray<'_> {
    /// The rows as local positions, in one pass and without a copy between.
    ///
    /// # Errors
    /// As [`PositionArray::rows`].
    pub(crate) fn local(&self, what: &str, frame: &Frame) -> PyResult<Vec<[f32; 3]>> {
        let positions = match self {
            Self::Double(array) => converted(array, what, |row| frame.from_file_coordinates(row)),
            Self::Single(array) => converted(array, what, |row| frame.from_file_coordinates(row.map(f64::from))),
        }?;
        check_finite(&positions, what)?;
        Ok(positions)
    }

    /// The rows as numbers of 64 bits.
    ///
    /// # Errors
    /// Unless there are three columns of finite numbers; `what` names the argument.
    pub(crate) fn rows(&self, what: &str) -> PyResult<Vec<[f64; 3]>> {
        match self {
            Self::Double(array) => converted(array, what, |row| row),
            Self::Single(array) => converted(array, what, |row| row.map(f64::from)),
        }
        .and_then(|rows| check_finite(&rows, what).map(|()| rows))
    }
}

/// Each row of three columns by a rule.
fn converted<T: Element + Copy + Sync, R: Send>(
    array: &PyReadonlyArray2<'_, T>,
    what: &str,
    rule: impl Fn([T; 3]) -> R + Sync,
) -> PyResult<Vec<R>> {
    let view = array.as_array();
    if view.ncols() != 3 {
        let shape = format!("an array of shape ({}, {})", view.nrows(), view.ncols());
        return Err(wrong(what, &shape, "give x, y and z in three columns, shape (N, 3)"));
    }
    let row = |i: usize| rule([view[[i, 0]], view[[i, 1]], view[[i, 2]]]);
    Ok(match view.as_slice() {
        Some(slice) => slice.as_chunks::<3>().0.par_iter().with_min_len(CHUNK).map(|&row| rule(row)).collect(),
        None => (0..view.nrows()).into_par_iter().with_min_len(CHUNK).map(row).collect(),
    })
}

fn check_finite<T: Copy + Into<f64> + Sync>(rows: &[[T; 3]], what: &str) -> PyResult<()> {
    let is_finite = |row: &[T; 3]| row.iter().all(|&v| v.into().is_finite());
    match rows.par_iter().with_min_len(CHUNK).position_first(|row| !is_finite(row)) {
        None => Ok(()),
        Some(at) => Err(wrong(what, &format!("not finite in row {at}"), "remove rows that are not finite numbers")),
    }
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
