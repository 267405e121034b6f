"""What rasters of the program and of Python hold, in one form."""

from __future__ import annotations

import numpy as np
import pytest

rasterio = pytest.importorskip("rasterio")


def bands_of(path):
    """Bands by name, NaN where there is no value, and where the raster lies."""
    with rasterio.open(path) as file:
        found = {}
        for number, name in enumerate(file.descriptions, 1):
            values = file.read(number).astype(np.float64)
            values[values == file.nodata] = np.nan
            found[name] = values
        return found, file.transform


def values_of(raster):
    """The values of a raster of Python, NaN where there is none."""
    values = np.asarray(raster.values, np.float64)
    return np.where(values == raster.nodata, np.nan, values) if raster.nodata is not None else values


def _read(path):
    with rasterio.open(path) as file:
        return file.read(1), file.transform, file.nodata, file.crs


def assert_same_raster(raster, path, folder):
    """A raster of Python is that of the program at `path`, value by value."""
    values, transform, nodata, crs = _read(path)
    ours = folder / f"python_{path.name}"
    raster.to_geotiff(ours)
    written = _read(ours)
    assert np.array_equal(written[0], values), path
    assert (written[1], written[2], written[3]) == (transform, nodata, crs)
    assert tuple(transform)[:6] == raster.transform
    expected = np.where(values == nodata, np.nan, values) if raster.values.dtype == np.float32 else values
    assert np.array_equal(raster.values, expected, equal_nan=True)
