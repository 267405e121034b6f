"""Targets, and how results come back."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from . import _core
from ._cloud import Cloud
from ._errors import wrong
from ._inputs import check_finite, map_places, places, reporter
from ._mesh import Mesh
from ._questions import Cells, ground_of
from ._raster import Raster, Rasters
from ._remarks import warned
from ._shapes import in_system
from ._table import Table
from ._types import Numbers, Places, Progress

#: Places of shape (N, 3), the points of a cloud, or the faces of a mesh: targets that are no cells.
Rows = Union[Places, Cloud, Mesh]
#: Cells of a grid (None), or rows.
Targets = Union[Rows, None]


def wanted(targets: Targets, normals: Numbers | None, cells: Cells, may_lack_heights: bool = False) -> dict[str, Any]:
    """Targets as the native part takes them."""
    on_map = None
    if may_lack_heights and targets is not None and not isinstance(targets, (Cloud, Mesh)):
        on_map = _on_map(targets)
    if on_map is not None:
        for name in ("cell", "surface"):
            if cells.get(name):
                raise wrong(name, cells.get(name), "it applies only to a grid; leave out targets, or leave this out")
        if normals is not None:
            raise wrong("normals", "given", "places without a height are level; give x, y and z, or leave this out")
    elif targets is not None:
        for name in ("cell", "target_height", "ground"):
            if cells.get(name) is not None:
                raise wrong(name, cells.get(name), "it applies only to a grid; leave out targets, or leave this out")
        if cells.get("surface"):
            raise wrong("surface", True, "it applies only to a grid; leave out targets, or leave this out")
    elif normals is not None:
        raise wrong("normals", "given", "cells are level; give targets, or leave this out")
    check_finite(cell=cells.get("cell"), target_height=cells.get("target_height"))
    turned = None
    if normals is not None:
        if isinstance(targets, Mesh):
            raise wrong("normals", "given", "a mesh has its own; Mesh.sampled(facing='level') turns its targets up")
        turned = np.asarray(places(normals, "normals"), np.float32)
        if not np.isfinite(turned).all():
            raise wrong("normals", "not finite", "give unit vectors of shape (N, 3)")
    return {
        "places": None
        if targets is None or on_map is not None or isinstance(targets, (Cloud, Mesh))
        else places(targets, "targets"),
        "on_map": None if on_map is None else on_map.tolist(),
        "cloud": targets._core if isinstance(targets, Cloud) else None,
        "faces": targets._faces if isinstance(targets, Mesh) else None,
        "normals": turned,
        "surface": bool(cells.get("surface")),
        "cell": cells.get("cell"),
        "height": cells.get("target_height"),
        "ground": ground_of(cells.get("ground")),
    }


def _on_map(targets: Any) -> npt.NDArray[np.float64] | None:
    """Rows of x, y and an unknown height, or of latitude and longitude; None for places with heights."""
    try:
        shape = np.shape(targets)
    except ValueError:
        return None
    if len(shape) not in (1, 2) or shape[-1] != 2 or shape[0] == 0:
        return None
    return map_places(targets, "targets", "give x and y, latitude and longitude in degrees, or x, y and z")


Grid = tuple[int, int, Sequence[float]]


def raster(values: npt.NDArray[Any], grid: Grid, crs: _core.Crs, **named: Any) -> Raster:
    """Values of cells, row by row from the north, as a raster."""
    width, height, (a, b, c, d, e, f) = grid
    return Raster(values.reshape(height, width), (a, b, c, d, e, f), crs, **named)


#: Columns of measures, and the grid where targets are cells; for a mesh only the rows of its faces; then remarks, and
#: the places of targets that were given on the map.
Results = tuple[
    list[tuple[str, str, npt.NDArray[Any], bool, str, dict[str, str]]],
    Union[Grid, None],
    Union[dict[str, Any], None],
    list[dict[str, Any]],
    Union[npt.NDArray[np.float64], None],
]


def measures(results: Results, crs: _core.Crs, targets: Targets) -> Rasters | Table:
    """Measures as rasters where targets are cells, and as a table elsewhere."""
    columns, grid, faces, given, on_map = results
    remarks = warned(given)
    if faces is not None:
        table = face_table(faces)
        table.remarks = remarks
        return table
    if grid is not None:
        nan = float("nan")
        made = {
            name: raster(values, grid, crs, name=name, description=text, nodata=nan, is_answer=is_answer, unit=unit)
            for name, text, values, is_answer, unit, _ in columns
        }
        for name, *_, tags in columns:
            made[name].tags, made[name].remarks = tags, remarks
        return Rasters(made)
    table = Table(
        {name: values for name, _, values, *_ in columns},
        places=coordinates(targets) if on_map is None else on_map,
        crs=crs.text,
    )
    table.remarks = remarks
    return table


def measured(
    core: _core.Scene,
    ask: Callable[..., Results],
    question: Sequence[Any],
    targets: Targets,
    cells: Cells,
    progress: Progress,
    normals: Numbers | None = None,
) -> Rasters | Table:
    """Measures of targets: the native part is arguments the question with them."""
    targets = in_system(targets, "targets", core.crs.text)
    results = ask(*question, wanted(targets, normals, cells, may_lack_heights=True), reporter(progress))
    return measures(results, core.crs, targets)


def face_table(faces: dict[str, Any]) -> Table:
    """A row for each face of a mesh, with a table of its objects."""
    count = faces["object_count"]
    names = np.array(faces["object"], object)
    columns = {"object": names, **faces["columns"]}
    objects = Table({name: values[:count] for name, values in columns.items()})
    return Table({name: values[count:] for name, values in columns.items()}, objects=objects)


def coordinates(targets: Targets) -> npt.NDArray[np.float64] | None:
    """Places of targets that are no cells."""
    if targets is None or isinstance(targets, Mesh):
        return None
    return targets.xyz if isinstance(targets, Cloud) else np.asarray(targets, np.float64)
