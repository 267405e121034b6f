"""The tutorial names algorithms and fields that exist."""

from __future__ import annotations

import re
from pathlib import Path

PAGE = Path(__file__).parents[3] / "docs/tutorials/plan_in_qgis.md"
# Words of QGIS itself.
OF_QGIS = {"Processing > Toolbox", "Belvedere", "…", "Animated temporal navigation", "Set to full range"}


def test_each_name_in_italics_is_an_algorithm_or_the_start_of_a_label(commands):
    page = PAGE.read_text(encoding="utf-8")
    named = set(re.findall(r"(?<!\*)\*([^*\n]+)\*(?!\*)", page)) - OF_QGIS
    assert len(named) > 15
    titles = {f"{command.group} > {command.title}" for command in commands.values()}
    labels = {parameter.label for command in commands.values() for parameter in command.parameters}
    unknown = {name for name in named if name not in titles and not any(label.startswith(name) for label in labels)}
    assert not unknown
