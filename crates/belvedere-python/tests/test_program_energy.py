"""Irradiance, roofs and heat are those of the command line, bit by bit."""

from __future__ import annotations

import json

import numpy as np
import pytest
from rasters import assert_same_raster

rasterio = pytest.importorskip("rasterio")


def test_roof_planes(scene, run_program, folder):
    pandas = pytest.importorskip("pandas")
    flags = ["--clear-sky", "ineichen", "--sun-cell-deg", 6, "--patch-division", 1, "--months", "--panel", 2]
    files = ["--planes", "roofs.csv", "--buildings", "buildings.csv", "--hourly", "hours", "--dc-ac-ratio", 1.1]
    run_program("irradiance", "tile.laz", *flags, "--through-trees", "seasons", *files)
    theirs = pandas.read_csv(folder / "roofs.csv", dtype=str)
    ours = scene.roof_planes(
        clear_sky="ineichen",
        sun_cell_deg=6,
        patch_division=1,
        months=True,
        panel=2,
        through_trees="seasons",
        dc_ac_ratio=1.1,
        hourly=True,
    )
    assert ours.row_count == len(theirs) > 2
    places = dict(zip("xyz", ours.places.T, strict=True))
    assert set(theirs.columns) == {"plane", *places, *ours}
    is_as_written(places | dict(ours), theirs)
    is_as_written(ours.buildings, pandas.read_csv(folder / "buildings.csv", dtype=str))
    assert len(ours.hours) == ours.row_count
    is_as_written(ours.hours[1], pandas.read_csv(folder / "hours" / "plane_2.csv", dtype=str))


def is_as_written(columns, theirs):
    for name, values in columns.items():
        if values.dtype.kind == "U":
            assert list(values) == list(theirs[name]), name
            continue
        decimals = max(len(cell.partition(".")[2]) for cell in theirs[name].fillna(""))
        written = theirs[name].astype(float).to_numpy()
        assert np.array_equal(np.isnan(values), np.isnan(written)), name
        assert np.nanmax(np.abs(values - written), initial=0) <= 0.5001 * 10.0**-decimals, name


def test_irradiance(scene, run_program, folder):
    run_program(
        *("irradiance", "tile.laz", "--clear-sky", "ineichen", "--cell", 8, "--through-trees", "seasons"),
        *("-o", "energy.tif", "--measures", "energy"),
    )
    rasters = scene.irradiance(clear_sky="ineichen", cell=8, through_trees="seasons")
    assert {path.stem for path in (folder / "energy").iterdir()} == set(rasters)
    for measure, raster in rasters.items():
        assert_same_raster(raster, folder / "energy" / f"{measure}.tif", folder)


def test_heat(scene, run_program, folder, hot_day):
    run_program(
        *("heat", "tile.laz", "--weather", hot_day, "--date", "07-21", "--zone", "Europe/Amsterdam", "--cell", 8),
        *("--between", "10:00,16:00", "--pet", "--by-hour", "-o", "heat.tif", "--measures", "heat"),
    )
    rasters = scene.heat(
        weather=hot_day, date="07-21", zone="Europe/Amsterdam", cell=8, between=(10, 16), pet=True, by_hour=True
    )
    assert {path.stem for path in (folder / "heat").iterdir()} == set(rasters)
    for measure, raster in rasters.items():
        assert_same_raster(raster, folder / "heat" / f"{measure}.tif", folder)
    tags = rasters["tmrt_20150721_1400"].tags
    assert tags["TIME"].startswith("2015-07-21T14:00") and tags["TIME_ZONE"] == "Europe/Amsterdam"
    with rasterio.open(folder / "heat.tif") as file:
        assert json.loads(tags["QUESTION"]) == json.loads(file.tags()["QUESTION"]), tags
