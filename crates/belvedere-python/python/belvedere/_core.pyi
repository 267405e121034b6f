import os
from collections.abc import Callable, Sequence
from typing import Any, final

import numpy as np
import numpy.typing as npt

_Progress = Callable[[str, int, int], object] | None
_Grid = tuple[int, int, Sequence[float]]
_Columns = list[tuple[str, str, npt.NDArray[Any]]]
_NamedColumns = list[tuple[str, Any]]
#: Dictionaries of fields, columns and choices.
_Data = dict[str, Any]
_Places = npt.NDArray[np.float64]
_Remarks = list[dict[str, Any]]
_Measures = list[tuple[str, str, npt.NDArray[Any], bool, str, dict[str, str]]]
_Results = tuple[
    _Measures,
    _Grid | None,
    dict[str, Any] | None,
    _Remarks,
    npt.NDArray[np.float64] | None,
]
_CrsState = tuple[str | None, int | None, int | None, float, float, int, str | None]

__all__ = [
    "NO_VALUE",
    "Cloud",
    "Crs",
    "Mesh",
    "Scene",
    "__version__",
    "devices",
    "fetch",
    "open_surveys",
    "read",
    "simulate",
    "write_geotiff",
]

__version__: str
NO_VALUE: float

@final
class Crs:
    def __new__(cls, text: str) -> Crs: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    @staticmethod
    def from_state(state: _CrsState) -> Crs: ...
    @property
    def state(self) -> _CrsState: ...
    @property
    def text(self) -> str | None: ...
    @property
    def description(self) -> str: ...
    @property
    def metres_per_unit(self) -> float: ...

_SkyState = tuple[int, float, list[list[float]], list[float], list[float], int, bytes]
_FilesState = tuple[list[tuple[Any, int, list[str], list[str]]], list[int] | None, bool]

@final
class Cloud:
    def __new__(
        cls, xyz: npt.NDArray[Any], attributes: dict[str, npt.NDArray[Any]], adjusted_gps_time: bool, crs: Crs | None
    ) -> Cloud: ...
    @staticmethod
    def from_state(
        origin: Sequence[float],
        positions: npt.NDArray[np.float32],
        attributes: dict[str, npt.NDArray[Any]],
        adjusted_gps_time: bool,
        scanners: tuple[npt.NDArray[np.float32], list[_SkyState]],
        crs: Crs,
        files: _FilesState,
    ) -> Cloud: ...
    @property
    def files(self) -> _FilesState: ...
    @property
    def positions(self) -> npt.NDArray[np.float32]: ...
    @property
    def scanner_positions(self) -> npt.NDArray[np.float32]: ...
    @property
    def sky_regions(self) -> list[_SkyState]: ...
    @property
    def xyz(self) -> npt.NDArray[np.float64]: ...
    @property
    def attributes(self) -> dict[str, npt.NDArray[Any]]: ...
    @property
    def adjusted_gps_time(self) -> bool: ...
    @property
    def origin(self) -> list[float]: ...
    @property
    def crs(self) -> Crs: ...
    @property
    def bounds(self) -> list[list[float]]: ...
    def write(self, path: str | os.PathLike[str]) -> list[dict[str, Any]]: ...
    def __len__(self) -> int: ...

@final
class Mesh:
    def __new__(
        cls,
        vertices: npt.NDArray[np.float64],
        triangles: npt.NDArray[np.uint32],
        objects: npt.NDArray[np.uint32],
        object_names: list[str],
        crs: Crs | None,
    ) -> Mesh: ...
    @staticmethod
    def read(input: object) -> Mesh: ...
    @property
    def vertices(self) -> npt.NDArray[np.float64]: ...
    @property
    def triangles(self) -> npt.NDArray[np.uint32]: ...
    @property
    def objects(self) -> npt.NDArray[np.uint32]: ...
    @property
    def object_names(self) -> list[str]: ...
    @property
    def crs(self) -> Crs: ...
    def __len__(self) -> int: ...

@final
class Scene:
    @staticmethod
    def build(cloud: Cloud, choices: dict[str, Any], progress: _Progress) -> tuple[Scene, str, _Remarks]: ...
    @staticmethod
    def calibrate(
        cloud: Cloud, choices: dict[str, Any], share: float, seed: int, progress: _Progress
    ) -> tuple[str, _Remarks]: ...
    @staticmethod
    def load(input: object, cloud: Cloud | None, progress: _Progress) -> Scene: ...
    def save(self, path: str | os.PathLike[str]) -> None: ...
    def to_bytes(self) -> bytes: ...
    def with_added(self, meshes: list[Mesh]) -> Scene: ...
    def without(self, rings: list[list[tuple[float, float]]] | None, class_: int) -> tuple[Scene, str, _Remarks]: ...
    def with_horizon(self, path: str) -> Scene: ...
    def with_terrain(self, path: str) -> Scene: ...
    def with_device(self, device: str) -> Scene: ...
    @property
    def device(self) -> str | None: ...
    @property
    def device_notes(self) -> list[str]: ...
    @property
    def cloud(self) -> Cloud | None: ...
    @property
    def ball_count(self) -> int: ...
    @property
    def pulse_count(self) -> int | None: ...
    @property
    def is_carved(self) -> bool: ...
    @property
    def bounds(self) -> list[list[float]]: ...
    @property
    def crs(self) -> Crs: ...
    @property
    def provenance(self) -> list[tuple[str, str]]: ...
    def visible(
        self, eye: Sequence[float], targets: _Data, unproven: str | None, progress: _Progress
    ) -> tuple[npt.NDArray[np.uint8], _Remarks]: ...
    def seen_of_mesh(
        self, eye: Sequence[float], faces: _Data, unproven: str | None, progress: _Progress
    ) -> tuple[_Data, _Remarks]: ...
    def lines_of_sight(
        self,
        question: _Data,
        observers: _Places,
        targets: _Places | None,
        max_distance: float | None,
        progress: _Progress,
    ) -> tuple[_Data, _Places, _Remarks]: ...
    def shadow(self, question: _Data, targets: _Data, progress: _Progress) -> list[_Results]: ...
    def on_targets(self, question: _Data, weather: object, targets: _Data, progress: _Progress) -> _Results: ...
    def hourly_sun(
        self, year: int, question: _Data, targets: _Data, progress: _Progress
    ) -> tuple[list[tuple[str, npt.NDArray[np.uint32]]], _Grid | None, _Remarks]: ...
    def sun_positions(self, question: _Data) -> list[tuple[float, float]]: ...
    def viewshed(
        self, question: _Data, observers: _Places | int, progress: _Progress
    ) -> tuple[list[tuple[npt.NDArray[Any], float]], list[str], str, _Grid, _Remarks]: ...
    def horizon(self, question: _Data, observers: _Places, progress: _Progress) -> tuple[_Places, int, _Remarks]: ...
    def isovist(
        self, question: _Data, observers: _Places, progress: _Progress
    ) -> tuple[_Data, list[npt.NDArray[np.float32]], _Remarks]: ...
    def towers(
        self, question: _Data, towers: list[_Data], wirelines: str | None, targets: _Data, progress: _Progress
    ) -> _Results: ...
    def landmark(
        self, question: _Data, object: _Data, observers: _Places | None, progress: _Progress
    ) -> tuple[_Measures, _Grid | None, _Remarks, _Places]: ...
    def protected_view(
        self, question: _Data, shape: _Data, object: _Data, observers: _Places, cells: _Data, progress: _Progress
    ) -> tuple[_Columns, _Grid, _Remarks]: ...
    def window_views(
        self, question: _Data, windows: list[list[float]], mesh: Mesh | None, objects: list[str], progress: _Progress
    ) -> tuple[_Columns, _Places, list[str], tuple[list[str], _NamedColumns], _Remarks]: ...
    def cameras(
        self, question: _Data, earth: _Data, choice: _Data, targets: _Data, progress: _Progress
    ) -> tuple[_Data, _Data, npt.NDArray[np.uint32], _Grid | None, _Remarks]: ...
    def survey_plan(
        self,
        question: _Data,
        candidates: list[tuple[list[float], int | None]] | None,
        observers: _Places,
        targets: _Places,
        cells: _Data,
        progress: _Progress,
    ) -> tuple[_Data, _Remarks]: ...
    def irradiance(self, radiation: _Data, summation: _Data, targets: _Data, progress: _Progress) -> _Results: ...
    def roof_planes(
        self,
        radiation: _Data,
        summation: _Data,
        footprints: object,
        ground: str | None,
        is_hourly: bool,
        progress: _Progress,
    ) -> tuple[_NamedColumns, _NamedColumns, list[_NamedColumns], _Remarks]: ...
    def depth_map(
        self, camera: _Data, north: str, progress: _Progress
    ) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.uint32] | None, _Remarks]: ...
    def comfort(
        self,
        question: _Data,
        routes: list[list[tuple[float, float, float]]],
        windows: list[list[float]],
        ground: str | None,
        progress: _Progress,
    ) -> tuple[_Data, _Remarks]: ...
    def envelope(
        self,
        question: _Data,
        parcel: list[list[tuple[float, float]]],
        protect: list[list[tuple[float, float, float]]],
        ground: str | None,
        progress: _Progress,
    ) -> tuple[tuple[str, str, npt.NDArray[np.float32]], _Grid, _Remarks]: ...
    def sun_calendar(
        self, question: _Data, windows: list[list[float]], targets: _Data, progress: _Progress
    ) -> tuple[_Data, _Remarks]: ...
    def glare(
        self,
        question: _Data,
        reflectors: list[list[float]],
        names: list[str],
        observers: _Places,
        progress: _Progress,
    ) -> tuple[_NamedColumns, _NamedColumns, _Remarks]: ...
    def sunlight_report(
        self, path: str, keywords: _Data, days: _Data, place: _Data, progress: _Progress
    ) -> tuple[list[str], _Remarks]: ...

def read(
    inputs: list[Any],
    crs: str | None,
    crs_override: bool,
    up: str,
    skip_distant: bool,
    bounds: list[list[float]] | None,
    classes: list[int] | None,
    flown: str | None,
    progress: _Progress,
) -> tuple[Cloud, str]: ...
def open_surveys(area: dict[str, Any], progress: _Progress) -> str: ...
def fetch(area: dict[str, Any], progress: _Progress) -> tuple[Cloud, str, str, list[str]]: ...
def simulate(preset: str, extent: float | None, density: float | None, seed: int) -> dict[str, npt.NDArray[Any]]: ...
def devices() -> list[list[str]]: ...
def write_geotiff(
    path: str | os.PathLike[str],
    bands: Sequence[npt.NDArray[Any]],
    labels: Sequence[tuple[str, str, Sequence[tuple[str, str]]]],
    transform: Sequence[float],
    crs: Crs,
    nodata: float | None,
    description: str | None,
) -> None: ...
