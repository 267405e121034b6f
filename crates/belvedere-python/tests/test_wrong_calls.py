"""Wrong calls raise the right error, which says what is wrong and what to do."""

from __future__ import annotations

import datetime

import belvedere
import numpy as np
import pytest

NAIVE = datetime.datetime(2026, 6, 21, 15)
PLACES = np.array([[155000.0, 463000.0, 5.0]])


WALL = [(0, 0, 0), (4, 0, 0), (4, 0, 3)]


def _wall(crs=None):
    return belvedere.Mesh(WALL, [(0, 1, 2)], crs=crs)


def hole(array):
    array = np.array(array, np.float64)
    array[0, 0] = np.nan
    return array


#: What is called with a scene, its cloud and a folder; the argument at fault, and a word of the advice.
WRONG = {
    "naive time": (lambda s, c, f: s.shadow(time=NAIVE), "time", "tzinfo"),
    "numpy time": (lambda s, c, f: s.shadow(time=np.datetime64("2026-06-21T15:00")), "time", "UTC"),
    "several naive times": (lambda s, c, f: s.shadow(time=[NAIVE]), "time", "tzinfo"),
    "number as time": (lambda s, c, f: s.shadow(time=15), "time", "datetime"),
    "naive period": (lambda s, c, f: s.sun_hours(period=(NAIVE, NAIVE)), "period", "tzinfo"),
    "time as date": (lambda s, c, f: s.sun_hours(date=NAIVE), "date", "datetime.date"),
    "no days": (lambda s, c, f: s.sun_hours(), "period", "days"),
    "days without year": (lambda s, c, f: s.sun_hours(date="longest-day"), "year", "given"),
    "no sun": (lambda s, c, f: s.shadow(), "sun and time", "one of them"),
    "two suns": (lambda s, c, f: s.shadow(sun=(1, 2), time="2026-06-21T15:00Z"), "sun and time", "one of them"),
    "sun in radians as one number": (lambda s, c, f: s.shadow(sun=1.2), "sun", "degrees"),
    "sun too high": (lambda s, c, f: s.shadow(sun=(180, 95)), "sun", "-90 to 90"),
    "sun that is no number": (lambda s, c, f: s.shadow(sun=(180, float("nan"))), "sun", "degrees"),
    "targets of two columns": (lambda s, c, f: s.visible((1, 2, 3), PLACES[:, :2]), "targets", "(N, 3)"),
    "targets of one row without brackets": (lambda s, c, f: s.visible((1, 2, 3), PLACES[0]), "targets", "(N, 3)"),
    "targets with a hole": (lambda s, c, f: s.visible((1, 2, 3), hole(PLACES)), "targets", "remove"),
    "triangle without vertex": (lambda s, c, f: belvedere.Mesh([(0, 0, 0)], [(0, 0, 1)]), "triangles", "1 vertices"),
    "no triangle": (lambda s, c, f: belvedere.Mesh([(0, 0, 0)], np.empty((0, 3), int)), "triangles", "one triangle"),
    "triangles of fractions": (lambda s, c, f: belvedere.Mesh([(0, 0, 0)], [(0, 0.5, 0)]), "triangles", "whole"),
    "objects without name": (lambda s, c, f: belvedere.Mesh(WALL, [(0, 1, 2)], objects=[1]), "objects", "object_names"),
    "normals of a mesh": (lambda s, c, f: s.sky_view(targets=_wall(), normals=PLACES), "normals", "level"),
    "mesh elsewhere": (lambda s, c, f: s.sky_view(targets=_wall("EPSG:2154")), None, "convert"),
    "targets of text": (lambda s, c, f: s.visible((1, 2, 3), [["a", "b", "c"]]), "targets", "(N, 3)"),
    "an eye of two numbers": (lambda s, c, f: s.visible((1, 2), PLACES), "eye", "x, y, z"),
    "an eye that is not finite": (lambda s, c, f: s.visible((1, 2, np.inf), PLACES), "eye", "finite"),
    "pairs of different numbers": (
        lambda s, c, f: s.line_of_sight(np.repeat(PLACES, 2, 0), np.repeat(PLACES, 3, 0)),
        "targets",
        "row for each",
    ),
    "a word that is not known": (lambda s, c, f: s.visible((1, 2, 3), PLACES, unproven="no"), "unproven", "as-visible"),
    "trees": (lambda s, c, f: belvedere.Scene(c, trees="bare"), "trees", "porous"),
    "orient": (lambda s, c, f: belvedere.Scene(c, orient="down"), "orient", "pulses"),
    "two ways to orient": (
        lambda s, c, f: belvedere.Scene(c, orient="up", scanner=(1, 2, 3)), "orient and scanner", "one of them"),
    "stations of three columns": (lambda s, c, f: belvedere.Scene(c, stations=PLACES), "stations", "four columns"),
    "a station twice": (
        lambda s, c, f: belvedere.Scene(c, stations=[[1, 2, 3, 4], [1, 2, 3, 5]]), "stations", "once"),
    "nobody who looks": (lambda s, c, f: s.viewshed(), "observers", "target"),
    "observers and a target": (
        lambda s, c, f: s.viewshed((1, 2), target=(1, 2)), "observers, target and spread", "one of"),
    "height below the ground": (lambda s, c, f: s.viewshed((1, 2), target_height=-1), "target_height", "0 metres"),
    "eye below the ground": (
        lambda s, c, f: s.line_of_sight((1, 2), (3, 4), observer_height=-0.5), "observer_height", "0 metres"),
    "cells below the ground": (lambda s, c, f: s.sky_view(target_height=-1), "target_height", "0 metres"),
    "far cells without terrain": (lambda s, c, f: s.viewshed((1, 2), far=True), "far", "with_terrain"),
    "azimuths of a target": (
        lambda s, c, f: s.viewshed(target=(1, 2), azimuth_range_deg=(0, 90)), "azimuth_range_deg", "one observer"),
    "two targets": (lambda s, c, f: s.viewshed(target=[(1, 2), (3, 4)]), "target", "one"),
    "method": (lambda s, c, f: belvedere.Scene(c, method="best"), "method", "carved"),
    "rule": (lambda s, c, f: belvedere.Scene(c, without="houses"), "without", "crowns"),
    "radius": (lambda s, c, f: belvedere.Scene(c, max_radius=-1), None, "above"),
    "array as cloud": (lambda s, c, f: belvedere.Scene(PLACES), "cloud", "belvedere.Cloud"),
    "cell": (lambda s, c, f: s.shadow(sun=(180, 30), cell=0), "cell", "above zero"),
    "cell as text": (lambda s, c, f: s.shadow(sun=(180, 30), cell="1"), "cell", "number"),
    "cell with targets": (lambda s, c, f: s.shadow(sun=(180, 30), cell=1, targets=PLACES), "cell", "grid"),
    "normals of cells": (lambda s, c, f: s.shadow(sun=(180, 30), normals=PLACES), "normals", "targets"),
    "normals of another length": (
        lambda s, c, f: s.shadow(sun=(180, 30), targets=PLACES, normals=np.ones((2, 3))), "normals", "1 rows"),
    "share of light": (lambda s, c, f: s.shadow(sun=(180, 30), through_trees=2.0), "through_trees", "0 (opaque)"),
    "leaves alone": (lambda s, c, f: s.shadow(sun=(180, 30), leaves="on"), "leaves", "seasons"),
    "location in the wrong order": (
        lambda s, c, f: s.shadow(time="2026-06-21T15:00Z", location=(140, 52)), "location", "-90"),
    "progress": (lambda s, c, f: s.shadow(sun=(180, 30), progress="yes"), "progress", "function"),
    "cloud without points": (lambda s, c, f: belvedere.Cloud(np.empty((0, 3))), "xyz", "at least one"),
    "cloud with a hole": (lambda s, c, f: belvedere.Cloud(hole(PLACES)), "xyz", "remove"),
    "cloud of two columns": (lambda s, c, f: belvedere.Cloud(PLACES[:, :2]), "xyz", "(N, 3)"),
    "cloud in degrees": (lambda s, c, f: belvedere.Cloud([[5.0, 52.0, 1.0]], crs="EPSG:4326"), "crs", "convert"),
    "system that is not known": (lambda s, c, f: belvedere.Cloud(PLACES, crs="EPSG:99999999"), None, ""),
    "attribute of another length": (
        lambda s, c, f: belvedere.Cloud(PLACES, classification=[1, 2]), "classification", "row for each point"),
    "classes that do not fit": (
        lambda s, c, f: belvedere.Cloud(PLACES, classification=[300]), "classification", "uint8"),
    "bytes without a name": (lambda s, c, f: belvedere.read(b"1 2 3"), "name", "extension"),
    "damaged bytes": (lambda s, c, f: belvedere.read(b"no LAS file", name="x.laz"), None, ""),
    "format": (lambda s, c, f: belvedere.read(b"", name="x.docx"), "point cloud format", ".laz"),
    "axis": (lambda s, c, f: belvedere.read(b"1 2 3", name="x.xyz", up="x"), "up", "'y'"),
    "box of three corners": (lambda s, c, f: belvedere.read(f / "tile.laz", bounds=[(0, 0)] * 3), "bounds", "corner"),
    "box inside out": (lambda s, c, f: belvedere.read(f / "tile.laz", bounds=[(1, 0), (0, 1)]), "bounds", "lowest"),
    "class": (lambda s, c, f: belvedere.read(f / "tile.laz", classes=[256]), "classes", "255"),
    "class by name": (lambda s, c, f: belvedere.read(f / "tile.laz", classes="ground"), "classes", "[2, 6]"),
    "list without files": (lambda s, c, f: belvedere.read([]), "source", "at least one"),
    "cloud as balls": (lambda s, c, f: belvedere.Scene.load(f / "tile.laz"), "ball file", "Scene(read"),
    "town": (lambda s, c, f: belvedere.simulate("city"), "town", "village"),
    "extent": (lambda s, c, f: belvedere.simulate(extent=5), "extent", "60"),
    "observers": (lambda s, c, f: s.viewshed([[1.0]]), "observers", "(N, 2)"),
    "observer far away": (lambda s, c, f: s.viewshed((0, 0, 0)), "observers", "coordinates"),
    "two landmarks": (lambda s, c, f: s.landmark("a.obj", target_class=6), "landmark", "one of"),
    "protected view of nothing": (lambda s, c, f: s.protected_view((1, 2)), "landmark", "one of"),
    "class of windows": (
        lambda s, c, f: s.window_views({"x": [1], "y": [1], "z": [1], "azimuth": [0]}, classes={1: "sky"}),
        "classes", "'vegetation'"),
    "spacing of a table of windows": (
        lambda s, c, f: s.window_views({"x": [1], "y": [1], "z": [1], "azimuth": [0]}, spacing=1),
        "spacing and objects", "mesh"),
    "frequency": (
        lambda s, c, f: s.line_of_sight((1, 2, 3), (4, 5, 6), frequency_ghz=0), "frequency_ghz", "1000"),
    "Fresnel zone without a frequency": (
        lambda s, c, f: s.cameras("roofs", count=1, fresnel_percent=60), "fresnel_percent", "frequency_ghz"),
    "radiation": (lambda s, c, f: s.irradiance(), "radiation", "weather="),
    "albedo": (lambda s, c, f: s.irradiance(clear_sky="ineichen", albedo=2), "albedo", "0 to 1"),
    "body": (lambda s, c, f: s.heat(weather=f / "weather.csv", date="07-21", body="cat"), "body", "'round'"),
    "wind": (lambda s, c, f: s.heat(weather=f / "weather.csv", date="07-21", wind_factor=9), "wind_factor", "0 to 2"),
    "day of heat": (lambda s, c, f: s.heat(weather=f / "weather.csv"), "period", "days"),
    "tower without a tip": (lambda s, c, f: s.towers({"x": [1], "y": [1]}), "towers", "tip"),
    "tower of a kilometre": (
        lambda s, c, f: s.towers({"x": [154990], "y": [462980], "tip": [1500]}), "towers", "1000 metres"),
    "view": (lambda s, c, f: s.depth_map(), "view", "one of"),
    "route of one corner": (lambda s, c, f: s.comfort(route=[(1, 2)], date="2026-06-21"), "route", "2 at least"),
    "windows without azimuth": (
        lambda s, c, f: s.comfort(windows={"x": [1], "y": [1], "z": [1]}, date="2026-06-21"), "windows", "azimuth"),
    "parcel of two corners": (
        lambda s, c, f: s.envelope([(1, 2), (3, 4)], protect=[(1, 2)], sun=(180, 30)), "parcel", "3 at least"),
    "protected sun below the horizon": (
        lambda s, c, f: s.envelope([(1, 2), (3, 4), (5, 0)], protect=[(1, 2)], sun=(180, -3)), "sun", "above 0"),
    "a clock as time": (lambda s, c, f: s.shadow(time="15:00"), "time", "+02:00"),
    "a day as time": (lambda s, c, f: s.shadow(time="2026-06-21"), "time", "+02:00"),
    "zone as number": (lambda s, c, f: s.sun_hours(date="2026-06-21", zone=2), "zone", "Europe/Amsterdam"),
    "year as text": (lambda s, c, f: s.hourly_sun("2026"), "year", "whole number"),
    "directions as fraction": (lambda s, c, f: s.sky_view(directions=5.5), "directions", "whole number"),
    "distance as text": (lambda s, c, f: s.viewshed((1, 2), max_distance="far"), "max_distance", "number"),
    "step as text": (lambda s, c, f: s.sun_hours(date="2026-06-21", time_step_min="1"), "time_step_min", "number"),
    "headings as fraction": (lambda s, c, f: s.cameras("roofs", count=1, headings=2.5), "headings", "whole number"),
    "pixels as text": (lambda s, c, f: s.cameras("roofs", count=1, pixels="many"), "pixels", "number"),
    "count below zero": (lambda s, c, f: s.survey_plan("ground", sun=(180, 30), count=-1), "count", "range"),
    "class above 255": (lambda s, c, f: s.landmark(target_class=256), "target_class", "range"),
    "year that no calendar has": (lambda s, c, f: s.sun_hours(date="equinox", year=10**6), "year", "range"),
    "light as list": (lambda s, c, f: s.sky_view(through_trees=[0.5]), "through_trees", "number"),
    "switch as word": (lambda s, c, f: s.sky_view(interval="no"), "interval", "True or False"),
    "air of another elevation": (
        lambda s, c, f: s.sun_hours(date="2026-06-21", sun_elevation="geometric", air=(1013, 15)), "air", "leave it"),
    "goal of cameras": (lambda s, c, f: s.cameras("roofs"), "count and coverage_percent", "one of them"),
    "weather and clear sky": (
        lambda s, c, f: s.irradiance(weather=f / "weather.csv", clear_sky="bird"), "weather and clear_sky", "one of"),
    "turbidity of another sky": (lambda s, c, f: s.irradiance(clear_sky="bird", linke=3), "linke", "ineichen"),
    "true as word": (lambda s, c, f: s.viewshed((1, 2), curvature=True), "curvature", "word"),
    "true as clear sky": (lambda s, c, f: s.irradiance(clear_sky=True), "clear_sky", "word"),
    "targets as file": (lambda s, c, f: s.shadow(sun=(180, 30), targets="a.shp"), "targets", "read the file"),
    "targets of other columns": (
        lambda s, c, f: s.shadow(sun=(180, 30), targets={"lat": [52], "lon": [5]}), "targets", "columns x and y"),
    "targets of words": (
        lambda s, c, f: s.shadow(sun=(180, 30), targets={"x": ["a"], "y": ["b"]}), "targets", "number"),
    "windows as rows": (lambda s, c, f: s.window_views([(1, 2, 3, 180)]), "windows", "by name"),
    "towers as rows": (lambda s, c, f: s.towers([(1, 2, 100)]), "towers", "by name"),
    "windows of words": (
        lambda s, c, f: s.window_views({"x": [1], "y": [1], "z": [1], "azimuth": ["south"]}), "windows", "azimuth"),
    "class as polygon": (lambda s, c, f: s.without(6), "polygon", "class_=6"),
    "file as polygon": (lambda s, c, f: s.without("house.geojson"), "polygon", "corners"),
    "point as polygon": (lambda s, c, f: s.without((1, 2)), "polygon", "corners"),
    "class by its name": (lambda s, c, f: s.landmark(target_class="building"), "target_class", "whole number"),
    "raster as terrain": (lambda s, c, f: s.with_terrain(PLACES), "path", "path of a file"),
    "table as horizon": (lambda s, c, f: s.with_horizon([(0, 10)]), "path", "path of a file"),
    "one side of a picture": (lambda s, c, f: s.depth_map(eye=(1, 2, 3), size=512), "size", "(640, 480)"),
    "picture as GeoTIFF": (lambda s, c, f: s.shadow(sun=(180, 30), cell=8).to_geotiff(f / "x.png"), "path", ".tif"),
    "plan as file": (
        lambda s, c, f: s.sunlight_report(f / "r.html", areas={"a": WALL}, planned="a.obj"), "planned", "with_added"),
    "system as name": (lambda s, c, f: belvedere.Cloud(PLACES, crs=True), "crs", "EPSG:28992"),
    "box of three numbers": (lambda s, c, f: belvedere.read(f / "tile.laz", bounds=(1, 2, 3)), "bounds", "west"),
}  # fmt: skip


@pytest.mark.parametrize("name", WRONG)
def test_wrong_call(name, scene, cloud, folder):
    call, what, advice = WRONG[name]
    with pytest.raises(belvedere.BelvedereError) as caught:
        call(scene, cloud, folder)
    error = caught.value
    assert isinstance(error, ValueError)
    if what is not None:
        assert error.what == what, error.what
    assert advice in error.advice or advice in str(error), f"{error} | {error.advice}"
    assert error.advice and str(error)


def test_fields_that_questions_lack_are_not_left_out_in_silence(scene):
    for place in ({"zones": "UTC"}, {"refraction": {"air": {"pressure": 1013, "temperature": 15, "humidity": 0.5}}}):
        with pytest.raises(TypeError, match=r"no field (zones|humidity)"):
            scene._core.sun_positions({"times": ["2026-06-21T15:00Z"], "place": place})


def test_numbers_of_numpy_are_numbers(scene):
    named = {"directions": np.int64(9), "cell": np.float32(8), "interval": np.bool_(False)}
    plain = {name: value.item() for name, value in named.items()}
    factors = [scene.sky_view(**numbers)["sky_view_factor"].values for numbers in (named, plain)]
    assert np.array_equal(*factors, equal_nan=True)


def test_files_that_are_missing_or_refused_raise_what_python_raises(folder, scene):
    for call in (belvedere.read, belvedere.Scene.load):
        with pytest.raises(FileNotFoundError) as caught:
            call(folder / "nothing.laz")
        assert "nothing.laz" in str(caught.value) and caught.value.filename.endswith("nothing.laz")
    with pytest.raises(OSError):
        scene.shadow(sun=(180, 30)).to_geotiff(folder / "no folder" / "x.tif")
    (folder / "a_file").write_text("x")
    with pytest.raises(OSError):
        scene.save(folder / "a_file" / "x.npz")


def test_a_scene_without_a_place_on_earth_says_how_to_give_one(scene, cloud):
    nowhere = belvedere.Scene(belvedere.Cloud(cloud.xyz), method="tau", orient="up")
    with pytest.raises(belvedere.BelvedereError, match="location is unknown"):
        nowhere.shadow(time="2026-06-21T15:00Z")
    assert nowhere.shadow(time="2026-06-21T15:00Z", location=(52, 5)).values.size


def test_errors_can_be_pickled():
    import pickle

    error = pickle.loads(pickle.dumps(belvedere.BelvedereError("m", "w", "v", "a")))
    assert (str(error), error.what, error.value, error.advice) == ("m", "w", "v", "a")


def test_points_left_out_and_observers_skipped_are_warned_of(scene, standing):
    with pytest.warns(belvedere.BelvedereWarning, match="left out"):
        belvedere.read(b"x y z\n1 2 3\nnan 2 3\n4 5 6\n", name="x.csv")
    x, y = standing
    with pytest.warns(belvedere.BelvedereWarning, match=r"1 of 2 targets \(50 %\) are outside the cloud"):
        lit = scene.shadow(sun=(180, 30), targets=[(x, y, 30.0), (0.0, 0.0, 0.0)])
    assert np.isfinite(lit[0]) and np.isnan(lit[1])
    with pytest.warns(belvedere.BelvedereWarning, match="observer 2 at .* is skipped"):
        scene.viewshed([(x, y), (0.0, 0.0)], cell=2)


def test_no_time_of_pandas_says_so(scene):
    pandas = pytest.importorskip("pandas")
    with pytest.raises(belvedere.BelvedereError, match="leave it out"):
        scene.shadow(time=[pandas.Timestamp("2026-06-21T15:00Z"), pandas.NaT])


def test_names_that_results_lack_are_answered_with_those_they_have(scene):
    hours = scene.sun_hours(date="2026-06-21", time_step_min=60, cell=8)
    table = scene.network([(154985, 462975, 30), (154990, 462975, 30)])
    for wrong, error, said in [
        (lambda: hours["sunhours"], KeyError, "sun_hours"),
        (lambda: hours.sun_hours, AttributeError, r"\['sun_hours'\]"),
        (lambda: hours.plot(), AttributeError, "by name"),
        (lambda: table["anser"], KeyError, "answer"),
        (lambda: table.answer, AttributeError, r"\['answer'\]"),
        (lambda: table[:5], TypeError, "to_pandas"),
        (lambda: table[["a", "b"]], TypeError, "to_pandas"),
    ]:
        with pytest.raises(error, match=said):
            wrong()
