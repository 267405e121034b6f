//! Rasters as files.

use crate::errors::{exception, wrong};
use crate::system::System;
use belvedere::io::{Georeference, write_tif_f32, write_tif_u8, write_tif_u16};
use belvedere::raster::Raster;
use numpy::{Element, PyReadonlyArray2};
use pyo3::prelude::*;
use std::path::PathBuf;

/// Values of a type that rasters have.
#[derive(FromPyObject)]
pub(crate) enum Values<'py> {
    F32(PyReadonlyArray2<'py, f32>),
    U8(PyReadonlyArray2<'py, u8>),
    U16(PyReadonlyArray2<'py, u16>),
}

/// Writes a GeoTIFF with the six numbers of an affine transform.
#[pyfunction]
pub(crate) fn write_geotiff(
    py: Python<'_>,
    path: PathBuf,
    values: Values<'_>,
    transform: [f64; 6],
    crs: System,
    nodata: Option<f64>,
    description: Option<String>,
) -> PyResult<()> {
    let [a, b, west, d, e, north] = transform;
    let place = Georeference { upper_left: [west, north], column_step: [a, d], row_step: [b, e], crs: crs.0 };
    let (place, what) = (Some(&place), description.as_deref());
    let number = |most: u16| match nodata {
        None => Ok(None),
        Some(v) if v >= 0.0 && v <= f64::from(most) && v.fract() == 0.0 => Ok(Some(v)),
        Some(v) => Err(wrong("nodata", &v.to_string(), &format!("give a whole number from 0 to {most}"))),
    };
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the range of the type")]
    let written = match &values {
        Values::F32(array) => {
            let raster = raster(array)?;
            py.detach(|| write_tif_f32(&path, &raster, place, nodata.map(|v| v as f32), what))
        }
        Values::U8(array) => {
            let (raster, nodata) = (raster(array)?, number(u16::from(u8::MAX))?);
            py.detach(|| write_tif_u8(&path, &raster, place, nodata.map(|v| v as u8), what))
        }
        Values::U16(array) => {
            let (raster, nodata) = (raster(array)?, number(u16::MAX)?);
            py.detach(|| write_tif_u16(&path, &raster, place, nodata.map(|v| v as u16), what))
        }
    };
    written.map_err(exception)
}

fn raster<T: Element + Copy>(array: &PyReadonlyArray2<'_, T>) -> PyResult<Raster<T>> {
    let view = array.as_array();
    Raster::from_values(view.ncols(), view.nrows(), view.iter().copied().collect()).map_err(exception)
}
