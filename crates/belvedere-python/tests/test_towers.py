"""Visible metres of towers: as the program finds them, and as a closed form has them."""

import belvedere
import numpy as np
import pytest
from rasters import assert_same_raster

TOWERS = {
    "name": ["near", "far", "north"],
    "x": [154990.0, 156500.0, 155100.0],
    "y": [462980.0, 463500.0, 464900.0],
    "base": [0.0, 5.0, 0.0],
    "hub": [40.0, 110.0, np.nan],
    "tip": [60.0, 180.0, 90.0],
    "scheme": ["a", "b", "b"],
}


def test_towers_are_those_of_the_program(scene, run_program, folder):
    columns = list(TOWERS.values())
    rows = ["" if value != value else str(value) for row in zip(*columns, strict=True) for value in row]
    lines = [",".join(rows[i : i + len(columns)]) for i in range(0, len(rows), len(columns))]
    (folder / "towers.csv").write_text("\n".join([",".join(TOWERS), *lines]) + "\n")
    run_program(
        *("towers", "tile.laz", "--towers", "towers.csv", "--cell", 8, "-o", "towers.tif", "--measures", "towers"),
    )
    with pytest.warns(belvedere.BelvedereWarning, match="beyond the cloud"):
        rasters = scene.towers(TOWERS, cell=8)
    assert {path.stem for path in (folder / "towers").iterdir()} == set(rasters)
    for measure, raster in rasters.items():
        assert_same_raster(raster, folder / "towers" / f"{measure}.tif", folder)
    metres, share = rasters["metres"].values, rasters["share"].values
    known = np.isfinite(metres)
    assert known.sum() > 20 and np.allclose(metres[known], 330 * share[known], atol=1e-3)
    assert (rasters["schemes"].values[known] <= 3).all() and (rasters["hubs"].values[known] <= 2).all()


def test_a_tower_above_an_eye_in_the_air_is_seen_whole(scene):
    # nothing stands between two places high above the town
    seen = scene.towers(
        {"x": [155030.0], "y": [463000.0], "base": [80.0], "tip": [50.0]}, targets=[(154980, 463000, 90)]
    )
    assert seen["metres"] == pytest.approx([50.0]) and seen["nearest_m"] == pytest.approx([50.0])
    angle = np.degrees(np.arctan2(40, 50) + np.arctan2(10, 50))
    assert seen["angle_deg"] == pytest.approx([angle], abs=1e-3)


def test_wirelines_are_pictures_and_a_table_of_each_place_and_tower(scene, folder):
    pandas = pytest.importorskip("pandas")
    places = [(155030.0, 463000.0, 90.0), (154980.0, 463000.0, 90.0)]
    with pytest.warns(belvedere.BelvedereWarning, match="beyond the cloud"):
        seen = scene.towers(TOWERS, targets=places, wirelines=folder / "views")
    assert {path.name for path in (folder / "views").iterdir()} == {"wirelines.csv", "wireline_1.png", "wireline_2.png"}
    table = pandas.read_csv(folder / "views" / "wirelines.csv")
    assert list(table["tower"]) == TOWERS["name"] * 2
    assert table.groupby("place")["visible_m"].sum().to_numpy() == pytest.approx(seen["metres"], abs=0.2)
    row = table.iloc[0]
    assert row["distance_m"] == pytest.approx(np.hypot(40, 20), abs=0.1)
    assert row["tip_deg"] == pytest.approx(np.degrees(np.arctan2(60 - 90, np.hypot(40, 20))), abs=0.01)
    # nothing stands between that high
    assert row["disc_visible_share"] == 1.0 and np.isnan(table["hub_deg"][2])
    visible = table["visible_m"] > 0
    assert visible.any() and set(table["unproven"][visible]) <= {0, 1} and table["unproven"][~visible].isna().all()
    # of a mast that is seen whole, the line to its middle counts
    checked = 0
    for eye in [(154980.0, 463000.0, 90.0), (154975.0, 462985.0, 3.0)]:
        mast = {"x": [155025.0], "y": [463005.0], "base": [eye[2]], "tip": [30.0]}
        scene.towers(mast, targets=[eye], wirelines=folder / "mast")
        (row,) = pandas.read_csv(folder / "mast" / "wirelines.csv").itertuples()
        if row.visible_m == 30.0:
            answer = scene.line_of_sight(eye, (155025.0, 463005.0, eye[2] + 15.0)).answer
            assert bool(row.unproven) == (answer == belvedere.Answer.UNPROVEN)
            checked += 1
    assert checked > 0
    with pytest.raises(belvedere.BelvedereError, match="single places, where wirelines are wanted"):
        scene.towers(TOWERS, cell=8, wirelines=folder / "views")
