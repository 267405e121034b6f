"""Errors of the program say which field of a dialog to mend."""

from __future__ import annotations

import pytest

from belvedere_qgis import program

CLOUD = "missing.laz"


@pytest.mark.parametrize(
    ("command", "typed", "expected"),
    [
        ("viewshed", [], 'Please give one of "An observer", "Observers", "Total viewshed", "Reverse viewshed"'),
        ("irradiance", [], 'Please give one of "Weather file", "Model of a year without clouds"'),
        ("viewshed", ["--observer=1,2", "--spread=3"], '"An observer" cannot be used with "Total viewshed"'),
        ("viewshed", ["--observer=1,2", "--far-output=x.tif"], 'Please give "Terrain beyond the cloud"'),
        ("sky-view", ["--cell=-3"], "invalid value '-3' for \"Side of a cell\": must be a number above zero"),
        ("sun-hours", ["--rule=foo"], '"Daylight rule by name": rule is foo, but must be a name such as nl-light'),
        ("sun-calendar", ["--at=1,2"], 'days are missing: give "A day", "First day of a period" and "Last day of a period", or "Daylight rule'),
    ],
)
def test_an_error_has_the_labels_of_the_fields(commands, binary, tmp_path, command, typed, expected):
    out = [f"--output={tmp_path / ('x.csv' if command == 'sun-calendar' else 'x.tif')}"]
    with pytest.raises(program.ProgramError) as caught:
        program.run(binary, [command, *typed, *out, "--", CLOUD])
    said = commands[command].reworded(str(caught.value))
    assert said.startswith(expected) and "--" not in said and "Usage" not in said, said


def test_what_the_dialog_has_not_stays_in_an_error(commands):
    said = commands["viewshed"].reworded("the folder is full: use --no-cache, or another --cell; see `belvedere cache`")
    assert said == 'the folder is full: use --no-cache, or another "Side of a cell"; see "Kept scenes"'
