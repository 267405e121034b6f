"""Questions about what observers see around themselves."""

from __future__ import annotations

import operator

import numpy as np
import numpy.typing as npt

from . import _core
from ._errors import wrong
from ._inputs import check_finite, check_whole, map_places, number_pair, place, reporter
from ._questions import earth, given, ground_of, how_sure, north, switch, unproven_as
from ._raster import Raster
from ._remarks import warned
from ._shapes import is_single
from ._table import Table
from ._targets import raster
from ._types import Curvature, Ground, Numbers, Places, Progress, Unproven

_SIZE = "give columns and rows, such as (640, 480)"
_OBSERVERS = "give x and y, or x, y and z: shape (2,), (3,), (N, 2) or (N, 3)"


class Outlook:
    """What observers see around themselves."""

    _core: _core.Scene

    def viewshed(
        self,
        observers: Places | None = None,
        *,
        target: Places | None = None,
        spread: int | None = None,
        observer_height: float | None = None,
        target_height: float | None = None,
        cell: float | None = None,
        ground: Ground | None = None,
        azimuth_range_deg: Numbers | None = None,
        elevation_range_deg: Numbers | None = None,
        min_distance: float | None = None,
        max_distance: float | None = None,
        unproven: Unproven = "report",
        probability: bool = False,
        certain: float | None = None,
        curvature: Curvature | None = None,
        refraction: float | None = None,
        grid_north: bool = False,
        far: bool = False,
        progress: Progress = None,
    ) -> Raster:
        """What one or many observers see of the ground, or from where a target is seen.

        Parameters
        ----------
        observers : array_like, shape (2,), (3,), (N, 2) or (N, 3), optional
            Places in the coordinates of the file. Without z, eyes are `observer_height` above the ground. After
            `with_terrain` they may be on the terrain beyond the cloud.
        target : array_like, shape (2,) or (3,), optional
            In place of observers: cells are those from which this place is seen by eyes `observer_height` above the
            ground. Without z, it is `target_height` above the ground. After `with_terrain` it may be on the terrain.
        spread : int, optional
            In place of observers: a total viewshed. So many observers, 1 to 65534, are spread evenly over the open
            ground; values count those that see a cell.
        observer_height : float, optional
            Height of eyes above the ground, metres; 1.7 if not given.
        target_height : float, optional
            Height of what is looked at above the ground, metres; 0.1 if not given.
        cell : float, optional
            Side of a cell, metres; 0.5 if not given, more for large scenes.
        ground : {'auto', 'class', 'found'}, optional
            Which points are ground: class 2 where there is one (default), always class 2, or those that are found.
        azimuth_range_deg, elevation_range_deg : array_like, shape (2,), optional
            Where observers look: azimuths clockwise from true north (from 300 to 60 runs through north), and
            elevations.
        min_distance, max_distance : float, optional
            How far they look on the map, metres.
        unproven : {'report', 'as-visible', 'as-blocked'}
            What to make of lines that nothing blocks but that cross space that no pulse came near.
        probability : bool, optional
            Whether to compute how likely each cell is visible, as `probability` of the Raster. Needs pulses.
        certain : float, optional
            Probability, above 0.5 and at most 1, below which an answer is uncertain, as `uncertain` of the Raster says.
        curvature : {'auto', 'on', 'off'}, optional
        refraction : float, optional
            As for `line_of_sight`.
        grid_north : bool, optional
            Whether azimuths are counted from grid north.
        far : bool, optional
            Cells of the terrain beyond the cloud, which `with_terrain` gives the scene, in place of those in the cloud.
            They are as large as those of the terrain, and there is no answer within the extent of the cloud.
        progress : bool or callable, optional

        Returns
        -------
        Raster
            Of one observer uint8: 1 where nothing blocks the view, 0 blocked, 255 where there is no answer. Of several
            uint16: from how many nothing blocks a cell, 65535 where none looks. Where pulses were tested, the Raster
            `unproven` says what of it is not proven. The attribute `remarks` says what to know.

        Raises
        ------
        BelvedereError
            Where no observer is left, and for parameters out of range.

        Warns
        -----
        BelvedereWarning
            Of observers that cannot look (inside an obstacle, below the ground, outside the cloud), and of those that
            see nothing.

        References
        ----------
        docs/methods/viewshed.md, docs/methods/terrain.md

        Examples
        --------
        >>> seen = scene.viewshed(standing, max_distance=50)
        >>> seen.values.dtype, bool((seen.values == 1).any())
        (dtype('uint8'), True)
        >>> seen_from = scene.viewshed(target=standing, target_height=10, cell=2)
        >>> total = scene.viewshed(spread=50, target_height=1.7, cell=4)
        >>> int(total.values[total.values != total.nodata].max()) <= 50
        True
        >>> mountains = scene.with_terrain("dtm.tif").viewshed(standing, far=True)  # doctest: +SKIP
        """
        if sum(one is not None for one in (observers, target, spread)) > 1:
            raise wrong("observers, target and spread", "given together", "give one of them")
        places: npt.NDArray[np.float64] | int
        if spread is not None:
            check_whole(spread=spread)
            if not 1 <= spread <= 65534:
                raise wrong("spread", str(spread), "give a whole number from 1 to 65534")
            places = operator.index(spread)
        elif target is None:
            if observers is None:
                raise wrong("observers", "missing", "give observers, a target, or spread")
            places = map_places(observers, "observers", _OBSERVERS, crs=self._core.crs.text)
        else:
            places = map_places(target, "target", "give x and y, or x, y and z", crs=self._core.crs.text)
            if len(places) != 1:
                raise wrong("target", f"{len(places)} places", "give one")
        check_finite(observer_height=observer_height, target_height=target_height, cell=cell, min_distance=min_distance)
        question = given(
            reverse=target is not None,
            observer_height=observer_height,
            target_height=target_height,
            limits=given(
                azimuth_range_deg=_range(azimuth_range_deg, "azimuth_range_deg"),
                elevation_range_deg=_range(elevation_range_deg, "elevation_range_deg"),
                min_distance=min_distance,
                max_distance=max_distance,
            ),
            north=north(grid_north),
            earth=earth(curvature, refraction),
            unproven=unproven_as(unproven),
            how_sure=how_sure(probability, certain),
            cell=cell,
            ground=ground_of(ground),
            targets=["far-terrain" if far else "cells"],
        )
        bands, names, text, grid, found = self._core.viewshed(question, places, reporter(progress))
        made = {
            name: raster(band, grid, self._core.crs, name=name, nodata=no_value, unit="1")
            for (band, no_value), name in zip(bands, names)
        }
        seen = made[names[0]]
        seen.description = text
        seen.unproven, seen.uncertain = made.get("unproven"), made.get("uncertain")
        seen.probability = made.get("probability", made.get("expected"))
        seen.remarks = warned(found)
        return seen

    def depth_map(
        self,
        *,
        sun: Numbers | None = None,
        direction: Numbers | None = None,
        eye: Places | None = None,
        look_at: Numbers | None = None,
        pixel: float | None = None,
        fov_deg: float | None = None,
        size: tuple[int, int] | None = None,
        width: int | None = None,
        grid_north: bool = False,
        progress: Progress = None,
    ) -> npt.NDArray[np.float32]:
        """What a view shows: the distance to what is hit first in each pixel.

        Parameters
        ----------
        sun : array_like, shape (2,), optional
            Azimuth and elevation, degrees: the view of the sun on the scene.
        direction : array_like, shape (3,), optional
            Direction of a parallel view, such as (0, 0, -1) for a view from above.
        eye : array_like, shape (3,), optional
            Place of a camera in the coordinates of the file; without `look_at` a panorama of all directions.
        look_at : array_like, shape (3,), optional
            Place that the camera looks at.
        pixel : float, optional
            Side of a pixel of a parallel view, metres.
        fov_deg : float, optional
            Field of view of a camera, degrees; 60 if not given.
        size : tuple of 2 ints, optional
            Width and height of the picture of a camera, pixels; (1280, 720) if not given.
        width : int, optional
            Width of a panorama, pixels; 2048 if not given.
        grid_north : bool, optional
            Whether the azimuth of the sun is counted from grid north.
        progress : bool or callable, optional

        Returns
        -------
        ndarray, shape (height, width), float32
            Metres, infinite where nothing is hit. Along the axis of the view; from the eye in panoramas, whose
            columns run from south over west, north and east.

        References
        ----------
        docs/methods/depth-maps.md

        Examples
        --------
        >>> depth = scene.depth_map(direction=(0, 0, -1), pixel=1)
        >>> depth.dtype, bool(np.isfinite(depth).any())
        (dtype('float32'), True)
        >>> scene.depth_map(eye=eye, width=256).shape
        (128, 256)
        """
        ways = [name for name, v in (("sun", sun), ("direction", direction), ("eye", eye)) if v is not None]
        if len(ways) != 1:
            raise wrong("view", " and ".join(ways) or "missing", "give one of sun, direction and eye")
        check_finite(pixel=pixel, fov_deg=fov_deg)
        check_whole(width=width)
        camera = {
            "sun": None if sun is None else number_pair(sun, "sun", "give azimuth and elevation in degrees"),
            "direction": None if direction is None else place(direction, "direction"),
            "eye": None if eye is None else place(eye, "eye"),
            "look_at": None if look_at is None else place(look_at, "look_at"),
            "pixel": pixel,
            "fov": fov_deg,
            "size": None if size is None else [int(side) for side in number_pair(size, "size", _SIZE)],
            "width": width,
        }
        depth, _, found = self._core.depth_map(camera, north(grid_north), reporter(progress))
        warned(found)
        return depth

    def horizon(
        self,
        observers: Places,
        *,
        observer_height: float | None = None,
        angle_step_deg: float | None = None,
        ground: Ground | None = None,
        curvature: Curvature | None = None,
        refraction: float | None = None,
        grid_north: bool = False,
        interval: bool = False,
        progress: Progress = None,
    ) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
        """Above which elevation the sky is free around observers.

        Parameters
        ----------
        observers : array_like, shape (2,), (3,), (N, 2) or (N, 3)
            Places in the coordinates of the file. Without z, eyes are `observer_height` above the ground.
        observer_height : float, optional
            Metres; 1.7 if not given.
        angle_step_deg : float, optional
            Degrees between azimuths; 1 if not given.
        interval : bool, optional
            Whether to say between which elevations the sky begins nine times in ten; needs pulses.
        ground, curvature, refraction, grid_north, progress : optional
            As for `viewshed`.

        Returns
        -------
        azimuths_deg : ndarray, shape (A,)
            Clockwise from true north.
        elevations_deg : ndarray, shape (A,) for one observer, (N, A) for several
            -90 where nothing stands; NaN for observers that are skipped. With `interval` there is one more axis of
            three: the elevation, and the lower and the upper end of its interval.

        Raises
        ------
        BelvedereError
            Where no observer is left, and for parameters out of range.

        Warns
        -----
        BelvedereWarning
            Of observers that cannot look, and where much of the horizon is near the edge of the cloud.

        Examples
        --------
        >>> azimuths, elevations = scene.horizon(standing)
        >>> len(azimuths), bool((elevations <= 90).all())
        (360, True)
        """
        check_finite(observer_height=observer_height, angle_step_deg=angle_step_deg)
        question = given(
            observer_height=observer_height,
            ground=ground_of(ground),
            angle_step_deg=angle_step_deg,
            earth=earth(curvature, refraction),
            north=north(grid_north),
            below="keep",
            **switch(interval=interval),
        )
        places = map_places(observers, "observers", _OBSERVERS, crs=self._core.crs.text)
        found, count, remarks = self._core.horizon(question, places, reporter(progress))
        warned(remarks)
        azimuths = 360.0 * np.arange(count) / count
        elevations = found.reshape((len(places), count, 3) if interval else (len(places), count))
        return azimuths, elevations[0] if is_single(observers) else elevations

    def isovist(
        self,
        observers: Places,
        *,
        observer_height: float | None = None,
        max_distance: float | None = None,
        angle_step_deg: float | None = None,
        min_jump: float | None = None,
        ground: Ground | None = None,
        grid_north: bool = False,
        interval: bool = False,
        progress: Progress = None,
    ) -> Table:
        """The space that observers see, in numbers: its volume, how open it is, and its plan.

        Parameters
        ----------
        observers : array_like, shape (2,), (3,), (N, 2) or (N, 3)
            Places in the coordinates of the file. Without z, eyes are `observer_height` above the ground.
        observer_height : float, optional
            Metres; 1.7 if not given.
        max_distance : float, optional
            Range at which sight ends where nothing blocks, metres; 100 if not given.
        angle_step_deg : float, optional
            Degrees between rays; 1 if not given.
        min_jump : float, optional
            Smallest jump of range that is an edge of the plan, metres; 0.25 if not given.
        interval : bool, optional
            Whether to say between which areas and volumes what is seen lies nine times in ten; needs pulses.
        ground, grid_north, progress : optional
            As for `viewshed`.

        Returns
        -------
        Table
            ``volume_m3``, ``blocked_volume_m3`` of the directions in which something blocks, ``openness``,
            ``sky_openness``, ranges, drift, area and perimeter of the plan; a row for each observer, NaN for one that
            is skipped; with `interval` also ``plan_area_low_m2``, ``plan_area_high_m2``, ``volume_low_m3`` and
            ``volume_high_m3``. The attribute `panoramas` has the ranges in all directions.

        Raises
        ------
        BelvedereError
            Where no observer is left, and for parameters out of range.

        Warns
        -----
        BelvedereWarning
            Of observers that cannot look.

        References
        ----------
        docs/methods/isovists.md

        Examples
        --------
        >>> space = scene.isovist(standing)
        >>> bool(space["volume_m3"][0] > 0), space.panoramas[0].shape
        (True, (180, 360))
        """
        check_finite(observer_height=observer_height, angle_step_deg=angle_step_deg, min_jump=min_jump)
        question = given(
            observer_height=observer_height,
            ground=ground_of(ground),
            north=north(grid_north),
            max_distance=max_distance,
            angle_step_deg=angle_step_deg,
            min_jump=min_jump,
            **switch(interval=interval),
        )
        eyes = map_places(observers, "observers", _OBSERVERS, crs=self._core.crs.text)
        columns, panoramas, found = self._core.isovist(question, eyes, reporter(progress))
        places = columns.pop("place")
        table = Table(columns, places=places, crs=self._core.crs.text, panoramas=panoramas)
        table.remarks = warned(found)
        return table


def _range(value: object, what: str) -> tuple[float, float] | None:
    return None if value is None else number_pair(value, what, "give two angles in degrees, such as (300, 60)")
