"""Numbers that the documentation gives for what is not given are those of the library, as the command line has them."""

from __future__ import annotations

import inspect
import json
import re
import subprocess
from pathlib import Path

import belvedere


def documented():
    """Method, parameter and the number of "N if not given"."""
    things = {name: value for name, value in inspect.getmembers(belvedere.Scene, inspect.isfunction)}
    things["simulate"] = belvedere.simulate
    for name, function in things.items():
        parameter = ""
        for line in (inspect.getdoc(function) or "").splitlines():
            if found := re.match(r"(\w+)(?:, \w+)* : ", line):
                parameter = found[1]
            if found := re.search(r"([\d./]+|\([\d, ]+\)) if not given", line):
                yield name, parameter, found[1]


def test_documented_defaults_are_those_of_the_command_line(program):
    described = json.loads(subprocess.run([program, "describe", "--json"], capture_output=True, check=True).stdout)
    flags = {
        command["name"]: {flag["name"]: flag["default"] or "" for flag in command["parameters"]}
        for command in described["commands"]
    }
    wrong, count = [], 0
    for name, parameter, number in documented():
        # parts of these commands
        command = {"roof_planes": "irradiance", "network": "line-of-sight"}.get(name, name.replace("_", "-"))
        of_command = flags[command]
        flag = "--" + parameter.replace("_", "-")
        if flag not in of_command:
            flag = {"--fov-deg": "--fov", "--width": "--size", "--tilts-deg": "--tilt"}[flag]
        default = of_command[flag]
        words = [number, number.strip("()").replace(", ", "x")]
        count += 1
        if not any(re.search(rf"(^|\D){re.escape(word)}($|[^\d.])", default) for word in words):
            wrong.append(f"{name}({parameter}) says {number}, but {flag} has {default!r}")
    assert not wrong, wrong
    assert count > 25, count


#: The layer of questions, whose fields state unit, range and default once.
ASK = Path(__file__).parents[2] / "belvedere-apps" / "src" / "ask"
#: The command of the questions in a file, where it does not have the name of the file.
COMMANDS = {
    "cells": "sky-view",
    "given_places": "sky-view",
    "sun": "sun-hours",
    "viewshed/limits": "viewshed",
    "viewshed/question": "viewshed",
    "cameras/mod": "cameras",
    "cameras/lens": "cameras",
}
#: Flags that do not have the names of their fields.
FLAGS = {"--min-sun-elevation-deg": "--min-sun-elevation", "--fov-deg": "--fov", "--height": "--target-height"}
#: Defaults that flags call by a name.
NAMED = {"25": "detect"}
#: Units in the words of fields, and as flags have them.
UNITS = {"metres": "m", "degrees": "degree", "minutes": "minute"}


def fields():
    """Command, field, unit in words and the number of "`None` for N" of the fields of questions."""
    for path in sorted(ASK.rglob("*.rs")):
        name = path.relative_to(ASK).with_suffix("").as_posix()
        found = None
        for line in path.read_text(encoding="utf-8").splitlines():
            if number := re.search(r"///.*`None` for ([\d.]+)\b", line):
                unit = next((unit for unit in UNITS if unit in line.lower()), None)
                found = unit, number[1].rstrip(".")
            elif field := re.match(r"\s+pub (\w+): Option<", line):
                if found:
                    yield COMMANDS.get(name, name.replace("_", "-")), field[1], *found
                found = None


def test_fields_of_questions_have_the_defaults_of_the_command_line(program):
    described = json.loads(subprocess.run([program, "describe", "--json"], capture_output=True, check=True).stdout)
    commands = {
        command["name"]: {flag["name"]: flag for flag in command["parameters"]} for command in described["commands"]
    }
    wrong, count = [], 0
    for command, field, unit, number in fields():
        flag = "--" + field.replace("_", "-")
        flag = FLAGS.get(flag, flag)
        if command not in commands or flag not in commands[command]:
            wrong.append(f"{command}: there is no {flag}")
            continue
        count += 1
        default = commands[command][flag]["default"] or ""
        if unit is not None and commands[command][flag]["unit"] != UNITS[unit]:
            wrong.append(f"{command}: {field} is in {unit}, but {flag} in {commands[command][flag]['unit']!r}")
        number = NAMED.get(number, number)
        if not re.search(rf"(^|\D){re.escape(number)}($|[^\d.]|\.$)", default):
            wrong.append(f"{command}: {field} says {number}, but {flag} has {default!r}")
    assert not wrong, "\n".join(wrong)
    assert count > 20, count
