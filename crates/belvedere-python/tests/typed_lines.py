"""Types of results, and calls that mypy refuses: only checked by mypy, never run.

`warn_unused_ignores` makes mypy say which wrong line it does not refuse.
"""

from __future__ import annotations

import datetime
from typing import Any

import belvedere
import numpy as np
import numpy.typing as npt
from typing_extensions import assert_type

Floats = npt.NDArray[np.float32]
DAY = datetime.date(2026, 6, 21)
TIME = datetime.datetime(2026, 6, 21, 13, tzinfo=datetime.timezone.utc)


def results(scene: belvedere.Scene, cloud: belvedere.Cloud, mesh: belvedere.Mesh, xyz: npt.NDArray[np.float64]) -> None:
    # ---- cells, rows, faces
    assert_type(scene.shadow(time=TIME), belvedere.Raster)
    assert_type(scene.shadow(time="2026-06-21T15:00+02:00", cell=2), belvedere.Raster)
    assert_type(scene.shadow(sun=(180, 30)), belvedere.Raster)
    assert_type(scene.shadow(time=[TIME, TIME]), belvedere.RasterSeries)
    assert_type(scene.shadow(sun=[(180.0, 30.0), (90.0, 10.0)]), belvedere.RasterSeries)
    assert_type(scene.shadow(time=TIME, targets=xyz), Floats)
    assert_type(scene.shadow(time=TIME, targets=(155000, 463000)), Floats)
    assert_type(scene.shadow(time=TIME, targets=cloud), Floats)
    assert_type(scene.shadow(time=[TIME], targets=xyz), list[Floats])
    assert_type(scene.shadow(time=TIME, targets=mesh), belvedere.Table)
    assert_type(scene.shadow(time=TIME, targets=xyz, casters=True), belvedere.Table)
    assert_type(scene.shadow(time=TIME, targets=xyz, certain=0.9), belvedere.Table)
    assert_type(scene.sun_hours(date=DAY), belvedere.Rasters)
    assert_type(scene.sun_hours(date="2026-06-21", targets=xyz), belvedere.Table)
    assert_type(scene.sky_view(), belvedere.Rasters)
    assert_type(scene.sky_view(targets=mesh), belvedere.Table)
    assert_type(scene.irradiance(clear_sky="ineichen", surface=True), belvedere.Rasters)
    assert_type(scene.irradiance(weather="tmy.epw", targets=[(1, 2, 3)], normals=[(0, 0, 1)]), belvedere.Table)
    assert_type(scene.heat(weather="tmy.epw", date=DAY), belvedere.Rasters)
    assert_type(scene.heat(weather="tmy.epw", date=DAY, targets=xyz), belvedere.Table)
    assert_type(scene.towers({"x": [1], "y": [2], "tip": [100]}), belvedere.Rasters)
    assert_type(scene.towers({"x": [1], "y": [2], "tip": [100]}, targets=xyz), belvedere.Table)
    assert_type(scene.landmark(target_class=6), belvedere.Rasters)
    assert_type(scene.landmark("church.obj", observers=xyz), belvedere.Table)
    # ---- what is seen
    assert_type(scene.visible((1, 2, 3), xyz), npt.NDArray[np.uint8])
    assert_type(scene.visible((1, 2, 3), mesh), belvedere.Table)
    assert_type(scene.line_of_sight((1, 2, 3), (4, 5, 6)), belvedere.Sight)
    assert_type(scene.line_of_sight((1, 2, 3), [(4, 5, 6), (7, 8, 9)]), belvedere.Table)
    assert_type(scene.line_of_sight([(1, 2), (3, 4)], (5, 6), observer_height=2), belvedere.Table)
    assert_type(scene.viewshed((1, 2), max_distance=60), belvedere.Raster)
    assert_type(scene.network(xyz), belvedere.Table)
    assert_type(scene.horizon((1, 2)), tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]])
    # ---- results
    lit = scene.shadow(time=TIME)
    assert_type(lit == 1, belvedere.Raster)
    assert_type(1 - lit, belvedere.Raster)
    assert_type((lit > 0.5) & ~(lit < 1), belvedere.Raster)
    assert_type(lit[lit == 1], npt.NDArray[Any])
    assert_type(lit.mean(), np.floating[Any])
    assert_type(lit.sum(), np.number[Any])
    print(f"{lit.max():.1f}", 1 - lit.min() <= 1, int(lit.sum()))
    assert_type(lit.mean(axis=0), npt.NDArray[np.floating[Any]])
    assert_type(lit.unproven, belvedere.Raster | None)
    assert_type(scene.sky_view()["sky_view_factor"], belvedere.Raster)
    assert_type(scene.shadow(time=[TIME])[0], belvedere.Raster)
    assert_type(scene.shadow(time=[TIME])[:1], belvedere.RasterSeries)
    assert_type(scene.cameras("roofs", count=1).cameras, belvedere.Table)
    assert_type(cloud.attributes["classification"], npt.NDArray[Any])


def refused(scene: belvedere.Scene, cloud: belvedere.Cloud, xyz: npt.NDArray[np.float64]) -> None:
    # ---- words
    scene.viewshed((1, 2), unproven="blocked")  # type: ignore[arg-type]
    scene.viewshed((1, 2), ground="DTM")  # type: ignore[arg-type]
    scene.viewshed((1, 2), curvature=True)  # type: ignore[arg-type]
    scene.visible((1, 2, 3), xyz, unproven="visible")  # type: ignore[call-overload]
    scene.line_of_sight((1, 2, 3), (4, 5, 6), unproven="visible")  # type: ignore[call-overload]
    scene.shadow(time=TIME, leaves="yes")  # type: ignore[call-overload]
    scene.shadow(time=TIME, through_trees="some")  # type: ignore[call-overload]
    scene.sun_hours(date=DAY, sun_elevation="true")  # type: ignore[call-overload]
    scene.sky_view(patches="reinhardt")  # type: ignore[call-overload]
    scene.irradiance(clear_sky="inechen")  # type: ignore[call-overload]
    scene.irradiance(clear_sky=True)  # type: ignore[call-overload]
    scene.irradiance(clear_sky="bird", sky_model="preetham")  # type: ignore[call-overload]
    scene.heat(weather="tmy.epw", date=DAY, body="cat")  # type: ignore[call-overload]
    scene.cameras("roof")  # type: ignore[arg-type]
    scene.cameras("roofs", count=1, density="detection")  # type: ignore[arg-type]
    scene.window_views("a.obj", classes={1: "sky"})  # type: ignore[dict-item]
    scene.sunlight_report("a.html", language="es")  # type: ignore[arg-type]
    scene.with_device("cuda")  # type: ignore[arg-type]
    belvedere.Scene(cloud, trees="winter")  # type: ignore[arg-type]
    belvedere.Scene(cloud, orient="down")  # type: ignore[arg-type]
    belvedere.Scene(cloud, without="houses")  # type: ignore[arg-type]
    belvedere.simulate("city")  # type: ignore[arg-type]
    belvedere.read("tile.laz", up="x")  # type: ignore[arg-type]
    belvedere.city.answer("sun", "tiles", "sun.tif")  # type: ignore[arg-type]
    # ---- names and places of arguments
    scene.shadow("2026-06-21T15:00Z")  # type: ignore[call-overload]
    scene.shadow(time=TIME, resolution=1)  # type: ignore[call-overload]
    scene.sun_hours(day=DAY)  # type: ignore[call-overload]
    scene.viewshed((1, 2), height=2)  # type: ignore[call-arg]
    scene.line_of_sight((1, 2, 3))  # type: ignore[call-overload]
    scene.heat(date=DAY)  # type: ignore[call-overload]
    # ---- values
    scene.shadow(time=15)  # type: ignore[call-overload]
    scene.shadow(time=DAY)  # type: ignore[call-overload]
    scene.shadow(sun=180)  # type: ignore[call-overload]
    scene.shadow(time=TIME, cell="1")  # type: ignore[call-overload]
    scene.shadow(time=TIME, targets="places.shp")  # type: ignore[arg-type]
    scene.sun_hours(date=2026)  # type: ignore[call-overload]
    scene.sun_hours(period="2026")  # type: ignore[call-overload]
    scene.sun_hours(date=DAY, zone=2)  # type: ignore[call-overload]
    scene.viewshed((1, 2), azimuth_range_deg=90)  # type: ignore[arg-type]
    scene.viewshed("tower")  # type: ignore[arg-type]
    scene.with_terrain(scene.viewshed((1, 2)))  # type: ignore[arg-type]
    scene.sunlight_report("a.html", planned="plan.obj")  # type: ignore[arg-type]
    scene.depth_map(eye=(1, 2, 3), size=512)  # type: ignore[arg-type]
    belvedere.Cloud("tile.laz")  # type: ignore[arg-type]
    belvedere.read("tile.laz", classes=2)  # type: ignore[arg-type]
    # ---- results
    scene.sun_hours(date=DAY).mean()  # type: ignore[attr-defined]
    scene.sun_hours(date=DAY) + 1  # type: ignore[operator]
    _ = scene.shadow(time=TIME)["lit"].values  # type: ignore[call-overload]
    scene.shadow(time=[TIME]).to_geotiff("day.tif")  # type: ignore[attr-defined]
    _ = scene.visible((1, 2, 3), xyz).answer  # type: ignore[attr-defined]
    scene.line_of_sight((1, 2, 3), (4, 5, 6))["answer"]  # type: ignore[call-overload]
    _ = scene.line_of_sight((1, 2, 3), [(4, 5, 6)]).answer  # type: ignore[attr-defined]
    scene.viewshed((1, 2)).to_pandas()  # type: ignore[attr-defined]
    scene.viewshed((1, 2)) + "a"  # type: ignore[arg-type]
    scene.network(xyz)[0]  # type: ignore[index]
