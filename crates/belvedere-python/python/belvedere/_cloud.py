"""Point clouds."""

from __future__ import annotations

import datetime
import json
import os
import warnings
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._errors import BelvedereWarning, wrong
from ._inputs import class_numbers, map_box, native_source, places, reporter, system_text
from ._remarks import warned
from ._types import Numbers, Places, Progress, Source, System, Up

#: Attributes of points: their types, and their columns where there are several.
ATTRIBUTES: Mapping[str, tuple[Any, int]] = {
    "classification": (np.uint8, 0),
    "gps_time": (np.float64, 0),
    "return_number": (np.uint8, 0),
    "return_count": (np.uint8, 0),
    "scan_angle": (np.float32, 0),
    "point_source_id": (np.uint16, 0),
    "scanner_channel": (np.uint8, 0),
    "flags": (np.uint8, 0),
    "intensity": (np.uint16, 0),
    "color": (np.uint16, 3),
    "normals": (np.float32, 3),
}


class Cloud:
    """A point cloud from arrays.

    Parameters
    ----------
    xyz : array_like, shape (N, 3)
        Coordinates in the unit of `crs`: east, north, up. 32 or 64 bit, with any strides; other numbers are converted.
    crs : str, int or object of pyproj, optional
        Coordinate reference system: ``"EPSG:28992"``, its number, well-known text, or a PROJ string. Without one,
        coordinates are metres.
    classification : array_like, shape (N,), uint8, optional
        ASPRS classes: 2 ground, 3 to 5 vegetation, 6 building, 7 and 18 noise.
    gps_time : array_like, shape (N,), float64, optional
        Seconds. Needed, with `return_number` and `return_count`, to find the scanner.
    adjusted_gps_time : bool, optional
        Whether `gps_time` counts from 1e9 s of GPS time (bit 0 of the LAS global encoding) rather than from Sunday
        midnight.
    return_number, return_count : array_like, shape (N,), uint8, optional
        Which return of its pulse a point is, from 1, and how many returns the pulse had.
    scan_angle : array_like, shape (N,), float32, optional
        Radians.
    point_source_id : array_like, shape (N,), uint16, optional
        Flight line.
    scanner_channel, flags : array_like, shape (N,), uint8, optional
        Channel of the scanner; LAS flags (1 synthetic, 2 key point, 4 withheld, 8 overlap).
    intensity : array_like, shape (N,), uint16, optional
    color : array_like, shape (N, 3), uint16, optional
        Red, green, blue.
    normals : array_like, shape (N, 3), float32, optional
        Outward unit normals.

    Raises
    ------
    BelvedereError
        Without points, for coordinates that are not finite or in degrees, and for attributes of another length.

    Examples
    --------
    >>> import numpy as np
    >>> rng = np.random.default_rng(1)
    >>> xyz = np.column_stack([rng.uniform(0, 20, (500, 2)), np.zeros(500)])
    >>> belvedere.Cloud(xyz, crs="EPSG:28992", classification=np.full(500, 2))
    <belvedere.Cloud: 500 points, EPSG:28992 (Amersfoort / RD New), metres; classification>
    """

    def __init__(
        self,
        xyz: Places,
        *,
        crs: System | None = None,
        classification: Numbers | None = None,
        gps_time: Numbers | None = None,
        adjusted_gps_time: bool = False,
        return_number: Numbers | None = None,
        return_count: Numbers | None = None,
        scan_angle: Numbers | None = None,
        point_source_id: Numbers | None = None,
        scanner_channel: Numbers | None = None,
        flags: Numbers | None = None,
        intensity: Numbers | None = None,
        color: Numbers | None = None,
        normals: Numbers | None = None,
    ) -> None:
        rows = places(xyz, "xyz")
        given = {
            "classification": classification,
            "gps_time": gps_time,
            "return_number": return_number,
            "return_count": return_count,
            "scan_angle": scan_angle,
            "point_source_id": point_source_id,
            "scanner_channel": scanner_channel,
            "flags": flags,
            "intensity": intensity,
            "color": color,
            "normals": normals,
        }
        columns = {name: _column(name, values, len(rows)) for name, values in given.items() if values is not None}
        system = None if crs is None else _core.Crs(system_text(crs))
        self._core = _core.Cloud(rows, columns, adjusted_gps_time, system)
        #: What reading the cloud found; empty for a cloud from arrays.
        self.report: dict[str, Any] = {}

    @classmethod
    def _of(cls, core: _core.Cloud, report: dict[str, Any]) -> Cloud:
        cloud = cls.__new__(cls)
        cloud._core = core
        cloud.report = report
        return cloud

    @property
    def xyz(self) -> npt.NDArray[np.float64]:
        """Coordinates in the unit of the file, shape (N, 3).

        Examples
        --------
        >>> cloud.xyz.shape == (len(cloud), 3)
        True
        """
        return self._core.xyz

    @property
    def attributes(self) -> dict[str, npt.NDArray[Any]]:
        """The attributes that the cloud has, by name, as copies.

        Examples
        --------
        >>> cloud.attributes["classification"].dtype
        dtype('uint8')
        """
        return self._core.attributes

    @property
    def crs(self) -> str | None:
        """The coordinate reference system as well-known text or ``EPSG:CODE``; None where it is not known.

        Examples
        --------
        >>> "Amersfoort" in cloud.crs
        True
        """
        return self._core.crs.text

    @property
    def bounds(self) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
        """Lowest and highest corner in the coordinates of the file.

        Examples
        --------
        >>> low, high = cloud.bounds
        >>> bool((low <= high).all())
        True
        """
        low, high = self._core.bounds
        return np.array(low), np.array(high)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the cloud; the extension selects the format: ``.laz .las .ply .csv .xyz .txt``.

        A ``.laz`` or ``.las`` file of points that were read from such files keeps all that these have: extra bytes,
        further fields, records of the header, point format and steps of coordinates.

        Warns
        -----
        BelvedereWarning
            Of what the file cannot hold.

        Examples
        --------
        >>> cloud.save(folder / "cloud.laz")
        >>> len(belvedere.read(folder / "cloud.laz")) == len(cloud)
        True
        """
        warned(self._core.write(os.fspath(path)))

    def __len__(self) -> int:
        return len(self._core)

    def __array__(self, dtype: npt.DTypeLike | None = None, copy: bool | None = None) -> npt.NDArray[Any]:
        if copy is False:
            raise ValueError("the coordinates of a Cloud are computed, and cannot be given without a copy")
        return self.xyz.astype(np.float64 if dtype is None else dtype, copy=False)

    def __repr__(self) -> str:
        names = ", ".join(sorted(self.attributes)) or "no attributes"
        return f"<belvedere.Cloud: {len(self)} points, {self._core.crs.description}; {names}>"

    def __reduce__(self) -> tuple[Any, ...]:
        core = self._core
        state = (
            core.origin,
            core.positions,
            core.attributes,
            core.adjusted_gps_time,
            (core.scanner_positions, core.sky_regions),
            core.crs.state,
            core.files,
        )
        return _unpickled, (state, self.report)


def read(
    source: Source | list[Source],
    *,
    crs: System | None = None,
    crs_override: bool = False,
    up: Up = "z",
    skip_distant: bool = False,
    name: str | None = None,
    bounds: Numbers | None = None,
    classes: Iterable[int] | None = None,
    flown: datetime.date | str | None = None,
    progress: Progress = None,
) -> Cloud:
    """Reads a point cloud, or the points of it in a box.

    Parameters
    ----------
    source : path, bytes, binary file, laspy object, or a list of these
        ``.las .laz .copc.laz .ply .xyz .txt .csv .pts .asc .pcd .e57 .ptx .npy ept.json``, or a folder of them.
        Several become one cloud.
    crs : str, int or object of pyproj, optional
        Coordinate reference system of files that name none, such as ``"EPSG:28992"``. One that contradicts a file, or
        whose area of use is more than 300 km away, is refused.
    crs_override : bool
        Use `crs` whatever the files and the coordinates say.
    up : {'z', 'y'}
        Which axis of the file is up.
    skip_distant : bool
        Leave out files whose points all lie more than 1000 km from those of the others, which is an error otherwise.
    name : str, optional
        Name of bytes or of a file without a name, such as ``"tile.laz"``; its extension selects the format.
    bounds : array_like, (4,), (2, 2) or (2, 3), optional
        West, south, east and north of a box in the coordinates and unit of the file, as shapely, geopandas and rasters
        have them, or its lowest and highest corner. Only points in it are read, and only
        the files that meet it; of a COPC file only the parts that do, also where it is an address (``https://…``) or an
        open file on a server (``fsspec``).
    classes : iterable of int, optional
        Only points of these ASPRS classes are read.
    flown : datetime.date or str, optional
        Day of the flight, such as ``"2014-02-03"``, for LAS files whose GPS times are seconds of a week. It tells the
        leaves of crowns that pulses measured.
    progress : bool or callable, optional
        True shows a bar; a function is called with stage, items done and items in all, and stops the work by raising.

    Returns
    -------
    Cloud
        Feet become metres for all work, and feet again in results.

    Raises
    ------
    BelvedereError
        For a format that is not known, a damaged file, a file without points, coordinates in degrees, and a `crs` that
        contradicts a file.
    FileNotFoundError
        For a file that is missing.

    Warns
    -----
    BelvedereWarning
        Of points that were left out and of what is odd about a file.

    Examples
    --------
    >>> belvedere.read(tile)
    <belvedere.Cloud: ... points, EPSG:7415 (Amersfoort / RD New + NAP height), metres; ...>
    >>> with open(tile, "rb") as file:
    ...     again = belvedere.read(file)
    """
    sources = source if isinstance(source, (list, tuple)) else [source]
    if not sources:
        raise wrong("source", "an empty list", "give at least one file")
    box = None if bounds is None else map_box(bounds, "bounds")
    wanted = None if classes is None else class_numbers(classes)
    inputs = [native_source(one, name, in_parts=box is not None) for one in sources]
    options = (None if crs is None else system_text(crs), bool(crs_override), up, bool(skip_distant))
    day = None if flown is None else str(flown)[:10]
    core, text = _core.read(inputs, *options, box, wanted, day, reporter(progress))
    return cloud_of(core, json.loads(text))


def cloud_of(core: _core.Cloud, report: dict[str, Any]) -> Cloud:
    """A cloud that was read, with warnings of what is lost or odd."""
    for note in _notes(report):
        _warn(note)
    return Cloud._of(core, report)


def _notes(report: dict[str, Any]) -> list[str]:
    """What a report on reading says is lost or odd."""
    # what `bounds` and `classes` leave out is what the caller wants
    wanted = ("outside the box to read", "of a class that is not read")
    found = [f"points left out: {reason}" for reason in report.get("left_out", []) if not reason.endswith(wanted)]
    lost = report.get("attributes_not_in_every_file", [])
    if lost:
        found.append(f"attributes that only some of the files have are left out: {', '.join(lost)}")
    return found + list(report.get("contradictions", [])) + list(report.get("notes", []))


def _warn(text: str) -> None:
    warnings.warn(text, BelvedereWarning)


def _column(name: str, values: Numbers, count: int) -> npt.NDArray[Any]:
    kind, columns = ATTRIBUTES[name]
    shape = (count, columns) if columns else (count,)
    try:
        array = np.asarray(values)
    except (TypeError, ValueError):
        raise wrong(name, f"a {type(values).__name__}", f"give an array of shape {shape}") from None
    if array.shape != shape:
        raise wrong(name, f"an array of shape {array.shape}", f"give one of shape {shape}, a row for each point")
    if array.dtype.kind not in "iufb":
        raise wrong(name, f"an array of {array.dtype}", f"give numbers that fit {np.dtype(kind).name}")
    converted = array.astype(kind, copy=False)
    if np.dtype(kind).kind == "u" and not np.array_equal(converted, array):
        raise wrong(name, "out of range", f"give whole numbers that fit {np.dtype(kind).name}")
    return converted


def _unpickled(state: tuple[Any, Any, Any, bool, Any, Any, Any], report: dict[str, Any]) -> Cloud:
    origin, positions, attributes, adjusted, scanners, system, files = state
    crs = _core.Crs.from_state(system)
    return Cloud._of(_core.Cloud.from_state(origin, positions, attributes, adjusted, scanners, crs, files), report)
