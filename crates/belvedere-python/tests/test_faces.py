"""One question, four faces: program, Python, page and city give equal values, remarks and places without a value.

Each row of the table is a question. Where a face has no such question, the row says why.
"""

from __future__ import annotations

import json
import subprocess
import time
import urllib.request
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import belvedere
import numpy as np
import pytest
from rasters import bands_of, values_of

pytest.importorskip("rasterio")
laspy = pytest.importorskip("laspy")

ZONE = "Europe/Amsterdam"
DAY = "2026-03-21"
NOON = "2026-06-21T13:00+02:00"
NO_PAGE = "the page has no question about all cells of a grid"
NO_CITY_GROUND = "a city answers for cells on top of what stands there"
NO_CITY_POINTS = "a city answers for cells"
NO_CITY_SOFT = "a city takes the sun as a point"
NO_CITY_SUNS = "a city gives a raster for each sun"


@dataclass
class Row:
    """A question in the words of each face; a text in place of words says why a face has no such question."""

    name: str
    program: list[Any]
    python: Callable[[belvedere.Scene], Any]
    city: list[Any] | str
    page: tuple[str, dict[str, Any]] | str = NO_PAGE
    #: band of the program's raster for each raster of Python
    bands: tuple[str, ...] = ()


SHADOWS = {
    "time": (["--time", NOON], {"time": NOON}),
    "low sun": (["--sun", "120,12"], {"sun": (120, 12)}),
    "high sun": (["--sun", "200,55"], {"sun": (200, 55)}),
    "winter, light through trees": (
        ["--time", "2026-01-21T12:00Z", "--through-trees", "seasons"],
        {"time": "2026-01-21T12:00Z", "through_trees": "seasons"},
    ),
    "half of the light through trees": (
        ["--sun", "200,40", "--through-trees", 0.5],
        {"sun": (200, 40), "through_trees": 0.5},
    ),
}
HOURS = {
    "equinox": (["--date", DAY, "--zone", ZONE], {"date": DAY, "zone": ZONE}),
    "half an hour": (
        ["--date", DAY, "--zone", ZONE, "--time-step-min", 30],
        {"date": DAY, "zone": ZONE, "time_step_min": 30},
    ),
    "suns above ten degrees": (
        ["--date", DAY, "--zone", ZONE, "--min-sun-elevation", 10],
        {"date": DAY, "zone": ZONE, "min_sun_elevation_deg": 10},
    ),
    "three days": (
        ["--from", "2026-06-01", "--to", "2026-06-03", "--time-step-min", 60],
        {"period": ("2026-06-01", "2026-06-03"), "time_step_min": 60},
    ),
    "light through trees": (
        ["--date", DAY, "--zone", ZONE, "--through-trees", "seasons"],
        {"date": DAY, "zone": ZONE, "through_trees": "seasons"},
    ),
}
SKIES = {
    "145 directions": (["--directions", 145], {"directions": 145}),
    "577 directions": ([], {}),
    "light through trees": (["--directions", 145, "--through-trees", 0.3], {"directions": 145, "through_trees": 0.3}),
}
ENERGY = ["--clear-sky", "ineichen", "--sun-cell-deg", 12, "--patch-division", 1]
ENERGY_OF_PYTHON = {"clear_sky": "ineichen", "sun_cell_deg": 12, "patch_division": 1}


def rows() -> list[Row]:
    """The questions about cells."""
    found = []
    for name, (flags, given) in SHADOWS.items():
        for surface in (False, True):
            places, of_python = (["--surface"], {"surface": True}) if surface else ([], {})
            # a city takes a sun that is above the horizon, and light through trees for all questions
            city = ["--sun" if flag == "--sun" else flag for flag in flags] if surface else NO_CITY_GROUND
            found.append(
                Row(
                    f"shadow, {name}, {'surface' if surface else 'ground'}",
                    ["shadow", *flags, *places, "--cell", 2],
                    lambda scene, given=given, of_python=of_python: scene.shadow(**given, **of_python, cell=2),
                    city,
                )
            )
    found.append(
        Row(
            "shadow, soft",
            ["shadow", "--sun", "200,25", "--soft", "--cell", 2],
            lambda s: s.shadow(sun=(200, 25), soft=True, cell=2),
            NO_CITY_SOFT,
        )
    )
    for name, (flags, given) in HOURS.items():
        for surface in (False, True):
            places, of_python = (["--surface"], {"surface": True}) if surface else ([], {})
            found.append(
                Row(
                    f"sun hours, {name}, {'surface' if surface else 'ground'}",
                    ["sun-hours", *flags, *places, "--cell", 2],
                    lambda scene, given=given, of_python=of_python: scene.sun_hours(**given, **of_python, cell=2)[
                        "sun_hours"
                    ],
                    ["--sun-hours", *flags] if surface else NO_CITY_GROUND,
                )
            )
    for name, (flags, given) in SKIES.items():
        for surface in (False, True):
            places, of_python = (["--surface"], {"surface": True}) if surface else ([], {})
            found.append(
                Row(
                    f"sky view, {name}, {'surface' if surface else 'ground'}",
                    ["sky-view", *flags, *places, "--cell", 2],
                    lambda scene, given=given, of_python=of_python: scene.sky_view(**given, **of_python, cell=2)[
                        "sky_view_factor"
                    ],
                    ["--sky-view", *(flags or ["--directions", 577])] if surface else NO_CITY_GROUND,
                )
            )
    for surface in (False, True):
        places, of_python = (["--surface"], {"surface": True}) if surface else ([], {})
        found.append(
            Row(
                f"irradiance, {'surface' if surface else 'ground'}",
                ["irradiance", *ENERGY, *places, "--cell", 4],
                lambda scene, of_python=of_python: scene.irradiance(**ENERGY_OF_PYTHON, **of_python, cell=4)["kwh_m2"],
                ["--irradiance", *ENERGY] if surface else NO_CITY_GROUND,
            )
        )
    return found


@pytest.fixture(scope="session")
def ask_page(program, folder, tile):
    """Asks the page's server of the tile; returns the named values and the bytes of an answer."""
    server = subprocess.Popen(
        [program, "view", tile.name, "--no-browser"],
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
    )
    url = server.stdout.readline().strip()

    def get(path, body=None):
        request = urllib.request.Request(url + path, data=body, headers={"Content-Type": "application/json"})
        with urllib.request.urlopen(request, timeout=120) as reply:
            return reply.read()

    deadline = time.monotonic() + 120
    while json.loads(get("state"))["scene"] is None:
        assert time.monotonic() < deadline
        time.sleep(0.05)

    def ask(question, values):
        reply = get(f"ask/{question}", json.dumps(values).encode())
        length = int.from_bytes(reply[:4], "little")
        return json.loads(reply[4 : 4 + length]), reply[4 + length :]

    yield ask
    server.kill()
    server.wait()


def said(remarks):
    """Key, severity and text of remarks, whichever face they come from."""
    as_dicts = [remark if isinstance(remark, dict) else remark._asdict() for remark in remarks]
    return sorted((one["key"], one["severity"], one["text"]) for one in as_dicts)


@pytest.mark.parametrize("row", rows(), ids=lambda row: row.name)
def test_cells_have_the_same_answers_in_the_program_and_in_python(scene, ask_program, folder, row):
    output = folder / "face.tif"
    summary = ask_program(*row.program[:1], "tile.laz", *row.program[1:], "-o", output.name)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", belvedere.BelvedereWarning)
        raster = row.python(scene)
    bands, transform = bands_of(output)
    first = next(iter(bands.values()))
    assert np.array_equal(first, values_of(raster), equal_nan=True)
    assert tuple(transform)[:6] == raster.transform
    unproven = bands.get("unproven")
    assert (unproven is None) == (raster.unproven is None)
    if unproven is not None:
        assert np.array_equal(unproven, values_of(raster.unproven), equal_nan=True)
    assert said(summary.get("remarks", [])) == said(raster.remarks)


#: Questions that a city can answer.
OF_CITY = [row for row in rows() if not isinstance(row.city, str)]


@pytest.mark.parametrize("number", range(len(OF_CITY)), ids=lambda number: OF_CITY[number].name)
def test_cells_have_the_same_answers_in_a_city(ask_program, folder, number):
    row = OF_CITY[number]
    cell = row.program[-1]
    name = "".join(c if c.isalnum() else "_" for c in row.name)
    # in several tiles, and two out of three in one, because balls are made anew for each
    side = 256 if number % 3 else 64
    ask_program("city", "plan", "tile.laz", *row.city, "--cell", cell, "--tile-size", side, "-o", name)
    of_run = ask_program("city", "run", name)
    ask_program("city", "merge", name, "-o", f"{name}.tif")
    summary = ask_program(*row.program[:1], "tile.laz", *row.program[1:], "-o", "whole.tif")
    (whole, place), (tiles, of_tiles) = bands_of(folder / "whole.tif"), bands_of(folder / f"{name}.tif")
    whole, tiles = next(iter(whole.values())), next(iter(tiles.values()))
    # the raster of a city covers whole tiles
    column, row_number = (round(v) for v in ~of_tiles * (place.c, place.f))
    part = tiles[row_number : row_number + whole.shape[0], column : column + whole.shape[1]]
    assert np.array_equal(np.isnan(part), np.isnan(whole))
    # balls of tiles are those of the whole but for three things that docs/scale.md lists
    differing = np.abs(part - whole) > 0.01 * np.nanmax(whole)
    assert differing.mean() < 0.01, differing.sum()
    keys = {remark["key"] for remark in of_run.get("remarks", [])}
    assert keys == {remark["key"] for remark in summary.get("remarks", []) if remark["severity"] == "warning"}


@pytest.mark.parametrize("trees", ["opaque", "seasons"])
@pytest.mark.parametrize("clock", ["2026-06-21T13:00", "2026-12-21T12:00"])
def test_points_have_the_same_shadow_on_the_page(scene, cloud, ask_program, ask_page, folder, clock, trees):
    chosen = {} if trees == "opaque" else {"through_trees": "seasons"}
    flags = [] if trees == "opaque" else ["--through-trees", "seasons"]
    summary = ask_program("shadow", "tile.laz", "--self", "--time", clock, "--zone", ZONE, *flags, "-o", "lit.laz")
    of_page, codes = ask_page(
        "shadow", {"time": clock, "zone": ZONE, "trees": "opaque" if trees == "opaque" else {"seasons": "by_date"}}
    )
    rows = laspy.read(folder / "lit.laz")
    lit = np.asarray(rows["lit"])
    assert of_page["lit"] == int((lit > 0).sum())
    assert of_page["unproven"] == int((np.asarray(rows["unproven"]) > 0).sum())
    assert (np.frombuffer(codes, np.uint8) == 2).sum() == of_page["unproven"]
    assert said(of_page["remarks"]) == said(summary["remarks"])
    offset = "+02:00" if clock < "2026-10" else "+01:00"
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        of_python = scene.shadow(time=clock + offset, targets=cloud, **chosen)
    assert np.array_equal(of_python, lit.astype(np.float32), equal_nan=True)
    keys = [warning.message.key for warning in caught if isinstance(warning.message, belvedere.BelvedereWarning)]
    assert sorted(keys) == sorted(one["key"] for one in summary["remarks"] if one["severity"] == "warning")


def test_a_place_has_the_same_hours_of_sun_on_the_page(scene, ask_program, ask_page, folder, standing):
    x, y = standing
    z = float(scene.cloud.xyz[:, 2].min()) + 2.5
    (folder / "place.csv").write_text(f"x,y,z\n{x},{y},{z}\n")
    flags = ["--date", DAY, "--zone", ZONE]
    summary = ask_program("sun-hours", "tile.laz", "--targets", "place.csv", *flags, "-o", "hours.csv")
    of_page, _ = ask_page("sun", {"place": [x, y, z], "date": DAY, "zone": ZONE})
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", belvedere.BelvedereWarning)
        of_python = scene.sun_hours(date=DAY, zone=ZONE, targets=[(x, y, z)])
    assert of_page["sun_hours"] == round(float(of_python["sun_hours"][0]), 3)
    assert summary["measures"]["sun_hours"]["mean"] == pytest.approx(of_page["sun_hours"], abs=0.0011)
    assert said(of_page["remarks"]) == said(summary["remarks"]) == said(of_python.remarks)


VIEWSHEDS = {
    "one observer": ({}, []),
    "within 30 m": ({"max_distance": 30}, ["--max-distance", 30]),
    "to the east": ({"azimuth_range_deg": (45, 135)}, ["--azimuth-range", "45,135"]),
    "higher targets": ({"target_height": 1.5, "observer_height": 3}, ["--target-height", 1.5, "--observer-height", 3]),
    "unproven as visible": ({"unproven": "as-visible"}, ["--unproven", "as-visible"]),
    "unproven as blocked": ({"unproven": "as-blocked"}, ["--unproven", "as-blocked"]),
}


@pytest.mark.parametrize("name", VIEWSHEDS)
def test_viewsheds_are_the_same_in_the_program_and_in_python(scene, ask_program, folder, standing, name):
    given, flags = VIEWSHEDS[name]
    x, y = standing
    summary = ask_program("viewshed", "tile.laz", "--observer", f"{x},{y}", *flags, "--cell", 1, "-o", "seen.tif")
    compare_rasters(folder / "seen.tif", summary, lambda: scene.viewshed((x, y), **given, cell=1))


def test_viewsheds_of_several_observers_are_the_same(scene, ask_program, folder, standing):
    x, y = standing
    # the last one stands far beside the cloud
    places = [(x, y), (x + 2, y - 1), (x - 1, y + 2), (x + 9000, y)]
    (folder / "observers.csv").write_text("x,y\n" + "".join(f"{a},{b}\n" for a, b in places))
    summary = ask_program("viewshed", "tile.laz", "--observers", "observers.csv", "--cell", 1, "-o", "seen.tif")
    compare_rasters(folder / "seen.tif", summary, lambda: scene.viewshed(places, cell=1))
    assert "observer-skipped" in {remark["key"] for remark in summary["remarks"]}


def compare_rasters(path, summary, ask):
    """Values, places without a value, what is unproven and remarks of a raster of the program and of Python."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", belvedere.BelvedereWarning)
        raster = ask()
    bands, _ = bands_of(path)
    first, *rest = bands.values()
    assert np.array_equal(first, values_of(raster), equal_nan=True)
    assert bool(rest) == (raster.unproven is not None)
    if rest:
        assert np.array_equal(rest[0], values_of(raster.unproven), equal_nan=True)
    assert said(summary.get("remarks", [])) == said(raster.remarks)
    return raster


def test_who_sees_a_place_is_the_same_on_the_page(scene, ask_program, ask_page, folder, eye):
    summary = ask_program("viewshed", "tile.laz", "--target", ",".join(map(str, eye)), "-o", "who.tif")
    compare_rasters(folder / "who.tif", summary, lambda: scene.viewshed(target=eye))
    of_page, _ = ask_page("who", {"place": list(eye)})
    assert {name: of_page[name] for name in ("visible", "blocked", "unproven")} == {
        name: summary["cells"][name] for name in ("visible", "blocked", "unproven")
    }
    assert said(of_page["remarks"]) == said(summary.get("remarks", []))


@pytest.mark.parametrize("rise", [0.5, 4.0, 15.0])
def test_a_line_of_sight_is_the_same_on_the_page(scene, ask_program, ask_page, standing, eye, rise):
    (x, y), low = standing, float(scene.cloud.xyz[:, 2].min())
    observer, target = [x, y, low + 2], [eye[0], eye[1], low + rise]
    typed = [",".join(map(str, place)) for place in (observer, target)]
    summary = ask_program("line-of-sight", "tile.laz", "--observer", typed[0], "--target", typed[1], "-o", "line.csv")
    of_page, _ = ask_page("line", {"observer": observer, "target": target})
    assert of_page["answer"] == summary["line"]["answer"]
    assert (of_page["first_block"] or {}).get("range_m") == summary["line"].get("first_block_range_m")
    assert of_page["unproven_m"] == summary["line"].get("unproven_m")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        of_python = scene.line_of_sight(observer, target)
    # half a metre above the ground the target is inside an obstacle
    is_inside = rise == 0.5
    assert [one.message.key for one in caught] == ["end-inside-obstacle"] * is_inside
    assert (of_python.answer is belvedere.Answer.INSIDE_OBSTACLE) is is_inside
    assert of_page["answer"] == ("inside an obstacle" if is_inside else of_python.answer.name.lower())
    assert said(of_page["remarks"]) == said(summary.get("remarks", [])) == said(of_python.remarks)


def test_how_open_a_place_is_is_the_same_on_the_page(scene, ask_program, ask_page, folder, standing):
    (x, y), z = standing, float(scene.cloud.xyz[:, 2].min()) + 2.5
    of_page, _ = ask_page("around", {"place": [x, y, z]})
    (folder / "here.csv").write_text(f"x,y,z\n{x},{y},{z}\n")
    sky = ask_program("sky-view", "tile.laz", "--targets", "here.csv", "-o", "sky.csv")
    isovist = ask_program("isovist", "tile.laz", "--observer", f"{x},{y},{z}", "-o", "isovist.csv")
    figures = {name: value for name, value in isovist["isovist"].items() if name not in "xyz"}
    assert of_page["isovist"] == pytest.approx(figures, nan_ok=True)
    assert of_page["sky_view_factor"] == pytest.approx(sky["measures"]["sky_view_factor"]["mean"], abs=5.1e-3)
    assert said(of_page["remarks"]) == said(isovist.get("remarks", []) + sky.get("remarks", []))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", belvedere.BelvedereWarning)
        of_python = scene.isovist((x, y, z))
    assert float(of_python["volume_m3"][0]) == pytest.approx(figures["volume_m3"], abs=0.51)


def test_horizons_and_landmarks_are_the_same_in_the_program_and_in_python(scene, ask_program, folder, standing):
    x, y = standing
    summary = ask_program(
        "horizon", "tile.laz", "--observer", f"{x},{y}", "--angle-step-deg", 5, "--below", "keep", "-o", "horizon.csv"
    )
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        _, of_python = scene.horizon((x, y), angle_step_deg=5)
    table = np.genfromtxt(folder / "horizon.csv", delimiter=",", names=True)
    assert np.allclose(np.ravel(of_python), table[table.dtype.names[1]], rtol=0, atol=6e-4)
    keys = {warning.message.key for warning in caught if isinstance(warning.message, belvedere.BelvedereWarning)}
    assert keys == {one["key"] for one in summary.get("remarks", []) if one["severity"] == "warning"}

    summary = ask_program("landmark", "tile.laz", "--target-class", 6, "--cell", 10, "-o", "landmark.tif")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", belvedere.BelvedereWarning)
        views = scene.landmark(target_class=6, cell=10)
    share = views["visible_share"]
    bands, _ = bands_of(folder / "landmark.tif")
    assert np.allclose(next(iter(bands.values())), values_of(share), rtol=0, atol=1e-6, equal_nan=True)
    assert said(summary.get("remarks", [])) == said(share.remarks)


def test_the_sun_stands_at_the_same_place_for_all_faces(scene, ask_program, ask_page, folder):
    ask_program("sun-position", "tile.laz", "--time", NOON, "--time", "2026-12-21T09:00Z", "-o", "sun.csv")
    rows = [line.split(",") for line in (folder / "sun.csv").read_text().splitlines()[1:]]
    of_program = [(float(azimuth), float(elevation)) for _, azimuth, elevation in rows]
    of_python = scene.sun_position([NOON, "2026-12-21T09:00Z"])
    assert np.allclose(of_program, of_python, rtol=0, atol=5.1e-5)
    of_page, _ = ask_page("shadow", {"time": NOON[:16], "zone": ZONE, "trees": "opaque"})
    assert of_program[0] == (of_page["azimuth_deg"], of_page["elevation_deg"])
    # a city is a map: it has no question without cells


def test_a_hole_of_the_survey_has_no_value_on_any_face(tile, cloud, ask_program, folder):
    middle = cloud.xyz[:, :2].min(0) / 2 + cloud.xyz[:, :2].max(0) / 2
    survey = laspy.read(tile)
    is_in_hole = (np.abs(np.stack([survey.x, survey.y], 1) - middle) < 25).all(axis=1)
    survey.points = survey.points[~is_in_hole]
    survey.write(folder / "hole.laz")
    x, y = middle - 32

    def values_in_hole(values, place):
        rows, columns = np.indices(values.shape)
        east, north = place[2] + place[0] * (columns + 0.5), place[5] + place[4] * (rows + 0.5)
        # ground reaches 5 m beyond returns
        is_deep = (np.abs(east - middle[0]) < 20) & (np.abs(north - middle[1]) < 20)
        assert is_deep.sum() > 300 and np.isfinite(values[~is_deep]).any()
        return int(np.isfinite(values[is_deep]).sum())

    scene = belvedere.Scene(belvedere.read(folder / "hole.laz"))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", belvedere.BelvedereWarning)
        rasters = [
            scene.shadow(sun=(200, 30), cell=2),
            scene.shadow(sun=(200, 30), cell=2, surface=True),
            scene.sun_hours(date=DAY, zone=ZONE, cell=2)["sun_hours"],
            *scene.sky_view(directions=145, cell=2).values(),
            scene.viewshed((x, y), cell=2),
            scene.viewshed([(x, y), (x + 64, y)], cell=2),
            scene.viewshed(target=(*middle, 30), cell=2),
        ]
    for raster in rasters:
        for one in [raster] if raster.unproven is None else [raster, raster.unproven]:
            assert values_in_hole(values_of(one), one.transform) == 0, one

    asks = ["--sun", "200,30", "--sky-view", "--directions", 49, "--sun-hours", "--date", DAY, "--observer", f"{x},{y}"]
    ask_program("city", "plan", "hole.laz", *asks, "--cell", 2, "--tile-size", 64, "-o", "holed")
    ask_program("city", "run", "holed")
    for name in ("shadow_200_30", "sky_view_factor", "sun_hours", "viewshed"):
        ask_program("city", "merge", "holed", "--result", name, "-o", "holed.tif")
        bands, place = bands_of(folder / "holed.tif")
        for band, values in bands.items():
            assert values_in_hole(values, tuple(place)[:6]) == 0, (name, band)


def warned_of(call):
    """Key and text of the warnings of a call."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        call()
    own = [one.message for one in caught if isinstance(one.message, belvedere.BelvedereWarning)]
    return [(warning.key, str(warning)) for warning in own]


def warnings_of(remarks):
    """The same of remarks of the program or the page."""
    return [(remark["key"], remark["text"]) for remark in remarks if remark["severity"] == "warning"]


def test_nothing_to_clear_is_said_on_every_face(scene, cloud, ask_program, ask_page, folder):
    # a triangle of millimetres, a centimetre beside a point: no point lies in it
    x, y = np.round(cloud.xyz[0, :2] + 0.01, 3)
    corners = [(x, y), (x + 0.002, y), (x + 0.002, y + 0.002)]
    inside = (np.abs(cloud.xyz[:, :2] - (x, y)) < 0.003).all(axis=1)
    assert not inside.any()
    ring = [[float(a), float(b)] for a, b in [*corners, corners[0]]]
    polygon = {"type": "Polygon", "coordinates": [ring]}
    (folder / "nothing.geojson").write_text(json.dumps(polygon))
    summary = ask_program(
        "shadow", "tile.laz", "--sun", "180,30", "--clear", "nothing.geojson", "--cell", 4, "-o", "cleared.tif"
    )
    of_program = [one for one in warnings_of(summary["remarks"]) if one[0] == "nothing-cleared"]
    of_page, _ = ask_page("plan", {"clear": [ring[:3]], "buildings": [], "meshes": []})
    assert len(of_program) == 1 and warnings_of(of_page["remarks"]) == of_program
    assert warned_of(lambda: scene.without(corners)) == of_program


def test_targets_and_eyes_outside_the_cloud_are_said_by_program_and_python(scene, cloud, ask_program, folder, standing):
    x, y = standing
    top = float(cloud.xyz[:, 2].max())
    far = [float(v) for v in cloud.bounds[1] + [700, 0, -5]]
    beside = (*far[:2], top + 5)
    places = [(x, y, top), far, (x + 1, y, top), (far[0] + 9, far[1], top + 5)]
    (folder / "far.csv").write_text("x,y,z\n" + "".join(f"{a},{b},{c}\n" for a, b, c in places))
    # far away, below the top of the cloud, nothing is known; in the air above the top, lines of sight may end
    for eye, key in [((x, y, top + 5), None), (far, "eye-outside-cloud"), (beside, "eye-beside-cloud")]:
        typed = ",".join(map(str, eye))
        summary = ask_program("query", "tile.laz", "--panorama", typed, "--targets", "far.csv", "-o", "far_seen.csv")
        assert [one["key"] for one in summary["remarks"] if one["key"].startswith("eye-")] == [key] * (key is not None)
        counts = {one["key"]: one.get("numbers", {}).get("count") for one in summary["remarks"]}
        assert counts["targets-beside-cloud"] == 1
        of_program = sorted(warnings_of(summary["remarks"]))
        assert of_program and sorted(warned_of(lambda eye=eye: scene.visible(eye, places))) == of_program
