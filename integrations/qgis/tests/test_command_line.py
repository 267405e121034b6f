"""The command line of an algorithm."""

from __future__ import annotations

import subprocess

from belvedere_qgis.command_line import arguments


def test_values_become_flags_and_defaults_are_left_to_the_program(commands):
    values = {
        "CLOUDS": ["a.laz", "-b.laz"],
        "OBSERVER": "84000.25,447000.5",
        "OBSERVER_HEIGHT": 1.7,
        "TARGET_HEIGHT": 2,
        "CURVATURE": 1,
        "UNPROVEN": None,
        "GRID_NORTH": True,
        "KEEP_NOISE": False,
        "AZIMUTH_RANGE": "-10,60",
        "GROUND": "",
    }
    made = arguments(commands["viewshed"], values, {"OUTPUT": "seen.tif", "OUTPUT_AREAS": "areas.geojson", "HEIGHTS": None})
    assert made[0] == "viewshed" and made[-3:] == ["--", "a.laz", "-b.laz"]
    assert set(made[1:-3]) == {
        "--observer=84000.25,447000.5",
        "--target-height=2.0",
        "--curvature=on",
        "--grid-north",
        "--azimuth-range=-10,60",
        "--output=seen.tif",
        "--output=areas.geojson",
    }


def test_several_texts_are_separated_by_semicolons(commands):
    made = arguments(commands["shadow"], {"CLOUDS": ["a"], "SUN": "180,30; 200.5,20;"}, {"OUTPUT": "x.tif"})
    assert [one for one in made if one.startswith("--sun")] == ["--sun=180,30", "--sun=200.5,20"]


def test_what_is_no_flag_stands_behind_the_flags(commands):
    made = arguments(commands["difference"], {"BEFORE": "a.tif", "AFTER": "b.tif", "TITLE": "Plan"}, {"OUTPUT": "x.tif"})
    assert made == ["difference", "--title=Plan", "--output=x.tif", "--", "a.tif", "b.tif"]
    assert arguments(commands["info"], {"CLOUDS": ["a.laz"]}, {"PAGE": "x.html"}) == ["info", "--", "a.laz"]


def test_the_program_takes_what_is_built_for_every_parameter(commands, binary, tmp_path):
    """Each value alone reaches the point where the program misses the cloud: no flag is unknown, and none is refused by its form."""
    samples = {"number": 3.0, "integer": 2, "flag": True, "crs": "EPSG:28992", "point": "1.5,2.5"}
    forms = {
        "--sun": "180,30",
        "--date": "2026-06-21",
        "--time": "2026-06-21T12:00Z",
        "--rule": "nl-light",
        "--ground": "found",
    }
    forms |= {
        "--location": "52,4",
        "--air": "1013,10",
        "--between": "10:00,14:00",
        "--through-trees": "seasons",
        "--orient": "up",
    }
    forms |= {"--lines": "1,2", "--only-classes": "2,6", "--tilt": "10; 20", "--without": "crowns,relief", "--clear": "class:6"}
    forms |= {"--density": "identify", "--azimuth-range": "10,60", "--elevation-range": "0,20", "--memory": "3G"}
    forms |= {"--bounds": "1,2,3,4", "--class": "26=ground", "--map-of": "sky", "--neighbors": "12"}
    table = tmp_path / "table.csv"
    table.write_text("x,y\n1,2\n")
    seen = 0
    for command in commands.values():
        if "CLOUDS" not in [one.key for one in command.parameters]:
            # they miss no cloud, and would go to the internet, or work: see the test in QGIS
            continue
        for one in command.parameters:
            if one.key == "CLOUDS" or one.kind == "written":
                continue
            value = forms.get(one.flag) or samples.get(one.kind) or "2026-06-21"
            if one.kind in ("file", "layer", "raster"):
                value = str(table)
            if one.kind == "files":
                value = [str(table)]
            if one.kind == "choice":
                value = 0 if one.default else 1
            made = arguments(command, {one.key: value, "CLOUDS": ["missing.laz"]}, {})
            flags = [part for part in made if part.startswith(one.flag)]
            if not flags:
                assert value == one.default
                continue
            done = subprocess.run([binary, *made], capture_output=True, text=True, cwd=tmp_path, check=False)
            assert done.returncode != 0
            assert "unexpected argument" not in done.stderr and "invalid value" not in done.stderr, (made, done.stderr)
            seen += 1
    assert seen > 200
