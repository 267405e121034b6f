"""A small simulated town that all tests share."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import belvedere
import numpy as np
import pytest


@pytest.fixture(scope="session", autouse=True)
def own_cache(tmp_path_factory: pytest.TempPathFactory) -> None:
    """Scenes of tests are kept apart from those of the user."""
    os.environ["XDG_CACHE_HOME"] = str(tmp_path_factory.mktemp("cache"))


@pytest.fixture(scope="session")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("belvedere")


@pytest.fixture(scope="session")
def tile(folder: Path) -> Path:
    """A LAZ tile of 80 m, as a survey delivers it."""
    path = folder / "tile.laz"
    belvedere.simulate("town", extent=80, density=6, seed=3).save(path)
    return path


@pytest.fixture(scope="session", autouse=True)
def hot_day(folder: Path) -> Path:
    """A day of weather, as PVGIS writes it."""
    path = folder / "weather.csv"
    rows = [
        "Latitude (decimal degrees): 52.15",
        "Longitude (decimal degrees): 5.39",
        "time(UTC),T2m,RH,G(h),Gb(n),Gd(h),IR(h),WS10m",
    ]
    for hour in range(24):
        light = "600,700,100" if 5 <= hour < 19 else "0,0,0"
        rows.append(f"20150721:{hour:02}00,{20 + hour % 12},50,{light},350,2")
    path.write_text("\n".join(rows) + "\n")
    return path


@pytest.fixture(scope="session")
def cloud(tile: Path) -> belvedere.Cloud:
    return belvedere.read(tile)


@pytest.fixture(scope="session")
def scene(cloud: belvedere.Cloud) -> belvedere.Scene:
    return belvedere.Scene(cloud)


@pytest.fixture(scope="session")
def targets(cloud: belvedere.Cloud) -> np.ndarray:
    """Every fiftieth point, half a metre higher."""
    return cloud.xyz[::50] + [0.0, 0.0, 0.5]


@pytest.fixture(scope="session")
def eye(cloud: belvedere.Cloud) -> tuple[float, float, float]:
    """Above the middle of the town."""
    low, high = cloud.bounds
    return (*((low + high) / 2)[:2], high[2] - 1.0)


@pytest.fixture(scope="session")
def standing(cloud: belvedere.Cloud) -> tuple[float, float]:
    """On open ground: a ground point far from everything higher."""
    xyz, classes = cloud.xyz, cloud.attributes["classification"]
    ground, high = xyz[classes == 2][::20], xyz[classes != 2][::5]
    low_corner, high_corner = cloud.bounds
    inside = ((ground[:, :2] > low_corner[:2] + 20) & (ground[:, :2] < high_corner[:2] - 20)).all(axis=1)
    ground = ground[inside]
    gaps = [np.hypot(*(high[:, :2] - place[:2]).T).min() for place in ground]
    x, y, _ = ground[int(np.argmax(gaps))]
    return float(x), float(y)


@pytest.fixture(scope="session")
def program() -> str:
    """The program that the wheel installed."""
    beside = Path(sys.executable).parent / ("belvedere.exe" if sys.platform == "win32" else "belvedere")
    found = str(beside) if beside.exists() else shutil.which("belvedere")
    assert found, "the wheel did not install the program `belvedere`"
    return found


@pytest.fixture(scope="session")
def run_program(program: str, folder: Path):
    """Runs the program in the folder of the tile."""

    def run(*arguments: object) -> None:
        subprocess.run([program, "--quiet", *map(str, arguments)], cwd=folder, check=True, timeout=300)

    return run


@pytest.fixture(scope="session")
def ask_program(program: str, folder: Path, tile: Path):
    """Runs a command of the program on the tile; returns its summary."""

    def ask(*words: object):
        done = subprocess.run(
            [program, "--json", *map(str, words)], cwd=folder, capture_output=True, text=True, timeout=300
        )
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout)

    return ask
