"""Parts that several questions have: cells, days, suns, and the place on earth."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from ._errors import wrong
from ._inputs import check_whole, check_words, day_texts, location_pair, moments, number_pair, times, zone_text
from ._targets import Cells
from ._types import Ground, Location, Numbers, SunElevation, Time, Zone

_DIRECTION = "give azimuth and elevation in degrees, such as (180, 30)"


def _cells(cell: float | None, target_height: float | None, surface: bool, ground: Ground | None) -> Cells:
    check_words(ground=ground)
    return {"cell": cell, "target_height": target_height, "surface": surface, "ground": ground}


def _days(
    date: Any,
    period: Any,
    year: int | None,
    time_step_min: float | None,
    min_sun_elevation_deg: float | None = None,
    sun_tolerance_deg: float | None = None,
) -> dict[str, Any]:
    check_whole(year=year)
    if date is not None and period is not None:
        raise wrong("date and period", "given together", "give one of them")
    return {
        "dates": [] if date is None else day_texts(date),
        "between": None if period is None else moments(period),
        "year": year,
        "step": time_step_min,
        "min_sun_elevation": min_sun_elevation_deg,
        "tolerance": sun_tolerance_deg,
    }


def _suns(sun: Numbers | None, time: Time | Iterable[Time] | None) -> tuple[Any, bool]:
    """Directions or times, and whether there is one that was not given in a list."""
    if (sun is None) == (time is None):
        raise wrong("sun and time", "both given" if sun is not None else "missing", "give one of them")
    if time is not None:
        return times(time)
    try:
        array = np.asarray(sun, np.float64)
    except (TypeError, ValueError):
        raise wrong("sun", repr(sun), _DIRECTION) from None
    if array.ndim == 1:
        return [number_pair(array, "sun", _DIRECTION)], True
    if array.ndim != 2 or array.shape[1] != 2 or not len(array):
        raise wrong("sun", f"an array of shape {array.shape}", _DIRECTION)
    return [number_pair(one, "sun", _DIRECTION) for one in array], False


def _place(
    location: Location | None,
    *,
    zone: Zone | None = None,
    grid_north: bool = False,
    sun_elevation: SunElevation = "apparent",
    air: Numbers | None = None,
) -> dict[str, Any]:
    if sun_elevation not in ("apparent", "geometric"):
        raise wrong("sun_elevation", repr(sun_elevation), "use 'apparent' or 'geometric'")
    what = "give pressure in hPa and temperature in degrees Celsius"
    return {
        "location": location_pair(location),
        "zone": zone_text(zone),
        "grid_north": grid_north,
        "geometric": sun_elevation == "geometric",
        "air": None if air is None else number_pair(air, "air", what),
    }
