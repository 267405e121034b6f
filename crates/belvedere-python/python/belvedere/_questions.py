"""Questions as data: dictionaries with the fields of the native questions, and the parts that several of them have."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, TypedDict, get_args

import numpy as np

from ._errors import wrong
from ._inputs import check_finite, check_whole, day_texts, location_pair, moments, number_pair, times, zone_text
from ._types import (
    Curvature,
    Ground,
    Leaves,
    Location,
    Numbers,
    Patches,
    SunElevation,
    ThroughTrees,
    Time,
    Unproven,
    Zone,
)


class Cells(TypedDict, total=False):
    """How cells are laid."""

    cell: float | None
    target_height: float | None
    surface: bool
    ground: Ground | None


_DIRECTION = "give azimuth and elevation in degrees, such as (180, 30)"
#: Words that questions lack, or have under another name.
_NATIVE = {"report": None, "as-visible": "visible", "as-blocked": "blocked", "class": "classed"}


def given(**fields: Any) -> dict[str, Any]:
    """Fields without those that are not given, which keep the defaults of the library."""
    return {name: value for name, value in fields.items() if value is not None}


def word(known: Any, **value: Any) -> str | None:
    """The word of a keyword as questions have it; `known` is the `Literal` of its words."""
    ((name, text),) = value.items()
    if text is None:
        return None
    if not isinstance(text, str):
        raise wrong(name, repr(text), "give a word; help() lists them")
    *words, last = map(repr, get_args(known))
    if text not in get_args(known):
        raise wrong(name, repr(text), f"use {', '.join(words)} or {last}")
    return _NATIVE.get(text, text.replace("-", "_"))


def switch(**values: Any) -> dict[str, bool]:
    """Fields that are true or false."""
    for name, value in values.items():
        if not isinstance(value, (bool, np.bool_)):
            raise wrong(name, repr(value), "give True or False")
    return values


def ground_of(ground: Ground | None) -> str | None:
    """The source of ground points."""
    return word(Ground, ground="auto" if ground is None else ground)


def unproven_as(unproven: Unproven) -> str | None:
    """What unproven lines of sight count as; None where they are reported."""
    return word(Unproven, unproven=unproven)


def how_sure(probability: bool, certain: float | None) -> dict[str, Any]:
    """The certainty of answers."""
    return given(**switch(probability=probability), certain=certain)


def earth(curvature: Curvature | None, refraction: float | None) -> dict[str, Any]:
    """Curvature of the earth on lines of sight."""
    check_finite(refraction=refraction)
    return given(curvature=word(Curvature, curvature=curvature), refraction=refraction)


def north(grid_north: bool) -> str:
    """The north of azimuths."""
    return "grid" if switch(grid_north=grid_north)["grid_north"] else "true"


def sky_parts(directions: int | None, patches: Patches | None = None) -> Any:
    """The division of the sky."""
    check_whole(directions=directions)
    return word(Patches, patches=patches) or (None if directions is None else {"even": directions})


def trees_of(through_trees: ThroughTrees | None, leaves: Leaves | None = None) -> Any:
    """The light that passes through crowns."""
    follows_leaves = isinstance(through_trees, str) and through_trees in ("measured", "seasons", "pulses")
    if leaves is not None and not follows_leaves:
        raise wrong("leaves", repr(leaves), "give it with through_trees='measured', 'seasons' or 'pulses' only")
    state = word(Leaves, leaves=leaves)
    if follows_leaves:
        return {through_trees: "by_date" if state in (None, "auto") else state}
    if through_trees is None or through_trees == "none":
        return None
    if isinstance(through_trees, str):
        advice = "use 'measured', 'none', 'seasons', 'pulses', or a number from 0 to 1"
        raise wrong("through_trees", repr(through_trees), advice)
    return {"share": through_trees}


def cells_of(cell: float | None, target_height: float | None, surface: bool, ground: Ground | None) -> Cells:
    """Cells of a grid."""
    return {"cell": cell, "target_height": target_height, "surface": surface, "ground": ground}


def days_of(
    date: Any,
    period: Any,
    year: int | None,
    time_step_min: float | None = None,
    min_sun_elevation_deg: float | None = None,
) -> dict[str, Any]:
    """Days of the sun."""
    check_whole(year=year)
    check_finite(time_step_min=time_step_min, min_sun_elevation_deg=min_sun_elevation_deg)
    if date is not None and period is not None:
        raise wrong("date and period", "given together", "give one of them")
    return given(
        dates=None if date is None else day_texts(date),
        between=None if period is None else moments(period),
        year=year,
        time_step_min=time_step_min,
        min_sun_elevation_deg=min_sun_elevation_deg,
    )


def suns_of(sun: Numbers | None, time: Time | Iterable[Time] | None) -> tuple[dict[str, Any], bool]:
    """Directions or times, and whether there is one that was not given in a list."""
    if (sun is None) == (time is None):
        raise wrong("sun and time", "both given" if sun is not None else "missing", "give one of them")
    if time is not None:
        texts, is_one = times(time)
        return {"times": texts}, is_one
    try:
        array = np.asarray(sun, np.float64)
    except (TypeError, ValueError):
        raise wrong("sun", repr(sun), _DIRECTION) from None
    if array.ndim == 1:
        return {"directions": [number_pair(array, "sun", _DIRECTION)]}, True
    if array.ndim != 2 or array.shape[1] != 2 or not len(array):
        raise wrong("sun", f"an array of shape {array.shape}", _DIRECTION)
    return {"directions": [number_pair(one, "sun", _DIRECTION) for one in array]}, False


def place_of(
    location: Location | None,
    *,
    zone: Zone | None = None,
    grid_north: bool = False,
    sun_elevation: SunElevation = "apparent",
    air: Numbers | None = None,
) -> dict[str, Any]:
    """The place on earth, its clocks, its air and its north."""
    refraction: Any = "without" if word(SunElevation, sun_elevation=sun_elevation) == "geometric" else None
    if air is not None:
        if refraction is not None:
            raise wrong("air", "given", "leave it out where sun_elevation='geometric'")
        what = "give pressure in hPa and temperature in degrees Celsius"
        pressure, temperature = number_pair(air, "air", what)
        refraction = {"air": {"pressure": pressure, "temperature": temperature}}
    return given(location=location_pair(location), zone=zone_text(zone), refraction=refraction, north=north(grid_north))
