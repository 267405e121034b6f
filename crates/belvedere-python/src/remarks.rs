//! Remarks of questions as Python has them.

use belvedere::apps::ask::{Remark, Severity};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Remarks in Python.
pub(crate) type Remarks<'py> = Vec<Bound<'py, PyDict>>;

/// All remarks.
pub(crate) fn remarks_of<'a, 'py>(
    py: Python<'py>,
    remarks: impl IntoIterator<Item = &'a Remark>,
) -> PyResult<Remarks<'py>> {
    remarks.into_iter().map(|remark| remark_of(py, remark)).collect()
}

/// A remark: key, severity, text and numbers.
fn remark_of<'py>(py: Python<'py>, remark: &Remark) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("key", remark.key)?;
    dict.set_item("severity", if remark.severity == Severity::Warning { "warning" } else { "note" })?;
    dict.set_item("text", &remark.text)?;
    let numbers = PyDict::new(py);
    for (name, number) in &remark.numbers {
        numbers.set_item(name, number)?;
    }
    dict.set_item("numbers", numbers)?;
    Ok(dict)
}
