"""Visibility analysis directly on point clouds: what can be seen from where, and what lies in shadow.

>>> import belvedere
>>> cloud = belvedere.read(tile)
>>> scene = belvedere.Scene(cloud)
>>> lit = scene.shadow(time="2026-06-21T15:00+02:00")
>>> lit.to_geotiff(folder / "shadow.tif")
"""

from . import city
from ._answer import Answer
from ._cameras import Placement
from ._cloud import Cloud, read
from ._core import __version__
from ._devices import Device, devices
from ._errors import BelvedereError, BelvedereWarning
from ._fetch import fetch, open_surveys
from ._mesh import Mesh
from ._raster import Raster, Rasters, RasterSeries
from ._remarks import Remark
from ._scene import Scene
from ._sights import Sight
from ._simulate import simulate
from ._table import Table

__all__ = [
    "Answer",
    "BelvedereError",
    "BelvedereWarning",
    "Cloud",
    "Device",
    "Mesh",
    "Placement",
    "Raster",
    "RasterSeries",
    "Rasters",
    "Remark",
    "Scene",
    "Sight",
    "Table",
    "__version__",
    "city",
    "devices",
    "fetch",
    "open_surveys",
    "read",
    "simulate",
]
