"""Parameters follow from what the program describes."""

from __future__ import annotations

import pytest

ALL = {"viewshed", "line-of-sight", "isovist", "horizon", "towers", "landmark", "protected-view", "window-views", "cameras"} | {
    *("survey-plan", "shadow", "sun-hours", "sky-view", "irradiance", "heat", "envelope", "comfort", "report", "surfaces", "fetch", "glare")
}


def parameter(commands, command, flag):
    return next(one for one in commands[command].parameters if one.flag == flag)


def test_every_algorithm_has_a_cloud_a_result_and_help(commands):
    assert set(commands) == ALL
    for command in commands.values():
        first = "place" if command.name == "fetch" else "files"
        assert command.parameters[0].kind == first and command.parameters[0].is_required
        assert [output.is_usual for output in command.outputs].count(True) == 1, command.name
        assert command.description and command.summary
        keys = [one.key for one in command.parameters if one.kind != "written"] + [one.key for one in command.outputs]
        assert len(keys) == len(set(keys)), command.name
        for one in command.parameters:
            assert one.help and 0 < len(one.label) <= 100, one


@pytest.mark.parametrize(
    ("command", "flag", "expected"),
    [
        ("viewshed", "--observer", {"kind": "point", "is_repeatable": True}),
        ("viewshed", "--observers", {"kind": "layer", "label": "Observers"}),
        ("viewshed", "--observer-height", {"kind": "number", "default": 1.7, "is_advanced": False}),
        # a sentence is no value: the program decides
        ("viewshed", "--cell", {"kind": "number", "default": None}),
        ("viewshed", "--shell", {"is_advanced": True}),
        ("viewshed", "--trees", {"is_advanced": True}),
        ("viewshed", "--crs", {"kind": "crs", "is_advanced": False}),
        ("line-of-sight", "--pairs", {"kind": "layer", "geometry": "line"}),
        ("line-of-sight", "--random", {"kind": "integer"}),
        ("towers", "--towers", {"kind": "layer", "geometry": "point", "is_required": True}),
        ("landmark", "--targets", {"kind": "file"}),
        ("landmark", "--target-polygon", {"kind": "layer", "geometry": "polygon"}),
        ("cameras", "--candidates", {"kind": "layer", "geometry": "any"}),
        ("cameras", "--on-roofs", {"kind": "number"}),
        ("cameras", "--private", {"kind": "layer"}),
        ("shadow", "--sun", {"kind": "text", "is_repeatable": True}),
        ("shadow", "--soft", {"kind": "flag", "default": False}),
        ("sun-hours", "--time-step-min", {"kind": "number", "default": 10.0}),
        ("envelope", "--parcel", {"kind": "layer", "geometry": "polygon", "is_required": True}),
        ("envelope", "--protect", {"kind": "layer", "geometry": "any", "is_required": True}),
        ("envelope", "--sun-elevation", {"kind": "choice", "default": 0}),
        ("irradiance", "--threads", {"is_advanced": True}),
        ("fetch", "--at", {"kind": "place", "is_required": True}),
        ("fetch", "--radius", {"kind": "number", "default": 200.0}),
    ],
)
def test_a_parameter_becomes(commands, command, flag, expected):
    found = parameter(commands, command, flag)
    assert {name: getattr(found, name) for name in expected} == expected


def test_a_result_becomes_a_destination_for_each_kind_of_layer(commands):
    def kinds(command):
        return {output.key: (output.kind, output.formats) for output in commands[command].outputs}

    assert kinds("viewshed")["OUTPUT"] == ("raster", (".tif",))
    assert kinds("viewshed")["OUTPUT_AREAS"] == ("vector", (".geojson",))
    assert kinds("viewshed")["OUTPUT_FILE"] == ("file", (".png", ".laz", ".las", ".ply"))
    assert kinds("viewshed")["HEIGHTS"] == ("raster", (".tif",))
    assert kinds("cameras")["OUTPUT"] == ("raster", (".tif",))
    cameras = {output.key: output.label for output in commands["cameras"].outputs}
    assert cameras["OUTPUT_AREAS"] == "Cameras as points"
    assert kinds("line-of-sight")["OUTPUT"] == ("table", (".csv",))
    assert kinds("irradiance")["PLANES"] == ("vector", (".geojson",))
    assert kinds("sky-view")["MEASURES"] == ("folder", ())
    assert kinds("envelope")["OUTPUT_FILE"][1] == (".npy", ".png", ".ply", ".obj")


def test_units_are_in_the_labels(commands):
    assert parameter(commands, "viewshed", "--observer-height").label == "Height of observers above the ground in metres"
    assert parameter(commands, "sun-hours", "--min-sun-elevation").label.endswith("in degrees")
    assert parameter(commands, "shadow", "--time").label == "An instant (separate several with ;)"
