"""Parameters follow from what the program describes."""

from __future__ import annotations

import re

import pytest

ALL = {"viewshed", "line-of-sight", "isovist", "horizon", "towers", "landmark", "protected-view", "window-views", "cameras"} | {
    *("survey-plan", "shadow", "sun-hours", "sky-view", "irradiance", "heat", "envelope", "comfort", "report", "surfaces", "fetch", "glare"),
    *("sun-calendar", "sun-position", "difference", "info", "balls", "calibrate", "normals", "trajectory", "simulate", "cache"),
}
# First parameters that are no point clouds.
FIRST = {"fetch": "place", "difference": "raster", "simulate": "choice", "cache": "flag"}


def parameter(commands, command, flag):
    return next(one for one in commands[command].parameters if one.flag == flag)


def test_every_algorithm_has_a_cloud_a_result_and_help(commands):
    assert set(commands) == ALL
    for command in commands.values():
        first = command.parameters[0]
        assert first.kind == FIRST.get(command.name, "files"), command.name
        assert first.is_required or command.name in ("sun-position", "simulate", "cache")
        usual = [output.kind for output in command.outputs if output.is_usual]
        assert usual and len(set(usual)) == len(usual) <= 2, command.name
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
        ("cameras", "--tilt", {"kind": "text", "is_repeatable": True}),
        ("difference", "before", {"kind": "raster", "is_required": True}),
        ("viewshed", "--terrain", {"kind": "raster", "is_required": False}),
        ("viewshed", "--add", {"kind": "files", "is_required": False}),
        ("viewshed", "--lines", {"kind": "text", "label": "Read only the points of some flight lines: point source ids such as 1,2,17"}),
        ("shadow", "--location", {"kind": "place"}),
        ("shadow", "--sun", {"kind": "text", "is_repeatable": True}),
        ("shadow", "--soft", {"kind": "flag", "default": False}),
        ("heat", "--areas", {"kind": "layer", "geometry": "polygon"}),
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
    assert kinds("info") == {"PAGE": ("page", (".html",))}
    assert kinds("line-of-sight")["OUTPUT"] == ("table", (".csv",))
    assert kinds("irradiance")["PLANES"] == ("vector", (".geojson",))
    assert kinds("sky-view")["MEASURES"] == ("folder", ())
    assert kinds("envelope")["OUTPUT_FILE"][1] == (".npy", ".png", ".ply", ".obj")


def test_results_are_named_by_what_the_program_says_of_each_kind_of_file(commands):
    labels = {(name, output.key): output.label for name, command in commands.items() for output in command.outputs}
    assert labels["cameras", "OUTPUT"] == "Where to put cameras: cameras per cell"
    assert labels["cameras", "OUTPUT_AREAS"] == "Where to put cameras: cameras"
    assert labels["viewshed", "OUTPUT_FILE"] == "Viewshed: map or points (.png .laz .las .ply)"
    assert labels["viewshed", "FAR_OUTPUT_AREAS"] == "Far output: visible areas"
    assert labels["sky-view", "MEASURES"] == "Folder for a raster of each measure of a grid"
    assert all(len(command_labels) == len(set(command_labels)) for command_labels in ([one.label for one in c.outputs] for c in commands.values()))


def test_an_area_to_clear_is_a_layer_and_a_class_is_typed(commands):
    found = {one.key: (one.kind, one.geometry) for one in commands["shadow"].parameters if one.flag == "--clear"}
    assert found == {"CLEAR": ("layer", "polygon"), "CLEAR_TEXT": ("text", "any")}


def test_units_are_in_the_labels(commands):
    assert parameter(commands, "viewshed", "--observer-height").label == "Height of observers above the ground in metres"
    assert parameter(commands, "sun-hours", "--min-sun-elevation").label.endswith("in degrees")
    assert parameter(commands, "shadow", "--frame-duration-s").label == "Duration of a frame in seconds"
    assert parameter(commands, "shadow", "--time").label == "An instant: 2026-06-21T15:00, or 2026-06-21T15:00+02:00 (separate several with ;)"


def test_no_text_of_a_dialog_speaks_of_a_command_line(commands):
    typed = re.compile(r"(?<![\w-])(?:--[a-z]|-[ov]\b)|belvedere|\bflags?\b|standard output|command line|repeatable|LAT,LON|\[default|\0")
    for command in commands.values():
        texts = [command.title, command.summary, command.description]
        for one in command.parameters:
            texts += [one.label, one.help, *(text for _, text in one.choices), *(output.label for output in one.outputs)]
        for text in texts:
            assert not typed.search(text), (command.name, text)
            assert len(text.splitlines()) > 1 or text == text.strip(), (command.name, text)


def test_texts_keep_minus_signs_and_name_fields_of_other_dialogs(commands):
    assert "x, -z, y" in parameter(commands, "viewshed", "--up").help
    assert "en17037-minimum, -medium, -high" in commands["sun-hours"].description
    assert 'made without and with "Add a mesh to the scene" or "Clear what stands in an area"' in " ".join(commands["difference"].description.split())
    assert "as one JSON object" not in commands["info"].description


def test_an_empty_field_says_what_the_program_does_then(commands):
    assert "If empty: that of a given time, else of the place." in parameter(commands, "shadow", "--zone").help
    assert "If empty" not in parameter(commands, "viewshed", "--observer-height").help
