"""Questions about the energy of sun and sky."""

from __future__ import annotations

import json
import os
import warnings
from typing import Any

import numpy.typing as npt

from . import _core
from ._errors import BelvedereWarning
from ._inputs import Progress, check_finite, number_pair, reporter
from ._raster import Rasters
from ._sunlight import _cells
from ._table import Table
from ._targets import Targets, measures, wanted


class Energy:
    """The energy of sun and sky."""

    _core: _core.Scene

    def irradiance(
        self,
        *,
        weather: str | os.PathLike[str] | None = None,
        clear_sky: str | None = None,
        linke: float | None = None,
        year: int | None = None,
        months: bool = False,
        sky_model: str | None = None,
        patch_division: int | None = None,
        parts_per_row: int | None = None,
        albedo: float | None = None,
        surroundings: str | None = None,
        sun_cell_deg: float | None = None,
        targets: Targets = None,
        normals: npt.ArrayLike | None = None,
        cell: float | None = None,
        target_height: float | None = None,
        surface: bool = False,
        ground: str | None = None,
        through_trees: str | float | None = None,
        leaves: str | None = None,
        location: npt.ArrayLike | None = None,
        progress: Progress = None,
    ) -> Rasters | Table:
        """The energy that sun and sky send to places in a year, or in the period of a weather file.

        Parameters
        ----------
        weather : path, optional
            Weather file: EPW, TMY3, CSV of PVGIS or of NSRDB.
        clear_sky : {'ineichen', 'haurwitz', 'bird'}, optional
            A year without clouds, in place of `weather`.
        linke : float, optional
            Turbidity for ``'ineichen'``; 3 if not given.
        year : int, optional
            Year of the clear sky; 2026 if not given.
        months : bool, optional
            Whether there is a result for each month too.
        sky_model : {'patches', 'perez', 'hay-davies', 'isotropic'}, optional
            Model of the diffuse sky; patches if not given.
        patch_division : int, optional
            1 for 145 patches of the sky, 2 for 577 (if not given), 4 for 2305.
        parts_per_row : int, optional
            Suns for each row of weather; 4 if not given.
        albedo : float, optional
            Of the ground, 0 to 1; 0.2 if not given.
        surroundings : {'dark', 'like-ground'}, optional
            What obstacles send in place of the sky that they hide; nothing if not given.
        sun_cell_deg : float, optional
            Side of the cells that sun directions are grouped in; 3 if not given.
        targets, normals, cell, target_height, surface, ground, through_trees, leaves, location
            As for `shadow`. The place of a weather file counts where the reference system says nothing.
        progress : bool or callable, optional

        Returns
        -------
        Rasters or Table
            ``kwh_m2`` (all), the share that obstacles take, and direct, diffuse and reflected parts, kWh per square
            metre.

        Raises
        ------
        BelvedereError
            Without a source of radiation, for a scene without a place on earth, and parameters out of range.

        Warns
        -----
        BelvedereWarning
            Where the times of the weather do not fit the place.

        References
        ----------
        docs/methods/irradiance.md

        Examples
        --------
        >>> energy = scene.irradiance(clear_sky="ineichen", cell=4)
        >>> bool(0 < np.nanmax(energy["kwh_m2"]) < 2500)
        True
        """
        where = "give latitude and longitude in degrees, such as (52.0, 4.4)"
        check_finite(linke=linke, albedo=albedo, sun_cell_deg=sun_cell_deg)
        radiation: dict[str, Any] = {
            "weather": None if weather is None else os.fspath(weather),
            "clear_sky": clear_sky,
            "linke": linke,
            "year": year,
            "parts": parts_per_row,
            "sky_model": sky_model,
            "patch_division": patch_division,
            "albedo": albedo,
            "surroundings": surroundings,
            "sun_cell": sun_cell_deg,
            "months": months,
            "location": None if location is None else number_pair(location, "location", where),
        }
        columns, grid, text = self._core.irradiance(
            radiation,
            wanted(targets, normals, _cells(cell, target_height, surface, ground)),
            {"share": through_trees, "leaves": leaves},
            reporter(progress),
        )
        report = json.loads(text)
        if report["is_doubtful"] or report["night_hours"] > 0:
            warnings.warn(
                "the weather has radiation while the sun is below the horizon: are its location and time zone correct?",
                BelvedereWarning,
                stacklevel=2,
            )
        return measures(columns, grid, self._core.crs, targets)
