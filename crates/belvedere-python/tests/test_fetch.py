"""Open surveys of a place, from a server of these tests: no network is needed."""

import functools
import http.server
import json
import threading

import belvedere
import numpy as np
import pytest

# the middle of the simulated town
PLACE = (52.1552, 5.3872)


@pytest.fixture(scope="module")
def surveys(folder, tile):
    handler = functools.partial(http.server.SimpleHTTPRequestHandler, directory=str(folder))
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        address = f"http://127.0.0.1:{server.server_port}"
        row = {
            "name": "town",
            "title": "Town",
            "licence": "CC0",
            "attribution": "the town",
            "page": "https://town.invalid",
        }
        index = {"list": {"address": address + "/list.json?{west},{south},{east},{north}"}}
        by_hand = {**row, "name": "club", "index": "page"}
        table = [{**one, "areas_deg": [[5, 52, 6, 53]]} for one in ({**row, "index": index}, by_hand)]
        (folder / "list.json").write_text(json.dumps({"features": [{"properties": {"url": f"{address}/{tile.name}"}}]}))
        (folder / "surveys.json").write_text(json.dumps(table))
        yield folder / "surveys.json"
        server.shutdown()


def test_points_of_a_place_are_those_of_the_tile(surveys, cloud):
    found = belvedere.open_surveys(PLACE, surveys=surveys)
    assert [(one["name"], len(one["tiles"])) for one in found] == [("town", 1), ("club", 0)]
    middle = np.mean(cloud.bounds, axis=0)[:2]
    taken = belvedere.fetch(PLACE, radius=20, surveys=surveys)
    assert taken.report["survey"]["licence"] == "CC0"
    low, high = taken.bounds
    # the place is known to a few metres here, the square to a millimetre
    assert (high - low)[:2] == pytest.approx([40, 40], abs=1.0)
    assert np.abs((low + high)[:2] / 2 - middle).max() < 30
    inside = ((cloud.xyz >= low - 1e-4) & (cloud.xyz <= high + 1e-4))[:, :2].all(axis=1)
    assert len(taken) == inside.sum() > 500


def test_wrong_places_and_surveys_are_refused(surveys):
    for place, words in (
        ((5.39, 52.16), "latitude first"),
        ((95, 5), "-85 to 85"),
        ((52.1,), "latitude and longitude"),
    ):
        with pytest.raises(belvedere.BelvedereError, match=words):
            belvedere.fetch(place, surveys=surveys)
    with pytest.raises(belvedere.BelvedereError, match="town, club"):
        belvedere.fetch(PLACE, survey="ahn9", surveys=surveys)
    with pytest.raises(belvedere.BelvedereError, match=r"choose tiles on https://town\.invalid"):
        belvedere.fetch(PLACE, survey="club", surveys=surveys)
    with pytest.raises(belvedere.BelvedereError, match="5000"):
        belvedere.open_surveys(PLACE, radius=1e6, surveys=surveys)
    with pytest.raises(FileNotFoundError):
        belvedere.open_surveys(PLACE, surveys="nowhere.json")
