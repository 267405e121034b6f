"""The code of the pages and notebooks runs."""

from __future__ import annotations

import inspect
import json
import os
import re
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import belvedere
import pytest

DOCS = Path(__file__).parents[3] / "docs"
DATA = Path(os.environ.get("BELVEDERE_TEST_DATA", DOCS.parents[1] / "shared"))


def run(code: str, folder: Path) -> str:
    done = subprocess.run(
        [sys.executable, "-c", code],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=300,
        env={**os.environ, "MPLBACKEND": "agg", "BELVEDERE_TEST_DATA": str(DATA)},
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_the_page_on_python_runs_from_top_to_bottom(tmp_path):
    page = (DOCS / "python.md").read_text(encoding="utf-8")
    blocks = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
    assert len(blocks) > 10
    printed = run("\n".join(blocks), tmp_path)
    assert "of the ground is in the sun" in printed
    assert (tmp_path / "shadow.tif").exists() and (tmp_path / "sun_hours.tif").exists()


@pytest.mark.parametrize("path", sorted((DOCS / "notebooks").glob("*.ipynb")), ids=lambda path: path.stem)
def test_notebook_runs(path, tmp_path):
    for package in ("geopandas", "laspy", "matplotlib", "pandas", "pvlib", "xarray"):
        pytest.importorskip(package)
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    code = ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"]
    assert len(code) >= 3
    if "BELVEDERE_TEST_DATA" in "".join(code) and not (DATA / "data" / "delft_ahn3").is_dir():
        pytest.skip("SKIPPED a page: there is no reference data; name its folder in BELVEDERE_TEST_DATA")
    run("\n\n".join(code), tmp_path)


def test_the_reference_has_every_function_and_class():
    page = (DOCS / "api.md").read_text(encoding="utf-8")
    listed = re.findall(r"^   ([A-Za-z_.]+)$", page, re.MULTILINE)
    public = [name for name in belvedere.__all__ if name not in ("__version__", "city")]
    public += [f"Scene.{name}" for name, _ in inspect.getmembers(belvedere.Scene, callable) if name[0] != "_"]
    public += [f"city.{name}" for name in belvedere.city.__all__]
    assert sorted(listed) == sorted(public)


NUMBER = re.compile(r"-?\d[\d,]*(?:\.\d+)?")


def is_shown(line: str, printed: str) -> bool:
    """Whether a line was printed, with numbers within a tenth: answers change from version to version."""

    def numbers(text: str) -> list[float]:
        return [float(number.replace(",", "")) for number in NUMBER.findall(text)]

    same_words = (each for each in printed.splitlines() if NUMBER.sub("#", each) == NUMBER.sub("#", line))
    return any(numbers(each) == pytest.approx(numbers(line), rel=0.1, abs=1) for each in same_words)


# the page on QGIS has nothing to type: the checks of the plugin follow it
TYPED = [path for path in sorted((DOCS / "tutorials").glob("*.md")) if path.stem != "plan_in_qgis"]


@pytest.mark.parametrize("path", TYPED, ids=lambda path: path.stem)
def test_tutorial_works_as_printed(path, tmp_path):
    page = path.read_text(encoding="utf-8")
    source, name = re.search(r"<!-- data: (\S+) as (\S+) -->", page).groups()
    if not (DATA / "data" / source).exists():
        pytest.skip("SKIPPED a page: there is no reference data; name its folder in BELVEDERE_TEST_DATA")
    shutil.copyfile(DATA / "data" / source, tmp_path / name)
    paths = os.pathsep.join([sysconfig.get_path("scripts"), os.environ["PATH"]])
    printed, code, count = "", "", 0
    for kind, text in re.findall(r"```(sh|python|text)\n(.*?)```", page, re.DOTALL):
        if kind == "sh":
            done = subprocess.run(
                ["bash", "-euo", "pipefail", "-c", text],
                cwd=tmp_path,
                capture_output=True,
                text=True,
                timeout=300,
                env={**os.environ, "PATH": paths},
            )
            assert done.returncode == 0, done.stderr
            printed, count = done.stdout, count + text.count("belvedere ")
        elif kind == "python":
            # later blocks use what earlier ones have made
            code += text
            printed = run(code, tmp_path)
        else:
            for line in text.splitlines():
                assert is_shown(line, printed), f"{line!r} is not in\n{printed}"
    assert count >= 2


def test_a_line_that_was_not_printed_is_found():
    printed = "mean 5.003 before, 4.822 after\n18 roof planes, 1,764 m2"
    assert is_shown("mean 5.1 before, 4.8 after", printed) and is_shown("18 roof planes, 1,700 m2", printed)
    assert not is_shown("mean 9 before, 4.8 after", printed) and not is_shown("18 planes, 1,764 m2", printed)


def described() -> dict[str, set[str]]:
    """The flags of each command, from the program itself; those of `city` have its steps together."""
    program = Path(sysconfig.get_path("scripts")) / "belvedere"
    answer = subprocess.run([program, "describe", "--json"], capture_output=True, text=True, check=True)
    flags: dict[str, set[str]] = {}
    for command in json.loads(answer.stdout)["commands"]:
        flags.setdefault(command["name"].split()[0], set()).update(each["name"] for each in command["parameters"])
    return flags


def test_the_table_of_questions_names_flags_and_parameters_that_exist():
    page = (DOCS / "questions.md").read_text(encoding="utf-8")
    rows = [[cell.strip() for cell in line.split("|")[1:-1]] for line in page.splitlines() if line.startswith("| ")]
    rows = [row for row in rows if row[0] != "question" and len(row) == 4]
    assert len(rows) > 25
    flags = described()
    for question, commands, python, _ in rows:
        for command in re.findall(r"`([^`]+)`", commands):
            words = command.split()
            if words[0] == "cargo":
                continue
            # a flag alone is one of several commands
            own = set().union(*flags.values()) if words[0].startswith("-") else flags[words[0]]
            for flag in (word for word in words if word.startswith("--")):
                assert flag in own, (question, flag)
        for method, arguments in re.findall(r"scene\.(?:with_\w+\([^)]*\)\.)?(\w+)\((.*?)\)", python):
            parameters = inspect.signature(getattr(belvedere.Scene, method)).parameters
            named = re.findall(r"(\w+)=", arguments)
            assert set(named) <= set(parameters), (question, method, named)
