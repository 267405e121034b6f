"""Rasters as arrays of xarray, by the conventions of CF and rioxarray."""

from __future__ import annotations

import datetime
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ._errors import missing

if TYPE_CHECKING:
    import xarray

    from ._raster import Raster

#: The variable that holds the reference system.
_SYSTEM = "spatial_ref"
#: Tags that differ from sun to sun.
_SUN = {"SUN_AZIMUTH_DEG": "azimuth of the sun from north", "SUN_ELEVATION_DEG": "elevation of the sun"}


def array_of(raster: Raster) -> xarray.DataArray:
    """A raster as an array of y and x, with its time where it has one."""
    coordinates: dict[str, Any] = {} if "TIME" not in raster.tags else {"time": _times([raster])[0]}
    return _array(raster, raster.values, (), coordinates, raster.tags)


def stack_of(rasters: Sequence[Raster]) -> xarray.DataArray:
    """Rasters of several suns on one grid as an array of time, y and x; of sun, y and x where times are not known."""
    first = rasters[0]
    dim = "time" if all("TIME" in raster.tags for raster in rasters) else "sun"
    coordinates: dict[str, Any] = {}
    if dim == "time":
        coordinates["time"] = (
            "time",
            _times(rasters),
            {"standard_name": "time", "long_name": "time in UTC", "axis": "T"},
        )
    for tag, text in _SUN.items():
        if all(tag in raster.tags for raster in rasters):
            angles = [float(raster.tags[tag]) for raster in rasters]
            coordinates[tag.lower()] = (dim, angles, {"long_name": text, "units": "degree"})
    common = {tag: text for tag, text in first.tags.items() if all(raster.tags.get(tag) == text for raster in rasters)}
    return _array(first, np.stack([raster.values for raster in rasters]), (dim,), coordinates, common)


def _array(
    raster: Raster,
    values: npt.NDArray[Any],
    dims: tuple[str, ...],
    coordinates: Mapping[str, Any],
    tags: Mapping[str, str],
) -> xarray.DataArray:
    try:
        import xarray
    except ImportError:
        raise missing("xarray", "to_xarray") from None
    a, b, c, d, e, f = raster.transform
    system, axes = _system(raster)
    texts = {"long_name": raster.description, "units": raster.unit} | {tag.lower(): text for tag, text in tags.items()}
    attributes: dict[str, Any] = {key: text for key, text in texts.items() if text}
    if raster.nodata is not None and np.isfinite(raster.nodata):
        attributes["_FillValue"] = values.dtype.type(raster.nodata)
    made = xarray.DataArray(
        values,
        dims=(*dims, "y", "x"),
        coords={
            **coordinates,
            "y": ("y", raster.y, axes["y"]),
            "x": ("x", raster.x, axes["x"]),
            _SYSTEM: ((), 0, system | {"GeoTransform": f"{c} {a} {b} {f} {d} {e}"}),
        },
        name=raster.name or None,
        attrs=attributes,
    )
    # as an attribute, so that a file has one variable of data for those who open it without `decode_coords="all"`
    made.attrs["grid_mapping"] = _SYSTEM
    return made


def _system(raster: Raster) -> tuple[dict[str, Any], dict[str, dict[str, Any]]]:
    """Attributes of the reference system and of the axes; those of CF need pyproj."""
    axes: dict[str, dict[str, Any]] = {
        name: {"standard_name": f"projection_{name}_coordinate", "axis": name.upper()} for name in ("y", "x")
    }
    if raster.crs is None:
        return {}, axes
    try:
        import pyproj
    except ImportError:
        return {"crs_wkt": raster.crs, "spatial_ref": raster.crs}, axes
    system = pyproj.CRS(raster.crs)
    for axis in system.cs_to_cf():
        name = str(axis.get("axis", "")).lower()
        if name in axes:
            axes[name] = axis
    return {**system.to_cf(), "spatial_ref": system.to_wkt()}, axes


def _times(rasters: Sequence[Raster]) -> npt.NDArray[np.datetime64]:
    """Times in UTC, as xarray and netCDF have no time zones."""
    times = [datetime.datetime.fromisoformat(raster.tags["TIME"]) for raster in rasters]
    return np.array([time.astimezone(datetime.timezone.utc).replace(tzinfo=None) for time in times], "datetime64[ns]")
