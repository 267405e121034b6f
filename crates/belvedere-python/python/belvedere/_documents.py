"""Sun calendars and sunlight reports."""

from __future__ import annotations

import datetime
import os
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core
from ._errors import wrong
from ._inputs import as_list, reporter
from ._planning import _windows
from ._questions import days_of, given, place_of
from ._remarks import warned
from ._shapes import columns_of, in_system, rings_of
from ._table import Table
from ._targets import Targets, coordinates, wanted
from ._types import Columns, Day, Language, Location, Period, Polygon, Progress, Study, Zone

if TYPE_CHECKING:
    from typing_extensions import Self


class Documents:
    """Sun calendars and sunlight reports."""

    _core: _core.Scene

    def sun_calendar(
        self,
        *,
        windows: Columns | None = None,
        targets: Targets = None,
        date: Day | Iterable[Day] | None = None,
        period: Period | None = None,
        rule: str | None = None,
        year: int | None = None,
        time_step_min: float | None = None,
        min_sun_elevation_deg: float | None = None,
        location: Location | None = None,
        zone: Zone | None = None,
        grid_north: bool = False,
        progress: Progress = None,
    ) -> Table:
        """From when to when the sun shines at windows or places, and what shades them.

        Parameters
        ----------
        windows : mapping of str to array_like, or DataFrame, optional
            Columns ``x, y, z`` and ``azimuth`` (degrees), and if known ``tilt`` (degrees, 90 upright). Their middles
            count.
        targets : array_like, shape (N, 3), (N, 2) or (2,), optional
            Places in place of windows, as for `shadow`.
        date, period, year, min_sun_elevation_deg, zone : optional
            As for `sun_hours`.
        rule : str, optional
            Daylight rule whose days and hours are listed, in place of days; with `year`.
        time_step_min : float, optional
            Minutes between two suns; 2 if not given.
        location, grid_north, progress : optional
            As for `shadow`.

        Returns
        -------
        Table
            A row for each stretch: ``place`` (from 0), ``start`` and ``end`` (numpy datetimes on the clocks of
            `zone`), ``hours``, ``state`` (sun, building, trees, plan, ground, terrain, water, other, own wall),
            ``object`` (the mesh that shades), and ``unproven_hours``, sun on lines that no pulse came near.

        Raises
        ------
        BelvedereError
            Unless windows or places are given, and days or a rule.

        Warns
        -----
        BelvedereWarning
            Of places outside the cloud or near its edge, and of points without classes.

        References
        ----------
        docs/methods/sun.md

        Examples
        --------
        >>> x, y, z = eye
        >>> window = {"x": [x], "y": [y], "z": [z], "azimuth": [180]}
        >>> days = scene.sun_calendar(windows=window, date="2026-03-21", zone="Europe/Amsterdam")
        >>> set(days["state"]) <= {"sun", "building", "trees", "ground", "other", "own wall"}
        True
        >>> bool(11.5 < days["hours"].sum() < 12.5)
        True
        """
        if (windows is None) == (targets is None):
            raise wrong("windows and targets", "both given" if windows is not None else "missing", "give one of them")
        places = in_system(targets, "targets", self._core.crs.text)
        question = given(
            days=days_of(date, period, year, time_step_min, min_sun_elevation_deg),
            rule=rule,
            place=place_of(location, zone=zone, grid_north=grid_north),
        )
        rows = [] if windows is None else _windows(windows)
        chosen = wanted(places, None, {}, may_lack_heights=True)
        columns, found = self._core.sun_calendar(question, rows, chosen, reporter(progress))
        days = np.array(columns.pop("date"), "datetime64[D]").astype("datetime64[s]")
        for name in ("start", "end"):
            columns[name] = days + np.round(columns[name] * 3600).astype("timedelta64[s]")
        for name in ("state", "object"):
            columns[name] = np.array(columns[name], object)
        where = None if windows is None else np.array(rows)[:, :3]
        at = coordinates(places) if where is None else where
        of_rows = None if at is None or at.ndim != 2 or at.shape[1] != 3 else at[columns["place"]]
        table = Table(columns, places=of_rows, crs=self._core.crs.text)
        table.remarks = warned(found)
        return table

    def sunlight_report(
        self,
        path: str | os.PathLike[str],
        *,
        windows: Columns | None = None,
        areas: Mapping[str, Polygon] | None = None,
        planned: Self | None = None,
        rule: str | None = None,
        area_rule: str | None = None,
        study: Study | None = None,
        date: Day | Iterable[Day] | None = None,
        year: int | None = None,
        time_step_min: float | None = None,
        title: str = "",
        notes: str | list[str] = [],
        language: Language = "en",
        location: Location | None = None,
        zone: Zone | None = None,
        grid_north: bool = False,
        progress: Progress = None,
    ) -> list[str]:
        """Write a sunlight report for windows and areas, before and after a plan: one HTML file that prints well.

        Parameters
        ----------
        path : path
            Where it is written (``.html``).
        windows : mapping of str to array_like, or DataFrame, optional
            Columns ``x, y, z`` and ``azimuth`` (degrees), and if known ``tilt``, ``name`` and ``room``. Their middles
            count; for a rule, the sun of the windows of one room adds up.
        areas : mapping of str to array_like of shape (N, 2), optional
            Names of areas that keep their sun, such as gardens, and their corners in the coordinates of the file.
        planned : Scene, optional
            The scene as it will be, from `with_added` or `without` of this scene.
        rule : str, optional
            Daylight rule of the windows, as for `sun_hours`; no verdict if not given.
        area_rule : str, optional
            Daylight rule of the areas; ``'bre-equinox'`` if not given.
        study : {'ceqr', 'san-francisco', 'toronto'}, optional
            City whose days and hours count for the shade that the plan adds to areas.
        date : date or str, or several, optional
            Days in detail; if not given those of `study`, else equinox, longest and shortest day of `year`.
        year : int, optional
            Year of days that are given without one; this year if not given.
        time_step_min : float, optional
            Minutes between two suns; 2 for windows and 10 for areas if not given.
        title : str, optional
            Title of the report.
        notes : str or list of str, optional
            Lines below the title, such as the client, the address and the author.
        language : {'en', 'nl', 'de', 'fr'}
            Language of the report.
        location, zone, grid_north, progress : optional
            As for `shadow` and `sun_hours`.

        Returns
        -------
        list of str
            The answer in English, a sentence for each window and area.

        Raises
        ------
        BelvedereError
            Unless windows or areas are given, for unknown rules and languages, and for files that cannot be written.

        Warns
        -----
        BelvedereWarning
            Of windows outside the cloud or near its edge, and of points without classes.

        References
        ----------
        docs/methods/sunlight-report.md

        Examples
        --------
        >>> x, y, z = eye
        >>> window = {"x": [x], "y": [y], "z": [z], "azimuth": [180], "name": ["kitchen"]}
        >>> said = scene.sunlight_report(folder / "report.html", windows=window, rule="2@03-21", year=2026)
        >>> said[0].startswith("kitchen: ")
        True
        """
        path = os.fspath(path)
        if not path.lower().endswith(".html"):
            raise wrong("path", repr(path), "a report is a file .html")
        columns: dict[str, Any] = {} if windows is None else dict(columns_of(windows))
        names, rooms = ([str(text) for text in np.asarray(columns.pop(name, []), object)] for name in ("name", "room"))
        rings = []
        for name, area in (areas or {}).items():
            outline, *holes = rings_of(area, "areas", self._core.crs.text)
            if holes:
                raise wrong("areas", f"{name} with a hole", "give polygons without holes")
            rings.append((str(name), outline))
        if planned is not None and not isinstance(planned, Documents):
            raise wrong("planned", f"a {type(planned).__name__}", "give a Scene, such as scene.with_added('plan.obj')")
        said, found = self._core.sunlight_report(
            path,
            {
                "windows": _windows(columns) if columns else [],
                "names": names,
                "rooms": rooms,
                "areas": rings,
                "planned": None if planned is None else planned._core,
                "rule": rule,
                "area_rule": area_rule,
                "study": study,
                "title": title,
                "notes": as_list(notes),
                "language": language,
                "today": datetime.date.today().isoformat(),
            },
            days_of(date, None, year, time_step_min),
            place_of(location, zone=zone, grid_north=grid_north),
            reporter(progress),
        )
        warned(found)
        return said
