//! Columns of results for Python.

use crate::arrays::to_1d;
use belvedere::apps::result_columns::{ResultColumn, ResultValues};
use pyo3::prelude::*;
use pyo3::types::PyList;

/// Names and values of columns.
pub(crate) type NamedColumns<'py> = Vec<(String, Bound<'py, PyAny>)>;

/// The columns as arrays and lists of words.
pub(crate) fn to_python<'py>(py: Python<'py>, columns: Vec<ResultColumn>) -> PyResult<NamedColumns<'py>> {
    let values = |values: ResultValues| match values {
        ResultValues::Real(values, _) | ResultValues::Clock(values) => Ok::<_, PyErr>(to_1d(py, values).into_any()),
        // numbers count from 1
        ResultValues::Whole(values) => {
            let values = values.into_iter().map(|v| v.and_then(|v| i64::try_from(v).ok()).unwrap_or(0)).collect();
            Ok(to_1d::<i64>(py, values).into_any())
        }
        ResultValues::Words(words) => Ok(PyList::new(py, words)?.into_any()),
    };
    columns.into_iter().map(|column| Ok((column.name, values(column.values)?))).collect()
}
