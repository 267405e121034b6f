//! Point clouds.

use crate::arrays::{PositionArray, column, fixed_rows, to_1d, to_2d};
use crate::errors::{belvedere_error, exception, wrong};
use crate::remarks::remarks_of;
use crate::system::System;
use crate::work::run;
use belvedere::apps::ask::remark_on_left_out;
use belvedere::cloud::{CloudFile, CloudFiles, FileRows};
use belvedere::io::{ReadOptions, Source, UpAxis, Within, read_cloud, write_cloud};
use belvedere::sky_region::SkyRegion;
use belvedere::weather::CalendarDay;
use belvedere::{Attributes, Frame, GpsTimeKind, PointCloud};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyOSError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use rayon::prelude::*;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Passes the columns of attributes that have a number for each point to a macro.
macro_rules! scalar_columns {
    ($apply:ident) => {
        $apply!(
            classification,
            gps_time,
            return_number,
            return_count,
            scan_angle,
            point_source_id,
            scanner_channel,
            flags,
            intensity,
            scanner_index
        )
    };
}

/// A point cloud.
#[pyclass(frozen, module = "belvedere._core")]
pub(crate) struct Cloud(pub(crate) Arc<PointCloud>);

/// A path, or a name and the bytes of its file, or a file of Python that has them.
#[derive(FromPyObject)]
pub(crate) enum PyInput {
    Bytes(PathBuf, Vec<u8>),
    File(PathBuf, Py<PyAny>),
    Path(PathBuf),
}

impl PyInput {
    pub(crate) fn source(&self) -> Source<'_> {
        match self {
            Self::Path(path) => Source::path(path),
            Self::Bytes(name, bytes) => Source::bytes(name, bytes),
            Self::File(name, file) => Source::reader(name, PythonFile(file)),
        }
    }

    /// Name or path of the file.
    pub(crate) fn name(&self) -> &Path {
        let (Self::Path(name) | Self::Bytes(name, _) | Self::File(name, _)) = self;
        name
    }
}

/// A file of Python, open for reading in binary mode. An exception of it becomes an error of reading.
struct PythonFile<'a>(&'a Py<PyAny>);

impl PythonFile<'_> {
    /// Calls `work`, unless the interpreter is about to end.
    fn call<T>(&self, work: impl FnOnce(&Bound<'_, PyAny>) -> PyResult<T>) -> std::io::Result<T> {
        let called =
            Python::try_attach(|py| work(self.0.bind(py)).map_err(|error| std::io::Error::other(error.to_string())));
        called.unwrap_or_else(|| Err(std::io::Error::other("Python has ended")))
    }
}

impl Read for PythonFile<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        self.call(|file| {
            let bytes = file.call_method1("read", (buffer.len(),))?.cast_into::<PyBytes>()?;
            let bytes = bytes.as_bytes();
            let Some(room) = buffer.get_mut(..bytes.len()) else {
                return Err(PyOSError::new_err(format!("read({}) returned {} bytes", buffer.len(), bytes.len())));
            };
            room.copy_from_slice(bytes);
            Ok(bytes.len())
        })
    }
}

impl Seek for PythonFile<'_> {
    fn seek(&mut self, to: SeekFrom) -> std::io::Result<u64> {
        self.call(|file| {
            let place = match to {
                SeekFrom::Start(offset) => file.call_method1("seek", (offset, 0)),
                SeekFrom::Current(offset) => file.call_method1("seek", (offset, 1)),
                SeekFrom::End(offset) => file.call_method1("seek", (offset, 2)),
            };
            place?.extract()
        })
    }
}

/// The cloud of some inputs, and the report on reading it as JSON.
#[pyfunction]
#[pyo3(signature = (inputs, crs, crs_override, up, skip_distant, bounds, classes, flown, progress))]
#[expect(clippy::too_many_arguments, reason = "keywords in Python")]
pub(crate) fn read(
    py: Python<'_>,
    inputs: Vec<PyInput>,
    crs: Option<String>,
    crs_override: bool,
    up: &str,
    skip_distant: bool,
    bounds: Option<[[f64; 3]; 2]>,
    classes: Option<Vec<u8>>,
    flown: Option<String>,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Cloud, String)> {
    let up = match up {
        "z" => UpAxis::Z,
        "y" => UpAxis::Y,
        _ => return Err(wrong("up", &format!("'{up}'"), "use 'z' or 'y'")),
    };
    let mut options = ReadOptions::new().with_up(up);
    if skip_distant {
        options = options.without_distant_files();
    }
    options.crs = crs;
    if crs_override {
        options = options.insisting_on_crs();
    }
    options.within = bounds.map(|[low, high]| Within::File { low, high });
    options.classes = classes;
    options.flown = match flown {
        Some(text) => {
            let day = CalendarDay::parse(&text);
            Some(day.ok_or_else(|| wrong("flown", &format!("'{text}'"), "give a date such as '2014-02-03'"))?)
        }
        None => None,
    };
    let (cloud, report) = run(py, progress, move |control| {
        let sources = inputs.iter().map(PyInput::source);
        control.stage("reading", 0, || read_cloud(sources, &options, control))
    })?;
    Ok((Cloud(Arc::new(cloud)), json(&report)?))
}

/// A report of the library as JSON.
pub(crate) fn json(report: &impl serde::Serialize) -> PyResult<String> {
    serde_json::to_string(report).map_err(|error| pyo3::exceptions::PyRuntimeError::new_err(error.to_string()))
}

#[pymethods]
impl Cloud {
    /// A cloud from coordinates in the unit of `crs` and columns of attributes.
    #[new]
    #[pyo3(signature = (xyz, attributes, adjusted_gps_time, crs))]
    fn new(
        xyz: PositionArray<'_>,
        attributes: &Bound<'_, PyDict>,
        adjusted_gps_time: bool,
        crs: Option<System>,
    ) -> PyResult<Self> {
        let mut rows = xyz.rows("xyz")?;
        let Some(&first) = rows.first() else {
            return Err(wrong("xyz", "an array without rows", "give at least one point"));
        };
        let crs = crs.map_or_else(Default::default, |crs| crs.0);
        if let Some(refusal) = crs.refusal(first) {
            return Err(belvedere_error(&format!("crs: {refusal}"), "crs", &crs.describe(), &refusal));
        }
        let scale = crs.metres_per_unit_xyz();
        rows.par_iter_mut().for_each(|row| *row = std::array::from_fn(|i| row[i] * scale[i]));
        let (mut cloud, _) = PointCloud::from_coordinates(&rows);
        cloud.frame.crs = crs;
        cloud.attributes = columns(attributes, adjusted_gps_time)?;
        cloud.validate().map_err(exception)?;
        Ok(Self(Arc::new(cloud)))
    }

    #[staticmethod]
    fn from_state(
        origin: [f64; 3],
        positions: PyReadonlyArray2<'_, f32>,
        attributes: &Bound<'_, PyDict>,
        adjusted_gps_time: bool,
        scanners: (PyReadonlyArray2<'_, f32>, Vec<SkyState>),
        crs: System,
        files: FilesState,
    ) -> PyResult<Self> {
        let (scanner_positions, sky_regions) = scanners;
        let cloud = PointCloud {
            frame: Frame { origin, crs: crs.0 },
            positions: fixed_rows(&positions, "positions")?,
            attributes: columns(attributes, adjusted_gps_time)?,
            scanner_positions: fixed_rows(&scanner_positions, "scanner positions")?,
            sky_regions: sky_regions.into_iter().map(sky_region).collect(),
            // only the cloud of a scene has them
            cleared_places: Vec::new(),
            files: files_of(files),
        };
        cloud.validate().map_err(exception)?;
        Ok(Self(Arc::new(cloud)))
    }

    /// The files that the points come from.
    #[getter]
    fn files(&self) -> FilesState {
        let file =
            |file: &CloudFile| (file.path.clone(), file.row_count, file.other_attributes.clone(), file.records.clone());
        let files = self.0.files.files.iter().map(file).collect();
        match &self.0.files.rows {
            FileRows::All => (files, None, true),
            FileRows::Of(rows) => (files, Some(rows.clone()), true),
            FileRows::Unknown => (files, None, false),
        }
    }

    #[getter]
    fn positions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(to_2d(py, &self.0.positions)?.into_any())
    }

    #[getter]
    fn scanner_positions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(to_2d(py, &self.0.scanner_positions)?.into_any())
    }

    /// Returns the regions of the sky that pulses of the scanners saw.
    #[getter]
    fn sky_regions(&self) -> Vec<SkyState> {
        let state = |region: &SkyRegion| {
            let SkyRegion { scanner, range, axes, azimuth, elevation, columns, .. } = *region;
            let is_open = region.is_open.iter().map(|&is_open| u8::from(is_open)).collect();
            (scanner, range, axes, azimuth, elevation, columns, is_open)
        };
        self.0.sky_regions.iter().map(state).collect()
    }

    #[getter]
    fn xyz<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let cloud = Arc::clone(&self.0);
        let to_file = move || -> Vec<[f64; 3]> {
            cloud.positions.par_iter().map(|&position| cloud.frame.to_file_coordinates(position)).collect()
        };
        Ok(to_2d(py, &py.detach(to_file))?.into_any())
    }

    /// The attributes that the cloud has, by name.
    #[getter]
    fn attributes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        let of = &self.0.attributes;
        macro_rules! add {
            ($($name:ident),*) => {$(
                if let Some(values) = &of.$name {
                    dict.set_item(stringify!($name), to_1d(py, values.clone()).into_any())?;
                }
            )*};
        }
        scalar_columns!(add);
        if let Some(values) = &of.normals {
            dict.set_item("normals", to_2d(py, values)?)?;
        }
        if let Some(values) = &of.color {
            dict.set_item("color", to_2d(py, values)?)?;
        }
        Ok(dict)
    }

    #[getter]
    fn adjusted_gps_time(&self) -> bool {
        self.0.attributes.gps_time_kind == GpsTimeKind::AdjustedStandard
    }

    #[getter]
    fn origin(&self) -> [f64; 3] {
        self.0.frame.origin
    }

    #[getter]
    fn crs(&self) -> System {
        System(self.0.frame.crs.clone())
    }

    /// Lowest and highest corner in the coordinates of the file.
    #[getter]
    fn bounds(&self) -> [[f64; 3]; 2] {
        let bounds = self.0.bounds().unwrap_or_default();
        [bounds.low, bounds.high].map(|corner| self.0.frame.to_file_coordinates(corner))
    }

    /// Writes the cloud, and gives the remarks on the columns missing from the file.
    fn write<'py>(&self, py: Python<'py>, path: PathBuf) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let cloud = Arc::clone(&self.0);
        let output = path.clone();
        let report = run(py, None, move |_| write_cloud(&path, &cloud, &[]))?;
        remarks_of(py, &remark_on_left_out(&output, &report.left_out).into_iter().collect::<Vec<_>>())
    }

    fn __len__(&self) -> usize {
        self.0.len()
    }
}

/// Path, number of points, further attributes and records of each file; the rows of the points, unless these are all of
/// them; and whether the rows are known.
type FilesState = (Vec<(PathBuf, u64, Vec<String>, Vec<String>)>, Option<Vec<u64>>, bool);

/// A region of the sky as Python keeps it: scanner, range, axes, azimuth, elevation, columns, open cells.
type SkyState = (u16, f32, [[f64; 3]; 3], [f64; 2], [f64; 2], usize, Vec<u8>);

fn sky_region((scanner, range, axes, azimuth, elevation, columns, is_open): SkyState) -> SkyRegion {
    let is_open = is_open.into_iter().map(|is_open| is_open != 0).collect();
    SkyRegion { scanner, range, axes, azimuth, elevation, columns, is_open }
}

fn files_of((files, rows, is_known): FilesState) -> CloudFiles {
    let file = |(path, row_count, other_attributes, records)| CloudFile { path, row_count, other_attributes, records };
    let rows = match rows {
        _ if !is_known => FileRows::Unknown,
        Some(rows) => FileRows::Of(rows),
        None => FileRows::All,
    };
    CloudFiles { files: files.into_iter().map(file).collect(), rows }
}

/// The columns of a dictionary, whose types Python has made right.
fn columns(given: &Bound<'_, PyDict>, adjusted_gps_time: bool) -> PyResult<Attributes> {
    let mut attributes = Attributes::default();
    if adjusted_gps_time {
        attributes.gps_time_kind = GpsTimeKind::AdjustedStandard;
    }
    for (name, values) in given {
        let name: String = name.extract()?;
        macro_rules! take {
            ($($column:ident),*) => {
                match name.as_str() {
                    $(stringify!($column) => attributes.$column = Some(column(&values.extract::<PyReadonlyArray1<'_, _>>()?)),)*
                    "normals" => attributes.normals = Some(fixed_rows(&values.extract::<PyReadonlyArray2<'_, _>>()?, "normals")?),
                    "color" => attributes.color = Some(fixed_rows(&values.extract::<PyReadonlyArray2<'_, _>>()?, "color")?),
                    _ => return Err(wrong("attribute", &format!("'{name}'"), "use a name that Cloud documents")),
                }
            };
        }
        scalar_columns!(take);
    }
    Ok(attributes)
}
