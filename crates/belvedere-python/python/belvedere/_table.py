"""Columns of values."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ._errors import missing, no_attribute, wrong
from ._remarks import Remark

if TYPE_CHECKING:
    import geopandas
    import pandas


class Table(dict[str, "npt.NDArray[Any]"]):
    """Columns of values, a row for each target.

    It is a dictionary of its columns, which `pandas.DataFrame`, `polars.DataFrame` and `pyarrow.table` take as it is. A
    column of two dimensions, such as places of shape (N, 3), is also found by its own name, and listed as one column
    for each of its own: ``place_x``.

    Attributes
    ----------
    crs : str or None
        Coordinate reference system of the places.
    places : ndarray, shape (N, 3), or None
        Where the rows lie, in the coordinates of the file.
    panoramas : list of ndarray
        Of an isovist: ranges in metres for each observer that looks, infinite where nothing blocks. Columns run
        clockwise from south over west, north and east, rows from the zenith down.
    remarks : tuple of Remark
        What to know of the rows.
    objects : Table or None
        Of the faces of a mesh: the same for each of its objects, or for the whole mesh where it has none.
    buildings : Table or None
        Of the planes of roofs: sums of each building.
    hours : list of Table
        Of the planes of roofs: radiation, losses and electricity of each, hour by hour.

    Examples
    --------
    >>> sights = scene.line_of_sight(eye, targets)
    >>> sights["answer"].dtype
    dtype('uint8')
    >>> len(sights.to_pandas()) == sights.row_count
    True
    """

    def __init__(
        self,
        columns: Mapping[str, npt.NDArray[Any]],
        *,
        places: npt.NDArray[np.float64] | None = None,
        crs: str | None = None,
        panoramas: list[npt.NDArray[np.float32]] | None = None,
        objects: Table | None = None,
    ) -> None:
        lengths = {len(values) for values in columns.values()}
        if len(lengths) > 1:
            raise wrong("columns", f"of {sorted(lengths)} rows", "give columns of one length")
        super().__init__(_flat(columns))
        self._wide = {name: values for name, values in columns.items() if values.ndim > 1}
        self._count = lengths.pop() if lengths else 0
        self.places = places
        self.crs = crs
        self.panoramas = [] if panoramas is None else panoramas
        self.objects = objects
        self.buildings: Table | None = None
        self.hours: list[Table] = []
        self.remarks: tuple[Remark, ...] = ()

    def __getitem__(self, name: str, /) -> npt.NDArray[Any]:
        if not isinstance(name, str):
            raise TypeError("a Table has columns by name; rows are those of a column or of to_pandas()")
        return super().__getitem__(name)

    def __missing__(self, name: str) -> npt.NDArray[Any]:
        if name not in self._wide:
            raise KeyError(f"no column {name!r}; use {', '.join([*self, *self._wide])}")
        return self._wide[name]

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            if name.startswith("_"):
                raise AttributeError(name)
            raise no_attribute(self, name, self)

    def __contains__(self, name: object) -> bool:
        return super().__contains__(name) or name in self._wide

    def __eq__(self, other: object) -> bool:
        raise TypeError("a Table is not compared as a whole; take a column by name, or use to_pandas()")

    def __array__(self, dtype: npt.DTypeLike | None = None, copy: bool | None = None) -> npt.NDArray[Any]:
        raise TypeError("a Table is no array; take a column by name, or use to_pandas()")

    @property
    def row_count(self) -> int:
        """Number of rows.

        Examples
        --------
        >>> scene.line_of_sight(eye, targets).row_count == len(targets)
        True
        """
        return self._count

    def to_pandas(self) -> pandas.DataFrame:
        """A `pandas.DataFrame`.

        Examples
        --------
        >>> scene.line_of_sight(eye, targets).to_pandas().columns[:2].tolist()
        ['answer', 'first_block_range_m']
        """
        try:
            import pandas
        except ImportError:
            raise missing("pandas", "to_pandas") from None
        return pandas.DataFrame(dict(self))

    def to_geodataframe(self) -> geopandas.GeoDataFrame:
        """A `geopandas.GeoDataFrame` of points.

        Examples
        --------
        >>> scene.line_of_sight(eye, targets).to_geodataframe().crs.name
        'Amersfoort / RD New + NAP height'
        """
        try:
            import geopandas
        except ImportError:
            raise missing("geopandas", "to_geodataframe") from None
        if self.places is None:
            raise wrong("places", "missing", "these rows lie nowhere on the map; use to_pandas")
        points = geopandas.points_from_xy(self.places[:, 0], self.places[:, 1], self.places[:, 2])
        return geopandas.GeoDataFrame(dict(self), geometry=points, crs=self.crs)

    def __repr__(self) -> str:
        return f"<belvedere.Table: {self._count} rows of {', '.join(self)}>"

    def _repr_html_(self) -> str:
        try:
            return str(self.to_pandas().to_html(max_rows=10))
        except ValueError:
            return f"<pre>{self!r}</pre>".replace("<belvedere", "&lt;belvedere")


def _flat(columns: Mapping[str, npt.NDArray[Any]]) -> dict[str, npt.NDArray[Any]]:
    """The columns, each of several dimensions as several."""
    flat: dict[str, npt.NDArray[Any]] = {}
    for name, values in columns.items():
        if values.ndim == 1:
            flat[name] = values
        else:
            names = ("x", "y", "z") if values.shape[1] == 3 else tuple(map(str, range(values.shape[1])))
            flat |= {f"{name}_{part}": values[:, i] for i, part in enumerate(names)}
    return flat
