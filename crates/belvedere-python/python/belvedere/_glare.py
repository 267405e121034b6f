"""Sun that panels and glass reflect to observers."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from . import _core
from ._inputs import check_finite, map_places, reporter, table_columns
from ._outlook import _OBSERVERS
from ._questions import days_of, given, ground_of, place_of
from ._remarks import warned
from ._table import Table
from ._types import Columns, Day, Ground, Location, Period, Places, Progress, Zone

_NUMBERS = ("x", "y", "z", "azimuth", "tilt", "width", "height")


class Glare:
    """Sun that panels and glass reflect to observers."""

    _core: _core.Scene

    def glare(
        self,
        reflectors: Columns,
        observers: Places,
        *,
        date: Day | Iterable[Day] | None = None,
        period: Period | None = None,
        year: int | None = None,
        time_step_min: float | None = None,
        min_sun_elevation_deg: float | None = None,
        scatter_deg: float | None = None,
        from_sun_deg: float | None = None,
        observer_height: float | None = None,
        ground: Ground | None = None,
        location: Location | None = None,
        zone: Zone | None = None,
        grid_north: bool = False,
        progress: Progress = None,
    ) -> Table:
        """When panels and glass reflect the sun to observers, for how long, and how strongly.

        Parameters
        ----------
        reflectors : mapping of str to array_like, or DataFrame
            Columns ``x, y, z`` of the middles of rectangles, ``azimuth`` that they face (degrees), ``width`` and
            ``height`` (metres), and if known ``tilt`` (degrees, 90 upright) and ``name``.
        observers : array_like, shape (2,), (3,), (N, 2) or (N, 3)
            Places in the coordinates of the file. Without z, eyes are `observer_height` above the ground.
        date, period, min_sun_elevation_deg, zone : optional
            As for `sun_hours`.
        year : int, optional
            Year of dates. Without dates all of it counts, a minute after the other.
        time_step_min : float, optional
            Minutes between two suns; 1 if not given.
        scatter_deg : float, optional
            Angle by which a surface spreads the beam to each side, 0 (a perfect mirror) to 11; 0.75 if not given.
        from_sun_deg : float, optional
            Count only reflections at least so far from the sun itself, degrees; 0 if not given.
        observer_height, ground : optional
            As for `horizon`.
        location, grid_north, progress : optional
            As for `shadow`.

        Returns
        -------
        Table
            A row for each observer and reflector: ``hours`` of glare, ``after_image_hours``, ``unproven_hours``,
            ``days``, ``first_day`` and ``last_day`` (numpy dates), ``earliest`` and ``latest`` (hours on the clocks of
            `zone`), ``longest_min`` without a break, and ``max_day_min``, the maximum of a day. Numbers count from 1;
            of several reflectors, number 0 is all of them together. NaN for observers that cannot look.
            ``table.hours`` has a table for each observer: minutes of glare in each hour (columns) of each month (rows).

        Raises
        ------
        BelvedereError
            For reflectors without a size, without days and year, where no observer is left, and for parameters out of
            range.

        Warns
        -----
        BelvedereWarning
            Of reflectors beside the cloud or inside an obstacle, of observers that cannot look, and of glare in solar
            time where no `zone` is given.

        References
        ----------
        docs/methods/glare.md

        Examples
        --------
        >>> x, y, z = eye
        >>> pane = {"x": [x], "y": [y + 5], "z": [z + 5], "azimuth": [180], "width": [4], "height": [3]}
        >>> seen = scene.glare(pane, eye, date="2026-06-21", zone="Europe/Amsterdam")
        >>> seen["hours"].shape
        (1,)
        """
        check_finite(scatter_deg=scatter_deg, from_sun_deg=from_sun_deg, observer_height=observer_height)
        columns = table_columns(
            reflectors, "reflectors", (*_NUMBERS, "name"), ("x", "y", "z", "azimuth", "width", "height"), ("name",)
        )
        names = [str(name) for name in columns.pop("name", ())]
        columns.setdefault("tilt", np.full(len(columns["x"]), 90.0))
        rows = np.column_stack([columns[name] for name in _NUMBERS])
        question = given(
            observer_height=observer_height,
            ground=ground_of(ground),
            days=days_of(date, period, year, time_step_min, min_sun_elevation_deg),
            place=place_of(location, zone=zone, grid_north=grid_north),
            scatter_deg=scatter_deg,
            from_sun_deg=from_sun_deg,
        )
        places = map_places(observers, "observers", _OBSERVERS, crs=self._core.crs.text)
        pairs, by_hour, remarks = self._core.glare(question, rows.tolist(), names, places, reporter(progress))
        found = dict(pairs)
        for name in ("first_day", "last_day"):
            found[name] = np.array([day or "NaT" for day in found[name]], "datetime64[D]")
        found["name"] = np.array(found["name"], object)
        hours = dict(by_hour)
        count = int(hours["observer"].max(initial=0))
        table = Table(found, crs=self._core.crs.text)
        table.hours = [
            Table({name: values[hours["observer"] == one] for name, values in hours.items() if name != "observer"})
            for one in range(1, count + 1)
        ]
        table.remarks = warned(remarks)
        return table
