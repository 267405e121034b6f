"""What the program reports of a run, as a page for the results viewer. Imports nothing of QGIS."""

from __future__ import annotations

import html
from pathlib import Path

# What is about the machine or the run, or is said in the sentences at the top.
LEFT_OUT = ("headline", "remarks", "seconds", "devices", "written")


def write(path, command, summary):
    """Writes the sentences of a summary, and then all that it holds as lists."""
    said = [*command.sentences(summary), *(command.reworded(remark["text"]) for remark in summary.get("remarks", []))]
    sentences = "".join(f"<p>{html.escape(one)}</p>" for one in said)
    rest = {name: value for name, value in summary.items() if name not in LEFT_OUT}
    title = html.escape(command.title)
    head = f'<!DOCTYPE html><html><head><meta charset="utf-8"><title>{title}</title></head>'
    Path(path).write_text(f"{head}<body><h1>{title}</h1>{sentences}{_listed(rest)}</body></html>\n", encoding="utf-8")


def _listed(value):
    if isinstance(value, dict):
        # a flag as a name is for those who type
        named = [(name, one) for name, one in value.items() if not name.startswith("-") and one not in ([], {}, None, "")]
        return "<ul>" + "".join(f"<li>{html.escape(name.replace('_', ' '))}: {_listed(one)}</li>" for name, one in named) + "</ul>"
    if isinstance(value, list):
        if all(isinstance(one, (int, float)) for one in value):
            return ", ".join(map(str, value))
        return "<ul>" + "".join(f"<li>{_listed(one)}</li>" for one in value) + "</ul>"
    return html.escape(str(value))
