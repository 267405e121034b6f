"""Parameters of Processing from what `belvedere describe --json` says of a command. Imports nothing of QGIS."""

from __future__ import annotations

import html
from dataclasses import dataclass, field

# The commands that become algorithms, with the group they are listed in.
GROUPS = {
    "viewshed": "Visibility",
    "line-of-sight": "Visibility",
    "isovist": "Visibility",
    "horizon": "Visibility",
    "towers": "Visibility",
    "landmark": "Visibility",
    "protected-view": "Visibility",
    "window-views": "Visibility",
    "cameras": "Visibility",
    "survey-plan": "Visibility",
    "shadow": "Sun and sky",
    "sun-hours": "Sun and sky",
    "sky-view": "Sun and sky",
    "irradiance": "Sun and sky",
    "heat": "Sun and sky",
    "glare": "Sun and sky",
    "envelope": "Sun and sky",
    "comfort": "Sun and sky",
    "report": "Sun and sky",
    "surfaces": "Scene",
    "fetch": "Scene",
}
TITLES = {
    "viewshed": "Viewshed",
    "line-of-sight": "Line of sight",
    "isovist": "Visible space",
    "horizon": "Horizon",
    "towers": "Visible metres of towers",
    "landmark": "Visibility of a landmark",
    "protected-view": "Protected view",
    "window-views": "Views from windows",
    "cameras": "Where to put cameras",
    "survey-plan": "Where to scan again",
    "shadow": "Shadow",
    "sun-hours": "Sun hours",
    "sky-view": "Sky view factor",
    "irradiance": "Solar irradiance",
    "heat": "Heat stress",
    "glare": "Glare of panels and glass",
    "envelope": "Solar envelope",
    "comfort": "Sun and sky along walks",
    "report": "Sunlight report",
    "surfaces": "Roofs and walls",
    "fetch": "Points of an open survey",
}
# Headings of parameters that few people change.
RARE = ("Lines of sight", "Scene", "Balls", "Global options")
# Layers that must have a certain geometry; others take any.
GEOMETRIES = {
    ("line-of-sight", "--pairs"): "line",
    ("line-of-sight", "--among"): "point",
    ("towers", "--towers"): "point",
    ("landmark", "--observers"): "point",
    ("landmark", "--target-polygon"): "polygon",
    ("protected-view", "--observers"): "point",
    ("protected-view", "--target-polygon"): "polygon",
    ("comfort", "--route"): "line",
    ("envelope", "--parcel"): "polygon",
    ("report", "--area"): "polygon",
}
# Commands whose tables become the same lines as their GeoJSON, which rounds degrees.
LINES_IN_TABLES = ("line-of-sight",)
# Names of layers that say more than those of their flags.
NAMES = {"--pairs": "Lines from observers to targets", "--protect": "Lines, polygons or points to protect from shadow"}
# Results that are no areas although they are written as GeoJSON.
OUTPUT_LABELS = {("cameras", "OUTPUT_AREAS"): "Cameras as points"}
UNITS = {"degree": "degrees", "minute": "minutes", "m2": "square metres"}
# A label longer than this makes the dialog too wide.
LONGEST_LABEL = 60


@dataclass(frozen=True)
class Output:
    """A result that the user can choose to keep: one destination of Processing."""

    key: str
    kind: str
    """raster, vector, table (a vector layer made from a table), file or folder"""
    label: str
    formats: tuple[str, ...]
    is_usual: bool = False
    """written unless the user refuses it"""


@dataclass(frozen=True)
class Parameter:
    """A parameter of a command, as Processing shows it."""

    flag: str
    key: str
    kind: str
    """flag, choice, number, integer, text, crs, point, place (on earth), layer, file, files or written"""
    label: str
    help: str
    default: object = None
    choices: tuple[tuple[str, str], ...] = ()
    geometry: str = "any"
    is_required: bool = False
    is_repeatable: bool = False
    is_advanced: bool = False
    outputs: tuple[Output, ...] = ()

    @property
    def heading(self):
        """What stands over its help."""
        return ", ".join(output.label for output in self.outputs) or self.label


@dataclass(frozen=True)
class Command:
    """A command of the program as an algorithm."""

    name: str
    title: str
    group: str
    summary: str
    description: str
    examples: tuple[str, ...] = ()
    parameters: tuple[Parameter, ...] = field(default=())

    @property
    def outputs(self):
        return [output for parameter in self.parameters for output in parameter.outputs]


def commands(described):
    """The commands that become algorithms, in the order of the groups."""
    by_name = {command["name"]: command for command in described["commands"]}
    threads = [one for one in described["global_parameters"] if one["name"] == "--threads"]
    return [_command(by_name[name], threads) for name in GROUPS if name in by_name]


def as_html(description):
    """The description of a command as HTML: its indented parts with their headings, and lists line by line."""
    parts = []
    for part in description.split("\n\n"):
        lines = part.splitlines()
        has_heading = len(lines) > 1 and not lines[0].startswith(" ") and all(line.startswith("  ") for line in lines[1:])
        body = [html.escape(line.strip()) for line in (lines[1:] if has_heading else lines)]
        is_list = any("  " in line for line in body)
        text = ("<br>" if is_list else " ").join(body)
        parts.append(f"<p><b>{html.escape(lines[0])}</b><br>{text}</p>" if has_heading else f"<p>{text}</p>")
    return "".join(parts)


def _command(described, further):
    name = described["name"]
    parameters = [_parameter(name, one) for one in described["parameters"] + further]
    # the point cloud first, results last, rare parameters as QGIS places them
    order = {"files": 0, "crs": 1, "written": 3}
    parameters.sort(key=lambda parameter: order.get(parameter.kind, 2))
    return Command(
        name=name,
        title=TITLES[name],
        group=GROUPS[name],
        summary=described["summary"],
        description=described["description"],
        examples=tuple(described["examples"]),
        parameters=tuple(parameters),
    )


def _parameter(command, described):
    flag = described["name"]
    key = flag.lstrip("-").replace("-", "_").upper()
    kind = _kind(described)
    is_usual = flag in ("clouds", "--crs")
    help_text = described["text"] + ("\n\n" + described["details"] if described["details"] else "")
    return Parameter(
        flag=flag,
        key=key,
        kind=kind,
        label=_label(described, kind),
        help=help_text.replace(described["text"] + "\n\n" + described["text"], described["text"]),
        default=_default(described, kind),
        choices=tuple((choice["name"], choice["text"]) for choice in described["choices"]),
        geometry=GEOMETRIES.get((command, flag), "any"),
        is_required=described["required"] and kind != "written",
        is_repeatable=described["repeatable"],
        is_advanced=not is_usual and (described["builds_balls"] or described["heading"] in RARE),
        outputs=_outputs(command, described, key) if kind == "written" else (),
    )


def _kind(described):
    named = described["value_name"] or ""
    if described["written"]:
        return "written"
    if described["name"] == "clouds":
        return "files"
    if named == "CRS":
        return "crs"
    if named.startswith("X,Y"):
        return "point"
    if described["name"] == "--at" and named == "LAT,LON":
        return "place"
    if ".geojson" in described["formats"]:
        return "layer"
    if described["type"] == "path":
        return "file"
    # several numbers in one value are typed, as on the command line
    return "text" if described["type"] == "numbers" else described["type"]


def _label(described, kind):
    name = described["name"].lstrip("-").replace("-", " ").capitalize()
    if described["name"] == "clouds":
        return "Point clouds, or a ball file"
    if kind == "layer":
        label = NAMES.get(described["name"], name)
    elif described["text"].startswith("With "):
        label = name
    else:
        label = described["text"]
        for end in (": ", "; ", " (", ", in metres", ", in degrees", ", such as"):
            label = label.split(end)[0]
        label = label if len(label) <= LONGEST_LABEL else name
    unit = UNITS.get(described["unit"], described["unit"])
    says_unit = any(word in label for word in ("metre", "degree", "minute", "hPa"))
    if kind in ("number", "integer") and unit and not says_unit:
        label += {"m": " in metres", "s": " in seconds"}.get(unit, f" in {unit}")
    if described["repeatable"] and kind == "text":
        label += " (separate several with ;)"
    return label


def _default(described, kind):
    text = described["default"]
    if kind == "flag":
        return False
    if text is None or kind == "written":
        return None
    if kind in ("number", "integer"):
        try:
            return int(text) if kind == "integer" else float(text)
        except ValueError:
            # a sentence: what happens without a value
            return None
    if kind == "choice":
        names = [choice["name"] for choice in described["choices"]]
        return names.index(text) if text in names else None
    # texts say what happens without a value
    return None


def _outputs(command, described, key):
    text = described["text"].replace("Also write ", "", 1).replace("Also save ", "", 1)
    name = key.replace("_", " ").capitalize()
    short = text.split(" (")[0].split(":")[0]
    says_what = len(short) <= LONGEST_LABEL and not short.startswith("With ")
    label = short[:1].upper() + short[1:] if says_what else name
    is_main = described["name"] == "--output"
    if described["type"] == "folder":
        return (Output(key, "folder", label, ()),)
    # QGIS writes packages itself
    left = [one for one in dict.fromkeys(described["formats"]) if one != ".gpkg"]
    if is_main and command in LINES_IN_TABLES:
        left.remove(".geojson")
    found = []

    def take(kind, suffix, own_label, *extensions):
        formats = tuple(one for one in extensions if one in left)
        if formats and (described["repeatable"] or not found):
            is_usual = is_main and not found
            own_key = key if not found else key + suffix
            found.append(Output(own_key, kind, OUTPUT_LABELS.get((command, own_key), own_label), formats, is_usual))
            left[:] = [one for one in left if one not in formats]

    take("raster", "_RASTER", "Result as a raster" if is_main else label, ".tif")
    take("vector", "_AREAS", "Result as areas" if is_main else label, ".geojson")
    if is_main:
        take("table", "_LAYER", "Result as a vector layer", ".csv")
    take("file", "_FILE", "Result as a file" if is_main else label + " as a file" * bool(found), *left)
    return tuple(found)
