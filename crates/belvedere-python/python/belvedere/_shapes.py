"""Places and polygons from shapely, geopandas, pandas and polars: objects that know their geometry or their columns."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from ._errors import wrong
from ._types import Columns, Polygon

Ring = list[tuple[float, float]]


def in_system(value: Any, what: str, crs: str | None = None) -> Any:
    """Rows of x, y and perhaps z of points or lines of shapely and geopandas, in `crs` where the value names its own
    system, and of the columns x, y and perhaps z of a table; anything else as it is.
    """
    shapes = _shapes(value, crs)
    if shapes is not None:
        return _of_shapes(shapes, what)
    if hasattr(value, "columns") or isinstance(value, Mapping):
        return _of_columns(value, what)
    return value


def is_single(value: Any) -> bool:
    """Return True for one place, False for rows of places."""
    if hasattr(value, "to_crs") or is_table(value):
        return False
    if hasattr(value, "geom_type"):
        return bool(value.geom_type == "Point")
    return _shapes(value, None) is None and np.ndim(value) <= 1


def is_table(value: object) -> bool:
    """Return True for named columns: a dictionary, or a table of pandas, polars or pyarrow."""
    return isinstance(value, Mapping) or hasattr(value, "columns")


def columns_of(table: Columns) -> dict[str, npt.NDArray[Any]]:
    """Columns of a dictionary, or of a table of pandas, polars or pyarrow, by name."""
    return {str(name): np.atleast_1d(np.asarray(table[name])) for name in _names(table)}


def _names(table: Columns) -> list[Any]:
    return list(table) if isinstance(table, Mapping) else list(getattr(table, "column_names", table.columns))


def rings_of(value: Polygon, what: str, crs: str | None = None) -> list[Ring]:
    """Corners of the outline of a polygon, and of its holes."""
    advice = "give corners (x, y), 3 at least, or a polygon of shapely or geopandas"
    shapes = _shapes(value, crs)
    if shapes is not None:
        polygons = [part for shape in shapes for part in getattr(shape, "geoms", [shape])]
        kinds = sorted({polygon.geom_type for polygon in polygons})
        if kinds != ["Polygon"] or len(polygons) != 1:
            raise wrong(what, f"{len(polygons)} x {' and '.join(kinds)}", "give one polygon")
        arrays = [np.asarray(ring.coords)[:-1, :2] for ring in (polygons[0].exterior, *polygons[0].interiors)]
    else:
        try:
            given: Any = value
            rings = [given] if np.ndim(given[0]) == 1 else given
            arrays = [np.asarray(ring, np.float64)[:, :2] for ring in rings]
        except (TypeError, ValueError, IndexError, KeyError):
            raise wrong(what, repr(value), advice) from None
    if any(ring.ndim != 2 or ring.shape[1] != 2 or len(ring) < 3 for ring in arrays):
        raise wrong(what, "not a polygon", advice)
    if not all(np.isfinite(ring).all() for ring in arrays):
        raise wrong(what, "not finite", advice)
    return [[(float(x), float(y)) for x, y in ring] for ring in arrays]


def _shapes(value: Any, crs: str | None) -> list[Any] | None:
    """Geometries, in `crs` where the value names its own system; None for what has none."""
    if hasattr(value, "to_crs"):
        geometry = getattr(value, "geometry", value)
        return list(geometry if geometry.crs is None or crs is None else geometry.to_crs(crs))
    if hasattr(value, "geom_type"):
        return [value]
    several = isinstance(value, Sequence) or (isinstance(value, np.ndarray) and value.dtype == object)
    if several and len(value) > 0 and all(hasattr(one, "geom_type") for one in value):
        return list(value)
    return None


def _of_columns(table: Any, what: str) -> Any:
    """The places of a `Table`, or rows of x, y and perhaps z by the names of columns; without these, the numbers of a
    table of two or three columns.
    """
    if getattr(table, "places", None) is not None:
        return table.places
    names = [str(name) for name in _names(table)]
    wanted = [name for name in "xyz" if name in names]
    if "x" in names and "y" in names:
        try:
            return np.column_stack([np.asarray(table[name], np.float64) for name in wanted])
        except (TypeError, ValueError):
            raise wrong(what, "x, y and z that are not numbers of one length", "give a number for each row") from None
    if isinstance(table, Mapping) or len(names) > 3:
        raise wrong(what, f"a table of {', '.join(names)}", "give columns x and y, or x, y and z")
    return np.asarray(table)


def _of_shapes(shapes: Sequence[Any], what: str) -> npt.NDArray[np.float64]:
    kinds = {shape.geom_type for shape in shapes if shape is not None}
    if None in shapes or not kinds <= {"Point", "MultiPoint", "LineString"}:
        raise wrong(what, " and ".join(sorted(kinds)) or "empty", "give points or lines, such as geometry.centroid")
    parts = [part for shape in shapes for part in getattr(shape, "geoms", [shape])]
    rows = [tuple(place) for part in parts for place in part.coords]
    if len({len(row) for row in rows}) > 1:
        raise wrong(what, "places with and without a height", "give all with a height, or none")
    return np.array(rows, np.float64)
