"""Questions about towers such as wind turbines and masts."""

from __future__ import annotations

from os import PathLike, fspath
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from . import _core
from ._errors import wrong
from ._inputs import check_finite, table_columns
from ._keywords import Towers as TowersKeywords
from ._questions import cells_of, earth, given, ground_of
from ._raster import Rasters
from ._table import Table
from ._targets import Rows, Targets, measured
from ._types import Columns, Curvature, Ground, Progress

if TYPE_CHECKING:
    from typing_extensions import Unpack


class Towers:
    """How much of towers is seen."""

    _core: _core.Scene

    @overload
    def towers(
        self,
        towers: Columns,
        *,
        targets: None = None,
        **more: Unpack[TowersKeywords],
    ) -> Rasters: ...
    @overload
    def towers(
        self,
        towers: Columns,
        *,
        targets: Rows,
        **more: Unpack[TowersKeywords],
    ) -> Table: ...
    def towers(
        self,
        towers: Columns,
        *,
        observer_height: float | None = None,
        max_distance: float | None = None,
        targets: Targets = None,
        cell: float | None = None,
        surface: bool = False,
        ground: Ground | None = None,
        curvature: Curvature | None = None,
        refraction: float | None = None,
        far: bool = False,
        wirelines: str | PathLike[str] | None = None,
        progress: Progress = None,
    ) -> Rasters | Table:
        """Visible metres of towers from places.

        Parameters
        ----------
        towers : mapping of str to array_like, or DataFrame
            Columns ``x``, ``y`` and ``tip``, and if known ``base``, ``hub``, ``name`` and ``scheme``; a DataFrame will
            do. ``tip`` and ``hub`` are metres above the base, a height of the file. Without it a tower stands on the
            ground of the cloud, or on the terrain of the scene. ``x`` and ``y`` may be latitude and longitude.
        observer_height : float, optional
            Height of eyes above the ground, metres; 1.7 if not given.
        max_distance : float, optional
            Horizontal distance up to which towers count, metres; no limit if not given.
        targets, cell, surface, ground
            As for `shadow`.
        curvature : {'auto', 'on', 'off'}, optional
            Whether lines follow the curvature of the earth; those of more than 2 km if not given.
        refraction : float, optional
            Share of the curvature that light follows, 0 to below 1; 1/7 if not given.
        far : bool, optional
            Whether eyes stand on the cells of the terrain beyond the cloud, in place of `targets`.
        wirelines : path-like, optional
            Folder for a picture of what each of at most 100 `targets` sees of the towers, ``wireline_1.png`` and so on,
            and for ``wirelines.csv``, a row for each target and tower.
        progress : bool or callable, optional

        Returns
        -------
        Rasters or Table
            ``metres`` and ``share``, visible metres of all towers and their share; ``towers``, ``tips`` and ``hubs``,
            numbers that are visible, partly or whole; ``max_metres``; ``angle_deg``, the greatest vertical angle of a
            tower; ``nearest_m``; ``schemes``, a bit for each scheme; ``unproven``.

        Raises
        ------
        BelvedereError
            For towers that lack columns or a foot, hubs above tips, towers far from the scene, and parameters out of
            range.

        Warns
        -----
        BelvedereWarning
            Where towers stand beyond what is known.

        References
        ----------
        docs/methods/towers.md

        Examples
        --------
        >>> mast = {"x": [154990.0], "y": [462980.0], "tip": [60.0]}
        >>> seen = scene.towers(mast, cell=8)
        >>> list(seen)
        ['metres', 'share', 'towers', 'tips', 'max_metres', 'angle_deg', 'nearest_m', 'unproven']
        >>> seen["metres"].unit
        'm'
        """
        check_finite(observer_height=observer_height, max_distance=max_distance)
        question = given(
            observer_height=observer_height,
            max_distance=max_distance,
            earth=earth(curvature, refraction),
            ground=ground_of(ground),
            far=bool(far),
        )
        arguments = question, _rows(towers), None if wirelines is None else fspath(wirelines)
        cells = cells_of(cell, None, surface, ground)
        return measured(self._core, self._core.towers, arguments, targets, cells, progress)


def _rows(towers: Columns) -> list[dict[str, Any]]:
    known = ("x", "y", "base", "hub", "tip", "name", "scheme")
    columns = table_columns(towers, "towers", known, ("x", "y", "tip"), ("name", "scheme"))

    def number(name: str, row: int) -> float | None:
        value = float(columns[name][row]) if name in columns else np.nan
        return value if np.isfinite(value) else None

    def text(name: str, row: int) -> str:
        value = columns[name][row] if name in columns else ""
        return "" if value is None or value != value else str(value)

    rows = []
    for row in range(len(columns["x"])):
        x, y, tip = (number(name, row) for name in ("x", "y", "tip"))
        if x is None or y is None or tip is None:
            raise wrong("towers", f"row {row} without x, y or tip", "give all three")
        rows.append(
            {
                "place": [x, y],
                "base": number("base", row),
                "hub": number("hub", row),
                "tip": tip,
                "name": text("name", row),
                "scheme": text("scheme", row),
            }
        )
    return rows
