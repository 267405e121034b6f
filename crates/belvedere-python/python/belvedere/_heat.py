"""Questions about the heat stress of people."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, overload

from . import _core
from ._energy import native_weather
from ._inputs import check_finite, check_whole, location_pair, number_pair
from ._keywords import Heat as HeatKeywords
from ._questions import cells_of, days_of, given, place_of, switch, trees_of, word
from ._raster import Rasters
from ._table import Table
from ._targets import Rows, Targets, measured
from ._types import (
    Body,
    Day,
    Ground,
    GroundCover,
    Leaves,
    Location,
    Numbers,
    Period,
    Progress,
    Source,
    ThroughTrees,
    Zone,
)

if TYPE_CHECKING:
    import pandas
    from typing_extensions import Unpack


class Heat:
    """The heat stress of people."""

    _core: _core.Scene

    @overload
    def heat(
        self,
        *,
        weather: Source | pandas.DataFrame,
        targets: None = None,
        **more: Unpack[HeatKeywords],
    ) -> Rasters: ...
    @overload
    def heat(
        self,
        *,
        weather: Source | pandas.DataFrame,
        targets: Rows,
        **more: Unpack[HeatKeywords],
    ) -> Table: ...
    def heat(
        self,
        *,
        weather: Source | pandas.DataFrame,
        date: Day | Iterable[Day] | None = None,
        period: Period | None = None,
        between: Numbers | None = None,
        by_hour: bool = False,
        pet: bool = False,
        body: Body = "standing",
        ground_cover: GroundCover = "paved",
        ground_warming: float | None = None,
        wind_factor: float | None = None,
        parts_per_row: int | None = None,
        targets: Targets = None,
        cell: float | None = None,
        target_height: float | None = None,
        surface: bool = False,
        ground: Ground | None = None,
        through_trees: ThroughTrees | None = None,
        leaves: Leaves | None = None,
        location: Location | None = None,
        zone: Zone | None = None,
        progress: Progress = None,
    ) -> Rasters | Table:
        """UTCI and mean radiant temperature of people, over hours of days of weather.

        Parameters
        ----------
        weather : path, file, bytes or pandas.DataFrame
            Weather with temperature and humidity: EPW, TMY3, CSV of PVGIS or of NSRDB. Or rows as pvlib has them:
            ``ghi``, ``dni``, ``dhi``, ``temp_air``, ``relative_humidity`` and ``wind_speed``, at the middle of what
            each row holds, with a time zone; then `location` is needed.
        date : date or str, or several, optional
            Days. A typical year has each day once, and the year does not matter.
        period : tuple of two, optional
            First and last day, or two times, in place of `date`.
        between : array_like, shape (2,), optional
            Hours of each day that count, on the clocks of `zone`; all if not given.
        by_hour : bool, optional
            Whether each hour is given too, 48 at most.
        pet : bool, optional
            Whether to add the Physiological Equivalent Temperature of a standing man of 35 years, lightly active.
        body : {'standing', 'sitting', 'round'}, optional
            Shape of the body that absorbs radiation.
        ground_cover : {'paved', 'asphalt', 'grass', 'soil'}, optional
            Cover of the ground.
        ground_warming : float, optional
            Share of the published warming of surfaces in the sun, 0 to 2; 0.5 if not given. 0 and 1 are the ends of
            what is not known.
        wind_factor : float, optional
            Factor of the wind, 0 to 2; 1 if not given. Shelter by buildings is not computed.
        parts_per_row : int, optional
            Suns for each row of weather; 4 if not given.
        target_height : float, optional
            Height of cells above the ground, metres; 1.1 if not given, the middle of a person.
        targets, cell, surface, ground, through_trees, leaves, location, zone
            As for `shadow`. The place of a weather file counts where the reference system says nothing.
        progress : bool or callable, optional

        Returns
        -------
        Rasters or Table
            ``utci_max``, ``utci_mean``, ``tmrt_max`` and ``tmrt_mean``, °C; ``hours_32`` and ``hours_38``, hours a day
            of strong and very strong heat stress; with `pet` also ``pet_max`` and ``pet_mean``; with `by_hour` also
            ``utci_`` and ``tmrt_`` of each hour.

        Raises
        ------
        BelvedereError
            Without days, for days that the weather does not have, for weather without temperature or humidity, for a
            scene of balls without points, and parameters out of range.

        Warns
        -----
        BelvedereWarning
            Where the times or the place of the weather do not fit the scene, and where rows of it are left out.

        References
        ----------
        docs/methods/heat.md

        Examples
        --------
        >>> heat = scene.heat(weather=folder / "weather.csv", date="07-21", between=(10, 16), zone="UTC", cell=8)
        >>> list(heat)
        ['utci_max', 'utci_mean', 'tmrt_max', 'tmrt_mean', 'hours_32', 'hours_38']
        >>> heat["utci_max"].unit
        '°C'
        """
        check_finite(ground_warming=ground_warming, wind_factor=wind_factor)
        check_whole(parts_per_row=parts_per_row)
        hours = None if between is None else number_pair(between, "between", "give two hours, such as (10, 17)")
        question = given(
            days=days_of(date, period, None),
            hours=hours,
            place=place_of(location, zone=zone),
            body=word(Body, body=body),
            surfaces=given(ground=word(GroundCover, ground_cover=ground_cover), warming=ground_warming),
            trees=trees_of(through_trees, leaves),
            parts=parts_per_row,
            wind_factor=wind_factor,
            **switch(by_hour=by_hour, pet=pet),
        )
        arguments = {"heat": question}, native_weather(weather, location_pair(location))
        cells = cells_of(cell, target_height, surface, ground)
        return measured(self._core, self._core.on_targets, arguments, targets, cells, progress)
