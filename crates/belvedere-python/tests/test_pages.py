"""The code of the pages and notebooks runs."""

from __future__ import annotations

import inspect
import json
import os
import re
import subprocess
import sys
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
    for package in ("laspy", "matplotlib", "pandas", "pvlib"):
        pytest.importorskip(package)
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    code = ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"]
    assert len(code) >= 3
    if "BELVEDERE_TEST_DATA" in "".join(code) and not (DATA / "data" / "delft_ahn3").is_dir():
        pytest.skip(f"SKIPPED: there is no reference data in {DATA}; name its folder in BELVEDERE_TEST_DATA")
    run("\n\n".join(code), tmp_path)


def test_the_reference_has_every_function_and_class():
    page = (DOCS / "api.md").read_text(encoding="utf-8")
    listed = re.findall(r"^   ([A-Za-z_.]+)$", page, re.MULTILINE)
    public = [name for name in belvedere.__all__ if name not in ("__version__", "city")]
    public += [f"Scene.{name}" for name, _ in inspect.getmembers(belvedere.Scene, callable) if name[0] != "_"]
    public += [f"city.{name}" for name in belvedere.city.__all__]
    assert sorted(listed) == sorted(public)
