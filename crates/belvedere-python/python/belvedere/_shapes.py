"""Places from shapely, geopandas and pandas: objects that know their geometry, in any reference system."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from ._errors import wrong


def in_system(value: Any, what: str, crs: str | None = None) -> Any:
    """Rows of x, y and perhaps z of points or lines of shapely and geopandas, in `crs` where the value names its own
    system; anything else as it is.
    """
    if hasattr(value, "to_crs"):
        return _of_frame(value, what, crs)
    if hasattr(value, "geom_type"):
        return _of_shapes([value], what)
    if isinstance(value, Sequence) and len(value) > 0 and all(hasattr(one, "geom_type") for one in value):
        return _of_shapes(value, what)
    if isinstance(value, np.ndarray) and value.dtype == object and all(hasattr(one, "geom_type") for one in value.flat):
        return _of_shapes(list(value.flat), what)
    return value


def is_single(value: Any) -> bool:
    """Return True for one place, False for rows of places."""
    if in_system(value, "place") is not value:
        return getattr(value, "geom_type", None) == "Point"
    return np.ndim(value) == 1


def _of_frame(value: Any, what: str, crs: str | None) -> npt.NDArray[np.float64]:
    geometry = getattr(value, "geometry", value)
    if geometry.crs is not None and crs is not None:
        geometry = geometry.to_crs(crs)
    return _of_shapes(list(geometry), what)


def _of_shapes(shapes: Sequence[Any], what: str) -> npt.NDArray[np.float64]:
    kinds = {shape.geom_type for shape in shapes if shape is not None}
    if None in shapes or not kinds <= {"Point", "MultiPoint", "LineString"}:
        raise wrong(what, " and ".join(sorted(kinds)) or "empty", "give points or lines, such as geometry.centroid")
    parts = [part for shape in shapes for part in getattr(shape, "geoms", [shape])]
    rows = [tuple(place) for part in parts for place in part.coords]
    if len({len(row) for row in rows}) > 1:
        raise wrong(what, "places with and without a height", "give all with a height, or none")
    return np.array(rows, np.float64)
