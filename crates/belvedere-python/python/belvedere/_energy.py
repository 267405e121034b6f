"""Questions about the energy of sun and sky."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, overload

import numpy as np
import numpy.typing as npt

from . import _core
from ._errors import wrong
from ._inputs import check_finite, check_whole, location_pair, native_source, reporter
from ._keywords import Irradiance
from ._questions import cells_of, given, ground_of, place_of, switch, trees_of, word
from ._raster import Rasters
from ._remarks import warned
from ._table import Table
from ._targets import Rows, Targets, measured
from ._types import (
    ClearSky,
    Ground,
    Leaves,
    Location,
    Numbers,
    Progress,
    SkyModel,
    Source,
    Surroundings,
    ThroughTrees,
)

if TYPE_CHECKING:
    import pandas
    from typing_extensions import Unpack


class Energy:
    """The energy of sun and sky."""

    _core: _core.Scene

    @overload
    def irradiance(
        self,
        *,
        targets: None = None,
        **more: Unpack[Irradiance],
    ) -> Rasters: ...
    @overload
    def irradiance(
        self,
        *,
        targets: Rows,
        **more: Unpack[Irradiance],
    ) -> Table: ...
    def irradiance(
        self,
        *,
        weather: Source | pandas.DataFrame | None = None,
        clear_sky: ClearSky | None = None,
        linke: float | None = None,
        year: int | None = None,
        months: bool = False,
        sky_model: SkyModel | None = None,
        patch_division: int | None = None,
        parts_per_row: int | None = None,
        albedo: float | None = None,
        surroundings: Surroundings | None = None,
        sun_cell_deg: float | None = None,
        targets: Targets = None,
        normals: Numbers | None = None,
        cell: float | None = None,
        target_height: float | None = None,
        surface: bool = False,
        ground: Ground | None = None,
        through_trees: ThroughTrees | None = None,
        leaves: Leaves | None = None,
        location: Location | None = None,
        interval: bool = False,
        progress: Progress = None,
    ) -> Rasters | Table:
        """The energy that sun and sky send to places in a year, or in the period of a weather file.

        Parameters
        ----------
        weather : path, file, bytes or pandas.DataFrame, optional
            Weather file: EPW, TMY3, CSV of PVGIS or of NSRDB. Or rows as pvlib has them: columns ``ghi``, ``dni``,
            ``dhi`` in W/m² and perhaps ``temp_air``, at the middle of what each row holds, with a time zone; then
            `location` is needed.
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
        interval : bool, optional
            Whether to add the expected value and an interval that holds the truth in 90 % of cases. Only where trees
            are opaque.
        progress : bool or callable, optional

        Returns
        -------
        Rasters or Table
            ``kwh_m2`` (all), the share that obstacles take, and direct, diffuse and reflected parts, kWh per square
            metre; with `interval` also ``kwh_m2_expected``, ``kwh_m2_low`` and ``kwh_m2_high``.

        Raises
        ------
        BelvedereError
            Without a source of radiation, for a scene without a place on earth, and parameters out of range.

        Warns
        -----
        BelvedereWarning
            Where the times or the place of the weather do not fit the scene, and where rows of it are left out.

        References
        ----------
        docs/methods/irradiance.md

        Examples
        --------
        >>> energy = scene.irradiance(clear_sky="ineichen", cell=4)
        >>> bool(0 < np.nanmax(energy["kwh_m2"]) < 2500)
        True
        """
        radiation = _radiation(weather, clear_sky, linke, year, parts_per_row, location)
        summation = given(
            params=_params(sky_model, patch_division, sun_cell_deg, albedo, surroundings, months),
            place=place_of(location),
            trees=trees_of(through_trees, leaves),
            **switch(interval=interval),
        )
        cells = cells_of(cell, target_height, surface, ground)
        arguments = radiation, summation
        return measured(self._core, self._core.irradiance, arguments, targets, cells, progress, normals)

    def roof_planes(
        self,
        *,
        weather: Source | pandas.DataFrame | None = None,
        clear_sky: ClearSky | None = None,
        linke: float | None = None,
        year: int | None = None,
        months: bool = False,
        sky_model: SkyModel | None = None,
        patch_division: int | None = None,
        parts_per_row: int | None = None,
        albedo: float | None = None,
        surroundings: Surroundings | None = None,
        sun_cell_deg: float | None = None,
        min_area: float | None = None,
        panel: float | None = None,
        min_cells: int | None = None,
        footprints: Source | None = None,
        module_efficiency: float | None = None,
        temperature_coefficient: float | None = None,
        system_losses: float | None = None,
        inverter_efficiency: float | None = None,
        dc_ac_ratio: float | None = None,
        hourly: bool = False,
        ground: Ground | None = None,
        through_trees: ThroughTrees | None = None,
        leaves: Leaves | None = None,
        location: Location | None = None,
        interval: bool = False,
        progress: Progress = None,
    ) -> Table:
        """The planes of roofs, the energy that each receives, and the electricity of panels on it.

        Parameters
        ----------
        weather, clear_sky, linke, year, months, sky_model, patch_division, parts_per_row, albedo, surroundings
            As for `irradiance`.
        sun_cell_deg, ground, through_trees, leaves, location, interval
            As for `irradiance`.
        min_area : float, optional
            Smallest area of a plane, square metres; that of the command line if not given.
        panel : float, optional
            Side of the panels that a plane is divided into, metres; a row of panels is a string.
        min_cells : int, optional
            Smallest number of cells of a plane that is listed; 10 if not given. Smaller planes are counted in a remark.
        footprints : path, file or bytes, optional
            Outlines of buildings: polygons of GeoJSON, or a city model of CityJSON. If not given, planes that touch are
            one building.
        module_efficiency : float, optional
            Peak power of panels, kW per square metre; 0.2 if not given.
        temperature_coefficient : float, optional
            Change of their power per degree Celsius, as a share; -0.0037 if not given.
        system_losses : float, optional
            Share of the direct current lost without shading; 0.1142 if not given.
        inverter_efficiency : float, optional
            Nominal efficiency of the inverters; 0.96 if not given.
        dc_ac_ratio : float, optional
            Peak power of panels for each power of their inverter; 1.2 if not given.
        hourly : bool, optional
            Whether there is a table of hours for each plane too.
        progress : bool or callable, optional

        Returns
        -------
        Table
            A row for each plane: ``cells``, ``area_m2``, ``tilt_deg``, ``azimuth_deg`` from true north (NaN for a level
            plane), the source of its ``radiation``, ``kwh_m2`` and its parts, ``min_loss`` where each panel works
            alone, ``max_loss`` where the worst panel limits its row, and ``radiation_kwh``. Of electricity: ``kwp``,
            ``dc_kwh``, ``ac_kwh``, ``kwh_per_kwp`` and ``performance_ratio`` where each panel works alone, and
            ``string_dc_kwh``, ``string_ac_kwh`` and ``string_kwh_per_kwp`` where the worst panel limits its row. With
            `interval` also ``kwh_m2_expected``, ``kwh_m2_low``, ``kwh_m2_high``, ``loss_expected``, ``loss_low`` and
            ``loss_high``. `places` has the middle of each plane, `buildings` the sums of each building, and `hours` a
            table for each plane if `hourly`.

        Raises
        ------
        BelvedereError
            Without a source of radiation, for a cloud without roofs, and parameters out of range.

        References
        ----------
        docs/methods/irradiance.md

        Examples
        --------
        >>> roofs = scene.roof_planes(clear_sky="ineichen", sun_cell_deg=6, patch_division=1)
        >>> bool((roofs["max_loss"] >= roofs["min_loss"]).all()), roofs.places.shape == (roofs.row_count, 3)
        (True, True)
        >>> bool((roofs["string_ac_kwh"] <= roofs["ac_kwh"]).all()), str(roofs["radiation"][0])
        (True, 'clear sky of Ineichen & Perez; Linke turbidity 3; 2026')
        """
        check_finite(min_area=min_area, panel=panel)
        check_whole(min_cells=min_cells)
        system = given(
            module_efficiency=module_efficiency,
            temperature_coefficient=temperature_coefficient,
            system_losses=system_losses,
            inverter_efficiency=inverter_efficiency,
            dc_ac_ratio=dc_ac_ratio,
        )
        roofs = given(min_area=min_area, panel=panel, min_cells=min_cells, system=system)
        radiation = _radiation(weather, clear_sky, linke, year, parts_per_row, location)
        summation = given(
            params=_params(sky_model, patch_division, sun_cell_deg, albedo, surroundings, months),
            place=place_of(location),
            trees=trees_of(through_trees, leaves),
            roofs=roofs,
            **switch(interval=interval),
        )
        planes, buildings, hours, remarks = self._core.roof_planes(
            radiation,
            summation,
            None if footprints is None else native_source(footprints, None),
            ground_of(ground),
            switch(hourly=hourly)["hourly"],
            reporter(progress),
        )
        found = _as_arrays(planes)
        middle = np.column_stack([found.pop(axis) for axis in "xyz"])
        table = Table(found, places=middle, crs=self._core.crs.text)
        table.buildings = Table(_as_arrays(buildings))
        table.hours = [Table(_as_arrays(of_plane)) for of_plane in hours]
        table.remarks = warned(remarks)
        return table


def _as_arrays(columns: list[tuple[str, Any]]) -> dict[str, npt.NDArray[Any]]:
    """Columns of numbers and of words."""
    return {name: np.array(values, str) if isinstance(values, list) else values for name, values in columns}


def native_weather(weather: Any, location: tuple[float, float] | None) -> Any:
    """A file of weather, or rows of a DataFrame, as the native part takes them."""
    return _as_file(weather, location) if hasattr(weather, "columns") else native_source(weather, None)


def _radiation(
    weather: Any,
    clear_sky: ClearSky | None,
    linke: float | None,
    year: int | None,
    parts_per_row: int | None,
    location: Location | None,
) -> dict[str, Any]:
    """The source of radiation as the native part takes it."""
    check_finite(linke=linke)
    check_whole(year=year, parts_per_row=parts_per_row)
    model = word(ClearSky, clear_sky=clear_sky)
    if linke is not None and model != "ineichen":
        raise wrong("linke", "given", "it needs clear_sky='ineichen'")
    if weather is not None and model is not None:
        raise wrong("weather and clear_sky", "given together", "give one of them")
    if weather is None and model is None:
        raise wrong("radiation", "missing", "give weather='file.epw' or clear_sky='ineichen'")
    file = None if weather is None else native_weather(weather, location_pair(location))
    return {"weather": file, "clear_sky": model, "linke": linke, "year": year, "parts": parts_per_row}


def _params(
    sky_model: SkyModel | None,
    patch_division: int | None,
    sun_cell_deg: float | None,
    albedo: float | None,
    surroundings: Surroundings | None,
    months: bool,
) -> dict[str, Any]:
    """How radiation is summed."""
    check_finite(albedo=albedo, sun_cell_deg=sun_cell_deg)
    check_whole(patch_division=patch_division)
    return given(
        sky=word(SkyModel, sky_model=sky_model),
        patch_division=patch_division,
        sun_cell=None if sun_cell_deg is None else math.radians(sun_cell_deg),
        albedo=albedo,
        surroundings=word(Surroundings, surroundings=surroundings),
        grouping="months" if switch(months=months)["months"] else None,
    )


def _as_file(weather: Any, location: tuple[float, float] | None) -> tuple[str, bytes]:
    """Rows of a DataFrame, as pvlib names them, in the format of NSRDB."""
    names = {str(name).lower(): name for name in weather.columns}
    if "ghi" not in names:
        raise wrong("weather", f"a DataFrame of {', '.join(names)}", "give columns ghi, dni and dhi, W/m²")
    if getattr(weather.index, "tz", None) is None:
        raise wrong("weather", "rows without a time zone", "give the index one, such as weather.tz_localize('UTC')")
    if location is None:
        advice = "a DataFrame does not say where it holds; give latitude and longitude"
        raise wrong("location", "missing", advice)
    known = {
        "GHI": "ghi",
        "DNI": "dni",
        "DHI": "dhi",
        "Temperature": "temp_air",
        "Relative Humidity": "relative_humidity",
        "Wind Speed": "wind_speed",
    }
    columns = {title: weather[names[name]].to_numpy(np.float64) for title, name in known.items() if name in names}
    times = weather.index.tz_convert("UTC")
    parts = [times.year, times.month, times.day, times.hour, times.minute]
    head = f"Source,Latitude,Longitude,Time Zone,Elevation\nDataFrame,{location[0]!r},{location[1]!r},0,0\n"
    lines = [",".join(["Year", "Month", "Day", "Hour", "Minute", *columns])]
    lines += [",".join(map(str, row)) for row in zip(*parts, *columns.values(), strict=True)]
    return "weather.csv", (head + "\n".join(lines) + "\n").encode()
