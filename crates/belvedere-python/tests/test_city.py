"""Cities in tiles, on this computer and on a Dask cluster that loses a worker."""

from __future__ import annotations

import json
import os
import signal
import threading
import time

import belvedere
import pytest
import rasterio


def results(folder):
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in folder.rglob("*")
        if path.suffix in (".npz", ".tif")
    }


def test_a_killed_worker_loses_nothing(folder):
    distributed = pytest.importorskip(
        "distributed", reason="SKIPPED a cluster of workers: distributed is not installed (pip install distributed)"
    )
    cloud = folder / "larger.laz"
    belvedere.simulate("town", extent=110, density=2, seed=5).save(cloud)
    questions = {"sun": [(150, 20)], "sky_view": True, "directions": 49, "tile_size": 64}
    alone, shared = folder / "alone", folder / "shared"
    for run in (alone, shared):
        belvedere.city.plan(cloud, run, **questions)
    expected = belvedere.city.run(alone)
    assert expected["is_complete"] and expected["tiles"] >= 4
    cluster = distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None)
    with cluster, distributed.Client(cluster) as client:
        killed = []

        def kill_one():
            # as soon as the first balls are there
            while not list(shared.glob("balls/*.json")):
                time.sleep(0.02)
            worker = next(iter(client.run(os.getpid).values()))
            os.kill(worker, signal.SIGKILL)
            killed.append(worker)

        killer = threading.Thread(target=kill_one)
        killer.start()
        found = belvedere.city.run(shared, client)
        killer.join()
        assert killed and killed[0] not in client.run(os.getpid).values()
    assert found["is_complete"]
    assert results(shared) == results(alone)


def test_flags_and_errors_are_those_of_the_program(folder, tile):
    plan = belvedere.city.plan(tile, folder / "flags", sun=[(150, 20), (-30, 40)], sky_view=True, cell=4)
    assert plan["results"] == ["shadow_150_20", "shadow_-30_40", "sky_view_factor"]
    cells = {"shadow": 2, "sky-view": 8}
    belvedere.city.plan(tile, folder / "cells", sun=[(150, 20)], sky_view=True, cell=4, cell_for=cells)
    kept = json.loads((folder / "cells" / "plan.json").read_text(encoding="utf-8"))
    assert kept["cells"] == {"usual": 4, "others": {"shadow": 2, "sky_view": 8}}
    with pytest.raises(belvedere.BelvedereError, match="--cell-for"):
        belvedere.city.plan(tile, folder / "wrong", sky_view=True, cell_for={"shadow": 2})
    with pytest.raises(belvedere.BelvedereError, match="--sunny"):
        belvedere.city.plan(tile, folder / "wrong", sunny=True)
    with pytest.raises(belvedere.BelvedereError, match="questions are missing"):
        belvedere.city.plan([tile], folder / "wrong", sky_view=False)
    with pytest.raises(belvedere.BelvedereError, match=r"plan\.json"):
        belvedere.city.run(folder / "nowhere")
    with pytest.raises(belvedere.BelvedereError, match="--result"):
        belvedere.city.merge(folder / "flags", folder / "flags.tif")


def test_one_question_of_a_survey_of_any_size(folder):
    cloud = folder / "any-size.laz"
    belvedere.simulate("town", extent=90, density=4, seed=5).save(cloud)
    scene = belvedere.Scene(belvedere.read(cloud))
    output = folder / "any-size.tif"
    found = belvedere.city.answer(
        "shadow", cloud, [output, folder / "any-size.png"], sun=[(150, 30)], cell=1, memory="118M"
    )
    assert "in-tiles" in [remark["key"] for remark in found["remarks"]]
    assert found["measures"]["lit"]["mean"] == pytest.approx(scene.shadow(sun=(150, 30), cell=1).mean(), abs=0.02)
    assert output.is_file() and (folder / "any-size.png").is_file()
    x, y, _ = scene.bounds[0] + 45
    found = belvedere.city.answer("viewshed", cloud, output, observer=[(x, y, 30)], cell=1, memory="118M")
    assert found["cells"]["targets"] > 1000 and 5 < found["cells"]["visible_percent"] < 100
    with pytest.raises(belvedere.BelvedereError, match="use 'shadow'"):
        belvedere.city.answer("balls", cloud, output)
    # what cells in tiles do not give comes from a scene that is made in tiles
    found = belvedere.city.answer("shadow", cloud, output, sun=[(150, 30)], casters=True, memory="118M")
    assert "balls-in-tiles" in [remark["key"] for remark in found["remarks"]]
    # with all its options, also as a plan for many computers
    found = belvedere.city.plan(cloud, folder / "soft", "shadow", sun=[(150, 30)], soft=True, cell=1)
    assert found["results"] == ["shadow"]
    assert belvedere.city.run(folder / "soft")["is_complete"]
    belvedere.city.merge(folder / "soft", output)
    with rasterio.open(output) as raster:
        lit = raster.read(1, masked=True)
    expected = scene.shadow(sun=(150, 30), soft=True, cell=1)
    assert float(lit.mean()) == pytest.approx(expected.mean(), abs=0.02)
    assert ((lit > 0) & (lit < 1)).any()
