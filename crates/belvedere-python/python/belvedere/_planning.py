"""Questions of planners: landmarks, comfort, views from windows, and how high one may build."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from . import _core
from ._errors import wrong
from ._inputs import as_list, check_finite, check_whole, map_places, number_pair, reporter, table_columns
from ._keywords import Landmark as LandmarkKeywords
from ._mesh import Mesh, native_mesh
from ._outlook import _OBSERVERS
from ._questions import (
    _DIRECTION,
    cells_of,
    days_of,
    earth,
    given,
    ground_of,
    north,
    place_of,
    sky_parts,
    switch,
    unproven_as,
    word,
)
from ._raster import Raster, Rasters
from ._remarks import warned
from ._shapes import is_single, rings_of
from ._table import Table
from ._targets import measures, raster, wanted
from ._types import (
    Columns,
    Curvature,
    Day,
    Ground,
    Kind,
    Location,
    Numbers,
    Period,
    Places,
    Polygon,
    Progress,
    Unproven,
    Zone,
)

if TYPE_CHECKING:
    from typing_extensions import Unpack


_LINE = "give corners of shape (N, 2) or (N, 3)"


class Planning:
    """Landmarks, comfort, views from windows, and how high one may build."""

    _core: _core.Scene

    @overload
    def landmark(
        self,
        mesh: str | os.PathLike[str] | Mesh | None = None,
        *,
        target_class: int | None = None,
        target_polygon: Polygon | None = None,
        objects: str | list[str] = [],
        observers: None = None,
        **more: Unpack[LandmarkKeywords],
    ) -> Rasters: ...
    @overload
    def landmark(
        self,
        mesh: str | os.PathLike[str] | Mesh | None = None,
        *,
        target_class: int | None = None,
        target_polygon: Polygon | None = None,
        objects: str | list[str] = [],
        observers: Places,
        **more: Unpack[LandmarkKeywords],
    ) -> Table: ...
    def landmark(
        self,
        mesh: str | os.PathLike[str] | Mesh | None = None,
        *,
        target_class: int | None = None,
        target_polygon: Polygon | None = None,
        objects: str | list[str] = [],
        observers: Places | None = None,
        observer_height: float | None = None,
        cell: float | None = None,
        ground: Ground | None = None,
        spacing: float | None = None,
        seed: int = 1,
        max_distance: float | None = None,
        unproven: Unproven = "report",
        curvature: Curvature | None = None,
        refraction: float | None = None,
        probability: bool = False,
        progress: Progress = None,
    ) -> Rasters | Table:
        """From where a landmark is seen, and how much of it.

        Parameters
        ----------
        mesh : path or Mesh, optional
            The landmark as a mesh: ``.obj``, ``.ply`` or CityJSON.
        target_class : int, optional
            The points of this ASPRS class, in place of a mesh.
        target_polygon : array_like, shape (N, 2), or polygon of shapely or geopandas, optional
            The points above this polygon that are not ground, in place of a mesh.
        objects : str or list of str, optional
            Objects of the mesh; all if not given.
        observers : array_like, shape (2,), (3,), (N, 2) or (N, 3), optional
            Who looks. Without any, the cells of a grid over the scene.
        observer_height : float, optional
            Metres; 1.7 if not given.
        cell : float, optional
            Side of a cell, metres; 2 if not given, more for large scenes.
        spacing, seed : optional
            Distance of samples on the mesh, metres, and the seed of their places.
        max_distance : float, optional
            How far observers look, metres.
        probability : bool, optional
            Whether to add the visible share that is expected, by how likely each part is visible.
        ground, unproven, curvature, refraction, progress : optional
            As for `viewshed`.

        Returns
        -------
        Rasters or Table
            ``visible_share``, ``visible_area_m2``, ``solid_angle_sr``, angles and ranges; with `probability` also
            ``expected_share``. `remarks` says what to know.

        Raises
        ------
        BelvedereError
            Unless one landmark is given, where no observer is left, and for parameters out of range.

        Warns
        -----
        BelvedereWarning
            Of observers that cannot look.

        References
        ----------
        docs/methods/landmarks.md

        Examples
        --------
        >>> views = scene.landmark(target_class=6, observers=standing)
        >>> bool(0 <= views["visible_share"][0] <= 1)
        True
        """
        shape, thing = _landmark(mesh, target_class, target_polygon, objects, spacing, seed, self._core.crs.text)
        check_finite(observer_height=observer_height, cell=cell)
        question = given(
            shape=shape,
            observer_height=observer_height,
            cell=cell,
            ground=ground_of(ground),
            max_distance=max_distance,
            earth=earth(curvature, refraction),
            unproven=unproven_as(unproven),
            **switch(probability=probability),
        )
        if observers is not None and cell is not None:
            raise wrong("cell", cell, "it applies only to a grid; leave out observers, or leave this out")
        places = None if observers is None else map_places(observers, "observers", _OBSERVERS, crs=self._core.crs.text)
        columns, grid, found, standing = self._core.landmark(question, thing, places, reporter(progress))
        if places is None:
            return measures((columns, grid, None, found, None), self._core.crs, None)
        table = Table({name: values for name, _, values, *_ in columns}, places=standing, crs=self._core.crs.text)
        table.remarks = warned(found)
        return table

    def protected_view(
        self,
        observers: Places,
        mesh: str | os.PathLike[str] | Mesh | None = None,
        *,
        target_class: int | None = None,
        target_polygon: Polygon | None = None,
        objects: str | list[str] = [],
        observer_height: float | None = None,
        cell: float | None = None,
        ground: Ground | None = None,
        spacing: float | None = None,
        seed: int = 1,
        max_distance: float | None = None,
        unproven: Unproven = "report",
        progress: Progress = None,
    ) -> Rasters:
        """How high one may build without entering the view of a landmark.

        Parameters
        ----------
        observers : array_like, shape (2,), (3,), (N, 2) or (N, 3)
            From where the landmark is seen today. Without z, eyes are `observer_height` above the ground.
        mesh, target_class, target_polygon, objects, spacing, seed : optional
            The landmark, as for `landmark`.
        observer_height : float, optional
            Metres; 1.7 if not given.
        cell : float, optional
            Side of a cell, metres; 0.5 if not given, more for large scenes.
        max_distance : float, optional
            How far observers look, metres.
        unproven : {'report', 'as-visible', 'as-blocked'}
            Lines that nothing blocks but that cross space that no pulse came near are protected, unless they count as
            blocked.
        ground, progress : optional
            As for `viewshed`.

        Returns
        -------
        Rasters
            ``height``, the greatest height above the ground, metres; ``top``, the same in the vertical system of the
            cloud. NaN where no protected view passes.

        Raises
        ------
        BelvedereError
            Unless one landmark is given, where no observer is left, and for parameters out of range.

        Warns
        -----
        BelvedereWarning
            Of observers that are skipped, and if none sees the landmark.

        References
        ----------
        docs/methods/protected-views.md

        Examples
        --------
        >>> limits = scene.protected_view(standing, target_class=6, cell=4)
        >>> bool(np.nanmin(limits["height"].values) >= 0)
        True
        """
        shape, thing = _landmark(mesh, target_class, target_polygon, objects, spacing, seed, self._core.crs.text)
        check_finite(observer_height=observer_height)
        question = given(observer_height=observer_height, max_distance=max_distance, unproven=unproven_as(unproven))
        places = map_places(observers, "observers", _OBSERVERS, crs=self._core.crs.text)
        cells = wanted(None, None, cells_of(cell, None, False, ground))
        columns, grid, said = self._core.protected_view(question, shape, thing, places, cells, reporter(progress))
        remarks = warned(said)
        nan = float("nan")
        crs = self._core.crs
        found = {
            name: raster(values, grid, crs, name=name, description=text, nodata=nan, unit="m")
            for name, text, values in columns
        }
        for one in found.values():
            one.remarks = remarks
        return Rasters(found)

    def window_views(
        self,
        windows: Columns | str | os.PathLike[str] | Mesh,
        *,
        objects: str | list[str] = [],
        spacing: float | None = None,
        seed: int = 1,
        directions: int | None = None,
        classes: Mapping[int, Kind] | None = None,
        unproven: Unproven = "report",
        grid_north: bool = False,
        progress: Progress = None,
    ) -> Table:
        """What is seen from windows: sky, vegetation, water, buildings and ground, and how far.

        Parameters
        ----------
        windows : mapping of str to array_like, DataFrame, path or Mesh
            Columns ``x, y, z`` and ``azimuth`` (degrees), and if known ``tilt`` (degrees, 90 upright), ``width`` and
            ``height`` (metres). Or a mesh, whose faces are windows; roofs and floors have no view.
        objects : str or list of str, optional
            Objects of the mesh; all if not given.
        spacing, seed : optional
            Longest side of the pieces of a face, metres (2 if not given), and the seed of the places in them.
        directions : int, optional
            Number of directions before each place; 1000 if not given.
        classes : mapping of int to str, optional
            What a class of points is: 'vegetation', 'water', 'building', 'ground' or 'other'. Classes that are not
            given mean what ASPRS says.
        unproven : {'report', 'as-visible'}
            Whether the column ``unproven`` is computed.
        grid_north, progress : optional
            As for `shadow`.

        Returns
        -------
        Table
            A row for each window: its azimuth and tilt, percentages of the view (``sky``, ``vegetation``, ``water``,
            ``building``, ``ground``, ``other``, ``beyond``; with ``_cos`` weighted by the cosine to the window),
            ``mean_range_m``, ``median_range_m`` and ``unproven``. Far terrain (`with_terrain`, `with_horizon`) is
            ``ground`` and has no range. NaN for windows without a view. Of a mesh with objects also ``object``, and the
            attribute `objects` has the mean of each object.

        Raises
        ------
        BelvedereError
            For windows without a place or an azimuth, and for parameters out of range.

        Warns
        -----
        BelvedereWarning
            Of windows outside the cloud, near its edge or in an obstacle, and of points that have no classes or
            mostly other ones than ASPRS has.

        References
        ----------
        docs/methods/window-views.md

        Examples
        --------
        >>> x, y, z = eye
        >>> view = scene.window_views({"x": [x], "y": [y], "z": [z], "azimuth": [180]}, directions=200)
        >>> kinds = ("sky", "vegetation", "water", "building", "ground", "other", "beyond")
        >>> round(float(sum(view[kind][0] for kind in kinds)), 3)
        100.0
        """
        check_finite(spacing=spacing)
        check_whole(seed=seed, directions=directions)
        question = given(
            north=north(grid_north),
            spacing=spacing,
            seed=seed,
            directions=directions,
            classes=None if classes is None else _classes(classes),
            unproven=unproven_as(unproven),
        )
        rows, mesh = [], None
        if isinstance(windows, (str, os.PathLike, Mesh)):
            mesh = native_mesh(windows)
        elif spacing is not None or as_list(objects):
            raise wrong("spacing and objects", "given", "they apply only to a mesh; leave them out")
        else:
            rows = _windows(windows)
        arguments = question, rows, mesh, as_list(objects)
        columns, places, names, buildings, said = self._core.window_views(*arguments, reporter(progress))
        remarks = warned(said)
        found = {"object": np.array(names, object)} if names else {}
        found |= {name: values for name, _, values in columns}
        objects_table = None
        if names:
            of_names, of_columns = buildings
            objects_table = Table({"object": np.array(of_names, object), **dict(of_columns)})
        table = Table(found, places=places, crs=self._core.crs.text, objects=objects_table)
        table.remarks = remarks
        return table

    def comfort(
        self,
        *,
        route: Places | None = None,
        windows: Columns | None = None,
        date: Day | Iterable[Day] | None = None,
        period: Period | None = None,
        year: int | None = None,
        distance_step_m: float | None = None,
        target_height: float | None = None,
        time_step_min: float | None = None,
        directions: int | None = None,
        ground: Ground | None = None,
        location: Location | None = None,
        zone: Zone | None = None,
        grid_north: bool = False,
        progress: Progress = None,
    ) -> Table:
        """Sun and sky along a walk, or at windows.

        Parameters
        ----------
        route : array_like, shape (N, 2) or (N, 3), or line of shapely or geopandas, optional
            Corners of a walk in the coordinates of the file; without z it runs on the ground.
        windows : mapping of str to array_like, or DataFrame, optional
            Columns ``x, y, z`` and ``azimuth`` (degrees), and if known ``tilt`` (degrees, 90 upright), ``width`` and
            ``height`` (metres), in place of a walk.
        date, period, year, time_step_min, zone : optional
            As for `sun_hours`.
        distance_step_m : float, optional
            Metres between places of a walk; 2 if not given.
        target_height : float, optional
            Height above the ground, metres; 1.1 if not given.
        directions : int, optional
            Number of directions of the sky; 577 if not given.
        ground, location, grid_north, progress : optional
            As for `shadow`.

        Returns
        -------
        Table
            A row for each place of the walk or each window: ``sky_view_factor``, ``sky_openness``, ``sun_hours``,
            ``sun_share``, ``first_light``, ``last_light``, ``longest``; for walks also ``route`` and ``distance_m``,
            for windows ``sky_component``.

        Raises
        ------
        BelvedereError
            Unless a walk or windows and days are given.

        Warns
        -----
        BelvedereWarning
            Of places outside the cloud, of many near its edge, and of places of a walk without known ground.

        References
        ----------
        docs/methods/comfort.md

        Examples
        --------
        >>> x, y = standing
        >>> walk = scene.comfort(route=[(x, y), (x + 10, y)], date="2026-06-21", zone="Europe/Amsterdam")
        >>> walk["distance_m"].tolist()
        [0.0, 2.0, 4.0, 6.0, 8.0, 10.0]
        """
        if (route is None) == (windows is None):
            raise wrong("route and windows", "both given" if route is not None else "missing", "give one of them")
        check_finite(distance_step_m=distance_step_m, target_height=target_height)
        question = given(
            days=days_of(date, period, year, time_step_min),
            place=place_of(location, zone=zone, grid_north=grid_north),
            sky=sky_parts(directions),
            distance_step_m=distance_step_m,
            target_height=target_height,
        )
        routes = [] if route is None else [_line(route, "route", self._core.crs.text, least=2)]
        rows = [] if windows is None else _windows(windows)
        columns, found = self._core.comfort(question, routes, rows, ground_of(ground), reporter(progress))
        places = columns.pop("place")
        table = Table(columns, places=places, crs=self._core.crs.text)
        table.remarks = warned(found)
        return table

    def envelope(
        self,
        parcel: Polygon,
        *,
        protect: Places | Sequence[Places],
        sun: Numbers | None = None,
        date: Day | Iterable[Day] | None = None,
        period: tuple[Day, Day] | None = None,
        year: int | None = None,
        between: Numbers | None = None,
        time_step_min: float | None = None,
        fence_height: float | None = None,
        spacing: float | None = None,
        max_height: float | None = None,
        credit_shade: bool = False,
        cell: float | None = None,
        ground: Ground | None = None,
        location: Location | None = None,
        zone: Zone | None = None,
        grid_north: bool = False,
        progress: Progress = None,
    ) -> Raster:
        """How high one may build on a parcel without taking protected sun from others.

        Parameters
        ----------
        parcel : array_like, shape (N, 2), or polygon of shapely or geopandas
            Corners in the coordinates of the file.
        protect : array_like, shape (N, 2) or (N, 3), or a list of these
            Lines that keep their sun; one corner is a point. Without z they run on the ground.
        sun : array_like, shape (2,) or (K, 2), optional
            Azimuth and elevation of protected suns, degrees, in place of days.
        date, period, year, time_step_min, zone : optional
            As for `sun_hours`.
        between : array_like, shape (2,), optional
            Hours of the day that are protected.
        fence_height : float, optional
            Height up to which protected lines may be in shade, metres; 0 if not given.
        spacing : float, optional
            Length of pieces of protected lines, metres; 0.5 if not given.
        max_height : float, optional
            Greatest height above the ground, metres. Without it, columns that no sun bounds are infinite.
        credit_shade : bool, optional
            Whether sun that the scene takes already needs no protection.
        cell : float, optional
            Side of a column, metres; 0.5 if not given.
        ground, location, grid_north, progress : optional
            As for `shadow`.

        Returns
        -------
        Raster
            Height above the ground, metres; NaN beside the parcel.

        Raises
        ------
        BelvedereError
            Without suns, for a parcel that is no polygon, and where no ground is known.

        Warns
        -----
        BelvedereWarning
            Of protected parts without known ground.

        References
        ----------
        docs/methods/solar-envelope.md

        Examples
        --------
        >>> x, y = standing
        >>> parcel = [(x, y), (x + 8, y), (x + 8, y + 8), (x, y + 8)]
        >>> height = scene.envelope(parcel, protect=[(x, y + 12), (x + 8, y + 12)], sun=(180, 30), max_height=20)
        >>> bool(np.nanmax(height) <= 20)
        True
        """
        check_finite(fence_height=fence_height, spacing=spacing, max_height=max_height, cell=cell)
        hours = None if between is None else number_pair(between, "between", "give two hours, such as (9, 15)")
        days = days_of(date, period, year, time_step_min)
        suns: dict[str, Any] = {"days": given(days=days, hours=hours)}
        if sun is not None:
            if date is not None or period is not None:
                raise wrong("sun and days", "given together", "give one of them")
            directions = np.atleast_2d(np.asarray(sun, np.float64))
            suns = {"directions": [number_pair(one, "sun", _DIRECTION) for one in directions]}
        crs = self._core.crs.text
        lines = [protect]
        if isinstance(protect, (list, tuple)) and not any(map(is_single, protect)):
            lines = list(protect)
        question = given(
            suns=suns,
            place=place_of(location, zone=zone, grid_north=grid_north),
            fence_height=fence_height,
            spacing=spacing,
            cell=cell,
            params=given(ceiling=max_height),
            **switch(credit_shade=credit_shade),
        )
        protected = [_line(line, "protect", crs) for line in lines]
        arguments = question, rings_of(parcel, "parcel", crs), protected, ground_of(ground)
        (name, text, values), grid, found = self._core.envelope(*arguments, reporter(progress))
        height = raster(values, grid, self._core.crs, name=name, description=text, nodata=float("nan"), unit="m")
        height.remarks = warned(found)
        return height


def _line(value: Any, what: str, crs: str | None, least: int = 1) -> list[tuple[float, float, float]]:
    """Corners; z is NaN where it follows from the ground."""
    rows = map_places(value, what, f"{_LINE}, {least} at least", least, crs)
    return [(float(x), float(y), float(z)) for x, y, z in rows]


def _landmark(
    mesh: str | os.PathLike[str] | Mesh | None,
    target_class: int | None,
    target_polygon: Polygon | None,
    objects: str | list[str],
    spacing: float | None,
    seed: int,
    crs: str | None,
) -> tuple[dict[str, Any], dict[str, Any]]:
    """The shape of a landmark, and the object that has it."""
    check_finite(spacing=spacing)
    count = sum(what is not None for what in (mesh, target_class, target_polygon))
    if count != 1:
        raise wrong("landmark", f"{count} given", "give one of mesh, target_class and target_polygon")
    check_whole(target_class=target_class, seed=seed)
    shape: dict[str, Any] = {"inside": {}} if target_class is None else {"class": target_class}
    if mesh is not None:
        shape = {"mesh": given(spacing=spacing, seed=seed)}
    return shape, {
        "mesh": None if mesh is None else native_mesh(mesh),
        "objects": as_list(objects),
        "polygon": [] if target_polygon is None else rings_of(target_polygon, "target_polygon", crs),
    }


def _classes(meanings: Mapping[int, Kind]) -> list[tuple[int, str | None]]:
    for class_ in meanings:
        if int(class_) != class_ or not 0 <= class_ <= 255:
            raise wrong("classes", repr(class_), "each is the class of points, 0 to 255")
    return [(int(class_), word(Kind, classes=name)) for class_, name in meanings.items()]


def _windows(columns: Columns) -> list[list[float]]:
    known = ("x", "y", "z", "azimuth", "tilt", "width", "height")
    columns = table_columns(columns, "windows", known, known[:4])
    usual = {"tilt": 90.0}
    full = {name: np.full(len(columns["x"]), usual.get(name, float("nan"))) for name in known}
    full |= columns
    rows: list[list[float]] = np.column_stack([full[name] for name in known]).tolist()
    return rows
