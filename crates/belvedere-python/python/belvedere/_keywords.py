"""Keywords of questions whose results follow from their targets, for the types of these results."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, TypedDict, Union

from ._types import (
    Body,
    ClearSky,
    Curvature,
    Day,
    Ground,
    GroundCover,
    Leaves,
    Location,
    Numbers,
    Patches,
    Period,
    Progress,
    SkyModel,
    Source,
    SunElevation,
    Surroundings,
    ThroughTrees,
    Unproven,
    Zone,
)

if TYPE_CHECKING:
    import os

    import pandas


class _Cells(TypedDict, total=False):
    cell: Union[float, None]
    surface: bool
    ground: Union[Ground, None]
    progress: Progress


class _Lit(_Cells, total=False):
    target_height: Union[float, None]
    through_trees: Union[ThroughTrees, None]


class Shadow(_Lit, total=False):
    normals: Union[Numbers, None]
    soft: bool
    leaves: Union[Leaves, None]
    location: Union[Location, None]
    grid_north: bool


class SunHours(_Lit, total=False):
    date: Union[Day, Iterable[Day], None]
    period: Union[Period, None]
    rule: Union[str, list[str]]
    year: Union[int, None]
    time_step_min: Union[float, None]
    min_sun_elevation_deg: Union[float, None]
    sun_tolerance_deg: Union[float, None]
    normals: Union[Numbers, None]
    leaves: Union[Leaves, None]
    location: Union[Location, None]
    zone: Union[Zone, None]
    sun_elevation: SunElevation
    air: Union[Numbers, None]
    interval: bool


class SkyView(_Lit, total=False):
    directions: Union[int, None]
    patches: Union[Patches, None]
    normals: Union[Numbers, None]
    interval: bool


class Irradiance(_Lit, total=False):
    weather: Union[Source, pandas.DataFrame, None]
    clear_sky: Union[ClearSky, None]
    linke: Union[float, None]
    year: Union[int, None]
    months: bool
    sky_model: Union[SkyModel, None]
    patch_division: Union[int, None]
    parts_per_row: Union[int, None]
    albedo: Union[float, None]
    surroundings: Union[Surroundings, None]
    sun_cell_deg: Union[float, None]
    normals: Union[Numbers, None]
    leaves: Union[Leaves, None]
    location: Union[Location, None]
    interval: bool


class Heat(_Lit, total=False):
    date: Union[Day, Iterable[Day], None]
    period: Union[Period, None]
    between: Union[Numbers, None]
    by_hour: bool
    pet: bool
    body: Body
    ground_cover: GroundCover
    ground_warming: Union[float, None]
    wind_factor: Union[float, None]
    parts_per_row: Union[int, None]
    leaves: Union[Leaves, None]
    location: Union[Location, None]
    zone: Union[Zone, None]


class Towers(_Cells, total=False):
    observer_height: Union[float, None]
    max_distance: Union[float, None]
    curvature: Union[Curvature, None]
    refraction: Union[float, None]
    far: bool
    wirelines: Union[str, os.PathLike[str], None]


class Landmark(TypedDict, total=False):
    observer_height: Union[float, None]
    cell: Union[float, None]
    ground: Union[Ground, None]
    spacing: Union[float, None]
    seed: int
    max_distance: Union[float, None]
    unproven: Unproven
    curvature: Union[Curvature, None]
    refraction: Union[float, None]
    probability: bool
    progress: Progress


class LineOfSight(TypedDict, total=False):
    observer_height: Union[float, None]
    target_height: Union[float, None]
    ground: Union[Ground, None]
    unproven: Unproven
    probability: bool
    certain: Union[float, None]
    curvature: Union[Curvature, None]
    refraction: Union[float, None]
    frequency_ghz: Union[float, None]
    progress: Progress
