//! Rasters as files.

use crate::errors::{exception, wrong};
use crate::system::System;
use belvedere::io::{
    BandLabel, BandValues, Bands, Georeference, MetadataTag, write_tif_bands, write_tif_f32, write_tif_u8,
    write_tif_u16,
};
use belvedere::raster::Raster;
use numpy::{Element, PyReadonlyArray2};
use pyo3::prelude::*;
use std::path::PathBuf;

/// Values of a type that rasters have.
#[derive(FromPyObject)]
pub(crate) enum RasterArray<'py> {
    F32(PyReadonlyArray2<'py, f32>),
    U8(PyReadonlyArray2<'py, u8>),
    U16(PyReadonlyArray2<'py, u16>),
    U32(PyReadonlyArray2<'py, u32>),
}

/// Writes a GeoTIFF of bands of one type with the six numbers of an affine transform. Labels of bands are names, units
/// and further metadata. A raster without a value for no data has one band, and no label.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "keywords in Python")]
pub(crate) fn write_geotiff(
    py: Python<'_>,
    path: PathBuf,
    bands: Vec<RasterArray<'_>>,
    labels: Vec<(String, String, Vec<MetadataTag>)>,
    transform: [f64; 6],
    crs: System,
    nodata: Option<f64>,
    description: Option<String>,
) -> PyResult<()> {
    let [a, b, west, d, e, north] = transform;
    let place = Georeference { upper_left: [west, north], column_step: [a, d], row_step: [b, e], crs: crs.0 };
    let (place, description) = (Some(&place), description.as_deref());
    let labels: Vec<BandLabel> =
        labels.into_iter().map(|(name, unit, tags)| BandLabel { tags, ..BandLabel::new(&name, &unit) }).collect();
    let number = |max: u32| match nodata {
        None => Ok(None),
        Some(v) if v >= 0.0 && v <= f64::from(max) && v.fract() == 0.0 => Ok(Some(v)),
        Some(v) => Err(wrong("nodata", &v.to_string(), &format!("give a whole number from 0 to {max}"))),
    };
    let write = |values: BandValues<'_>| {
        py.detach(|| write_tif_bands(&path, &Bands { values, labels: &labels, tags: &[], description }, place))
    };
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the range of the type")]
    let written = match (&bands[..], nodata) {
        ([RasterArray::U8(one)], None) => {
            let raster = raster(one)?;
            py.detach(|| write_tif_u8(&path, &raster, place, None, description))
        }
        ([RasterArray::U16(one)], None) => {
            let raster = raster(one)?;
            py.detach(|| write_tif_u16(&path, &raster, place, None, description))
        }
        ([RasterArray::F32(one)], None) => {
            let raster = raster(one)?;
            py.detach(|| write_tif_f32(&path, &raster, place, None, description))
        }
        ([RasterArray::U8(_), ..], _) => {
            let of_type =
                |band: &RasterArray<'_>| if let RasterArray::U8(band) = band { Some(raster(band)) } else { None };
            let (bands, nodata) = (all(&bands, of_type)?, number(u8::MAX.into())?.unwrap_or(255.0));
            write(BandValues::U8(&bands, nodata as u8))
        }
        ([RasterArray::U16(_), ..], _) => {
            let of_type =
                |band: &RasterArray<'_>| if let RasterArray::U16(band) = band { Some(raster(band)) } else { None };
            let (bands, nodata) = (all(&bands, of_type)?, number(u16::MAX.into())?.unwrap_or(65_535.0));
            write(BandValues::U16(&bands, nodata as u16))
        }
        ([RasterArray::U32(_), ..], _) => {
            let of_type =
                |band: &RasterArray<'_>| if let RasterArray::U32(band) = band { Some(raster(band)) } else { None };
            let (bands, nodata) = (all(&bands, of_type)?, number(u32::MAX)?.unwrap_or(f64::from(u32::MAX)));
            write(BandValues::U32(&bands, nodata as u32))
        }
        _ => {
            let of_type =
                |band: &RasterArray<'_>| if let RasterArray::F32(band) = band { Some(raster(band)) } else { None };
            let (bands, nodata) = (all(&bands, of_type)?, nodata.unwrap_or(-9999.0));
            write(BandValues::F32(&bands, nodata as f32))
        }
    };
    written.map_err(exception)
}

/// Bands that all have the type of the first.
fn all<T>(
    bands: &[RasterArray<'_>],
    of_type: impl Fn(&RasterArray<'_>) -> Option<PyResult<Raster<T>>>,
) -> PyResult<Vec<Raster<T>>> {
    let other = || Err(wrong("bands", "of several types", "give all the same one"));
    bands.iter().map(|band| of_type(band).unwrap_or_else(other)).collect()
}

fn raster<T: Element + Copy>(array: &PyReadonlyArray2<'_, T>) -> PyResult<Raster<T>> {
    let view = array.as_array();
    Raster::from_values(view.ncols(), view.nrows(), view.iter().copied().collect()).map_err(exception)
}
