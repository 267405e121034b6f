"""Open surveys of a place."""

from __future__ import annotations

import json
import os
import warnings
from collections.abc import Sequence
from typing import Any

from . import _core
from ._cloud import Cloud, cloud_of
from ._errors import BelvedereWarning, wrong
from ._inputs import check_finite, reporter
from ._types import Progress


def open_surveys(
    at: Sequence[float],
    *,
    radius: float = 200.0,
    surveys: str | os.PathLike[str] | None = None,
    progress: Progress = None,
) -> list[dict[str, Any]]:
    """The published point clouds that may cover a place.

    Surveys are found by boxes around their areas, and by their tiles where a service tells them. The list is empty
    where a survey has no tile.

    Parameters
    ----------
    at : (latitude, longitude)
        The place in degrees, north and east positive.
    radius : float
        Distance to the sides of the square around it, 1 to 5000 metres.
    surveys : path, optional
        A table of surveys (``.json``) instead of that of the package; the page on data describes its fields.
    progress : bool or callable, optional
        True shows a bar; a function is called with stage, items done and items in all, and stops the work by raising.

    Returns
    -------
    list of dict
        For each survey ``name``, ``title``, ``licence``, ``attribution``, ``page``, ``tiles`` (address without its key,
        and bytes and date where they are known) and ``covered_percent``, the share of the square that they cover.
        Surveys whose tiles people choose on a page have no tiles, and those that were not reached have a ``failure``.

    Raises
    ------
    BelvedereError
        For places that no survey of the table covers.
    OSError
        For a table that cannot be read.

    Examples
    --------
    >>> for survey in belvedere.open_surveys((52.0116, 4.3571)):  # doctest: +SKIP
    ...     print(survey["name"], survey["licence"], len(survey["tiles"]))
    ahn6 CC BY 4.0 1
    ahn5 CC BY 4.0 1
    """
    found: list[dict[str, Any]] = json.loads(_core.open_surveys(_area(at, radius, None, surveys), reporter(progress)))
    return found


def fetch(
    at: Sequence[float],
    *,
    radius: float = 200.0,
    survey: str | None = None,
    surveys: str | os.PathLike[str] | None = None,
    progress: Progress = None,
) -> Cloud:
    """The points of an open survey around a place.

    COPC files are read in part. Other files are downloaded whole, and points outside the square are then dropped.

    Parameters
    ----------
    at : (latitude, longitude)
        The place in degrees, north and east positive.
    radius : float
        Distance to the sides of the square around it, 1 to 1000 metres.
    survey : str, optional
        Name of the survey, as :func:`open_surveys` lists them; the first that covers the square if not given.
    surveys : path, optional
        A table of surveys (``.json``) instead of that of the package.
    progress : bool or callable, optional
        True shows a bar; a function is called with stage, items done and items in all, and stops the work by raising.

    Returns
    -------
    Cloud
        In the reference system of the survey. Its `report` has the ``survey`` with licence and attribution.

    Raises
    ------
    BelvedereError
        For places that no survey covers, surveys whose tiles people choose on a page, and services that do not answer.
    OSError
        For tiles whose server does not answer, and a table that cannot be read.

    Warns
    -----
    BelvedereWarning
        Where a survey was not reached, and where tiles cover a part of the square only.

    Examples
    --------
    >>> cloud = belvedere.fetch((52.0116, 4.3571), radius=150)  # doctest: +SKIP
    >>> belvedere.Scene(cloud).sun_hours(date="2026-03-21")  # doctest: +SKIP
    """
    core, text, chosen, given = _core.fetch(_area(at, radius, survey, surveys), reporter(progress))
    for warning in given:
        warnings.warn(warning, BelvedereWarning, stacklevel=2)
    return cloud_of(core, {**json.loads(text), "survey": json.loads(chosen)})


def _area(
    at: Sequence[float], radius: float, survey: str | None, surveys: str | os.PathLike[str] | None
) -> dict[str, Any]:
    check_finite(radius=radius)
    try:
        latitude, longitude = (float(value) for value in at)
    except (TypeError, ValueError):
        raise wrong("at", repr(at), "give latitude and longitude in degrees, such as (52.01, 4.36)") from None
    table = None if surveys is None else os.fspath(surveys)
    return {"at": [latitude, longitude], "radius": float(radius), "survey": survey, "surveys": table}
