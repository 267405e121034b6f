"""Grids of values on the map."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, SupportsIndex, Union, overload

import numpy as np
import numpy.typing as npt

from . import _core
from ._errors import missing, no_attribute, wrong
from ._inputs import map_places
from ._remarks import Remark
from ._types import Places
from ._xarray import array_of, stack_of

if TYPE_CHECKING:
    import matplotlib.axes
    import xarray


#: What rasters are computed with.
Operand = Union["Raster", npt.NDArray[Any], np.generic, float]


class Raster(np.lib.mixins.NDArrayOperatorsMixin):
    """A grid of values on the map, rows from the north.

    Comparisons, arithmetic and the elementwise functions of NumPy work cell by cell and give rasters on the same grid;
    the other operand is a number, an array or a raster on that grid. In all of them, in `numpy.asarray`, and in `mean`,
    `sum`, `min`, `max`, `std` and `var` with their functions of NumPy, a cell without a value is NaN; the latter leave
    such cells out. `values` has the numbers as they are.

    Attributes
    ----------
    values : ndarray, shape (height, width)
        float32 with NaN, or unsigned integers with `nodata`, where there is no value.
    transform : tuple of 6 floats
        Affine transform from columns and rows to coordinates, in the order of `affine.Affine` and rasterio:
        ``x = a * column + b * row + c``, ``y = d * column + e * row + f``.
    nodata : float or None
        The value where there is none; NaN for float32.
    name, description : str
        What the values are.
    unit : str
        Unit of the values, such as ``h``; ``1`` for shares, counts and answers, empty where it is not known.
    tags : dict of str to str
        Further metadata, such as ``TIME``, ``TIME_ZONE`` and ``SUN_ELEVATION_DEG`` of a shadow.
    unproven : Raster or None
        Where proof was tested: 1 where nothing blocks but no laser pulse proves it, 0 where it is proven or blocked. Of
        several observers: for how many of those in `values` the view is not proven. It is the second band of files.
    probability : Raster or None
        How likely the target is visible or lit, 0 to 1, where that was wanted; of several observers the expected number
        that see it.
    uncertain : Raster or None
        1 where the answer is less certain than wanted, or unproven; of several observers for how many that is so.
    caster : Raster or None
        What casts the shadow, by number, from `Scene.shadow` with `casters`.
    remarks : tuple of Remark
        What to know of the values.

    Examples
    --------
    >>> lit = scene.shadow(sun=(180, 30))
    >>> lit
    <belvedere.Raster 'lit': ... rows x ... columns of 0.5 m, EPSG:7415 (Amersfoort / RD New + NAP height), metres>
    >>> bool(0 <= np.mean(lit) <= 1)
    True
    >>> int((lit == 1).sum()) <= lit.values.size
    True
    """

    def __init__(
        self,
        values: npt.NDArray[Any],
        transform: tuple[float, float, float, float, float, float],
        crs: _core.Crs,
        *,
        nodata: float | None = None,
        name: str = "",
        description: str = "",
        unproven: Raster | None = None,
        is_answer: bool = False,
        unit: str = "",
    ) -> None:
        self.values = values
        self.transform = transform
        self.nodata = nodata
        self.name = name
        self.description = description
        self.unit = unit
        self.tags: dict[str, str] = {}
        self.unproven = unproven
        self.probability: Raster | None = None
        self.uncertain: Raster | None = None
        self.caster: Raster | None = None
        self.remarks: tuple[Remark, ...] = ()
        self._is_answer = is_answer
        self._crs = crs

    @property
    def crs(self) -> str | None:
        """The coordinate reference system as well-known text or ``EPSG:CODE``; None where it is not known."""
        return self._crs.text

    @property
    def shape(self) -> tuple[int, int]:
        """Number of rows and columns."""
        rows, columns = self.values.shape
        return rows, columns

    @property
    def dtype(self) -> np.dtype[Any]:
        """Type of the values."""
        return self.values.dtype

    @property
    def ndim(self) -> int:
        """Number of dimensions: 2."""
        return self.values.ndim

    @property
    def size(self) -> int:
        """Number of cells."""
        return self.values.size

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """West, south, east and north in the coordinates of the file.

        Examples
        --------
        >>> west, south, east, north = scene.shadow(sun=(180, 30)).bounds
        >>> west < east and south < north
        True
        """
        a, _, west, _, e, north = self.transform
        rows, columns = self.shape
        return west, north + e * rows, west + a * columns, north

    @property
    def x(self) -> npt.NDArray[np.float64]:
        """East coordinates of the middles of the columns."""
        a, _, west, *_ = self.transform
        return np.asarray(west + a * (np.arange(self.shape[1]) + 0.5), np.float64)

    @property
    def y(self) -> npt.NDArray[np.float64]:
        """North coordinates of the middles of the rows, from the north."""
        *_, e, north = self.transform
        return np.asarray(north + e * (np.arange(self.shape[0]) + 0.5), np.float64)

    def to_geotiff(self, path: str | os.PathLike[str]) -> None:
        """Writes a GeoTIFF, as the command line does: -9999 where a float raster has no value, and answers as bytes
        with 255. `unproven`, `probability`, `uncertain` and `caster` are further bands; with numbers among them all
        are float. GDAL reads names, units and tags of the bands.

        Examples
        --------
        >>> scene.shadow(sun=(180, 30)).to_geotiff(folder / "shadow.tif")
        """
        if not os.fspath(path).lower().endswith((".tif", ".tiff")):
            raise wrong("path", repr(path), "a GeoTIFF is a file .tif; to_xarray() writes other formats")
        further = [self.unproven, self.probability, self.uncertain, self.caster]
        rasters = [self, *(raster for raster in further if raster is not None)]
        bands = [raster._pixels() for raster in rasters]
        if len({band.dtype for band in bands}) > 1:
            bands = [_numbers(raster) for raster in rasters]
        labels = [(raster.name, raster.unit, list(raster.tags.items())) for raster in rasters] if self.name else []
        nodata = _core.NO_VALUE if bands[0].dtype == np.float32 else 255.0 if self._is_answer else self.nodata
        text = self.description or None
        _core.write_geotiff(os.fspath(path), bands, labels, self.transform, self._crs, nodata, text)

    def _pixels(self) -> npt.NDArray[Any]:
        """The values as a file has them."""
        values = np.ascontiguousarray(self.values)
        if self._is_answer and values.dtype == np.float32:
            return np.where(np.isnan(values), 255, values > 0).astype(np.uint8)
        return values if values.dtype in (np.float32, np.uint8, np.uint16, np.uint32) else values.astype(np.float32)

    def to_xarray(self) -> xarray.DataArray:
        """An `xarray.DataArray` by the conventions of CF and rioxarray, with its time in UTC where it has one.

        Examples
        --------
        >>> scene.shadow(sun=(180, 30)).to_xarray().dims
        ('y', 'x')
        """
        return array_of(self)

    def sample(self, places: Places) -> npt.NDArray[np.float32]:
        """The values of the cells that hold places; NaN beside the grid, and where there is no value.

        Parameters
        ----------
        places : array_like, shape (N, 2) or (N, 3), or points of shapely or geopandas
            In the coordinates of the file; those of geopandas may be in any system.

        Returns
        -------
        ndarray, shape (N,), float32

        Examples
        --------
        >>> lit = scene.shadow(sun=(180, 30))
        >>> places = [[lit.x[3], lit.y[5]], [0, 0]]
        >>> np.array_equal(lit.sample(places), [lit.values[5, 3], np.nan], equal_nan=True)
        True
        """
        a, b, c, d, e, f = self.transform
        rows = map_places(places, "places", "give x and y: shape (N, 2)", 0, self.crs)
        inverse = np.linalg.inv(np.array([[a, b], [d, e]]))
        columns, lines = np.floor(inverse @ (rows[:, :2] - (c, f)).T).astype(np.int64)
        height, width = self.shape
        is_inside = (columns >= 0) & (columns < width) & (lines >= 0) & (lines < height)
        found = np.full(len(rows), np.nan, np.float32)
        found[is_inside] = self._known()[lines[is_inside], columns[is_inside]]
        return found

    def plot(
        self, ax: matplotlib.axes.Axes | None = None, *, add_colorbar: bool = True, **keywords: Any
    ) -> matplotlib.axes.Axes:
        """Draws the raster on the map with a bar of colours.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to draw; new ones if not given.
        add_colorbar : bool
            Whether there is a bar of colours.
        **keywords
            For `matplotlib.axes.Axes.imshow`, such as ``cmap`` and ``vmin``.

        Returns
        -------
        matplotlib.axes.Axes

        Examples
        --------
        >>> axes = scene.shadow(sun=(180, 30)).plot(cmap="gray")
        >>> axes.get_title()
        'share of the sun, 0 in shadow'
        """
        try:
            import matplotlib.pyplot as plt
        except ImportError:
            raise missing("matplotlib", "plot") from None
        if ax is None:
            ax = plt.figure().add_subplot()
        west, south, east, north = self.bounds
        drawn = ax.imshow(self._known(), extent=(west, east, south, north), **keywords)
        if add_colorbar:
            unit = "" if self.unit in ("", "1") else f" [{self.unit}]"
            ax.figure.colorbar(drawn, ax=ax, label=f"{self.name}{unit}")
        ax.set_title(self.description)
        ax.ticklabel_format(useOffset=False, style="plain")
        return ax

    def _known(self) -> npt.NDArray[Any]:
        """The values, as numbers with NaN where there is none."""
        if self.nodata is None or not np.isfinite(self.nodata):
            return self.values
        return np.where(self.values == self.nodata, np.nan, self.values).astype(np.float32)

    def __array__(self, dtype: npt.DTypeLike | None = None, copy: bool | None = None) -> npt.NDArray[Any]:
        known = self._known()
        if copy:
            return np.array(known, dtype)
        if copy is False and known is not self.values:
            raise ValueError("an array with NaN for nodata is a copy; `values` has the numbers as they are")
        return np.asarray(known, dtype)

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **keywords: Any) -> Any:
        for other in inputs:
            if isinstance(other, Raster):
                self._check_grid(other)
            elif not isinstance(other, (np.ndarray, np.generic, int, float, complex, list, tuple)):
                if hasattr(other, "__array_ufunc__"):
                    return NotImplemented
                raise TypeError(f"a Raster is not computed with a {type(other).__name__}; use its `values`")
        if keywords.get("out") is not None:
            raise TypeError("a Raster is no place for results of NumPy; use its `values`")
        arrays = [one._known() if isinstance(one, Raster) else one for one in inputs]
        found = getattr(ufunc, method)(*arrays, **keywords)
        if isinstance(found, tuple):
            return tuple(self._on_grid(one) for one in found)
        return self._on_grid(found)

    def _check_grid(self, other: Raster) -> None:
        if other.shape != self.shape or other.transform != self.transform:
            raise wrong("raster", "on another grid", "use rasters of the same cells, or their `values`")

    def _on_grid(self, found: Any) -> Any:
        """A result of NumPy as a raster where it has a value for each cell."""
        if not isinstance(found, np.ndarray) or found.shape != self.values.shape:
            return found
        return Raster(found, self.transform, self._crs, nodata=np.nan if found.dtype.kind == "f" else None)

    if TYPE_CHECKING:
        # the operators of NDArrayOperatorsMixin, whose types are not known
        def _operated(self, other: Operand) -> Raster: ...
        def _changed(self) -> Raster: ...

        __add__ = __radd__ = __sub__ = __rsub__ = __mul__ = __rmul__ = _operated
        __truediv__ = __rtruediv__ = __floordiv__ = __rfloordiv__ = __mod__ = __rmod__ = __pow__ = __rpow__ = _operated
        __and__ = __rand__ = __or__ = __ror__ = __xor__ = __rxor__ = _operated
        __lshift__ = __rlshift__ = __rshift__ = __rrshift__ = _operated
        __lt__ = __le__ = __gt__ = __ge__ = _operated
        __eq__ = __ne__ = _operated
        __neg__ = __pos__ = __abs__ = __invert__ = _changed

    def __bool__(self) -> bool:
        raise ValueError("a Raster is neither true nor false; use `.any()` or `.all()`")

    def any(self) -> bool:
        """Whether any cell that has a value is not zero.

        Examples
        --------
        >>> bool((scene.shadow(sun=(180, 30)) == 2).any())
        False
        """
        return bool(np.nan_to_num(self._known()).any())

    def all(self) -> bool:
        """Whether no cell that has a value is zero.

        Examples
        --------
        >>> (scene.shadow(sun=(180, 30)) <= 1).any()
        True
        """
        known = self._known()
        return bool(np.where(np.isnan(known), 1, known).all()) if known.dtype.kind == "f" else bool(known.all())

    def _reduced(self, name: str, keywords: dict[str, Any]) -> Any:
        """A reduction of NumPy over the cells that have a value."""
        if keywords.pop("out", None) is not None:
            raise TypeError("a Raster is no place for results of NumPy; use its `values`")
        return getattr(np, f"nan{name}")(self._known(), **keywords)

    @overload
    def mean(self, axis: None = None, **keywords: Any) -> np.floating[Any]: ...
    @overload
    def mean(self, axis: int, **keywords: Any) -> npt.NDArray[np.floating[Any]]: ...
    def mean(self, axis: int | None = None, **keywords: Any) -> Any:
        """Mean of the cells that have a value; also `numpy.mean`.

        Examples
        --------
        >>> bool(0 <= scene.shadow(sun=(180, 30)).mean() <= 1)
        True
        """
        return self._reduced("mean", {"axis": axis, **keywords})

    @overload
    def sum(self, axis: None = None, **keywords: Any) -> np.number[Any]: ...
    @overload
    def sum(self, axis: int, **keywords: Any) -> npt.NDArray[np.number[Any]]: ...
    def sum(self, axis: int | None = None, **keywords: Any) -> Any:
        """Sum of the cells that have a value; also `numpy.sum`.

        Examples
        --------
        >>> lit = scene.shadow(sun=(180, 30))
        >>> bool(lit.sum() == (lit == 1).sum())
        True
        """
        return self._reduced("sum", {"axis": axis, **keywords})

    @overload
    def min(self, axis: None = None, **keywords: Any) -> np.number[Any]: ...
    @overload
    def min(self, axis: int, **keywords: Any) -> npt.NDArray[np.number[Any]]: ...
    def min(self, axis: int | None = None, **keywords: Any) -> Any:
        """Least of the cells that have a value; also `numpy.min`.

        Examples
        --------
        >>> bool(scene.sky_view(cell=2)["sky_view_factor"].min() >= 0)
        True
        """
        return self._reduced("min", {"axis": axis, **keywords})

    @overload
    def max(self, axis: None = None, **keywords: Any) -> np.number[Any]: ...
    @overload
    def max(self, axis: int, **keywords: Any) -> npt.NDArray[np.number[Any]]: ...
    def max(self, axis: int | None = None, **keywords: Any) -> Any:
        """Greatest of the cells that have a value; also `numpy.max`.

        Examples
        --------
        >>> bool(scene.sky_view(cell=2)["sky_view_factor"].max() <= 1)
        True
        """
        return self._reduced("max", {"axis": axis, **keywords})

    @overload
    def std(self, axis: None = None, **keywords: Any) -> np.floating[Any]: ...
    @overload
    def std(self, axis: int, **keywords: Any) -> npt.NDArray[np.floating[Any]]: ...
    def std(self, axis: int | None = None, **keywords: Any) -> Any:
        """Standard deviation of the cells that have a value; also `numpy.std`.

        Examples
        --------
        >>> bool(scene.sky_view(cell=2)["sky_view_factor"].std() >= 0)
        True
        """
        return self._reduced("std", {"axis": axis, **keywords})

    @overload
    def var(self, axis: None = None, **keywords: Any) -> np.floating[Any]: ...
    @overload
    def var(self, axis: int, **keywords: Any) -> npt.NDArray[np.floating[Any]]: ...
    def var(self, axis: int | None = None, **keywords: Any) -> Any:
        """Variance of the cells that have a value; also `numpy.var`.

        Examples
        --------
        >>> bool(scene.sky_view(cell=2)["sky_view_factor"].var() >= 0)
        True
        """
        return self._reduced("var", {"axis": axis, **keywords})

    @overload
    def __getitem__(self, cells: Raster) -> npt.NDArray[Any]: ...
    @overload
    def __getitem__(self, cells: SupportsIndex | slice | tuple[Any, ...] | list[Any] | npt.NDArray[Any]) -> Any: ...
    def __getitem__(self, cells: Any) -> Any:
        return self.values[cells.values if isinstance(cells, Raster) else cells]

    def __len__(self) -> int:
        return len(self.values)

    def __repr__(self) -> str:
        rows, columns = self.shape
        name = f" '{self.name}'" if self.name else ""
        side = f"{self.transform[0] * self._crs.metres_per_unit:g} m"
        return f"<belvedere.Raster{name}: {rows} rows x {columns} columns of {side}, {self._crs.description}>"

    def _repr_html_(self) -> str:
        from ._picture import png_tag

        return f"{png_tag(self.values, self.nodata)}<br>{escaped(repr(self))}"

    def __reduce__(self) -> tuple[Any, ...]:
        state = (self.values, self.transform, self._crs.state, self.nodata, self.name, self.description)
        more = (self.unproven, self._is_answer, self.probability, self.uncertain, self.unit, self.tags, self.caster)
        return _unpickled, (*state, *more)


class RasterSeries(list[Raster]):
    """Rasters of several suns or times on one grid: a list in their order.

    Examples
    --------
    >>> day = scene.shadow(time=["2026-06-21T10:00+02:00", "2026-06-21T15:00+02:00"], cell=4)
    >>> [lit.tags["TIME"] for lit in day]
    ['2026-06-21T10:00:00+02:00', '2026-06-21T15:00:00+02:00']
    """

    @overload
    def __getitem__(self, index: SupportsIndex, /) -> Raster: ...
    @overload
    def __getitem__(self, index: slice, /) -> RasterSeries: ...
    def __getitem__(self, index: SupportsIndex | slice, /) -> Raster | RasterSeries:
        return RasterSeries(super().__getitem__(index)) if isinstance(index, slice) else super().__getitem__(index)

    def to_xarray(self) -> xarray.DataArray:
        """An `xarray.DataArray` of time, y and x by the conventions of CF; of sun, y and x where suns have no time.

        Times are in UTC, because xarray and netCDF have no time zones. ``sun_azimuth_deg`` and ``sun_elevation_deg``
        are coordinates. `to_netcdf` of xarray writes a file that xarray, GDAL and QGIS open.

        Examples
        --------
        >>> day = scene.shadow(time=["2026-06-21T10:00+02:00", "2026-06-21T15:00+02:00"], cell=4)
        >>> day.to_xarray()["time"].dt.hour.values.tolist()
        [8, 13]
        """
        if not self:
            raise wrong("rasters", "empty", "give at least one")
        return stack_of(self)


class Rasters(Mapping[str, Raster]):
    """Several rasters on one grid, by name.

    Examples
    --------
    >>> sky = scene.sky_view(cell=2)
    >>> sorted(sky)
    ['sky_openness', 'sky_view_factor']
    >>> sky["sky_view_factor"].shape == sky["sky_openness"].shape
    True
    """

    def __init__(self, rasters: Mapping[str, Raster]) -> None:
        if not rasters:
            raise wrong("rasters", "empty", "give at least one")
        self._rasters = dict(rasters)

    def __getitem__(self, name: str) -> Raster:
        if name not in self._rasters:
            raise KeyError(f"no raster {name!r}; use {', '.join(self._rasters)}")
        return self._rasters[name]

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            if name.startswith("_"):
                raise AttributeError(name)
            raise no_attribute(self, name, self._rasters)

    def __eq__(self, other: object) -> bool:
        raise TypeError(f"Rasters are not compared as a whole; take one by name, such as rasters[{next(iter(self))!r}]")

    def __array__(self, dtype: npt.DTypeLike | None = None, copy: bool | None = None) -> npt.NDArray[Any]:
        raise TypeError(f"Rasters are no array; take one by name, such as rasters[{next(iter(self))!r}]")

    def __iter__(self) -> Iterator[str]:
        return iter(self._rasters)

    def __len__(self) -> int:
        return len(self._rasters)

    def to_xarray(self) -> xarray.Dataset:
        """An `xarray.Dataset` by the conventions of rioxarray.

        Examples
        --------
        >>> sorted(scene.sky_view(cell=2).to_xarray())
        ['sky_openness', 'sky_view_factor']
        """
        try:
            import xarray
        except ImportError:
            raise missing("xarray", "to_xarray") from None
        return xarray.Dataset({name: raster.to_xarray() for name, raster in self.items()})

    def __repr__(self) -> str:
        first = next(iter(self.values()))
        return f"<belvedere.Rasters {', '.join(self)}: {repr(first).split(': ', 1)[1]}"


def escaped(text: str) -> str:
    """Text in HTML."""
    return text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")


def _unpickled(
    values: npt.NDArray[Any],
    transform: Any,
    system: Any,
    nodata: float | None,
    name: str,
    description: str,
    unproven: Raster | None,
    is_answer: bool,
    probability: Raster | None = None,
    uncertain: Raster | None = None,
    unit: str = "",
    tags: Mapping[str, str] | None = None,
    caster: Raster | None = None,
) -> Raster:
    named: dict[str, Any] = {"nodata": nodata, "name": name, "description": description}
    made = Raster(values, transform, _core.Crs.from_state(system), **named, unproven=unproven, is_answer=is_answer)
    made.probability, made.uncertain, made.caster = probability, uncertain, caster
    made.unit, made.tags = unit, dict(tags or {})
    return made


def _numbers(raster: Raster) -> npt.NDArray[np.float32]:
    """The pixels as numbers, `NO_VALUE` where there is none."""
    values = np.array(raster.values, np.float32)
    no_value = np.isnan(values) if raster.nodata is None else (raster.values == raster.nodata) | np.isnan(values)
    values[no_value] = _core.NO_VALUE
    return values
