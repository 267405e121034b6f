"""Scenes: questions about visibility."""

from __future__ import annotations

import json
import os
import warnings
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._cameras import Cameras
from ._cloud import Cloud, read
from ._core import Scene as NativeScene
from ._documents import Documents
from ._energy import Energy
from ._errors import BelvedereWarning, wrong
from ._glare import Glare
from ._heat import Heat
from ._inputs import as_list, check_finite, check_whole, native_source, path_text, place, reporter
from ._mesh import Mesh, native_mesh
from ._outlook import Outlook
from ._planning import Planning
from ._raster import escaped
from ._remarks import warned
from ._shapes import rings_of
from ._sights import Sights
from ._sunlight import Sunlight
from ._towers import Towers
from ._types import CarvingRule, Device, Method, Numbers, Orient, Polygon, Progress, Source, Trees


class Scene(Sights, Outlook, Towers, Sunlight, Energy, Heat, Glare, Planning, Documents, Cameras):
    """A scene that answers what can be seen: medial balls, cut with the space that laser pulses prove empty.

    Parameters
    ----------
    cloud : Cloud, or what `read` takes
        The points.
    trees : {'measured', 'opaque', 'porous'}, optional
        What crowns are taken for: as the pulses found them (default), solid as in full leaf, or twigs as in winter.
    orient : {'auto', 'pulses', 'scanner', 'given', 'up'}, optional
        How normals are turned outward: by what the cloud has (default), by the pulses, towards the scanner positions
        of the file, as the file says, or upward.
    scanner : array_like, shape (3,), optional
        Place of the one scanner, in the coordinates of the cloud, in place of `orient`.
    stations : path, mapping or array_like of shape (N, 4), optional
        Where a scanner on the ground stood, in place of `orient`: a table with the columns station, x, y and z, places
        by the point source id of their points, or rows of these four numbers. In the coordinates of the cloud.
    trajectory : path, optional
        Trajectory of the scanner, in place of `orient`.
    mesh : path, optional
        Mesh whose faces say which side is outside, in place of `orient`.
    method : {'carved', 'tau', 'angles'}, optional
        How balls are made: carved with pulses where that is possible (default), from points alone, or as published in
        2015.
    without : str or list of str, optional
        Rules of carving to leave out, such as ``'crowns'``.
    keep_noise, keep_duplicates, keep_isolated : bool, optional
        Points that cleaning would leave out.
    keep_strips : bool, optional
        Heights of flight lines that differ by more than 5 cm, which are fitted to each other otherwise.
    neighbors : int, optional
        Points that a normal is estimated from.
    initial_radius, max_radius, penetration : float, optional
        Radius in metres that balls start with, their greatest radius, and how deep a point may lie in a ball.
    cache : bool or path, optional
        Whether the scene is kept on disk, so that the next one of the same cloud and parameters is there at once (also
        after the cloud was read anew), or the folder for it. ``belvedere cache`` lists what is kept.
    progress : bool or callable, optional
        True shows a bar; a function is called with stage, items done and items in all, and stops the work by raising.

    Attributes
    ----------
    cloud : Cloud or None
        The points; None for a scene from a ball file without them.
    report : dict
        What became of the points on the way; ``"scene"`` says whether it was found in the cache or built.

    Raises
    ------
    BelvedereError
        For parameters out of range, and for a cloud that lacks what they need.

    Notes
    -----
    The numbers that are not given are those of the library, and of the command line: ``belvedere balls --help`` shows
    them. Results are the same, bit by bit, for any number of threads.

    References
    ----------
    Peters, Ledoux & Biljecki 2015, "Visibility analysis in a point cloud based on the medial axis transform".

    Examples
    --------
    >>> scene = belvedere.Scene(cloud)
    >>> scene
    <belvedere.Scene: ... balls, carved with ... pulses, EPSG:7415 ...>
    """

    _planned = False
    _choices: dict[str, Any] | None = None

    def __init__(
        self,
        cloud: Cloud | Source,
        *,
        trees: Trees | None = None,
        orient: Orient | None = None,
        scanner: Numbers | None = None,
        stations: str | os.PathLike[str] | Mapping[int, Numbers] | Numbers | None = None,
        trajectory: str | os.PathLike[str] | None = None,
        mesh: str | os.PathLike[str] | None = None,
        method: Method | None = None,
        without: CarvingRule | list[CarvingRule] = [],
        keep_noise: bool = False,
        keep_duplicates: bool = False,
        keep_isolated: bool = False,
        keep_strips: bool = False,
        neighbors: int | None = None,
        initial_radius: float | None = None,
        max_radius: float | None = None,
        penetration: float | None = None,
        cache: bool | str | os.PathLike[str] = True,
        progress: Progress = None,
    ) -> None:
        if isinstance(cloud, np.ndarray):
            raise wrong("cloud", "an array", "make a cloud of it: belvedere.Cloud(xyz, crs='EPSG:CODE')")
        if not isinstance(cloud, Cloud):
            cloud = read(cloud)
        ways = {"orient": orient, "scanner": scanner, "stations": stations, "trajectory": trajectory, "mesh": mesh}
        given = [name for name, value in ways.items() if value is not None]
        if len(given) > 1:
            raise wrong(" and ".join(given), "given together", "give one of them")
        check_finite(initial_radius=initial_radius, penetration=penetration)
        choices = {
            "trees": trees,
            "orient": orient,
            "scanner": None if scanner is None else place(scanner, "scanner"),
            "stations": None if stations is None else _stations(stations),
            "trajectory": None if trajectory is None else os.fspath(trajectory),
            "mesh": None if mesh is None else os.fspath(mesh),
            "method": method,
            "without": as_list(without),
            "keep_noise": keep_noise,
            "keep_duplicates": keep_duplicates,
            "keep_isolated": keep_isolated,
            "keep_strips": keep_strips,
            "neighbors": neighbors,
            "initial_radius": initial_radius,
            "max_radius": max_radius,
            "penetration": penetration,
            "cache": cache if isinstance(cache, bool) else os.fspath(cache),
        }
        self._core, text, remarks = _core.Scene.build(cloud._core, choices, reporter(progress))
        self._choices = choices
        self.cloud: Cloud | None = cloud
        self.report: dict[str, Any] = json.loads(text)
        remark = self.report.get("pulses", {}).get("remark")
        if remark:
            warnings.warn(str(remark), BelvedereWarning, stacklevel=2)
        warned(remarks)

    @classmethod
    def load(
        cls, source: Source, *, cloud: Cloud | None = None, name: str | None = None, progress: Progress = None
    ) -> Scene:
        """The scene of a ball file.

        Parameters
        ----------
        source : path, bytes or binary file
            ``.npz`` holds everything; ``.ply``, ``.las`` and ``.laz`` hold the balls without the pulses.
        cloud : Cloud, optional
            The points, which show the ground below cells and observers.
        name : str, optional
            Name of bytes, such as ``"balls.npz"``.
        progress : bool or callable, optional

        Examples
        --------
        >>> scene.save(folder / "balls.npz")
        >>> again = belvedere.Scene.load(folder / "balls.npz", cloud=scene.cloud)
        >>> bool((again.visible(eye, targets) == scene.visible(eye, targets)).all())
        True
        """
        if cloud is not None and not isinstance(cloud, Cloud):
            raise wrong("cloud", f"a {type(cloud).__name__}", "give a Cloud: belvedere.read(path)")
        core = _core.Scene.load(native_source(source, name), None if cloud is None else cloud._core, reporter(progress))
        return cls._of(core, {} if cloud is None else cloud.report, {})

    def calibrate(self, *, share: float = 0.1, seed: int = 1, progress: Progress = None) -> dict[str, Any]:
        """How reliable answers on this survey are, measured with pulses that are kept out of a second scene.

        The way of a pulse to its first return is free: an answer that it is blocked is wrong. A place 1 m behind a last
        return of ground or a building is hidden from the scanner: an answer that it is visible is wrong. Only
        directions from the scanner are tested, and the neighbours of the pulses kept out remain.

        Parameters
        ----------
        share : float
            Share of the pulses kept out, above 0 and below 1.
        seed : int
            Chooses these pulses.
        progress : bool or callable, optional

        Returns
        -------
        dict
            ``free_paths`` and ``hidden_places`` with their wrong answers in percent and 95 % intervals, and
            ``probabilities``: what answers are worth that are 90 % certain, and the shares expected and found by tenths
            of probability.

        Raises
        ------
        BelvedereError
            For a scene that was not made of a cloud, and for a cloud whose pulses or scanner are not known.

        Examples
        --------
        >>> scene.calibrate()["free_paths"]["wrong_percent"]
        {'value': ..., 'low': ..., 'high': ...}
        """
        if self._choices is None or self.cloud is None:
            raise wrong("scene", "not made of a cloud as it is", "make it of one: Scene(read(path))")
        text, remarks = _core.Scene.calibrate(self.cloud._core, self._choices, share, seed, reporter(progress))
        warned(remarks)
        found: dict[str, Any] = json.loads(text)
        return found

    def with_added(self, *meshes: str | os.PathLike[str] | Mesh) -> Scene:
        """The same scene with planned buildings: meshes (``.obj .ply .json``) in the coordinates of the cloud.

        Their triangles block lines of sight exactly as they are, from both sides, beside balls. A target within 1 mm
        of the plane of a triangle is not blocked by that triangle. What pulses prove stays as it was. Ball files do not
        keep added meshes.

        Parameters
        ----------
        meshes : path or Mesh

        Examples
        --------
        >>> low, high = scene.bounds
        >>> x, y = ((low + high) / 2)[:2]
        >>> corners = [(x + a, y + b, low[2] + c) for a, b, c in [(-9, 0, -9), (9, 0, -9), (9, 0, 90), (-9, 0, 90)]]
        >>> planned = scene.with_added(belvedere.Mesh(corners, [(0, 1, 2), (0, 2, 3)]))
        >>> ends = [(x, y - 5, high[2])], [(x, y + 5, high[2])]
        >>> [int(s.line_of_sight(*ends)["answer"][0]) for s in (scene, planned)]
        [1, 0]
        """
        if not meshes:
            raise wrong("meshes", "missing", "give at least one mesh")
        core = self._core.with_added([native_mesh(mesh) for mesh in meshes])
        return self._plan(core, self.report)

    def without(
        self,
        polygon: Polygon | None = None,
        *,
        class_: int | None = None,
    ) -> Scene:
        """The same scene without what stands in an area now: points above the ground, and the balls at them.

        Balls beside the area are cut to its edge, and the ground is closed at the height interpolated from the ground
        around. Lines of sight through the space that was freed count as proven. Meshes that were added go too.

        Parameters
        ----------
        polygon : corners, rings, or polygon of shapely or geopandas
            Corners (x, y) of an outline in the coordinates of the cloud, or the outline and its holes.
        class_ : int
            Instead: the points of this class.

        Examples
        --------
        >>> low, high = scene.bounds
        >>> x, y = ((low + high) / 2)[:2]
        >>> cleared = scene.without([(x - 20, y - 20), (x + 20, y - 20), (x + 20, y + 20), (x - 20, y + 20)])
        >>> cleared.report["cleared"]["points_cleared"] == len(scene.cloud) - len(cleared.cloud)
        True
        """
        if (polygon is None) == (class_ is None):
            raise wrong("polygon and class_", "both or none", "give one of them")
        if self.cloud is None:
            raise wrong("cloud of the scene", "missing", "make the scene of a cloud: Scene(read(path))")
        rings = None
        if isinstance(polygon, int):
            raise wrong("polygon", polygon, f"leave out the points of a class with class_={polygon}")
        if polygon is not None:
            rings = rings_of(polygon, "polygon", self._core.crs.text)
        check_whole(class_=class_)
        core, text, remarks = self._core.without(rings, 0 if class_ is None else int(class_))
        warned(remarks)
        return self._plan(core, {**self.report, "cleared": json.loads(text)})

    def with_horizon(self, path: str | os.PathLike[str]) -> Scene:
        r"""The same scene before far terrain: directions to the sun and the sky below its horizon are blocked.

        Parameters
        ----------
        path : path
            The horizon of PVGIS (``.json .csv``, azimuths from south), or a table of azimuth, clockwise from north,
            and elevation in degrees.

        Examples
        --------
        >>> _ = (folder / "horizon.csv").write_text("0,30\n180,30")
        >>> float(np.nanmax(scene.with_horizon(folder / "horizon.csv").shadow(sun=(180, 29)).values))
        0.0
        """
        return self._plan(self._core.with_horizon(path_text(path, "path")), self.report)

    def with_terrain(self, path: str | os.PathLike[str]) -> Scene:
        """The same scene before the terrain of an elevation raster: each place has its own horizon.

        Horizons are exact for the cells of the raster, with the curvature of the earth and refraction. Within the
        extent of the cloud, and one cell around it, the raster blocks nothing. Places of `line_of_sight` and
        `viewshed` may then be on the terrain.

        Parameters
        ----------
        path : path
            Heights of the ground (DTM, ``.tif``) in the coordinate system of the cloud, or in degrees.

        Examples
        --------
        >>> lit = scene.with_terrain("dtm.tif").shadow(sun=(180, 20))  # doctest: +SKIP
        """
        return self._plan(self._core.with_terrain(path_text(path, "path")), self.report)

    def with_device(self, device: Device = "auto") -> Scene:
        """The same scene, whose lines of sight and depth maps are the work of a graphics processor.

        Answers are the same. Depths of depth maps and panoramas differ by at most 0.00001 of themselves, and with
        ``"cpu"`` not at all. Wheels are built without graphics processors: the page on graphics processors says how to
        build one with them.

        Parameters
        ----------
        device : str or int
            ``"auto"``: a graphics card, for questions of many lines of sight and large depth maps. ``"cpu"``.
            ``"gpu"``: the first graphics card, or else integrated graphics; where there is none, the CPU, with a
            warning. A number: that of :func:`belvedere.devices`.

        Examples
        --------
        >>> scene.with_device("cpu").device is None
        True
        """
        core = self._core.with_device(str(device))
        for note in core.device_notes:
            warnings.warn(note, BelvedereWarning, stacklevel=2)
        scene = Scene._of(core, {} if self.cloud is None else self.cloud.report, self.report)
        scene._planned, scene._choices = self._planned, self._choices
        return scene

    @property
    def device(self) -> str | None:
        """The graphics processor that is ready to be used; None for the CPU.

        Examples
        --------
        >>> scene.device is None
        True
        """
        return self._core.device

    @property
    def device_notes(self) -> list[str]:
        """What the CPU had to do instead of the device, and why, a line each.

        Examples
        --------
        >>> scene.device_notes
        []
        """
        return self._core.device_notes

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes a ball file: ``.npz`` keeps every bit; ``.ply .laz .las`` are for looking at.

        Examples
        --------
        >>> scene.save(folder / "balls.npz")
        """
        if self._planned:
            remark = "ball files do not keep added meshes, freed space and far terrain: they are not saved"
            warnings.warn(remark, BelvedereWarning, stacklevel=2)
        self._core.save(os.fspath(path))

    @classmethod
    def _of(cls, core: NativeScene, of_cloud: dict[str, Any], report: dict[str, Any]) -> Scene:
        scene = cls.__new__(cls)
        scene._core = core
        points = core.cloud
        scene.cloud = None if points is None else Cloud._of(points, of_cloud)
        scene.report = report
        return scene

    def _plan(self, core: NativeScene, report: dict[str, Any]) -> Scene:
        """A scene made of this one, of which a ball file does not keep everything."""
        scene = Scene._of(core, {} if self.cloud is None else self.cloud.report, report)
        scene._planned = True
        return scene

    @property
    def crs(self) -> str | None:
        """The coordinate reference system as well-known text or ``EPSG:CODE``; None where it is not known."""
        return self._core.crs.text

    @property
    def bounds(self) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
        """Lowest and highest corner of the points that the balls were made from.

        Examples
        --------
        >>> low, high = scene.bounds
        >>> bool((low <= high).all())
        True
        """
        low, high = self._core.bounds
        return np.array(low), np.array(high)

    @property
    def provenance(self) -> dict[str, str]:
        """How the balls were made.

        Examples
        --------
        >>> scene.provenance["method"]
        'carved'
        """
        return dict(self._core.provenance)

    def __repr__(self) -> str:
        pulses = self._core.pulse_count
        how = f"carved with {pulses} pulses" if pulses is not None else "without pulses"
        return f"<belvedere.Scene: {self._core.ball_count} balls, {how}, {self._core.crs.description}>"

    def _repr_html_(self) -> str:
        from ._picture import png_tag

        text = f"<pre>{escaped(json.dumps(self.report, indent=1))}</pre>"
        details = f"<details><summary>{escaped(repr(self))}</summary>{text}</details>"
        if self.cloud is None:
            return details
        return png_tag(_relief(self.cloud)) + details

    def __reduce__(self) -> tuple[Any, ...]:
        if self._planned:
            raise TypeError("a planned scene cannot be pickled; pickle the scene that it was made of")
        return _unpickled, (self._core.to_bytes(), self.cloud, self.report)


def _stations(given: Any) -> str | list[tuple[int, tuple[float, float, float]]]:
    """The path of a table, or ids and places."""
    if isinstance(given, (str, os.PathLike)):
        return os.fspath(given)
    if isinstance(given, Mapping):
        rows = [(number, place(where, f"stations[{number}]")) for number, where in given.items()]
    else:
        array = np.asarray(given, np.float64)
        if array.ndim != 2 or array.shape[1] != 4:
            raise wrong("stations", f"an array of shape {array.shape}", "give station, x, y and z in four columns")
        rows = [(row[0], place(row[1:], "stations")) for row in array]
    if not rows:
        raise wrong("stations", "empty", "give at least one")
    numbers = [number for number, _ in rows]
    if any(number != int(number) or not 0 <= number <= 65535 for number in numbers) or len(set(numbers)) < len(rows):
        raise wrong("stations", repr(numbers), "each is a point source id, 0 to 65535, and occurs once")
    return [(int(number), where) for number, where in rows]


def _relief(cloud: Cloud) -> npt.NDArray[np.float64]:
    """Heights of the highest points, on a small grid for a picture."""
    xyz = cloud.xyz
    low = xyz[:, :2].min(axis=0)
    span = max(float((xyz[:, :2].max(axis=0) - low).max()), 1e-9)
    size = 160
    columns, rows = ((xyz[:, :2] - low) / span * (size - 1)).astype(np.intp).T
    heights = np.full((rows.max() + 1, columns.max() + 1), -np.inf)
    np.maximum.at(heights, (rows.max() - rows, columns), xyz[:, 2])
    return np.where(np.isfinite(heights), heights, np.nan)


def _unpickled(balls: bytes, cloud: Cloud | None, report: dict[str, Any]) -> Scene:
    core = _core.Scene.load(("scene.npz", balls), None if cloud is None else cloud._core, None)
    return Scene._of(core, {} if cloud is None else cloud.report, report)
