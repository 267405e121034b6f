"""Results open in the programs they are made for: rasterio (GDAL), geopandas, laspy and Pillow.

Usage: open_elsewhere.py BELVEDERE FOLDER
"""

import json
import shutil
import subprocess
import sys
from pathlib import Path

import geopandas
import laspy
import numpy
import PIL
import rasterio
from PIL import Image

belvedere, folder = sys.argv[1], Path(sys.argv[2])


def run(*words):
    command = [belvedere, "--json", *map(str, words)]
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


# what is left of an earlier program may have another plan
shutil.rmtree(folder, ignore_errors=True)
run("demo", "-o", folder)
town, balls = folder / "town.laz", folder / "balls.npz"
scene = [balls, "--ground", f"cloud={town}"]
x, y = 155000, 462985
outputs = {name: folder / f"seen.{name}" for name in ("tif", "geojson", "laz", "png")}
flags = [flag for path in outputs.values() for flag in ("-o", path)]
heights, masks = folder / "heights.tif", folder / "masks.npy"
of_ground = ["--observer", f"{x},{y}", "--max-distance", 40, "--target-height", 0]
result = run("viewshed", *scene, *of_ground, "--heights", heights, *flags)

with rasterio.open(outputs["tif"]) as raster:
    seen = raster.read(1)
    unproven = raster.read(2)
    assert raster.dtypes == ("uint8", "uint8") and raster.nodatavals == (255, 255), (raster.dtypes, raster.nodata)
    assert raster.descriptions == ("visible", "unproven"), raster.descriptions
    assert raster.crs.to_epsg() in (7415, 28992), raster.crs
    assert raster.res == (0.5, 0.5) and raster.bounds.left % 0.5 == 0, raster.transform
    assert set(numpy.unique(seen)) <= {0, 1, 255} and set(numpy.unique(unproven)) <= {0, 1, 255}
    proven = (seen == 1) & (unproven == 0)
    assert proven.sum() == result["cells"]["visible"] and (unproven == 1).sum() == result["cells"]["unproven"]
    row, column = raster.index(x, y)
    near = seen[row - 2 : row + 2, column - 2 : column + 2]
    assert (near == 1).mean() > 0.5, near
    transform, shape = raster.transform, seen.shape
with rasterio.open(heights) as raster:
    values = raster.read(1, masked=True)
    assert raster.nodata == -9999 and raster.transform == transform
    # what the balls alone let see is seen at height 0, proven or not
    assert ((values.filled(1) == 0) == (seen == 1)).mean() > 0.999

areas = geopandas.read_file(outputs["geojson"])
assert areas.crs.to_epsg() == 4326 and areas.geometry.is_valid.all(), areas
plane = areas.to_crs(28992)
visible = plane[plane.answer == "visible"]
assert abs(visible.area.sum() - proven.sum() * 0.25) < 0.01 * visible.area.sum()
# 0.3 m: what grids of datum shifts move between programs
centre = geopandas.points_from_xy([x], [y], crs=28992)[0]
assert visible.distance(centre).min() < 1.5

cloud = laspy.read(outputs["laz"])
assert cloud.header.parse_crs() is not None
assert len(cloud) == laspy.read(town).header.point_count
assert set(numpy.unique(cloud["answer"])) <= {0, 1, 2, 3} and (cloud["answer"] == 1).any()

# points on roofs and walls, whose numbers are those of the lines and places in the GeoJSON
lines, points = folder / "surfaces.geojson", folder / "surfaces.laz"
run("surfaces", town, "-o", lines, "-o", points)
cloud, found = laspy.read(points), geopandas.read_file(lines)
assert cloud.header.parse_crs() is not None and set(numpy.unique(cloud["kind"])) == {1, 2}
assert abs(cloud["distance"]).max() < 0.3
for code, kind in enumerate(("roof", "wall"), 1):
    numbers = found[found.kind == kind][kind].astype(int)
    assert set(numpy.unique(cloud["number"][cloud["kind"] == code])) <= set(numbers), kind

# a walk as GeoJSON in WGS 84, written by geopandas
line = geopandas.GeoSeries.from_wkt([f"LINESTRING ({x} {y}, {x} {y + 20})"], crs=28992).to_crs(4326)
line.to_file(folder / "walk.geojson", driver="GeoJSON")
count = folder / "count.tif"
result = run("viewshed", *scene, "--observers", folder / "walk.geojson", "--cell", 1, "--masks", masks, "-o", count)
assert result["observers"]["count"] in (5, 6), result["observers"]
with rasterio.open(count) as raster:
    counts, unproven = raster.read(1, masked=True), raster.read(2, masked=True)
    assert raster.dtypes == ("uint16", "uint16") and raster.nodatavals == (65535, 65535)
    assert raster.descriptions == ("observers", "unproven"), raster.descriptions
bits = numpy.load(masks)
assert bits.shape == (1, *counts.shape) and (numpy.bitwise_count(bits[0]) == (counts - unproven).filled(0)).all()
# a landmark as a raster, and a horizon as a table of one elevation an azimuth, from north on
share = folder / "share.tif"
result = run("landmark", *scene, "--targets", folder / "town.obj", "--max-distance", 60, "--cell", 10, "-o", share)
with rasterio.open(share) as raster:
    values = raster.read(1, masked=True)
    assert raster.dtypes == ("float32",) and raster.crs.to_epsg() in (7415, 28992), (raster.dtypes, raster.crs)
    assert raster.res == (10, 10) and values.count() > 50 and 0 < values.max() <= 1 and values.min() >= 0, values
horizon = folder / "horizon.csv"
run("horizon", *scene, "--observer", f"{x},{y}", "-o", horizon)
table = numpy.genfromtxt(horizon, delimiter=",", names=True)
assert len(table) == 360 and (table[table.dtype.names[0]] == numpy.arange(360)).all(), table.dtype.names
assert 0 <= table[table.dtype.names[1]].min() and 10 < table[table.dtype.names[1]].max() < 90

# shadow at three hours of a morning: as rasters, a raster of one sun, and a film
day = ["--from", "2026-06-21T08:00+02:00", "--to", "2026-06-21T11:00+02:00", "--time-step-min", 60, "--cell", 2]
lit, film, rasters = folder / "lit.tif", folder / "film.png", folder / "lit"
result = run("shadow", *scene, *day, "-o", lit, "--film", film, "--measures", rasters)
suns = result["sun"]["suns"]
assert suns in (3, 4), result["sun"]
with rasterio.open(lit) as raster:
    values = raster.read(1, masked=True)
    assert raster.dtypes == ("uint8",) * suns and raster.nodata == 255 and raster.res == (2, 2), raster.meta
    assert raster.crs.to_epsg() in (7415, 28992), raster.crs
    assert set(numpy.unique(values.compressed())) == {0, 1}
    # the file says what it shows: command, question, zone, and the sun of each band
    tags = raster.tags()
    assert tags["COMMAND"].startswith("belvedere shadow balls.npz --from 2026-06-21T08:00+02:00"), tags
    assert tags["COMMAND"].endswith("--cell 2 --ground cloud=town.laz"), tags
    assert str(folder) not in str(tags) and tags["TIFFTAG_SOFTWARE"].startswith("belvedere "), tags
    assert json.loads(tags["QUESTION"])["shadow"]["suns"]["days"]["between"][0] == "2026-06-21T08:00+02:00", tags
    assert tags["TIME_ZONE"] == "+02" and raster.units == ("1",) * suns, (tags, raster.units)
    times = [raster.tags(band)["TIME"] for band in raster.indexes]
    assert times == sorted(times) and times[0].startswith("2026-06-21T08:") and times[0].endswith("+02:00"), times
    sun_elevations = [float(raster.tags(band)["SUN_ELEVATION_DEG"]) for band in raster.indexes]
    assert sun_elevations == sorted(sun_elevations) and 15 < sun_elevations[0] < 30, sun_elevations
    # each sun is a band, named like its file
    assert all(name.startswith("lit_20260621_") for name in raster.descriptions), raster.descriptions
    for band, name in enumerate(raster.descriptions, 1):
        with rasterio.open(rasters / f"{name}.tif") as own:
            assert (own.read(1) == raster.read(band)).all() and own.descriptions == (name,)
assert len(list(rasters.glob("lit_20260621_*.tif"))) == suns
with Image.open(film) as frames:
    assert frames.format == "PNG" and frames.n_frames == suns and frames.info["loop"] == 0, frames.info
    shaded = []
    for number in range(suns):
        frames.seek(number)
        shaded.append(numpy.asarray(frames.convert("RGB")))
    # each frame is that of its sun: what differs from the first is not only its title
    assert all((shaded[0][100:] != other[100:]).any() for other in shaded[1:])

hours = folder / "hours.tif"
measures = folder / "sun"
result = run("sun-hours", *scene, "--date", "2026-06-21", "--time-step-min", 60, "--cell", 2, "-o", hours, "--measures", measures)
with rasterio.open(hours) as raster, rasterio.open(measures / "sun_share.tif") as shares:
    values, share = raster.read(1, masked=True), shares.read(1, masked=True)
    assert raster.transform == shares.transform and raster.nodata == -9999
    # a system with heights in metres gives bands no unit of its own
    assert raster.units[:2] == ("h", "1") and shares.units == ("1",), (raster.units, shares.units)
    # 16 h 45 min between sunrise and sunset at 52.2 degrees north
    assert 0 <= values.min() and 10 < values.max() < 16.8, values
    assert abs(values / share - (values / share).mean()).max() < 0.01

# a ground cloud that names no system has that of the balls
bare = folder / "bare.csv"
points = laspy.read(town)
columns = numpy.column_stack([points.x, points.y, points.z, points.classification])
numpy.savetxt(bare, columns, fmt="%.3f,%.3f,%.3f,%d", header="x,y,z,classification", comments="")
run("shadow", balls, "--ground", f"cloud={bare}", "--sun", "235,30", "--cell", 2, "-o", lit)
with rasterio.open(lit) as raster:
    assert raster.crs.to_epsg() in (7415, 28992), raster.crs

sky = folder / "sky.laz"
run("sky-view", town, "--self", "--directions", 64, "-o", sky)
cloud = laspy.read(sky)
assert cloud.header.parse_crs() is not None and len(cloud) == laspy.read(town).header.point_count
for name in ("sky_view_factor", "sky_openness"):
    assert 0 <= cloud[name].min() and 0.9 < cloud[name].max() <= 1.01, name
    # roofs see more of the sky than the ground
    assert cloud[name][cloud.classification == 6].mean() > cloud[name][cloud.classification == 2].mean(), name

# a city in tiles: the merged raster is cloud-optimised and holds what the tiles hold
city, merged = folder / "city", folder / "city.tif"
run("city", "plan", town, "--sun", "235,30", "--sky-view", "--directions", 49, "--cell", 0.125, "--tile-size", 64, "-o", city)
run("city", "run", city)
for result, kind, nodata, names in (
    ("shadow_235_30", "uint8", 255, ("lit", "unproven")),
    ("sky_view_factor", "float32", -9999, ("sky_view_factor", "sky_openness")),
):
    run("city", "merge", city, "--result", result, "-o", merged)
    with rasterio.open(merged) as raster, rasterio.open(city / f"{result}.vrt") as tiles:
        values = raster.read(1)
        assert set(raster.dtypes) == {kind} and raster.descriptions == names and raster.nodata == tiles.nodata == nodata, raster.meta
        assert raster.crs.to_epsg() in (7415, 28992) and raster.res == tiles.res
        # the merged raster ends with the cloud, and whole tiles have no value beyond
        window = tiles.window(*raster.bounds).round_offsets().round_lengths()
        assert tiles.window_bounds(window) == tuple(raster.bounds), (window, raster.bounds)
        assert values.size < tiles.width * tiles.height and (values == tiles.read(1, window=window)).all()
        assert (values != nodata).sum() == (tiles.read(1) != nodata).sum() > 0
        what = raster.tags()["TIFFTAG_IMAGEDESCRIPTION"]
        assert tiles.tags()["TIFFTAG_IMAGEDESCRIPTION"] == what and tiles.descriptions == names, tiles.tags()
        levels = raster.overviews(1)
        assert set(raster.block_shapes) == {(512, 512)} and levels[0] == 2 and max(raster.shape) / levels[-1] <= 512, levels
        # directories come first and in order; of the data, the coarsest level comes first
        numbers = [None, *range(len(levels))]
        directories = [int(raster.get_tag_item("IFD_OFFSET", "TIFF", bidx=1, ovr=n)) for n in numbers]
        blocks = [int(raster.get_tag_item("BLOCK_OFFSET_0_0", "TIFF", bidx=1, ovr=n)) for n in numbers]
        assert directories[0] == 8 and directories == sorted(directories) and max(directories) < min(blocks), directories
        assert blocks == sorted(blocks, reverse=True), blocks
    # values of a coarser level lie between those of the pixels below
    with rasterio.open(merged, overview_level=0) as coarse:
        seen, four = coarse.read(1), values[: 2 * (len(values) // 2), : 2 * (values.shape[1] // 2)]
        four = numpy.ma.masked_equal(four.reshape(len(four) // 2, 2, -1, 2), nodata)
        seen = numpy.ma.masked_equal(seen[: four.shape[0], : four.shape[2]], nodata)
        low, high = four.min(axis=(1, 3)), four.max(axis=(1, 3))
        assert (seen.mask == low.mask).all() and (seen >= low - 1e-6).all() and (seen <= high + 1e-6).all()

print("rasterio", rasterio.__version__, "geopandas", geopandas.__version__, "laspy", laspy.__version__)
print("and Pillow", PIL.__version__, "open all results")
