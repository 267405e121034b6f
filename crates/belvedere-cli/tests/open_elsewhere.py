"""Results open in the programs they are made for: rasterio (GDAL), geopandas and laspy.

Usage: open_elsewhere.py BELVEDERE FOLDER
"""

import json
import subprocess
import sys
from pathlib import Path

import geopandas
import laspy
import numpy
import rasterio

belvedere, folder = sys.argv[1], Path(sys.argv[2])


def run(*words):
    command = [belvedere, "--json", *map(str, words)]
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


run("demo", "-o", folder)
town, balls = folder / "town.laz", folder / "balls.npz"
scene = [balls, "--ground", f"cloud={town}"]
x, y = 155000, 462985
outputs = {name: folder / f"seen.{name}" for name in ("tif", "geojson", "laz", "png")}
flags = [flag for path in outputs.values() for flag in ("-o", path)]
heights, masks = folder / "heights.tif", folder / "masks.npy"
told = run("viewshed", *scene, "--observer", f"{x},{y}", "--max-distance", 40, "--heights", heights, *flags)

with rasterio.open(outputs["tif"]) as raster:
    seen = raster.read(1)
    assert raster.dtypes == ("uint8",) and raster.nodata == 254, (raster.dtypes, raster.nodata)
    assert raster.crs.to_epsg() in (7415, 28992), raster.crs
    assert raster.res == (0.5, 0.5) and raster.bounds.left % 0.5 == 0, raster.transform
    assert set(numpy.unique(seen)) <= {0, 128, 254, 255} and (seen == 255).sum() == told["cells"]["visible"]
    row, column = raster.index(x, y)
    near = seen[row - 2 : row + 2, column - 2 : column + 2]
    assert (near == 255).mean() > 0.5, near
    transform, shape = raster.transform, seen.shape
with rasterio.open(heights) as raster:
    values = raster.read(1, masked=True)
    assert raster.nodata == -9999 and raster.transform == transform
    # what the balls alone let see is seen at height 0, proven or not
    assert ((values.filled(1) == 0) == numpy.isin(seen, (128, 255))).mean() > 0.999

areas = geopandas.read_file(outputs["geojson"])
assert areas.crs.to_epsg() == 4326 and areas.geometry.is_valid.all(), areas
plane = areas.to_crs(28992)
visible = plane[plane.answer == "visible"]
assert abs(visible.area.sum() - (seen == 255).sum() * 0.25) < 0.01 * visible.area.sum()
# 0.3 m: what grids of datum shifts move between programs
centre = geopandas.points_from_xy([x], [y], crs=28992)[0]
assert visible.distance(centre).min() < 1.5

cloud = laspy.read(outputs["laz"])
assert cloud.header.parse_crs() is not None
assert len(cloud) == laspy.read(town).header.point_count
assert set(numpy.unique(cloud["answer"])) <= {0, 1, 2, 3} and (cloud["answer"] == 1).any()

# a walk as GeoJSON in WGS 84, written by geopandas
line = geopandas.GeoSeries.from_wkt([f"LINESTRING ({x} {y}, {x} {y + 20})"], crs=28992).to_crs(4326)
line.to_file(folder / "walk.geojson", driver="GeoJSON")
count = folder / "count.tif"
told = run("viewshed", *scene, "--observers", folder / "walk.geojson", "--cell", 1, "--masks", masks, "-o", count)
assert told["observers"]["count"] in (5, 6), told["observers"]
with rasterio.open(count) as raster:
    counts = raster.read(1)
    assert raster.dtypes == ("uint16",) and raster.nodata == 65535
bits = numpy.load(masks)
assert bits.shape == (1, *counts.shape) and (numpy.bitwise_count(bits[0]) == counts).all()
# a landmark as a raster, and a horizon as a table of one elevation an azimuth, from north on
share = folder / "share.tif"
told = run("landmark", *scene, "--target", folder / "town.obj", "--max-distance", 60, "--cell", 10, "-o", share)
with rasterio.open(share) as raster:
    values = raster.read(1, masked=True)
    assert raster.dtypes == ("float32",) and raster.crs.to_epsg() in (7415, 28992), (raster.dtypes, raster.crs)
    assert raster.res == (10, 10) and values.count() > 50 and 0 < values.max() <= 1 and values.min() >= 0, values
horizon = folder / "horizon.csv"
run("horizon", *scene, "--eye", f"{x},{y}", "--north", "true", "-o", horizon)
table = numpy.genfromtxt(horizon, delimiter=",", names=True)
assert len(table) == 360 and (table[table.dtype.names[0]] == numpy.arange(360)).all(), table.dtype.names
assert 0 <= table[table.dtype.names[1]].min() and 10 < table[table.dtype.names[1]].max() < 90
print("rasterio", rasterio.__version__, "geopandas", geopandas.__version__, "laspy", laspy.__version__, "open all results")
