//! Triangle meshes: targets, landmarks and planned buildings.

use crate::arrays::{column, fixed_rows, to_1d, to_2d};
use crate::cloud::PyInput;
use crate::errors::{exception, wrong};
use crate::result_columns::to_python;
use crate::system::System;
use crate::work::run;
use belvedere::apps::ask;
use belvedere::apps::targets::{Facing, MeshParams};
use belvedere::io::read_mesh;
use belvedere::results::FaceRows;
use numpy::{PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;
use std::sync::Arc;

/// A triangle mesh in the unit of its reference system.
#[pyclass(frozen, module = "belvedere._core", name = "Mesh")]
pub(crate) struct PyMesh {
    mesh: Arc<belvedere::Mesh>,
    /// Its file, or its name in messages.
    pub(crate) name: PathBuf,
}

#[pymethods]
impl PyMesh {
    #[new]
    fn new(
        vertices: PyReadonlyArray2<'_, f64>,
        triangles: PyReadonlyArray2<'_, u32>,
        objects: PyReadonlyArray1<'_, u32>,
        object_names: Vec<String>,
        crs: Option<System>,
    ) -> PyResult<Self> {
        let vertices: Vec<[f64; 3]> = fixed_rows(&vertices, "vertices")?;
        let triangles: Vec<[u32; 3]> = fixed_rows(&triangles, "triangles")?;
        let objects = column(&objects);
        if triangles.is_empty() {
            return Err(wrong("triangles", "an array without rows", "give at least one triangle"));
        }
        if let Some(row) = vertices.iter().position(|vertex| vertex.iter().any(|v| !v.is_finite())) {
            return Err(wrong("vertices", &format!("not finite in row {row}"), "give finite numbers"));
        }
        let count = vertices.len();
        if let Some(row) = triangles.iter().position(|triangle| triangle.iter().any(|&v| v as usize >= count)) {
            let value = format!("out of range in row {row}");
            return Err(wrong("triangles", &value, &format!("give rows of the {count} vertices, counted from 0")));
        }
        if !objects.is_empty() && objects.len() != triangles.len() {
            let value = format!("an array of {} rows", objects.len());
            return Err(wrong(
                "objects",
                &value,
                &format!("give one of {} rows, one for each triangle", triangles.len()),
            ));
        }
        if objects.iter().any(|&object| object as usize >= object_names.len()) {
            let advice = format!("give rows of the {} object_names, counted from 0", object_names.len());
            return Err(wrong("objects", "out of range", &advice));
        }
        let crs = crs.map_or_else(Default::default, |crs| crs.0);
        let mesh = Arc::new(belvedere::Mesh { vertices, triangles, objects, object_names, crs });
        Ok(Self { mesh, name: PathBuf::from("mesh") })
    }

    /// The mesh of a file.
    #[staticmethod]
    fn read(py: Python<'_>, input: PyInput) -> PyResult<Self> {
        let (mesh, name) =
            run(py, None, move |_| Ok((read_mesh(input.source())?.0, input.source().name().to_owned())))?;
        Ok(Self { mesh: Arc::new(mesh), name })
    }

    #[getter]
    fn vertices<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        to_2d(py, &self.mesh.vertices)
    }

    #[getter]
    fn triangles<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        to_2d(py, &self.mesh.triangles)
    }

    #[getter]
    fn objects<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u32>> {
        to_1d(py, self.mesh.objects.clone())
    }

    #[getter]
    fn object_names(&self) -> Vec<String> {
        self.mesh.object_names.clone()
    }

    #[getter]
    fn crs(&self) -> System {
        System(self.mesh.crs.clone())
    }

    fn __len__(&self) -> usize {
        self.mesh.triangles.len()
    }
}

impl PyMesh {
    /// The mesh in the metres of a scene.
    ///
    /// # Errors
    /// [`belvedere::Error::UnusableCrs`] for another reference system than that of the scene.
    pub(crate) fn in_metres(&self, inner: &ask::Scene) -> belvedere::Result<belvedere::Mesh> {
        let crs = &inner.frame().crs;
        self.mesh.crs.check_for(crs, "mesh", &self.name)?;
        Ok((*self.mesh).clone().scaled_to_metres(crs))
    }

    /// The same of these objects alone, of all where none is named.
    ///
    /// # Errors
    /// Those of [`Mesh::in_metres`], and [`belvedere::Error::InvalidParameter`] for an object that the mesh does not
    /// have.
    pub(crate) fn objects_in_metres(
        &self,
        objects: &[String],
        inner: &ask::Scene,
    ) -> belvedere::Result<belvedere::Mesh> {
        let mesh = self.in_metres(inner)?;
        if let Some(missing) = objects.iter().find(|name| !mesh.object_names.contains(name)) {
            return Err(belvedere::Error::InvalidParameter {
                parameter: belvedere::Parameter::Object,
                value: format!("'{missing}'"),
                expected: "the name of an object of the mesh",
            });
        }
        Ok(if objects.is_empty() { mesh } else { mesh.of_objects(objects) })
    }
}

/// The faces of a mesh as targets.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Faces {
    mesh: Py<PyMesh>,
    spacing: Option<f64>,
    seed: u64,
    is_level: bool,
}

impl Faces {
    /// The mesh in the metres of a scene, and how it is sampled.
    pub(crate) fn owned(&self, inner: &ask::Scene) -> PyResult<(Arc<belvedere::Mesh>, MeshParams)> {
        let mesh = self.mesh.get().in_metres(inner).map_err(exception)?;
        let facing = if self.is_level { Facing::Level } else { Facing::Normals };
        let params = MeshParams::default().with_seed(self.seed).with_facing(facing);
        let params = self.spacing.map_or(params, |spacing| params.with_spacing(spacing));
        Ok((Arc::new(mesh), params))
    }
}

/// The rows of faces as Python takes them.
pub(crate) fn rows_of<'py>(py: Python<'py>, rows: FaceRows<'_>) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("object_count", rows.object_count)?;
    dict.set_item("object", rows.objects)?;
    let columns = PyDict::new(py);
    for (name, values) in to_python(py, rows.columns)? {
        columns.set_item(name, values)?;
    }
    dict.set_item("columns", columns)?;
    Ok(dict)
}
