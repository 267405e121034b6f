"""Glare: as the program finds it, and as the image of an eye in a mirror says."""

import csv

import belvedere
import numpy as np
import pytest

# a pane high above the town that faces south, and one beside it
PANES = {
    "name": ["a", "b"],
    "x": [155000.0, 155006.0],
    "y": [463020.0, 463020.0],
    "z": [60.0, 60.0],
    "azimuth": [180.0, 180.0],
    "width": [4.0, 4.0],
    "height": [3.0, 3.0],
}
EYES = [(155000.0, 462990.0, 37.0), (154980.0, 463000.0, 45.0)]
DAY = {"date": "2026-03-21", "zone": "Europe/Amsterdam"}


def test_glare_is_that_of_the_program(scene, run_program, folder):
    rows = zip(*PANES.values(), strict=True)
    table = [",".join(PANES), *(",".join(str(value) for value in row) for row in rows)]
    (folder / "panes.csv").write_text("\n".join(table) + "\n")
    (folder / "eyes.csv").write_text("x,y,z\n" + "".join(f"{x},{y},{z}\n" for x, y, z in EYES))
    run_program(
        *("glare", "tile.laz", "--reflectors", "panes.csv", "--observers", "eyes.csv", "--date", DAY["date"]),
        *("--zone", DAY["zone"], "-o", "glare.csv", "--by-hour", "glare_hours.csv"),
    )
    found = scene.glare(PANES, EYES, **DAY)
    with open(folder / "glare.csv", newline="") as file:
        expected = list(csv.DictReader(file))
    assert len(expected) == 6 and list(found) == list(expected[0])
    assert [row["name"] for row in expected] == list(found["name"]) == ["a", "b", "all"] * 2
    for name in ("observer", "reflector", "hours", "after_image_hours", "days", "longest_min"):
        assert found[name] == pytest.approx([float(row[name]) for row in expected], abs=0.06), name
    assert found["hours"].max() > 0.2
    clocks = [int(text[:2]) + int(text[3:]) / 60 if (text := row["earliest"]) else np.nan for row in expected]
    assert found["earliest"] == pytest.approx(clocks, abs=0.51 / 60, nan_ok=True)
    assert [str(day) for day in found["first_day"]] == [row["first_day"] or "NaT" for row in expected]
    # minutes by hour are the hours of all panes together
    minutes = [sum(values.sum() for name, values in one.items() if name.startswith("min_")) for one in found.hours]
    assert np.array(minutes) / 60 == pytest.approx(found["hours"][found["reflector"] == 0], abs=1e-3)


def test_a_perfect_mirror_sends_the_sun_where_the_image_of_the_eye_looks(scene):
    # straight before the pane: the sun must stand in the south, as high as the pane above the eye
    eye = (155000.0, 462990.0, 45.0)
    found = scene.glare({**PANES, "x": [155000.0, 155020.0]}, eye, year=2026, scatter_deg=0, zone="UTC")
    first = {name: values[0] for name, values in found.items()}
    assert first["hours"] > 0.1 and first["days"] > 10
    # noon at 5.4 degrees east is at 11:38 in UTC, give or take the equation of time
    assert 11.0 < first["earliest"] < first["latest"] < 12.3
    elevation = np.degrees(np.arctan2(15, 30))
    suns = [scene.sun_position(f"{first[end]}T11:38+00:00")[1] for end in ("first_day", "last_day")]
    # the pane subtends five degrees upwards
    assert np.abs(np.array(suns) - elevation).max() < 4


def test_wrong_reflectors_are_refused(scene, eye):
    with pytest.raises(belvedere.BelvedereError, match="height"):
        scene.glare({name: values for name, values in PANES.items() if name != "height"}, eye, **DAY)
    with pytest.raises(belvedere.BelvedereError, match="color"):
        scene.glare({**PANES, "color": ["red", "blue"]}, eye, **DAY)
    with pytest.raises(belvedere.BelvedereError, match=r"number 2.*0\.01"):
        scene.glare({**PANES, "width": [4, 0]}, eye, **DAY)
    with pytest.raises(belvedere.BelvedereError, match="a year"):
        scene.glare(PANES, eye)
    with pytest.raises(belvedere.BelvedereError, match="11"):
        scene.glare(PANES, eye, scatter_deg=40, **DAY)
