"""Questions about what is seen from where."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple, overload

import numpy as np
import numpy.typing as npt

from . import _core
from ._answer import Answer
from ._cloud import Cloud
from ._inputs import check_finite, pairs_of, place, reporter
from ._keywords import LineOfSight
from ._mesh import Mesh
from ._questions import earth, given, ground_of, how_sure, unproven_as
from ._remarks import Remark, warned
from ._shapes import in_system, is_single
from ._table import Table
from ._targets import Targets, face_table, wanted
from ._types import Curvature, Ground, Place, PlaceRows, Places, Progress, Unproven

if TYPE_CHECKING:
    from typing_extensions import Unpack


class Sight(NamedTuple):
    """What is known of one line of sight.

    Attributes
    ----------
    answer : Answer
        Whether the target can be seen.
    first_block_range_m : float
        Distance from the observer to what blocks first, metres; NaN where nothing does.
    unproven_m : float
        How much of the line no laser pulse came near to, metres; NaN where it is blocked or pulses are not known.
    block : tuple of 3 floats
        Where the line is blocked first, in the coordinates of the file.
    fresnel_free_percent : float
        How much of the radius of the first Fresnel zone is free; NaN without a frequency.
    block_surface : str
        Kind of the surface patch that blocks first: roof, wall, parapet, step, box, inside or slab; empty where
        none does.
    block_terrain : bool
        Whether it is the terrain of `with_terrain` that blocks first.
    probability : float
        How likely both ends see each other, 0 to 1; NaN where that was not wanted.
    uncertain : bool or None
        Whether the answer is less certain than wanted, or unproven; None where that was not wanted.
    remarks : tuple of Remark
        What to know of the answer.

    Examples
    --------
    >>> sight = scene.line_of_sight(eye, targets[0])
    >>> sight.answer in belvedere.Answer
    True
    """

    answer: Answer
    first_block_range_m: float
    unproven_m: float
    block: tuple[float, float, float]
    fresnel_free_percent: float = float("nan")
    block_terrain: bool = False
    remarks: tuple[Remark, ...] = ()
    block_surface: str = ""
    probability: float = float("nan")
    uncertain: bool | None = None


class Sights:
    """What is seen from where."""

    _core: _core.Scene

    @overload
    def visible(
        self, eye: Places, targets: Mesh, *, unproven: Unproven = "report", progress: Progress = None
    ) -> Table: ...
    @overload
    def visible(
        self, eye: Places, targets: Places | Cloud | None, *, unproven: Unproven = "report", progress: Progress = None
    ) -> npt.NDArray[np.uint8]: ...
    def visible(
        self,
        eye: Places,
        targets: Targets,
        *,
        unproven: Unproven = "report",
        progress: Progress = None,
    ) -> npt.NDArray[np.uint8] | Table:
        """Which targets one eye can see.

        Parameters
        ----------
        eye : array_like, shape (3,)
            Place of the eye in the coordinates of the file: x, y, z.
        targets : array_like, shape (N, 3), Cloud, or Mesh
            Places in the coordinates of the file, or the faces of a mesh. None means the cells of a grid, as for
            `shadow`.
        unproven : {'report', 'as-visible', 'as-blocked'}
            What to make of lines that nothing blocks but that cross space that no pulse came near.
        progress : bool or callable, optional

        Returns
        -------
        ndarray, shape (N,), uint8; or Table
            An `Answer` for each target. For a mesh a row for each face: ``object``, ``area_m2``, ``visible_m2``,
            ``visible_share``, ``unproven_m2`` and ``standard_error_m2``; its attribute ``objects`` has the same for
            each object. Faces that are turned away are not visible.

        Raises
        ------
        BelvedereError
            For places that are not finite or not of shape (N, 3).

        Examples
        --------
        >>> seen = scene.visible(eye, targets)
        >>> seen.dtype, len(seen) == len(targets)
        (dtype('uint8'), True)
        >>> x, y, z = eye
        >>> wall = belvedere.Mesh([(x - 2, y + 9, z), (x, y + 9, z + 2), (x + 2, y + 9, z)], [(0, 1, 2)])
        >>> scene.visible(eye, wall)
        <belvedere.Table: 1 rows of object, area_m2, visible_m2, visible_share, unproven_m2, standard_error_m2>
        """
        if isinstance(targets, Mesh):
            faces, found = self._core.seen_of_mesh(
                place(eye, "eye"), targets._faces, unproven_as(unproven), reporter(progress)
            )
            table = face_table(faces)
            table.remarks = warned(found)
            return table
        targets = in_system(targets, "targets", self._core.crs.text)
        chosen = wanted(targets, None, {})
        answers, found = self._core.visible(place(eye, "eye"), chosen, unproven_as(unproven), reporter(progress))
        warned(found)
        return answers

    @overload
    def line_of_sight(self, observer: Place, target: Place, **more: Unpack[LineOfSight]) -> Sight: ...
    @overload
    def line_of_sight(self, observer: Place, target: PlaceRows, **more: Unpack[LineOfSight]) -> Table: ...
    @overload
    def line_of_sight(self, observer: PlaceRows, target: Place | PlaceRows, **more: Unpack[LineOfSight]) -> Table: ...
    @overload
    def line_of_sight(self, observer: Places, target: Places, **more: Unpack[LineOfSight]) -> Any: ...
    def line_of_sight(
        self,
        observer: Places,
        target: Places,
        *,
        observer_height: float | None = None,
        target_height: float | None = None,
        ground: Ground | None = None,
        unproven: Unproven = "report",
        probability: bool = False,
        certain: float | None = None,
        curvature: Curvature | None = None,
        refraction: float | None = None,
        frequency_ghz: float | None = None,
        progress: Progress = None,
    ) -> Any:
        """What is known of lines of sight between pairs of places.

        With `with_terrain`, places may lie on the terrain beyond the cloud, which then blocks as in `viewshed`.

        Parameters
        ----------
        observer, target : array_like, shape (3,), (N, 3), (2,) or (N, 2)
            Ends of the lines in the coordinates of the file: x, y, z. Without z they are above the ground. One observer
            can have many targets, and the other way round.
        observer_height : float, optional
            Height of observers without z above the ground, metres; 1.7 if not given.
        target_height : float, optional
            Height of targets without z above the ground, metres; 0.1 if not given.
        ground : {'auto', 'class', 'found'}, optional
            Which points are ground, as for `viewshed`.
        unproven : {'report', 'as-visible', 'as-blocked'}
            What to make of lines that nothing blocks but that cross space that no pulse came near.
        probability : bool, optional
            Whether to compute how likely the ends see each other. Needs pulses.
        certain : float, optional
            Probability, above 0.5 and at most 1, below which an answer is uncertain.
        curvature : {'auto', 'on', 'off'}, optional
            Whether lines follow the curvature of the earth; those of more than 2 km if not given.
        refraction : float, optional
            Share of the curvature that light follows, 0 to below 1; 1/7 if not given.
        frequency_ghz : float, optional
            Frequency of a radio link, 0.001 to 1000: also tests its first Fresnel zone.
        progress : bool or callable, optional

        Returns
        -------
        Sight or Table
            A `Sight` for one pair. For several a `Table` with ``answer``, ``first_block_range_m``, ``unproven_m``
            (where pulses are known), ``probability``, ``uncertain`` (where wanted), ``fresnel_free_percent`` (with a
            frequency), ``block_x``, ``block_y``, ``block_z`` (together ``block``, (N, 3)), ``block_ball``,
            ``block_source`` (-1 where no ball blocks), ``block_surface`` (where the scene has patches of surfaces) and
            ``block_terrain`` (with terrain).

        Raises
        ------
        BelvedereError
            For places that are not finite, and where there are not as many observers as targets.

        Warns
        -----
        BelvedereWarning
            Of lines with an end outside the cloud or inside an obstacle, and of ends without known ground.

        Examples
        --------
        >>> scene.line_of_sight(eye, targets)
        <belvedere.Table: ... rows of answer, first_block_range_m, unproven_m, block_x, block_y, block_z,
        block_ball, block_source, block_surface>
        """
        check_finite(frequency_ghz=frequency_ghz, observer_height=observer_height, target_height=target_height)
        is_one = is_single(observer) and is_single(target)
        observers, targets = pairs_of(observer, target, self._core.crs.text)
        question = given(
            observer_height=observer_height,
            target_height=target_height,
            ground=ground_of(ground),
            earth=earth(curvature, refraction),
            frequency_ghz=frequency_ghz,
            unproven=unproven_as(unproven),
            how_sure=how_sure(probability, certain),
        )
        columns, standing, found = self._sight_columns(question, observers, targets, None, progress)
        remarks = warned(found)
        if not is_one:
            # heights that were given, to their last digit
            np.copyto(standing, targets, where=~np.isnan(targets))
            table = Table(columns, places=standing, crs=self._core.crs.text)
            table.remarks = remarks
            return table
        nan = float("nan")
        block = columns["block"][0]
        return Sight(
            Answer(int(columns["answer"][0])),
            float(columns["first_block_range_m"][0]),
            float(columns["unproven_m"][0]) if "unproven_m" in columns else nan,
            (float(block[0]), float(block[1]), float(block[2])),
            float(columns["fresnel_free_percent"][0]) if "fresnel_free_percent" in columns else nan,
            bool(columns["block_terrain"][0]) if "block_terrain" in columns else False,
            remarks,
            str(columns["block_surface"][0]) if "block_surface" in columns else "",
            float(columns["probability"][0]) if "probability" in columns else nan,
            bool(columns["uncertain"][0] > 0) if "uncertain" in columns else None,
        )

    def network(
        self,
        places: Places,
        *,
        max_distance: float | None = None,
        observer_height: float | None = None,
        ground: Ground | None = None,
        unproven: Unproven = "report",
        probability: bool = False,
        certain: float | None = None,
        curvature: Curvature | None = None,
        refraction: float | None = None,
        frequency_ghz: float | None = None,
        progress: Progress = None,
    ) -> Table:
        """Which of several places see each other.

        Lines of sight are the same in both directions.

        Parameters
        ----------
        places : array_like, shape (N, 3) or (N, 2)
            Places in the coordinates of the file: x, y, z. Without z they are above the ground.
        max_distance : float, optional
            Horizontal distance up to which two places are a pair, metres; no limit if not given.
        observer_height : float, optional
            Height of places without z above the ground, metres; 1.7 if not given.
        ground, unproven, probability, certain, curvature, refraction, frequency_ghz
            As for `line_of_sight`.
        progress : bool or callable, optional

        Returns
        -------
        Table
            A row for each pair: ``a`` and ``b``, the rows of its places, ``length_m``, and the columns of
            `line_of_sight`.

        Raises
        ------
        BelvedereError
            For fewer than two places, more than 10 million pairs, and places that are not finite.

        Examples
        --------
        >>> links = scene.network([eye, targets[0], targets[1]])
        >>> [(int(a), int(b)) for a, b in zip(links["a"], links["b"])]
        [(0, 1), (0, 2), (1, 2)]
        """
        check_finite(frequency_ghz=frequency_ghz, max_distance=max_distance, observer_height=observer_height)
        given_places, _ = pairs_of(places, places, self._core.crs.text)
        question = given(
            observer_height=observer_height,
            ground=ground_of(ground),
            earth=earth(curvature, refraction),
            frequency_ghz=frequency_ghz,
            unproven=unproven_as(unproven),
            how_sure=how_sure(probability, certain),
        )
        columns, standing, found = self._sight_columns(question, given_places, None, max_distance, progress)
        table = Table(columns, places=standing, crs=self._core.crs.text)
        table.remarks = warned(found)
        return table

    def _sight_columns(
        self,
        question: dict[str, Any],
        observers: npt.NDArray[np.float64],
        targets: npt.NDArray[np.float64] | None,
        max_distance: float | None,
        progress: Progress,
    ) -> tuple[dict[str, Any], npt.NDArray[np.float64], list[dict[str, Any]]]:
        """Columns of lines of sight, where they end, and remarks."""
        arguments = question, observers, targets, max_distance
        columns, standing, found = self._core.lines_of_sight(*arguments, reporter(progress))
        if "block_surface" in columns:
            columns["block_surface"] = np.asarray(columns["block_surface"])
        return columns, standing, found
