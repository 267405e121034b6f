"""Triangle meshes."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._errors import wrong
from ._inputs import check_finite, check_whole, native_source, places, system_text
from ._types import Facing, Numbers, Places, Source, System


class Mesh:
    """A triangle mesh from arrays: targets, a landmark, or a planned building.

    Parameters
    ----------
    vertices : array_like, shape (V, 3)
        Coordinates in the unit and the reference system of the cloud.
    triangles : array_like, shape (T, 3)
        Rows of `vertices`, from 0; counter-clockwise seen from outside.
    objects : array_like, shape (T,), optional
        Which object a triangle belongs to: a row of `object_names`.
    object_names : list of str, optional
    crs : str, int or object of pyproj, optional
        Coordinate reference system; that of the cloud if not given.

    Raises
    ------
    BelvedereError
        Without a triangle, for vertices that are not finite, and for rows out of range.

    Examples
    --------
    >>> corners = [(0, 0, 0), (4, 0, 0), (4, 0, 3), (0, 0, 3)]
    >>> belvedere.Mesh(corners, [(0, 1, 2), (0, 2, 3)])
    <belvedere.Mesh: 2 triangles>
    """

    def __init__(
        self,
        vertices: Places,
        triangles: Numbers,
        *,
        objects: Numbers | None = None,
        object_names: Sequence[str] = (),
        crs: System | None = None,
    ) -> None:
        corners = np.asarray(places(vertices, "vertices"), np.float64)
        faces = _rows(triangles, "triangles")
        if faces.ndim != 2 or faces.shape[1] != 3:
            raise wrong("triangles", f"an array of shape {faces.shape}", "give rows of three vertices, shape (T, 3)")
        of = np.empty(0, np.uint32) if objects is None else _rows(objects, "objects")
        if of.ndim != 1:
            raise wrong("objects", f"an array of shape {of.shape}", "give a number for each triangle, shape (T,)")
        system = None if crs is None else _core.Crs(system_text(crs))
        self._core = _core.Mesh(corners, faces, of, list(object_names), system)
        self._sampling: tuple[float | None, int, bool] = (None, 1, False)

    @classmethod
    def _of(cls, core: _core.Mesh, sampling: tuple[float | None, int, bool] = (None, 1, False)) -> Mesh:
        mesh = cls.__new__(cls)
        mesh._core = core
        mesh._sampling = sampling
        return mesh

    @classmethod
    def read(cls, source: Source, *, name: str | None = None) -> Mesh:
        """The mesh of a file: ``.obj``, ``.ply`` or CityJSON.

        Parameters
        ----------
        source : path, bytes, or binary file
        name : str, optional
            Name of bytes, such as ``"town.obj"``; its extension selects the format.

        Examples
        --------
        >>> lines = ["v 0 0 0", "v 4 0 0", "v 4 0 3", "f 1 2 3"]
        >>> belvedere.Mesh.read(chr(10).join(lines).encode(), name="wall.obj")
        <belvedere.Mesh: 1 triangles>
        """
        return cls._of(_core.Mesh.read(native_source(source, name)))

    def sampled(self, *, spacing: float | None = None, seed: int = 1, facing: Facing = "normals") -> Mesh:
        """The same mesh, sampled in another way where its faces are targets.

        Parameters
        ----------
        spacing : float, optional
            Longest side of a piece, metres; 0.5 if not given. Each piece of a face has one target at a random place.
        seed : int
            Of these places.
        facing : {'normals', 'level'}
            Whether targets face away from the surface, or up.

        Examples
        --------
        >>> wall = belvedere.Mesh([(0, 0, 0), (4, 0, 0), (4, 0, 3)], [(0, 1, 2)])
        >>> finer = wall.sampled(spacing=0.1)
        """
        check_finite(spacing=spacing)
        if facing not in ("normals", "level"):
            raise wrong("facing", repr(facing), "use 'normals' or 'level'")
        check_whole(seed=seed)
        if seed < 0:
            raise wrong("seed", seed, "give a whole number, 0 or more")
        return Mesh._of(self._core, (spacing, int(seed), facing == "level"))

    @property
    def _faces(self) -> dict[str, Any]:
        """As targets for the native part."""
        spacing, seed, is_level = self._sampling
        return {"mesh": self._core, "spacing": spacing, "seed": seed, "is_level": is_level}

    @property
    def vertices(self) -> npt.NDArray[np.float64]:
        """Coordinates, shape (V, 3).

        Examples
        --------
        >>> belvedere.Mesh([(0, 0, 0), (4, 0, 0), (4, 0, 3)], [(0, 1, 2)]).vertices.shape
        (3, 3)
        """
        return self._core.vertices

    @property
    def triangles(self) -> npt.NDArray[np.uint32]:
        """Rows of the vertices of each triangle, shape (T, 3).

        Examples
        --------
        >>> belvedere.Mesh([(0, 0, 0), (4, 0, 0), (4, 0, 3)], [(0, 1, 2)]).triangles.tolist()
        [[0, 1, 2]]
        """
        return self._core.triangles

    @property
    def objects(self) -> npt.NDArray[np.uint32]:
        """The row of `object_names` of each triangle, shape (T,); empty where the mesh knows no objects.

        Examples
        --------
        >>> len(belvedere.Mesh([(0, 0, 0), (4, 0, 0), (4, 0, 3)], [(0, 1, 2)]).objects)
        0
        """
        return self._core.objects

    @property
    def object_names(self) -> list[str]:
        """Names of the objects.

        Examples
        --------
        >>> corners = [(0, 0, 0), (4, 0, 0), (4, 0, 3)]
        >>> belvedere.Mesh(corners, [(0, 1, 2)], objects=[0], object_names=["wall"]).object_names
        ['wall']
        """
        return self._core.object_names

    @property
    def crs(self) -> str | None:
        """The coordinate reference system as well-known text or ``EPSG:CODE``; None where it is not known.

        Examples
        --------
        >>> belvedere.Mesh([(0, 0, 0), (4, 0, 0), (4, 0, 3)], [(0, 1, 2)]).crs is None
        True
        """
        return self._core.crs.text

    def __len__(self) -> int:
        return len(self._core)

    def __repr__(self) -> str:
        names = len(self.object_names)
        return f"<belvedere.Mesh: {len(self)} triangles{f' of {names} objects' if names else ''}>"

    def __reduce__(self) -> tuple[Any, ...]:
        state = (self.vertices, self.triangles, self.objects, self.object_names, self._core.crs.state)
        return _unpickled, (state, self._sampling)


def native_mesh(mesh: str | os.PathLike[str] | Mesh) -> _core.Mesh:
    """A mesh, or that of a file."""
    return (mesh if isinstance(mesh, Mesh) else Mesh.read(mesh))._core


def _rows(values: Numbers, what: str) -> npt.NDArray[np.uint32]:
    array = np.asarray(values)
    if array.size == 0:
        raise wrong(what, "empty", "give at least one triangle")
    converted = array.astype(np.uint32) if array.dtype.kind in "iu" else None
    if converted is None or not np.array_equal(converted, array):
        raise wrong(what, f"an array of {array.dtype}", "give whole numbers from 0")
    return converted


def _unpickled(state: tuple[Any, Any, Any, list[str], Any], sampling: tuple[float | None, int, bool]) -> Mesh:
    vertices, triangles, objects, names, system = state
    return Mesh._of(_core.Mesh(vertices, triangles, objects, names, _core.Crs.from_state(system)), sampling)
