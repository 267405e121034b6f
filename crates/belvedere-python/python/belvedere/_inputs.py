"""From what users give to what the native part takes."""

from __future__ import annotations

import datetime
import operator
import os
import sys
from collections.abc import Callable, Iterable, Sequence
from numbers import Integral, Real
from typing import Any

import numpy as np
import numpy.typing as npt

from ._errors import wrong
from ._shapes import columns_of, in_system, is_table
from ._types import Columns, Day, Location, Places, Progress, Source, System, Time, Zone


def native_source(source: Source, name: str | None, *, in_parts: bool = False) -> object:
    """A path, or a pair of a name and bytes; with `in_parts`, of a name and a file that can be read from any place."""
    if isinstance(source, (bytes, bytearray, memoryview)):
        if name is None:
            raise wrong("name", "missing", "bytes have no name: give name='tile.laz', whose extension says the format")
        return name, bytes(source)
    if isinstance(source, (str, os.PathLike)):
        return os.fspath(source)
    if hasattr(source, "point_format") and hasattr(source, "write"):
        import io

        buffer = io.BytesIO()
        writer: Any = source
        writer.write(buffer, do_compress=False)
        return "laspy.las", buffer.getvalue()
    if hasattr(source, "read"):
        reads_parts = in_parts and hasattr(source, "seekable") and source.seekable()
        content = source.read(0 if reads_parts else -1)
        if not isinstance(content, bytes):
            raise wrong("source", "a file in text mode", "open it in binary mode: open(path, 'rb')")
        # files of fsspec have a path in place of a name
        names = (name, getattr(source, "name", None), getattr(source, "path", None))
        given = next((text for text in names if isinstance(text, str)), None)
        if given is None:
            raise wrong(
                "name", "missing", "this file has no name: give name='tile.laz', whose extension says the format"
            )
        return given, source if reads_parts else content
    raise wrong("source", f"a {type(source).__name__}", "give a path, bytes, a binary file, or an object of laspy")


def map_box(value: object, what: str) -> list[list[float]]:
    """Lowest and highest corner of a box, whose heights may be left out."""
    advice = (
        "give west, south, east and north, or the lowest and the highest corner: [(x, y), (x, y)], "
        "or with heights [(x, y, z), (x, y, z)]"
    )
    try:
        corners = np.asarray(value, np.float64)
    except (TypeError, ValueError):
        raise wrong(what, repr(value), advice) from None
    if corners.shape == (4,):
        corners = corners.reshape(2, 2)
    if corners.shape not in ((2, 2), (2, 3)) or not np.isfinite(corners).all() or (corners[0] > corners[1]).any():
        raise wrong(what, repr(value), advice)
    everywhere = [-np.finfo(np.float64).max, np.finfo(np.float64).max]
    return [[*corner, height][:3] for corner, height in zip(corners.tolist(), everywhere, strict=True)]


def class_numbers(value: Iterable[int]) -> list[int]:
    """ASPRS classes."""
    advice = "give numbers from 0 to 255, such as [2, 6] for ground and buildings"
    try:
        numbers = [operator.index(number) for number in value]
    except TypeError:
        raise wrong("classes", repr(value), advice) from None
    if not numbers or not all(0 <= number <= 255 for number in numbers):
        raise wrong("classes", repr(value), advice)
    return numbers


def place(value: object, what: str) -> tuple[float, float, float]:
    """Three finite numbers."""
    try:
        array = np.asarray(in_system(value, what), np.float64)
    except (TypeError, ValueError):
        raise wrong(what, repr(value), "give three numbers: x, y, z") from None
    if array.shape == (1, 3):
        array = array[0]
    if array.shape != (3,) or not np.isfinite(array).all():
        raise wrong(what, repr(value), "give three finite numbers: x, y, z")
    return float(array[0]), float(array[1]), float(array[2])


def places(value: Places, what: str, crs: str | None = None) -> npt.NDArray[Any]:
    """Rows of three numbers, 32 or 64 bit, without a copy where they are that already."""
    if isinstance(value, (str, os.PathLike)):
        raise wrong(what, repr(value), "read the file first, such as with geopandas.read_file or belvedere.Mesh.read")
    value = in_system(value, what, crs)
    try:
        array = np.asarray(value)
        if array.dtype not in (np.float32, np.float64):
            if array.dtype.kind not in "iufb":
                raise TypeError
            array = array.astype(np.float64)
    except (TypeError, ValueError):
        raise wrong(what, f"a {type(value).__name__}", "give numbers of shape (N, 3)") from None
    if array.ndim != 2 or array.shape[1] != 3:
        raise wrong(what, f"an array of shape {array.shape}", "give x, y and z in three columns, shape (N, 3)")
    return array


def map_places(
    value: Places, what: str, advice: str, least: int = 1, crs: str | None = None
) -> npt.NDArray[np.float64]:
    """Rows of x, y, z from one place or rows of x, y and perhaps z, which is NaN where it follows from the ground.
    Points of geopandas come into the system `crs`.
    """
    value = in_system(value, what, crs)
    try:
        array = np.asarray(value, np.float64)
    except (TypeError, ValueError):
        raise wrong(what, repr(value), advice) from None
    if array.ndim == 1:
        array = array[np.newaxis]
    if array.ndim != 2 or array.shape[1] not in (2, 3) or len(array) < least:
        raise wrong(what, f"an array of shape {array.shape}", advice)
    if not np.isfinite(array).all():
        raise wrong(what, "not finite", "leave z out where it is not known")
    if array.shape[1] == 2:
        array = np.column_stack([array, np.full(len(array), np.nan)])
    return np.ascontiguousarray(array)


def pairs_of(
    observer: Places, target: Places, crs: str | None
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """Rows of x, y, z of both ends of lines; a single observer has all targets, and the other way round."""
    advice = "give x and y, or x, y and z: shape (2,), (3,), (N, 2) or (N, 3)"
    observers = map_places(observer, "observer", advice, 0, crs)
    targets = map_places(target, "target", advice, 0, crs)
    if len(observers) == 1 and len(targets) > 1:
        observers = np.broadcast_to(observers, targets.shape)
    elif len(targets) == 1 and len(observers) > 1:
        targets = np.broadcast_to(targets, observers.shape)
    return observers, targets


def table_columns(
    table: Columns, what: str, known: Sequence[str], required: Sequence[str], words: Sequence[str] = ()
) -> dict[str, npt.NDArray[Any]]:
    """Columns of a table of places, all of one length: those that are known, with those that are required. All but
    `words` are numbers.
    """
    needs = f"give {', '.join(required[:-1])} and {required[-1]}"
    if not is_table(table):
        raise wrong(what, f"a {type(table).__name__}", f"{needs} by name: a dictionary or a DataFrame")
    columns = columns_of(table)
    unknown = [name for name in columns if name not in known]
    if unknown:
        raise wrong(what, f"a table with a column '{unknown[0]}'", f"use {', '.join(known)}")
    missing = [name for name in required if name not in columns]
    if missing:
        raise wrong(what, f"without {', '.join(missing)}", needs)
    count = len(columns[required[0]])
    if {column.shape for column in columns.values()} != {(count,)} or not count:
        raise wrong(what, "columns of different lengths, or empty", "give a value for each row")
    for name, column in columns.items():
        if name not in words:
            try:
                columns[name] = column.astype(np.float64)
            except (TypeError, ValueError):
                raise wrong(what, f"{name} of {column[0]!r}", f"give numbers for {name}") from None
    return columns


def location_pair(location: Location | None) -> tuple[float, float] | None:
    """Latitude and longitude, degrees."""
    where = "give latitude and longitude in degrees, such as (52.0, 4.4)"
    site: Any = location
    if hasattr(site, "latitude") and hasattr(site, "longitude"):
        site = (site.latitude, site.longitude)
    return None if site is None else number_pair(site, "location", where)


def system_text(crs: System) -> str:
    """A coordinate reference system as text."""
    if isinstance(crs, (int, np.integer)) and not isinstance(crs, bool):
        return f"EPSG:{crs}"
    if hasattr(crs, "to_wkt"):
        return crs.to_wkt()
    if not isinstance(crs, str):
        raise wrong("crs", repr(crs), "give a text such as 'EPSG:28992', its number, or an object of pyproj")
    return crs


def path_text(path: object, what: str) -> str:
    """A path as text."""
    if not isinstance(path, (str, os.PathLike)):
        raise wrong(what, f"a {type(path).__name__}", "give the path of a file")
    return os.fspath(path)


def time_text(time: Time, what: str = "time") -> str:
    """ISO 8601; without an offset it is on the clocks of the place."""
    if isinstance(time, str):
        if "T" not in time.strip().upper().replace(" ", "T"):
            advice = "give day and time, such as 2026-06-21T15:00 on the clocks of the place, or 2026-06-21T15:00+02:00"
            raise wrong(what, repr(time), advice)
        return time
    if isinstance(time, datetime.datetime):
        if time != time:
            raise wrong(what, time, "it is no time; leave it out")
        if time.tzinfo is None or time.utcoffset() is None:
            raise wrong(
                what,
                time.isoformat(),
                "it has no time zone, so the instant is not known; give one, such as "
                "datetime(2026, 6, 21, 15, tzinfo=ZoneInfo('Europe/Amsterdam'))",
            )
        return time.isoformat()
    if isinstance(time, np.datetime64):
        raise wrong(what, time, "numpy times have no time zone; use datetime or pandas with one, such as tz='UTC'")
    raise wrong(what, repr(time), "give a datetime with a time zone")


def times(value: Time | Iterable[Time], what: str = "time") -> tuple[list[str], bool]:
    """Times as text, and whether one time was given rather than several."""
    if isinstance(value, (str, datetime.datetime, np.datetime64)):
        return [time_text(value, what)], True
    try:
        texts = [time_text(one, what) for one in value]
    except TypeError:
        raise wrong(what, repr(value), "give a datetime with a time zone, or several") from None
    if not texts:
        raise wrong(what, "empty", "give at least one")
    return texts, False


def day_text(day: Day, what: str = "date") -> str:
    """A day as text."""
    if isinstance(day, str):
        return day
    if isinstance(day, datetime.datetime):
        # days of pandas are midnights
        if day.time() == datetime.time():
            return day.date().isoformat()
        raise wrong(what, day.isoformat(), "give a day without a time, such as datetime.date(2026, 6, 21)")
    if isinstance(day, datetime.date):
        return day.isoformat()
    if isinstance(day, np.datetime64):
        return str(day.astype("datetime64[D]"))
    raise wrong(what, repr(day), "give a day, such as datetime.date(2026, 6, 21) or '2026-06-21'")


def day_texts(value: Day | Iterable[Day]) -> list[str]:
    """Days as text."""
    if isinstance(value, (str, datetime.date, np.datetime64)):
        return [day_text(value)]
    try:
        texts = [day_text(one) for one in value]
    except TypeError:
        raise wrong("date", repr(value), "give a day, such as datetime.date(2026, 6, 21), or several") from None
    if not texts:
        raise wrong("date", "empty", "give at least one day")
    return texts


def moments(value: object) -> list[str]:
    """Two days, or two times."""
    if not isinstance(value, (tuple, list)) or len(value) != 2:
        raise wrong("period", repr(value), "give its first and its last day, or two times")
    return [
        time_text(one, "period") if isinstance(one, datetime.datetime) else day_text(one, "period") for one in value
    ]


def zone_text(zone: Zone | None) -> str | None:
    """The name of a time zone."""
    if zone is None or isinstance(zone, str):
        return zone
    key = getattr(zone, "key", None) or getattr(zone, "zone", None)
    if isinstance(key, str):
        return key
    offset = zone.utcoffset(None) if isinstance(zone, datetime.tzinfo) else None
    if offset is None:
        raise wrong("zone", repr(zone), "give a name such as 'Europe/Amsterdam'")
    minutes = int(offset.total_seconds() // 60)
    return f"{'-' if minutes < 0 else '+'}{abs(minutes) // 60:02}:{abs(minutes) % 60:02}"


def check_whole(**values: object) -> None:
    """Refuses what should be a whole number and is none."""
    for name, value in values.items():
        if value is not None and (isinstance(value, bool) or not isinstance(value, Integral)):
            raise wrong(name, repr(value), "give a whole number")


def number_pair(value: object, what: str, advice: str) -> tuple[float, float]:
    """Two finite numbers."""
    try:
        array = np.asarray(value, np.float64)
    except (TypeError, ValueError):
        raise wrong(what, repr(value), advice) from None
    if array.shape != (2,) or not np.isfinite(array).all():
        raise wrong(what, repr(value), advice)
    return float(array[0]), float(array[1])


#: Heights above the ground, below which nothing can be seen.
_HEIGHTS = frozenset(["observer_height", "target_height", "camera_height", "fence_height"])


def check_finite(**values: float | None) -> None:
    """Refuses numbers that are none, and heights below the ground."""
    for name, value in values.items():
        if value is None:
            continue
        if not isinstance(value, Real):
            raise wrong(name, repr(value), "give a number")
        if not np.isfinite(value):
            raise wrong(name, value, "give a finite number")
        if name in _HEIGHTS and value < 0:
            raise wrong(name, value, "give a height above the ground of 0 metres or more")


def reporter(progress: Progress) -> Callable[[str, int, int], object] | None:
    """What the native part calls with the progress."""
    if progress is None or progress is False:
        return None
    if progress is True:
        return _bar()
    if callable(progress):
        return progress
    raise wrong("progress", repr(progress), "give True, None, or a function of stage, done and total")


def _bar() -> Callable[[str, int, int], object]:
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return _lines()
    bars: list[Any] = []

    def show(stage: str, done: int, total: int) -> None:
        if not bars or bars[-1].desc != stage:
            if bars:
                bars[-1].close()
            bars.append(tqdm(desc=stage, total=total or None))
        bars[-1].update(done - bars[-1].n)

    return show


def _lines() -> Callable[[str, int, int], object]:
    last = [""]

    def show(stage: str, done: int, total: int) -> None:
        if stage != last[0]:
            last[0] = stage
            print(f"belvedere: {stage}", file=sys.stderr)

    return show


def as_list(value: str | Sequence[str]) -> list[str]:
    """One text, or several."""
    return [value] if isinstance(value, str) else list(value)
