"""Where cameras, observers and masts cover most."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from . import _core
from ._errors import wrong
from ._inputs import check_finite, map_places, pairs_of, reporter
from ._mesh import Mesh
from ._questions import cells_of, earth, given, ground_of, north, suns_of, switch, unproven_as
from ._raster import Raster
from ._remarks import Remark, warned
from ._shapes import in_system, is_single
from ._table import Table
from ._targets import Targets, coordinates, raster, wanted
from ._types import Candidates, Curvature, Density, Ground, Numbers, Places, Progress, Unproven

_PLACES = "give x and y, or x, y and z: shape (N, 2) or (N, 3)"


@dataclass(frozen=True)
class Placement:
    """Cameras that were chosen, and what is proven of the choice.

    Attributes
    ----------
    cameras : Table
        ``heading_deg``, ``tilt_deg`` and ``fov_deg`` (NaN for cameras that turn or see all around), ``is_existing``,
        ``added_percent`` and ``covered_targets``; its `places` are where the cameras stand.
    counts : Raster or Table
        How many cameras cover each target: a raster (65535 where nothing counts) where targets are cells, a column
        ``cameras`` elsewhere.
    covered : list of ndarray
        For each camera the rows of the targets that it covers. Cells are counted row by row from the north.
    coverage_percent : float
        Share of the weight of all targets that is covered.
    best_possible_percent : float
        The share that no choice of as many cameras can exceed.
    is_proven_optimum : bool
        Whether no other choice is better.
    all_candidates_percent : float
        The share that all candidates together cover.
    existing_only_percent : float
        The share that the existing cameras cover.
    least_possible_cameras : int or None
        The number of new cameras below which no choice reaches the coverage that was wanted.
    cameras_to_choose_from : int
        Cameras that could be chosen: headings and tilts of all places.
    remarks : tuple of Remark
        What to know of the choice.

    Examples
    --------
    >>> placed = scene.cameras(standing, count=1, fov_deg=360)
    >>> placed.coverage_percent <= placed.best_possible_percent
    True
    """

    cameras: Table
    counts: Union[Raster, Table]
    covered: list[npt.NDArray[np.uint64]]
    coverage_percent: float
    best_possible_percent: float
    is_proven_optimum: bool
    all_candidates_percent: float
    existing_only_percent: float
    least_possible_cameras: Union[int, None]
    cameras_to_choose_from: int
    remarks: tuple[Remark, ...] = ()


class Cameras:
    """Where cameras, observers and masts cover most."""

    _core: _core.Scene

    def cameras(
        self,
        candidates: Candidates,
        *,
        count: int | None = None,
        coverage_percent: float | None = None,
        targets: Targets = None,
        weights: Numbers | None = None,
        existing: Places | Table | None = None,
        private: Places | None = None,
        spacing: float = 5.0,
        camera_height: float | None = None,
        target_height: float | None = None,
        cell: float | None = None,
        ground: Ground | None = None,
        fov_deg: float | None = None,
        vertical_fov_deg: float | None = None,
        pixels: float | None = None,
        density: Density | None = None,
        headings: int | None = None,
        tilts_deg: Numbers | None = None,
        turning: bool = False,
        min_distance: float | None = None,
        max_distance: float | None = None,
        per_target: int = 1,
        search_limit: int | None = None,
        unproven: Unproven = "report",
        certain: float | None = None,
        curvature: Curvature | None = None,
        refraction: float | None = None,
        frequency_ghz: float | None = None,
        fresnel_percent: float | None = None,
        grid_north: bool = False,
        progress: Progress = None,
    ) -> Placement:
        """Which of many possible cameras to put up, with a proven bound on the best choice.

        Parameters
        ----------
        candidates : array_like, shape (N, 2) or (N, 3), or {'ground', 'roofs'}
            Places in the coordinates of the file; without z, `camera_height` above the ground. Or a grid of places
            above the ground or above roofs.
        count : int, optional
            Cover as much as possible with so many new cameras.
        coverage_percent : float, optional
            In place of a count: cover this share of the targets with as few new cameras as possible.
        targets : array_like, shape (N, 3), Cloud or Mesh, optional
            What is to be covered; the cells of the ground if not given.
        weights : array_like, shape (N,), optional
            How much each target counts; all alike if not given. Only for places and clouds.
        existing : array_like, shape (N, 2), (N, 3) or (N, 5), or Table, optional
            Cameras that stay: x, y, z, heading and tilt in degrees (without these two for cameras that turn or see all
            around), or the table of an earlier choice.
        private : array_like, shape (N, 2) or (N, 3), optional
            Places that no camera may have in its picture; without z, `target_height` above the ground.
        spacing : float, optional
            Side of the cells of a grid of candidates, metres.
        camera_height : float, optional
            Metres above the ground; 4 if not given, or 1 above roofs.
        target_height : float, optional
            Metres above the ground; 1.5 if not given.
        cell : float, optional
            Side of the cells that are targets, metres; 2 if not given, more for large scenes.
        ground : {'auto', 'class', 'found'}, optional
            Which points are ground, as for `viewshed`.
        fov_deg, vertical_fov_deg : float, optional
            Field of view, degrees; 90 if not given, in a picture of 16:9. From 180 on the camera sees all around: a
            person, a fisheye lens, a mast.
        pixels : float, optional
            Across the picture; 1920 if not given.
        density : str or float, optional
            Pixels per metre that are needed, or a level of EN 62676-4: 'monitor', 'detect' (default), 'observe',
            'recognise', 'identify'; or 'none'.
        headings : int, optional
            Headings to choose from at each place; 8 if not given.
        tilts_deg : array_like, shape (T,), optional
            Angles below the horizon to choose from; 15 if not given.
        turning : bool, optional
            Whether cameras turn and tilt to each target.
        min_distance, max_distance : float, optional
            Horizontal distances at which cameras are good, metres.
        per_target : int, optional
            Cameras that each target needs; one with fewer counts in proportion.
        search_limit : int, optional
            Most branches of the search for the proven optimum; 0 for no search.
        unproven : {'report', 'as-visible', 'as-blocked'}
            What is not proven visible covers a target only 'as-visible'.
        certain : float, optional
            Least probability, above 0.5 to 1, with which a target must be visible to be covered; any if not given.
            Needs pulses.
        frequency_ghz : float, optional
            Frequency of radio links, 0.001 to 1000: a target is only covered if the first Fresnel zone is free too.
        fresnel_percent : float, optional
            How much of the radius of this zone must be free; 60 if not given.
        curvature, refraction, grid_north, progress : optional
            As for `viewshed`.

        Returns
        -------
        Placement

        Raises
        ------
        BelvedereError
            Where no candidate is left, where all of them do not reach the coverage, and for parameters out of range.

        Warns
        -----
        BelvedereWarning
            Of given candidates and existing cameras that cannot look: inside an obstacle, below the ground, outside the
            cloud; and of targets outside the cloud.

        References
        ----------
        docs/methods/cameras.md

        Examples
        --------
        >>> placed = scene.cameras("ground", spacing=20, count=2, turning=True, max_distance=40)
        >>> len(placed.cameras["heading_deg"]), placed.counts.values.dtype
        (2, dtype('uint16'))
        """
        if isinstance(candidates, str) and candidates not in ("ground", "roofs"):
            raise wrong("candidates", repr(candidates), "give places, 'ground' or 'roofs'")
        crs = self._core.crs
        check_finite(spacing=spacing, camera_height=camera_height, fov_deg=fov_deg, vertical_fov_deg=vertical_fov_deg)
        check_finite(pixels=pixels, min_distance=min_distance, coverage_percent=coverage_percent)
        if isinstance(targets, Mesh) and weights is not None:
            raise wrong("weights", "given", "the targets of a mesh have the weights of their areas")
        if targets is None and weights is not None:
            raise wrong("weights", "given", "cells count alike; give targets, or leave this out")
        if (count is None) == (coverage_percent is None):
            raise wrong("count and coverage_percent", "not one of them", "give one of them")
        targets = in_system(targets, "targets", crs.text)
        wanted_targets = wanted(targets, None, {"cell": cell})
        wanted_targets.update(height=target_height, ground=ground_of(ground))
        check_finite(certain=certain)
        check_finite(target_height=target_height, frequency_ghz=frequency_ghz, fresnel_percent=fresnel_percent)
        if fresnel_percent is not None and frequency_ghz is None:
            raise wrong("fresnel_percent", fresnel_percent, "give frequency_ghz too, or leave this out")
        question = given(
            goal=given(count=count, coverage_percent=coverage_percent),
            per_target=per_target,
            search_limit=search_limit,
            candidates=_grid(candidates, spacing),
            camera_height=camera_height,
            lens=given(
                fov_deg=fov_deg,
                vertical_fov_deg=vertical_fov_deg,
                pixels=pixels,
                headings=headings,
                tilts_deg=None if tilts_deg is None else np.atleast_1d(np.asarray(tilts_deg, np.float64)).tolist(),
                is_turning=switch(turning=turning)["turning"],
                min_distance=min_distance,
                max_distance=max_distance,
            ),
            targets=given(height=target_height),
            north=north(grid_north),
            frequency_ghz=frequency_ghz,
            fresnel_percent=fresnel_percent,
            unproven=unproven_as(unproven),
            certain=certain,
        )
        choice = {
            "candidates": None
            if isinstance(candidates, str)
            else map_places(candidates, "candidates", _PLACES, crs=crs.text).tolist(),
            "existing": _existing(existing, crs.text).tolist(),
            "private": [] if private is None else map_places(private, "private", _PLACES, crs=crs.text).tolist(),
            "weights": [] if weights is None else _weights(weights, targets).tolist(),
            "density": density,
        }
        arguments = question, earth(curvature, refraction), choice, wanted_targets
        columns, whole, counts, grid, found = self._core.cameras(*arguments, reporter(progress))
        remarks = warned(found)
        of_targets: Raster | Table
        small = np.where(counts == np.uint32(2**32 - 1), 65535, np.minimum(counts, 65534)).astype(np.uint16)
        if grid is None:
            of_targets = Table({"cameras": small}, places=coordinates(targets), crs=crs.text)
        else:
            text = "number of cameras that cover the cell, 65535 nodata"
            of_targets = raster(small, grid, crs, name="cameras", description=text, nodata=65535.0, unit="1")
        places = columns.pop("place")
        cameras = Table(columns, places=places, crs=crs.text)
        cameras.remarks = of_targets.remarks = remarks
        return Placement(cameras, of_targets, remarks=remarks, **whole)

    def survey_plan(
        self,
        candidates: Candidates | list[Places],
        observer: Places | None = None,
        target: Places | None = None,
        *,
        sun: Numbers | None = None,
        cell: float | None = None,
        count: int = 1,
        spacing: float = 5.0,
        station_height: float | None = None,
        max_distance: float | None = None,
        angle_step_deg: float | None = None,
        observer_height: float | None = None,
        target_height: float | None = None,
        ground: Ground | None = None,
        progress: Progress = None,
    ) -> Table:
        """Where to put a scanner next, so that unproven lines of sight become proven.

        Parameters
        ----------
        candidates : array_like, shape (N, 2) or (N, 3), or {'ground', 'roofs'}
            Places for the scanner in the coordinates of the file; without z, `station_height` above the ground. Or a
            grid of places above the ground or above roofs. A list of such arrays has a candidate for each of them that
            is scanned from all of its places, such as a flight line.
        observer, target : array_like, shape (3,), (N, 3), (2,) or (N, 2), optional
            Ends of the lines of sight that matter, as for `line_of_sight`.
        sun : array_like, shape (2,) or (K, 2), optional
            In place of these: azimuths and elevations, degrees, of suns whose light on the ground matters.
        cell : float, optional
            With `sun`: side of the cells of the ground, metres; 2 if not given, more for large scenes.
        count : int, optional
            Stations to choose.
        spacing : float, optional
            Side of the cells of a grid of candidates, metres.
        station_height : float, optional
            Height of the scanner above the ground or the roof, metres; 1.8 if not given.
        max_distance : float, optional
            Maximum range of the scanner, metres; 100 if not given.
        angle_step_deg : float, optional
            Angle between pulses, degrees; 0.1 if not given.
        observer_height, target_height, ground, progress : optional
            As for `line_of_sight`.

        Returns
        -------
        Table
            A row for each candidate that can be used, chosen stations first: ``station`` (its number, 0 for one that
            was not chosen), ``settles_alone`` (unproven lines that become proven if nothing stands where no pulse
            was), ``expected_alone`` (how many are expected to), ``proves_alone_m``, and the same for it and the
            stations before it: ``settled`` and ``expected``, NaN where it was not chosen. Its `places` are where the
            scanner stands.

        Raises
        ------
        BelvedereError
            For a scene without known scanner positions, where no candidate can be used, and for parameters out of
            range.

        Warns
        -----
        BelvedereWarning
            Where no candidate settles any line, and of given candidates that cannot be used.

        References
        ----------
        docs/methods/survey-plan.md

        Examples
        --------
        >>> plan = scene.survey_plan("ground", eye, targets, spacing=20, max_distance=60)
        >>> plan["station"].dtype, (plan["settles_alone"] >= 0).all()
        (dtype('uint64'), np.True_)
        """
        if isinstance(candidates, str) and candidates not in ("ground", "roofs"):
            raise wrong("candidates", repr(candidates), "give places, 'ground' or 'roofs'")
        if (sun is None) == (observer is None and target is None):
            raise wrong("observer and target", "missing" if sun is None else "given", "give both of them, or only sun")
        check_finite(spacing=spacing, station_height=station_height, max_distance=max_distance)
        check_finite(observer_height=observer_height, target_height=target_height, angle_step_deg=angle_step_deg)
        observers = targets = np.empty((0, 3))
        if sun is None:
            if observer is None or target is None:
                raise wrong("observer and target", "one of them", "give both of them, or only sun")
            observers, targets = pairs_of(observer, target, self._core.crs.text)
        given_places, has_lines = _stations(candidates, self._core.crs.text)
        question = given(
            count=count,
            candidates=_grid(candidates, spacing),
            station_height=station_height,
            max_distance=max_distance,
            angle_step_deg=angle_step_deg,
            suns=None if sun is None else suns_of(sun, None)[0],
            whole_lines=has_lines,
            observer_height=observer_height,
            target_height=target_height,
            ground=ground_of(ground),
        )
        cells = wanted(None, None, cells_of(cell, target_height, False, ground))
        arguments = question, given_places, observers, targets, cells
        columns, remarks = self._core.survey_plan(*arguments, reporter(progress))
        places = columns.pop("place")
        table = Table(columns, places=places, crs=self._core.crs.text)
        table.remarks = warned(remarks)
        return table


def _grid(candidates: Any, spacing: float) -> dict[str, float] | None:
    """Candidates of a grid; None for places."""
    return {candidates: spacing} if isinstance(candidates, str) else None


def _stations(candidates: Any, crs: str | None) -> tuple[list[tuple[list[float], int | None]] | None, bool]:
    """Places with the numbers of the lines that they are on, if any are given, and whether they are on lines."""
    if isinstance(candidates, str):
        return None, False
    if isinstance(candidates, (list, tuple)) and candidates and not any(map(is_single, candidates)):
        lines = [map_places(line, "candidates", _PLACES, crs=crs).tolist() for line in candidates]
        return [(place, number) for number, line in enumerate(lines) for place in line], True
    return [(place, None) for place in map_places(candidates, "candidates", _PLACES, crs=crs).tolist()], False


def _existing(given: Places | Table | None, crs: str | None) -> npt.NDArray[np.float64]:
    """Rows of x, y, z, heading and tilt, NaN where they are not given."""
    if given is None:
        return np.empty((0, 5))
    if isinstance(given, Table):
        if given.places is None:
            raise wrong("existing", "a table without places", "give the cameras of an earlier choice")
        return np.column_stack([given.places, given["heading_deg"], given["tilt_deg"]]).astype(np.float64)
    advice = "give x, y, z, heading and tilt, or x and y, or x, y and z: shape (N, 5), (N, 2) or (N, 3)"
    given = in_system(given, "existing", crs)
    try:
        array = np.atleast_2d(np.asarray(given, np.float64))
    except (TypeError, ValueError):
        raise wrong("existing", repr(given), advice) from None
    if array.ndim == 2 and array.shape[1] == 5:
        return array
    places = map_places(array, "existing", advice)
    return np.column_stack([places, np.full((len(places), 2), np.nan)])


def _weights(weights: Numbers, targets: Targets) -> npt.NDArray[np.float64]:
    array = np.asarray(weights, np.float64)
    places = coordinates(targets)
    rows = 0 if places is None else len(places)
    if array.shape != (rows,):
        raise wrong("weights", f"an array of shape {array.shape}", f"give one for each of the {rows} targets")
    return array
