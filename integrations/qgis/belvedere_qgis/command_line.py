"""The command line of an algorithm from the values that the user gave. Imports nothing of QGIS."""

from __future__ import annotations


def arguments(command, values, outputs):
    """Arguments of the program, without the program itself.

    `values` has a value for each parameter by its key: a path, a list of paths, a text, a number, a truth value or the number of a choice. None, an
    empty text and the default are not passed: the program knows its defaults, and refuses some flags where they have no effect.
    `outputs` has the path of each output that the user wants, by its key.
    """
    inputs, flags = [], []
    for parameter in command.parameters:
        if parameter.kind == "written":
            for output in parameter.outputs:
                if outputs.get(output.key) and output.kind != "page":
                    flags.append(f"{parameter.flag}={outputs[output.key]}")
            continue
        value = values.get(parameter.key)
        if value is None or value == "" or value == parameter.default:
            continue
        if not parameter.flag.startswith("-"):
            inputs.extend(_written(parameter, value))
        elif parameter.kind == "flag":
            flags.append(parameter.flag)
        else:
            flags.extend(f"{parameter.flag}={one}" for one in _written(parameter, value))
    return [command.name, *flags, "--", *inputs]


def _written(parameter, value):
    if parameter.kind == "files":
        return value
    if parameter.kind == "choice":
        return [parameter.choices[value][0]]
    if parameter.kind == "number":
        return [repr(float(value))]
    if parameter.kind == "text" and parameter.is_repeatable:
        return [one.strip() for one in value.split(";") if one.strip()]
    return [str(value)]
