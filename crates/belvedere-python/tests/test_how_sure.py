"""How sure answers are, in the program and in Python: the same numbers."""

from __future__ import annotations

import json
import warnings

import belvedere
import numpy as np
import pytest
from rasters import bands_of, values_of

ZONE = "Europe/Amsterdam"
DAY = "2026-03-21"

SURE = {
    "shadow": (
        ["shadow", "--sun", "200,30", "--cell", 2],
        lambda scene, place, **sure: scene.shadow(sun=(200, 30), cell=2, **sure),
    ),
    "viewshed": (
        ["viewshed", "--observer", "{place}", "--cell", 2],
        lambda scene, place, **sure: scene.viewshed(place, cell=2, **sure),
    ),
}


@pytest.mark.parametrize("name", SURE)
def test_answers_are_as_sure_in_the_program_and_in_python(scene, ask_program, folder, standing, name):
    words, of_python = SURE[name]
    words = [str(word).format(place=f"{standing[0]},{standing[1]}") for word in words]
    ask_program(words[0], "tile.laz", *words[1:], "--probability", "--certain", 0.9, "-o", "sure.tif")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", belvedere.BelvedereWarning)
        raster = of_python(scene, standing, probability=True, certain=0.9)
        plain = of_python(scene, standing)
    bands, _ = bands_of(folder / "sure.tif")
    assert np.array_equal(values_of(plain), values_of(raster), equal_nan=True), "answers stay"
    for band, of_face in [("probability", raster.probability), ("uncertain", raster.uncertain)]:
        assert np.array_equal(bands[band], values_of(of_face), equal_nan=True), band
    likely = bands["probability"][np.isfinite(bands["probability"])]
    assert likely.size > 300
    assert ((likely >= 0) & (likely <= 1)).all()
    assert 0 < np.nansum(bands["uncertain"]) < 0.5 * likely.size
    assert plain.probability is None
    assert plain.uncertain is None


@pytest.mark.parametrize("question", ["sun-hours", "sky-view", "irradiance"])
def test_intervals_are_the_same_in_the_program_and_in_python(scene, ask_program, folder, question):
    flags = {
        "sun-hours": ["--date", DAY, "--zone", ZONE],
        "sky-view": ["--directions", 145],
        "irradiance": ["--clear-sky", "ineichen", "--patch-division", 1, "--sun-cell-deg", 9],
    }[question]
    ask_program(question, "tile.laz", *flags, "--interval", "--cell", 4, "-o", "interval.tif")
    bands, _ = bands_of(folder / "interval.tif")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", belvedere.BelvedereWarning)
        if question == "sun-hours":
            rasters = scene.sun_hours(date=DAY, zone=ZONE, interval=True, cell=4)
        elif question == "irradiance":
            rasters = scene.irradiance(clear_sky="ineichen", patch_division=1, sun_cell_deg=9, interval=True, cell=4)
        else:
            rasters = scene.sky_view(directions=145, interval=True, cell=4)
    for band in (name for name in bands if name.endswith(("_expected", "_low", "_high"))):
        assert np.array_equal(bands[band], values_of(rasters[band]), equal_nan=True), band
    assert sum(name.endswith("_low") for name in bands) == {"sun-hours": 1, "sky-view": 2, "irradiance": 1}[question]


def test_horizons_isovists_and_landmarks_are_as_sure_in_the_program_as_in_python(scene, ask_program, folder, standing):
    x, y = standing
    place = ["--observer", f"{x},{y}"]
    ask_program("horizon", "tile.laz", *place, "--angle-step-deg", 5, "--below", "keep", "--interval", "-o", "h.csv")
    ask_program("isovist", "tile.laz", *place, "--angle-step-deg", 5, "--interval", "-o", "i.csv")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", belvedere.BelvedereWarning)
        _, elevations = scene.horizon((x, y), angle_step_deg=5, interval=True)
        space = scene.isovist((x, y), angle_step_deg=5, interval=True)
        views = scene.landmark(target_class=6, observers=[(x, y)], probability=True)
    table = np.genfromtxt(folder / "h.csv", delimiter=",", names=True)
    assert elevations.shape == (72, 3)
    for column, name in enumerate(["elevation", "low", "high"]):
        # tables have four decimals
        assert np.allclose(elevations[:, column], table[name], atol=6e-5), name
    table = np.genfromtxt(folder / "i.csv", delimiter=",", names=True)
    for name in ["plan_area_low_m2", "plan_area_high_m2", "volume_low_m3", "volume_high_m3"]:
        assert np.isclose(space[name][0], table[name], atol=6e-3), name
    (folder / "who.csv").write_text(f"x,y\n{x},{y}\n")
    ask_program("landmark", "tile.laz", "--target-class", 6, "--observers", "who.csv", "--probability", "-o", "l.csv")
    table = np.genfromtxt(folder / "l.csv", delimiter=",", names=True)
    assert np.isclose(views["expected_share"][0], table["expected_share"], atol=6e-6)


def test_certain_cameras_are_the_same_in_the_program_and_in_python(scene, ask_program, folder, standing):
    x, y = standing
    (folder / "mast.csv").write_text(f"x,y\n{x},{y}\n")
    flags = ["--candidates", "mast.csv", "--camera-height", 6, "--fov", 360, "--count", 1, "--cell", 2]
    ask_program("cameras", "tile.laz", *flags, "--certain", 0.9, "-o", "covered.tif")
    bands, _ = bands_of(folder / "covered.tif")
    given = {"camera_height": 6, "fov_deg": 360, "count": 1, "cell": 2}
    certain, any_answer = (scene.cameras([(x, y)], **given, certain=least).counts for least in (0.9, None))
    assert np.array_equal(next(iter(bands.values())), values_of(certain), equal_nan=True)
    assert np.nansum(values_of(certain)) < np.nansum(values_of(any_answer))


def flight_lines(cloud, folder):
    """Two flight lines 40 m above the town, as places five metres apart, and the file of them."""
    low, high = cloud.bounds
    along = np.arange(low[1], high[1], 5.0)
    lines = [
        np.column_stack([np.full_like(along, x), along, np.full_like(along, high[2] + 40)]) for x in (low[0], high[0])
    ]
    features = [
        {
            "type": "Feature",
            "properties": {},
            "geometry": {"type": "LineString", "coordinates": line[[0, -1]].tolist()},
        }
        for line in lines
    ]
    (folder / "flights.geojson").write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    return lines


def test_plans_of_flight_lines_are_the_same_in_the_program_and_in_python(scene, cloud, ask_program, folder):
    lines = flight_lines(cloud, folder)
    flags = ["--candidates", "flights.geojson", "--whole-lines", "--angle-step-deg", 0.5]
    summary = ask_program("survey-plan", "tile.laz", *flags, "--sun", "200,30", "--cell", 4, "-o", "plan.csv")
    plan = scene.survey_plan(lines, sun=(200, 30), cell=4, angle_step_deg=0.5)
    table = np.genfromtxt(folder / "plan.csv", delimiter=",", names=True)
    assert len(plan["station"]) == 2, "a candidate for each line"
    assert plan["settles_alone"].max() > 0
    assert plan["settles_alone"].max() <= summary["survey_plan"]["unproven_lines"]
    for name in ["settles_alone", "expected_alone", "proves_alone_m"]:
        # tables have one decimal of these
        assert np.allclose(plan[name], table[name], atol=0.051), name
    assert list(plan["station"]) == [1, 0]
    alone = scene.survey_plan(np.concatenate(lines), sun=(200, 30), cell=4, angle_step_deg=0.5)
    assert len(alone["station"]) == len(lines[0]) + len(lines[1])
    assert alone["settles_alone"].max() <= plan["settles_alone"].max()
