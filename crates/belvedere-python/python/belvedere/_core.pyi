import os
from collections.abc import Callable, Sequence
from typing import Any, final

import numpy as np
import numpy.typing as npt

_Progress = Callable[[str, int, int], object] | None
_Grid = tuple[int, int, Sequence[float]]
_Columns = list[tuple[str, str, npt.NDArray[Any]]]
_NamedColumns = list[tuple[str, Any]]
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
        self, eye: Sequence[float], targets: dict[str, Any], unproven: str, progress: _Progress
    ) -> tuple[npt.NDArray[np.uint8], _Remarks]: ...
    def seen_of_mesh(
        self, eye: Sequence[float], faces: dict[str, Any], unproven: str, progress: _Progress
    ) -> tuple[dict[str, Any], _Remarks]: ...
    def lines_of_sight(
        self,
        observers: npt.NDArray[np.float64],
        targets: npt.NDArray[np.float64] | None,
        ends: dict[str, Any],
        unproven: str,
        how_sure: dict[str, Any],
        curvature: str | None,
        refraction: float | None,
        frequency: float | None,
        max_distance: float | None,
        progress: _Progress,
    ) -> tuple[dict[str, npt.NDArray[Any]], npt.NDArray[np.float64], list[dict[str, Any]]]: ...
    def shadow(
        self,
        suns: Sequence[Any],
        place: dict[str, Any],
        targets: dict[str, Any],
        edges: str,
        trees: dict[str, Any],
        how_sure: dict[str, Any],
        casters: bool,
        progress: _Progress,
    ) -> list[_Results]: ...
    def sun_hours(
        self,
        days: dict[str, Any],
        rules: list[str],
        place: dict[str, Any],
        targets: dict[str, Any],
        trees: dict[str, Any],
        interval: bool,
        progress: _Progress,
    ) -> _Results: ...
    def hourly_sun(
        self,
        year: int,
        days: dict[str, Any],
        place: dict[str, Any],
        targets: dict[str, Any],
        progress: _Progress,
    ) -> tuple[list[tuple[str, npt.NDArray[np.uint32]]], _Grid | None, list[dict[str, Any]]]: ...
    def sky_view(
        self,
        directions: int | None,
        patches: str | None,
        targets: dict[str, Any],
        trees: dict[str, Any],
        interval: bool,
        progress: _Progress,
    ) -> _Results: ...
    def viewshed(
        self,
        observers: npt.NDArray[np.float64] | int,
        looking: dict[str, Any],
        place: dict[str, Any],
        unproven: str,
        how_sure: dict[str, Any],
        progress: _Progress,
    ) -> tuple[list[tuple[npt.NDArray[Any], float]], list[str], str, _Grid, list[dict[str, Any]]]: ...
    def horizon(
        self,
        observers: npt.NDArray[np.float64],
        angle_step: float | None,
        looking: dict[str, Any],
        place: dict[str, Any],
        interval: bool,
        progress: _Progress,
    ) -> tuple[npt.NDArray[np.float64], int, list[dict[str, Any]]]: ...
    def isovist(
        self,
        observers: npt.NDArray[np.float64],
        angle_step: float | None,
        min_jump: float | None,
        looking: dict[str, Any],
        place: dict[str, Any],
        interval: bool,
        progress: _Progress,
    ) -> tuple[dict[str, npt.NDArray[Any]], list[npt.NDArray[np.float32]], list[dict[str, Any]]]: ...
    def towers(
        self,
        towers: list[dict[str, Any]],
        looking: dict[str, Any],
        targets: dict[str, Any],
        wirelines: str | None,
        progress: _Progress,
    ) -> _Results: ...
    def landmark(
        self,
        landmark: dict[str, Any],
        observers: npt.NDArray[np.float64] | None,
        looking: dict[str, Any],
        unproven: str,
        probability: bool,
        progress: _Progress,
    ) -> tuple[_Measures, _Grid | None, list[dict[str, Any]], npt.NDArray[np.float64]]: ...
    def protected_view(
        self,
        landmark: dict[str, Any],
        observers: npt.NDArray[np.float64],
        looking: dict[str, Any],
        unproven: str,
        progress: _Progress,
    ) -> tuple[_Columns, _Grid, list[dict[str, Any]]]: ...
    def window_views(
        self, facades: dict[str, Any], place: dict[str, Any], unproven: str, progress: _Progress
    ) -> tuple[
        _Columns,
        npt.NDArray[np.float64],
        list[str],
        tuple[list[str], list[tuple[str, npt.NDArray[Any]]]],
        list[dict[str, Any]],
    ]: ...
    def cameras(
        self,
        choice: dict[str, Any],
        targets: dict[str, Any],
        place: dict[str, Any],
        unproven: str,
        progress: _Progress,
    ) -> tuple[
        dict[str, npt.NDArray[Any]], dict[str, Any], npt.NDArray[np.uint32], _Grid | None, list[dict[str, Any]]
    ]: ...
    def survey_plan(
        self,
        stations: dict[str, Any],
        observers: npt.NDArray[np.float64],
        targets: npt.NDArray[np.float64],
        ends: dict[str, Any],
        progress: _Progress,
    ) -> tuple[dict[str, Any], list[dict[str, Any]]]: ...
    def irradiance(
        self, radiation: dict[str, Any], targets: dict[str, Any], trees: dict[str, Any], progress: _Progress
    ) -> _Results: ...
    def heat(
        self,
        given: dict[str, Any],
        days: dict[str, Any],
        place: dict[str, Any],
        targets: dict[str, Any],
        trees: dict[str, Any],
        progress: _Progress,
    ) -> _Results: ...
    def roof_planes(
        self,
        radiation: dict[str, Any],
        roofs: dict[str, Any],
        trees: dict[str, Any],
        progress: _Progress,
    ) -> tuple[_NamedColumns, _NamedColumns, list[_NamedColumns], _Remarks]: ...
    def depth_map(
        self, camera: dict[str, Any], place: dict[str, Any], progress: _Progress
    ) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.uint32] | None, _Remarks]: ...
    def comfort(
        self, walks: dict[str, Any], days: dict[str, Any], place: dict[str, Any], progress: _Progress
    ) -> tuple[dict[str, npt.NDArray[Any]], list[dict[str, Any]]]: ...
    def sun_calendar(
        self,
        windows: list[list[float]],
        targets: dict[str, Any],
        days: dict[str, Any],
        rule: str | None,
        place: dict[str, Any],
        progress: _Progress,
    ) -> tuple[dict[str, Any], list[dict[str, Any]]]: ...
    def glare(
        self,
        keywords: dict[str, Any],
        observers: npt.NDArray[np.float64],
        days: dict[str, Any],
        place: dict[str, Any],
        progress: _Progress,
    ) -> tuple[list[tuple[str, Any]], list[tuple[str, Any]], list[dict[str, Any]]]: ...
    def sunlight_report(
        self,
        path: str,
        keywords: dict[str, Any],
        days: dict[str, Any],
        place: dict[str, Any],
        progress: _Progress,
    ) -> tuple[list[str], list[dict[str, Any]]]: ...
    def envelope(
        self, build: dict[str, Any], days: dict[str, Any], place: dict[str, Any], progress: _Progress
    ) -> tuple[tuple[str, str, npt.NDArray[np.float32]], _Grid, list[dict[str, Any]]]: ...
    def sun_positions(self, times: list[str], place: dict[str, Any]) -> list[tuple[float, float]]: ...

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
