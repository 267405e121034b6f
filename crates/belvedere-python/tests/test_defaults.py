"""Numbers that the documentation gives for what is not given are those of the library, as the command line has them."""

from __future__ import annotations

import inspect
import json
import re
import subprocess

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
        of_command = flags[name.replace("_", "-")]
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
