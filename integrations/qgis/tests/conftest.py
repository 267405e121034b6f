"""What tests without QGIS share: the program, and what it describes."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[1]))

from belvedere_qgis import description, program


@pytest.fixture(scope="session")
def binary():
    """The program of this checkout."""
    return os.environ["BELVEDERE_PROGRAM"]


@pytest.fixture(scope="session")
def commands(binary):
    """The commands that become algorithms, by their names."""
    return {command.name: command for command in description.commands(program.describe(binary))}
