"""The program `belvedere`: where it is, what it can do, and a run of it. Imports nothing of QGIS."""

from __future__ import annotations

import contextlib
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import sysconfig
import threading
import time
from pathlib import Path

ENVIRONMENT = "BELVEDERE_PROGRAM"
NAME = "belvedere.exe" if os.name == "nt" else "belvedere"
PLUGIN = Path(__file__).resolve().parent
MISSING = (
    "The program belvedere was not found. Build it from a checkout of Belvedere (docs/qgis.md says how), and put it into "
    f"{PLUGIN / 'bin'}. If it is elsewhere, give its path in Settings > Options > Processing > Providers > Belvedere, or in the environment "
    f"variable {ENVIRONMENT}."
)
# How long a run that is cancelled may take to remove unfinished files.
PATIENCE_S = 2.0
# How often a run looks whether it was cancelled.
POLL_S = 0.1


# Scheme, user and password, server with its path, and all behind that, such as a key.
ADDRESS = re.compile(r"([a-z][a-z0-9+.-]+://)([^/?#\s]*@)?([^?#\s]*)([?#]\S*)?", re.IGNORECASE)


def shown(words):
    """A command line as others may read it: addresses without user, password and key."""
    cut = [ADDRESS.sub(lambda part: part[1] + part[3] + ("?***" if part[2] or part[4] else ""), word) for word in words]
    return " ".join(["belvedere", *cut])


class ProgramError(Exception):
    """What the program says went wrong."""


class Cancelled(Exception):
    """The user cancelled the run."""


def find(setting=""):
    """The path of the program, or a ProgramError that says how to get it.

    In this order: the setting, the environment variable, PATH, the scripts of this Python (where pip puts programs), and the folder `bin` of the plugin.
    A setting or a variable that names no program is an error: the user meant that one.
    """
    for source, path in (
        ("the Belvedere settings", setting),
        (f"the environment variable {ENVIRONMENT}", os.environ.get(ENVIRONMENT)),
    ):
        if path:
            if not _is_program(path):
                raise ProgramError(f"{path}: there is no program here; correct this path in {source}, or remove it")
            return str(path)
    found = shutil.which("belvedere")
    if found:
        return found
    packed = PLUGIN / "bin" / NAME
    if packed.is_file() and not os.access(packed, os.X_OK):
        # QGIS unpacks a zip without the right to run its files
        with contextlib.suppress(OSError):
            packed.chmod(0o755)
    for program in [*(folder / NAME for folder in _script_folders()), packed]:
        if _is_program(program):
            return str(program)
    raise ProgramError(MISSING)


def _is_program(path):
    return os.path.isfile(path) and os.access(path, os.X_OK)


def _script_folders():
    schemes = [None] + [scheme for scheme in sysconfig.get_scheme_names() if scheme.endswith("_user")]
    paths = [sysconfig.get_path("scripts", scheme) if scheme else sysconfig.get_path("scripts") for scheme in schemes]
    return [Path(path) for path in paths if path]


def describe(program):
    """What `belvedere describe --json` says."""
    done = subprocess.run([program, "describe", "--json"], capture_output=True, timeout=30, check=False, **_hidden())
    if done.returncode != 0:
        raise ProgramError(f"{program}: {_error_text(done.stderr.decode('utf-8', 'replace').splitlines())}")
    try:
        described = json.loads(done.stdout)
        described["commands"], described["global_parameters"]
    except (ValueError, KeyError, TypeError):
        raise ProgramError(f"{program}: this program is not belvedere, or not a version that this plugin can use; update it") from None
    return described


def run(program, arguments, on_progress=lambda stage, done, total: None, is_cancelled=lambda: False):
    """Runs the program and returns its summary, a dict.

    `on_progress(stage, done, total)` is called in this thread; `total` is None where it is not known. `is_cancelled()` is called ten times a second. Raises
    ProgramError with what the program said, and Cancelled.
    """
    # options first: what follows `--` are files
    command = [program, "--json", "--progress=json", *arguments]
    running = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, **_hidden())
    with running:
        return _watch(running, on_progress, is_cancelled)


def _watch(running, on_progress, is_cancelled):
    output, lines, latest = [], [], []
    readers = [
        threading.Thread(target=lambda: output.append(running.stdout.read()), daemon=True),
        threading.Thread(target=_follow, args=(running.stderr, lines, latest), daemon=True),
    ]
    for reader in readers:
        reader.start()
    while any(reader.is_alive() for reader in readers):
        readers[0].join(POLL_S)
        if latest:
            on_progress(*latest[-1])
            latest.clear()
        if is_cancelled():
            _stop(running)
            for reader in readers:
                reader.join()
            raise Cancelled
        if not readers[0].is_alive():
            readers[1].join(POLL_S)
    status = running.wait()
    if status != 0:
        raise ProgramError(_error_text(lines, status))
    return json.loads(b"".join(output) or b"{}")


def progress(line):
    """Stage, done and total of a line of progress, or None for any other line."""
    if not line.startswith("{"):
        return None
    try:
        read = json.loads(line)
        return read["stage"], read["done"], read["total"]
    except (ValueError, KeyError):
        return None


def _follow(stream, lines, latest):
    for raw in stream:
        line = raw.decode("utf-8", "replace").rstrip()
        step = progress(line)
        if step is None:
            lines.append(line)
        else:
            latest.append(step)


def _error_text(lines, status=1):
    text = "\n".join(line for line in lines if line).strip()
    if text.startswith("error: "):
        text = text[len("error: ") :]
    return text or f"the program ended with status {status} and no message"


def _stop(running):
    # the program removes its unfinished files on an interrupt; Windows has none for programs without a console
    if os.name == "nt":
        running.terminate()
    else:
        running.send_signal(signal.SIGINT)
    deadline = time.monotonic() + PATIENCE_S
    while running.poll() is None and time.monotonic() < deadline:
        time.sleep(0.02)
    if running.poll() is None:
        running.kill()
        running.wait()


def _hidden():
    """No console window on Windows."""
    return {"creationflags": subprocess.CREATE_NO_WINDOW} if sys.platform == "win32" else {}
