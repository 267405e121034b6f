//! Coordinate reference systems as Python carries them.

use crate::errors::{exception, wrong};
use belvedere::crs::{Crs, CrsKind};
use pyo3::prelude::*;

/// A coordinate reference system with its units.
#[pyclass(frozen, eq, from_py_object, module = "belvedere._core", name = "Crs")]
#[derive(Clone, PartialEq)]
pub(crate) struct System(pub(crate) Crs);

/// State of a system, for pickling.
type CrsState = (Option<String>, Option<u32>, Option<u32>, f64, f64, u8, Option<String>);

const KINDS: [CrsKind; 5] =
    [CrsKind::Unknown, CrsKind::Projected, CrsKind::Geographic, CrsKind::Geocentric, CrsKind::Local];

#[pymethods]
impl System {
    /// The system that a text names.
    #[new]
    fn new(text: &str) -> PyResult<Self> {
        Crs::parse(text).map(Self).map_err(exception)
    }

    #[staticmethod]
    fn from_state(state: CrsState) -> PyResult<Self> {
        let (wkt, epsg, vertical_epsg, metres_per_unit, vertical_metres_per_unit, kind, doubt) = state;
        let Some(&kind) = KINDS.get(usize::from(kind)) else {
            return Err(wrong("kind of reference system", &kind.to_string(), "unpickle with the version that pickled"));
        };
        Ok(Self(Crs { wkt, epsg, vertical_epsg, metres_per_unit, vertical_metres_per_unit, kind, doubt }))
    }

    #[getter]
    fn state(&self) -> CrsState {
        let Crs { wkt, epsg, vertical_epsg, metres_per_unit, vertical_metres_per_unit, kind, doubt } = self.0.clone();
        let kind = (0..).zip(KINDS).find(|(_, known)| *known == kind).map_or(0, |(number, _)| number);
        (wkt, epsg, vertical_epsg, metres_per_unit, vertical_metres_per_unit, kind, doubt)
    }

    /// Well-known text, or `EPSG:CODE`, or nothing where no system is known.
    #[getter]
    fn text(&self) -> Option<String> {
        self.0.definition()
    }

    #[getter]
    fn description(&self) -> String {
        self.0.describe()
    }

    #[getter]
    fn metres_per_unit(&self) -> f64 {
        self.0.metres_per_unit
    }
}
