"""Types of what users give: arrays, objects of other packages, and words."""

from __future__ import annotations

import datetime
import os
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal, Protocol, SupportsFloat, Union

import numpy as np
import numpy.typing as npt


class _File(Protocol):
    """A file that is open for reading in binary mode."""

    def read(self, size: int = ..., /) -> bytes: ...


class _Laspy(Protocol):
    """Points of laspy."""

    @property
    def point_format(self) -> Any: ...
    @property
    def write(self) -> Any: ...


class _Array(Protocol):
    """An array, also of other packages."""

    def __array__(self) -> npt.NDArray[Any]: ...


class _Shapes(Protocol):
    """A geometry of shapely, or a series or frame of geopandas."""

    @property
    def __geo_interface__(self) -> Any: ...


class _Frame(Protocol):
    """A table of pandas, polars or pyarrow."""

    @property
    def columns(self) -> Any: ...
    def __getitem__(self, name: Any, /) -> Any: ...


class _Site(Protocol):
    """A location of pvlib."""

    @property
    def latitude(self) -> Any: ...
    @property
    def longitude(self) -> Any: ...


class _System(Protocol):
    """A reference system of pyproj or rasterio."""

    def to_wkt(self) -> str: ...


#: A path, bytes, a file that is open for reading in binary mode, or an object of laspy.
Source = Union[str, "os.PathLike[str]", bytes, _File, _Laspy]
#: An instant: a `datetime` or a pandas `Timestamp` with a time zone, or ISO 8601 text, which is on the clocks of the
#: place where it has no offset.
Time = Union[datetime.datetime, str]
#: A day: a `date`, a midnight of pandas, a day of NumPy, or ISO 8601 text.
Day = Union[datetime.date, np.datetime64, str]
#: First and last day, or begin and end.
Period = tuple[Union[Day, Time], Union[Day, Time]]
#: The name of a time zone, or a zone of `zoneinfo` and other packages.
Zone = Union[str, datetime.tzinfo]
#: Called with the name of the stage, the items that are done, and their number (0 where it is not known).
Progress = Union[bool, Callable[[str, int, int], object], None]
#: Numbers in one row, or in rows.
Numbers = Union[_Array, Sequence[SupportsFloat], Sequence[Sequence[SupportsFloat]], Sequence[_Array]]
#: Columns of a table, by name.
Columns = Union[Mapping[str, npt.ArrayLike], _Frame]
#: One place or rows of places in the coordinates of the cloud's file, columns x, y and perhaps z, or objects of shapely
#: or geopandas.
Places = Union[Numbers, _Shapes, Sequence[_Shapes], Columns]
#: Where stations and cameras may stand: anywhere on the ground, on roofs, or at places.
Candidates = Union[Literal["ground", "roofs"], Places]
#: One place: x, y and perhaps z.
Place = Union[tuple[float, float], tuple[float, float, float], list[float]]
#: Rows of places.
PlaceRows = Sequence[Place]
#: A polygon of shapely or geopandas, corners (x, y), or the corners of an outline and its holes.
Polygon = Union[Numbers, _Shapes, Sequence[Sequence[Sequence[SupportsFloat]]]]
#: Latitude and longitude, degrees, or a location of pvlib.
Location = Union[Numbers, _Site]
#: A coordinate reference system: EPSG code, text, or an object of pyproj or rasterio.
System = Union[str, int, _System]

#: Azimuth and elevation, degrees.
Direction = Union[tuple[float, float], list[float]]

Body = Literal["standing", "sitting", "round"]
ClearSky = Literal["ineichen", "haurwitz", "bird"]
CarvingRule = Literal[
    "smoothing",
    "vegetation",
    "crowns",
    "slender",
    "thin-surfaces",
    "roof-edges",
    "data-voids",
    "relief",
    "pruning",
    "planes",
]
Curvature = Literal["auto", "on", "off"]
Density = Union[Literal["monitor", "detect", "observe", "recognise", "identify", "none"], float]
Device = Union[Literal["auto", "cpu", "gpu"], int]
Facing = Literal["normals", "level"]
Ground = Literal["auto", "class", "found"]
GroundCover = Literal["paved", "asphalt", "grass", "soil"]
Kind = Literal["vegetation", "water", "building", "ground", "other"]
Language = Literal["en", "nl", "de", "fr"]
Leaves = Literal["auto", "on", "off"]
Method = Literal["carved", "tau", "angles"]
Orient = Literal["auto", "pulses", "scanner", "given", "up"]
Patches = Literal["tregenza", "reinhart"]
SkyModel = Literal["patches", "perez", "hay-davies", "isotropic"]
Study = Literal["ceqr", "san-francisco", "toronto"]
SunElevation = Literal["apparent", "geometric"]
Surroundings = Literal["dark", "like-ground"]
ThroughTrees = Union[Literal["measured", "none", "seasons", "pulses"], float]
Town = Literal["town", "village", "old-town", "towers", "park"]
Trees = Literal["measured", "opaque", "porous"]
Unproven = Literal["report", "as-visible", "as-blocked"]
Up = Literal["z", "y"]
