"""Simulated towns."""

from __future__ import annotations

import numpy as np

from . import _core
from ._cloud import Cloud
from ._inputs import check_finite
from ._types import Town

#: The Dutch grid with heights above NAP, in which simulated towns lie.
_SYSTEM = "EPSG:7415"


def simulate(town: Town = "town", *, extent: float | None = None, density: float | None = None, seed: int = 1) -> Cloud:
    """An airborne laser scan of a simulated town: a cloud to try things with.

    `belvedere simulate` writes the same scan with its exact mesh, and has more choices.

    Parameters
    ----------
    town : {'town', 'village', 'old-town', 'towers', 'park'}
        Type of town.
    extent : float, optional
        Side of the town, 60 to 5000 metres; 150 if not given.
    density : float, optional
        Pulses per square metre, 0.1 to 200; 10 if not given.
    seed : int, optional
        Another number gives another town.

    Returns
    -------
    Cloud
        With classes, GPS times, return numbers and scan angles, in EPSG:7415.

    Raises
    ------
    BelvedereError
        For a town that is not known and for numbers out of range.

    Examples
    --------
    >>> belvedere.simulate("village", extent=60, density=2)
    <belvedere.Cloud: ... points, EPSG:7415 (Amersfoort / RD New + NAP height), metres; classification, gps_time, ...>
    """
    check_finite(extent=extent, density=density)
    scan = _core.simulate(town, extent, density, seed)
    xyz = np.column_stack([scan.pop(axis) for axis in "xyz"])
    return Cloud(xyz, crs=_SYSTEM, adjusted_gps_time=True, **scan)
