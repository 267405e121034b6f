"""Results are those of the command line, bit by bit."""

from __future__ import annotations

import csv
import json
import pickle
import warnings

import belvedere
import numpy as np
import pytest
from rasters import assert_same_raster


def test_ball_files_are_the_same_bytes(scene, run_program, folder):
    run_program("balls", "tile.laz", "-o", "cli.npz")
    scene.save(folder / "python.npz")
    ours, theirs = np.load(folder / "python.npz"), np.load(folder / "cli.npz")
    assert sorted(ours) == sorted(theirs)
    for name in set(ours) - {"metadata"}:
        assert ours[name].tobytes() == theirs[name].tobytes(), name


@pytest.mark.parametrize(
    ("name", "flags", "arguments"),
    [
        ("time", ["--time", "2026-06-21T15:00+02:00"], {"time": "2026-06-21T15:00+02:00"}),
        ("clock", ["--time", "2026-06-21T15:00"], {"time": "2026-06-21T15:00"}),
        ("sun", ["--sun", "200,25"], {"sun": (200, 25)}),
        ("soft", ["--sun", "200,25", "--soft"], {"sun": (200, 25), "soft": True}),
        ("top", ["--sun", "120,40", "--surface", "--cell", "1"], {"sun": (120, 40), "surface": True, "cell": 1}),
        (
            "trees",
            ["--time", "2026-01-21T12:00Z", "--through-trees", "seasons"],
            {"time": "2026-01-21T12:00Z", "through_trees": "seasons"},
        ),
    ],
)
def test_shadow(scene, run_program, folder, name, flags, arguments):
    run_program("shadow", "tile.laz", *flags, "-o", f"shadow_{name}.tif")
    assert_same_raster(scene.shadow(**arguments), folder / f"shadow_{name}.tif", folder)


@pytest.mark.parametrize(
    ("name", "flags", "arguments"),
    [
        (
            "day",
            ["--date", "2026-03-21", "--zone", "Europe/Amsterdam"],
            {"date": "2026-03-21", "zone": "Europe/Amsterdam"},
        ),
        (
            "days",
            ["--from", "2026-06-01", "--to", "2026-06-05", "--time-step-min", "30", "--rule", "nl-light"],
            {"period": ("2026-06-01", "2026-06-05"), "time_step_min": 30, "rule": "nl-light", "year": 2026},
        ),
    ],
)
def test_sun_hours(scene, run_program, folder, name, flags, arguments):
    run_program("sun-hours", "tile.laz", *flags, "--cell", 2, "-o", f"sun_{name}.tif", "--measures", f"sun_{name}")
    rasters = scene.sun_hours(**arguments, cell=2)
    assert {path.stem for path in (folder / f"sun_{name}").iterdir()} == set(rasters)
    for measure, raster in rasters.items():
        assert_same_raster(raster, folder / f"sun_{name}" / f"{measure}.tif", folder)


def test_sky_view(scene, run_program, folder):
    run_program("sky-view", "tile.laz", "--cell", 2, "-o", "sky.tif", "--measures", "sky")
    for measure, raster in scene.sky_view(cell=2).items():
        assert_same_raster(raster, folder / "sky" / f"{measure}.tif", folder)


@pytest.fixture(scope="session")
def block(cloud, folder):
    """A mesh of two objects above the town: a box with its walls, and a roof that leans."""
    low, high = cloud.bounds
    x, y = ((low + high) / 2)[:2].round()
    z = float(round(high[2]))
    corners = [(x + a, y + b, z + c) for c in (0, 3) for a, b in ((0, 0), (4, 0), (4, 4), (0, 4))]
    corners += [(x + 6, y, z), (x + 9, y, z), (x + 9, y + 3, z + 2)]
    quads = [(0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7), (4, 5, 6, 7)]
    triangles = [row for a, b, c, d in quads for row in ((a, b, c), (a, c, d))] + [(8, 9, 10)]
    lines = [f"v {x} {y} {z}" for x, y, z in corners] + ["o box"]
    faces = [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in triangles]
    (folder / "block.obj").write_text("\n".join([*lines, *faces[:-1], "o roof", faces[-1]]) + "\n")
    objects = [0] * 10 + [1]
    return belvedere.Mesh(corners, triangles, objects=objects, object_names=["box", "roof"])


def rows_of(path):
    """Rows of objects and of faces."""
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    return [row for row in rows if not row["face"]], [row for row in rows if row["face"]]


def assert_same_rows(table, path):
    for ours, rows in zip((table.objects, table), rows_of(path), strict=True):
        assert list(ours["object"]) == [row["object"] for row in rows]
        for name in set(ours) - {"object"}:
            for value, row in zip(ours[name], rows, strict=True):
                # to the digits that the program writes
                digits = len(row[name].partition(".")[2])
                assert abs(value - float(row[name])) <= 0.5000001 * 10.0**-digits, (name, row)


# the block hangs above the town, which is said
@pytest.mark.filterwarnings("ignore:.* floats:belvedere.BelvedereWarning")
def test_faces_of_a_mesh(scene, run_program, folder, block):
    read = belvedere.Mesh.read(folder / "block.obj")
    assert np.array_equal(read.vertices[read.triangles], block.vertices[block.triangles])
    assert read.object_names == block.object_names and np.array_equal(read.objects, block.objects)
    again = pickle.loads(pickle.dumps(block.sampled(spacing=1)))
    arguments = ["tile.laz", "--targets", "block.obj", "-o"]
    run_program("shadow", *arguments, "lit_faces.csv", "--sun", "200,25")
    lit = scene.shadow(sun=(200, 25), targets=block)
    assert_same_rows(lit, folder / "lit_faces.csv")
    # no point of the town is as high: faces turned to the sun are lit, the others are not
    assert lit["lit"][:10].tolist() == [1, 1, 0, 0, 0, 0, 1, 1, 1, 1]
    run_program("sun-hours", *arguments, "hours_faces.csv", "--date", "2026-03-21", "--zone", "Europe/Amsterdam")
    day = {"date": "2026-03-21", "zone": "Europe/Amsterdam"}
    assert_same_rows(scene.sun_hours(targets=block, **day), folder / "hours_faces.csv")
    run_program("sky-view", *arguments, "sky_faces.csv", "--spacing", 1, "--facing", "level")
    assert_same_rows(scene.sky_view(targets=again.sampled(spacing=1, facing="level")), folder / "sky_faces.csv")
    x, y, z = block.vertices[0]
    run_program(
        "query", *arguments, "seen_faces.csv", "--eye", f"{x + 2},{y - 20},{z + 1}", "--look-at", f"{x + 2},{y},{z}"
    )
    seen = scene.visible((x + 2, y - 20, z + 1), read)
    # of the box only the wall before the eye is turned to it
    assert (seen["visible_share"][:10] > 0.99).tolist() == [True] * 2 + [False] * 8
    landmark = scene.landmark(block, objects="box", observers=[(x + 2, y - 20, z + 1)])
    from_file = scene.landmark(folder / "block.obj", objects="box", observers=[(x + 2, y - 20, z + 1)])
    assert landmark["visible_area_m2"].tolist() == from_file["visible_area_m2"].tolist()
    above = [(x + 2, y + 2, z - 0.5)], [(x + 2, y + 2, z + 9)]
    planned = [s.line_of_sight(*above)["answer"][0] for s in (scene.with_added(block), scene.with_added(read))]
    assert planned == [belvedere.Answer.BLOCKED] * 2


def test_viewsheds(scene, run_program, folder, standing):
    x, y = standing
    others = [(x, y), (x + 1, y + 1)]
    run_program("viewshed", "tile.laz", "--observer", f"{x},{y}", "--max-distance", 40, "-o", "one.tif")
    assert_same_raster(scene.viewshed((x, y), max_distance=40), folder / "one.tif", folder)
    limits = ["--azimuth-range", "300,60", "--observer-height", "3", "--cell", "1"]
    typed = [part for place in others for part in ("--observer", f"{place[0]},{place[1]}")]
    run_program("viewshed", "tile.laz", *typed, *limits, "-o", "two.tif")
    ours = scene.viewshed(others, azimuth_range_deg=(300, 60), observer_height=3, cell=1)
    assert_same_raster(ours, folder / "two.tif", folder)


@pytest.mark.parametrize(
    ("name", "flags", "arguments"),
    [
        ("ground", [], {}),
        ("high", ["--target-height", "12", "--observer-height", "3"], {"target_height": 12, "observer_height": 3}),
        ("near", ["--max-distance", "30", "--cell", "1"], {"max_distance": 30, "cell": 1}),
    ],
)
def test_cells_from_which_a_target_is_seen(scene, run_program, folder, standing, name, flags, arguments):
    x, y = standing
    run_program("viewshed", "tile.laz", "--target", f"{x},{y}", *flags, "-o", f"from_{name}.tif")
    ours = scene.viewshed(target=(x, y), **arguments)
    assert_same_raster(ours, folder / f"from_{name}.tif", folder)
    # it is no viewshed of an observer there: heights are those of the other end
    if name == "high":
        assert not np.array_equal(ours.values, scene.viewshed((x, y), **arguments).values)


def test_stations_of_a_scanner_on_the_ground(run_program, folder):
    simulated = ["--scanner", "terrestrial", "--extent", 60, "--stations", 2, "--angle-step-deg", 1]
    run_program("simulate", "town", *simulated, "-o", "tripods")
    table = folder / "tripods" / "stations.csv"
    run_program("balls", "tripods/cloud.laz", "--orient", f"stations={table}", "-o", "tripods.npz")
    theirs = np.load(folder / "tripods.npz")
    rows = np.loadtxt(table, delimiter=",", skiprows=1)
    with pytest.warns(belvedere.BelvedereWarning, match="extra bytes"):
        cloud = belvedere.read(folder / "tripods" / "cloud.laz")
    for given in (table, rows, {int(row[0]): row[1:] for row in rows}):
        scene = belvedere.Scene(cloud, stations=given)
        scene.save(folder / "python_tripods.npz")
        ours = np.load(folder / "python_tripods.npz")
        for name in set(theirs) - {"metadata"}:
            assert ours[name].tobytes() == theirs[name].tobytes(), name
    # the places count: with those of the other station the pulses come from elsewhere
    other = belvedere.Scene(cloud, stations=np.column_stack([rows[::-1, 0], rows[:, 1:]]))
    assert other.report["normals"] != scene.report["normals"]


def test_horizons_and_isovists(scene, run_program, folder, standing):
    pandas = pytest.importorskip("pandas")
    x, y = standing
    run_program("horizon", "tile.laz", "--observer", f"{x},{y}", "-o", "horizon.csv")
    theirs = pandas.read_csv(folder / "horizon.csv")
    # so small a tile could have something higher beyond its edge
    with pytest.warns(belvedere.BelvedereWarning, match="% of the azimuths are near the edge of the cloud") as caught:
        azimuths, elevations = scene.horizon((x, y))
    assert [one.message.key for one in caught] == ["horizon-near-edge"]
    assert np.array_equal(azimuths, theirs["azimuth"])
    assert np.abs(np.maximum(elevations, 0) - theirs["elevation"]).max() < 6e-5
    run_program("isovist", "tile.laz", "--observer", f"{x},{y}", "-o", "isovist.csv")
    theirs = pandas.read_csv(folder / "isovist.csv")
    ours = scene.isovist((x, y))
    assert list(theirs.columns[3:]) == list(ours)
    for name in ours:
        assert ours[name][0] == pytest.approx(theirs[name][0], abs=6e-3), name


def test_visible_targets(scene, cloud, run_program, folder, eye):
    x, y, z = eye
    np.save(folder / "targets.npy", cloud.xyz)
    run_program("query", "tile.laz", "--panorama", f"{x},{y},{z}", "--self", "-o", "seen.npy")
    assert np.array_equal(scene.visible(eye, cloud), np.load(folder / "seen.npy"))
    assert np.array_equal(scene.visible(eye, cloud.xyz), np.load(folder / "seen.npy"))


def test_lines_of_sight(scene, run_program, folder, eye, targets):
    pandas = pytest.importorskip("pandas")
    table = pandas.DataFrame(np.column_stack([np.tile(eye, (len(targets), 1)), targets]))
    table.to_csv(folder / "pairs.csv", header=["ax", "ay", "az", "bx", "by", "bz"], index=False)
    run_program("line-of-sight", "tile.laz", "--pairs", "pairs.csv", "-o", "sights.csv")
    theirs = pandas.read_csv(folder / "sights.csv")
    # half a metre above a point of a crown or below a roof is inside of it
    with pytest.warns(belvedere.BelvedereWarning, match="have an end inside an obstacle") as caught:
        sights = scene.line_of_sight(eye, targets)
    ours = sights.to_pandas()
    assert (ours["answer"] == theirs["answer"]).all()
    assert [one.message.key for one in caught] == ["lines-inside-obstacle"]
    assert caught[0].message.numbers["count"] == (ours["answer"] == belvedere.Answer.INSIDE_OBSTACLE).sum()
    for name in ("first_block_range_m", "unproven_m", "block_x", "block_y", "block_z"):
        assert np.allclose(ours[name], theirs[name], rtol=0, atol=6e-4, equal_nan=True), name
    assert (ours["block_ball"] == theirs["block_ball"].fillna(-1)).all()


def test_lines_of_sight_without_heights(scene, run_program, folder, standing, targets):
    pandas = pytest.importorskip("pandas")
    flat = np.column_stack([np.tile(standing, (len(targets), 1)), targets[:, :2]])
    pandas.DataFrame(flat).to_csv(folder / "flat.csv", header=["ax", "ay", "bx", "by"], index=False)
    run_program("line-of-sight", "tile.laz", "--pairs", "flat.csv", "--target-height", 1, "-o", "flat-sights.csv")
    theirs = pandas.read_csv(folder / "flat-sights.csv")
    # a metre above the ground, below roofs and crowns
    with pytest.warns(belvedere.BelvedereWarning, match="have an end inside an obstacle") as caught:
        ours = scene.line_of_sight(standing, targets[:, :2], target_height=1)
    assert [one.message.key for one in caught] == ["lines-inside-obstacle"]
    assert caught[0].message.numbers["count"] == (ours["answer"] == belvedere.Answer.INSIDE_OBSTACLE).sum()
    assert np.abs(ours.places[:, 2] - theirs["bz"]).max() < 6e-5
    assert (ours["answer"] == theirs["answer"]).all() and len(set(ours["answer"])) > 1


def test_simulated_points_are_those_of_the_program(run_program, folder):
    run_program("simulate", "town", "--extent", 80, "--density", 6, "--seed", 3, "-o", "town")
    with pytest.warns(belvedere.BelvedereWarning, match="extra bytes"):
        theirs = belvedere.read(folder / "town" / "cloud.laz")
    ours = belvedere.read(folder / "tile.laz")
    assert len(ours) == len(theirs)
    assert np.array_equal(ours.attributes["gps_time"], theirs.attributes["gps_time"])
    assert np.abs(ours.xyz - theirs.xyz).max() < 2e-3


def test_landmarks(scene, run_program, folder, standing):
    x, y = standing
    run_program(
        "landmark",
        "tile.laz",
        "--target-class",
        6,
        "--cell",
        16,
        "--max-distance",
        60,
        "-o",
        "share.tif",
        "--measures",
        "landmark",
    )
    rasters = scene.landmark(target_class=6, cell=16, max_distance=60)
    assert {path.stem for path in (folder / "landmark").iterdir()} == set(rasters)
    for measure, raster in rasters.items():
        assert_same_raster(raster, folder / "landmark" / f"{measure}.tif", folder)


def test_protected_views(scene, run_program, folder, standing):
    x, y = standing
    typed = ["--observer", f"{x},{y}", "--target-class", 6, "--cell", 2, "--max-distance", 60]
    run_program("protected-view", "tile.laz", *typed, "-o", "limits.tif", "--tops", "limit_tops.tif")
    limits = scene.protected_view((x, y), target_class=6, cell=2, max_distance=60)
    assert_same_raster(limits["height"], folder / "limits.tif", folder)
    assert_same_raster(limits["top"], folder / "limit_tops.tif", folder)
    assert np.isfinite(limits["height"].values).any()
    with pytest.warns(belvedere.BelvedereWarning, match="nothing is protected"):
        scene.protected_view((x, y), target_class=6, cell=4, max_distance=0.01)


def test_views_from_windows(scene, run_program, folder, standing):
    pandas = pytest.importorskip("pandas")
    x, y = standing
    z = float(scene.bounds[0][2])
    rows = {
        "x": [x, x + 1],
        "y": [y, y + 1],
        "z": [z + 6, z + 9],
        "azimuth": [10, 200],
        "width": [2, 1],
        "height": [1, 1],
    }
    pandas.DataFrame(rows).to_csv(folder / "windows.csv", index=False)
    run_program("window-views", "tile.laz", "--windows", "windows.csv", "--class", "2=water", "-o", "views.csv")
    with pytest.warns(belvedere.BelvedereWarning, match="near the edge of the cloud") as caught:
        ours = scene.window_views(rows, classes={2: "water"})
    assert [one.message.key for one in caught] == [one.key for one in ours.remarks] == ["targets-near-edge"]
    assert_same_views(ours, pandas.read_csv(folder / "views.csv"))

    # two upright faces of a wall, and a roof
    corners = [(x, y, z + 5), (x + 4, y, z + 5), (x + 4, y, z + 8), (x, y, z + 8), (x + 4, y + 3, z + 8)]
    lines = [f"v {a!r} {b!r} {c!r}" for a, b, c in corners] + ["o wall", "f 1 2 3", "f 1 3 4", "o roof", "f 4 3 5"]
    (folder / "facades.obj").write_text("\n".join(lines))
    flags = ["--windows", "facades.obj", "--object", "wall", "--directions", 300, "-o", "faces.csv"]
    run_program("window-views", "tile.laz", *flags, "--buildings", "buildings.csv")
    with pytest.warns(belvedere.BelvedereWarning, match="near the edge of the cloud"):
        ours = scene.window_views(folder / "facades.obj", objects="wall", directions=300)
    assert_same_views(ours, pandas.read_csv(folder / "faces.csv"))
    assert ours["object"].tolist() == ["wall"] * 2 and ours.objects is not None
    theirs = pandas.read_csv(folder / "buildings.csv")
    assert theirs["name"].tolist() == ours.objects["object"].tolist()
    for name in set(theirs) - {"name"}:
        assert np.allclose(ours.objects[name], theirs[name], rtol=0, atol=6e-4), name


def assert_same_views(ours, theirs):
    """The columns of a table that the program wrote with two to four decimals."""
    assert set(ours) - {"object"} <= set(theirs.columns)
    for name in set(ours) - {"object"}:
        assert np.allclose(ours[name], theirs[name], rtol=0, atol=6e-3, equal_nan=True), name
    assert (ours["sky"] > 0).all() and np.allclose(ours.places, theirs[["x", "y", "z"]], rtol=0, atol=6e-4)


def test_cameras(scene, run_program, folder, standing):
    """Grids and given places, fixed and turning, with private places and a camera that stays."""
    run_program(
        "cameras", "tile.laz", "--on-roofs", 12, "--count", 3, "--max-distance", 50, "--density", "monitor",
        "-o", "cameras.tif", "-o", "cameras.geojson", "--search-limit", 200,
    )  # fmt: skip
    placed = scene.cameras("roofs", spacing=12, count=3, max_distance=50, density="monitor", search_limit=200)
    assert_same_raster(placed.counts, folder / "cameras.tif", folder)
    features = json.loads((folder / "cameras.geojson").read_text())["features"]
    assert [f["properties"]["covered_targets"] for f in features] == placed.cameras["covered_targets"].tolist()
    headings = np.array([f["properties"]["heading"] for f in features])
    assert np.abs(headings - placed.cameras["heading_deg"]).max() < 6e-4
    assert [len(rows) for rows in placed.covered] == placed.cameras["covered_targets"].tolist()
    assert (placed.counts.values[placed.counts.values != 65535] > 0).mean() * 100 == pytest.approx(
        placed.coverage_percent, abs=1e-9
    )

    x, y = standing
    posts = [(x + dx, y + dy) for dx in (-8, 0, 8) for dy in (-8, 0, 8)]
    (folder / "posts.csv").write_text("x,y\n" + "".join(f"{a!r},{b!r}\n" for a, b in posts))
    (folder / "private.csv").write_text(f"x,y\n{x + 3!r},{y + 9!r}\n")
    run_program(
        "cameras", "tile.laz", "--candidates", "posts.csv", "--private", "private.csv", "--coverage", 30, "--cell", 4,
        "--density", "none", "--headings", 6, "--tilt", 10, "--tilt", 40, "-o", "some.tif",
    )  # fmt: skip
    with pytest.warns(belvedere.BelvedereWarning) as caught:
        some = scene.cameras(
            posts, private=(x + 3, y + 9), coverage_percent=30, cell=4, density="none", headings=6, tilts_deg=(10, 40)
        )
    # the cells of 4 m do not fit into the tile
    assert {one.message.key for one in caught} == {"targets-outside-cloud", "observer-skipped"}
    assert [one.text for one in some.remarks if one.severity == "warning"] == [str(one.message) for one in caught]
    assert any("candidate " in one.text and "inside an obstacle" in one.text for one in some.remarks)
    assert_same_raster(some.counts, folder / "some.tif", folder)
    # few masts: the Fresnel zones of a mast are looked at for each cell
    radio = ["--on-roofs", 24, "--fov", 360, "--count", 2, "--frequency-ghz", 2.4, "--fresnel-percent", 80]
    run_program("cameras", "tile.laz", *radio, "--max-distance", 40, "-o", "masts.tif")
    masts = {"spacing": 24, "count": 2, "fov_deg": 360, "max_distance": 40}
    ours = scene.cameras("roofs", **masts, frequency_ghz=2.4, fresnel_percent=80)
    assert_same_raster(ours.counts, folder / "masts.tif", folder)
    assert ours.coverage_percent < scene.cameras("roofs", **masts).coverage_percent
    assert some.coverage_percent >= 30 and some.least_possible_cameras <= len(some.covered)
    with pytest.warns(belvedere.BelvedereWarning, match=r"targets \(.* %\) are outside the cloud"):
        more = scene.cameras(posts[2:6], count=1, cell=4, density="none", existing=some.cameras, headings=6)
    assert more.existing_only_percent == pytest.approx(some.coverage_percent, abs=0.2)
    assert more.cameras["is_existing"].tolist() == [True] * len(some.covered) + [False]


def test_cameras_of_places(scene, cloud, standing):
    x, y = standing
    targets = cloud.xyz[::400] + [0, 0, 1.0]
    weights = np.zeros(len(targets))
    weights[:10] = 1
    placed = scene.cameras([(x, y), (x + 5, y)], count=2, fov_deg=360, targets=targets, weights=weights)
    assert set(np.flatnonzero(placed.counts["cameras"] != 65535)) == set(range(10))
    assert all((rows < 10).all() for rows in placed.covered)
    with pytest.raises(belvedere.BelvedereError, match="weights"):
        scene.cameras(standing, count=1, targets=targets, weights=[1, 2])
    with pytest.raises(belvedere.BelvedereError, match="one of"):
        scene.cameras(standing)
    with pytest.raises(belvedere.BelvedereError, match="'sharp'"):
        scene.cameras(standing, count=1, density="sharp")
    with pytest.raises(belvedere.BelvedereError, match="distance"):
        scene.cameras(standing, count=1, fov_deg=360, density=50)
    with pytest.raises(belvedere.BelvedereError, match="roofs"):
        scene.cameras("trees", count=1)


def test_depth_maps(scene, run_program, folder, eye):
    x, y, z = eye
    views = [
        (["--sun", "200,40", "--pixel", "0.5"], {"sun": (200, 40), "pixel": 0.5}),
        (["--panorama", f"{x},{y},{z}", "--size", "256"], {"eye": eye, "width": 256}),
        (
            ["--eye", f"{x},{y},{z}", "--look-at", f"{x + 20},{y},{z - 9}", "--size", "320x200"],
            {"eye": eye, "look_at": (x + 20, y, z - 9), "size": (320, 200)},
        ),
    ]
    for number, (flags, arguments) in enumerate(views):
        run_program("depth-map", "tile.laz", *flags, "-o", f"depth_{number}.npy")
        theirs = np.load(folder / f"depth_{number}.npy")
        assert scene.depth_map(**arguments).tobytes() == theirs.tobytes(), flags


def test_comfort_and_envelopes(scene, run_program, folder, standing):
    pandas = pytest.importorskip("pandas")
    x, y = standing
    route, end = f"{x},{y} {x + 15},{y + 5}", (x + 15, y + 5)
    run_program("comfort", "tile.laz", "--route", route, "--date", "2026-06-21", "-o", "walk.csv")
    theirs = pandas.read_csv(folder / "walk.csv")
    ours = scene.comfort(route=[(x, y), end], date="2026-06-21")
    for name in ours:
        assert np.allclose(ours[name], theirs[name], rtol=0, atol=6e-3, equal_nan=True), name
    # files have times of the clock beside the hours, for people who read them
    assert set(theirs.columns) - {"x", "y", "z", "first_light_time", "last_light_time"} == set(ours)

    ring = [(x, y), (x + 8, y), (x + 8, y + 8), (x, y + 8)]
    line = [(x - 2, y + 12), (x + 10, y + 12)]

    def typed(corners):
        return " ".join(f"{x},{y}" for x, y in corners)

    run_program(
        *("envelope", "tile.laz", "--parcel", typed(ring), "--protect", typed(line), "--date", "2026-03-21"),
        *("--between", "10,14", "--zone", "Europe/Amsterdam", "--max-height", 25, "-o", "envelope.tif"),
    )
    hours = {"date": "2026-03-21", "between": (10, 14), "zone": "Europe/Amsterdam"}
    ours = scene.envelope(ring, protect=line, **hours, max_height=25)
    assert_same_raster(ours, folder / "envelope.tif", folder)


def test_plans(scene, run_program, folder):
    low, high = scene.bounds
    x, y = ((low + high) / 2)[:2]
    corners = [(x + a, y + b, c) for a, b in [(-9, -7), (9, -7), (9, 7), (-9, 7)] for c in (low[2] - 1, high[2] + 9)]
    faces = ["1 3 4 2", "3 5 6 4", "5 7 8 6", "7 1 2 8", "2 4 6 8"]
    lines = [f"v {a!r} {b!r} {c!r}" for a, b, c in ([float(v) for v in corner] for corner in corners)]
    (folder / "planned.obj").write_text("\n".join(lines + [f"f {face}" for face in faces]))
    (folder / "hills.csv").write_text("azimuth,elevation\n90,2\n180,45\n270,8\n")
    heights = np.full((200, 200), low[2], np.float32)
    heights[140:] += 1000
    transform = (20.0, 0.0, float(x) - 2000, 0.0, -20.0, float(y) + 2000)
    belvedere.Raster(heights, transform, scene._core.crs).to_geotiff(folder / "dtm.tif")
    box = [float(v) for v in (x - 20, y - 15, x + 20, y + 15)]
    area = [(box[0], box[1]), (box[2], box[1]), (box[2], box[3]), (box[0], box[3])]
    sun, flags = {"sun": (200, 25)}, ["--sun", "200,25"]
    cleared = scene.without(area)
    for name, planned, more in [
        ("added", scene.with_added(folder / "planned.obj"), ["--add", "planned.obj"]),
        ("cleared", cleared, ["--clear", ",".join(repr(v) for v in box)]),
        (
            "both",
            cleared.with_added(folder / "planned.obj"),
            ["--clear", ",".join(repr(v) for v in box), "--add", "planned.obj"],
        ),
        ("hills", scene.with_horizon(folder / "hills.csv"), ["--horizon", "hills.csv"]),
        ("terrain", scene.with_terrain(folder / "dtm.tif"), ["--terrain", "dtm.tif"]),
    ]:
        run_program("shadow", "tile.laz", *flags, *more, "-o", f"plan_{name}.tif")
        raster = planned.shadow(**sun)
        assert_same_raster(raster, folder / f"plan_{name}.tif", folder)
        assert not np.array_equal(raster.values, scene.shadow(**sun).values, equal_nan=True), name
    # the mountains beyond the cloud, and from where in them a mast is seen
    eye = [float(x), float(y), float(high[2]) + 30]
    for name, flags, arguments in [
        ("seen", ["--observer", ",".join(map(repr, eye)), "--max-distance", "1500"], {"max_distance": 1500}),
        ("from", ["--target", ",".join(map(repr, eye)), "--observer-height", "3"], {"observer_height": 3}),
    ]:
        run_program("viewshed", "tile.laz", *flags, "--terrain", "dtm.tif", "--far-output", f"far_{name}.tif")
        who = {"observers": eye} if name == "seen" else {"target": eye}
        far = scene.with_terrain(folder / "dtm.tif").viewshed(**who, **arguments, far=True)
        assert_same_raster(far, folder / f"far_{name}.tif", folder)
        assert (far.values == belvedere.Answer.VISIBLE).any() and (far.values == belvedere.Answer.BLOCKED).any(), name
    # from the top of these mountains, 1000 m above the plain, with and without a mast
    mountains = scene.with_terrain(folder / "dtm.tif")
    top = (float(x), float(y) - 1200)
    standing = ["--terrain", "dtm.tif", "--observer", ",".join(map(repr, top)), "--observer-height"]
    answers = []
    for mast in (2.0, 900.0):
        run_program("viewshed", "tile.laz", *standing, str(mast), "--cell", "2", "-o", "from_top.tif")
        with warnings.catch_warnings():
            # without a mast nothing of the plain is seen
            warnings.simplefilter("ignore" if mast < 900 else "error", belvedere.BelvedereWarning)
            seen = mountains.viewshed(top, observer_height=mast, cell=2)
        assert_same_raster(seen, folder / "from_top.tif", folder)
        answers.append(np.isin(seen.values, [belvedere.Answer.VISIBLE, belvedere.Answer.UNPROVEN]).any())
        line = [*standing, str(mast), "--target", ",".join(map(repr, eye)), "-o", "line.csv"]
        run_program("line-of-sight", "tile.laz", *line)
        sight = mountains.line_of_sight(top, eye, observer_height=mast)
        assert sight.block_terrain == (sight.answer == belvedere.Answer.BLOCKED)
        with (folder / "line.csv").open() as file:
            (row,) = csv.DictReader(file)
        assert (int(row["answer"]), row["block_terrain"]) == (sight.answer, "1" if sight.block_terrain else "")
        if sight.block_terrain:
            assert abs(float(row["first_block_range_m"]) - sight.first_block_range_m) <= 0.0005
    assert answers == [False, True]
    table = mountains.line_of_sight([top, (float(x), float(y))], eye, observer_height=900)
    assert table["block_terrain"].dtype == bool and not table["block_terrain"].any()
    zone = mountains.line_of_sight(top, eye, observer_height=900, frequency_ghz=5.8)
    run_program("line-of-sight", "tile.laz", *line, "--frequency-ghz", "5.8")
    with (folder / "line.csv").open() as file:
        (row,) = csv.DictReader(file)
    assert abs(float(row["fresnel_free_percent"]) - zone.fresnel_free_percent) < 0.1 and zone.fresnel_free_percent > 0


def test_plans_are_not_lost_without_a_word(scene, folder):
    (folder / "hills.csv").write_text("0,30\n180,30")
    planned = scene.with_horizon(folder / "hills.csv")
    with pytest.warns(belvedere.BelvedereWarning, match="not saved"):
        planned.save(folder / "planned.npz")
    with pytest.raises(TypeError, match="cannot be pickled"):
        pickle.dumps(planned)


def test_places_on_the_map(scene, ask_program, folder, standing):
    x, y = standing
    summary = ask_program("sun-hours", "tile.laz", "--at", f"{x},{y}", "--date", "2026-06-21", "-o", "place.csv")
    table = scene.sun_hours(date="2026-06-21", targets=(x, y), interval=True)
    # the program prints millimetres
    np.testing.assert_allclose(table.places[0], summary["at"][0]["position"], atol=6e-4)
    printed = np.genfromtxt(folder / "place.csv", delimiter=",", names=True)
    for name in ("sun_hours", "hours_low", "hours_high"):
        # and hours to four digits
        assert float(printed[name]) == pytest.approx(table[name][0], abs=6e-5)
    same = scene.sun_hours(date="2026-06-21", targets=[(x, y), (x, y)], interval=True)
    assert list(same["sun_hours"]) == [table["sun_hours"][0]] * 2
    higher = scene.sky_view(targets=(x, y), target_height=30)
    assert higher["sky_view_factor"][0] > scene.sky_view(targets=(x, y))["sky_view_factor"][0]
    with pytest.raises(belvedere.BelvedereError, match="must be on the points"):
        scene.sun_hours(date="2026-06-21", targets=(x + 5000, y))
