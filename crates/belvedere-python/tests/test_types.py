"""Types say what the package takes: words are those of the native part, keywords those of the questions."""

from __future__ import annotations

import inspect
import re
import typing

import belvedere
import pytest
from belvedere import Scene, _keywords, _questions, _types
from belvedere._targets import wanted

WINDOW = {"x": [1], "y": [1], "z": [1], "azimuth": [180]}
#: Calls with a word that is not known, whose advice lists those that are.
CALLS = {
    "Body": lambda s, w: s.heat(weather=w, date="2015-07-21", body="?"),
    "CarvingRule": lambda s, w: Scene(s.cloud, without="?"),
    "ClearSky": lambda s, w: s.irradiance(clear_sky="?"),
    "Curvature": lambda s, w: s.viewshed((1, 2), curvature="?"),
    "Density": lambda s, w: s.cameras("roofs", count=1, density="?"),
    "Ground": lambda s, w: s.viewshed((1, 2), ground="?"),
    "GroundCover": lambda s, w: s.heat(weather=w, date="2015-07-21", ground_cover="?"),
    "Kind": lambda s, w: s.window_views(WINDOW, classes={1: "?"}),
    "Language": lambda s, w: s.sunlight_report("r.html", windows=WINDOW, language="?"),
    "Leaves": lambda s, w: s.shadow(sun=(180, 30), through_trees="seasons", leaves="?"),
    "Method": lambda s, w: Scene(s.cloud, method="?"),
    "Orient": lambda s, w: Scene(s.cloud, orient="?"),
    "Patches": lambda s, w: s.sky_view(patches="?"),
    "SkyModel": lambda s, w: s.irradiance(clear_sky="bird", sky_model="?"),
    "Study": lambda s, w: s.sunlight_report("r.html", windows=WINDOW, study="?"),
    "Surroundings": lambda s, w: s.irradiance(clear_sky="bird", surroundings="?"),
    "ThroughTrees": lambda s, w: s.shadow(sun=(180, 30), through_trees="?"),
    "Town": lambda s, w: belvedere.simulate("?"),
    "Trees": lambda s, w: Scene(s.cloud, trees="?"),
    "Unproven": lambda s, w: s.viewshed((1, 2), unproven="?"),
    "Up": lambda s, w: belvedere.read(b"1 2 3", name="a.xyz", up="?"),
}


def words_of(alias: object) -> set[str]:
    parts = typing.get_args(alias)
    if typing.get_origin(alias) is typing.Literal:
        return set(parts)
    return set().union(*(words_of(part) for part in parts))


@pytest.mark.parametrize("name", CALLS)
def test_words_are_those_of_the_native_part(name, scene, hot_day):
    with pytest.raises(belvedere.BelvedereError) as caught:
        CALLS[name](scene, hot_day)
    advice = caught.value.advice
    listed = re.findall(r"'([\w-]+)'", advice) or re.findall(r"[\w-]+", advice.split("one of")[-1])
    assert words_of(getattr(_types, name)) == set(listed), advice


#: A question with a word that is not known, where the package itself lists those that are, and what else it may be.
QUESTIONS = {
    "Body": ({"heat": {"body": "?"}}, set()),
    "Curvature": ({"line-of-sight": {"earth": {"curvature": "?"}}}, set()),
    "Ground": ({"horizon": {"ground": "?"}}, set()),
    "GroundCover": ({"heat": {"surfaces": {"ground": "?"}}}, set()),
    "Kind": ({"window-views": {"classes": [(1, "?")]}}, {"sky", "beyond"}),
    "Leaves": ({"sky-view": {"trees": {"measured": "?"}}}, set()),
    "Patches": ({"sky-view": {"sky": "?"}}, {"even"}),
    "SkyModel": ({"irradiance": {"params": {"sky": "?"}}}, set()),
    "Surroundings": ({"irradiance": {"params": {"surroundings": "?"}}}, set()),
    "Unproven": ({"line-of-sight": {"unproven": "?"}}, set()),
}


@pytest.mark.parametrize("name", QUESTIONS)
def test_words_of_the_package_are_those_of_questions(name, scene):
    question, others = QUESTIONS[name]
    with pytest.raises(belvedere.BelvedereError) as caught:
        scene._core.on_targets(question, None, wanted(None, None, {}), None)
    listed = set(re.findall(r"`(\w+)`", caught.value.advice.split("expected")[1]))
    alias = getattr(_types, name)
    native = {_questions.word(alias, word=word) or "reported" for word in words_of(alias)}
    assert {"by_date" if word == "auto" and name == "Leaves" else word for word in native} == listed - others


@pytest.mark.parametrize(
    ("method", "keywords", "others"),
    [
        ("shadow", _keywords.Shadow, {"sun", "time", "targets", "probability", "certain", "casters"}),
        ("sun_hours", _keywords.SunHours, {"targets"}),
        ("sky_view", _keywords.SkyView, {"targets"}),
        ("irradiance", _keywords.Irradiance, {"targets"}),
        ("heat", _keywords.Heat, {"targets", "weather"}),
        ("towers", _keywords.Towers, {"targets", "towers"}),
        ("landmark", _keywords.Landmark, {"mesh", "target_class", "target_polygon", "objects", "observers"}),
        ("line_of_sight", _keywords.LineOfSight, {"observer", "target"}),
    ],
)
def test_keywords_are_those_of_the_method(method, keywords, others):
    parameters = set(inspect.signature(getattr(Scene, method)).parameters) - {"self"}
    assert parameters == keywords.__required_keys__ | keywords.__optional_keys__ | others
