"""Styles are well-formed, and have a colour for each value."""

from __future__ import annotations

import colorsys
import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest

from belvedere_qgis import style


def parse(text):
    return ElementTree.fromstring(text.split("\n", 1)[1])


def test_answers_have_colours_of_their_own_and_counts_a_ramp():
    entries = parse(style.raster("viewshed", "OUTPUT", 0, 1, is_bytes=True)).findall(".//paletteEntry")
    assert [(entry.get("value"), entry.get("label")) for entry in entries] == [
        ("0", "blocked"),
        ("1", "nothing blocks it"),
    ]
    counted = parse(style.raster("viewshed", "OUTPUT", 0, 7, is_bytes=False)).find(".//colorrampshader")
    assert (counted.get("minimumValue"), counted.get("maximumValue")) == ("0.0", "7")


def test_each_code_of_an_answer_has_the_words_of_the_program():
    source = Path(__file__).parents[3] / "crates/belvedere-apps/src/ask/line_of_sight.rs"
    words = re.findall(r'^ +(?:Answer::\w+|_) => "([a-z ]+)",$', source.read_text(encoding="utf-8"), re.MULTILINE)
    assert "inside an obstacle" in words
    assert [code for code, _, _ in style.SIGHTS] == list(range(6))
    assert {label for _, _, label in style.SIGHTS} == set(words)
    entries = parse(style.raster("viewshed", "OUTPUT", 0, 5, is_bytes=True)).findall(".//paletteEntry")
    assert [(int(entry.get("value")), entry.get("label")) for entry in entries[2:]] == [(code, label) for code, _, label in style.SIGHTS[2:]]
    assert len({entry.get("color") for entry in entries if entry.get("value") in "0125"}) == 4


@pytest.mark.parametrize(("command", "key"), sorted(style.RAMPS))
def test_a_ramp_covers_the_values_in_order(command, key):
    made = parse(style.raster(command, key, -3.0, 900.0, is_bytes=False))
    values = [float(item.get("value")) for item in made.findall(".//item")]
    assert values == sorted(values) and len(set(values)) == len(values) >= 4
    if (command, key) in (("sky-view", "OUTPUT"), ("shadow", "OUTPUT")):
        assert (values[0], values[-1]) == (0.0, 1.0)


def test_no_change_is_the_middle_of_its_ramp():
    items = parse(style.raster("difference", "OUTPUT", -1.0, 4.0, is_bytes=False)).findall(".//item")
    assert [float(item.get("value")) for item in (items[0], items[3], items[-1])] == [-4.0, 0.0, 4.0]
    assert items[3].get("color") == "#f7f7f7"


def test_a_raster_of_one_value_still_has_a_ramp():
    values = {float(item.get("value")) for item in parse(style.raster("sun-hours", "OUTPUT", 0.0, 0.0, False)).findall(".//item")}
    assert len(values) > 2


@pytest.mark.parametrize(("command", "key"), sorted(style.FIELDS))
@pytest.mark.parametrize("geometry", ["point", "line", "polygon"])
def test_a_vector_style_has_a_symbol_for_each_class(command, key, geometry):
    made = parse(style.vector(command, key, geometry, 0.0, 10.0))
    classes = made.findall(".//category") + made.findall(".//range")
    symbols = {symbol.get("name") for symbol in made.findall(".//symbols/symbol")}
    assert classes and {one.get("symbol") for one in classes} == symbols


def luminance(color):
    return sum(share * int(color[at : at + 2], 16) for share, at in ((0.2126, 1), (0.7152, 3), (0.0722, 5)))


@pytest.mark.parametrize("colors", [style.VIRIDIS, style.INFERNO, style.DAY])
def test_ramps_grow_lighter_so_that_they_need_no_hue(colors):
    lights = [luminance(color) for color in colors]
    assert lights == sorted(lights)


def test_answers_differ_for_those_who_see_no_red_or_no_green():
    # blue against yellow is what remains to them, and lightness
    colors = {
        name: colorsys.rgb_to_hls(*(int(color[at : at + 2], 16) / 255 for at in (1, 3, 5)))
        for name, color in (("visible", style.VISIBLE), ("unproven", style.UNPROVEN), ("blocked", style.BLOCKED))
    }
    assert 30 <= colors["visible"][0] * 360 <= 65 and 200 <= colors["unproven"][0] * 360 <= 250
    assert colors["blocked"][2] < 0.1


def test_only_two_modules_import_qt_and_all_through_qgis():
    sources = {path.name: path.read_text(encoding="utf-8") for path in Path(style.__file__).parent.glob("*.py")}
    for name, text in sources.items():
        assert not re.search(r"^\s*(from|import) +PyQt", text, re.MULTILINE), name
    without = {name for name, text in sources.items() if "from qgis" not in text and "import qgis" not in text}
    assert without >= {"command_line.py", "description.py", "program.py", "style.py"}
