"""Surveys larger than memory, tile by tile.

`answer` asks one question of a survey of any size. `plan`, `run` and `merge` are `belvedere city` on one computer, or
on a Dask cluster: a plan and all results lie in one folder, which all computers of a cluster must reach. What is done
is kept there, so that a run that was interrupted, or that lost a worker, continues where it stopped.

Examples
--------
>>> run = folder / "city"
>>> _ = belvedere.city.plan(tile, run, sun=[(150, 20)], cell=2, tile_size=64)
>>> belvedere.city.run(run)["is_complete"]  # or run(run, distributed.Client())
True
>>> _ = belvedere.city.merge(run, folder / "city.tif")
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sysconfig
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from ._errors import BelvedereError, wrong

if TYPE_CHECKING:
    import distributed

__all__ = ["answer", "merge", "plan", "run", "status"]

#: Questions about cells that are answered in tiles where one model does not fit into memory.
QUESTIONS = ("shadow", "sun_hours", "sky_view", "irradiance", "viewshed")
#: Shares of the tiles for each thread of a cluster: enough that all have work until the end.
SHARES_PER_THREAD = 4


def answer(
    question: Literal["shadow", "sun_hours", "sky_view", "irradiance", "viewshed"],
    clouds: str | Path | Iterable[str | Path],
    output: str | Path | Iterable[str | Path],
    **flags: object,
) -> dict[str, Any]:
    """Answers a question about the cells of a survey of any size. Returns the figures and remarks of the answer.

    Where one model of the survey does not fit into memory, tiles are answered one after the other. They are kept with
    scenes: a call that was interrupted goes on, and the next question finds the balls.

    Parameters
    ----------
    question : {'shadow', 'sun_hours', 'sky_view', 'irradiance', 'viewshed'}
        Which one.
    clouds
        Files, folders and catalogues (.vpc) of the survey.
    output
        Raster (.tif), map (.png), or both.
    **flags
        The flags of the command with underscores, as for `plan`: ``sun=[(150, 20)]``, ``date="2026-03-21"``,
        ``observer=[(155000, 463000)]``, ``cell=1``, ``memory="2G"`` [default: half of what is free].

    Examples
    --------
    >>> found = belvedere.city.answer("shadow", tile, folder / "lit.tif", sun=[(150, 20)], cell=2)
    >>> 0 < found["measures"]["lit"]["mean"] < 1
    True
    """
    outputs = [word for path in _paths(output) for word in ("-o", path)]
    return _program(_command(question), *_paths(clouds), *_words(flags), *outputs)


def _command(question: str) -> str:
    if question not in QUESTIONS:
        raise wrong("question", repr(question), f"use {', '.join(map(repr, QUESTIONS))}")
    return question.replace("_", "-")


def plan(
    clouds: str | Path | Iterable[str | Path],
    folder: str | Path,
    question: Literal["shadow", "sun_hours", "sky_view", "irradiance", "viewshed"] | None = None,
    **flags: object,
) -> dict[str, Any]:
    """Reads all points once, and writes the plan of a run into `folder`. Returns what the run will need.

    Parameters
    ----------
    clouds
        Files, folders and catalogues (.vpc) of the survey.
    folder
        Folder for the plan and the results; created if it does not exist.
    question : {'shadow', 'sun_hours', 'sky_view', 'irradiance', 'viewshed'}, optional
        One question, with all its flags, as for `answer`; without it the flags are those of ``belvedere city plan``.
    **flags
        The flags of ``belvedere city plan`` with underscores: ``sun=[(150, 20)]``, ``time="2026-03-21T10:00+01:00"``,
        ``sun_hours=True``, ``date="2026-03-21"``, ``sky_view=True``, ``cell=1``, ``cell_for={"shadow": 0.5}`` (metres),
        ``memory="4G"``. A list repeats a flag, and so does a dictionary, as name=value; the numbers of a tuple are
        joined by commas.

    Examples
    --------
    >>> belvedere.city.plan(tile, folder / "plan", sky_view=True, directions=49, tile_size=64)["results"]
    ['sky_view_factor']
    """
    if question is None:
        return _program("city", "plan", *_paths(clouds), *_words(flags), "-o", folder)
    return _program(_command(question), *_paths(clouds), *_words(flags), "--plan", folder)


def run(
    folder: str | Path, client: distributed.Client | None = None, *, threads: int | None = None, retries: int = 3
) -> dict[str, Any]:
    """Computes the tiles that are not done yet. Returns `status` at the end.

    Parameters
    ----------
    folder
        Folder of the plan.
    client
        Client of a Dask cluster (`distributed.Client`), whose workers have this package and reach the folder under the
        same path. Without it, all is computed on this computer.
    threads
        Threads that a tile is computed with [default: all processors; on a cluster one].
    retries
        How often a share of the tiles is tried again that failed, or whose worker was lost.

    Raises
    ------
    BelvedereError
        If tiles failed; all others are done.
    """
    # distributed declares no types
    cluster: Any = client
    if cluster is not None:
        tiles = status(folder)["tiles"]
        shares = max(1, min(tiles, SHARES_PER_THREAD * sum(cluster.nthreads().values())))
        numbers = range(1, shares + 1)
        # balls of all tiles first: results need those of neighbours
        for more in (["--balls-only"], []):
            jobs = cluster.map(
                _share,
                numbers,
                folder=str(folder),
                of=shares,
                more=more,
                threads=threads or 1,
                retries=retries,
                pure=False,
            )
            cluster.gather(jobs)
    # what is left, and the list of all tiles
    _program("city", "run", folder, threads=threads)
    return status(folder)


def status(folder: str | Path) -> dict[str, Any]:
    """Which tiles of each result are done, left or failed.

    Examples
    --------
    >>> _ = belvedere.city.plan(tile, folder / "new", sky_view=True, tile_size=64)
    >>> belvedere.city.status(folder / "new")["is_complete"]
    False
    """
    return _program("city", "status", folder)


def merge(
    folder: str | Path,
    output: str | Path,
    *,
    result: str | None = None,
    unfinished: bool = False,
) -> dict[str, Any]:
    """Writes the tiles of a result as one cloud-optimised GeoTIFF, which reaches as far as the points do.

    Parameters
    ----------
    folder
        Folder of the plan.
    output
        Raster of all tiles (.tif).
    result
        Name of the result [default: the only one].
    unfinished
        Merge what is there of a run that is not finished, with a warning [default: such a run is
        an error].
    """
    words = [*(["--result", result] if result else []), *(["--unfinished"] if unfinished else [])]
    return _program("city", "merge", folder, "-o", output, *words)


def _paths(paths: str | Path | Iterable[str | Path]) -> list[str | Path]:
    return [paths] if isinstance(paths, (str, Path)) else list(paths)


def _words(flags: Mapping[str, object]) -> list[str]:
    return [word for name, value in flags.items() for word in _typed(name, value)]


def _typed(name: str, value: object) -> list[str]:
    """A keyword as a flag."""
    flag = "--" + name.replace("_", "-")
    if value is None or value is False:
        return []
    if value is True:
        return [flag]
    if isinstance(value, dict):
        return [f"{flag}={key}={each}" for key, each in value.items()]
    if isinstance(value, list):
        return [word for each in value for word in _typed(name, each)]
    # with "=", so that a value that begins with a minus is no flag
    return [f"{flag}={','.join(str(part) for part in value) if isinstance(value, tuple) else value}"]


def _share(number: int, *, folder: str, of: int, more: list[str], threads: int) -> Mapping[str, Any]:
    """A share of the tiles, on a worker. What is done already is not done again."""
    return _program("city", "run", folder, "--shard", f"{number}/{of}", *more, threads=threads)


def _program(*words: object, threads: int | None = None) -> dict[str, Any]:
    """The summary of a command, by the program of this package."""
    name = "belvedere.exe" if os.name == "nt" else "belvedere"
    beside = Path(sysconfig.get_path("scripts"), name)
    found = str(beside) if beside.exists() else shutil.which(name)
    if found is None:
        raise BelvedereError("the program belvedere is not installed beside this package; install the package again")
    limit = [] if threads is None else ["--threads", str(threads)]
    command = [found, "--json", "--progress", "none", *limit, *(str(word) for word in words)]
    ended = subprocess.run(command, capture_output=True, text=True, encoding="utf-8", check=False)
    if ended.returncode != 0:
        raise BelvedereError(ended.stderr.strip().removeprefix("error: ") or f"belvedere {words[0]} was stopped")
    summary: dict[str, Any] = json.loads(ended.stdout)
    return summary
