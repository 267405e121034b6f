"""Questions about sun and sky."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any, Literal, overload

import numpy as np
import numpy.typing as npt

from . import _core
from ._cloud import Cloud
from ._errors import wrong
from ._inputs import as_list, check_finite, reporter, times
from ._keywords import Shadow, SkyView, SunHours
from ._mesh import Mesh
from ._questions import cells_of, days_of, given, how_sure, place_of, sky_parts, suns_of, switch, trees_of
from ._raster import Raster, Rasters, RasterSeries
from ._remarks import warned
from ._shapes import in_system
from ._table import Table
from ._targets import Results, Rows, Targets, measured, measures, raster, wanted
from ._types import (
    Day,
    Direction,
    Ground,
    Leaves,
    Location,
    Numbers,
    Patches,
    Period,
    Places,
    Progress,
    SunElevation,
    ThroughTrees,
    Time,
    Zone,
)

if TYPE_CHECKING:
    from typing_extensions import Unpack


class Sunlight:
    """Sun and sky."""

    _core: _core.Scene

    @overload
    def shadow(
        self,
        *,
        sun: Direction | None = None,
        time: Time | None = None,
        targets: None = None,
        probability: bool = False,
        certain: float | None = None,
        casters: bool = False,
        **more: Unpack[Shadow],
    ) -> Raster: ...
    @overload
    def shadow(
        self,
        *,
        sun: Direction | None = None,
        time: Time | None = None,
        targets: Mesh,
        probability: bool = False,
        certain: float | None = None,
        casters: bool = False,
        **more: Unpack[Shadow],
    ) -> Table: ...
    @overload
    def shadow(
        self,
        *,
        sun: Direction | None = None,
        time: Time | None = None,
        targets: Places | Cloud,
        probability: Literal[False] = False,
        certain: None = None,
        casters: Literal[False] = False,
        **more: Unpack[Shadow],
    ) -> npt.NDArray[np.float32]: ...
    @overload
    def shadow(
        self,
        *,
        sun: Direction | None = None,
        time: Time | None = None,
        targets: Places | Cloud,
        probability: bool = False,
        certain: float | None = None,
        casters: bool = False,
        **more: Unpack[Shadow],
    ) -> Table: ...
    @overload
    def shadow(
        self,
        *,
        sun: Sequence[Direction] | None = None,
        time: Iterable[Time] | None = None,
        targets: None = None,
        probability: bool = False,
        certain: float | None = None,
        casters: bool = False,
        **more: Unpack[Shadow],
    ) -> RasterSeries: ...
    @overload
    def shadow(
        self,
        *,
        sun: Sequence[Direction] | None = None,
        time: Iterable[Time] | None = None,
        targets: Mesh,
        probability: bool = False,
        certain: float | None = None,
        casters: bool = False,
        **more: Unpack[Shadow],
    ) -> list[Table]: ...
    @overload
    def shadow(
        self,
        *,
        sun: Sequence[Direction] | None = None,
        time: Iterable[Time] | None = None,
        targets: Places | Cloud,
        probability: Literal[False] = False,
        certain: None = None,
        casters: Literal[False] = False,
        **more: Unpack[Shadow],
    ) -> list[npt.NDArray[np.float32]]: ...
    @overload
    def shadow(
        self,
        *,
        sun: Sequence[Direction] | None = None,
        time: Iterable[Time] | None = None,
        targets: Places | Cloud,
        probability: bool = False,
        certain: float | None = None,
        casters: bool = False,
        **more: Unpack[Shadow],
    ) -> list[Table]: ...
    @overload
    def shadow(
        self,
        *,
        sun: Numbers,
        targets: Targets = None,
        probability: bool = False,
        certain: float | None = None,
        casters: bool = False,
        **more: Unpack[Shadow],
    ) -> Any: ...
    def shadow(
        self,
        *,
        sun: Numbers | None = None,
        time: Time | Iterable[Time] | None = None,
        targets: Targets = None,
        normals: Numbers | None = None,
        cell: float | None = None,
        target_height: float | None = None,
        surface: bool = False,
        ground: Ground | None = None,
        soft: bool = False,
        through_trees: ThroughTrees | None = None,
        leaves: Leaves | None = None,
        location: Location | None = None,
        grid_north: bool = False,
        probability: bool = False,
        certain: float | None = None,
        casters: bool = False,
        progress: Progress = None,
    ) -> Any:
        """The share of the sun that reaches targets: 1 in the sun, 0 in shadow.

        Parameters
        ----------
        sun : array_like, shape (2,) or (K, 2), optional
            Azimuth, clockwise from true north, and elevation of the sun, degrees. Several give several results.
        time : datetime, pandas Timestamp, ISO text, or several, optional
            When, in place of `sun`; with a time zone.
        targets : array_like, shape (N, 3), (N, 2) or (2,), Cloud, or Mesh, optional
            Places in the coordinates of the file, or the faces of a mesh. Places without a height stand on the ground,
            or on the roof that covers it; two numbers may be latitude and longitude, degrees. Without any, the cells
            of a grid over the scene.
        normals : array_like, shape (N, 3), optional
            Unit vectors that targets face; what the sun meets from behind is in shadow.
        cell : float, optional
            Side of a cell, metres; 0.5 if not given, more for large scenes.
        target_height : float, optional
            Height of cells above the ground, metres; 0.1 if not given.
        surface : bool, optional
            Whether cells lie on roofs, crowns and the ground between, instead of on the ground.
        ground : {'auto', 'class', 'found'}, optional
            Which points are ground: class 2 where there is one (default), always class 2, or those that are found.
        soft : bool, optional
            Whether the sun is a disc, of which places see a share.
        through_trees : {'measured', 'none', 'seasons', 'pulses'} or float, optional
            Light that passes through crowns; none if not given.
        leaves : {'auto', 'on', 'off'}, optional
            Whether trees have leaves; by the date if not given, and as they were measured without one.
        location : array_like, shape (2,), or Location of pvlib, optional
            Latitude and longitude, degrees, where the reference system does not say where the scene lies.
        grid_north : bool, optional
            Whether azimuths are counted from grid north.
        probability : bool, optional
            Whether to compute how likely each target is lit. Needs pulses, hard edges and opaque trees.
        certain : float, optional
            Probability, above 0.5 and at most 1, below which an answer is uncertain.
        casters : bool, optional
            Whether to say what casts each shadow, by the classes of points.
        progress : bool or callable, optional

        Returns
        -------
        Raster, or ndarray of shape (N,), float32; for several suns a RasterSeries, or a list of arrays
            With `probability` or `certain` a Raster has these as attributes `probability` and `uncertain`, and places
            give a Table with ``lit``, ``probability`` and ``uncertain``. With `casters` likewise ``caster``: 0 sun, 1
            building, 2 trees, 3 ground, 4 water, 5 other things, 6 terrain beyond the cloud, 7 the surface of the
            target itself, 8 and more the meshes that were added.
            For a mesh a Table of its faces: ``object``, ``area_m2``, ``lit``. NaN for what is not tested: cells under
            a cover or without ground, and targets outside the cloud. The attribute `unproven` of a Raster of one sun
            with hard edges is a Raster that is 1 where `lit` is 1 but no pulse proves it; `remarks` says what to know.

        Raises
        ------
        BelvedereError
            For a time without a zone, a scene without a place on earth, and parameters out of range.

        References
        ----------
        docs/methods/shadow.md

        Examples
        --------
        >>> from datetime import datetime, timezone
        >>> scene.shadow(time=datetime(2026, 6, 21, 13, tzinfo=timezone.utc))
        <belvedere.Raster 'lit': ...>
        >>> lit = scene.shadow(sun=(180, 30), targets=targets)
        >>> lit.shape == (len(targets),)
        True
        """
        suns, is_one = suns_of(sun, time)
        question = given(
            suns=suns,
            place=place_of(location, grid_north=grid_north),
            edges="soft" if soft else "hard",
            trees=trees_of(through_trees, leaves),
            how_sure=how_sure(probability, certain),
            **switch(casters=casters),
        )
        targets = in_system(targets, "targets", self._core.crs.text)
        cells = cells_of(cell, target_height, surface, ground)
        chosen = wanted(targets, normals, cells, may_lack_heights=True)
        results = self._core.shadow(question, chosen, reporter(progress))
        has_columns = probability or certain is not None or casters
        made = [self._lit(result, targets, has_columns) for result in results]
        if is_one:
            return made[0]
        return RasterSeries(made) if targets is None else made

    def _lit(self, results: Results, targets: Targets, has_columns: bool) -> Any:
        """The share of one sun."""
        columns, grid, faces, remarks, _ = results
        if grid is None and faces is None and not has_columns:
            warned(remarks)
            return columns[0][2]
        found = measures(results, self._core.crs, targets)
        if isinstance(found, Table):
            return found
        lit = found["lit"]
        lit.unproven = found.get("unproven")
        lit.probability, lit.uncertain = found.get("probability"), found.get("uncertain")
        lit.caster = found.get("caster")
        return lit

    @overload
    def sun_hours(
        self,
        *,
        targets: None = None,
        **more: Unpack[SunHours],
    ) -> Rasters: ...
    @overload
    def sun_hours(
        self,
        *,
        targets: Rows,
        **more: Unpack[SunHours],
    ) -> Table: ...
    def sun_hours(
        self,
        *,
        date: Day | Iterable[Day] | None = None,
        period: Period | None = None,
        rule: str | list[str] = [],
        year: int | None = None,
        time_step_min: float | None = None,
        min_sun_elevation_deg: float | None = None,
        sun_tolerance_deg: float | None = None,
        targets: Targets = None,
        normals: Numbers | None = None,
        cell: float | None = None,
        target_height: float | None = None,
        surface: bool = False,
        ground: Ground | None = None,
        through_trees: ThroughTrees | None = None,
        leaves: Leaves | None = None,
        location: Location | None = None,
        zone: Zone | None = None,
        sun_elevation: SunElevation = "apparent",
        air: Numbers | None = None,
        interval: bool = False,
        progress: Progress = None,
    ) -> Rasters | Table:
        """Hours of sun on days, and when.

        Parameters
        ----------
        date : datetime.date, ISO text, or several, optional
            Days; ``'longest-day'``, ``'shortest-day'`` and ``'equinox'`` with `year`.
        period : pair of days or of times, optional
            First and last day, or begin and end, in place of `date`. Results are means of the days.
        rule : str or list of str, optional
            Daylight rules such as ``'nl-light'``, ``'pl'`` or ``'3@equinoxes@7-17'``, with `year`.
        year : int, optional
            Year of days that are given without one.
        time_step_min : float, optional
            Minutes between two suns; 10 if not given.
        min_sun_elevation_deg : float, optional
            Lower suns do not count.
        sun_tolerance_deg : float, optional
            Greatest angle between a sun and the direction that is tested for it; 0 for few suns and 1 for many if not
            given.
        targets, normals, cell, target_height, surface, ground, through_trees, leaves, location
            As for `shadow`.
        zone : str or tzinfo, optional
            How clocks run; the zone of the place if not given; ``"solar"`` for mean solar time.
        sun_elevation : {'apparent', 'geometric'}
            Whether the air lifts the sun.
        air : array_like, shape (2,), optional
            Pressure in hPa and temperature in degrees Celsius.
        interval : bool, optional
            Whether to add the expected value and an interval that holds the truth in 90 % of cases. Only where trees
            are opaque.
        progress : bool or callable, optional

        Returns
        -------
        Rasters or Table
            ``sun_hours``, ``sun_share``, ``first_light``, ``last_light``, ``longest``, of several days also
            ``min_sun_hours`` and ``total_hours``, and for each rule whether it is met; with `interval` also
            ``hours_expected``, ``hours_low`` and ``hours_high``.

        Raises
        ------
        BelvedereError
            Without days, for a scene without a place on earth, and parameters out of range.

        References
        ----------
        docs/methods/sun.md

        Examples
        --------
        >>> sun = scene.sun_hours(date="2026-06-21", zone="Europe/Amsterdam", cell=2)
        >>> list(sun)
        ['sun_hours', 'sun_share', 'first_light', 'last_light', 'longest']
        >>> bool(np.nanmax(sun["sun_hours"]) < 17)
        True
        """
        check_finite(sun_tolerance_deg=sun_tolerance_deg)
        question = given(
            days=days_of(date, period, year, time_step_min, min_sun_elevation_deg),
            rules=as_list(rule),
            place=place_of(location, zone=zone, sun_elevation=sun_elevation, air=air),
            sun_tolerance_deg=sun_tolerance_deg,
            trees=trees_of(through_trees, leaves),
            **switch(interval=interval),
        )
        cells = cells_of(cell, target_height, surface, ground)
        arguments = {"sun-hours": question}, None
        return measured(self._core, self._core.on_targets, arguments, targets, cells, progress, normals)

    def hourly_sun(
        self,
        year: int,
        *,
        sun_tolerance_deg: float | None = None,
        cell: float | None = None,
        target_height: float | None = None,
        surface: bool = False,
        ground: Ground | None = None,
        location: Location | None = None,
        zone: Zone | None = None,
        sun_elevation: SunElevation = "apparent",
        air: Numbers | None = None,
        progress: Progress = None,
    ) -> Rasters:
        """Sun of each hour of a year, a bit for each day: the hourly shade of the Google Solar API.

        Trees are opaque. The rasters take 1152 bytes a cell.

        Parameters
        ----------
        year : int
            The year.
        sun_tolerance_deg, cell, target_height, surface, ground, location, zone, sun_elevation, air
            As for `sun_hours`.
        progress : bool or callable, optional

        Returns
        -------
        Rasters
            288 rasters of uint32, named by month and hour of the clock: ``06_15`` for June, from 15:00 to 16:00. Bit
            ``day - 1`` is set if the sun reaches the cell on that day, in the middle of the hour. ``nodata`` is 2**31.

        Raises
        ------
        BelvedereError
            For a scene without a place on earth, parameters out of range, and more than 8 GiB of bits.

        References
        ----------
        docs/methods/sun.md

        Examples
        --------
        >>> sun = scene.hourly_sun(2026, zone="Europe/Amsterdam", cell=5, sun_tolerance_deg=3)
        >>> june = sun["06_15"]
        >>> days = june.values[june.values != june.nodata]
        >>> lit = days >> 20 & 1  # 21 June, half past three
        >>> bool(0 < lit.mean() < 1)
        True
        """
        check_finite(sun_tolerance_deg=sun_tolerance_deg)
        question = given(
            days=days_of(None, None, year),
            place=place_of(location, zone=zone, sun_elevation=sun_elevation, air=air),
            sun_tolerance_deg=sun_tolerance_deg,
        )
        cells = wanted(None, None, cells_of(cell, target_height, surface, ground))
        bands, grid, found = self._core.hourly_sun(year, question, cells, reporter(progress))
        if grid is None:
            raise wrong("targets", "no cells", "give none")
        remarks = warned(found)
        text = "days with sun in the middle of an hour, a bit for each"
        named = {"nodata": 2.0**31, "unit": "1", "description": text}
        made = Rasters({name: raster(days, grid, self._core.crs, name=name, **named) for name, days in bands})
        for one in made.values():
            one.remarks = remarks
        return made

    @overload
    def sky_view(
        self,
        *,
        targets: None = None,
        **more: Unpack[SkyView],
    ) -> Rasters: ...
    @overload
    def sky_view(
        self,
        *,
        targets: Rows,
        **more: Unpack[SkyView],
    ) -> Table: ...
    def sky_view(
        self,
        *,
        directions: int | None = None,
        patches: Patches | None = None,
        targets: Targets = None,
        normals: Numbers | None = None,
        cell: float | None = None,
        target_height: float | None = None,
        surface: bool = False,
        ground: Ground | None = None,
        through_trees: ThroughTrees | None = None,
        interval: bool = False,
        progress: Progress = None,
    ) -> Rasters | Table:
        """How much of the sky places see.

        Parameters
        ----------
        directions : int, optional
            Number of directions of the sky; 577 if not given.
        patches : {'tregenza', 'reinhart'}, optional
            Patches of the sky in place of even directions.
        targets, normals, cell, target_height, surface, ground, through_trees
            As for `shadow`.
        interval : bool, optional
            Whether to add the expected value and an interval that holds the truth in 90 % of cases. Only where trees
            are opaque.
        progress : bool or callable, optional

        Returns
        -------
        Rasters or Table
            ``sky_view_factor`` (cosine-weighted) and ``sky_openness`` (unweighted), 0 to 1; with `interval` also
            ``factor_expected``, ``factor_low``, ``factor_high``, ``open_expected``, ``open_low`` and ``open_high``.

        References
        ----------
        docs/methods/sky-view.md

        Examples
        --------
        >>> sky = scene.sky_view(targets=targets)
        >>> sky["sky_view_factor"].shape == (len(targets),)
        True
        """
        question = given(sky=sky_parts(directions, patches), trees=trees_of(through_trees), **switch(interval=interval))
        cells = cells_of(cell, target_height, surface, ground)
        arguments = {"sky-view": question}, None
        return measured(self._core, self._core.on_targets, arguments, targets, cells, progress, normals)

    def sun_position(self, time: Time | Iterable[Time], *, location: Location | None = None) -> npt.NDArray[np.float64]:
        """Azimuth, clockwise from true north, and elevation of the sun above the scene, degrees.

        Parameters
        ----------
        time : datetime, pandas Timestamp, ISO text, or several
            With a time zone.
        location : array_like, shape (2,), or Location of pvlib, optional
            Latitude and longitude, degrees, where the reference system does not say where the scene lies.

        Returns
        -------
        ndarray, shape (2,) or (N, 2)

        Examples
        --------
        >>> scene.sun_position("2026-06-21T12:00+02:00").round(1)
        array([...])
        """
        texts, is_one = times(time)
        positions = np.array(self._core.sun_positions({"times": texts, "place": place_of(location)}))
        return positions[0] if is_one else positions
