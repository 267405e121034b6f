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
